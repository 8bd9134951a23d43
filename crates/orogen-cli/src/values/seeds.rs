//! `--seed`: one seed, or several with one output each.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use super::number::seed;
use crate::failure::Failure;

/// Maximum number of seeds of a command.
const MAX_SEEDS: u64 = 10_000;

/// The placeholder of the seed in the name of an output.
const MARK: &str = "{seed}";

/// Seeds in the given order, without duplicates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seeds(Vec<u64>);

impl FromStr for Seeds {
    type Err = String;

    /// Parses `7`, `1,2,3`, `1..9` (inclusive) and lists of these.
    fn from_str(text: &str) -> Result<Seeds, String> {
        let mut seeds: Vec<u64> = Vec::new();
        for part in text.split(',') {
            let (first, last) = match part.split_once("..") {
                Some((first, last)) => (seed(first)?, seed(last.strip_prefix('=').unwrap_or(last))?),
                None => (seed(part)?, seed(part)?),
            };
            if first > last {
                return Err(format!(
                    "the range of seeds {first}..{last} is empty; write the lower seed first: {last}..{first}"
                ));
            }
            if last - first >= MAX_SEEDS || seeds.len() as u64 + (last - first) >= MAX_SEEDS {
                return Err(format!("at most {MAX_SEEDS} seeds are allowed"));
            }
            for seed in first..=last {
                if seeds.contains(&seed) {
                    return Err(format!("the seed {seed} is listed twice"));
                }
                seeds.push(seed);
            }
        }
        Ok(Seeds(seeds))
    }
}

impl Seeds {
    /// The first seed.
    pub fn first(&self) -> u64 {
        self.0.first().copied().unwrap_or_default()
    }

    /// Calls a function for each seed with the name of its output: the name with the seed in place of `{seed}`, or
    /// before its extension if there are several seeds.
    pub fn each(
        asked: Option<&Seeds>,
        out: Option<&Path>,
        mut work: impl FnMut(Option<Seeds>, Option<PathBuf>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let marked = out.is_some_and(|out| out.to_string_lossy().contains(MARK));
        match asked {
            None if marked => {
                Err(Failure::Usage(format!("{MARK} in the output name needs --seed, such as --seed 1..9")))
            }
            None => work(None, out.map(Path::to_path_buf)),
            Some(Seeds(seeds)) if seeds.len() > 1 && out == Some(Path::new("-")) => Err(Failure::Usage(format!(
                "the outputs of {} seeds cannot be written to one stream; name a file with -o",
                seeds.len()
            ))),
            Some(Seeds(seeds)) => seeds.iter().try_for_each(|&seed| {
                let out = out.map(|out| if marked || seeds.len() > 1 { named(out, seed) } else { out.to_path_buf() });
                work(Some(Seeds(vec![seed])), out)
            }),
        }
    }
}

/// The output name of one seed.
fn named(out: &Path, seed: u64) -> PathBuf {
    let text = out.to_string_lossy();
    if text.contains(MARK) {
        return PathBuf::from(text.replace(MARK, &seed.to_string()));
    }
    let mut name = out.file_stem().unwrap_or_default().to_os_string();
    name.push(format!("-{seed}"));
    if let Some(extension) = out.extension() {
        name.push(".");
        name.push(extension);
    }
    out.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_ranges() {
        for (text, expect) in [
            ("7", Ok(vec![7])),
            ("1, 2,3", Ok(vec![1, 2, 3])),
            ("4..6,9", Ok(vec![4, 5, 6, 9])),
            ("1..=3", Ok(vec![1, 2, 3])),
            ("5..5", Ok(vec![5])),
            ("9..1", Err("write the lower seed first")),
            ("1..4,2", Err("the seed 2 is listed twice")),
            ("0..9999999", Err("at most 10000")),
            ("0..9999,5", Err("at most 10000")),
            ("1,,2", Err("a seed must be a whole number")),
            ("-1", Err("a seed must be a whole number")),
            ("", Err("a seed must be a whole number")),
        ] {
            match (text.parse::<Seeds>(), expect) {
                (Ok(Seeds(seeds)), Ok(expect)) => assert_eq!(seeds, expect, "{text}"),
                (Err(why), Err(expect)) => assert!(why.contains(expect), "{text}: {why}"),
                (found, _) => panic!("{text}: {found:?}"),
            }
        }
    }

    #[test]
    fn outputs_are_named_by_their_seeds() {
        let names = |seeds: Option<&str>, out: &str| {
            let mut names = Vec::new();
            let seeds = seeds.map(|seeds| seeds.parse::<Seeds>().unwrap());
            Seeds::each(seeds.as_ref(), Some(Path::new(out)), |seed, out| {
                names.push(format!("{:?} {}", seed.map(|seed| seed.first()), out.unwrap().display()));
                Ok(())
            })
            .map(|()| names)
            .map_err(|failure| format!("{failure:?}"))
        };
        assert_eq!(names(None, "a.png").unwrap(), ["None a.png"]);
        assert_eq!(names(Some("7"), "a.png").unwrap(), ["Some(7) a.png"]);
        assert_eq!(names(Some("7,8"), "x/a.tif").unwrap(), ["Some(7) x/a-7.tif", "Some(8) x/a-8.tif"]);
        assert_eq!(names(Some("7"), "{seed}/a-{seed}.tif").unwrap(), ["Some(7) 7/a-7.tif"]);
        assert_eq!(names(Some("1..2"), "out").unwrap(), ["Some(1) out-1", "Some(2) out-2"]);
        assert!(names(None, "{seed}.png").unwrap_err().contains("needs --seed"));
        assert!(names(Some("1,2"), "-").unwrap_err().contains("one stream"));
    }
}

//! `orogen cache`.

use std::path::PathBuf;
use std::time::{Duration, SystemTime};

use orogen::grid::words::{bytes, count, number};
use orogen::store::Stored;
use orogen::{FolderStore, Window};
use serde_json::json;

use crate::failure::Failure;
use crate::options::cache_folder;
use crate::say;
use crate::values::bytes::Bytes;
use crate::values::time::Age;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, clap::Subcommand)]
enum Action {
    /// List the stored solutions (content, size and time of last use) and the tiles of levels together
    List(List),
    /// Remove stored solutions and tiles: all, those not used for a time, or the least recently used beyond a size
    Clear(Clear),
}

/// `orogen cache list`.
#[derive(Debug, clap::Args)]
struct List {
    /// The cache folder [default: $OROGEN_CACHE, else the system's cache folder]
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Print the list as JSON
    #[arg(long)]
    json: bool,
}

/// `orogen cache clear`.
#[derive(Debug, clap::Args)]
struct Clear {
    /// The cache folder [default: $OROGEN_CACHE, else the system's cache folder]
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Remove only entries that were not used for this time, such as 30d, 12h or 90m
    #[arg(long, value_name = "AGE")]
    older_than: Option<Age>,
    /// Keep this many bytes of the most recently used entries
    #[arg(long, value_name = "BYTES")]
    keep: Option<Bytes>,
    /// Print no summary
    #[arg(short, long)]
    quiet: bool,
}

/// Lists or clears.
pub fn run(args: &Args) -> Result<(), Failure> {
    match &args.action {
        Action::List(args) => list(args),
        Action::Clear(args) => clear(args),
    }
}

fn cache(asked: Option<&PathBuf>) -> Result<FolderStore, Failure> {
    let folder =
        cache_folder(asked).ok_or_else(|| Failure::Usage("no cache folder is known; name one with --cache".into()))?;
    Ok(FolderStore::new(folder))
}

fn list(args: &List) -> Result<(), Failure> {
    let cache = cache(args.cache.as_ref())?;
    let stored = cache.stored()?;
    let size = |stored: &[Stored]| stored.iter().map(|stored| stored.bytes).sum::<u64>();
    let total = size(&stored);
    let (tiles, solutions): (Vec<Stored>, Vec<Stored>) = stored.into_iter().partition(|stored| stored.level.is_some());
    if args.json {
        let entries: Vec<serde_json::Value> = solutions
            .iter()
            .map(|stored| {
                let layers = stored.layers.as_ref().map(|layers| {
                    let layer = |window: &Window| json!({ "width": window.width, "height": window.height, "cell": window.cell });
                    layers.iter().map(layer).collect::<Vec<_>>()
                });
                json!({
                    "file": stored.path.display().to_string(),
                    "bytes": stored.bytes,
                    "unused_seconds": age(stored).as_secs(),
                    "layers": layers,
                })
            })
            .collect();
        let whole = json!({
            "folder": cache.folder.display().to_string(),
            "bytes": total,
            "solutions": entries,
            "tiles": { "count": tiles.len(), "bytes": size(&tiles) },
        });
        // A tree of numbers and strings can always be serialized.
        return say::out(&(serde_json::to_string_pretty(&whole).unwrap_or_default() + "\n"));
    }
    let mut text = String::new();
    for stored in &solutions {
        let name = stored.path.file_stem().unwrap_or_default().to_string_lossy();
        text.push_str(&format!(
            "{:.12}  {:>9}  used {:>16}  {}\n",
            name,
            bytes(stored.bytes),
            ago(age(stored)),
            holds(stored)
        ));
    }
    if let Some(last) = tiles.last() {
        let used = ago(age(last));
        let (size, counted) = (bytes(size(&tiles)), count(tiles.len(), "tile"));
        text.push_str(&format!("{:12}  {size:>9}  used {used:>16}  {counted} of levels\n", "tiles"));
    }
    let counted = counted(solutions.len(), tiles.len());
    text.push_str(&format!("{}: {counted}, {}\n", cache.folder.display(), bytes(total)));
    say::out(&text)
}

fn clear(args: &Clear) -> Result<(), Failure> {
    let cache = cache(args.cache.as_ref())?;
    let stored = cache.stored()?;
    let mut left: u64 = stored.iter().map(|stored| stored.bytes).sum();
    let (mut removed, mut freed) = ([0, 0], 0);
    // The least recently used first.
    for stored in &stored {
        let is_old = args.older_than.is_none_or(|Age(limit)| age(stored) >= limit);
        let is_much = args.keep.is_none_or(|Bytes(keep)| left > keep);
        if is_old && is_much {
            cache.remove(stored)?;
            left -= stored.bytes;
            freed += stored.bytes;
            removed[usize::from(stored.level.is_some())] += 1;
        }
    }
    let tiles = stored.iter().filter(|stored| stored.level.is_some()).count();
    let kept = counted(stored.len() - tiles - removed[0], tiles - removed[1]);
    match args.quiet {
        true => Ok(()),
        false => say::out(&format!(
            "{}: {} removed, {}; {kept} kept, {}\n",
            cache.folder.display(),
            counted(removed[0], removed[1]),
            bytes(freed),
            bytes(left)
        )),
    }
}

/// The numbers of solutions and tiles as text; tiles are only mentioned if there are any.
fn counted(solutions: usize, tiles: usize) -> String {
    let solutions = count(solutions, "solution");
    if tiles == 0 { solutions } else { format!("{solutions} and {}", count(tiles, "tile")) }
}

/// The time since the last use.
fn age(stored: &Stored) -> Duration {
    SystemTime::now().duration_since(stored.used).unwrap_or_default()
}

/// A duration in a suitable unit.
fn ago(age: Duration) -> String {
    let seconds = age.as_secs();
    let (unit, length) = match seconds {
        0..60 => ("second", 1),
        60..3600 => ("minute", 60),
        3600..86_400 => ("hour", 3600),
        _ => ("day", 86_400),
    };
    format!("{} ago", count((seconds / length) as usize, unit))
}

/// The content of a solution.
fn holds(stored: &Stored) -> String {
    match stored.layers.as_deref() {
        None => "damaged; it is computed again when needed".into(),
        Some([]) => "numbers".into(),
        Some([first, ..]) => format!(
            "{} of {} x {} samples of {} m",
            count(stored.layers.as_ref().map_or(0, Vec::len), "layer"),
            first.width,
            first.height,
            number(first.cell)
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ages_are_in_their_largest_unit() {
        let said = [0, 1, 59, 60, 7200, 86_400 * 3].map(|seconds| ago(Duration::from_secs(seconds)));
        assert_eq!(
            said,
            ["0 seconds ago", "1 second ago", "59 seconds ago", "1 minute ago", "2 hours ago", "3 days ago"]
        );
    }
}

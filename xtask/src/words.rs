//! Checks that no name and no text uses a term for which there is a better standard term.

use std::path::Path;
use std::process::Command;

use crate::failure::{Failure, Result};

/// Names that must not be defined, each with its replacement.
const NAMES: &[(&str, &str)] = &[
    ("Setting", "WorldParams"),
    ("Slots", "Inputs"),
    ("Moves", "CoordMap"),
    ("Slopes", "Stencil"),
    ("Place", "CoordSet, Placement, Point"),
    ("Demand", "GridRequest"),
    ("Between", "Interpolation"),
    ("Machine", "Interpreter"),
    ("Ready", "PreparedProgram"),
    ("Complaint", "Diagnostic"),
    ("Fault", "Diagnostic"),
    ("Imported", "FileRef"),
    ("lies_in", "set_base_dir"),
    ("of_place", "from_dem"),
    ("Order", "BuildSpec"),
    ("Shelf", "OutputStore"),
    ("Story", "JournalState"),
    ("Subject", "LayerSource"),
    ("Spread", "Quantizer"),
    ("Takes", "ValueKind"),
    ("WayOut", "Spill"),
    ("over_bed", "route_carving"),
    ("nearness", "inverse_distance"),
    ("settled", "solve_newton"),
    ("Rings", "LodConfig"),
    ("give_up", "evict"),
    ("KNOBS", "PARAMS"),
    ("Likeness", "FeatureVector"),
    ("film", "tone_map"),
    ("Lettering", "BuiltinFont"),
    ("Letters", "FontSet"),
    ("Mismatch", "LengthMismatch"),
    ("Untileable", "TileError"),
];

/// Prefixes of names, each with its replacement.
const PREFIXES: &[(&str, &str)] = &[("MOST_", "MAX_"), ("USUAL_", "DEFAULT_")];

/// Keywords after which a name is defined.
const DEFINITIONS: &[&str] = &["struct", "enum", "trait", "type", "fn", "const", "static", "mod"];

/// Phrases that no text may contain.
const PHRASES: &[&str] = &[
    "a plan for points asks at no point",
    "show nothing",
    "makes nothing",
    "make nothing",
    "Which chances.",
    "/// One.",
    "/// The other.",
    "it begins otherwise",
    "lies nowhere",
    "it is nobody's",
    "that is nobody's",
    "grow by what sticks to them",
    "each as fast as it is by itself",
    "appear whole or not at all",
    "appears whole or not at all",
    "What depends on what it is asked for",
    "What is the same for",
    "What is told",
    "Whatever lies beyond",
    "The way in:",
    "The way from",
    "as far as there are",
    "as far as they matter",
    "asked sample by sample",
    "is asked at",
    "are asked at",
    "is no plain sum",
    "whoever asks",
    "boils down to",
    "closes on itself",
    "ever farther",
    "held there",
    "held within",
    "the very operations",
    "the very same",
    "worked out once",
];

/// Parts of words in British spelling, each with the American one.
const SPELLINGS: &[(&str, &str)] = &[
    ("behaviour", "behavior"),
    ("neighbour", "neighbor"),
    ("artefact", "artifact"),
    ("colours", "colors"),
    ("coloured", "colored"),
    ("centred", "centered"),
    ("optimis", "optimiz"),
    ("serialis", "serializ"),
    ("quantis", "quantiz"),
    ("rasteris", "rasteriz"),
    ("labelled", "labeled"),
    ("dialogue", "dialog"),
    ("favour", "favor"),
];

/// Ends of the names of Markdown files that are generated, have one entry per line, or are not in English.
const NOT_PROSE: &[&str] = &["docs/ops.md", "docs/gallery.md", "CHANGELOG.md", ".zh-CN.md"];

/// Words that end with a dot within a sentence.
const ABBREVIATIONS: &[&str] = &["al", "cf", "vs", "Fig", "No", "St"];

/// Maximum number of characters of a line of comments; longer tables are allowed.
const WIDTH: usize = 120;

/// Checks every file that git tracks.
pub fn check() -> Result {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."));
    let listed = Command::new("git").args(["ls-files", "*.rs", "*.md", "*.toml"]).current_dir(root).output();
    let listed = listed.map_err(|cause| Failure::Failed(format!("cannot run git: {cause}")))?;
    let mut found = Vec::new();
    for file in String::from_utf8_lossy(&listed.stdout).lines().filter(|file| *file != "xtask/src/words.rs") {
        let Ok(text) = std::fs::read_to_string(root.join(file)) else { continue };
        let is_prose = file.ends_with(".md") && !NOT_PROSE.iter().any(|end| file.ends_with(end));
        let mut is_code = false;
        for (number, line) in text.lines().enumerate() {
            is_code ^= line.trim_start().starts_with("```");
            let sentences =
                (is_prose && !is_code && has_sentences(line)).then(|| "a line has one sentence".to_string());
            let faults = faults(line).into_iter().chain(sentences);
            found.extend(faults.map(|fault| format!("  {file}:{}: {fault}", number + 1)));
        }
    }
    match found.is_empty() {
        true => Ok(()),
        false => Err(Failure::Failed(format!("these have a plainer word:\n{}", found.join("\n")))),
    }
}

/// A line in lower case, without names of other programs and libraries.
fn text_of(line: &str) -> String {
    line.replace("MonoBehaviour", "").replace("labelled_by(", "").to_lowercase()
}

fn faults(line: &str) -> Vec<String> {
    let mut faults: Vec<String> =
        PHRASES.iter().filter(|phrase| line.contains(*phrase)).map(|phrase| format!("\"{phrase}\"")).collect();
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let code = line.split("//").next().unwrap_or_default();
    let words: Vec<&str> = code.split(|c| !is_name(c)).filter(|word| !word.is_empty()).collect();
    for pair in words.windows(2).filter(|pair| DEFINITIONS.contains(&pair[0])) {
        let name = NAMES.iter().find(|(name, _)| *name == pair[1]);
        let prefix = PREFIXES.iter().find(|(prefix, _)| pair[1].starts_with(prefix));
        faults.extend(name.or(prefix).map(|(_, instead)| format!("`{}`: {instead}", pair[1])));
    }
    // Quoted words may be typed by a user, or be in a file.
    let is_quoted = |word: &str| {
        line.contains(&format!("\"{word}")) || line.contains(&format!("-{word}")) || line.contains(&format!("__{word}"))
    };
    let spelled = SPELLINGS.iter().filter(|(british, _)| text_of(line).contains(british) && !is_quoted(british));
    faults.extend(spelled.map(|(british, american)| format!("`{british}`: {american}")));
    let text = line.trim_start();
    if text.starts_with("//")
        && !text.trim_start_matches(['/', '!', ' ']).starts_with('|')
        && line.chars().count() > WIDTH
    {
        faults.push(format!("a comment of more than {WIDTH} characters"));
    }
    faults
}

/// Whether a line of Markdown has more than one sentence; headings, tables and indented code may.
fn has_sentences(line: &str) -> bool {
    let text = line.trim_start();
    if text.starts_with(['#', '|', '<', '!']) || line.starts_with("    ") && !text.starts_with("- ") {
        return false;
    }
    // A dot between backticks or in brackets does not end a sentence.
    let (mut is_code, mut depth) = (false, 0);
    let mut outside = String::new();
    for c in text.chars() {
        is_code ^= c == '`';
        depth += i32::from(!is_code && matches!(c, '(' | '[')) - i32::from(!is_code && matches!(c, ')' | ']'));
        outside.push(if is_code || depth > 0 { 'x' } else { c });
    }
    let starts = |rest: &str| rest.starts_with(|c: char| c.is_ascii_uppercase());
    outside.match_indices(". ").any(|(at, end)| {
        let word = outside[..at].rsplit(' ').next().unwrap_or_default();
        let is_end = word.len() > 1 && !word.contains('.') && !word.ends_with(|c: char| c.is_ascii_digit());
        is_end && !ABBREVIATIONS.contains(&word) && starts(&outside[at + end.len()..])
    })
}

#[cfg(test)]
mod tests {
    use super::{faults, has_sentences};

    #[test]
    fn a_line_of_markdown_has_one_sentence() {
        assert!(has_sentences("Rivers run. Lakes do not."));
        assert!(has_sentences("- **Rivers** run to `sea`. Lakes do not."));
        assert!(!has_sentences("Rivers (long. And wide) run, see Smith et al. 2022 and `a. B`."));
        assert!(!has_sentences("1. Rivers run."));
        assert!(!has_sentences("| Rivers run. Lakes do not. |"));
    }

    #[test]
    fn definitions_and_phrases_are_found_and_uses_are_not() {
        assert_eq!(faults("pub struct Shelf<'a> {"), ["`Shelf`: OutputStore"]);
        assert_eq!(faults("const MOST_NODES: usize = 3;"), ["`MOST_NODES`: MAX_"]);
        assert_eq!(faults("    /// Which chances."), ["\"Which chances.\""]);
        assert_eq!(faults("/// The Neighbours of a cell."), ["`neighbour`: neighbor"]);
        assert!(faults("aliases([\"colours\"])").is_empty());
        assert_eq!(faults(&format!("    // {}", "x".repeat(120))), ["a comment of more than 120 characters"]);
        assert!(faults(&format!("    /// | {} |", "x".repeat(120))).is_empty());
        assert!(faults("impl Shelf { // struct Shelf").is_empty());
        assert!(faults("let order = Order::new();").is_empty());
    }
}

//! Names on a map, from points and lines with names.

use orogen_grid::grid::Window;
use orogen_grid::words::number;
use orogen_io::format::dem::Georeference;
use orogen_io::format::points::NamedPoints;
use orogen_output::sheet::options::{LineName, PlaceKind, PlaceName, SheetOptions};

/// Maximum number of names in a message.
const SHOWN: usize = 5;

/// What the words of a file name, in lower case.
const KINDS: [(PlaceKind, &[&str]); 3] = [
    (PlaceKind::Summit, &["summit", "peak", "mountain", "hill", "volcano"]),
    (PlaceKind::River, &["river", "stream", "creek", "brook", "canal"]),
    (PlaceKind::Water, &["water", "lake", "pond", "reservoir", "sea", "ocean", "bay", "gulf", "strait"]),
];

/// What a word names; a place if it is none of these.
fn kind(word: Option<&String>) -> PlaceKind {
    let word = word.map(|word| word.to_lowercase()).unwrap_or_default();
    KINDS.iter().find(|(_, words)| words.contains(&word.as_str())).map_or(PlaceKind::Place, |(kind, _)| *kind)
}

/// Adds the named points and lines inside a window to the options of its sheet, with a warning about others.
pub fn add(
    options: &mut SheetOptions,
    names: &NamedPoints,
    map: Option<&Georeference>,
    window: &Window,
    warnings: &mut Vec<String>,
) {
    let map = map.cloned().unwrap_or(Georeference::LOCAL);
    let mut outside = Vec::new();
    let shares = |at: [f64; 2]| {
        let [east, south] = map.metres(at[0], at[1]);
        let share = |metres: f64, first: i64, count: usize| (metres / window.cell - first as f64) / (count - 1) as f64;
        [share(east, window.x, window.width), share(south, window.y, window.height)]
    };
    let is_inside = |at: &[f64; 2]| at.iter().all(|share| (0.0..=1.0).contains(share));
    for point in &names.points {
        let Some(name) = point.name.clone() else { continue };
        let at = shares(point.at);
        let kind = kind(point.kind.as_ref());
        match is_inside(&at) {
            true => options.names.push(PlaceName { name, kind, height: point.height, at }),
            false => outside.push(name),
        }
    }
    for line in &names.lines {
        let Some(name) = line.name.clone() else { continue };
        let points: Vec<[f64; 2]> = line.points.iter().map(|at| shares(*at)).collect();
        let is_water = line.kind.is_none() || matches!(kind(line.kind.as_ref()), PlaceKind::River | PlaceKind::Water);
        match points.iter().any(is_inside) {
            true => options.line_names.push(LineName { name, is_water, points }),
            false => outside.push(name),
        }
    }
    if !outside.is_empty() {
        let ([west, north], [east, south]) = (
            map.at(window.east(0), window.south(0)),
            map.at(window.east(window.width - 1), window.south(window.height - 1)),
        );
        let [west, east, south, north] = [west, east, south, north].map(number);
        warnings.push(format!(
            "{} outside the map, which extends from {west} to {east} east and from {south} to {north} north",
            match outside.as_slice() {
                [one] => format!("{} is", quoted(one)),
                _ => format!("{} are", listed(&outside)),
            }
        ));
    }
}

/// The first names of a list, and how many more there are.
pub fn listed(names: &[String]) -> String {
    let shown: Vec<String> = names.iter().take(SHOWN).map(|name| quoted(name)).collect();
    match names.len().saturating_sub(SHOWN) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

fn quoted(name: &str) -> String {
    format!("`{}`", name.escape_debug())
}

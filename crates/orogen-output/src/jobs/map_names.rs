//! Names of places on a map.

use crate::sheet::options::PlaceName;
use orogen_grid::grid::Window;
use orogen_grid::words::number;
use orogen_io::format::dem::Georeference;
use orogen_io::format::points::NamedPoint;

/// Maximum number of names in a message.
const SHOWN: usize = 5;

/// The named points inside a window, with a warning about others.
pub fn within(
    points: &[NamedPoint],
    map: Option<&Georeference>,
    window: &Window,
    warnings: &mut Vec<String>,
) -> Vec<PlaceName> {
    let map = map.cloned().unwrap_or(Georeference { origin: [0.0; 2], per_metre: [1.0; 2], keys: None });
    let (mut names, mut outside) = (Vec::new(), Vec::new());
    for point in points {
        let Some(name) = point.name.clone() else { continue };
        let [east, south] = map.metres(point.at[0], point.at[1]);
        let share = |metres: f64, first: i64, count: usize| (metres / window.cell - first as f64) / (count - 1) as f64;
        let at = [share(east, window.x, window.width), share(south, window.y, window.height)];
        match at.iter().all(|share| (0.0..=1.0).contains(share)) {
            true => names.push(PlaceName { name, at }),
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
    names
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

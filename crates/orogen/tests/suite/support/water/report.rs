//! All measurements of a mosaic, with their targets.

use super::layers::Tiles;
use super::mosaic::Mosaic;
use super::network::Network;
use super::{agreement, beds, borders, depressions, lakes};
use orogen::Result;

/// Ranges of drainage areas in which rivers are compared, in m², and the target for the share that agrees, in %.
const RANGES: [([f64; 2], Option<f64>); 4] =
    [([5e6, 10e6], None), ([10e6, 30e6], None), ([10e6, 100e6], Some(95.0)), ([100e6, f64::INFINITY], Some(99.0))];

/// A measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// The name, with the unit.
    pub name: String,
    /// The value; `None` if there was nothing to measure.
    pub value: Option<f64>,
    /// Number of cells, links or borders that were measured.
    pub of: usize,
    /// The target.
    pub target: Target,
}

/// The target of a measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// For information only.
    None,
    /// At most this.
    AtMost(f64),
    /// At least this.
    AtLeast(f64),
}

impl Figure {
    fn new(name: impl Into<String>, value: f64, of: usize, target: Target) -> Figure {
        Figure { name: name.into(), value: (of > 0).then_some(value), of, target }
    }

    /// Whether the target is met, or there was nothing to measure.
    pub fn holds(&self) -> bool {
        match (self.value, self.target) {
            (None, _) | (_, Target::None) => true,
            (Some(value), Target::AtMost(most)) => value <= most,
            (Some(value), Target::AtLeast(least)) => value >= least,
        }
    }
}

/// Makes a mosaic and measures it.
pub fn measure(tiles: Tiles, mosaic: &Mosaic) -> Result<Vec<Figure>> {
    let water = mosaic.make(tiles)?;
    let network = Network::new(&water);
    let share = |part: usize, whole: usize| 100.0 * part as f64 / whole.max(1) as f64;
    let mut figures = Vec::new();
    let mut add = |name: &str, value: f64, of: usize, target: Target| {
        figures.push(Figure::new(name, value, of, target));
    };

    let found = depressions::measure(&water);
    add("depressions, % of the land", share(found.cells, found.land), found.land, Target::AtMost(0.02));
    add("depressions, depth in m", found.deepest.into(), found.land, Target::AtMost(5.0));

    let found = beds::measure(&network);
    add("beds that rise, % of links", share(found.rising, found.links), found.links, Target::AtMost(0.01));
    add("beds that rise, height in m", found.greatest.into(), found.links, Target::AtMost(1.0));
    add("rivers that end on land", found.ends as f64, found.links, Target::AtMost(0.0));

    let ranges = RANGES.map(|(range, _)| range);
    for (found, (_, target)) in agreement::measure(&network, &ranges).iter().zip(RANGES) {
        let [from, below] = found.range.map(|area| area / 1e6);
        let name = if below.is_finite() { format!("{from} to {below} km²") } else { format!("above {from} km²") };
        let target = target.map_or(Target::None, Target::AtLeast);
        add(&format!("D8 agrees, {name}, % of cells"), share(found.agree, found.cells), found.cells, target);
    }

    figures.extend(of_borders("borders of tiles", &borders::measure(&network, mosaic), true));
    figures.extend(of_borders("middles of tiles", &borders::measure_middles(&network, mosaic), false));

    let mut add = |name: &str, value: f64, of: usize, target: Target| {
        figures.push(Figure::new(name, value, of, target));
    };
    let found = lakes::measure(&network);
    add("lakes, step of the surface in m", found.step.into(), found.cells, Target::AtMost(0.05));
    add("lakes, surface above the shore in m", found.above_shore.into(), found.cells, Target::AtMost(1.0));
    Ok(figures)
}

/// The measurements of pairs of adjacent windows.
pub fn of_pairs(found: &borders::Pairs) -> Vec<Figure> {
    let borders::Pairs { borders, middles } = found;
    let mut figures = of_borders(&format!("borders of {} pairs", borders.borders), borders, true);
    figures.extend(of_borders(&format!("middles of {} windows", middles.borders), middles, false));
    figures
}

/// The measurements of borders, with targets or for comparison.
fn of_borders(place: &str, found: &borders::Borders, targets: bool) -> Vec<Figure> {
    let target = if targets { Target::AtMost(0.0) } else { Target::None };
    let figure = |name: &str, count: usize, target: Target| {
        Figure::new(format!("{name} at {place}"), count as f64, found.crossings.max(count), target)
    };
    vec![
        figure("rivers cut", found.cut, target),
        figure("areas unbalanced", found.unbalanced, target),
        // Drainage areas of levels are carried down with a small error, also in the middle of tiles.
        figure("areas that fall", found.falling, Target::None),
    ]
}

/// A table of measurements, one per line.
pub fn table(figures: &[Figure]) -> String {
    let width = figures.iter().map(|figure| figure.name.chars().count()).max().unwrap_or(0);
    let mut text = format!("{:width$}  {:>10}  {:>10}  {:>10}\n", "figure", "value", "target", "of");
    for figure in figures {
        let value = figure.value.map_or("-".to_owned(), |value| format!("{value:.4}"));
        let target = match figure.target {
            Target::None => "-".to_owned(),
            Target::AtMost(most) => format!("<= {most}"),
            Target::AtLeast(least) => format!(">= {least}"),
        };
        let missed = if figure.holds() { "" } else { "  missed" };
        text.push_str(&format!("{:width$}  {value:>10}  {target:>10}  {:>10}{missed}\n", figure.name, figure.of));
    }
    text
}

//! Beaches: sand on the rock, with the profile of Dean (1977) below the water and a berm above.

use super::Coast;
use super::march::{Start, march, neighbors};
use super::nodes::{NONE, Node, Nodes, cell_of};
use super::retreat::{self, Shore};
use crate::grid::Window;

/// Slope of the dry beach.
const FACE: f64 = 0.1;
/// Slope of sand at the end of its body.
pub(super) const FOREFOOT: f64 = 0.5;
/// Length of the body of sand under water, in widths of the beach.
pub(super) const BODY: f64 = 4.0;
/// Depth of closure on an open coast and least depth, in metres (Hallermeier 1981).
const CLOSURE: [f64; 2] = [8.0, 1.0];
/// A beach narrower than this, in metres, is thinner than the profile.
const NARROW: f64 = 12.0;
/// Widest beach, in metres.
const WIDEST: f64 = 200.0;
/// The shore of an island is as many times longer than its beaches are wide, at least.
const ROUND: f64 = 20.0;
/// Corrections of the widths, so that the sand on the ground has the volume of the lines.
const CORRECTIONS: usize = 6;
/// Share of the volume that may be missing.
const TOLERANCE: f64 = 0.02;

/// A of Dean's profile h = A y^(2/3) from the size of grains in mm, through their settling velocity (Dean 1987).
pub(super) fn dean(grain: f64) -> f64 {
    0.067 * libm::pow(14.0 * libm::pow(grain, 1.1), 0.44)
}

/// Depth below which waves of an exposure do not move sand.
pub(super) fn closure(exposure: f64) -> f64 {
    CLOSURE[1] + (CLOSURE[0] - CLOSURE[1]) * exposure.clamp(0.0, 1.0).sqrt()
}

/// Sand on the ground.
pub(super) struct Sand {
    /// Thickness in metres.
    pub(super) thickness: Vec<f32>,
    /// Volume in m^3.
    pub(super) volume: f64,
}

/// Lays sand with these widths of beaches at the nodes, all multiplied so that the sand has a volume.
pub(super) fn lay(
    law: &Coast,
    window: &Window,
    shore: &Shore,
    worn: &[f32],
    nodes: &Nodes,
    widths: &[f64],
    volume: f64,
) -> Sand {
    let at_shore = spread(window, nodes, widths);
    let laid =
        |factor: f64| lay_widths(law, window, shore, worn, |cell| (factor * f64::from(at_shore[cell])).min(WIDEST));
    let mut best = laid(1.0);
    let off = |sand: &Sand| (sand.volume / volume.max(1e-9)).max(1e-9);
    let (mut low, mut high) = (0.0f64, f64::INFINITY);
    let mut factor = 1.0;
    let mut share = off(&best);
    for _ in 0..CORRECTIONS {
        if (share - 1.0).abs() < TOLERANCE || volume <= 0.0 {
            break;
        }
        if share > 1.0 {
            high = factor
        } else {
            low = factor
        }
        // Volume grows a little faster than width.
        let tried = factor * libm::pow(share, -0.8).clamp(0.25, 4.0);
        factor = if tried > low && tried < high { tried } else { 0.5 * (low + high.min(4.0 * low.max(0.1))) };
        let next = laid(factor);
        share = off(&next);
        if libm::log(share).abs() < libm::log(off(&best)).abs() {
            best = next;
        }
    }
    best
}

/// Widths at the cells around the nodes, as means with weights.
fn spread(window: &Window, nodes: &Nodes, width: &[f64]) -> Vec<f32> {
    let mut sums = vec![[0.0f64; 2]; window.len()];
    for (node, width) in nodes.nodes.iter().zip(width) {
        let [x, y] = node.at;
        let (i, j) = (x.max(0.0) as usize, y.max(0.0) as usize);
        for row in j.saturating_sub(3)..(j + 5).min(window.height) {
            for column in i.saturating_sub(3)..(i + 5).min(window.width) {
                let (dx, dy) = (column as f64 - x, row as f64 - y);
                let weight = (1.0 - (dx * dx + dy * dy) / 12.0).max(0.0);
                let sum = &mut sums[row * window.width + column];
                sum[0] += weight * weight * width;
                sum[1] += weight * weight;
            }
        }
    }
    sums.iter().map(|[sum, weight]| if *weight > 0.0 { (sum / weight) as f32 } else { 0.0 }).collect()
}

/// Lays sand that moves the shore out by a width.
fn lay_widths(law: &Coast, window: &Window, shore: &Shore, worn: &[f32], width: impl Fn(usize) -> f64) -> Sand {
    // A front that begins earlier where the beach is wide: its time is the distance from the water line of the sand,
    // negative on the beach.
    let starts: Vec<Start> = retreat::starts(&shore.beside, false, |cell, d| {
        let exposure = retreat::mean_around(window, |at| shore.is_sea(at), &shore.exposure, cell);
        (WIDEST + d - width(cell), [width(cell) as f32, exposure])
    });
    let widest = starts.iter().map(|start| f64::from(start.carried[0])).fold(0.0, f64::max);
    let limit = WIDEST + BODY * widest + CLOSURE[0] / FOREFOOT + 2.0 * window.cell;
    let front = march(window, starts, |cell| shore.is_sea(cell), |_, _| 1.0, limit);
    let scale = dean(law.grain_size);
    let mut thickness = vec![0.0f32; worn.len()];
    let mut volume = 0.0;
    for (cell, thickness) in thickness.iter_mut().enumerate() {
        // At the border of the domain water leaves at any height, and sand would dam it.
        let border = neighbors(window, cell).contains(&None);
        if border || !front.time[cell].is_finite() {
            continue;
        }
        let [width, exposure] = front.carried[cell].map(f64::from);
        let y = f64::from(front.time[cell]) - WIDEST;
        let thick = sand_over(law, scale, y, width, exposure, f64::from(worn[cell])) as f32;
        if thick > 0.0 {
            *thickness = thick;
            volume += f64::from(thick) * window.cell * window.cell;
        }
    }
    Sand { thickness, volume }
}

/// Height of sand at a distance seaward of its water line.
pub(super) fn surface(law: &Coast, scale: f64, y: f64, width: f64, exposure: f64) -> f64 {
    if y <= 0.0 {
        return (FACE * -y).min(law.berm * (0.3 + 0.7 * exposure.clamp(0.0, 1.0).sqrt()));
    }
    // Over a deep bed the body of sand ends after some widths.
    let end = libm::pow(closure(exposure) / scale, 1.5).min(BODY * width);
    -scale * libm::pow(y.min(end), 2.0 / 3.0) - FOREFOOT * (y - end).max(0.0)
}

/// Thickness of sand over a bed.
fn sand_over(law: &Coast, scale: f64, y: f64, width: f64, exposure: f64, bed: f64) -> f64 {
    let height = surface(law, scale, y, width, exposure);
    // On a bed deeper than the waves reach sand does not stay.
    let closure = closure(exposure);
    let held = (2.0 + bed / closure).clamp(0.0, 1.0);
    (height - bed).max(0.0) * (width / NARROW).min(1.0) * held
}

/// Sand that arrives at each node, in m^3: from worn cliffs and from rivers.
pub(super) fn supply(nodes: &Nodes, volumes: impl Iterator<Item = (usize, f64)>) -> Vec<f64> {
    let mut sand = vec![0.0; nodes.nodes.len()];
    for (cell, volume) in volumes {
        let node = nodes.nearest[cell];
        if node != NONE {
            sand[node as usize] += volume;
        }
    }
    sand
}

/// Widths of beaches for which the sand is known, in metres.
const WIDTHS: [f64; 8] = [0.0, 6.0, 12.0, 25.0, 50.0, 90.0, 140.0, WIDEST];
/// Width of a usual beach, in metres.
const USUAL: f64 = 50.0;

/// Sand that the shore at a node can hold.
#[derive(Debug, Clone, Copy)]
pub(super) struct Section {
    /// Area of the sand across the shore, in m^2, for each of [`WIDTHS`].
    areas: [f64; WIDTHS.len()],
    /// Width of the widest beach, in metres.
    pub(super) widest: f64,
}

impl Section {
    /// The sections at all nodes.
    pub(super) fn all(law: &Coast, window: &Window, shore: &Shore, worn: &[f32], nodes: &Nodes) -> Vec<Section> {
        let scale = dean(law.grain_size);
        nodes.nodes.iter().map(|node| Section::new(law, window, shore, worn, node, scale)).collect()
    }

    fn new(law: &Coast, window: &Window, shore: &Shore, worn: &[f32], node: &Node, scale: f64) -> Section {
        let step = 0.5 * window.cell;
        let mut section = Section { areas: [0.0; WIDTHS.len()], widest: WIDEST.min(node.line / ROUND) };
        let mut k = 0.5;
        loop {
            let distance = k * step;
            k += 1.0;
            let at = [0, 1].map(|axis| node.at[axis] + distance / window.cell * node.out[axis]);
            let cell = cell_of(window, at);
            let outside = at[0] < 0.0 || at[1] < 0.0;
            let beyond = at[0] > window.width as f64 - 1.0 || at[1] > window.height as f64 - 1.0;
            // The first samples may be on land.
            if (!shore.is_sea(cell) || worn[cell] > 0.0) && distance > 1.5 * window.cell {
                section.widest = section.widest.min(0.4 * distance);
                return section;
            }
            if outside || beyond || distance > WIDEST * (1.0 + BODY) {
                return section;
            }
            let exposure = f64::from(shore.exposure[cell]);
            let bed = f64::from(worn[cell]).min(0.0);
            for (area, width) in section.areas.iter_mut().zip(WIDTHS) {
                *area += step * sand_over(law, scale, distance - width, width, exposure, bed);
            }
        }
    }

    /// A section of the same depth everywhere.
    #[cfg(test)]
    pub(super) fn of_depth(depth: f64) -> Section {
        Section { areas: WIDTHS.map(|width| width * depth), widest: WIDEST }
    }

    /// Area of the sand of a beach of a width.
    pub(super) fn area(&self, width: f64) -> f64 {
        let above = WIDTHS.iter().position(|known| *known >= width).unwrap_or(WIDTHS.len() - 1).max(1);
        let share = ((width - WIDTHS[above - 1]) / (WIDTHS[above] - WIDTHS[above - 1])).clamp(0.0, 1.0);
        self.areas[above - 1] + share * (self.areas[above] - self.areas[above - 1])
    }

    /// Area of the sand of the widest beach.
    pub(super) fn most(&self) -> f64 {
        self.area(self.widest)
    }

    /// Height of the profile of a usual beach, in metres.
    pub(super) fn depth(&self) -> f64 {
        let width = self.widest.clamp(1.0, USUAL);
        (self.area(width) / width).max(1.0)
    }

    /// Width of a beach with sand of an area.
    pub(super) fn width(&self, area: f64) -> f64 {
        let above = self.areas.iter().position(|known| *known >= area).unwrap_or(WIDTHS.len() - 1).max(1);
        let [low, high] = [self.areas[above - 1], self.areas[above]];
        let share = if high > low { ((area - low) / (high - low)).clamp(0.0, 1.0) } else { 1.0 };
        (WIDTHS[above - 1] + share * (WIDTHS[above] - WIDTHS[above - 1])).min(self.widest)
    }
}

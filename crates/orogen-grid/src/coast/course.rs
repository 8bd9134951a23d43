//! Courses of spits: where sand goes that leaves the shore.

use super::nodes::cell_of;
use super::ridges::{DEEPEST, Ridges};

/// Steps of a course, in cells.
pub(super) const STEP: f64 = 0.5;
/// Length over which a spit turns to the direction in which waves move the most sand, in metres.
const TURNED: f64 = 500.0;
/// Smallest radius of a course, in metres.
const RADIUS: f64 = 250.0;
/// Mean radius by which waves bend a spit towards its lee, in metres.
const BENT: f64 = 2500.0;
/// Angle between the waves and the shore at which they move the most sand: 45 degrees (Ashton and Murray 2006).
const MOST: f64 = std::f64::consts::FRAC_PI_4;
/// A course turns away from its first direction by at most these angles, towards the sea and towards the lee.
const BOUNDS: [f64; 2] = [0.12, 1.3];
/// The first cells of a course may pass by the shore.
const FREE: f64 = 4.0;
/// Distance to the lee in which land counts, in cells.
const LEE: usize = 16;

/// Turns a vector.
pub(super) fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (cos, sin) = (libm::cos(angle), libm::sin(angle));
    [x * cos - y * sin, x * sin + y * cos]
}

/// The angle from one vector to another, positive where [`turned`] turns.
pub(super) fn angle([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    libm::atan2(ax * by - ay * bx, ax * bx + ay * by)
}

/// A place at which sand leaves the shore.
#[derive(Debug, Clone, Copy)]
pub(super) struct Root {
    pub(super) at: [f64; 2],
    /// Direction of the shore before it.
    pub(super) along: [f64; 2],
    /// 1 or -1: where the land is, as an angle from `along`.
    pub(super) side: f64,
}

/// Where a course ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum End {
    /// At land, at a cell.
    Land(usize),
    /// In deep water, at the reach of the sand or at the border of the domain.
    Open,
}

/// The course of a spit.
#[derive(Debug, Clone)]
pub(super) struct Course {
    /// Positions and directions, [`STEP`] apart.
    pub(super) points: Vec<([f64; 2], [f64; 2])>,
    pub(super) end: End,
    /// Mean distance to the land in the lee, in cells.
    pub(super) lee: f64,
}

impl Course {
    /// The course from a root, at most `reach` metres long. `waves` has the sums of directions that waves come from.
    pub(super) fn new(ridges: &Ridges, waves: &[[f32; 2]], root: &Root, reach: f64) -> Course {
        let window = ridges.window;
        let step = STEP * window.cell;
        let (mut at, mut along) = (root.at, root.along);
        let mut points = vec![(at, along)];
        let mut end = End::Open;
        let ahead = ridges.narrowest() / window.cell + 1.0;
        let (mut lee, mut count) = (0.0, 0.0);
        while points.len() as f64 * step < reach {
            let [east, south] = waves[cell_of(window, at)].map(f64::from);
            let strength = (east * east + south * south).sqrt();
            let mut turn = 0.0;
            if strength > 1e-9 {
                let sought = turned([-east / strength, -south / strength], -root.side * MOST);
                turn = root.side * angle(along, sought) * step / TURNED;
            }
            // Waves turn around the end, the more the further it is from the shore.
            let bent = step / BENT * (0.4 + 1.6 * points.len() as f64 * step / reach);
            turn = (turn + bent).max(0.5 * bent);
            // Waves feel a shoal before deep water, and turn the spit along it.
            let before = [0, 1].map(|k| at[k] + 3.0 * along[k]);
            turn += step / RADIUS * (1.75 * ridges.depth(before) / DEEPEST - 1.05).max(0.0);
            turn = turn.clamp(-step / RADIUS, step / RADIUS);
            let gone = root.side * angle(root.along, along);
            turn = turn.clamp(-BOUNDS[0] - gone, (BOUNDS[1] - gone).max(0.0));
            along = turned(along, root.side * turn);
            at = [0, 1].map(|k| at[k] + STEP * along[k]);
            let far = points.len() as f64 * STEP;
            let border = ahead + 2.0;
            if at[0] < border
                || at[1] < border
                || at[0] > window.width as f64 - 1.0 - border
                || at[1] > window.height as f64 - 1.0 - border
                || ridges.depth(at) > DEEPEST
            {
                break;
            }
            if far > FREE {
                let tip = cell_of(window, [0, 1].map(|k| at[k] + ahead * along[k]));
                let own = cell_of(window, at);
                if let Some(cell) = [own, tip].into_iter().find(|cell| ridges.is_land(*cell)) {
                    end = End::Land(cell);
                    break;
                }
                let (distance, cell) = lee_of(ridges, at, turned(along, root.side * std::f64::consts::FRAC_PI_2));
                // It meets a headland beside it.
                if distance <= ahead && far > 2.0 * FREE {
                    end = End::Land(cell);
                    break;
                }
                lee += distance;
                count += 1.0;
            }
            points.push((at, along));
        }
        Course { points, end, lee: if count > 0.0 { lee / count } else { 0.0 } }
    }

    /// Length in cells.
    pub(super) fn length(&self) -> f64 {
        self.points.len().saturating_sub(1) as f64 * STEP
    }
}

/// Distance to land in a direction, in cells, and the last cell that was looked at.
fn lee_of(ridges: &Ridges, at: [f64; 2], direction: [f64; 2]) -> (f64, usize) {
    let cell = |k: usize| cell_of(ridges.window, [0, 1].map(|axis| at[axis] + k as f64 * direction[axis]));
    let far = (1..LEE).find(|k| ridges.is_land(cell(*k))).unwrap_or(LEE);
    (far as f64, cell(far))
}

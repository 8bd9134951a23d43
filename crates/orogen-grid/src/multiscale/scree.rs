//! Scree on detail levels: debris of rock faces lies at their foot at its angle of repose. Water seeps into it, so that
//! it has no gullies.

use super::level::Level;
use super::rock;

/// Slope of scree: the tangent of its angle of repose, 34 degrees.
const REPOSE: f32 = 0.675;

/// Stable slopes between which a hillside changes to a face that sheds debris.
const FACES: [f32; 2] = [0.75, 1.0];

/// Number of nodes around a node whose heights determine whether it is at the foot of a face or on the face.
pub const REACH: usize = 3;

/// Positions between the lowest and the highest of these nodes: up to the first there is only scree, from the second on
/// there is only rock.
const FOOT: [f32; 2] = [0.3, 0.5];

/// Steepening of the rock above scree relative to the flattening of the scree, so that faces keep their height, and the
/// maximum slope of the rock.
const STEEPER: f32 = 0.6;
const MAX_ROCK: f32 = 2.5;

/// Added to the logarithm of uplift over erodibility where everything is scree, so that no stream cuts down.
const SEEPAGE: f32 = 2.0;

/// Adds scree at the foot of faces: changes `stable`, the stable slopes of nodes, and `variation`. Nodes are exact
/// except for [`REACH`] at the edge.
pub fn lay(level: &Level, stable: &mut [f32], variation: &mut [f32]) {
    let position = positions(level);
    for ((stable, variation), position) in stable.iter_mut().zip(variation).zip(position) {
        let face = rock::share(*stable, FACES);
        let scree = face * (1.0 - rock::share(position, FOOT));
        let steeper = 1.0 + STEEPER * (face - scree) * (1.0 - REPOSE / stable.max(REPOSE));
        let of_rock = (*stable * steeper).min(MAX_ROCK.max(*stable));
        *stable = of_rock + scree * (REPOSE - of_rock);
        *variation += SEEPAGE * scree;
    }
}

/// The position of each node's height between the lowest and the highest around it, 0 to 1.
fn positions(level: &Level) -> Vec<f32> {
    let (width, height) = (level.window.width, level.window.height);
    let lowest = extreme(&level.height, (width, height), f32::min);
    let highest = extreme(&level.height, (width, height), f32::max);
    let heights = level.height.iter().zip(lowest).zip(highest);
    heights.map(|((height, low), high)| (height - low) / (high - low).max(1e-3)).collect()
}

/// The extreme value among the nodes up to [`REACH`] columns and rows away.
fn extreme(plane: &[f32], (width, height): (usize, usize), of: impl Fn(f32, f32) -> f32) -> Vec<f32> {
    let fold = |values: &mut dyn Iterator<Item = f32>, first: f32| values.fold(first, &of);
    let mut rows = plane.to_vec();
    for (out, row) in rows.chunks_mut(width.max(1)).zip(plane.chunks(width.max(1))) {
        for (i, out) in out.iter_mut().enumerate() {
            let near = &row[i.saturating_sub(REACH)..(i + REACH + 1).min(width)];
            *out = fold(&mut near.iter().copied(), row[i]);
        }
    }
    let mut both = rows.clone();
    for j in 0..height {
        for i in 0..width {
            let near = j.saturating_sub(REACH)..(j + REACH + 1).min(height);
            both[j * width + i] = fold(&mut near.map(|j| rows[j * width + i]), rows[j * width + i]);
        }
    }
    both
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    /// A face in the middle of the columns: from 0 m up to its foot at column 6, then up with this slope.
    fn face(slope: f32) -> Level {
        let window = Window { x: 0, y: 0, width: 20, height: 9, cell: 60.0 };
        let plane = |value: f32| vec![value; window.len()];
        let height = (0..window.len()).map(|q| ((q % 20) as f32 - 6.0).clamp(0.0, 8.0) * slope * 60.0).collect();
        let receiver = vec![4; window.len()];
        let [east, south, area, variation, uplift, shore] = [0.5, 0.5, 1.0, 0.0, 0.0, 9.0].map(plane);
        Level { depth: 0, window, east, south, height, area, receiver, variation, uplift, shore }
    }

    #[test]
    fn scree_lies_at_the_foot_of_steep_faces_below_steeper_rock() {
        let level = face(1.2);
        let (mut stable, mut variation) = (vec![1.2; level.window.len()], level.variation.clone());
        lay(&level, &mut stable, &mut variation);
        let row = 4 * 20;
        assert_eq!(stable[row + 6], REPOSE, "at the foot");
        assert!(stable[row + 13] > 1.4 && stable[row + 13] < MAX_ROCK, "rock: {}", stable[row + 13]);
        assert!(variation[row + 6] == SEEPAGE && variation[row + 13] == 0.0);
    }

    #[test]
    fn gentle_hillsides_have_none() {
        let level = face(0.5);
        let (mut stable, mut variation) = (vec![0.6; level.window.len()], level.variation.clone());
        lay(&level, &mut stable, &mut variation);
        assert!(stable.iter().all(|slope| *slope == 0.6) && variation == level.variation);
    }
}

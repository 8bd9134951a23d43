//! The courses of a map's rivers through the world: with bends between the points of the map, heights of the bed, and
//! mouths in the sea.

use orogen_grid::grid::Grid;
use orogen_grid::placement;
use orogen_grid::random::Random;
use orogen_io::format::fmg::FmgMap;

/// Number of times each part of a river is halved, and the distance of the new points from the middle, as a share of
/// its length.
const HALVINGS: u64 = 4;
const BEND: f64 = 0.16;

/// Height of a bed as a share of the mean height of the land around it.
const BED: f64 = 0.6;

/// The distance by which rivers that end in no other river are longer than on the map, in distances between cells: the
/// coast of the world wanders about that of the map.
const BEYOND: f64 = 1.5;

/// The points of each river of a map, from source to mouth: east, south, and the height of the bed, in metres.
pub fn courses(map: &FmgMap, heights: &Grid) -> Vec<Vec<[f64; 3]>> {
    let rivers = map.rivers.iter().zip(0u64..);
    rivers
        .map(|(river, number)| {
            let mut points = river.points.clone();
            if let (None, [.., before, end]) = (river.parent, &points[..]) {
                let along = [end[0] - before[0], end[1] - before[1]];
                let share = BEYOND * map.spacing / libm::hypot(along[0], along[1]).max(1e-6);
                points.push([end[0] + share * along[0], end[1] + share * along[1]]);
            }
            let mut lowest = f64::INFINITY;
            let bent = bent(points, number);
            bent.into_iter()
                .map(|at| {
                    lowest = lowest.min((BED * height(heights, at)).max(0.0));
                    [at[0], at[1], lowest]
                })
                .collect()
        })
        .collect()
}

/// A line with further points beside the middles of its parts, again and again. Its own points stay.
fn bent(mut points: Vec<[f64; 2]>, number: u64) -> Vec<[f64; 2]> {
    for halving in 0..HALVINGS {
        let mut next = Vec::with_capacity(2 * points.len());
        for (ends, place) in points.windows(2).zip(0u64..) {
            let [[ax, ay], [bx, by]] = [ends[0], ends[1]];
            let aside = BEND * (2.0 * Random::new(number << 8 | halving, place).share() - 1.0);
            next.push([ax, ay]);
            next.push([0.5 * (ax + bx) - aside * (by - ay), 0.5 * (ay + by) + aside * (bx - ax)]);
        }
        next.extend(points.last());
        points = next;
    }
    points
}

/// The height at a position; beyond the samples that of their border.
fn height(heights: &Grid, [east, south]: [f64; 2]) -> f64 {
    let window = heights.window();
    let inside = |at: f64, first: i64, count: usize| {
        let first = first as f64 * window.cell;
        // Not on the last sample, which no cell begins at.
        at.clamp(first, first + (count as f64 - 1.001).max(0.0) * window.cell)
    };
    let at = [inside(east, window.x, window.width), inside(south, window.y, window.height)];
    placement::height(heights, at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;

    #[test]
    fn bends_keep_the_points_and_the_length_about() {
        let line = vec![[0.0, 0.0], [1000.0, 0.0], [1000.0, 500.0]];
        let made = bent(line.clone(), 3);
        assert_eq!(made.len(), 2 * 16 + 1);
        assert!([made[0], made[16], made[32]] == line[..], "{made:?}");
        let length: f64 =
            made.windows(2).map(|ends| libm::hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1])).sum();
        assert!((1500.0..1800.0).contains(&length), "{length}");
        assert!(made != bent(line, 4));
    }

    #[test]
    fn heights_go_on_beyond_the_border() {
        let mut grid = Grid::filled(Window::new(3, 2, 10.0).at(-1, 0), 0.0f32);
        for j in 0..2 {
            (grid[(0, j)], grid[(1, j)], grid[(2, j)]) = (1.0, 2.0, 4.0);
        }
        for (at, expect) in [([-10.0, 0.0], 1.0), ([5.0, 0.0], 3.0), ([0.0, 5.0], 2.0), ([90.0, -5.0], 4.0)] {
            assert!((height(&grid, at) - expect).abs() < 0.01, "{at:?}");
        }
    }
}

//! Crossings of lines with shores. Each crossing becomes a point of both.

use std::collections::HashMap;

use super::given::snapped;

/// A shore: an open line, or a ring whose last point repeats its first.
pub type Path = Vec<[f64; 2]>;

/// Length of land between two stretches of water, in samples, below which a line that ends in the water is cut before
/// that land.
const SPIT: f64 = 1.0;

/// A crossing of a segment with a shore.
#[derive(Clone, Copy)]
struct Crossing {
    /// The position along the segment, 0 to 1.
    along: f64,
    /// The line of the shore.
    line: u32,
    segment: u32,
    other: f64,
    at: [f64; 2],
}

/// An index of lines by the squares of one sample that their segments touch, and a list of points to insert into them.
pub struct Joints<'a> {
    lines: &'a [Path],
    /// The water of each line.
    waters: &'a [u32],
    squares: HashMap<[i64; 2], Vec<(u32, u32)>>,
    /// Line, segment, position along it (0 to 1), and the point.
    found: Vec<(u32, u32, f64, [f64; 2])>,
    /// Whether crossings are snapped.
    is_snapped: bool,
}

impl<'a> Joints<'a> {
    /// An index of `lines`, whose points are columns and rows. `waters` has, for each line, the number of the water
    /// whose shore it is.
    #[must_use]
    pub fn new(lines: &'a [Path], waters: &'a [u32]) -> Joints<'a> {
        let mut squares: HashMap<[i64; 2], Vec<(u32, u32)>> = HashMap::new();
        for (k, line) in lines.iter().enumerate() {
            for (i, pair) in line.windows(2).enumerate() {
                touched(pair[0], pair[1], |square| squares.entry(square).or_default().push((k as u32, i as u32)));
            }
        }
        Joints { lines, waters, squares, found: Vec::new(), is_snapped: false }
    }

    /// The same index, with crossings that have the same bits in every window.
    #[must_use]
    pub fn snapped(self) -> Joints<'a> {
        Joints { is_snapped: true, ..self }
    }

    /// The crossing at which a path that ends in a water enters it. This is the last crossing with the shore of
    /// `water`, or an earlier one if the path leaves the water for less than a sample after it. Returns the index of
    /// the path's segment, the position along it (0 to 1), and the point, which is also inserted into the shore.
    pub fn entry(&mut self, path: &[[f64; 3]], water: u32) -> Option<(usize, f64, [f64; 2])> {
        let pairs = path.windows(2).enumerate();
        let crossings: Vec<_> =
            pairs.flat_map(|(k, pair)| self.crossings(pair, water).map(move |found| (k, found))).collect();
        let mut entry = crossings.len().checked_sub(1)?;
        while let Some(earlier) = entry.checked_sub(2) {
            let [out, into] = [entry - 1, entry].map(|k| crossings[k].1.at);
            if libm::hypot(into[0] - out[0], into[1] - out[1]) >= SPIT {
                break;
            }
            entry = earlier;
        }
        let (k, Crossing { along, line, segment, other, at }) = crossings[entry];
        let ends = &self.lines[line as usize][segment as usize..segment as usize + 2];
        if at != ends[0] && at != ends[1] {
            self.found.push((line, segment, other, at));
        }
        Some((k, along, at))
    }

    /// The crossings of a segment with the shore of a water, in order along the segment.
    fn crossings(&self, pair: &[[f64; 3]], water: u32) -> impl Iterator<Item = Crossing> {
        let [a, b] = [pair[0], pair[1]].map(|[x, y, _]| [x, y]);
        let mut found: Vec<(f64, u32, u32, f64)> = Vec::new();
        touched(a, b, |square| {
            for (line, segment) in self.squares.get(&square).into_iter().flatten() {
                let path = &self.lines[*line as usize];
                let (c, d) = (path[*segment as usize], path[*segment as usize + 1]);
                if self.waters[*line as usize] == water
                    && let Some([along, other]) = crossing(a, b, c, d)
                {
                    found.push((along, *line, *segment, other));
                }
            }
        });
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        // Several squares may list the same segment, and two segments may meet in one point.
        found.dedup_by_key(|found| found.0);
        found.into_iter().map(|(along, line, segment, other)| {
            let ends = &self.lines[line as usize][segment as usize..segment as usize + 2];
            let at = match other {
                // At an end of the segment, the point already exists.
                0.0 => ends[0],
                1.0 => ends[1],
                other => {
                    let at = [0, 1].map(|c| ends[0][c] + (ends[1][c] - ends[0][c]) * other);
                    if self.is_snapped { at.map(snapped) } else { at }
                }
            };
            Crossing { along, line, segment, other, at }
        })
    }

    /// The nearest point of a water's shore within a few samples.
    #[must_use]
    pub fn nearest(&self, [x, y]: [f64; 2], water: u32) -> Option<[f64; 2]> {
        let (column, row) = (x.floor() as i64, y.floor() as i64);
        let mut best: Option<(f64, [f64; 2])> = None;
        // On coarse levels, inlets of a given network may be too narrow for the samples to show.
        let reach = if self.is_snapped { 6 } else { 3 };
        for square in (-reach..=reach).flat_map(|v| (-reach..=reach).map(move |u| [column + u, row + v])) {
            for (line, segment) in self.squares.get(&square).into_iter().flatten() {
                let at = self.lines[*line as usize][*segment as usize];
                let far = (at[0] - x) * (at[0] - x) + (at[1] - y) * (at[1] - y);
                if self.waters[*line as usize] == water && best.is_none_or(|(least, _)| far < least) {
                    best = Some((far, at));
                }
            }
        }
        best.map(|(_, at)| at)
    }

    /// The points to insert into the lines.
    #[must_use]
    pub fn into_points(self) -> Points {
        Points(self.found)
    }
}

/// Points to insert into lines.
pub struct Points(Vec<(u32, u32, f64, [f64; 2])>);

impl Points {
    /// Inserts the points.
    pub fn insert(mut self, lines: &mut [Path]) {
        // From the end of each line, so that indices of earlier segments stay valid.
        self.0.sort_by(|a, b| (b.0, b.1).cmp(&(a.0, a.1)).then(b.2.total_cmp(&a.2)));
        for (line, segment, _, at) in self.0 {
            let path = &mut lines[line as usize];
            let behind = segment as usize + 1;
            if path[behind] != at {
                path.insert(behind, at);
            }
        }
    }
}

/// The squares between samples that the bounding box of a segment touches.
fn touched(a: [f64; 2], b: [f64; 2], mut visit: impl FnMut([i64; 2])) {
    let span = |c: usize| (a[c].min(b[c]).floor() as i64, a[c].max(b[c]).floor() as i64);
    let ((west, east), (north, south)) = (span(0), span(1));
    for row in north..=south {
        for column in west..=east {
            visit([column, row]);
        }
    }
}

/// The positions along each of two segments, 0 to 1, at which they cross.
fn crossing(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> Option<[f64; 2]> {
    let [ux, uy] = [b[0] - a[0], b[1] - a[1]];
    let [vx, vy] = [d[0] - c[0], d[1] - c[1]];
    let turn = ux * vy - uy * vx;
    if turn == 0.0 {
        return None;
    }
    let [wx, wy] = [c[0] - a[0], c[1] - a[1]];
    let (along, other) = ((wx * vy - wy * vx) / turn, (wx * uy - wy * ux) / turn);
    ((0.0..=1.0).contains(&along) && (0.0..=1.0).contains(&other)).then_some([along, other])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crossing_is_a_point_of_both() {
        let mut lines = vec![vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0]]];
        let mut joints = Joints::new(&lines, &[7]);
        let river = [[5.0, -4.0, 9.0], [5.5, -1.0, 8.0], [4.5, 1.0, 7.0], [5.0, 4.0, 7.0]];
        let (segment, along, at) = joints.entry(&river, 7).unwrap();
        assert_eq!((segment, along, at), (1, 0.5, [5.0, 0.0]));
        let other = joints.entry(&[[2.0, -1.0, 0.0], [2.0, 1.0, 0.0]], 7).unwrap();
        assert_eq!(other.2, [2.0, 0.0]);
        assert_eq!(joints.entry(&[[2.0, 2.0, 0.0], [3.0, 8.0, 0.0]], 7), None);
        assert_eq!(joints.entry(&river, 8), None);
        assert_eq!(joints.nearest([10.5, 11.0], 7), Some([10.0, 10.0]));
        joints.into_points().insert(&mut lines);
        assert_eq!(lines[0][..4], [[0.0, 0.0], [2.0, 0.0], [5.0, 0.0], [10.0, 0.0]]);
        assert_eq!(lines[0].len(), 7);
    }

    #[test]
    fn a_line_enters_the_water_that_it_ends_in() {
        let square = |x: f64, side: f64| vec![[x, -5.0], [x + side, -5.0], [x + side, 5.0], [x, 5.0], [x, -5.0]];
        // A pond, a strip of land, and the sea; then the same with a narrow spit instead of the strip.
        for (width, expected) in [(2.0, 20.0), (17.5, 2.0)] {
            let lines = vec![square(2.0, width), square(20.0, 40.0)];
            let mut joints = Joints::new(&lines, &[0, 0]);
            let river: Vec<[f64; 3]> = (0..30).map(|k| [f64::from(k) + 0.25, 0.5, 0.0]).collect();
            assert_eq!(joints.entry(&river, 0).unwrap().2, [expected, 0.5]);
        }
    }
}

//! Crossings of lines with shores: each crossing becomes a point of both.

use std::collections::HashMap;

use super::given::snapped;

/// A shore: an open line or a ring, whose last point repeats its first.
pub type Path = Vec<[f64; 2]>;

/// An index of lines by the squares of one sample that their segments touch, and the points to insert into them.
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
    /// An index over these lines, whose points are columns and rows; `waters` has the number of the water that each
    /// line is the shore of.
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

    /// The same with crossings that have the same bits in every window.
    #[must_use]
    pub fn snapped(self) -> Joints<'a> {
        Joints { is_snapped: true, ..self }
    }

    /// The first crossing of a path with the shore of a water: the index of the path's segment, the position along it
    /// (0 to 1), and the point. The point is also inserted into the shore.
    pub fn first(&mut self, path: &[[f64; 3]], water: u32) -> Option<(usize, f64, [f64; 2])> {
        for (k, pair) in path.windows(2).enumerate() {
            let [a, b] = [pair[0], pair[1]].map(|[x, y, _]| [x, y]);
            let mut best: Option<(f64, u32, u32, f64)> = None;
            touched(a, b, |square| {
                for (line, segment) in self.squares.get(&square).into_iter().flatten() {
                    if self.waters[*line as usize] != water {
                        continue;
                    }
                    let path = &self.lines[*line as usize];
                    let (c, d) = (path[*segment as usize], path[*segment as usize + 1]);
                    if let Some([along, other]) = crossing(a, b, c, d)
                        && best.is_none_or(|best| (along, *line, *segment) < (best.0, best.1, best.2))
                    {
                        best = Some((along, *line, *segment, other));
                    }
                }
            });
            if let Some((along, line, segment, other)) = best {
                let ends = &self.lines[line as usize][segment as usize..segment as usize + 2];
                let at = match other {
                    // A crossing at an end of the segment: the point exists already.
                    0.0 => ends[0],
                    1.0 => ends[1],
                    other => {
                        let at = [0, 1].map(|c| ends[0][c] + (ends[1][c] - ends[0][c]) * other);
                        let at = if self.is_snapped { at.map(snapped) } else { at };
                        if at != ends[0] && at != ends[1] {
                            self.found.push((line, segment, other, at));
                        }
                        at
                    }
                };
                return Some((k, along, at));
            }
        }
        None
    }

    /// The nearest point of a water's shore within a few samples.
    #[must_use]
    pub fn nearest(&self, [x, y]: [f64; 2], water: u32) -> Option<[f64; 2]> {
        let (column, row) = (x.floor() as i64, y.floor() as i64);
        let mut best: Option<(f64, [f64; 2])> = None;
        // On coarse levels, inlets of a given network may be narrower than the samples show.
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
        // From the end of each line, so that the indices of earlier segments stay valid.
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
        let (segment, along, at) = joints.first(&river, 7).unwrap();
        assert_eq!((segment, along, at), (1, 0.5, [5.0, 0.0]));
        let other = joints.first(&[[2.0, -1.0, 0.0], [2.0, 1.0, 0.0]], 7).unwrap();
        assert_eq!(other.2, [2.0, 0.0]);
        assert_eq!(joints.first(&[[2.0, 2.0, 0.0], [3.0, 8.0, 0.0]], 7), None);
        assert_eq!(joints.first(&river, 8), None);
        assert_eq!(joints.nearest([10.5, 11.0], 7), Some([10.0, 10.0]));
        joints.into_points().insert(&mut lines);
        assert_eq!(lines[0][..4], [[0.0, 0.0], [2.0, 0.0], [5.0, 0.0], [10.0, 0.0]]);
        assert_eq!(lines[0].len(), 7);
    }
}

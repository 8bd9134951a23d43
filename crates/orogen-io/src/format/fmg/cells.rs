//! Cells of a map and the borders between them.

use orogen_grid::contour::line::twice_area;
use orogen_grid::hydrography::rings::nested;

use crate::format::features::Ring;

/// Maximum number of separate pieces of a coast.
const MAX_RINGS: usize = 5000;

/// Cells as polygons that share vertices.
pub struct Cells {
    /// The middles of the cells, in metres east and south.
    pub middles: Vec<[f64; 2]>,
    /// The positions of the vertices.
    pub vertices: Vec<[f64; 2]>,
    /// The vertices around each cell, and where those of the next cell begin.
    pub around: Vec<u32>,
    pub starts: Vec<usize>,
}

/// A side of a cell. `low` and `high` are its vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Side {
    pub low: u32,
    pub high: u32,
    pub cell: u32,
}

impl Cells {
    /// The vertices around a cell.
    pub fn around(&self, cell: usize) -> &[u32] {
        match (self.starts.get(cell), self.starts.get(cell + 1)) {
            (Some(&start), Some(&end)) => self.around.get(start..end).unwrap_or(&[]),
            _ => &[],
        }
    }

    /// The sides of these cells, sorted, so that the same side of two cells follows itself.
    pub fn sides(&self, cells: impl Iterator<Item = usize>) -> Vec<Side> {
        let mut sides = Vec::new();
        for cell in cells {
            let around = self.around(cell);
            let next = around.iter().cycle().skip(1);
            for (&a, &b) in around.iter().zip(next).filter(|(a, b)| a != b) {
                sides.push(Side { low: a.min(b), high: a.max(b), cell: cell as u32 });
            }
        }
        sides.sort_unstable();
        sides
    }

    /// The area of a cell, in m^2.
    pub fn area(&self, cell: usize) -> f64 {
        let mut ring: Vec<[f64; 2]> = self.around(cell).iter().map(|&v| self.vertices[v as usize]).collect();
        ring.extend(ring.first().copied());
        0.5 * twice_area(&ring).abs()
    }

    /// The polygons that these cells form together, each an outer ring and its holes, the largest first. `place` gives
    /// the position of a vertex.
    pub fn polygons(
        &self,
        cells: impl Iterator<Item = usize>,
        place: impl Fn(u32) -> [f64; 2],
    ) -> Result<Vec<Vec<Ring>>, String> {
        let mut sides = Vec::new();
        for same in self.sides(cells).chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
            if let &[side] = same {
                sides.push(self.directed(side));
            }
        }
        sides.sort_unstable();
        let rings = rings(&sides).into_iter().map(|ring| ring.into_iter().map(&place).collect::<Ring>());
        let rings: Vec<Ring> = rings.filter(|ring| twice_area(ring).abs() > 0.0).collect();
        if rings.len() > MAX_RINGS {
            return Err(format!(
                "its land or a lake has {} separate shores, and at most {MAX_RINGS} are read",
                rings.len()
            ));
        }
        Ok(nested(rings.iter().collect()))
    }

    /// The vertices of a side in the order in which the cell is on its left, with north up.
    fn directed(&self, side: Side) -> (u32, u32) {
        let [a, b] = [side.low, side.high].map(|vertex| self.vertices[vertex as usize]);
        let middle = self.middles[side.cell as usize];
        match twice_area(&[a, b, middle, a]) > 0.0 {
            true => (side.low, side.high),
            false => (side.high, side.low),
        }
    }
}

/// Joins directed sides, sorted by their starts, to rings that repeat their first vertex. Sides that form no ring are
/// left out.
fn rings(sides: &[(u32, u32)]) -> Vec<Vec<u32>> {
    let mut used = vec![false; sides.len()];
    let mut rings = Vec::new();
    for first in 0..sides.len() {
        if used[first] {
            continue;
        }
        used[first] = true;
        let (start, mut at) = sides[first];
        let mut ring = vec![start];
        while at != start {
            ring.push(at);
            let from = sides.partition_point(|side| side.0 < at);
            let next = (from..sides.len()).take_while(|&k| sides[k].0 == at).find(|&k| !used[k]);
            let Some(next) = next else { break };
            used[next] = true;
            at = sides[next].1;
        }
        if at == start && ring.len() >= 3 {
            ring.push(start);
            rings.push(ring);
        }
    }
    rings
}

/// Sets that are joined.
pub struct Sets(Vec<u32>);

impl Sets {
    pub fn new(count: usize) -> Sets {
        Sets((0..count as u32).collect())
    }

    /// The first member of the set of `one`.
    pub fn root(&mut self, one: u32) -> u32 {
        let mut at = one;
        while self.0[at as usize] != at {
            let above = self.0[self.0[at as usize] as usize];
            self.0[at as usize] = above;
            at = above;
        }
        at
    }

    /// Joins the sets of two members; the first of the smaller number stays.
    pub fn join(&mut self, one: u32, other: u32) {
        let (one, other) = (self.root(one), self.root(other));
        self.0[one.max(other) as usize] = one.min(other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squares of a side of 1 in rows of `width`.
    fn squares(width: usize, height: usize) -> Cells {
        let corner = |i: usize, j: usize| (j * (width + 1) + i) as u32;
        let cells = (0..width * height).map(|k| (k % width, k / width));
        let around: Vec<[u32; 4]> = cells
            .clone()
            .map(|(i, j)| [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)])
            .collect();
        Cells {
            middles: cells.map(|(i, j)| [i as f64 + 0.5, j as f64 + 0.5]).collect(),
            vertices: (0..(width + 1) * (height + 1))
                .map(|k| [(k % (width + 1)) as f64, (k / (width + 1)) as f64])
                .collect(),
            starts: (0..=around.len()).map(|k| 4 * k).collect(),
            around: around.into_flattened(),
        }
    }

    fn polygons(cells: &Cells, chosen: &[usize]) -> Vec<Vec<Ring>> {
        cells.polygons(chosen.iter().copied(), |vertex| cells.vertices[vertex as usize]).unwrap()
    }

    #[test]
    fn cells_form_polygons_with_holes() {
        let cells = squares(6, 4);
        // A block of 3 x 3 without its middle, and a cell beside it.
        let found = polygons(&cells, &[0, 1, 2, 6, 8, 12, 13, 14, 16]);
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
        assert_eq!(twice_area(&found[0][0]), 18.0);
        assert_eq!(twice_area(&found[0][1]), -2.0);
        assert_eq!(twice_area(&found[1][0]), 2.0);
        assert_eq!(cells.area(7), 1.0);
    }

    #[test]
    fn cells_that_touch_at_a_corner_are_covered_once() {
        let cells = squares(3, 3);
        let found = polygons(&cells, &[0, 4, 8]);
        let area: f64 = found.iter().flatten().map(|ring| twice_area(ring)).sum();
        assert_eq!(area, 6.0);
    }

    #[test]
    fn sides_without_an_end_are_left_out() {
        assert_eq!(rings(&[(0, 1), (1, 2), (2, 3)]), Vec::<Vec<u32>>::new());
        assert_eq!(rings(&[(0, 1), (1, 2), (2, 0), (2, 5)]), [vec![0, 1, 2, 0]]);
    }

    #[test]
    fn joined_sets_have_one_root() {
        let mut sets = Sets::new(5);
        sets.join(3, 4);
        sets.join(4, 1);
        assert_eq!((0..5).map(|k| sets.root(k)).collect::<Vec<_>>(), [0, 1, 2, 1, 1]);
    }
}

//! Triangles cut at a level: the part above it.

use std::collections::HashMap;

/// The share of an edge at both ends in which it is never cut, so that vertices on the level do not coincide with
/// vertices of the triangles. The error of the outline is at most this share of an edge.
const MARGIN: f64 = 1.0 / 64.0;

/// The number of a vertex that is not in the result.
pub(super) const NONE: u32 = u32::MAX;

/// Triangles above a level.
#[derive(Debug)]
pub(super) struct Clipped {
    /// The vertices in use: those above the level, and those on it where edges are cut.
    pub corners: Vec<[f32; 3]>,
    /// Triangles with the orientation of the input.
    pub triangles: Vec<[u32; 3]>,
    /// The edges of the outline, each with the triangles to its left.
    pub around: Vec<[u32; 2]>,
}

/// Cuts triangles at the level `z`, and keeps the part above it. `around` is the border of the triangles,
/// counter-clockwise, edge by edge.
///
/// A vertex at the level counts as below it, and edges are cut strictly inside. So if each edge of the input has a
/// triangle on both sides, except along the border, the same is true of the result.
pub(super) fn clip(corners: &[[f32; 3]], triangles: &[[u32; 3]], around: &[[u32; 2]], z: f32) -> Clipped {
    let vertices = vec![NONE; corners.len()];
    let mut cut = Cut { corners, z, made: Vec::new(), vertices, cuts: HashMap::new() };
    let mut clipped = Clipped { corners: Vec::new(), triangles: Vec::new(), around: Vec::new() };
    for triangle in triangles {
        let is_above = triangle.map(|corner| cut.is_above(corner));
        let mut polygon = Vec::with_capacity(4);
        let (mut leaves, mut enters) = (None, None);
        for k in 0..3 {
            let next = (k + 1) % 3;
            if is_above[k] {
                polygon.push(cut.vertex(triangle[k]));
            }
            if is_above[k] != is_above[next] {
                let vertex = cut.between(triangle[k], triangle[next]);
                polygon.push(vertex);
                *(if is_above[k] { &mut leaves } else { &mut enters }) = Some(vertex);
            }
        }
        for k in 2..polygon.len() {
            clipped.triangles.push([polygon[0], polygon[k - 1], polygon[k]]);
        }
        if let (Some(from), Some(to)) = (leaves, enters) {
            clipped.around.push([from, to]);
        }
    }
    for [from, to] in around {
        match [cut.is_above(*from), cut.is_above(*to)] {
            [false, false] => {}
            [true, true] => clipped.around.push([cut.vertex(*from), cut.vertex(*to)]),
            [true, false] => clipped.around.push([cut.vertex(*from), cut.between(*from, *to)]),
            [false, true] => clipped.around.push([cut.between(*from, *to), cut.vertex(*to)]),
        }
    }
    clipped.corners = cut.made;
    clipped
}

/// Triangles divided at a level.
#[derive(Debug)]
pub(super) struct Parted {
    /// The vertices of the triangles, with the same numbers, followed by the vertices on the level where edges are cut.
    pub corners: Vec<[f32; 3]>,
    /// Triangles above the level, with the orientation of the input.
    pub above: Vec<[u32; 3]>,
    /// Triangles below the level, with the orientation of the input.
    pub below: Vec<[u32; 3]>,
    /// The lines between the two parts, edge by edge, with the triangles above the level to their left.
    pub between: Vec<[u32; 2]>,
}

/// Divides triangles at the level `z`. Both parts share the vertices between them, so together they are the surface
/// that was cut. Vertices at the level are treated as in [`clip`].
pub(super) fn part(corners: &[[f32; 3]], triangles: &[[u32; 3]], z: f32) -> Parted {
    let vertices = (0..corners.len() as u32).collect();
    let mut cut = Cut { corners, z, made: corners.to_vec(), vertices, cuts: HashMap::new() };
    let mut parted = Parted { corners: Vec::new(), above: Vec::new(), below: Vec::new(), between: Vec::new() };
    for triangle in triangles {
        let is_above = triangle.map(|corner| cut.is_above(corner));
        let mut polygons = [Vec::with_capacity(4), Vec::with_capacity(4)];
        let (mut leaves, mut enters) = (None, None);
        for k in 0..3 {
            let next = (k + 1) % 3;
            polygons[usize::from(is_above[k])].push(triangle[k]);
            if is_above[k] != is_above[next] {
                let vertex = cut.between(triangle[k], triangle[next]);
                polygons.iter_mut().for_each(|polygon| polygon.push(vertex));
                *(if is_above[k] { &mut leaves } else { &mut enters }) = Some(vertex);
            }
        }
        let [below, above] = polygons;
        for (polygon, out) in [(below, &mut parted.below), (above, &mut parted.above)] {
            for k in 2..polygon.len() {
                out.push([polygon[0], polygon[k - 1], polygon[k]]);
            }
        }
        if let (Some(from), Some(to)) = (leaves, enters) {
            parted.between.push([from, to]);
        }
    }
    parted.corners = cut.made;
    parted
}

/// Vertices of the result, each made once, in the order of their first use.
struct Cut<'a> {
    corners: &'a [[f32; 3]],
    z: f32,
    made: Vec<[f32; 3]>,
    /// The numbers of vertices of the triangles in the result.
    vertices: Vec<u32>,
    cuts: HashMap<[u32; 2], u32>,
}

impl Cut<'_> {
    fn is_above(&self, corner: u32) -> bool {
        self.corners[corner as usize][2] > self.z
    }

    fn vertex(&mut self, corner: u32) -> u32 {
        let number = &mut self.vertices[corner as usize];
        if *number == NONE {
            *number = push(&mut self.made, self.corners[corner as usize]);
        }
        *number
    }

    /// The vertex on the level between two vertices, of which one is above it.
    fn between(&mut self, a: u32, b: u32) -> u32 {
        let [above, below] = if self.is_above(a) { [a, b] } else { [b, a] };
        let [from, to] = [above, below].map(|corner| self.corners[corner as usize].map(f64::from));
        let z = self.z;
        let made = &mut self.made;
        *self.cuts.entry([above, below]).or_insert_with(|| {
            let share = ((from[2] - f64::from(z)) / (from[2] - to[2])).clamp(MARGIN, 1.0 - MARGIN);
            let along = |axis: usize| (from[axis] + (to[axis] - from[axis]) * share) as f32;
            push(made, [along(0), along(1), z])
        })
    }
}

fn push(corners: &mut Vec<[f32; 3]>, corner: [f32; 3]) -> u32 {
    corners.push(corner);
    (corners.len() - 1) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_parts_of_a_pyramid_share_the_line_between_them() {
        let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0], [1.0, 1.0, 4.0]];
        let triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        let parted = part(&corners, &triangles, 2.0);
        assert_eq!((parted.above.len(), parted.below.len(), parted.corners.len()), (4, 8, 9));
        // Around the upper part counter-clockwise, with it to the left.
        let turn: f32 = parted.between.iter().fold(0.0, |sum, [from, to]| {
            let [a, b] = [from, to].map(|corner| parted.corners[*corner as usize]);
            assert_eq!([a[2], b[2]], [2.0; 2]);
            sum + (a[0] - 1.0) * (b[1] - 1.0) - (a[1] - 1.0) * (b[0] - 1.0)
        });
        assert_eq!(turn, 2.0);
        let area = |triangles: &[[u32; 3]]| -> f32 {
            let each = triangles.iter().map(|triangle| {
                let [a, b, c] = triangle.map(|corner| parted.corners[corner as usize]);
                ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
            });
            each.sum()
        };
        assert_eq!([area(&parted.above), area(&parted.below)], [1.0, 3.0]);
        let whole = part(&corners, &triangles, -1.0);
        assert!(whole.above == triangles && whole.below.is_empty() && whole.between.is_empty());
    }

    #[test]
    fn a_pyramid_is_cut_where_its_sides_are_and_never_at_a_vertex() {
        // A summit of 4 m in the middle of a square with sides of 2 m, which are at the level 0.
        let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0], [1.0, 1.0, 4.0]];
        let triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        let around = [[0, 1], [1, 2], [2, 3], [3, 0]];
        let half = clip(&corners, &triangles, &around, 2.0);
        assert_eq!((half.corners.len(), half.triangles.len(), half.around.len()), (5, 4, 4));
        let cut = half.corners.iter().filter(|corner| corner[2] == 2.0);
        assert!(cut.clone().count() == 4 && cut.flat_map(|[x, y, _]| [x, y]).all(|at| [0.5, 1.5].contains(at)));
        // At their level, the sides are cut a little inside.
        let low = clip(&corners, &triangles, &around, 0.0);
        assert!(low.corners.iter().all(|[x, y, _]| *x > 0.01 && *y > 0.01));
        // All of it, and nothing.
        let all = clip(&corners, &triangles, &around, -1.0);
        assert_eq!((all.corners.len(), all.triangles.len(), all.around.len()), (5, 4, 4));
        assert!(clip(&corners, &triangles, &around, 4.0).triangles.is_empty());
    }
}

//! The parts of the land in the 3D view: the whole land, and rings of detail inside each other.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3};
use orogen::Window;

use super::mesh::Tile;
use crate::view::rings::band;

/// The place of a part, like `Part` in `relief.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Placement {
    /// West, north, width and depth in the view.
    pub rect: [f32; 4],
    /// The rectangle that a finer part covers: its first and last position, from 0, 0 to 1, 1. Empty if the first is
    /// behind the last.
    pub hole: [f32; 4],
    /// The position in the coarser part: offset and scale.
    pub coarser: [f32; 4],
    /// Number of vertices of the coarser part along its sides; the width of the border, 0 for the whole land.
    pub border: [f32; 4],
}

/// No hole.
const FILLED: [f32; 4] = [2.0, 2.0, -1.0, -1.0];

/// Number of cells of a ring at its border that also the coarser part draws, so that no gap opens between both. There,
/// the ring has the heights of the coarser part.
const OVERLAP: f32 = 2.0;

/// The sides of a window in metres: west, north, width, depth.
fn metres(window: &Window) -> [f64; 4] {
    let side = |count: usize| (count.max(2) - 1) as f64 * window.cell;
    [window.x as f64 * window.cell, window.y as f64 * window.cell, side(window.width), side(window.height)]
}

/// The position of a window in another one: offset and scale, as shares of the other.
fn position_in(inner: &Window, outer: &Window) -> [f32; 4] {
    let ([x, y, width, depth], [x0, y0, of_width, of_depth]) = (metres(inner), metres(outer));
    [(x - x0) / of_width, (y - y0) / of_depth, width / of_width, depth / of_depth].map(|share| share as f32)
}

/// The places of the parts, from the whole land to the finest ring. `half` is half the width and depth of the land in
/// the view, `vertices` are the numbers of vertices of each part along its sides.
pub fn places(windows: &[Window], half: [f32; 2], vertices: &[[usize; 2]]) -> Vec<Placement> {
    let Some(land) = windows.first() else { return Vec::new() };
    let place = |k: usize| {
        let window = &windows[k];
        let [x, y, width, depth] = position_in(window, land);
        let outer = &windows[k.saturating_sub(1)];
        let hole = windows.get(k + 1).map_or(FILLED, |finer| {
            let [x, y, width, depth] = position_in(finer, window);
            let inset = [finer.width, finer.height].map(|count| OVERLAP / (count.max(2) - 1) as f32);
            let [inset_x, inset_y] = [width * inset[0], depth * inset[1]];
            [x + inset_x, y + inset_y, x + width - inset_x, y + depth - inset_y]
        });
        let [columns, rows] = vertices[k.saturating_sub(1)].map(|count| count as f32);
        let border = [window.width, window.height].map(|count| band(count) as f32 / (count.max(2) - 1) as f32);
        Placement {
            rect: [(2.0 * x - 1.0) * half[0], (2.0 * y - 1.0) * half[1], 2.0 * width * half[0], 2.0 * depth * half[1]],
            hole,
            coarser: position_in(window, outer),
            border: if k == 0 { [columns, rows, 0.0, 0.0] } else { [columns, rows, border[0], border[1]] },
        }
    };
    (0..windows.len()).map(place).collect()
}

/// The ranges of indices of the visible tiles: those that are neither in the hole nor outside of the picture. Their
/// heights in the view are between `levels`.
pub fn visible(
    tiles: &[Tile],
    place: &Placement,
    levels: [f32; 2],
    matrix: &Mat4,
    range: impl Fn(&Tile) -> Range<u32>,
) -> Vec<Range<u32>> {
    let mut ranges: Vec<Range<u32>> = Vec::new();
    for tile in tiles {
        let [[u, v], [u1, v1]] = tile.rect;
        let [left, top, right, bottom] = place.hole;
        let is_covered = u >= left && v >= top && u1 <= right && v1 <= bottom;
        if is_covered || is_outside(tile, place, levels, matrix) {
            continue;
        }
        let next = range(tile);
        match ranges.last_mut() {
            Some(last) if last.end == next.start => last.end = next.end,
            _ => ranges.push(next),
        }
    }
    ranges
}

/// Whether all of a tile is on the outer side of one of the planes around the picture.
fn is_outside(tile: &Tile, place: &Placement, levels: [f32; 2], matrix: &Mat4) -> bool {
    let [west, north, width, depth] = place.rect;
    let corner = |k: usize| {
        let [u, v] = [tile.rect[k & 1][0], tile.rect[k >> 1 & 1][1]];
        *matrix * Vec3::new(west + u * width, levels[k >> 2], north + v * depth).extend(1.0)
    };
    let corners: [_; 8] = std::array::from_fn(corner);
    let all = |outside: fn(&glam::Vec4) -> bool| corners.iter().all(outside);
    all(|c| c.x > c.w) || all(|c| c.x < -c.w) || all(|c| c.y > c.w) || all(|c| c.y < -c.w) || all(|c| c.z > c.w)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::camera::{Camera, Side};
    use crate::window::mesh::Mesh;

    fn windows() -> [Window; 2] {
        [Window::new(101, 101, 10.0), Window::new(81, 81, 5.0).at(40, 60)]
    }

    #[test]
    fn places_meet_at_their_borders() {
        let places = places(&windows(), [1.0; 2], &[[101; 2], [81; 2]]);
        let close = |a: [f32; 4], b: [f32; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(close(places[0].rect, [-1.0, -1.0, 2.0, 2.0]) && places[0].border[2] == 0.0);
        assert!(close(places[1].rect, [-0.6, -0.4, 0.8, 0.8]), "{places:?}");
        // Two cells of 400 m / 80, as shares of a kilometre, are left to both.
        assert!(close(places[0].hole, [0.21, 0.31, 0.59, 0.69]), "{places:?}");
        assert!(close(places[1].coarser, [0.2, 0.3, 0.4, 0.4]) && places[1].hole == FILLED);
    }

    #[test]
    fn only_visible_tiles_are_drawn() {
        let mesh = Mesh::new(161, 161);
        let places = places(&windows(), [1.0; 2], &[[161; 2], [81; 2]]);
        let count = |place: &Placement, camera: Camera| {
            let ranges = visible(&mesh.tiles, place, [0.0, 0.1], &camera.matrix(1.0), |tile| tile.ground.clone());
            ranges.iter().map(|range| range.len()).sum::<usize>()
        };
        let above = Camera::of_side(Side::Above);
        assert_eq!(count(&places[1], above), mesh.ground.len());
        let holed = count(&places[0], above);
        assert!(holed < mesh.ground.len() && holed > mesh.ground.len() * 3 / 4, "{holed}");
        let close = Camera { distance: 0.1, ..above };
        assert!(count(&places[0], close) < mesh.ground.len() / 8);
    }
}

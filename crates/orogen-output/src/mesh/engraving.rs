//! Letters engraved in the southern wall of a solid.

use super::clip::NONE;
use super::monotone;
use super::solid::Solid;
use super::wall_text::WallText;
use orogen_grid::error::{Error, ErrorKind, Result};

/// Depth of engraved letters in millimetres, unless the wall is thin.
const DEPTH: f32 = 0.6;

/// Minimum thickness of the solid behind engraved letters, in millimetres.
const BEHIND: f32 = 0.2;

impl Solid {
    /// Engraves letters in the middle of the southern wall, which goes from the western to the eastern side; returns
    /// their size in millimetres per em. In a hollow solid with walls of `hollow` millimetres, letters are at most half
    /// as deep as the wall.
    ///
    /// The wall is triangulated again around the letters, so the solid stays one closed surface.
    ///
    /// # Errors
    /// If the font lacks a letter, if there are no letters or too many, or if the wall has no room for them.
    pub fn engrave(&mut self, text: &str, hollow: Option<f64>) -> Result<f64> {
        let depth = hollow.map_or(DEPTH, |wall| DEPTH.min(0.5 * wall as f32));
        let mut walls = self.southern_walls();
        let near = self.least_height(depth + BEHIND);
        walls.iter_mut().for_each(|wall| wall.height = wall.height.min(near));
        let text = WallText::new(text, &walls, self.size()[0], true)?;
        let mut parted = text.parted();
        let [columns, rows] = text.lattice;
        self.numbered(2 * parted.corners.len())?;
        self.triangles.retain(|triangle| triangle.iter().any(|corner| self.corners[*corner as usize][1] != 0.0));
        // The upper and the lower edge of the wall, from west to east.
        let along = |is_upper: bool| -> Vec<u32> {
            let all = self.corners.iter().enumerate();
            let mut line: Vec<u32> = all
                .filter(|(_, [_, north, up])| *north == 0.0 && (*up > 0.0) == is_upper)
                .map(|(corner, _)| corner as u32)
                .collect();
            line.sort_by(|a, b| self.corners[*a as usize][0].total_cmp(&self.corners[*b as usize][0]));
            line
        };
        let [upper, lower] = [along(true), along(false)];
        let (Some((start, rest)), true) = (lower.split_first(), upper.len() > 1) else { return Err(no_wall()) };
        let Some((end, between)) = rest.split_last() else { return Err(no_wall()) };
        let [west, east] = [*start, *end].map(|corner| self.corners[corner as usize][0]);
        // A vertex of the lower edge exactly below a side of the lattice would be collinear with it.
        let step = 0.1 * (parted.corners[1][0] - parted.corners[0][0]);
        let is_in_line = |x: f32| between.iter().any(|corner| self.corners[*corner as usize][0] == x);
        while is_in_line(parted.corners[0][0]) || is_in_line(parted.corners[columns - 1][0]) {
            parted.corners.iter_mut().for_each(|corner| corner[0] += step);
        }
        if parted.corners[0][0] <= west || parted.corners[columns - 1][0] >= east {
            return Err(no_wall());
        }
        let face = self.copies(&parted.corners, &parted.below, 0.0);
        let floor = self.copies(&parted.corners, &parted.above, depth);
        for [from, to] in &parted.between {
            let [[a, b], [c, d]] = [&face, &floor].map(|copy| [from, to].map(|corner| copy[*corner as usize]));
            self.triangles.extend([[a, b, d], [a, d, c]]);
        }
        // Around the lattice of the letters: down its western side, along the bottom, and up the eastern side; and
        // along its top.
        let at = |column: usize, row: usize| face[row * columns + column];
        let under: Vec<u32> = (0..rows)
            .map(|row| at(0, row))
            .chain((1..columns).map(|column| at(column, rows - 1)))
            .chain((0..rows - 1).rev().map(|row| at(columns - 1, row)))
            .collect();
        let over: Vec<u32> = (0..columns).map(|column| at(column, 0)).collect();
        let corners = &self.corners;
        let place = |corner: u32| {
            let [x, _, z] = corners[corner as usize];
            [x, z].map(f64::from)
        };
        let mut around = monotone::triangles(&place, [*start, *end], &upper, &over);
        around.extend(monotone::triangles(&place, [*start, *end], &under, between));
        self.triangles.append(&mut around);
        Ok(text.size)
    }

    /// The minimum height of the surface within this distance from the southern wall.
    fn least_height(&self, distance: f32) -> f32 {
        let mut least = f32::INFINITY;
        for triangle in &self.triangles {
            let corners = triangle.map(|corner| self.corners[corner as usize]);
            if corners.iter().any(|[_, _, up]| *up == 0.0) || corners.iter().all(|[_, north, _]| *north > distance) {
                continue;
            }
            for k in 0..3 {
                let [a, b] = [corners[k], corners[(k + 1) % 3]];
                if a[1] <= distance {
                    least = least.min(a[2]);
                }
                if (a[1] <= distance) != (b[1] <= distance) {
                    least = least.min(a[2] + (b[2] - a[2]) * (distance - a[1]) / (b[1] - a[1]));
                }
            }
        }
        least
    }

    /// Adds triangles of the wall at a distance from its face; returns the numbers of their vertices.
    fn copies(&mut self, corners: &[[f32; 3]], triangles: &[[u32; 3]], north: f32) -> Vec<u32> {
        let mut numbers = vec![NONE; corners.len()];
        for triangle in triangles {
            let made = triangle.map(|corner| {
                if numbers[corner as usize] == NONE {
                    let [x, z, _] = corners[corner as usize];
                    numbers[corner as usize] = self.push([x, north, z]);
                }
                numbers[corner as usize]
            });
            self.triangles.push(made);
        }
        numbers
    }
}

fn no_wall() -> Error {
    Error::new(ErrorKind::Request, "there is no straight side for the letters of --text")
}

//! Closed solids for printing, made from surfaces.
//!
//! Millimetres; x east, y north, z up, with the south-western corner of the window at the origin. The surface is closed
//! by walls and a flat base, so that the solid is watertight: every edge has a triangle on both sides, and every normal
//! points outward.

use super::bounds::bounds;
use super::cavity::Ceiling;
use super::clip::{Clipped, NONE, clip, part};
use super::outline::sides;
use super::scale::Scale;
use super::surface::Surface;
use super::wall_text::{StraightWall, WallText};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::number;

/// How far letters stand out of their wall, and how far they reach into it, in millimetres.
pub const RAISED: f32 = 0.6;
const SUNK: f32 = 0.4;

/// Letters below this size are hard to print, in millimetres per em.
pub const LEGIBLE: f64 = 4.0;

/// Dimensions of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct Print {
    /// Length of the longer side in millimetres, between the centers of its first and last sample.
    pub size: f64,
    /// Thickness of the base in millimetres, below the lowest sample or the cut level; 3 by default.
    pub base: f64,
    /// The level in metres, before exaggeration, above which the land is kept; by default all land is kept.
    pub cut: Option<f64>,
    /// Minimum thickness in millimetres of the walls and the ceiling around a cavity that is open below; without it the
    /// solid is full.
    pub hollow: Option<f64>,
}

impl Print {
    /// A solid whose longer side has this length in millimetres.
    pub fn new(size: f64) -> Print {
        Print { size, base: 3.0, cut: None, hollow: None }
    }

    /// Sets the thickness of the base, in millimetres.
    pub fn with_base(self, base: f64) -> Print {
        Print { base, ..self }
    }

    /// Keeps only the land above a level in metres. The outline of the solid follows the land, and its base begins at
    /// the level.
    pub fn with_cut(self, level: f64) -> Print {
        Print { cut: Some(level), ..self }
    }

    /// Adds a cavity, with walls of at least this thickness in millimetres.
    pub fn with_hollow(self, wall: f64) -> Print {
        Print { hollow: Some(wall), ..self }
    }
}

/// A closed solid.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// The vertices in millimetres: east, north, up.
    pub corners: Vec<[f32; 3]>,
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Solid {
    /// The solid of a surface.
    ///
    /// # Errors
    /// If there are holes, no land above the cut, no room for a cavity, or more vertices than 32 bits can number.
    pub fn new(surface: &Surface, print: &Print) -> Result<Solid> {
        let grid = surface.grid;
        let holes = grid.data().iter().filter(|height| !height.is_finite()).count();
        if holes > 0 {
            let message = format!(
                "{holes} of {} samples are nodata, and a solid must not have holes; choose a window or a layer without nodata",
                grid.data().len()
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        let scale = Scale::new(surface, [print.size, print.base], print.cut);
        let mut solid = Solid::top(surface, &scale);
        let sides = sides(surface);
        let around = sides.concat();
        let level = scale.base as f32;
        if let Some(cut) = print.cut.filter(|_| solid.corners.iter().any(|[_, _, up]| *up <= level)) {
            // Every edge is cut at most once, and all vertices have a copy.
            solid.numbered(7 * solid.corners.len())?;
            let around: Vec<[u32; 2]> = pairs(&around).map(|(from, to)| [from, to]).collect();
            let clipped = clip(&solid.corners, &solid.triangles, &around, level);
            if clipped.triangles.is_empty() {
                let [_, [_, highest, _]] = surface.bounds();
                let message = format!(
                    "no land is above the cut: its level is {} m, and the highest sample is at {} m",
                    number(cut),
                    number((highest / surface.exaggeration).into())
                );
                return Err(Error::new(ErrorKind::Request, message));
            }
            drop(solid);
            let mut solid = Solid { corners: Vec::new(), triangles: Vec::new() };
            match print.hollow {
                Some(wall) => solid.extrude_hollow(&clipped, surface, &scale, wall)?,
                None => solid.extrude(&clipped, |[x, y, _]| [x, y, 0.0]),
            }
            return Ok(solid);
        }
        match print.hollow {
            Some(wall) => {
                let ceiling = Ceiling::of(surface, &scale, wall, false)?;
                solid.numbered(around.len() + 3 * ceiling.heights.len())?;
                solid.close_hollow(&sides, &ceiling);
            }
            None => {
                solid.numbered(around.len() + 1)?;
                solid.close(&around);
            }
        }
        Ok(solid)
    }

    /// Adds raised letters in the middle of the southern wall, or of its straight piece where they are largest; returns
    /// their size in millimetres per em.
    ///
    /// The letters are separate bodies that reach into the wall; slicers join them with it.
    ///
    /// # Errors
    /// If the font lacks a letter, if there are no letters or too many, or if no wall has room for them.
    pub fn letter(&mut self, text: &str) -> Result<f64> {
        let text = WallText::new(text, &self.southern_walls(), self.size()[0], false)?;
        let mut front = text.letters();
        self.numbered(2 * front.corners.len())?;
        front.corners.iter_mut().for_each(|corner| *corner = [corner[0], -RAISED, corner[1]]);
        self.extrude(&front, |[x, _, z]| [x, SUNK, z]);
        Ok(text.size)
    }

    /// The straight walls along the southern side of the window, from west to east.
    pub(super) fn southern_walls(&self) -> Vec<StraightWall> {
        // In each piece of a wall, one of the two triangles contains its upper edge.
        let mut pieces: Vec<StraightWall> = Vec::new();
        for triangle in &self.triangles {
            let corners = triangle.map(|corner| self.corners[corner as usize]);
            let mut upper = corners.iter().filter(|[_, _, up]| *up > 0.0);
            if let (Some(a), Some(b), None) = (upper.next(), upper.next(), upper.next())
                && corners.iter().all(|[_, north, _]| *north == 0.0)
                && a[0] != b[0]
            {
                pieces.push(StraightWall { west: a[0].min(b[0]), east: a[0].max(b[0]), height: a[2].min(b[2]) });
            }
        }
        pieces.sort_by(|a, b| a.west.total_cmp(&b.west));
        let mut walls: Vec<StraightWall> = Vec::new();
        for piece in pieces {
            match walls.last_mut() {
                Some(wall) if wall.east == piece.west => {
                    (wall.east, wall.height) = (piece.east, wall.height.min(piece.height));
                }
                _ => walls.push(piece),
            }
        }
        walls
    }

    /// Adds a surface, its copy at the positions of `back`, and the walls between them.
    fn extrude(&mut self, front: &Clipped, back: impl Fn([f32; 3]) -> [f32; 3]) {
        let (first, count) = (self.corners.len() as u32, front.corners.len() as u32);
        self.reserve(2 * front.corners.len(), 2 * (front.triangles.len() + front.around.len()));
        self.corners.extend_from_slice(&front.corners);
        self.corners.extend(front.corners.iter().map(|corner| back(*corner)));
        self.triangles.extend(front.triangles.iter().map(|triangle| triangle.map(|corner| first + corner)));
        let behind = first + count;
        self.triangles.extend(front.triangles.iter().map(|[a, b, c]| [behind + a, behind + c, behind + b]));
        for [from, to] in &front.around {
            self.wall_piece([first + from, first + to], [behind + from, behind + to]);
        }
    }

    /// Adds land above a cut with walls, a base, and a cavity that is open below in each part that has room for one.
    ///
    /// The outlines of the cavities divide the triangles of the land: triangles outside have a copy on the ground,
    /// triangles inside have a copy at the ceiling.
    ///
    /// # Errors
    /// If the base is too thin, no part has room, or the surface does not use all samples.
    fn extrude_hollow(&mut self, land: &Clipped, surface: &Surface, scale: &Scale, wall: f64) -> Result<()> {
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        // The ceiling is linear between vertices, so they must not be far apart.
        if surface.shape.corners() != surface.grid.data().len() {
            return refuse(
                "a hollow model of the land above a cut has a vertex at every sample; leave out --max-error, or use a larger cell".into(),
            );
        }
        let ceiling = Ceiling::of(surface, scale, wall, true)?;
        let under: Vec<[f32; 3]> = land.corners.iter().map(|[x, y, _]| [*x, *y, ceiling.at([*x, *y])]).collect();
        // Ceilings that are not next to a wall are above the base minus the wall.
        let parted = part(&under, &land.triangles, (0.5 * (scale.base - wall)) as f32);
        if parted.above.is_empty() {
            return refuse(format!(
                "no part of the land above the cut has room for a cavity within walls of {} mm; use a smaller --hollow, or leave it out",
                number(wall)
            ));
        }
        self.numbered(land.corners.len() + 2 * parted.corners.len())?;
        self.corners.extend_from_slice(&land.corners);
        self.triangles.extend_from_slice(&land.triangles);
        let ground = self.face_down(&parted.corners, &parted.below, |_| 0.0);
        let inside = self.face_down(&parted.corners, &parted.above, |up| up);
        let below = |[from, to]: [u32; 2]| [from, to].map(|corner| ground[corner as usize]);
        for edge in &land.around {
            self.wall_piece(*edge, below(*edge));
        }
        for [from, to] in &parted.between {
            self.wall_piece([*to, *from].map(|corner| inside[corner as usize]), below([*to, *from]));
        }
        Ok(())
    }

    /// Adds flipped triangles, with a copy of each vertex; returns the numbers of the copies.
    fn face_down(&mut self, corners: &[[f32; 3]], triangles: &[[u32; 3]], up: impl Fn(f32) -> f32) -> Vec<u32> {
        let mut numbers = vec![NONE; corners.len()];
        for triangle in triangles {
            let [a, b, c] = triangle.map(|corner| {
                let [x, y, z] = corners[corner as usize];
                let number = &mut numbers[corner as usize];
                if *number == NONE {
                    self.corners.push([x, y, up(z)]);
                    *number = (self.corners.len() - 1) as u32;
                }
                *number
            });
            self.triangles.push([a, c, b]);
        }
        numbers
    }

    /// Only the surface.
    fn top(surface: &Surface, scale: &Scale) -> Solid {
        let shape = surface.shape;
        let mut corners = Vec::with_capacity(shape.corners());
        for row in shape.rows() {
            row.each(|column| corners.push(scale.place(surface, column, row.row)));
        }
        let mut triangles = Vec::with_capacity(shape.triangles());
        for piece in 0..shape.pieces() {
            shape.piece(surface.grid, piece, |triangle| triangles.push(triangle));
        }
        Solid { corners, triangles }
    }

    /// Checks that this many more vertices can be numbered.
    pub(super) fn numbered(&self, more: usize) -> Result<()> {
        match u32::try_from(self.corners.len() + more) {
            Ok(_) => Ok(()),
            Err(_) => Err(Error::new(
                ErrorKind::Request,
                "a solid holds at most 4294967295 vertices, and this one has more; use --max-error, a smaller window or a larger cell",
            )),
        }
    }

    /// Adds walls below a surface, and a base. `around` is the border of the surface, counter-clockwise from above.
    fn close(&mut self, around: &[u32]) {
        self.reserve(around.len() + 1, 3 * around.len());
        let below = self.drop(around);
        self.wall(around, &below);
        // The whole border is visible from a point in the middle of the base.
        let [_, [east, north, _]] = self.bounds();
        let middle = self.push([0.5 * east, 0.5 * north, 0.0]);
        for (from, to) in pairs(&below) {
            self.triangles.push([to, from, middle]);
        }
    }

    /// Adds walls below a surface with these sides, and a cavity that is open below.
    fn close_hollow(&mut self, sides: &[Vec<u32>; 4], ceiling: &Ceiling) {
        let around = sides.concat();
        let vertices = ceiling.heights.len();
        self.reserve(around.len() + 2 * vertices, 4 * around.len() + 4 * vertices);
        let below = self.drop(&around);
        self.wall(&around, &below);
        let first = self.corners.len() as u32;
        let width = ceiling.xs.len();
        let vertices = ceiling.heights.iter().enumerate();
        self.corners.extend(vertices.map(|(k, up)| [ceiling.xs[k % width], ceiling.ys[k / width], *up]));
        for row in 0..ceiling.ys.len() - 1 {
            for column in 0..width - 1 {
                let nw = first + (row * width + column) as u32;
                let [ne, sw, se] = [nw + 1, nw + width as u32, nw + width as u32 + 1];
                self.triangles.extend([[nw, se, sw], [nw, ne, se]]);
            }
        }
        // The rim on the ground, side by side: its outer line, and its inner line below the ceiling's border.
        let inner = ceiling
            .sides()
            .map(|side| side[..side.len() - 1].iter().map(|corner| first + corner).collect::<Vec<u32>>());
        let inner_above = inner.concat();
        let inner_below = self.drop(&inner_above);
        for ((from, to), (from_below, to_below)) in pairs(&inner_above).zip(pairs(&inner_below)) {
            self.wall_piece([to, from], [to_below, from_below]);
        }
        let [mut outer_start, mut inner_start] = [0; 2];
        for side in 0..4 {
            let line = |all: &[u32], start: usize, count: usize| -> Vec<u32> {
                (start..=start + count).map(|k| all[k % all.len()]).collect()
            };
            let outer = line(&below, outer_start, sides[side].len());
            let inside = line(&inner_below, inner_start, inner[side].len());
            self.rim(&outer, &inside);
            outer_start += sides[side].len();
            inner_start += inner[side].len();
        }
    }

    /// Adds the triangles between a side of the base and the parallel side of the cavity, facing down.
    fn rim(&mut self, outer: &[u32], inner: &[u32]) {
        let share = |solid: &Solid, line: &[u32], k: usize| {
            let [start, end, here] =
                [line[0], line[line.len() - 1], line[k]].map(|corner| solid.corners[corner as usize]);
            let along = |to: [f32; 3]| (to[0] - start[0]).abs() + (to[1] - start[1]).abs();
            along(here) / along(end)
        };
        let [mut i, mut j] = [0; 2];
        while i + 1 < outer.len() || j + 1 < inner.len() {
            let is_outer =
                j + 1 == inner.len() || i + 1 < outer.len() && share(self, outer, i + 1) <= share(self, inner, j + 1);
            if is_outer {
                self.triangles.push([outer[i + 1], outer[i], inner[j]]);
                i += 1;
            } else {
                self.triangles.push([inner[j], inner[j + 1], outer[i]]);
                j += 1;
            }
        }
    }

    /// Reserves exact capacity for more vertices and triangles.
    pub(super) fn reserve(&mut self, corners: usize, triangles: usize) {
        self.corners.reserve_exact(corners);
        self.triangles.reserve_exact(triangles);
    }

    /// Adds the points on the ground below vertices; returns their numbers.
    fn drop(&mut self, corners: &[u32]) -> Vec<u32> {
        corners
            .iter()
            .map(|corner| {
                let [x, y, _] = self.corners[*corner as usize];
                self.push([x, y, 0.0])
            })
            .collect()
    }

    /// Adds the wall between a closed line and the line below it. Its outside is to the right of the line.
    fn wall(&mut self, above: &[u32], below: &[u32]) {
        for ((from, to), (from_below, to_below)) in pairs(above).zip(pairs(below)) {
            self.wall_piece([from, to], [from_below, to_below]);
        }
    }

    fn wall_piece(&mut self, [from, to]: [u32; 2], [from_below, to_below]: [u32; 2]) {
        self.triangles.extend([[from, from_below, to_below], [from, to_below, to]]);
    }

    pub(super) fn push(&mut self, corner: [f32; 3]) -> u32 {
        self.corners.push(corner);
        (self.corners.len() - 1) as u32
    }

    /// The minimum and the maximum of each coordinate.
    #[must_use]
    pub fn bounds(&self) -> [[f32; 3]; 2] {
        bounds(&self.corners)
    }

    /// The size in millimetres: east, north, up.
    #[must_use]
    pub fn size(&self) -> [f64; 3] {
        let [least, greatest] = self.bounds();
        std::array::from_fn(|axis| f64::from(greatest[axis]) - f64::from(least[axis]))
    }
}

/// The edges of a closed line.
fn pairs(line: &[u32]) -> impl Iterator<Item = (u32, u32)> {
    line.iter().copied().zip(line.iter().copied().cycle().skip(1))
}

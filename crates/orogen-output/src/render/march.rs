//! Intersection of rays with the land.
//!
//! A ray traverses the patches from above. Where it stays above the highest point of a node of the pyramid it skips the
//! whole node; otherwise it descends into the four nodes below (A. Tevs, I. Ihrke, H.-P. Seidel, "Maximum mipmaps for
//! fast, accurate, and scalable dynamic height field rendering", 2008). Within a patch the ground is bilinear, so the
//! intersection is the first root of a quadratic: exact at any distance. The next patch is computed in integers, so
//! that no ray passes between two patches.

use super::relief::{DRY, Relief};
use super::vector::Vector;

/// A ray: origin and unit direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Origin, in cells.
    pub from: Vector,
    /// Direction, of length 1.
    pub along: Vector,
}

impl Ray {
    /// The point at a distance, in cells.
    pub fn at(&self, distance: f64) -> Vector {
        self.from + self.along * distance
    }
}

/// The surface that a ray meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Surface {
    /// The ground.
    GroundCover,
    /// Water of the sea or a lake.
    Water,
    /// A side of the block, below the edge of the ground; its outward normal points west, east, north or south.
    Side,
    /// A side of the block, below the edge of the water and above the ground.
    WaterSide,
}

/// An intersection of a ray with a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin, in cells.
    pub distance: f64,
    /// The surface.
    pub surface: Surface,
    /// The unit normal of a side; straight up otherwise, because shading computes the slope of the ground more
    /// precisely.
    pub normal: Vector,
}

/// A traversal of the nodes of the pyramid along a line.
struct Walk {
    level: usize,
    /// The patch; for a higher node, any of its patches.
    i: usize,
    j: usize,
    /// The distance at which the line enters the node.
    enter: f64,
    from: [f64; 2],
    along: [f64; 2],
    /// 1 / direction; infinite where that is 0.
    inverse: [f64; 2],
    last: [usize; 2],
}

impl Walk {
    /// Starts at a distance along a line, in the highest node.
    fn new(relief: &Relief, ray: &Ray, enter: f64) -> Walk {
        let from = [ray.from.x, ray.from.y];
        let along = [ray.along.x, ray.along.y];
        let last = relief.samples().map(|side| side - 2);
        let start = [0, 1].map(|axis| {
            let at = from[axis] + along[axis] * enter;
            (at.max(0.0) as usize).min(last[axis])
        });
        let level = relief.tops().len() - 1;
        Walk { level, i: start[0], j: start[1], enter, from, along, inverse: along.map(|d| 1.0 / d), last }
    }

    /// The distance at which the line leaves the node, and the axis.
    fn exit(&self) -> (f64, usize) {
        let side = |axis: usize, index: usize| {
            let node = index >> self.level;
            let edge = match self.along[axis] {
                d if d > 0.0 => (node + 1) << self.level,
                d if d < 0.0 => node << self.level,
                _ => return f64::INFINITY,
            };
            (edge as f64 - self.from[axis]) * self.inverse[axis]
        };
        let (x, y) = (side(0, self.i), side(1, self.j));
        if x <= y { (x.max(self.enter), 0) } else { (y.max(self.enter), 1) }
    }

    /// Moves to the next node; false if that is outside the land.
    fn step(&mut self, exit: f64, axis: usize) -> bool {
        let before = [self.i, self.j].map(|index| index >> self.level);
        let crossed = match self.along[axis] > 0.0 {
            true => Some((before[axis] + 1) << self.level).filter(|index| *index <= self.last[axis]),
            false => (before[axis] << self.level).checked_sub(1),
        };
        let Some(crossed) = crossed else {
            return false;
        };
        // On the other axis the line is still in the same node; rounding must not put it beyond the node's ends.
        let other = 1 - axis;
        let (first, end) = (before[other] << self.level, ((before[other] + 1) << self.level) - 1);
        let at = (self.from[other] + self.along[other] * exit).max(0.0) as usize;
        let at = at.clamp(first, end.min(self.last[other]));
        (self.i, self.j) = if axis == 0 { (crossed, at) } else { (at, crossed) };
        self.enter = exit;
        let up = self.level + 1;
        let parted = (crossed >> up) != (before[axis] >> 1);
        self.level += usize::from(parted);
        true
    }
}

impl Relief {
    /// The first intersection of a ray, at least `nearest` cells from its origin.
    #[must_use]
    pub fn hit(&self, ray: &Ray, nearest: f64) -> Option<Hit> {
        let (enter, leave, face) = self.clip(ray, nearest)?;
        if let Some(normal) = face {
            let place = ray.at(enter);
            if let Some(surface) = self.side(place) {
                return Some(Hit { distance: enter, surface, normal });
            }
        }
        let mut walk = Walk::new(self, ray, enter);
        walk.level = walk.level.min(self.tops().len() - 1);
        loop {
            let (exit, axis) = walk.exit();
            let low = ray.from.z + ray.along.z * if ray.along.z < 0.0 { exit } else { walk.enter };
            if low <= f64::from(self.tops()[walk.level].at(walk.i >> walk.level, walk.j >> walk.level)) {
                if walk.level > 0 {
                    walk.level -= 1;
                    continue;
                }
                if let Some((distance, surface)) = self.meets(ray, [walk.i, walk.j], walk.enter, exit) {
                    return Some(Hit { distance, surface, normal: Vector::UP });
                }
            }
            if exit >= leave || !walk.step(exit, axis) {
                return None;
            }
            walk.level = walk.level.min(self.tops().len() - 1);
        }
    }

    /// The range of distances in which a ray is over the land and below its highest point, and the outward normal of
    /// the side that it enters through, if any.
    fn clip(&self, ray: &Ray, nearest: f64) -> Option<(f64, f64, Option<Vector>)> {
        let (mut enter, mut leave, mut face) = (nearest, f64::INFINITY, None);
        let reach = self.reach();
        let axes = [
            (ray.from.x, ray.along.x, reach[0], Vector::new(1.0, 0.0, 0.0)),
            (ray.from.y, ray.along.y, reach[1], Vector::new(0.0, 1.0, 0.0)),
        ];
        for (from, along, reach, outward) in axes {
            if along == 0.0 {
                if !(0.0..=reach).contains(&from) {
                    return None;
                }
                continue;
            }
            let (near, far) = match along > 0.0 {
                true => (-from / along, (reach - from) / along),
                false => ((reach - from) / along, -from / along),
            };
            if near > enter {
                enter = near;
                face = Some(if along > 0.0 { -outward } else { outward });
            }
            leave = leave.min(far);
        }
        let highest = self.highest();
        if ray.along.z < 0.0 {
            let falls = (highest - ray.from.z) / ray.along.z;
            if falls > enter {
                enter = falls;
                face = None;
            }
        } else if ray.along.z > 0.0 {
            leave = leave.min((highest - ray.from.z) / ray.along.z);
        } else if ray.from.z > highest {
            return None;
        }
        (enter <= leave).then_some((enter, leave, face))
    }

    /// The part of a side at a point on it; `None` above the ground and the water.
    fn side(&self, place: Vector) -> Option<Surface> {
        let ground = self.ground(place.x, place.y);
        if place.z < ground {
            return Some(Surface::Side);
        }
        (place.z < self.top(place.x, place.y)).then_some(Surface::WaterSide)
    }

    /// The first intersection of a ray with the ground or the water of a patch, between two distances.
    fn meets(&self, ray: &Ray, [i, j]: [usize; 2], enter: f64, exit: f64) -> Option<(f64, Surface)> {
        let [nw, ne, sw, se] = self.corners(i, j).map(f64::from);
        let (east, south, twist) = (ne - nw, sw - nw, nw - ne - sw + se);
        let start = ray.at(enter);
        let (u, v) = (start.x - i as f64, start.y - j as f64);
        let Vector { x: du, y: dv, z: dz } = ray.along;
        // Height above the ground after a further distance s: above + fall s + bend s^2.
        let above = start.z - (nw + east * u + south * v + twist * u * v);
        let fall = dz - (east * du + south * dv + twist * (u * dv + v * du));
        let bend = -twist * du * dv;
        let ground = first_root(above, fall, bend, exit - enter);
        let level = self.water_of(i, j);
        if level != DRY && dz < 0.0 && above > 0.0 {
            let s = (f64::from(level) - start.z) / dz;
            if s >= 0.0 && s <= exit - enter && ground.is_none_or(|ground| s < ground) {
                return Some((enter + s, Surface::Water));
            }
        }
        ground.map(|s| (enter + s, Surface::GroundCover))
    }

    /// The steepest slope (z per cell of distance) from a point to any ground in the horizontal unit direction (dx,
    /// dy), at least `nearest` cells away, if it is more than `at_least`. Values above `enough` are not refined.
    #[must_use]
    pub fn steepest(&self, place: Vector, [dx, dy]: [f64; 2], nearest: f64, at_least: f64, enough: f64) -> f64 {
        let ray = Ray { from: Vector { z: f64::NEG_INFINITY, ..place }, along: Vector::new(dx, dy, 0.0) };
        let mut most = at_least;
        let Some((enter, leave, _)) = self.clip(&ray, nearest) else {
            return most;
        };
        let highest = self.highest();
        let mut walk = Walk::new(self, &ray, enter);
        // Starting in the highest node would only add descents.
        walk.level = walk.level.min(2);
        loop {
            let (exit, axis) = walk.exit();
            // Within this range, the line with the steepest slope so far is nowhere lower than this.
            let line = place.z + most * if most > 0.0 { walk.enter } else { exit };
            if most > 0.0 && line > highest {
                return most;
            }
            if line < f64::from(self.tops()[walk.level].at(walk.i >> walk.level, walk.j >> walk.level)) {
                if walk.level > 0 {
                    walk.level -= 1;
                    continue;
                }
                most = most.max(self.rise_over(place, &walk, exit.min(leave)));
                if most > enough {
                    return most;
                }
            }
            if exit >= leave || !walk.step(exit, axis) {
                return most;
            }
            walk.level = walk.level.min(self.tops().len() - 1);
        }
    }

    /// The steepest slope to the ground of a patch.
    fn rise_over(&self, place: Vector, walk: &Walk, exit: f64) -> f64 {
        let [nw, ne, sw, se] = self.corners(walk.i, walk.j).map(f64::from);
        let (east, south, twist) = (ne - nw, sw - nw, nw - ne - sw + se);
        let (u, v) = (place.x - walk.i as f64, place.y - walk.j as f64);
        let [du, dv] = walk.along;
        // The ground at distance t from the point: start + climb t + bend t^2.
        let start = nw + east * u + south * v + twist * u * v - place.z;
        let climb = east * du + south * dv + twist * (u * dv + v * du);
        let bend = twist * du * dv;
        let rise = |t: f64| start / t + climb + bend * t;
        let mut most = rise(walk.enter).max(rise(exit));
        let turn = start / bend;
        if turn > 0.0 {
            let t = turn.sqrt();
            if t > walk.enter && t < exit {
                most = most.max(rise(t));
            }
        }
        most
    }
}

/// The first s from 0 to `end` where above + fall s + bend s^2 is not positive.
fn first_root(above: f64, fall: f64, bend: f64, end: f64) -> Option<f64> {
    if above <= 0.0 {
        return Some(0.0);
    }
    let inside = |s: f64| (s >= 0.0 && s <= end).then_some(s);
    let square = fall * fall - 4.0 * bend * above;
    if square < 0.0 {
        return None;
    }
    // Of the two forms of each root, the one without cancellation.
    let q = -0.5 * (fall + if fall < 0.0 { -square.sqrt() } else { square.sqrt() });
    let (one, other) = (above / q, q / bend);
    match (inside(one), inside(other)) {
        (Some(one), Some(other)) => Some(one.min(other)),
        (one, other) => one.or(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::relief::Land;
    use orogen_grid::grid::{Grid, Window};

    /// Terrain with z = f(x, y), in cells, over `columns` x `rows` samples.
    fn relief(columns: usize, rows: usize, f: impl Fn(f64, f64) -> f64) -> Relief {
        let window = Window::new(columns, rows, 1.0);
        let mut heights = Grid::filled(window, 0.0);
        for j in 0..rows {
            for i in 0..columns {
                heights.row_mut(j)[i] = f(i as f64, j as f64) as f32;
            }
        }
        Relief::new(&Land { heights: &heights, surface: None, flow: None, sea_level: None }, 1.0).unwrap()
    }

    fn ray(from: [f64; 3], along: [f64; 3]) -> Ray {
        let [from, along] = [from, along].map(|[x, y, z]| Vector::new(x, y, z));
        Ray { from, along: along.unit() }
    }

    /// Directions all around, and steep to level.
    fn directions() -> impl Iterator<Item = Vector> {
        (0..40).map(|k| Vector::towards(f64::from(k) * 17.0 + 0.3, -2.0 - f64::from(k * k % 87)))
    }

    #[test]
    fn a_plane_is_met_where_it_is() {
        // z = 3 + 0.25 x - 0.5 y + 32; the datum is its lowest sample.
        let plane = relief(65, 65, |x, y| 35.0 + 0.25 * x - 0.5 * y);
        let lowest = 35.0 - 0.5 * 64.0;
        let normal = Vector::new(-0.25, 0.5, 1.0);
        let mut met = 0;
        for along in directions() {
            let from = Vector::new(32.3, 31.1, 60.0);
            let ray = Ray { from, along };
            let expect = (35.0 - lowest - normal.dot(from)) / normal.dot(along);
            let place = ray.at(expect);
            let inside = (0.0..=64.0).contains(&place.x) && (0.0..=64.0).contains(&place.y) && expect > 0.0;
            match plane.hit(&ray, 0.0) {
                Some(hit) => {
                    assert!(inside && (hit.distance - expect).abs() < 1e-9, "{along:?}: {} {expect}", hit.distance);
                    met += 1;
                }
                None => assert!(!inside, "{along:?} should meet the plane at {place:?}"),
            }
        }
        assert!(met > 12, "{met}");
    }

    #[test]
    fn a_saddle_is_met_at_the_root_of_its_quadratic() {
        // z = x y / 8 is bilinear all over: patches must agree with the whole.
        let saddle = relief(33, 17, |x, y| x * y / 8.0);
        for along in directions() {
            let ray = Ray { from: Vector::new(10.0, 9.0, 90.0), along };
            if let Some(hit) = saddle.hit(&ray, 0.0) {
                let place = ray.at(hit.distance);
                assert!((place.z - place.x * place.y / 8.0).abs() < 1e-9, "{along:?}: {place:?}");
                // No surface was missed on the way.
                for k in 0..1000 {
                    let before = ray.at(hit.distance * f64::from(k) / 1000.0);
                    let over = before.x >= 0.0 && before.x <= 32.0 && before.y >= 0.0 && before.y <= 16.0;
                    assert!(!over || before.z > before.x * before.y / 8.0 - 1e-9);
                }
            }
        }
    }

    #[test]
    fn rough_ground_is_met_where_small_steps_meet_it() {
        let height = |i: usize, j: usize| ((i * 7919 + j * 104_729) % 97) as f64 / 12.0;
        let rough = relief(40, 30, |x, y| height(x as usize, y as usize));
        for (k, along) in directions().enumerate() {
            let from = Vector::new(-5.0 + k as f64, 12.5, 20.0);
            let ray = Ray { from, along };
            let found = rough.hit(&ray, 0.0).filter(|hit| hit.surface == Surface::GroundCover);
            // Brute force in steps of a thousandth.
            let felt = (0..90_000).map(|step| f64::from(step) / 1000.0).find(|&t| {
                let place = ray.at(t);
                let over = (0.0..=39.0).contains(&place.x) && (0.0..=29.0).contains(&place.y);
                over && place.z <= rough.ground(place.x, place.y)
            });
            match (found, felt) {
                (Some(hit), Some(felt)) => assert!((hit.distance - felt).abs() < 2e-3, "{k}: {} {felt}", hit.distance),
                (None, None) => {}
                (found, felt) => {
                    let through = felt.is_some_and(|felt| {
                        let place = ray.at(felt);
                        place.x.min(place.y).min(39.0 - place.x).min(29.0 - place.y) < 0.01
                    });
                    assert!(found.is_none() && through, "{k}: {found:?} {felt:?}");
                }
            }
        }
    }

    #[test]
    fn a_wall_throws_a_shadow_of_height_over_tangent() {
        // A wall 8 high along x = 20, seen from the level ground east of it, towards the west.
        let wall = relief(64, 9, |x, _| if x == 20.0 { 8.0 } else { 0.0 });
        for elevation in [10.0f64, 20.0, 35.0, 50.0] {
            let tangent = libm::tan(elevation.to_radians());
            let length = 8.0 / tangent;
            for (off, shaded) in [(-0.01, true), (0.01, false)] {
                let place = Vector::new(20.0 + length + off, 4.0, 0.0);
                let rise = wall.steepest(place, [-1.0, 0.0], 0.25, -10.0, 10.0);
                assert_eq!(rise > tangent, shaded, "{elevation} {off}: {rise} {tangent}");
            }
        }
    }

    #[test]
    fn the_steepest_rise_is_that_of_a_search() {
        let height = |i: usize, j: usize| ((i * 7919 + j * 104_729) % 97) as f64 / 12.0;
        let rough = relief(40, 30, |x, y| height(x as usize, y as usize));
        for k in 0..60 {
            let (sin, cos) = libm::sincos(f64::from(k) * 0.7);
            let place = Vector::new(3.3 + f64::from(k % 7) * 5.0, 4.4 + f64::from(k % 5) * 4.0, 3.0);
            let got = rough.steepest(place, [cos, sin], 0.5, -50.0, 1e9);
            let felt = (500..60_000)
                .map(|step| f64::from(step) / 1000.0)
                .map(|t| (place.x + cos * t, place.y + sin * t, t))
                .filter(|(x, y, _)| (0.0..=39.0).contains(x) && (0.0..=29.0).contains(y))
                .map(|(x, y, t)| (rough.ground(x, y) - place.z) / t)
                .fold(-50.0, f64::max);
            assert!(got >= felt - 1e-9 && got < felt + 0.02, "{k}: {got} {felt}");
        }
    }

    #[test]
    fn water_is_met_before_its_bed_and_sides_before_all() {
        let heights = Grid::from_data(Window::new(3, 3, 1.0), [0.0, 0.0, 6.0].repeat(3)).unwrap();
        let land = Land { heights: &heights, surface: None, flow: None, sea_level: Some(3.0) };
        let relief = Relief::new(&land, 1.0).unwrap();
        let down = |x: f64| relief.hit(&ray([x, 1.0, 9.0], [0.0, 0.0, -1.0]), 0.0).unwrap();
        assert_eq!((down(0.5).surface, down(0.5).distance), (Surface::Water, 6.0));
        assert_eq!((down(1.25).surface, down(1.25).distance), (Surface::Water, 6.0));
        assert_eq!((down(1.75).surface, down(1.75).distance), (Surface::GroundCover, 4.5));
        let west = |z: f64| relief.hit(&ray([-2.0, 1.0, z], [1.0, 0.0, 0.0]), 0.0).unwrap();
        assert_eq!((west(2.0).surface, west(2.0).distance), (Surface::WaterSide, 2.0));
        assert_eq!(west(-0.5).surface, Surface::Side);
        assert_eq!(west(-0.5).normal, Vector::new(-1.0, 0.0, 0.0));
        assert_eq!((west(4.5).surface, west(4.5).distance), (Surface::GroundCover, 3.75));
        assert_eq!(relief.hit(&ray([-2.0, 1.0, 7.0], [1.0, 0.0, 0.0]), 0.0), None);
        assert_eq!(relief.hit(&ray([0.5, 1.0, 9.0], [0.0, 0.0, 1.0]), 0.0), None);
    }
}

//! Meandering rivers and the floodplain that they leave, as a function of the position.
//!
//! The line of a river moves by the model of A. D. Howard and T. R. Knutson, "Sufficient conditions for river
//! meandering: a simulation approach" (Water Resources Research 20, 1984). Where a bend comes back to itself the river
//! cuts through the neck, and leaves an oxbow lake. Lines of earlier times tell when the river was last at a position.

mod cutoffs;
mod floodplain;
mod migration;

pub use floodplain::{Alluvial, Floodplain};

/// A river that moves over its floodplain.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Meanders {
    /// Width of the channel, in metres.
    pub width: f64,
    /// Depth of the channel, in metres.
    pub depth: f64,
    /// Friction of the bed: the square of the ratio of the shear velocity to that of the flow.
    pub friction: f64,
    /// Distance, in widths, by which a bend would move if its radius were one width and nothing upstream mattered.
    pub migration: f64,
    /// Width of the valley floor around the first line, in metres, beyond which the river does not move; 0 for a wide
    /// plain.
    pub valley: f64,
    /// Seed of the first bends.
    pub seed: u64,
}

impl Default for Meanders {
    /// The defaults of the op `meanders`.
    fn default() -> Meanders {
        Meanders { width: 60.0, depth: 3.0, friction: 0.015, migration: 200.0, valley: 0.0, seed: 0 }
    }
}

orogen_noise::builder!(
    Meanders:
    with_width(width: f64),
    with_depth(depth: f64),
    with_friction(friction: f64),
    with_migration(migration: f64),
    with_valley(valley: f64),
    with_seed(seed: u64)
);

/// A river at the end, and what it left.
struct History {
    /// The lines of the river at equal times, from the first to the present one.
    courses: Vec<Vec<[f64; 2]>>,
    oxbows: Vec<Oxbow>,
}

/// A bend that was cut off.
struct Oxbow {
    line: Vec<[f64; 2]>,
    /// When it was cut off, as an index of courses.
    time: f64,
}

impl Meanders {
    /// The floodplain of rivers that start along these lines: x to the east and y to the south, in metres. Each line is
    /// a river of its own; its ends do not move.
    #[must_use]
    pub fn floodplain(&self, lines: &[Vec<[f64; 3]>]) -> Floodplain {
        let flat = |line: &Vec<[f64; 3]>| line.iter().map(|[x, y, _]| [*x, *y]).collect::<Vec<[f64; 2]>>();
        let rivers = lines.iter().map(flat).zip(0u64..);
        Floodplain::new(self, rivers.map(|(line, index)| migration::migrate(self, &line, index)).collect())
    }
}

impl Meanders {
    /// Approximate memory of the floodplain of lines with this total length in metres, in bytes.
    #[must_use]
    pub fn memory(&self, length: f64) -> u64 {
        /// Bytes of a point of a course in a tree of boxes.
        const POINT: f64 = 160.0;
        (POINT * (migration::COURSES[1] / 2 + 2) as f64 * migration::points_of(self, length)) as u64
    }
}

/// 0 up to 0, 1 from 1 on, and smooth between them.
fn smoothstep(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The distance between two points.
fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    let (x, y) = (bx - ax, by - ay);
    (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests;

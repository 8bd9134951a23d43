//! The rows of the page and their noises.

use orogen_grid::aggregate::relief::{self, Ridges};
use orogen_grid::aggregate::single;
use orogen_grid::progress::Progress;
use orogen_noise::{Basis, Falloff, Feature, Fractal, Kind, LengthMismatch, Points, Worley};

/// A row of related noises.
#[derive(Debug)]
pub struct Row {
    /// The heading.
    pub title: &'static str,
    /// The common property of its noises.
    pub about: &'static str,
    /// The noises, at most [`COLUMNS`].
    pub noises: Vec<Shown>,
}

/// A noise on the page.
#[derive(Debug)]
pub struct Shown {
    /// The name.
    pub name: &'static str,
    /// The parameters.
    pub about: &'static str,
    /// The noise.
    pub noise: Noise,
}

/// The source of a picture.
#[derive(Debug)]
pub enum Noise {
    /// A fractal, or a single octave.
    Fractal(Fractal),
    /// Cellular noise.
    Worley(Worley),
    /// A fractal displaced by another one.
    Warped {
        /// The fractal that is displaced.
        noise: Fractal,
        /// The displacement: one noise for each direction, with different seeds.
        by: Fractal,
        /// Displacement per unit of noise.
        strength: f32,
    },
    /// A diffusion-limited aggregate: 1 in its cells.
    Aggregate(u64),
    /// Mountains made of aggregates.
    Peaks(u64),
}

impl Noise {
    /// The samples over columns and rows.
    pub fn fill(&self, xs: &[f64], ys: &[f64], out: &mut [f32]) -> Result<(), LengthMismatch> {
        let lattice = Points::Lattice { xs, ys };
        match *self {
            Noise::Fractal(noise) => noise.fill(&lattice, out),
            Noise::Worley(noise) => noise.fill(&lattice, out),
            Noise::Warped { noise, by, strength } => {
                let (mut dx, mut dy) = (vec![0.0; out.len()], vec![0.0; out.len()]);
                by.fill(&lattice, &mut dx)?;
                // Another seed gives an independent noise.
                by.with_seed(by.seed ^ 1).fill(&lattice, &mut dy)?;
                for part in dx.iter_mut().chain(&mut dy) {
                    *part *= strength;
                }
                noise.fill(&Points::Displaced { xs, ys, dx: &dx, dy: &dy }, out)
            }
            Noise::Aggregate(seed) => {
                let cells = single::aggregate(SIDE as usize, usize::MAX, seed);
                sample(&cells.iter().map(|cell| f32::from(*cell)).collect::<Vec<_>>(), SIDE as usize, xs, ys, out);
                Ok(())
            }
            Noise::Peaks(seed) => {
                let ridges = Ridges::default()
                    .with_seed(seed)
                    .with_reach(0.95)
                    .with_density(0.2)
                    .with_gain(0.65)
                    .with_taper(8.0);
                // It takes a fraction of a second and is never cancelled.
                if let Ok((across, _, heights)) =
                    relief::ridge_heights(SIDE as usize, SIDE as usize, &ridges, &Progress::none())
                {
                    sample(&heights, across, xs, ys, out);
                }
                Ok(())
            }
        }
    }
}

/// Samples a square of `across` cells per side over the picture, with nearest-neighbor interpolation.
fn sample(cells: &[f32], across: usize, xs: &[f64], ys: &[f64], out: &mut [f32]) {
    let index = |at: f64| ((at / SIDE * across as f64) as usize).min(across - 1);
    for (row, y) in out.chunks_mut(xs.len().max(1)).zip(ys) {
        row.iter_mut().zip(xs).for_each(|(h, x)| *h = cells[index(*y) * across + index(*x)]);
    }
}

/// Number of noises per row.
pub const COLUMNS: usize = 6;

/// Side of each picture in the noises' unit of length, independent of the number of samples.
pub const SIDE: f64 = 200.0;

/// The rows, with every noise from `seed`.
#[must_use]
pub fn rows(seed: u64) -> Vec<Row> {
    let single = |basis, wavelength| {
        Fractal::new(seed, wavelength)
            .with_basis(basis)
            .with_octaves(1)
            .with_kind(Kind::Fbm)
            .with_gain(0.5)
            .with_lacunarity(2.0)
    };
    let summed = |kind| single(Basis::Perlin, 100.0).with_octaves(6).with_kind(kind);
    let weighted = |k, falloff| summed(Kind::Weighted { k, falloff });
    let shown = |name, about, noise| Shown { name, about, noise };
    let plain = |name, about, noise| shown(name, about, Noise::Fractal(noise));
    let cells = |name, about, feature| shown(name, about, Noise::Worley(Worley::new(seed, 40.0).with_feature(feature)));
    let by = summed(Kind::Fbm).with_octaves(2).with_seed(seed ^ 0xa11ce);
    let warped = Noise::Warped { noise: summed(Kind::Fbm), by, strength: 80.0 };
    vec![
        Row {
            title: "One octave",
            about: "random numbers, and five ways to make smooth noise from them",
            noises: vec![
                plain("White noise", "a number a square, 4 wide", single(Basis::White, 4.0)),
                plain("Value noise", "wavelength 50", single(Basis::Value, 50.0)),
                plain("Perlin noise", "wavelength 50", single(Basis::Perlin, 50.0)),
                plain("Classic Perlin noise", "wavelength 50, table of 256", single(Basis::ClassicDiagonal, 50.0)),
                plain("Simplex noise", "wavelength 70, on triangles", single(Basis::Simplex, 70.0)),
                plain("OpenSimplex2", "wavelength 70, smooth", single(Basis::OpenSimplex2Smooth, 70.0)),
            ],
        },
        Row {
            title: "Cells",
            about: "Worley noise: one random point in each square 40 wide, and the distance to the nearest points",
            noises: vec![
                cells("Worley F1", "the nearest point", Feature::F1),
                cells("Worley F2", "the second nearest", Feature::F2),
                cells("Worley F2 − F1", "0 between two cells", Feature::Difference),
                cells("Worley F1 × F2", "both together", Feature::Product),
                cells("Worley edge", "the nearest edge of a cell", Feature::Edge),
                cells("Worley value", "a number a cell", Feature::Value),
            ],
        },
        Row {
            title: "Six octaves",
            about: "from wavelength 100 down, each with half the wavelength and half the amplitude; Perlin noise except for the last",
            noises: vec![
                plain("fBm", "the sum", summed(Kind::Fbm)),
                plain("Ridged fBm", "the sum of 1 − 2 |noise|", summed(Kind::Ridged)),
                plain("Billow", "the sum of 2 |noise| − 1", summed(Kind::Billow)),
                plain("Ping-pong", "folded, strength 4", summed(Kind::PingPong { strength: 4.0 })),
                shown("Domain-warped fBm", "moved by fBm, up to 80", warped),
                plain("fBm of Worley F1", "cells in cells", summed(Kind::Fbm).with_basis(Basis::Worley)),
            ],
        },
        Row {
            title: "Weighted by slope",
            about: "each octave damped by a falloff of k m, where m is the squared slope of the sum so far",
            noises: vec![
                plain("Weighted fBm, k = 0", "no damping", weighted(0.0, Falloff::Reciprocal)),
                plain("Weighted fBm, k = 1", "1 / (1 + k m)", weighted(1.0, Falloff::Reciprocal)),
                plain("Weighted fBm, k = 10", "1 / (1 + k m)", weighted(10.0, Falloff::Reciprocal)),
                plain("Exponential, k = 1", "exp(−k m)", weighted(1.0, Falloff::Exponential)),
                plain("Square root, k = 1", "1 / (1 + k √m)", weighted(1.0, Falloff::SquareRoot)),
                plain("Smoothstep, k = 1", "1 − smoothstep(k m)", weighted(1.0, Falloff::Smoothstep)),
            ],
        },
        Row {
            title: "Shaped by what came before",
            about: "six octaves, scaled by the height so far or moved by its slope",
            noises: vec![
                plain(
                    "Hybrid multifractal",
                    "gain 0.8: rough heights",
                    summed(Kind::Hybrid { offset: 0.7 }).with_gain(0.8),
                ),
                plain("Heterogeneous", "the higher, the rougher", summed(Kind::Hetero { offset: 0.7 })),
                plain("Swiss turbulence", "branching crests", summed(Kind::Swiss { warp: 0.15 })),
                plain("Jordan turbulence", "worn massifs", summed(Kind::Jordan { warp: 0.35, damp: 0.8 })),
            ],
        },
        Row {
            title: "Aggregates",
            about: "diffusion-limited aggregates: random walkers attach to the aggregate when they touch it",
            noises: vec![
                shown("Aggregate", "grown from the middle", Noise::Aggregate(seed)),
                shown("DLA mountains", "at six scales, by way to tips", Noise::Peaks(seed)),
            ],
        },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_fit_the_page_and_leave_room_for_the_note() {
        let rows = rows(1);
        assert!(rows.iter().all(|row| !row.noises.is_empty() && row.noises.len() <= COLUMNS));
        assert!(rows.last().unwrap().noises.len() < COLUMNS);
    }
}

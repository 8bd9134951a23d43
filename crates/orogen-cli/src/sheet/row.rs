//! What the page shows: its rows and the noises in them.

use orogen_noise::{Basis, Falloff, Fractal, Kind};

/// A row of noises that belong together.
#[derive(Debug)]
pub struct Row {
    /// Its heading.
    pub title: &'static str,
    /// What its noises have in common.
    pub about: &'static str,
    /// The noises, at most [`COLUMNS`].
    pub noises: Vec<Shown>,
}

/// A noise of the page.
#[derive(Debug)]
pub struct Shown {
    /// What it is called.
    pub name: &'static str,
    /// Its parameters.
    pub about: &'static str,
    /// The noise itself.
    pub noise: Fractal,
    /// What it is read through, if it is warped: a noise for each direction, and how far one of 1 moves.
    pub warp: Option<(Fractal, f32)>,
}

/// How many noises stand side by side.
pub const COLUMNS: usize = 4;

/// The side of each picture in the noises' unit of length: however many samples it has, it shows the same.
pub const SIDE: f64 = 200.0;

/// The rows, with every noise from `seed`.
pub fn rows(seed: u64) -> Vec<Row> {
    let single = |basis, wavelength| Fractal {
        basis,
        seed,
        wavelength,
        octaves: 1,
        kind: Kind::Fbm,
        gain: 0.5,
        lacunarity: 2.0,
    };
    let summed = |kind| Fractal { octaves: 6, kind, ..single(Basis::Perlin, 100.0) };
    let weighted = |k| summed(Kind::Weighted { k, falloff: Falloff::Reciprocal });
    let plain = |name, about, noise| Shown { name, about, noise, warp: None };
    let warp = Fractal { octaves: 2, seed: seed ^ 0xa11ce, ..summed(Kind::Fbm) };
    vec![
        Row {
            title: "One octave",
            about: "random numbers, and three ways to make hills of them",
            noises: vec![
                plain("White noise", "a number a square, 4 wide", single(Basis::White, 4.0)),
                plain("Value noise", "wavelength 50", single(Basis::Value, 50.0)),
                plain("Perlin noise", "wavelength 50", single(Basis::Perlin, 50.0)),
                plain("Classic Perlin noise", "wavelength 50, table of 256", single(Basis::ClassicDiagonal, 50.0)),
            ],
        },
        Row {
            title: "Six octaves",
            about: "Perlin noise from wavelength 100 down, each octave half as long and half as high",
            noises: vec![
                plain("fBm", "the sum", summed(Kind::Fbm)),
                plain("Ridged fBm", "the sum of 1 − 2 |noise|", summed(Kind::Ridged)),
                plain("Billow", "the sum of 2 |noise| − 1", summed(Kind::Billow)),
                Shown {
                    warp: Some((warp, 80.0)),
                    ..plain("Domain-warped fBm", "moved by fBm, up to 80", summed(Kind::Fbm))
                },
            ],
        },
        Row {
            title: "Weighted by slope",
            about: "each octave over 1 + k m, where m is the squared slope of the sum so far",
            noises: vec![
                plain("Weighted fBm, k = 0", "the plain sum", weighted(0.0)),
                plain("Weighted fBm, k = 1", "smooth where it is steep", weighted(1.0)),
                plain("Weighted fBm, k = 10", "detail on crests and floors only", weighted(10.0)),
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

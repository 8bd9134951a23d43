//! Gullies on the slopes of any source.

use super::powers::raise;
use crate::lower::Lowering;
use crate::noise_field::checked;
use crate::op::{Evaluator, Field, Inputs, Stencil, WorldParams};
use orogen_grid::error::Result;
use orogen_noise::shader::function::Shader;
use orogen_noise::shader::phacelle::PHACELLE;
use orogen_noise::{Phacelle, Points, PreparedPhacelle, shader_constants};

op! {
    /// The source with gullies running down its slopes, made by a field without simulation (erosion filter).
    ///
    /// Phacelle noise makes stripes that run down the slope. The flanks of the stripes turn the stripes of the next
    /// octave, so small gullies branch off large ones. Let g be the slope, m the mask and t the fade; they start as the
    /// slope of the source, softened |g| `onset` and `fade`. An octave of wavelength w and strength s adds s w mix(t, c
    /// `weight`, m), where c and n are the cosine and sine of the stripes along g. Then g -= sign(n) 2 pi s `weight`
    /// side, t becomes the added value, and m = (1 - (1 - m)^`detail`) * softened
    /// |n| `sharpness`. The method is local: some gullies end in closed depressions, and valleys do not collect tributaries. A few steps of
    /// `stream-power` after it correct both. The slope is taken between positions `step` metres to each side, so the
    /// source is evaluated five times per sample. The source may be a field, a filter or a solver. R. Skovbo Johansen,
    /// "Phacelle noise" (2025).
    pub struct Gullies = "gullies", field, revision 1;
    inputs {
        /// The heights, in metres.
        source: required,
        /// Value shown where the ground is too flat for gullies: -1 where gullies end in a valley floor, 1 where they
        /// end on a crest, 0 in between. Default: 0 everywhere.
        fade: optional,
    }
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Distance between the largest gullies.
        wavelength: f64 = 1500.0, unit "m", range 1e-3 to 1e9, alias "scale";
        /// Number of octaves. Each octave is finer than the one before.
        octaves: u32 = 5, range 1.0 to 16.0;
        /// Frequency ratio between successive octaves.
        lacunarity: f64 = 2.0, range 1.0 to 16.0;
        /// Depth ratio between successive octaves.
        gain: f64 = 0.5, range 0.0 to 1.0, alias "persistence";
        /// Depth of the largest gullies, as a multiple of their wavelength.
        strength: f64 = 0.22, range 0.0 to 10.0;
        /// Share of the strength that goes into gullies; the rest raises crests and lowers valleys according to the
        /// fade. Higher values also turn finer gullies more.
        weight: f64 = 0.5, range 0.0 to 1.0;
        /// How far finer gullies extend onto the crests and floors of larger ones: with 1 they cover only the flanks,
        /// with 3 nearly everything.
        detail: f64 = 1.5, range 0.1 to 10.0;
        /// How quickly gullies set in with steepness: they have their full depth where the slope is 1.5 / `onset`.
        onset: f64 = 3.0, range 0.01 to 1000.0;
        /// How quickly finer gullies set in on the flanks of larger ones: 1.25 gives round crests and floors, higher
        /// values make them sharp.
        sharpness: f64 = 1.25, range 0.01 to 1000.0;
        /// Slope that finer gullies assume for the ground; 0 uses the true slope. The lower the value, the more finer
        /// gullies branch off.
        assumed_slope: f64 = 0.7, range 0.0 to 100.0;
        /// Side of the noise's cells in wavelengths. It limits the length of a gully.
        cell: f64 = 0.7, range 0.1 to 10.0;
        /// How far stripes that cancel each other are restored in depth, from 0 (not at all) to 1 (to full depth).
        normalisation: f64 = 0.5, range 0.0 to 1.0;
        /// Sampling distance for the source's slope, to each side.
        step: f64 = 30.0, unit "m", range 1e-3 to 1e6;
    }
}

impl Field for Gullies {
    fn prepare(&self, world_params: &WorldParams) -> Option<Evaluator> {
        let gullies = self.clone();
        let octaves = self.octaves(world_params).map(|(noise, depth, turn)| (noise.prepare(), depth, turn));
        let octaves: Vec<_> = octaves.collect();
        Some(Box::new(move |at, inputs, out| gullies.carve(&octaves, at, inputs, out)))
    }

    fn lower(&self, _: usize, world_params: &WorldParams) -> Lowering<Shader> {
        Lowering::Shader(self.shader(world_params))
    }

    fn stencil(&self) -> Option<Stencil> {
        Some(Stencil { source: 0, step: self.step })
    }

    fn cost(&self) -> f64 {
        35.0 * f64::from(self.octaves)
    }
}

/// Samples processed together: few enough to stay on the stack.
const CHUNK: usize = 256;

shader_constants! {
    CODE = "gullies.wgsl",
    // Words before the octaves, after their number.
    GULLIES_PER_DIFFERENCE = 1, GULLIES_ONSET = 2, GULLIES_ASSUMED = 3, GULLIES_WEIGHT = 4, GULLIES_DETAIL = 5,
    GULLIES_SHARPNESS = 6, GULLIES_OCTAVES = 7,
    // Words of an octave, after the words of its noise.
    GULLIES_DEPTH = 6, GULLIES_TURN = 7, GULLIES_OCTAVE = 8
}

/// An octave: its noise, its depth, and how far it turns the next one.
type Octave = (PreparedPhacelle, f32, f32);

impl Gullies {
    /// The octaves: their noise, their depth, and how far they turn the next one.
    fn octaves(&self, world_params: &WorldParams) -> impl Iterator<Item = (Phacelle, f32, f32)> {
        let seed = world_params.seed_of(self.seed);
        let (mut wavelength, mut depth) = (self.wavelength, self.strength * self.wavelength);
        (0..self.octaves).map(move |octave| {
            let noise = Phacelle::new(seed.wrapping_add(u64::from(octave)), wavelength)
                .with_cell(self.cell)
                .with_normalisation(self.normalisation);
            let turn = (std::f64::consts::TAU * depth / wavelength) as f32 * self.weight as f32;
            let made = (noise, depth as f32, turn);
            wavelength /= self.lacunarity;
            depth *= self.gain;
            made
        })
    }

    /// The function for graphics cards. A `fade` that is not given is 0.
    fn shader(&self, world_params: &WorldParams) -> Shader {
        let per_metre = 0.5 / self.step;
        let [weight, detail, sharpness] = [self.weight, self.detail, self.sharpness];
        let numbers = [
            (GULLIES_PER_DIFFERENCE, per_metre),
            (GULLIES_ONSET, self.onset),
            (GULLIES_ASSUMED, self.assumed_slope),
            (GULLIES_WEIGHT, weight),
            (GULLIES_DETAIL, detail),
            (GULLIES_SHARPNESS, sharpness),
        ];
        let mut words = vec![self.octaves; GULLIES_OCTAVES];
        numbers.into_iter().for_each(|(at, number)| words[at] = (number as f32).to_bits());
        let mut lattices = Vec::new();
        for (noise, depth, turn) in self.octaves(world_params) {
            let mut octave = noise.shader_words();
            octave.resize(GULLIES_OCTAVE, 0);
            (octave[GULLIES_DEPTH], octave[GULLIES_TURN]) = (depth.to_bits(), turn.to_bits());
            words.extend(octave);
            lattices.push(noise.shader_lattice());
        }
        let [place, hash, phacelle] = PHACELLE;
        Shader { name: "gullies", code: vec![place, hash, phacelle, CODE], words, lattices, undisplaced: None }
    }

    /// Writes the source with gullies.
    fn carve(&self, octaves: &[Octave], at: &Points, inputs: &Inputs, out: &mut [f32]) -> Result<()> {
        out.copy_from_slice(inputs.required("source")?);
        let (around, fade) = (inputs.around()?, inputs.get("fade"));
        let mut start = 0;
        let mut part = |points: &Points| {
            let range = start..start + points.len();
            start = range.end;
            let around = around.map(|source| &source[range.clone()]);
            let fade = fade.map(|fade| &fade[range.clone()]);
            self.cut(octaves, points, around, fade, &mut out[range])
        };
        match *at {
            Points::Lattice { xs, ys } => {
                for y in ys {
                    for xs in xs.chunks(CHUNK) {
                        part(&Points::Lattice { xs, ys: std::slice::from_ref(y) })?;
                    }
                }
            }
            Points::Displaced { xs, ys, dx, dy } if !xs.is_empty() => {
                for ((y, dx), dy) in ys.iter().zip(dx.chunks(xs.len())).zip(dy.chunks(xs.len())) {
                    for ((xs, dx), dy) in xs.chunks(CHUNK).zip(dx.chunks(CHUNK)).zip(dy.chunks(CHUNK)) {
                        part(&Points::Displaced { xs, ys: std::slice::from_ref(y), dx, dy })?;
                    }
                }
            }
            Points::Displaced { .. } => {}
            Points::Scattered { x, y } => {
                for (x, y) in x.chunks(CHUNK).zip(y.chunks(CHUNK)) {
                    part(&Points::Scattered { x, y })?;
                }
            }
        }
        Ok(())
    }

    /// Adds the gullies at up to [`CHUNK`] points to `heights`.
    fn cut(
        &self,
        octaves: &[Octave],
        points: &Points,
        [east, west, south, north]: [&[f32]; 4],
        fade: Option<&[f32]>,
        heights: &mut [f32],
    ) -> Result<()> {
        let count = heights.len();
        let mut slope = [[0.0f32; CHUNK]; 2];
        let (mut mask, mut target) = ([0.0f32; CHUNK], [0.0f32; CHUNK]);
        let per_metre = (0.5 / self.step) as f32;
        let (onset, assumed) = (self.onset as f32, self.assumed_slope as f32);
        for k in 0..count {
            let (x, y) = ((east[k] - west[k]) * per_metre, (south[k] - north[k]) * per_metre);
            let steepness = (x * x + y * y).sqrt();
            mask[k] = soft(steepness * onset);
            let as_if = if assumed > 0.0 && steepness > 0.0 { assumed / steepness } else { 1.0 };
            (slope[0][k], slope[1][k]) = (x * as_if, y * as_if);
            target[k] = fade.map_or(0.0, |fade| fade[k].clamp(-1.0, 1.0));
        }
        let (weight, detail, sharpness) = (self.weight as f32, self.detail as f32, self.sharpness as f32);
        let (mut cosine, mut sine) = ([0.0f32; CHUNK], [0.0f32; CHUNK]);
        for (octave, (noise, amplitude, turn)) in (1..).zip(octaves) {
            let [x, y] = &slope;
            checked(noise.fill_along(points, &x[..count], &y[..count], &mut cosine[..count], &mut sine[..count]))?;
            for k in 0..count {
                target[k] += (cosine[k] * weight - target[k]) * mask[k];
                heights[k] += target[k] * amplitude;
            }
            if octave == octaves.len() {
                break;
            }
            for k in 0..count {
                // The gradient of a stripe's cosine is minus its sine, across the stripe.
                let (x, y) = (slope[0][k], slope[1][k]);
                let length = (x * x + y * y).sqrt();
                if length > 0.0 && sine[k] != 0.0 {
                    let across = -turn.copysign(sine[k]) / length;
                    (slope[0][k], slope[1][k]) = (x - y * across, y + x * across);
                }
                mask[k] = (1.0 - mask[k]).max(0.0);
            }
            raise(&mut mask[..count], detail);
            for k in 0..count {
                mask[k] = (1.0 - mask[k]) * soft(sine[k].abs() * sharpness);
            }
        }
        Ok(())
    }
}

/// A smooth step from 0 at 0, quadratic at first, to 1 at 1.5 and beyond, where its slope is 0.
fn soft(t: f32) -> f32 {
    let started = if t < 1.0 { 0.5 * t * t } else { t - 0.5 };
    let left = (1.0 - started).max(0.0);
    1.0 - left * left
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::declare::Declared;

    const SETTING: WorldParams = WorldParams { seed: 1, size: None, cell: 1.0, sea_level: 0.0 };

    /// Gullies on a plane that rises by `rise` per metre to the east, minus the plane, at `side` x `side` points 10 m
    /// apart.
    fn in_a_plane(gullies: &Gullies, rise: f32, side: usize, fade: Option<f32>) -> Vec<f32> {
        let axis: Vec<f64> = (0..side).map(|i| i as f64 * 10.0).collect();
        let plane = |moved: f64| -> Vec<f32> {
            (0..side * side).map(|k| ((k % side) as f32 * 10.0 + moved as f32) * rise).collect()
        };
        let (here, east, west) = (plane(0.0), plane(gullies.step), plane(-gullies.step));
        let fade = fade.map(|fade| vec![fade; side * side]);
        let slots =
            [Some(&here[..]), fade.as_deref(), Some(&east[..]), Some(&west[..]), Some(&here[..]), Some(&here[..])];
        let mut out = vec![0.0; side * side];
        gullies
            .eval(&Points::Lattice { xs: &axis, ys: &axis }, &Inputs::new(gullies.spec(), &slots), &SETTING, &mut out)
            .unwrap();
        out.iter().zip(&here).map(|(made, plane)| made - plane).collect()
    }

    fn roughness(made: &[f32], side: usize, stride: usize) -> f32 {
        (0..made.len() - stride)
            .filter(|k| k % side + 1 < side)
            .map(|k| made[k + stride] - made[k])
            .map(|d| d * d)
            .sum()
    }

    #[test]
    fn they_run_down_the_slope() {
        let gullies = Gullies { wavelength: 120.0, octaves: 1, ..Default::default() };
        let made = in_a_plane(&gullies, 0.6, 100, None);
        let (along, across) = (roughness(&made, 100, 1), roughness(&made, 100, 100));
        assert!(across > 5.0 * along, "{across} across the slope, {along} along it");
    }

    #[test]
    fn their_depth_is_that_asked_for() {
        let gullies = Gullies { wavelength: 120.0, octaves: 1, strength: 0.2, weight: 0.5, ..Default::default() };
        let made = in_a_plane(&gullies, 2.0, 100, None);
        let highest = made.iter().copied().fold(0.0f32, f32::max);
        let lowest = made.iter().copied().fold(0.0f32, f32::min);
        assert!((11.9..=12.01).contains(&highest) && (-12.01..=-11.9).contains(&lowest), "{lowest} to {highest}");
        let more = in_a_plane(&Gullies { octaves: 5, ..gullies }, 2.0, 100, None);
        assert!(more.iter().all(|height| height.abs() <= 12.0 * 1.9375 + 0.01));
    }

    #[test]
    fn flat_ground_has_none_but_what_it_fades_to() {
        let gullies = Gullies { wavelength: 100.0, octaves: 2, ..Default::default() };
        assert!(in_a_plane(&gullies, 0.0, 20, None).iter().all(|height| *height == 0.0));
        for (fade, expect) in [(-1.0, -33.0), (0.5, 16.5), (7.0, 33.0)] {
            let made = in_a_plane(&gullies, 0.0, 20, Some(fade));
            assert!(made.iter().all(|height| (height - expect).abs() < 1e-3), "{fade} gives {}", made[0]);
        }
    }

    #[test]
    fn every_way_of_asking_gives_the_same() {
        let gullies = Gullies { wavelength: 90.0, ..Default::default() };
        let (xs, ys) = ([0.0, 35.0, 71.5], [3.0, -900.0]);
        let heights =
            [[1.0, 2.0, 5.0, -3.0, 8.0, 2.5], [9.0, 3.0, 1.0, 4.0, 4.0, -8.0], [0.0, 9.0, 1.0, 5.0, 2.0, 6.0]];
        let slots = [&heights[0], &heights[1], &heights[2], &heights[0], &heights[2]].map(|row| Some(&row[..]));
        let slots = [slots[0], None, slots[1], slots[2], slots[3], slots[4]];
        let made = |points: &Points| {
            let mut out = [0.0; 6];
            gullies.eval(points, &Inputs::new(gullies.spec(), &slots), &SETTING, &mut out).unwrap();
            out
        };
        let lattice = made(&Points::Lattice { xs: &xs, ys: &ys });
        let none = [0.0; 6];
        assert_eq!(lattice, made(&Points::Displaced { xs: &xs, ys: &ys, dx: &none, dy: &none }));
        let (x, y): (Vec<f64>, Vec<f64>) = ys.iter().flat_map(|y| xs.map(|x| (x, *y))).unzip();
        assert_eq!(lattice, made(&Points::Scattered { x: &x, y: &y }));
    }
}

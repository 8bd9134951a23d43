//! A step of the wind: its speed over the dunes, the flux of sand, and what it erodes and deposits.

use super::slides;
use super::torus::Heading;
use super::{Dunes, WAVELENGTH};
use crate::error::Result;
use crate::parallel;
use crate::progress::Progress;

/// A of the shear stress over low hills (Jackson and Hunt 1975, Kroy and others 2002): tau0 (1 + A (|k| + i B k) h) for
/// a wave h of the heights with the wave number k.
const SPEED_UP: f32 = 2.4;

/// B: how far the maximum of the stress lies before the crest. It decides the wavelength of young dunes.
pub(super) const ASYMMETRY: f32 = 0.6;

/// Stress at which sand begins to move, over that of the undisturbed wind.
const THRESHOLD: f32 = 0.4;

/// Maximum slope at which the wind follows the ground down; behind steeper ground is a wake: 14 degrees.
const WAKE: f32 = 0.25;

/// Share of the flux that moves down a slope of 1 across the wind.
const SIDEWAYS: f32 = 0.3;

/// Spread of the flux across the wind, because the wind turns a little all the time: its variance grows by twice this
/// share of the wavelength times the distance. Without it dunes have tails before them.
const MIXING: f64 = 1.0 / 120.0;

/// Scales in lines whose differences make |k|: h less its mean over a scale s is k^2 s^2 / (1 + k^2 s^2) h, and the sum
/// over all s of that over s^2 is pi / 2 |k| h.
const SCALES: [usize; 5] = [1, 2, 4, 8, 16];

/// 2 / pi times the logarithm of the ratio of the scales.
const PER_SCALE: f32 = 0.441_271_2;

/// Scales after which the influence of a line is small.
const MEMORY: usize = 4;

/// Number of planes of a step in addition to the ground and the sand.
pub(super) const PLANES: usize = 4 + SCALES.len();

/// Ground, sand and wind in lines across the wind.
pub(super) struct State {
    pub(super) ground: Vec<f32>,
    pub(super) sand: Vec<f32>,
    heading: Heading,
    /// Heights with sand.
    height: Vec<f32>,
    /// Heights with sand, and wakes over them.
    cover: Vec<f32>,
    /// Flux of sand, in m^2 per year.
    flux: Vec<f32>,
    /// Shares of what slides and a second plane of sand.
    spare: Vec<f32>,
    means: [Vec<f32>; SCALES.len()],
    /// Flux over level sand.
    level_flux: f32,
    /// Flux that enters the first line: what has left the last one.
    entering: Vec<f32>,
    /// Share of the way to saturation from line to line.
    saturation: f32,
    /// Share of the flux that goes to each sample beside from line to line.
    mixing: f32,
    /// Distance from line to line along the wind, in metres.
    stride: f32,
    cell: f32,
    /// Duration in years.
    duration: f32,
}

impl State {
    /// A state at rest.
    pub(super) fn new(
        law: &Dunes,
        heading: &Heading,
        cell: f64,
        duration: f64,
        ground: Vec<f32>,
        sand: Vec<f32>,
    ) -> State {
        let plane = || vec![0.0; ground.len()];
        let stride = cell as f32 * heading.stride();
        let length = (law.wavelength / WAVELENGTH).max(f64::from(stride));
        State {
            height: plane(),
            cover: plane(),
            flux: plane(),
            spare: plane(),
            means: SCALES.map(|_| plane()),
            level_flux: law.flux as f32,
            entering: vec![0.0; heading.across],
            saturation: (1.0 - libm::exp(-f64::from(stride) / length)) as f32,
            mixing: (MIXING * law.wavelength / cell).min(0.4) as f32,
            stride,
            cell: cell as f32,
            duration: duration as f32,
            heading: *heading,
            ground,
            sand,
        }
    }

    /// Lets the wind blow for a step.
    pub(super) fn step(&mut self) {
        self.raise();
        self.wakes();
        self.mean();
        self.saturate();
        self.carry();
        self.raise();
        let creep = 0.5 * SIDEWAYS * self.duration / (self.cell * self.cell);
        slides::slide(self.heading, self.cell, [&self.height, &self.flux], creep, &mut self.spare, &mut self.sand);
    }

    /// The wind dies: what is in the air falls down, everywhere along the wind.
    pub(super) fn calm(&mut self) {
        let fallen = self.duration / (self.stride * self.heading.lines as f32);
        for line in self.sand.chunks_mut(self.heading.across) {
            for (sand, flux) in line.iter_mut().zip(&self.entering) {
                *sand += *flux * fallen;
            }
        }
        self.entering.fill(0.0);
    }

    /// Lets sand slide until it is at rest.
    pub(super) fn settle(&mut self, progress: &Progress) -> Result<()> {
        for _ in 0..MAX_SLIDES {
            progress.check()?;
            self.raise();
            let most = slides::slide(
                self.heading,
                self.cell,
                [&self.height, &self.flux],
                0.0,
                &mut self.spare,
                &mut self.sand,
            );
            if most < 1e-3 {
                break;
            }
        }
        Ok(())
    }

    /// The heights of ground and sand.
    fn raise(&mut self) {
        let across = self.heading.across;
        let lines = self.height.chunks_mut(across).zip(self.ground.chunks(across).zip(self.sand.chunks(across)));
        parallel::for_each(lines, |(height, (ground, sand))| {
            for (height, (ground, sand)) in height.iter_mut().zip(ground.iter().zip(sand)) {
                *height = ground + sand;
            }
        });
    }

    /// The heights under the wind: it leaves the ground behind crests.
    fn wakes(&mut self) {
        let (across, lines) = (self.heading.across, self.heading.lines);
        let fall = WAKE * self.stride;
        let mut moved = Moved::new(across);
        let warm_up = lines.min(MEMORY * SCALES[SCALES.len() - 1]);
        let mut wind = self.height[(lines - warm_up) * across..][..across].to_vec();
        for line in (lines - warm_up + 1..lines).chain(0..lines) {
            let height = &self.height[line * across..][..across];
            let before = moved.by(self.heading.drift, &wind);
            for (wind, (height, before)) in wind.iter_mut().zip(height.iter().zip(before)) {
                *wind = height.max(before - fall);
            }
            self.cover[line * across..][..across].copy_from_slice(&wind);
        }
    }

    /// Means of the cover along the wind, with weights that fall exponentially to both sides.
    fn mean(&mut self) {
        let (heading, cover) = (self.heading, &self.cover);
        let (across, lines) = (heading.across, heading.lines);
        parallel::for_each(self.means.iter_mut().zip(SCALES), |(means, scale)| {
            let own = 1.0 / (1.0 + scale as f32);
            let mut moved = Moved::new(across);
            let warm_up = lines.min(MEMORY * scale + 1);
            let mut mean = cover[(lines - warm_up) * across..][..across].to_vec();
            for line in (lines - warm_up + 1..lines).chain(0..lines) {
                let (cover, before) = (&cover[line * across..][..across], moved.by(heading.drift, &mean));
                for (mean, (cover, before)) in mean.iter_mut().zip(cover.iter().zip(before)) {
                    *mean = before + (cover - before) * own;
                }
                means[line * across..][..across].copy_from_slice(&mean);
            }
            mean.copy_from_slice(&cover[(warm_up - 1) * across..][..across]);
            // The sample itself is in both halves.
            let whole = 1.0 / (2.0 - own);
            let order =
                (0..warm_up - 1).rev().map(|line| (line, false)).chain((0..lines).rev().map(|line| (line, true)));
            for (line, kept) in order {
                let (cover, after) = (&cover[line * across..][..across], moved.by(-heading.drift, &mean));
                for (mean, (cover, after)) in mean.iter_mut().zip(cover.iter().zip(after)) {
                    *mean = after + (cover - after) * own;
                }
                if kept {
                    let means = &mut means[line * across..][..across];
                    for (both, (cover, mean)) in means.iter_mut().zip(cover.iter().zip(&mean)) {
                        *both = (*both + mean - own * cover) * whole;
                    }
                }
            }
        });
    }

    /// The saturated flux, into the plane of the flux.
    fn saturate(&mut self) {
        let State { heading, height, cover, means, stride, level_flux, flux, .. } = self;
        let (across, lines) = (heading.across, heading.lines);
        let (stride, level_flux, cover, means) = (*stride, *level_flux, &*cover, &*means);
        let slope = SPEED_UP * ASYMMETRY * 0.5 / stride;
        let factors = SCALES.map(|scale| SPEED_UP * PER_SCALE / (scale as f32 * stride));
        parallel::for_each(flux.chunks_mut(across).zip(height.chunks(across)).enumerate(), |(line, (flux, height))| {
            let at = |line: usize| line * across..(line + 1) * across;
            let (mut before, mut after) = (Moved::new(across), Moved::new(across));
            let before = before.by(heading.drift, &cover[at((line + lines - 1) % lines)]);
            let after = after.by(-heading.drift, &cover[at((line + 1) % lines)]);
            let here = &cover[at(line)];
            for (flux, (before, after)) in flux.iter_mut().zip(before.iter().zip(after)) {
                *flux = (after - before) * slope;
            }
            for (means, factor) in means.iter().zip(factors) {
                for (flux, (cover, mean)) in flux.iter_mut().zip(here.iter().zip(&means[at(line)])) {
                    *flux += (cover - mean) * factor;
                }
            }
            for (flux, (cover, height)) in flux.iter_mut().zip(here.iter().zip(height)) {
                let stress = (1.0 + *flux).clamp(0.0, 4.0);
                let moving = (stress - THRESHOLD).max(0.0) * (1.0 / (1.0 - THRESHOLD));
                *flux = if *cover > *height + 1e-3 { 0.0 } else { level_flux * moving * stress.sqrt() };
            }
        });
    }

    /// Carries the sand: the flux follows the saturated one as far as there is sand.
    fn carry(&mut self) {
        let across = self.heading.across;
        let mut moved = Moved::new(across);
        let per_flux = self.duration / self.stride;
        let available = self.stride / self.duration;
        let mut wind = std::mem::take(&mut self.entering);
        for (flux, sand) in self.flux.chunks_mut(across).zip(self.sand.chunks_mut(across)) {
            let before = moved.mixed(self.heading.drift, &wind, self.mixing);
            for ((wind, flux), (sand, before)) in wind.iter_mut().zip(flux.iter_mut()).zip(sand.iter_mut().zip(before))
            {
                let taken = ((*flux - before) * self.saturation).min(*sand * available);
                *wind = before + taken;
                *flux = *wind;
                *sand = (*sand - taken * per_flux).max(0.0);
            }
        }
        self.entering = wind;
    }
}

/// Maximum number of slides until sand is at rest.
const MAX_SLIDES: usize = 400;

/// A line, moved along itself.
struct Moved {
    wide: Vec<f32>,
    line: Vec<f32>,
}

impl Moved {
    fn new(across: usize) -> Moved {
        Moved { wide: vec![0.0; across + 4], line: vec![0.0; across] }
    }

    /// The line, moved by -1 to 1 samples, interpolated linearly. Its sum stays the same.
    fn by(&mut self, drift: f32, line: &[f32]) -> &[f32] {
        let across = line.len();
        let whole = drift.floor();
        let part = drift - whole;
        self.wide[2..across + 2].copy_from_slice(line);
        self.wide[0] = line[(2 * across - 2) % across];
        self.wide[1] = line[across - 1];
        self.wide[across + 2] = line[0];
        self.wide[across + 3] = line[1 % across];
        let first = (2 - whole as isize) as usize;
        let (near, far) = (&self.wide[first..][..across], &self.wide[first - 1..][..across]);
        for (moved, (near, far)) in self.line.iter_mut().zip(near.iter().zip(far)) {
            *moved = near + (far - near) * part;
        }
        &self.line
    }

    /// The moved line, of which a share `mix` goes to each sample beside.
    fn mixed(&mut self, drift: f32, line: &[f32], mix: f32) -> &[f32] {
        self.by(drift, line);
        let across = line.len();
        self.wide[1..=across].copy_from_slice(&self.line);
        self.wide[0] = self.line[across - 1];
        self.wide[across + 1] = self.line[0];
        let beside = self.wide.iter().zip(&self.wide[2..]);
        for (line, (left, right)) in self.line.iter_mut().zip(beside) {
            *line += (left + right - 2.0 * *line) * mix;
        }
        &self.line
    }
}

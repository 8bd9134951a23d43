//! Patches of an example on a lattice of triangles.

use super::{BORDER, Texture};
use crate::multiscale::hash;
use crate::random::Random;
use crate::resample::split;

/// Radius of a patch over the side of a triangle: the height of the triangle. A patch ends at the side opposite to its
/// middle, so that the three corners of a triangle have all patches in it.
const HEIGHT: f64 = 0.866_025_403_784_438_6;

/// Stream of the random choices of a patch.
const STREAM: u64 = 0x65;

/// Samples a texture at any position. It keeps the patches of the last triangle, which neighboring positions share.
#[derive(Debug, Clone)]
pub struct Sampler<'t> {
    texture: &'t Texture,
    seed: u64,
    /// Column and row of the triangle's cell, and whether it is the lower right one of the two.
    triangle: Option<(i64, i64, bool)>,
    patches: [Patch; 3],
}

/// A patch around a corner of the lattice.
#[derive(Debug, Clone, Copy, Default)]
struct Patch {
    /// Position of the corner, in samples of the example.
    corner: [f64; 2],
    /// The sample nearest to the corner.
    nearest: [i64; 2],
    /// Index of the sample of the example that lies there.
    middle: i64,
    /// Change of the index for a step to the east and to the south.
    steps: [i64; 2],
}

/// The weights of four samples in the interpolating cubic of Catmull and Rom (1974), at a fraction between the second
/// and the third.
#[inline(always)]
fn cubic(t: f32) -> [f32; 4] {
    [
        ((1.0 - 0.5 * t) * t - 0.5) * t,
        (1.5 * t - 2.5) * t * t + 1.0,
        ((2.0 - 1.5 * t) * t + 0.5) * t,
        (0.5 * t - 0.5) * t * t,
    ]
}

impl<'t> Sampler<'t> {
    pub(super) fn new(texture: &'t Texture, seed: u64) -> Sampler<'t> {
        Sampler { texture, seed, triangle: None, patches: [Patch::default(); 3] }
    }

    /// The patch around the corner at a column and row of the lattice.
    fn patch(&self, column: i64, row: i64) -> Patch {
        let Texture { width, height, radius, rotate, .. } = *self.texture;
        let side = radius / HEIGHT;
        let corner = [(column as f64 + 0.5 * row as f64) * side, row as f64 * radius];
        let mut random = Random::of_state(hash::node(self.seed, 0, column, row, STREAM));
        let border = radius.ceil() as usize + BORDER;
        // Uniform positions would show the middle of the example more often than its sides, because patches are inside.
        // With those of an arcsine distribution all samples are shown about equally often.
        let mut draw = |length: usize| {
            let share = 0.5 - 0.5 * libm::cos(std::f64::consts::PI * random.share());
            let room = length.saturating_sub(2 * border).max(1);
            (border + ((share * room as f64) as usize).min(room - 1)) as i64
        };
        let (x, y) = (draw(width), draw(height));
        let along = width as i64;
        let [east, south] = [1, along];
        let choice = if rotate { random.below(8) } else { 0 };
        let [east, south] = if choice & 4 == 0 { [east, south] } else { [south, east] };
        let sign = |bit: usize| if choice & bit == 0 { 1 } else { -1 };
        Patch {
            corner,
            nearest: corner.map(|at| at.round() as i64),
            middle: y * along + x,
            steps: [sign(1) * east, sign(2) * south],
        }
    }

    /// Finds the patches around a position, in samples.
    #[inline(always)]
    fn move_to(&mut self, x: f64, y: f64) {
        let radius = self.texture.radius;
        let b = y / radius;
        let a = x * HEIGHT / radius - 0.5 * b;
        let (column, row) = (a.floor(), b.floor());
        let is_lower = (a - column) + (b - row) > 1.0;
        let (column, row) = (column as i64, row as i64);
        let triangle = Some((column, row, is_lower));
        if self.triangle != triangle {
            self.triangle = triangle;
            let shift = i64::from(is_lower);
            self.patches = [
                self.patch(column.saturating_add(shift), row.saturating_add(shift)),
                self.patch(column.saturating_add(1), row),
                self.patch(column, row.saturating_add(1)),
            ];
        }
    }

    /// The value at a position, in metres. A position that is not finite gives NaN.
    #[inline]
    pub fn at(&mut self, x: f64, y: f64) -> f32 {
        if !(x.is_finite() && y.is_finite()) {
            return f32::NAN;
        }
        let texture = self.texture;
        let ((i, u), (j, v)) = (split(x, texture.cell), split(y, texture.cell));
        let (x, y) = (x / texture.cell, y / texture.cell);
        self.move_to(x, y);
        let squared = 1.0 / (texture.radius * texture.radius);
        // Far away, where doubles have no fractions, positions stay inside the patch.
        let most = texture.radius as i64 + 1;
        let on_sample = u == 0.0 && v == 0.0;
        let (columns, rows) = (cubic(u), cubic(v));
        let mut sums = [0.0f32; 4];
        let mut squares = 0.0f32;
        for Patch { corner, nearest, middle, steps } in &self.patches {
            let (dx, dy) = (x - corner[0], y - corner[1]);
            let bump = (1.0 - (dx * dx + dy * dy) * squared).max(0.0) as f32;
            let weight = (bump * bump) * (bump * bump);
            squares += weight * weight;
            let column = i.saturating_sub(nearest[0]).clamp(-most, most);
            let row = j.saturating_sub(nearest[1]).clamp(-most, most);
            let at = middle + column * steps[0] + row * steps[1];
            if on_sample {
                sums[1] += weight * texture.sample(at);
                continue;
            }
            let mut first = at - steps[0] - steps[1];
            for share in rows {
                let samples = texture.row(first, steps[0]);
                let share = weight * share;
                for (sum, sample) in sums.iter_mut().zip(samples) {
                    *sum += share * sample;
                }
                first += steps[1];
            }
        }
        let sum = match on_sample {
            true => sums[1],
            false => (sums[0] * columns[0] + sums[1] * columns[1]) + (sums[2] * columns[2] + sums[3] * columns[3]),
        };
        // The variance of a sum of independent samples is that of one of them. Only where numbers of triangles overflow
        // there are no patches.
        texture.inverse.value(texture.mean + sum / squares.max(f32::MIN_POSITIVE).sqrt())
    }
}

impl Texture {
    #[inline(always)]
    fn sample(&self, at: i64) -> f32 {
        self.samples.get(at as usize).copied().unwrap_or(0.0)
    }

    /// Four samples from one on, in steps.
    #[inline(always)]
    fn row(&self, first: i64, step: i64) -> [f32; 4] {
        if step == 1
            && let Some(samples) = self.samples.get(first as usize..).and_then(|samples| samples.first_chunk())
        {
            return *samples;
        }
        [0, 1, 2, 3].map(|k| self.sample(first + k * step))
    }
}

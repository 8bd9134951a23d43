//! Light of the sky on each sample, with the horizon and the color of every direction.
//!
//! In each of sixteen directions the horizon of every sample is found exactly: lines through the land are traversed
//! against the direction while the convex hull of the ground is updated (V. Timonen, J. Westerholm, "Scalable height
//! field self-shadowing", 2010), in a few steps per sample for any distance. The light of the sky above that horizon on
//! the sample's slope is read from a table of sums, so there is neither noise nor a radius that limits the shade of
//! mountains.

use orogen_grid::parallel;

use super::relief::Relief;
use super::sky::Sky;
use super::vector::Vector;
use orogen_grid::error::Result;
use orogen_grid::grid::transposed;
use orogen_grid::progress::Progress;
use orogen_io::palette::color::Light;

/// Number of directions.
const AZIMUTHS: usize = 16;

/// Maximum number of samples per side; on larger land, light is computed for every second sample, every third, and so
/// on.
const MOST: usize = 2048;

/// Entries of the tables, over the sine of the horizon's elevation.
pub const ENTRIES: usize = 96;

/// Light of the sky on the ground (red, green, blue, in the sky's unit times steradians), and the share relative to a
/// uniform sky without obstacles.
pub type Shed = [f32; 4];

/// A device that computes the light of the sky, such as a graphics card.
pub trait SkylightDevice {
    /// Computes the light of the sky on every sample of the land; `None` if the CPU must do it.
    ///
    /// # Errors
    /// If the work is cancelled.
    fn skylight(&self, input: &SkylightInput, progress: &Progress) -> Result<Option<Vec<Shed>>>;
}

/// The light of the sky on every sample, or every n-th.
#[derive(Debug, Clone)]
pub(super) struct Skylight {
    pub columns: usize,
    pub rows: usize,
    pub stride: usize,
    pub shed: Vec<Shed>,
}

impl Skylight {
    /// Computes the light, on `device` if it supports that.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn new(
        relief: &Relief,
        sky: &Sky,
        device: Option<&dyn SkylightDevice>,
        progress: &Progress,
    ) -> Result<Skylight> {
        let input = SkylightInput::new(relief, sky);
        let [columns, rows] = input.size;
        let lit = device.map(|device| device.skylight(&input, progress)).transpose()?.flatten();
        let shed = match lit.filter(|shed| shed.len() == columns * rows) {
            Some(shed) => shed,
            None => input.light(progress)?,
        };
        Ok(Skylight { columns, rows, stride: input.stride, shed })
    }

    /// The light at a position in cells.
    pub fn at(&self, x: f64, y: f64) -> Shed {
        let scale = 1.0 / self.stride as f64;
        let (x, y) =
            ((x * scale).clamp(0.0, (self.columns - 1) as f64), (y * scale).clamp(0.0, (self.rows - 1) as f64));
        let (i, j) = ((x as usize).min(self.columns.saturating_sub(2)), (y as usize).min(self.rows.saturating_sub(2)));
        let (u, v) = ((x - i as f64) as f32, (y - j as f64) as f32);
        let (east, south) = (usize::from(self.columns > 1), if self.rows > 1 { self.columns } else { 0 });
        let at = j * self.columns + i;
        let [nw, ne, sw, se] = [at, at + east, at + south, at + south + east].map(|at| self.shed[at]);
        std::array::from_fn(|c| {
            let north = nw[c] + (ne[c] - nw[c]) * u;
            north + (sw[c] + (se[c] - sw[c]) * u - north) * v
        })
    }
}

/// The input of the computation, for the CPU and for other devices.
#[derive(Debug)]
#[non_exhaustive]
pub struct SkylightInput {
    /// Number of columns and rows.
    pub size: [usize; 2],
    /// The z of the ground at every sample, in cells, row by row.
    pub bed: Vec<f32>,
    /// The same values, column by column.
    pub turned: Vec<f32>,
    /// The horizontal directions, of length 1, with the sky in each of them.
    pub directions: Vec<([f64; 2], Dome)>,
    stride: usize,
}

impl SkylightInput {
    fn new(relief: &Relief, sky: &Sky) -> SkylightInput {
        let [all_columns, all_rows] = relief.samples();
        let stride = all_columns.max(all_rows).div_ceil(MOST);
        let (columns, rows) = (all_columns.div_ceil(stride), all_rows.div_ceil(stride));
        let bed = parallel::samples(rows * columns, |at| {
            relief.bed()[at / columns * stride * all_columns + at % columns * stride] / stride as f32
        });
        let turned = transposed(&bed, columns);
        let direction = |k: usize| {
            // Between the axes, with which ridges on grids often align.
            let azimuth = (k as f64 + 0.5) * 360.0 / AZIMUTHS as f64;
            let towards = Vector::towards(azimuth, 0.0);
            ([towards.x, towards.y], Dome::new(sky, azimuth))
        };
        SkylightInput { size: [columns, rows], bed, turned, directions: (0..AZIMUTHS).map(direction).collect(), stride }
    }

    /// The light on every sample, computed by the CPU.
    fn light(&self, progress: &Progress) -> Result<Vec<Shed>> {
        let [columns, rows] = self.size;
        let nothing = || vec![[0.0f32; 4]; self.bed.len()];
        let (mut shed, mut shed_turned) = (nothing(), nothing());
        progress.expect(AZIMUTHS as f64);
        for ([x, y], dome) in &self.directions {
            progress.check()?;
            if x.abs() >= y.abs() {
                let sweep = Sweep { bed: &self.bed, length: columns, lines: rows, towards: [*x, *y] };
                sweep.gather(dome, &mut shed);
            } else {
                let sweep = Sweep { bed: &self.turned, length: rows, lines: columns, towards: [*y, *x] };
                sweep.gather(dome, &mut shed_turned);
            }
            progress.advance(1.0);
        }
        let back = transposed(&shed_turned, rows);
        let pieces = shed.chunks_mut(parallel::SAMPLES).zip(back.chunks(parallel::SAMPLES));
        parallel::for_each(pieces, |(shed, more)| {
            shed.as_flattened_mut().iter_mut().zip(more.as_flattened()).for_each(|(s, m)| *s += m);
        });
        Ok(shed)
    }
}

/// The sky in one direction, summed from the zenith down: for level ground and for slopes that face it.
#[derive(Debug)]
pub struct Dome {
    /// By the sine of the horizon's elevation: light times cos^2, then light times sin cos, each followed by the value
    /// for a uniform sky.
    pub sums: Vec<[[f32; 4]; 2]>,
}

impl Dome {
    fn new(sky: &Sky, azimuth: f64) -> Dome {
        let width = std::f32::consts::TAU / AZIMUTHS as f32;
        let mut sums = vec![[[0.0; 4]; 2]; ENTRIES + 1];
        // From the zenith down; each entry adds the ring up to the elevation of the previous one.
        for k in (0..ENTRIES).rev() {
            let mut ring = [[0.0f32; 4]; 2];
            const PARTS: usize = 4;
            let elevation = |share: f64| libm::asin((share / ENTRIES as f64).clamp(0.0, 1.0));
            let (low, high) = (elevation(k as f64), elevation((k + 1) as f64));
            for part in 0..PARTS {
                let angle = low + (high - low) * (part as f64 + 0.5) / PARTS as f64;
                let (sin, cos) = libm::sincos(angle);
                let [red, green, blue]: Light = sky.falling(Vector::towards(azimuth, angle.to_degrees()));
                let weight = width * ((high - low) / PARTS as f64) as f32;
                for (c, light) in [red, green, blue, std::f32::consts::FRAC_1_PI].into_iter().enumerate() {
                    ring[0][c] += light * (cos * cos) as f32 * weight;
                    ring[1][c] += light * (sin * cos) as f32 * weight;
                }
            }
            for kind in 0..2 {
                for c in 0..4 {
                    sums[k][kind][c] = sums[k + 1][kind][c] + ring[kind][c];
                }
            }
        }
        Dome { sums }
    }

    /// The light above a horizon with slope `slope`, on ground whose normal has the component `lean` towards it and
    /// `up` upward.
    fn light(&self, slope: f32, lean: f32, up: f32) -> Shed {
        let slope = slope.max(0.0);
        let at = slope / (1.0 + slope * slope).sqrt() * ENTRIES as f32;
        let k = (at as usize).min(ENTRIES - 1);
        let share = at - k as f32;
        let (low, high) = (&self.sums[k], &self.sums[k + 1]);
        std::array::from_fn(|c| {
            let part = |kind: usize| low[kind][c] + (high[kind][c] - low[kind][c]) * share;
            (lean * part(0) + up * part(1)).max(0.0)
        })
    }
}

/// Lines in one direction that cross every column of the land.
struct Sweep<'a> {
    bed: &'a [f32],
    /// Number of columns, and of rows.
    length: usize,
    lines: usize,
    /// The direction along the rows and across them; the first component has the larger magnitude.
    towards: [f64; 2],
}

impl Sweep<'_> {
    /// Rows per column of a line.
    fn slant(&self) -> f64 {
        self.towards[1] / self.towards[0]
    }

    /// The height of a line's ground at column `i` and row `y`.
    fn height(&self, i: usize, y: f64) -> f32 {
        let y = y.clamp(0.0, (self.lines - 1) as f64);
        let j = (y as usize).min(self.lines.saturating_sub(2));
        let share = (y - j as f64) as f32;
        let north = self.bed[j * self.length + i];
        let south = self.bed[(j + 1).min(self.lines - 1) * self.length + i];
        north + (south - north) * share
    }

    /// The slope of the horizon along a line that crosses column 0 at row `start`, at every column where it is on the
    /// land or next to it.
    fn horizon(&self, start: i64, hull: &mut Vec<[f32; 2]>, out: &mut [f32]) {
        hull.clear();
        let slant = self.slant();
        let step = (1.0 / self.towards[0].abs()) as f32;
        let last = (self.lines - 1) as f64;
        let forwards = self.towards[0] > 0.0;
        for k in 0..self.length {
            // Ground ahead is visited first.
            let i = if forwards { self.length - 1 - k } else { k };
            let y = start as f64 + slant * i as f64;
            if y < -1.0 || y > last + 1.0 {
                continue;
            }
            let (way, z) = (k as f32 * step, self.height(i, y));
            let slope = |point: [f32; 2]| (point[1] - z) / (way - point[0]);
            while let [.., second, first] = hull[..] {
                if slope(second) < slope(first) {
                    break;
                }
                hull.pop();
            }
            out[i] = hull.last().map_or(0.0, |&point| slope(point));
            hull.push([way, z]);
        }
    }

    /// Adds this direction's light to every sample.
    fn gather(&self, dome: &Dome, shed: &mut [Shed]) {
        let (length, lines, slant) = (self.length, self.lines, self.slant());
        let drift = slant * (length - 1) as f64;
        // The starting rows of lines such that each sample lies between two lines.
        let first = (-drift.max(0.0)) as i64 - 1;
        let count = lines + drift.abs() as usize + 3;
        let mut horizons = vec![0.0f32; count * length];
        parallel::for_each_init(horizons.chunks_exact_mut(length).enumerate(), Vec::new, |hull, (line, out)| {
            self.horizon(first + line as i64, hull, out);
        });
        let [along, across] = self.towards.map(|part| part as f32);
        parallel::for_each(shed.chunks_exact_mut(length).enumerate(), |(j, shed)| {
            let (above, below) = (j.saturating_sub(1), (j + 1).min(lines - 1));
            let rows = (below - above).max(1) as f32;
            for (i, shed) in shed.iter_mut().enumerate() {
                let line = j as f64 - slant * i as f64 - first as f64;
                let index = line as usize;
                let share = (line - index as f64) as f32;
                let one = horizons[index * length + i];
                let other = horizons[(index + 1).min(count - 1) * length + i];
                let slope = one + (other - one) * share;
                let (west, east) = (i.saturating_sub(1), (i + 1).min(length - 1));
                let columns = (east - west).max(1) as f32;
                let gx = (self.bed[j * length + east] - self.bed[j * length + west]) / columns;
                let gy = (self.bed[below * length + i] - self.bed[above * length + i]) / rows;
                let up = 1.0 / (1.0 + gx * gx + gy * gy).sqrt();
                let lean = -(gx * along + gy * across) * up;
                shed.iter_mut().zip(dome.light(slope, lean, up)).for_each(|(shed, light)| *shed += light);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::relief::Land;
    use orogen_grid::grid::{Grid, Window};

    fn skylight(columns: usize, rows: usize, f: impl Fn(f64, f64) -> f64) -> Skylight {
        let window = Window::new(columns, rows, 1.0);
        let data = (0..window.len()).map(|at| f((at % columns) as f64, (at / columns) as f64) as f32).collect();
        let heights = Grid::from_data(window, data).unwrap();
        let relief = Relief::new(&Land { heights: &heights, surface: None, flow: None, sea_level: None }, 1.0).unwrap();
        Skylight::new(&relief, &Sky::new(200.0, 40.0), None, &Progress::none()).unwrap()
    }

    #[test]
    fn level_ground_sees_all_of_the_sky() {
        let level = skylight(33, 20, |_, _| 5.0);
        assert!(
            level.shed.iter().all(|shed| (shed[3] - 1.0).abs() < 2e-3 && *shed == level.shed[0]),
            "{:?}",
            level.shed[0]
        );
        assert!(level.shed[0][2] > level.shed[0][0], "it is blue");
    }

    #[test]
    fn the_foot_of_a_long_wall_sees_half_and_a_slope_what_its_tilt_leaves() {
        let wall = skylight(201, 101, |x, _| if x >= 100.0 { 1e4 } else { 0.0 });
        let foot = wall.at(98.0, 50.0)[3];
        assert!((foot - 0.5).abs() < 0.04, "{foot}");
        // A plane that rises at 45 degrees sees (1 + cos 45) / 2 of the sky, except in the directions in which it soon
        // ends.
        let slope = skylight(401, 401, |x, _| x);
        let middle = slope.at(200.0, 200.0)[3];
        let expect = 0.5 * (1.0 + 0.5f32.sqrt());
        assert!((middle - expect).abs() < 0.02, "{middle} {expect}");
    }

    #[test]
    fn turning_the_land_turns_the_light() {
        let height = |x: f64, y: f64| 8.0 * libm::sin(x * 0.3) * libm::cos(y * 0.2) + 0.1 * x;
        let (one, other) = (skylight(40, 31, height), skylight(31, 40, |x, y| height(y, x)));
        for (x, y) in [(3.0, 4.0), (20.0, 11.0), (35.0, 29.0)] {
            assert!((one.at(x, y)[3] - other.at(y, x)[3]).abs() < 1e-4);
        }
    }

    #[test]
    fn horizons_are_those_of_a_search() {
        let (columns, rows) = (30, 20);
        let bed: Vec<f32> = (0..columns * rows).map(|k| ((k * 7919) % 53) as f32 / 9.0).collect();
        for towards in [[1.0, 0.0], [-0.8, 0.6], [0.9, -0.435_889_9]] {
            let sweep = Sweep { bed: &bed, length: columns, lines: rows, towards };
            for start in -20..35 {
                let mut out = vec![f32::NAN; columns];
                sweep.horizon(start, &mut Vec::new(), &mut out);
                let place = |i: usize| start as f64 + sweep.slant() * i as f64;
                let on = |i: &usize| (-1.0..=rows as f64).contains(&place(*i));
                for i in (0..columns).filter(on) {
                    let z = sweep.height(i, place(i));
                    let ahead = |other: &usize| if towards[0] > 0.0 { *other > i } else { *other < i };
                    let rise = |other: usize| {
                        (sweep.height(other, place(other)) - z) / (other.abs_diff(i) as f32 / towards[0].abs() as f32)
                    };
                    let most = (0..columns).filter(ahead).filter(on).map(rise).fold(f32::NEG_INFINITY, f32::max);
                    let most = if most == f32::NEG_INFINITY { 0.0 } else { most };
                    assert!((out[i] - most).abs() < 1e-4, "{towards:?} {start} {i}: {} {most}", out[i]);
                }
            }
        }
    }
}

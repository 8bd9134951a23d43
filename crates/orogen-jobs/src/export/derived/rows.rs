//! Computation of a derived layer in bands of rows; only the rows of the current halo are held.

use orogen_grid::parallel;

use super::layer::{Around, RowLayer};
use crate::options::Options;
use orogen_engine::bands::Bands;
use orogen_engine::device::{Computed, PassRun, PassStep, PlanGrid};
use orogen_engine::lower::Extent;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use std::borrow::Cow;

/// Rows that are computed at once, unless they are very wide.
const ROWS: usize = 256;
const SAMPLES: usize = 1 << 21;

/// Rows per thread.
const STRIP: usize = 16;

/// Maximum number of rows of an input band.
const BAND: usize = 512;

/// The rows of a derived layer from the north, in bands: one grid per channel.
pub struct Rows<'w> {
    derived: &'static RowLayer,
    channels: usize,
    window: Window,
    world: &'w World,
    source: Source<'w>,
    options: Options,
    /// The next row.
    next: usize,
}

/// The input layers.
struct Source<'w> {
    bands: Bands<'w>,
    /// Their window.
    wide: Window,
    /// For each layer, the rows that are held; and the first of them.
    rows: Vec<Vec<f32>>,
    first: usize,
}

impl<'w> Rows<'w> {
    /// The rows over a window, within the world's memory minus `beside` bytes.
    ///
    /// # Errors
    /// The errors of [`World::bands`].
    pub fn new(
        derived: &'static RowLayer,
        world: &'w World,
        window: &Window,
        reserved: u64,
        progress: &Progress,
    ) -> Result<Rows<'w>> {
        let reach = (derived.reach)(window.cell);
        let wide = world.surroundings(window, reach);
        let others = (derived.layers)(world.recipe());
        let layers: Vec<&str> = [HEIGHT].into_iter().chain(others.iter().map(String::as_str)).collect();
        let channels = (derived.channels)(world.recipe()).len();
        let held = (layers.len() * (at_once(window) + 2 * reach + BAND) * wide.width) as u64;
        let made = (channels * at_once(window) * window.width) as u64;
        let reserved = reserved.saturating_add(4 * (held + 2 * made));
        let bands = world.bands(&layers, &wide, reserved, progress)?;
        let source = Source { bands, wide, rows: vec![Vec::new(); layers.len()], first: 0 };
        Ok(Rows { derived, channels, window: *window, world, source, options: Options::default(), next: 0 })
    }

    /// The same with these options of the layer.
    #[must_use]
    pub fn with_options(self, options: Options) -> Rows<'w> {
        Rows { options, ..self }
    }

    /// All rows at once: one grid per channel.
    ///
    /// # Errors
    /// The errors of the rows.
    pub fn whole(self) -> Result<Vec<Grid>> {
        let mut all = vec![Grid::filled(self.window, 0.0); self.channels];
        for band in self {
            all.iter_mut().zip(band?.0).for_each(|(all, band)| all.paste(&band));
        }
        Ok(all)
    }

    /// The next rows, and the number of finite heights under them.
    fn make(&mut self) -> Result<(Vec<Grid>, FiniteCount)> {
        let height = at_once(&self.window).min(self.window.height - self.next);
        let band = Window { y: self.window.y + self.next as i64, height, ..self.window };
        self.next += height;
        let reach = (self.derived.reach)(band.cell);
        let grids = self.source.around(&band.grown(reach))?;
        let Some((heights, layers)) = grids.split_first() else { return Ok((Vec::new(), FiniteCount::default())) };
        let around = Around { heights, layers, recipe: self.world.recipe(), options: &self.options };
        let beneath = heights.crop(&band.intersection(heights.window()));
        // Shades and weights are finite even if the heights are not.
        let finite = beneath.map_or_else(FiniteCount::default, |beneath| FiniteCount::of(beneath.data()));
        if let Some(made) = self.on_device(&around, &band)? {
            return Ok((made, finite));
        }
        let strips: Vec<Window> = (0..height)
            .step_by(STRIP)
            .map(|first| Window { y: band.y + first as i64, height: STRIP.min(height - first), ..band })
            .collect();
        let derived = self.derived;
        let made: Vec<Vec<Grid>> =
            self.world.install(|| parallel::map(&strips, |strip| (derived.make)(&around, strip)));
        let mut out = vec![Grid::filled(band, 0.0); self.channels];
        for strip in made {
            out.iter_mut().zip(&strip).for_each(|(out, strip)| out.paste(strip));
        }
        Ok((out, finite))
    }

    /// The channels over a band, made by the device of the world; `None` if there is none, or the processor is to do
    /// it.
    fn on_device(&self, around: &Around, band: &Window) -> Result<Option<Vec<Grid>>> {
        let Some((device, lowered)) = self.world.device().zip(self.derived.lowered.as_ref()) else { return Ok(None) };
        let extent = Extent::Halo((self.derived.reach)(band.cell));
        let passes = (lowered.passes)(band.cell, around.options).with_planes(extent, 1, &vec![true; self.channels]);
        let inputs = vec![Some(Cow::Owned(PlanGrid::from((lowered.heights)(around, band))))];
        let run = PassRun { steps: &[PassStep { passes, inputs, window: *band }], above: &[], stays: false };
        let Computed::Done(made) = device.run(&run, &Progress::none())? else { return Ok(None) };
        Ok(Some(made.into_iter().filter_map(PlanGrid::into_memory).collect()))
    }
}

/// Number of rows that are computed at once.
fn at_once(window: &Window) -> usize {
    (SAMPLES / window.width.max(1)).clamp(STRIP, ROWS).min(window.height.max(1))
}

impl Source<'_> {
    /// The inputs over a window, one grid per layer; drops all rows above it.
    fn around(&mut self, window: &Window) -> Result<Vec<Grid>> {
        let window = window.intersection(&self.wide);
        let (top, bottom) = ((window.y - self.wide.y) as usize, (window.bottom() - self.wide.y) as usize);
        let width = self.wide.width;
        for rows in &mut self.rows {
            rows.drain(..(top - self.first) * width);
        }
        self.first = top;
        while self.first + self.rows[0].len() / width < bottom {
            match self.bands.next() {
                Some(band) => {
                    self.rows.iter_mut().zip(band?).for_each(|(rows, band)| rows.extend_from_slice(band.data()));
                }
                None => break,
            }
        }
        let grids = self.rows.iter().map(|rows| {
            let mut grid = Grid::filled(Window { x: self.wide.x, width, ..window }, 0.0);
            let samples = grid.data().len();
            grid.data_mut().copy_from_slice(&rows[..samples]);
            grid
        });
        Ok(grids.collect())
    }
}

impl Iterator for Rows<'_> {
    type Item = Result<(Vec<Grid>, FiniteCount)>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.next >= self.window.height {
            return None;
        }
        let made = self.make();
        if made.is_err() {
            self.next = self.window.height;
        }
        Some(made)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::derived::list;
    use orogen_engine::recipe::document::Recipe;

    /// A world with a sea, steep ground and rivers, bounded or unbounded.
    fn world(size: &str, layer: &str) -> World {
        let text = format!(
            "orogen = 1\n[world]\nseed = 5\n{size}\ncell = 20\nsea_level = 40\n[nodes.hills]\nop = \"fbm\"\nwavelength = 900\n[nodes.land]\n\
             op = \"remap\"\nsource = \"hills\"\nfrom = [-1, 1]\nto = [-300, 700]\n[outputs]\nheight = \"land\"\n"
        );
        let mut recipe = Recipe::parse(&text, "test").unwrap();
        list::prepare(&mut recipe, layer, &Options::default()).unwrap();
        World::open(recipe).unwrap()
    }

    fn rows_of(name: &str) -> &'static RowLayer {
        list::named(name).unwrap().rows().unwrap()
    }

    fn made(derived: &'static RowLayer, world: &World, window: &Window) -> Vec<Grid> {
        let mut all = vec![Grid::filled(*window, 0.0); (derived.channels)(world.recipe()).len()];
        let progress = Progress::none();
        for band in Rows::new(derived, world, window, 0, &progress).unwrap() {
            all.iter_mut().zip(band.unwrap().0).for_each(|(all, band)| all.paste(&band));
        }
        all
    }

    fn bits(grids: &[Grid]) -> Vec<Vec<u32>> {
        grids.iter().map(|grid| grid.data().iter().map(|sample| sample.to_bits()).collect()).collect()
    }

    #[test]
    fn a_window_is_the_crop_of_the_whole() {
        for layer in list::all() {
            let Some(derived) = layer.rows() else { continue };
            for size in ["size = [6000, 8000]", ""] {
                let world = world(size, layer.name);
                // More rows than are computed at once, up to the far edge that belongs to the neighbor.
                let window = Window::new(301, 401, 20.0);
                let whole = made(derived, &world, &window);
                for part in [
                    Window { x: 0, y: 0, width: 7, height: 5, ..window },
                    Window { x: 100, y: 250, width: 33, height: 40, ..window },
                    Window { x: 290, y: 390, width: 11, height: 11, ..window },
                    Window { x: 0, y: 200, width: 301, height: 1, ..window },
                ] {
                    let cut: Vec<Grid> = whole.iter().map(|grid| grid.crop(&part).unwrap()).collect();
                    assert_eq!(bits(&made(derived, &world, &part)), bits(&cut), "{} {part:?} {size}", layer.name);
                }
            }
        }
    }

    #[test]
    fn weights_add_up_and_rivers_have_beds() {
        let world = world("size = [6000, 8000]", "splat");
        let weights = made(rows_of("splat"), &world, &Window::new(300, 400, 20.0));
        for k in 0..weights[0].data().len() {
            assert!((weights.iter().map(|grid| grid.data()[k]).sum::<f32>() - 1.0).abs() < 1e-5);
        }
        let share = |k: usize| weights[k].data().iter().filter(|weight| **weight > 0.5).count();
        assert!(share(0) > 10_000 && share(1) > 1000 && share(5) > 100, "{:?}", [0, 1, 2, 3, 4, 5].map(share));
    }

    #[test]
    fn normals_have_length_one() {
        let world = world("", "normal");
        let parts = made(rows_of("normal"), &world, &Window::new(50, 40, 20.0));
        for k in 0..2000 {
            let length: f32 = parts.iter().map(|part| part.data()[k] * part.data()[k]).sum();
            assert!((length - 1.0).abs() < 1e-5 && parts[2].data()[k] > 0.0);
        }
    }
}

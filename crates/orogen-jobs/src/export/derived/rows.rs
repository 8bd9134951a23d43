//! The channels of a derived layer, in bands of rows.

use orogen_grid::parallel;

use super::layer::Channels;
use orogen_engine::bands::Bands;
use orogen_engine::world::World;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;

/// Number of rows that are computed at once, unless they are very wide.
const ROWS: usize = 256;
const SAMPLES: usize = 1 << 21;

/// Rows per thread.
const STRIP: usize = 16;

/// The rows of a derived layer from the north, in bands: one grid per channel.
pub struct Rows<'w> {
    derived: &'static Channels,
    channels: usize,
    window: Window,
    world: &'w World,
    bands: Bands<'w>,
    /// The layers that are read, over the current band, and the band's next row.
    layers: Vec<Grid>,
    next: usize,
}

impl<'w> Rows<'w> {
    /// The rows over a window, within the world's memory minus `reserved` bytes.
    ///
    /// # Errors
    /// The errors of [`World::bands`].
    pub fn new(
        derived: &'static Channels,
        world: &'w World,
        window: &Window,
        reserved: u64,
        progress: &Progress,
    ) -> Result<Rows<'w>> {
        let layers = (derived.layers)(world.recipe());
        let layers: Vec<&str> = layers.iter().map(String::as_str).collect();
        let channels = (derived.names)(world.recipe()).len();
        let made = (channels * at_once(window) * window.width) as u64;
        let bands = world.bands(&layers, window, reserved.saturating_add(8 * made), progress)?;
        Ok(Rows { derived, channels, window: *window, world, bands, layers: Vec::new(), next: 0 })
    }

    /// All rows at once: one grid per channel.
    ///
    /// # Errors
    /// The errors of computing the rows.
    pub fn whole(self) -> Result<Vec<Grid>> {
        let mut all = vec![Grid::filled(self.window, 0.0); self.channels];
        for band in self {
            all.iter_mut().zip(band?.0).for_each(|(all, band)| all.paste(&band));
        }
        Ok(all)
    }

    /// The next rows of the current band, and the number of finite samples of the first layer. Weights and colors are
    /// finite even where the heights are not.
    fn make(&mut self, band: &Window) -> (Vec<Grid>, FiniteCount) {
        let Some(make) = self.derived.make else {
            let layers = std::mem::take(&mut self.layers);
            let count = layers.first().map_or_else(FiniteCount::default, |layer| FiniteCount::of(layer.data()));
            return (layers, count);
        };
        let height = at_once(band).min(band.height - self.next);
        let rows = Window { y: band.y + self.next as i64, height, ..*band };
        let samples = self.next * band.width..(self.next + height) * band.width;
        self.next += height;
        let strips: Vec<Window> = (0..height)
            .step_by(STRIP)
            .map(|first| Window { y: rows.y + first as i64, height: STRIP.min(height - first), ..rows })
            .collect();
        let (layers, recipe) = (&self.layers, self.world.recipe());
        let made: Vec<Vec<Grid>> = self.world.install(|| parallel::map(&strips, |strip| make(recipe, layers, strip)));
        let mut out = vec![Grid::filled(rows, 0.0); self.channels];
        for strip in made {
            out.iter_mut().zip(&strip).for_each(|(out, strip)| out.paste(strip));
        }
        (out, FiniteCount::of(&self.layers[0].data()[samples]))
    }
}

/// Number of rows that are computed at once.
fn at_once(window: &Window) -> usize {
    (SAMPLES / window.width.max(1)).clamp(STRIP, ROWS).min(window.height.max(1))
}

impl Iterator for Rows<'_> {
    type Item = Result<(Vec<Grid>, FiniteCount)>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.layers.first().is_none_or(|layer| self.next >= layer.height()) {
            // The last band is dropped before the next one is made.
            (self.layers, self.next) = (Vec::new(), 0);
            match self.bands.next()? {
                Ok(layers) => self.layers = layers,
                Err(error) => return Some(Err(error)),
            }
        }
        let band = *self.layers.first()?.window();
        Some(Ok(self.make(&band)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::derived::list;
    use crate::export::layer_source::LayerSource;
    use crate::options::Options;
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

    fn made(layer: &str, world: &World, window: &Window) -> Vec<Grid> {
        LayerSource::new(world, layer, *window, &Progress::none()).unwrap().whole().unwrap()
    }

    fn bits(grids: &[Grid]) -> Vec<Vec<u32>> {
        grids.iter().map(|grid| grid.data().iter().map(|sample| sample.to_bits()).collect()).collect()
    }

    #[test]
    fn a_window_is_the_crop_of_the_whole() {
        for layer in
            ["slope", "aspect", "curvature", "hillshade", "occlusion", "normal", "splat", "albedo", "roughness"]
        {
            for size in ["size = [6000, 8000]", ""] {
                let world = world(size, layer);
                // More rows than are computed at once, up to the far edge that belongs to the next window.
                let window = Window::new(301, 401, 20.0);
                let whole = made(layer, &world, &window);
                for part in [
                    Window { x: 0, y: 0, width: 7, height: 5, ..window },
                    Window { x: 100, y: 250, width: 33, height: 40, ..window },
                    Window { x: 290, y: 390, width: 11, height: 11, ..window },
                    Window { x: 0, y: 200, width: 301, height: 1, ..window },
                ] {
                    let cut: Vec<Grid> = whole.iter().map(|grid| grid.crop(&part).unwrap()).collect();
                    assert_eq!(bits(&made(layer, &world, &part)), bits(&cut), "{layer} {part:?} {size}");
                }
            }
        }
    }

    /// The heights of a bounded world are extrapolated, whatever its fields are beyond its edges.
    #[test]
    fn at_the_edges_of_a_world_only_its_ground_counts() {
        use orogen_grid::analysis::slope::{extended, normals, slope_degrees};
        use orogen_grid::analysis::{hillshade, sky};
        let (window, size) = (Window::new(301, 401, 20.0), "size = [6000, 8000]");
        let heights = world(size, "height").window("height", &window).unwrap();
        let wide = extended(&heights);
        let light = hillshade::Light::default();
        for (layer, expected) in [
            ("slope", vec![slope_degrees(&wide)]),
            ("hillshade", vec![hillshade(&wide, &light)]),
            ("normal", normals(&wide).into()),
            ("occlusion", vec![sky::sky_view(&heights, &window, 50)]),
        ] {
            assert_eq!(bits(&made(layer, &world(size, layer), &window)), bits(&expected), "{layer}");
        }
    }

    #[test]
    fn weights_add_up_and_rivers_have_beds() {
        let world = world("size = [6000, 8000]", "splat");
        let weights = made("splat", &world, &Window::new(300, 400, 20.0));
        for k in 0..weights[0].data().len() {
            assert!((weights.iter().map(|grid| grid.data()[k]).sum::<f32>() - 1.0).abs() < 1e-5);
        }
        let share = |k: usize| weights[k].data().iter().filter(|weight| **weight > 0.5).count();
        assert!(share(0) > 10_000 && share(1) > 1000 && share(5) > 100, "{:?}", [0, 1, 2, 3, 4, 5].map(share));
    }
}

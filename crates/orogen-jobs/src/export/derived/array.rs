//! Derived layers of heights in memory, without a world.
//!
//! A filter of a few operations a sample takes less time than a world needs to bring it the samples: a plan, tiles with
//! halos, their copies. Over an array the filter is applied to the samples themselves.

use std::ops::RangeInclusive;

use super::layer::Made;
use super::list;
use crate::options::Options;
use orogen_engine::declare::Input;
use orogen_engine::field::Dem;
use orogen_engine::node::Node;
use orogen_engine::op::{Context, GridInputs, Op};
use orogen_engine::recipe::document::{Recipe, WorldSpec};
use orogen_engine::world::HEIGHT;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::analysis::slope::beyond;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;
use orogen_grid::progress::Progress;

/// Cells in metres that need no check.
const CELLS: RangeInclusive<f64> = 1e-3..=1e6;

/// Rows that are made at once: with their halo they stay in the cache.
const ROWS: usize = 64;

/// A layer that one filter makes of heights and of the samples next to them, with the bits that a world of these
/// heights has.
pub struct ArrayLayer<'a> {
    window: Window,
    heights: &'a [f32],
    /// The prepared recipe of such a world.
    recipe: Recipe,
    /// The layers of its last node that are read.
    wanted: Vec<bool>,
}

impl<'a> ArrayLayer<'a> {
    /// A layer of the heights of `window`, by rows from the north. `None` if it needs more than one filter and a halo
    /// of one sample, or if some heights are missing: a world fills them.
    ///
    /// # Errors
    /// If an option does not belong to the layer or is invalid.
    pub fn new(name: &str, window: &Window, heights: &'a [f32], options: &Options) -> Result<Option<ArrayLayer<'a>>> {
        if !CELLS.contains(&window.cell) || window.is_empty() || heights.len() != window.len() {
            return Ok(None);
        }
        let size = [window.width, window.height].map(|samples| samples as f64 * window.cell);
        let mut recipe = Recipe::new(WorldSpec::default().with_size(Some(size)).with_cell(window.cell));
        recipe.add("place", Dem::default()).output(HEIGHT, "place");
        list::prepare(&mut recipe, name, options)?;
        let wanted = wanted(&recipe, name).filter(|_| {
            let count = FiniteCount::of(heights);
            count.finite == count.samples
        });
        Ok(wanted.map(|wanted| ArrayLayer { window: *window, heights, recipe, wanted }))
    }

    /// Number of channels.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.wanted.iter().filter(|wanted| **wanted).count()
    }

    /// Fills one slice for each channel, each as long as the heights.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn fill(&self, out: Vec<&mut [f32]>, progress: &Progress) -> Result<()> {
        let Some(Op::Filter(filter)) = self.recipe.nodes().last().map(|named| named.node.op()) else { return Ok(()) };
        let (width, world_params) = (self.window.width, self.recipe.world.world_params());
        let mut bands: Vec<Vec<&mut [f32]>> = Vec::new();
        for channel in out {
            for (k, rows) in channel.chunks_mut(ROWS * width).enumerate() {
                if bands.len() == k {
                    bands.push(Vec::new());
                }
                bands[k].push(rows);
            }
        }
        progress.expect(bands.len() as f64);
        parallel::try_for_each(bands.into_iter().enumerate(), |(k, channels)| {
            progress.step(1.0)?;
            let first = k * ROWS;
            let height = ROWS.min(self.window.height - first);
            let band = Window { y: self.window.y + first as i64, height, ..self.window };
            let wide = self.surrounded(&band, first);
            let mut made: Vec<Option<Grid>> =
                self.wanted.iter().map(|wanted| wanted.then(|| Grid::filled(band, 0.0))).collect();
            let context = Context { world_params: &world_params, progress: &Progress::none(), observer: None };
            filter.apply(&GridInputs::new(filter.spec(), &[Some(&wide)]), &band, &mut made, &context)?;
            channels.into_iter().zip(made.iter().flatten()).for_each(|(to, made)| to.copy_from_slice(made.data()));
            Ok(())
        })
    }

    /// The heights of a band and one sample around them, as the world of an array has them: to the west and the north
    /// they are extrapolated; to the east and the south, where the last samples have cells that are still inside the
    /// world, they are repeated. `first` is the first row of the band.
    fn surrounded(&self, band: &Window, first: usize) -> Grid {
        let (wide, last) = (band.grown(1), self.window.height - 1);
        let mut data = Vec::with_capacity(wide.len());
        let row = |j: usize, data: &mut Vec<f32>| {
            let row = &self.heights[j.min(last) * self.window.width..][..self.window.width];
            let end = row[row.len() - 1];
            data.push(beyond(row[0], row.get(1).copied().unwrap_or(end)));
            data.extend_from_slice(row);
            data.push(end);
        };
        match first.checked_sub(1) {
            Some(above) => row(above, &mut data),
            None => {
                let (mut edge, mut next) = (Vec::new(), Vec::new());
                row(0, &mut edge);
                row(1, &mut next);
                data.extend(edge.iter().zip(next).map(|(edge, next)| beyond(*edge, next)));
            }
        }
        (first..=first + band.height).for_each(|j| row(j, &mut data));
        Grid::from_data(wide, data).unwrap_or_else(|| Grid::filled(wide, f32::NAN))
    }
}

/// The layers that are read of the filter that makes a layer of a prepared recipe from heights extrapolated by one
/// sample; `None` if it is not made so.
fn wanted(recipe: &Recipe, name: &str) -> Option<Vec<bool>> {
    let [_, extrapolate, named] = recipe.nodes() else { return None };
    let (Node::Extrapolate(extrapolate), Op::Filter(filter)) = (&extrapolate.node, named.node.op()) else {
        return None;
    };
    let spec = filter.spec();
    if extrapolate.samples != 1 || spec.inputs.len() != 1 || filter.halo(recipe.world.cell) != 1 {
        return None;
    }
    let layers = match &list::named(name)?.made {
        Made::Channels(channels) if channels.make.is_none() => (channels.layers)(recipe),
        Made::Channels(_) => return None,
        Made::Nodes(_) => match &recipe.output_inputs().iter().find(|(output, _)| output == name)?.1 {
            Input::Node(layer) => vec![layer.clone()],
            Input::None | Input::Value(_) => return None,
        },
    };
    let is_read = |layer: &str| layers.contains(&format!("{}.{layer}", named.name));
    Some(spec.layers.iter().map(|layer| is_read(layer.name)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::layer_source::LayerSource;
    use orogen_engine::world::World;
    use orogen_io::dem::PreparedDem;
    use orogen_io::format::dem::Dem as Heights;
    use std::path::Path;
    use std::sync::Arc;

    fn ground(width: usize, height: usize) -> Vec<f32> {
        (0..width * height).map(|k| (k * k % 61) as f32 * 0.7 + (k % width) as f32 * 3.0).collect()
    }

    /// The channels of a layer, if it is one of those of an array.
    fn made(name: &str, window: &Window, heights: &[f32], options: &Options) -> Result<Option<Vec<Grid>>> {
        let Some(layer) = ArrayLayer::new(name, window, heights, options)? else { return Ok(None) };
        let mut grids = vec![Grid::filled(*window, -1.0); layer.channels()];
        layer.fill(grids.iter_mut().map(|grid| grid.data_mut()).collect(), &Progress::none())?;
        Ok(Some(grids))
    }

    /// The layer of a world of these heights.
    fn by_world(name: &str, window: &Window, heights: &[f32], options: &Options) -> Vec<Grid> {
        let dem = Heights::new([window.width, window.height], heights.to_vec(), None).unwrap();
        let place = PreparedDem::of(dem, Some(window.cell), u64::MAX).unwrap();
        let mut recipe = Recipe::from_dem(Path::new("array"), &Arc::new(place));
        list::prepare(&mut recipe, name, options).unwrap();
        let world = World::open(recipe).unwrap();
        LayerSource::new(&world, name, *window, &Progress::none()).unwrap().whole().unwrap()
    }

    /// Whether all samples have the same bits.
    fn same(made: &[Grid], expected: &[Grid]) -> bool {
        let bits = |grid: &Grid| grid.data().iter().map(|sample| sample.to_bits()).collect::<Vec<u32>>();
        made.len() == expected.len() && made.iter().zip(expected).all(|(made, expected)| bits(made) == bits(expected))
    }

    #[test]
    fn it_has_the_bits_of_a_world() {
        let mut direct = Vec::new();
        for derived in list::all().iter().filter(|derived| derived.name != "viewshed") {
            for (width, height) in [(64, 200), (1, 1), (1, 5), (7, 2), (9, ROWS), (3, ROWS + 1)] {
                let (window, heights) = (Window::new(width, height, 12.5), ground(width, height));
                let options = Options::default();
                let Some(made) = made(derived.name, &window, &heights, &options).unwrap() else { continue };
                direct.push(derived.name);
                let expected = by_world(derived.name, &window, &heights, &options);
                assert!(same(&made, &expected), "{} {width} x {height}", derived.name);
            }
        }
        direct.dedup();
        assert_eq!(direct, ["slope", "aspect", "curvature", "hillshade", "normal"]);
    }

    #[test]
    fn options_count() {
        let (window, heights) = (Window::new(30, 20, 5.0), ground(30, 20));
        let options =
            Options::of(list::options().into_iter().map(|(spec, _)| spec), [("azimuth", "90"), ("altitude", "20")]);
        let options = options.unwrap();
        let light = made("hillshade", &window, &heights, &options).unwrap().unwrap();
        assert!(same(&light, &by_world("hillshade", &window, &heights, &options)));
        let refused = made("slope", &window, &heights, &options).unwrap_err();
        assert!(refused.to_string().contains("does not apply to the layer slope"), "{refused}");
    }

    #[test]
    fn missing_heights_are_left_to_a_world() {
        let (window, mut heights) = (Window::new(30, 20, 5.0), ground(30, 20));
        heights[77] = f32::NAN;
        assert!(made("slope", &window, &heights, &Options::default()).unwrap().is_none());
    }
}

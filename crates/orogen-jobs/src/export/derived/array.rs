//! Derived layers of heights in memory, without a world.
//!
//! A filter of a few operations a sample takes less time than a world needs to bring it the samples: a plan, tiles with
//! halos, their copies. Over an array the filter is applied at once.

use std::ops::RangeInclusive;

use super::layer::Made;
use super::list;
use crate::options::Options;
use orogen_engine::declare::Input;
use orogen_engine::field::Dem;
use orogen_engine::op::{Context, GridInputs, Op};
use orogen_engine::recipe::document::{NamedNode, Recipe, WorldSpec};
use orogen_engine::world::HEIGHT;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::analysis::slope::beyond;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;

/// Cells in metres that need no check.
const CELLS: RangeInclusive<f64> = 1e-3..=1e6;

/// The channels of a layer that one filter makes of heights and of the samples next to them, with the bits that a world
/// of these heights has. `heights` are those of `window`, by rows from the north. `None` if the layer needs more than
/// that, or if some heights are missing: a world fills them.
///
/// # Errors
/// If an option does not belong to the layer or is invalid, or if the work is cancelled.
pub fn layer(
    name: &str,
    window: &Window,
    heights: &[f32],
    options: &Options,
    progress: &Progress,
) -> Result<Option<Vec<Grid>>> {
    if !CELLS.contains(&window.cell) || window.is_empty() || heights.len() != window.len() {
        return Ok(None);
    }
    let size = [window.width, window.height].map(|samples| samples as f64 * window.cell);
    let mut recipe = Recipe::new(WorldSpec::default().with_size(Some(size)).with_cell(window.cell));
    recipe.add("place", Dem::default()).output(HEIGHT, "place");
    list::prepare(&mut recipe, name, options)?;
    let Some((named, layers)) = only_filter(&recipe, name) else { return Ok(None) };
    let Op::Filter(filter) = named.node.op() else { return Ok(None) };
    let count = FiniteCount::of(heights);
    if filter.halo(window.cell) != 1 || count.finite < count.samples {
        return Ok(None);
    }
    let wide = surrounded(window, heights);
    let wanted = |layer: &str| layers.iter().any(|name| name.strip_prefix(&named.name) == Some(&format!(".{layer}")));
    let declared = filter.spec().layers;
    let mut made: Vec<Option<Grid>> =
        declared.iter().map(|layer| wanted(layer.name).then(|| Grid::filled(*window, 0.0))).collect();
    let context = Context { world_params: &recipe.world.world_params(), progress, observer: None };
    filter.apply(&GridInputs::new(filter.spec(), &[Some(&wide)]), window, &mut made, &context)?;
    Ok(Some(made.into_iter().flatten().collect()))
}

/// The filter that makes a layer of a prepared recipe from heights that are extrapolated by one sample, and the names of
/// the layers that are read.
fn only_filter<'a>(recipe: &'a Recipe, name: &str) -> Option<(&'a NamedNode, Vec<String>)> {
    let layers = match &list::named(name)?.made {
        Made::Channels(channels) if channels.make.is_none() => (channels.layers)(recipe),
        Made::Channels(_) => return None,
        Made::Nodes(_) => match &recipe.output_inputs().iter().find(|(output, _)| output == name)?.1 {
            Input::Node(layer) => vec![layer.clone()],
            Input::None | Input::Value(_) => return None,
        },
    };
    let [_, extrapolate, named] = recipe.nodes() else { return None };
    let is_one = matches!(&extrapolate.node, orogen_engine::node::Node::Extrapolate(op) if op.samples == 1);
    (is_one && named.node.spec().inputs.len() == 1).then_some((named, layers))
}

/// The heights and one sample around them, as the world of an array has them: to the west and the north they are
/// extrapolated; to the east and the south, where the last samples have cells that are still inside the world, they are
/// repeated.
fn surrounded(window: &Window, heights: &[f32]) -> Grid {
    let wide = window.grown(1);
    let mut data = Vec::with_capacity(wide.len());
    // The northernmost row follows from the next two.
    data.resize(wide.width, 0.0);
    for row in heights.chunks_exact(window.width) {
        let last = row[row.len() - 1];
        data.push(beyond(row[0], row.get(1).copied().unwrap_or(last)));
        data.extend_from_slice(row);
        data.push(last);
    }
    data.extend_from_within(data.len() - wide.width..);
    for i in 0..wide.width {
        data[i] = beyond(data[wide.width + i], data[2 * wide.width + i]);
    }
    Grid::from_data(wide, data).unwrap_or_else(|| Grid::filled(wide, f32::NAN))
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
        (0..width * height).map(|k| ((k * k % 61) as f32).mul_add(0.7, (k % width) as f32 * 3.0)).collect()
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
            for (width, height) in [(64, 40), (1, 1), (1, 5), (7, 2)] {
                let (window, heights) = (Window::new(width, height, 12.5), ground(width, height));
                let options = Options::default();
                let made = layer(derived.name, &window, &heights, &options, &Progress::none()).unwrap();
                let Some(made) = made else { continue };
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
        let made = layer("hillshade", &window, &heights, &options, &Progress::none()).unwrap().unwrap();
        assert!(same(&made, &by_world("hillshade", &window, &heights, &options)));
        let refused = layer("slope", &window, &heights, &options, &Progress::none()).unwrap_err();
        assert!(refused.to_string().contains("does not apply to the layer slope"), "{refused}");
    }

    #[test]
    fn missing_heights_are_left_to_a_world() {
        let (window, mut heights) = (Window::new(30, 20, 5.0), ground(30, 20));
        heights[77] = f32::NAN;
        assert!(layer("slope", &window, &heights, &Options::default(), &Progress::none()).unwrap().is_none());
    }
}

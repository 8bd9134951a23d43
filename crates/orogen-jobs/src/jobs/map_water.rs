//! The rivers and lakes of a map: those of the recipe's own network, which exports have, too.

use crate::export::features::options::FeatureOptions;
use crate::export::features::source::FeatureSource;
use crate::options::Options;
use orogen_engine::node::Node;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::recipe::network::OwnNetwork;
use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrography::water::Cover;
use orogen_grid::progress::Progress;
use orogen_output::sheet::water::{KnownWater, River};

/// Whether a window with this cell has rivers of the recipe's own network.
#[must_use]
pub fn is_known(recipe: &Recipe, window: &Window) -> bool {
    OwnNetwork::of(recipe).is_some_and(|own| own.cell_for(window.cell).is_some())
}

/// Whether the recipe's land is drained: by erosion, as a real place, or by outputs of water. The depressions of bare
/// noise are no lakes.
#[must_use]
pub fn is_drained(recipe: &Recipe) -> bool {
    let shapes = |node: &Node| {
        matches!(
            node,
            Node::Amplify(_)
                | Node::Bake(_)
                | Node::Breach(_)
                | Node::Continents(_)
                | Node::Dem(_)
                | Node::Droplets(_)
                | Node::Fill(_)
                | Node::Image(_)
                | Node::LocalStreamPower(_)
                | Node::Pipes(_)
                | Node::StreamPower(_)
        )
    };
    recipe.outputs().any(|name| matches!(name, "flow" | "lakes" | "receiver" | "rivers"))
        || recipe.nodes().iter().any(|named| shapes(&named.node))
}

/// The water of the network in a window, with at least these drainage areas of rivers and areas of lakes in m^2. The
/// caller holds `held` bytes.
///
/// # Errors
/// If memory does not suffice, or the work was cancelled.
pub fn of(world: &World, window: &Window, least: [f64; 2], held: u64, progress: &Progress) -> Result<KnownWater> {
    let given = Options::default();
    let mut options = FeatureOptions::new(&given, world.recipe())?;
    options.river = (least[0], 1);
    options.lake = least[1];
    let source = FeatureSource::of(world, window, &options, held, progress)?;
    let area = (source.cell() / window.cell) * (source.cell() / window.cell);
    let rivers = source.rivers.iter().map(|river| River {
        points: river.points.iter().map(|[x, y, _]| source.to_window([*x, *y])).collect(),
        drained: river.drained * area,
    });
    let rings = source.lakes.iter().flat_map(|lake| lake.parts.iter().flatten());
    let lakes = rings.map(|ring| ring.iter().map(|at| source.to_window(*at)).collect()).collect();
    let mut levels = Grid::filled(*window, f32::NAN);
    for j in 0..window.height {
        for (i, level) in levels.row_mut(j).iter_mut().enumerate() {
            if let Cover::Lake(lake) = source.water.cover(source.nearest(i, j))
                && source.lake_id(lake).is_some()
            {
                *level = source.water.lakes[lake as usize - 1].level;
            }
        }
    }
    Ok(KnownWater { rivers: rivers.collect(), lakes, levels })
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_engine::presets;

    fn preset(name: &str) -> Recipe {
        presets::find(name).unwrap().recipe().unwrap()
    }

    #[test]
    fn bare_noise_and_dry_land_are_not_drained() {
        for preset in presets::all() {
            let is_bare = ["caves", "classic", "craters", "dunes", "karst", "tile-island"].contains(&preset.name);
            assert_eq!(is_drained(&preset.recipe().unwrap()), !is_bare, "{}", preset.name);
        }
    }

    #[test]
    fn the_water_of_a_window_is_that_of_its_parts() {
        let world = World::open(preset("endless")).unwrap();
        let whole = Window::new(96, 80, 240.0).at(100, -60);
        assert!(is_known(world.recipe(), &whole));
        let water_of = |window: &Window| of(&world, window, [2e7, 1e5], 0, &Progress::none()).unwrap();
        let [all, west, east] = [whole, Window { width: 48, ..whole }, Window { x: 148, width: 48, ..whole }]
            .map(|window| water_of(&window));
        assert!(!all.rivers.is_empty());
        for j in 0..80 {
            let parts: Vec<u32> =
                west.levels.row(j).iter().chain(east.levels.row(j)).map(|level| level.to_bits()).collect();
            let level: Vec<u32> = all.levels.row(j).iter().map(|level| level.to_bits()).collect();
            assert_eq!(parts, level, "row {j}");
        }
        // Every point of the parts within their windows is a point of the whole.
        let points = |water: &KnownWater, from: f64| -> Vec<[f64; 2]> {
            let points = water.rivers.iter().flat_map(|river| river.points.iter()).map(|[x, y]| [x + from, *y]);
            points.filter(|[x, _]| (x - 47.5).abs() > 0.01).collect()
        };
        let all = points(&all, 0.0);
        for point in points(&west, 0.0).into_iter().chain(points(&east, 48.0)) {
            let near = |other: &[f64; 2]| (other[0] - point[0]).abs() < 1e-3 && (other[1] - point[1]).abs() < 1e-3;
            assert!(all.iter().any(near), "{point:?}");
        }
    }
}

//! Water for meshes: `--water`.

use std::io;

use super::features::options::FeatureOptions;
use super::features::source::FeatureSource;
use super::format::refuse;
use super::layer_source::LayerSource;
use super::mesh::Prepared;
use crate::options::{OptionSpec, Options};
use orogen_engine::world::HEIGHT;
use orogen_grid::grid::Window;
use orogen_grid::hydrography::water::{Cover, MEMORY};
use orogen_output::mesh::water::{Ribbon, WaterMesh};

/// `--water`.
pub const WATER: OptionSpec = OptionSpec::switch("water").with_about(
    "Add water: rivers as ribbons, lakes and the sea as level surfaces, as translucent meshes in separate nodes",
);

/// Linear red, green and blue, and opacity, of rivers, lakes and the sea.
const RIVERS: [f32; 4] = [0.045, 0.16, 0.27, 0.85];
const LAKES: [f32; 4] = [0.03, 0.13, 0.24, 0.75];
const SEA: [f32; 4] = [0.015, 0.08, 0.18, 0.75];

/// Height of ribbons above the ground where the ground is higher than the river, relative to the cell: enough to avoid
/// z-fighting.
const LIFT: f64 = 0.01;

/// Memory of the water of a window in addition to the mesh, in bytes.
pub fn memory(window: &Window, options: &Options) -> u64 {
    match options.has(WATER.name) {
        true => (window.width as u64).saturating_mul(window.height as u64).saturating_mul(MEMORY),
        false => 0,
    }
}

/// The water on a mesh, if requested: rivers, lakes and sea, as far as they exist.
///
/// Fails if the source fails, or the mesh is not made from heights.
pub fn of(source: &LayerSource, mesh: &Prepared, options: &Options, reserved: u64) -> io::Result<Vec<WaterMesh>> {
    if !options.has(WATER.name) {
        return Ok(Vec::new());
    }
    if source.layer() != HEIGHT {
        return refuse(format!("--water applies to the layer `{HEIGHT}`, not to `{}`", source.layer()));
    }
    let none = Options::default();
    let wanted = FeatureOptions::new(&none, source.world().recipe())?;
    let ground = FeatureSource::of(source.world(), source.window(), &wanted, reserved, source.progress())?;
    let cell = ground.cell();
    let width = |samples: f64| wanted.channel.width_of(wanted.channel.discharge(samples * cell * cell));
    let mut rivers = WaterMesh::new("rivers", RIVERS);
    let lift = LIFT * source.window().cell + mesh.max_error().unwrap_or(0.0);
    for river in &ground.rivers {
        let mut heights: Vec<f32> = river.points.iter().map(|point| point[2] as f32).collect();
        mesh.bend(&mut heights);
        let points = river.points.iter().zip(heights);
        let points = points.map(|([x, y, _], height)| {
            let [x, y] = ground.to_window([*x, *y]);
            [x, y, f64::from(height)]
        });
        let points = points.collect();
        let widths = [river.start, river.end].map(|node| width(ground.water.drained(node as usize)));
        rivers.lay(&Ribbon { points, widths }, &mesh.grid, lift);
    }
    let bent = |level: f32| {
        let mut level = [level];
        mesh.bend(&mut level);
        level[0]
    };
    let levels: Vec<f32> = ground.water.lakes.iter().map(|lake| bent(lake.level)).collect();
    let sea_level = ground.water.sea_level.map(bent);
    let cover = |i: usize, j: usize| ground.water.cover(ground.nearest(i, j));
    let mut lakes = WaterMesh::new("lakes", LAKES);
    lakes.cover(&mesh.grid, |i, j| match cover(i, j) {
        Cover::Lake(lake) => levels.get(lake as usize - 1).copied(),
        _ => None,
    });
    let mut sea = WaterMesh::new("sea", SEA);
    sea.cover(&mesh.grid, |i, j| if cover(i, j) == Cover::Sea { sea_level } else { None });
    let mut all: Vec<WaterMesh> = [rivers, lakes, sea].into_iter().filter(|mesh| !mesh.triangles.is_empty()).collect();
    all.iter_mut().for_each(|water| water.exaggerate(mesh.exaggeration()));
    Ok(all)
}

//! The passes by which a graphics card computes the layers of drained land.

use super::drained::Drained;
use super::layers::surface_halo;
use super::passes::{AROUND, FEW, code, numbered, passes};
use crate::declare::Spec;
use crate::lower::{Extent, Lowering, Over, Pass, Passes};
use crate::op::WorldParams;
use orogen_grid::multiscale::level::Level;
use orogen_grid::multiscale::refinement::Refinement;

const SURFACE: &str = code!("layers.wgsl", "surface.wgsl");
const RIVERS: &str = code!("layers.wgsl", "rivers.wgsl");
const BEDS: &str = code!("layers.wgsl", "beds.wgsl");

/// The planes after the planes of a level, by their names in shaders; planes of layers are called `LAYER_` and the name
/// of the layer. The names in one line are uses of one plane, in this order.
const SCRATCH: [&[&str]; 10] = [
    &["LAYER_HEIGHT"],
    &["LAYER_FLOW"],
    &["LAYER_LAKE"],
    &["LAYER_RECEIVER"],
    &["WATER_LEVEL"],
    // Nodes of rivers: position, height, half of the width in cells, and depth.
    &["NODE_EAST", "LAYER_SURFACE"],
    &["NODE_SOUTH", "LAYER_WIDTH"],
    &["NODE_HEIGHT", "LAYER_DEPTH"],
    &["NODE_HALF"],
    &["NODE_DEPTH"],
];

/// Approximate number of samples that a call reads along a river.
const ALONG: usize = 1000;
/// Approximate number of samples that a call reads in the bed of a link.
const BED: usize = 2000;

/// The passes by which a graphics card computes layers from a level that it has made.
#[must_use]
pub fn lower_layers(
    land: &Drained,
    level: usize,
    spec: &Spec,
    wanted: &[bool],
    world_params: &WorldParams,
) -> Lowering<Passes> {
    let plane_of = |layer: &str| {
        let plane = format!("LAYER_{}", layer.to_uppercase());
        numbered(&SCRATCH).find(|(name, _)| *name == plane).map(|(_, plane)| plane as usize)
    };
    let layers = spec.layers.iter().zip(wanted).filter(|(_, wanted)| **wanted);
    let Some(layers) = layers.map(|(layer, _)| plane_of(layer.name)).collect::<Option<Vec<_>>>() else {
        return Lowering::Processor("floodplains, sediment and the nodes themselves are read from levels in memory");
    };
    let (refinement, channel) = (&land.refinement, land.channel());
    let [inside, change] = refinement.surface_numbers(level, land.share(level));
    let passes = passes(refinement, level, &SCRATCH).with_scratch(Level::PLANES + SCRATCH.len());
    let mut passes = passes.with_numbers([
        // Position of samples in their cells, as a share of the sides.
        ("inside", inside),
        // The mean change of heights by finer levels, as a share of the rise to a node at the source of a river.
        ("mean_change", change),
        ("sea_level", land.sea_level(world_params)),
        // Minimum drainage area of rivers in m^2, discharge in m^3/s per m^2, and width and depth of a river of 1
        // m^3/s.
        ("stream", land.stream as f32),
        ("runoff", channel.discharge(1.0) as f32),
        ("width_of_one", channel.width as f32),
        ("depth_of_one", channel.depth as f32),
    ]);
    let pass = |code, function, around, reads| Pass {
        code,
        function,
        step: 0,
        over: Over::Window(around),
        reads,
        is_shared: false,
    };
    passes.passes.push(pass(SURFACE, "surface", 0, AROUND));
    if refinement.has_beds(level) {
        passes.passes.push(pass(RIVERS, "find_river", Refinement::BEDS_REACH + 1, ALONG));
        passes.passes.push(Pass { is_shared: true, ..pass(BEDS, "cut_bed", Refinement::BEDS_REACH, BED) });
    }
    passes.passes.push(pass(SURFACE, "finish_layers", 0, FEW));
    passes.extent = Extent::Before(surface_halo(refinement, level, spec, wanted));
    passes.layers = layers;
    Lowering::Shader(passes)
}

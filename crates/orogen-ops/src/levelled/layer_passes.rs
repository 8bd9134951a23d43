//! The layers of drained land as passes of a graphics card.

use super::drained::{Reading, surface_halo};
use super::passes::{AROUND, FEW, code, passes};
use crate::lower::{Extent, Lowering, Over, Pass, Passes};
use orogen_grid::hydrology::rivers::Channel;
use orogen_grid::multiscale::level::Level;
use orogen_grid::multiscale::refinement::Refinement;

const SURFACE: &str = code!("layers.wgsl", "surface.wgsl");
const RIVERS: &str = code!("layers.wgsl", "rivers.wgsl");
const BEDS: &str = code!("layers.wgsl", "beds.wgsl");

/// The planes of the layers that a card makes, in the order of the layers, with their names in shaders.
const PLANES: [(&str, u32); 7] = [
    ("GROUND", 8),
    ("FLOW", 9),
    ("LAKE_DEPTH", 10),
    ("SURFACE", 13),
    ("LED_TO", 11),
    ("RIVER_WIDTH", 14),
    ("RIVER_DEPTH", 15),
];

/// Number of planes beside those of a level.
const SCRATCH: usize = 10;

/// Samples that a call reads, about, along a river and in the bed of a link.
const ALONG: usize = 1000;
const BED: usize = 2000;

/// How a graphics card reads layers from a level, which it has made.
#[must_use]
pub fn lower_layers(refinement: &Refinement, reading: &Reading, level: usize, wanted: &[bool]) -> Lowering<Passes> {
    if wanted.iter().skip(PLANES.len()).any(|wanted| *wanted) {
        return Lowering::Processor("floodplains, sediment and the nodes themselves are read from levels in memory");
    }
    let channel = Channel::default().with_runoff(reading.runoff);
    let [inside, change] = refinement.surface_numbers(level, reading.share);
    let passes = passes(refinement, level).with_scratch(Level::PLANES + SCRATCH).with_constants(PLANES);
    let mut passes = passes.with_numbers([
        // Where samples are in their cells, as a share of the sides.
        ("inside", inside),
        // The mean change of heights by finer levels, as a share of the rise to a node at the source of a river.
        ("mean_change", change),
        ("sea_level", reading.sea_level),
        // Least area of rivers in m^2, discharge in m^3/s from a m^2, and width and depth of a river of 1 m^3/s.
        ("stream", reading.stream as f32),
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
    passes.extent = Extent::Before(surface_halo(refinement, level, wanted));
    passes.layers =
        PLANES.iter().zip(wanted).filter(|(_, wanted)| **wanted).map(|((_, plane), _)| *plane as usize).collect();
    Lowering::Shader(passes)
}

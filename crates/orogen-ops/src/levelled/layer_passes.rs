//! The layers of drained land as passes of a graphics card.

use super::drained::Reading;
use super::passes::{AROUND, FEW, GIVEN, code};
use crate::lower::{LayerPass, LayerPasses, Lowering};
use orogen_grid::hydrology::rivers::Channel;
use orogen_grid::multiscale::refinement::Refinement;

const SURFACE: &str = code!("layers.wgsl", "surface.wgsl");
const RIVERS: &str = code!("layers.wgsl", "rivers.wgsl");
const BEDS: &str = code!("layers.wgsl", "beds.wgsl");

/// The planes of the layers that a card makes, in the order of the layers.
const PLANES: [usize; 7] = [8, 9, 10, 13, 11, 14, 15];

/// Number of planes beside those of a level.
const SCRATCH: usize = 10;

/// Samples that a call reads, about, along a river and in the bed of a link.
const ALONG: usize = 1000;
const BED: usize = 2000;

/// How a graphics card reads layers from a level, which it has made.
#[must_use]
pub fn lower_layers(
    refinement: &Refinement,
    reading: &Reading,
    level: usize,
    wanted: &[bool],
) -> Lowering<LayerPasses> {
    if wanted.iter().skip(PLANES.len()).any(|wanted| *wanted) {
        return Lowering::Processor("floodplains, sediment and the nodes themselves are read from levels in memory");
    }
    let channel = Channel::default().with_runoff(reading.runoff);
    let [inside, change] = refinement.surface_numbers(level, reading.share);
    let numbers = [
        inside,
        change,
        reading.sea_level,
        reading.stream as f32,
        channel.discharge(1.0) as f32,
        channel.width as f32,
        channel.depth as f32,
    ];
    let mut words = refinement.words(level).to_vec();
    words.extend([0; GIVEN]);
    words.extend(numbers.map(f32::to_bits));
    let pass = |code, function, around, reads| LayerPass { code, function, around, reads, is_shared: false };
    let mut passes = vec![pass(SURFACE, "surface", 0, AROUND)];
    if refinement.has_beds(level) {
        passes.push(pass(RIVERS, "find_river", Refinement::BEDS_REACH + 1, ALONG));
        passes.push(LayerPass { is_shared: true, ..pass(BEDS, "cut_bed", Refinement::BEDS_REACH, BED) });
    }
    passes.push(pass(SURFACE, "finish_layers", 0, FEW));
    let layers = PLANES.iter().zip(wanted).filter(|(_, wanted)| **wanted).map(|(plane, _)| *plane).collect();
    Lowering::Shader(LayerPasses { words, scratch: SCRATCH, layers, passes })
}

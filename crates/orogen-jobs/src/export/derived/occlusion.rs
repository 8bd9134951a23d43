//! The layer `occlusion`.

use super::layer::{Around, Derived, LoweredRows, Made, Nature, RowLayer, none, nothing};
use crate::options::Options;
use orogen_engine::lower::Passes;
use orogen_grid::analysis::sky;
use orogen_grid::grid::{Grid, Window};

/// Search radius of horizons, in metres, and its maximum in samples.
const METRES: f64 = 1000.0;
const MOST: f64 = 128.0;

fn reach(cell: f64) -> usize {
    (METRES / cell).ceil().clamp(1.0, MOST) as usize
}

/// The layer.
pub static LAYER: Derived = Derived {
    name: "occlusion",
    about: "ambient occlusion: visible share of the sky within 1000 m or 128 samples; 1 on open ground",
    palette: "grey",
    options: &[],
    made: Made::Rows(RowLayer {
        unit: "",
        nature: Nature::Numbers,
        channels: |_| vec!["occlusion".into()],
        prepare: nothing,
        layers: none,
        reach,
        make: |around, window| vec![sky::sky_view(around.heights, window, reach(window.cell))],
        lowered: Some(LoweredRows { passes, heights }),
    }),
};

/// The passes of a graphics card.
fn passes(cell: f64, _: &Options) -> Passes {
    let reach = reach(cell);
    let steps = sky::steps_of_view(reach, cell);
    let words = [steps.len() as u32].into_iter().chain(steps.iter().flat_map(|step| {
        let [east, south] = step.offset.map(|side| (side as i32).cast_unsigned());
        [east, south, step.per_metre.to_bits(), step.share.to_bits()]
    }));
    Passes::new(include_str!("occlusion.wgsl"), &[]).with_words(words).then("view", 0, [reach; 2]).reading(steps.len())
}

/// The heights over a window and its surroundings; beyond the world there are none.
fn heights(around: &Around, window: &Window) -> Grid {
    let mut heights = Grid::filled(window.grown(reach(window.cell)), f32::NAN);
    heights.paste(around.heights);
    heights
}

//! Helpers for tests of filters: a device, inputs, and filters with several parameters.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

use orogen_engine::filter::{
    Blur, Comparison, Curvature, CurvatureKind, Distance, Extrapolate, FlowCodes, FlowDirection, FlowIndices,
    Geomorphons, Hillshade, LocalStreamPower, Occlusion, Pipes, SelectAspect, SelectCurvature, SelectSlope, Slope,
    SlopeUnit, SoilDepth, Thermal, TopographicPosition,
};
use orogen_engine::lower::{Extent, Lowering, Passes};
use orogen_engine::node::Node;
use orogen_engine::op::{Context, Filter, GridInputs, Op, WorldParams};
use orogen_gpu::gpu::Options;
use orogen_gpu::{Choice, Failure, Gpu};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;

pub const WORLD: WorldParams = WorldParams { seed: 1, size: None, cell: 10.0, sea_level: 0.0 };

/// A separate device, so that tests can count the shaders that it compiles.
pub fn gpu() -> Gpu {
    Gpu::open(&Options::new(Choice::Any)).unwrap()
}

pub fn gpu_with_buffers_of(bytes: u64) -> Gpu {
    Gpu::open(&Options::new(Choice::Any).with_buffer(bytes)).unwrap()
}

fn hash(x: i64, y: i64, seed: i64) -> f64 {
    let mut z = (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (y as u64).wrapping_mul(0xD1B5_4A32_D192_ED03);
    z ^= (seed as u64).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 40) as f64 / 16_777_216.0
}

/// Interpolated random values, -1 to 1.
fn value(x: f64, y: f64, seed: i64) -> f64 {
    let (i, j) = (x.floor(), y.floor());
    let smooth = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (u, v) = (smooth(x - i), smooth(y - j));
    let at = |a: i64, b: i64| 2.0 * hash(i as i64 + a, j as i64 + b, seed) - 1.0;
    let row = |b: i64| at(0, b) + u * (at(1, b) - at(0, b));
    row(0) + v * (row(1) - row(0))
}

fn fbm(x: f64, y: f64, seed: i64, octaves: i64) -> f64 {
    let octave = |k: i64| {
        let scale = f64::from(1 << k);
        value(x * scale + 17.3 * k as f64, y * scale, seed + k) / scale
    };
    (0..octaves).map(octave).sum()
}

/// Heights in metres over a window: hills with a wavelength of 60 cells, cliffs, and lowland that is flat or below the
/// sea.
pub fn heights(window: &Window) -> Grid {
    sampled(window, |x, y| {
        let hills = fbm(x / 60.0, y / 60.0, 3, 6);
        let cliff = if fbm(x / 90.0, y / 90.0, 40, 2) > 0.25 { 1.5 } else { 0.0 };
        let height = (hills + 0.25 * cliff) * 14.0;
        // Heights are in metres; slopes do not depend on the cell.
        if height < -4.0 { -4.0 * window.cell } else { (height + 0.02 * x) * window.cell }
    })
}

/// Suitable values for the input with this name.
pub fn input(name: &str, op: &str, window: &Window) -> Grid {
    match (name, op) {
        ("source", "flow-direction") => sampled(window, |x, y| (hash(x as i64, y as i64, 9) * 10.0).floor()),
        ("source", "distance") => sampled(window, |x, y| fbm(x / 12.0, y / 12.0, 5, 3)),
        ("flow", _) => sampled(window, |x, y| {
            let stream = (1.0 - fbm(x / 20.0, y / 20.0, 6, 3).abs()).max(0.0);
            window.cell * window.cell * (0.5 + 1000.0 * stream * stream * stream * stream)
        }),
        _ => heights(window),
    }
}

/// A grid by columns and rows.
pub fn sampled(window: &Window, value: impl Fn(f64, f64) -> f64) -> Grid {
    let mut grid = Grid::filled(*window, 0.0f32);
    for j in 0..window.height {
        for (i, out) in grid.row_mut(j).iter_mut().enumerate() {
            *out = value((window.x + i as i64) as f64, (window.y + j as i64) as f64) as f32;
        }
    }
    grid
}

/// The filter of a node.
pub fn filter(node: &Node) -> Option<&dyn Filter> {
    match node.op() {
        Op::Filter(filter) => Some(filter),
        _ => None,
    }
}

/// The passes by which a graphics card computes a node, if it does.
pub fn lowered(node: &Node, cell: f64) -> Option<Passes> {
    match filter(node)?.lower(cell, &WORLD) {
        Lowering::Shader(passes) => Some(passes),
        _ => None,
    }
}

/// The inputs of a node for a window of its result, with or without optional ones.
pub fn inputs(node: &Node, window: &Window, with_optional: bool) -> Vec<Option<Grid>> {
    let grown = window.grown(filter(node).unwrap().halo(window.cell));
    let made = node
        .inputs()
        .into_iter()
        .map(|declared| (declared.required || with_optional).then(|| input(declared.name, node.spec().op, &grown)));
    made.collect()
}

/// All layers of a node by the processor.
pub fn on_processor(node: &Node, window: &Window, inputs: &[Option<Grid>]) -> Vec<Grid> {
    let inputs: Vec<Option<&Grid>> = inputs.iter().map(Option::as_ref).collect();
    let mut out: Vec<Option<Grid>> = node.layers().iter().map(|_| Some(Grid::filled(*window, 0.0))).collect();
    let context = Context { world_params: &WORLD, progress: &Progress::none(), observer: None };
    filter(node).unwrap().apply(&GridInputs::new(node.spec(), &inputs), window, &mut out, &context).unwrap();
    out.into_iter().flatten().collect()
}

/// All layers of a node by a graphics card.
pub fn on_card(gpu: &Gpu, node: &Node, window: &Window, inputs: &[Option<Grid>]) -> Vec<Grid> {
    tried_on_card(gpu, node, window, inputs).unwrap()
}

/// [`on_card`] with its failure.
pub fn tried_on_card(gpu: &Gpu, node: &Node, window: &Window, inputs: &[Option<Grid>]) -> Result<Vec<Grid>, Failure> {
    let wanted = vec![true; node.layers().len()];
    let passes = lowered(node, window.cell).unwrap();
    let extent = (*window, filter(node).unwrap().halo(window.cell));
    Ok(apply(gpu, passes, inputs, extent, &wanted, false)?.unwrap())
}

/// The wanted layers of a filter over a window with a halo.
pub fn apply(
    gpu: &Gpu,
    passes: Passes,
    inputs: &[Option<Grid>],
    (window, halo): (Window, usize),
    wanted: &[bool],
    is_cancelled: bool,
) -> Result<Option<Vec<Grid>>, Failure> {
    let passes = passes.with_planes(Extent::Halo(halo), inputs.len(), wanted);
    super::run(gpu, &[super::step(passes, inputs, &window)], &[], || is_cancelled)
}

/// Several variants of a filter with other parameters than the defaults.
pub fn variants(node: &Node) -> Vec<Node> {
    match node.spec().op {
        "blur" => {
            vec![Blur { radius: 0.0, ..Default::default() }.into(), Blur { radius: 3.7, ..Default::default() }.into()]
        }
        "slope" => vec![Slope { unit: SlopeUnit::Ratio, ..Default::default() }.into()],
        "hillshade" => vec![
            Hillshade { azimuth: 100.0, altitude: 20.0, z_factor: 3.0, ..Default::default() }.into(),
            Hillshade { azimuth: -30.0, altitude: 90.0, ..Default::default() }.into(),
        ],
        "curvature" => [CurvatureKind::Profile, CurvatureKind::Plan]
            .map(|kind| Curvature { kind, scale: 45.0, ..Default::default() }.into())
            .to_vec(),
        "occlusion" => vec![Occlusion { reach: 30.0, ..Default::default() }.into()],
        "extrapolate" => vec![Extrapolate { samples: 0, ..Default::default() }.into()],
        "thermal" => vec![
            Thermal { iterations: 0, ..Default::default() }.into(),
            Thermal { iterations: 7, talus_angle: 10.0, rate: 0.4, ..Default::default() }.into(),
            Thermal { iterations: 16, talus_angle: 0.0, ..Default::default() }.into(),
        ],
        "pipes" => vec![
            Pipes { iterations: 0, ..Default::default() }.into(),
            Pipes { iterations: 1, ..Default::default() }.into(),
            Pipes { iterations: 12, rain: 20.0, erosion: 0.8, time_step: 0.4, evaporation: 0.1, ..Default::default() }
                .into(),
        ],
        "local-stream-power" => vec![
            LocalStreamPower { iterations: 1, ..Default::default() }.into(),
            LocalStreamPower {
                iterations: 8,
                slope_exponent: 1.6,
                uplift: 2.0,
                creep: 1.0,
                sea: false,
                ..Default::default()
            }
            .into(),
            LocalStreamPower { iterations: 15, deposition: 5.0, years: 1e6, ..Default::default() }.into(),
        ],
        "distance" => vec![
            Distance { threshold: 0.9, reach: 37.0, ..Default::default() }.into(),
            Distance { threshold: 0.0, reach: 0.0, ..Default::default() }.into(),
            Distance { threshold: 1.2, reach: 400.0, ..Default::default() }.into(),
        ],
        "select-slope" => vec![SelectSlope { range: [0.0, 12.0], falloff: [0.0, 25.0], ..Default::default() }.into()],
        "select-aspect" => vec![
            SelectAspect { direction: 250.0, width: 10.0, falloff: 100.0, least_slope: 0.0, ..Default::default() }
                .into(),
            SelectAspect { direction: -80.0, width: 100.0, falloff: 80.0, ..Default::default() }.into(),
        ],
        "select-curvature" => [CurvatureKind::Total, CurvatureKind::Profile, CurvatureKind::Plan]
            .map(|kind| {
                let (range, falloff) = ([-2e-3, 3e-3], [0.05, 0.02]);
                SelectCurvature { kind, scale: 2.0, range, falloff, ..Default::default() }.into()
            })
            .to_vec(),
        "soil-depth" => vec![
            SoilDepth { production: 1e-4, creep: 0.02, critical_slope: 2.5, deepest: 1.0, ..Default::default() }.into(),
            SoilDepth { production: 1e-3, decay: 0.2, critical_slope: 100.0, ..Default::default() }.into(),
        ],
        "topographic-position" => vec![
            TopographicPosition { radius: 1.0, ..Default::default() }.into(),
            TopographicPosition { radius: 64.0, ..Default::default() }.into(),
        ],
        "geomorphons" => vec![
            Geomorphons { comparison: Comparison::Difference, reach: 90.0, flat: 4.0, ..Default::default() }.into(),
            Geomorphons { reach: 1.0, flat: 0.0, ..Default::default() }.into(),
        ],
        "flow-direction" => [FlowCodes::Grass, FlowCodes::Taudem, FlowCodes::Whitebox, FlowCodes::Pcraster]
            .map(|codes| FlowDirection { codes, ..Default::default() }.into())
            .to_vec(),
        "flow-indices" => vec![FlowIndices { least_slope: 0.1, ..Default::default() }.into()],
        "ruggedness" | "aspect" | "normal" => Vec::new(),
        op => panic!("write other parameters for {op}"),
    }
}

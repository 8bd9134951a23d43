//! Area `resolution`: the differences of each preset at larger cells. Nothing is timed.

use orogen::layer::LayerKind;
use orogen::{Grid, Points, Window, World, grid::resample, presets};
use serde_json::{Value, json};

use crate::options::Options;

/// Ratios of the cells to the world's own cell.
const RATIOS: [usize; 3] = [2, 4, 8];

/// Border in large cells that is excluded: the interpolation has no samples beyond it.
const BORDER: usize = 2;

/// Number of cells along a side above which only a part of a world is compared.
const LARGEST: usize = 8192;
/// Number of cells along a side of that part.
const PART: usize = 1024;

/// Measures every preset, or those selected.
pub fn run(options: &Options) -> Result<Value, String> {
    let mut rows = Vec::new();
    for preset in presets::all().iter().filter(|preset| preset.name.contains(&options.case)) {
        eprintln!("{} ...", preset.name);
        let world = preset.recipe().and_then(World::open).map_err(|e| e.to_string())?;
        rows.extend(measure(preset.name, &world)?);
    }
    Ok(json!({ "area": "resolution", "simd": orogen_simd::Level::current().name(), "threads": 1, "rows": rows }))
}

fn measure(name: &str, world: &World) -> Result<Vec<Value>, String> {
    let spec = world.recipe().world;
    let coarsest = RATIOS.iter().copied().max().unwrap_or(1);
    let cells = |length: f64| (length / spec.cell).floor() as usize / coarsest * coarsest;
    // The default window of an unbounded world; the middle of a very large one.
    let [width, height] = spec.size.map_or([PART; 2], |size| size.map(cells));
    let part =
        |cells: usize| if cells > LARGEST { ((cells - PART) / 2 / coarsest * coarsest, PART) } else { (0, cells) };
    let ((x, width), (y, height)) = (part(width), part(height));
    let make = |ratio: usize| {
        let window = Window::new(width / ratio + 1, height / ratio + 1, spec.cell * ratio as f64);
        let window = window.at((x / ratio) as i64, (y / ratio) as i64);
        world.window("height", &window).map_err(|e| e.to_string())
    };
    let fine = make(1)?;
    let (low, high) = fine.data().iter().fold((f32::MAX, f32::MIN), |(l, h), &v| (l.min(v), h.max(v)));
    let relief = f64::from(high) - f64::from(low);
    RATIOS
        .iter()
        .map(|&ratio| {
            let coarse = make(ratio)?;
            let shared = difference(&fine, &coarse, ratio, |i, j| coarse[(i / ratio, j / ratio)]);
            let read = between(&fine, &coarse);
            let everywhere = difference(&fine, &read, 1, |i, j| read[(i, j)]);
            let of = |[rms, worst]: [f64; 2]| {
                json!({ "rms_m": rms, "worst_m": worst, "rms_share": rms / relief, "worst_share": worst / relief })
            };
            Ok(json!({
                "preset": name, "cell_m": spec.cell, "ratio": ratio, "relief_m": relief,
                "shared": of(shared), "everywhere": of(everywhere),
            }))
        })
        .collect()
}

/// The coarse grid interpolated at every sample of the fine one.
fn between(fine: &Grid, coarse: &Grid) -> Grid {
    let mut read = Grid::filled(*fine.window(), 0.0);
    let (xs, ys) = (fine.window().eastings(), fine.window().southings());
    resample::read(coarse, LayerKind::Height, &Points::Lattice { xs: &xs, ys: &ys }, read.data_mut());
    read
}

/// The root mean square of the differences of every `step`th sample, and the maximum, in metres.
fn difference(fine: &Grid, coarse: &Grid, step: usize, other: impl Fn(usize, usize) -> f32) -> [f64; 2] {
    let coarsest = RATIOS.iter().copied().max().unwrap_or(1);
    let border = if coarse.window().cell == fine.window().cell { BORDER * coarsest } else { 0 };
    let (mut squares, mut worst, mut count) = (0.0, 0.0f64, 0.0);
    for j in (border..fine.height() - border).step_by(step) {
        for i in (border..fine.width() - border).step_by(step) {
            let off = (f64::from(other(i, j)) - f64::from(fine[(i, j)])).abs();
            squares += off * off;
            worst = worst.max(off);
            count += 1.0;
        }
    }
    [f64::sqrt(squares / count), worst]
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::Recipe;

    fn world(last: &str) -> World {
        let text = format!(
            "orogen = 1\nworld = {{ size = 1280, cell = 10 }}\noutputs = {{ height = \"a\" }}\n\
             nodes.n = {{ op = \"fbm\", wavelength = 400 }}\nnodes.a = {last}\n"
        );
        World::open(Recipe::parse(&text, "test").expect("a recipe")).expect("a world")
    }

    #[test]
    fn fields_share_samples_and_filters_do_not() {
        let fields = measure("f", &world("{ op = \"remap\", source = \"n\", to = [0, 100] }")).expect("it has bounds");
        let filtered = measure("b", &world("{ op = \"slope\", source = \"n\" }")).expect("it has bounds");
        assert_eq!((fields.len(), filtered.len()), (3, 3));
        for (row, ratio) in fields.iter().zip(RATIOS) {
            assert_eq!((row["ratio"].as_u64(), row["shared"]["worst_m"].as_f64()), (Some(ratio as u64), Some(0.0)));
            let [rms, worst] = ["rms_m", "worst_m"].map(|key| row["everywhere"][key].as_f64().unwrap_or(0.0));
            assert!(0.0 < rms && rms < worst && worst < 20.0, "{row}");
        }
        assert!(fields[0]["everywhere"]["rms_m"].as_f64() < fields[2]["everywhere"]["rms_m"].as_f64());
        assert!(filtered[0]["shared"]["rms_m"].as_f64() > Some(0.0), "{}", filtered[0]);
    }
}

//! Land that is measured: presets, recipes and files of heights, real ones too.

use std::path::Path;

use orogen::{Grid, Recipe, Window, World, open, presets};

use crate::options::number;

/// The options of the measurement.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Request {
    /// Presets, recipe files and files of heights.
    pub sources: Vec<String>,
    pub seed: Option<u64>,
    pub cell: Option<f64>,
    /// First column and row, columns and rows.
    pub window: Option<[i64; 4]>,
}

/// The name of a source in a table.
pub fn name(source: &str) -> String {
    Path::new(source).file_stem().map_or(source.into(), |name| name.to_string_lossy().into_owned())
}

/// The heights of a source, with the surface of water where it has water.
pub fn heights(source: &str, request: &Request) -> Result<Grid, String> {
    of_world(source, request, |world| match world.recipe().outputs().any(|name| name == "surface") {
        true => "surface",
        false => "height",
    })
}

/// A layer of a source.
pub fn grid(source: &str, request: &Request, layer: &'static str) -> Result<Grid, String> {
    of_world(source, request, |_| layer)
}

/// The layer that is chosen of the world of a source.
fn of_world(source: &str, request: &Request, layer: impl Fn(&World) -> &'static str) -> Result<Grid, String> {
    let text = |error: orogen::Error| format!("{source}: {error}");
    let world = match presets::find(source) {
        Some(preset) => {
            let mut recipe: Recipe = preset.recipe().map_err(text)?;
            recipe.world.seed = request.seed.unwrap_or(recipe.world.seed);
            World::open(recipe)
        }
        None => open(source),
    }
    .map_err(text)?;
    let cell = request.cell.unwrap_or(world.recipe().world.cell);
    let window = match request.window {
        Some([x, y, width, height]) => Window::new(width as usize, height as usize, cell).at(x, y),
        None => world.full_window(cell).map_err(text)?,
    };
    world.window(layer(&world), &window).map_err(text)
}

pub fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

/// A quantile of sorted values; NaN if there are none.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let last = values.len().saturating_sub(1);
    values.get((share * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}

pub fn parse(args: &[String]) -> Result<Request, String> {
    let mut request = Request::default();
    let mut args = args.iter();
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or_else(|| format!("{arg} needs a value after it"));
        match arg.as_str() {
            "--seed" => request.seed = Some(number(arg, value()?)?),
            "--cell" => request.cell = Some(number(arg, value()?)?),
            "--window" => {
                let numbers: Result<Vec<i64>, String> = value()?.split(',').map(|text| number(arg, text)).collect();
                let [x, y, width, height] =
                    numbers?.try_into().map_err(|_| "--window needs four numbers: X,Y,WIDTH,HEIGHT".to_owned())?;
                if width < 8 || height < 8 {
                    return Err("--window must have at least 8 columns and 8 rows".to_owned());
                }
                request.window = Some([x, y, width, height]);
            }
            flag if flag.starts_with("--") => return Err(format!("there is no option '{flag}'")),
            source => request.sources.push(source.to_owned()),
        }
    }
    if request.sources.is_empty() {
        return Err("expected presets, recipe files or files of heights".to_owned());
    }
    Ok(request)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::words;

    #[test]
    fn options() {
        let request = parse(&words("endless a.tif --window -512,-512,1024,1024 --cell 60")).expect("well formed");
        assert_eq!(request.sources, ["endless", "a.tif"]);
        assert_eq!((request.window, request.cell), (Some([-512, -512, 1024, 1024]), Some(60.0)));
        for (line, expect) in [
            ("", "expected presets"),
            ("alpine --window 1,2,3", "four numbers"),
            ("alpine --window 1,2,3,4", "at least 8"),
            ("alpine --seed x", "'x' is not a valid number"),
            ("alpine --fast", "no option '--fast'"),
        ] {
            let message = parse(&words(line)).expect_err(expect);
            assert!(message.contains(expect), "{message}");
        }
    }
}

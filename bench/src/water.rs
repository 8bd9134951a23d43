//! Checks the water of a recipe on a mosaic of tiles that are made separately. Prints a table, and fails if a target is
//! missed.

#[path = "../../crates/orogen/tests/suite/support/water/mod.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod support;

use std::path::Path;
use std::time::Instant;

use crate::options::number;
use orogen::{Options, Recipe, Session, Window, World, presets};
use support::borders::{self, Places};
use support::layers::{Tiles, tiles_in, tiles_of};
use support::mosaic::{Mosaic, TILES};
use support::report;

/// Cells along the side of a tile of an unbounded world.
const SIDE: usize = 512;

/// Half the side of the square of an unbounded world in which pairs of tiles are placed, in cells.
const FAR: i64 = 1 << 20;

/// The options of the measurement.
#[derive(Debug, PartialEq)]
struct Request {
    recipe: String,
    seed: Option<u64>,
    cell: Option<f64>,
    origin: [i64; 2],
    side: Option<usize>,
    pairs: usize,
    pair_side: usize,
    near: usize,
    fresh: bool,
}

/// Runs the measurement.
pub fn run(args: &[String]) -> Result<(), String> {
    let request = parse(args)?;
    measure(&request)
}

fn measure(request: &Request) -> Result<(), String> {
    let text = |error: orogen::Error| error.to_string();
    let mut recipe = match presets::find(&request.recipe) {
        Some(preset) => preset.recipe(),
        None => Recipe::read(Path::new(&request.recipe)),
    }
    .map_err(text)?;
    recipe.world.seed = request.seed.unwrap_or(recipe.world.seed);
    let cell = request.cell.unwrap_or(recipe.world.cell);
    let bounded = recipe.world.size.is_some();
    let extent = match bounded {
        true => World::open(recipe.clone()).and_then(|world| world.full_window(cell)).map_err(text)?,
        false => Window::new(2 * FAR as usize, 2 * FAR as usize, cell).at(-FAR, -FAR),
    };
    let whole = if bounded { extent.width.min(extent.height) / TILES } else { SIDE };
    let mosaic = Mosaic { cell, origin: request.origin, side: request.side.unwrap_or(whole) };
    let began = Instant::now();
    let mut figures = report::measure(&tiles_of(&recipe, None), &mosaic).map_err(text)?;
    eprintln!("mosaic: {:.1} s", began.elapsed().as_secs_f64());
    if request.pairs > 0 {
        let began = Instant::now();
        let session = || Session::new(Options::default()).map_err(text);
        let sessions = [session()?, session()?];
        let (shared, apart) =
            (sessions.each_ref().map(|session| tiles_in(&recipe, session)), tiles_of(&recipe, Some(1)));
        let tiles: [Tiles; 2] = if request.fresh { [&apart, &apart] } else { [&shared[0], &shared[1]] };
        let Request { pair_side: side, pairs, near, .. } = *request;
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let places = Places { extent, side, pairs, near, seed: 1 };
        let found = borders::measure_pairs(tiles, &places, threads).map_err(text)?;
        figures.extend(report::of_pairs(&found));
        eprintln!("{pairs} pairs: {:.1} s", began.elapsed().as_secs_f64());
    }
    let [x, y] = mosaic.origin;
    println!(
        "{}, seed {}: {TILES} x {TILES} tiles of {} x {} cells of {cell} m from ({x}, {y})\n\n{}",
        request.recipe,
        recipe.world.seed,
        mosaic.side,
        mosaic.side,
        report::table(&figures)
    );
    match figures.iter().filter(|figure| !figure.holds()).count() {
        0 => Ok(()),
        missed => Err(format!("{missed} targets are missed")),
    }
}

fn parse(args: &[String]) -> Result<Request, String> {
    let mut request = Request {
        recipe: String::new(),
        seed: None,
        cell: None,
        origin: [0, 0],
        side: None,
        pairs: 200,
        pair_side: 64,
        near: 1,
        fresh: false,
    };
    let mut args = args.iter();
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or_else(|| format!("{arg} needs a value after it"));
        match arg.as_str() {
            "--seed" => request.seed = Some(number(arg, value()?)?),
            "--cell" => request.cell = Some(number(arg, value()?)?),
            "--side" => request.side = Some(number(arg, value()?)?),
            "--pairs" => request.pairs = number(arg, value()?)?,
            "--pair-side" => request.pair_side = number(arg, value()?)?,
            "--near" => request.near = number(arg, value()?)?,
            "--fresh" => request.fresh = true,
            "--origin" => {
                let (x, y) = value()?.split_once(',').ok_or("--origin needs a column and a row: X,Y")?;
                request.origin = [number(arg, x)?, number(arg, y)?];
            }
            flag if flag.starts_with("--") => return Err(format!("there is no option '{flag}'")),
            recipe if request.recipe.is_empty() => request.recipe = recipe.to_owned(),
            other => return Err(format!("expected one recipe, not also '{other}'")),
        }
    }
    match () {
        () if request.recipe.is_empty() => Err("expected a preset or a recipe file".to_owned()),
        () if request.side.is_some_and(|side| side < 2) => Err("--side must be at least 2 cells".to_owned()),
        () if request.pair_side < 8 => Err("--pair-side must be at least 8 cells".to_owned()),
        () => Ok(request),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::words;

    #[test]
    fn options() {
        let request =
            parse(&words("alpine --origin -5,7 --side 100 --pairs 10 --near 5 --fresh")).expect("well formed");
        assert_eq!((request.recipe.as_str(), request.origin, request.side), ("alpine", [-5, 7], Some(100)));
        assert_eq!((request.pairs, request.near, request.fresh, request.cell), (10, 5, true, None));
        for (line, expect) in [
            ("", "expected a preset"),
            ("alpine hills", "not also 'hills'"),
            ("alpine --origin 5", "a column and a row"),
            ("alpine --side x", "'x' is not a valid number"),
            ("alpine --quick", "no option '--quick'"),
        ] {
            let error = parse(&words(line)).expect_err(expect);
            assert!(error.contains(expect), "{error}");
        }
    }
}

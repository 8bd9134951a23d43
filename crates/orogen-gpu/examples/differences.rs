//! Prints the differences between terrain on a graphics card and on the processor: the tables of docs/gpu.md.
//!
//! ```text
//! cargo run --release -p orogen-gpu --example differences
//! ```

#[path = "../tests/suite/common/mod.rs"]
mod common;

use common::{compare, gpu, session};
use orogen_engine::lower::Lowering;
use orogen_engine::node::Node;
use orogen_engine::op::{Op, WorldParams};
use orogen_engine::{Options, Recipe, Session, Window, presets};
use std::sync::Arc;

/// Inputs of the ops: noise, heights in metres, and areas.
const SOURCES: &str = "orogen = 1\n[world]\ncell = 10\nsize = [4e6, 4e6]\n[nodes.hills]\nop = \"fbm\"\nseed = 3\nwavelength = 700\n\
    [nodes.other]\nop = \"perlin\"\nseed = 4\nwavelength = 900\n\
    [nodes.heights]\nop = \"expr\"\nexpr = \"300 + 400 * hills\"\n";

/// Samples near the origin and a thousand kilometres away.
fn windows() -> [Window; 2] {
    let window = Window::new(257, 193, 10.0);
    [window.at(20, 31), window.at(100_000, 100_003)]
}

/// A recipe with one node of an op with its defaults.
fn recipe(node: &Node) -> Option<Recipe> {
    let spec = node.spec();
    let reads_heights = !matches!(node.op(), Op::Field(_));
    let mut text = format!("{SOURCES}[nodes.made]\nop = \"{}\"\n", spec.op);
    for (i, input) in spec.inputs.iter().filter(|input| input.required).enumerate() {
        let source = if reads_heights { "heights" } else { ["hills", "other"][i % 2] };
        text.push_str(&format!("{} = \"{source}\"\n", input.name));
    }
    text.push_str("[outputs]\nheight = \"made\"\n");
    Recipe::parse(&text, spec.op).ok()
}

/// A recipe of a solver of water that reads exact heights, or of a levelled op with its rivers.
fn water_recipe(op: &str) -> Option<Recipe> {
    let more = match op {
        "fill" | "lakes" | "drainage" => "",
        "height-above-drainage" => "stream = 1e5\n",
        "stream-power" => "steps = 1\nyears = 30000\n",
        "amplify" => "flow = \"rivers.flow\"\ncell = 60\nhalvings = 3\n",
        "learned" => "cell = 60\nhalvings = 3\n",
        "continents" => "",
        _ => return None,
    };
    let source = match op {
        "amplify" | "learned" => "source = \"rivers\"\n",
        "continents" => "",
        _ => "source = \"baked\"\n",
    };
    let text = format!(
        "orogen = 1\n[world]\nseed = 2\ncell = 30\nsize = [12000, 9000]\n[nodes.hills]\nop = \"fbm\"\nwavelength = 3000\n\
         [nodes.heights]\nop = \"expr\"\nexpr = \"400 + 300 * hills\"\n[nodes.baked]\nop = \"bake\"\nsource = \"heights\"\n[nodes.rivers]\nop = \"stream-power\"\nsource = \"heights\"\n\
         cell = 480\nmargin = 20000\nsteps = 1\n[nodes.made]\nop = \"{op}\"\n{source}{more}[outputs]\nheight = \"made\"\n"
    );
    Recipe::parse(&text, op).ok()
}

/// The reason why the processor computes an op, if it does; `Err` for ops that compute nothing, or that are computed
/// level by level.
fn reason(node: &Node) -> Result<Option<&'static str>, ()> {
    let world_params = WorldParams { seed: 0, size: Some([4e6, 4e6]), cell: 10.0, sea_level: 0.0 };
    match node.op() {
        Op::Field(field) if field.terms().is_some() || field.source_cell(1.0, 1.0).is_some() => Err(()),
        Op::Field(field) if field.coord_map().is_some() => Ok(None),
        Op::Field(field) => Ok(reason_of(&field.lower(0, &world_params))),
        Op::Filter(filter) => Ok(reason_of(&filter.lower(10.0, &world_params))),
        Op::Solver(solver) => {
            let padded = Window::new(400, 300, 10.0);
            Ok(reason_of(&solver.lower(&padded, &vec![false; node.inputs().len()], &world_params)))
        }
        Op::Levelled(_) => Err(()),
    }
}

fn reason_of<T>(lowering: &Lowering<T>) -> Option<&'static str> {
    match lowering {
        Lowering::Shader(_) => None,
        Lowering::Processor(why) => Some(why),
        Lowering::Missing => Some("not written yet"),
    }
}

fn shown(number: f64) -> String {
    if number == 0.0 { "0".to_string() } else { format!("{number:.0e}") }
}

fn main() {
    let session = session();
    println!("Adapter: {}, {}.\n", gpu().adapter(), gpu().adapter().driver);
    println!(
        "| op | layer | RMS | worst | worst, of the range | worst at 1000 km, of the range |\n|---|---|---|---|---|---|"
    );
    let mut on_processor = Vec::new();
    for node in Node::all() {
        let name = node.spec().op;
        match reason(&node) {
            Err(()) => continue,
            Ok(Some(why)) => {
                on_processor.push((name, why));
                continue;
            }
            Ok(None) => {}
        }
        let Some(recipe) = recipe(&node).filter(|_| !matches!(node.op(), Op::Solver(_))) else { continue };
        for layer in node.layers() {
            let path = format!("made.{}", layer.name);
            let path = if node.layers().len() == 1 { "height".to_string() } else { path };
            let [near, far] = windows().map(|window| compare(&session, &recipe, &path, &window));
            let [rms, worst, share, far] =
                [near.rms, f64::from(near.worst), f64::from(near.share), f64::from(far.share)].map(shown);
            println!("| `{name}` | {} | {rms} | {worst} | {share} | {far} |", layer.name);
        }
    }
    println!(
        "\n| op | layer | RMS | worst, of the range | share of the samples beyond 1e-4 of it |\n|---|---|---|---|---|"
    );
    for node in Node::all().iter().filter(|node| matches!(node.op(), Op::Solver(_) | Op::Levelled(_))) {
        let name = node.spec().op;
        let Some(recipe) = water_recipe(name) else { continue };
        let cell = if matches!(node.op(), Op::Levelled(_)) { 60.0 } else { 30.0 };
        for layer in node.layers() {
            // A separate session has no exact solutions that it would use. It makes drafts, so that the card solves one
            // step of `stream-power`.
            let Ok(card) = Session::new(Options::default()) else { continue };
            let card = card.with_device(Arc::new(gpu().clone()));
            let card = if name == "stream-power" { card.drafting() } else { card };
            let found = compare(&card, &recipe, &format!("made.{}", layer.name), &Window::new(200, 150, cell));
            let [rms, share, beyond] = [found.rms, f64::from(found.share), found.beyond].map(shown);
            println!("| `{name}` | {} | {rms} | {share} | {beyond} |", layer.name);
        }
    }
    let mut alone: Vec<String> = Vec::new();
    println!("\n| preset | RMS in m | worst in m | worst, of the range |\n|---|---|---|---|");
    for preset in presets::all() {
        let Ok(recipe) = preset.recipe() else { continue };
        let window = session.open(recipe.clone()).and_then(|world| world.window_fitting(256));
        let window = window.unwrap_or(Window::new(256, 256, recipe.world.cell));
        let _ = gpu().take_seconds();
        let difference = compare(&session, &recipe, "height", &window);
        if gpu().take_seconds() == 0.0 {
            alone.push(format!("`{}`", preset.name));
            continue;
        }
        let [rms, worst, share] = [difference.rms, f64::from(difference.worst), f64::from(difference.share)].map(shown);
        println!("| `{}` | {rms} | {worst} | {share} |", preset.name);
    }
    println!("\nThe heights of the other presets are the processor's alone: {}.", alone.join(", "));
    println!("\n| op | why the processor computes it |\n|---|---|");
    for (name, why) in on_processor {
        println!("| `{name}` | {why} |");
    }
    if let Some(failure) = gpu().failure() {
        println!("\n{failure}");
    }
}

//! The description of a plan for users.

use super::levels::Serving;
use super::steps::{Plan, Step};
use super::{cost, memory};
use crate::recipe::document::Recipe;
use crate::recipe::graph::Graph;
use orogen_grid::grid::Window;
use orogen_grid::words::{bytes, count, number};
use orogen_ops::declare::short;
use orogen_ops::ids::{GridId, Id, NodeId};
use orogen_ops::op::Op;
use std::fmt::Write as _;

/// Describes a plan: the nodes in order with their locality and halo, then the steps with their windows and memory.
pub fn explain(plan: &Plan, recipe: &Recipe, graph: &Graph, threads: usize) -> String {
    let mut text = String::new();
    let cell = plan.window.cell;
    let longest = recipe.nodes().iter().map(|node| node.name.chars().count()).max().unwrap_or(4).clamp(4, 24);
    let _ = writeln!(text, "nodes, in the order of evaluation, at a cell size of {} m", number(cell));
    let _ = writeln!(text, "  {:longest$}  {:12}  {:8}  {:18}  what it does", "name", "op", "locality", "looks at");
    const SHOWN: usize = 200;
    for &index in graph.order.iter().take(SHOWN) {
        let named = &recipe.nodes()[index.index()];
        let spec = named.node.spec();
        let reach = match named.node.op() {
            Op::Field(field) if let Some(source) = field.source_cell(cell, recipe.world.cell) => {
                format!("samples at {} m", number(source))
            }
            Op::Field(field) => match field.coord_map() {
                Some(orogen_ops::op::CoordMap::Displaced { reach, .. }) => format!("within {} m", number(reach)),
                Some(map) if let Some(altitude) = map.altitude() => format!("at altitude {} m", number(altitude)),
                Some(orogen_ops::op::CoordMap::Mapped { .. }) => "elsewhere".to_string(),
                None => match field.stencil() {
                    Some(stencil) => format!("within {} m", number(stencil.step)),
                    None => "one position".to_string(),
                },
            },
            Op::Filter(filter) => format!("halo of {}", count(filter.halo(cell), "sample")),
            Op::Levelled(op) => {
                let levels = op.levels();
                format!("{} to {} m", number(levels.cell(0)), number(levels.finest))
            }
            Op::Solver(solver) => {
                format!("world{} at {} m", beyond(solver.margin()), number(solver.cell(recipe.world.cell)))
            }
        };
        let _ = writeln!(
            text,
            "  {:longest$}  {:12}  {:8}  {reach:18}  {}",
            named.name,
            spec.op,
            spec.locality.name(),
            brief(&short(spec.doc))
        );
    }
    if graph.order.len() > SHOWN {
        let _ = writeln!(text, "  and {} more", graph.order.len() - SHOWN);
    }
    let _ = writeln!(
        text,
        "\nsteps for {} x {} samples at ({}, {})",
        plan.window.width, plan.window.height, plan.window.x, plan.window.y
    );
    let named = |node: NodeId| recipe.nodes().get(node.index());
    let name = |node: NodeId| named(node).map_or("?", |named| named.name.as_str());
    for solve in &plan.solves {
        let _ = writeln!(
            text,
            "  solve `{}` over the world{}, {} x {} samples at {} m; keeps {}{}",
            name(solve.node),
            beyond(named(solve.node).and_then(|named| named.node.margin())),
            solve.domain.width,
            solve.domain.height,
            number(solve.domain.cell),
            bytes(memory::rasters(solve)),
            if solve.on_disk { ", the rest on disk" } else { "" }
        );
    }
    for step in plan.steps.iter().take(SHOWN) {
        let window = step.window();
        let _ = match step {
            Step::Fill { program, out, .. } => {
                let made: Vec<String> =
                    out.iter().map(|&grid| format!("`{}`", plan.grids[grid].node.map_or("a constant", name))).collect();
                writeln!(
                    text,
                    "  fill {} with {}: {} over {}",
                    extent(window),
                    made.join(", "),
                    count(program.instructions.len(), "instruction"),
                    count(program.registers, "register")
                )
            }
            Step::Apply { node, halo, out, .. } => {
                let which = layers_read(recipe, *node, out);
                writeln!(text, "  apply `{}`{which} to {}, halo {halo}", name(*node), extent(window))
            }
            Step::Refine { node, out, .. } => {
                let which = layers_read(recipe, *node, out);
                let level = match named(*node).map(|named| named.node.op()) {
                    Some(Op::Levelled(op)) => {
                        let (levels, serving) = (op.levels(), Serving::of(&op.levels(), window));
                        let cell = number(serving.samples.cell);
                        format!(" from {}, the last of {cell} m", count(serving.level.min(levels.count) + 1, "level"))
                    }
                    _ => String::new(),
                };
                writeln!(text, "  refine `{}`{which} to {}{level}", name(*node), extent(window))
            }
        };
    }
    if plan.steps.len() > SHOWN {
        let _ = writeln!(text, "  and {} more", plan.steps.len() - SHOWN);
    }
    let _ = writeln!(
        text,
        "\nmemory: at most {}, with {}",
        bytes(memory::needed(plan, recipe, threads)),
        count(threads, "thread")
    );
    if let disk @ 1.. = memory::disk(plan) {
        let _ = writeln!(text, "disk: {} temporarily", bytes(disk));
    }
    let solving = plan.solves.iter().fold(0u64, |sum, solve| sum.saturating_add(solve.samples));
    let solved = if solving > 0 { format!(", and {} to solve the world once", about(solving)) } else { String::new() };
    let _ = writeln!(text, "samples: {}{solved}", about(plan.samples()));
    let nanoseconds = cost::needed(plan, recipe);
    let _ = match duration(nanoseconds) {
        None => writeln!(text, "time: less than 0.1 s"),
        Some(one) => {
            let all = duration(nanoseconds / threads as f64).unwrap_or_else(|| "less than 0.1 s".to_string());
            writeln!(
                text,
                "time: about {one} of one core, {all} with {}; it varies between machines",
                count(threads, "thread")
            )
        }
    };
    text
}

/// The layers that a step makes, in brackets, if the node has several.
fn layers_read(recipe: &Recipe, node: NodeId, out: &[Option<GridId>]) -> String {
    let layers = recipe.nodes()[node.index()].node.layers();
    let wanted = layers.iter().zip(out).filter(|(_, out)| out.is_some()).map(|(layer, _)| layer.name);
    if layers.len() > 1 { format!(" ({})", wanted.collect::<Vec<_>>().join(", ")) } else { String::new() }
}

/// The margin of a solver, to follow the word "world".
fn beyond(margin: Option<f64>) -> String {
    match margin {
        Some(margin @ f64::MIN_POSITIVE..) => format!(" and {} m around", number(margin)),
        _ => String::new(),
    }
}

fn extent(window: &Window) -> String {
    format!("{} x {} at ({}, {})", window.width, window.height, window.x, window.y)
}

/// A number of samples, formatted for users.
fn about(samples: u64) -> String {
    match samples as f64 {
        n if n >= 1e9 => format!("{:.1} thousand million", n / 1e9),
        n if n >= 1e6 => format!("{:.1} million", n / 1e6),
        n if n >= 1e4 => format!("{:.0} thousand", n / 1e3),
        _ => samples.to_string(),
    }
}

/// A time, formatted with one or two digits; `None` if it is negligible.
fn duration(nanoseconds: f64) -> Option<String> {
    Some(match nanoseconds / 1e9 {
        s if s < 0.1 => return None,
        s if s < 10.0 => format!("{s:.1} s"),
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6000.0 => format!("{:.0} minutes", s / 60.0),
        s => format!("{:.0} hours", s / 3600.0),
    })
}

/// The first sentence, cut at a word if it is too long for a line.
fn brief(doc: &str) -> String {
    const LONGEST: usize = 60;
    let message = doc.split(". ").next().unwrap_or_default().trim_end_matches('.');
    let mut line = String::new();
    for word in message.split(' ') {
        if line.chars().count() + word.chars().count() > LONGEST {
            return line.trim_end_matches([',', ':', ';', ' ']).to_string() + " ...";
        }
        line.extend([if line.is_empty() { "" } else { " " }, word]);
    }
    line
}

//! Helpers for tests of solvers: sources in memory, and solutions by the processor and by a card.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

use super::filters::WORLD;
use super::run;
use orogen_engine::declare::Spec;
use orogen_engine::device::PassStep;
use orogen_engine::lower::{Lowering, Passes};
use orogen_engine::node::Node;
use orogen_engine::op::{Context, Op, Solution, Solver, Sources};
use orogen_gpu::{Failure, Gpu};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_io::raster::Raster;

/// Grids over the whole domain as the inputs of a solver.
struct InMemory<'a> {
    spec: &'static Spec,
    window: Window,
    inputs: &'a [Option<Grid>],
}

impl Sources for InMemory<'_> {
    fn domain(&self) -> &Window {
        &self.window
    }

    fn padded(&self) -> &Window {
        &self.window
    }

    fn given(&self, name: &str) -> bool {
        self.inputs[self.spec.input_named(name).unwrap()].is_some()
    }

    fn each_tile(&self, name: &str, window: &Window, visit: &mut dyn FnMut(&Grid) -> Result<()>) -> Result<()> {
        let grid = self.inputs[self.spec.input_named(name).unwrap()].as_ref().unwrap();
        visit(&grid.crop(window).unwrap())
    }

    fn raster(&self) -> Result<Raster> {
        Ok(Raster::in_memory(Grid::filled(self.window, 0.0)))
    }

    fn on_disk(&self) -> bool {
        false
    }

    fn keep(&self, grid: Grid) -> Result<Raster> {
        Ok(Raster::in_memory(grid))
    }
}

/// The solver of a node.
pub fn solver(node: &Node) -> Option<&dyn Solver> {
    match node.op() {
        Op::Solver(solver) => Some(solver),
        _ => None,
    }
}

/// The passes by which a graphics card solves a node, if it does.
pub fn solver_passes(node: &Node, window: &Window, inputs: &[Option<Grid>]) -> Option<Passes> {
    let given: Vec<bool> = inputs.iter().map(Option::is_some).collect();
    match solver(node)?.lower(window, &given, &WORLD) {
        Lowering::Shader(passes) => Some(passes),
        _ => None,
    }
}

/// All layers of a solution by the processor.
pub fn solved_by_processor(node: &Node, window: &Window, inputs: &[Option<Grid>]) -> Vec<Grid> {
    let context = Context { world_params: &WORLD, progress: &Progress::none(), observer: None };
    let sources = InMemory { spec: node.spec(), window: *window, inputs };
    let Solution { layers, .. } = solver(node).unwrap().solve(&sources, &context).unwrap();
    layers.iter().map(|layer| layer.get(window).unwrap()).collect()
}

/// All layers of a solution by a graphics card.
pub fn solved_by_card(gpu: &Gpu, node: &Node, window: &Window, inputs: &[Option<Grid>]) -> Vec<Grid> {
    try_card(gpu, node, window, inputs).unwrap()
}

/// [`solved_by_card`] with its failure.
pub fn try_card(
    gpu: &Gpu,
    node: &Node,
    window: &Window,
    inputs: &[Option<Grid>],
) -> std::result::Result<Vec<Grid>, Failure> {
    Ok(run(gpu, &[step(node, window, inputs)], &[], || false)?.unwrap())
}

/// A solver with its inputs.
pub fn step<'a>(node: &Node, window: &Window, inputs: &[Option<Grid>]) -> PassStep<'a> {
    super::step(solver_passes(node, window, inputs).unwrap(), inputs, window)
}

//! The data of a plan: steps, solvers and grids.

use super::key::Key;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_ops::ids::{GridId, IndexVec, NodeId, StepId};
use orogen_ops::program::{Instruction, Program};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// A plan for layers over a window: an owned value, made without computing any sample.
///
/// It can be stored and sent (serde). It contains the version of the library, the identity of its recipe and a
/// checksum. Deserialization fails for other versions and for damaged plans; a plan of another recipe cannot be run.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The identity of its recipe: a hash of the content keys of all nodes.
    pub(crate) recipe: Key,
    /// The window.
    pub(crate) window: Window,
    /// Whether the program is evaluated at arbitrary points within the window instead of its lattice.
    pub(crate) scattered: bool,
    /// The solvers that must be solved first, in order.
    pub(crate) solves: Vec<Solve>,
    /// The steps, in order.
    pub(crate) steps: IndexVec<StepId, Step>,
    /// The grids of the steps.
    pub(crate) grids: IndexVec<GridId, GridSlot>,
    /// The grids with the results (empty if scattered: then the last step's program computes them).
    pub(crate) outputs: Vec<GridId>,
}

/// A solver to be solved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Solve {
    /// The node.
    pub node: NodeId,
    /// The key of its solution.
    pub key: Key,
    /// Its domain on its lattice: the world and the solver's margin.
    #[serde(alias = "world")]
    pub domain: Window,
    /// The domain with the samples beyond its edge that readers may need.
    pub padded: Window,
    /// Number of rasters that it keeps or works in, each over `padded`.
    pub rasters: usize,
    /// Whether the rasters are on disk.
    pub on_disk: bool,
    /// Memory for solving in addition to the rasters, in bytes.
    pub scratch: u64,
    /// [`Solve::scratch`] if the rasters are on disk.
    pub scratch_on_disk: u64,
    /// Side of the tiles in which its sources are made, in samples.
    pub side: usize,
    /// Maximum memory for making a tile of its sources, in bytes.
    pub tile: u64,
    /// The solvers that its sources read.
    pub reads: Vec<NodeId>,
    /// Approximate number of samples that are made for its sources.
    pub samples: u64,
    /// Approximate time for making its sources on one core, in nanoseconds.
    pub source_work: f64,
    /// Approximate time for solving without the sources, in nanoseconds.
    pub own_work: f64,
}

impl Solve {
    /// Approximate time on one core, in nanoseconds.
    #[must_use]
    pub fn work(&self) -> f64 {
        self.source_work + self.own_work
    }
}

/// A step of a plan. While it is planned, it reads requests instead of grids.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Step<G = GridId> {
    /// Runs a program over a window, block by block.
    Fill {
        /// The program.
        program: Program<G>,
        /// The window.
        window: Window,
        /// The grids for its outputs (empty if scattered).
        out: Vec<GridId>,
    },
    /// Applies a filter.
    Apply {
        /// The node.
        node: NodeId,
        /// The grids of its inputs, each covering at least the window grown by the halo.
        inputs: Vec<Option<G>>,
        /// The window.
        window: Window,
        /// Halo, in samples.
        halo: usize,
        /// The grids for its layers; `None` for a layer that is not read.
        out: Vec<Option<GridId>>,
    },
    /// Makes the layers of a levelled op, level by level.
    Refine {
        /// The node.
        node: NodeId,
        /// The grids of its inputs at each level from the coarsest, each covering at least the samples that the level
        /// reads.
        inputs: Vec<Vec<Option<G>>>,
        /// The window.
        window: Window,
        /// The grids for its layers; `None` for a layer that is not read.
        out: Vec<Option<GridId>>,
    },
}

/// Which layers of a node have a grid.
#[must_use]
pub fn wanted(out: &[Option<GridId>]) -> Vec<bool> {
    out.iter().map(Option::is_some).collect()
}

/// A grid of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GridSlot {
    /// Its window.
    pub window: Window,
    /// The node it holds; `None` for a constant.
    pub node: Option<NodeId>,
    /// The last step that reads it; `None` for an output, which is kept.
    pub last_use: Option<StepId>,
}

impl<G> Step<G> {
    /// The step with other grids in place of its inputs.
    pub(super) fn resolve<H>(self, grid: impl Fn(G) -> Result<H>) -> Result<Step<H>> {
        Ok(match self {
            Step::Fill { program, window, out } => Step::Fill { program: program.resolve(grid)?, window, out },
            Step::Apply { node, inputs, window, halo, out } => {
                let inputs = resolved(inputs, &grid)?;
                Step::Apply { node, inputs, window, halo, out }
            }
            Step::Refine { node, inputs, window, out } => {
                let inputs = inputs.into_iter().map(|inputs| resolved(inputs, &grid)).collect::<Result<_>>()?;
                Step::Refine { node, inputs, window, out }
            }
        })
    }
}

/// Maps each input to its grid.
fn resolved<G, H>(inputs: Vec<Option<G>>, grid: &impl Fn(G) -> Result<H>) -> Result<Vec<Option<H>>> {
    inputs.into_iter().map(|input| input.map(grid).transpose()).collect()
}

impl Step {
    /// The solvers that it reads.
    pub fn solvers_read(&self) -> impl Iterator<Item = NodeId> {
        let program = match self {
            Step::Fill { program, .. } => Some(program),
            Step::Apply { .. } | Step::Refine { .. } => None,
        };
        program.into_iter().flat_map(|program| &program.instructions).filter_map(|instruction| match instruction {
            Instruction::Solved { node, .. } => Some(*node),
            _ => None,
        })
    }

    /// The grids that it reads.
    #[must_use]
    pub fn reads(&self) -> Vec<GridId> {
        match self {
            Step::Fill { program, .. } => program.reads(),
            Step::Apply { inputs, .. } => inputs.iter().flatten().copied().collect(),
            Step::Refine { inputs, .. } => inputs.iter().flatten().flatten().copied().collect(),
        }
    }

    /// The grids that it makes.
    #[must_use]
    pub fn writes(&self) -> Vec<GridId> {
        match self {
            Step::Fill { out, .. } => out.clone(),
            Step::Apply { out, .. } | Step::Refine { out, .. } => out.iter().flatten().copied().collect(),
        }
    }

    /// The window of the result.
    #[must_use]
    pub fn window(&self) -> &Window {
        match self {
            Step::Fill { window, .. } | Step::Apply { window, .. } | Step::Refine { window, .. } => window,
        }
    }
}

impl Plan {
    /// The window of the result.
    #[must_use]
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// The solvers that must be solved first, in order.
    #[must_use]
    pub fn solves(&self) -> &[Solve] {
        &self.solves
    }

    /// The steps, in order.
    #[must_use]
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Solves on disk, with solvers' sources in tiles of `side` samples, as the planner does if memory is short.
    pub fn solve_on_disk(&mut self, side: usize) {
        for solve in &mut self.solves {
            (solve.on_disk, solve.side) = (true, side);
        }
    }

    /// Whether one program serves all points: no step depends on their positions.
    #[must_use]
    pub fn is_pointwise(&self) -> bool {
        self.scattered && self.steps.len() == 1 && self.grids.is_empty()
    }

    /// The program that a scattered plan evaluates at points, after all other steps.
    #[must_use]
    pub fn asked(&self) -> Option<&Program> {
        match self.steps.last() {
            Some(Step::Fill { program, out, .. }) if self.scattered && out.is_empty() => Some(program),
            _ => None,
        }
    }

    /// The solvers that its steps read.
    #[must_use]
    pub fn solvers_read(&self) -> BTreeSet<NodeId> {
        self.steps.iter().flat_map(Step::solvers_read).collect()
    }

    /// Number of samples to be made, without solvers' sources.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.steps.iter().fold(0u64, |sum, step| sum.saturating_add(step.window().len() as u64))
    }
}

/// Memory of a grid over a window, in bytes.
#[must_use]
pub fn grid_bytes(window: &Window) -> u64 {
    (window.width as u64).saturating_mul(window.height as u64).saturating_mul(4)
}

//! The data of a plan: steps, solvers and grids.

use super::key::Key;
use super::program::{Instruction, Program};
use orogen_grid::grid::Window;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fmt::{self, Write};

/// A plan for layers over a window: an owned value, made without computing any sample.
///
/// It can be stored and sent (serde). It contains the version of the library, the identity of its recipe and a
/// checksum. Deserialisation fails for other versions and for damaged plans; a plan of another recipe cannot be run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "StoredPlan", into = "StoredPlan")]
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
    pub(crate) steps: Vec<Step>,
    /// The grids of the steps.
    pub(crate) grids: Vec<GridSlot>,
    /// The grids with the results (empty if scattered: then the last step's program computes them).
    pub(crate) outputs: Vec<usize>,
}

/// A solver to be solved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Solve {
    /// The node.
    pub node: usize,
    /// The key of its solution.
    pub key: Key,
    /// Its domain on its lattice: the world and the solver's margin.
    pub domain: Window,
    /// The same with the samples beyond the edge that readers may need.
    pub padded: Window,
    /// Number of rasters that it keeps or works in, each over `padded`.
    pub rasters: usize,
    /// Whether they are on disk.
    pub on_disk: bool,
    /// Memory of solving beside the rasters, in bytes.
    pub scratch: u64,
    /// The same if the rasters are on disk.
    pub scratch_on_disk: u64,
    /// Side of the tiles in which its sources are made, in samples.
    pub side: usize,
    /// Maximum memory for making a tile of its sources, in bytes.
    pub tile: u64,
    /// The solvers that its sources read.
    pub reads: Vec<usize>,
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

/// A step of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Step {
    /// Runs a program over a window, block by block.
    Fill {
        /// The program.
        program: Program,
        /// The window.
        window: Window,
        /// The grids for its outputs (empty if scattered).
        out: Vec<usize>,
    },
    /// Applies a filter.
    Apply {
        /// The node.
        node: usize,
        /// The grids of its inputs, each covering at least the window grown by the halo.
        inputs: Vec<Option<usize>>,
        /// The window.
        window: Window,
        /// Halo, in samples.
        halo: usize,
        /// The grids for its layers; `None` for a layer that is not read.
        out: Vec<Option<usize>>,
    },
}

/// A grid of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GridSlot {
    /// Its window.
    pub window: Window,
    /// The node it holds.
    pub node: usize,
    /// The last step that reads it; the number of steps for an output.
    pub last_use: usize,
}

impl Step {
    /// The grids that it reads.
    #[must_use]
    pub fn reads(&self) -> Vec<usize> {
        match self {
            Step::Fill { program, .. } => program
                .instructions
                .iter()
                .filter_map(|instruction| match instruction {
                    Instruction::Grid { grid, .. } => Some(*grid),
                    _ => None,
                })
                .collect(),
            Step::Apply { inputs, .. } => inputs.iter().flatten().copied().collect(),
        }
    }

    /// The grids that it makes.
    #[must_use]
    pub fn writes(&self) -> Vec<usize> {
        match self {
            Step::Fill { out, .. } => out.clone(),
            Step::Apply { out, .. } => out.iter().flatten().copied().collect(),
        }
    }

    /// The window of the result.
    #[must_use]
    pub fn window(&self) -> &Window {
        match self {
            Step::Fill { window, .. } | Step::Apply { window, .. } => window,
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
    pub fn solvers_read(&self) -> BTreeSet<usize> {
        let mut read = BTreeSet::new();
        for step in &self.steps {
            let Step::Fill { program, .. } = step else { continue };
            for instruction in &program.instructions {
                if let Instruction::Solved { node, .. } = instruction {
                    read.insert(*node);
                }
            }
        }
        read
    }

    /// Number of samples to be made, without solvers' sources.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.steps.iter().fold(0u64, |sum, step| sum.saturating_add(step.window().len() as u64))
    }
}

/// The serialised form of a plan.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct StoredPlan {
    orogen: String,
    checksum: Key,
    recipe: Key,
    window: Window,
    scattered: bool,
    solves: Vec<Solve>,
    steps: Vec<Step>,
    grids: Vec<GridSlot>,
    outputs: Vec<usize>,
}

/// SHA-256 of a plan's debug text, which distinguishes all bits except those of NaNs.
fn checksum(plan: &Plan) -> Key {
    struct Text(Sha256);
    impl Write for Text {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0.update(text.as_bytes());
            Ok(())
        }
    }
    let mut text = Text(Sha256::new());
    // Hashing cannot fail.
    let _ = write!(text, "{plan:?}");
    text.0.finalize().into()
}

impl From<Plan> for StoredPlan {
    fn from(plan: Plan) -> StoredPlan {
        let checksum = checksum(&plan);
        let Plan { recipe, window, scattered, solves, steps, grids, outputs } = plan;
        let orogen = env!("CARGO_PKG_VERSION").to_string();
        StoredPlan { orogen, checksum, recipe, window, scattered, solves, steps, grids, outputs }
    }
}

impl TryFrom<StoredPlan> for Plan {
    type Error = String;

    fn try_from(stored: StoredPlan) -> Result<Plan, String> {
        let StoredPlan { orogen, checksum: expected, recipe, window, scattered, solves, steps, grids, outputs } =
            stored;
        let own = env!("CARGO_PKG_VERSION");
        if orogen != own {
            return Err(format!("the plan was made by Orogen {orogen}, this is {own}: make the plan again"));
        }
        let plan = Plan { recipe, window, scattered, solves, steps, grids, outputs };
        match checksum(&plan) == expected {
            true => Ok(plan),
            false => Err("the plan is damaged: its checksum does not match; make the plan again".into()),
        }
    }
}

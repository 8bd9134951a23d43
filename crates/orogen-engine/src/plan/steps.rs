//! What a plan is: steps, solvers and grids, as plain data.

use super::key::Key;
use super::program::{Instruction, Program};
use orogen_grid::grid::Window;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fmt::{self, Write};

/// What will be done to make some layers over a window: an owned value that touches no sample.
///
/// It may be stored or sent (serde): it carries the version of the library, the identity of its recipe and a checksum. A plan of another version and a
/// damaged one are not read; a plan of another recipe is not run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "StoredPlan", into = "StoredPlan")]
pub struct Plan {
    /// The identity of its recipe: the content keys of all nodes.
    pub(crate) recipe: Key,
    /// What is made.
    pub(crate) window: Window,
    /// Whether the program is asked at the window's lattice, or at points that lie anywhere within it.
    pub(crate) scattered: bool,
    /// The solvers that must be solved first, in order.
    pub(crate) solves: Vec<Solve>,
    /// What is then done, in order.
    pub(crate) steps: Vec<Step>,
    /// The grids that steps make.
    pub(crate) grids: Vec<GridSlot>,
    /// The grids that hold the results (empty if scattered: then the last step's program makes them).
    pub(crate) outputs: Vec<usize>,
}

/// A solver to be solved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Solve {
    /// The node.
    pub node: usize,
    /// What its solution is stored under.
    pub key: Key,
    /// The samples of the world on its lattice.
    pub world: Window,
    /// Those with the margin for readers.
    pub padded: Window,
    /// Rasters that it keeps or works in, each over `padded`.
    pub rasters: usize,
    /// Whether they are on disk.
    pub on_disk: bool,
    /// Bytes of memory that solving takes beside them.
    pub scratch: u64,
    /// The same when they are on disk.
    pub scratch_on_disk: u64,
    /// Samples along a side of the tiles that its sources are made in.
    pub side: usize,
    /// Bytes that making a tile of its sources takes at most.
    pub tile: u64,
    /// The solvers that its sources read.
    pub reads: Vec<usize>,
    /// Samples made for its sources, about.
    pub samples: u64,
    /// Nanoseconds of one core that making its sources takes, about.
    pub source_work: f64,
    /// Nanoseconds of one core that solving takes beside them, about.
    pub own_work: f64,
}

impl Solve {
    /// Nanoseconds of one core that it takes, about.
    pub fn work(&self) -> f64 {
        self.source_work + self.own_work
    }
}

/// One step of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Step {
    /// Runs a program over a window, block by block.
    Fill {
        /// The program.
        program: Program,
        /// The samples made.
        window: Window,
        /// The grids its outputs go to (none if scattered).
        out: Vec<usize>,
    },
    /// Applies a filter.
    Apply {
        /// The node.
        node: usize,
        /// The grids its inputs are in, each holding at least the window grown by the halo.
        inputs: Vec<Option<usize>>,
        /// The samples made.
        window: Window,
        /// Samples its inputs are read beyond them.
        halo: usize,
        /// The grids its layers go to; none for a layer that nobody reads.
        out: Vec<Option<usize>>,
    },
}

/// A grid of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GridSlot {
    /// Its samples.
    pub window: Window,
    /// The node it holds.
    pub node: usize,
    /// The last step that reads it; the number of steps if it is an output.
    pub last_use: usize,
}

impl Step {
    /// The grids it reads.
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

    /// The grids it makes.
    pub fn writes(&self) -> Vec<usize> {
        match self {
            Step::Fill { out, .. } => out.clone(),
            Step::Apply { out, .. } => out.iter().flatten().copied().collect(),
        }
    }

    /// The samples it makes.
    pub fn window(&self) -> &Window {
        match self {
            Step::Fill { window, .. } | Step::Apply { window, .. } => window,
        }
    }
}

impl Plan {
    /// The samples that are made.
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// The solvers that must be solved first, in order.
    pub fn solves(&self) -> &[Solve] {
        &self.solves
    }

    /// What is then done, in order.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Solves on disk, and makes solvers' sources in tiles of `side` samples, as the planner does where memory is short.
    pub fn solve_on_disk(&mut self, side: usize) {
        for solve in &mut self.solves {
            (solve.on_disk, solve.side) = (true, side);
        }
    }

    /// Whether the same program answers for every point: no step depends on where the points lie.
    pub fn is_pointwise(&self) -> bool {
        self.scattered && self.steps.len() == 1 && self.grids.is_empty()
    }

    /// The program that a scattered plan asks at points, after all else is made.
    pub fn asked(&self) -> Option<&Program> {
        match self.steps.last() {
            Some(Step::Fill { program, out, .. }) if self.scattered && out.is_empty() => Some(program),
            _ => None,
        }
    }

    /// The solvers that its steps read.
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

    /// Samples that will be made, solvers' sources not counted.
    pub fn samples(&self) -> u64 {
        self.steps.iter().fold(0u64, |sum, step| sum.saturating_add(step.window().len() as u64))
    }
}

/// What is written of a plan.
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

/// SHA-256 of a plan's debug text, which tells every bit but those of NaNs apart.
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

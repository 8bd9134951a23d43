//! A plan as it is stored: with the library's version and a checksum.

use super::key::Key;
use super::steps::{GridSlot, Plan, Solve, Step};
use crate::grid::Window;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::{self, Write};

/// What is written of a plan.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct StoredPlan {
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

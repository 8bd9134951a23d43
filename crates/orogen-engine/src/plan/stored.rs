//! The stored form of a plan.

use super::key::Key;
use super::steps::{GridSlot, Plan, Solve, Step};
use orogen_grid::grid::Window;
use orogen_ops::ids::{GridId, IndexVec, StepId};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use sha2::{Digest, Sha256};
use std::fmt::{self, Write};

/// The format of stored plans. It is increased when the meaning of a plan changes.
const FORMAT: u32 = 4;

fn first_format() -> u32 {
    1
}

/// The serialized form of a plan.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct StoredPlan {
    orogen: String,
    /// Plans from before this field was added have format 1.
    #[serde(default = "first_format")]
    format: u32,
    checksum: Key,
    recipe: Key,
    window: Window,
    scattered: bool,
    solves: Vec<Solve>,
    steps: IndexVec<StepId, Step>,
    grids: IndexVec<GridId, GridSlot>,
    outputs: Vec<GridId>,
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

impl Serialize for Plan {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        StoredPlan::from(self.clone()).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Plan {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Plan, D::Error> {
        Plan::try_from(StoredPlan::deserialize(deserializer)?).map_err(de::Error::custom)
    }
}

impl From<Plan> for StoredPlan {
    fn from(plan: Plan) -> StoredPlan {
        let checksum = checksum(&plan);
        let Plan { recipe, window, scattered, solves, steps, grids, outputs } = plan;
        let orogen = env!("CARGO_PKG_VERSION").to_string();
        StoredPlan { orogen, format: FORMAT, checksum, recipe, window, scattered, solves, steps, grids, outputs }
    }
}

impl TryFrom<StoredPlan> for Plan {
    type Error = String;

    fn try_from(stored: StoredPlan) -> Result<Plan, String> {
        let StoredPlan { orogen, format, checksum: expected, recipe, window, scattered, solves, steps, grids, outputs } =
            stored;
        let own = env!("CARGO_PKG_VERSION");
        if orogen != own {
            return Err(format!("the plan was made by Orogen {orogen}, this is {own}: make the plan again"));
        }
        if format != FORMAT {
            return Err(format!(
                "the plan has format {format}, this version reads format {FORMAT}: make the plan again"
            ));
        }
        let plan = Plan { recipe, window, scattered, solves, steps, grids, outputs };
        match checksum(&plan) == expected {
            true => Ok(plan),
            false => Err("the plan is damaged: its checksum does not match; make the plan again".into()),
        }
    }
}

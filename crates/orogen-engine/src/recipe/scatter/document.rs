//! A kind of scattered objects in memory.

use crate::recipe::condition::document::{Condition, rename_layers, rename_mask, write_input, write_toml};
use orogen_ops::declare::Input;
use orogen_ops::value::toml_string;
use std::fmt::Write as _;
use std::ops::Range;

/// Maximum number of kinds of a recipe.
pub const MAX_SCATTERS: usize = 64;

/// Bounds of spacings, in metres.
pub const SPACINGS: [f64; 2] = [0.01, 1e6];

/// Bounds of scale factors.
pub const SIZES: [f64; 2] = [1e-3, 1e3];

/// A kind of objects that stand where its conditions hold, at distances of at least its spacing.
///
/// The objects are points with a size and a turn (see [`World::objects`](crate::world::World::objects)).
#[derive(Debug, Clone, PartialEq)]
pub struct Scatter {
    /// The name of the kind: 1 to 64 letters, digits, `_` and `-`. Several entries may have the same.
    pub name: String,
    /// Smallest distance of two objects of this entry, in metres: 0.01 to 1e6.
    pub spacing: f64,
    /// Number of objects as a share of the greatest possible one, 0 to 1: a node, a layer or a number. It is a factor of
    /// the conditions' share.
    pub density: Input,
    /// Scale factors of the smallest and the largest objects, 0.001 to 1000.
    pub size: [f64; 2],
    /// How objects are turned about the vertical axis.
    pub turn: Turn,
    /// Whether objects stand in water.
    pub water: InWater,
    /// Smallest distance to the objects of the entries before it, in metres.
    pub clearance: f64,
    /// The cell in metres at which conditions are computed; `None` for the world's.
    pub cell: Option<f64>,
    /// Seed, hashed with the world's. Entries with the same seed and spacing have the same candidates.
    pub seed: u64,
    /// Conditions that must all hold; their shares are multiplied.
    pub all: Vec<Condition>,
    /// Alternatives, of which the largest share counts. If empty, only `all` counts.
    pub any: Vec<Vec<Condition>>,
    /// A node, a layer or a number that multiplies the share.
    pub mask: Input,
}

impl Default for Scatter {
    fn default() -> Scatter {
        Scatter {
            name: String::new(),
            spacing: 10.0,
            density: Input::Value(1.0),
            size: [1.0; 2],
            turn: Turn::Random,
            water: InWater::Avoid,
            clearance: 10.0,
            cell: None,
            seed: 0,
            all: Vec::new(),
            any: Vec::new(),
            mask: Input::None,
        }
    }
}

/// The turn of objects about the vertical axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Turn {
    /// A random one for each object.
    Random,
    /// The same for all, in degrees clockwise seen from above: 0 to less than 360.
    Fixed(f64),
}

/// Whether objects stand in the sea and in the recipe's lakes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InWater {
    /// Only on land.
    Avoid,
    /// On land and in water.
    Any,
    /// Only in water.
    Only,
}

impl InWater {
    /// All, with their names in recipes.
    pub const ALL: [(&'static str, InWater); 3] =
        [("avoid", InWater::Avoid), ("any", InWater::Any), ("only", InWater::Only)];

    fn name(self) -> &'static str {
        InWater::ALL.iter().find(|(_, way)| *way == self).map_or("avoid", |(name, _)| name)
    }
}

/// An entry whose density is computed by nodes of the recipe.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpandedScatter {
    /// The layer of its density, 0 to 1.
    pub density: String,
    /// The indices of the nodes that were added for it.
    pub nodes: Range<usize>,
}

impl Scatter {
    /// Renames the nodes and layers that it reads.
    pub(in crate::recipe) fn rename_inputs(&mut self, of: &impl Fn(&str) -> Option<Input>) {
        rename_mask(&mut self.mask, of);
        rename_mask(&mut self.density, of);
        rename_layers(self.all.iter_mut().chain(self.any.iter_mut().flatten()), of);
    }

    /// Appends the entry to a recipe's text.
    pub fn write_toml(&self, text: &mut String) {
        let _ = writeln!(text, "\n[[scatter]]\nname = {}\nspacing = {:?}", toml_string(&self.name), self.spacing);
        write_input(text, "density", &self.density);
        let _ = writeln!(text, "size = {:?}", self.size);
        let _ = match self.turn {
            Turn::Random => writeln!(text, "turn = \"random\""),
            Turn::Fixed(degrees) => writeln!(text, "turn = {degrees:?}"),
        };
        let _ = writeln!(text, "water = \"{}\"\nclearance = {:?}", self.water.name(), self.clearance);
        if let Some(cell) = self.cell {
            let _ = writeln!(text, "cell = {cell:?}");
        }
        let _ = writeln!(text, "seed = {}", self.seed);
        write_toml(text, &self.all, &self.any, &self.mask);
    }
}

//! A kind of scattered objects in memory.

use crate::recipe::condition::part::rename_input;
use orogen_ops::declare::Input;
use std::ops::Range;

/// Maximum number of kinds of a recipe.
pub const MAX_SCATTERS: usize = 64;

/// Bounds of spacings, in metres.
pub const SPACINGS: [f64; 2] = [0.01, 1e6];

/// Bounds of scale factors.
pub const SIZES: [f64; 2] = [1e-3, 1e3];

table! {
    /// A kind of objects that stand where its conditions hold, at distances of at least its spacing.
    ///
    /// The objects are points with a size and a turn (see [`World::objects`](crate::world::World::objects)). Several
    /// entries may have the same name. Entries with the same seed and spacing have the same candidates.
    pub struct Scatter;
    /// Name of the kind of objects.
    name: String = String::new();
    /// Smallest distance of two objects of this entry. Unit: m.
    spacing: f64 = 10.0, range SPACINGS;
    /// Number of objects as a share of the greatest possible one, 0 to 1: a node, a layer or a number. Default: 1.
    density: Input = Input::Value(1.0), range [0.0, 1.0];
    /// Scale factor: one number, or [smallest, largest]. Default: 1.
    size: [f64; 2] = [1.0; 2], range SIZES, pair "[SMALLEST, LARGEST]", single true, ascending true;
    /// Rotation about the vertical axis: `random`, or degrees clockwise seen from above.
    turn: Turn = Turn::Random;
    /// Whether objects are placed in the sea and in the lakes of the output `lakes`.
    water: InWater = InWater::Avoid;
    /// Smallest distance to the objects of the entries before this one. Unit: m. Default: `spacing`.
    clearance: f64 = 10.0, range [0.0, 1e6];
    /// Cell at which conditions are computed. Unit: m. Default: the world's.
    cell: Option<f64> = None, range [1e-4, 1e7];
    /// Hashed with the world's seed. Default: the number of the entry, from 0.
    seed: u64 = 0;
    conditions and mask "A node, a layer or a number that multiplies the density.";
}

/// The rotation of objects about the vertical axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Turn {
    /// A random angle for each object.
    Random,
    /// The same angle for all objects, in degrees clockwise seen from above: 0 to less than 360.
    Fixed(f64),
}

/// Whether objects are placed in the sea and in the recipe's lakes.
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
    /// All values, with their names in recipes.
    pub const ALL: [(&'static str, InWater); 3] =
        [("avoid", InWater::Avoid), ("any", InWater::Any), ("only", InWater::Only)];
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
        rename_input(&mut self.density, of);
        self.conditions().rename_inputs(of);
    }
}

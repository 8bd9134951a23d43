//! A terrain class in memory.

use crate::recipe::condition::part::rename_layer;
use crate::recipe::outputs::HEIGHT;
use orogen_io::palette::color::{Rgb, rgb};
use orogen_ops::declare::Input;
use std::ops::Range;

/// Maximum number of classes of a recipe.
pub const MAX_CLASSES: usize = 255;

/// Default colors of classes, by name.
const COLORS: [(&str, u32); 14] = [
    ("water", 0x3f_74a8),
    ("sea", 0x2f_5f96),
    ("river", 0x4f_86b8),
    ("lake", 0x4f_86b8),
    ("sand", 0xdc_c88f),
    ("beach", 0xdc_c88f),
    ("desert", 0xd9_b573),
    ("grass", 0x7f_ad55),
    ("meadow", 0x8f_b95f),
    ("forest", 0x3f_7342),
    ("wood", 0x3f_7342),
    ("swamp", 0x5f_7150),
    ("rock", 0x86_807a),
    ("snow", 0xf1_f5f8),
];

/// Default colors of classes with other names, used in turn.
const OTHERS: [u32; 8] = [0xb0_6a55, 0xc9_a04c, 0x86_9c4e, 0x4f_9a86, 0x59_7fb5, 0x8a_6fae, 0xb7_6c96, 0x9a_8468];

table! {
    /// A terrain class, which takes the cells where its conditions hold: where the product of their shares is at least
    /// one half.
    ///
    /// Classes are in the order of the recipe: the first one is everywhere, and each covers those before it. No two
    /// have the same name.
    pub struct TerrainClass;
    /// Name of the class. `orogen tilemap` draws it with the tileset's terrain of this name.
    name: String = String::new();
    /// A color: #rrggbb, #rgb or a name. Default: one by the name or the number of the class.
    color: Option<Rgb> = None;
    conditions and mask "A node, a layer or a number that multiplies the share.";
    /// An exact share of all cells of a bounded world, selected among the cells where the conditions hold.
    share: Option<Share> = None;
}

/// An exact share of all cells of a bounded world.
#[derive(Debug, Clone, PartialEq)]
pub struct Share {
    /// The quantity by which cells are ordered: `height`, or a node or layer.
    pub of: String,
    /// Which end of that order is selected.
    pub end: End,
    /// The share of all cells, 0 to 1.
    pub part: f64,
}

/// An end of an order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The lowest values.
    Lowest,
    /// The highest values.
    Highest,
}

impl End {
    /// Both ends, with their keys in recipes.
    pub const ALL: [(&'static str, End); 2] = [("lowest", End::Lowest), ("highest", End::Highest)];
}

/// A class whose nodes were added to the recipe.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpandedClass {
    /// The indices of the nodes that were added for it.
    pub nodes: Range<usize>,
}

impl TerrainClass {
    /// The color of the class with this number: its own, one by its name, or one by its number.
    #[must_use]
    pub fn color(&self, number: usize) -> Rgb {
        let named = COLORS.iter().find(|(name, _)| *name == self.name);
        self.color.unwrap_or_else(|| rgb(named.map_or(OTHERS[number % OTHERS.len()], |(_, color)| *color)))
    }

    /// Renames the nodes and layers that it reads.
    pub(in crate::recipe) fn rename_inputs(&mut self, of: &impl Fn(&str) -> Option<Input>) {
        self.conditions().rename_inputs(of);
        // The heights are no node.
        if let Some(share) = self.share.as_mut().filter(|share| share.of != HEIGHT) {
            rename_layer(&mut share.of, of);
        }
    }
}

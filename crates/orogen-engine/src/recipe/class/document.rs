//! A terrain class in memory.

use crate::recipe::condition::document::{Condition, rename_layers, rename_mask, write_toml};
use orogen_io::palette::color::{Rgb, hex, rgb};
use orogen_ops::declare::Input;
use orogen_ops::value::toml_string;
use std::fmt::Write as _;
use std::ops::Range;

/// The output with the number of each sample's class, from 0.
pub const CLASS: &str = "class";

/// The name of the heights in a [`Share`]: that of the output.
pub const HEIGHT: &str = "height";

/// Maximum number of classes of a recipe.
pub const MAX_CLASSES: usize = 255;

/// Colors of classes without one, by their names.
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

/// Colors of classes without one that have other names, one after the other.
const OTHERS: [u32; 8] = [0xb0_6a55, 0xc9_a04c, 0x86_9c4e, 0x4f_9a86, 0x59_7fb5, 0x8a_6fae, 0xb7_6c96, 0x9a_8468];

/// A terrain class, which takes the cells where its conditions hold.
///
/// Classes are in the order of the recipe: the first one is everywhere, and each covers those before it.
#[derive(Debug, Clone, PartialEq)]
pub struct TerrainClass {
    /// The name: 1 to 64 letters, digits, `_` and `-`. No two classes of a recipe have the same.
    pub name: String,
    /// The color in maps and legends; `None` for one by its name or number.
    pub color: Option<Rgb>,
    /// Conditions that must all hold; their shares are multiplied. The class is where the product is at least one half.
    pub all: Vec<Condition>,
    /// Alternatives, of which the largest share counts. If empty, only `all` counts.
    pub any: Vec<Vec<Condition>>,
    /// A node, a layer or a number that multiplies the share.
    pub mask: Input,
    /// An exact number of cells, selected among those where the conditions hold.
    pub share: Option<Share>,
}

/// An exact share of all cells of a bounded world.
#[derive(Debug, Clone, PartialEq)]
pub struct Share {
    /// What cells are ordered by: `height`, or a node or layer.
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
    /// Both, with their keys in recipes.
    pub const ALL: [(&'static str, End); 2] = [("lowest", End::Lowest), ("highest", End::Highest)];
}

impl Default for TerrainClass {
    fn default() -> TerrainClass {
        TerrainClass {
            name: String::new(),
            color: None,
            all: Vec::new(),
            any: Vec::new(),
            mask: Input::None,
            share: None,
        }
    }
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
        rename_mask(&mut self.mask, of);
        rename_layers(self.all.iter_mut().chain(self.any.iter_mut().flatten()), of);
        // The heights are no node.
        if let Some(share) = self.share.as_mut().filter(|share| share.of != HEIGHT)
            && let Some(Input::Node(name)) = of(&share.of)
        {
            share.of = name;
        }
    }

    /// Appends the class to a recipe's text.
    pub fn write_toml(&self, text: &mut String) {
        let _ = writeln!(text, "\n[[class]]\nname = {}", toml_string(&self.name));
        if let Some(color) = self.color {
            let _ = writeln!(text, "color = \"{}\"", hex(color));
        }
        write_toml(text, &self.all, &self.any, &self.mask);
        if let Some(Share { of, end, part }) = &self.share {
            let end = End::ALL.iter().find(|(_, other)| other == end).map_or("", |(name, _)| *name);
            let _ = writeln!(text, "share = {{ of = {}, {end} = {part:?} }}", toml_string(of));
        }
    }
}

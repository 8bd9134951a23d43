//! A surface in memory.

pub use super::coloring::{Along, Coloring, DEFAULT_GRAIN, MAX_COLORS, RAMP};
use super::coloring::{Colored, Colors};
pub use crate::recipe::condition::document::{Condition, Noise, Quantity};
use crate::recipe::condition::part::rename_layer;
use orogen_io::dem::file_ref::FileRef;
use orogen_io::palette::color::Light;
use orogen_ops::declare::Input;

/// Maximum number of surfaces of a recipe.
pub const MAX_SURFACES: usize = 64;

/// Default roughness, as of soil and plants.
pub const DEFAULT_ROUGHNESS: f64 = 0.9;

table! {
    /// A surface: a material that covers the ground where its conditions hold.
    ///
    /// Surfaces are layered in the order of the recipe. Each covers those below it by its share, 0 to 1; the first one
    /// is everywhere. The weights of all surfaces therefore add up to 1.
    pub struct Surface;
    /// Name of the surface and of its weight map. Surfaces with the same name share a weight map.
    name: String = String::new();
    /// The color.
    color: Coloring = Coloring::Plain([128; 3]), part Colors;
    /// 0 is a mirror, 1 is matt.
    roughness: f64 = DEFAULT_ROUGHNESS, range [0.0, 1.0], stated DEFAULT_ROUGHNESS;
    /// Maximum share of the surface.
    opacity: f64 = 1.0, range [0.0, 1.0], stated 1.0, omitted 1.0;
    conditions and mask "A node, a layer or a number that multiplies the share.";
}

/// A surface whose share is computed by nodes of the recipe.
#[derive(Debug, Clone, PartialEq)]
pub struct Expanded {
    /// The surface.
    pub surface: Surface,
    /// The layer of its share, 0 to 1; `None` for the first surface, which is everywhere.
    pub share: Option<String>,
    /// The layer of its position in the gradient, 0 to 1.
    pub position: Option<String>,
    /// The indices of the nodes that were added for it.
    pub nodes: std::ops::Range<usize>,
    /// Its colors in linear light, from the first of the gradient to the last; empty until its picture is read.
    pub colors: Vec<Light>,
}

impl Colored for Surface {
    fn coloring(&mut self) -> &mut Coloring {
        &mut self.color
    }
}

impl Surface {
    /// The picture of its colors.
    #[must_use]
    pub fn picture(&self) -> Option<&FileRef> {
        match &self.color {
            Coloring::Picture(file, _) => Some(file),
            _ => None,
        }
    }

    /// Renames the nodes and layers that it reads.
    pub(in crate::recipe) fn rename_inputs(&mut self, of: &impl Fn(&str) -> Option<Input>) {
        self.conditions().rename_inputs(of);
        if let Coloring::Gradient(_, Along::Layer(layer, _)) | Coloring::Picture(_, Along::Layer(layer, _)) =
            &mut self.color
        {
            rename_layer(layer, of);
        }
    }

    /// The picture of its colors, mutable.
    pub fn picture_mut(&mut self) -> Option<&mut FileRef> {
        match &mut self.color {
            Coloring::Picture(file, _) => Some(file),
            _ => None,
        }
    }
}

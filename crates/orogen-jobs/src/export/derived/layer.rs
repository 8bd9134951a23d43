//! Definition of derived layers.

use super::appended::Appended;
use crate::options::{OptionSpec, Options};
use orogen_engine::declare::Input;
use orogen_engine::lower::Passes;
use orogen_engine::recipe::document::Recipe;
use orogen_grid::analysis::slope::beyond;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

/// The meaning of a layer's channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nature {
    /// Plain numbers.
    Numbers,
    /// A unit vector: east, north and up, each -1 to 1.
    Normal,
    /// Weights: each 0 to 1, with the sum 1.
    Weights,
    /// A color in linear light: red, green and blue, 0 to 1.
    Color,
}

/// A layer derived from the heights.
pub struct Derived {
    /// The name for `--layer`.
    pub name: &'static str,
    /// A one-line description.
    pub about: &'static str,
    /// The palette for maps of it; empty if a map makes no sense.
    pub palette: &'static str,
    /// The options of the layer.
    pub options: &'static [OptionSpec],
    /// How it is computed.
    pub made: Made,
}

impl Derived {
    /// The row layer, if it is computed from rows.
    #[must_use]
    pub fn rows(&self) -> Option<&RowLayer> {
        match &self.made {
            Made::Rows(rows) => Some(rows),
            Made::Nodes(_) => None,
        }
    }
}

/// How a derived layer is computed.
pub enum Made {
    /// In bands of rows, from the heights around each sample.
    Rows(RowLayer),
    /// By nodes that are appended to the recipe before its world is opened.
    Nodes(NodeLayer),
}

/// A layer computed by nodes.
pub struct NodeLayer {
    /// Whether one of them is a solver, which needs a bounded world.
    pub bounded: bool,
    /// Whether a world with [its own network](orogen_engine::recipe::network::OwnNetwork) needs no solver for it.
    pub network: bool,
    /// Appends the nodes, and returns the input that the layer reads.
    ///
    /// Fails if an option is missing or invalid.
    pub append: fn(&mut Appended) -> Result<Input>,
}

/// A layer computed from rows of heights.
pub struct RowLayer {
    /// Unit of a sample, or empty.
    pub unit: &'static str,
    /// The meaning of its channels.
    pub nature: Nature,
    /// The names of the channels, for a [prepared](super::list::prepare) recipe.
    pub channels: fn(&Recipe) -> Vec<String>,
    /// Adds the nodes to a recipe that compute the further inputs of the layer.
    pub prepare: fn(&mut Recipe),
    /// The layers of a prepared recipe that it reads beside the heights.
    pub layers: fn(&Recipe) -> Vec<String>,
    /// The halo in samples, for a cell in metres.
    pub reach: fn(f64) -> usize,
    /// Computes the samples of a window: one grid per channel.
    pub make: fn(&Around, &Window) -> Vec<Grid>,
    /// How a graphics card does, if it can.
    pub lowered: Option<LoweredRows>,
}

/// How a graphics card computes a row layer in place of [`RowLayer::make`].
pub struct LoweredRows {
    /// The passes for a cell in metres and the options of the layer. They read the heights as plane 0, and write the
    /// channels as the next planes.
    pub passes: fn(f64, &Options) -> Passes,
    /// The heights over a window grown by the reach of the layer.
    pub heights: fn(&Around, &Window) -> Grid,
}

/// The ground around the samples to compute.
pub struct Around<'a> {
    /// Heights in metres: of the window and its halo, as far as the world extends.
    pub heights: &'a Grid,
    /// The other layers that it reads, over the same window.
    pub layers: &'a [Grid],
    /// The recipe.
    pub recipe: &'a Recipe,
    /// The options of the layer.
    pub options: &'a Options,
}

/// The `prepare` of a layer that reads only the heights.
pub fn nothing(_: &mut Recipe) {}

/// The `layers` of a layer that reads only the heights.
#[must_use]
pub fn none(_: &Recipe) -> Vec<String> {
    Vec::new()
}

impl Around<'_> {
    /// The heights of a window extended by one sample on each side, with linear extrapolation beyond the edges of the
    /// world.
    #[must_use]
    pub fn bordered(&self, window: &Window) -> Grid {
        let wide = window.grown(1);
        let there = self.heights.window();
        let left = wide.x.max(there.x);
        let (columns, rows) =
            (left..wide.right().min(there.right()), wide.y.max(there.y)..wide.bottom().min(there.bottom()));
        let mut out = Grid::filled(wide, f32::NAN);
        let across = (columns.end - columns.start) as usize;
        let (inside, from) = ((left - wide.x) as usize, (left - there.x) as usize);
        for y in rows.clone() {
            let source = self.heights.row((y - there.y) as usize);
            let row = out.row_mut((y - wide.y) as usize);
            row[inside..inside + across].copy_from_slice(&source[from..from + across]);
            // At most one sample is missing at each end.
            if inside > 0 {
                row[0] = beyond(row[1], row[2.min(across)]);
            }
            let last = inside + across;
            if last < row.len() {
                row[last] = beyond(row[last - 1], row[last.saturating_sub(2).max(inside)]);
            }
        }
        let (top, bottom) = ((rows.start - wide.y) as usize, (rows.end - 1 - wide.y) as usize);
        for (to, last, before) in
            [(0, top, (top + 1).min(bottom)), (wide.height - 1, bottom, bottom.saturating_sub(1).max(top))]
        {
            if to == last {
                continue;
            }
            for i in 0..wide.width {
                out.row_mut(to)[i] = beyond(out[(i, last)], out[(i, before)]);
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_engine::recipe::document::WorldSpec;
    use orogen_grid::analysis::slope::extended;

    #[test]
    fn at_the_ends_of_a_world_it_is_the_extended_grid() {
        for (width, height) in [(7, 5), (1, 1), (2, 1), (1, 3), (2, 2)] {
            let window = Window::new(width, height, 5.0);
            let data = (0..width * height).map(|k| (k * k % 23) as f32).collect();
            let ground = Grid::from_data(window, data).unwrap();
            let (recipe, options) = (Recipe::new(WorldSpec::default()), Options::default());
            let around = Around { heights: &ground, layers: &[], recipe: &recipe, options: &options };
            let whole = around.bordered(&window);
            assert_eq!(whole, extended(&ground), "{width} x {height}");
            for part in window.tiles(2) {
                assert_eq!(Some(around.bordered(&part)), whole.crop(&part.grown(1)), "{part:?}");
            }
        }
    }
}

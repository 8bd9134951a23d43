//! The nodes of one level over a window.

use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::hydrology::direction::NONE;

/// Added to the code of the receiver's direction for a node in a lake with an outlet.
pub const LAKE: u8 = 16;

/// The first code after the codes of lakes with an outlet.
const LAKES_END: u8 = LAKE + NONE;

/// The code of the receiver's direction, also in lakes with an outlet; [`NONE`] for other water.
#[must_use]
pub fn direction(receiver: u8) -> u8 {
    match receiver {
        0..NONE => receiver,
        LAKE..LAKES_END => receiver - LAKE,
        _ => NONE,
    }
}

/// The nodes of one level over a window, one node per sample of the lattice.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// The number of halvings of the cell from the coarsest level, which has depth 0.
    pub depth: usize,
    /// The window, in samples of this level.
    pub window: Window,
    /// Position of the node in its cell, from 0 in the west to 1 in the east.
    pub east: Vec<f32>,
    /// Position of the node in its cell, from 0 in the north to 1 in the south.
    pub south: Vec<f32>,
    /// Height in metres; for water, the height of its surface. The sea is at 0.
    pub height: Vec<f32>,
    /// Drainage area, in cells of this level, weighted by the rain if rain is given.
    pub area: Vec<f32>,
    /// Code of the direction to the receiver (see [`crate::hydrology::direction`]); [`NONE`] for the sea and for lakes
    /// without an outlet. Nodes of lakes with an outlet have [`LAKE`] added.
    pub receiver: Vec<u8>,
    /// Local part of the logarithm of uplift over erodibility; on detail levels the whole logarithm.
    pub variation: Vec<f32>,
    /// Regional part of the logarithm of uplift over erodibility; on detail levels the logarithm of the stable slope.
    pub uplift: Vec<f32>,
    /// Approximate distance to the shore in kilometres, positive on land.
    pub shore: Vec<f32>,
}

impl Level {
    /// Number of planes.
    pub const PLANES: usize = Level::PLANE_NAMES.len();

    /// Names of the planes in shaders, in the order of the fields.
    pub const PLANE_NAMES: [&str; 8] = ["EAST", "SOUTH", "HEIGHT", "AREA", "RECEIVER", "VARIATION", "UPLIFT", "SHORE"];

    /// Each plane as a grid over the window, in the order of the fields.
    #[must_use]
    pub fn into_planes(self) -> Vec<Grid> {
        let receiver = self.receiver.into_iter().map(f32::from).collect();
        let planes = [self.east, self.south, self.height, self.area, receiver, self.variation, self.uplift, self.shore];
        let no_data = || Grid::filled(self.window, f32::NAN);
        planes.into_iter().map(|plane| Grid::from_data(self.window, plane).unwrap_or_else(no_data)).collect()
    }

    /// The level with these planes. The inverse of [`Level::into_planes`].
    ///
    /// # Errors
    /// If the number of planes is wrong, their windows differ, or a receiver is not a code of a direction.
    pub fn from_planes(depth: usize, planes: &[&Grid]) -> Result<Level> {
        let &[east, south, height, area, receiver, variation, uplift, shore] = planes else {
            return Err(invalid(format!("a level has {} planes, not {}", Level::PLANES, planes.len())));
        };
        let window = *east.window();
        if planes.iter().any(|plane| *plane.window() != window) {
            return Err(invalid("the planes of a level must have the same window"));
        }
        let code = |value: &f32| match *value {
            value if value.floor() == value && is_code(value) => Ok(value as u8),
            value => Err(invalid(format!("{value} is not a receiver"))),
        };
        let receiver = receiver.data().iter().map(code).collect::<Result<_>>()?;
        let [east, south, height, area] = [east, south, height, area].map(|plane| plane.data().to_vec());
        let [variation, uplift, shore] = [variation, uplift, shore].map(|plane| plane.data().to_vec());
        Ok(Level { depth, window, east, south, height, area, receiver, variation, uplift, shore })
    }

    /// Column and row of the cell of a node.
    pub(super) fn place(&self, q: usize) -> (i64, i64) {
        (self.window.x + (q % self.window.width) as i64, self.window.y + (q / self.window.width) as i64)
    }

    /// Index of the first node of row `j` of a window inside the level's window.
    pub(super) fn row(&self, window: &Window, j: usize) -> usize {
        ((window.y - self.window.y) as usize + j) * self.window.width + (window.x - self.window.x) as usize
    }

    /// Indices of the nodes that are not among the `edge` outermost ones, row by row.
    pub(super) fn inner(&self, edge: usize) -> impl DoubleEndedIterator<Item = usize> + use<> {
        let Window { width, height, .. } = self.window;
        let rows = edge..height.saturating_sub(edge);
        rows.flat_map(move |j| j * width + edge..((j + 1) * width).saturating_sub(edge))
    }

    /// Returns an error if the level does not cover the given nodes and `reach` nodes around them.
    pub(super) fn check_covers(&self, what: &str, nodes: &Window, reach: usize) -> Result<()> {
        let needed = nodes.grown(reach);
        if self.window.contains(&needed) {
            return Ok(());
        }
        Err(invalid(format!("{what} over {nodes:?} needs its level over {needed:?}")))
    }

    /// Whether a node is in an inland lake: water without an outlet above the sea.
    #[inline(always)]
    pub(super) fn is_inland(&self, q: usize) -> bool {
        self.receiver[q] == NONE && self.height[q] > 0.0
    }

    /// The nodes of `window`, which must lie within the level's window.
    ///
    /// # Errors
    /// If the window is not a part of the level's.
    pub fn crop(&self, window: &Window) -> Result<Level> {
        if !self.window.contains(window) {
            return Err(invalid(format!("a level over {:?} does not contain {window:?}", self.window)));
        }
        let part = |plane: &[f32]| cropped(plane, &self.window, window);
        Ok(Level {
            depth: self.depth,
            window: *window,
            east: part(&self.east),
            south: part(&self.south),
            height: part(&self.height),
            area: part(&self.area),
            receiver: cropped(&self.receiver, &self.window, window),
            variation: part(&self.variation),
            uplift: part(&self.uplift),
            shore: part(&self.shore),
        })
    }
}

/// Whether a number is a valid receiver code.
fn is_code(value: f32) -> bool {
    let lake = f32::from(LAKE);
    (0.0..=f32::from(NONE)).contains(&value) || (lake..lake + f32::from(NONE)).contains(&value)
}

/// The part over `window` of a plane over `from`, which must contain it.
pub(super) fn cropped<T: Copy>(plane: &[T], from: &Window, window: &Window) -> Vec<T> {
    let (left, top) = ((window.x - from.x) as usize, (window.y - from.y) as usize);
    let mut part = Vec::with_capacity(window.len());
    for row in plane.chunks(from.width.max(1)).skip(top).take(window.height) {
        part.extend_from_slice(&row[left..left + window.width]);
    }
    part
}

/// The error of a request that does not fit a level.
pub(super) fn invalid(message: impl Into<String>) -> Error {
    Error::new(ErrorKind::Request, message)
}

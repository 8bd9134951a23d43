//! A picture of a part of a world.

use std::sync::Arc;

use orogen::budget::Reservation;
use orogen::layer::LayerKind;
use orogen::{Grid, Window};

use super::contours::Contours;
use super::legend::Legend;
use super::statistics::Statistics;

/// What tells pictures apart: the request, the samples along the width, and the time.
pub type Key = (u64, usize, u64);

/// Memory of a sample in bytes.
const BYTES: u64 = 32;

/// How good a picture is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quality {
    /// Of a draft of the recipe: the land differs in detail.
    Draft,
    /// Exact samples, and finer pictures follow.
    Coarse,
    /// The finest that was asked for.
    Fine,
}

/// A picture of a part of a world.
#[derive(Debug, Clone)]
pub struct Frame {
    /// The number of the request.
    pub request: u64,
    /// How good it is.
    pub quality: Quality,
    /// The heights of the surface, in metres.
    pub heights: Arc<Grid>,
    /// The layer that is colored, unless it is the surface.
    pub values: Option<Arc<Grid>>,
    /// What kind of quantity the colored layer is.
    pub kind: LayerKind,
    /// The unit of the colored layer, or empty.
    pub unit: &'static str,
    /// Colors without light: red, green, blue and 255 for each sample, sRGB.
    pub albedo: Vec<u8>,
    /// What the colors mean.
    pub legend: Legend,
    /// Colors with relief shading, as maps have them.
    pub shaded: Vec<u8>,
    /// Contour lines of the heights, if they are wanted.
    pub contours: Option<Arc<Contours>>,
    /// How much of the sun each sample sees, 0 to 255: two bytes for each sample, of the ground and of the surface of
    /// land and sea.
    pub light: Vec<u8>,
    /// The height of the sea.
    pub sea_level: f64,
    /// Figures of the colored layer.
    pub statistics: Statistics,
    /// The seconds since the request.
    pub seconds: f64,
    /// Its memory, which counts in the session's budget.
    pub memory: Arc<Reservation>,
}

impl Frame {
    /// Memory of a picture of a window while it is made, in bytes: heights, values, colors with and without light, the
    /// light, and what makes them.
    #[must_use]
    pub fn memory(window: &Window) -> u64 {
        (window.width as u64).saturating_mul(window.height as u64).saturating_mul(BYTES)
    }

    /// What tells it apart from others.
    #[must_use]
    pub fn key(&self) -> Key {
        (self.request, self.window().width, self.seconds.to_bits())
    }

    /// Its window.
    #[must_use]
    pub fn window(&self) -> &Window {
        self.heights.window()
    }

    /// The layer that is colored.
    #[must_use]
    pub fn shown(&self) -> &Grid {
        self.values.as_deref().unwrap_or(&self.heights)
    }

    /// The value of the colored layer and the height at a position in metres; `None` outside.
    #[must_use]
    pub fn at(&self, [east, south]: [f64; 2]) -> Option<[f32; 2]> {
        let window = self.window();
        let place = |metres: f64, first: i64, count: usize| {
            let at = (metres / window.cell).round() as i64 - first;
            (0..count as i64).contains(&at).then_some(at as usize)
        };
        let (i, j) = (place(east, window.x, window.width)?, place(south, window.y, window.height)?);
        Some([self.shown().get(i, j)?, self.heights.get(i, j)?])
    }
}

//! A picture of a part of a world.

use std::sync::Arc;

use orogen::budget::Reservation;
use orogen::layer::LayerKind;
use orogen::{Grid, Window};
use serde::{Deserialize, Serialize};

use super::colors::Colors;
use super::contours::Contours;
use super::legend::Legend;
use super::rivers::Rivers;
use super::statistics::Statistics;
use crate::platform::wire;

/// The identity of a picture: the request, the number of samples along the width, and the time.
pub type Key = (u64, usize, u64);

/// The unit of a layer, or empty.
pub type Unit = &'static str;

/// Memory per sample in bytes.
const BYTES: u64 = 32;

/// The quality of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quality {
    /// Made from a draft of the recipe; the land differs in detail.
    Draft,
    /// Exact samples; finer pictures will follow.
    Coarse,
    /// The finest requested picture.
    Fine,
}

/// A picture of a part of a world.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Frame {
    /// The number of the request.
    pub request: u64,
    /// The quality.
    pub quality: Quality,
    /// The heights of the surface, in metres.
    #[serde(with = "wire::shared")]
    pub heights: Arc<Grid>,
    /// The lowest and the highest height, in metres; 0 if no sample has a height.
    pub levels: [f32; 2],
    /// The colored layer, unless it is the surface.
    #[serde(with = "wire::shared_option")]
    pub values: Option<Arc<Grid>>,
    /// The kind of quantity of the colored layer.
    pub kind: LayerKind,
    /// The unit of the colored layer, or empty.
    #[serde(with = "wire::word")]
    pub unit: Unit,
    /// How values are converted to colors; `None` if the colors show the cover of the ground.
    pub colors: Option<Colors>,
    /// Colors without light: red, green, blue and 255 for each sample, sRGB.
    #[serde(with = "wire::bytes")]
    pub albedo: Vec<u8>,
    /// The legend of the colors.
    pub legend: Legend,
    /// Colors with relief shading, like on maps.
    #[serde(with = "wire::bytes")]
    pub shaded: Vec<u8>,
    /// The rivers and lakes that are painted on it, if requested.
    #[serde(with = "wire::shared_option")]
    pub rivers: Option<Arc<Rivers>>,
    /// Contour lines of the heights, if requested.
    #[serde(with = "wire::shared_option")]
    pub contours: Option<Arc<Contours>>,
    /// How much of the sun each sample sees, 0 to 255. Two bytes per sample: for the ground, and for the surface of
    /// land and sea.
    #[serde(with = "wire::bytes")]
    pub light: Vec<u8>,
    /// The sea level in metres.
    pub sea_level: f64,
    /// Statistics of the colored layer.
    pub statistics: Statistics,
    /// Seconds since the request.
    pub seconds: f64,
    /// The memory of the picture, which counts towards the budget of the session that made it.
    #[serde(skip)]
    pub memory: Option<Arc<Reservation>>,
}

impl Frame {
    /// Memory of a picture of a window while it is made, in bytes: heights, values, colors with and without light, the
    /// light, and intermediate data.
    #[must_use]
    pub fn memory(window: &Window) -> u64 {
        (window.width as u64).saturating_mul(window.height as u64).saturating_mul(BYTES)
    }

    /// The identity of the picture.
    #[must_use]
    pub fn key(&self) -> Key {
        (self.request, self.window().width, self.seconds.to_bits())
    }

    /// The lowest and the highest height in metres.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        self.levels.map(f64::from)
    }

    /// The window.
    #[must_use]
    pub fn window(&self) -> &Window {
        self.heights.window()
    }

    /// The colored layer.
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

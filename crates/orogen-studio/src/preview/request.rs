//! A request for pictures.

use std::sync::Arc;

use orogen::recipe::Recipe;
use orogen::world::HEIGHT;
use serde::{Deserialize, Serialize};

use super::coloring::Coloring;
use super::frame::Frame;
use super::region::Region;
use crate::platform::wire;

/// A request for pictures.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Request {
    /// The recipe.
    #[serde(with = "wire::recipe")]
    pub recipe: Recipe,
    /// The layer that is colored: an output, `node`, `node.layer`, or a layer derived from the heights.
    pub layer: String,
    /// The layer with the heights of the surface.
    pub surface: String,
    /// The part of the world.
    pub region: Region,
    /// What the colors show.
    pub coloring: Coloring,
    /// Direction to the sun: azimuth clockwise from north and altitude, in degrees.
    pub sun: [f64; 2],
    /// Number of samples along the longer side of the finest picture.
    pub finest: usize,
    /// The interval of contours in metres; 0 chooses a round one that suits the land. Without contours if `None`.
    pub contours: Option<f64>,
    /// Whether rivers and lakes are painted.
    pub rivers: bool,
    /// The finest picture of the same land with other colors or light; its samples are reused.
    #[serde(with = "wire::shared_option")]
    pub land: Option<Arc<Frame>>,
}

impl Request {
    /// A request for the heights of a recipe with the default colors and light.
    #[must_use]
    pub fn new(recipe: Recipe) -> Request {
        let region = Region::of(recipe.world.size, recipe.world.cell);
        Request {
            recipe,
            layer: HEIGHT.into(),
            surface: HEIGHT.into(),
            region,
            coloring: Coloring::Own,
            sun: [315.0, 40.0],
            finest: 1024,
            contours: None,
            rivers: false,
            land: None,
        }
    }
}

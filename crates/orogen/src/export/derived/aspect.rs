//! Which way the ground faces.

use super::layer::{Derived, Nature};
use crate::analysis::aspect::aspect;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "aspect",
    about: "direction downhill in degrees clockwise from north; NaN on level ground",
    unit: "deg",
    nature: Nature::Numbers,
    channels: &["aspect"],
    flow: false,
    reach: |_| 1,
    make: |around, window| vec![aspect(&around.bordered(window))],
};

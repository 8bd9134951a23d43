//! Conditions in memory.

/// Maximum number of alternatives in an `any`.
pub const MAX_ALTERNATIVES: usize = 16;

/// A range of a quantity with smooth ends: the share is 1 inside and decreases to 0 outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// The quantity.
    pub of: Quantity,
    /// Lower end; `None` for no bound.
    pub min: Option<f64>,
    /// Upper end; `None` for no bound.
    pub max: Option<f64>,
    /// Widths of the transitions below and above the range, in the quantity's unit (for flow: in powers of ten).
    pub fade: [f64; 2],
}

impl Condition {
    /// A condition on a range of a quantity, with transitions of these widths below and above.
    #[must_use]
    pub fn new(of: Quantity, min: Option<f64>, max: Option<f64>, fade: [f64; 2]) -> Condition {
        Condition { of, min, max, fade }
    }
}

/// The quantity of a condition.
#[derive(Debug, Clone, PartialEq)]
pub enum Quantity {
    /// Height above sea level, in metres.
    Height,
    /// Slope in degrees.
    Slope,
    /// Total curvature in 1/m, positive where the ground is convex, from heights at distances of `scale`.
    Curvature {
        /// Distance of the heights, in metres.
        scale: f64,
    },
    /// Drainage area in m^2.
    Flow,
    /// Fractal noise, -1 to 1.
    Noise(Noise),
    /// A node or layer of the recipe, in its own unit.
    Layer(String),
}

/// The noise of a condition: fBm of Perlin noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Wavelength in metres.
    pub wavelength: f64,
    /// Number of octaves.
    pub octaves: u32,
    /// Seed, hashed with the world's.
    pub seed: u64,
}

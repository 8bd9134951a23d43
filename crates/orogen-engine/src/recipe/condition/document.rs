//! Conditions in memory.

use orogen_ops::value::toml_key;

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

/// Conditions as TOML entries on one line each.
pub(super) fn entries(conditions: &[Condition]) -> Vec<String> {
    let (layers, others): (Vec<&Condition>, Vec<&Condition>) =
        conditions.iter().partition(|condition| matches!(condition.of, Quantity::Layer(_)));
    let mut out: Vec<String> = (others.iter())
        .map(|condition| {
            let (key, more) = match &condition.of {
                Quantity::Height => ("height", String::new()),
                Quantity::Slope => ("slope", String::new()),
                Quantity::Curvature { scale } => ("curvature", format!(", scale = {scale:?}")),
                Quantity::Flow => ("flow", String::new()),
                Quantity::Noise(Noise { wavelength, octaves, seed }) => {
                    ("noise", format!(", wavelength = {wavelength:?}, octaves = {octaves}, seed = {seed}"))
                }
                Quantity::Layer(_) => ("layers", String::new()),
            };
            format!("{key} = {{ {}{more} }}", range(condition))
        })
        .collect();
    if !layers.is_empty() {
        let layers: Vec<String> = (layers.iter())
            .filter_map(|condition| match &condition.of {
                Quantity::Layer(name) => Some(format!("{} = {{ {} }}", toml_key(name), range(condition))),
                _ => None,
            })
            .collect();
        out.push(format!("layers = {{ {} }}", layers.join(", ")));
    }
    out
}

fn range(condition: &Condition) -> String {
    let bounds = [("min", condition.min), ("max", condition.max)];
    let mut parts: Vec<String> =
        bounds.iter().filter_map(|(key, bound)| bound.map(|bound| format!("{key} = {bound:?}"))).collect();
    parts.push(format!("fade = {:?}", condition.fade));
    parts.join(", ")
}

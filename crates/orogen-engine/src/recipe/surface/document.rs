//! A surface in memory.

use crate::declare::Input;
use crate::value::{toml_key, toml_string};
use orogen_io::dem::file_ref::FileRef;
use orogen_io::palette::color::{Light, Rgb, decode, hex, linear, mix, oklab};
use std::fmt::Write as _;

/// Number of colors of a gradient or a picture, including the first and the last.
pub const RAMP: usize = 128;

/// Maximum number of surfaces of a recipe.
pub const MAX_SURFACES: usize = 64;

/// Maximum number of alternatives in a surface's `any`.
pub const MAX_ALTERNATIVES: usize = 16;

/// Maximum number of colors in a gradient.
pub const MAX_COLORS: usize = 256;

/// Default wavelength of the noise along which a gradient runs, in metres.
pub const DEFAULT_GRAIN: f64 = 200.0;

/// Default roughness: that of soil and plants.
pub const DEFAULT_ROUGHNESS: f64 = 0.9;

/// A surface: a material that covers the ground where its conditions hold.
///
/// Surfaces are layered in the order of the recipe. Each covers those below it by its share, 0 to 1; the first one is
/// everywhere. The weights of all surfaces therefore add up to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// The name, which is also the name of its weight map. Surfaces with the same name share a weight map.
    pub name: String,
    /// The color.
    pub color: Coloring,
    /// The roughness as in glTF: 0 is a mirror, 1 is matt.
    pub roughness: f64,
    /// The maximum share, 0 to 1.
    pub opacity: f64,
    /// Conditions that must all hold; their shares are multiplied.
    pub all: Vec<Condition>,
    /// Alternatives, of which the largest share counts. If empty, only `all` counts.
    pub any: Vec<Vec<Condition>>,
    /// A node, a layer or a number that multiplies the share.
    pub mask: Input,
}

impl Default for Surface {
    fn default() -> Surface {
        Surface {
            name: String::new(),
            color: Coloring::Plain([128; 3]),
            roughness: DEFAULT_ROUGHNESS,
            opacity: 1.0,
            all: Vec::new(),
            any: Vec::new(),
            mask: Input::None,
        }
    }
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

/// The coloring of a surface.
#[derive(Debug, Clone, PartialEq)]
pub enum Coloring {
    /// A single color.
    Plain(Rgb),
    /// Colors along a quantity, mixed in Oklab.
    Gradient(Vec<Rgb>, Along),
    /// The colors of a picture along a quantity, each with its frequency in the picture (histogram).
    Picture(FileRef, Along),
}

/// The quantity along which a gradient runs from its first color to its last.
#[derive(Debug, Clone, PartialEq)]
pub enum Along {
    /// Noise with this wavelength in metres; every color covers the same area.
    Noise(f64),
    /// Height above sea level, over this range in metres.
    Height([f64; 2]),
    /// Slope, over this range in degrees.
    Slope([f64; 2]),
    /// A node or layer, over this range of values.
    Layer(String, [f64; 2]),
}

impl Default for Along {
    fn default() -> Along {
        Along::Noise(DEFAULT_GRAIN)
    }
}

impl Coloring {
    /// The colors in linear light, evenly spaced; empty for a picture that was not read yet.
    pub fn ramp(&self) -> Vec<Light> {
        match self {
            Coloring::Plain(color) => vec![color.map(decode)],
            Coloring::Picture(..) => Vec::new(),
            Coloring::Gradient(colors, _) => {
                let stops: Vec<[f32; 3]> = colors.iter().map(|color| oklab(color.map(decode))).collect();
                let last = stops.len().saturating_sub(1);
                let step = |k: usize| {
                    let at = k as f32 / (RAMP - 1) as f32 * last as f32;
                    let from = (at as usize).min(last.saturating_sub(1));
                    mix(stops[from], stops[(from + 1).min(last)], at - from as f32)
                };
                (0..RAMP).map(|k| linear(step(k)).map(|part| part.clamp(0.0, 1.0))).collect()
            }
        }
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
        let renamed = |layer: &mut String| {
            if let Some(Input::Node(name)) = of(layer) {
                *layer = name;
            }
        };
        if let Input::Node(name) = &self.mask
            && let Some(input) = of(name)
        {
            self.mask = input;
        }
        for condition in self.all.iter_mut().chain(self.any.iter_mut().flatten()) {
            if let Quantity::Layer(layer) = &mut condition.of {
                renamed(layer);
            }
        }
        if let Coloring::Gradient(_, Along::Layer(layer, _)) | Coloring::Picture(_, Along::Layer(layer, _)) =
            &mut self.color
        {
            renamed(layer);
        }
    }

    /// The picture of its colors, mutable.
    pub fn picture_mut(&mut self) -> Option<&mut FileRef> {
        match &mut self.color {
            Coloring::Picture(file, _) => Some(file),
            _ => None,
        }
    }

    /// Appends the surface to a recipe's text.
    pub fn write_toml(&self, text: &mut String) {
        let _ = writeln!(text, "\n[[surface]]\nname = {}", toml_string(&self.name));
        let along = match &self.color {
            Coloring::Plain(color) => {
                let _ = writeln!(text, "color = \"{}\"", hex(*color));
                None
            }
            Coloring::Gradient(colors, along) => {
                let colors: Vec<String> = colors.iter().map(|color| format!("\"{}\"", hex(*color))).collect();
                let _ = writeln!(text, "gradient = [{}]", colors.join(", "));
                Some(along)
            }
            Coloring::Picture(file, along) => {
                let _ = writeln!(text, "picture = {}", toml_string(&file.text()));
                Some(along)
            }
        };
        let _ = match along {
            None => Ok(()),
            Some(Along::Noise(grain)) => writeln!(text, "grain = {grain:?}"),
            Some(Along::Height(span)) => writeln!(text, "along = \"height\"\nspan = {span:?}"),
            Some(Along::Slope(span)) => writeln!(text, "along = \"slope\"\nspan = {span:?}"),
            Some(Along::Layer(name, span)) => writeln!(text, "along = {}\nspan = {span:?}", toml_string(name)),
        };
        let _ = writeln!(text, "roughness = {:?}", self.roughness);
        // The first surface has none.
        if self.opacity != 1.0 {
            let _ = writeln!(text, "opacity = {:?}", self.opacity);
        }
        for entry in entries(&self.all) {
            let _ = writeln!(text, "{entry}");
        }
        if !self.any.is_empty() {
            text.push_str("any = [\n");
            for alternative in &self.any {
                let _ = writeln!(text, "  {{ {} }},", entries(alternative).join(", "));
            }
            text.push_str("]\n");
        }
        let _ = match &self.mask {
            Input::None => Ok(()),
            Input::Node(name) => writeln!(text, "mask = {}", toml_string(name)),
            Input::Value(value) => writeln!(text, "mask = {value:?}"),
        };
    }
}

/// Conditions as TOML entries on one line each.
fn entries(conditions: &[Condition]) -> Vec<String> {
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

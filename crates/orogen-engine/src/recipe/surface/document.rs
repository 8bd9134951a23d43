//! A surface in memory.

use crate::declare::Input;
use crate::value::{toml_key, toml_string};
use orogen_io::dem::file_ref::FileRef;
use orogen_io::palette::color::{Light, Rgb, decode, linear, mix, oklab};
use std::fmt::Write as _;

/// Colors of a gradient or a picture between its first and its last, these included.
pub const RAMP: usize = 128;

/// Most surfaces a recipe may have.
pub const MAX_SURFACES: usize = 64;

/// Most alternatives in a surface's `any`.
pub const MAX_ALTERNATIVES: usize = 16;

/// Most colors in a gradient.
pub const MAX_COLORS: usize = 256;

/// Wavelength in metres of the noise that a gradient follows by default.
pub const DEFAULT_GRAIN: f64 = 200.0;

/// Roughness by default: that of soil and plants.
pub const DEFAULT_ROUGHNESS: f64 = 0.9;

/// A surface: a material that covers the ground where its conditions hold.
///
/// Surfaces are laid over one another in the order of the recipe. Each covers what lies below it by its share, 0 to 1; the first lies everywhere. So the
/// weights of all surfaces add up to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Its name, which is also the name of its weight map. Surfaces of one name share a weight map.
    pub name: String,
    /// Its color.
    pub color: Coloring,
    /// Its roughness as glTF counts it: 0 is a mirror, 1 is matt.
    pub roughness: f64,
    /// Its greatest share, 0 to 1.
    pub opacity: f64,
    /// Conditions that must all hold.
    pub all: Vec<Condition>,
    /// Alternatives of which the one that holds best counts. None: only `all` counts.
    pub any: Vec<Vec<Condition>>,
    /// A node, a layer or a number that its share is multiplied with.
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
    /// The layer of its share, 0 to 1; none for the first, which lies everywhere.
    pub share: Option<String>,
    /// The layer of its position in its gradient, 0 to 1.
    pub position: Option<String>,
    /// The nodes that were added for it, by their indices.
    pub nodes: std::ops::Range<usize>,
    /// Its colors as linear light from the first of its gradient to the last; empty until the picture that they come from is read.
    pub colors: Vec<Light>,
}

/// A range of a quantity with soft ends: the share of a surface is 1 in it and falls smoothly to 0 outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// The quantity.
    pub of: Quantity,
    /// Its lower end; none is no bound.
    pub min: Option<f64>,
    /// Its upper end; none is no bound.
    pub max: Option<f64>,
    /// How far below and above the range the share falls to 0, in the quantity's unit (of a flow: in powers of ten).
    pub fade: [f64; 2],
}

impl Condition {
    /// Whether a quantity lies within a range, its ends fading over so much below and above.
    pub fn new(of: Quantity, min: Option<f64>, max: Option<f64>, fade: [f64; 2]) -> Condition {
        Condition { of, min, max, fade }
    }
}

/// What a condition looks at.
#[derive(Debug, Clone, PartialEq)]
pub enum Quantity {
    /// The height above the sea in metres.
    Height,
    /// The slope in degrees.
    Slope,
    /// The total curvature in 1/m, positive where the ground is convex, of heights so many metres apart.
    Curvature {
        /// Metres.
        scale: f64,
    },
    /// The drainage area in m^2.
    Flow,
    /// Fractal noise, -1 to 1.
    Noise(Noise),
    /// Any node or layer of the recipe, in its own unit.
    Layer(String),
}

/// The noise of a condition: fBm of Perlin noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Metres.
    pub wavelength: f64,
    /// Octaves.
    pub octaves: u32,
    /// Seed, hashed with the world's.
    pub seed: u64,
}

/// How a surface is colored.
#[derive(Debug, Clone, PartialEq)]
pub enum Coloring {
    /// One color.
    Plain(Rgb),
    /// Colors along a quantity, mixed in Oklab.
    Gradient(Vec<Rgb>, Along),
    /// The colors of a picture along a quantity, each as often as it occurs there: its histogram.
    Picture(FileRef, Along),
}

/// What a gradient follows from its first color to its last.
#[derive(Debug, Clone, PartialEq)]
pub enum Along {
    /// A noise of such a wavelength in metres; every color covers the same area.
    Noise(f64),
    /// The height above the sea, from one to another in metres.
    Height([f64; 2]),
    /// The slope, from one to another in degrees.
    Slope([f64; 2]),
    /// A node or layer, from one value to another.
    Layer(String, [f64; 2]),
}

impl Default for Along {
    fn default() -> Along {
        Along::Noise(DEFAULT_GRAIN)
    }
}

impl Coloring {
    /// The colors as linear light, at even steps; none of a picture that has to be read.
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
    /// The picture that its colors come from.
    pub fn picture(&self) -> Option<&FileRef> {
        match &self.color {
            Coloring::Picture(file, _) => Some(file),
            _ => None,
        }
    }

    /// Puts others in the places of the nodes and layers that it reads.
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

    /// The same, to be changed.
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
        // The first surface takes none.
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

/// A color as `#rrggbb`.
pub fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

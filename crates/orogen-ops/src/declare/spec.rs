//! Declarations of ops, as data.

use super::input::InputName;
use super::point_lists::{Drawn, Reader};
use crate::layer::Layer;
use crate::value::{Span, Value};
use orogen_grid::error::{Error, ErrorKind};
use orogen_grid::words::list;

/// The locality of an op: what its result may depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Locality {
    /// One position and the seed.
    Field,
    /// A finite halo.
    Filter,
    /// A finite halo of the next coarser level, level by level.
    Levelled,
    /// The whole bounded world.
    Solver,
}

impl Locality {
    /// The name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Locality::Field => "field",
            Locality::Filter => "filter",
            Locality::Levelled => "levelled",
            Locality::Solver => "solver",
        }
    }
}

/// The name of the parameter for the width by which a solver's domain extends beyond the world.
pub const MARGIN: &str = "margin";

/// The name of the parameter that makes a noise one of space, with a wavelength along the altitude.
pub const VERTICAL: &str = "vertical";

/// The declaration of an op.
#[derive(Debug)]
pub struct Spec {
    /// The name in recipes.
    pub op: &'static str,
    /// The locality.
    pub locality: Locality,
    /// Incremented when the op's results change (only before 1.0; later a better algorithm is a new op).
    pub revision: u32,
    /// The documentation; the first paragraph is the short form.
    pub doc: &'static str,
    /// The inputs.
    pub inputs: &'static [InputSpec],
    /// Whether the names in its expression are also inputs.
    pub named_inputs: bool,
    /// The parameters.
    pub params: &'static [ParamSpec],
    /// The layers: at least one.
    pub layers: &'static [Layer],
}

impl Spec {
    /// The names of the declared inputs.
    pub(crate) fn input_names(&self) -> Vec<InputName<'static>> {
        self.inputs.iter().map(|input| InputName { name: input.name, required: input.required }).collect()
    }

    /// The index of the input with this name, if `given` says that it is given.
    pub(crate) fn given_input(&self, name: &str, given: &[bool]) -> Option<usize> {
        self.input_named(name).filter(|i| given.get(*i) == Some(&true))
    }

    /// The item for the input with this name in a list in the order of the inputs.
    #[doc(hidden)]
    #[must_use]
    pub fn given<T: Copy>(&self, name: &str, given: &[Option<T>]) -> Option<T> {
        given.get(self.input_named(name)?).copied().flatten()
    }

    /// The internal error for a required input that is not given: plans always provide it.
    #[doc(hidden)]
    #[must_use]
    pub fn missing(&self, name: &str) -> Error {
        Error::new(ErrorKind::Internal, format!("the input `{name}` of `{}` is missing", self.op))
    }

    /// The index of the input with this key or alias.
    #[must_use]
    pub fn input_named(&self, key: &str) -> Option<usize> {
        self.inputs.iter().position(|input| input.name == key || (!key.is_empty() && input.alias == key))
    }

    /// The index of the parameter with this key or alias.
    #[must_use]
    pub fn param_named(&self, key: &str) -> Option<usize> {
        self.params.iter().position(|param| param.name == key || (!key.is_empty() && param.alias == key))
    }

    /// The aliases of inputs and parameters (former keys and common terms), each with its key.
    pub fn aliases(&self) -> impl Iterator<Item = (&'static str, &'static str)> + '_ {
        let inputs = self.inputs.iter().map(|input| (input.alias, input.name));
        inputs.chain(self.params.iter().map(|param| (param.alias, param.name))).filter(|(alias, _)| !alias.is_empty())
    }
}

/// The declaration of an input.
#[derive(Debug)]
pub struct InputSpec {
    /// The key.
    pub name: &'static str,
    /// Another key that recipes may use, such as a former key or a common term; or empty.
    pub alias: &'static str,
    /// The documentation.
    pub doc: &'static str,
    /// Whether the input is required.
    pub required: bool,
}

/// The declaration of a parameter.
#[derive(Debug)]
pub struct ParamSpec {
    /// The key.
    pub name: &'static str,
    /// Another key that recipes may use, such as a former key or a common term; or empty.
    pub alias: &'static str,
    /// The documentation.
    pub doc: &'static str,
    /// The unit, or empty.
    pub unit: &'static str,
    /// The kind of value.
    pub shape: Shape,
    /// Minimum and maximum (of each number in the value); infinite if there is no bound.
    pub range: [f64; 2],
}

/// The kind of a parameter's value.
#[derive(Debug, Clone, Copy)]
pub enum Shape {
    /// A finite number.
    Number,
    /// An integer.
    Integer,
    /// A seed: an integer from 0 to 2^63 - 1.
    Seed,
    /// A boolean.
    Flag,
    /// One of several names; each with its description.
    Choice(fn() -> Vec<(&'static str, &'static str)>),
    /// Two numbers.
    Pair,
    /// An expression of the node's inputs.
    Expression,
    /// Control points [[x, y], ...], at least two, with ascending x.
    Curve,
    /// Lists of points [[x, y], ...] or [[x, y, height], ...], each of at least this many points; or one such list.
    Points(usize),
    /// A list of positions [[x, y], ...], at least one.
    Positions,
    /// A list of tables.
    Tables(&'static TableSpec),
    /// The path of a file.
    File,
    /// A coordinate reference system, by its EPSG code.
    Crs,
}

/// The declaration of tables in a list, such as the strokes of a brush.
#[derive(Debug)]
pub struct TableSpec {
    /// The name of a table in messages, in the singular and the plural.
    pub names: [&'static str; 2],
    /// The keys.
    pub keys: &'static [ParamSpec],
    /// Number of keys that every table has: the first ones.
    pub required: usize,
    /// The defaults of the other keys.
    pub defaults: fn() -> Vec<Value>,
    /// Maximum number of tables.
    pub max: usize,
    /// The first problem of a list, which is the value of the parameter with this name: its position and a message.
    pub problem: fn(&str, &Value) -> Option<(Span, String)>,
}

/// A bound in short form: 1e9 instead of 1000000000.
fn number(bound: f64) -> String {
    let plain = (1e-3..1e6).contains(&bound.abs()) || bound == 0.0;
    if plain { format!("{bound}") } else { format!("{bound:e}") }
}

/// The first paragraph of a doc, on one line.
#[must_use]
pub fn short(doc: &str) -> String {
    let paragraph = doc.trim().split("\n\n").next().unwrap_or_default();
    paragraph.split_whitespace().collect::<Vec<_>>().join(" ")
}

impl ParamSpec {
    fn bounds(&self) -> String {
        match self.range {
            [low, high] if low.is_finite() && high.is_finite() => format!(" from {} to {}", number(low), number(high)),
            [low, _] if low.is_finite() => format!(" of at least {}", number(low)),
            [_, high] if high.is_finite() => format!(" of at most {}", number(high)),
            _ => String::new(),
        }
    }

    fn unit_in_parentheses(&self) -> String {
        match self.unit {
            "" => String::new(),
            unit => format!(" ({unit})"),
        }
    }

    /// The valid values of a single number.
    pub(super) fn number(&self) -> String {
        format!("a finite number{}{}", self.bounds(), self.unit_in_parentheses())
    }

    /// The first problem within a value of several parts: its position and a message. `None` if there is none, or the
    /// value is a single part.
    #[must_use]
    pub fn problem(&self, value: &Value) -> Option<(Span, String)> {
        match self.shape {
            Shape::Points(min) => {
                let reader = Reader {
                    name: self.name,
                    number: self.number(),
                    drawn: Drawn::of_at_least(min),
                    range: self.range,
                };
                reader.read(value).err()
            }
            Shape::Tables(table) => (table.problem)(self.name, value),
            _ => None,
        }
    }

    /// The valid values, for messages: "a number from 0 to 1".
    #[must_use]
    pub fn expected(&self) -> String {
        let (range, unit) = (self.bounds(), self.unit_in_parentheses());
        match self.shape {
            Shape::Number => self.number(),
            Shape::Integer => format!("a whole number{range}{unit}"),
            Shape::Seed => "a whole number from 0 to 9223372036854775807".to_string(),
            Shape::Flag => "true or false".to_string(),
            Shape::Choice(choices) => {
                let names: Vec<String> = choices().iter().map(|(name, _)| format!("{name:?}")).collect();
                format!("one of {}", names.join(", "))
            }
            Shape::Pair => format!("two numbers [x, y], each finite{range}{unit}"),
            Shape::Curve => format!(
                "a list of at least two points [[x, y], ...] of finite numbers{range}, each x greater than the one before"
            ),
            Shape::Points(min) => {
                format!(
                    "a list of at least {min} points [[x, y], ...] or [[x, y, height], ...] of finite numbers{range}{unit}, or a list of such lists"
                )
            }
            Shape::Positions => {
                format!("a list of at least one point [[x, y], ...] of finite numbers{range}{unit}")
            }
            Shape::Tables(table) => {
                let keys = list(table.keys.iter().map(|key| key.name));
                format!("a list of at most {} {}, each a table with {keys}", table.max, table.names[1])
            }
            Shape::Expression => "an expression in quotes, such as \"a * 2 + b\"".to_string(),
            Shape::File => "the path of a file, in quotes".to_string(),
            Shape::Crs => "an EPSG code in quotes, such as \"EPSG:32632\"".to_string(),
        }
    }
}

//! What is declared of an op.

use crate::layer::Layer;

/// What an op may look at: the idea everything else follows from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Locality {
    /// One position and the seed.
    Field,
    /// A finite halo.
    Filter,
    /// The whole bounded world.
    Solver,
}

impl Locality {
    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Locality::Field => "field",
            Locality::Filter => "filter",
            Locality::Solver => "solver",
        }
    }
}

/// Everything declared of an op.
#[derive(Debug)]
pub struct Spec {
    /// Its name in recipes.
    pub op: &'static str,
    /// What it may look at.
    pub locality: Locality,
    /// Raised when the op comes to make other bits (only before 1.0; later a better algorithm is a new op).
    pub revision: u32,
    /// Its documentation; the first paragraph is the short form.
    pub doc: &'static str,
    /// The nodes it reads.
    pub inputs: &'static [InputSpec],
    /// Whether it also reads whatever its expression names.
    pub named_inputs: bool,
    /// What it can be told.
    pub params: &'static [ParamSpec],
    /// What it makes: at least one layer.
    pub layers: &'static [Layer],
}

impl Spec {
    /// The input with this key or former key.
    pub fn input_named(&self, key: &str) -> Option<usize> {
        self.inputs.iter().position(|input| input.name == key || (!key.is_empty() && input.alias == key))
    }

    /// The parameter with this key or former key.
    pub fn param_named(&self, key: &str) -> Option<usize> {
        self.params.iter().position(|param| param.name == key || (!key.is_empty() && param.alias == key))
    }

    /// The former keys of inputs and parameters, each with today's key.
    pub fn aliases(&self) -> impl Iterator<Item = (&'static str, &'static str)> + '_ {
        let inputs = self.inputs.iter().map(|input| (input.alias, input.name));
        inputs.chain(self.params.iter().map(|param| (param.alias, param.name))).filter(|(alias, _)| !alias.is_empty())
    }
}

/// A node read by an op.
#[derive(Debug)]
pub struct InputSpec {
    /// Its key.
    pub name: &'static str,
    /// A former key, which recipes may still use; or empty.
    pub alias: &'static str,
    /// What it is for.
    pub doc: &'static str,
    /// Whether the op cannot do without.
    pub required: bool,
}

/// A parameter of an op.
#[derive(Debug)]
pub struct ParamSpec {
    /// Its key.
    pub name: &'static str,
    /// A former key, which recipes may still use; or empty.
    pub alias: &'static str,
    /// What it does.
    pub doc: &'static str,
    /// Its unit, or empty.
    pub unit: &'static str,
    /// What kind of value it is.
    pub shape: Shape,
    /// Lowest and highest value allowed (of each number in it); infinite where there is no bound.
    pub range: [f64; 2],
}

/// What kind of value a parameter takes.
#[derive(Debug, Clone, Copy)]
pub enum Shape {
    /// A finite number.
    Number,
    /// A whole number.
    Integer,
    /// A seed: a whole number from 0 to 2^63 - 1.
    Seed,
    /// true or false.
    Flag,
    /// One of some names; each with what it means.
    Choice(fn() -> Vec<(&'static str, &'static str)>),
    /// Two numbers.
    Pair,
    /// An expression of the node's inputs.
    Expression,
    /// Control points [[x, y], ...], at least two, x rising.
    Curve,
    /// The path of a file.
    File,
    /// A coordinate reference system, by its EPSG code.
    Crs,
}

/// A bound as people write it: 1e9 rather than 1000000000.
fn number(bound: f64) -> String {
    let plain = (1e-3..1e6).contains(&bound.abs()) || bound == 0.0;
    if plain { format!("{bound}") } else { format!("{bound:e}") }
}

/// First paragraph of a doc, on one line.
pub fn short(doc: &str) -> String {
    let paragraph = doc.trim().split("\n\n").next().unwrap_or_default();
    paragraph.split_whitespace().collect::<Vec<_>>().join(" ")
}

impl ParamSpec {
    /// What the parameter must be, for a message: "a number from 0 to 1".
    pub fn expected(&self) -> String {
        let unit = match self.unit {
            "" => String::new(),
            unit => format!(" ({unit})"),
        };
        let range = match self.range {
            [low, high] if low.is_finite() && high.is_finite() => format!(" from {} to {}", number(low), number(high)),
            [low, _] if low.is_finite() => format!(" of at least {}", number(low)),
            [_, high] if high.is_finite() => format!(" of at most {}", number(high)),
            _ => String::new(),
        };
        match self.shape {
            Shape::Number => format!("a finite number{range}{unit}"),
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
            Shape::Expression => "an expression in quotes, such as \"a * 2 + b\"".to_string(),
            Shape::File => "the path of a file, in quotes".to_string(),
            Shape::Crs => "an EPSG code in quotes, such as \"EPSG:32632\"".to_string(),
        }
    }
}

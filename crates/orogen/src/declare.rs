//! Declarations: what an op is called, reads and can be told, said once.
//!
//! One `op!` block gives the struct, its defaults, reading and checking from a recipe, writing back, the JSON Schema, the
//! command line's help and a user interface's sliders.

use crate::dem::file_ref::{FileRef, Picture};
use crate::expression::text::Expression;
use crate::layer::Layer;
use crate::value::{Spanned, Value};
use serde::{Deserialize, Serialize};

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

/// An input of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InputName<'a> {
    /// Its key.
    pub name: &'a str,
    /// Whether the node cannot do without.
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

/// What an op reads: another node's output, or a constant.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Input {
    /// Nothing: an optional input left out, or a required one still missing.
    #[default]
    None,
    /// A node by name, or one of its layers as `node.layer`.
    Node(String),
    /// The same number everywhere.
    Value(f64),
}

impl From<&str> for Input {
    fn from(name: &str) -> Input {
        Input::Node(name.to_string())
    }
}

impl From<&String> for Input {
    fn from(name: &String) -> Input {
        Input::Node(name.clone())
    }
}

impl From<f64> for Input {
    fn from(value: f64) -> Input {
        Input::Value(value)
    }
}

/// A type that a parameter can have.
pub trait Param: Sized {
    /// What kind of value it is read from.
    const SHAPE: Shape;
    /// The parameter from a value, if the value is of the right kind.
    fn read(value: &Value) -> Option<Self>;
    /// The parameter as a value.
    fn write(&self) -> Value;
    /// Whether every number in it is finite and within the range.
    fn within(&self, range: [f64; 2]) -> bool {
        let _ = range;
        true
    }
    /// What decides about results: the parameter itself, or of a file what is in it.
    fn key(&self) -> Value {
        self.write()
    }
    /// The file that it names, if it is a file.
    fn file(&mut self) -> Option<&mut FileRef> {
        None
    }
}

impl Param for Expression {
    const SHAPE: Shape = Shape::Expression;
    fn read(value: &Value) -> Option<Expression> {
        match value {
            Value::Text(text) => Some(Expression::from(text.as_str())),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::Text(self.text().to_string())
    }
    fn key(&self) -> Value {
        Value::Text(Expression::key(self))
    }
}

impl Param for FileRef {
    const SHAPE: Shape = Shape::File;
    fn read(value: &Value) -> Option<FileRef> {
        match value {
            Value::Text(path) => Some(FileRef::from(path.as_str())),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::Text(self.text())
    }
    fn key(&self) -> Value {
        match self.ground() {
            Some(ground) => Value::Text(ground.hash.iter().map(|byte| format!("{byte:02x}")).collect()),
            None => self.write(),
        }
    }
    fn file(&mut self) -> Option<&mut FileRef> {
        Some(self)
    }
}

impl Param for Picture {
    const SHAPE: Shape = Shape::File;
    fn read(value: &Value) -> Option<Picture> {
        match value {
            Value::Text(path) => Some(Picture::from(path.as_str())),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        self.0.write()
    }
    fn key(&self) -> Value {
        self.0.key()
    }
    fn file(&mut self) -> Option<&mut FileRef> {
        Some(&mut self.0)
    }
}

impl Param for f64 {
    const SHAPE: Shape = Shape::Number;
    fn read(value: &Value) -> Option<f64> {
        value.number()
    }
    fn write(&self) -> Value {
        Value::Number(*self)
    }
    fn within(&self, range: [f64; 2]) -> bool {
        self.is_finite() && (range[0]..=range[1]).contains(self)
    }
}

impl Param for u32 {
    const SHAPE: Shape = Shape::Integer;
    fn read(value: &Value) -> Option<u32> {
        match value {
            // What does not fit is out of every declared range too: saturate, so that the range is what the message names.
            Value::Integer(integer) => Some(u32::try_from(*integer).unwrap_or(u32::MAX)),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::Integer(i64::from(*self))
    }
    fn within(&self, range: [f64; 2]) -> bool {
        (range[0]..=range[1]).contains(&f64::from(*self))
    }
}

impl Param for u64 {
    const SHAPE: Shape = Shape::Seed;
    fn read(value: &Value) -> Option<u64> {
        match value {
            Value::Integer(integer) => u64::try_from(*integer).ok(),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::Integer((*self).min(i64::MAX as u64) as i64)
    }
}

impl Param for bool {
    const SHAPE: Shape = Shape::Flag;
    fn read(value: &Value) -> Option<bool> {
        match value {
            Value::Flag(flag) => Some(*flag),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::Flag(*self)
    }
}

impl Param for [f64; 2] {
    const SHAPE: Shape = Shape::Pair;
    fn read(value: &Value) -> Option<[f64; 2]> {
        match value {
            Value::List(items) => match items.as_slice() {
                [a, b] => Some([a.value.number()?, b.value.number()?]),
                _ => None,
            },
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::List(self.iter().map(|number| Spanned::unplaced(Value::Number(*number))).collect())
    }
    fn within(&self, range: [f64; 2]) -> bool {
        self.iter().all(|number| number.within(range))
    }
}

impl Param for Vec<[f64; 2]> {
    const SHAPE: Shape = Shape::Curve;
    fn read(value: &Value) -> Option<Vec<[f64; 2]>> {
        match value {
            Value::List(items) => items.iter().map(|item| <[f64; 2]>::read(&item.value)).collect(),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::List(self.iter().map(|point| Spanned::unplaced(point.write())).collect())
    }
    fn within(&self, range: [f64; 2]) -> bool {
        self.len() >= 2
            && self.iter().all(|point| point.within(range))
            && self.windows(2).all(|pair| pair[0][0] < pair[1][0])
    }
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

/// Reads one parameter: the right kind, in range; or what was expected.
pub fn read_param<T: Param>(spec: &ParamSpec, value: &Value) -> Result<T, String> {
    match T::read(value) {
        Some(param) if param.within(spec.range) => Ok(param),
        _ => {
            let mut message = format!("`{}` must be {}, not {}", spec.name, spec.expected(), value.describe());
            if let (Shape::Choice(choices), Value::Text(text)) = (spec.shape, value) {
                let names: Vec<&str> = choices().iter().map(|(name, _)| *name).collect();
                if let Some(near) = crate::words::nearest(text, names) {
                    message.push_str(&format!("; did you mean \"{near}\"?"));
                }
            }
            Err(message)
        }
    }
}

/// Sets what a name in an expression stands for, and keeps the names in the expression's order.
pub fn set_named(inputs: &mut Vec<(String, Input)>, names: &[String], name: String, input: Input) {
    inputs.retain(|(other, _)| *other != name);
    inputs.push((name, input));
    inputs.sort_by_key(|(name, _)| names.iter().position(|other| other == name));
}

/// What an `op!` block implements: reaching a node's inputs and parameters by their index in the [`Spec`].
pub trait Declared {
    /// What was declared.
    fn spec(&self) -> &'static Spec;
    /// The inputs it has: those declared, or those that its expression names.
    fn inputs(&self) -> Vec<InputName<'_>> {
        self.spec().inputs.iter().map(|input| InputName { name: input.name, required: input.required }).collect()
    }
    /// Input `i`.
    fn input(&self, i: usize) -> &Input;
    /// Sets input `i`.
    fn set_input(&mut self, i: usize, input: Input);
    /// Parameter `i`.
    fn param(&self, i: usize) -> Value;
    /// Sets parameter `i`, or says what was expected.
    fn set_param(&mut self, i: usize, value: &Value) -> Result<(), String>;
    /// What of parameter `i` decides about results.
    fn param_key(&self, i: usize) -> Value;
    /// The files that parameters name.
    fn files(&mut self) -> Vec<&mut FileRef>;
    /// What a single parameter cannot see: a message if parameters contradict each other, with the key it is about.
    fn consistent(&self) -> Result<(), (&'static str, String)>;
}

/// A choice between names, each variant with its doc: `choice! { /// .. pub enum Unit { /// .. Degrees = "degrees", .. } }`.
/// The first variant is the default.
macro_rules! choice {
    (
        $(#[doc = $doc:literal])+
        pub enum $name:ident { $(#[doc = $first_doc:literal])+ $first:ident = $first_text:literal, $( $(#[doc = $vdoc:literal])+ $variant:ident = $text:literal, )* }
    ) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
        pub enum $name { $(#[doc = $first_doc])+ #[default] $first, $( $(#[doc = $vdoc])+ $variant, )* }

        impl $crate::declare::Param for $name {
            const SHAPE: $crate::declare::Shape = $crate::declare::Shape::Choice(|| {
                vec![($first_text, concat!($($first_doc, "\n"),+)), $( ($text, concat!($($vdoc, "\n"),+)), )*]
            });
            fn read(value: &$crate::value::Value) -> Option<$name> {
                match value {
                    $crate::value::Value::Text(text) => match text.as_str() {
                        $first_text => Some($name::$first),
                        $( $text => Some($name::$variant), )*
                        _ => None,
                    },
                    _ => None,
                }
            }
            fn write(&self) -> $crate::value::Value {
                $crate::value::Value::Text(match self {
                    $name::$first => $first_text,
                    $( $name::$variant => $text, )*
                }.to_string())
            }
        }
    };
}

/// Declares an op: see any file in `field/`, `filter/` or `solver/`.
///
/// What a filter or solver makes besides one layer of heights is declared in a block `layers`: each with its doc, how it is
/// read between samples (`height`, `label`, `flow`, or as its `source`) and its unit.
///
/// With `inputs of NAME;` it reads whatever the expression in its parameter NAME names.
///
/// With `octaves;` after its name the op is a fractal: it gets the parameters all fractals share, beside its own.
macro_rules! op {
    (
        $(#[doc = $doc:literal])+
        pub struct $name:ident = $op:literal, $locality:ident, revision $revision:literal;
        octaves;
        $(params { $($params:tt)* })?
    ) => {
        op! {
            $(#[doc = $doc])+
            pub struct $name = $op, $locality, revision $revision;
            params {
                /// Noise basis of the octaves.
                basis: orogen_noise::Basis = orogen_noise::Basis::Perlin;
                /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
                seed: u64 = 0;
                /// Wavelength of the first octave, which is about the distance between its hills.
                wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9;
                /// Number of octaves. Each octave is finer than the one before.
                octaves: u32 = 6, range 1 to orogen_noise::MAX_OCTAVES;
                /// Frequency ratio between successive octaves.
                lacunarity: f64 = 2.0, range 1.0 to 16.0;
                /// Amplitude ratio between successive octaves (also called persistence).
                gain: f64 = 0.5, range 0.0 to 1.0;
                $($($params)*)?
            }
        }

        impl $name {
            /// The octaves as the noise library sums them.
            fn fractal(&self, world_params: &$crate::op::WorldParams, kind: orogen_noise::Kind) -> orogen_noise::Fractal {
                orogen_noise::Fractal {
                    basis: self.basis,
                    kind,
                    seed: world_params.seed_of(self.seed),
                    wavelength: self.wavelength,
                    octaves: self.octaves,
                    lacunarity: self.lacunarity,
                    gain: self.gain,
                }
            }
        }
    };
    (
        $(#[doc = $doc:literal])+
        pub struct $name:ident = $op:literal, $locality:ident, revision $revision:literal;
        $(inputs of $expression:ident;)?
        $(inputs { $( $(#[doc = $idoc:literal])+ $input:ident: $need:ident $(, alias $ialias:literal)?, )* })?
        $(params { $(
            $(#[doc = $pdoc:literal])+
            $param:ident: $pty:ty = $default:expr $(, unit $unit:literal)? $(, range $low:literal to $high:expr)? $(, alias $palias:literal)?;
        )* })?
        $(layers { $( $(#[doc = $ldoc:literal])+ $layer:ident: $interpolation:ident $(, unit $lunit:literal)?; )+ })?
        $(check $check:expr;)?
    ) => {
        $(#[doc = $doc])+
        ///
        #[doc = concat!("In recipes: `op = \"", $op, "\"`.")]
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name {
            $(
                #[doc = concat!("What the names in `", stringify!($expression), "` stand for.")]
                pub inputs: Vec<(String, $crate::declare::Input)>,
            )?
            $( $( $(#[doc = $idoc])+ pub $input: $crate::declare::Input, )* )?
            $( $(
                $(#[doc = $pdoc])+
                $(#[doc = ""] #[doc = concat!("Unit: ", $unit, ".")])?
                #[doc = ""]
                #[doc = concat!("Default: `", stringify!($default), "`." $(, " Range: ", stringify!($low), " to ", stringify!($high), ".")?)]
                pub $param: $pty,
            )* )?
        }

        impl Default for $name {
            fn default() -> $name {
                $name {
                    $( inputs: op!(@empty $expression), )?
                    $( $( $input: $crate::declare::Input::None, )* )?
                    $( $( $param: $default, )* )?
                }
            }
        }

        impl $crate::declare::Declared for $name {
            fn spec(&self) -> &'static $crate::declare::Spec {
                const INPUTS: &[$crate::declare::InputSpec] = &[$( $( $crate::declare::InputSpec {
                    name: stringify!($input),
                    alias: concat!($($ialias)?),
                    doc: concat!($($idoc, "\n"),+),
                    required: op!(@required $need),
                }, )* )?];
                const PARAMS: &[$crate::declare::ParamSpec] = &[$( $( $crate::declare::ParamSpec {
                    name: stringify!($param),
                    alias: concat!($($palias)?),
                    doc: concat!($($pdoc, "\n"),+),
                    unit: concat!($($unit)?),
                    shape: <$pty as $crate::declare::Param>::SHAPE,
                    range: op!(@range $($low, $high)?),
                }, )* )?];
                const LAYERS: &[$crate::layer::Layer] = &[$( $( $crate::layer::Layer {
                    name: stringify!($layer),
                    doc: concat!($($ldoc, "\n"),+),
                    unit: concat!($($lunit)?),
                    interpolation: op!(@interpolation $interpolation),
                }, )+ )?];
                static SPEC: $crate::declare::Spec = $crate::declare::Spec {
                    op: $op,
                    locality: op!(@locality $locality),
                    revision: $revision,
                    doc: concat!($($doc, "\n"),+),
                    inputs: INPUTS,
                    named_inputs: op!(@given $($expression)?),
                    params: PARAMS,
                    layers: if LAYERS.is_empty() { $crate::layer::ONE_LAYER } else { LAYERS },
                };
                &SPEC
            }

            $(
                fn inputs(&self) -> Vec<$crate::declare::InputName<'_>> {
                    let names = self.$expression.names().iter();
                    names.map(|name| $crate::declare::InputName { name, required: true }).collect()
                }
            )?

            #[allow(unused_variables, unused_mut, unused_assignments, reason = "not every op has inputs")]
            fn input(&self, i: usize) -> &$crate::declare::Input {
                $(
                    let given = self.$expression.names().get(i);
                    let given = self.inputs.iter().find(|(name, _)| Some(name) == given);
                    if let Some((_, input)) = given { return input; }
                )?
                let mut at = 0;
                $( $( if i == at { return &self.$input; } at += 1; )* )?
                &$crate::declare::Input::None
            }

            #[allow(unused_variables, unused_mut, unused_assignments, reason = "not every op has inputs")]
            fn set_input(&mut self, i: usize, input: $crate::declare::Input) {
                $(
                    if let Some(name) = self.$expression.names().get(i).cloned() {
                        $crate::declare::set_named(&mut self.inputs, self.$expression.names(), name, input);
                        return;
                    }
                )?
                let mut at = 0;
                $( $( if i == at { self.$input = input; return; } at += 1; )* )?
            }

            #[allow(unused_variables, unused_mut, unused_assignments, reason = "not every op has parameters")]
            fn param(&self, i: usize) -> $crate::value::Value {
                let mut at = 0;
                $( $( if i == at { return $crate::declare::Param::write(&self.$param); } at += 1; )* )?
                $crate::value::Value::Other("nothing")
            }

            #[allow(unused_variables, unused_mut, unused_assignments, reason = "not every op has parameters")]
            fn set_param(&mut self, i: usize, value: &$crate::value::Value) -> std::result::Result<(), String> {
                let spec = self.spec();
                let mut at = 0;
                $( $(
                    if i == at {
                        self.$param = $crate::declare::read_param(&spec.params[i], value)?;
                        return Ok(());
                    }
                    at += 1;
                )* )?
                Ok(())
            }

            #[allow(unused_variables, unused_mut, unused_assignments, reason = "not every op has parameters")]
            fn param_key(&self, i: usize) -> $crate::value::Value {
                let mut at = 0;
                $( $( if i == at { return $crate::declare::Param::key(&self.$param); } at += 1; )* )?
                $crate::value::Value::Other("nothing")
            }

            fn files(&mut self) -> Vec<&mut $crate::dem::file_ref::FileRef> {
                let files: Vec<Option<&mut $crate::dem::file_ref::FileRef>> =
                    vec![$( $( $crate::declare::Param::file(&mut self.$param), )* )?];
                files.into_iter().flatten().collect()
            }

            fn consistent(&self) -> std::result::Result<(), (&'static str, String)> {
                $( let check: fn(&$name) -> std::result::Result<(), (&'static str, String)> = $check; check(self)?; )?
                Ok(())
            }
        }
    };
    (@empty $given:tt) => { Vec::new() };
    (@given) => { false };
    (@given $given:tt) => { true };
    (@required required) => { true };
    (@required optional) => { false };
    (@range) => { [f64::NEG_INFINITY, f64::INFINITY] };
    (@range $low:literal, $high:expr) => { [$low as f64, $high as f64] };
    (@interpolation height) => { $crate::layer::Interpolation::As($crate::layer::LayerKind::Height) };
    (@interpolation label) => { $crate::layer::Interpolation::As($crate::layer::LayerKind::Label) };
    (@interpolation flow) => { $crate::layer::Interpolation::As($crate::layer::LayerKind::Flow) };
    (@interpolation source) => { $crate::layer::Interpolation::AsSource };
    (@locality field) => { $crate::declare::Locality::Field };
    (@locality filter) => { $crate::declare::Locality::Filter };
    (@locality solver) => { $crate::declare::Locality::Solver };
}

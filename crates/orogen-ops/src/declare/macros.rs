//! `op!` and `choice!`. Every path begins with `$crate`, so that they work in any crate.

/// A parameter that is one of several names. The first variant is the default. With `as TYPE` after its name it
/// converts into the enum `TYPE`, whose variants have the same names.
///
/// ```
/// orogen_ops::choice! {
///     /// Unit of a slope.
///     pub enum Unit {
///         /// Degrees from the horizontal.
///         Degrees = "degrees",
///         /// Rise over run.
///         Ratio = "ratio",
///     }
/// }
///
/// assert_eq!(Unit::default(), Unit::Degrees);
/// ```
#[macro_export]
macro_rules! choice {
    (
        $(#[doc = $doc:literal])+
        $visibility:vis enum $name:ident as $twin:ty { $( $(#[doc = $vdoc:literal])+ $variant:ident = $text:literal, )+ }
    ) => {
        $crate::choice! {
            $(#[doc = $doc])+
            $visibility enum $name { $( $(#[doc = $vdoc])+ $variant = $text, )+ }
        }

        impl From<$name> for $twin {
            fn from(choice: $name) -> $twin {
                type Twin = $twin;
                match choice {
                    $( $name::$variant => Twin::$variant, )+
                }
            }
        }
    };
    (
        $(#[doc = $doc:literal])+
        $visibility:vis enum $name:ident { $(#[doc = $first_doc:literal])+ $first:ident = $first_text:literal, $( $(#[doc = $vdoc:literal])+ $variant:ident = $text:literal, )* }
    ) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
        $visibility enum $name { $(#[doc = $first_doc])+ #[default] $first, $( $(#[doc = $vdoc])+ $variant, )* }

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

/// Declares an op: its struct, defaults, name in recipes, inputs, parameters and layers. You then implement the trait
/// of the declared locality for the struct: [`Field`](crate::op::Field), [`Filter`](crate::op::Filter),
/// [`Levelled`](crate::op::Levelled) or [`Solver`](crate::op::Solver).
///
/// The name of an op that is not part of this crate has a namespace: `"mygame.terraces"`. Register it in a `Registry`
/// of the engine to use it in recipes. The revision is part of the content key of every node of the op: increase it
/// when the results of the op change.
///
/// The blocks are in this order; all are optional:
///
/// - `inputs { /// .. source: required, /// .. other: optional, }`: the inputs, by their names in the `inputs`
///   argument. With `inputs of NAME;` the inputs are instead the names in the expression of the parameter NAME.
/// - `params { /// .. name: TYPE = DEFAULT, unit "m", range 0.0 to 1e5; }`: unit and range are optional. A type is any
///   [`Param`](crate::declare::Param): `f64`, `u32`, `u64` (a seed), `bool`, `[f64; 2]`, `Vec<[f64; 2]>` (a curve),
///   `LinePoints` or `AreaPoints`, `Strokes`, `FileRef`, `Expression`, or a [`choice!`](crate::choice).
/// - `layers { /// .. name: height, unit "m"; }`: the layers, if there are others than one layer of heights, and how
///   each is interpolated between samples (`height`, `label`, `flow`, or like the first input: `source`).
/// - `units |op, layer| "m";`: the unit of a layer by its index, if it depends on parameters.
/// - `check |op| Ok(());`: a check across parameters. It returns a key and a message if parameters contradict each
///   other.
/// - `noise |op, world_params| NOISE; cost |op| [f64; 2];`: a field that is a noise of [`orogen_noise`], with its time
///   in nanoseconds per sample, at arbitrary positions and on a lattice. The op gets the parameter `vertical`, and
///   `Field` is implemented for it.
///
/// After `required` or `optional`, or at the end of a parameter, `alias "other"` declares another key that recipes may
/// use: a former key or a common term. With `octaves |op| KIND;` after its name the op is a fractal: a noise with its
/// own parameters and those that all fractals share. With `margin;` after its name the op is a solver with the
/// parameter `margin`: its domain extends beyond the world by that length on each side. The implementation needs no
/// code for it, because [`Sources::domain`](crate::op::Sources::domain) is the extended domain. With `strata;` after
/// that the op gets the input `bedding`, the parameters `strata` and `repeat_strata`, and a method `prepared_strata`.
///
/// ```
/// use orogen_ops::op::{Context, Filter, GridInputs, only_layer};
/// use orogen_grid::{Grid, Result, Window};
///
/// orogen_ops::op! {
///     /// Raises the source by a constant height.
///     pub struct Raise = "example.raise", filter, revision 1;
///     inputs {
///         /// The heights to raise.
///         source: required,
///     }
///     params {
///         /// How far.
///         by: f64 = 10.0, unit "m", range -1e4 to 1e4;
///     }
/// }
///
/// impl Filter for Raise {
///     fn halo(&self, _cell: f64) -> usize {
///         0
///     }
///
///     fn apply(&self, inputs: &GridInputs, _: &Window, out: &mut [Option<Grid>], _: &Context) -> Result<()> {
///         let source = inputs.required("source")?;
///         let out = only_layer(out)?;
///         for (out, source) in out.data_mut().iter_mut().zip(source.data()) {
///             *out = source + self.by as f32;
///         }
///         Ok(())
///     }
/// }
///
/// assert_eq!(Raise::default().by, 10.0);
/// ```
#[macro_export]
macro_rules! op {
    (
        $(#[doc = $doc:literal])+
        $visibility:vis struct $name:ident = $op:literal, field, revision $revision:literal;
        octaves $kind:expr;
        $(params { $($params:tt)* })?
    ) => {
        $crate::op! {
            $(#[doc = $doc])+
            $visibility struct $name = $op, field, revision $revision;
            params {
                /// Noise basis of the octaves.
                basis: $crate::declare::noise::Basis = $crate::declare::noise::Basis::Perlin;
                /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
                seed: u64 = 0;
                /// Wavelength of the first octave, which is about the distance between its hills.
                wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
                /// Number of octaves. Each octave is finer than the one before.
                octaves: u32 = 6, range 1 to $crate::declare::noise::MAX_OCTAVES;
                /// Frequency ratio between successive octaves.
                lacunarity: f64 = 2.0, range 1.0 to 16.0;
                /// Amplitude ratio between successive octaves (also called persistence).
                gain: f64 = 0.5, range 0.0 to 1.0, alias "persistence";
                $($($params)*)?
            }
            noise |op, world_params| {
                let kind: fn(&$name) -> $crate::declare::noise::Kind = $kind;
                $crate::declare::noise::Fractal::new(world_params.seed_of(op.seed), op.wavelength)
                    .with_basis(op.basis)
                    .with_kind(kind(op))
                    .with_octaves(op.octaves)
                    .with_lacunarity(op.lacunarity)
                    .with_gain(op.gain)
            };
            cost |op| {
                let kind: fn(&$name) -> $crate::declare::noise::Kind = $kind;
                $crate::noise_field::fractal_cost(op.basis, kind(op), op.octaves)
            };
        }
    };
    (
        $(#[doc = $doc:literal])+
        $visibility:vis struct $name:ident = $op:literal, field, revision $revision:literal;
        params { $($params:tt)* }
        noise $noise:expr;
        cost $cost:expr;
    ) => {
        $crate::op! {
            $(#[doc = $doc])+
            $visibility struct $name = $op, field, revision $revision;
            space in vertical;
            params {
                $($params)*
                /// Wavelength along the altitude, as a multiple of `wavelength`: the noise is one of space, and depends
                /// on the altitude at which the layer is sampled. 0: the noise is one of the plane, the same at every
                /// altitude.
                vertical: f64 = 0.0, range 0.0 to 1e3;
            }
        }

        impl $name {
            fn noise(&self, world_params: &$crate::op::WorldParams) -> $crate::noise_field::NoiseField {
                let noise: fn(&$name, &$crate::op::WorldParams) -> _ = $noise;
                let dimensions = $crate::noise_field::dimensions(self.vertical);
                $crate::noise_field::NoiseField::new(noise(self, world_params).prepare_in(dimensions), self.vertical)
            }

            const COST: fn(&$name) -> [f64; 2] = $cost;
        }

        impl $crate::op::Field for $name {
            fn prepare(&self, world_params: &$crate::op::WorldParams) -> Option<$crate::op::Evaluator> {
                Some(self.noise(world_params).evaluator())
            }

            fn lower(&self, _: usize, world_params: &$crate::op::WorldParams) -> $crate::noise_field::Lowered {
                self.noise(world_params).lower()
            }

            fn cost(&self) -> f64 {
                $name::COST(self)[0]
            }

            fn cost_in_rows(&self) -> f64 {
                $name::COST(self)[1]
            }
        }
    };
    (
        $(#[doc = $doc:literal])+
        $visibility:vis struct $name:ident = $op:literal, solver, revision $revision:literal;
        margin;
        strata;
        $($rest:tt)*
    ) => {
        $crate::op! { @strata [margin;] $(#[doc = $doc])+ $visibility struct $name = $op, solver, revision $revision; $($rest)* }
    };
    (
        $(#[doc = $doc:literal])+
        $visibility:vis struct $name:ident = $op:literal, $locality:ident, revision $revision:literal;
        strata;
        $($rest:tt)*
    ) => {
        $crate::op! { @strata [] $(#[doc = $doc])+ $visibility struct $name = $op, $locality, revision $revision; $($rest)* }
    };
    (
        @strata [$($margin:tt)*]
        $(#[doc = $doc:literal])+
        $visibility:vis struct $name:ident = $op:literal, $locality:ident, revision $revision:literal;
        inputs { $($inputs:tt)* }
        $(params { $($params:tt)* })?
        $(layers { $($layers:tt)* })?
    ) => {
        $crate::op! {
            $(#[doc = $doc])+
            $visibility struct $name = $op, $locality, revision $revision;
            $($margin)*
            inputs {
                $($inputs)*
                /// Height of the top of the first stratum in metres, at the end of the simulated time: a plane for
                /// rock that dips, noise for folds, a step for a fault. It has no effect without `strata`. Default: 0.
                bedding: optional,
            }
            params {
                $($($params)*)?
                /// Layers of rock from the top down. Above the first one and below the last one these two go on.
                strata: Vec<$crate::declare::Stratum> = Vec::new();
                /// Whether the strata repeat above and below instead.
                repeat_strata: bool = false;
            }
            $(layers { $($layers)* })?
        }

        impl $name {
            /// The strata for a run; `None` if there are none. Strata without a talus angle get `max_slope`, rise over
            /// run.
            fn prepared_strata(&self, max_slope: f64) -> Option<$crate::declare::strata::Strata> {
                $crate::declare::strata::Strata::new(&self.strata, self.repeat_strata, max_slope)
            }
        }
    };
    (
        $(#[doc = $doc:literal])+
        $visibility:vis struct $name:ident = $op:literal, solver, revision $revision:literal;
        margin;
        $(inputs { $($inputs:tt)* })?
        $(params { $($params:tt)* })?
        $(layers { $($layers:tt)* })?
        $(check $check:expr;)?
    ) => {
        $crate::op! {
            $(#[doc = $doc])+
            $visibility struct $name = $op, solver, revision $revision;
            margin in margin;
            $(inputs { $($inputs)* })?
            params {
                $($($params)*)?
                /// Width of the strip beyond each side of the world that is solved too. The border of the solved domain
                /// shows in drainage, erosion and shadows; with a margin it lies outside the world. Nodes that read
                /// beyond the world's sides get solved values up to there.
                margin: f64 = 0.0, unit "m", range 0.0 to 1e6;
            }
            $(layers { $($layers)* })?
            $(check $check;)?
        }
    };
    (
        $(#[doc = $doc:literal])+
        $visibility:vis struct $name:ident = $op:literal, $locality:ident, revision $revision:literal;
        $(margin in $margin:ident;)?
        $(space in $vertical:ident;)?
        $(inputs of $expression:ident;)?
        $(inputs { $( $(#[doc = $idoc:literal])+ $input:ident: $need:ident $(, alias $ialias:literal)?, )* })?
        $(params { $(
            $(#[doc = $pdoc:literal])+
            $param:ident: $pty:ty = $default:expr $(, unit $unit:literal)? $(, range $low:literal to $high:expr)? $(, alias $palias:literal)?;
        )* })?
        $(layers { $( $(#[doc = $ldoc:literal])+ $layer:ident: $interpolation:ident $(, unit $lunit:literal)?; )+ })?
        $(units $units:expr;)?
        $(check $check:expr;)?
    ) => {
        $(#[doc = $doc])+
        ///
        #[doc = concat!("In recipes: `op = \"", $op, "\"`.")]
        #[derive(Debug, Clone, PartialEq)]
        $visibility struct $name {
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
                    $( inputs: $crate::op!(@empty $expression), )?
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
                    required: $crate::op!(@required $need),
                }, )* )?];
                const PARAMS: &[$crate::declare::ParamSpec] = &[$( $( $crate::declare::ParamSpec {
                    name: stringify!($param),
                    alias: concat!($($palias)?),
                    doc: concat!($($pdoc, "\n"),+),
                    unit: concat!($($unit)?),
                    shape: <$pty as $crate::declare::Param>::SHAPE,
                    range: $crate::op!(@range $($low, $high)?),
                }, )* )?];
                const LAYERS: &[$crate::layer::Layer] = &[$( $( $crate::layer::Layer {
                    name: stringify!($layer),
                    doc: concat!($($ldoc, "\n"),+),
                    unit: concat!($($lunit)?),
                    interpolation: $crate::op!(@interpolation $interpolation),
                }, )+ )?];
                static SPEC: $crate::declare::Spec = $crate::declare::Spec {
                    op: $op,
                    locality: $crate::op!(@locality $locality),
                    revision: $revision,
                    doc: concat!($($doc, "\n"),+),
                    inputs: INPUTS,
                    named_inputs: $crate::op!(@given $($expression)?),
                    params: PARAMS,
                    layers: if LAYERS.is_empty() { $crate::layer::ONE_LAYER } else { LAYERS },
                };
                &SPEC
            }

            $(
                fn inputs(&self) -> ::std::vec::Vec<$crate::declare::InputName<'_>> {
                    let names = self.$expression.names().iter();
                    names.map(|name| $crate::declare::InputName { name, required: true }).collect()
                }
            )?

            #[allow(unreachable_code, reason = "an op with an expression has no other inputs")]
            fn input(&self, i: usize) -> &$crate::declare::Input {
                $( return $crate::declare::named(&self.inputs, self.$expression.names(), i); )?
                let inputs: &[&$crate::declare::Input] = &[$( $( &self.$input, )* )?];
                inputs.get(i).copied().unwrap_or(&$crate::declare::Input::None)
            }

            #[allow(unreachable_code, reason = "an op with an expression has no other inputs")]
            fn set_input(&mut self, i: usize, input: $crate::declare::Input) {
                $(
                    let names = self.$expression.names();
                    return names.get(i).map_or((), |name| $crate::declare::set_named(&mut self.inputs, names, name, input));
                )?
                let inputs: &mut [&mut $crate::declare::Input] = &mut [$( $( &mut self.$input, )* )?];
                if let Some(old) = inputs.get_mut(i) {
                    **old = input;
                }
            }

            fn params(&self) -> Vec<&dyn $crate::declare::AnyParam> {
                vec![$( $( &self.$param, )* )?]
            }

            fn params_mut(&mut self) -> Vec<&mut dyn $crate::declare::AnyParam> {
                vec![$( $( &mut self.$param, )* )?]
            }

            $(
                fn margin(&self) -> Option<f64> {
                    Some(self.$margin)
                }
            )?

            $(
                fn vertical(&self) -> f64 {
                    self.$vertical
                }
            )?

            $(
                fn unit(&self, layer: usize) -> &'static str {
                    let units: fn(&$name, usize) -> &'static str = $units;
                    units(self, layer)
                }
            )?

            fn consistent(&self) -> std::result::Result<(), (&'static str, String)> {
                $( let check: fn(&$name) -> std::result::Result<(), (&'static str, String)> = $check; check(self)?; )?
                Ok(())
            }
        }

        impl $crate::op::OpType for $name {
            fn as_op(&self) -> $crate::op::Op<'_> {
                $crate::op!(@as_op $locality self)
            }
        }
    };
    (@as_op field $op:expr) => { $crate::op::Op::Field($op) };
    (@as_op filter $op:expr) => { $crate::op::Op::Filter($op) };
    (@as_op levelled $op:expr) => { $crate::op::Op::Levelled($op) };
    (@as_op solver $op:expr) => { $crate::op::Op::Solver($op) };
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
    (@locality levelled) => { $crate::declare::Locality::Levelled };
    (@locality solver) => { $crate::declare::Locality::Solver };
}

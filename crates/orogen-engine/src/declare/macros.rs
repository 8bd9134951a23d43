//! `op!` and `choice!`.

/// An enum of named choices, each variant with its doc: `choice! { /// .. pub enum Unit { /// .. Degrees = "degrees",
/// .. } }`. The first variant is the default.
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
/// Layers of a filter or solver other than a single layer of heights are declared in a block `layers`: each with its
/// doc, its interpolation (`height`, `label`, `flow`, or as its `source`) and its unit.
///
/// With `inputs of NAME;` its inputs are the names in the expression of its parameter NAME.
///
/// With `octaves;` after its name the op is a fractal: it has the common parameters of fractals, in addition to its
/// own.
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
            /// The octaves, as the noise library sums them.
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

            fn files(&mut self) -> Vec<&mut $crate::declare::FileRef> {
                let files: Vec<Option<&mut $crate::declare::FileRef>> =
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

//! Builder methods of option structs.

/// Writes a method `with_FIELD` for each public field of an option struct.
///
/// Option structs are `#[non_exhaustive]`, so programs outside their crate build them from `new` or `Default` and these
/// methods.
#[doc(hidden)]
#[macro_export]
macro_rules! builder {
    ($type:ident: $($with:ident($field:ident: $kind:ty)),* $(,)?) => {
        impl $type {
            $(
                #[doc = concat!("Sets [`", stringify!($field), "`](field@Self::", stringify!($field), ").")]
                #[must_use]
                pub const fn $with(mut self, $field: $kind) -> Self {
                    self.$field = $field;
                    self
                }
            )*
        }
    };
}

/// The constructor and the builder methods of a noise: `new`, `with_seed`, `with_wavelength`, and one method for each
/// other field.
macro_rules! noise_builder {
    ($noise:ident $(: $($with:ident($field:ident: $kind:ty)),*)? $(,)?) => {
        impl $noise {
            /// The noise with this [`seed`](field@Self::seed) and [`wavelength`](field@Self::wavelength) in metres, and
            /// the defaults of the other fields.
            #[must_use]
            pub fn new(seed: u64, wavelength: f64) -> Self {
                Self { seed, wavelength, ..Self::default() }
            }
        }

        $crate::builder!($noise: with_seed(seed: u64), with_wavelength(wavelength: f64) $($(, $with($field: $kind))*)?);
    };
}
pub(crate) use noise_builder;

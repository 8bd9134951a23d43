//! Declarations of ops: name, inputs, parameters and layers.
//!
//! One `op!` block defines the struct, its defaults, parsing, validation and serialization, the JSON Schema, the help
//! on the command line and the sliders of a user interface.
//!
//! - [`spec`]: the declarations of ops, inputs and parameters, as data
//! - [`input`]: inputs of nodes
//! - [`param`]: the types that parameters can have
//! - [`points`]: lists of points as parameters, and their segments; [`memo`]: values computed from parameters once
//! - [`exemplar_file`]: a file whose texture is spread
//! - [`strokes`]: strokes of a brush as a parameter; [`strata`]: strata of rock; `tables` reads such lists of tables
//! - [`declared`]: the trait that every op implements by its declaration
//! - `macros`: [`op!`](crate::op!) and [`choice!`](crate::choice), which generate all of this

#[macro_use]
mod macros;

#[doc(hidden)]
pub mod declared;
#[doc(hidden)]
pub mod exemplar_file;
#[doc(hidden)]
pub mod input;
#[doc(hidden)]
pub mod memo;
#[doc(hidden)]
pub mod param;
#[doc(hidden)]
pub mod point_lists;
#[doc(hidden)]
pub mod points;
#[doc(hidden)]
pub mod spec;
#[doc(hidden)]
pub mod strata;
#[doc(hidden)]
pub mod strokes;
mod tables;

/// Noise of the octaves of fractals. A module, because the pages of a crate that is passed on are not hidden.
#[doc(hidden)]
pub mod noise {
    pub use orogen_noise::*;
}

pub use declared::Declared;
#[doc(hidden)]
pub use exemplar_file::ExemplarFile;
pub use input::{Input, InputName};
#[doc(hidden)]
pub use input::{named, set_named};
pub use orogen_grid::strata::Stratum;
#[doc(hidden)]
pub use orogen_io::dem::file_ref::RidgeFile;
pub use orogen_io::dem::file_ref::{AreaFile, FileRef, LineFile, NetworkFile};
#[doc(hidden)]
pub use param::AnyParam;
pub use param::{Param, read_param};
pub use points::{AreaPoints, LinePoints, OutlineOptions, PointLists};
pub use spec::{InputSpec, Locality, MARGIN, ParamSpec, Shape, Spec, TableSpec, VERTICAL, short};
pub use strokes::{Stroke, StrokeMode, Strokes};

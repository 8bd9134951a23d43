//! Declarations of ops: name, inputs, parameters and layers.
//!
//! One `op!` block gives the struct, its defaults, parsing and validation, serialization, the JSON Schema, the help of
//! the command line and the sliders of a user interface.
//!
//! - [`spec`]: what is declared of an op, its inputs and its parameters
//! - [`input`]: what a node reads
//! - [`param`]: the types that parameters can have
//! - [`points`]: lists of points as parameters, and their segments; [`memo`]: a value made from parameters once
//! - [`strokes`]: strokes of a brush as a parameter
//! - [`declared`]: what every op implements
//! - `macros`: [`op!`](crate::op!) and [`choice!`](crate::choice), which write all of it

#[macro_use]
mod macros;

#[doc(hidden)]
pub mod declared;
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
pub mod strokes;

pub use declared::Declared;
pub use input::{Input, InputName};
#[doc(hidden)]
pub use input::{named, set_named};
pub use orogen_io::dem::file_ref::{AreaFile, FileRef, LineFile};
/// What the octaves of a fractal are made of.
#[doc(hidden)]
pub use orogen_noise as noise;
#[doc(hidden)]
pub use param::AnyParam;
pub use param::{Param, read_param};
pub use points::{AreaPoints, LinePoints, OutlineOptions, PointLists};
pub use spec::{InputSpec, Locality, MARGIN, ParamSpec, Shape, Spec, TableSpec, VERTICAL, short};
pub use strokes::{Stroke, StrokeMode, Strokes};

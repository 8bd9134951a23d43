//! Declarations: what an op is called, reads and can be told, said once.
//!
//! One `op!` block gives the struct, its defaults, reading and checking from a recipe, writing back, the JSON Schema, the
//! command line's help and a user interface's sliders.
//!
//! - [`spec`]: what is declared of an op, its inputs and its parameters
//! - [`input`]: what a node reads
//! - [`param`]: the types that parameters can have
//! - [`declared`]: what every op implements
//! - `macros`: [`op!`](crate::op!) and [`choice!`](crate::choice), which write all of it

#[macro_use]
mod macros;

pub mod declared;
pub mod input;
pub mod param;
pub mod spec;

pub use declared::Declared;
pub use input::{Input, InputName, set_named};
pub use orogen_io::dem::file_ref::FileRef;
/// What the octaves of a fractal are made of.
#[doc(hidden)]
pub use orogen_noise as noise;
pub use param::{Param, read_param};
pub use spec::{InputSpec, Locality, ParamSpec, Shape, Spec, short};

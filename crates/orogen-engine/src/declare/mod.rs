//! Declarations of ops: name, inputs, parameters and layers.
//!
//! One `op!` block gives the struct, its defaults, parsing and validation, serialisation, the JSON Schema, the help of
//! the command line and the sliders of a user interface.
//!
//! - [`spec`]: the declaration of an op, its inputs and its parameters
//! - [`input`]: the inputs of a node
//! - [`param`]: the types of parameters
//! - [`declared`]: the trait that every op implements
//! - `macros`: `op!` and `choice!`, which generate the code

#[macro_use]
mod macros;

pub mod declared;
pub mod input;
pub mod param;
pub mod spec;

pub use declared::Declared;
pub use input::{Input, InputName, set_named};
pub use orogen_io::dem::file_ref::FileRef;
pub use param::{Param, read_param};
pub use spec::{InputSpec, Locality, ParamSpec, Shape, Spec, short};

//! Programs of the engine as compute shaders.

pub(crate) mod functions;
pub(crate) mod kernel;
pub(crate) mod positions;
pub(crate) mod run;

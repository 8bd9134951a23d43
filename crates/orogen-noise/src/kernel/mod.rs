//! The kernels: every noise, one program; lattice and scattered points.

pub(crate) mod basis;
pub(crate) mod cell;
pub(crate) mod combine;
pub(crate) mod fade;
pub(crate) mod fill;
pub(crate) mod scattered;
pub(crate) mod source;

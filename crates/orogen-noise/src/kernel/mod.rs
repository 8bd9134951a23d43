//! The kernels: every noise, one program; lattice and scattered points.
//!
//! Everything a kernel runs per sample is an `#[inline(always)]` function or a plain loop over an index: a closure or an iterator
//! adaptor is a function of its own, compiled *without* the level's instructions where it is not inlined.

pub(crate) mod bases;
pub(crate) mod basis;
pub(crate) mod cell;
pub(crate) mod cellular;
pub(crate) mod cellular_rows;
pub(crate) mod combine;
pub(crate) mod fade;
pub(crate) mod families;
pub(crate) mod fill;
pub(crate) mod gradient;
pub(crate) mod lattice;
pub(crate) mod near;
pub(crate) mod open_simplex;
pub(crate) mod outputs;
pub(crate) mod phacelle;
pub(crate) mod places;
pub(crate) mod pointwise;
pub(crate) mod scattered;
pub(crate) mod simplex;
pub(crate) mod sites;
pub(crate) mod slanted;
pub(crate) mod source;
pub(crate) mod strip;
pub(crate) mod value;
pub(crate) mod white;

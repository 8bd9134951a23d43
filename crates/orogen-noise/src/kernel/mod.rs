//! The kernels, which evaluate any noise as a program, for lattices and scattered points.
//!
//! Code that runs per sample is in `#[inline(always)]` functions and plain loops over an index. A closure or an
//! iterator adaptor is a separate function. If it is not inlined, it is compiled *without* the instructions of the SIMD
//! level.

pub(crate) mod bases;
pub(crate) mod basis;
pub(crate) mod blocks;
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

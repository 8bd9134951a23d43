//! Lookup tables of noises.

pub(crate) mod directions;
pub(crate) mod reference;

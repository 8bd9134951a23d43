//! Lookup tables of noises. Those that tests read are `pub`.

pub mod directions;
pub mod reference;

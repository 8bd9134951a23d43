//! Numbers that noises look up.

pub(crate) mod directions;
pub(crate) mod reference;

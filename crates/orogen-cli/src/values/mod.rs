//! Values on the command line: each kind is parsed in one place, with its range and its message.

pub mod arguments;
pub mod bytes;
pub mod name_of;
pub mod number;
pub mod region;
pub mod seeds;
pub mod sweep;
pub mod time;

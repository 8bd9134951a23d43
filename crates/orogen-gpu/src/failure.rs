//! Failures of work on a graphics card.

use std::fmt;

/// The reason why work could not be done on a graphics card. The engine then does it on the processor.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Failure {
    /// There is no adapter, or none can be used; has the reason for each.
    NoAdapter(String),
    /// The device was lost: the driver was restarted or updated, or the card was removed.
    Lost(String),
    /// The device has too little memory, or the work exceeds one of its limits.
    Memory(String),
    /// The driver rejected a shader or a command.
    Driver(String),
    /// An input does not fit the work, for example because it covers too little.
    Input(String),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::NoAdapter(why) => write!(f, "no graphics card can be used: {why}"),
            Failure::Lost(why) => write!(f, "the graphics card was lost: {why}"),
            Failure::Memory(why) => write!(f, "the graphics card has too little memory: {why}"),
            Failure::Driver(why) => write!(f, "the graphics driver refused the work: {why}"),
            Failure::Input(why) => write!(f, "the graphics card cannot do the work: {why}"),
        }
    }
}

impl std::error::Error for Failure {}

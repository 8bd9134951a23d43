//! Previews on a graphics card, which a page has not: its work would have to wait for the card.

use orogen::Session;

/// A graphics card that computes previews. There is none.
#[derive(Debug, Clone, Copy)]
pub enum Gpu {}

/// The adapter of a graphics card.
#[derive(Debug)]
pub struct Adapter {
    /// Its name.
    pub name: String,
}

impl Gpu {
    /// The adapter.
    #[must_use]
    pub fn adapter(&self) -> &Adapter {
        match *self {}
    }

    /// Why it is no longer used.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        match *self {}
    }
}

/// A session whose previews are computed on a graphics card.
#[must_use]
pub fn with_gpu(_: &Session, gpu: &Gpu) -> Session {
    match *gpu {}
}

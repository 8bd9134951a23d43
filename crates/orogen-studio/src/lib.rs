//! The studio of Orogen: a window in which a person designs a world by looking.
//!
//! It is a thin shell over the engine's session. What is edited ([`editing`]), what is shown ([`studio`], [`preview`])
//! and from where ([`view`]) needs no graphics; the feature `window` adds what draws it.
#![forbid(unsafe_code)]

pub mod catalogue;
pub mod editing;
pub mod export;
pub mod files;
pub mod preview;
pub mod recovery;
pub mod settings;
pub mod studio;
pub mod view;
#[cfg(feature = "window")]
pub mod window;

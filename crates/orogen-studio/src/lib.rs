//! The studio of Orogen: a window for designing a world interactively.
//!
//! It is a thin layer over the engine's session. The edited recipe ([`editing`]), the pictures ([`studio`],
//! [`preview`]) and the views ([`view`]) need no graphics; the feature `window` adds the code that draws them.
#![forbid(unsafe_code)]

pub mod catalogue;
pub mod editing;
pub mod export;
pub mod file_watch;
pub mod files;
pub mod platform;
pub mod preview;
pub mod recovery;
pub mod settings;
pub mod studio;
#[cfg(target_arch = "wasm32")]
pub mod tasks;
pub mod view;
#[cfg(feature = "window")]
pub mod window;

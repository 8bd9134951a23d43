//! What differs between a program of a system and a page of a browser: threads, clocks, files, fonts.
//!
//! A browser has one thread for a page. Work is done by a second instance of the program, in a worker, and therefore is
//! data: a [`Task`]. Files are in memory, and those of the studio and of its user are kept in the browser's storage.

#[cfg(not(target_arch = "wasm32"))]
mod native;
mod task;
#[cfg(target_arch = "wasm32")]
mod web;
pub mod wire;

#[cfg(not(target_arch = "wasm32"))]
pub use native::*;
pub use task::Task;
#[cfg(target_arch = "wasm32")]
pub use web::*;

//! Orogen for C: worlds, windows, samplers, chunks around a viewer, and objects.
//!
//! `include/orogen.h` is made from these files. Each function checks its pointers for null, reports errors by a
//! [`status::Status`] with a message of its thread, and lets no panic pass. No two functions share a buffer: the caller
//! owns what it passes, and frees what it receives by the function that is named there.
#![allow(clippy::missing_safety_doc, reason = "the contract of all functions is at the head of the header")]

pub mod chunks;
mod handle;
pub mod objects;
pub mod sampler;
pub mod status;
pub mod world;

//! Orogen in Godot 4: `OrogenWorld` opens worlds and reads them, `OrogenChunks` makes chunks of ground around a viewer
//! on other threads.
//!
//! Axes are those of Godot: x east, y up, z south, in metres. What computes stands in `orogen-engine-ground`; this
//! library converts arrays.

mod chunks;
mod world;

use godot::prelude::*;

/// The library that Godot loads.
struct OrogenLibrary;

// SAFETY: the trait has no method that is implemented here.
#[gdextension]
unsafe impl ExtensionLibrary for OrogenLibrary {}

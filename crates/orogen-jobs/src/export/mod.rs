//! Export of layers to files, with one registry of formats for every front end.
//!
//! A [`format::Format`] declares its name, extensions, options and memory, and a function that writes it from a
//! [`layer_source::LayerSource`]: a layer over a window, in bands of rows from the north, or as a whole. Output goes
//! through `Files`, which puts either all files of an export in place at the end, or none. [`registry`] lists the
//! formats, and a [`job::ExportJob`] exports; a [`targets::job::EngineJob`] exports for a game engine.
//!
//! ```
//! use orogen_io::file::OutputPolicy;
//! use orogen_jobs::export::{job::ExportJob, registry};
//! use orogen_engine::{Progress, Window, World};
//!
//! let mut recipe = orogen_engine::presets::find("hills").ok_or("no such preset")?.recipe()?;
//! let path = std::env::temp_dir().join(format!("orogen-doc-{}.npy", std::process::id()));
//! let job = ExportJob::new(registry::of_path(&path)?).with_layer("slope").with_window(Window::new(100, 80, 20.0));
//! job.prepare(&mut recipe)?;
//! let world = World::open(recipe)?;
//! job.to_file(&world, &OutputPolicy::default().output(&path)?, &Progress::none())?;
//! # std::fs::remove_file(&path).ok();
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[doc(hidden)]
pub mod biome_cover;
#[doc(hidden)]
pub mod channels;
#[doc(hidden)]
pub mod contour_options;
pub(crate) mod contours;
#[doc(hidden)]
pub mod derived;
#[doc(hidden)]
pub mod features;
pub(crate) mod files;
#[doc(hidden)]
pub mod format;
pub(crate) mod formats;
#[doc(hidden)]
pub mod job;
#[doc(hidden)]
pub mod layer_source;
pub(crate) mod memory;
#[doc(hidden)]
pub mod mesh;
#[doc(hidden)]
pub mod mesh_cover;
pub(crate) mod mesh_objects;
#[doc(hidden)]
pub mod mesh_tint;
pub(crate) mod mesh_water;
#[doc(hidden)]
pub mod place;
pub(crate) mod print_bed;
#[doc(hidden)]
pub mod quantizer;
#[doc(hidden)]
pub mod registry;
pub(crate) mod run;
#[doc(hidden)]
pub mod sheet_cover;
pub(crate) mod sidecar;
pub(crate) mod solid;
#[doc(hidden)]
pub mod targets;
pub(crate) mod vectors;
pub(crate) mod weights_preview;
mod world_export;

pub use format::Format;
pub use job::ExportJob;
#[doc(hidden)]
pub use layer_source::LayerSource;
pub use registry::{all, named, of_path};
pub use world_export::Export;

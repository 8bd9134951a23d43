//! Export of layers to files, with one registry of formats for every front end.
//!
//! A [`format::Format`] declares its name, extensions, options and memory, and a function that writes it from a
//! [`layer_source::LayerSource`]: a layer over a window, in bands of rows from the north, or as a whole. Output goes
//! through `Files`, which puts all files of an export in place at the end, or none. [`registry`] lists the
//! formats, and a [`job::ExportJob`] exports; a [`targets::job::EngineJob`] exports for an engine.
//!
//! ```
//! use orogen_io::file::OutputPolicy;
//! use orogen_jobs::export::{job::ExportJob, registry};
//! use orogen_engine::{Progress, Window, World};
//!
//! let world = World::open(orogen_engine::presets::find("hills").ok_or("no such preset")?.recipe()?)?;
//! let path = std::env::temp_dir().join(format!("orogen-doc-{}.npy", std::process::id()));
//! let job = ExportJob::new(registry::of_path(&path)?).with_layer("slope").with_window(Window::new(100, 80, 20.0));
//! job.to_file(&world, &OutputPolicy::default().output(&path)?, &Progress::none())?;
//! # std::fs::remove_file(&path).ok();
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod biome_cover;
pub mod channels;
pub mod contour_options;
pub(crate) mod contours;
pub mod derived;
pub mod features;
pub(crate) mod files;
pub mod format;
pub(crate) mod formats;
pub mod job;
pub mod layer_source;
pub(crate) mod memory;
pub mod mesh;
pub mod mesh_cover;
pub(crate) mod mesh_objects;
pub mod mesh_tint;
pub(crate) mod mesh_water;
pub mod place;
pub(crate) mod print_bed;
pub mod quantizer;
pub mod registry;
pub(crate) mod run;
pub mod sheet_cover;
pub(crate) mod sidecar;
pub(crate) mod solid;
pub mod targets;
pub(crate) mod vectors;
pub(crate) mod weights_preview;

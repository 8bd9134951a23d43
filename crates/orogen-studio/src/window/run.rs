//! The start of the window.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use eframe::egui::ViewportBuilder;

use super::app::App;
use crate::files;
use crate::settings::Settings;
use crate::studio::open;

/// Design terrain by looking at it.
#[derive(Debug, Parser)]
#[command(name = "orogen-studio", version)]
struct Arguments {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...) [default: the start page]
    recipe: Option<PathBuf>,
}

/// The size of the window at first, and at least.
const SIZES: [[f32; 2]; 2] = [[1280.0, 800.0], [480.0, 320.0]];

/// Opens the window, and returns once it is closed.
#[must_use]
pub fn run() -> ExitCode {
    let arguments = Arguments::parse();
    let folder = files::settings_folder();
    let settings = Settings::read(folder.as_deref());
    let document = match arguments.recipe.as_deref().map(open).transpose() {
        Ok(document) => document,
        Err(error) => return fail(&error.to_string()),
    };
    let viewport = ViewportBuilder::default()
        .with_title("Orogen")
        .with_app_id("orogen-studio")
        .with_inner_size(settings.window.unwrap_or(SIZES[0]))
        .with_min_inner_size(SIZES[1]);
    let options = eframe::NativeOptions { viewport, ..eframe::NativeOptions::default() };
    let start = move |context: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, Box<dyn std::error::Error + Send + Sync>> {
        Ok(Box::new(App::new(context, settings, folder, document)?))
    };
    match eframe::run_native("orogen-studio", options, Box::new(start)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&format!(
            "cannot open a window: {error}. The studio needs a display and a driver for Vulkan, Metal, DirectX 12 or OpenGL; on Linux without a \
             graphics card install Mesa's software driver (mesa-vulkan-drivers). All else works without it: `orogen generate`, `orogen map`"
        )),
    }
}

#[allow(clippy::print_stderr, reason = "there is no window to say it in")]
fn fail(message: &str) -> ExitCode {
    eprintln!("error: {message}");
    ExitCode::FAILURE
}

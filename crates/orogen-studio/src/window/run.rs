//! The start of the window.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::Parser;
use eframe::egui::ViewportBuilder;
use orogen::device_choice::DeviceChoice;
use orogen_gpu::Gpu;

use super::app::{App, Start};
use super::device::DeviceWatch;
use super::restart;
use crate::files;
use crate::settings::Settings;
use crate::studio::open;

/// Design terrain interactively.
#[derive(Debug, Parser)]
#[command(name = "orogen-studio", version)]
struct Arguments {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...) [default: the start page]
    recipe: Option<PathBuf>,
    /// Where previews are computed: cpu, gpu, gpu:NAME or auto; exports are always computed by the processor
    #[arg(long, value_name = "DEVICE", default_value_t)]
    device: DeviceChoice,
    /// The program was started again because the graphics device of the run before was lost
    #[arg(long, hide = true)]
    after_loss: bool,
    /// Lose the graphics device after so many seconds, for tests
    #[arg(long, hide = true, value_name = "S")]
    lose_device: Option<f64>,
}

/// Initial and minimum size of the window.
const SIZES: [[f32; 2]; 2] = [[1280.0, 800.0], [480.0, 320.0]];

/// A device that is lost this soon after the previous one is not worth another try.
const SOON: Duration = Duration::from_secs(30);

/// Opens the window, and returns once it is closed.
#[must_use]
pub fn run() -> ExitCode {
    let arguments = Arguments::parse();
    let folder = files::settings_folder();
    let settings = Settings::read(folder.as_deref());
    let document = match arguments.recipe.as_deref().map(open).transpose() {
        Ok(document) => document,
        // A text without a file, which was stored for recovery.
        Err(_) if arguments.after_loss => None,
        Err(error) => return fail(&error.to_string()),
    };
    let gpu = Gpu::chosen(&arguments.device, Some(settings.memory / 8)).unwrap_or_else(|failure| {
        note(&format!("{failure}; the processor computes instead"));
        None
    });
    let viewport = ViewportBuilder::default()
        .with_title("Orogen")
        .with_app_id("orogen-studio")
        .with_inner_size(settings.window.unwrap_or(SIZES[0]))
        .with_min_inner_size(SIZES[1]);
    // The interface has no gradients that need dithering, which takes a CPU time for each pixel.
    let options = eframe::NativeOptions { viewport, dithering: false, ..eframe::NativeOptions::default() };
    let watch = DeviceWatch::default();
    let begin = Start {
        settings,
        folder,
        document,
        gpu,
        watch: watch.clone(),
        is_after_loss: arguments.after_loss,
        lose_device: arguments.lose_device,
        message: None,
    };
    let start = move |context: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, Box<dyn std::error::Error + Send + Sync>> {
        Ok(Box::new(App::new(context, begin)?))
    };
    let end = End { watch, is_after_loss: arguments.after_loss, begun: Instant::now() };
    let at_panic = end.clone();
    let print_panic = std::panic::take_hook();
    // The code that draws the window panics in the same frame when its device is lost; the text was stored before. A
    // panic hook is used, because the release profile does not unwind.
    std::panic::set_hook(Box::new(move |panic| {
        print_panic(panic);
        std::process::exit(at_panic.conclude(None));
    }));
    let ended = eframe::run_native("orogen-studio", options, Box::new(start));
    if end.conclude(Some(ended.map_err(|error| error.to_string()))) == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// State that is needed when the window ends.
#[derive(Clone)]
struct End {
    watch: DeviceWatch,
    is_after_loss: bool,
    /// When the window was opened.
    begun: Instant,
}

impl End {
    /// Restarts the studio if its device was lost, and otherwise reports why it ended; returns the exit code. `ended`
    /// is `None` after a panic.
    fn conclude(&self, ended: Option<Result<(), String>>) -> i32 {
        let lost = self.watch.lost();
        let message = match (lost, ended) {
            (Some(why), _) if self.is_after_loss && self.begun.elapsed() < SOON => format!(
                "the graphics device was lost again ({why}). Changes that were not saved are kept, and offered at the next start. Check the driver of the \
                 graphics card; WGPU_BACKEND=gl or Mesa's software driver may help"
            ),
            (Some(_), _) => restart::again(self.watch.document().as_deref()),
            (None, Some(Ok(()))) => return 0,
            (None, Some(Err(error))) => format!(
                "cannot open a window: {error}. The studio needs a display and a driver for Vulkan, Metal, DirectX 12 or OpenGL; on Linux without a \
                 graphics card install Mesa's software driver (mesa-vulkan-drivers). All else works without it: `orogen generate`, `orogen map`"
            ),
            (None, None) => "the studio ended because of an internal error, which is printed above; please report it. Changes that were not saved are \
                 kept, and offered at the next start"
                .to_owned(),
        };
        note(&format!("error: {message}"));
        1
    }
}

fn fail(message: &str) -> ExitCode {
    note(&format!("error: {message}"));
    ExitCode::FAILURE
}

#[allow(clippy::print_stderr, reason = "there is no window to say it in")]
fn note(message: &str) {
    eprintln!("{message}");
}

//! The start of the window in a page.

use std::path::Path;

use eframe::egui_wgpu::{WgpuSetup, wgpu};
use eframe::{WebOptions, WebRunner};
use js_sys::Function;
use orogen::Result;
use orogen::recipe::source;
use web_sys::HtmlCanvasElement;

use super::app::{App, Start};
use crate::catalogue::Language;
use crate::editing::document::Document;
use crate::files;
use crate::platform::{self, query};
use crate::settings::Settings;
use crate::studio::open;

/// Opens the window in a canvas. The address of the page may have a `preset`, or a recipe to `open`, and a language
/// (`lang`). `held` are the locks of the browser that other pages of the site have, and `hold` takes one by its name.
/// It is drawn with WebGPU if `with_webgpu`, otherwise with WebGL 2.
///
/// # Errors
/// If the browser cannot draw. It may be tried again in another canvas.
pub async fn run(
    canvas: HtmlCanvasElement,
    held: &[String],
    hold: Function,
    with_webgpu: bool,
) -> std::result::Result<(), String> {
    platform::prepare();
    platform::begin(held, hold);
    let folder = files::settings_folder();
    let mut settings = Settings::read(folder.as_deref());
    if let Some(language) = query("lang").as_deref().and_then(Language::of_code) {
        settings.language = Some(language);
    }
    let (document, message) = match asked().await {
        Ok(document) => (document, None),
        Err(message) => (None, Some(message)),
    };
    let begin = Start { settings, folder, document, message, ..Start::default() };
    let mut options = WebOptions { dithering: false, ..WebOptions::default() };
    if let WgpuSetup::CreateNew(setup) = &mut options.wgpu_options.wgpu_setup {
        setup.instance_descriptor.backends =
            if with_webgpu { wgpu::Backends::BROWSER_WEBGPU } else { wgpu::Backends::GL };
    }
    let runner = WebRunner::new();
    let start = runner.start(canvas, options, Box::new(|context| Ok(Box::new(App::new(context, begin)?))));
    start.await.map_err(|cause| cause.as_string().unwrap_or_else(|| format!("{cause:?}")))
}

/// The document that the address of the page asks for.
async fn asked() -> std::result::Result<Option<Document>, String> {
    if let Some(name) = query("preset") {
        let preset = source::preset(&name).and_then(Document::of_preset);
        return preset.map(Some).map_err(|error| error.to_string());
    }
    match query("open") {
        Some(address) => {
            let path = platform::fetch(&address).await?;
            fetched(&path).map(Some).map_err(|error| error.to_string())
        }
        None => Ok(None),
    }
}

/// The document of a file of the host. A recipe is opened like a preset, so that it replaces nothing that was saved.
fn fetched(path: &Path) -> Result<Document> {
    if path.extension().is_none_or(|extension| extension != "toml") {
        return open(path);
    }
    let text = files::read(path);
    files::remove(path);
    Document::new(&path.file_stem().unwrap_or_default().to_string_lossy(), text?)
}

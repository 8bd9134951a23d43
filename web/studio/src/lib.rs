//! The studio of Orogen as a page: what its scripts call.

use js_sys::Function;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;
use web_sys::HtmlCanvasElement;

/// Opens the window in a canvas. `held` are the locks that other pages of the site have, and `hold` takes one by its
/// name. It is drawn with WebGPU if `with_webgpu`, otherwise with WebGL 2.
///
/// # Errors
/// If the browser cannot draw. It may be tried again in another canvas.
#[wasm_bindgen]
pub async fn run(
    canvas: HtmlCanvasElement,
    held: Vec<String>,
    hold: Function,
    with_webgpu: bool,
) -> Result<(), JsValue> {
    orogen_studio::window::page::run(canvas, &held, hold, with_webgpu).await.map_err(JsValue::from)
}

/// Takes a message of the page, in a worker.
#[wasm_bindgen]
pub fn work(message: &JsValue) {
    orogen_studio::platform::work(message, orogen_studio::tasks::run);
}

/// Lends the thread of a worker to the instance whose memory it shares. Never returns.
#[cfg(target_feature = "atomics")]
#[wasm_bindgen]
pub fn lend() {
    orogen_studio::platform::lend();
}

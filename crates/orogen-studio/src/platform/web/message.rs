//! Messages between the page and its workers.

use js_sys::Array;
use wasm_bindgen::JsValue;

/// The parts of a message.
pub fn array(parts: &[JsValue]) -> Array {
    parts.iter().cloned().collect()
}

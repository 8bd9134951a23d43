//! The JSON Schema of `surface`.

use serde_json::{Value as Json, json};

use super::document::{DEFAULT_GRAIN, DEFAULT_ROUGHNESS, MAX_COLORS, MAX_SURFACES};
use crate::recipe::condition::schema::{any, conditions};

/// The schema of the list.
pub fn list() -> Json {
    let color = json!({ "type": "string", "description": "A color: #rrggbb, #rgb or a name." });
    let name = json!({ "type": "string", "pattern": "^[A-Za-z0-9_-]{1,64}$" });
    let mut properties = conditions();
    let own = json!({
        "name": { "description": "Name of the surface and of its weight map. Surfaces with the same name share a weight map.", "allOf": [name] },
        "color": color,
        "gradient": {
            "type": "array", "minItems": 2, "maxItems": MAX_COLORS, "items": color,
            "description": "Colors of a gradient over noise, height, slope or a layer, mixed in Oklab.",
        },
        "picture": {
            "type": "string",
            "description": "Path of a .png, such as a satellite picture. Its colors are used in proportion to their frequency in the picture.",
        },
        "along": { "type": "string", "default": "noise", "description": "Quantity of the gradient: `noise`, `height`, `slope` or the name of a node." },
        "span": {
            "type": "array", "minItems": 2, "maxItems": 2, "items": { "type": "number" },
            "description": "Values of the first and the last color, in the unit of the gradient's quantity.",
        },
        "grain": { "type": "number", "minimum": 1e-3, "maximum": 1e9, "default": DEFAULT_GRAIN, "description": "Wavelength of the gradient's noise. Unit: m." },
        "roughness": { "type": "number", "minimum": 0, "maximum": 1, "default": DEFAULT_ROUGHNESS, "description": "0 is a mirror, 1 is matt." },
        "opacity": { "type": "number", "minimum": 0, "maximum": 1, "default": 1, "description": "Maximum share of the surface." },
        "any": any(),
        "mask": { "description": "A node, a layer or a number that multiplies the share.", "allOf": [{ "$ref": "#/definitions/input" }] },
    });
    if let (Some(all), Some(own)) = (properties.as_object_mut(), own.as_object()) {
        all.extend(own.clone());
    }
    json!({
        "type": "array",
        "maxItems": MAX_SURFACES,
        "description": "Surfaces that cover the ground, from bottom to top. Each covers those before it where its conditions hold; the first one is everywhere.",
        "items": {
            "type": "object",
            "required": ["name"],
            "additionalProperties": false,
            "properties": properties,
        },
    })
}

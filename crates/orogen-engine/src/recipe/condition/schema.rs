//! The JSON Schema of conditions.

use serde_json::{Map, Value as Json, json};

use super::document::MAX_ALTERNATIVES;
use super::read::CONDITIONS;

/// The schema of `any`.
pub fn any() -> Json {
    let properties: Map<String, Json> = CONDITIONS.into_iter().map(String::from).zip(conditions()).collect();
    json!({
        "type": "array", "minItems": 1, "maxItems": MAX_ALTERNATIVES,
        "items": { "type": "object", "additionalProperties": false, "minProperties": 1, "properties": properties },
        "description": "Alternatives: the largest share of them is used.",
    })
}

/// The schemas of conditions, in the order of their keys.
pub fn conditions() -> [Json; CONDITIONS.len()] {
    let range = |about: &str, more: Json| {
        let number = json!({ "type": "number" });
        let pair = json!({ "type": "array", "minItems": 2, "maxItems": 2, "items": number });
        let mut properties = json!({
            "min": { "type": "number", "description": "Lower bound." },
            "max": { "type": "number", "description": "Upper bound." },
            "fade": { "anyOf": [number, pair], "description": "Width of the transition outside the range: one number, or [below, above]." },
        });
        if let (Some(all), Some(more)) = (properties.as_object_mut(), more.as_object()) {
            all.extend(more.clone());
        }
        let table = json!({ "type": "object", "additionalProperties": false, "properties": properties });
        json!({ "anyOf": [pair, table], "description": about })
    };
    let noise = json!({
        "wavelength": { "type": "number", "minimum": 1e-3, "maximum": 1e9, "description": "Unit: m." },
        "octaves": { "type": "integer", "minimum": 1, "maximum": 32, "default": 4 },
        "seed": { "type": "integer", "minimum": 0, "default": 0, "description": "Hashed with the world's seed." },
    });
    let scale = json!({ "scale": { "type": "number", "minimum": 0, "maximum": 1e6, "default": 50, "description": "Distance between the heights that the curvature is computed from. Unit: m." } });
    let layers = json!({
        "type": "object",
        "additionalProperties": range("A node or layer, in its own unit.", json!({})),
        "description": "Conditions on nodes or layers of the recipe, by name.",
    });
    [
        range("Height above the sea. Unit: m.", json!({})),
        range("Slope. Unit: degrees.", json!({})),
        range("Total curvature, positive where the ground is convex. Unit: 1/m.", scale),
        range("Drainage area. `fade` is in powers of ten. Unit: m^2.", json!({})),
        range("Fractal noise, -1 to 1.", noise),
        layers,
    ]
}

//! The JSON Schema of `surface`.

use serde_json::{Value as Json, json};

use super::document::{DEFAULT_GRAIN, DEFAULT_ROUGHNESS, MAX_ALTERNATIVES, MAX_COLORS, MAX_SURFACES};

/// The schema of the list.
pub fn list() -> Json {
    let color = json!({ "type": "string", "description": "A color: #rrggbb, #rgb or a name." });
    let name = json!({ "type": "string", "pattern": "^[A-Za-z0-9_-]{1,64}$" });
    let mut properties = conditions();
    let own = json!({
        "name": { "description": "Name of the surface and of its weight map. Surfaces of one name share a weight map.", "allOf": [name] },
        "color": color,
        "gradient": {
            "type": "array", "minItems": 2, "maxItems": MAX_COLORS, "items": color,
            "description": "Colors, mixed in Oklab along noise, the height, the slope or a layer.",
        },
        "picture": {
            "type": "string",
            "description": "Path of a .png, such as a satellite picture: its colors are used as often as they occur in it.",
        },
        "along": { "type": "string", "default": "noise", "description": "What a gradient follows: noise, height, slope, or a node's name." },
        "span": {
            "type": "array", "minItems": 2, "maxItems": 2, "items": { "type": "number" },
            "description": "Values of the first and the last color, in the unit of what the gradient follows.",
        },
        "grain": { "type": "number", "minimum": 1e-3, "maximum": 1e9, "default": DEFAULT_GRAIN, "description": "Wavelength of the noise that the gradient follows. Unit: m." },
        "roughness": { "type": "number", "minimum": 0, "maximum": 1, "default": DEFAULT_ROUGHNESS, "description": "0 is a mirror, 1 is matt." },
        "opacity": { "type": "number", "minimum": 0, "maximum": 1, "default": 1, "description": "Greatest share of the surface." },
        "any": {
            "type": "array", "minItems": 1, "maxItems": MAX_ALTERNATIVES,
            "items": { "type": "object", "additionalProperties": false, "minProperties": 1, "properties": conditions() },
            "description": "Alternatives: the one that holds best counts.",
        },
        "mask": { "description": "A node, a layer or a number that the share is multiplied with.", "allOf": [{ "$ref": "#/definitions/input" }] },
    });
    if let (Some(all), Some(own)) = (properties.as_object_mut(), own.as_object()) {
        all.extend(own.clone());
    }
    json!({
        "type": "array",
        "maxItems": MAX_SURFACES,
        "description": "What covers the ground, bottom to top: each surface covers those before it where its conditions hold; the first lies everywhere.",
        "items": {
            "type": "object",
            "required": ["name"],
            "additionalProperties": false,
            "properties": properties,
        },
    })
}

/// The conditions' part.
fn conditions() -> Json {
    let range = |about: &str, more: Json| {
        let number = json!({ "type": "number" });
        let pair = json!({ "type": "array", "minItems": 2, "maxItems": 2, "items": number });
        let mut properties = json!({
            "min": { "type": "number", "description": "Lower end." },
            "max": { "type": "number", "description": "Upper end." },
            "fade": { "anyOf": [number, pair], "description": "How far outside the range the share falls to 0: one number, or [below, above]." },
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
    let scale = json!({ "scale": { "type": "number", "minimum": 0, "maximum": 1e6, "default": 50, "description": "Metres between the heights it is taken from." } });
    json!({
        "height": range("Height above the sea. Unit: m.", json!({})),
        "slope": range("Slope. Unit: degrees.", json!({})),
        "curvature": range("Total curvature, positive where the ground is convex. Unit: 1/m.", scale),
        "flow": range("Drainage area; its fade is in powers of ten. Unit: m^2.", json!({})),
        "noise": range("Fractal noise, -1 to 1.", noise),
        "layers": {
            "type": "object",
            "additionalProperties": range("A node or layer, in its own unit.", json!({})),
            "description": "Conditions on nodes or layers of the recipe, by name.",
        },
    })
}

//! The JSON Schema of `scatter`.

use serde_json::{Value as Json, json};

use super::document::{MAX_SCATTERS, SIZES, SPACINGS};
use crate::recipe::condition::schema::{any, conditions};

/// The schema of the list.
pub fn list() -> Json {
    let mut properties = conditions();
    let size = json!({ "type": "number", "minimum": SIZES[0], "maximum": SIZES[1] });
    let own = json!({
        "name": { "type": "string", "pattern": "^[A-Za-z0-9_-]{1,64}$", "description": "Name of the kind of objects." },
        "spacing": {
            "type": "number", "minimum": SPACINGS[0], "maximum": SPACINGS[1],
            "description": "Smallest distance of two objects of this entry. Unit: m.",
        },
        "density": {
            "description": "Number of objects as a share of the greatest possible one, 0 to 1: a node, a layer or a number. Default: 1.",
            "allOf": [{ "$ref": "#/definitions/input" }],
        },
        "size": {
            "anyOf": [size, { "type": "array", "minItems": 2, "maxItems": 2, "items": size }],
            "description": "Scale factor: one number, or [smallest, largest]. Default: 1.",
        },
        "turn": {
            "anyOf": [{ "type": "string", "enum": ["random"] }, { "type": "number", "minimum": 0, "exclusiveMaximum": 360 }],
            "default": "random",
            "description": "Turn about the vertical axis: `random`, or degrees clockwise seen from above.",
        },
        "water": {
            "type": "string", "enum": ["avoid", "any", "only"], "default": "avoid",
            "description": "Whether objects stand in the sea and in the lakes of the output `lakes`.",
        },
        "clearance": {
            "type": "number", "minimum": 0, "maximum": 1e6,
            "description": "Smallest distance to the objects of the entries before this one. Unit: m. Default: `spacing`.",
        },
        "cell": {
            "type": "number", "minimum": 1e-4, "maximum": 1e7,
            "description": "Cell at which conditions are computed. Unit: m. Default: the world's.",
        },
        "seed": { "type": "integer", "minimum": 0, "description": "Hashed with the world's seed. Default: the number of the entry, from 0." },
        "any": any(),
        "mask": { "description": "A node, a layer or a number that multiplies the density.", "allOf": [{ "$ref": "#/definitions/input" }] },
    });
    if let (Some(all), Some(own)) = (properties.as_object_mut(), own.as_object()) {
        all.extend(own.clone());
    }
    json!({
        "type": "array",
        "maxItems": MAX_SCATTERS,
        "description": "Objects that stand on the ground where their conditions hold, such as trees. Each entry keeps a distance to the objects of those before it.",
        "items": {
            "type": "object",
            "required": ["name", "spacing"],
            "additionalProperties": false,
            "properties": properties,
        },
    })
}

//! The JSON Schema of `class`.

use serde_json::{Value as Json, json};

use super::document::MAX_CLASSES;
use crate::recipe::condition::schema::{any, conditions};

/// The schema of the list.
pub fn list() -> Json {
    let mut properties = conditions();
    let part = |about: &str| json!({ "type": "number", "minimum": 0, "maximum": 1, "description": about });
    let end = |key: &str| json!({ "required": [key] });
    let own = json!({
        "name": { "type": "string", "pattern": "^[A-Za-z0-9_-]{1,64}$", "description": "Name of the class. `orogen tilemap` draws it with the tileset's terrain of this name." },
        "color": { "type": "string", "description": "A color: #rrggbb, #rgb or a name. Default: one by the name or the number of the class." },
        "any": any(),
        "mask": { "description": "A node, a layer or a number that multiplies the share.", "allOf": [{ "$ref": "#/definitions/input" }] },
        "share": {
            "type": "object",
            "required": ["of"],
            "oneOf": [end("lowest"), end("highest")],
            "additionalProperties": false,
            "properties": {
                "of": { "type": "string", "description": "What cells are ordered by: `height`, or the name of a node or layer." },
                "lowest": part("The class takes this share of all cells from the lowest values."),
                "highest": part("The class takes this share of all cells from the highest values."),
            },
            "description": "An exact share of all cells of a bounded world, selected among the cells where the conditions hold.",
        },
    });
    if let (Some(all), Some(own)) = (properties.as_object_mut(), own.as_object()) {
        all.extend(own.clone());
    }
    json!({
        "type": "array",
        "minItems": 1,
        "maxItems": MAX_CLASSES,
        "description": "Terrain classes. The first one is everywhere; each takes the cells where its conditions hold, and covers those before it.",
        "items": {
            "type": "object",
            "required": ["name"],
            "additionalProperties": false,
            "properties": properties,
        },
    })
}

//! The JSON Schema of recipes, made from the declarations.

use super::document::VERSION;
use super::{class, parameters, scatter, subgraph, surface, world_spec};
use crate::registry::Registry;
use orogen_grid::words::respelled;
use orogen_ops::declare::point_lists::MAX_POINTS;
use orogen_ops::declare::{ParamSpec, Shape, TableSpec, short};
use orogen_ops::node::Node;
use orogen_ops::value::Value;
use serde_json::{Map, Value as Json, json};
use std::collections::BTreeMap;

/// The JSON Schema (draft 7) of recipes of built-in ops, with which editors check recipes.
#[must_use]
pub fn json_schema() -> Json {
    json_schema_of(&Registry::new())
}

/// The schema of recipes of these ops.
#[must_use]
pub fn json_schema_of(registry: &Registry) -> Json {
    let name = json!({ "type": "string", "pattern": "^[A-Za-z_][A-Za-z0-9_-]{0,63}$" });
    let mut world = world_spec::KEYS.schema();
    world["description"] = json!("Seed, size and cell size of the world.");
    let mut schema = json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Orogen recipe",
        "description": "A world: its nodes and its outputs.",
        "type": "object",
        "required": ["orogen", "outputs"],
        "additionalProperties": false,
        "properties": {
            "$schema": { "type": "string", "description": "The schema of this document, for editors." },
            "orogen": { "const": VERSION, "description": "The version of recipes this one is written in." },
            "about": { "type": "string", "description": "One message about the world." },
            "parameters": parameters_schema(&name),
            "world": world,
            "nodes": {
                "type": "object",
                "description": "The nodes by name.",
                "propertyNames": { "type": "string", "pattern": "^[A-Za-z_][A-Za-z0-9_/-]*$" },
                "additionalProperties": { "$ref": "#/definitions/node" },
            },
            "use": uses_schema(&name),
            "outputs": {
                "type": "object",
                "description": "Outputs of the world: layer names with the node (or node.layer) that they show. Maps are made from \
                                `height`.",
                "minProperties": 1,
                "propertyNames": name,
                "additionalProperties": { "$ref": "#/definitions/input" },
            },
            "surface": surface::list::SURFACES.schema(),
            "scatter": scatter::list::SCATTERS.schema(),
            "class": class::list::CLASSES.schema(),
            "studio": { "type": "object", "description": "What the studio keeps with the recipe. It has no effect on the world." },
        },
        "definitions": {
            "input": {
                "anyOf": [
                    { "type": "string", "pattern": "^[A-Za-z_][A-Za-z0-9_/-]*(\\.[A-Za-z0-9_-]+)?$" },
                    { "type": "number" },
                ],
            },
            "node": node_schema(&registry.nodes()),
        },
    });
    for part in ["properties", "definitions"] {
        let parts = schema[part].as_object_mut().into_iter().flatten();
        parts
            .filter(|(name, _)| !matches!(name.as_str(), "orogen" | "parameters" | "studio"))
            .for_each(|(_, part)| take_formulas(part));
    }
    schema
}

/// The pattern of a formula.
const FORMULA: &str = "^\\s*=";

/// Allows a formula in place of every number.
fn take_formulas(schema: &mut Json) {
    match schema {
        Json::Object(keys) => {
            if let Some(kind) =
                keys.get("type").and_then(Json::as_str).filter(|kind| matches!(*kind, "number" | "integer"))
            {
                let kinds = json!([kind, "string"]);
                keys.insert("type".into(), kinds);
                keys.insert("pattern".into(), json!(FORMULA));
            }
            keys.values_mut().for_each(take_formulas);
        }
        Json::Array(items) => items.iter_mut().for_each(take_formulas),
        _ => {}
    }
}

/// The schema of `[parameters]`.
fn parameters_schema(name: &Json) -> Json {
    let mut name = name.clone();
    name["pattern"] = json!("^[A-Za-z_][A-Za-z0-9_]{0,63}$");
    json!({
        "type": "object",
        "description": "Numbers that the recipe offers, by name. A string that begins with `=` is a formula of them, wherever a number can stand; \
                        `--set NAME=VALUE` gives them other values.",
        "propertyNames": name,
        "additionalProperties": { "anyOf": [{ "type": "number" }, parameters::KEYS.schema()] },
    })
}

/// The schema of `[use]`.
fn uses_schema(name: &Json) -> Json {
    json!({
        "type": "object",
        "description": "Other recipes that this one includes, by name. `NAME.layer` is one of their outputs, `NAME` is their `height`.",
        "propertyNames": name,
        "additionalProperties": subgraph::KEYS.schema(),
    })
}

/// The schema of a node, chosen by its op. It uses `if` and `then` instead of `oneOf`, so that an editor reports the
/// wrong key instead of the whole node. All keys of all ops are listed next to them, because editors look for
/// completions there.
fn node_schema(nodes: &[Node]) -> Json {
    let ops: Vec<Json> = nodes
        .iter()
        .map(|node| json!({ "if": { "properties": { "op": op_name(node.spec().op) } }, "then": op_schema(node) }))
        .collect();
    let mut keys: BTreeMap<&str, Vec<(&str, String)>> = BTreeMap::new();
    for spec in nodes.iter().map(Node::spec) {
        let inputs = spec.inputs.iter().map(|input| (input.name, input.doc));
        for (key, doc) in inputs.chain(spec.params.iter().map(|param| (param.name, param.doc))) {
            keys.entry(key).or_default().push((spec.op, short(doc)));
        }
    }
    let mut properties: Map<String, Json> =
        keys.into_iter().map(|(key, docs)| (key.to_string(), json!({ "description": joined(&docs) }))).collect();
    let names: Vec<String> = nodes.iter().flat_map(|node| spellings(node.spec().op)).collect();
    properties.insert("op".into(), json!({ "enum": names, "description": "What the node does." }));
    properties.insert("mask".into(), mask_schema());
    json!({ "type": "object", "required": ["op"], "properties": properties, "allOf": ops })
}

/// All accepted spellings of a name, the canonical one first.
fn spellings(name: &str) -> Vec<String> {
    [name.to_string()].into_iter().chain(respelled(name)).collect()
}

/// The name of an op, in any of its spellings.
fn op_name(op: &str) -> Json {
    match spellings(op).as_slice() {
        [one] => json!({ "const": one }),
        several => json!({ "enum": several }),
    }
}

/// The description of a key: once if it is the same in all ops, otherwise per op.
fn joined(docs: &[(&str, String)]) -> String {
    match docs {
        [(_, first), others @ ..] if others.iter().all(|(_, doc)| doc == first) => first.clone(),
        _ => docs.iter().map(|(op, doc)| format!("{op}: {doc}")).collect::<Vec<_>>().join("\n"),
    }
}

fn mask_schema() -> Json {
    json!({
        "description": "Weight of the op, 0 to 1: 1 is its full effect, 0 none (the result is its first input, or 0).",
        "allOf": [{ "$ref": "#/definitions/input" }],
    })
}

fn op_schema(node: &Node) -> Json {
    let spec = node.spec();
    let mut properties = Map::new();
    let mut about = spec.doc.split("\n\n").map(short).collect::<Vec<_>>().join("\n\n");
    if spec.layers.len() > 1 {
        about.push_str("\n\nLayers:");
        for layer in spec.layers {
            about.push_str(&format!("\n`{}`: {}", layer.name, short(layer.doc)));
        }
    }
    let mut op = op_name(spec.op);
    op["description"] = json!(about);
    properties.insert("op".into(), op);
    for input in spec.inputs {
        properties.insert(
            input.name.into(),
            json!({ "description": short(input.doc), "allOf": [{ "$ref": "#/definitions/input" }] }),
        );
    }
    for (i, param) in spec.params.iter().enumerate() {
        let schema = param_schema(param, Some(&node.param(i)));
        properties.extend(spellings(param.name).into_iter().map(|name| (name, schema.clone())));
    }
    for (alias, name) in spec.aliases() {
        if let Some(mut schema) = properties.get(name).cloned() {
            schema["description"] = json!(format!("Another name of `{name}`."));
            schema["deprecated"] = json!(true);
            properties.insert(alias.into(), schema);
        }
    }
    properties.insert("mask".into(), mask_schema());
    // Names in an expression are inputs, so any key is valid.
    let others = if spec.named_inputs { json!({ "$ref": "#/definitions/input" }) } else { json!(false) };
    let required: Vec<&str> =
        ["op"].into_iter().chain(spec.inputs.iter().filter(|input| input.required).map(|input| input.name)).collect();
    json!({
        "title": spec.op,
        "description": short(spec.doc),
        "type": "object",
        "required": required,
        "additionalProperties": others,
        "properties": properties,
    })
}

fn param_schema(spec: &ParamSpec, default: Option<&Value>) -> Json {
    let mut number = json!({ "type": "number" });
    for (key, bound) in [("minimum", spec.range[0]), ("maximum", spec.range[1])] {
        if bound.is_finite() {
            number[key] = json!(bound);
        }
    }
    let mut schema = match spec.shape {
        Shape::Number => number,
        Shape::Integer => {
            number["type"] = json!("integer");
            number
        }
        Shape::Seed => json!({ "type": "integer", "minimum": 0 }),
        Shape::Flag => json!({ "type": "boolean" }),
        Shape::Choice(choices) => json!({
            "oneOf": choices().iter().map(|(name, doc)| json!({ "const": name, "description": short(doc) })).collect::<Vec<_>>(),
        }),
        Shape::File | Shape::Expression => json!({ "type": "string" }),
        Shape::Crs => json!({ "type": "string", "pattern": "^EPSG:[0-9]+$" }),
        Shape::Pair => json!({ "type": "array", "minItems": 2, "maxItems": 2, "items": number }),
        Shape::Points(min) => {
            let point = json!({ "type": "array", "minItems": 2, "maxItems": 3, "items": number });
            let list = json!({ "type": "array", "minItems": min, "maxItems": MAX_POINTS, "items": point });
            json!({ "anyOf": [{ "type": "array", "maxItems": 0 }, list, { "type": "array", "items": list }] })
        }
        Shape::Positions => {
            let point = json!({ "type": "array", "minItems": 2, "maxItems": 2, "items": number });
            json!({ "type": "array", "minItems": 1, "maxItems": MAX_POINTS, "items": point })
        }
        Shape::Tables(table) => json!({ "type": "array", "maxItems": table.max, "items": table_schema(table) }),
        Shape::Curve => json!({
            "type": "array",
            "minItems": 2,
            "items": { "type": "array", "minItems": 2, "maxItems": 2, "items": number },
        }),
    };
    let unit = if spec.unit.is_empty() { String::new() } else { format!(" Unit: {}.", spec.unit) };
    schema["description"] = json!(format!("{}{unit}", short(spec.doc)));
    if let Some(default) = default {
        schema["default"] = plain(default);
    }
    schema
}

fn table_schema(table: &TableSpec) -> Json {
    let names = table.keys.iter().map(|key| key.name);
    let defaults = (table.defaults)();
    let defaults = defaults.iter().map(Some).enumerate();
    let defaults = defaults.map(|(k, default)| default.filter(|_| k >= table.required));
    let properties: Map<String, Json> =
        table.keys.iter().zip(defaults).map(|(key, default)| (key.name.into(), param_schema(key, default))).collect();
    json!({
        "title": table.names[0],
        "type": "object",
        "required": names.take(table.required).collect::<Vec<_>>(),
        "additionalProperties": false,
        "properties": properties,
    })
}

fn plain(value: &Value) -> Json {
    match value {
        Value::Flag(flag) => json!(flag),
        Value::Integer(integer) => json!(integer),
        Value::Number(number) => json!(number),
        Value::Text(text) => json!(text),
        Value::List(items) => Json::Array(items.iter().map(|item| plain(&item.value)).collect()),
        Value::Table(entries) => {
            Json::Object(entries.iter().map(|(key, item)| (key.value.clone(), plain(&item.value))).collect())
        }
        Value::Other(_) => Json::Null,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::document::Recipe;

    /// The node schemas that apply to this op.
    fn taken<'a>(schema: &'a Json, op: &str) -> Vec<&'a Json> {
        let named =
            |name: &Json| name["const"] == op || name["enum"].as_array().is_some_and(|all| all.contains(&json!(op)));
        let node = &schema["definitions"]["node"];
        assert!(named(&node["properties"]["op"]), "`{op}` is not in the list of ops");
        let cases = node["allOf"].as_array().unwrap().iter();
        let cases: Vec<&Json> =
            cases.filter(|case| named(&case["if"]["properties"]["op"])).map(|case| &case["then"]).collect();
        assert!(cases.iter().all(|then| named(&then["properties"]["op"])), "{op}");
        cases
    }

    #[test]
    fn the_schema_takes_every_op_and_key_that_recipes_may_name() {
        let schema = json_schema();
        let diagnostic = |line: &str| match Recipe::parse(
            &format!("orogen = 1\n[nodes.n]\n{line}\n[outputs]\nheight = \"n\"\n"),
            "test.toml",
        ) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        };
        assert!(diagnostic("op = \"normalizes\"").contains("unknown op"), "the test can fail");
        assert!(diagnostic("op = \"fbm\"\ncolor = 1").contains("unknown key"), "the test can fail");
        let mut respellings = 0;
        for node in Node::all() {
            let spec = node.spec();
            for op in spellings(spec.op) {
                assert!(!diagnostic(&format!("op = \"{op}\"")).contains("unknown op"), "{op}");
                let cases = taken(&schema, &op);
                assert_eq!(cases.len(), 1, "{op}");
                let inputs = spec.inputs.iter().map(|input| input.name);
                let keys = inputs.chain(spec.params.iter().map(|param| param.name)).flat_map(spellings);
                for key in keys.chain(spec.aliases().map(|(alias, _)| alias.to_string())) {
                    let read = !diagnostic(&format!("op = \"{op}\"\n{key} = 1")).contains("unknown key");
                    assert_eq!(read, !cases[0]["properties"][&key].is_null(), "{op}.{key}");
                }
                respellings += usize::from(op != spec.op);
            }
        }
        assert!(respellings > 0, "an op with two spellings was tried");
    }

    #[test]
    fn paragraphs_of_descriptions_are_lines() {
        for node in Node::all() {
            let schema = op_schema(&node);
            let about = schema["properties"]["op"]["description"].as_str().unwrap();
            let doc = about.split("\n\nLayers:").next().unwrap();
            assert!(!doc.replace("\n\n", "").contains('\n'), "{about}");
        }
    }
}

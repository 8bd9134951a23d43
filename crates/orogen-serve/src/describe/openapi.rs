//! `/openapi.json`: all requests, for programs (OpenAPI 3.1).

use axum::response::Response;
use orogen::export::derived::list;
use orogen::jobs::vector_tiles::tile_layers;
use orogen::locate::LocateJob;
use orogen::options::OptionSpec;
use serde_json::{Map, Value, json};

use crate::answer;
use crate::call::Call;
use crate::objects;
use crate::places::CELL;
use crate::points::MAX_ALONG;
use crate::query::{SEED, SET};
use crate::refusal::Refusal;
use crate::sent;
use crate::vector;
use crate::windows;

/// A parameter of a request: its name, its schema and what it means.
type Parameter = (&'static str, Value, &'static str);

/// The answer.
pub async fn openapi(call: Call) -> Result<Response, Refusal> {
    call.query.only(&[])?;
    let mut paths = Map::new();
    let single = call.shared.worlds.len() == 1;
    let prefixes: &[&str] = if single { &["", "/{world}"] } else { &["/{world}"] };
    for prefix in prefixes {
        for (path, about, kind, parameters) in requests() {
            paths.insert(format!("{prefix}{path}"), operation(prefix, &path, about, kind, parameters));
        }
    }
    for (path, about, kind) in [
        ("/", "Map of the only world, or list of all worlds", "text/html"),
        ("/healthz", "Whether the server lives; needs no token", "text/plain"),
        ("/metrics", "Counts for Prometheus", "text/plain"),
        ("/openapi.json", "This description", "application/json"),
    ] {
        paths.insert(path.into(), operation("", path, about, kind, Vec::new()));
    }
    if call.shared.limits.allows_recipes {
        paths.insert("/recipes".into(), sending());
    }
    let mut text = json!({
        "openapi": "3.1.0",
        "info": {
            "title": "Orogen",
            "description": "Terrain, computed when it is requested.",
            "version": env!("CARGO_PKG_VERSION"),
            "license": { "name": "MIT OR Apache-2.0", "identifier": "MIT OR Apache-2.0" },
        },
        "servers": [{ "url": "/" }],
        "paths": paths,
        "components": {
            "schemas": { "Error": {
                "type": "object",
                "required": ["error"],
                "properties": { "error": { "type": "string", "description": "What is wrong, where, and what to do" } },
            } },
            "securitySchemes": {
                "bearer": { "type": "http", "scheme": "bearer" },
                "token": { "type": "apiKey", "in": "query", "name": "token" },
            },
        },
    });
    if call.is_private() {
        text["security"] = json!([{ "bearer": [] }, { "token": [] }]);
    }
    answer::text(&call.headers, "application/json", &text.to_string(), call.is_private())
}

/// The requests of a world: path, description, media type and parameters.
fn requests() -> Vec<(String, &'static str, &'static str, Vec<Parameter>)> {
    let grid = || {
        let schema = json!({ "type": "string", "enum": ["web", "world"], "default": "web" });
        vec![("grid", schema, "Grid of tiles: that of web maps, or the square of the world")]
    };
    let layer = || {
        ("layer", json!({ "type": "string", "default": "height" }), "Layer of the recipe, or derived from its heights")
    };
    let number = || json!({ "type": "number" });
    let palette = || ("palette", json!({ "type": "string" }), "Name of a palette; the layer's own if it is left out");
    let with = |mut parameters: Vec<Parameter>, more: Parameter| {
        parameters.push(more);
        parameters
    };
    let surface = || {
        let schema = json!({ "type": "string", "enum": ["ground", "water"], "default": "ground" });
        with(grid(), ("surface", schema, "Heights of the ground, or with a flat sea, also outside the world"))
    };
    let features = || {
        let names: Vec<&str> = tile_layers::ALL.iter().map(|layer| layer.name).collect();
        let about = "Layers, separated by commas; all that the world has if it is left out";
        let text = json!({ "type": "string", "examples": [names.join(",")] });
        let [least, most] = [vector::INTERVALS.start(), vector::INTERVALS.end()];
        let interval = json!({ "type": "number", "minimum": least, "maximum": most });
        let mut all = grid();
        all.extend([(vector::LAYERS, text, about), (vector::INTERVAL, interval, "Contour interval in metres")]);
        all
    };
    let fixed = vec![
        (
            "/tiles/{layer}/{z}/{x}/{y}.png",
            "Tile of a layer in its colors, with relief shading; `{y}@2x.png` has 512 pixels",
            "image/png",
            with(grid(), palette()),
        ),
        ("/terrarium/{z}/{x}/{y}.png", "Tile of heights: 256 R + G + B / 256 - 32768 metres", "image/png", surface()),
        (
            "/terrain-rgb/{z}/{x}/{y}.png",
            "Tile of heights: (65536 R + 256 G + B) / 10 - 10000 metres",
            "image/png",
            surface(),
        ),
        (
            "/vector/{z}/{x}/{y}.mvt",
            "Vector tile: contours, rivers, lakes, summits and objects",
            vector::KIND,
            features(),
        ),
        (
            "/tilejson/{layer}.json",
            "TileJSON of a layer, of `terrarium`, of `terrain-rgb` or of `vector`",
            "application/json",
            with(surface(), palette()),
        ),
        ("/colors/{layer}.json", "Values and their colors, for a legend", "application/json", vec![palette()]),
        ("/world.json", "Size, place, layers, palettes and formats of the world", "application/json", Vec::new()),
        ("/addresses", "Page that lists layers and addresses", "text/html", Vec::new()),
        ("/wmts", "Capabilities of WMTS 1.0.0 with addresses of tiles", "application/xml", Vec::new()),
        (
            "/height",
            "Value of a layer at a point",
            "application/json",
            vec![("x", number(), "Easting, required"), ("y", number(), "Northing, required"), layer()],
        ),
        (
            "/profile",
            "Values of a layer along a line",
            "application/json",
            vec![
                ("points", json!({ "type": "string" }), "Corners of the line, x,y;x,y, required"),
                (
                    "samples",
                    json!({ "type": "integer", "minimum": 2, "maximum": MAX_ALONG, "default": 256 }),
                    "Number of points",
                ),
                layer(),
            ],
        ),
    ];
    let mut all: Vec<_> =
        fixed.into_iter().map(|(path, about, kind, parameters)| (path.to_string(), about, kind, parameters)).collect();
    all.push((
        "/recipe.json".to_string(),
        "The seed and the numbers that `seed` and `set` can change: values, ranges, units",
        "application/json",
        Vec::new(),
    ));
    all.push((
        "/mesh/layer.json".to_string(),
        "Description of the tiles of meshes, for Cesium",
        "application/json",
        Vec::new(),
    ));
    all.push((
        "/mesh/{z}/{x}/{y}.terrain".to_string(),
        "Tile of a mesh of the heights, quantized-mesh 1.0; rows count from the south",
        "application/vnd.quantized-mesh",
        vec![(
            "extensions",
            json!({ "type": "string" }),
            "Extensions with `-` between them: octvertexnormals, metadata; otherwise those of the header `Accept`",
        )],
    ));
    all.push((
        "/zarr/{key}".to_string(),
        "Zarr v3 store of all layers: metadata (`zarr.json`) and chunks (`height/c/ROW/COLUMN`), also in `levels/N`",
        "application/octet-stream",
        Vec::new(),
    ));
    let cell = (CELL, number(), "Distance between the samples that are searched, in metres");
    let search = LocateJob::OPTIONS.iter().map(of_option).chain([cell]).collect();
    all.push(("/locate".to_string(), "Nearest places that satisfy conditions", "application/json", search));
    let about = "Objects, rivers, lakes, ... of a window";
    all.push(("/objects.geojson".to_string(), about, objects::KIND, window_features()));
    for format in windows::formats() {
        let size = || json!({ "type": "integer", "minimum": 1 });
        let mut parameters = vec![
            ("bbox", json!({ "type": "string" }), "West,south,east,north; the whole world if it is left out"),
            ("width", size(), "Samples from west to east"),
            ("height", size(), "Samples from north to south"),
            (
                "cell",
                json!({ "type": "number", "exclusiveMinimum": 0 }),
                "Metres between samples; the world's cell if it is left out",
            ),
            layer(),
        ];
        parameters.extend(format.options.iter().filter(|spec| spec.name != "no-sidecar").map(of_option));
        parameters.extend(list::options().into_iter().map(|(spec, _)| of_option(spec)));
        all.push((format!("/window.{}", format.name), format.about, windows::media_type(format), parameters));
    }
    for (_, _, _, parameters) in all.iter_mut().filter(|(path, ..)| path != "/zarr/{key}" && path != "/addresses") {
        parameters.extend(variant());
    }
    all
}

/// The parameters of features of a window.
fn window_features() -> Vec<Parameter> {
    let names = objects::LAYERS.map(|(name, _)| name);
    let text = || json!({ "type": "string" });
    let cell = json!({ "type": "number", "exclusiveMinimum": 0 });
    let mut all = vec![
        ("bbox", text(), "West,south,east,north; the whole world if it is left out"),
        ("cell", cell, "Metres between the samples that features are made from; the world's cell if it is left out"),
        ("layer", json!({ "type": "string", "enum": names, "default": names[0] }), "Kind of the features"),
    ];
    for spec in objects::LAYERS.iter().flat_map(|(_, layer)| objects::options(layer)) {
        if all.iter().all(|(name, ..)| *name != spec.name) {
            all.push(of_option(spec));
        }
    }
    all
}

/// Parameters that choose a variant of the world.
fn variant() -> [Parameter; 2] {
    [
        (SEED, json!({ "type": "integer", "minimum": 0 }), "Another seed of the world"),
        (
            SET,
            json!({ "type": "array", "items": { "type": "string" } }),
            "NAME=VALUE: another value of a number that `/recipe.json` lists; may be given several times",
        ),
    ]
}

/// An option of a format or a layer as a parameter.
fn of_option(spec: &OptionSpec) -> Parameter {
    (spec.name, json!({ "type": "string" }), spec.about)
}

/// The answer of an error.
fn error(about: &str) -> Value {
    let schema = json!({ "$ref": "#/components/schemas/Error" });
    json!({ "description": about, "content": { "application/json": { "schema": schema } } })
}

/// `POST /recipes`.
fn sending() -> Value {
    let properties = json!({
        "name": { "type": "string", "description": "Name of the world in paths: `/{world}/...`" },
        "url": { "type": "string", "description": "Address of its map" },
        "about": { "type": "string" },
        "version": { "type": "string" },
        "layers": { "type": "array", "items": { "type": "string" } },
    });
    let made = |about: &str| json!({ "description": about, "content": { "application/json": { "schema": { "type": "object", "properties": properties } } } });
    let text = json!({ "schema": { "type": "string", "maxLength": sent::MAX_BYTES } });
    json!({ "post": {
        "summary": "Serves the world of a recipe that cannot name files",
        "parameters": [],
        "requestBody": {
            "required": true,
            "description": "A recipe as TOML or JSON",
            "content": { "application/toml": text, "application/json": text },
        },
        "responses": {
            "200": made("The recipe is known"),
            "201": made("Its world is served, at the address in `Location`"),
            "400": error("The recipe is not valid: each line has a place and what is wrong"),
            "408": error("The recipe did not arrive in time"),
            "413": error("The recipe is too long, or its world takes too much memory or time"),
            "503": error("Too many requests are waiting, or the answer takes too long; see `Retry-After`"),
        },
    } })
}

fn operation(prefix: &str, path: &str, about: &str, kind: &str, parameters: Vec<Parameter>) -> Value {
    let whole = format!("{prefix}{path}");
    let mut all: Vec<Value> = Vec::new();
    for name in ["world", "layer", "z", "x", "y", "key"] {
        if whole.contains(&format!("{{{name}}}")) {
            let kind = if matches!(name, "world" | "layer" | "key") { "string" } else { "integer" };
            all.push(json!({ "name": name, "in": "path", "required": true, "schema": { "type": kind } }));
        }
    }
    for (name, schema, about) in parameters {
        let is_required = about.ends_with("required");
        all.push(
            json!({ "name": name, "in": "query", "required": is_required, "schema": schema, "description": about }),
        );
    }
    json!({ "get": {
        "summary": about,
        "parameters": all,
        "responses": {
            "200": { "description": about, "content": { kind: {} } },
            "304": { "description": "The client has it already" },
            "400": error("A parameter is wrong"),
            "404": error("There is no such world, layer or tile"),
            "413": error("More samples or memory than a request may have"),
            "503": error("Too many requests are waiting, or the answer takes too long; see `Retry-After`"),
        },
    } })
}

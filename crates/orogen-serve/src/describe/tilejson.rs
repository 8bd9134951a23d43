//! `/tilejson/{layer}.json`: TileJSON 3.0.0.

use axum::response::Response;
use orogen::builder::tile_grid;
use orogen::io::format::encoding::Encoding;
use orogen::jobs::vector_tiles::VectorTiles;
use orogen::jobs::vector_tiles::tile_layers::TileLayerSpec;
use orogen::world::HEIGHT;
use serde_json::{Map, Value, json};

use crate::answer;
use crate::call::Call;
use crate::query::encoded;
use crate::refusal::Refusal;
use crate::served::{Frame, Served, TILE};
use crate::vector;

/// The vector layers of TileJSON, with the attributes of their features.
fn vector_layers(vector: &VectorTiles) -> Vec<Value> {
    let layer = |layer: &'static TileLayerSpec| {
        let fields = layer.fields.iter().map(|field| (field.field.name.to_string(), json!(field.field.about)));
        json!({ "id": layer.name, "description": layer.about, "fields": fields.collect::<Map<_, _>>() })
    };
    vector.layers().into_iter().map(layer).collect()
}

/// The path of the tiles of a layer, and the encoding of its heights if they are encoded.
pub fn tiles_of(layer: &str) -> (String, Option<Encoding>) {
    match Encoding::ALL.into_iter().find(|encoding| encoding.name() == layer) {
        Some(encoding) => (encoding.name().to_string(), Some(encoding)),
        None => (format!("tiles/{}", encoded(layer)), None),
    }
}

/// The answer.
pub async fn tilejson(call: Call) -> Result<Response, Refusal> {
    call.query.only_of_variants(&["grid", "palette", "surface"])?;
    let (served, frame) = (call.served()?, call.frame()?);
    let name = call.part("layer");
    let layer = name
        .strip_suffix(".json")
        .ok_or_else(|| Refusal::absent(format!("`{name}` has no extension: TileJSON is at /tilejson/{name}.json")))?;
    let is_vector = layer == vector::NAME;
    let (path, encoding) = if is_vector { (vector::NAME.into(), None) } else { tiles_of(layer) };
    let shown = if encoding.is_some() || is_vector { HEIGHT } else { layer };
    served.world_of(shown).map_err(|error| Refusal::of(&error).or_absent())?;
    let zooms = served.zooms(frame)?;
    let grid = (frame != Frame::Web).then(|| frame.name());
    let mut link = call.link(&served, grid);
    call.palette()?;
    for name in if encoding.is_some() { ["surface"] } else { ["palette"] } {
        if let Some(value) = call.query.get(name) {
            link += &format!("&{name}={}", encoded(value));
        }
    }
    let extension = if is_vector { "mvt" } else { "png" };
    let template = format!("{}/{path}/{{z}}/{{x}}/{{y}}.{extension}{link}", call.base(&served));
    // Vector tiles have as many samples as four tiles of the next zoom.
    let most = if is_vector { zooms.most.saturating_sub(1).max(zooms.least) } else { zooms.most };
    let mut tiles = json!({
        "tilejson": "3.0.0",
        "name": format!("{}: {layer}", served.name),
        "description": served.title(),
        "version": "1.0.0",
        "tiles": [template],
        "scheme": "xyz",
        "minzoom": zooms.least,
        "maxzoom": most,
        "tileSize": TILE,
        "grid": grid_of(&served, frame)?,
        "made_by": format!("Orogen {}", env!("CARGO_PKG_VERSION")),
    });
    if is_vector {
        tiles["tileSize"] = json!(VectorTiles::SIDE);
        tiles["vector_layers"] = json!(vector_layers(served.vector()));
    }
    if let Some(encoding) = encoding {
        tiles["encoding"] = json!(encoding.tilejson());
    }
    if frame == Frame::Web {
        let own = served.grid(frame, zooms.own, TILE)?;
        let [west, south, east, north] = tile_grid::degrees(own.pixels(), (TILE as u64) << zooms.own);
        let shown = if served.recipe().world.size.is_some() { zooms.least } else { zooms.own.saturating_sub(4) };
        tiles["bounds"] = json!([west, south, east, north]);
        tiles["center"] = json!([(west + east) / 2.0, (south + north) / 2.0, shown]);
    }
    answer::text(&call.headers, "application/json", &tiles.to_string(), call.is_private())
}

/// The description of a grid of tiles.
pub fn grid_of(served: &Served, frame: Frame) -> Result<Value, Refusal> {
    let zoom_0 = served.grid(frame, served.zooms(frame)?.least, TILE)?;
    let cell_0 = zoom_0.cell() * f64::from(1u32 << zoom_0.zoom());
    let map = served.map();
    let crs = map.as_ref().and_then(orogen::io::format::Georeference::epsg).map(|code| format!("EPSG:{code}"));
    let unbounded = served.recipe().world.size.is_none();
    Ok(match frame {
        Frame::Web => json!({
            "name": frame.name(),
            "crs": "EPSG:3857",
            "placement": match served.is_on_web_map() {
                true => "the real position of the world",
                false => "the origin of the world is at 0 degrees east and north, and one metre of the world is one metre of the map",
            },
            "metres_per_pixel_at_zoom_0": cell_0,
        }),
        Frame::World => {
            let side = cell_0 * TILE as f64;
            let corner = if unbounded { [-side / 2.0; 2] } else { [0.0; 2] };
            let origin = map.as_ref().map_or([corner[0], 0.0 - corner[1]], |map| map.at(corner[0], corner[1]));
            json!({
                "name": frame.name(),
                "crs": crs,
                "placement": match unbounded {
                    true => "zoom 0 is one tile, a square with the origin of the world in its middle; columns count east, rows count south",
                    false => "zoom 0 is one tile, the square of the world's longer side from its north-west corner; columns count east, rows count south",
                },
                "origin": origin,
                "side": side,
                "metres_per_pixel_at_zoom_0": cell_0,
            })
        }
    })
}

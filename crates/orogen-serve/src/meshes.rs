//! `/mesh`: quantized-mesh tiles for globes such as Cesium, and their description.

use axum::http::{HeaderMap, header};
use axum::response::Response;
use orogen::builder::tile_grid::MAX_ZOOM;
use orogen::grid::hex;
use orogen::jobs::mesh_tiles::{self, Extensions, MeshAddress, MeshTiles};
use orogen::world::HEIGHT;
use serde_json::{Value, json};

use crate::answer;
use crate::call::Call;
use crate::desk::{Keep, Work};
use crate::refusal::Refusal;
use crate::served::{Frame, Served};

/// The media type of tiles.
const KIND: &str = "application/vnd.quantized-mesh";

/// The parameter for extensions, in addresses and in the header `Accept`.
const EXTENSIONS: &str = "extensions";

/// Names of extensions.
const NORMALS: &str = "octvertexnormals";
const METADATA: &str = "metadata";

/// `/mesh/layer.json`.
pub async fn layer(call: Call) -> Result<Response, Refusal> {
    call.query.only_of_variants(&[])?;
    let served = call.served()?;
    served.fingerprint(HEIGHT).map_err(|error| Refusal::of(&error).or_absent())?;
    let tiles = MeshTiles::new(served.world());
    let most = max_zoom(&served)?;
    let text = json!({
        "tilejson": "2.1.0",
        "name": served.name,
        "description": served.title(),
        "version": "1.0.0",
        "format": "quantized-mesh-1.0",
        "scheme": "tms",
        "projection": "EPSG:4326",
        "tiles": [format!("{}/mesh/{{z}}/{{x}}/{{y}}.terrain{}", call.base(&served), call.link(&served, None))],
        "bounds": tiles.bounds(),
        "minzoom": 0,
        "maxzoom": most,
        "extensions": [NORMALS],
        "available": (0..=most).map(|zoom| available(&tiles, zoom)).collect::<Vec<_>>(),
        "placement": match tiles.is_real() {
            true => "the real position of the world",
            false => "the origin of the world is at 0 degrees east and north, and one metre of the world is one metre on the equator",
        },
    });
    answer::text(&call.headers, "application/json", &text.to_string(), call.is_private())
}

/// The highest zoom in the description; its samples are twice as fine as those of web maps.
fn max_zoom(served: &Served) -> Result<u32, Refusal> {
    Ok(served.zooms(Frame::Web)?.most.saturating_sub(1))
}

/// The tiles of a zoom. Globes request all of zoom 0.
fn available(tiles: &MeshTiles, zoom: u32) -> Value {
    let [columns, rows] = if zoom == 0 { [[0, 1], [0, 0]] } else { tiles.tiles(zoom) };
    json!([{ "startX": columns[0], "startY": rows[0], "endX": columns[1], "endY": rows[1] }])
}

/// `/mesh/{z}/{x}/{y}.terrain`.
pub async fn tile(call: Call) -> Result<Response, Refusal> {
    call.query.only_of_variants(&[EXTENSIONS])?;
    let served = call.served()?;
    let at = address(&call)?;
    let fingerprint = served.fingerprint(HEIGHT).map_err(|error| Refusal::of(&error).or_absent())?;
    let tiles = MeshTiles::new(served.world());
    if !tiles.has(at) {
        let [[west, east], [south, north]] = tiles.tiles(at.zoom);
        return Err(Refusal::absent(format!(
            "this tile is outside the world; at zoom {} it has the columns {west} to {east} and, from the south, the rows {south} to {north}",
            at.zoom
        )));
    }
    let names = extensions(call.query.get(EXTENSIONS), &call.headers);
    let has = |name: &str| names.iter().any(|own| own == name);
    let below = || {
        let most = max_zoom(&served).unwrap_or(at.zoom);
        let levels: Vec<Value> = (at.zoom + 1..=most).map(|zoom| available(&tiles, zoom)).collect();
        json!({ "geometricerror": mesh_tiles::max_error(at.zoom), "available": levels }).to_string()
    };
    let extensions = Extensions { normals: has(NORMALS), metadata: has(METADATA).then(below) };
    let key = format!("mesh {} {} {at:?} {extensions:?}", served.name, hex::encode(&fingerprint));
    let (world, budget) = (served.world().clone(), served.session().budget().clone());
    let work = async || {
        Ok(Box::new(move |progress: &orogen::Progress| {
            let _scratch = budget.reserve(mesh_tiles::SCRATCH)?;
            Ok(MeshTiles::new(&world).tile(at, &extensions, progress)?.into())
        }) as Work)
    };
    let mut response = call.worked(&served, (key, Keep::Tile), KIND, work).await?;
    answer::set(response.headers_mut(), header::VARY, "accept, accept-encoding");
    Ok(response)
}

/// Reads `{z}/{x}/{y}.terrain`.
fn address(call: &Call) -> Result<MeshAddress, Refusal> {
    let [z, x, y] = ["z", "x", "y"].map(|name| call.part(name));
    let wrong = || {
        Refusal::absent(format!(
            "`{z}/{x}/{y}` is not a tile: it must be zoom/column/row.terrain with whole numbers, such as 12/4096/2047.terrain"
        ))
    };
    let number = |text: &str| {
        let is_plain = !text.is_empty() && text.len() < 12 && text.bytes().all(|byte| byte.is_ascii_digit());
        is_plain.then(|| text.parse::<u64>().ok()).flatten().ok_or_else(wrong)
    };
    let row = y.strip_suffix(".terrain").ok_or_else(wrong)?;
    let (zoom, column, row) = (number(z)?, number(x)?, number(row)?);
    match u32::try_from(zoom) {
        Ok(zoom) if zoom <= MAX_ZOOM => Ok(MeshAddress { zoom, column, row }),
        _ => Err(Refusal::absent(format!("the zoom must be 0 to {MAX_ZOOM}, not {zoom}"))),
    }
}

/// The extensions that a request names: in the parameter, or else in the header `Accept`.
fn extensions(parameter: Option<&str>, headers: &HeaderMap) -> Vec<String> {
    let of = |list: &str| list.split('-').map(|name| name.trim().to_string()).collect();
    if let Some(list) = parameter {
        return of(list);
    }
    let accepted = headers.get_all(header::ACCEPT).iter().filter_map(|value| value.to_str().ok());
    let mut kinds = accepted.flat_map(|value| value.split(','));
    let own = kinds.find(|kind| kind.trim().starts_with(KIND)).unwrap_or_default();
    own.split(';').find_map(|part| part.trim().strip_prefix("extensions=")).map(of).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;

    #[test]
    fn extensions_are_read() {
        for (parameter, accept, expect) in [
            (None, "*/*", &[][..]),
            (
                None,
                "application/vnd.quantized-mesh;extensions=octvertexnormals-metadata,*/*;q=0.01",
                &[NORMALS, METADATA],
            ),
            (None, "text/html, application/vnd.quantized-mesh; extensions=octvertexnormals;q=0.9", &[NORMALS]),
            (None, "application/vnd.quantized-mesh,application/octet-stream;q=0.9", &[]),
            (Some("metadata"), "application/vnd.quantized-mesh;extensions=octvertexnormals", &[METADATA]),
        ] {
            let headers = HeaderMap::from_iter([(header::ACCEPT, HeaderValue::from_static(accept))]);
            assert_eq!(extensions(parameter, &headers), expect, "{accept}");
        }
    }
}

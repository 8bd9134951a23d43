//! The list of the worlds, and `/addresses`: layers and addresses of a world.

use std::fmt::Write as _;

use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};

use orogen::builder::tile_grid::UNBOUNDED_ZOOM;

use super::escape::escaped;
use super::tilejson::tiles_of;
use crate::answer;
use crate::call::Call;
use crate::query::encoded;
use crate::refusal::Refusal;
use crate::served::Served;

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#1d2529;background:#fff}\
    h1{margin-bottom:.2rem}code{font-size:.9em;overflow-wrap:anywhere}table{border-collapse:collapse;width:100%}\
    td,th{text-align:left;padding:.3rem .6rem .3rem 0;border-bottom:1px solid #d5dcdf;vertical-align:top}\
    .worlds{list-style:none;padding:0;display:grid;grid-template-columns:repeat(auto-fill,minmax(15rem,1fr));gap:1.5rem}\
    .worlds p{margin:.2rem 0}.worlds a,.worlds img{display:block}.worlds a{text-decoration:none}.worlds strong{display:block;margin-top:.4rem}\
    img{width:256px;height:256px;background:#eef2f3;border:1px solid #d5dcdf}\
    @media(prefers-color-scheme:dark){body{color:#dfe6e8;background:#14191c}td,th,img{border-color:#34404a}a{color:#8ab9f1}img{background:#1d2529}}";

/// How many zooms wider than at its own cell the picture of an unbounded world is.
const WIDER: u32 = 4;

/// The list of the worlds.
pub fn worlds(call: &Call) -> Result<Response, Refusal> {
    let mut body =
        String::from("<h1>Orogen</h1>\n<p>Terrain, computed when it is requested.</p>\n<ul class=\"worlds\">\n");
    let token = call.query.get("token").map_or(String::new(), |token| format!("?token={}", encoded(token)));
    for world in &call.shared.worlds {
        let (name, title) = (escaped(&world.name), escaped(world.title()));
        let (zoom, tile) = match world.recipe().world.size {
            Some(_) => (0, 0),
            None => (UNBOUNDED_ZOOM - WIDER, 1u64 << (UNBOUNDED_ZOOM - WIDER - 1)),
        };
        let picture = format!(
            "<img src=\"{name}/tiles/{}/{zoom}/{tile}/{tile}.png{}\" alt=\"\" loading=\"lazy\">",
            world.layers().first().map_or(String::new(), |layer| encoded(&layer.name)),
            escaped(&call.link(world, Some("world"))),
        );
        // Writing to a string cannot fail.
        let _ =
            writeln!(body, "<li><a href=\"{name}/{token}\">{picture}<strong>{name}</strong></a><p>{title}</p></li>");
    }
    page(call, "Orogen", &(body + "</ul>\n"))
}

/// The layers and addresses of a world.
pub async fn addresses(call: Call) -> Result<Response, Refusal> {
    call.query.only(&[])?;
    let served = call.served()?;
    page(&call, &served.name, &world_body(&call, &served)?)
}

fn world_body(call: &Call, served: &Served) -> Result<String, Refusal> {
    let (base, link) = (escaped(&call.base(served)), escaped(&call.link(served, None)));
    let token = call.query.get("token").map_or(String::new(), |token| format!("?token={}", encoded(token)));
    let and = |query: &str| escaped(&format!("?{query}{}", token.replacen('?', "&", 1)));
    let token = escaped(&token);
    let spec = &served.recipe().world;
    let size = spec.size.map_or_else(|| "unbounded".into(), |[width, height]| format!("{width} x {height} m"));
    let mut body = format!(
        "<h1>{}</h1>\n<p>{}</p>\n<p>{size}, cell {} m",
        escaped(&served.name),
        escaped(served.title()),
        spec.cell
    );
    if let Some(code) = served.map().and_then(|map| map.epsg()) {
        let _ = write!(body, ", EPSG:{code}");
    }
    body += "</p>\n";
    if spec.size.is_some() {
        let _ = writeln!(
            body,
            "<p><img src=\"{base}/tiles/{}/0/0/0.png{}\" alt=\"The whole world\"></p>",
            served.layers().first().map_or(String::new(), |layer| encoded(&layer.name)),
            escaped(&call.link(served, Some("world"))),
        );
    }
    body += "<h2>Addresses</h2>\n<table><tr><th>For<th>Address</tr>\n";
    for (what, address) in [
        ("WMTS: QGIS, GDAL", format!("{base}/wmts{token}")),
        ("Heights, Terrarium (TileJSON)", format!("{base}/tilejson/terrarium.json{token}")),
        ("Heights, Terrain-RGB (TileJSON)", format!("{base}/tilejson/terrain-rgb.json{token}")),
        ("A window as GeoTIFF, PNG or NumPy array", format!("{base}/window.tif{}", and("width=512"))),
        ("The value at a point", format!("{base}/height{}", and("x=0&y=0"))),
        ("All requests and their parameters (OpenAPI)", format!("/openapi.json{token}")),
        ("Counts for Prometheus", format!("/metrics{token}")),
    ] {
        let _ = writeln!(body, "<tr><td>{what}<td><a href=\"{address}\"><code>{address}</code></a></tr>");
    }
    if call.shared.limits.allows_recipes {
        body += "<tr><td>A recipe of your own, as the body of a POST<td><code>/recipes</code></tr>\n";
    }
    body += "</table>\n<h2>Layers</h2>\n<table><tr><th>Layer<th>Description<th>Tiles</tr>\n";
    for layer in served.layers() {
        let (path, _) = tiles_of(&layer.name);
        let unit = if layer.unit.is_empty() { String::new() } else { format!(" ({})", escaped(layer.unit)) };
        let _ = writeln!(
            body,
            "<tr><td><a href=\"{base}/tilejson/{}.json{token}\">{}</a><td>{}{unit}<td><code>{base}/{path}/{{z}}/{{x}}/{{y}}.png{link}</code></tr>",
            encoded(&layer.name),
            escaped(&layer.name),
            escaped(&layer.about),
        );
    }
    Ok(body + "</table>\n")
}

fn page(call: &Call, title: &str, body: &str) -> Result<Response, Refusal> {
    let title = escaped(title);
    let text = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <title>{title}</title><link rel=\"icon\" href=\"data:,\"><style>{STYLE}</style></head><body>\n{body}</body></html>\n"
    );
    let mut response = answer::text(&call.headers, "text/html; charset=utf-8", &text, call.is_private())?;
    // The page has no scripts, and texts of recipes cannot add any.
    let policy = "default-src 'none'; style-src 'unsafe-inline'; img-src 'self' data:";
    answer::set(response.headers_mut(), header::CONTENT_SECURITY_POLICY, policy);
    answer::set(response.headers_mut(), header::REFERRER_POLICY, "no-referrer");
    Ok(if response.status() == StatusCode::NOT_MODIFIED { response } else { response.into_response() })
}

//! `/world.json`: what a map program needs to know about a world.

use axum::response::Response;
use orogen::builder::tile_grid;
use orogen::io::format::Georeference;
use orogen::io::palette::named::{self, Span};
use orogen::locate::LocateJob;
use orogen::options::ValueKind;
use orogen::world::HEIGHT;
use serde_json::{Value, json};

use crate::answer;
use crate::call::Call;
use crate::refusal::Refusal;
use crate::served::{Frame, Served, TILE};
use crate::windows;

/// The answer.
pub async fn world(call: Call) -> Result<Response, Refusal> {
    call.query.only_of_variants(&[])?;
    let served = call.served()?;
    let recipe = served.recipe();
    let spec = &recipe.world;
    let map = served.map().unwrap_or(Georeference::LOCAL);
    let layers: Vec<Value> = served
        .layers()
        .into_iter()
        .map(|layer| json!({ "name": layer.name, "about": layer.about, "unit": layer.unit }))
        .collect();
    let palettes: Vec<Value> = named::all()
        .iter()
        .map(|named| {
            let suits = match (named.name == named::DEFAULT, named.span) {
                (true, _) => "heights",
                (false, Span::Degrees) => "degrees",
                _ => "any",
            };
            json!({ "name": named.name, "about": named.about, "suits": suits, "safe": named.safe })
        })
        .collect();
    let formats: Vec<Value> =
        windows::formats().map(|format| json!({ "name": format.name, "about": format.about })).collect();
    let find = LocateJob::OPTIONS.iter().find_map(|spec| match spec.kind {
        ValueKind::Word(words) if spec.name == "find" => Some(words),
        _ => None,
    });
    let text = json!({
        "name": served.name,
        "about": served.title(),
        "version": served.version,
        "is_place": served.is_place,
        "has_heights": served.world().unit(HEIGHT).is_ok(),
        "size": spec.size,
        "cell": spec.cell,
        "sea_level": (!served.is_place).then_some(spec.sea_level),
        "seed": spec.seed,
        "crs": served.map().and_then(|map| map.epsg()).map(|code| format!("EPSG:{code}")),
        "web": web(&served, &map)?,
        "layers": layers,
        "palettes": palettes,
        "formats": formats,
        "find": find,
        "has_studio": call.shared.site.has("studio") && !served.is_place,
        "has_book": call.shared.site.has("book"),
        "max_samples": call.max_samples(&served),
        "orogen": env!("CARGO_PKG_VERSION"),
    });
    answer::text(&call.headers, "application/json", &text.to_string(), call.is_private())
}

/// The place of the world on web maps, and how positions there become those of requests: `origin` and `per_metre` turn
/// metres of the map, east and north of 0 degrees, into coordinates.
fn web(served: &Served, map: &Georeference) -> Result<Value, Refusal> {
    let zooms = served.zooms(Frame::Web)?;
    let own = served.grid(Frame::Web, zooms.own, TILE)?;
    let bounds = served.recipe().world.size.map(|_| tile_grid::degrees(own.pixels(), (TILE as u64) << zooms.own));
    let (origin, per_metre) = match served.is_on_web_map() {
        true => ([0.0; 2], [1.0; 2]),
        false => (map.origin, map.per_metre),
    };
    Ok(json!({
        "bounds": bounds,
        "min_zoom": zooms.least,
        "own_zoom": zooms.own,
        "max_zoom": zooms.most,
        "origin": origin,
        "per_metre": per_metre,
    }))
}

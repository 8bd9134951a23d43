//! `/colors/{layer}.json`: the colors of a layer's tiles, for legends and for maps that are colored by the client.

use std::sync::Arc;

use axum::body::Bytes;
use axum::response::Response;
use orogen::grid::hex;
use orogen::io::palette::color;
use orogen::io::palette::named::Named;
use orogen::jobs::map_tiles::MapTiles;
use serde_json::json;

use crate::call::Call;
use crate::desk::{Keep, Work};
use crate::refusal::Refusal;
use crate::served::Served;

/// The answer.
pub async fn colors(call: Call) -> Result<Response, Refusal> {
    call.query.only_of_variants(&["palette"])?;
    let (served, palette) = (call.served()?, call.palette()?);
    let name = call.part("layer");
    let layer = name
        .strip_suffix(".json")
        .ok_or_else(|| Refusal::absent(format!("`{name}` has no extension: colors are at /colors/{name}.json")))?
        .to_string();
    let fingerprint = served.fingerprint(&layer).map_err(|error| Refusal::of(&error).or_absent())?;
    let named = palette.map_or("", |named| named.name);
    let key = format!("colors.json {} {layer} {} {named}", served.name, hex::encode(&fingerprint));
    let work = async || {
        let map = fitted(&call, &served, &layer, palette).await?;
        Ok(Box::new(move |_: &orogen::Progress| {
            let stops: Vec<_> = map.stops().into_iter().map(|(at, rgb)| json!([at, color::hex(rgb)])).collect();
            let classes = map.classes().iter().map(|(name, rgb)| json!({ "name": name, "color": color::hex(*rgb) }));
            let text = json!({
                "layer": layer,
                "unit": map.unit(),
                "stops": stops,
                "classes": classes.collect::<Vec<_>>(),
            });
            Ok(text.to_string().into())
        }) as Work)
    };
    call.worked(&served, (key, Keep::Tile), "application/json", work).await
}

/// A layer with its colors. They are fitted once, which may need the solution of a whole world, so the work goes on if
/// the client does not wait for it.
///
/// # Errors
/// If the palette does not suit the layer, or the work fails.
pub async fn fitted(
    call: &Call,
    served: &Arc<Served>,
    layer: &str,
    palette: Option<&'static Named>,
) -> Result<Arc<MapTiles>, Refusal> {
    if let Some(map) = served.ready_map(layer, palette) {
        return Ok(map);
    }
    let work = || {
        let (served, layer) = (Arc::clone(served), layer.to_string());
        Box::new(move |progress: &orogen::Progress| {
            served.fit_map(&layer, palette, progress)?;
            Ok(Bytes::new())
        }) as Work
    };
    let name = palette.map_or("", |named| named.name);
    call.shared.desk.get(format!("fit {} {} {layer} {name}", served.name, served.version), served.keep(), work).await?;
    let missing = || Refusal::busy("the layer is being prepared; send the request again");
    served.ready_map(layer, palette).ok_or_else(missing)
}

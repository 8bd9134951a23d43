//! Vector tiles.

use std::sync::Arc;

use axum::body::Bytes;
use axum::response::Response;
use orogen::jobs::vector_tiles::VectorTiles;

use crate::call::Call;
use crate::desk::{Keep, Work};
use crate::refusal::Refusal;
use crate::served::Served;
use crate::tiles::Address;

/// The media type of vector tiles.
pub const KIND: &str = "application/vnd.mapbox-vector-tile";

/// The name of the tiles in TileJSON.
pub const NAME: &str = "vector";

/// Parameters that choose what the tiles have.
pub const LAYERS: &str = "layers";
pub const INTERVAL: &str = "interval";

/// Smallest and largest contour interval, in metres.
pub const INTERVALS: std::ops::RangeInclusive<f64> = 1e-3..=1e5;

/// `/vector/{z}/{x}/{y}.mvt`.
pub async fn tile(call: Call) -> Result<Response, Refusal> {
    call.query.only_of_variants(&["grid", LAYERS, INTERVAL])?;
    let (served, frame) = (call.served()?, call.frame()?);
    let address = Address::read(&call, ".mvt", VectorTiles::SIDE)?;
    let vector = Arc::clone(served.vector());
    let layers = match call.query.get(LAYERS) {
        Some(names) => vector.chosen(names).map_err(|error| Refusal::of(&error).or_absent())?,
        None => vector.layers(),
    };
    let interval = call.query.number(INTERVAL)?;
    if let Some(wrong) = interval.filter(|interval| !INTERVALS.contains(interval)) {
        return Err(Refusal::bad(format!(
            "`{INTERVAL}` must be {} to {} m, not {wrong}",
            INTERVALS.start(),
            INTERVALS.end()
        )));
    }
    let names: Vec<&str> = layers.iter().map(|layer| layer.name).collect();
    let hash = vector.key().map_err(|error| Refusal::of(&error).or_absent())?;
    let kind = format!("{NAME} {} {} {interval:?}", served.name, names.join(","));
    let key = address.key_of(&kind, &hash, frame);
    let grid = address.grid(&served, frame)?;
    let interval = interval.unwrap_or_else(|| VectorTiles::interval(&grid));
    let work = async || {
        if !vector.is_ready(&layers) {
            found(&call, &served).await?;
        }
        let (vector, layers) = (Arc::clone(&vector), layers.clone());
        Ok(Box::new(move |progress: &orogen::Progress| {
            Ok(vector.tile(&grid, [address.column, address.row], &layers, interval, progress)?.into())
        }) as Work)
    };
    call.worked(&served, (key, Keep::Tile), KIND, work).await
}

/// Finds the rivers, lakes and summits of a whole world, once. The work goes on if the client does not wait for it.
async fn found(call: &Call, served: &Arc<Served>) -> Result<(), Refusal> {
    let work = || {
        let vector = Arc::clone(served.vector());
        Box::new(move |progress: &orogen::Progress| {
            vector.find(progress)?;
            Ok(Bytes::new())
        }) as Work
    };
    call.shared.desk.get(format!("features {} {}", served.name, served.version), served.keep(), work).await.map(drop)
}

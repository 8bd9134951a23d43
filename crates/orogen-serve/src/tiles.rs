//! Tiles: maps of layers, and heights in colors.

use std::sync::Arc;

use axum::body::Bytes;
use axum::response::Response;
use orogen::builder::tile_grid::MAX_ZOOM;
use orogen::builder::xyz;
use orogen::grid::hex;
use orogen::grid::resample::LayerKind;
use orogen::io::format::encoding::Encoding;
use orogen::world::HEIGHT;

use crate::call::Call;
use crate::desk::{Keep, Work};
use crate::refusal::Refusal;
use crate::served::{Frame, Served, TILE};

/// Bytes that a pixel of a tile takes while it is made, beside the samples of its window.
const PIXEL: u64 = 48;

/// The position of a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Address {
    zoom: u32,
    column: u64,
    row: u64,
    /// Pixels on a side.
    side: usize,
}

impl Address {
    /// Reads `{z}/{x}/{y}.png` or `{z}/{x}/{y}@2x.png`.
    fn read(call: &Call) -> Result<Address, Refusal> {
        let [z, x, y] = ["z", "x", "y"].map(|name| call.part(name));
        let wrong = || {
            Refusal::absent(format!(
                "`{z}/{x}/{y}` is not a tile: it must be zoom/column/row.png with whole numbers, such as 12/2048/2050.png, or row@2x.png for 512 pixels"
            ))
        };
        let name = y.strip_suffix(".png").ok_or_else(wrong)?;
        let (name, side) = name.strip_suffix("@2x").map_or((name, TILE), |name| (name, 2 * TILE));
        let number = |text: &str| {
            let is_plain = !text.is_empty() && text.len() < 12 && text.bytes().all(|byte| byte.is_ascii_digit());
            is_plain.then(|| text.parse::<u64>().ok()).flatten().ok_or_else(wrong)
        };
        let (zoom, column, row) = (number(z)?, number(x)?, number(name)?);
        if zoom > u64::from(MAX_ZOOM) {
            return Err(Refusal::absent(format!("the zoom must be 0 to {MAX_ZOOM}, not {zoom}")));
        }
        let count = 1u64 << zoom;
        if column >= count || row >= count {
            return Err(Refusal::absent(format!(
                "there is no tile {column}, {row} at zoom {zoom}: columns and rows are 0 to {}",
                count - 1
            )));
        }
        Ok(Address { zoom: zoom as u32, column, row, side })
    }

    /// The grid that has the tile.
    fn grid(&self, served: &Served, frame: Frame) -> Result<orogen::builder::tile_grid::TileGrid, Refusal> {
        let grid = served.grid(frame, self.zoom, self.side).map_err(|error| Refusal::of(&error).or_absent())?;
        match grid.has(self.column, self.row) {
            true => Ok(grid),
            false => Err(Refusal::of(&served.outside(&grid)).or_absent()),
        }
    }

    /// Everything that the bytes of a tile depend on.
    fn key(&self, served: &Served, kind: &str, layer: &str, frame: Frame) -> Result<String, Refusal> {
        let fingerprint = served.fingerprint(layer).map_err(|error| Refusal::of(&error).or_absent())?;
        let Address { zoom, column, row, side } = self;
        let world = hex::encode(&fingerprint);
        Ok(format!("{kind} {} {layer} {world} {} {zoom}/{column}/{row}/{side}", served.name, frame.name()))
    }
}

/// `/tiles/{layer}/{z}/{x}/{y}.png`.
pub async fn map(call: Call) -> Result<Response, Refusal> {
    call.query.only(&["grid"])?;
    let (served, frame, address) = (call.served()?, call.frame()?, Address::read(&call)?);
    let layer = call.part("layer").to_string();
    let key = address.key(&served, "map", &layer, frame)?;
    let grid = address.grid(&served, frame)?;
    let work = async || {
        let map = match served.ready_map(&layer) {
            Some(map) => map,
            None => {
                fitted(&call, &served, &layer).await?;
                let missing = || Refusal::busy("the layer is being prepared; send the request again");
                served.ready_map(&layer).ok_or_else(missing)?
            }
        };
        let budget = served.session().budget().clone();
        Ok(Box::new(move |progress: &orogen::Progress| {
            let _scratch = budget.reserve(PIXEL * ((address.side + 2) * (address.side + 2)) as u64)?;
            Ok(map.png(&grid, address.column, address.row, address.side, progress)?.into())
        }) as Work)
    };
    call.worked(&served, (key, Keep::Tile), "image/png", work).await
}

/// Fits the colors of a layer, once. That may need the solution of a whole world, so the work goes on if the client
/// does not wait for it.
async fn fitted(call: &Call, served: &Arc<Served>, layer: &str) -> Result<(), Refusal> {
    let work = || {
        let (served, layer) = (Arc::clone(served), layer.to_string());
        Box::new(move |progress: &orogen::Progress| {
            served.fit_map(&layer, progress)?;
            Ok(Bytes::new())
        }) as Work
    };
    call.shared.desk.get(format!("colors {} {layer}", served.name), Keep::Work, work).await.map(drop)
}

/// `/terrarium/{z}/{x}/{y}.png`.
pub async fn terrarium(call: Call) -> Result<Response, Refusal> {
    encoded(call, Encoding::Terrarium).await
}

/// `/terrain-rgb/{z}/{x}/{y}.png`.
pub async fn terrain_rgb(call: Call) -> Result<Response, Refusal> {
    encoded(call, Encoding::TerrainRgb).await
}

async fn encoded(call: Call, encoding: Encoding) -> Result<Response, Refusal> {
    call.query.only(&["grid"])?;
    let (served, frame, address) = (call.served()?, call.frame()?, Address::read(&call)?);
    let key = address.key(&served, encoding.name(), HEIGHT, frame)?;
    let grid = address.grid(&served, frame)?;
    let (world, budget) = (Arc::clone(served.world()), served.session().budget().clone());
    let work = async || {
        Ok(Box::new(move |progress: &orogen::Progress| {
            let Address { column, row, side, .. } = address;
            let _scratch = budget.reserve(PIXEL * (side * side) as u64)?;
            let window = grid.window(column, row, 0);
            let heights = world.grids(&[HEIGHT], &window, progress)?.pop();
            let heights = heights.ok_or_else(|| Refusal::absent("the world has no heights"))?;
            let samples = grid.read(column, row, 0, &heights, LayerKind::Height);
            Ok(xyz::encode(encoding, side, &samples)?.into())
        }) as Work)
    };
    call.worked(&served, (key, Keep::Tile), "image/png", work).await
}

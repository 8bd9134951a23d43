//! Tiles: maps of layers, and heights in colors.

use std::sync::Arc;

use axum::response::Response;
use orogen::builder::tile_grid::{MAX_ZOOM, TileGrid};
use orogen::builder::xyz;
use orogen::grid::hex;
use orogen::grid::resample::LayerKind;
use orogen::io::format::encoding::Encoding;
use orogen::world::HEIGHT;

use crate::call::Call;
use crate::colors;
use crate::desk::{Keep, Work};
use crate::refusal::Refusal;
use crate::served::{Frame, Served, TILE};

/// Bytes that a pixel of a tile takes while it is made, beside the samples of its window.
const PIXEL: u64 = 48;

/// The position of a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Address {
    pub zoom: u32,
    pub column: u64,
    pub row: u64,
    /// Pixels on a side.
    pub side: usize,
}

impl Address {
    /// Reads `{z}/{x}/{y}.png` or `{z}/{x}/{y}@2x.png`.
    fn of_picture(call: &Call) -> Result<Address, Refusal> {
        match call.part("y").strip_suffix("@2x.png") {
            Some(row) => Address::of(call, row, ".png", 2 * TILE),
            None => Address::read(call, ".png", TILE),
        }
    }

    /// Reads `{z}/{x}/{y}` with an extension; its tile has this many pixels on a side.
    pub fn read(call: &Call, extension: &str, side: usize) -> Result<Address, Refusal> {
        let row = call.part("y").strip_suffix(extension).unwrap_or_default();
        Address::of(call, row, extension, side)
    }

    fn of(call: &Call, row: &str, extension: &str, side: usize) -> Result<Address, Refusal> {
        let [z, x, y] = ["z", "x", "y"].map(|name| call.part(name));
        let wrong = || {
            let larger = if extension == ".png" { ", or row@2x.png for 512 pixels" } else { "" };
            Refusal::absent(format!(
                "`{z}/{x}/{y}` is not a tile: it must be zoom/column/row{extension} with whole numbers, such as 12/2048/2050{extension}{larger}"
            ))
        };
        let number = |text: &str| {
            let is_plain = !text.is_empty() && text.len() < 12 && text.bytes().all(|byte| byte.is_ascii_digit());
            is_plain.then(|| text.parse::<u64>().ok()).flatten().ok_or_else(wrong)
        };
        let (zoom, column, row) = (number(z)?, number(x)?, number(row)?);
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
    pub fn grid(&self, served: &Served, frame: Frame) -> Result<TileGrid, Refusal> {
        let grid = served.grid(frame, self.zoom, self.side).map_err(|error| Refusal::of(&error).or_absent())?;
        match grid.has(self.column, self.row) {
            true => Ok(grid),
            false => Err(Refusal::of(&served.outside(&grid)).or_absent()),
        }
    }

    /// Everything that the bytes of a tile depend on.
    fn key(&self, served: &Served, kind: &str, layer: &str, frame: Frame) -> Result<String, Refusal> {
        let fingerprint = served.fingerprint(layer).map_err(|error| Refusal::of(&error).or_absent())?;
        Ok(self.key_of(&format!("{kind} {} {layer}", served.name), &fingerprint, frame))
    }

    /// The same for a tile that depends on the features with this hash.
    pub fn key_of(&self, kind: &str, hash: &[u8], frame: Frame) -> String {
        let Address { zoom, column, row, side } = self;
        format!("{kind} {} {} {zoom}/{column}/{row}/{side}", hex::encode(hash), frame.name())
    }
}

/// `/tiles/{layer}/{z}/{x}/{y}.png`.
pub async fn map(call: Call) -> Result<Response, Refusal> {
    call.query.only_of_variants(&["grid", "palette"])?;
    let (served, frame, address, palette) =
        (call.served()?, call.frame()?, Address::of_picture(&call)?, call.palette()?);
    let layer = call.part("layer").to_string();
    let named = palette.map_or("own", |named| named.name);
    let key = address.key(&served, &format!("map {named}"), &layer, frame)?;
    let grid = address.grid(&served, frame)?;
    let work = async || {
        let map = colors::fitted(&call, &served, &layer, palette).await?;
        let budget = served.session().budget().clone();
        Ok(Box::new(move |progress: &orogen::Progress| {
            let _scratch = budget.reserve(PIXEL * ((address.side + 2) * (address.side + 2)) as u64)?;
            Ok(map.png(&grid, address.column, address.row, address.side, progress)?.into())
        }) as Work)
    };
    call.worked(&served, (key, Keep::Tile), "image/png", work).await
}

/// `/terrarium/{z}/{x}/{y}.png`.
pub async fn terrarium(call: Call) -> Result<Response, Refusal> {
    encoded(call, Encoding::Terrarium).await
}

/// `/terrain-rgb/{z}/{x}/{y}.png`.
pub async fn terrain_rgb(call: Call) -> Result<Response, Refusal> {
    encoded(call, Encoding::TerrainRgb).await
}

/// What the heights of tiles are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Surface {
    /// Those of the ground; the part outside the world repeats its edge.
    Ground,
    /// The sea is flat, and so is the part outside the world: what a map in 3D shows.
    Water,
}

impl Surface {
    const ALL: [(&str, Surface); 2] = [("ground", Surface::Ground), ("water", Surface::Water)];

    /// Reads `?surface=`.
    fn read(call: &Call) -> Result<(&'static str, Surface), Refusal> {
        let Some(name) = call.query.get("surface") else { return Ok(Surface::ALL[0]) };
        Surface::ALL.into_iter().find(|(own, _)| *own == name).ok_or_else(|| {
            Refusal::bad(format!(
                "`surface` must be ground (the heights) or water (a flat sea, also outside the world), not `{name}`"
            ))
        })
    }
}

async fn encoded(call: Call, encoding: Encoding) -> Result<Response, Refusal> {
    call.query.only_of_variants(&["grid", "surface"])?;
    let (served, frame, address) = (call.served()?, call.frame()?, Address::of_picture(&call)?);
    let (named, surface) = Surface::read(&call)?;
    let key = address.key(&served, &format!("{} {named}", encoding.name()), HEIGHT, frame)?;
    let grid = address.grid(&served, frame)?;
    let (world, budget) = (Arc::clone(served.world()), served.session().budget().clone());
    // A real place may be below the level of the sea without being in it.
    let (has_sea, sea_level) = (!served.is_place, served.recipe().world.sea_level as f32);
    let work = async || {
        Ok(Box::new(move |progress: &orogen::Progress| {
            let Address { column, row, side, .. } = address;
            let _scratch = budget.reserve(PIXEL * (side * side) as u64)?;
            let window = grid.window(column, row, 0);
            let heights = world.grids(&[HEIGHT], &window, progress)?.pop();
            let heights = heights.ok_or_else(|| Refusal::absent("the world has no heights"))?;
            let mut samples = grid.read(column, row, 0, &heights, LayerKind::Height);
            if surface == Surface::Water {
                let [columns, rows] = grid.covered(column, row);
                for (k, sample) in samples.iter_mut().enumerate() {
                    let is_inside = columns.contains(&(k % side)) && rows.contains(&(k / side));
                    *sample = match (is_inside, has_sea) {
                        (true, true) => sample.max(sea_level),
                        (true, false) => *sample,
                        (false, true) => sea_level,
                        (false, false) => 0.0,
                    };
                }
            }
            Ok(xyz::encode(encoding, side, &samples)?.into())
        }) as Work)
    };
    call.worked(&served, (key, Keep::Tile), "image/png", work).await
}

//! `/zarr`: the world as a Zarr v3 store that was never built. Metadata and chunks are those of `orogen build`, made
//! when they are requested.
//!
//! The group `levels` has the world at its own cell (`0`), at twice that cell (`1`), and so on.

use std::sync::Arc;

use axum::response::Response;
use orogen::builder::Form;
use orogen::builder::zarr_layout::ZarrLayout;
use orogen::export::derived::list;
use orogen::grid::hex;
use orogen::{Window, World};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::answer;
use crate::call::Call;
use crate::desk::{Keep, Work};
use crate::refusal::Refusal;
use crate::served::Served;

/// The name of metadata.
const METADATA: &str = "zarr.json";

/// The name of the group of levels. Layers with this name or that of a coordinate are not in the store.
const LEVELS: &str = "levels";

/// Side of the square of an unbounded world in samples, with the origin in its middle. Readers such as xarray load all
/// coordinates of an array, 8 bytes a sample of a side.
pub const UNBOUNDED_SIDE: usize = 1 << 20;

/// Convention of levels, by which readers recognize it.
const MULTISCALES: &str = "d35379db-88df-4056-af3a-620245f8e347";

/// What a key of the store names.
#[derive(Debug, PartialEq, Eq)]
enum Item<'a> {
    /// The group of levels.
    Levels,
    /// The group of a level, the world.
    Group(usize),
    /// The metadata of an array.
    Array(usize, &'a str),
    /// A chunk of an array: its level, its array and its position.
    Chunk(usize, &'a str, Vec<usize>),
}

impl Item<'_> {
    /// Reads a key; `None` if no store has it.
    fn of(key: &str) -> Option<Item<'_>> {
        let parts: Vec<&str> = key.split('/').collect();
        match parts.as_slice() {
            [LEVELS, METADATA] => Some(Item::Levels),
            [LEVELS, level, rest @ ..] => Item::of_level(whole(level)?, rest),
            all => Item::of_level(0, all),
        }
    }

    fn of_level<'a>(level: usize, parts: &[&'a str]) -> Option<Item<'a>> {
        match parts {
            [METADATA] => Some(Item::Group(level)),
            [array, METADATA] => Some(Item::Array(level, array)),
            [array, "c", place @ ..] if matches!(place.len(), 1 | 2) => {
                Some(Item::Chunk(level, array, place.iter().map(|part| whole(part)).collect::<Option<_>>()?))
            }
            _ => None,
        }
    }
}

/// A number as keys have it, without signs and leading zeros.
fn whole(text: &str) -> Option<usize> {
    let is_plain = text == "0" || !text.starts_with('0');
    let is_whole = is_plain && text.len() < 12 && text.bytes().all(|byte| byte.is_ascii_digit());
    is_whole.then(|| text.parse().ok()).flatten()
}

/// `/zarr/{key}`.
pub async fn zarr(call: Call) -> Result<Response, Refusal> {
    call.query.only(&[])?;
    let served = call.served()?;
    let key = call.part("key").to_string();
    let absent = || {
        Refusal::absent(format!(
            "the store has no key `{key}`; it has zarr.json, and zarr.json and c/ROW/COLUMN of each array, also in levels/N"
        ))
    };
    // Readers ask for many names that no store of version 3 has: nothing is opened for them.
    let item = Item::of(&key).ok_or_else(absent)?;
    let levels = served.zarr_levels()?;
    let level = |level: &usize| levels.get(*level).ok_or_else(absent);
    match &item {
        Item::Levels => text(&call, &group_of_levels(levels)),
        Item::Group(n) => text(&call, &level(n)?.group()),
        Item::Array(n, name) => {
            let arrays = level(n)?.arrays();
            let array = arrays.into_iter().find(|(own, _)| own == name).ok_or_else(absent)?;
            text(&call, &array.1)
        }
        Item::Chunk(n, name, place) => match (ZarrLayout::axis(name), place.as_slice()) {
            (Some(axis), [chunk]) if *chunk < level(n)?.coordinate_chunks(axis) => {
                coordinates(&call, &served, level(n)?, axis, *chunk).await
            }
            (None, [row, column]) => {
                let layout = level(n)?;
                let [columns, rows] = layout.chunks();
                let has = layout.layers.iter().any(|(own, _)| own == name) && *row < rows && *column < columns;
                match has {
                    true => samples(&call, &served, layout, name, [*row, *column]).await,
                    false => Err(absent()),
                }
            }
            _ => Err(absent()),
        },
    }
}

/// Metadata, as builds write it.
fn text(call: &Call, metadata: &Value) -> Result<Response, Refusal> {
    answer::text(&call.headers, "application/json", &format!("{metadata:#}\n"), call.is_private())
}

/// The group of all levels, with a copy of their metadata.
fn group_of_levels(levels: &[ZarrLayout]) -> Value {
    let mut members = Vec::new();
    let mut layout = Vec::new();
    for (level, own) in levels.iter().enumerate() {
        let mut group = own.group();
        for (name, array) in own.arrays() {
            members.push((format!("{level}/{name}"), array));
        }
        group["consolidated_metadata"] = json!({ "kind": "inline", "must_understand": false, "metadata": {} });
        members.push((level.to_string(), group));
        layout.push(match level {
            0 => json!({ "asset": "0" }),
            _ => json!({
                "asset": level.to_string(),
                "derived_from": (level - 1).to_string(),
                "transform": { "scale": [2.0, 2.0], "translation": [0.0, 0.0] },
            }),
        });
    }
    let attributes = json!({
        "zarr_conventions": [{
            "uuid": MULTISCALES,
            "name": "multiscales",
            "description": "Multiscale layout of zarr datasets",
            "spec_url": "https://github.com/zarr-conventions/multiscales/blob/v0.1/README.md",
            "schema_url": "https://raw.githubusercontent.com/zarr-conventions/multiscales/refs/tags/v0.1/schema.json",
        }],
        "multiscales": { "layout": layout },
    });
    orogen::io::format::zarr::metadata::group(&members, attributes)
}

/// A chunk of coordinates.
async fn coordinates(
    call: &Call,
    served: &Served,
    layout: &ZarrLayout,
    axis: usize,
    chunk: usize,
) -> Result<Response, Refusal> {
    let key = format!("zarr {} {} {:?} {} {chunk}", served.name, served.version, layout.window, axis);
    let layout = layout.clone();
    let work =
        async || Ok(Box::new(move |_: &orogen::Progress| Ok(layout.coordinate_chunk(axis, chunk)?.into())) as Work);
    call.worked(served, (key, Keep::Nothing), CHUNK, work).await
}

/// The media type of chunks.
const CHUNK: &str = "application/octet-stream";

/// A chunk of samples.
async fn samples(
    call: &Call,
    served: &Served,
    layout: &ZarrLayout,
    layer: &str,
    [row, column]: [usize; 2],
) -> Result<Response, Refusal> {
    let fingerprint = hex::encode(&served.fingerprint(layer)?);
    let window = layout.chunk_window(row, column);
    let key = format!("zarr {} {layer} {fingerprint} {} {window:?}", served.name, layout.tile);
    let (world, budget) = (served.world_of(layer)?, served.session().budget().clone());
    let (layout, layer) = (layout.clone(), layer.to_string());
    let work = async || {
        Ok(Box::new(move |progress: &orogen::Progress| {
            let _scratch = budget.reserve(layout.scratch_memory())?;
            let grid = world.grids(&[&layer], &window, progress)?.pop();
            let grid = grid.ok_or_else(|| Refusal::absent("the layer has no samples"))?;
            Ok(layout.chunk(&grid)?.into())
        }) as Work)
    };
    call.worked(served, (key, Keep::Tile), CHUNK, work).await
}

impl Served {
    /// The levels of the store, the finest first.
    fn zarr_levels(&self) -> Result<&[ZarrLayout], Refusal> {
        if let Some(levels) = self.zarr.get() {
            return Ok(levels);
        }
        let levels = levels(self)?;
        Ok(self.zarr.get_or_init(|| levels))
    }
}

/// The layers of one number a sample: their names, units and worlds.
fn layers(served: &Served) -> Vec<(String, String, Arc<World>)> {
    let mut layers = Vec::new();
    for layer in served.layers() {
        let has_channels =
            layer.unit.is_empty() && list::named(&layer.name).is_some_and(|own| own.channels().is_some());
        if has_channels || layer.name == LEVELS || ZarrLayout::axis(&layer.name).is_some() {
            continue;
        }
        let Ok(world) = served.world_of(&layer.name) else { continue };
        let Ok(unit) = world.unit(&layer.name) else { continue };
        layers.push((layer.name, unit.to_string(), world));
    }
    layers
}

/// Levels until the world is a single chunk.
fn levels(served: &Served) -> Result<Vec<ZarrLayout>, Refusal> {
    let tile = Form::Zarr.usual_tile().unwrap_or(1);
    let layers = layers(served);
    let mut hash = Sha256::new();
    for (name, _, world) in &layers {
        hash.update(world.key(name)?);
    }
    let first = ZarrLayout {
        about: served.recipe().about.clone(),
        recipe: hex::encode(&hash.finalize()),
        layers: layers.into_iter().map(|(name, unit, _)| (name, unit)).collect(),
        window: window(served, 0)?,
        tile,
        map: served.map(),
    };
    let mut levels = vec![first];
    while let Some(last) = levels.last().filter(|last| last.window.width.max(last.window.height) > tile) {
        let Ok(window) = window(served, levels.len() as u32) else { break };
        levels.push(ZarrLayout { window, ..last.clone() });
    }
    Ok(levels)
}

/// The window of a level.
fn window(served: &Served, level: u32) -> Result<Window, Refusal> {
    let spec = &served.recipe().world;
    let cell = spec.cell * f64::from(1u32 << level.min(31));
    if spec.size.is_some() {
        return Ok(served.world().full_window(cell)?);
    }
    let side = UNBOUNDED_SIDE >> level;
    Ok(Window::new(side, side, cell).at(-(side as i64 / 2), -(side as i64 / 2)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_read() {
        for (key, expect) in [
            ("zarr.json", Some(Item::Group(0))),
            ("height/zarr.json", Some(Item::Array(0, "height"))),
            ("node.layer/c/0/12", Some(Item::Chunk(0, "node.layer", vec![0, 12]))),
            ("x/c/3", Some(Item::Chunk(0, "x", vec![3]))),
            ("levels/zarr.json", Some(Item::Levels)),
            ("levels/2/zarr.json", Some(Item::Group(2))),
            ("levels/10/height/c/0/0", Some(Item::Chunk(10, "height", vec![0, 0]))),
            ("", None),
            (".zarray", None),
            ("height", None),
            ("height/.zarray", None),
            ("height/c", None),
            ("height/c/0/0/0", None),
            ("height/c/-1/0", None),
            ("height/c/00/0", None),
            ("height/c/+1/0", None),
            ("height/c/99999999999999999999/0", None),
            ("levels/a/zarr.json", None),
            ("levels", None),
            ("levels/0/levels/0/zarr.json", None),
        ] {
            assert_eq!(Item::of(key), expect, "{key}");
        }
    }
}

//! Tilesets of the map editor Tiled (.tsx) with wang sets, which Tiled also calls terrain sets.
//!
//! Each color of a wang set is a terrain class. If every tile has only one color, the tiles belong to layers, and all
//! wang sets of the file are used: their colors are the classes, bottom to top. If the first of them has tiles for its
//! borders, a class `none` without tiles is added below it. If there are tiles of several colors, they are wang tiles
//! of one wang set.

use std::path::Path;

use orogen_grid::autotile::flip::{Flip, Flips};
use orogen_grid::autotile::mask::Layout;
use orogen_grid::error::Result;
use orogen_io::format::xml;
use roxmltree::Node;

use super::loaded::{Loaded, text, unusable};
use super::picture::{Cut, Grid, color, cut};
use crate::tilemap::tileset::{Fit, Terrain, Tile, Tileset};

/// Maximum number of terrain classes.
const MAX_CLASSES: usize = 254;

/// A wang set as stored in the file. Colors are numbered from 1; 0 is none.
struct Set {
    name: String,
    layout: Layout,
    colors: Vec<Terrain>,
    tiles: Vec<(u32, [u8; 8])>,
}

/// Reads the tileset and its picture. `wang_set` names the wang set to use.
///
/// # Errors
/// If a file cannot be read, there is no such wang set, or the wang sets cannot be combined.
pub fn load(path: &Path, wang_set: Option<&str>) -> Result<Loaded> {
    read(path, &text(path)?, wang_set, cut)
}

/// Reads the text of a tileset; `cut` cuts its picture into tiles.
pub(super) fn read(
    path: &Path,
    text: &str,
    wang_set: Option<&str>,
    cut: impl Fn(&Path, &Grid) -> Result<Cut>,
) -> Result<Loaded> {
    let failed = |why: String| unusable(path, &why);
    let document = xml::parse(text, false).map_err(&failed)?;
    let root = document.root_element();
    if root.tag_name().name() != "tileset" {
        return Err(failed(format!("its content is a `{}`, not a tileset of Tiled", root.tag_name().name())));
    }
    let Some(image) = root.children().find(|node| node.has_tag_name("image")) else {
        return Err(failed("it has no picture of all tiles; collections of pictures are not supported".into()));
    };
    let size = whole(&root, "tilewidth").map_err(&failed)?;
    let height = whole(&root, "tileheight").map_err(&failed)?;
    if size == 0 || size != height {
        return Err(failed(format!("its tiles have {size} x {height} pixels; they must be squares")));
    }
    let source = image.attribute("source").ok_or_else(|| failed("its picture has no file".into()))?;
    let picture = path.parent().unwrap_or(Path::new("")).join(source);
    let optional = |name: &str| if root.has_attribute(name) { whole(&root, name).map_err(&failed) } else { Ok(0) };
    let grid = Grid {
        size,
        margin: optional("margin")?,
        spacing: optional("spacing")?,
        transparent: image.attribute("trans").and_then(color),
    };
    let Cut { count, columns, pixels } = cut(&picture, &grid)?;
    // A picture may end with unused positions for tiles.
    let count =
        if root.has_attribute("tilecount") { count.min(whole(&root, "tilecount").map_err(&failed)?) } else { count };
    let mut sets = sets(&root, count).map_err(&failed)?;
    let names = sets.iter().map(|set| format!("`{}`", set.name)).collect::<Vec<_>>().join(", ");
    if sets.is_empty() {
        return Err(failed(
            "it has no wang set (terrain set) with a tile; make one in Tiled, or write a description".into(),
        ));
    }
    if let Some(name) = wang_set {
        if !sets.iter().any(|set| set.name == name) {
            return Err(failed(format!("it has no wang set `{name}`; it has {names}")));
        }
        sets.retain(|set| set.name == name);
    }
    let is_wang = sets.iter().any(|set| set.tiles.iter().any(|(_, id)| several(id)));
    let differ = sets.iter().any(|set| set.layout != sets[0].layout);
    if sets.len() > 1 && (is_wang || differ) {
        return Err(failed(format!("it has several wang sets; choose one with --wang-set: {names}")));
    }
    let layout = sets[0].layout;
    let weights = weights(&root).map_err(&failed)?;
    let weight = |tile: u32| weights.iter().find(|(of, _)| *of == tile).map_or(1.0, |(_, weight)| *weight);
    let (terrains, mut tiles) = if is_wang { wang(&sets[0]) } else { layered(&sets, layout) };
    if terrains.len() > MAX_CLASSES {
        return Err(failed(format!("it has more than {MAX_CLASSES} terrains")));
    }
    tiles.retain(|tile| weight(tile.picture) > 0.0);
    tiles.iter_mut().for_each(|tile| tile.weight = weight(tile.picture));
    if tiles.is_empty() {
        return Err(failed(
            "its wang set has no tile with all its sides and corners set and a probability above 0".into(),
        ));
    }
    let tileset = Tileset {
        name: root.attribute("name").unwrap_or("tiles").into(),
        size,
        layout,
        is_wang,
        terrains,
        tiles,
        flips: Flips::default(),
        prefers_unturned: false,
        count,
        columns,
        pixels,
    };
    let turns = root.children().find(|node| node.has_tag_name("transformations"));
    let allows = |name: &str| turns.is_some_and(|node| ["1", "true"].contains(&node.attribute(name).unwrap_or("0")));
    let flips = Flips { x: allows("hflip"), y: allows("vflip"), turns: allows("rotate") };
    Ok(Loaded { tileset: tileset.with_flips(flips, allows("preferuntransformed")), picture })
}

/// An integer attribute of an element.
fn whole(node: &Node, name: &str) -> std::result::Result<usize, String> {
    let text = node.attribute(name).ok_or_else(|| format!("its `{}` has no `{name}`", node.tag_name().name()))?;
    let number = text.parse().ok().filter(|number| *number <= 1 << 24);
    number.ok_or_else(|| format!("`{name}` is `{text}`, not a whole number up to 16777216"))
}

/// Whether a wang id has several colors.
fn several(id: &[u8; 8]) -> bool {
    let mut colors = id.iter().filter(|color| **color != 0);
    let first = colors.next();
    colors.any(|color| Some(color) != first)
}

/// The wang sets with a tile.
fn sets(root: &Node, count: usize) -> std::result::Result<Vec<Set>, String> {
    let named = |node: &Node| node.attribute("name").unwrap_or_default().to_string();
    let mut sets = Vec::new();
    for node in root.children().filter(|node| node.has_tag_name("wangsets")).flat_map(|node| node.children()) {
        if !node.has_tag_name("wangset") {
            continue;
        }
        let name = named(&node);
        let layout = match node.attribute("type") {
            Some("corner") => Layout::Corner,
            Some("edge") => Layout::Edge,
            Some("mixed") => Layout::Blob,
            _ => return Err(format!("the wang set `{name}` has no type; save the tileset with Tiled 1.5 or later")),
        };
        let colors: Vec<Terrain> = (node.children().filter(|node| node.has_tag_name("wangcolor")))
            .map(|node| Terrain {
                name: named(&node),
                color: node.attribute("color").and_then(color).unwrap_or([128; 3]),
            })
            .collect();
        let mut tiles = Vec::new();
        for tile in node.children().filter(|node| node.has_tag_name("wangtile")) {
            let id = whole(&tile, "tileid")?;
            if id >= count {
                return Err(format!("the wang set `{name}` has the tile {id}, but the picture has {count} tiles"));
            }
            let text = tile.attribute("wangid").unwrap_or_default();
            let found: Vec<u8> = text.split(',').map_while(|color| color.trim().parse().ok()).collect();
            let Ok(wang) = <[u8; 8]>::try_from(found) else {
                return Err(format!(
                    "the wang id `{text}` of the tile {id} is not eight numbers; save the tileset with Tiled 1.5 or later"
                ));
            };
            if let Some(unknown) = wang.iter().find(|color| usize::from(**color) > colors.len()) {
                return Err(format!(
                    "the wang id of the tile {id} has the color {unknown}, but the wang set `{name}` has {}",
                    colors.len()
                ));
            }
            let directions = layout.directions();
            let known = std::array::from_fn(|bit| if directions >> bit & 1 == 1 { wang[bit] } else { 0 });
            if known != [0; 8] {
                tiles.push((id as u32, known));
            }
        }
        if !tiles.is_empty() {
            sets.push(Set { name, layout, colors, tiles });
        }
    }
    Ok(sets)
}

/// The weights of tiles, where they are not 1.
fn weights(root: &Node) -> std::result::Result<Vec<(u32, f32)>, String> {
    let tiles = root.children().filter(|node| node.has_tag_name("tile"));
    let weight = |node: Node| {
        let text = node.attribute("probability")?;
        let id: u32 = node.attribute("id")?.parse().ok()?;
        let weight = text.parse().ok().filter(|weight: &f32| weight.is_finite() && *weight >= 0.0);
        Some(weight.map(|weight| (id, weight)).ok_or_else(|| {
            format!("the probability of its tile {id} is `{}`; it must be a number of at least 0", text.escape_debug())
        }))
    };
    tiles.filter_map(weight).collect()
}

/// The classes and tiles of a set with tiles of several colors. Tiles that lack a color somewhere are omitted.
fn wang(set: &Set) -> (Vec<Terrain>, Vec<Tile>) {
    let directions = set.layout.directions();
    let is_whole = |id: &[u8; 8]| (0..8).all(|bit| directions >> bit & 1 == 0 || id[bit] != 0);
    let tiles = set.tiles.iter().filter(|(_, id)| is_whole(id));
    let tile = |(picture, id): &(u32, [u8; 8])| {
        let fit = Fit::Wang(id.map(|color| color.saturating_sub(1)));
        Tile { picture: *picture, flip: Flip::NONE, fit, weight: 1.0 }
    };
    (set.colors.clone(), tiles.map(tile).collect())
}

/// The classes and tiles of sets whose tiles have one color.
fn layered(sets: &[Set], layout: Layout) -> (Vec<Terrain>, Vec<Tile>) {
    let mut terrains = Vec::new();
    let mut tiles = Vec::new();
    for set in sets {
        for (nth, terrain) in set.colors.iter().enumerate() {
            for (picture, id) in &set.tiles {
                let mask = (0..8).filter(|bit| usize::from(id[*bit]) == nth + 1).fold(0, |mask, bit| mask | 1 << bit);
                if mask != 0 {
                    let fit = Fit::Layer { class: terrains.len() as u8, mask: layout.reduced(mask) };
                    tiles.push(Tile { picture: *picture, flip: Flip::NONE, fit, weight: 1.0 });
                }
            }
            terrains.push(terrain.clone());
        }
    }
    let is_border = |tile: &Tile| matches!(tile.fit, Fit::Layer { class: 0, mask } if !layout.is_full(mask));
    if tiles.iter().any(is_border) {
        terrains.insert(0, Terrain { name: "none".into(), color: [0; 3] });
        for tile in &mut tiles {
            if let Fit::Layer { class, .. } = &mut tile.fit {
                *class += 1;
            }
        }
    }
    (terrains, tiles)
}

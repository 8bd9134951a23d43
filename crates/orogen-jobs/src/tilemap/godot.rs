//! Resources of Godot 4.3 and later: a TileSet, and a scene with a TileMapLayer for each layer and a Marker2D for each
//! scattered object.
//!
//! The formats are Godot's text resources (docs.godotengine.org, "TSCN file format"). The cells of a TileMapLayer are
//! bytes: a version, and for each cell its column, row, source, and the column, row and flips of its tile, all as 16
//! bits little-endian.

use std::io::{self, Write};

use orogen_grid::autotile::flip::Flip;
use orogen_grid::autotile::mask::Layout;
use orogen_io::records::Records;

use super::map::Tilemap;
use super::tileset::{Fit, Tile, Tileset};
use orogen_output::markup::Base64;
use orogen_output::tilemap::rows::godot_cells;

/// The largest column and row of a cell, which have 16 bits.
const MAX_PLACE: usize = 32_767;

/// Maximum number of tiles of a layer: a scene takes 16 characters for each.
const MAX_TILES: usize = 1 << 24;

/// The names of the directions, clockwise from the north.
const DIRECTIONS: [&str; 8] = [
    "top_side",
    "top_right_corner",
    "right_side",
    "bottom_right_corner",
    "bottom_side",
    "bottom_left_corner",
    "left_side",
    "top_left_corner",
];

/// Writes the tileset as a TileSet with terrains. `image` is the name of its picture in the same folder, and `made_by`
/// is the program.
///
/// # Errors
/// If `out` fails.
pub fn write_tileset(tileset: &Tileset, out: &mut dyn Write, image: &str, made_by: &str) -> io::Result<()> {
    let size = tileset.size;
    writeln!(out, "[gd_resource type=\"TileSet\" load_steps=3 format=3]\n; made by {made_by}\n")?;
    writeln!(out, "[ext_resource type=\"Texture2D\" path={} id=\"1\"]\n", text(image))?;
    writeln!(out, "[sub_resource type=\"TileSetAtlasSource\" id=\"1\"]\ntexture = ExtResource(\"1\")")?;
    writeln!(out, "texture_region_size = Vector2i({size}, {size})")?;
    let mut own: Vec<&Tile> = tileset.tiles.iter().filter(|tile| tile.flip == Flip::NONE).collect();
    own.sort_by_key(|tile| tile.picture);
    own.dedup_by_key(|tile| tile.picture);
    for tile in own {
        let picture = tile.picture as usize;
        let place = format!("{}:{}/0", picture % tileset.columns, picture / tileset.columns);
        writeln!(out, "{place} = 0")?;
        if tile.weight != 1.0 {
            writeln!(out, "{place}/probability = {:?}", tile.weight)?;
        }
        if tileset.layout == Layout::Rule {
            continue;
        }
        let directions = tileset.layout.directions();
        let (set, terrain, terrains): (usize, u8, [Option<u8>; 8]) = match tile.fit {
            Fit::Layer { class, mask } => {
                (usize::from(class), 0, std::array::from_fn(|bit| (mask >> bit & 1 == 1).then_some(0)))
            }
            Fit::Wang(id) => {
                let known: [Option<u8>; 8] = std::array::from_fn(|bit| (directions >> bit & 1 == 1).then_some(id[bit]));
                let often = |class: u8| known.iter().filter(|of| **of == Some(class)).count();
                let most = known.iter().flatten().copied().max_by_key(|class| (often(*class), *class));
                (0, most.unwrap_or_default(), known)
            }
        };
        writeln!(out, "{place}/terrain_set = {set}\n{place}/terrain = {terrain}")?;
        for (direction, terrain) in DIRECTIONS.iter().zip(terrains) {
            if let Some(terrain) = terrain {
                writeln!(out, "{place}/terrains_peering_bit/{direction} = {terrain}")?;
            }
        }
    }
    writeln!(out, "\n[resource]\ntile_size = Vector2i({size}, {size})")?;
    let mode = match tileset.layout {
        Layout::Edge => 2,
        Layout::Corner | Layout::Dual => 1,
        _ => 0,
    };
    let mut last = None;
    for (class, terrain) in tileset.terrains.iter().enumerate().filter(|_| tileset.layout != Layout::Rule) {
        let (set, nth) = if tileset.is_wang { (0, class) } else { (class, 0) };
        if last != Some(set) {
            writeln!(out, "terrain_set_{set}/mode = {mode}")?;
            last = Some(set);
        }
        let [red, green, blue] = terrain.color.map(|part| f64::from(part) / 255.0);
        writeln!(out, "terrain_set_{set}/terrain_{nth}/name = {}", text(&terrain.name))?;
        writeln!(out, "terrain_set_{set}/terrain_{nth}/color = Color({red:.4}, {green:.4}, {blue:.4}, 1)")?;
    }
    writeln!(out, "sources/0 = SubResource(\"1\")")
}

impl Tilemap {
    /// Whether the map can be a Godot scene: it has at most 32767 tiles along a side, and at most 2^24 tiles, because a
    /// scene lists each tile.
    #[must_use]
    pub fn fits_godot(&self) -> bool {
        self.width.max(self.height) <= MAX_PLACE && self.width * self.height <= MAX_TILES
    }

    /// Writes the map as a scene. `tileset` is the name of the TileSet in the same folder, and `made_by` is the
    /// program.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_tscn(&self, out: &mut dyn Write, tileset: &str, made_by: &str) -> io::Result<()> {
        writeln!(out, "[gd_scene load_steps=2 format=4]\n; made by {made_by}\n")?;
        writeln!(out, "[ext_resource type=\"TileSet\" path={} id=\"1\"]\n", text(tileset))?;
        // Nearest-neighbor filtering, for crisp pixels.
        writeln!(out, "[node name=\"Map\" type=\"Node2D\"]\ntexture_filter = 1")?;
        for (name, tiles) in self.used() {
            writeln!(out, "\n[node name={} type=\"TileMapLayer\" parent=\".\"]", text(&node_name(name)))?;
            write!(out, "tile_map_data = PackedByteArray(\"")?;
            let mut cells = Base64::new(out);
            self.write_cells(&mut cells, tiles)?;
            cells.finish()?;
            writeln!(out, "\")\ntile_set = ExtResource(\"1\")")?;
        }
        if self.objects.is_empty() {
            return Ok(());
        }
        writeln!(out, "\n[node name=\"objects\" type=\"Node2D\" parent=\".\"]")?;
        let size = self.tileset.size as f64;
        self.each_object(|nth, object| {
            let kind = &self.kinds[object.kind];
            let name = text(&node_name(&format!("{kind} {}", nth + 1)));
            writeln!(out, "\n[node name={name} type=\"Marker2D\" parent=\"objects\" groups=[{}]]", text(kind))?;
            let [x, y] = object.position.map(|at| at * size);
            writeln!(out, "position = Vector2({x:.2}, {y:.2})\nrotation = {:.5}", object.turn.to_radians())?;
            writeln!(out, "scale = Vector2({size:.4}, {size:.4})", size = object.size)
        })
    }

    /// Writes the cells of a layer as Godot stores them.
    fn write_cells(&self, out: &mut dyn Write, tiles: &Records<u32>) -> io::Result<()> {
        out.write_all(&[0; 2])?;
        let (mut reader, mut tiles) = (tiles.reader(), Vec::new());
        for row in 0..self.height {
            reader.read(self.width, &mut tiles)?;
            out.write_all(&godot_cells(&self.tileset, &tiles, row))?;
        }
        Ok(())
    }
}

/// A text in quotes.
fn text(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Converts a name to one that a node may have.
fn node_name(name: &str) -> String {
    name.replace(['.', ':', '@', '/', '"', '%'], "_")
}

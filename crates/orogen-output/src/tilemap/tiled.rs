//! Files for the map editor Tiled: a tileset (TSX), and a map as XML (TMX) and as JSON (TMJ).
//!
//! The formats are those of Tiled 1.8 (doc.mapeditor.org, "TMX Map Format" and "JSON Map Format"). Each terrain above the first has a wang set, so that its
//! borders can be edited with the terrain brush. Each class of a map is a tile layer.

use std::io::{self, Write};

use orogen_grid::autotile::choose::NONE;
use orogen_grid::autotile::mask::Layout;
use serde_json::{Value, json};

use super::job::Tilemap;
use super::tileset::Tileset;
use crate::markup::{base64, escaped};

/// The version of the formats.
const VERSION: &str = "1.8";

/// The first number of the tileset's tiles in a map; 0 is no tile.
const FIRST: u32 = 1;

/// Maximum number of tiles of a map whose layers are lists of numbers, which all programs read. Those of larger maps are compressed.
const MAX_LISTED: usize = 1 << 20;

/// A wang set: the terrain, and the tiles with their eight colours, clockwise from the north.
struct WangSet {
    name: String,
    color: String,
    tiles: Vec<(usize, [u8; 8])>,
}

impl Tileset {
    /// The type of its wang sets.
    fn wang_type(&self) -> &'static str {
        match self.layout {
            Layout::Edge => "edge",
            Layout::Corner | Layout::Dual => "corner",
            _ => "mixed",
        }
    }

    fn wang_sets(&self) -> Vec<WangSet> {
        let set = |class: usize| {
            let terrain = &self.terrains[class];
            let [red, green, blue] = terrain.color;
            let tiles = self.tiles.iter().enumerate().filter(|(_, tile)| usize::from(tile.class) == class);
            let colors = |mask: u8| std::array::from_fn(|bit| mask >> bit & 1);
            WangSet {
                name: terrain.name.clone(),
                color: format!("#{red:02x}{green:02x}{blue:02x}"),
                tiles: tiles.map(|(n, tile)| (n, colors(tile.mask))).collect(),
            }
        };
        (1..self.terrains.len()).map(set).collect()
    }

    /// Writes the tileset as TSX. `image` is the name of its picture beside the file, and `made_by` the program.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_tsx(&self, out: &mut dyn Write, image: &str, made_by: &str) -> io::Result<()> {
        writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}", mark(made_by))?;
        let (name, size, count, columns) = (quoted(&self.name), self.size, self.tiles.len(), self.columns);
        writeln!(
            out,
            "<tileset version=\"{VERSION}\" name=\"{name}\" tilewidth=\"{size}\" tileheight=\"{size}\" tilecount=\"{count}\" columns=\"{columns}\">"
        )?;
        let (image, width, height) = (quoted(image), self.width(), self.height());
        writeln!(out, " <image source=\"{image}\" width=\"{width}\" height=\"{height}\"/>")?;
        for (n, tile) in self.tiles.iter().enumerate().filter(|(_, tile)| tile.weight != 1.0) {
            writeln!(out, " <tile id=\"{n}\" probability=\"{}\"/>", tile.weight)?;
        }
        writeln!(out, " <wangsets>")?;
        for set in self.wang_sets() {
            let (name, kind, color) = (quoted(&set.name), self.wang_type(), &set.color);
            let icon = set.tiles.first().map_or(-1, |(n, _)| *n as i64);
            writeln!(out, "  <wangset name=\"{name}\" type=\"{kind}\" tile=\"{icon}\">")?;
            writeln!(out, "   <wangcolor name=\"{name}\" color=\"{color}\" tile=\"{icon}\" probability=\"1\"/>")?;
            for (n, colors) in set.tiles {
                writeln!(
                    out,
                    "   <wangtile tileid=\"{n}\" wangid=\"{}\"/>",
                    colors.map(|color| color.to_string()).join(",")
                )?;
            }
            writeln!(out, "  </wangset>")?;
        }
        writeln!(out, " </wangsets>\n</tileset>")
    }

    /// The tileset as it is embedded in a map in JSON.
    fn json(&self, image: &str) -> Value {
        let tiles = self.tiles.iter().enumerate().filter(|(_, tile)| tile.weight != 1.0);
        let sets = self.wang_sets().into_iter().map(|set| {
            let icon = set.tiles.first().map_or(-1, |(n, _)| *n as i64);
            let tiles = set.tiles.iter().map(|(n, colors)| json!({ "tileid": n, "wangid": colors }));
            json!({
                "name": set.name, "type": self.wang_type(), "tile": icon,
                "colors": [{ "name": set.name, "color": set.color, "tile": icon, "probability": 1 }],
                "wangtiles": tiles.collect::<Vec<_>>(),
            })
        });
        json!({
            "firstgid": FIRST, "name": self.name, "image": image, "imagewidth": self.width(), "imageheight": self.height(),
            "tilewidth": self.size, "tileheight": self.size, "tilecount": self.tiles.len(), "columns": self.columns,
            "margin": 0, "spacing": 0,
            "tiles": tiles.map(|(n, tile)| json!({ "id": n, "probability": tile.weight })).collect::<Vec<_>>(),
            "wangsets": sets.collect::<Vec<_>>(),
        })
    }
}

impl Tilemap {
    /// The layers with a tile, with their names.
    fn used(&self) -> impl Iterator<Item = (&str, &[u32])> {
        let named = self.tileset.terrains.iter().zip(&self.layers);
        named
            .map(|(terrain, tiles)| (terrain.name.as_str(), tiles.as_slice()))
            .filter(|(_, tiles)| tiles.iter().any(|tile| *tile != NONE))
    }

    fn is_listed(&self) -> bool {
        self.width * self.height <= MAX_LISTED
    }

    /// Writes the map as TMX. `tileset` is the name of the TSX beside the file, and `made_by` the program.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_tmx(&self, out: &mut dyn Write, tileset: &str, made_by: &str) -> io::Result<()> {
        let (width, height, size) = (self.width, self.height, self.tileset.size);
        let layers: Vec<_> = self.used().collect();
        writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}", mark(made_by))?;
        writeln!(
            out,
            "<map version=\"{VERSION}\" orientation=\"orthogonal\" renderorder=\"right-down\" width=\"{width}\" height=\"{height}\" tilewidth=\"{size}\" \
             tileheight=\"{size}\" infinite=\"0\" nextlayerid=\"{}\" nextobjectid=\"1\">",
            layers.len() + 1
        )?;
        writeln!(out, " <properties>\n  <property name=\"cell\" type=\"float\" value=\"{}\"/>", self.window.cell)?;
        writeln!(out, "  <property name=\"seed\" value=\"{}\"/>\n </properties>", self.seed)?;
        writeln!(out, " <tileset firstgid=\"{FIRST}\" source=\"{}\"/>", quoted(tileset))?;
        for (n, (name, tiles)) in layers.into_iter().enumerate() {
            writeln!(out, " <layer id=\"{}\" name=\"{}\" width=\"{width}\" height=\"{height}\">", n + 1, quoted(name))?;
            if self.is_listed() {
                writeln!(out, "  <data encoding=\"csv\">")?;
                let mut rows = tiles.chunks(width).peekable();
                while let Some(row) = rows.next() {
                    let numbers: Vec<String> = row.iter().map(|tile| number(*tile).to_string()).collect();
                    writeln!(out, "{}{}", numbers.join(","), if rows.peek().is_some() { "," } else { "" })?;
                }
            } else {
                write!(out, "  <data encoding=\"base64\" compression=\"zlib\">")?;
                base64(out, &packed(tiles))?;
            }
            writeln!(out, "</data>\n </layer>")?;
        }
        writeln!(out, "</map>")
    }

    /// Writes the map as TMJ, with its tileset. `image` is the name of the tileset's picture beside the file, and `made_by` the program.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_tmj(&self, out: &mut dyn Write, image: &str, made_by: &str) -> io::Result<()> {
        let (width, height, size) = (self.width, self.height, self.tileset.size);
        let layers: Vec<_> = self.used().collect();
        writeln!(out, "{{\n\"made_by\": {},", json!(made_by))?;
        writeln!(
            out,
            "\"type\": \"map\", \"version\": \"{VERSION}\", \"orientation\": \"orthogonal\", \"renderorder\": \"right-down\","
        )?;
        writeln!(out, "\"width\": {width}, \"height\": {height}, \"tilewidth\": {size}, \"tileheight\": {size},")?;
        writeln!(
            out,
            "\"infinite\": false, \"compressionlevel\": -1, \"nextlayerid\": {}, \"nextobjectid\": 1,",
            layers.len() + 1
        )?;
        let properties = json!([
            { "name": "cell", "type": "float", "value": self.window.cell },
            { "name": "seed", "type": "string", "value": self.seed.to_string() },
        ]);
        writeln!(out, "\"properties\": {properties},\n\"layers\": [")?;
        for (n, (name, tiles)) in layers.iter().enumerate() {
            write!(out, "{{\"type\": \"tilelayer\", \"id\": {}, \"name\": {}, ", n + 1, json!(name))?;
            write!(
                out,
                "\"width\": {width}, \"height\": {height}, \"x\": 0, \"y\": 0, \"opacity\": 1, \"visible\": true, "
            )?;
            if self.is_listed() {
                write!(out, "\"data\": [")?;
                for (at, row) in tiles.chunks(width).enumerate() {
                    let numbers: Vec<String> = row.iter().map(|tile| number(*tile).to_string()).collect();
                    write!(out, "{}{}", if at > 0 { ",\n" } else { "" }, numbers.join(","))?;
                }
                write!(out, "]")?;
            } else {
                write!(out, "\"encoding\": \"base64\", \"compression\": \"zlib\", \"data\": \"")?;
                base64(out, &packed(tiles))?;
                write!(out, "\"")?;
            }
            writeln!(out, "}}{}", if n + 1 < layers.len() { "," } else { "" })?;
        }
        writeln!(out, "],\n\"tilesets\": [{}]\n}}", self.tileset.json(image))
    }
}

/// The number of a tile in a map.
fn number(tile: u32) -> u32 {
    if tile == NONE { 0 } else { tile + FIRST }
}

/// The numbers of tiles as 32-bit little-endian, compressed.
fn packed(tiles: &[u32]) -> Vec<u8> {
    let bytes: Vec<u8> = tiles.iter().flat_map(|tile| number(*tile).to_le_bytes()).collect();
    miniz_oxide::deflate::compress_to_vec_zlib(&bytes, 6)
}

/// Text for an attribute of XML.
fn quoted(text: &str) -> String {
    escaped(text).replace('"', "&quot;")
}

/// The comment that marks a file as made by a program, and not by hand.
fn mark(made_by: &str) -> String {
    // Two hyphens end a comment.
    format!("<!-- made by {} -->", escaped(made_by).replace("--", "- -"))
}

//! Files for the map editor Tiled: a tileset (TSX), and a map as XML (TMX) and as JSON (TMJ).
//!
//! The formats are those of Tiled 1.8 (doc.mapeditor.org, "TMX Map Format" and "JSON Map Format"). Each terrain has a wang set, so that its borders can be edited
//! with the terrain brush; wang tiles have one for all terrains. Tiles chosen by rules have none, because such a tile fits many surroundings. Each class of a map
//! is a tile layer; wang tiles have one layer.

use std::io::{self, Write};

use orogen_grid::autotile::choose::NONE;
use orogen_grid::autotile::flip::{Flip, Flips};
use orogen_grid::autotile::mask::Layout;
use serde_json::{Value, json};

use super::job::Tilemap;
use super::tileset::{Fit, Tileset};
use crate::markup::{base64, escaped};

/// The version of the formats.
const VERSION: &str = "1.8";

/// The first number of the tileset's tiles in a map; 0 is no tile.
const FIRST: u32 = 1;

/// Maximum number of tiles of a map whose layers are lists of numbers, which all programs read. Those of larger maps are compressed.
const MAX_LISTED: usize = 1 << 20;

/// A wang set: its colours, and the tiles with their eight colours, clockwise from the north.
struct WangSet {
    name: String,
    colors: Vec<WangColor>,
    tiles: Vec<(u32, [u8; 8])>,
}

/// A colour of a wang set: a terrain.
struct WangColor {
    name: String,
    color: String,
    /// A tile that shows it; -1 if there is none.
    tile: i64,
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
        let own = || self.tiles.iter().filter(|tile| tile.flip == Flip::NONE);
        let color = |class: usize, tiles: &[(u32, [u8; 8])], number: u8| {
            let terrain = &self.terrains[class];
            let [red, green, blue] = terrain.color;
            let shows = |(_, colors): &&(u32, [u8; 8])| colors.iter().all(|color| [0, number].contains(color));
            WangColor {
                name: terrain.name.clone(),
                color: format!("#{red:02x}{green:02x}{blue:02x}"),
                tile: tiles.iter().find(shows).map_or(-1, |(tile, _)| i64::from(*tile)),
            }
        };
        if self.is_wang {
            let directions = self.layout.directions();
            // Colours are numbered from 1, and 0 stands for what a layout does not tell apart.
            let colors = |id: [u8; 8]| std::array::from_fn(|bit| (id[bit] + 1) * (directions >> bit & 1));
            let tiles: Vec<(u32, [u8; 8])> = own()
                .filter_map(|tile| match tile.fit {
                    Fit::Wang(id) => Some((tile.picture, colors(id))),
                    Fit::Layer { .. } => None,
                })
                .collect();
            let terrains = 0..self.terrains.len();
            let colors = terrains.map(|class| color(class, &tiles, class as u8 + 1)).collect();
            return vec![WangSet { name: "terrain".into(), colors, tiles }];
        }
        if self.layout == Layout::Rule {
            return Vec::new();
        }
        let set = |class: usize| {
            let colors = |mask: u8| std::array::from_fn(|bit| mask >> bit & 1);
            let tiles: Vec<(u32, [u8; 8])> = own()
                .filter_map(|tile| match tile.fit {
                    // A tile without any colour is no part of a wang set.
                    Fit::Layer { class: of, mask } if usize::from(of) == class && mask != 0 => {
                        Some((tile.picture, colors(mask)))
                    }
                    _ => None,
                })
                .collect();
            WangSet { name: self.terrains[class].name.clone(), colors: vec![color(class, &tiles, 1)], tiles }
        };
        (0..self.terrains.len()).map(set).filter(|set| !set.tiles.is_empty()).collect()
    }

    /// The tiles of the picture that are drawn more or less often than others, with their weights.
    fn weights(&self) -> Vec<(u32, f32)> {
        let mut weights: Vec<(u32, f32)> = (self.tiles.iter())
            .filter(|tile| tile.weight != 1.0 && tile.flip == Flip::NONE)
            .map(|tile| (tile.picture, tile.weight))
            .collect();
        weights.sort_by_key(|(tile, _)| *tile);
        weights.dedup_by_key(|(tile, _)| *tile);
        weights
    }

    /// Writes the tileset as TSX. `image` is the name of its picture beside the file, and `made_by` the program.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_tsx(&self, out: &mut dyn Write, image: &str, made_by: &str) -> io::Result<()> {
        writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}", mark(made_by))?;
        let (name, size, count, columns) = (quoted(&self.name), self.size, self.count, self.columns);
        writeln!(
            out,
            "<tileset version=\"{VERSION}\" name=\"{name}\" tilewidth=\"{size}\" tileheight=\"{size}\" tilecount=\"{count}\" columns=\"{columns}\">"
        )?;
        if self.flips != Flips::default() {
            let Flips { x, y, turns } = self.flips;
            let [x, y, turns, prefers] = [x, y, turns, self.prefers_unturned].map(u8::from);
            writeln!(
                out,
                " <transformations hflip=\"{x}\" vflip=\"{y}\" rotate=\"{turns}\" preferuntransformed=\"{prefers}\"/>"
            )?;
        }
        let (image, width, height) = (quoted(image), self.width(), self.height());
        writeln!(out, " <image source=\"{image}\" width=\"{width}\" height=\"{height}\"/>")?;
        for (tile, weight) in self.weights() {
            writeln!(out, " <tile id=\"{tile}\" probability=\"{weight}\"/>")?;
        }
        writeln!(out, " <wangsets>")?;
        for set in self.wang_sets() {
            let (name, kind) = (quoted(&set.name), self.wang_type());
            let icon = set.colors.first().map_or(-1, |color| color.tile);
            writeln!(out, "  <wangset name=\"{name}\" type=\"{kind}\" tile=\"{icon}\">")?;
            for WangColor { name, color, tile } in &set.colors {
                let name = quoted(name);
                writeln!(out, "   <wangcolor name=\"{name}\" color=\"{color}\" tile=\"{tile}\" probability=\"1\"/>")?;
            }
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
        let sets = self.wang_sets().into_iter().map(|set| {
            let icon = set.colors.first().map_or(-1, |color| color.tile);
            let colors = set.colors.iter().map(|WangColor { name, color, tile }| {
                json!({ "name": name, "color": color, "tile": tile, "probability": 1 })
            });
            let tiles = set.tiles.iter().map(|(n, colors)| json!({ "tileid": n, "wangid": colors }));
            json!({
                "name": set.name, "type": self.wang_type(), "tile": icon,
                "colors": colors.collect::<Vec<_>>(),
                "wangtiles": tiles.collect::<Vec<_>>(),
            })
        });
        let mut tileset = json!({
            "firstgid": FIRST, "name": self.name, "image": image, "imagewidth": self.width(), "imageheight": self.height(),
            "tilewidth": self.size, "tileheight": self.size, "tilecount": self.count, "columns": self.columns,
            "margin": 0, "spacing": 0,
            "tiles": (self.weights().into_iter())
                .map(|(tile, weight)| json!({ "id": tile, "probability": weight }))
                .collect::<Vec<_>>(),
            "wangsets": sets.collect::<Vec<_>>(),
        });
        if self.flips != Flips::default() {
            let (Flips { x, y, turns }, prefers) = (self.flips, self.prefers_unturned);
            tileset["transformations"] =
                json!({ "hflip": x, "vflip": y, "rotate": turns, "preferuntransformed": prefers });
        }
        tileset
    }
}

/// Tiles along a side of a chunk of an infinite map.
const CHUNK: usize = 16;

/// A chunk of a layer of an infinite map: where it begins, and its tiles.
struct Chunk {
    x: i64,
    y: i64,
    tiles: Vec<u32>,
}

impl Tilemap {
    /// The chunks of a layer that have a tile, at the positions of the world's cells.
    fn chunks(&self, tiles: &[u32]) -> Vec<Chunk> {
        let side = CHUNK as i64;
        let ends = |from: i64, length: usize| from.div_euclid(side)..(from + length as i64 + side - 1).div_euclid(side);
        let (columns, rows) = (ends(self.window.x, self.width), ends(self.window.y, self.height));
        let places = rows.flat_map(|row| columns.clone().map(move |column| [column * side, row * side]));
        let chunk = |[x, y]: [i64; 2]| {
            let at = |place: usize| {
                let [column, row] =
                    [x - self.window.x + (place % CHUNK) as i64, y - self.window.y + (place / CHUNK) as i64];
                let is_inside = (0..self.width as i64).contains(&column) && (0..self.height as i64).contains(&row);
                if is_inside { tiles[row as usize * self.width + column as usize] } else { NONE }
            };
            let tiles: Vec<u32> = (0..CHUNK * CHUNK).map(at).collect();
            tiles.iter().any(|tile| *tile != NONE).then_some(Chunk { x, y, tiles })
        };
        places.filter_map(chunk).collect()
    }

    /// Tiles from the origin of the map in a file to the upper left tile.
    fn place(&self) -> [i64; 2] {
        if self.is_infinite { [self.window.x, self.window.y] } else { [0, 0] }
    }

    /// The pixel of a position on the map in a file.
    fn pixel(&self, position: [f64; 2]) -> [f64; 2] {
        let ([left, top], size) = (self.place(), self.tileset.size as f64);
        [(position[0] + left as f64) * size, (position[1] + top as f64) * size]
    }

    /// The layers with a tile, with their names.
    fn used(&self) -> impl Iterator<Item = (&str, &[u32])> {
        let named = self.tileset.layer_names().into_iter().zip(&self.layers);
        named.map(|(name, tiles)| (name, tiles.as_slice())).filter(|(_, tiles)| tiles.iter().any(|tile| *tile != NONE))
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
        let objects = layers.len() + 1;
        writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}", mark(made_by))?;
        writeln!(
            out,
            "<map version=\"{VERSION}\" orientation=\"orthogonal\" renderorder=\"right-down\" width=\"{width}\" height=\"{height}\" tilewidth=\"{size}\" \
             tileheight=\"{size}\" infinite=\"{}\" nextlayerid=\"{}\" nextobjectid=\"{}\">",
            u8::from(self.is_infinite),
            layers.len() + 2,
            self.objects.len() + 1
        )?;
        writeln!(out, " <properties>\n  <property name=\"cell\" type=\"float\" value=\"{}\"/>", self.window.cell)?;
        writeln!(out, "  <property name=\"seed\" value=\"{}\"/>\n </properties>", self.seed)?;
        writeln!(out, " <tileset firstgid=\"{FIRST}\" source=\"{}\"/>", quoted(tileset))?;
        for (n, (name, tiles)) in layers.into_iter().enumerate() {
            writeln!(out, " <layer id=\"{}\" name=\"{}\" width=\"{width}\" height=\"{height}\">", n + 1, quoted(name))?;
            if self.is_infinite {
                writeln!(out, "  <data encoding=\"csv\">")?;
                for Chunk { x, y, tiles } in self.chunks(tiles) {
                    writeln!(out, "   <chunk x=\"{x}\" y=\"{y}\" width=\"{CHUNK}\" height=\"{CHUNK}\">")?;
                    listed(out, &tiles, CHUNK)?;
                    writeln!(out, "</chunk>")?;
                }
            } else if self.is_listed() {
                writeln!(out, "  <data encoding=\"csv\">")?;
                listed(out, tiles, width)?;
            } else {
                write!(out, "  <data encoding=\"base64\" compression=\"zlib\">")?;
                base64(out, &packed(tiles))?;
            }
            writeln!(out, "</data>\n </layer>")?;
        }
        if !self.objects.is_empty() {
            writeln!(out, " <objectgroup id=\"{objects}\" name=\"objects\">")?;
            for (nth, object) in self.objects.iter().enumerate() {
                let [x, y] = self.pixel(object.position);
                let kind = quoted(&self.kinds[object.kind]);
                writeln!(
                    out,
                    "  <object id=\"{}\" type=\"{kind}\" x=\"{x:.2}\" y=\"{y:.2}\" rotation=\"{:.2}\">",
                    nth + 1,
                    object.turn
                )?;
                let size = object.size;
                writeln!(out, "   <properties>\n    <property name=\"size\" type=\"float\" value=\"{size:.4}\"/>")?;
                writeln!(out, "   </properties>\n   <point/>\n  </object>")?;
            }
            writeln!(out, " </objectgroup>")?;
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
            "\"infinite\": {}, \"compressionlevel\": -1, \"nextlayerid\": {}, \"nextobjectid\": {},",
            self.is_infinite,
            layers.len() + 2,
            self.objects.len() + 1
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
            if self.is_infinite {
                let [x, y] = self.place();
                write!(out, "\"startx\": {x}, \"starty\": {y}, \"chunks\": [")?;
                for (nth, Chunk { x, y, tiles }) in self.chunks(tiles).into_iter().enumerate() {
                    let comma = if nth > 0 { "," } else { "" };
                    write!(
                        out,
                        "{comma}\n{{\"x\": {x}, \"y\": {y}, \"width\": {CHUNK}, \"height\": {CHUNK}, \"data\": [\n"
                    )?;
                    listed(out, &tiles, CHUNK)?;
                    write!(out, "]}}")?;
                }
                write!(out, "]")?;
            } else if self.is_listed() {
                writeln!(out, "\"data\": [")?;
                listed(out, tiles, width)?;
                write!(out, "]")?;
            } else {
                write!(out, "\"encoding\": \"base64\", \"compression\": \"zlib\", \"data\": \"")?;
                base64(out, &packed(tiles))?;
                write!(out, "\"")?;
            }
            writeln!(out, "}}{}", if n + 1 < layers.len() { "," } else { "" })?;
        }
        if !self.objects.is_empty() {
            let comma = if layers.is_empty() { "" } else { "," };
            writeln!(
                out,
                "{comma}{{\"type\": \"objectgroup\", \"id\": {}, \"name\": \"objects\", \"draworder\": \"topdown\", \"x\": 0, \"y\": 0, \
                 \"opacity\": 1, \"visible\": true, \"objects\": [",
                layers.len() + 1
            )?;
            for (nth, object) in self.objects.iter().enumerate() {
                let [x, y] = self.pixel(object.position).map(|at| (at * 100.0).round() / 100.0);
                let rotation = (object.turn * 100.0).round() / 100.0;
                let own = json!({
                    "id": nth + 1, "name": "", "type": self.kinds[object.kind], "x": x, "y": y, "width": 0, "height": 0, "rotation": rotation,
                    "visible": true, "point": true,
                    "properties": [{ "name": "size", "type": "float", "value": (object.size * 1e4).round() / 1e4 }],
                });
                writeln!(out, "{own}{}", if nth + 1 < self.objects.len() { "," } else { "" })?;
            }
            writeln!(out, "]}}")?;
        }
        writeln!(out, "],\n\"tilesets\": [{}]\n}}", self.tileset.json(image))
    }
}

/// Writes the numbers of tiles row by row, separated by commas.
fn listed(out: &mut dyn Write, tiles: &[u32], width: usize) -> io::Result<()> {
    let mut rows = tiles.chunks(width.max(1)).peekable();
    while let Some(row) = rows.next() {
        let numbers: Vec<String> = row.iter().map(|tile| number(*tile).to_string()).collect();
        writeln!(out, "{}{}", numbers.join(","), if rows.peek().is_some() { "," } else { "" })?;
    }
    Ok(())
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

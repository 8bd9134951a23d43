//! Files for the map editor Tiled: a tileset (TSX), and a map as XML (TMX) and as JSON (TMJ).
//!
//! The formats are those of Tiled 1.8 (doc.mapeditor.org, "TMX Map Format" and "JSON Map Format"). Each terrain has a
//! wang set, so that its borders can be edited with the terrain brush; wang tiles have one wang set for all terrains.
//! Tiles chosen by rules have none, because such a tile fits many surroundings. Each class of a map is a tile layer;
//! wang tiles have a single layer.

use std::io::{self, Write};

use orogen_grid::autotile::flip::{Flip, Flips};
use orogen_grid::autotile::mask::Layout;
use orogen_io::records::Records;
use serde_json::{Value, json};

use super::map::Tilemap;
use super::tileset::{Fit, Tileset};
use orogen_output::markup::{Base64, escaped};
use orogen_output::tilemap::rows::listed;

/// The version of the formats.
const VERSION: &str = "1.8";

/// The version of Tiled in the files: it determines how readers interpret an infinite map.
const TILED: &str = "1.8.6";

/// The first number of the tileset's tiles in a map; 0 is no tile.
const FIRST: u32 = 1;

/// Maximum number of tiles of a map whose layers are lists of numbers, which all programs read. Layers of larger maps
/// are compressed.
const MAX_LISTED: usize = 1 << 20;

/// A wang set: its colors, and the tiles with their eight colors, clockwise from the north.
struct WangSet {
    name: String,
    colors: Vec<WangColor>,
    tiles: Vec<(u32, [u8; 8])>,
}

/// A color of a wang set: a terrain.
struct WangColor {
    name: String,
    color: String,
    /// A tile that represents the terrain; -1 if there is none.
    tile: i64,
}

/// The type of the wang sets.
fn wang_type(tileset: &Tileset) -> &'static str {
    match tileset.layout {
        Layout::Edge => "edge",
        Layout::Corner | Layout::Dual => "corner",
        _ => "mixed",
    }
}

fn wang_sets(tileset: &Tileset) -> Vec<WangSet> {
    let own = || tileset.tiles.iter().filter(|tile| tile.flip == Flip::NONE);
    let color = |class: usize, tiles: &[(u32, [u8; 8])], number: u8| {
        let terrain = &tileset.terrains[class];
        let [red, green, blue] = terrain.color;
        let shows = |(_, colors): &&(u32, [u8; 8])| colors.iter().all(|color| [0, number].contains(color));
        WangColor {
            name: terrain.name.clone(),
            color: format!("#{red:02x}{green:02x}{blue:02x}"),
            tile: tiles.iter().find(shows).map_or(-1, |(tile, _)| i64::from(*tile)),
        }
    };
    if tileset.is_wang {
        let directions = tileset.layout.directions();
        // Colors are numbered from 1; 0 is for positions that a layout does not distinguish.
        let colors = |id: [u8; 8]| std::array::from_fn(|bit| (id[bit] + 1) * (directions >> bit & 1));
        let tiles: Vec<(u32, [u8; 8])> = own()
            .filter_map(|tile| match tile.fit {
                Fit::Wang(id) => Some((tile.picture, colors(id))),
                Fit::Layer { .. } => None,
            })
            .collect();
        let terrains = 0..tileset.terrains.len();
        let colors = terrains.map(|class| color(class, &tiles, class as u8 + 1)).collect();
        return vec![WangSet { name: "terrain".into(), colors, tiles }];
    }
    if tileset.layout == Layout::Rule {
        return Vec::new();
    }
    let set = |class: usize| {
        let colors = |mask: u8| std::array::from_fn(|bit| mask >> bit & 1);
        let tiles: Vec<(u32, [u8; 8])> = own()
            .filter_map(|tile| match tile.fit {
                // A tile without any color is not part of a wang set.
                Fit::Layer { class: of, mask } if usize::from(of) == class && mask != 0 => {
                    Some((tile.picture, colors(mask)))
                }
                _ => None,
            })
            .collect();
        WangSet { name: tileset.terrains[class].name.clone(), colors: vec![color(class, &tiles, 1)], tiles }
    };
    (0..tileset.terrains.len()).map(set).filter(|set| !set.tiles.is_empty()).collect()
}

/// The tiles of the picture with a weight other than 1, with their weights.
fn weights(tileset: &Tileset) -> Vec<(u32, f32)> {
    let mut weights: Vec<(u32, f32)> = (tileset.tiles.iter())
        .filter(|tile| tile.weight != 1.0 && tile.flip == Flip::NONE)
        .map(|tile| (tile.picture, tile.weight))
        .collect();
    weights.sort_by_key(|(tile, _)| *tile);
    weights.dedup_by_key(|(tile, _)| *tile);
    weights
}

/// Writes the tileset as TSX. `image` is the name of its picture in the same folder, and `made_by` is the program.
///
/// # Errors
/// If `out` fails.
pub fn write_tsx(tileset: &Tileset, out: &mut dyn Write, image: &str, made_by: &str) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}", mark(made_by))?;
    let (name, size, count, columns) = (quoted(&tileset.name), tileset.size, tileset.count, tileset.columns);
    writeln!(
        out,
        "<tileset version=\"{VERSION}\" name=\"{name}\" tilewidth=\"{size}\" tileheight=\"{size}\" tilecount=\"{count}\" columns=\"{columns}\">"
    )?;
    if tileset.flips != Flips::default() {
        let Flips { x, y, turns } = tileset.flips;
        let [x, y, turns, prefers] = [x, y, turns, tileset.prefers_unturned].map(u8::from);
        writeln!(
            out,
            " <transformations hflip=\"{x}\" vflip=\"{y}\" rotate=\"{turns}\" preferuntransformed=\"{prefers}\"/>"
        )?;
    }
    let (image, width, height) = (quoted(image), tileset.width(), tileset.height());
    writeln!(out, " <image source=\"{image}\" width=\"{width}\" height=\"{height}\"/>")?;
    for (tile, weight) in weights(tileset) {
        writeln!(out, " <tile id=\"{tile}\" probability=\"{weight}\"/>")?;
    }
    writeln!(out, " <wangsets>")?;
    for set in wang_sets(tileset) {
        let (name, kind) = (quoted(&set.name), wang_type(tileset));
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

/// The tileset as embedded in a JSON map.
fn tileset_json(tileset: &Tileset, image: &str) -> Value {
    let sets = wang_sets(tileset).into_iter().map(|set| {
        let icon = set.colors.first().map_or(-1, |color| color.tile);
        let colors = set.colors.iter().map(
            |WangColor { name, color, tile }| json!({ "name": name, "color": color, "tile": tile, "probability": 1 }),
        );
        let tiles = set.tiles.iter().map(|(n, colors)| json!({ "tileid": n, "wangid": colors }));
        json!({
            "name": set.name, "type": wang_type(tileset), "tile": icon,
            "colors": colors.collect::<Vec<_>>(),
            "wangtiles": tiles.collect::<Vec<_>>(),
        })
    });
    let mut made = json!({
        "firstgid": FIRST, "name": tileset.name, "image": image, "imagewidth": tileset.width(), "imageheight": tileset.height(),
        "tilewidth": tileset.size, "tileheight": tileset.size, "tilecount": tileset.count, "columns": tileset.columns,
        "margin": 0, "spacing": 0,
        "tiles": (weights(tileset).into_iter())
            .map(|(tile, weight)| json!({ "id": tile, "probability": weight }))
            .collect::<Vec<_>>(),
        "wangsets": sets.collect::<Vec<_>>(),
    });
    if tileset.flips != Flips::default() {
        let (Flips { x, y, turns }, prefers) = (tileset.flips, tileset.prefers_unturned);
        made["transformations"] = json!({ "hflip": x, "vflip": y, "rotate": turns, "preferuntransformed": prefers });
    }
    made
}

/// Tiles along a side of a chunk of an infinite map.
const CHUNK: usize = 16;

impl Tilemap {
    /// The first tile and the size of the area that the chunks of an infinite map cover; for another map, its size.
    fn span(&self) -> ([i64; 2], [usize; 2]) {
        if !self.is_infinite {
            return ([0, 0], [self.width, self.height]);
        }
        let axis = |from: i64, length: usize| {
            let start = from.div_euclid(CHUNK as i64) * CHUNK as i64;
            (start, ((from - start) as usize + length).div_ceil(CHUNK) * CHUNK)
        };
        let ((x, width), (y, height)) = (axis(self.window.x, self.width), axis(self.window.y, self.height));
        ([x, y], [width, height])
    }

    /// Calls a function with the chunks of a layer that have a tile: the position of each chunk in cells of the world,
    /// and its tiles.
    fn each_chunk(
        &self,
        tiles: &Records<u32>,
        mut of_chunk: impl FnMut([i64; 2], &[u32]) -> io::Result<()>,
    ) -> io::Result<()> {
        let side = CHUNK as i64;
        let ends = |from: i64, length: usize| from.div_euclid(side)..(from + length as i64 + side - 1).div_euclid(side);
        let (columns, rows) = (ends(self.window.x, self.width), ends(self.window.y, self.height));
        let (mut reader, mut band, mut chunk) = (tiles.reader(), Vec::new(), Vec::new());
        let mut next = 0;
        for y in rows.map(|row| row * side) {
            // The rows of the map that these chunks contain.
            let (first, last) = (next, ((y + side - self.window.y) as usize).min(self.height));
            reader.read((last - first) * self.width, &mut band)?;
            next = last;
            for x in columns.clone().map(|column| column * side) {
                let at = |place: usize| {
                    let column = x - self.window.x + (place % CHUNK) as i64;
                    let row = y - self.window.y + (place / CHUNK) as i64 - first as i64;
                    let is_inside =
                        (0..self.width as i64).contains(&column) && (0..(last - first) as i64).contains(&row);
                    if is_inside { band[row as usize * self.width + column as usize] } else { 0 }
                };
                chunk.clear();
                chunk.extend((0..CHUNK * CHUNK).map(at));
                if chunk.iter().any(|tile| *tile != 0) {
                    of_chunk([x, y], &chunk)?;
                }
            }
        }
        Ok(())
    }

    /// Writes the numbers of the tiles of a layer row by row, separated by commas.
    fn write_listed(&self, out: &mut dyn Write, tiles: &Records<u32>) -> io::Result<()> {
        let (mut reader, mut row) = (tiles.reader(), Vec::new());
        for nth in 1..=self.height {
            reader.read(self.width, &mut row)?;
            out.write_all(listed(&row).as_bytes())?;
            writeln!(out, "{}", if nth < self.height { "," } else { "" })?;
        }
        Ok(())
    }

    /// The distance from the origin of the map in a file to the upper left tile, in tiles.
    fn place(&self) -> [i64; 2] {
        if self.is_infinite { [self.window.x, self.window.y] } else { [0, 0] }
    }

    /// The pixel position of a map position in a file.
    fn pixel(&self, position: [f64; 2]) -> [f64; 2] {
        let ([left, top], size) = (self.place(), self.tileset.size as f64);
        [(position[0] + left as f64) * size, (position[1] + top as f64) * size]
    }

    /// The layers that have a tile, with their names.
    pub(super) fn used(&self) -> impl Iterator<Item = (&str, &Records<u32>)> {
        let named = self.tileset.layer_names().into_iter().zip(&self.layers);
        named.filter(|(_, layer)| layer.is_used).map(|(name, layer)| (name, &layer.tiles))
    }

    fn is_listed(&self) -> bool {
        self.width * self.height <= MAX_LISTED
    }

    /// Writes the map as TMX. `tileset` is the name of the TSX in the same folder, and `made_by` is the program.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_tmx(&self, out: &mut dyn Write, tileset: &str, made_by: &str) -> io::Result<()> {
        let (_, [width, height]) = self.span();
        let size = self.tileset.size;
        let layers: Vec<_> = self.used().collect();
        let objects = layers.len() + 1;
        writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}", mark(made_by))?;
        writeln!(
            out,
            "<map version=\"{VERSION}\" tiledversion=\"{TILED}\" orientation=\"orthogonal\" renderorder=\"right-down\" width=\"{width}\" height=\"{height}\" tilewidth=\"{size}\" \
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
                self.each_chunk(tiles, |[x, y], tiles| {
                    writeln!(out, "   <chunk x=\"{x}\" y=\"{y}\" width=\"{CHUNK}\" height=\"{CHUNK}\">")?;
                    write_chunk(out, tiles)?;
                    writeln!(out, "</chunk>")
                })?;
            } else if self.is_listed() {
                writeln!(out, "  <data encoding=\"csv\">")?;
                self.write_listed(out, tiles)?;
            } else {
                write!(out, "  <data encoding=\"base64\" compression=\"zlib\">")?;
                write_packed(out, tiles)?;
            }
            writeln!(out, "</data>\n </layer>")?;
        }
        if !self.objects.is_empty() {
            writeln!(out, " <objectgroup id=\"{objects}\" name=\"objects\">")?;
            self.each_object(|nth, object| {
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
                writeln!(out, "   </properties>\n   <point/>\n  </object>")
            })?;
            writeln!(out, " </objectgroup>")?;
        }
        writeln!(out, "</map>")
    }

    /// Writes the map as TMJ, with its tileset. `image` is the name of the tileset's picture in the same folder, and
    /// `made_by` is the program.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_tmj(&self, out: &mut dyn Write, image: &str, made_by: &str) -> io::Result<()> {
        let ([left, top], [width, height]) = self.span();
        let size = self.tileset.size;
        let layers: Vec<_> = self.used().collect();
        writeln!(out, "{{\n\"made_by\": {},", json!(made_by))?;
        writeln!(
            out,
            "\"type\": \"map\", \"version\": \"{VERSION}\", \"tiledversion\": \"{TILED}\", \"orientation\": \"orthogonal\", \"renderorder\": \"right-down\","
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
                write!(out, "\"startx\": {left}, \"starty\": {top}, \"chunks\": [")?;
                let mut comma = "";
                self.each_chunk(tiles, |[x, y], tiles| {
                    writeln!(
                        out,
                        "{comma}\n{{\"x\": {x}, \"y\": {y}, \"width\": {CHUNK}, \"height\": {CHUNK}, \"data\": ["
                    )?;
                    comma = ",";
                    write_chunk(out, tiles)?;
                    write!(out, "]}}")
                })?;
                write!(out, "]")?;
            } else if self.is_listed() {
                writeln!(out, "\"data\": [")?;
                self.write_listed(out, tiles)?;
                write!(out, "]")?;
            } else {
                write!(out, "\"encoding\": \"base64\", \"compression\": \"zlib\", \"data\": \"")?;
                write_packed(out, tiles)?;
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
            self.each_object(|nth, object| {
                let [x, y] = self.pixel(object.position).map(|at| (at * 100.0).round() / 100.0);
                let rotation = (object.turn * 100.0).round() / 100.0;
                let own = json!({
                    "id": nth + 1, "name": "", "type": self.kinds[object.kind], "x": x, "y": y, "width": 0, "height": 0, "rotation": rotation,
                    "visible": true, "point": true,
                    "properties": [{ "name": "size", "type": "float", "value": (object.size * 1e4).round() / 1e4 }],
                });
                writeln!(out, "{own}{}", if nth + 1 < self.objects.len() { "," } else { "" })
            })?;
            writeln!(out, "]}}")?;
        }
        writeln!(out, "],\n\"tilesets\": [{}]\n}}", tileset_json(&self.tileset, image))
    }
}

/// Writes the tiles of a chunk row by row, separated by commas.
fn write_chunk(out: &mut dyn Write, tiles: &[u32]) -> io::Result<()> {
    let mut rows = tiles.chunks(CHUNK).peekable();
    while let Some(row) = rows.next() {
        out.write_all(listed(row).as_bytes())?;
        writeln!(out, "{}", if rows.peek().is_some() { "," } else { "" })?;
    }
    Ok(())
}

/// Writes tiles as 32-bit little-endian, compressed, as base64.
fn write_packed(out: &mut dyn Write, tiles: &Records<u32>) -> io::Result<()> {
    let mut base64 = Base64::new(out);
    tiles.write_packed(&mut base64)?;
    base64.finish()
}

/// Escapes text for an XML attribute.
fn quoted(text: &str) -> String {
    escaped(text).replace('"', "&quot;")
}

/// The comment that marks a file as generated by a program, as opposed to written by hand.
fn mark(made_by: &str) -> String {
    // Two hyphens would end the comment.
    format!("<!-- made by {} -->", escaped(made_by).replace("--", "- -"))
}

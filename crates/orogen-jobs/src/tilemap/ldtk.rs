//! A project of the level editor LDtk with one level.
//!
//! The format is LDtk 1.5 (ldtk.io/json, "JSON schema"). Each layer of tiles is a layer of the level, tilesets of cells
//! have the classes as an IntGrid layer, and scattered objects are entities. LDtk lists layers top to bottom.

use std::io::{self, Write};

use orogen_grid::random::mix64;
use orogen_io::records::Records;
use serde_json::{Value, json};

use super::map::{MapObject, Tilemap};
use orogen_output::tilemap::rows::ldtk_tiles;

/// The version of the format.
const VERSION: &str = "1.5.3";

/// Maximum number of tiles of a layer.
const MAX_TILES: usize = 1 << 20;

/// Numbers of the definitions.
const TILESET: u32 = 1;
const LEVEL: u32 = 2;
const CLASSES: u32 = 3;
const OBJECTS: u32 = 4;
const SIZE_FIELD: u32 = 5;
const TURN_FIELD: u32 = 6;
const FIRST: u32 = 16;

/// The opacity of the classes, which are above the tiles and initially hidden.
const CLASSES_OPACITY: f64 = 0.5;

/// A layer of the level; LDtk lists the uppermost first.
enum Layer<'a> {
    Objects,
    Classes,
    Tiles(usize, &'a str),
}

impl Tilemap {
    /// Whether the map can be an LDtk project: it has at most 2^20 tiles, because a project lists each tile, and no
    /// quarter turns, which LDtk does not support.
    #[must_use]
    pub fn fits_ldtk(&self) -> bool {
        self.width.saturating_mul(self.height) <= MAX_TILES
            && !self.tileset.flips.turns
            && !self.layers.iter().any(|layer| layer.is_turned)
    }

    fn ldtk_layers(&self) -> Vec<Layer<'_>> {
        let mut layers = Vec::new();
        if !self.kinds.is_empty() {
            layers.push(Layer::Objects);
        }
        if !self.tileset.layout.is_on_corners() {
            layers.push(Layer::Classes);
        }
        let names = self.tileset.layer_names().into_iter().enumerate().rev();
        let used = names.filter(|(nth, _)| self.layers[*nth].is_used);
        layers.extend(used.map(|(nth, name)| Layer::Tiles(nth, name)));
        layers
    }

    /// Writes the map as an LDtk project. `image` is the name of the tileset's picture in the same folder, and
    /// `made_by` is the program.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_ldtk(&self, out: &mut dyn Write, image: &str, made_by: &str) -> io::Result<()> {
        let size = self.tileset.size;
        let [width, height] = [self.width * size, self.height * size];
        let layers = self.ldtk_layers();
        let root = json!({
            "__header__": {
                "fileType": "LDtk Project JSON", "app": "LDtk", "doc": "https://ldtk.io/json", "schema": "https://ldtk.io/files/JSON_SCHEMA.json",
                "appAuthor": format!("made by {made_by}"), "appVersion": VERSION, "url": "https://ldtk.io",
            },
            "iid": self.iid(0), "jsonVersion": VERSION, "appBuildId": 0, "nextUid": entity_uid(self.kinds.len()),
            "identifierStyle": "Free", "toc": [], "worldLayout": "Free", "worldGridWidth": width, "worldGridHeight": height,
            "defaultLevelWidth": width, "defaultLevelHeight": height, "defaultPivotX": 0, "defaultPivotY": 0, "defaultGridSize": size,
            "defaultEntityWidth": size, "defaultEntityHeight": size, "bgColor": "#40465B", "defaultLevelBgColor": "#696A79", "minifyJson": false,
            "externalLevels": false, "exportTiled": false, "simplifiedExport": false, "imageExportMode": "None", "exportLevelBg": true,
            "pngFilePattern": null, "backupOnSave": false, "backupLimit": 10, "backupRelPath": null, "levelNamePattern": "Level_%idx",
            "jsonStyle": "Minified", "tutorialDesc": null, "customCommands": [], "flags": [], "worlds": [], "dummyWorldIid": self.iid(1),
            "defs": self.ldtk_definitions(&layers, image),
        });
        let level = json!({
            "identifier": "Level_0", "iid": self.iid(2), "uid": LEVEL, "worldX": 0, "worldY": 0, "worldDepth": 0, "pxWid": width, "pxHei": height,
            "__bgColor": "#696A79", "bgColor": null, "useAutoIdentifier": true, "bgRelPath": null, "bgPos": null, "bgPivotX": 0.5, "bgPivotY": 0.5,
            "__smartColor": "#ADADB5", "__bgPos": null, "externalRelPath": null, "fieldInstances": [], "__neighbours": [],
        });
        write!(out, "{},\n\"levels\": [{},\n\"layerInstances\": [", open(&root), open(&level))?;
        for (nth, layer) in layers.iter().enumerate() {
            let instance = self.ldtk_layer(layer, nth, image);
            write!(out, "{}\n{}", if nth > 0 { "," } else { "" }, open(&instance))?;
            write!(out, ",\"entityInstances\":[")?;
            if matches!(layer, Layer::Objects) {
                self.each_object(|nth, object| {
                    write!(out, "{}{}", if nth > 0 { ",\n" } else { "" }, self.ldtk_entity(nth, object))
                })?;
            }
            write!(out, "],\"gridTiles\":[")?;
            if let Layer::Tiles(layer, _) = layer {
                self.write_grid_tiles(out, &self.layers[*layer].tiles)?;
            }
            write!(out, "],\"intGridCsv\":[")?;
            if matches!(layer, Layer::Classes) {
                let (mut reader, mut classes) = (self.classes.reader(), Vec::new());
                for row in 0..self.height {
                    reader.read(self.class_columns(), &mut classes)?;
                    let values: Vec<String> = classes.iter().map(|class| (u32::from(*class) + 1).to_string()).collect();
                    write!(out, "{}{}", if row > 0 { ",\n" } else { "" }, values.join(","))?;
                }
            }
            write!(out, "]}}")?;
        }
        writeln!(out, "]}}]}}")
    }

    fn write_grid_tiles(&self, out: &mut dyn Write, tiles: &Records<u32>) -> io::Result<()> {
        let (mut reader, mut tiles, mut is_first) = (tiles.reader(), Vec::new(), true);
        for row in 0..self.height {
            reader.read(self.width, &mut tiles)?;
            out.write_all(ldtk_tiles(&self.tileset, &tiles, row, &mut is_first).as_bytes())?;
        }
        Ok(())
    }

    /// An identifier in the form of a UUID, for the nth object of this map.
    fn iid(&self, nth: u64) -> String {
        let place = mix64(self.window.x as u64 ^ mix64(self.window.y as u64 ^ mix64(self.window.cell.to_bits())));
        let [high, low] = [1, 2].map(|half| mix64(self.seed ^ place ^ mix64(nth.wrapping_mul(4).wrapping_add(half))));
        format!(
            "{:08x}-{:04x}-4{:03x}-a{:03x}-{:012x}",
            high >> 32,
            (high >> 16) & 0xffff,
            high & 0xfff,
            low >> 52,
            low & 0xffff_ffff_ffff
        )
    }

    fn ldtk_definitions(&self, layers: &[Layer], image: &str) -> Value {
        let size = self.tileset.size;
        let tileset = json!({
            "__cWid": self.tileset.columns, "__cHei": self.tileset.height() / size, "identifier": "tiles", "uid": TILESET, "relPath": image,
            "embedAtlas": null, "pxWid": self.tileset.width(), "pxHei": self.tileset.height(), "tileGridSize": size, "spacing": 0, "padding": 0,
            "tags": [], "tagsSourceEnumUid": null, "enumTags": [], "customData": [], "savedSelections": [], "cachedPixelData": null,
        });
        let values = self.tileset.terrains.iter().enumerate().map(|(class, terrain)| {
            let [red, green, blue] = terrain.color;
            json!({
                "value": class + 1, "identifier": identifier(&terrain.name), "color": format!("#{red:02x}{green:02x}{blue:02x}"), "tile": null,
                "groupUid": 0,
            })
        });
        let values: Vec<Value> = values.collect();
        let layers = layers.iter().enumerate().map(|(nth, layer)| {
            let (kind, name, values, opacity) = match layer {
                Layer::Objects => ("Entities", "objects".to_string(), Vec::new(), 1.0),
                Layer::Classes => ("IntGrid", "classes".to_string(), values.clone(), CLASSES_OPACITY),
                Layer::Tiles(_, name) => ("Tiles", identifier(name), Vec::new(), 1.0),
            };
            let tileset = matches!(layer, Layer::Tiles(..)).then_some(TILESET);
            json!({
                "__type": kind, "identifier": name, "type": kind, "uid": layer_uid(layer, nth), "doc": null, "uiColor": null, "gridSize": size,
                "guideGridWid": 0, "guideGridHei": 0, "displayOpacity": opacity, "inactiveOpacity": 1, "hideInList": false,
                "hideFieldsWhenInactive": true, "canSelectWhenInactive": true, "renderInWorldView": true, "pxOffsetX": 0, "pxOffsetY": 0,
                "parallaxFactorX": 0, "parallaxFactorY": 0, "parallaxScaling": true, "requiredTags": [], "excludedTags": [],
                "autoTilesKilledByOtherLayerUid": null, "uiFilterTags": [], "useAsyncRender": false, "intGridValues": values,
                "intGridValuesGroups": [], "autoRuleGroups": [], "autoSourceLayerDefUid": null, "tilesetDefUid": tileset, "tilePivotX": 0,
                "tilePivotY": 0, "biomeFieldUid": null, "autoTilesetDefUid": null,
            })
        });
        let layers: Vec<Value> = layers.collect();
        let field = |name: &str, uid: u32| {
            json!({
                "identifier": name, "doc": null, "__type": "Float", "uid": uid, "type": "F_Float", "isArray": false, "canBeNull": false,
                "arrayMinLength": null, "arrayMaxLength": null, "editorDisplayMode": "Hidden", "editorDisplayScale": 1, "editorDisplayPos": "Above",
                "editorLinkStyle": "StraightArrow", "editorDisplayColor": null, "editorAlwaysShow": false, "editorShowInWorld": true,
                "editorCutLongValues": true, "editorTextSuffix": null, "editorTextPrefix": null, "useForSmartColor": false, "exportToToc": false,
                "searchable": false, "min": null, "max": null, "regex": null, "acceptFileTypes": null, "defaultOverride": null,
                "textLanguageMode": null, "symmetricalRef": false, "autoChainRef": true, "allowOutOfLevelRef": true,
                "allowedRefs": "OnlySame", "allowedRefsEntityUid": null, "allowedRefTags": [], "tilesetUid": null,
            })
        };
        let entities = self.kinds.iter().enumerate().map(|(nth, name)| {
            json!({
                "identifier": identifier(name), "uid": entity_uid(nth), "tags": [], "exportToToc": false, "allowOutOfBounds": false, "doc": null,
                "width": size, "height": size, "resizableX": false, "resizableY": false, "minWidth": null, "maxWidth": null, "minHeight": null,
                "maxHeight": null, "keepAspectRatio": false, "tileOpacity": 1, "fillOpacity": 1, "lineOpacity": 1, "hollow": false,
                "color": entity_color(nth), "renderMode": "Ellipse", "showName": true, "tilesetId": null, "tileRenderMode": "FitInside",
                "tileRect": null, "uiTileRect": null, "nineSliceBorders": [], "maxCount": 0, "limitScope": "PerLevel",
                "limitBehavior": "MoveLastOne", "pivotX": 0.5, "pivotY": 0.5, "tileId": null,
                // Each kind has its own field numbers.
                "fieldDefs": [field("size", SIZE_FIELD + field_uid(nth)), field("turn", TURN_FIELD + field_uid(nth))],
            })
        });
        let entities: Vec<Value> = entities.collect();
        json!({
            "layers": layers, "entities": entities, "tilesets": [tileset], "enums": [], "externalEnums": [], "levelFields": [],
        })
    }

    /// A layer without its tiles, classes and entities.
    fn ldtk_layer(&self, layer: &Layer, nth: usize, image: &str) -> Value {
        let size = self.tileset.size;
        let (kind, name) = match layer {
            Layer::Objects => ("Entities", "objects".to_string()),
            Layer::Classes => ("IntGrid", "classes".to_string()),
            Layer::Tiles(_, name) => ("Tiles", identifier(name)),
        };
        let opacity = if matches!(layer, Layer::Classes) { CLASSES_OPACITY } else { 1.0 };
        let has_tiles = matches!(layer, Layer::Tiles(..));
        json!({
            "__identifier": name, "__type": kind, "__cWid": self.width, "__cHei": self.height, "__gridSize": size, "__opacity": opacity,
            "__pxTotalOffsetX": 0, "__pxTotalOffsetY": 0, "__tilesetDefUid": has_tiles.then_some(TILESET),
            "__tilesetRelPath": has_tiles.then_some(image), "iid": self.iid(16 + nth as u64), "levelId": LEVEL,
            "layerDefUid": layer_uid(layer, nth), "pxOffsetX": 0, "pxOffsetY": 0, "visible": !matches!(layer, Layer::Classes),
            "optionalRules": [], "autoLayerTiles": [], "seed": self.seed % (1 << 31), "overrideTilesetUid": null,
        })
    }

    fn ldtk_entity(&self, nth: u64, object: MapObject) -> Value {
        let size = self.tileset.size;
        let px = object.position.map(|at| (at * size as f64).round() as i64);
        let grid = object.position.map(|at| at.floor() as i64);
        let field = |name: &str, uid: u32, value: f64| {
            json!({
                "__identifier": name, "__type": "Float", "__value": value, "__tile": null, "defUid": uid + field_uid(object.kind),
                "realEditorValues": [{ "id": "V_Float", "params": [value] }],
            })
        };
        json!({
            "__identifier": identifier(&self.kinds[object.kind]), "__grid": grid, "__pivot": [0.5, 0.5], "__tags": [], "__tile": null,
            "__smartColor": entity_color(object.kind), "iid": self.iid(1 << 32 | nth), "width": size, "height": size,
            "defUid": entity_uid(object.kind), "px": px, "__worldX": px[0], "__worldY": px[1],
            "fieldInstances": [field("size", SIZE_FIELD, object.size), field("turn", TURN_FIELD, object.turn)],
        })
    }
}

/// A JSON value as text without its last brace, so that more keys can be appended.
fn open(value: &Value) -> String {
    let mut text = value.to_string();
    text.pop();
    text
}

/// Converts a name to an LDtk identifier: letters, digits and underscores, not starting with a digit.
fn identifier(name: &str) -> String {
    let mut text: String = name.chars().map(|at| if at.is_ascii_alphanumeric() { at } else { '_' }).collect();
    if !text.starts_with(|at: char| at.is_ascii_alphabetic()) {
        text.insert(0, 'n');
    }
    text
}

fn layer_uid(layer: &Layer, nth: usize) -> u32 {
    match layer {
        Layer::Objects => OBJECTS,
        Layer::Classes => CLASSES,
        Layer::Tiles(..) => FIRST + nth as u32,
    }
}

/// Each kind of object has four numbers: its own, and the numbers of its fields.
fn field_uid(kind: usize) -> u32 {
    1000 + 4 * kind as u32
}

fn entity_uid(kind: usize) -> u32 {
    field_uid(kind) + 4
}

/// Colors of the kinds of objects.
fn entity_color(kind: usize) -> &'static str {
    const COLORS: [&str; 6] = ["#3e8948", "#a8a8a8", "#be4a2f", "#63c74d", "#e4a672", "#5a6988"];
    COLORS[kind % COLORS.len()]
}

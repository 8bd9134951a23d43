//! Descriptions of tilesets in TOML: a picture, and for each terrain class its tiles, by masks or by rules.
//!
//! ```toml
//! picture = "tiles.png"
//! size = 16
//! layout = "blob"
//!
//! [[class]]
//! name = "water"
//! full = [{ tile = 0, weight = 5 }, { tile = 1 }]
//!
//! [[class]]
//! name = "grass"
//! first = 2
//! ```

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use orogen_grid::autotile::flip::{Flip, Flips};
use orogen_grid::autotile::mask::Layout;
use orogen_grid::autotile::rule::{Pattern, first_matches};
use orogen_grid::error::Result;
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, Deserializer, MapAccess, Unexpected, Visitor};

use super::loaded::{Loaded, text, unusable};
use super::picture::{Cut, Grid, color, cut};
use crate::tilemap::tileset::{Fit, Terrain, Tile, Tileset};

/// Maximum number of terrain classes.
const MAX_CLASSES: usize = 255;

/// The content of the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Description {
    name: Option<String>,
    picture: String,
    size: usize,
    #[serde(default)]
    margin: usize,
    #[serde(default)]
    spacing: usize,
    transparent: Option<String>,
    layout: String,
    #[serde(default)]
    turns: Vec<Turn>,
    #[serde(default)]
    prefer_unturned: bool,
    #[serde(default)]
    class: Vec<Class>,
}

/// A way in which tiles may be flipped or rotated.
#[derive(Deserialize, Clone, Copy, PartialEq)]
#[serde(rename_all = "kebab-case")]
enum Turn {
    FlipX,
    FlipY,
    Rotate,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Class {
    name: String,
    color: Option<String>,
    #[serde(default)]
    full: Vec<Choice>,
    first: Option<u32>,
    #[serde(default)]
    tiles: BTreeMap<String, Vec<Choice>>,
    #[serde(default)]
    rule: Vec<Rule>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Rule {
    pattern: Vec<String>,
    tiles: Vec<Choice>,
    #[serde(default)]
    turns: Vec<Turn>,
}

/// A tile and its weight, which is 1 if only the tile's number is given.
#[derive(Clone, Copy)]
struct Choice {
    tile: u32,
    weight: f32,
}

/// Implemented by hand, because error messages of untagged enums do not say what is wrong.
impl<'de> Deserialize<'de> for Choice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Choice, D::Error> {
        deserializer.deserialize_any(ChoiceVisitor)
    }
}

struct ChoiceVisitor;

impl<'de> Visitor<'de> for ChoiceVisitor {
    type Value = Choice;

    fn expecting(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.write_str("the number of a tile, or a table such as { tile = 0, weight = 5 }")
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> std::result::Result<Choice, E> {
        let tile = u32::try_from(number).map_err(|_| E::invalid_value(Unexpected::Signed(number), &self))?;
        Ok(Choice { tile, weight: 1.0 })
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> std::result::Result<Choice, A::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Weighted {
            tile: u32,
            weight: Option<f32>,
        }
        let Weighted { tile, weight } = Weighted::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Choice { tile, weight: weight.unwrap_or(1.0) })
    }
}

fn flips(turns: &[Turn]) -> Flips {
    Flips { x: turns.contains(&Turn::FlipX), y: turns.contains(&Turn::FlipY), turns: turns.contains(&Turn::Rotate) }
}

/// Reads a description and its picture.
///
/// # Errors
/// If a file cannot be read, or the description contradicts itself or the picture.
pub fn load(path: &Path) -> Result<Loaded> {
    read(path, &text(path)?, cut)
}

/// Reads the text of a description; `cut` cuts its picture into tiles.
pub(super) fn read(path: &Path, text: &str, cut: impl Fn(&Path, &Grid) -> Result<Cut>) -> Result<Loaded> {
    let failed = |why: String| unusable(path, &why);
    let described: Description =
        toml::from_str(text).map_err(|cause| failed(format!("\n{}", cause.to_string().trim_end())))?;
    let layout = Layout::named(&described.layout).ok_or_else(|| {
        failed(format!("the layout `{}` is none of blob, edge, corner, dual and rule", described.layout))
    })?;
    if described.size == 0 || [described.size, described.margin, described.spacing].iter().any(|side| *side > 1 << 16) {
        return Err(failed("`size` must be 1 to 65536 pixels, and `margin` and `spacing` at most 65536".into()));
    }
    let transparent = match &described.transparent {
        Some(text) => {
            Some(color(text).ok_or_else(|| failed(format!("`transparent` is `{text}`, not a color like #ff00ff")))?)
        }
        None => None,
    };
    let picture = path.parent().unwrap_or(Path::new("")).join(&described.picture);
    let grid = Grid { size: described.size, margin: described.margin, spacing: described.spacing, transparent };
    let Cut { count, columns, pixels } = cut(&picture, &grid)?;
    let made = Made { layout, count };
    let terrains = terrains(&described.class).map_err(&failed)?;
    if layout == Layout::Rule && !described.turns.is_empty() {
        return Err(failed(
            "`turns` of the whole tileset has no meaning for rules; give it to the rules that turn".into(),
        ));
    }
    let mut tiles = Vec::new();
    for (nth, class) in described.class.iter().enumerate() {
        let of = made.tiles(nth, class).map_err(|why| failed(format!("the class `{}` {why}", class.name)))?;
        tiles.extend(of);
    }
    let tileset = Tileset {
        name: described.name.unwrap_or_else(|| path.file_stem().unwrap_or_default().to_string_lossy().into_owned()),
        size: described.size,
        layout,
        is_wang: false,
        terrains,
        tiles,
        flips: Flips::default(),
        prefers_unturned: false,
        count,
        columns,
        pixels,
    };
    Ok(Loaded { tileset: tileset.with_flips(flips(&described.turns), described.prefer_unturned), picture })
}

/// Checks the classes.
fn terrains(classes: &[Class]) -> std::result::Result<Vec<Terrain>, String> {
    if classes.is_empty() || classes.len() > MAX_CLASSES {
        return Err(format!("it has {} tables `[[class]]`; it needs 1 to {MAX_CLASSES}", classes.len()));
    }
    let mut terrains: Vec<Terrain> = Vec::new();
    for class in classes {
        if terrains.iter().any(|terrain| terrain.name == class.name) {
            return Err(format!("it has two classes `{}`", class.name));
        }
        let color = match &class.color {
            Some(text) => {
                color(text).ok_or_else(|| format!("the color `{text}` of `{}` is not like #7db955", class.name))?
            }
            None => [128; 3],
        };
        terrains.push(Terrain { name: class.name.clone(), color });
    }
    Ok(terrains)
}

/// Properties that all classes share.
struct Made {
    layout: Layout,
    count: usize,
}

impl Made {
    /// The tiles of a class.
    fn tiles(&self, nth: usize, class: &Class) -> std::result::Result<Vec<Tile>, String> {
        let layout = self.layout;
        let mut tiles = Vec::new();
        let mut add = |choice: Choice, flip: Flip, mask: u8| -> std::result::Result<(), String> {
            let Choice { tile, weight } = choice;
            if tile as usize >= self.count {
                return Err(format!("has the tile {tile}, but the picture has the tiles 0 to {}", self.count - 1));
            }
            if !(weight > 0.0 && weight.is_finite()) {
                return Err(format!("has a weight of {weight}; weights are above 0"));
            }
            tiles.push(Tile { picture: tile, flip, fit: Fit::Layer { class: nth as u8, mask }, weight });
            Ok(())
        };
        if layout == Layout::Rule {
            if class.first.is_some() || !class.tiles.is_empty() {
                return Err("has tiles by masks, but the layout `rule` has rules: give it tables [[class.rule]]".into());
            }
            let mut rules = Vec::new();
            for (at, rule) in class.rule.iter().enumerate() {
                let pattern = Pattern::read(&rule.pattern)
                    .map_err(|why| format!("has a pattern, its rule {}, that {why}", at + 1))?;
                if rule.tiles.is_empty() {
                    return Err(format!("has a rule without tiles, number {}", at + 1));
                }
                rules.push((pattern, flips(&rule.turns)));
            }
            let matches = first_matches(&rules);
            if let Some(never) = (0..rules.len()).find(|nth| !matches.iter().flatten().any(|(found, _)| found == nth)) {
                return Err(format!(
                    "has a rule that is never used, number {}: earlier rules match all that it matches; put it before them",
                    never + 1
                ));
            }
            for (mask, found) in matches.into_iter().enumerate() {
                match found {
                    Some((rule, flip)) => {
                        class.rule[rule].tiles.iter().try_for_each(|choice| add(*choice, flip, mask as u8))?;
                    }
                    // Where no rule matches, the full tile is drawn.
                    None => class.full.iter().try_for_each(|choice| add(*choice, Flip::NONE, mask as u8))?,
                }
            }
        } else {
            if !class.rule.is_empty() {
                return Err(format!("has rules, but the layout is `{}`; rules need the layout `rule`", layout.name()));
            }
            class.full.iter().try_for_each(|choice| add(*choice, Flip::NONE, layout.full()))?;
            if let Some(first) = class.first {
                if first as usize >= self.count {
                    return Err(format!(
                        "has its first tile at {first}, but the picture has the tiles 0 to {}",
                        self.count - 1
                    ));
                }
                let given = |mask: &u8| {
                    (*mask == layout.full() && !class.full.is_empty()) || class.tiles.contains_key(&mask.to_string())
                };
                for (tile, mask) in (first..).zip(layout.masks()).filter(|(_, mask)| !given(mask)) {
                    add(Choice { tile, weight: 1.0 }, Flip::NONE, mask)?;
                }
            }
            for (mask, choices) in &class.tiles {
                let known = mask.parse().ok().filter(|mask| layout.reduced(*mask) == *mask);
                let Some(mask) = known else {
                    return Err(format!(
                        "has a tile for the mask `{mask}`, which the layout `{}` does not have: {:?}",
                        layout.name(),
                        layout.masks()
                    ));
                };
                choices.iter().try_for_each(|choice| add(*choice, Flip::NONE, mask))?;
            }
        }
        let has_full = |tile: &Tile| matches!(tile.fit, Fit::Layer { mask, .. } if layout.is_full(mask));
        if tiles.is_empty() && nth > 0 {
            return Err("has no tiles".into());
        }
        if !tiles.is_empty() && !tiles.iter().any(has_full) {
            return Err("has no full tile; name one with `full`".into());
        }
        Ok(tiles)
    }
}

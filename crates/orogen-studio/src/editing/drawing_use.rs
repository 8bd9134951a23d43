//! What a drawn line or area does to the land.

use orogen::declare::Input;
use orogen::grid::hydrography::rings::holds;
use orogen::recipe::Recipe;
use orogen::value::Value;

use super::brush::round_number;
use super::edit::Edit;
use super::reader::Reader;
use super::{drawing, names};

/// The op that fills lakes, and its input.
const LAKES: [&str; 2] = ["lakes", "source"];

/// What a drawing does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Use {
    /// It raises the land.
    Raise,
    /// It lowers the land.
    Lower,
    /// It levels the land.
    Flatten,
    /// It holds a lake.
    Lake,
    /// It is the mask of the selected node.
    Mask,
    /// Nothing yet.
    Alone,
}

impl Use {
    /// What a drawing by an op can do, while a node is selected.
    #[must_use]
    pub fn of(op: &str, recipe: &Recipe, selected: Option<&str>) -> Vec<Use> {
        let is_area = op != drawing::OPS[0];
        // A lake is found in a world with sides.
        let can_hold = is_area && recipe.world.size.is_some();
        let takes_mask =
            recipe.nodes().iter().any(|named| Some(named.name.as_str()) == selected && named.mask == Input::None);
        let all = [
            (Use::Raise, true),
            (Use::Lower, true),
            (Use::Flatten, is_area),
            (Use::Lake, can_hold),
            (Use::Mask, takes_mask),
            (Use::Alone, true),
        ];
        all.into_iter().filter(|(_, can)| *can).map(|(use_of, _)| use_of).collect()
    }

    /// The catalog keys of its name and its help, for a drawing by an op.
    #[must_use]
    pub fn names(self, op: &str) -> [&'static str; 2] {
        let is_area = op != drawing::OPS[0];
        match self {
            Use::Raise if is_area => ["drawing.raise", "drawing.raise_help"],
            Use::Raise => ["drawing.ridge", "drawing.raise_help"],
            Use::Lower if is_area => ["drawing.lower", "drawing.lower_help"],
            Use::Lower => ["drawing.valley", "drawing.lower_help"],
            Use::Flatten => ["drawing.flatten", "drawing.flatten_help"],
            Use::Lake => ["drawing.lake", "drawing.lake_help"],
            Use::Mask => ["drawing.mask", "drawing.mask_help"],
            Use::Alone => ["drawing.alone", "drawing.alone_help"],
        }
    }
}

/// The land that a drawing changes.
pub struct Land<'a> {
    /// The recipe.
    pub recipe: &'a Recipe,
    /// The output with the heights.
    pub output: &'a str,
    /// The range of the heights in metres, if it is known.
    pub range: Option<[f64; 2]>,
    /// The height at a position in metres, where it is known.
    pub height: &'a dyn Fn([f64; 2]) -> Option<f64>,
}

/// The share of the relief by which a drawing raises or lowers the land.
const SHARE: f64 = 0.1;

/// Number of positions along each side of an area at which its height is taken.
const PLACES: u32 = 48;

impl Land<'_> {
    /// The edit that adds a drawing with its use.
    #[must_use]
    pub fn edit(&self, chosen: Use, op: &str, points: &[[f64; 2]], selected: Option<&str>) -> Edit {
        let mut taken: std::collections::HashSet<&str> =
            self.recipe.nodes().iter().map(|named| named.name.as_str()).collect();
        let drawn = names::free(&names::of_op(op), &taken);
        let width = round_number(extent(points) / 8.0);
        let mut params = vec![(drawing::POINTS.to_owned(), drawing::value(points))];
        if chosen != Use::Alone {
            // The edge of what it does is soft.
            params.push(("falloff".to_owned(), Value::Number(width)));
            if op == drawing::OPS[0] {
                params.push(("width".to_owned(), Value::Number(width)));
            }
        }
        let add_drawing = |reader: Option<Reader>| Edit::Add {
            name: drawn.clone(),
            op: op.to_owned(),
            inputs: Vec::new(),
            params: params.clone(),
            readers: reader.into_iter().collect(),
        };
        let mask_of = |node: &str| Reader::Input { node: node.to_owned(), key: "mask".to_owned() };
        if chosen == Use::Alone {
            return add_drawing(None);
        }
        if chosen == Use::Mask {
            return add_drawing(selected.map(mask_of));
        }
        let (source, readers) = self.ground();
        taken.insert(&drawn);
        let relief = self.range.map_or(0.0, |[low, high]| high - low);
        let step = if relief.is_finite() && relief > 0.0 { round_number(relief * SHARE) } else { 10.0 };
        let (name, changing, change) = match chosen {
            Use::Raise => ("raised", "add", vec![("b", step)]),
            Use::Lower => ("lowered", "add", vec![("b", -step)]),
            Use::Flatten => ("levelled", "mix", vec![("b", self.mean(points).round()), ("amount", 1.0)]),
            // The bed is below the lowest point of the shore, over which the lake drains.
            _ => ("basin", "mix", vec![("b", (self.lowest(points) - step / 2.0).round()), ("amount", 1.0)]),
        };
        let name = names::free(name, &taken);
        let mut params: Vec<(String, Value)> =
            change.into_iter().map(|(key, number)| (key.to_owned(), Value::Number(number))).collect();
        let mut inputs = Vec::new();
        match &source {
            Input::Node(source) => inputs.push(("a".to_owned(), source.clone())),
            Input::Value(height) => params.push(("a".to_owned(), Value::Number(*height))),
            Input::None => {}
        }
        let is_in_lakes = matches!(readers.first(), Some(Reader::Input { .. }));
        let mut edits = vec![
            Edit::Add { name: name.clone(), op: changing.to_owned(), inputs, params, readers: readers.clone() },
            add_drawing(Some(mask_of(&name))),
        ];
        if chosen == Use::Lake && !is_in_lakes {
            taken.insert(&name);
            edits.push(Edit::Add {
                name: names::free("lakes", &taken),
                op: LAKES[0].to_owned(),
                inputs: vec![(LAKES[1].to_owned(), name.clone())],
                params: Vec::new(),
                readers,
            });
        }
        Edit::Several(edits)
    }

    /// What is read as the ground, and by what: heights that lakes stand on are changed below the lakes.
    fn ground(&self) -> (Input, Vec<Reader>) {
        let outputs = self.recipe.output_inputs();
        let land = outputs.iter().find(|(name, _)| name == self.output).map_or(&Input::None, |(_, input)| input);
        let lakes = self.recipe.nodes().iter().find(|named| {
            named.node.spec().op == LAKES[0]
                && matches!(land, Input::Node(read) if read.split('.').next() == Some(named.name.as_str()))
        });
        if let Some(named) = lakes {
            let reader = Reader::Input { node: named.name.clone(), key: LAKES[1].to_owned() };
            return (named.node.input(0).clone(), vec![reader]);
        }
        let readers = outputs.iter().filter(|(_, input)| input == land);
        (land.clone(), readers.map(|(name, _)| Reader::Output(name.clone())).collect())
    }

    /// The mean height within an area; 0 if it is not known.
    fn mean(&self, points: &[[f64; 2]]) -> f64 {
        let [west, north, east, south] = bounds(points);
        let share = |k: u32| (f64::from(k) + 0.5) / f64::from(PLACES);
        let places = (0..PLACES).flat_map(|j| {
            (0..PLACES).map(move |i| [west + (east - west) * share(i), north + (south - north) * share(j)])
        });
        let ring: Vec<[f64; 2]> = points.iter().chain(points.first()).copied().collect();
        let heights: Vec<f64> = places
            .filter(|at| holds(&ring, *at))
            .filter_map(|at| (self.height)(at))
            .filter(|height| height.is_finite())
            .collect();
        if heights.is_empty() { 0.0 } else { heights.iter().sum::<f64>() / heights.len() as f64 }
    }

    /// The lowest height along the side of an area; 0 if it is not known.
    fn lowest(&self, points: &[[f64; 2]]) -> f64 {
        let ends = points.iter().zip(points.iter().cycle().skip(1));
        let places = ends.flat_map(|(a, b)| {
            (0..PLACES).map(move |k| {
                let share = f64::from(k) / f64::from(PLACES);
                [0, 1].map(|c| a[c] + (b[c] - a[c]) * share)
            })
        });
        let lowest =
            places.filter_map(|at| (self.height)(at)).filter(|height| height.is_finite()).fold(f64::INFINITY, f64::min);
        if lowest.is_finite() { lowest } else { 0.0 }
    }
}

/// West, north, east and south of points.
fn bounds(points: &[[f64; 2]]) -> [f64; 4] {
    let start = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    points
        .iter()
        .fold(start, |[west, north, east, south], [x, y]| [west.min(*x), north.min(*y), east.max(*x), south.max(*y)])
}

/// The length of the shorter side of an area, or of the longer side of a line.
fn extent(points: &[[f64; 2]]) -> f64 {
    let [west, north, east, south] = bounds(points);
    let sides = [east - west, south - north];
    if points.len() > 2 { sides[0].min(sides[1]) } else { sides[0].max(sides[1]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editing::document::Document;

    const AREA: [[f64; 2]; 4] = [[100.0, 100.0], [500.0, 100.0], [500.0, 500.0], [100.0, 500.0]];

    fn text(outputs: &str) -> String {
        format!(
            "orogen = 1\n[world]\nsize = 1000\n[nodes.hills]\nop = \"fbm\"\n[nodes.pools]\nop = \"lakes\"\nsource = \"hills\"\n\
             [outputs]\n{outputs}\n"
        )
    }

    fn drawn(text: &str, chosen: Use, selected: Option<&str>) -> String {
        let mut document = Document::new("test", text.to_owned()).unwrap();
        // The ground falls from 100 m in the west to 0 m in the east.
        let height = |at: [f64; 2]| Some(100.0 - at[0] / 10.0);
        let land = Land { recipe: document.recipe(), output: "height", range: Some([0.0, 100.0]), height: &height };
        let edit = land.edit(chosen, "polygon", &AREA, selected);
        document.apply(&edit).unwrap();
        assert!(document.is_valid(), "{}", document.text());
        let made = document.text().to_owned();
        assert!(document.undo() && document.text() == text, "one step of undo");
        made
    }

    #[test]
    fn an_area_changes_the_land_where_it_is() {
        let plain = text("height = \"hills\"\nmoisture = \"hills\"");
        let made = drawn(&plain, Use::Raise, None);
        assert!(made.contains("[nodes.raised]\nop = \"add\"\na = \"hills\"\nb = 10.0\nmask = \"polygon\""), "{made}");
        assert!(
            made.contains("height = \"raised\"\nmoisture = \"raised\"") && made.contains("falloff = 50.0"),
            "{made}"
        );
        assert!(drawn(&plain, Use::Lower, None).contains("b = -10.0"));
        let made = drawn(&plain, Use::Flatten, None);
        assert!(made.contains("[nodes.levelled]\nop = \"mix\"\na = \"hills\"\nb = 70.0\namount = 1.0"), "{made}");
        let made = drawn(&plain, Use::Lake, None);
        assert!(made.contains("b = 45.0") && made.contains("op = \"lakes\"\nsource = \"basin\""), "{made}");
        assert!(made.contains("height = \"lakes\""), "{made}");
        let made = drawn(&plain, Use::Mask, Some("hills"));
        assert!(made.contains("op = \"fbm\"\nmask = \"polygon\""), "{made}");
        let made = drawn(&plain, Use::Alone, None);
        assert!(made.contains("height = \"hills\"") && !made.contains("falloff"), "{made}");
        // A level land without nodes.
        let made = drawn(&text("height = 5"), Use::Raise, None);
        assert!(made.contains("a = 5.0") && made.contains("height = \"raised\""), "{made}");
    }

    #[test]
    fn lakes_stand_on_the_changed_ground() {
        let made = drawn(&text("height = \"pools\"\nlakes = \"pools.lake\""), Use::Lake, None);
        assert!(
            made.contains("op = \"lakes\"\nsource = \"basin\"") && made.matches("op = \"lakes\"").count() == 1,
            "{made}"
        );
        assert!(
            made.contains("height = \"pools\"\nlakes = \"pools.lake\"") && made.contains("a = \"hills\""),
            "{made}"
        );
    }

    #[test]
    fn only_what_can_be_done_is_offered() {
        let document = Document::new("test", text("height = \"hills\"")).unwrap();
        let recipe = document.recipe();
        assert_eq!(Use::of("path", recipe, None), [Use::Raise, Use::Lower, Use::Alone]);
        assert!(Use::of("polygon", recipe, Some("hills")).contains(&Use::Mask));
        let endless = Document::new(
            "test",
            text("height = \"hills\"")
                .replace("size = 1000", "")
                .replace("[nodes.pools]\nop = \"lakes\"\nsource = \"hills\"\n", ""),
        )
        .unwrap();
        assert!(!Use::of("polygon", endless.recipe(), None).contains(&Use::Lake));
    }
}

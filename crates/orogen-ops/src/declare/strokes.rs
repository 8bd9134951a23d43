//! Strokes of a brush as a parameter.

use std::sync::Arc;

use super::memo::Memo;
use super::param::{Param, read_param};
use super::point_lists::{Drawn, MAX_POINTS, Reader};
use super::spec::{ParamSpec, Shape, TableSpec};
use super::tables::{self, Problem, shortest};
use crate::value::{Spanned, Value};
use orogen_grid::polylines::buffers::Buffers;

/// Maximum number of strokes of a parameter.
pub const MAX_STROKES: usize = 10_000;

choice! {
    /// What a stroke does to the values below it.
    pub enum StrokeMode {
        /// Adds `value`: a height offset. Negative values lower.
        Add = "add",
        /// Mixes with `value`: a mask is painted with 1, and land is levelled to a height.
        Set = "set",
        /// Mixes with the background: the strokes before disappear.
        Erase = "erase",
    }
}

/// A stroke of a brush: a line, and its effect around it.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// The points of the line, in metres east and south. One point is a dab.
    pub points: Vec<[f64; 2]>,
    /// The distance from the line up to which it has an effect, in metres.
    pub radius: f64,
    /// The share of the radius with full effect, 0 to 1.
    pub hardness: f64,
    /// The operation.
    pub mode: StrokeMode,
    /// The value that is added or set.
    pub value: f64,
    /// The share of the effect on the line; 1 is the full effect.
    pub strength: f64,
}

impl Default for Stroke {
    fn default() -> Stroke {
        Stroke { points: Vec::new(), radius: 100.0, hardness: 0.5, mode: StrokeMode::Add, value: 1.0, strength: 1.0 }
    }
}

/// The keys of a stroke, in the order of its values.
const KEYS: &[ParamSpec; 6] = &[
    ParamSpec {
        name: "points",
        alias: "",
        doc: "Points of the line of the stroke: metres east, metres south. One point is a dab.",
        unit: "m",
        shape: Shape::Positions,
        range: [-1e9, 1e9],
    },
    ParamSpec {
        name: "radius",
        alias: "",
        doc: "Distance from the line at which the effect ends.",
        unit: "m",
        shape: Shape::Number,
        range: [1e-3, 1e9],
    },
    ParamSpec {
        name: "hardness",
        alias: "",
        doc: "Share of the radius with full effect; from there it falls smoothly to 0. With 1 the edge is sharp.",
        unit: "",
        shape: Shape::Number,
        range: [0.0, 1.0],
    },
    ParamSpec {
        name: "mode",
        alias: "",
        doc: "What the stroke does to the values below it.",
        unit: "",
        shape: StrokeMode::SHAPE,
        range: [f64::NEG_INFINITY, f64::INFINITY],
    },
    ParamSpec {
        name: "value",
        alias: "",
        doc: "What is added or set.",
        unit: "",
        shape: Shape::Number,
        range: [-1e9, 1e9],
    },
    ParamSpec {
        name: "strength",
        alias: "",
        doc: "Effect on the line: with 0.5 half of `value` is added, or values move half of the way.",
        unit: "",
        shape: Shape::Number,
        range: [0.0, 1.0],
    },
];

/// The declaration of a stroke.
pub static STROKE: TableSpec = TableSpec {
    names: ["stroke", "strokes"],
    keys: KEYS,
    required: 2,
    defaults: || Stroke::default().values().into(),
    max: MAX_STROKES,
    problem: |name, value| read(name, value).err(),
};

impl Stroke {
    /// The values of its keys, in the order of [`STROKE`].
    #[must_use]
    pub fn values(&self) -> [Value; 6] {
        let list = |items: Vec<Value>| Value::List(items.into_iter().map(Spanned::unplaced).collect());
        let points = self.points.iter().map(|point| list(point.map(shortest).to_vec())).collect();
        let [radius, hardness, value, strength] = [self.radius, self.hardness, self.value, self.strength].map(shortest);
        [list(points), radius, hardness, self.mode.write(), value, strength]
    }

    fn table(&self, is_written: impl Fn(usize, &Value) -> bool) -> Value {
        let values = KEYS.iter().zip(self.values()).enumerate();
        let values = values.filter(|(k, (_, value))| is_written(*k, value));
        let entry = |(_, (key, value)): (usize, (&ParamSpec, Value))| {
            (Spanned::unplaced(key.name.to_string()), Spanned::unplaced(value))
        };
        Value::Table(values.map(entry).collect())
    }

    /// The table for a recipe, without keys that have their defaults.
    #[must_use]
    pub fn short_table(&self) -> Value {
        let defaults = Stroke::default().values();
        self.table(|k, value| k < STROKE.required || defaults.get(k) != Some(value))
    }

    /// The share of its effect at a distance from its line in metres: 1 on the line, 0 from the radius on.
    #[must_use]
    pub fn falloff(&self, distance: f64) -> f64 {
        let hard = self.hardness * self.radius;
        match (distance <= hard, distance < self.radius) {
            (true, _) => 1.0,
            (_, true) => {
                let t = (self.radius - distance) / (self.radius - hard);
                t * t * (3.0 - 2.0 * t)
            }
            (_, false) => 0.0,
        }
    }

    fn within(&self) -> bool {
        let [points, radius, hardness, _, value, strength] = KEYS;
        !self.points.is_empty()
            && self.points.iter().all(|point| point.within(points.range))
            && self.radius.within(radius.range)
            && self.hardness.within(hardness.range)
            && self.value.within(value.range)
            && self.strength.within(strength.range)
    }
}

/// Strokes in the order in which they were painted. Recipes write a list of tables: `[{ points = [[x, y], ...], radius
/// = 200 }, ...]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Strokes {
    list: Arc<Vec<Stroke>>,
    buffers: Memo<Buffers>,
}

impl From<Vec<Stroke>> for Strokes {
    fn from(list: Vec<Stroke>) -> Strokes {
        Strokes { list: Arc::new(list), buffers: Memo::default() }
    }
}

impl Strokes {
    /// The strokes.
    #[must_use]
    pub fn list(&self) -> &[Stroke] {
        &self.list
    }

    /// The buffers around the lines of the strokes, each with the stroke's radius. They are made once.
    pub fn with_buffers<T>(&self, read: impl FnOnce(&Buffers) -> T) -> T {
        let make = || Buffers::new(self.list.iter().map(|stroke| (stroke.points.as_slice(), stroke.radius)));
        read(&self.buffers.get_or_make(|_| true, make))
    }

    /// Memory of the strokes, in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        let points: usize = self.list.iter().map(|stroke| size_of_val(&*stroke.points)).sum();
        self.with_buffers(Buffers::memory) + (size_of_val(self.list.as_slice()) + points) as u64
    }
}

/// The form of a stroke, and what to do about too many, for messages.
const FORM: [&str; 2] = ["{ points = [[x, y], ...], radius = 100 }", "paint the others in a node of their own"];

/// Reads strokes; an error has the position of the part that is wrong.
fn read(name: &str, value: &Value) -> Result<Vec<Stroke>, Problem> {
    let mut left = MAX_POINTS;
    let items = tables::items(&STROKE, FORM, name, value)?;
    items.iter().enumerate().map(|(k, item)| stroke(name, k + 1, item, &mut left)).collect()
}

/// Reads the stroke of this number. `left` is the number of points that are still allowed.
fn stroke(name: &str, number: usize, item: &Spanned<Value>, left: &mut usize) -> Result<Stroke, Problem> {
    let mut stroke = Stroke::default();
    tables::table(&STROKE, FORM[0], name, number, item, |k, spec, value| {
        let read = match k {
            0 => {
                stroke.points = points(name, number, spec, value, left)?;
                Ok(())
            }
            1 => read_param(spec, &value.value).map(|radius| stroke.radius = radius),
            2 => read_param(spec, &value.value).map(|hardness| stroke.hardness = hardness),
            3 => read_param(spec, &value.value).map(|mode| stroke.mode = mode),
            4 => read_param(spec, &value.value).map(|value| stroke.value = value),
            _ => read_param(spec, &value.value).map(|strength| stroke.strength = strength),
        };
        read.map_err(|message| tables::refused(&STROKE, name, number, value, &message))
    })?;
    Ok(stroke)
}

fn points(
    name: &str,
    number: usize,
    spec: &ParamSpec,
    value: &Spanned<Value>,
    left: &mut usize,
) -> Result<Vec<[f64; 2]>, Problem> {
    let reader = Reader { name, number: spec.number(), drawn: Drawn::Stroke, range: spec.range };
    let Value::List(items) = &value.value else {
        let found = value.value.describe();
        let message = format!("`{name}`: the points of stroke {number} must be a list [[x, y], ...], not {found}");
        return Err((value.span.clone(), message));
    };
    let read = reader.list(items, &value.span, &format!(" of stroke {number}"), &mut None, left)?;
    Ok(read.into_iter().map(|[x, y, _]| [x, y]).collect())
}

impl Param for Strokes {
    const SHAPE: Shape = Shape::Tables(&STROKE);

    fn read(value: &Value) -> Option<Strokes> {
        read("", value).ok().map(Strokes::from)
    }

    fn write(&self) -> Value {
        Value::List(self.list.iter().map(|stroke| Spanned::unplaced(stroke.table(|_, _| true))).collect())
    }

    fn within(&self, _: [f64; 2]) -> bool {
        self.list.len() <= MAX_STROKES
            && self.list.iter().map(|stroke| stroke.points.len()).sum::<usize>() <= MAX_POINTS
            && self.list.iter().all(Stroke::within)
    }
}

//! The found places.

use orogen_grid::words::number;
use orogen_io::format::features::Value;
use serde_json::{Map, Value as Json, json};

/// A place that satisfies the conditions.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Match {
    /// The position in metres east and south of the world's origin.
    pub at: [f64; 2],
    /// The map coordinates; without a map, metres east and north of the world's origin.
    pub coordinates: [f64; 2],
    /// The distance from the position that places are searched near to, in metres.
    pub distance: f64,
    /// The values of layers, or the attributes of an object: name, value and unit.
    pub values: Vec<(String, Value, &'static str)>,
    /// Places with a smaller rank are better.
    pub(super) rank: f64,
}

/// The result of a search.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Located {
    /// The places, the best first.
    pub places: Vec<Match>,
    /// The distance between the samples that were searched first, in metres.
    pub cell: f64,
    /// The distance between the samples in which the places were found, in metres.
    pub own_cell: f64,
    /// The position that places were searched near to, in metres east and south of the world's origin.
    pub near: [f64; 2],
    /// The radius of the searched area, in metres.
    pub within: f64,
}

/// The points of the compass, clockwise from north.
const COMPASS: [&str; 8] = ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];

/// A length in words.
fn length(metres: f64) -> String {
    match metres {
        long if long >= 10_000.0 => format!("{:.1} km", long / 1000.0),
        short => format!("{short:.0} m"),
    }
}

fn value(value: &Value, unit: &str) -> String {
    let with_unit = |text: String| if unit.is_empty() { text } else { format!("{text} {unit}") };
    match value {
        Value::Null => "none".to_owned(),
        Value::Integer(number) => with_unit(number.to_string()),
        Value::Real(real) if real.abs() >= 1000.0 || real.fract() == 0.0 => with_unit(number(real.round())),
        Value::Real(real) => with_unit(format!("{real:.2}")),
        Value::Boolean(is) => is.to_string(),
        Value::Text(text) => text.to_string(),
    }
}

impl Located {
    /// The places as lines of text, and how they were searched.
    #[must_use]
    pub fn words(&self) -> String {
        let line = |(nth, place): (usize, &Match)| {
            let [east, south] = [place.at[0] - self.near[0], place.at[1] - self.near[1]];
            let turn = libm::atan2(east, -south) / std::f64::consts::TAU;
            let direction = COMPASS[((turn * 8.0).round() as i64).rem_euclid(8) as usize];
            let [x, y] = place.coordinates.map(|at| number((at * 100.0).round() / 100.0));
            let values = place.values.iter().map(|(name, own, unit)| format!("{name} {}", value(own, unit)));
            let values: Vec<String> = values.collect();
            let away = match place.distance {
                0.0 => "here".to_owned(),
                distance => format!("{} {direction}", length(distance)),
            };
            format!("{}. {x},{y} ({away}): {}\n", nth + 1, values.join(", "))
        };
        let lines: String = self.places.iter().enumerate().map(line).collect();
        let how = match self.cell > self.own_cell {
            true => format!(
                "searched at a cell of {} m, found at {} m; smaller places may be missing",
                number(self.cell),
                number(self.own_cell)
            ),
            false => format!("searched at a cell of {} m", number(self.cell)),
        };
        let none = match self.places.is_empty() {
            true => format!("no place within {}\n", length(self.within)),
            false => String::new(),
        };
        format!("{lines}{none}{how}\n")
    }

    /// The places as an object of JSON, with a line end.
    #[must_use]
    pub fn to_json(&self) -> String {
        let json_of = |value: &Value| match value {
            Value::Null => Json::Null,
            Value::Integer(number) => json!(number),
            Value::Real(number) => json!(number),
            Value::Boolean(is) => json!(is),
            Value::Text(text) => json!(text),
        };
        let place = |place: &Match| {
            let values: Map<String, Json> =
                place.values.iter().map(|(name, value, _)| (name.clone(), json_of(value))).collect();
            json!({ "coordinates": place.coordinates, "distance": place.distance, "values": values })
        };
        let places: Vec<Json> = self.places.iter().map(place).collect();
        let whole = json!({
            "places": places,
            "search_cell": self.cell,
            "cell": self.own_cell,
            "within": self.within,
        });
        // A tree of numbers and strings can always be serialized.
        serde_json::to_string_pretty(&whole).unwrap_or_default() + "\n"
    }
}

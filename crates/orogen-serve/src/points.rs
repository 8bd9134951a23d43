//! Layers at points and along lines.

use std::sync::Arc;

use axum::response::Response;
use orogen::grid::hex;
use orogen::io::format::Georeference;
use orogen::world::HEIGHT;
use serde_json::{Value, json};

use crate::call::Call;
use crate::desk::{Keep, Work};
use crate::refusal::Refusal;
use crate::served::Served;

/// Default and maximum number of points along a line.
const ALONG: usize = 256;
pub const MAX_ALONG: usize = 4096;

/// Maximum number of corners of a line.
const MAX_CORNERS: usize = 256;

/// Number of points between two checks for cancellation.
const CHUNK: usize = 32;

/// The position of the world: on its map, otherwise metres east and north of its origin.
fn place(served: &Served) -> Georeference {
    served.map().unwrap_or(Georeference::LOCAL)
}

/// `/height?x=&y=`.
pub async fn height(call: Call) -> Result<Response, Refusal> {
    call.query.only_of_variants(&["x", "y", "layer"])?;
    let served = call.served()?;
    let (Some(x), Some(y)) = (call.query.number("x")?, call.query.number("y")?) else {
        let message = "give `x` and `y`: map coordinates, or metres east and north of the world's north-west corner, such as x=1200&y=-800";
        return Err(Refusal::bad(message));
    };
    let layer = call.query.get("layer").unwrap_or(HEIGHT).to_string();
    answered(&call, served, layer, vec![[x, y]], |unit, layer, points, values| {
        json!({ "x": points[0][0], "y": points[0][1], "layer": layer, "unit": unit, "value": finite(values[0]) })
    })
    .await
}

/// `/profile?points=`.
pub async fn profile(call: Call) -> Result<Response, Refusal> {
    call.query.only_of_variants(&["points", "samples", "layer"])?;
    let served = call.served()?;
    let corners = corners(call.query.get("points").unwrap_or_default())?;
    let samples = call.query.count("samples", 2..=MAX_ALONG)?.unwrap_or(ALONG);
    let (points, distances) = along(&corners, &place(&served), samples);
    let layer = call.query.get("layer").unwrap_or(HEIGHT).to_string();
    answered(&call, served, layer, points, move |unit, layer, points, values| {
        let axis = |axis: usize| points.iter().map(|point| point[axis]).collect::<Vec<f64>>();
        json!({
            "layer": layer,
            "unit": unit,
            "length": distances.last(),
            "distance": distances,
            "x": axis(0),
            "y": axis(1),
            "values": values.iter().map(|value| finite(*value)).collect::<Vec<Value>>(),
        })
    })
    .await
}

/// The corners of a line: `x,y;x,y`.
fn corners(text: &str) -> Result<Vec<[f64; 2]>, Refusal> {
    let wrong = || {
        Refusal::bad(format!(
            "`points` must be 2 to {MAX_CORNERS} positions, x,y;x,y, such as points=0,0;5000,-2500, not `{text}`"
        ))
    };
    let point = |text: &str| {
        let (x, y) = text.split_once(',')?;
        let point = [x.trim().parse().ok()?, y.trim().parse().ok()?];
        point.iter().all(|part: &f64| part.is_finite()).then_some(point)
    };
    let corners: Option<Vec<[f64; 2]>> = text.split(';').map(point).take(MAX_CORNERS + 1).collect();
    corners.filter(|corners| (2..=MAX_CORNERS).contains(&corners.len())).ok_or_else(wrong)
}

/// Points at equal distances along a line, and their distances from its start in metres.
fn along(corners: &[[f64; 2]], place: &Georeference, samples: usize) -> (Vec<[f64; 2]>, Vec<f64>) {
    let length = |a: [f64; 2], b: [f64; 2]| {
        let ([ax, ay], [bx, by]) = (place.metres(a[0], a[1]), place.metres(b[0], b[1]));
        libm::hypot(bx - ax, by - ay)
    };
    let lengths: Vec<f64> = corners.windows(2).map(|pair| length(pair[0], pair[1])).collect();
    let total: f64 = lengths.iter().sum();
    let (mut points, mut distances) = (Vec::with_capacity(samples), Vec::with_capacity(samples));
    let (mut leg, mut before) = (0, 0.0);
    for k in 0..samples {
        let at = total * k as f64 / (samples - 1) as f64;
        while leg + 1 < lengths.len() && at > before + lengths[leg] {
            before += lengths[leg];
            leg += 1;
        }
        let share = if lengths[leg] > 0.0 { ((at - before) / lengths[leg]).clamp(0.0, 1.0) } else { 0.0 };
        let (a, b) = (corners[leg], corners[leg + 1]);
        // The ends are exactly the given ones.
        points.push(if share == 1.0 { b } else { [0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * share) });
        distances.push(at);
    }
    (points, distances)
}

/// A number for JSON, which has no NaN.
fn finite(value: f32) -> Value {
    if value.is_finite() { json!(value) } else { Value::Null }
}

/// The answer for points in coordinates of requests.
async fn answered(
    call: &Call,
    served: Arc<Served>,
    layer: String,
    points: Vec<[f64; 2]>,
    describe: impl FnOnce(&str, &str, &[[f64; 2]], &[f32]) -> Value + Send + 'static,
) -> Result<Response, Refusal> {
    let world = served.world_of(&layer).map_err(|error| Refusal::of(&error).or_absent())?;
    if world.unit(&layer).is_err() {
        return Err(Refusal::bad(format!("`{layer}` has several channels; read it from /window.npy")));
    }
    let fingerprint = hex::encode(&served.fingerprint(&layer)?);
    let key = format!("points {} {fingerprint} {}", served.name, call.query.text());
    let place = place(&served);
    let owner = Arc::clone(&served);
    let work = async || {
        Ok(Box::new(move |progress: &orogen::Progress| {
            let sampler = owner.sampler(&layer)?;
            let [xs, ys]: [Vec<f64>; 2] =
                [0, 1].map(|axis| points.iter().map(|point| place.metres(point[0], point[1])[axis]).collect());
            let mut values = vec![f32::NAN; points.len()];
            for ((xs, ys), values) in xs.chunks(CHUNK).zip(ys.chunks(CHUNK)).zip(values.chunks_mut(CHUNK)) {
                progress.check()?;
                sampler.points(xs, ys, values).map_err(|error| {
                    let refusal = Refusal::of(&error);
                    Refusal {
                        message: format!("{} (y counts north of the origin in requests)", refusal.message),
                        ..refusal
                    }
                })?;
            }
            let unit = world.unit(&layer).unwrap_or_default();
            Ok(describe(unit, &layer, &points, &values).to_string().into())
        }) as Work)
    };
    call.worked(&served, (key, Keep::Nothing), "application/json", work).await
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_divided_into_equal_parts() {
        let place = Georeference::LOCAL;
        let corners = corners("0,0; 30,-40;30,10").unwrap();
        let (points, distances) = along(&corners, &place, 5);
        assert_eq!(distances, [0.0, 25.0, 50.0, 75.0, 100.0]);
        assert_eq!(points, [[0.0, 0.0], [15.0, -20.0], [30.0, -40.0], [30.0, -15.0], [30.0, 10.0]]);
        let (points, distances) = along(&[[1.0, 2.0], [1.0, 2.0]], &place, 2);
        assert_eq!((points, distances), (vec![[1.0, 2.0]; 2], vec![0.0; 2]));
    }

    #[test]
    fn what_is_no_line_is_a_sentence() {
        for text in ["", "1,2", "1,2;3", "1,2;nan,3", "1,2;a,3", &"1,2;".repeat(300)] {
            assert!(corners(text).unwrap_err().message.contains("`points` must be 2 to 256 positions"), "{text}");
        }
    }
}

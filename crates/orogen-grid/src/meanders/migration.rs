//! The movement of a river by the curvature of its bends, here and upstream.

use super::cutoffs::cut;
use super::{History, Meanders, distance, smoothstep};
use crate::polylines::outline::Outline;
use crate::polylines::segments::Segments;
use crate::random::Random;

/// Rate of migration by the curvature at a point and by that upstream (Howard and Knutson 1984).
const LOCAL: f64 = -1.0;
const UPSTREAM: f64 = 2.5;

/// Exponent of the sinuosity, by which a longer river, which is less steep, moves more slowly.
const SINUOSITY: f64 = -2.0 / 3.0;

/// Maximum movement in a step, in widths, and the maximum number of steps.
const STEP: f64 = 0.1;
const MAX_STEPS: usize = 5000;

/// Distance of neighboring points, in widths.
const SPACING: f64 = 0.5;

/// Maximum number of points of a river.
const MAX_POINTS: usize = 1 << 14;

/// Maximum curvature, in 1 / width: bends that are tighter do not move faster.
const TIGHTEST: f64 = 0.6;

/// Amplitude of the first bends, in widths.
const FIRST_BENDS: f64 = 0.6;

/// Curvature, in 1 / width, with which the flow enters, and the widths of nominal movement over which it changes. A
/// flow that enters straight on would stay straight for a long way.
const ENTRY: f64 = 0.4;
const ENTRY_TIME: f64 = 12.0;

/// Length of the parts at both ends that move less, in widths.
const FIXED: f64 = 8.0;

/// Share of a valley in which the river moves freely.
const FREE: f64 = 0.6;

/// Widths of nominal movement from one kept course to the next, such that no bend moves by more than its width, and the
/// numbers of kept courses.
const KEPT: f64 = 2.5;
pub const COURSES: [usize; 2] = [16, 128];

/// The history of a river along a line.
pub fn migrate(river: &Meanders, line: &[[f64; 2]], index: u64) -> History {
    let mut random = Random::new(river.seed, index);
    let spacing = spacing(river, line);
    let mut points = spaced(line, spacing);
    bend(&mut points, FIRST_BENDS * river.width, &mut random);
    let valley = Valley::new(river, line);
    let [fewest, most] = COURSES;
    let courses = ((river.migration / KEPT).ceil() as usize).clamp(fewest, most);
    let steps = ((river.migration / STEP).ceil() as usize).clamp(courses, MAX_STEPS);
    let every = steps.div_ceil(courses);
    // Widths of nominal movement in a step.
    let step = river.migration / steps as f64;
    let mut entry = [0.0; 2].map(|_| 2.0 * random.share() - 1.0);
    let mut history = History { courses: vec![sparse(&points)], oxbows: Vec::new() };
    for at in 1..=steps {
        let time = at as f64 * step / ENTRY_TIME;
        if (time - step / ENTRY_TIME).floor() < time.floor() {
            entry = [entry[1], 2.0 * random.share() - 1.0];
        }
        let share = smoothstep(time - time.floor());
        let entering = ENTRY * (entry[0] + share * (entry[1] - entry[0]));
        advance(river, &mut points, (step, entering), spacing, &valley);
        cut(river.width, &mut points, at as f64 / every as f64, &mut history.oxbows);
        respace(&mut points, spacing);
        if at == steps {
            history.courses.push(points.clone());
        } else if at % every == 0 {
            history.courses.push(sparse(&points));
        }
    }
    history
}

/// Every second point of a line, with its ends.
fn sparse(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let last = points.len().saturating_sub(1);
    points.iter().enumerate().filter(|(k, _)| k % 2 == 0 || *k == last).map(|(_, point)| *point).collect()
}

/// How many times as long as its line a river becomes at most, approximately.
const LENGTHENED: f64 = 4.0;

/// Approximate number of points of rivers along lines with this total length in metres.
pub fn points_of(river: &Meanders, length: f64) -> f64 {
    LENGTHENED * length / (SPACING * river.width)
}

/// The distance of neighboring points. Rivers that are very long for their width have fewer of them.
fn spacing(river: &Meanders, line: &[[f64; 2]]) -> f64 {
    let length: f64 = line.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
    (SPACING * river.width).max(LENGTHENED * length / MAX_POINTS as f64)
}

/// Points at equal distances along a line, with its ends.
fn spaced(line: &[[f64; 2]], spacing: f64) -> Vec<[f64; 2]> {
    let length: f64 = line.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
    let parts = (length / spacing).round().clamp(1.0, MAX_POINTS as f64);
    let mut points = Vec::with_capacity(parts as usize + 1);
    points.extend(line.first());
    let (mut before, mut next) = (0.0, 1.0);
    for pair in line.windows(2) {
        let own = distance(pair[0], pair[1]);
        while next < parts && next * length / parts <= before + own {
            let share = if own > 0.0 { (next * length / parts - before) / own } else { 0.0 };
            points.push([0, 1].map(|k| pair[0][k] + share * (pair[1][k] - pair[0][k])));
            next += 1.0;
        }
        before += own;
    }
    points.extend(line.last().filter(|_| line.len() > 1));
    points
}

/// Moves points across the line at random, smoothly along it.
fn bend(points: &mut [[f64; 2]], amplitude: f64, random: &mut Random) {
    /// Points whose offsets are averaged.
    const AVERAGED: usize = 5;
    let offsets: Vec<f64> = points.iter().map(|_| 2.0 * random.share() - 1.0).collect();
    let from = points.to_vec();
    for k in 1..points.len().saturating_sub(1) {
        let around = &offsets[k.saturating_sub(AVERAGED / 2)..(k + AVERAGED / 2 + 1).min(offsets.len())];
        let offset = amplitude * around.iter().sum::<f64>() / (around.len() as f64).sqrt();
        let [nx, ny] = normal(from[k - 1], from[k + 1]);
        points[k] = [from[k][0] + offset * nx, from[k][1] + offset * ny];
    }
}

/// The unit vector to the right of the direction from one point to another, in coordinates with y to the south: from
/// the east it points south.
fn normal(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    let length = distance(from, to).max(f64::MIN_POSITIVE);
    [(from[1] - to[1]) / length, (to[0] - from[0]) / length]
}

/// Moves the points of a river by one step of nominal movement, in widths. The flow enters with a curvature.
fn advance(river: &Meanders, points: &mut Vec<[f64; 2]>, (step, entering): (f64, f64), spacing: f64, valley: &Valley) {
    let count = points.len();
    if count < 3 {
        return;
    }
    // The influence of a bend falls by this factor from point to point downstream.
    let decay = 2.0 * river.friction / river.depth;
    let factor = libm::exp(-decay * spacing);
    let length: f64 = points.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
    let sinuosity = (length / distance(points[0], points[count - 1]).max(river.width)).max(1.0);
    let pace = step * river.width * libm::pow(sinuosity, SINUOSITY);
    let mut upstream = entering;
    let mut moved = points.clone();
    let mut along = 0.0;
    for k in 1..count - 1 {
        let [a, b, c] = [points[k - 1], points[k], points[k + 1]];
        along += distance(a, b);
        let nominal = (curvature(a, b, c) * river.width).clamp(-TIGHTEST, TIGHTEST);
        upstream = factor * upstream + (1.0 - factor) * nominal;
        let rate = LOCAL * nominal + UPSTREAM * upstream;
        let ends = (along.min(length - along) / (FIXED * river.width)).clamp(0.0, 1.0);
        let [nx, ny] = normal(a, c);
        // A bend to the right has its center on the right; it moves to the left.
        let offset = -pace * rate * ends;
        let to = [b[0] + offset * nx, b[1] + offset * ny];
        let kept = valley.kept(b, to);
        moved[k] = [b[0] + kept * (to[0] - b[0]), b[1] + kept * (to[1] - b[1])];
    }
    *points = moved;
    smooth(points);
}

/// Removes the shortest waves, which points cannot carry.
fn smooth(points: &mut [[f64; 2]]) {
    const WEIGHT: f64 = 0.05;
    let mut before = points[0];
    for k in 1..points.len() - 1 {
        let own = points[k];
        let next = points[k + 1];
        points[k] = [0, 1].map(|i| own[i] + WEIGHT * (0.5 * (before[i] + next[i]) - own[i]));
        before = own;
    }
}

/// The curvature of the circle through three points, in 1 / m: positive if it turns to the right.
fn curvature(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let cross = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
    let sides = distance(a, b) * distance(b, c) * distance(a, c);
    if sides > 0.0 { 2.0 * cross / sides } else { 0.0 }
}

/// Adds points where neighbors are far apart, and removes them where they are close together.
fn respace(points: &mut Vec<[f64; 2]>, spacing: f64) {
    let (longest, shortest) = (1.4 * spacing, 0.6 * spacing);
    let mut spaced: Vec<[f64; 2]> = Vec::with_capacity(points.len() + points.len() / 8);
    let last = points.len() - 1;
    for (k, &point) in points.iter().enumerate() {
        let Some(&before) = spaced.last() else {
            spaced.push(point);
            continue;
        };
        let apart = distance(before, point);
        if apart > longest && spaced.len() < 2 * MAX_POINTS {
            // The middle of a cubic through the neighbors: between them a bend is not straight.
            let outer = [if spaced.len() > 1 { spaced[spaced.len() - 2] } else { before }, points[(k + 1).min(last)]];
            spaced.push([0, 1].map(|i| 0.5625 * (before[i] + point[i]) - 0.0625 * (outer[0][i] + outer[1][i])));
        }
        if apart >= shortest || k == last {
            spaced.push(point);
        }
    }
    *points = spaced;
}

/// The valley floor.
struct Valley {
    line: Segments,
    half: f64,
}

impl Valley {
    fn new(river: &Meanders, line: &[[f64; 2]]) -> Valley {
        let outline = Outline::of_points(&line.iter().map(|[x, y]| [*x, *y, 0.0]).collect::<Vec<_>>());
        let half = 0.5 * river.valley;
        Valley { line: if half > 0.0 { Segments::new(&[outline], 0.0) } else { Segments::default() }, half }
    }

    /// The share of a movement that the sides of the valley allow: less and less outward near them.
    fn kept(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        if self.half <= 0.0 {
            return 1.0;
        }
        if self.line.nearest(to, FREE * self.half).is_some() {
            return 1.0;
        }
        let away = |at| self.line.nearest(at, f64::INFINITY).map_or(0.0, |nearest| nearest.distance());
        let (before, after) = (away(from), away(to));
        if after <= before { 1.0 } else { ((1.0 - before / self.half) / (1.0 - FREE)).clamp(0.0, 1.0) }
    }
}

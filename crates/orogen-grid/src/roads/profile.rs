//! Heights along a road with a maximum grade, and what of it is a bridge or a tunnel.

use super::lattice::Lattice;
use super::lines::RoadKind;
use super::smooth::Curve;
use super::{Land, Roads};

/// Length over which the ground, and then the profile, is evened, in metres: vertical curves.
const EVEN: f64 = 60.0;
/// Height above the ground from which a bridge of the route is one, as a share of the highest embankment.
const PLANNED: f64 = 0.3;
/// Height of bridges over the lower bank, in metres.
const CLEAR: f64 = 1.0;
/// Shorter tunnels are cuts, and shorter roads between two bridges or two tunnels are none, in widths of the road.
const SHORT: [f64; 2] = [4.0, 2.0];

/// A curve on the land.
pub(super) struct Profile {
    /// Heights of the road at the points of the curve.
    pub(super) heights: Vec<f64>,
    /// What the road is from each point on.
    pub(super) kinds: Vec<RoadKind>,
}

/// The ground along a curve.
struct Ground {
    heights: Vec<f64>,
    wet: Vec<bool>,
}

impl Ground {
    fn new(land: &Land, lattice: &Lattice, curve: &Curve) -> Ground {
        let heights: Vec<f64> = curve.points.iter().map(|at| height(land, lattice, *at)).collect();
        let wet = curve.points.iter().zip(&heights);
        let wet = wet.map(|(at, height)| lattice.wet[lattice.sample_at(*at)] || !height.is_finite()).collect();
        Ground { heights, wet }
    }
}

/// The height at a position, linear between samples; NaN where one of them has none.
fn height(land: &Land, lattice: &Lattice, at: [f64; 2]) -> f64 {
    let window = &lattice.window;
    let [x, y] = lattice.columns(at);
    let part = |at: f64, count: usize| {
        let first = at.floor().clamp(0.0, (count.max(2) - 2) as f64);
        (first as usize, (at - first).clamp(0.0, 1.0))
    };
    let ((i, x), (j, y)) = (part(x, window.width), part(y, window.height));
    let sample = |i: usize, j: usize| {
        let (i, j) = (i.min(window.width - 1), j.min(window.height - 1));
        f64::from(land.ground.data()[j * window.width + i])
    };
    let north = sample(i, j) * (1.0 - x) + sample(i + 1, j) * x;
    let south = sample(i, j + 1) * (1.0 - x) + sample(i + 1, j + 1) * x;
    north * (1.0 - y) + south * y
}

/// The profile of a curve. `pins` are heights at points, in order, that the profile has where its grade allows.
pub(super) fn profile(
    roads: &Roads,
    land: &Land,
    lattice: &Lattice,
    curve: &Curve,
    pins: &[(usize, f64)],
    stride: f64,
) -> Profile {
    let ground = Ground::new(land, lattice, curve);
    let count = curve.points.len();
    // What the road follows: the ground where it is on it.
    let follows: Vec<bool> = (0..count).map(|k| !ground.wet[k] && curve.kinds[k].is_none()).collect();
    let even = (0.5 * EVEN / stride).round().max(1.0) as usize;
    let wanted = evened_ground(&ground, &follows, even);
    let grades = Grades { roads, chainage: &curve.chainage };
    let mut heights = grades.between(&wanted);
    let fixed: Vec<usize> = pins.iter().map(|(point, _)| *point).collect();
    for _ in 0..2 {
        heights = evened(&heights, even / 2, &fixed);
    }
    // Points are not quite evenly spaced.
    heights = grades.between(&heights);
    let banks = banks(&ground);
    let least = grades.envelope(&banks, 1.0);
    heights.iter_mut().zip(&least).for_each(|(height, least)| *height = height.max(*least));
    if !pins.is_empty() {
        let mut pinned = vec![f64::NAN; count];
        pins.iter().for_each(|(point, height)| pinned[*point] = *height);
        let [least, most] = [1.0, -1.0].map(|sign| grades.envelope(&pinned, sign));
        for (height, (least, most)) in heights.iter_mut().zip(least.iter().zip(&most)) {
            // Pins too close to each other for the grade: the road is steeper there.
            *height = if least > most { 0.5 * (least + most) } else { height.clamp(*least, *most) };
        }
        pins.iter().for_each(|(point, height)| heights[*point] = *height);
    }
    let kinds = kinds(roads, curve, &ground, &heights, lattice.window.cell);
    Profile { heights, kinds }
}

/// The ground that the road follows, evened; NaN elsewhere.
fn evened_ground(ground: &Ground, follows: &[bool], even: usize) -> Vec<f64> {
    let count = follows.len();
    let (mut sums, mut counts) = (vec![0.0; count + 1], vec![0usize; count + 1]);
    for k in 0..count {
        let height = if follows[k] { ground.heights[k] } else { 0.0 };
        (sums[k + 1], counts[k + 1]) = (sums[k] + height, counts[k] + usize::from(follows[k]));
    }
    let mean = |k: usize| {
        let half = even.min(k).min(count - 1 - k);
        let (first, end) = (k - half, k + half + 1);
        (sums[end] - sums[first]) / (counts[end] - counts[first]) as f64
    };
    (0..count).map(|k| if follows[k] { mean(k) } else { f64::NAN }).collect()
}

/// The lower bank at each point in water; NaN on land.
fn banks(ground: &Ground) -> Vec<f64> {
    let count = ground.wet.len();
    let mut banks = vec![f64::NAN; count];
    let mut first = 0;
    while first < count {
        let end = (first..count).find(|k| ground.wet[*k] != ground.wet[first]).unwrap_or(count);
        if ground.wet[first] {
            let beside = [first.checked_sub(1), (end < count).then_some(end)];
            let heights = beside.into_iter().flatten().map(|k| ground.heights[k]);
            let bank = heights.fold(f64::INFINITY, f64::min);
            if bank.is_finite() {
                banks[first..end].fill(bank + CLEAR);
            }
        }
        first = end;
    }
    banks
}

/// Bounds of heights by the grade.
struct Grades<'a> {
    roads: &'a Roads,
    chainage: &'a [f64],
}

impl Grades<'_> {
    /// The lowest (sign 1) line over given heights, or the highest (sign -1) below them, that keeps the grade. NaN are
    /// no heights.
    fn envelope(&self, given: &[f64], sign: f64) -> Vec<f64> {
        let mut bound = vec![f64::NEG_INFINITY; given.len()];
        let forward: Vec<usize> = (0..given.len()).collect();
        let back = forward.iter().rev().copied().collect::<Vec<usize>>();
        for order in [forward, back] {
            let mut near = (f64::NEG_INFINITY, 0.0);
            for k in order {
                let carried = near.0 - self.roads.grade * (self.chainage[k] - near.1).abs();
                let own = if given[k].is_nan() { f64::NEG_INFINITY } else { sign * given[k] };
                near = (own.max(carried), self.chainage[k]);
                bound[k] = near.0.max(bound[k]);
            }
        }
        bound.iter_mut().for_each(|bound| *bound *= sign);
        bound
    }

    /// The line that keeps the grade with the least maximum distance from heights: between the two envelopes.
    fn between(&self, wanted: &[f64]) -> Vec<f64> {
        let [over, under] = [1.0, -1.0].map(|sign| self.envelope(wanted, sign));
        let line = over.iter().zip(&under).map(|(over, under)| 0.5 * (over + under));
        line.map(|height| if height.is_finite() { height } else { 0.0 }).collect()
    }
}

/// Means over `half` points before and after, fewer near the ends and near fixed points. The mean of a line that keeps
/// a grade keeps it.
fn evened(heights: &[f64], half: usize, fixed: &[usize]) -> Vec<f64> {
    let count = heights.len();
    let base = heights.first().copied().unwrap_or(0.0);
    let mut sums = vec![0.0; count + 1];
    for k in 0..count {
        sums[k + 1] = sums[k] + (heights[k] - base);
    }
    let mut room: Vec<usize> = (0..count).map(|k| half.min(k).min(count - 1 - k)).collect();
    for point in fixed {
        let near = point.saturating_sub(half)..(point + half + 1).min(count);
        near.for_each(|k| room[k] = room[k].min(k.abs_diff(*point)));
    }
    (0..count).map(|k| base + (sums[k + room[k] + 1] - sums[k - room[k]]) / (2 * room[k] + 1) as f64).collect()
}

/// What the road is at each point.
fn kinds(roads: &Roads, curve: &Curve, ground: &Ground, heights: &[f64], cell: f64) -> Vec<RoadKind> {
    let highest = roads.slope_width * roads.embankment_slope;
    let deepest = roads.slope_width * roads.cut_slope;
    // Bridges begin on the bank, so that their abutments do not stand in the water.
    let over = near_water(&ground.wet, &curve.chainage, 0.5 * roads.width.max(cell) + 0.5 * cell);
    let mut kinds: Vec<RoadKind> = (0..heights.len())
        .map(|k| {
            let above = heights[k] - ground.heights[k];
            let planned = if curve.kinds[k] == Some(RoadKind::Bridge) { PLANNED } else { 1.0 };
            match () {
                () if over[k] || above > highest * planned => RoadKind::Bridge,
                () if -above > deepest => RoadKind::Tunnel,
                () => RoadKind::Road,
            }
        })
        .collect();
    let [tunnel, between] = SHORT.map(|widths| widths * roads.width);
    join(&mut kinds, &curve.chainage, |kind, length, beside| match kind {
        RoadKind::Road if length < between && beside[0] == beside[1] => beside[0],
        _ => None,
    });
    join(&mut kinds, &curve.chainage, |kind, length, _| {
        (kind == RoadKind::Tunnel && length < tunnel).then_some(RoadKind::Road)
    });
    kinds
}

/// Whether each point is in water, or within a distance of it.
fn near_water(wet: &[bool], chainage: &[f64], distance: f64) -> Vec<bool> {
    let mut near = wet.to_vec();
    let forward: Vec<usize> = (0..wet.len()).collect();
    let back: Vec<usize> = forward.iter().rev().copied().collect();
    for order in [forward, back] {
        let mut water = f64::INFINITY;
        for k in order {
            water = if wet[k] { chainage[k] } else { water };
            near[k] |= (chainage[k] - water).abs() <= distance;
        }
    }
    near
}

/// Changes stretches of one kind, by their length and the kinds beside them.
fn join(
    kinds: &mut [RoadKind],
    chainage: &[f64],
    change: impl Fn(RoadKind, f64, [Option<RoadKind>; 2]) -> Option<RoadKind>,
) {
    let mut first = 0;
    while first < kinds.len() {
        let kind = kinds[first];
        let end = (first..kinds.len()).find(|k| kinds[*k] != kind).unwrap_or(kinds.len());
        let beside = [first.checked_sub(1).map(|k| kinds[k]), kinds.get(end).copied()];
        let length = chainage[end.min(kinds.len() - 1)] - chainage[first];
        if let Some(other) = change(kind, length, beside) {
            kinds[first..end].fill(other);
        }
        first = end;
    }
}

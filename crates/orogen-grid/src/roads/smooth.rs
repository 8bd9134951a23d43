//! Smooth curves along routes: uniform cubic B-splines, whose curvature changes steadily, as that of clothoids does.

use super::lattice::Lattice;
use super::lines::RoadKind;

/// A point that a curve is drawn to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Control {
    pub(super) at: [f64; 2],
    /// What the route is from here to the next control.
    pub(super) kind: Option<RoadKind>,
    /// The node of the route here; `None` between nodes.
    pub(super) node: Option<u32>,
}

/// A curve, as points.
pub(super) struct Curve {
    /// Metres east and south.
    pub(super) points: Vec<[f64; 2]>,
    /// The bridge or tunnel of the route from each point on.
    pub(super) kinds: Vec<Option<RoadKind>>,
    /// The nodes of the route, with the points at them.
    pub(super) nodes: Vec<(u32, usize)>,
    /// Distance of each point along the curve, in metres.
    pub(super) chainage: Vec<f64>,
}

/// Length of the straight pieces between controls, at most, in spacings of nodes; and of those of bridges and tunnels.
const LONGEST: f64 = 2.5;
const STRAIGHT: f64 = 1.5;
/// Rounds in which controls are added where a curve is in water.
const ROUNDS: usize = 4;

fn middle(a: [f64; 2], b: [f64; 2], share: f64) -> [f64; 2] {
    [0, 1].map(|k| a[k] + (b[k] - a[k]) * share)
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(b[0] - a[0], b[1] - a[1])
}

/// Controls with others between them, so that the curve stays near its route.
fn divided(lattice: &Lattice, controls: &[Control]) -> Vec<Control> {
    let mut divided = Vec::new();
    for pair in controls.windows(2) {
        let length = distance(pair[0].at, pair[1].at) / lattice.spacing;
        let parts = match pair[0].kind {
            Some(_) => (length / STRAIGHT).ceil().max(4.0),
            None => (length / LONGEST).ceil().max(1.0),
        };
        divided.push(pair[0]);
        for k in 1..parts as usize {
            divided.push(Control { at: middle(pair[0].at, pair[1].at, k as f64 / parts), node: None, ..pair[0] });
        }
    }
    divided.extend(controls.last());
    divided
}

/// The smooth curve along controls, with points about `stride` metres apart. It begins and ends at the first and the
/// last of them.
pub(super) fn curve(lattice: &Lattice, controls: &[Control], stride: f64) -> Curve {
    let mut controls = divided(lattice, controls);
    for round in 0.. {
        let (curve, firsts) = drawn(&controls, stride);
        let is_wet = |at: &[f64; 2]| lattice.wet[lattice.sample_at(*at)];
        let touches: Vec<bool> = (0..controls.len().saturating_sub(1))
            .map(|k| controls[k].kind.is_none() && curve.points[firsts[k]..firsts[k + 1]].iter().any(is_wet))
            .collect();
        if round == ROUNDS || !touches.contains(&true) {
            return curve;
        }
        let mut more = Vec::new();
        for (k, pair) in controls.windows(2).enumerate() {
            more.push(pair[0]);
            let around = k.saturating_sub(1)..(k + 2).min(touches.len());
            if touches[around].contains(&true) {
                more.push(Control { at: middle(pair[0].at, pair[1].at, 0.5), node: None, ..pair[0] });
            }
        }
        more.extend(controls.last());
        controls = more;
    }
    drawn(&controls, stride).0
}

/// The curve of controls, and the index of the first point of each.
fn drawn(controls: &[Control], stride: f64) -> (Curve, Vec<usize>) {
    let mut curve = Curve { points: Vec::new(), kinds: Vec::new(), nodes: Vec::new(), chainage: Vec::new() };
    let mut firsts = Vec::with_capacity(controls.len());
    let last = controls.len().saturating_sub(1);
    // Beyond its ends the route goes straight on.
    let at = |k: isize| match k {
        k if k < 0 => middle(controls[0].at, controls[1.min(last)].at, -1.0),
        k if k as usize > last => middle(controls[last].at, controls[last.saturating_sub(1)].at, -1.0),
        k => controls[k as usize].at,
    };
    for (k, control) in controls.iter().enumerate() {
        firsts.push(curve.points.len());
        curve.nodes.extend(control.node.map(|node| (node, curve.points.len())));
        let around = [-1, 0, 1, 2].map(|offset| at(k as isize + offset));
        let count = match k < last {
            true => (distance(around[1], around[2]) / stride).ceil().clamp(1.0, 1e6) as usize,
            false => 1,
        };
        for part in 0..count {
            let t = part as f64 / count as f64;
            let s = 1.0 - t;
            let weights = [
                s * s * s / 6.0,
                (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
                (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0,
                t * t * t / 6.0,
            ];
            // Relative to a control, so that the precision does not depend on the distance from the origin.
            let base = around[1];
            let sum = |axis: usize| -> f64 {
                (0..4).map(|point| weights[point] * (around[point][axis] - base[axis])).sum::<f64>()
            };
            curve.points.push([base[0] + sum(0), base[1] + sum(1)]);
            curve.kinds.push(control.kind);
        }
    }
    let mut length = 0.0;
    for k in 0..curve.points.len() {
        length += if k > 0 { distance(curve.points[k - 1], curve.points[k]) } else { 0.0 };
        curve.chainage.push(length);
    }
    (curve, firsts)
}

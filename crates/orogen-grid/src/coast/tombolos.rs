//! Tombolos: necks of sand from a shore to an islet before it.

use super::Coast;
use super::course::STEP;
use super::nodes::Nodes;
use super::ridges::{DEEPEST, Part, Ridges};

/// An islet is joined to the shore if its distance is less than this times its length (Sunamura and Mizuno 1987).
const SHADOW: f64 = 1.5;
/// Longest shore of an islet, in metres.
const ISLET: f64 = 6000.0;
/// Width of the neck over the length of the islet, and its most, in metres.
const NECK: (f64, f64) = (0.2, 250.0);
/// Half width at the ends of the neck, over that in its middle, less 1.
const FLARE: f64 = 1.6;
/// Halvings of the length for which sand suffices.
const HALVINGS: usize = 5;
/// A neck that is built for less than this share of its length is not built.
const LEAST: f64 = 0.35;

/// A shore and an islet in whose shadow it lies.
struct Pair {
    /// Node of the shore and of the islet.
    ends: [usize; 2],
    /// Distance and length of the islet along the shore, in metres.
    distance: f64,
    length: f64,
}

/// Builds tombolos of sand at the nodes, in m^3, and takes it from there.
pub(super) fn build(law: &Coast, ridges: &mut Ridges, nodes: &Nodes, sand: &mut [f64]) {
    for pair in pairs(ridges, nodes) {
        let shares = within_reach(law, nodes, &pair, sand);
        let most: f64 = shares.iter().map(|(_, share)| share).sum();
        let volume = build_neck(ridges, nodes, &pair, most);
        if volume > 0.0 {
            shares.iter().for_each(|(node, share)| sand[*node] -= volume / most * share);
        }
    }
}

/// Islets in order of their nodes, each with the nearest longer shore.
fn pairs(ridges: &Ridges, nodes: &Nodes) -> Vec<Pair> {
    let all = &nodes.nodes;
    let cell = ridges.window.cell;
    let mut pairs = Vec::new();
    let mut first = 0;
    while first < all.len() {
        let count = all[first..].iter().take_while(|node| node.first == all[first].first).count();
        let islet = &all[first..first + count];
        if all[first].line <= ISLET {
            // No islet is longer than half of its shore.
            let far = SHADOW * 0.5 * all[first].line / cell;
            let mut nearest = (far, [first; 2]);
            for (k, other) in all.iter().enumerate().filter(|(_, other)| other.line > all[first].line) {
                for (own, node) in islet.iter().enumerate() {
                    let [x, y] = [0, 1].map(|axis| node.at[axis] - other.at[axis]);
                    if x.abs() < nearest.0 && y.abs() < nearest.0 {
                        let distance = libm::hypot(x, y);
                        if distance < nearest.0 {
                            nearest = (distance, [k, first + own]);
                        }
                    }
                }
            }
            pairs.extend(pair(ridges, nodes, first..first + count, nearest));
        }
        first += count;
    }
    pairs
}

fn pair(
    ridges: &Ridges,
    nodes: &Nodes,
    islet: std::ops::Range<usize>,
    (distance, ends): (f64, [usize; 2]),
) -> Option<Pair> {
    let all = &nodes.nodes;
    if ends[0] == ends[1] || distance < 1.0 {
        return None;
    }
    let [from, to] = ends.map(|node| all[node].at);
    let across = [(to[1] - from[1]) / distance, (from[0] - to[0]) / distance];
    let aside = all[islet].iter().map(|node| node.at[0] * across[0] + node.at[1] * across[1]);
    let (low, high) = aside.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    let deepest =
        (0..=8).map(|k| ridges.depth([0, 1].map(|axis| from[axis] + k as f64 / 8.0 * (to[axis] - from[axis]))));
    let cell = ridges.window.cell;
    let fits = distance < SHADOW * (high - low) && deepest.fold(0.0, f64::max) <= DEEPEST;
    fits.then_some(Pair { ends, distance: distance * cell, length: (high - low) * cell })
}

/// The part of the sand at nodes within the reach of a tombolo.
fn within_reach(law: &Coast, nodes: &Nodes, pair: &Pair, sand: &[f64]) -> Vec<(usize, f64)> {
    let all = &nodes.nodes;
    let mut shares = Vec::new();
    for end in pair.ends {
        let steps = (law.reach / all[end].length) as usize;
        shares.push((end, law.spits * sand[end]));
        let mut sides = [end; 2];
        for step in 1..=steps {
            for side in 0..2 {
                let next = all[sides[side]].ends[side];
                // On around an islet both sides meet.
                if next == sides[side] || next == end || next == sides[1 - side] {
                    continue;
                }
                sides[side] = next;
                let part = 1.0 - step as f64 / (steps + 1) as f64;
                shares.push((next, law.spits * part * sand[next]));
            }
        }
    }
    shares
}

/// Builds what the sand suffices for, from the shore on. Returns its volume.
fn build_neck(ridges: &mut Ridges, nodes: &Nodes, pair: &Pair, most: f64) -> f64 {
    let [from, to] = pair.ends.map(|node| nodes.nodes[node].at);
    let steps = (pair.distance / ridges.window.cell / STEP).ceil().max(2.0) as usize;
    let narrow = (0.5 * NECK.0 * pair.length).clamp(ridges.narrowest(), NECK.1.max(ridges.narrowest()));
    let lay = |ridges: &mut Ridges, count: usize| {
        ridges.undo();
        for k in 0..=count {
            let share = k as f64 / steps as f64;
            let at = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
            let end = 2.0 * share - 1.0;
            // Without the islet the neck ends in a point.
            let half = narrow * (1.0 + FLARE * end * end);
            let half = if count < steps { half.min(narrow * (0.5 + (count - k) as f64 * 0.1)) } else { half };
            ridges.add(Part { at, lee: [0.0; 2], half });
        }
        ridges.volume() <= most
    };
    if !lay(ridges, steps) {
        let (mut low, mut high) = (0, steps);
        for _ in 0..HALVINGS {
            let middle = (low + high) / 2;
            if lay(ridges, middle) { low = middle } else { high = middle }
        }
        if (low as f64) < LEAST * steps as f64 || !lay(ridges, low) {
            ridges.undo();
        }
    }
    ridges.keep()
}

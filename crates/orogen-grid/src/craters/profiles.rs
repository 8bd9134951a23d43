//! Profiles of craters and how they age: heights by the distance from the center, and by the time of diffusion.

use super::step;
use std::sync::OnceLock;

/// Distance in radii at which profiles end.
pub(super) const MAX_DISTANCE: f64 = 4.0;

/// Time of diffusion, in squares of the radius, of a crater that has just formed: its rim is not a knife.
pub(super) const MIN_TIME: f64 = 4e-4;

/// Time of diffusion at which a crater has vanished.
pub(super) const MAX_TIME: f64 = 1.6384;

/// Number of profiles: each has twice the time of the one before.
const TIMES: usize = 13;

/// Number of nodes of a profile per radius.
const PER_RADIUS: usize = 64;

/// Number of nodes of a profile. There is one before the center, and room for the cubic at the end.
const NODES: usize = MAX_DISTANCE as usize * PER_RADIUS + 4;

/// Number of implicit steps between two profiles.
const STEPS: usize = 12;

/// A form of craters, with a depth of 1 from the rim to the floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// A bowl.
    Simple,
    /// A floor of .4 of the diameter with a peak, and walls with terraces.
    Narrow,
    /// A floor of .62 of the diameter with a peak.
    Wide,
}

type Profile = [f64; NODES];

/// Two profiles of a form between which a time lies.
#[derive(Debug, Clone)]
pub(super) struct Row {
    profiles: [&'static Profile; 2],
    share: f64,
}

impl Row {
    /// The profile of a form at a time of diffusion in squares of the radius.
    pub(super) fn new(form: Form, time: f64) -> Row {
        static FORMS: OnceLock<[Box<[Profile]>; 3]> = OnceLock::new();
        let forms = FORMS.get_or_init(|| [Form::Simple, Form::Narrow, Form::Wide].map(aged));
        let doublings = libm::log2((time / MIN_TIME).max(1.0)).min((TIMES - 1) as f64);
        let first = (doublings as usize).min(TIMES - 2);
        let profiles = &forms[form as usize];
        Row { profiles: [&profiles[first], &profiles[first + 1]], share: doublings - first as f64 }
    }

    /// The height at a distance in radii.
    pub(super) fn at(&self, distance: f64) -> f64 {
        let node = distance * PER_RADIUS as f64;
        let first = node.max(0.0) as usize;
        let [one, other] = self.profiles.map(|profile| profile.get(first..first + 4));
        let (Some(one), Some(other)) = (one, other) else { return 0.0 };
        let mut near = [0.0; 4];
        for (near, (one, other)) in near.iter_mut().zip(one.iter().zip(other)) {
            *near = one + (other - one) * self.share;
        }
        // The cubic of Catmull and Rom.
        let [a, b, c, d] = near;
        let t = node - first as f64;
        b + 0.5 * t * ((c - a) + t * ((2.0 * a - 5.0 * b + 4.0 * c - d) + t * (3.0 * (b - c) + d - a)))
    }
}

/// A form at each time, from the formation.
fn aged(form: Form) -> Box<[Profile]> {
    let mut heights: Vec<f64> = (0..NODES).map(|node| fresh(form, node as f64 / PER_RADIUS as f64)).collect();
    let mut time = 0.0;
    let mut profiles = Vec::with_capacity(TIMES);
    for k in 0..TIMES {
        let end = MIN_TIME * (1u64 << k) as f64;
        for _ in 0..STEPS {
            diffuse(&mut heights, (end - time) / STEPS as f64);
        }
        time = end;
        let mut profile = [0.0; NODES];
        for (node, height) in profile.iter_mut().enumerate() {
            // Before the center is what lies behind it. The end is smooth.
            let at = if node == 0 { 1 } else { node - 1 };
            let distance = at as f64 / PER_RADIUS as f64;
            *height = heights[at] * (1.0 - step(0.7 * MAX_DISTANCE, MAX_DISTANCE, distance));
        }
        profiles.push(profile);
    }
    profiles.into_boxed_slice()
}

/// The height of a form that has just formed, at a distance in radii: 0 is the ground before.
fn fresh(form: Form, at: f64) -> f64 {
    let (floor, rim, peak) = match form {
        // Rims of simple craters are .036 D high, and their depth is .196 D.
        Form::Simple => (0.08, 0.184, 0.0),
        Form::Narrow => (0.4, 0.3, 0.28),
        Form::Wide => (0.62, 0.34, 0.22),
    };
    if at >= 1.0 {
        // Uplift and ejecta (McGetchin and others 1973).
        return rim / (at * at * at);
    }
    let up = ((at - floor) / (1.0 - floor)).max(0.0);
    let wall = match form {
        Form::Simple => up * up.sqrt(),
        // Slumped blocks, and the scarp below the rim.
        _ => {
            0.2 * up
                + 0.17 * step(0.0, 0.25, up)
                + 0.2 * step(0.36, 0.58, up)
                + 0.43 * step(0.68, 1.0, up * (0.7 + 0.3 * up))
        }
    };
    // Central peaks are steep and narrow.
    let center = (1.0 - at / (0.42 * floor + 0.02)).max(0.0);
    rim - 1.0 + wall + peak * center * (0.4 + 0.6 * center)
}

/// A step of diffusion over a time, in squares of the radius: implicit, so that it is stable, over rings of nodes.
fn diffuse(heights: &mut [f64], time: f64) {
    let width = 1.0 / PER_RADIUS as f64;
    let factor = time / (width * width);
    // Thomas' algorithm. The disc around the center has a quarter of the area of a ring of its own width.
    let count = heights.len();
    let mut above = vec![0.0; count];
    for node in 0..count {
        let (inner, outer) = match node {
            0 => (0.0, 4.0 * factor),
            _ => (factor * (1.0 - 0.5 / node as f64), factor * (1.0 + 0.5 / node as f64)),
        };
        let outer = if node + 1 == count { 0.0 } else { outer };
        let (before, before_height) = match node {
            0 => (0.0, 0.0),
            _ => (above[node - 1], heights[node - 1]),
        };
        let pivot = 1.0 + inner + outer - inner * before;
        above[node] = outer / pivot;
        heights[node] = (heights[node] + inner * before_height) / pivot;
    }
    for node in (0..count - 1).rev() {
        heights[node] += above[node] * heights[node + 1];
    }
}

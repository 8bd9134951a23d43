//! One doline: its outline and its cross-section.

use super::Dolines;
use crate::craters::step;
use crate::random::Random;

/// Maximum change of the radius with the direction.
pub(super) const OUTLINE: f64 = 0.15;

/// Waves of the outline, from two to five around the doline.
const WAVES: usize = 4;

/// Maximum angle between the length of a doline and the joints, in degrees.
const SPREAD: f64 = 25.0;

/// The cross-section of a doline.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    /// A round bottom.
    Bowl,
    /// A straight side down to the middle.
    Funnel,
    /// A level floor of sediment.
    Floor,
}

/// A doline.
#[derive(Debug, Clone)]
pub(super) struct Doline {
    /// Its center, in metres.
    pub(super) center: [f64; 2],
    /// Distance beyond which nothing changes, in metres.
    pub(super) reach: f64,
    /// Depth of the middle below the ground there, in metres.
    depth: f64,
    /// Height of the ground in the middle, in metres.
    ground: f64,
    form: Form,
    /// Unit vector along the length.
    along: [f64; 2],
    /// Half of the length and half of the width, in metres.
    radii: [f64; 2],
    /// Cosines and sines of the waves of the outline, as shares of the radius.
    outline: [[f64; 2]; WAVES],
}

impl Doline {
    /// A doline of the diameter with a hashed form, at a place where the ground has this height.
    pub(super) fn new(law: &Dolines, center: [f64; 2], ground: f64, diameter: f64, cell: f64, bits: u64) -> Doline {
        let mut random = Random::of_state(bits);
        let form = match random.share() {
            share if share < law.funnels => Form::Funnel,
            share if share < law.funnels + law.floors => Form::Floor,
            _ => Form::Bowl,
        };
        let [least, most] = law.depths;
        // Floors of sediment fill the deepest part.
        let filled = if form == Form::Floor { 0.5 } else { 1.0 };
        let share = least + (most - least) * random.share() * filled;
        let [least, most] = law.elongations;
        let stretch = (least + (most - least) * random.share()).sqrt();
        let turn = (law.direction + SPREAD * (random.share() + random.share() - 1.0)).to_radians();
        let mut outline = [[0.0; 2]; WAVES];
        for (k, wave) in outline.iter_mut().enumerate() {
            *wave = [(); 2].map(|()| (2.0 * random.share() - 1.0) * OUTLINE / (k as f64 + 2.0));
        }
        let radii = [0.5 * diameter * stretch, 0.5 * diameter / stretch];
        Doline {
            center,
            reach: radii[0] * (1.0 + OUTLINE),
            // Those that few samples show fade out.
            depth: share * diameter * step(1.0, 2.0, diameter / cell),
            ground,
            form,
            along: [libm::sin(turn), -libm::cos(turn)],
            radii,
            outline,
        }
    }

    /// Depth below the ground, in metres, at metres east and south of the center where the ground has a height.
    pub(super) fn depth(&self, [east, south]: [f64; 2], height: f64) -> f64 {
        let [x, y] = self.along;
        let [u, v] = [(east * x + south * y) / self.radii[0], (south * x - east * y) / self.radii[1]];
        let distance = (u * u + v * v).sqrt();
        if distance >= 1.0 + OUTLINE {
            return 0.0;
        }
        let at = distance / (1.0 + self.outline(u, v, distance));
        if at >= 1.0 {
            return 0.0;
        }
        match self.form {
            Form::Bowl => {
                let left = 1.0 - at * at;
                self.depth * left * left.sqrt()
            }
            // The rim is rounded over the outer quarter.
            Form::Funnel if at < 0.75 => self.depth * (0.875 - at) / 0.875,
            Form::Funnel => self.depth * (1.0 - at) * (1.0 - at) * 2.0 / 0.875,
            Form::Floor => {
                let level = 1.0 - step(0.4, 0.75, at);
                let depth = self.depth * (1.0 - step(0.45, 1.0, at)) + (height - self.ground) * level;
                depth.max(0.0)
            }
        }
    }

    /// The change of the radius in a direction, as a share.
    fn outline(&self, u: f64, v: f64, distance: f64) -> f64 {
        let [x, y] = if distance > 0.0 { [u / distance, v / distance] } else { [1.0, 0.0] };
        let (mut cosine, mut sine) = (x, y);
        let mut change = 0.0;
        for wave in &self.outline {
            (cosine, sine) = (cosine * x - sine * y, sine * x + cosine * y);
            change += wave[0] * cosine + wave[1] * sine;
        }
        change.clamp(-OUTLINE, OUTLINE)
    }
}

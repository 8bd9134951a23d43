//! One crater: its size and shape, and what it makes of a position.

use super::profiles::{Form, MAX_DISTANCE, MAX_TIME, MIN_TIME, Row};
use super::{Craters, step};
use crate::random::Random;
use std::cmp::Ordering;

/// Reach of a crater over its radius: that of the profile, in the direction in which it is widest.
pub(super) const REACH: f64 = MAX_DISTANCE * (1.0 + OUTLINE);

/// Maximum change of the radius with the direction.
const OUTLINE: f64 = 0.1;

/// The diffusivity that ages a crater grows with this power of its diameter, because larger impacts wear larger craters
/// (Fassett and others 2022).
const DIFFUSIVITY: f64 = 0.9;

/// Waves of the outline, from two to nine around the crater.
const WAVES: usize = 8;

/// An impact crater.
#[derive(Debug, Clone)]
pub(super) struct Crater {
    /// Its center, in metres.
    pub(super) center: [f64; 2],
    pub(super) diameter: f64,
    /// Distance beyond which nothing changes, in metres.
    pub(super) reach: f64,
    /// Age over that of the surface, 0 to 1.
    age: f64,
    bits: u64,
    /// Cosines and sines of the waves of the outline, as shares of the radius.
    outline: [[f64; 2]; WAVES],
    /// Cosines and sines of the waves of terraces and ejecta.
    texture: [[f64; 2]; WAVES],
    /// Heights of the forms over their unit, in metres, with their profiles at the age.
    forms: [(f64, Row); 2],
    /// Mean heights of older craters under this one, by their indices.
    pub(super) levels: Vec<(usize, f64)>,
}

/// What a crater makes of a position.
pub(super) struct Shape {
    /// Height in metres.
    pub(super) height: f64,
    /// Share of the bowl: 1 inside, 0 outside of the rim.
    pub(super) bowl: f64,
    /// Brightness of young ejecta.
    pub(super) brightness: f64,
    /// Thickness of the ejecta in metres.
    ejecta: f64,
}

impl Crater {
    /// A crater of the diameter, with hashed age and outline; `None` if nothing is left of it.
    pub(super) fn new(law: &Craters, center: [f64; 2], diameter: f64, bits: u64) -> Option<Crater> {
        let mut random = Random::of_state(bits);
        let age = random.share();
        let radius = 0.5 * diameter;
        let diffusion = law.diffusion * age * libm::pow(diameter / 1000.0, DIFFUSIVITY);
        let time = (diffusion / (radius * radius)).max(MIN_TIME);
        if time >= MAX_TIME {
            return None;
        }
        // Nothing ends at once.
        let left = 1.0 - step(0.5 * MAX_TIME, MAX_TIME, time);
        let size = diameter / law.transition;
        let complex = step(0.8, 1.5, size);
        // Depths of simple craters .196 D, of complex ones 1.044 D^.301 km, which is .157 of the transition's at it
        // (Pike 1977).
        let simple_depth = 0.196 * diameter;
        let complex_depth = 0.157 * law.transition * libm::pow(size, 0.301);
        let wide = step(1.0, 10.0, size);
        let (forms, shares) = match complex {
            // Floors of complex craters grow from .4 to .62 of the diameter.
            complex if complex >= 1.0 => {
                ([Form::Narrow, Form::Wide], [1.0 - wide, wide].map(|share| share * complex_depth))
            }
            complex => ([Form::Simple, Form::Narrow], [(1.0 - complex) * simple_depth, complex * complex_depth]),
        };
        let mut wave = |strength: f64| {
            let mut waves = [[0.0; 2]; WAVES];
            for (k, wave) in waves.iter_mut().enumerate() {
                *wave = [(); 2].map(|()| (2.0 * random.share() - 1.0) * strength / (k as f64 + 2.0));
            }
            waves
        };
        let outline = wave(0.05 + 0.03 * complex);
        let texture = wave(1.0);
        let unit = [0, 1].map(|k| (shares[k] * left, Row::new(forms[k], time)));
        Some(Crater {
            center,
            diameter,
            reach: REACH * radius,
            age,
            bits,
            outline,
            texture,
            forms: unit,
            levels: Vec::new(),
        })
    }

    /// Older craters first; of two with one age, an arbitrary one.
    pub(super) fn by_age(&self, other: &Crater) -> Ordering {
        let place = |crater: &Crater| crater.center.map(f64::to_bits);
        other.age.total_cmp(&self.age).then(self.bits.cmp(&other.bits)).then(place(self).cmp(&place(other)))
    }

    /// The shape at metres east and south of the center, and at their distance.
    pub(super) fn shape(&self, [east, south]: [f64; 2], distance: f64) -> Shape {
        let [x, y] = if distance > 0.0 { [east / distance, south / distance] } else { [1.0, 0.0] };
        let (mut cosine, mut sine) = (x, y);
        let (mut outline, mut texture) = (0.0, 0.0);
        for (shape, detail) in self.outline.iter().zip(&self.texture) {
            (cosine, sine) = (cosine * x - sine * y, sine * x + cosine * y);
            outline += shape[0] * cosine + shape[1] * sine;
            texture += detail[0] * cosine + detail[1] * sine;
        }
        let radius = 0.5 * self.diameter * (1.0 + outline.clamp(-OUTLINE, OUTLINE));
        let at = distance / radius;
        // Terraces are not concentric: walls are shifted most at two thirds of the radius.
        let shift = (6.75 * at * at * (1.0 - at)).max(0.0);
        let inside = at + 0.06 * texture.clamp(-1.0, 1.0) * shift;
        let height = self.forms.iter().fold(0.0, |sum, (height, row)| sum + height * row.at(inside));
        // Thickness of .02 D at the rim, falling with the cube of the distance (McGetchin and others 1973).
        let blanket = 1.0 - step(1.5, MAX_DISTANCE, at);
        let cube = 1.0 / (at * at * at).max(1.0);
        let rays = (1.0 + texture).clamp(0.0, 2.0);
        let ejecta = 0.02 * self.diameter * cube * blanket * rays;
        let young = (1.0 - 5.0 * self.age).max(0.0);
        let light = if at < 1.0 { 1.0 } else { (1.0 / at) * blanket * (0.4 + 0.6 * rays) };
        Shape { height, bowl: 1.0 - step(0.85, 1.3, at), brightness: (young * young * light).min(1.0), ejecta }
    }
}

/// Finds the levels of craters that are sorted by age: what a crater replaces becomes as high as the relief was around
/// its center, so that a crater in another one lies on its floor.
pub(super) fn find_levels(craters: &mut [Crater]) {
    for newer in 1..craters.len() {
        let (before, after) = craters.split_at_mut(newer);
        let Some(crater) = after.first_mut() else { continue };
        for (index, older) in before.iter().enumerate() {
            let from = [0, 1].map(|axis| crater.center[axis] - older.center[axis]);
            let square = from[0] * from[0] + from[1] * from[1];
            if crater.diameter > NOT_REPLACED * older.diameter && square < older.reach * older.reach {
                let at = 2.0 * square.sqrt() / older.diameter;
                let height = older.forms.iter().fold(0.0, |sum, (height, row)| sum + height * row.at(at));
                // The mean over the crater: little of a much smaller one.
                let share = (older.diameter / crater.diameter).min(1.0);
                crater.levels.push((index, height * share * share));
            }
        }
    }
}

/// Diameter over that of an older crater up to which its relief stays.
const NOT_REPLACED: f64 = 0.3;

impl Shape {
    /// Share of the relief of an older crater that this one replaces in its bowl, if that is not much larger.
    pub(super) fn replaced(&self, diameter: f64, older: f64) -> f64 {
        if self.bowl > 0.0 { self.bowl * step(NOT_REPLACED, 1.0, diameter / older) } else { 0.0 }
    }

    /// Share of the relief of an older crater that the ejecta bury, if it is shallower than these.
    pub(super) fn buried(&self, diameter: f64, older: f64) -> f64 {
        let buried = |thickness: f64| thickness / (thickness + 0.04 * older);
        if older < diameter { buried(self.ejecta) * step(0.0, 0.5, 1.0 - older / diameter) } else { 0.0 }
    }
}

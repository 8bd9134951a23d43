//! Color ramps while they are edited.

use orogen::io::palette::color::Encoder;
use orogen::io::palette::fitted::Fitted;
use orogen::io::palette::palette::Position;
use orogen::io::palette::{Palette, Rgb, Stop};

/// A color ramp whose positions are all of the same kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Ramp {
    palette: Palette,
}

/// Minimum number of colors of a ramp.
const FEWEST: usize = 2;

impl Ramp {
    /// The ramp of a palette; `None` if it has less than two colors, or positions of several kinds.
    #[must_use]
    pub fn of(palette: &Palette) -> Option<Ramp> {
        let kind = |stop: &Stop| std::mem::discriminant(&stop.at);
        let first = palette.stops.first()?;
        let is_one_kind = palette.stops.iter().all(|stop| kind(stop) == kind(first));
        let is_ordered = palette.stops.is_sorted_by(|a, b| number(a.at) <= number(b.at));
        let is_ramp = is_one_kind && is_ordered && palette.stops.len() >= FEWEST;
        let mut palette = palette.clone();
        // An edited ramp is used as shown, whatever the relief.
        palette.follows_relief = false;
        is_ramp.then_some(Ramp { palette })
    }

    /// The palette.
    #[must_use]
    pub fn palette(&self) -> &Palette {
        &self.palette
    }

    /// Sets the name.
    pub fn rename(&mut self, name: &str) {
        name.clone_into(&mut self.palette.name);
    }

    /// Whether the positions are values, in metres or in the unit of the layer.
    #[must_use]
    pub fn has_values(&self) -> bool {
        self.palette.stops.iter().any(|stop| matches!(stop.at, Position::Value(_)))
    }

    /// The colors and their positions.
    #[must_use]
    pub fn stops(&self) -> Vec<(f64, Rgb)> {
        self.palette.stops.iter().map(|stop| (number(stop.at), stop.color)).collect()
    }

    /// The positions of the first and the last color.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        let at = |stop: Option<&Stop>| stop.map_or(0.0, |stop| number(stop.at));
        [at(self.palette.stops.first()), at(self.palette.stops.last())]
    }

    /// Evenly spaced colors from the first to the last one.
    #[must_use]
    pub fn colors(&self, count: usize) -> Vec<Rgb> {
        let [low, high] = self.ends();
        // Positions that are shares refer to a range from 0 to 1, with the sea at 0.
        let sea = 0.0;
        let fitted = Fitted::new(&self.palette, low as f32, high as f32, sea);
        let encoder = Encoder::new();
        let at = |k: usize| low + (high - low) * k as f64 / (count.max(2) - 1) as f64;
        (0..count).map(|k| encoder.bytes(fitted.at(at(k) as f32))).collect()
    }

    /// Sets a color.
    pub fn set_color(&mut self, k: usize, color: Rgb) {
        if let Some(stop) = self.palette.stops.get_mut(k) {
            stop.color = color;
        }
    }

    /// Sets a position, limited to between its neighbors. The ends of ramps whose positions are not values are not
    /// moved.
    pub fn set_position(&mut self, k: usize, at: f64) {
        let neighbor = |k: Option<usize>| k.and_then(|k| self.palette.stops.get(k)).map(|stop| number(stop.at));
        let (low, high) = (neighbor(k.checked_sub(1)), neighbor(Some(k + 1)));
        let is_fixed = !self.has_values() && (low.is_none() || high.is_none());
        let at = at.max(low.unwrap_or(f64::NEG_INFINITY)).min(high.unwrap_or(f64::INFINITY));
        if let Some(stop) = self.palette.stops.get_mut(k)
            && !is_fixed
            && at.is_finite()
        {
            stop.at = with_number(stop.at, at);
        }
    }

    /// Adds a color at a position within the ramp, with the color that the ramp has there. Returns its index.
    pub fn add(&mut self, at: f64) -> Option<usize> {
        let [low, high] = self.ends();
        let place = (at - low) / (high - low);
        if !(0.0..=1.0).contains(&place) {
            return None;
        }
        let colors = self.colors(STEPS);
        let color = *colors.get((place * (STEPS - 1) as f64 + 0.5) as usize)?;
        let k =
            self.palette.stops.partition_point(|stop| number(stop.at) <= at).max(1).min(self.palette.stops.len() - 1);
        let kind = self.palette.stops.first()?.at;
        self.palette.stops.insert(k, Stop { at: with_number(kind, at), color });
        Some(k)
    }

    /// Removes a color. The first and the last color cannot be removed.
    pub fn remove(&mut self, k: usize) {
        if k > 0 && k + 1 < self.palette.stops.len() && self.palette.stops.len() > FEWEST {
            self.palette.stops.remove(k);
        }
    }

    /// Reverses the order of the colors.
    pub fn reverse(&mut self) {
        let colors: Vec<Rgb> = self.palette.stops.iter().rev().map(|stop| stop.color).collect();
        self.palette.stops.iter_mut().zip(colors).for_each(|(stop, color)| stop.color = color);
    }
}

/// Number of colors among which the color of a new stop is looked up.
const STEPS: usize = 1024;

/// The number in a position.
fn number(at: Position) -> f64 {
    match at {
        Position::Value(at) | Position::Share(at) | Position::Sea(at) => at,
        // Kinds that may be added later are rejected when a ramp is made.
        _ => f64::NAN,
    }
}

/// A position of the same kind.
fn with_number(at: Position, number: f64) -> Position {
    match at {
        Position::Value(_) => Position::Value(number),
        Position::Share(_) => Position::Share(number),
        Position::Sea(_) => Position::Sea(number),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::io::palette::{named, own};

    #[test]
    fn ramps_are_edited_and_written() {
        for named in named::all() {
            let mut ramp = Ramp::of(&named.palette()).unwrap();
            let (before, [low, high]) = (ramp.stops(), ramp.ends());
            let middle = low + 0.37 * (high - low);
            let k = ramp.add(middle).unwrap();
            assert_eq!(ramp.stops().len(), before.len() + 1);
            assert_eq!(ramp.stops()[k].0, middle);
            ramp.set_color(k, [1, 2, 3]);
            ramp.set_position(k, high + 1.0);
            assert_eq!(ramp.stops()[k], (ramp.stops()[k + 1].0, [1, 2, 3]), "it stays before its neighbor");
            ramp.set_position(k, middle);
            assert_eq!(own::parse("", &own::write(ramp.palette()).unwrap()).unwrap(), *ramp.palette());
            ramp.remove(k);
            assert_eq!(ramp.stops(), before, "{}", named.name);
            ramp.remove(0);
            ramp.set_position(usize::MAX - 1, 0.0);
            assert_eq!((ramp.stops(), ramp.add(high + 1.0)), (before.clone(), None));
            ramp.reverse();
            assert_eq!(ramp.stops()[0].1, before[before.len() - 1].1);
        }
    }

    #[test]
    fn the_colors_of_a_ramp_are_those_of_its_ends() {
        let ramp = Ramp::of(&named::find("viridis").unwrap().palette()).unwrap();
        let (colors, stops) = (ramp.colors(9), ramp.stops());
        assert_eq!([colors[0], colors[8]], [stops[0].1, stops[stops.len() - 1].1]);
        assert!(Ramp::of(&Palette::new("one", ramp.palette().stops[..1].to_vec())).is_none());
    }
}

//! A palette applied to heights.

use super::color::{Light, Rgb, decode, linear, mix, oklab};
use super::palette::{Mix, NO_DATA, Palette, Position};
use serde::{Deserialize, Serialize};

/// Number of table entries for the narrowest interval between two stops, and minimum and maximum size of a table.
const PER_STRETCH: f64 = 48.0;
const ENTRIES: [f64; 2] = [256.0, 16_384.0];

/// A palette fitted to a range of heights, prepared for lookup.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Fitted {
    /// Pieces without a hard step inside, in ascending order. Each begins at its own height.
    pieces: Vec<Segment>,
    missing: Light,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Segment {
    /// The lowest height of the piece.
    from: f32,
    start: f64,
    per_metre: f64,
    table: Vec<Light>,
}

impl Segment {
    fn at(&self, height: f32) -> Light {
        let last = self.table.len() - 1;
        let at = ((f64::from(height) - self.start) * self.per_metre).clamp(0.0, last as f64);
        let index = (at as usize).min(last.saturating_sub(1));
        mix(self.table[index], self.table[(index + 1).min(last)], (at - index as f64) as f32)
    }
}

impl Fitted {
    /// A palette fitted to heights from `low` to `high` with the sea at `sea_level`, in metres.
    pub fn new(palette: &Palette, low: f32, high: f32, sea_level: f32) -> Fitted {
        let [low, high, sea] = [low, high, sea_level].map(f64::from);
        let low = if low.is_finite() { low } else { 0.0 };
        let high = if high > low { high } else { low + 1.0 };
        // Land above the sea starts at its lowest height. A world without land ends at the surface of the sea.
        let shore = if sea.is_finite() { sea.max(low) } else { low };
        let [depth, relief] = [if sea > low { sea - low } else { 1.0 }, if high > shore { high - shore } else { 1.0 }];
        let resolved = |at: Position| match at {
            Position::Value(value) => value,
            Position::Share(share) => low + share * (high - low),
            Position::Sea(share) if share < 0.0 => shore + share * depth,
            Position::Sea(share) => shore + share * relief,
        };
        let mut stops: Vec<(f64, Rgb)> = palette.stops.iter().map(|stop| (resolved(stop.at), stop.color)).collect();
        stops.retain(|(at, _)| at.is_finite());
        // A file may mix kinds of positions. The sort is stable for equal positions.
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        if palette.mix == Mix::Nearest {
            stops = stepped(&stops);
        }
        let missing = palette.missing.unwrap_or(NO_DATA).map(decode);
        let mut pieces: Vec<Segment> = Vec::new();
        if let Some(below) = palette.below {
            pieces.push(flat(f32::NEG_INFINITY, below));
        }
        let of_sea = |at: f64| palette.has_sea() && at == shore && sea >= low;
        let mut start = 0;
        while start < stops.len() {
            // A piece continues while its stops have different positions and its table can resolve them.
            let (mut end, mut narrowest) = (start, f64::MAX);
            let mut crowded = false;
            while end + 1 < stops.len() && stops[end + 1].0 > stops[end].0 && !crowded {
                narrowest = narrowest.min(stops[end + 1].0 - stops[end].0);
                crowded = end > start && entries(stops[end + 1].0 - stops[start].0, narrowest) > ENTRIES[1];
                end += usize::from(!crowded);
            }
            let at = stops[start].0;
            let from = match (pieces.is_empty(), of_sea(at)) {
                (true, _) => f32::NEG_INFINITY,
                // Heights exactly at sea level are sea.
                (false, true) => reached(at).max((at as f32).next_up()),
                (false, false) => reached(at),
            };
            pieces.push(piece(from, &stops[start..=end], palette.mix));
            start = if crowded { end } else { end + 1 };
        }
        if let (Some(last), Some(above)) = (stops.last(), palette.above) {
            pieces.push(flat((last.0 as f32).next_up(), above));
        }
        if pieces.is_empty() {
            pieces.push(flat(f32::NEG_INFINITY, palette.missing.unwrap_or(NO_DATA)));
        }
        Fitted { pieces, missing }
    }

    /// The color of a height; the palette's color of missing samples if it is not finite.
    #[must_use]
    pub fn at(&self, height: f32) -> Light {
        if !height.is_finite() {
            return self.missing;
        }
        let piece = self.pieces.partition_point(|piece| piece.from <= height).saturating_sub(1);
        self.pieces.get(piece).map_or(self.missing, |piece| piece.at(height))
    }
}

/// Stops with a hard step halfway between any two.
fn stepped(stops: &[(f64, Rgb)]) -> Vec<(f64, Rgb)> {
    let mut steps: Vec<(f64, Rgb)> = stops.first().copied().into_iter().collect();
    for pair in stops.windows(2) {
        let ((start, from), (end, to)) = (pair[0], pair[1]);
        let middle = start + (end - start) / 2.0;
        steps.extend([(middle, from), (middle, to), (end, to)]);
    }
    steps
}

/// The smallest f32 that is at least `height`.
fn reached(height: f64) -> f32 {
    let near = height as f32;
    if f64::from(near) >= height { near } else { near.next_up() }
}

fn flat(from: f32, color: Rgb) -> Segment {
    Segment { from, start: 0.0, per_metre: 0.0, table: vec![color.map(decode)] }
}

/// Number of entries of a table over `length` metres.
fn entries(length: f64, narrowest: f64) -> f64 {
    (length / narrowest * PER_STRETCH).ceil()
}

fn piece(from: f32, stops: &[(f64, Rgb)], mix: Mix) -> Segment {
    let ([first, .., last], true) = (stops, stops.len() > 1) else {
        return flat(from, stops.first().map_or([0; 3], |stop| stop.1));
    };
    let narrowest = stops.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(f64::MAX, f64::min);
    let length = last.0 - first.0;
    let entries = entries(length, narrowest).clamp(ENTRIES[0], ENTRIES[1]);
    let mut at = 0;
    let table = (0..=entries as usize).map(|k| {
        let height = first.0 + length * k as f64 / entries;
        while at + 2 < stops.len() && stops[at + 1].0 <= height {
            at += 1;
        }
        let ((start, from), (end, to)) = (stops[at], stops[at + 1]);
        mixed(from, to, ((height - start) / (end - start)).clamp(0.0, 1.0) as f32, mix)
    });
    Segment { from, start: first.0, per_metre: (entries / length).min(1e30), table: table.collect() }
}

/// The mixture of two colors.
fn mixed(from: Rgb, to: Rgb, share: f32, how: Mix) -> Light {
    match how {
        Mix::Oklab => linear(mix(oklab(from.map(decode)), oklab(to.map(decode)), share)),
        Mix::Rgb => mix(from.map(f32::from), to.map(f32::from), share).map(light),
        Mix::Nearest => if share < 0.5 { from } else { to }.map(decode),
        Mix::Hsv => {
            let ([h0, s0, v0], [mut h1, s1, v1]) = (hsv(from), hsv(to));
            let h0 = if s0 == 0.0 { h1 } else { h0 };
            if s1 == 0.0 {
                h1 = h0;
            }
            let turn = (h1 - h0 + 540.0).rem_euclid(360.0) - 180.0;
            of_hsv([(h0 + turn * share).rem_euclid(360.0), s0 + (s1 - s0) * share, v0 + (v1 - v0) * share])
                .map(|c| light(255.0 * c))
        }
    }
}

/// Linear light of an sRGB value from 0 to 255.
fn light(byte: f32) -> f32 {
    let c = byte.clamp(0.0, 255.0) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { libm::powf((c + 0.055) / 1.055, 2.4) }
}

/// Hue in degrees, saturation and value from 0 to 1. The hue of a gray is 0.
#[must_use]
pub fn hsv(color: Rgb) -> [f32; 3] {
    let [r, g, b] = color.map(|byte| f32::from(byte) / 255.0);
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let chroma = most - least;
    let sixth = if chroma == 0.0 {
        0.0
    } else if most == r {
        ((g - b) / chroma).rem_euclid(6.0)
    } else if most == g {
        (b - r) / chroma + 2.0
    } else {
        (r - g) / chroma + 4.0
    };
    [60.0 * sixth, if most > 0.0 { chroma / most } else { 0.0 }, most]
}

/// Red, green and blue, 0 to 1, from hue (degrees), saturation and value.
#[must_use]
pub fn of_hsv([hue, saturation, value]: [f32; 3]) -> [f32; 3] {
    let part = |n: f32| {
        let k = (n + hue / 60.0).rem_euclid(6.0);
        value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    };
    [part(5.0), part(3.0), part(1.0)]
}

#[cfg(test)]
mod tests {
    use super::super::color::Encoder;
    use super::super::palette::Stop;
    use super::*;

    fn bytes(palette: &Palette, range: [f32; 3], heights: &[f32]) -> Vec<Rgb> {
        let fitted = Fitted::new(palette, range[0], range[1], range[2]);
        let encoder = Encoder::new();
        heights.iter().map(|height| encoder.bytes(fitted.at(*height))).collect()
    }

    fn palette(stops: &[(Position, Rgb)]) -> Palette {
        Palette::new("test", stops.iter().map(|&(at, color)| Stop { at, color }).collect())
    }

    const RED: Rgb = [255, 0, 0];
    const BLUE: Rgb = [0, 0, 255];
    const LIME: Rgb = [0, 255, 0];
    const WHITE: Rgb = [255; 3];

    #[test]
    fn the_nearest_stop_has_the_color() {
        let stop = |at, color| Stop { at: Position::Value(at), color };
        let stops = vec![stop(0.0, [10, 20, 30]), stop(100.0, [200, 0, 0]), stop(110.0, [0, 7, 0])];
        let fitted = Fitted::new(&Palette::new("t", stops).nearest(), -500.0, 900.0, 0.0);
        let encoder = Encoder::new();
        for (height, expect) in [
            (-300.0, [10, 20, 30]),
            (49.9, [10, 20, 30]),
            (50.0, [200, 0, 0]),
            (104.9, [200, 0, 0]),
            (105.1, [0, 7, 0]),
            (800.0, [0, 7, 0]),
        ] {
            assert_eq!(encoder.bytes(fitted.at(height)), expect, "{height}");
        }
    }

    #[test]
    fn stops_are_met_and_steps_are_hard() {
        use Position::{Sea, Share, Value};
        let steps = palette(&[(Share(0.0), BLUE), (Share(0.3), BLUE), (Share(0.3), LIME), (Share(1.0), WHITE)]);
        let at = [0.0, 29.9, 30.0f32.next_down(), 30.0, 100.0, -5.0, 1e9];
        assert_eq!(bytes(&steps, [0.0, 100.0, 0.0], &at), [BLUE, BLUE, BLUE, LIME, WHITE, BLUE, WHITE]);
        let shore = palette(&[(Sea(-1.0), BLUE), (Sea(0.0), RED), (Sea(0.0), LIME), (Sea(1.0), WHITE)]);
        for sea in [0.0f32, 12.5, -400.0] {
            let at = [sea - 300.0, sea, sea.next_up(), sea + 800.0];
            assert_eq!(bytes(&shore, [sea - 300.0, sea + 800.0, sea], &at), [BLUE, RED, LIME, WHITE]);
        }
        // A plateau far above the sea starts with the first land color. A map with only sea ends at its surface.
        assert_eq!(bytes(&shore, [500.0, 900.0, 0.0], &[500.5, 900.0])[1], WHITE);
        assert_eq!(bytes(&shore, [500.0, 900.0, 0.0], &[500.0])[0], LIME);
        assert_eq!(bytes(&shore, [-500.0, -90.0, 0.0], &[-500.0, 0.0]), [BLUE, RED]);
        let metres = palette(&[(Value(-10.0), BLUE), (Value(10.0), RED)]);
        assert_eq!(bytes(&metres, [0.0, 1.0, 0.0], &[-10.0, 10.0, 90.0, -90.0]), [BLUE, RED, RED, BLUE]);
    }

    #[test]
    fn what_lies_outside_has_the_colors_named() {
        let mut ends = palette(&[(Position::Value(0.0), BLUE), (Position::Value(1.0), RED)]);
        (ends.below, ends.above, ends.missing) = (Some(LIME), Some(WHITE), Some([1, 2, 3]));
        let at = [-1.0, 0.0, 1.0, 1.5, f32::NAN];
        assert_eq!(bytes(&ends, [0.0, 9.0, 0.0], &at), [LIME, BLUE, RED, WHITE, [1, 2, 3]]);
    }

    /// Values halfway between two bytes may be rounded either way.
    fn near(a: Rgb, b: Rgb) -> bool {
        a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 1)
    }

    #[test]
    fn three_ways_to_mix() {
        let mut between = palette(&[(Position::Share(0.0), RED), (Position::Share(1.0), [255, 255, 0])]);
        let middle = |palette: &Palette| bytes(palette, [0.0, 1.0, 0.0], &[0.5])[0];
        between.mix = Mix::Rgb;
        assert!(near(middle(&between), [255, 128, 0]));
        between.mix = Mix::Hsv;
        assert!(near(middle(&between), [255, 128, 0]));
        between.stops[0].color = LIME;
        between.stops[1].color = BLUE;
        assert!(near(middle(&between), [0, 255, 255]));
        between.mix = Mix::Rgb;
        assert!(near(middle(&between), [0, 128, 128]));
        between.mix = Mix::Oklab;
        let [r, g, b] = middle(&between);
        assert!(g > 150 && b > 150 && r < 140, "{r} {g} {b}");
        for color in [RED, [12, 200, 37], [9, 9, 9], [0, 0, 0], [77, 3, 199]] {
            let back = of_hsv(hsv(color)).map(|c| (c * 255.0).round() as u8);
            assert_eq!(back, color);
        }
    }

    #[test]
    fn narrow_stretches_in_a_wide_palette_keep_their_colors() {
        let value = Position::Value;
        let wide = palette(&[(value(-11e3), BLUE), (value(0.0), WHITE), (value(1.0), RED), (value(9e3), LIME)]);
        assert_eq!(bytes(&wide, [0.0, 1.0, 0.0], &[-11e3, 0.0, 1.0, 9e3]), [BLUE, WHITE, RED, LIME]);
        let shore = bytes(&wide, [0.0, 1.0, 0.0], &[-10.0])[0];
        assert!(near(shore, WHITE), "{shore:?}");
    }

    #[test]
    fn senseless_ranges_and_empty_palettes_still_have_colors() {
        let some = palette(&[(Position::Sea(-1.0), BLUE), (Position::Share(0.5), RED), (Position::Value(9.0), LIME)]);
        for palette in &[some, Palette::default()] {
            for range in [[5.0, 5.0, 0.0], [f32::NAN; 3], [1.0, -1.0, 0.0], [f32::MIN, f32::MAX, f32::INFINITY]] {
                let fitted = Fitted::new(palette, range[0], range[1], range[2]);
                for height in [f32::MIN, -1.0, 0.0, 1.0, f32::MAX, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                    assert!(fitted.at(height).iter().all(|c| c.is_finite()), "{range:?} {height}");
                }
            }
        }
    }
}

//! Colors of a layer other than height: along a linear or a logarithmic ramp, or one color per number.

use orogen_grid::parallel;
use orogen_noise::Points;

use super::furniture::{Align, Desk, SMALL};
use super::geometry::{Point, Rect};
use super::ground::at_pixels;
use super::options::{Layer, Scale};
use super::scene::{Item, line};
use super::ticks::{Count, grouped, step, ticks};
use crate::map::text::Face;
use orogen_engine::layer::LayerKind;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Grid;
use orogen_grid::resample;
use orogen_grid::words::number;
use orogen_io::format::levels::Levels;
use orogen_io::palette::color::{Encoder, Light, decode};
use orogen_io::palette::fitted::{Fitted, of_hsv};
use orogen_io::palette::palette::{Palette, Position};

/// Maximum number of decades of a logarithmic ramp; smaller values have the color of its lower end.
const MAX_DECADES: f64 = 8.0;

/// A mapping from the samples of a layer to colors.
pub struct Ramp {
    fitted: Fitted,
    scale: Scale,
    /// The values at its ends.
    ends: [f64; 2],
    name: String,
    unit: &'static str,
    /// Divisor of values in labels.
    divide: f64,
}

impl Ramp {
    /// The colors of `palette` over the samples of a layer, or over its given range.
    ///
    /// # Errors
    /// If the palette is the atlas tint, or a logarithmic ramp has no positive value.
    pub fn new(layer: &Layer, palette: &Palette) -> Result<Ramp> {
        let fault = |message: String| Err(Error::new(ErrorKind::Request, message));
        let name = &layer.name;
        if palette.follows_relief {
            return fault(format!(
                "the palette {} applies to heights only; choose another for `{name}`, such as viridis",
                palette.name
            ));
        }
        let values = || layer.values.data().iter().copied().filter(|value| value.is_finite());
        let levels = Levels::of(&layer.values);
        let mut ends = layer.range.unwrap_or([levels.low(), levels.high()]).map(f64::from);
        if layer.scale == Scale::Log {
            let lowest = values().filter(|value| *value > 0.0).fold(f32::INFINITY, f32::min);
            if layer.range.is_none() {
                ends[0] = f64::from(lowest).max(ends[1] / libm::pow(10.0, MAX_DECADES));
            }
            if !(ends[0] > 0.0 && ends[1] >= ends[0]) {
                return fault(format!(
                    "a logarithmic ramp needs values above 0, and `{name}` ranges from {} to {}",
                    number(ends[0]),
                    number(ends[1])
                ));
            }
        }
        let mut palette = palette.clone();
        if layer.scale == Scale::Log {
            // Colors at values stay there; shares refer to the decades.
            palette.stops.retain(|stop| !matches!(stop.at, Position::Value(value) if value <= 0.0));
            for stop in &mut palette.stops {
                if let Position::Value(value) = stop.at {
                    stop.at = Position::Value(libm::log10(value));
                }
            }
        }
        let [low, high] = ends.map(|end| if layer.scale == Scale::Log { libm::log10(end) } else { end });
        let (unit, divide) = match (layer.unit, ends[1]) {
            ("m^2", high) if high >= 1e6 => ("km\u{b2}", 1e6),
            ("m^2", _) => ("m\u{b2}", 1.0),
            ("deg", _) => ("\u{b0}", 1.0),
            (unit, _) => (unit, 1.0),
        };
        let fitted = Fitted::new(&palette, low as f32, high as f32, f32::NEG_INFINITY);
        Ok(Ramp { fitted, scale: layer.scale, ends, name: name.clone(), unit, divide })
    }

    /// The color of a value; if it is not finite, the palette's color of missing samples.
    pub fn at(&self, value: f32) -> Light {
        match self.scale {
            _ if !value.is_finite() => self.fitted.at(value),
            Scale::Linear => self.fitted.at(value),
            Scale::Log => self.fitted.at(libm::log10(f64::from(value).max(self.ends[0])) as f32),
            Scale::Labels => label(value),
        }
    }

    /// Values at equal distances along the ramp, from its lower to its upper end.
    pub fn values(&self, intervals: usize) -> Vec<f32> {
        let is_log = self.scale == Scale::Log;
        let [low, high] = self.ends.map(|end| if is_log { libm::log10(end) } else { end });
        let at = |k: usize| low + (high - low) * k as f64 / intervals as f64;
        let inner = (1..intervals).map(|k| if is_log { libm::pow(10.0, at(k)) } else { at(k) });
        std::iter::once(self.ends[0]).chain(inner).chain([self.ends[1]]).map(|value| value as f32).collect()
    }

    /// The values at pixel centers: means of numbers, or the nearest label.
    pub fn at_pixels(&self, values: &Grid, pixels: [usize; 2]) -> Grid {
        let mut out = at_pixels(values, pixels);
        if self.scale != Scale::Labels {
            return out;
        }
        let window = values.window();
        let own =
            Grid::from_data(orogen_grid::grid::Window::new(window.width, window.height, 1.0), values.data().to_vec());
        let at = |count: usize, samples: usize| {
            (0..count).map(|k| ((k as f64 + 0.5) * (samples - 1) as f64 / count as f64).round()).collect::<Vec<f64>>()
        };
        let (xs, ys) = (at(pixels[0], window.width), at(pixels[1], window.height));
        if let Some(own) = own {
            parallel::for_each(out.data_mut().chunks_mut(pixels[0]).zip(&ys), |(row, y)| {
                resample::read(&own, LayerKind::Label, &Points::Lattice { xs: &xs, ys: &[*y] }, row);
            });
        }
        out
    }

    /// A description of its range.
    pub fn words(&self) -> String {
        // Three digits suffice for a map.
        let short = |value: f64| number(format!("{value:.2e}").parse().unwrap_or(value));
        let [low, high] =
            self.ends.map(|end| if self.scale == Scale::Labels { number(end) } else { short(end / self.divide) });
        match self.scale {
            Scale::Labels => format!("{}, numbered {low} to {high}", self.name),
            _ => format!("{} {low} to {high} {}", self.name, self.unit).trim_end().to_string(),
        }
    }

    /// Round values along the ramp, each with its label and its position, 0 to 1.
    fn marks(&self) -> Vec<(f64, String)> {
        let [low, high] = self.ends.map(|end| end / self.divide);
        if self.scale != Scale::Log || high / low < 20.0 {
            let share = |value: f64| match self.scale {
                Scale::Log if high > low => libm::log10(value / low) / libm::log10(high / low),
                _ if high > low => (value - low) / (high - low),
                _ => 0.5,
            };
            let decimals = (-libm::log10(step(high - low, 6) * 1.000_001).floor()).clamp(0.0, 6.0) as usize;
            return ticks([low, high], 6, Count::Latitude)
                .into_iter()
                .map(|(value, _)| (share(value), grouped(value, decimals)))
                .collect();
        }
        let [first, last] = [low, high].map(libm::log10);
        let every = ((last - first) / 6.0).ceil().max(1.0) as i64;
        ((first - 1e-9).ceil() as i64..=(last + 1e-9).floor() as i64)
            .filter(|decade| decade % every == 0)
            .map(|decade| {
                let value = libm::pow(10.0, decade as f64);
                let name = if decade < 5 { grouped(value, (-decade).max(0) as usize) } else { format!("1e{decade}") };
                ((decade as f64 - first) / (last - first), name)
            })
            .collect()
    }
}

/// A color for a number: consecutive numbers differ. 0, which means no area, is gray.
fn label(value: f32) -> Light {
    if value == 0.0 {
        return [0.6; 3];
    }
    // Multiples of the golden ratio keep hues far apart.
    let k = f64::from(value.round());
    let hue = (k * 0.618_033_988_749_895).rem_euclid(1.0) * 360.0;
    let tone = (k * 0.381_966_011_250_105 * 7.0).rem_euclid(1.0);
    of_hsv([hue as f32, 0.35 + 0.3 * tone as f32, 0.95 - 0.25 * tone as f32]).map(|c| decode((c * 255.0 + 0.5) as u8))
}

impl Desk<'_> {
    /// A bar of the ramp's colors with its values and its name; `width` is the total width.
    pub fn ramp(&mut self, Point { x: left, y: top }: Point, width: f32, ramp: &Ramp) {
        const STEPS: usize = 600;
        let encoder = Encoder::new();
        let (named, unit) = (ramp.name.clone(), ramp.unit);
        let beside = 2.0 + self.letters.width(unit, Face::Regular, SMALL).max(8.0);
        let area = Rect::new(left, top, width - beside, 3.6);
        let [low, high] = ramp.ends;
        if ramp.scale == Scale::Labels {
            let sample = 6.0;
            for k in 0..5u8 {
                let color = encoder.bytes(label(f32::from(k) + 1.0));
                let part = Rect::new(left + sample * f32::from(k), top, sample, 3.6);
                self.scene.block(part, color);
                self.scene.frame(part, 0.15, self.colors.ink);
            }
            self.small(&format!("{named}, one color each"), Point::new(left, top + 7.4), Align::Start);
            return;
        }
        let pixels = (0..STEPS).flat_map(|k| {
            let share = (k as f64 + 0.5) / STEPS as f64;
            let value = match ramp.scale {
                Scale::Log => low * libm::pow(high / low, share),
                _ => low + (high - low) * share,
            };
            encoder.bytes(ramp.at(value as f32))
        });
        self.scene.items.push(Item::Picture { area, width: STEPS, height: 1, pixels: pixels.collect() });
        self.scene.frame(area, 0.15, self.colors.ink);
        let mut lines: Vec<Vec<Point>> = Vec::new();
        let mut free = f32::MIN;
        for (share, name) in ramp.marks() {
            let x = left + area.width * share as f32;
            lines.push(line([[x, top + 3.6], [x, top + 4.5]]));
            let half = self.letters.width(&name, Face::Regular, SMALL) / 2.0;
            if x - half > free {
                self.small(&name, Point::new(x, top + 7.4), Align::Middle);
                free = x + half + 1.0;
            }
        }
        self.scene.lines(lines, 0.2, self.colors.ink, 1.0);
        self.small(unit, Point::new(left + area.width + 2.0, top + 2.8), Align::Start);
        self.small(&named, Point::new(left, top + 11.0), Align::Start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;
    use orogen_io::palette::named;

    fn layer(scale: Scale, data: Vec<f32>) -> Layer {
        let window = Window::new(data.len(), 1, 10.0);
        Layer { values: Grid::from_data(window, data).unwrap(), name: "area".into(), unit: "m^2", scale, range: None }
    }

    fn viridis() -> Palette {
        named::find("viridis").unwrap().palette()
    }

    #[test]
    fn decades_are_as_wide_as_each_other() {
        let ramp = Ramp::new(&layer(Scale::Log, vec![100.0, 0.0, 1e4, 1e8]), &viridis()).unwrap();
        let plain = Fitted::new(&viridis(), 2.0, 8.0, f32::NEG_INFINITY);
        for decade in 2..=8 {
            assert_eq!(ramp.at(libm::powf(10.0, decade as f32)), plain.at(decade as f32), "{decade}");
        }
        // Values of 0 and below have the color of the lower end.
        assert_eq!(ramp.at(0.0), ramp.at(100.0));
        let marks = ramp.marks();
        let names: Vec<&str> = marks.iter().map(|mark| mark.1.as_str()).collect();
        assert_eq!(names, ["0.0001", "0.001", "0.01", "0.1", "1", "10", "100"]);
        assert!((marks[3].0 - 0.5).abs() < 1e-9 && ramp.words() == "area 0.0001 to 100 km\u{b2}", "{}", ramp.words());
    }

    #[test]
    fn a_linear_ramp_and_labels() {
        let linear = Ramp::new(&layer(Scale::Linear, vec![0.0, 0.5, 1.0]), &viridis()).unwrap();
        let marks = linear.marks();
        assert_eq!(marks.first().map(|mark| mark.1.as_str()), Some("0.0"));
        assert!(marks.iter().all(|(share, name)| (share - name.parse::<f64>().unwrap()).abs() < 1e-9));
        let labels = Ramp::new(&layer(Scale::Labels, vec![1.0, 2.0, 3.0]), &viridis()).unwrap();
        let apart = |a: f32, b: f32| labels.at(a).iter().zip(labels.at(b)).map(|(a, b)| (a - b).abs()).sum::<f32>();
        assert!((1..100).all(|k| apart(k as f32, k as f32 + 1.0) > 0.1));
        let grid = labels.at_pixels(&layer(Scale::Labels, vec![1.0, 2.0, 3.0]).values, [30, 3]);
        assert!(grid.data().iter().all(|value| value.fract() == 0.0));
    }

    #[test]
    fn what_has_no_ramp_is_a_sentence() {
        for (scale, data, palette, expect) in [
            (Scale::Log, vec![0.0, -1.0], "viridis", "needs values above 0"),
            (Scale::Linear, vec![0.0, 1.0], named::DEFAULT, "applies to heights only"),
        ] {
            let error = Ramp::new(&layer(scale, data), &named::find(palette).unwrap().palette()).err().unwrap();
            assert!(error.to_string().contains(expect), "{error}");
        }
    }
}

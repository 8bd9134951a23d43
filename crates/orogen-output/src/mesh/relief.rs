//! Remapping of heights by a curve, before a mesh is made.

use orogen_engine::declare::Input;
use orogen_engine::field::Curve;
use orogen_grid::analysis::halo::Halo;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Grid;
use orogen_io::format::levels::{NO_SAMPLES, extremes};

/// A curve over the relief of a grid, from 0 at its lowest to 1 at its highest sample: control points (from, to) with
/// ascending first numbers, interpolated with the monotone cubic of the op `curve`.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightCurve {
    points: Vec<[f64; 2]>,
}

impl HeightCurve {
    /// Parses text such as `0:0,0.5:0.2,1:1`.
    ///
    /// # Errors
    /// If it is not at least two pairs of numbers with ascending first numbers.
    pub fn parse(text: &str) -> Result<HeightCurve> {
        let refuse = |why: String| {
            let message = format!(
                "`{}` is not a valid height curve: {why}; write two or more points such as 0:0,0.5:0.2,1:1, from the lowest (0) to the highest (1)",
                text.escape_debug()
            );
            Err(Error::new(ErrorKind::Request, message))
        };
        let mut points: Vec<[f64; 2]> = Vec::new();
        for pair in text.split(',') {
            let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.abs() <= 1e6);
            match pair.split_once(':').map(|(from, to)| (number(from), number(to))) {
                Some((Some(from), Some(to))) => points.push([from, to]),
                _ => {
                    return refuse(format!("`{}` is not two numbers separated by a colon", pair.trim().escape_debug()));
                }
            }
        }
        if points.len() < 2 {
            return refuse("a curve needs at least two points".into());
        }
        match points.windows(2).find(|pair| pair[0][0] >= pair[1][0]) {
            Some(pair) => refuse(format!("{} follows {}, which is not less", pair[1][0], pair[0][0])),
            None => Ok(HeightCurve { points }),
        }
    }

    /// Remaps the heights of a grid and of its halo. Level ground and holes do not change.
    pub fn bend(&self, grid: &mut Grid, halo: &mut Halo) {
        let range = extremes(NO_SAMPLES, grid.data());
        halo.each(|heights| self.bend_within(range, heights));
        for j in 0..grid.height() {
            self.bend_within(range, grid.row_mut(j));
        }
    }

    /// Remaps heights relative to this lowest and highest height.
    pub fn bend_within(&self, range: [f32; 2], heights: &mut [f32]) {
        let [low, high] = range.map(f64::from);
        let relief = high - low;
        if !(relief > 0.0 && relief.is_finite()) {
            return;
        }
        let function = Curve { source: Input::None, points: self.points.clone() }.function();
        for height in heights {
            let share = function(((f64::from(*height) - low) / relief) as f32);
            *height = (low + f64::from(share) * relief) as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;

    #[test]
    fn heights_are_bent_over_the_relief() {
        let data = vec![100.0, 150.0, 200.0, 250.0, 300.0, f32::NAN];
        let mut grid = Grid::from_data(Window::new(3, 2, 1.0), data).unwrap();
        HeightCurve::parse("0:0, 0.5:0.25 ,1:2").unwrap().bend(&mut grid, &mut Halo::default());
        let row = grid.data();
        assert_eq!([row[0], row[2], row[4]], [100.0, 150.0, 500.0]);
        assert!(row[5].is_nan() && row[1] > 100.0 && row[1] < 150.0);
        let mut flat = Grid::filled(Window::new(2, 2, 1.0), 7.0);
        HeightCurve::parse("0:1,1:0").unwrap().bend(&mut flat, &mut Halo::default());
        assert_eq!(flat.data(), [7.0; 4]);
    }

    #[test]
    fn what_is_no_curve_is_a_sentence() {
        for (text, expect) in [
            ("", "`` is not two numbers"),
            ("0:0", "a curve needs at least two points"),
            ("0:0,1", "`1` is not two numbers"),
            ("0:0,nan:1", "`nan:1` is not"),
            ("0:0,0.5:1,0.5:2", "0.5 follows 0.5"),
        ] {
            let error = HeightCurve::parse(text).unwrap_err().to_string();
            assert!(error.contains(expect), "{error}");
        }
    }
}

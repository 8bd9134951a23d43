//! The domain: closed to a torus, so that no sand is lost, and lines across the wind.

use crate::grid::{Window, transposed};

/// A window that is closed to a torus by strips in which values change smoothly to those of the opposite side.
#[derive(Debug, Clone, Copy)]
pub(super) struct Torus {
    /// Columns and rows of the window.
    inner: [usize; 2],
    /// Columns and rows with the strips.
    sides: [usize; 2],
}

/// The direction in which the wind blows, as lines of samples across it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Heading {
    /// Whether lines are columns of the torus; otherwise they are rows.
    columns: bool,
    /// Whether the wind blows to the first line.
    reversed: bool,
    /// Number of lines.
    pub(super) lines: usize,
    /// Samples of a line.
    pub(super) across: usize,
    /// Samples along the next line by which the wind drifts from line to line, -1 to 1.
    pub(super) drift: f32,
}

impl Heading {
    /// The heading of a wind that comes from a direction in degrees clockwise from north.
    pub(super) fn from(direction: f64, torus: &Torus) -> Heading {
        let angle = direction.to_radians();
        let (east, south) = (-libm::sin(angle), libm::cos(angle));
        let [width, height] = torus.sides;
        let columns = east.abs() >= south.abs();
        let (ahead, aside) = if columns { (east, south) } else { (south, east) };
        let (lines, across) = if columns { (width, height) } else { (height, width) };
        // A wind along an axis has no drift of rounding errors.
        let drift = aside / ahead.abs();
        let drift = if drift.abs() < 1e-9 { 0.0 } else { drift.clamp(-1.0, 1.0) };
        Heading { columns, reversed: ahead < 0.0, lines, across, drift: drift as f32 }
    }

    /// Distance along the wind from line to line, in cells.
    pub(super) fn stride(&self) -> f32 {
        (1.0 + self.drift * self.drift).sqrt()
    }
}

impl Torus {
    /// The torus of a window, with strips about as wide as a wavelength.
    pub(super) fn new(window: &Window, wavelength: f64) -> Torus {
        let strip = (wavelength / window.cell).ceil().clamp(8.0, 64.0) as usize;
        let inner = [window.width, window.height];
        Torus { inner, sides: inner.map(|side| side.saturating_add(strip)) }
    }

    /// Number of samples.
    pub(super) fn len(&self) -> usize {
        self.sides[0].saturating_mul(self.sides[1])
    }

    /// The values of the window, continued over the strips.
    pub(super) fn closed(&self, values: &[f32]) -> Vec<f32> {
        let [inner_width, inner_height] = self.inner;
        let [width, height] = self.sides;
        let share = |k: usize, inner: usize, side: usize| {
            let t = (k + 1 - inner) as f32 / (side - inner + 1) as f32;
            t * t * (3.0 - 2.0 * t)
        };
        let mut closed = vec![0.0; self.len()];
        for (row, values) in closed.chunks_mut(width).zip(values.chunks(inner_width)) {
            row[..inner_width].copy_from_slice(values);
            let (first, last) = (values[0], values[inner_width - 1]);
            for (i, value) in row.iter_mut().enumerate().skip(inner_width) {
                *value = last + (first - last) * share(i, inner_width, width);
            }
        }
        for j in inner_height..height {
            let t = share(j, inner_height, height);
            for i in 0..width {
                let (first, last) = (closed[i], closed[(inner_height - 1) * width + i]);
                closed[j * width + i] = last + (first - last) * t;
            }
        }
        closed
    }

    /// Writes the values of the window.
    pub(super) fn open(&self, values: &[f32], out: &mut [f32]) {
        for (out, row) in out.chunks_mut(self.inner[0]).zip(values.chunks(self.sides[0])) {
            out.copy_from_slice(&row[..out.len()]);
        }
    }

    /// The values in lines across the wind, in the direction in which it blows.
    pub(super) fn along(&self, heading: &Heading, values: &[f32]) -> Vec<f32> {
        let mut lines = if heading.columns { transposed(values, self.sides[0]) } else { values.to_vec() };
        reverse(heading, &mut lines);
        lines
    }

    /// The values in rows from lines across the wind.
    pub(super) fn back(&self, heading: &Heading, lines: &[f32]) -> Vec<f32> {
        let mut values = lines.to_vec();
        reverse(heading, &mut values);
        if heading.columns { transposed(&values, heading.across) } else { values }
    }
}

fn reverse(heading: &Heading, lines: &mut [f32]) {
    if heading.reversed {
        let (count, across) = (heading.lines, heading.across);
        for line in 0..count / 2 {
            let (one, other) = lines.split_at_mut((count - 1 - line) * across);
            one[line * across..][..across].swap_with_slice(&mut other[..across]);
        }
    }
}

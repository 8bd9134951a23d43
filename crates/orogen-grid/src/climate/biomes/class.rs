//! A class of a scheme, and the climate that it is found from.

use crate::climate::year::{Year, cosine};

/// A class of climates or biomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Class {
    /// The code, from 0.
    pub code: u8,
    /// The name, in lower case.
    pub name: &'static str,
    /// The color on maps, sRGB.
    pub color: [u8; 3],
}

/// The code of water, in all schemes.
pub const WATER: u8 = 0;

/// A climate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Climate {
    /// The temperatures of the year.
    pub year: Year,
    /// Rain of a year, in mm.
    pub rain: f64,
    /// When the rain falls, -1 to 1: 0 evenly over the year; the rain of a month is 1 + `seasonality` cos t of the
    /// mean, with t = 0 in the warmest month.
    pub seasonality: f64,
}

impl Climate {
    /// Rain of the twelve months in mm, from the warmest month (0) to the coldest (6) and back.
    pub(super) fn rain_of_months(&self) -> [f64; 12] {
        let mean = self.rain / 12.0;
        std::array::from_fn(|month| mean * (1.0 + self.seasonality * cosine(month)))
    }
}

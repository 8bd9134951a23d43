//! A class of a scheme, and the climate that determines it.

use crate::climate::year::{Year, cosine};

/// A class of climates or biomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Class {
    /// The code, from 0.
    pub code: u8,
    /// The name, in lower case.
    pub name: &'static str,
    /// The color on maps, in sRGB.
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
    /// Seasonality of the rain, -1 to 1: the rain of a month is 1 + `seasonality` cos t times the mean, with t = 0 in
    /// the warmest month. 0 means even rain over the year.
    pub seasonality: f64,
}

impl Climate {
    /// Rain of the twelve months in mm, from the warmest month (0) to the coldest (6) and back.
    pub(super) fn rain_of_months(&self) -> [f64; 12] {
        let mean = self.rain / 12.0;
        std::array::from_fn(|month| mean * (1.0 + self.seasonality * cosine(month)))
    }
}

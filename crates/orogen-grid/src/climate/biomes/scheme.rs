//! The schemes of classes.

use super::class::{Class, Climate};
use super::{holdridge, koppen_geiger, whittaker};

/// A scheme that divides climates into classes.
///
/// ```
/// use orogen_grid::climate::biomes::{class::Climate, scheme::Scheme};
/// use orogen_grid::climate::year::Year;
///
/// let climate = Climate { year: Year { mean: 26.0, range: 1.5 }, rain: 2700.0, seasonality: 0.0 };
/// let name = |scheme: Scheme| scheme.class(scheme.code(&climate)).map(|class| class.name);
/// assert_eq!(name(Scheme::Whittaker), Some("tropical rain forest"));
/// assert_eq!(name(Scheme::KoppenGeiger), Some("Af tropical, rainforest"));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Biomes by mean temperature and rain (Whittaker 1975), with straight lines along the borders of the diagram in
    /// Ricklefs (2008), and ice where no month is above 0 degrees C.
    Whittaker,
    /// Life zones by biotemperature, rain and their ratio (Holdridge 1967): hexagons in the logarithms of the three.
    Holdridge,
    /// Climates by the monthly temperatures and rain (Köppen and Geiger; criteria and colors of Peel, Finlayson and
    /// McMahon 2007, and Beck and others 2018).
    KoppenGeiger,
}

impl Scheme {
    /// All classes. The code of each class is its index; the first one is water.
    #[must_use]
    pub fn classes(self) -> &'static [Class] {
        match self {
            Scheme::Whittaker => whittaker::CLASSES,
            Scheme::Holdridge => holdridge::CLASSES,
            Scheme::KoppenGeiger => koppen_geiger::CLASSES,
        }
    }

    /// The class with this code, if there is one.
    #[must_use]
    pub fn class(self, code: u8) -> Option<&'static Class> {
        self.classes().get(usize::from(code))
    }

    /// The code of the class of a climate on land.
    #[must_use]
    pub fn code(self, climate: &Climate) -> u8 {
        match self {
            Scheme::Whittaker => whittaker::code(climate),
            Scheme::Holdridge => holdridge::code(climate),
            Scheme::KoppenGeiger => koppen_geiger::code(climate),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::climate::year::Year;
    use std::collections::HashSet;

    const ALL: [Scheme; 3] = [Scheme::Whittaker, Scheme::Holdridge, Scheme::KoppenGeiger];

    /// Temperatures, rain, and ranges with the seasons of the rain.
    fn climates() -> impl Iterator<Item = (f64, f64, [f64; 2])> {
        let calm = [[0.5, 0.0], [4.0, -0.9], [5.0, 0.9], [6.0, 0.9], [8.0, 0.0]];
        let seasonal = [[12.0, 0.9], [13.0, -0.9], [15.0, 0.0], [22.0, -0.9], [24.0, 0.9], [29.0, -0.9], [30.0, 0.0]];
        let years = calm.into_iter().chain(seasonal).chain([[33.0, 0.9]]);
        years.flat_map(|year| {
            (-40..=36).flat_map(move |mean| (0..60).map(move |k| (f64::from(mean), 2.5 * f64::from(k * k), year)))
        })
    }

    #[test]
    fn codes_are_indices_and_names_and_colors_are_distinct() {
        for scheme in ALL {
            let classes = scheme.classes();
            assert!(classes.iter().enumerate().all(|(k, class)| usize::from(class.code) == k));
            let names: HashSet<&str> = classes.iter().map(|class| class.name).collect();
            let colors: HashSet<[u8; 3]> = classes.iter().map(|class| class.color).collect();
            assert_eq!([names.len(), colors.len()], [classes.len(); 2], "{scheme:?}");
        }
    }

    #[test]
    fn every_climate_has_a_class_and_every_class_a_climate() {
        for scheme in ALL {
            let mut found = HashSet::from([0]);
            for (mean, rain, [range, seasonality]) in climates() {
                let code = scheme.code(&Climate { year: Year { mean, range }, rain, seasonality });
                assert!(code > 0 && scheme.class(code).is_some(), "{scheme:?} {code}");
                found.insert(code);
            }
            let missing: Vec<&str> =
                scheme.classes().iter().filter(|class| !found.contains(&class.code)).map(|class| class.name).collect();
            assert!(missing.is_empty(), "{scheme:?}: {missing:?}");
        }
    }
}

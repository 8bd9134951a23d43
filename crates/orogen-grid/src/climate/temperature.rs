//! Temperature by latitude, height and distance from the sea.

/// The temperature of the air near the ground.
///
/// The mean at sea level is `equator` - (`equator` - `pole`) sin^2(latitude): two modes of an energy balance (North,
/// Cahalan and Coakley 1981). The annual range A follows from Conrad's index of continentality K (Conrad 1946): K = 1.7
/// A / sin(latitude + 10 degrees) - 14.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Temperature {
    /// Mean at sea level at the equator, in degrees C. Default: 29.
    pub equator: f64,
    /// Mean at sea level at the poles, in degrees C. Default: -13.
    pub pole: f64,
    /// Decrease with height above sea level, in K per km. Default: 6.5.
    pub lapse_rate: f64,
    /// Latitude at y = 0, in degrees north, -90 to 90. Default: 45.
    pub latitude: f64,
    /// Distance along y of one degree of latitude, in metres; greater than 0. Default: 111 195.
    pub metres_per_degree: f64,
    /// Distance from the sea at which K is 50, in metres; greater than 0. Default: 900 000.
    pub continental_distance: f64,
}

impl Default for Temperature {
    fn default() -> Temperature {
        Temperature {
            equator: 29.0,
            pole: -13.0,
            lapse_rate: 6.5,
            latitude: 45.0,
            metres_per_degree: 111_195.0,
            continental_distance: 900_000.0,
        }
    }
}

orogen_noise::builder!(
    Temperature:
    with_equator(equator: f64),
    with_pole(pole: f64),
    with_lapse_rate(lapse_rate: f64),
    with_latitude(latitude: f64),
    with_metres_per_degree(metres_per_degree: f64),
    with_continental_distance(continental_distance: f64)
);

impl Temperature {
    /// Latitude in degrees north, clamped to -90 to 90, at `south` metres to the south of the origin.
    #[must_use]
    pub fn latitude_at(&self, south: f64) -> f64 {
        (self.latitude - south / self.metres_per_degree).clamp(-90.0, 90.0)
    }

    /// Mean temperature at sea level, in degrees C, at `south` metres to the south of the origin.
    #[must_use]
    pub fn at_sea_level(&self, south: f64) -> f64 {
        let sin = libm::sin(self.latitude_at(south).to_radians());
        self.equator - (self.equator - self.pole) * sin * sin
    }

    /// Decrease of the temperature from sea level to `above_sea` metres above it, in K; 0 below sea level.
    #[must_use]
    pub fn decrease(&self, above_sea: f64) -> f64 {
        self.lapse_rate * (above_sea.max(0.0) / 1000.0)
    }

    /// Index of continentality at `from_sea` metres from the sea, from 0 at the sea to 100: 100 d / (d +
    /// `continental_distance`).
    #[must_use]
    pub fn continentality(&self, from_sea: f64) -> f64 {
        let distance = from_sea.max(0.0);
        100.0 * distance / (distance + self.continental_distance)
    }

    /// Half the difference between the warmest and the coldest month, in K, per unit of 14 + K, at `south` metres to
    /// the south of the origin.
    #[must_use]
    pub fn seasonality(&self, south: f64) -> f64 {
        libm::sin((self.latitude_at(south).abs() + 10.0).to_radians()) / (2.0 * 1.7)
    }
}

/// K + 14 for an index of continentality K: the factor for [`Temperature::seasonality`].
#[must_use]
pub fn seasons(continentality: f64) -> f64 {
    continentality + 14.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_warm_at_the_equator_and_at_the_sea() {
        let there = Temperature::default().with_latitude(0.0);
        let south = |degrees: f64| degrees * there.metres_per_degree;
        assert_eq!(there.at_sea_level(0.0), 29.0);
        assert!((there.at_sea_level(south(90.0)) + 13.0).abs() < 1e-9);
        assert!((there.at_sea_level(south(45.0)) - 8.0).abs() < 1e-9);
        // Both hemispheres are alike, and positions beyond a pole count as the pole.
        assert_eq!(there.at_sea_level(south(30.0)), there.at_sea_level(south(-30.0)));
        assert_eq!(there.at_sea_level(south(90.0)), there.at_sea_level(south(300.0)));
        assert_eq!([there.decrease(1000.0), there.decrease(-500.0)], [6.5, 0.0]);
    }

    #[test]
    fn seasons_grow_with_the_latitude_and_the_distance_from_the_sea() {
        let range = |latitude: f64, from_sea: f64| {
            let there = Temperature::default().with_latitude(latitude);
            there.seasonality(0.0) * seasons(there.continentality(from_sea))
        };
        // Half of the ranges of Singapore, Dublin, Berlin, Moscow and Yakutsk: 1, 5, 9.5, 14 and 29 K.
        assert!(range(1.0, 0.0) < 1.0);
        assert!((range(53.0, 50e3) - 5.0).abs() < 1.5, "{}", range(53.0, 50e3));
        assert!((range(52.5, 180e3) - 9.5).abs() < 2.0, "{}", range(52.5, 180e3));
        assert!((range(56.0, 700e3) - 14.0).abs() < 2.5, "{}", range(56.0, 700e3));
        assert!((range(62.0, 2500e3) - 29.0).abs() < 5.0, "{}", range(62.0, 2500e3));
    }
}

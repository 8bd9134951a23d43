//! Position of the sun.

/// A latitude and a time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Moment {
    /// Degrees north of the equator.
    pub latitude: f64,
    /// Day of the year, from 1.
    pub day: u16,
    /// True solar time in hours after midnight: the sun is highest at 12.
    pub hour: f64,
}

impl Moment {
    /// A moment from a latitude in degrees north, a day from 1, and an hour of true solar time.
    #[must_use]
    pub const fn new(latitude: f64, day: u16, hour: f64) -> Moment {
        Moment { latitude, day, hour }
    }
}

orogen_noise::builder!(Moment: with_latitude(latitude: f64), with_day(day: u16), with_hour(hour: f64));

impl Moment {
    /// The sun's azimuth, in degrees clockwise from north, and its elevation, in degrees above the horizon (negative
    /// below it).
    ///
    /// Declination by J. W. Spencer's series ("Fourier series representation of the position of the sun", Search 2(5),
    /// 1971), accurate to 0.04 degrees. Because the time is true solar time, longitude and the equation of time do not
    /// matter. Atmospheric refraction (half a degree at the horizon) is ignored.
    #[must_use]
    pub fn sun(&self) -> [f64; 2] {
        let turn = (f64::from(self.day) - 1.0 + (self.hour - 12.0) / 24.0) * std::f64::consts::TAU / 365.0;
        let wave = |times: f64| libm::sincos(turn * times);
        let ((s1, c1), (s2, c2), (s3, c3)) = (wave(1.0), wave(2.0), wave(3.0));
        let declination = 0.006_918 - 0.399_912 * c1 + 0.070_257 * s1 - 0.006_758 * c2 + 0.000_907 * s2
            - 0.002_697 * c3
            + 0.001_48 * s3;
        let (sin_d, cos_d) = libm::sincos(declination);
        let (sin_l, cos_l) = libm::sincos(self.latitude.to_radians());
        let (sin_h, cos_h) = libm::sincos(((self.hour - 12.0) * 15.0).to_radians());
        let up = sin_l * sin_d + cos_l * cos_d * cos_h;
        let (east, north) = (-cos_d * sin_h, cos_l * sin_d - sin_l * cos_d * cos_h);
        let azimuth = libm::atan2(east, north).to_degrees();
        [if azimuth < 0.0 { azimuth + 360.0 } else { azimuth }, libm::asin(up.clamp(-1.0, 1.0)).to_degrees()]
    }

    /// The hours of sunrise and sunset on that day: `None` if the sun never rises, 0 to 24 if it never sets.
    #[must_use]
    pub fn daylight(&self) -> Option<[f64; 2]> {
        let noon = Moment { hour: 12.0, ..*self };
        let midnight = Moment { hour: 0.0, ..*self };
        match (midnight.sun()[1] > 0.0, noon.sun()[1] > 0.0) {
            (true, _) => Some([0.0, 24.0]),
            (_, false) => None,
            _ => {
                // The crossing of the horizon is found by bisection.
                let cross = |mut down: f64, mut up: f64| {
                    for _ in 0..40 {
                        let middle = 0.5 * (down + up);
                        let above = Moment { hour: middle, ..*self }.sun()[1] > 0.0;
                        (down, up) = if above { (down, middle) } else { (middle, up) };
                    }
                    up
                };
                Some([cross(0.0, 12.0), cross(24.0, 12.0)])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_stands_where_almanacs_say() {
        // Latitude, day, solar time; azimuth and elevation. Noon elevations are 90 - |latitude - declination|,
        // declinations from the Astronomical Almanac's table of the sun (2023): 21 June +23.44, 21 December -23.44, 5
        // February -15.9, 6 August +16.6.
        for (latitude, day, hour, azimuth, elevation) in [
            (47.0, 172, 12.0, 180.0, 66.44),
            (47.0, 355, 12.0, 180.0, 19.56),
            (52.0, 36, 12.0, 180.0, 22.1),
            (0.0, 218, 12.0, 0.0, 73.4),
            (-35.0, 355, 12.0, 0.0, 78.44),
            (70.0, 172, 0.0, 0.0, 3.44),
            // On the equator at an equinox the sun rises due east and is at 45 degrees three hours later.
            (0.0, 81, 6.0, 90.0, 0.0),
            (0.0, 81, 9.0, 90.0, 45.0),
            (0.0, 81, 15.0, 270.0, 45.0),
            // J. A. Duffie, W. A. Beckman, "Solar Engineering of Thermal Processes", example 1.6.2: latitude 43, 13
            // February at 9:30, zenith angle 66.5 and azimuth 40.0 east of south; 1 July at 18:30, 79.6 and 112.0 west
            // of south.
            (43.0, 44, 9.5, 140.0, 23.5),
            (43.0, 182, 18.5, 292.0, 10.4),
        ] {
            let [got_azimuth, got_elevation] = Moment { latitude, day, hour }.sun();
            let turn = (got_azimuth - azimuth + 540.0).rem_euclid(360.0) - 180.0;
            assert!(
                turn.abs() < 0.8 && (got_elevation - elevation).abs() < 0.5,
                "{latitude} {day} {hour}: {got_azimuth} {got_elevation}"
            );
        }
    }

    #[test]
    fn days_have_their_length() {
        let length =
            |latitude: f64, day: u16| Moment { latitude, day, hour: 0.0 }.daylight().map(|[rise, set]| set - rise);
        for (latitude, day, hours) in [(0.0, 81, 12.0), (50.0, 172, 16.2), (50.0, 355, 7.8), (80.0, 172, 24.0)] {
            let got = length(latitude, day).unwrap();
            assert!((got - hours).abs() < 0.15, "{latitude} {day}: {got}");
        }
        assert_eq!(length(80.0, 355), None);
    }
}

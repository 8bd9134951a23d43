//! The direction of the sun.

/// The unit vector towards the sun at an azimuth clockwise from north and an altitude, in degrees: east, south and up.
#[must_use]
pub fn towards([azimuth, altitude]: [f64; 2]) -> [f64; 3] {
    let (azimuth, altitude) = (azimuth.to_radians(), altitude.to_radians());
    let level = libm::cos(altitude);
    [libm::sin(azimuth) * level, -libm::cos(azimuth) * level, libm::sin(altitude)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions() {
        for (sun, expect) in
            [([90.0, 0.0], [1.0, 0.0, 0.0]), ([180.0, 0.0], [0.0, 1.0, 0.0]), ([0.0, 90.0], [0.0, 0.0, 1.0])]
        {
            let found = towards(sun);
            assert!((0..3).all(|k| (found[k] - expect[k]).abs() < 1e-12), "{sun:?}: {found:?}");
        }
    }
}

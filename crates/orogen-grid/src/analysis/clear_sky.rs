//! Solar irradiance under a clear sky: direct, diffuse and reflected by the surrounding ground.
//!
//! This is the model of the European Solar Radiation Atlas (Rigollier, Bauer and Wald, "On the clear sky model of the
//! ESRA", Solar Energy 68, 2000) with Muneer's model (1990) of diffuse light on slopes. Šúri and Hofierka combined them
//! for maps ("A new GIS-based solar radiation model", Transactions in GIS 8, 2004).

/// Solar irradiance outside the atmosphere at the sun's mean distance, in W/m^2.
const SOLAR_CONSTANT: f64 = 1367.0;

/// Height over which the air pressure falls by a factor of e, in metres.
const PRESSURE_SCALE: f64 = 8434.5;

/// Number of heights at which the beam is computed; it is interpolated linearly between them.
const LEVELS: usize = 64;

/// Parameters of the atmosphere and the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ClearSky {
    /// Linke turbidity for an air mass of 2: 1 is clean dry air, 3 is typical, 6 is hazy.
    pub turbidity: f64,
    /// Albedo: the share of light that the surrounding ground reflects, 0 to 1.
    pub albedo: f64,
}

impl Default for ClearSky {
    /// A typical sky: turbidity 3, albedo 0.2.
    fn default() -> ClearSky {
        ClearSky { turbidity: 3.0, albedo: 0.2 }
    }
}

orogen_noise::builder!(ClearSky: with_turbidity(turbidity: f64), with_albedo(albedo: f64));

/// Orientation of a slope, with the factors that the light model needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facet {
    /// The upward normal: east, south and up, of length 1.
    normal: [f64; 3],
    /// The share of an isotropic sky that is visible from the slope: (1 + cos slope) / 2.
    sky: f64,
    /// sin - slope cos - pi sin^2 (slope / 2): the anisotropic term of Muneer's sky.
    uneven: f64,
}

impl Facet {
    /// A facet from its gradient: the rise per metre to the east and to the south.
    #[must_use]
    pub fn new(east: f64, south: f64) -> Facet {
        let length = (1.0 + east * east + south * south).sqrt();
        let up = 1.0 / length;
        let sine = (1.0 - up * up).max(0.0).sqrt();
        let uneven = sine - libm::atan2(sine, up) * up - std::f64::consts::PI * 0.5 * (1.0 - up);
        Facet { normal: [-east / length, -south / length, up], sky: 0.5 * (1.0 + up), uneven }
    }
}

/// The sun at one moment, and its irradiance at any height.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Sunlight {
    /// Unit vector to the sun: east, south and up.
    pub towards: [f64; 3],
    elevation: f64,
    /// Irradiance outside the atmosphere on a plane that faces the sun, in W/m^2.
    outside: f64,
    /// Diffuse irradiance on level ground, in W/m^2.
    diffuse: f64,
    albedo: f64,
    /// Beam irradiance on a plane that faces the sun, in W/m^2, at heights from `lowest`, `step` apart.
    beam: Vec<f64>,
    lowest: f64,
    step: f64,
}

impl ClearSky {
    /// The irradiance of a sun at `azimuth` (degrees clockwise from north) and `elevation` (degrees, above 0) on day
    /// `day` of the year (from 1), for ground at heights from `lowest` to `highest` metres.
    #[must_use]
    pub fn sunlight(&self, day: f64, [azimuth, elevation]: [f64; 2], [lowest, highest]: [f64; 2]) -> Sunlight {
        let angle = elevation.to_radians();
        let (sine, cosine) = libm::sincos(angle);
        let (east, north) = libm::sincos(azimuth.to_radians());
        let year = day * std::f64::consts::TAU / 365.25;
        let outside = SOLAR_CONSTANT * (1.0 + 0.03344 * libm::cos(year - 0.048869));
        let step = ((highest - lowest) / LEVELS as f64).max(1.0);
        let beam = (0..=LEVELS).map(|k| outside * self.transmittance(angle, lowest + step * k as f64)).collect();
        Sunlight {
            towards: [east * cosine, -north * cosine, sine],
            elevation: angle,
            outside,
            diffuse: outside * self.diffuse(sine),
            albedo: self.albedo,
            beam,
            lowest,
            step,
        }
    }

    /// The share of the beam that passes through the air above `height` metres.
    fn transmittance(&self, elevation: f64, height: f64) -> f64 {
        // Refraction, and the relative optical air mass (Kasten and Young 1989).
        let h = elevation;
        let refracted = h + 0.061359 * (0.1594 + 1.123 * h + 0.065656 * h * h) / (1.0 + 28.9344 * h + 277.3971 * h * h);
        let path = libm::sin(refracted) + 0.50572 * libm::pow(refracted.to_degrees() + 6.07995, -1.6364);
        let mass = libm::exp(-height / PRESSURE_SCALE) / path;
        // The Rayleigh optical thickness (Kasten 1996).
        let thickness = if mass <= 20.0 {
            1.0 / (6.6296 + mass * (1.7513 + mass * (-0.1202 + mass * (0.0065 - mass * 0.00013))))
        } else {
            1.0 / (10.4 + 0.718 * mass)
        };
        libm::exp(-0.8662 * self.turbidity * mass * thickness)
    }

    /// Diffuse irradiance on level ground as a share of the irradiance outside the atmosphere; `sine` is the sine of
    /// the sun's elevation.
    fn diffuse(&self, sine: f64) -> f64 {
        let t = self.turbidity;
        let zenith = -0.015843 + 0.030543 * t + 0.0003797 * t * t;
        let a1 = 0.26463 - 0.061581 * t + 0.0031408 * t * t;
        let a1 = if a1 * zenith < 0.0022 { 0.0022 / zenith } else { a1 };
        let a2 = 2.04020 + 0.018945 * t - 0.011161 * t * t;
        let a3 = -1.3025 + 0.039231 * t + 0.0085079 * t * t;
        (zenith * (a1 + a2 * sine + a3 * sine * sine)).max(0.0)
    }
}

impl Sunlight {
    /// The irradiance of a facet at `height` metres, in W/m^2. `lit` is false if other ground casts a shadow on it.
    #[must_use]
    pub fn on(&self, facet: &Facet, height: f64, lit: bool) -> f64 {
        let [east, south, up] = self.towards;
        let at = ((height - self.lowest) / self.step).clamp(0.0, LEVELS as f64);
        let k = (at as usize).min(LEVELS - 1);
        let beam = self.beam[k] + (self.beam[k + 1] - self.beam[k]) * (at - k as f64);
        // The sine of the sun's elevation above the facet.
        let facing = facet.normal[0] * east + facet.normal[1] * south + facet.normal[2] * up;
        let direct = if lit && facing > 0.0 { beam * facing } else { 0.0 };
        let level_beam = if lit { beam * up } else { 0.0 };
        let share = beam / self.outside;
        let sky = if direct > 0.0 {
            let n = 0.00263 - 0.712 * share - 0.6883 * share * share;
            let even = (facet.sky + facet.uneven * n) * (1.0 - share);
            if self.elevation >= 0.1 {
                even + share * facing / up
            } else {
                let towards = facet.normal[0] * east + facet.normal[1] * south;
                let flat = (east * east + south * south).sqrt();
                let level = 1.0 - 2.0 * (1.0 - facet.sky);
                // Level ground receives exactly this share.
                let leaning = towards / flat / (0.1 - 0.008 * self.elevation);
                even + share * if level > 1.0 - 1e-9 { 1.0 } else { leaning.max(0.0) }
            }
        } else {
            facet.sky + facet.uneven * 0.25227
        };
        let reflected = self.albedo * (level_beam + self.diffuse) * (1.0 - facet.sky);
        direct + self.diffuse * sky.max(0.0) + reflected
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SKY: ClearSky = ClearSky { turbidity: 3.0, albedo: 0.2 };

    fn on(elevation: f64, facet: Facet, height: f64, lit: bool) -> f64 {
        SKY.sunlight(172.0, [180.0, elevation], [0.0, 4000.0]).on(&facet, height, lit)
    }

    #[test]
    fn level_ground_gets_what_tables_say() {
        // Rigollier et al., and r.sun with the same parameters: about 1000 W/m^2 with a high sun in average air.
        let level = Facet::new(0.0, 0.0);
        let high = on(65.0, level, 0.0, true);
        assert!((900.0..1000.0).contains(&high), "{high}");
        assert!(on(65.0, level, 3000.0, true) > high + 20.0);
        assert!(on(20.0, level, 0.0, true) < 0.4 * high);
        let shade = on(65.0, level, 0.0, false);
        assert!((70.0..140.0).contains(&shade), "{shade}");
        // For a lower sun, the result is continuous where the model switches between formulas.
        let (below, above) = (on(5.72, level, 0.0, true), on(5.74, level, 0.0, true));
        assert!((below - above).abs() < 0.5, "{below} {above}");
    }

    #[test]
    fn slopes_that_face_the_sun_get_more() {
        let (north, south) = (Facet::new(0.0, 0.6), Facet::new(0.0, -0.6));
        let level = on(40.0, Facet::new(0.0, 0.0), 0.0, true);
        assert!(on(40.0, south, 0.0, true) > 1.15 * level && on(40.0, north, 0.0, true) < 0.6 * level);
        assert!(on(3.0, south, 0.0, true) > on(3.0, north, 0.0, true));
    }
}

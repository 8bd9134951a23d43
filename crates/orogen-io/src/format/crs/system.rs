//! A coordinate reference system by its parameters.

use std::fmt::Write;

/// A geographic system: longitude and latitude in degrees, from Greenwich.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geographic {
    /// The EPSG code.
    pub code: u16,
    /// ESRI's name.
    pub name: &'static str,
    /// ESRI's name of the datum.
    pub datum: &'static str,
    /// EPSG's name of the datum, which OGC WKT uses.
    pub datum_ogc: &'static str,
    /// The name of the ellipsoid.
    pub spheroid: &'static str,
    /// The semi-major axis, in metres.
    pub radius: f64,
    /// The inverse flattening.
    pub flattening: f64,
}

/// A map projection, with ESRI's name and parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// Transverse Mercator.
    TransverseMercator,
    /// Transverse Mercator, under its name in Germany and China.
    GaussKruger,
    /// Lambert conformal conic with two standard parallels.
    Lambert,
    /// Lambert conformal conic with one standard parallel and a scale.
    LambertOne,
    /// Albers equal-area conic.
    Albers,
    /// Lambert azimuthal equal-area.
    AzimuthalEqualArea,
    /// Mercator with a standard parallel.
    Mercator,
    /// Web Mercator.
    WebMercator,
    /// Polar stereographic with a scale at the pole (variant A).
    Stereographic,
    /// Polar stereographic with a standard parallel in the north (variant B).
    NorthPole,
    /// Polar stereographic with a standard parallel in the south (variant B).
    SouthPole,
    /// Oblique stereographic.
    DoubleStereographic,
    /// Equidistant cylindrical (equirectangular) with a standard parallel.
    EquidistantCylindrical,
    /// Sinusoidal.
    Sinusoidal,
    /// Hotine oblique Mercator with its centre on the initial line (variant B).
    ObliqueMercator,
}

impl Method {
    /// ESRI's name of the projection, and its parameters in the order of [`System::projection`].
    pub fn terms(self) -> (&'static str, &'static [&'static str]) {
        const CENTRE: [&str; 3] = ["False_Easting", "False_Northing", "Central_Meridian"];
        const SCALED: &[&str] = &[CENTRE[0], CENTRE[1], CENTRE[2], "Scale_Factor", "Latitude_Of_Origin"];
        const CONIC: &[&str] =
            &[CENTRE[0], CENTRE[1], CENTRE[2], "Standard_Parallel_1", "Standard_Parallel_2", "Latitude_Of_Origin"];
        const PARALLEL: &[&str] = &[CENTRE[0], CENTRE[1], CENTRE[2], "Standard_Parallel_1"];
        match self {
            Method::TransverseMercator => ("Transverse_Mercator", SCALED),
            Method::GaussKruger => ("Gauss_Kruger", SCALED),
            Method::Lambert => ("Lambert_Conformal_Conic", CONIC),
            Method::LambertOne => (
                "Lambert_Conformal_Conic",
                &[CENTRE[0], CENTRE[1], CENTRE[2], "Standard_Parallel_1", "Scale_Factor", "Latitude_Of_Origin"],
            ),
            Method::Albers => ("Albers", CONIC),
            Method::AzimuthalEqualArea => {
                ("Lambert_Azimuthal_Equal_Area", &[CENTRE[0], CENTRE[1], CENTRE[2], "Latitude_Of_Origin"])
            }
            Method::Mercator => ("Mercator", PARALLEL),
            Method::WebMercator => (
                "Mercator_Auxiliary_Sphere",
                &[CENTRE[0], CENTRE[1], CENTRE[2], "Standard_Parallel_1", "Auxiliary_Sphere_Type"],
            ),
            Method::Stereographic => ("Stereographic", SCALED),
            Method::NorthPole => ("Stereographic_North_Pole", PARALLEL),
            Method::SouthPole => ("Stereographic_South_Pole", PARALLEL),
            Method::EquidistantCylindrical => ("Equidistant_Cylindrical", PARALLEL),
            Method::Sinusoidal => ("Sinusoidal", &CENTRE),
            Method::DoubleStereographic => ("Double_Stereographic", SCALED),
            Method::ObliqueMercator => (
                "Hotine_Oblique_Mercator_Azimuth_Center",
                &[CENTRE[0], CENTRE[1], "Scale_Factor", "Azimuth", "Longitude_Of_Center", "Latitude_Of_Center"],
            ),
        }
    }
}

/// A projected or geographic system.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    /// ESRI's name; for a geographic system, its own name.
    pub name: String,
    /// The underlying geographic system.
    pub geographic: Geographic,
    /// The projection and its parameters, in degrees and the system's unit of length; none for a geographic system.
    pub projection: Option<(Method, Vec<f64>)>,
    /// Metres per unit of length.
    pub unit: f64,
}

/// Radians per degree, as ESRI writes it.
const RADIANS: &str = "0.0174532925199433";

impl System {
    /// The text of a `.prj` file: WKT 1 in ESRI's terms, on one line.
    pub fn to_wkt(&self) -> String {
        let Geographic { name, datum, spheroid, radius, flattening, .. } = self.geographic;
        let degrees = format!(
            "GEOGCS[\"{name}\",DATUM[\"{datum}\",SPHEROID[\"{spheroid}\",{},{}]],PRIMEM[\"Greenwich\",0.0],\
             UNIT[\"Degree\",{RADIANS}]]",
            decimal(radius),
            decimal(flattening)
        );
        let Some((method, parameters)) = &self.projection else { return degrees };
        let (projection, names) = method.terms();
        let mut text = format!("PROJCS[\"{}\",{degrees},PROJECTION[\"{projection}\"]", self.name);
        for (name, value) in names.iter().zip(parameters) {
            // Writing to a string does not fail.
            let _ = write!(text, ",PARAMETER[\"{name}\",{}]", decimal(*value));
        }
        let unit = match self.unit {
            1.0 => "Meter",
            0.3048 => "Foot",
            unit if (unit - 1200.0 / 3937.0).abs() < 1e-12 => "Foot_US",
            _ => "Unit",
        };
        let _ = write!(text, ",UNIT[\"{unit}\",{}]]", decimal(self.unit));
        text
    }
}

/// A number with a decimal point.
fn decimal(number: f64) -> String {
    let text = number.to_string();
    if text.contains('.') { text } else { text + ".0" }
}

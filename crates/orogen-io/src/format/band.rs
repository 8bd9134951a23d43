//! Nodata, scale, offset and unit of a band, as stated by files and their sidecars, and the conversion of stored
//! samples to heights in metres.

use roxmltree::Node;

use super::conversion::{Conversion, Linear};
use super::crs::unit::length_of_name;
use super::xml;

/// Properties of a band that a file, a virtual raster or a sidecar states.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct BandMetadata {
    /// Stored values of missing samples.
    pub nodata: Vec<f64>,
    /// Factor of stored samples; 1 if it is not stated.
    pub scale: Option<f64>,
    /// Number added to scaled samples; 0 if it is not stated.
    pub offset: Option<f64>,
    /// The unit of scaled samples, by name or symbol.
    pub unit: Option<String>,
    /// Metres per unit of scaled samples, if the unit is known without a name.
    pub metres: Option<f64>,
    /// The minimum and the maximum integer of a virtual raster's type, to which stored samples are rounded.
    pub whole: Option<[f64; 2]>,
}

impl BandMetadata {
    /// Reads the children `NoDataValue`, `Scale`, `Offset` and `UnitType` of a band in GDAL's XML.
    pub fn of_xml(band: Node) -> BandMetadata {
        let text = |name: &str| {
            let text = band.children().find(|node| node.has_tag_name(name)).and_then(|node| node.text());
            text.map(str::trim).filter(|text| !text.is_empty())
        };
        // Text that is not a number must not count as "not stated".
        let number = |name: &str| text(name).map(|text| text.parse().unwrap_or(f64::NAN));
        BandMetadata {
            nodata: text("NoDataValue").and_then(|text| text.parse().ok()).into_iter().collect(),
            scale: number("Scale"),
            offset: number("Offset"),
            unit: text("UnitType").map(String::from),
            metres: None,
            whole: None,
        }
    }

    /// The metadata of the band with index `band`, from 0, in the text of GDAL's TIFF tag 42112; empty if the text is
    /// not XML.
    pub fn of_tiff(metadata: &str, band: usize) -> BandMetadata {
        let Ok(document) = xml::parse(metadata, false) else { return BandMetadata::default() };
        let text = |role: &str| {
            let own = |node: &Node| {
                node.attribute("role") == Some(role) && node.attribute("sample").map_or(Ok(0), str::parse) == Ok(band)
            };
            let text = document.root_element().children().find(own).and_then(|node| node.text());
            text.map(str::trim).filter(|text| !text.is_empty())
        };
        let number = |role: &str| text(role).map(|text| text.parse().unwrap_or(f64::NAN));
        BandMetadata {
            nodata: Vec::new(),
            scale: number("scale"),
            offset: number("offset"),
            unit: text("unittype").map(String::from),
            metres: None,
            whole: None,
        }
    }

    /// Whether nothing is stated.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == BandMetadata::default()
    }

    /// Replaces what `other` states too. Nodata values are combined.
    pub fn replaced_by(mut self, other: &BandMetadata) -> BandMetadata {
        self.nodata.extend(&other.nodata);
        // A scale without an offset has an offset of 0, not the offset of the other source.
        if other.scale.is_some() || other.offset.is_some() {
            (self.scale, self.offset) = (other.scale, other.offset);
        }
        if other.unit.is_some() || other.metres.is_some() {
            (self.unit, self.metres) = (other.unit.clone(), other.metres);
        }
        self.whole = other.whole.or(self.whole);
        self
    }

    /// The metadata with another nodata value.
    pub fn with_nodata(mut self, nodata: Option<f64>) -> BandMetadata {
        self.nodata.extend(nodata);
        self
    }

    /// The conversion of samples. `vertical` is the number of metres per unit of the vertical coordinate system, which
    /// applies if the band states no unit.
    ///
    /// # Errors
    /// A message if the scale or the offset is not a number.
    pub fn conversion(&self, vertical: Option<f64>) -> Result<Conversion, String> {
        let (scale, offset) = (self.scale.unwrap_or(1.0), self.offset.unwrap_or(0.0));
        for (what, number) in [("scale", scale), ("offset", offset)] {
            if !number.is_finite() {
                return Err(format!("the {what} of its band is not a finite number"));
            }
        }
        if scale == 0.0 {
            return Err("the scale of its band is 0".into());
        }
        let unknown = self.unit.as_ref().filter(|unit| length_of_name(unit).is_none()).cloned();
        let metres = self.unit.as_deref().map_or(self.metres.or(vertical), length_of_name).unwrap_or(1.0);
        let linear = Linear { scale, offset, metres };
        Ok(Conversion::new(self.nodata.clone(), self.whole, linear, unknown))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_become_metres() {
        let feet = BandMetadata { scale: Some(0.5), offset: Some(10.0), unit: Some("ft".into()), ..Default::default() };
        let mut conversion = feet.conversion(Some(1.0)).unwrap();
        assert_eq!((conversion.height(180.0, 4), conversion.absent()), (30.48, 3.048));
        let metres = BandMetadata { unit: Some("m".into()), ..Default::default() };
        assert_eq!(metres.conversion(Some(0.3048)).unwrap().height(7.0, 4), 7.0);
        assert_eq!(BandMetadata::default().conversion(Some(0.3048)).unwrap().height(10.0, 4), 3.048);
        for scale in [f64::NAN, f64::INFINITY, 0.0] {
            let band = BandMetadata { scale: Some(scale), ..Default::default() };
            assert!(band.conversion(None).unwrap_err().contains("the scale of its band"), "{scale}");
        }
    }

    #[test]
    fn nodata_is_stored_values() {
        let band = BandMetadata { nodata: vec![-9999.0, -3.4e38], scale: Some(0.1), ..Default::default() };
        let mut conversion = band.conversion(None).unwrap();
        assert!(conversion.height(-9999.0, 2).is_nan() && conversion.height(f64::from(-3.4e38f32), 4).is_nan());
        assert!(conversion.absent().is_nan() && conversion.notes().is_empty());
    }

    #[test]
    fn undeclared_nodata_is_a_note() {
        let mut conversion = BandMetadata::default().conversion(None).unwrap();
        assert_eq!(conversion.height(-9999.0, 4), -9999.0);
        assert!(conversion.height(f64::from(f32::MIN), 4).is_nan());
        let notes = conversion.notes();
        assert!(notes.len() == 2 && notes[0].contains("are -9999") && notes[1].contains("beyond 1e30"), "{notes:?}");
        let percent = BandMetadata { unit: Some("percent".into()), ..Default::default() };
        assert!(percent.conversion(None).unwrap().notes()[0].contains("`percent`"));
    }

    #[test]
    fn samples_of_virtual_rasters_are_rounded_to_their_type() {
        // Rounded like floats that GDAL copies to bytes.
        let band =
            BandMetadata { whole: Some([0.0, 255.0]), scale: Some(2.0), nodata: vec![7.0], ..Default::default() };
        let mut conversion = band.conversion(None).unwrap();
        let heights = [1.4, 1.5, 300.0, -3.0].map(|value| conversion.height(value, 4));
        assert_eq!((heights, conversion.height(6.9, 4).is_nan()), ([2.0, 4.0, 510.0, 0.0], true));
    }

    #[test]
    fn masked_samples_are_no_note() {
        let mut conversion = BandMetadata::default().conversion(None).unwrap();
        conversion.height(-9999.0, 4);
        assert!(conversion.clone().notes_of(&[1.0, f32::NAN]).is_empty());
        assert_eq!(conversion.notes_of(&[1.0, -9999.0]).len(), 1);
    }

    #[test]
    fn metadata_is_read_and_replaced() {
        let text = "<GDALMetadata><Item name=\"SCALE\" sample=\"1\" role=\"scale\">0.5</Item>\
                    <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">ft</Item></GDALMetadata>";
        let (first, second) = (BandMetadata::of_tiff(text, 0), BandMetadata::of_tiff(text, 1));
        assert_eq!((first.unit.as_deref(), first.scale, second.scale), (Some("ft"), None, Some(0.5)));
        assert!(BandMetadata::of_tiff("x", 0).is_empty());
        let xml = "<B><NoDataValue>-1</NoDataValue><Scale>x</Scale><UnitType>m</UnitType></B>";
        let document = roxmltree::Document::parse(xml).unwrap();
        let stated = BandMetadata::of_xml(document.root_element());
        assert!(stated.scale.is_some_and(f64::is_nan) && stated.conversion(None).is_err());
        let both = first.replaced_by(&stated);
        assert_eq!((both.nodata, both.unit.as_deref(), both.offset), (vec![-1.0], Some("m"), None));
    }
}

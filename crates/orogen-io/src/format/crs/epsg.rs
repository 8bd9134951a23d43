//! Coordinate systems by EPSG code (EPSG Geodetic Parameter Dataset, IOGP): common geographic systems and UTM grids of
//! elevation data, Web Mercator, the polar grids, and national grids of many countries. Names are ESRI's, so that ESRI
//! programs recognise them.

use super::system::{Geographic, Method, System};

/// Rows of [`Geographic`].
type Row = (u16, &'static str, &'static str, &'static str, &'static str, f64, f64);

const GEOGRAPHIC: &[Row] = &[
    (4326, "GCS_WGS_1984", "D_WGS_1984", "WGS_1984", "WGS_1984", 6378137.0, 298.257223563),
    (
        4269,
        "GCS_North_American_1983",
        "D_North_American_1983",
        "North_American_Datum_1983",
        "GRS_1980",
        6378137.0,
        298.257222101,
    ),
    (
        4267,
        "GCS_North_American_1927",
        "D_North_American_1927",
        "North_American_Datum_1927",
        "Clarke_1866",
        6378206.4,
        294.978698213898,
    ),
    (
        4258,
        "GCS_ETRS_1989",
        "D_ETRS_1989",
        "European_Terrestrial_Reference_System_1989",
        "GRS_1980",
        6378137.0,
        298.257222101,
    ),
    (4230, "GCS_European_1950", "D_European_1950", "European_Datum_1950", "International_1924", 6378388.0, 297.0),
    (
        4277,
        "GCS_OSGB_1936",
        "D_OSGB_1936",
        "Ordnance_Survey_of_Great_Britain_1936",
        "Airy_1830",
        6377563.396,
        299.3249646,
    ),
    (4283, "GCS_GDA_1994", "D_GDA_1994", "Geocentric_Datum_of_Australia_1994", "GRS_1980", 6378137.0, 298.257222101),
    (7844, "GCS_GDA2020", "GDA2020", "Geocentric_Datum_of_Australia_2020", "GRS_1980", 6378137.0, 298.257222101),
    (
        4617,
        "GCS_North_American_1983_CSRS",
        "D_North_American_1983_CSRS",
        "NAD83_Canadian_Spatial_Reference_System",
        "GRS_1980",
        6378137.0,
        298.257222101,
    ),
    (4167, "GCS_NZGD_2000", "D_NZGD_2000", "New_Zealand_Geodetic_Datum_2000", "GRS_1980", 6378137.0, 298.257222101),
    (
        6318,
        "GCS_NAD_1983_2011",
        "D_NAD_1983_2011",
        "NAD83_National_Spatial_Reference_System_2011",
        "GRS_1980",
        6378137.0,
        298.257222101,
    ),
    (
        4674,
        "GCS_SIRGAS_2000",
        "D_SIRGAS_2000",
        "Sistema_de_Referencia_Geocentrico_para_las_AmericaS_2000",
        "GRS_1980",
        6378137.0,
        298.257222101,
    ),
    (
        4314,
        "GCS_Deutsches_Hauptdreiecksnetz",
        "D_Deutsches_Hauptdreiecksnetz",
        "Deutsches_Hauptdreiecksnetz",
        "Bessel_1841",
        6377397.155,
        299.1528128,
    ),
    (4312, "GCS_MGI", "D_MGI", "Militar-Geographische_Institut", "Bessel_1841", 6377397.155, 299.1528128),
    (4149, "GCS_CH1903", "D_CH1903", "CH1903", "Bessel_1841", 6377397.155, 299.1528128),
    (4150, "GCS_CH1903+", "D_CH1903+", "CH1903+", "Bessel_1841", 6377397.155, 299.1528128),
    (4171, "GCS_RGF_1993", "D_RGF_1993", "Reseau_Geodesique_Francais_1993_v1", "GRS_1980", 6378137.0, 298.257222101),
    (4612, "GCS_JGD_2000", "D_JGD_2000", "Japanese_Geodetic_Datum_2000", "GRS_1980", 6378137.0, 298.257222101),
    (6668, "GCS_JGD_2011", "D_JGD_2011", "Japanese_Geodetic_Datum_2011", "GRS_1980", 6378137.0, 298.257222101),
    (
        4490,
        "GCS_China_Geodetic_Coordinate_System_2000",
        "D_China_2000",
        "China_2000",
        "CGCS2000",
        6378137.0,
        298.257222101,
    ),
    (4289, "GCS_Amersfoort", "D_Amersfoort", "Amersfoort", "Bessel_1841", 6377397.155, 299.1528128),
    (4313, "GCS_Belge_1972", "D_Belge_1972", "Reseau_National_Belge_1972", "International_1924", 6378388.0, 297.0),
    (4322, "GCS_WGS_1972", "D_WGS_1972", "World_Geodetic_System_1972", "WGS_1972", 6378135.0, 298.26),
    (4180, "GCS_Estonia_1997", "D_Estonia_1997", "Estonia_1997", "GRS_1980", 6378137.0, 298.257222101),
    (4619, "GCS_SWEREF99", "D_SWEREF99", "SWEREF99", "GRS_1980", 6378137.0, 298.257222101),
    (
        4765,
        "GCS_Slovenia_1996",
        "D_Slovenia_Geodetic_Datum_1996",
        "Slovenia_Geodetic_Datum_1996",
        "GRS_1980",
        6378137.0,
        298.257222101,
    ),
    (4237, "GCS_Hungarian_1972", "D_Hungarian_1972", "Hungarian_Datum_1972", "GRS_1967", 6378160.0, 298.247167427),
    (4299, "GCS_TM65", "D_TM65", "TM65", "Airy_Modified", 6377340.189, 299.3249646),
    (4173, "GCS_IRENET95", "D_IRENET95", "IRENET95", "GRS_1980", 6378137.0, 298.257222101),
    (4141, "GCS_Israel", "D_Israel", "Israel_1993", "GRS_1980", 6378137.0, 298.257222101),
    (4686, "GCS_MAGNA", "D_MAGNA", "Marco_Geocentrico_Nacional_de_Referencia", "GRS_1980", 6378137.0, 298.257222101),
    (4669, "GCS_LKS_1994", "D_Lithuania_1994", "Lithuania_1994_ETRS89", "GRS_1980", 6378137.0, 298.257222101),
];

/// UTM and similar grids: the codes of the first and the last zone, the first zone, the geographic system, the name
/// before the zone's number, and the hemisphere after it.
type Zones = (u16, u16, u16, u16, &'static str, &'static str);

const ZONES: &[Zones] = &[
    (32601, 32660, 1, 4326, "WGS_1984_UTM_Zone_", "N"),
    (32701, 32760, 1, 4326, "WGS_1984_UTM_Zone_", "S"),
    (26901, 26923, 1, 4269, "NAD_1983_UTM_Zone_", "N"),
    (26701, 26722, 1, 4267, "NAD_1927_UTM_Zone_", "N"),
    (6330, 6348, 1, 6318, "NAD_1983_2011_UTM_Zone_", "N"),
    (25828, 25838, 28, 4258, "ETRS_1989_UTM_Zone_", "N"),
    (23028, 23038, 28, 4230, "ED_1950_UTM_Zone_", "N"),
    (31965, 31972, 11, 4674, "SIRGAS_2000_UTM_Zone_", "N"),
    (31977, 31985, 17, 4674, "SIRGAS_2000_UTM_Zone_", "S"),
    (28348, 28358, 48, 4283, "GDA_1994_MGA_Zone_", ""),
    (7846, 7859, 46, 7844, "GDA2020_MGA_Zone_", ""),
    (32201, 32260, 1, 4322, "WGS_1972_UTM_Zone_", "N"),
    (32301, 32360, 1, 4322, "WGS_1972_UTM_Zone_", "S"),
];

use Method::*;

/// Code, name, geographic system, projection and parameters.
type Projected = (u16, &'static str, u16, Method, &'static [f64]);

const PROJECTED: &[Projected] = &[
    (2154, "RGF_1993_Lambert_93", 4171, Lambert, &[700000.0, 6600000.0, 3.0, 49.0, 44.0, 46.5]),
    (3034, "ETRS_1989_LCC", 4258, Lambert, &[4000000.0, 2800000.0, 10.0, 35.0, 65.0, 52.0]),
    (
        3347,
        "NAD_1983_Statistics_Canada_Lambert",
        4269,
        Lambert,
        &[6200000.0, 3000000.0, -91.8666666666667, 49.0, 77.0, 63.390675],
    ),
    (3978, "NAD_1983_Canada_Atlas_Lambert", 4269, Lambert, &[0.0, 0.0, -95.0, 49.0, 77.0, 49.0]),
    (3979, "NAD_1983_CSRS_Canada_Atlas_Lambert", 4617, Lambert, &[0.0, 0.0, -95.0, 49.0, 77.0, 49.0]),
    (31287, "MGI_Austria_Lambert", 4312, Lambert, &[400000.0, 400000.0, 13.3333333333333, 49.0, 46.0, 47.5]),
    (
        31370,
        "Belge_Lambert_1972",
        4313,
        Lambert,
        &[150000.013, 5400088.438, 4.36748666666667, 51.1666672333333, 49.8333339, 90.0],
    ),
    (
        3812,
        "Belge_Lambert_2008",
        4258,
        Lambert,
        &[649328.0, 665262.0, 4.35921583333333, 49.8333333333333, 51.1666666666667, 50.797815],
    ),
    (32198, "NAD_1983_Quebec_Lambert", 4269, Lambert, &[0.0, 0.0, -68.5, 60.0, 46.0, 44.0]),
    (5243, "ETRS_1989_LCC_Germany_E-N", 4258, Lambert, &[0.0, 0.0, 10.5, 48.6666666666667, 53.6666666666667, 51.0]),
    (5070, "NAD_1983_Contiguous_USA_Albers", 4269, Albers, &[0.0, 0.0, -96.0, 29.5, 45.5, 23.0]),
    (3338, "NAD_1983_Alaska_Albers", 4269, Albers, &[0.0, 0.0, -154.0, 55.0, 65.0, 50.0]),
    (3005, "NAD_1983_BC_Environment_Albers", 4269, Albers, &[1000000.0, 0.0, -126.0, 50.0, 58.5, 45.0]),
    (3577, "GDA_1994_Australia_Albers", 4283, Albers, &[0.0, 0.0, 132.0, -18.0, -36.0, 0.0]),
    (9473, "GDA2020_Australian_Albers", 7844, Albers, &[0.0, 0.0, 132.0, -18.0, -36.0, 0.0]),
    (3035, "ETRS_1989_LAEA", 4258, AzimuthalEqualArea, &[4321000.0, 3210000.0, 10.0, 52.0]),
    (3573, "WGS_1984_North_Pole_LAEA_Canada", 4326, AzimuthalEqualArea, &[0.0, 0.0, -100.0, 90.0]),
    (6931, "WGS_1984_EASE-Grid_2.0_North", 4326, AzimuthalEqualArea, &[0.0, 0.0, 0.0, 90.0]),
    (6932, "WGS_1984_EASE-Grid_2.0_South", 4326, AzimuthalEqualArea, &[0.0, 0.0, 0.0, -90.0]),
    (27700, "British_National_Grid", 4277, TransverseMercator, &[400000.0, -100000.0, -2.0, 0.9996012717, 49.0]),
    (
        2193,
        "NZGD_2000_New_Zealand_Transverse_Mercator",
        4167,
        TransverseMercator,
        &[1600000.0, 10000000.0, 173.0, 0.9996, 0.0],
    ),
    (31466, "DHDN_3_Degree_Gauss_Zone_2", 4314, GaussKruger, &[2500000.0, 0.0, 6.0, 1.0, 0.0]),
    (31467, "DHDN_3_Degree_Gauss_Zone_3", 4314, GaussKruger, &[3500000.0, 0.0, 9.0, 1.0, 0.0]),
    (31468, "DHDN_3_Degree_Gauss_Zone_4", 4314, GaussKruger, &[4500000.0, 0.0, 12.0, 1.0, 0.0]),
    (31469, "DHDN_3_Degree_Gauss_Zone_5", 4314, GaussKruger, &[5500000.0, 0.0, 15.0, 1.0, 0.0]),
    (3067, "EUREF_FIN_TM35FIN", 4258, TransverseMercator, &[500000.0, 0.0, 27.0, 0.9996, 0.0]),
    (3006, "SWEREF99_TM", 4619, TransverseMercator, &[500000.0, 0.0, 15.0, 0.9996, 0.0]),
    (3794, "Slovenia_1996_Slovene_National_Grid", 4765, TransverseMercator, &[500000.0, -5000000.0, 15.0, 0.9999, 0.0]),
    (
        23700,
        "Hungarian_1972_Egyseges_Orszagos_Vetuleti",
        4237,
        ObliqueMercator,
        &[650000.0, 200000.0, 0.99993, 90.0, 19.0485717777778, 47.1443937222222],
    ),
    (29902, "TM65_Irish_Grid", 4299, TransverseMercator, &[200000.0, 250000.0, -8.0, 1.000035, 53.5]),
    (2157, "IRENET95_Irish_Transverse_Mercator", 4173, TransverseMercator, &[600000.0, 750000.0, -8.0, 0.99982, 53.5]),
    (
        2039,
        "Israel_TM_Grid",
        4141,
        TransverseMercator,
        &[219529.584, 626907.39, 35.2045169444444, 1.0000067, 31.7343936111111],
    ),
    (
        3116,
        "MAGNA_Colombia_Bogota",
        4686,
        TransverseMercator,
        &[1000000.0, 1000000.0, -74.0775079166667, 1.0, 4.59620041666667],
    ),
    (4647, "ETRS_1989_UTM_Zone_N32", 4258, TransverseMercator, &[32500000.0, 0.0, 9.0, 0.9996, 0.0]),
    (
        3301,
        "Estonia_1997_Estonia_National_Grid",
        4180,
        Lambert,
        &[500000.0, 6375000.0, 24.0, 59.3333333333333, 58.0, 57.5175539305556],
    ),
    (3346, "LKS_1994_Lithuania_TM", 4669, TransverseMercator, &[500000.0, 0.0, 24.0, 0.9998, 0.0]),
    (5105, "ETRS_1989_NTM_Zone_5", 4258, TransverseMercator, &[100000.0, 1000000.0, 5.5, 1.0, 58.0]),
    (3395, "WGS_1984_World_Mercator", 4326, Mercator, &[0.0, 0.0, 0.0, 0.0]),
    (3857, "WGS_1984_Web_Mercator_Auxiliary_Sphere", 4326, WebMercator, &[0.0, 0.0, 0.0, 0.0, 0.0]),
    (3413, "WGS_1984_NSIDC_Sea_Ice_Polar_Stereographic_North", 4326, NorthPole, &[0.0, 0.0, -45.0, 70.0]),
    (3031, "WGS_1984_Antarctic_Polar_Stereographic", 4326, SouthPole, &[0.0, 0.0, 0.0, -71.0]),
    (3995, "WGS_1984_Arctic_Polar_Stereographic", 4326, NorthPole, &[0.0, 0.0, 0.0, 71.0]),
    (3996, "WGS_1984_IBCAO_Polar_Stereographic", 4326, NorthPole, &[0.0, 0.0, 0.0, 75.0]),
    (3976, "WGS_1984_NSIDC_Sea_Ice_Polar_Stereographic_South", 4326, SouthPole, &[0.0, 0.0, 0.0, -70.0]),
    (28992, "RD_New", 4289, DoubleStereographic, &[155000.0, 463000.0, 5.38763888888889, 0.9999079, 52.1561605555556]),
    (
        2056,
        "CH1903+_LV95",
        4150,
        ObliqueMercator,
        &[2600000.0, 1200000.0, 1.0, 90.0, 7.43958333333333, 46.9524055555556],
    ),
    (21781, "CH1903_LV03", 4149, ObliqueMercator, &[600000.0, 200000.0, 1.0, 90.0, 7.43958333333333, 46.9524055555556]),
    (3832, "WGS_1984_PDC_Mercator", 4326, Mercator, &[0.0, 0.0, 150.0, 0.0]),
    (6703, "WGS_1984_TM_60_SW", 4326, TransverseMercator, &[500000.0, 10000000.0, -60.0, 0.9996, 0.0]),
];

/// The geographic system with this code.
pub fn geographic(code: u16) -> Option<Geographic> {
    let row = GEOGRAPHIC.iter().find(|row| row.0 == code)?;
    let (code, name, datum, datum_ogc, spheroid, radius, flattening) = *row;
    Some(Geographic { code, name, datum, datum_ogc, spheroid, radius, flattening })
}

/// The system with this code; `None` if it is not in this module.
pub fn find(code: u16) -> Option<System> {
    if let Some(geographic) = geographic(code) {
        return Some(System { name: geographic.name.to_string(), geographic, projection: None, unit: 1.0 });
    }
    if let Some((_, name, degrees, method, parameters)) = PROJECTED.iter().find(|row| row.0 == code) {
        let projection = Some((*method, parameters.to_vec()));
        return Some(System { name: name.to_string(), geographic: geographic(*degrees)?, projection, unit: 1.0 });
    }
    let (from, _, zone, degrees, name, hemisphere) = ZONES.iter().find(|row| (row.0..=row.1).contains(&code))?;
    let zone = zone + code - from;
    // Names of Australian grids have no letter; these grids are in the southern hemisphere.
    let north = *hemisphere == "N";
    let parameters = vec![500_000.0, if north { 0.0 } else { 1e7 }, f64::from(zone) * 6.0 - 183.0, 0.9996, 0.0];
    let projection = Some((TransverseMercator, parameters));
    Some(System { name: format!("{name}{zone}{hemisphere}"), geographic: geographic(*degrees)?, projection, unit: 1.0 })
}

/// The codes of all systems of this module.
pub fn codes() -> impl Iterator<Item = u16> {
    let zones = ZONES.iter().flat_map(|row| row.0..=row.1);
    GEOGRAPHIC.iter().map(|row| row.0).chain(zones).chain(PROJECTED.iter().map(|row| row.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_is_one_system() {
        let mut all: Vec<u16> = codes().collect();
        assert!(all.len() > 350, "{}", all.len());
        all.sort_unstable();
        assert!(all.windows(2).all(|pair| pair[0] != pair[1]));
        for code in all {
            let system = find(code).unwrap();
            if let Some((method, parameters)) = &system.projection {
                assert_eq!(method.terms().1.len(), parameters.len(), "{code}");
            }
        }
    }

    #[test]
    fn zones_have_their_meridians() {
        for (code, name, meridian, northing) in [
            (32632, "WGS_1984_UTM_Zone_32N", 9.0, 0.0),
            (32719, "WGS_1984_UTM_Zone_19S", -69.0, 1e7),
            (28355, "GDA_1994_MGA_Zone_55", 147.0, 1e7),
            (6339, "NAD_1983_2011_UTM_Zone_10N", -123.0, 0.0),
        ] {
            let system = find(code).unwrap();
            let (_, parameters) = system.projection.unwrap();
            assert_eq!((system.name.as_str(), parameters[2], parameters[1]), (name, meridian, northing));
        }
        assert_eq!(find(1), None);
    }
}

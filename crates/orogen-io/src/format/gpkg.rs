//! OGC GeoPackage 1.3 (OGC 12-128r17): features in an SQLite database, one table and one R-tree index per layer.

use std::io::{self, Write};

use super::features::{Crs, Definition, FeatureLayer, FieldType, GeometryType, LOCAL_WKT};
use super::gpkg_rows;
use super::sqlite::{Column, Database};

/// The application number "GPKG", and version 1.3.
const APPLICATION: u32 = 0x4750_4B47;
const VERSION: u32 = 10_300;

/// The time of the last change. It is constant, so that equal content gives equal files.
const LAST_CHANGE: &str = "1970-01-01T00:00:00.000Z";

/// The coordinate systems that every GeoPackage lists: undefined Cartesian and undefined geographic.
const LOCAL: i64 = -1;
const GEOGRAPHIC: i64 = 0;

/// The number of a system without an EPSG code; EPSG codes are smaller.
const CUSTOM: i64 = 100_000;

const WGS_84: &str = concat!(
    r#"GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],"#,
    r#"PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]]"#
);

/// Writes layers with coordinates of `crs`.
///
/// Fails if `out` fails.
pub fn write<'a>(out: &mut dyn Write, layers: impl Iterator<Item = &'a FeatureLayer>, crs: Crs) -> io::Result<()> {
    let layers: Vec<&FeatureLayer> = layers.collect();
    let layers = layers.as_slice();
    let mut database = Database::new();
    let definition = crs.definition();
    let srs = srs_id(crs, &definition);
    spatial_ref_sys(&mut database, srs, &definition)?;
    contents(&mut database, layers, srs)?;
    geometry_columns(&mut database, layers, srs)?;
    extensions(&mut database, layers)?;
    let sequence = layers
        .iter()
        .enumerate()
        .map(|(k, layer)| (k as i64 + 1, vec![Column::Text(layer.name), Column::Integer(layer.features.len() as i64)]));
    database.table("sqlite_sequence", "CREATE TABLE sqlite_sequence(name,seq)", sequence)?;
    for layer in layers {
        features(&mut database, layer, srs)?;
        index(&mut database, layer)?;
    }
    database.write(out, APPLICATION, VERSION)
}

/// The number of a coordinate system.
fn srs_id(crs: Crs, definition: &Definition) -> i64 {
    match definition {
        Definition::Epsg(code, _) => i64::from(*code),
        Definition::Wkt(_) if crs == Crs::Local => LOCAL,
        Definition::Wkt(_) => CUSTOM,
        Definition::Unknown { degrees: true } => GEOGRAPHIC,
        Definition::Unknown { degrees: false } => LOCAL,
    }
}

fn spatial_ref_sys(database: &mut Database, srs: i64, definition: &Definition) -> io::Result<()> {
    let row = |name, id, organization, definition, about| {
        let columns = vec![
            Column::Text(name),
            Column::Null,
            Column::Text(organization),
            Column::Integer(id),
            Column::Text(definition),
            Column::Text(about),
        ];
        (id, columns)
    };
    let name = format!("EPSG:{srs}");
    let mut rows = vec![
        row("Undefined Cartesian SRS", LOCAL, "NONE", LOCAL_WKT, "undefined Cartesian coordinate reference system"),
        row(
            "Undefined geographic SRS",
            GEOGRAPHIC,
            "NONE",
            "undefined",
            "undefined geographic coordinate reference system",
        ),
        row("WGS 84 geodetic", 4326, "EPSG", WGS_84, "longitude and latitude on the WGS 84 ellipsoid, in degrees"),
    ];
    if !matches!(srs, LOCAL | GEOGRAPHIC | 4326) {
        rows.push(match definition {
            Definition::Wkt(wkt) => {
                row("Coordinate system of the input", srs, "NONE", wkt, "coordinate system without EPSG code")
            }
            // Readers use the code and ignore the definition.
            Definition::Epsg(_, Some(wkt)) => row(&name, srs, "EPSG", wkt, "as the EPSG registry defines it"),
            _ => row(&name, srs, "EPSG", "undefined", "as the EPSG registry defines it"),
        });
    }
    rows.sort_by_key(|(id, _)| *id);
    let sql = "CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER NOT NULL PRIMARY KEY, organization TEXT NOT NULL, \
               organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT)";
    database.table("gpkg_spatial_ref_sys", sql, rows)
}

fn contents(database: &mut Database, layers: &[&FeatureLayer], srs: i64) -> io::Result<()> {
    let rows = layers.iter().enumerate().map(|(k, layer)| {
        let mut columns = vec![
            Column::Text(layer.name),
            Column::Text("features"),
            Column::Text(layer.name),
            Column::Text(layer.about),
            Column::Text(LAST_CHANGE),
        ];
        match layer.bounds() {
            Some(bounds) => columns.extend(bounds.map(Column::Real)),
            None => columns.extend([const { Column::Null }; 4]),
        }
        columns.push(Column::Integer(srs));
        (k as i64 + 1, columns)
    });
    let sql = "CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE, \
               description TEXT DEFAULT '', last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')), \
               min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER, \
               CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id))";
    database.table("gpkg_contents", sql, rows)?;
    // One index for the table names, one for the identifiers.
    database.unique_index("gpkg_contents", 1, keys(layers, &[]))?;
    database.unique_index("gpkg_contents", 2, keys(layers, &[]))
}

fn geometry_columns(database: &mut Database, layers: &[&FeatureLayer], srs: i64) -> io::Result<()> {
    let rows = layers.iter().enumerate().map(|(k, layer)| {
        let columns = vec![
            Column::Text(layer.name),
            Column::Text("geom"),
            Column::Text(type_name(layer.geometry)),
            Column::Integer(srs),
            Column::Integer(i64::from(layer.geometry.has_z())),
            Column::Integer(0),
        ];
        (k as i64 + 1, columns)
    });
    let sql = "CREATE TABLE gpkg_geometry_columns (table_name TEXT NOT NULL, column_name TEXT NOT NULL, geometry_type_name TEXT NOT NULL, \
               srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL, \
               CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name), CONSTRAINT uk_gc_table_name UNIQUE (table_name), \
               CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name), \
               CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id))";
    database.table("gpkg_geometry_columns", sql, rows)?;
    database.unique_index("gpkg_geometry_columns", 1, keys(layers, &["geom"]))?;
    database.unique_index("gpkg_geometry_columns", 2, keys(layers, &[]))
}

const RTREE: &str = "gpkg_rtree_index";

fn extensions(database: &mut Database, layers: &[&FeatureLayer]) -> io::Result<()> {
    let rows = layers.iter().enumerate().map(|(k, layer)| {
        let columns = vec![
            Column::Text(layer.name),
            Column::Text("geom"),
            Column::Text(RTREE),
            Column::Text("http://www.geopackage.org/spec120/#extension_rtree"),
            Column::Text("write-only"),
        ];
        (k as i64 + 1, columns)
    });
    let sql = "CREATE TABLE gpkg_extensions (table_name TEXT, column_name TEXT, extension_name TEXT NOT NULL, definition TEXT NOT NULL, \
               scope TEXT NOT NULL, CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name))";
    database.table("gpkg_extensions", sql, rows)?;
    database.unique_index("gpkg_extensions", 1, keys(layers, &["geom", RTREE]))
}

/// The layers' names with `more` columns, and their row numbers.
fn keys<'a>(layers: &[&FeatureLayer], more: &[&'a str]) -> Vec<(Vec<&'a str>, i64)> {
    let key = |(k, layer): (usize, &&FeatureLayer)| {
        let columns: Vec<&str> = [layer.name].into_iter().chain(more.iter().copied()).collect();
        (columns, k as i64 + 1)
    };
    layers.iter().enumerate().map(key).collect()
}

fn type_name(geometry: GeometryType) -> &'static str {
    match geometry {
        GeometryType::Point => "POINT",
        GeometryType::Line | GeometryType::LineZ => "LINESTRING",
        GeometryType::MultiPolygon => "MULTIPOLYGON",
    }
}

/// The table of a layer.
fn features(database: &mut Database, layer: &FeatureLayer, srs: i64) -> io::Result<()> {
    let mut sql = format!(
        "CREATE TABLE \"{}\" (\"fid\" INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, \"geom\" {}",
        layer.name,
        type_name(layer.geometry)
    );
    for field in layer.fields {
        let kind = match field.kind {
            FieldType::Integer => "INTEGER",
            FieldType::Real => "DOUBLE",
            FieldType::Boolean => "BOOLEAN",
            FieldType::Text => "TEXT",
        };
        sql.push_str(&format!(", \"{}\" {kind}", field.name));
    }
    sql.push(')');
    gpkg_rows::features(database, layer.name, &sql, &layer.features, layer.geometry, srs)
}

/// The R-tree of a layer: the tables of SQLite's module `rtree`, and triggers that keep it up to date (OGC 12-128r17,
/// annex F.3).
fn index(database: &mut Database, layer: &FeatureLayer) -> io::Result<()> {
    let (table, name) = (layer.name, format!("rtree_{}_geom", layer.name));
    let sql = format!("CREATE VIRTUAL TABLE \"{name}\" USING rtree(id, minx, maxx, miny, maxy)");
    database.declare("table", &name, &name, sql);
    gpkg_rows::index(database, &name, &layer.features)?;
    let filled = "NEW.\"geom\" NOT NULL AND NOT ST_IsEmpty(NEW.\"geom\")";
    let emptied = "(NEW.\"geom\" IS NULL OR ST_IsEmpty(NEW.\"geom\"))";
    let insert = format!(
        "INSERT OR REPLACE INTO \"{name}\" VALUES (NEW.\"fid\", ST_MinX(NEW.\"geom\"), ST_MaxX(NEW.\"geom\"), ST_MinY(NEW.\"geom\"), \
         ST_MaxY(NEW.\"geom\"));"
    );
    let delete = format!("DELETE FROM \"{name}\" WHERE id = OLD.\"fid\";");
    let (same, moved) = ("OLD.\"fid\" = NEW.\"fid\"", "OLD.\"fid\" != NEW.\"fid\"");
    for (what, event, when, action) in [
        ("insert", "INSERT", filled.to_string(), insert.clone()),
        ("update1", "UPDATE OF \"geom\"", format!("{same} AND {filled}"), insert.clone()),
        ("update2", "UPDATE OF \"geom\"", format!("{same} AND {emptied}"), delete.clone()),
        ("update3", "UPDATE", format!("{moved} AND {filled}"), format!("{delete} {insert}")),
        (
            "update4",
            "UPDATE",
            format!("{moved} AND {emptied}"),
            format!("DELETE FROM \"{name}\" WHERE id IN (OLD.\"fid\", NEW.\"fid\");"),
        ),
        ("delete", "DELETE", "OLD.\"geom\" NOT NULL".to_string(), delete.clone()),
    ] {
        let own = format!("{name}_{what}");
        let sql = format!("CREATE TRIGGER \"{own}\" AFTER {event} ON \"{table}\" WHEN {when} BEGIN {action} END");
        database.declare("trigger", &own, table, sql);
    }
    Ok(())
}

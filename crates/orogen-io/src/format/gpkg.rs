//! OGC GeoPackage 1.3 (OGC 12-128r17): features in an SQLite database, one table and one R-tree index per layer.

use std::io::{self, Write};

use super::coordinates::append_bytes;
use super::features::{Crs, Definition, FeatureLayer, FieldType, Geometry, GeometryType, LOCAL_WKT, Value};
use super::packed_tree::{Bounds, hilbert_order, levels};
use super::sqlite::{Column, Database};

/// "GPKG", and version 1.3.
const APPLICATION: u32 = 0x4750_4B47;
const VERSION: u32 = 10_300;

/// The time of the last change. It is constant, so that equal content gives equal files.
const LAST_CHANGE: &str = "1970-01-01T00:00:00.000Z";

/// Cells per node of an R-tree, and bytes of a node.
const NODE_CELLS: usize = 51;
const NODE_CELL: usize = 24;

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
            // Readers look up the code and ignore the definition.
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
    let blobs: Vec<Vec<u8>> =
        layer.features.iter().map(|feature| blob(&feature.geometry, layer.geometry, srs)).collect();
    let rows = layer.features.iter().zip(&blobs).enumerate().map(|(k, (feature, blob))| {
        let columns = [Column::Null, Column::Blob(blob)].into_iter().chain(feature.values.iter().map(column));
        (k as i64 + 1, columns.collect())
    });
    database.table(layer.name, &sql, rows)
}

/// The column of an attribute.
fn column(value: &Value) -> Column<'_> {
    match value {
        Value::Integer(number) => Column::Integer(*number),
        Value::Real(number) if number.is_finite() => Column::Real(*number),
        Value::Boolean(is) => Column::Integer(i64::from(*is)),
        Value::Text(text) => Column::Text(text),
        Value::Null | Value::Real(_) => Column::Null,
    }
}

/// A geometry in GeoPackage binary: its header with the bounds, then ISO WKB, little-endian.
fn blob(geometry: &Geometry, kind: GeometryType, srs: i64) -> Vec<u8> {
    let mut out = Vec::with_capacity(64 + geometry.vertices() * 24);
    let bounds = geometry.bounds().filter(|_| kind != GeometryType::Point);
    let empty = geometry.vertices() == 0;
    // Flags: little-endian; with or without 2D bounds; empty or not.
    out.extend_from_slice(&[b'G', b'P', 0, 1 | u8::from(bounds.is_some()) << 1 | u8::from(empty) << 4]);
    out.extend_from_slice(&(srs as i32).to_le_bytes());
    if let Some([west, south, east, north]) = bounds {
        numbers(&[west, east, south, north], &mut out);
    }
    match geometry {
        Geometry::Point(at) => {
            head(1001, &mut out);
            numbers(at, &mut out);
        }
        Geometry::Line(points) => {
            let z = kind == GeometryType::LineZ;
            head(if z { 1002 } else { 2 }, &mut out);
            count(points.len(), &mut out);
            append_bytes(points.as_flattened(), 3, 0..if z { 3 } else { 2 }, &mut out);
        }
        Geometry::MultiPolygon(parts) => {
            head(6, &mut out);
            count(parts.len(), &mut out);
            for part in parts {
                head(3, &mut out);
                count(part.len(), &mut out);
                for ring in part {
                    count(ring.len(), &mut out);
                    append_bytes(ring.as_flattened(), 2, 0..2, &mut out);
                }
            }
        }
    }
    out
}

fn head(kind: u32, out: &mut Vec<u8>) {
    out.push(1);
    out.extend_from_slice(&kind.to_le_bytes());
}

fn count(count: usize, out: &mut Vec<u8>) {
    out.extend_from_slice(&(count as u32).to_le_bytes());
}

fn numbers(numbers: &[f64], out: &mut Vec<u8>) {
    numbers.iter().for_each(|number| out.extend_from_slice(&number.to_le_bytes()));
}

/// The R-tree of a layer: the tables of SQLite's module `rtree`, and triggers that keep it up to date (OGC 12-128r17,
/// annex F.3).
fn index(database: &mut Database, layer: &FeatureLayer) -> io::Result<()> {
    let (table, name) = (layer.name, format!("rtree_{}_geom", layer.name));
    let sql = format!("CREATE VIRTUAL TABLE \"{name}\" USING rtree(id, minx, maxx, miny, maxy)");
    database.declare("table", &name, &name, sql);
    let (rows, boxes): (Vec<i64>, Vec<Bounds>) = (layer.features.iter().zip(1..))
        .filter_map(|(feature, row)| feature.geometry.bounds().map(|bounds| (row, bounds)))
        .unzip();
    let nodes = Nodes::new(&rows, &boxes);
    let shadow =
        |what: &str, columns: &str| (format!("{name}_{what}"), format!("CREATE TABLE \"{name}_{what}\"({columns})"));
    let (own, sql) = shadow("rowid", "rowid INTEGER PRIMARY KEY,nodeno");
    let pair = |(key, value): &(i64, i64)| (*key, vec![Column::Null, Column::Integer(*value)]);
    database.table(&own, &sql, nodes.rows.iter().map(pair))?;
    let (own, sql) = shadow("node", "nodeno INTEGER PRIMARY KEY,data");
    let blobs = (1..).zip(&nodes.blobs).map(|(number, blob)| (number, vec![Column::Null, Column::Blob(blob)]));
    database.table(&own, &sql, blobs)?;
    let (own, sql) = shadow("parent", "nodeno INTEGER PRIMARY KEY,parentnode");
    database.table(&own, &sql, nodes.parents.iter().map(pair))?;
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

/// The nodes of an R-tree in SQLite's format.
struct Nodes {
    /// The leaf of each row.
    rows: Vec<(i64, i64)>,
    /// The nodes, from number 1, the root.
    blobs: Vec<Vec<u8>>,
    /// The parent of each node except the root.
    parents: Vec<(i64, i64)>,
}

impl Nodes {
    fn new(rows: &[i64], boxes: &[Bounds]) -> Nodes {
        let order = hilbert_order(boxes);
        let sorted: Vec<Bounds> = order.iter().map(|k| boxes[*k]).collect();
        let levels = levels(&sorted, NODE_CELLS);
        let mut nodes = Nodes { rows: Vec::new(), blobs: Vec::new(), parents: Vec::new() };
        if levels.is_empty() {
            nodes.blobs.push(node(0, &[]));
            return nodes;
        }
        // The number of the first node of each level: 1 for the root; lower levels follow.
        let mut first = vec![1i64; levels.len()];
        for k in (0..levels.len() - 1).rev() {
            first[k] = first[k + 1] + levels[k + 1].len() as i64;
        }
        for depth in (0..levels.len()).rev() {
            let below: &[Bounds] = if depth == 0 { &sorted } else { &levels[depth - 1] };
            for (k, children) in below.chunks(NODE_CELLS).enumerate() {
                let number = first[depth] + k as i64;
                let start = k * NODE_CELLS;
                let id =
                    |i: usize| if depth == 0 { rows[order[start + i]] } else { first[depth - 1] + (start + i) as i64 };
                let cells: Vec<(i64, Bounds)> =
                    children.iter().enumerate().map(|(i, bounds)| (id(i), *bounds)).collect();
                let kept = if depth == 0 { &mut nodes.rows } else { &mut nodes.parents };
                kept.extend(cells.iter().map(|(id, _)| (*id, number)));
                // Only the root stores the depth of the tree.
                nodes.blobs.push(node(if number == 1 { depth as u16 } else { 0 }, &cells));
            }
        }
        nodes.rows.sort_unstable();
        nodes.parents.sort_unstable();
        nodes
    }
}

/// A node: depth and cells; a cell is a number and its bounds as f32, rounded outward.
fn node(depth: u16, cells: &[(i64, Bounds)]) -> Vec<u8> {
    let mut out = Vec::with_capacity(4 + NODE_CELLS * NODE_CELL);
    out.extend_from_slice(&depth.to_be_bytes());
    out.extend_from_slice(&(cells.len() as u16).to_be_bytes());
    let below =
        |value: f64| Some(value as f32).filter(|near| f64::from(*near) <= value).unwrap_or((value as f32).next_down());
    let above =
        |value: f64| Some(value as f32).filter(|near| f64::from(*near) >= value).unwrap_or((value as f32).next_up());
    for (id, [west, south, east, north]) in cells {
        out.extend_from_slice(&id.to_be_bytes());
        for corner in [below(*west), above(*east), below(*south), above(*north)] {
            out.extend_from_slice(&corner.to_be_bytes());
        }
    }
    out.resize(4 + NODE_CELLS * NODE_CELL, 0);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::features::samples;

    #[test]
    fn geometries_are_wkb_behind_their_bounds() {
        let line = Geometry::Line(vec![[1.0, 2.0, 3.0], [4.0, -5.0, 6.0]]);
        let bytes = blob(&line, GeometryType::LineZ, 32_633);
        assert_eq!(&bytes[..8], &[b'G', b'P', 0, 3, 0x79, 0x7F, 0, 0]);
        let number = |at: usize| f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
        assert_eq!([8, 16, 24, 32].map(number), [1.0, 4.0, -5.0, 2.0]);
        assert_eq!(bytes[40..49], [1, 0xEA, 3, 0, 0, 2, 0, 0, 0]);
        assert_eq!((number(49), bytes.len()), (1.0, 49 + 48));
        let point = blob(&Geometry::Point([1.0, 2.0, 3.0]), GeometryType::Point, -1);
        assert_eq!((point.len(), point[3], &point[4..8]), (8 + 5 + 24, 1, &[255; 4][..]));
        assert_eq!(blob(&Geometry::MultiPolygon(Vec::new()), GeometryType::MultiPolygon, 0)[3], 0b1_0001);
    }

    #[test]
    fn every_row_is_in_the_tree_and_every_node_holds_its_own() {
        for count in [0usize, 1, 51, 52, 3000] {
            let layer = samples::layer("a", GeometryType::LineZ, count);
            let boxes: Vec<Bounds> = layer.features.iter().map(|feature| feature.geometry.bounds().unwrap()).collect();
            let rows: Vec<i64> = (1..=count as i64).collect();
            let nodes = Nodes::new(&rows, &boxes);
            assert_eq!(nodes.rows.len(), count);
            assert_eq!(nodes.parents.len(), nodes.blobs.len() - 1);
            assert!(nodes.blobs.iter().all(|blob| blob.len() == 1228));
            for (row, leaf) in &nodes.rows {
                let blob = &nodes.blobs[*leaf as usize - 1];
                let cells = usize::from(u16::from_be_bytes([blob[2], blob[3]]));
                let cell = |k: usize| &blob[4 + k * 24..28 + k * 24];
                let found = (0..cells).map(cell).find(|cell| cell[..8] == row.to_be_bytes()).unwrap();
                let number = |k: usize| f64::from(f32::from_be_bytes(found[8 + 4 * k..12 + 4 * k].try_into().unwrap()));
                let [west, south, east, north] = boxes[*row as usize - 1];
                assert!(number(0) <= west && number(1) >= east && number(2) <= south && number(3) >= north);
            }
        }
    }
}

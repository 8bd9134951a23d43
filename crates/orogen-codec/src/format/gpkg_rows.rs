//! The rows of a GeoPackage: features, and the nodes of their R-tree.

use std::io;

use super::coordinates::append_bytes;
use super::features::{Feature, Geometry, GeometryType, Value};
use super::packed_tree::{Bounds, hilbert_order, levels};
use super::sqlite::{Column, Database};

/// Number of cells in a node of an R-tree, and number of bytes of a cell.
const NODE_CELLS: usize = 51;
const NODE_CELL: usize = 24;

/// Adds the table of features. `srs` is the number of their spatial reference system.
///
/// # Errors
/// The errors of [`Database::table`].
pub fn features(
    database: &mut Database,
    name: &str,
    sql: &str,
    features: &[Feature],
    kind: GeometryType,
    srs: i64,
) -> io::Result<()> {
    let blobs: Vec<Vec<u8>> = features.iter().map(|feature| blob(&feature.geometry, kind, srs)).collect();
    let rows = features.iter().zip(&blobs).enumerate().map(|(k, (feature, blob))| {
        let columns = [Column::Null, Column::Blob(blob)].into_iter().chain(feature.values.iter().map(column));
        (k as i64 + 1, columns.collect())
    });
    database.table(name, sql, rows)
}

/// The database value of an attribute.
fn column(value: &Value) -> Column<'_> {
    match value {
        Value::Integer(number) => Column::Integer(*number),
        Value::Real(number) if number.is_finite() => Column::Real(*number),
        Value::Boolean(is) => Column::Integer(i64::from(*is)),
        Value::Text(text) => Column::Text(text),
        Value::Null | Value::Real(_) => Column::Null,
    }
}

/// A geometry in GeoPackage binary: a header with the bounds, then ISO WKB, little-endian.
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

/// Adds the tables of the R-tree `name` of features.
///
/// # Errors
/// The errors of [`Database::table`].
pub fn index(database: &mut Database, name: &str, features: &[Feature]) -> io::Result<()> {
    let (rows, boxes): (Vec<i64>, Vec<Bounds>) = (features.iter().zip(1..))
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
    database.table(&own, &sql, nodes.parents.iter().map(pair))
}

/// The nodes of an R-tree in SQLite's format.
struct Nodes {
    /// The number of the leaf that contains each row.
    rows: Vec<(i64, i64)>,
    /// The nodes in the order of their numbers, from 1, the root.
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
        // The number of the first node of each level. The root has 1, and the lower levels follow.
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

/// A node: its depth and its cells. A cell is a number and its bounds as f32, rounded outward.
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
            let corner = |k: usize| [(k * 37 % 101) as f64 * 10.1, (k * 53 % 97) as f64 * -9.9];
            let around = |[x, y]: [f64; 2]| [x, y, x + 7.7, y + 3.3];
            let boxes: Vec<Bounds> = (0..count).map(corner).map(around).collect();
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

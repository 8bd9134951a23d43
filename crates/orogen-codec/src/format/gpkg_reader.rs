//! Reads lines and areas from OGC GeoPackage (OGC 12-128r17), and their geometries in ISO well-known binary (OGC
//! 06-103r4).
//!
//! Coordinate systems and measures are skipped, and points and attributes other than heights, which only ridges have. y
//! points north in a GeoPackage, so it is negated. The third coordinate is the height.

use orogen_grid::polylines::outline::Outline;

use super::outlines::{Collector, DrawingKind, height_rank};
use super::sqlite::Column;
use super::sqlite_reader::Reader;

/// The table that lists the layers of features.
const LAYERS: &str = "gpkg_geometry_columns";

/// Maximum depth of nested collections of geometries.
const MAX_DEPTH: usize = 8;

/// What is wrong with a geometry whose bytes end too early or have no meaning.
const DAMAGED: &str = "a geometry is damaged";

/// Reads the layer with this name into `collector`; without one, the only layer that has outlines of the requested
/// kind.
pub fn read(bytes: &[u8], layer: Option<&str>, collector: &mut Collector) -> Result<(), String> {
    let reader = Reader::new(bytes)?;
    let layers = layers(&reader)?;
    if let Some(layer) = layer {
        let Some(own) = layers.iter().find(|own| own.eq_ignore_ascii_case(layer)) else {
            return Err(format!("it has no layer `{layer}`, but {}", listed(&layers)));
        };
        return features(&reader, own, collector);
    }
    let mut used = Vec::new();
    for layer in layers {
        let before = collector.outlines.len();
        features(&reader, &layer, collector)?;
        if collector.outlines.len() > before {
            used.push(layer);
        }
    }
    match used.as_slice() {
        [] | [_] => Ok(()),
        [first, ..] => Err(format!(
            "it has {}s in {}; name one of them after the file, as in `map.gpkg|layername={first}`",
            collector.kind().word(),
            listed(&used)
        )),
    }
}

/// The names of the layers of features.
fn layers(reader: &Reader) -> Result<Vec<String>, String> {
    let Some(root) = reader.table(LAYERS)? else {
        return Err(format!("it is not a GeoPackage with features: it has no table `{LAYERS}`"));
    };
    let mut layers = Vec::new();
    reader.rows(root, &mut |row| {
        if let Some(Column::Text(name)) = row.first() {
            layers.push((*name).to_string());
        }
        Ok(())
    })?;
    Ok(layers)
}

/// Names of layers in a sentence.
fn listed(layers: &[String]) -> String {
    const MOST: usize = 12;
    match layers {
        [] => "no layers of features".into(),
        [one] => format!("the layer `{one}`"),
        _ => {
            let names: Vec<String> = layers.iter().take(MOST).map(|name| format!("`{name}`")).collect();
            let more = if layers.len() > MOST { " and others" } else { "" };
            format!("the layers {}{more}", names.join(", "))
        }
    }
}

/// Reads the features of a layer.
fn features(reader: &Reader, layer: &str, collector: &mut Collector) -> Result<(), String> {
    let Some(root) = reader.table(layer)? else {
        return Err(format!("its layer `{layer}` is no table; export it to a new file"));
    };
    let names = if collector.kind() == DrawingKind::Ridges { reader.columns(layer)? } else { Vec::new() };
    reader.rows(root, &mut |row| {
        let heights = names.iter().zip(row).filter_map(|(name, column)| {
            let height = match column {
                Column::Integer(height) => *height as f64,
                Column::Real(height) => *height,
                Column::Text(height) => height.trim().parse().ok()?,
                _ => return None,
            };
            Some((height_rank(name)?, height))
        });
        collector.height = heights.min_by_key(|(rank, _)| *rank).map(|(_, height)| height);
        // A layer has one column of geometries, and no other one has the mark of a geometry.
        let mut blobs = row.iter().filter_map(|column| match column {
            Column::Blob(blob) if blob.starts_with(b"GP") => Some(*blob),
            _ => None,
        });
        let read = blobs.next().map_or(Ok(()), |blob| feature(blob, collector));
        read.map_err(|why| format!("layer `{layer}`: {why}"))
    })
}

/// Reads a geometry in GeoPackage binary: a head, with the bounds or without them, and well-known binary.
fn feature(blob: &[u8], collector: &mut Collector) -> Result<(), String> {
    const IS_EMPTY: u8 = 1 << 4;
    const IS_EXTENDED: u8 = 1 << 5;
    let flags = *blob.get(3).ok_or(DAMAGED)?;
    if flags & IS_EMPTY != 0 {
        return Ok(());
    }
    if flags & IS_EXTENDED != 0 {
        return Err("a geometry is of an extension; convert it to lines or polygons".into());
    }
    let bounds = *[0, 32, 48, 48, 64].get(usize::from(flags >> 1 & 7)).ok_or(DAMAGED)?;
    let bytes = blob.get(8 + bounds..).ok_or(DAMAGED)?;
    Binary { bytes, at: 0 }.geometry(0, collector)
}

/// Well-known binary that is being read.
struct Binary<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Binary<'_> {
    fn geometry(&mut self, depth: usize, collector: &mut Collector) -> Result<(), String> {
        use DrawingKind::{Areas, Lines, Ridges};
        let is_little = match self.take()? {
            [0] => false,
            [1] => true,
            [_] => return Err(DAMAGED.into()),
        };
        let kind = self.count(is_little)?;
        // 1000 is added with z, 2000 with a measure, 3000 with both.
        let (kind, dimensions) = (kind % 1000, kind / 1000);
        let shape = Shape {
            is_little,
            size: *[2, 3, 3, 4].get(dimensions as usize).ok_or(DAMAGED)?,
            has_z: dimensions % 2 == 1,
        };
        match kind {
            1 if collector.kind() == Ridges => {
                let point = self.point(shape)?;
                // An empty point has no numbers.
                let is_there = point.iter().all(|number| !number.is_nan());
                collector.take(&[Ridges], is_there.then(|| Outline::of_points(&[point])).into_iter().collect())
            }
            1 => self.skip(8 * shape.size),
            2 => {
                let line = self.points(shape)?;
                collector.take(&[Lines], line.into_iter().collect())
            }
            3 => {
                let mut rings = Vec::new();
                for _ in 0..self.count(is_little)? {
                    rings.extend(self.points(shape)?);
                }
                collector.take(&[Areas], rings)
            }
            4..=7 if depth < MAX_DEPTH => {
                for _ in 0..self.count(is_little)? {
                    self.geometry(depth + 1, collector)?;
                }
                Ok(())
            }
            8..=14 => Err("a geometry has arcs; convert its curves to lines of points".into()),
            15..=17 => Err("a geometry is a surface of triangles; convert it to polygons".into()),
            _ => Err(DAMAGED.into()),
        }
    }

    /// The points of a line or ring, if it has any.
    fn points(&mut self, shape: Shape) -> Result<Option<Outline>, String> {
        let count = self.count(shape.is_little)? as usize;
        let mut points = Vec::with_capacity(count.min(self.bytes.len() / 16));
        for _ in 0..count {
            points.push(self.point(shape)?);
        }
        Ok((count > 0).then(|| Outline::of_points(&points)))
    }

    fn point(&mut self, shape: Shape) -> Result<[f64; 3], String> {
        let mut point = [0.0; 4];
        for number in &mut point[..shape.size] {
            let bytes = self.take()?;
            *number = if shape.is_little { f64::from_le_bytes(bytes) } else { f64::from_be_bytes(bytes) };
        }
        let [x, y, z, _] = point;
        Ok([x, -y, if shape.has_z { z } else { 0.0 }])
    }

    fn count(&mut self, is_little: bool) -> Result<u32, String> {
        let bytes = self.take()?;
        Ok(if is_little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let part = self.bytes.get(self.at..self.at + N).ok_or(DAMAGED)?;
        self.at += N;
        <[u8; N]>::try_from(part).map_err(|_| DAMAGED.into())
    }

    fn skip(&mut self, bytes: usize) -> Result<(), String> {
        self.at += bytes;
        if self.at <= self.bytes.len() { Ok(()) } else { Err(DAMAGED.into()) }
    }
}

/// How the points of a geometry are stored.
#[derive(Clone, Copy)]
struct Shape {
    is_little: bool,
    /// Numbers of a point.
    size: usize,
    has_z: bool,
}

//! FlatGeobuf 3.0 (flatgeobuf.org): one layer of features after a packed Hilbert R-tree.

use std::io::{self, Write};

use super::coordinates::append_bytes;
use super::features::{Crs, Definition, Feature, FeatureLayer, FieldType, Geometry, GeometryType, LOCAL_NAME, Value};
use super::flatbuffer::{Builder, Offset, Slot};
use super::packed_tree::{Bounds, hilbert_order, levels};

const MAGIC: [u8; 8] = [0x66, 0x67, 0x62, 0x03, 0x66, 0x67, 0x62, 0x01];

/// Entries of a node of the R-tree.
const FANOUT: usize = 16;

/// Numbers of the geometry types.
const POINT: u8 = 1;
const LINE: u8 = 2;
const POLYGON: u8 = 3;
const MULTI_POLYGON: u8 = 6;

/// Writes a layer with coordinates of `crs`. Features are in the order of a Hilbert curve.
///
/// Fails if `out` fails.
pub fn write(out: &mut dyn Write, layer: &FeatureLayer, crs: Crs) -> io::Result<()> {
    // Features without vertices cannot be in the index.
    let there: Vec<&Feature> = layer.features.iter().filter(|feature| feature.geometry.vertices() > 0).collect();
    let boxes: Vec<Bounds> = there.iter().filter_map(|feature| feature.geometry.bounds()).collect();
    let order = hilbert_order(&boxes);
    out.write_all(&MAGIC)?;
    out.write_all(&head(layer, order.len(), crs))?;
    let packed: Vec<Vec<u8>> = order.iter().map(|k| packed(there[*k], layer)).collect();
    let sorted: Vec<Bounds> = order.iter().map(|k| boxes[*k]).collect();
    let levels = levels(&sorted, FANOUT);
    let mut node = |bounds: &Bounds, leads_to: u64| {
        bounds.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))?;
        out.write_all(&leads_to.to_le_bytes())
    };
    // The root first, each node with the number of its first child; last the boxes of features, each with its byte
    // offset.
    let mut first_child = 0u64;
    for (depth, level) in levels.iter().enumerate().rev() {
        first_child += level.len() as u64;
        let below = if depth == 0 { sorted.len() } else { levels[depth - 1].len() };
        debug_assert_eq!(below.div_ceil(FANOUT), level.len());
        for (k, bounds) in level.iter().enumerate() {
            node(bounds, first_child + (k * FANOUT) as u64)?;
        }
    }
    let mut at = 0u64;
    for (bounds, bytes) in sorted.iter().zip(&packed) {
        node(bounds, at)?;
        at += bytes.len() as u64;
    }
    packed.iter().try_for_each(|bytes| out.write_all(bytes))
}

/// The header of the file.
fn head(layer: &FeatureLayer, count: usize, crs: Crs) -> Vec<u8> {
    let mut builder = Builder::new();
    let name = builder.text(layer.name);
    let about = builder.text(layer.about);
    let columns: Vec<Offset> = (layer.fields.iter())
        .map(|field| {
            let (name, about) = (builder.text(field.name), builder.text(field.about));
            let kind = match field.kind {
                FieldType::Boolean => 2,
                FieldType::Integer => 7,
                FieldType::Real => 10,
                FieldType::Text => 11,
            };
            builder.table(&[Slot::Reference(name), Slot::Byte(kind), Slot::Absent, Slot::Reference(about)])
        })
        .collect();
    let columns = builder.references(&columns);
    let crs = match crs.definition() {
        Definition::Epsg(code, _) => {
            let organization = builder.text("EPSG");
            Slot::Reference(builder.table(&[Slot::Reference(organization), Slot::Int(i32::from(code))]))
        }
        Definition::Wkt(wkt) => {
            let name = match crs {
                Crs::Local => Slot::Reference(builder.text(LOCAL_NAME)),
                Crs::Map(_) => Slot::Absent,
            };
            let wkt = Slot::Reference(builder.text(&wkt));
            Slot::Reference(builder.table(&[Slot::Absent, Slot::Absent, name, Slot::Absent, wkt]))
        }
        Definition::Unknown { .. } => Slot::Absent,
    };
    let envelope = match layer.bounds() {
        Some(bounds) => Slot::Reference(builder.numbers(&bounds.map(f64::to_le_bytes).concat())),
        None => Slot::Absent,
    };
    let kind = match layer.geometry {
        GeometryType::Point => POINT,
        GeometryType::Line | GeometryType::LineZ => LINE,
        GeometryType::MultiPolygon => MULTI_POLYGON,
    };
    let root = builder.table(&[
        Slot::Reference(name),
        envelope,
        Slot::Byte(kind),
        if layer.geometry.has_z() { Slot::Byte(1) } else { Slot::Absent },
        Slot::Absent,
        Slot::Absent,
        Slot::Absent,
        Slot::Reference(columns),
        Slot::Long(count as u64),
        // Without features there is no index.
        Slot::Short(if count > 0 { FANOUT as u16 } else { 0 }),
        crs,
        Slot::Absent,
        Slot::Reference(about),
    ]);
    builder.finish(root)
}

/// A feature.
fn packed(feature: &Feature, layer: &FeatureLayer) -> Vec<u8> {
    let mut builder = Builder::new();
    let geometry = match &feature.geometry {
        Geometry::Point(at) => points(&mut builder, &[*at], true),
        Geometry::Line(line) => points(&mut builder, line, layer.geometry.has_z()),
        Geometry::MultiPolygon(parts) => {
            let parts: Vec<Offset> = (parts.iter())
                .map(|part| {
                    let ends: Vec<u32> = (part.iter())
                        .scan(0, |end, ring| {
                            *end += ring.len() as u32;
                            Some(*end)
                        })
                        .collect();
                    let ends = if ends.len() > 1 { Slot::Reference(builder.wholes(&ends)) } else { Slot::Absent };
                    let mut xy = Vec::new();
                    part.iter().for_each(|ring| append_bytes(ring.as_flattened(), 2, 0..2, &mut xy));
                    let xy = builder.numbers(&xy);
                    let slots = [ends, Slot::Reference(xy)].into_iter().chain([Slot::Absent; 4]);
                    builder.table(&slots.chain([Slot::Byte(POLYGON)]).collect::<Vec<Slot>>())
                })
                .collect();
            let parts = builder.references(&parts);
            let slots = [Slot::Absent; 6].into_iter().chain([Slot::Byte(MULTI_POLYGON), Slot::Reference(parts)]);
            builder.table(&slots.collect::<Vec<Slot>>())
        }
    };
    let mut values = Vec::new();
    for (column, value) in feature.values.iter().enumerate() {
        if matches!(value, Value::Null) || matches!(value, Value::Real(number) if !number.is_finite()) {
            continue;
        }
        values.extend_from_slice(&(column as u16).to_le_bytes());
        match value {
            Value::Integer(number) => values.extend_from_slice(&number.to_le_bytes()),
            Value::Real(number) => values.extend_from_slice(&number.to_le_bytes()),
            Value::Boolean(is) => values.push(u8::from(*is)),
            Value::Text(text) => {
                values.extend_from_slice(&(text.len() as u32).to_le_bytes());
                values.extend_from_slice(text.as_bytes());
            }
            Value::Null => {}
        }
    }
    let values = builder.bytes(&values);
    let root = builder.table(&[Slot::Reference(geometry), Slot::Reference(values)]);
    builder.finish(root)
}

fn points(builder: &mut Builder, points: &[[f64; 3]], z: bool) -> Offset {
    let mut bytes = Vec::new();
    append_bytes(points.as_flattened(), 3, 0..2, &mut bytes);
    let xy = builder.numbers(&bytes);
    bytes.clear();
    append_bytes(points.as_flattened(), 3, 2..3, &mut bytes);
    let heights = if z { Slot::Reference(builder.numbers(&bytes)) } else { Slot::Absent };
    builder.table(&[Slot::Absent, Slot::Reference(xy), heights])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::features::samples;

    #[test]
    fn every_feature_is_where_the_index_says() {
        for count in [0usize, 1, 16, 17, 300] {
            let layer = samples::layer("a", GeometryType::LineZ, count);
            let mut bytes = Vec::new();
            write(&mut bytes, &layer, Crs::Local).unwrap();
            let four = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
            let index = 8 + 4 + four(8);
            let mut nodes = vec![count];
            while count > 0 && (nodes.len() == 1 || *nodes.last().unwrap() > 1) {
                nodes.push(nodes.last().unwrap().div_ceil(FANOUT));
            }
            let all: usize = nodes.iter().sum();
            let features = index + 40 * all;
            let mut at = features;
            for k in 0..count {
                let leaf = index + 40 * (all - count + k);
                let offset = u64::from_le_bytes(bytes[leaf + 32..leaf + 40].try_into().unwrap()) as usize;
                assert_eq!(features + offset, at);
                at += 4 + four(at);
            }
            assert_eq!(at, bytes.len());
            if count > 16 {
                // The root's first child is the node after it.
                assert_eq!(bytes[index + 32..index + 40], 1u64.to_le_bytes());
            }
        }
    }
}

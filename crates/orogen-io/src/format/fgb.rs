//! FlatGeobuf 3.0 (flatgeobuf.org): one layer of features after a packed Hilbert R-tree.

use std::io::{self, Write};

use super::features::{Crs, Definition, FeatureLayer, FieldType, GeometryType, LOCAL_NAME};
use super::flatbuffer::{Builder, Offset, Slot};
use super::sorted_features::{FANOUT, MULTI_POLYGON, Sorted};

const MAGIC: [u8; 8] = [0x66, 0x67, 0x62, 0x03, 0x66, 0x67, 0x62, 0x01];

/// Numbers of the geometry types.
const POINT: u8 = 1;
const LINE: u8 = 2;

/// Writes a layer with coordinates of `crs`. Features are written in the order of a Hilbert curve.
///
/// Fails if `out` fails.
pub fn write(out: &mut dyn Write, layer: &FeatureLayer, crs: Crs) -> io::Result<()> {
    let sorted = Sorted::of(&layer.features);
    out.write_all(&MAGIC)?;
    out.write_all(&head(layer, sorted.features.len(), crs))?;
    sorted.write(out, layer.geometry.has_z())
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

//! The index and the features of a FlatGeobuf file.

use std::io::{self, Write};

use super::coordinates::append_bytes;
use super::features::{Feature, Geometry, Value};
use super::flatbuffer::{Builder, Offset, Slot};
use super::packed_tree::{Bounds, hilbert_order, levels};

/// Number of children per node of the index.
pub const FANOUT: usize = 16;

/// Geometry types of FlatGeobuf.
const POLYGON: u8 = 3;
/// The geometry type of several polygons.
pub const MULTI_POLYGON: u8 = 6;

/// Features in the order of a Hilbert curve.
pub struct Sorted<'a> {
    /// The features.
    pub features: Vec<&'a Feature>,
    boxes: Vec<Bounds>,
}

impl<'a> Sorted<'a> {
    /// Sorts the features that have vertices. Others are left out, because they cannot be in the index.
    #[must_use]
    pub fn of(features: &'a [Feature]) -> Sorted<'a> {
        let there: Vec<&Feature> = features.iter().filter(|feature| feature.geometry.vertices() > 0).collect();
        let boxes: Vec<Bounds> = there.iter().filter_map(|feature| feature.geometry.bounds()).collect();
        let order = hilbert_order(&boxes);
        let features = order.iter().map(|k| there[*k]).collect();
        Sorted { features, boxes: order.iter().map(|k| boxes[*k]).collect() }
    }

    /// Writes the index and the features, with or without heights.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write(&self, out: &mut dyn Write, has_z: bool) -> io::Result<()> {
        let packed: Vec<Vec<u8>> = self.features.iter().map(|feature| packed(feature, has_z)).collect();
        let sorted = &self.boxes;
        let levels = levels(sorted, FANOUT);
        let mut node = |bounds: &Bounds, leads_to: u64| {
            bounds.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))?;
            out.write_all(&leads_to.to_le_bytes())
        };
        // The root comes first, each node with the number of its first child. The boxes of features come last, each
        // with its byte offset.
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
}

/// The bytes of a feature.
fn packed(feature: &Feature, has_z: bool) -> Vec<u8> {
    let mut builder = Builder::new();
    let geometry = match &feature.geometry {
        Geometry::Point(at) => points(&mut builder, &[*at], true),
        Geometry::Line(line) => points(&mut builder, line, has_z),
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

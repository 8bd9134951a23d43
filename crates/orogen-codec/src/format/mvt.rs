//! Vector tiles (Mapbox Vector Tile Specification 2.1): layers of points, lines and polygons in the coordinates of a
//! tile, as a message of protocol buffers.

use std::collections::HashMap;

use super::features::Value;

/// A layer of a tile.
#[derive(Debug, Clone, PartialEq)]
pub struct TileLayer<'a> {
    /// The name.
    pub name: &'a str,
    /// Units along the side of the tile.
    pub extent: u32,
    /// The names of the attributes.
    pub fields: Vec<&'a str>,
    /// The features.
    pub features: Vec<TileFeature>,
}

/// A feature of a tile: its geometry, and one value per field. A [`Value::Null`] is left out.
#[derive(Debug, Clone, PartialEq)]
pub struct TileFeature {
    /// The geometry.
    pub geometry: TileGeometry,
    /// The values.
    pub values: Vec<Value>,
}

/// A geometry in units of the tile: x to the east, y to the south.
#[derive(Debug, Clone, PartialEq)]
pub enum TileGeometry {
    /// Points.
    Points(Vec<[i32; 2]>),
    /// Lines of at least two points.
    Lines(Vec<Vec<[i32; 2]>>),
    /// Rings of at least three points, without the first one again at the end: outer rings with a positive area
    /// (clockwise with north up), each followed by its holes with a negative one.
    Rings(Vec<Vec<[i32; 2]>>),
}

/// Commands of geometries.
const MOVE: u32 = 1;
const LINE: u32 = 2;
const CLOSE: u32 = 7;

/// Types of protocol buffers: a number of variable length, 8 bytes, a length with that many bytes, 4 bytes.
const VARINT: u32 = 0;
const FIXED64: u32 = 1;
const BYTES: u32 = 2;
const FIXED32: u32 = 5;

/// The tile with these layers. A layer without features is left out, so a tile without any has no bytes.
#[must_use]
pub fn encode(layers: &[TileLayer]) -> Vec<u8> {
    let mut tile = Vec::new();
    for layer in layers.iter().filter(|layer| !layer.features.is_empty()) {
        append_bytes(&mut tile, 3, &encode_layer(layer));
    }
    tile
}

fn encode_layer(layer: &TileLayer) -> Vec<u8> {
    let mut bytes = Vec::new();
    append_key(&mut bytes, 15, VARINT);
    append_varint(&mut bytes, 2);
    append_bytes(&mut bytes, 1, layer.name.as_bytes());
    // The names and the values that occur, in the order in which they do.
    let (mut keys, mut values) = (Vec::new(), Vec::new());
    let mut key_of: Vec<Option<u32>> = vec![None; layer.fields.len()];
    let mut value_of: HashMap<Vec<u8>, u32> = HashMap::new();
    let mut tags = Vec::new();
    for feature in &layer.features {
        tags.clear();
        for (field, value) in feature.values.iter().enumerate().take(layer.fields.len()) {
            let Some(value) = encode_value(value) else { continue };
            let key = *key_of[field].get_or_insert_with(|| {
                keys.push(layer.fields[field]);
                keys.len() as u32 - 1
            });
            let next = values.len() as u32;
            let number = *value_of.entry(value).or_insert_with_key(|value| {
                values.push(value.clone());
                next
            });
            append_varint(&mut tags, u64::from(key));
            append_varint(&mut tags, u64::from(number));
        }
        let (kind, geometry) = encode_geometry(&feature.geometry);
        let mut message = Vec::with_capacity(geometry.len() + tags.len() + 8);
        append_bytes(&mut message, 2, &tags);
        append_key(&mut message, 3, VARINT);
        append_varint(&mut message, kind);
        append_bytes(&mut message, 4, &geometry);
        append_bytes(&mut bytes, 2, &message);
    }
    keys.iter().for_each(|key| append_bytes(&mut bytes, 3, key.as_bytes()));
    values.iter().for_each(|value| append_bytes(&mut bytes, 4, value));
    append_key(&mut bytes, 5, VARINT);
    append_varint(&mut bytes, u64::from(layer.extent));
    bytes
}

/// The message of a value; `None` without one. Numbers that f32 has exactly are floats.
fn encode_value(value: &Value) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    match value {
        Value::Text(text) => append_bytes(&mut bytes, 1, text.as_bytes()),
        Value::Real(number) if f64::from(*number as f32) == *number => {
            append_key(&mut bytes, 2, FIXED32);
            bytes.extend((*number as f32).to_le_bytes());
        }
        Value::Real(number) if number.is_finite() => {
            append_key(&mut bytes, 3, FIXED64);
            bytes.extend(number.to_le_bytes());
        }
        Value::Integer(number) if *number >= 0 => {
            append_key(&mut bytes, 5, VARINT);
            append_varint(&mut bytes, *number as u64);
        }
        Value::Integer(number) => {
            append_key(&mut bytes, 6, VARINT);
            append_varint(&mut bytes, ((number << 1) ^ (number >> 63)) as u64);
        }
        Value::Boolean(is) => {
            append_key(&mut bytes, 7, VARINT);
            append_varint(&mut bytes, u64::from(*is));
        }
        Value::Null | Value::Real(_) => return None,
    }
    Some(bytes)
}

/// The type of a geometry, and its commands.
fn encode_geometry(geometry: &TileGeometry) -> (u64, Vec<u8>) {
    let mut commands = Commands { bytes: Vec::new(), at: [0, 0] };
    let kind = match geometry {
        TileGeometry::Points(points) => {
            commands.push(MOVE, points);
            1
        }
        TileGeometry::Lines(lines) => {
            lines.iter().for_each(|line| commands.path(line));
            2
        }
        TileGeometry::Rings(rings) => {
            for ring in rings {
                commands.path(ring);
                commands.command(CLOSE, 1);
            }
            3
        }
    };
    (kind, commands.bytes)
}

/// Commands with positions relative to the last one.
struct Commands {
    bytes: Vec<u8>,
    at: [i32; 2],
}

impl Commands {
    fn command(&mut self, command: u32, count: usize) {
        append_varint(&mut self.bytes, (count as u64) << 3 | u64::from(command));
    }

    fn push(&mut self, command: u32, points: &[[i32; 2]]) {
        self.command(command, points.len());
        for point in points {
            for (unit, last) in point.iter().zip(self.at) {
                let step = unit.wrapping_sub(last);
                append_varint(&mut self.bytes, u64::from(((step << 1) ^ (step >> 31)) as u32));
            }
            self.at = *point;
        }
    }

    fn path(&mut self, points: &[[i32; 2]]) {
        let (first, rest) = points.split_at(points.len().min(1));
        self.push(MOVE, first);
        self.push(LINE, rest);
    }
}

fn append_key(bytes: &mut Vec<u8>, field: u32, kind: u32) {
    append_varint(bytes, u64::from(field << 3 | kind));
}

fn append_bytes(bytes: &mut Vec<u8>, field: u32, content: &[u8]) {
    append_key(bytes, field, BYTES);
    append_varint(bytes, content.len() as u64);
    bytes.extend_from_slice(content);
}

/// Appends a number in groups of 7 bits, the lowest first.
pub fn append_varint(bytes: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_examples_of_the_specification() {
        // Section 4.3.5 of the specification.
        let of = |geometry: TileGeometry| {
            let (kind, bytes) = encode_geometry(&geometry);
            (kind, bytes.into_iter().map(u32::from).collect::<Vec<_>>())
        };
        assert_eq!(of(TileGeometry::Points(vec![[25, 17]])), (1, vec![9, 50, 34]));
        assert_eq!(of(TileGeometry::Points(vec![[5, 7], [3, 2]])), (1, vec![17, 10, 14, 3, 9]));
        assert_eq!(
            of(TileGeometry::Lines(vec![vec![[2, 2], [2, 10], [10, 10]]])),
            (2, vec![9, 4, 4, 18, 0, 16, 16, 0])
        );
        assert_eq!(
            of(TileGeometry::Lines(vec![vec![[2, 2], [2, 10], [10, 10]], vec![[1, 1], [3, 5]]])),
            (2, vec![9, 4, 4, 18, 0, 16, 16, 0, 9, 17, 17, 10, 4, 8])
        );
        assert_eq!(
            of(TileGeometry::Rings(vec![vec![[3, 6], [8, 12], [20, 34]]])),
            (3, vec![9, 6, 12, 18, 10, 12, 24, 44, 15])
        );
    }

    #[test]
    fn values_are_stored_once_and_empty_layers_not_at_all() {
        let feature = |values: Vec<Value>| TileFeature { geometry: TileGeometry::Points(vec![[1, 2]]), values };
        let layer = |features| TileLayer { name: "a", extent: 4096, fields: vec!["none", "x", "y"], features };
        assert!(encode(&[layer(Vec::new())]).is_empty());
        let values = || vec![Value::Null, Value::Real(0.5), Value::Integer(-2)];
        let once = encode(&[layer(vec![feature(values())])]);
        assert_eq!(
            once,
            [
                &[0x1a, 51][..],
                &[0x78, 2, 0x0a, 1, b'a'],
                // The feature: tags, type, geometry.
                &[0x12, 13, 0x12, 4, 0, 0, 1, 1, 0x18, 1, 0x22, 3, 9, 2, 4],
                &[0x1a, 1, b'x', 0x1a, 1, b'y'],
                &[0x22, 5, 0x15, 0, 0, 0, 0x3f, 0x22, 2, 0x30, 3],
                &[0x28, 0x80, 0x20],
            ]
            .concat()
            .iter()
            .copied()
            .enumerate()
            .map(|(k, byte)| if k == 1 { once.len() as u8 - 2 } else { byte })
            .collect::<Vec<u8>>()
        );
        let twice = encode(&[layer(vec![feature(values()), feature(values())])]);
        assert_eq!(twice.len(), once.len() + 15);
    }

    #[test]
    fn numbers_keep_their_value() {
        assert_eq!(encode_value(&Value::Real(0.1)).unwrap()[0], 0x19);
        assert_eq!(encode_value(&Value::Real(2500.0)).unwrap()[0], 0x15);
        assert_eq!(encode_value(&Value::Real(f64::NAN)), None);
        assert_eq!(encode_value(&Value::Integer(300)).unwrap(), [0x28, 0xac, 2]);
        assert_eq!(encode_value(&Value::Boolean(true)).unwrap(), [0x38, 1]);
        assert_eq!(encode_value(&Value::text("sea")).unwrap(), [0x0a, 3, b's', b'e', b'a']);
    }
}

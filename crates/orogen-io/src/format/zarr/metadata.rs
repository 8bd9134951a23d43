//! What arrays and groups say of themselves: the text of `zarr.json`.

use serde_json::{Map, Value, json};

use super::blosc;

/// What a chunk holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    /// f32; samples without a value are NaN.
    F32,
    /// f64.
    F64,
}

impl Number {
    /// Bytes.
    pub fn size(self) -> u8 {
        match self {
            Number::F32 => 4,
            Number::F64 => 8,
        }
    }
}

/// An array: its sides, the sides of its chunks, what the sides are called, and what it says of itself.
#[derive(Debug, Clone)]
pub struct Array<'a> {
    /// Samples along each side, rows first.
    pub shape: &'a [usize],
    /// Samples of a chunk along each side.
    pub chunk: &'a [usize],
    /// What the sides are called.
    pub sides: &'a [&'a str],
    /// What it holds.
    pub number: Number,
    /// Its attributes.
    pub attributes: Value,
}

/// The metadata of an array. Its chunks are at `c/ROW/COLUMN` beside it.
pub fn array(array: &Array) -> Value {
    let Array { shape, chunk, sides, number, attributes } = array;
    let (name, fill) = match number {
        Number::F32 => ("float32", json!("NaN")),
        Number::F64 => ("float64", json!(0.0)),
    };
    json!({
        "zarr_format": 3,
        "node_type": "array",
        "shape": shape,
        "data_type": name,
        "chunk_grid": { "name": "regular", "configuration": { "chunk_shape": chunk } },
        "chunk_key_encoding": { "name": "default", "configuration": { "separator": "/" } },
        "fill_value": fill,
        "codecs": [
            { "name": "bytes", "configuration": { "endian": "little" } },
            {
                "name": "blosc",
                "configuration": {
                    "typesize": number.size(), "cname": "zlib", "clevel": blosc::LEVEL, "shuffle": "shuffle", "blocksize": 0,
                },
            },
        ],
        "dimension_names": sides,
        "attributes": attributes,
    })
}

/// The metadata of a group with these arrays in it. It holds a copy of theirs, as zarr-python consolidates it, so that one file tells
/// all; readers that do not know of that look for each.
pub fn group(arrays: &[(String, Value)], attributes: Value) -> Value {
    let members: Map<String, Value> = arrays.iter().cloned().collect();
    json!({
        "zarr_format": 3,
        "node_type": "group",
        "attributes": attributes,
        "consolidated_metadata": { "kind": "inline", "must_understand": false, "metadata": members },
    })
}

//! Metadata of arrays and groups: the text of `zarr.json`.

use serde_json::{Map, Value, json};

use super::blosc;

/// The data type of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Number {
    /// f32; the fill value is NaN.
    F32,
    /// f64.
    F64,
}

impl Number {
    /// Bytes per number.
    #[must_use]
    pub fn size(self) -> u8 {
        match self {
            Number::F32 => 4,
            Number::F64 => 8,
        }
    }
}

/// The description of an array.
#[derive(Debug, Clone)]
pub struct Array<'a> {
    /// Number of samples along each dimension, rows first.
    pub shape: &'a [usize],
    /// Number of samples of a chunk along each dimension.
    pub chunk: &'a [usize],
    /// Names of the dimensions.
    pub sides: &'a [&'a str],
    /// The data type.
    pub number: Number,
    /// The attributes.
    pub attributes: Value,
}

/// The metadata of an array. Its chunks are at `c/ROW/COLUMN` relative to it.
#[must_use]
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

/// The metadata of a group with these arrays. It includes a copy of the arrays' metadata (consolidated metadata of
/// zarr-python), so that one file suffices for readers that support it; other readers read the metadata of each array.
#[must_use]
pub fn group(arrays: &[(String, Value)], attributes: Value) -> Value {
    let members: Map<String, Value> = arrays.iter().cloned().collect();
    json!({
        "zarr_format": 3,
        "node_type": "group",
        "attributes": attributes,
        "consolidated_metadata": { "kind": "inline", "must_understand": false, "metadata": members },
    })
}

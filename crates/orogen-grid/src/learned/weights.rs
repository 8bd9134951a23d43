//! The file of a network: a header of lines, an empty line, and the weights as 32-bit floats with the least significant
//! byte first.
//!
//! ```text
//! orogen network 1
//! channels 32
//! layers 4
//! cells 60 180
//! licence CC0-1.0
//! land the Bernese Alps, Switzerland
//! sha256 (of the weights, in hexadecimal)
//! ```
//!
//! `cells` are the smallest and the largest fine cell of the land in training, in metres. `land` and unknown lines may
//! be repeated. With `rivers yes` the network also reads the beds of rivers and their drainage areas.

use super::convolution::{Convolution, TAPS};
use crate::error::{Error, ErrorKind, Result};
use sha2::{Digest, Sha256};

/// First line of the files; the number is that of the format.
const FORMAT: &str = "orogen network 1";
/// Maximum length of the header in bytes.
const MAX_HEADER: usize = 1 << 16;
/// Features of the heights, before the noise.
pub const FEATURES: usize = 6;
/// Planes of noise.
pub const NOISES: usize = 4;
/// Number of fine samples in a coarse cell.
pub const PHASES: usize = 4;
/// What the network reads of rivers at a coarse sample: for each of its fine ones, the bed and the drainage area.
pub const OF_RIVERS: usize = 2 * PHASES;
/// Channels are a multiple of this number, the lanes of the widest SIMD level, and at most [`MAX_CHANNELS`].
const CHANNEL_STEP: usize = 16;
const MAX_CHANNELS: usize = 256;
/// Maximum number of layers. Each reads one more coarse sample on each side.
const MAX_LAYERS: usize = 16;

/// The numbers of a network.
#[derive(Debug, Clone, PartialEq)]
pub struct Weights {
    /// Channels of each hidden layer.
    pub channels: usize,
    /// Whether the network reads rivers.
    pub rivers: bool,
    pub layers: Vec<Convolution>,
    /// Weights from each channel to the fine samples of a coarse cell, and what is added to them.
    pub phases: Vec<[f32; PHASES]>,
    pub offsets: [f32; PHASES],
    /// Smallest and largest fine cell in training, in metres.
    pub cells: [f64; 2],
}

fn broken(what: impl std::fmt::Display) -> Error {
    Error::new(ErrorKind::File, format!("not a network for learned detail: {what}"))
}

impl Weights {
    /// Reads a file.
    ///
    /// # Errors
    /// If the file is none of a network, of another format, incomplete, or its weights are not those of its hash.
    pub fn parse(file: &[u8]) -> Result<Weights> {
        let header = file.get(..file.len().min(MAX_HEADER)).unwrap_or_default();
        let end = header.windows(2).position(|pair| pair == b"\n\n").ok_or_else(|| broken("it has no header"))?;
        let (header, body) = (&file[..end], &file[end + 2..]);
        let header = std::str::from_utf8(header).map_err(|_| broken("its header is not UTF-8"))?;
        let mut lines = header.lines();
        if lines.next() != Some(FORMAT) {
            return Err(broken(format!("its first line is not `{FORMAT}`")));
        }
        let fields: Vec<(&str, &str)> = lines.filter_map(|line| line.split_once(' ')).collect();
        let field = |name: &str| {
            let found = fields.iter().find(|(key, _)| *key == name).map(|(_, value)| *value);
            found.ok_or_else(|| broken(format!("its header has no line `{name}`")))
        };
        let channels = whole(field("channels")?, "channels", MAX_CHANNELS)?;
        if channels % CHANNEL_STEP != 0 {
            return Err(broken(format!("{channels} channels are not a multiple of {CHANNEL_STEP}")));
        }
        let count = whole(field("layers")?, "layers", MAX_LAYERS)?;
        let cells = cells(field("cells")?)?;
        let rivers = match field("rivers") {
            Err(_) => false,
            Ok("yes") => true,
            Ok(other) => return Err(broken(format!("`rivers {other}` is not `rivers yes`"))),
        };
        let (length, expected) = (body.len(), bytes(rivers, channels, count));
        if length != expected {
            return Err(broken(format!("it has {length} bytes of weights instead of {expected}")));
        }
        let hash: String = Sha256::digest(body).iter().map(|byte| format!("{byte:02x}")).collect();
        if field("sha256")? != hash {
            return Err(broken(format!("the SHA-256 of its weights is {hash}, which is not that of its header")));
        }
        let mut numbers =
            body.chunks_exact(4).map(|bytes| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
        if numbers.clone().any(|number| !number.is_finite()) {
            return Err(broken("a weight is not a finite number"));
        }
        let mut take = |count: usize| -> Vec<f32> { numbers.by_ref().take(count).collect() };
        let layers = (0..count)
            .map(|layer| {
                let inputs = if layer == 0 { inputs(rivers) } else { channels };
                Convolution {
                    inputs,
                    outputs: channels,
                    weights: take(TAPS * inputs * channels),
                    offsets: take(channels),
                }
            })
            .collect();
        let phases = take(channels * PHASES).chunks_exact(PHASES).map(four).collect();
        Ok(Weights { channels, rivers, layers, phases, offsets: four(&take(PHASES)), cells })
    }
}

fn four(numbers: &[f32]) -> [f32; PHASES] {
    std::array::from_fn(|at| numbers.get(at).copied().unwrap_or(0.0))
}

/// A positive whole number up to `max`.
fn whole(text: &str, name: &str, max: usize) -> Result<usize> {
    let number = text.parse().ok().filter(|number| (1..=max).contains(number));
    number.ok_or_else(|| broken(format!("`{name} {text}` is not a number from 1 to {max}")))
}

/// Two cells in metres, the smaller one first.
fn cells(text: &str) -> Result<[f64; 2]> {
    let pair = text.split_once(' ').and_then(|(least, greatest)| Some([least.parse().ok()?, greatest.parse().ok()?]));
    let pair = pair.filter(|[least, greatest]: &[f64; 2]| 0.0 < *least && least <= greatest && *greatest < 1e9);
    pair.ok_or_else(|| broken(format!("`cells {text}` are not two cells in metres, the smaller one first")))
}

/// Inputs of the first layer.
pub const fn inputs(rivers: bool) -> usize {
    FEATURES + NOISES + if rivers { OF_RIVERS } else { 0 }
}

/// Bytes of all weights.
fn bytes(rivers: bool, channels: usize, layers: usize) -> usize {
    let first = TAPS * inputs(rivers) * channels + channels;
    let others = (layers - 1) * (TAPS * channels * channels + channels);
    4 * (first + others + PHASES * channels + PHASES)
}

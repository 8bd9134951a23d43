//! Reading heights from OpenEXR pictures: scan lines of one part, uncompressed or with RLE, ZIPS or ZIP.
//!
//! "OpenEXR File Layout" (openexr.com). Heights are in the channel that is chosen by its number in the order of names.
//! By default they are in the only channel, in `Y`, `height` or `Z`, or in R if R, G and B are equal. Samples are
//! metres.

use super::dem::{Dem, Input, Request, afford, afford_beside, length, refused};
use super::exr_block::{damaged, take, unpack};
use super::sidecar::Sidecar;
use super::stored::{Kind, Stored};
use crate::samples;
use orogen_grid::error::Result;

/// Maximum length of the header, in bytes.
const MAX_HEAD: u64 = 1 << 20;

/// Maximum number of channels.
const MAX_CHANNELS: usize = 1024;

/// Reads a picture. `name` is the file's name in errors.
///
/// # Errors
/// If it is not OpenEXR, is of an unsupported kind, damaged or too large.
pub fn read(input: &mut dyn Input, name: &str, sidecar: &Sidecar, request: Request) -> Result<Dem> {
    open(input, sidecar, request).map_err(|why| refused(name, why))
}

/// The type of a channel's samples: their size, and whether they are floats.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Sample {
    Whole,
    Half,
    Float,
}

impl Sample {
    fn bytes(self) -> usize {
        if self == Sample::Half { 2 } else { 4 }
    }

    fn stored(self) -> Stored {
        let kind = if self == Sample::Whole { Kind::Unsigned } else { Kind::Float };
        Stored { kind, size: self.bytes(), big_endian: false }
    }
}

#[derive(Default)]
struct Head {
    channels: Vec<(String, Option<Sample>, bool)>,
    packing: Option<u8>,
    /// First and last column and row.
    window: Option<[i32; 4]>,
}

fn open(input: &mut dyn Input, sidecar: &Sidecar, request: Request) -> std::result::Result<Dem, String> {
    let there = length(input)?;
    let mut bytes = Vec::new();
    read_some(input, MAX_HEAD.min(there), &mut bytes)?;
    let mut rest = bytes.as_slice();
    if take(&mut rest, 4).ok() != Some(&[0x76, 0x2f, 0x31, 0x01]) {
        return Err("it is not an OpenEXR picture".into());
    }
    let version = int(&mut rest)? as u32;
    if version & 0xff != 2 || version & 0x1a00 != 0 {
        return Err(
            "tiled, multi-part and deep OpenEXR pictures are not supported; save it as a single part with scan lines"
                .into(),
        );
    }
    let head = head(&mut rest)?;
    let before = bytes.len() - rest.len();
    let (Some([left, top, right, bottom]), Some(packing)) = (head.window, head.packing) else { return Err(damaged()) };
    let side = |first: i32, last: i32| u64::try_from(i64::from(last) - i64::from(first) + 1).map_err(|_| damaged());
    let (width, height) = (side(left, right)?, side(top, bottom)?);
    let count = afford(width, height, request.allowed)?;
    let rows = match packing {
        0..=2 => 1,
        3 => 16,
        4 => return Err(other("PIZ")),
        5 => return Err(other("PXR24")),
        6 | 7 => return Err(other("B44")),
        8 | 9 => return Err(other("DWA")),
        _ => return Err(other("an unknown method")),
    };
    let chosen = choose(&head.channels, request)?;
    let mut before_own = 0;
    let mut own = Sample::Float;
    let mut pixel = 0u64;
    for (k, (name, sample, full)) in head.channels.iter().enumerate() {
        let sample = sample
            .filter(|_| *full)
            .ok_or_else(|| format!("its channel {} is not of full size", name.escape_debug()))?;
        if k < chosen {
            before_own += sample.bytes() as u64;
        }
        if k == chosen {
            own = sample;
        }
        pixel += sample.bytes() as u64;
    }
    let (width, line) = (width as usize, width.checked_mul(pixel).ok_or_else(damaged)?);
    let blocks = height.div_ceil(rows);
    let table = before as u64;
    if there.saturating_sub(table) / 8 < blocks || line.saturating_mul(rows) > there.saturating_mul(1032).max(1 << 20) {
        return Err("it ends before its samples".into());
    }
    let mut heights = samples::filled(f32::NAN, count);
    let mut seen = 0;
    for n in 0..blocks {
        let mut entry = Vec::new();
        seek(input, table + 8 * n)?;
        read_some(input, 8, &mut entry)?;
        let at = u64::from_le_bytes(entry.try_into().map_err(|_| damaged())?);
        let mut front = Vec::new();
        seek(input, at)?;
        read_some(input, 8, &mut front)?;
        let mut front = front.as_slice();
        let (y, size) = (int(&mut front)?, int(&mut front)?);
        let first =
            u64::try_from(i64::from(y) - i64::from(top)).ok().filter(|first| *first < height).ok_or_else(damaged)?;
        let size = u64::try_from(size).ok().filter(|size| *size <= there).ok_or_else(damaged)?;
        let lines = rows.min(height - first);
        let due = (lines * line) as usize;
        // The compressed bytes, the split bytes, and the samples.
        afford_beside(count, size.saturating_add(2 * due as u64), request.allowed)?;
        let mut packed = Vec::new();
        read_some(input, size, &mut packed)?;
        let samples = if packed.len() == due { packed } else { unpack(packing, &packed, due)? };
        for j in 0..lines as usize {
            let begin = j * line as usize + before_own as usize * width;
            let out = &mut heights[(first as usize + j) * width..][..width];
            let source = &samples[begin..begin + own.bytes() * width];
            own.stored().copy(source, out);
        }
        seen += lines;
    }
    if seen != height {
        return Err(damaged());
    }
    if let Some(nodata) = sidecar.nodata {
        samples::hide(&mut heights, nodata);
    }
    let heights = sidecar.north_first(heights, width)?;
    Dem::new([width, height as usize], heights, sidecar.place(height as usize)?)
}

fn other(method: &str) -> String {
    format!("its compression {method} is not supported; save it with ZIP (supported: none, RLE, ZIPS and ZIP)")
}

fn seek(input: &mut dyn Input, at: u64) -> std::result::Result<(), String> {
    input.seek(std::io::SeekFrom::Start(at)).map(|_| ()).map_err(|cause| cause.to_string())
}

/// Reads exactly `count` bytes, and allocates memory only for bytes that exist.
fn read_some(input: &mut dyn Input, count: u64, out: &mut Vec<u8>) -> std::result::Result<(), String> {
    use std::io::Read;
    input.take(count).read_to_end(out).map_err(|cause| cause.to_string())?;
    if out.len() as u64 == count { Ok(()) } else { Err("it ends within its samples".into()) }
}

fn int(rest: &mut &[u8]) -> std::result::Result<i32, String> {
    let four = take(rest, 4)?;
    Ok(i32::from_le_bytes([four[0], four[1], four[2], four[3]]))
}

/// A null-terminated text.
fn text(rest: &mut &[u8]) -> std::result::Result<String, String> {
    let end = rest.iter().take(256).position(|byte| *byte == 0).ok_or_else(damaged)?;
    let text = String::from_utf8_lossy(take(rest, end)?).into_owned();
    take(rest, 1)?;
    Ok(text)
}

fn head(rest: &mut &[u8]) -> std::result::Result<Head, String> {
    let mut head = Head::default();
    loop {
        let name = text(rest)?;
        if name.is_empty() {
            return Ok(head);
        }
        let _kind = text(rest)?;
        let length = usize::try_from(int(rest)?).map_err(|_| damaged())?;
        let mut value = take(rest, length)?;
        match name.as_str() {
            "channels" => {
                while value.first().is_some_and(|byte| *byte != 0) {
                    let name = text(&mut value)?;
                    let sample = match int(&mut value)? {
                        0 => Some(Sample::Whole),
                        1 => Some(Sample::Half),
                        2 => Some(Sample::Float),
                        _ => None,
                    };
                    take(&mut value, 4)?;
                    let full = (int(&mut value)?, int(&mut value)?) == (1, 1);
                    head.channels.push((name, sample, full));
                    if head.channels.len() > MAX_CHANNELS {
                        return Err(format!("it has more than {MAX_CHANNELS} channels"));
                    }
                }
            }
            "compression" => head.packing = value.first().copied(),
            "dataWindow" => {
                head.window = Some([int(&mut value)?, int(&mut value)?, int(&mut value)?, int(&mut value)?]);
            }
            _ => {}
        }
    }
}

/// The index of the channel with the heights.
fn choose(channels: &[(String, Option<Sample>, bool)], request: Request) -> std::result::Result<usize, String> {
    if request.band.is_none() && channels.len() > 1 {
        let named = |wanted: &str| {
            channels
                .iter()
                .position(|(name, ..)| name.rsplit('.').next().is_some_and(|own| own.eq_ignore_ascii_case(wanted)))
        };
        if let Some(k) = ["y", "height", "z"].into_iter().find_map(named) {
            return Ok(k);
        }
    }
    if channels.is_empty() {
        return Err("it has no channels".into());
    }
    request.choose(channels.len()).map_err(|why| {
        let names: Vec<&str> = channels.iter().map(|(name, ..)| name.as_str()).collect();
        format!("{why} (its channels are {})", names.join(", ").escape_debug())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::exr;
    use crate::spool::Spool;
    use std::io::Cursor;

    fn written(names: &[&str], sample: exr::Sample) -> (Vec<Vec<f32>>, Vec<u8>) {
        let (width, height) = (23, 37);
        let picture = exr::Picture {
            width,
            height,
            channels: names.iter().map(ToString::to_string).collect(),
            sample,
            comments: String::new(),
        };
        let channels: Vec<Vec<f32>> =
            (0..names.len()).map(|n| (0..width * height).map(|k| (k * (n + 1) % 977) as f32 * 0.5).collect()).collect();
        let mut writer = exr::Writer::new(picture, Spool::in_memory()).unwrap();
        writer.rows(&channels.iter().map(Vec::as_slice).collect::<Vec<_>>()).unwrap();
        let mut bytes = Vec::new();
        writer.finish(&mut bytes).unwrap();
        (channels, bytes)
    }

    #[test]
    fn what_is_written_is_read_back() {
        let parse =
            |bytes: &[u8], request: Request| read(&mut Cursor::new(bytes), "a.exr", &Sidecar::default(), request);
        let plain = Request::from(1 << 20);
        for sample in [exr::Sample::Float, exr::Sample::Half] {
            let (channels, bytes) = written(&["Y"], sample);
            let dem = parse(&bytes, plain).unwrap();
            assert_eq!((dem.width, dem.height, &dem.heights), (23, 37, &channels[0]));
        }
        let (channels, bytes) = written(&["G", "R"], exr::Sample::Float);
        assert_eq!(parse(&bytes, Request { band: Some(2), ..plain }).unwrap().heights, channels[1]);
        let why = parse(&bytes, plain).unwrap_err().to_string();
        assert!(why.contains("2 bands") && why.contains("G, R"), "{why}");
        assert!(parse(&bytes, Request::from(100)).unwrap_err().to_string().contains("is allowed"));
        for n in (0..bytes.len() - 1).step_by(13) {
            assert!(parse(&bytes[..n], Request { band: Some(1), ..plain }).is_err(), "{n}");
        }
    }
}

//! Every reader of heights: any bytes are heights or a message.

use orogen::io::format::dem::Part;
use orogen::io::format::{Dem, Request, Sidecar, import};
use std::io::Cursor;

/// Runs the target on an input.
pub fn run(bytes: &[u8]) {
    let mut sidecar = Sidecar::parse("width = 37\nheight = 23\ncell = 30\nlow = 8\nhigh = 117.225", true).ok();
    if let Some(sidecar) = &mut sidecar {
        sidecar.header = Some("nrows 23\nncols 37\nnbits 16".into());
    }
    // What the bytes begin with tells most formats apart; the others take any bytes.
    let extensions: &[&str] = match bytes {
        [b'I', b'I', ..] | [b'M', b'M', ..] => &["tif"],
        [0x93, b'N', ..] => &["npy"],
        [0x89, b'P', ..] => &["png"],
        [0x76, 0x2f, ..] => &["exr"],
        [b'P', b'K', ..] => &["hgt.zip"],
        [b'U', b'H', ..] => &["dt1"],
        [b'C', b'D', b'F', ..] => &["nc"],
        _ => &["asc", "hgt", "r16", "r32", "bil", "flt", "xyz"],
    };
    for extension in extensions {
        let request = Request::new(1 << 22).with_band(Some(1));
        let read = |part| {
            let request = request.with_part(part);
            import::parse(&mut Cursor::new(bytes), "it", extension, sidecar.clone(), request)
        };
        if let Ok(dem) = read(None) {
            assert_eq!(dem.heights.len(), dem.width * dem.height);
            // A part has the bits of the whole.
            let [from, size] = [[dem.width / 3, dem.height / 2], [dem.width.div_ceil(3), dem.height.div_ceil(2)]];
            let part = Part { from, size };
            let bits = |dem: Dem| dem.heights.iter().map(|height| height.to_bits()).collect::<Vec<u32>>();
            assert_eq!(bits(read(Some(part)).unwrap()), bits(dem.cropped(part).unwrap()));
        }
    }
}

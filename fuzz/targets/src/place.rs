//! What stands beside heights and tells their place: any text is understood or refused with a message.

use orogen::io::format::crs::keys;
use orogen::io::format::{Sidecar, aux_xml, vrt, world_file};

/// Runs the target on an input; one that is no text is skipped.
pub fn run(input: &[u8]) {
    let Ok(text) = std::str::from_utf8(input) else { return };
    if let Ok(keys) = keys::of_wkt(text) {
        // A system that was understood can be told again, and is then the same.
        let told = keys::to_wkt(&keys);
        assert!(told.is_err() || told.is_ok_and(|told| keys::of_wkt(&told).is_ok()), "{text}");
    }
    let _ = (aux_xml::parse(text), vrt::parse(text), world_file::parse(text), keys::of_text(text));
    for toml in [false, true] {
        if let Ok(sidecar) = Sidecar::parse(text, toml) {
            let _ = sidecar.place(10);
        }
    }
}

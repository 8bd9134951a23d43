//! Maps of Azgaar's Fantasy Map Generator: any text is a map or refused with a message. What is read is on the map, and
//! rivers are in order.

use orogen::io::format::fmg::FmgMap;

/// Runs the target on an input; one that is no text is skipped.
pub fn run(input: &[u8]) {
    let Ok(text) = std::str::from_utf8(input) else { return };
    for width in [None, Some(400.0)] {
        let Ok(map) = FmgMap::parse(text, width) else { continue };
        assert!(!map.coast.is_empty() && map.spacing > 0.0);
        let is_inside = |at: &[f64; 2]| at.iter().zip(map.size).all(|(at, length)| (0.0..=length).contains(at));
        let finite = |at: &[f64; 2]| at.iter().all(|number| number.is_finite());
        assert!(map.sites.iter().all(|site| finite(&site.at) && site.height.is_finite()));
        assert!(map.rain.iter().all(|(at, rain)| finite(at) && (0.0..=100.0).contains(rain)));
        assert!(map.settlements.iter().all(|settlement| is_inside(&settlement.at)));
        for ring in map.coast.iter().chain(map.lakes.iter().flat_map(|lake| &lake.parts)).flatten() {
            assert!(ring.len() >= 4 && ring.first() == ring.last() && ring.iter().all(finite));
        }
        for (k, river) in map.rivers.iter().enumerate() {
            assert!(river.points.len() >= 2 && river.points.iter().all(finite));
            if let Some(parent) = river.parent {
                assert!(parent < k && map.rivers[parent].points.contains(river.points.last().unwrap()));
            }
        }
    }
}

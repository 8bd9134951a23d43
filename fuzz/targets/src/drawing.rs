//! SVG, GeoJSON and GeoPackage: any content is a drawing, or refused with a message. The distance to it and its inside
//! are known everywhere.

use orogen::grid::polylines::{Outline, Segments};
use orogen::io::format::drawing::{Drawing, Format};
use orogen::io::format::outlines::DrawingKind;

/// Runs the target on an input.
pub fn run(input: &[u8]) {
    for format in [Format::Svg, Format::GeoJson, Format::GeoPackage] {
        for kind in [DrawingKind::Lines, DrawingKind::Areas, DrawingKind::Ridges] {
            let Ok(drawing) = Drawing::parse(input, format, None, kind) else { continue };
            assert!(!drawing.outlines.is_empty());
            for is_smooth in [false, true] {
                let outlines = drawing.outlines.iter().map(|outline| match is_smooth {
                    false => outline.placed([2.0, -3.0], [1e6, 5.0]),
                    true => outline.smoothed(),
                });
                // A coarse tolerance: a run must not take seconds.
                let segments = Segments::new(&outlines.collect::<Vec<Outline>>(), 1e5);
                for at in [[0.0, 0.0], [-1e9, 1e9], [1e6, 5.0]] {
                    let nearest = segments.nearest(at, f64::INFINITY).expect("the nearest point of a drawing");
                    assert!(nearest.distance().is_finite() && nearest.height().is_finite());
                    assert!((0.0..=1.0).contains(&nearest.position()));
                    let _ = segments.is_inside(at);
                }
            }
        }
    }
}

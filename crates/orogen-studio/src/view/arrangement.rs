//! The positions of the boxes of a graph: an automatic layout of all boxes, and a free position for one.

use orogen::graph_layout::forward::Forward;
use orogen::graph_layout::layout::{Layout, Link, Spacing};
use orogen::output::sheet::Size;

use super::scene::{End, Scene};

/// Distances between boxes, wires and columns, in points.
const SPACING: Spacing = Spacing { gap: 22.0, wire_gap: 12.0, alley: 62.0 };

/// The upper left corners of all boxes. `sizes` are widths and heights; `outlet` and `port` return the distance of the
/// ends of a wire from the top of its box.
#[must_use]
pub fn tidy(
    scene: &Scene,
    sizes: &[[f32; 2]],
    outlet: impl Fn(usize, usize) -> f32,
    port: impl Fn(usize, End) -> f32,
) -> Vec<[f32; 2]> {
    let wires: Vec<(usize, usize)> = scene.wires.iter().map(|wire| (wire.from, wire.to)).collect();
    let forward = Forward::new(sizes.len(), &wires);
    let ordered: Vec<Size> = forward
        .order
        .iter()
        .filter_map(|block| sizes.get(*block))
        .map(|[width, height]| Size::new(*width, *height))
        .collect();
    let links: Vec<Link> = scene
        .wires
        .iter()
        .filter(|wire| forward.is_forward((wire.from, wire.to)))
        .filter_map(|wire| {
            let (from, to) = (*forward.place.get(wire.from)?, *forward.place.get(wire.to)?);
            Some(Link { from: (from, outlet(wire.from, wire.outlet)), to: (to, port(wire.to, wire.end)) })
        })
        .collect();
    let layout = Layout::new(&ordered, &links, SPACING);
    let place = |block: usize| forward.place.get(block).and_then(|at| layout.places.get(*at));
    (0..sizes.len()).map(|block| place(block).map_or([0.0; 2], |point| [point.x, point.y])).collect()
}

/// A rectangle: its upper left corner and its size.
pub type Area = ([f32; 2], [f32; 2]);

fn overlap((a, of_a): &Area, (b, of_b): &Area, gap: f32) -> bool {
    (0..2).all(|k| a[k] < b[k] + of_b[k] + gap && b[k] < a[k] + of_a[k] + gap)
}

/// The position nearest to `wanted` at which a box of this size does not overlap any other.
#[must_use]
pub fn free(wanted: [f32; 2], size: [f32; 2], others: &[Area]) -> [f32; 2] {
    const GAP: f32 = 14.0;
    let is_free = |place: [f32; 2]| !others.iter().any(|other| overlap(&(place, size), other, GAP));
    let distance = |place: [f32; 2]| libm::hypotf(place[0] - wanted[0], place[1] - wanted[1]);
    if is_free(wanted) {
        return wanted;
    }
    // The nearest free position touches the sides of other boxes, with the gap between them.
    let mut sides = [vec![wanted[0]], vec![wanted[1]]];
    for (place, of) in others {
        for (k, side) in sides.iter_mut().enumerate() {
            side.extend([place[k] - size[k] - GAP, place[k] + of[k] + GAP]);
        }
    }
    let places = sides[0].iter().flat_map(|x| sides[1].iter().map(move |y| [*x, *y]));
    let mut places: Vec<[f32; 2]> = places.collect();
    places.sort_by(|a, b| distance(*a).total_cmp(&distance(*b)));
    places.into_iter().find(|place| is_free(*place)).unwrap_or(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editing::document::Document;
    use crate::editing::edit::Edit;
    use orogen::presets;

    #[test]
    fn circles_of_groups_do_not_overlap_either() {
        // Every second node is in a group, which reads its own readers.
        for preset in presets::all() {
            let mut document = Document::of_preset(preset).unwrap();
            let nodes = document.recipe().nodes().iter().step_by(2).map(|named| named.name.clone()).collect();
            document.apply(&Edit::Group { nodes, name: "group".into() }).unwrap();
            for group in ["", "group"] {
                let scene = Scene::of(document.recipe(), group);
                let sizes = vec![[132.0, 90.0]; scene.boxes.len()];
                let places = tidy(&scene, &sizes, |_, _| 17.0, |_, _| 40.0);
                assert!(places.len() == sizes.len() && !scene.boxes.is_empty());
                check(&places, &sizes, preset.name);
            }
        }
    }

    fn check(places: &[[f32; 2]], sizes: &[[f32; 2]], name: &str) {
        for a in 0..places.len() {
            for b in 0..a {
                let (one, other) = ((places[a], sizes[a]), (places[b], sizes[b]));
                assert!(!overlap(&one, &other, 0.0), "{name}: {one:?} {other:?}");
            }
        }
    }

    #[test]
    fn the_boxes_of_presets_do_not_overlap_and_wires_run_to_the_right() {
        for preset in presets::all() {
            let scene = Scene::of(&preset.recipe().unwrap(), "");
            let sizes: Vec<[f32; 2]> =
                scene.boxes.iter().map(|block| [132.0, 40.0 + 15.0 * block.ports.len().max(1) as f32]).collect();
            let port = |_: usize, end: End| if let End::Port(k) = end { 42.0 + 15.0 * k as f32 } else { 0.0 };
            let places = tidy(&scene, &sizes, |_, _| 17.0, port);
            for wire in &scene.wires {
                assert!(places[wire.from][0] + 132.0 < places[wire.to][0], "{}: {wire:?}", preset.name);
            }
            check(&places, &sizes, preset.name);
        }
    }

    #[test]
    fn a_free_place_is_near_and_overlaps_nothing() {
        let size = [100.0, 60.0];
        let mut others: Vec<Area> = Vec::new();
        for _ in 0..60 {
            let place = free([10.0, 20.0], size, &others);
            assert!(others.iter().all(|other| !overlap(&(place, size), other, 0.0)), "{place:?}");
            assert!(libm::hypotf(place[0], place[1]) < 900.0, "{place:?}");
            others.push((place, size));
        }
        assert_eq!(others[0].0, [10.0, 20.0]);
    }
}

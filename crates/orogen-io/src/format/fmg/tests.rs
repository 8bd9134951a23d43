//! Tests on the small map.

use super::samples;
use super::{FmgMap, Water};
use crate::test_folder::TestFolder;
use orogen_grid::contour::line::twice_area;
use orogen_grid::hydrography::rings::holds;
use serde_json::{Value, json};

fn parsed(map: &Value) -> Result<FmgMap, String> {
    FmgMap::parse(&map.to_string(), None)
}

/// The small map after a change.
fn changed(change: impl FnOnce(&mut Value)) -> Result<FmgMap, String> {
    let mut map = samples::map();
    change(&mut map);
    parsed(&map)
}

#[test]
fn the_small_map_is_read() {
    let map = parsed(&samples::map()).unwrap();
    assert_eq!((map.name.as_str(), map.seed, map.size), ("Sample", Some(42), [410_000.0, 210_000.0]));
    assert!((map.spacing - 18_940.0).abs() < 10.0, "{}", map.spacing);
    assert_eq!(map.coast.iter().map(Vec::len).collect::<Vec<_>>(), [1, 1]);
    assert!(map.coast.iter().all(|part| twice_area(&part[0]) > 0.0));
    assert_eq!(map.lakes.len(), 1);
    assert_eq!((map.lakes[0].name.as_str(), map.lakes[0].height), ("Long Mere", Some(156.25)));
    assert_eq!(map.sites.iter().filter(|site| site.water == Some(Water::Lake)).count(), 1);
    // Land is where heights are 20 and more.
    for site in &map.sites {
        let is_land = map.coast.iter().any(|part| holds(&part[0], site.at));
        assert_eq!(is_land, site.water != Some(Water::Sea), "{site:?}");
        assert_eq!(site.water.is_none(), site.height >= 4.0);
    }
    assert_eq!(map.rain.len(), 240);
    let names: Vec<&str> = map.settlements.iter().map(|settlement| settlement.name.as_str()).collect();
    assert_eq!(names, ["Aldermouth, \"old\"", "Upper Ford"]);
    assert_eq!(
        map.notes,
        [
            "1 river with fewer than two points left out",
            "1 settlement without a position on the map left out (`pack.burgs`)"
        ]
    );
}

#[test]
fn rivers_are_in_order_and_tributaries_end_on_them() {
    let map = parsed(&samples::map()).unwrap();
    let names: Vec<(&str, Option<usize>)> =
        map.rivers.iter().map(|river| (river.name.as_str(), river.parent)).collect();
    assert_eq!(
        names,
        [("Arden River", None), ("Weir", None), ("Eastern", None), ("Ash Brook", Some(0)), ("Inlet", Some(1))]
    );
    for river in &map.rivers {
        if let Some(parent) = river.parent {
            assert!(map.rivers[parent].points.contains(river.points.last().unwrap()), "{river:?}");
        }
    }
    // The mouth in the sea is on the shore.
    let [x, y] = *map.rivers[0].points.last().unwrap();
    let ring = &map.coast[0][0];
    let distance = ring.windows(2).map(|pair| {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        let (east, south) = (bx - ax, by - ay);
        let share = (((x - ax) * east + (y - ay) * south) / (east * east + south * south)).clamp(0.0, 1.0);
        libm::hypot(x - ax - share * east, y - ay - share * south)
    });
    assert!(distance.fold(f64::INFINITY, f64::min) < 1.0);
    assert_eq!((map.rivers[0].discharge, map.rivers[0].width), (Some(90.0), Some(200.0)));
}

#[test]
fn other_shapes_of_exports_are_the_same_map() {
    let map = samples::map();
    let expect = parsed(&map).unwrap();
    // The export of `pack cells` has neither scale nor grid.
    let pack = json!({ "info": map["info"], "cells": map["pack"] });
    let why = parsed(&pack).unwrap_err();
    assert!(why.contains("`settings.distanceScale`") && why.contains("`--width 1200`"), "{why}");
    let found = FmgMap::parse(&pack.to_string(), Some(410.0)).unwrap();
    assert_eq!((&found.coast, &found.lakes), (&expect.coast, &expect.lakes));
    assert!(found.rain.is_empty() && found.notes.iter().any(|note| note.contains("no precipitation")));
    // Cells as columns, and vertices beside them.
    let column =
        |name: &str| map["pack"]["cells"].as_array().unwrap().iter().map(|cell| cell[name].clone()).collect::<Value>();
    let mut columns = map.clone();
    columns["pack"]["cells"] =
        json!({ "p": column("p"), "v": column("v"), "h": column("h"), "f": column("f"), "g": column("g") });
    columns["vertices"] = columns["pack"]["vertices"].take();
    columns["pack"].as_object_mut().unwrap().remove("vertices");
    assert!(parsed(&columns).unwrap() == expect);
    let wide = FmgMap::parse(&map.to_string(), Some(41.0)).unwrap();
    assert_eq!(wide.size, [41_000.0, 21_000.0]);
}

#[test]
fn land_at_the_border_goes_on_beyond_it() {
    let map = changed(|map| {
        for cell in 0..12 {
            map["pack"]["cells"][20 * cell]["h"] = json!(30);
        }
    })
    .unwrap();
    let west = map.coast.iter().flatten().flatten().map(|at| at[0]).fold(f64::INFINITY, f64::min);
    assert_eq!(west, -4.0 * map.spacing);
}

#[test]
fn what_is_missing_or_odd_is_a_sentence() {
    for (path, value, expect) in [
        ("/info/width", json!(null), "`info.width`, the size of the map in pixels, is missing"),
        ("/info/height", json!(1e9), "`info.height` is 1000000000, and must be 1 to 100000 pixels"),
        ("/settings/distanceUnit", json!("custom"), "`settings.distanceUnit` is `custom`, whose length is not known"),
        ("/settings/distanceScale", json!(-3), "it does not say how long a pixel is"),
        ("/settings/distanceScale", json!(1e9), "sides of 1 to 40000 km are read"),
        ("/settings/heightExponent", json!("7"), "`settings.heightExponent` is 7, and must be 0.5 to 2.5"),
        ("/pack/cells", json!([]), "it has no cells (`pack.cells`)"),
        ("/pack/vertices", json!(7), "it has no corners of cells"),
        ("/pack/cells/3/p", json!("here"), "`pack.cells[3].p` is not a position"),
        ("/pack/cells/3/p", json!([1e300, 2]), "`pack.cells[3].p` is not a position"),
        ("/pack/cells/3/h", json!(101), "`pack.cells[3].h` is not a height from 0 to 100"),
        ("/pack/cells/3/v", json!([1, 2]), "`pack.cells[3].v` has 2 corners"),
        ("/pack/cells/3/v/1", json!(1.5), "`pack.cells[3].v[1]` is not the number of a corner"),
        ("/pack/cells/3/v/1", json!(99_999), "`pack.cells[3].v[1]` is not the number of a corner"),
        ("/pack/vertices/3/p", json!([null, 1]), "is not the number of a corner on the map"),
    ] {
        let why = changed(|map| *map.pointer_mut(path).unwrap() = value).unwrap_err();
        assert!(why.contains(expect), "{path}: {why}");
    }
    let why = changed(|map| {
        map["pack"]["cells"].as_array_mut().unwrap().iter_mut().for_each(|cell| cell["h"] = json!(5));
    });
    assert!(why.unwrap_err().contains("it has no land"));
    for (text, expect) in [
        ("", "it is not valid JSON of an export"),
        ("[]", "it is not valid JSON of an export"),
        ("{", "it is not valid JSON of an export"),
        ("{}", "it has no cells (`pack.cells`)"),
        ("1.99|File can be loaded in azgaar.github.io\n", "a .map file is only read by"),
    ] {
        let why = FmgMap::parse(text, None).unwrap_err();
        assert!(why.contains(expect), "{text}: {why}");
    }
}

#[test]
fn odd_rivers_are_left_out_or_joined_where_they_can_be() {
    let map = changed(|map| {
        map["pack"]["rivers"] = json!([
            null,
            { "i": 1, "parent": 2, "cells": [129, 128, 9999, -5, "x"] },
            { "i": 2, "parent": 1, "cells": [150, 149, 148] },
            { "i": 3, "parent": 77, "cells": [129, 130, -1] },
            { "i": 4, "cells": { "a": 1 } },
            { "i": 5, "points": [[10, 20], [30, 40], [null, 3]] },
        ]);
    })
    .unwrap();
    assert_eq!(map.rivers.len(), 4);
    assert!(map.rivers.iter().all(|river| river.parent.is_none()));
    let on_border = |at: &[f64; 2]| at[0] == 0.0 || at[1] == 0.0 || at[0] == map.size[0] || at[1] == map.size[1];
    assert!(map.rivers.iter().any(|river| river.points.last().is_some_and(on_border)));
    assert!(map.notes[0].starts_with("1 river with fewer"), "{:?}", map.notes);
}

#[test]
fn files_are_read_by_their_content() {
    let folder = TestFolder::new("fmg").unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let text = samples::map().to_string();
    assert!(FmgMap::read(&write("a.json", text.as_bytes()), None).is_ok());
    for (name, bytes) in [("a.map", &b"1.9|x"[..]), ("b.map", &[0x1f, 0x8b, 8, 0]), ("c.map", b"")] {
        let why = FmgMap::read(&write(name, bytes), None).unwrap_err().to_string();
        assert!(why.contains("a .map file is only read by") && why.contains(name), "{why}");
    }
    let why = FmgMap::read(&write("d.json", &[0xff, 0xfe]), None).unwrap_err().to_string();
    assert!(why.contains("it is not text in UTF-8"), "{why}");
}

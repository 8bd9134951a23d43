use super::*;
use crate::format::outlines::MAX_POINTS;
use crate::test_folder::TestFolder;

/// The points of outlines, flattened.
fn points(text: &str, format: Format, kind: DrawingKind) -> Vec<Vec<[f64; 2]>> {
    let drawing = Drawing::parse(text.as_bytes(), format, None, kind).unwrap_or_else(|why| panic!("{why}\n{text}"));
    let flattened = drawing.outlines.iter().map(|outline| {
        let mut points = vec![[outline.start[0], outline.start[1]]];
        outline.flatten(0.001, |[x, y, _]| points.push([x, y]));
        points
    });
    flattened.collect()
}

fn svg(content: &str) -> String {
    format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 100 100\">{content}</svg>")
}

/// The lines of SVG path data.
fn path(data: &str) -> Vec<Vec<[f64; 2]>> {
    points(&svg(&format!("<path d=\"{data}\"/>")), Format::Svg, DrawingKind::Lines)
}

fn refusal(text: &str, format: Format, kind: DrawingKind) -> String {
    match Drawing::parse(text.as_bytes(), format, None, kind) {
        Ok(drawing) => panic!("{} outlines were read of {:.200}", drawing.outlines.len(), text),
        Err(why) => why,
    }
}

#[test]
fn path_data_of_straight_lines() {
    let line = vec![vec![[10.0, 20.0], [30.0, 20.0], [30.0, 5.0], [0.5, 5.5]]];
    for data in [
        "M10 20 L30 20 L30 5 L.5 5.5",
        "M10,20 30,20 30,5 0.5,5.5",
        "m10 20 20 0 0-15-29.5.5",
        "M 10 20 H 30 V 5 L .5 5.5",
        "M10 20h20v-15l-29.5 5e-1",
        "\n M1e1+20H3E1V5.0L0.5.55e1 ",
    ] {
        assert_eq!(path(data), line, "{data}");
    }
    // Several subpaths; after Z, the next subpath begins where the last one began.
    assert_eq!(
        path("M0 0h5v5zl-1 0M7 7m1 1h1"),
        [
            vec![[0.0, 0.0], [5.0, 0.0], [5.0, 5.0], [0.0, 0.0]],
            vec![[0.0, 0.0], [-1.0, 0.0]],
            vec![[8.0, 8.0], [9.0, 8.0]],
        ]
    );
}

#[test]
fn path_data_of_curves() {
    // Every second form draws the same curve as the form before it.
    for [first, second] in [
        ["M0 0C0 10 20 10 20 0C20-10 40-10 40 0", "M0 0c0 10 20 10 20 0s20-10 20 0"],
        ["M0 0Q10 20 20 0Q30-20 40 0", "M0 0q10 20 20 0t20 0"],
        ["M5 5C5 5 10 10 20 5", "M5 5S10 10 20 5"],
        ["M5 5Q5 5 20 5", "M5 5T20 5"],
        ["M0 0A10 10 0 0 1 20 0", "M0 0a10,10 0 01 20,0"],
    ] {
        let (first, second) = (path(first), path(second));
        for (a, b) in first.iter().flatten().zip(second.iter().flatten()) {
            assert!((a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9, "{a:?} {b:?}");
        }
        assert_eq!(first.len(), second.len());
    }
    // The middle of a quadratic curve.
    let curve = path("M0 0Q10 20 20 0").concat();
    assert!(curve.iter().any(|[x, y]| (x - 10.0).abs() < 0.5 && (y - 10.0).abs() < 0.02), "{curve:?}");
}

#[test]
fn arcs_are_parts_of_circles() {
    for (data, center, radius, length) in [
        // A half circle; the large and the small part, in both directions.
        ("M0 0A10 10 0 0 1 20 0", [10.0, 0.0], 10.0, 31.4159),
        ("M0 0A10 10 0 0 1 10 10", [0.0, 10.0], 10.0, 15.708),
        ("M0 0A10 10 0 1 1 10 10", [10.0, 0.0], 10.0, 47.1239),
        ("M0 0A10 10 0 0 0 10 10", [10.0, 0.0], 10.0, 15.708),
        ("M0 0A10 10 0 1 0 10 10", [0.0, 10.0], 10.0, 47.1239),
        // Radii that are too small are enlarged.
        ("M0 0A1 1 0 0 1 20 0", [10.0, 0.0], 10.0, 31.4159),
    ] {
        let arc = path(data).concat();
        for [x, y] in &arc {
            let apart = libm::hypot(x - center[0], y - center[1]);
            assert!((apart - radius).abs() < 1e-5, "{data}: {x} {y}");
        }
        let steps = arc.windows(2).map(|pair| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]));
        let drawn: f64 = steps.sum();
        assert!((drawn - length).abs() < 0.01, "{data}: {drawn}");
    }
    // An ellipse rotated by 90 degrees equals one with swapped radii.
    let (turned, swapped) = (path("M0 0A20 10 90 0 1 20 0").concat(), path("M0 0A10 20 0 0 1 20 0").concat());
    for [a, b] in turned.iter().zip(&swapped).map(|(a, b)| [a, b]) {
        assert!((a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9, "{a:?} {b:?}");
    }
    assert_eq!(path("M0 0A0 10 0 0 1 20 0"), [[[0.0, 0.0], [20.0, 0.0]]]);
    assert_eq!(path("M0 0A5 5 0 0 1 0 0L1 1"), [[[0.0, 0.0], [1.0, 1.0]]]);
}

#[test]
fn elements_of_svg() {
    use DrawingKind::{Areas, Lines};
    let shapes = svg(concat!(
        "<title>A drawing</title><defs><path d='M9 9h9'/></defs>",
        "<polyline points='0,0 5 5,10,0'/><line x1='1' y1='2' x2='3px' y2='4'/>",
        "<polygon points='0 0 4 0 4 4'/><rect x='1' y='1' width='2' height='3'/>",
        "<g style='fill:none; display : none'><rect width='1' height='1'/></g><g display='none'><line x2='7'/></g>",
    ));
    let lines = [vec![[0.0, 0.0], [5.0, 5.0], [10.0, 0.0]], vec![[1.0, 2.0], [3.0, 4.0]]];
    assert_eq!(points(&shapes, Format::Svg, Lines), lines);
    let areas = [
        vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 0.0]],
        vec![[1.0, 1.0], [3.0, 1.0], [3.0, 4.0], [1.0, 4.0], [1.0, 1.0]],
    ];
    assert_eq!(points(&shapes, Format::Svg, Areas), areas);
    // Round shapes: extents and areas.
    for (shape, low, high, area) in [
        ("<circle cx='5' cy='6' r='2'/>", [3.0, 4.0], [7.0, 8.0], 12.566),
        ("<ellipse cx='5' cy='6' rx='2' ry='1'/>", [3.0, 5.0], [7.0, 7.0], std::f64::consts::TAU),
        ("<rect width='10' height='6' rx='1'/>", [0.0, 0.0], [10.0, 6.0], 59.1416),
        ("<rect width='10' height='6' rx='9' ry='9'/>", [0.0, 0.0], [10.0, 6.0], 47.1239),
    ] {
        let ring = points(&svg(shape), Format::Svg, Areas).concat();
        for k in 0..2 {
            let along = || ring.iter().map(|point| point[k]);
            assert!((along().fold(f64::MAX, f64::min) - low[k]).abs() < 1e-9, "{shape}");
            assert!((along().fold(f64::MIN, f64::max) - high[k]).abs() < 1e-9, "{shape}");
        }
        let doubled: f64 = ring.windows(2).map(|pair| pair[0][0] * pair[1][1] - pair[1][0] * pair[0][1]).sum();
        assert!((0.5 * doubled - area).abs() < 0.02, "{shape}: {doubled}");
    }
}

#[test]
fn transforms_of_elements_and_groups() {
    for (transform, expect) in [
        ("translate(10)", [[11.0, 2.0], [13.0, 5.0]]),
        ("translate(10, -20)", [[11.0, -18.0], [13.0, -15.0]]),
        ("scale(2)", [[2.0, 4.0], [6.0, 10.0]]),
        ("scale(2 -1)", [[2.0, -2.0], [6.0, -5.0]]),
        ("rotate(90)", [[-2.0, 1.0], [-5.0, 3.0]]),
        ("rotate(90 1 2)", [[1.0, 2.0], [-2.0, 4.0]]),
        ("skewX(45)", [[3.0, 2.0], [8.0, 5.0]]),
        ("skewY(45)", [[1.0, 3.0], [3.0, 8.0]]),
        ("matrix(1 2 3 4 5 6)", [[12.0, 16.0], [23.0, 32.0]]),
        ("translate(10 0) scale(2)", [[12.0, 4.0], [16.0, 10.0]]),
        ("none", [[1.0, 2.0], [3.0, 5.0]]),
    ] {
        let alone = format!("<line x1='1' y1='2' x2='3' y2='5' transform='{transform}'/>");
        let group = format!("<g transform='{transform}'><g><line x1='1' y1='2' x2='3' y2='5'/></g></g>");
        for text in [alone, group] {
            for (a, b) in points(&svg(&text), Format::Svg, DrawingKind::Lines).concat().iter().zip(&expect) {
                assert!((a[0] - b[0]).abs() < 1e-12 && (a[1] - b[1]).abs() < 1e-12, "{text}: {a:?}");
            }
        }
    }
    let nested = svg("<g transform='translate(10 0)'><path transform='scale(2)' d='M1 1L2 2'/></g>");
    assert_eq!(points(&nested, Format::Svg, DrawingKind::Lines), [[[12.0, 2.0], [14.0, 4.0]]]);
}

#[test]
fn geometries_of_geojson() {
    use DrawingKind::{Areas, Lines};
    let line = r#"{ "type": "LineString", "coordinates": [[0, 5], [10.5, -2, 7]] }"#;
    let lines = r#"{ "coordinates": [[[0, 1, 2, 99], [3, 4, 5, 98]], [[6, 7], [8, 9]]], "type": "MultiLineString" }"#;
    let ring = "[[0, 0], [9, 0], [9, 9], [0, 0]]";
    let area = format!(r#"{{ "type": "Polygon", "coordinates": [{ring}, [[5, 1], [6, 1], [6, 2], [5, 1]]] }}"#);
    let areas = format!(r#"{{ "type": "MultiPolygon", "coordinates": [[{ring}], [{ring}]] }}"#);
    let feature = |geometry: &str| {
        format!(
            r#"{{ "type": "Feature", "properties": {{ "type": "LineString", "a": [1] }}, "geometry": {geometry} }}"#
        )
    };
    let all = format!(
        r#"{{ "type": "FeatureCollection", "bbox": [0, 0, 1, 1], "features": [{}, {}, {}, {}] }}"#,
        feature(line),
        feature("null"),
        feature(&format!(r#"{{ "type": "GeometryCollection", "geometries": [{lines}, {area}] }}"#)),
        feature(&areas),
    );
    let read = |text: &str, kind| Drawing::parse(text.as_bytes(), Format::GeoJson, None, kind).unwrap().outlines;
    assert_eq!(read(line, Lines), [Outline::of_points(&[[0.0, -5.0, 0.0], [10.5, 2.0, 7.0]])]);
    assert_eq!(read(lines, Lines).len(), 2);
    assert_eq!(read(lines, Lines)[0], Outline::of_points(&[[0.0, -1.0, 2.0], [3.0, -4.0, 5.0]]));
    assert_eq!(read(&area, Areas).len(), 2);
    assert!(read(&areas, Areas).iter().all(|outline| outline.closed));
    assert_eq!((read(&all, Lines).len(), read(&all, Areas).len()), (3, 4));
    assert_eq!(read(&feature(line), Lines), read(line, Lines));
    let point = r#"{ "type": "Point", "coordinates": [1, 2] }"#;
    assert_eq!(refusal(point, Format::GeoJson, Lines), "it has no lines; `LineString` and `MultiLineString` are read");
    assert!(refusal(&area, Format::GeoJson, Lines).ends_with("the op `polygon` reads its 2 areas"));
    assert!(refusal(line, Format::GeoJson, Areas).ends_with("the op `path` reads its 1 line"));
}

/// The points of ridges of a drawing.
fn ridges(content: &[u8], format: Format) -> std::result::Result<Vec<Vec<[f64; 3]>>, String> {
    let drawing = Drawing::parse(content, format, None, DrawingKind::Ridges)?;
    let points = |outline: &Outline| [outline.start].into_iter().chain(outline.pieces.iter().map(Piece::end)).collect();
    Ok(drawing.outlines.iter().map(points).collect())
}

#[test]
fn ridges_and_summits_have_heights() {
    let bytes = fs::read(Path::new(CORPUS).join("ridges.geojson").as_path()).unwrap();
    let expect = [
        vec![[0.0, 500.0, 812.5], [1050.0, 700.0, 812.5], [1900.0, 300.0, 812.5]],
        vec![[0.0, 5.0, 400.0], [900.0, 90.0, 700.0]],
        vec![[300.0, 1200.0, 950.0]],
        vec![[1.0, 2.0, 640.0]],
        vec![[60.0, 70.0, 5.0]],
    ];
    assert_eq!(ridges(&bytes, Format::GeoJson).unwrap(), expect);
    let drawn = svg(
        "<g data-height='700'><line x2='9'/><circle cx='3' cy='4' r='1' data-height='810.5'/></g><polygon points='0 0 1 1 2 0'/>",
    );
    let expect = [vec![[0.0, 0.0, 700.0], [9.0, 0.0, 700.0]], vec![[3.0, 4.0, 810.5]]];
    assert_eq!(ridges(drawn.as_bytes(), Format::Svg).unwrap(), expect);
    for (content, format) in [
        (svg("<line x2='9'/>"), Format::Svg),
        (r#"{ "type": "Point", "coordinates": [1, 2] }"#.to_string(), Format::GeoJson),
        (
            r#"{ "type": "Feature", "properties": { "height": "high" }, "geometry": { "type": "LineString", "coordinates": [[1, 2], [3, 4]] } }"#
                .to_string(),
            Format::GeoJson,
        ),
    ] {
        let why = ridges(content.as_bytes(), format).unwrap_err();
        assert!(why.contains("a ridge or summit has no height; give its points a third coordinate (Z)"), "{why}");
    }
    let area = r#"{ "type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 0]]] }"#;
    let why = ridges(area.as_bytes(), Format::GeoJson).unwrap_err();
    assert!(why.starts_with("it has no ridges, of which `LineString`, `Point`"), "{why}");
}

#[test]
fn ridges_of_a_geopackage() {
    use crate::format::features::{Crs, Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value};
    const FIELDS: &[Field] = &[
        Field { name: "name", kind: FieldType::Text, about: "name" },
        Field { name: "Elevation", kind: FieldType::Real, about: "height in m" },
    ];
    let layer = |name, geometry, features: Vec<(Geometry, f64)>| {
        let feature = |(geometry, height)| Feature { geometry, values: vec![Value::text("a"), Value::Real(height)] };
        let features = features.into_iter().map(feature).collect();
        FeatureLayer { name, about: "a test", geometry, fields: FIELDS, features }
    };
    let line = vec![[0.0, 0.0, 0.0], [90.0, 10.0, 0.0]];
    let layers = [
        layer("ridges", GeometryType::Line, vec![(Geometry::Line(line), 640.0)]),
        layer("summits", GeometryType::Point, vec![(Geometry::Point([5.0, 6.0, 0.0]), 700.5)]),
    ];
    let mut file = Vec::new();
    crate::format::gpkg::write(&mut file, layers.iter(), Crs::Local).unwrap();
    let read = |layer: &str| {
        let drawing = Drawing::parse(&file, Format::GeoPackage, Some(layer), DrawingKind::Ridges).unwrap();
        drawing.outlines.iter().map(|outline| (outline.pieces.len(), outline.start[2])).collect::<Vec<_>>()
    };
    assert_eq!((read("ridges"), read("summits")), (vec![(1, 640.0)], vec![(0, 700.5)]));
}

#[test]
fn malformed_files_are_refused_with_what_is_wrong() {
    use DrawingKind::{Areas, Lines};
    for (content, message) in [
        ("<path d='L1 2'/>", "`path` number 1: its `d`: expected M, because a path begins with a move at character 1"),
        (
            "<line/><path/><path d='M1 2 L3'/>",
            "`path` number 2: its `d`: expected a number at character 8, not the end",
        ),
        ("<path id='river' d='M1 2 B3 4'/>", "the `path` with the id \"river\": its `d`: expected one of the commands"),
        ("<path d='M1 2 L3 4e'/>", "expected one of the commands M L H V C S Q T A Z at character 10, not \"e\""),
        ("<path d='M0 0A1 1 0 2 0 5 5'/>", "expected the flag 0 or 1 at character 12"),
        ("<path d='M1 2 L1e999 0'/>", "expected a number"),
        ("<path d='M1 2 L2e9 0'/>", "a coordinate that is not a number from -1e9 to 1e9"),
        ("<path d='M1 2 é'/>", "expected a command"),
        ("<polyline points='1 2 3'/>", "its `points`: expected a number at character 6, not the end"),
        ("<line x1='50%' x2='7'/>", "its `x1` is \"50%\"; only numbers in user units are read"),
        ("<g transform='turn(3)'><line x2='7'/></g>", "its `transform`: \"turn(3)\" is no transform"),
        ("<g transform='scale'/>", "\"scale\" is no transform"),
        ("<line x2='1e6' transform='scale(1e6)'/>", "a coordinate that is not a number"),
        ("<text>x</text>", "it has no lines; `path`, `polyline` and `line` are read"),
        ("<path d='M5 5'/>", "it has no lines"),
        ("<circle r='3'/>", "the op `polygon` reads its 1 area"),
        ("<g>", "it is not valid XML"),
    ] {
        let why = refusal(&svg(content), Format::Svg, Lines);
        assert!(why.contains(message), "{content}: {why}");
    }
    assert!(refusal("<html/>", Format::Svg, Lines).contains("its root is `html`"));
    let entities = "<!DOCTYPE svg [<!ENTITY a \"aaaa\">]><svg>&a;</svg>";
    assert!(refusal(entities, Format::Svg, Lines).contains("defines XML entities"));
    let document = "<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" \"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd\"><svg><line x2='1'/></svg>";
    assert_eq!(points(document, Format::Svg, Lines).len(), 1);
    for (text, message) in [
        ("", "it is not valid GeoJSON"),
        ("[]", "it is not valid GeoJSON"),
        ("{}", "its `type` is missing"),
        (r#"{"type":"LineString"}"#, "a LineString has no coordinates"),
        (r#"{"type":"LineString","coordinates":[1,2]}"#, "its coordinates are not nested as this type has them"),
        (r#"{"type":"LineString","coordinates":[[[1,2]]]}"#, "a position is not a list of two or three numbers"),
        (r#"{"type":"LineString","coordinates":[[1]]}"#, "a position has only one number"),
        (r#"{"type":"LineString","coordinates":[[1,[2,3]]]}"#, "a list has both numbers and lists"),
        (r#"{"type":"LineString","coordinates":[["1",2]]}"#, "expected a number or a list"),
        (r#"{"type":"LineString","coordinates":[[1,2],[1e300,2]]}"#, "a coordinate that is not a number"),
        (r#"{"type":"LineString","coordinates":[[1,2],[3,4]]} x"#, "trailing characters"),
        (r#"{"type":"FeatureCollection","features":[3]}"#, "expected an object of GeoJSON"),
    ] {
        let why = refusal(text, Format::GeoJson, Lines);
        assert!(why.contains(message), "{text}: {why}");
    }
    let deep = format!("{}{}", "[".repeat(10_000), "]".repeat(10_000));
    assert!(refusal(&format!("{{\"coordinates\":{deep}}}"), Format::GeoJson, Areas).contains("recursion limit"));
}

#[test]
fn large_files_take_bounded_memory() {
    let nested = svg(&format!("{}<line x2='5'/>{}", "<g>".repeat(20_000), "</g>".repeat(20_000)));
    let read = Drawing::parse(nested.as_bytes(), Format::Svg, None, DrawingKind::Lines);
    assert!(read.is_ok_and(|drawing| drawing.outlines.len() == 1));
    let many = svg(&format!("<polyline points='{}'/>", "1 2 ".repeat(MAX_POINTS + 1)));
    assert!(refusal(&many, Format::Svg, DrawingKind::Lines).contains("more than 1048576 points"));
    let lists = format!("{{\"coordinates\":[{}[]]}}", "[],".repeat(2 * MAX_POINTS));
    assert!(refusal(&lists, Format::GeoJson, DrawingKind::Lines).contains("positions and objects"));
    let drawing = Drawing::parse(svg("<line x2='5'/>").as_bytes(), Format::Svg, None, DrawingKind::Lines).unwrap();
    assert!(drawing.memory() > 0);
}

#[test]
fn files_by_path() {
    let folder = TestFolder::new("drawing").unwrap();
    let write = |name: &str, text: &[u8]| {
        let path = folder.join(name);
        fs::write(&path, text).unwrap();
        path
    };
    let line = svg("<line x2='5'/>");
    let read = |path: &Path, allowed| Drawing::read(path, None, DrawingKind::Lines, allowed);
    let svg_path = write("a.SVG", line.as_bytes());
    assert_eq!(read(&svg_path, 1 << 20).unwrap().outlines.len(), 1);
    let json = write("a.geojson", "\u{feff}{\"type\":\"LineString\",\"coordinates\":[[0,-0],[5,0]]}".as_bytes());
    assert_eq!(read(&json, 1 << 20).unwrap().outlines, read(&svg_path, 1 << 20).unwrap().outlines);
    for (path, message) in [
        (write("a.txt", b""), "the op `path` reads .svg, .geojson and .gpkg"),
        (write("b.svg", b"\xff\xfe"), "it is not text in UTF-8"),
        (write("c.svg", &b" ".repeat(70_000)[..]), "more than 64 KiB"),
        (folder.join("none.svg"), "none.svg"),
    ] {
        let error = read(&path, 1 << 20).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
    // The hash depends on the content, not on the text.
    let [a, b, c] = ["<line x2='5'/>", "<line  y1='0' x2='5.0'/>", "<line x2='6'/>"]
        .map(|text| Drawing::parse(svg(text).as_bytes(), Format::Svg, None, DrawingKind::Lines).unwrap().hash);
    assert!(a == b && a != c);
}

#[test]
fn exported_lines_are_read_where_they_were() {
    use crate::format::features::{Crs, Feature, Geometry, GeometryType, Value, samples};
    let points = [[0.0, 0.0, 0.0], [120.5, 30.0, 0.0], [90.0, 410.25, 0.0]];
    let mut layer = samples::layer("lines", GeometryType::Line, 0);
    let values = vec![Value::Integer(1), Value::Real(250.0), Value::Boolean(true), Value::Null];
    layer.features.push(Feature { geometry: Geometry::Line(points.to_vec()), values });
    layer.place(None);
    let mut text = Vec::new();
    crate::format::geojson::write(&mut text, &layer, Crs::Local, 10.0).unwrap();
    let read = Drawing::parse(&text, Format::GeoJson, None, DrawingKind::Lines).unwrap();
    assert_eq!(read.outlines, [Outline::of_points(&points)]);
}

/// The folder of inputs for fuzzing. Its GeoPackage was written by GDAL.
const CORPUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/drawing/");

#[test]
fn layers_of_a_geopackage() {
    let bytes = fs::read(Path::new(CORPUS).join("layers.gpkg").as_path()).unwrap();
    let read = |layer, kind| Drawing::parse(&bytes, Format::GeoPackage, layer, kind);
    let rivers = read(Some("rivers"), DrawingKind::Lines).unwrap().outlines;
    let expect = [
        vec![[0.0, 0.0, 5.0], [100.0, 50.0, 7.0], [200.0, 20.0, 9.0]],
        vec![[10.0, 10.0, 1.0], [20.0, 20.0, 2.0]],
        vec![[30.0, 30.0, 3.0], [40.0, 45.0, 4.0]],
    ];
    assert_eq!(rivers, expect.map(|points| Outline::of_points(&points)));
    let roads = read(Some("ROADS"), DrawingKind::Lines).unwrap().outlines;
    assert_eq!(roads, [Outline::of_points(&[[0.0, 5.0, 0.0], [50.0, 5.0, 0.0]])]);
    // The only layer with areas, and its hole.
    let areas = read(None, DrawingKind::Areas).unwrap().outlines;
    assert!(areas.len() == 2 && areas.iter().all(|area| area.closed && area.pieces.len() == 4));
    for (layer, kind, message) in [
        (
            None,
            DrawingKind::Lines,
            "it has lines in the layers `rivers`, `roads`; name one of them after the file, as in `map.gpkg|layername=rivers`",
        ),
        (Some("lakes"), DrawingKind::Lines, "no layer `lakes`, but the layers `rivers`, `coast`, `places`, `roads`"),
        (Some("places"), DrawingKind::Areas, "it has no areas"),
        (Some("roads"), DrawingKind::Areas, "the op `path` reads its 1 line"),
    ] {
        let why = read(layer, kind).unwrap_err();
        assert!(why.contains(message), "{why}");
    }
}

#[test]
fn names_of_layers_follow_those_of_geopackages() {
    for (name, file, layer) in [
        ("a/map.gpkg|layername=my coast", "a/map.gpkg", Some("my coast")),
        ("map.GPKG|layername=a|layername=b", "map.GPKG", Some("a|layername=b")),
        ("map.gpkg", "map.gpkg", None),
        ("map.svg|layername=a", "map.svg|layername=a", None),
    ] {
        assert_eq!(file_and_layer(name), (file, layer));
        assert_eq!(named(file, layer), name);
    }
}

#[test]
fn a_geopackage_with_changes_elsewhere_is_refused() {
    let folder = TestFolder::new("drawing-log").unwrap();
    let path = folder.join("layers.gpkg");
    fs::write(&path, fs::read(Path::new(CORPUS).join("layers.gpkg").as_path()).unwrap()).unwrap();
    let read = || Drawing::read(&path, Some("roads"), DrawingKind::Lines, 1 << 20);
    assert_eq!(read().unwrap().outlines.len(), 1);
    fs::write(folder.join("layers.gpkg-wal"), b"").unwrap();
    assert!(read().is_ok());
    fs::write(folder.join("layers.gpkg-wal"), b"frames").unwrap();
    assert!(read().unwrap_err().to_string().contains("close the program that has it open"));
}

#[test]
fn exported_geopackages_are_read_where_they_were() {
    use crate::format::features::{Crs, Feature, Geometry, GeometryType, samples};
    let points = [[0.0, 0.0, 3.0], [120.5, 30.0, 4.5], [90.0, 410.25, 0.0]];
    let mut lines = samples::layer("lines", GeometryType::LineZ, 300);
    lines.features.push(Feature { geometry: Geometry::Line(points.to_vec()), ..lines.features[0].clone() });
    let mut areas = samples::layer("areas", GeometryType::MultiPolygon, 20);
    lines.place(None);
    areas.place(None);
    let mut bytes = Vec::new();
    crate::format::gpkg::write(&mut bytes, [&lines, &areas].into_iter(), Crs::Local).unwrap();
    let read = |kind| Drawing::parse(&bytes, Format::GeoPackage, None, kind).unwrap().outlines;
    assert_eq!((read(DrawingKind::Lines).len(), read(DrawingKind::Areas).len()), (301, 40));
    assert_eq!(read(DrawingKind::Lines)[300], Outline::of_points(&points));
}

#[test]
fn damaged_files_are_read_or_refused() {
    let mut random = orogen_grid::random::Random::new(11, 0);
    let (mut read, mut refused) = (0, 0);
    for (name, format) in [
        ("shapes.svg", Format::Svg),
        ("lines.geojson", Format::GeoJson),
        ("areas.geojson", Format::GeoJson),
        ("layers.gpkg", Format::GeoPackage),
    ] {
        let whole = fs::read(Path::new(CORPUS).join(name).as_path()).unwrap();
        for _ in 0..4000 {
            let mut bytes = whole.clone();
            for _ in 0..=random.below(4) {
                let at = random.below(bytes.len());
                let other = bytes[random.below(bytes.len())];
                match random.below(4) {
                    0 => bytes[at] = other,
                    1 => bytes.insert(at, other),
                    2 => drop(bytes.remove(at)),
                    _ => bytes[at] = b"0123456789-+eE.,[]{}<>/\"MmLlHhVvCcSsQqTtAaZz"[random.below(44)],
                }
            }
            for kind in [DrawingKind::Lines, DrawingKind::Areas] {
                match Drawing::parse(&bytes, format, None, kind) {
                    Ok(drawing) => {
                        read += 1;
                        let segments = orogen_grid::polylines::segments::Segments::new(&drawing.outlines, 1e5);
                        assert!(segments.nearest([1.0, 2.0], f64::INFINITY).is_some(), "{name}");
                    }
                    Err(why) => {
                        refused += 1;
                        assert!(!why.is_empty());
                    }
                }
            }
        }
    }
    assert!(read > 1000 && refused > 1000, "{read} {refused}");
}

//! `orogen map`.

use crate::harness::{Folder, png};

#[test]
fn one_sheet_as_picture_svg_and_pdf() {
    let folder = Folder::with_small();
    let told = folder.good(&["map", "small.toml", "-o", "a.png", "--size", "600"]).text().to_string();
    assert!(told.starts_with("a.png: ") && told.contains("64 x 48 samples of 10 m, contours "), "{told}");
    let picture = png(&folder.read("a.png"));
    assert_eq!((picture.width.max(picture.height), picture.channels), (600, 3));
    folder.good(&["map", "small.toml", "-o", "a.svg", "--paper", "a5", "--title", "H\u{f6}hen & Tiefen", "-q"]);
    let text = folder.text("a.svg");
    assert!(
        text.contains("width=\"148.000mm\" height=\"210.000mm\"") && text.contains("<title>H\u{f6}hen &amp; Tiefen")
    );
    folder.good(&["map", "small.toml", "-o", "a.pdf", "--paper", "letter", "--landscape", "--contours", "20", "-q"]);
    let page = folder.read("a.pdf");
    assert!(page.starts_with(b"%PDF-1.4") && page.ends_with(b"%%EOF\n"));
    // The same command writes the same bytes; without one part the bytes differ.
    folder.good(&["map", "small.toml", "-o", "b.png", "--size", "600", "-q", "--threads", "1"]);
    folder.good(&["map", "small.toml", "-o", "c.png", "--size", "600", "-q", "--no-contours"]);
    assert!(folder.read("a.png") == folder.read("b.png") && folder.read("a.png") != folder.read("c.png"));
    // A title with letters that the built-in font lacks is drawn or reported, and never stops the map.
    folder.good(&["map", "small.toml", "-o", "d.png", "--size", "300", "--title", "\u{5c71}\u{6cb3}", "-q"]);
}

#[test]
fn colors_by_name_and_from_files() {
    let folder = Folder::with_small();
    folder.write("own.toml", "unit = \"range\"\nstops = [[0, \"#000\"], [1, \"white\"]]\n");
    for palette in ["viridis", "own.toml"] {
        let plain =
            ["--no-contours", "--no-rivers", "--no-lakes", "--no-summits", "--shade", "none", "--size", "300", "-q"];
        folder.good(&[&["map", "small.toml", "-o", "a.png", "--palette", palette][..], &plain].concat());
        let picture = png(&folder.read("a.png"));
        // A gray map has colors only in the small print.
        let colored =
            picture.data.chunks(3).filter(|pixel| pixel.iter().max().unwrap() - pixel.iter().min().unwrap() > 20);
        assert_eq!(colored.count() > 1000, palette == "viridis", "{palette}");
    }
    // Only the colors of the stops, given from 0 to 1.
    folder.write("classes.txt", "0% 0.2 0.4 1\n50% 1 0 0.6\n100% 0.0 0.8 0\n");
    let line = |out: &str, more: &[&str]| {
        let plain =
            ["map", "small.toml", "-o", out, "--palette", "classes.txt", "--size", "300", "--shade", "none", "-q"];
        let without = ["--no-contours", "--no-rivers", "--no-lakes", "--no-summits"];
        folder.good(&[&plain[..], &without, more].concat());
        png(&folder.read(out))
    };
    let is_stop = |pixel: &&[u8]| [[51, 102, 255], [255, 0, 153], [0, 204, 0]].iter().any(|color| pixel == color);
    let exact = |picture: &crate::harness::Picture| picture.data.chunks(3).filter(is_stop).count();
    let (mixed, nearest) = (line("mixed.png", &[]), line("nearest.png", &["--nearest-color"]));
    assert!(exact(&mixed) < 1000 && exact(&nearest) > 40_000, "{} {}", exact(&mixed), exact(&nearest));
    folder.bad(&["map", "small.toml", "-o", "b.png", "--nearest-color"], 2, "--palette");
    for (palette, expect) in [
        ("viridiss", "did you mean `viridis`?"),
        ("nothing", "`orogen palettes` lists them"),
        ("gone.cpt", "cannot read gone.cpt: no such file"),
    ] {
        let code = if palette == "gone.cpt" { 1 } else { 2 };
        folder.bad(&["map", "small.toml", "-o", "b.png", "--palette", palette], code, expect);
    }
}

#[test]
fn what_cannot_be_drawn_is_a_sentence_and_leaves_nothing() {
    let folder = Folder::with_small();
    for (arguments, code, expect) in [
        (&["-o", "a.jpg"][..], 2, "a map is a .png, .svg or .pdf"),
        (&["-o", "a"], 2, "a map is a .png, .svg or .pdf"),
        (&["-o", "a.png", "--paper", "a9"], 2, "the paper size must be a0 to a5"),
        (&["-o", "a.png", "--landscape"], 2, "--paper"),
        (&["-o", "a.png", "--contours", "0"], 2, "greater than 0"),
        (&["-o", "a.png", "--contours", "0.0001"], 2, "use a larger interval"),
        (&["-o", "a.png", "--size", "500", "--memory", "1MB"], 1, "of memory"),
        (&["-o", "a.png", "--paper", "2000x2000mm", "--dpi", "1200"], 2, "use a lower resolution"),
        (&["-o", "a.png", "--window", "0,0,1,1"], 2, "a map needs at least 2 x 2 finite heights"),
        (&["-o", "none/a.png", "--size", "200"], 1, "the folder does not exist"),
    ] {
        folder.bad(&[&["map", "small.toml"][..], arguments].concat(), code, expect);
        assert_eq!(folder.names(""), ["small.toml"], "{arguments:?}");
    }
}

#[test]
fn any_layer_colors_a_map() {
    let folder = Folder::with_small();
    let text = crate::harness::SMALL.replace(
        "[outputs]",
        "[nodes.water]\nop = \"drainage\"\nsource = \"land\"\n[nodes.same]\nop = \"constant\"\nvalue = 1\n[outputs]",
    );
    folder.write("wet.toml", text);
    let map = |out: &str, options: &[&str]| {
        let told = folder.good(&[&["map", "wet.toml", "-o", out, "--size", "300"][..], options].concat());
        (told.text().to_string(), folder.read(out))
    };
    let (_, heights) = map("h.png", &[]);
    let mut seen = vec![heights];
    for options in [
        &["--layer", "slope"][..],
        &["--layer", "aspect"],
        &["--layer", "water.flow"],
        &["--layer", "water.flow", "--ramp", "linear"],
        &["--layer", "water.flow", "--range", "1000,10000"],
        &["--layer", "water.watershed"],
        &["--layer", "noise", "--palette", "magma"],
        &["--layer", "noise", "--contours", "20"],
        &["--layer", "same"],
    ] {
        let (told, picture) = map("l.png", options);
        assert!(told.starts_with(&format!("l.png: {}, ", options[1])), "{told}");
        assert!(!seen.contains(&picture), "{options:?}");
        seen.push(picture);
    }
    map("l.svg", &["--layer", "water.flow"]);
    map("l.pdf", &["--layer", "slope"]);
    for (options, expect) in [
        (&["--layer", "nothing"][..], "nothing"),
        (&["--layer", "normal"], "`normal` has 3 channels"),
        (&["--layer", "slope", "--range", "5"], "two numbers, the lower first"),
        (&["--layer", "slope", "--range", "9,5"], "the lower first"),
        (&["--color", "surfaces", "--layer", "slope"], "applies to --color palette"),
        (&["--color", "biomes", "--layer", "slope"], "applies to --color palette"),
        (&["--color", "surfaces", "--palette", "viridis"], "applies to --color palette"),
        (&["--color", "surfaces", "--range", "0,5"], "applies to --color palette"),
        (&["--ramp", "log"], "needs a --layer other than height"),
        (&["--layer", "noise", "--ramp", "log", "--range", "-1,1"], "a logarithmic ramp needs values above 0"),
        (&["--layer", "slope", "--palette", "hypsometric"], "applies to heights only"),
    ] {
        folder.bad(&[&["map", "wet.toml", "-o", "x.png", "--size", "300"][..], options].concat(), 2, expect);
    }
}

#[test]
fn a_size_is_for_every_kind_of_file() {
    let folder = Folder::with_small();
    let size = |out: &str, size: &str| {
        folder.good(&["map", "small.toml", "-o", out, "--size", size, "-q"]);
        folder.read(out).len()
    };
    for out in ["a.svg", "a.pdf"] {
        assert!(size(out, "2000") > size(out, "400") + 100_000, "{out}");
    }
}

#[test]
fn surfaces_color_a_map() {
    let folder = Folder::with_small();
    let own = crate::harness::SMALL.to_string()
        + "\n[[surface]]\nname = \"lava\"\ncolor = \"#c03010\"\n[[surface]]\nname = \"ash\"\ncolor = \"#303030\"\nslope = [0, 20]\n";
    folder.write("own.toml", own);
    folder.good(&["map", "small.toml", "-o", "heights.png", "--size", "400", "-q"]);
    let mut seen = vec![folder.read("heights.png")];
    for recipe in ["small.toml", "own.toml"] {
        let told = folder.good(&["map", recipe, "-o", "a.png", "--size", "400", "--colour", "surfaces"]);
        assert!(told.text().starts_with("a.png: surfaces, "), "{}", told.text());
        assert!(!seen.contains(&folder.read("a.png")), "{recipe}");
        seen.push(folder.read("a.png"));
        folder.good(&["map", recipe, "-o", "b.png", "--size", "400", "--color", "surfaces", "--threads", "1", "-q"]);
        assert_eq!(folder.read("a.png"), folder.read("b.png"), "{recipe}");
    }
    for out in ["a.svg", "a.pdf"] {
        folder.good(&["map", "own.toml", "-o", out, "--size", "400", "--color", "surfaces", "--paper", "a4", "-q"]);
    }
}

#[test]
fn biomes_color_a_map() {
    let folder = Folder::with_small();
    let climate = "\n[nodes.warm]\nop = \"temperature\"\nsource = \"land\"\n[nodes.wet]\nop = \"orographic-rain\"\nsource = \"land\"\n\
        [nodes.cover]\nop = \"biome\"\nscheme = \"holdridge\"\ntemperature = \"warm\"\nrain = \"wet\"\n";
    let biomes = |output: &str| crate::harness::SMALL.replace("[outputs]", &format!("{climate}[outputs]\n{output}"));
    folder.write("biomes.toml", biomes("cover = \"cover\""));
    let told = folder.good(&["map", "biomes.toml", "-o", "a.png", "--size", "400", "--color", "biomes"]);
    assert!(told.text().starts_with("a.png: biomes, "), "{}", told.text());
    folder.good(&["map", "biomes.toml", "-o", "b.png", "--size", "400", "--color", "biomes", "--threads", "1", "-q"]);
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
    // As a layer, they have their own colors and names, unless others are chosen.
    let layer = |more: &[&str]| {
        let map = ["map", "biomes.toml", "-o", "l.svg", "--size", "400", "--layer", "cover", "--force", "-q"];
        folder.good(&[&map[..], more].concat());
        folder.text("l.svg")
    };
    let own = layer(&[]);
    assert!(own != layer(&["--ramp", "labels"]) && own != layer(&["--palette", "viridis"]));
    folder.good(&[
        "map",
        "biomes.toml",
        "-o",
        "b.svg",
        "--size",
        "400",
        "--color",
        "biomes",
        "--no-summits",
        "--no-contours",
        "--no-rivers",
        "--no-lakes",
        "-q",
    ]);
    assert!(own == folder.text("b.svg"));
    folder.write("none.toml", biomes(""));
    folder.bad(
        &["map", "none.toml", "-o", "c.png", "--size", "400", "--color", "biomes"],
        2,
        "no output of this recipe is the layer of a `biome`",
    );
}

#[test]
fn terrain_classes_color_a_map_and_are_exported() {
    let folder = Folder::with_small();
    let classes = "[[class]]\nname = \"meadow\"\n[[class]]\nname = \"lava\"\ncolor = \"red\"\nshare = { of = \"noise\", highest = 0.25 }\n";
    folder.write("classes.toml", format!("{}{classes}", crate::harness::SMALL));
    let told = folder.good(&["map", "classes.toml", "-o", "a.png", "--size", "400", "--color", "classes"]);
    assert!(told.text().starts_with("a.png: classes, "), "{}", told.text());
    folder.write("other.toml", folder.text("classes.toml").replace("red", "blue"));
    folder.good(&["map", "other.toml", "-o", "b.png", "--size", "400", "--color", "classes", "-q"]);
    assert_ne!(folder.read("a.png"), folder.read("b.png"), "the color of a class is its own");
    folder.bad(&["map", "small.toml", "-o", "c.png", "--color", "classes"], 2, "this recipe has no terrain classes");
    folder.good(&["export", "classes.toml", "-o", "class.csv", "--layer", "class", "--size", "64", "-q"]);
    let text = folder.text("class.csv");
    let count = |code: &str| text.lines().filter(|line| line.ends_with(code)).count();
    assert_eq!((count(",1"), count(",0")), (768, 2304), "64 x 48 samples");
}

#[test]
fn the_docs_list_all_classes() {
    use orogen::grid::climate::biomes::Scheme;
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/climate.md")).unwrap();
    for scheme in [Scheme::Whittaker, Scheme::Holdridge, Scheme::KoppenGeiger] {
        for class in scheme.classes() {
            let [red, green, blue] = class.color;
            let row = format!("| {} | {} | `#{red:02x}{green:02x}{blue:02x}` |", class.code, class.name);
            assert!(text.contains(&row), "{row} in {scheme:?}");
        }
    }
}

#[test]
fn a_range_colors_maps_alike() {
    let folder = Folder::with_small();
    let map = |options: &[&str]| {
        folder.good(&[&["map", "small.toml", "-o", "a.png", "--size", "300", "-q"][..], options].concat());
        folder.read("a.png")
    };
    assert_ne!(map(&[]), map(&["--range", "-500,4000"]));
    assert_ne!(map(&["--palette", "viridis"]), map(&["--palette", "viridis", "--range", "-500,4000"]));
}

#[test]
fn names_of_places_are_drawn_and_those_left_out_are_listed() {
    let folder = Folder::with_solutions();
    let map = ["map", "hills", "--window", "0,0,101,81", "--cell", "10", "--no-contours", "-o"];
    let with = |more: &[&'static str]| [&map[..], more].concat();
    folder.write("places.csv", "\u{feff}x;y;name\n500;-400;Ford\n-5;-400;Beyond\n700;-200;\n");
    folder.good(&with(&["plain.svg"]));
    let outcome = folder.good(&with(&["named.svg", "--names", "places.csv"]));
    let expect = "warning: `Beyond` is outside the map, which extends from 0 to 1000 east and from -800 to 0 north\n";
    assert_eq!(outcome.err, expect);
    assert!(folder.text("named.svg").len() > folder.text("plain.svg").len() + 500, "the name, its dot and the legend");
    // The same points as GeoJSON give the same sheet.
    let points = r#"{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"name":"Ford"},
        "geometry":{"type":"Point","coordinates":[500,-400]}}]}"#;
    folder.write("places.geojson", points);
    folder.good(&with(&["again.svg", "--names", "places.geojson"]));
    assert_eq!(folder.text("again.svg"), folder.text("named.svg"));
    // Twenty places within a few metres have no room for all names.
    let crowd: String = (0..20).map(|k| format!("{},-400,Crowded town {k}\n", 500 + k)).collect();
    folder.write("crowd.csv", format!("x,y,name\n{crowd}"));
    let outcome = folder.good(&with(&["crowd.svg", "--names", "crowd.csv"]));
    assert!(outcome.err.starts_with("warning: there is no room for `Crowded town"), "{}", outcome.err);
    for (name, content, why) in [
        ("empty.csv", "x,y,name\n", "it has no points"),
        ("bad.csv", "x,y,name\n1,two,A\n", "line 2"),
        ("places.txt.gz", "", "points are read from .csv and .geojson"),
    ] {
        folder.write(name, content);
        folder.bad(&with(&["no.svg", "--names", name]), 1, why);
    }
    folder.bad(&with(&["places.csv", "--format", "svg", "--force", "--names", "places.csv"]), 1, "places.csv");
}

#[test]
fn a_scale_sets_the_size_of_the_page() {
    let folder = Folder::with_solutions();
    let map = |more: &[&'static str]| [&["map", "hills", "--window", "0,0,101,81", "--cell", "10"][..], more].concat();
    // 1000 m are 200 mm at 1 : 5000, and 100 mm at 1 : 10 000.
    let width = |scale: &'static str| {
        folder.good(&map(&["-o", "a.svg", "--scale", scale]));
        let text = folder.text("a.svg");
        text.split("width=\"").nth(1).unwrap().split("mm").next().unwrap().parse::<f64>().unwrap()
    };
    assert!((width("5000") - width("1e4") - 100.0).abs() < 0.5, "{} {}", width("5000"), width("1e4"));
    folder.bad(&map(&["-o", "b.svg", "--scale", "10"]), 2, "choose a scale from 1 : 200 to 1 : 50000");
    folder.bad(&map(&["-o", "b.svg", "--scale", "1e4", "--paper", "a4"]), 2, "--paper");
}

#[test]
fn contours_at_given_heights() {
    let folder = Folder::with_solutions();
    let map = |more: &[&'static str]| {
        [&["map", "hills", "--window", "0,0,101,81", "--cell", "150", "--no-summits", "--no-rivers"][..], more].concat()
    };
    let told = folder.good(&map(&["-o", "a.png", "--levels", "250,100,9000,100"]));
    assert!(told.text().ends_with(", contours at 100, 250 m\n"), "{}", told.text());
    assert_eq!(told.err, "warning: there is no contour at 9000 m\n");
    folder.good(&map(&["-o", "b.svg", "--levels", "200", "-q"]));
    folder.good(&map(&["-o", "c.svg", "--levels", "200,201", "-q"]));
    folder.good(&map(&["-o", "d.svg", "--no-contours", "-q"]));
    let [one, two, none] = ["b.svg", "c.svg", "d.svg"].map(|name| folder.text(name).matches("stroke=").count());
    assert!(none < one && one <= two, "{none} {one} {two}");
    // Contours of the heights on a map of another layer.
    let told = folder.good(&map(&["-o", "e.png", "--layer", "slope", "--levels", "200"]));
    assert!(told.text().ends_with(", contours at 200 m\n"), "{}", told.text());
    for (more, why) in [
        (&["--levels", "100", "--contours", "50"][..], "--contours"),
        (&["--levels", "100,high"], "numbers separated by commas"),
        (&["--levels", ""], "numbers separated by commas"),
        (&["--levels", "100", "--labels", "index"], "no index contours"),
        (&["--labels", "all", "--no-labels"], "--no-labels"),
    ] {
        folder.bad(&[&map(&["-o", "x.png"])[..], more].concat(), 2, why);
    }
}

#[test]
fn every_contour_with_room_has_a_label() {
    let folder = Folder::with_solutions();
    let areas = |labels: &'static str| {
        let map = ["map", "hills", "--window", "0,0,201,161", "--cell", "40", "--contours", "20", "-o", "a.svg", "-q"];
        folder.good(&[&map[..], &["--labels", labels, "--no-summits", "--no-legend", "--force"]].concat());
        folder.text("a.svg").matches("<path fill=\"#").count()
    };
    let [none, index, all] = ["none", "index", "all"].map(areas);
    assert!(none < index && all > none + 2 * (index - none), "{none} {index} {all}");
}

#[test]
fn a_grid_has_lines_at_round_coordinates() {
    let folder = Folder::with_solutions();
    // 4000 m are 160 mm at 1 : 25 000, so that 500 m are 20 mm.
    let map = |more: &[&'static str]| {
        let map =
            ["map", "hills", "--window", "0,0,101,81", "--cell", "40", "--scale", "25000", "--no-color", "-q", "-o"];
        [&map[..], more].concat()
    };
    let lines = |file: &'static str, more: &[&'static str]| {
        folder.good(&map(&[&[file], more].concat()));
        let text = folder.text(file);
        let grid = text.split("stroke-width=\"0.150\"").nth(1).unwrap_or_default();
        grid.split("/>").next().unwrap_or_default().matches('M').count()
    };
    // 9 lines from west to east and 7 from north to south, including the lines at both ends.
    assert_eq!(lines("a.svg", &["--grid"]), 9 + 7);
    assert_eq!(lines("b.svg", &["--grid", "1000"]), 5 + 4);
    assert_eq!(lines("c.svg", &[]), 0);
    folder.bad(&map(&["x.svg", "--grid", "2"]), 2, "less than 1 mm apart on this map; use at least 50 m");
    folder.bad(&map(&["x.svg", "--grid", "no"]), 2, "to leave it out, write --grid at the end");
}

#[test]
fn colors_of_the_page_and_its_lines() {
    let folder = Folder::with_solutions();
    let colors =
        ["--page-color", "#102030", "--ink-color", "ivory", "--water-color", "#00ff80", "--contour-color", "red"];
    let map = |file: &'static str| {
        let map = ["map", "hills", "--window", "0,0,201,161", "--cell", "40", "--size", "500", "-q", "-o", file];
        folder.good(&[&map[..], &colors].concat());
        folder.read(file)
    };
    let picture = png(&map("a.png"));
    assert_eq!(picture.data[..3], [0x10, 0x20, 0x30], "the page");
    let text = String::from_utf8(map("a.svg")).unwrap();
    for part in ["height=\"100%\" fill=\"#102030\"", "stroke=\"#00ff80\"", "stroke=\"#ff0000\"", "fill=\"#fffff0\""] {
        assert!(text.contains(part), "{part}");
    }
    assert!(!text.contains("#262422"), "the ink of other pages");
    assert!(map("a.pdf").starts_with(b"%PDF-1.4"));
    folder.bad(&["map", "hills", "-o", "b.png", "--page-color", "papyrus"], 2, "a color must be #rrggbb or a name");
}

#[test]
fn names_of_summits_rivers_and_lines() {
    let folder = Folder::with_solutions();
    let map = |file: &'static str, more: &[&'static str]| {
        let map = ["map", "hills", "--cell", "60", "--no-contours", "--no-legend", "-o", file];
        folder.good(&[&map[..], more].concat()).err
    };
    map("plain.svg", &[]);
    folder.write(
        "names.csv",
        "name,kind,x,y,height\nHorn,summit,5450,-9570,\nTarn,lake,4750,-6700,\nAshburn,river,6300,-2400,\n",
    );
    assert_eq!(map("named.svg", &["--names", "names.csv"]), "");
    assert_eq!(map("dry.svg", &["--names", "names.csv", "--no-rivers"]), "warning: no river is drawn near `Ashburn`\n");
    // The names of water are blue, like rivers.
    let blue = |file: &str| folder.text(file).matches("fill=\"#225c9c\"").count();
    assert_eq!((blue("plain.svg"), blue("named.svg"), blue("dry.svg")), (0, 2, 1));
    folder.write(
        "lines.geojson",
        r#"{"type":"FeatureCollection","features":[
        {"type":"Feature","properties":{"name":"Long Water"},"geometry":{"type":"LineString","coordinates":[[2000,-5500],[6000,-5600]]}},
        {"type":"Feature","properties":{"name":"Old Road","kind":"road"},"geometry":{"type":"LineString","coordinates":[[2000,-9500],[6000,-9600]]}},
        {"type":"Feature","properties":{"name":"Far"},"geometry":{"type":"LineString","coordinates":[[-2000,500],[-60,600]]}}]}"#,
    );
    let told = map("lines.svg", &["--names", "lines.geojson"]);
    assert!(told.starts_with("warning: `Far` is outside the map") && told.lines().count() == 1, "{told}");
    assert_eq!(blue("lines.svg"), 1);
    folder.bad(
        &["export", "hills", "--layer", "watershed", "--outlets", "lines.geojson", "-o", "a.geojson"],
        1,
        "outlets are points",
    );
}

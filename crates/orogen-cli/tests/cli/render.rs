//! `orogen render`.

use crate::harness::{Folder, png};

const QUICK: [&str; 6] = ["render", "small.toml", "--size", "96x54", "--samples", "1"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&QUICK[..], more].concat()
}

#[test]
fn a_view_is_a_picture_and_the_same_on_any_number_of_threads() {
    let folder = Folder::with_small();
    let outcome = folder.good(&with(&[]));
    assert!(outcome.text().starts_with("view.png: 96 x 54 pixels"), "{}", outcome.text());
    let picture = png(&folder.read("view.png"));
    assert_eq!((picture.width, picture.height, picture.channels), (96, 54, 3));
    assert!(picture.data.iter().any(|byte| *byte > 150) && picture.data.iter().any(|byte| *byte < 90));
    folder.good(&with(&["--threads", "1", "-q", "-o", "one.png"]));
    assert!(folder.read("one.png") == folder.read("view.png"));
}

#[test]
fn every_choice_makes_another_picture() {
    let folder = Folder::with_small();
    let mut seen: Vec<Vec<u8>> = Vec::new();
    for choice in [
        &["--colors", "natural"][..],
        &["--color", "desert"],
        &["--colour", "map"],
        &["--colors", "clay"],
        &["--edge", "haze"],
        &["--sun", "100,20"],
        &["--time", "17:00", "--latitude", "-20", "--day", "10"],
        &["--haze", "4"],
        &["--exaggeration", "2"],
        &["--snow-line", "20"],
        &["--camera", "20,60"],
        &["--camera", "20,60,2000"],
        &["--camera", "20,400,300", "--look", "400,200"],
        &["--fov", "20", "--camera", "200,24,900"],
        &["--seed", "9"],
        &["--window", "0,0,20,20"],
        &["--cell", "30"],
    ] {
        folder.good(&with(&[choice, &["-o", "a.png"]].concat()));
        let data = png(&folder.read("a.png")).data;
        assert!(!seen.contains(&data), "{choice:?}");
        seen.push(data);
    }
}

#[test]
fn an_underground_camera_is_lifted_with_a_note() {
    let folder = Folder::with_small();
    let outcome = folder.good(&with(&["--camera", "300,300,-900", "--look", "500,200"]));
    assert!(outcome.err.contains("note: the camera was below the ground and was raised by"), "{}", outcome.err);
}

#[test]
fn what_cannot_be_is_a_sentence_and_leaves_nothing() {
    let folder = Folder::with_small();
    for (wrong, message) in [
        (&["-o", "a.jpg"][..], "the extension .png"),
        (&["--camera", "1"], "AZIMUTH,ELEVATION[,DISTANCE]"),
        (&["--camera", "1,2,3,4"], "AZIMUTH,ELEVATION[,DISTANCE]"),
        (&["--camera", "1,100"], "must be from -90 to 90"),
        (&["--camera", "1,-5"], "must be above the horizon"),
        (&["--camera", "1,5,0"], "greater than 0"),
        (&["--camera", "a,b"], "numbers separated by commas"),
        (&["--camera", "1,2", "--look", "3,4"], "X,Y,HEIGHT"),
        (&["--camera", "1,2,3", "--look", "1,2"], "directly above the point that it looks at"),
        (&["--sun", "290"], "AZIMUTH,ELEVATION"),
        (&["--sun", "290,91"], "to 90"),
        (&["--time", "25:00"], "23:59"),
        (&["--time", "02:00"], "it is up from"),
        (&["--time", "12:00", "--latitude", "80", "--day", "355"], "never rises"),
        (&["--time", "12:00", "--latitude", "95"], "from -90 to 90"),
        (&["--fov", "170"], "1 to 150"),
        (&["--exaggeration", "1000"], "0.01 to 100"),
        (&["--haze", "1000"], "0 to 100"),
        (&["--size", "99999x5"], "32768"),
        (&["--window", "0,0,1,9"], "not 1 x 9"),
        (&["--memory", "1kB"], "memory"),
    ] {
        let arguments: Vec<&str> = match wrong.contains(&"--size") {
            true => [&["render", "small.toml"], wrong].concat(),
            false => with(wrong),
        };
        let outcome = folder.run(&arguments);
        assert!(outcome.code != 0 && outcome.err.contains(message), "{wrong:?}: {}", outcome.err);
    }
    folder.bad(&with(&["-o", "none/a.png"]), 1, "cannot write into none");
    assert_eq!(folder.names(""), ["small.toml"]);
}

#[test]
fn a_turntable_goes_into_one_file_or_many() {
    let folder = Folder::with_small();
    let turn = ["--turntable", "4", "--delay", "70", "-o"];
    let outcome = folder.good(&with(&[&turn[..], &["turn.png"]].concat()));
    assert!(outcome.text().starts_with("turn.png: 4 frames of 96 x 54 pixels"), "{}", outcome.text());
    folder.good(&with(&[&turn[..], &["turn.gif"]].concat()));
    folder.good(&with(&[&turn[..], &["turn-%02d.png"]].concat()));
    let names = ["small.toml", "turn-00.png", "turn-01.png", "turn-02.png", "turn-03.png", "turn.gif", "turn.png"];
    assert_eq!(folder.names(""), names);
    // Views from four sides at the same distance; the first is the first frame of the animation.
    let frames: Vec<Vec<u8>> = (0..4).map(|k| png(&folder.read(&format!("turn-0{k}.png"))).data).collect();
    assert!((1..4).all(|k| frames[k] != frames[0]) && png(&folder.read("turn.png")).data == frames[0]);
    assert!(folder.read("turn.gif").starts_with(b"GIF89a"));
    folder.bad(&with(&["-o", "turn.gif"]), 2, "or write frames with --turntable");
    folder.bad(&with(&["--turntable", "4", "-o", "turn.mp4"]), 2, "cannot be written as .mp4");
    folder.bad(&with(&["--turntable", "4", "-o", "none/a-%d.png"]), 1, "cannot write into none");
    folder.bad(&with(&["--colors", "natural", "--palette", "viridis"]), 2, "--palette applies to --color map");
    folder.bad(&with(&["--colors", "map", "--palette", "viridos"]), 2, "did you mean `viridis`?");
    folder.good(&with(&["--colors", "map", "--palette", "viridis", "-o", "palette.png"]));
}

#[test]
fn noises_move_in_a_gif_too() {
    let folder = Folder::new();
    folder.good(&["noise", "perlin", "--size", "16", "--frames", "3", "-o", "a.gif"]);
    folder.good(&["noise", "perlin", "--size", "16", "--frames", "3", "--texture", "marble", "-o", "b-%d.png"]);
    assert_eq!(folder.names(""), ["a.gif", "b-0.png", "b-1.png", "b-2.png"]);
    folder.bad(&["noise", "perlin", "--frames", "3", "--bits", "16", "-o", "c.gif"], 2, "a GIF has 8 bits");
    folder.bad(&["noise", "perlin", "-o", "c.gif"], 2, ".gif");
}

#[test]
fn land_that_is_higher_than_wide_is_told_with_the_factor_to_use() {
    let folder = Folder::with_small();
    folder.write(
        "high.toml",
        "orogen = 1\nworld = { size = [64, 48], cell = 2 }\noutputs = { height = \"h\" }\nnodes.n = { op = \"perlin\", wavelength = 40 }\nnodes.h = { op = \"expr\", expr = \"1000 * n\" }\n",
    );
    let render = |recipe: &'static str| ["render", recipe, "--size", "32x18", "--samples", "1"];
    let said = folder.good(&render("high.toml")).err;
    assert!(said.contains("m high but only 64 m wide; use an exaggeration of about 0.01"), "{said}");
    assert!(!folder.good(&[&render("high.toml")[..], &["--exaggeration", "0.01"]].concat()).err.contains("wide"));
    assert_eq!(folder.good(&render("small.toml")).err, "");
    let solid = folder.good(&["export", "high.toml", "-o", "high.stl"]);
    assert!(solid.text().contains("\nwarning: the land is "), "{}", solid.text());
}

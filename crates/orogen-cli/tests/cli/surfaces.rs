//! Surfaces that cover the ground.

use crate::harness::{Folder, png};

/// A slope that rises eastward from -100 m to 900 m, with sand below, rock above and moss between.
const RECIPE: &str = r##"
orogen = 1
[world]
size = [1000, 640]
cell = 10
[nodes.land]
op = "ramp"
length = 1
[nodes.metres]
op = "remap"
source = "land"
from = [0, 1000]
to = [-100, 900]
[outputs]
height = "metres"
[[surface]]
name = "rock"
color = "#808080"
roughness = 0.5
[[surface]]
name = "sand"
picture = "sand.png"
grain = 100
height = { max = 200 }
[[surface]]
name = "moss"
color = "#204010"
height = [200, 500]
[[surface]]
name = "sand"
color = "#ffe0a0"
roughness = 1
layers = { land = { min = 950 } }
"##;

fn folder() -> Folder {
    let folder = Folder::new();
    // Two colors with the same number of pixels.
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.write_header().unwrap().write_image_data(&[200, 180, 140, 120, 100, 60]).unwrap();
    folder.write("sand.png", &bytes);
    folder.write("a.toml", RECIPE);
    folder
}

#[test]
fn weights_albedo_and_roughness_follow_the_rules() {
    let folder = folder();
    folder.good(&["export", "a.toml", "-o", "w.png", "--layer", "splat", "-q"]);
    let weights = png(&folder.read("w.png"));
    let names: Vec<String> = folder.json("w.json")["channels"]
        .as_array()
        .map_or(Vec::new(), |channels| channels.iter().map(ToString::to_string).collect());
    assert!(folder.text("w.json").contains("rock") && folder.text("w.json").contains("moss"), "{names:?}");
    folder.good(&["export", "a.toml", "-o", "c.png", "--layer", "albedo", "-q"]);
    let colors = png(&folder.read("c.png"));
    assert_eq!((colors.width, colors.height, colors.channels), (100, 64, 3));
    folder.good(&["export", "a.toml", "-o", "r.npy", "--layer", "roughness", "-q"]);
    let roughness = crate::harness::npy(&folder.read("r.npy"));
    let weight = |i: usize| {
        let at = (20 * 100 + i) * weights.channels;
        [0, 1, 2].map(|channel| weights.data[at + channel])
    };
    let color = |i: usize| [0, 1, 2].map(|channel| colors.data[(20 * 100 + i) * 3 + channel]);
    // Channels: rock, sand, moss. Sample i has a height of 10 i - 100 metres.
    for (i, expect, rough) in
        [(5, [0, 255, 0], 0.9), (40, [0, 0, 255], 0.9), (80, [255, 0, 0], 0.5), (97, [0, 255, 0], 1.0)]
    {
        assert_eq!(weight(i), expect, "{i}");
        assert_eq!(roughness[(i, 20)], rough, "{i}");
    }
    assert_eq!([color(40), color(80), color(97)], [[0x20, 0x40, 0x10], [0x80; 3], [0xff, 0xe0, 0xa0]]);
    // The picture's two colors cover half of the sand each, with a short blend between them.
    let sand: Vec<[u8; 3]> = (0..25)
        .flat_map(|i| (0..64).map(move |j| (i, j)))
        .map(|(i, j)| [0, 1, 2].map(|channel| colors.data[(j * 100 + i) * 3 + channel]))
        .collect();
    let share = |color: [u8; 3]| sand.iter().filter(|own| **own == color).count() as f64 / sand.len() as f64;
    let (light, dark) = (share([200, 180, 140]), share([120, 100, 60]));
    assert!(light > 0.3 && dark > 0.3 && light + dark > 0.9, "{light} {dark}");
}

#[test]
fn meshes_wear_them() {
    let folder = folder();
    folder.good(&["export", "a.toml", "-o", "a.obj", "--surfaces", "-q"]);
    folder.good(&["export", "a.toml", "-o", "c.png", "--layer", "albedo", "-q"]);
    assert!(png(&folder.read("a-texture.png")).data == png(&folder.read("c.png")).data, "the albedo");
    folder.good(&["export", "a.toml", "-o", "a.glb", "--surfaces", "-q"]);
    let glb = folder.read("a.glb");
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let json: serde_json::Value = serde_json::from_slice(&glb[20..20 + length]).unwrap();
    let material = &json["materials"][0];
    assert_eq!(material["occlusionTexture"]["index"], 1);
    assert_eq!(material["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"], 1);
    let picture = |image: usize| {
        let view = &json["bufferViews"][json["images"][image]["bufferView"].as_u64().unwrap() as usize];
        let start = 20 + length + 8 + view["byteOffset"].as_u64().unwrap() as usize;
        png(&glb[start..start + view["byteLength"].as_u64().unwrap() as usize])
    };
    assert!(picture(0).data == png(&folder.read("c.png")).data);
    // Occlusion, roughness, metalness of the rock: a slope of 45 degrees, where three quarters of the sky are visible;
    // a roughness of 0.5; no metal.
    let packed = picture(1);
    let at = 3 * (20 * 100 + 80);
    assert_eq!(packed.data[at..at + 3], [192, 128, 0]);
    folder.bad(
        &["export", "a.toml", "-o", "b.glb", "--surfaces", "--color", "vertex"],
        2,
        "--surfaces writes a texture",
    );
}

#[test]
fn a_render_shows_them_and_what_is_wrong_is_told_at_its_place() {
    let folder = folder();
    folder.good(&["render", "a.toml", "-o", "view.png", "--size", "160x90", "--colors", "surfaces", "-q"]);
    folder.good(&["render", "a.toml", "-o", "natural.png", "--size", "160x90", "-q"]);
    assert!(folder.read("view.png") != folder.read("natural.png"));
    folder.write("b.toml", RECIPE.replace("sand.png", "none.png"));
    // The picture is read only for colors.
    folder.good(&["export", "b.toml", "-o", "h.npy", "-q"]);
    folder.bad(&["export", "b.toml", "-o", "x.png", "--layer", "albedo"], 1, "surface `sand`: cannot read");
    // The picture is an input, so it is not overwritten.
    folder.bad(
        &["export", "a.toml", "-o", "sand.png", "--layer", "albedo", "--force"],
        1,
        "this command reads that file",
    );
    folder.write("c.toml", RECIPE.replace("height = [200, 500]", "height = [500, 200]"));
    let error = folder.bad(&["export", "c.toml", "-o", "x.png", "--layer", "albedo"], 1, "lower bound of `height`").err;
    assert!(error.contains("c.toml:28:10"), "{error}");
    assert!(!folder.names("").iter().any(|name| name.starts_with('x')));
}

#[test]
fn a_preview_shows_what_weights_mean() {
    let folder = folder();
    let said = folder.good(&["export", "a.toml", "-o", "w.png", "--layer", "splat", "--preview"]).text().to_string();
    assert!(said.contains("\n  w_preview.png: the surfaces in their colors"), "{said}");
    let preview = folder.read("w_preview.png");
    let picture = png(&preview);
    assert_eq!((picture.width, picture.data.len()), (100, 3 * 100 * 64));
    // The slope is uniform, so each surface has a single shade of its color: the shade of a map, which is lighter than
    // the albedo.
    let pixel = |i: usize| [0, 1, 2].map(|c| picture.data[3 * (20 * 100 + i) + c]);
    let shaded = |color: [u8; 3], i: usize| {
        let light = color.map(orogen::io::palette::color::decode);
        [0, 1, 2].map(|c| orogen::io::palette::color::decode(pixel(i)[c]) / light[c])
    };
    let [rock, moss] = [shaded([0x80; 3], 80), shaded([0x20, 0x40, 0x10], 45)];
    for (a, b) in rock.iter().zip(moss) {
        assert!((a - b).abs() < 0.1 * a, "{rock:?} {moss:?}");
    }
    assert!(rock.iter().all(|factor| (1.2..2.2).contains(factor)), "{rock:?}");
    assert_ne!(pixel(80), pixel(45));
    // The ground below the sea is bluer than the sand above it.
    let blue = |[red, _, blue]: [u8; 3]| i32::from(blue) - i32::from(red);
    assert!(blue(pixel(2)) > blue(pixel(20)) + 40, "{:?} {:?}", pixel(2), pixel(20));
    // The weights are the same without the preview. The preview is the same with other layouts, threads and order of
    // rows.
    folder.good(&["export", "a.toml", "-o", "plain.png", "--layer", "splat", "-q"]);
    assert_eq!(folder.read("plain.png"), folder.read("w.png"));
    let line =
        ["export", "a.toml", "-o", "v.png", "--layer", "splat", "--preview", "--threads", "1", "--first-row", "south"];
    folder.good(&[&line[..], &["--weights", "layers", "-q"]].concat());
    assert_eq!(png(&folder.read("v_preview.png")).data, picture.data);
    // Exports for engines include it with each tile, over the same pixels.
    let engine =
        ["export", "a.toml", "-o", "u.png", "--layer", "splat", "--target", "unity", "--size", "33", "--preview"];
    folder.good(&[&engine[..], &["--tiles", "2x1", "-q"]].concat());
    assert_eq!(png(&folder.read("u_1_0_preview.png")).width, 32);
    // A file of another kind is not replaced, and nothing is written.
    folder.write("x_preview.png", "mine");
    folder.bad(&["export", "a.toml", "-o", "x.png", "--layer", "splat", "--preview"], 1, "x_preview.png");
    assert!(folder.text("x_preview.png") == "mine" && !folder.path("x.png").exists());
    folder.write("named.toml", RECIPE.replace("\"moss\"", "\"preview\""));
    for (args, expect) in [
        (&["a.toml", "-o", "y.png", "--layer", "normal", "--preview"][..], "--preview applies to the layer `splat`"),
        (&["a.toml", "-o", "y.png", "--preview"], "--preview applies to the layer `splat`; leave it out for `height`"),
        (&["a.toml", "-o", "y.exr", "--layer", "splat", "--preview"], "--preview does not apply to the format exr"),
        (&["a.toml", "-o", "y.png", "--layer", "splat", "--target", "unity", "--weights", "layers"], "sets --weights"),
        (
            &["named.toml", "-o", "y.png", "--layer", "splat", "--preview", "--weights", "layers"],
            "a surface is named `preview`, as is the file of --preview; use --weights rgba",
        ),
    ] {
        folder.bad(&[&["export"][..], args].concat(), 2, expect);
    }
}

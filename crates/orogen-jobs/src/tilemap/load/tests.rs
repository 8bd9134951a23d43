//! Tilesets that are written and read again, and broken tilesets.

use std::path::PathBuf;

use orogen_grid::autotile::mask::Layout;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::test_folder::TestFolder;

use super::any::load;
use crate::tilemap::art::set::SETS;
use crate::tilemap::tiled::write_tsx;
use crate::tilemap::tileset::{Fit, Tileset};

/// A folder with a picture of 8 x 2 tiles of 4 pixels, with a margin of 1 and a spacing of 2; tile n has n in its first
/// channel.
fn folder() -> TestFolder {
    let folder = TestFolder::new("tilesets").unwrap();
    let [width, height] = [8, 2].map(|tiles| 2 + tiles * 4 + (tiles - 1) * 2);
    let picture = Picture::new(width, height, Pixel::Rgba8);
    let mut bytes = Vec::new();
    png::write(&mut bytes, &picture, |rows, out| {
        for (pixel, at) in out.as_chunks_mut::<4>().0.iter_mut().zip(rows.start * width..) {
            let [x, y] = [at % width, at / width].map(|at| at.saturating_sub(1) / 6);
            *pixel = [(y * 8 + x) as u8, 0, 255, 255];
        }
        Ok(())
    })
    .unwrap();
    std::fs::write(folder.join("tiles.png"), bytes).unwrap();
    folder
}

fn write(folder: &TestFolder, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

fn read(folder: &TestFolder, name: &str, text: &str) -> Tileset {
    load(&write(folder, name, text), None, None).unwrap().tileset
}

fn error(folder: &TestFolder, name: &str, text: &str) -> String {
    load(&write(folder, name, text), None, None).unwrap_err().to_string()
}

const HEAD: &str = "picture = \"tiles.png\"\nsize = 4\nmargin = 1\nspacing = 2\n";

/// Tilesets written for Tiled are read back, except for tiles of single cells, which no wang set contains.
#[test]
fn tilesets_are_read_as_they_were_written() {
    let folder = TestFolder::new("tilesets").unwrap();
    for layout in Layout::ALL {
        let own = SETS[0].draw(layout);
        let [mut tsx, mut picture] = [Vec::new(), Vec::new()];
        write_tsx(&own, &mut tsx, "tiles.png", "test").unwrap();
        own.write_png(&mut picture, &[]).unwrap();
        std::fs::write(folder.join("tiles.png"), picture).unwrap();
        let again = read(&folder, "tiles.tsx", std::str::from_utf8(&tsx).unwrap());
        assert_eq!((&again.terrains, again.count, again.columns), (&own.terrains, own.count, own.columns));
        assert!(again.pixels == own.pixels);
        let wanted = own.tiles.iter().filter(|tile| !matches!(tile.fit, Fit::Layer { mask: 0, .. }));
        let corner = if layout == Layout::Dual { Layout::Corner } else { layout };
        assert_eq!((again.tiles.iter().collect::<Vec<_>>(), again.layout), (wanted.collect::<Vec<_>>(), corner));
        if layout == Layout::Dual {
            let dual = load(&folder.join("tiles.tsx"), Some(layout), None).unwrap().tileset;
            assert_eq!(dual.layout, layout);
        }
    }
}

#[test]
fn descriptions_have_masks_turns_and_margins() {
    let folder = folder();
    let text = format!(
        "{HEAD}layout = \"edge\"\nturns = [\"rotate\"]\nprefer_unturned = true\n[[class]]\nname = \"a\"\nfull = [0, {{ tile = 9, weight = 3 }}]\n\
         [[class]]\nname = \"b\"\ncolor = \"#102030\"\nfull = [1]\ntiles = {{ 0 = [2], 1 = [3], 5 = [4], 17 = [5], 21 = [6] }}"
    );
    let set = read(&folder, "set.toml", &text);
    assert!(set.drawable().is_complete(), "turned, six tiles are all sixteen");
    assert_eq!((set.count, set.columns, set.name.as_str(), set.terrains[1].color), (16, 8, "set", [16, 32, 48]));
    assert_eq!([set.row(9, 3)[3], set.row(15, 0)[0]], [[9, 0, 255, 255], [15, 0, 255, 255]]);
    assert_eq!(set.tiles.iter().map(|tile| tile.weight).fold(0.0, f32::max), 3.0);
    // A quarter of a separate picture: tile 3 has a border on all sides except the north.
    assert_eq!(set.tiles.iter().filter(|tile| tile.picture == 3).count(), 4);
}

#[test]
fn rules_are_tried_in_order() {
    let folder = folder();
    let text = format!(
        "{HEAD}layout = \"rule\"\n[[class]]\nname = \"a\"\nfull = [0]\n[[class]]\nname = \"b\"\nfull = [1]\n\
         [[class.rule]]\npattern = [\"...\", \".#.\", \"...\"]\ntiles = [2]\n\
         [[class.rule]]\npattern = [\"?.?\", \"?#?\", \"???\"]\ntiles = [3, 4]\nturns = [\"rotate\"]"
    );
    let set = read(&folder, "set.toml", &text);
    assert!(set.drawable().is_complete());
    let of = |mask: u8| {
        let fits = set.tiles.iter().filter(|tile| tile.fit == Fit::Layer { class: 1, mask });
        fits.map(|tile| tile.picture).collect::<Vec<_>>()
    };
    assert_eq!((of(0), of(255), of(0b1111_1110), of(0b1111_1011)), (vec![2], vec![1], vec![3, 4], vec![3, 4]));
}

#[test]
fn wrong_descriptions_are_explained() {
    let folder = folder();
    let class = "[[class]]\nname = \"a\"\nfull = [0]\n";
    for (text, expected) in [
        (format!("{HEAD}layout = \"hex\"\n{class}"), "`hex` is none of blob, edge, corner, dual and rule"),
        (format!("{HEAD}layout = \"blob\"\nsides = 3\n{class}"), "unknown field `sides`"),
        (format!("{HEAD}layout = \"blob\""), "0 tables `[[class]]`"),
        (format!("{HEAD}layout = \"blob\"\n{class}{class}"), "two classes `a`"),
        (
            format!("{HEAD}layout = \"blob\"\n[[class]]\nname = \"a\"\nfull = [16]"),
            "the tile 16, but the picture has the tiles 0 to 15",
        ),
        (format!("{HEAD}layout = \"blob\"\n[[class]]\nname = \"a\"\nfirst = 4294967295"), "first tile at 4294967295"),
        (
            format!("{HEAD}layout = \"blob\"\n{class}tiles = {{ 2 = [1] }}"),
            "the mask `2`, which the layout `blob` does not have",
        ),
        (format!("{HEAD}layout = \"blob\"\n{class}[[class]]\nname = \"b\""), "`b` has no tiles"),
        (format!("{HEAD}layout = \"blob\"\n{class}[[class]]\nname = \"b\"\ntiles = {{ 1 = [1] }}"), "no full tile"),
        (
            format!("{HEAD}layout = \"blob\"\n{class}[[class.rule]]\npattern = [\"#\"]\ntiles = [1]"),
            "rules need the layout `rule`",
        ),
        (format!("{HEAD}layout = \"rule\"\n{class}[[class.rule]]\npattern = [\"#\"]\ntiles = [1]"), "needs three rows"),
        (
            format!(
                "{HEAD}layout = \"rule\"\n{class}[[class.rule]]\npattern = [\"???\", \"?#?\", \"???\"]\ntiles = [1]\n\
                 [[class.rule]]\npattern = [\"###\", \"?#?\", \"???\"]\ntiles = [1]"
            ),
            "a rule that is never used, number 2",
        ),
        (
            format!("{HEAD}layout = \"blob\"\n[[class]]\nname = \"a\"\nfull = [{{ tile = 1, weight = 0 }}]"),
            "weight of 0",
        ),
        (
            format!("{HEAD}layout = \"blob\"\n[[class]]\nname = \"a\"\nfull = [\"x\"]"),
            "invalid type: string \"x\", expected the number of a tile, or a table such as { tile = 0, weight = 5 }",
        ),
        (
            format!("{HEAD}layout = \"blob\"\n[[class]]\nname = \"a\"\nfull = [-1]"),
            "invalid value: integer `-1`, expected the number of a tile",
        ),
        (
            format!("{HEAD}layout = \"blob\"\n[[class]]\nname = \"a\"\nfull = [{{ tile = 1, wight = 2 }}]"),
            "unknown field `wight`, expected `tile` or `weight`",
        ),
        ("picture = \"none.png\"\nsize = 4\nlayout = \"blob\"\n".into(), "none.png"),
        ("picture = \"tiles.png\"\nsize = 400\nlayout = \"blob\"\n".into(), "hold no tile of 400 x 400 pixels"),
        ("picture = \"tiles.png\"\nsize = 0\nlayout = \"blob\"\n".into(), "`size` must be 1 to 65536"),
        ("picture = \"set.toml\"\nsize = 4\nlayout = \"blob\"\n".into(), "no readable PNG"),
    ] {
        let message = error(&folder, "set.toml", &text);
        assert!(message.contains(expected) && message.contains("set.toml") | message.contains(".png"), "{message}");
    }
}

/// A tileset of Tiled with this content.
fn tsx(content: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<tileset version=\"1.8\" name=\"t\" tilewidth=\"4\" tileheight=\"4\" spacing=\"2\" margin=\"1\" tilecount=\"16\" columns=\"8\">\n\
         <image source=\"tiles.png\" width=\"46\" height=\"12\"/>{content}</tileset>"
    )
}

/// A wang set of a type with two colors.
fn set(name: &str, kind: &str, tiles: &[(usize, &str)]) -> String {
    let tiles: String =
        tiles.iter().map(|(id, wang)| format!("<wangtile tileid=\"{id}\" wangid=\"{wang}\"/>")).collect();
    let color = |name: &str| format!("<wangcolor name=\"{name}\" color=\"#ff112233\" tile=\"-1\" probability=\"1\"/>");
    format!("<wangset name=\"{name}\" type=\"{kind}\" tile=\"-1\">{}{}{tiles}</wangset>", color("dirt"), color("grass"))
}

#[test]
fn wang_sets_of_tiled_are_layers_or_wang_tiles() {
    let folder = folder();
    let several = set(
        "Ground",
        "corner",
        &[(0, "0,1,0,1,0,1,0,1"), (1, "0,2,0,2,0,2,0,2"), (2, "0,1,0,2,0,2,0,2"), (3, "0,1,0,0,0,0,0,0")],
    );
    let found = read(
        &folder,
        "a.tsx",
        &tsx(&format!(
            "<transformations hflip=\"1\" vflip=\"1\" rotate=\"0\" preferuntransformed=\"1\"/><wangsets>{several}</wangsets>"
        )),
    );
    assert!(found.is_wang);
    assert_eq!(found.layout, Layout::Corner);
    let names: Vec<&str> = found.terrains.iter().map(|terrain| terrain.name.as_str()).collect();
    assert_eq!((names, found.terrains[0].color), (vec!["dirt", "grass"], [0x11, 0x22, 0x33]));
    // Three tiles, and the mixed one flipped; the incomplete tile is omitted.
    assert_eq!(found.tiles.len(), 3 + 3);
    let single = set("Path", "edge", &[(4, "1,0,1,0,1,0,1,0"), (5, "1,0,0,0,0,0,0,0")]);
    let found =
        read(&folder, "b.tsx", &tsx(&format!("<tile id=\"4\" probability=\"0.5\"/><wangsets>{single}</wangsets>")));
    assert_eq!((found.is_wang, found.layout), (false, Layout::Edge));
    let names: Vec<&str> = found.terrains.iter().map(|terrain| terrain.name.as_str()).collect();
    assert_eq!(names, ["none", "dirt", "grass"], "a path needs something below it");
    assert_eq!((found.tiles[0].fit, found.tiles[0].weight), (Fit::Layer { class: 1, mask: 0x55 }, 0.5));

    for weight in ["nan", "-5", "inf", "1,5", ""] {
        let tile = format!("<tile id=\"4\" probability=\"{weight}\"/><wangsets>{single}</wangsets>");
        let message = error(&folder, "w.tsx", &tsx(&tile));
        let expect = format!("the probability of its tile 4 is `{weight}`; it must be a number of at least 0");
        assert!(message.contains(&expect), "{message}");
    }

    let both = write(&folder, "c.tsx", &tsx(&format!("<wangsets>{several}{single}</wangsets>")));
    let message = load(&both, None, None).unwrap_err().to_string();
    assert!(message.contains("choose one with --wang-set: `Ground`, `Path`"), "{message}");
    assert!(load(&both, None, Some("Path")).is_ok());
    let message = load(&both, None, Some("Road")).unwrap_err().to_string();
    assert!(message.contains("no wang set `Road`"), "{message}");
    let message = load(&both, Some(Layout::Blob), Some("Path")).unwrap_err().to_string();
    assert!(message.contains("layout `edge`, not `blob`"), "{message}");
}

#[test]
fn wrong_tilesets_of_tiled_are_explained() {
    let folder = folder();
    let sets = |content: String| tsx(&format!("<wangsets>{content}</wangsets>"));
    for (text, expected) in [
        ("<map/>".to_string(), "its content is a `map`"),
        ("<tileset".to_string(), "not valid XML"),
        (tsx(""), "no wang set"),
        (tsx("").replace("<image source=\"tiles.png\" width=\"46\" height=\"12\"/>", ""), "collections of pictures"),
        (tsx("").replace("tileheight=\"4\"", "tileheight=\"8\""), "4 x 8 pixels; they must be squares"),
        (tsx("").replace("tilewidth=\"4\"", "tilewidth=\"x\""), "`tilewidth` is `x`"),
        (sets(set("a", "corner", &[(16, "0,1,0,1,0,1,0,1")])), "the tile 16, but the picture has 16 tiles"),
        (sets(set("a", "corner", &[(0, "0,9,0,1,0,1,0,1")])), "the color 9, but the wang set `a` has 2"),
        (sets(set("a", "corner", &[(0, "0x1111")])), "is not eight numbers"),
        (sets(set("a", "", &[(0, "0,1,0,1,0,1,0,1")])), "has no type"),
        (sets(set("a", "corner", &[(0, "0,1,0,2,0,0,0,0")])), "no tile with all its sides and corners"),
    ] {
        let message = error(&folder, "a.tsx", &text);
        assert!(message.contains(expected), "{message}");
    }
}

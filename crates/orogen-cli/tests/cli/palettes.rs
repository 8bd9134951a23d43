//! `orogen palettes`.

use crate::harness::{Folder, png};

#[test]
fn a_list_and_a_page_with_ones_from_files() {
    let folder = Folder::new();
    let outcome = folder.good(&["palettes"]);
    assert!(outcome.text().starts_with("hypsometric"), "{}", outcome.text());
    assert!(
        outcome.text().contains("viridis     * dark blue through green") && outcome.text().contains("\nturbo         ")
    );
    folder.write("own.toml", "name = \"Autumn\"\nstops = [[0, \"#2c5f2d\"], [1800, \"white\"]]\n");
    folder.write("relief.txt", "0% 10 20 30\n100% white\n");
    folder.good(&["palettes", "-o", "a.png", "-q"]);
    let told = folder.good(&["palettes", "own.toml", "relief.txt", "-o", "b.png"]).text().to_string();
    assert!(told.contains("\nAutumn") && told.contains("\nrelief"), "{told}");
    let [a, b] = ["a.png", "b.png"].map(|name| png(&folder.read(name)));
    assert!(a.width == b.width && a.height < b.height && a.channels == 3);
}

#[test]
fn what_cannot_be_read_is_a_sentence() {
    let folder = Folder::new();
    folder.write("bad.cpt", "0 red 1 blurple\n");
    folder.write("bytes.gpl", [0xff, 0xfe, 0x00]);
    for (file, expect) in [
        ("bad.cpt", "cannot read the palette bad.cpt: line 1: `blurple` is not a color"),
        ("bytes.gpl", "not UTF-8 text"),
        ("none.txt", "cannot read none.txt: no such file"),
    ] {
        folder.bad(&["palettes", file], 1, expect);
    }
    folder.bad(&["palettes", "-o", "a.jpg"], 2, "the extension .png");
}

//! `orogen compare`.

use crate::harness::{Folder, png};

#[test]
fn the_page_is_one_picture_that_grows_with_its_parts() {
    let folder = Folder::new();
    let outcome = folder.good(&["compare", "--size", "120"]);
    assert!(outcome.text().starts_with("compare.png: 30 noises and aggregates of seed 4"), "{}", outcome.text());
    folder.good(&["compare", "--size", "240", "-o", "b.png", "-q"]);
    folder.good(&["compare", "--size", "120", "-o", "c.png", "--seed", "5", "-q"]);
    folder.good(&["compare", "--size", "120", "-o", "d.png", "--seed", "4", "-q"]);
    let [a, b, c] = ["compare.png", "b.png", "c.png"].map(|name| png(&folder.read(name)));
    assert_eq!((a.bits, a.channels), (8, 1));
    assert!(a.width.abs_diff(b.width / 2) <= 1 && a.height.abs_diff(b.height / 2) <= 1);
    assert!((a.width, a.height) == (c.width, c.height) && a.data != c.data);
    assert_eq!(folder.read("compare.png"), folder.read("d.png"));
    // The corners have the paper color, and the margin has text.
    assert!(a.data.first() == a.data.last() && a.data[0] > 240);
    assert!(a.data.iter().take(a.width * 60).any(|&grey| grey < 60), "a title");
}

#[test]
fn what_cannot_be_drawn_is_a_sentence_and_leaves_nothing() {
    let folder = Folder::new();
    for (arguments, code, expect) in [
        (&["--size", "0"][..], 2, "120..=4000"),
        (&["--size", "5000"], 2, "120..=4000"),
        (&["--seed", "-1"], 2, "a seed must be a whole number"),
        (&["-o", "a.npy"], 2, "the extension .png"),
        (&["-o", "a.pgn"], 2, "the extension .png instead of a.pgn"),
        (&["-o", "none/a.png"], 1, "the folder does not exist"),
        (&["--memory", "1MB"], 1, "of memory, and 977 KiB is allowed"),
        (&["perlin"], 2, "unexpected argument"),
    ] {
        folder.bad(&[&["compare"][..], arguments].concat(), code, expect);
        assert!(folder.names("").is_empty(), "{arguments:?}");
    }
}

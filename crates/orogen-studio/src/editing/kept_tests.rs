//! What the studio keeps in a recipe.

use super::document::Document;
use super::edit::Edit;
use super::kept::{Frame, Kept, KeptExport};

const TEXT: &str = "orogen = 1\n# The land.\n[nodes.hills]\nop = \"fbm\"\n[nodes.soft]\nop = \"blur\"\nsource = \"hills\"\n[outputs]\nheight = \"soft\"\n";

fn kept() -> Kept {
    let export = KeptExport {
        kind: "layer".into(),
        file: "a \"b\".tif".into(),
        size: Some(512),
        part: Some([1.5, -2.0, 1000.0]),
        options: [("bits".to_owned(), "16".to_owned())].into(),
        ..KeptExport::default()
    };
    let frame = Frame { title: "基础".into(), nodes: vec!["hills".into(), "soft".into()] };
    Kept { exports: vec![export.clone(), export], frames: vec![frame], locked: vec!["hills".into()], ..Kept::default() }
}

#[test]
fn what_is_kept_is_in_the_text_and_comes_back() {
    let mut document = Document::new("test", TEXT.to_owned()).unwrap();
    let recipe = document.recipe().clone();
    document.apply(&Edit::Keep(kept())).unwrap();
    assert!(document.is_valid() && *document.kept() == kept(), "{}", document.text());
    assert_eq!(*document.recipe(), recipe, "it has no effect on the world");
    document.apply(&Edit::Keep(Kept::default())).unwrap();
    assert_eq!(document.text(), TEXT);
    assert!(document.undo() && *document.kept() == kept());
    for broken in ["studio = 1\n", "[studio]\nexports = 3\n", "[studio]\nlater = true\n"] {
        assert_eq!(Kept::of(broken), Kept::default());
    }
}

#[test]
fn it_follows_renamed_and_deleted_nodes_and_locked_ones_stay() {
    let mut document = Document::new("test", TEXT.to_owned()).unwrap();
    document.apply(&Edit::Keep(kept())).unwrap();
    document.apply(&Edit::Rename { from: "hills".into(), to: "land".into() }).unwrap();
    assert_eq!(document.kept().locked, ["land"]);
    assert_eq!(document.kept().frames[0].nodes, ["land", "soft"]);
    let blocked = [
        Edit::Delete(vec!["soft".into(), "land".into()]),
        Edit::Reset { node: "land".into(), key: "gain".into() },
        Edit::Connect { node: "land".into(), input: "mask".into(), source: orogen::declare::Input::Value(0.0) },
    ];
    for edit in blocked {
        let error = document.apply(&edit).unwrap_err().to_string();
        assert!(error.contains("`land` is locked"), "{error}");
    }
    document.apply(&Edit::Delete(vec!["soft".into()])).unwrap();
    assert_eq!(document.kept().frames[0].nodes, ["land"]);
    assert!(document.text().contains("nodes = [\"land\"]"), "{}", document.text());
}

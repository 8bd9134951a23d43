//! Groups: grouping does not change the land.

use orogen::declare::Input;
use orogen::recipe::Recipe;
use orogen::{Options, Session, Window, presets};

use super::*;
use crate::editing::document::Document;
use crate::editing::edit::Edit;

#[test]
fn names_tell_their_groups() {
    assert_eq!((group_of("a/b/c"), own_name("a/b/c"), group_of("a")), ("a/b", "c", ""));
    assert_eq!((rest("a/b/c", "a"), rest("ab/c", "a"), rest("a", "")), (Some("b/c"), None, Some("a")));
    assert_eq!((inner("a/b/c", ""), inner("a/b/c", "a"), inner("a/b", "a")), (Some("a"), Some("a/b"), None));
    assert_eq!(common(["a/b/c", "a/b/d", "a/e"].into_iter()), "a");
    assert_eq!(common(["a/b/c", "d"].into_iter()), "");
    assert_eq!((within("", "a"), within("g", "a")), ("a".into(), "g/a".into()));
}

const TEXT: &str = r#"orogen = 1

[world]
size = 1000

# The hills.
[nodes.hills]
op = "fbm"

[nodes.rough]
op = "ridged"
wavelength = 90

[nodes.land]
op = "expr"
expr = "hills * 100 + rough" # in metres

[nodes.soft]
op = "blur"
source = "land"
radius = 30
mask = "hills"

[outputs]
height = "soft"

[[surface]]
name = "grass"
color = "green"

[[surface]]
name = "mud"
color = "brown"
layers = { rough = { min = 0.2 } }
"#;

fn document() -> Document {
    Document::new("test", TEXT.into()).unwrap()
}

fn names(document: &Document) -> Vec<&str> {
    document.recipe().nodes().iter().map(|named| named.name.as_str()).collect()
}

fn group(nodes: &[&str], name: &str) -> Edit {
    Edit::Group { nodes: nodes.iter().map(|node| (*node).to_owned()).collect(), name: name.into() }
}

#[test]
fn nodes_are_grouped_and_ungrouped_where_they_stand() {
    let mut document = document();
    document.apply(&group(&["hills", "rough"], "noises")).unwrap();
    assert_eq!(names(&document), ["noises/hills", "noises/rough", "land", "soft"]);
    let text = document.text().to_owned();
    for part in [
        "# The hills.\n[nodes.\"noises/hills\"]",
        "hills = \"noises/hills\"",
        "mask = \"noises/hills\"",
        "# in metres",
        "\"noises/rough\" = { min = 0.2 }",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    // A group around a group, another name, and then both dissolved.
    document.apply(&group(&["noises/hills", "noises/rough", "land"], "base")).unwrap();
    assert_eq!(names(&document), ["base/noises/hills", "base/noises/rough", "base/land", "soft"]);
    document.apply(&Edit::RenameGroup { from: "base/noises".into(), to: "base/waves".into() }).unwrap();
    assert_eq!(names(&document)[1], "base/waves/rough");
    document.apply(&Edit::Ungroup("base".into())).unwrap();
    assert_eq!(names(&document), ["waves/hills", "waves/rough", "land", "soft"]);
    document.apply(&Edit::Ungroup("waves".into())).unwrap();
    assert_eq!(names(&document), ["hills", "rough", "land", "soft"]);
    // Each was one step.
    (0..5).for_each(|_| assert!(document.undo()));
    assert!(document.text() == TEXT && !document.undo());
    assert!(document.redo() && document.text() == text);
}

#[test]
fn other_edits_work_within_groups() {
    let mut document = document();
    document.apply(&group(&["hills", "land"], "g")).unwrap();
    document.apply(&Edit::Duplicate(vec!["g/hills".into(), "g/land".into()])).unwrap();
    assert_eq!(names(&document)[4..], ["g2/hills", "g2/land"]);
    let copy = document.recipe().nodes()[5].node.clone();
    assert_eq!(copy.input(0), &Input::Node("g2/hills".into()), "{}", document.text());
    document.apply(&Edit::Duplicate(vec!["g/hills".into()])).unwrap();
    assert_eq!(names(&document)[6], "g/hills2");
    document.apply(&Edit::Rename { from: "g/hills2".into(), to: "spare".into() }).unwrap();
    document.apply(&Edit::Delete(vec!["g2/hills".into(), "g2/land".into(), "spare".into()])).unwrap();
    document
        .apply(&Edit::Connect { node: "soft".into(), input: "mask".into(), source: Input::Node("g/land".into()) })
        .unwrap();
    document.apply(&Edit::Delete(members(document.recipe(), "g"))).unwrap();
    assert_eq!(names(&document), ["rough", "soft"]);
    assert!(document.is_valid());
}

#[test]
fn names_that_are_taken_are_left_alone() {
    let mut document = document();
    document.apply(&group(&["hills", "land"], "g")).unwrap();
    document.apply(&Edit::Rename { from: "rough".into(), to: "land".into() }).unwrap();
    assert!(document.apply(&group(&["soft"], "g")).unwrap_err().to_string().contains("a group `g`"));
    assert!(document.apply(&group(&[], "h")).is_err() && document.apply(&Edit::Ungroup("h".into())).is_err());
    assert_eq!(free(document.recipe(), "", "g"), "g2");
    document.apply(&Edit::Ungroup("g".into())).unwrap();
    assert_eq!(names(&document), ["hills", "land", "land2", "soft"]);
}

#[test]
fn a_group_is_known_by_its_nodes() {
    let mut document = document();
    document.apply(&group(&["hills", "rough"], "a")).unwrap();
    document.apply(&group(&["a/hills", "a/rough", "land"], "b")).unwrap();
    let of = |names: &[&str]| {
        of_selection(document.recipe(), &names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>())
    };
    assert_eq!(of(&["b/a/rough", "b/a/hills"]).as_deref(), Some("b/a"));
    assert_eq!(of(&["b/land", "b/a/rough", "b/a/hills"]).as_deref(), Some("b"));
    assert_eq!((of(&["b/a/rough"]), of(&["soft"]), of(&[])), (None, None, None));
}

#[test]
fn what_a_used_recipe_has_is_not_changed() {
    let text = "orogen = 1\n[world]\nsize = 1000\n[nodes.top]\nop = \"constant\"\nvalue = 3\n[use.hills]\nrecipe = \"hills\"\n\
                [nodes.land]\nop = \"add\"\na = \"hills\"\nb = \"top\"\n[outputs]\nheight = \"land\"\n";
    let mut document = Document::new("test", text.into()).unwrap();
    let inner = members(document.recipe(), "hills");
    assert!(!inner.is_empty() && is_group(document.recipe(), "hills"));
    for edit in [
        Edit::Ungroup("hills".into()),
        Edit::Delete(inner.clone()),
        Edit::Duplicate(inner.clone()),
        Edit::Group { nodes: vec!["land".into(), inner[0].clone()], name: "g".into() },
        Edit::Connect { node: inner[0].clone(), input: "mask".into(), source: Input::Value(0.5) },
    ] {
        let error = document.apply(&edit).unwrap_err().to_string();
        assert!(error.contains("[use.hills]"), "{edit:?}: {error}");
    }
    assert_eq!(document.text(), text);
}

/// The bits of the heights of a small window.
fn bits(session: &Session, recipe: &Recipe) -> Vec<u32> {
    let world = session.open(recipe.draft(8)).unwrap();
    let window = match recipe.world.size {
        Some(_) => world.window_fitting(12).unwrap(),
        None => Window::new(12, 12, recipe.world.cell * 40.0),
    };
    let heights = world.window(&crate::studio::surface(recipe), &window).unwrap();
    heights.data().iter().map(|height| height.to_bits()).collect()
}

/// Random selections in every preset: the content key of the heights and their bits do not change.
#[test]
fn the_land_of_every_preset_stays_when_nodes_are_grouped_and_ungrouped() {
    let session = Session::new(Options::default()).unwrap();
    let mut state = 7_u64;
    let mut below = move |end: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % end.max(1)
    };
    for preset in presets::all() {
        let mut document = Document::of_preset(preset).unwrap();
        let before = document.recipe().clone();
        let key = |recipe: &Recipe| {
            let world = session.open(recipe.clone()).unwrap();
            recipe.outputs().map(|output| world.key(output).unwrap()).collect::<Vec<_>>()
        };
        let (keys, heights) = (key(&before), bits(&session, &before));
        for round in 0..4 {
            let all: Vec<String> = document.recipe().nodes().iter().map(|named| named.name.clone()).collect();
            let nodes: Vec<String> = all.into_iter().filter(|_| below(2) == 0).collect();
            let name = free(document.recipe(), common(nodes.iter().map(String::as_str)), "group");
            if nodes.is_empty() {
                continue;
            }
            document.apply(&Edit::Group { nodes, name }).unwrap_or_else(|error| panic!("{}: {error}", preset.name));
            assert_eq!(key(document.recipe()), keys, "{}", preset.name);
            if round == 3 {
                assert_eq!(bits(&session, document.recipe()), heights, "{}", preset.name);
            }
        }
        while let Some(group) = document.recipe().nodes().iter().find_map(|named| inner(&named.name, "")) {
            let group = group.to_owned();
            document.apply(&Edit::Ungroup(group)).unwrap_or_else(|error| panic!("{}: {error}", preset.name));
        }
        assert_eq!(key(document.recipe()), keys, "{}", preset.name);
        assert_eq!(bits(&session, document.recipe()), heights, "{}", preset.name);
        let nodes = |recipe: &Recipe| recipe.nodes().iter().map(|named| named.name.clone()).collect::<Vec<_>>();
        assert_eq!(nodes(document.recipe()), nodes(&before), "{}", preset.name);
    }
}

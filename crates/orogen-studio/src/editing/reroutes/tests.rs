//! Reroutes: their form in the recipe, and what they follow.

use orogen::declare::Input;

use super::*;
use crate::editing::document::Document;
use crate::editing::edit::Edit;
use crate::editing::kept::Kept;

const TEXT: &str = "orogen = 1\n[nodes.hills]\nop = \"fbm\"\n[nodes.\"g/base\"]\nop = \"fbm\"\n[nodes.\"g/soft\"]\nop = \"blur\"\nsource = \"g/base\"\nmask = \"hills\"\n[nodes.end]\nop = \"add\"\na = \"g/soft\"\nb = \"hills\"\n[outputs]\nheight = \"end\"\n";

fn document() -> Document {
    Document::new("test", TEXT.to_owned()).unwrap()
}

fn input(from: &str, node: &str, key: &str, group: &str) -> Reroute {
    let reader = Reader::Input { node: node.into(), key: key.into() };
    Reroute { from: from.into(), reader, group: group.into(), points: vec![[0.5, 0.0, -40.0], [0.75, 10.5, 20.0]] }
}

fn output(from: &str, name: &str) -> Reroute {
    Reroute { reader: Reader::Output(name.into()), ..input(from, "", "", "") }
}

/// A document with points on wires of all kinds: within a group, into it, at its outside, to a mask and to an output.
fn rerouted() -> (Document, Vec<Reroute>) {
    let all = vec![
        input("g/base", "g/soft", "source", "g"),
        input("hills", "g/soft", "mask", ""),
        input("hills", "g/soft", "mask", "g"),
        input("g/soft", "end", "a", "g"),
        input("hills", "end", "b", ""),
        output("end", "height"),
    ];
    let mut document = document();
    for one in &all {
        document.apply(&Edit::Reroute(one.clone())).unwrap();
    }
    assert_eq!(document.kept().reroutes, all);
    (document, all)
}

#[test]
fn points_are_in_the_text_and_each_edit_is_a_step() {
    let mut document = document();
    let recipe = document.recipe().clone();
    let first = input("hills", "end", "b", "");
    document.apply(&Edit::Reroute(first.clone())).unwrap();
    let line = "{ from = \"hills\", input = \"b\", node = \"end\", points = [[0.5, 0.0, -40.0], [0.75, 10.5, 20.0]] },";
    assert!(document.text().contains(&format!("[studio]\nreroutes = [\n  {line}\n]")), "{}", document.text());
    assert_eq!(*document.recipe(), recipe, "they have no effect on the world");
    assert_eq!(Kept::of(document.text()).reroutes, std::slice::from_ref(&first));
    let moved = Reroute { points: vec![[0.1, 2.0, 3.0]], ..first.clone() };
    document.apply(&Edit::Reroute(moved.clone())).unwrap();
    assert_eq!(document.kept().reroutes, [moved]);
    document.apply(&Edit::Reroute(Reroute { points: Vec::new(), ..first.clone() })).unwrap();
    assert_eq!(document.text(), TEXT);
    assert!(document.undo() && document.undo());
    assert_eq!(document.kept().reroutes, [first]);
    assert!(document.undo() && !document.undo());
    assert_eq!(document.text(), TEXT);
}

#[test]
fn they_follow_new_names_and_groups() {
    let (mut document, all) = rerouted();
    document.apply(&Edit::Rename { from: "hills".into(), to: "land".into() }).unwrap();
    assert_eq!(document.kept().reroutes[1], input("land", "g/soft", "mask", ""));
    document.apply(&Edit::RenameGroup { from: "g".into(), to: "k".into() }).unwrap();
    let expect = [
        input("k/base", "k/soft", "source", "k"),
        input("land", "k/soft", "mask", ""),
        input("land", "k/soft", "mask", "k"),
        input("k/soft", "end", "a", "k"),
        input("land", "end", "b", ""),
        output("end", "height"),
    ];
    assert_eq!(document.kept().reroutes, expect);
    // Without the group, its own view of the wires is gone.
    document.apply(&Edit::Ungroup("k".into())).unwrap();
    let expect = [
        input("base", "soft", "source", ""),
        input("land", "soft", "mask", ""),
        input("land", "end", "b", ""),
        output("end", "height"),
    ];
    assert_eq!(document.kept().reroutes, expect);
    // In a group with both ends, a wire is shown there.
    document.apply(&Edit::Group { nodes: vec!["land".into(), "end".into()], name: "all".into() }).unwrap();
    assert_eq!(document.kept().reroutes[2], input("all/land", "all/end", "b", "all"));
    assert_eq!(document.kept().reroutes[1], input("all/land", "soft", "mask", ""));
    for _ in 0..4 {
        assert!(document.undo());
    }
    assert_eq!(document.kept().reroutes, all);
}

#[test]
fn they_go_away_with_their_wires() {
    let gone = |edit: Edit| -> Vec<usize> {
        let (mut document, all) = rerouted();
        document.apply(&edit).unwrap_or_else(|error| panic!("{edit:?}: {error}"));
        let kept = document.kept().reroutes.clone();
        assert!(document.undo() && document.kept().reroutes == all);
        all.iter().enumerate().filter(|(_, one)| !kept.contains(one)).map(|(k, _)| k).collect()
    };
    let connect =
        |node: &str, input: &str, source: Input| Edit::Connect { node: node.into(), input: input.into(), source };
    assert_eq!(gone(connect("g/soft", "mask", Input::None)), [1, 2]);
    assert_eq!(gone(connect("end", "b", Input::Node("g/base".into()))), [4]);
    assert_eq!(gone(connect("end", "b", Input::Value(0.0))), [4]);
    assert_eq!(gone(Edit::Output { name: "height".into(), source: Input::Node("hills".into()) }), [5]);
    assert_eq!(gone(Edit::Delete(vec!["end".into()])), [3, 4, 5]);
    assert_eq!(gone(Edit::Delete(vec!["hills".into(), "g/soft".into()])), [0, 1, 2, 3, 4]);
    assert_eq!(gone(Edit::Seed(5)), Vec::<usize>::new());
    // What is typed over is left out with the next edit.
    let (mut document, all) = rerouted();
    document.type_text(document.text().replace("b = \"hills\"", "b = 3"));
    document.apply(&Edit::Seed(5)).unwrap();
    assert_eq!(document.kept().reroutes.len(), all.len() - 1);
}

#[test]
fn copies_of_nodes_have_copies_of_the_points() {
    let (mut document, all) = rerouted();
    document.apply(&Edit::Duplicate(vec!["end".into(), "hills".into()])).unwrap();
    let kept = &document.kept().reroutes;
    assert_eq!(kept[..all.len()], all);
    assert_eq!(kept[all.len()..], [input("g/soft", "end2", "a", "g"), input("hills2", "end2", "b", "")]);
    document.undo();
    document.apply(&Edit::Duplicate(vec!["g/base".into(), "g/soft".into()])).unwrap();
    let expect = [
        input("g2/base", "g2/soft", "source", "g2"),
        input("hills", "g2/soft", "mask", ""),
        input("hills", "g2/soft", "mask", "g2"),
    ];
    assert_eq!(document.kept().reroutes[all.len()..], expect);
}

#[test]
fn what_is_no_reroute_is_ignored_and_the_rest_stays() {
    let good = "{ from = \"hills\", node = \"end\", input = \"b\", points = [[0.5, 0, -40]] }";
    let read = |list: &str| Kept::of(&format!("{TEXT}[studio]\nlocked = [\"hills\"]\nreroutes = {list}\n"));
    for bad in [
        "3",
        "\"b\"",
        "1979-05-27",
        "{}",
        "{ from = 3, node = \"end\", input = \"b\", points = [[0.5, 0, 0]] }",
        "{ from = \"hills\", points = [[0.5, 0, 0]] }",
        "{ from = \"hills\", node = \"end\", points = [[0.5, 0, 0]] }",
        "{ from = \"hills\", node = \"end\", input = \"b\", output = \"height\", points = [[0.5, 0, 0]] }",
        "{ from = \"hills\", node = \"end\", input = \"b\" }",
        "{ from = \"hills\", node = \"end\", input = \"b\", points = [] }",
        "{ from = \"hills\", node = \"end\", input = \"b\", points = [[0.5, 0]] }",
        "{ from = \"hills\", node = \"end\", input = \"b\", points = [[nan, 0, 0]] }",
        "{ from = \"hills\", node = \"end\", input = \"b\", points = [[0.5, inf, 0]] }",
        "{ from = \"hills\", node = \"end\", input = \"b\", points = [[7, 0, 0], [0.5, 1e300, 0], [0.5, 0, -1e9]] }",
    ] {
        let kept = read(&format!("[{bad}, {good}]"));
        assert_eq!((kept.reroutes.len(), kept.locked.len()), (1, 1), "{bad}");
        let kept = read(bad);
        assert_eq!((kept.reroutes.len(), kept.locked.len()), (0, 1), "{bad}");
    }
    let many = vec!["[0.5, 0, 0]"; 1000].join(", ");
    let kept = read(&format!("[{}]", good.replace("[0.5, 0, -40]", &many)));
    assert_eq!(kept.reroutes[0].points.len(), MAX_POINTS);
    // Reroutes of wires that do not exist do no harm, and an edit drops them.
    let text = format!("{TEXT}[studio]\nreroutes = [{}, {good}]\n", good.replace("hills", "none"));
    let mut document = Document::new("test", text).unwrap();
    document.apply(&Edit::Seed(3)).unwrap();
    assert_eq!(document.kept().reroutes.len(), 1);
}

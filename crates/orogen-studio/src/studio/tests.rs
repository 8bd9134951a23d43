//! Random edits, as made by a person in a hurry.

use super::*;
use crate::editing::adding::After;
use crate::editing::kept::Kept;
use crate::editing::{adding, names};
use orogen::declare::Input;
use orogen::node::Node;
use orogen::value::Value;
use orogen::{Budget, Options, presets};
use std::time::Duration;
#[cfg(target_os = "linux")]
use std::time::Instant;

/// Random numbers: splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    fn of<'a, T>(&mut self, items: &'a [T]) -> Option<&'a T> {
        items.get(self.below(items.len()))
    }
}

/// A random edit of a recipe with selected nodes.
fn edit(recipe: &Recipe, selected: &[String], random: &mut Random) -> Option<Edit> {
    let names: Vec<String> = recipe.nodes().iter().map(|named| named.name.clone()).collect();
    let name = random.of(&names)?.clone();
    let node = &recipe.nodes().iter().find(|named| named.name == name)?.node;
    Some(match random.below(12) {
        0 => Edit::Seed(random.next() >> 1),
        1 => Edit::World("sea_level", random.below(500) as f64 - 250.0),
        2 | 3 => {
            let (i, param) = random.of(&node.spec().params.iter().enumerate().collect::<Vec<_>>()).copied()?;
            let value = match node.param(i) {
                Value::Number(own) => Value::Number(own * (random.below(300) as f64 / 100.0)),
                Value::Integer(own) => Value::Integer(own + random.below(5) as i64 - 2),
                Value::Flag(own) => Value::Flag(!own),
                other => other,
            };
            Edit::Param { node: name, key: param.name.into(), value }
        }
        4 => {
            let inputs: Vec<String> = node.inputs().iter().map(|input| input.name.to_owned()).collect();
            let source = Input::Node(random.of(&names)?.clone());
            Edit::Connect { node: name, input: random.of(&inputs)?.clone(), source }
        }
        5 => {
            // Expensive ops are tested elsewhere.
            let ops: Vec<&str> = Node::all()
                .iter()
                .map(|node| node.spec().op)
                .filter(|op| !matches!(*op, "dem" | "exemplar" | "image" | "dla"))
                .collect();
            let op = *random.of(&ops)?;
            let taken = names.iter().map(String::as_str).collect();
            let range = (random.below(2) == 0).then(|| [-50.0, random.below(2000) as f64]);
            let name = names::free(&names::of_op(op), &taken);
            let after = selected.first().map_or(After::Nothing, |selected| After::Node(selected));
            adding::edit(recipe, name, op, after, range)
        }
        6 => Edit::Delete(selected.to_vec()),
        7 => Edit::Duplicate(selected.to_vec()),
        8 => Edit::Group { nodes: selected.to_vec(), name: groups::free(recipe, "", "group") },
        9 => Edit::Ungroup(groups::of_selection(recipe, selected)?),
        10 => Edit::Output { name: HEIGHT.into(), source: Input::Node(name) },
        _ => Edit::Rename { to: format!("n{}", random.below(1000)), from: name },
    })
}

/// Makes random edits for some time, and requests pictures.
#[cfg(target_os = "linux")]
fn edit_for(time: Duration, seed: u64) {
    let begun = Instant::now();
    edit_while(|_| begun.elapsed() < time, seed);
}

/// Makes random edits while `goes_on`, which receives the number of steps so far, returns true, and requests pictures.
/// Returns the number of edits.
fn edit_while(goes_on: impl Fn(usize) -> bool, seed: u64) -> usize {
    let session = Session::new(Options { memory: Budget::of(512 << 20), ..Options::default() }).unwrap();
    let limit = 512 << 20;
    let document = |name: &str| Document::of_preset(presets::find(name).unwrap()).unwrap();
    let mut studio = Studio::new(session, Arc::new(|| ()), document("hills"));
    studio.look.finest = 256;
    let mut random = Random(seed);
    let (mut steps, mut edits) = (0, 0);
    while goes_on(steps) {
        steps += 1;
        match random.below(20) {
            0 => studio.open(document(random.of(&["classic", "island", "mesa", "fjords"]).unwrap())),
            1 | 2 => drop(studio.undo()),
            3 => {
                studio.redo();
                // Typed and undone text may come back.
                if !studio.document.is_valid() {
                    assert!(studio.undo());
                }
            }
            4 => {
                let mut text = studio.document.text().to_owned();
                let at = text.char_indices().nth(random.below(text.chars().count())).map_or(0, |(at, _)| at);
                text.insert_str(at, ["x", "\"", "[", "=", "\n"][random.below(5)]);
                studio.type_text(text);
                assert!(studio.undo());
            }
            6..9 => {
                let nodes = studio.document.recipe().nodes();
                let some = (0..random.below(4)).filter_map(|_| random.of(nodes)).map(|named| named.name.clone());
                studio.selected = some.collect::<HashSet<String>>().into_iter().collect();
            }
            5 => studio.look.layer = random.of(&studio.layers()).unwrap().clone(),
            _ => {
                if let Some(edit) = edit(studio.document.recipe(), &studio.selected, &mut random) {
                    let before = studio.document.text().to_owned();
                    if let Err(error) = studio.edit(&edit) {
                        assert_eq!(studio.document.text(), before, "{edit:?}");
                        let (message, uses_selection) =
                            (error.to_string(), !matches!(edit, Edit::Connect { .. } | Edit::Output { .. }));
                        assert!(!(uses_selection && message.contains("reads itself")), "{edit:?}: {message}");
                        assert!(!message.contains("unknown node"), "{edit:?}: {message}");
                    }
                    edits += 1;
                }
            }
        }
        assert!(studio.document.is_valid(), "{:?}", studio.document.diagnostics());
        let has = |name: &String| studio.document.recipe().nodes().iter().any(|named| named.name == *name);
        assert!(studio.selected.iter().all(has), "{:?}", studio.selected);
        studio.look.finest = 256;
        studio.refresh();
        studio.poll();
        std::thread::sleep(Duration::from_millis(random.next() % 12));
        assert!(studio.session().kept_memory() <= limit, "{}", studio.session().kept_memory());
    }
    edits
}

#[test]
fn what_has_no_effect_on_the_land_makes_no_new_pictures() {
    let session = Session::new(Options::default()).unwrap();
    let mut studio =
        Studio::new(session, Arc::new(|| ()), Document::of_preset(presets::find("hills").unwrap()).unwrap());
    assert!(studio.refresh() && !studio.refresh());
    let node = studio.document.recipe().nodes()[0].name.clone();
    studio.edit(&Edit::Keep(Kept { locked: vec![node.clone()], ..studio.document.kept().clone() })).unwrap();
    studio.edit(&Edit::Note { node, text: "the first".into() }).unwrap();
    assert!(studio.document.history().undo_label().is_some() && !studio.refresh());
    studio.type_text(format!("{}\n[", studio.document.text()));
    assert!(!studio.refresh() && !studio.document.is_valid());
    assert!(studio.undo() && !studio.refresh());
    studio.edit(&Edit::Seed(77)).unwrap();
    assert!(studio.refresh() && studio.undo() && studio.refresh());
}

#[test]
fn json_is_edited_as_toml() {
    let folder = orogen::io::test_folder::TestFolder::new("studio-json").unwrap();
    let path = folder.join("land.json");
    let json = r#"{"orogen": 1, "world": {"cell": 5}, "nodes": {"land": {"op": "fbm", "octaves": 3}}, "outputs": {"height": "land"}}"#;
    std::fs::write(&path, json).unwrap();
    let mut document = open(&path).unwrap();
    assert!(document.text().contains("[nodes.land]") && document.path().is_none());
    document.apply(&Edit::Seed(5)).unwrap();
    assert_eq!((document.recipe().world.seed, document.recipe().world.cell), (5, 5.0));
    std::fs::write(&path, "{\"orogen\": 1").unwrap();
    assert!(open(&path).is_err());
}

#[test]
fn random_edits_do_no_harm() {
    assert!(edit_while(|steps| steps < 300, 1) > 100);
}

/// The memory that this process uses, in bytes, once all cancelled work has ended.
#[cfg(target_os = "linux")]
fn resident() -> u64 {
    let is_working = || {
        let threads = std::fs::read_dir("/proc/self/task").unwrap().flatten();
        let mut names = threads.filter_map(|thread| std::fs::read_to_string(thread.path().join("comm")).ok());
        names.any(|name| name.starts_with("orogen-request"))
    };
    let begun = Instant::now();
    while is_working() && begun.elapsed() < Duration::from_secs(300) {
        std::thread::sleep(Duration::from_millis(20));
    }
    // Without the pages of the program file, more of which are loaded as more of the program runs.
    status("RssAnon:")
}

/// A line of the process's status in bytes.
#[cfg(target_os = "linux")]
fn status(key: &str) -> u64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = text.lines().find_map(|line| line.strip_prefix(key)).unwrap();
    line.trim().trim_end_matches(" kB").parse::<u64>().unwrap() * 1024
}

/// Settings of glibc's allocator with which it returns freed memory to the system: all threads share one heap, its end
/// is trimmed, and blocks from 16 KiB have their own pages. Otherwise it keeps gaps between blocks in use, and some
/// memory for each former thread, so that the memory of the process says little about the memory in use.
#[cfg(target_os = "linux")]
const ALLOCATOR: [(&str, &str); 4] = [
    ("MALLOC_ARENA_MAX", "1"),
    ("MALLOC_TRIM_THRESHOLD_", "65536"),
    ("MALLOC_MMAP_THRESHOLD_", "16384"),
    ("MALLOC_MMAP_MAX_", "1000000"),
];

#[test]
#[ignore = "long: half an hour of random edits, whose memory is measured"]
#[cfg(target_os = "linux")]
fn half_an_hour_of_random_edits_leaks_nothing() {
    if ALLOCATOR.iter().any(|(name, _)| std::env::var_os(name).is_none()) {
        let mut again = std::process::Command::new(std::env::current_exe().unwrap());
        again.args(["half_an_hour_of_random_edits", "--ignored", "--nocapture"]).envs(ALLOCATOR);
        assert!(again.status().unwrap().success());
        return;
    }
    // By then, caches have grown to their limits.
    edit_for(Duration::from_secs(300), 2);
    let before = resident();
    println!("{} KiB", before >> 10);
    for part in 0..5 {
        edit_for(Duration::from_secs(300), 3 + part);
        println!("{} KiB", resident() >> 10);
    }
    // No document is open at these moments, so the growth since then is compared with what the studio needs while it
    // works.
    let (after, most) = (resident(), status("VmHWM:"));
    println!("at most {} KiB", most >> 10);
    assert!(after < before + most / 20, "{} KiB, then {} KiB; at most {}", before >> 10, after >> 10, most >> 10);
}

#[test]
fn a_node_that_is_added_undone_and_added_again_does_not_read_itself() {
    let session = Session::new(Options { memory: Budget::of(512 << 20), ..Options::default() }).unwrap();
    let document = Document::of_preset(presets::find("classic").unwrap()).unwrap();
    let mut studio = Studio::new(session, Arc::new(|| ()), document);
    studio.selected = vec!["terrain".into()];
    for _ in 0..3 {
        let selected = studio.selected.first().cloned();
        let recipe = studio.document.recipe();
        let after = selected.as_deref().map_or(After::Nothing, After::Node);
        let edit = adding::edit(recipe, "step".into(), "terrace", after, Some([-3.0, 1870.0]));
        studio.edit(&edit).unwrap();
        assert_eq!(studio.selected, ["step"]);
        assert!(studio.undo());
        assert!(studio.selected.is_empty());
    }
    assert!(studio.redo());
    studio.selected = vec!["step".into()];
    studio.type_text(studio.document.text().replace("nodes.step", "nodes.stairs"));
    assert!(studio.document.is_valid() && studio.selected.is_empty());
}

#[test]
fn a_stroke_is_seen_whatever_was_shown() {
    let text = "orogen = 1\n[nodes.hills]\nop = \"fbm\"\n[nodes.spots]\nop = \"paint\"\n[nodes.shaped]\nop = \"paint\"\nbackground = \"hills\"\n\
        mask = \"part\"\n[nodes.part]\nop = \"paint\"\n[outputs]\nheight = \"shaped\"\nbare = \"hills\"\n";
    let recipe = Recipe::parse(text, "t").unwrap();
    for (node, shown, expect) in [
        ("spots", "height", "spots"),
        ("spots", "spots", "spots"),
        ("shaped", "height", "height"),
        ("shaped", "spots", "height"),
        ("shaped", "bare", "bare"),
        ("part", "part", "part"),
        ("part", "height", "height"),
    ] {
        assert_eq!(layer_of_stroke(&recipe, node, shown), expect, "{node} {shown}");
    }
}

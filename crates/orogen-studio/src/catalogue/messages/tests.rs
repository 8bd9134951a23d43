//! Coverage of the translated messages, and odd texts.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::*;
use orogen::grid::words::suggestion;
use orogen::{Error, ErrorKind, Recipe};

/// The tables of the file: keys with their translations.
fn tables() -> toml::Table {
    include_str!("../../../locales/messages.zh-CN.toml").parse().unwrap()
}

fn pairs(table: &str) -> Vec<(String, String)> {
    let table = tables()[table].as_table().unwrap().clone();
    table.into_iter().map(|(english, chinese)| (english, chinese.as_str().unwrap().to_owned())).collect()
}

/// The string literals of Rust sources, without tests.
fn literals(source: &str) -> Vec<String> {
    let source = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let (mut literals, mut left) = (Vec::new(), source);
    while let Some(first) = left.chars().next() {
        let raw = left.strip_prefix('r').filter(|rest| rest.starts_with(['"', '#']));
        let hashes = raw.map_or(0, |rest| rest.len() - rest.trim_start_matches('#').len());
        if left.starts_with("//") {
            left = left.split_once('\n').map_or("", |(_, rest)| rest);
        } else if let Some(body) = raw.and_then(|rest| rest[hashes..].strip_prefix('"')) {
            let (literal, rest) = body.split_once(&format!("\"{}", "#".repeat(hashes))).unwrap();
            literals.push(literal.to_owned());
            left = rest;
        } else if let Some(body) = left.strip_prefix('"') {
            let (literal, rest) = escaped(body);
            literals.push(literal);
            left = rest;
        } else if left.starts_with("'\\") {
            // A character such as '\'' or '\n'.
            left = left[3..].split_once('\'').map_or("", |(_, rest)| rest);
        } else if left.starts_with("'\"'") {
            left = &left[3..];
        } else {
            left = &left[first.len_utf8()..];
        }
    }
    literals
}

/// The string before the next quotation mark, and what follows it.
fn escaped(body: &str) -> (String, &str) {
    let (mut literal, mut chars) = (String::new(), body.char_indices());
    while let Some((at, c)) = chars.next() {
        match c {
            '"' => return (literal, &body[at + 1..]),
            '\\' => match chars.next().map(|(_, c)| c) {
                Some('\n') => {
                    let blank = chars.as_str().len() - chars.as_str().trim_start().len();
                    chars.by_ref().take(blank).for_each(drop);
                }
                Some('n') => literal.push('\n'),
                Some('u') => drop(chars.by_ref().find(|(_, c)| *c == '}')),
                Some(c) => literal.push(c),
                None => {}
            },
            c => literal.push(c),
        }
    }
    (literal, "")
}

/// A format string with `{}` for each hole, or several holes in a row.
fn normalized(format: &str) -> String {
    let mut text = String::new();
    for piece in pieces(format) {
        match piece {
            Piece::Text(part) => text.push_str(&part),
            Piece::Hole(_) if text.ends_with('\0') => {}
            Piece::Hole(_) => text.push('\0'),
        }
    }
    text
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "tests" {
            sources(&path, found);
        } else if name.ends_with(".rs") && !name.ends_with("tests.rs") {
            found.push(path);
        }
    }
}

#[test]
fn every_key_is_a_format_string_of_the_sources() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut files = Vec::new();
    for name in ["engine", "ops", "io", "grid", "codec", "jobs", "output", "gpu", "studio"] {
        sources(&crates.join(format!("orogen-{name}/src")), &mut files);
    }
    let mut known = BTreeSet::new();
    for file in files {
        for literal in literals(&std::fs::read_to_string(file).unwrap()) {
            known.insert(normalized(&literal));
            // A literal that is no format string.
            known.insert(literal);
        }
    }
    let keys = pairs("messages");
    let stale: Vec<&String> =
        keys.iter().map(|(english, _)| english).filter(|english| !known.contains(&normalized(english))).collect();
    assert!(stale.is_empty(), "no source has {stale:#?}");
}

#[test]
fn both_sides_have_the_same_holes() {
    let holes = |text: &str| {
        let holes = pieces(text).into_iter().filter_map(|piece| match piece {
            Piece::Hole(name) => Some(name),
            Piece::Text(_) => None,
        });
        let mut holes: Vec<String> = holes.collect();
        holes.sort();
        holes
    };
    let mut seen = BTreeSet::new();
    for (english, chinese) in pairs("messages").into_iter().chain(pairs("others")) {
        assert_eq!(holes(&english), holes(&chinese), "{english}");
        assert!(!english.contains("}{"), "{english}: holes in a row are one hole");
        assert!(seen.insert(normalized(&english)), "{english}: there are two keys of this form");
        let template = Template::new(&english, &chinese);
        let letters = template.texts.concat().chars().filter(char::is_ascii_alphabetic).count();
        assert!(
            template.holes.is_empty() || letters >= 2 || template.is_quoted(0) || english == " ({unit})",
            "{english}: little more than holes"
        );
    }
    assert!(pairs("counted").iter().all(|(english, chinese)| !english.contains('{') && !chinese.is_empty()));
}

/// The words of a message that are no names: English that was not translated.
fn english_words(chinese: &str) -> Vec<String> {
    let (mut plain, mut end) = (String::new(), None);
    for c in chinese.chars() {
        match (end, c) {
            (Some(close), c) if c == close => end = None,
            (Some(_), _) => {}
            (None, '`' | '"') => end = Some(c),
            (None, '“') => end = Some('”'),
            (None, '[') => end = Some(']'),
            (None, '{') => end = Some('}'),
            (None, c) => plain.push(c),
        }
    }
    let is_letter = |c: char| c.is_ascii_alphabetic();
    // Names such as TOML are in translations, too; the others are names in the recipes below.
    let translations = ["messages", "others"].into_iter().flat_map(pairs).map(|(_, chinese)| chinese);
    let mut names: BTreeSet<String> =
        ["null", "nan", "inf", "hills", "recipes", "none", "clamp", "high"].map(str::to_owned).into();
    translations.for_each(|chinese| names.extend(chinese.split(|c| !is_letter(c)).map(str::to_owned)));
    let words = plain.split(|c| !is_letter(c));
    words.filter(|word| word.len() > 1 && !names.contains(*word)).map(str::to_owned).collect()
}

/// A recipe with this text after its first lines, and outputs if it has none.
fn recipe(text: &str) -> String {
    let outputs = if text.contains("outputs") { "" } else { "[outputs]\nheight = \"land\"\n" };
    format!("orogen = 1\n[world]\nsize = 2000\ncell = 10\n[nodes.land]\nop = \"fbm\"\n{text}\n{outputs}")
}

/// Texts that are no recipes.
const NO_RECIPES: &[&str] = &[
    "",
    "a = 1",
    "orogen = 9",
    "orogen = \"one\"",
    "orogen = 1.0",
    "orogen = 1\norogen = 1",
    "orogen = ",
    "orogen 1",
    "[nodes",
    "orogen = 1\n[[nodes\n",
    "orogen = \"one",
    "orogen = 'one",
    "orogen = \"\"\"one",
    "orogen = \"\\q\"",
    "orogen = \"\\u12\"",
    "orogen = 01",
    "orogen = +-1",
    "orogen = 1__0",
    "orogen = 1.e",
    "orogen = 0xg",
    "orogen = yes",
    "orogen = [1 2]",
    "orogen = [1, 2",
    "orogen = [1,, 2]",
    "orogen = { a = 1 b = 2 }",
    "orogen = { a = 1",
    "orogen = { a }",
    "orogen == 1",
    "orogen = 1 about = 2",
    "= 1",
    "orogen = 1\n[world]\n[world]",
    "orogen = 1\nnodes = 1\nnodes.a = 2",
    "orogen = 1\nnodes = [1]\n[[nodes]]",
    "ü = 1",
    "# \u{1}\norogen = 1",
    "orogen = 2024-99-99",
    "{",
    "{ \"orogen\": 1",
    "{ \"orogen\" 1 }",
    "{ \"orogen\": }",
    "{ \"orogen\": 1, }",
    "{ \"orogen\": 1 } 2",
    "{ orogen: 1 }",
    "{ \"orogen\": \"one }",
    "{ \"orogen\": [1, 2 }",
    "{ \"orogen\": -a }",
    "{ \"orogen\": 1 // one\n }",
    "{ \"orogen\": \"\\q\" }",
    "{ \"orogen\": 1, \"orogen\": 1 }",
    "{ \"orogen\": null }",
    "{ \"orogen\": 1, \"nodes\": { \"a\": { \"op\": \"fbm\", \"op\": \"blur\" } }, \"outputs\": { \"height\": \"a\" } }",
];

/// Texts after the first lines of a recipe, which make it wrong.
const BROKEN: &[&str] = &[
    "[nodes.a]\nop = \"fbmm\"",
    "[nodes.a]\nop = \"zzzzzzzzzzz\"",
    "[nodes.a]\nop = \"game.lands\"",
    "[nodes.a]\nop = 3",
    "[nodes]\na = 3",
    "[nodes.a]\nwavelength = 3",
    "[nodes.a]\nop = \"fbm\"\nwavelenght = 3",
    "[nodes.a]\nop = \"fbm\"\nfrequency = 3",
    "[nodes.a]\nop = \"fbm\"\nperiod = 3",
    "[nodes.a]\nop = \"fbm\"\nwavelength = -3",
    "[nodes.a]\nop = \"fbm\"\nwavelength = \"long\"",
    "[nodes.a]\nop = \"fbm\"\nwavelength = \"a very long text that is shortened in the message, because it is long\"",
    "[nodes.a]\nop = \"fbm\"\noctaves = 2.5",
    "[nodes.a]\nop = \"fbm\"\noctaves = 2.0",
    "[nodes.a]\nop = \"fbm\"\noctaves = 200",
    "[nodes.a]\nop = \"fbm\"\noctaves = [1, 2]",
    "[nodes.a]\nop = \"fbm\"\noctaves = [1, 2, 3, 4, 5]",
    "[nodes.a]\nop = \"fbm\"\noctaves = { a = 1 }",
    "[nodes.a]\nop = \"fbm\"\noctaves = 2024-01-01",
    "[nodes.a]\nop = \"fbm\"\nseed = -1",
    "[nodes.a]\nop = \"fbm\"\nseed = 99999999999999999999999",
    "[nodes.a]\nop = \"fbm\"\nbasis = \"perlinn\"",
    "[nodes.a]\nop = \"fbm\"\nmask = true",
    "[nodes.a]\nop = \"blur\"\nsource = [1]",
    "[nodes.a]\nop = \"blur\"",
    "[nodes.a]\nop = \"blur\"\nsource = \"a\"",
    "[nodes.a]\nop = \"blur\"\nsource = \"b\"\n[nodes.b]\nop = \"blur\"\nsource = \"a\"",
    "[nodes.a]\nop = \"blur\"\nsource = \"lnd\"",
    "[nodes.a]\nop = \"blur\"\nsource = \"nothing_like_it\"",
    "[nodes.a]\nop = \"drainage\"\nsource = \"land\"\n[nodes.b]\nop = \"blur\"\nsource = \"a.flw\"",
    "[nodes.a]\nop = \"blur\"\nsource = nan",
    "[nodes.a]\nop = \"constant\"\nvalue = 1e300",
    "[nodes.\"4\"]\nop = \"fbm\"",
    "[nodes.a]\nop = \"clamp\"\nsource = \"land\"\nlow = 3\nhigh = 1",
    "[nodes.a]\nop = \"remap\"\nsource = \"land\"\nfrom = [1, 1]",
    "[nodes.a]\nop = \"remap\"\nsource = \"land\"\nfrom = 1",
    "[nodes.a]\nop = \"remap\"\nsource = \"land\"\nclamp = 1",
    "[nodes.a]\nop = \"curve\"\nsource = \"land\"\npoints = [[0, 0]]",
    "[nodes.a]\nop = \"dem\"",
    "[nodes.a]\nop = \"dem\"\npath = 3",
    "[nodes.a]\nop = \"image\"",
    "[nodes.a]\nop = \"path\"",
    "[nodes.a]\nop = \"path\"\npoints = [[0, 0]]",
    "[nodes.a]\nop = \"path\"\npoints = [[0, 0], 3]",
    "[nodes.a]\nop = \"path\"\npoints = [[0, 0], [1]]",
    "[nodes.a]\nop = \"path\"\npoints = [[0, 0], [1, 1, 1]]",
    "[nodes.a]\nop = \"path\"\npoints = [[0, 0], [1, \"b\"]]",
    "[nodes.a]\nop = \"path\"\npoints = [[[0, 0], [1, 1]], [[0, 0]]]",
    "[nodes.a]\nop = \"path\"\npoints = [[[0, 0], [1, 1]], [[0, 0], [0, \"x\"]]]",
    "[nodes.a]\nop = \"path\"\npoints = [[[0, 0], [1, 1]], 3]",
    "[nodes.a]\nop = \"path\"\npoints = 3",
    "[nodes.a]\nop = \"path\"\npoints = [[0, 0], [1, 1]]\nfile = \"a.svg\"",
    "[nodes.a]\nop = \"path\"\nfile = \"a.svg\"\nscale = 0",
    "[nodes.a]\nop = \"polygon\"",
    "[nodes.a]\nop = \"paint\"\nstrokes = 3",
    "[nodes.a]\nop = \"paint\"\nstrokes = [3]",
    "[nodes.a]\nop = \"paint\"\nstrokes = [{ radius = 3 }]",
    "[nodes.a]\nop = \"paint\"\nstrokes = [{ points = 3, radius = 3 }]",
    "[nodes.a]\nop = \"paint\"\nstrokes = [{ points = [[0, 0]], radius = -3 }]",
    "[nodes.a]\nop = \"paint\"\nstrokes = [{ points = [[0]], radius = 3 }]",
    "[nodes.a]\nop = \"paint\"\nstrokes = [{ points = [], radius = 3 }]",
    "[nodes.a]\nop = \"paint\"\nstrokes = [{ points = [[0, 0]], radus = 3 }]",
    "[nodes.a]\nop = \"paint\"\nstrokes = [{ points = [[0, 0]], radius = 3, mode = \"sett\" }]",
    "[nodes.a]\nop = \"expr\"\nexpr = \"\"",
    "[nodes.a]\nop = \"expr\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"land +\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"land + )\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"land, land\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"land land\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"(land\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"(land land)\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"max(land)\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"clamp(land)\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"mxa(land, 1)\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"max\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"land ** 2\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"land && 2\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"land || 2\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"land ? 2 : 1\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"land = 2\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"!land\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"[land]\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"land # 2\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"1 < land < 2\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"1e999\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"1.2.3\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"hils * 2\"",
    "[nodes.a]\nop = \"expr\"\nexpr = \"land\"\nhils = 2",
    "[nodes.a]\nop = \"fbm\"\nwavelength = \"= relif\"\n[parameters]\nrelief = 3",
    "[nodes.a]\nop = \"fbm\"\nwavelength = \"= relief\"",
    "[nodes.a]\nop = \"fbm\"\nwavelength = \"= 1 / 0\"",
    "[parameters]\nrelief = \"high\"",
    "[parameters]\nrelief = { range = [0, 1] }",
    "[parameters]\nrelief = { default = 3, range = [0, 1] }",
    "[parameters]\nrelief = { default = 3, range = [1, 0] }",
    "[parameters]\nrelief = { default = 3, range = 1 }",
    "[parameters]\nrelief = { default = 3, unit = 1 }",
    "[parameters]\nrelief = { default = 3, uint = \"m\" }",
    "[parameters]\nrelief = { default = -3, range = [0, inf], unit = \"m\" }",
    "[parameters]\nmax = 3",
    "[parameters]\nrelief = []",
    "[use]\na = 3",
    "[use.\"4\"]\nrecipe = \"hills\"",
    "[use.land]\nrecipe = \"hills\"",
    "[use.a]\nseed = 3",
    "[use.a]\nrecipe = \"hils\"",
    "[use.a]\nrecipe = \"zzzzzzzzz\"",
    "[use.a]\nrecipe = \"none.toml\"",
    "[use.a]\nrecipe = \"hills\"\ninputs = { b = 3 }",
    "[use.a]\nrecipe = \"hills\"\nparameters = { b = 3 }",
    "[use.a]\nrecipe = \"hills\"\nseed = -3",
    "[outputs]\nheight = \"lnd\"",
    "[outputs]\nheight = { a = 3 }",
    "[outputs]\nheight = true",
    "[outputs]\n\"4\" = \"land\"",
    "[outputs]\nheight = \"land.flow\"",
    "[outputs]",
    "[[outputs]]",
    "[suface]\nname = \"a\"",
    "[surface]\nname = \"a\"",
    "[[surface]]\ncolor = \"green\"",
    "[[surface]]\nname = \"a\"",
    "[[surface]]\nname = \"a b\"\ncolor = \"green\"",
    "[[surface]]\nname = \"a\"\ncolor = \"greeen\"",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\nmask = \"land\"",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\npicture = \"a.png\"",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\nspan = [0, 1]",
    "[[surface]]\nname = \"a\"\npicture = 3",
    "[[surface]]\nname = \"a\"\ngradient = [\"green\"]",
    "[[surface]]\nname = \"a\"\ngradient = [\"green\", \"red\"]\nspan = [0, 1]",
    "[[surface]]\nname = \"a\"\ngradient = [\"green\", \"red\"]\nalong = \"height\"",
    "[[surface]]\nname = \"a\"\ngradient = [\"green\", \"red\"]\nalong = 3",
    "[[surface]]\nname = \"a\"\ngradient = [\"green\", \"red\"]\nalong = \"slope\"\nspan = [0, 0]",
    "[[surface]]\nname = \"a\"\ngradient = [\"green\", \"red\"]\nalong = \"slope\"\ngrain = 3",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nslope = 3",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nslope = {}",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nslope = [3, 1]",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nslope = { mni = 3 }",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nany = []",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nany = 3",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nany = [{}]",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nany = [{ slop = [1, 2] }]",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nlayers = { lnd = [1, 2] }",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nslope = [1, 2]\nmask = \"lnd\"",
    "[[surface]]\nname = \"a\"\ncolor = \"green\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nnoise = [0, 1]",
    "[[scatter]]\nname = \"tree\"",
    "[[scatter]]\nspacing = 3",
    "[[scatter]]\nname = \"tree\"\nspacing = 3\nturn = \"east\"",
    "[[scatter]]\nname = \"tree\"\nspacing = 3\nwater = \"yes\"",
    "[[scatter]]\nname = \"tree\"\nspacing = 0",
    "[[scatter]]\nname = \"tree\"\nspacing = 3\nscale = 3\nsize = [3, 1]",
    "[[class]]\ncolor = \"green\"",
    "[[class]]\nname = \"a\"\n[[class]]\nname = \"a\"\nslope = [0, 1]",
    "[[class]]\nname = \"a\"\n[[class]]\nname = \"b\"\nshare = 3",
    "[[class]]\nname = \"a\"\n[[class]]\nname = \"b\"\nshare = { of = 3, lowest = 0.5 }",
    "[[class]]\nname = \"a\"\n[[class]]\nname = \"b\"\nshare = { lowest = 0.5 }",
    "[[class]]\nname = \"a\"\n[[class]]\nname = \"b\"\nshare = { of = \"height\" }",
    "[[class]]\nname = \"a\"\n[[class]]\nname = \"b\"\nshare = { of = \"height\", lowest = 5 }",
    "[[class]]\nname = \"a\"\n[[class]]\nname = \"b\"\nshare = { of = \"height\", lowest = 0.5, most = 1 }",
    "[[class]]\nname = \"a\"\n[outputs]\nheight = \"land\"\nclass = \"land\"",
    "[[class]]\nname = \"a\"\n[outputs]\nmoisture = \"land\"",
    "[nodes.a]\nop = \"fbm\"\n[nodes.b]\nop = \"fbm\"\nbasis = 3\nlacunarity = 0\ngain = \"x\"",
];

/// Worlds and top-level keys that are wrong.
const WORLDS: &[&str] = &[
    "world = 3\n",
    "about = 3\n",
    "studio = 3\n",
    "studioo = 3\n",
    "nodes = 3\n",
    "use = 3\n",
    "parameters = 3\n",
    "surface = []\nscatter = 3\n",
    "class = []\n",
    "[world]\nsize = \"wide\"\n",
    "[world]\nsize = [1, 2, 3]\n",
    "[world]\nsize = 1e12\ncell = 0.01\n",
    "[world]\nsize = 1\ncell = 10\n",
    "[world]\ncell = -1\n",
    "[world]\nseed = 1.5\n",
    "[world]\nsead = 1\n",
    "[world]\ncrs = 3\n",
    "[world]\ncrs = \"there\"\norigin = [1, 2]\n",
    "[world]\ncrs = \"EPSG:1\"\norigin = [1, 2]\n",
    "[nodes.a]\nop = \"erosion\"\n",
    "[nodes.a]\nop = \"drainage\"\nsource = 0\n",
    "[[surface]]\nname = \"a\"\ncolor = \"red\"\n[[surface]]\nname = \"b\"\ncolor = \"red\"\nflow = [1, 2]\n",
    "[[class]]\nname = \"a\"\n[[class]]\nname = \"b\"\nshare = { of = \"height\", lowest = 0.5 }\n[outputs]\nheight = 0\n",
];

#[test]
fn diagnostics_of_broken_recipes_are_translated() {
    let (mut told, mut faults) = (BTreeSet::new(), Vec::new());
    let texts = NO_RECIPES.iter().map(|text| (*text).to_owned()).chain(BROKEN.iter().map(|text| recipe(text)));
    for text in texts.chain(WORLDS.iter().map(|text| format!("orogen = 1\n{text}"))) {
        let Err(error) = Recipe::parse(&text, "a.toml") else {
            faults.push(format!("this is a recipe:\n{text}"));
            continue;
        };
        for diagnostic in error.diagnostics() {
            let chinese = Language::Chinese.message(&diagnostic.message);
            let words = english_words(&chinese);
            if !words.is_empty() || chinese == diagnostic.message {
                faults.push(format!("{}\n{chinese}\n{words:?}", diagnostic.message));
            }
            told.insert(format!("{}\n{chinese}\n", diagnostic.message));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
    assert!(told.len() > 150, "{}", told.len());
}

#[test]
fn other_messages_are_translated() {
    let none = std::io::Error::from_raw_os_error(2);
    let missing = Error::file("read", Path::new("a/b c.tif"), &none);
    let system = if cfg!(unix) {
        "无法读取 a/b c.tif：没有这个文件或文件夹"
    } else {
        "无法读取 a/b c.tif：没有这个文件"
    };
    let say = |text: &str| Language::Chinese.message(text).into_owned();
    assert_eq!(say(&missing.to_string()), system);
    assert_eq!(say("the work was cancelled"), "工作已取消");
    assert_eq!(
        say("this needs up to 3.5 GiB of memory, and 2.0 GiB is allowed; use fewer samples, or raise the memory limit"),
        "此操作最多需要 3.5 GiB 内存，只允许 2.0 GiB；请减少采样，或提高内存上限"
    );
    assert_eq!(
        say("making 16 rows at a time needs up to 3 GiB of memory, and 2 GiB is allowed; allow more"),
        "每次制作 16 行最多需要 3 GiB 内存，只允许 2 GiB；请允许更多内存"
    );
    assert_eq!(
        say(
            "node `place`: cannot read a.tif: it has 3 bands; choose one with `band = 1` in the node, or with FILE:1 on the command line"
        ),
        "节点“place”：无法读取 a.tif：它有 3 个波段；请在节点中用 `band = 1` 选择一个，或在命令行中写 FILE:1"
    );
    assert_eq!(
        say(
            "cannot write a.tif: it exists and is a PNG picture, not a TIFF picture; choose another name, or replace it with --force"
        ),
        "无法写入 a.tif：它已存在，且是 PNG 图片，不是 TIFF 图片；请选择其他名称，或用 --force 替换"
    );
    // The place in another text is kept, and each line is a message.
    let one = "recipes/b.toml:3:4: unknown node `lnd`; did you mean `land`?";
    assert_eq!(say(one), "recipes/b.toml:3:4：没有名为“lnd”的节点；是否想写“land”？");
    assert_eq!(say(&format!("{one}\nand 12 more diagnostics")), format!("{}\n另有 12 条诊断", say(one)));
    // What is unknown stays in English, and a known line beside it does not.
    assert_eq!(say("a sentence of nobody"), "a sentence of nobody");
    assert_eq!(say("a sentence of nobody\nthe work was cancelled"), "a sentence of nobody\n工作已取消");
    // Names that look like sentences are names.
    assert_eq!(say("there is no node `a table`"), "没有名为“a table”的节点");
    let hint = suggestion("zzzzzz", ["a", "b and c", "nothing"]);
    assert_eq!(say(&hint), "可用的有：“a”、“b and c”和“nothing”");
    assert_eq!(Language::English.message("the work was cancelled"), "the work was cancelled");
    let error = Error::new(ErrorKind::Internal, "no layer was computed");
    assert_eq!(say(&error.to_string()), "没有计算出图层");
}

/// Any text is told in some way, and not slowly.
#[test]
fn odd_texts_are_told() {
    let mut parts: Vec<String> = pairs("messages").into_iter().map(|(english, _)| english).collect();
    let odd = [
        "`", "\"", "{", "}", "\n", ": ", "; ", ", ", " and ", "ä", "节点", "\u{0}", "🏔", " ", "", "7", "points", "`a`",
        "\\", ".",
    ];
    (0..40).for_each(|_| parts.extend(odd.map(str::to_owned)));
    let mut state = 1u64;
    let mut next = |most: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % most
    };
    for _ in 0..3000 {
        let text: String = (0..next(12)).map(|_| parts[next(parts.len())].clone()).collect();
        let end = (0..=next(text.len() + 1)).rev().find(|end| text.is_char_boundary(*end)).unwrap_or(0);
        for text in [&text[..], &text[..end]] {
            assert_eq!(Language::English.message(text), text);
            let _ = Language::Chinese.message(text);
        }
    }
    for text in
        ["`a`, ".repeat(2000), "node `a`: ".repeat(1500), "; ".repeat(8000), "`".repeat(16_000), "x: ".repeat(5000)]
    {
        let begun = std::time::Instant::now();
        let _ = Language::Chinese.message(&text);
        assert!(begun.elapsed().as_secs() < 5, "{}", &text[..20]);
    }
}

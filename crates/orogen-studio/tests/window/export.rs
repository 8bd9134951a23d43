//! Compares exports with the files of the command line that the dialog shows.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

use eframe::egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;
use orogen::export::registry;
use orogen::export::targets::list;
use orogen::io::test_folder::TestFolder;
use orogen::{Progress, Session};
use orogen_studio::catalogue::Language;
use orogen_studio::export::given::Given;
use orogen_studio::export::kind::Kind;
use orogen_studio::export::request::Export;
use orogen_studio::preview::region::Region;
use orogen_studio::studio::open;

use super::{press, studio, until, until_done, window};

/// The words of a line, as split by a shell.
fn split(line: &str) -> Vec<String> {
    let (mut words, mut word, mut is_quoted, mut letters) = (Vec::new(), None, false, line.chars());
    while let Some(letter) = letters.next() {
        match letter {
            '\'' => {
                is_quoted = !is_quoted;
                word.get_or_insert_with(String::new);
            }
            '\\' if !is_quoted => word.get_or_insert_with(String::new).extend(letters.next()),
            ' ' if !is_quoted => words.extend(word.take()),
            other => word.get_or_insert_with(String::new).push(other),
        }
    }
    words.extend(word);
    words
}

/// Runs a command line as it is copied from the dialog.
fn run(line: &str) {
    let mut words = split(line);
    words.extend(["--no-cache".into(), "--quiet".into()]);
    assert_eq!(format!("{:?}", orogen_cli::run_with(words)), format!("{:?}", ExitCode::SUCCESS), "{line}");
}

/// Returns all files in a folder with their content, and removes them.
fn taken(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            all.extend(taken(&path).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
            std::fs::remove_dir(&path).unwrap();
        } else {
            all.insert(name, std::fs::read(&path).unwrap());
            std::fs::remove_file(&path).unwrap();
        }
    }
    all
}

/// Sets options.
fn give(given: &mut Given, options: &[(&'static str, &str)]) {
    given.extend(options.iter().map(|(name, text)| (*name, text.to_string())));
}

/// Exports, and runs the command line: both must make the same files. Returns the number of files.
fn same(argument: &Path, region: Region, folder: &Path, choose: impl FnOnce(&mut Export)) -> usize {
    let document = open(argument).unwrap();
    let mut export = Export::new(region, document.title(), document.is_place(), folder).unwrap();
    choose(&mut export);
    let session = Session::new(orogen::Options::default()).unwrap();
    export.run(&session, document.recipe().clone(), document.path(), &Progress::none()).unwrap();
    let own = taken(folder);
    let line = export.command_line(&document.argument().unwrap(), &document.recipe().world).to_string();
    run(&line);
    let theirs = taken(folder);
    assert_eq!(own.keys().collect::<Vec<_>>(), theirs.keys().collect::<Vec<_>>(), "{line}");
    for (name, bytes) in &own {
        assert!(*bytes == theirs[name], "{name} of {line}");
    }
    own.len()
}

#[test]
fn the_copied_command_line_makes_the_same_files() {
    let recipes = TestFolder::new("studio-recipes").unwrap();
    let folder = TestFolder::new("studio-same").unwrap();
    let classic = Path::new("classic");
    let mine = recipes.join("it's mine.toml");
    std::fs::write(&mine, orogen::presets::find("island").unwrap().text.replace("#:schema", "#")).unwrap();
    let heights = recipes.join("place.asc");
    let rows: String =
        (0..24).map(|y| format!("{}\n", (0..24).map(|x| format!("{} ", 300 + x * y)).collect::<String>())).collect();
    std::fs::write(&heights, format!("ncols 24\nnrows 24\nxllcorner 0\nyllcorner 0\ncellsize 30\n{rows}")).unwrap();
    let part = Region::Square { center: [1234.5, 2100.25], side: 999.75 };

    // Layers and meshes.
    let layer = |name: &'static str, layer: &'static str, size: usize| {
        move |export: &mut Export| {
            export.layer.set_format(registry::named(name).unwrap(), Some(800.0));
            export.layer.set_layer(layer);
            export.layer.size = Some(size);
            export.set_extension();
        }
    };
    assert!(same(classic, Region::Whole, &folder, layer("tif", "height", 90)) >= 1);
    assert!(same(&mine, part, &folder, layer("r16", "slope", 77)) >= 2);
    same(classic, part, &folder, layer("glb", "height", 50));
    same(&mine, Region::Whole, &folder, layer("geojson", "contours", 64));
    same(Path::new("endless"), part, &folder, layer("npy", "height", 40));
    same(classic, Region::Whole, &folder, |export| {
        layer("png", "insolation", 40)(export);
        export.layer.layer_options.insert("latitude", "-33.5".into());
        export.layer.options.insert("bits", "8".into());
    });

    // All engines.
    for target in list::all() {
        let side = target.sides[0];
        let choose = |export: &mut Export| {
            export.kind = Kind::Engine;
            export.engine.set_target(target);
            export.engine.side = Some(side);
            export.set_extension();
        };
        same(classic, Region::Whole, &folder, choose);
        same(&mine, part, &folder, choose);
    }
    let tiles = same(classic, part, &folder, |export| {
        export.kind = Kind::Engine;
        export.engine.set_target(list::named("unity").unwrap());
        (export.engine.side, export.engine.tiles) = (Some(33), [2, 1]);
        export.set_extension();
    });
    assert!(tiles >= 2);

    // Map sheets.
    let map = |format: &'static str| {
        move |export: &mut Export| {
            export.set_kind(Kind::Map);
            export.set_path(&export.path().with_extension(format).to_string_lossy());
            export.map.samples = Some(70);
            give(&mut export.map.options, &[("size", "400")]);
        }
    };
    same(classic, Region::Whole, &folder, map("png"));
    same(&heights, Region::Whole, &folder, map("png"));
    same(&mine, part, &folder, |export| {
        map("svg")(export);
        let options = [
            ("color", "surfaces"),
            // Options that do not apply are not on the command line.
            ("layer", "slope"),
            ("title", "-x 'Höhe'"),
            ("paper", "a5"),
            ("landscape", ""),
            ("shade", "swiss"),
            ("labels", "all"),
            ("grid", "200"),
            ("water-color", "#0a7882"),
        ];
        give(&mut export.map.options, &options);
    });
    same(&mine, Region::Whole, &folder, |export| {
        map("pdf")(export);
        let options = [
            ("layer", "slope"),
            ("palette", "magma"),
            ("ramp", "linear"),
            ("range", "-1.5,40.25"),
            ("contours", "25.5"),
            ("no-legend", ""),
            ("no-axes", ""),
            ("dpi", "90"),
        ];
        export.map.options.clear();
        give(&mut export.map.options, &options);
    });

    // Renders.
    let render = |export: &mut Export| {
        export.set_kind(Kind::Render);
        export.render.samples = Some(60);
        give(&mut export.render.options, &[("size", "96x54"), ("samples", "1")]);
    };
    same(classic, Region::Whole, &folder, render);
    same(&mine, part, &folder, |export| {
        render(export);
        let options = [
            ("color", "surfaces"),
            ("camera", "77.7,33.3,2500.5"),
            ("sun", "120,12.5"),
            ("haze", "0.25"),
            ("exaggeration", "1.7"),
            ("fov", "55"),
            ("edge", "cut"),
            ("snow-line", "-20.5"),
        ];
        give(&mut export.render.options, &options);
    });
    same(classic, Region::Whole, &folder, |export| {
        render(export);
        give(&mut export.render.options, &[("color", "map"), ("palette", "viridis"), ("color-bar", "")]);
    });

    // Tilemaps.
    let tilemap = |export: &mut Export| {
        export.set_kind(Kind::Tilemap);
        export.tilemap.size = 30;
    };
    assert!(same(classic, Region::Whole, &folder, tilemap) >= 9);
    same(&mine, part, &folder, |export| {
        tilemap(export);
        give(&mut export.tilemap.options, &[("tileset", "fields-32"), ("layout", "dual"), ("infinite", "")]);
    });
    let usual = same(Path::new("tile-island"), Region::Whole, &folder, |export| export.set_kind(Kind::Tilemap));
    assert!(usual >= 9);
}

/// Every kind is selected in the dialog and exported; the command line that it shows makes the same files.
#[test]
fn every_kind_is_exported_from_the_dialog() {
    let folder = TestFolder::new("studio-dialog").unwrap();
    let files = TestFolder::new("studio-dialog-files").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::E);
    for (kind, key) in Kind::ALL {
        harness.get_by_role_and_label(Role::Button, Language::English.text(key)).click();
        harness.run_steps(3);
        // Fewer samples than the world has.
        let (field, value) = match kind {
            Kind::Engine => ("Samples along a side", "127"),
            _ => ("Samples", "256"),
        };
        if kind != Kind::Tilemap {
            harness.get_by_role_and_label(Role::ComboBox, field).click();
            harness.run_steps(3);
            harness.get_by_role_and_label(Role::Button, value).click();
            harness.run_steps(3);
        }
        let extension = harness.state().export_dialog().unwrap().export().path().extension().map(|own| own.to_owned());
        let path = extension.map_or_else(|| files.join("it"), |own| files.join("it").with_extension(own));
        harness.get_by_role_and_label(Role::TextInput, "file of export").focus();
        harness.run_steps(2);
        press(&mut harness, Modifiers::COMMAND, Key::A);
        harness.get_by_role_and_label(Role::TextInput, "file of export").type_text(&path.to_string_lossy());
        harness.run_steps(3);
        harness.get_by_role_and_label(Role::Button, "Export").click();
        harness.run_steps(2);
        until(&mut harness, "the export", |app| app.export_dialog().unwrap().outcome().is_some());
        // The dialog has another height when it shows the result.
        harness.run_steps(3);
        let dialog = harness.state().export_dialog().unwrap();
        assert!(dialog.outcome().unwrap().is_ok(), "{kind:?}: {:?}", dialog.outcome());
        assert!(dialog.export().kind == kind && dialog.export().path() == path);
        let world = studio(&harness).document.recipe().world;
        let line = dialog.export().command_line("classic", &world).to_string();
        assert!(harness.query_by_label(&line).is_some(), "{line}");
        let own = taken(&files);
        assert!(!own.is_empty(), "{kind:?}");
        run(&line);
        assert!(own == taken(&files), "{line}");
    }
}

#[test]
fn the_exports_of_a_recipe_are_kept_in_it_and_made_together() {
    let folder = TestFolder::new("studio-exports").unwrap();
    let recipe = folder.join("land.toml");
    std::fs::write(&recipe, orogen::presets::find("classic").unwrap().text).unwrap();
    let mut harness = window(&folder, recipe.to_str(), Language::English);
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::E);
    for name in ["a.png", "b.r32"] {
        harness.get_by_role_and_label(Role::TextInput, "file of export").focus();
        harness.run_steps(2);
        press(&mut harness, Modifiers::COMMAND, Key::A);
        let path = folder.join(name);
        harness.get_by_role_and_label(Role::TextInput, "file of export").type_text(&path.to_string_lossy());
        harness.run_steps(3);
        harness.get_by_label("Add this one").click();
        harness.run_steps(3);
    }
    let kept = &studio(&harness).document.kept().exports;
    assert_eq!(kept.iter().map(|export| export.file.as_str()).collect::<Vec<_>>(), ["a.png", "b.r32"]);
    harness.get_by_label("Make all").click();
    harness.run_steps(2);
    until(&mut harness, "the exports", |app| app.export_dialog().unwrap().list().results().count() == 2);
    assert!(harness.state().export_dialog().unwrap().list().results().all(Result::is_ok));
    let first = ["a.png", "b.r32"].map(|name| std::fs::read(folder.join(name)).unwrap());
    run(&format!("orogen export {} --out {}", recipe.display(), folder.join("c.r32").display()));
    assert!(std::fs::read(folder.join("c.r32")).unwrap() == first[1]);
    // The second time it is asked for each file; a refusal leaves one out.
    harness.get_by_label("Make all").click();
    harness.run_steps(3);
    until(&mut harness, "the first question", |app| app.export_dialog().unwrap().list().is_asking());
    harness.run_steps(3);
    harness.get_by_label("Replace").click();
    harness.run_steps(3);
    until(&mut harness, "the second question", |app| app.export_dialog().unwrap().list().is_asking());
    harness.run_steps(3);
    harness.get_by_label("Cancel").click();
    harness.run_steps(3);
    let list = harness.state().export_dialog().unwrap().list();
    assert!(!list.is_busy() && list.results().count() == 1);
    // They are saved with the recipe.
    press(&mut harness, Modifiers::NONE, Key::Escape);
    press(&mut harness, Modifiers::COMMAND, Key::S);
    let text = std::fs::read_to_string(&recipe).unwrap();
    assert!(text.contains("[studio]\nexports = [\n") && text.contains("file = \"b.r32\""), "{text}");
}

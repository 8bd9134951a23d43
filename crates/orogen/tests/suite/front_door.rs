//! `orogen::open` and `World::export`: the entry points of most programs.

use orogen::export::{ExportJob, of_path};
use orogen::io::file::OutputPolicy;
use orogen::io::test_folder::TestFolder;
use orogen::{ErrorKind, Export, Progress, Window, World, presets};
use std::fs;

#[test]
fn a_world_opens_by_the_name_of_a_preset_of_a_recipe_file_and_of_a_file_of_heights() {
    let folder = TestFolder::new("front-door-open").unwrap();
    let window = Window::new(24, 16, 60.0).at(40, 30);
    let hills = orogen::open("hills").unwrap();
    let heights = hills.window("height", &window).unwrap();

    let recipe = folder.join("land.toml");
    fs::write(&recipe, hills.recipe().to_toml()).unwrap();
    assert_eq!(orogen::open(&recipe).unwrap().window("height", &window).unwrap(), heights);

    let dem = folder.join("land.tif");
    hills.export("height", &window, &dem).unwrap();
    let place = orogen::open(&dem).unwrap();
    let whole = place.full_window(60.0).unwrap();
    assert_eq!(place.window("height", &whole).unwrap().data(), heights.data());

    for (name, said) in [("hils", "did you mean `hills`?"), ("none.toml", "none.toml"), ("none.tif", "none.tif")] {
        let error = orogen::open(name).err().unwrap();
        assert!(error.to_string().contains(said), "{error}");
    }
}

#[test]
fn an_export_in_one_call_is_that_of_a_job_whose_recipe_was_prepared_first() {
    let folder = TestFolder::new("front-door-export").unwrap();
    let window = Window::new(40, 30, 120.0).at(20, 20);
    // A recipe with classes and scattered objects, and layers with and without appended nodes.
    let world = orogen::open("rolling").unwrap();
    for (layer, file) in [
        ("height", "a.npy"),
        ("hillshade", "b.tif"),
        ("wetness", "c.tif"),
        ("filled", "d.npy"),
        ("contours", "e.geojson"),
    ] {
        world.export(layer, &window, folder.join(file)).unwrap();
        let job = ExportJob::new(of_path(file.as_ref()).unwrap()).with_layer(layer).with_window(window);
        let mut recipe = presets::find("rolling").unwrap().recipe().unwrap();
        job.prepare(&mut recipe).unwrap();
        let expect = folder.join(format!("expect-{file}"));
        let output = OutputPolicy::default().output(&expect).unwrap();
        job.to_file(&World::open(recipe).unwrap(), &output, &Progress::none()).unwrap();
        assert_eq!(fs::read(folder.join(file)).unwrap(), fs::read(&expect).unwrap(), "{layer}");
    }
}

#[test]
fn an_export_in_one_call_refuses_what_a_job_refuses() {
    let folder = TestFolder::new("front-door-refuse").unwrap();
    let window = Window::new(8, 8, 100.0);
    let world = orogen::open("hills").unwrap();
    let dem = folder.join("dem.tif");
    world.export("height", &window, &dem).unwrap();
    let before = fs::read(&dem).unwrap();
    let place = orogen::open(&dem).unwrap();
    let whole = place.full_window(100.0).unwrap();
    for (layer, path, said) in [
        ("height", dem.clone(), "dem.tif"),
        ("height", folder.join("land.tiff2"), "unknown format .tiff2"),
        ("heigth", folder.join("land.tif"), "heigth"),
        ("rivers", folder.join("rivers.png"), "rivers"),
    ] {
        let error = place.export(layer, &whole, &path).unwrap_err();
        assert!(error.to_string().contains(said), "{layer}: {error}");
        assert_ne!(error.kind(), ErrorKind::Internal, "{error}");
    }
    assert_eq!(fs::read(&dem).unwrap(), before);
    assert_eq!(fs::read_dir(dem.parent().unwrap()).unwrap().count(), 1, "no other file appears");
}

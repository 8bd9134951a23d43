//! Builds in parts: in any order, at the same time, interrupted and repeated. The result always equals the result of a
//! build in one process.

use std::collections::BTreeSet;

use super::*;

fn part_of(world: &World, spec: &BuildSpec, out: &Path, [number, count]: [usize; 2]) -> Result<Report, String> {
    let spec = spec.clone().with_part(number, count);
    let build = Build::new(world, &spec, &output(out)).unwrap();
    build.run(Start::Resume, &Progress::none()).map_err(|error| error.to_string())
}

/// The only files left next to a complete result.
fn assert_tidy(folder: &Folder, what: &str) {
    let names: Vec<PathBuf> = result(&folder.0.join("out.build")).into_keys().collect();
    assert_eq!(names, [Path::new("journal"), Path::new("lock")], "{what}");
}

#[test]
fn parts_in_any_order_have_the_same_bytes() {
    for form in FORMS {
        let (expect, whole) = undisturbed(form);
        let (world, spec) = (world(None, 2), spec(form));
        for count in [1, 3, 7] {
            let folder = Folder::new();
            let mut made = 0;
            for n in 0..count {
                let number = (5 * n + 3) % count + 1;
                let report = part_of(&world, &spec, &folder.out(), [number, count]).unwrap();
                made += report.made;
                let left: Vec<usize> = (n + 1..count).map(|n| (5 * n + 3) % count + 1).collect();
                assert_eq!(report.left.iter().copied().collect::<BTreeSet<_>>(), left.into_iter().collect());
            }
            assert_eq!(made, whole.made, "{form:?} {count}");
            assert!(result(&folder.out()) == expect, "{form:?} {count}");
            assert_tidy(&folder, form.name());
            for number in [1, count] {
                let report = part_of(&world, &spec, &folder.out(), [number, count]).unwrap();
                assert_eq!((report.made, report.left.len(), report.bytes), (0, 0, whole.bytes), "{form:?} {count}");
            }
            assert_tidy(&folder, form.name());
            let checked = run(&world, &spec, &folder.out(), Start::Resume);
            assert_eq!((checked.made, checked.bytes), (0, whole.bytes));
        }
    }
}

#[test]
fn parts_at_the_same_time_have_the_same_bytes() {
    for form in [Form::Cog, Form::Zarr, Form::Tiles(Samples::Png)] {
        let (expect, _) = undisturbed(form);
        let spec = spec(form);
        for _ in 0..4 {
            let folder = Folder::new();
            let complete = AtomicUsize::new(0);
            std::thread::scope(|scope| {
                for number in 1..=4 {
                    let (complete, spec, out) = (&complete, &spec, folder.out());
                    scope.spawn(move || {
                        let report = part_of(&world(None, 1), spec, &out, [number, 4]).unwrap();
                        complete.fetch_add(usize::from(report.left.is_empty()), Ordering::Relaxed);
                    });
                }
            });
            assert!(complete.into_inner() > 0, "one of the parts finishes the result");
            assert!(result(&folder.out()) == expect, "{form:?}");
            assert_tidy(&folder, form.name());
        }
    }
}

#[test]
fn interrupted_parts_go_on() {
    for form in FORMS {
        let (expect, whole) = undisturbed(form);
        let (world, spec) = (world(None, 2), spec(form));
        let folder = Folder::new();
        let mut made = 0;
        // The disk is full after a few files, also while the result is finished, which any part can continue.
        for n in 0.. {
            let spec = spec.clone().with_part(n % 3 + 1, 3);
            let mut build = Build::new(&world, &spec, &output(&folder.out())).unwrap();
            fill_after(&mut build, n / 3);
            match build.run(Start::Resume, &Progress::none()) {
                Ok(report) => {
                    made += report.made;
                    if report.left.is_empty() {
                        break;
                    }
                }
                Err(error) => assert!(error.to_string().ends_with(": no storage space"), "{error}"),
            }
            assert!(n < 1000);
        }
        assert!(made < whole.made, "{form:?}: some were made by interrupted calls");
        assert!(result(&folder.out()) == expect, "{form:?}");
        assert_tidy(&folder, form.name());
    }
}

#[test]
fn tiles_that_vanish_are_made_again() {
    for form in [Form::Zarr, Form::Cog] {
        let (expect, _) = undisturbed(form);
        let (world, spec) = (world(None, 2), spec(form));
        let folder = Folder::new();
        for number in [1, 2] {
            part_of(&world, &spec, &folder.out(), [number, 3]).unwrap();
        }
        let tiles = files(&folder.0.join(if form.is_file() { "out.build" } else { "out/height/c" }));
        let tile = tiles.keys().find(|path| !form.is_file() || path.to_string_lossy().contains("packed")).unwrap();
        fs::remove_file(tile).unwrap();
        let report = part_of(&world, &spec, &folder.out(), [3, 3]).unwrap();
        assert_eq!(report.left.len(), 1, "{form:?}");
        let report = part_of(&world, &spec, &folder.out(), [report.left[0], 3]).unwrap();
        assert!(report.left.is_empty() && report.made > 0 && report.kept > 0, "{form:?} {report:?}");
        assert!(result(&folder.out()) == expect, "{form:?}");
        // Of a complete result, one process makes it again.
        if !form.is_file() {
            fs::remove_file(folder.out().join("zarr.json")).unwrap();
            let error = part_of(&world, &spec, &folder.out(), [3, 3]).unwrap_err();
            assert!(error.ends_with("repair it with --resume and without --part"), "{error}");
            run(&world, &spec, &folder.out(), Start::Resume);
            assert!(result(&folder.out()) == expect);
        }
    }
}

#[test]
fn parts_and_whole_builds_continue_each_other() {
    for form in FORMS {
        let (expect, whole) = undisturbed(form);
        let (world, spec) = (world(None, 2), spec(form));
        let folder = Folder::new();
        let part = part_of(&world, &spec, &folder.out(), [2, 3]).unwrap();
        let report = run(&world, &spec, &folder.out(), Start::Resume);
        assert_eq!((report.kept, report.made), (part.made, whole.made - part.made), "{form:?}");
        assert!(result(&folder.out()) == expect, "{form:?}");
        assert_tidy(&folder, form.name());
        // A whole build that was interrupted goes on in parts.
        let folder = Folder::new();
        let mut build = Build::new(&world, &spec, &output(&folder.out())).unwrap();
        fill_after(&mut build, 6);
        assert!(build.run(Start::Fresh, &Progress::none()).is_err());
        let reports = [2, 1].map(|number| part_of(&world, &spec, &folder.out(), [number, 2]).unwrap());
        assert!(reports[0].kept + reports[1].kept > 0, "{form:?}");
        assert!(result(&folder.out()) == expect, "{form:?}");
        assert_tidy(&folder, form.name());
    }
}

#[test]
fn other_parts_are_refused() {
    let folder = Folder::new();
    let (world, spec) = (world(None, 1), spec(Form::Zarr));
    let run = |spec: &BuildSpec, part, start| {
        let spec = BuildSpec { part, ..spec.clone() };
        let report =
            Build::new(&world, &spec, &output(&folder.out())).and_then(|build| build.run(start, &Progress::none()));
        report.map_err(|error| error.to_string().replace(&folder.0.display().to_string(), "~"))
    };
    assert_eq!(
        run(&spec, Some([3, 2]), Start::Resume).unwrap_err(),
        "there is no part 3 of 2: parts are counted from 1"
    );
    assert_eq!(
        run(&spec, Some([0, 2]), Start::Resume).unwrap_err(),
        "there is no part 0 of 2: parts are counted from 1"
    );
    assert_eq!(
        run(&spec, Some([1, 2]), Start::Force).unwrap_err(),
        "--part cannot be used with --force, which would remove what the other parts made; remove ~/out and ~/out.build first, or choose another output"
    );
    fs::create_dir(folder.out()).unwrap();
    fs::write(folder.out().join("diary"), "mine").unwrap();
    assert_eq!(
        run(&spec, Some([1, 2]), Start::Resume).unwrap_err(),
        "~/out already exists, and is not an unfinished build; remove it first, or choose another output"
    );
    assert!(!folder.0.join("out.build").exists());
    fs::remove_dir_all(folder.out()).unwrap();
    run(&spec, Some([1, 2]), Start::Resume).unwrap();
    assert_eq!(
        run(&spec, Some([1, 3]), Start::Resume).unwrap_err(),
        "~/out was started in 2 parts, not in 3; use --part K/2, or finish it in one process with --resume and without --part"
    );
    let other = BuildSpec { tile: Some(64), ..spec.clone() };
    for number in [1, 2] {
        assert_eq!(
            run(&other, Some([number, 2]), Start::Resume).unwrap_err(),
            "~/out is another build: it was started with tiles of 40, not 64; start all parts with the same arguments, or choose another output"
        );
    }
    assert!(
        run(&spec, None, Start::Fresh).unwrap_err().contains("is an unfinished build; use --resume to continue it")
    );
    run(&spec, Some([2, 2]), Start::Resume).unwrap();
    assert!(run(&other, Some([2, 2]), Start::Resume).unwrap_err().contains("with tiles of 40, not 64"));
    // Of a complete result, the number of parts does not matter.
    assert_eq!(run(&spec, Some([9, 9]), Start::Resume).unwrap().made, 0);
}

#[test]
fn a_part_runs_once_at_a_time() {
    use super::super::part::Part;
    use super::super::part_folder::PartFolder;
    let folder = Folder::new();
    let (world, spec) = (world(None, 1), spec(Form::Zarr));
    part_of(&world, &spec, &folder.out(), [1, 2]).unwrap();
    let parts = PartFolder::new(&folder.0.join("out.build/parts"), Part { number: 2, count: 2 });
    let held = parts.hold(&folder.out()).unwrap();
    let error = part_of(&world, &spec, &folder.out(), [2, 2]).unwrap_err();
    assert!(error.contains("part 2 of 2 of") && error.ends_with("is already running; wait until it ends"), "{error}");
    part_of(&world, &spec, &folder.out(), [1, 2]).unwrap();
    drop(held);
    // A build without parts excludes all parts, and the other way round.
    let work_dir = super::super::work_dir::WorkDir::new(&output(&folder.out()), false).unwrap();
    let held = work_dir.hold().unwrap();
    let error = part_of(&world, &spec, &folder.out(), [2, 2]).unwrap_err();
    assert!(error.contains("a build without --part of"), "{error}");
    drop(held);
    let held = work_dir.share().unwrap();
    let error = Build::new(&world, &spec, &output(&folder.out())).unwrap().run(Start::Resume, &Progress::none());
    assert!(error.unwrap_err().to_string().contains("another build of"));
    drop(held);
    assert_eq!(part_of(&world, &spec, &folder.out(), [2, 2]).unwrap().left, [0usize; 0]);
}

#[test]
fn worlds_of_any_size_are_built_tile_by_tile() {
    let recipe = Recipe::parse(
        "orogen = 1\n[world]\nseed = 3\n[nodes.land]\nop = \"continents\"\n[outputs]\nheight = \"land\"\n",
        "endless",
    );
    let options = Options { threads: Some(2), memory: Budget::of(Some(1 << 30)), ..Options::default() };
    let world = World::with_options(recipe.unwrap(), options).unwrap();
    // A planet: 40 000 km x 20 000 km at 30 m.
    let window = Window::new(1_333_333, 666_667, 30.0).at(-600_000, -300_000);
    let spec = BuildSpec { form: Form::Zarr, window, tile: Some(2048), layers: vec!["height".into()], part: None };
    let folder = Folder::new();
    let output = OutputPolicy::default().output(folder.out()).unwrap();
    let spec = spec.with_part(80_000, 212_000);
    let build = Build::new(&world, &spec, &output).unwrap();
    let (tiles, samples) = build.tiles();
    assert!(tiles == 1 && samples <= 2048 * 2048, "{tiles} {samples}");
    assert_eq!(build.max_parts(), 652 * 326);
    assert!(build.memory() <= 1 << 30);
}

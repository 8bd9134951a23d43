//! The calls, as C makes them: results are those of the library, and wrong arguments are errors with a message.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

use orogen::chunks::*;
use orogen::objects::*;
use orogen::sampler::*;
use orogen::status::{OrogenStatus, orogen_error, orogen_version};
use orogen::world::*;

const RECIPE: &str = "orogen = 1\n[world]\nsize = [1000, 800]\ncell = 10\nseed = 7\n[nodes.a]\nop = \"fbm\"\nwavelength = 300\n\
                      [nodes.b]\nop = \"remap\"\nsource = \"a\"\nto = [0, 100]\n[outputs]\nheight = \"b\"\n\
                      [[scatter]]\nname = \"tree\"\nspacing = 40\n";

fn message() -> String {
    // SAFETY: the message is never null.
    unsafe { CStr::from_ptr(orogen_error()) }.to_str().unwrap().to_string()
}

fn c(text: &str) -> CString {
    CString::new(text).unwrap()
}

/// A world that is freed at the end of its test.
struct Opened(*mut OrogenWorld);

impl Drop for Opened {
    fn drop(&mut self) {
        // SAFETY: made by `open`, once.
        unsafe { orogen_world_free(self.0) };
    }
}

fn open() -> Opened {
    // SAFETY: two texts.
    let world = unsafe { orogen_world_parse(c(RECIPE).as_ptr(), c("test").as_ptr(), 1, 1 << 30) };
    assert!(!world.is_null(), "{}", message());
    Opened(world)
}

fn window() -> OrogenWindow {
    OrogenWindow { x: 3, y: 5, width: 7, height: 4, cell: 10.0 }
}

#[test]
fn windows_points_and_worlds_are_those_of_the_library() {
    let world = open();
    let own = engine::World::open(engine::Recipe::parse(RECIPE, "test").unwrap()).unwrap();
    let expect = own.window("height", &engine::Window::new(7, 4, 10.0).at(3, 5)).unwrap();
    let mut out = [0f32; 28];
    // SAFETY: all pointers are to what the calls expect.
    unsafe {
        let mut info = std::mem::zeroed::<OrogenWorldInfo>();
        assert_eq!(orogen_world_info(world.0, &raw mut info), OrogenStatus::OROGEN_OK);
        assert_eq!((info.is_bounded, info.width, info.height, info.cell, info.seed), (true, 1000.0, 800.0, 10.0, 7));
        let mut whole = window();
        assert_eq!(orogen_world_whole(world.0, 10.0, &raw mut whole), OrogenStatus::OROGEN_OK);
        assert_eq!((whole.width, whole.height), (100, 80));
        let layer = c("height");
        assert_eq!(
            orogen_world_window(world.0, layer.as_ptr(), window(), out.as_mut_ptr(), 28),
            OrogenStatus::OROGEN_OK
        );
        assert_eq!(out.as_slice(), expect.data());
        let sampler = orogen_sampler_new(world.0, layer.as_ptr());
        let mut again = [0f32; 28];
        assert_eq!(orogen_sampler_window(sampler, window(), again.as_mut_ptr(), 28), OrogenStatus::OROGEN_OK);
        assert_eq!(again, out);
        let (x, y) = ([30.0, 40.0], [50.0, 50.0]);
        let status = orogen_sampler_points(sampler, x.as_ptr(), y.as_ptr(), 2, again.as_mut_ptr());
        assert_eq!((status, again[0], again[1]), (OrogenStatus::OROGEN_OK, out[0], out[1]));
        assert_eq!(orogen_sampler_points(sampler, null(), null(), 0, null_mut()), OrogenStatus::OROGEN_OK);
        orogen_sampler_free(sampler);
        assert_eq!(CStr::from_ptr(orogen_version()).to_str().unwrap(), env!("CARGO_PKG_VERSION"));
    }
}

#[test]
fn chunks_cover_the_ground_around_a_viewer() {
    let world = open();
    // SAFETY: all pointers are to what the calls expect.
    unsafe {
        let mut lod = orogen_lod_default();
        (lod.cells, lod.cell, lod.levels, lod.range) = (8, 10.0, 2, 200.0);
        let chunks = orogen_chunks_new(world.0, lod);
        assert_eq!(orogen_chunks_set_viewer(chunks, 500.0, 400.0), OrogenStatus::OROGEN_OK);
        let mut chunk = OrogenChunk { x: 0, y: 0, level: 0 };
        let (mut has, mut made) = (false, Vec::new());
        loop {
            assert_eq!(orogen_chunks_take(chunks, &raw mut chunk, &raw mut has), OrogenStatus::OROGEN_OK);
            if !has {
                break;
            }
            let mut samples = window();
            assert_eq!(orogen_chunks_window(chunks, chunk, &raw mut samples), OrogenStatus::OROGEN_OK);
            assert_eq!(samples.cell, 10.0 * f64::from(1 << chunk.level));
            made.push(chunk);
            assert_eq!(orogen_chunks_done(chunks, chunk), OrogenStatus::OROGEN_OK);
        }
        assert!(made.len() > 4 && made.iter().any(|chunk| chunk.level == 0), "{}", made.len());
        assert_eq!(orogen_chunks_set_viewer(chunks, 0.0, 0.0), OrogenStatus::OROGEN_OK);
        assert_eq!(orogen_chunks_take(chunks, &raw mut chunk, &raw mut has), OrogenStatus::OROGEN_OK);
        let first = chunk;
        assert_eq!(orogen_chunks_forget(chunks, chunk), OrogenStatus::OROGEN_OK);
        let mut last = chunk;
        loop {
            assert_eq!(orogen_chunks_take(chunks, &raw mut chunk, &raw mut has), OrogenStatus::OROGEN_OK);
            if !has {
                break;
            }
            last = chunk;
        }
        assert_eq!(last, first, "a chunk that was forgotten comes after all others");
        assert_eq!(orogen_chunks_evict(chunks, &raw mut chunk, &raw mut has), OrogenStatus::OROGEN_OK);
        orogen_chunks_free(chunks);
        lod.cells = 7;
        assert!(orogen_chunks_new(world.0, lod).is_null() && message().contains("must be even"), "{}", message());
    }
}

#[test]
fn objects_have_kinds_and_are_in_their_window() {
    let world = open();
    let part = OrogenWindow { x: 0, y: 0, width: 50, height: 40, cell: 10.0 };
    // SAFETY: all pointers are to what the calls expect.
    unsafe {
        let objects = orogen_objects_new(world.0, part);
        assert!(!objects.is_null(), "{}", message());
        let (mut list, mut count) = (null(), 0);
        assert_eq!(orogen_objects_list(objects, &raw mut list, &raw mut count), OrogenStatus::OROGEN_OK);
        let found = std::slice::from_raw_parts(list, count);
        assert!(found.len() > 50 && found.iter().all(|object| (0.0..500.0).contains(&object.x) && object.y < 400.0));
        assert_eq!(CStr::from_ptr(orogen_objects_kind(objects, found[0].kind)).to_str().unwrap(), "tree");
        assert!(orogen_objects_kind(objects, 9).is_null() && message().contains("no number 9"));
        orogen_objects_free(objects);
    }
}

#[test]
fn wrong_arguments_are_errors() {
    let world = open();
    let mut out = [0f32; 28];
    let height = c("height");
    // SAFETY: null and texts are what the calls must take.
    unsafe {
        let mut calls: Vec<(OrogenStatus, &str)> = Vec::new();
        let mut note = |status, part| {
            assert!(message().contains(part), "{part}: {}", message());
            calls.push((status, part));
        };
        note(orogen_world_window(null(), height.as_ptr(), window(), out.as_mut_ptr(), 28), "`world` is null");
        note(orogen_world_window(world.0, null(), window(), out.as_mut_ptr(), 28), "`layer` is null");
        note(orogen_world_window(world.0, c("heigth").as_ptr(), window(), out.as_mut_ptr(), 28), "height");
        note(orogen_world_window(world.0, height.as_ptr(), window(), out.as_mut_ptr(), 27), "room for 27 samples");
        note(orogen_world_window(world.0, height.as_ptr(), window(), null_mut(), 28), "`out` is null");
        let far = OrogenWindow { x: 1 << 40, ..window() };
        note(orogen_world_window(world.0, height.as_ptr(), far, out.as_mut_ptr(), 28), "world");
        let large = OrogenWindow { width: usize::MAX, height: usize::MAX, ..window() };
        note(orogen_world_window(world.0, height.as_ptr(), large, out.as_mut_ptr(), 28), "");
        let bad = CString::new(vec![0xff]).unwrap();
        note(orogen_world_window(world.0, bad.as_ptr(), window(), out.as_mut_ptr(), 28), "not UTF-8");
        assert!(calls.iter().all(|(status, _)| *status == OrogenStatus::OROGEN_REQUEST), "{calls:?}");
        assert!(orogen_world_open(c("hils").as_ptr()).is_null() && message().contains("did you mean `hills`?"));
        assert!(orogen_world_parse(c("orogen = 2").as_ptr(), c("test").as_ptr(), 0, 0).is_null());
        assert!(orogen_sampler_new(null(), height.as_ptr()).is_null());
        orogen_world_free(null_mut());
    }
}

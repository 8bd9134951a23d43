//! Objects on the ground: trees, rocks, houses.

use std::ffi::{CString, c_char};

use engine::{Progress, Window};

use crate::handle::{borrowed, buffer, free};
use crate::status::{OrogenStatus, guarded, made, wrong};
use crate::world::{OrogenWindow, OrogenWorld};

/// The objects of a window.
pub struct OrogenObjects {
    objects: Vec<OrogenObject>,
    names: Vec<CString>,
}

/// An object.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct OrogenObject {
    /// Metres east of the origin.
    pub x: f64,
    /// Metres south of the origin.
    pub y: f64,
    /// Height of the ground, in metres.
    pub height: f64,
    /// Scale factor.
    pub size: f64,
    /// Rotation about the vertical axis in degrees, clockwise seen from above.
    pub turn: f64,
    /// Number of its kind, whose name is `orogen_objects_kind`.
    pub kind: u32,
}

/// The objects of a window, which is half open: adjacent windows share none. Null after an error, also if the recipe
/// has no objects. Free them by `orogen_objects_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_objects_new(world: *const OrogenWorld, window: OrogenWindow) -> *mut OrogenObjects {
    made(|| {
        // SAFETY: the contract of the header.
        let world = &unsafe { borrowed(world, "world") }?.world;
        let found = world.objects(&Window::from(window), &Progress::none())?;
        let object = |object: &engine::Object| OrogenObject {
            x: object.position[0],
            y: object.position[1],
            height: object.height,
            size: object.size,
            turn: object.turn,
            kind: object.entry as u32,
        };
        let name = |name: &str| CString::new(name).unwrap_or_default();
        Ok(OrogenObjects {
            objects: found.iter().map(object).collect(),
            names: world.recipe().scatter().iter().map(|entry| name(&entry.name)).collect(),
        })
    })
}

/// Frees objects. Null does nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_objects_free(objects: *mut OrogenObjects) {
    // SAFETY: the contract of the header.
    unsafe { free(objects) }
}

/// The objects and their number. The pointer is valid until the objects are freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_objects_list(
    objects: *const OrogenObjects,
    list: *mut *const OrogenObject,
    count: *mut usize,
) -> OrogenStatus {
    guarded(|| {
        // SAFETY: the contract of the header.
        let (objects, list, count) =
            unsafe { (borrowed(objects, "objects")?, buffer(list, 1, "list")?, buffer(count, 1, "count")?) };
        list[0] = objects.objects.as_ptr();
        count[0] = objects.objects.len();
        Ok(())
    })
}

/// The name of a kind of objects, valid until the objects are freed; null if there is no such kind.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_objects_kind(objects: *const OrogenObjects, kind: u32) -> *const c_char {
    let mut name = std::ptr::null();
    guarded(|| {
        // SAFETY: the contract of the header.
        let objects = unsafe { borrowed(objects, "objects") }?;
        let missing = || wrong(format!("there are {} kinds of objects, and no number {kind}", objects.names.len()));
        name = objects.names.get(kind as usize).ok_or_else(missing)?.as_ptr();
        Ok(())
    });
    name
}

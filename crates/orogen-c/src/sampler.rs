//! A layer at points and in small windows, planned once.

use std::ffi::c_char;
use std::sync::Arc;

use engine::{Sampler, Window, World};

use crate::handle::{borrowed, buffer, free, numbers, text};
use crate::status::{OrogenStatus, guarded, made, wrong};
use crate::world::{OrogenWindow, OrogenWorld};

/// A layer of a world that is ready to be read. It works on the calling thread, and may be used by any number of
/// threads at the same time.
pub struct OrogenSampler {
    pub(crate) sampler: Sampler<Arc<World>>,
}

/// Prepares a layer, such as "height": it is planned, and what it needs of the whole world is solved. Null after an
/// error. Free it by `orogen_sampler_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_sampler_new(world: *const OrogenWorld, layer: *const c_char) -> *mut OrogenSampler {
    made(|| {
        // SAFETY: the contract of the header.
        let (world, layer) = unsafe { (borrowed(world, "world")?, text(layer, "layer")?) };
        Ok(OrogenSampler { sampler: Sampler::new(Arc::clone(&world.world), layer)? })
    })
}

/// Frees a sampler. Null does nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_sampler_free(sampler: *mut OrogenSampler) {
    // SAFETY: the contract of the header.
    unsafe { free(sampler) }
}

/// Writes the values at `count` points to `out`: `x` and `y` are in metres east and south of the origin.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_sampler_points(
    sampler: *const OrogenSampler,
    x: *const f64,
    y: *const f64,
    count: usize,
    out: *mut f32,
) -> OrogenStatus {
    guarded(|| {
        // SAFETY: the contract of the header.
        let sampler = unsafe { borrowed(sampler, "sampler") }?;
        // SAFETY: the contract of the header.
        let (x, y, out) = unsafe { (numbers(x, count, "x")?, numbers(y, count, "y")?, buffer(out, count, "out")?) };
        sampler.sampler.points(x, y, out)
    })
}

/// Writes the samples of a window to `out`, row by row from the north-west, without allocating memory if the layer has
/// no filters. `count` is the number of samples that fit, and must be at least width * height.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_sampler_window(
    sampler: *const OrogenSampler,
    window: OrogenWindow,
    out: *mut f32,
    count: usize,
) -> OrogenStatus {
    guarded(|| {
        // SAFETY: the contract of the header.
        let sampler = unsafe { borrowed(sampler, "sampler") }?;
        let window = Window::from(window);
        sampler.sampler.world().check(&window)?;
        if window.len() > count {
            let message = format!("`out` has room for {count} samples, but the window has {}", window.len());
            return Err(wrong(message));
        }
        // SAFETY: the contract of the header.
        let out = unsafe { buffer(out, window.len(), "out") }?;
        sampler.sampler.fill(&window, out)
    })
}

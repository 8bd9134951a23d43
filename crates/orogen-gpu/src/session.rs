//! Sessions with a graphics card.

use crate::failure::Failure;
use crate::gpu::{Gpu, Options};
use orogen_engine::Session;
use std::sync::Arc;

/// Sessions that compute windows on a graphics card.
pub trait WithGpu: Sized {
    /// The same session with the first usable graphics card. Windows of worlds that are opened in it are computed on
    /// the card as far as possible. They are close to the processor's, but not bit-equal. The processor always computes
    /// solutions of solvers, tiles of levels, points and objects.
    ///
    /// ```no_run
    /// use orogen_engine::{Options, Session, Window, presets};
    /// use orogen_gpu::WithGpu;
    ///
    /// let session = Session::new(Options::default())?.with_gpu()?;
    /// let recipe = presets::find("classic").ok_or("no such preset")?.recipe()?;
    /// let preview = session.open(recipe)?.window("height", &Window::new(512, 512, 30.0))?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If there is no graphics card that can be used.
    fn with_gpu(&self) -> Result<Self, Failure>;
}

impl WithGpu for Session {
    fn with_gpu(&self) -> Result<Session, Failure> {
        Ok(self.with_device(Arc::new(Gpu::open(&Options::default())?)))
    }
}

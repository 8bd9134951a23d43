//! A running export.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, channel};

use orogen::recipe::Recipe;
use orogen::{Progress, Result, Session};

use super::request::Export;
use crate::preview::worker::Wake;

/// A running export.
pub struct Running {
    progress: Progress,
    share: Arc<AtomicU32>,
    result: Receiver<Result<String>>,
}

impl Running {
    /// Starts an export on a thread of the session.
    ///
    /// # Errors
    /// If no thread can be started.
    pub fn start(
        export: Export,
        recipe: Recipe,
        own: Option<PathBuf>,
        session: &Session,
        wake: Wake,
    ) -> Result<Running> {
        let share = Arc::new(AtomicU32::new(0));
        let (heard, told) = (Arc::clone(&share), Arc::clone(&wake));
        let progress = Progress::new(move |done| {
            heard.store((done * 1000.0) as u32, Ordering::Relaxed);
            told();
        });
        let (sender, result) = channel();
        let own_progress = progress.clone();
        session.start(move |session| {
            // The dialog may already be closed.
            let _ = sender.send(export.run(session, recipe, own.as_deref(), &own_progress));
            wake();
        })?;
        Ok(Running { progress, share, result })
    }

    /// The completed share, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f32 {
        self.share.load(Ordering::Relaxed) as f32 / 1000.0
    }

    /// Cancels the work.
    pub fn cancel(&self) {
        self.progress.cancel();
    }

    /// The result, once the export has ended: a description of the file. `None` while it runs.
    #[must_use]
    pub fn result(&self) -> Option<Result<String>> {
        self.result.try_recv().ok()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.cancel();
    }
}

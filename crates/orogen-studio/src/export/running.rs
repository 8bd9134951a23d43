//! A running export.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, channel};

use orogen::recipe::Recipe;
use orogen::{Progress, Result, Session};
use serde::{Deserialize, Serialize};

use super::kept;
use super::request::Export;
use crate::platform::{self, Task, wire};
use crate::preview::worker::Wake;

/// The work of an export.
#[derive(Serialize, Deserialize)]
pub struct Exporting {
    #[serde(with = "kept::wire")]
    export: Export,
    #[serde(with = "wire::recipe")]
    recipe: Recipe,
    /// The recipe's file.
    own: Option<PathBuf>,
}

/// The end of an export: a description of the file.
#[derive(Serialize, Deserialize)]
pub struct Event(#[serde(with = "wire::result")] Result<String>);

impl Task for Exporting {
    const NAME: &'static str = "export";
    type Event = Event;

    fn run(self, session: &Session, progress: &Progress, tell: &(dyn Fn(Event) + Send + Sync)) {
        tell(Event(self.export.run(session, self.recipe, self.own.as_deref(), progress)));
    }
}

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
        // The dialog may already be closed.
        platform::start(session, Exporting { export, recipe, own }, &progress, move |Event(result)| {
            let _ = sender.send(result);
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

//! Work outside of the thread of the user interface.

use std::time::Duration;

use orogen::{Progress, Session};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Work outside of the thread of the user interface, as data that can be sent to another instance of the program.
pub trait Task: Serialize + DeserializeOwned + Send + 'static {
    /// The name by which another instance finds it.
    const NAME: &'static str;

    /// Whether it is done before tasks that are not.
    const IS_URGENT: bool = false;

    /// What it tells while it runs.
    type Event: Serialize + DeserializeOwned + Send + 'static;

    /// How long it waits for a change that makes it needless, where work cannot be cancelled at any time.
    fn delay(&self) -> Duration {
        Duration::ZERO
    }

    /// Does the work. It ends soon once `progress` is cancelled.
    fn run(self, session: &Session, progress: &Progress, tell: &(dyn Fn(Self::Event) + Send + Sync));
}

//! All tasks by their names, for the instance of the program in a worker.

use orogen::{Progress, Session};

use crate::export::running::Exporting;
use crate::platform::Task;
use crate::preview::detail::RingTask;
use crate::preview::strip::Variants;
use crate::preview::survey::Measuring;
use crate::preview::thumbnails::NodePictures;
use crate::preview::worker::Pictures;
#[cfg(feature = "window")]
use crate::window::light::SkyTask;

/// Receives the bytes of an event.
type Tell<'a> = dyn Fn(Vec<u8>) + Send + Sync + 'a;

/// Runs the task of this name with these bytes.
pub fn run(name: &str, bytes: &[u8], session: &Session, progress: &Progress, tell: &Tell<'_>) {
    let arguments = (bytes, session, progress, tell);
    match name {
        Pictures::NAME => one::<Pictures>(arguments),
        RingTask::NAME => one::<RingTask>(arguments),
        NodePictures::NAME => one::<NodePictures>(arguments),
        Variants::NAME => one::<Variants>(arguments),
        Measuring::NAME => one::<Measuring>(arguments),
        Exporting::NAME => one::<Exporting>(arguments),
        #[cfg(feature = "window")]
        SkyTask::NAME => one::<SkyTask>(arguments),
        // Both instances are the same program.
        _ => {}
    }
}

fn one<T: Task>((bytes, session, progress, tell): (&[u8], &Session, &Progress, &Tell<'_>)) {
    // What one instance has written, another one of the same program can read.
    if let Ok(task) = postcard::from_bytes::<T>(bytes) {
        task.run(session, progress, &|event| {
            if let Ok(bytes) = postcard::to_stdvec(&event) {
                tell(bytes);
            }
        });
    }
}

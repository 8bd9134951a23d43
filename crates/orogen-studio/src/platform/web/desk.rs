//! Hands tasks to workers, which run one after another, and their events to those who asked.
//!
//! There are two workers: one for pictures of the land, and one for everything else, which waits. A cancelled task that
//! does not end soon is ended with its worker; a new worker has nothing of what the old one has solved. Where memory is
//! shared, tasks are interrupted, and end soon.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::time::Duration;

use js_sys::{Array, Uint8Array};
use orogen::{Error, ErrorKind, Progress, Result, Session};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};
use web_sys::MessageEvent;

use super::super::Task;
use super::group::WorkerGroup;
use super::message::array;
use super::{Instant, SHARES_MEMORY, files, storage};

/// How long a cancelled task may go on.
const PATIENCE: Duration = Duration::from_millis(if SHARES_MEMORY { 10_000 } else { 400 });

/// Receives the bytes of an event.
type Hear = Box<dyn Fn(&[u8])>;

/// A task that was asked for.
struct Job {
    number: f64,
    name: &'static str,
    bytes: Vec<u8>,
    progress: Progress,
    hear: Hear,
    not_before: Instant,
    /// The share of the work that was reported.
    share: f64,
    /// Files that it has made.
    made: Vec<(String, Vec<u8>)>,
    /// When it was first found cancelled.
    cancelled: Option<Instant>,
}

/// A worker and its tasks.
#[derive(Default)]
struct Desk {
    group: Option<WorkerGroup>,
    /// The number of the last change of the files that it knows.
    files: u64,
    running: Option<Job>,
    waiting: VecDeque<Job>,
    /// Whether a look at the tasks is due later.
    is_due: bool,
}

thread_local! {
    static DESKS: RefCell<[Desk; 2]> = RefCell::default();
    static NUMBER: RefCell<f64> = const { RefCell::new(0.0) };
}

/// Starts a task in a worker. `tell` is called between frames.
///
/// # Errors
/// If the task cannot be sent.
pub fn start<T: Task>(
    _: &Session,
    task: T,
    progress: &Progress,
    tell: impl Fn(T::Event) + Send + Sync + 'static,
) -> Result<()> {
    let delay = task.delay();
    let bytes = postcard::to_stdvec(&task).map_err(|cause| failed(&format!("a task cannot be sent: {cause}")))?;
    let number = NUMBER.with_borrow_mut(|number| {
        *number += 1.0;
        *number
    });
    let hear = Box::new(move |bytes: &[u8]| match postcard::from_bytes(bytes) {
        Ok(event) => tell(event),
        Err(cause) => super::warn(&format!("an event of a worker cannot be read: {cause}")),
    });
    progress.expect(1.0);
    let job = Job {
        number,
        name: T::NAME,
        bytes,
        progress: progress.clone(),
        hear,
        not_before: Instant::now() + delay,
        share: 0.0,
        made: Vec::new(),
        cancelled: None,
    };
    DESKS.with_borrow_mut(|desks| desks[usize::from(!T::IS_URGENT)].waiting.push_back(job));
    Ok(())
}

fn failed(message: &str) -> Error {
    Error::new(ErrorKind::Internal, message)
}

/// Starts the worker for pictures, before there is a task for it.
pub fn prepare() {
    if let Err(cause) = DESKS.with_borrow_mut(|desks| desks[0].hire(0).map(drop)) {
        super::warn(&format!("no worker can be started: {cause:?}"));
    }
}

/// Looks at the tasks at the end of a frame, when it is known which of them are still wanted.
pub fn end_frame() {
    storage::keep();
    (0..2).for_each(look);
}

/// Ends cancelled tasks, and gives the next one to its worker.
fn look(at: usize) {
    let due = DESKS.with_borrow_mut(|desks| desks[at].look(at));
    if let Some(wait) = due {
        later(at, wait);
    }
}

fn later(at: usize, wait: Duration) {
    let call = Closure::once_into_js(move || {
        DESKS.with_borrow_mut(|desks| desks[at].is_due = false);
        look(at);
    });
    if let Some(window) = web_sys::window() {
        let millis = i32::try_from(wait.as_millis()).unwrap_or(i32::MAX).saturating_add(1);
        let _ = window.set_timeout_with_callback_and_timeout_and_arguments_0(call.unchecked_ref(), millis);
    }
}

impl Desk {
    /// Returns after which time to look again, unless that is already due.
    fn look(&mut self, at: usize) -> Option<Duration> {
        let now = Instant::now();
        self.waiting.retain(|job| !job.progress.is_cancelled());
        let mut wait = None;
        if let Some(job) = self.running.as_mut().filter(|job| job.progress.is_cancelled()) {
            if let Some(group) = self.group.as_ref().filter(|_| job.cancelled.is_none()) {
                group.interrupt();
            }
            let spent = now - *job.cancelled.get_or_insert(now);
            if spent >= PATIENCE {
                self.end_worker();
            } else {
                wait = Some(PATIENCE - spent);
            }
        }
        if self.running.is_none()
            && let Some(job) = self.waiting.pop_front()
        {
            if job.not_before > now {
                wait = Some(job.not_before - now);
                self.waiting.push_front(job);
            } else {
                self.give(at, job);
            }
        }
        let wait = wait.filter(|_| !self.is_due);
        self.is_due |= wait.is_some();
        wait
    }

    fn end_worker(&mut self) {
        if let Some(group) = self.group.take() {
            group.end();
        }
        (self.running, self.files) = (None, 0);
    }

    /// Gives a task to the worker, or puts it back until the worker is ready.
    fn give(&mut self, at: usize, job: Job) {
        match self.hire(at) {
            Ok(true) => {}
            Ok(false) => return self.waiting.push_front(job),
            Err(cause) => return super::warn(&format!("no worker can be started: {cause:?}")),
        }
        match self.send(&job) {
            Ok(()) => self.running = Some(Job { bytes: Vec::new(), ..job }),
            Err(cause) => super::warn(&format!("a task cannot be sent: {cause:?}")),
        }
    }

    /// Sends the files that have changed, and a task.
    fn send(&mut self, job: &Job) -> std::result::Result<(), JsValue> {
        let Some(group) = &self.group else { return Ok(()) };
        let worker = group.worker();
        for (path, bytes) in storage::changed(&mut self.files) {
            let bytes = bytes.map_or(JsValue::NULL, |bytes| Uint8Array::from(&bytes[..]).into());
            worker.post_message(&array(&["file".into(), path.into(), bytes]))?;
        }
        let bytes = Uint8Array::from(&job.bytes[..]);
        let buffers = Array::of1(&bytes.buffer());
        let message = array(&["task".into(), job.number.into(), job.name.into(), bytes.into()]);
        worker.post_message_with_transfer(&message, &buffers)
    }

    /// Starts the worker if necessary. Returns whether it is ready.
    fn hire(&mut self, at: usize) -> std::result::Result<bool, JsValue> {
        if let Some(group) = &self.group {
            return Ok(group.is_ready());
        }
        let hear = Closure::<dyn FnMut(JsValue)>::new(move |event: JsValue| match event.dyn_ref::<MessageEvent>() {
            Some(event) => hear(at, &event.data()),
            None => hear(at, &event),
        });
        let group = WorkerGroup::start(hear.into_js_value().unchecked_into())?;
        let is_ready = group.is_ready();
        self.group = Some(group);
        Ok(is_ready)
    }
}

/// A message of a worker: what it is, the number of the task, and what follows.
fn hear(at: usize, message: &JsValue) {
    let parts: &Array = message.unchecked_ref();
    let (what, number) = (parts.get(0).as_string().unwrap_or_default(), parts.get(1).as_f64());
    let bytes = |part: u32| Uint8Array::new(&parts.get(part)).to_vec();
    let mut ended = None;
    let is_of_group = DESKS.with_borrow_mut(|desks| {
        let desk = &mut desks[at];
        if desk.group.as_mut().is_some_and(|group| group.hear(parts)) {
            return true;
        }
        let Some(job) = desk.running.as_mut().filter(|job| Some(job.number) == number) else { return false };
        match what.as_str() {
            "event" => (job.hear)(&bytes(2)),
            "share" => {
                let share = parts.get(2).as_f64().unwrap_or(0.0);
                job.progress.advance(share - job.share);
                job.share = share.max(job.share);
            }
            "file" => job.made.push((parts.get(2).as_string().unwrap_or_default(), bytes(3))),
            _ => ended = desk.running.take(),
        }
        false
    });
    if is_of_group {
        look(at);
    }
    if let Some(job) = ended {
        if !job.progress.is_cancelled() {
            files::hand_over(job.made);
        }
        look(at);
    }
}

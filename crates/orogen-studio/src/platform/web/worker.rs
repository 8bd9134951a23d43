//! The instance of the program in a worker: it runs tasks one after another.

use std::cell::{Cell, RefCell};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use js_sys::{Array, Uint8Array};
use orogen::io::fs;
use orogen::{Budget, Options, Progress, Session};
use wasm_bindgen::{JsCast as _, JsValue};
use web_sys::DedicatedWorkerGlobalScope;

use super::message::array;
use super::{Instant, MEMORY, clock, warn};

/// Runs the task of this name with these bytes; the last argument receives the bytes of its events.
pub type Runner = fn(&str, &[u8], &Session, &Progress, &(dyn Fn(Vec<u8>) + Send + Sync));

/// The time between two reports of the completed share, in milliseconds.
const BETWEEN: u64 = 100;

thread_local! {
    static SESSION: RefCell<Option<Session>> = const { RefCell::new(None) };
    /// Number of threads that the page has started for the session.
    static THREADS: Cell<usize> = const { Cell::new(0) };
    /// Set by the page to interrupt a task.
    static STOP: Arc<AtomicBool> = Arc::default();
    /// The number of the last change of a file that the page knows.
    static KNOWN: RefCell<u64> = const { RefCell::new(0) };
}

/// Takes a message of the page: a question for the memory, the number of threads, a file (`null` for a removed one), or
/// a task.
pub fn work(message: &JsValue, runner: Runner) {
    fs::memory::set_clock(clock);
    let parts: &Array = message.unchecked_ref();
    let text = |part: u32| parts.get(part).as_string().unwrap_or_default();
    match text(0).as_str() {
        "share" => {
            let stop = STOP.with(|stop| Arc::as_ptr(stop) as usize as f64);
            return post(&array(&["shared".into(), 0.into(), wasm_bindgen::memory(), stop.into()]), &Array::new());
        }
        "threads" => return THREADS.set(parts.get(1).as_f64().unwrap_or_default() as usize),
        "file" => {
            let bytes = parts.get(2);
            put(&text(1), bytes.is_object().then(|| Uint8Array::new(&bytes).to_vec()));
            return KNOWN.set(fs::memory::changes(u64::MAX).0);
        }
        _ => {}
    }
    let number = parts.get(1).as_f64().unwrap_or(0.0);
    if let Some(session) = session() {
        runner(&text(2), &Uint8Array::new(&parts.get(3)).to_vec(), &session, &progress(number), &move |event| {
            post_bytes(&["event".into(), number.into()], &event);
        });
    }
    let (last, made) = fs::memory::changes(KNOWN.take());
    KNOWN.set(last);
    for path in made {
        if let Ok(bytes) = fs::read(&path) {
            post_bytes(&["file".into(), number.into(), path.to_string_lossy().as_ref().into()], &bytes);
            // The page has it.
            let _ = fs::remove_file(&path);
        }
    }
    KNOWN.set(fs::memory::changes(u64::MAX).0);
    post(&array(&["end".into(), number.into()]), &Array::new());
}

fn session() -> Option<Session> {
    SESSION.with_borrow_mut(|session| {
        if session.is_none() {
            let threads = Some(THREADS.get());
            *session = Session::new(Options { threads, memory: Budget::of(MEMORY), ..Options::default() }).ok();
        }
        session.clone()
    })
}

/// Lends this thread to the instance with the same memory that runs tasks.
#[cfg(target_feature = "atomics")]
pub fn lend() {
    post(&array(&["lent".into()]), &Array::new());
    orogen::pool::lend_thread()
}

/// Progress that reports its share to the page, and that the page can interrupt. With threads, any of them reports.
fn progress(number: f64) -> Progress {
    let (begun, last) = (Instant::now(), AtomicU64::new(0));
    let stop = STOP.with(Arc::clone);
    stop.store(false, Ordering::Relaxed);
    let progress = Progress::new(move |share| {
        let now = begun.elapsed().as_millis() as u64;
        if now.saturating_sub(last.load(Ordering::Relaxed)) >= BETWEEN {
            last.store(now, Ordering::Relaxed);
            post(&array(&["share".into(), number.into(), share.into()]), &Array::new());
        }
    });
    progress.stopped_by(stop)
}

fn put(path: &str, bytes: Option<Vec<u8>>) {
    let path = Path::new(path);
    let done = match bytes {
        Some(bytes) => fs::create_dir_all(fs::folder(path)).and_then(|()| fs::write(path, bytes)),
        None => fs::remove_file(path).or(Ok(())),
    };
    if let Err(cause) = done {
        warn(&format!("{} is missing in a worker: {cause}", path.display()));
    }
}

fn post_bytes(head: &[JsValue], bytes: &[u8]) {
    let bytes = Uint8Array::from(bytes);
    let message = array(head);
    message.push(&bytes);
    post(&message, &Array::of1(&bytes.buffer()));
}

fn post(message: &Array, buffers: &Array) {
    let scope: DedicatedWorkerGlobalScope = js_sys::global().unchecked_into();
    if let Err(cause) = scope.post_message_with_transfer(message, buffers) {
        warn(&format!("a worker cannot answer: {cause:?}"));
    }
}

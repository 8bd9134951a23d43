//! A worker, and the workers that lend it their threads.
//!
//! The instances of a module with threads share the memory of the first one: the page starts that one, passes its
//! memory on to the others, and tells it how many of them are ready. Through this memory the page also reaches a worker
//! that runs a task, and can interrupt it. Other modules have one worker, which hears of nothing meanwhile.

use js_sys::WebAssembly::Memory;
use js_sys::{Array, Atomics, Function, Uint8Array};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};
use web_sys::{Worker, WorkerOptions, WorkerType};

use super::message::array;
use super::{SHARES_MEMORY, warn};

/// The script of a worker.
const SCRIPT: &str = if SHARES_MEMORY { "worker.js?threads" } else { "worker.js" };

/// Maximum number of threads of a worker.
const MAX_THREADS: f64 = 16.0;

/// A worker that runs tasks, and its threads.
pub struct WorkerGroup {
    worker: Worker,
    lenders: Vec<Worker>,
    /// Number of lenders of which nothing was heard yet.
    starting: usize,
    /// Number of lenders that are ready.
    ready: usize,
    /// The memory, and the place of the byte that interrupts the task.
    shared: Option<(Memory, u32)>,
    /// Whether tasks can be given to it.
    is_ready: bool,
    listener: Function,
}

impl WorkerGroup {
    /// Starts a worker. `listener` receives the messages of all its threads.
    ///
    /// # Errors
    /// If the browser refuses.
    pub fn start(listener: Function) -> Result<WorkerGroup, JsValue> {
        let worker = begun(&listener, &JsValue::UNDEFINED)?;
        if SHARES_MEMORY {
            worker.post_message(&array(&["share".into()]))?;
        }
        Ok(WorkerGroup {
            worker,
            lenders: Vec::new(),
            starting: 0,
            ready: 0,
            shared: None,
            is_ready: !SHARES_MEMORY,
            listener,
        })
    }

    /// Whether tasks can be given to the worker.
    pub fn is_ready(&self) -> bool {
        self.is_ready
    }

    /// The worker.
    pub fn worker(&self) -> &Worker {
        &self.worker
    }

    /// Takes a message about memory and threads. Returns whether it was one.
    pub fn hear(&mut self, message: &Array) -> bool {
        match message.get(0).as_string().as_deref() {
            Some("shared") => {
                let memory: Memory = message.get(2).unchecked_into();
                self.borrow_threads(&memory);
                self.shared = Some((memory, message.get(3).as_f64().unwrap_or_default() as u32));
            }
            Some("lent") => self.count(true),
            Some("missing") => self.count(false),
            _ => return false,
        }
        if self.starting == 0 && !self.is_ready {
            let threads = JsValue::from(self.ready as u32);
            if let Err(cause) = self.worker.post_message(&array(&["threads".into(), threads])) {
                warn(&format!("a worker has no threads: {cause:?}"));
            }
            self.is_ready = true;
        }
        true
    }

    /// Starts a lender for each core.
    fn borrow_threads(&mut self, memory: &Memory) {
        let cores = web_sys::window().map_or(1.0, |window| window.navigator().hardware_concurrency());
        let threads = if cores > 1.0 { cores.min(MAX_THREADS) as usize } else { 0 };
        for _ in 0..threads {
            match begun(&self.listener, memory) {
                Ok(lender) => {
                    let listener = self.listener.clone();
                    let fail = Closure::<dyn FnMut()>::new(move || {
                        let message = array(&["missing".into()]);
                        let _ = listener.call1(&JsValue::NULL, &message);
                    });
                    lender.set_onerror(Some(fail.into_js_value().unchecked_ref()));
                    self.lenders.push(lender);
                }
                Err(cause) => warn(&format!("a thread cannot be started: {cause:?}")),
            }
        }
        self.starting = self.lenders.len();
    }

    fn count(&mut self, is_ready: bool) {
        // Later errors of a lender do not change the number.
        if self.starting > 0 {
            self.starting -= 1;
            self.ready += usize::from(is_ready);
        }
    }

    /// Interrupts the task that the worker runs, if it can be reached.
    pub fn interrupt(&self) {
        if let Some((memory, at)) = &self.shared
            && let Err(cause) = Atomics::store(&Uint8Array::new(&memory.buffer()), *at, 1)
        {
            warn(&format!("a worker cannot be interrupted: {cause:?}"));
        }
    }

    /// Ends all workers at once.
    pub fn end(self) {
        for worker in self.lenders.into_iter().chain([self.worker]) {
            worker.set_onmessage(None);
            worker.terminate();
        }
    }
}

/// A new worker, which has the module, and the memory of another one if that is given.
fn begun(listener: &Function, memory: &JsValue) -> Result<Worker, JsValue> {
    let options = WorkerOptions::new();
    options.set_type(WorkerType::Module);
    let worker = Worker::new_with_options(SCRIPT, &options)?;
    worker.set_onmessage(Some(listener));
    worker.post_message(&array(&["begin".into(), wasm_bindgen::module(), memory.clone()]))?;
    Ok(worker)
}

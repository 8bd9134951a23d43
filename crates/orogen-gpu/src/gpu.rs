//! An opened graphics card.

use crate::adapters::{Adapter, Choice, Kind, found};
use crate::failure::Failure;
use crate::pipelines::Pipelines;
use orogen_engine::device::Computed;
use orogen_engine::device_choice::DeviceChoice;
use orogen_grid::error::Error;
use orogen_grid::progress::Progress;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// An opened graphics card. Clones share it.
#[derive(Clone)]
pub struct Gpu {
    opened: Arc<Opened>,
}

struct Opened {
    adapter: Adapter,
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipelines: Pipelines,
    lost: Arc<Mutex<Option<String>>>,
    failure: Mutex<Option<Failure>>,
    seconds: Mutex<f64>,
    /// The start of the work that has not been waited for yet.
    begun: Mutex<Option<Instant>>,
    moved: Mutex<Moved>,
    together: AtomicUsize,
    buffer: u64,
    kernel: usize,
}

/// Number of samples that were copied between the processor's memory and the card's.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moved {
    /// Number of samples that were copied to the card.
    pub there: u64,
    /// Number of samples that were copied back.
    pub back: u64,
}

/// Options for opening a graphics card.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// The choice of the adapter.
    pub choice: Choice,
    /// Maximum size of a buffer, in bytes, if less than the adapter's limit. `None` uses the adapter's limit.
    pub buffer: Option<u64>,
    /// Maximum number of instructions of a program in one shader, where a call of a noise counts as 8. Larger programs
    /// are split. Default 64. With 1, each instruction is a separate shader: after a change of a recipe's structure
    /// only new instructions are compiled, but programs run slower.
    pub kernel: usize,
}

/// Maximum number of dispatches that are submitted together.
const TOGETHER: usize = 64;

/// Target time of dispatches that are submitted together, so that work can be cancelled and the driver does not abort
/// it after a timeout.
const PART: Duration = Duration::from_millis(100);

/// Default of [`Options::kernel`].
const KERNEL: usize = 64;

impl Default for Options {
    fn default() -> Options {
        Options::new(Choice::default())
    }
}

impl Options {
    /// Options for an adapter.
    #[must_use]
    pub fn new(choice: Choice) -> Options {
        Options { choice, buffer: None, kernel: KERNEL }
    }

    /// Sets the maximum size of a buffer, in bytes.
    #[must_use]
    pub fn with_buffer(mut self, bytes: u64) -> Options {
        self.buffer = Some(bytes);
        self
    }

    /// Sets the maximum number of instructions in a shader.
    #[must_use]
    pub fn with_kernel(mut self, instructions: usize) -> Options {
        self.kernel = instructions;
        self
    }
}

impl Gpu {
    /// Opens the first adapter that the choice allows and that can be used.
    ///
    /// # Errors
    /// If there is none; the message has the reason for each adapter.
    pub fn open(options: &Options) -> Result<Gpu, Failure> {
        let mut refused = Vec::new();
        for (adapter, handle) in found() {
            if !options.choice.allows(&adapter) {
                refused.push(match options.choice {
                    Choice::Card => format!("{adapter} computes on the processor"),
                    _ => format!("{adapter} was not asked for"),
                });
                continue;
            }
            if let Some(why) = &adapter.refused {
                refused.push(format!("{adapter}: {why}"));
                continue;
            }
            match Gpu::opened(adapter.clone(), &handle, options) {
                Ok(gpu) => return Ok(gpu),
                Err(error) => refused.push(format!("{adapter}: {error}")),
            }
        }
        Err(Failure::NoAdapter(match refused.is_empty() {
            true => "no driver for Vulkan, Metal or Direct3D 12 was found".to_string(),
            false => refused.join("; "),
        }))
    }

    /// Opens the card of a choice; `None` for the processor, or if there is none for [`DeviceChoice::Auto`]. Buffers
    /// have at most `buffer` bytes, if it is given.
    ///
    /// # Errors
    /// If a card was requested and none can be used.
    pub fn chosen(choice: &DeviceChoice, buffer: Option<u64>) -> Result<Option<Gpu>, Failure> {
        let wanted = match choice {
            DeviceChoice::Processor => return Ok(None),
            DeviceChoice::Auto => Choice::Card,
            DeviceChoice::Card(None) => Choice::Any,
            DeviceChoice::Card(Some(name)) => Choice::Named(name.clone()),
        };
        match Gpu::open(&Options { buffer, ..Options::new(wanted) }) {
            Err(_) if *choice == DeviceChoice::Auto => Ok(None),
            opened => opened.map(Some),
        }
    }

    fn opened(adapter: Adapter, handle: &wgpu::Adapter, options: &Options) -> Result<Gpu, wgpu::RequestDeviceError> {
        let given = handle.limits();
        let required_limits = wgpu::Limits {
            max_storage_buffer_binding_size: given.max_storage_buffer_binding_size,
            max_buffer_size: given.max_buffer_size,
            ..wgpu::Limits::default()
        };
        let wanted = wgpu::DeviceDescriptor { required_limits, ..wgpu::DeviceDescriptor::default() };
        let (device, queue) = pollster::block_on(handle.request_device(&wanted))?;
        let lost = Arc::new(Mutex::new(None));
        let told = Arc::clone(&lost);
        device.set_device_lost_callback(move |reason, message| {
            let message = if message.is_empty() { format!("{reason:?}") } else { message };
            *told.lock().unwrap_or_else(PoisonError::into_inner) = Some(message);
        });
        let told = Arc::clone(&lost);
        // Errors that no scope catches happen outside of jobs. The device is not used after such an error.
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            *told.lock().unwrap_or_else(PoisonError::into_inner) = Some(error.to_string());
        }));
        let buffer = options.buffer.unwrap_or(u64::MAX).min(adapter.limits.buffer);
        let pipelines = Pipelines::new(&device);
        let together = if adapter.kind == Kind::Software { 1 } else { TOGETHER };
        Ok(Gpu {
            opened: Arc::new(Opened {
                adapter,
                device,
                queue,
                pipelines,
                lost,
                failure: Mutex::default(),
                seconds: Mutex::default(),
                begun: Mutex::default(),
                moved: Mutex::default(),
                together: AtomicUsize::new(together),
                buffer,
                kernel: options.kernel.max(1),
            }),
        })
    }

    /// The adapter.
    #[must_use]
    pub fn adapter(&self) -> &Adapter {
        &self.opened.adapter
    }

    /// Number of shaders compiled so far.
    #[must_use]
    pub fn shaders_compiled(&self) -> u64 {
        self.opened.pipelines.compiled()
    }

    /// Maximum size of a buffer, in bytes.
    #[must_use]
    pub fn buffer_limit(&self) -> u64 {
        self.opened.buffer
    }

    /// The time of all jobs since the last call in seconds, from the first copy to the device to the end of the last
    /// shader, without copying back. Successive jobs on grids that stay on the device count as one, including the
    /// processor's work between them.
    #[doc(hidden)]
    #[must_use]
    pub fn take_seconds(&self) -> f64 {
        std::mem::take(&mut *self.opened.seconds.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The samples that were copied since the last call.
    #[doc(hidden)]
    #[must_use]
    pub fn take_moved(&self) -> Moved {
        std::mem::take(&mut *self.opened.moved.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Counts copied samples.
    pub(crate) fn count_moved(&self, moved: Moved) {
        let mut sum = self.opened.moved.lock().unwrap_or_else(PoisonError::into_inner);
        sum.there += moved.there;
        sum.back += moved.back;
    }

    /// Number of dispatches to be submitted together, which are expected to take a tenth of a second, judging by
    /// earlier dispatches.
    pub(crate) fn together(&self) -> usize {
        self.opened.together.load(Ordering::Relaxed)
    }

    /// Records the time of dispatches that were submitted together.
    pub(crate) fn took(&self, dispatches: usize, time: Duration) {
        let together = self.together();
        let next = match time {
            _ if time > PART => (dispatches as f64 * PART.as_secs_f64() / time.as_secs_f64()) as usize,
            // Twice as many would still take less time.
            _ if dispatches >= together && 2 * time < PART => 2 * together,
            _ => together,
        };
        self.opened.together.store(next.clamp(1, TOGETHER), Ordering::Relaxed);
    }

    /// Records the start of work.
    pub(crate) fn begin(&self) {
        self.opened.begun.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(Instant::now);
    }

    /// The seconds that the device takes to copy this many bytes within its memory.
    ///
    /// # Errors
    /// If the device was lost.
    #[doc(hidden)]
    pub fn copy_seconds(&self, bytes: u64) -> Result<f64, Failure> {
        use wgpu::BufferUsages as Usage;
        let buffer = |usage| {
            let size = bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
            self.device().create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
        };
        let (from, to) = (buffer(Usage::COPY_SRC), buffer(Usage::COPY_DST));
        let mut fastest = f64::MAX;
        // The first copy may include the allocation of memory.
        for _ in 0..4 {
            let mut encoder = self.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            encoder.copy_buffer_to_buffer(&from, 0, &to, 0, from.size());
            let begun = Instant::now();
            self.queue().submit([encoder.finish()]);
            self.wait()?;
            fastest = fastest.min(begun.elapsed().as_secs_f64());
        }
        Ok(fastest)
    }

    /// Destroys the device, as a restart of the driver would. For tests.
    #[doc(hidden)]
    pub fn lose(&self) {
        self.opened.device.destroy();
        *self.opened.lost.lock().unwrap_or_else(PoisonError::into_inner) = Some("it was destroyed".to_string());
    }

    /// The first failure, if there was one. The processor did the failed work, and all later work if the device was
    /// lost.
    #[must_use]
    pub fn failure(&self) -> Option<Failure> {
        self.opened.failure.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The result for the engine: failed work is declined, so that the processor does it, and cancelled work is an
    /// error.
    pub(crate) fn outcome<T>(
        &self,
        made: Result<Option<T>, Failure>,
        otherwise: Computed<T>,
        progress: &Progress,
    ) -> Result<Computed<T>, Error> {
        progress.check()?;
        match made {
            Ok(Some(made)) => Ok(Computed::Done(made)),
            Ok(None) => Ok(otherwise),
            Err(failure) => {
                self.opened.failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(failure);
                Ok(otherwise)
            }
        }
    }

    /// Maximum weight of a part of a program in one shader.
    pub(crate) fn kernel_weight(&self) -> usize {
        self.opened.kernel
    }

    pub(crate) fn device(&self) -> &wgpu::Device {
        &self.opened.device
    }

    pub(crate) fn queue(&self) -> &wgpu::Queue {
        &self.opened.queue
    }

    pub(crate) fn pipelines(&self) -> &Pipelines {
        &self.opened.pipelines
    }

    /// Whether the device can still be used.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        match &*self.opened.lost.lock().unwrap_or_else(PoisonError::into_inner) {
            Some(why) => Err(Failure::Lost(why.clone())),
            None => Ok(()),
        }
    }

    /// Whether both are the same opened card.
    pub(crate) fn is(&self, other: &Gpu) -> bool {
        Arc::ptr_eq(&self.opened, &other.opened)
    }

    /// A buffer of some words.
    pub(crate) fn buffer(&self, words: usize, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let size = 4 * words.max(4) as u64;
        self.device().create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    }

    /// Runs work, and converts errors of the device to failures.
    pub(crate) fn scoped<T>(&self, work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
        self.check()?;
        let out_of_memory = self.device().push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let invalid = self.device().push_error_scope(wgpu::ErrorFilter::Validation);
        let done = work();
        let invalid = pollster::block_on(invalid.pop());
        let out_of_memory = pollster::block_on(out_of_memory.pop());
        self.check()?;
        if let Some(error) = out_of_memory {
            return Err(Failure::Memory(error.to_string()));
        }
        if let Some(error) = invalid {
            return Err(Failure::Driver(error.to_string()));
        }
        done
    }

    /// Waits until all submitted work is done.
    pub(crate) fn wait(&self) -> Result<(), Failure> {
        let waited = self.opened.device.poll(wgpu::PollType::wait_indefinitely());
        if let Some(begun) = self.opened.begun.lock().unwrap_or_else(PoisonError::into_inner).take() {
            *self.opened.seconds.lock().unwrap_or_else(PoisonError::into_inner) += begun.elapsed().as_secs_f64();
        }
        self.check()?;
        waited.map(drop).map_err(|error| Failure::Lost(error.to_string()))
    }
}

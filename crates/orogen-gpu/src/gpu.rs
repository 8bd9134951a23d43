//! An opened graphics card.

use crate::adapters::{Adapter, Choice, found};
use crate::failure::Failure;
use crate::pipelines::Pipelines;
use std::sync::{Arc, Mutex, PoisonError};

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
    buffer: u64,
}

/// Options of opening a graphics card.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Which adapter.
    pub choice: Choice,
    /// Maximum size of a buffer, in bytes: less than the adapter's own limit. `None` uses that.
    pub buffer: Option<u64>,
}

impl Options {
    /// Options for an adapter.
    #[must_use]
    pub fn new(choice: Choice) -> Options {
        Options { choice, buffer: None }
    }

    /// With at most this size of a buffer, in bytes.
    #[must_use]
    pub fn with_buffer(mut self, bytes: u64) -> Options {
        self.buffer = Some(bytes);
        self
    }
}

impl Gpu {
    /// Opens the first adapter that the choice allows and that can be used.
    ///
    /// # Errors
    /// If there is none: why each was refused.
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
        // What no scope catches happens outside of jobs: the device is not to be trusted any more.
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            *told.lock().unwrap_or_else(PoisonError::into_inner) = Some(error.to_string());
        }));
        let buffer = options.buffer.unwrap_or(u64::MAX).min(adapter.limits.buffer);
        let pipelines = Pipelines::new(&device);
        Ok(Gpu { opened: Arc::new(Opened { adapter, device, queue, pipelines, lost, buffer }) })
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

    /// Gives the device up, as a driver that is restarted does: for tests of what happens then.
    #[doc(hidden)]
    pub fn lose(&self) {
        self.opened.device.destroy();
        *self.opened.lost.lock().unwrap_or_else(PoisonError::into_inner) = Some("it was given up".to_string());
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

    /// Waits until all submitted work is done.
    pub(crate) fn wait(&self) -> Result<(), Failure> {
        let waited = self.opened.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        waited.map(drop).map_err(|error| Failure::Lost(error.to_string()))
    }
}

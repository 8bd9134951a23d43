//! The graphics device, and its faults while the window is open.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui_wgpu::{RenderState, wgpu};

/// The faults of a device.
#[derive(Debug, Clone, Default)]
pub struct DeviceWatch {
    shared: Arc<Mutex<Faults>>,
    /// The device. Its callbacks do not have it, because in a page with threads a device cannot be sent to another one.
    device: Arc<Mutex<Option<wgpu::Device>>>,
}

#[derive(Debug, Default)]
struct Faults {
    /// The reason why the device is lost.
    lost: Option<String>,
    /// The first error that was not reported yet.
    error: Option<String>,
    /// Whether an error was reported.
    was_told: bool,
    /// The document that was open when the device was lost.
    document: Option<PathBuf>,
}

impl DeviceWatch {
    /// Starts watching the device of a window. Otherwise the first error would end the program.
    pub fn start(&self, state: &RenderState) {
        let shared = Arc::clone(&self.shared);
        state.device.set_device_lost_callback(move |reason, message| {
            let mut faults = shared.lock().unwrap_or_else(PoisonError::into_inner);
            faults.lost.get_or_insert(format!("{reason:?}: {message}"));
        });
        *self.device.lock().unwrap_or_else(PoisonError::into_inner) = Some(state.device.clone());
        let shared = Arc::clone(&self.shared);
        state.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let mut faults = shared.lock().unwrap_or_else(PoisonError::into_inner);
            if !faults.was_told {
                faults.error.get_or_insert(error.to_string());
            }
        }));
    }

    /// The reason why the device is lost, if it is.
    #[must_use]
    pub fn lost(&self) -> Option<String> {
        let device = self.device.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some(device) = device {
            // The device only reports its loss when it is polled.
            let _ = device.poll(wgpu::PollType::Poll);
        }
        self.shared.lock().unwrap_or_else(PoisonError::into_inner).lost.clone()
    }

    /// Records which document is open: a file, or the name of a preset.
    pub fn set_document(&self, document: Option<PathBuf>) {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner).document = document;
    }

    /// The document that was open when the device was lost.
    #[must_use]
    pub fn document(&self) -> Option<PathBuf> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner).document.clone()
    }

    /// The first error of the device. Later calls return `None`, because an error occurs in every frame.
    #[must_use]
    pub fn error(&self) -> Option<String> {
        let mut faults = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        let error = faults.error.take();
        faults.was_told |= error.is_some();
        error
    }
}

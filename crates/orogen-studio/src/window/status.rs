//! The line at the bottom of the window.

use eframe::egui::{self, Ui};

use crate::catalogue::Language;
use crate::platform::Gpu;
use crate::preview::frame::Quality;
use crate::studio::Studio;

/// Results of solvers below this size are not mentioned, in bytes.
const KEPT: u64 = 1 << 20;

/// Shows the progress of the picture, the time that it took, and which graphics card computes previews, if any.
pub fn show(ui: &mut Ui, studio: &Studio, gpu: Option<&Gpu>, language: Language) {
    ui.horizontal(|ui| {
        if studio.is_busy() {
            ui.add(egui::ProgressBar::new(studio.share()).desired_width(120.0).desired_height(8.0));
        }
        if let Some(failure) = &studio.failure {
            ui.colored_label(ui.visuals().error_fg_color, language.message(&failure.to_string()));
            return;
        }
        if !studio.document.is_valid() {
            ui.colored_label(ui.visuals().error_fg_color, language.text("status.invalid"));
            return;
        }
        if let Some(frame) = &studio.frame {
            let samples = frame.window().width.max(frame.window().height).to_string();
            let seconds = format!("{:.2}", frame.seconds);
            ui.weak(language.fill("status.made", &[("samples", &samples), ("seconds", &seconds)]));
            if frame.quality == Quality::Draft {
                ui.weak(language.text("analysis.draft"));
            }
        }
        let kept = studio.session().kept_memory();
        if kept > KEPT {
            let bytes = orogen::grid::words::bytes(kept);
            ui.weak(language.fill("status.kept", &[("bytes", &bytes)]))
                .on_hover_text(language.text("status.kept_help"));
        }
        if let Some(gpu) = gpu {
            match gpu.failure() {
                None => ui.weak(language.fill("status.device", &[("name", &gpu.adapter().name)])),
                Some(failure) => {
                    let why = language.fill("status.processor", &[("why", &language.message(&failure.to_string()))]);
                    ui.colored_label(ui.visuals().warn_fg_color, why)
                }
            };
        }
    });
}

//! The legend in a corner of a view.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, Vec2, pos2, vec2};

use orogen::grid::words::number;

use crate::catalogue::Language;
use crate::preview::frame::Frame;
use crate::preview::legend::Legend;

/// The largest and smallest height of a ramp, and the height of a line of text.
const RAMP: [f32; 2] = [150.0, 60.0];
const LINE: f32 = 16.0;

/// The space below a legend, for the value at the pointer.
const BELOW: f32 = 36.0;

/// Draws the legend of a picture with its upper left corner at `at`. In a low view it is smaller, and without room it
/// is left out.
pub fn draw(painter: &Painter, at: Pos2, frame: &Frame, language: Language) {
    match &frame.legend {
        Legend::Ramp { colors, .. } => ramp(painter, at, frame, colors, language),
        Legend::Entries(entries) => {
            let font = FontId::proportional(11.0);
            let lines: Vec<_> = entries
                .iter()
                .map(|entry| {
                    let text = format!("{}  {:.0} %", entry.name, entry.share * 100.0);
                    (painter.layout_no_wrap(text, font.clone(), Color32::WHITE), entry.color)
                })
                .collect();
            let width = lines.iter().map(|(galley, _)| galley.size().x).fold(0.0, f32::max);
            if lines.is_empty() {
                return;
            }
            let size = vec2(width + 34.0, LINE * lines.len() as f32 + 10.0);
            painter.rect_filled(Rect::from_min_size(at, size), 4.0, Color32::from_black_alpha(150));
            for (k, (galley, [red, green, blue])) in lines.into_iter().enumerate() {
                let top = at.y + 5.0 + LINE * k as f32;
                let swatch = Rect::from_min_size(pos2(at.x + 6.0, top + 2.0), Vec2::splat(LINE - 4.0));
                painter.rect_filled(swatch, 2.0, Color32::from_rgb(red, green, blue));
                painter.galley(pos2(at.x + 26.0, top + 1.0), galley, Color32::WHITE);
            }
        }
    }
}

fn ramp(painter: &Painter, at: Pos2, frame: &Frame, colors: &[[u8; 3]], language: Language) {
    let ticks = frame.legend.ticks();
    if ticks.is_empty() || colors.is_empty() {
        return;
    }
    let font = FontId::proportional(11.0);
    let labels: Vec<_> = ticks
        .iter()
        .filter_map(|value| {
            let galley = painter.layout_no_wrap(number(f64::from(*value)), font.clone(), Color32::WHITE);
            Some((frame.legend.place(*value)?, galley))
        })
        .collect();
    let unit = painter.layout_no_wrap(language.named(frame.unit).to_owned(), font, Color32::WHITE);
    let width = labels.iter().map(|(_, galley)| galley.size().x).fold(unit.size().x, f32::max);
    let head = if frame.unit.is_empty() { 8.0 } else { LINE + 6.0 };
    let room = painter.clip_rect().bottom() - BELOW - at.y - head - 10.0;
    if room < RAMP[1] {
        return;
    }
    let height = room.min(RAMP[0]);
    // Labels that would overlap are left out.
    let apart = labels.windows(2).map(|pair| (pair[1].0 - pair[0].0).abs() * height).fold(f32::INFINITY, f32::min);
    let every = (LINE / apart.max(0.1)).ceil().max(1.0) as usize;
    let size = vec2(width + 36.0, height + head + 10.0);
    painter.rect_filled(Rect::from_min_size(at, size), 4.0, Color32::from_black_alpha(150));
    painter.galley(at + vec2(7.0, 4.0), unit, Color32::WHITE);
    let bar = Rect::from_min_size(at + vec2(8.0, head), vec2(12.0, height));
    let step = height / colors.len() as f32;
    for (k, [red, green, blue]) in colors.iter().enumerate() {
        let bottom = bar.bottom() - step * k as f32;
        let part = Rect::from_min_max(pos2(bar.left(), bottom - step - 0.5), pos2(bar.right(), bottom));
        painter.rect_filled(part.intersect(bar), 0.0, Color32::from_rgb(*red, *green, *blue));
    }
    for (place, galley) in labels.into_iter().step_by(every) {
        let y = bar.bottom() - height * place;
        painter.line_segment([pos2(bar.right(), y), pos2(bar.right() + 4.0, y)], Stroke::new(1.0, Color32::WHITE));
        let corner = Align2::LEFT_CENTER.anchor_size(pos2(bar.right() + 7.0, y), galley.size()).min;
        painter.galley(corner, galley, Color32::WHITE);
    }
}

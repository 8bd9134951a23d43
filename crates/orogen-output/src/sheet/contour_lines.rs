//! Contours on a map, grouped by their inks, with labels in gaps of their lines.

use super::font_set::FontSet;
use super::furniture::Desk;
use super::geometry::{Point, Rect};
use super::inks::{Inks, THIN};
use super::labels::{Label, LabelStyle, gaps, place};
use super::linework::{Linework, height};
use super::options::{Labels, SheetOptions};
use super::scene::Scene;
use super::taken::{Passing, Taken};
use crate::map::text::Face;
use orogen_grid::contour::line::Line;
use orogen_io::palette::color::Rgb;

/// Style of the labels of index contours, and of contours whose heights were given.
const LABEL: LabelStyle =
    LabelStyle { size: 2.1, spacing: 1.0, reach: 0.62, turn: 0.5, straight: 0.9, apart: 7.0, every: 95.0 };

/// Style of the labels of other contours.
const SMALL: LabelStyle =
    LabelStyle { size: 1.75, spacing: 1.0, reach: 0.62, turn: 0.5, straight: 0.9, apart: APART, every: 110.0 };

/// Minimum distance between two labels if all contours have labels, in millimetres.
const APART: f32 = 3.0;

/// Lines of one ink, width and opacity.
struct Kind {
    ink: Rgb,
    width: f32,
    cover: f32,
    lines: Vec<Vec<Point>>,
}

/// Contours with their labels.
pub struct ContourLines {
    kinds: Vec<Kind>,
    labels: Vec<(Inks, Label)>,
}

impl ContourLines {
    /// Finds positions for the labels of contours, and marks them as occupied. `ink` chooses the inks of a line.
    pub fn new(
        linework: &Linework,
        contours: Vec<(&Line, Vec<Point>)>,
        options: &SheetOptions,
        letters: &FontSet,
        map: Rect,
        taken: &mut Taken,
        ink: impl Fn(&Line, &[Point]) -> Inks,
    ) -> ContourLines {
        let inks: Vec<Inks> = contours.iter().map(|(line, places)| ink(line, places)).collect();
        let labels = match options.parts.labels {
            true => labels(linework, &contours, &inks, options, letters, map, taken),
            false => Vec::new(),
        };
        // Grouped in the order of first use, index contours last.
        let mut kinds: Vec<Kind> = Vec::new();
        let (thick, thin): (Vec<_>, Vec<_>) =
            contours.into_iter().zip(inks).partition(|((line, _), _)| linework.is_index(line));
        for ((line, places), inks) in thin.into_iter().chain(thick) {
            let width = linework.contour_width(line);
            let cover = if width > THIN { inks.cover + 0.18 } else { inks.cover };
            match kinds.iter_mut().find(|kind| (kind.ink, kind.width) == (inks.line, width)) {
                Some(kind) => kind.lines.push(places),
                None => kinds.push(Kind { ink: inks.line, width, cover, lines: vec![places] }),
            }
        }
        ContourLines { kinds, labels }
    }

    /// Draws the lines, with gaps for their labels.
    pub fn draw_lines(&self, scene: &mut Scene) {
        let labels: Vec<&Label> = self.labels.iter().map(|(_, label)| label).collect();
        for kind in &self.kinds {
            scene.lines(gaps(&kind.lines, &labels, 0.25), kind.width, kind.ink, kind.cover);
        }
    }

    /// Draws the labels.
    pub fn draw_labels(&self, desk: &mut Desk) {
        for (inks, label) in &self.labels {
            desk.along(label, Face::Bold, inks.words);
        }
    }
}

/// The labels of contours with their inks: index contours first, and long lines before short ones.
fn labels(
    linework: &Linework,
    contours: &[(&Line, Vec<Point>)],
    inks: &[Inks],
    options: &SheetOptions,
    letters: &FontSet,
    map: Rect,
    taken: &mut Taken,
) -> Vec<(Inks, Label)> {
    let of_all = options.labels == Some(Labels::All) || (options.labels.is_none() && linework.interval.is_none());
    let is_index = |nth: &usize| linework.is_index(contours[*nth].0);
    let mut order: Vec<usize> = (0..contours.len()).filter(|nth| of_all || is_index(nth)).collect();
    order.sort_by(|a, b| {
        let length = |nth: &usize| contours[*nth].0.length();
        is_index(b).cmp(&is_index(a)).then(length(b).total_cmp(&length(a)))
    });
    let style = |nth: usize| match (of_all, linework.contour_width(contours[nth].0) > THIN) {
        (false, _) => LABEL,
        (true, true) => LabelStyle { apart: APART, ..LABEL },
        (true, false) => SMALL,
    };
    let mut labels = Vec::new();
    let mut placed = |nth: usize, is_clear: &dyn Fn(Point, f32) -> bool| {
        let (line, places) = &contours[nth];
        let (text, style) = (height(line.elevation), style(nth));
        let width = letters.width(&text, Face::Bold, style.size);
        let found = place(places, &text, width, style, taken, is_clear);
        let is_placed = !found.is_empty();
        labels.extend(found.into_iter().map(|label| (inks[nth], label)));
        is_placed
    };
    // On steep ground, labels of all contours would hide the lines around them, so positions without another line
    // nearby are tried first.
    if of_all {
        let passing = Passing::of(map, contours.iter().map(|(_, places)| places.as_slice()));
        order.retain(|nth| !placed(*nth, &|place, reach| passing.is_alone(*nth, place, reach)));
    }
    for nth in order {
        placed(nth, &|_, _| true);
    }
    labels
}

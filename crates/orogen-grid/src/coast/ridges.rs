//! Ridges of sand in the water: the bodies of spits, bars and tombolos.

use super::Coast;
use super::beach::{BODY, FOREFOOT, surface};
use super::march::neighbors;
use super::nodes::cell_of;
use super::retreat::Shore;
use crate::grid::Window;

/// Length of the flanks under water in half widths, towards the sea and towards the lee.
const FLANKS: [f64; 2] = [2.2, 1.0];
/// Ridges are built in water as deep as this at most, in metres.
pub(super) const DEEPEST: f64 = 12.0;
/// Waves of this exposure made the berm of a ridge at least.
const CALM: f64 = 0.15;
/// Least half width of a ridge, in cells, so that its samples are joined.
const JOINED: f64 = 0.75;

/// A part of a ridge: a disc with flanks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    /// Cells east and south of the first sample.
    pub(super) at: [f64; 2],
    /// Unit vector towards the lee, or zero if both sides are alike.
    pub(super) lee: [f64; 2],
    /// Half of the width above the water, in metres.
    pub(super) half: f64,
}

/// Ridges on the worn ground.
pub(super) struct Ridges<'a> {
    law: &'a Coast,
    pub(super) window: &'a Window,
    shore: &'a Shore,
    worn: &'a [f32],
    scale: f64,
    /// Thickness of the sand, in metres.
    pub(super) thickness: Vec<f32>,
    /// Cells that have changed since the ridges were last kept, with the thickness before.
    changed: Vec<(usize, f32)>,
    /// Volume since the ridges were last kept, in m^3.
    volume: f64,
}

impl<'a> Ridges<'a> {
    pub(super) fn new(law: &'a Coast, window: &'a Window, shore: &'a Shore, worn: &'a [f32]) -> Ridges<'a> {
        let scale = super::beach::dean(law.grain_size);
        let thickness = vec![0.0; worn.len()];
        Ridges { law, window, shore, worn, scale, thickness, changed: Vec::new(), volume: 0.0 }
    }

    /// Half width of the narrowest ridge, in metres.
    pub(super) fn narrowest(&self) -> f64 {
        (1.2 * JOINED * self.window.cell).max(20.0)
    }

    /// Whether a cell is land or a ridge above the water.
    pub(super) fn is_land(&self, cell: usize) -> bool {
        !self.shore.is_sea(cell) || (self.thickness[cell] > 0.0 && self.worn[cell] + self.thickness[cell] > 0.0)
    }

    /// Whether a cell is rock or soil above the water.
    pub(super) fn is_firm(&self, cell: usize) -> bool {
        !self.shore.is_sea(cell)
    }

    /// How far waves move sand at a position, as a part of the reach: less in sheltered water.
    pub(super) fn strength(&self, at: [f64; 2]) -> f64 {
        let exposed = super::retreat::mean_around(
            self.window,
            |cell| self.shore.is_sea(cell),
            &self.shore.exposure,
            cell_of(self.window, at),
        );
        f64::from(exposed).clamp(0.0, 1.0).sqrt()
    }

    /// Depth of the water over the bed at a position, in metres; 0 on land.
    pub(super) fn depth(&self, at: [f64; 2]) -> f64 {
        let cell = cell_of(self.window, at);
        if self.shore.is_sea(cell) { f64::from(-self.worn[cell]).max(0.0) } else { 0.0 }
    }

    /// Adds a part of a ridge. Sand is as high as the highest of all parts.
    pub(super) fn add(&mut self, part: Part) {
        let cell_size = self.window.cell;
        let half = part.half.max(JOINED * cell_size);
        let far = half * (1.0 + FLANKS[0]) + DEEPEST / FOREFOOT;
        let radius = far / cell_size;
        let exposure = f64::from(self.shore.exposure[cell_of(self.window, part.at)]).max(CALM);
        let [x, y] = part.at;
        let range = |at: f64, side: usize| {
            ((at - radius).ceil().max(0.0) as usize, ((at + radius).floor().max(-1.0) + 1.0).min(side as f64) as usize)
        };
        let ((west, east), (north, south)) = (range(x, self.window.width), range(y, self.window.height));
        for row in north..south {
            for column in west..east {
                let cell = row * self.window.width + column;
                let (dx, dy) = (column as f64 - x, row as f64 - y);
                let distance = (dx * dx + dy * dy).sqrt();
                if distance > radius || !self.shore.is_sea(cell) {
                    continue;
                }
                // 1 towards the lee, -1 towards the sea, 0 ahead or if both sides are alike.
                let side = (dx * part.lee[0] + dy * part.lee[1]) / distance.max(1e-9);
                let flank = 0.5 * (FLANKS[0] + FLANKS[1] - side * (FLANKS[0] - FLANKS[1]));
                let height = surface(self.law, self.scale, distance * cell_size - half, flank * half / BODY, exposure);
                let thick = (height - f64::from(self.worn[cell])) as f32;
                // At the border of the domain water leaves at any height, and sand would dam it.
                if thick > self.thickness[cell] && !neighbors(self.window, cell).contains(&None) {
                    self.changed.push((cell, self.thickness[cell]));
                    self.volume += f64::from(thick - self.thickness[cell]) * cell_size * cell_size;
                    self.thickness[cell] = thick;
                }
            }
        }
    }

    /// Volume since the ridges were last kept, in m^3.
    pub(super) fn volume(&self) -> f64 {
        self.volume
    }

    /// Takes away what has been added since the ridges were last kept.
    pub(super) fn undo(&mut self) {
        while let Some((cell, before)) = self.changed.pop() {
            self.thickness[cell] = before;
        }
        self.volume = 0.0;
    }

    /// Keeps what has been added; returns its volume.
    pub(super) fn keep(&mut self) -> f64 {
        self.changed.clear();
        std::mem::take(&mut self.volume)
    }
}

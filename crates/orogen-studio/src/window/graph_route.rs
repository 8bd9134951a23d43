//! Wires of the graph on the screen, and the state of their points.

use eframe::egui::Pos2;

use super::wire_curve::{self, Piece};
use crate::editing::reroutes::Reroute;
use crate::studio::Studio;
use crate::view::scene::Wire;

/// The distance from a wire within which a click chooses it, in points.
const NEAR: f32 = 7.0;

/// A wire on the screen.
pub(super) struct Route {
    pub(super) wire: Wire,
    /// The wire and its points, as the recipe keeps them.
    pub(super) reroute: Reroute,
    pub(super) ends: [Pos2; 2],
    /// The positions of its points.
    pub(super) points: Vec<Pos2>,
    pub(super) pieces: Vec<Piece>,
}

/// The wire at a position.
pub(super) fn near(routes: &[Route], at: Pos2) -> Option<&Route> {
    let distances = routes.iter().filter_map(|route| Some((wire_curve::nearest(&route.pieces, at)?.2, route)));
    let near = distances.filter(|(distance, _)| *distance < NEAR).min_by(|a, b| a.0.total_cmp(&b.0));
    near.map(|(_, route)| route)
}

/// State of the reroutes.
#[derive(Default)]
pub(super) struct Reroutes {
    /// The selected point: its wire and its number.
    pub(super) selected: Option<(Reroute, usize)>,
    /// The point that is being moved.
    pub(super) moved: Option<Moved>,
    /// The wire whose menu is open, and where it was clicked.
    pub(super) menu: Option<(Reroute, Pos2)>,
}

/// A point that is being moved. Its position is in the recipe when the gesture ends.
pub(super) struct Moved {
    /// The wire with its present points.
    pub(super) reroute: Reroute,
    /// The number of the point.
    pub(super) point: usize,
    /// Its position in the graph.
    pub(super) at: Pos2,
}

impl Reroutes {
    /// The present points of a wire.
    pub(super) fn fill(&self, wire: &mut Reroute, studio: &Studio) {
        let moved = self.moved.as_ref().map(|moved| &moved.reroute);
        let mut all = moved.into_iter().chain(&studio.document.kept().reroutes);
        if let Some(known) = all.find(|known| known.is_same_wire(wire)) {
            wire.points.clone_from(&known.points);
        }
    }

    /// Selects no point.
    pub(super) fn deselect(&mut self) {
        self.selected = None;
    }

    pub(super) fn is_selected(&self, route: &Route, point: usize) -> bool {
        self.selected.as_ref().is_some_and(|(wire, k)| *k == point && wire.is_same_wire(&route.reroute))
    }
}

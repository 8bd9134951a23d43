//! Where a view shows positions of the world.

use eframe::egui::{Pos2, Rect};

/// A function from a position in a view to one in the world, in metres.
type World<'a> = dyn Fn(Pos2) -> Option<[f64; 2]> + 'a;

/// A function from a position in the world to one in a view.
type Screen<'a> = dyn Fn([f64; 2]) -> Option<Pos2> + 'a;

/// Where a view shows positions of the world.
pub struct Projection<'a> {
    /// The view.
    pub rect: Rect,
    world: Box<World<'a>>,
    screen: Box<Screen<'a>>,
}

impl<'a> Projection<'a> {
    /// The projection of a view by its functions. `world` is `None` where the view shows no land, and `screen` where a
    /// position is behind the camera.
    pub fn new(
        rect: Rect,
        world: impl Fn(Pos2) -> Option<[f64; 2]> + 'a,
        screen: impl Fn([f64; 2]) -> Option<Pos2> + 'a,
    ) -> Projection<'a> {
        Projection { rect, world: Box::new(world), screen: Box::new(screen) }
    }

    /// The position in the world, in metres, that is shown at a position in the view.
    #[must_use]
    pub fn world(&self, at: Pos2) -> Option<[f64; 2]> {
        (self.world)(at)
    }

    /// The position in the view of a position in the world, in metres.
    #[must_use]
    pub fn screen(&self, at: [f64; 2]) -> Option<Pos2> {
        (self.screen)(at)
    }

    /// A line of the world as the parts that are in the view.
    #[must_use]
    pub fn line(&self, points: &[[f64; 2]]) -> Vec<Vec<Pos2>> {
        let mut parts = vec![Vec::new()];
        for point in points {
            match (self.screen(*point), parts.last_mut()) {
                (Some(at), Some(part)) => part.push(at),
                _ => parts.push(Vec::new()),
            }
        }
        parts.retain(|part| part.len() > 1);
        parts
    }
}

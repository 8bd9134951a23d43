//! Symbols on the map.

use super::font_set::FontSet;
use super::geometry::Point;
use super::labels::Taken;
use super::scene::{INK, Scene, Step, polygon};
use crate::map::text::Face;

/// Size of a summit's label, the em in millimetres.
const SIZE: f32 = 2.5;

/// A small triangle around a point.
pub fn triangle(Point { x, y }: Point) -> Vec<Step> {
    polygon([[x, y - 0.95], [x + 0.85, y + 0.6], [x - 0.85, y + 0.6]])
}

/// Draws a summit and its height, if there is room: to the right, otherwise to the left. Marks the room as occupied.
pub fn summit(scene: &mut Scene, letters: &FontSet, taken: &mut Taken, at: Point, text: &str) {
    let width = letters.width(text, Face::Bold, SIZE);
    let starts = [at.x + 1.5, at.x - 1.5 - width];
    let middle = |start: f32, share: f32| Point::new(start + width * share, at.y);
    let shares = || (0..=6).map(|k| k as f32 / 6.0);
    let free = |start: &f32| shares().all(|share| taken.is_free(middle(*start, share), SIZE * 0.5));
    let Some(start) = starts.iter().copied().find(free).filter(|_| taken.is_free(at, 0.8)) else { return };
    let outline = letters.write(text, Face::Bold, SIZE, Point::new(start, at.y + SIZE * 0.35), 0.0);
    let mark = triangle(at);
    // A bright edge for visibility on dark ground.
    let edge: Vec<Vec<Point>> = rings(&outline).into_iter().chain(rings(&mark)).collect();
    scene.lines(edge, 0.75, [255; 3], 0.55);
    scene.area(mark, INK, 1.0);
    scene.area(outline, INK, 1.0);
    taken.take(at, 1.3);
    shares().for_each(|share| taken.take(middle(start, share), SIZE * 0.75));
}

/// The parts of an outline as closed lines; curves are replaced by their ends, which suffices at this size.
fn rings(outline: &[Step]) -> Vec<Vec<Point>> {
    let mut rings: Vec<Vec<Point>> = Vec::new();
    for step in outline {
        match (*step, rings.last_mut()) {
            (Step::Move(place), _) | (Step::Line(place) | Step::Curve(_, _, place), None) => rings.push(vec![place]),
            (Step::Line(place) | Step::Curve(_, _, place), Some(ring)) => ring.push(place),
        }
    }
    for ring in &mut rings {
        ring.extend(ring.first().copied());
    }
    rings
}

#[cfg(test)]
mod tests {
    use super::super::geometry::{Rect, Size};
    use super::*;

    #[test]
    fn summits_find_room_or_are_left_out() {
        let letters = FontSet::for_texts([]).unwrap();
        let mut scene = Scene { size: Size::new(50.0, 50.0), title: String::new(), items: Vec::new() };
        let mut taken = Taken::none(Rect::new(0.0, 0.0, 50.0, 50.0));
        summit(&mut scene, &letters, &mut taken, Point::new(25.0, 25.0), "2345");
        assert_eq!(scene.items.len(), 3);
        // A second mark next to it has no room; a mark at the right edge is labelled on its left.
        summit(&mut scene, &letters, &mut taken, Point::new(26.0, 25.5), "2344");
        assert_eq!(scene.items.len(), 3);
        summit(&mut scene, &letters, &mut taken, Point::new(47.0, 10.0), "1999");
        assert_eq!(scene.items.len(), 6);
        assert!(!taken.is_free(Point::new(43.0, 10.0), 0.3));
    }
}

//! Symbols on the map.

use super::furniture::Desk;
use super::geometry::Point;
use super::scene::Step;
use super::symbols::{DOT, dot, triangle};
use super::taken::Taken;
use crate::map::text::Face;
use orogen_io::palette::color::Rgb;

/// Size of a summit's label, the em in millimetres.
const SIZE: f32 = 2.5;

/// Size of a place's name.
const NAME: f32 = 3.1;

/// Draws a summit and its height, if there is room: to the right, otherwise to the left. Marks the room as occupied.
pub fn summit(desk: &mut Desk, taken: &mut Taken, at: Point, text: &str) {
    let width = desk.letters.width(text, Face::Bold, SIZE);
    let starts = [at.x + 1.5, at.x - 1.5 - width];
    let middle = |start: f32, share: f32| Point::new(start + width * share, at.y);
    let shares = || (0..=6).map(|k| k as f32 / 6.0);
    let free = |start: &f32| shares().all(|share| taken.is_free(middle(*start, share), SIZE * 0.5));
    let Some(start) = starts.iter().copied().find(free).filter(|_| taken.is_free(at, 0.8)) else { return };
    let outline = desk.letters.write(text, Face::Bold, SIZE, Point::new(start, at.y + SIZE * 0.35), 0.0);
    let mark = triangle(at);
    // A bright edge for visibility on dark ground.
    let edge: Vec<Vec<Point>> = rings(&outline).into_iter().chain(rings(&mark)).collect();
    desk.scene.lines(edge, 0.75, desk.colors.page, 0.55);
    desk.scene.area(mark, desk.colors.ink, 1.0);
    desk.scene.area(outline, desk.colors.ink, 1.0);
    taken.take(at, 1.3);
    shares().for_each(|share| taken.take(middle(start, share), SIZE * 0.75));
}

/// Draws a place and its name, if there is room: to the right, otherwise to the left, above or below. Marks the room as
/// occupied. Returns whether there was room.
pub fn place_name(desk: &mut Desk, taken: &mut Taken, at: Point, text: &str) -> bool {
    let width = desk.letters.width(text, Face::Bold, NAME);
    let beside = DOT + 0.8;
    let above = beside + NAME * 0.5;
    let slant = [beside * 0.7, above * 0.8];
    let starts = [
        [beside, 0.0],
        [-beside - width, 0.0],
        [slant[0], -slant[1]],
        [slant[0], slant[1]],
        [-slant[0] - width, -slant[1]],
        [-slant[0] - width, slant[1]],
        [-width / 2.0, -above],
        [-width / 2.0, above],
    ];
    let parts = (width / (NAME * 0.5)).ceil().max(1.0);
    let middles =
        |start: [f32; 2]| (0..=parts as i32).map(move |k| at.moved(start[0] + width * k as f32 / parts, start[1]));
    let free = |start: &[f32; 2]| middles(*start).all(|middle| taken.is_free(middle, NAME * 0.45));
    let Some(start) = starts.into_iter().find(free) else { return false };
    let outline = desk.letters.write(text, Face::Bold, NAME, at.moved(start[0], start[1] + NAME * 0.35), 0.0);
    let mark = dot(at);
    let edge: Vec<Vec<Point>> = rings(&outline).into_iter().chain(rings(&mark)).collect();
    desk.scene.lines(edge, 0.8, desk.colors.page, 0.7);
    desk.scene.area(mark, desk.colors.ink, 1.0);
    desk.scene.area(outline, desk.colors.ink, 1.0);
    taken.take(at, 1.0);
    middles(start).for_each(|middle| taken.take(middle, NAME * 0.6));
    true
}

/// Draws a summit with its name, and its height below it, if there is room. Marks the room as occupied. Returns whether
/// there was room.
pub fn named_summit(desk: &mut Desk, taken: &mut Taken, at: Point, name: &str, height: Option<&str>) -> bool {
    let lines: Vec<(&str, Face, f32)> =
        std::iter::once((name, Face::Bold, NAME)).chain(height.map(|height| (height, Face::Regular, SIZE))).collect();
    let widths: Vec<f32> = lines.iter().map(|(text, face, size)| desk.letters.width(text, *face, *size)).collect();
    let rise = if lines.len() > 1 { NAME * 0.49 } else { 0.0 };
    // The middle of the first line from the summit; 0 if lines start there, 1 if they end there.
    let beside = [([1.7, -rise], 0.0), ([-1.7, -rise], 1.0), ([0.0, -3.0 - 2.0 * rise], 0.5), ([0.0, 2.8], 0.5)];
    let start = |[x, y]: [f32; 2], share: f32, k: usize| at.moved(x - share * widths[k], y + 2.0 * rise * k as f32);
    let middles = |offset: [f32; 2], share: f32| {
        let line = |k: usize| {
            let (first, wide) = (start(offset, share, k), widths[k]);
            let parts = (wide / (SIZE * 0.5)).ceil().max(1.0);
            (0..=parts as i32).map(move |n| first.moved(wide * n as f32 / parts, 0.0))
        };
        (0..lines.len()).flat_map(line).collect::<Vec<Point>>()
    };
    let is_free = |(offset, share): &([f32; 2], f32)| {
        middles(*offset, *share).iter().all(|middle| taken.is_free(*middle, NAME * 0.42))
    };
    let Some((offset, share)) = beside.into_iter().find(is_free).filter(|_| taken.is_free(at, 0.8)) else {
        return false;
    };
    let mark = triangle(at);
    let mut outlines = vec![mark];
    for (k, (text, face, size)) in lines.iter().enumerate() {
        let foot = start(offset, share, k).moved(0.0, size * 0.35);
        outlines.push(desk.letters.write(text, *face, *size, foot, 0.0));
    }
    let edge: Vec<Vec<Point>> = outlines.iter().flat_map(|outline| rings(outline)).collect();
    desk.scene.lines(edge, 0.8, desk.colors.page, 0.7);
    outlines.into_iter().for_each(|outline| desk.scene.area(outline, desk.colors.ink, 1.0));
    taken.take(at, 1.3);
    middles(offset, share).into_iter().for_each(|middle| taken.take(middle, NAME * 0.6));
    true
}

/// Draws the name of a lake or a sea around a point, or a little above or below it, if there is room, and marks the
/// room as occupied. Returns whether there was room.
pub fn water_name(desk: &mut Desk, taken: &mut Taken, at: Point, text: &str) -> bool {
    let width = desk.letters.width(text, Face::Italic, NAME);
    let parts = (width / (NAME * 0.5)).ceil().max(1.0);
    let middles = |down: f32| {
        (0..=parts as i32).map(move |k| at.moved(width * (k as f32 / parts - 0.5), down)).collect::<Vec<Point>>()
    };
    let is_free = |down: &f32| middles(*down).iter().all(|middle| taken.is_free(*middle, NAME * 0.45));
    let Some(down) = [0.0, -NAME, NAME].into_iter().find(is_free) else { return false };
    let foot = at.moved(-width / 2.0, down + NAME * 0.3);
    let outline = desk.letters.write(text, Face::Italic, NAME, foot, 0.0);
    edged_text(desk, outline, desk.colors.rivers());
    middles(down).into_iter().for_each(|middle| taken.take(middle, NAME * 0.6));
    true
}

/// Draws text with an edge for visibility on any ground.
pub fn edged_text(desk: &mut Desk, outline: Vec<Step>, ink: Rgb) {
    desk.scene.lines(rings(&outline), 0.7, desk.colors.page, 0.65);
    desk.scene.area(outline, ink, 1.0);
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
    use super::super::font_set::FontSet;
    use super::super::geometry::{Rect, Size};
    use super::super::options::PageColors;
    use super::super::scene::Scene;
    use super::*;

    #[test]
    fn summits_find_room_or_are_left_out() {
        let letters = FontSet::for_texts([]).unwrap();
        let scene = Scene::new(Size::new(50.0, 50.0), String::new());
        let mut desk = Desk { scene, letters: &letters, colors: PageColors::default() };
        let mut taken = Taken::none(Rect::new(0.0, 0.0, 50.0, 50.0));
        summit(&mut desk, &mut taken, Point::new(25.0, 25.0), "2345");
        assert_eq!(desk.scene.items.len(), 3);
        // A second mark next to it has no room; a mark at the right edge is labeled on its left.
        summit(&mut desk, &mut taken, Point::new(26.0, 25.5), "2344");
        assert_eq!(desk.scene.items.len(), 3);
        summit(&mut desk, &mut taken, Point::new(47.0, 10.0), "1999");
        assert_eq!(desk.scene.items.len(), 6);
        assert!(!taken.is_free(Point::new(43.0, 10.0), 0.3));
    }

    #[test]
    fn names_stand_on_a_free_side_of_their_place() {
        let letters = FontSet::for_texts(["Port Varn"]).unwrap();
        let scene = Scene::new(Size::new(60.0, 60.0), String::new());
        let mut desk = Desk { scene, letters: &letters, colors: PageColors::default() };
        let mut taken = Taken::none(Rect::new(0.0, 0.0, 60.0, 60.0));
        let name = |desk: &mut Desk, taken: &mut Taken, x: f32, y: f32| {
            let has_room = place_name(desk, taken, Point::new(x, y), "Port Varn");
            (has_room, desk.scene.items.len())
        };
        // To the right; at the right edge to the left; next to the first one above or below it.
        assert_eq!(name(&mut desk, &mut taken, 20.0, 30.0), (true, 3));
        assert_eq!(name(&mut desk, &mut taken, 58.0, 10.0), (true, 6));
        assert_eq!(name(&mut desk, &mut taken, 20.5, 30.5), (true, 9));
        assert!(!taken.is_free(Point::new(26.0, 30.0), 0.3) && !taken.is_free(Point::new(52.0, 10.0), 0.3));
        // Around a place with many neighbors there is no room.
        let more: Vec<bool> = (0..12).map(|k| name(&mut desk, &mut taken, 20.0 + 0.1 * k as f32, 30.0).0).collect();
        assert!(more.contains(&false), "{more:?}");
    }
}

use super::*;
use crate::editing::document::Document;

const TEXT: &str = r#"orogen = 1

[world]
size = [4000, 4000]
cell = 10

# The hills.
[nodes.hills]
op = "fbm"

[nodes.land]
op = "multiply"
a = "hills"
b = 300

[outputs]
height = "land" # metres
"#;

fn document(text: &str) -> Document {
    Document::new("test", text.into()).unwrap()
}

fn brush(effect: Effect) -> Brush {
    Brush { effect, radius: 200.0, hardness: 0.3, strength: 1.0, height: 25.0 }
}

/// Paints a stroke along a line, as the pointer does.
fn paint(document: &mut Document, brush: Brush, selected: Option<&str>, line: &[[f64; 2]]) -> String {
    let mut painting = Painting::begin(brush, document.recipe(), selected, "height", line[0]).unwrap();
    document.apply(&painting.edit()).unwrap();
    for at in &line[1..] {
        if painting.continue_to(*at) {
            document.apply(&painting.edit()).unwrap();
        }
    }
    document.end_gesture();
    painting.node
}

fn straight(from: [f64; 2], to: [f64; 2]) -> Vec<[f64; 2]> {
    (0..=20).map(|k| f64::from(k) / 20.0).map(|t| [0, 1].map(|k| from[k] + (to[k] - from[k]) * t)).collect()
}

#[test]
fn land_is_raised_and_lowered_in_a_node_of_its_own_and_each_stroke_is_one_step() {
    let mut document = document(TEXT);
    let line = straight([500.123, 700.456], [1500.777, 900.999]);
    assert_eq!(paint(&mut document, brush(Effect::Raise), Some("hills"), &line), "paint");
    let node = "[nodes.paint]\nop = \"paint\"\nbackground = \"land\"\nstrokes = [\n  { points = [[500, 700], [1501, 901]], radius = 200, hardness = 0.3, value = 25 },\n]\n";
    let raised = TEXT.replace("[outputs]\nheight = \"land\"", &format!("{node}\n[outputs]\nheight = \"paint\""));
    assert_eq!(document.text(), raised);
    // The next stroke goes there too, whatever is selected.
    paint(&mut document, brush(Effect::Lower), Some("hills"), &line[..1]);
    let lowered = raised.replace(
        "value = 25 },\n]",
        "value = 25 },\n  { points = [[500, 700]], radius = 200, hardness = 0.3, value = -25 },\n]",
    );
    assert_eq!(document.text(), lowered);
    assert!(document.undo());
    assert_eq!(document.text(), raised);
    assert!(document.undo());
    assert_eq!(document.text(), TEXT);
    assert!(document.redo() && document.text() == raised);
}

#[test]
fn a_mask_is_painted_and_erased_alone_or_as_the_mask_of_a_node() {
    let mut document = document(TEXT);
    let dab = [[1000.0, 2000.0]];
    assert!(Painting::begin(brush(Effect::Erase), document.recipe(), None, "height", dab[0]).is_none());
    assert_eq!(paint(&mut document, Brush { strength: 0.5, ..brush(Effect::Paint) }, None, &dab), "paint");
    let stroke = "{ points = [[1000, 2000]], radius = 200, hardness = 0.3, mode = \"set\", strength = 0.5 }";
    let node = format!("[nodes.paint]\nop = \"paint\"\nstrokes = [\n  {stroke},\n]\n\n");
    assert_eq!(document.text(), TEXT.replace("[outputs]", &format!("{node}[outputs]")));
    assert_eq!(paint(&mut document, brush(Effect::Erase), Some("paint"), &dab), "paint");
    assert!(document.text().contains("hardness = 0.3, mode = \"erase\" },\n]"), "{}", document.text());
    // On a node without a mask: the node then reads a new mask, and later strokes go there.
    assert_eq!(paint(&mut document, brush(Effect::Paint), Some("land"), &dab), "paint2");
    assert!(document.text().contains("b = 300\nmask = \"paint2\"\n"), "{}", document.text());
    assert_eq!(paint(&mut document, brush(Effect::Paint), Some("land"), &dab), "paint2");
    let erased = Painting::begin(brush(Effect::Erase), document.recipe(), Some("land"), "height", dab[0]).unwrap();
    assert_eq!((erased.node.as_str(), erased.at), ("paint2", 2));
    // Land is not raised in a mask, and no mask is painted in heights.
    assert_eq!(paint(&mut document, brush(Effect::Raise), Some("paint"), &dab), "paint3");
    assert_eq!(paint(&mut document, brush(Effect::Paint), Some("paint3"), &dab), "paint4");
    assert_eq!(document.recipe().output_inputs()[0].1, Input::Node("paint3".into()));
    for _ in 0..6 {
        assert!(document.undo());
    }
    assert_eq!(document.text(), TEXT);
}

#[test]
fn other_strokes_and_comments_stay_as_they_are_written() {
    let own = "strokes = [ { radius = 50.0, points = [[0, 0]] } ] # by hand\n";
    let text = TEXT.replace("op = \"fbm\"\n", &format!("op = \"paint\"\n{own}"));
    let mut document = document(&text);
    assert_eq!(paint(&mut document, brush(Effect::Raise), Some("hills"), &[[1.0, 2.0], [300.0, 2.0]]), "hills");
    let new = "{ points = [[1, 2], [300, 2]], radius = 200, hardness = 0.3, value = 25 }";
    let after = format!("strokes = [ {{ radius = 50.0, points = [[0, 0]] }} ,\n  {new},\n] # by hand\n");
    assert_eq!(document.text(), text.replace(own, &after));
    // Strokes as separate tables.
    let own = "\n[[nodes.hills.strokes]]\nradius = 50.0 # small\npoints = [[0, 0]]\n";
    let text = TEXT.replace("op = \"fbm\"\n", &format!("op = \"paint\"\n{own}"));
    let mut document = self::document(&text);
    paint(&mut document, brush(Effect::Raise), Some("hills"), &[[1.0, 2.0], [300.0, 2.0]]);
    let Node::Paint(paint) = &document.recipe().nodes()[0].node else { panic!("it paints") };
    let strokes = paint.strokes.list();
    assert!(strokes.len() == 2 && strokes[1].points == [[1.0, 2.0], [300.0, 2.0]], "{strokes:?}");
    assert!(document.text().contains(own) && document.text().matches("[[nodes.hills.strokes]]").count() == 2);
}

#[test]
fn an_output_that_is_a_number_is_painted_over() {
    let mut document = document(&TEXT.replace("height = \"land\"", "height = 12.5"));
    paint(&mut document, brush(Effect::Raise), None, &[[1.0, 2.0]]);
    assert!(document.text().contains("background = 12.5\n") && document.text().contains("height = \"paint\" # metres"));
}

#[test]
fn a_stroke_that_was_undone_while_it_was_painted_begins_again() {
    let mut document = document(TEXT);
    let mut painting = Painting::begin(brush(Effect::Raise), document.recipe(), None, "height", [0.0, 0.0]).unwrap();
    document.apply(&painting.edit()).unwrap();
    assert!(document.undo());
    assert!(painting.continue_to([900.0, 0.0]));
    document.apply(&painting.edit()).unwrap();
    assert_eq!(document.text().matches("points").count(), 1);
    assert!(document.undo());
    assert_eq!(document.text(), TEXT);
    // A node with that name that is not a paint node gets no strokes.
    let edit = Edit::Stroke {
        node: "land".into(),
        placement: Placement::Alone,
        at: 0,
        stroke: brush(Effect::Raise).stroke(&[[0.0; 2]]),
    };
    let error = document.apply(&edit).unwrap_err().to_string();
    assert!(error.contains("the node `land` takes no strokes"), "{error}");
}

#[test]
fn strokes_have_few_points_with_few_digits() {
    let circle: Vec<[f64; 2]> = (0..500)
        .map(|k| f64::from(k) * 0.0126)
        .map(|turn| [1000.0 * libm::cos(turn), 1000.0 * libm::sin(turn)])
        .collect();
    for (radius, digits) in [(0.5, 3), (30.0, 1), (200.0, 0), (9000.0, -2)] {
        let brush = Brush { radius, ..brush(Effect::Paint) };
        let scale = radius / 200.0;
        let line: Vec<[f64; 2]> = circle.iter().map(|point| point.map(|part| part * scale)).collect();
        let points = brush.stroke(&line).points;
        assert!((20..90).contains(&points.len()), "{radius}: {}", points.len());
        for part in points.iter().flatten() {
            assert!(rounded(*part, digits) == *part && format!("{part}").len() <= 7, "{radius}: {part}");
        }
        let far = |point: &[f64; 2]| {
            let ends = points.windows(2);
            let distance = |ends: &[[f64; 2]]| crate::editing::thinning::distance([ends[0], ends[1]], *point);
            ends.map(distance).fold(f64::INFINITY, f64::min)
        };
        let worst = line.iter().map(far).fold(0.0, f64::max);
        assert!(worst < 0.03 * radius, "{radius}: {worst}");
    }
}

#[test]
fn a_brush_fits_the_view_and_is_scaled() {
    let mut brush = Brush::fitting(Effect::Raise, 4000.0, [-12.0, 900.0]);
    assert_eq!((brush.radius, brush.height), (100.0, 20.0));
    assert_eq!(Brush::fitting(Effect::Raise, 1e9, [0.0, f32::NAN]).radius, 1e6);
    brush.scale(1.2345);
    assert_eq!(brush.radius, 123.0);
    (0..200).for_each(|_| brush.scale(0.5));
    assert_eq!(brush.radius, 0.1);
}

//! Strokes of the op `paint`.

use orogen_engine::declare::strokes::{Stroke, StrokeMode};
use orogen_engine::field::Paint;
use orogen_engine::{Recipe, World, WorldSpec};

fn stroke(points: &[[f64; 2]], mode: StrokeMode, value: f64) -> Stroke {
    Stroke { points: points.to_vec(), radius: 10.0, mode, value, ..Stroke::default() }
}

/// The values of strokes at points, over a constant background.
fn painted(strokes: &[Stroke], background: f64, points: &[[f64; 2]]) -> Vec<f32> {
    let mut recipe = Recipe::new(WorldSpec::default());
    recipe.add("painted", Paint { background: background.into(), strokes: strokes.to_vec().into() });
    recipe.output("height", "painted");
    let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|[x, y]| (*x, *y)).unzip();
    World::open(recipe).unwrap().points("height", &x, &y).unwrap()
}

#[test]
fn a_dab_falls_from_its_center_to_its_radius() {
    // Full effect up to 5 m, half in the middle of the falloff, none from 10 m on.
    let at = [[0.0, 0.0], [3.0, 4.0], [0.0, 7.5], [-8.0, 6.0], [0.0, 11.0]];
    let dab = stroke(&[[0.0, 0.0]], StrokeMode::Add, 8.0);
    assert_eq!(painted(std::slice::from_ref(&dab), 100.0, &at), [108.0, 108.0, 104.0, 100.0, 100.0]);
    let soft = Stroke { hardness: 0.0, strength: 0.5, ..dab.clone() };
    assert_eq!(painted(&[soft], 0.0, &[[0.0, 0.0], [0.0, 5.0], [0.0, 10.0]]), [4.0, 2.0, 0.0]);
    let hard = Stroke { hardness: 1.0, ..dab };
    assert_eq!(painted(&[hard], 0.0, &[[0.0, 10.0], [0.0, 10.001]]), [8.0, 0.0]);
}

#[test]
fn a_line_that_crosses_itself_does_not_add_up() {
    let cross = [[-50.0, 0.0], [50.0, 0.0], [50.0, 50.0], [0.0, 50.0], [0.0, -50.0]];
    let line = stroke(&cross, StrokeMode::Add, -3.0);
    assert_eq!(painted(std::slice::from_ref(&line), 1.0, &[[0.0, 0.0], [25.0, 2.0], [25.0, 25.0]]), [-2.0, -2.0, 1.0]);
    assert_eq!(painted(&[line.clone(), line], 1.0, &[[0.0, 0.0]]), [-5.0], "two strokes do");
}

#[test]
fn strokes_are_applied_in_their_order() {
    let (at, dab) = ([[0.0, 0.0], [7.5, 0.0]], [[0.0, 0.0]]);
    let set = stroke(&dab, StrokeMode::Set, 1.0);
    let add = stroke(&dab, StrokeMode::Add, 4.0);
    let erase = stroke(&dab, StrokeMode::Erase, 9.0);
    assert_eq!(painted(&[add.clone(), set.clone()], 0.0, &at), [1.0, 1.5]);
    assert_eq!(painted(&[set.clone(), add], 0.0, &at), [5.0, 2.5]);
    // Erasing restores the background, not 0.
    assert_eq!(painted(&[set.clone(), erase.clone()], 0.25, &at), [0.25, 0.4375]);
    assert_eq!(painted(&[set.clone(), Stroke { strength: 0.5, ..erase }], 0.25, &at), [0.625, 0.53125]);
    let clear = stroke(&dab, StrokeMode::Set, 0.0);
    assert_eq!(painted(&[set, clear], 0.0, &at), [0.0, 0.25]);
}

#[test]
fn what_is_set_is_exact_on_any_background() {
    let set = stroke(&[[0.0, 0.0]], StrokeMode::Set, 0.1);
    for background in [1e30, -1e30, 0.3] {
        assert_eq!(painted(std::slice::from_ref(&set), background, &[[1.0, 1.0]]), [0.1]);
        assert_eq!(painted(std::slice::from_ref(&set), background, &[[20.0, 1.0]]), [background as f32]);
    }
    assert_eq!(painted(&[], 7.0, &[[1.0, 1.0]]), [7.0]);
}

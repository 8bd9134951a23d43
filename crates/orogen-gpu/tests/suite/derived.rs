//! Layers derived from heights on any adapter of this machine, compared with the processor.

use crate::common::{difference, processor, session};
use orogen_engine::{Grid, Progress, Recipe, Session, Window};
use orogen_jobs::export::derived::list;
use orogen_jobs::export::layer_source::LayerSource;
use orogen_jobs::options::Options;

/// Steep land with ledges that end at missing samples.
fn recipe(size: &str) -> Recipe {
    let text = format!(
        "orogen = 1\n[world]\nseed = 5\ncell = 20\n{size}[nodes.hills]\nop = \"fbm\"\nwavelength = 900\n[nodes.land]\nop = \"expr\"\n\
         expr = \"sqrt(0.7 - hills) * 0 + hills * 600\"\n[outputs]\nheight = \"land\"\n"
    );
    Recipe::parse(&text, "test").unwrap()
}

/// The layers of a derived layer over a window.
fn made(session: &Session, recipe: &Recipe, layer: &str, window: &Window) -> Vec<Grid> {
    let mut recipe = recipe.clone();
    list::prepare(&mut recipe, layer, &Options::default()).unwrap();
    let world = session.open(recipe).unwrap();
    LayerSource::new(&world, layer, *window, &Progress::none()).unwrap().whole().unwrap()
}

#[test]
fn derived_layers_are_those_of_the_processor() {
    for size in ["", "size = [4000, 3000]\n"] {
        let recipe = recipe(size);
        // At the corner of the world, a single sample, odd sizes, far away, and several bands of rows.
        let mut windows = vec![
            Window::new(1, 1, 20.0),
            Window::new(57, 31, 20.0),
            Window::new(40, 530, 5.0).at(100, 60),
            Window::new(33, 20, 20.0).at(150, 120),
        ];
        if size.is_empty() {
            windows.push(Window::new(64, 41, 20.0).at(50_000, -50_000));
        }
        for window in &windows {
            for layer in ["slope", "hillshade", "normal", "occlusion"] {
                let (exact, made) =
                    (made(processor(), &recipe, layer, window), made(&session(), &recipe, layer, window));
                assert_eq!(made.len(), exact.len());
                for (exact, made) in exact.iter().zip(&made) {
                    let pairs = || exact.data().iter().zip(made.data());
                    assert!(pairs().all(|(exact, made)| exact.is_finite() == made.is_finite()), "{layer} {window:?}");
                    let found = difference(exact, made);
                    // Slopes are in degrees; the others have a range of about 1.
                    let range = if layer == "slope" { 90.0 } else { 1.0 };
                    assert!(found.worst < 1e-4 * range, "{layer} {window:?}: {found:?}");
                }
            }
        }
    }
}

//! The realism of land that a graphics card has eroded, whose samples differ from the processor's.

use crate::common::{gpu, processor, session};
use orogen_engine::{Recipe, Session, Window};
use orogen_output::survey::measures::Measures;
use orogen_output::survey::real::FIGURES;

fn measured(session: &Session, op: &str) -> Measures {
    let text = format!(
        "orogen = 1\n[world]\nseed = 4\ncell = 30\n[nodes.hills]\nop = \"fbm\"\nwavelength = 9000\noctaves = 8\n[nodes.land]\nop = \"remap\"\n\
         source = \"hills\"\nfrom = [-1, 1]\nto = [0, 3000]\n[nodes.eroded]\nop = \"{op}\"\nsource = \"land\"\n[outputs]\nheight = \"eroded\"\n"
    );
    let world = session.open(Recipe::parse(&text, op).unwrap()).unwrap();
    Measures::of(&world.window("height", &Window::new(256, 256, 30.0)).unwrap(), None).unwrap()
}

#[test]
fn chaotic_filters_make_land_as_real_as_the_processors() {
    for op in ["pipes", "local-stream-power"] {
        let (exact, made) = (measured(processor(), op), measured(&session(), op));
        for figure in FIGURES {
            let place = |measures: &Measures| figure.value(measures).map(|value| figure.place(value));
            let (exact, made) = (place(&exact), place(&made));
            // 1 is the distance from the median of real land to its 90 % quantile.
            let apart = exact.zip(made).map(|(exact, made)| (exact - made).abs());
            assert_eq!(exact.is_some(), made.is_some(), "{op}, {}", figure.name);
            assert!(apart.is_none_or(|apart| apart < 0.05), "{op}, {}: {exact:?}, {made:?}", figure.name);
        }
    }
    assert_eq!(gpu().failure(), None);
}

//! Small pictures of the ops: what each makes of the same land.

use std::sync::Arc;

use orogen::Session;
use orogen::node::Node;
use orogen::recipe::Recipe;

use super::picture::Picture;
use super::region::Region;
use super::thumbnails::Thumbnails;
use super::worker::Wake;
use crate::editing::adding::{self, After};
use crate::editing::document::Document;
use crate::editing::drawing;
use crate::editing::edit::Edit;
use crate::editing::names;

/// The land from which the pictures are made.
const LAND: &str = r#"orogen = 1

[world]
seed = 3
size = 5120
cell = 20
sea_level = 0

[nodes.noise]
op = "ridged"
wavelength = 2500
octaves = 7

[nodes.source_land]
op = "expr"
expr = "noise * 320 + 420"

[nodes.rough]
op = "fbm"
wavelength = 700

[outputs]
height = "source_land"
"#;

/// The range of its heights in metres.
const RANGE: [f64; 2] = [100.0, 740.0];

/// The corners of the area and the points of the line in their pictures.
const DRAWN: [[f64; 2]; 4] = [[1200.0, 1000.0], [4200.0, 1500.0], [3600.0, 4100.0], [1000.0, 3500.0]];

/// Small pictures of the ops.
pub struct OpPictures {
    thumbnails: Thumbnails,
    is_asked: bool,
}

impl OpPictures {
    /// No pictures yet.
    #[must_use]
    pub fn new(wake: Wake) -> OpPictures {
        OpPictures { thumbnails: Thumbnails::new(wake), is_asked: false }
    }

    /// Makes the pictures, at the first call, and takes those that are made.
    pub fn update(&mut self, session: &Session) {
        if !self.is_asked {
            self.is_asked = true;
            // Without threads there are no pictures.
            let _ = self.thumbnails.ask(session, recipe(), Region::Whole);
        }
        self.thumbnails.poll();
    }

    /// The picture of an op, if there is one.
    #[must_use]
    pub fn of(&self, op: &str) -> Option<&Arc<Picture>> {
        self.thumbnails.of(&names::of_op(op))
    }
}

/// A recipe with a node of each op that the land suits, each by its default parameters.
#[must_use]
pub fn recipe() -> Recipe {
    let Ok(mut document) = Document::new("ops", LAND.to_owned()) else {
        return Recipe::new(orogen::WorldSpec::default());
    };
    // The land alone, at whose end each op is added with parameters that suit it.
    let land = document.recipe().clone();
    for spec in Node::all().iter().map(Node::spec) {
        let name = names::of_op(spec.op);
        let mut edit = adding::edit(&land, name, spec.op, After::Node("source_land"), Some(RANGE));
        if let Edit::Add { op, inputs, params, readers, .. } = &mut edit {
            // The output stays with the land.
            readers.clear();
            if drawing::OPS.contains(&op.as_str()) {
                params.push((drawing::POINTS.to_owned(), drawing::value(&DRAWN)));
            }
            if let Some(second) = spec.inputs.get(1).filter(|input| input.required) {
                inputs.push((second.name.to_owned(), "rough".to_owned()));
            }
        }
        // Ops that need more, such as a file, have no picture.
        let _ = document.apply(&edit);
    }
    document.recipe().clone()
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::Options;
    use std::time::{Duration, Instant};

    #[test]
    fn most_ops_have_a_picture() {
        let session = Session::new(Options::default()).unwrap();
        let mut pictures = OpPictures::new(Arc::new(|| ()));
        let begun = Instant::now();
        pictures.update(&session);
        while pictures.thumbnails.is_busy() {
            assert!(begun.elapsed() < Duration::from_secs(300), "no pictures");
            std::thread::sleep(Duration::from_millis(5));
            pictures.update(&session);
        }
        let without: Vec<&str> =
            Node::all().iter().map(|node| node.spec().op).filter(|op| pictures.of(op).is_none()).collect();
        assert!(without.len() < 12, "{without:?}");
        assert!(
            ["fbm", "stream-power", "slope", "polygon", "blur"].iter().all(|op| !without.contains(op)),
            "{without:?}"
        );
    }
}

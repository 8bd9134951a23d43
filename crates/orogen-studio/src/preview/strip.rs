//! Small pictures of variants of a recipe.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use orogen::recipe::Recipe;
use orogen::{Progress, Result, Session};
use serde::{Deserialize, Serialize};

use super::picture::Picture;
use super::region::Region;
use super::worker::Wake;
use crate::platform::{self, Task, wire};

/// Number of samples along the longer side of a picture.
pub const SIDE: usize = 128;

/// How much coarser the solvers of variants are, because many small pictures matter more than detail.
const COARSER: u32 = 4;

/// Makes small pictures of recipes; a new list cancels the previous one.
pub struct Strip {
    wake: Wake,
    sender: Sender<(u64, usize, Result<Picture>)>,
    receiver: Receiver<(u64, usize, Result<Picture>)>,
    list: u64,
    running: Option<Progress>,
}

impl Strip {
    /// A strip without pictures.
    #[must_use]
    pub fn new(wake: Wake) -> Strip {
        let (sender, receiver) = channel();
        Strip { wake, sender, receiver, list: 0, running: None }
    }

    /// Requests pictures of a layer of recipes.
    ///
    /// # Errors
    /// If no thread can be started.
    pub fn ask(&mut self, session: &Session, recipes: Vec<Recipe>, layer: String) -> Result<()> {
        self.cancel();
        self.list += 1;
        let (list, sender, wake) = (self.list, self.sender.clone(), Arc::clone(&self.wake));
        let progress = Progress::none();
        self.running = Some(progress.clone());
        // The panel may already be closed.
        platform::start(session, Variants { recipes, layer }, &progress, move |Event(k, made)| {
            let _ = sender.send((list, k, made));
            wake();
        })
    }

    /// Cancels the current work.
    pub fn cancel(&mut self) {
        if let Some(running) = self.running.take() {
            running.cancel();
        }
    }

    /// The pictures of the current list that were made since the last call, with their indices.
    #[must_use]
    pub fn made(&self) -> Vec<(usize, Result<Picture>)> {
        let all = std::iter::from_fn(|| self.receiver.try_recv().ok());
        all.filter(|(list, ..)| *list == self.list).map(|(_, k, made)| (k, made)).collect()
    }
}

impl Drop for Strip {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// The work for a list of variants.
#[derive(Serialize, Deserialize)]
pub struct Variants {
    #[serde(with = "wire::recipes")]
    recipes: Vec<Recipe>,
    layer: String,
}

/// The picture of a variant, with its index.
#[derive(Serialize, Deserialize)]
pub struct Event(usize, #[serde(with = "wire::result")] Result<Picture>);

impl Task for Variants {
    const NAME: &'static str = "variants";
    type Event = Event;

    fn run(self, session: &Session, progress: &Progress, tell: &(dyn Fn(Event) + Send + Sync)) {
        for (k, recipe) in self.recipes.iter().enumerate() {
            let made = picture(session, recipe, &self.layer, progress);
            if progress.is_cancelled() {
                return;
            }
            tell(Event(k, made));
        }
    }
}

/// Makes a picture.
fn picture(session: &Session, recipe: &Recipe, layer: &str, progress: &Progress) -> Result<Picture> {
    let world = session.open(recipe.draft(COARSER))?;
    let window = Region::of(recipe.world.size, recipe.world.cell).window(&world, SIDE)?;
    Picture::of(&world, layer, &window, progress)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::{Options, presets};
    use std::time::{Duration, Instant};

    #[test]
    fn variants_are_drawn_in_order_and_a_new_list_replaces_the_old_one() {
        let session = Session::new(Options::default()).unwrap();
        let mut strip = Strip::new(Arc::new(|| ()));
        let recipes = |preset: &str, count: u64| -> Vec<Recipe> {
            let mut recipe = presets::find(preset).unwrap().recipe().unwrap();
            (0..count)
                .map(|seed| {
                    recipe.world.seed = seed;
                    recipe.clone()
                })
                .collect()
        };
        strip.ask(&session, recipes("alpine", 9), "height".into()).unwrap();
        strip.ask(&session, recipes("classic", 3), "height".into()).unwrap();
        let (begun, mut made) = (Instant::now(), Vec::new());
        while made.len() < 3 && begun.elapsed() < Duration::from_secs(300) {
            made.extend(strip.made().into_iter().map(|(k, picture)| (k, picture.unwrap())));
            std::thread::sleep(Duration::from_millis(2));
        }
        assert_eq!(made.iter().map(|(k, _)| *k).collect::<Vec<_>>(), [0, 1, 2]);
        assert!(made.iter().all(|(_, picture)| picture.size == [SIDE; 2] && picture.pixels.len() == 4 * SIDE * SIDE));
        assert_ne!(made[0].1.pixels, made[1].1.pixels);
    }
}

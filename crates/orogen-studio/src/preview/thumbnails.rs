//! Small pictures of the nodes of a recipe. Pictures that have not changed are not made again.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use orogen::recipe::{NamedNode, Recipe};
use orogen::{ErrorKind, Progress, Result, Session, Window, World};
use serde::{Deserialize, Serialize};

use super::picture::Picture;
use super::region::Region;
use super::worker::Wake;
use crate::platform::{self, Task, wire};

/// Number of samples along the longer side of a picture.
pub const SIDE: usize = 64;

/// How much coarser the solvers of drafts are.
const COARSER: u32 = 4;

/// Maximum time for a picture on one core, in nanoseconds; nodes that take longer have no picture.
const PATIENCE: f64 = 4e8;

/// Everything a picture depends on: the content key of its layer, and the window.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Key([u8; 32], Window);

/// A picture, or `None` because it would take too long.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Made(Key, #[serde(with = "wire::shared_option")] Option<Arc<Picture>>);

/// An event of the work.
#[derive(Serialize, Deserialize)]
pub enum Event {
    /// The picture of a node, and whether it was newly computed.
    Node(String, Made, bool),
    /// All nodes have been processed.
    Done,
}

/// The work for the pictures of a recipe.
#[derive(Serialize, Deserialize)]
pub struct NodePictures {
    #[serde(with = "wire::recipe")]
    recipe: Recipe,
    region: Region,
    known: Vec<Made>,
}

impl Task for NodePictures {
    const NAME: &'static str = "nodes";
    type Event = Event;

    fn run(self, session: &Session, progress: &Progress, tell: &(dyn Fn(Event) + Send + Sync)) {
        // Recipes that cannot be opened have no pictures.
        let _ = make(session, &self.recipe, self.region, self.known, progress, &tell);
        if !progress.is_cancelled() {
            tell(Event::Done);
        }
    }
}

/// Makes pictures of the nodes of a recipe; a new recipe cancels the work for the previous one.
pub struct Thumbnails {
    wake: Wake,
    sender: Sender<(u64, Event)>,
    receiver: Receiver<(u64, Event)>,
    list: u64,
    running: Option<Progress>,
    /// Pictures by the names of nodes.
    made: HashMap<String, Made>,
    /// The nodes of the current recipe.
    names: HashSet<String>,
    computed: u64,
}

impl Thumbnails {
    /// No thumbnails yet.
    #[must_use]
    pub fn new(wake: Wake) -> Thumbnails {
        let (sender, receiver) = channel();
        Thumbnails {
            wake,
            sender,
            receiver,
            list: 0,
            running: None,
            made: HashMap::new(),
            names: HashSet::new(),
            computed: 0,
        }
    }

    /// Requests pictures of all nodes over a region.
    ///
    /// # Errors
    /// If no thread can be started.
    pub fn ask(&mut self, session: &Session, recipe: Recipe, region: Region) -> Result<()> {
        self.cancel();
        self.list += 1;
        self.names = recipe.nodes().iter().map(|named| named.name.clone()).collect();
        let (list, sender, wake) = (self.list, self.sender.clone(), Arc::clone(&self.wake));
        let known: Vec<Made> = self.made.values().cloned().collect();
        let progress = Progress::none();
        self.running = Some(progress.clone());
        // The window may already be closed.
        platform::start(session, NodePictures { recipe, region, known }, &progress, move |event: Event| {
            let _ = sender.send((list, event));
            wake();
        })
    }

    /// Cancels the current work.
    pub fn cancel(&mut self) {
        if let Some(running) = self.running.take() {
            running.cancel();
        }
    }

    /// Takes the pictures that were made since the last call. Returns whether there is anything new.
    pub fn poll(&mut self) -> bool {
        let events: Vec<(u64, Event)> = std::iter::from_fn(|| self.receiver.try_recv().ok()).collect();
        let mut is_new = false;
        for (_, event) in events.into_iter().filter(|(list, _)| *list == self.list) {
            is_new = true;
            match event {
                Event::Node(name, made, is_computed) => {
                    self.computed += u64::from(is_computed);
                    self.made.insert(name, made);
                }
                Event::Done => {
                    self.running = None;
                    self.made.retain(|name, _| self.names.contains(name));
                }
            }
        }
        is_new
    }

    /// The picture of a node, if there is one.
    #[must_use]
    pub fn of(&self, node: &str) -> Option<&Arc<Picture>> {
        self.made.get(node).and_then(|Made(_, picture)| picture.as_ref())
    }

    /// Whether pictures are being made.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    /// Number of pictures that have been computed so far.
    #[must_use]
    pub fn computed(&self) -> u64 {
        self.computed
    }
}

impl Drop for Thumbnails {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// The first layer of a node, by a name that no output has.
fn layer_of(recipe: &Recipe, named: &NamedNode) -> String {
    let is_output = recipe.outputs().any(|output| output == named.name);
    match named.node.layers().first() {
        Some(first) if is_output => format!("{}.{}", named.name, first.name),
        _ => named.name.clone(),
    }
}

fn make(
    session: &Session,
    recipe: &Recipe,
    region: Region,
    mut known: Vec<Made>,
    progress: &Progress,
    tell: &impl Fn(Event),
) -> Result<()> {
    let worlds = [session.open(recipe.clone())?, session.open(recipe.draft(COARSER))?];
    let window = region.window(&worlds[0], SIDE)?;
    for named in recipe.nodes() {
        progress.check()?;
        let layer = layer_of(recipe, named);
        let (made, is_computed) = match one(&worlds, &layer, &window, &known, progress) {
            Ok(made) => made,
            Err(error) if error.kind() == ErrorKind::Cancelled => return Err(error),
            // A node that cannot be computed on its own has no picture.
            Err(_) => continue,
        };
        if is_computed {
            known.push(made.clone());
        }
        tell(Event::Node(named.name.clone(), made, is_computed));
    }
    Ok(())
}

/// The picture of a layer: a known one; otherwise one of the recipe itself if that takes little time (its solvers are
/// in the store, or quick); otherwise one of its draft. The flag says whether it was computed.
fn one(worlds: &[World; 2], layer: &str, window: &Window, known: &[Made], progress: &Progress) -> Result<(Made, bool)> {
    let mut last = None;
    for world in worlds {
        let key = Key(world.key(layer)?, *window);
        let same = known.iter().find(|Made(other, picture)| *other == key && picture.is_some());
        if let Some(same) = same {
            return Ok((same.clone(), false));
        }
        let plan = world.plan(&[layer], window)?;
        if world.work_of(&plan)?.iter().sum::<f64>() <= PATIENCE {
            return Ok((Made(key, Some(Arc::new(Picture::of(world, layer, window, progress)?))), true));
        }
        last = Some(key);
    }
    let key = last.unwrap_or(Key([0; 32], *window));
    Ok((Made(key, None), false))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editing::document::Document;
    use crate::editing::edit::Edit;
    use orogen::value::Value;
    use orogen::{Options, presets};
    use std::time::{Duration, Instant};

    /// Requests thumbnails and waits for them. Returns how many were computed.
    fn wait(thumbnails: &mut Thumbnails, session: &Session, document: &Document) -> u64 {
        let before = thumbnails.computed();
        let recipe = document.recipe();
        thumbnails.ask(session, recipe.clone(), Region::of(recipe.world.size, recipe.world.cell)).unwrap();
        let begun = Instant::now();
        while thumbnails.is_busy() {
            assert!(begun.elapsed() < Duration::from_secs(300), "no pictures");
            std::thread::sleep(Duration::from_millis(2));
            thumbnails.poll();
        }
        thumbnails.computed() - before
    }

    const TEXT: &str = "orogen = 1\n[world]\nsize = 4000\n[nodes.hills]\nop = \"fbm\"\n[nodes.rough]\nop = \"ridged\"\n[nodes.land]\nop = \
                        \"add\"\na = \"hills\"\nb = \"rough\"\n[nodes.spare]\nop = \"blur\"\nsource = \"rough\"\nradius = 90\n[outputs]\nheight = \
                        \"land\"\nhills = \"rough\"\n";

    #[test]
    fn only_what_has_changed_is_made_again() {
        let session = Session::new(Options::default()).unwrap();
        let mut thumbnails = Thumbnails::new(Arc::new(|| ()));
        let mut document = Document::new("test", TEXT.into()).unwrap();
        assert_eq!(wait(&mut thumbnails, &session, &document), 4);
        let picture = |thumbnails: &Thumbnails, node: &str| Arc::clone(thumbnails.of(node).unwrap());
        assert_eq!(picture(&thumbnails, "land").size, [SIDE; 2]);
        // An output with the same name as a node is a different layer.
        assert_ne!(picture(&thumbnails, "hills"), picture(&thumbnails, "rough"));
        assert_eq!(wait(&mut thumbnails, &session, &document), 0);
        let land = picture(&thumbnails, "land");
        let edit = |key: &str, value| Edit::Param { node: "hills".into(), key: key.into(), value };
        document.apply(&edit("octaves", Value::Integer(2))).unwrap();
        assert_eq!(wait(&mut thumbnails, &session, &document), 2);
        assert_ne!(picture(&thumbnails, "land"), land);
        // A name does not affect the content.
        let nodes = vec!["hills".into(), "land".into()];
        document.apply(&Edit::Group { nodes, name: "g".into() }).unwrap();
        assert_eq!(wait(&mut thumbnails, &session, &document), 0);
        assert!(thumbnails.of("g/land").is_some() && thumbnails.of("land").is_none());
        document.apply(&Edit::Seed(5)).unwrap();
        assert_eq!(wait(&mut thumbnails, &session, &document), 4);
    }

    #[test]
    fn a_new_recipe_cancels_the_one_before_and_nodes_that_take_long_have_none() {
        let session = Session::new(Options::default()).unwrap();
        let mut thumbnails = Thumbnails::new(Arc::new(|| ()));
        let alpine = presets::find("alpine").unwrap().recipe().unwrap();
        thumbnails.ask(&session, alpine, Region::Whole).unwrap();
        let text = "orogen = 1\n[world]\nsize = 4000\n[nodes.hills]\nop = \"fbm\"\n[nodes.slow]\nop = \"thermal\"\nsource = \"hills\"\niterations = \
                    2000\n[outputs]\nheight = \"hills\"\n";
        let document = Document::new("test", text.to_owned()).unwrap();
        wait(&mut thumbnails, &session, &document);
        assert!(thumbnails.of("hills").is_some() && thumbnails.of("slow").is_none());
    }
}

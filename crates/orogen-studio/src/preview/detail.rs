//! The work that makes rings of detail around the place that the camera looks at, once the finest picture is there.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use orogen::{Grid, Progress, Result, Session, Window};
use serde::{Deserialize, Serialize};

use super::frame::{Frame, Key};
use super::request::Request;
use super::ring::Ring;
use super::worker::{self, Wake};
use crate::platform::{self, Task, wire};
use crate::view::rings::is_within;

/// Finer rings are left out if the land is as smooth as this, relative to the cell.
const SMOOTH: f64 = 0.02;

/// Makes rings.
pub struct Detail {
    wake: Wake,
    sender: Sender<(u64, Event)>,
    receiver: Receiver<(u64, Event)>,
    /// The number of the last request.
    number: u64,
    running: Option<Progress>,
    /// The picture and the windows of the last request, until a change of the land or of the camera.
    asked: Option<(Key, Vec<Window>)>,
    /// The rings, from coarse to fine.
    rings: Vec<Arc<Ring>>,
}

/// An event of the work.
#[derive(Serialize, Deserialize)]
pub enum Event {
    /// The next finer ring.
    Ring(Box<Ring>),
    /// There are no more rings.
    Done,
}

impl Detail {
    /// Creates it without rings.
    #[must_use]
    pub fn new(wake: Wake) -> Detail {
        let (sender, receiver) = channel();
        Detail { wake, sender, receiver, number: 0, running: None, asked: None, rings: Vec::new() }
    }

    /// Requests the rings with these windows, from coarse to fine, for a finest picture and its request. Nothing
    /// happens if they were already requested.
    pub fn ask(&mut self, session: &Session, request: Request, frame: &Arc<Frame>, windows: Vec<Window>) {
        let asked = Some((frame.key(), windows.clone()));
        if self.asked == asked {
            return;
        }
        self.cancel();
        self.number += 1;
        self.asked = asked;
        let is_known = |ring: &&Arc<Ring>| ring.frame == frame.key();
        let kept: Vec<Arc<Ring>> = self.rings.iter().filter(is_known).map(Arc::clone).collect();
        // With other colors or light, the heights are the same.
        let of_land = |ring: &&Arc<Ring>| Arc::ptr_eq(&ring.land, &frame.heights);
        let heights: Vec<Arc<Grid>> = self.rings.iter().filter(of_land).map(|ring| Arc::clone(&ring.heights)).collect();
        self.rings.clone_from(&kept);
        let common = kept.iter().zip(&windows).take_while(|(ring, window)| ring.window() == *window).count();
        if common == windows.len() {
            self.rings.truncate(common);
            return;
        }
        let progress = Progress::none();
        self.running = Some(progress.clone());
        let (number, sender, wake) = (self.number, self.sender.clone(), Arc::clone(&self.wake));
        let frame = Arc::clone(frame);
        let rings = RingTask { request, frame, windows, kept, heights };
        // The window may already be closed.
        let tell = move |event: Event| {
            let _ = sender.send((number, event));
            wake();
        };
        if platform::start(session, rings, &progress, tell).is_err() {
            self.running = None;
        }
    }

    /// Cancels the work; the rings stay.
    pub fn cancel(&mut self) {
        self.asked = None;
        if let Some(running) = self.running.take() {
            running.cancel();
        }
    }

    /// Removes all rings.
    pub fn clear(&mut self) {
        self.cancel();
        self.number += 1;
        self.rings.clear();
    }

    /// Takes the rings that were made since the last call.
    pub fn poll(&mut self) {
        let events: Vec<(u64, Event)> = std::iter::from_fn(|| self.receiver.try_recv().ok()).collect();
        let current = self.number;
        for (_, event) in events.into_iter().filter(|(number, _)| *number == current) {
            match event {
                Event::Ring(ring) => self.add(Arc::from(ring)),
                Event::Done => self.running = None,
            }
        }
    }

    /// Adds a ring in place of those with the same cell, and drops finer ones that are not inside it.
    fn add(&mut self, ring: Arc<Ring>) {
        let finer =
            self.rings.iter().filter(|other| other.window().cell < ring.window().cell && other.frame == ring.frame);
        let finer: Vec<Arc<Ring>> = finer.map(Arc::clone).collect();
        self.rings.retain(|other| other.window().cell > ring.window().cell && other.frame == ring.frame);
        self.rings.push(ring);
        for other in finer {
            match self.rings.last() {
                Some(last) if is_within(other.window(), last.window()) => self.rings.push(other),
                _ => break,
            }
        }
    }

    /// The rings of a picture, from coarse to fine.
    #[must_use]
    pub fn rings(&self, frame: &Frame) -> Vec<Arc<Ring>> {
        let is_of_it = |ring: &&Arc<Ring>| ring.frame == frame.key();
        self.rings.iter().take_while(is_of_it).map(Arc::clone).collect()
    }

    /// Whether rings are being made.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    /// The last requested windows; `None` after a change of the land or of the camera.
    #[must_use]
    pub fn asked(&self) -> Option<&[Window]> {
        self.asked.as_ref().map(|(_, windows)| windows.as_slice())
    }
}

impl Drop for Detail {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// The work for rings of a picture.
#[derive(Serialize, Deserialize)]
pub struct RingTask {
    request: Request,
    #[serde(with = "wire::shared")]
    frame: Arc<Frame>,
    /// From coarse to fine.
    windows: Vec<Window>,
    /// Rings that exist.
    #[serde(with = "wire::shared_list")]
    kept: Vec<Arc<Ring>>,
    /// Heights that are known.
    #[serde(with = "wire::shared_list")]
    heights: Vec<Arc<Grid>>,
}

impl Task for RingTask {
    const NAME: &'static str = "rings";
    type Event = Event;

    fn run(self, session: &Session, progress: &Progress, tell: &(dyn Fn(Event) + Send + Sync)) {
        // Without memory, or if the world fails, there is no finer ring.
        let _ = make(session, &self, progress, tell);
        if !progress.is_cancelled() {
            tell(Event::Done);
        }
    }
}

/// Makes rings from coarse to fine.
fn make(session: &Session, rings: &RingTask, progress: &Progress, tell: &dyn Fn(Event)) -> Result<()> {
    let RingTask { request, frame, windows, kept, heights } = rings;
    let world = worker::open(session, request, 1)?;
    let mut coarser = Arc::clone(&frame.heights);
    for window in windows {
        progress.check()?;
        let ring = match kept.iter().find(|ring| ring.window() == window) {
            Some(ring) => Ring::clone(ring),
            None => Ring::make(&world, (request, frame), window, heights, progress)?,
        };
        if !ring.adds_to(&coarser, SMOOTH) {
            break;
        }
        coarser = Arc::clone(&ring.heights);
        progress.check()?;
        tell(Event::Ring(Box::new(ring)));
    }
    Ok(())
}

#[cfg(test)]
mod tests;

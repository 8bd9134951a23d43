//! The work that makes pictures: one request at a time, on a thread of the session, cancelled by the next request.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use orogen::budget::Reservation;
use orogen::export::LayerSource;
use orogen::export::derived::list;
use orogen::layer::LayerKind;
use orogen::options::Options as LayerOptions;
use orogen::output::map::Painter;
use orogen::{Error, ErrorKind, Grid, Progress, Result, Session, World};
use serde::{Deserialize, Serialize};

use super::colors::Colors;
use super::contours::Contours;
use super::frame::{Frame, Quality};
use super::request::Request;
use super::rivers::Rivers;
use super::stages::{self, Stage};
use super::statistics::Statistics;
use super::sunlight::sunlight;
use super::{cover, failure};
use crate::platform::{self, IS_STEPWISE, Instant, Task, wire};

/// An event of the work.
#[derive(Debug, Serialize, Deserialize)]
pub enum Event {
    /// A picture.
    Frame(Box<Frame>),
    /// A step is done; this is the next one.
    Next(usize),
    /// All pictures are made.
    Done,
    /// The request failed.
    Failed(#[serde(with = "wire::error")] Error),
}

/// Called from any thread when there is something new to show.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// The work for a request.
#[derive(Serialize, Deserialize)]
pub struct Pictures {
    request: Request,
    /// The number of the request.
    number: u64,
    /// When it was made; in another instance, when it arrived there.
    #[serde(skip, default = "Instant::now")]
    begun: Instant,
    /// Seconds that earlier steps took.
    spent: f64,
    /// The step to do; all of them if `None`.
    step: Option<usize>,
}

impl Task for Pictures {
    const NAME: &'static str = "pictures";
    const IS_URGENT: bool = true;
    type Event = Event;

    fn delay(&self) -> Duration {
        if self.step.is_some_and(|step| step > 0) { QUIET } else { Duration::ZERO }
    }

    fn run(self, session: &Session, progress: &Progress, tell: &(dyn Fn(Event) + Send + Sync)) {
        match make(session, &self, progress, tell) {
            Ok(Some(next)) => tell(Event::Next(next)),
            Ok(None) => tell(Event::Done),
            Err(error) if error.kind() == ErrorKind::Cancelled => {}
            Err(error) => tell(Event::Failed(error)),
        }
    }
}

/// How long a finer picture waits for a change, where it could not be cancelled once it is begun.
const QUIET: Duration = Duration::from_millis(120);

/// How long a change waits for the first picture of the change before it, where that could not be cancelled.
const PATIENCE: Duration = Duration::from_millis(700);

/// Minimum time between two reports of the completed share, in milliseconds.
const BETWEEN: u32 = 150;

/// Makes pictures.
pub struct Worker {
    session: Session,
    wake: Wake,
    sender: Sender<(u64, Event)>,
    receiver: Receiver<(u64, Event)>,
    /// An event that was waited for.
    early: Option<(u64, Event)>,
    /// The number of the last request.
    request: u64,
    running: Option<Progress>,
    /// The current request, if it is done step by step.
    stepwise: Option<Request>,
    /// When it was made.
    begun: Instant,
    /// Whether it has a picture.
    has_picture: bool,
    /// The completed share of the current request, in percent.
    share: Arc<AtomicU32>,
}

impl Worker {
    /// A worker that uses the threads and memory of a session.
    #[must_use]
    pub fn new(session: Session, wake: Wake) -> Worker {
        let (sender, receiver) = channel();
        Worker {
            session,
            wake,
            sender,
            receiver,
            early: None,
            request: 0,
            running: None,
            stepwise: None,
            begun: Instant::now(),
            has_picture: false,
            share: Arc::default(),
        }
    }

    /// Requests pictures. An earlier request is cancelled. Returns the number of the request.
    pub fn ask(&mut self, request: Request) -> u64 {
        self.cancel();
        self.request += 1;
        (self.begun, self.has_picture) = (Instant::now(), false);
        self.stepwise = IS_STEPWISE.then(|| request.clone());
        self.start(request, IS_STEPWISE.then_some(0));
        self.request
    }

    /// Starts a step of the current request, or all of them.
    fn start(&mut self, request: Request, step: Option<usize>) {
        let number = self.request;
        let (sender, wake) = (self.sender.clone(), Arc::clone(&self.wake));
        let (heard, told) = (Arc::new(AtomicU32::new(0)), Arc::clone(&self.wake));
        self.share = Arc::clone(&heard);
        let begun = self.begun;
        let last = AtomicU32::new(0);
        let progress = Progress::new(move |share| {
            let percent = (share * 100.0) as u32;
            // Each drawing of the window takes time from the work.
            let now = begun.elapsed().as_millis() as u32;
            if heard.swap(percent, Ordering::Relaxed) != percent
                && now.saturating_sub(last.load(Ordering::Relaxed)) >= BETWEEN
            {
                last.store(now, Ordering::Relaxed);
                told();
            }
        });
        self.running = Some(progress.clone());
        // The window may already be closed.
        let tell = move |event: Event| {
            let _ = sender.send((number, event));
            wake();
        };
        let spent = if step.is_some() { begun.elapsed().as_secs_f64() } else { 0.0 };
        let pictures = Pictures { request, number, begun, spent, step };
        if let Err(error) = platform::start(&self.session, pictures, &progress, tell) {
            let _ = self.sender.send((number, Event::Failed(error)));
        }
    }

    /// Cancels the current request.
    pub fn cancel(&mut self) {
        if let Some(running) = self.running.take() {
            running.cancel();
        }
    }

    /// The events of the current request since the last call. Events of earlier requests are dropped.
    pub fn events(&mut self) -> Vec<Event> {
        let early = self.early.take();
        let events: Vec<Event> = early
            .into_iter()
            .chain(self.receiver.try_iter())
            .filter(|(request, _)| *request == self.request)
            .map(|(_, event)| event)
            .collect();
        if events.iter().any(|event| matches!(event, Event::Done | Event::Failed(_))) {
            self.running = None;
        }
        self.has_picture |= events.iter().any(|event| matches!(event, Event::Frame(_)));
        if let Some(Event::Next(step)) = events.last()
            && let Some(request) = self.stepwise.clone()
        {
            self.start(request, Some(*step));
        }
        events
    }

    /// Whether a change should wait for the first picture of the change before it.
    #[must_use]
    pub fn should_wait(&self) -> bool {
        IS_STEPWISE && self.is_busy() && !self.has_picture && self.begun.elapsed() < PATIENCE
    }

    /// Waits for an event of the current request, for `limit` at most. Returns whether there is one.
    pub fn wait(&mut self, limit: Duration) -> bool {
        let until = Instant::now() + limit;
        while self.early.as_ref().is_none_or(|(request, _)| *request != self.request) {
            match platform::wait(&self.receiver, until.saturating_duration_since(Instant::now())) {
                Some(event) => self.early = Some(event),
                None => return false,
            }
        }
        true
    }

    /// Whether a request is in progress.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    /// The completed share of the current request, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f32 {
        self.share.load(Ordering::Relaxed) as f32 / 100.0
    }

    /// The session.
    #[must_use]
    pub fn session(&self) -> &Session {
        &self.session
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// Makes the pictures of a request, or those of one step. Returns the next step, if there is one.
fn make(
    session: &Session,
    Pictures { request, number, begun, spent, step }: &Pictures,
    progress: &Progress,
    tell: &(dyn Fn(Event) + Send + Sync),
) -> Result<Option<usize>> {
    let world = open(session, request, 1)?;
    let tell_of = |frame: Frame| {
        let seconds = spent + begun.elapsed().as_secs_f64();
        tell(Event::Frame(Box::new(Frame { request: *number, seconds, ..frame })));
    };
    if let Some(land) = &request.land {
        let samples = Samples {
            heights: Arc::clone(&land.heights),
            values: land.values.clone(),
            unit: land.unit,
            kind: land.kind,
            memory: Some(Arc::new(world.budget().reserve(Frame::memory(land.window()))?)),
        };
        let frame = paint(&world, request, Quality::Fine, samples, progress)?;
        let known = land.rivers.clone();
        tell_of(with_rivers(&world, request, frame, known, progress)?);
        return Ok(None);
    }
    let stages = stages::of(&world, request)?;
    let next = step.map(|step| step + 1).filter(|next| *next < stages.len());
    let mut works = Vec::new();
    for (_, stage) in stages.into_iter().enumerate().filter(|(at, _)| step.is_none_or(|step| step == *at)) {
        let is_draft = stage.quality == Quality::Draft;
        let of_stage = || match stage.on_card {
            true => open(&session.drafting(), request, 1),
            false => open(session, request, stage.coarser),
        };
        let draft = is_draft.then(of_stage).transpose()?;
        let work = work(draft.as_ref().unwrap_or(&world), request, stage)?;
        // The recipe's solvers run only before its first picture.
        let is_later = works.iter().any(|(draft, ..): &(Option<World>, Stage, [f64; 2])| draft.is_none());
        works.push((draft, stage, [if is_later { 0.0 } else { work[0] }, work[1]]));
    }
    works.iter().for_each(|(.., work)| progress.expect(work.iter().sum()));
    for (draft, stage, work) in works {
        progress.check()?;
        let part = progress.part(work.iter().sum());
        let world = draft.as_ref().unwrap_or(&world);
        let made = samples(world, request, stage, &part)
            .and_then(|samples| paint(world, request, stage.quality, samples, &progress.part(0.0)));
        part.finish();
        let frame = match made {
            Ok(frame) => frame,
            // A draft that fails is skipped.
            Err(error) if stage.quality == Quality::Draft && error.kind() != ErrorKind::Cancelled => continue,
            Err(error) => return Err(error),
        };
        let has_rivers = frame.quality == Quality::Fine && request.rivers && Rivers::are_in(world.recipe());
        let last = has_rivers.then(|| frame.clone());
        tell_of(frame);
        // The land is shown before its rivers are found.
        if let Some(frame) = last {
            tell_of(with_rivers(world, request, frame, None, progress)?);
        }
    }
    Ok(next)
}

/// A picture with its rivers and lakes, if they are requested. `known` are those that were found before.
fn with_rivers(
    world: &World,
    request: &Request,
    mut frame: Frame,
    known: Option<Arc<Rivers>>,
    progress: &Progress,
) -> Result<Frame> {
    if !request.rivers || !Rivers::are_in(world.recipe()) {
        return Ok(frame);
    }
    let rivers = match known {
        Some(rivers) => rivers,
        None => match Rivers::of(world, &frame.heights, &progress.part(0.0)) {
            Ok(rivers) => Arc::new(rivers),
            Err(error) if error.kind() == ErrorKind::Cancelled => return Err(error),
            // Without the memory for rivers there is the land alone.
            Err(_) => return Ok(frame),
        },
    };
    let window = *frame.window();
    rivers.paint(&window, &mut frame.albedo);
    rivers.paint(&window, &mut frame.shaded);
    frame.rivers = Some(rivers);
    Ok(frame)
}

/// Opens the recipe of a request, or a draft of it.
pub(super) fn open(session: &Session, request: &Request, coarser: u32) -> Result<World> {
    let mut recipe = request.recipe.draft(coarser);
    cover::prepare(&mut recipe, &request.coloring);
    list::prepare(&mut recipe, &request.layer, &LayerOptions::default())?;
    session.open(recipe)
}

/// Approximate time of a picture on one core, in nanoseconds: for its solvers, and for its samples.
fn work(world: &World, request: &Request, stage: Stage) -> Result<[f64; 2]> {
    let window = request.region.window(world, stage.samples)?;
    world.work_of(&world.plan(&[&request.surface], &window)?)
}

/// The samples of a picture.
struct Samples {
    heights: Arc<Grid>,
    values: Option<Arc<Grid>>,
    unit: &'static str,
    kind: LayerKind,
    memory: Option<Arc<Reservation>>,
}

/// Computes the samples of a picture.
fn samples(world: &World, request: &Request, stage: Stage, progress: &Progress) -> Result<Samples> {
    let window = request.region.window(world, stage.samples)?;
    let memory = Some(Arc::new(world.budget().reserve(Frame::memory(&window))?));
    let heights = world.grids(&[&request.surface], &window, progress)?.pop().ok_or_else(failure::nothing)?;
    let mut unit = world.unit(&request.surface)?;
    let mut kind = world.kind(&request.surface)?;
    let values = match request.layer == request.surface {
        true => None,
        false => {
            let mut source = LayerSource::new(world, &request.layer, window, progress)?;
            (unit, kind) = (source.unit(), source.kind());
            let values = source.whole().map_err(failure::of_stream)?.into_iter().next();
            Some(Arc::new(values.ok_or_else(failure::nothing)?))
        }
    };
    Ok(Samples { heights: Arc::new(heights), values, unit, kind, memory })
}

/// Computes colors and light of samples.
fn paint(world: &World, request: &Request, quality: Quality, samples: Samples, progress: &Progress) -> Result<Frame> {
    let Samples { heights, values, unit, kind, memory } = samples;
    let sea_level = world.recipe().world.sea_level;
    let shown = values.as_ref().unwrap_or(&heights);
    let (albedo, legend, painter, colors) = match request.coloring.is_cover() {
        true => {
            let (albedo, legend) = cover::paint(world, &request.coloring, &heights, &heights, progress)?;
            (albedo, legend, Painter::fit(&heights, sea_level), None)
        }
        false => {
            let colors = Colors::of(world.recipe(), &request.layer, kind, &request.coloring, shown);
            (colors.paint(shown), colors.legend(shown), colors.painter(&heights, sea_level), Some(colors))
        }
    };
    progress.check()?;
    let mut shaded = albedo.clone();
    world.install(|| painter.shade(&heights, &mut shaded));
    progress.check()?;
    // On the session's threads, like all parallel work.
    let (contours, light, statistics) = world.install(|| {
        let contours = request.contours.map(|interval| Contours::of(&heights, interval)).transpose();
        (contours, sunlight(&heights, sea_level as f32, request.sun), Statistics::of(shown, sea_level))
    });
    Ok(Frame {
        request: 0,
        quality,
        unit,
        kind,
        statistics,
        levels: levels(&heights),
        colors,
        albedo,
        legend,
        shaded,
        rivers: None,
        contours: contours?.map(Arc::new),
        light,
        sea_level,
        seconds: 0.0,
        memory,
        heights,
        values,
    })
}

/// The lowest and the highest height; 0 if there is none.
fn levels(heights: &Grid) -> [f32; 2] {
    let finite = heights.data().iter().copied().filter(|height| height.is_finite());
    let [low, high] =
        finite.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], height| [low.min(height), high.max(height)]);
    if low <= high { [low, high] } else { [0.0; 2] }
}

#[cfg(test)]
mod tests;

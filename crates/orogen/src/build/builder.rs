//! Builds what is ordered.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::blocks::{Block, union};
use super::cog::Cog;
use super::folder::Folder;
use super::identity::Identity;
use super::job::{Job, Place, Record, Stage};
use super::journal::{Journal, Story};
use super::order::{Form, Order};
use super::piece::Piece;
use super::shelf::{Put, Shelf, put};
use super::site::Site;
use super::target::{Disk, Target};
use super::xyz::Tree;
use super::zarr::Zarr;
use crate::error::{Error, ErrorKind, Result};
use crate::grid::Grid;
use crate::progress::Progress;
use crate::world::World;

/// What to do with what is there already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// Nothing may be there.
    Fresh,
    /// Go on with the same build, if it was begun: what is sound is kept.
    Resume,
    /// Begin anew, over what a build has left there.
    Force,
}

/// What has been done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Report {
    /// Tiles that were made now, those of overviews and lower zooms among them.
    pub made: usize,
    /// Tiles that were there and sound.
    pub kept: usize,
    /// Bytes of the result's tiles, or of the one file that it is.
    pub bytes: u64,
}

/// A build: an order that can be met, about to be carried out.
///
/// ```
/// use orogen::build::builder::{Build, Start};
/// use orogen::build::order::{Form, Order};
/// use orogen::{Progress, Window, World};
///
/// let world = World::open(orogen::presets::find("hills").ok_or("no such preset")?.recipe()?)?;
/// let out = std::env::temp_dir().join(format!("orogen-doc-{}.zarr", std::process::id()));
/// let order =
///     Order { form: Form::Zarr, window: Window::new(300, 200, 30.0), tile: Some(128), layers: vec!["height".into()] };
/// let build = Build::new(&world, &order, &out)?;
/// let report = build.run(Start::Fresh, &Progress::none())?;
/// assert_eq!((report.made, report.kept), (6, 0));
/// assert_eq!(build.run(Start::Resume, &Progress::none())?.made, 0);
/// # std::fs::remove_dir_all(&out)?;
/// # std::fs::remove_dir_all(build.beside())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Build<'a> {
    world: &'a World,
    identity: Identity,
    target: Box<dyn Target>,
    stages: Vec<Stage>,
    block: Block,
    site: Site,
    /// How files are written.
    pub(super) put: Box<Put>,
}

impl<'a> Build<'a> {
    /// Makes sure that an order can be met. Nothing is written yet.
    ///
    /// # Errors
    /// If the order or its place is impossible, the world does not have these samples, or one tile needs more memory than allowed.
    pub fn new(world: &'a World, order: &Order, out: &Path) -> Result<Build<'a>> {
        order.check()?;
        let tile = match order.tile.or(order.form.usual_tile()) {
            Some(tile) => tile,
            None => Cog::usual_tile(&order.window)?,
        };
        let identity = Identity::of(world, order, tile)?;
        let layers: Vec<&str> = order.layers.iter().map(String::as_str).collect();
        // Refuses a window that is none, before it is cut.
        world.plan(&layers, &order.window)?;
        let about = &world.recipe().about;
        let target: Box<dyn Target> = match order.form {
            Form::Cog => Box::new(Cog::new(&identity)?),
            Form::Zarr => Box::new(Zarr::new(&identity, about)?),
            Form::Tiles(samples) => Box::new(Folder::new(&identity, samples, about, world.recipe().world.sea_level)?),
            Form::Xyz(encoding) => Box::new(Tree::new(&identity, about, encoding)?),
        };
        let stages = target.stages();
        let block = Block::fitting(world, target.as_ref(), stages[0], &layers)?;
        let site = Site::new(out, order.form.is_file())?;
        Ok(Build { world, identity, target, stages, block, site, put: Box::new(put) })
    }

    /// Bytes of memory that it takes at most.
    pub fn memory(&self) -> u64 {
        self.block.memory
    }

    /// Bytes on disk that it takes at most, and how many of them are there already.
    pub fn disk(&self) -> (Disk, u64) {
        let there = match Story::read(&self.site.journal()) {
            Ok(Some(story)) => story.records.values().flat_map(|record| &record.pieces).map(|piece| piece.length).sum(),
            _ => 0,
        };
        (self.target.disk(), there)
    }

    /// How many tiles it has, and how many samples in all, those of overviews and lower zooms among them.
    pub fn tiles(&self) -> (usize, u64) {
        let samples = self.stages.iter().map(|stage| stage.len() as u64 * stage.samples as u64).sum();
        (self.stages.iter().map(Stage::len).sum(), samples)
    }

    /// The folder that holds the journal, and, until the build is finished, what it needs on the way.
    pub fn beside(&self) -> &Path {
        self.site.beside()
    }

    /// Builds.
    ///
    /// # Errors
    /// If something is there that `start` does not allow for, another build is at work there, a file cannot be written, or the work
    /// is cancelled. After any of these, and after a kill, [`Start::Resume`] goes on.
    pub fn run(&self, start: Start, progress: &Progress) -> Result<Report> {
        let mut held = self.site.hold()?;
        let (story, sound) = self.begin(start, progress)?;
        held.keep();
        if let Some(report) = self.is_finished(&story, &sound) {
            self.site.sweep()?;
            return Ok(report);
        }
        let wanted = self.wanted(&sound);
        let kept = sound.len();
        let records: BTreeMap<Job, Record> = story.records;
        let journal = Story { identity: self.identity.clone(), records: records.clone(), finished: None };
        self.site.tidy()?;
        self.site.furnish()?;
        let journal = Journal::write(&self.site.journal(), &self.site.temporary(0), &journal)?;
        let shelf = Shelf::new(&self.site, journal, records, self.put.as_ref());
        let made = wanted.len();
        self.world.install(|| self.make(&wanted, &shelf, progress))?;
        progress.check()?;
        let extra = self.target.finish(&shelf)?;
        let bytes = self.close(shelf, extra)?;
        Ok(Report { made, kept, bytes })
    }

    /// What is known of the build, and which of its jobs' files are as they should be.
    fn begin(&self, start: Start, progress: &Progress) -> Result<(Story, BTreeSet<Job>)> {
        let story = match (start, Story::read(&self.site.journal())) {
            (Start::Force, read) => {
                self.site.clear(!matches!(read, Ok(None)))?;
                None
            }
            (_, read) => read?,
        };
        let refuse = |sentence: String| Err(Error::new(ErrorKind::File, sentence));
        let out = self.site.out().display();
        match (start, story) {
            (Start::Fresh, Some(Story { finished: Some(_), .. })) => {
                refuse(format!("{out} is finished: --resume checks it, --force builds it anew"))
            }
            (Start::Fresh, Some(_)) => refuse(format!(
                "a build of {out} was begun and not finished: --resume goes on with it, --force begins anew"
            )),
            (Start::Fresh | Start::Resume, None) if self.site.is_taken() => match start {
                Start::Fresh => refuse(format!("{out} is there already: --force replaces it")),
                _ => refuse(format!(
                    "{out} is there, but no journal of its build ({}): nothing tells what it is; --force builds it anew",
                    self.site.journal().display()
                )),
            },
            (_, Some(story)) => match self.identity.difference(&story.identity) {
                Some(difference) => refuse(format!(
                    "{out} cannot be resumed: it was begun {difference}; ask for the same, or begin anew with --force"
                )),
                None => {
                    let sound = self.world.install(|| self.sound(&story, progress))?;
                    Ok((story, sound))
                }
            },
            (_, None) => Ok((Story::begun(self.identity.clone()), BTreeSet::new())),
        }
    }

    /// The jobs whose files are all there and what they were.
    fn sound(&self, story: &Story, progress: &Progress) -> Result<BTreeSet<Job>> {
        let records: Vec<(&Job, &Record)> = story.records.iter().collect();
        let checked = records.into_par_iter().map(|(job, record)| {
            progress.check()?;
            let stage = self.stages.get(job.stage).filter(|stage| job.row < stage.rows && job.column < stage.columns);
            let places = if stage.is_some() { self.target.places(*job) } else { Vec::new() };
            let as_many = !places.is_empty() && places.len() == record.pieces.len();
            let same = |(place, piece): (&Place, &Piece)| match (place, &story.finished) {
                // What was needed on the way is gone, and not missed.
                (Place::Scratch(_), Some(_)) => true,
                _ => piece.is_at(&self.site.path(place)),
            };
            Ok((as_many && places.iter().zip(&record.pieces).all(same)).then_some(*job))
        });
        Ok(checked.collect::<Result<Vec<Option<Job>>>>()?.into_iter().flatten().collect())
    }

    /// If all is there and sound: what there is.
    fn is_finished(&self, story: &Story, sound: &BTreeSet<Job>) -> Option<Report> {
        let finished = story.finished.as_ref()?;
        let whole = finished.iter().all(|(path, piece)| piece.is_at(&self.site.result(path)));
        let tiles = if self.target.assembles() { 0 } else { self.tiles().0 };
        (whole && sound.len() >= tiles).then(|| Report {
            made: 0,
            kept: self.tiles().0,
            bytes: self.bytes(&story.records, finished.iter().map(|(_, piece)| piece.length).sum()),
        })
    }

    /// The jobs that have to be done: those whose part of the result is not there, and those that others need and that are not there.
    fn wanted(&self, sound: &BTreeSet<Job>) -> BTreeSet<Job> {
        let mut wanted = BTreeSet::new();
        for (stage, Stage { rows, columns, .. }) in self.stages.iter().enumerate().rev() {
            let read: BTreeSet<Job> = wanted
                .iter()
                .filter(|job: &&Job| job.stage == stage + 1)
                .flat_map(|job| self.target.reads(*job))
                .collect();
            for (row, column) in (0..*rows).flat_map(|row| (0..*columns).map(move |column| (row, column))) {
                let job = Job { stage, row, column };
                let places = self.target.places(job);
                let needed = read.contains(&job)
                    || self.target.assembles()
                    || places.iter().any(|place| matches!(place, Place::Result(_)));
                // After the end, scratch counts as sound while nobody reads it.
                let there = sound.contains(&job)
                    && (!read.contains(&job)
                        || places
                            .iter()
                            .all(|place| matches!(place, Place::Result(_)) || self.site.path(place).is_file()));
                if needed && !there {
                    wanted.insert(job);
                }
            }
        }
        wanted
    }

    /// Does the jobs, stage after stage.
    fn make(&self, wanted: &BTreeSet<Job>, shelf: &Shelf, progress: &Progress) -> Result<()> {
        progress.expect(wanted.iter().map(|job| self.stages[job.stage].samples as i64).sum());
        for (n, stage) in self.stages.iter().enumerate() {
            let tiles = wanted.iter().filter(|job| job.stage == n).map(|job| (job.row, job.column));
            if n == 0 {
                for group in self.block.groups(&tiles.collect(), *stage) {
                    self.make_group(&group, shelf, progress)?;
                }
            } else {
                let tiles: Vec<(usize, usize)> = tiles.collect();
                tiles
                    .into_par_iter()
                    .try_for_each(|(row, column)| self.make_one(Job { stage: n, row, column }, &[], shelf, progress))?;
            }
        }
        Ok(())
    }

    /// Makes the samples of tiles that lie together, then each tile of them.
    fn make_group(&self, group: &[(usize, usize)], shelf: &Shelf, progress: &Progress) -> Result<()> {
        let Some(window) = union(self.target.as_ref(), group.iter().copied()) else { return Ok(()) };
        let layers: Vec<&str> = self.identity.layers.iter().map(String::as_str).collect();
        let grids = self.world.grids(&layers, &window, &progress.part())?;
        group.par_iter().try_for_each(|&(row, column)| {
            let window = self.target.window(row, column);
            let tiles: Option<Vec<Grid>> = grids.iter().map(|grid| grid.crop(&window)).collect();
            let tiles = tiles.ok_or_else(|| Error::new(ErrorKind::Request, "a tile lies outside of its block"))?;
            self.make_one(Job { stage: 0, row, column }, &tiles, shelf, progress)
        })
    }

    fn make_one(&self, job: Job, grids: &[Grid], shelf: &Shelf, progress: &Progress) -> Result<()> {
        progress.check()?;
        let made = self.target.make(job, grids, shelf)?;
        shelf.keep(job, &self.target.places(job), &made)?;
        progress.advance(self.stages[job.stage].samples as u64);
        Ok(())
    }

    /// Makes all of it last, says so in the journal, and removes what is needed no more. Returns the bytes of the result.
    fn close(&self, shelf: Shelf, extra: Vec<(PathBuf, Piece)>) -> Result<u64> {
        let mut records = shelf.into_records();
        if self.target.assembles() {
            // The file is what there is to check from now on.
            records.clear();
        }
        let mut paths: Vec<PathBuf> = extra.iter().map(|(path, _)| path.clone()).collect();
        for job in records.keys() {
            paths.extend(self.target.places(*job).into_iter().filter_map(|place| match place {
                Place::Result(path) => Some(path),
                Place::Scratch(_) => None,
            }));
        }
        self.site.sync(&paths)?;
        let bytes = self.bytes(&records, extra.iter().map(|(_, piece)| piece.length).sum());
        let story = Story { identity: self.identity.clone(), records, finished: Some(extra) };
        Journal::write(&self.site.journal(), &self.site.temporary(0), &story)?;
        self.site.sweep()?;
        Ok(bytes)
    }

    /// The bytes of the result.
    fn bytes(&self, records: &BTreeMap<Job, Record>, extra: u64) -> u64 {
        let of = |(job, record): (&Job, &Record)| -> u64 {
            let places = self.target.places(*job);
            let own = places.iter().zip(&record.pieces).filter(|(place, _)| matches!(place, Place::Result(_)));
            own.map(|(_, piece)| piece.length).sum()
        };
        records.iter().map(of).sum::<u64>() + extra
    }
}

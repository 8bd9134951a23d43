//! Running a build.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use orogen_grid::parallel;

use super::blocks::{Block, memory_beside, union};
use super::cog::Cog;
use super::digest::FileDigest;
use super::folder::Folder;
use super::identity::Identity;
use super::job::{Job, JobFile, Record, Stage};
use super::journal::{Journal, JournalState};
use super::output_store::{OutputStore, Put, WAITING, put};
use super::part::Part;
use super::part_folder::{self, PartFolder};
use super::pmtiles::Pmtiles;
use super::samples::range;
use super::spec::{BuildSpec, Form};
use super::target::{BuildTarget, Disk, paths};
use super::work_dir::WorkDir;
use super::xyz::Tree;
use super::zarr::Zarr;
use orogen_engine::world::World;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_io::file::Output;
use orogen_io::fs;

/// How existing results are treated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// There must be no existing result.
    Fresh,
    /// Continue the same build if it was started, and keep intact tiles.
    Resume,
    /// Start again, replacing the files of an earlier build.
    Force,
}

/// Approximate time for compressing and writing a sample, in nanoseconds.
const PACKING: f64 = 15.0;

/// Statistics of a run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Report {
    /// Tiles made in this run, including tiles of overviews and lower zooms.
    pub made: usize,
    /// Tiles that existed and were intact.
    pub kept: usize,
    /// Existing tiles that were computed again because new tiles are derived from them.
    pub again: usize,
    /// The count of samples computed in this run, over all layers.
    pub samples: FiniteCount,
    /// Files in the result's folder that no build made, by their paths within it; they were kept.
    pub foreign: Vec<PathBuf>,
    /// Size of the result's tiles, or of the single file, in bytes.
    pub bytes: u64,
    /// The parts of the build that are not complete, of more than 1000 parts perhaps not all of them; empty if the
    /// result is complete.
    pub left: Vec<usize>,
}

/// A checked build, ready to run.
///
/// ```
/// use orogen_jobs::builder::run::{Build, Start};
/// use orogen_jobs::builder::spec::{BuildSpec, Form};
/// use orogen_io::file::OutputPolicy;
/// use orogen_engine::{Progress, Window, World};
///
/// let world = World::open(orogen_engine::presets::find("hills").ok_or("no such preset")?.recipe()?)?;
/// let out = std::env::temp_dir().join(format!("orogen-doc-{}.zarr", std::process::id()));
/// let spec = BuildSpec::new(Form::Zarr, Window::new(300, 200, 30.0)).with_tile(128);
/// let build = Build::new(&world, &spec, &OutputPolicy::default().output(&out)?)?;
/// let report = build.run(Start::Fresh, &Progress::none())?;
/// assert_eq!((report.made, report.kept), (6, 0));
/// assert_eq!(build.run(Start::Resume, &Progress::none())?.made, 0);
/// # std::fs::remove_dir_all(&out)?;
/// # std::fs::remove_dir_all(build.beside())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Build<'a> {
    pub(super) world: &'a World,
    pub(super) identity: Identity,
    pub(super) target: Box<dyn BuildTarget>,
    stages: Vec<Stage>,
    block: Block,
    pub(super) work_dir: WorkDir,
    part: Option<Part>,
    /// The function that writes files.
    pub(super) put: Box<Put>,
}

impl<'a> Build<'a> {
    /// Checks that the build is possible. Nothing is written.
    ///
    /// If the specification or the path is invalid, the world does not have these samples, or a single tile needs more
    /// memory than allowed.
    pub fn new(world: &'a World, spec: &BuildSpec, output: &Output) -> Result<Build<'a>> {
        spec.check()?;
        let tile = match spec.tile.or(spec.form.usual_tile()) {
            Some(tile) => tile,
            None => Cog::usual_tile(&spec.window)?,
        };
        let identity = Identity::of(world, spec, tile)?;
        let layers: Vec<&str> = spec.layers.iter().map(String::as_str).collect();
        // Rejects invalid windows and layers first. The whole window may have more samples than can be made at once.
        world.check(&spec.window)?;
        for corner in corners(&spec.window) {
            world.plan(&layers, &corner)?;
        }
        let target = target(world, &identity, spec.form)?;
        let stages = target.stages();
        let waiting = if fs::is_remote(output.path()) { WAITING } else { 0 };
        let block = Block::fitting(world, target.as_ref(), stages[0], &layers, waiting)?;
        let part = spec.part.map(|[number, count]| Part { number, count });
        let work_dir = WorkDir::new(output, spec.form.is_file())?;
        let work_dir = match part {
            Some(part) => work_dir.for_part(part.number),
            None => work_dir,
        };
        Ok(Build { world, identity, target, stages, block, work_dir, part, put: Box::new(put) })
    }

    /// Maximum memory, in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        self.block.memory
    }

    /// Maximum disk space, and the number of bytes that already exist. Of a part, its share, unless it begins the
    /// build.
    #[must_use]
    pub fn disk(&self) -> (Disk, u64) {
        let (disk, state) = (self.target.disk(), JournalState::read(&self.work_dir.journal()));
        let Ok(Some(mut state)) = state else { return (disk, 0) };
        let made = |state: &JournalState| {
            sum(state.records.values().flat_map(|record| &record.digests).map(|digest| digest.length))
        };
        let Some(part) = self.part else {
            part_folder::merge(&self.work_dir.parts(), &mut state);
            return (disk, made(&state));
        };
        let (own, all) = (self.tiles().0 as u128, self.stages[0].len().max(1) as u128);
        let [result, scratch] = [disk.result, disk.scratch].map(|bytes| (u128::from(bytes) * own / all) as u64);
        let own = PartFolder::new(&self.work_dir.parts(), part).own(&self.identity);
        let there = match state.finished {
            Some(_) => result.saturating_add(scratch),
            None => own.as_ref().map_or(0, made),
        };
        (Disk { result, scratch }, there)
    }

    /// Number of tiles and of samples, including tiles and samples of overviews and lower zooms. Of a part, those of
    /// its share, which has neither.
    pub fn tiles(&self) -> (usize, u64) {
        if self.part.is_some() {
            let count = self.share().len();
            return (count, count as u64 * self.stages[0].samples as u64);
        }
        let samples = self.stages.iter().map(|stage| stage.len() as u64 * stage.samples as u64).sum();
        (self.stages.iter().map(Stage::len).sum(), samples)
    }

    /// The maximum number of parts that have something to do.
    #[cfg(test)]
    pub(super) fn max_parts(&self) -> usize {
        self.stages[0].len()
    }

    /// The jobs of the first stage that this part does.
    pub(super) fn share(&self) -> BTreeSet<Job> {
        self.part.unwrap_or(Part { number: 1, count: 1 }).jobs(self.stages[0])
    }

    /// The folder with the journal and, until the build is complete, temporary files.
    #[must_use]
    pub fn beside(&self) -> &Path {
        self.work_dir.beside()
    }

    /// Runs the build, or its part. A part always continues what exists, and cannot start again with [`Start::Force`].
    ///
    /// # Errors
    /// If `start` does not allow an existing result, another build is running there, a file cannot be written, or the
    /// work is cancelled. After any of these, and after a kill, [`Start::Resume`] continues.
    pub fn run(&self, start: Start, progress: &Progress) -> Result<Report> {
        if let Some(part) = self.part {
            return self.run_part(part, start, progress);
        }
        let mut held = self.work_dir.hold()?;
        let (state, sound, foreign) = self.begin(start, progress)?;
        held.keep();
        if let Some(report) = self.is_finished(&state, &sound) {
            self.work_dir.sweep()?;
            return Ok(report);
        }
        let wanted = self.wanted(&sound);
        let (kept, again) = (sound.len(), wanted.intersection(&sound).count());
        let state = JournalState { parts: None, finished: None, ..state };
        self.work_dir.tidy()?;
        self.work_dir.furnish()?;
        let (samples, bytes) = self.finish(&wanted, &state, &BTreeSet::new(), progress)?;
        self.work_dir.sweep()?;
        let made = wanted.len() - again;
        Ok(Report { made, kept, again, samples, foreign, bytes, left: Vec::new() })
    }

    /// Makes the wanted jobs, finishes the result and records completion in the journal. `synced` are jobs whose files
    /// need not be synced. Returns the count of finite samples, and the size of the result.
    pub(super) fn finish(
        &self,
        wanted: &BTreeSet<Job>,
        state: &JournalState,
        synced: &BTreeSet<Job>,
        progress: &Progress,
    ) -> Result<(FiniteCount, u64)> {
        let journal = Journal::write(&self.work_dir.journal(), &self.work_dir.temporary(0), state)?;
        if state.parts.is_none() {
            // Their records are in the journal now.
            self.work_dir.drop_parts()?;
        }
        let store = OutputStore::new(&self.work_dir, journal, state.records.clone(), self.put.as_ref());
        let samples = self.world.install(|| self.make(wanted, &store, progress))?;
        progress.check()?;
        for (n, layer) in self.identity.layers.iter().enumerate() {
            if store.range(n).is_none() {
                // Also if all tiles existed, because then no samples were counted in this run.
                FiniteCount { samples: samples.samples.max(1), finite: 0 }.check(&format!("the layer `{layer}`"))?;
            }
        }
        let extra = self.target.finish(&store)?;
        let made_before = |job: &Job| synced.contains(job) && !wanted.contains(job);
        Ok((samples, self.close(store, extra, made_before)?))
    }

    /// The state of the build, and the jobs whose files are intact.
    fn begin(&self, start: Start, progress: &Progress) -> Result<(JournalState, BTreeSet<Job>, Vec<PathBuf>)> {
        let mut foreign = Vec::new();
        let state = match (start, JournalState::read(&self.work_dir.journal())) {
            (Start::Force, read) => {
                let known = !matches!(read, Ok(None));
                foreign = self.clear(read.ok().flatten().map(|state| state.identity).as_ref(), known)?;
                None
            }
            (_, read) => read?.map(|mut state| {
                part_folder::merge(&self.work_dir.parts(), &mut state);
                state
            }),
        };
        let refuse = |message: String| Err(Error::new(ErrorKind::File, message));
        let out = self.work_dir.out().display();
        let taken = self.work_dir.is_taken();
        match (start, state) {
            // Each message names only options that will work.
            (Start::Fresh, Some(state)) => match (self.identity.difference(&state.identity), state.finished) {
                (Some(difference), _) => refuse(format!(
                    "{out} is another build: it was started {difference}; choose another output, or replace it with --force"
                )),
                (None, Some(_)) => {
                    refuse(format!("{out} is already complete; use --resume to check it, or --force to build it again"))
                }
                (None, None) => refuse(format!(
                    "{out} is an unfinished build; use --resume to continue it, or --force to start again"
                )),
            },
            (Start::Fresh | Start::Resume, None) if taken => match (self.work_dir.foreign(), start) {
                (Some(foreign), _) => Err(foreign),
                (None, Start::Fresh) => refuse(format!("{out} already exists; use --force to replace it")),
                (None, _) => refuse(format!(
                    "{out} exists, but the journal of its build ({}) is missing, so it cannot be resumed; use --force, without --resume, to build it again",
                    self.work_dir.journal().display()
                )),
            },
            (_, Some(state)) => match self.identity.difference(&state.identity) {
                Some(difference) => refuse(format!(
                    "{out} cannot be resumed: it was started {difference}; use the same arguments, or start again with --force and without --resume"
                )),
                None => {
                    let sound = self.world.install(|| self.sound(&state, progress))?;
                    Ok((state, sound, foreign))
                }
            },
            (_, None) => Ok((JournalState::begun(self.identity.clone()), BTreeSet::new(), foreign)),
        }
    }

    /// Removes the files of the previous build, as described by its journal. Returns files that no build made; they are
    /// kept.
    fn clear(&self, before: Option<&Identity>, known: bool) -> Result<Vec<PathBuf>> {
        let new = paths(self.target.as_ref());
        // Without a readable journal, only files that would be written again count as files of a build.
        let old = before.and_then(|before| target(self.world, before, Form::named(&before.form)?).ok());
        let old = old.map_or_else(|| new.clone(), |target| paths(target.as_ref()));
        self.work_dir.clear(known, &old, &new)
    }

    /// The jobs whose files all exist and are unchanged.
    pub(super) fn sound(&self, state: &JournalState, progress: &Progress) -> Result<BTreeSet<Job>> {
        let records: Vec<(&Job, &Record)> = state.records.iter().collect();
        let checked = parallel::try_map(records, |(job, record)| -> Result<Option<Job>> {
            progress.check()?;
            let stage = self.stages.get(job.stage).filter(|stage| job.row < stage.rows && job.column < stage.columns);
            let places = if stage.is_some() { self.target.places(*job) } else { Vec::new() };
            let as_many = !places.is_empty() && places.len() == record.digests.len();
            let same = |(place, digest): (&JobFile, &FileDigest)| match (place, &state.finished) {
                // Temporary files may be missing.
                (JobFile::Scratch(_), Some(_)) => true,
                _ => digest.is_at(&self.work_dir.path(place)),
            };
            Ok((as_many && places.iter().zip(&record.digests).all(same)).then_some(*job))
        });
        Ok(checked?.into_iter().flatten().collect())
    }

    /// The report, if all files exist and are intact.
    fn is_finished(&self, state: &JournalState, sound: &BTreeSet<Job>) -> Option<Report> {
        let finished = state.finished.as_ref()?;
        let whole = finished.iter().all(|(path, digest)| digest.is_at(&self.work_dir.result(path)));
        let tiles = if self.target.assembles() { 0 } else { self.tiles().0 };
        (whole && sound.len() >= tiles).then(|| Report {
            made: 0,
            kept: self.tiles().0,
            again: 0,
            samples: FiniteCount::default(),
            foreign: Vec::new(),
            bytes: self.bytes_of(state),
            left: Vec::new(),
        })
    }

    /// The jobs to run: jobs whose part of the result is missing, and missing jobs that these depend on.
    pub(super) fn wanted(&self, sound: &BTreeSet<Job>) -> BTreeSet<Job> {
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
                    || places.iter().any(|place| matches!(place, JobFile::Result(_)));
                // After completion, temporary files count as intact unless a job reads them.
                let there = sound.contains(&job)
                    && (!read.contains(&job)
                        || places.iter().all(|place| {
                            matches!(place, JobFile::Result(_)) || fs::is_file(&self.work_dir.path(place))
                        }));
                if needed && !there {
                    wanted.insert(job);
                }
            }
        }
        wanted
    }

    /// Runs the jobs, stage by stage. Returns the count of finite samples.
    pub(super) fn make(&self, wanted: &BTreeSet<Job>, store: &OutputStore, progress: &Progress) -> Result<FiniteCount> {
        let mut count = FiniteCount::default();
        let samples = |stage: usize| {
            wanted.iter().filter(|job| job.stage == stage).map(|job| self.stages[job.stage].samples as f64).sum::<f64>()
        };
        let [mut solving, each] = self.work(wanted)?;
        let packing: f64 = (0..self.stages.len()).map(|stage| PACKING * samples(stage)).sum();
        progress.expect(solving + each * samples(0) + packing);
        for n in 0..self.stages.len() {
            let made =
                store.sending(|| self.make_stage(n, wanted, store, progress, [std::mem::take(&mut solving), each]))?;
            count = count.and(made);
        }
        Ok(count)
    }

    /// Runs the jobs of one stage; `work` is the time for solving and for making one sample, in nanoseconds.
    fn make_stage(
        &self,
        n: usize,
        wanted: &BTreeSet<Job>,
        store: &OutputStore,
        progress: &Progress,
        [mut solving, each]: [f64; 2],
    ) -> Result<FiniteCount> {
        let (stage, mut count) = (self.stages[n], FiniteCount::default());
        let tiles = wanted.iter().filter(|job| job.stage == n).map(|job| (job.row, job.column));
        if n > 0 {
            let make = |(row, column)| self.make_one(Job { stage: n, row, column }, &[], store, progress);
            parallel::try_for_each(tiles.collect::<Vec<_>>(), make)?;
            return Ok(count);
        }
        for group in self.block.groups(&tiles.collect(), stage) {
            // The first group includes the time for solving.
            let work = std::mem::take(&mut solving) + each * (group.len() * stage.samples) as f64;
            count = count.and(self.make_group(&group, store, progress, work)?);
        }
        Ok(count)
    }

    /// Approximate time, in nanoseconds, for solving and for making one sample.
    fn work(&self, wanted: &BTreeSet<Job>) -> Result<[f64; 2]> {
        let first = wanted.iter().find(|job| job.stage == 0).map(|job| (job.row, job.column));
        let Some(window) = union(self.target.as_ref(), first.into_iter()) else { return Ok([0.0; 2]) };
        let layers: Vec<&str> = self.identity.layers.iter().map(String::as_str).collect();
        let [solving, making] = self.world.work_of(&self.world.plan(&layers, &window)?)?;
        Ok([solving, making / window.len().max(1) as f64])
    }

    /// Computes the samples of adjacent tiles, with progress `work`, then makes each tile.
    fn make_group(
        &self,
        group: &[(usize, usize)],
        store: &OutputStore,
        progress: &Progress,
        work: f64,
    ) -> Result<FiniteCount> {
        let Some(window) = union(self.target.as_ref(), group.iter().copied()) else {
            return Ok(FiniteCount::default());
        };
        let layers: Vec<&str> = self.identity.layers.iter().map(String::as_str).collect();
        let beside = memory_beside(self.world, self.target.as_ref(), &layers, self.block.waiting);
        let grids = self.world.grids_beside(&layers, &window, beside, &progress.part(work))?;
        parallel::try_for_each(group, |&(row, column)| {
            let window = self.target.window(row, column);
            let tiles: Option<Vec<Grid>> = grids.iter().map(|grid| grid.crop(&window)).collect();
            let tiles = tiles.ok_or_else(|| Error::new(ErrorKind::Request, "a tile is outside its block"))?;
            self.make_one(Job { stage: 0, row, column }, &tiles, store, progress)
        })?;
        Ok(grids.iter().fold(FiniteCount::default(), |count, grid| count.and(FiniteCount::of(grid.data()))))
    }

    fn make_one(&self, job: Job, grids: &[Grid], store: &OutputStore, progress: &Progress) -> Result<()> {
        progress.check()?;
        let mut made = self.target.make(job, grids, store)?;
        if made.ranges.is_empty() {
            // Ranges also tell whether any sample is finite.
            made.ranges = grids.iter().map(range).collect();
        }
        store.keep(job, self.target.places(job), made)?;
        progress.advance(PACKING * self.stages[job.stage].samples as f64);
        Ok(())
    }

    /// Syncs the result, except for the files of jobs that are already synced, and records completion in the journal.
    /// Returns the size of the result.
    fn close(
        &self,
        store: OutputStore,
        extra: Vec<(PathBuf, FileDigest)>,
        is_synced: impl Fn(&Job) -> bool,
    ) -> Result<u64> {
        let mut records = store.into_records();
        if self.target.assembles() {
            // From now on the assembled file is checked.
            records.clear();
        }
        let mut files: Vec<JobFile> = extra.iter().map(|(path, _)| JobFile::Result(path.clone())).collect();
        for job in records.keys().filter(|job| !is_synced(job)) {
            let places = self.target.places(*job).into_iter();
            files.extend(places.filter(|place| matches!(place, JobFile::Result(_))));
        }
        self.work_dir.sync(&files)?;
        let state = JournalState { records, finished: Some(extra), ..JournalState::begun(self.identity.clone()) };
        Journal::write(&self.work_dir.journal(), &self.work_dir.temporary(0), &state)?;
        Ok(self.bytes_of(&state))
    }

    /// The size of the files of the result that a journal lists, in bytes.
    pub(super) fn bytes_of(&self, state: &JournalState) -> u64 {
        let extra = state.finished.iter().flatten().map(|(_, digest)| digest.length);
        let of = |(job, record): (&Job, &Record)| -> u64 {
            let places = self.target.places(*job);
            let own = places.iter().zip(&record.digests).filter(|(place, _)| matches!(place, JobFile::Result(_)));
            sum(own.map(|(_, digest)| digest.length))
        };
        sum(state.records.iter().map(of).chain(extra))
    }
}

/// The sum of lengths, without overflow: a journal may contain any numbers.
fn sum(lengths: impl Iterator<Item = u64>) -> u64 {
    lengths.fold(0, u64::saturating_add)
}

/// The target for an identity.
fn target(world: &World, identity: &Identity, form: Form) -> Result<Box<dyn BuildTarget>> {
    let (about, sea_level) = (&world.recipe().about, world.recipe().world.sea_level);
    Ok(match form {
        Form::Cog => Box::new(Cog::new(identity)?),
        Form::Zarr => Box::new(Zarr::new(identity, about)?),
        Form::Tiles(samples) => Box::new(Folder::new(identity, samples, about, sea_level)?),
        Form::Xyz(encoding) => Box::new(Tree::new(world, identity, encoding)?),
        Form::Pmtiles(encoding) => Box::new(Pmtiles::new(world, identity, encoding)?),
    })
}

/// The first and the last sample of a window.
fn corners(window: &Window) -> [Window; 2] {
    let one = Window { width: 1, height: 1, ..*window };
    [one, Window { x: window.right() - 1, y: window.bottom() - 1, ..one }]
}

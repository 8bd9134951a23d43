//! Running one part of a build. The call that completes the last part finishes the result.
//!
//! Parts share the folder next to the result, and need no other communication. The journal of the build states the
//! number of parts. Each part writes the tiles of its share, syncs them, and marks itself as complete. Then, with the
//! lock of all parts, it looks whether all are complete; if so, it makes everything that needs more than one part, and
//! writes the journal of a complete build. After a kill at any moment, the same call goes on.

use std::collections::{BTreeMap, BTreeSet};

use orogen_grid::parallel;

use super::digest::FileDigest;
use super::job::{Job, JobFile, Record};
use super::journal::{Journal, JournalState};
use super::output_store::OutputStore;
use super::part::Part;
use super::part_folder::{self, PartFolder};
use super::run::{Build, Report, Start};
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::progress::Progress;
use orogen_io::fs::{self, File};

fn refuse<T>(message: String) -> Result<T> {
    Err(Error::new(ErrorKind::File, message))
}

impl Build<'_> {
    /// Runs one part.
    pub(super) fn run_part(&self, part: Part, start: Start, progress: &Progress) -> Result<Report> {
        let out = self.work_dir.out().display();
        if start == Start::Force {
            let message = format!(
                "--part cannot be used with --force, which would remove what the other parts made; remove {out} and {} first, or choose another output",
                self.work_dir.beside().display()
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        // Before anything is created.
        self.begun(part)?;
        let _shared = self.work_dir.share()?;
        let folder = PartFolder::new(&self.work_dir.parts(), part);
        let (running, begun) = loop {
            if let Some(report) = self.completed(self.begun(part)?.as_ref())? {
                return Ok(report);
            }
            if let Some(entered) = self.enter(part, &folder, progress)? {
                break entered;
            }
        };
        let report = {
            let _running = running;
            let mut report = self.make_share(part, &folder, &begun, progress)?;
            self.finish_parts(part, &folder, &mut report, progress)?;
            report
        };
        if report.left.is_empty() {
            // Files that another part has just opened may stay; whoever runs next removes them.
            let _ = self.work_dir.sweep();
        }
        Ok(report)
    }

    /// The journal of the build.
    fn begun(&self, part: Part) -> Result<Option<JournalState>> {
        // A network file system may remember that there was no journal. Opening the folder makes it ask again.
        drop(fs::read_dir(self.work_dir.beside()));
        // In this order, because another part may begin the build now: it writes the journal before any tile.
        let is_taken = self.work_dir.is_taken();
        let state = JournalState::read(&self.work_dir.journal())?;
        let out = self.work_dir.out().display();
        let Some(state) = state else {
            return match is_taken {
                true => refuse(format!(
                    "{out} already exists, and is not an unfinished build; remove it first, or choose another output"
                )),
                false => Ok(None),
            };
        };
        if let Some(difference) = self.identity.difference(&state.identity) {
            return refuse(format!(
                "{out} is another build: it was started {difference}; start all parts with the same arguments, or choose another output"
            ));
        }
        match state.parts {
            Some(count) if count != part.count && state.finished.is_none() => refuse(format!(
                "{out} was started in {count} parts, not in {}; use --part K/{count}, or finish it in one process with --resume and without --part",
                part.count
            )),
            _ => Ok(Some(state)),
        }
    }

    /// The report, if the result is complete.
    fn completed(&self, state: Option<&JournalState>) -> Result<Option<Report>> {
        let Some((state, finished)) = state.and_then(|state| Some((state, state.finished.as_ref()?))) else {
            return Ok(None);
        };
        for (path, digest) in finished {
            let path = self.work_dir.result(path);
            if !digest.has_length_of(&path) {
                return refuse(format!(
                    "{} is missing or damaged, although the build was finished; repair it with --resume and without --part",
                    path.display()
                ));
            }
        }
        let _ = self.work_dir.sweep();
        Ok(Some(Report { kept: self.tiles().0, bytes: self.bytes_of(state), ..Report::default() }))
    }

    /// Begins the build, if no other part has, and locks the part. Returns the lock and the journal of the build;
    /// `None` if the build has been finished.
    fn enter(&self, part: Part, folder: &PartFolder, progress: &Progress) -> Result<Option<(File, JournalState)>> {
        folder.create()?;
        let Some(_all) = folder.lock(progress)? else { return Ok(None) };
        let state = self.begun(part)?;
        if state.as_ref().is_some_and(|state| state.finished.is_some()) {
            return Ok(None);
        }
        let running = folder.hold(self.work_dir.out())?;
        self.work_dir.tidy()?;
        self.work_dir.furnish()?;
        let is_new = state.as_ref().is_none_or(|state| state.parts.is_none());
        let state = state.unwrap_or_else(|| JournalState::begun(self.identity.clone()));
        let state = JournalState { parts: Some(part.count), ..state };
        if is_new {
            folder.clear()?;
            let journal = self.work_dir.journal();
            let begun = Journal::write(&journal, &self.work_dir.temporary(0), &state);
            if begun.is_err() && self.work_dir.is_remote() && fs::is_file(&journal) {
                // Without locks, another part may have begun the build at the same time.
                return Ok(None);
            }
            begun?;
        }
        Ok(Some((running, state)))
    }

    /// Makes the tiles of a part that do not exist, and marks it as complete.
    fn make_share(&self, part: Part, folder: &PartFolder, begun: &JournalState, progress: &Progress) -> Result<Report> {
        let share = self.share();
        let (journal, done) = (folder.journal(part.number), folder.done(part.number));
        let own = folder.own(&self.identity);
        // Tiles may have been made before the build was continued in parts.
        let records = begun.records.clone().into_iter().chain(own.into_iter().flat_map(|state| state.records));
        let records: BTreeMap<Job, Record> = records.filter(|(job, _)| share.contains(job)).collect();
        let is_there = |job: &Job| records.get(job).is_some_and(|record| self.has_lengths(*job, record));
        let mut report = Report { kept: share.len(), ..Report::default() };
        if folder.is_done() && share.iter().all(is_there) {
            return Ok(report);
        }
        folder.revoke(part.number)?;
        let mut state = JournalState { records, ..JournalState::begun(self.identity.clone()) };
        let sound = self.world.install(|| self.sound(&state, progress))?;
        let wanted: BTreeSet<Job> = share.difference(&sound).copied().collect();
        let lines = Journal::write(&journal, &self.work_dir.temporary(0), &state)?;
        let store = OutputStore::new(&self.work_dir, lines, state.records, self.put.as_ref());
        let samples = self.world.install(|| self.make(&wanted, &store, progress))?;
        progress.check()?;
        (report.made, report.kept) = (wanted.len(), sound.len());
        // A part without finite samples is no error; a layer without is found at the end.
        report.samples = if samples.finite > 0 { samples } else { FiniteCount::default() };
        state.records = store.into_records();
        report.bytes = self.bytes_of(&state);
        let files: Vec<JobFile> = share.iter().flat_map(|job| self.target.places(*job)).collect();
        self.work_dir.sync(&files)?;
        Journal::write(&done, &self.work_dir.temporary(0), &state)?;
        fs::remove_file(&journal).map_err(|cause| Error::file("remove", &journal, &cause))?;
        self.work_dir.tidy()?;
        Ok(report)
    }

    /// Finishes the result, if all parts are complete; otherwise enters the others in the report.
    fn finish_parts(&self, part: Part, folder: &PartFolder, report: &mut Report, progress: &Progress) -> Result<()> {
        let lock = folder.lock(progress)?;
        let state = self.begun(part)?;
        if let Some(complete) = self.completed(state.as_ref())? {
            report.bytes = complete.bytes;
            return Ok(());
        }
        let (Some(_all), Some(state)) = (lock, state) else {
            return refuse(format!("{} was removed while parts were running", self.work_dir.beside().display()));
        };
        report.left = folder.missing();
        if !report.left.is_empty() {
            return Ok(());
        }
        let mut tiles = Vec::new();
        for number in 1..=part.count {
            match part_folder::read(&folder.done(number), &self.identity) {
                Some(done) => tiles.extend(done.records.into_iter().map(|(job, record)| (number, job, record))),
                None => report.left.push(number),
            }
        }
        // Parts are trusted, but files may have been removed since. A part that lost some has to run again.
        let lost = self.world.install(|| {
            parallel::try_map(&tiles, |(number, job, record)| -> Result<Option<usize>> {
                progress.check()?;
                Ok((!self.has_lengths(*job, record)).then_some(*number))
            })
        })?;
        report.left.extend(lost.into_iter().flatten().collect::<BTreeSet<usize>>());
        report.left.sort_unstable();
        if !report.left.is_empty() {
            return report.left.iter().try_for_each(|number| folder.revoke(*number));
        }
        let mut sound: BTreeSet<Job> = tiles.iter().map(|(_, job, _)| *job).collect();
        let synced = sound.clone();
        // What an interrupted call made of the tiles.
        let later = state.records.into_iter().filter(|(job, _)| job.stage > 0).collect();
        let mut whole = JournalState { records: later, finished: None, ..state };
        sound.extend(self.world.install(|| self.sound(&whole, progress))?);
        whole.records.extend(tiles.into_iter().map(|(_, job, record)| (job, record)));
        self.work_dir.furnish()?;
        let wanted = self.wanted(&sound);
        let finished = self.finish(&wanted, &whole, &synced, progress);
        if finished.is_err()
            && self.work_dir.is_remote()
            && let Some(complete) = self.completed(self.begun(part)?.as_ref())?
        {
            // Without locks, another part may have finished the result, and removed temporary files.
            report.bytes = complete.bytes;
            return Ok(());
        }
        let (samples, bytes) = finished?;
        report.made += wanted.len();
        report.samples = report.samples.and(samples);
        report.bytes = bytes;
        Ok(())
    }

    /// Whether the files of a job exist and have the lengths of its record. Objects are not looked at: one request for
    /// each tile of all parts would take too long.
    fn has_lengths(&self, job: Job, record: &Record) -> bool {
        let places = self.target.places(job);
        let is_remote = self.work_dir.is_remote();
        let same =
            |(place, digest): (&JobFile, &FileDigest)| is_remote || digest.has_length_of(&self.work_dir.path(place));
        places.len() == record.digests.len() && places.iter().zip(&record.digests).all(same)
    }
}

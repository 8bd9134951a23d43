//! Exports: what is chosen in the dialogue, the same as a command line, and the work.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, channel};

use orogen::export::format::Format;
use orogen::export::job::ExportJob;
use orogen::export::options::{Options, ValueKind};
use orogen::export::registry;
use orogen::file::OutputPolicy;
use orogen::recipe::document::Recipe;
use orogen::words::number;
use orogen::world::HEIGHT;
use orogen::{Progress, Result, Session, World};

use crate::preview::region::Region;
use crate::preview::worker::Wake;

/// What is to be exported.
#[derive(Debug, Clone)]
pub struct Export {
    /// The format.
    pub format: &'static Format,
    /// The layer.
    pub layer: String,
    /// Samples along the longer side; `None` for the world's own cell.
    pub size: Option<usize>,
    /// The part of the world.
    pub region: Region,
    /// Options of the format as texts, by their names.
    pub options: BTreeMap<&'static str, String>,
    /// The file.
    pub path: PathBuf,
}

/// Samples along a side of an unbounded world, unless another size is asked for.
const UNBOUNDED: usize = 1024;

impl Export {
    /// The heights in a format.
    #[must_use]
    pub fn new(format: &'static Format, region: Region) -> Export {
        Export {
            format,
            layer: HEIGHT.into(),
            size: None,
            region,
            options: BTreeMap::new(),
            path: PathBuf::from(format!("out.{}", format.name)),
        }
    }

    /// Another format; options that it lacks are dropped, and the file gets its extension.
    pub fn set_format(&mut self, format: &'static Format) {
        self.format = format;
        self.options.retain(|name, _| format.knows(name));
        self.path.set_extension(format.name);
    }

    fn job(&self) -> Result<ExportJob> {
        let mut options = Options::default();
        for spec in self.format.options {
            if let Some(text) = self.options.get(spec.name) {
                options.give(spec, text)?;
            }
        }
        let job = ExportJob::new(self.format).with_layer(&self.layer).with_options(options);
        job.check()?;
        Ok(job)
    }

    /// The command line that makes the same file. `recipe` names the recipe's file or preset.
    #[must_use]
    pub fn command_line(&self, recipe: &str) -> String {
        let mut words = vec![
            "orogen".to_owned(),
            "export".into(),
            quoted(recipe),
            "-o".into(),
            quoted(&self.path.to_string_lossy()),
        ];
        if registry::of_path(&self.path).map_or(true, |format| format.name != self.format.name) {
            words.extend(["--format".into(), self.format.name.into()]);
        }
        if self.layer != HEIGHT {
            words.extend(["--layer".into(), quoted(&self.layer)]);
        }
        match self.region {
            Region::Whole => {
                if let Some(size) = self.size {
                    words.extend(["--size".into(), size.to_string()]);
                }
            }
            Region::Square { center, side } => {
                // The window that the work takes, in samples.
                let samples = self.size.unwrap_or(UNBOUNDED);
                let cell = side / samples as f64;
                let first = center.map(|center| ((center - side / 2.0) / cell).round() as i64);
                words.extend([
                    "--cell".into(),
                    number(cell),
                    "--window".into(),
                    format!("{},{},{samples},{samples}", first[0], first[1]),
                ]);
            }
        }
        for spec in self.format.options {
            if let Some(text) = self.options.get(spec.name) {
                words.push(format!("--{}", spec.name));
                if spec.value_kind != ValueKind::Nothing {
                    words.push(quoted(text));
                }
            }
        }
        words.join(" ")
    }

    /// Makes the file.
    ///
    /// # Errors
    /// If an option is not valid, or the export fails; then there is no file, or that which was there.
    pub fn run(
        &self,
        session: &Session,
        mut recipe: Recipe,
        own: Option<&Path>,
        progress: &Progress,
    ) -> Result<String> {
        let job = self.job()?;
        job.prepare(&mut recipe)?;
        let files = recipe.files();
        let world = session.open(recipe)?;
        let job = match self.window(&world)? {
            Some(window) => job.with_window(window),
            None => job,
        };
        let policy = OutputPolicy::default().protecting(files).protecting(own);
        Ok(job.to_file(&world, &policy.output(&self.path)?, progress)?.words)
    }

    fn window(&self, world: &World) -> Result<Option<orogen::Window>> {
        match (self.region, self.size) {
            (Region::Whole, None) => Ok(None),
            (Region::Whole, Some(size)) => world.window_fitting(size).map(Some),
            (region, size) => region.window(world, size.unwrap_or(UNBOUNDED)).map(Some),
        }
    }
}

/// A word of a command line, in quotes if a shell would read it otherwise.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "_-./,:=@+%".contains(c);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

/// An export that is being made.
pub struct Running {
    progress: Progress,
    share: Arc<AtomicU32>,
    result: Receiver<Result<String>>,
}

impl Running {
    /// Starts an export on a thread of the session.
    ///
    /// # Errors
    /// If no thread can be started.
    pub fn start(
        export: Export,
        recipe: Recipe,
        own: Option<PathBuf>,
        session: &Session,
        wake: Wake,
    ) -> Result<Running> {
        let share = Arc::new(AtomicU32::new(0));
        let (heard, told) = (Arc::clone(&share), Arc::clone(&wake));
        let progress = Progress::new(move |done| {
            heard.store((done * 1000.0) as u32, Ordering::Relaxed);
            told();
        });
        let (sender, result) = channel();
        let own_progress = progress.clone();
        session.start(move |session| {
            // The dialogue may be closed.
            let _ = sender.send(export.run(session, recipe, own.as_deref(), &own_progress));
            wake();
        })?;
        Ok(Running { progress, share, result })
    }

    /// The share that is done, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f32 {
        self.share.load(Ordering::Relaxed) as f32 / 1000.0
    }

    /// Asks the work to end.
    pub fn cancel(&self) {
        self.progress.cancel();
    }

    /// What it has led to, once it has ended: a description of the file.
    #[must_use]
    pub fn result(&self) -> Option<Result<String>> {
        self.result.try_recv().ok()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.cancel();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::presets;
    use orogen::test_folder::TestFolder;

    #[test]
    fn command_lines_are_quoted() {
        let mut export = Export::new(registry::named("png").unwrap(), Region::Whole);
        assert_eq!(export.command_line("classic"), "orogen export classic -o out.png");
        export.size = Some(300);
        export.layer = "slope".into();
        export.options.insert("bits", "8".into());
        export.path = "my map's.png".into();
        assert_eq!(
            export.command_line("a b.toml"),
            "orogen export 'a b.toml' -o 'my map'\\''s.png' --layer slope --size 300 --bits 8"
        );
        export.set_format(registry::named("npy").unwrap());
        assert!(export.options.is_empty() && export.path.ends_with("my map's.npy"));
        export.region = Region::Square { center: [1000.0, 500.0], side: 2000.0 };
        export.size = Some(200);
        assert!(export.command_line("endless").ends_with("--cell 10 --window 0,-50,200,200"));
    }

    #[test]
    fn an_export_has_the_samples_of_the_world() {
        let folder = TestFolder::new("studio-export").unwrap();
        let session = Session::new(orogen::Options::default()).unwrap();
        let recipe = presets::find("classic").unwrap().recipe().unwrap();
        let mut export = Export::new(registry::named("r32").unwrap(), Region::Whole);
        (export.size, export.path) = (Some(64), folder.join("heights.r32"));
        export.run(&session, recipe.clone(), None, &Progress::none()).unwrap();
        let bytes = std::fs::read(&export.path).unwrap();
        let world = session.open(recipe).unwrap();
        let grid = world.window(HEIGHT, &world.window_fitting(64).unwrap()).unwrap();
        let expect: Vec<u8> = grid.data().iter().flat_map(|height| height.to_le_bytes()).collect();
        assert!(bytes == expect);
    }
}

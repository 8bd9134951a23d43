//! Policies for replacing files.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::identity::FileId;
use super::kind::Found;
use crate::fs;
use orogen_grid::error::{Error, ErrorKind, Result};

/// How existing files are treated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Existing {
    /// Existing files are never replaced.
    Keep,
    /// An existing file is replaced if it has the kind of the new one.
    #[default]
    SameKind,
    /// Existing files of any kind are replaced.
    Replace,
}

/// The files that an output may replace.
///
/// A file that the work reads (also under another name, through symbolic or hard links), or a recipe written or changed
/// by hand, is never replaced.
///
/// ```
/// use orogen_io::file::{Existing, OutputPolicy, write_whole};
///
/// let path = std::env::temp_dir().join(format!("orogen-doc-policy-{}.npy", std::process::id()));
/// std::fs::write(&path, "notes of a person")?;
/// assert!(OutputPolicy::default().output(&path).is_err());
/// let output = OutputPolicy::new(Existing::Replace).output(&path)?;
/// write_whole(&output, |out| out.write_all(b"\x93NUMPY..."))?;
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct OutputPolicy {
    existing: Existing,
    inputs: Arc<Vec<FileId>>,
}

impl OutputPolicy {
    /// A policy for work that reads no files.
    #[must_use]
    pub fn new(existing: Existing) -> OutputPolicy {
        OutputPolicy { existing, inputs: Arc::default() }
    }

    /// The same policy for work that also reads these files. Paths that do not exist or are not files are ignored.
    pub fn protecting<P: AsRef<Path>>(mut self, inputs: impl IntoIterator<Item = P>) -> OutputPolicy {
        let more = inputs.into_iter().filter_map(|path| FileId::of(path.as_ref()));
        Arc::make_mut(&mut self.inputs).extend(more);
        self
    }

    /// The treatment of existing files.
    #[must_use]
    pub fn existing(&self) -> Existing {
        self.existing
    }

    /// An output at `path`.
    ///
    /// # Errors
    /// If the existing file may not be replaced. Make all outputs before the work begins.
    pub fn output(&self, path: impl Into<PathBuf>) -> Result<Output> {
        let output = Output { path: path.into(), policy: self.clone() };
        output.check(None)?;
        Ok(output)
    }

    /// Whether the work reads this file.
    #[must_use]
    pub fn is_input(&self, path: &Path) -> bool {
        FileId::of(path).is_some_and(|there| self.inputs.iter().any(|input| input.is(&there)))
    }
}

/// A path to write to, with its policy. Only [`OutputPolicy::output`] makes one.
#[derive(Debug, Clone)]
pub struct Output {
    path: PathBuf,
    policy: OutputPolicy,
}

impl Output {
    /// The path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The policy.
    #[must_use]
    pub fn policy(&self) -> &OutputPolicy {
        &self.policy
    }

    /// Checks that the existing file may be replaced. `new` is the written file that will replace it, if it already
    /// exists.
    #[doc(hidden)]
    pub fn check(&self, new: Option<&Path>) -> Result<()> {
        let path = &self.path;
        let refuse = |why: String| Err(Error::new(ErrorKind::File, format!("cannot write {}: {why}", path.display())));
        if fs::is_read_only(path) {
            return refuse(
                "files on HTTP servers are only read; write to a file, or to an object of s3://, gs:// or az://".into(),
            );
        }
        // Paths that are not files are rejected or written directly when they are opened.
        let Some(there) = FileId::of(path) else { return Ok(()) };
        if self.policy.inputs.iter().any(|input| input.is(&there)) {
            return refuse("this command reads that file; choose another name".into());
        }
        if self.policy.existing == Existing::Keep {
            return refuse("it already exists, and --no-clobber is set; choose another name".into());
        }
        let found = Found::at(path).map_err(|cause| Error::file("write", path, &cause))?;
        if found == Found::Recipe {
            return refuse(
                "it is a recipe that was written or edited by hand, which is never replaced; choose another name, or move it away"
                    .into(),
            );
        }
        if self.policy.existing == Existing::Replace {
            return Ok(());
        }
        let new = new.and_then(|new| Found::at(new).ok());
        match found.differs(path, new) {
            Some(kind) => refuse(format!(
                "it exists and is {}, not {kind}; choose another name, or replace it with --force",
                found.name()
            )),
            None => Ok(()),
        }
    }

    /// Whether existing files are never replaced.
    pub(super) fn keeps(&self) -> bool {
        self.policy.existing == Existing::Keep
    }
}

#[cfg(test)]
mod tests {
    use super::super::{mark, stage, write_whole};
    use super::*;

    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Folder {
            let path = std::env::temp_dir().join(format!("orogen-policy-{}-{name}", std::process::id()));
            let _ = fs::remove_dir_all(&path);
            fs::create_dir_all(&path).unwrap();
            Folder(path)
        }

        fn with(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
            let path = self.0.join(name);
            fs::write(&path, content).unwrap();
            path
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    const POLICIES: [Existing; 3] = [Existing::Keep, Existing::SameKind, Existing::Replace];

    fn refusal(policy: &OutputPolicy, path: &Path) -> String {
        let error = policy.output(path).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::File);
        error.to_string()
    }

    #[test]
    fn an_input_is_never_replaced_whatever_leads_to_it() {
        let folder = Folder::new("input");
        let input = folder.with("a.npy", b"\x93NUMPY");
        fs::hard_link(&input, folder.0.join("hard.npy")).unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink("a.npy", folder.0.join("soft.npy")).unwrap();
        for existing in POLICIES {
            let policy = OutputPolicy::new(existing).protecting([&input, &folder.0.join("none.npy")]);
            for name in ["a.npy", "hard.npy", if cfg!(unix) { "soft.npy" } else { "a.npy" }] {
                assert!(refusal(&policy, &folder.0.join(name)).contains("this command reads that file"), "{name}");
            }
            policy.output(folder.0.join("b.npy")).unwrap();
        }
    }

    #[test]
    fn only_recipes_of_its_own_are_replaced() {
        let folder = Folder::new("recipe");
        let own = mark::marked("# Made.\norogen = 1\n");
        for (text, allowed) in [
            (own.clone(), [false, true, true]),
            (own.replace("orogen = 1", "orogen  = 1"), [false; 3]),
            ("# mine\norogen = 1\n".to_string(), [false; 3]),
            ("{ \"orogen\": 1 }".to_string(), [false; 3]),
            ("[package]\nname = \"x\"\n".to_string(), [false, false, true]),
        ] {
            let path = folder.with("recipe.toml", &text);
            for (existing, allowed) in POLICIES.into_iter().zip(allowed) {
                let done = OutputPolicy::new(existing).output(&path);
                assert_eq!(done.is_ok(), allowed, "{existing:?}: {done:?} over {text}");
            }
        }
        // Also if its extension is that of a picture.
        let path = folder.with("a.png", "orogen = 1\n");
        assert!(refusal(&OutputPolicy::new(Existing::Replace), &path).contains("by hand"));
    }

    #[test]
    fn what_appears_meanwhile_is_kept() {
        let folder = Folder::new("meanwhile");
        for (existing, content, expect) in [
            (Existing::Keep, &b"\x93NUMPY"[..], "already exists"),
            (Existing::SameKind, b"notes", "it exists and is text, not a NumPy array"),
        ] {
            let path = folder.0.join("a.npy");
            let _ = fs::remove_file(&path);
            let output = OutputPolicy::new(existing).output(&path).unwrap();
            let staged = stage(&output, |out| out.write_all(b"\x93NUMPY.")).unwrap();
            fs::write(&path, content).unwrap();
            let error = staged.commit().unwrap_err().to_string();
            assert!(error.contains(expect), "{error}");
            assert_eq!(fs::read(&path).unwrap(), content);
        }
        assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 1);
    }

    #[test]
    fn where_a_name_tells_nothing_content_does() {
        let folder = Folder::new("nameless");
        let write = |bytes: &'static [u8]| {
            let output = OutputPolicy::default().output(folder.0.join("data"))?;
            write_whole(&output, |out| out.write_all(bytes))
        };
        write(b"\x93NUMPY 1").unwrap();
        write(b"\x93NUMPY 2").unwrap();
        assert!(write(b"a text").unwrap_err().to_string().contains("it exists and is a NumPy array, not text"));
        assert_eq!(fs::read(folder.0.join("data")).unwrap(), b"\x93NUMPY 2");
    }
}

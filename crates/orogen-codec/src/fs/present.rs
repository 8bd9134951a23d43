//! The items of `std::fs` that Orogen uses, for files of the system and for [objects](super::objects).

use std::fs as system;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::objects::{self, is_remote, url};
use metadata::{About, Listing};

mod file;
mod metadata;

pub use file::{File, OpenOptions};
pub use metadata::{DirEntry, FileType, Metadata, Permissions, ReadDir};
pub use system::TryLockError;

/// The error for what objects do not have.
fn unsupported<T>(why: &str) -> io::Result<T> {
    Err(io::Error::new(io::ErrorKind::Unsupported, why))
}

macro_rules! functions {
    ($($name:ident($path:ident) -> $made:ty: $remote:expr;)+) => {$(
        #[doc = concat!("As `std::fs::", stringify!($name), "`.\n\n# Errors\nAs there.")]
        pub fn $name($path: impl AsRef<Path>) -> io::Result<$made> {
            let $path = $path.as_ref();
            match is_remote($path) {
                true => $remote,
                false => system::$name($path),
            }
        }
    )+};
}

functions! {
    canonicalize(path) -> PathBuf: Ok(PathBuf::from(url(path)?));
    create_dir(path) -> (): match objects::store()?.list(&url(path)?)?.is_empty() {
        true => Ok(()),
        false => Err(io::ErrorKind::AlreadyExists.into()),
    };
    create_dir_all(path) -> (): objects::store().map(drop);
    read(path) -> Vec<u8>: objects::store()?.read(&url(path)?, None, None);
    remove_dir(path) -> (): objects::store().map(drop);
    remove_dir_all(path) -> (): objects::store()?.remove_all(&url(path)?);
    remove_file(path) -> (): objects::store()?.remove(&url(path)?);
}

/// As `std::fs::read_to_string`.
///
/// # Errors
/// As there.
pub fn read_to_string(path: impl AsRef<Path>) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|cause| io::Error::new(io::ErrorKind::InvalidData, cause))
}

/// As `std::fs::metadata`.
///
/// # Errors
/// As there.
pub fn metadata(path: impl AsRef<Path>) -> io::Result<Metadata> {
    let path = path.as_ref();
    if !is_remote(path) {
        return Ok(Metadata(About::Local(system::metadata(path)?)));
    }
    let (store, url) = (objects::store()?, url(path)?);
    match store.info(&url) {
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => match store.list(&url) {
            Ok(entries) if !entries.is_empty() => Ok(Metadata(About::Remote(None))),
            _ => Err(cause),
        },
        info => Ok(Metadata(About::Remote(Some(info?)))),
    }
}

/// As `std::fs::symlink_metadata`.
///
/// # Errors
/// As there.
pub fn symlink_metadata(path: impl AsRef<Path>) -> io::Result<Metadata> {
    let path = path.as_ref();
    match is_remote(path) {
        true => metadata(path),
        false => Ok(Metadata(About::Local(system::symlink_metadata(path)?))),
    }
}

/// As `std::fs::read_dir`. A folder of objects that does not exist is empty.
///
/// # Errors
/// As there.
pub fn read_dir(path: impl AsRef<Path>) -> io::Result<ReadDir> {
    let path = path.as_ref();
    Ok(ReadDir(match is_remote(path) {
        true => Listing::Remote(path.to_path_buf(), objects::store()?.list(&url(path)?)?.into_iter()),
        false => Listing::Local(system::read_dir(path)?),
    }))
}

/// As `std::fs::rename`. A file can become an object.
///
/// # Errors
/// As there.
pub fn rename(from: impl AsRef<Path>, to: impl AsRef<Path>) -> io::Result<()> {
    let (from, to) = (from.as_ref(), to.as_ref());
    match (is_remote(from), is_remote(to)) {
        (false, false) => return system::rename(from, to),
        (false, true) => objects::upload(from, to, false)?,
        (true, true) => objects::copy(from, to)?,
        (true, false) => return unsupported("an object cannot be moved into a folder of the system"),
    }
    remove_file(from)
}

/// As `std::fs::hard_link`. To an object, the file is copied; an existing object is not replaced.
///
/// # Errors
/// As there.
pub fn hard_link(from: impl AsRef<Path>, to: impl AsRef<Path>) -> io::Result<()> {
    let (from, to) = (from.as_ref(), to.as_ref());
    match (is_remote(from), is_remote(to)) {
        (false, false) => system::hard_link(from, to),
        (false, true) => objects::upload(from, to, true),
        (true, _) => unsupported("objects have no links"),
    }
}

/// Writes a file that must not exist.
///
/// # Errors
/// [`io::ErrorKind::AlreadyExists`] if it exists, or if it cannot be written.
pub fn write_new(path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    let (path, bytes) = (path.as_ref(), bytes.as_ref());
    match is_remote(path) {
        true => objects::store()?.write(&url(path)?, &mut &bytes[..], bytes.len() as u64, true),
        false => OpenOptions::new().write(true).create_new(true).open(path)?.write_all(bytes),
    }
}

/// As `std::fs::write`.
///
/// # Errors
/// As there.
pub fn write(path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    let (path, bytes) = (path.as_ref(), bytes.as_ref());
    match is_remote(path) {
        true => objects::store()?.write(&url(path)?, &mut &bytes[..], bytes.len() as u64, false),
        false => system::write(path, bytes),
    }
}

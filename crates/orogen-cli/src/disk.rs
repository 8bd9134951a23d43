//! Free space on disks.

use std::path::Path;

use orogen::{Error, ErrorKind, grid::words};

/// Free space, in bytes, on the disk that contains or would contain `path`; `None` if the system does not provide it,
/// and for objects.
pub fn free_at(path: &Path) -> Option<u64> {
    if orogen::io::fs::is_remote(path) {
        return None;
    }
    let real = path.ancestors().find_map(|path| match path.as_os_str().is_empty() {
        true => Path::new(".").canonicalize().ok(),
        false => path.canonicalize().ok(),
    })?;
    free_in(&real)
}

/// Asks the file system itself: lists of disks lack file systems in memory, and the prefix of a path does not determine
/// where it is mounted.
#[cfg(unix)]
fn free_in(folder: &Path) -> Option<u64> {
    let there = rustix::fs::statvfs(folder).ok()?;
    there.f_bavail.checked_mul(there.f_frsize)
}

#[cfg(not(unix))]
fn free_in(folder: &Path) -> Option<u64> {
    let disks = sysinfo::Disks::new_with_refreshed_list().ok()?;
    let holding = disks.iter().filter(|disk| folder.starts_with(disk.mount_point()));
    holding.max_by_key(|disk| disk.mount_point().components().count()).map(sysinfo::Disk::available_space)
}

/// Fails before the work starts if the disk of `path` has less than `needed` bytes.
pub fn afford(path: &Path, needed: u64, free: Option<u64>) -> Result<(), Error> {
    match free {
        Some(free) if needed > free => {
            let [needed, free] = words::bytes_apart(needed, free);
            let path = path.display();
            let message = format!(
                "not enough disk space for {path}: up to {needed} needed, {free} free; free some space, or write to another disk"
            );
            Err(Error::new(ErrorKind::File, message))
        }
        _ => Ok(()),
    }
}

/// Fails if the disk of `path` has less than `needed` bytes. An existing object that is not a file, such as a pipe, has
/// no limit.
pub fn afford_file(path: &Path, needed: u64) -> Result<(), Error> {
    match path.metadata() {
        Ok(there) if !there.is_file() => Ok(()),
        _ => afford(path, needed, free_at(path)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_some() {
        let folder = std::env::temp_dir();
        let free = free_at(&folder.join("not/yet/there"));
        assert!(free.is_some_and(|free| free > 0), "{free:?}");
        assert_eq!(free.is_some(), free_at(Path::new("x")).is_some());
        assert!(afford(&folder, 2, Some(1)).unwrap_err().to_string().contains("1 byte free"));
        // Compares with the output of `df` for every mounted file system, including those in memory.
        #[cfg(unix)]
        for mounted in ["/", "/dev/shm", "/run", "/tmp", "."] {
            let free = || free_at(&Path::new(mounted).join("not/yet/there")).unwrap() as f64 / 1024.0;
            let before = free();
            let output = std::process::Command::new("df").args(["-P", "-k", mounted]).output();
            let Some(output) = output.ok().filter(|output| output.status.success()) else { continue };
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            let expect: f64 = text.lines().last().unwrap().split_whitespace().nth(3).unwrap().parse().unwrap();
            // Other processes may write between the calls.
            let (after, slack) = (free(), 0.05 * expect + 65536.0);
            let range = before.min(after) - slack..=before.max(after) + slack;
            assert!(range.contains(&expect), "{mounted}: {before} to {after} KiB, df says {expect}");
        }
        assert!(afford(&folder, 1, Some(1)).is_ok() && afford(&folder, u64::MAX, None).is_ok());
    }
}

//! How much memory may be used.

use orogen::{Error, ErrorKind, words};
use sysinfo::{Pid, ProcessRefreshKind, ProcessesToUpdate, System};

use crate::size::Bytes;

/// Half of what is free, to the machine or to the container this runs in, whichever is less; `None` if the system does not
/// tell.
pub fn share_of_free() -> Option<u64> {
    let mut system = System::new().ok()?;
    system.refresh_memory();
    let pid = Pid::from_u32(std::process::id());
    system.refresh_processes_specifics(ProcessesToUpdate::Some(&[pid]), false, ProcessRefreshKind::nothing());
    let limits = [system.cgroup_limits(), system.process(pid).and_then(|process| process.cgroup_limits())];
    limits
        .into_iter()
        .flatten()
        // What a container has free does not count the file cache it could drop, so take what is really held.
        .map(|limits| limits.total_memory.saturating_sub(limits.rss))
        .chain([system.available_memory()])
        .filter(|&free| free > 0)
        .min()
        .map(|free| free / 2)
}

/// Refuses work that needs more bytes than `allowed`, or than [`share_of_free`] if nobody says: nothing starts that cannot
/// finish.
pub fn afford(needed: u64, allowed: Option<Bytes>) -> Result<(), Error> {
    match allowed.map(|bytes| bytes.0).or_else(share_of_free) {
        Some(allowed) if needed > allowed => Err(Error::new(
            ErrorKind::Memory,
            format!(
                "this needs up to {} of memory and {} is allowed: ask for fewer samples, or allow more",
                words::bytes(needed),
                words::bytes(allowed)
            ),
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn there_is_some_and_not_all() {
        let share = super::share_of_free().unwrap();
        let mut system = sysinfo::System::new().unwrap();
        system.refresh_memory();
        assert!(share > 0 && share < system.total_memory(), "{share}");
    }
}

//! How much memory may be used: the whole process counts.

use orogen::Budget;
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

/// Bytes that the program takes whatever it does: its code, the runtime and the tables of its libraries.
const PROGRAM: u64 = 14 << 20;

/// Bytes that a thread takes beside what it works on: the stack that it touches, and what the allocator keeps for it.
const THREAD: u64 = 256 << 10;

/// How many threads work at once, if nobody says.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// What the work may use of so many bytes for the whole process, or of [`share_of_free`] if nobody says: the program's own share is taken off.
pub fn budget(allowed: Option<Bytes>, threads: usize) -> Budget {
    let budget = Budget::of(allowed.map(|bytes| bytes.0).or_else(share_of_free));
    budget.charge(PROGRAM + THREAD * threads as u64).keep();
    budget
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

//! Memory limits of the whole process.

use orogen::Budget;
use sysinfo::{Pid, ProcessRefreshKind, ProcessesToUpdate, System};

use crate::values::bytes::Bytes;

/// Half of the free memory of the machine or of the container, whichever is less; `None` if the system does not provide
/// it.
pub fn share_of_free() -> Option<u64> {
    let mut system = System::new().ok()?;
    system.refresh_memory();
    let pid = Pid::from_u32(std::process::id());
    system.refresh_processes_specifics(ProcessesToUpdate::Some(&[pid]), false, ProcessRefreshKind::nothing());
    let limits = [system.cgroup_limits(), system.process(pid).and_then(|process| process.cgroup_limits())];
    limits
        .into_iter()
        .flatten()
        // A container's free memory excludes file cache that could be dropped, so the resident memory is used.
        .map(|limits| limits.total_memory.saturating_sub(limits.rss))
        .chain([system.available_memory()])
        .filter(|&free| free > 0)
        .min()
        .map(|free| free / 2)
}

/// Memory of the program itself, in bytes: code, runtime and tables of libraries.
const PROGRAM: u64 = 14 << 20;

/// Memory per thread, in bytes, in addition to its work: the used part of the stack, and the allocator's cache.
const THREAD: u64 = 256 << 10;

/// The default number of threads.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// The budget for the work: the limit of the whole process (by default [`share_of_free`]) minus the program's own
/// memory.
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

//! Tests of loops on threads.

use super::*;
use std::sync::Barrier;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

/// Runs `work` in a pool of `threads` threads.
fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

#[test]
fn results_are_in_the_order_of_the_items() {
    for (threads, count) in [(1, 100), (2, 0), (2, 1), (3, 1000), (8, 5), (16, 10_000)] {
        let squares = with_threads(threads, || map(0..count, |k| k * k));
        assert_eq!(squares, (0..count).map(|k| k * k).collect::<Vec<usize>>(), "{threads} threads");
        let squares = with_threads(threads, || try_map(0..count, |k| Ok::<_, ()>(k * k)));
        assert_eq!(squares.unwrap().len(), count);
    }
    assert_eq!(samples(SAMPLES + 2, |at| at as u32)[SAMPLES - 1..], [16383, 16384, 16385]);
    // Outside of any pool.
    assert_eq!(map([3, 1, 2].iter(), |k| k + 1), [4, 2, 3]);
}

#[test]
fn every_item_is_done_once() {
    for (threads, count) in [(1, 7), (2, 10_007), (5, 3), (7, 1000), (64, 64usize)] {
        let done: Vec<AtomicU32> = (0..count).map(|_| AtomicU32::new(0)).collect();
        let count_one = |done: &AtomicU32| assert!(done.fetch_add(1, Ordering::Relaxed) < 2);
        with_threads(threads, || for_each(&done, count_one));
        assert!(done.iter().all(|done| done.load(Ordering::Relaxed) == 1), "{threads} threads");
        // The length of this iterator is unknown.
        let few = done.iter().enumerate().filter(|(k, _)| k % 3 == 0).map(|(_, done)| done);
        with_threads(threads, || for_each(few, count_one));
        let sum: u32 = done.iter().map(|done| done.load(Ordering::Relaxed)).sum();
        assert_eq!(sum as usize, count + count.div_ceil(3));
    }
}

#[test]
fn items_run_at_the_same_time() {
    for threads in [2, 3, 4, 7] {
        let together = Barrier::new(threads);
        let leaders = with_threads(threads, || map(0..threads, |_| together.wait().is_leader()));
        assert_eq!(leaders.iter().filter(|is_leader| **is_leader).count(), 1);
    }
}

#[test]
fn the_first_error_wins_whatever_fails_first() {
    for threads in [2, 4] {
        // The first item begins before the second one fails, and fails after it.
        let begun = Barrier::new(2);
        let work = |k: usize| match k {
            0 => {
                begun.wait();
                std::thread::sleep(Duration::from_millis(20));
                Err(k)
            }
            1 => {
                begun.wait();
                Err(k)
            }
            _ => Ok(()),
        };
        assert_eq!(with_threads(threads, || try_for_each(0..4, work)), Err(0), "{threads} threads");
    }
    for threads in [1, 2, 3, 8] {
        for failing in [[0, 1], [17, 18], [500, 999], [998, 999]] {
            let done: Vec<AtomicU32> = (0..1000).map(|_| AtomicU32::new(0)).collect();
            let work = |k: usize| {
                done[k].fetch_add(1, Ordering::Relaxed);
                if failing.contains(&k) { Err(k) } else { Ok(()) }
            };
            assert_eq!(with_threads(threads, || try_for_each(0..1000, work)), Err(failing[0]));
            assert!(done[..=failing[0]].iter().all(|done| done.load(Ordering::Relaxed) == 1));
            assert_eq!(with_threads(threads, || try_map(0..1000, work)), Err(failing[0]));
        }
    }
}

#[test]
fn nothing_begins_after_a_known_failure() {
    let begun = AtomicU32::new(0);
    let result = with_threads(1, || {
        try_for_each(0..1000, |k| {
            begun.fetch_add(1, Ordering::Relaxed);
            if k == 9 { Err(k) } else { Ok(()) }
        })
    });
    assert_eq!((result, begun.into_inner()), (Err(9), 10));
}

#[test]
fn one_thread_takes_the_items_in_order() {
    let order = Mutex::new(Vec::new());
    let outer = std::thread::current().id();
    with_threads(1, || for_each(0..1000, |k| order.lock().unwrap().push(k)));
    assert!(order.into_inner().unwrap().into_iter().eq(0..1000));
    // A single item runs on the calling thread, in a pool or not.
    for_each(0..1, |_| assert_eq!(std::thread::current().id(), outer));
}

#[test]
fn each_task_has_a_value_of_its_own() {
    for threads in [1, 2, 4] {
        let (made, sum) = (AtomicU32::new(0), AtomicU32::new(0));
        let init = || {
            made.fetch_add(1, Ordering::Relaxed);
            0u32
        };
        // Each item sees what earlier items of the same task have left.
        with_threads(threads, || {
            for_each_init(0..1000, init, |count, _| {
                *count += 1;
                if *count == 1 {
                    sum.fetch_add(1, Ordering::Relaxed);
                }
            });
        });
        assert_eq!(sum.load(Ordering::Relaxed), made.load(Ordering::Relaxed));
        assert!((1..=threads as u32).contains(&made.into_inner()));
        let none = AtomicU32::new(0);
        let init = || none.fetch_add(1, Ordering::Relaxed);
        let result = with_threads(threads, || try_for_each_init(0..0, init, |_, _: usize| Err(())));
        assert_eq!((result, none.load(Ordering::Relaxed)), (Ok(()), 0), "without items");
    }
}

#[test]
fn loops_may_be_nested() {
    for threads in [1, 2, 5] {
        let sums = with_threads(threads, || {
            map(0..50, |outer| map(0..100, |inner| map(0..3, |k| outer * inner + k).iter().sum::<usize>()))
        });
        for (outer, sums) in sums.iter().enumerate() {
            assert!(sums.iter().enumerate().all(|(inner, sum)| *sum == 3 * outer * inner + 3));
        }
    }
}

#[test]
fn a_panic_of_an_item_reaches_the_caller() {
    for threads in [1, 3] {
        let caught = std::panic::catch_unwind(|| {
            with_threads(threads, || for_each(0..100, |k| assert!(k != 40, "the fortieth")));
        });
        assert!(caught.is_err());
    }
}

#[test]
fn sorted_items_are_those_of_a_stable_sort() {
    // Repeated keys, in an order without sorted runs.
    let unsorted: Vec<(u32, u32)> =
        (0..3 * SAMPLES as u32 + 7).map(|k| (k.wrapping_mul(2_654_435_761) >> 20, k)).collect();
    let mut expected = unsorted.clone();
    expected.sort_by_key(|(key, _)| *key);
    for threads in [1, 2, 3, 8] {
        let mut items = unsorted.clone();
        with_threads(threads, || sort_by(&mut items, |(a, _), (b, _)| a.cmp(b)));
        assert_eq!(items, expected, "{threads} threads");
    }
}

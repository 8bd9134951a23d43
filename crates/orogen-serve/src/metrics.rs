//! Counts of requests, in the text format of Prometheus.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};

use orogen::Session;

use crate::desk::Desk;
use crate::peers::Peers;

/// Upper ends of the classes of durations, in seconds.
const ENDS: [f64; 12] = [0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 60.0];

/// The requests of a route.
#[derive(Debug, Clone, Default)]
struct Route {
    statuses: BTreeMap<u16, u64>,
    /// Requests by duration, the last class without an end.
    durations: [u64; ENDS.len() + 1],
    seconds: f64,
}

/// Counts of requests by route.
#[derive(Default)]
pub struct Metrics(Mutex<BTreeMap<String, Route>>);

impl Metrics {
    /// Counts a request.
    pub fn count(&self, route: &str, status: u16, seconds: f64) {
        let mut routes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let route = routes.entry(route.to_string()).or_default();
        *route.statuses.entry(status).or_default() += 1;
        route.durations[ENDS.iter().position(|end| seconds <= *end).unwrap_or(ENDS.len())] += 1;
        route.seconds += seconds;
    }

    /// The text.
    pub fn text(&self, desk: &Desk, peers: &Peers, session: &Session) -> String {
        let routes = self.0.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let mut text = String::new();
        let head = |name: &str, kind: &str, about: &str| format!("# HELP {name} {about}\n# TYPE {name} {kind}\n");
        text += &head("orogen_requests_total", "counter", "Requests by route and status; 499: the client went away");
        // Writing to a string cannot fail.
        for (name, route) in &routes {
            for (status, count) in &route.statuses {
                let _ = writeln!(text, "orogen_requests_total{{route=\"{name}\",status=\"{status}\"}} {count}");
            }
        }
        text += &head("orogen_request_seconds", "histogram", "Time until the head of the answer");
        for (name, route) in &routes {
            let mut sum = 0;
            for (end, count) in ENDS.iter().map(f64::to_string).chain(["+Inf".into()]).zip(route.durations) {
                sum += count;
                let _ = writeln!(text, "orogen_request_seconds_bucket{{route=\"{name}\",le=\"{end}\"}} {sum}");
            }
            let _ = writeln!(text, "orogen_request_seconds_sum{{route=\"{name}\"}} {}", route.seconds);
            let _ = writeln!(text, "orogen_request_seconds_count{{route=\"{name}\"}} {sum}");
        }
        let total = |count: &std::sync::atomic::AtomicU64| count.load(Ordering::Relaxed);
        let budget = session.budget();
        let used = budget.limit().zip(budget.unused()).map(|(limit, unused)| limit - unused);
        for (name, kind, about, value) in [
            ("orogen_cache_hits_total", "counter", "Answers from the cache of tiles", total(&desk.counts.hits)),
            ("orogen_work_total", "counter", "Finished pieces of work", total(&desk.counts.made)),
            (
                "orogen_work_cancelled_total",
                "counter",
                "Work cancelled because its clients went away",
                total(&desk.counts.cancelled),
            ),
            (
                "orogen_requests_refused_total",
                "counter",
                "Requests refused because the queue was full",
                total(&desk.counts.refused),
            ),
            ("orogen_connections", "gauge", "Open connections", peers.count() as u64),
            (
                "orogen_connections_displaced_total",
                "counter",
                "Idle connections that were closed for new ones",
                total(&peers.displaced),
            ),
            (
                "orogen_connections_refused_total",
                "counter",
                "Connections refused because all others were busy",
                total(&peers.refused),
            ),
            ("orogen_workers_busy", "gauge", "Workers that compute", desk.busy() as u64),
            ("orogen_work_pending", "gauge", "Pieces of work that wait or run", desk.pending() as u64),
            ("orogen_cache_bytes", "gauge", "Bytes in the cache of tiles", desk.cache_bytes() as u64),
            ("orogen_memory_limit_bytes", "gauge", "The memory limit, 0 for none", budget.limit().unwrap_or(0)),
            ("orogen_memory_used_bytes", "gauge", "Memory that is held or needed by running work", used.unwrap_or(0)),
            ("orogen_memory_peak_bytes", "gauge", "The maximum of it so far", budget.peak()),
            ("orogen_kept_bytes", "gauge", "Memory of kept solutions and tiles of levels", session.kept_memory()),
            ("orogen_solutions_total", "counter", "Solutions of solvers that were computed", session.solutions_made()),
            ("orogen_level_tiles_total", "counter", "Tiles of levels that were computed", session.level_tiles_made()),
        ] {
            text += &head(name, kind, about);
            let _ = writeln!(text, "{name} {value}");
        }
        text
    }
}

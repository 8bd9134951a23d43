//! Area `serve`: `orogen serve` under load from this machine, over loopback, on all cores.

mod client;

use std::net::SocketAddr;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::options::Options;
use client::{Connection, Server};

/// Connections that ask for warm tiles.
const CLIENTS: usize = 8;

/// Connections of mixed requests, and the memory of their server.
const MIXED: usize = 64;
const MEMORY: &str = "512MiB";

/// A case: its name, what it measures, its unit and its target.
struct Case {
    name: &'static str,
    unit: &'static str,
    target: f64,
    /// Whether more is better.
    is_rate: bool,
    /// Whether it runs only if it is named.
    is_long: bool,
    measure: fn(&Options) -> Result<f64, String>,
}

const fn case(
    name: &'static str,
    unit: &'static str,
    target: f64,
    measure: fn(&Options) -> Result<f64, String>,
) -> Case {
    Case { name, unit, target, is_rate: false, is_long: false, measure }
}

const CASES: &[Case] = &[
    Case { is_rate: true, ..case("warm tiles of 256 x 256, at least", "tiles/s", 1500.0, warm) },
    case("warm tiles at 200/s, 99 of 100 within", "ms", 20.0, paced),
    case("cold tiles of fields (classic), 99 of 100 within", "ms", 50.0, |options| cold(options, "classic", 18)),
    case("cold tiles of endless, 99 of 100 within", "ms", 400.0, |options| cold(options, "endless", 11)),
    case("10 000 mixed requests, 64 connections, 512 MiB: memory of the process at most", "MiB", 563.2, mixed),
    case("1000 aborted requests: work that is left, at most", "requests", 0.0, aborted),
    case("10 000 idle connections: growth of memory at most", "MiB", 16.0, idle),
    case("400 clients that read nothing of 4 MiB, 512 MiB: memory of the process at most", "MiB", 563.2, unread),
    Case { is_long: true, ..case("soak of ten minutes: growth of memory at most", "%", 5.0, soak) },
];

/// Measures all cases, or those selected.
pub fn run(options: &Options) -> Result<Value, String> {
    let mut rows = Vec::new();
    let chosen = |case: &&Case| case.name.contains(&options.case) && (!case.is_long || !options.case.is_empty());
    for case in CASES.iter().filter(chosen) {
        eprintln!("{} ...", case.name);
        let measured = ((case.measure)(options)? * 100.0).round() / 100.0;
        let met = if case.is_rate { measured >= case.target } else { measured <= case.target };
        rows.push(json!({
            "case": case.name, "ours": measured, "unit": case.unit, "peer": null, "peer_value": null, "ratio": null,
            "target": case.target, "met": met,
        }));
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(json!({ "area": "serve", "simd": orogen_simd::Level::current().name(), "threads": threads, "rows": rows }))
}

/// Seconds of a case.
fn seconds(options: &Options, most: f64) -> f64 {
    if options.repetitions < 9 { most / 5.0 } else { most }
}

/// The path of a tile around the origin of a world in the grid of web maps.
fn tile(layer: &str, zoom: u32, column: u64, row: u64) -> String {
    let middle = 1u64 << (zoom - 1);
    format!("/{layer}/{zoom}/{}/{}.png", middle + column, middle + row)
}

/// Asks, and checks that there is a tile.
fn fetched(connection: &mut Connection, path: &str) -> Result<usize, String> {
    match connection.get(path)? {
        (200, body) if body.starts_with(b"\x89PNG") => Ok(body.len()),
        (status, body) => Err(format!("{path}: {status} {}", String::from_utf8_lossy(&body))),
    }
}

/// Sixteen tiles of `classic` that the server has made.
fn warmed() -> Result<(Server, Vec<String>), String> {
    let server = Server::start(&["classic"])?;
    let paths: Vec<String> = (0..16).map(|k| tile("tiles/height", 15, k % 4, k / 4)).collect();
    let mut connection = Connection::open(server.address)?;
    for path in &paths {
        fetched(&mut connection, path)?;
    }
    Ok((server, paths))
}

/// Runs a function on several threads, and collects what they return.
fn together<T: Send>(count: usize, work: impl Fn(usize) -> Result<T, String> + Sync) -> Result<Vec<T>, String> {
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..count)
            .map(|k| {
                scope.spawn({
                    let work = &work;
                    move || work(k)
                })
            })
            .collect();
        threads.into_iter().map(|thread| thread.join().map_err(|_| "a client ended".to_string())?).collect()
    })
}

/// Warm tiles a second.
fn warm(options: &Options) -> Result<f64, String> {
    let (server, paths) = warmed()?;
    let (start, most) = (Instant::now(), seconds(options, 10.0));
    let counts = together(CLIENTS, |k| {
        let mut connection = Connection::open(server.address)?;
        let mut count = 0usize;
        while start.elapsed().as_secs_f64() < most {
            fetched(&mut connection, &paths[(k + count) % paths.len()])?;
            count += 1;
        }
        Ok(count)
    })?;
    Ok(counts.iter().sum::<usize>() as f64 / start.elapsed().as_secs_f64())
}

/// The time within which 99 of 100 answers come, in milliseconds, to 200 requests a second at times set before.
fn paced(options: &Options) -> Result<f64, String> {
    const RATE: f64 = 200.0;
    let (server, paths) = warmed()?;
    let per_client = (seconds(options, 10.0) * RATE) as usize / CLIENTS;
    let start = Instant::now();
    let times = together(CLIENTS, |k| {
        let mut connection = Connection::open(server.address)?;
        let mut times = Vec::new();
        for n in 0..per_client {
            let due = Duration::from_secs_f64((n * CLIENTS + k) as f64 / RATE);
            std::thread::sleep(due.saturating_sub(start.elapsed()));
            fetched(&mut connection, &paths[(n + k) % paths.len()])?;
            // From the time at which it was due: a client that waits is part of the delay.
            times.push((start.elapsed() - due).as_secs_f64() * 1000.0);
        }
        Ok(times)
    })?;
    Ok(percentile(times.concat()))
}

/// The 99th percentile.
fn percentile(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    let at = (times.len() * 99).div_ceil(100).saturating_sub(1);
    times.get(at).copied().unwrap_or(f64::NAN)
}

/// The time within which 99 of 100 tiles come that nobody asked for before, one after the other, in milliseconds.
fn cold(options: &Options, world: &str, zoom: u32) -> Result<f64, String> {
    let server = Server::start(&[world, "--no-cache"])?;
    let mut connection = Connection::open(server.address)?;
    // The colors of the layer are fitted to the world before.
    fetched(&mut connection, &tile("tiles/height", zoom, 0, 0))?;
    let count = if options.repetitions < 9 { 40 } else { 200 };
    let mut times = Vec::new();
    for k in 1..=count {
        // Not beside each other: what a tile computes helps none of the others.
        let path = tile("tiles/height", zoom, (k * 7) % 61, (k * 11) % 59);
        let start = Instant::now();
        fetched(&mut connection, &path)?;
        times.push(start.elapsed().as_secs_f64() * 1000.0);
    }
    Ok(percentile(times))
}

/// A generator of numbers, the same in every run (G. Marsaglia, "Xorshift RNGs", 2003).
struct Random(u64);

impl Random {
    fn below(&mut self, count: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % count
    }
}

/// A request of any kind, of two worlds.
fn any(random: &mut Random) -> String {
    let world = ["alpine", "endless"][random.below(2) as usize];
    let (zoom, column, row) = (11 + random.below(3) as u32, random.below(6), random.below(6));
    let at = || (column * 900, row * 900);
    let path = match random.below(9) {
        0 => tile("tiles/height", zoom, column, row),
        1 => tile("tiles/slope", zoom, column, row),
        2 => tile("terrarium", zoom, column, row),
        3 => tile("terrain-rgb", zoom, column, row),
        4 => tile("vector", zoom - 1, column / 2, row / 2).replace(".png", ".mvt"),
        5 => format!("/height?x={}&y=-{}", at().0, at().1),
        6 => format!("/profile?points={0},-{1};{2},-{1}&samples=128", at().0, at().1, at().0 + 5000),
        7 => format!("/window.npy?bbox={0},-{1},{2},-{3}&width=256", at().0, at().1 + 8000, at().0 + 8000, at().1),
        _ => "/tilejson/height.json".into(),
    };
    format!("/{world}{path}")
}

/// Asks many requests of any kind at once, and fails at an answer that is no answer.
fn ask_mixed(address: SocketAddr, count: usize, until: Option<Instant>, seed: u64) -> Result<(), String> {
    let asked = AtomicUsize::new(0);
    together(MIXED, |k| {
        let mut connection = Connection::open(address)?;
        let mut random = Random((k as u64 + seed).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        while asked.fetch_add(1, Ordering::Relaxed) < count && until.is_none_or(|until| Instant::now() < until) {
            let path = any(&mut random);
            let (status, body) = connection.get(&path)?;
            // Outside the world there is no tile; a full queue is announced.
            if ![200, 404, 503].contains(&status) {
                return Err(format!("{path}: {status} {}", String::from_utf8_lossy(&body)));
            }
        }
        Ok(())
    })
    .map(drop)
}

/// The largest memory of a server of mixed requests, in MiB.
fn mixed(options: &Options) -> Result<f64, String> {
    let server = Server::start(&["alpine", "endless", "--memory", MEMORY])?;
    ask_mixed(server.address, if options.repetitions < 9 { 1000 } else { 10_000 }, None, 1)?;
    Ok(server.memory("VmHWM")? as f64 / f64::from(1 << 20))
}

/// The work that is left after 1000 clients that went away.
fn aborted(options: &Options) -> Result<f64, String> {
    let server = Server::start(&["endless"])?;
    let mut random = Random(77);
    for _ in 0..if options.repetitions < 9 { 100 } else { 1000 } {
        let mut connection = Connection::open(server.address)?;
        connection.send(&tile("tiles/height", 12, random.below(2000), random.below(2000)))?;
        std::thread::sleep(Duration::from_millis(2));
    }
    // Work notices at its next step that it is cancelled.
    let start = Instant::now();
    loop {
        let left = server.metric("orogen_work_pending")?;
        if left == 0 || start.elapsed() > Duration::from_secs(20) {
            return Ok(left as f64);
        }
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// By how much the memory grows with connections that ask nothing, or half of a request, in MiB. All are held open, and
/// others are answered meanwhile.
fn idle(options: &Options) -> Result<f64, String> {
    let (server, paths) = warmed()?;
    let before = server.memory("VmRSS")?;
    let mut open = Vec::new();
    for k in 0..if options.repetitions < 9 { 1000 } else { 10_000 } {
        let mut connection = Connection::open(server.address)?;
        match k % 3 {
            0 => connection.send_raw("GET /healthz HTTP/1.1\r\nHost: localhost\r\n")?,
            1 => connection.send_raw("P")?,
            _ => {}
        }
        open.push(connection);
        if k % 50 == 0 {
            fetched(&mut Connection::open(server.address)?, &paths[k / 50 % paths.len()])?;
        }
    }
    let most = server.metric("orogen_connections")?;
    if most > 512 {
        return Err(format!("the server has {most} connections"));
    }
    let grown = server.memory("VmRSS")?.saturating_sub(before);
    drop(open);
    Ok(grown as f64 / f64::from(1 << 20))
}

/// The largest memory of a server whose clients do not read their answers, in MiB. Others are answered meanwhile.
fn unread(options: &Options) -> Result<f64, String> {
    let server = Server::start(&["classic", "--memory", MEMORY])?;
    let mut open = Vec::new();
    for k in 0..if options.repetitions < 9 { 40 } else { 400 } {
        let mut connection = Connection::open(server.address)?;
        connection.send(&format!("/window.npy?bbox=0,-{0},{0},0&width=1024", 4000 + k))?;
        open.push(connection);
        let mut other = Connection::open(server.address)?;
        let (status, _) = other.get("/height?x=100&y=-100")?;
        // A full queue is announced, and memory that is needed for answers, too.
        if ![200, 413, 503].contains(&status) {
            return Err(format!("a client beside those that do not read: {status}"));
        }
    }
    drop(open);
    Ok(server.memory("VmHWM")? as f64 / f64::from(1 << 20))
}

/// Settings under which the allocator of glibc gives back what is free: by default each of its arenas keeps tens of
/// megabytes, others at every moment, in which a leak would not be seen.
const GIVE_BACK: [(&str, &str); 3] =
    [("MALLOC_ARENA_MAX", "2"), ("MALLOC_MMAP_THRESHOLD_", "65536"), ("MALLOC_TRIM_THRESHOLD_", "65536")];

/// By how much the memory grows in nine minutes, in percent, after two minutes and enough requests to fill the caches
/// of a slow machine, too. What is read is the memory between two minutes of requests: during them it holds what is
/// being answered. Each end is the median of three.
fn soak(options: &Options) -> Result<f64, String> {
    let server = Server::start_with(&["alpine", "endless", "--memory", MEMORY], &GIVE_BACK)?;
    let minute = Duration::from_secs_f64(seconds(options, 60.0));
    let start = Instant::now();
    ask_mixed(server.address, if options.repetitions < 9 { 200 } else { 2000 }, None, 1)?;
    ask_mixed(server.address, usize::MAX, Some(start + 2 * minute), 2)?;
    let mut held = Vec::new();
    for round in 0..9 {
        ask_mixed(server.address, usize::MAX, Some(Instant::now() + minute), 3 + round)?;
        std::thread::sleep(minute / 60);
        held.push(server.memory("VmRSS")?);
    }
    eprintln!("memory after each minute, in MiB: {:?}", held.iter().map(|bytes| bytes >> 20).collect::<Vec<_>>());
    let median = |range: std::ops::Range<usize>| {
        let mut three = held[range].to_vec();
        three.sort_unstable();
        three[1] as f64
    };
    Ok(100.0 * (median(6..9) / median(0..3) - 1.0))
}

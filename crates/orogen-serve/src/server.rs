//! The server: its options, its worlds, and its life.

use std::net::{IpAddr, SocketAddr, TcpListener, ToSocketAddrs};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use orogen::grid::words;
use orogen::options::{OptionSpec, Options, ValueKind};
use orogen::{Error, ErrorKind, Recipe, Result, Session};

use crate::connection;
use crate::desk::Desk;
use crate::metrics::Metrics;
use crate::peers::Peers;
use crate::recent::Recent;
use crate::routes::{RESERVED, router};
use crate::sent;
use crate::served::Served;
use crate::shared::{GRACE, Limits, Log, Shared};
use crate::site::Site;

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("port", "N", ValueKind::Whole(0, 65_535))
        .with_about("Port to listen on; 0 chooses a free one")
        .with_default("8080"),
    OptionSpec::new("host", "ADDRESS", ValueKind::Text)
        .with_about("Address to listen on: other machines can connect only to another one than the default, which needs --token")
        .with_default("127.0.0.1"),
    OptionSpec::new("token", "TOKEN", ValueKind::Text).with_about(
        "Answer only requests with this token, at least 16 letters and digits, as `Authorization: Bearer TOKEN` or `?token=TOKEN`",
    ),
    OptionSpec::new("queue", "N", ValueKind::Whole(1, 100_000))
        .with_about("Requests that may wait for others; more are answered with 503")
        .with_default("256"),
    OptionSpec::new("connections", "N", ValueKind::Whole(1, 100_000))
        .with_about("Open connections; a new one closes the one that is idle for the longest time")
        .with_default("512"),
    OptionSpec::new("max-samples", "N", ValueKind::Whole(1, 1_000_000_000_000))
        .with_about("Samples that a window may have")
        .with_default("16777216"),
    OptionSpec::new("timeout", "S", ValueKind::Number(0.1, 86_400.0))
        .with_about("Seconds that an answer may take; then it is 503, and its work is cancelled unless others wait for it")
        .with_default("120"),
    OptionSpec::new(sent::OPTION, "", ValueKind::Nothing)
        .with_about("Take recipes from clients, as the body of `POST /recipes`; they cannot name files"),
    OptionSpec::new("web", "FOLDER", ValueKind::File)
        .with_about("Folder that `cargo xtask web` and `cargo xtask book` make: the studio at /studio/, the book at /book/"),
];

/// Shortest token.
const SHORTEST_TOKEN: usize = 16;

/// Maximum memory of the cache of tiles, in bytes, and its share of the memory limit.
const CACHE: u64 = 64 << 20;
const CACHE_SHARE: u64 = 8;

/// Threads that read and write requests, beside those that compute.
const SPEAKERS: usize = 2;

/// A server of terrain over HTTP.
///
/// [Add](Server::add) worlds, [bind](Server::bind) to an address, and [run](Server::run).
#[must_use]
pub struct Server {
    session: Session,
    limits: Limits,
    site: Site,
    host: String,
    port: u16,
    worlds: Vec<Arc<Served>>,
    listener: Option<TcpListener>,
}

impl Server {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// A server with these [options](Server::OPTIONS), whose requests share the threads and the memory of a session.
    ///
    /// # Errors
    /// If an option is not valid, or the host is reachable by other machines and there is no token.
    pub fn new(session: Session, options: &Options) -> Result<Server> {
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        let host = options.text("host").unwrap_or("127.0.0.1").trim_matches(['[', ']']).to_string();
        let token = options.text("token").map(str::to_string);
        if let Some(token) = &token
            && (token.len() < SHORTEST_TOKEN
                || !token.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-._~".contains(&byte)))
        {
            return refuse(format!(
                "--token must have at least {SHORTEST_TOKEN} characters, and only letters, digits, `-`, `.`, `_` and `~`"
            ));
        }
        let is_loopback = host == "localhost" || host.parse::<IpAddr>().is_ok_and(|address| address.is_loopback());
        if !is_loopback && token.is_none() {
            return refuse(format!(
                "--host {host} can be reached by other machines; set --token TOKEN, which requests must then have, or leave out --host"
            ));
        }
        let limits = Limits {
            token,
            samples: options.whole("max-samples").map_or(1 << 24, |count| usize::try_from(count).unwrap_or(usize::MAX)),
            timeout: Duration::from_secs_f64(options.number("timeout").unwrap_or(120.0)),
            queue: options.whole("queue").unwrap_or(256) as usize,
            connections: options.whole("connections").unwrap_or(512) as usize,
            allows_recipes: options.has(sent::OPTION),
        };
        let port = options.whole("port").unwrap_or(8080) as u16;
        let site = options.file("web").map(Site::of).transpose()?.unwrap_or_default();
        Ok(Server { session, limits, site, host, port, worlds: Vec::new(), listener: None })
    }

    /// Adds a world under a name, which begins the paths of its requests if there are several worlds. `is_place`: it is
    /// a real place, a file of heights.
    ///
    /// # Errors
    /// If the recipe is not valid, or the name is taken or cannot be part of a path.
    pub fn add(&mut self, name: &str, recipe: Recipe, is_place: bool) -> Result<()> {
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        let is_plain = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_".contains(&byte));
        if name.is_empty() || name.len() > 100 || !is_plain {
            return refuse(format!(
                "a world cannot be served under the name `{name}`: it must have 1 to 100 letters, digits, `-` and `_`; rename its file"
            ));
        }
        if RESERVED.contains(&name) {
            let names = words::list(RESERVED);
            return refuse(format!(
                "a world cannot be served under the name `{name}`; {names} are requests; rename its file"
            ));
        }
        if self.worlds.iter().any(|world| world.name == name) {
            return refuse(format!("two worlds have the name `{name}`; rename the file of one of them"));
        }
        self.worlds.push(Arc::new(Served::new(name, &self.session, recipe, is_place)?));
        Ok(())
    }

    /// The names of the worlds.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.worlds.iter().map(|world| world.name.as_str())
    }

    /// Starts to listen, and returns the address. Requests are answered by [`run`](Server::run).
    ///
    /// # Errors
    /// If the address does not exist or is in use.
    pub fn bind(&mut self) -> Result<SocketAddr> {
        let failed = |cause: std::io::Error| {
            let address = format!("{}:{}", self.host, self.port);
            let error = Error::file("listen on", Path::new(&address), &cause);
            match cause.kind() {
                std::io::ErrorKind::AddrInUse => {
                    Error::new(ErrorKind::Request, format!("{error}; choose another --port, or 0 for a free one"))
                }
                _ => error,
            }
        };
        let addresses: Vec<SocketAddr> = (self.host.as_str(), self.port).to_socket_addrs().map_err(failed)?.collect();
        let listener = TcpListener::bind(addresses.as_slice()).map_err(failed)?;
        listener.set_nonblocking(true).map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        self.listener = Some(listener);
        Ok(address)
    }

    /// Answers requests until `stop` is set; then running answers have a few seconds to end. `log` receives a line for
    /// each request.
    ///
    /// # Errors
    /// If there is no world, the address cannot be [bound](Server::bind), or no thread can be started.
    pub fn run(mut self, stop: &Arc<AtomicBool>, log: impl Fn(&str) + Send + Sync + 'static) -> Result<()> {
        if self.worlds.is_empty() {
            return Err(Error::new(ErrorKind::Request, "there is no world to serve"));
        }
        if self.listener.is_none() {
            self.bind()?;
        }
        let Some(listener) = self.listener.take() else { return Ok(()) };
        let shared = Arc::new(self.shared(Box::new(log))?);
        if let Ok(address) = listener.local_addr() {
            let _ = shared.address.set(address);
        }
        let started = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(SPEAKERS)
            .max_blocking_threads(shared.session.threads() + 1)
            .thread_name("orogen-serve")
            .enable_all()
            .build();
        let runtime = started.map_err(|cause| {
            Error::new(ErrorKind::Request, format!("the threads of the server cannot be started: {cause}"))
        })?;
        let served = runtime.block_on(connection::serve(listener, router(&shared), &shared, stop));
        runtime.shutdown_timeout(GRACE);
        served
    }

    /// What all requests share. The memory of the cache is reserved.
    pub(crate) fn shared(self, log: Log) -> Result<Shared> {
        let budget = self.session.budget();
        let cache = budget.limit().map_or(CACHE, |limit| CACHE.min(limit / CACHE_SHARE));
        budget.reserve(cache)?.keep();
        Ok(Shared {
            worlds: self.worlds,
            recipes: Recent::new(sent::MAX_KEPT),
            desk: Arc::new(Desk::new(self.session.threads(), self.limits.queue, cache as usize)),
            peers: Arc::new(Peers::new(self.limits.connections)),
            limits: self.limits,
            site: self.site,
            metrics: Metrics::default(),
            log,
            session: self.session,
            address: OnceLock::new(),
        })
    }
}

//! What all requests share: the worlds, the limits, and what is counted.

use std::net::SocketAddr;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use orogen::Session;

use crate::desk::Desk;
use crate::metrics::Metrics;
use crate::peers::Peers;
use crate::recent::Recent;
use crate::served::Served;
use crate::site::Site;

/// How long running answers may take to end when the server stops.
pub const GRACE: Duration = Duration::from_secs(10);

/// Limits of requests.
#[derive(Debug, Clone)]
pub struct Limits {
    pub token: Option<String>,
    pub samples: usize,
    pub timeout: Duration,
    pub queue: usize,
    pub connections: usize,
    /// Whether clients may send recipes.
    pub allows_recipes: bool,
}

/// Receives lines of the log.
pub type Log = Box<dyn Fn(&str) + Send + Sync>;

/// What all requests share.
pub struct Shared {
    pub worlds: Vec<Arc<Served>>,
    /// Worlds of recipes that clients sent, by their names.
    pub recipes: Recent<Served>,
    pub desk: Arc<Desk>,
    pub peers: Arc<Peers>,
    pub limits: Limits,
    pub site: Site,
    pub metrics: Metrics,
    pub log: Log,
    pub session: Session,
    pub address: OnceLock<SocketAddr>,
}

impl Shared {
    /// The address that the server listens on.
    pub fn address(&self) -> String {
        self.address.get().map_or_else(|| "localhost".into(), SocketAddr::to_string)
    }
}

/// The address of a client.
#[derive(Debug, Clone, Copy)]
pub struct Client(pub SocketAddr);

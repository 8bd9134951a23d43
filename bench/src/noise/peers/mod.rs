//! The peers: each fills the picture by the fastest way of its public API.

#[cfg(feature = "peers")]
mod by_sample;
#[cfg(feature = "peers")]
mod fastnoise_lite;
#[cfg(feature = "peers")]
mod libnoise;
#[cfg(feature = "peers")]
mod noise_functions;
#[cfg(feature = "peers")]
mod noise_rs;
mod plain;
#[cfg(all(feature = "peers", target_arch = "x86_64"))]
mod simdnoise;

use super::cases::Case;
use crate::measure::Job;

/// The job of a peer for a case; `None` if it does not offer it.
pub type Peer = fn(&Case) -> Option<Job>;

/// Every peer.
pub const PEERS: &[Peer] = &[
    plain::job,
    #[cfg(feature = "peers")]
    fastnoise_lite::job,
    #[cfg(feature = "peers")]
    noise_functions::job,
    #[cfg(feature = "peers")]
    noise_rs::job,
    #[cfg(feature = "peers")]
    libnoise::job,
    #[cfg(all(feature = "peers", target_arch = "x86_64"))]
    simdnoise::job,
];

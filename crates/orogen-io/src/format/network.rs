//! Files of networks for learned detail.

use std::path::Path;

use orogen_grid::error::Result;
use orogen_grid::learned::Network;
use orogen_grid::words::bytes_apart;
use sha2::{Digest, Sha256};

use super::dem::refused;
use crate::open;

/// Maximum length of a file in bytes.
const MAX_LENGTH: u64 = 1 << 26;

/// Memory per byte of a file: its content, and the weights.
const MEMORY_PER_BYTE: u64 = 2;

/// A network that was read from a file.
#[doc(hidden)]
#[derive(Debug)]
pub struct NetworkWeights {
    /// The network.
    pub network: Network,
    /// Hash of the file's content.
    pub hash: [u8; 32],
    length: u64,
}

impl NetworkWeights {
    /// Reads a file in at most `allowed` bytes of memory.
    ///
    /// # Errors
    /// If the file cannot be read, is too large, or has no network.
    pub fn read(path: &Path, allowed: u64) -> Result<NetworkWeights> {
        let name = path.display().to_string();
        let most = MAX_LENGTH.min(allowed / MEMORY_PER_BYTE);
        let Some(content) = open::bytes(path, "read", most)? else {
            let [most, needed] = bytes_apart(most, allowed.min(MAX_LENGTH * MEMORY_PER_BYTE));
            return Err(refused(
                &name,
                format!("it has more than {most}, the most that a network may have in {needed} of memory"),
            ));
        };
        let network = Network::parse(&content).map_err(|error| refused(&name, error.to_string()))?;
        Ok(NetworkWeights { network, hash: Sha256::digest(&content).into(), length: content.len() as u64 })
    }

    /// Memory of the network in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        self.length
    }
}

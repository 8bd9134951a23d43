//! The thread pool.
//!
//! On WebAssembly, a program has no threads of its own. If it is compiled for shared memory (the target feature
//! `atomics`), its host can start other instances of it with the same memory, and lend their threads by `lend_thread`.

#[cfg(not(all(feature = "threads", any(not(target_family = "wasm"), target_feature = "atomics"))))]
mod single;
#[cfg(all(feature = "threads", any(not(target_family = "wasm"), target_feature = "atomics")))]
mod threads;

#[cfg(not(all(feature = "threads", any(not(target_family = "wasm"), target_feature = "atomics"))))]
pub use single::Pool;
#[cfg(all(feature = "threads", any(not(target_family = "wasm"), target_feature = "atomics")))]
pub use threads::*;

/// Whether there can be several threads. Otherwise no thread may wait for another one.
pub const HAS_THREADS: bool =
    cfg!(all(feature = "threads", any(not(target_family = "wasm"), target_feature = "atomics")));

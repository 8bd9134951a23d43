//! Threads of the operating system.

use std::io;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

pub fn pool(threads: Option<usize>) -> Result<Option<ThreadPool>, ThreadPoolBuildError> {
    ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build().map(Some)
}

pub fn start(work: impl FnOnce() + Send + 'static) -> io::Result<()> {
    std::thread::Builder::new().name("orogen-request".into()).spawn(work).map(drop)
}

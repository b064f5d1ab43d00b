//! Our own thread pool, so that a host program's pool is never touched.

use std::num::NonZeroUsize;

/// The operating system refused to start the worker threads.
#[derive(Debug, thiserror::Error)]
#[error("cannot start {threads} worker threads ({reason}); ask for fewer")]
pub struct PoolError {
    threads: usize,
    reason: String,
}

/// A pool of `threads` workers, or one per core; run work in it with `pool.install(..)`.
///
/// # Errors
/// [`PoolError`] when the threads cannot be started.
pub fn pool(threads: Option<NonZeroUsize>) -> Result<rayon::ThreadPool, PoolError> {
    let threads = threads
        .or_else(|| std::thread::available_parallelism().ok())
        .map_or(1, NonZeroUsize::get);
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(|i| format!("bonemesh-{i}"))
        .build()
        .map_err(|e| PoolError {
            threads,
            reason: e.to_string(),
        })
}

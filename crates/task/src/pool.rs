//! Our own thread pool, so that a host program's pool is never touched.

use std::num::NonZeroUsize;

/// The operating system refused to start the worker threads.
#[derive(Debug, thiserror::Error)]
#[error("cannot start {threads} worker threads ({reason}); ask for fewer")]
pub struct PoolError {
    threads: usize,
    reason: String,
}

/// More workers than any machine here makes use of; thousands would only stall each other.
const MAX_THREADS: usize = 256;

/// A pool of `threads` workers (at most 256), or one per core; run work in it with
/// `pool.install(..)`.
///
/// # Errors
/// [`PoolError`] when the threads cannot be started.
pub fn pool(threads: Option<NonZeroUsize>) -> Result<rayon::ThreadPool, PoolError> {
    let threads = threads
        .or_else(|| std::thread::available_parallelism().ok())
        .map_or(1, NonZeroUsize::get)
        .min(MAX_THREADS);
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(|i| format!("bonemesh-{i}"))
        .build()
        .map_err(|e| PoolError {
            threads,
            reason: e.to_string(),
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pool_has_the_threads_asked_for_up_to_a_sane_number() {
        let threads = |n| pool(NonZeroUsize::new(n)).unwrap().current_num_threads();
        assert_eq!(threads(3), 3);
        assert_eq!(threads(1_000_000), MAX_THREADS);
    }
}

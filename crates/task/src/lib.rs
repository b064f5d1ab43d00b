//! Long work that can be watched, stopped and repeated to the byte.
//!
//! A [`Task`] carries progress and cancellation through every step. The worker only writes
//! (`begin`, `advance`), whoever waits polls [`Task::progress`]: no callback ever runs on a
//! worker thread, so a user interface or a Python interpreter stays on its own thread.
//!
//! Limits: one stage at a time; nested stages replace one another.
//!
//! ```
//! use bonemesh_task::Task;
//! let task = Task::default();
//! task.begin("count", 2);
//! task.advance(1)?;
//! assert_eq!(task.progress().stage, "count");
//! assert!((task.progress().fraction - 0.5).abs() < 1e-12);
//! task.cancel().cancel();
//! assert!(task.advance(1).is_err());
//! # Ok::<(), bonemesh_task::Cancelled>(())
//! ```

mod foreign;
mod pool;
mod sum;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

pub use pool::{PoolError, pool};
pub use sum::chunked_sum;

/// The work was stopped on request; nothing was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// A switch that stops the work it was given to; clones share one switch.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Asks the work to stop; it does so at its next check.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether [`Cancel::cancel`] was called.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Where the work stands: a stage's name and the done part of it, 0 to 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Progress {
    /// The running stage, for example `edges`; empty before the first.
    pub stage: &'static str,
    /// Done part of the stage, 0 to 1.
    pub fraction: f64,
}

/// Progress and cancellation of one piece of work; clones watch the same work.
#[derive(Clone, Debug, Default)]
pub struct Task {
    cancel: Cancel,
    stage: Arc<Mutex<&'static str>>,
    done: Arc<AtomicU64>,
    total: Arc<AtomicU64>,
}

impl Task {
    /// A task that `cancel` stops.
    pub fn new(cancel: Cancel) -> Self {
        Self {
            cancel,
            ..Self::default()
        }
    }

    /// The switch that stops this task.
    pub fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    /// Starts a stage of `total` units (0 is taken as 1).
    pub fn begin(&self, stage: &'static str, total: usize) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = stage;
        self.done.store(0, Ordering::Relaxed);
        self.total.store(total.max(1) as u64, Ordering::Relaxed);
    }

    /// Reports `units` more as done.
    ///
    /// # Errors
    /// [`Cancelled`] when the work is to stop.
    pub fn advance(&self, units: usize) -> Result<(), Cancelled> {
        self.done.fetch_add(units as u64, Ordering::Relaxed);
        self.check()
    }

    /// Cheap test for the inside of loops; call it at least every 50 ms.
    ///
    /// # Errors
    /// [`Cancelled`] when the work is to stop.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancel.is_cancelled() {
            Err(Cancelled)
        } else {
            Ok(())
        }
    }

    /// Where the work stands now.
    pub fn progress(&self) -> Progress {
        let total = self.total.load(Ordering::Relaxed).max(1) as f64;
        let done = self.done.load(Ordering::Relaxed) as f64;
        Progress {
            stage: *self.stage.lock().unwrap_or_else(PoisonError::into_inner),
            fraction: (done / total).min(1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clones_share_progress_and_cancel() {
        let task = Task::default();
        let watcher = task.clone();
        task.begin("edges", 4);
        task.advance(3).unwrap();
        assert_eq!(watcher.progress().stage, "edges");
        assert!((watcher.progress().fraction - 0.75).abs() < 1e-12);
        watcher.cancel().cancel();
        assert_eq!(task.check(), Err(Cancelled));
    }

    #[test]
    fn progress_never_passes_one() {
        let task = Task::default();
        task.begin("empty", 0);
        task.advance(7).unwrap();
        assert!(task.progress().fraction <= 1.0);
    }
}

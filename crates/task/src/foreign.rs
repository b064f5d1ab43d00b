//! Work of other libraries, which know nothing of a task.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use rayon::ThreadPoolBuilder;

use crate::{Cancelled, Task};

/// How often the cancel switch is looked at.
const LOOK_EVERY: Duration = Duration::from_millis(20);

impl Task {
    /// Does work that another switch stops, and flips that one by `stop` when this task is cancelled.
    ///
    /// # Errors
    /// [`Cancelled`]
    pub fn stopping<R>(
        &self,
        stop: impl Fn() + Send,
        work: impl FnOnce() -> R,
    ) -> Result<R, Cancelled> {
        let (done, is_done) = channel::<()>();
        let result = std::thread::scope(|scope| {
            scope.spawn(move || {
                while is_done.recv_timeout(LOOK_EVERY) == Err(RecvTimeoutError::Timeout) {
                    if self.check().is_err() {
                        stop();
                    }
                }
            });
            let result = work();
            drop(done);
            result
        });
        self.check()?;
        Ok(result)
    }

    /// Does work that cannot be stopped, on threads of its own, which are left alone with it when the task
    /// is cancelled. They may not be those that wait here: all of these might wait at once. `None` if it
    /// panicked.
    ///
    /// # Errors
    /// [`Cancelled`]
    pub fn leaving<R: Send + 'static>(
        &self,
        work: impl FnOnce() -> R + Send + 'static,
    ) -> Result<Option<R>, Cancelled> {
        let threads = ThreadPoolBuilder::new()
            .num_threads(rayon::current_num_threads())
            .panic_handler(|_| ());
        let Ok(threads) = threads.build() else {
            return Ok(None);
        };
        let (done, is_done) = channel();
        threads.spawn(move || {
            // Nobody waits for it any more where this fails.
            let _ = done.send(work());
        });
        loop {
            match is_done.recv_timeout(LOOK_EVERY) {
                Ok(result) => return Ok(Some(result)),
                Err(RecvTimeoutError::Timeout) => self.check()?,
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::thread::sleep;

    #[test]
    fn a_cancelled_task_flips_the_other_switch() {
        let task = Task::default();
        task.cancel().cancel();
        let is_stopped = AtomicBool::new(false);
        let result = task.stopping(
            || is_stopped.store(true, Ordering::Relaxed),
            || {
                while !is_stopped.load(Ordering::Relaxed) {
                    sleep(Duration::from_millis(1));
                }
            },
        );
        assert_eq!(result, Err(Cancelled));
        assert_eq!(Task::default().stopping(|| (), || 7), Ok(7));
    }

    #[test]
    fn a_cancelled_task_waits_for_nobody_and_a_panic_is_told() {
        let task = Task::default();
        assert_eq!(task.leaving(|| 7), Ok(Some(7)));
        let panicked = task.leaving(|| std::panic::panic_any("left"));
        assert_eq!(panicked, Ok(None::<()>));
        task.cancel().cancel();
        assert_eq!(
            task.leaving(|| sleep(Duration::from_millis(300))),
            Err(Cancelled)
        );
    }
}

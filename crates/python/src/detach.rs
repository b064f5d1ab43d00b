//! The one door through which work leaves the GIL.
//!
//! The work runs on a thread of its own. The thread that called waits without the GIL and looks up
//! every [`LOOK`]: it calls the progress callback, and lets Python handle signals, so that Ctrl-C
//! arrives. Whatever comes of that (`KeyboardInterrupt`, an exception of the callback) stops the
//! work, waits for it and goes on to the caller. Short work is not delayed: its end wakes the
//! waiting thread.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use bonemesh::{Cancel, Error, Progress, Task};
use pyo3::prelude::*;

use crate::errors;

/// How often the waiting thread takes the GIL to report progress and to see to signals.
const LOOK: Duration = Duration::from_millis(50);
/// How often it looks at the caller's switch, for which it does not need the GIL.
const SWITCH: Duration = Duration::from_millis(10);

/// What a caller hands in to watch and stop the work.
#[derive(Default)]
pub(crate) struct Watch {
    progress: Option<Py<PyAny>>,
    cancel: Cancel,
    last: Progress,
}

impl Watch {
    /// Checks the callback.
    pub(crate) fn new(
        py: Python<'_>,
        progress: Option<Py<PyAny>>,
        cancel: Option<&crate::cancel::Cancel>,
    ) -> PyResult<Self> {
        if let Some(callback) = &progress
            && !callback.bind(py).is_callable()
        {
            let kind = callback.bind(py).get_type().name()?;
            return Err(errors::argument(
                py,
                &format!(
                    "progress is {kind}, which cannot be called; pass a function of (stage, fraction) or None"
                ),
            ));
        }
        Ok(Self {
            progress,
            cancel: cancel
                .map(crate::cancel::Cancel::switch)
                .unwrap_or_default(),
            last: Progress::default(),
        })
    }

    /// Sees to signals and reports what is new.
    fn look(&mut self, py: Python<'_>, task: &Task) -> PyResult<()> {
        py.check_signals()?;
        self.report(py, task)
    }

    fn report(&mut self, py: Python<'_>, task: &Task) -> PyResult<()> {
        let now = task.progress();
        if let Some(callback) = &self.progress
            && !now.stage.is_empty()
            && now != self.last
        {
            callback.call1(py, (now.stage, now.fraction))?;
            self.last = now;
        }
        Ok(())
    }
}

/// Runs `work` without the GIL and gives its result.
///
/// The switch is looked at before anything else, and the callback hears of the last stage even if
/// the work was too short to be watched.
///
/// # Errors
/// What `work` gives, what the callback raises, `KeyboardInterrupt`, `Cancelled`; a panic in `work`
/// becomes a `BonemeshError`.
pub(crate) fn detached<T, W>(py: Python<'_>, mut watch: Watch, work: W) -> PyResult<T>
where
    T: Send + 'static,
    W: FnOnce(&Task) -> Result<T, Error> + Send + 'static,
{
    if watch.cancel.is_cancelled() {
        return Err(errors::cancelled(py));
    }
    let task = Task::default();
    let desk = Arc::new(Desk::default());
    let worker = {
        let (task, desk) = (task.clone(), desk.clone());
        thread::Builder::new()
            .name("bonemesh".to_owned())
            .spawn(move || desk.leave(catch_unwind(AssertUnwindSafe(|| work(&task)))))
            .map_err(|e| errors::no_thread(py, &e))?
    };
    let mut stopped = None;
    let outcome = loop {
        let (cancel, waiting) = (&watch.cancel, &desk);
        if let Some(outcome) = py.detach(|| waiting.wait(cancel, &task)) {
            break outcome;
        }
        if stopped.is_none()
            && let Err(exception) = watch.look(py, &task)
        {
            task.cancel().cancel();
            stopped = Some(exception);
        }
    };
    // The thread has nothing left to do but end; its panic, if any, is in the outcome.
    let _ = py.detach(|| worker.join());
    if let Some(exception) = stopped {
        return Err(exception);
    }
    let result = outcome.map_err(|payload| errors::bug(py, panic_message(payload.as_ref())))?;
    let value = result.map_err(|error| errors::raised(py, &error))?;
    watch.look(py, &task)?;
    Ok(value)
}

/// What a thread ends with: a result, or the payload of a panic.
type Outcome<T> = Result<Result<T, Error>, Box<dyn Any + Send>>;

/// Where the working thread leaves its outcome for the waiting one.
struct Desk<T> {
    outcome: Mutex<Option<Outcome<T>>>,
    bell: Condvar,
}

impl<T> Default for Desk<T> {
    fn default() -> Self {
        Self {
            outcome: Mutex::new(None),
            bell: Condvar::new(),
        }
    }
}

impl<T> Desk<T> {
    fn leave(&self, outcome: Outcome<T>) {
        *self.outcome.lock().unwrap_or_else(PoisonError::into_inner) = Some(outcome);
        self.bell.notify_one();
    }

    /// Waits up to [`LOOK`] for the outcome and hands the caller's `cancel` on to the `task`.
    fn wait(&self, cancel: &Cancel, task: &Task) -> Option<Outcome<T>> {
        let end = Instant::now() + LOOK;
        let mut outcome = self.outcome.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            if cancel.is_cancelled() {
                task.cancel().cancel();
            }
            let left = end.saturating_duration_since(Instant::now());
            if outcome.is_some() || left.is_zero() {
                return outcome.take();
            }
            outcome = self
                .bell
                .wait_timeout(outcome, left.min(SWITCH))
                .unwrap_or_else(PoisonError::into_inner)
                .0;
        }
    }
}

/// What a panic had to say.
fn panic_message(payload: &(dyn Any + Send)) -> &str {
    payload
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| payload.downcast_ref::<&str>().copied())
        .unwrap_or("no message")
}

//! The progress line on stderr.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use bonemesh_task::Task;
use indicatif::{ProgressBar, ProgressStyle};

/// How often the line is drawn anew.
const TICK: Duration = Duration::from_millis(100);
/// Steps of the bar.
const STEPS: u64 = 1000;

/// Draws the progress of a task until it is finished.
pub(super) struct Watcher {
    finished: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// Starts to draw the progress of `task`; nothing is drawn where stderr is no terminal.
pub(super) fn watch(task: &Task) -> Watcher {
    let finished = Arc::new(AtomicBool::new(false));
    let (task, done) = (task.clone(), Arc::clone(&finished));
    let bar = ProgressBar::new(STEPS);
    if let Ok(style) = ProgressStyle::with_template("{msg:12} [{bar:40}] {percent:>3} %") {
        bar.set_style(style);
    }
    let thread = (!bar.is_hidden()).then(|| {
        std::thread::spawn(move || {
            while !done.load(Ordering::Relaxed) {
                let progress = task.progress();
                bar.set_message(progress.stage);
                bar.set_position((progress.fraction * STEPS as f64) as u64);
                std::thread::park_timeout(TICK);
            }
            bar.finish_and_clear();
        })
    });
    Watcher { finished, thread }
}

impl Watcher {
    /// Clears the line.
    pub(super) fn finish(self) {
        self.finished.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread {
            thread.thread().unpark();
            // The thread only draws; should it have panicked, the result is not touched.
            let _ = thread.join();
        }
    }
}

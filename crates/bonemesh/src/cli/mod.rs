//! The `bonemesh` command: arguments in, text or one JSON object out.
//!
//! Exit codes: 0 done, 1 a failure that one line on stderr explains, 2 unusable arguments.
//! Progress goes to stderr and only to a terminal. Ctrl-C stops the work and leaves no file.

mod after_care;
mod after_care_values;
mod arguments;
mod check_text;
mod commands;
mod compare;
mod histogram;
mod mesh_file;
mod output;
mod phantom;
mod progress;
mod region;
mod roi;
mod sampling;
mod surface;
mod text;

use std::ffi::OsString;

use bonemesh_task::Task;
use clap::Parser;

use crate::panics::hush_foreign_panics;
use arguments::Arguments;

/// Exit code for a failure that a message explains.
const FAILED: u8 = 1;
/// Exit code after a second Ctrl-C, as shells give it.
const INTERRUPTED: i32 = 130;
/// Exit code for arguments that cannot be used.
const USAGE: u8 = 2;

/// Runs the command with `arguments` (the program's name first) and gives its exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(message) => {
            // Printing can only fail when the stream is closed, and then nobody reads it.
            let _ = message.print();
            return if message.use_stderr() { USAGE } else { 0 };
        }
    };
    hush_foreign_panics();
    let task = Task::default();
    let switch = task.cancel().clone();
    // The first signal asks the work to stop; a second one, for work that waits for a pipe or a
    // dead disk, ends the process. Where a host has its own handler, that one stays.
    let _ = ctrlc::set_handler(move || {
        if switch.is_cancelled() {
            std::process::exit(INTERRUPTED);
        }
        switch.cancel();
    });
    let watcher = progress::watch(&task);
    let result = commands::run(&arguments.command, &task);
    watcher.finish();
    let (message, code) = match result {
        Ok(answer) => match output::print(&answer, arguments.json) {
            Ok(()) => return 0,
            Err(message) => (message, FAILED),
        },
        Err(error) if error.is_of_choices() => (error.to_string(), USAGE),
        Err(error) => (error.to_string(), FAILED),
    };
    eprintln!("bonemesh: {}", text::printable(&message));
    code
}

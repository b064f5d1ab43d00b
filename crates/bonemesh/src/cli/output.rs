//! One answer, two voices: text for people, JSON for programs.

use std::io::Write;

use serde::Serialize;

/// What a command has to say.
pub(super) struct Answer {
    /// For people.
    pub(super) text: String,
    /// For programs.
    pub(super) json: serde_json::Value,
}

impl Answer {
    /// An answer whose JSON is `report`.
    pub(super) fn new(report: &impl Serialize, text: String) -> Self {
        let json = serde_json::to_value(report)
            .expect("reports have text keys and plain values: anything else is a bug");
        Self { text, json }
    }

    /// The same answer with one more field in its JSON.
    pub(super) fn with(mut self, key: &str, value: impl Into<serde_json::Value>) -> Self {
        if let Some(object) = self.json.as_object_mut() {
            object.insert(key.to_owned(), value.into());
        }
        self
    }
}

/// Prints `answer` on stdout.
///
/// A reader that closed the pipe early has what it wanted: that is no failure.
pub(super) fn print(answer: &Answer, as_json: bool) -> Result<(), String> {
    let mut line = if as_json {
        answer.json.to_string()
    } else {
        answer.text.trim_end().to_owned()
    };
    line.push('\n');
    match std::io::stdout().write_all(line.as_bytes()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write to stdout: {e}"))
        }
        _ => Ok(()),
    }
}

//! Runs the `bonemesh` command on a phantom head.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use serde_json::Value;
use tempfile::TempDir;

/// A phantom head, coarse enough for a quick test, made once.
static HEAD: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = TempDir::new().unwrap();
    let series = folder.path().join("head");
    let made = bonemesh(&["phantom", "head", text(&series), "--coarser", "2"]);
    assert!(made.status.success(), "{}", message(&made));
    folder
});

pub(crate) fn bonemesh(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bonemesh"))
        .args(arguments)
        .output()
        .unwrap()
}

pub(crate) fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

pub(crate) fn message(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

pub(crate) fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", message(output));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The head's bone as a file of this folder.
pub(crate) fn bone(folder: &Path) -> PathBuf {
    let bone = folder.join("bone.stl");
    json(&bonemesh(&[
        "render",
        text(&head()),
        "-o",
        text(&bone),
        "--json",
    ]));
    bone
}

pub(crate) fn head() -> PathBuf {
    HEAD.path().join("head")
}

/// One line on stderr that begins with the program's name, exit code 1, nothing on stdout.
pub(crate) fn assert_refused(output: &Output, word: &str) {
    let said = message(output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("bonemesh: "), "{said}");
    assert_eq!(said.trim_end().lines().count(), 1, "{said}");
    assert!(said.contains(word), "{said} has no {word}");
    assert!(output.stdout.is_empty());
}

//! The `bonemesh` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(bonemesh::cli::run(std::env::args_os()))
}

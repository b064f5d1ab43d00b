//! Tetrahedralises any points, and says as JSON how many cells they have and how long it took:
//! `cargo run --release -p bonemesh --example tetrahedralize_points -- POINTS [--threads N] [--alpha MM]`
//!
//! `POINTS` holds x, y, z of one point after the other as float64, little endian, and nothing
//! else. With `--alpha` the cells of the alpha complex are counted too.

use std::error::Error;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

use bonemesh::{Points, Task, pool, tetrahedralize};
use bonemesh_delaunay::alpha_complex;
use clap::Parser;
use serde_json::json;

/// Tetrahedralises a file of points.
#[derive(Parser)]
struct Arguments {
    /// File of float64 x, y, z, little endian.
    points: PathBuf,
    /// Worker threads; one per core unless given.
    #[arg(long)]
    threads: Option<NonZeroUsize>,
    /// Also count the cells with a circumradius of at most this.
    #[arg(long)]
    alpha: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let coordinates = read_points(&arguments.points)?;
    let points = Points::Free(&coordinates);
    let task = Task::default();
    let workers = pool(arguments.threads)?;

    let start = Instant::now();
    let cells = workers.install(|| tetrahedralize(points, &task))?.cells;
    let seconds = start.elapsed().as_secs_f64();
    let mut report = json!({
        "points": points.len(),
        "threads": workers.current_num_threads(),
        "cells": cells.len(),
        "seconds": seconds,
    });
    drop(cells);

    if let Some(alpha) = arguments.alpha {
        let start = Instant::now();
        let kept = workers
            .install(|| alpha_complex(points, alpha, &task))?
            .cells;
        report["alpha"] = alpha.into();
        report["alpha_cells"] = kept.len().into();
        report["alpha_seconds"] = start.elapsed().as_secs_f64().into();
    }
    println!("{report}");
    Ok(())
}

fn read_points(path: &Path) -> Result<Vec<[f64; 3]>, Box<dyn Error>> {
    let bytes = std::fs::read(path)?;
    let (numbers, rest) = bytes.as_chunks::<8>();
    if !rest.is_empty() || numbers.len() % 3 != 0 {
        let (file, length) = (path.display(), bytes.len());
        return Err(format!("{file} has {length} bytes; three float64 a point are 24").into());
    }
    let numbers: Vec<f64> = numbers.iter().map(|n| f64::from_le_bytes(*n)).collect();
    Ok(numbers.as_chunks::<3>().0.to_vec())
}

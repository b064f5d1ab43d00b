//! Scans the phantom head in any number of slices over the same height, as a DICOM series:
//! `cargo run --release -p bonemesh --example head_in_slices -- SLICES NEW_FOLDER`
//!
//! More slices are thinner ones: what grows is the data, not the body.

use std::error::Error;
use std::path::PathBuf;

use bonemesh::{Phantom, ScanSettings, Task, write_phantom};
use clap::Parser;

/// Writes the phantom head as a series of SLICES slices.
#[derive(Parser)]
struct Arguments {
    /// How many slices.
    #[arg(value_parser = clap::value_parser!(u16).range(1..))]
    slices: u16,
    /// Folder to make; the series goes to its sub-folder `dicom`.
    folder: PathBuf,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let usual = Phantom::Head.settings();
    let height_mm = usual.slices as f64 * usual.slice_mm;
    let settings = ScanSettings {
        slices: arguments.slices.into(),
        slice_mm: height_mm / f64::from(arguments.slices),
        ..usual
    };
    let written = write_phantom(
        Phantom::Head,
        &arguments.folder,
        &settings,
        &Task::default(),
    )?;
    let (files, folder) = (written.files.len(), written.series.display());
    println!("{files} slices of {:.3} mm in {folder}", settings.slice_mm);
    Ok(())
}

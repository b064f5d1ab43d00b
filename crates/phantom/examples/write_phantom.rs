//! Writes a phantom's DICOM series and truth, and says how long it took:
//! `cargo run --release -p bonemesh-phantom --example write_phantom -- head OUT [COARSER [ORIENTATION]]`

use std::path::PathBuf;
use std::time::Instant;

use bonemesh_phantom::{Phantom, ScanSettings, scan, write_phantom};
use bonemesh_task::Task;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words = std::env::args().skip(1);
    let phantom: Phantom = words.next().unwrap_or_else(|| "head".to_owned()).parse()?;
    let dir: PathBuf = words
        .next()
        .ok_or("name a new folder to write into")?
        .into();
    let coarser = words.next().map_or(Ok(1.0), |factor| factor.parse())?;
    let orientation = words.next().unwrap_or_else(|| "axial".to_owned()).parse()?;
    let settings = ScanSettings {
        orientation,
        ..phantom.settings().coarser(coarser)
    };
    let task = Task::default();
    let start = Instant::now();
    scan(phantom, &settings, &task)?;
    println!("scanned in {:.2?}", start.elapsed());
    let start = Instant::now();
    let written = write_phantom(phantom, &dir, &settings, &task)?;
    let files = written.files.len();
    println!("scanned and wrote {files} files in {:.2?}", start.elapsed());
    Ok(())
}

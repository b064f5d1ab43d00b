//! Writes a phantom: `cargo run --release -p bonemesh-phantom --example write_phantom -- NAME DIR [FACTOR]`.
use std::path::Path;
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().collect();
    let phantom: bonemesh_phantom::Phantom = args[1].parse()?;
    let factor = args.get(3).map_or(Ok(1.0), |f| f.parse())?;
    let settings = phantom.settings().coarser(factor);
    let task = bonemesh_task::Task::default();
    let start = std::time::Instant::now();
    bonemesh_phantom::scan(phantom, &settings, &task)?;
    println!("scan {:.2?}", start.elapsed());
    let start = std::time::Instant::now();
    bonemesh_phantom::write_phantom(phantom, Path::new(&args[2]), &settings, &task)?;
    println!("scan and write {:.2?}", start.elapsed());
    Ok(())
}

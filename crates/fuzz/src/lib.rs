//! What the fuzz targets share: a folder in memory, and the reading of a folder's series.

use std::fs;
use std::path::Path;

use bonemesh_dicom::{find_series, read_series};
use bonemesh_task::Task;

/// Where temporary files lie in memory, on Linux.
const IN_MEMORY: &str = "/dev/shm";

/// Writes the files into a folder of their own and gives it to `read`.
///
/// # Panics
/// When the folder cannot be written: the machine is at fault, not the input.
pub fn with_files(files: &[(&str, &[u8])], read: impl FnOnce(&Path)) {
    let folder = tempfile::tempdir_in(IN_MEMORY)
        .or_else(|_| tempfile::tempdir())
        .expect("a temporary folder can be made");
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).expect("a temporary file can be written");
    }
    read(folder.path());
}

/// Reads every series of a folder; anything but a panic, a hang or too much memory is right.
pub fn read_folder(folder: &Path) {
    let task = Task::default();
    if let Ok(scan) = find_series(folder, &task) {
        for series in &scan.series {
            let _ = read_series(series, &task);
        }
    }
}

/// Makes panics silent, for targets whose decoders' panics are caught on purpose.
///
/// The fuzzer's own hook would end the process before they are; one that is not caught is still
/// a finding.
pub fn catch_decoder_panics() {
    std::panic::set_hook(Box::new(|_| {}));
}

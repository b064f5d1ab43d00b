//! How much memory this process took at its worst.

/// Peak resident memory of this process in MiB, where the operating system tells it in a file
/// (Linux); `None` elsewhere.
pub(crate) fn peak_mib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024.0)
}

//! Panics that are somebody else's.
//!
//! Decoders written for honest input panic on damaged one. Such a panic is caught and becomes the
//! reason why a slice cannot be read; what the standard library prints of it would only confuse.

use std::panic;
use std::path::Path;
use std::sync::Once;

/// From now on, only panics of our own code, which are bugs, are printed to stderr.
pub fn hush_foreign_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if info.location().is_none_or(|l| is_ours(l.file())) {
                usual(info);
            }
        }));
    });
}

/// Whether a source file is of this workspace: its crates are compiled by relative paths.
fn is_ours(file: &str) -> bool {
    Path::new(file).starts_with("crates")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn our_own_panics_are_told_from_those_of_others() {
        assert!(is_ours(panic::Location::caller().file()));
        assert!(!is_ours(
            "/home/me/.cargo/registry/src/index/openjp2-0.6.1/src/tcd.rs"
        ));
        assert!(!is_ours("/rustc/abcdef/library/core/src/slice/index.rs"));
    }
}

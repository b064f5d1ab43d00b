//! Unique identifiers that follow from content.
//!
//! A 128-bit FNV-1a hash, marked as a UUID of version 8, written under 2.25 (DICOM PS3.5 B.2).

/// Hash of everything that was fed to it, in order.
#[derive(Clone, Copy)]
pub(super) struct Fingerprint(u128);

const BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

impl Fingerprint {
    pub(super) fn new() -> Self {
        Self(BASIS)
    }

    #[must_use]
    pub(super) fn with(mut self, bytes: &[u8]) -> Self {
        for byte in bytes {
            self.0 = (self.0 ^ u128::from(*byte)).wrapping_mul(PRIME);
        }
        // The length keeps "ab", "c" apart from "a", "bc".
        self.0 = (self.0 ^ bytes.len() as u128).wrapping_mul(PRIME);
        self
    }

    pub(super) fn uid(self) -> String {
        let version = 8_u128 << 76;
        let variant = 2_u128 << 62;
        let bits = self.0 & !(0xf_u128 << 76) & !(3_u128 << 62) | version | variant;
        format!("2.25.{bits}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uids_are_short_enough_and_tell_content_apart() {
        let one = Fingerprint::new().with(b"ab").with(b"c").uid();
        let other = Fingerprint::new().with(b"a").with(b"bc").uid();
        assert_ne!(one, other);
        assert!(one.len() <= 64 && one.starts_with("2.25."));
        assert_eq!(one, Fingerprint::new().with(b"ab").with(b"c").uid());
    }
}

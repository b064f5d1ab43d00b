//! Numbers as binary files store them.

/// A number's type in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Scalar {
    /// Bytes a number takes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The number in the first [`Scalar::size`] bytes, or `None` when there are fewer.
    pub(super) fn read(self, bytes: &[u8], is_big_endian: bool) -> Option<f64> {
        let size = self.size();
        let mut word = [0_u8; 8];
        // Always the low bytes of a little-endian word.
        for (at, byte) in bytes.get(..size)?.iter().enumerate() {
            word[if is_big_endian { size - 1 - at } else { at }] = *byte;
        }
        let word = u64::from_le_bytes(word);
        Some(match self {
            Self::I8 => f64::from(word as i8),
            Self::U8 => f64::from(word as u8),
            Self::I16 => f64::from(word as i16),
            Self::U16 => f64::from(word as u16),
            Self::I32 => f64::from(word as i32),
            Self::U32 => f64::from(word as u32),
            Self::I64 => word as i64 as f64,
            Self::U64 => word as f64,
            Self::F32 => f64::from(f32::from_bits(word as u32)),
            Self::F64 => f64::from_bits(word),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_byte_orders_and_signs_are_read() {
        assert_eq!(Scalar::I16.read(&[0xfe, 0xff], false), Some(-2.0));
        assert_eq!(Scalar::I16.read(&[0xff, 0xfe], true), Some(-2.0));
        assert_eq!(Scalar::U16.read(&[0xfe, 0xff], false), Some(65534.0));
        assert_eq!(Scalar::F32.read(&1.5_f32.to_be_bytes(), true), Some(1.5));
        assert_eq!(
            Scalar::F64.read(&(-0.1_f64).to_le_bytes(), false),
            Some(-0.1)
        );
        assert_eq!(Scalar::I64.read(&(-3_i64).to_be_bytes(), true), Some(-3.0));
        assert_eq!(Scalar::F64.read(&[0; 7], false), None);
    }
}

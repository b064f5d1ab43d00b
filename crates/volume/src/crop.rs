//! A box of voxels, written as people write it: `I0:I1,J0:J1,K0:K1`.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// Columns, rows and slices to keep; each range is half-open and counts from 0.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct CropBox {
    /// Columns to keep.
    pub columns: Range<usize>,
    /// Rows to keep.
    pub rows: Range<usize>,
    /// Slices to keep.
    pub slices: Range<usize>,
}

/// A crop box that cannot be used.
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CropError {
    /// Not of the written form.
    #[error(
        "`{0}` is no crop box; write first:end for columns, rows and slices, for example 0:256,0:346,2:91"
    )]
    Syntax(String),
    /// A range that keeps nothing.
    #[error("the crop box keeps no {axis} ({first}:{end}); the end must be above the first")]
    Empty {
        /// `columns`, `rows` or `slices`.
        axis: &'static str,
        /// First index kept.
        first: usize,
        /// First index not kept.
        end: usize,
    },
    /// A range beyond the volume.
    #[error(
        "the crop box asks for {axis} {first}:{end}, but the volume has {size}; the end may be at most {size}"
    )]
    Outside {
        /// `columns`, `rows` or `slices`.
        axis: &'static str,
        /// First index kept.
        first: usize,
        /// First index not kept.
        end: usize,
        /// How many the volume has.
        size: usize,
    },
}

impl fmt::Display for CropBox {
    /// As it is written.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [columns, rows, slices] = [&self.columns, &self.rows, &self.slices];
        write!(
            f,
            "{}:{},{}:{},{}:{}",
            columns.start, columns.end, rows.start, rows.end, slices.start, slices.end
        )
    }
}

impl CropBox {
    /// Checks the box against a volume of `[slices, rows, columns]`.
    ///
    /// # Errors
    /// [`CropError::Empty`] and [`CropError::Outside`].
    pub fn check(&self, shape: [usize; 3]) -> Result<(), CropError> {
        let [slices, rows, columns] = shape;
        for (axis, range, size) in [
            ("columns", &self.columns, columns),
            ("rows", &self.rows, rows),
            ("slices", &self.slices, slices),
        ] {
            let (first, end) = (range.start, range.end);
            if first >= end {
                return Err(CropError::Empty { axis, first, end });
            }
            if end > size {
                return Err(CropError::Outside {
                    axis,
                    first,
                    end,
                    size,
                });
            }
        }
        Ok(())
    }
}

impl FromStr for CropBox {
    type Err = CropError;

    fn from_str(text: &str) -> Result<Self, CropError> {
        let syntax = || CropError::Syntax(text.to_owned());
        let range = |part: &str| -> Result<Range<usize>, CropError> {
            let (first, end) = part.split_once(':').ok_or_else(syntax)?;
            let number = |n: &str| n.trim().parse().map_err(|_| syntax());
            Ok(number(first)?..number(end)?)
        };
        let parts: Vec<&str> = text.split(',').collect();
        let [columns, rows, slices] = parts[..] else {
            return Err(syntax());
        };
        let crop = Self {
            columns: range(columns)?,
            rows: range(rows)?,
            slices: range(slices)?,
        };
        crop.check([usize::MAX; 3])?;
        Ok(crop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_written_form_is_columns_rows_slices() {
        let crop: CropBox = "0:256, 0:346, 2:91".parse().unwrap();
        assert_eq!(crop.columns, 0..256);
        assert_eq!(crop.slices, 2..91);
        assert!(crop.check([91, 346, 256]).is_ok());
    }

    #[test]
    fn nonsense_and_empty_ranges_are_named() {
        for text in ["", "1:2", "a:b,0:1,0:1", "0:1,0:1,0:1,0:1", "-1:2,0:1,0:1"] {
            assert!(
                matches!(text.parse::<CropBox>(), Err(CropError::Syntax(_))),
                "{text}"
            );
        }
        assert!(matches!(
            "3:3,0:1,0:1".parse::<CropBox>(),
            Err(CropError::Empty {
                axis: "columns",
                ..
            })
        ));
    }
}

//! One slice: a frame of a file, placed along its stack.

use std::sync::Arc;

use crate::error::FileError;
use crate::frame::read_frame;
use crate::header::{Frame, Header};
use crate::hounsfield::{self, Voxel};

/// One slice of a stack; clones share the header.
#[derive(Clone, Debug)]
pub(crate) struct Slice {
    pub(crate) header: Arc<Header>,
    /// Number of the frame in its file, from 0.
    pub(crate) frame: usize,
    /// Position along the stack's normal (mm).
    pub(crate) along_mm: f64,
}

impl Slice {
    pub(crate) fn place(&self) -> &Frame {
        &self.header.frames[self.frame]
    }

    /// The file's name, and the frame where the file has several.
    pub(crate) fn name(&self) -> String {
        let name = self.header.path.file_name().unwrap_or_default();
        let name = name.to_string_lossy();
        if self.header.frames.len() > 1 {
            format!("{name} frame {}", self.frame + 1)
        } else {
            name.into_owned()
        }
    }

    /// Whether the Hounsfield units are whole numbers whatever the pixels are.
    pub(crate) fn is_whole(&self) -> bool {
        hounsfield::is_whole(&self.header.layout, self.place())
    }

    /// Decodes the slice into `hu`, row by row; false if a value does not fit the voxel type.
    pub(crate) fn decode<T: Voxel>(&self, hu: &mut [T]) -> Result<bool, FileError> {
        let header = &self.header;
        let bytes = read_frame(&header.path, &header.storage, &header.layout, self.frame)?;
        Ok(T::convert(&bytes, &header.layout, self.place(), hu))
    }

    /// Decodes the slice into memory of its own.
    pub(crate) fn decode_whole<T: Voxel>(&self) -> Result<Vec<T>, FileError> {
        let mut hu = vec![T::default(); self.header.layout.rows * self.header.layout.columns];
        self.decode(&mut hu)?;
        Ok(hu)
    }
}

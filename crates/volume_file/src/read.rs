//! The voxels of a file, converted on every core while the next ones are inflated.

use std::path::Path;

use bonemesh_task::Task;
use bonemesh_volume::Voxels;
use ndarray::Array3;
use rayon::prelude::*;

use crate::error::VolumeFileError;
use crate::header::Header;
use crate::sample::{Conversion, Summary, Voxel};

/// Bytes decoded between two looks at the task; a whole number of voxels of every type.
const BLOCK: usize = 1 << 20;

/// The voxels, and what was seen in them.
pub(crate) fn read(
    path: &Path,
    header: &Header,
    task: &Task,
) -> Result<(Voxels, Summary), VolumeFileError> {
    let shape = header.geometry.shape();
    let voxels: usize = shape.iter().product();
    task.begin("read", (header.data.bytes as usize).div_ceil(BLOCK));
    let mut stream = header.data.open(task)?;
    let mut sink = Sink {
        path,
        conversion: header.conversion,
        voxels: Store::Whole(zeros(path, voxels)?),
        filled: 0,
        summary: Summary::EMPTY,
    };
    let (mut ready, mut next) = (Vec::new(), Vec::new());
    stream.fill(&mut ready, BLOCK)?;
    while !ready.is_empty() {
        let (converted, decoded) =
            rayon::join(|| sink.push(&ready), || stream.fill(&mut next, BLOCK));
        converted?;
        decoded?;
        std::mem::swap(&mut ready, &mut next);
        task.advance(1)?;
    }
    let bug = "a stream that gives another number of voxels is a bug";
    let voxels = match sink.voxels {
        Store::Whole(v) => Voxels::I16(Array3::from_shape_vec(shape, v).expect(bug)),
        Store::Real(v) => Voxels::F32(Array3::from_shape_vec(shape, v).expect(bug)),
    };
    Ok((voxels, sink.summary))
}

/// Voxels that become 32-bit with the first value that does not fit 16 bits.
enum Store {
    Whole(Vec<i16>),
    Real(Vec<f32>),
}

struct Sink<'a> {
    path: &'a Path,
    conversion: Conversion,
    voxels: Store,
    filled: usize,
    summary: Summary,
}

impl Sink<'_> {
    /// Converts the next block.
    fn push(&mut self, bytes: &[u8]) -> Result<(), VolumeFileError> {
        let end = self.filled + bytes.len() / self.conversion.element.size();
        let place = self.filled..end;
        let mut seen = match &mut self.voxels {
            Store::Whole(v) => self.conversion.convert(bytes, &mut v[place.clone()]),
            Store::Real(v) => self.conversion.convert(bytes, &mut v[place.clone()]),
        };
        if let (Store::Whole(whole), false) = (&self.voxels, seen.fits) {
            let mut real = zeros::<f32>(self.path, whole.len())?;
            real[..self.filled]
                .par_iter_mut()
                .zip(&whole[..self.filled])
                .for_each(|(real, whole)| *real = f32::from(*whole));
            seen = self.conversion.convert(bytes, &mut real[place]);
            self.voxels = Store::Real(real);
        }
        self.filled = end;
        self.summary = self.summary.and(seen);
        Ok(())
    }
}

/// Memory that is not touched yet: a file that ends early has cost only what it held.
fn zeros<T: Voxel + Default>(path: &Path, length: usize) -> Result<Vec<T>, VolumeFileError> {
    // Asked for first in a way that may be refused: `vec!` would end the program.
    let mut probe: Vec<T> = Vec::new();
    probe
        .try_reserve_exact(length)
        .map_err(|_| VolumeFileError::Memory {
            path: path.to_owned(),
            bytes: length as u64 * size_of::<T>() as u64,
        })?;
    drop(probe);
    Ok(vec![T::default(); length])
}

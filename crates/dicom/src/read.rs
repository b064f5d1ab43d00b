//! The pixels of a series, read in parallel into one volume.

use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::{Volume, Voxels};
use ndarray::Array3;
use rayon::prelude::*;

use crate::error::{DicomError, FileError};
use crate::frame::is_readable;
use crate::hounsfield::Voxel;
use crate::series::Series;
use crate::slice::Slice;
use crate::stack::Source;

/// Of how many slices one at least must be readable for the rest to be filled in.
const MIN_READABLE_SHARE: usize = 2;

/// Grid places blended at a time: bounds the memory for the blends.
const BLENDS_AT_ONCE: usize = 32;

/// Reads the pixels of a series into a volume; also gives what a user should know about it.
///
/// Hounsfield units `[slice, row, column]`: each slice with its own rescale, 16-bit where all
/// values are whole and fit, 32-bit floating point otherwise. Places without a slice of their
/// own are linear between the slices around them (rounded in 16-bit volumes). Where slices lie
/// beside the straight line of their stack by more than half a pixel, they are moved within their
/// plane, linear between pixels; what comes from outside their image is air. A file that cannot
/// be read is named in the warnings and treated as missing; its place is filled, or, at an end
/// of the stack, the volume is shorter.
///
/// # Errors
/// [`DicomError::Implausible`] when the files are far too small for their pixels,
/// [`DicomError::TransferSyntax`] when the form of the pixels is not supported,
/// [`DicomError::Unreadable`] when fewer than half the slices, or fewer than 2, can be read,
/// [`DicomError::Memory`], [`DicomError::Volume`], [`DicomError::Cancelled`].
pub fn read_series(series: &Series, task: &Task) -> Result<(Volume, Vec<String>), DicomError> {
    for slice in &series.stack {
        let storage = &slice.header.storage;
        if !is_readable(storage.syntax_uid) {
            return Err(DicomError::TransferSyntax {
                name: storage.syntax_name.to_owned(),
                uid: storage.syntax_uid.to_owned(),
            });
        }
    }
    if !series.is_plausible() {
        let (slices, rows, columns) = (series.slices, series.rows, series.columns);
        return Err(DicomError::Implausible {
            slices,
            rows,
            columns,
        });
    }
    task.begin("read", series.stack.len());
    let mut warnings = series.warnings.clone();
    if series.stack.iter().all(Slice::is_whole) {
        let (read, fits) = Read::<i16>::new(series, task)?;
        if fits {
            let (array, begin) = read.into_array(series, task, &mut warnings)?;
            return volume(series, Voxels::I16(array), begin, warnings);
        }
        task.begin("read", series.stack.len());
    }
    let (read, _) = Read::<f32>::new(series, task)?;
    let (array, begin) = read.into_array(series, task, &mut warnings)?;
    let voxels = whole(&array).map_or(Voxels::F32(array), Voxels::I16);
    volume(series, voxels, begin, warnings)
}

fn volume(
    series: &Series,
    voxels: Voxels,
    begin: usize,
    warnings: Vec<String>,
) -> Result<(Volume, Vec<String>), DicomError> {
    let geometry = series.geometry(begin, voxels.shape()[0])?;
    Ok((Volume::new(voxels, geometry)?, warnings))
}

/// The array in 16 bits, if all its values are whole and fit.
fn whole(array: &Array3<f32>) -> Option<Array3<i16>> {
    let fits = |v: &f32| v.fract() == 0.0 && (-32768.0..=32767.0).contains(v);
    let values = array.as_slice()?;
    let all = values.par_chunks(1 << 16).all(|c| c.iter().all(fits));
    all.then(|| array.mapv(|v| v as i16))
}

/// Decoded slices: those on the grid in their place, the others aside.
struct Read<T> {
    grid: Vec<T>,
    aside: Vec<Option<Vec<T>>>,
    /// Grid place of each slice that is on the grid.
    places: Vec<Option<usize>>,
    /// Why a slice could not be read, in stack order.
    failures: Vec<Option<FileError>>,
    /// Pixels of a slice.
    pixels: usize,
}

impl<T: Voxel> Read<T> {
    /// Decodes all slices; also says whether all values fit the voxel type.
    fn new(series: &Series, task: &Task) -> Result<(Self, bool), DicomError> {
        let along: Vec<f64> = series.stack.iter().map(|s| s.along_mm).collect();
        let (_, sources) = series.grid.sources(&along);
        let pixels = series.rows * series.columns;
        let mut grid = zeros::<T>(series, pixels)?;
        let decode = |k: usize, hu: &mut [T]| -> Result<Outcome, Cancelled> {
            task.check()?;
            let outcome = Outcome {
                slice: k,
                result: series.stack[k].decode(hu),
            };
            series.line.straighten(&series.stack[k], hu);
            task.advance(1)?;
            Ok(outcome)
        };
        let on_grid = grid
            .par_chunks_mut(pixels)
            .zip(&sources)
            .filter_map(|(hu, source)| match source {
                Source::Slice(k) => Some(decode(*k, hu)),
                Source::Blend(..) => None,
            });
        let mut outcomes: Vec<Outcome> = on_grid.collect::<Result<_, _>>()?;
        let mut places = vec![None; along.len()];
        for (place, source) in sources.iter().enumerate() {
            if let Source::Slice(k) = source {
                places[*k] = Some(place);
            }
        }
        let off_grid: Vec<usize> = (0..along.len()).filter(|k| places[*k].is_none()).collect();
        let decoded: Result<Vec<(Outcome, Vec<T>)>, Cancelled> = off_grid
            .into_par_iter()
            .map(|k| {
                let mut hu = vec![T::default(); pixels];
                Ok((decode(k, &mut hu)?, hu))
            })
            .collect();
        let mut aside: Vec<Option<Vec<T>>> = along.iter().map(|_| None).collect();
        for (outcome, hu) in decoded? {
            aside[outcome.slice] = Some(hu);
            outcomes.push(outcome);
        }
        let mut failures: Vec<Option<FileError>> = along.iter().map(|_| None).collect();
        let mut fits = true;
        for outcome in outcomes {
            match outcome.result {
                Ok(fit) => fits &= fit,
                Err(error) => failures[outcome.slice] = Some(error),
            }
        }
        let read = Self {
            grid,
            aside,
            places,
            failures,
            pixels,
        };
        Ok((read, fits))
    }

    /// Fills the places without a slice; also gives the first place of the array on the grid.
    fn into_array(
        mut self,
        series: &Series,
        task: &Task,
        warnings: &mut Vec<String>,
    ) -> Result<(Array3<T>, usize), DicomError> {
        warnings.extend(self.lost(series)?);
        let readable: Vec<usize> = (0..self.failures.len())
            .filter(|k| self.failures[*k].is_none())
            .collect();
        let along: Vec<f64> = readable.iter().map(|k| series.stack[*k].along_mm).collect();
        let (begin, sources) = series.grid.sources(&along);
        let blends: Vec<(usize, usize, f64)> = sources
            .iter()
            .enumerate()
            .filter_map(|(i, source)| match source {
                Source::Blend(k, t) => Some((begin + i, *k, *t)),
                Source::Slice(_) => None,
            })
            .collect();
        for batch in blends.chunks(BLENDS_AT_ONCE) {
            task.check()?;
            let blended: Vec<Vec<T>> = batch
                .par_iter()
                .map(|(_, k, t)| {
                    let (a, b) = (self.slice(readable[*k]), self.slice(readable[k + 1]));
                    a.iter()
                        .zip(b)
                        .map(|(a, b)| T::between(*a, *b, *t))
                        .collect()
                })
                .collect();
            for ((place, ..), hu) in batch.iter().zip(blended) {
                self.grid[place * self.pixels..][..self.pixels].copy_from_slice(&hu);
            }
        }
        self.grid.truncate((begin + sources.len()) * self.pixels);
        self.grid.drain(..begin * self.pixels);
        let shape = [sources.len(), series.rows, series.columns];
        let array = Array3::from_shape_vec(shape, self.grid)
            .expect("a grid that is not a whole number of slices is a bug");
        Ok((array, begin))
    }

    /// Pixels of a slice that was decoded.
    fn slice(&self, k: usize) -> &[T] {
        match (self.places[k], &self.aside[k]) {
            (Some(place), _) => &self.grid[place * self.pixels..][..self.pixels],
            (None, Some(hu)) => hu,
            (None, None) => &[],
        }
    }

    /// A warning about slices that could not be read.
    fn lost(&self, series: &Series) -> Result<Option<String>, DicomError> {
        let slices = self.failures.len();
        let mut failed = self
            .failures
            .iter()
            .zip(&series.stack)
            .filter_map(|(failure, slice)| Some((failure.as_ref()?, slice)));
        let Some((reason, first)) = failed.next() else {
            return Ok(None);
        };
        let lost = 1 + failed.count();
        let readable = slices - lost;
        if readable < 2 || readable * MIN_READABLE_SHARE < slices {
            return Err(DicomError::Unreadable {
                readable,
                slices,
                path: first.header.path.clone(),
                reason: reason.to_string(),
            });
        }
        Ok(Some(format!(
            "{lost} of {slices} slices cannot be read and {} filled in or, at an end, left out; first {}: {reason}",
            if lost == 1 { "is" } else { "are" },
            first.name()
        )))
    }
}

/// What became of one slice.
struct Outcome {
    slice: usize,
    result: Result<bool, FileError>,
}

/// Memory for the whole grid, not touched yet: each thread touches what it decodes.
fn zeros<T: Voxel>(series: &Series, pixels: usize) -> Result<Vec<T>, DicomError> {
    let (slices, rows, columns) = (series.grid.count, series.rows, series.columns);
    let too_large = || DicomError::Memory {
        slices,
        rows,
        columns,
        bytes: slices as u64 * pixels as u64 * size_of::<T>() as u64,
    };
    let length = slices.checked_mul(pixels).ok_or_else(too_large)?;
    // Asked for first in a way that may be refused: `vec!` would end the program.
    let mut probe: Vec<T> = Vec::new();
    probe.try_reserve_exact(length).map_err(|_| too_large())?;
    drop(probe);
    Ok(vec![T::default(); length])
}

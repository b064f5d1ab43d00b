//! Arguments that several functions share, from Python's values to types that cannot be wrong.

use std::num::NonZeroUsize;
use std::ops::{Range, RangeInclusive};

use bonemesh::{
    CannySettings, CropBox, Error, HuThreshold, SeriesChoice, ThresholdChoice, ThresholdPreset,
};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyString};

use crate::errors;

/// More threads than any computer has cores; the system would refuse them one by one.
const MAX_THREADS: i128 = 1024;

/// How many worker threads.
pub(crate) struct Threads(NonZeroUsize);

impl Threads {
    /// The number for the library; `None` is one thread a core.
    pub(crate) fn count(threads: Option<Self>) -> Option<NonZeroUsize> {
        threads.map(|t| t.0)
    }
}

impl FromPyObject<'_, '_> for Threads {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let remedy = "give a whole number from 1 to 1024, or None for one a core";
        let count = whole("threads", &value, 1..=MAX_THREADS, remedy)?;
        Ok(NonZeroUsize::new(count as usize)
            .map(Self)
            .expect("at least 1: anything else is a bug"))
    }
}

/// Which series: a number from 1 or a UID.
pub(crate) struct Choice(pub(crate) SeriesChoice);

impl FromPyObject<'_, '_> for Choice {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let py = value.py();
        if value.is_instance_of::<PyString>() {
            let choice = value.extract::<String>()?.parse();
            return choice
                .map(Self)
                .map_err(|e| errors::raised(py, &Error::Dicom(e)));
        }
        let remedy =
            "give its number (1 is the largest), its UID, or None for the only plausible one";
        let number = whole("series", &value, 1..=i128::from(u32::MAX), remedy)?;
        Ok(Self(SeriesChoice::Number(number as usize)))
    }
}

/// Part of a volume: `"I0:I1,J0:J1,K0:K1"` or three pairs (columns, rows, slices).
pub(crate) struct Crop(pub(crate) CropBox);

impl FromPyObject<'_, '_> for Crop {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        if value.is_instance_of::<PyString>() {
            let crop = value.extract::<String>()?.parse();
            return crop.map(Self).map_err(|e| errors::unusable(value.py(), e));
        }
        let remedy =
            "give three pairs (first, end) of whole numbers from 0 for columns, rows and slices";
        let refused = || {
            let what = value.repr().map(|r| r.to_string()).unwrap_or_default();
            errors::argument(value.py(), &format!("crop is {what}; {remedy}"))
        };
        let ranges: Vec<Range<usize>> = items(&value)
            .and_then(|axes| axes.iter().map(|axis| range(axis, remedy)).collect())
            .ok_or_else(refused)?;
        let [columns, rows, slices] =
            <[Range<usize>; 3]>::try_from(ranges).map_err(|_| refused())?;
        Ok(Self(CropBox {
            columns,
            rows,
            slices,
        }))
    }
}

/// A pair of whole numbers from 0.
fn range(pair: &Bound<'_, PyAny>, remedy: &str) -> Option<Range<usize>> {
    let ends = items(pair)?;
    let [first, end] = &ends[..] else {
        return None;
    };
    let index = |value: &Bound<'_, PyAny>| {
        let index = whole("crop", value, 0..=i128::from(u32::MAX), remedy).ok()?;
        Some(index as usize)
    };
    Some(index(first)?..index(end)?)
}

/// What a sequence holds.
fn items<'py>(sequence: &Bound<'py, PyAny>) -> Option<Vec<Bound<'py, PyAny>>> {
    sequence.try_iter().ok()?.collect::<PyResult<_>>().ok()
}

/// A whole number in `range`; `True` and `False` are none.
pub(crate) fn whole(
    name: &str,
    value: &Bound<'_, PyAny>,
    range: RangeInclusive<i128>,
    remedy: &str,
) -> PyResult<i128> {
    let number = (!value.is_instance_of::<PyBool>())
        .then(|| value.extract::<i128>().ok())
        .flatten()
        .filter(|number| range.contains(number));
    number.map_or_else(
        || {
            let message = format!("{name} is {}; {remedy}", value.repr()?);
            Err(errors::argument(value.py(), &message))
        },
        Ok,
    )
}

/// Seed of a random generator.
pub(crate) fn seed(py: Python<'_>, seed: i128) -> PyResult<u64> {
    u64::try_from(seed).map_err(|_| {
        let remedy = "give a whole number from 0 to 2**64 - 1";
        errors::argument(py, &format!("seed is {seed}; {remedy}"))
    })
}

/// A threshold: a number in HU, or a name.
#[derive(Clone, Copy)]
pub(crate) struct Threshold(pub(crate) ThresholdChoice);

impl Threshold {
    /// The published threshold for skulls, which functions take where none is given.
    pub(crate) fn skull() -> Self {
        Self(ThresholdChoice::Given(ThresholdPreset::Skull.threshold()))
    }
}

impl FromPyObject<'_, '_> for Threshold {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let choice = if value.is_instance_of::<PyString>() {
            value.extract::<String>()?.parse()
        } else {
            HuThreshold::new(value.extract()?).map(ThresholdChoice::Given)
        };
        let choice = choice.map_err(|e| errors::unusable(value.py(), e))?;
        Ok(Self(choice))
    }
}

/// Alpha: a length in mm, or "auto".
#[derive(Clone, Copy)]
pub(crate) enum Alpha {
    Auto,
    Given(f64),
}

impl Alpha {
    /// The length, where one is given.
    pub(crate) fn mm(self) -> Option<f64> {
        match self {
            Self::Auto => None,
            Self::Given(alpha_mm) => Some(alpha_mm),
        }
    }
}

impl FromPyObject<'_, '_> for Alpha {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        if !value.is_instance_of::<PyString>() {
            return Ok(Self::Given(value.extract()?));
        }
        match value.extract::<String>()?.as_str() {
            "auto" => Ok(Self::Auto),
            other => {
                let remedy = "give a length in mm, \"auto\", or None for the mean distance";
                let message = format!("alpha_mm is {other:?}; {remedy}");
                Err(errors::argument(value.py(), &message))
            }
        }
    }
}

/// Poisson's depth; the library says which are possible.
pub(crate) fn depth(py: Python<'_>, depth: i128) -> PyResult<u32> {
    u32::try_from(depth).map_err(|_| {
        let message = format!("depth is {depth}; give a whole number from 3 to 8");
        errors::argument(py, &message)
    })
}

/// Canny's parameters; its thresholds are the usual ones where none are given.
pub(crate) fn canny(
    py: Python<'_>,
    sigma: f64,
    thresholds: Option<(f64, f64)>,
) -> PyResult<CannySettings> {
    let usual = CannySettings::default();
    let (low, high) = thresholds.unwrap_or((usual.low(), usual.high()));
    CannySettings::new(sigma, low, high).map_err(|e| errors::unusable(py, e))
}

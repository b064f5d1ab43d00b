//! What people hand in as arrays, checked and copied before the GIL is released.
//!
//! Anything that `numpy` can read as an array will do. What cannot be used is refused with one line
//! that names the argument, what it is and what it should be.

use std::ops::RangeInclusive;

use ndarray::Array2;
use numpy::{
    Element, PyArray, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use crate::errors::argument;

/// Kinds of numbers, as `numpy` abbreviates them.
const FLOATS: u8 = b'f';
const SIGNED: u8 = b'i';
const UNSIGNED: u8 = b'u';
const BOOLS: u8 = b'b';

/// An argument that `numpy` understood as an array.
pub(crate) struct Input<'py> {
    name: &'static str,
    array: Bound<'py, PyUntypedArray>,
}

/// The module itself. To be called before anything of the crate of its name, which panics without it.
pub(crate) fn numpy(py: Python<'_>) -> PyResult<&Bound<'_, PyModule>> {
    static NUMPY: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let module = NUMPY.get_or_try_init(py, || py.import("numpy").map(Bound::unbind))?;
    Ok(module.bind(py))
}

impl<'py> Input<'py> {
    /// Reads `value`, the argument called `name`, as an array.
    pub(crate) fn new(name: &'static str, value: &Bound<'py, PyAny>) -> PyResult<Self> {
        let py = value.py();
        let array = match numpy(py)?.call_method1("asarray", (value,)) {
            Ok(array) => array,
            Err(e)
                if e.is_instance_of::<PyValueError>(py) || e.is_instance_of::<PyTypeError>(py) =>
            {
                let reason = e.value(py).to_string();
                let reason = reason.lines().next().unwrap_or_default();
                return Err(argument(
                    py,
                    &format!("{name} is no array ({reason}); give rows of equal length"),
                ));
            }
            Err(e) => return Err(e),
        };
        let array = array.cast_into::<PyUntypedArray>()?;
        Ok(Self { name, array })
    }

    /// The interpreter that holds it.
    pub(crate) fn py(&self) -> Python<'py> {
        self.array.py()
    }

    /// The letter that `numpy` has for the kind of number.
    pub(crate) fn kind(&self) -> u8 {
        self.array.dtype().kind()
    }

    /// Bytes of one element.
    pub(crate) fn item_size(&self) -> usize {
        self.array.dtype().itemsize()
    }

    /// Length of each axis.
    pub(crate) fn shape(&self) -> &[usize] {
        self.array.shape()
    }

    /// Whether the elements are whole numbers.
    pub(crate) fn is_whole(&self) -> bool {
        matches!(self.kind(), SIGNED | UNSIGNED)
    }

    /// Whether the elements are true or false.
    pub(crate) fn is_bool(&self) -> bool {
        self.kind() == BOOLS
    }

    /// Whether the elements are whole or floating-point numbers.
    pub(crate) fn is_number(&self) -> bool {
        self.is_whole() || self.kind() == FLOATS
    }

    /// The error that this argument is not as it should be.
    pub(crate) fn refuse(&self, remedy: &str) -> PyErr {
        let shape: Vec<String> = self.shape().iter().map(usize::to_string).collect();
        let message = format!(
            "{} is an array of shape ({}) and type {}; {remedy}",
            self.name,
            shape.join(", "),
            self.array.dtype(),
        );
        argument(self.py(), &message)
    }

    /// The error that a row is not as it should be.
    fn refuse_row(&self, row: usize, value: &[f64; 3], remedy: &str) -> PyErr {
        let message = format!("{} holds {value:?} in row {row}; {remedy}", self.name);
        argument(self.py(), &message)
    }

    /// The error that an element is not as it should be.
    pub(crate) fn refuse_value(&self, value: impl std::fmt::Display, remedy: &str) -> PyErr {
        argument(self.py(), &format!("{} holds {value}; {remedy}", self.name))
    }

    /// Whether the type of the elements has no value beyond 16 bits with sign.
    pub(crate) fn fits_int16(&self) -> bool {
        let bytes = self.item_size();
        match self.kind() {
            SIGNED => bytes <= 2,
            UNSIGNED => bytes == 1,
            _ => false,
        }
    }

    /// The largest value that the type of whole numbers can hold.
    pub(crate) fn largest_whole(&self) -> f64 {
        let sign_bits = usize::from(self.kind() == SIGNED);
        2.0_f64.powi((8 * self.item_size() - sign_bits) as i32) - 1.0
    }

    /// Lets `read` look at the elements in C order as type `T`, which `numpy` calls `dtype`.
    ///
    /// The GIL is held meanwhile: nobody writes to them.
    pub(crate) fn read<T: Element, R>(
        &self,
        dtype: &str,
        read: impl FnOnce(&[T]) -> R,
    ) -> PyResult<R> {
        let needs = ["C_CONTIGUOUS", "ALIGNED"];
        let array = numpy(self.py())?.call_method1("require", (&self.array, dtype, needs))?;
        let array = array.cast_into::<PyArrayDyn<T>>()?;
        let elements = array.try_readonly()?;
        Ok(read(elements.as_slice()?))
    }

    /// `(N, 3)` finite numbers.
    pub(crate) fn vectors(&self) -> PyResult<Vec<[f64; 3]>> {
        self.check_vectors("give an (N, 3) array of numbers: x, y, z of each point in mm")?;
        let vectors = self.read("float64", triples::<f64>)?;
        let finite = |v: &&[f64; 3]| v.iter().all(|c| c.is_finite());
        match vectors.iter().position(|v| !finite(&v)) {
            Some(row) => {
                Err(self.refuse_row(row, &vectors[row], "remove what has no finite coordinates"))
            }
            None => Ok(vectors),
        }
    }

    /// `(M, 3)` indices, each below 2^32.
    pub(crate) fn index_triples(&self) -> PyResult<Vec<[u32; 3]>> {
        let remedy =
            "give an (M, 3) array of whole numbers: the three vertices of each triangle, from 0";
        if !self.is_whole() && !self.is_empty() {
            return Err(self.refuse(remedy));
        }
        self.check_vectors(remedy)?;
        let indices = self.whole_numbers(0..=i64::from(u32::MAX), "number the vertices from 0")?;
        Ok(triples(&indices)
            .into_iter()
            .map(|t| t.map(|v| v as u32))
            .collect())
    }

    /// `(N,)` indices, each below 2^32.
    pub(crate) fn indices(&self) -> PyResult<Vec<u32>> {
        if self.is_bool() {
            return Err(self.refuse("give indices, such as numpy.flatnonzero(..) of these marks"));
        }
        if self.shape().len() != 1 || !(self.is_whole() || self.is_empty()) {
            return Err(
                self.refuse("give a one-dimensional array of whole numbers: indices of vertices")
            );
        }
        let indices =
            self.whole_numbers(0..=i64::from(u32::MAX), "vertices are numbered from 0")?;
        Ok(indices.into_iter().map(|v| v as u32).collect())
    }

    /// `(N, 3)` whole numbers.
    pub(crate) fn whole_vectors(&self) -> PyResult<Vec<[i32; 3]>> {
        self.check_vectors("give an (N, 3) array of numbers: x, y, z of each point")?;
        let remedy = "lattice coordinates must fit into 32 bits; give float64 for free points";
        let flat = self.whole_numbers(i64::from(i32::MIN)..=i64::from(i32::MAX), remedy)?;
        Ok(triples(&flat)
            .into_iter()
            .map(|p| p.map(|c| c as i32))
            .collect())
    }

    /// Whole numbers in `range`, in C order.
    fn whole_numbers(&self, range: RangeInclusive<i64>, remedy: &str) -> PyResult<Vec<i64>> {
        let outside = |at: usize, value: &dyn std::fmt::Display| {
            self.refuse_value(format_args!("{value} at position {at}"), remedy)
        };
        if self.kind() == UNSIGNED && self.item_size() == 8 {
            let large = |v: &u64| i64::try_from(*v).is_err();
            let found = self.read("uint64", |values: &[u64]| {
                values.iter().position(large).map(|at| (at, values[at]))
            })?;
            if let Some((at, value)) = found {
                return Err(outside(at, &value));
            }
        }
        let values = self.read("int64", <[i64]>::to_vec)?;
        match values.iter().position(|v| !range.contains(v)) {
            Some(at) => Err(outside(at, &values[at])),
            None => Ok(values),
        }
    }

    fn check_vectors(&self, remedy: &str) -> PyResult<()> {
        match self.shape() {
            [_, 3] if self.is_number() => Ok(()),
            _ => Err(self.refuse(remedy)),
        }
    }

    /// Whether there is no element; `numpy` takes an empty list for floating-point numbers.
    fn is_empty(&self) -> bool {
        self.shape().contains(&0)
    }
}

/// The rows of an array with three columns.
fn triples<T: Copy>(elements: &[T]) -> Vec<[T; 3]> {
    elements.as_chunks::<3>().0.to_vec()
}

/// Rows of `N` numbers as an array.
pub(crate) fn rows<T, const N: usize>(rows: Vec<[T; N]>) -> Array2<T> {
    let shape = (rows.len(), N);
    Array2::from_shape_vec(shape, rows.into_flattened())
        .expect("as many numbers as the shape says: anything else is a bug")
}

/// A new array of Python's own.
pub(crate) fn owned<T: Element, D: ndarray::Dimension>(
    py: Python<'_>,
    array: ndarray::Array<T, D>,
) -> PyResult<Bound<'_, PyArray<T, D>>> {
    numpy(py)?;
    Ok(PyArray::from_owned_array(py, array))
}

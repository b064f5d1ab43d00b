//! Arrays that Python may look into but not change: the only `unsafe` code of the project.
#![allow(unsafe_code)]

use ndarray::{Array, Dimension};
use numpy::{Element, PyArray, PyArrayMethods};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;

/// A read-only view, without a copy, of an array that `owner` holds; it keeps the owner alive.
///
/// `numpy` refuses to make such a view writeable again, because its owner offers no writeable memory.
pub(crate) fn read_only<'py, C, T, D>(
    owner: &Bound<'py, C>,
    array: impl for<'a> Fn(&'a C) -> &'a Array<T, D>,
) -> Bound<'py, PyArray<T, D>>
where
    C: PyClass<Frozen = True> + Sync,
    T: Element,
    D: Dimension,
{
    let array = array(owner.get());
    // SAFETY: the array is borrowed from a frozen object, of which nobody ever has a mutable
    // reference: it is not written to, moved or dropped before the object. The view holds the
    // object as its base, and is made read-only before Python sees it.
    let view = unsafe { PyArray::borrow_from_array(array, owner.clone().into_any()) };
    // Nobody else has borrowed a new array, so taking it for writing cannot fail.
    drop(view.readwrite().make_nonwriteable());
    view
}

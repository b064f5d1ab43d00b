//! A CT volume.

use std::sync::Arc;

use bonemesh::{Affine, Geometry, Voxels, Window};
use ndarray::{Array3, arr2};
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::arrays::{Input, numpy, owned};
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::planes::SlicePlane;
use crate::views::read_only;

/// Largest difference of the fourth row of an affine matrix from 0, 0, 0, 1.
const FOURTH_ROW: f64 = 1e-9;

/// A CT volume: Hounsfield units and their place in the patient; it never changes.
///
/// `hu` is `[slice, row, column]`; `patient_from_voxel` is the 4x4 matrix that takes a voxel's
/// `(column, row, slice, 1)` to the place of its centre in the patient (DICOM LPS, mm).
#[pyclass(frozen, module = "bonemesh")]
pub(crate) struct Volume {
    volume: Arc<bonemesh::Volume>,
    warnings: Vec<String>,
}

#[pymethods]
impl Volume {
    #[new]
    fn new(
        py: Python<'_>,
        hu: &Bound<'_, PyAny>,
        patient_from_voxel: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let voxels = voxels(&Input::new("hu", hu)?)?;
        let affine = affine(&Input::new("patient_from_voxel", patient_from_voxel)?)?;
        let volume = Geometry::new(voxels.shape(), affine)
            .and_then(|geometry| bonemesh::Volume::new(voxels, geometry))
            .map_err(|e| errors::unusable(py, e))?;
        Ok(Self::of(volume, Vec::new()))
    }

    /// Hounsfield units `[slice, row, column]`, int16 or float32: a read-only view.
    #[getter]
    fn hu<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        numpy(slf.py())?;
        Ok(match slf.get().volume.voxels() {
            Voxels::I16(_) => read_only(slf, Self::whole).into_any(),
            Voxels::F32(_) => read_only(slf, Self::fractional).into_any(),
        })
    }

    /// `(4, 4) float64`: `(column, row, slice, 1)` of a voxel to its centre in the patient (LPS, mm).
    #[getter]
    fn patient_from_voxel<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        owned(
            py,
            arr2(&self.volume.geometry().patient_from_voxel().matrix()),
        )
    }

    /// Distance between columns, between rows, and between slices along their normal (mm).
    #[getter]
    fn spacing_mm(&self) -> (f64, f64, f64) {
        self.volume.geometry().spacing_mm().into()
    }

    /// The pictures that can be taken along one normal: "axial", "coronal" or "sagittal", of the stack's own.
    fn plane(&self, py: Python<'_>, name: &str) -> PyResult<SlicePlane> {
        let anatomical = name.parse().map_err(|e| errors::unusable(py, e))?;
        Ok(SlicePlane::of(
            self.volume.geometry().slice_plane(anatomical),
        ))
    }

    /// A picture along a plane, `[row, column]`, the top row first; see `plane` for its place.
    ///
    /// - `position_mm`: along the plane's normal; between slices values are interpolated linearly.
    /// - `window_hu`: centre and width of what is shown from black to white: `uint8`; None gives `float32`
    ///   Hounsfield units, NaN where nothing was measured.
    #[pyo3(signature = (name, position_mm, *, window_hu=None, progress=None, cancel=None))]
    fn slice<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        position_mm: f64,
        window_hu: Option<(f64, f64)>,
        progress: Option<Py<PyAny>>,
        cancel: Option<&Cancel>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let watch = Watch::new(py, progress, cancel)?;
        let plane = self.plane(py, name)?.0;
        if !position_mm.is_finite() {
            let message = format!("position_mm is {position_mm}; give a place along the normal");
            return Err(errors::argument(py, &message));
        }
        let window = window_hu.map(|(centre, width)| Window::new(centre, width));
        let window = window.transpose().map_err(|e| errors::unusable(py, e))?;
        let volume = self.shared();
        let hu = detached(py, watch, move |task| {
            Ok(volume.slice(&plane, position_mm, task)?)
        })?;
        Ok(match window {
            Some(window) => owned(py, hu.map(|hu| window.grey(*hu)))?.into_any(),
            None => owned(py, hu)?.into_any(),
        })
    }

    /// What the reader had to say of the series.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    fn __repr__(&self) -> String {
        let [slices, rows, columns] = self.volume.geometry().shape();
        let [x, y, z] = self.volume.geometry().spacing_mm();
        format!(
            "<bonemesh.Volume, {slices} slices of {rows} x {columns}, spacing {x:.3} x {y:.3} x {z:.3} mm>"
        )
    }
}

impl Volume {
    /// A volume that was read or made.
    pub(crate) fn of(volume: bonemesh::Volume, warnings: Vec<String>) -> Self {
        Self {
            volume: Arc::new(volume),
            warnings,
        }
    }

    /// The volume, for work that goes on while Python may drop this object.
    pub(crate) fn shared(&self) -> Arc<bonemesh::Volume> {
        self.volume.clone()
    }

    fn whole(&self) -> &Array3<i16> {
        let Voxels::I16(hu) = self.volume.voxels() else {
            unreachable!("asked of whole voxels only: anything else is a bug")
        };
        hu
    }

    fn fractional(&self) -> &Array3<f32> {
        let Voxels::F32(hu) = self.volume.voxels() else {
            unreachable!("asked of fractional voxels only: anything else is a bug")
        };
        hu
    }
}

/// Voxels in 16 bits where all are whole numbers that fit, in single precision otherwise.
fn voxels(input: &Input<'_>) -> PyResult<Voxels> {
    let shape = match *input.shape() {
        [slices, rows, columns] if input.is_number() => [slices, rows, columns],
        _ => {
            return Err(
                input.refuse("give Hounsfield units [slice, row, column], int16 or float32")
            );
        }
    };
    let joined = "as many voxels as the shape says: anything else is a bug";
    if let Some(hu) = whole_voxels(input)? {
        return Ok(Voxels::I16(
            Array3::from_shape_vec(shape, hu).expect(joined),
        ));
    }
    let hu = input.read("float32", <[f32]>::to_vec)?;
    if let Some(value) = hu.iter().find(|v| !v.is_finite()) {
        let remedy = "replace it, for example with numpy.nan_to_num(hu, nan=-1000)";
        return Err(input.refuse_value(value, remedy));
    }
    Ok(Voxels::F32(
        Array3::from_shape_vec(shape, hu).expect(joined),
    ))
}

/// The voxels of an array of whole numbers, if all fit into 16 bits.
fn whole_voxels(input: &Input<'_>) -> PyResult<Option<Vec<i16>>> {
    if !input.is_whole() {
        return Ok(None);
    }
    if input.fits_int16() {
        return input.read("int16", <[i16]>::to_vec).map(Some);
    }
    let fits = |v: &f64| (f64::from(i16::MIN)..=f64::from(i16::MAX)).contains(v);
    input.read("float64", |values: &[f64]| {
        let all = values.iter().all(fits);
        all.then(|| values.iter().map(|v| *v as i16).collect())
    })
}

/// The upper three rows of a 4x4 matrix.
fn affine(input: &Input<'_>) -> PyResult<Affine> {
    let remedy = "give a 4x4 matrix whose last row is 0, 0, 0, 1";
    if *input.shape() != [4, 4] || !input.is_number() {
        return Err(input.refuse(remedy));
    }
    let values = input.read("float64", <[f64]>::to_vec)?;
    let row = |r: usize| std::array::from_fn::<f64, 4, _>(|c| values[4 * r + c]);
    let mut last = row(3).into_iter().zip([0.0, 0.0, 0.0, 1.0]);
    if !last.all(|(v, wanted)| (v - wanted).abs() <= FOURTH_ROW) {
        return Err(input.refuse(remedy));
    }
    Ok(Affine::from_rows([row(0), row(1), row(2)]))
}

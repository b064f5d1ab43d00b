//! Canny's edges of images that people bring themselves.

use bonemesh::{Affine, CannySettings, Error, Geometry, Task};
use bonemesh_segment::{Mask, detect_edges};
use ndarray::parallel::prelude::*;
use ndarray::{Array3, Axis, Zip};

use pyo3::prelude::*;

use crate::arrays::{Input, owned};
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::options::{self, Threads};

/// One image or a stack of them, `[slice, row, column]`.
enum Images {
    Bool(Array3<bool>),
    Grey(Array3<f64>),
}

/// Canny's edges of an image `[row, column]`, or of each image of a stack `[slice, row, column]`.
///
/// Pixel for pixel those of scikit-image's `feature.canny` with its usual borders. `sigma` is in
/// pixels. `low` and `high` are gradients where the image's full range is 1: True of a boolean
/// image, the type's largest value of whole numbers; floating-point images are taken as they are,
/// in double precision, and hold numbers only: NaN and infinities are refused.
#[pyfunction]
#[pyo3(signature = (image_or_stack, *, sigma=1.0, low=0.1, high=0.2, threads=None, progress=None, cancel=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments, as Python has them
pub(crate) fn canny<'py>(
    py: Python<'py>,
    image_or_stack: &Bound<'py, PyAny>,
    sigma: f64,
    low: f64,
    high: f64,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyAny>> {
    let watch = Watch::new(py, progress, cancel)?;
    let settings = options::canny(py, sigma, Some((low, high)))?;
    let input = Input::new("image_or_stack", image_or_stack)?;
    let is_stack = input.shape().len() == 3;
    let images = images(&input)?;
    let threads = Threads::count(threads);
    let edges = detached(py, watch, move |task| {
        bonemesh::pool(threads)?.install(|| match images {
            Images::Bool(stack) => edges_of_masks(stack, settings, task),
            Images::Grey(stack) => edges_of_images(&stack, settings, task),
        })
    })?;
    Ok(if is_stack {
        owned(py, edges)?.into_any()
    } else {
        owned(py, edges.index_axis_move(Axis(0), 0))?.into_any()
    })
}

fn edges_of_masks(
    voxels: Array3<bool>,
    settings: CannySettings,
    task: &Task,
) -> Result<Array3<bool>, Error> {
    if voxels.is_empty() {
        return Ok(voxels);
    }
    let (slices, rows, columns) = voxels.dim();
    // Edges do not depend on where in the patient the image lies.
    let unit = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
    let geometry = Geometry::new([slices, rows, columns], unit)?;
    Ok(detect_edges(&Mask { voxels, geometry }, settings, task)?.edges)
}

fn edges_of_images(
    stack: &Array3<f64>,
    settings: CannySettings,
    task: &Task,
) -> Result<Array3<bool>, Error> {
    let mut edges = Array3::from_elem(stack.raw_dim(), false);
    task.begin("edges", stack.len_of(Axis(0)));
    Zip::from(edges.axis_iter_mut(Axis(0)))
        .and(stack.axis_iter(Axis(0)))
        .into_par_iter()
        .try_for_each(|(mut edges, image)| -> Result<(), Error> {
            task.check()?;
            edges.assign(&bonemesh_segment::canny(image, settings)?);
            Ok(task.advance(1)?)
        })?;
    Ok(edges)
}

/// The images as the library takes them: whole numbers become fractions of their type's largest
/// value, as scikit-image makes them (a multiplication, and nothing below -1).
fn images(input: &Input<'_>) -> PyResult<Images> {
    let shape = match *input.shape() {
        [rows, columns] => [1, rows, columns],
        [slices, rows, columns] => [slices, rows, columns],
        _ => {
            return Err(
                input.refuse("give one image [row, column] or a stack [slice, row, column]")
            );
        }
    };
    let joined = "as many pixels as the shape says: anything else is a bug";
    if input.is_bool() {
        // Not read as `bool`: memory of that name may hold other bytes than 0 and 1.
        let pixels = input.read("uint8", |p: &[u8]| p.iter().map(|p| *p != 0).collect())?;
        return Ok(Images::Bool(
            Array3::from_shape_vec(shape, pixels).expect(joined),
        ));
    }
    if !input.is_number() || (input.is_whole() && input.item_size() == 8) {
        return Err(input.refuse(
            "give bool, 8- to 32-bit whole or floating-point pixels, astype(..) converts",
        ));
    }
    let mut pixels = input.read("float64", <[f64]>::to_vec)?;
    if input.is_whole() {
        let scale = 1.0 / input.largest_whole();
        for pixel in &mut pixels {
            *pixel = (*pixel * scale).max(-1.0);
        }
    }
    Ok(Images::Grey(
        Array3::from_shape_vec(shape, pixels).expect(joined),
    ))
}

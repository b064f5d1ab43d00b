//! The method written out literally as oracle, and counts that are known otherwise.

use super::kernel::gaussian_weights;
use super::*;
use bonemesh_phantom::{Phantom, model_images};
use bonemesh_volume::{Affine, Geometry};
use ndarray::arr2;
use proptest::prelude::*;

/// Correlation along one axis with weights that are symmetric (`sign` 1) or antisymmetric (-1),
/// in `SciPy`'s order: centre first, then pairs from the outside in.
fn correlate(
    image: &Array2<f64>,
    axis: usize,
    weights: &[f64],
    sign: f64,
    outside: impl Fn(isize, usize) -> Option<usize>,
) -> Array2<f64> {
    Array2::from_shape_fn(image.dim(), |(row, column)| {
        let at = |step: isize| {
            let mut place = [row, column];
            let length = image.shape()[axis];
            outside(place[axis] as isize + step, length).map_or(0.0, |inside| {
                place[axis] = inside;
                image[place]
            })
        };
        let mut sum = at(0) * weights[0];
        for distance in (1..weights.len()).rev() {
            let step = distance as isize;
            sum += (at(-step) + sign * at(step)) * weights[distance];
        }
        sum
    })
}

fn nothing(at: isize, length: usize) -> Option<usize> {
    (0..length as isize).contains(&at).then_some(at as usize)
}

#[expect(clippy::unnecessary_wraps, reason = "the other border has no pixel")]
fn repeated(at: isize, length: usize) -> Option<usize> {
    Some(at.clamp(0, length as isize - 1) as usize)
}

/// Every step on the whole image, nothing left out.
fn by_definition(image: &Array2<f64>, settings: CannySettings) -> Array2<bool> {
    let weights = gaussian_weights(settings.sigma());
    let blur = |image: &Array2<f64>| {
        let rows = correlate(image, 0, &weights, 1.0, nothing);
        correlate(&rows, 1, &weights, 1.0, nothing)
    };
    let ones = blur(&Array2::ones(image.dim()));
    let smoothed = blur(image) / (ones + f64::EPSILON);
    let derivative = |axis: usize| {
        let difference = correlate(&smoothed, axis, &[0.0, -1.0], -1.0, repeated);
        correlate(&difference, 1 - axis, &[2.0, 1.0], 1.0, repeated)
    };
    let (down, across) = (derivative(0), derivative(1));
    let magnitude = (&down * &down + &across * &across).mapv(f64::sqrt);
    let low = f64::from(settings.low() as f32);
    let low = if low == 0.0 {
        f64::from(1e-14_f32)
    } else {
        low
    };
    let (rows, columns) = image.dim();
    let stays = Array2::from_shape_fn(image.dim(), |(r, c)| {
        let is_inner = r > 0 && c > 0 && r + 1 < rows && c + 1 < columns;
        is_inner
            && magnitude[[r, c]] >= low
            && is_ridge(&magnitude, r, c, down[[r, c]], across[[r, c]])
    });
    let mut edges = Array2::from_shape_fn(image.dim(), |at| {
        stays[at] && magnitude[at] >= settings.high()
    });
    // Spread over what stays until nothing changes.
    loop {
        let spread = Array2::from_shape_fn(image.dim(), |(r, c)| {
            let rows = r.saturating_sub(1)..(r + 2).min(rows);
            stays[[r, c]]
                && rows
                    .into_iter()
                    .any(|j| (c.saturating_sub(1)..(c + 2).min(columns)).any(|i| edges[[j, i]]))
        });
        if spread == edges {
            return edges;
        }
        edges = spread;
    }
}

/// Whether a pixel is at least as high as its interpolated neighbours along the gradient.
fn is_ridge(magnitude: &Array2<f64>, r: usize, c: usize, down: f64, across: f64) -> bool {
    let at =
        |dr: isize, dc: isize| magnitude[[r.wrapping_add_signed(dr), c.wrapping_add_signed(dc)]];
    let (steep, flat) = (down.abs(), across.abs());
    let falls = (down <= 0.0) == (across <= 0.0);
    let diagonal = if falls { [1, 1] } else { [-1, 1] };
    let (straight, weight) = if (falls && steep > flat) || (!falls && steep >= flat) {
        ([diagonal[0], 0], flat / steep)
    } else {
        ([0, 1], steep / flat)
    };
    [1, -1].into_iter().all(|side| {
        let corner = at(side * diagonal[0], side * diagonal[1]);
        let side = at(side * straight[0], side * straight[1]);
        corner * weight + side * (1.0 - weight) <= magnitude[[r, c]]
    })
}

fn settings(sigma: f64, low: f64, high: f64) -> CannySettings {
    CannySettings::new(sigma, low, high).unwrap()
}

fn mask(voxels: Array3<bool>) -> Mask {
    let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
    let (k, j, i) = voxels.dim();
    let geometry = Geometry::new([k, j, i], affine).unwrap();
    Mask { voxels, geometry }
}

fn edges_of(image: &Array2<bool>, settings: CannySettings) -> Array2<bool> {
    let mask = mask(image.clone().insert_axis(Axis(0)));
    let edges = detect_edges(&mask, settings, &Task::default()).unwrap();
    edges.edges.index_axis_move(Axis(0), 0)
}

fn grey_edges(image: &ArrayView2<'_, f64>, settings: CannySettings) -> Array2<bool> {
    canny(image.view(), settings).unwrap()
}

fn as_grey(image: &Array2<bool>, value: f64) -> Array2<f64> {
    image.mapv(|bone| if bone { value } else { 0.0 })
}

fn any_settings() -> impl Strategy<Value = CannySettings> {
    let sigma = prop_oneof![Just(0.0), Just(1.0), Just(2.0), Just(30.0), 0.05..4.0_f64];
    let low = prop_oneof![Just(0.1), Just(0.0), Just(1e-15), 0.0..0.6_f64];
    (sigma, low, 0.0..0.5_f64).prop_map(|(sigma, low, more)| settings(sigma, low, low + more))
}

/// Boxes on an even ground, down to single pixels, often touching the border.
fn any_image() -> impl Strategy<Value = Array2<bool>> {
    let boxes = prop::collection::vec((0..40_usize, 0..80_usize, 1..25_usize, 1..40_usize), 0..7);
    (1..40_usize, 1..80_usize, boxes, any::<bool>()).prop_map(|(rows, columns, boxes, ground)| {
        let mut image = Array2::from_elem([rows, columns], ground);
        for (row, column, height, width) in boxes {
            for r in row..(row + height).min(rows) {
                for c in column..(column + width).min(columns) {
                    image[[r, c]] ^= true;
                }
            }
        }
        image
    })
}

proptest! {
    #[test]
    fn masks_get_the_edges_of_the_definition(image in any_image(), settings in any_settings()) {
        let expected = by_definition(&as_grey(&image, 1.0), settings);
        prop_assert_eq!(edges_of(&image, settings), expected);
    }

    #[test]
    fn grey_images_get_the_edges_of_the_definition(
        image in any_image(),
        settings in any_settings(),
        grain in prop::collection::vec(-1.0..1.0_f64, 97),
    ) {
        let mut grey = as_grey(&image, 1.0);
        for (pixel, grain) in grey.iter_mut().zip(grain.iter().cycle()) {
            *pixel += 0.3 * grain;
        }
        prop_assert_eq!(grey_edges(&grey.view(), settings), by_definition(&grey, settings));
        // A view whose rows do not lie one after the other in memory.
        let turned = grey.t();
        let expected = by_definition(&turned.to_owned(), settings);
        prop_assert_eq!(grey_edges(&turned, settings), expected);
    }

    #[test]
    fn a_mask_and_its_image_have_the_same_edges(image in any_image(), settings in any_settings()) {
        let grey = as_grey(&image, 1.0);
        prop_assert_eq!(edges_of(&image, settings), grey_edges(&grey.view(), settings));
    }
}

/// One slice of a model, drawn as `OpenCV` draws it.
fn model(phantom: Phantom) -> Array2<bool> {
    let images = model_images(phantom, [1, 512, 512]).unwrap();
    images.index_axis_move(Axis(0), 0)
}

fn count(edges: &Array2<bool>) -> usize {
    edges.iter().filter(|edge| **edge).count()
}

#[test]
fn the_published_ring_has_2156_edge_pixels_as_mask_and_as_grey_image() {
    let ring = model(Phantom::Cylinder);
    let settings = CannySettings::default();
    assert_eq!(count(&edges_of(&ring, settings)), 2156);
    assert_eq!(
        count(&grey_edges(&as_grey(&ring, 255.0).view(), settings)),
        2156
    );
}

#[test]
fn the_published_line_has_576_edge_pixels_as_grey_image() {
    let line = as_grey(&model(Phantom::Line), 255.0);
    assert_eq!(
        count(&grey_edges(&line.view(), CannySettings::default())),
        576
    );
}

#[test]
fn slices_do_not_see_each_other() {
    let image = |k: usize, j: usize, i: usize| (j / 5 + i / 7 + k).is_multiple_of(3);
    let stack = mask(Array3::from_shape_fn([4, 40, 50], |(k, j, i)| {
        image(k, j, i)
    }));
    let settings = CannySettings::default();
    let edges = detect_edges(&stack, settings, &Task::default()).unwrap();
    for k in 0..4 {
        let slice = Array2::from_shape_fn([40, 50], |(j, i)| image(k, j, i));
        assert_eq!(
            edges.edges.index_axis(Axis(0), k),
            edges_of(&slice, settings)
        );
    }
    assert!(edges.edges.iter().any(|edge| *edge));
}

#[test]
fn the_edges_are_the_same_for_any_number_of_threads() {
    let stack = mask(Array3::from_shape_fn([9, 64, 80], |(k, j, i)| {
        (k * 31 + j * j + i * i / 3) % 700 < 350
    }));
    let edges = [1, 2, 5].map(|threads| {
        let pool = bonemesh_task::pool(std::num::NonZeroUsize::new(threads)).unwrap();
        pool.install(|| detect_edges(&stack, CannySettings::default(), &Task::default()).unwrap())
    });
    assert!(edges.iter().all(|e| *e == edges[0]));
}

#[test]
fn a_mask_in_another_memory_order_has_the_same_edges() {
    let image = |k: usize, j: usize, i: usize| (j + 2 * i + 3 * k) % 17 < 8;
    let settings = CannySettings::default();
    let rows = mask(Array3::from_shape_fn([3, 30, 40], |(k, j, i)| {
        image(k, j, i)
    }));
    let mut columns = rows.clone();
    columns.voxels = Array3::from_shape_fn([40, 30, 3], |(i, j, k)| image(k, j, i)).reversed_axes();
    let task = Task::default();
    assert_eq!(
        detect_edges(&rows, settings, &task).unwrap(),
        detect_edges(&columns, settings, &task).unwrap()
    );
}

#[test]
fn pixels_that_are_no_usable_number_are_refused() {
    let mut grey = Array2::from_elem([8, 9], 1.0);
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 2e150, -2e150] {
        grey[[3, 4]] = value;
        let error = canny(grey.view(), CannySettings::default()).unwrap_err();
        let at = (3, 4);
        assert!(matches!(error, SegmentError::Pixel { row, column, .. } if (row, column) == at));
        assert!(error.to_string().contains("row 3, column 4"));
    }
    grey[[3, 4]] = 1e150;
    let expected = by_definition(&grey, CannySettings::default());
    assert_eq!(
        canny(grey.view(), CannySettings::default()).unwrap(),
        expected
    );
}

#[test]
fn settings_that_make_no_sense_are_refused() {
    for sigma in [-0.1, f64::NAN, f64::INFINITY, 101.0] {
        assert!(matches!(
            CannySettings::new(sigma, 0.1, 0.2),
            Err(SegmentError::Sigma(_))
        ));
    }
    for (low, high) in [
        (0.2, 0.1),
        (-0.1, 0.1),
        (f64::NAN, 0.2),
        (0.1, f64::INFINITY),
    ] {
        let error = CannySettings::new(1.0, low, high).unwrap_err();
        assert!(matches!(error, SegmentError::CannyThresholds { .. }));
    }
    assert_eq!(settings(1.0, 0.1, 0.2), CannySettings::default());
}

#[test]
fn a_mask_of_another_shape_than_its_geometry_is_refused() {
    let mut wrong = mask(Array3::from_elem([2, 3, 4], true));
    wrong.voxels = Array3::from_elem([2, 4, 3], true);
    let result = detect_edges(&wrong, CannySettings::default(), &Task::default());
    assert!(matches!(result, Err(SegmentError::Shape { .. })));
}

#[test]
fn cancelling_stops_the_edges() {
    let task = Task::default();
    task.cancel().cancel();
    let result = detect_edges(
        &mask(Array3::from_elem([2, 3, 4], true)),
        CannySettings::default(),
        &task,
    );
    assert!(matches!(result, Err(SegmentError::Cancelled(_))));
}

#[test]
fn images_without_pixels_have_no_edges() {
    let settings = CannySettings::default();
    assert!(grey_edges(&arr2::<f64, 0>(&[]).view(), settings).is_empty());
    assert!(grey_edges(&Array2::<f64>::zeros([0, 5]).view(), settings).is_empty());
}

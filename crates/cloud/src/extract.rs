//! From edge pixels to points.

use bonemesh_segment::EdgeMap;
use bonemesh_task::{Cancelled, Task};
use ndarray::ArrayView2;
use ndarray::Axis;
use rayon::prelude::*;

use crate::{CloudError, Frame, Lattice, PointCloud};

/// One point an edge pixel, ordered by slice, row, column.
///
/// An edge map without edges gives a cloud without points.
///
/// # Errors
/// [`CloudError::TooMany`], [`CloudError::NotFinite`] and [`CloudError::Cancelled`].
pub fn extract_points(
    edges: &EdgeMap,
    frame: Frame,
    task: &Task,
) -> Result<PointCloud, CloudError> {
    let slices = edges.edges.dim().0;
    task.begin("cloud", slices);
    let of_slice: Vec<Vec<[i32; 3]>> = (0..slices)
        .into_par_iter()
        .map(|slice| {
            task.check()?;
            let points = edge_pixels(&edges.edges.index_axis(Axis(0), slice), slice as i32);
            task.advance(1)?;
            Ok(points)
        })
        .collect::<Result<_, Cancelled>>()?;
    let frame_from_lattice = match frame {
        Frame::Patient => *edges.geometry.patient_from_voxel(),
        Frame::Image => edges.geometry.image_from_voxel(),
    };
    PointCloud::from_lattice(Lattice {
        coordinates: of_slice.concat(),
        frame_from_lattice,
    })
}

/// `(column, row, slice)` of a slice's edge pixels, ordered by row and column.
fn edge_pixels(edges: &ArrayView2<'_, bool>, slice: i32) -> Vec<[i32; 3]> {
    /// Most pixels are no edge; this many are passed over in one step.
    const STRIDE: usize = 64;
    let mut points = Vec::new();
    let mut gathered = Vec::new();
    for (row, line) in edges.rows().into_iter().enumerate() {
        let line = if let Some(line) = line.as_slice() {
            line
        } else {
            gathered.clear();
            gathered.extend(line);
            &gathered
        };
        for (stride, pixels) in line.chunks(STRIDE).enumerate() {
            if !pixels.iter().fold(false, |any, edge| any | edge) {
                continue;
            }
            for (offset, _) in pixels.iter().enumerate().filter(|(_, edge)| **edge) {
                points.push([(stride * STRIDE + offset) as i32, row as i32, slice]);
            }
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use bonemesh_volume::{Affine, Geometry};
    use ndarray::Array3;

    fn edge_map(edges: Array3<bool>) -> EdgeMap {
        let affine = Affine::from_axes(
            [0.0, 0.4, 0.0],
            [0.5, 0.0, 0.0],
            [0.0, 0.1, 2.0],
            [10.0, 20.0, 30.0],
        );
        let (k, j, i) = edges.dim();
        let geometry = Geometry::new([k, j, i], affine)
            .unwrap()
            .with_slice_locations_mm(-4.0, 3.0);
        EdgeMap { edges, geometry }
    }

    #[test]
    fn points_come_by_slice_row_and_column() {
        let pattern = |(k, j, i): (usize, usize, usize)| (7 * i + 5 * j + 3 * k) % 11 == 0;
        let map = edge_map(Array3::from_shape_fn([3, 9, 150], pattern));
        let cloud = extract_points(&map, Frame::Patient, &Task::default()).unwrap();
        let expected: Vec<[i32; 3]> = map
            .edges
            .indexed_iter()
            .filter(|(_, edge)| **edge)
            .map(|((k, j, i), _)| [i as i32, j as i32, k as i32])
            .collect();
        assert_eq!(cloud.lattice().unwrap().coordinates, expected);
        assert!(expected.len() > 300);
    }

    #[test]
    fn the_frames_are_the_patients_and_the_published_one() {
        let only = |at| at == (1, 2, 3);
        let map = edge_map(Array3::from_shape_fn([2, 4, 5], only));
        let at = |frame| {
            let cloud = extract_points(&map, frame, &Task::default()).unwrap();
            cloud.points_mm().to_vec()
        };
        assert_eq!(
            at(Frame::Patient),
            [map.geometry.patient_from_voxel().apply([3.0, 2.0, 1.0])]
        );
        let [dx, dy, _] = map.geometry.spacing_mm();
        let [image] = at(Frame::Image)[..] else {
            unreachable!()
        };
        let expected = [3.0 * dx - dx / 2.0, 2.0 * dy - dy / 2.0, -4.0 + 3.0];
        for (value, expected) in image.into_iter().zip(expected) {
            assert!((value - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn no_edges_give_no_points() {
        let map = edge_map(Array3::from_elem([2, 3, 4], false));
        let cloud = extract_points(&map, Frame::Patient, &Task::default()).unwrap();
        assert!(cloud.is_empty());
    }

    #[test]
    fn cancelling_stops_the_extraction() {
        let task = Task::default();
        task.cancel().cancel();
        let map = edge_map(Array3::from_elem([2, 3, 4], true));
        let result = extract_points(&map, Frame::Patient, &task);
        assert!(matches!(result, Err(CloudError::Cancelled(_))));
    }
}

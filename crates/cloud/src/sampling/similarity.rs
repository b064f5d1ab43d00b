//! How alike normals are, in the plane of the slices and as published.

use std::num::NonZeroUsize;

use bonemesh_task::Task;
use rayon::prelude::*;

use super::lines::double_angle;
use super::remaining::Remaining;
use super::slices::Slices;
use super::thesis_targeted::{NEIGHBOURS, mean_similarity, normals};
use crate::{CloudError, PointCloud};

/// Points from which a line in the plane is estimated, itself included: two on either side.
const NEAR: usize = 5;

/// Where normals are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum NormalsIn {
    /// In the plane of the slice, across the line that fits the five nearest points; without a sign.
    #[default]
    Plane,
    /// In space, from the 30 nearest points, with the sign that comes of it: as published.
    Space,
}

/// How alike the normals of points are that share a slice: the mean over all ordered pairs of 1 - angle /
/// (largest angle there can be), hence 1 for a straight line; over all slices by their points. 1 of nothing.
///
/// `neighbours` are the points from which a normal is found, itself included; `None` takes those of
/// [`NormalsIn`]. The time is quadratic in the points of a slice.
///
/// In space the points of a slice have but the normal of the slice, up or down by chance. Published were 0.89
/// for a straight line (whose least direction is not even unique, so a few of 50 normals differ) and 0.52 for a
/// parabola (of 50 normals 20 up and 30 down: (20^2 + 30^2) / 50^2); neither says anything of the shape.
///
/// # Errors
/// [`CloudError::Cancelled`].
pub fn normal_similarity(
    cloud: &PointCloud,
    kind: NormalsIn,
    neighbours: Option<NonZeroUsize>,
    task: &Task,
) -> Result<f64, CloudError> {
    task.begin("similarity", cloud.len());
    let slices = Slices::of(cloud);
    let of_slices: Vec<f64> = slices
        .par_iter()
        .map(|members| {
            let normals = match kind {
                NormalsIn::Plane => {
                    let count = neighbours.map_or(NEAR, NonZeroUsize::get);
                    lines(&slices, members, count, task)?
                }
                NormalsIn::Space => {
                    let points = cloud.points_mm();
                    let points: Vec<_> = members.iter().map(|i| points[*i as usize]).collect();
                    let count = neighbours.map_or(NEIGHBOURS, NonZeroUsize::get);
                    normals(&points, count, task)?
                }
            };
            task.advance(members.len())?;
            Ok(mean_similarity(&normals, task)? * members.len() as f64)
        })
        .collect::<Result<_, CloudError>>()?;
    if cloud.is_empty() {
        return Ok(1.0);
    }
    Ok(of_slices.iter().sum::<f64>() / cloud.len() as f64)
}

/// The line through the nearest points of each, as the direction of twice its angle: two lines at right
/// angles, which differ most, are opposite, so the published mean fits them as well.
fn lines(
    slices: &Slices<'_>,
    members: &[u32],
    count: usize,
    task: &Task,
) -> Result<Vec<[f64; 3]>, CloudError> {
    let places: Vec<_> = members.iter().map(|i| slices.in_plane_mm(*i)).collect();
    let flat: Vec<_> = places.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
    let mut all = Remaining::new(&flat, [1.0, 1.0, 0.0]);
    let mut found = Vec::with_capacity(members.len());
    for point in 0..members.len() as u32 {
        task.check()?;
        let nearest = all.nearest(point, count).iter();
        let [x, y] = double_angle(nearest.map(|n| places[n.1 as usize]));
        // Where there is no line, any is as good.
        let is_none = x == 0.0 && y == 0.0;
        found.push(if is_none {
            [1.0, 0.0, 0.0]
        } else {
            [x, y, 0.0]
        });
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(y: impl Fn(f64) -> f64) -> PointCloud {
        let points = (0..50).map(|i| f64::from(2 * i)).map(|x| [x, y(x), 0.0]);
        PointCloud::from_points(points.collect()).unwrap()
    }

    fn similarity(cloud: &PointCloud, kind: NormalsIn) -> f64 {
        normal_similarity(cloud, kind, None, &Task::default()).unwrap()
    }

    #[test]
    fn a_straight_line_is_1_in_the_plane_and_a_parabola_clearly_less() {
        let line = curve(|x| 10.0 * x);
        let parabola = curve(|x| -(x - 50.0).powi(2));
        for cloud in [line.clone(), line.with_lattice_recognised()] {
            assert_eq!(
                similarity(&cloud, NormalsIn::Plane).to_bits(),
                1.0_f64.to_bits()
            );
        }
        for cloud in [parabola.clone(), parabola.with_lattice_recognised()] {
            let found = similarity(&cloud, NormalsIn::Plane);
            assert!(found > 0.5 && found < 0.95, "{found}");
        }
        let steep = curve(|x| 1e-3 * x * x * x);
        assert!(similarity(&steep, NormalsIn::Plane) < 0.98);
    }

    #[test]
    fn in_space_even_a_straight_line_differs_from_itself_and_a_parabola_is_up_and_down() {
        let line = similarity(&curve(|x| 10.0 * x), NormalsIn::Space);
        assert!(line < 1.0, "{line}");
        let parabola = similarity(&curve(|x| -(x - 50.0).powi(2)), NormalsIn::Space);
        // Some of the 50 up, the others down.
        let is_split = |up: i32| {
            let [up, down] = [f64::from(up), f64::from(50 - up)];
            ((up * up + down * down) / 2500.0 - parabola).abs() < 1e-9
        };
        assert!((1..50).any(is_split), "{parabola}");
    }

    #[test]
    fn few_and_equal_points_are_alike() {
        for points in [vec![], vec![[1.0, 2.0, 3.0]], vec![[1.0, 2.0, 3.0]; 9]] {
            let cloud = PointCloud::from_points(points).unwrap();
            for kind in [NormalsIn::Plane, NormalsIn::Space] {
                assert_eq!(similarity(&cloud, kind).to_bits(), 1.0_f64.to_bits());
            }
        }
    }
}

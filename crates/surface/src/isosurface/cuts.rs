//! The vertices: one on each cut edge.

use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::Affine;
use rayon::prelude::*;

use super::cut::{self, FROM_VOXEL};
use super::march::cut_edges;
use super::signs::Signs;
use super::slide::slide;

/// Where the edges between inside and outside are cut, in the order of vertices.
pub(super) struct Cuts {
    /// In voxels.
    pub(super) places: Vec<[f32; 3]>,
    /// Along which axis each edge runs; [`FIXED`] of those that end beyond the volume.
    axes: Vec<u8>,
}

/// The axis of an edge whose vertex stays: the volume's border is flat.
const FIXED: u8 = 3;

impl Cuts {
    /// `crossing` tells where between two values of `value` an edge is cut.
    pub(super) fn of(
        signs: &Signs,
        shape: [usize; 3],
        value: impl Fn([usize; 3]) -> f32 + Sync,
        crossing: impl Fn(f32, f32) -> f32 + Sync,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        let slices: Vec<(Vec<[f32; 3]>, Vec<u8>)> = (0..signs.slices())
            .into_par_iter()
            .map(|k| {
                task.advance(1)?;
                let (mut places, mut axes) = (Vec::new(), Vec::new());
                cut_edges(signs, k, |node, axis| {
                    let inner = cut::between(node, axis, shape, &value, &crossing);
                    axes.push(inner.map_or(FIXED, |_| axis as u8));
                    places.push(inner.unwrap_or_else(|| cut::border(node, axis)));
                });
                Ok((places, axes))
            })
            .collect::<Result<_, Cancelled>>()?;
        let (places, axes): (Vec<_>, Vec<_>) = slices.into_iter().unzip();
        Ok(Self {
            places: places.concat(),
            axes: axes.concat(),
        })
    }

    /// Slides the vertices along their edges, as far as these reach.
    pub(super) fn smooth(
        &mut self,
        triangles: &[[u32; 3]],
        affine: &Affine,
        tolerance_mm: f32,
        task: &Task,
    ) -> Result<(), Cancelled> {
        let spacing_mm = affine.spacing().map(|v| v as f32);
        let slides = slide(&self.places, triangles, spacing_mm, tolerance_mm, task)?;
        let places = self.places.par_iter_mut().zip(slides).zip(&self.axes);
        places.for_each(|((place, slide), axis)| {
            if *axis != FIXED {
                let axis = usize::from(*axis);
                let first = place[axis].floor();
                let part = place[axis] - first + slide[axis];
                place[axis] = first + part.clamp(FROM_VOXEL, 1.0 - FROM_VOXEL);
            }
        });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::isosurface::march::{Rows, triangles};

    const SHAPE: [usize; 3] = [24, 24, 24];
    const SPACING_MM: [f64; 3] = [0.5, 0.5, 1.0];

    /// The cuts before and after smoothing, each with the value that `exact` has there.
    fn smoothed(
        value: impl Fn([usize; 3]) -> f32 + Sync + Copy,
        exact: impl Fn([f32; 3]) -> f32,
    ) -> (Cuts, Cuts, [Vec<f32>; 2]) {
        let task = Task::default();
        let signs = Signs::of(SHAPE, |at| value(at) > 0.0, &task).unwrap();
        let rows = Rows::of(&signs).unwrap();
        let cuts = || Cuts::of(&signs, SHAPE, value, cut::linear, &task).unwrap();
        let (before, mut after) = (cuts(), cuts());
        let [x, y, z] = SPACING_MM;
        let affine = Affine::from_axes([x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z], [0.0; 3]);
        let triangles = triangles(&signs, &rows, &task).unwrap();
        after.smooth(&triangles, &affine, 0.1, &task).unwrap();
        let off = [&before, &after].map(|cuts| {
            let inner = |place: &&[f32; 3]| place.iter().all(|p| (6.0..17.0).contains(p));
            cuts.places
                .iter()
                .filter(inner)
                .map(|p| exact(*p))
                .collect()
        });
        (before, after, off)
    }

    fn mean_size(values: &[f32]) -> f32 {
        values.iter().map(|v| v.abs()).sum::<f32>() / values.len() as f32
    }

    #[test]
    fn a_plane_stays_where_it_is() {
        let plane = |[x, y, z]: [f32; 3]| 0.8 * (x - 11.3) + 0.5 * (y - 12.1) + 0.33 * (z - 11.8);
        let (_, _, [_, off]) = smoothed(|at| plane(at.map(|a| a as f32)), plane);
        // But for vertices beside voxels, which keep away from these.
        let most = off.iter().fold(0.0, |most: f32, v| most.max(v.abs()));
        assert!(off.len() > 100 && most < FROM_VOXEL, "{most}");
    }

    #[test]
    fn noise_goes_the_shape_stays_and_every_vertex_stays_on_its_edge() {
        let ball = |[x, y, z]: [f32; 3]| {
            let [x, y, z] = [x - 11.5, y - 11.5, 2.0 * (z - 11.5)];
            9.0 - (x * x + y * y + z * z).sqrt()
        };
        let noise = |[i, j, k]: [usize; 3]| {
            let mixed = (i * 73 + j * 179 + k * 283) * 2_654_435_761;
            (mixed >> 16 & 255) as f32 / 255.0 - 0.5
        };
        let value = |at: [usize; 3]| ball(at.map(|a| a as f32)) + 0.3 * noise(at);
        let (before, after, [noisy, smooth]) = smoothed(value, ball);
        let left = mean_size(&smooth) / mean_size(&noisy);
        assert!(left < 0.7, "{left}");
        let mean = smooth.iter().sum::<f32>() / smooth.len() as f32;
        assert!(mean.abs() < 0.02, "it neither shrinks nor grows: {mean}");
        let pairs = before.places.iter().zip(&after.places).zip(&before.axes);
        for ((from, to), axis) in pairs {
            for k in 0..3 {
                let moves = usize::from(*axis) == k && from[k] as usize == to[k] as usize;
                assert!(
                    moves || from[k].to_bits() == to[k].to_bits(),
                    "{from:?} {to:?}"
                );
            }
        }
    }
}

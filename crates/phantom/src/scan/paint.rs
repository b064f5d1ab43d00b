//! One slice of a body, painted sparsely.
//!
//! A rectangle of voxels is one material if no surface comes nearer to its middle than its
//! farthest corner; otherwise it is quartered, each quarter keeping only the parts of the body
//! that can reach it. What remains are a few voxels at a surface, sampled in cubes.

use bonemesh_task::Task;
use bonemesh_volume::Geometry;

use crate::PhantomError;
use crate::body::Layers;
use crate::vector::{Vec3, add, length, scale, sub};

/// Rectangles of at most this many columns and rows are painted voxel by voxel.
const LEAF: usize = 4;

struct Painter<'a> {
    image: Vec<f32>,
    columns: usize,
    steps: [Vec3; 3],
    origin: Vec3,
    /// Cubes in a voxel: their middles relative to the voxel's.
    cubes: Vec<Vec3>,
    side: f64,
    task: &'a Task,
}

/// Hounsfield units `[row, column]` of a slice, partial volume included.
pub(super) fn slice(
    layers: &Layers,
    geometry: &Geometry,
    slice: usize,
    task: &Task,
) -> Result<Vec<f32>, PhantomError> {
    let [_, rows, columns] = geometry.shape();
    let affine = geometry.patient_from_voxel();
    let steps = [affine.axis(0), affine.axis(1), affine.axis(2)];
    let (cubes, side) = split(steps);
    let mut painter = Painter {
        image: vec![layers.background_hu as f32; rows * columns],
        columns,
        steps,
        origin: affine.apply([0.0, 0.0, slice as f64]),
        cubes,
        side,
        task,
    };
    painter.fill(layers, [0, 0], [columns, rows])?;
    Ok(painter.image)
}

/// A voxel as nearly cubic parts: their middles relative to the voxel's, and their mean side.
fn split(steps: [Vec3; 3]) -> (Vec<Vec3>, f64) {
    let sides = steps.map(length);
    let least = sides[0].min(sides[1]).min(sides[2]);
    // More than 16 parts along a side add nothing that the noise would leave visible.
    let parts = sides.map(|s| ((s / least).round() as usize).clamp(1, 16));
    let mut cubes = Vec::with_capacity(parts[0] * parts[1] * parts[2]);
    for k in 0..parts[2] {
        for j in 0..parts[1] {
            for i in 0..parts[0] {
                let at = |n: usize, axis: usize| (n as f64 + 0.5) / parts[axis] as f64 - 0.5;
                let weights = [at(i, 0), at(j, 1), at(k, 2)];
                cubes.push((0..3).fold([0.0; 3], |sum, a| add(sum, scale(steps[a], weights[a]))));
            }
        }
    }
    let volume: f64 = (0..3).map(|a| sides[a] / parts[a] as f64).product();
    (cubes, volume.cbrt())
}

impl Painter<'_> {
    fn fill(
        &mut self,
        layers: &Layers,
        first: [usize; 2],
        end: [usize; 2],
    ) -> Result<(), PhantomError> {
        let size = [end[0] - first[0], end[1] - first[1]];
        let centre = self.at(
            (first[0] + end[0] - 1) as f64 / 2.0,
            (first[1] + end[1] - 1) as f64 / 2.0,
        );
        // Half of a cube's side more: a surface blurs so far by partial volume.
        let reach = self.reach(size) + self.side / 2.0;
        let near = layers.near(centre, reach);
        if near.tissues.is_empty() {
            self.flood(near.background_hu as f32, first, end);
        } else if size[0] <= LEAF && size[1] <= LEAF {
            self.sample(&near, first, end);
        } else {
            self.task.check()?;
            let middle = [
                first[0] + size[0].div_ceil(2),
                first[1] + size[1].div_ceil(2),
            ];
            for (c0, c1) in [(first[0], middle[0]), (middle[0], end[0])] {
                for (r0, r1) in [(first[1], middle[1]), (middle[1], end[1])] {
                    if c0 < c1 && r0 < r1 {
                        self.fill(&near, [c0, r0], [c1, r1])?;
                    }
                }
            }
        }
        Ok(())
    }

    fn at(&self, column: f64, row: f64) -> Vec3 {
        let across = add(scale(self.steps[0], column), scale(self.steps[1], row));
        add(self.origin, across)
    }

    /// Distance from the middle of a rectangle of voxels to its farthest corner.
    fn reach(&self, size: [usize; 2]) -> f64 {
        let u = scale(self.steps[0], size[0] as f64 / 2.0);
        let v = scale(self.steps[1], size[1] as f64 / 2.0);
        let w = scale(self.steps[2], 0.5);
        let corners = [
            add(add(u, v), w),
            sub(add(u, v), w),
            add(sub(u, v), w),
            sub(sub(u, v), w),
        ];
        corners.map(length).into_iter().fold(0.0, f64::max)
    }

    fn flood(&mut self, hu: f32, first: [usize; 2], end: [usize; 2]) {
        for row in first[1]..end[1] {
            let start = row * self.columns;
            self.image[start + first[0]..start + end[0]].fill(hu);
        }
    }

    fn sample(&mut self, layers: &Layers, first: [usize; 2], end: [usize; 2]) {
        for row in first[1]..end[1] {
            for column in first[0]..end[0] {
                let centre = self.at(column as f64, row as f64);
                let sum: f64 = self
                    .cubes
                    .iter()
                    .map(|cube| layers.mean_hu(add(centre, *cube), self.side))
                    .sum();
                self.image[row * self.columns + column] = (sum / self.cubes.len() as f64) as f32;
            }
        }
    }
}

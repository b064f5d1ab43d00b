//! Which points a normal is made of.

use std::num::NonZero;

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::{BATCH, NormalSettings, dot, minus};
use crate::{Forest, PointCloud};

/// A neighbourhood grows to so many times its size in search of other slices.
const GROWTH: [usize; 3] = [1, 3, 9];

/// Least part of a neighbourhood, as 1 / this, that is to lie in other slices.
const OTHER_SLICES: usize = 4;

/// The neighbours of every point.
pub(super) struct Neighbourhoods {
    /// Unit vector across the slices.
    pub(super) across_slices: [f64; 3],
    /// What tells the slices apart: a lattice's third coordinate, or z.
    slices: Vec<f64>,
    starts: Vec<usize>,
    neighbours: Vec<u32>,
}

impl Neighbourhoods {
    pub(super) fn of(
        cloud: &PointCloud,
        settings: NormalSettings,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        task.begin("neighbours", cloud.len());
        let search = Search::new(cloud, settings, task)?;
        let batches: Vec<Vec<Vec<u32>>> = (0..cloud.len().div_ceil(BATCH))
            .into_par_iter()
            .map(|batch| {
                let points = batch * BATCH..((batch + 1) * BATCH).min(cloud.len());
                let mut found = Vec::with_capacity(points.len());
                for i in points.clone() {
                    task.check()?;
                    found.push(search.around(i));
                }
                task.advance(points.len())?;
                Ok(found)
            })
            .collect::<Result<_, Cancelled>>()?;
        let mut starts = Vec::with_capacity(cloud.len() + 1);
        let mut neighbours = Vec::new();
        starts.push(0);
        for found in batches.iter().flatten() {
            neighbours.extend_from_slice(found);
            starts.push(neighbours.len());
        }
        Ok(Self {
            across_slices: across_slices(cloud),
            slices: search.slices,
            starts,
            neighbours,
        })
    }

    /// Whether two points lie in one slice.
    pub(super) fn share_slice(&self, i: usize, j: usize) -> bool {
        self.slices[i].to_bits() == self.slices[j].to_bits()
    }

    /// How many there are in all.
    pub(super) fn len(&self) -> usize {
        self.neighbours.len()
    }

    /// The neighbours of point `i`, without itself, the nearest first in each group of slices.
    pub(super) fn of_point(&self, i: usize) -> &[u32] {
        &self.neighbours[self.starts[i]..self.starts[i + 1]]
    }
}

fn across_slices(cloud: &PointCloud) -> [f64; 3] {
    let Some(lattice) = cloud.lattice() else {
        return [0.0, 0.0, 1.0];
    };
    let origin = lattice.frame_from_lattice.apply([0.0; 3]);
    let axis = |at: [f64; 3]| minus(lattice.frame_from_lattice.apply(at), origin);
    let (u, v) = (axis([1.0, 0.0, 0.0]), axis([0.0, 1.0, 0.0]));
    let across = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = dot(across, across).sqrt();
    across.map(|x| x / length)
}

struct Search<'a> {
    points: &'a [[f64; 3]],
    slices: Vec<f64>,
    forest: Forest,
    settings: NormalSettings,
}

impl<'a> Search<'a> {
    fn new(
        cloud: &'a PointCloud,
        settings: NormalSettings,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        let slices = match cloud.lattice() {
            Some(lattice) => lattice
                .coordinates
                .iter()
                .map(|at| f64::from(at[2]))
                .collect(),
            None => cloud.points_mm().iter().map(|p| p[2]).collect(),
        };
        Ok(Self {
            points: cloud.points_mm(),
            slices,
            forest: Forest::new(cloud.points_mm(), task)?,
            settings,
        })
    }

    /// The neighbours of point `i`: the nearest, or, where too few of these lie in other slices,
    /// the nearest of its own slice and of the others, half and half.
    fn around(&self, i: usize) -> Vec<u32> {
        let count = self.settings.neighbours;
        let mut found = Vec::new();
        for growth in GROWTH {
            found = self.nearest(i, count * growth);
            let in_others = found.iter().filter(|j| !self.share_slice(i, **j)).count();
            if in_others >= count / OTHER_SLICES {
                if growth == 1 {
                    return found;
                }
                break;
            }
            // There are no more within the radius.
            if found.len() + 1 < count * growth {
                break;
            }
        }
        let (own, others): (Vec<u32>, Vec<u32>) =
            found.iter().partition(|j| self.share_slice(i, **j));
        let from_others = others.len().min(count / 2);
        let from_own = own.len().min(count - 1 - from_others);
        [&own[..from_own], &others[..from_others]].concat()
    }

    fn share_slice(&self, i: usize, j: u32) -> bool {
        self.slices[i].to_bits() == self.slices[j as usize].to_bits()
    }

    /// The nearest `count` within the radius, without point `i` itself, which counts as one.
    fn nearest(&self, i: usize, count: usize) -> Vec<u32> {
        let count = NonZero::new(count).expect("three or more were asked for, else this is a bug");
        let reach = self.settings.radius_mm * self.settings.radius_mm;
        let nearest = self.forest.nearest(self.points[i], count, reach);
        let others = nearest.iter().map(|n| n.point).filter(|j| *j as usize != i);
        others.collect()
    }
}

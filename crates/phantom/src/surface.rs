//! The bone surface of a body as a ruler: how far any point lies from it, and how much bone there is.
//!
//! A body's field has the right sign and the right surface everywhere, but near blends and in air
//! its size is only a lower bound of the distance. An error measured with it would come out too
//! small. Here the nearest point of the surface is searched until nothing nearer can exist.

mod foot;
mod lines;
mod search;
mod volume;

use bonemesh_task::Task;
use rayon::prelude::*;

use crate::body::{Body, Layers};
use crate::shape::build::{Solid, union};
use crate::vector::Vec3;
use crate::{Phantom, PhantomError};

/// Points that one worker measures before it looks whether the work was cancelled.
const AT_ONCE: usize = 64;
/// Just off the surface, on which side tissues are told (mm).
const BESIDE_MM: f64 = 0.02;

/// The surface of all bone of a body, in patient space (LPS, mm).
///
/// ```
/// use bonemesh_phantom::{BoneSurface, Phantom};
///
/// let surface = BoneSurface::of(Phantom::SphereShell).expect("it is a body");
/// let nearest = surface.nearest([0.0, 0.0, 37.5], 1.2);
/// assert!((nearest.distance_mm - 1.5).abs() < 0.005);
/// assert!(!nearest.crease);
/// assert!((nearest.wall_mm - 6.0).abs() < 0.01);
/// ```
pub struct BoneSurface {
    bone: Solid,
    layers: Layers,
    structures: Vec<(&'static str, Solid)>,
}

/// The point of a bone surface that is nearest to another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// How far it is, negative where the other point lies in bone. Right to 0.005 mm up to 1 mm,
    /// to half a percent beyond; may be infinite for points metres away.
    pub distance_mm: f64,
    /// The point of the surface.
    pub point_mm: [f64; 3],
    /// Direction out of the bone there, a unit vector.
    pub normal: [f64; 3],
    /// Whether the surface turns by more than 25 degrees on a walk of the asked length from there.
    pub crease: bool,
    /// Bone below the point, straight in; at most 20 mm are looked at.
    pub wall_mm: f64,
    /// Way from the point to the next bone, straight out; at most 20 mm are looked at.
    pub gap_mm: f64,
    /// Way from the point to air, straight out; at most 20 mm are looked at.
    pub air_mm: f64,
    /// Hounsfield units of what touches the bone there.
    pub outside_hu: f64,
    /// Which of [`BoneSurface::structures`] the surface belongs to.
    pub structure: usize,
}

impl BoneSurface {
    /// The surface of `phantom`, or `None` for the models that are drawn in pixels.
    pub fn of(phantom: Phantom) -> Option<Self> {
        let known = phantom.known()?;
        let bones = known.layers.tissues.iter().filter(|t| t.bone);
        let bone = union(bones.map(|t| Solid::clone(&t.shape)).collect());
        let mut structures = known.structures;
        if structures.is_empty() {
            structures.push((phantom.name(), Solid::clone(&bone)));
        }
        Some(Self {
            bone,
            layers: known.layers,
            structures,
        })
    }

    /// Names of the parts that the surface is made of.
    pub fn structures(&self) -> Vec<&'static str> {
        self.structures.iter().map(|(name, _)| *name).collect()
    }

    /// The nearest point of the surface.
    ///
    /// It is at a crease if a walk of `crease_mm` from it, in any of eight directions along the
    /// surface, meets a place where the surface faces more than 25 degrees away from where it
    /// faces at the point: at edges and corners, and where the surface bends with a radius below
    /// about 2.4 times `crease_mm`.
    ///
    /// # Panics
    /// Never for finite coordinates.
    pub fn nearest(&self, p: [f64; 3], crease_mm: f64) -> Nearest {
        let (point_mm, distance_mm) = search::nearest(&self.bone, p);
        let foot = foot::Foot::at(&self.bone, point_mm, p, distance_mm);
        let normal = foot.normal;
        Nearest {
            distance_mm,
            point_mm,
            normal,
            crease: foot.is_at_crease(&self.bone, crease_mm),
            wall_mm: foot::wall(&self.bone, point_mm, normal),
            gap_mm: foot::gap(&self.bone, point_mm, normal),
            air_mm: foot::way_to_air(&self.layers, point_mm, normal),
            outside_hu: self.layers.hu(foot.beside(BESIDE_MM)),
            structure: self.structure(point_mm),
        }
    }

    /// [`nearest`](Self::nearest) of many points, in their order.
    ///
    /// # Errors
    /// [`PhantomError`] when cancelled.
    pub fn nearest_of_all(
        &self,
        points: &[[f64; 3]],
        crease_mm: f64,
        task: &Task,
    ) -> Result<Vec<Nearest>, PhantomError> {
        task.begin("distances", points.len());
        let parts: Result<Vec<_>, PhantomError> = points
            .par_chunks(AT_ONCE)
            .map(|part| {
                let found: Vec<_> = part.iter().map(|p| self.nearest(*p, crease_mm)).collect();
                task.advance(part.len())?;
                Ok(found)
            })
            .collect();
        Ok(parts?.concat())
    }

    /// `count` points of the surface, each place as likely as any other: where random lines pass
    /// through it (Crofton 1868).
    ///
    /// # Errors
    /// [`PhantomError`] when cancelled.
    pub fn samples(
        &self,
        count: usize,
        seed: u64,
        task: &Task,
    ) -> Result<Vec<[f64; 3]>, PhantomError> {
        lines::samples(&self.bone, count, seed, task)
    }

    /// Volume of all bone, from cubes of `cell_mm`; with 0.25 mm right to 0.05 percent.
    ///
    /// # Errors
    /// [`PhantomError`] when cancelled.
    pub fn volume_mm3(&self, cell_mm: f64, task: &Task) -> Result<f64, PhantomError> {
        volume::of(&self.bone, cell_mm, task)
    }

    /// The structure whose own surface is the nearest, the first of those that share it.
    fn structure(&self, p: Vec3) -> usize {
        let away = |i: usize| self.structures[i].1.distance(p).abs();
        let all = 0..self.structures.len();
        let least = all.clone().map(away).fold(f64::INFINITY, f64::min);
        all.into_iter()
            .find(|i| away(*i) <= least + 1e-6)
            .unwrap_or_default()
    }
}

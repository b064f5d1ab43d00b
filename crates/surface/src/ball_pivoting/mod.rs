//! The surface over which a ball rolls from point to point.
//!
//! 1. `seed`: find three points that a ball of the smallest radius touches from outside with no
//!    point inside it.
//! 2. `roll`: pivot the ball around each free edge until it touches another point, which makes the
//!    next triangle; an edge where it meets nothing, or nothing that fits, stays a border.
//! 3. With each larger radius, roll on from the borders and from new seeds.
//!
//! Points of a lattice share balls by the dozen. To decide which is met first, each point is moved
//! by a tiny amount that its place alone gives (`ball::Ball`); the mesh keeps the true places.

mod ball;
mod front;

use std::borrow::Cow;
use std::collections::VecDeque;

use bonemesh_cloud::{NormalSettings, PointCloud, estimate_normals, mean_neighbour_distance};
use bonemesh_mesh::TriangleMesh;
use bonemesh_task::{Cancelled, Task};

use crate::SurfaceError;
use crate::sorted::sorted;
use ball::{Balls, scattered};
use bonemesh_mesh::vector::{cross, dot, minus};
use front::Front;

/// The smallest ball of the published study: so many mean distances to the nearest neighbour.
const RADIUS_FACTOR: f64 = 3.0;

/// Nearest unused points among which the other corners of a first triangle are looked for: among all,
/// points that no ball can reach would each cost the square of their neighbours.
const SEED_NEIGHBOURS: usize = 24;

/// A triangle agrees with a normal less than square to its own; more than ties are moved by.
const LEAST_COSINE: f64 = 0.01;

/// The balls that roll over a cloud.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct BallPivotingSettings {
    /// Radii in mm, the smallest first; `None` takes three and six times the mean distance to the
    /// nearest neighbour, as the published study did.
    pub radii_mm: Option<Vec<f64>>,
    /// How normals are estimated, which tell the ball which side is outside.
    pub normals: NormalSettings,
}

/// A mesh by ball pivoting, and the balls that made it.
#[derive(Clone, Debug, PartialEq)]
pub struct BallPivoted {
    /// Triangles that face the side on which the ball rolled; only vertices in use.
    pub mesh: TriangleMesh,
    /// The radii in mm, the smallest first.
    pub radii_mm: Vec<f64>,
}

/// The surface that balls of growing radius roll over, from point to point of `cloud`.
///
/// Promise: each edge has one triangle, or two that agree on which side is out; no triangle comes
/// twice. Of equal points the first is used.
///
/// Limits: the surface has borders wherever points are further apart than a ball's diameter: slices
/// 5 mm apart hardly join with the usual radii. Balls wider than a gap or a thin wall bridge it. A
/// vertex may have several fans of triangles. It is no better than the estimated normals.
///
/// F. Bernardini et al., *The ball-pivoting algorithm for surface reconstruction*, 1999. The stages
/// are those of [`estimate_normals`] and `surface`.
///
/// # Errors
/// [`SurfaceError::Radii`], [`SurfaceError::Cloud`] for clouds too small for normals or distances,
/// [`SurfaceError::NoDistance`] where points share places, [`SurfaceError::NothingPivoted`].
pub fn ball_pivoting(
    cloud: &PointCloud,
    settings: &BallPivotingSettings,
    task: &Task,
) -> Result<BallPivoted, SurfaceError> {
    let cloud = &*distinct(cloud, task)?;
    let radii_mm = radii(cloud, settings, task)?;
    let normals = estimate_normals(cloud, settings.normals, task)?;
    task.begin("surface", radii_mm.len() * cloud.len());
    let mut rolling = Rolling {
        normals: &normals,
        front: Front::new(cloud.len()),
        task,
    };
    for &radius_mm in &radii_mm {
        let balls = Balls::new(cloud.points_mm(), radius_mm, task)?;
        rolling.roll_on(&balls)?;
        for first in 0..cloud.len() as u32 {
            task.advance(1)?;
            if let Some(edges) = rolling.seed(&balls, first)? {
                rolling.roll(&balls, edges.into())?;
            }
        }
    }
    let triangles = rolling.front.into_triangles();
    if triangles.is_empty() {
        let radius_mm = radii_mm.last().copied().unwrap_or_default();
        return Err(SurfaceError::NothingPivoted { radius_mm });
    }
    let mesh = TriangleMesh::new(cloud.points_mm().to_vec(), triangles)?.compacted();
    Ok(BallPivoted { mesh, radii_mm })
}

/// The cloud without repeated points: of equal ones the first stays.
fn distinct<'a>(cloud: &'a PointCloud, task: &Task) -> Result<Cow<'a, PointCloud>, Cancelled> {
    let count = cloud.len();
    let places = (0u32..).zip(cloud.points_mm()).map(|(point, place)| {
        // Adding 0.0 turns -0.0 into 0.0.
        let place = place.map(|v| (v + 0.0).to_bits());
        (scattered(place), place, point)
    });
    let mut places = sorted(places, |of| (of.0 >> 56) as u8, |of| *of, task)?;
    places.dedup_by_key(|(_, place, _)| *place);
    if places.len() == count {
        return Ok(Cow::Borrowed(cloud));
    }
    let points = places.into_iter().map(|(_, _, point)| point);
    let bucket = |point: &u32| (256 * *point as usize / count) as u8;
    let order = sorted(points, bucket, |point| *point, task)?;
    Ok(Cow::Owned(cloud.subset(&order)))
}

fn radii(
    cloud: &PointCloud,
    settings: &BallPivotingSettings,
    task: &Task,
) -> Result<Vec<f64>, SurfaceError> {
    let Some(radii_mm) = &settings.radii_mm else {
        let nearest_mm = mean_neighbour_distance(cloud, 2, false, task)?;
        if nearest_mm <= 0.0 || !nearest_mm.is_finite() {
            return Err(SurfaceError::NoDistance);
        }
        return Ok(vec![
            RADIUS_FACTOR * nearest_mm,
            2.0 * RADIUS_FACTOR * nearest_mm,
        ]);
    };
    let is_length = |r: &f64| r.is_finite() && *r > 0.0;
    if radii_mm.is_empty() || !radii_mm.iter().all(is_length) {
        return Err(SurfaceError::Radii(radii_mm.clone()));
    }
    let mut radii_mm = radii_mm.clone();
    radii_mm.sort_by(f64::total_cmp);
    radii_mm.dedup();
    Ok(radii_mm)
}

/// A directed edge of a triangle, with the centre of the ball that touches its corners.
type Free = ([u32; 2], [f64; 3]);

struct Rolling<'a> {
    normals: &'a [[f64; 3]],
    front: Front,
    task: &'a Task,
}

impl Rolling<'_> {
    /// Rolls a ball of another radius on from every border whose triangle it can touch.
    fn roll_on(&mut self, balls: &Balls) -> Result<(), SurfaceError> {
        let mut edges = VecDeque::new();
        for ([a, b], opposite) in self.front.borders() {
            self.task.check()?;
            let touch = balls.touching([a, b, opposite]);
            if let Some(touch) = touch.filter(|t| balls.is_empty(t, &balls.near(t.centre))) {
                edges.push_back(([a, b], touch.centre));
            }
        }
        self.roll(balls, edges)
    }

    /// A first triangle at an unused point, if there is one; its edges.
    fn seed(&mut self, balls: &Balls, first: u32) -> Result<Option<[Free; 3]>, SurfaceError> {
        if self.front.is_used(first) {
            return Ok(None);
        }
        let mut near = balls.around(first);
        near.retain(|&v| !self.front.is_used(v));
        near.truncate(SEED_NEIGHBOURS);
        for (i, &second) in near.iter().enumerate() {
            self.task.check()?;
            for &third in &near[..i] {
                let Some(corners) = self.outward([first, second, third], balls) else {
                    continue;
                };
                let touch = balls.touching(corners);
                let touch = touch.filter(|t| balls.is_empty(t, &balls.near(t.centre)));
                if let Some(touch) = touch.filter(|_| self.front.takes(corners)) {
                    self.front.add(corners);
                    return Ok(Some(edges(corners, touch.centre)));
                }
            }
        }
        Ok(None)
    }

    /// Rolls the ball over the edges, and over those of all triangles that this makes.
    fn roll(&mut self, balls: &Balls, mut edges_to_do: VecDeque<Free>) -> Result<(), SurfaceError> {
        while let Some(([a, b], centre)) = edges_to_do.pop_front() {
            self.task.check()?;
            if !self.front.is_border([a, b]) {
                continue;
            }
            let opposite = self.front.opposite([a, b]);
            let Some((met, touch)) = balls.pivot([a, b], opposite, centre) else {
                continue;
            };
            let corners = [b, a, met];
            let fits =
                self.front.is_open(met) && self.agrees(corners, balls) && self.front.takes(corners);
            if fits {
                self.front.add(corners);
                edges_to_do.extend(&edges(corners, touch.centre)[1..]);
            }
        }
        Ok(())
    }

    /// The corners in the order that faces the side of their normals, if these agree.
    fn outward(&self, [a, b, c]: [u32; 3], balls: &Balls) -> Option<[u32; 3]> {
        [[a, b, c], [a, c, b]]
            .into_iter()
            .find(|corners| self.agrees(*corners, balls))
    }

    /// Whether a triangle faces the side that its corners' normals are on.
    fn agrees(&self, corners: [u32; 3], balls: &Balls) -> bool {
        let [a, b, c] = corners.map(|v| balls.place(v));
        let normal = cross(minus(b, a), minus(c, a));
        let least = LEAST_COSINE * dot(normal, normal).sqrt();
        let mut normals = corners.iter().map(|&v| self.normals[v as usize]);
        normals.all(|n| dot(normal, n) > least)
    }
}

/// The edges of a triangle that a ball touches.
fn edges([a, b, c]: [u32; 3], centre: [f64; 3]) -> [Free; 3] {
    [([a, b], centre), ([b, c], centre), ([c, a], centre)]
}

#[cfg(test)]
mod tests;

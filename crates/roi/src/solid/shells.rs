//! The closed surfaces that a cut consists of, and which of them bound the same body.
//!
//! A body has one surface around it and one around each of its hollows. Those of hollows are inside out, and
//! belong to the first surface that a ray from them leaves without having entered it.

use bonemesh_mesh::{Sets, TriangleMesh, TriangleTree};
use bonemesh_task::Task;

use super::boolean::{Body, Source};
use crate::RoiError;
use bonemesh_mesh::vector::{Vector, cross, dot, minus, plus_scaled};

/// Which way rays go: as unlike all that lies along the axes as can be.
const TOWARDS: Vector = [0.481, 0.6123, 0.627_477_258_552_053];
/// What is passed over after a hit (mm), so that it is not met again.
const AFTER_HIT_MM: f64 = 1e-6;

/// Bodies of less than this (mm3) are crumbs: no printer makes them, and nobody meant them.
const CRUMB_MM3: f64 = 1.0;

/// Keeps the bodies that have a triangle of the patch. `is_front`: by the triangles of the bone, which of them
/// are the patch's.
pub(super) fn at_patch(
    (cut, sources): (Body, Vec<Source>),
    is_front: &[bool],
    task: &Task,
) -> Result<Body, RoiError> {
    let shells = Shells::of(&cut);
    let mut bodies = shells.bodies(&cut, task)?;
    let mut is_kept = vec![false; shells.volumes.len()];
    for (shell, source) in shells.of_triangles.iter().zip(&sources) {
        if matches!(source, Source::First(t) if is_front[*t as usize]) {
            is_kept[bodies.lowest(*shell) as usize] = true;
        }
    }
    let triangles = cut.triangles.into_iter().zip(&shells.of_triangles);
    let kept = triangles.filter(|(_, shell)| is_kept[bodies.lowest(**shell) as usize]);
    Ok(Body {
        vertices_mm: cut.vertices_mm,
        triangles: kept.map(|(triangle, _)| triangle).collect(),
    })
}

/// Keeps the bodies of at least [`CRUMB_MM3`] whose places are `meant`, and of their hollows those as large; of
/// crumbs alone the largest.
pub(super) fn without_crumbs(
    cut: Body,
    meant: impl Fn(&[Vector]) -> bool,
    task: &Task,
) -> Result<Body, RoiError> {
    let shells = Shells::of(&cut);
    let mut bodies = shells.bodies(&cut, task)?;
    let largest = shells.volumes.iter().copied().fold(0.0, f64::max);
    let least6 = largest.min(6.0 * CRUMB_MM3);
    let mut places = vec![Vec::new(); shells.volumes.len()];
    for (shell, triangle) in shells.of_triangles.iter().zip(&cut.triangles) {
        places[*shell as usize].extend(triangle.map(|v| cut.vertices_mm[v as usize]));
    }
    let is_meant = |shell: usize| shells.volumes[shell] > 0.0 && meant(&places[shell]);
    let is_large = |shell: usize| shells.volumes[shell].abs() >= least6;
    let mut is_body = vec![false; places.len()];
    for shell in (0..places.len()).filter(|shell| is_large(*shell) && is_meant(*shell)) {
        is_body[bodies.lowest(shell as u32) as usize] = true;
    }
    let is_kept: Vec<bool> = (0..places.len())
        .map(|shell| is_large(shell) && is_body[bodies.lowest(shell as u32) as usize])
        .collect();
    let triangles = cut.triangles.into_iter().zip(&shells.of_triangles);
    let kept = triangles.filter(|(_, shell)| is_kept[**shell as usize]);
    Ok(Body {
        vertices_mm: cut.vertices_mm,
        triangles: kept.map(|(triangle, _)| triangle).collect(),
    })
}

/// What hangs together of a surface.
struct Shells {
    /// The shell of each triangle.
    of_triangles: Vec<u32>,
    /// Six times the volume in each; below 0 in those of hollows.
    volumes: Vec<f64>,
}

impl Shells {
    fn of(cut: &Body) -> Self {
        let mut sets = Sets::new(cut.vertices_mm.len());
        for &[a, b, c] in &cut.triangles {
            sets.join(a, b);
            sets.join(b, c);
        }
        let mut numbers = vec![u32::MAX; cut.vertices_mm.len()];
        let mut volumes = Vec::new();
        let shell = |triangle: &[u32; 3]| {
            let root = sets.lowest(triangle[0]) as usize;
            if numbers[root] == u32::MAX {
                numbers[root] = volumes.len() as u32;
                volumes.push(0.0);
            }
            // From a place of its own, so that small volumes are not lost beside large coordinates.
            let from = cut.vertices_mm[root];
            let [a, b, c] = triangle.map(|v| minus(cut.vertices_mm[v as usize], from));
            volumes[numbers[root] as usize] += dot(a, cross(b, c));
            numbers[root]
        };
        let of_triangles = cut.triangles.iter().map(shell).collect();
        Self {
            of_triangles,
            volumes,
        }
    }

    /// The shells by body.
    fn bodies(&self, cut: &Body, task: &Task) -> Result<Sets, RoiError> {
        let mut bodies = Sets::new(self.volumes.len());
        if self.volumes.iter().all(|volume| *volume > 0.0) {
            return Ok(bodies);
        }
        let numbered = || self.of_triangles.iter().zip(&cut.triangles);
        let is_outer = |shell: u32| self.volumes[shell as usize] > 0.0;
        let (of_outer, outer): (Vec<u32>, Vec<[u32; 3]>) =
            numbered().filter(|(shell, _)| is_outer(**shell)).unzip();
        let outer = TriangleMesh::new(cut.vertices_mm.clone(), outer)?;
        let tree = TriangleTree::new(&outer, task)?;
        let mut is_placed = vec![false; self.volumes.len()];
        for (shell, triangle) in numbered().filter(|(shell, _)| !is_outer(**shell)) {
            if !std::mem::replace(&mut is_placed[*shell as usize], true)
                && let Some(around) = around(&tree, cut.vertices_mm[triangle[0] as usize])
            {
                bodies.join(*shell, of_outer[around as usize]);
            }
        }
        Ok(bodies)
    }
}

/// A triangle of the innermost closed surface around a place.
fn around(outer: &TriangleTree<'_>, mut place: Vector) -> Option<u32> {
    let mut entered = 0;
    loop {
        let (away, triangle) = outer.first_hit(place, TOWARDS, f64::INFINITY)?;
        let corners = outer.mesh().triangles()[triangle as usize];
        let [a, b, c] = outer.mesh().corners_mm(corners);
        if dot(cross(minus(b, a), minus(c, a)), TOWARDS) < 0.0 {
            entered += 1;
        } else if entered == 0 {
            return Some(triangle);
        } else {
            entered -= 1;
        }
        place = plus_scaled(place, away + AFTER_HIT_MM, TOWARDS);
    }
}

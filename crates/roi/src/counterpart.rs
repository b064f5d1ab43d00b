//! What of a mirrored body's other side lies where the selection is seen in the mirror.
//!
//! The selection may go around a defect, where nothing can be selected. So it is looked at as an area, seen
//! along its own mean direction: its triangles as a relief, gaps and holes in it closed. Pieces that face other
//! ways, such as those on both sides of the head, are looked at on their own. On the other side
//! those vertices count whose mirror images lie in that area, about as deep, and face the same way.

use std::collections::BTreeMap;

use bonemesh_mesh::{Plane, Sets, TriangleMesh, TriangleTree};
use bonemesh_task::Task;

use crate::RoiError;
use crate::selection::Selection;
use crate::solid::{Frame, Neighbourhood, Space, covered};
use bonemesh_mesh::vector::{Vector, cross, dot, length, minus, plus_scaled, unit_or_zero};

/// Side of a cell of the area (mm); larger where the area is.
const CELL_MM: f64 = 0.5;
const MOST_CELLS: f64 = 4e6;
/// Gaps in the area up to twice as wide (mm) are closed.
const GAP_MM: f64 = 1.5;
/// Triangles of a piece that are looked at to tell whether something lies before it, and how far (mm) before each.
const SAMPLES: usize = 32;
const BEFORE_MM: f64 = 1e-3;
/// Cosine of the most that pieces looked at together face apart.
const SAME_SIDE: f64 = 0.5;
/// How much deeper or higher (mm) than the selection the other side may be.
const UNEVEN_MM: f64 = 10.0;

/// What lies on the other side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counterparts {
    /// The vertices opposite to each part of the selection that faces about one way, ascending.
    pub sides: Vec<Vec<u32>>,
    /// Such parts that were left out: hidden in the bone, or with nothing opposite.
    pub left_out: usize,
}

/// The vertices of `mesh` whose mirror images lie where the `selected` ones do.
///
/// Pieces of the selection that face other ways are looked at on their own, so that each is cut on its own. Unless
/// hidden ones count (`with_hidden`), those beside the largest must be seen from where they face: the inner side of
/// a vault, which a lasso that sees through the bone picks up, belongs to the piece before it.
/// The triangles of `mesh` must face outward ([`bonemesh_mesh::face_outward`]).
///
/// # Errors
/// [`RoiError::NoFace`] for a selection without a triangle, [`RoiError::NoCounterpart`] where the other side
/// has nothing at all there, or the work was cancelled.
pub fn counterparts(
    mesh: &TriangleMesh,
    selected: &[u32],
    plane: &Plane,
    with_hidden: bool,
    task: &Task,
) -> Result<Counterparts, RoiError> {
    let selection = &Selection::new(selected, mesh.vertices_mm().len())?;
    let is_whole = |t: &&[u32; 3]| t.iter().all(|v| selection.contains(*v));
    let patch: Vec<[u32; 3]> = mesh.triangles().iter().filter(is_whole).copied().collect();
    if patch.is_empty() {
        return Err(RoiError::NoFace {
            selected: selection.indices().len(),
        });
    }
    let mut found = Counterparts {
        sides: Vec::new(),
        left_out: 0,
    };
    let mut sides = sides(mesh, patch);
    if !with_hidden && sides.len() > 1 {
        let tree = TriangleTree::new(mesh, task)?;
        let largest = sides.remove(0);
        let count = sides.len();
        sides.retain(|side| side.is_seen(&tree));
        found.left_out = count - sides.len();
        sides.insert(0, largest);
    }
    for side in sides {
        let mut opposite = side.opposite(mesh, plane, task)?;
        opposite.sort_unstable();
        if opposite.len() < 3 {
            found.left_out += 1;
        } else {
            found.sides.push(opposite);
        }
    }
    if found.sides.is_empty() {
        return Err(RoiError::NoCounterpart);
    }
    Ok(found)
}

/// A part of a selection that is looked at along one direction.
struct Side {
    triangles: Vec<[u32; 3]>,
    /// Twice the area, along the directions that the triangles face.
    facing: Vector,
}

/// The pieces of a patch that hang together, those that face about the same way as one side: they may lie
/// around one defect. The largest piece first.
fn sides(mesh: &TriangleMesh, patch: Vec<[u32; 3]>) -> Vec<Side> {
    let mut sets = Sets::new(mesh.vertices_mm().len());
    for [a, b, c] in &patch {
        sets.join(*a, *b);
        sets.join(*b, *c);
    }
    let mut pieces: BTreeMap<u32, Side> = BTreeMap::new();
    for triangle in patch {
        let [a, b, c] = mesh.corners_mm(triangle);
        let piece = pieces.entry(sets.lowest(triangle[0])).or_insert(Side {
            triangles: Vec::new(),
            facing: [0.0; 3],
        });
        piece.facing = plus_scaled(piece.facing, 1.0, cross(minus(b, a), minus(c, a)));
        piece.triangles.push(triangle);
    }
    let mut pieces: Vec<Side> = pieces.into_values().collect();
    pieces.sort_by(|a, b| length(b.facing).total_cmp(&length(a.facing)));
    let mut sides: Vec<Side> = Vec::new();
    for piece in pieces {
        let same = |side: &&mut Side| {
            dot(unit_or_zero(side.facing), unit_or_zero(piece.facing)) > SAME_SIDE
        };
        if let Some(side) = sides.iter_mut().find(same) {
            side.facing = plus_scaled(side.facing, 1.0, piece.facing);
            side.triangles.extend(piece.triangles);
        } else {
            sides.push(piece);
        }
    }
    sides
}

impl Side {
    /// Whether nothing lies before most of it.
    fn is_seen(&self, tree: &TriangleTree<'_>) -> bool {
        let outward = unit_or_zero(self.facing);
        let every = self.triangles.len().div_ceil(SAMPLES);
        let samples = self.triangles.iter().step_by(every);
        let is_covered = |triangle: &&[u32; 3]| {
            let [a, b, c] = tree.mesh().corners_mm(**triangle);
            let middle = [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0);
            let before = plus_scaled(middle, BEFORE_MM, outward);
            tree.first_hit(before, outward, f64::INFINITY).is_some()
        };
        let covered = samples.clone().filter(is_covered).count();
        2 * covered <= samples.count()
    }

    /// The vertices whose mirror images lie in its area.
    fn opposite(
        &self,
        mesh: &TriangleMesh,
        plane: &Plane,
        task: &Task,
    ) -> Result<Vec<u32>, RoiError> {
        let inward = unit_or_zero(self.facing.map(|v| -v));
        let area = Area::of(mesh, &self.triangles, Frame::along(inward));
        let area = area.ok_or(RoiError::NoCounterpart)?;
        task.check()?;
        let corners = self.triangles.iter().flat_map(|t| mesh.corners_mm(*t));
        let images = corners.map(|place| plane.mirrored(place));
        let space = Space::of(images).ok_or(RoiError::NoSelection)?;
        let other = Neighbourhood::around(mesh, &space.wider(UNEVEN_MM), task)?;
        let mut normals = vec![[0.0; 3]; other.vertices_mm.len()];
        for triangle in &other.triangles {
            let facing = other.facing(*triangle);
            for vertex in triangle {
                let normal = &mut normals[*vertex as usize];
                *normal = plus_scaled(*normal, 1.0, facing);
            }
        }
        let looks_in = plane.mirrored_direction(inward);
        let vertices = other.vertices_mm.iter().zip(&normals).zip(&other.of_mesh);
        let found = vertices.filter(|((place, normal), _)| {
            dot(**normal, looks_in) < 0.0 && area.has(plane.mirrored(**place))
        });
        Ok(found.map(|(_, vertex)| *vertex).collect())
    }
}

/// An area of the plane across a direction, and a range along it.
struct Area {
    frame: Frame,
    space: Space,
    cell_mm: f64,
    shape: [usize; 2],
    is_in: Vec<bool>,
}

impl Area {
    /// What triangles cover, with gaps and holes.
    fn of(mesh: &TriangleMesh, patch: &[[u32; 3]], frame: Frame) -> Option<Self> {
        let corners = |t: &[u32; 3]| mesh.corners_mm(*t).map(|place| frame.of(place));
        let space = Space::of(patch.iter().flat_map(corners))?.wider(2.0 * GAP_MM);
        let size = [0, 1].map(|axis| space.high[axis] - space.low[axis]);
        let cell_mm = CELL_MM.max((size[0] * size[1] / MOST_CELLS).sqrt());
        let shape = size.map(|size| (size / cell_mm).ceil() as usize + 1);
        let mut area = Self {
            frame,
            space,
            cell_mm,
            shape,
            is_in: vec![false; shape[0] * shape[1]],
        };
        for triangle in patch {
            let corners = corners(triangle).map(|corner| area.cell(corner));
            for corner in corners {
                let [i, j] = [corner[0], corner[1]].map(|c| c.round() as usize);
                area.is_in[j * shape[0] + i] = true;
            }
            for (i, j, _) in covered(corners, shape) {
                area.is_in[j * shape[0] + i] = true;
            }
        }
        area.close();
        Some(area)
    }

    /// A place's coordinates in cells.
    fn cell(&self, in_frame: Vector) -> Vector {
        [0, 1, 2].map(|axis| (in_frame[axis] - self.space.low[axis]) / self.cell_mm)
    }

    /// Closes gaps: what cannot be reached from outside by a disc of that radius is in.
    fn close(&mut self) {
        let radius = (GAP_MM / self.cell_mm).ceil() as usize;
        let is_wide = self.grown(&self.is_in, radius);
        let is_outside = self.reached_from_border(&is_wide);
        let is_shut = self.grown(&is_outside, radius);
        for (is_in, is_shut) in self.is_in.iter_mut().zip(is_shut) {
            *is_in |= !is_shut;
        }
    }

    /// With all cells within `radius` of those that are set.
    fn grown(&self, is_set: &[bool], radius: usize) -> Vec<bool> {
        let [columns, rows] = self.shape;
        let mut grown = is_set.to_vec();
        let squared = radius * radius;
        for at in (0..is_set.len()).filter(|at| is_set[*at]) {
            let (i, j) = (at % columns, at / columns);
            for y in j.saturating_sub(radius)..(j + radius + 1).min(rows) {
                for x in i.saturating_sub(radius)..(i + radius + 1).min(columns) {
                    if x.abs_diff(i).pow(2) + y.abs_diff(j).pow(2) <= squared {
                        grown[y * columns + x] = true;
                    }
                }
            }
        }
        grown
    }

    /// The cells that are not set and hang together with the border.
    fn reached_from_border(&self, is_set: &[bool]) -> Vec<bool> {
        let [columns, rows] = self.shape;
        let mut is_reached = vec![false; is_set.len()];
        let is_border = |at: &usize| {
            let (i, j) = (at % columns, at / columns);
            i == 0 || j == 0 || i + 1 == columns || j + 1 == rows
        };
        let mut todo: Vec<usize> = (0..is_set.len()).filter(is_border).collect();
        while let Some(at) = todo.pop() {
            if is_set[at] || is_reached[at] {
                continue;
            }
            is_reached[at] = true;
            let (i, j) = (at % columns, at / columns);
            todo.extend((i > 0).then(|| at - 1));
            todo.extend((i + 1 < columns).then(|| at + 1));
            todo.extend((j > 0).then(|| at - columns));
            todo.extend((j + 1 < rows).then(|| at + columns));
        }
        is_reached
    }

    /// Whether a place (mm) lies in the area, about as deep as the triangles.
    fn has(&self, place: Vector) -> bool {
        let in_frame = self.frame.of(place);
        let depth = in_frame[2];
        if depth < self.space.low[2] - UNEVEN_MM || depth > self.space.high[2] + UNEVEN_MM {
            return false;
        }
        let [i, j, _] = self.cell(in_frame).map(f64::round);
        let [columns, rows] = self.shape;
        let is_on = i >= 0.0 && j >= 0.0 && (i as usize) < columns && (j as usize) < rows;
        is_on && self.is_in[j as usize * columns + i as usize]
    }
}

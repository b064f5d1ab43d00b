//! Whether a mesh can be printed, judged on the file that it would be.

use std::num::NonZeroUsize;

use bonemesh_mesh::{
    Intersection, Intersections, Nesting, Topology, TriangleMesh, TriangleTree, WallThickness,
    check_nesting, check_topology, find_intersections,
};
use bonemesh_task::{Task, pool};
use serde::Serialize;

use crate::Error;
use crate::report::CheckReport;

/// Self-intersections that a report names one by one.
const MOST_NAMED: usize = 20;

/// Part of the surface that may have a thinner wall than [`PrintCheck::wall_5_percent_mm`] says.
const THIN_PART: f64 = 0.05;

/// What can be said of a mesh as a body to be printed.
///
/// It is judged as its file would be read: coordinates in 32-bit floats, vertices of equal
/// coordinates made one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PrintCheck {
    /// Connections, volume and area.
    #[serde(flatten)]
    pub topology: CheckReport,
    /// Edges of two triangles that disagree on which side is out.
    pub inconsistent_edges: usize,
    /// The volume inside is positive: triangles face outward.
    pub outward: bool,
    /// Pairs of triangles that pass through, overlap or touch one another beyond a common corner or edge.
    pub self_intersections: usize,
    /// Triangles that are in such a pair.
    pub intersecting_triangles: usize,
    /// The first of these pairs.
    pub intersections: Vec<Place>,
    /// Thickness of the thinnest wall; `None` if the mesh bounds no volume.
    pub thinnest_wall_mm: Option<f64>,
    /// Where the wall is thinnest.
    pub thinnest_wall_place_mm: Option<[f64; 3]>,
    /// Under a twentieth of the surface the wall is thinner than this; `None` if the mesh bounds no
    /// volume.
    pub wall_5_percent_mm: Option<f64>,
    /// The verdict: closed, 2-manifold, outward, free of self-intersections and of triangles without
    /// area. How thin a wall may be depends on the printer and is left to the reader.
    pub printable: bool,
    /// Why not, each with its remedy; empty if printable.
    pub reasons: Vec<String>,
}

/// Where two triangles meet that should not.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Place {
    /// Their numbers in the file, from 0, the lower first.
    pub triangles: [u32; 2],
    /// A place that both share.
    pub place_mm: [f64; 3],
}

impl From<Intersection> for Place {
    fn from(intersection: Intersection) -> Self {
        let Intersection {
            triangles,
            place_mm,
        } = intersection;
        Self {
            triangles,
            place_mm,
        }
    }
}

/// What [`check_walls`] gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Checked {
    /// The verdict.
    pub report: PrintCheck,
    /// The mesh as its file would be read.
    pub mesh: TriangleMesh,
    /// Thickness (mm) of the wall at each of its vertices, infinite where nothing lies opposite;
    /// empty if the mesh bounds no volume.
    pub walls_mm: Vec<f64>,
}

/// Judges `mesh` as a body to be printed. `threads`: `None` is one per core; the result does not
/// depend on it.
///
/// Walls are measured only in a mesh that is closed and outward, since others have no inside.
///
/// # Errors
/// [`Error::Mesh`] for coordinates that no file can hold, or [`Error::is_cancelled`].
pub fn check(
    mesh: &TriangleMesh,
    threads: Option<NonZeroUsize>,
    task: &Task,
) -> Result<PrintCheck, Error> {
    Ok(check_walls(mesh, threads, task)?.report)
}

/// The same with the thickness of the wall everywhere.
///
/// # Errors
/// Those of [`check`].
pub fn check_walls(
    mesh: &TriangleMesh,
    threads: Option<NonZeroUsize>,
    task: &Task,
) -> Result<Checked, Error> {
    pool(threads)?.install(|| {
        let mesh = mesh.as_written(task)?;
        let topology = check_topology(&mesh, task)?;
        let tree = TriangleTree::new(&mesh, task)?;
        let found = find_intersections(&tree, MOST_NAMED, task)?;
        let walls = if topology.watertight && topology.volume_mm3 > 0.0 {
            bonemesh_mesh::wall_thickness(&tree, task)?
        } else {
            WallThickness::default()
        };
        // Where triangles pass through one another, nothing lies in anything.
        let nesting = if topology.watertight && found.count == 0 {
            check_nesting(&mesh, task)?
        } else {
            Nesting::default()
        };
        let reasons = reasons(&topology, &found, nesting);
        let report = PrintCheck {
            inconsistent_edges: topology.inconsistent_edges,
            outward: topology.volume_mm3 > 0.0,
            self_intersections: found.count,
            intersecting_triangles: found.triangles,
            intersections: found.pairs.into_iter().map(Place::from).collect(),
            thinnest_wall_mm: walls.thinnest.map(|thinnest| thinnest.thickness_mm),
            thinnest_wall_place_mm: walls.thinnest.map(|thinnest| thinnest.place_mm),
            wall_5_percent_mm: low_part(&mesh, &walls.at_triangle_mm),
            printable: reasons.is_empty(),
            reasons,
            topology: CheckReport {
                cavities: nesting.cavities,
                ..topology.into()
            },
        };
        Ok(Checked {
            report,
            walls_mm: walls.at_vertex_mm,
            mesh,
        })
    })
}

/// The thickness (mm) of the wall at each vertex, infinite where nothing lies opposite.
///
/// Vertices at one place get one thickness. The mesh should be closed and outward.
///
/// # Errors
/// [`Error::Pool`], or [`Error::is_cancelled`].
pub fn wall_thickness(mesh: &TriangleMesh, task: &Task) -> Result<Vec<f64>, Error> {
    pool(None)?.install(|| {
        let (merged, numbers) = mesh.merged_with_numbers(task)?;
        let tree = TriangleTree::new(&merged, task)?;
        let walls = bonemesh_mesh::wall_thickness(&tree, task)?.at_vertex_mm;
        Ok(numbers.iter().map(|n| walls[*n as usize]).collect())
    })
}

/// The thickness that triangles with [`THIN_PART`] of the area of all have less than, of those with
/// something opposite.
fn low_part(mesh: &TriangleMesh, at_triangle_mm: &[f64]) -> Option<f64> {
    let triangles = mesh.triangles().iter().zip(at_triangle_mm);
    let finite = triangles.filter(|(_, thickness)| thickness.is_finite());
    let mut by_thickness: Vec<(f64, f64)> = finite
        .map(|(triangle, thickness)| (*thickness, area_mm2(mesh.corners_mm(*triangle))))
        .collect();
    by_thickness.sort_by(|a, b| a.0.total_cmp(&b.0));
    let most = THIN_PART * by_thickness.iter().map(|(_, area)| area).sum::<f64>();
    let mut area = 0.0;
    let reaches = |(_, of_triangle): &&(f64, f64)| {
        area += of_triangle;
        area >= most
    };
    let found = by_thickness.iter().find(reaches);
    found.map(|(thickness, _)| *thickness)
}

fn area_mm2([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let side = |to: [f64; 3]| [0, 1, 2].map(|axis| to[axis] - a[axis]);
    let ([ux, uy, uz], [vx, vy, vz]) = (side(b), side(c));
    let normal = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    0.5 * normal.iter().map(|n| n * n).sum::<f64>().sqrt()
}

/// What a printer's software would stumble over, each with its remedy.
fn reasons(topology: &Topology, found: &Intersections, nesting: Nesting) -> Vec<String> {
    let mut reasons = Vec::new();
    let mut add = |count: usize, one: &str, many: &str, remedy: &str| match count {
        0 => {}
        1 => reasons.push(format!("1 {one}; {remedy}")),
        _ => reasons.push(format!("{count} {many}; {remedy}")),
    };
    add(
        usize::from(topology.triangles == 0),
        "mesh without triangles",
        "",
        "check the step that made it",
    );
    add(
        topology.boundary_edges,
        "open edge: the surface has a hole",
        "open edges: the surface has holes",
        "fill them (bonemesh repair --fill-holes all; in Blender: Mesh > Clean Up > Fill Holes)",
    );
    add(
        topology.non_manifold_edges,
        "edge with more than two triangles: parts touch along it",
        "edges with more than two triangles: parts touch along them",
        "take out triangles that are there twice (bonemesh repair), or join or part the surface there (in Blender: the Remesh modifier)",
    );
    add(
        topology.non_manifold_vertices,
        "vertex where parts touch in a point",
        "vertices where parts touch in a point",
        "join or part the surface there (in Blender: the Remesh modifier)",
    );
    add(
        topology.inconsistent_edges,
        "edge whose two triangles face opposite ways",
        "edges whose two triangles face opposite ways",
        "turn the triangles (bonemesh repair; in Blender: Mesh > Normals > Recalculate Outside)",
    );
    add(
        usize::from(topology.watertight && topology.volume_mm3 <= 0.0),
        "surface that is inside out",
        "",
        "turn the triangles (bonemesh repair; in Blender: Mesh > Normals > Recalculate Outside)",
    );
    if topology.volume_mm3 > 0.0 {
        add(
            nesting.inside_out,
            "part that is inside out",
            "parts that are inside out",
            "turn their triangles (bonemesh repair; in Blender: Mesh > Normals > Recalculate Outside)",
        );
    }
    add(
        nesting.doubled,
        "part that lies inside of another",
        "parts that lie inside of others",
        "take them away, or turn them if they are cavities (in Blender: select one with L, Mesh > Normals > Flip)",
    );
    add(
        found.count,
        "pair of triangles that pass through, overlap or touch one another",
        "pairs of triangles that pass through, overlap or touch one another",
        "unite the parts (in Blender: the Remesh modifier)",
    );
    add(
        topology.degenerate_triangles,
        "triangle without area",
        "triangles without area",
        "take them out (bonemesh repair; in Blender: Mesh > Clean Up > Degenerate Dissolve)",
    );
    reasons
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron with its corner at `(x, 0, 0)`.
    fn tetrahedron(x: f64) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let corners = [[0.0; 3], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]];
        let moved = corners.map(|[a, b, c]| [a + x, b, c]);
        (
            moved.to_vec(),
            vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        )
    }

    fn checked(vertices: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> PrintCheck {
        let mesh = TriangleMesh::new(vertices, triangles).unwrap();
        check(&mesh, None, &Task::default()).unwrap()
    }

    fn only_reason(check: &PrintCheck) -> &str {
        assert!(!check.printable);
        assert_eq!(check.reasons.len(), 1, "{:?}", check.reasons);
        &check.reasons[0]
    }

    #[test]
    fn a_tetrahedron_is_printable() {
        let (vertices, triangles) = tetrahedron(0.0);
        let check = checked(vertices, triangles);
        assert!(check.printable && check.outward && check.reasons.is_empty());
        assert_eq!(check.self_intersections, 0);
        assert!(check.thinnest_wall_mm.is_some_and(|t| t > 0.0 && t < 3.0));
    }

    #[test]
    fn each_fault_is_the_one_reason() {
        let (vertices, triangles) = tetrahedron(0.0);
        let open = checked(vertices.clone(), triangles[1..].to_vec());
        assert!(only_reason(&open).starts_with("3 open edges"));
        assert_eq!(open.thinnest_wall_mm, None);
        let inside_out = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
        assert!(only_reason(&checked(vertices.clone(), inside_out)).contains("inside out"));
        let mut turned = triangles.clone();
        turned[0].reverse();
        assert!(only_reason(&checked(vertices.clone(), turned)).starts_with("3 edges whose"));
        let collapsed = [&triangles[..], &[[0, 0, 1]]].concat();
        assert!(only_reason(&checked(vertices, collapsed)).starts_with("1 triangle without"));
        assert!(only_reason(&checked(vec![], vec![])).contains("without triangles"));
    }

    #[test]
    fn bodies_that_pass_through_one_another_are_named_with_the_place() {
        let (mut vertices, mut triangles) = tetrahedron(0.0);
        let (more, other) = tetrahedron(0.75);
        vertices.extend(more.iter().map(|v| [v[0], v[1] + 0.5, v[2] + 0.5]));
        triangles.extend(other.iter().map(|t| t.map(|v| v + 4)));
        let check = checked(vertices, triangles);
        assert!(only_reason(&check).contains("pass through"));
        assert_eq!(check.intersections.len(), check.self_intersections);
        assert!(check.intersections.iter().all(|place| {
            place.triangles[0] < 4 && place.triangles[1] >= 4 && place.place_mm[0] >= 0.75
        }));
    }

    #[test]
    fn parts_that_lie_wrong_in_one_another_are_named() {
        let (outer, sides) = tetrahedron(0.0);
        let scaled = |size: f64, x: f64| {
            outer
                .iter()
                .map(move |v| v.map(|c| 0.2 + size * c))
                .map(move |[a, b, c]| [a + x, b, c])
        };
        let inward: Vec<[u32; 3]> = sides.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
        let with = |size: f64, x: f64, triangles: &[[u32; 3]]| {
            let vertices = outer.iter().copied().chain(scaled(size, x)).collect();
            let more = triangles.iter().map(|t| t.map(|v| v + 4));
            checked(vertices, sides.iter().copied().chain(more).collect())
        };
        let hollow = with(0.3, 0.0, &inward);
        assert!(hollow.printable && hollow.topology.cavities == 1);
        assert!(only_reason(&with(0.3, 0.0, &sides)).contains("lies inside of another"));
        let beside = with(0.3, 9.0, &inward);
        assert!(only_reason(&beside).contains("inside out"));
        assert_eq!(beside.topology.cavities, 0);
    }

    #[test]
    fn a_twentieth_is_one_of_the_surface_not_of_the_vertices() {
        // A plate of two triangles a side is mostly thin, whatever its many narrow sides are.
        let corners = |z: f64| {
            [
                [0.0, 0.0, z],
                [40.0, 0.0, z],
                [40.0, 40.0, z],
                [0.0, 40.0, z],
            ]
        };
        let vertices = [corners(0.0), corners(1.0)].concat();
        let mut triangles = vec![[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]];
        for side in 0..4 {
            let next = (side + 1) % 4;
            triangles.extend([[side, next, next + 4], [side, next + 4, side + 4]]);
        }
        let plate = checked(vertices, triangles);
        assert!(plate.printable, "{:?}", plate.reasons);
        assert!((plate.thinnest_wall_mm.unwrap() - 1.0).abs() < 1e-9);
        assert!((plate.wall_5_percent_mm.unwrap() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn vertices_that_a_file_cannot_tell_apart_are_one() {
        let (vertices, triangles) = tetrahedron(0.0);
        let corners = triangles.as_flattened().iter().enumerate();
        let apart =
            corners.map(|(i, v)| vertices[*v as usize].map(|c| 200.0 + c + i as f64 * 1e-9));
        let soup = (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let check = checked(apart.collect(), soup);
        assert_eq!(check.topology.vertices, 4);
        assert!(check.topology.watertight);
    }

    #[test]
    fn walls_are_given_for_every_vertex_even_of_a_soup() {
        let (vertices, triangles) = tetrahedron(0.0);
        let corners = triangles.as_flattened().iter();
        let soup = TriangleMesh::new(
            corners.clone().map(|v| vertices[*v as usize]).collect(),
            (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        );
        let merged = TriangleMesh::new(vertices.clone(), triangles.clone()).unwrap();
        let of_soup = wall_thickness(&soup.unwrap(), &Task::default()).unwrap();
        let of_merged = wall_thickness(&merged, &Task::default()).unwrap();
        let expected: Vec<f64> = corners.map(|v| of_merged[*v as usize]).collect();
        assert_eq!(of_soup, expected);
    }
}

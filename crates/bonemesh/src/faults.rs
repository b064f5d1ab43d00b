//! Where a mesh is not fit for printing, by the numbers of its own vertices and triangles.

use bonemesh_mesh::{
    TriangleMesh, TriangleTree, find_faults as find_in_merged, find_intersections,
};
use bonemesh_task::{Task, pool};

use crate::Error;

/// The places of what [`crate::check`] counts; all in ascending order.
///
/// Vertices at one place are one, as in a file: where a mesh has several there, all of them are named.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Faults {
    /// Edges of one triangle: the rims of holes; the lower vertex first.
    pub open_edges: Vec<[u32; 2]>,
    /// Edges of more than two triangles.
    pub non_manifold_edges: Vec<[u32; 2]>,
    /// Edges whose two triangles face opposite ways.
    pub inconsistent_edges: Vec<[u32; 2]>,
    /// Vertices in which parts only touch.
    pub non_manifold_vertices: Vec<u32>,
    /// Triangles without area.
    pub degenerate_triangles: Vec<u32>,
    /// Triangles that pass through, overlap or touch others.
    pub intersecting_triangles: Vec<u32>,
    /// Vertices where the wall is thinner than asked for; none unless it was asked.
    pub thin_vertices: Vec<u32>,
}

/// Finds the faults of `mesh`, and where its walls are thinner than a length.
///
/// # Errors
/// [`Error::Mesh`] for a cancelled task, [`Error::Pool`].
pub fn find_faults(
    mesh: &TriangleMesh,
    thinner_than_mm: Option<f64>,
    task: &Task,
) -> Result<Faults, Error> {
    pool(None)?.install(|| {
        let (merged, numbers) = mesh.merged_with_numbers(task)?;
        let found = find_in_merged(&merged, task)?;
        let tree = TriangleTree::new(&merged, task)?;
        let thin_vertices = match thinner_than_mm {
            Some(least_mm) => {
                let walls_mm = bonemesh_mesh::wall_thickness(&tree, task)?.at_vertex_mm;
                vertices(&numbers, |vertex| walls_mm[vertex as usize] < least_mm)
            }
            None => Vec::new(),
        };
        let is_among = |sorted: &[u32], vertex: u32| sorted.binary_search(&vertex).is_ok();
        Ok(Faults {
            open_edges: edges(mesh, &numbers, &found.boundary_edges),
            non_manifold_edges: edges(mesh, &numbers, &found.non_manifold_edges),
            inconsistent_edges: edges(mesh, &numbers, &found.inconsistent_edges),
            non_manifold_vertices: vertices(&numbers, |vertex| {
                is_among(&found.non_manifold_vertices, vertex)
            }),
            degenerate_triangles: found.degenerate_triangles,
            intersecting_triangles: find_intersections(&tree, 0, task)?.in_pairs,
            thin_vertices,
        })
    })
}

/// The vertices whose merged ones are meant.
fn vertices(numbers: &[u32], is_meant: impl Fn(u32) -> bool) -> Vec<u32> {
    (0..)
        .zip(numbers)
        .filter(|(_, merged)| is_meant(**merged))
        .map(|(vertex, _)| vertex)
        .collect()
}

/// The edges of triangles whose merged ones are among `meant`.
fn edges(mesh: &TriangleMesh, numbers: &[u32], meant: &[[u32; 2]]) -> Vec<[u32; 2]> {
    if meant.is_empty() {
        return Vec::new();
    }
    let ordered = |a: u32, b: u32| [a.min(b), a.max(b)];
    let mut found: Vec<[u32; 2]> = mesh
        .triangles()
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .filter(|&[a, b]| {
            let merged = ordered(numbers[a as usize], numbers[b as usize]);
            meant.binary_search(&merged).is_ok()
        })
        .map(|[a, b]| ordered(a, b))
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 3]; 4] = [[0.0; 3], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]];
    const SIDES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn faults(vertices: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Faults {
        let mesh = TriangleMesh::new(vertices, triangles).unwrap();
        find_faults(&mesh, None, &Task::default()).unwrap()
    }

    #[test]
    fn a_tetrahedron_has_no_faults_but_thin_corners_where_asked() {
        let mesh = TriangleMesh::new(CORNERS.to_vec(), SIDES.to_vec()).unwrap();
        let none = find_faults(&mesh, None, &Task::default()).unwrap();
        assert_eq!(none, Faults::default());
        let thin = find_faults(&mesh, Some(100.0), &Task::default()).unwrap();
        assert!(!thin.thin_vertices.is_empty());
    }

    #[test]
    fn the_rim_of_a_hole_is_named_whatever_vertices_share_its_places() {
        let open = faults(CORNERS.to_vec(), SIDES[1..].to_vec());
        assert_eq!(open.open_edges, [[0, 1], [0, 2], [1, 2]]);
        // The same three triangles, none sharing a vertex with another.
        let apart: Vec<[f64; 3]> = SIDES[1..]
            .iter()
            .flatten()
            .map(|v| CORNERS[*v as usize])
            .collect();
        let soup = faults(apart, vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
        assert_eq!(soup.open_edges, [[0, 1], [3, 5], [6, 7]]);
    }

    #[test]
    fn each_fault_is_named_by_its_own_vertices_and_triangles() {
        let mut turned = SIDES;
        turned[3].reverse();
        let turned = faults(CORNERS.to_vec(), turned.to_vec());
        assert_eq!(turned.inconsistent_edges, [[1, 2], [1, 3], [2, 3]]);
        let collapsed = [&SIDES[..], &[[0, 0, 1]]].concat();
        assert_eq!(
            faults(CORNERS.to_vec(), collapsed).degenerate_triangles,
            [4]
        );
        // Two tetrahedra on one edge, and two in one corner.
        let more = |vertices: &[[f64; 3]], sides: [[u32; 3]; 4]| {
            faults([&CORNERS[..], vertices].concat(), [SIDES, sides].concat())
        };
        let [d, e] = [[-3.0, -1.0, 1.0], [-1.0, -3.0, 1.0]];
        let on_edge = more(&[d, e], [[0, 3, 4], [3, 0, 5], [0, 4, 5], [4, 3, 5]]);
        assert_eq!(on_edge.non_manifold_edges, [[0, 3]]);
        let opposite = [[-3.0, 0.0, 0.0], [0.0, -3.0, 0.0], [0.0, 0.0, -3.0]];
        let in_corner = more(&opposite, [[0, 4, 5], [0, 6, 4], [0, 5, 6], [4, 6, 5]]);
        assert_eq!(in_corner.non_manifold_vertices, [0]);
        // One passing through the other.
        let through = CORNERS.map(|[x, y, z]| [x + 0.75, y + 0.5, z + 0.5]);
        let through = more(&through, SIDES.map(|side| side.map(|v| v + 4)));
        assert_eq!(through.intersecting_triangles.len(), {
            let meeting = &through.intersecting_triangles;
            meeting.iter().filter(|t| **t < 8).count()
        });
        assert!(through.intersecting_triangles.contains(&3));
    }
}

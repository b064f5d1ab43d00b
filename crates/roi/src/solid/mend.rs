//! Slivers along the cut, which in a file's 32-bit coordinates meet their neighbours.
//!
//! Where a cut passes next to a vertex it leaves triangles that are much thinner than the step between two
//! coordinates is long. Their shortest edges are collapsed: into the end that is a vertex of the bone, if one
//! is, so that the front stays as it was.

use bonemesh_mesh::{Intersection, TriangleMesh};
use rustc_hash::FxHashSet;

use bonemesh_mesh::vector::{Vector, length, minus};

/// The longest edge (mm) that is collapsed: less than a scan can tell.
const LONGEST_MM: f64 = 0.02;

/// The mesh without the shortest edges of triangles that meet others; `None` where none of them is short.
///
/// `own`: the places of the bone's vertices.
pub(super) fn mended(
    mesh: &TriangleMesh,
    met: &[Intersection],
    own: &Places,
) -> Option<TriangleMesh> {
    let mut triangles = mesh.triangles().to_vec();
    let mut touched: FxHashSet<u32> = FxHashSet::default();
    for triangle in met.iter().flat_map(|pair| pair.triangles) {
        let corners = mesh.triangles()[triangle as usize];
        let [a, b] = shortest_edge(mesh, corners);
        let places = [a, b].map(|v| mesh.vertices_mm()[v as usize]);
        let is_short = length(minus(places[1], places[0])) < LONGEST_MM;
        if !is_short || touched.contains(&a) || touched.contains(&b) {
            continue;
        }
        let [kept, gone] = match places.map(|place| own.has(place)) {
            [true, true] => continue,
            [false, true] => [b, a],
            _ => [a, b],
        };
        if let Some(around) = collapsed(&mut triangles, kept, gone) {
            touched.extend(around);
        }
    }
    if touched.is_empty() {
        return None;
    }
    let mesh = TriangleMesh::new(mesh.vertices_mm().to_vec(), triangles).ok()?;
    Some(mesh.compacted())
}

/// Places in the 32-bit coordinates of files.
pub(super) struct Places(FxHashSet<[u32; 3]>);

impl Places {
    pub(super) fn of(places_mm: &[Vector]) -> Self {
        Self(places_mm.iter().copied().map(Self::key).collect())
    }

    fn has(&self, place: Vector) -> bool {
        self.0.contains(&Self::key(place))
    }

    fn key(place: Vector) -> [u32; 3] {
        // Adding 0 makes one zero of the two.
        place.map(|v| (v as f32 + 0.0).to_bits())
    }
}

fn shortest_edge(mesh: &TriangleMesh, [a, b, c]: [u32; 3]) -> [u32; 2] {
    let place = |v: u32| mesh.vertices_mm()[v as usize];
    let size = |[from, to]: &[u32; 2]| length(minus(place(*to), place(*from)));
    let edges = [[b, c], [c, a]];
    edges.into_iter().fold([a, b], |shortest, edge| {
        if size(&edge) < size(&shortest) {
            edge
        } else {
            shortest
        }
    })
}

/// Makes two neighbours of a closed 2-manifold one, where it stays one; gives the vertices around them.
fn collapsed(triangles: &mut Vec<[u32; 3]>, kept: u32, gone: u32) -> Option<FxHashSet<u32>> {
    let around = |vertex: u32| -> FxHashSet<u32> {
        let own = triangles.iter().filter(|t| t.contains(&vertex));
        own.flatten().copied().filter(|v| *v != vertex).collect()
    };
    let (of_kept, of_gone) = (around(kept), around(gone));
    // Exactly the two opposite corners are neighbours of both (the link condition).
    if of_kept.intersection(&of_gone).count() != 2 {
        return None;
    }
    triangles.retain(|t| !(t.contains(&kept) && t.contains(&gone)));
    for triangle in triangles.iter_mut() {
        *triangle = triangle.map(|v| if v == gone { kept } else { v });
    }
    Some(of_kept.union(&of_gone).copied().collect())
}

//! Which triangle belongs to which part, and what each part is like.

use bonemesh_task::{Cancelled, Task};

use crate::TriangleMesh;
use crate::topology::Sets;
use crate::vector::{Vector, cross, dot, minus};

/// Triangles done between two looks at the cancel switch.
const STRIDE: usize = 1 << 16;

/// The part of each triangle, parts numbered as they first come up.
pub(super) struct Labels {
    pub(super) of_triangles: Vec<u32>,
    pub(super) count: usize,
}

/// What is known of a part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Enclosed, below 0 if the part faces inward.
    pub(super) volume_mm3: f64,
    pub(super) triangles: usize,
    pub(super) is_closed: bool,
    /// Its vertex with the highest x; a ray from there along x leaves the part at once.
    pub(super) tip: Vector,
    /// The innermost closed part that it lies in.
    pub(super) parent: Option<u32>,
    pub(super) is_cavity: bool,
}

impl Labels {
    pub(super) fn of(mesh: &TriangleMesh, task: &Task) -> Result<Self, Cancelled> {
        let mut sets = Sets::default();
        sets.reset(mesh.vertices_mm().len());
        for triangles in mesh.triangles().chunks(STRIDE) {
            for &[a, b, c] in triangles {
                sets.join(a, b);
                sets.join(b, c);
            }
            task.advance(triangles.len())?;
        }
        let mut numbers = vec![u32::MAX; mesh.vertices_mm().len()];
        let mut count = 0;
        let label = |triangle: &[u32; 3]| {
            let number = &mut numbers[sets.lowest(triangle[0]) as usize];
            if *number == u32::MAX {
                *number = count;
                count += 1;
            }
            *number
        };
        Ok(Self {
            of_triangles: mesh.triangles().iter().map(label).collect(),
            count: count as usize,
        })
    }

    /// Volume, size and tip of each part; parents are not known yet.
    pub(super) fn parts(&self, mesh: &TriangleMesh, task: &Task) -> Result<Vec<Part>, Cancelled> {
        let mut bounds = vec![([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]); self.count];
        let mut tips = vec![[f64::NEG_INFINITY; 3]; self.count];
        let labelled = || mesh.triangles().iter().zip(&self.of_triangles);
        for (triangle, &label) in labelled() {
            let (low, high) = &mut bounds[label as usize];
            for corner in mesh.corners_mm(*triangle) {
                *low = [0, 1, 2].map(|axis| low[axis].min(corner[axis]));
                *high = [0, 1, 2].map(|axis| high[axis].max(corner[axis]));
                let tip = &mut tips[label as usize];
                if corner[0] > tip[0] {
                    *tip = corner;
                }
            }
        }
        task.check()?;
        let mut volumes = vec![0.0; self.count];
        let mut sizes = vec![0; self.count];
        let mut rims = vec![0_u64; self.count];
        for (triangle, &label) in labelled() {
            let label = label as usize;
            let (low, high) = bounds[label];
            let middle = [0, 1, 2].map(|axis| f64::midpoint(low[axis], high[axis]));
            let [a, b, c] = mesh
                .corners_mm(*triangle)
                .map(|corner| minus(corner, middle));
            volumes[label] += dot(a, cross(b, c)) / 6.0;
            sizes[label] += 1;
            rims[label] = rims[label].wrapping_add(rim(*triangle));
        }
        task.check()?;
        let parts = (0..self.count).map(|label| Part {
            volume_mm3: volumes[label],
            triangles: sizes[label],
            is_closed: rims[label] == 0,
            tip: tips[label],
            parent: None,
            is_cavity: false,
        });
        Ok(parts.collect())
    }
}

/// The triangles of each part.
pub(super) struct ByPart {
    starts: Vec<usize>,
    triangles: Vec<u32>,
}

impl ByPart {
    pub(super) fn of(&self, part: usize) -> &[u32] {
        &self.triangles[self.starts[part]..self.starts[part + 1]]
    }
}

impl Labels {
    /// Triangles in their order, part by part.
    pub(super) fn triangles_of_parts(&self) -> ByPart {
        let mut starts = vec![0; self.count + 1];
        for &label in &self.of_triangles {
            starts[label as usize + 1] += 1;
        }
        for part in 0..self.count {
            starts[part + 1] += starts[part];
        }
        let mut next = starts.clone();
        let mut triangles = vec![0; self.of_triangles.len()];
        for (number, &label) in (0..).zip(&self.of_triangles) {
            triangles[next[label as usize]] = number;
            next[label as usize] += 1;
        }
        ByPart { starts, triangles }
    }
}

/// A number for a triangle's three edges that cancels where another triangle runs along an edge the
/// other way: over a part without rims all add up to 0, and over one with rims, but for a chance of
/// one in 2^64, to something else.
fn rim([a, b, c]: [u32; 3]) -> u64 {
    let edges = [[a, b], [b, c], [c, a]].map(|[from, to]| {
        let scattered = scatter(u64::from(from.min(to)) << 32 | u64::from(from.max(to)));
        match from.cmp(&to) {
            std::cmp::Ordering::Less => scattered,
            std::cmp::Ordering::Equal => 0,
            std::cmp::Ordering::Greater => scattered.wrapping_neg(),
        }
    });
    edges.into_iter().fold(0, u64::wrapping_add)
}

/// A number that has nothing to do with its neighbours (Steele, Lea and Flood, *Fast splittable
/// pseudorandom number generators*, 2014).
fn scatter(number: u64) -> u64 {
    let mixed = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ mixed >> 31
}

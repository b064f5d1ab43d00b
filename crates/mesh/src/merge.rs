//! Numbers for vertices by their exact coordinates.

use rustc_hash::FxHashMap;

/// Gives equal coordinates one number, in the order in which they are first met.
#[derive(Default)]
pub(crate) struct VertexMerger {
    numbers: FxHashMap<[u64; 3], u32>,
    vertices_mm: Vec<[f64; 3]>,
}

impl VertexMerger {
    /// The number of the vertex at `vertex_mm`, a new one if nothing was there.
    pub(crate) fn index_of(&mut self, vertex_mm: [f64; 3]) -> u32 {
        // Adding 0.0 turns -0.0 into 0.0, which it equals but whose bits differ.
        let key = vertex_mm.map(|value| (value + 0.0).to_bits());
        *self.numbers.entry(key).or_insert_with(|| {
            self.vertices_mm.push(vertex_mm);
            (self.vertices_mm.len() - 1) as u32
        })
    }

    /// The distinct vertices in the order of their numbers.
    pub(crate) fn into_vertices(self) -> Vec<[f64; 3]> {
        self.vertices_mm
    }
}

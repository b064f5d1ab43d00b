//! The triangulation as it grows: cells, their neighbours, and the ghost outside the hull.
//!
//! Invariants between two insertions:
//! - the finite cells are the Delaunay tetrahedra of the points so far under the perturbed lift,
//!   each positively oriented;
//! - every hull facet has one more cell, made of it and the [`GHOST`], so that every facet of
//!   every cell has a neighbour; replacing its ghost by a point strictly outside the facet gives
//!   a positive orientation;
//! - neighbours name each other: facet `f` of cell `c` (the one opposite vertex `f`) is written
//!   `4 c + f`, and `neighbours[f]` is the same facet seen from the other side.

use bonemesh_task::Task;

use crate::DelaunayError;
use crate::hilbert::insertion_order;
use crate::insert::Cavity;
use crate::points::Sites;
use crate::predicates::{Kernel, Site};
use crate::sphere::{Precision, Sphere};

/// The vertex at infinity.
pub(crate) const GHOST: u32 = 0;
/// Marks a cell that is not in use, in place of its first vertex.
pub(crate) const UNUSED: u32 = u32::MAX;
/// The most cells that facets can name.
pub(crate) const CELL_LIMIT: usize = 1 << 30;
/// New cells between two looks at the cancel switch: a millisecond, or some ten where every
/// question needs exact arithmetic.
const CELLS_PER_CHECK: usize = 1 << 12;

/// Room made for cells: somewhat more than random points need.
const CELLS_PER_POINT: usize = 7;

/// A tetrahedron: its vertices, facet `f` seen from the other side for each `f`, its sphere.
///
/// All that an insertion asks of a cell it passes is in one line of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Cell {
    pub(crate) vertices: [u32; 4],
    pub(crate) neighbours: [u32; 4],
    pub(crate) sphere: Sphere,
}

impl Cell {
    /// Whether the ghost is among the vertices.
    #[inline]
    pub(crate) fn is_infinite(&self) -> bool {
        let [a, b, c, d] = self.vertices;
        // The ghost is 0, and a minimum has no branch: this is asked of every cell looked at.
        a.min(b).min(c.min(d)) == GHOST
    }

    #[inline]
    pub(crate) fn is_in_use(&self) -> bool {
        self.vertices[0] != UNUSED
    }

    /// Whether the cell is in use and has no ghost.
    #[inline]
    pub(crate) fn is_finite(&self) -> bool {
        self.is_in_use() && !self.is_infinite()
    }

    /// The place of the ghost among the vertices, if the cell is infinite.
    #[inline]
    pub(crate) fn ghost(&self) -> Option<usize> {
        if self.is_infinite() {
            self.vertices.iter().position(|&v| v == GHOST)
        } else {
            None
        }
    }
}

/// A point of the triangulation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex<S> {
    pub(crate) site: Site<S>,
    /// The insertion in which it was last on the rim, and its number there. Beside the place,
    /// since both are asked for together.
    pub(crate) on_rim: (u32, u32),
}

/// A growing Delaunay triangulation of points, numbered in the order of insertion from 1.
pub(crate) struct Triangulation<'k, K: Kernel> {
    pub(crate) kernel: &'k K,
    /// The points; the first is a stand-in for the ghost and never looked at.
    pub(crate) vertices: Vec<Vertex<K::Scalar>>,
    pub(crate) cells: Vec<Cell>,
    pub(crate) precision: Precision,
    /// Cells not in use.
    pub(crate) unused: Vec<u32>,
    /// Where the next walk starts.
    pub(crate) recent: u32,
}

/// Four points that span a tetrahedron, as positions in a list, or how far the points get.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Span {
    /// All points equal, or none.
    Point,
    /// All points on a line.
    Line,
    /// All points in a plane.
    Plane,
    /// Positions of four points not in one plane, ascending.
    Space([usize; 4]),
}

/// The first points, in order, that are not equal, not on a line, not in a plane.
pub(crate) fn span<'a, K: Kernel>(
    kernel: &K,
    mut points: impl Iterator<Item = &'a [K::Scalar; 3]>,
) -> Span
where
    K::Scalar: 'a,
{
    let Some(a) = points.next() else {
        return Span::Point;
    };
    let mut rest = points.zip(1..);
    let Some((b, second)) = rest.find(|(p, _)| *p != a) else {
        return Span::Point;
    };
    let Some((c, third)) = rest.find(|(p, _)| !kernel.collinear([a, b, p])) else {
        return Span::Line;
    };
    match rest.find(|(p, _)| kernel.orientation([a, b, c, p]) != 0.0) {
        Some((_, fourth)) => Span::Space([0, second, third, fourth]),
        None => Span::Plane,
    }
}

impl<'k, K: Kernel> Triangulation<'k, K> {
    /// The Delaunay triangulation of `points`, some of `of`, or `None` where they span no space.
    ///
    /// `room` is any list whose memory may be used for the cells.
    pub(crate) fn build(
        of: &'k Sites<K>,
        points: &[Site<K::Scalar>],
        mut room: Vec<Cell>,
        task: &Task,
    ) -> Result<Option<Self>, DelaunayError> {
        let kernel = &of.kernel;
        let order = insertion_order(points.iter().map(|s| kernel.place_mm(&s.at)));
        task.check()?;
        // The ghost comes first; its site is never looked at.
        let ghost = Site {
            at: [K::Scalar::default(); 3],
            rank: u32::MAX,
        };
        let inserted = order.iter().map(|&i| points[i as usize]);
        let vertices = std::iter::once(ghost).chain(inserted).map(|site| Vertex {
            site,
            on_rim: (0, 0),
        });
        let mut vertices: Vec<Vertex<K::Scalar>> = vertices.collect();
        let Span::Space(first) = span(kernel, vertices[1..].iter().map(|v| &v.site.at)) else {
            return Ok(None);
        };
        // The four go to the front (swapping keeps the others on the curve, but for a few).
        for (to, from) in first.into_iter().enumerate() {
            vertices.swap(to + 1, from + 1);
        }
        room.clear();
        room.reserve(CELLS_PER_POINT * vertices.len());
        let mut triangulation = Self {
            kernel,
            cells: room,
            precision: of.precision,
            vertices,
            unused: Vec::new(),
            recent: 0,
        };
        triangulation.start();
        triangulation.insert_rest(task)?;
        Ok(Some(triangulation))
    }

    /// The memory of its cells, for the next triangulation.
    pub(crate) fn into_room(self) -> Vec<Cell> {
        self.cells
    }

    /// The tetrahedron of the first four points and the four infinite cells around it.
    fn start(&mut self) {
        let mut vertices = [1, 2, 3, 4];
        if self.kernel.orientation(self.corners(vertices)) < 0.0 {
            vertices.swap(2, 3);
        }
        self.cells.push(Cell {
            vertices,
            neighbours: [4, 9, 14, 19],
            sphere: Sphere::UNKNOWN,
        });
        for f in 0..4 {
            // The ghost is beyond facet `f`, opposite the vertex it replaces: swap two others.
            let (i, j) = ((f + 1) % 4, (f + 2) % 4);
            let mut outer = vertices;
            outer[f] = GHOST;
            outer.swap(i, j);
            self.cells.push(Cell {
                vertices: outer,
                neighbours: [f as u32; 4],
                sphere: Sphere::UNKNOWN,
            });
        }
        for c in 1..5 {
            for f in 0..4 {
                let v = self.cells[c].vertices[f];
                // The facet opposite `v` is shared with the infinite cell that lacks `v`.
                self.cells[c].neighbours[f] = if v == GHOST {
                    c as u32 - 1
                } else {
                    self.start_facet(c, v)
                };
            }
        }
    }

    /// Among the first five cells: the facet of the infinite cell without vertex `lacking` that
    /// it shares with infinite cell `c`.
    fn start_facet(&self, c: usize, lacking: u32) -> u32 {
        let replaced = |c: usize| self.cells[0].vertices[c - 1];
        let other = (1..5)
            .find(|&o| replaced(o) == lacking)
            .expect("each vertex is lacked by one infinite cell, anything else is a bug");
        let facet = self.cells[other]
            .vertices
            .iter()
            .position(|&v| v == replaced(c))
            .expect("an infinite cell has the vertices that others lack, anything else is a bug");
        (4 * other + facet) as u32
    }

    fn insert_rest(&mut self, task: &Task) -> Result<(), DelaunayError> {
        let mut cavity = Cavity::default();
        let (mut inserted, mut made) = (4, 0);
        for vertex in 5..self.vertices.len() as u32 {
            made += self.insert(vertex, &mut cavity);
            inserted += 1;
            if made >= CELLS_PER_CHECK {
                task.advance(inserted)?;
                (inserted, made) = (0, 0);
                if self.cells.len() > CELL_LIMIT - CELLS_PER_CHECK {
                    let points = self.vertices.len() - 1;
                    return Err(DelaunayError::TooMany {
                        points,
                        limit: CELL_LIMIT,
                    });
                }
            }
        }
        Ok(task.advance(inserted)?)
    }

    /// Coordinates of four finite vertices.
    #[inline]
    pub(crate) fn corners(&self, vertices: [u32; 4]) -> [&[K::Scalar; 3]; 4] {
        vertices.map(|v| &self.vertices[v as usize].site.at)
    }

    /// The sites of a finite cell.
    #[inline]
    pub(crate) fn cell_sites(&self, cell: &Cell) -> [Site<K::Scalar>; 4] {
        cell.vertices.map(|v| self.vertices[v as usize].site)
    }

    /// The finite cells.
    pub(crate) fn finite_cells(&self) -> impl Iterator<Item = &Cell> {
        self.cells.iter().filter(|c| c.is_finite())
    }
}

//! Nearest neighbours among points that are taken away one after the other.
//!
//! A k-d tree whose shape stays while its points go: every node counts the points it still
//! holds, and a node without any is passed over. Any input is fine, equal points included.

/// Points in a leaf.
const LEAF: usize = 8;

/// Marks the root, which has no parent.
const NO_NODE: u32 = u32::MAX;

struct Node {
    low: [f64; 3],
    high: [f64; 3],
    /// Range of `order`.
    start: u32,
    end: u32,
    parent: u32,
    /// The second child; the first one is the next node. `NO_NODE` in a leaf.
    second: u32,
    remaining: u32,
}

/// The points of one slice that were not taken yet.
pub(super) struct Remaining<'a> {
    points: &'a [[f64; 3]],
    /// Squared length of a unit step along each axis.
    metric: [f64; 3],
    nodes: Vec<Node>,
    /// Point numbers, leaf by leaf.
    order: Vec<u32>,
    leaf_of: Vec<u32>,
    is_gone: Vec<bool>,
    /// No point before this one remains.
    first: usize,
    nearest: Vec<(f64, u32)>,
}

impl<'a> Remaining<'a> {
    /// All of `points`; the squared length of a step is the metric's weighted sum of squares.
    pub(super) fn new(points: &'a [[f64; 3]], metric: [f64; 3]) -> Self {
        let mut remaining = Self {
            points,
            metric,
            nodes: Vec::with_capacity(4 * points.len() / LEAF + 1),
            order: (0..points.len() as u32).collect(),
            leaf_of: vec![0; points.len()],
            is_gone: vec![false; points.len()],
            first: 0,
            nearest: Vec::new(),
        };
        if !points.is_empty() {
            remaining.build(0, points.len(), NO_NODE);
        }
        remaining
    }

    /// The remaining point of the lowest number.
    pub(super) fn first(&mut self) -> Option<u32> {
        while *self.is_gone.get(self.first)? {
            self.first += 1;
        }
        Some(self.first as u32)
    }

    /// Takes a point away.
    pub(super) fn remove(&mut self, point: u32) {
        if std::mem::replace(&mut self.is_gone[point as usize], true) {
            return;
        }
        let mut node = self.leaf_of[point as usize];
        while node != NO_NODE {
            self.nodes[node as usize].remaining -= 1;
            node = self.nodes[node as usize].parent;
        }
    }

    /// Squared distance and number of the up to `count` remaining points nearest to `point`,
    /// ascending; equal distances by number.
    pub(super) fn nearest(&mut self, point: u32, count: usize) -> &[(f64, u32)] {
        let mut nearest = std::mem::take(&mut self.nearest);
        nearest.clear();
        if count > 0 && !self.nodes.is_empty() {
            self.visit(0, self.points[point as usize], count, &mut nearest);
        }
        self.nearest = nearest;
        &self.nearest
    }

    fn build(&mut self, start: usize, end: usize, parent: u32) -> u32 {
        let number = self.nodes.len() as u32;
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for index in &self.order[start..end] {
            for (axis, value) in self.points[*index as usize].into_iter().enumerate() {
                low[axis] = low[axis].min(value);
                high[axis] = high[axis].max(value);
            }
        }
        self.nodes.push(Node {
            low,
            high,
            start: start as u32,
            end: end as u32,
            parent,
            second: NO_NODE,
            remaining: (end - start) as u32,
        });
        if end - start <= LEAF {
            for index in &self.order[start..end] {
                self.leaf_of[*index as usize] = number;
            }
            return number;
        }
        let width = |axis: usize| (high[axis] - low[axis]).powi(2) * self.metric[axis];
        let axis = (1..3).fold(0, |a, b| if width(b) > width(a) { b } else { a });
        let middle = (end - start) / 2;
        let points = self.points;
        self.order[start..end].select_nth_unstable_by(middle, |a, b| {
            let key = |i: &u32| points[*i as usize][axis];
            key(a).total_cmp(&key(b)).then(a.cmp(b))
        });
        self.build(start, start + middle, number);
        self.nodes[number as usize].second = self.build(start + middle, end, number);
        number
    }

    fn visit(&self, node: u32, at: [f64; 3], count: usize, nearest: &mut Vec<(f64, u32)>) {
        let Node {
            start, end, second, ..
        } = self.nodes[node as usize];
        if second == NO_NODE {
            for index in &self.order[start as usize..end as usize] {
                if !self.is_gone[*index as usize] {
                    let offset = subtract(self.points[*index as usize], at);
                    insert(nearest, count, (self.squared(offset), *index));
                }
            }
            return;
        }
        let mut children = [
            (self.bound(node + 1, at), node + 1),
            (self.bound(second, at), second),
        ];
        if children[1].0 < children[0].0 {
            children.swap(0, 1);
        }
        for (bound, child) in children {
            let is_full = nearest.len() == count;
            // At the same distance a lower number may still win, so equality is looked at.
            let is_out = is_full && nearest.last().is_some_and(|worst| bound > worst.0);
            if self.nodes[child as usize].remaining > 0 && !is_out {
                self.visit(child, at, count, nearest);
            }
        }
    }

    /// Squared distance from `at` to a node's box; rounding is monotone, so it never exceeds
    /// that to a point inside.
    fn bound(&self, node: u32, at: [f64; 3]) -> f64 {
        let node = &self.nodes[node as usize];
        let outside = std::array::from_fn(|axis| {
            (node.low[axis] - at[axis])
                .max(at[axis] - node.high[axis])
                .max(0.0)
        });
        self.squared(outside)
    }

    fn squared(&self, offset: [f64; 3]) -> f64 {
        let [x, y, z] = offset;
        let [xx, yy, zz] = self.metric;
        x * x * xx + y * y * yy + z * z * zz
    }
}

fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Keeps the `count` smallest, in order.
fn insert(nearest: &mut Vec<(f64, u32)>, count: usize, new: (f64, u32)) {
    let at = nearest.partition_point(|old| (old.0, old.1) < new);
    if at < count {
        nearest.truncate(count - 1);
        nearest.insert(at, new);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_nearest_are_those_of_a_full_search_while_points_go(
            points in prop::collection::vec(
                prop::array::uniform3(-4..5_i32).prop_map(|p| p.map(f64::from)), 1..120),
            metric in prop::array::uniform3(prop::sample::select(vec![0.0, 0.25, 1.0, 4.0])),
            removals in prop::collection::vec(0..120_u32, 0..120),
            count in 0..15_usize,
        ) {
            let mut remaining = Remaining::new(&points, metric);
            let mut left: Vec<u32> = (0..points.len() as u32).collect();
            for removed in removals {
                let from = removed % points.len() as u32;
                let mut all: Vec<(f64, u32)> = left
                    .iter()
                    .map(|i| {
                        let offset = subtract(points[*i as usize], points[from as usize]);
                        (remaining.squared(offset), *i)
                    })
                    .collect();
                all.sort_by(|a, b| a.partial_cmp(b).unwrap());
                all.truncate(count);
                prop_assert_eq!(remaining.nearest(from, count), &all[..]);
                prop_assert_eq!(remaining.first(), left.first().copied());
                remaining.remove(from);
                left.retain(|i| *i != from);
            }
        }
    }
}

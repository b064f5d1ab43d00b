//! Where the surface cuts an edge between two voxels.

/// Tells after which part of the step from a value to one of the other sign the surface passes.
pub(crate) type Crossing = fn(f32, f32) -> f32;

/// Vertices stay away from voxels by this part of the step between two: those around one voxel
/// remain distinct also as 32-bit numbers.
pub(crate) const FROM_VOXEL: f32 = 0.02;

/// Part of an edge's contrast between two voxels from which the edge lies within their boxes.
const SHARP: f32 = 0.5;

/// The two voxels of an edge between nodes (see [`Signs`](super::signs::Signs)), the first and the
/// next one along `axis`; `None` if one of them is on the border.
#[inline]
pub(crate) fn voxels(node: [usize; 3], axis: usize, shape: [usize; 3]) -> Option<[[usize; 3]; 2]> {
    let is_voxel = |at: [usize; 3]| (0..3).all(|k| (1..=shape[k]).contains(&at[k]));
    let mut next = node;
    next[axis] += 1;
    (is_voxel(node) && is_voxel(next)).then(|| [node, next].map(|at| at.map(|n| n - 1)))
}

/// The place at a part of the step from a voxel to the next one along `axis`, in voxels.
#[inline]
pub(crate) fn place(voxel: [usize; 3], axis: usize, part: f32) -> [f32; 3] {
    let mut place = voxel.map(|v| v as f32);
    place[axis] += part.clamp(FROM_VOXEL, 1.0 - FROM_VOXEL);
    place
}

/// Where the value passes 0 between a node and the next one along `axis`, in voxels; `None` if one
/// of them is on the border.
#[inline]
pub(crate) fn between(
    node: [usize; 3],
    axis: usize,
    shape: [usize; 3],
    value: impl Fn([usize; 3]) -> f32,
    crossing: impl Fn(f32, f32) -> f32,
) -> Option<[f32; 3]> {
    let [a, b] = voxels(node, axis, shape)?;
    Some(place(a, axis, crossing(value(a), value(b))))
}

/// Halfway from the outermost voxels to the nodes beyond them: where their voxels end.
pub(crate) fn border(node: [usize; 3], axis: usize) -> [f32; 3] {
    let mut place = node.map(|n| n as f32 - 1.0);
    place[axis] += 0.5;
    place
}

/// The part of the step from a value `a` to one `b` of the other sign after which a line between
/// them passes 0.
#[inline]
pub(crate) fn linear(a: f32, b: f32) -> f32 {
    a / (a - b)
}

/// The same of values that an edge takes from -0.5 to 0.5 (more is another edge's), as means over the boxes around voxels.
///
/// A sharp edge is done within the two boxes, so that their sum tells how much of them is inside:
/// a line between the values would be off by up to 0.086 of the step. The line is true of edges
/// that take more than two steps; where they take just two, both say the same.
#[inline]
pub(crate) fn in_boxes(a: f32, b: f32) -> f32 {
    let [a, b] = [a, b].map(|value| value.clamp(-0.5, 0.5));
    if (a - b).abs() > SHARP {
        0.5 + a.signum() * (a + b)
    } else {
        linear(a, b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_found_wherever_it_is_between_two_boxes() {
        for part in [0.1f32, 0.25, 0.5, 0.6, 0.9] {
            // How much of the boxes around 0 and 1 lies before `part`.
            let inside = |at: f32| (part - at + 0.5).clamp(0.0, 1.0) - 0.5;
            let (a, b) = (inside(0.0), inside(1.0));
            assert!((in_boxes(a, b) - part).abs() < 1e-6, "{part}");
            assert!((in_boxes(-a, -b) - part).abs() < 1e-6, "{part}");
        }
    }

    #[test]
    fn both_ways_agree_where_one_takes_over() {
        for a in [0.1f32, 0.25, 0.4] {
            assert!((linear(a, a - SHARP) - (0.5 + 2.0 * a - SHARP)).abs() < 1e-6);
        }
    }
}

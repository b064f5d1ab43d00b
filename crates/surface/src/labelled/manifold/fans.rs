//! Vertices at which a closed surface touches itself.

use rayon::prelude::*;

/// The vertices with more than one fan of triangles, ascending.
pub(super) fn touched(triangles: &[[u32; 3]], points: usize) -> Vec<u32> {
    // Where each vertex's list of triangles starts.
    let mut starts = vec![0u32; points + 1];
    for &v in triangles.as_flattened() {
        starts[v as usize + 1] += 1;
    }
    for v in 0..points {
        starts[v + 1] += starts[v];
    }
    let mut next = starts.clone();
    let mut around = vec![[0; 2]; 3 * triangles.len()];
    for &[a, b, c] in triangles {
        for (v, rim) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
            around[next[v as usize] as usize] = rim;
            next[v as usize] += 1;
        }
    }
    let is_touched = |v: &u32| {
        let range = starts[*v as usize] as usize..starts[*v as usize + 1] as usize;
        !is_one_loop(&around[range])
    };
    (0..points as u32)
        .into_par_iter()
        .filter(is_touched)
        .collect()
}

/// Whether the sides opposite a vertex make up one closed loop, or there is none.
fn is_one_loop(sides: &[[u32; 2]]) -> bool {
    let Some(&[first, mut at]) = sides.first() else {
        return true;
    };
    let mut passed = 1;
    while at != first {
        let mut next = sides.iter().filter(|side| side[0] == at);
        let (Some(side), None) = (next.next(), next.next()) else {
            return false;
        };
        at = side[1];
        passed += 1;
        if passed > sides.len() {
            return false;
        }
    }
    passed == sides.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tetrahedra_that_share_a_corner_or_an_edge_touch_there() {
        let outward = |[a, b, c, d]: [u32; 4]| [[b, d, c], [a, c, d], [a, d, b], [a, b, c]];
        let one = outward([0, 1, 2, 3]);
        assert!(touched(&one, 9).is_empty());
        let corner = [one, outward([3, 4, 5, 6])].concat();
        assert_eq!(touched(&corner, 9), [3]);
        let edge = [one, outward([2, 3, 5, 6])].concat();
        assert_eq!(touched(&edge, 9), [2, 3]);
    }
}

//! Cells in an order that only the points decide, named by the input's indices.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::Tetrahedra;

/// Cells sorted, and about as many placed, between two looks at the cancel switch: some ten
/// milliseconds.
const CELLS_PER_BIN: usize = 1 << 16;

/// Sorts cells of ranks and names them by `input`, the index of each rank.
///
/// Cells are put in bins by their lowest rank first, so that no sort is long.
pub(crate) fn numbered(
    lists: &[Vec<[u32; 4]>],
    input: &[u32],
    task: &Task,
) -> Result<Tetrahedra, Cancelled> {
    let total: usize = lists.iter().map(Vec::len).sum();
    let bins = total.div_ceil(CELLS_PER_BIN).max(1);
    let bin = |cell: &[u32; 4]| cell[0] as usize * bins / input.len();
    let chunks = || lists.iter().flat_map(|list| list.chunks(CELLS_PER_BIN));
    let mut places = vec![0; bins];
    for chunk in chunks() {
        task.check()?;
        for cell in chunk {
            places[bin(cell)] += 1;
        }
    }
    let lengths = places.clone();
    let mut start = 0;
    for place in &mut places {
        start += std::mem::replace(place, start);
    }
    let mut cells = vec![[0; 4]; total];
    for chunk in chunks() {
        task.check()?;
        for cell in chunk {
            let place = &mut places[bin(cell)];
            cells[*place] = *cell;
            *place += 1;
        }
    }
    let mut rest = cells.as_mut_slice();
    let parts = lengths.into_iter().map(|length| {
        let (part, after) = std::mem::take(&mut rest).split_at_mut(length);
        rest = after;
        part
    });
    let parts: Vec<_> = parts.collect();
    parts.into_par_iter().try_for_each(|part| {
        task.check()?;
        part.sort_unstable_by_key(long_number);
        for cell in part {
            *cell = cell.map(|rank| input[rank as usize]);
        }
        Ok(())
    })?;
    Ok(Tetrahedra { cells })
}

/// As one long number a cell compares in the same order, but quicker.
fn long_number(&[a, b, c, d]: &[u32; 4]) -> u128 {
    let pair = |high: u32, low: u32| u64::from(high) << 32 | u64::from(low);
    u128::from(pair(a, b)) << 64 | u128::from(pair(c, d))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_any_order_make_the_same_sorted_cells() {
        let input: Vec<u32> = (0..500).rev().collect();
        // More cells than a bin has, with ranks in many bins.
        let cell = |i: u32| [i * 7919 % 490, 490 + i % 5, 495 + i % 3, 498 + i % 2];
        let cells: Vec<[u32; 4]> = (0..3 * CELLS_PER_BIN as u32).map(cell).collect();
        let (first, second) = cells.split_at(12_345);
        let task = Task::default();
        let found = numbered(&[first.to_vec(), second.to_vec()], &input, &task).unwrap();
        let other = numbered(&[second.to_vec(), first.to_vec()], &input, &task).unwrap();
        let mut expected = cells;
        expected.sort_unstable();
        let named = expected.iter().map(|c| c.map(|rank| 499 - rank));
        assert!(found.cells.iter().copied().eq(named));
        assert_eq!(found, other);
        assert!(numbered(&[], &input, &task).unwrap().cells.is_empty());
        task.cancel().cancel();
        assert_eq!(numbered(&[expected], &input, &task), Err(Cancelled));
    }
}

//! Which pixels of a slice are neighbours.

/// No neighbour.
const NONE: u32 = u32::MAX;

/// The up to eight neighbours of every pixel, sides before corners, so that a walk does not cut corners.
pub(super) struct Adjacent {
    /// Pixels by row and column.
    sorted: Vec<u32>,
    neighbours: Vec<[u32; 8]>,
}

/// Places in the list of neighbours: right, below, left, above, then the corners.
const RIGHT: usize = 0;
const LEFT: usize = 2;
/// Of the pixels below, by their column from one to the left to one to the right; and where the upper
/// pixel is in the list of that one.
const BELOW: [(usize, usize); 3] = [(5, 7), (1, 3), (4, 6)];

impl Adjacent {
    /// Finds them row by row. Of equal pixels one has neighbours.
    pub(super) fn of(pixels: &[[i32; 2]]) -> Self {
        let mut sorted: Vec<u32> = (0..pixels.len() as u32).collect();
        let key = |p: &u32| {
            let [column, row] = pixels[*p as usize];
            (row, column)
        };
        // Pixels that come in this order are sorted in linear time.
        sorted.sort_by_key(key);
        let mut distinct = sorted.clone();
        distinct.dedup_by_key(|p| key(p));
        let column = |p: u32| i64::from(pixels[p as usize][0]);
        let mut neighbours = vec![[NONE; 8]; pixels.len()];
        let mut above: &[u32] = &[];
        for row in distinct.chunk_by(|a, b| key(a).0 == key(b).0) {
            for pair in row.windows(2) {
                if column(pair[1]) == column(pair[0]) + 1 {
                    neighbours[pair[0] as usize][RIGHT] = pair[1];
                    neighbours[pair[1] as usize][LEFT] = pair[0];
                }
            }
            let is_next = above
                .first()
                .is_some_and(|p| i64::from(key(p).0) + 1 == i64::from(key(&row[0]).0));
            let mut from = 0;
            for &upper in above.iter().filter(|_| is_next) {
                while row
                    .get(from)
                    .is_some_and(|p| column(*p) < column(upper) - 1)
                {
                    from += 1;
                }
                for &lower in &row[from..] {
                    let Some((below, back)) = usize::try_from(column(lower) - column(upper) + 1)
                        .ok()
                        .and_then(|at| BELOW.get(at))
                    else {
                        break;
                    };
                    neighbours[upper as usize][*below] = lower;
                    neighbours[lower as usize][*back] = upper;
                }
            }
            above = row;
        }
        Self { sorted, neighbours }
    }

    /// All pixels by row and column.
    pub(super) fn sorted(&self) -> impl Iterator<Item = u32> {
        self.sorted.iter().copied()
    }

    /// The neighbours of a pixel.
    pub(super) fn of_point(&self, point: u32) -> impl Iterator<Item = u32> {
        let all = self.neighbours[point as usize].into_iter();
        all.filter(|p| *p != NONE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The order in which neighbours are listed, as offsets of column and row.
    const OFFSETS: [[i32; 2]; 8] = [
        [1, 0],
        [0, 1],
        [-1, 0],
        [0, -1],
        [1, 1],
        [-1, 1],
        [-1, -1],
        [1, -1],
    ];

    proptest! {
        #[test]
        fn neighbours_are_those_of_a_look_at_all_pixels(
            pixels in prop::collection::btree_set(prop::array::uniform2(-6..7_i32), 0..90),
        ) {
            let pixels: Vec<[i32; 2]> = pixels.into_iter().collect();
            let adjacent = Adjacent::of(&pixels);
            for (number, [i, j]) in (0_u32..).zip(&pixels) {
                let at = |[di, dj]: &[i32; 2]| pixels.iter().position(|p| *p == [i + di, j + dj]);
                let expected: Vec<u32> = OFFSETS.iter().filter_map(at).map(|p| p as u32).collect();
                let found: Vec<u32> = adjacent.of_point(number).collect();
                prop_assert_eq!(found, expected);
            }
        }
    }
}

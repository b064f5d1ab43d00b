//! Balls of steps as windows onto packed rows.

use super::offsets::{Offset, Offsets};

/// Growth of the number of steps from one level to the next.
const LEVEL_GROWTH: f64 = 1.15;

/// Bits that can be read from any place in one step.
const WINDOW: i32 = 57;

/// Windows side by side in a word.
const WINDOWS: usize = 4;

/// A part of a row relative to a point.
#[derive(Clone, Copy, Default)]
pub(super) struct Window {
    /// From the point's bit to the first of the window.
    pub(super) offset: isize,
    pub(super) mask: u64,
    /// Where in the word the window is put.
    pub(super) shift: u32,
}

/// Windows that are looked at together.
pub(super) struct Group {
    pub(super) windows: [Window; WINDOWS],
    /// Class of each bit of the word.
    pub(super) classes: [u16; 64],
}

/// A ball of steps.
pub(super) struct Level {
    pub(super) groups: Vec<Group>,
    /// How many classes the ball has.
    pub(super) classes: usize,
}

/// Where the bits lie: rows and slices are followed by as many empty ones as a step can reach.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    pub(super) lead: usize,
    pub(super) row: usize,
    pub(super) slice: usize,
}

impl Layout {
    /// The bit of a point, counted from the lowest coordinates.
    pub(super) fn bit(self, from_low: [i32; 3]) -> usize {
        self.lead.wrapping_add_signed(self.step(from_low))
    }

    pub(super) fn step(self, [x, y, z]: [i32; 3]) -> isize {
        x as isize + y as isize * self.row as isize + z as isize * self.slice as isize
    }
}

/// Balls from the smallest that can hold `k` points to that of all steps.
pub(super) fn levels(offsets: &Offsets, k: usize, layout: Layout) -> Vec<Level> {
    let all = &offsets.nearest_first;
    let mut levels = Vec::new();
    let mut wanted = k;
    loop {
        // A ball holds all steps of a length or none.
        let last = all[wanted.min(all.len()) - 1].class;
        let end = all.partition_point(|offset| offset.class <= last);
        levels.push(Level::new(&all[..end], layout));
        if end == all.len() {
            return levels;
        }
        wanted = (end as f64 * LEVEL_GROWTH) as usize + 1;
    }
}

impl Level {
    /// The windows that hold the bits of `offsets`, nearest first.
    fn new(offsets: &[Offset], layout: Layout) -> Self {
        let mut by_row = offsets.to_vec();
        by_row.sort_unstable_by_key(|offset| {
            let [x, y, z] = offset.step;
            [z, y, x]
        });
        let mut groups: Vec<Group> = Vec::new();
        // Windows and bits used of the last group's word.
        let (mut windows, mut used) = (WINDOWS, 64);
        // Rows longer than a window are cut into several.
        let place = |offset: &Offset| {
            let [x, y, z] = offset.step;
            [z, y, (x + WINDOW / 2).div_euclid(WINDOW)]
        };
        for part in by_row.chunk_by(|a, b| place(a) == place(b)) {
            let width = (part[part.len() - 1].step[0] - part[0].step[0] + 1) as u32;
            if windows == WINDOWS || used + width > 64 {
                groups.push(Group {
                    windows: [Window::default(); WINDOWS],
                    classes: [0; 64],
                });
                (windows, used) = (0, 0);
            }
            let group = groups
                .last_mut()
                .expect("one was pushed, else this is a bug");
            group.put(part, windows, used, layout);
            windows += 1;
            used += width;
        }
        let classes = offsets.last().map_or(0, |offset| offset.class as usize + 1);
        Self { groups, classes }
    }
}

impl Group {
    /// Puts the neighbouring steps `part` of one row into the word from bit `shift` on.
    fn put(&mut self, part: &[Offset], window: usize, shift: u32, layout: Layout) {
        let first = part[0].step;
        let mut mask = 0;
        for offset in part {
            let bit = (offset.step[0] - first[0]) as u32;
            mask |= 1 << bit;
            self.classes[(shift + bit) as usize] = offset.class;
        }
        self.windows[window] = Window {
            offset: layout.step(first),
            mask,
            shift,
        };
    }
}

//! Step 4: of the pixels that stayed, the connected pieces that are strong somewhere.

/// What is known about a pixel while pieces are followed.
const NONE: u8 = 0;
const WAITING: u8 = 1;

/// A pixel that stayed after suppression.
#[derive(Clone, Copy)]
pub(super) struct Candidate {
    /// Index of the pixel in its slice; never in the outermost ring.
    pub(super) pixel: u32,
    /// Whether its magnitude starts an edge.
    pub(super) is_strong: bool,
}

/// Follows the 8-connected pieces of one slice at a time.
#[derive(Default)]
pub(super) struct Hysteresis {
    state: Vec<u8>,
    open: Vec<u32>,
}

impl Hysteresis {
    /// For slices of `pixels` pixels.
    pub(super) fn new(pixels: usize) -> Self {
        Self {
            state: vec![NONE; pixels],
            open: Vec::new(),
        }
    }

    /// Sets in `edges` every candidate that is connected to a strong one.
    pub(super) fn connect(&mut self, candidates: &[Candidate], columns: usize, edges: &mut [bool]) {
        for candidate in candidates {
            self.state[candidate.pixel as usize] = WAITING;
        }
        for candidate in candidates.iter().filter(|c| c.is_strong) {
            self.follow(candidate.pixel, columns as u32, edges);
        }
        for candidate in candidates {
            self.state[candidate.pixel as usize] = NONE;
        }
    }

    /// Takes the whole piece around `start` that is still waiting.
    fn follow(&mut self, start: u32, columns: u32, edges: &mut [bool]) {
        self.take(start, edges);
        while let Some(pixel) = self.open.pop() {
            // Candidates keep off the outermost ring, so all eight neighbours exist.
            for row in [pixel - columns, pixel, pixel + columns] {
                for neighbour in row - 1..=row + 1 {
                    self.take(neighbour, edges);
                }
            }
        }
    }

    fn take(&mut self, pixel: u32, edges: &mut [bool]) {
        let state = &mut self.state[pixel as usize];
        if *state == WAITING {
            *state = NONE;
            edges[pixel as usize] = true;
            self.open.push(pixel);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weak_piece_stays_only_where_it_touches_a_strong_pixel() {
        // Columns of an 8 x 8 slice: a strong pixel with a weak diagonal tail, and a weak piece.
        let candidate = |row: u32, column: u32, is_strong| Candidate {
            pixel: row * 8 + column,
            is_strong,
        };
        let candidates = [
            candidate(1, 1, true),
            candidate(2, 2, false),
            candidate(3, 1, false),
            candidate(5, 5, false),
            candidate(5, 6, false),
        ];
        let mut hysteresis = Hysteresis::new(64);
        for _ in 0..2 {
            let mut edges = vec![false; 64];
            hysteresis.connect(&candidates, 8, &mut edges);
            let kept: Vec<usize> = (0..64).filter(|i| edges[*i]).collect();
            assert_eq!(kept, [9, 18, 25]);
        }
    }
}

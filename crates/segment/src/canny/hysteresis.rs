//! Step 4: of the pixels that stayed, the connected pieces that are strong somewhere.

/// A pixel that stayed after suppression.
#[derive(Clone, Copy, Default)]
pub(super) struct Candidate {
    /// Index of the pixel in its slice; never in the outermost ring.
    pub(super) pixel: u32,
    /// Whether its magnitude starts an edge.
    pub(super) is_strong: bool,
}

/// Follows the 8-connected pieces of one slice at a time.
pub(super) struct Hysteresis {
    /// Whether a pixel is weak and not known to be an edge.
    waits: Vec<bool>,
    weak: Vec<u32>,
    open: Vec<u32>,
}

impl Hysteresis {
    /// For slices of `pixels` pixels.
    pub(super) fn new(pixels: usize) -> Self {
        Self {
            waits: vec![false; pixels],
            weak: Vec::new(),
            open: Vec::new(),
        }
    }

    /// Sets in `edges` every candidate that is connected to a strong one.
    ///
    /// Most candidates are strong, so the weak ones look for them and not the other way round.
    pub(super) fn connect(&mut self, candidates: &[Candidate], columns: usize, edges: &mut [bool]) {
        self.weak.clear();
        for candidate in candidates {
            if candidate.is_strong {
                edges[candidate.pixel as usize] = true;
            } else {
                self.waits[candidate.pixel as usize] = true;
                self.weak.push(candidate.pixel);
            }
        }
        for at in 0..self.weak.len() {
            let pixel = self.weak[at];
            let touches_edge = neighbours(pixel, columns).any(|n| edges[n as usize]);
            if self.waits[pixel as usize] && touches_edge {
                self.follow(pixel, columns, edges);
            }
        }
        for pixel in &self.weak {
            self.waits[*pixel as usize] = false;
        }
    }

    /// Takes the weak pixels around `start` that are still waiting.
    fn follow(&mut self, start: u32, columns: usize, edges: &mut [bool]) {
        self.open.push(start);
        while let Some(pixel) = self.open.pop() {
            self.waits[pixel as usize] = false;
            edges[pixel as usize] = true;
            let waiting = neighbours(pixel, columns).filter(|n| self.waits[*n as usize]);
            self.open.extend(waiting);
        }
    }
}

/// A pixel with its eight neighbours; candidates keep off the outermost ring, so all exist.
fn neighbours(pixel: u32, columns: usize) -> impl Iterator<Item = u32> {
    let columns = columns as u32;
    [pixel - columns, pixel, pixel + columns]
        .into_iter()
        .flat_map(|row| row - 1..=row + 1)
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

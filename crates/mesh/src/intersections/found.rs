//! Pairs counted, and the lowest of them kept.

/// The pairs met so far.
pub(super) struct Found {
    count: usize,
    /// The `most` lowest pairs are always among these.
    pairs: Vec<[u32; 2]>,
    most: usize,
}

impl Found {
    pub(super) fn new(most: usize) -> Self {
        Self {
            count: 0,
            pairs: Vec::new(),
            most,
        }
    }

    pub(super) fn add(&mut self, pair: [u32; 2]) {
        self.count += 1;
        self.pairs.push(pair);
        self.trim();
    }

    pub(super) fn plus(mut self, other: Self) -> Self {
        self.count += other.count;
        self.pairs.extend(other.pairs);
        self.trim();
        self
    }

    /// How many there are, and the lowest in order.
    pub(super) fn into_parts(mut self) -> (usize, Vec<[u32; 2]>) {
        self.pairs.sort_unstable();
        self.pairs.truncate(self.most);
        (self.count, self.pairs)
    }

    /// Forgets pairs that are too high to be kept, once there are many.
    fn trim(&mut self) {
        const ROOM: usize = 1 << 10;
        if self.pairs.len() >= self.most.saturating_mul(2).saturating_add(ROOM) {
            self.pairs.select_nth_unstable(self.most);
            self.pairs.truncate(self.most);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_pairs_are_kept_and_all_are_counted() {
        for most in [0, 1, 5, 10_000] {
            let mut found = Found::new(most);
            let mut other = Found::new(most);
            for i in 0..8000_u32 {
                // 7919 is prime, so every number comes up once.
                let pair = [i * 7919 % 8000, 8000];
                if i % 3 == 0 { &mut found } else { &mut other }.add(pair);
            }
            let (count, pairs) = found.plus(other).into_parts();
            assert_eq!(count, 8000);
            let lowest: Vec<[u32; 2]> = (0..8000).map(|i| [i, 8000]).take(most).collect();
            assert_eq!(pairs, lowest);
        }
    }
}

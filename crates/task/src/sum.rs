//! Sums whose last bit does not depend on the number of threads.

use rayon::prelude::*;

/// Values added up one after the other before the partial sums are combined.
const CHUNK: usize = 4096;

/// Sum of `values` in parallel: fixed chunks, then the chunk sums in order.
///
/// Any number of threads gives the same bits, which a sum that decides anything (alpha) needs.
pub fn chunked_sum(values: &[f64]) -> f64 {
    let partial: Vec<f64> = values
        .par_chunks(CHUNK)
        .map(|chunk| chunk.iter().sum::<f64>())
        .collect();
    partial.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_is_the_same_for_any_number_of_threads() {
        let values: Vec<f64> = (0..100_000).map(|i| 1.0 / f64::from(i + 1)).collect();
        let sums: Vec<u64> = [1, 2, 3, 8]
            .into_iter()
            .map(|n| {
                crate::pool(std::num::NonZeroUsize::new(n))
                    .unwrap()
                    .install(|| chunked_sum(&values))
                    .to_bits()
            })
            .collect();
        assert!(sums.iter().all(|s| *s == sums[0]));
    }
}

//! Sorting that can be stopped.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

/// Items put into buckets between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// The items in the order of their keys. Each goes to the bucket, of at most 256, that `bucket`
/// names, which never falls where keys rise.
pub(crate) fn sorted<T: Send, K: Ord>(
    items: impl IntoIterator<Item = T>,
    bucket: impl Fn(&T) -> u8,
    key: impl Fn(&T) -> K + Sync,
    task: &Task,
) -> Result<Vec<T>, Cancelled> {
    let mut buckets: Vec<Vec<T>> = (0..=u8::MAX).map(|_| Vec::new()).collect();
    for (done, item) in items.into_iter().enumerate() {
        if done.is_multiple_of(STRIDE) {
            task.check()?;
        }
        buckets[usize::from(bucket(&item))].push(item);
    }
    buckets.par_iter_mut().try_for_each(|bucket| {
        task.check()?;
        bucket.sort_unstable_by_key(&key);
        Ok(())
    })?;
    Ok(buckets.into_iter().flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_are_one_order() {
        let items: Vec<u16> = (0..50_000u16).map(|i| i.wrapping_mul(40_503)).collect();
        let high = |i: &u16| (i >> 8) as u8;
        let found = sorted(items.iter().copied(), high, |i| *i, &Task::default()).unwrap();
        let mut expected = items;
        expected.sort_unstable();
        assert_eq!(found, expected);
    }
}

//! Splitting geometry into tiles of about equal size, so that a frame draws only what is in sight.

use fragscale_core::split_mix::SplitMix;
use std::ops::Range;

use glam::Vec3;

/// Reorders `items` and cuts them into runs of at most `limit`, each compact over (x, y): halved at
/// the median along its longer side until small enough. `place` says where an item is.
pub(crate) fn tiles(
    items: &mut [u32],
    limit: usize,
    place: &impl Fn(u32) -> Vec3,
) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut waiting: Vec<Range<usize>> = std::iter::once(0..items.len()).collect();
    while let Some(run) = waiting.pop() {
        if run.len() <= limit.max(1) {
            if !run.is_empty() {
                runs.push(run);
            }
            continue;
        }
        let part = &mut items[run.clone()];
        let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for &item in part.iter() {
            let p = place(item);
            (min, max) = (min.min(p), max.max(p));
        }
        let size = max - min;
        let half = part.len() / 2;
        if size.x > size.y {
            part.select_nth_unstable_by(half, |&a, &b| place(a).x.total_cmp(&place(b).x));
        } else {
            part.select_nth_unstable_by(half, |&a, &b| place(a).y.total_cmp(&place(b).y));
        }
        waiting.push(run.start + half..run.end);
        waiting.push(run.start..run.start + half);
    }
    runs
}

/// Shuffles by a fixed seed, so that every prefix is a fair sample and the same one each time.
pub(crate) fn shuffle(items: &mut [u32]) {
    let mut random = SplitMix(SplitMix::GOLDEN);
    for last in (1..items.len()).rev() {
        // The modulo's bias is below 2^-32 for lists of this length.
        let other = (random.next() % (last as u64 + 1)) as usize;
        items.swap(last, other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_small_compact_and_complete() {
        // A 64 x 64 grid in tiles of 64: squares of 8 x 8.
        let place = |i: u32| Vec3::new((i % 64) as f32, (i / 64) as f32, 0.0);
        let mut items: Vec<u32> = (0..4096).collect();
        let runs = tiles(&mut items, 64, &place);
        assert_eq!(runs.len(), 64);
        for run in &runs {
            let places: Vec<Vec3> = items[run.clone()].iter().map(|&i| place(i)).collect();
            let min = places.iter().copied().reduce(Vec3::min).unwrap();
            let max = places.iter().copied().reduce(Vec3::max).unwrap();
            assert_eq!(max - min, Vec3::new(7.0, 7.0, 0.0));
        }
        items.sort_unstable();
        assert_eq!(items, (0..4096).collect::<Vec<u32>>());
    }

    /// Without a size to halve there is still an end.
    #[test]
    fn points_in_one_place_are_split_by_number() {
        let mut items: Vec<u32> = (0..10).collect();
        assert_eq!(tiles(&mut items, 4, &|_| Vec3::ONE).len(), 4);
        assert!(tiles(&mut [], 4, &|_| Vec3::ONE).is_empty());
    }

    /// Each quarter of the line gets about a quarter of the prefix: 250 of 1000 with a standard
    /// deviation of 13 (hypergeometric).
    #[test]
    fn a_prefix_is_a_fair_sample() {
        let mut items: Vec<u32> = (0..8000).collect();
        shuffle(&mut items);
        for quarter in 0..4 {
            let range = quarter * 2000..(quarter + 1) * 2000;
            let count = items[..1000].iter().filter(|i| range.contains(*i)).count();
            assert!((200..300).contains(&count), "{count}");
        }
        items.sort_unstable();
        assert_eq!(items, (0..8000).collect::<Vec<u32>>());
    }
}

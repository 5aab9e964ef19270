//! Photos whose fragments are drawn anew, each by random numbers of its own.
//!
//! How many times a draw holds a fragment follows Poisson's law with the mean 1, by a number that its place in the photo and
//! the draw's seed make; all of a photo together are then taken for as many as there are. That is the bootstrap (Hanley and
//! MacGibbon, Computer Methods and Programs in Biomedicine 83 (2006) 57), and what happens to one fragment changes nothing of how
//! the others are drawn: by numbers that are taken one after another all draws are others where one fragment is left out.

use fragscale_core::split_mix::{SplitMix, spread};
use rustc_hash::FxHashMap;

use crate::mass::{PhotoFragments, Steps};
use crate::measures::Fragment;

/// The chance of Poisson's law with the mean 1 that there is none.
const NONE: f64 = 1.0 / std::f64::consts::E;

/// More than that no draw holds of one: the chance is 1e-20.
const MOST: f64 = 20.0;

/// A photo whose fragments can be drawn anew.
pub(crate) struct Redrawn {
    /// Its fragments ascend by size: so do those of a draw, which need no sorting then.
    pub(crate) photo: PhotoFragments,
    /// The way to the mass.
    pub(crate) steps: Steps,
    /// By what each is drawn, in the same order.
    keys: Vec<u64>,
}

impl Redrawn {
    pub(crate) fn of(photo: &PhotoFragments, steps: Steps) -> Self {
        let fragments = photo.fragments.iter().copied();
        let mut keyed: Vec<(Fragment, u64)> = fragments.zip(keys(&photo.fragments)).collect();
        let size = |of: &Fragment| of.world.map_or(0.0, |world| world.sieve_size);
        keyed.sort_by(|(a, _), (b, _)| size(a).total_cmp(&size(b)));
        let (fragments, keys) = keyed.into_iter().unzip();
        Self {
            photo: PhotoFragments {
                fragments,
                ..photo.without_fragments()
            },
            steps,
            keys,
        }
    }

    /// How many times a draw of this seed holds each of its fragments, in their order: together as many as there are.
    pub(crate) fn times(&self, seed: u64) -> Vec<f64> {
        let keys = self.keys.iter();
        let mut times: Vec<f64> = keys
            .map(|key| poisson(SplitMix(key ^ seed).unit()))
            .collect();
        let all: f64 = times.iter().sum();
        if all > 0.0 {
            let factor = times.len() as f64 / all;
            times.iter_mut().for_each(|times| *times *= factor);
        } else {
            // Of a few it may hold none: then it holds them as they are.
            times.fill(1.0);
        }
        times
    }
}

/// Of each fragment a number that follows from where its middle lies: it stays where others are changed, taken away or numbered
/// anew, and mostly where a stroke moves its own outline a little. Of several in one place each has its own, in their order.
fn keys(fragments: &[Fragment]) -> Vec<u64> {
    let mut met: FxHashMap<u64, u64> = FxHashMap::default();
    let key = |of: &Fragment| {
        let cell = cell(of.pixels);
        let [x, y] = (of.middle / cell).floor().to_array();
        let place = [x, y, cell].map(f64::to_bits).into_iter();
        let place = place.fold(0_u64, |all, of| spread(all.wrapping_add(spread(of))));
        let before = met.entry(place).or_insert(0);
        let key = spread(place.wrapping_add(*before));
        *before += 1;
        key
    };
    fragments.iter().map(key).collect()
}

/// How exactly the middle of a fragment of so many pixels counts, pixels: the power of two from an eighth to a quarter of their root,
/// 1 at least. Two of one size do not lie as near to each other.
fn cell(pixels: usize) -> f64 {
    f64::from(1_u32 << (pixels.max(16).ilog2() / 2 - 2))
}

/// The count of Poisson's law with the mean 1 below which this share of all counts lies, 0 to 1.
fn poisson(share: f64) -> f64 {
    let (mut count, mut chance, mut left) = (0.0, NONE, share);
    while left >= chance && count < MOST {
        left -= chance;
        count += 1.0;
        chance /= count;
    }
    count
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::mass::tests::fragment;

    fn photo(count: u32) -> PhotoFragments {
        let one = |number: u32| {
            let mut one = fragment(1.0 + f64::from(number % 7), 0.0, false);
            one.middle = DVec2::new(f64::from(number % 40), f64::from(number / 40)) * 3.3;
            one
        };
        PhotoFragments {
            fragments: (0..count).map(one).collect(),
            frame: DVec2::splat(100.0),
            fines: 0.0,
            limit: 0.5,
            mm: 1.0,
        }
    }

    /// Poisson's own chances of 0, 1 and 2 are 1/e, 1/e and 1/(2e); of the whole range of numbers the mean and variance are 1.
    #[test]
    fn counts_follow_poissons_law() {
        let e = std::f64::consts::E;
        for (share, wanted) in [
            (0.0, 0.0),
            (0.999 / e, 0.0),
            (1.001 / e, 1.0),
            (1.999 / e, 1.0),
            (2.001 / e, 2.0),
            (2.499 / e, 2.0),
            (2.501 / e, 3.0),
        ] {
            assert_eq!(poisson(share), wanted, "{share}");
        }
        assert!(poisson(1.0 - f64::EPSILON / 2.0) <= MOST);
        let counts: Vec<f64> = (0..100_000)
            .map(|part| poisson((f64::from(part) + 0.5) / 1e5))
            .collect();
        for power in [1, 2] {
            let mean = counts.iter().map(|of| of.powi(power)).sum::<f64>() / 1e5;
            assert!((mean - f64::from(power)).abs() < 1e-3, "{power}: {mean}");
        }
    }

    /// The mean of 500 sizes is as sure as by drawing with replacement: their variance over their count.
    #[test]
    fn means_are_as_sure_as_by_drawing_with_replacement() {
        let redrawn = Redrawn::of(&photo(500), Steps::default());
        let own: Vec<f64> = (redrawn.photo.fragments.iter())
            .filter_map(|of| Some(of.world?.sieve_size))
            .collect();
        let count = own.len() as f64;
        let middle = own.iter().sum::<f64>() / count;
        let variance = own.iter().map(|of| (of - middle).powi(2)).sum::<f64>() / count;
        let means: Vec<f64> = (0..4000)
            .map(|seed| {
                let times = redrawn.times(spread(seed));
                assert!((times.iter().sum::<f64>() - count).abs() < 1e-9);
                times.iter().zip(&own).map(|(a, b)| a * b).sum::<f64>() / count
            })
            .collect();
        let off = means.iter().map(|of| of - middle);
        let bias = off.clone().sum::<f64>() / 4000.0;
        let found = off.map(|of| of * of).sum::<f64>() / 4000.0;
        assert!(bias.powi(2) < 0.01 * found, "{bias}");
        assert!((found / (variance / count) - 1.0).abs() < 0.1, "{found}");
    }

    /// One that is taken away, and another order, leave the others as often in a draw as they were, but for the count of all.
    #[test]
    fn each_is_drawn_by_its_own_numbers() {
        let whole = photo(50);
        let mut less = whole.clone();
        less.fragments.remove(20);
        less.fragments.reverse();
        let [whole, less] = [&whole, &less].map(|of| Redrawn::of(of, Steps::default()));
        let held = |of: &Redrawn, seed: u64| -> Vec<(f64, f64, f64)> {
            let all = of.photo.fragments.iter().zip(of.times(seed));
            let mut all: Vec<_> = all
                .map(|(of, times)| (of.middle.x, of.middle.y, times))
                .collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
            all
        };
        let taken = photo(50).fragments[20].middle;
        for seed in 0..20 {
            let (before, now) = (held(&whole, seed), held(&less, seed));
            let kept = before
                .iter()
                .filter(|(x, y, _)| DVec2::new(*x, *y) != taken);
            let factors = kept.zip(&now).map(|(a, b)| {
                assert_eq!((a.0, a.1, a.2 == 0.0), (b.0, b.1, b.2 == 0.0));
                b.2 / a.2
            });
            let factors: Vec<f64> = factors.filter(|factor| factor.is_finite()).collect();
            assert!(factors.len() > 15);
            for factor in &factors {
                assert!((factor / factors[0] - 1.0).abs() < 1e-12);
            }
        }
    }

    /// A stroke that moves the middle of a large one a little leaves it its numbers, and it shares them with no neighbour.
    #[test]
    fn a_place_is_no_point() {
        let cells = [0, 1, 63, 64, 255, 256, 10_000].map(cell);
        assert_eq!(cells, [1.0, 1.0, 1.0, 2.0, 2.0, 4.0, 16.0]);
        let key_at = |x: f64, y: f64| {
            let mut one = fragment(1.0, 0.0, false);
            (one.pixels, one.middle) = (10_000, DVec2::new(x, y));
            keys(&[one])[0]
        };
        let key = key_at(40.0, 8.0);
        assert_eq!(key, key_at(42.3, 6.9));
        for (x, y) in [(40.0, 108.0), (140.0, 8.0), (8.0, 40.0)] {
            assert_ne!(key, key_at(x, y));
        }
    }

    /// Those in one pixel are drawn each by itself, and of one or none something is drawn.
    #[test]
    fn few_and_near_ones() {
        let mut together = photo(2);
        together.fragments[1].middle = together.fragments[0].middle + 0.4;
        let together = Redrawn::of(&together, Steps::default());
        let differ = (0..100).filter(|seed| {
            let times = together.times(spread(*seed));
            times[0] != times[1]
        });
        assert!(differ.count() > 40);
        for count in [0, 1] {
            let few = Redrawn::of(&photo(count), Steps::default());
            for seed in 0..20 {
                assert_eq!(few.times(spread(seed)), vec![1.0; count as usize]);
            }
        }
    }
}

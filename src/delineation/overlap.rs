//! How regions agree with a label image that is held to be true.

use rustc_hash::FxHashMap;

use crate::labels::{FINES, LabelImage, NOT_ROCK};
use crate::tree::{NOWHERE, Tree};

/// Of every node the most that it shares with a true fragment: pixels in both over pixels in either.
pub fn of_nodes(tree: &Tree, truth: &LabelImage) -> Vec<f64> {
    let areas = truth.areas();
    let mut shared: Vec<FxHashMap<u32, u32>> = vec![FxHashMap::default(); tree.nodes.len()];
    for (leaf, label) in tree.leaf_of.iter().zip(&truth.labels) {
        if *leaf != NOWHERE && *label != FINES && *label != NOT_ROCK {
            *shared[*leaf as usize].entry(*label).or_default() += 1;
        }
    }
    let mut most = Vec::with_capacity(tree.nodes.len());
    for (place, node) in tree.nodes.iter().enumerate() {
        if let Some([a, b]) = node.children {
            let [mut large, mut small] =
                [a, b].map(|child| std::mem::take(&mut shared[child as usize]));
            if large.len() < small.len() {
                std::mem::swap(&mut large, &mut small);
            }
            for (label, count) in small {
                *large.entry(label).or_default() += count;
            }
            shared[place] = large;
        }
        let with = shared[place].iter().map(|(label, count)| {
            let both = f64::from(*count);
            both / (node.sums.area + areas[*label as usize] as f64 - both)
        });
        most.push(with.fold(0.0, f64::max));
    }
    most
}

/// Whether each label's found fragment counts: where the truth is not `complete`, if most of it lies where something was outlined.
pub fn counts(found: &LabelImage, truth: &LabelImage, complete: bool) -> Vec<bool> {
    let areas = found.areas();
    let mut outlined = vec![0; areas.len()];
    for (label, other) in found.labels.iter().zip(&truth.labels) {
        if *label != NOT_ROCK && *other != FINES && *other != NOT_ROCK {
            outlined[*label as usize] += 1;
        }
    }
    let both = areas.into_iter().zip(outlined);
    both.map(|(area, outlined)| complete || 2 * outlined > area)
        .collect()
}

/// How found fragments agree with true ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Agreement {
    /// Found ones that share more than half with a true one: then each has only one.
    pub right: usize,
    /// Found ones that do not.
    pub wrong: usize,
    /// True ones that nobody found.
    pub missed: usize,
}

impl Agreement {
    /// Of found against true fragments. True ones of fewer pixels than `least` and found ones of fewer do not count.
    /// Where the truth is not `complete`, neither do found ones of which most is where nothing was outlined.
    pub fn of(found: &LabelImage, truth: &LabelImage, least: usize, complete: bool) -> Self {
        let (found_areas, true_areas) = (found.areas(), truth.areas());
        let mut shared: FxHashMap<[u32; 2], usize> = FxHashMap::default();
        for (one, other) in found.labels.iter().zip(&truth.labels) {
            if *one == FINES || *one == NOT_ROCK || *other == FINES || *other == NOT_ROCK {
                continue;
            }
            *shared.entry([*one, *other]).or_default() += 1;
        }
        let mut is_right = vec![false; found_areas.len()];
        let mut is_found = vec![false; true_areas.len()];
        for ([one, other], both) in shared {
            let either = found_areas[one as usize] + true_areas[other as usize] - both;
            if 2 * both > either {
                is_right[one as usize] = true;
                is_found[other as usize] = true;
            }
        }
        let counts = counts(found, truth, complete);
        let mut agreement = Self::default();
        for (label, area) in found_areas.iter().enumerate().skip(1) {
            if is_right[label] {
                agreement.right += 1;
            } else if *area >= least && counts[label] {
                agreement.wrong += 1;
            }
        }
        let missed = true_areas.iter().zip(&is_found).skip(1);
        agreement.missed = missed
            .filter(|(area, is_found)| **area >= least && !**is_found)
            .count();
        agreement
    }

    /// Of several photos together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            right: self.right + other.right,
            wrong: self.wrong + other.wrong,
            missed: self.missed + other.missed,
        }
    }

    /// The harmonic mean of the share of found ones that are right and of true ones that were found.
    pub fn f1(self) -> f64 {
        let right = self.right as f64;
        right / (right + 0.5 * (self.wrong + self.missed) as f64).max(1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two true fragments one is found half too large, one is missed; one find lies on fines.
    #[test]
    fn by_hand() {
        let row = |labels: [u32; 10]| LabelImage {
            width: 10,
            height: 1,
            labels: labels.to_vec(),
        };
        let truth = row([1, 1, 1, 1, 0, 0, 0, 0, 2, 2]);
        let found = row([1, 1, 1, 1, 1, 1, 2, 2, 0, 0]);
        let complete = Agreement::of(&found, &truth, 1, true);
        assert_eq!(
            complete,
            Agreement {
                right: 1,
                wrong: 1,
                missed: 1
            }
        );
        assert!((complete.f1() - 0.5).abs() < 1e-12);
        // Where not all is outlined, a find on nothing is no error.
        let partly = Agreement::of(&found, &truth, 1, false);
        assert_eq!(
            partly,
            Agreement {
                right: 1,
                wrong: 0,
                missed: 1
            }
        );
        // Small ones do not count.
        let large = Agreement::of(&found, &truth, 3, true);
        assert_eq!(
            large,
            Agreement {
                right: 1,
                wrong: 0,
                missed: 0
            }
        );
    }
}

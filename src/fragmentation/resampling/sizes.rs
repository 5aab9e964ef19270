//! Sizes of many curves, told in one sentence.

use crate::LabelledDistribution;
use crate::distribution::as_typed;
use crate::units::LengthUnit;

/// Sizes of one curve after another, which are told in one sentence.
#[derive(Default)]
pub(super) struct Sizes {
    /// Of how many curves there are some, how many at least and at most, and the least and the greatest.
    curves: usize,
    counts: [usize; 2],
    ends: [f64; 2],
    /// What stands in front of a sentence of the first of the curves.
    first: String,
}

/// The parts of such a sentence.
pub(super) struct ToldSizes {
    pub(super) in_front: String,
    pub(super) count: String,
    pub(super) range: String,
    pub(super) of_curves: String,
}

impl Sizes {
    /// Adds those of a curve, which ascend.
    pub(super) fn add(&mut self, curve: &LabelledDistribution, sizes: &[f64]) {
        let (Some(least), Some(most)) = (sizes.first(), sizes.last()) else {
            return;
        };
        let count = sizes.len();
        if self.curves == 0 {
            self.counts = [count; 2];
            self.ends = [*least, *most];
            self.first = curve.labels.in_front();
        }
        self.curves += 1;
        self.counts = [self.counts[0].min(count), self.counts[1].max(count)];
        self.ends = [self.ends[0].min(*least), self.ends[1].max(*most)];
    }

    /// What is told of them, of `all` curves; `None` where there are none.
    pub(super) fn told(self, unit: LengthUnit, all: usize) -> Option<ToldSizes> {
        let [least, most] = self.ends.map(as_typed);
        let count = match self.counts {
            [fewest, most] if fewest == most => most.to_string(),
            [fewest, most] => format!("{fewest} to {most}"),
        };
        let (in_front, of_curves) = match self.curves {
            0 => return None,
            1 => (self.first, String::new()),
            some if some == all => (String::new(), format!(" of each of the {all} curves")),
            some => (
                String::new(),
                format!(" of each of {some} of the {all} curves"),
            ),
        };
        Some(ToldSizes {
            in_front,
            count,
            range: format!("{least} to {most} {unit}"),
            of_curves,
        })
    }
}

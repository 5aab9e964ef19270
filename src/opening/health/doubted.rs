//! What speaks against one thing, over all photos.

use super::{Health, HealthFinding, HealthItem, of};
use crate::flight::{Doubt, PhotoReview, Review};

/// What speaks against one thing.
pub(super) struct Doubted {
    /// In how many photos.
    count: usize,
    /// The first such reason.
    pub(super) first: Doubt,
}

/// Whether reasons for doubt speak against this.
pub(super) fn doubted(review: &Review, item: HealthItem) -> Option<Doubted> {
    let is_meant = |doubt: &&Doubt| HealthItem::doubted_by(doubt) == Some(item);
    let reason = |photo: PhotoReview<'_>| photo.doubts.iter().find(is_meant).cloned();
    let mut reasons = review.photos().filter_map(reason);
    let first = reasons.next()?;
    Some(Doubted {
        count: 1 + reasons.count(),
        first,
    })
}

impl Doubted {
    /// "3 of 7 photos".
    pub(super) fn share(&self, review: &Review) -> String {
        share(self.count, review)
    }

    /// With the reason.
    pub(super) fn says(&self, review: &Review) -> String {
        format!("{}: {}.", self.share(review), self.first)
    }
}

/// "3 of 7 photos".
pub(super) fn share(count: usize, review: &Review) -> String {
    format!("{count} of {} photos", review.count())
}

/// Where something speaks against them, with the first reason.
pub(super) fn only_where_doubted(review: &Review, item: HealthItem) -> Option<HealthFinding> {
    doubted(review, item).map(|doubted| {
        let share = doubted.share(review);
        let says = format!("{share}; the first: {}.", doubted.first);
        of(item, Health::Bad, share, says)
    })
}

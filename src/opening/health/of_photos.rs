//! How a flight's photos are: their poses, what their files say, whether they are there.

use super::doubted::{doubted, only_where_doubted, share};
use super::{Health, HealthFinding, HealthItem, Remedy, StatedOfFlight, of};
use crate::flight::{Doubt, PhotoFileState, PhotoReview, Review};

pub(super) fn exif(review: &Review, stated: &StatedOfFlight<'_>) -> HealthFinding {
    let item = HealthItem::Exif;
    if let Some(doubted) = doubted(review, item) {
        let can_georeference = stated.reconstruction.is_some();
        return HealthFinding {
            remedy: Remedy::against(&doubted.first, can_georeference),
            ..of(
                item,
                Health::Bad,
                doubted.share(review),
                doubted.says(review),
            )
        };
    }
    let metadata = review.looked_up().metadata;
    if metadata.telling == 0 {
        let says = "No photo's file says with what it was taken, or no file is there: nothing speaks for the \
                    calibration, nothing against it."
            .to_owned();
        let finding = of(item, Health::Unknown, "none", says);
        return match files_found(review) {
            0 => finding.with(Remedy::AddPhotos),
            _ => finding,
        };
    }
    let says = format!(
        "What {} of {} files that were looked at say of camera and height fits the flight.",
        metadata.telling, metadata.looked_at
    );
    of(item, Health::Good, "fits", says)
}

pub(super) fn poses(review: &Review) -> Option<HealthFinding> {
    only_where_doubted(review, HealthItem::Poses)
}

pub(super) fn files_found(review: &Review) -> usize {
    let is_found = |photo: &PhotoReview<'_>| matches!(photo.file, PhotoFileState::Found { .. });
    review.photos().filter(is_found).count()
}

pub(super) fn photos(review: &Review, stated: &StatedOfFlight<'_>) -> HealthFinding {
    let (found, count) = (files_found(review), review.count());
    let short = format!("{found} of {count}");
    let (health, says) = match found == count && count > 0 {
        true => match doubted(review, HealthItem::Photos) {
            Some(doubted) => (Health::Bad, doubted.says(review)),
            None => {
                let others = stated.without_pose.map(|others| format!(" {others}."));
                let others = others.unwrap_or_default();
                let says = format!("All {count} photo files are there.{others}");
                (Health::Good, says)
            }
        },
        false => (
            Health::Bad,
            match doubted(review, HealthItem::Photos) {
                Some(doubted) if matches!(doubted.first, Doubt::FileUnreadable(_)) => {
                    doubted.says(review)
                }
                _ => format!("The files of {} are there.", share(found, review)),
            },
        ),
    };
    let finding = of(HealthItem::Photos, health, short, says);
    match health {
        Health::Good => finding,
        _ => finding.with(Remedy::AddPhotos),
    }
}

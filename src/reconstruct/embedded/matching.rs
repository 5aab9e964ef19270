//! Pairs of photos: matches of descriptors (ratio of the nearest two, both ways) that one geometry of two
//! views explains (RANSAC, seeded: the same on every run).

use std::path::Path;

use cumulus3d_core::FeatureStore;
use cumulus3d_matching::{MatcherBackend, PairMatchingOptions, match_pairs};

use super::features::keep;
use super::image_id;
use super::nearest_two::Products;
#[cfg(feature = "gpu")]
use super::on_card::OnCard;
use crate::adjusted::failed;
use crate::card::Card;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::photo_set::PhotoSet;

/// Pairs between two looks at the clock and at cancel.
const AT_ONCE: usize = 4;
/// The result is written after so many pairs.
const WRITTEN_EACH: usize = 400;

/// Compares pairs of photos; those that `store` has already are passed over.
///
/// # Errors
/// Where `kept` cannot be written, no pair shows the same, or the work was cancelled.
pub(super) fn compare(
    store: &FeatureStore,
    photos: &PhotoSet,
    pairs: &[[usize; 2]],
    kept: &Path,
    card: Option<&Card>,
    progress: &Progress,
) -> Result<(), Fault> {
    #[cfg(feature = "gpu")]
    let on_card = card.and_then(OnCard::new);
    #[cfg(not(feature = "gpu"))]
    let on_card = card.map(|_| Products);
    let matcher: &dyn MatcherBackend = match &on_card {
        Some(card) => card,
        None => &Products,
    };
    progress.stage(format!("comparing {} pairs of photos", pairs.len()));
    let mut options = PairMatchingOptions::default();
    options.geometry.ransac.random_seed = Some(1);
    let mut unwritten = 0;
    for (done, some) in pairs.chunks(AT_ONCE).enumerate() {
        progress.advance((done * AT_ONCE) as u64, pairs.len() as u64)?;
        let some: Vec<(u32, u32)> = some
            .iter()
            .map(|&[a, b]| (image_id(a), image_id(b)))
            .filter(|&(a, b)| store.num_keypoints(a) > 0 && store.num_keypoints(b) > 0)
            .filter(|&(a, b)| !store.contains_two_view(a, b))
            .collect();
        if some.is_empty() {
            continue;
        }
        match_pairs(store, &some, &options, matcher).map_err(|_| failed("comparing photos"))?;
        unwritten += some.len();
        if unwritten >= WRITTEN_EACH {
            keep(store, kept)?;
            unwritten = 0;
        }
    }
    if unwritten > 0 {
        keep(store, kept)?;
    }
    let least = options.geometry.min_num_inliers;
    let good = store.two_view_geometries();
    if good
        .iter()
        .all(|(_, pair)| pair.inlier_matches.len() < least)
    {
        let what = format!("no two of its {} photos show the same", photos.photos.len());
        let remedy = "take photos that overlap by two thirds";
        return Err(Fault::new(what, remedy));
    }
    Ok(())
}

//! Which of many pairs are worth comparing, where photos do not say where they were taken.
//!
//! The largest features of two photos that overlap match as the others do, and there are few of them (Wu,
//! "Towards Linear-time Incremental Structure from Motion", 2013, section 3): 128 of each photo cost a four
//! thousandth of all 8192. Each photo keeps the partners with which it shares most of them.

use cumulus3d_core::FeatureStore;
use cumulus3d_matching::{MatcherBackend, Top2};
use rayon::prelude::*;

use super::image_id;
use super::nearest_two::{Products, radians};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::photo_set::PhotoSet;

/// Up to so many pairs a photo all are compared: as many as a photo keeps, or not much more.
const COMPARED_ANYWAY: usize = 30;
/// Features of a photo that are looked at, the largest.
const FIRST: usize = 128;
/// Partners that a photo keeps.
const PARTNERS: usize = 24;
/// With fewer common features two photos share nothing: chance makes one now and then.
const FEWEST: usize = 2;
/// The nearest descriptor is at most so much of the angle away that the second is (Lowe 2004, section 7.1).
const RATIO: f64 = 0.8;
/// Pairs between two looks at the clock and at cancel.
const AT_ONCE: usize = 2048;

/// Those of `pairs` that are worth comparing: all where both photos say where they were taken, or where all are
/// few.
///
/// # Errors
/// Where the work was cancelled.
pub(super) fn worth_comparing(
    store: &FeatureStore,
    photos: &PhotoSet,
    pairs: &[[usize; 2]],
    progress: &Progress,
) -> Result<Vec<[usize; 2]>, Fault> {
    let has_place = |photo: usize| (photos.photos.get(photo)).is_some_and(|p| p.place.is_some());
    let (known, blind): (Vec<[usize; 2]>, Vec<_>) = pairs
        .iter()
        .partition(|pair| pair.map(has_place) == [true; 2]);
    let count = photos.photos.len();
    if blind.len() <= COMPARED_ANYWAY * count {
        return Ok(pairs.to_vec());
    }
    progress.stage(format!("choosing among {} pairs of photos", blind.len()));
    let largest: Vec<Vec<u8>> = (0..count).map(|photo| largest(store, photo)).collect();
    let mut shared = vec![Vec::new(); count];
    for (done, some) in blind.chunks(AT_ONCE).enumerate() {
        progress.advance((done * AT_ONCE) as u64, blind.len() as u64)?;
        let counted = some
            .par_iter()
            .map(|&[a, b]| common(&largest[a], &largest[b]));
        for (&[a, b], common) in some.iter().zip(counted.collect::<Vec<_>>()) {
            if common >= FEWEST {
                shared[a].push((common, b));
                shared[b].push((common, a));
            }
        }
    }
    let mut chosen = known;
    for (photo, mut partners) in shared.into_iter().enumerate() {
        partners.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        let kept = partners.iter().take(PARTNERS);
        chosen.extend(kept.map(|&(_, other)| [photo.min(other), photo.max(other)]));
    }
    chosen.sort_unstable();
    chosen.dedup();
    Ok(chosen)
}

/// The descriptors of a photo's largest features, one after the other.
fn largest(store: &FeatureStore, photo: usize) -> Vec<u8> {
    let id = image_id(photo);
    let (Some(points), Some(descriptors)) = (store.keypoints(id), store.descriptors(id)) else {
        return Vec::new();
    };
    let mut sizes: Vec<(f32, usize)> = (points.iter())
        .map(|point| (point.a11 * point.a22 - point.a12 * point.a21).abs())
        .zip(0..descriptors.len())
        .collect();
    sizes.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let first = sizes.iter().take(FIRST);
    first
        .flat_map(|&(_, row)| descriptors.row(row).to_vec())
        .collect()
}

/// How many features two photos have in common: each the other's nearest, and much nearer than the second.
fn common(first: &[u8], second: &[u8]) -> usize {
    const BYTES: usize = 128;
    let (rows, columns) = Products.top2(first, first.len() / BYTES, second, second.len() / BYTES);
    let is_clear = |top: &Top2| radians(top.best) < RATIO * radians(top.second);
    let both = rows.iter().zip(0_u32..).filter(|(top, row)| {
        let back = columns.get(top.idx as usize);
        back.is_some_and(|back| back.idx == *row && is_clear(top) && is_clear(back))
    });
    both.count()
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use cumulus3d_core::{Camera, CameraModelKind, Descriptors, Keypoint};
    use fragscale_core::split_mix::SplitMix;
    use glam::DVec3;

    use super::*;
    use crate::embedded::nearest_two::NORM;
    use crate::photo_set::{Place, SurveyPhoto};

    /// A flight line of 80 photos, each of which shows 40 features of a strip and shares all but 8 with the
    /// next: photos are partners where they share some, and no others are.
    #[test]
    fn neighbours_are_found_without_places() {
        const COUNT: usize = 80;
        let mut random = SplitMix(4);
        let mut descriptor = move || -> [u8; 128] {
            let numbers = [(); 128].map(|()| (random.next() >> 40) as f64 / f64::from(1 << 24));
            let length = numbers.iter().map(|n| n * n * n * n).sum::<f64>().sqrt();
            numbers.map(|n| (n * n / length * NORM) as u8)
        };
        let strip: Vec<[u8; 128]> = (0..COUNT * 8 + 40).map(|_| descriptor()).collect();
        let store = FeatureStore::new();
        let lens = vec![100.0, 50.0, 50.0];
        let camera = Camera::new(1, CameraModelKind::SingleFocalPinhole, 100, 100, lens);
        store.add_camera(camera.unwrap()).unwrap();
        for photo in 0..COUNT {
            let id = image_id(photo);
            store.add_image_with_id(id, &photo.to_string(), 1).unwrap();
            let mut descriptors = Descriptors::new();
            let mut points = Vec::new();
            for (number, its) in strip[photo * 8..photo * 8 + 40].iter().enumerate() {
                descriptors.push(its);
                points.push(Keypoint::new(number as f32, 1.0));
            }
            store.set_keypoints(id, points);
            store.set_descriptors(id, descriptors);
        }
        let set = |place: Option<Place>| PhotoSet {
            warnings: Vec::new(),
            photos: (0..COUNT)
                .map(|number| SurveyPhoto {
                    name: number.to_string(),
                    path: PathBuf::new(),
                    camera: 0,
                    place,
                    gimbal: None,
                })
                .collect(),
            cameras: Vec::new(),
            left_out: Vec::new(),
            origin: DVec3::ZERO,
            count: COUNT,
        };
        let all: Vec<[usize; 2]> = (0..COUNT)
            .flat_map(|a| (a + 1..COUNT).map(move |b| [a, b]))
            .collect();
        let progress = Progress::default();
        let chosen = worth_comparing(&store, &set(None), &all, &progress).unwrap();
        let sharing: Vec<[usize; 2]> = (all.iter().copied()).filter(|[a, b]| b - a <= 4).collect();
        assert_eq!(chosen, sharing);
        // Who says where it was taken has its neighbours already.
        let place = Place {
            center: DVec3::ZERO,
            deviation: None,
        };
        let known = worth_comparing(&store, &set(Some(place)), &all, &progress);
        assert_eq!(known.unwrap(), all);
    }
}

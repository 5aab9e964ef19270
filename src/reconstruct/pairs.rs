//! Which photos are compared with each other. To compare all with all costs the square of their number, and
//! most photos of a survey show nothing in common.
//!
//! A photo that says where it was taken is compared with its nearest neighbours in space and, where the
//! camera looks aslant, with those that look at a place near its own. One that does not may show what any other
//! shows: an engine that has its features may choose among those pairs.

use std::collections::BTreeSet;

use glam::DVec3;

use crate::photo_set::PhotoSet;

/// Neighbours of each photo by where it was taken, and as many by what it looks at. A survey of 80 % overlap
/// along and 70 % across shows a place in about 15 photos.
const NEIGHBOURS: usize = 12;

/// Pairs of places in the set, the lower first, sorted.
pub(crate) fn pairs(set: &PhotoSet) -> Vec<[usize; 2]> {
    let photos = &set.photos;
    let mut pairs = BTreeSet::new();
    let mut add = |a: usize, b: usize| {
        if a != b {
            pairs.insert([a.min(b), a.max(b)]);
        }
    };
    let centers: Vec<Option<DVec3>> = photos
        .iter()
        .map(|photo| photo.place.map(|place| place.center))
        .collect();
    for (photo, center) in centers.iter().enumerate() {
        if center.is_none() {
            (0..photos.len()).for_each(|other| add(photo, other));
        }
    }
    for (a, b) in near(&centers) {
        add(a, b);
    }
    for (a, b) in near(&looked_at(set, &centers)) {
        add(a, b);
    }
    pairs.into_iter().collect()
}

/// Each with its nearest.
fn near(places: &[Option<DVec3>]) -> Vec<(usize, usize)> {
    let known: Vec<(usize, DVec3)> = places
        .iter()
        .enumerate()
        .filter_map(|(number, place)| Some((number, (*place)?)))
        .collect();
    let mut pairs = Vec::new();
    for &(photo, place) in &known {
        let mut others: Vec<(f64, usize)> = known
            .iter()
            .filter(|(other, _)| *other != photo)
            .map(|&(other, at)| (at.distance_squared(place), other))
            .collect();
        // Of a hover, or a receiver that stuck, those that were taken just before and after.
        let between = |other: usize| (other.abs_diff(photo), other);
        others.sort_by(|a, b| {
            let by_place = a.0.total_cmp(&b.0);
            by_place.then_with(|| between(a.1).cmp(&between(b.1)))
        });
        let nearest = others.iter().take(NEIGHBOURS);
        pairs.extend(nearest.map(|&(_, other)| (photo, other)));
    }
    pairs
}

/// Where the cameras look at: on a level so far below the lowest of them as makes their views of it fill
/// the survey. What it is exactly does not matter, for neighbours stay neighbours.
fn looked_at(set: &PhotoSet, centers: &[Option<DVec3>]) -> Vec<Option<DVec3>> {
    let heights = centers.iter().flatten().map(|center| center.z);
    let lowest = heights.clone().fold(f64::INFINITY, f64::min);
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for center in centers.iter().flatten() {
        (min, max) = (min.min(*center), max.max(*center));
    }
    let reach = (max - min).truncate().max_element();
    let level = lowest - 0.5 * reach.max(1.0);
    let photos = set.photos.iter().zip(centers);
    photos
        .map(|(photo, center)| {
            let (looks, center) = (photo.gimbal?.z_axis, (*center)?);
            // Near the horizon it looks at nothing.
            (looks.z < -0.2).then(|| center + looks * ((level - center.z) / looks.z))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use glam::DMat3;

    use super::*;
    use crate::photo_set::{Place, SurveyPhoto};

    fn set(places: &[Option<DVec3>]) -> PhotoSet {
        let photo = |(number, place): (usize, &Option<DVec3>)| SurveyPhoto {
            name: format!("{number}.jpg"),
            path: PathBuf::new(),
            camera: 0,
            place: place.map(|center| Place {
                center,
                deviation: None,
            }),
            gimbal: Some(DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z)),
        };
        PhotoSet {
            warnings: Vec::new(),
            photos: places.iter().enumerate().map(photo).collect(),
            cameras: Vec::new(),
            left_out: Vec::new(),
            origin: DVec3::ZERO,
            count: places.len(),
        }
    }

    /// Of a hover each is compared with those that were taken around it.
    #[test]
    fn photos_of_one_place_are_compared_in_their_order() {
        let pairs = near(&[Some(DVec3::new(3.0, 4.0, 5.0)); 60]);
        assert_eq!(pairs.len(), 60 * NEIGHBOURS);
        assert!(pairs.iter().all(|(a, b)| a != b));
        for photo in 0..59 {
            assert!(pairs.contains(&(photo, photo + 1)) && pairs.contains(&(photo + 1, photo)));
        }
    }

    /// Of a grid each photo is compared with the eight around it, and with few others.
    #[test]
    fn neighbours_are_compared() {
        let places: Vec<Option<DVec3>> = (0..100)
            .map(|at| Some(DVec3::new(f64::from(at % 10), f64::from(at / 10), 30.0)))
            .collect();
        let pairs = pairs(&set(&places));
        assert!(pairs.len() < 100 * NEIGHBOURS, "{}", pairs.len());
        for a in 0..100_usize {
            for b in a + 1..100 {
                let beside = (a % 10).abs_diff(b % 10) <= 1 && (a / 10).abs_diff(b / 10) <= 1;
                if beside {
                    assert!(pairs.contains(&[a, b]), "{a} {b}");
                }
            }
        }
        assert!(pairs.is_sorted() && pairs.iter().all(|[a, b]| a < b));
    }

    /// Without places all are compared with all; one photo without is compared with all others.
    #[test]
    fn without_places_all_are_compared() {
        assert_eq!(pairs(&set(&[None; 6])).len(), 15);
        let mut places: Vec<Option<DVec3>> = (0..40)
            .map(|at| Some(DVec3::new(f64::from(at), 0.0, 30.0)))
            .collect();
        places[7] = None;
        let pairs = pairs(&set(&places));
        assert_eq!(pairs.iter().filter(|pair| pair.contains(&7)).count(), 39);
        assert!(!pairs.contains(&[0, 39]));
    }
}

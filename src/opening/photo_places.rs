//! Where the photos' own receivers were, held against the poses.
//!
//! - A photo that was elsewhere while the others fit theirs: two photos have changed their names. What all are off, by another datum
//!   or a false origin, is not counted. Where hardly any fits, all of them have, or the poses are of another flight.
//! - Their distances: the similarity that brings the poses to the receivers is one of length 1, whatever the world is called, or the
//!   unit or the scale of the model is wrong.

use glam::{DVec2, DVec3};

use crate::flight::{Doubt, Flight, Photo};
use crate::formats::photos::photo_metadata::PhotoMetadata;
use crate::geodesy::{Crs, ecef_from_geographic, enu_axes};
use crate::geometry::median;
use crate::georeference::{Pair, fit};

/// A finding and the photos that it speaks against, by their index.
pub(crate) type Finding = (Doubt, Vec<usize>);

/// A photo with its index and what its file says of itself.
pub(crate) type Described<'a> = (usize, &'a Photo, PhotoMetadata);

/// So many photos say where most are: of two that have changed their names one is off as far as the other, the other way.
const LEAST_PLACES: usize = 3;
/// Receivers of drones are rarely so far off, metres; where the better ones are worse, so many times as far as a quarter of them.
const ELSEWHERE: f64 = 12.0;
/// Where all say that they are sure of their place ([`Pair::SURE_OF_RECEIVERS`]) a drone that moves while its shutter opens is not farther off.
const ELSEWHERE_OF_SURE: f64 = 3.0;
const ELSEWHERE_OF_BETTER: f64 = 8.0;

/// So many positions tell a length: a fit to three leaves two numbers over.
const LEAST_DISTANT: usize = 4;
/// The share of a length from which a sentence is due, and how many times its interval it has to be: receivers err together.
const WORTH_SAYING: f64 = 0.05;
/// The same of receivers that are sure: a map's scale and the height above it are less.
const WORTH_SAYING_OF_SURE: f64 = 0.01;
const OF_INTERVAL: f64 = 1.5;

/// Photos whose receivers were elsewhere than their poses.
pub(crate) fn check_places(flight: &Flight, described: &[Described<'_>]) -> Vec<Finding> {
    let parts = flight.parts();
    let system = parts.as_read.system.as_ref();
    let Some(crs) = system.and_then(|system| Crs::understand(&system.name).ok()) else {
        return Vec::new();
    };
    let metres = parts.unit.metres();
    let off = described.iter().filter_map(|(index, photo, metadata)| {
        let place = crs.from_geographic(metadata.place?.place)?.truncate();
        Some((*index, (place - photo.pose.center.truncate()) * metres))
    });
    let off: Vec<(usize, DVec2)> = off.collect();
    let along = |axis: usize| median(&mut off.iter().map(|(_, off)| off[axis]).collect::<Vec<_>>());
    let (true, Some(x), Some(y)) = (off.len() >= LEAST_PLACES, along(0), along(1)) else {
        return Vec::new();
    };
    let off: Vec<(usize, f64)> = off
        .into_iter()
        .map(|(index, off)| (index, off.distance(DVec2::new(x, y))))
        .collect();
    let mut sorted: Vec<f64> = off.iter().map(|(_, off)| *off).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let better = sorted[(sorted.len() - 1) / 4];
    let elsewhere = match are_sure(described) {
        true => ELSEWHERE_OF_SURE,
        false => ELSEWHERE,
    };
    if better > elsewhere {
        let distance = median(&mut sorted).unwrap_or_default();
        let usual = None;
        let all = (0..parts.photos.len()).collect();
        return vec![(Doubt::OtherPlace { distance, usual }, all)];
    }
    let limit = elsewhere.max(ELSEWHERE_OF_BETTER * better);
    let fitting = sorted.partition_point(|off| *off <= limit);
    let usual = Some(median(&mut sorted[..fitting]).unwrap_or_default());
    let elsewhere = off.into_iter().filter(|(_, off)| *off > limit);
    elsewhere
        .map(|(index, distance)| (Doubt::OtherPlace { distance, usual }, vec![index]))
        .collect()
}

/// Whether the poses are as far apart as the receivers were.
pub(crate) fn check_lengths(flight: &Flight, described: &[Described<'_>]) -> Option<Finding> {
    let parts = flight.parts();
    if !parts.unit_known {
        // No length to compare.
        return None;
    }
    let mut origin = None;
    let pairs = described.iter().filter_map(|(_, photo, metadata)| {
        let measured = metadata.place.filter(|place| place.height.is_some())?;
        let place = ecef_from_geographic(measured.place);
        let (origin, axes) = *origin.get_or_insert((place, enu_axes(measured.place)));
        let stated = measured.deviation.map(Pair::accuracy_of);
        Some(Pair {
            source: photo.pose.center * parts.unit.metres(),
            target: axes.transpose() * (place - origin),
            accuracy: stated
                .filter(|d| *d > 0.0)
                .or(Some(Pair::USUAL_OF_RECEIVERS)),
        })
    });
    let pairs: Vec<Pair> = pairs.collect();
    if pairs.len() < LEAST_DISTANT || is_small(&pairs) {
        return None;
    }
    // On a line, or agreeing in no length: other checks say so.
    let found = fit(&pairs).ok()?;
    let ratio = found.similarity.scale.recip();
    let error = found.scale_interval;
    let worth_saying = match are_sure(described) {
        true => WORTH_SAYING_OF_SURE,
        false => WORTH_SAYING,
    };
    let limit = worth_saying.max(OF_INTERVAL * error);
    ((ratio - 1.0).abs() > limit).then(|| {
        let all = (0..parts.photos.len()).collect();
        (Doubt::OtherLength { ratio, error }, all)
    })
}

/// Whether all that say where they were say it surely.
fn are_sure(described: &[Described<'_>]) -> bool {
    let mut places = described
        .iter()
        .filter_map(|(_, _, metadata)| metadata.place);
    let is_sure = |deviation: DVec3| deviation.max_element() <= Pair::SURE_OF_RECEIVERS;
    places.all(|place| place.deviation.is_some_and(is_sure))
}

/// Whether the receivers were so near each other that their errors are all that they tell, as on a hover.
fn is_small(pairs: &[Pair]) -> bool {
    let middle = pairs.iter().map(|pair| pair.target).sum::<DVec3>() / pairs.len() as f64;
    let usual = Pair::USUAL_OF_RECEIVERS;
    let spread = |pair: &Pair| pair.target.distance(middle) / pair.accuracy.unwrap_or(usual);
    median(&mut pairs.iter().map(spread).collect::<Vec<_>>()).is_none_or(|spread| spread < 3.0)
}

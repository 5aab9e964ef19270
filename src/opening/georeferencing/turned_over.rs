//! A world that the fit turned over: nearly level places fit as well so, which swapped columns do.

use std::collections::HashMap;

use glam::DVec3;

use super::Georeferenced;
use super::marks::MarkedPoint;
use crate::fault::Fault;
use crate::formats::PosedPhoto;
use crate::formats::poses::position_list::PositionList;
use crate::georeference::is_turned_over;

/// What is to be said where all photos lie under all the surveyed points, or, where there are none, all look up.
pub(super) fn turned_over(
    marked: &[MarkedPoint],
    photos: &[PosedPhoto],
    fit: &Georeferenced,
) -> Option<String> {
    from_below(marked, photos, fit).or_else(|| looking_up(photos, fit))
}

/// Why photos' own positions are none that a model can be placed by: it would look the other way than its gimbals did.
pub(super) fn by_receivers(
    photos: &[PosedPhoto],
    list: &PositionList,
    fit: &Georeferenced,
) -> Option<Fault> {
    let own = list.positions.iter();
    let own: HashMap<&str, Option<DVec3>> = own.map(|own| (own.name.as_str(), own.looks)).collect();
    let looks = photos.iter().map(|photo| {
        let found = fit.similarity.rotation * photo.pose.rotation * DVec3::Z;
        (found, own.get(photo.name.as_str()).copied().flatten())
    });
    is_turned_over(looks).then(|| {
        Fault::new(
            "the photos' positions turn the pile over: by them the cameras look the other way than their gimbals said, or at the sky",
            "look whether longitudes or latitudes lack their minus (west, south), are swapped, or heights count downwards",
        )
    })
}

fn from_below(
    marked: &[MarkedPoint],
    photos: &[PosedPhoto],
    fit: &Georeferenced,
) -> Option<String> {
    let height = |place: DVec3| fit.similarity.apply(place).z;
    let surveyed = marked.iter().filter(|point| point.position.is_some());
    let lowest = surveyed
        .map(|point| height(point.found.point))
        .reduce(f64::min)?;
    let highest = photos
        .iter()
        .map(|photo| height(photo.pose.center))
        .reduce(f64::max)?;
    (highest < lowest).then(|| {
        "all photos come to lie under the control points: if they were taken from above, easting and northing are swapped in the list, or its \
         heights count downwards"
            .to_owned()
    })
}

/// How far all photos look above the horizon, a sine: pit walls are photographed upwards, too, but not all of a pile.
const UP: f64 = 0.3;

fn looking_up(photos: &[PosedPhoto], fit: &Georeferenced) -> Option<String> {
    let up = |photo: &PosedPhoto| (fit.similarity.rotation * photo.pose.rotation * DVec3::Z).z;
    let lowest = photos.iter().map(up).reduce(f64::min)?;
    (lowest > UP).then(|| {
        "all photos come to look at the sky: if they were taken from above, easting and northing are swapped in the list, or its heights \
         count downwards"
            .to_owned()
    })
}

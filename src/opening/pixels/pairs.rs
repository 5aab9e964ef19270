//! Which photos of a flight are beside each other: they show the same rock from places far enough apart.

use std::collections::BTreeSet;

use glam::DVec3;

use crate::fault::Fault;
use crate::flight::Flight;
use crate::geometry::median;
use crate::jobs::Progress;
use crate::photo_files::PhotoFile;
use crate::picture::Parallax;
use crate::scale::{FieldGrid, ImageKind};

/// Each photo is compared with so many: one may be of other light, or have its own error.
const EACH: usize = 2;

/// So many of the nearest photos are looked at.
const NEAREST: usize = 16;

/// Photos nearer to each other, as a share of their distance from the rock, show it from one place.
const LEAST_BASE: f64 = 0.05;

/// A photo beside another shows at least so much of what it shows.
const LEAST_SHARE: f64 = 0.15;

/// More parallax, pixels for a percent of the distance, makes nothing surer, and stones look otherwise from there.
const ENOUGH: f64 = 1.5;

/// Where a photo is looked at to know what it shows.
const LOOKS: FieldGrid = FieldGrid {
    columns: 12,
    rows: 9,
};

/// The pairs, the earlier photo first; each once.
pub(super) fn pairs(
    flight: &Flight,
    files: &[PhotoFile],
    progress: &Progress,
) -> Result<Vec<[usize; 2]>, Fault> {
    let parts = flight.parts();
    progress.stage("looking which photos are beside each other");
    let mut shown: Vec<Vec<DVec3>> = Vec::new();
    for (index, (photo, file)) in parts.photos.iter().zip(files).enumerate() {
        progress.advance(index as u64, parts.photos.len() as u64)?;
        let looked = file
            .path
            .is_some()
            .then(|| flight.field(photo, ImageKind::Undistorted, LOOKS, progress));
        // What shows no surface is beside nothing; whether the work was cancelled the next round asks.
        shown.push(
            looked
                .and_then(Result::ok)
                .map(|field| field.points())
                .unwrap_or_default(),
        );
    }
    let mut pairs = BTreeSet::new();
    for (index, points) in shown.iter().enumerate() {
        progress.advance(index as u64, parts.photos.len() as u64)?;
        for other in beside(flight, files, index, points) {
            pairs.insert([index.min(other), index.max(other)]);
        }
    }
    Ok(pairs.into_iter().collect())
}

/// The photos beside one of which these points are known.
fn beside(flight: &Flight, files: &[PhotoFile], index: usize, points: &[DVec3]) -> Vec<usize> {
    let photos = &flight.parts().photos;
    let eye = photos[index].pose.center;
    let mut distances: Vec<f64> = points.iter().map(|point| point.distance(eye)).collect();
    let Some(distance) = median(&mut distances) else {
        return Vec::new();
    };
    let mut others: Vec<(f64, usize)> = photos
        .iter()
        .zip(files)
        .enumerate()
        .filter(|(_, (_, file))| file.path.is_some())
        .map(|(other, (photo, _))| (photo.pose.center.distance(eye), other))
        .filter(|(base, _)| *base > LEAST_BASE * distance)
        .collect();
    if others.len() > NEAREST {
        others.select_nth_unstable_by(NEAREST, |a, b| a.0.total_cmp(&b.0));
        others.truncate(NEAREST);
    }
    let worth = |(_, other): (f64, usize)| {
        let photo = &photos[other];
        let parallax = Parallax::of(points, eye, flight.camera(photo), &photo.pose)?;
        let is_worth = parallax.share >= LEAST_SHARE && parallax.tells();
        is_worth.then(|| {
            (
                parallax.share * parallax.pixels_a_percent.min(ENOUGH),
                other,
            )
        })
    };
    let mut others: Vec<(f64, usize)> = others.into_iter().filter_map(worth).collect();
    // The place in the flight where they are worth the same: the same pairs on every run.
    others.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    others
        .into_iter()
        .take(EACH)
        .map(|(_, other)| other)
        .collect()
}

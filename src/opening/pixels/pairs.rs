//! Which photos of a flight are beside each other: they show the same rock from places far enough apart.

use std::collections::BTreeSet;

use glam::DVec3;

use crate::fault::Fault;
use crate::flight::{Flight, Outcome};
use crate::geometry::median;
use crate::jobs::Progress;
use crate::photo_files::PhotoFile;
use crate::picture::Parallax;
use crate::scale::{Corner, FieldGrid, ImageKind};

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
    outcomes: &[Outcome],
    files: &[PhotoFile],
    progress: &Progress,
) -> Result<Vec<[usize; 2]>, Fault> {
    let parts = flight.parts();
    progress.stage("looking which photos are beside each other");
    let mut shown: Vec<Vec<DVec3>> = Vec::new();
    for (index, (file, outcome)) in files.iter().zip(outcomes).enumerate() {
        progress.advance(index as u64, parts.photos.len() as u64)?;
        shown.push(match (&file.path, between_corners(outcome)) {
            (None, _) => Vec::new(),
            (_, Some(points)) => points,
            // What shows no surface is beside nothing; whether the work was cancelled the next round asks.
            (_, None) => {
                let photo = &parts.photos[index];
                let field = flight.field(photo, ImageKind::Undistorted, LOOKS, progress);
                field.map(|field| field.points()).unwrap_or_default()
            }
        });
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

/// Points between a photo's corners, which the flight knows without another ray; `None` where a corner has none.
fn between_corners(outcome: &Outcome) -> Option<Vec<DVec3>> {
    let corners = outcome.scale()?.corners.each_ref().map(Corner::point);
    let [
        Some(top_left),
        Some(top_right),
        Some(bottom_right),
        Some(bottom_left),
    ] = corners
    else {
        return None;
    };
    let share = |place: u32, count: u32| (f64::from(place) + 0.5) / f64::from(count);
    let point = |(column, row): (u32, u32)| {
        let across = share(column, LOOKS.columns);
        let top = top_left.lerp(top_right, across);
        top.lerp(
            bottom_left.lerp(bottom_right, across),
            share(row, LOOKS.rows),
        )
    };
    Some(LOOKS.cells().map(point).collect())
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

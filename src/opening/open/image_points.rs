//! What a package's own image points say of its photos: whether they are of the size that it solved on, and whether pose, focal
//! length and lens are those that it found. Somebody resized photos, typed a focal length or left a lens away, and no number of the
//! flight shows it.

use glam::DVec2;

use crate::flight::Doubt;
use crate::formats::{ImageUnit, Observation, Origin, Reconstruction, Sizes};
use crate::geometry::median;

/// Fewer say nothing.
const LEAST_POINTS: usize = 20;
/// The share of a camera's points that may lie outside of its photos: features are found up to their edges, and lists of others
/// have wrong ones.
const OUTSIDE: f64 = 0.02;
/// Points of whole flights reach over nearly all of the photos; less than this share of width and height does not happen.
const INSIDE: f64 = 0.7;
/// Distances that are worth a word: parts of the longer side (a percent of scale is a percent of a point's distance from the middle,
/// a third of the side in the mean), and pixels.
const OFF: f64 = 0.003;
const LEAST_OFF: f64 = 2.0;

/// What speaks against single photos; `sizes` is what the package said of them, before they were taken from files.
pub(super) fn doubts(model: &Reconstruction, sizes: Sizes) -> Vec<(usize, Doubt)> {
    let mut doubts = match sizes {
        // Points in parts of the side go with it.
        Sizes::Unknown {
            unit: ImageUnit::LongerSide,
            ..
        } => return Vec::new(),
        Sizes::Unknown {
            unit: ImageUnit::Pixel,
            ..
        } => of_another_size(model),
        Sizes::Known | Sizes::PerhapsReduced => Vec::new(),
    };
    // Of another size points lie off, too.
    let is_new = |(photo, _): &(usize, Doubt)| !doubts.iter().any(|(other, _)| other == photo);
    let off: Vec<(usize, Doubt)> = off_theirs(model).into_iter().filter(is_new).collect();
    doubts.extend(off);
    doubts
}

/// Photos whose file has another size than the photos that the package solved on, where it wrote none.
fn of_another_size(model: &Reconstruction) -> Vec<(usize, Doubt)> {
    let mut of_camera: Vec<Vec<DVec2>> = vec![Vec::new(); model.cameras.len()];
    for seen in &model.observations {
        if let Some((camera, from_middle)) = from_middle(model, seen) {
            of_camera[camera].push(from_middle);
        }
    }
    let all: Vec<DVec2> = of_camera.iter().flatten().copied().collect();
    let is_in_the_middle = all.len() >= LEAST_POINTS && reach(&all).max_element() < INSIDE;
    let reached = |camera: usize| {
        let own = &of_camera[camera];
        let outside = own.iter().filter(|at| at.max_element() > 1.0).count();
        let is_outside = own.len() >= LEAST_POINTS && outside as f64 > OUTSIDE * own.len() as f64;
        match is_outside {
            true => Some(reach(own)),
            false => is_in_the_middle.then(|| reach(&all)),
        }
    };
    let reached: Vec<Option<DVec2>> = (0..model.cameras.len()).map(reached).collect();
    let photos = model.photos.iter().enumerate();
    let doubts = photos.filter_map(|(photo, of)| {
        let reach = (*reached.get(of.camera)?)?;
        let camera = model.cameras.get(of.camera)?;
        let size = (camera.width, camera.height);
        // Casts of floats end at the limits of their type.
        let pixels = |share: f64, side: u32| (share * f64::from(side)).round() as u32;
        let reach = (pixels(reach.x, size.0), pixels(reach.y, size.1));
        Some((photo, Doubt::SolvedOnOther { size, reach }))
    });
    doubts.collect()
}

/// Photos whose points project elsewhere than the package says that they show them. Poses and points are in a frame of lengths.
fn off_theirs(model: &Reconstruction) -> Vec<(usize, Doubt)> {
    // Where the reader had to bend the frame, pixels are not those of the solution.
    if model.solved_reprojection_px.is_some() {
        return Vec::new();
    }
    let mut of_photo: Vec<Vec<f64>> = vec![Vec::new(); model.photos.len()];
    for seen in &model.observations {
        let own = of_photo.get_mut(seen.photo as usize);
        if let (Some(own), Some(off)) = (own, model.reprojection_px(seen)) {
            own.push(off);
        }
    }
    let photos = of_photo.into_iter().enumerate();
    let doubts = photos.filter_map(|(photo, mut off)| {
        let points = off.len();
        let camera = model.cameras.get(model.photos.get(photo)?.camera)?;
        let limit = (OFF * f64::from(camera.width.max(camera.height))).max(LEAST_OFF);
        let pixels = median(&mut off).filter(|pixels| points >= LEAST_POINTS && *pixels > limit)?;
        let doubt = Doubt::OffItsPoints {
            pixels,
            limit,
            points,
        };
        Some((photo, doubt))
    });
    doubts.collect()
}

/// The camera of an image point, and how far that is from the photo's middle along each axis: 1 is its edge.
fn from_middle(model: &Reconstruction, seen: &Observation) -> Option<(usize, DVec2)> {
    let camera = model.photos.get(seen.photo as usize)?.camera;
    let of = model.cameras.get(camera)?;
    let half = DVec2::new(f64::from(of.width), f64::from(of.height)) / 2.0;
    let at = match model.observed_from {
        Origin::Middle => seen.pixel,
        Origin::Corner => seen.pixel - half,
    };
    Some((camera, (at / half).abs()))
}

/// How far nearly all of them reach.
fn reach(points: &[DVec2]) -> DVec2 {
    let of = |along: fn(&DVec2) -> f64| {
        let mut all: Vec<f64> = points.iter().map(along).collect();
        all.sort_unstable_by(f64::total_cmp);
        // As many are wrong as may lie outside.
        let place = (all.len() as f64 * (1.0 - OUTSIDE / 2.0)) as usize;
        all.get(place.min(all.len().saturating_sub(1)))
            .copied()
            .unwrap_or_default()
    };
    DVec2::new(of(|at| at.x), of(|at| at.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::covariance::tests::model;

    const IN_PIXELS: Sizes = Sizes::Unknown {
        unit: ImageUnit::Pixel,
        principal_points_from: Origin::Middle,
    };

    /// The model with points all over its photos, as a package writes them that knows no sizes: from the middle.
    fn from_the_middle() -> Reconstruction {
        let mut model = model();
        model.sizes = Sizes::Known;
        let all_over = (0..400_u32).map(|place| Observation {
            photo: place % 5,
            point: place % 40,
            pixel: DVec2::new(f64::from(place % 20) + 0.5, f64::from(place / 20) + 0.5)
                * DVec2::new(64.0, 36.0),
        });
        model.observations = all_over.collect();
        for seen in &mut model.observations {
            seen.pixel -= DVec2::new(640.0, 360.0);
        }
        model.observed_from = Origin::Middle;
        model
    }

    fn kinds(doubts: &[(usize, Doubt)]) -> Vec<(usize, &'static str)> {
        let kinds = doubts.iter().map(|(photo, doubt)| (*photo, doubt.kind()));
        kinds.collect()
    }

    /// Half as large, or twice: the points of a package that writes no sizes say it.
    #[test]
    fn photos_that_were_resized() {
        let mut model = from_the_middle();
        assert_eq!(of_another_size(&model), Vec::new());
        for (size, is_other) in [
            ((640, 360), true),
            ((2560, 1440), true),
            ((1270, 714), false),
        ] {
            (model.cameras[0].width, model.cameras[0].height) = size;
            let doubts = doubts(&model, IN_PIXELS);
            let of_size = kinds(&doubts)
                .into_iter()
                .filter(|(_, kind)| *kind == "solved-on-other");
            assert_eq!(of_size.count(), if is_other { 5 } else { 0 }, "{size:?}");
            if let (true, (_, Doubt::SolvedOnOther { reach, .. })) = (is_other, &doubts[0]) {
                // 19 of 20 columns lie so far apart.
                assert_eq!(*reach, (1216, 684));
            }
            // It is said once of each photo.
            assert!(doubts.len() <= 5, "{doubts:?}");
        }
        // Who knows its sizes was scaled with them.
        (model.cameras[0].width, model.cameras[0].height) = (640, 360);
        assert!(
            kinds(&doubts(&model, Sizes::Known))
                .iter()
                .all(|(_, kind)| *kind == "off-its-points")
        );
    }

    /// Points that are 0.8 px off are those of the solution; with a focal length that is 3 % longer they are not.
    #[test]
    fn what_was_solved_fits_its_points() {
        let mut model = model();
        model.sizes = Sizes::Known;
        assert_eq!(doubts(&model, Sizes::Known), Vec::new());
        model.cameras[0].fx *= 1.03;
        model.cameras[0].fy *= 1.03;
        let found = doubts(&model, Sizes::Known);
        assert_eq!(found.len(), 5, "{found:?}");
        for (_, doubt) in &found {
            let Doubt::OffItsPoints {
                pixels,
                limit,
                points,
            } = doubt
            else {
                panic!("{doubt:?}");
            };
            assert!((*limit - 3.84).abs() < 1e-9 && *points == 40);
            // 3 % of their distances from the middle.
            assert!((4.0..12.0).contains(pixels), "{pixels}");
        }
        // A few points say nothing, nor those of a frame that the reader bent.
        let mut few = model.clone();
        few.observations.truncate(19);
        assert_eq!(doubts(&few, Sizes::Known), Vec::new());
        model.solved_reprojection_px = Some(0.5);
        assert_eq!(doubts(&model, Sizes::Known), Vec::new());
    }
}

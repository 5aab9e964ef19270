//! How sure the poses and lenses of a model are whose package does not say it: by what its photos see of its points
//! ([`crate::covariance`]). A flight.toml has one value for all photos: their root mean square.

use std::path::Path;

use glam::{DVec2, DVec3};

use super::Georeferenced;
use crate::camera::Pose;
use crate::covariance::{Known, MOST_PHOTOS, deviations, lens_deviations};
use crate::fault::Fault;
use crate::flight::Flight;
use crate::formats::photos::photo_folder::PhotoFolder;
use crate::formats::{FileError, Origin, Reconstruction, read_project};
use crate::geometry::Similarity;
use crate::jobs::Progress;
use crate::numbers::{four_digits, significant_digits, stated_percent};
use crate::photo_files::set_sizes_from_files;
use crate::scale::{PoseErrors, StatedErrors};

/// What lies so many medians off is another point. Of errors of measurement alone none in 10^10 does.
const MOST_MEDIANS: f64 = 6.0;
/// Centres that are moved alike are apart by rounding alone, in parts of how far they spread.
const SAME: f64 = 1e-6;
/// What takes so long.
const STAGE: &str = "how sure the poses are";

/// Of a model that `to_world` brings to the world, in the world's unit; empty where its package states them; or why they
/// are not known, as a sentence. `photos` have the sizes where the package has none.
///
/// # Errors
/// Where it is cancelled.
pub(super) fn of_model(
    model: Reconstruction,
    photos: &PhotoFolder<'_>,
    to_world: &Similarity,
    progress: &Progress,
) -> Result<Result<StatedErrors, String>, Fault> {
    if (model.pose_errors.iter()).any(|stated| stated.errors().is_stated()) {
        return Ok(Ok(StatedErrors::default()));
    }
    progress.stage(STAGE);
    let found = match with_good_matches(model, photos) {
        Ok(model) => of_matches(model, to_world, progress)?,
        Err(why) => Err(why),
    };
    Ok(found.map_err(|why| {
        format!(
            "it is not known how sure the poses and the focal length are: {why}; so intervals do not count it"
        )
    }))
}

/// The model with the sizes of its photos and without wrong matches, or why there is no such thing.
fn with_good_matches(
    mut model: Reconstruction,
    photos: &PhotoFolder<'_>,
) -> Result<Reconstruction, String> {
    if model.observations.is_empty() {
        return Err("the model keeps nothing of what its photos see".to_owned());
    }
    if !model.sizes.are_known() {
        // Which photos are left out for it is said where the flight is opened.
        let mut left_out = Vec::new();
        set_sizes_from_files(&mut model, photos, |_| None, &mut left_out)
            .map_err(|_| "the sizes of its photos are not known (give their folder)".to_owned())?;
    }
    take_off_wrong_matches(&mut model);
    match of_other_photos(&model) {
        Some(why) => Err(why),
        None => Ok(model),
    }
}

/// By the covariance, or why there is none.
fn of_matches(
    mut model: Reconstruction,
    to_world: &Similarity,
    progress: &Progress,
) -> Result<Result<StatedErrors, String>, Fault> {
    model.transform(to_world);
    let photos = model.photos.len();
    let known = Known {
        centers: vec![None; photos],
        // Whether a calibration was given to the package, its files do not say.
        lenses: (model.cameras.iter())
            .map(|camera| lens_deviations(camera, 1.0))
            .collect(),
    };
    let Some(sure) = deviations(&model, &known, progress)? else {
        return Ok(Err(match photos > MOST_PHOTOS {
            true => format!("it has more than {MOST_PHOTOS} photos"),
            false => "its points do not hold its photos together".to_owned(),
        }));
    };
    let root = |squares: DVec3| {
        let mean = (squares / photos as f64).to_array();
        Some(DVec3::from_array(mean.map(|mean| four_digits(mean.sqrt()))))
    };
    let degrees = sure.poses.iter().map(|(_, turn)| turn.map(f64::to_degrees));
    let focal = sure.focal_in_scales.iter().copied().reduce(f64::max);
    Ok(Ok(StatedErrors {
        pose: PoseErrors {
            position: root(sure.poses.iter().map(|(center, _)| center * center).sum()),
            angle: root(degrees.map(|turn| turn * turn).sum()),
        },
        focal: focal
            .filter(|_| model.errors.focal.is_none())
            .map(stated_percent),
        ..StatedErrors::default()
    }))
}

/// From a model to where its named poses were moved; the error is a sentence.
fn to_moved<'a>(
    model: &Reconstruction,
    moved: impl Iterator<Item = (&'a str, Pose)>,
) -> Result<Similarity, String> {
    let both = moved.filter_map(|(name, pose)| {
        let own = model.photos.iter().find(|own| own.name == name)?;
        Some((own.pose, pose))
    });
    let both: Vec<(Pose, Pose)> = both.collect();
    let unknown = || {
        "it is not known how sure the poses are: the flight's are not those of its model".to_owned()
    };
    let (first, last) = both.first().ok_or_else(unknown)?;
    let count = both.len() as f64;
    let middle =
        |center: fn(&(Pose, Pose)) -> DVec3| both.iter().map(center).sum::<DVec3>() / count;
    let [from, to] = [
        middle(|(own, _)| own.center),
        middle(|(_, moved)| moved.center),
    ];
    let far = |square: &dyn Fn(&(Pose, Pose)) -> f64| both.iter().map(square).sum::<f64>().sqrt();
    let [extent, moved] = [
        far(&|(own, _)| own.center.distance_squared(from)),
        far(&|(_, moved)| moved.center.distance_squared(to)),
    ];
    let (scale, rotation) = (moved / extent, last.rotation * first.rotation.transpose());
    let similarity = Similarity::new(scale, rotation, to - rotation * from * scale);
    let off = far(&|(own, moved)| similarity.apply(own.center).distance_squared(moved.center));
    (off <= SAME * moved)
        .then_some(similarity)
        .ok_or_else(unknown)
}

/// Packages keep what lies far off: no error of measurement, but of another point.
fn take_off_wrong_matches(model: &mut Reconstruction) {
    let most = MOST_MEDIANS * model.median_reprojection_px().unwrap_or_default();
    let mut kept = std::mem::take(&mut model.observations);
    kept.retain(|seen| model.reprojection_px(seen).is_some_and(|off| off <= most));
    model.observations = kept;
}

/// That a photo is not the one that the model is of: image points lie beyond it (a few may, by a lens's bend), or it has
/// none.
fn of_other_photos(model: &Reconstruction) -> Option<String> {
    let mut counts = vec![[0, 0]; model.photos.len()];
    for seen in &model.observations {
        let [outside, all] = &mut counts[seen.photo as usize];
        let camera = &model.cameras[model.photos[seen.photo as usize].camera];
        let half = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
        let off = match model.observed_from {
            Origin::Corner => seen.pixel - half,
            Origin::Middle => seen.pixel,
        };
        *outside += usize::from(off.abs().cmpgt(half).any());
        *all += 1;
    }
    let mut photos = model.photos.iter().zip(counts);
    photos.find_map(|(photo, [outside, all])| {
        let name = &photo.name;
        if all == 0 {
            return Some(format!("'{name}' shows none of its points"));
        }
        (10 * outside > all).then(|| {
            format!(
                "the model has image points outside of '{name}', so its photos were of another size"
            )
        })
    })
}

impl Georeferenced {
    /// Looks up its [`errors`](Georeferenced::errors) where it is of a flight whose poses are of this reconstruction, or warns
    /// that they are not known. `photos` have the sizes where the package has none.
    ///
    /// # Errors
    /// Where the reconstruction cannot be read, or it is cancelled.
    pub fn look_up_errors(
        &mut self,
        flight: &Flight,
        reconstruction: &Path,
        photos: Option<&Path>,
        progress: &Progress,
    ) -> Result<(), FileError> {
        progress.stage(format!("reading {}", reconstruction.display()));
        let model = read_project(reconstruction, progress)?.reconstruction;
        let photos = PhotoFolder::new(photos);
        let photos_of_flight = flight.parts().photos.iter();
        let moved = photos_of_flight.map(|photo| (photo.name.as_str(), photo.pose));
        let found = match to_moved(&model, moved) {
            Ok(moved) => of_model(model, &photos, &self.similarity.after(&moved), progress)
                .map_err(|fault| FileError::new(reconstruction, fault))?,
            Err(unknown) => Err(unknown),
        };
        self.take_errors(found);
        Ok(())
    }

    /// What was found of its errors, or why nothing was.
    pub(super) fn take_errors(&mut self, found: Result<StatedErrors, String>) {
        match found {
            Ok(errors) => self.errors = errors,
            Err(unknown) => self.warnings.push(unknown),
        }
    }

    /// Its [`errors`](Georeferenced::errors), as a line; `None` where they are not known.
    pub fn errors_in_words(&self) -> Option<String> {
        let axes = |axes: DVec3| {
            let each = axes.to_array();
            each.map(|value| significant_digits(value, 2)).join(", ")
        };
        let (position, angle) = (self.errors.pose.position?, self.errors.pose.angle?);
        let focal = self.errors.focal.map_or_else(String::new, |focal| {
            format!(
                "; the focal length leaves ± {} % in the scales",
                significant_digits(focal, 2)
            )
        });
        Some(format!(
            "± {} {} along x, y, z to the pile, ± {} degrees about the camera's axes{focal} (standard errors, means of the photos)",
            axes(position),
            self.unit,
            axes(angle),
        ))
    }
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::covariance::tests::{found, model};
    use crate::formats::{Observation, PoseCovariance, Sizes};

    fn of(
        model: Reconstruction,
        photos: Option<&Path>,
        to_world: &Similarity,
    ) -> Result<StatedErrors, String> {
        let photos = PhotoFolder::new(photos);
        of_model(model, &photos, to_world, &Progress::default()).unwrap()
    }

    fn known_sizes() -> Reconstruction {
        Reconstruction {
            sizes: Sizes::Known,
            ..model()
        }
    }

    fn as_large(scale: f64) -> Similarity {
        Similarity::new(scale, DMat3::IDENTITY, DVec3::new(4e5, 5e6, 100.0))
    }

    /// In the world's unit, and what it says of the scales has none.
    #[test]
    fn errors_are_in_the_world() {
        let own = of(known_sizes(), None, &as_large(1.0)).unwrap();
        let world = of(known_sizes(), None, &as_large(2.0)).unwrap();
        let ratio = world.pose.position.unwrap() / own.pose.position.unwrap();
        assert!((ratio - 2.0).abs().max_element() < 2e-3, "{ratio}");
        let ratio = world.pose.angle.unwrap() / own.pose.angle.unwrap();
        assert!((ratio - 1.0).abs().max_element() < 2e-3, "{ratio}");
        assert!((world.focal.unwrap() / own.focal.unwrap() - 1.0).abs() < 2e-3);
        assert_eq!(own.world_scale, None);
        // What the covariance says of each photo, its lens as free as any.
        let lens = [1000.0, 1001.0, 6.4, 6.4, 0.3, 0.3, 0.001, 0.001];
        let known = Known {
            centers: vec![None; 5],
            lenses: vec![lens],
        };
        let each = found(&model(), &known);
        for axis in 0..3 {
            let mean = |square: fn(&(DVec3, DVec3), usize) -> f64| {
                let sum: f64 = each.poses.iter().map(|pose| square(pose, axis)).sum();
                (sum / 5.0).sqrt()
            };
            let position = mean(|pose, axis| pose.0[axis].powi(2));
            let angle = mean(|pose, axis| pose.1[axis].powi(2)) * 57.295_78;
            let stated = own.pose.position.unwrap()[axis] / position;
            assert!((stated - 1.0).abs() < 1e-3, "{stated}");
            let stated = own.pose.angle.unwrap()[axis] / angle;
            assert!((stated - 1.0).abs() < 1e-3, "{stated}");
        }
        let stated = own.focal.unwrap() / (100.0 * each.focal_in_scales[0]);
        assert!((stated - 1.0).abs() < 1e-3, "{stated}");
    }

    /// What a flight was moved by is found; poses of another model were not moved alike.
    #[test]
    fn the_way_of_moved_poses() {
        let rotation = DMat3::from_rotation_z(0.4) * DMat3::from_rotation_x(-2.0);
        let way = Similarity::new(7.0, rotation, DVec3::new(4e5, -6.0, 70.0));
        let mut moved = model();
        moved.transform(&way);
        let of = |model: &Reconstruction| {
            let photos = model.photos.iter().skip(1);
            let poses = photos.map(|photo| (photo.name.clone(), photo.pose));
            poses.collect::<Vec<_>>()
        };
        let way_to = |poses: Vec<(String, Pose)>| {
            let poses = poses.iter().map(|(name, pose)| (name.as_str(), *pose));
            to_moved(&model(), poses)
        };
        let found = way_to(of(&moved)).unwrap();
        assert!((found.scale / 7.0 - 1.0).abs() < 1e-9);
        for point in model().cloud.points {
            assert!(found.apply(point).distance(way.apply(point)) < 1e-7);
        }
        moved.photos[3].pose.center += DVec3::X;
        assert!(
            way_to(of(&moved))
                .unwrap_err()
                .contains("not those of its model")
        );
        assert!(way_to(Vec::new()).is_err());
    }

    /// A wrong match, or what one photo shows alone, changes nothing.
    #[test]
    fn wrong_matches_do_not_count() {
        let right = of(known_sizes(), None, &as_large(2.0)).unwrap();
        let mut more = known_sizes();
        more.cloud.points.push(DVec3::new(1.0, 1.0, 1.0));
        let wrong = |photo, point, pixel| Observation {
            photo,
            point,
            pixel,
        };
        more.observations
            .push(wrong(0, 40, DVec2::new(640.0, 360.0)));
        more.observations.push(wrong(2, 7, DVec2::new(9.0, 700.0)));
        let found = of(more, None, &as_large(2.0)).unwrap();
        // The point that one photo sees has a place among the others for the datum alone.
        let ratio = found.pose.position.unwrap() / right.pose.position.unwrap();
        assert!((ratio - 1.0).abs().max_element() < 0.03, "{ratio}");
    }

    #[test]
    fn what_the_package_states_stays() {
        let mut stated = known_sizes();
        stated.pose_errors = vec![PoseCovariance::default(); 5];
        assert!(
            of(stated.clone(), None, &as_large(2.0))
                .unwrap()
                .focal
                .is_some()
        );
        stated.pose_errors[3] = PoseCovariance::of_deviations(None, Some(DVec3::splat(0.1)));
        let found = of(stated, None, &as_large(2.0)).unwrap();
        assert_eq!(found, StatedErrors::default());
        let mut focal = known_sizes();
        focal.errors.focal = Some(0.2);
        assert_eq!(of(focal, None, &as_large(2.0)).unwrap().focal, None);
    }

    #[test]
    fn what_cannot_be_known_is_said() {
        let nothing = Reconstruction {
            observations: Vec::new(),
            ..known_sizes()
        };
        let said = of(nothing, None, &as_large(2.0)).unwrap_err();
        assert!(
            said.contains("keeps nothing of what its photos see"),
            "{said}"
        );
        let mut half = known_sizes();
        half.cameras[0].width /= 2;
        half.cameras[0].height /= 2;
        let said = of(half, None, &as_large(2.0)).unwrap_err();
        assert!(said.contains("were of another size"), "{said}");
        let mut blind = known_sizes();
        blind.observations.retain(|seen| seen.photo != 3);
        let said = of(blind, None, &as_large(2.0)).unwrap_err();
        assert!(said.contains("'3.jpg' shows none"), "{said}");
        let said = of(model(), None, &as_large(2.0)).unwrap_err();
        assert!(said.contains("sizes of its photos are not known"), "{said}");
    }
}

//! Surveys of a known ground whose photos see points to a tenth of a pixel, and state a focal length that is wrong.

use std::path::PathBuf;

use cumulus3d_core::reconstruction::{Image, Rig, TrackEntry};
use cumulus3d_core::{Camera as EngineCamera, CameraModelKind, Vec2};
use fragscale_core::split_mix::SplitMix;
use glam::{DMat3, DVec2};

use super::*;
use crate::adjusted::model_files;
use crate::camera::Pose;
use crate::formats::read_project;
use crate::georeference::similarity_of;
use crate::opening::covariance::{Deviations, Known, deviations};
use crate::photo_set::{PhotoSet, Place, SurveyCamera, SurveyPhoto, camera_of_tests};

/// The camera's, pixels.
const FOCAL: f64 = 3000.0;
const LENS: [f64; 4] = [-0.02, 0.008, 2e-4, -1e-4];
/// Where photos see points, pixels.
const SEEN_TO: f64 = 0.1;
/// Above the ground, metres.
const HEIGHT: f64 = 60.0;

struct Noise(SplitMix);

impl Noise {
    /// Of deviation 1 within a thousandth: twelve uniform numbers.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.0.unit()).sum::<f64>() - 6.0
    }

    fn vector(&mut self, deviations: DVec3) -> DVec3 {
        DVec3::new(self.normal(), self.normal(), self.normal()) * deviations
    }
}

/// A survey straight down, and what is stated of it.
struct Survey {
    /// Where its photos were taken, of the ground's middle.
    centers: Vec<DVec3>,
    /// What their receivers are off, metres.
    receivers: DVec3,
    /// Of the stated focal length: how far off it is, and how far it is said to be, parts of it.
    stated: (f64, f64),
    /// How many times each photo was zoomed, which its file does not say.
    zooms: Vec<f64>,
    /// How well photos see points, pixels.
    seen_to: f64,
    /// So many of them ten times worse, a part.
    far: f64,
    points: Vec<DVec3>,
    /// Those of the model, in its order.
    of_model: Vec<DVec3>,
    noise: Noise,
}

impl Survey {
    fn new(centers: Vec<DVec3>, stated: (f64, f64), seed: u64) -> Self {
        let mut noise = Noise(SplitMix(seed));
        let mut place = || (noise.0.unit() - 0.5) * 90.0;
        let points = (0..500).map(|_| DVec2::new(place(), place()));
        let points = points.map(|at| at.extend(3.0 * (0.12 * at.x).sin() * (0.1 * at.y).cos()));
        Self {
            zooms: vec![1.0; centers.len()],
            centers,
            receivers: DVec3::new(2.0, 2.0, 5.0),
            stated,
            seen_to: SEEN_TO,
            far: 0.0,
            points: points.collect(),
            of_model: Vec::new(),
            noise,
        }
    }

    fn pose(center: DVec3) -> Pose {
        Pose {
            rotation: DMat3::from_cols(DVec3::X, -DVec3::Y, -DVec3::Z),
            center,
        }
    }

    fn photos(&mut self) -> PhotoSet {
        let focal = FOCAL * (1.0 + self.stated.0);
        let photos = self.centers.iter().enumerate();
        let photos = photos.map(|(number, &center)| SurveyPhoto {
            name: format!("{number:02}.jpg"),
            path: PathBuf::new(),
            camera: 0,
            place: Some(Place {
                center: center + self.noise.vector(self.receivers),
                deviation: Some(self.receivers),
            }),
            gimbal: Some(Self::pose(center).rotation),
        });
        PhotoSet {
            photos: photos.collect(),
            cameras: vec![SurveyCamera {
                camera: camera_of_tests(focal),
                focal_error: Some(self.stated.1),
                is_given: false,
            }],
            left_out: Vec::new(),
            origin: DVec3::ZERO,
            count: self.centers.len(),
            warnings: Vec::new(),
        }
    }

    /// As it has grown: a focal length as stated, without distortion, in a frame a tenth of the world's.
    fn grown(&mut self) -> Reconstruction {
        let mut model = Reconstruction::new();
        let focal = FOCAL * (1.0 + self.stated.0);
        let numbers = |focal: f64, lens: [f64; 4]| {
            let mut numbers = vec![focal, focal, 2000.0, 1500.0];
            numbers.extend(lens);
            EngineCamera::new(1, CameraModelKind::OpenCv, 4000, 3000, numbers).unwrap()
        };
        model.add_camera(numbers(focal, [0.0; 4])).unwrap();
        model.add_rig(Rig::trivial(1)).unwrap();
        let mut tracks = vec![Vec::new(); self.points.len()];
        for (id, &center) in (1..).zip(&self.centers) {
            let of = Self::pose(center);
            let mut pixels = Vec::new();
            let zoom = self.zooms[id as usize - 1];
            let truth = numbers(FOCAL * zoom, LENS);
            for (point, track) in self.points.iter().zip(&mut tracks) {
                let seen = of.camera_from_world(*point);
                let Some(pixel) = truth.cam_to_img(&to_vector(seen)) else {
                    continue;
                };
                let is_far = self.far > 0.0 && self.noise.0.unit() < self.far;
                let seen_to = self.seen_to * if is_far { 10.0 } else { 1.0 };
                let off = self.noise.vector(DVec3::splat(seen_to));
                let pixel = Vec2::new(pixel.x + off.x, pixel.y + off.y);
                if (0.0..4000.0).contains(&pixel.x) && (0.0..3000.0).contains(&pixel.y) {
                    track.push(TrackEntry::new(id, u32::try_from(pixels.len()).unwrap()));
                    pixels.push(pixel);
                }
            }
            // A longer focal length comes with a higher camera.
            let higher = (1.0 + self.stated.0) / zoom - 1.0;
            let center = (center + DVec3::Z * HEIGHT * higher) / 10.0;
            let turn = of.rotation.transpose();
            let pose = cumulus3d_core::Rigid3::new(to_rotation(&turn), to_vector(-(turn * center)));
            let image = Image::new(id, format!("{:02}.jpg", id - 1), 1, pixels);
            model.add_image_own_frame(image, Some(pose)).unwrap();
            model.register_image(id).unwrap();
        }
        for (point, track) in self.points.iter().zip(tracks) {
            if track.len() > 1 {
                model
                    .add_point3d(to_vector(*point / 10.0), track, [0; 3])
                    .unwrap();
                self.of_model.push(*point);
            }
        }
        model
    }

    /// By how much a photo's scale is off, a part of it, beside what the world is too long. A focal length that all have too long comes
    /// with ground that is too deep by as much, and does not count.
    fn scale_off(&self, model: &Reconstruction, image: u32) -> f64 {
        let points = model.points3d();
        let pairs: Vec<(DVec3, DVec3, f64)> = points
            .map(|(id, found)| {
                let truth = self.of_model[usize::try_from(id).unwrap() - 1];
                (point(&found.xyz), truth, 1.0)
            })
            .collect();
        let to_truth = similarity_of(&pairs).unwrap();
        let camera = model.image(image).unwrap().camera_id;
        let focal = model.camera(camera).unwrap().mean_focal();
        let center = point(&model.projection_center(image).unwrap());
        let scale = focal / to_truth.apply(center).z;
        let number = image as usize - 1;
        let right = FOCAL * self.zooms[number] / self.centers[number].z;
        scale / right - 1.0
    }

    /// What came of it: see [`Found`].
    fn found(&mut self) -> Found {
        let photos = self.photos();
        let mut model = self.grown();
        let whose = Whose::of(&model, &photos);
        place(&mut model, &whose, &Progress::default()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        for (name, bytes) in model_files::files(&model, folder.path()).unwrap() {
            std::fs::write(folder.path().join(name), bytes).unwrap();
        }
        let read = read_project(folder.path(), &Progress::default()).unwrap();
        let mut read = read.reconstruction;
        let truth = |id: u64| self.of_model[usize::try_from(id).unwrap() - 1];
        let points = model.points3d();
        let pairs: Vec<(DVec3, DVec3, f64)> = points
            .map(|(id, found)| (point(&found.xyz), truth(id), 1.0))
            .collect();
        let to_truth = similarity_of(&pairs).unwrap();
        read.transform(&to_truth);
        let focal = (read.cameras[0].fx + read.cameras[0].fy) / 2.0;
        let off = read.photos.iter().map(|photo| {
            let number: usize = photo.name[..2].parse().unwrap();
            focal / photo.pose.center.z / (FOCAL / self.centers[number].z) - 1.0
        });
        let off = off.sum::<f64>() / read.photos.len() as f64;
        let stretch = [0, 1].map(|axis| {
            let (mut both, mut own) = (0.0, 0.0);
            for (found, truth, _) in &pairs {
                both += to_truth.apply(*found)[axis] * truth[axis];
                own += truth[axis] * truth[axis];
            }
            both / own
        });
        let known = Known {
            centers: vec![Some(self.receivers); read.photos.len()],
            lenses: vec![photos.cameras[0].expected().1],
        };
        let sure = deviations(&read, &known, &Progress::default());
        Found {
            off,
            stretched: stretch[0] / stretch[1] - 1.0,
            sure: sure.unwrap().unwrap(),
        }
    }
}

/// What the length of the world is off is taken away: that is stated apart.
struct Found {
    /// By how much the photos' scales are off, a part of them, the mean.
    off: f64,
    /// By how much more the world is stretched to the east than to the north.
    stretched: f64,
    sure: Deviations,
}

/// Three by four and one in the middle, that overlap by three quarters, at heights a little apart.
fn thirteen(noise: &mut Noise) -> Vec<DVec3> {
    let grid = (0..12).map(|number| {
        let (column, row) = (f64::from(number % 4) - 1.5, f64::from(number / 4) - 1.0);
        DVec2::new(20.0 * column, 15.0 * row)
    });
    let places = grid.chain([DVec2::ZERO]);
    places
        .map(|at| at.extend(HEIGHT) + noise.vector(DVec3::splat(0.5)))
        .collect()
}

/// Photos straight down, all turned the same way: the hardest, for nothing but the ground's relief tells how long the lens is. Each
/// is off by what is stated, however wrong the stated length is, and its errors hardly differ by that.
#[test]
fn scales_hang_on_a_stated_focal_length_as_little_as_is_said() {
    for (count, errors) in [(13, [-0.1, 0.0, 0.1]), (3, [-0.03, 0.0, 0.03])] {
        for seed in 0..3 {
            let mut centers = thirteen(&mut Noise(SplitMix(seed + 100)));
            if count == 3 {
                centers = vec![centers[5], centers[6], centers[9]];
            }
            let found = errors.map(|error| {
                let stated = (error, f64::abs(error).max(0.02));
                Survey::new(centers.clone(), stated, seed).found()
            });
            for found in &found {
                let (off, said) = (found.off, found.sure.focal_in_scales[0]);
                assert!((found.sure.pixel / SEEN_TO - 1.0).abs() < 0.06);
                assert!(off.abs() < 2.5 * said, "{count}: {off} of {said}");
                assert!(said < 0.0015, "{count}: {said}");
                let stretched = found.stretched;
                assert!(stretched.abs() < 0.002, "{count}: {stretched}");
            }
            let apart = (found[2].off - found[0].off).abs();
            assert!(apart < 0.0006, "{count}: {apart}");
        }
    }
}

/// One photo was zoomed, and says nothing of it: with a lens of its own it does not bend the others, and its focal length is found,
/// whether its receiver is sure or not, and in small blocks.
#[test]
fn a_zoomed_photo_gets_a_lens_of_its_own() {
    let sure = DVec3::splat(0.02);
    let ordinary = DVec3::new(2.0, 2.0, 5.0);
    for (count, receivers, zoom) in [
        (13, sure, 1.0),
        (13, sure, 1.08),
        (13, ordinary, 1.0),
        (13, ordinary, 1.03),
        (6, sure, 1.0),
        (6, sure, 1.03),
        (7, sure, 0.97),
        (7, ordinary, 1.0),
        (7, ordinary, 1.04),
        (6, ordinary, 0.97),
    ] {
        let mut centers = thirteen(&mut Noise(SplitMix(3)));
        centers.retain(|at| match count {
            6 => at.x > 2.0,
            7 => at.x.abs() < 20.0,
            _ => true,
        });
        assert_eq!(centers.len(), count);
        let mut survey = Survey::new(centers, (0.0, 0.02), 3);
        survey.receivers = receivers;
        survey.zooms[5] = zoom;
        let photos = survey.photos();
        let mut model = survey.grown();
        let whose = Whose::of(&model, &photos);
        place(&mut model, &whose, &Progress::default()).unwrap();
        let focal = |image| {
            let camera = model.image(image).unwrap().camera_id;
            model.camera(camera).unwrap().mean_focal()
        };
        assert_eq!(model.cameras().len(), 1 + usize::from(zoom != 1.0));
        let ratio = focal(6) / focal(1) / zoom;
        assert!((ratio - 1.0).abs() < 0.001, "{count} {zoom}: {ratio}");
        let off = [1, 6].map(|image| survey.scale_off(&model, image));
        assert!(
            off.iter().all(|off| off.abs() < 0.001),
            "{count} {zoom}: {off:?}"
        );
    }
}

/// Less than half a percent is what photos of one lens come out apart by, too.
#[test]
fn a_lens_of_its_own_begins_at_half_a_percent() {
    for (zoom, lenses) in [(1.004, 1), (1.006, 2)] {
        let centers = thirteen(&mut Noise(SplitMix(3)));
        let mut survey = Survey::new(centers, (0.0, 0.02), 3);
        survey.receivers = DVec3::splat(0.02);
        survey.zooms[5] = zoom;
        let photos = survey.photos();
        let mut model = survey.grown();
        let whose = Whose::of(&model, &photos);
        place(&mut model, &whose, &Progress::default()).unwrap();
        assert_eq!(model.cameras().len(), lenses, "{zoom}");
    }
}

/// A photo at the rim that sees little stands out among lengths that agree to a thousandth, and was not zoomed.
#[test]
fn a_photo_at_the_rim_keeps_the_lens_of_all() {
    for seed in 3..7 {
        let mut centers = thirteen(&mut Noise(SplitMix(seed)));
        centers.push(DVec3::new(68.0, 48.0, HEIGHT));
        let mut survey = Survey::new(centers, (0.0, 0.02), seed);
        survey.seen_to = 0.3;
        let photos = survey.photos();
        let mut model = survey.grown();
        let whose = Whose::of(&model, &photos);
        place(&mut model, &whose, &Progress::default()).unwrap();
        assert_eq!(model.cameras().len(), 1, "{seed}");
    }
}

/// Frames of a stabilised film: each is cropped otherwise, and no length is that of most.
#[test]
fn photos_that_are_all_cropped_otherwise_have_their_own() {
    for receivers in [DVec3::splat(0.02), DVec3::new(2.0, 2.0, 5.0)] {
        let centers = thirteen(&mut Noise(SplitMix(3)));
        let mut survey = Survey::new(centers, (0.0, 0.02), 3);
        survey.receivers = receivers;
        for (number, zoom) in survey.zooms.iter_mut().enumerate() {
            *zoom = 1.0 + 0.003 * ((number * 7) % 13) as f64;
        }
        let photos = survey.photos();
        let mut model = survey.grown();
        let whose = Whose::of(&model, &photos);
        place(&mut model, &whose, &Progress::default()).unwrap();
        let off: Vec<f64> = (1..=13)
            .map(|image| survey.scale_off(&model, image))
            .collect();
        assert!(off.iter().all(|off| off.abs() < 0.002), "{off:?}");
    }
}

/// A receiver that is sure of a place two metres too high is not believed, and whatever lens its photo gets, its scale is right.
#[test]
fn a_receiver_that_is_wrong_and_sure_does_no_harm() {
    let centers = thirteen(&mut Noise(SplitMix(3)));
    let mut survey = Survey::new(centers, (0.0, 0.02), 3);
    survey.receivers = DVec3::splat(0.02);
    let mut photos = survey.photos();
    photos.photos[5].place.as_mut().unwrap().center.z += 2.0;
    let mut model = survey.grown();
    let whose = Whose::of(&model, &photos);
    place(&mut model, &whose, &Progress::default()).unwrap();
    let off = [1, 6].map(|image| survey.scale_off(&model, image));
    assert!(off.iter().all(|off| off.abs() < 0.001), "{off:?}");
}

/// Six photos with so few points that focal lengths come out apart by themselves: the one that was zoomed makes receivers fit, and
/// of the same photos without it none has a lens of its own.
#[test]
fn where_no_length_stands_out_the_farthest_has_to_fit_better() {
    for zoom in [1.0, 1.035] {
        let mut centers = thirteen(&mut Noise(SplitMix(3)));
        centers.retain(|at| at.x > 2.0);
        let mut survey = Survey::new(centers, (0.0, 0.02), 3);
        survey.points.truncate(60);
        survey.seen_to = 1.0;
        survey.receivers = DVec3::splat(0.02);
        survey.zooms[4] = zoom;
        let photos = survey.photos();
        let mut model = survey.grown();
        let whose = Whose::of(&model, &photos);
        place(&mut model, &whose, &Progress::default()).unwrap();
        assert_eq!(model.cameras().len(), 1 + usize::from(zoom != 1.0));
    }
}

/// A fifth of the points that are seen ten times worse leave the ways cameras look nearly as sure as none does; weighed alike they
/// would make them 4.5 times less so (the root of 0.8 and 0.2 times 100).
#[test]
fn points_that_are_seen_badly_do_little_harm() {
    let off = |far: f64| -> f64 {
        let of_seed = |seed: u64| {
            let centers = thirteen(&mut Noise(SplitMix(seed + 50)));
            let mut survey = Survey::new(centers, (0.0, 0.02), seed);
            survey.receivers = DVec3::splat(0.02);
            survey.far = far;
            let photos = survey.photos();
            let mut model = survey.grown();
            let whose = Whose::of(&model, &photos);
            place(&mut model, &whose, &Progress::default()).unwrap();
            let images = model.registered_images();
            let off = images.iter().map(|&image| {
                let looks = pose(&model.world_to_cam(image).unwrap()).rotation * DVec3::Z;
                looks.truncate().length_squared()
            });
            off.sum::<f64>() / images.len() as f64
        };
        (0..4).map(of_seed).sum::<f64>().sqrt()
    };
    let (none, far) = (off(0.0), off(0.2));
    assert!(far < 1.6 * none, "{none} {far}");
}

/// Positions whose longitudes lack their minus: the mirror would be looked at from behind, and is not.
#[test]
fn a_mirrored_world_is_not_taken() {
    let centers = thirteen(&mut Noise(SplitMix(7)));
    let mut survey = Survey::new(centers, (0.0, 0.02), 7);
    survey.receivers = DVec3::splat(0.02);
    let mut photos = survey.photos();
    for photo in &mut photos.photos {
        photo.place.as_mut().unwrap().center.x *= -1.0;
    }
    let mut model = survey.grown();
    let whose = Whose::of(&model, &photos);
    place(&mut model, &whose, &Progress::default()).unwrap();
    for image in model.registered_images() {
        let looks = pose(&model.world_to_cam(image).unwrap()).rotation * DVec3::Z;
        assert!(looks.z < -0.99, "{looks}");
    }
    // In its own frame, a tenth of the world.
    let center = |image| point(&model.projection_center(image).unwrap());
    let apart = center(1).distance(center(4)) / survey.centers[0].distance(survey.centers[3]);
    assert!((apart * 10.0 - 1.0).abs() < 0.02, "{apart}");
}

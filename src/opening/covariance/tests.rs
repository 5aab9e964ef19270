use super::*;
use crate::camera::VisualSfm;
use crate::formats::PosedPhoto;
use crate::geometry::Similarity;
use crate::surface::Cloud;
use fragscale_core::split_mix::SplitMix;

/// What is found of a model that says enough.
pub(crate) fn found(model: &Reconstruction, known: &Known) -> Deviations {
    deviations(model, known, &Progress::default())
        .unwrap()
        .unwrap()
}

/// Five photos of 40 points, seen 0.8 px off.
pub(crate) fn model() -> Reconstruction {
    let mut random = SplitMix(5);
    let mut uniform = move || random.unit() - 0.5;
    let lens = Brown::new([-0.05, 0.02, 1e-3, -5e-4, 0.0, 0.0, 0.0, 0.0]);
    let camera = Camera {
        name: "c".to_owned(),
        width: 1280,
        height: 720,
        fx: 1000.0,
        fy: 1001.0,
        cx: 640.0,
        cy: 360.0,
        skew: 0.0,
        distortion: Distortion::Brown(lens),
    };
    let photos = (0..5).map(|number| {
        let center = DVec3::new(
            f64::from(number) * 4.0 - 8.0,
            uniform() * 6.0,
            30.0 + uniform(),
        );
        let pose = Pose::from_tilt_pan(center, [80.0 + 10.0 * uniform(), 90.0 * f64::from(number)]);
        PosedPhoto {
            name: format!("{number}.jpg"),
            camera: 0,
            pose,
        }
    });
    let photos: Vec<PosedPhoto> = photos.collect();
    let points: Vec<DVec3> = (0..40)
        .map(|_| DVec3::new(uniform() * 16.0, uniform() * 10.0, uniform() * 4.0))
        .collect();
    let mut observations = Vec::new();
    for (photo, posed) in (0..).zip(&photos) {
        for (point, &at) in (0..).zip(&points) {
            let pixel = camera.pixel_as_shot(posed.pose.camera_from_world(at));
            // Off by a known length: that is what the deviation is found from.
            let off = DVec2::from_angle(uniform() * 6.0) * 0.8;
            observations.extend(pixel.map(|pixel| Observation {
                photo,
                point,
                pixel: pixel + off,
            }));
        }
    }
    Reconstruction {
        cameras: vec![camera],
        photos,
        cloud: Cloud {
            points,
            ..Cloud::default()
        },
        observations,
        ..Reconstruction::default()
    }
}

/// What the whole matrix gives, points and all, with derivatives by moving each number.
#[test]
fn deviations_are_those_of_the_whole_matrix() {
    let model = model();
    let lens = [30.0, 30.03, 6.4, 6.4, 1.0, 1.0, 0.01, 0.01_f64];
    let known = Known {
        centers: vec![Some(DVec3::new(0.02, 0.02, 0.04)); 5],
        lenses: vec![lens],
    };
    let found = found(&model, &known);
    let (photos, points) = (model.photos.len(), model.cloud.points.len());
    let count = photos * 6 + 8 + points * 3;
    let pixels = |moved: Option<(usize, f64)>| -> Vec<DVec2> {
        let mut model = model.clone();
        let axis = |at: usize| DVec3::AXES[at % 3];
        match moved {
            Some((at, step)) if at < photos * 6 => {
                let pose = &mut model.photos[at / 6].pose;
                if at % 6 < 3 {
                    pose.rotation *= DMat3::from_axis_angle(axis(at % 6), step);
                } else {
                    pose.center += axis(at % 6) * step;
                }
            }
            Some((at, step)) if at < photos * 6 + 8 => {
                model.cameras[0] = changed(&model.cameras[0], at - photos * 6, step);
            }
            Some((at, step)) => {
                let at = at - photos * 6 - 8;
                model.cloud.points[at / 3] += axis(at) * step;
            }
            None => {}
        }
        let seen = model.observations.iter().map(|seen| {
            let (camera, pose, point) = of(&model, seen);
            camera.pixel_as_shot(pose.camera_from_world(point)).unwrap()
        });
        seen.collect()
    };
    let rows = model.observations.len() * 2;
    let mut jacobian = DMatrix::<f64>::zeros(rows, count);
    for at in 0..count {
        let step = 1e-5;
        let (ahead, behind) = (pixels(Some((at, step))), pixels(Some((at, -step))));
        for (row, (a, b)) in ahead.iter().zip(&behind).enumerate() {
            jacobian[(2 * row, at)] = (a.x - b.x) / (2.0 * step);
            jacobian[(2 * row + 1, at)] = (a.y - b.y) / (2.0 * step);
        }
    }
    let mut normal = jacobian.tr_mul(&jacobian) / found.pixel.powi(2);
    for photo in 0..photos {
        for (axis, deviation) in [0.02_f64, 0.02, 0.04].into_iter().enumerate() {
            let at = photo * 6 + 3 + axis;
            normal[(at, at)] += deviation.powi(-2);
        }
    }
    for (place, deviation) in lens.into_iter().enumerate() {
        let at = photos * 6 + place;
        normal[(at, at)] += deviation.powi(-2);
    }
    let world = normal.try_inverse().unwrap();
    // What the points' shifts, each by how sure it is, say of a similarity is taken off of all.
    let lens_at = photos * 6;
    let middle = model.cloud.points.iter().sum::<DVec3>() / points as f64;
    let similarity = |at: usize, by: usize| match (at, by) {
        (_, 0..3) => DVec3::AXES[by],
        (_, 3..6) => DVec3::AXES[by - 3].cross(position(&model, at) - middle),
        _ => position(&model, at) - middle,
    };
    let mut alike = DMatrix::<f64>::zeros(count, 7);
    for by in 0..7 {
        for photo in 0..photos {
            for axis in 0..3 {
                alike[(photo * 6 + 3 + axis, by)] = similarity(photo, by)[axis];
                if let Some(turn) = by.checked_sub(3).filter(|turn| *turn < 3) {
                    let axes = model.photos[photo].pose.rotation;
                    alike[(photo * 6 + axis, by)] = axes.col(axis)[turn];
                }
            }
        }
        for point in 0..points {
            for axis in 0..3 {
                alike[(lens_at + 8 + point * 3 + axis, by)] = similarity(photos + point, by)[axis];
            }
        }
    }
    let mut weights = DMatrix::<f64>::zeros(count, count);
    for point in 0..points {
        let at = lens_at + 8 + point * 3;
        let own = jacobian.columns(at, 3);
        let weight = (own.transpose() * own)
            .try_inverse()
            .unwrap()
            .trace()
            .recip();
        for axis in 0..3 {
            weights[(at + axis, at + axis)] = weight;
        }
    }
    let fit = (alike.transpose() * &weights * &alike)
        .try_inverse()
        .unwrap()
        * alike.transpose()
        * &weights;
    let off = DMatrix::identity(count, count) - &alike * fit;
    let covariance = &off * world * off.transpose();
    let mut left = 0.0;
    for (photo, (center, turn)) in found.poses.iter().enumerate() {
        // Given the lens: the inverse of the pose's part of the inverse.
        let own = (photo * 6..photo * 6 + 6).chain(lens_at..lens_at + 8);
        let own: Vec<usize> = own.collect();
        let with_lens = covariance.select_rows(&own).select_columns(&own);
        let given = with_lens.clone().try_inverse().unwrap();
        let given = given
            .view((0, 0), (6, 6))
            .into_owned()
            .try_inverse()
            .unwrap();
        for axis in 0..3 {
            for (part, at) in [(turn[axis], axis), (center[axis], axis + 3)] {
                let expected = given[(at, at)].sqrt();
                assert!((part / expected - 1.0).abs() < 1e-4, "{part} {expected}");
            }
        }
        // Of the logarithm of focal length over depth: all there is, less what there is for a given lens.
        let pose = &model.photos[photo].pose;
        let seen = model
            .observations
            .iter()
            .filter(|seen| seen.photo as usize == photo);
        let depths: Vec<f64> = seen
            .map(|seen| {
                pose.camera_from_world(model.cloud.points[seen.point as usize])
                    .z
            })
            .collect();
        let depth = depths.iter().sum::<f64>() / depths.len() as f64;
        let mut by = DMatrix::<f64>::zeros(14, 1);
        for axis in 0..3 {
            by[(3 + axis, 0)] = pose.rotation.z_axis[axis] / depth;
        }
        let own = by.rows(0, 6);
        let given = (own.transpose() * given * own)[(0, 0)];
        by[(6, 0)] = 2001.0_f64.recip();
        by[(7, 0)] = 2001.0_f64.recip();
        left += (by.transpose() * with_lens * &by)[(0, 0)] - given;
    }
    let expected = (left / photos as f64).sqrt();
    let part = found.focal_in_scales[0];
    assert!((part / expected - 1.0).abs() < 1e-4, "{part} {expected}");
    // Photos from above: a longer lens means a greater height, and the scales stay.
    assert!(part < 0.3 * found.focal[0], "{part} {}", found.focal[0]);
    // All residuals are 0.8 px long.
    let free = rows - photos * 6 - points * 3;
    let expected = (0.64 * model.observations.len() as f64 / free as f64).sqrt();
    assert!((found.pixel - expected).abs() < 1e-9, "{}", found.pixel);
    let lens = lens_at;
    let both = covariance[(lens, lens)]
        + covariance[(lens + 1, lens + 1)]
        + 2.0 * covariance[(lens, lens + 1)];
    let expected = both.sqrt() / 2001.0;
    assert!((found.focal[0] / expected - 1.0).abs() < 1e-4, "{expected}");
    assert!(found.focal[0] < 0.03);
}

/// The centre of a photo, or the point behind the photos.
fn position(model: &Reconstruction, at: usize) -> DVec3 {
    match at.checked_sub(model.photos.len()) {
        None => model.photos[at].pose.center,
        Some(point) => model.cloud.points[point],
    }
}

/// Receivers that are off by metres, or none at all, leave the cameras where they are to the pile.
#[test]
fn where_the_world_is_does_not_matter() {
    let model = model();
    let of = |center: Option<DVec3>| {
        let known = Known {
            centers: vec![center; 5],
            lenses: vec![[30.0, 30.03, 6.4, 6.4, 1.0, 1.0, 0.01, 0.01]],
        };
        found(&model, &known)
    };
    let [metres, none] = [of(Some(DVec3::new(3.0, 3.0, 8.0))), of(None)];
    for ((center, turn), (other, other_turn)) in metres.poses.iter().zip(&none.poses) {
        // 30 units from the pile, with 40 points that are off by a pixel.
        assert!(center.z < 0.1 && center.max_element() < 0.3, "{center}");
        assert!(turn.max_element() < 0.01, "{turn}");
        assert!(
            (center.length() / other.length() - 1.0).abs() < 0.02,
            "{other}"
        );
        assert!(
            (turn.length() / other_turn.length() - 1.0).abs() < 0.02,
            "{other_turn}"
        );
    }
}

/// A model that nobody has placed is as sure of itself wherever and however large it is: its matrix has seven directions
/// that nothing holds, and held too loosely, an inverse was there or not by the last digit.
#[test]
fn a_free_model_is_as_sure_anywhere() {
    let lens = [1000.0, 1001.0, 6.4, 6.4, 0.3, 0.3, 0.001, 0.001];
    let known = Known {
        centers: vec![None; 5],
        lenses: vec![lens],
    };
    let here = found(&model(), &known);
    let mut random = SplitMix(8);
    let mut uniform = move || random.unit();
    for _ in 0..60 {
        let scale = 10.0_f64.powf(uniform() * 6.0 - 3.0);
        let turn = DMat3::from_rotation_z(6.0 * uniform()) * DMat3::from_rotation_x(uniform());
        let shift = DVec3::new(5e5 * uniform(), 5e6 * uniform(), 1e3 * uniform());
        // As far away as digits of so small a model allow.
        let shift = shift * scale.min(1.0);
        let mut there = model();
        there.transform(&Similarity::new(scale, turn, shift));
        let there = found(&there, &known);
        let focal = there.focal_in_scales[0] / here.focal_in_scales[0];
        assert!((focal - 1.0).abs() < 1e-3, "{scale}: {focal}");
        for ((center, turn), (own, own_turn)) in there.poses.iter().zip(&here.poses) {
            let center = center.length() / (scale * own.length());
            let turn = turn.length() / own_turn.length();
            assert!(
                (center - 1.0).abs() < 1e-3 && (turn - 1.0).abs() < 1e-3,
                "{scale}: {center} {turn}"
            );
        }
    }
}

/// A lens of another model that bends nothing is off by Brown's terms as a pinhole is, whose derivatives are differences.
#[test]
fn lenses_of_other_models_are_off_by_the_same_terms() {
    let pinhole = Camera {
        distortion: Distortion::None,
        ..model().cameras[0].clone()
    };
    let other = Camera {
        distortion: Distortion::VisualSfm(VisualSfm { k: 0.0 }),
        ..pinhole.clone()
    };
    for at in [DVec3::new(9.0, -7.0, 30.0), DVec3::new(-2.0, -8.0, 25.0)] {
        let (differences, terms) = (by_lens(&pinhole, at).unwrap(), by_lens(&other, at).unwrap());
        for (difference, term) in differences.into_iter().zip(terms) {
            let off = difference.distance(term) / term.length().max(1.0);
            assert!(off < 1e-6, "{difference} {term}");
        }
    }
}

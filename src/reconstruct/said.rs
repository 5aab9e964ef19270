//! What is said of photos before a reconstruction and of the flight after it: the same words in the window
//! and on the command line.

use crate::Reconstructed;
use crate::fault::first_names;
use crate::geometry::median;
use crate::photo_set::{LeftOut, PhotoSet, SurveyCamera};

/// What came out, a line each: where it lies, how much of the photos is in it, which world.
pub fn summary(made: &Reconstructed) -> Vec<String> {
    let mut lines = facts(made);
    if let Some(first) = lines.first_mut() {
        *first = format!("{}: {first}", made.flight.display());
    }
    lines
}

/// The same without the flight's name, for what lies beside it.
pub(crate) fn facts(made: &Reconstructed) -> Vec<String> {
    let mut text = format!(
        "{} of {} photos, {} points",
        made.registered, made.photos, made.points
    );
    if let Some(px) = made.reprojection_px {
        text += &format!(", median reprojection error {px:.2} px");
    }
    let mut lines = vec![text];
    if let Some(dense) = &made.dense {
        let mut text = format!("dense cloud: {} points", dense.count);
        if let Some(world) = &made.world {
            let deviation = rounded(dense.deviation);
            text += &format!(
                ", each to {deviation} {} along the view (standard deviation)",
                world.unit
            );
        }
        lines.push(text);
    }
    lines.extend(made.computed_on.clone());
    if let Some(world) = &made.world {
        let crs = world.crs.as_deref().unwrap_or("local");
        let mut text = format!("world: {crs}, in {}", world.unit);
        if let Some(rms) = world.rms {
            text += &format!("; photos' own positions fit to {rms:.3} {}", world.unit);
        }
        lines.push(text);
    }
    lines
}

/// Of photos that are left out a sentence a reason.
pub fn left_out(photos: &[LeftOut], all: usize) -> Vec<String> {
    let mut reasons: Vec<(&str, Vec<String>)> = Vec::new();
    for LeftOut { photo, why } in photos {
        match reasons.iter_mut().find(|(reason, _)| reason == why) {
            Some((_, names)) => names.push(photo.clone()),
            None => reasons.push((why, vec![photo.clone()])),
        }
    }
    let sentence = |(why, names): (&str, Vec<String>)| {
        let count = names.len();
        format!(
            "{count} of {all} photos left out: {why} ({})",
            first_names(&names)
        )
    };
    reasons.into_iter().map(sentence).collect()
}

/// What was found in a folder of photos, a line each: how many there are, whose cameras took them, from
/// where.
pub fn found(set: &PhotoSet) -> Vec<String> {
    let mut lines = vec![match set.photos.len() {
        some if some == set.count => format!("{some} photos"),
        some => format!("{some} of {} photos can be read", set.count),
    }];
    for (number, camera) in set.cameras.iter().enumerate() {
        let its = set.photos.iter().filter(|photo| photo.camera == number);
        lines.push(camera_in_words(camera, its.count()));
    }
    lines.push(places_in_words(set));
    lines
}

fn camera_in_words(its: &SurveyCamera, photos: usize) -> String {
    let camera = &its.camera;
    let focal = match its.focal_error {
        _ if its.is_given => format!("calibration given and kept, {:.1} px", camera.fx),
        Some(error) => format!(
            "focal length stated, {:.0} px ± {} %",
            camera.fx,
            rounded(error * 100.0)
        ),
        None => "focal length not stated: it is found from the photos".to_owned(),
    };
    format!(
        "{photos} by {}, {} x {} px; {focal}",
        camera.name, camera.width, camera.height
    )
}

fn places_in_words(set: &PhotoSet) -> String {
    let all = set.photos.len();
    let places: Vec<_> = set.photos.iter().filter_map(|photo| photo.place).collect();
    if places.is_empty() {
        return "no photo says where it was taken: the flight has no unit until it is georeferenced"
            .to_owned();
    }
    let mut text = format!("{} of {all} say where they were taken", places.len());
    // Half of the photos are as good or better.
    let known: Vec<_> = places.iter().filter_map(|place| place.deviation).collect();
    let mut level: Vec<f64> = known.iter().map(|of| of.x.max(of.y)).collect();
    let mut up: Vec<f64> = known.iter().map(|of| of.z).collect();
    match (median(&mut level), median(&mut up)) {
        (Some(level), Some(up)) => {
            let (level, up) = (rounded(level), rounded(up));
            text += &format!(", to {level} m level and {up} m up (standard deviations)");
            if known.len() < places.len() {
                text += &format!("; {} do not say how well", places.len() - known.len());
            }
        }
        _ => text += ", but not how well",
    }
    text
}

/// Two digits that count, without zeros at the end.
fn rounded(number: f64) -> String {
    let text = crate::numbers::significant_digits(number, 2);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use glam::DVec3;

    use super::*;
    use crate::camera::Camera;
    use crate::photo_set::{Place, SurveyPhoto, camera_of_tests};

    fn camera(name: &str, focal_error: Option<f64>) -> SurveyCamera {
        SurveyCamera {
            camera: Camera {
                name: name.to_owned(),
                ..camera_of_tests(3000.4)
            },
            focal_error,
            is_given: false,
        }
    }

    fn photo(camera: usize, place: Option<Option<DVec3>>) -> SurveyPhoto {
        SurveyPhoto {
            name: "a.jpg".to_owned(),
            path: PathBuf::new(),
            camera,
            place: place.map(|deviation| Place {
                center: DVec3::ZERO,
                deviation,
            }),
            gimbal: None,
        }
    }

    #[test]
    fn cameras_and_places_are_said() {
        let rtk = Some(Some(DVec3::new(0.015, 0.012, 0.025)));
        let mut set = PhotoSet {
            warnings: Vec::new(),
            photos: vec![
                photo(0, rtk),
                photo(0, rtk),
                photo(0, Some(None)),
                photo(1, None),
            ],
            cameras: vec![camera("DJI FC6310R", Some(0.01)), camera("camera", None)],
            left_out: Vec::new(),
            origin: DVec3::ZERO,
            count: 5,
        };
        assert_eq!(
            found(&set),
            [
                "4 of 5 photos can be read",
                "3 by DJI FC6310R, 4000 x 3000 px; focal length stated, 3000 px ± 1 %",
                "1 by camera, 4000 x 3000 px; focal length not stated: it is found from the photos",
                "3 of 4 say where they were taken, to 0.015 m level and 0.025 m up (standard \
                 deviations); 1 do not say how well",
            ]
        );
        set.photos = vec![photo(0, Some(None))];
        assert!(
            found(&set)
                .iter()
                .any(|line| line.ends_with("but not how well"))
        );
        set.photos = vec![photo(0, None)];
        assert!(
            found(&set)
                .iter()
                .any(|line| line.contains("no unit until"))
        );
    }

    #[test]
    fn reasons_are_said_once() {
        let out = |photo: &str, why: &str| LeftOut {
            photo: photo.to_owned(),
            why: why.to_owned(),
        };
        let all = [out("a", "dark"), out("b", "blurred"), out("c", "dark")];
        assert_eq!(
            left_out(&all, 9),
            [
                "2 of 9 photos left out: dark (a, c)",
                "1 of 9 photos left out: blurred (b)"
            ]
        );
    }
}

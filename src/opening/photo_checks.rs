//! A careful engineer's checks: what the photo files say about themselves against what the flight
//! says about them. Each finding is a doubt with its numbers and the photos that it speaks against;
//! none is an error, because metadata err as well.
//!
//! - The camera: photos of two devices under one calibration, a calibration named after another
//!   model, a focal length over 5 % (or what the metadata's own error allows) from the metadata's.
//! - The height: cameras above the surface below them against RelativeAltitude, which counts from the
//!   take-off. A deviation over 5 % is said where the take-off would lie outside the levels of the
//!   surface: a drone that rises from a quarry's floor is less high above the pile. Of flights below 10 m so is one over 2 m.
//! - The distance: to the surface in the middle of the photo against the drone's laser.
//! - The places: see [`crate::photo_places`].
//!
//! Only the headers of the files are read, of [`MOST_PHOTOS`] photos at most.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};

use crate::flight::{Doubt, Flight, MetadataRead};
use crate::formats::photos::photo_metadata::{self, PhotoMetadata};
use crate::geometry::{Ray, median};
use crate::photo_files::PhotoFile;
use crate::photo_places::{Described, Finding, check_lengths, check_places};

/// How many photos are looked at, evenly over the flight.
const MOST_PHOTOS: usize = 200;

/// The deviation from which a sentence is due.
const WORTH_SAYING: f64 = 0.05;

/// The lowest flight, in metres, whose heights are compared to 5 %: below it the barometer's own error is beyond that ...
const LOWEST: f64 = 10.0;
/// ... and what is off by so many metres is said, four times that error: a model of ten times its size. In the hand a drone says
/// less than it stands high.
const OFF_IN_LOW: f64 = 2.0;

/// Compares a flight with its photo files, which are in the order of its photos.
pub(crate) fn photo_checks(flight: &Flight, files: &[PhotoFile]) -> (Vec<Finding>, MetadataRead) {
    let photos = &flight.parts().photos;
    let step = photos.len().div_ceil(MOST_PHOTOS).max(1);
    let described: Vec<Described<'_>> = photos
        .iter()
        .zip(files)
        .enumerate()
        .step_by(step)
        .filter_map(|(index, (photo, file))| {
            let metadata = photo_metadata::read_file(file.path.as_deref()?).ok()?;
            Some((index, photo, metadata))
        })
        .collect();
    let tells = |m: &PhotoMetadata| m.model.is_some() || !m.focal.is_empty();
    let metadata = MetadataRead {
        looked_at: described.len(),
        telling: described.iter().filter(|(.., m)| tells(m)).count(),
        turned: described.iter().filter(|(.., m)| m.shown > 1).count(),
    };
    let mut findings = check_cameras(flight, &described);
    if described.is_empty() {
        return (findings, metadata);
    }
    findings.extend(check_distances(flight, &described));
    findings.extend(check_places(flight, &described));
    findings.extend(check_lengths(flight, &described));
    (findings, metadata)
}

fn check_cameras(flight: &Flight, described: &[Described<'_>]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let parts = flight.parts();
    for (index, camera) in parts.cameras.iter().enumerate() {
        let of_camera = described
            .iter()
            .filter(|(_, photo, _)| photo.camera == index)
            .map(|(.., metadata)| metadata);
        // All of its photos: those between the ones looked at are no better.
        let mut found = |doubt: Doubt| {
            let photos = parts.photos.iter().enumerate();
            let its = photos.filter(|(_, photo)| photo.camera == index);
            findings.push((doubt, its.map(|(photo, _)| photo).collect()));
        };
        let name = match camera.name.as_str() {
            "" => "the camera".to_owned(),
            name => format!("camera '{name}'"),
        };
        if let Some(why) = camera.strange() {
            found(Doubt::StrangeCamera {
                camera: name.clone(),
                why,
            });
        }
        let devices: BTreeSet<(String, String)> = of_camera
            .clone()
            .filter_map(|m| Some((m.make.clone().unwrap_or_default(), m.model.clone()?)))
            .collect();
        if devices.len() > 1 {
            found(Doubt::SeveralDevices {
                camera: name.clone(),
                devices: devices.into_iter().map(|(_, model)| model).collect(),
            });
        } else if let Some((make, model)) = devices.first()
            && is_named_otherwise(&camera.name, make, model)
        {
            found(Doubt::OtherDevice {
                camera: name.clone(),
                device: format!("{make} {model}"),
            });
        }
        let same_size = of_camera.filter(|m| m.size == (camera.width, camera.height));
        if let Some(of_film) = zoomed(camera.fx, same_size.clone()) {
            found(Doubt::FocalLength {
                camera: name.clone(),
                focal: camera.fx,
                ratio: camera.fx / of_film.fx,
                source: of_film.source.in_words(),
                error: of_film.relative_error,
            });
            continue;
        }
        let stated = same_size.filter_map(|m| m.focal.first());
        let mut ratios: Vec<f64> = stated.clone().map(|stated| camera.fx / stated.fx).collect();
        let (Some(ratio), Some(stated)) = (median(&mut ratios), stated.clone().next()) else {
            continue;
        };
        if photo_metadata::is_another_focal(ratio, stated.relative_error) {
            found(Doubt::FocalLength {
                camera: name,
                focal: camera.fx,
                ratio,
                source: stated.source.in_words(),
                error: stated.relative_error,
            });
        }
    }
    findings
}

/// The share from which a 35 mm equivalent contradicts a focal length that the photo states better elsewhere: sensors that are counted
/// across their diagonal or their width differ by less, digital zooms by more.
const ZOOMED: f64 = 0.25;

/// The 35 mm equivalent of most of these photos, where it is so far from the camera's focal length: a digital zoom cuts the middle
/// out of the sensor, and makers leave the lens's calibration in the file as it was.
fn zoomed<'a>(
    fx: f64,
    photos: impl Iterator<Item = &'a PhotoMetadata>,
) -> Option<photo_metadata::FocalCandidate> {
    let of_film = photos.flat_map(|photo| &photo.focal);
    let of_film: Vec<_> = of_film
        .filter(|stated| stated.source == photo_metadata::FocalSource::FilmEquivalent)
        .collect();
    let ratio = median(
        &mut of_film
            .iter()
            .map(|stated| fx / stated.fx)
            .collect::<Vec<_>>(),
    )?;
    let is_other = !(1.0 / (1.0 + ZOOMED)..=1.0 + ZOOMED).contains(&ratio);
    of_film.first().filter(|_| is_other).map(|stated| **stated)
}

/// Whether a calibration's name has the maker's name in it, but not the model's.
fn is_named_otherwise(name: &str, make: &str, model: &str) -> bool {
    let (name, make, model) = (
        name.to_lowercase(),
        make.to_lowercase(),
        model.to_lowercase(),
    );
    let make = make.split_whitespace().next().unwrap_or_default();
    let model = model.strip_prefix(make).unwrap_or(&model).trim();
    !make.is_empty() && !model.is_empty() && name.contains(make) && !name.contains(model)
}

fn check_distances(flight: &Flight, described: &[Described<'_>]) -> Vec<Finding> {
    let parts = flight.parts();
    let metres = parts.unit.metres();
    let mut findings = Vec::new();
    if !parts.unit_known {
        // No length to compare.
        return findings;
    }
    // A surface that cannot be met says so when scales are asked of it.
    let Ok(mut caster) = parts.surface.caster_for(described.len()) else {
        return findings;
    };
    let all: Vec<usize> = (0..parts.photos.len()).collect();
    let mut distance = |origin: DVec3, direction: DVec3| {
        let direction = direction.normalize();
        caster
            .cast(&Ray { origin, direction })
            .map(|hit| hit.t * metres)
    };
    let (mut above, mut ahead, mut take_offs) = (Vec::new(), Vec::new(), Vec::new());
    for (_, photo, metadata) in described {
        let pose = &photo.pose;
        if let Some(stated) = metadata.relative_altitude.filter(|&h| h > OFF_IN_LOW)
            && let Some(height) = distance(pose.center, DVec3::NEG_Z)
        {
            above.push((height, stated));
            take_offs.push(pose.center.z - stated / metres);
        }
        if let Some(stated) = metadata.laser_range {
            let camera = flight.camera(photo);
            let middle = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
            let direction = pose.rotation * camera.direction_undistorted(middle);
            if let Some(range) = distance(pose.center, direction) {
                ahead.push((range, stated));
            }
        }
    }
    let slack = |stated: f64| match stated < LOWEST {
        true => OFF_IN_LOW,
        false => WORTH_SAYING * stated,
    };
    if let Some((above, stated)) = deviation(&above)
        && (above - stated).abs() > slack(stated)
        && !has_level(flight, &take_offs, slack(stated) / metres)
    {
        findings.push((Doubt::FlyingHeight { above, stated }, all.clone()));
    }
    if let Some((distance, stated)) = deviation(&ahead) {
        findings.push((Doubt::LaserRange { distance, stated }, all));
    }
    findings
}

/// Whether the surface has the median of these levels, give or take `slack`; all in world units.
fn has_level(flight: &Flight, levels: &[f64], slack: f64) -> bool {
    match (
        median(&mut levels.to_vec()),
        flight.parts().surface.usual_heights(),
    ) {
        (Some(level), Some([low, high])) => (low - slack..=high + slack).contains(&level),
        _ => false,
    }
}

/// The medians of what is and of what is stated; `None` where the median part by which they deviate is
/// not worth saying.
fn deviation(pairs: &[(f64, f64)]) -> Option<(f64, f64)> {
    let of =
        |value: fn(&(f64, f64)) -> f64| median(&mut pairs.iter().map(value).collect::<Vec<f64>>());
    let part = of(|(is, stated)| is / stated)? - 1.0;
    let (is, stated) = (of(|pair| pair.0)?, of(|pair| pair.1)?);
    (part.abs() > WORTH_SAYING).then_some((is, stated))
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;
    use std::sync::Arc;

    use exif::Tag;

    use super::*;
    use crate::camera::{Camera, Distortion, Pose};
    use crate::flight::{FlightParts, Photo, PhotoFileState};
    use crate::scale::{Ground, ImageKind};
    use crate::surface::{Cloud, Surface};
    use crate::units::LengthUnit;
    use fragscale_test_data::jpeg::{jpeg, packet, short, text};

    /// A camera 50 m above a level square, straight down; 24 mm on 43.27 mm of film at 5000 px.
    fn flight(name: &str, fx: f64, unit: LengthUnit) -> Flight {
        let corner = |x, y| DVec3::new(x, y, 0.0);
        let points = vec![
            corner(-100.0, -100.0),
            corner(100.0, -100.0),
            corner(-100.0, 100.0),
            corner(100.0, 100.0),
        ];
        let cloud = Cloud {
            points,
            ..Cloud::default()
        };
        let photo = |name: &str| Photo {
            name: name.to_owned(),
            camera: 0,
            pose: Pose::from_tilt_pan(DVec3::new(1.0, 2.0, 50.0), [90.0, 0.0]),
            errors: Default::default(),
            package_errors: Default::default(),
            trouble: None,
        };
        Flight::new(FlightParts {
            name: "test".to_owned(),
            unit,
            unit_known: true,
            ground: Ground::Auto,
            image: ImageKind::Undistorted,
            pair: Default::default(),
            errors: Default::default(),
            package_errors: Default::default(),
            surface: Arc::new(Surface::new(cloud).unwrap()),
            cameras: vec![Camera {
                name: name.to_owned(),
                width: 4000,
                height: 3000,
                fx,
                fy: fx,
                cx: 2000.0,
                cy: 1500.0,
                skew: 0.0,
                distortion: Distortion::None,
            }],
            as_read: Default::default(),
            photos: vec![photo("a.jpg"), photo("b.jpg")],
        })
        .unwrap()
    }

    fn files(folder: &Path, models: [&str; 2], altitude: f64, range: f64) -> Vec<PhotoFile> {
        let mut files = Vec::new();
        for (name, model) in ["a.jpg", "b.jpg"].into_iter().zip(models) {
            let path = folder.join(name);
            let exif = [
                text(Tag::Make, "DJI"),
                text(Tag::Model, model),
                short(Tag::FocalLengthIn35mmFilm, 24),
            ];
            let xmp = packet(&format!(
                r#"<rdf:Description drone-dji:RelativeAltitude="{altitude:+}" drone-dji:LRFTargetDistance="{range}"/>"#
            ));
            fs::write(&path, jpeg((4000, 3000), &exif, &[&xmp])).unwrap();
            files.push(PhotoFile {
                path: Some(path),
                state: PhotoFileState::Found {
                    width: 4000,
                    height: 3000,
                },
                ..PhotoFile::default()
            });
        }
        files
    }

    /// A camera that no lens has speaks against all its photos, where no file can be read, too.
    #[test]
    fn a_strange_camera_needs_no_file() {
        let mut parts = flight("c", 5000.0, LengthUnit::Metre).parts().clone();
        let found = |parts: &FlightParts| {
            let files = [PhotoFile::default(), PhotoFile::default()];
            photo_checks(&Flight::new(parts.clone()).unwrap(), &files).0
        };
        assert_eq!(found(&parts), Vec::new());
        (parts.cameras[0].cx, parts.cameras[0].cy) = (-2.75, 1.75);
        let against = found(&parts);
        assert_eq!(against.len(), 1);
        let (doubt, photos) = &against[0];
        assert_eq!((doubt.kind(), &photos[..]), ("strange-camera", &[0, 1][..]));
    }

    /// A zoom of 2 by cutting the middle out: the lens's calibration in the file is as it was, the 35 mm equivalent is not.
    #[test]
    fn a_digital_zoom_is_doubted() {
        let folder = tempfile::tempdir().unwrap();
        let film = 24.0 / 1872.0_f64.sqrt() * 5000.0;
        let found = |millimetres: u16| {
            let exif = [
                text(Tag::Make, "DJI"),
                text(Tag::Model, "FC1"),
                short(Tag::FocalLengthIn35mmFilm, millimetres),
            ];
            let xmp = packet(&format!(
                r#"<rdf:Description drone-dji:CalibratedFocalLength="{film}" drone-dji:CalibratedOpticalCenterX="2000" drone-dji:CalibratedOpticalCenterY="1500"/>"#
            ));
            let mut files = files(folder.path(), ["FC1"; 2], 50.0, 50.0);
            for file in &mut files {
                fs::write(
                    file.path.as_ref().unwrap(),
                    jpeg((4000, 3000), &exif, &[&xmp]),
                )
                .unwrap();
            }
            photo_checks(&flight("DJI FC1", film, LengthUnit::Metre), &files).0
        };
        assert_eq!(found(24), []);
        let [(Doubt::FocalLength { ratio, .. }, photos)] = &found(48)[..] else {
            panic!("{:?}", found(48));
        };
        assert_eq!(
            (format!("{ratio:.3}"), &photos[..]),
            ("0.500".to_owned(), &[0, 1][..])
        );
    }

    #[test]
    fn contradictions_are_said_with_their_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let film = 24.0 / 1872.0_f64.sqrt() * 5000.0;
        let check = |flight: &Flight, models, altitude, range| {
            let (found, read) =
                photo_checks(flight, &files(folder.path(), models, altitude, range));
            assert_eq!((read.looked_at, read.telling), (2, 2));
            // Each of these speaks against all of its two photos.
            assert!(found.iter().all(|(_, photos)| *photos == [0, 1]));
            found
                .iter()
                .map(|(doubt, _)| doubt.to_string())
                .collect::<Vec<_>>()
        };
        let good = flight("DJI FC1", film, LengthUnit::Metre);
        assert_eq!(check(&good, ["FC1"; 2], 50.0, 50.0), [""; 0]);
        // Within 5 %, and within the 5.1 % that 24 mm may be off.
        let near = flight("", film * 1.045, LengthUnit::Metre);
        assert_eq!(check(&near, ["FC1"; 2], 48.0, 52.0), [""; 0]);
        // Half a metre, which a barometer does not tell from one and a half.
        let low = flight("DJI FC1", film, LengthUnit::Centimetre);
        assert_eq!(check(&low, ["FC1"; 2], 1.5, 0.5), [""; 0]);
        for (flight, models, altitude, range, words) in [
            (
                flight("", film * 1.1, LengthUnit::Metre),
                ["FC1"; 2],
                50.0,
                50.0,
                "+10.0 % from the 2773.5 px",
            ),
            (
                flight("v2 dji fc9", film, LengthUnit::Metre),
                ["FC1"; 2],
                50.0,
                50.0,
                "taken with a DJI FC1",
            ),
            (
                flight("DJI FC1", film, LengthUnit::Metre),
                ["FC1", "FC2"],
                50.0,
                50.0,
                "2 devices (FC1, FC2)",
            ),
            (
                flight("DJI FC1", film, LengthUnit::Metre),
                ["FC1"; 2],
                40.0,
                50.0,
                "50.0 m above the surface below them, but their photos say 40.0 m above the take-off (+25.0 %)",
            ),
            (
                flight("DJI FC1", film, LengthUnit::Metre),
                ["FC1"; 2],
                50.0,
                62.5,
                "50.0 m away, but the drone's laser measured 62.5 m (-20.0 %)",
            ),
            // A model of ten times its size, flown low.
            (
                flight("DJI FC1", film, LengthUnit::Metre),
                ["FC1"; 2],
                4.84,
                50.0,
                "their photos say 4.8 m above the take-off",
            ),
            // Feet: 15.24 m.
            (
                flight("DJI FC1", film, LengthUnit::Foot),
                ["FC1"; 2],
                15.24,
                30.48,
                "15.2 m away, but the drone's laser measured 30.5 m (-50.0 %)",
            ),
        ] {
            let warnings = check(&flight, models, altitude, range);
            assert_eq!(warnings.len(), 1, "{warnings:?}");
            assert!(warnings[0].contains(words), "{words}: {warnings:?}");
        }
        // The pile under the cameras is 10 m high, and the drone rose from its foot: 40 m above the
        // surface, 50 m above the take-off.
        let on_pile = {
            let mut points: Vec<DVec3> = good.parts().surface.vertices().collect();
            for x in -9..=9 {
                points.push(DVec3::new(f64::from(x), 0.0, 10.0));
                points.push(DVec3::new(f64::from(x), 4.0, 10.0));
            }
            let cloud = Cloud {
                points,
                ..Cloud::default()
            };
            let parts = FlightParts {
                pair: Default::default(),
                errors: Default::default(),
                package_errors: Default::default(),
                surface: Arc::new(Surface::new(cloud).unwrap()),
                ..good.parts().clone()
            };
            Flight::new(parts).unwrap()
        };
        assert_eq!(check(&on_pile, ["FC1"; 2], 50.0, 40.0), [""; 0]);
        // Below 10 m a barometer's metre is not said, 2.5 are.
        let low = |z: f64| {
            let mut parts = good.parts().clone();
            for photo in &mut parts.photos {
                photo.pose.center.z = z;
            }
            Flight::new(parts).unwrap()
        };
        assert_eq!(check(&low(5.5), ["FC1"; 2], 4.0, 5.5), [""; 0]);
        let said = check(&low(6.5), ["FC1"; 2], 4.0, 6.5);
        assert!(
            said.len() == 1 && said[0].contains("4.0 m above the take-off"),
            "{said:?}"
        );
        // Files that are not there are not spoken of here.
        assert_eq!(
            photo_checks(&good, &[PhotoFile::default(), PhotoFile::default()]).0,
            []
        );
    }
}

//! About how long a reconstruction takes: rates measured on simulated surveys (docs/reconstruct.md has the runs; a core of an
//! AMD EPYC, release build), spread over this computer's cores. It is a plan for the coffee, not a promise: rock
//! with little texture takes half, a slow disk more.

use std::thread;

use crate::pairs::pairs;
use crate::photo_set::PhotoSet;
use crate::quality::Quality;

/// Processor-seconds of features, a megapixel; larger photos are looked at in 8 megapixels at most.
const FEATURES: f64 = 1.2;
const MOST_LOOKED_AT: f64 = 8.0;
/// Of comparing two photos of a megapixel; of larger ones it grows with the square of their features, which
/// are kept to 8192.
const PAIR: f64 = 0.25;
const MOST_PAIR: f64 = 0.6;
/// Of placing and adjusting, a photo.
const PLACING: f64 = 0.7;
/// Of depths, a megapixel.
const DEPTHS: f64 = 12.0;

/// Processor-seconds of these photos at this quality.
pub fn processor_seconds(set: &PhotoSet, quality: Quality) -> f64 {
    let megapixels = set.photos.iter().map(|photo| {
        let camera = &set.cameras[photo.camera].camera;
        f64::from(camera.width) * f64::from(camera.height) / 1e6
    });
    let megapixels: Vec<f64> = megapixels.collect();
    let count = megapixels.len() as f64;
    let looked_at = megapixels.iter().map(|size| size.min(MOST_LOOKED_AT));
    let mean = megapixels.iter().sum::<f64>() / count.max(1.0);
    let compared = pairs(set).len() as f64 * (PAIR * mean).clamp(PAIR / 2.0, MOST_PAIR);
    let sparse = FEATURES * looked_at.sum::<f64>() + compared + PLACING * count;
    let dense = quality.dense().map_or(0.0, |dense| {
        let most = dense.most_pixels as f64 / 1e6;
        // Halved until they fit.
        let halved = |size: f64| size / 4_f64.powf((size / most).log(4.0).ceil().max(0.0));
        DEPTHS * megapixels.into_iter().map(halved).sum::<f64>()
    });
    sparse + dense
}

/// The same as time on this computer, in words: "about 6 minutes".
pub fn about(set: &PhotoSet, quality: Quality) -> String {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    in_words(processor_seconds(set, quality), cores)
}

fn in_words(seconds: f64, cores: usize) -> String {
    // A tenth of the work does not spread over cores.
    let minutes = seconds * (0.1 + 0.9 / cores as f64) / 60.0;
    match minutes {
        ..1.0 => "less than a minute".to_owned(),
        ..1.5 => "about a minute".to_owned(),
        ..90.0 => format!("about {minutes:.0} minutes"),
        _ => format!("about {:.0} hours", minutes / 60.0),
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use glam::DVec3;

    use super::*;
    use crate::camera::{Camera, Distortion};
    use crate::photo_set::{Place, SurveyCamera, SurveyPhoto};

    fn survey(count: usize, size: (u32, u32)) -> PhotoSet {
        let photo = |number: usize| SurveyPhoto {
            name: number.to_string(),
            path: PathBuf::new(),
            camera: 0,
            place: Some(Place {
                center: DVec3::new((number % 6) as f64, (number / 6) as f64, 0.0),
                deviation: None,
            }),
            gimbal: None,
        };
        let camera = Camera {
            name: String::new(),
            width: size.0,
            height: size.1,
            fx: 1.0,
            fy: 1.0,
            cx: 0.0,
            cy: 0.0,
            skew: 0.0,
            distortion: Distortion::None,
        };
        PhotoSet {
            warnings: Vec::new(),
            photos: (0..count).map(photo).collect(),
            cameras: vec![SurveyCamera {
                camera,
                focal_error: None,
                is_given: false,
            }],
            left_out: Vec::new(),
            origin: DVec3::ZERO,
            count,
        }
    }

    /// Measured: 39 photos of 1280 x 720 took 141 processor-seconds to the sparse cloud and 602 to the dense one; 40 of 4096 x 3072,
    /// whose depths are found in a sixteenth of their pixels, 18 processor-minutes.
    #[test]
    fn a_measured_run_is_estimated() {
        let set = survey(39, (1280, 720));
        let (fast, normal) = (
            processor_seconds(&set, Quality::Fast),
            processor_seconds(&set, Quality::Normal),
        );
        assert!((fast / 141.0 - 1.0).abs() < 0.25, "{fast}");
        assert!((normal / 602.0 - 1.0).abs() < 0.25, "{normal}");
        let larger = processor_seconds(&survey(40, (4096, 3072)), Quality::Normal);
        assert!((larger / 1080.0 - 1.0).abs() < 0.25, "{larger}");
        // 12 megapixels are halved to 3.
        let large = survey(39, (4000, 3000));
        let depths =
            |quality| processor_seconds(&large, quality) - processor_seconds(&large, Quality::Fast);
        assert!((depths(Quality::Best) / depths(Quality::Normal) - 4.0).abs() < 1e-9);
    }

    #[test]
    fn times_are_round() {
        for (seconds, cores, words) in [
            (60.0, 2, "less than a minute"),
            (80.0, 1, "about a minute"),
            (3600.0, 4, "about 20 minutes"),
            (36_000.0, 2, "about 6 hours"),
        ] {
            assert_eq!(in_words(seconds, cores), words);
        }
    }
}

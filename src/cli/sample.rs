//! `fragscale sample`: a simulated flight whose every answer is known.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::Answer;
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::sample::{self, DrawnErrors, Lens, PoseNoise, Preset, Receiver, SampleOptions};

#[derive(Debug, Args)]
pub(super) struct SampleArguments {
    /// The folder to make; new or empty.
    folder: PathBuf,
    /// Which place: the paper's lab, a muckpile in UTM coordinates, a stockpile, a bench face.
    #[arg(long, value_enum, default_value = "lab")]
    preset: SamplePreset,
    /// Everything random follows from this number.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The camera's lens.
    #[arg(long, value_enum, default_value = "brown")]
    lens: SampleLens,
    /// The surface: a cloud as structure from motion gives it, or the true mesh.
    #[arg(long, value_enum, default_value = "cloud")]
    surface: SampleSurface,
    /// Matching noise of the cloud, in pixels (standard deviation).
    #[arg(long, value_name = "PIXELS", value_parser = noise)]
    noise: Option<f64>,
    /// How many points the cloud has.
    #[arg(long, value_name = "COUNT")]
    points: Option<usize>,
    /// Add this many overlapping photos on a ring around the pile.
    #[arg(long, value_name = "COUNT", default_value_t = 0)]
    ring: u32,
    /// Add the overlapping photos of a mapping flight, and let all photos say where they were taken, as
    /// such a receiver does: for `fragscale reconstruct`. About a hundred photos, some seconds each; outdoors alone (muckpile,
    /// stockpile, bench).
    #[arg(long, value_enum, value_name = "RECEIVER")]
    survey: Option<SampleReceiver>,
    /// Leave out the photos and their label images.
    #[arg(long)]
    no_photos: bool,
    /// Leave out the label images, which say which fragment each pixel shows.
    #[arg(long)]
    no_labels: bool,
    /// Put the middle of the pile at the world's origin, without a coordinate system.
    #[arg(long)]
    at_origin: bool,
    /// Draw errors into the written poses, of these standard deviations: of positions in metres along
    /// each axis, of rotations in degrees about each camera axis.
    #[arg(long, value_name = "POSITION,ANGLE", value_parser = pose_noise, allow_hyphen_values = true)]
    pose_noise: Option<PoseNoise>,
    /// Draw an error into the written focal length, of this standard deviation.
    #[arg(long, value_name = "PERCENT", value_parser = percent, allow_hyphen_values = true)]
    lens_noise: Option<f64>,
    /// Draw an error into all written lengths of the world, of this standard deviation.
    #[arg(long, value_name = "PERCENT", value_parser = percent, allow_hyphen_values = true)]
    world_noise: Option<f64>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum SamplePreset {
    Lab,
    Muckpile,
    Stockpile,
    Bench,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum SampleReceiver {
    /// Metres.
    Gps,
    /// Centimetres.
    Rtk,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum SampleLens {
    None,
    Brown,
    Fisheye,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum SampleSurface {
    Cloud,
    Mesh,
}

fn noise(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|e| format!("{e}"))?;
    if (0.0..=100.0).contains(&number) {
        return Ok(number);
    }
    Err("give 0 to 100 pixels".to_owned())
}

/// A number from 0 to the most that makes sense.
fn within(text: &str, most: f64, unit: &str) -> Result<f64, String> {
    let number: Option<f64> = text.trim().parse().ok();
    number
        .filter(|number| (0.0..=most).contains(number))
        // Minus nothing is nothing.
        .map(f64::abs)
        .ok_or_else(|| format!("'{text}' is not a number from 0 to {most} {unit}"))
}

fn percent(text: &str) -> Result<f64, String> {
    within(text, 50.0, "percent")
}

fn pose_noise(text: &str) -> Result<PoseNoise, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let [position, angle] = parts.as_slice() else {
        return Err("give two numbers with a comma between them: metres, degrees".to_owned());
    };
    Ok(PoseNoise {
        position: within(position, 1000.0, "m")?,
        angle: within(angle, 45.0, "degrees")?,
    })
}

/// `fragscale sample`.
pub(super) fn sample(arguments: &SampleArguments, progress: &Progress) -> Result<Answer, String> {
    let options = SampleOptions {
        preset: match arguments.preset {
            SamplePreset::Lab => Preset::Lab,
            SamplePreset::Muckpile => Preset::Muckpile,
            SamplePreset::Stockpile => Preset::Stockpile,
            SamplePreset::Bench => Preset::Bench,
        },
        seed: arguments.seed,
        lens: match arguments.lens {
            SampleLens::None => Lens::None,
            SampleLens::Brown => Lens::Brown,
            SampleLens::Fisheye => Lens::Fisheye,
        },
        true_mesh: arguments.surface == SampleSurface::Mesh,
        noise_px: arguments.noise,
        points: arguments.points,
        ring: arguments.ring,
        survey: arguments.survey.map(|receiver| match receiver {
            SampleReceiver::Gps => Receiver::Gps,
            SampleReceiver::Rtk => Receiver::Rtk,
        }),
        photos: !arguments.no_photos,
        labels: !arguments.no_labels,
        at_origin: arguments.at_origin,
        errors: DrawnErrors {
            pose: arguments.pose_noise,
            lens: arguments.lens_noise,
            world: arguments.world_noise,
        },
    };
    let folder = &arguments.folder;
    sample::make(folder, &options, progress)
        .map_err(|fault| FileError::new(folder, fault).to_string())?;
    let text = format!("{}: a simulated flight\n", folder.display());
    Ok(Answer::new(text, Vec::new()))
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Debug, Parser)]
    struct Alone {
        #[command(flatten)]
        arguments: SampleArguments,
    }

    fn parsed(options: &[&str]) -> Result<SampleArguments, String> {
        let words = ["sample", "folder"].iter().chain(options);
        let alone = Alone::try_parse_from(words).map_err(|error| error.to_string())?;
        Ok(alone.arguments)
    }

    #[test]
    fn noise_is_understood() {
        let words = ["--pose-noise", "0.02,0.1", "--lens-noise", "0.5"];
        let arguments = parsed(&words).unwrap();
        let expected = PoseNoise {
            position: 0.02,
            angle: 0.1,
        };
        assert_eq!(arguments.pose_noise, Some(expected));
        assert_eq!(arguments.lens_noise, Some(0.5));
        assert_eq!(arguments.world_noise, None);
    }

    #[test]
    fn absurd_noise_is_refused() {
        for pair in [
            "1", "1,2,3", "", ",", "1,", "-1,2", "1,-2", "nan,1", "1,inf", "1001,1", "1,46", "a,b",
        ] {
            let refused = parsed(&["--pose-noise", pair]).unwrap_err();
            assert!(refused.contains("--pose-noise"), "{pair}: {refused}");
            assert!(!refused.contains("unexpected"), "{pair}: {refused}");
        }
        for option in ["--lens-noise", "--world-noise"] {
            for number in [
                "-1", "-0.1", "50.01", "nan", "inf", "-inf", "1,2", "", "1 %",
            ] {
                let refused = parsed(&[option, number]).unwrap_err();
                let what = format!("'{number}' is not a number from 0 to 50 percent");
                assert!(refused.contains(&what), "{number}: {refused}");
            }
        }
    }
}

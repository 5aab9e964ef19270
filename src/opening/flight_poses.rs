//! What a flight.toml may name as `[photos] poses`: a poses.csv, or poses over time (a trajectory, a
//! ROS recording), which the image files in `[photos] folder` take by the stamps in their names.
//!
//! Poses over time name no camera, so the flight has one. Where they are those of a body, the camera's
//! file must say where it sits on it (EuRoC's sensor.yaml, T_BS).

use std::fs;
use std::path::{Path, PathBuf};

use crate::camera::Pose;
use crate::fault::Fault;
use crate::files::FileError;
use crate::flight::{CameraEntry, CameraSource};
use crate::formats::packages::ros;
use crate::formats::photos::image_names::is_image;
use crate::formats::poses::trajectory::PosedFiles;
use crate::formats::{
    Kind, Package, PoseLine, PosesFile, detect, read_camera_mount, read_poses, read_trajectory,
};
use crate::jobs::Progress;
use crate::scale::PoseErrors;

/// What poses over time are for.
pub(crate) struct PhotosToPose<'a> {
    /// The folder of flight.toml, which paths are relative to.
    pub(crate) flight_folder: &'a Path,
    /// Its cameras.
    pub(crate) cameras: &'a [CameraEntry],
    /// The folder of the image files.
    pub(crate) folder: Option<PathBuf>,
    /// The topic of a recording whose poses are meant.
    pub(crate) topic: Option<&'a str>,
}

/// What is to be said where a topic is named and no recording is there.
pub(crate) fn topic_without_recording(topic: &str) -> Fault {
    Fault::new(
        format!("a topic ('{topic}') is named, and this is no recording of ROS"),
        "leave out --topic, or topic in flight.toml's [photos]",
    )
}

/// Reads the poses of a flight's photos.
///
/// # Errors
/// With the file and the place in it, where no image file gets a pose, and where a camera has to be
/// said.
pub(crate) fn read(
    path: &Path,
    photos: &PhotosToPose<'_>,
    progress: &Progress,
) -> Result<PosesFile, FileError> {
    let at = |fault| FileError::new(path, fault);
    let kind = detect(path);
    if let Some(topic) = photos.topic
        && !matches!(kind, Ok(Kind::Reconstruction(Package::Ros, _)))
    {
        return Err(at(topic_without_recording(topic)));
    }
    let (posed, warnings) = match kind {
        Ok(Kind::Trajectory(format)) => {
            let trajectory = read_trajectory(path, format, progress)?;
            let mut posed = trajectory.pose_files(&photos.files(path)?).map_err(at)?;
            let mut warnings = trajectory.warnings;
            if format.is_of_body() {
                let mount = photos.mount(path)?;
                for (_, pose) in &mut posed.photos {
                    *pose = pose.carrying(&mount);
                }
            } else {
                warnings.push(format.caveat().to_owned());
            }
            (posed, warnings)
        }
        Ok(Kind::Reconstruction(Package::Ros, folder)) => {
            let files = photos.files(path)?;
            let recording = ros::read(&folder, progress)?;
            let posed = recording.pose_files(&files, photos.topic).map_err(at)?;
            (posed, Vec::new())
        }
        // Whatever else it is, its faults are those of a list of poses.
        _ => return read_poses(path),
    };
    if photos.cameras.len() > 1 {
        return Err(at(Fault::new(
            "the flight has several cameras, and poses over time name none",
            "keep one [[camera]], or write a poses.csv with a column camera",
        )));
    }
    Ok(poses_file(posed, warnings))
}

fn poses_file(posed: PosedFiles, mut warnings: Vec<String>) -> PosesFile {
    warnings.extend(posed.warnings);
    let lines = posed.photos.into_iter().zip(1..);
    PosesFile {
        lines: lines
            .map(|((photo, pose), line)| PoseLine {
                photo,
                camera: None,
                pose,
                errors: PoseErrors::default(),
                line,
            })
            .collect(),
        warnings,
        ..PosesFile::default()
    }
}

impl PhotosToPose<'_> {
    /// The names of the image files, sorted.
    fn files(&self, poses: &Path) -> Result<Vec<String>, FileError> {
        let Some(folder) = &self.folder else {
            return Err(FileError::new(
                poses,
                Fault::new(
                    "these are poses over time: the photos are the image files called by their stamps",
                    "name their folder as [photos] folder",
                ),
            ));
        };
        let entries = fs::read_dir(folder).map_err(|e| {
            let what = format!("the folder of the photos cannot be read ({e})");
            FileError::new(folder, Fault::new(what, "correct [photos] folder"))
        })?;
        let names = entries
            .flatten()
            .filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names.filter(|name| is_image(name)).collect();
        names.sort_unstable();
        Ok(names)
    }

    /// Where the flight's camera sits on the body.
    fn mount(&self, poses: &Path) -> Result<Pose, FileError> {
        let entry = self.cameras.first();
        let source = entry
            .map(CameraEntry::source)
            .transpose()
            .map_err(|fault| FileError::new(poses, fault))?;
        let mount = match source {
            Some(CameraSource::File(name)) => read_camera_mount(&self.flight_folder.join(name))?,
            _ => None,
        };
        mount.ok_or_else(|| {
            FileError::new(
                poses,
                Fault::new(
                    "its poses are those of the body, and the camera does not say where it sits on it (T_BS)",
                    "name the camera's own sensor.yaml as [[camera]] file, or write a trajectory of the camera",
                ),
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};
    use image::RgbImage;

    use super::*;
    use crate::{OpenOptions, Opened, open_flight};

    const SENSOR: &str = "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  \
        data: [0, -1, 0, 0.5, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\nresolution: [8, 6]\n\
        camera_model: pinhole\nintrinsics: [10, 10, 3.5, 2.5]\n\
        distortion_model: radial-tangential\ndistortion_coefficients: [0, 0, 0, 0]\n";
    const INLINE: &str =
        "[[camera]]\nwidth = 8\nheight = 6\nfx = 10.0\nfy = 10.0\ncx = 4.0\ncy = 3.0\n";
    const FILE: &str = "[[camera]]\nfile = \"sensor.yaml\"\n";
    const TUM: &str = "10 0 0 9 1 0 0 0\n10.4 4 0 9 1 0 0 0\n";
    const EUROC: &str = "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n\
        1403715525000000000,1,2,3,1,0,0,0\n1403715525400000000,5,2,3,1,0,0,0\n";

    /// A flight over four points, with photos of these names.
    fn opened(poses: (&str, &str), camera: &str, photos: &[&str]) -> Result<Opened, String> {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        write(poses.0, poses.1);
        write("sensor.yaml", SENSOR);
        write("pile.xyz", "-9 -9 0\n9 -9 0\n9 9 0\n-9 9 0\n");
        let toml = format!(
            "format = 1\n[world]\nunit = \"m\"\n[surface]\nfile = \"pile.xyz\"\n{camera}[photos]\nposes = \"{}\"\n{}",
            poses.0,
            if photos.is_empty() {
                ""
            } else {
                "folder = \"photos\"\n"
            }
        );
        write("flight.toml", &toml);
        fs::create_dir(folder.path().join("photos")).unwrap();
        write("photos/notes.txt", "10.2");
        for photo in photos {
            RgbImage::new(8, 6)
                .save(folder.path().join("photos").join(photo))
                .unwrap();
        }
        open_flight(folder.path(), &OpenOptions::default(), &Progress::default())
            .map_err(|error| error.to_string())
    }

    #[test]
    fn photos_named_by_stamps_take_the_poses_of_a_trajectory() {
        let opened = opened(
            ("t.txt", TUM),
            INLINE,
            &["10.1.png", "10.300.png", "11.png"],
        )
        .unwrap();
        let photos = &opened.flight.parts().photos;
        let found: Vec<(&str, DVec3)> = photos
            .iter()
            .map(|p| (p.name.as_str(), p.pose.center))
            .collect();
        assert_eq!(
            found,
            [
                ("10.1.png", DVec3::new(1.0, 0.0, 9.0)),
                ("10.300.png", DVec3::new(3.0, 0.0, 9.0))
            ]
        );
        // Half a turn about x: the camera looks down.
        assert!((photos[0].pose.rotation.z_axis - DVec3::NEG_Z).length() < 1e-15);
        let warnings = opened.warnings.join("\n");
        assert!(
            warnings.contains("t.txt: a TUM trajectory does not say which axes move"),
            "{warnings}"
        );
        assert!(
            warnings.contains("1 of 3 image files have no pose"),
            "{warnings}"
        );
        assert!(!warnings.contains("missing"), "{warnings}");
    }

    #[test]
    fn a_bodys_poses_become_the_cameras() {
        let photos = ["1403715525100000000.png"];
        let flown = opened(("data.csv", EUROC), FILE, &photos).unwrap();
        let pose = flown.flight.parts().photos[0].pose;
        // A quarter of the way along x, and T_BS puts the camera half a metre further.
        assert!((pose.center - DVec3::new(2.5, 2.0, 3.0)).length() < 1e-12);
        assert!(
            pose.rotation
                .abs_diff_eq(DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z), 1e-15)
        );
        assert!(
            !flown.warnings.iter().any(|w| w.contains("T_BS")),
            "{:?}",
            flown.warnings
        );
        let error = opened(("data.csv", EUROC), INLINE, &photos).unwrap_err();
        assert!(
            error.contains(
                "those of the body, and the camera does not say where it sits on it (T_BS)"
            ),
            "{error}"
        );
    }

    #[test]
    fn what_is_missing_is_said() {
        let error = opened(("t.txt", TUM), INLINE, &[]).unwrap_err();
        assert!(
            error.contains(
                "the photos are the image files called by their stamps; name their folder"
            ),
            "{error}"
        );
        let two = "[[camera]]\nname = \"a\"\nfile = \"sensor.yaml\"\n[[camera]]\nname = \"b\"\nfile = \"sensor.yaml\"\n";
        let error = opened(("t.txt", TUM), two, &["10.1.png"]).unwrap_err();
        assert!(
            error.contains("several cameras, and poses over time name none"),
            "{error}"
        );
        let error = opened(("t.txt", TUM), INLINE, &["20.png"]).unwrap_err();
        assert!(
            error.contains("t.txt: none of 1 image files has a pose"),
            "{error}"
        );
        // What is no trajectory is a poses.csv, as ever.
        let error = opened(("t.csv", "photo,x,y\n"), INLINE, &["10.1.png"]).unwrap_err();
        assert!(error.contains("there is no column z"), "{error}");
    }
}

//! poses.csv (contract, section 4), with quaternions of world_from_camera or with tilt and pan, and
//! where they are stated with standard deviations (section 8).
//! Numbers are the shortest ones that read back to the same f64.

use std::collections::HashSet;

use glam::{DQuat, DVec3};

use crate::camera::Pose;

/// Which way a photo looked, in the words of poses.csv.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Orientation {
    /// x, y, z, w of world_from_camera.
    Quaternion([f64; 4]),
    /// Degrees: tilt below the horizon, pan clockwise from world +y.
    TiltPan([f64; 2]),
}

/// How sure a pose is: one standard deviation each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StatedDeviations {
    /// Of the camera centre along each axis of the world, in the world's unit.
    pub position: DVec3,
    /// Of the rotation about each camera axis, degrees.
    pub angle: f64,
}

/// One line of a poses.csv.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseRow {
    /// The image file's name.
    pub photo: String,
    /// What the camera is called; `None` with one camera.
    pub camera: Option<String>,
    /// The camera centre in the world, in the world's unit.
    pub center: DVec3,
    /// As it will stand there.
    pub orientation: Orientation,
    /// In columns of their own; `None` leaves the cells empty.
    pub stated: Option<StatedDeviations>,
}

impl PoseRow {
    /// The line of a photo whose pose is known as a rotation: with its unit quaternion.
    pub fn of_pose(photo: &str, pose: &Pose) -> Self {
        Self {
            photo: photo.to_owned(),
            camera: None,
            center: pose.center,
            orientation: Orientation::Quaternion(DQuat::from_mat3(&pose.rotation).to_array()),
            stated: None,
        }
    }
}

/// The text of a poses.csv. The column `camera` is there where a row names one, those of standard
/// deviations where a row states them.
///
/// # Errors
/// Where there is no row, a name is one that a reader would change or that stands twice, a number is
/// not finite, a standard deviation is negative, or quaternions and angles are mixed.
pub fn poses_csv(rows: &[PoseRow]) -> Result<String, String> {
    let first = rows.first().ok_or("there are no poses to write")?;
    let cameras = rows.iter().any(|row| row.camera.is_some());
    let states = rows.iter().any(|row| row.stated.is_some());
    let deviations: &[&str] = match states {
        true => &["s_x", "s_y", "s_z", "s_angle"],
        false => &[],
    };
    let columns: &[&str] = match first.orientation {
        Orientation::Quaternion(_) => &["qx", "qy", "qz", "qw"],
        Orientation::TiltPan(_) => &["tilt", "pan"],
    };
    let failed = |error: csv::Error| format!("poses.csv cannot be written ({error})");
    let mut writer = csv::WriterBuilder::new()
        .comment(Some(b'#'))
        .from_writer(Vec::new());
    let camera = cameras.then_some("camera");
    let head = ["photo"].into_iter().chain(camera).chain(["x", "y", "z"]);
    writer
        .write_record(head.chain(columns.iter().chain(deviations).copied()))
        .map_err(failed)?;
    let mut seen = HashSet::new();
    for row in rows {
        let photo = &row.photo;
        check_name("photo", photo)?;
        if !seen.insert(photo) {
            return Err(format!("the photo '{photo}' stands twice"));
        }
        if let Some(camera) = &row.camera {
            check_name("camera", camera)?;
        }
        let angles: &[f64] = match (&row.orientation, &first.orientation) {
            (Orientation::Quaternion(quaternion), Orientation::Quaternion(_)) => quaternion,
            (Orientation::TiltPan(angles), Orientation::TiltPan(_)) => angles,
            _ => {
                return Err(format!(
                    "the photo '{photo}' has another kind of orientation than the first one"
                ));
            }
        };
        let center = row.center.to_array();
        let numbers = || center.iter().chain(angles);
        if let Some(number) = numbers().find(|number| !number.is_finite()) {
            return Err(format!(
                "the pose of the photo '{photo}' has {number} in it"
            ));
        }
        let stated = row.stated.map(|StatedDeviations { position, angle }| {
            let [x, y, z] = position.to_array();
            [x, y, z, angle]
        });
        let is_deviation = |number: &f64| *number >= 0.0 && number.is_finite();
        if let Some(number) = stated.iter().flatten().find(|number| !is_deviation(number)) {
            return Err(format!(
                "the photo '{photo}' has the standard deviation {number}"
            ));
        }
        let stated = match stated {
            Some(numbers) => numbers.map(|number| number.to_string()).to_vec(),
            None => vec![String::new(); deviations.len()],
        };
        let camera = cameras.then(|| row.camera.clone().unwrap_or_default());
        let names = [photo.clone()].into_iter().chain(camera);
        let pose = names.chain(numbers().map(f64::to_string));
        writer.write_record(pose.chain(stated)).map_err(failed)?;
    }
    let bytes = writer.into_inner().map_err(|e| e.to_string())?;
    String::from_utf8(bytes).map_err(|e| e.to_string())
}

/// Refuses names that do not come back as they were: readers trim fields and strip quotes.
fn check_name(what: &str, name: &str) -> Result<(), String> {
    if name.is_empty() || name.trim() != name || name.contains(|c: char| c.is_control() || c == '"')
    {
        return Err(format!("{name:?} is no name for a {what}"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::jobs::Progress;
    use crate::scale::PoseErrors;
    use fragscale_formats::read_poses;
    use fragscale_opening::{OpenOptions, open_flight};
    use fragscale_test_data::written;

    /// The poses that the program itself reads from a poses.csv.
    fn read(text: &str) -> Vec<(String, Pose)> {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text);
        write("poses.csv", text).unwrap();
        // Wide, and far below: where the photos stand is not the matter here.
        let pile = "-9e5 -9e5 -9e5\n9e5 -9e5 -9e5\n0 9e5 -9e5\n";
        write("pile.xyz", pile).unwrap();
        let camera = |name: &str| {
            format!(
                "[[camera]]\nname = \"{name}\"\nwidth = 4\nheight = 3\nfx = 5\nfy = 5\n\
                 cx = 2\ncy = 1.5\n"
            )
        };
        let flight = format!(
            "format = 1\n[world]\nunit = \"m\"\n[surface]\nfile = \"pile.xyz\"\n\
             {}{}[photos]\nposes = \"poses.csv\"\n",
            camera("left"),
            camera("right, far"),
        );
        write("flight.toml", &flight).unwrap();
        let path = folder.path().join("flight.toml");
        let opened = open_flight(&path, &OpenOptions::default(), &Progress::default()).unwrap();
        assert_eq!(opened.warnings, [""; 0]);
        let flight = opened.flight;
        let photos = &flight.parts().photos;
        let name = |camera: usize| flight.parts().cameras[camera].name.clone();
        photos
            .iter()
            .map(|photo| (format!("{}/{}", name(photo.camera), photo.name), photo.pose))
            .collect()
    }

    fn row(photo: &str, camera: &str, orientation: Orientation) -> PoseRow {
        PoseRow {
            photo: photo.to_owned(),
            camera: Some(camera.to_owned()),
            center: DVec3::new(500_000.123_456_789, 1.0 / 3.0, 1e-7),
            orientation,
            stated: None,
        }
    }

    #[test]
    fn standard_deviations_read_back() {
        let down = Orientation::TiltPan([90.0, 0.0]);
        let stated = StatedDeviations {
            position: DVec3::new(0.02, 1e-9, 1.0 / 3.0),
            angle: 0.1,
        };
        let rows = [
            row("a.jpg", "left", down),
            PoseRow {
                stated: Some(stated),
                ..row("b.jpg", "left", down)
            },
        ];
        let text = poses_csv(&rows).unwrap();
        let (_folder, path) = written("poses.csv", &text);
        let lines = read_poses(&path).unwrap().lines;
        assert_eq!(lines[0].errors, PoseErrors::default());
        let expected = PoseErrors {
            position: Some(stated.position),
            angle: Some(DVec3::splat(stated.angle)),
        };
        assert_eq!(lines[1].errors, expected);
        for wrong in [-0.1, f64::NAN, f64::INFINITY] {
            let mut rows = rows.clone();
            rows[1].stated = Some(StatedDeviations {
                angle: wrong,
                ..stated
            });
            assert!(poses_csv(&rows).unwrap_err().contains(&wrong.to_string()));
        }
    }

    #[test]
    fn quaternions_read_back() {
        let turn = DMat3::from_euler(glam::EulerRot::ZYX, 0.3, -1.1, 2.9);
        let pose = Pose {
            rotation: turn,
            center: DVec3::new(1e6 + 0.1, -2.0, 3.3),
        };
        let rows = [
            PoseRow {
                camera: Some("left".to_owned()),
                ..PoseRow::of_pose("a, b.jpg", &pose)
            },
            row(
                "#2.jpg",
                "right, far",
                Orientation::Quaternion([1.0, 0.0, 0.0, 0.0]),
            ),
        ];
        let text = poses_csv(&rows).unwrap();
        assert_eq!(poses_csv(&rows).unwrap(), text);
        assert!(
            text.starts_with("photo,camera,x,y,z,qx,qy,qz,qw\n"),
            "{text}"
        );
        let read = read(&text);
        assert_eq!(read[0].0, "left/a, b.jpg");
        assert_eq!(read[0].1.center, pose.center);
        // From matrix to quaternion and back: a few roundings of 1e-16.
        let off = read[0].1.rotation - pose.rotation;
        assert!(off.to_cols_array().iter().all(|d| d.abs() < 1e-15), "{off}");
        assert_eq!(read[1].0, "right, far/#2.jpg");
        assert_eq!(read[1].1.center, rows[1].center);
        assert_eq!(
            Ok(read[1].1),
            Pose::from_quaternion(rows[1].center, [1.0, 0.0, 0.0, 0.0])
        );
    }

    #[test]
    fn tilt_and_pan_read_back_exactly() {
        let rows = [[90.0, 0.0], [89.99, -1.0 / 3.0], [-7.25, 359.9]].map(|angles| {
            row(
                &format!("{}.jpg", angles[0]),
                "left",
                Orientation::TiltPan(angles),
            )
        });
        let read = read(&poses_csv(&rows).unwrap());
        for (row, (name, pose)) in rows.iter().zip(read) {
            let Orientation::TiltPan(angles) = row.orientation else {
                panic!("angles");
            };
            assert_eq!(name, format!("left/{}", row.photo));
            assert_eq!(pose, Pose::from_tilt_pan(row.center, angles));
        }
    }

    #[test]
    fn the_camera_column_is_there_when_it_says_something() {
        let row = PoseRow {
            camera: None,
            ..row("a.jpg", "", Orientation::TiltPan([90.0, 0.5]))
        };
        assert_eq!(
            poses_csv(&[row]).unwrap(),
            "photo,x,y,z,tilt,pan\na.jpg,500000.123456789,0.3333333333333333,0.0000001,90,0.5\n"
        );
    }

    #[test]
    fn what_would_not_read_back_is_refused() {
        let down = Orientation::TiltPan([90.0, 0.0]);
        let good = row("a.jpg", "left", down);
        assert!(poses_csv(&[]).is_err());
        assert!(
            poses_csv(&[good.clone(), good.clone()])
                .unwrap_err()
                .contains("twice")
        );
        for name in ["", " a.jpg", "a\nb.jpg", "\"a\""] {
            assert!(poses_csv(&[row(name, "left", down)]).is_err(), "{name}");
            assert!(poses_csv(&[row("a.jpg", name, down)]).is_err(), "{name}");
        }
        let nan = row("b.jpg", "left", Orientation::TiltPan([f64::NAN, 0.0]));
        assert!(poses_csv(&[nan]).unwrap_err().contains("NaN"));
        let mixed = row(
            "b.jpg",
            "left",
            Orientation::Quaternion([0.0, 0.0, 0.0, 1.0]),
        );
        assert!(
            poses_csv(&[good, mixed])
                .unwrap_err()
                .contains("another kind")
        );
    }
}

//! A `reconstruction.json` given directly, with what lies beside it in OpenSfM's data set.
//!
//! Written from OpenSfM's documentation ("Dataset Structure") and ODM's `stages/run_opensfm.py`:
//!
//! | beside | what it gives |
//! |---|---|
//! | `tracks.csv`; beside `reconstruction_X.json` first `tracks_X.csv` | where photos show the points |
//! | `reference_lla.json` | the frame's origin, where the reconstruction states none |
//! | `stats/stats.json` | how sure the world's scale is (stats.rs) |
//! | `image_list.txt` | which photos there were before the alignment |
//! | `images/`; of a folder `opensfm` also `../images/` | the photos |
//! | `reconstruction.topocentric.json`, `exported_geocoords.txt` | OpenDroneMap has put projected coordinates less an offset into `reconstruction.json`, unless the photos' positions say otherwise (frame/) |

use std::collections::HashSet;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::OpenSfm;
use super::frame::Hint;
use super::stats::world_scale_error;
use crate::files::{FileError, last_segment, open_file, read_bytes, text_from_bytes};
use crate::packages::reconstruction::{Project, Reconstruction};
use crate::photos::photo_folder::folder_of_photos;

/// The `reconstruction.json` of a data set's folder, or of the `opensfm` folder in it; else the only
/// `reconstruction_X.json` of the folder. Its report has the same name, but is no list.
pub(crate) fn dataset_file(folder: &Path) -> Option<PathBuf> {
    let begins_a_list = |file: &PathBuf| {
        let mut start = Vec::new();
        let read = open_file(file).map(|file| file.take(64).read_to_end(&mut start));
        read.is_ok() && start.trim_ascii_start().starts_with(b"[")
    };
    ["reconstruction.json", "opensfm/reconstruction.json"]
        .map(|name| folder.join(name))
        .into_iter()
        .find(begins_a_list)
        .or_else(|| {
            let entries = fs::read_dir(folder).ok()?.flatten();
            let mut others = entries.map(|entry| entry.path()).filter(|file| {
                let name = file.file_name().unwrap_or_default().to_string_lossy();
                name.starts_with("reconstruction_")
                    && name.ends_with(".json")
                    && begins_a_list(file)
            });
            others.next().filter(|_| others.next().is_none())
        })
}

/// Reads a `reconstruction.json` and what lies beside it.
///
/// # Errors
/// Where the file itself cannot be used. What only adds to it is a warning where it is broken.
pub(crate) fn read_file(path: &Path) -> Result<Project, FileError> {
    let at = |fault| FileError::new(path, fault);
    let mut file = OpenSfm::read(&read_bytes(path)?).map_err(at)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut warnings = Vec::new();
    let reference = folder.join("reference_lla.json");
    if reference.is_file()
        && let Err(error) = read_bytes(&reference).and_then(|bytes| {
            file.add_reference(&bytes)
                .map_err(|fault| FileError::new(&reference, fault))
        })
    {
        warnings.push(format!("no origin on the Earth: {error}"));
    }
    if let Some(tracks) = tracks_file(path)
        && let Err(error) = read_bytes(&tracks).and_then(|bytes| {
            text_from_bytes(&bytes)
                .and_then(|text| file.add_observations(text))
                .map_err(|fault| FileError::new(&tracks, fault))
        })
    {
        warnings.push(format!("no observations: {error}"));
    }
    file.reconstruction.warnings.append(&mut warnings);
    file.place(hint(path));
    let mut reconstruction = file.reconstruction;
    let centers: Vec<DVec3> = reconstruction
        .photos
        .iter()
        .map(|p| p.pose.center)
        .collect();
    // In a frame of its own it says nothing of the world.
    if reconstruction.enu_origin.is_some() || reconstruction.crs.is_some() {
        let stats = folder.join("stats/stats.json");
        reconstruction.errors.world_scale = scale_error(&stats, &centers, &mut warnings);
    }
    warnings.extend(unaligned(folder, &reconstruction));
    reconstruction.warnings.extend(warnings);
    let mut folders = vec![folder.join("images")];
    if folder.file_name().is_some_and(|name| name == "opensfm") {
        folders.push(folder.join("../images"));
    }
    let photos = folder_of_photos(folders, &reconstruction);
    Ok(Project {
        reconstruction,
        photos,
        ..Project::default()
    })
}

/// The standard error of the world's scale, percent, by a `stats.json`, if it is there.
pub(crate) fn scale_error(
    path: &Path,
    centers: &[DVec3],
    warnings: &mut Vec<String>,
) -> Option<f64> {
    let read = |bytes: Vec<u8>| {
        world_scale_error(&bytes, centers).map_err(|fault| FileError::new(path, fault))
    };
    let found = path.is_file().then(|| read_bytes(path).and_then(read))?;
    found.unwrap_or_else(|error| {
        warnings.push(format!("how sure the scale is cannot be told: {error}"));
        None
    })
}

/// How many photos a `reconstruction.json` of `most` bytes at most places.
pub(crate) fn count_of_photos(path: &Path, most: u64) -> Option<usize> {
    let is_small = path.metadata().ok()?.len() <= most;
    let bytes = is_small.then(|| read_bytes(path).ok()).flatten()?;
    Some(OpenSfm::read(&bytes).ok()?.reconstruction.photos.len())
}

/// What the file's name and its neighbours say about its frame.
fn hint(path: &Path) -> Hint {
    let of_projection = ["reconstruction.topocentric.json", "exported_geocoords.txt"];
    let name = path.file_name().unwrap_or_default();
    if name == "reconstruction.topocentric.json" {
        Hint::Topocentric
    } else if name == "reconstruction.json"
        && of_projection
            .iter()
            .any(|name| path.with_file_name(name).is_file())
    {
        Hint::Projected
    } else {
        Hint::None
    }
}

/// The tracks that the reconstruction was made from.
fn tracks_file(path: &Path) -> Option<PathBuf> {
    let stem = path.file_stem()?.to_str()?;
    let own = stem
        .strip_prefix("reconstruction")
        .map(|rest| path.with_file_name(format!("tracks{rest}.csv")));
    let any = path.with_file_name("tracks.csv");
    own.into_iter().chain([any]).find(|file| file.is_file())
}

/// A warning with the count of the photos of `image_list.txt` that were not aligned, if any.
fn unaligned(folder: &Path, reconstruction: &Reconstruction) -> Option<String> {
    let file = folder.join("image_list.txt");
    let list = file.is_file().then(|| read_bytes(&file).ok()).flatten()?;
    let last = |name: &str| last_segment(name).to_owned();
    let aligned: HashSet<String> = reconstruction
        .photos
        .iter()
        .map(|p| last(&p.name))
        .collect();
    let listed: HashSet<String> = text_from_bytes(&list)
        .ok()?
        .lines()
        .map(|line| last(line.trim()))
        .filter(|name| !name.is_empty())
        .collect();
    let count = listed.difference(&aligned).count();
    (count > 0).then(|| format!("{count} of {} photos were not aligned", listed.len()))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use fragscale_test_data::shared_data;

    #[test]
    fn statistics_say_how_sure_the_scale_is() {
        let stats = r#"{"reconstruction_statistics": {"has_gps": true},
            "gps_errors": {"std": {"x": 1, "y": 1, "z": 1}}}"#;
        let shots = |place: &str, x: f64| {
            format!(
                r#""{place}": {{"camera": "c", "rotation": [0, 0, 0], "translation": [{x}, 0, 0]}}"#
            )
        };
        let shots = [shots("a", 0.0), shots("b", 30.0), shots("d", -30.0)].join(", ");
        let from = ONE.find("\"a.jpg\"").unwrap();
        let to = ONE.find("},\n        \"points\"").unwrap();
        let text = format!("{}{shots}{}", &ONE[..from], &ONE[to..]);
        let files = |stats| {
            [
                ("opensfm/reconstruction.json", &*text),
                ("opensfm/stats/stats.json", stats),
            ]
        };
        let (_dir, found) = project(&files(stats));
        // n = 3: sqrt(9/2 / 1800).
        let percent = found.reconstruction.errors.world_scale.unwrap();
        assert!((percent - 5.0).abs() < 1e-12, "{percent}");
        let (_dir, found) = project(&files("[1"));
        assert_eq!(found.reconstruction.errors.world_scale, None);
        let said = found.reconstruction.warnings.join("; ");
        assert!(said.contains("how sure the scale is"), "{said}");
    }

    const ONE: &str = r#"[{"cameras": {"c": {"focal": 1, "width": 200, "height": 400}},
        "shots": {"a.jpg": {"camera": "c", "rotation": [0, 0, 0], "translation": [0, 0, 0],
            "gps_position": [1, 2, 3]}},
        "points": {"t": {"coordinates": [0, 0, 5]}},
        "reference_lla": {"latitude": 50, "longitude": 10, "altitude": 0}}]"#;

    fn project(files: &[(&str, &str)]) -> (tempfile::TempDir, Project) {
        let dir = tempfile::tempdir().unwrap();
        for (name, content) in files {
            let file = dir.path().join(name);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, content).unwrap();
        }
        let project = read_file(&dir.path().join(files[0].0)).unwrap();
        (dir, project)
    }

    #[test]
    fn what_lies_beside_is_found() {
        let (dir, project) = project(&[
            ("opensfm/reconstruction.json", ONE),
            ("opensfm/tracks.csv", "a.jpg\tt\t0\t0.01\t0\t1\t2\t3\n"),
            (
                "opensfm/image_list.txt",
                "../images/a.jpg\r\n../images/b.jpg\n",
            ),
            ("images/a.jpg", ""),
        ]);
        let found = project.reconstruction;
        // The point is on the axis, and was seen 0.01 of the longer side beside it.
        assert!((found.median_reprojection_px().unwrap() - 4.0).abs() < 1e-12);
        assert_eq!(found.warnings, ["1 of 2 photos were not aligned"]);
        assert_eq!(project.photos, Some(dir.path().join("opensfm/../images")));
        assert!(found.enu_origin.is_some());
        fs::create_dir(dir.path().join("reports")).unwrap();
        fs::write(dir.path().join("reports/reconstruction.json"), "{}").unwrap();
        assert_eq!(dataset_file(&dir.path().join("reports")), None);
        assert_eq!(
            dataset_file(dir.path()),
            Some(dir.path().join("opensfm/reconstruction.json"))
        );
    }

    #[test]
    fn tracks_are_those_of_the_same_name() {
        let (_dir, project) = project(&[
            ("reconstruction_old.json", ONE),
            ("tracks_old.csv", "a.jpg\tt\t0\t0\t0\t1\t2\t3\n"),
            ("tracks.csv", "broken"),
        ]);
        assert_eq!(project.reconstruction.observations.len(), 1);
        assert_eq!(
            (project.reconstruction.warnings.len(), project.photos),
            (0, None)
        );
    }

    #[test]
    fn projected_coordinates_have_no_origin_of_east_north_up() {
        let (_dir, project) = project(&[
            ("reconstruction.json", ONE),
            ("exported_geocoords.txt", ""),
            ("reference_lla.json", "x"),
            ("tracks.csv", "broken"),
        ]);
        let found = project.reconstruction;
        assert_eq!(
            (found.enu_origin, found.measured_positions.len()),
            (None, 1)
        );
        for (warning, named) in
            found
                .warnings
                .iter()
                .zip(["no origin", "no observations", "less an offset"])
        {
            assert!(warning.contains(named), "{warning}");
        }
    }

    #[test]
    fn berlin_given_directly() {
        let Some(folder) = shared_data("opensfm-berlin") else {
            return;
        };
        let project = read_file(&folder.join("reconstruction_example.json")).unwrap();
        let found = project.reconstruction;
        assert_eq!((found.observations.len(), found.warnings.len()), (3082, 0));
        let median = found.median_reprojection_px().unwrap();
        assert!((median - 0.796).abs() < 5e-4, "{median}");
        assert_eq!(project.photos, Some(folder.join("images")));
        // The EXIF of 03.jpg: north of the reference by 9.376 m, 111.27 km a degree here.
        let of_03 = &found.measured_positions[0];
        let origin = found.enu_origin.unwrap();
        let north = (of_03.position.latitude - origin.latitude) * 111_270.0;
        assert!((north - 9.376).abs() < 0.01, "{north}");
        assert!((of_03.position.height - 39.0).abs() < 1e-4);
    }
}

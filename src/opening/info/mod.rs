//! What the program understood of a file (contract, section 6), as JSON.

mod flights;
mod mission;
mod own;
mod places;
mod poses;

use std::path::Path;

use serde_json::{Value, json};

use self::flights::{flight_info, photos_info, reconstruction_info, recording_info};
use self::mission::mission_info;
use self::places::known_places_info;
use self::poses::{camera_info, poses_info, trajectory_info};
use crate::formats::packages::ros;
use crate::formats::{
    CloudFile, CloudFormat, DistributionColumns, FileError, Kind, Package, PhotosAlone, detect,
    read_camera, read_cloud, read_mission, read_photos, read_poses, read_project,
    read_size_distributions, read_trajectory,
};
use crate::fragmentation::DistributionSet;
use crate::geometry::Bounds;
use crate::jobs::Progress;
use crate::world::WorldFrame;
use crate::{OpenOptions, open_flight};

/// Reads any supported file or folder and says what it holds.
///
/// # Errors
/// With the file and the place in it.
pub fn info(path: &Path, progress: &Progress) -> Result<Value, FileError> {
    let kind = detect(path);
    if let Some(own) = own::own_info(path, kind.as_ref().ok()) {
        return Ok(own);
    }
    let kind = match kind {
        Ok(kind) => kind,
        // DJI's list of places has no name that tells.
        Err(error) => return known_places_info(path).unwrap_or(Err(error)),
    };
    Ok(match kind {
        Kind::Cloud(CloudFormat::Xyz) => match known_places_info(path) {
            // Which have columns like a cloud's.
            Some(places) => places?,
            None => cloud_info(&read_cloud(path, progress)?),
        },
        Kind::Cloud(_) => cloud_info(&read_cloud(path, progress)?),
        Kind::Camera => camera_info(&read_camera(path)?),
        Kind::Poses => poses_info(&read_poses(path)?),
        Kind::Trajectory(format) => trajectory_info(&read_trajectory(path, format, progress)?),
        Kind::SizeDistributions => {
            let (set, warnings) = read_size_distributions(path, &DistributionColumns::default())?;
            distributions_info(&set, &warnings)
        }
        Kind::Mission => mission_info(&read_mission(path)?),
        Kind::Reconstruction(Package::Ros, path) => recording_info(&ros::read(&path, progress)?),
        Kind::Reconstruction(Package::Photos, path) => {
            let PhotosAlone { photos, project } = read_photos(&path, progress)?;
            match project {
                Ok(project) => reconstruction_info(&project.reconstruction),
                // Not one of them is a photo.
                Err(fault) if photos.is_empty() => return Err(FileError::new(&path, fault)),
                Err(fault) => photos_info(&photos, &fault),
            }
        }
        Kind::Reconstruction(..) => {
            let project = read_project(path, progress)?;
            let mut info = reconstruction_info(&project.reconstruction);
            // Its points may be none, and its cloud lie beside it.
            if let Some(surface) = &project.surface {
                info["surface"] = json!(surface.display().to_string());
            }
            info
        }
        Kind::Flight(_) => {
            let opened = open_flight(path, &OpenOptions::default(), progress)?;
            flight_info(&opened.flight, &opened.warnings)
        }
    })
}

/// A cloud or mesh.
fn cloud_info(file: &CloudFile) -> Value {
    let bounds = Bounds::of(&file.cloud.points)
        .map(|b| json!({"min": b.min.to_array(), "max": b.max.to_array()}));
    let mut warnings = file.warnings.clone();
    // What is wrong with its system is told where it is needed.
    if let Ok(frame) = WorldFrame::of_cloud(file, &mut Vec::new()) {
        warnings.extend(frame.heights_in_words());
    }
    json!({
        "kind": "cloud",
        "points": file.cloud.points.len(),
        "faces": file.cloud.triangles.len(),
        "colors": !file.cloud.colors.is_empty(),
        "bounds": bounds,
        "crs": file.crs,
        "warnings": warnings,
    })
}

/// Size distributions, sizes in the file's unit.
fn distributions_info(set: &DistributionSet, warnings: &[String]) -> Value {
    let sizes = || {
        let points = set
            .curves
            .iter()
            .flat_map(|curve| curve.distribution.points());
        points.map(|point| point[0])
    };
    let curves = set.curves.iter().map(|curve| {
        let points = curve.distribution.points();
        json!({
            "method": curve.labels.method,
            "trial": curve.labels.trial,
            "photo": curve.labels.photo,
            "weight": curve.weight,
            "points": points.len(),
            "smallest": points.first(),
            "largest": points.last(),
        })
    });
    json!({
        "kind": "size-distributions",
        "unit": set.unit.symbol(),
        "curves": curves.collect::<Vec<_>>(),
        "smallest_size": sizes().min_by(f64::total_cmp),
        "largest_size": sizes().max_by(f64::total_cmp),
        "warnings": warnings,
    })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use exif::Tag;
    use fragscale_test_data::jpeg;
    use image::RgbImage;

    use super::*;
    use crate::Dropped;

    /// Frames of a film, screenshots, photos whose positions a program took away.
    #[test]
    fn photos_without_positions_are_said_to_be_that() {
        let folder = tempfile::tempdir().unwrap();
        let camera = [
            jpeg::text(Tag::Make, "DJI"),
            jpeg::text(Tag::Model, "FC6310R"),
        ];
        for name in ["a.jpg", "b.jpg"] {
            let photo = jpeg::jpeg((40, 30), &camera, &[]);
            fs::write(folder.path().join(name), photo).unwrap();
        }
        let screenshot = folder.path().join("c.png");
        RgbImage::new(8, 6).save(&screenshot).unwrap();
        let said = info(folder.path(), &Progress::default()).unwrap();
        assert_eq!(said["kind"], "photos");
        assert_eq!(said["photos"].as_array().map(Vec::len), Some(3));
        assert_eq!(said["positions"], 0);
        let cameras = json!([
            {"name": null, "width": 8, "height": 6, "photos": 1},
            {"name": "DJI FC6310R", "width": 40, "height": 30, "photos": 2},
        ]);
        assert_eq!(said["cameras"], cameras);
        let why = said["warnings"][0].as_str().unwrap();
        assert!(why.contains("it is no flight") && why.contains("3 of 3 have no position"));
        let one = info(&screenshot, &Progress::default()).unwrap();
        assert_eq!(one["photos"][0]["photo"], "c.png");
        // What is no photo is an error as ever.
        fs::write(&screenshot, "x").unwrap();
        assert!(info(&screenshot, &Progress::default()).is_err());
    }

    /// OpenDroneMap's list with marks (whose pixels count from the first one's centre, ours from its corner), without, and DJI's of a Phantom's photos.
    #[test]
    fn known_places_are_said_to_be_that() {
        let folder = tempfile::tempdir().unwrap();
        let of = |name: &str, text: &str| {
            let path = folder.path().join(name);
            fs::write(&path, text).unwrap();
            info(&path, &Progress::default()).unwrap()
        };
        let said = of(
            "gcp_list.txt",
            "EPSG:32633\n500000 5000000 100 320 240 a.jpg 7\n500000 5000000 100 10 20 b.jpg 7\n",
        );
        let marks = json!([
            {"photo": "a.jpg", "pixel": [320.5, 240.5]},
            {"photo": "b.jpg", "pixel": [10.5, 20.5]},
        ]);
        let point = json!({"name": "7", "position": [500000.0, 5000000.0, 100.0], "marks": marks});
        assert_eq!(said["points"], json!([point]));
        let of_list = json!(["control-points", "EPSG:32633", 2]);
        assert_eq!(json!([said["kind"], said["crs"], said["marks"]]), of_list);
        let said = of("geo.txt", "EPSG:4326\na.jpg 7.5 50.25 160\n");
        assert_eq!(said["kind"], "positions");
        assert_eq!(
            said["positions"],
            json!([{"photo": "a.jpg", "position": [7.5, 50.25, 160.0], "accuracy": null}])
        );
        let line = "2\t296288.242869\t[2211]\t3,N\t0,E\t75,V\t47.5,Lat\t16.25,Lon\t512.998,Ellh\t\
            0.01, 0.02, 0.03\t50,Q\n";
        let said = of("Timestamp.MRK", line);
        assert_eq!(said["kind"], "positions");
        // As surveyors list them, and as people do: not clouds of two points, nor poses.
        let said = of(
            "gcp.csv",
            "name,x,y,z\nGCP1,500000,5000000,100\nGCP2,500010,5000000,101\n",
        );
        assert_eq!(
            (&said["kind"], said["points"].as_array().map(Vec::len)),
            (&json!("control-points"), Some(2))
        );
        let said = of(
            "gcps.csv",
            "GCP;Easting;Northing;Elevation\n1;500000;5000000;100\n2;500010;5000000;101\n",
        );
        assert_eq!(said["kind"], "control-points");
        let said = of(
            "places.csv",
            "photo,x,y,z\na.jpg,500000,5000000,160\nb.jpg,500010,5000000,161\n",
        );
        assert_eq!(
            (&said["kind"], said["positions"].as_array().map(Vec::len)),
            (&json!("positions"), Some(2))
        );
        // A column of classes or of numbers makes no list.
        let said = of("classes.csv", "label,x,y,z\nrock,1,2,3\nrock,2,2,3\n");
        assert_eq!(said["kind"], "cloud");
        let said = of("numbers.csv", "id,x,y,z\n1,1,2,3\n2,2,2,3\n");
        assert_eq!(said["kind"], "cloud");
        // What is wrong with a list is said in its own words: a mark without its photo, a height that is none.
        for (name, text, place, what) in [
            (
                "unnamed.txt",
                "EPSG:32633\n500010.1 5000020.2 160.1 100 200\n",
                2,
                "a line of 5 fields",
            ),
            ("letters.txt", "EPSG:4326\na.jpg 7.5 50.25 high\n", 2, "z"),
            (
                "empty.csv",
                "gcp,easting,northing,height\n7,500000,,100\n",
                2,
                "the line has no Y",
            ),
        ] {
            let path = folder.path().join(name);
            fs::write(&path, text).unwrap();
            let error = info(&path, &Progress::default()).unwrap_err().to_string();
            assert!(error.contains(&format!(":{place}: {what}")), "{error}");
        }
        // What is neither is an error as ever.
        let path = folder.path().join("letter.txt");
        fs::write(&path, "Dear all,\nthe blast is at noon, as ever.\n").unwrap();
        assert!(info(&path, &Progress::default()).is_err());
    }

    /// Home and one photo, in Mission Planner's lines; whatever the file is called.
    #[test]
    fn a_mission_is_known_by_what_is_in_it() {
        let text = "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t50\t7\t160\t1\n\
            1\t0\t3\t16\t0\t0\t0\t0\t50.0001\t7.0001\t12.5\t1\n\
            2\t0\t3\t2000\t0\t0\t1\t0\t0\t0\t0\t1\n";
        let folder = tempfile::tempdir().unwrap();
        for name in ["bench.waypoints", "bench.txt"] {
            let path = folder.path().join(name);
            fs::write(&path, text).unwrap();
            assert_eq!(detect(&path), Ok(Kind::Mission));
            let said = info(&path, &Progress::default()).unwrap();
            assert_eq!(
                (&said["kind"], &said["photos"]),
                (&json!("mission"), &json!(1))
            );
            assert_eq!(said["take_off"]["latitude"], json!(50.0));
            let stop = &said["stops"][0];
            assert_eq!(stop["height"]["metres"], json!(12.5));
            assert_eq!(stop["height"]["above"], json!("the place of take-off"));
            // It is no flight, and what to do with it is said.
            let error = Dropped::sort(&[path]).unwrap_err().to_string();
            assert!(error.contains("fragscale flown"), "{error}");
        }
    }

    #[test]
    fn size_distributions_are_told_from_lists_of_points_and_poses() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, text: &str| {
            let path = folder.path().join(name);
            fs::write(&path, text).unwrap();
            path
        };
        let long = file(
            "long.csv",
            "photo,size_cm,passing\na,1,20\na,2,40\nb,3,30\nb,4,50\n",
        );
        assert_eq!(detect(&long), Ok(Kind::SizeDistributions));
        let said = info(&long, &Progress::default()).unwrap();
        assert_eq!(said["kind"], "size-distributions");
        assert_eq!(
            (&said["unit"], &said["smallest_size"]),
            (&json!("cm"), &json!(1.0))
        );
        assert_eq!(said["curves"][1]["photo"], "b");
        assert_eq!(said["curves"][1]["largest"], json!([4.0, 50.0]));
        let error = Dropped::sort(std::slice::from_ref(&long)).unwrap_err();
        assert!(error.to_string().contains("fragscale psd"), "{error}");
        let pasted = file(
            "pasted.tsv",
            "Size (in)\tsieve\tpoint cloud\n1\t2\t3\n2\t3\t4\n",
        );
        assert_eq!(detect(&pasted), Ok(Kind::SizeDistributions));
        let poses = file("poses.csv", "photo,x,y,z,tilt,pan\na,1,2,3,90,0\n");
        assert_eq!(detect(&poses), Ok(Kind::Poses));
        let points = file("points.csv", "x,y,z,size\n1,2,3,4\n");
        assert!(matches!(detect(&points), Ok(Kind::Cloud(_))));
    }
}

//! Which reader takes a file, and the file's name before what it finds wrong.

use std::io::{BufRead, BufReader, Cursor, Read, Seek};
use std::path::Path;

use crate::camera::{Camera, Pose};
use crate::cameras::{camera_file, json_camera};
use crate::candidates::Contents;
use crate::clouds::{CloudFile, e57, ept, geotiff, gltf, las, leica, obj, pcd, ply, stl, xyz};
use crate::detect::{CloudFormat, Kind, detect};
use crate::fault::Fault;
use crate::files::{FileError, open_file, read_bytes, read_text, text_from_bytes};
use crate::geodesy::is_stated;
use crate::jobs::Progress;
use crate::packages::reconstruction::Project;
use crate::packages::{metashape, open3d};
use crate::poses::poses_csv::PosesFile;
use crate::poses::position_list::{KnownPlaces, read_known_places};
use crate::poses::trajectory::{self, Trajectory, TrajectoryFormat};
use crate::poses::{poses_csv, poses_opk};

/// Reads a cloud or mesh.
///
/// # Errors
/// With the file and the place in it.
pub fn read_cloud(path: &Path, progress: &Progress) -> Result<CloudFile, FileError> {
    let format = match detect(path)? {
        Kind::Cloud(format) => format,
        other => {
            return Err(FileError::new(
                path,
                Fault::new(
                    format!("it holds {}, not a surface", other.in_words()),
                    "give a cloud, a mesh or an elevation model",
                ),
            ));
        }
    };
    progress.stage(format!("reading {}", path.display()));
    let file = open_file(path)?;
    let size = file.metadata().map_or(0, |metadata| metadata.len());
    let input = BufReader::with_capacity(1 << 18, file);
    let beside = |name: &str| gltf::read_beside(path, name);
    read_cloud_as(format, input, size, &beside, progress)
        .map_err(|fault| FileError::new(path, no_surface_but_places(path, format).unwrap_or(fault)))
}

/// A sample of a LAS, LAZ or COPC file of millions of points, in a second or two, with how many it has in all:
/// to be looked at while it is read. `None` of other files, and where anything is wrong with it.
pub fn read_cloud_sample(path: &Path, progress: &Progress) -> Option<(CloudFile, u64)> {
    let Ok(Kind::Cloud(CloudFormat::Las)) = detect(path) else {
        return None;
    };
    progress.stage(format!("looking at {}", path.display()));
    let input = BufReader::with_capacity(1 << 18, open_file(path).ok()?);
    las::sample::read_sample(input, progress)
}

/// What to do with a text that is no cloud because it lists places for georeferencing, or what is wrong with the list; `None` of others.
pub fn no_surface_but_places(path: &Path, format: CloudFormat) -> Option<Fault> {
    if format != CloudFormat::Xyz {
        return None;
    }
    let (what, option) = match read_known_places(path)? {
        Err(fault) => return Some(fault),
        Ok(KnownPlaces::ControlPoints(list)) => {
            let count = list.list.points.len();
            (format!("{count} ground control points"), "gcp")
        }
        Ok(KnownPlaces::OfPhotos(list)) => {
            let count = list.positions.len();
            (format!("the positions of {count} photos"), "positions")
        }
    };
    Some(Fault::new(
        format!("it holds {what}, not a surface"),
        format!("give it to 'fragscale georeference' as --{option}"),
    ))
}

/// Reads a cloud or mesh that is in memory, as a file of that format. A glTF's buffers in files of
/// their own are not there.
///
/// # Errors
/// With the place in it.
pub fn read_cloud_bytes(
    format: CloudFormat,
    bytes: Vec<u8>,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let size = bytes.len() as u64;
    let beside = |name: &str| {
        Err(Fault::new(
            format!("its buffer '{name}' is a file of its own"),
            "export it as .glb",
        ))
    };
    read_cloud_as(format, Cursor::new(bytes), size, &beside, progress)
}

/// Hands `input`, of `size` bytes, to the reader of its format. `beside` reads a file that it names.
fn read_cloud_as(
    format: CloudFormat,
    input: impl BufRead + Seek + Send + Sync + 'static,
    size: u64,
    beside: &dyn Fn(&str) -> Result<Vec<u8>, Fault>,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let mut file = match format {
        CloudFormat::Ply => ply::read(input, progress),
        CloudFormat::Las => las::read(input, progress),
        CloudFormat::Obj => obj::read(input, size, progress),
        CloudFormat::Xyz => xyz::read(input, size, progress),
        CloudFormat::E57 => e57::read(input, progress),
        CloudFormat::Pcd => pcd::read(input, size, progress),
        CloudFormat::Pts => leica::read_pts(input, size, progress),
        CloudFormat::Ptx => leica::read_ptx(input, size, progress),
        CloudFormat::Stl => stl::read(input, size, progress),
        CloudFormat::Gltf => gltf::read(input, beside, progress),
        CloudFormat::GeoTiff => geotiff::read(input, size, progress),
        CloudFormat::Ept => {
            let mut header = Vec::new();
            let read = input.take(MOST_HEADER).read_to_end(&mut header);
            read.map_err(|e| Fault::new(format!("it cannot be read ({e})"), "check the disk"))?;
            ept::read(&header, beside, progress)
        }
    }?;
    file.crs = file.crs.filter(|crs| is_stated(crs));
    Ok(file)
}

/// The most bytes of a header that are read.
const MOST_HEADER: u64 = 16 << 20;

/// Reads a camera's calibration.
///
/// # Errors
/// With the file and the place in it.
pub fn read_camera(path: &Path) -> Result<Camera, FileError> {
    let text = read_text(path)?;
    let camera = if json_camera::is_camera(&text) {
        json_camera::read(&text)
    } else {
        camera_file::read(&text)
    };
    camera.map_err(|fault| FileError::new(path, fault))
}

/// Reads what a package wrote.
///
/// # Errors
/// With the file and the place in it, and where `path` holds no reconstruction.
pub fn read_project(path: &Path, progress: &Progress) -> Result<Project, FileError> {
    match detect(path)? {
        Kind::Reconstruction(package, at) => {
            let mut project = package.read(&at, progress)?;
            let found = &mut project.reconstruction;
            for crs in [&mut found.crs, &mut found.preferred_crs] {
                // An empty text states nothing.
                *crs = crs.take().filter(|crs| is_stated(crs));
            }
            if path.is_dir() {
                let said = Contents::of(path).sources_in_words(path);
                found.warnings.extend(said);
            }
            Ok(project)
        }
        other => Err(FileError::new(
            path,
            Fault::new(
                format!("it holds {}, not a reconstruction", other.in_words()),
                "give the file or folder that a photogrammetry package wrote",
            ),
        )),
    }
}

/// Where a camera's file says that it sits on the body that carries it; `None` where it does not.
/// # Errors
/// With the file and the place in it.
pub fn read_camera_mount(path: &Path) -> Result<Option<Pose>, FileError> {
    camera_file::read_mount(&read_text(path)?).map_err(|fault| FileError::new(path, fault))
}

/// Reads a trajectory.
///
/// # Errors
/// With the file and the place in it.
pub fn read_trajectory(
    path: &Path,
    format: TrajectoryFormat,
    progress: &Progress,
) -> Result<Trajectory, FileError> {
    progress.stage(format!("reading {}", path.display()));
    let input = BufReader::with_capacity(1 << 18, open_file(path)?);
    trajectory::read(format, input).map_err(|fault| FileError::new(path, fault))
}

/// Reads a poses.csv, or another list of poses (see `poses_opk`). A .prj beside it of the same name
/// states the coordinate system where the list does not.
///
/// # Errors
/// With the file and the place in it.
pub fn read_poses(path: &Path) -> Result<PosesFile, FileError> {
    let bytes = read_bytes(path)?;
    let at = |fault| FileError::new(path, fault);
    let system = path.with_extension("prj");
    let system = match system.is_file() {
        true => Some(read_text(&system)?.trim().to_owned()),
        false => None,
    };
    let system = system.filter(|crs| is_stated(crs));
    let mut poses = if poses_opk::is_geojson(&bytes) {
        poses_opk::read_geojson(&bytes).map_err(at)?
    } else if let Ok(text) = text_from_bytes(&bytes)
        && metashape::is_opk(text)
    {
        metashape::read_opk(text).map_err(at)?
    } else if let Ok(text) = text_from_bytes(&bytes)
        && open3d::is_log(text)
    {
        open3d::read_log(text).map_err(at)?
    } else if poses_opk::is_table(&bytes) {
        poses_opk::read_table(&bytes, system.as_deref()).map_err(at)?
    } else {
        poses_csv::read(&bytes).map_err(at)?
    };
    poses.crs = poses.crs.filter(|crs| is_stated(crs)).or(system);
    Ok(poses)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_list_of_control_points_says_what_it_is_for() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gcp_list.txt");
        let text = "EPSG:32633\n500000 5000000 100 320 240 a.jpg\n500010 5000000 101 10 20 a.jpg\n";
        fs::write(&path, text).unwrap();
        let error = read_cloud(&path, &Progress::default()).unwrap_err();
        assert!(
            error
                .fault
                .what
                .contains("ground control points, not a surface"),
            "{error}"
        );
        assert!(error.fault.remedy.contains("--gcp"), "{error}");
    }

    /// As Pix4D writes it for senseFly's photos: names, latitude, longitude and two altitudes, which points have, too.
    #[test]
    fn places_called_as_photos_are_their_positions() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("geoinfo.txt");
        let names =
            "fileName\tlatitude\tlongitude\taltitude_amsl\taltitude_wgs84\theading\tpitch\troll\n";
        let text = format!(
            "#Rev: sensefly/geoinfo/2\n{names}IMG_2166.JPG\t37.5\t139.0\t216.5\t255.8\t149.4\t5.2\t3.9\t\nIMG_2167.JPG\t37.6\t139.0\t216.5\t255.8\t149.4\t5.2\t3.9\t\n"
        );
        fs::write(&path, text).unwrap();
        let fault = read_cloud(&path, &Progress::default()).unwrap_err().fault;
        assert_eq!(
            fault.what,
            "it holds the positions of 2 photos, not a surface"
        );
        assert!(fault.remedy.contains("--positions"), "{fault}");
    }

    #[test]
    fn tables_of_poses_are_no_control_points() {
        let folder = tempfile::tempdir().unwrap();
        for (name, start) in [
            ("a.csv", "photo;x;y;z;tilt;pan\na;1,5;2;3;90;0\n"),
            ("a.tsv", "photo\tx\ty\tz\ttilt\tpan\na\t1\t2\t3\t90\t0\n"),
            (
                "b.csv",
                "filename,latitude,longitude,altitude,roll,pitch,yaw\n",
            ),
            (
                "c.csv",
                "'filename' 'x' 'y' 'z' 'omega' 'phi' 'kappa' 'camera'\n",
            ),
            (
                "d.csv",
                "\"filename\",\"x\",\"y\",\"z\",\"roll\",\"pitch\",\"yaw\"\n",
            ),
        ] {
            let path = folder.path().join(name);
            fs::write(&path, start).unwrap();
            assert_eq!(detect(&path), Ok(Kind::Poses), "{start}");
        }
    }

    #[test]
    fn clouds_are_told_by_their_first_bytes_or_their_name() {
        let folder = tempfile::tempdir().unwrap();
        let cases: [(&str, &[u8], CloudFormat); 10] = [
            ("a.ply", b"ply\nformat", CloudFormat::Ply),
            ("scan.e57.part", b"ASTM-E57\x01", CloudFormat::E57),
            ("a.PCD", b"VERSION .7", CloudFormat::Pcd),
            ("a.pts", b"1\n1 2 3", CloudFormat::Pts),
            ("a.ptx", b"1\n1\n", CloudFormat::Ptx),
            ("a.stl", b"solid", CloudFormat::Stl),
            ("a.gltf", b"{\"asset\": {}}", CloudFormat::Gltf),
            ("model", b"glTF\x02", CloudFormat::Gltf),
            ("dsm", b"MM\0+", CloudFormat::GeoTiff),
            ("dsm.tif", b"II*\0", CloudFormat::GeoTiff),
        ];
        for (name, start, format) in cases {
            let path = folder.path().join(name);
            fs::write(&path, start).unwrap();
            assert_eq!(detect(&path), Ok(Kind::Cloud(format)), "{name}");
            // As a file it is cut off, and said to be so in one line.
            let error = read_cloud(&path, &Progress::default());
            match format {
                CloudFormat::Pts => assert_eq!(error.unwrap().cloud.points.len(), 1),
                _ => assert!(!error.unwrap_err().to_string().contains('\n')),
            }
        }
    }
}

//! Files that others wrote. One file a format; its header comment is the specification it was
//! written from. Here only: what kind a file is, and which reader takes it.
//!
//! A reader turns bytes into the core's types plus a list of warnings. It knows no path: it returns
//! a [`Fault`], and the dispatcher puts the file's name in front.

mod blocks_exchange;
mod bundler;
mod camera_file;
mod candidates;
mod cloud_file;
mod colmap;
mod drone_photos;
mod dropped;
mod e57;
mod effort_table;
mod ept;
mod evidence;
mod fields;
mod flight_poses;
mod georeferencing;
mod geotiff;
mod gltf;
mod grouped_values;
mod info;
mod input;
mod json;
mod json_camera;
mod json_packages;
mod las;
mod leica;
mod meshroom;
mod metashape;
mod middlebury;
mod nerfstudio;
mod nvm;
mod obj;
mod odm;
mod open;
mod open3d;
mod opensfm;
mod opf;
mod origin;
mod package;
mod pcd;
mod photo_checks;
mod photo_files;
mod photo_metadata;
mod photo_names;
mod photo_size;
mod pix4d;
mod ply;
mod polynomial_fisheye;
mod poses_csv;
mod poses_opk;
mod position_list;
mod realitycapture;
mod reconstruction;
mod ros;
mod rounded_rotation;
mod separated;
mod size_distributions;
mod stl;
mod table;
mod text_lines;
mod trajectory;
mod unstated_surface;
mod world_frame;
mod xml_document;
mod xyz;

use fragscale_core::{
    camera, fault, files, flight, geodesy, geometry, georeference, jobs, picture, raster, scale,
    surface, units,
};
use fragscale_fragmentation as fragmentation;

use std::fs;
use std::io::{BufRead, BufReader, Cursor, Read, Seek};
use std::path::{Path, PathBuf};

pub use candidates::{Candidate, candidates};
pub use cloud_file::CloudFile;
pub use dropped::Dropped;
pub use effort_table::{effort_table, read_effort_table};
pub use evidence::{Colours, compare_all_colours, compare_colours, look_up};
pub use georeferencing::{
    GeoreferenceRequest, Georeferenced, KnownDistance, KnownEnds, KnownKind, LengthResidual,
    PositionResidual, georeference,
};
pub use grouped_values::{GroupedValues, Groups, grouped_values, read_grouped_values};
pub use info::info;
pub use input::{FileError, open_file, read_bytes, read_text, text_from_bytes};
pub use open::{FlightReconstruction, OpenOptions, Opened, open_flight};
pub use origin::FlightOrigin;
pub use package::Package;
pub use photo_files::PhotoFile;
pub use poses_csv::{PoseLine, PosesFile};
pub use position_list::{
    ControlPoint, ControlPoints, NamedPosition, PositionList, positions_of_photos,
    read_control_points, read_positions,
};
pub use reconstruction::{MeasuredPosition, Observation, PosedPhoto, Project, Reconstruction};
pub use size_distributions::{
    DistributionColumns, PointWeights, read_point_weights, read_size_distributions,
    size_distributions,
};
pub use table::{NumberRepairs, Row, Table};
pub use trajectory::TrajectoryFormat;

use candidates::{Contents, only_below, several};

use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::jobs::Progress;

/// What a file or folder holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Kind {
    /// A flight.toml, at this path.
    Flight(PathBuf),
    /// Points, perhaps with faces.
    Cloud(CloudFormat),
    /// The calibration of a camera.
    Camera,
    /// The poses of photos: a poses.csv, or what packages write like it.
    Poses,
    /// Poses over time.
    Trajectory(TrajectoryFormat),
    /// A table of size distributions; see [`read_size_distributions`].
    SizeDistributions,
    /// Cameras and posed photos as this package wrote them, in this file or folder.
    Reconstruction(Package, PathBuf),
}

/// A format of clouds and meshes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CloudFormat {
    /// Stanford polygons.
    Ply,
    /// LAS or LAZ.
    Las,
    /// Wavefront.
    Obj,
    /// Points as text.
    Xyz,
    /// Laser scans, ASTM E2807.
    E57,
    /// The Point Cloud Library's.
    Pcd,
    /// Leica's points.
    Pts,
    /// Leica's scans.
    Ptx,
    /// Triangles for stereolithography.
    Stl,
    /// glTF 2.0 as JSON or as .glb.
    Gltf,
    /// An elevation model.
    GeoTiff,
    /// Entwine Point Tile: a folder of LAZ tiles, by its ept.json.
    Ept,
}

impl Kind {
    /// What it holds, for people.
    pub fn in_words(&self) -> &'static str {
        match self {
            Self::Flight(_) => "a flight",
            Self::Cloud(_) => "a cloud or mesh",
            Self::Camera => "a camera calibration",
            Self::Poses => "poses",
            Self::Trajectory(_) => "a trajectory",
            Self::SizeDistributions => "size distributions",
            Self::Reconstruction(package, _) => package.in_words(),
        }
    }
}

/// Everything that can be opened, for messages.
const SUPPORTED: &str = "flight.toml; PLY, LAS, LAZ, E57, PCD, PTS, PTX, OBJ, STL, glTF, GeoTIFF, EPT (ept.json), XYZ/TXT/CSV; what photogrammetry packages write (README lists them); ROS recordings and trajectories; poses.csv; a camera's YAML or XML; a folder of photos; a CSV of size distributions";

/// How many bytes of a file are looked at to tell its kind.
const DETECTED_BY: usize = 4096;

/// Tells what a file or folder holds: by its first bytes where they are distinctive, else by its
/// name.
///
/// # Errors
/// Where it is missing or of no known kind.
pub fn detect(path: &Path) -> Result<Kind, FileError> {
    if path.is_dir() {
        return detect_folder(path);
    }
    let mut start = Vec::new();
    open_file(path)?
        .take(DETECTED_BY as u64)
        .read_to_end(&mut start)
        .map_err(|e| {
            FileError::new(
                path,
                Fault::new(format!("it cannot be read ({e})"), "check the disk"),
            )
        })?;
    if start.is_empty() {
        return Err(FileError::new(
            path,
            Fault::new("it is empty", "export it again"),
        ));
    }
    if let Some((package, path)) = package::of_file(path, &start) {
        return Ok(Kind::Reconstruction(package, path));
    }
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&start);
    for (magic, kind) in [
        (&b"LASF"[..], Kind::Cloud(CloudFormat::Las)),
        (b"ply\n", Kind::Cloud(CloudFormat::Ply)),
        (b"ply\r", Kind::Cloud(CloudFormat::Ply)),
        (b"ASTM-E57", Kind::Cloud(CloudFormat::E57)),
        (b"# .PCD", Kind::Cloud(CloudFormat::Pcd)),
        (b"glTF", Kind::Cloud(CloudFormat::Gltf)),
        (b"II*\0", Kind::Cloud(CloudFormat::GeoTiff)),
        (b"MM\0*", Kind::Cloud(CloudFormat::GeoTiff)),
        (b"II+\0", Kind::Cloud(CloudFormat::GeoTiff)),
        (b"MM\0+", Kind::Cloud(CloudFormat::GeoTiff)),
        (b"%YAML", Kind::Camera),
        (b"<?xml", Kind::Camera),
        (b"<opencv_storage", Kind::Camera),
    ] {
        if text.starts_with(magic) {
            return Ok(kind);
        }
    }
    let name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase();
    if ept::is_header(text, &name) {
        return Ok(Kind::Cloud(CloudFormat::Ept));
    }
    let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
    if matches!(extension, "csv" | "txt" | "tum" | "kitti") {
        let whole = start.len() < DETECTED_BY;
        let text = String::from_utf8_lossy(text);
        if let Some(format) = trajectory::recognise(&text, whole, &name) {
            return Ok(Kind::Trajectory(format));
        }
    }
    if matches!(extension, "csv" | "txt" | "tsv") {
        let whole = start.len() < DETECTED_BY;
        if size_distributions::is_table(&String::from_utf8_lossy(text), whole) {
            return Ok(Kind::SizeDistributions);
        }
    }
    Ok(match extension {
        "toml" => Kind::Flight(path.to_owned()),
        "ply" => Kind::Cloud(CloudFormat::Ply),
        "las" | "laz" => Kind::Cloud(CloudFormat::Las),
        "obj" => Kind::Cloud(CloudFormat::Obj),
        "e57" => Kind::Cloud(CloudFormat::E57),
        "pcd" => Kind::Cloud(CloudFormat::Pcd),
        "pts" => Kind::Cloud(CloudFormat::Pts),
        "ptx" => Kind::Cloud(CloudFormat::Ptx),
        "stl" => Kind::Cloud(CloudFormat::Stl),
        "gltf" | "glb" => Kind::Cloud(CloudFormat::Gltf),
        "tif" | "tiff" => Kind::Cloud(CloudFormat::GeoTiff),
        "yaml" | "yml" | "xml" => Kind::Camera,
        "json" if json_camera::is_camera(&String::from_utf8_lossy(text)) => Kind::Camera,
        "csv" | "txt" | "tsv" if poses_csv::has_photo_column(text) => Kind::Poses,
        "csv" | "txt" | "tsv" if poses_opk::is_table(text) => Kind::Poses,
        "csv" | "txt" if metashape::is_opk(&String::from_utf8_lossy(text)) => Kind::Poses,
        "log" | "txt" if open3d::is_log(&String::from_utf8_lossy(text)) => Kind::Poses,
        "geojson" | "json" if poses_opk::is_geojson(text) => Kind::Poses,
        "csv" | "txt" | "xyz" | "asc" => Kind::Cloud(CloudFormat::Xyz),
        _ => {
            return Err(FileError::new(
                path,
                Fault::new(
                    "a file of no known kind",
                    format!("supported are {SUPPORTED}"),
                ),
            ));
        }
    })
}

fn detect_folder(path: &Path) -> Result<Kind, FileError> {
    let flight = path.join("flight.toml");
    if flight.is_file() {
        return Ok(Kind::Flight(flight));
    }
    let mut meant = Contents::of(path).meant;
    match (meant.pop(), meant.is_empty()) {
        (Some((package, path)), true) => return Ok(Kind::Reconstruction(package, path)),
        (Some(last), false) => {
            meant.push(last);
            return Err(several(path, meant));
        }
        (None, _) => {}
    }
    let of_model = |part: &str| {
        [".bin", ".txt"]
            .iter()
            .any(|end| path.join(format!("{part}{end}")).is_file())
    };
    let parts = ["cameras", "images", "points3D"];
    if parts.into_iter().any(of_model)
        && let Some(missing) = parts.into_iter().find(|part| !of_model(part))
    {
        return Err(FileError::new(
            path,
            Fault::new(
                format!("a COLMAP model without {missing}.bin or {missing}.txt"),
                "copy the whole model",
            ),
        ));
    }
    if path.join(ept::HEADER).is_file() {
        let fault = Fault::new("a folder of a cloud in tiles (EPT)", "open its ept.json");
        return Err(FileError::new(path, fault));
    }
    if let Some(error) = only_below(path) {
        return Err(error);
    }
    let what = match fs::read_dir(path) {
        Ok(_) => "a folder with no flight.toml and no reconstruction in it".to_owned(),
        Err(e) => format!("a folder that cannot be read ({e})"),
    };
    Err(FileError::new(
        path,
        Fault::new(what, format!("supported are {SUPPORTED}")),
    ))
}

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
        .map_err(|fault| FileError::new(path, known_places(path, format).unwrap_or(fault)))
}

/// What to do with a text that is no cloud because it lists places for georeferencing.
fn known_places(path: &Path, format: CloudFormat) -> Option<Fault> {
    if format != CloudFormat::Xyz {
        return None;
    }
    let (what, option) = match (read_control_points(path), read_positions(path)) {
        (Ok(list), _) => (
            format!("{} ground control points", list.points.len()),
            "gcp",
        ),
        (_, Ok(list)) => (
            format!("the positions of {} photos", list.positions.len()),
            "positions",
        ),
        _ => return None,
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
    file.crs = file.crs.filter(|crs| world_frame::is_stated(crs));
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
            let mut project = package::read(package, &at, progress)?;
            let found = &mut project.reconstruction;
            for crs in [&mut found.crs, &mut found.preferred_crs] {
                // An empty text states nothing.
                *crs = crs.take().filter(|crs| world_frame::is_stated(crs));
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
fn read_camera_mount(path: &Path) -> Result<Option<Pose>, FileError> {
    camera_file::read_mount(&read_text(path)?).map_err(|fault| FileError::new(path, fault))
}

/// Reads a trajectory.
fn read_trajectory(
    path: &Path,
    format: TrajectoryFormat,
    progress: &Progress,
) -> Result<trajectory::Trajectory, FileError> {
    progress.stage(format!("reading {}", path.display()));
    let input = BufReader::with_capacity(1 << 18, open_file(path)?);
    trajectory::read(format, input).map_err(|fault| FileError::new(path, fault))
}

/// Reads a poses.csv, or another list of poses (see `poses_opk`). A .prj beside it of the same name
/// states the coordinate system where the list does not.
///
/// # Errors
/// With the file and the place in it.
fn read_poses(path: &Path) -> Result<PosesFile, FileError> {
    let bytes = read_bytes(path)?;
    let at = |fault| FileError::new(path, fault);
    let system = path.with_extension("prj");
    let system = match system.is_file() {
        true => Some(read_text(&system)?.trim().to_owned()),
        false => None,
    };
    let system = system.filter(|crs| world_frame::is_stated(crs));
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
    poses.crs = poses
        .crs
        .filter(|crs| world_frame::is_stated(crs))
        .or(system);
    Ok(poses)
}

#[cfg(test)]
mod tests {
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

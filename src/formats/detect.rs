//! What kind a file or folder is: by its first bytes where they are distinctive, else by its name.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::cameras::json_camera;
use crate::candidates::{meant_in, only_below, several};
use crate::clouds::ept;
use crate::fault::Fault;
use crate::files::{FileError, open_file, unreadable_folder};
use crate::missions;
use crate::packages::{self, DETECTED_BY, Package, colmap, metashape, open3d};
use crate::poses::trajectory::{self, TrajectoryFormat};
use crate::poses::{poses_csv, poses_opk};
use crate::tables::size_distributions;

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
    /// A table of size distributions; see [`read_size_distributions`](crate::read_size_distributions).
    SizeDistributions,
    /// What a drone is told: see [`read_mission`](crate::read_mission).
    Mission,
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
            Self::Mission => "a drone's mission",
            Self::Reconstruction(package, _) => package.in_words(),
        }
    }
}

/// Everything that can be opened, for messages.
const SUPPORTED: &str = "flight.toml; PLY, LAS, LAZ, E57, PCD, PTS, PTX, OBJ, STL, glTF, GeoTIFF, EPT (ept.json), XYZ/TXT/CSV; what photogrammetry packages write (README and docs/flights.md list them); ROS recordings and trajectories; poses.csv; a camera's YAML or XML; a folder of photos; size distributions; missions";

/// Where `fragscale reconstruct` puts the model beside the flight that it makes of it.
pub const MODEL: &str = "reconstruction";

/// What a folder of a reconstruction holds that is not finished yet: what it is of.
pub const UNFINISHED: &str = "unfinished/photos.txt";

/// The same where its photos could not be reconstructed: why, and what to do about it, one line.
pub const FAILED: &str = "unfinished/failed.txt";

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
    if let Some((package, path)) = packages::of_file(path, &start) {
        return Ok(Kind::Reconstruction(package, path));
    }
    if missions::is_mission(path, &start) {
        return Ok(Kind::Mission);
    }
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&start);
    // Numbers in rows, as a cloud's are.
    let is_of_colmap = [
        &b"# Image list with two lines"[..],
        b"# Camera list with one line",
    ];
    if is_of_colmap.iter().any(|magic| text.starts_with(magic))
        && let Some(fault) = path.parent().and_then(colmap::incomplete)
    {
        return Err(FileError::new(path, fault));
    }
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
        "csv" | "txt" | "tsv" if poses_csv::is_table(text) => Kind::Poses,
        "csv" | "txt" | "tsv" if poses_opk::is_table(text) => Kind::Poses,
        "csv" | "txt" if metashape::is_opk(&String::from_utf8_lossy(text)) => Kind::Poses,
        "log" | "txt" if open3d::is_log(&String::from_utf8_lossy(text)) => Kind::Poses,
        "geojson" | "json" if poses_opk::is_geojson(text) => Kind::Poses,
        "csv" | "txt" | "xyz" | "asc" => {
            let whole = start.len() < DETECTED_BY;
            if let Some(rows) = matrix(&String::from_utf8_lossy(text)).filter(|_| whole) {
                let what = format!("a matrix of {rows} x {rows} numbers, no points");
                let remedy = "give a cloud, or a camera's calibration with its photos' size";
                return Err(FileError::new(path, Fault::new(what, remedy)));
            }
            Kind::Cloud(CloudFormat::Xyz)
        }
        _ => {
            let fault = match archive(&start, extension) {
                Some(kind) => Fault::new(
                    format!("{kind}, which is not looked into"),
                    "unpack it first, then open the folder or the file that was in it",
                ),
                None if is_control_of_opensfm(&String::from_utf8_lossy(text)) => Fault::new(
                    "OpenSfM's own list of ground control points, which is not read",
                    "give the gcp_list.txt that it was made of to 'fragscale georeference' as --gcp",
                ),
                None => Fault::new(
                    "a file of no known kind",
                    format!("supported are {SUPPORTED}"),
                ),
            };
            return Err(FileError::new(path, fault));
        }
    })
}

/// Which archive a file is, by its first bytes. Other files are zip inside (.xlsx, .kmz): these are told by their names.
fn archive(start: &[u8], extension: &str) -> Option<&'static str> {
    let is_zip = matches!(extension, "zip" | "");
    let known = [
        (&b"PK\x03\x04"[..], "a zip archive", is_zip),
        (b"7z\xbc\xaf\x27\x1c", "a 7z archive", true),
        (b"Rar!\x1a\x07", "a rar archive", true),
        (b"\x1f\x8b", "a gzip archive", true),
    ];
    let mut archives = known.into_iter();
    let found = archives.find(|(magic, _, named)| *named && start.starts_with(magic));
    found.map(|(_, kind, _)| kind)
}

/// Whether a text is OpenSfM's ground_control_points.json: points with the photos that show them.
fn is_control_of_opensfm(text: &str) -> bool {
    let has = |key: &str| text.contains(key);
    let is_list = text.trim_start().starts_with('{') && has("\"points\"");
    is_list && has("\"observations\"") && has("\"shot_id\"")
}

/// How many rows and columns a text has that is nothing but a camera's matrix (3 x 3) or a pose's (4 x 4). Their last row is what
/// tells them from three or four points.
fn matrix(text: &str) -> Option<usize> {
    let rows = text.lines().map(str::trim).filter(|row| !row.is_empty());
    // Longer ones are none: a cloud is not split into all its numbers for that.
    let rows: Vec<&str> = rows.take(5).collect();
    let size = rows.len();
    let numbers = |row: &str| -> Option<Vec<f64>> {
        let fields = row.split([',', ';', ' ', '\t']);
        let fields = fields.filter(|field| !field.is_empty());
        fields.map(|field| field.parse().ok()).collect()
    };
    let rows: Vec<Vec<f64>> = rows.into_iter().map(numbers).collect::<Option<_>>()?;
    let is_square = (3..=4).contains(&size) && rows.iter().all(|row| row.len() == size);
    let (one, zeros) = rows.last()?.split_last()?;
    let is_last = *one == 1.0 && zeros.iter().all(|zero| *zero == 0.0);
    (is_square && is_last).then_some(size)
}

fn detect_folder(path: &Path) -> Result<Kind, FileError> {
    let flight = path.join("flight.toml");
    if flight.is_file() {
        return Ok(Kind::Flight(flight));
    }
    if path.join(UNFINISHED).is_file() {
        let fault = match fs::read_to_string(path.join(FAILED)) {
            Ok(why) => Fault::new(
                format!("a reconstruction that failed: {why}"),
                "then reconstruct again",
            ),
            Err(_) => Fault::new(
                "a reconstruction that is not finished",
                "reconstruct the same photos into it again: it goes on where it was",
            ),
        };
        return Err(FileError::new(path, fault));
    }
    let mut meant = meant_in(path);
    match (meant.pop(), meant.is_empty()) {
        (Some((package, path)), true) => return Ok(Kind::Reconstruction(package, path)),
        (Some(last), false) => {
            meant.push(last);
            return Err(several(path, meant));
        }
        (None, _) => {}
    }
    if missions::is_mission_folder(path) {
        return Ok(Kind::Mission);
    }
    if let Some(fault) = colmap::incomplete(path) {
        return Err(FileError::new(path, fault));
    }
    if path.join(ept::HEADER).is_file() {
        let fault = Fault::new("a folder of a cloud in tiles (EPT)", "open its ept.json");
        return Err(FileError::new(path, fault));
    }
    if let Some(error) = only_below(path) {
        return Err(error);
    }
    let fault = match fs::read_dir(path) {
        Ok(_) => Fault::new(
            "a folder with no flight.toml and no reconstruction in it",
            format!("supported are {SUPPORTED}"),
        ),
        Err(e) => unreadable_folder(&e),
    };
    Err(FileError::new(path, fault))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// The first bytes are those of the formats' own descriptions (APPNOTE 4.3.7, 7zFormat.txt, RAR 5.0 technote, RFC 1952).
    #[test]
    fn archives_are_to_be_unpacked() {
        let folder = tempfile::tempdir().unwrap();
        for (name, start, what) in [
            ("Flug 31.zip", &b"PK\x03\x04\x14\0"[..], "a zip archive"),
            ("flight", b"PK\x03\x04\x14\0", "a zip archive"),
            ("flight.7z", b"7z\xbc\xaf\x27\x1c\0\x04", "a 7z archive"),
            ("flight.rar", b"Rar!\x1a\x07\x01\0", "a rar archive"),
            ("pile.ply.GZ", b"\x1f\x8b\x08\0", "a gzip archive"),
            ("sizes.xlsx", b"PK\x03\x04\x14\0", "a file of no known kind"),
            ("photo.zip", b"no such thing", "a file of no known kind"),
        ] {
            let path = folder.path().join(name);
            fs::write(&path, start).unwrap();
            let fault = detect(&path).unwrap_err().fault;
            assert!(fault.what.starts_with(what), "{name}: {fault}");
            let unpack = fault.remedy.starts_with("unpack it first");
            assert_eq!(unpack, what.ends_with("archive"), "{name}: {fault}");
        }
    }

    /// The beginning of the list of OpenSfM's data set of Berlin.
    #[test]
    fn control_points_of_opensfm_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ground_control_points.json");
        let text = "{\n    \"points\": [\n        {\n            \"id\": \"1\",\n            \"observations\": [\n                \
            {\"projection\": [0.049848, 0.144291], \"shot_id\": \"02.jpg\"}]}]}";
        fs::write(&path, text).unwrap();
        let fault = detect(&path).unwrap_err().fault;
        assert!(fault.what.starts_with("OpenSfM's own list"), "{fault}");
        assert!(fault.remedy.contains("gcp_list.txt"), "{fault}");
    }

    /// K.txt of the photos of Sceaux, as openMVG's data sets have it, and a pose's matrix.
    #[test]
    fn matrices_are_no_clouds() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("K.txt");
        let of = |text: &str| {
            fs::write(&path, text).unwrap();
            detect(&path)
        };
        for (text, size) in [
            ("2905.88 0 1416 \r\n0 2905.88 1064\r\n0 0 1", 3),
            ("1,0,0,5\n0,1,0,6\n0,0,1,7\n0,0,0,1\n", 4),
        ] {
            let fault = of(text).unwrap_err().fault;
            let said = format!("a matrix of {size} x {size} numbers, no points");
            assert_eq!(fault.what, said);
        }
        let cloud = Ok(Kind::Cloud(CloudFormat::Xyz));
        for points in [
            "1 2 3\n2 2 3\n3 2 3\n",
            "0 0 0\n1 0 0\n0 1 0\n0 0 1\n",
            "x y z\n1 2 3\n2 2 3\n0 0 1\n",
            "1 2 3\n2 2 3\n2 3 3\n4 5 6\n0 0 1\n",
        ] {
            assert_eq!(of(points), cloud, "{points}");
        }
    }
}

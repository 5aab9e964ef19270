//! The XMP sidecars of a folder.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use glam::DVec3;
use roxmltree::Node;

use crate::camera::{Brown, Camera, Distortion, Pose};
use crate::fault::Fault;
use crate::files::{FileError, open_file, read_text};
use crate::packages::reconstruction::{ImageUnit, Origin, Project, Reconstruction, Sizes};
use crate::photos::image_names::{Ending, is_ending};
use crate::text::fields::Fields;
use crate::text::xml_document::{line_of, parse};

use super::{FILM, Lens, add, say_refused};

const NAMESPACE: &str = "capturingreality.com/ns/xcr";
const EXPORT: &str = "export the XMP metadata from RealityCapture again";

/// How many sidecars are looked at: other programs leave some as well.
const LOOKED_AT: usize = 10;

/// Whether one of a folder's first sidecars is RealityCapture's.
pub(crate) fn has_sidecars(folder: &Path) -> bool {
    let files = files(folder);
    let sidecars = files.iter().filter(|path| is_sidecar(path));
    sidecars.take(LOOKED_AT).any(|path| {
        let mut start = Vec::new();
        let read = open_file(path).map(|file| file.take(4096).read_to_end(&mut start));
        matches!(read, Ok(Ok(_))) && String::from_utf8_lossy(&start).contains(NAMESPACE)
    })
}

/// Reads the sidecars of a folder, in the order of their names; the cameras have no sizes yet.
///
/// # Errors
/// Names the sidecar that cannot be read; where none has a pose.
pub(crate) fn read_folder(folder: &Path) -> Result<Project, FileError> {
    let files = files(folder);
    let mut found = Reconstruction {
        package: "realitycapture",
        sizes: Sizes::Unknown {
            unit: ImageUnit::LongerSide,
            principal_points_from: Origin::Middle,
        },
        ..Reconstruction::default()
    };
    let mut without_pose = 0;
    let mut relative = 0;
    let mut refused = Vec::new();
    for path in files.iter().filter(|path| is_sidecar(path)) {
        let text = read_text(path)?;
        // Other programs leave sidecars as well.
        if !text.contains(NAMESPACE) {
            continue;
        }
        let sidecar = Sidecar::read(&text).map_err(|fault| FileError::new(path, fault))?;
        let name = photo_of(path, &files);
        let Some(pose) = sidecar.pose else {
            without_pose += 1;
            continue;
        };
        match sidecar.camera(&name) {
            Ok(camera) => {
                relative += usize::from(!sidecar.is_absolute);
                add(&mut found, name, camera, pose);
            }
            Err(why) => refused.push((name, why)),
        }
    }
    say_refused(&mut found, &refused);
    if without_pose > 0 {
        found.warnings.push(format!(
            "{without_pose} photos have no pose in their sidecars and are left out"
        ));
    }
    if relative > 0 {
        found.warnings.push(format!(
            "{relative} photos' coordinates are not said to be absolute: scale and place are those \
             of a frame of their own"
        ));
    }
    if found.photos.is_empty() {
        let what = match found.warnings.first() {
            Some(warning) => format!("no sidecar has a camera that can be read: {warning}"),
            None => "a folder without RealityCapture's sidecars".to_owned(),
        };
        return Err(FileError::new(folder, Fault::new(what, EXPORT)));
    }
    Ok(Project {
        photos: Some(folder.to_owned()),
        ..Project::from(found)
    })
}

/// A folder's files, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    files.sort();
    files
}

fn is_sidecar(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default();
    ending.eq_ignore_ascii_case("xmp")
}

/// The photo of a sidecar: the file beside it, or else the sidecar's name without its end.
fn photo_of(sidecar: &Path, files: &[PathBuf]) -> String {
    let stem = sidecar.file_stem().unwrap_or_default();
    let is_photo = |file: &Path| {
        let ending = file.extension().unwrap_or_default().to_string_lossy();
        is_ending(&ending, Ending::Raw)
    };
    // Sorted files with one stem stand side by side, but "a-b.jpg" stands between "a.jpg" and "a.xmp".
    let photo = files
        .iter()
        .find(|file| file.file_stem() == Some(stem) && is_photo(file));
    let name = photo.and_then(|photo| photo.file_name()).unwrap_or(stem);
    name.to_string_lossy().into_owned()
}

/// What one sidecar says.
#[derive(Debug, Clone, PartialEq)]
struct Sidecar {
    pose: Option<Pose>,
    is_absolute: bool,
    lens: Option<Lens>,
    model: String,
    /// The skew, and the aspect ratio less 1.
    other: [f64; 2],
}

impl Sidecar {
    fn read(text: &str) -> Result<Self, Fault> {
        let document = parse(text)?;
        let node = document
            .descendants()
            .find(|node| node.has_tag_name("Description") && has_terms(*node))
            .or_else(|| document.descendants().find(|node| has_terms(*node)))
            .ok_or_else(|| Fault::new("it holds nothing of RealityCapture's", EXPORT))?;
        let numbers = |name: &str, count: usize| -> Result<Option<Vec<f64>>, Fault> {
            let Some(text) = term(node, name) else {
                return Ok(None);
            };
            let mut fields = Fields::new(line_of(node), text, EXPORT);
            let numbers: Result<Vec<f64>, Fault> =
                (0..count).map(|_| fields.number(name)).collect();
            match fields.rest() {
                "" => numbers.map(Some),
                _ => Err(fields.fault(format!("{name} has more than {count} numbers"))),
            }
        };
        let number = |name: &str| Ok::<_, Fault>(numbers(name, 1)?.map(|n| n[0]));
        let pose = match (
            numbers("Position", 3)?.as_deref(),
            numbers("Rotation", 9)?.as_deref(),
        ) {
            (Some(&[x, y, z]), Some(&[a, b, c, d, e, f, g, h, i])) => {
                // Its rows are the camera's axes in the world.
                let pose = Pose::from_row_major(DVec3::new(x, y, z), [a, d, g, b, e, h, c, f, i]);
                Some(pose.map_err(|error| {
                    Fault::at(line_of(node), format!("Rotation: {error}"), EXPORT)
                })?)
            }
            _ => None,
        };
        let coefficients = numbers("DistortionCoeficients", 6)?;
        let mut lens = None;
        if let Some(focal) = number("FocalLength35mm")? {
            let mut of_lens = [0.0; 6];
            for (place, value) in of_lens.iter_mut().zip(coefficients.unwrap_or_default()) {
                *place = value;
            }
            lens = Some(Lens {
                focal: focal / FILM,
                principal: [
                    number("PrincipalPointU")?.unwrap_or(0.0),
                    number("PrincipalPointV")?.unwrap_or(0.0),
                ],
                coefficients: of_lens,
            });
        }
        Ok(Self {
            pose,
            is_absolute: term(node, "Coordinates").is_none_or(|said| said == "absolute"),
            lens,
            model: term(node, "DistortionModel")
                .unwrap_or("perspective")
                .to_owned(),
            other: [
                number("Skew")?.unwrap_or(0.0),
                number("AspectRatio")?.unwrap_or(1.0) - 1.0,
            ],
        })
    }

    /// As a camera without size, or, in words, why it cannot be one.
    fn camera(&self, name: &str) -> Result<Camera, String> {
        let lens = self.lens.ok_or("no focal length")?;
        let [skew, aspect] = self.other;
        if skew != 0.0 || aspect != 0.0 {
            return Err(format!(
                "a skew of {skew} and an aspect ratio of {}",
                aspect + 1.0
            ));
        }
        let without = Lens {
            coefficients: [0.0; 6],
            ..lens
        };
        match (self.model.as_str(), lens.coefficients) {
            ("perspective" | "none", _) | (_, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]) => {
                without.camera(name)
            }
            ("brown3" | "brown4" | "brown3t2" | "brown4t2", _) => lens.camera(name),
            ("division", [k1, 0.0, 0.0, 0.0, 0.0, 0.0]) => {
                let rational = Brown::new([0.0, 0.0, 0.0, 0.0, 0.0, k1, 0.0, 0.0]);
                Ok(Camera {
                    distortion: Distortion::Brown(rational),
                    ..without.camera(name)?
                })
            }
            ("division", _) => Err("a division model of more than k1".to_owned()),
            (model, _) => Err(format!(
                "the distortion model '{model}', which cannot be read"
            )),
        }
    }
}

/// Whether an element says something in RealityCapture's namespace.
fn has_terms(node: Node<'_, '_>) -> bool {
    ["FocalLength35mm", "Rotation", "Position", "Version"]
        .iter()
        .any(|name| term(node, name).is_some())
}

/// The text of an attribute or child of RealityCapture's.
fn term<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let attribute = node.attributes().find(|attribute| {
        attribute.name() == name
            && attribute
                .namespace()
                .is_some_and(|ns| ns.contains(NAMESPACE))
    });
    if let Some(attribute) = attribute {
        return Some(attribute.value().trim());
    }
    let child = node.children().find(|child| {
        let tag = child.tag_name();
        tag.name() == name && tag.namespace().is_some_and(|ns| ns.contains(NAMESPACE))
    })?;
    child.text().map(str::trim)
}

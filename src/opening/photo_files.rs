//! The image files of a flight: where they are, and whether their cameras are for their size
//! (contract, section 2, rule 7).

use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};

use image::RgbImage;

use crate::camera::Camera;
use crate::fault::{Fault, Lacking, first_names};
use crate::files::{FileError, read_bytes};
use crate::flight::{Doubt, Photo, PhotoFileState};
use crate::formats::photos::photo_folder::{PhotoFolder, size_of_file};
use crate::formats::{PhotosBelow, Reconstruction};
use crate::picture::decode;

/// The image file of a photo.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PhotoFile {
    /// Where it is, if it is there.
    pub path: Option<PathBuf>,
    /// What is known about it.
    pub state: PhotoFileState,
    /// The photo's size in pixels, where the package names one beside its camera's.
    pub named_size: Option<(u32, u32)>,
    /// Whether the photo's camera may be for a reduced copy of it, as the package is known to make.
    pub may_be_reduced: bool,
}

impl PhotoFile {
    /// The photo's pixels as shot; `None` where its file is not there.
    pub fn pixels(&self) -> Option<Result<RgbImage, FileError>> {
        let path = self.path.as_deref()?;
        let decoded = |bytes: Vec<u8>| decode(&bytes).map_err(|fault| FileError::new(path, fault));
        Some(read_bytes(path).and_then(decoded))
    }
}

/// The photos that lie beside those of a flight and have no pose in it, in words; `None` where there are none.
pub(crate) fn without_pose(files: &[PhotoFile]) -> Option<String> {
    let used: HashSet<&Path> = files.iter().filter_map(|of| of.path.as_deref()).collect();
    let folders: BTreeSet<&Path> = used.iter().filter_map(|path| path.parent()).collect();
    let mut names = Vec::new();
    for folder in folders {
        // A folder that cannot be read has nothing that anybody could miss.
        let photos = PhotosBelow::read(folder).unwrap_or_default().photos;
        let others = photos
            .into_iter()
            .filter(|(_, path)| !used.contains(path.as_path()));
        names.extend(others.map(|(name, _)| name));
    }
    let photos = match names.len() {
        0 => return None,
        1 => "1 photo that lies beside these has no pose, and no scale".to_owned(),
        count => format!("{count} photos that lie beside these have no pose, and no scale"),
    };
    Some(format!("{photos} ({})", first_names(&names)))
}

/// The file of each photo and what is known about it, in their order.
pub(crate) fn files_of(folder: &PhotoFolder<'_>, photos: &[Photo]) -> Vec<PhotoFile> {
    let file_of = |photo: &Photo| {
        if folder.folder.is_none() {
            return PhotoFile::default();
        }
        let path = folder.find(&photo.name);
        let state = match path.as_deref().map(size_of_file) {
            None => PhotoFileState::Missing,
            Some(Ok((width, height))) => PhotoFileState::Found { width, height },
            Some(Err(fault)) => PhotoFileState::Unreadable(fault.to_string()),
        };
        PhotoFile {
            path,
            state,
            ..PhotoFile::default()
        }
    };
    photos.iter().map(file_of).collect()
}

/// Gives the cameras of a package that writes no image sizes those of their photos; `given` is what a
/// flight.toml says. A photo whose file cannot be read, or is missing among others that are there, is
/// left out, which is said in `warnings`.
///
/// # Errors
/// Where no photo's size is known.
pub(crate) fn set_sizes_from_files(
    reconstruction: &mut Reconstruction,
    folder: &PhotoFolder<'_>,
    given: impl Fn(&str) -> Option<(u32, u32)>,
    warnings: &mut Vec<String>,
) -> Result<(), Fault> {
    let mut left_out = Vec::new();
    let mut sizes = Vec::with_capacity(reconstruction.cameras.len());
    for (index, camera) in reconstruction.cameras.iter().enumerate() {
        let photos = reconstruction.photos.iter();
        let mut its = photos.filter(|photo| photo.camera == index).peekable();
        let first = its.peek().map(|photo| photo.name.clone());
        let mut why = None;
        let size = given(&camera.name).or_else(|| {
            its.find_map(|photo| match folder.size_of(&photo.name)? {
                Ok(size) => Some(size),
                Err(fault) => {
                    why = Some(fault.to_string());
                    None
                }
            })
        });
        sizes.push(size);
        if let (None, Some(photo)) = (size, first) {
            let why = why.unwrap_or_else(|| match folder.folder {
                Some(path) => match why_not_found(folder, &photo) {
                    Some(fault) => format!("{}: {fault}", path.display()),
                    None => format!("there is no such image file in {}", path.display()),
                },
                None => "there is no such image file".to_owned(),
            });
            left_out.push((photo, why));
        }
    }
    if !sizes.iter().any(Option::is_some) {
        let (photo, why) = left_out.into_iter().next().unwrap_or_default();
        // A package without the list of its photos has numbers in the place of names.
        if !photo.is_empty() && photo.bytes().all(|byte| byte.is_ascii_digit()) {
            let what = format!(
                "nothing says how its photos are called ('{photo}' is a number), and so neither of what size they are"
            );
            let remedy =
                "put the list of their names beside it, as the package wrote it (list.txt)";
            return Err(Fault::new(what, remedy).for_want_of(Lacking::Photos));
        }
        return Err(Fault::new(
            format!(
                "the image size of '{photo}' is not known: this package writes none, and its file does not tell it ({why})"
            ),
            "give the folder of its photos (--photo-folder, or [photos] folder in a flight.toml), or a [[camera]] table with width and height there",
        )
        .for_want_of(Lacking::Photos));
    }
    for (photo, why) in left_out {
        warnings.push(format!(
            "photo '{photo}' is left out: the package writes no image size, and its file does not tell it ({why})"
        ));
    }
    reconstruction.set_sizes(|camera| sizes.get(camera).copied().flatten());
    Ok(())
}

/// Why the file of a photo is not taken, though the folder has one of its name.
fn why_not_found(folder: &PhotoFolder<'_>, photo: &str) -> Option<Fault> {
    let several = folder.in_several(&[photo]);
    several.or_else(|| folder.dead_links(&[photo]))
}

/// Rescales each camera to the size of its photo files, where those have the same shape; photos of
/// another shape get a trouble. What is done, and what files are missing, is said in `warnings`; of photos with fewer pixels than
/// their camera was calibrated for, that is returned, with their indices: a package that solves on reduced photos leaves files with
/// more.
pub(crate) fn fit_cameras_to_files(
    folder: &PhotoFolder<'_>,
    files: &[PhotoFile],
    cameras: &mut [Camera],
    photos: &mut [Photo],
    warnings: &mut Vec<String>,
) -> Vec<(usize, Doubt)> {
    let mut smaller = Vec::new();
    let Some(path) = folder.folder else {
        return smaller;
    };
    let mut missing = Vec::new();
    let mut sizes = Vec::with_capacity(photos.len());
    for (photo, file) in photos.iter().zip(files) {
        sizes.push(match &file.state {
            PhotoFileState::Found { width, height } => Some((*width, *height)),
            PhotoFileState::Unreadable(fault) => {
                warnings.push(format!(
                    "photo '{}': {fault}; its size is not checked",
                    photo.name
                ));
                None
            }
            PhotoFileState::Missing | PhotoFileState::NotNamed => {
                missing.push(photo.name.as_str());
                None
            }
        });
    }
    if !missing.is_empty() {
        warnings.push(format!(
            "{}: {} of {} image files are missing ({}); their sizes are not checked",
            path.display(),
            missing.len(),
            sizes.len(),
            first_names(&missing)
        ));
        let several = folder.in_several(&missing);
        let dead = folder.dead_links(&missing);
        let why = several.into_iter().chain(dead);
        warnings.extend(why.map(|fault| format!("{}: {fault}", path.display())));
    }
    for (index, camera) in cameras.iter_mut().enumerate() {
        let of_camera = photos
            .iter()
            .zip(&sizes)
            .filter(|(photo, _)| photo.camera == index);
        let of_its_shape = of_camera
            .filter_map(|(_, size)| *size)
            .filter(|(width, height)| camera.rescaled(*width, *height).is_ok());
        // Where no file has its shape, the camera stays as it is, and each photo says why it has no scale.
        let Some(size) = most_common(of_its_shape) else {
            continue;
        };
        let (width, height) = (camera.width, camera.height);
        if size == (width, height) {
            continue;
        }
        if let Ok(rescaled) = camera.rescaled(size.0, size.1) {
            let name = match camera.name.as_str() {
                "" => "the camera".to_owned(),
                name => format!("camera '{name}'"),
            };
            warnings.push(format!(
                "{name} is for {width} x {height}, its photos are {} x {}: its intrinsics are scaled to the photos' size",
                size.0, size.1
            ));
            *camera = rescaled;
            let of_camera = photos.iter().zip(&sizes).enumerate();
            let fewer = of_camera.filter(|(_, (photo, its))| {
                photo.camera == index && **its == Some(size) && size.0 < width
            });
            smaller.extend(fewer.map(|(photo, _)| {
                let calibrated = (width, height);
                (photo, Doubt::SmallerPhotos { size, calibrated })
            }));
        }
    }
    for (photo, size) in photos.iter_mut().zip(sizes) {
        let Some(camera) = cameras.get(photo.camera) else {
            continue;
        };
        if let Some((width, height)) = size
            && (width, height) != (camera.width, camera.height)
        {
            let matter = match camera.rescaled(width, height) {
                Err(error) => error.to_string(),
                Ok(_) => format!(
                    "the photo is {width} x {height}, other photos of its camera are {} x {}",
                    camera.width, camera.height
                ),
            };
            photo.trouble = Some(matter);
        }
    }
    smaller
}

/// The most common size, of equals the first.
fn most_common(sizes: impl Iterator<Item = (u32, u32)>) -> Option<(u32, u32)> {
    let mut counts: HashMap<(u32, u32), (usize, usize)> = HashMap::new();
    for (place, size) in sizes.enumerate() {
        counts.entry(size).or_insert((0, place)).0 += 1;
    }
    counts
        .into_iter()
        .max_by_key(|&(_, (count, place))| (count, std::cmp::Reverse(place)))
        .map(|(size, _)| size)
}

/// Refuses a folder in which photos of the flight lie: pictures beside them would count among them the next time.
///
/// # Errors
/// Where they do.
pub fn apart_from_photos(folder: &Path, photos: &[PhotoFile]) -> Result<(), FileError> {
    let Ok(real) = folder.canonicalize() else {
        // It is made anew.
        return Ok(());
    };
    let lies_there = |path: &Path| {
        let of_photo = path.parent().and_then(|parent| parent.canonicalize().ok());
        of_photo.is_some_and(|of_photo| of_photo == real)
    };
    if !photos
        .iter()
        .any(|photo| photo.path.as_deref().is_some_and(lies_there))
    {
        return Ok(());
    }
    let what = "the flight's photos lie in it, and pictures beside them would be taken for photos";
    let fault = Fault::new(what, "give a folder of its own, as one in it");
    Err(FileError::new(folder, fault))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use image::RgbImage;

    use super::*;
    use crate::camera::{Distortion, Pose};

    /// The camera and its photos then, what is said, and which photos are doubted.
    type Fitted = (Camera, Vec<Photo>, Vec<String>, Vec<(usize, Doubt)>);

    fn fit(camera: (u32, u32), files: &[(u32, u32)]) -> Fitted {
        let folder = tempfile::tempdir().unwrap();
        let mut cameras = [Camera {
            name: "c".to_owned(),
            width: camera.0,
            height: camera.1,
            fx: 100.0,
            fy: 100.0,
            cx: 50.0,
            cy: 25.0,
            skew: 1.0,
            distortion: Distortion::None,
        }];
        let mut photos: Vec<Photo> = (0..=files.len())
            .map(|index| Photo {
                name: format!("a/{index}.png"),
                camera: 0,
                pose: Pose::from_tilt_pan(DVec3::ZERO, [90.0, 0.0]),
                errors: Default::default(),
                package_errors: Default::default(),
                trouble: None,
            })
            .collect();
        // The last photo has no file.
        for (index, (width, height)) in files.iter().enumerate() {
            let path = folder.path().join(format!("{index}.png"));
            RgbImage::new(*width, *height).save(path).unwrap();
        }
        let mut warnings = Vec::new();
        let files = PhotoFolder::new(Some(folder.path()));
        let of_photos = files_of(&files, &photos);
        let smaller =
            fit_cameras_to_files(&files, &of_photos, &mut cameras, &mut photos, &mut warnings);
        let [camera] = cameras;
        (camera, photos, warnings, smaller)
    }

    #[test]
    fn the_camera_follows_the_files_for_all_its_photos() {
        let (camera, photos, warnings, smaller) = fit((100, 50), &[(400, 200), (400, 200)]);
        assert_eq!(smaller, []);
        assert_eq!(
            (camera.width, camera.height, camera.fx, camera.cy),
            (400, 200, 400.0, 100.0)
        );
        assert!(photos.iter().all(|photo| photo.trouble.is_none()));
        assert!(
            warnings.iter().any(|w| w.contains("100 x 50")),
            "{warnings:?}"
        );
        assert!(
            warnings
                .iter()
                .any(|w| w.contains("1 of 3 image files are missing")),
            "{warnings:?}"
        );
    }

    #[test]
    fn another_shape_is_trouble_for_that_photo() {
        let (camera, photos, ..) = fit((100, 50), &[(100, 50), (400, 300), (100, 50), (200, 100)]);
        assert_eq!(camera.width, 100);
        let troubled: Vec<bool> = photos.iter().map(|photo| photo.trouble.is_some()).collect();
        assert_eq!(troubled, [false, true, false, true, false]);
        assert!(
            photos[1]
                .trouble
                .as_ref()
                .unwrap()
                .contains("another shape")
        );
    }

    /// Photos of another camera in the same folder, however many, take no scale from those of the camera's shape.
    #[test]
    fn files_of_another_shape_say_nothing_of_the_camera() {
        let files = [(400, 300), (400, 300), (100, 50), (200, 100), (200, 100)];
        let (camera, photos, ..) = fit((100, 50), &files);
        assert_eq!(camera.width, 200);
        let told = |word: &str| -> Vec<bool> {
            let troubles = photos.iter().map(|photo| photo.trouble.as_deref());
            troubles
                .map(|trouble| trouble.is_some_and(|trouble| trouble.contains(word)))
                .collect()
        };
        assert_eq!(
            told("another shape"),
            [true, true, false, false, false, false]
        );
        assert_eq!(
            told("other photos of its camera"),
            [false, false, true, false, false, false]
        );
        let (camera, ..) = fit((100, 50), &[(400, 300), (80, 70)]);
        assert_eq!(camera.width, 100);
    }

    /// Cropped or made smaller: the file does not tell.
    #[test]
    fn photos_with_fewer_pixels_than_calibrated_are_doubted() {
        let (camera, _, _, smaller) = fit((400, 200), &[(300, 150), (300, 150), (400, 200)]);
        assert_eq!(camera.width, 300);
        let doubt = Doubt::SmallerPhotos {
            size: (300, 150),
            calibrated: (400, 200),
        };
        assert_eq!(smaller, [(0, doubt.clone()), (1, doubt)]);
    }

    /// Bundler's file alone, without the list of its photos.
    #[test]
    fn numbers_in_the_place_of_names() {
        let mut model = crate::covariance::tests::model();
        for (index, photo) in model.photos.iter_mut().enumerate() {
            photo.name = index.to_string();
        }
        let (folder, mut said) = (PhotoFolder::new(None), Vec::new());
        let fault = set_sizes_from_files(&mut model, &folder, |_| None, &mut said).unwrap_err();
        assert!(
            fault
                .what
                .contains("nothing says how its photos are called"),
            "{fault}"
        );
        assert!(fault.remedy.contains("list.txt"), "{fault}");
    }
}

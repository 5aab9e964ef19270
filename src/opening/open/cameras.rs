//! The cameras: those of the `[[camera]]` tables, the sizes that no package wrote, and how they meet
//! their photo files.

use std::path::Path;

use super::source::{Named, Source};
use crate::fault::Fault;
use crate::files::FileError;
use crate::flight::{CameraEntry, CameraSource};
use crate::formats::photos::photo_folder::{PhotoFolder, WantedPhoto};
use crate::formats::{Reconstruction, read_camera};
use crate::photo_files::{PhotoFile, files_of, fit_cameras_to_files, set_sizes_from_files};

/// Reads the cameras of the tables; returns what poses may call each.
pub(super) fn read_tables(
    source: &mut Source,
    path: &Path,
    folder: &Path,
    entries: &[CameraEntry],
) -> Result<Vec<Option<String>>, FileError> {
    let at = |what: String, remedy: &str| FileError::new(path, Fault::new(what, remedy));
    if entries.is_empty() {
        return Err(at(
            "there is no [[camera]]".to_owned(),
            "add one, with a file or inline",
        ));
    }
    let mut names: Vec<Option<String>> = Vec::new();
    for entry in entries {
        let mut camera = match entry
            .source()
            .map_err(|fault| FileError::new(path, fault))?
        {
            CameraSource::File(name) => {
                let file = folder.join(name);
                let camera = read_camera(&file)?;
                source.inputs.push(file);
                camera
            }
            CameraSource::Inline(camera) => camera,
            CameraSource::Size(..) => {
                return Err(at(
                    "a [[camera]] has only a size".to_owned(),
                    "add fx, fy, cx and cy, or name a calibration file",
                ));
            }
        };
        if let Some(warning) = entry.may_mean_others() {
            source.warn(path, &[warning]);
        }
        if let Some(name) = &entry.name {
            camera.name.clone_from(name);
        }
        let name = entry.name.clone().or_else(|| {
            (entries.len() > 1 && !camera.name.is_empty()).then(|| camera.name.clone())
        });
        if entries.len() > 1 && name.is_none() {
            return Err(at(
                "one of several cameras has no name".to_owned(),
                "name each",
            ));
        }
        if names.contains(&name) {
            let name = name.unwrap_or_default();
            return Err(at(
                format!("two cameras are called '{name}'"),
                "give each its own name",
            ));
        }
        names.push(name);
        source.cameras.push(camera);
    }
    Ok(names)
}

/// Gives a reconstruction's cameras their sizes, where the package wrote none: those of the tables, or
/// of the photo files.
///
/// # Errors
/// Where a table says another size than the package, or no size is known.
pub(super) fn take_sizes(
    source: &mut Source,
    path: &Path,
    reconstruction: &mut Reconstruction,
    entries: &[CameraEntry],
) -> Result<(), FileError> {
    let at = |fault| FileError::new(path, fault);
    let sizes = sizes_of_entries(entries).map_err(at)?;
    let given = |name: &str| {
        sizes
            .iter()
            .find(|(camera, _)| camera.is_none_or(|camera| camera == name))
            .map(|(_, size)| *size)
    };
    if reconstruction.sizes.are_known() {
        for camera in &reconstruction.cameras {
            if given(&camera.name).is_some_and(|size| size != (camera.width, camera.height)) {
                let (w, h) = (camera.width, camera.height);
                let what = format!(
                    "camera '{}' is for {w} x {h} in the reconstruction",
                    camera.name
                );
                return Err(at(Fault::new(what, "remove its [[camera]] table")));
            }
        }
    } else {
        let photos = reconstruction.photos.iter();
        let photos: Vec<WantedPhoto<'_>> =
            photos.map(|photo| (photo.name.as_str(), None)).collect();
        let of_photos = source.photo_folder.as_deref();
        let folder = photo_folder(of_photos, source.photo_folder_named, &photos);
        let mut said = Vec::new();
        set_sizes_from_files(reconstruction, &folder, given, &mut said).map_err(at)?;
        source.warn(path, &said);
    }
    Ok(())
}

/// The folder of the photos. One that somebody named for them is looked through with the folders in it.
fn photo_folder<'a>(
    path: Option<&'a Path>,
    named: Named,
    photos: &[WantedPhoto<'_>],
) -> PhotoFolder<'a> {
    match named {
        Named::Now | Named::InFlight => PhotoFolder::named(path, photos),
        Named::ByPackage => PhotoFolder::new(path),
    }
}

/// Finds the photo files, and scales each camera to the size of its own. Where the folder that a flight.toml names is gone, or holds
/// other photos, that is said, and each photo is doubted for its missing file.
///
/// # Errors
/// Where the folder that somebody named just now cannot be the photos'.
pub(super) fn fit(source: &mut Source) -> Result<Vec<PhotoFile>, FileError> {
    let photos = source.photos.iter().enumerate();
    let photos = photos.map(|(index, photo)| {
        let named = source.named_sizes.get(index).copied().flatten();
        let camera = source.cameras.get(photo.camera);
        let size = named.or(camera.map(|camera| (camera.width, camera.height)));
        (photo.name.as_str(), size)
    });
    let photos: Vec<WantedPhoto<'_>> = photos.collect();
    let path = source.photo_folder.as_deref();
    let folder = photo_folder(path, source.photo_folder_named, &photos);
    let mut are_elsewhere = false;
    if let Some(path) = &source.photo_folder
        && source.photo_folder_named != Named::ByPackage
    {
        let names: Vec<&str> = photos.iter().map(|(name, _)| *name).collect();
        match folder.check(&names) {
            Err(fault) if source.photo_folder_named == Named::Now => {
                return Err(FileError::new(path, fault));
            }
            Err(fault) => {
                are_elsewhere = true;
                let said = format!(
                    "{}: {}, where the flight says that its photos are: it is opened without them, and their sizes are not checked ({})",
                    path.display(),
                    fault.what,
                    fault.remedy
                );
                source.warnings.push(said);
            }
            Ok(()) => {
                let chosen = folder.chosen_by_size();
                let said = chosen.map(|said| format!("{}: {said}", path.display()));
                source.warnings.extend(said);
            }
        }
    }
    let mut photo_files = files_of(&folder, &source.photos);
    for (index, file) in photo_files.iter_mut().enumerate() {
        file.named_size = source.named_sizes.get(index).copied().flatten();
        file.may_be_reduced = source.may_be_reduced;
    }
    if are_elsewhere {
        return Ok(photo_files);
    }
    source.photo_doubts.extend(fit_cameras_to_files(
        &folder,
        &photo_files,
        &mut source.cameras,
        &mut source.photos,
        &mut source.warnings,
    ));
    Ok(photo_files)
}

/// The size that a table gives: for the camera that it names, or for all.
type GivenSize<'a> = (Option<&'a str>, (u32, u32));

/// The tables of a flight whose cameras come from a reconstruction hold sizes only.
fn sizes_of_entries(entries: &[CameraEntry]) -> Result<Vec<GivenSize<'_>>, Fault> {
    entries
        .iter()
        .map(|entry| match entry.source()? {
            CameraSource::Size(width, height) => Ok((entry.name.as_deref(), (width, height))),
            CameraSource::File(_) | CameraSource::Inline(_) => Err(Fault::new(
                "a [[camera]] has intrinsics, but the reconstruction brings its own",
                "keep only width and height, or remove the table",
            )),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use crate::jobs::Progress;
    use crate::{OpenOptions, open_flight};

    /// VisualSFM writes no sizes, and has a camera for each photo: where a table says that of one, and nobody has the photos, the other
    /// one cannot be used.
    #[test]
    fn photos_of_a_camera_without_a_size_are_left_out() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let nvm = "NVM_V3\n\n2\na.jpg 100 0 1 0 0 0 0 10 0 0\nb.jpg 100 0 1 0 0 1 0 10 0 0\n\n4\n\
                   -9 -9 0 9 8 7 0\n9 -9 0 9 8 7 0\n-9 9 0 9 8 7 0\n9 9 0 9 8 7 0\n\n0\n";
        fs::write(folder.join("a.nvm"), nvm).unwrap();
        let flight = "format = 1\nworld.unit = \"m\"\nphotos.reconstruction = \"a.nvm\"\n\
                      [[camera]]\nname = \"a.jpg\"\nwidth = 400\nheight = 300\n";
        fs::write(folder.join("flight.toml"), flight).unwrap();
        let opened = open_flight(folder, &OpenOptions::default(), &Progress::default()).unwrap();
        let parts = opened.flight.parts();
        let names: Vec<&str> = parts.photos.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names, ["a.jpg"]);
        let sizes: Vec<(u32, u32)> = parts.cameras.iter().map(|c| (c.width, c.height)).collect();
        assert_eq!(sizes, [(400, 300)]);
        let said = opened.warnings.iter();
        let said: Vec<&String> = said.filter(|said| said.contains("is left out")).collect();
        assert!(
            said.len() == 1 && said[0].contains("photo 'b.jpg' is left out"),
            "{:?}",
            opened.warnings
        );
    }
}

//! Where a flight goes that is made of photos, if nobody says otherwise.

use std::path::{Path, PathBuf};

use super::folder::{FLIGHT, checked};
use crate::files::{self, FileError, Inputs, Kind};

/// Beside the folder of the photos: "NAME flight", or with a number where another flight is there. A folder
/// that a run left unfinished is proposed again, for the next one goes on in it.
pub fn proposed_folder(photos: &Path) -> PathBuf {
    let photos = photos.canonicalize().unwrap_or_else(|_| photos.to_owned());
    let name = name_of(&photos);
    let beside = photos.parent().unwrap_or(&photos);
    let numbered = (2..).map(|number| format!("{name} flight {number}"));
    let mut names = std::iter::once(format!("{name} flight")).chain(numbered);
    let free = names.find(|name| may_be_made(&beside.join(name)));
    beside.join(free.unwrap_or_default())
}

/// Folders that are called so say nothing of the blast that their photos are of.
const PLAIN: [&str; 6] = ["photos", "images", "pictures", "dcim", "jpg", "jpeg"];

/// What a flight of photos in a folder is called: as the folder, or as the one that it lies in where its own name
/// says nothing.
pub fn name_of(photos: &Path) -> String {
    let photos = photos.canonicalize().unwrap_or_else(|_| photos.to_owned());
    let named = |folder: &Path| Some(folder.file_name()?.to_string_lossy().into_owned());
    let own = named(&photos).unwrap_or_default();
    let is_plain = PLAIN.contains(&own.to_lowercase().as_str());
    let above = photos.parent().filter(|_| is_plain).and_then(named);
    above.unwrap_or(own)
}

/// Whether a flight of photos may be made here: a folder that is new, empty, or of a run that did not end.
pub fn may_be_made(folder: &Path) -> bool {
    checked(folder).is_ok()
}

/// The same, said; and that the flight would not lie among its photos.
///
/// # Errors
/// Where it may not be made.
pub fn check_new_folder(folder: &Path, photos: &Path) -> Result<(), FileError> {
    let may_be = checked(folder).and_then(|()| {
        files::may_write(
            &folder.join(FLIGHT),
            Kind::Flight,
            &Inputs::of([photos]),
            false,
        )
    });
    may_be.map_err(|fault| FileError::new(folder, fault))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::jobs::Progress;
    use crate::{Embedded, Request, reconstruct};

    #[test]
    fn a_folder_with_other_things_is_not_proposed() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        let photos = root.join("face 3");
        fs::create_dir(&photos).unwrap();
        let first = root.join("face 3 flight");
        assert_eq!(proposed_folder(&photos), first);
        fs::create_dir(&first).unwrap();
        assert_eq!(proposed_folder(&photos), first, "empty");
        fs::write(first.join("notes.txt"), "mine").unwrap();
        let second = root.join("face 3 flight 2");
        assert_eq!(proposed_folder(&photos), second);
    }

    #[test]
    fn a_plain_folder_is_called_as_the_one_above() {
        let folder = tempfile::tempdir().unwrap();
        let photos = folder.path().join("face 7").join("DCIM");
        fs::create_dir_all(&photos).unwrap();
        assert_eq!(name_of(&photos), "face 7");
        assert_eq!(name_of(photos.parent().unwrap()), "face 7");
        assert!(proposed_folder(&photos).ends_with("face 7/face 7 flight"));
        assert_eq!(name_of(Path::new("/")), "");
    }

    /// What a cancelled run leaves is what the next one goes on with.
    #[test]
    fn an_unfinished_folder_is_proposed_again() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        let photos = root.join("photos");
        fs::create_dir(&photos).unwrap();
        for (level, name) in (1..).zip(["a.png", "b.png", "c.png"]) {
            // No two alike: copies are left out.
            let even = image::GrayImage::from_pixel(64, 48, image::Luma([level]));
            even.save(photos.join(name)).unwrap();
        }
        let to = proposed_folder(&photos);
        let request = Request {
            photos: photos.clone(),
            to: to.clone(),
            crs: None,
            camera: None,
            dense: None,
            card: None,
        };
        // Nothing overlaps: it ends with a fault.
        reconstruct(&request, &Embedded::default(), &Progress::default()).unwrap_err();
        assert!(fs::read_dir(&to).unwrap().next().is_some());
        assert_eq!(proposed_folder(&photos), to);
        fs::write(to.join("flight.toml"), "").unwrap();
        assert_ne!(proposed_folder(&photos), to);
    }
}

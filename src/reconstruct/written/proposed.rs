//! Where a flight goes that is made of photos, if nobody says otherwise.

use std::path::{Path, PathBuf};

use super::folder::checked;

/// Beside the folder of the photos: "NAME flight", or with a number where another flight is there. A folder
/// that a run left unfinished is proposed again, for the next one goes on in it.
pub fn proposed_folder(photos: &Path) -> PathBuf {
    let photos = photos.canonicalize().unwrap_or_else(|_| photos.to_owned());
    let name = photos.file_name().unwrap_or_default().to_string_lossy();
    let beside = photos.parent().unwrap_or(&photos);
    let numbered = (2..).map(|number| format!("{name} flight {number}"));
    let mut names = std::iter::once(format!("{name} flight")).chain(numbered);
    let free = names.find(|name| may_be_made(&beside.join(name)));
    beside.join(free.unwrap_or_default())
}

/// Whether a flight of photos may be made here: a folder that is new, empty, or of a run that did not end.
pub fn may_be_made(folder: &Path) -> bool {
    checked(folder).is_ok()
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
        };
        // Nothing overlaps: it ends with a fault.
        reconstruct(&request, &Embedded, &Progress::default()).unwrap_err();
        assert!(fs::read_dir(&to).unwrap().next().is_some());
        assert_eq!(proposed_folder(&photos), to);
        fs::write(to.join("flight.toml"), "").unwrap();
        assert_ne!(proposed_folder(&photos), to);
    }
}

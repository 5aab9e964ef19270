//! Outlines that another tool made, or a person with it: those of a photo, as they are in the undistorted photo.

use std::path::{Path, PathBuf};

use crate::camera::Camera;
use crate::delineation::leave_out;
use crate::fault::Fault;
use crate::flight::Flight;
use crate::formats::photos::photo_metadata;
use crate::formats::{FileError, MaskFile, Masks, OutlinedPhoto};
use crate::outlines::named_files::{
    candidates, files_below, files_of_many, is_namesake, is_photo, is_told_by_folder,
    may_be_outlines, names, rank, stem,
};
use crate::outlines::turned;
use crate::picture;
use crate::scale::ImageKind;

/// Where outlines are looked for.
#[derive(Debug)]
pub struct OutlinesOfOthers {
    path: PathBuf,
    of: Option<ImageKind>,
    place: Place,
}

#[derive(Debug)]
enum Place {
    File(MaskFile),
    /// A folder's files of many photos each: an export of COCO or CVAT lies in a folder of its own, perhaps beside its photos.
    OfMany(Vec<(PathBuf, MaskFile)>),
    /// The files of a folder, by name.
    Folder(Vec<PathBuf>),
}

impl OutlinesOfOthers {
    /// Reads the file, or lists the folder. `of` is the photo that they were outlined in; without it, fragscale's own files are
    /// of the undistorted photo and all others of the original one.
    ///
    /// # Errors
    /// Where it is neither, or the file has no outlines.
    pub fn open(path: &Path, of: Option<ImageKind>) -> Result<Self, FileError> {
        let place = match path.is_dir() {
            false => Place::File(MaskFile::read(path)?),
            true => {
                let files = files_below(path)?;
                match files_of_many(&files) {
                    Some(of_many) => Place::OfMany(of_many),
                    None => Place::Folder(files),
                }
            }
        };
        let path = path.to_owned();
        Ok(Self { path, of, place })
    }

    /// Whether it has outlines that are said to be of this photo.
    pub fn is_of(&self, name: &str) -> bool {
        match &self.place {
            Place::File(file) if file.is_of_one() => self.is_named_for(&self.path, file, name),
            Place::File(file) => names(file, name),
            Place::OfMany(files) => files.iter().any(|(_, file)| names(file, name)),
            Place::Folder(files) => candidates(files, name).next().is_some(),
        }
    }

    /// All files that may be read.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        let files = match &self.place {
            Place::File(_) => vec![&self.path],
            Place::OfMany(files) => files.iter().map(|(path, _)| path).collect(),
            Place::Folder(files) => files.iter().collect(),
        };
        files.into_iter()
    }

    /// That a file of one photo, which is taken for `name`, is named as the outlines of another of these photos.
    fn named_for_another<'p>(
        &self,
        name: &str,
        mut photos: impl Iterator<Item = &'p str>,
    ) -> Option<String> {
        let Place::File(file) = &self.place else {
            return None;
        };
        // What a file says itself of its photo is said elsewhere.
        if !file.is_of_one() || file.photos().next().is_some() || rank(&self.path, name).is_some() {
            return None;
        }
        let other = photos.find(|other| rank(&self.path, other).is_some())?;
        Some(format!(
            "{} is named as the outlines of {other}",
            self.path.display()
        ))
    }

    /// What of it is of none of these photos, by the names of files in a folder, or of the photos in a file.
    pub fn of_no_photo(&self, photos: &[&str]) -> Vec<String> {
        let of_none = |is_of: &dyn Fn(&str) -> bool| !photos.iter().any(|photo| is_of(photo));
        match &self.place {
            Place::File(file) if file.is_of_one() => Vec::new(),
            Place::File(file) => file
                .photos()
                .filter(|other| of_none(&|photo| stem(photo) == stem(other)))
                .map(str::to_owned)
                .collect(),
            Place::OfMany(files) => (files.iter())
                .flat_map(|(_, file)| file.photos())
                .filter(|other| of_none(&|photo| stem(photo) == stem(other)))
                .map(str::to_owned)
                .collect(),
            Place::Folder(files) => files
                .iter()
                .filter(|path| may_be_outlines(path))
                .filter(|path| {
                    of_none(&|photo| rank(path, photo).is_some() || is_photo(path, photo))
                })
                .filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()))
                .collect(),
        }
    }

    /// The label image of a flight's undistorted photo without what of it is `left_out` (`delineation::photo::left_out`), with what
    /// is to be said about it; `photo_file` is where the photo is, if it is there. `is_only`: no other photo is asked for, so that a file of
    /// one photo is of this one.
    ///
    /// # Errors
    /// Where there is none of this photo, or it cannot be read; the file is named.
    pub fn of_flights_photo(
        &self,
        flight: &Flight,
        (index, photo_file): (usize, Option<&Path>),
        left_out: &[bool],
        is_only: bool,
    ) -> Result<Masks, Fault> {
        let photos = &flight.parts().photos;
        let photo = &photos[index];
        let names = || photos.iter().map(|photo| photo.name.as_str());
        let is_other = |other: &&str| *other != photo.name && is_namesake(other, &photo.name);
        let namesake = names().find(is_other);
        // What cannot be read is said where its pixels are wanted.
        let metadata = photo_file.and_then(|file| photo_metadata::read_file(file).ok());
        let shown = metadata.map_or(1, |metadata| metadata.shown);
        let camera = (flight.camera(photo), shown);
        let mut masks = self.of_photo(&photo.name, namesake, camera, is_only)?;
        leave_out(&mut masks.labels, left_out);
        if is_only {
            let names = names();
            masks
                .notes
                .extend(self.named_for_another(&photo.name, names));
        }
        Ok(masks)
    }

    /// The label image of the undistorted photo, with what is to be said about it. `namesake` is another photo of the flight
    /// whose file has the same name, `shown` how viewers show the photo (EXIF's Orientation). `is_only`: no other photo is asked for, so that
    /// a file of one photo is of this one.
    ///
    /// # Errors
    /// Where there is none of this photo, or it cannot be read, or may be the namesake's; the file is named.
    fn of_photo(
        &self,
        name: &str,
        namesake: Option<&str>,
        (camera, shown): (&Camera, u32),
        is_only: bool,
    ) -> Result<Masks, Fault> {
        let photo = OutlinedPhoto {
            name,
            width: camera.width,
            height: camera.height,
        };
        let named = |path: &Path, fault: Fault| {
            Fault::new(
                FileError::new(path, fault.clone())
                    .to_string()
                    .replace(&format!("; {}", fault.remedy), ""),
                fault.remedy,
            )
        };
        // A file that says a photo's name without its folder is as likely another one's.
        let check_namesake = |is_told: bool| match namesake.filter(|_| !is_told) {
            None => Ok(()),
            Some(other) => Err(Fault::new(
                format!("it may be of {name} or of {other}"),
                "name the photo's folder, too: DIR/NAME_labels.png, DIR_NAME_labels.png, or DIR/NAME in a file of many photos",
            )),
        };
        let mut passed_over = None;
        let read;
        let (path, file) = match &self.place {
            Place::File(file) => {
                if file.is_of_one() && !is_only && !self.is_named_for(&self.path, file, name) {
                    let what = "it has the outlines of one photo, which its name does not say to be this one";
                    let remedy = "name the photo (--photo), or name the file as the photo";
                    return Err(named(&self.path, Fault::new(what, remedy)));
                }
                let is_told = file.is_of_one() && is_only || file.photos().any(|own| own == name);
                (check_namesake(is_told)).map_err(|fault| named(&self.path, fault))?;
                (self.path.as_path(), file)
            }
            Place::OfMany(files) => {
                let exact = files
                    .iter()
                    .find(|(_, file)| file.photos().any(|own| own == name));
                let mut like = files.iter().filter(|(_, file)| names(file, name));
                let (path, file) = match (exact, like.next(), like.next()) {
                    (Some(exact), ..) => exact,
                    (None, Some((one, _)), Some((other, _))) => {
                        let what = format!("{} has outlines of such a photo, too", other.display());
                        let remedy = "give the outlines of this photo in a file of its own";
                        return Err(named(one, Fault::new(what, remedy)));
                    }
                    (None, Some(one), None) => {
                        check_namesake(false).map_err(|fault| named(&one.0, fault))?;
                        one
                    }
                    (None, None, _) => return Err(self.without_it()),
                };
                (path.as_path(), file)
            }
            Place::Folder(files) => {
                let mut candidates = candidates(files, name);
                let path = candidates.next().ok_or_else(|| self.without_it())?;
                check_namesake(is_told_by_folder(path, name))
                    .map_err(|fault| named(path, fault))?;
                passed_over = candidates.next();
                read = MaskFile::read(path).map_err(|error| named(path, error.fault))?;
                (path, &read)
            }
        };
        let is_undistorted = match self.of {
            Some(of) => of == ImageKind::Undistorted,
            None => file.is_own(),
        };
        // What fragscale exports, viewers do not turn.
        let shown = if is_undistorted { 1 } else { shown };
        let mut masks = as_stored(file, &photo, shown).map_err(|fault| named(path, fault))?;
        if let Some(other) = passed_over {
            let file = |path: &Path| {
                path.file_name()
                    .unwrap_or_default()
                    .to_string_lossy()
                    .into_owned()
            };
            masks
                .notes
                .push(format!("{} is taken, not {}", file(path), file(other)));
        }
        if self.of.is_none() {
            let note = match is_undistorted {
                true => "fragscale's own outlines: taken as those of the undistorted photo",
                false => "taken as outlines of the photo as shot, not of the undistorted one",
            };
            masks.notes.push(note.to_owned());
        }
        if !is_undistorted {
            masks.labels = picture::undistorted_labels(&masks.labels, camera);
        }
        Ok(masks)
    }

    fn without_it(&self) -> Fault {
        // The same of all photos: it is said once.
        let what = format!("there are no outlines of it in {}", self.path.display());
        Fault::new(
            what,
            "put them there, named as the photo (NAME_labels.png; no JPEG, which changes numbers)",
        )
    }

    /// Whether the name of a file of one photo, or the photo that it names, is this photo's.
    fn is_named_for(&self, path: &Path, file: &MaskFile, photo: &str) -> bool {
        let same = |other: &str| stem(other).eq_ignore_ascii_case(stem(photo));
        rank(path, photo).is_some() || file.photos().any(same)
    }
}

/// The labels of a photo as its pixels are stored, which viewers show as `shown` says. Outlines of the photo on its side have the sides of
/// the photo swapped, and are turned back; of those that have its size, or none, nobody knows.
fn as_stored(file: &MaskFile, photo: &OutlinedPhoto<'_>, shown: u32) -> Result<Masks, Fault> {
    let verb = turned::in_words(shown);
    let found = file.of_photo(photo);
    if turned::is_on_its_side(shown) && photo.width != photo.height && found.is_err() {
        let on_its_side = OutlinedPhoto {
            width: photo.height,
            height: photo.width,
            ..*photo
        };
        if let Ok(mut masks) = file.of_photo(&on_its_side) {
            masks.labels = turned::as_stored(&masks.labels, shown);
            masks.notes.push(format!(
                "viewers {verb} this photo (EXIF Orientation {shown}), and so are its outlines: they are turned back to its pixels"
            ));
            return Ok(masks);
        }
    }
    let mut masks = found?;
    if shown > 1 {
        masks.notes.push(format!(
            "viewers {verb} this photo (EXIF Orientation {shown}), and its outlines are taken as of its pixels as they are stored: look at \
             them over the photo; where they do not fit, take the mark away (exiftool -n -Orientation=1) and outline it again"
        ));
    }
    Ok(masks)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn files_are_known_by_the_name_of_their_photo() {
        let files = [
            "IMG_0005.jpg",
            "IMG_0005.json",
            "IMG_0005_labels.png",
            "IMG_00051_labels.png",
            "img_0005_full_set_pred.tif",
            "IMG_0005_outlines.png",
            "IMG_0005.png",
        ];
        let files: Vec<PathBuf> = files
            .iter()
            .map(|name| Path::new("masks").join(name))
            .collect();
        let found = |photo: &str| -> Vec<String> {
            let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
            candidates(&files, photo).map(name).collect()
        };
        assert_eq!(
            found("photos/IMG_0005.jpg"),
            [
                "IMG_0005_labels.png",
                "IMG_0005.json",
                "IMG_0005.png",
                "img_0005_full_set_pred.tif"
            ]
        );
        // The photo itself is no outline.
        assert_eq!(found("IMG_0005.png").len(), 3);
        assert!(found("IMG_0006.jpg").is_empty());
        // What is of no photo is named: neither photos nor what lies beside label images.
        let folder = OutlinesOfOthers {
            path: "masks".into(),
            of: None,
            place: Place::Folder(files),
        };
        assert!(folder.is_of("IMG_00051.jpg") && !folder.is_of("IMG_0006.jpg"));
        let of_none = folder.of_no_photo(&["a/IMG_0005.jpg", "b.jpg"]);
        assert_eq!(of_none, ["IMG_00051_labels.png"]);
    }

    /// As Roboflow and CVAT export it: one file of all photos, perhaps beside them.
    #[test]
    fn a_folder_may_hold_one_file_of_many_photos() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        write("DJI_0005.jpg", "a photo");
        write(
            "_annotations.coco.json",
            r#"{"images": [{"id": 1, "file_name": "DJI_0005.jpg", "width": 4, "height": 4}], "categories": [], "annotations": []}"#,
        );
        let open = || OutlinesOfOthers::open(folder.path(), None).unwrap();
        assert!(open().is_of("DJI_0005.jpg"));
        assert!(!open().is_of("DJI_0006.jpg"));
        // Another one, for other photos, in a folder within; and a photo that is a PNG.
        let of = |photo: &str| {
            format!(
                r#"{{"images": [{{"id": 1, "file_name": "{photo}", "width": 4, "height": 4}}], "categories": [], "annotations": []}}"#
            )
        };
        fs::create_dir_all(folder.path().join("annotations")).unwrap();
        write("annotations/instances_default.json", &of("DJI_0007.png"));
        write("DJI_0007.png", "a photo");
        assert!(open().is_of("DJI_0005.jpg") && open().is_of("DJI_0007.png"));
        assert_eq!(open().of_no_photo(&["DJI_0005.jpg"]), ["DJI_0007.png"]);
        // Beside files of single photos their names count.
        write("DJI_0006_labels.png", "a label image");
        assert!(!open().is_of("DJI_0005.jpg"));
        assert!(open().is_of("DJI_0006.jpg"));
    }

    /// Cards have folders of their own, with the same names in each: a name alone tells nothing of which photo it is.
    #[test]
    fn outlines_of_photos_of_one_name_say_their_folder() {
        let folder = tempfile::tempdir().unwrap();
        let camera = Camera {
            name: String::new(),
            width: 4,
            height: 4,
            fx: 4.0,
            fy: 4.0,
            cx: 2.0,
            cy: 2.0,
            skew: 0.0,
            distortion: crate::camera::Distortion::None,
        };
        let mut image = image::GrayImage::new(4, 4);
        image.put_pixel(1, 1, image::Luma([1]));
        let write = |name: &str| {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            image.save(path).unwrap();
        };
        let found = |name: &str, namesake: Option<&str>| {
            let others = OutlinesOfOthers::open(folder.path(), None).unwrap();
            others.of_photo(name, namesake, (&camera, 1), false)
        };
        write("A_labels.png");
        assert!(found("d1/A.jpg", None).is_ok());
        let fault = found("d1/A.jpg", Some("d2/A.jpg")).unwrap_err();
        assert!(
            fault.what.contains("it may be of d1/A.jpg or of d2/A.jpg"),
            "{fault}"
        );
        write("d1/A.png");
        write("d2_A_labels.png");
        assert!(found("d1/A.jpg", Some("d2/A.jpg")).is_ok());
        assert!(found("d2/A.jpg", Some("d1/A.jpg")).is_ok());
        assert!(found("d3/A.jpg", Some("d1/A.jpg")).is_err());
    }

    /// A photo of 6 by 4 that viewers turn: outlined in one that turns it, its outlines are of 4 by 6.
    #[test]
    fn outlines_of_a_photo_on_its_side_are_turned_back() {
        let folder = tempfile::tempdir().unwrap();
        let mut camera = Camera {
            name: String::new(),
            width: 6,
            height: 4,
            fx: 4.0,
            fy: 4.0,
            cx: 2.0,
            cy: 2.0,
            skew: 0.0,
            distortion: crate::camera::Distortion::None,
        };
        let path = folder.path().join("A_labels.png");
        // The stored pixel (1, 0) is shown at the top right, one down.
        let mut image = image::GrayImage::new(4, 6);
        image.put_pixel(3, 1, image::Luma([7]));
        image.save(&path).unwrap();
        let others = OutlinesOfOthers::open(folder.path(), None).unwrap();
        let found = others.of_photo("A.jpg", None, (&camera, 6), false).unwrap();
        assert_eq!(found.labels.labels[1], 7);
        assert!(found.notes.iter().any(|note| note.contains("turned back")));
        assert!(others.of_photo("A.jpg", None, (&camera, 3), false).is_err());
        // Of its own size nobody knows, which is said.
        (camera.width, camera.height) = (4, 6);
        let found = others.of_photo("A.jpg", None, (&camera, 3), false).unwrap();
        let asked = "look at them over the photo";
        assert!(
            found.notes.iter().any(|note| note.contains(asked)),
            "{:?}",
            found.notes
        );
        let plain = others.of_photo("A.jpg", None, (&camera, 1), false).unwrap();
        assert!(!plain.notes.iter().any(|note| note.contains("viewers")));
    }
}

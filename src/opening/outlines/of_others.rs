//! Outlines that another tool made, or a person with it: those of a photo, as they are in the undistorted photo.

use std::path::{Path, PathBuf};

use image::RgbImage;

use crate::camera::Camera;
use crate::delineation::leave_out;
use crate::fault::Fault;
use crate::files::same_name::is_same_stem;
use crate::flight::Flight;
use crate::formats::photos::photo_metadata;
use crate::formats::{FileError, MaskFile, Masks, OutlinedPhoto};
use crate::outlines::followed::not_followed;
use crate::outlines::named_files::{
    also_taken_by, candidates, files_below, files_of_many, folders_shared, has_folder, is_anothers,
    is_namesake, is_photo, is_told_apart, may_be_called, may_be_outlines, names, told, with_photo,
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
                match files_of_many(&files)? {
                    Some(of_many) => Place::OfMany(of_many),
                    None => Place::Folder(files),
                }
            }
        };
        let path = path.to_owned();
        Ok(Self { path, of, place })
    }

    /// Whether it has outlines that are said to be of this photo, among all of the flight.
    pub fn is_of(&self, name: &str, photos: &[&str]) -> bool {
        match &self.place {
            Place::File(file) if file.is_of_one() => self.is_named_for(file, name, photos),
            Place::File(file) => names(&self.path, file, name, photos),
            Place::OfMany(files) => !with_photo(files, name, photos).is_empty(),
            Place::Folder(files) => candidates(files, name, photos).next().is_some(),
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
    fn named_for_another(&self, name: &str, photos: &[&str]) -> Option<String> {
        let Place::File(file) = &self.place else {
            return None;
        };
        // What a file says itself of its photo is said elsewhere.
        let is_named = |photo: &str| self.is_named_for(file, photo, photos);
        if !file.is_of_one() || file.photos().next().is_some() || is_named(name) {
            return None;
        }
        let other = photos.iter().find(|other| is_named(other))?;
        Some(format!(
            "{} is named as the outlines of {other}",
            self.path.display()
        ))
    }

    /// What of it is of none of these photos, by the names of files in a folder, with those of folders within, or of the photos in a
    /// file.
    pub fn of_no_photo(&self, photos: &[&str]) -> Vec<String> {
        let of_none = |is_of: &dyn Fn(&str) -> bool| !photos.iter().any(|photo| is_of(photo));
        match &self.place {
            Place::File(file) if file.is_of_one() => Vec::new(),
            Place::File(file) => file
                .photos()
                .filter(|other| of_none(&|photo| is_same_stem(photo, other)))
                .map(str::to_owned)
                .collect(),
            Place::OfMany(files) => (files.iter())
                .flat_map(|(_, file)| file.photos())
                .filter(|other| of_none(&|photo| is_same_stem(photo, other)))
                .map(str::to_owned)
                .collect(),
            Place::Folder(files) => files
                .iter()
                .filter(|path| may_be_outlines(path))
                .filter(|path| {
                    of_none(&|photo| told(path, photo).is_some() || is_photo(path, photo))
                })
                .map(|path| self.called(path))
                .collect(),
        }
    }

    /// The label image of a flight's undistorted photo without what of it is `left_out` (`delineation::photo::left_out`), with what
    /// is to be said about it; `photo_file` is where the photo is, if it is there, and `pixels` is the undistorted one. `is_only`: no other
    /// photo is asked for, so that a file of one photo is of this one.
    ///
    /// # Errors
    /// Where there is none of this photo, or it cannot be read; the file is named.
    pub fn of_flights_photo(
        &self,
        flight: &Flight,
        (index, photo_file): (usize, Option<&Path>),
        pixels: Option<&RgbImage>,
        left_out: &[bool],
        is_only: bool,
    ) -> Result<Masks, Fault> {
        let photos = &flight.parts().photos;
        let photo = &photos[index];
        let names: Vec<&str> = photos.iter().map(|photo| photo.name.as_str()).collect();
        // What cannot be read is said where its pixels are wanted.
        let metadata = photo_file.and_then(|file| photo_metadata::read_file(file).ok());
        let shown = metadata.map_or(1, |metadata| metadata.shown);
        let camera = (flight.camera(photo), shown);
        let mut masks = self.of_photo(&photo.name, &names, camera, is_only)?;
        leave_out(&mut masks.labels, left_out);
        let not_followed = pixels.and_then(|pixels| not_followed(pixels, &masks.labels));
        masks.notes.extend(not_followed);
        if is_only {
            masks
                .notes
                .extend(self.named_for_another(&photo.name, &names));
        }
        Ok(masks)
    }

    /// The label image of the undistorted photo, with what is to be said about it. `photos` are all of the flight, `shown` is how
    /// viewers show the photo (EXIF's Orientation). `is_only`: no other photo is asked for, so that a file of one photo is of this one.
    ///
    /// # Errors
    /// Where there is none of this photo, or it cannot be read, or may be another one's; the file is named.
    fn of_photo(
        &self,
        name: &str,
        photos: &[&str],
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
        let check = |path: &Path, other: Option<&str>| match other {
            None => Ok(()),
            Some(other) => Err(named(
                path,
                Fault::new(
                    format!("it may be of {name} or of {other}"),
                    "name the photo's folder, too: DIR/NAME_labels.png, DIR_NAME_labels.png, or DIR/NAME in a file of many photos",
                ),
            )),
        };
        // A file that says a photo's name without its folder is as likely another one's of that name.
        let is_other = |other: &&str| *other != name && is_namesake(other, name);
        let namesake = photos.iter().copied().find(is_other);
        let is_exact = |file: &MaskFile| file.photos().any(|own| own == name);
        let mut passed_over = None;
        let read;
        let (path, file) = match &self.place {
            Place::File(file) => {
                let path = self.path.as_path();
                if file.is_of_one() && !is_only && !self.is_named_for(file, name, photos) {
                    let what = "it has the outlines of one photo, which its name does not say to be this one";
                    let remedy = "name the photo (--photo), or name the file as the photo";
                    return Err(named(path, Fault::new(what, remedy)));
                }
                let has_folders = told(path, name).is_some_and(|told| !told.is_by_name_alone);
                let is_told = file.is_of_one() && (is_only || has_folders)
                    || is_exact(file)
                    || is_told_apart(path, name, photos);
                check(path, namesake.filter(|_| !is_told))?;
                (path, file)
            }
            Place::OfMany(files) => {
                let its = with_photo(files, name, photos);
                let mut exact = its.iter().copied().filter(|(_, file)| is_exact(file));
                let shared = |of: &(PathBuf, MaskFile)| folders_shared(&of.0, name);
                let (path, file) = match (exact.next(), &its[..]) {
                    (Some(one), _) => {
                        passed_over = exact.next().map(|(path, _)| path.as_path());
                        one
                    }
                    (None, [one, other, ..]) if shared(one) == shared(other) => {
                        let other = other.0.display();
                        let what = format!("{other} has outlines of such a photo, too");
                        let remedy = "give the outlines of this photo in a file of its own";
                        return Err(named(&one.0, Fault::new(what, remedy)));
                    }
                    (None, [one, rest @ ..]) => {
                        let is_told = is_told_apart(&one.0, name, photos);
                        check(&one.0, namesake.filter(|_| !is_told))?;
                        passed_over = rest.first().map(|(path, _)| path.as_path());
                        *one
                    }
                    (None, []) => return Err(self.without_it()),
                };
                (path.as_path(), file)
            }
            Place::Folder(files) => {
                let mut candidates = candidates(files, name, photos);
                let path = candidates.next().ok_or_else(|| self.without_it())?;
                passed_over = candidates.next();
                // A photo that has no folder is that of the nearest file where its namesakes have others of their own.
                let is_told = told(path, name).is_some_and(|told| told.folders > 0);
                let namesake = namesake.filter(|_| !is_told && has_folder(name));
                let other = also_taken_by(path, files, name, photos).or(namesake);
                check(path, other)?;
                read = MaskFile::read(path).map_err(|error| named(path, error.fault))?;
                (path, &read)
            }
        };
        // As in a file of many photos, the name that stands in it binds.
        let is_another = |stated: &&str| !stated.trim().is_empty() && !may_be_called(name, stated);
        if file.is_of_one()
            && let Some(stated) = file.photos().find(is_another)
        {
            let what = format!("it has no outlines of {name}, but of {stated}");
            let remedy = "give the outlines of this photo; where they are its own, correct the photo's name in the file";
            return Err(named(path, Fault::new(what, remedy)));
        }
        let is_undistorted = match self.of {
            Some(of) => of == ImageKind::Undistorted,
            None => file.is_own(),
        };
        // What fragscale exports, viewers do not turn.
        let shown = if is_undistorted { 1 } else { shown };
        let mut masks = as_stored(file, &photo, shown).map_err(|fault| named(path, fault))?;
        // Among many photos one may have none, which its sizes say.
        if masks.labels.fragments() == 0 && is_only {
            let what = format!("no fragment of {name} is outlined in it, only fines or background");
            let remedy = "give its outlines, or leave the photo out";
            return Err(named(path, Fault::new(what, remedy)));
        }
        if let Some(other) = passed_over {
            let [taken, other] = [path, other].map(|path| self.called(path));
            masks.notes.push(format!("{taken} is taken, not {other}"));
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

    /// What a file of a folder is called, with the folders within that it lies in: cards have the same names in each of theirs.
    fn called(&self, path: &Path) -> String {
        let within = path.strip_prefix(&self.path).unwrap_or(path);
        within.to_string_lossy().replace('\\', "/")
    }

    /// Whether the name of a file of one photo is this photo's before any other of these, or the photo that it names is.
    fn is_named_for(&self, file: &MaskFile, photo: &str, photos: &[&str]) -> bool {
        match told(&self.path, photo) {
            Some(_) => !is_anothers(&self.path, photo, photos),
            None => file.photos().any(|own| is_namesake(own, photo)),
        }
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
mod tests;

//! The control points of a flight, in a file of their own beside its flight.toml: a `gcp_list.txt`, so that other
//! programs and `fragscale georeference --gcp` read it too.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::photo_names::PhotoNames;
use crate::control::ControlList;
use crate::files::{FileError, last_segment};
use crate::formats::{control_list_text, read_control_points};

/// Where the control points of the flight in a flight.toml are: `flight-control-points.txt` beside it.
pub fn control_file(flight_file: &Path) -> PathBuf {
    let stem = flight_file
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy();
    flight_file.with_file_name(format!("{stem}-control-points.txt"))
}

/// Reads a list of control points; its marks are in these photos by the photos' own names. Marks in other photos
/// keep the list's. Returns what had to be assumed, too, one sentence each.
///
/// # Errors
/// As [`read_control_points`].
pub fn read_control(path: &Path, photos: &[&str]) -> Result<(ControlList, Vec<String>), FileError> {
    let read = read_control_points(path)?;
    let (mut list, mut warnings) = (read.list, read.warnings);
    let listed: Vec<String> = (list.points.iter())
        .flat_map(|point| point.marks.iter().map(|(photo, _)| photo.clone()))
        .collect();
    let listed: Vec<&str> = listed.iter().map(String::as_str).collect();
    let names = PhotoNames::new(photos.iter().copied(), &listed);
    let mut strangers = 0;
    for point in &mut list.points {
        for (photo, _) in &mut point.marks {
            match names.find(photo).and_then(|index| photos.get(index)) {
                Some(name) => (*name).clone_into(photo),
                None => strangers += 1,
            }
        }
    }
    if strangers > 0 {
        let all = listed.len();
        warnings.push(format!(
            "{strangers} of {all} marks are in photos that the flight does not have"
        ));
    }
    warnings.extend(names.warning);
    Ok((list, warnings))
}

/// The text of that file: photos are called as their files are, where no two of them are called so.
pub fn control_text(list: &ControlList, photos: &[&str]) -> String {
    let mut called: HashMap<String, usize> = HashMap::new();
    for photo in photos {
        *called
            .entry(last_segment(photo).to_lowercase())
            .or_default() += 1;
    }
    control_list_text(list, |photo| {
        let name = last_segment(photo);
        let is_clear = called.get(&name.to_lowercase()) == Some(&1);
        (if is_clear { name } else { photo }).to_owned()
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::control::ControlPoint;

    #[test]
    fn photos_are_found_by_their_names() {
        let photos = ["a/IMG_1.JPG", "a/IMG_2.JPG", "b/IMG_2.JPG"];
        let marks = photos.map(|photo| (photo.to_owned(), DVec2::new(1.5, 2.5)));
        let list = ControlList {
            points: vec![ControlPoint {
                name: "P1".to_owned(),
                marks: marks.to_vec(),
                position: None,
            }],
            ..ControlList::default()
        };
        let text = control_text(&list, &photos);
        assert!(
            text.contains("\tIMG_1.JPG\t") && text.contains("\tb/IMG_2.JPG\t"),
            "{text}"
        );
        let folder = tempfile::tempdir().unwrap();
        let path = control_file(&folder.path().join("flight.toml"));
        assert!(path.ends_with("flight-control-points.txt"));
        std::fs::write(&path, text).unwrap();
        let (read, warnings) = read_control(&path, &photos).unwrap();
        assert_eq!((read, warnings), (list, Vec::new()));
        let (_, warnings) = read_control(&path, &photos[..1]).unwrap();
        assert!(warnings[0].contains("2 of 3 marks"), "{warnings:?}");
    }
}

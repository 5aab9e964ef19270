//! Names of files that are made of photos: inside their folder, different from each other, fit for every
//! file system.

use std::collections::HashSet;

use crate::files::last_segment;
use crate::flight::Flight;

/// For each photo of a flight a stem of its own, in their order, to build names of files on.
pub fn photo_file_stems(flight: &Flight) -> Vec<String> {
    let photos = flight.parts().photos.iter();
    let names: Vec<&str> = photos.map(|photo| photo.name.as_str()).collect();
    file_names(&names)
        .into_iter()
        .map(|(stem, _)| stem)
        .collect()
}

/// For each photo of a flight a stem and an extension (with its dot, may be empty). The stem is that
/// of the photo's file; where two photos would share it, the folders of their names go in front, and
/// where that is not enough a number behind. Letter case alone makes no difference. The names depend
/// on the whole flight, so that they stay what they are when another selection is exported.
pub(crate) fn file_names(photos: &[&str]) -> Vec<(String, String)> {
    let parts: Vec<(String, String, String)> = photos
        .iter()
        .map(|photo| {
            let last = last_segment(photo);
            let (stem, extension) = match last.rsplit_once('.') {
                Some((stem, extension)) if !stem.is_empty() && !extension.is_empty() => {
                    (stem, format!(".{extension}"))
                }
                _ => (last, String::new()),
            };
            let whole = &photo[..photo.len() - extension.len()];
            let extension = if extension.is_empty() {
                extension
            } else {
                format!(".{}", safe(&extension[1..]))
            };
            (safe(stem), safe(whole), extension)
        })
        .collect();
    let mut count = std::collections::HashMap::new();
    for (stem, _, _) in &parts {
        *count.entry(stem.to_lowercase()).or_insert(0_u32) += 1;
    }
    let mut taken = HashSet::new();
    // Whoever has a stem of its own keeps it, whatever the others turn into.
    for (stem, _, _) in &parts {
        if count[&stem.to_lowercase()] == 1 {
            taken.insert(stem.to_lowercase());
        }
    }
    parts
        .into_iter()
        .map(|(stem, whole, extension)| {
            if count[&stem.to_lowercase()] == 1 {
                return (stem, extension);
            }
            let mut name = whole.clone();
            let mut number = 2;
            while !taken.insert(name.to_lowercase()) {
                name = format!("{whole} ({number})");
                number += 1;
            }
            (name, extension)
        })
        .collect()
}

/// The longest stem, in bytes: file systems take 255 with the extension.
const LONGEST: usize = 200;

/// A name without anything that leads out of a folder or that some file system refuses.
fn safe(name: &str) -> String {
    let mut safe: String = name
        .trim_matches(['/', '\\'])
        .chars()
        .map(|c| match c {
            '/' | '\\' | '<' | '>' | ':' | '"' | '|' | '?' | '*' => '_',
            c if c.is_control() => '_',
            c => c,
        })
        .collect();
    while safe.len() > LONGEST {
        safe.pop();
    }
    // Windows drops dots and spaces at the end; a dot in front hides a file, or leads upwards.
    let safe = safe
        .trim_end_matches(['.', ' '])
        .trim_start_matches(['.', ' ']);
    let lower = safe.to_ascii_lowercase();
    let is_device = ["con", "prn", "aux", "nul"].contains(&lower.as_str())
        || (lower.len() == 4
            && (lower.starts_with("com") || lower.starts_with("lpt"))
            && lower.ends_with(|c: char| c.is_ascii_digit()));
    if safe.is_empty() || is_device {
        return format!("photo_{safe}");
    }
    safe.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(photos: &[&str]) -> Vec<String> {
        let names = file_names(photos).into_iter();
        names.map(|(stem, extension)| stem + &extension).collect()
    }

    #[test]
    fn a_photo_keeps_the_name_of_its_file() {
        assert_eq!(
            names(&["IMG_0001.JPG", "photos/b.jpg", "C:\\fly\\c.tif", "plain"]),
            ["IMG_0001.JPG", "b.jpg", "c.tif", "plain"]
        );
    }

    #[test]
    fn equal_names_are_told_apart() {
        assert_eq!(
            names(&[
                "a/1.jpg",
                "b/1.jpg",
                "c/2.jpg",
                "3.png",
                "3.JPG",
                "3 (2).jpg"
            ]),
            [
                "a_1.jpg",
                "b_1.jpg",
                "2.jpg",
                "3.png",
                "3 (3).JPG",
                "3 (2).jpg"
            ]
        );
        assert_eq!(names(&["x/A.jpg", "y/a.jpg"]), ["x_A.jpg", "y_a.jpg"]);
    }

    #[test]
    fn no_name_leaves_the_folder() {
        let nasty = [
            "../../etc/passwd",
            "/etc/shadow.jpg",
            "..",
            ".",
            "",
            "a/..",
            "..\\..\\x.jpg",
            "CON",
            "a:b?.jpg",
            "nul.jpg",
            "dot.",
            ".hidden",
            "a\n\u{0}b.jpg",
            "com1.png",
            "x./",
        ];
        let names = names(&nasty);
        let mut seen = HashSet::new();
        for (name, photo) in names.iter().zip(nasty) {
            assert!(
                !name.is_empty() && !name.starts_with('.') && !name.ends_with('.'),
                "{photo:?}: {name:?}"
            );
            assert!(
                !name.contains(['/', '\\', ':', '\n', '\0']),
                "{photo:?}: {name:?}"
            );
            assert!(seen.insert(name.to_lowercase()), "{name:?} is there twice");
        }
        let long = file_names(&[&"ü".repeat(500)]);
        assert!(long[0].0.len() <= LONGEST);
    }
}

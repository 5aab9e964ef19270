//! Which photo of a reconstruction a list means.

use std::collections::HashMap;

use crate::files::{last_segment, same_name};
use crate::formats::poses::position_list::number_of_photo;

/// How the names of a list match those of photos: the first of these ways in which any of them do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// The file's name without its folder, whatever its case and whether its accents stand apart.
    Name,
    /// The same without the extension.
    Stem,
    /// The last run of digits in the photo's name, where the list holds nothing but numbers.
    Number,
}

impl Way {
    fn key(self, name: &str) -> Option<String> {
        let name = same_name::key(last_segment(name).trim());
        match self {
            Self::Name => Some(name),
            Self::Stem => Some(match name.rsplit_once('.') {
                Some((stem, _)) if !stem.is_empty() => stem.to_owned(),
                _ => name,
            }),
            Self::Number => number_of_photo(&name).map(|number| number.to_string()),
        }
    }
}

/// The photos of a reconstruction by the names that lists call them.
pub(super) struct PhotoNames {
    way: Way,
    /// By their whole names, which go before all ways.
    whole: HashMap<String, usize>,
    /// `None` for a name that two photos have.
    photos: HashMap<String, Option<usize>>,
    /// How they were matched, where that was not by the whole name.
    pub warning: Option<String>,
}

impl PhotoNames {
    /// Decides on the way in which the names of a list match the photos.
    pub(super) fn new<'a>(photos: impl Iterator<Item = &'a str> + Clone, list: &[&str]) -> Self {
        let whole: HashMap<String, usize> = (photos.clone().enumerate())
            .map(|(index, photo)| (photo.to_owned(), index))
            .collect();
        let of_way = |way: Way| {
            let mut found: HashMap<String, Option<usize>> = HashMap::new();
            for (index, photo) in photos.clone().enumerate() {
                if let Some(key) = way.key(photo) {
                    found
                        .entry(key)
                        .and_modify(|known| *known = None)
                        .or_insert(Some(index));
                }
            }
            let mut names = Self {
                way,
                whole: whole.clone(),
                photos: found,
                warning: None,
            };
            let matched = list
                .iter()
                .filter(|name| names.find(name).is_some())
                .count();
            names.warning = match way {
                Way::Name => None,
                Way::Stem => Some("photos were found by their names without extension".to_owned()),
                Way::Number => Some("photos were found by the numbers in their names".to_owned()),
            };
            (matched > 0).then_some(names)
        };
        let all_numbers = list.iter().all(|name| name.trim().parse::<u32>().is_ok());
        of_way(Way::Name)
            .or_else(|| of_way(Way::Stem))
            .or_else(|| all_numbers.then(|| of_way(Way::Number))?)
            .unwrap_or_else(|| Self {
                way: Way::Name,
                whole: HashMap::new(),
                photos: HashMap::new(),
                warning: None,
            })
    }

    /// The photo that a name of the list means.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        let whole = self.whole.get(name).copied();
        whole.or_else(|| self.photos.get(&self.way.key(name)?).copied().flatten())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(photos: &[&str], list: &[&str]) -> Vec<Option<usize>> {
        let names = PhotoNames::new(photos.iter().copied(), list);
        list.iter().map(|name| names.find(name)).collect()
    }

    #[test]
    fn names_without_folder_case_and_extension() {
        let photos = ["a/IMG_1.JPG", "a\\IMG_2.JPG", "b/IMG_3.JPG", "c/IMG_3.JPG"];
        assert_eq!(
            found(&photos, &["img_2.jpg", "IMG_1.JPG"]),
            [Some(1), Some(0)]
        );
        assert_eq!(found(&photos, &["img_2.tif", "IMG_9"]), [Some(1), None]);
        // Two photos of that name: which is meant is not for us to say.
        assert_eq!(found(&photos, &["IMG_3.JPG", "IMG_1.JPG"]), [None, Some(0)]);
        // One way for a whole list: "IMG_1" beside whole names is another photo.
        assert_eq!(found(&photos, &["IMG_1", "IMG_2.JPG"]), [None, Some(1)]);
    }

    /// Positions of photos in a folder as macOS wrote it, for a model from elsewhere.
    #[test]
    fn accents_apart_are_the_same_letters() {
        let photos = ["a/B\u{f6}schung_1.JPG", "a/Bo\u{308}schung_2.JPG"];
        let list = [
            "Bo\u{308}schung_1.JPG",
            "b\u{f6}schung_2.jpg",
            "Boschung_1.JPG",
        ];
        assert_eq!(found(&photos, &list), [Some(0), Some(1), None]);
        assert_eq!(found(&photos, &["Bo\u{308}schung_1"]), [Some(0)]);
    }

    #[test]
    fn numbers_of_an_mrk() {
        let photos = ["DJI_20230102030405_0002_V.JPG", "DJI_0003.JPG"];
        assert_eq!(found(&photos, &["2", "3", "4"]), [Some(0), Some(1), None]);
        assert_eq!(found(&photos, &["2", "x"]), [None, None]);
    }
}

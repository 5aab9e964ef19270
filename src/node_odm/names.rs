//! What photos are called on a node. A node turns all but letters, digits, `-`, `_` and `.` into underscores, knows
//! no folders, and OpenDroneMap's lists are apart by blanks; so each photo is sent under a name that nobody changes: its
//! file's where that is unique, else with the folders in front of it. Lists of the user's are told in these names,
//! and results are told back in the photos' own.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::io;
use std::path::Path;

use crate::files::last_segment;

/// The photos' names, in their order: their own, and that on the node.
pub(crate) struct Names {
    pairs: Vec<(String, String)>,
}

/// Whether a node leaves it as it is.
fn is_plain(c: char) -> bool {
    c.is_ascii_alphanumeric() || "-_.".contains(c)
}

impl Names {
    /// Of photos with these names.
    pub(crate) fn of<'a>(photos: impl Iterator<Item = &'a str>) -> Self {
        let photos: Vec<&str> = photos.collect();
        let mut called: HashMap<String, usize> = HashMap::new();
        for photo in &photos {
            *called
                .entry(last_segment(photo).to_lowercase())
                .or_default() += 1;
        }
        let proposed = |photo: &str| -> String {
            let last = last_segment(photo);
            let is_unique = called.get(&last.to_lowercase()) == Some(&1);
            let name = if is_unique { last } else { photo };
            (name.chars().map(|c| if is_plain(c) { c } else { '_' })).collect()
        };
        // Whoever keeps its name keeps it whatever others turn into. (Disks may not tell cases apart.)
        let mut taken: HashSet<String> = photos
            .iter()
            .filter(|photo| proposed(photo) == **photo)
            .map(|photo| photo.to_lowercase())
            .collect();
        let pairs = photos.iter().map(|photo| {
            let name = proposed(photo);
            if name == **photo {
                return (name.clone(), name);
            }
            let (stem, ending) = name.rsplit_once('.').unwrap_or((&name, ""));
            let (stem, ending) = (stem.to_owned(), ending.to_owned());
            let mut name = name;
            let mut number = 2;
            while !taken.insert(name.to_lowercase()) {
                name = format!("{stem}_{number}.{ending}");
                number += 1;
            }
            ((*photo).to_owned(), name)
        });
        Self {
            pairs: pairs.collect(),
        }
    }

    /// What the photos are called on the node, in their order.
    pub(crate) fn sent(&self) -> impl Iterator<Item = &str> {
        self.pairs.iter().map(|(_, sent)| sent.as_str())
    }

    /// What a photo is called on the node; what is none of them keeps its name.
    pub(crate) fn of_photo<'a>(&'a self, photo: &'a str) -> &'a str {
        let pair = self.pairs.iter().find(|(ours, _)| ours == photo);
        pair.map_or(photo, |(_, sent)| sent)
    }

    /// A list of the user's in the names of the node, and how many of its lines name a photo: in each line behind
    /// so many fields that are apart by blanks. What names none stays as it is, to the byte.
    pub(crate) fn in_list(&self, list: Vec<u8>, before: usize) -> (Vec<u8>, usize) {
        let mut by_name: HashMap<String, Option<&str>> = HashMap::new();
        for (ours, sent) in &self.pairs {
            let last = last_segment(ours).to_lowercase();
            let known = by_name.entry(last).or_insert(Some(sent));
            if *known != Some(sent) {
                *known = None;
            }
        }
        for (ours, sent) in &self.pairs {
            by_name.insert(ours.to_lowercase(), Some(sent));
        }
        let text = String::from_utf8_lossy(&list);
        let (mut told, mut named, mut is_same) = (String::with_capacity(text.len()), 0, true);
        for line in text.split_inclusive('\n') {
            let Some((start, end, sent)) = named_in(line, before, &by_name) else {
                told += line;
                continue;
            };
            named += 1;
            is_same &= line.get(start..end) == Some(sent);
            told += line.get(..start).unwrap_or_default();
            told += sent;
            told += line.get(end..).unwrap_or_default();
        }
        if is_same {
            return (list, named);
        }
        (told.into_bytes(), named)
    }

    /// Tells the results in a folder in the photos' own names.
    ///
    /// # Errors
    /// What the system says.
    pub(crate) fn tell_back(&self, folder: &Path) -> io::Result<()> {
        let back: HashMap<&str, &str> = (self.pairs.iter())
            .filter(|(ours, sent)| ours != sent)
            .map(|(ours, sent)| (sent.as_str(), ours.as_str()))
            .collect();
        if back.is_empty() {
            return Ok(());
        }
        for name in [
            "opensfm/reconstruction.json",
            "opensfm/reconstruction.topocentric.json",
            "odm_report/shots.geojson",
            "odm_georeferencing/ground_control_points.geojson",
            "images.json",
        ] {
            rewrite(&folder.join(name), |text| strings_told_back(text, &back))?;
        }
        for name in ["opensfm/tracks.csv", "img_list.txt"] {
            rewrite(&folder.join(name), |text| lines_told_back(text, &back))?;
        }
        Ok(())
    }
}

/// Where a line names a photo, and what that is called on the node. (Names may hold blanks.)
fn named_in<'a>(
    line: &str,
    before: usize,
    by_name: &HashMap<String, Option<&'a str>>,
) -> Option<(usize, usize, &'a str)> {
    let mut start = line.len() - line.trim_start().len();
    for _ in 0..before {
        let rest = line.get(start..)?;
        let field = rest.find(char::is_whitespace)?;
        let behind = rest.get(field..)?;
        start += field + behind.len() - behind.trim_start().len();
    }
    let mut end = start + line.get(start..)?.trim_end().len();
    loop {
        let name = line.get(start..end)?.trim_end();
        if name.is_empty() {
            return None;
        }
        if let Some(sent) = by_name.get(&name.to_lowercase()) {
            return sent.map(|sent| (start, start + name.len(), sent));
        }
        end = start + name.rfind(char::is_whitespace)?;
    }
}

fn rewrite(file: &Path, told: impl Fn(&str) -> String) -> io::Result<()> {
    let bytes = match fs::read(file) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(error),
    };
    match std::str::from_utf8(&bytes) {
        Ok(text) => fs::write(file, told(text)),
        // Whoever reads it says what is wrong with it.
        Err(_) => Ok(()),
    }
}

/// A JSON text whose strings are told back; all else stays as it is, numbers to the last digit.
fn strings_told_back(text: &str, back: &HashMap<&str, &str>) -> String {
    let mut told = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((outside, behind)) = rest.split_once('"') {
        told += outside;
        let mut is_escaped = false;
        let end = behind.find(|c| {
            let ends = c == '"' && !is_escaped;
            is_escaped = c == '\\' && !is_escaped;
            ends
        });
        let Some((string, after)) = end.and_then(|end| behind.split_at_checked(end)) else {
            // A string that does not end.
            told.push('"');
            rest = behind;
            break;
        };
        match back.get(string) {
            Some(ours) => told += &serde_json::Value::from(*ours).to_string(),
            None => {
                told.push('"');
                told += string;
                told.push('"');
            }
        }
        rest = after.get(1..).unwrap_or_default();
    }
    told += rest;
    told
}

/// A table whose lines begin with a photo's name.
fn lines_told_back(text: &str, back: &HashMap<&str, &str>) -> String {
    let mut told = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let end = line.find(['\t', '\r', '\n']).unwrap_or(line.len());
        let (name, behind) = line.split_at_checked(end).unwrap_or((line, ""));
        told += back.get(name).unwrap_or(&name);
        told += behind;
    }
    told
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sent(photos: &[&str]) -> Vec<String> {
        let names = Names::of(photos.iter().copied());
        names.sent().map(str::to_owned).collect()
    }

    #[test]
    fn names_are_unique_and_stay_as_they_are() {
        assert_eq!(sent(&["b.JPG", "a-1_2.jpg"]), ["b.JPG", "a-1_2.jpg"]);
        assert_eq!(
            sent(&[
                "100MEDIA/A.JPG",
                "100MEDIA/B.JPG",
                "101MEDIA/B.JPG",
                "101MEDIA/C.JPG"
            ]),
            ["A.JPG", "100MEDIA_B.JPG", "101MEDIA_B.JPG", "C.JPG"]
        );
        // Made plain they may be called as others are.
        assert_eq!(
            sent(&["a b.jpg", "a_b.jpg", "a%b.jpg", "Füße 1.jpg", "x/A B_2.JPG"]),
            [
                "a_b_2.jpg",
                "a_b.jpg",
                "a_b_3.jpg",
                "F__e_1.jpg",
                "A_B_2_2.JPG"
            ]
        );
    }

    #[test]
    fn lists_are_told_in_the_nodes_names() {
        let photos = ["1/a.jpg", "2/a.jpg", "2/b c.jpg"];
        let names = Names::of(photos.into_iter());
        let geo = "EPSG:4326\n1/A.JPG 1 2 3\r\n  b c.jpg 4 5 6\na.jpg 7 8 9\n";
        let (told, named) = names.in_list(geo.as_bytes().to_vec(), 0);
        assert_eq!(
            String::from_utf8(told).unwrap(),
            "EPSG:4326\n1_a.jpg 1 2 3\r\n  b_c.jpg 4 5 6\na.jpg 7 8 9\n"
        );
        assert_eq!(named, 2);
        let control = "EPSG:4326\n1 2 3 10 20 2/a.jpg p1\n1 2 3\n1 2 3\t4  5 b c.jpg";
        let (told, named) = names.in_list(control.as_bytes().to_vec(), 5);
        assert_eq!(
            String::from_utf8(told).unwrap(),
            "EPSG:4326\n1 2 3 10 20 2_a.jpg p1\n1 2 3\n1 2 3\t4  5 b_c.jpg"
        );
        assert_eq!(named, 2);
        // To the byte, whatever its letters are.
        let names = Names::of(["a.jpg"].into_iter());
        let latin = b"EPSG:4326\na.jpg 1 2 \xfc\n".to_vec();
        assert_eq!(names.in_list(latin.clone(), 0), (latin, 1));
    }

    #[test]
    fn results_are_told_back() {
        let back = HashMap::from([("1_a.jpg", "1/a \"x\".jpg")]);
        assert_eq!(
            strings_told_back(
                r#"{"1_a.jpg": [0.10, "1_a.jpg", "\"1_a.jpg", "1_a.jpg\\"]}"#,
                &back
            ),
            r#"{"1/a \"x\".jpg": [0.10, "1/a \"x\".jpg", "\"1_a.jpg", "1_a.jpg\\"]}"#
        );
        assert_eq!(strings_told_back(r#"["1_a.jpg"#, &back), r#"["1_a.jpg"#);
        assert_eq!(
            lines_told_back("v1\n1_a.jpg\t1\t2\nb.jpg\t1_a.jpg\r\n1_a.jpg", &back),
            "v1\n1/a \"x\".jpg\t1\t2\nb.jpg\t1_a.jpg\r\n1/a \"x\".jpg"
        );
    }
}

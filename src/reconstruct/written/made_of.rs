//! What a model is made of, as text beside it: the engine, the calibrations that were given, and a line a photo; by which a later
//! run knows whether it may go on with it.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

use crate::engine::Engine;
use crate::fault::first_names;
use crate::photo_set::PhotoSet;

/// The engine's line, one for each given camera, and for each photo one of its camera, size in bytes and name, and one of where
/// it was taken, if it says so.
pub(super) fn text(photos: &PhotoSet, engine: &dyn Engine) -> String {
    let mut text = format!("{}\n", engine.name());
    for given in photos.cameras.iter().filter(|camera| camera.is_given) {
        // Writing to a text does not fail.
        let _ = writeln!(text, "{:?}", given.camera);
    }
    for photo in &photos.photos {
        let size = fs::metadata(&photo.path).map_or(0, |file| file.len());
        let _ = writeln!(text, "{} {size} {}", photo.camera, photo.name);
        if let Some(place) = photo.place {
            let [x, y, z] = (photos.origin + place.center).to_array();
            let _ = writeln!(text, "{AT}{x:.3} {y:.3} {z:.3} {}", photo.name);
        }
    }
    text
}

/// How what was made `before` is of something else than what is to be made `now`, as words after a comma; `None` where it is not.
pub(super) fn difference(before: &str, now: &str) -> Option<String> {
    if before == now {
        return None;
    }
    let (before, now) = (MadeOf::read(before), MadeOf::read(now));
    if before.photos != now.photos {
        return Some(of_other_photos(&before.photos, &now.photos));
    }
    // Flights of older versions do not say them.
    let says = !before.places.is_empty();
    let of_other = |name: &&&str| before.places.get(**name) != now.places.get(**name);
    let moved: Vec<&str> = (now.photos.keys()).filter(of_other).copied().collect();
    if says && !moved.is_empty() {
        return Some(format!(
            "of photos that say other places now, or of another coordinate system ({})",
            first_names(&moved)
        ));
    }
    if before.engine != now.engine {
        return Some(format!("made by another engine: {}", before.engine));
    }
    if before.cameras == now.cameras && before.of_photos == now.of_photos {
        return None;
    }
    Some(
        match (before.cameras.is_empty(), now.cameras.is_empty()) {
            (true, false) => "whose lens was found, not given",
            (false, true) => "whose lens was given (--camera)",
            (false, false) => "whose lens was given by another calibration",
            (true, true) => "of the same photos as of other cameras",
        }
        .to_owned(),
    )
}

/// The parts of such a text.
struct MadeOf<'a> {
    engine: &'a str,
    cameras: Vec<&'a str>,
    /// Bytes by name.
    photos: BTreeMap<&'a str, u64>,
    /// Cameras by name.
    of_photos: BTreeMap<&'a str, usize>,
    /// Places by name, as text.
    places: BTreeMap<&'a str, &'a str>,
}

impl<'a> MadeOf<'a> {
    fn read(text: &'a str) -> Self {
        let mut lines = text.lines();
        let engine = lines.next().unwrap_or_default();
        let mut made = Self {
            engine,
            cameras: Vec::new(),
            photos: BTreeMap::new(),
            of_photos: BTreeMap::new(),
            places: BTreeMap::new(),
        };
        for line in lines {
            match (photo(line), place(line)) {
                (Some((camera, name, size)), _) => {
                    made.photos.insert(name, size);
                    made.of_photos.insert(name, camera);
                }
                (None, Some((name, place))) => drop(made.places.insert(name, place)),
                (None, None) => made.cameras.push(line),
            }
        }
        made
    }
}

/// What stands before a place.
const AT: &str = "at ";

/// Its camera, name and bytes.
fn photo(line: &str) -> Option<(usize, &str, u64)> {
    let (camera, rest) = line.split_once(' ')?;
    let (size, name) = rest.split_once(' ')?;
    Some((camera.parse().ok()?, name, size.parse().ok()?))
}

/// A photo's name and its place.
fn place(line: &str) -> Option<(&str, &str)> {
    let rest = line.strip_prefix(AT)?;
    let (end, _) = rest.match_indices(' ').nth(2)?;
    Some((&rest[end + 1..], &rest[..end]))
}

fn of_other_photos(before: &BTreeMap<&str, u64>, now: &BTreeMap<&str, u64>) -> String {
    let few = |what: &str, names: Vec<&str>| {
        (!names.is_empty()).then(|| format!("{} {what}: {}", names.len(), first_names(&names)))
    };
    let changed = (now.iter())
        .filter(|(name, size)| before.get(*name).is_some_and(|before| before != *size))
        .map(|(name, _)| *name)
        .collect();
    let differences = [
        few("more now", without(now, before)),
        few("gone", without(before, now)),
        few("changed since", changed),
    ];
    let differences: Vec<String> = differences.into_iter().flatten().collect();
    format!("of other photos ({})", differences.join("; "))
}

/// The names of one that the other lacks.
fn without<'a>(of: &BTreeMap<&'a str, u64>, other: &BTreeMap<&str, u64>) -> Vec<&'a str> {
    let names = of.keys().copied();
    names.filter(|name| !other.contains_key(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a user does: another engine, a photo more, a folder of other photos, a photo edited, a calibration found.
    #[test]
    fn what_differs_is_named() {
        let before =
            "embedded (1.0)\n0 10 a.jpg\n0 20 with space.jpg\nat 1.0 2.0 3.5 with space.jpg\n";
        let difference = |now: &str| difference(before, now);
        assert_eq!(difference(before), None);
        for (now, expected) in [
            (
                "colmap\n0 10 a.jpg\n0 20 with space.jpg\nat 1.0 2.0 3.5 with space.jpg\n",
                "made by another engine: embedded (1.0)",
            ),
            (
                "embedded (1.0)\n0 10 a.jpg\n1 20 with space.jpg\n1 20 c.jpg\n",
                "of other photos (1 more now: c.jpg)",
            ),
            (
                "embedded (1.0)\n0 11 a.jpg\n0 3 b.jpg\n",
                "of other photos (1 more now: b.jpg; 1 gone: with space.jpg; 1 changed since: a.jpg)",
            ),
            (
                "embedded (1.0)\nCamera { name: \"1\" }\n0 10 a.jpg\n0 20 with space.jpg\nat 1.0 2.0 3.5 with space.jpg\n",
                "whose lens was found, not given",
            ),
            (
                "embedded (1.0)\n0 10 a.jpg\n0 20 with space.jpg\nat 1.0 2.0 3.6 with space.jpg\n",
                "of photos that say other places now, or of another coordinate system (with space.jpg)",
            ),
        ] {
            assert_eq!(difference(now).as_deref(), Some(expected));
        }
        // A flight of an older version does not say its places.
        let old = "embedded (1.0)\n0 10 a.jpg\n0 20 with space.jpg\n";
        assert_eq!(super::difference(old, before), None);
    }
}

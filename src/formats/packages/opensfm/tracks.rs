//! OpenSfM's `tracks.csv`: where photos show points.
//!
//! Written from `opensfm/src/map/src/tracks_manager.cc` (`InstanciateFromStreamV0` to `V2`) and
//! OpenSfM's documentation ("Normalized Image Coordinates"). Fields are separated by tabs, and their
//! count must be that of the version:
//!
//! ```text
//! (no first line)            shot track feature x y       r g b
//! OPENSFM_TRACKS_VERSION_v1  shot track feature x y scale r g b
//! OPENSFM_TRACKS_VERSION_v2  shot track feature x y scale r g b segmentation instance
//! ```
//!
//! A track is named as the point it became, where it became one. x, y are normalised: in
//! fragscale's pixels u = s x + w/2, v = s y + h/2, s = max(w, h).

use std::collections::HashMap;

use glam::DVec2;

use crate::fault::Fault;
use crate::packages::reconstruction::{Observation, Reconstruction};

/// The observations that photos of `reconstruction` made of points that `point_index` knows, by the
/// track's name.
pub(super) fn read(
    tracks: &str,
    reconstruction: &Reconstruction,
    point_index: impl Fn(&str) -> Option<u32>,
) -> Result<Vec<Observation>, Fault> {
    let mut frames = HashMap::with_capacity(reconstruction.photos.len());
    for (index, photo) in (0_u32..).zip(&reconstruction.photos) {
        if let Some(camera) = reconstruction.cameras.get(photo.camera) {
            let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
            frames.insert(photo.name.as_str(), (index, size));
        }
    }
    let mut lines = (1_u64..).zip(tracks.lines()).peekable();
    let mut columns = 8;
    if let Some((_, first)) = lines.peek()
        && let Some(version) = first.strip_prefix("OPENSFM_TRACKS_VERSION_")
    {
        columns = match version.trim_end() {
            "v0" => 8,
            "v1" => 9,
            "v2" => 11,
            _ => {
                return Err(Fault::at(
                    1,
                    format!("the tracks are of version \"{version}\"; v0, v1 and v2 are known"),
                    "leave tracks.csv out, or write it with an older OpenSfM",
                ));
            }
        };
        lines.next();
    }
    let mut observations = Vec::new();
    for (line, text) in lines {
        if text.is_empty() {
            continue;
        }
        let count = text.split('\t').count();
        if count != columns {
            return Err(Fault::at(
                line,
                format!("the line has {count} fields; it should have {columns}, separated by tabs"),
                "the file is cut off or damaged: export it again",
            ));
        }
        let mut fields = text.split('\t');
        let mut next = || fields.next().unwrap_or_default();
        let (shot, track, _feature, x, y) = (next(), next(), next(), next(), next());
        let normalized = DVec2::new(number(x, "x", line)?, number(y, "y", line)?);
        if let (Some(&(photo, size)), Some(point)) = (frames.get(shot), point_index(track)) {
            observations.push(Observation {
                photo,
                point,
                pixel: normalized * size.max_element() + size / 2.0,
            });
        }
    }
    Ok(observations)
}

fn number(text: &str, name: &str, line: u64) -> Result<f64, Fault> {
    let value = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
    value.ok_or_else(|| {
        Fault::at(
            line,
            format!("{name} is \"{text}\", not a finite number"),
            "export the tracks again",
        )
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::packages::opensfm;

    fn portrait() -> Reconstruction {
        let json = br#"[{"cameras": {"c": {"focal": 1, "width": 200, "height": 400}},
            "shots": {"a b.jpg": {"camera": "c", "rotation": [0, 0, 0], "translation": [0, 0, 0]}}}]"#;
        opensfm::read(json).unwrap()
    }

    fn read_one(tracks: &str) -> Result<Vec<Observation>, Fault> {
        read(tracks, &portrait(), |track| (track == "t").then_some(4))
    }

    const V2: &str = "OPENSFM_TRACKS_VERSION_v2\n\
                      a b.jpg\tt\t1\t0.25\t-0.5\t0.01\t1\t2\t3\t-1\t-1\n\
                      a b.jpg\tu\t1\t0.25\t-0.5\t0.01\t1\t2\t3\t-1\t-1\n";

    #[test]
    fn every_version_says_the_same() {
        let expected = [Observation {
            photo: 0,
            point: 4,
            pixel: DVec2::new(200.0, 0.0),
        }];
        let v0 = "a b.jpg\tt\t1\t0.25\t-0.5\t1\t2\t3";
        let v1 = "OPENSFM_TRACKS_VERSION_v1\r\na b.jpg\tt\t1\t0.25\t-0.5\t0.01\t1\t2\t3\r\n\r\n";
        for tracks in [v0, &format!("OPENSFM_TRACKS_VERSION_v0\n{v0}"), v1, V2] {
            assert_eq!(read_one(tracks).unwrap(), expected, "{tracks}");
        }
        assert_eq!(read_one("").unwrap(), []);
    }

    #[test]
    fn broken_lines_are_placed() {
        for (tracks, line, named) in [
            ("OPENSFM_TRACKS_VERSION_v3\n", 1, "v3"),
            ("a\tt\t1\t0\t0\t1\t2", 1, "7 fields"),
            (
                "OPENSFM_TRACKS_VERSION_v1\na\tt\t1\t0\t0\t1\t2\t3\n",
                2,
                "8 fields",
            ),
            ("a\tt\t1\t0\tnan\t1\t2\t3", 1, "y is \"nan\""),
            (
                "a\tt\t1\t0\t0\t1\t2\t3\na\tt\t1\tinf\t0\t1\t2\t3",
                2,
                "x is \"inf\"",
            ),
        ] {
            let fault = read_one(tracks).unwrap_err();
            assert_eq!(fault.line, Some(line), "{tracks}");
            assert!(fault.what.contains(named), "{fault}");
        }
    }

    #[test]
    fn truncated_anywhere_it_does_not_panic() {
        for cut in 0..V2.len() {
            let _ = read_one(&V2[..cut]);
        }
    }

    proptest! {
        #[test]
        fn damaged_files_never_panic(at in 0_usize..200, c: char) {
            let place = at % V2.len();
            let damaged = format!("{}{c}{}", &V2[..place], &V2[place + 1..]);
            let _ = read_one(&damaged);
        }
    }
}

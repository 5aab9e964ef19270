//! Photos that show the same rock from two places say where the surface is: the bundled flight, whose true surface is known, and
//! the same with its surface moved, which neither colours nor metadata tell.

use std::fs;
use std::path::Path;

use crate::common::{fragscale, scales_json, stdout_of};

/// Bytes of a vertex in the flight's cloud: three doubles, three bytes of colour.
const VERTEX: usize = 27;

/// Copies the bundled flight with these `heights`, metres, of its cloud's, and without colours.
fn without_colours(folder: &Path, heights: impl Fn(f64) -> f64) {
    let from = Path::new("assets/sample");
    fs::create_dir(folder.join("photos")).expect("made");
    for photo in fs::read_dir(from.join("photos")).expect("listed").flatten() {
        fs::copy(photo.path(), folder.join("photos").join(photo.file_name())).expect("copied");
    }
    for name in ["flight.toml", "ost.yaml", "poses.csv"] {
        fs::copy(from.join(name), folder.join(name)).expect("copied");
    }
    let bytes = fs::read(from.join("pile.ply")).expect("read");
    let end = b"end_header\n";
    let start = bytes.windows(end.len()).position(|window| window == end);
    let start = start.expect("a header") + end.len();
    let mut out = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\nend_header\n",
        (bytes.len() - start) / VERTEX
    )
    .into_bytes();
    for vertex in bytes[start..].chunks_exact(VERTEX) {
        out.extend(&vertex[..16]);
        let z = f64::from_le_bytes(vertex[16..24].try_into().expect("8 bytes"));
        out.extend(heights(z).to_le_bytes());
    }
    fs::write(folder.join("pile.ply"), out).expect("written");
}

/// 3 cm too high under cameras 0.45 m above it, the rock is 0.03 / 0.45 = 6.7 % farther away than the surface; how far two photos of so
/// rough a pile tell, whose stones lie wrongly under the patches besides, to a third.
#[test]
fn a_surface_that_is_too_high_is_seen_farther_away() {
    let folder = tempfile::tempdir().expect("a folder");
    without_colours(folder.path(), |z| z + 0.03);
    let scales = scales_json(folder.path(), &[]);
    let photos = scales["photos"].as_array().expect("photos");
    let mut doubted = 0;
    for photo in photos {
        let reasons = photo["reasons"].to_string();
        let name = photo["photo"].as_str().expect("a name");
        assert_eq!(photo["verdict"], "check", "{name}");
        // Those that do not tell are as doubtful as those that do.
        if !reasons.contains("it and IMG_") {
            let says = "the 6 photos of the flight that do see it ";
            assert!(reasons.contains(says), "{name}: {reasons}");
            continue;
        }
        doubted += 1;
        let (_, said) = reasons.split_once("see the surface ").expect("how far");
        let percent: f64 = said
            .split_once(" %")
            .expect("percent")
            .0
            .parse()
            .expect("a number");
        let true_percent = 100.0 * 0.03 / 0.45;
        assert!(
            (percent / true_percent - 1.0).abs() < 0.34,
            "{name}: {percent}"
        );
    }
    // The first six of nine overlap; the others do not tell.
    assert_eq!(doubted, 6, "{scales}");
}

#[test]
fn a_right_surface_is_seen_where_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    without_colours(folder.path(), |z| z);
    let text = stdout_of(&["check", folder.path().to_str().expect("UTF-8")]);
    let there = text
        .lines()
        .filter(|line| line.contains("it sees the surface where it is, to 0."));
    assert_eq!(there.count(), 6, "{text}");
    let alone = text.lines();
    let alone = alone.filter(|line| line.contains("  compared with nothing"));
    let names: Vec<&str> = alone.map(|line| &line[..12]).collect();
    assert_eq!(names, ["IMG_0007.jpg", "IMG_0008.jpg", "IMG_0009.jpg"]);
    // And what speaks against photos otherwise, as the other commands say it.
    let hole = "IMG_0009.jpg: check: over a hole in the cloud: top right";
    assert!(text.contains(hole), "{text}");
    let scales = scales_json(folder.path(), &[]);
    assert!(!scales.to_string().contains("than it is"), "{scales}");
    // Of two that are trusted and beside none nothing says that they are of this place, which is said.
    let scales = fragscale(&["scales", folder.path().to_str().expect("UTF-8")]);
    let said = String::from_utf8_lossy(&scales.stderr);
    let alone = "2 of 8 trusted photos were compared with nothing (IMG_0007.jpg, IMG_0008.jpg)";
    assert!(said.contains(alone), "{said}");
}

/// Heights with the wrong sign: stones are hollows, by which nothing is alike, and nothing is clearly unlike.
#[test]
fn where_no_photo_tells_none_is_trusted() {
    let folder = tempfile::tempdir().expect("a folder");
    without_colours(folder.path(), |z| 0.08 - z);
    let scales = scales_json(folder.path(), &[]);
    let photos = scales["photos"].as_array().expect("photos");
    let trusted = photos.iter().filter(|photo| photo["verdict"] == "trust");
    assert_eq!(trusted.count(), 0);
    assert!(scales.to_string().contains("none of the 4 photos"));
}

/// Names moved on by one, and two photos swapped, over a cloud without colours: nothing but the photos tells it. Once none was doubted, as
/// close photos of two sides show less than a fifth of each other.
#[test]
fn renamed_photos_over_a_cloud_without_colours_are_doubted() {
    let folder = tempfile::tempdir().expect("a folder");
    without_colours(folder.path(), |z| z);
    let photo = |number: usize| folder.path().join(format!("photos/IMG_000{number}.jpg"));
    let rename = |from: &Path, to: &Path| fs::rename(from, to).expect("renamed");
    let doubted = || -> Vec<usize> {
        let scales = scales_json(folder.path(), &[]);
        let photos = scales["photos"].as_array().expect("photos").clone();
        let reasons = |at: &usize| photos[at - 1]["reasons"].to_string();
        let words = ["alike", "compared with those beside them"];
        let is_doubted = |at: &usize| words.iter().any(|words| reasons(at).contains(words));
        let all = (1..=9).filter(is_doubted);
        all.collect()
    };
    let kept = folder.path().join("kept.jpg");
    rename(&photo(2), &kept);
    rename(&photo(5), &photo(2));
    rename(&kept, &photo(5));
    assert_eq!(doubted(), [2, 5]);
    // Back, then all by one.
    rename(&photo(2), &kept);
    rename(&photo(5), &photo(2));
    rename(&kept, &photo(5));
    rename(&photo(1), &kept);
    (2..=9).for_each(|at| rename(&photo(at), &photo(at - 1)));
    rename(&kept, &photo(9));
    // Six were compared, and the other three are no surer.
    assert_eq!(doubted(), [1, 2, 3, 4, 5, 6, 7, 8, 9]);
}

//! Holds the floors of the house: a module uses its own folder and the floors below it, never one
//! above (see `src/lib.rs`). Between the members of the workspace the compiler holds them; here are
//! the floors of the core, and the list of who may use whom.
//!
//! It reads the paths that begin with `crate::`. Two ways around it are not allowed: in the core
//! `use crate::{...}`, and anywhere `super::super`, which could leave a folder.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    missing_docs,
    reason = "in a test or a benchmark a panic is the report"
)]

#[path = "floors/circles.rs"]
mod circles;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The core's modules and their floors. `fault` is the cellar: a sentence that every floor can say.
const FLOORS: [(&str, i32); 20] = [
    ("fault", -1),
    ("files", 0),
    ("geometry", 0),
    ("jobs", 0),
    ("numbers", 0),
    ("raster", 0),
    ("labels", 1),
    ("split_mix", 0),
    ("toml_text", 0),
    ("units", 0),
    ("camera", 1),
    ("geodesy", 1),
    ("georeference", 1),
    ("surface", 1),
    ("plan", 3),
    ("scale", 2),
    ("survey", 2),
    ("control", 2),
    ("flight", 4),
    ("picture", 3),
];

/// The other members and what they may be built on. Cargo holds that nobody uses what is not in its
/// list; this table, that the lists do not grow unseen.
const MEMBERS: [(&str, &[&str]); 13] = [
    ("core", &[]),
    ("fragmentation", &["core"]),
    ("formats", &["core", "fragmentation"]),
    (
        "opening",
        &["core", "delineation", "formats", "fragmentation"],
    ),
    ("exports", &["core", "delineation", "fragmentation"]),
    ("delineation", &["core", "fragmentation"]),
    ("batch", &["core", "exports", "formats", "opening"]),
    ("render", &["core"]),
    ("dense", &["core", "render"]),
    ("sample", &["core", "exports", "fragmentation", "formats"]),
    (
        "reconstruct",
        &["core", "dense", "exports", "formats", "opening", "render"],
    ),
    ("node_odm", &["core", "formats", "opening", "reconstruct"]),
    (
        "app",
        &[
            "batch",
            "core",
            "delineation",
            "exports",
            "formats",
            "fragmentation",
            "node-odm",
            "opening",
            "reconstruct",
            "render",
        ],
    ),
];

fn floor(module: &str) -> i32 {
    let known = FLOORS.iter().find(|(name, _)| *name == module);
    known
        .unwrap_or_else(|| panic!("module '{module}' has no floor; give it one"))
        .1
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// The modules named behind `crate::` in code (not in comments).
fn used(text: &str) -> Vec<String> {
    let code = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default());
    let mut names = Vec::new();
    for line in code {
        for (at, _) in line.match_indices("crate::") {
            let rest = &line[at + "crate::".len()..];
            names.push(
                rest.chars()
                    .take_while(|c| c.is_alphanumeric() || *c == '_')
                    .collect(),
            );
        }
    }
    names
}

#[test]
fn nobody_reaches_up() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    assert!(files.len() > 20, "the sources were not found");
    for path in files {
        let inside = path.strip_prefix(&src).expect("below src");
        let first = inside.iter().next().expect("a name").to_string_lossy();
        let module = first.strip_suffix(".rs").unwrap_or(&first).to_owned();
        let text = fs::read_to_string(&path).expect("a source");
        assert!(
            !text.contains("super::super"),
            "{}: super::super",
            path.display()
        );
        let in_core = FLOORS.iter().any(|(name, _)| *name == module);
        for name in used(&text) {
            if in_core {
                assert!(
                    !name.is_empty(),
                    "{}: write `use crate::module` out",
                    path.display()
                );
                let (own, its) = (floor(&module), floor(&name));
                assert!(
                    its < own || name == module,
                    "{}: {module} on floor {own} uses {name} on floor {its}",
                    path.display()
                );
            }
        }
    }
}

#[test]
fn members_are_built_on_what_lies_below() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for (member, allowed) in MEMBERS {
        let path = src.join(member).join("Cargo.toml");
        let manifest = fs::read_to_string(&path).expect("a manifest");
        let normal = manifest.split("[dependencies]").nth(1).expect("a list");
        let normal = normal.split("\n[").next().unwrap_or_default();
        let mut its: Vec<&str> = normal
            .lines()
            .filter_map(|line| line.strip_prefix("fragscale-"))
            .map(|line| line.split(['.', ' ']).next().unwrap_or_default())
            .collect();
        its.sort_unstable();
        let mut allowed = allowed.to_vec();
        allowed.sort_unstable();
        assert_eq!(its, allowed, "{}", path.display());
    }
}

/// Floors 0 to 3 take no paths, keep no f32, know no clock.
#[test]
fn the_core_stays_pure() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    for (module, floor) in FLOORS {
        let folder = src.join(module);
        // Paths are what that one is about; a job says every now and then how far it is.
        if floor > 3 || ["files", "jobs"].contains(&module) {
            continue;
        }
        match folder.is_dir() {
            true => sources(&folder, &mut files),
            false => files.push(folder.with_extension("rs")),
        }
    }
    for path in files {
        let text = fs::read_to_string(&path).expect("a source");
        for word in ["std::path", "std::fs", "std::time", "f32", "println!"] {
            // Colours and strokes are no measurements, and the words of a library's messages none either.
            let is_no_measure =
                ["picture", "toml_text.rs"].map(|own| path.starts_with(src.join(own)));
            if word == "f32" && is_no_measure.contains(&true) {
                continue;
            }
            assert!(!text.contains(word), "{} uses {word}", path.display());
        }
    }
}

/// One rule for all that is written, in one place (`src/files/overwrite.rs`).
#[test]
fn nobody_writes_past_the_rule() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    for path in files {
        let inside = path.strip_prefix(&src).expect("below src");
        let name = inside.to_string_lossy().replace('\\', "/");
        // The rule itself; and a folder with a list of its own files.
        let own = name.starts_with("files/")
            || name.starts_with("test_data/")
            || name == "exports/split_desktop/folder.rs"
            // What streams in from a node, into a folder of its own, has its names told back there, and goes to its place.
            || name == "node_odm/place.rs"
            || name == "node_odm/names.rs";
        let text = fs::read_to_string(&path).expect("a source");
        let is_test = name.ends_with("/tests.rs") || name.contains("/tests/");
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        for word in [
            "write_whole(",
            "fs::write(",
            "File::create(",
            "fs::rename(",
            "fs::copy(",
            "OpenOptions::new(",
        ] {
            // The simulated flight is made in a new folder, which is moved into its place; what a
            // reconstruction has found so far replaces what it had, in a folder of its own; the log of
            // frames grows with them, and is asked for first; the lock of a season is empty; what engines are developed with is no program of
            // the user's.
            let apart = word == "fs::write(" && name == "sample/lib.rs"
                || word == "fs::rename(" && name == "reconstruct/embedded/features.rs"
                || word == "File::create(" && name == "app/frame_times.rs"
                || word == "OpenOptions::new(" && name == "batch/results.rs"
                || (word == "File::create(" || word == "fs::write(")
                    && name == "opening/examples/develop/main.rs";
            assert!(
                own || is_test || apart || !code.contains(word),
                "{name} has {word}): files::write keeps what was read"
            );
        }
    }
}

/// A room with more files than one looks over at once has rooms inside.
#[test]
fn no_folder_has_more_than_fifteen_files() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    let mut rooms: BTreeMap<&Path, usize> = BTreeMap::new();
    for file in files.iter().filter(|file| !file.ends_with("tests.rs")) {
        *rooms.entry(file.parent().expect("a folder")).or_default() += 1;
    }
    for (room, count) in rooms {
        let is_of_tests = room.ends_with("tests");
        assert!(
            is_of_tests || count <= 15,
            "{}: {count} files",
            room.display()
        );
    }
}

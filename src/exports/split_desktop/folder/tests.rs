//! What is ours in a folder is kept, replaced or taken away, and what is of others stays.

use std::sync::LazyLock;

use super::*;
use crate::other_flight_in;

static NOTHING_READ: LazyLock<Inputs> = LazyLock::new(Inputs::default);

fn open(folder: &Path, planned: &[&str]) -> Result<ExportFolder<'static>, FileError> {
    let read = &NOTHING_READ;
    open_for("flight.toml", read, Replace::Nothing, folder, planned)
}

fn open_for<'a>(
    flight: &str,
    read: &'a Inputs,
    replace: Replace,
    folder: &Path,
    planned: &[&str],
) -> Result<ExportFolder<'a>, FileError> {
    let planned: Vec<String> = planned.iter().map(|&name| name.to_owned()).collect();
    let flight = FlightOfExport::new("a flight", Path::new(flight), folder);
    let progress = Progress::default();
    ExportFolder::open(folder, &flight, read, replace, &planned, &progress)
}

fn file(name: &str, text: &str) -> (String, Vec<u8>) {
    (name.to_owned(), text.as_bytes().to_vec())
}

#[test]
fn what_is_done_is_known_again() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("new/export");
    let name = ["photos/a.jpg".to_owned()];
    let mut first = open(&folder, &["photos/a.jpg"]).unwrap();
    assert!(!first.is_done(&name, "x"));
    first
        .write(&[file("photos/a.jpg", "one")], Some("x"))
        .unwrap();
    let again = open(&folder, &["photos/a.jpg"]).unwrap();
    assert!(again.is_done(&name, "x") && !again.is_done(&name, "y"));
    fs::remove_file(folder.join("photos/a.jpg")).unwrap();
    assert!(
        !open(&folder, &["photos/a.jpg"])
            .unwrap()
            .is_done(&name, "x")
    );
}

#[test]
fn files_of_others_are_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scales.csv"), "mine").unwrap();
    let error = open(folder.path(), &["photos/a.jpg", "scales.csv"])
        .err()
        .unwrap();
    assert!(
        error
            .to_string()
            .contains("scales.csv: it is there already"),
        "{error}"
    );
    // Nothing was made.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    // Others beside ours do not matter.
    open(folder.path(), &["a.txt"])
        .unwrap()
        .write(&[file("a.txt", "1")], None)
        .unwrap();
    fs::write(folder.path().join("a.txt"), "edited").unwrap();
    let error = open(folder.path(), &["a.txt"]).err().unwrap();
    assert!(error.to_string().contains("was changed"), "{error}");
    fs::write(folder.path().join("export.json"), "{}").unwrap();
    assert!(open(folder.path(), &["b.txt"]).is_err());
    assert_eq!(fs::read(folder.path().join("scales.csv")).unwrap(), b"mine");
}

#[test]
fn an_interrupt_between_the_list_and_the_file_can_be_gone_on_from() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");
    open(folder.path(), &["a.txt"])
        .unwrap()
        .write(&[file("a.txt", "old")], None)
        .unwrap();
    let mut second = open(folder.path(), &["a.txt"]).unwrap();
    second.write(&[file("a.txt", "new")], None).unwrap();
    // As if the file had not been replaced yet.
    fs::write(&path, "old").unwrap();
    let mut third = open(folder.path(), &["a.txt"]).unwrap();
    third.write(&[file("a.txt", "new")], None).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"new");
}

#[test]
fn only_our_own_left_overs_go() {
    let folder = tempfile::tempdir().unwrap();
    let mut export = open(folder.path(), &["a.txt", "b.txt", "c.txt"]).unwrap();
    export
        .write(
            &[file("a.txt", "a"), file("b.txt", "b"), file("c.txt", "c")],
            None,
        )
        .unwrap();
    fs::write(folder.path().join("b.txt"), "edited").unwrap();
    fs::write(folder.path().join("d.txt"), "foreign").unwrap();
    let planned = ["c.txt".to_owned()];
    let mut export = open(folder.path(), &["c.txt"]).unwrap();
    export
        .remove_others(&planned, &Progress::default())
        .unwrap();
    let there = |name| folder.path().join(name).exists();
    assert!(!there("a.txt") && there("b.txt") && there("c.txt") && there("d.txt"));
    // A list that names what is outside takes nothing away there.
    let outside = tempfile::tempdir().unwrap();
    let victim = outside.path().join("v");
    fs::write(&victim, "v").unwrap();
    let name = victim.to_str().unwrap().to_owned();
    export.list.files.insert(
        name,
        Entry {
            sha256: sha256_of_bytes(b"v"),
            ..Entry::default()
        },
    );
    export
        .remove_others(&planned, &Progress::default())
        .unwrap();
    assert!(victim.exists());
}

/// Files of others go only when that is said; one that was read never.
#[test]
fn what_was_read_is_never_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for name in ["read.csv", "foreign.csv", "part of it"] {
        fs::write(at(name), name).unwrap();
    }
    fs::create_dir(at("folder")).unwrap();
    let read = Inputs::of([at("read.csv")]).with_opened(&[at("part of it")]);
    for (name, without, with) in [
        ("read.csv", false, false),
        ("foreign.csv", false, true),
        ("part of it", false, false),
        ("folder", false, false),
        ("new.csv", true, true),
    ] {
        for (replace, may) in [
            (Replace::Nothing, without),
            (Replace::OtherFlight, without),
            (Replace::Anything, with),
        ] {
            let opened = open_for("f", &read, replace, folder.path(), &[name]);
            assert_eq!(opened.is_ok(), may, "{name} {replace:?}");
        }
    }
    // Nor is it taken away, where it is the file of an earlier export.
    let mut export = open(folder.path(), &["ours.txt"]).unwrap();
    export.write(&[file("ours.txt", "1")], None).unwrap();
    let read = Inputs::of([at("ours.txt")]);
    let flight = "flight.toml";
    let mut next = open_for(flight, &read, Replace::Nothing, folder.path(), &[]).unwrap();
    next.remove_others(&[], &Progress::default()).unwrap();
    assert!(at("ours.txt").exists());
}

#[test]
fn the_export_of_another_flight_stays() {
    let parent = tempfile::tempdir().unwrap();
    let at = |name: &str| parent.path().join(name).to_str().unwrap().to_owned();
    for name in ["first.toml", "second.toml"] {
        fs::write(at(name), "").unwrap();
    }
    let folder = parent.path().join("export");
    let other = |flight: &str| other_flight_in(&folder, "x", Path::new(flight));
    let export = |flight: &str, replace| {
        let mut export = open_for(flight, &NOTHING_READ, replace, &folder, &["a"])?;
        export.write(&[file("a", flight)], None)?;
        export.remove_others(&["a".to_owned()], &Progress::default())
    };
    assert_eq!(other(&at("first.toml")), None);
    export(&at("first.toml"), Replace::Nothing).unwrap();
    export(&at("./first.toml"), Replace::Nothing).unwrap();
    assert_eq!(other(&at("first.toml")), None);
    let error = export(&at("second.toml"), Replace::Nothing).unwrap_err();
    let said = error.to_string();
    assert!(said.contains("another flight, 'a flight'"), "{said}");
    assert!(other(&at("second.toml")).unwrap().contains("first.toml"));
    assert!(
        fs::read_to_string(folder.join("a"))
            .unwrap()
            .ends_with("first.toml")
    );
    export(&at("second.toml"), Replace::OtherFlight).unwrap();
    assert!(export(&at("first.toml"), Replace::Nothing).is_err());
}

#[test]
fn what_a_killed_export_left_goes() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("photos")).unwrap();
    for name in [
        ".fragscale-ab12.part",
        "photos/.fragscale-x.part",
        "photos/b.part",
    ] {
        fs::write(at(name), "half").unwrap();
    }
    open(folder.path(), &["photos/a.jpg"]).unwrap();
    let left = fs::read_dir(at("photos")).unwrap().count();
    assert_eq!((left, at(".fragscale-ab12.part").exists()), (1, false));
}

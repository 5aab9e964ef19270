//! What is read is never written over, by any of its names; what somebody else wrote only with
//! `--force`; what fragscale wrote as often as it likes.

use crate::own_frame;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

fn windrow() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/windrow")
}

/// A flight with everything that a flight reads: flight.toml, a calibration, poses, a cloud, photos; a
/// COLMAP model with the positions of its photos; tables of sizes, values and times.
fn desk() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    for name in ["ost.yaml", "poses.csv", "pile.ply"] {
        fs::copy(windrow().join(name), at(name)).expect("a copy");
    }
    let text = fs::read_to_string(windrow().join("flight.toml")).expect("the flight");
    fs::write(at("flight.toml"), format!("{text}folder = \"photos\"\n")).expect("written");
    fs::copy(at("pile.ply"), at("other.ply")).expect("a copy");
    fs::create_dir(at("photos")).expect("a folder");
    let photo = image::RgbImage::from_fn(1280, 720, |x, y| {
        image::Rgb([(x / 5) as u8, (y / 3) as u8, 128])
    });
    for number in 1..=9 {
        let path = at(&format!("photos/IMG_000{number}.jpg"));
        photo.save(path).expect("a photo");
    }
    fs::create_dir(at("model")).expect("a folder");
    own_frame::model(&at("model"));
    fs::write(at("list.csv"), own_frame::positions()).expect("written");
    fs::create_dir(at("elsewhere")).expect("a folder");
    let sizes = "method,size_mm,percent_passing\nsieve,10,5\nsieve,20,30\nsieve,40,70\nsieve,80,99\n\
                 cloud,10,6\ncloud,20,33\ncloud,40,74\ncloud,80,99.5\n";
    fs::write(at("sizes.csv"), sizes).expect("written");
    fs::write(at("places.csv"), "x,y\n-0.4,-0.3\n0.4,-0.3\n0.4,0.3\n").expect("written");
    let values = "trial,value\na,1\na,2\na,3\nb,2\nb,4\nb,7\n";
    fs::write(at("values.csv"), values).expect("written");
    let times = "step,object,cloud\nflight,12,10\nspheres,3,0\n";
    fs::write(at("times.csv"), times).expect("written");
    folder
}

/// Runs in a folder.
fn run_in(folder: &Path, line: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragscale"))
        .args(line.split_whitespace())
        .current_dir(folder)
        .output()
        .expect("the command starts")
}

/// It must be refused, in a line that says these words.
fn refused(folder: &Path, line: &str, words: &str) {
    let output = run_in(folder, line);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{line}: {stderr}");
    let one = stderr.lines().count() == 1 && stderr.starts_with("error: ");
    assert!(one && stderr.contains(words), "{line}: {stderr}");
    assert!(output.stdout.is_empty(), "{line}");
}

fn done(folder: &Path, line: &str) {
    let output = run_in(folder, line);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{line}: {stderr}");
}

/// Every file below a folder with its contents; links as what they lead to.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inside) = folders.pop() {
        for entry in fs::read_dir(inside).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let bytes = fs::read(&path).expect("a file");
                found.insert(path, bytes);
            }
        }
    }
    found
}

/// Other names of a file: through a folder and back, from the root, a link to it, a link to that link,
/// a hard link.
fn names_of(folder: &Path, file: &str, ending: &str) -> Vec<String> {
    let mut names = vec![
        file.to_owned(),
        format!("elsewhere/../{file}"),
        folder.join(file).to_str().expect("UTF-8").to_owned(),
    ];
    let flat = file.replace('/', "-");
    let hard = format!("elsewhere/hard-{flat}.{ending}");
    if !folder.join(&hard).exists() {
        fs::hard_link(folder.join(file), folder.join(&hard)).expect("a link");
    }
    #[cfg(unix)]
    {
        let soft = format!("elsewhere/soft-{flat}.{ending}");
        let twice = format!("elsewhere/twice-{flat}.{ending}");
        if !folder.join(&soft).exists() {
            let link = std::os::unix::fs::symlink::<PathBuf, PathBuf>;
            link(Path::new("..").join(file), folder.join(&soft)).expect("a link");
            link(folder.join(&soft), folder.join(&twice)).expect("a link");
        }
        // Elsewhere the standard library cannot tell hard links.
        names.extend([soft, twice, hard]);
    }
    names
}

#[test]
fn no_command_writes_over_what_it_reads() {
    let desk = desk();
    let folder = desk.path();
    // Commands, the ending that their output has to have, and what they read.
    let cases: [(&str, &str, &[&str]); 12] = [
        (
            "scales flight.toml -o",
            "csv",
            &[
                "flight.toml",
                "pile.ply",
                "ost.yaml",
                "poses.csv",
                "photos/IMG_0003.jpg",
            ],
        ),
        (
            "scales flight.toml --surface other.ply --output",
            "csv",
            &["other.ply"],
        ),
        ("scales . --format json -o", "json", &["flight.toml"]),
        (
            "scales model -o",
            "txt",
            &["model/images.txt", "model/points3D.txt"],
        ),
        ("psd fit sizes.csv -o", "csv", &["sizes.csv"]),
        ("psd fit sizes.csv --figure", "svg", &["sizes.csv"]),
        ("psd compare sizes.csv --report", "html", &["sizes.csv"]),
        (
            "anova values.csv --group trial --value value -o",
            "csv",
            &["values.csv"],
        ),
        ("effort times.csv -o", "csv", &["times.csv"]),
        (
            "profile flight.toml --line places.csv -o",
            "csv",
            &["places.csv"],
        ),
        (
            "volume flight.toml --polygon places.csv -o",
            "csv",
            &["places.csv"],
        ),
        (
            "map flight.toml --polygon places.csv -o",
            "svg",
            &["places.csv"],
        ),
    ];
    for (command, ending, inputs) in cases {
        for input in inputs {
            let names = names_of(folder, input, ending);
            let before = contents(folder);
            for name in names {
                // A figure's and a report's name are looked at first.
                let ends = [
                    "--figure",
                    "--report",
                    "map flight.toml --polygon places.csv -o",
                ];
                let must_end = ends.iter().any(|end| command.ends_with(end));
                if must_end && !name.ends_with(ending) {
                    continue;
                }
                refused(folder, &format!("{command} {name} --force"), "read");
                refused(folder, &format!("{command} {name}"), &name);
            }
            assert_eq!(contents(folder), before, "{command} {input}");
        }
    }
}

#[test]
fn a_georeferenced_flight_is_no_file_that_was_read() {
    let desk = desk();
    let folder = desk.path();
    let command = "georeference model --positions list.csv --crs EPSG:32632 -o";
    for input in ["model/images.txt", "list.csv"] {
        let names = names_of(folder, input, "toml");
        let before = contents(folder);
        for name in names {
            refused(folder, &format!("{command} {name} --force"), "");
        }
        assert_eq!(contents(folder), before);
    }
    // Somebody's flight, then our own.
    refused(folder, &format!("{command} flight.toml"), "--force");
    done(folder, &format!("{command} flight.toml --force"));
    done(folder, &format!("{command} flight.toml"));
    done(folder, "scales flight.toml");
    // It holds what a person may have set since: no result takes its place.
    refused(folder, "scales model -o flight.toml", "--force");
}

/// Files of others, and our own in every format.
#[test]
fn what_fragscale_did_not_write_is_replaced_with_force_only() {
    let desk = desk();
    let folder = desk.path();
    let mine = "What I noted on the pile.\n";
    let commands = [
        "scales flight.toml --format table -o",
        "scales flight.toml --format csv -o",
        "scales flight.toml --format json --output",
        "scales model --format table -o",
        "psd fit sizes.csv --format table -o",
        "psd fit sizes.csv --format csv -o",
        "psd fit sizes.csv --format json -o",
        "psd fit sizes.csv -o /dev/null --figure",
        "psd compare sizes.csv --format table -o",
        "psd compare sizes.csv --format csv -o",
        "psd compare sizes.csv --format json -o",
        "psd compare sizes.csv -o /dev/null --report",
        "anova values.csv --group trial --value value --format table -o",
        "anova values.csv --group trial --value value --format csv -o",
        "anova values.csv --group trial --value value --format json -o",
        "anova values.csv --group trial --value value --by trial --format csv -o",
        "effort times.csv --format table -o",
        "effort times.csv --format csv -o",
        "effort times.csv --format json -o",
    ];
    for (number, command) in commands.into_iter().enumerate() {
        let endings: &[&str] = match command.rsplit(' ').next() {
            Some("--figure") => &["svg", "png"],
            Some("--report") => &["html"],
            _ => &["txt"],
        };
        for ending in endings {
            let name = format!("result{number}.{ending}");
            let line = format!("{command} {name}");
            fs::write(folder.join(&name), mine).expect("written");
            refused(folder, &line, "it is there already");
            assert_eq!(
                fs::read_to_string(folder.join(&name)).expect("a file"),
                mine
            );
            done(folder, &format!("{line} --force"));
            let first = fs::read(folder.join(&name)).expect("a file");
            assert_ne!(first, mine.as_bytes());
            // Its own again and again.
            done(folder, &line);
            assert_eq!(fs::read(folder.join(&name)).expect("a file"), first);
            // And in place of an empty file, as mktemp leaves it.
            fs::write(folder.join(&name), "").expect("written");
            done(folder, &line);
            assert_eq!(fs::read(folder.join(&name)).expect("a file"), first);
        }
    }
    // One result may follow another of another kind.
    done(folder, "scales flight.toml -o result0.txt --format json");
    // A folder with a flight.toml is not read as a whole.
    fs::write(folder.join("notes.txt"), mine).expect("written");
    refused(folder, "scales . -o notes.txt", "--force");
    done(folder, "scales . -o notes.txt --force");
    // Two into one file are one too few.
    refused(
        folder,
        "psd fit sizes.csv --figure a.svg --figure ./a.svg",
        "two results would go into it",
    );
    refused(folder, "scales flight.toml -o photos", "it is a folder");
    assert!(!folder.join("a.svg").exists());
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_written_through() {
    let desk = desk();
    done(desk.path(), "scales flight.toml -o /dev/null");
    let output = run_in(
        desk.path(),
        "scales flight.toml --format csv -o /dev/stdout",
    );
    assert!(output.stdout.starts_with(b"photo,width_px,"), "{output:?}");
}

#[test]
fn an_export_leaves_the_photos_and_other_flights_alone() {
    let desk = desk();
    let folder = desk.path();
    let before = contents(folder);
    let words = "photos: the flight's photos lie in it";
    // Beside the flight, its photos would be in the way; a photo that the list of poses calls otherwise than its file is would have a
    // second one beside it. Into their folder, a season would pass over what lies there as an export.
    for to in [".", ". --force", "photos", "photos --force"] {
        refused(folder, &format!("export flight.toml --to {to}"), words);
    }
    assert_eq!(contents(folder), before);
    #[cfg(unix)]
    {
        // As through a link to their folder.
        let to = folder.join("elsewhere/linked");
        fs::create_dir(&to).expect("a folder");
        std::os::unix::fs::symlink("../../photos", to.join("photos")).expect("a link");
        refused(
            folder,
            "export flight.toml --to elsewhere/linked --force",
            words,
        );
        fs::remove_dir_all(&to).expect("removed");
    }
    // In a folder of its own in theirs it is in nobody's way.
    done(folder, "export flight.toml --to photos/export");
    for (path, bytes) in &before {
        assert_eq!(
            fs::read(path).as_ref().ok(),
            Some(bytes),
            "{}",
            path.display()
        );
    }

    // Another flight.
    let text = fs::read_to_string(folder.join("flight.toml")).expect("the flight");
    fs::write(
        folder.join("second.toml"),
        text.replace("Windrow", "Second"),
    )
    .expect("written");
    done(folder, "export flight.toml --to out");
    let out = folder.join("out");
    let first = contents(&out);
    refused(
        folder,
        "export second.toml --to out",
        "the export of another flight, 'Windrow'",
    );
    assert_eq!(contents(&out), first);
    done(folder, "export second.toml --to out --force");
    refused(
        folder,
        "export flight.toml --to out",
        "the export of another flight, 'Second'",
    );

    // Files of others in the way.
    fs::write(out.join("scales.csv"), "mine").expect("written");
    refused(folder, "export second.toml --to out", "scales.csv");
    done(folder, "export second.toml --to out --force");
    assert_ne!(fs::read(out.join("scales.csv")).expect("a file"), b"mine");

    // Exported photos that another flight was read from are its photos.
    fs::write(
        folder.join("third.toml"),
        text.replace("\"photos\"", "\"out/photos\""),
    )
    .expect("written");
    let photos = contents(&out.join("photos"));
    refused(folder, "export third.toml --to out --force", words);
    assert_eq!(contents(&out.join("photos")), photos);
}

#[cfg(feature = "render")]
#[test]
fn a_picture_is_no_file_that_was_read() {
    let desk = desk();
    let folder = desk.path();
    // As a photo that is a PNG could be.
    let names = names_of(folder, "photos/IMG_0003.jpg", "png");
    let before = contents(folder);
    for name in names {
        refused(
            folder,
            &format!("render flight.toml -o {name} --force"),
            "read",
        );
        refused(folder, &format!("render flight.toml -o {name}"), &name);
    }
    assert_eq!(contents(folder), before);
    fs::write(folder.join("mine.png"), "mine").expect("written");
    refused(
        folder,
        "render flight.toml --size 64x48 -o mine.png",
        "--force",
    );
    done(
        folder,
        "render flight.toml --size 64x48 -o mine.png --force",
    );
    done(folder, "render flight.toml --size 64x48 -o mine.png");
}

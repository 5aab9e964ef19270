//! What a full disk or a killed process leaves: whole files or none.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::common::stdout_of;

/// One test at a time: the moments of kills are fractions of a run that has the machine for itself.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn sample() -> String {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    sample.to_str().expect("UTF-8").to_owned()
}

/// The bundled flight with three of its photos: runs are killed half a dozen times over.
fn three_photos(folder: &Path) -> String {
    let sample = PathBuf::from(sample());
    fs::create_dir_all(folder.join("photos")).expect("a folder");
    for name in ["flight.toml", "ost.yaml", "pile.ply"] {
        fs::copy(sample.join(name), folder.join(name)).expect("a copy");
    }
    for number in 1..=3 {
        let name = format!("photos/IMG_000{number}.jpg");
        fs::copy(sample.join(&name), folder.join(&name)).expect("a copy");
    }
    let poses = fs::read_to_string(sample.join("poses.csv")).expect("the poses");
    let others = (4..=9).map(|number| format!("IMG_000{number}"));
    let others: Vec<String> = others.collect();
    let kept = poses
        .lines()
        .filter(|line| !others.iter().any(|name| line.starts_with(name)));
    let kept: String = kept.flat_map(|line| [line, "\n"]).collect();
    fs::write(folder.join("poses.csv"), kept).expect("written");
    folder.to_str().expect("UTF-8").to_owned()
}

/// Runs with files limited to so many KiB: a write beyond fails as it does on a full disk, and the
/// signal that comes with it is ignored, as it is on a disk.
fn limited(kib: u32, arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_fragscale");
    Command::new("bash")
        .arg("-c")
        .arg(format!("trap '' XFSZ; ulimit -f {kib}; exec \"$0\" \"$@\""))
        .arg(program)
        .args(arguments)
        .output()
        .expect("bash starts")
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inside) = folders.pop() {
        let Ok(entries) = fs::read_dir(inside) else {
            continue;
        };
        for entry in entries {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                found.push(path);
            }
        }
    }
    found
}

fn is_part(path: &Path) -> bool {
    let name = path.file_name().expect("a name").to_string_lossy();
    name.starts_with(".fragscale-") && name.ends_with(".part")
}

/// Every file of an export that is there is whole: pictures decode to their size, tables and pages
/// end as they should.
fn assert_whole(folder: &Path) {
    for path in files_below(folder)
        .into_iter()
        .filter(|path| !is_part(path))
    {
        let bytes = fs::read(&path).expect("a file");
        let name = path.strip_prefix(folder).expect("below").to_string_lossy();
        let shown = path.display();
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("jpg" | "png") => {
                let image = image::load_from_memory(&bytes).expect(&name);
                let size = (image.width(), image.height());
                let ends = bytes.ends_with(&[0xff, 0xd9]) || name.ends_with("png");
                assert!(ends, "{shown} has no end");
                // The photos of the sample have this size; the others are smaller.
                assert!(
                    !name.starts_with("photos/") || size == (1280, 720),
                    "{shown}"
                );
            }
            Some("json" | "geojson") => {
                let read = serde_json::from_slice::<serde_json::Value>(&bytes);
                assert!(read.is_ok(), "{shown}: {read:?}");
            }
            Some("csv") => assert!(bytes.ends_with(b"\n"), "{shown}"),
            Some("html" | "kml") => {
                let text = String::from_utf8(bytes).expect("UTF-8");
                let end = text.trim_end();
                assert!(
                    end.ends_with("</html>") || end.ends_with("</kml>"),
                    "{shown}"
                );
            }
            other => panic!("{shown}: {other:?}"),
        }
    }
}

#[test]
fn a_full_disk_leaves_the_file_that_was_there() {
    let _alone = alone();
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scales.json");
    let sample = sample();
    let file = path.to_str().expect("UTF-8");
    let arguments = ["scales", &sample, "--format", "json", "-o", file];
    stdout_of(&["scales", &sample, "--format", "csv", "-o", file]);
    let before = fs::read(&path).expect("a file");
    // The JSON has more than 1 KiB, the CSV of before was written.
    let output = limited(1, &arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    let one = stderr.lines().count() == 1 && stderr.starts_with("error: ");
    assert!(one && stderr.contains("it cannot be written"), "{stderr}");
    assert_eq!(fs::read(&path).expect("a file"), before);
    assert_eq!(
        files_below(folder.path()),
        std::slice::from_ref(&path),
        "nothing beside it"
    );
    // With room again.
    stdout_of(&arguments);
    assert!(fs::read(&path).expect("a file").len() > 1024);
}

#[test]
fn a_full_disk_leaves_whole_files_of_an_export() {
    let _alone = alone();
    let folder = tempfile::tempdir().expect("a folder");
    let flight = three_photos(&folder.path().join("flight"));
    let to = folder.path().join("export");
    let arguments = ["export", &flight, "--to", to.to_str().expect("UTF-8")];
    // Thumbnails and overlays have room, full photos have not.
    let output = limited(200, &arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(
        stderr.contains("cannot be written") && stderr.lines().count() == 1,
        "{stderr}"
    );
    assert_whole(&to);
    assert!(!files_below(&to).iter().any(|path| is_part(path)));
    stdout_of(&arguments);
    assert_whole(&to);
    assert!(to.join("scales.html").is_file());
}

/// Kills before the first file is written and at moments from then to the end; whatever stands under its
/// name is whole, and the next run goes on.
#[test]
fn a_killed_export_leaves_whole_files() {
    const EARLY: u32 = 2;
    const LATE: u32 = 8;
    let _alone = alone();
    let folder = tempfile::tempdir().expect("a folder");
    let flight = three_photos(&folder.path().join("flight"));
    let start = |to: &Path| {
        Command::new(env!("CARGO_BIN_EXE_fragscale"))
            .args(["export", &flight, "--to", to.to_str().expect("UTF-8")])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("it starts")
    };
    // The list is written before every other file.
    let wait_for_list = |export: &mut Child, to: &Path| {
        while export.try_wait().expect("a child").is_none() && !to.join("export.json").exists() {
            std::thread::sleep(Duration::from_millis(1));
        }
    };
    let measured = folder.path().join("measured");
    let begin = Instant::now();
    let mut export = start(&measured);
    wait_for_list(&mut export, &measured);
    let reading = begin.elapsed();
    assert!(export.wait().expect("a child").success());
    let writing = begin.elapsed() - reading;
    let names = |of: &Path| -> Vec<PathBuf> {
        let files = files_below(of).into_iter();
        let mut names: Vec<PathBuf> = files
            .map(|path| path.strip_prefix(of).expect("below").to_owned())
            .collect();
        names.sort();
        names
    };
    let all = names(&measured);
    let mut begun = Vec::new();
    for kill in 0..EARLY + LATE {
        let to = folder.path().join(format!("killed{kill}"));
        let mut export = start(&to);
        if kill < EARLY {
            std::thread::sleep(reading * (kill + 1) / (EARLY + 1));
        } else {
            wait_for_list(&mut export, &to);
            std::thread::sleep(writing * (kill - EARLY) / LATE);
        }
        // SIGKILL, on Unix.
        export.kill().expect("killed");
        export.wait().expect("it ended");
        assert_whole(&to);
        let left = names(&to).len();
        if (1..all.len()).contains(&left) {
            begun.push(to);
        }
    }
    let count = begun.len();
    println!("{count} of {LATE} killed amid writing, which takes {writing:?}");
    // As if the last had been killed in the middle of a file.
    let last = begun.pop().expect("one that was killed amid writing");
    for place in ["", "photos", "overlays"] {
        fs::create_dir_all(last.join(place)).expect("a folder");
        fs::write(last.join(place).join(".fragscale-Ab12.part"), "half").expect("written");
    }
    assert!(start(&last).wait().expect("a child").success());
    assert_whole(&last);
    // Complete, and nothing of the killed one is left.
    assert_eq!(names(&last), all);
}

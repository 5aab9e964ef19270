//! What a full disk or a killed process leaves: whole files or none.

#![cfg(unix)]
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    missing_docs,
    reason = "in a test a panic is the report"
)]

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use common::{fragscale, stdout_of};

fn sample() -> String {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    sample.to_str().expect("UTF-8").to_owned()
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
        [path.clone()],
        "nothing beside it"
    );
    // With room again.
    stdout_of(&arguments);
    assert!(fs::read(&path).expect("a file").len() > 1024);
}

#[test]
fn a_full_disk_leaves_whole_files_of_an_export() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("export");
    let arguments = ["export", &sample(), "--to", to.to_str().expect("UTF-8")];
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

/// Kills at moments all over the run; whatever stands under its name is whole, and the next run goes on.
#[test]
fn a_killed_export_leaves_whole_files() {
    const KILLS: u32 = 10;
    let sample = sample();
    let folder = tempfile::tempdir().expect("a folder");
    let measured = folder.path().join("measured");
    let start = Instant::now();
    stdout_of(&["export", &sample, "--to", measured.to_str().expect("UTF-8")]);
    let whole = start.elapsed();
    let names = |of: &Path| -> Vec<PathBuf> {
        let mut names: Vec<PathBuf> = files_below(of)
            .iter()
            .map(|path| path.strip_prefix(of).expect("below").to_owned())
            .collect();
        names.sort();
        names
    };
    let (mut killed, mut begun) = (0, Vec::new());
    for kill in 0..KILLS {
        let to = folder.path().join(format!("killed{kill}"));
        let mut export = Command::new(env!("CARGO_BIN_EXE_fragscale"))
            .args(["export", &sample, "--to", to.to_str().expect("UTF-8")])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("it starts");
        // From a tenth of the run to nearly its end.
        std::thread::sleep(whole.mul_f64(f64::from(kill + 1) / f64::from(KILLS + 1)));
        if export.try_wait().expect("a child").is_none() {
            killed += 1;
        }
        // SIGKILL, on Unix.
        export.kill().expect("killed");
        export.wait().expect("it ended");
        assert_whole(&to);
        let left = files_below(&to).len();
        if left > 0 && left < names(&measured).len() {
            begun.push(to);
        }
    }
    assert!(killed >= KILLS / 2, "only {killed} were killed in time");
    println!(
        "{killed} killed, {} of them amid writing, of runs of {whole:?}",
        begun.len()
    );
    // As if one had been killed in the middle of a file.
    let last = begun.pop().unwrap_or(measured.clone());
    for place in ["", "photos", "overlays"] {
        fs::create_dir_all(last.join(place)).expect("a folder");
        fs::write(last.join(place).join(".fragscale-Ab12.part"), "half").expect("written");
    }
    let output = fragscale(&["export", &sample, "--to", last.to_str().expect("UTF-8")]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_whole(&last);
    assert_eq!(
        names(&last),
        names(&measured),
        "complete, and nothing of the killed one is left"
    );
    assert!(
        start.elapsed() < Duration::from_secs(120),
        "{:?}",
        start.elapsed()
    );
}

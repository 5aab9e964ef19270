//! `fragscale reconstruct` from outside: what it refuses, in one line. What comes out of photos that overlap
//! is tested in `src/reconstruct/tests.rs`.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{error_of, fragscale, stdout_of};

/// The bundled photos do not overlap, as the paper's: that is said, not a model made of nothing.
#[test]
fn photos_without_overlap_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("flight");
    let to = to.to_str().expect("UTF-8");
    let photos = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sample/photos");
    let error = error_of(&["reconstruct", photos, "--to", to]);
    assert!(error.contains("show the same"), "{error}");
    assert!(error.contains("overlap by two thirds"), "{error}");
    // Whoever opens the folder is told that, and not to do it again.
    let opened = error_of(&["scales", to]);
    assert!(opened.contains("overlap by two thirds"), "{opened}");
    assert!(!opened.contains("goes on where it was"), "{opened}");
}

#[test]
fn folders_that_are_none_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    fs::create_dir(path("empty")).expect("a folder");
    let error = error_of(&["reconstruct", &path("empty"), "--to", &path("a")]);
    assert!(error.contains("0 of its 0 photos"), "{error}");
    assert!(!folder.path().join("a").exists());
    let error = error_of(&["reconstruct", &path("none"), "--to", &path("a")]);
    assert!(error.contains("there is no such folder"), "{error}");
    fs::write(folder.path().join("empty/mine.txt"), "mine").expect("a file");
    let photos = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sample/photos");
    let error = error_of(&["reconstruct", photos, "--to", &path("empty")]);
    assert!(error.contains("the folder is not empty"), "{error}");
}

/// How much work the cloud is; what each word costs stands in the help.
#[test]
fn qualities_are_words() {
    let photos = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sample/photos");
    let output = fragscale(&["reconstruct", photos, "--to", "x", "--quality", "good"]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(
        error.contains("[possible values: fast, normal, best]"),
        "{error}"
    );
    let help = stdout_of(&["reconstruct", "--help"]);
    for words in ["[default: fast]", "- fast:", "sparse cloud", "megapixels"] {
        assert!(help.contains(words), "{words}: {help}");
    }
}

/// Ctrl+C ends it at once, says that the same command goes on, and so does whoever opens what is there.
#[cfg(unix)]
#[test]
fn interrupted_it_says_how_to_go_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("flight");
    let photos = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sample/photos");
    let child = Command::new(env!("CARGO_BIN_EXE_fragscale"))
        .args(["reconstruct", photos, "--to"])
        .arg(&to)
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    let since = Instant::now();
    while !to.join("unfinished/photos.txt").exists() {
        assert!(since.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(10));
    }
    let process = child.id().to_string();
    let kill = Command::new("kill").args(["-INT", &process]).status();
    assert!(kill.expect("kill is there").success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(130));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.starts_with("interrupted; what is done lies in"),
        "{said}"
    );
    assert!(said.contains("the same command goes on with it"), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    let error = error_of(&["scales", to.to_str().expect("UTF-8")]);
    assert!(
        error.contains("a reconstruction that is not finished"),
        "{error}"
    );
}

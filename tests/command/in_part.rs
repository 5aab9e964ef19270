//! Clouds that are read in part, as a user asks for them: the same numbers as whole, and what is refused.

use std::fs;

use crate::common::{error_of, fragscale, stdout_of};

/// Two simulated flights, whose clouds are LAZ in UTM: every digit of what `scales` says, a scale map's bytes, a plan.
#[test]
fn in_part_every_digit_is_the_same() {
    for (preset, seed) in [("muckpile", "3"), ("bench", "4")] {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
        let flight = at("flight");
        stdout_of(&[
            "sample",
            &flight,
            "--preset",
            preset,
            "--seed",
            seed,
            "--points",
            "60000",
            "--no-photos",
        ]);
        let whole = stdout_of(&["scales", &flight, "--format", "json"]);
        let part = stdout_of(&["scales", &flight, "--format", "json", "--in-part"]);
        assert!(whole.contains("fitted") && whole == part, "{preset}");
        let map = |name: &str, more: &[&str]| {
            let path = at(name);
            let mut arguments = vec!["scale-map", &flight, "--photo", "IMG_0002.jpg", "-o", &path];
            arguments.extend(more);
            stdout_of(&arguments);
            fs::read(&path).expect("a map")
        };
        assert!(
            map("whole.png", &[]) == map("part.png", &["--in-part"]),
            "{preset}"
        );
        let said = stdout_of(&["check", &flight, "--in-part"]);
        assert!(
            said.contains("not looked at: only a part of the surface was read"),
            "{said}"
        );
        let error = error_of(&["scales", &flight, "--memory", "100kB"]);
        assert!(
            error.contains("of memory, and 100 kB may be used") && error.contains("--memory"),
            "{error}"
        );
        let wrong = fragscale(&["scales", &flight, "--memory", "8"]);
        let said = String::from_utf8_lossy(&wrong.stderr);
        assert!(
            wrong.status.code() == Some(2) && said.contains("as 8GB"),
            "{said}"
        );
    }
}

/// A PLY is read whole, and that is said where it takes more than was allowed.
#[test]
fn what_cannot_be_read_in_part_says_so() {
    let output = fragscale(&["scales", "assets/sample/flight.toml", "--memory", "100kB"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains("pile.ply") && said.contains("more than 100 kB: only LAS, LAZ, COPC and EPT"),
        "{said}"
    );
}

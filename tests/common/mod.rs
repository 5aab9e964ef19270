//! What the integration tests share: running the command as a user does.

#![allow(unreachable_pub, reason = "each test binary is a crate of its own")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// Runs the command with these arguments.
pub fn fragscale(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragscale"))
        .args(arguments)
        .output()
        .expect("the command starts")
}

/// Standard output of a run that must succeed.
pub fn stdout_of(arguments: &[&str]) -> String {
    let output = fragscale(arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {stderr}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// `scales --format json` of a flight.
#[allow(dead_code, reason = "not every test binary asks for JSON")]
pub fn scales_json(flight: &Path, more: &[&str]) -> Value {
    let flight = flight.to_str().expect("a UTF-8 path");
    let mut arguments = vec!["scales", flight, "--format", "json"];
    arguments.extend(more);
    serde_json::from_str(&stdout_of(&arguments)).expect("JSON")
}

/// A scale of a photo, where there is one.
#[allow(dead_code, reason = "not every test binary looks at scales")]
pub fn scale(photo: &Value, edge: &str) -> Option<f64> {
    photo["scale"][edge].as_f64()
}

/// A file below the shared real data, or `None`, said on the terminal.
#[allow(dead_code, reason = "not every test binary uses real data")]
pub fn shared_data(path: &str) -> Option<PathBuf> {
    let root = std::env::var_os("FRAGSCALE_TEST_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data"),
        PathBuf::from,
    );
    let found = root.join(path);
    if found.exists() {
        return Some(found);
    }
    println!("left out: no shared data ({path})");
    None
}

//! What the integration tests share: running the command as a user does.

#![allow(unreachable_pub, reason = "each test binary is a crate of its own")]

use std::path::Path;
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

/// The error of a run that must fail, one line; warnings may stand beside it.
#[allow(dead_code, reason = "not every test binary has a run that fails")]
pub fn error_of(arguments: &[&str]) -> String {
    let output = fragscale(arguments);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    let text = String::from_utf8(output.stderr).expect("UTF-8");
    let errors: Vec<&str> = text.lines().filter(|l| l.starts_with("error: ")).collect();
    assert_eq!(errors.len(), 1, "{text}");
    errors[0].to_owned()
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

#[allow(unused_imports, reason = "not every test binary uses real data")]
pub use fragscale_test_data::shared_data;

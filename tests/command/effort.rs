//! The paper's Table I through the command.

use std::fs;

use serde_json::{Value, json};

fn written(text: &str) -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().expect("a file");
    fs::write(&file, text).expect("it is written");
    file
}

fn path(file: &tempfile::NamedTempFile) -> &str {
    file.path().to_str().expect("a UTF-8 path")
}

/// Minutes: 12.5, 30, 1.5 in the one method; 10, 45 and none in the other.
const WIDE: &str = "step,scale object,point cloud\nflight,12.5,10\nset up,1800 s,0:45:00\n\
                    spheres,1:30,\n";

#[test]
fn totals_and_averages_of_rows_and_columns() {
    let file = written(WIDE);
    let text = crate::common::stdout_of(&["effort", path(&file), "--format", "json"]);
    let found: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(found["unit"], "min");
    assert_eq!(found["columns"], json!(["scale object", "point cloud"]));
    assert_eq!(found["steps"][0]["total"], 22.5);
    assert_eq!(found["steps"][0]["average"], 11.25);
    assert_eq!(found["steps"][2]["times"], json!([1.5, null]));
    assert_eq!(found["steps"][2]["missing"], 1);
    assert_eq!(found["column_sums"][0]["total"], 44.0);
    assert_eq!(found["column_sums"][1]["total"], 55.0);
    assert_eq!(found["column_sums"][1]["average"], 27.5);
    assert_eq!(found["all"]["total"], 99.0);
    assert_eq!(found["average_column_total"], 49.5);
    let text = crate::common::stdout_of(&["effort", path(&file)]);
    assert!(text.contains("1 time is missing, in no total and no average: 'spheres' of"));
}

/// The table of the manual, as it stands there: 12.5 and 45 minutes in the one method, 10 and none in the other.
#[test]
fn the_manuals_table_is_read() {
    let manual = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/sizes.md");
    let manual = fs::read_to_string(manual).expect("the manual");
    let mut boxes = manual
        .split("```\n")
        .filter(|text| text.starts_with("step,"));
    let table = boxes.next().expect("a table of times");
    let file = written(table);
    let text = crate::common::stdout_of(&["effort", path(&file), "--format", "json"]);
    let found: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(found["columns"], json!(["scale object", "point cloud"]));
    assert_eq!(found["column_sums"][0]["total"], 57.5);
    assert_eq!(found["column_sums"][1]["total"], 10.0);
    assert_eq!(found["steps"][1]["missing"], 1);
    assert_eq!(found["all"]["total"], 67.5);
}

/// What the command writes as CSV it reads again; the sums are computed anew.
#[test]
fn its_own_table_is_read_again() {
    let file = written(WIDE);
    let csv = crate::common::stdout_of(&["effort", path(&file), "--format", "csv"]);
    let again = written(&csv);
    let output = crate::common::fragscale(&["effort", path(&again), "--format", "csv"]);
    assert_eq!(String::from_utf8_lossy(&output.stdout), csv);
    let warnings = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        warnings.contains("the line 'total' is left out"),
        "{warnings}"
    );
}

/// The spheres took "1:30".
#[test]
fn how_times_of_two_parts_are_read_is_said() {
    let output = crate::common::fragscale(&["effort", path(&written(WIDE))]);
    let warnings = String::from_utf8_lossy(&output.stderr).into_owned();
    let said =
        "times of two parts are taken for minutes and seconds, the first is '1:30' on line 4";
    assert_eq!(warnings.matches(said).count(), 1, "{warnings}");
}

#[test]
fn percents_that_pass_are_no_times() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    for table in ["distributions.csv", "reference.csv"] {
        let table = root.join("assets/sample").join(table);
        let error = crate::common::error_of(&["effort", table.to_str().expect("a UTF-8 path")]);
        let said = "it holds size distributions, not the times of steps; ";
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn a_time_that_is_none_is_said_with_line_and_column() {
    let file = written("step,cloud\nflight,10\nset up,soon\n");
    let output = crate::common::fragscale(&["effort", path(&file)]);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stderr.contains(":3: column cloud: 'soon' is not a number; "),
        "{stderr}"
    );
}

//! Analyses of variance against NIST's certified answers, in the library and through the command.

use std::collections::BTreeMap;
use std::fs;

use fragscale::fragmentation::Anova;
use serde_json::Value;

/// What a file of NIST's Statistical Reference Datasets holds: the groups, and of its header the
/// certified sums of squares between and within, F, R squared and residual standard deviation.
struct Certified {
    groups: Vec<Vec<f64>>,
    degrees: [usize; 2],
    sums: [f64; 2],
    f: f64,
    r_squared: f64,
    residual_sd: f64,
}

fn read(name: &str) -> Option<Certified> {
    let path = crate::common::shared_data(&format!("nist-anova/{name}.dat"))?;
    let text = fs::read_to_string(path).expect("a text");
    let (header, data): (Vec<_>, Vec<_>) = text.lines().enumerate().partition(|(at, _)| *at < 60);
    let numbers = |begin: &str| -> Vec<f64> {
        let line = header.iter().find(|(_, line)| line.contains(begin));
        let words = line.expect("a line of the header").1.split_whitespace();
        words.filter_map(|word| word.parse().ok()).collect()
    };
    let (between, within) = (numbers("Between "), numbers("Within "));
    let mut groups = BTreeMap::<u32, Vec<f64>>::new();
    for (_, line) in data {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let [group, value] = words[..] {
            let group = group.parse().expect("a group");
            let value = value.parse().expect("a value");
            groups.entry(group).or_default().push(value);
        }
    }
    // Whole numbers below 2000.
    let degrees = [between[0] as usize, within[0] as usize];
    Some(Certified {
        groups: groups.into_values().collect(),
        degrees,
        sums: [between[1], within[1]],
        f: between[3],
        r_squared: numbers("Certified R-Squared")[0],
        residual_sd: numbers("Standard Deviation ")[0],
    })
}

/// Nine digits on the sets of low and average difficulty; on SmLs07 no more than its numbers have as
/// doubles: the spacing at 1e12 is 1.2e-4, and exact rational arithmetic on them gives an F of
/// 21.000811887818770 (4e-5 off the certified 21).
#[test]
fn nists_certified_answers() {
    for (name, digits) in [
        ("SiRstv", 1e-12),
        ("SmLs01", 1e-12),
        ("SmLs02", 1e-12),
        ("SmLs04", 2e-10),
        ("SmLs07", 1e-4),
    ] {
        let Some(certified) = read(name) else {
            return;
        };
        let found = Anova::of_groups(&certified.groups, 0.05).expect("a table");
        assert_eq!(
            [found.between, found.within].map(|source| source.degrees_of_freedom),
            certified.degrees
        );
        for (what, found, certified) in [
            ("between", found.between.sum_of_squares, certified.sums[0]),
            ("within", found.within.sum_of_squares, certified.sums[1]),
            ("F", found.f.expect("an F"), certified.f),
            (
                "R squared",
                found.r_squared.expect("a share"),
                certified.r_squared,
            ),
            (
                "deviation",
                found.residual_standard_deviation,
                certified.residual_sd,
            ),
        ] {
            let off = (found / certified - 1.0).abs();
            println!("{name} {what}: {off:.1e}");
            assert!(off < digits, "{name} {what}: {found} for {certified}");
        }
    }
}

/// Sums of squares and F of the doubles themselves, from exact rational arithmetic (Python's
/// fractions): what is lost is lost in reading the numbers, not in the analysis.
#[test]
fn nothing_is_lost_but_the_input() {
    for (name, between, within, f) in [
        (
            "SmLs04",
            1.680_000_000_149_011_6,
            1.800_000_000_093_132_2,
            21.000_000_000_776_1,
        ),
        (
            "SmLs07",
            1.680_156_269_401_469_6,
            1.800_097_837_334_587_5,
            21.000_811_887_818_77,
        ),
    ] {
        let Some(certified) = read(name) else {
            return;
        };
        let found = Anova::of_groups(&certified.groups, 0.05).expect("a table");
        for (found, exact) in [
            (found.between.sum_of_squares, between),
            (found.within.sum_of_squares, within),
            (found.f.expect("an F"), f),
        ] {
            let off = (found / exact - 1.0).abs();
            println!("{name}: {off:.1e} off the exact answer of its doubles");
            assert!(off < 1e-13, "{name}: {found} for {exact}");
        }
    }
}

/// A table of the paper's shape: three photos of each of two trials at two sizes.
const TRIALS: &str = "trial;size_mm;passing\n1;10;20,5\n1;10;21\n1;10;19,5\n2;10;30\n2;10;31\n\
                      2;10;29\n1;20;50\n1;20;52\n1;20;51\n2;20;50\n2;20;51\n2;20;52\n";

fn written(text: &str) -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().expect("a file");
    fs::write(&file, text).expect("it is written");
    file
}

fn path(file: &tempfile::NamedTempFile) -> &str {
    file.path().to_str().expect("a UTF-8 path")
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&crate::common::stdout_of(arguments)).expect("JSON")
}

fn near(value: &Value, expected: f64) {
    let found = value.as_f64().expect("a number");
    assert!(
        (found / expected - 1.0).abs() < 1e-9,
        "{found} instead of {expected}"
    );
}

/// scipy.stats.f_oneway of the pooled values and of those at 10 mm.
#[test]
fn the_command_gives_one_table_and_one_a_size() {
    let file = written(TRIALS);
    let mut arguments = vec![
        "anova",
        path(&file),
        "--group",
        "trial",
        "--value",
        "passing",
    ];
    arguments.extend(["--by", "size_mm", "--format", "json"]);
    let found = json(&arguments);
    assert_eq!(found["between"]["df"], 1);
    assert_eq!(found["within"]["df"], 10);
    near(&found["between"]["f"], 0.337_047_130_490_541_8);
    near(&found["between"]["p"], 0.574_387_660_070_212_7);
    near(&found["critical_f"], 4.964_602_743_730_711);
    assert_eq!(found["level"], 0.05);
    assert_eq!(found["per"][0]["value"], "10");
    near(&found["per"][0]["between"]["f"], 177.052_631_578_949_5);
    near(
        &found["per"][0]["between"]["p"],
        0.000_184_403_086_178_808_6,
    );
    assert_eq!(found["per"][0]["differs"], true);
    assert_eq!(found["per"][1]["between"]["f"], 0.0);
    arguments.truncate(6);
    let output = crate::common::fragscale(&arguments);
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(
        text.contains("the groups of 'trial' do not differ at the 5 % level"),
        "{text}"
    );
    let warnings = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(
        warnings.starts_with("warning: decimal commas"),
        "{warnings}"
    );
}

/// The line of docs/sizes.md: the bundled table's sieve has no trial, and each method's trials are analysed alone.
#[test]
fn one_method_of_the_bundled_table() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let table = root.join("assets/sample/distributions.csv");
    let table = table.to_str().expect("a UTF-8 path");
    let mut arguments = vec!["anova", table, "--group", "trial"];
    arguments.extend(["--value", "percent_passing", "--by", "size_mm"]);
    let error = crate::common::error_of(&arguments);
    assert!(error.contains(":8: a value without its trial; "), "{error}");
    assert!(error.contains("(--only COLUMN=TEXT)"), "{error}");
    arguments.extend(["--only", "method=point cloud", "--format", "json"]);
    let found = json(&arguments);
    // 22, 23 and 23 lines.
    assert_eq!(found["between"]["df"], 2);
    assert_eq!(found["within"]["df"], 65);
}

/// The paper's Table II from its sums of squares.
#[test]
fn the_command_takes_published_sums() {
    let published = ["anova", "--between", "9,1.9", "--within", "20,1255.3"];
    let found = json(&[&published[..], &["--format", "json"]].concat());
    near(&found["between"]["mean_square"], 1.9 / 9.0);
    near(&found["between"]["f"], 1.9 / 9.0 / (1255.3 / 20.0));
    near(&found["critical_f"], 2.392_814_108_442_279);
    assert_eq!(found["differs"], false);
    let text = crate::common::stdout_of(&published);
    let line = text.lines().nth(1).expect("a line");
    let words: Vec<&str> = line.split_whitespace().collect();
    assert_eq!(
        words[..6],
        ["between", "9", "1.9", "0.2111", "0.003364", "2.393"]
    );
    assert!(
        text.contains("note: F = 3.36e-3 is smaller than chance makes it"),
        "{text}"
    );
}

#[test]
fn what_cannot_be_used_is_said_with_line_and_column() {
    let file = written("trial,passing\n1,20\n1,many\n");
    let one = written("trial,passing\n1,20\n1,21\n");
    let columns = ["--group", "trial", "--value", "passing"];
    for (file, more, status, sentence) in [
        (
            &file,
            &columns[..],
            1,
            ":3: column passing: 'many' is not a number; ",
        ),
        (&one, &columns[..], 1, ": there is one group only; "),
        (
            &one,
            &["--group", "round", "--value", "passing"],
            1,
            ":1: there is no column 'round'; name",
        ),
        (&one, &["--group", "trial"], 2, "--value"),
        (
            &one,
            &["--between", "9,1", "--within", "20,1"],
            2,
            "cannot be used with",
        ),
    ] {
        let output = crate::common::fragscale(&[&["anova", path(file)][..], more].concat());
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{stderr}");
        assert!(stderr.contains(sentence), "{stderr}");
        assert_eq!(stderr.lines().count(), 1, "{stderr}");
    }
}

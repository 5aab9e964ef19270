//! Fits of size distributions against scipy, an independent program: the bundled reference curve and
//! real grain sizes.
//!
//! scipy's answers are of `scipy.optimize.least_squares` (trf, all tolerances 1e-15) in logarithms of
//! the parameters, the best of 25 random starts (75 for five parameters), xmax at or above the largest
//! size for Swebrec; for Gates-Gaudin-Schuhmann P = min(1, (x / xmax)^m).

use std::path::Path;

use crate::common::{shared_data, stdout_of};
use fragscale::fragmentation::{FitOptions, Model, SizeDistribution, fit};
use serde_json::Value;

fn near(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs())
}

/// Row (from 0) and scipy's least sums of Swebrec, of the extended one (where scipy's starts found the
/// least), of Rosin-Rammler, of Gates-Gaudin-Schuhmann.
const ROWS: [(usize, f64, Option<f64>, f64, f64); 12] = [
    (0, 160.994379, Some(20.0831337), 406.316338, 672.174283),
    (2, 108.620524, Some(27.0466475), 112.773663, 291.878962),
    (6, 40.6770956, Some(8.74898507), 161.61056, 372.51392),
    (9, 126.027911, Some(29.4479222), 194.146419, 354.419504),
    (10, 55.7510663, Some(6.9338189), 106.449697, 348.018516),
    (12, 125.035667, Some(13.7405214), 216.152714, 435.406412),
    (13, 65.9301399, Some(12.356116), 52.9158142, 135.500465),
    (24, 138.991849, Some(108.451033), 160.57439, 273.023445),
    (34, 199.960844, None, 231.828908, 165.167214),
    (35, 4.56224546, Some(2.45258692), 25.9505503, 277.711015),
    (72, 51.1726789, Some(33.8880428), 55.8189059, 52.1122758),
    (352, 607.963174, None, 767.848273, 1087.82473),
];

#[test]
fn real_grain_sizes_have_scipys_least_sums() {
    const PERCENTS: [u32; 9] = [5, 10, 16, 25, 50, 75, 84, 90, 95];
    let Some(path) = shared_data("rock-photosieving-csv/Master_Matrix.csv") else {
        return;
    };
    let mut reader = csv::Reader::from_path(path).expect("a table");
    let header = reader.headers().expect("a header").clone();
    let column = |percent: u32| {
        let name = format!("D{percent}");
        header
            .iter()
            .position(|found| *found == name)
            .expect("a column")
    };
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("a row")).collect();
    for (row, swebrec, swebrec5, rosin_rammler, ggs) in ROWS {
        let points = PERCENTS.map(|percent| {
            let size = rows[row][column(percent)].parse().expect("a size");
            [size, f64::from(percent)]
        });
        let distribution = SizeDistribution::new(points.to_vec()).expect("it rises");
        for (model, scipy) in [
            (Model::Swebrec, Some(swebrec)),
            (Model::Swebrec5, swebrec5),
            (Model::RosinRammler, Some(rosin_rammler)),
            (Model::GatesGaudinSchuhmann, Some(ggs)),
        ] {
            let Some(scipy) = scipy else { continue };
            let fit = fit(&distribution, model, &FitOptions::default()).expect("a fit");
            let sum = fit.residual_sum_of_squares;
            assert!(
                near(sum, scipy, 1e-6),
                "row {row} {}: {sum}, scipy {scipy}",
                model.key()
            );
        }
    }
}

fn reference() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample/reference.csv");
    path.to_str().expect("a UTF-8 path").to_owned()
}

fn fit_of_reference(model: &str, more: &[&str]) -> Value {
    let path = reference();
    let mut arguments = vec!["psd", "fit", &path, "--model", model, "--format", "json"];
    arguments.extend(["--size", "size_mm", "--passing", "percent_passing"]);
    arguments.extend(more);
    serde_json::from_str(&stdout_of(&arguments)).expect("JSON")
}

/// Parameters, standard errors and sums of `scipy.optimize.curve_fit`.
#[test]
fn the_reference_curve_has_scipys_parameters_and_standard_errors() {
    let swebrec = [
        ("xmax", 25.195339, 0.13505),
        ("x50", 10.6270169, 0.0132449),
        ("b", 2.18318429, 0.012712),
    ];
    let rosin_rammler = [("x50", 9.90725731, 0.330539), ("n", 1.65070374, 0.113193)];
    let ggs = [("xmax", 19.6758147, 0.374914), ("m", 1.11849769, 0.0319584)];
    for (model, sum, parameters) in [
        ("swebrec", 0.1497628407, &swebrec[..]),
        ("rosin-rammler", 156.478017, &rosin_rammler[..]),
        ("ggs", 27.08648649, &ggs[..]),
    ] {
        let fit = fit_of_reference(model, &[]);
        let of = |key: &str, name: &str| fit[key][name].as_f64().expect("a number");
        for &(name, value, error) in parameters {
            assert!(near(of("parameters", name), value, 1e-6), "{model} {name}");
            // scipy's Jacobian is of differences.
            assert!(
                near(of("standard_errors", name), error, 1e-4),
                "{model} {name}"
            );
        }
        let found = fit["residual_sum_of_squares"].as_f64().expect("a number");
        assert!(near(found, sum, 1e-7), "{model}: {found}");
    }
    // By the delta method from scipy's covariance and its Student's t.
    let fit = fit_of_reference("rosin-rammler", &[]);
    let number = |value: &Value| value.as_f64().expect("a number");
    assert!(near(number(&fit["percentiles"]["p80"]), 16.503856547, 1e-7));
    let band = &fit["percentile_bands"]["p80"];
    assert!(near(number(&band[0]), 14.944347, 1e-4));
    assert!(near(number(&band[1]), 18.226108, 1e-4));
    let point = &fit["points"][10];
    assert_eq!(number(&point["size"]), 8.0);
    assert!(near(number(&point["band"][0]), 34.472454, 1e-4));
    assert!(near(number(&point["band"][1]), 42.635028, 1e-4));
}

/// The largest size counts as the table's sizes do, whatever unit they are brought to.
#[test]
fn the_largest_size_is_in_the_unit_of_the_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let points = [(4, 10), (8, 20), (16, 45), (32, 80), (64, 100)];
    for (unit, in_mm) in [("µm", 0.001), ("mm", 1.0), ("dm", 100.0)] {
        let file = folder.path().join("table.csv");
        let rows = points.map(|(size, passing)| format!("{size},{passing}\n"));
        let text = format!("size ({unit}),percent passing\n{}", rows.concat());
        std::fs::write(&file, text).expect("written");
        let file = file.to_str().expect("a path");
        let found = stdout_of(&["psd", "fit", file, "--xmax", "100", "--format", "json"]);
        let found: Value = serde_json::from_str(&found).expect("JSON");
        let mm = match found["unit"].as_str() {
            Some("mm") => 1.0,
            Some("cm") => 10.0,
            other => panic!("{other:?}: {found}"),
        };
        let xmax = found["parameters"]["xmax"].as_f64().expect("xmax") * mm;
        assert!(near(xmax, 100.0 * in_mm, 1e-12), "{unit}: {xmax}");
        // The points are the same in their own unit.
        let b = found["parameters"]["b"].as_f64().expect("b");
        assert!(near(b, 3.484_160, 1e-5), "{unit}: {b}");
    }
}

/// The sample's fragments are drawn from Swebrec of x50 10.5 mm, xmax 25 mm, b 2.2
/// (`src/sample/preset.rs`): a draw of some thousands is near it.
#[test]
fn the_sample_gives_its_recipe_back() {
    let fit = fit_of_reference("swebrec", &[]);
    for (name, recipe, relative) in [("xmax", 25.0, 0.02), ("x50", 10.5, 0.02), ("b", 2.2, 0.02)] {
        let found = fit["parameters"][name].as_f64().expect("a number");
        assert!(near(found, recipe, relative), "{name}: {found}");
    }
}

#[test]
fn a_largest_size_that_is_known_is_kept_and_every_format_is_written() {
    let fit = fit_of_reference("swebrec", &["--xmax", "25", "--percentiles", "2.5,80"]);
    assert_eq!(fit["parameters"]["xmax"], 25.0);
    assert_eq!(fit["standard_errors"]["xmax"], Value::Null);
    assert_eq!(fit["degrees_of_freedom"], 12);
    assert!(fit["percentiles"]["p2.5"].is_f64() && fit["percentiles"]["p30"].is_f64());
    assert_eq!(fit["unit"], "mm");
    let path = reference();
    let table = stdout_of(&["psd", "fit", &path]);
    assert!(
        table.contains("Swebrec fitted to 14 points; sizes in mm"),
        "{table}"
    );
    assert!(table.contains("topsize (P99.95)"), "{table}");
    let csv = stdout_of(&["psd", "fit", &path, "--format", "csv"]);
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let quantities: Vec<String> = reader
        .records()
        .map(|row| row.expect("a row")[2].to_owned())
        .collect();
    for wanted in ["xmax", "x50", "b", "r_squared", "p10", "p90", "topsize"] {
        assert!(quantities.iter().any(|found| found == wanted), "{wanted}");
    }
}

fn table(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("t.csv"), text).expect("a file");
    folder
}

/// RSS of the weighted fit and its parameters by `curve_fit(sigma = 1 / sqrt(w))`, w = 1 / (1 + size).
#[test]
fn weights_are_scipys() {
    let points = std::fs::read_to_string(reference()).expect("the sample");
    let mut text = String::from("size_mm,percent_passing,w\n");
    for line in points.lines().skip(1) {
        let size: f64 = line
            .split(',')
            .next()
            .expect("a size")
            .parse()
            .expect("a number");
        text += &format!("{line},{}\n", 1.0 / (1.0 + size));
    }
    let folder = table(&text);
    let path = folder.path().join("t.csv");
    let path = path.to_str().expect("a UTF-8 path");
    let output = stdout_of(&[
        "psd",
        "fit",
        path,
        "--size",
        "size_mm",
        "--passing",
        "percent_passing",
        "--weights",
        "w",
        "--model",
        "rosin-rammler",
        "--format",
        "json",
    ]);
    let fit: Value = serde_json::from_str(&output).expect("JSON");
    let number = |value: &Value| value.as_f64().expect("a number");
    assert!(near(number(&fit["parameters"]["x50"]), 10.038302, 1e-6));
    assert!(near(number(&fit["parameters"]["n"]), 1.33726643, 1e-6));
    assert!(near(number(&fit["standard_errors"]["n"]), 0.1038, 1e-3));
    assert!(near(
        number(&fit["residual_sum_of_squares"]),
        33.63063457,
        1e-7
    ));
}

#[test]
fn several_curves_are_an_array_and_one_that_cannot_be_fitted_is_said() {
    let folder = table(
        "photo,size_mm,percent_passing\n\
         a,1,10\na,2,30\na,4,60\na,8,90\nb,1,20\nb,2,40\n",
    );
    let path = folder.path().join("t.csv");
    let path = path.to_str().expect("a UTF-8 path");
    let output = crate::common::fragscale(&["psd", "fit", path, "--format", "json"]);
    assert_eq!(output.status.code(), Some(0));
    let fits: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(fits.as_array().map(Vec::len), Some(1));
    assert_eq!(fits[0]["curve"], "a");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("warning: b: left out: 2 points for the 3 parameters"),
        "{said}"
    );
    let output = crate::common::fragscale(&["psd", "fit", path, "--model", "swebrec5"]);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("4 points for the 5 parameters"), "{said}");
}

/// What nobody measured is the function's alone, and is said where people read it; the largest size, too.
#[test]
fn sizes_beyond_what_was_measured_are_named() {
    let said_with = |text: &str, more: &[&str]| {
        let folder = table(text);
        let path = folder.path().join("t.csv");
        let mut arguments = vec!["psd", "fit", path.to_str().expect("a UTF-8 path")];
        arguments.extend(more);
        let told = stdout_of(&arguments);
        let line = told
            .lines()
            .find(|line| line.starts_with("beyond what was measured"));
        line.map(str::to_owned)
    };
    let said = |text: &str| said_with(text, &[]);
    // P10 is 9.70 mm and P90 100.6 mm by scipy, too; P99.95 286 mm and xmax 469 mm by a Nelder-Mead search in Python.
    let open = "size_mm,percent_passing\n10,10\n25,30\n50,60\n100,90\n";
    assert_eq!(
        said(open).expect("a line"),
        "beyond what was measured, by the function alone: P10 (below 10 mm) and P90, topsize (P99.95), xmax (above 100 mm)"
    );
    // By the same: 282 mm and 453 mm.
    let longer = "size_mm,percent_passing\n1,2\n10,10\n25,30\n50,60\n100,90\n200,99\n";
    assert_eq!(
        said(longer).expect("a line"),
        "beyond what was measured, by the function alone: topsize (P99.95), xmax (above 200 mm)"
    );
    // Swebrec of xmax 64, x50 16, b 2 by hand: at 16 * 4^-k mm it is 100 / (1 + (1 + k)^2) %. P10 is 1 mm, P90 40.3 mm, P99.95 62.0 mm.
    let points =
        "size_mm,percent_passing\n0.5,7.5472\n1,10\n2,13.7931\n4,20\n8,30.7692\n16,50\n32,80\n";
    assert_eq!(said(&format!("{points}128,100\n")), None);
    let last = format!("{points}36.7583,86.2068\n");
    let beyond = "beyond what was measured, by the function alone: P90, topsize (P99.95)";
    assert_eq!(
        said(&last).expect("a line"),
        format!("{beyond}, xmax (above 36.7583 mm)")
    );
    // Three points for three parameters: it goes through them, and gives 500 mm and 210 mm back but for rounding.
    assert_eq!(
        said("size_mm,percent_passing\n1000,100\n800,97\n500,80\n").expect("a line"),
        "beyond what was measured, by the function alone: P10, P20, P30, P40, P50, P60, P70 (below 500 mm)"
    );
    assert_eq!(
        said("photo;D10 [mm];D50 [mm];D80 [mm]\nA;12,5;88;210\n").expect("a line"),
        format!("{beyond}, xmax (above 210 mm)")
    );
    // A largest size that is known is no guess.
    assert_eq!(
        said_with(&last, &["--xmax", "64"]).expect("a line"),
        format!("{beyond} (above 36.7583 mm)")
    );
    // Rosin-Rammler has none.
    let of_rosin_rammler = said_with(open, &["--model", "rosin-rammler"]).expect("a line");
    assert!(!of_rosin_rammler.contains("xmax"), "{of_rosin_rammler}");
}

/// Two sieves that everything passed say nothing: they neither make the fit look better nor are they passed over without a word.
#[test]
fn what_says_nothing_does_not_make_a_fit_look_better() {
    let below = "size_mm,percent_passing\n6.3,38\n12.5,60\n25,90\n";
    let said = |text: &str, format: &str| {
        let folder = table(text);
        let path = folder.path().join("t.csv");
        let path = path.to_str().expect("a UTF-8 path");
        let model = "ggs";
        stdout_of(&["psd", "fit", path, "--model", model, "--format", format])
    };
    let fit = |text: &str| -> Value { serde_json::from_str(&said(text, "json")).expect("JSON") };
    let all = format!("{below}100,100\n250,100\n");
    let (few, many) = (fit(below), fit(&all));
    assert_eq!(many["telling_points"], 3);
    for name in ["rmse", "r_squared"] {
        let [one, other] = [&few, &many].map(|fit| fit[name].as_f64().expect("a number"));
        assert!(near(one, other, 1e-6), "{name} {one} {other}");
    }
    let told =
        "RMSE and R squared are of the 3 points that say something of the parameters, not of 2 ";
    assert!(said(&all, "table").contains(told));
    assert!(!said(below, "table").contains("RMSE and R squared are of"));
    assert!(said(&all, "csv").contains(",telling_points,,3,,,\n"));
}

/// Points that rise more slowly at their end than Swebrec without a largest size does.
#[test]
fn a_largest_size_that_the_data_do_not_say_is_no_number_in_table_and_csv() {
    let folder = table("size_mm,percent_passing\n1,9\n2.5,20\n10,50\n40,78\n90,87\n");
    let path = folder.path().join("t.csv");
    let path = path.to_str().expect("a UTF-8 path");
    let why = "the data do not say a largest size";
    let output = crate::common::fragscale(&["psd", "fit", path, "--format", "csv"]);
    let csv = String::from_utf8_lossy(&output.stdout).into_owned();
    for row in [",swebrec,xmax,mm,,,,\n", ",swebrec,b,,,,,\n"] {
        assert!(csv.contains(row), "{csv}");
    }
    assert!(csv.contains(",swebrec,x50,mm,10.5"), "{csv}");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(said.matches(why).count(), 1, "{said}");
    let output = crate::common::fragscale(&["psd", "fit", path]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let rows = text.lines().filter(|line| line.contains("not determined"));
    let names: Vec<&str> = rows.filter_map(|row| row.split(' ').next()).collect();
    assert_eq!(names, ["xmax", "b"], "{text}");
    assert!(text.contains(&format!("note: {why}")), "{text}");
    assert!(!text.contains("topsize (P99.95), xmax (above"), "{text}");
    // It is in the notes there.
    assert!(!String::from_utf8_lossy(&output.stderr).contains(why));
    let json: Value =
        serde_json::from_str(&stdout_of(&["psd", "fit", path, "--format", "json"])).expect("JSON");
    assert!(json["parameters"]["xmax"].as_f64().expect("a number") > 1e90);
}

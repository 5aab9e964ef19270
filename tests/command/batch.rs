//! Many flights: each for itself, what is done is not done again, and a killed season ends as an undisturbed one.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

use crate::common::fragscale;

/// The bundled flight, which `sample` made, without photo files; flown a little higher with each number, so that no two
/// are alike. (Making another pile takes many seconds.)
fn small(folder: &Path, number: usize) {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    fs::create_dir_all(folder).expect("a folder");
    for name in ["ost.yaml", "pile.ply"] {
        fs::copy(sample.join(name), folder.join(name)).expect("a copy");
    }
    let text = fs::read_to_string(sample.join("flight.toml")).expect("a flight");
    let lines = text.lines().filter(|line| !line.starts_with("folder"));
    let text: String = lines.flat_map(|line| [line, "\n"]).collect();
    fs::write(folder.join("flight.toml"), text).expect("written");
    let poses = fs::read_to_string(sample.join("poses.csv")).expect("the poses");
    let heads: Vec<&str> = poses
        .lines()
        .find(|line| line.starts_with("photo,"))
        .expect("heads")
        .split(',')
        .collect();
    let z = heads
        .iter()
        .position(|head| *head == "z")
        .expect("a column");
    let mut text = String::new();
    for line in poses.lines() {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if line.starts_with("IMG_") {
            let height: f64 = cells[z].parse().expect("a number");
            cells[z] = (height + number as f64 * 0.001).to_string();
        }
        text += &(cells.join(",") + "\n");
    }
    fs::write(folder.join("poses.csv"), text).expect("written");
}

/// The bundled flight with some of its photos.
fn with_photos(folder: &Path, count: usize) {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    fs::create_dir_all(folder.join("photos")).expect("a folder");
    for name in ["flight.toml", "ost.yaml", "pile.ply"] {
        fs::copy(sample.join(name), folder.join(name)).expect("a copy");
    }
    let poses = fs::read_to_string(sample.join("poses.csv")).expect("the poses");
    let is_kept = |line: &&str| {
        let number = line.strip_prefix("IMG_000").and_then(|rest| rest.get(..1));
        number.is_none_or(|number| number.parse().is_ok_and(|number: usize| number <= count))
    };
    let kept: String = poses
        .lines()
        .filter(is_kept)
        .flat_map(|line| [line, "\n"])
        .collect();
    fs::write(folder.join("poses.csv"), kept).expect("written");
    for number in 1..=count {
        let name = format!("photos/IMG_000{number}.jpg");
        fs::copy(sample.join(&name), folder.join(&name)).expect("a copy");
    }
}

/// Flights that cannot be done, each for another reason.
fn broken(root: &Path) {
    small(&root.join("no-cloud"), 90);
    fs::remove_file(root.join("no-cloud/pile.ply")).expect("removed");
    small(&root.join("bad-toml"), 91);
    let toml = root.join("bad-toml/flight.toml");
    let text = fs::read_to_string(&toml)
        .expect("a flight")
        .replace("unit", "unti");
    fs::write(toml, text).expect("written");
}

/// All files below a folder with their bytes.
fn tree(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(inside) = waiting.pop() {
        for entry in fs::read_dir(inside).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                waiting.push(path);
            } else {
                let bytes = fs::read(&path).expect("a file");
                found.insert(path.strip_prefix(folder).expect("below").to_owned(), bytes);
            }
        }
    }
    found
}

fn assert_same(found: &Path, expected: &Path) {
    let (found, expected) = (tree(found), tree(expected));
    let names: Vec<_> = found.keys().collect();
    assert_eq!(names, expected.keys().collect::<Vec<_>>());
    for (name, bytes) in &found {
        let [now, then] = [bytes, &expected[name]].map(|bytes| String::from_utf8_lossy(bytes));
        let lines = now
            .lines()
            .zip(then.lines())
            .find(|(now, then)| now != then);
        assert!(
            bytes == &expected[name],
            "{} differs: {lines:?}",
            name.display()
        );
    }
}

/// `batch` in a folder, so that paths are the same whatever the folder is called.
fn command(root: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fragscale"));
    command.current_dir(root).arg("batch").args(arguments);
    command
}

fn batch(root: &Path, arguments: &[&str]) -> Output {
    command(root, arguments).output().expect("it starts")
}

fn status(output: &Output) -> i32 {
    output.status.code().expect("a status")
}

/// What was said of each flight, by its blast: done, as before or failed.
fn said(output: &Output) -> BTreeMap<String, String> {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    let lines = text.lines().filter(|line| line.starts_with('['));
    let words = lines.filter_map(|line| {
        let (word, rest) = line.split_once("] ")?.1.split_once("  ")?;
        let (blast, _) = rest.trim_start().split_once(": ")?;
        Some((blast.to_owned(), word.trim().to_owned()))
    });
    words.collect()
}

fn all(pairs: &[(&str, &str)]) -> BTreeMap<String, String> {
    let owned = pairs
        .iter()
        .map(|(a, b)| ((*a).to_owned(), (*b).to_owned()));
    owned.collect()
}

#[test]
fn what_is_done_is_not_done_again() {
    let root = tempfile::tempdir().expect("a folder");
    let root = root.path();
    for (name, seed) in [("a", 1), ("b", 2)] {
        small(&root.join("season").join(name), seed);
    }
    let arguments = ["season", "--to", "out", "--steps", "scales"];
    let output = batch(root, &arguments);
    assert_eq!(status(&output), 0, "{output:?}");
    assert_eq!(said(&output), all(&[("a", "done"), ("b", "done")]));
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        table.starts_with("blast") && table.lines().count() == 3,
        "{table}"
    );
    // The same files as those of the command for one flight.
    for name in ["a", "b"] {
        for format in ["csv", "json"] {
            let flight = format!("season/{name}");
            let single = Command::new(env!("CARGO_BIN_EXE_fragscale"))
                .current_dir(root)
                .args(["scales", &flight, "--format", format])
                .output()
                .expect("it starts");
            let file = root.join(format!("out/{name}/scales.{format}"));
            assert_eq!(fs::read(file).expect("a file"), single.stdout);
        }
    }
    let before = tree(&root.join("out"));
    let output = batch(root, &arguments);
    assert_eq!(status(&output), 0);
    assert_eq!(
        said(&output),
        all(&[("a", "as before"), ("b", "as before")])
    );
    assert_eq!(String::from_utf8_lossy(&output.stdout), table);
    assert!(tree(&root.join("out")) == before);

    // Another input: that flight alone.
    let poses = root.join("season/b/poses.csv");
    let text = fs::read_to_string(&poses).expect("poses") + "# looked at\n";
    fs::write(&poses, text).expect("written");
    let output = batch(root, &arguments);
    assert_eq!(said(&output), all(&[("a", "as before"), ("b", "done")]));
    // A result that is gone.
    fs::remove_file(root.join("out/a/scales.json")).expect("removed");
    let output = batch(root, &arguments);
    assert_eq!(said(&output), all(&[("a", "done"), ("b", "as before")]));
    // Another version of the program.
    let record = root.join("out/b/flight.json");
    let text = fs::read_to_string(&record).expect("a record");
    let version = format!("\"program\": \"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(text.contains(&version), "{text}");
    fs::write(&record, text.replace(&version, "\"program\": \"0.0.1\"")).expect("written");
    let output = batch(root, &arguments);
    assert_eq!(said(&output), all(&[("a", "as before"), ("b", "done")]));
    // Other options: all; and what a step wrote that is not asked for any more is gone, what others put there stays.
    fs::write(root.join("out/a/notes.txt"), "mine").expect("written");
    let output = batch(root, &["season", "--to", "out", "--steps", "check"]);
    assert_eq!(said(&output), all(&[("a", "done"), ("b", "done")]));
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    let taken_away: Vec<&str> = told
        .lines()
        .filter(|line| line.starts_with("taken away: "))
        .collect();
    let of_both = |name: &str| {
        format!("taken away: {name} of 2 flights, which an earlier run wrote and this one does not")
    };
    assert_eq!(taken_away, ["scales.csv", "scales.json"].map(of_both));
    let names: Vec<PathBuf> = tree(&root.join("out/a")).into_keys().collect();
    assert_eq!(
        names,
        ["check.txt", "flight.json", "notes.txt"].map(PathBuf::from)
    );
    // One that comes later.
    small(&root.join("season/c"), 3);
    let output = batch(
        root,
        &[
            "season", "--to", "out", "--steps", "check", "--format", "jsonl",
        ],
    );
    assert_eq!(
        said(&output),
        all(&[("a", "as before"), ("b", "as before"), ("c", "done")])
    );
    let lines = String::from_utf8_lossy(&output.stdout).into_owned();
    let lines: Vec<Value> = lines
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    assert_eq!(lines.len(), 3);
    assert!(
        lines
            .iter()
            .all(|line| line["photos"] == 9 && line["state"] == "done")
    );
}

#[test]
fn a_broken_flight_fails_alone() {
    let root = tempfile::tempdir().expect("a folder");
    let root = root.path();
    small(&root.join("season/good"), 1);
    broken(&root.join("season"));
    fs::create_dir_all(root.join("season/empty")).expect("a folder");
    fs::create_dir_all(root.join("empty")).expect("a folder");
    let flights =
        ["season", "empty", "missing"].map(|path| format!("[[flight]]\npath = \"{path}\"\n"));
    let season = format!("format = 1\n{}", flights.concat());
    fs::write(root.join("SEASON.toml"), season).expect("written");
    let output = batch(
        root,
        &[
            "SEASON.toml",
            "--to",
            "out",
            "--steps",
            "scales",
            "--jobs",
            "2",
        ],
    );
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(status(&output), 3, "{text}");
    let mut expected = all(&[
        ("good", "done"),
        ("bad-toml", "failed"),
        ("no-cloud", "failed"),
    ]);
    expected.extend(all(&[("empty", "failed"), ("missing", "failed")]));
    assert_eq!(said(&output), expected, "{text}");
    // One line each, with the place and what to do.
    let errors: Vec<&str> = text
        .lines()
        .filter(|line| line.starts_with("error: "))
        .collect();
    assert_eq!(errors.len(), 1, "{text}");
    assert!(errors[0].contains("4 of 5 flights failed"), "{text}");
    assert!(
        text.contains("bad-toml/flight.toml:") && text.contains("unknown key 'unti'"),
        "{text}"
    );
    assert!(
        text.contains("warning: 1 folder holds no flight: season/empty"),
        "{text}"
    );
    let csv = fs::read_to_string(root.join("out/season.csv")).expect("a table");
    assert_eq!(csv.lines().count(), 6, "{csv}");
    assert!(csv.contains("unknown key"), "{csv}");
    assert!(!root.join("out/bad-toml").exists());
    // Mended, it is done; the good one is not done again.
    let toml = root.join("season/bad-toml/flight.toml");
    let text = fs::read_to_string(&toml)
        .expect("a flight")
        .replace("unti", "unit");
    fs::write(toml, text).expect("written");
    let output = batch(root, &["season", "--to", "out", "--steps", "scales"]);
    assert_eq!(status(&output), 3);
    assert_eq!(
        said(&output),
        all(&[
            ("good", "as before"),
            ("bad-toml", "done"),
            ("no-cloud", "failed")
        ])
    );
    // What an earlier cloud gave does not pass for what the broken one gives; what a flight of another name gave is named.
    assert!(root.join("out/good/scales.csv").is_file());
    fs::write(root.join("season/good/pile.ply"), "ply\n").expect("written");
    fs::rename(root.join("season/bad-toml"), root.join("season/renamed")).expect("renamed");
    let output = batch(root, &["season", "--to", "out", "--steps", "scales"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(status(&output), 3, "{text}");
    let word = || fs::read_to_string(root.join("out/good/failed.txt"));
    let said = word().expect("a word");
    assert!(
        said.contains("pile.ply") && said.contains("may be of an earlier run"),
        "{said}"
    );
    assert!(root.join("out/bad-toml/scales.csv").is_file());
    assert!(
        text.contains("results of flights that are none of these stay in out: bad-toml"),
        "{text}"
    );
    // Mended, nothing of it is left.
    small(&root.join("season/good"), 1);
    let output = batch(root, &["season", "--to", "out", "--steps", "scales"]);
    assert_eq!(status(&output), 3);
    assert!(word().is_err() && root.join("out/good/scales.csv").is_file());
}

/// A season of one flight, with sizes held against a sieve, which says so besides: where it was done, what was said, and the status.
fn sized(more: &str) -> (TempDir, String, i32) {
    let root = tempfile::tempdir().expect("a folder");
    with_photos(&root.path().join("a"), 1);
    let season = format!("format = 1\nto = \"out\"\nsteps = [\"delineate\", \"psd\"]\n{more}");
    fs::write(root.path().join("SEASON.toml"), season).expect("written");
    let output = batch(root.path(), &["SEASON.toml"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    (root, text, status(&output))
}

/// What a step lacks is said before the others are done.
#[test]
fn a_missing_reference_is_said_first() {
    let (root, text, status) = sized("[[flight]]\npath = \"a\"\nreference = \"nosieve.csv\"\n");
    let root = root.path();
    assert_eq!(status, 3, "{text}");
    assert!(
        text.contains("nosieve.csv: there is no such file"),
        "{text}"
    );
    assert!(!root.join("out/a").exists());
}

/// A season that names a reference and leaves out psd says so, and holds sizes against it where psd is asked for after all.
#[test]
fn a_reference_waits_for_psd() {
    let root = tempfile::tempdir().expect("a folder");
    let root = root.path();
    small(&root.join("a"), 1);
    let season = "format = 1\nto = \"out\"\nsteps = [\"scales\"]\n[psd]\nreference = \"nosieve.csv\"\n[[flight]]\npath = \"a\"\n";
    fs::write(root.join("SEASON.toml"), season).expect("written");
    let output = batch(root, &["SEASON.toml"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(status(&output), 0, "{text}");
    let said = "warning: SEASON.toml: [psd] names a reference, but psd is not among the steps";
    assert_eq!(text.matches(said).count(), 1, "{text}");
    let output = batch(root, &["SEASON.toml", "--steps", "delineate,psd"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(status(&output), 3, "{text}");
    let missing = "nosieve.csv: there is no such file";
    assert!(text.contains(missing) && !text.contains(said), "{text}");
}

/// Of many blasts one was sieved: the others are done all the same, and it is said that nothing holds their sizes.
#[test]
fn a_blast_that_nobody_sieved_is_done() {
    let (root, text, status) =
        sized("[delineate]\nengine = \"classical\"\n[[flight]]\npath = \"a\"\n");
    let root = root.path();
    assert_eq!(status, 0, "{text}");
    let said = "warning: psd is passed over for all flights: no reference is named";
    assert_eq!(text.matches(said).count(), 1, "{text}");
    let report = fs::read_to_string(root.join("out/season.html")).expect("a report");
    assert!(
        report.contains("psd: no reference is named for it"),
        "{report}"
    );
    assert!(root.join("out/a/fragments/distribution.csv").is_file());
    assert!(!root.join("out/a/psd.csv").exists());
}

/// All steps of a season, by a SEASON.toml: every file is the one that the single command writes.
#[test]
fn every_file_is_that_of_the_single_command() {
    let root = tempfile::tempdir().expect("a folder");
    let root = root.path();
    with_photos(&root.join("flights/one"), 1);
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    // A belt's photos in the same table, half as coarse again: nothing is held against them.
    let sieve = fs::read_to_string(sample.join("reference.csv")).expect("a table");
    let points: Vec<[f64; 2]> = sieve
        .lines()
        .filter_map(|line| {
            let (size, percent) = line.split_once(',')?;
            Some([size.parse().ok()?, percent.parse().ok()?])
        })
        .collect();
    let rows = |method: &str, factor: f64| -> String {
        let row = |[size, percent]: &[f64; 2]| format!("{method},{},{percent}\n", size * factor);
        points.iter().map(row).collect()
    };
    let table = format!(
        "method,size_mm,percent_passing\n{}{}",
        rows("belt", 1.5),
        rows("sieve", 1.0)
    );
    fs::write(root.join("sieve.csv"), table).expect("written");
    // What fits the pattern beside the flights, and is none.
    fs::write(root.join("flights/notes.txt"), "hi\n").expect("written");
    fs::write(
        root.join("flights/other.toml"),
        "format = 1\n[[flight]]\npath = \"one\"\n",
    )
    .expect("written");
    let season = "format = 1\nname = \"Trial\"\nto = \"results\"\nunit = \"mm\"\n\
        steps = [\"scales\", \"check\", \"export\", \"scale-map\", \"delineate\", \"psd\"]\n\
        [scale-map]\nlayers = [\"scale\", \"z\"]\n[delineate]\nengine = \"classical\"\nalso = [\"coco\"]\n\
        [psd]\nreference = \"sieve.csv\"\n[[flight]]\npath = \"flights/*\"\ndate = 2026-05-31\nname = \"B 1\"\n";
    fs::write(root.join("season.toml"), season).expect("written");
    let output = batch(root, &["season.toml"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(status(&output), 0, "{text}");
    assert!(
        text.contains("2 files are no flights: flights/notes.txt, flights/other.toml"),
        "{text}"
    );
    let single = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_fragscale"))
            .current_dir(root)
            .args(arguments)
            .output()
            .expect("it starts");
        assert_eq!(output.status.code(), Some(0), "{arguments:?} {output:?}");
    };
    // As deep as the batch's, because an export knows the way to its flight.
    fs::create_dir_all(root.join("single/B 1")).expect("a folder");
    let flight = "flights/one";
    for format in ["csv", "json"] {
        let file = format!("single/B 1/scales.{format}");
        single(&[
            "scales", flight, "--unit", "mm", "--format", format, "-o", &file,
        ]);
    }
    single(&["check", flight, "-o", "single/B 1/check.txt"]);
    single(&[
        "export",
        flight,
        "--unit",
        "mm",
        "--to",
        "single/B 1/split-desktop",
    ]);
    single(&[
        "scale-map",
        flight,
        "--all",
        "--unit",
        "mm",
        "--layers",
        "scale,z",
        "-o",
        "single/B 1/scale-maps",
    ]);
    let fragments = "single/B 1/fragments";
    single(&[
        "delineate",
        flight,
        "--unit",
        "mm",
        "--engine",
        "classical",
        "--also",
        "coco",
        "--to",
        fragments,
    ]);
    // The report names its files as they were named.
    fs::rename(root.join("results/B 1"), root.join("kept")).expect("moved");
    fs::create_dir_all(root.join("results/B 1/fragments")).expect("a folder");
    fs::copy(
        root.join(fragments).join("distribution.csv"),
        root.join("results/B 1/fragments/distribution.csv"),
    )
    .expect("a copy");
    single(&[
        "psd",
        "compare",
        "sieve.csv",
        "results/B 1/fragments/distribution.csv",
        "--format",
        "csv",
        "-o",
        "single/B 1/psd.csv",
        "--report",
        "single/B 1/psd.html",
    ]);
    fs::remove_file(root.join("kept/flight.json")).expect("a record");
    assert_same(&root.join("kept"), &root.join("single/B 1"));

    let lines = fs::read_to_string(root.join("results/season.jsonl")).expect("lines");
    let line: Value = serde_json::from_str(&lines).expect("JSON");
    assert_eq!(
        (&line["blast"], &line["date"], &line["unit"]),
        (&"B 1".into(), &"2026-05-31".into(), &"mm".into())
    );
    // The sizes are those of the flight's own table.
    let sizes = fs::read_to_string(root.join(fragments).join("sizes.csv")).expect("sizes");
    let row = sizes
        .lines()
        .find(|line| line.starts_with("all photos,80,"))
        .expect("a row");
    let cells: Vec<f64> = row
        .split(',')
        .skip(2)
        .map(|cell| cell.parse().expect("a number"))
        .collect();
    let eighty = &line["sizes"][2];
    for (key, cell) in ["size", "low", "high"].into_iter().zip(cells) {
        let size = eighty[key].as_f64().expect("a size");
        assert!((size / cell - 1.0).abs() < 1e-12, "{key}: {size} {cell}");
    }
    // How far they are from the sieve, by hand: between two sieves the logarithm of the size goes with the percent.
    let at = points
        .iter()
        .position(|[_, percent]| *percent >= 80.0)
        .expect("a sieve");
    let [[s0, p0], [s1, p1]] = [points[at - 1], points[at]];
    let sieved = s0 * (s1 / s0).powf((80.0 - p0) / (p1 - p0));
    let shifts = line["off_reference"].as_array().expect("shifts");
    let shift = shifts
        .iter()
        .find(|shift| shift["percent"] == 80.0)
        .expect("P80");
    let wanted = 100.0 * (eighty["size"].as_f64().expect("a size") / sieved - 1.0);
    let off = shift["off_percent"].as_f64().expect("a number");
    assert!((off - wanted).abs() < 1e-9, "{off} {wanted}");
    let page = fs::read_to_string(root.join("results/season.html")).expect("a page");
    assert!(page.contains("<svg") && page.contains("2026-05-31"));
}

/// Pseudo random, so that a failure comes again.
fn random(state: &mut u64, below: u64) -> u64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 33) % below
}

/// Runs a batch, killing it so many times at random moments of the work, which takes so long undisturbed: each run goes
/// on where the one before was killed. Then until it ends by itself; and how many of the kills met it at work.
fn killed(
    root: &Path,
    arguments: &[&str],
    kills: usize,
    length: Duration,
    seed: u64,
) -> (Output, usize) {
    let mut state = seed;
    let mut hit = 0;
    let mut moments: Vec<u64> = (0..kills)
        // Of the first three quarters: the undisturbed run may have been the slower one.
        .map(|_| random(&mut state, length.as_millis() as u64 * 3 / 4))
        .collect();
    moments.sort_unstable();
    let mut before = 0;
    for moment in moments {
        let mut child: Child = command(root, arguments)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("it starts");
        std::thread::sleep(Duration::from_millis(moment - before));
        before = moment;
        if child.try_wait().expect("a state").is_none() {
            hit += 1;
        }
        let _ = child.kill();
        child.wait().expect("an end");
    }
    (batch(root, arguments), hit)
}

/// Flights, of which one has so many photos and some are broken, done once undisturbed and once killed so many times.
fn season_with_kills(flights: usize, photos: usize, kills: usize, seed: u64, steps: &[&str]) {
    let root = tempfile::tempdir().expect("a folder");
    let root = root.path();
    with_photos(&root.join("season/photos"), photos);
    for number in 0..flights {
        let name = format!("blast-{number:03}");
        let folder = root.join("season").join(&name);
        match number % 10 {
            3 => {
                fs::create_dir_all(&folder).expect("a folder");
                fs::write(folder.join("flight.toml"), "format = 1\nwrold = 3\n").expect("written");
            }
            4 => {
                small(&folder, number);
                fs::remove_file(folder.join("pile.ply")).expect("removed");
            }
            _ => small(&folder, number),
        }
    }
    let mut arguments = vec!["season", "--to", "out", "--jobs", "2"];
    arguments.extend(steps);
    let begun = Instant::now();
    let output = batch(root, &arguments);
    let length = begun.elapsed();
    let failed = (0..flights).any(|number| [3, 4].contains(&(number % 10)));
    let expected = if failed { 3 } else { 0 };
    assert_eq!(status(&output), expected);
    // In the same place: an export knows the way to its flight.
    fs::rename(root.join("out"), root.join("quiet")).expect("moved");
    let (output, hit) = killed(root, &arguments, kills, length, seed);
    assert_eq!(status(&output), expected);
    println!("{flights} flights in {length:?}; killed {hit} of {kills} times");
    assert_same(&root.join("out"), &root.join("quiet"));
}

#[test]
fn a_killed_season_ends_as_an_undisturbed_one() {
    season_with_kills(5, 1, 3, 5, &["--steps", "scales,export"]);
}

/// The one of the issue: minutes.
#[test]
#[ignore = "takes minutes: cargo test -p fragscale --test command two_hundred -- --ignored --nocapture"]
fn two_hundred_flights_killed_five_times() {
    season_with_kills(200, 4, 5, 11, &["--steps", "scales,check,export"]);
}

/// The process of a flight ends where whoever started it is gone, and says what it is for where a person starts it.
#[test]
fn no_process_is_left() {
    let start = || {
        Command::new(env!("CARGO_BIN_EXE_fragscale"))
            .arg("batch-flight")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it starts")
    };
    let mut child = start();
    drop(child.stdin.take());
    let output = child.wait_with_output().expect("an end");
    assert_eq!(output.status.code(), Some(1));
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        text.starts_with("error: ") && text.contains("fragscale batch"),
        "{text}"
    );

    let root = tempfile::tempdir().expect("a folder");
    with_photos(&root.path().join("flight"), 9);
    let told = serde_json::json!({
        "flight": root.path().join("flight"), "surface": null, "photos": null, "reference": null,
        "to": root.path().join("out"), "force": false,
        "asked": {"unit": "cm", "steps": [{"step": "export"}]},
    });
    let mut child = start();
    let mut input = child.stdin.take().expect("a pipe");
    std::io::Write::write_all(&mut input, format!("{told}\n").as_bytes()).expect("told");
    std::thread::sleep(Duration::from_millis(300));
    drop(input);
    let output = child.wait_with_output().expect("an end");
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(!root.path().join("out/flight.json").exists());
}

#[test]
fn what_cannot_be_begun_is_refused() {
    let root = tempfile::tempdir().expect("a folder");
    let root = root.path();
    small(&root.join("season/a"), 1);
    fs::create_dir_all(root.join("full")).expect("a folder");
    fs::write(root.join("full/mine.txt"), "x").expect("written");
    fs::write(root.join("bad.toml"), "format = 1\nstep = []\n").expect("written");
    fs::write(
        root.join("none.toml"),
        "format = 1\nto = \"out\"\n[[flight]]\npath = \"x*\"\n",
    )
    .expect("written");
    for (arguments, code, what) in [
        (&["season"][..], 2, "--to DIR"),
        (&["season", "--to", "out", "--steps", "scale"], 2, "'scale'"),
        (
            &["season", "--to", "out", "--steps", "psd"],
            2,
            "needs delineate",
        ),
        (
            &[
                "season",
                "--to",
                "out",
                "--set",
                "delineate.engine=classical",
            ],
            2,
            "not among the steps",
        ),
        (&["season", "--to", "out", "--memory", "8"], 2, "8GB"),
        (&["season", "--to", "out", "--jobs", "0"], 2, "'0'"),
        (&["--to", "out"], 2, "SEASON.toml"),
        (&["bad.toml", "season", "--to", "out"], 2, "name it alone"),
        (
            &["bad.toml", "--to", "out"],
            1,
            "bad.toml:2: unknown key 'step'",
        ),
        (&["none.toml"], 1, "no flight"),
        (&["season", "--to", "full"], 1, "not empty"),
        (&["season", "--to", "season/a"], 1, "not empty"),
        (&["season/a", "season/a", "--to", "out"], 1, "named twice"),
        (&["--watch", "missing", "--to", "out"], 1, "no such folder"),
        (
            &["season", "seson/a", "--to", "out"],
            1,
            "seson/a: there is no such",
        ),
    ] {
        let output = batch(root, arguments);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(status(&output), code, "{arguments:?} {text}");
        let errors: Vec<&str> = text
            .lines()
            .filter(|line| line.starts_with("error: "))
            .collect();
        assert!(
            errors.len() == 1 && errors[0].contains(what),
            "{arguments:?} {text}"
        );
        assert!(!root.join("out").exists(), "{arguments:?}");
    }
    assert_eq!(
        fs::read_dir(root.join("full")).expect("a folder").count(),
        1
    );
}

/// A flight that takes more memory than there is fails alone; beside others it waits.
#[cfg(target_os = "linux")]
#[test]
fn memory_is_not_exceeded() {
    let root = tempfile::tempdir().expect("a folder");
    let root = root.path();
    with_photos(&root.join("season/large"), 9);
    let output = batch(
        root,
        &[
            "season", "--to", "out", "--steps", "export", "--memory", "5MB",
        ],
    );
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(status(&output), 3, "{text}");
    assert!(text.contains("more memory than the 5 MB"), "{text}");
}

#[test]
fn one_batch_at_a_time_works_in_a_folder() {
    let root = tempfile::tempdir().expect("a folder");
    let root = root.path();
    fs::create_dir_all(root.join("season")).expect("a folder");
    let mut watching = command(
        root,
        &["--watch", "season", "--to", "out", "--steps", "scales"],
    )
    .stderr(Stdio::null())
    .spawn()
    .expect("it starts");
    until(|| root.join("out/season.lock").is_file());
    small(&root.join("a"), 1);
    std::thread::sleep(Duration::from_millis(100));
    let output = batch(root, &["a", "--to", "out"]);
    let _ = watching.kill();
    watching.wait().expect("an end");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(status(&output), 1, "{text}");
    assert!(text.contains("another batch is at work"), "{text}");
}

/// Waits for what comes.
fn until(is_so: impl Fn() -> bool) {
    for _ in 0..1200 {
        if is_so() {
            return;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    panic!("it did not come");
}

/// Flights are taken as they arrive, and again when they change; Ctrl+C ends it.
#[cfg(unix)]
#[test]
fn flights_are_taken_as_they_arrive() {
    let root = tempfile::tempdir().expect("a folder");
    let root = root.path();
    fs::create_dir_all(root.join("in")).expect("a folder");
    small(&root.join("in/a"), 1);
    let child = command(
        root,
        &[
            "--watch", "in", "--to", "out", "--steps", "scales", "--settle", "1",
        ],
    )
    .stdout(Stdio::piped())
    .stderr(Stdio::piped())
    .spawn()
    .expect("it starts");
    let rows = |count: usize| {
        let csv = fs::read_to_string(root.join("out/season.csv")).unwrap_or_default();
        csv.lines().count() == 1 + count
    };
    until(|| rows(1));
    small(&root.join("in/b"), 2);
    until(|| rows(2));
    let scales = root.join("out/b/scales.csv");
    let before = fs::read(&scales).expect("scales");
    small(&root.join("other"), 3);
    fs::copy(root.join("other/poses.csv"), root.join("in/b/poses.csv")).expect("other poses");
    until(|| fs::read(&scales).is_ok_and(|now| now != before));
    let id = child.id().to_string();
    let killed = Command::new("kill")
        .args(["-INT", &id])
        .status()
        .expect("kill");
    assert!(killed.success());
    let output = child.wait_with_output().expect("an end");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(130), "{text}");
    assert!(text.contains("interrupted; what is done stays"), "{text}");
    // What was done as they arrived is what is done at once.
    let output = fragscale(&[
        "batch",
        &root.join("in").to_string_lossy(),
        "--to",
        &root.join("once").to_string_lossy(),
        "--steps",
        "scales",
    ]);
    assert_eq!(output.status.code(), Some(0));
    for name in ["a", "b"] {
        let file = |folder: &str| fs::read(root.join(folder).join(name).join("scales.csv"));
        assert_eq!(file("out").expect("scales"), file("once").expect("scales"));
    }
}

/// Photos that a run before had outlined are not outlined again, and their files stay results of the flight.
#[test]
fn outlines_of_a_run_before_stay() {
    let root = tempfile::tempdir().expect("a folder");
    let root = root.path();
    let flight = root.join("season/a");
    with_photos(&flight, 2);
    let (photo, aside) = (flight.join("photos/IMG_0002.jpg"), root.join("aside.jpg"));
    fs::rename(&photo, &aside).expect("moved");
    let run = || {
        batch(
            root,
            &[
                "season",
                "--to",
                "out",
                "--steps",
                "delineate",
                "--set",
                "delineate.engine=classical",
            ],
        )
    };
    let output = run();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(status(&output), 3, "{text}");
    // The reason stands in its one line.
    assert!(
        text.contains("the first: IMG_0002.jpg: not delineated: its image file was not found"),
        "{text}"
    );
    let labels = |number: usize| root.join(format!("out/a/fragments/IMG_000{number}_labels.png"));
    assert!(labels(1).is_file() && !labels(2).is_file(), "{text}");
    let before = fs::metadata(labels(1)).and_then(|of| of.modified());
    fs::rename(&aside, &photo).expect("moved");
    let output = run();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(status(&output), 0, "{text}");
    assert!(labels(1).is_file() && labels(2).is_file(), "{text}");
    let after = fs::metadata(labels(1)).and_then(|of| of.modified());
    assert_eq!(before.expect("a time"), after.expect("a time"));
    let record = fs::read_to_string(root.join("out/a/flight.json")).expect("a record");
    assert!(record.contains("IMG_0001_labels.png"), "{record}");
}

/// Who does fewer steps than before knows beforehand what becomes of the results of the others.
#[test]
fn help_says_what_is_taken_away() {
    let output = fragscale(&["batch", "--help"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let words: Vec<&str> = text.split_whitespace().collect();
    let said = "results of steps that are not among these are taken away";
    assert!(words.join(" ").contains(said), "{text}");
}

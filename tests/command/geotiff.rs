//! GeoTIFFs that GDAL wrote, cell by cell against what rasterio reads (`tests/geotiff/make.py`). A
//! folder with more of them is named in `FRAGSCALE_TEST_GEOTIFFS`.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use fragscale::formats::read_cloud;
use fragscale::jobs::Progress;

/// The elevations by column and row, as rasterio has them.
fn expected(lines: std::str::Lines<'_>) -> HashMap<(u32, u32), f64> {
    lines
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            let [column, row, value] = words[..] else {
                panic!("'{line}' is no cell");
            };
            let number = |word: &str| word.parse().expect("a whole number");
            (
                (number(column), number(row)),
                value.parse().expect("a number"),
            )
        })
        .collect()
}

/// What differs, in a sentence; `Ok` says whether the file was read (or refused as it has to be).
fn compare(tif: &Path) -> Result<bool, String> {
    let answer = fs::read_to_string(tif.with_extension("txt")).expect("an answer");
    let mut lines = answer.lines();
    let head = lines.next().expect("a line");
    let read = read_cloud(tif, &Progress::default());
    if let Some(word) = head.strip_prefix("refused ") {
        return match read {
            Err(error) if error.fault.what.contains(word) => Ok(false),
            Err(error) => Err(format!("not '{word}': {error}")),
            Ok(_) => Err(format!("it is read, not refused with '{word}'")),
        };
    }
    let file = read.map_err(|error| error.to_string())?;
    let mut cells = expected(lines);
    for point in &file.cloud.points {
        // Cells of half a metre, the corner of the first at (500 000, 5 000 000).
        let column = ((point.x - 500_000.0) / 0.5 - 0.5) as u32;
        let row = ((5_000_000.0 - point.y) / 0.5 - 0.5) as u32;
        match cells.remove(&(column, row)) {
            Some(z) if z == point.z => {}
            other => return Err(format!("({column}, {row}): {}, not {other:?}", point.z)),
        }
    }
    match cells.len() {
        0 => Ok(true),
        left => Err(format!("{left} cells are not read")),
    }
}

fn compare_all(folder: &Path) -> (usize, usize) {
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "tif"))
        .collect();
    files.sort();
    let (mut exact, mut refused, mut wrong) = (0, 0, Vec::new());
    for file in &files {
        match compare(file) {
            Ok(true) => exact += 1,
            Ok(false) => refused += 1,
            Err(what) => wrong.push(format!("{}: {what}", file.display())),
        }
    }
    assert!(
        wrong.is_empty(),
        "{}\n{} wrong",
        wrong.join("\n"),
        wrong.len()
    );
    (exact, refused)
}

#[test]
fn what_gdal_writes_is_read_exactly_or_refused_by_name() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/geotiff");
    assert_eq!(compare_all(&folder), (13, 2));
}

#[test]
fn a_random_matrix_where_one_was_made() {
    let Some(folder) = std::env::var_os("FRAGSCALE_TEST_GEOTIFFS") else {
        println!("left out: no FRAGSCALE_TEST_GEOTIFFS");
        return;
    };
    let (exact, refused) = compare_all(Path::new(&folder));
    println!("{exact} exact, {refused} refused by name");
}

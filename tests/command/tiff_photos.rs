//! Photos in TIFF files, pixel by pixel against what libtiff reads (`tests/geotiff/make_photos.py`). A
//! folder with more of them is named in `FRAGSCALE_TEST_TIFF_PHOTOS`.

use std::fs;
use std::path::{Path, PathBuf};

use fragscale::picture::decode;

/// How many levels the worst pixel is off, and all of them on average; `None` where it is refused as it
/// has to be.
fn compare(tif: &Path) -> Result<Option<(u8, f64)>, String> {
    let bytes = fs::read(tif).expect("a photo");
    let answer = fs::read_to_string(tif.with_extension("txt")).expect("an answer");
    let read = decode(&bytes);
    if let Some(word) = answer.trim().strip_prefix("refused ") {
        return match read {
            Err(fault) if fault.what.contains(word) => Ok(None),
            Err(fault) => Err(format!("not '{word}': {fault}")),
            Ok(_) => Err("it is read, not refused".to_owned()),
        };
    }
    let most: u8 = answer.trim().parse().expect("a number");
    let image = read.map_err(|fault| fault.to_string())?;
    let png = fs::read(tif.with_extension("png")).expect("its pixels");
    let expected = decode(&png).expect("a PNG");
    if image.dimensions() != expected.dimensions() {
        return Err(format!("{:?}", image.dimensions()));
    }
    let off = || {
        image
            .iter()
            .zip(expected.iter())
            .map(|(a, b)| a.abs_diff(*b))
    };
    let worst = off().max().unwrap_or_default();
    let mean = off().map(f64::from).sum::<f64>() / image.len() as f64;
    // What is shared is shared by few: on average decoders agree.
    if worst > most || mean > 1.0 {
        return Err(format!("{worst} levels off, {mean:.3} on average"));
    }
    Ok(Some((worst, mean)))
}

fn compare_all(folder: &Path) -> (usize, usize, usize) {
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "tif"))
        .collect();
    files.sort();
    let (mut equal, mut near, mut refused, mut wrong) = (0, 0, 0, Vec::new());
    for file in &files {
        match compare(file) {
            Ok(Some((0, _))) => equal += 1,
            Ok(Some((worst, mean))) => {
                near += 1;
                println!("{}: {worst}, {mean:.3}", file.display());
            }
            Ok(None) => refused += 1,
            Err(what) => wrong.push(format!("{}: {what}", file.display())),
        }
    }
    assert!(
        wrong.is_empty(),
        "{}\n{} wrong",
        wrong.join("\n"),
        wrong.len()
    );
    (equal, near, refused)
}

#[test]
fn photos_are_what_libtiff_reads() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/tiff_photos");
    let (equal, near, refused) = compare_all(&folder);
    assert_eq!((equal + near, refused), (9, 1));
    assert!(equal >= 4, "{equal}");
}

#[test]
fn a_random_matrix_where_one_was_made() {
    let Some(folder) = std::env::var_os("FRAGSCALE_TEST_TIFF_PHOTOS") else {
        println!("left out: no FRAGSCALE_TEST_TIFF_PHOTOS");
        return;
    };
    let (equal, near, refused) = compare_all(Path::new(&folder));
    println!("{equal} equal, {near} near, {refused} refused by name");
}

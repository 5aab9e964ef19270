//! What comes out: COLMAP's text files, points coloured by what the photos show there.

use std::fs;
use std::path::Path;

use cumulus3d_core::Reconstruction;
use cumulus3d_core::interop::{ImageOrder, read_model_text, write_model_text};
use cumulus3d_core::reconstruction::{Image, bilinear_rgb};

use super::{Whose, failed};
use crate::fault::Fault;
use crate::jobs::Progress;

/// Colours points.
///
/// # Errors
/// Where the work was cancelled.
pub(super) fn colour(
    model: &mut Reconstruction,
    whose: &Whose<'_>,
    progress: &Progress,
) -> Result<(), Fault> {
    let count = model.registered_image_count() as u64;
    let mut done = 0;
    model.extract_colors(|image: &Image| {
        done += 1;
        if progress.advance(done, count).is_err() {
            return None;
        }
        let path = &whose.photo(image.image_id)?.path;
        let pixels = image::open(path).ok()?.into_rgb8();
        let (width, height) = (pixels.width() as usize, pixels.height() as usize);
        Some(move |x: f64, y: f64| bilinear_rgb(pixels.as_raw(), width, height, x, y))
    });
    progress.advance(1, 1)
}

/// The files, by way of a folder in `work`.
///
/// # Errors
/// Where they cannot be written.
pub(super) fn files(
    model: &Reconstruction,
    work: &Path,
) -> Result<[(&'static str, Vec<u8>); 3], Fault> {
    let folder = work.join("model");
    let written = |error: std::io::Error| {
        let what = format!("{} cannot be written ({error})", folder.display());
        Fault::new(what, "make room on the disk")
    };
    fs::create_dir_all(&folder).map_err(written)?;
    write_model_text(model, &folder, ImageOrder::ById).map_err(|_| failed("writing the model"))?;
    let read = |name| fs::read(folder.join(name)).map_err(written);
    Ok([
        ("cameras.txt", read("cameras.txt")?),
        ("images.txt", read("images.txt")?),
        ("points3D.txt", read("points3D.txt")?),
    ])
}

/// A model that a program left as text files in a folder.
///
/// # Errors
/// Where a file is not there or is no such file.
pub(crate) fn read(folder: &Path, program: &str) -> Result<Reconstruction, Fault> {
    read_model_text(folder).map_err(|_| {
        let what = format!("the model that {program} wrote cannot be read");
        Fault::new(what, "report this with the program's version")
    })
}

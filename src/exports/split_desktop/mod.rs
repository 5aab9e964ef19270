//! The export for Split-Desktop: a folder with the photos that scales are for, the scales in a sheet
//! to type from, and what shows where they came from.
//!
//! Split-Desktop has no documented import of scales: an engineer types the top and the bottom scale
//! of each photo into its dialog. The folder holds:
//!
//! ```text
//! scales.html          to print or keep open: a row a photo, big digits
//! scales.csv           the same numbers in full (contract, section 5)
//! photos/NAME          what to open in Split-Desktop, undistorted or as shot, full size
//! overlays/NAME.jpg    the same, smaller, with the scale drawn on it
//! thumbnails/NAME.jpg  for the sheet
//! rectified/NAME.png   where asked for: the photo seen squarely, with one scale, and its world file
//! masks/NAME.png       white for rock, black where a scale object was painted over
//! footprints.geojson   where each photo lies
//! footprints.kml       the same for map programs, where the coordinate system is known
//! export.json          what was written and from what (see `folder.rs`)
//! ```
//!
//! An export that was interrupted is started again and goes on: each file is there whole or not at
//! all, and pictures that are there and still right are not made again.

mod folder;
mod footprints;
mod kml;
mod list;
mod objects;
mod photo_footprint;
mod photo_names;
mod pictures;
mod plan;
mod rectified;
mod sheet;
mod whose;

use std::collections::HashSet;
use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

pub use folder::Replace;
pub use list::other_flight_in;
pub use plan::export_folders;

use self::folder::ExportFolder;
use self::footprints::Footprints;
use self::objects::PhotoObject;
use self::photo_names::PhotoNames;
use self::pictures::PictureSource;
use self::whose::FlightOfExport;
use crate::fault::{Fault, first_names};
use crate::files::{FileError, Inputs, sha256_of_file};
use crate::flight::{FlightSettings, Review};
use crate::jobs::Progress;
use crate::picture;
use crate::scale::Onto;
use crate::units::LengthUnit;
use crate::{ScaleReport, scales_csv};

/// What the pictures that are worked on at once may take, in bytes.
const MEMORY: u64 = 2 << 30;

/// Bytes that a pixel of a photo takes on its way: decoded, undistorted, rectified, and its files.
const BYTES_A_PIXEL: u64 = 18;

/// The most photos that are worked on at once.
const MOST_AT_ONCE: usize = 4;

/// What to export.
#[derive(Debug, Clone, Copy)]
pub struct ExportRequest<'a> {
    /// The flight with its scales, doubts and verdicts.
    pub review: &'a Review,
    /// What the flight was read from.
    pub from: &'a Provenance<'a>,
    /// Which photos are exported; parallel to the flight's photos.
    pub selected: &'a [bool],
    /// Scales are in pixels per this.
    pub unit: LengthUnit,
    /// Onto what the photos are rectified besides; `None` where they are not.
    pub rectified: Option<Onto>,
    /// What of others may be replaced.
    pub replace: Replace,
}

/// What a flight was read from: the sheet names it, and nothing of it is written over.
#[derive(Debug, Clone, Copy)]
pub struct Provenance<'a> {
    /// The flight's own file or folder, by which an export is known as that of this flight.
    pub file: &'a Path,
    /// The files that the flight was read from.
    pub inputs: &'a [PathBuf],
    /// The same with the photos and whatever was opened on the way: nothing of it is written over.
    pub read: &'a Inputs,
    /// The image files, where there are any; parallel to the flight's photos.
    pub photo_files: &'a [Option<PathBuf>],
    /// What the flight was opened with.
    pub settings: &'a FlightSettings,
    /// The coordinate system of the world: "EPSG:n" or WKT.
    pub crs: Option<&'a str>,
    /// What was noticed on the way.
    pub warnings: &'a [String],
}

/// What an export did.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ExportSummary {
    /// Photos in the sheet.
    pub photos: usize,
    /// Of them, whose pictures were made now.
    pub made: usize,
    /// Of them, whose pictures were there already and are still right.
    pub kept: usize,
    /// Of them, whose pictures could not be made because their file is damaged, cut or unreadable.
    pub damaged: usize,
    /// What to know, one sentence each; photos without pictures are among them.
    pub warnings: Vec<String>,
}

impl fmt::Display for ExportSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} photos, pictures of {} made, of {} there already; open scales.html",
            self.photos, self.made, self.kept
        )
    }
}

/// Exports the selected photos into `dir`, which is made where it is not there. `progress` counts
/// photos and can cancel; what is written until then stays good, and the same call goes on from it.
///
/// # Errors
/// Where the folder cannot be written, holds the export of another flight or files of others by the
/// same names that may not be replaced, or files that the flight was read from (nothing is written
/// then); no photo is selected, or the work was cancelled.
pub fn export_for_split_desktop(
    dir: &Path,
    request: &ExportRequest<'_>,
    progress: &Progress,
) -> Result<ExportSummary, FileError> {
    let at_dir = |fault| FileError::new(dir, fault);
    let flight = request.review.flight();
    let parts = flight.parts();
    let chosen: Vec<usize> = (0..parts.photos.len())
        .filter(|&index| request.selected.get(index) == Some(&true))
        .collect();
    if chosen.is_empty() {
        return Err(at_dir(Fault::new(
            "no photo is selected for export",
            "select at least one",
        )));
    }
    still_there(request, &chosen).map_err(at_dir)?;
    let objects = objects::of_photos(request).map_err(at_dir)?;
    let mut pictures = plan::pictures(request, &objects);
    let footprints = Footprints::new(request);
    let mut planned: Vec<String> = [plan::CSV, plan::SHEET, plan::GEOJSON]
        .map(str::to_owned)
        .to_vec();
    if footprints.is_on_maps() {
        planned.push(plan::KML.to_owned());
    }
    let of_photos = chosen
        .iter()
        .filter_map(|&index| pictures[index].as_ref().ok());
    planned.extend(of_photos.flat_map(PhotoNames::all));
    let whose = FlightOfExport::new(&parts.name, request.from.file, dir);
    let (read, replace) = (request.from.read, request.replace);
    let folder = ExportFolder::open(dir, &whose, read, replace, &planned, progress)?;

    let (mut folder, done) =
        make_pictures(folder, request, &chosen, &pictures, &objects, progress)?;
    let mut summary = ExportSummary {
        photos: chosen.len(),
        ..ExportSummary::default()
    };
    summary.warnings.extend(footprints.warning());
    let of_chosen = objects.iter().flatten();
    summary
        .warnings
        .extend(of_chosen.filter_map(PhotoObject::warning));
    for (&index, done) in chosen.iter().zip(done) {
        let name = &parts.photos[index].name;
        let doubt = match done {
            Done::Made(doubt) => {
                summary.made += 1;
                doubt
            }
            Done::Kept(doubt) => {
                summary.kept += 1;
                doubt
            }
            Done::Not(why) => {
                pictures[index] = Err(why);
                None
            }
            Done::Damaged(fault) => {
                summary.damaged += 1;
                pictures[index] = Err(format!("no pictures: {fault}"));
                None
            }
        };
        let whys = doubt.iter().chain(pictures[index].as_ref().err());
        summary
            .warnings
            .extend(whys.map(|why| format!("{name}: {why}")));
    }

    progress.stage("writing the sheet");
    let report = ScaleReport::new(request.review, request.unit)
        .of_photos(request.selected)
        .to_type_from();
    let csv = scales_csv(&report).map_err(|e| {
        at_dir(Fault::new(
            format!("the scales cannot be written ({e})"),
            "report this",
        ))
    })?;
    let inputs = checked_inputs(request.from, progress).map_err(at_dir)?;
    let sheet = sheet::html(
        request,
        &report,
        &pictures,
        &objects,
        &inputs,
        &summary.warnings,
    );
    let mut files = vec![
        (plan::CSV.to_owned(), csv.into_bytes()),
        (plan::SHEET.to_owned(), sheet.into_bytes()),
        (
            plan::GEOJSON.to_owned(),
            footprints.geojson(&report).into_bytes(),
        ),
    ];
    if let Some(kml) = footprints.kml(&report) {
        files.push((plan::KML.to_owned(), kml.into_bytes()));
    }
    folder.write(&files, None)?;
    // Pictures that could not be made are of no use from an earlier export either.
    let of_photos = chosen
        .iter()
        .filter_map(|&index| pictures[index].as_ref().ok());
    let mut kept: Vec<String> = files.into_iter().map(|(name, _)| name).collect();
    kept.extend(of_photos.flat_map(PhotoNames::all));
    let removed = folder.remove_others(&kept, progress)?;
    if !removed.is_empty() {
        summary.warnings.push(format!(
            "files of the earlier export that this one does not have were taken away: {} ({})",
            removed.len(),
            first_names(&removed)
        ));
    }
    progress.advance(1, 1).map_err(at_dir)?;
    Ok(summary)
}

/// Refuses where all files of photos that a flight had are gone, as with a drive that was unplugged: pictures of an earlier export
/// would go with them, and none would come.
fn still_there(request: &ExportRequest<'_>, chosen: &[usize]) -> Result<(), Fault> {
    let of_photo = |index: &usize| request.from.photo_files.get(*index)?.as_ref();
    let files: Vec<&PathBuf> = chosen.iter().filter_map(of_photo).collect();
    match files.first() {
        Some(first) if !files.iter().any(|file| file.exists()) => Err(Fault::new(
            format!(
                "the photos' files are gone since the flight was opened ({} is not there)",
                first.display()
            ),
            "bring them back; for the scales alone open the flight again, without its photos",
        )),
        _ => Ok(()),
    }
}

/// What became of a photo's pictures.
enum Done {
    /// With what is doubted about the photo.
    Made(Option<String>),
    Kept(Option<String>),
    Not(String),
    /// Its file is not whole, or cannot be read.
    Damaged(Fault),
}

/// Makes the pictures of the chosen photos, a few at once; what became of them in their order.
fn make_pictures<'a>(
    folder: ExportFolder<'a>,
    request: &ExportRequest<'a>,
    chosen: &[usize],
    pictures: &[Result<PhotoNames, String>],
    objects: &[Vec<PhotoObject<'_>>],
    progress: &Progress,
) -> Result<(ExportFolder<'a>, Vec<Done>), FileError> {
    progress.stage("exporting photos");
    let work = Mutex::new(Work {
        folder,
        done: chosen.iter().map(|_| None).collect(),
        finished: 0,
        failed: None,
    });
    let next = AtomicUsize::new(0);
    let worker = || {
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(&index) = chosen.get(place) else {
                return;
            };
            let done = match &pictures[index] {
                Ok(names) => {
                    let objects = objects.get(index).map_or(&[][..], Vec::as_slice);
                    one_photo(&work, request, index, names, objects, progress)
                }
                // Said where it was planned.
                Err(why) => Ok(Done::Not(why.clone())),
            };
            let mut work = lock(&work);
            work.finished += 1;
            let counted = progress
                .advance(work.finished, chosen.len() as u64)
                .map_err(|fault| FileError::new(work.folder.path(), fault));
            match done.and_then(|done| counted.map(|()| done)) {
                Ok(done) => work.done[place] = Some(done),
                Err(error) => {
                    work.failed.get_or_insert(error);
                }
            }
            if work.failed.is_some() {
                return;
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..at_once(request, chosen) {
            scope.spawn(worker);
        }
        worker();
    });
    let work = work.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Some(error) = work.failed {
        return Err(error);
    }
    // Without a failure every place was filled.
    Ok((work.folder, work.done.into_iter().flatten().collect()))
}

/// Shared by the workers.
struct Work<'a> {
    folder: ExportFolder<'a>,
    done: Vec<Option<Done>>,
    finished: u64,
    failed: Option<FileError>,
}

fn lock<'a, 'b>(work: &'a Mutex<Work<'b>>) -> std::sync::MutexGuard<'a, Work<'b>> {
    work.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes the pictures of one photo if they are not there; they are written one photo at a time.
fn one_photo(
    work: &Mutex<Work<'_>>,
    request: &ExportRequest<'_>,
    index: usize,
    names: &PhotoNames,
    objects: &[PhotoObject<'_>],
    progress: &Progress,
) -> Result<Done, FileError> {
    let parts = request.review.flight().parts();
    let photo = request.review.photo(index);
    let scaled = photo.and_then(|photo| Some((photo, photo.camera, photo.scale()?)));
    let (Some((photo, camera, scale)), Some(Some(file))) =
        (scaled, request.from.photo_files.get(index))
    else {
        return Ok(Done::Not(
            "no pictures: it has no scale or no file".to_owned(),
        ));
    };
    let source = PictureSource {
        file,
        camera,
        image: parts.image,
        scale,
        pair: photo.estimates(photo.pair, request.unit),
        unit: request.unit,
        rectified: rectified::depends_on(request, index),
        names,
        left_out: objects
            .iter()
            .filter(|object| object.is_masked())
            .map(|object| object.region().clone())
            .collect(),
    };
    let bytes = match fs::read(source.file) {
        Ok(bytes) => bytes,
        Err(e) => {
            let what = format!("the photo file cannot be read ({e})");
            return Ok(Done::Damaged(Fault::new(what, "copy the photo again")));
        }
    };
    let fingerprint = source.fingerprint(&bytes);
    let is_done = lock(work).folder.is_done(&names.all(), &fingerprint);
    let photo = match is_done {
        true => None,
        false => match picture::decode_photo(&bytes) {
            Ok(photo) => Some(photo),
            Err(fault) => return Ok(Done::Damaged(fault)),
        },
    };
    // What was made before was as large as its camera.
    let size = (photo.as_ref()).map_or((camera.width, camera.height), |p| p.image.dimensions());
    let doubt = match pictures::doubt_about_size(&bytes, size) {
        Ok(doubt) => doubt,
        Err(fault) => return Ok(Done::Damaged(fault)),
    };
    let doubts = doubt
        .into_iter()
        .chain(pictures::doubt_about_turning(&bytes));
    let doubts: Vec<String> = doubts.collect();
    let said = |doubts: Vec<String>| (!doubts.is_empty()).then(|| doubts.join("; "));
    let Some(photo) = photo else {
        lock(work).folder.keep(&names.all());
        return Ok(Done::Kept(said(doubts)));
    };
    // Before the photo's memory is given away; without it the others are of use all the same.
    let made = rectified::files(request, index, names, &photo.image, objects, progress);
    let (rectified, of_rectified) = match made {
        Ok(made) => (
            made.files,
            made.doubt.map(|why| format!("rectified: {why}")),
        ),
        Err(fault) => (Vec::new(), Some(format!("not rectified: {fault}"))),
    };
    // What is said of them is said again by the next export: it makes them again.
    let fingerprint = of_rectified.is_none().then_some(fingerprint);
    let doubt = said(doubts.into_iter().chain(of_rectified).collect());
    let mut files = match source.make(photo, bytes) {
        Ok(files) => files,
        Err(fault) => return Ok(Done::Not(format!("no pictures: {fault}"))),
    };
    files.extend(rectified);
    let mut work = lock(work);
    if progress.is_cancelled() {
        // `advance` says so.
        return Ok(Done::Not(String::new()));
    }
    work.folder.write(&files, fingerprint.as_deref())?;
    Ok(Done::Made(doubt))
}

/// How many photos to work on at once: as many as there are cores and memory for.
fn at_once(request: &ExportRequest<'_>, chosen: &[usize]) -> usize {
    let photos = chosen
        .iter()
        .filter_map(|&index| request.review.photo(index));
    let pixels = photos.map(|photo| u64::from(photo.camera.width) * u64::from(photo.camera.height));
    let of_photo = pixels.max().unwrap_or(1).max(1) * BYTES_A_PIXEL;
    let fit = usize::try_from(MEMORY / of_photo).unwrap_or(MOST_AT_ONCE);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    fit.min(cores).min(MOST_AT_ONCE).min(chosen.len()).max(1)
}

/// A file that the flight was read from, and its checksum or why there is none.
struct CheckedInput {
    path: PathBuf,
    checksum: String,
}

/// The most files of a folder that are listed.
const LISTED: usize = 20;

/// The inputs with their checksums; of a folder the files in it that were opened, but for the photos, which have their own.
fn checked_inputs(from: &Provenance<'_>, progress: &Progress) -> Result<Vec<CheckedInput>, Fault> {
    progress.stage("checking the inputs");
    let photos: HashSet<&Path> = from
        .photo_files
        .iter()
        .flatten()
        .map(PathBuf::as_path)
        .collect();
    let named: HashSet<&Path> = from.inputs.iter().map(PathBuf::as_path).collect();
    let mut checked = Vec::new();
    for (done, input) in from.inputs.iter().enumerate() {
        progress.advance(done as u64, from.inputs.len() as u64)?;
        if !input.is_dir() {
            checked.push(checked_file(input, progress)?);
            continue;
        }
        let opened = from.read.opened_below(input).into_iter();
        let files: Vec<PathBuf> = opened
            .filter(|file| !photos.contains(file.as_path()) && !named.contains(file.as_path()))
            .collect();
        if files.is_empty() || files.len() > LISTED {
            checked.push(CheckedInput {
                path: input.clone(),
                checksum: format!("a folder, of which {} files were read", files.len()),
            });
            continue;
        }
        for file in files {
            checked.push(checked_file(&file, progress)?);
        }
    }
    Ok(checked)
}

fn checked_file(path: &Path, progress: &Progress) -> Result<CheckedInput, Fault> {
    let checksum = match sha256_of_file(path, || progress.is_cancelled()) {
        Ok(sum) => sum,
        Err(e) if e.kind() == io::ErrorKind::Interrupted => {
            progress.advance(1, 1)?;
            String::new()
        }
        Err(e) => format!("it cannot be read any more ({e})"),
    };
    Ok(CheckedInput {
        path: path.to_owned(),
        checksum,
    })
}

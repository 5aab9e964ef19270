//! Starting the window's long work: opening, computing, thumbnails, saving, exporting, dialogs.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use image::RgbImage;
use image::buffer::ConvertBuffer;

use crate::camera::Camera;
use crate::exports::{self, ExportRequest, Provenance, Replace};
use crate::fault::Fault;
use crate::files::{self, Kind};
use crate::flight::{Flight, FlightSettings};
use crate::formats::{self, FileError};
use crate::geometry::LocalFrame;
use crate::jobs::Progress;
use crate::opening::{self, Colours, Dropped, OpenOptions};
use crate::picture;
use crate::render::{
    CloudBuffers, CloudGeometry, Gpu, LargePhoto, MeshBuffers, MeshGeometry, Normals, PhotoImage,
};
use crate::scale::ImageKind;
use crate::state::{Severity, State};
use crate::tasks::work::{
    DialogFor, Done, Geometry, Loaded, NotOpened, PreviewPicture, Task, Thumbnail,
};

/// The longer side of a thumbnail, pixels: for the table and the image planes in the viewport.
const THUMBNAIL: u32 = 256;

/// The longer side of a thumbnail in the table, pixels: sharp at 200 %.
const ROW_THUMBNAIL: u32 = 128;

/// The longer side of the photo that is laid over the surface, pixels.
const PROJECTED: u32 = 2048;

/// The longer side of the inspector's photo, pixels: zooming in shows more than a screen does.
const PREVIEW: u32 = 4096;

impl State {
    /// Starts a task, or says why it cannot be started.
    pub(crate) fn start(
        &mut self,
        task: Task,
        work: impl FnOnce(&Progress) -> Done + Send + 'static,
    ) {
        if let Err(fault) = self.work.start(task, work) {
            self.say(Severity::Error, &fault.to_string());
        }
    }

    /// Reads what was named and computes its scales. A surface alone is for the flight that could not
    /// be opened last, else for the one on the screen; photos alone are, too, if they are to be
    /// `added`, else a flight of their own.
    pub fn start_opening(&mut self, paths: Vec<PathBuf>, added: bool) {
        let on_screen = self.open.as_ref();
        let base = on_screen.map(|open| (open.path.clone(), open.options.clone()));
        let base = self.tried.clone().or(base);
        self.notice = None;
        self.reads_other = true;
        self.start(Task::Open, move |progress| {
            let loaded = named(&paths, base, added)
                .and_then(|(path, options)| open(path, options, None, progress));
            Done::Opened(Box::new(loaded))
        });
    }

    /// Reads the flight on the screen once more, with other settings.
    pub fn open_again(&mut self, settings: FlightSettings) {
        let Some(open_now) = &self.open else {
            return;
        };
        let (path, options) = (open_now.path.clone(), open_now.options.clone());
        let again = (open_now.number, settings);
        self.notice = None;
        self.reads_other = false;
        self.start(Task::Open, move |progress| {
            Done::Opened(Box::new(open(path, options, Some(again), progress)))
        });
    }

    /// Computes scales and footprints with the settings of now.
    pub fn start_scales(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let (flight, settings) = (open.flight().clone(), open.settings());
        let files = open.photo_files.clone();
        // Footprints under way go on: where these scales are cancelled, they are still wanted.
        self.start(Task::Scales, move |progress| {
            let compute = || {
                let flight = flight.with_settings(&settings)?;
                let outcomes = flight.scales(progress)?;
                // Heights and laser ranges are held against the unit of now.
                let looked_up = opening::look_up(&flight, &files);
                Ok((Arc::new(flight), outcomes, looked_up, settings))
            };
            Done::Scales(compute())
        });
    }

    /// Drapes the footprints of the flight as it is computed.
    pub fn start_views(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let (flight, outcomes) = (open.flight().clone(), open.review.outcomes().clone());
        self.start(Task::Views, move |progress| {
            Done::Views(flight.views(&outcomes, progress))
        });
    }

    /// Makes ready what the viewport draws of the surface.
    pub fn start_geometry(&mut self) {
        let (Some(open), Some(gpu)) = (&self.open, self.gpu.clone()) else {
            return;
        };
        let (flight, frame) = (open.flight().clone(), open.frame);
        self.start(Task::Geometry, move |progress| {
            Done::Geometry(geometry(&flight, &frame, &gpu, progress))
        });
    }

    /// Reads all photos, small.
    pub fn start_thumbnails(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let (number, files) = (open.number, open.photo_files.clone());
        let flight = open.flight().clone();
        let send = self.work.thumbnail_sender();
        let context = self.context.clone();
        self.start(Task::Thumbnails, move |progress| {
            progress.stage("reading photos");
            let photos = &flight.parts().photos;
            for (index, (photo, file)) in photos.iter().zip(files.iter()).enumerate() {
                if progress.advance(index as u64, photos.len() as u64).is_err() {
                    break;
                }
                let Some(path) = &file.path else {
                    continue;
                };
                let camera = flight.camera(photo);
                let image = flight.parts().image;
                let thumbnail = match read_photo(path) {
                    Ok(large) => Thumbnail {
                        flight: number,
                        photo: index,
                        small: Some(color_image(&as_scaled(
                            &large,
                            camera,
                            image,
                            ROW_THUMBNAIL,
                        ))),
                        image: Some(PhotoImage::new(
                            &undistorted(&large, camera, THUMBNAIL).convert(),
                        )),
                        colours: Colours::of_photo(&flight, index, &large),
                    },
                    Err(why) => Thumbnail {
                        flight: number,
                        photo: index,
                        small: None,
                        image: None,
                        colours: Colours::Unreadable(why),
                    },
                };
                // Waits until the window has taken some; a cancelled job gives up.
                if !offer(&send, thumbnail, progress) {
                    break;
                }
                context.request_repaint();
            }
            Done::Thumbnails
        });
    }

    /// Reads the selected photo for the inspector.
    pub fn load_preview(&mut self) {
        self.work.cancel(Task::Preview);
        let Some(open) = &self.open else {
            return;
        };
        let Some(photo) = open.selected else {
            return;
        };
        let file = open.photo_files.get(photo).cloned().unwrap_or_default();
        let (flight, gpu) = (open.flight().clone(), self.gpu.clone());
        // egui refuses larger textures than the graphics device takes.
        let largest = self.context.input(|input| input.max_texture_side);
        let largest = u32::try_from(largest).map_or(PREVIEW, |largest| largest.min(PREVIEW));
        self.start(Task::Preview, move |progress| {
            // Who runs through the table with a key held down wants none of the photos between.
            std::thread::sleep(std::time::Duration::from_millis(60));
            if progress.is_cancelled() {
                return Done::Cancelled;
            }
            let posed = &flight.parts().photos[photo];
            let picture = match &file.path {
                None => Err(format!("the file of photo '{}' is not there", posed.name)),
                Some(path) => read_photo(path).map(|full| {
                    let camera = flight.camera(posed);
                    let image = flight.parts().image;
                    PreviewPicture {
                        projected: gpu.map(|gpu| {
                            LargePhoto::new(&gpu, &undistorted(&full, camera, PROJECTED).convert())
                        }),
                        large: Arc::new(color_image(&as_scaled(&full, camera, image, largest))),
                    }
                }),
            };
            Done::Preview { photo, picture }
        });
    }

    /// Writes flight.toml; with `replace` over a file that is there.
    pub fn start_saving(&mut self, path: PathBuf, replace: bool) {
        let read = self.read_beside(&path);
        let Some(open) = &self.open else {
            return;
        };
        let (settings, origin) = (open.settings(), open.origin.clone());
        self.start(Task::Save, move |_| {
            let saved = origin.text_at(&path, &settings).and_then(|text| {
                files::write(&path, text.as_bytes(), Kind::Flight, &read, replace)
                    .map_err(|fault| FileError::new(&path, fault))
            });
            let saved = match saved {
                Ok(()) => Ok((origin.saved_at(&path), settings)),
                Err(error) => Err(error.to_string()),
            };
            Done::Saved(origin, saved)
        });
    }

    /// Exports the chosen photos, into a folder with the export of another flight where that may be
    /// replaced.
    pub fn start_export(&mut self, folder: PathBuf, replace: Replace) {
        let read = self.read();
        let Some(open) = &self.open else {
            return;
        };
        if !open.review.is_looked_at() || !open.is_computed() {
            self.say(
                Severity::Error,
                "scales and footprints are still being computed; export when they are there",
            );
            return;
        }
        let mut review = open.review.clone();
        let photo_files = open.photo_files.clone();
        let selected = open.history.now().chosen.clone();
        let unit = self.preferences.unit();
        let settings = open.settings();
        let (crs, inputs) = (open.crs.clone(), open.inputs.clone());
        let warnings = open.all_warnings();
        let source = open.origin.file().to_owned();
        self.start(Task::Export, move |progress| {
            // Those that the window has not come to yet.
            let compared = opening::compare_all_colours(&mut review, &photo_files, progress);
            if let Err(fault) = compared {
                return Done::Exported(Err(fault.to_string()));
            }
            let files = photo_files.iter().map(|file| file.path.clone());
            let files: Vec<Option<PathBuf>> = files.collect();
            let request = ExportRequest {
                review: &review,
                from: &Provenance {
                    file: &source,
                    inputs: &inputs,
                    read: &read,
                    photo_files: &files,
                    settings: &settings,
                    crs: crs.as_deref(),
                    warnings: &warnings,
                },
                selected: &selected,
                unit,
                replace,
            };
            let exported = exports::export_for_split_desktop(&folder, &request, progress);
            Done::Exported(match exported {
                Ok(summary) => Ok((format!("{}: {summary}", folder.display()), summary.warnings)),
                Err(error) => Err(error.to_string()),
            })
        });
    }

    /// Opens the desktop's own dialog on a thread of its own: its blocking form would freeze the
    /// window.
    pub fn browse(&mut self, what: DialogFor, folder: bool) {
        self.start(Task::Dialog, move |progress| {
            progress.stage("waiting for the desktop's dialog");
            let dialog = rfd::AsyncFileDialog::new();
            let chosen = pollster::block_on(async {
                match what {
                    DialogFor::Open if folder => {
                        dialog
                            .set_title("Open a flight's folder")
                            .pick_folder()
                            .await
                    }
                    DialogFor::Open => dialog.set_title("Open a flight").pick_file().await,
                    DialogFor::Add if folder => {
                        let dialog = dialog.set_title("Folder of the flight's photos");
                        dialog.pick_folder().await
                    }
                    DialogFor::Add => dialog.set_title("Surface of the flight").pick_file().await,
                    DialogFor::Export => {
                        let dialog = dialog.set_title("Export for Split-Desktop into");
                        dialog.pick_folder().await
                    }
                    DialogFor::SaveAs => {
                        let dialog = dialog.set_title("Save flight").set_file_name("flight.toml");
                        dialog.save_file().await
                    }
                    DialogFor::Georeference(_) if folder => {
                        let dialog = dialog.set_title("Folder of the flight's photos");
                        dialog.pick_folder().await
                    }
                    DialogFor::Georeference(_) => {
                        dialog.set_title("List of positions").pick_file().await
                    }
                    DialogFor::Distributions => {
                        let dialog = dialog.set_title("Size distributions");
                        dialog.pick_file().await
                    }
                    DialogFor::Effort => dialog.set_title("Times of steps").pick_file().await,
                    DialogFor::Figure => {
                        let dialog = dialog.set_title("Save figure");
                        dialog
                            .set_file_name("size-distributions.svg")
                            .save_file()
                            .await
                    }
                    DialogFor::Report => {
                        let dialog = dialog.set_title("Save report");
                        dialog
                            .set_file_name("size-distributions.html")
                            .save_file()
                            .await
                    }
                    DialogFor::Picture => {
                        let dialog = dialog.set_title("Save picture").set_file_name("figure.png");
                        dialog.save_file().await
                    }
                }
            });
            Done::Dialog(what, chosen.map(|file| file.path().to_owned()))
        });
    }
}

/// Which flight was named, with which surface and photos; `base` is the one that a surface or photos
/// alone belong to.
fn named(
    paths: &[PathBuf],
    base: Option<(PathBuf, OpenOptions)>,
    added: bool,
) -> Result<(PathBuf, OpenOptions), Box<NotOpened>> {
    let not_opened = |why| Box::new(NotOpened { why, tried: None });
    let dropped = Dropped::sort(paths).map_err(|error| not_opened(error.to_string()))?;
    let OpenOptions {
        surface,
        mut photos,
        ..
    } = dropped.options;
    let flight = match dropped.flight {
        None if !added => photos.take(),
        flight => flight,
    };
    match (flight, base) {
        (Some(flight), _) => Ok((
            flight,
            OpenOptions {
                surface,
                photos,
                ..OpenOptions::default()
            },
        )),
        (None, Some((path, before))) => Ok((
            path,
            OpenOptions {
                surface: surface.or(before.surface),
                photos: photos.or(before.photos),
                topic: before.topic,
                settings: None,
            },
        )),
        (None, None) => {
            let name = paths.first().map(|path| path.display().to_string());
            Err(not_opened(format!(
                "{}: a surface without photos; drop it together with the photos or with what the photogrammetry package wrote",
                name.unwrap_or_default()
            )))
        }
    }
}

fn open(
    path: PathBuf,
    mut options: OpenOptions,
    again: Option<(u64, FlightSettings)>,
    progress: &Progress,
) -> Result<Loaded, Box<NotOpened>> {
    let again_for = again.as_ref().map(|(number, _)| *number);
    options.settings = again.map(|(_, settings)| settings);
    let not_opened = |error: FileError| {
        Box::new(NotOpened {
            why: error.to_string(),
            tried: Some((path.clone(), options.clone())),
        })
    };
    let begun = Instant::now();
    let opened = opening::open_flight(&path, &options, progress).map_err(not_opened)?;
    let read = begun.elapsed();
    let at_path = |fault: Fault| not_opened(FileError::new(&path, fault));
    let outcomes = opened.flight.scales(progress).map_err(at_path)?;
    let surface = &opened.flight.parts().surface;
    let (surface_bounds, bulk_bounds) = (surface.bounds(), surface.bulk_bounds());
    Ok(Loaded {
        path,
        options,
        opened,
        outcomes,
        surface_bounds,
        bulk_bounds,
        took: [read, begun.elapsed().saturating_sub(read)],
        again_for,
    })
}

/// Triangulates, makes ready and uploads: the window's thread has nothing left to do with it.
fn geometry(
    flight: &Flight,
    frame: &LocalFrame,
    gpu: &Gpu,
    progress: &Progress,
) -> Result<Box<Geometry>, Fault> {
    let surface = &flight.parts().surface;
    progress.stage("triangulating the surface for the picture");
    let triangles = surface
        .triangles()
        .map_err(|error| Fault::new(error.to_string(), "check the surface file"))?;
    progress.advance(1, 4)?;
    let normals = Normals::of(frame, surface.vertices(), &triangles);
    progress.advance(2, 4)?;
    let colors = surface.colors();
    let mesh = MeshGeometry::new(frame, surface.vertices(), colors, &normals, &triangles);
    drop(triangles);
    progress.advance(3, 4)?;
    let mesh = MeshBuffers::new(gpu, &mesh);
    let cloud = CloudGeometry::new(frame, surface.vertices(), colors, &normals);
    progress.advance(4, 4)?;
    Ok(Box::new(Geometry {
        cloud: CloudBuffers::new(gpu, &cloud),
        mesh,
        points: surface.vertices().len(),
    }))
}

/// Reads a photo.
fn read_photo(path: &Path) -> Result<RgbImage, String> {
    let bytes = formats::read_bytes(path).map_err(|error| error.to_string())?;
    picture::decode(&bytes).map_err(|fault| FileError::new(path, fault).to_string())
}

/// A photo as its scale assumes it, reduced.
fn as_scaled(photo: &RgbImage, camera: &Camera, image: ImageKind, max_side: u32) -> RgbImage {
    match image {
        ImageKind::Undistorted => undistorted(photo, camera, max_side),
        ImageKind::AsShot => picture::reduced(photo, max_side),
    }
}

/// A photo without the distortion of its lens, reduced: what the viewport's pinhole cameras show,
/// whatever the scales are for.
fn undistorted(photo: &RgbImage, camera: &Camera, max_side: u32) -> RgbImage {
    if photo.dimensions() == (camera.width, camera.height) {
        picture::undistorted(photo, camera, max_side)
    } else {
        // A photo of another size is shown as it is: its verdict says that it does not fit.
        picture::reduced(photo, max_side)
    }
}

fn color_image(picture: &RgbImage) -> egui::ColorImage {
    let size = [picture.width() as usize, picture.height() as usize];
    egui::ColorImage::from_rgb(size, picture.as_raw())
}

/// Sends a thumbnail as soon as there is room; false where nobody wants it any more.
fn offer(
    send: &std::sync::mpsc::SyncSender<Thumbnail>,
    mut thumbnail: Thumbnail,
    progress: &Progress,
) -> bool {
    use std::sync::mpsc::TrySendError;
    loop {
        match send.try_send(thumbnail) {
            Ok(()) => return true,
            Err(TrySendError::Disconnected(_)) => return false,
            Err(TrySendError::Full(back)) => {
                if progress.is_cancelled() {
                    return false;
                }
                thumbnail = back;
                std::thread::sleep(std::time::Duration::from_millis(5));
            }
        }
    }
}

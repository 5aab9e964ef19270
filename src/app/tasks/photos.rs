//! Reading photos: all of them small, the selected one large.

use std::path::Path;
use std::sync::Arc;

use image::RgbImage;
use image::buffer::ConvertBuffer;

use super::work::Task;
use crate::camera::Camera;
use crate::flight::{ColoursFound, Doubt, TogetherFound, Verdict};
use crate::formats::photos::photo_metadata;
use crate::formats::{self, FileError};
use crate::jobs::Progress;
use crate::open_flight::{Preview, PreviewPicture};
use crate::opening::{Colours, PhotosTogether, Together};
use crate::picture;
use crate::render::{LargePhoto, PhotoImage};
use crate::scale::ImageKind;
use crate::state::{Severity, State};

/// The longer side of a thumbnail, pixels: for the table and the image planes in the viewport.
const THUMBNAIL: u32 = 256;

/// The longer side of a thumbnail in the table, pixels: sharp at 200 %.
const ROW_THUMBNAIL: u32 = 128;

/// The longer side of the photo that is laid over the surface, pixels.
const PROJECTED: u32 = 2048;

/// The longer side of the inspector's photo, pixels: zooming in shows more than a screen does.
const PREVIEW: u32 = 4096;

impl Task {
    /// Small pictures of all photos.
    pub const THUMBNAILS: Self = Self::new("Thumbnails").of_flight();
    /// The selected photo for the inspector.
    pub const PREVIEW: Self = Self::new("Photo").of_flight();
}

/// What is said while [`State::compares_photos`].
pub(crate) const STILL_COMPARING: &str =
    "The photos are still being compared with the surface and with each other";

/// A reduced, undistorted photo on its way to the table and the viewport.
struct Thumbnail {
    /// Of which opened flight, counted.
    flight: u64,
    /// Which photo.
    photo: usize,
    /// For the table.
    small: Option<egui::ColorImage>,
    /// For the viewport.
    image: Option<PhotoImage>,
    /// When it was taken, by EXIF.
    time: Option<String>,
}

impl State {
    /// Whether the photos are still being compared: their colours as they are read, with those beside them, and behind the last what
    /// follows from all.
    pub(crate) fn compares_photos(&self) -> bool {
        self.work.is_running(Task::THUMBNAILS)
    }

    /// Whether a photo with this verdict may still be doubted for what its comparison says.
    pub(crate) fn may_still_be_doubted(&self, verdict: Verdict) -> bool {
        self.may_fall() == Some(verdict)
    }

    /// The verdict with which a photo may still be doubted for that, if any. It is looked up among all tasks: who looks at many photos
    /// asks once.
    pub(crate) fn may_fall(&self) -> Option<Verdict> {
        self.compares_photos().then_some(Verdict::Trust)
    }

    /// Reads all photos, small.
    pub fn start_thumbnails(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let (number, files) = (open.number, open.files.photo_files.clone());
        let flight = open.flight().clone();
        let outcomes = open.review.outcomes().clone();
        let steps = self.work.steps_of_a_job();
        let context = self.context.clone();
        let work = move |progress: &Progress| {
            // Cancelled, nobody is told anything: what all say together is known behind the last one.
            let Ok(mut together) = PhotosTogether::new(&flight, &outcomes, &files, progress) else {
                return Vec::new();
            };
            progress.stage("reading photos");
            let photos = &flight.parts().photos;
            let has_colours = !flight.parts().surface.colors().is_empty();
            for (index, (photo, file)) in photos.iter().zip(files.iter()).enumerate() {
                if progress.advance(index as u64, photos.len() as u64).is_err() {
                    return Vec::new();
                }
                let Some(path) = &file.path else {
                    together.give_up(index);
                    continue;
                };
                let camera = flight.camera(photo);
                let image = flight.parts().image;
                let metadata = photo_metadata::read_file(path).ok();
                let time = metadata.and_then(|metadata| metadata.time);
                let read = read_photo(path);
                let large = read.as_ref().ok();
                let thumbnail = Thumbnail {
                    flight: number,
                    photo: index,
                    small: large
                        .map(|large| color_image(&as_scaled(large, camera, image, ROW_THUMBNAIL))),
                    image: large.map(|large| {
                        PhotoImage::new(&undistorted(large, camera, THUMBNAIL).convert())
                    }),
                    time,
                };
                // Waits until the window has taken some; a cancelled job gives up.
                if !steps.offer(|state: &mut Self| state.take_thumbnail(thumbnail), progress) {
                    return Vec::new();
                }
                context.request_repaint();
                // What takes longer comes behind what is seen.
                let is_compared = has_colours || together.wants(index);
                let small = read.as_ref().ok().filter(|_| is_compared);
                let small = small.and_then(|large| picture::for_comparing(large, camera));
                let colours = match read {
                    Ok(_) => Colours::of_photo(&flight, index, small.as_ref()),
                    Err(why) => Colours::Unreadable(why),
                };
                together.take_colours(index, &(&colours).into());
                let tell = move |state: &mut Self| state.take_colours(number, index, &colours);
                if !steps.offer(tell, progress) {
                    return Vec::new();
                }
                context.request_repaint();
                match &small {
                    Some(small) => together.take(&flight, index, small, progress),
                    None => together.give_up(index),
                }
            }
            together.found(&flight)
        };
        // All thumbnails have been sent by then.
        self.start(Task::THUMBNAILS, work, move |state, found| {
            state.take_together(number, &found);
        });
    }

    /// Reads the selected photo for the inspector; its tint comes with it.
    pub fn load_preview(&mut self) {
        self.load_tint();
        self.load_full_photo();
        self.load_corners();
        self.work.cancel(Task::PREVIEW);
        let Some(open) = &self.open else {
            return;
        };
        let Some(photo) = open.selected else {
            return;
        };
        let file = open
            .files
            .photo_files
            .get(photo)
            .cloned()
            .unwrap_or_default();
        let (flight, gpu) = (open.flight().clone(), self.gpu.clone());
        // egui refuses larger textures than the graphics device takes.
        let largest = self.context.input(|input| input.max_texture_side);
        let largest = u32::try_from(largest).map_or(PREVIEW, |largest| largest.min(PREVIEW));
        let work = move |progress: &Progress| {
            // Who runs through the table with a key held down wants none of the photos between.
            std::thread::sleep(std::time::Duration::from_millis(60));
            if progress.is_cancelled() {
                return None;
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
            Some(picture)
        };
        self.start(Task::PREVIEW, work, move |state, picture| {
            if let Some(picture) = picture
                && let Some(open) = &mut state.open
                && open.selected == Some(photo)
            {
                let number = open
                    .pictures
                    .preview
                    .as_ref()
                    .map_or(0, |preview| preview.number)
                    + 1;
                open.pictures.preview = Some(Preview {
                    photo,
                    picture,
                    number,
                });
            }
        });
    }

    /// Takes what photos of an opened flight and those beside them see.
    fn take_together(&mut self, flight: u64, found: &[(usize, Together)]) {
        let Some(open) = self.open.as_mut().filter(|open| open.number == flight) else {
            return;
        };
        let is_new = |photo: usize| {
            let evidence = open.review.looked_up().evidence.get(photo);
            evidence.is_some_and(|evidence| !matches!(evidence.together, TogetherFound::Against(_)))
        };
        // What follows of the others the strip says once, not the messages of every photo.
        let of_itself = |together: &Together| together.doubt().filter(Doubt::is_of_pixels);
        let said = found.iter().filter_map(|(photo, together)| {
            let doubt = of_itself(together).filter(|_| is_new(*photo))?;
            Some(format!("photo '{}': {doubt}", open.name(*photo)))
        });
        let said: Vec<String> = said.collect();
        open.take_together(found);
        for said in said {
            self.say(Severity::Warning, &said);
        }
    }

    fn take_thumbnail(&mut self, thumbnail: Thumbnail) {
        let Thumbnail {
            flight,
            photo,
            small,
            image,
            time,
        } = thumbnail;
        let Some(open) = &mut self.open else {
            return;
        };
        if open.number != flight || photo >= open.pictures.thumbnails.len() {
            return;
        }
        if let Some(small) = small {
            let options = egui::TextureOptions::LINEAR;
            let texture = self
                .context
                .load_texture(format!("thumbnail {photo}"), small, options);
            open.pictures.thumbnails[photo] = Some(texture);
        }
        open.pictures.images[photo] = image.map(Arc::new);
        open.take_time(photo, time);
    }

    /// Takes how the colours of a photo of that flight compare with the surface's.
    fn take_colours(&mut self, flight: u64, photo: usize, colours: &Colours) {
        let Some(open) = self.open.as_mut().filter(|open| open.number == flight) else {
            return;
        };
        let evidence = open.review.looked_up().evidence.get(photo);
        let is_known =
            evidence.is_some_and(|evidence| evidence.colours != ColoursFound::NotCompared);
        let doubt = colours.doubt().filter(|_| !is_known);
        let said = doubt.map(|doubt| format!("photo '{}': {doubt}", open.name(photo)));
        open.take_colours(photo, colours);
        if let Some(said) = said {
            self.say(Severity::Warning, &said);
        }
    }
}

/// Reads a photo.
pub(crate) fn read_photo(path: &Path) -> Result<RgbImage, String> {
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

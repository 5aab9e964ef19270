//! What the photo view's commands do, and reading the photo for it.

use std::sync::Arc;

use glam::DVec2;

use super::placing::Placing;
use super::{FullPhoto, PhotoCommand};
use crate::camera::Camera;
use crate::jobs::Progress;
use crate::open_flight::OpenFlight;
use crate::picture::PhotoPyramid;
use crate::scale::ImageKind;
use crate::size_distributions::Page;
use crate::state::{Severity, State};
use crate::tasks::Task;
use crate::tasks::photos::read_photo;

impl Task {
    /// The selected photo at full resolution.
    pub const FULL_PHOTO: Self = Self::new("Full photo").of_flight();
}

impl State {
    pub(crate) fn apply_to_photo(&mut self, command: PhotoCommand) {
        if let PhotoCommand::Middle(middle) = command {
            self.middle = middle;
            self.load_full_photo();
            return;
        }
        if let PhotoCommand::Overlays(overlays) = command {
            self.preferences.photo_overlays = overlays;
            return;
        }
        let Some(open) = &mut self.open else {
            return;
        };
        if let PhotoCommand::Image(image) = command {
            let before = open.photo_view.image_for(open.flight().parts().image);
            open.photo_view.image = Some(image);
            if before != image {
                self.begin_tiles();
            }
            return;
        }
        let Some(image) = open.selected_size() else {
            return;
        };
        let view = &mut open.photo_view;
        view.placing = match command {
            PhotoCommand::Zoom {
                cursor,
                factor,
                frame,
            } => view.placing.zoomed(cursor, factor, image, frame),
            PhotoCommand::Pan { by, frame } => view.placing.panned(by, image, frame),
            PhotoCommand::OneToOne => Placing {
                zoom: Some(1.0),
                ..view.placing
            },
            PhotoCommand::Fit => Placing::default(),
            PhotoCommand::GoTo(pixel) => view.placing.at(pixel, image),
            PhotoCommand::Want(wanted) => {
                view.tiles.want(wanted);
                return;
            }
            PhotoCommand::Middle(_) | PhotoCommand::Overlays(_) | PhotoCommand::Image(_) => return,
        };
    }

    /// Reads the selected photo at full resolution where it is looked at and not there.
    pub(crate) fn load_full_photo(&mut self) {
        self.work.cancel(Task::FULL_PHOTO);
        let Some(open) = &mut self.open else {
            return;
        };
        let there = open.photo_view.full.as_ref().map(|full| full.photo);
        let is_seen = self.middle.has_photo() || self.page == Page::Fragments;
        if there != open.selected || !is_seen {
            // A large photo is hundreds of megabytes: no longer than it is looked at.
            open.photo_view.full = None;
            open.photo_view.tiles = Default::default();
        }
        let wanted = open.selected.filter(|_| is_seen);
        let Some(photo) = wanted.filter(|_| open.photo_view.full.is_none()) else {
            return;
        };
        let files = &open.files.photo_files;
        let file = files.get(photo).cloned().unwrap_or_default();
        let name = open.name(photo).to_owned();
        let work = move |progress: &Progress| {
            // Who runs through the photos with a key held down wants none of those between.
            std::thread::sleep(std::time::Duration::from_millis(60));
            if progress.is_cancelled() {
                return None;
            }
            progress.stage("reading the photo at full resolution");
            Some(match &file.path {
                None => Err(format!("the file of photo '{name}' is not there")),
                Some(path) => read_photo(path).map(|pixels| Arc::new(PhotoPyramid::new(pixels))),
            })
        };
        self.start(Task::FULL_PHOTO, work, move |state, pixels| {
            if let (Some(pixels), Some(open)) = (pixels, &mut state.open)
                && open.selected == Some(photo)
            {
                open.photo_view.full = Some(FullPhoto { photo, pixels });
                state.begin_tiles();
            }
        });
    }

    /// The same where the photo may be another one: its file, or its camera.
    pub(crate) fn load_full_photo_anew(&mut self) {
        if let Some(open) = &mut self.open {
            open.photo_view.full = None;
        }
        self.load_full_photo();
    }

    /// Begins to make tiles of the image that is to be shown.
    fn begin_tiles(&mut self) {
        let context = self.context.clone();
        let Some(open) = &mut self.open else {
            return;
        };
        let Some(FullPhoto {
            photo,
            pixels: Ok(pixels),
        }) = &open.photo_view.full
        else {
            return;
        };
        let pixels = pixels.clone();
        let lens = open.lens_of(*photo, pixels.size());
        let begun = open.photo_view.tiles.begin(pixels, lens, context);
        if let Err(fault) = begun {
            self.say(Severity::Error, &fault.to_string());
        }
    }
}

impl OpenFlight {
    /// The size of the selected photo's image, pixels of its camera.
    fn selected_size(&self) -> Option<DVec2> {
        let camera = self.review.photo(self.selected?)?.camera;
        Some(DVec2::new(
            f64::from(camera.width),
            f64::from(camera.height),
        ))
    }

    /// The camera that a photo is to be undistorted by; `None` where it is shown as shot. A file of another
    /// size is shown as it is: its verdict says that it does not fit.
    fn lens_of(&self, photo: usize, size: (u32, u32)) -> Option<Camera> {
        let image = self.photo_view.image_for(self.flight().parts().image);
        let camera = self.review.photo(photo)?.camera;
        let fits = (camera.width, camera.height) == size;
        (fits && image == ImageKind::Undistorted).then(|| camera.clone())
    }
}

//! What the corner loupe's commands do, and looking for its triangles.

use glam::DVec2;

use super::{CROP, CornerFacts, CornerTriangle};
use crate::camera::Camera;
use crate::jobs::Progress;
use crate::open_flight::OpenFlight;
use crate::scale::{Corner, CornerName, ImageKind};
use crate::state::{Severity, State};
use crate::surface::SurfaceError;
use crate::tasks::Task;

impl Task {
    /// Looking for the triangles that the corners lie on.
    pub const CORNERS: Self = Self::new("Corners").of_flight().to_the_end();
}

impl State {
    /// Shows the loupe, or does no longer.
    pub(crate) fn toggle_loupe(&mut self) {
        self.preferences.loupe_open ^= true;
        self.load_corners();
    }

    /// Looks for the triangles under the corners of the selected photo, where that is wanted.
    pub(crate) fn load_corners(&mut self) {
        self.work.cancel(Task::CORNERS);
        let is_wanted = self.preferences.loupe_open;
        let Some(open) = &mut self.open else {
            return;
        };
        open.corners = None;
        let Some(photo) = open.selected.filter(|_| is_wanted) else {
            return;
        };
        let Some(scale) = open.scale(photo) else {
            return;
        };
        let (corners, flight) = (scale.corners, open.flight().clone());
        let work = move |progress: &Progress| {
            let surface = &flight.parts().surface;
            let mut triangles = [None; 4];
            for (place, corner) in triangles.iter_mut().zip(&corners) {
                if progress.is_cancelled() {
                    return Ok(None);
                }
                *place = CornerTriangle::of(corner, surface)?;
            }
            Ok(Some(CornerFacts { photo, triangles }))
        };
        self.start(Task::CORNERS, work, |state, facts| match facts {
            Ok(facts) => {
                if let Some(open) = &mut state.open {
                    open.corners = facts.filter(|facts| Some(facts.photo) == open.selected);
                }
            }
            Err(error) => {
                let error: SurfaceError = error;
                state.say(Severity::Error, &error.to_string());
            }
        });
    }
}

impl OpenFlight {
    /// Goes to a corner of the selected photo: in the pile to its point, in the photo view to its pixel.
    pub(crate) fn go_to_corner(&mut self, name: CornerName) {
        let image = self.flight().parts().image;
        let Some(reviewed) = self.selected.and_then(|photo| self.review.photo(photo)) else {
            return;
        };
        let (camera, pose) = (reviewed.camera.clone(), reviewed.photo.pose);
        let pixel = name.pixel(&camera);
        let shown = self.photo_view.image_for(image);
        let shown = shown.pixel_from(image, &camera, pixel).unwrap_or(pixel);
        self.photo_view.placing = self.photo_view.placing.at(shown, size_of(&camera));
        let found = reviewed.scale().and_then(|scale| {
            let corner = scale.corners.iter().find(|corner| corner.name == name);
            corner.and_then(Corner::point)
        });
        if let Some(point) = found {
            // As near as shows about what a crop of the loupe shows, from where it was looked.
            let distance = (point - pose.center).length();
            let across = distance * f64::from(camera.width.max(camera.height)) / camera.fx;
            self.looking.through = None;
            self.looking.turned = true;
            self.looking.orbit.center_on(point);
            self.looking.orbit.distance = (across * CROP * 2.0).max(f64::MIN_POSITIVE);
        }
    }

    /// The ray of a corner of a photo in the undistorted image, as a pixel of it.
    pub(crate) fn corner_in_view(&self, photo: usize, name: CornerName) -> Option<DVec2> {
        let image = self.flight().parts().image;
        let camera = self.review.photo(photo)?.camera;
        ImageKind::Undistorted.pixel_from(image, camera, name.pixel(camera))
    }
}

fn size_of(camera: &Camera) -> DVec2 {
    DVec2::new(f64::from(camera.width), f64::from(camera.height))
}

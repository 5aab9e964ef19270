//! What a ray of the mouse does to the flight on the screen, once it is known what it met.

use std::sync::Arc;

use glam::DVec2;

use crate::camera::{Camera, Pose};
use crate::open_flight::picker::{Picked, Purpose};
use crate::open_flight::survey::SurveyStep;
use crate::open_flight::{Measure, OpenFlight};
use crate::planning::PlanTool;

impl OpenFlight {
    /// Takes what a ray met.
    pub(crate) fn take_picked(&mut self, picked: Picked) {
        let point = picked.hit.map(|hit| hit.point);
        match picked.purpose {
            // The mouse may have left since.
            Purpose::Hover if self.pointer.from.is_none() => {}
            Purpose::Hover => {
                self.pointer.hover = point;
                self.pointer.linked = picked.linked.map(Arc::new);
                self.ask_surveyor();
            }
            Purpose::Draw => {
                if let Some(point) = point {
                    self.draw_at(point);
                }
            }
            Purpose::EndDrawing => self.survey(SurveyStep::Finish),
            Purpose::Pick => {
                // A double click picks its place once.
                let last = self.pointer.picked.list().last();
                let again = last.is_some_and(|last| Some(last.point) == point);
                if let Some(point) = point.filter(|_| !again) {
                    self.pointer.picked.pick(point);
                }
            }
            Purpose::Center => {
                if let Some(point) = point {
                    self.looking.through = None;
                    self.looking.orbit.center_on(point);
                }
            }
            Purpose::Measure => {
                if let Some(point) = point {
                    self.pointer.measure = match self.pointer.measure {
                        Measure::Off => Measure::Off,
                        Measure::First | Measure::Both(..) => Measure::Second(point),
                        Measure::Second(first) => Measure::Both(first, point),
                    };
                }
            }
            Purpose::Plan if self.planning.tool == PlanTool::Select => {
                let made = self.planning.made.clone();
                let photo = made.and_then(|made| {
                    let photos = made.plan.photos.iter();
                    let photos = photos.map(|photo| (&photo.pose, &made.plan.camera));
                    photo_at(&picked, photos)
                });
                self.planning.select(photo);
            }
            // The whole window has a part in it.
            Purpose::EndArea => {}
            Purpose::Plan => {
                if let Some(point) = point {
                    self.plan_at(point.truncate());
                }
            }
            Purpose::Select => {
                let flight = self.flight().clone();
                let photos = flight.parts().photos.iter();
                let photos = photos.map(|photo| (&photo.pose, flight.camera(photo)));
                if let Some(photo) = photo_at(&picked, photos) {
                    self.select(Some(photo));
                }
            }
        }
    }
}

/// The photo that a click means: the camera next to the ray, else the photo that sees the place
/// nearest to its middle.
fn photo_at<'a>(
    picked: &Picked,
    photos: impl Iterator<Item = (&'a Pose, &'a Camera)> + Clone,
) -> Option<usize> {
    // A camera is hit within this share of its distance: about ten pixels on the screen.
    let reach = 0.012;
    let camera = (photos.clone().enumerate())
        .filter_map(|(index, (pose, _))| {
            let way = pose.center - picked.ray.origin;
            let along = way.dot(picked.ray.direction);
            let beside = (way - picked.ray.direction * along).length();
            let before_surface = picked.hit.is_none_or(|hit| along < hit.t);
            (along > 0.0 && before_surface && beside < reach * along)
                .then_some((index, beside / along))
        })
        .min_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((index, _)) = camera {
        return Some(index);
    }
    let point = picked.hit?.point;
    photos
        .enumerate()
        .filter_map(|(index, (pose, camera))| {
            let pixel = camera.pixel_undistorted(pose.camera_from_world(point))?;
            let half = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
            (camera.contains(pixel)).then(|| (index, ((pixel - half) / half).abs().max_element()))
        })
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(index, _)| index)
}

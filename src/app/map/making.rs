//! The plan of the flight on the screen, as a job.

use std::sync::Arc;

use super::{MadePlan, PhotosAt};
use crate::exports::{Plan, PlanRequest};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::opening::PhotoFile;
use crate::picture::reduced_size;
use crate::state::{Severity, State};
use crate::tasks::Task;

impl Task {
    /// Making the plan of a flight.
    pub const MAP: Self = Self::new("Map").of_flight().to_the_end();
}

/// The pixels of a photo as shot, from its file.
pub(super) fn pixels_of(
    files: &[PhotoFile],
    photo: usize,
) -> Option<Result<image::RgbImage, Fault>> {
    let pixels = files.get(photo)?.pixels()?;
    Some(pixels.map_err(|error| error.fault))
}

/// A picture as the graphics device takes it: no side longer than its textures can be.
fn on_screen(picture: &image::RgbaImage, context: &egui::Context) -> egui::ColorImage {
    let most = context.input(|input| input.max_texture_side) as u32;
    let (width, height) = reduced_size(picture.width(), picture.height(), most);
    let small = ((width, height) != picture.dimensions()).then(|| {
        let filter = image::imageops::FilterType::Triangle;
        image::imageops::resize(picture, width, height, filter)
    });
    let picture = small.as_ref().unwrap_or(picture);
    egui::ColorImage::from_rgba_unmultiplied([width as usize, height as usize], picture.as_raw())
}

impl State {
    /// Makes the plan of the review as it is now; its ground only where the surface is another one.
    pub(super) fn make_map(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        let wish = open.map.wish();
        let (revision, kind) = wish;
        let before = open.map.made.as_ref().map(|made| {
            let surface = &open.review.flight().parts().surface;
            let same = Arc::ptr_eq(&made.surface, surface) && made.plan.ground_kind == kind;
            (same.then(|| made.plan.clone()), made.ground.clone())
        });
        let (review, crs) = (open.review.clone(), open.files.crs.clone());
        let files = open.files.photo_files.clone();
        let context = self.context.clone();
        let work = move |progress: &Progress| {
            let request = PlanRequest {
                crs: crs.as_deref(),
                ground: kind,
                ..PlanRequest::default()
            };
            let pixels = |photo: usize| pixels_of(&files, photo);
            let kept = before.and_then(|(plan, ground)| Some((plan?, ground)));
            let (plan, ground) = match kept {
                Some((plan, ground)) => (plan.with_photos_of(&review), ground),
                None => {
                    let plan = Plan::new(&review, request, &pixels, progress)?;
                    let pixels = on_screen(&plan.ground, &context);
                    let options = egui::TextureOptions::LINEAR;
                    let ground = context.load_texture("ground of the map", pixels, options);
                    (plan, ground)
                }
            };
            Ok(MadePlan {
                revision,
                photos: Arc::new(PhotosAt::new(&plan)),
                surface: review.flight().parts().surface.clone(),
                plan: Arc::new(plan),
                ground,
            })
        };
        self.start_wished(Task::MAP, wish, work, |state, made: MadePlan| {
            let Some(open) = &mut state.open else {
                return;
            };
            let warnings = made.plan.warnings.clone();
            open.map.made = Some(made);
            for warning in &warnings {
                state.say(Severity::Warning, warning);
            }
        });
    }
}

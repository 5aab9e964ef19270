//! The part of the plan that is in sight, as a picture: a thread draws it, so that no frame waits for many
//! photos.

use super::part::{DrawnPart, PartInSight};
use crate::exports::{GroundOf, PlanGround, PlanInks, ground};
use crate::jobs::Progress;
use crate::state::State;
use crate::surface::MapRaster;
use crate::tasks::Task;

impl Task {
    /// Drawing the part of the map that is in sight.
    pub const MAP_PART: Self = Self::new("Drawing the map").of_flight().to_the_end();
}

/// How much coarser than the screen the ground may be before the part in sight is lit anew.
const COARSE: f64 = 1.4;

impl State {
    /// Draws a part of the plan.
    pub(super) fn draw_map(&mut self, part: PartInSight) {
        let made = self.open.as_ref().and_then(|open| open.map.made.as_ref());
        let Some(made) = made else {
            return;
        };
        let plan = made.plan.clone();
        let review = self.open.as_ref().map(|open| open.review.clone());
        let Some(review) = review else {
            return;
        };
        let context = self.context.clone();
        let most = context.input(|input| input.max_texture_side) as f64;
        let work = move |progress: &Progress| {
            progress.stage("drawing the map");
            let (frame, pixels) = (part.frame(), part.pixels_of_picture(most));
            let inks = match part.dark {
                true => PlanInks::DARK,
                false => PlanInks::PAPER,
            };
            let options = egui::TextureOptions::LINEAR;
            let texture = |name: &str, picture: &image::RgbaImage| {
                let size = [picture.width() as usize, picture.height() as usize];
                let pixels = egui::ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
                context.load_texture(name, pixels, options)
            };
            let picture = plan.photos_picture(&frame, &part.room_for_names(), &inks, pixels);
            let photos = texture("photos of the map", &picture);
            // A pixel of the screen, world units.
            let pixel = 1.0 / (part.scale * pixels);
            // Photos are not read anew at every step of the wheel.
            let is_relief = plan.ground_kind == PlanGround::Relief;
            let ground = if is_relief && plan.raster.pixel > COARSE * pixel {
                let ([min, max], whole) = (frame.bounds(), plan.raster.bounds());
                let seen = [min.max(whole[0]), max.min(whole[1])];
                let raster = seen[0].cmplt(seen[1]).all().then(|| {
                    let most = most * most;
                    MapRaster::over(seen, pixel, most as u64)
                });
                match raster.transpose()? {
                    Some(raster) => {
                        let of = GroundOf {
                            review: &review,
                            photos: &|_| None,
                            kind: plan.ground_kind,
                            light: plan.light,
                        };
                        let (picture, _) = ground(&of, &raster, progress)?;
                        Some((texture("ground of the map", &picture), raster.bounds()))
                    }
                    None => None,
                }
            } else {
                None
            };
            Ok(DrawnPart {
                part,
                frame,
                photos,
                ground,
            })
        };
        self.start_wished(Task::MAP_PART, part, work, |state, drawn| {
            if let Some(open) = &mut state.open {
                open.map.take_drawn(drawn);
            }
        });
    }
}

//! One photo of a pattern: where it is taken from, whether the drone may go there, and what it will show.

use glam::{DVec2, DVec3};

use super::{Ground, NO_GROUND};
use crate::camera::Pose;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::numbers::apart;
use crate::plan::forecast::{Forecast, bulk_of};
use crate::plan::keep_out::KeepOut;
use crate::plan::photo::PlannedPhoto;
use crate::plan::steadiness::interval;
use crate::plan::terrain::GroundPlane;
use crate::plan::wish::Size;
use crate::surface::Surface;

/// How often the distance of a photo is set so that its scales lie around the wished one.
const ROUNDS: usize = 3;

impl Ground<'_> {
    /// Moves a photo of the slope pattern along its axis until the middle of the bulk of its scales is the wished one,
    /// by the terrain's raster.
    pub(in crate::plan) fn set_distance(&self, photo: &mut PlannedPhoto) {
        let (true, Size::Scale { pixels, .. }) = (self.is_square(), self.wish.size) else {
            return;
        };
        let focal = (self.camera.fx * self.camera.fy).sqrt();
        let away = (photo.pose.center - photo.target) / photo.distance;
        for _ in 0..ROUNDS {
            let seen = photo.sees(self.camera, self.terrain);
            let mut scales: Vec<f64> = seen.map(|(_, in_camera)| focal / in_camera.z).collect();
            let Some([least, greatest]) = bulk_of(&mut scales) else {
                return;
            };
            // Both ends move alike, nearly: a few rounds do.
            let middle = (least + greatest) / 2.0;
            photo.distance *= middle / pixels;
            photo.pose.center = photo.target + away * photo.distance;
        }
    }

    /// Why the drone does not take a photo, by its gimbal or by where it is to be taken from, one clause; `None` where it
    /// does.
    pub(in crate::plan) fn not_flown(
        &self,
        photo: &PlannedPhoto,
        keep_out: &KeepOut<'_>,
    ) -> Option<String> {
        let (from, pitch) = (photo.pose.center, -photo.tilt);
        let [lowest, highest] = self.wish.gimbal;
        if pitch < lowest || pitch > highest {
            let end = if pitch < lowest { lowest } else { highest };
            let (pitch, end) = apart(pitch, end, 0);
            return Some(format!(
                "the gimbal does not reach so far: it would have to pitch to {pitch} degrees, and goes to {end}"
            ));
        }
        if self.terrain.is_near(from, self.wish.clearance) {
            let why = "the drone would come nearer to the ground than the clearance (--clearance)";
            return Some(why.to_owned());
        }
        let why = "the drone would stand over an area to keep out of, or too near to it";
        keep_out.holds(from.truncate()).then(|| why.to_owned())
    }

    /// Says what a photo will show, and how sure its scale is.
    pub(in crate::plan) fn foresee(
        &self,
        photo: &mut PlannedPhoto,
        surface: &Surface,
        progress: &Progress,
    ) -> Result<(), Fault> {
        let foreseen = Forecast::of(self.camera, &photo.pose, surface, progress)?;
        photo.outline.clear();
        photo.forecast = foreseen.map(|(forecast, outline)| {
            photo.outline = outline;
            forecast
        });
        photo.interval = interval(photo, self.camera, self.terrain, &self.wish.errors);
        Ok(())
    }

    /// A photo that looks at the ground squarely.
    pub(super) fn square_to_ground(
        &self,
        place: DVec2,
        along: DVec2,
    ) -> Result<PlannedPhoto, String> {
        let side = self.footprint().max_element();
        let ground = self.terrain.plane(place, side);
        let ground = ground.ok_or(NO_GROUND)?;
        let normal = ground.normal;
        // The normal's part in the upright plane of the strip.
        let sideways = along.perp().extend(0.0);
        let in_strip = (normal - sideways * normal.dot(sideways)).normalize();
        let axis = match in_strip.angle_between(normal).to_degrees() <= self.wish.off_normal {
            true => -in_strip,
            false => -normal,
        };
        let level = axis.truncate();
        // Uphill; straight down any direction does, so that of the strip.
        let looks = if level.length() < 1e-9 { along } else { level };
        let pitch = axis.z.clamp(-1.0, 1.0).asin().to_degrees();
        Ok(self.looking_at(ground.point, [-pitch, azimuth(looks)], ground))
    }

    /// The photo whose middle shows a point from the distance, by tilt and pan in degrees.
    pub(super) fn looking_at(
        &self,
        target: DVec3,
        angles: [f64; 2],
        ground: GroundPlane,
    ) -> PlannedPhoto {
        let camera = self.camera;
        // A height above all is one: aslant the way to it is longer.
        let distance = match (self.wish.size_of(self.purpose), self.is_square()) {
            (Size::Distance(height), false) => height / angles[0].to_radians().sin(),
            _ => self.distance,
        };
        let middle = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
        let direction = camera.direction_undistorted(middle);
        let direction = direction / direction.z;
        let level = Pose::from_tilt_pan(DVec3::ZERO, angles);
        let center = target - level.rotation * direction * distance;
        let axis = level.rotation * DVec3::Z;
        PlannedPhoto {
            name: String::new(),
            purpose: self.purpose,
            pose: Pose { center, ..level },
            tilt: angles[0],
            pan: angles[1].rem_euclid(360.0),
            target,
            distance,
            off_normal: (-axis).angle_between(ground.normal).to_degrees(),
            // Aslant footprints are longer.
            reach: self.footprint().length() / axis.z.abs().max(0.3),
            forecast: None,
            outline: Vec::new(),
            interval: None,
        }
    }
}

/// Degrees clockwise from world +y.
pub(super) fn azimuth(direction: DVec2) -> f64 {
    direction.x.atan2(direction.y).to_degrees()
}

//! Where to fly, so that the photos are good before they are flown: a plan against the true surface, what each
//! photo will show, and the mission that a drone is told.
//!
//! ```text
//! wish        what is asked for: scale, pattern, gaps, gimbal, clearance; and what is usual
//! terrain     heights on a raster, planes of the ground, how near a point in the air is to it
//! drones      cameras and gimbals that are often flown
//! area        the ground to be photographed: the pile found by itself
//! keep_out    the ground that is not flown over, and the way around it
//! photo       a planned photo
//! patterns    where photos are taken from: slope, paper, survey
//! forecast    what a photo will show: its field of scales
//! steadiness  how well a drone holds its pose, and what that makes of the scale
//! sun         where the sun stands, and what lies in shadow
//! cover       how much photos share, and the widest gap that they leave
//! way         in which order, with which climbs
//! mission/    what a drone is told, and what came of it
//! ```
//!
//! A plan is in the unit and the frame of its surface. It is made in two looks at the ground: the terrain's raster
//! decides where photos lie and how far they are taken from, because that takes many tries; the true triangles then
//! say what each photo will show, and whoever reads the plan is told those numbers only.
//!
//! This room stands on floor 3: it casts scale fields (floor 2) over areas (`survey`, floor 2).

mod area;
mod cover;
mod drones;
mod forecast;
mod keep_out;
mod mission;
mod patterns;
mod photo;
mod steadiness;
mod sun;
mod terrain;
#[cfg(test)]
mod tests;
mod way;
mod wish;

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, DVec3};
use rayon::prelude::*;

pub use area::pile;
pub use cover::Cover;
pub use drones::Drone;
pub use forecast::Forecast;
pub use mission::{
    Above, DroneCodes, Fence, Finish, Flown, Height, Mission, PayloadCodes, PhotoOf, PlannedPose,
    Residual, Stop, TakeOff, Taken, Told, heading, missions, planned_poses,
};
pub use patterns::Pattern;
pub use photo::{PlannedPhoto, Refused};
pub use steadiness::{PoseErrors, Positioning};
pub use sun::{Shadows, Sun};
pub use terrain::{GroundPlane, Terrain, ground_at};
pub use way::{MOST_SPEED, Pace, USUAL_SETTLE, USUAL_SPEED, Way, WayPoint};
pub use wish::{Size, USUAL_CLEARANCE, USUAL_OFF_NORMAL, USUAL_TILT, Wish};

use crate::camera::Camera;
use crate::fault::Fault;
use crate::geometry::extent;
use crate::jobs::Progress;
use crate::surface::Surface;
use crate::survey::Polygon;
use keep_out::KeepOut;
use patterns::{Ground, MOST};

/// Pixels of the terrain along the shorter side of a footprint.
const FINENESS: f64 = 24.0;
/// So many photos more than there are fill gaps at most.
const FILLING: u64 = 10;
/// Of a photo that shows so much of the surface nobody asks for the rest.
const NEARLY_ALL: f64 = 0.99;

/// Where to fly.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The photos, in the order in which they are flown.
    pub photos: Vec<PlannedPhoto>,
    /// Those that cannot be taken.
    pub refused: Vec<Refused>,
    /// What was to be photographed.
    pub area: Polygon,
    /// How well the photos cover it.
    pub cover: Cover,
    /// The surface as it was looked at.
    pub terrain: Terrain,
    /// What was asked for.
    pub wish: Wish,
    /// What is to fly.
    pub camera: Camera,
    /// A photo's width and height on a plane across its axis, from the distance that was asked for.
    pub footprint: DVec2,
}

impl Plan {
    /// Plans photos of an area.
    ///
    /// # Errors
    /// Where the wish makes no photos (a scale or an overlap that is none, an area off the surface), the surface
    /// cannot be triangulated, or the work was cancelled.
    pub fn new(
        surface: &Surface,
        camera: &Camera,
        area: Polygon,
        wish: Wish,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let distance = distance(camera, &wish)?;
        are_near(&wish.keep_out, surface, distance)?;
        is_not_too_many(camera, &area, &wish, distance)?;
        progress.stage("looking at the ground");
        let terrain = terrain_of(surface, camera, &area, (&wish, distance), progress)?;
        let ground = Ground::new((surface, &terrain), camera, &area, &wish, distance);
        let (mut photos, mut refused) = ground.photos();
        if photos.len() + refused.len() >= MOST {
            return Err(too_many());
        }
        (photos.par_iter_mut()).for_each(|photo| ground.set_distance(photo));
        let keep_out = KeepOut::new(&wish.keep_out, wish.clearance)?;
        photos.retain(|photo| match ground.not_flown(photo, &keep_out) {
            None => true,
            Some(why) => {
                let place = photo.target.truncate();
                refused.push(Refused { place, why });
                false
            }
        });
        if photos.is_empty() {
            return Err(none(&refused));
        }
        // In the order in which they are flown, so that a table is read beside the drone.
        let places: Vec<DVec3> = photos.iter().map(|photo| photo.pose.center).collect();
        let begin = match wish.take_off {
            Some(place) => place.extend(places[0].z),
            None => places[0],
        };
        let mut photos: Vec<PlannedPhoto> = (way::order(begin, &places).into_iter())
            .map(|photo| photos[photo].clone())
            .collect();
        for (photo, number) in photos.iter_mut().zip(1..) {
            photo.name = photo_name(number);
        }
        progress.stage("what each photo will show");
        let count = photos.len() as u64;
        let done = AtomicU64::new(0);
        (photos.par_iter_mut()).try_for_each(|photo| {
            progress.advance(done.fetch_add(1, Ordering::Relaxed), count)?;
            // Its own stages would come between.
            ground.foresee(photo, surface, &Progress::default())
        })?;
        let cover = Cover::of(&photos, camera, &area, &terrain);
        Ok(Self {
            photos,
            refused,
            cover,
            footprint: footprint(camera, distance),
            camera: camera.clone(),
            area,
            terrain,
            wish,
        })
    }

    /// The same plan with one photo that looks at another place, by the same rule of its pattern; of photos of one tilt
    /// it keeps its direction.
    ///
    /// # Errors
    /// Where no photo can be taken of that place, or the work was cancelled.
    pub fn with_photo_at(
        &self,
        photo: usize,
        place: DVec2,
        surface: &Surface,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let Some(before) = self.photos.get(photo) else {
            return Ok(self.clone());
        };
        let mut plan = self.clone();
        plan.photos[photo] = self.photo_of(place, before, surface, progress)?;
        plan.cover_again();
        Ok(plan)
    }

    /// The same plan with one photo more, where the way to it is shortest; of a pattern of one tilt it looks as the one
    /// next to it.
    ///
    /// # Errors
    /// Where no photo can be taken of that place, there are too many, or the work was cancelled.
    pub fn with_photo(
        &self,
        place: DVec2,
        surface: &Surface,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        if self.photos.len() >= MOST {
            return Err(too_many());
        }
        let away = |photo: &PlannedPhoto| photo.target.truncate().distance(place);
        let nearest = (self.photos.iter()).min_by(|a, b| away(a).total_cmp(&away(b)));
        let Some(nearest) = nearest else {
            return Ok(self.clone());
        };
        let mut photo = self.photo_of(place, nearest, surface, progress)?;
        let numbers = self
            .photos
            .iter()
            .filter_map(|photo| photo.name.get(1..)?.parse().ok());
        let number: usize = numbers.max().unwrap_or(0) + 1;
        photo.name = photo_name(number);
        let at = way::cheapest(
            &self
                .photos
                .iter()
                .map(|photo| photo.pose.center)
                .collect::<Vec<_>>(),
            photo.pose.center,
        );
        let mut plan = self.clone();
        plan.photos.insert(at, photo);
        plan.cover_again();
        Ok(plan)
    }

    /// The same plan with a photo more in the middle of the widest gap, again and again, as long as gaps are wider than was
    /// wished and each such photo shows more of the area. These photos share more with others than was wished; photos are
    /// named anew, in the order in which they are flown. A gap that cannot be photographed stays, and ends it.
    ///
    /// # Errors
    /// Where the work was cancelled.
    pub fn with_gaps_filled(&self, surface: &Surface, progress: &Progress) -> Result<Self, Fault> {
        progress.stage("filling gaps");
        let mut plan = self.clone();
        let most = self.photos.len() as u64 + FILLING;
        for done in 0..most {
            progress.advance(done, most)?;
            let Some(gap) = plan.cover.gap_at.filter(|_| plan.has_wide_gap()) else {
                break;
            };
            match plan.with_photo(gap, surface, &Progress::default()) {
                Ok(next) if next.cover.covered > plan.cover.covered => plan = next,
                _ => break,
            }
        }
        for (photo, number) in plan.photos.iter_mut().zip(1..) {
            photo.name = photo_name(number);
        }
        Ok(plan)
    }

    /// The same plan without a photo; the last one stays.
    #[must_use]
    pub fn without_photo(&self, photo: usize) -> Self {
        let mut plan = self.clone();
        if photo < plan.photos.len() && plan.photos.len() > 1 {
            plan.photos.remove(photo);
            plan.cover_again();
        }
        plan
    }

    /// Behind a change of its photos.
    fn cover_again(&mut self) {
        self.cover = Cover::of(&self.photos, &self.camera, &self.area, &self.terrain);
    }

    /// A photo of a place that looks as another one of the plan, and is called like it.
    fn photo_of(
        &self,
        place: DVec2,
        like: &PlannedPhoto,
        surface: &Surface,
        progress: &Progress,
    ) -> Result<PlannedPhoto, Fault> {
        let refuse = |why: String| {
            let what = format!("no photo at ({:.1}, {:.1}): {why}", place.x, place.y);
            Fault::new(what, "take one of another place")
        };
        let distance = distance(&self.camera, &self.wish)?;
        let terrain = (surface, &self.terrain);
        let ground = Ground::new(terrain, &self.camera, &self.area, &self.wish, distance);
        let mut photo = ground.photo_of(place, like).map_err(refuse)?;
        ground.set_distance(&mut photo);
        let keep_out = KeepOut::new(&self.wish.keep_out, self.wish.clearance)?;
        if let Some(why) = ground.not_flown(&photo, &keep_out) {
            return Err(refuse(why));
        }
        ground.foresee(&mut photo, surface, progress)?;
        photo.name.clone_from(&like.name);
        Ok(photo)
    }

    /// Whether the photos leave a wider gap than was asked for.
    pub fn has_wide_gap(&self) -> bool {
        self.cover.widest_gap > self.wish.gap * self.footprint.min_element()
    }

    /// What of the wish a photo does not hold, one clause each.
    pub fn troubles(&self, photo: usize) -> Vec<String> {
        let Some(photo) = self.photos.get(photo) else {
            return Vec::new();
        };
        let mut troubles = Vec::new();
        match (&photo.forecast, self.wish.size) {
            (None, _) => troubles.push("it shows nothing of the surface".to_owned()),
            (
                Some(forecast),
                Size::Scale {
                    pixels,
                    within: Some(within),
                },
            ) => {
                let [least, greatest] = forecast.bulk;
                let off = (greatest - pixels).max(pixels - least);
                if off > within {
                    let percent = off / pixels * 100.0;
                    troubles.push(format!(
                        "98 % of its scales are only within {percent:.0} % of the wished one"
                    ));
                }
            }
            _ => {}
        }
        if let Some(forecast) = &photo.forecast
            && forecast.covered < NEARLY_ALL
        {
            let share = (1.0 - forecast.covered) * 100.0;
            troubles.push(format!("{share:.0} % of it looks beyond the surface"));
        }
        if self.wish.pattern == Pattern::Slope && photo.off_normal > self.wish.off_normal {
            let off = photo.off_normal;
            troubles.push(format!("its axis is {off:.0} degrees off the normal"));
        }
        troubles
    }
}

/// What a photo of this number is called.
fn photo_name(number: usize) -> String {
    format!("P{number:03}")
}

/// How far along the axis the wish asks for.
fn distance(camera: &Camera, wish: &Wish) -> Result<f64, Fault> {
    let refuse = |what: &str, remedy: &str| Err(Fault::new(what, remedy));
    if !(0.0..0.98).contains(&wish.overlap) {
        return refuse(
            "the overlap is not from 0 to 98 %",
            "give one, as --overlap 70",
        );
    }
    if !(5.0..=90.0).contains(&wish.tilt) {
        return refuse(
            "the tilt is not from 5 to 90 degrees",
            "90 looks straight down",
        );
    }
    let distance = match wish.size {
        Size::Scale { pixels, .. } => (camera.fx * camera.fy).sqrt() / pixels,
        Size::Distance(distance) => distance,
    };
    if !(distance > 0.0 && distance.is_finite()) {
        return refuse(
            "the scale or height is no positive number",
            "give one, as --scale '20 px/cm'",
        );
    }
    Ok(distance)
}

fn none(refused: &[Refused]) -> Fault {
    let what = match refused.first() {
        None => "no photo of the area can be planned".to_owned(),
        Some(first) => format!("no photo of the area can be taken: {}", first.why),
    };
    Fault::new(what, "try another scale, another area, or another drone")
}

/// An area to keep out of that lies elsewhere protects nobody: its coordinates are wrong.
fn are_near(keep_out: &[Polygon], surface: &Surface, distance: f64) -> Result<(), Fault> {
    let bounds = surface.bounds();
    let around = bounds.size().truncate().max_element() + distance;
    for (area, number) in keep_out.iter().zip(1..) {
        let [min, max] = extent(area.corners());
        let is_near = max.cmpge(bounds.min.truncate() - around).all()
            && min.cmple(bounds.max.truncate() + around).all();
        if !is_near {
            let middle = (min + max) / 2.0;
            let what = format!(
                "area {number} to keep out of is nowhere near the surface: it lies around ({:.1}, {:.1})",
                middle.x, middle.y
            );
            let remedy = "check its coordinates, and in a file of a map that longitudes come first";
            return Err(Fault::new(what, remedy));
        }
    }
    Ok(())
}

fn too_many() -> Fault {
    let what = format!("the plan has more than {MOST} photos");
    Fault::new(what, "take photos from farther away, or of a smaller area")
}

/// Before the ground is looked at in their fineness.
fn is_not_too_many(
    camera: &Camera,
    area: &Polygon,
    wish: &Wish,
    distance: f64,
) -> Result<(), Fault> {
    let step = footprint(camera, distance) * (1.0 - wish.overlap);
    let count = area.area() / (step.x * step.y);
    if count < MOST as f64 {
        Ok(())
    } else {
        Err(too_many())
    }
}

/// A photo's width and height on a plane across its axis at a distance.
fn footprint(camera: &Camera, distance: f64) -> DVec2 {
    let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    size / DVec2::new(camera.fx, camera.fy) * distance
}

/// The terrain under an area and around it, as far as photos of it may look, and as far as the take-off.
fn terrain_of(
    surface: &Surface,
    camera: &Camera,
    area: &Polygon,
    (wish, distance): (&Wish, f64),
    progress: &Progress,
) -> Result<Terrain, Fault> {
    let footprint = footprint(camera, distance);
    let [min, max] = extent(area.corners());
    let around = footprint.max_element() + distance;
    let (mut min, mut max) = (min - around, max + around);
    if let Some(place) = wish.take_off {
        min = min.min(place - wish.clearance);
        max = max.max(place + wish.clearance);
    }
    let bounds = surface.bounds();
    let (min, max) = (
        min.max(bounds.min.truncate()),
        max.min(bounds.max.truncate()),
    );
    if !min.cmplt(max).all() {
        let what = "the area lies off the surface";
        return Err(Fault::new(
            what,
            "give its corners in the surface's coordinates",
        ));
    }
    let pixel = footprint.min_element() / FINENESS;
    Terrain::of(surface, [min, max], pixel, progress)
}

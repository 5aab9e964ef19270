//! Where to fly, so that the photos are good before they are flown: a plan against the true surface, what each
//! photo will show, and the mission that a drone is told.
//!
//! ```text
//! wish/       what is asked for: scale, pattern, gaps, gimbal, clearance; what is usual; what a flight's file keeps of it
//! tiles       heights in tiles, which are kept
//! terrain     heights on a raster, planes of the ground, how near a point in the air is to it
//! drones      cameras and gimbals that are often flown
//! area        the ground to be photographed: the pile found by itself
//! keep_out    the ground that is not flown over, and the way around it
//! known       which ground a plan needs, and what a plan before it knows
//! photo       a planned photo
//! patterns    where photos are taken from: slope, paper, survey, or two of them in one flight
//! forecast    what a photo will show: its field of scales
//! steadiness  how well a drone holds its pose, and what that makes of the scale
//! sun         where the sun stands, and what lies in shadow
//! cover       how much photos share, and the widest gap that they leave
//! home        the straight way home that the drone flies by itself
//! way         the legs between photos, with which climbs; how long they take
//! order       in which order photos are taken
//! mission/    what a drone is told, what of it lies beyond the surface, and what came of it
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
mod home;
mod keep_out;
mod known;
mod mission;
mod order;
mod patterns;
mod photo;
mod steadiness;
mod sun;
mod terrain;
#[cfg(test)]
mod tests;
mod tiles;
mod way;
mod wish;

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, DVec3};
use rayon::prelude::*;

pub use area::{heights_in_and_about, heights_in_words, lying, pile};
pub use cover::Cover;
pub use drones::Drone;
pub use forecast::Forecast;
pub use home::{homes_over_keep_out, lost_signal, return_height, set_height};
pub use mission::{
    Above, Beyond, DroneCodes, Fence, Finish, Flown, Height, LostSignal, Mission, PayloadCodes,
    PhotoOf, PlannedPose, Residual, Stop, TakeOff, Taken, Told, heading, is_over_ground, missions,
    planned_poses,
};
pub use photo::{PlannedPhoto, Purpose, Refused};
pub use steadiness::{PoseErrors, Positioning};
pub use sun::{Shadows, Sun};
pub use terrain::{GroundPlane, Terrain, ground_at};
pub use way::{
    Flying, MOST_SPEED, Pace, USUAL_CLIMB, USUAL_DESCENT, USUAL_SETTLE, USUAL_SPEED, Way, WayPoint,
};
pub use wish::{
    AskedPlan, Edit, Pattern, PhotoAt, Size, SurveyWish, USUAL_CLEARANCE, USUAL_OFF_NORMAL,
    USUAL_SURVEY_OVERLAP, USUAL_TILT, Wish,
};

use crate::camera::Camera;
use crate::fault::Fault;
use crate::geometry::{Bounds, extent};
use crate::jobs::Progress;
use crate::numbers::apart;
use crate::surface::Surface;
use crate::survey::Polygon;
use keep_out::KeepOut;
use known::{Known, Need};
use patterns::{Ground, MOST};

/// So many photos more than there are fill gaps at most.
const FILLING: u64 = 10;
/// What is wrong with a photo of nothing.
const NOTHING: &str = "it shows nothing of the surface";
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
    /// The surface as the plan needs it.
    pub terrain: Terrain,

    /// What was asked for.
    pub wish: Wish,
    /// What is to fly.
    pub camera: Camera,
    /// A photo's width and height on a plane across its axis, from the distance that was asked for: of photos for scales,
    /// where there are some.
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
        Self::after(None, (surface, camera), area, wish, progress)
    }

    /// The same behind another plan over the same surface: what that knows of the ground, and of photos that stay where they
    /// were, is not looked at again. The answer is the same.
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub fn after(
        before: Option<&Self>,
        (surface, camera): (&Surface, &Camera),
        area: Polygon,
        wish: Wish,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        check(&wish)?;
        let mut distances = Vec::new();
        for purpose in wish.pattern.purposes() {
            distances.push(distance(camera, wish.size_of(*purpose))?);
        }
        let farthest = distances.iter().copied().fold(0.0, f64::max);
        let nearest = distances.iter().copied().fold(f64::MAX, f64::min);
        are_near(&wish.keep_out, surface, farthest)?;
        is_not_too_many(camera, &area, &wish)?;
        progress.stage("looking at the ground");
        let distances = [nearest, farthest];
        let need = Need::of(surface, camera, &area, (&wish, distances))?;
        let terrain = need.terrain(surface, before, progress)?;
        let keep_out = KeepOut::new(&wish.keep_out, wish.clearance)?;
        let over = (surface, &terrain);
        let mut grounds = Vec::new();
        for purpose in wish.pattern.purposes() {
            grounds.push(Ground::new(over, camera, &area, (&wish, *purpose))?);
        }
        let (mut photos, mut refused) = (Vec::new(), Vec::new());
        for ground in &grounds {
            let before = refused.len();
            let (mut own, not) = ground.photos();
            refused.extend(not);
            (own.par_iter_mut()).for_each(|photo| ground.set_distance(photo));
            own.retain(|photo| match ground.not_flown(photo, &keep_out) {
                None => true,
                Some(why) => {
                    let place = photo.target.truncate();
                    refused.push(Refused { place, why });
                    false
                }
            });
            // Half of what was asked for is another plan.
            if own.is_empty() {
                return Err(none(ground.what(), &refused[before..], surface));
            }
            photos.extend(own);
            if photos.len() + refused.len() >= MOST {
                return Err(too_many());
            }
        }
        let footprint = footprint(camera, distance(camera, wish.size_of(wish.pattern.main()))?);
        // In the order in which they are flown, so that a table is read beside the drone.
        let mut photos: Vec<PlannedPhoto> =
            (order::order(wish.take_off, &photos, footprint.max_element()).into_iter())
                .map(|photo| photos[photo].clone())
                .collect();
        name_in_order(&mut photos);
        progress.stage("what each photo will show");
        let count = photos.len() as u64;
        let done = AtomicU64::new(0);
        let known_photos = Known::of(before, camera, &wish, &terrain);
        (photos.par_iter_mut()).try_for_each(|photo| {
            if known_photos.say(photo) {
                return Ok(());
            }
            progress.advance(done.fetch_add(1, Ordering::Relaxed), count)?;
            let own = grounds.iter().find(|ground| ground.is_for(photo));
            // Its own stages would come between.
            own.map_or(Ok(()), |own| {
                own.foresee(photo, surface, &Progress::default())
            })
        })?;
        let cover = Cover::of((&photos, wish.survey.overlap), camera, &area, &terrain);
        Ok(Self {
            photos,
            refused,
            cover,
            footprint,
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
    /// next to it. Of a pattern with photos for scales it is one of these.
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
        let main = self.wish.pattern.main();
        let nearest = (self.photos.iter())
            .filter(|photo| photo.purpose == main)
            .min_by(|a, b| away(a).total_cmp(&away(b)));
        let Some(nearest) = nearest else {
            return Ok(self.clone());
        };
        let mut photo = self.photo_of(place, nearest, surface, progress)?;
        let numbers = self
            .photos
            .iter()
            .filter_map(|photo| photo.name.get(1..)?.parse().ok());
        let number: usize = numbers.max().unwrap_or(0) + 1;
        photo.name = photo.purpose.photo_name(number);
        let at = order::cheapest(
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
        name_in_order(&mut plan.photos);
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
        self.cover = Cover::of(
            (&self.photos, self.wish.survey.overlap),
            &self.camera,
            &self.area,
            &self.terrain,
        );
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
        let terrain = (surface, &self.terrain);
        let wish = (&self.wish, like.purpose);
        let ground = Ground::new(terrain, &self.camera, &self.area, wish)?;
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

    /// What of the wish a photo does not hold, one clause each. Photos of a survey are held to what they share, all
    /// together ([`Cover::surveyed`]).
    pub fn troubles(&self, photo: usize) -> Vec<String> {
        let Some(photo) = self.photos.get(photo) else {
            return Vec::new();
        };
        let mut troubles = Vec::new();
        if photo.purpose == Purpose::Survey {
            if photo.forecast.is_none() {
                troubles.push(NOTHING.to_owned());
            }
            return troubles;
        }
        match (&photo.forecast, self.wish.size) {
            (None, _) => troubles.push(NOTHING.to_owned()),
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
                    let [off, within] = [off, within].map(|scale| scale / pixels * 100.0);
                    let (off, within) = apart(off, within, 0);
                    troubles.push(format!(
                        "98 % of its scales are only within {off} % of the wished one, not {within} %"
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
        if self.wish.pattern.is_square() && photo.off_normal > self.wish.off_normal {
            let (off, most) = apart(photo.off_normal, self.wish.off_normal, 0);
            troubles.push(format!(
                "its axis is {off} degrees off the normal, more than {most}"
            ));
        }
        troubles
    }
}

/// Names photos by their places in the flight.
fn name_in_order(photos: &mut [PlannedPhoto]) {
    for (photo, number) in photos.iter_mut().zip(1..) {
        photo.name = photo.purpose.photo_name(number);
    }
}

/// What no photo can be planned by.
fn check(wish: &Wish) -> Result<(), Fault> {
    for purpose in wish.pattern.purposes() {
        if !(0.0..0.98).contains(&wish.overlap_of(*purpose)) {
            let (what, remedy) = match purpose {
                Purpose::Scale => (
                    "the overlap is not from 0 to 98 %",
                    "give one, as --overlap 20",
                ),
                Purpose::Survey => (
                    "the survey's overlap is not from 0 to 98 %",
                    "give one, as --survey-overlap 70",
                ),
            };
            return Err(Fault::new(what, remedy));
        }
    }
    if !(5.0..=90.0).contains(&wish.tilt) {
        let what = "the tilt is not from 5 to 90 degrees";
        return Err(Fault::new(what, "90 looks straight down"));
    }
    Ok(())
}

/// How far along the axis the rock is as large as is wished.
fn distance(camera: &Camera, size: Size) -> Result<f64, Fault> {
    let distance = match size {
        Size::Scale { pixels, .. } => (camera.fx * camera.fy).sqrt() / pixels,
        Size::Distance(distance) => distance,
    };
    if distance > 0.0 && distance.is_finite() {
        return Ok(distance);
    }
    let what = "the scale or height is no positive number";
    Err(Fault::new(what, "give one, as --scale '20 px/cm'"))
}

fn none(what: &str, refused: &[Refused], surface: &Surface) -> Fault {
    let mut what = match refused.first() {
        None => format!("no photo of {what} can be planned"),
        Some(first) => format!("no photo of {what} can be taken: {}", first.why),
    };
    if let Some(words) = lying(surface) {
        what += &format!("; {words}");
    }
    Fault::new(what, "try another scale, area, drone or clearance")
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
            let what = format!("area {number} to keep out of is nowhere near the surface");
            return Err(elsewhere(&what, (min + max) / 2.0, surface));
        }
    }
    Ok(())
}

/// What does not lie on a surface, or near it: its own coordinates are wrong, and the surface's tell how.
fn elsewhere(what: &str, place: DVec2, surface: &Surface) -> Fault {
    let Bounds { min, max } = surface.bounds();
    let [low, high] = [min, max].map(DVec3::truncate);
    if place.cmpge(low).all() && place.cmple(high).all() {
        let what = format!(
            "{what}: at ({:.1}, {:.1}) it has a hole, or ends before, though its bounds reach farther",
            place.x, place.y
        );
        return Fault::new(
            what,
            "give a place where it has points, or a surface that reaches there",
        );
    }
    let what = format!(
        "{what}: it lies around ({:.1}, {:.1}), the surface at x {:.1} to {:.1}, y {:.1} to {:.1}",
        place.x, place.y, min.x, max.x, min.y, max.y
    );
    let remedy = "give its coordinates in the surface's system, x before y; in a file of a map longitudes come first";
    Fault::new(what, remedy)
}

fn too_many() -> Fault {
    let what = format!("the plan has more than {MOST} photos");
    Fault::new(what, "take photos from farther away, or of a smaller area")
}

/// Before the ground is looked at in their fineness.
fn is_not_too_many(camera: &Camera, area: &Polygon, wish: &Wish) -> Result<(), Fault> {
    let mut count = 0.0;
    for purpose in wish.pattern.purposes() {
        let distance = distance(camera, wish.size_of(*purpose))?;
        let step = footprint(camera, distance) * (1.0 - wish.overlap_of(*purpose));
        count += area.area() / (step.x * step.y);
    }
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

//! Where to fly, so that the photos are good before they are flown: a plan against the true surface, what each
//! photo will show, and the mission that a drone is told.
//!
//! ```text
//! wish       what is asked for: scale, pattern, gaps, gimbal, clearance
//! terrain    heights on a raster, planes of the ground, how near a point in the air is to it
//! drones     cameras and gimbals that are often flown
//! area       the ground to be photographed: the pile found by itself
//! patterns   where photos are taken from: slope, paper, survey
//! forecast   what a photo will show: its field of scales
//! cover      how much photos share, and the widest gap that they leave
//! way        in which order, with which climbs
//! told       the way as a mission, in degrees and metres above take-off
//! flown      planned against flown
//! mission    take-off, stops with the camera's direction, what happens at the end
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
mod flown;
mod forecast;
mod mission;
mod patterns;
mod terrain;
#[cfg(test)]
mod tests;
mod told;
mod way;
mod wish;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

pub use area::pile;
pub use cover::Cover;
pub use drones::Drone;
pub use flown::{Flown, PlannedPose, Residual, Taken, planned_poses};
pub use forecast::Forecast;
pub use mission::{
    Above, DroneCodes, Fence, Finish, Height, Mission, PayloadCodes, PhotoOf, Stop, TakeOff,
    heading,
};
pub use patterns::Pattern;
pub use terrain::{GroundPlane, Terrain, ground_at};
pub use told::{Told, mission};
pub use way::{Pace, Way, WayPoint};
pub use wish::{Size, Wish};

use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::geometry::extent;
use crate::jobs::Progress;
use crate::surface::Surface;
use crate::survey::Polygon;
use patterns::{Ground, MOST};

/// Pixels of the terrain along the shorter side of a footprint.
const FINENESS: f64 = 24.0;
/// Of a photo that shows so much of the surface nobody asks for the rest.
const NEARLY_ALL: f64 = 0.99;
/// How often the distance of a photo is set so that its scales lie around the wished one.
const ROUNDS: usize = 3;

/// A photo that is to be taken.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPhoto {
    /// Its place in the plan: P001, P002, …
    pub name: String,
    /// Where from, in the world.
    pub pose: Pose,
    /// The axis below the horizon, degrees: 90 straight down.
    pub tilt: f64,
    /// Where it looks, degrees clockwise from world +y, 0 to under 360.
    pub pan: f64,
    /// What its middle shows, on the ground as it is smoothed over a footprint.
    pub target: DVec3,
    /// From there to the camera, along the axis.
    pub distance: f64,
    /// The angle between its axis and the normal of the ground, degrees.
    pub off_normal: f64,
    /// Nothing farther than this from its target along x or y is in it.
    pub reach: f64,
    /// What it will show; `None` where that is nothing of the surface.
    pub forecast: Option<Forecast>,
}

impl PlannedPhoto {
    /// The terrain's points inside its image, in the world and in camera axes; what hides behind others, too.
    fn sees<'a>(
        &'a self,
        camera: &'a Camera,
        terrain: &'a Terrain,
    ) -> impl Iterator<Item = (DVec3, DVec3)> + 'a {
        let points = terrain.around(self.target.truncate(), self.reach);
        points.filter_map(|point| {
            let in_camera = self.pose.camera_from_world(point);
            let pixel = camera.pixel_undistorted(in_camera)?;
            camera.contains(pixel).then_some((point, in_camera))
        })
    }
}

/// A photo that cannot be taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Refused {
    /// What it was to show.
    pub place: DVec2,
    /// Why, one clause.
    pub why: String,
}

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
        is_not_too_many(camera, &area, &wish, distance)?;
        progress.stage("looking at the ground");
        let terrain = terrain_of(surface, camera, &area, (&wish, distance), progress)?;
        // Pixels are looked at in their middles; the highest place of a slope is at a corner.
        let corners = area.corners().iter();
        let highest = corners.filter_map(|corner| ground_at(surface, *corner));
        let ground = Ground {
            highest_corner: highest.reduce(f64::max),
            camera,
            area: &area,
            terrain: &terrain,
            wish: &wish,
            distance,
        };
        let (mut photos, mut refused) = ground.photos();
        if photos.len() + refused.len() >= MOST {
            return Err(too_many());
        }
        if wish.pattern == Pattern::Slope
            && let Size::Scale { pixels, .. } = wish.size
        {
            photos
                .par_iter_mut()
                .for_each(|photo| set_distance(photo, camera, &terrain, pixels));
        }
        photos.retain(|photo| {
            let is_near = terrain.is_near(photo.pose.center, wish.clearance);
            if is_near {
                let why = "the drone would come nearer to the ground than the clearance".to_owned();
                let place = photo.target.truncate();
                refused.push(Refused { place, why });
            }
            !is_near
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
            photo.name = format!("P{number:03}");
        }
        progress.stage("what each photo will show");
        let count = photos.len() as u64;
        for (photo, done) in photos.iter_mut().zip(0..) {
            progress.advance(done, count)?;
            photo.forecast = Forecast::of(camera, &photo.pose, surface, progress)?;
        }
        let cover = Cover::of(&photos, camera, &area, &terrain);
        Ok(Self {
            photos,
            refused,
            area,
            cover,
            terrain,
            footprint: footprint(camera, distance),
            wish,
        })
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
                        "scales are up to {percent:.0} % off the wished one"
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

/// Moves a photo along its axis until the middle of the bulk of its scales is the wished one, by the
/// terrain's raster.
fn set_distance(photo: &mut PlannedPhoto, camera: &Camera, terrain: &Terrain, pixels: f64) {
    let focal = (camera.fx * camera.fy).sqrt();
    let away = (photo.pose.center - photo.target) / photo.distance;
    for _ in 0..ROUNDS {
        let seen = photo.sees(camera, terrain);
        let mut scales: Vec<f64> = seen.map(|(_, in_camera)| focal / in_camera.z).collect();
        let Some([least, greatest]) = forecast::bulk_of(&mut scales) else {
            return;
        };
        // Both ends move alike, nearly: a few rounds do.
        let middle = (least + greatest) / 2.0;
        photo.distance *= middle / pixels;
        photo.pose.center = photo.target + away * photo.distance;
    }
}

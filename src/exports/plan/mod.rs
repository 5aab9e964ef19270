//! The flight as a plan, seen from straight above in its own coordinates: the surface's hillshade, where
//! every photo lies with its verdict, and where it was taken from. The window shows it, a report takes it
//! along: on a page (SVG, PDF, PNG), or as pixels that map programs put in their place (GeoTIFF).
//!
//! ```text
//! extent    what a plan holds
//! frame     which part of the map is drawn where
//! ground    what lies under everything: hillshade, photos, colours, nothing
//! grid      lines at round coordinates
//! inks      colours and dashes of verdicts
//! clip      outlines within a frame
//! photos    footprints, cameras and names, drawn
//! furniture grid lines, coordinates, north and bar of a printed map
//! page      the whole of it on A4, with title and legend
//! geotiff   pixels with their place on the Earth
//! format    which of them a file's name asks for
//! ```
//!
//! Nothing in it knows the window.

pub(crate) mod clip;
mod extent;
mod format;
mod frame;
pub(crate) mod furniture;
mod geotiff;
mod grid;
mod ground;
pub(crate) mod inks;
mod page;
pub(crate) mod photos;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::DVec2;
use image::RgbaImage;

pub use format::PlanFormat;
pub use frame::MapFrame;
pub use grid::{Grid, GridLine};
pub use ground::{GroundOf, PhotoPixels, PlanGround, ground};
pub use inks::PlanInks;
pub(crate) use page::ground as ground_shape;
pub use photos::RoomForNames;

use crate::fault::Fault;
use crate::flight::{Date, Review, Verdict};
use crate::geo_tags::{crs_in_words, projected};
use crate::geodesy::is_stated;
use crate::jobs::Progress;
use crate::numbers::{round_down, round_near};
use crate::surface::{Light, MapRaster};
use crate::units::{LengthUnit, in_words, round_length_in_words};

/// The most pixels of the ground: 160 MB of colours, and twice as much of heights.
pub const MOST_MAP_PIXELS: u64 = 40_000_000;

/// About how many pixels the longer side of the ground has if nobody says.
const SIDE: f64 = 1300.0;

/// What is not in the review, or can be chosen.
#[derive(Debug, Clone, Copy, Default)]
pub struct PlanRequest<'a> {
    /// The side of a pixel of the ground, world units; `None` for about 1300 of them along the longer side, twice
    /// as many of photos.
    pub pixel: Option<f64>,
    /// What the ground is.
    pub ground: PlanGround,
    /// The coordinate system of the world: "EPSG:n" or WKT.
    pub crs: Option<&'a str>,
    /// When the photos were taken, in words, where they say it.
    pub taken: Option<&'a str>,
}

/// The days of "YYYY:MM:DD HH:MM:SS", as EXIF writes times: "2024-05-06" or "2024-05-06 to 2024-05-07"; `None`
/// where none is a day of the calendar.
pub fn taken_in_words<'a>(times: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let day = |time: &str| time.get(..10)?.replace(':', "-").parse::<Date>().ok();
    let days: Vec<Date> = times.into_iter().filter_map(day).collect();
    let (first, last) = (days.iter().min()?, days.iter().max()?);
    Some(match first == last {
        true => first.to_string(),
        false => format!("{first} to {last}"),
    })
}

/// A flight as a plan. Coordinates are x and y of the world.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The flight's name.
    pub flight: String,
    /// The coordinate system: "EPSG:n" or WKT; `None` in a frame of its own.
    pub crs: Option<String>,
    /// When the photos were taken.
    pub taken: Option<String>,
    /// Of the coordinates.
    pub unit: LengthUnit,
    /// Whether somebody says that it is this unit.
    pub unit_known: bool,
    /// Least and greatest coordinates of what the plan holds.
    pub extent: [DVec2; 2],
    /// Where the ground's pixels lie.
    pub raster: MapRaster,
    /// The ground, transparent where there is no surface.
    pub ground: Arc<RgbaImage>,
    /// What it is.
    pub ground_kind: PlanGround,
    /// Which photos should be on the ground and are not, and why.
    pub warnings: Vec<String>,
    /// The light on it.
    pub light: Light,
    /// In the order of the flight.
    pub photos: Vec<PlanPhoto>,
    /// Lines and polygons that were measured.
    pub measured: Vec<MeasuredOutline>,
}

/// What was measured on the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredOutline {
    /// Its corners, in their order.
    pub points: Vec<DVec2>,
    /// Whether it is a polygon, whose last corner is joined to the first; else a line.
    pub is_polygon: bool,
}

/// A scale bar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanBar {
    /// In its unit.
    pub length: f64,
    /// That unit; `None` where nobody knows the world's.
    pub unit: Option<LengthUnit>,
    /// Units of the drawing.
    pub long: f64,
}

impl PlanBar {
    /// What is written at it.
    pub fn words(&self) -> String {
        match self.unit {
            Some(unit) => round_length_in_words(self.length, unit),
            None => format!("{} {}", self.length, in_words(None)),
        }
    }
}

/// A photo on the plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanPhoto {
    /// Its name.
    pub name: String,
    /// `None` while it is not settled.
    pub verdict: Option<Verdict>,
    /// The outline of what it shows, closed; empty where it shows nothing.
    pub outline: Vec<DVec2>,
    /// What its middle shows.
    pub middle: Option<DVec2>,
    /// Where the camera stood.
    pub camera: DVec2,
}

impl Plan {
    /// The plan of a reviewed flight; footprints are on it once the review has looked at them. `photos` reads the
    /// photos' pixels, for a ground of photos.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, the ground would have more than [`MOST_MAP_PIXELS`], there is
    /// nothing that the ground is asked to be of, or the work was cancelled.
    pub fn new(
        review: &Review,
        request: PlanRequest<'_>,
        photos: PhotoPixels<'_>,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let parts = review.flight().parts();
        let plan_photos = Self::photos_of(review);
        let extent = extent::of(&parts.surface.bulk_bounds(), &plan_photos);
        let longest = (extent[1] - extent[0]).max_element();
        let pixel = match request.pixel {
            Some(pixel) => pixel,
            None => {
                let finer = if request.ground == PlanGround::Photos {
                    2.0
                } else {
                    1.0
                };
                round_near(longest / SIDE / finer).unwrap_or(1.0)
            }
        };
        let raster = MapRaster::over(extent, pixel, MOST_MAP_PIXELS)?;
        let light = Light::default();
        let of = GroundOf {
            review,
            photos,
            kind: request.ground,
            light,
        };
        let (ground, warnings) = ground(&of, &raster, progress)?;
        Ok(Self {
            flight: parts.name.clone(),
            crs: request.crs.filter(|crs| is_stated(crs)).map(str::to_owned),
            taken: request.taken.map(str::to_owned),
            unit: parts.unit,
            unit_known: parts.unit_known,
            extent,
            raster,
            ground: Arc::new(ground),
            ground_kind: request.ground,
            warnings,
            light,
            photos: plan_photos,
            measured: Vec::new(),
        })
    }

    /// The same plan with the photos of another review of the same surface: other verdicts cost no other ground.
    #[must_use]
    pub fn with_photos_of(&self, review: &Review) -> Self {
        Self {
            photos: Self::photos_of(review),
            ..self.clone()
        }
    }

    fn photos_of(review: &Review) -> Vec<PlanPhoto> {
        let views = review.views();
        let photos = review.photos().enumerate().map(|(index, photo)| {
            let view = views.and_then(|views| views.get(index)?.as_ref());
            let footprint = view.map(|view| &view.footprint);
            let points = footprint.iter().flat_map(|footprint| &footprint.outline);
            let points = points.filter_map(|point| Some(point.point()?.truncate()));
            let middle = footprint.and_then(|footprint| {
                let (columns, rows) = (footprint.columns, footprint.rows);
                let index = rows / 2 * (columns + 1) + columns / 2;
                Some(footprint.grid.get(index as usize)?.point()?.truncate())
            });
            PlanPhoto {
                name: photo.name().to_owned(),
                verdict: photo.settled(),
                outline: points.filter(|point| point.is_finite()).collect(),
                middle: middle.filter(|point| point.is_finite()),
                camera: photo.photo.pose.center.truncate(),
            }
        });
        photos.collect()
    }

    /// Whether the coordinates are those of a map, so that y is its north.
    pub fn is_on_map(&self) -> bool {
        projected(self.crs.as_deref()).is_some()
    }

    /// What to call the coordinate system: its code, the name that its WKT has, or that none is stated.
    pub fn crs_in_words(&self) -> String {
        crs_in_words(self.crs.as_deref())
    }

    /// What lengths on it are counted in, for people.
    pub fn unit_of_lengths(&self) -> &'static str {
        in_words(self.unit_known.then_some(self.unit))
    }

    /// A bar of a round length in `unit`, at most `longest` units of the drawing, where `scale` of them are a
    /// unit of the world. Where nobody knows the world's unit, the bar is in that.
    pub fn bar(&self, scale: f64, longest: f64, unit: LengthUnit) -> Option<PlanBar> {
        let unit = self.unit_known.then_some(unit);
        let one = unit.map_or(1.0, |unit| unit.in_units_of(self.unit));
        let length = round_down(longest / (scale * one))?;
        Some(PlanBar {
            length,
            unit,
            long: length * one * scale,
        })
    }

    /// Photos, cameras and names of a part of the map as a picture without ground, with so many pixels to a
    /// unit of the frame; names only in their room.
    pub fn photos_picture(
        &self,
        frame: &MapFrame,
        room: &RoomForNames,
        inks: &PlanInks,
        pixels: f64,
    ) -> RgbaImage {
        let [width, height] = frame
            .size
            .map(|side| (side * pixels).round().max(1.0) as u32);
        let mut picture = RgbaImage::new(width, height);
        let mut pen = crate::drawing::Pen::default();
        photos::draw(self, frame, room, inks, &mut pen);
        crate::drawing::png::draw_all(&mut picture, &pen.shapes, pixels);
        picture
    }
}

//! What lies under everything on a plan.

use glam::DVec2;
use image::{Rgb, RgbImage, Rgba, RgbaImage};

use crate::fault::Fault;
use crate::flight::Review;
use crate::jobs::Progress;
use crate::picture::{Draping, PhotoAbove};
use crate::surface::{Light, MapRaster, hillshade};

/// Grey of the ground where no light falls on it, and what full light adds.
pub(super) const DARKEST: f64 = 60.0;
pub(super) const LIGHT: f64 = 190.0;

/// What the ground of a plan is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PlanGround {
    /// The surface's hillshade.
    #[default]
    Relief,
    /// The flight's photos, laid over the surface; hillshade where none shows it.
    Photos,
    /// The colours of the surface's own points; hillshade where it has none.
    Colours,
    /// Nothing.
    Plain,
}

impl PlanGround {
    /// All of them, in the order in which people are offered them.
    pub const ALL: [Self; 4] = [Self::Relief, Self::Photos, Self::Colours, Self::Plain];

    /// As the command line names it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Relief => "relief",
            Self::Photos => "photos",
            Self::Colours => "colours",
            Self::Plain => "plain",
        }
    }
}

/// Reads the pixels of a photo as shot by its place in the flight; `None` where its file is not there.
pub type PhotoPixels<'a> = &'a dyn Fn(usize) -> Option<Result<RgbImage, Fault>>;

/// What a ground is made of.
#[derive(Clone, Copy)]
pub struct GroundOf<'a> {
    /// The flight, with the footprints of its photos.
    pub review: &'a Review,
    /// Its photos' pixels.
    pub photos: PhotoPixels<'a>,
    /// What it shall be.
    pub kind: PlanGround,
    /// The light on its relief.
    pub light: Light,
}

/// The ground on a raster, transparent where there is no surface, and what could not be put on it.
///
/// # Errors
/// Where the surface cannot be triangulated or there is nothing to make the ground of, or the work was
/// cancelled.
pub fn ground(
    of: &GroundOf<'_>,
    raster: &MapRaster,
    progress: &Progress,
) -> Result<(RgbaImage, Vec<String>), Fault> {
    let surface = &of.review.flight().parts().surface;
    let mut ground = RgbaImage::new(raster.columns, raster.rows);
    if of.kind == PlanGround::Plain {
        return Ok((ground, Vec::new()));
    }
    if of.kind == PlanGround::Colours && surface.colors().is_empty() {
        let what = "the surface's points have no colours";
        return Err(Fault::new(what, "choose another ground: relief or photos"));
    }
    progress.stage("looking at the surface from above");
    let heights = surface.heights_from_above(raster, progress)?;
    progress.stage("lighting the surface");
    let shades = hillshade(raster, &heights, of.light);
    for (pixel, shade) in ground.pixels_mut().zip(&shades) {
        if !shade.is_nan() {
            // At most 250.
            let grey = (DARKEST + LIGHT * shade).round() as u8;
            *pixel = Rgba([grey, grey, grey, 255]);
        }
    }
    let mut warnings = Vec::new();
    match of.kind {
        PlanGround::Relief | PlanGround::Plain => {}
        PlanGround::Colours => {
            progress.stage("taking the colours of the points");
            let colours = surface.colours_from_above(raster, &heights, progress)?;
            for (pixel, colour) in ground.pixels_mut().zip(&colours) {
                if let Some([red, green, blue]) = *colour {
                    *pixel = Rgba([red, green, blue, 255]);
                }
            }
        }
        PlanGround::Photos => drape(of, raster, &heights, &mut ground, &mut warnings, progress)?,
    }
    Ok((ground, warnings))
}

/// Lays the photos over it: one after the other, for each is large.
fn drape(
    of: &GroundOf<'_>,
    raster: &MapRaster,
    heights: &[f64],
    ground: &mut RgbaImage,
    warnings: &mut Vec<String>,
    progress: &Progress,
) -> Result<(), Fault> {
    progress.stage("choosing a photo for each place");
    let review = of.review;
    let flight = review.flight();
    let views = review.views();
    let mut above: Vec<Option<PhotoAbove<'_>>> = Vec::new();
    for (index, photo) in flight.parts().photos.iter().enumerate() {
        let view = views.and_then(|views| views.get(index)?.as_ref());
        let outline = view.into_iter().flat_map(|view| &view.footprint.outline);
        let points = outline.filter_map(|point| Some(point.point()?.truncate()));
        let points: Vec<DVec2> = points.filter(|point| point.is_finite()).collect();
        let ends = (
            points.iter().copied().reduce(DVec2::min),
            points.iter().copied().reduce(DVec2::max),
        );
        above.push(match ends {
            (Some(low), Some(high)) => Some(PhotoAbove {
                camera: flight.camera(photo),
                pose: &photo.pose,
                shows: [low, high],
            }),
            _ => None,
        });
    }
    // A photo that cannot be read leaves its places to others: then it is chosen anew.
    let mut read_all = false;
    let mut missing = 0_usize;
    while !read_all {
        read_all = true;
        let draping = Draping::new(raster, heights, &above, progress)?;
        let photos = draping.photos();
        progress.stage("laying the photos over the surface");
        for (count, &index) in photos.iter().enumerate() {
            progress.advance(count as u64, photos.len() as u64)?;
            let Some(photo) = above[index] else {
                continue;
            };
            let read = (of.photos)(index);
            let colours = match read {
                None => Err(None),
                Some(Err(fault)) => Err(Some(fault)),
                Some(Ok(picture)) => draping.colours(index, &photo, &picture).map_err(Some),
            };
            match colours {
                Ok(colours) => put(ground, &colours),
                Err(why) => {
                    read_all = false;
                    above[index] = None;
                    match why {
                        None => missing += 1,
                        Some(fault) => {
                            let name = &flight.parts().photos[index].name;
                            warnings.push(format!("{name} is not on the ground: {}", fault.what));
                        }
                    }
                }
            }
        }
    }
    if above.iter().all(Option::is_none) {
        let what = "no photo's file can be laid over the surface";
        let remedy = "name the folder of the photos, or choose another ground: relief or colours";
        return Err(Fault::new(what, remedy));
    }
    if missing > 0 {
        warnings.push(format!(
            "{missing} photos are not on the ground: their files are not there"
        ));
    }
    Ok(())
}

fn put(ground: &mut RgbaImage, colours: &[(usize, [u8; 3])]) {
    let columns = ground.width() as usize;
    for (place, colour) in colours {
        let Rgb([red, green, blue]) = Rgb(*colour);
        let (column, row) = ((place % columns) as u32, (place / columns) as u32);
        ground.put_pixel(column, row, Rgba([red, green, blue, 255]));
    }
}

//! How the faces of a mesh lie over each other inside a polygon. Prisms under faces add up to a volume only where faces look
//! up and down in turn, from the top: a surface, or bodies whose faces look outwards. Tiles that overlap, faces that are
//! there twice and faces that are turned over make another sum, which nothing shows. Looked at on a raster, so shares are
//! good to about a thousandth.

use glam::DVec2;

use super::{Polygon, SurveyError};
use crate::geometry::surrounds;
use crate::jobs::Progress;
use crate::surface::{Face, MapRaster, Surface};

/// Pixels along the longer side of the polygon's box.
const ACROSS: f64 = 330.0;
/// Of the pixel: whose mesh stands on whole numbers has no edge in the middle of a pixel.
const ASIDE: DVec2 = DVec2::new(0.271_828, 0.314_159);
/// Of the polygon's pixels: more is no volume any more.
const MOST: f64 = 1e-2;
/// Less is what a raster sees of edges.
const LEAST: f64 = 1e-3;
/// Heights that are alike, of the span of heights: a body stands on the ground.
const ALIKE: f64 = 1e-7;

/// What the faces of a mesh are like.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Layers {
    /// Whether they are the other way round: most of those that are seen from above look down.
    pub(super) is_turned_over: bool,
    /// The share of the polygon, 0 to 1, in which as many look down as up: closed bodies, of which the own volume counts, or
    /// sheets with two sides.
    pub(super) closed: f64,
    /// The share in which faces lie over others that look up, too, or look down from the top: few, or it is refused.
    pub(super) doubtful: f64,
}

/// Of a surface inside a polygon; of a cloud none is like that.
///
/// # Errors
/// Where in a share that counts faces lie over others that look up, too, or look down from the top.
pub(super) fn layers(surface: &Surface, polygon: &Polygon) -> Result<Layers, SurveyError> {
    if surface.is_cloud() {
        return Ok(Layers::default());
    }
    let corners = polygon.corners();
    let (min, max) = corners.iter().fold(
        (DVec2::INFINITY, DVec2::NEG_INFINITY),
        |(min, max), corner| (min.min(*corner), max.max(*corner)),
    );
    let pixel = (max - min).max_element() / ACROSS;
    let corner = DVec2::new(min.x, max.y) - DVec2::new(1.0, -1.0) * ASIDE * pixel;
    // At most ACROSS and two.
    let count = |side: f64| (side / pixel).ceil() as u32 + 2;
    let raster = MapRaster {
        corner,
        pixel,
        columns: count(max.x - min.x),
        rows: count(max.y - min.y),
    };
    let mut pixels = surface
        .faces_from_above(&raster, &Progress::default())
        .map_err(|fault| SurveyError::Faces(fault.to_string()))?;
    let columns = raster.columns as usize;
    let is_inside = |place: usize| {
        let middle = DVec2::new((place % columns) as f64, (place / columns) as f64) + 0.5;
        surrounds(corners, raster.world_from_pixel(middle))
    };
    let mut inside: Vec<&mut Vec<Face>> = (pixels.iter_mut().enumerate())
        .filter_map(|(place, faces)| is_inside(place).then_some(faces))
        .collect();
    for faces in &mut inside {
        faces.sort_by(|a, b| b.height.total_cmp(&a.height));
    }
    let tops = inside.iter().filter_map(|faces| faces.first());
    let up = tops.clone().filter(|top| top.looks_up).count();
    let is_turned_over = 2 * up < tops.count();
    let alike = ALIKE * surface.bounds().size().z;
    let [mut twice, mut turned, mut closed] = [0_u64; 3];
    for faces in &inside {
        let [least, most, last] = counted(faces, is_turned_over, alike);
        twice += u64::from(most > 1);
        turned += u64::from(least < 0 && most <= 1);
        closed += u64::from(!faces.is_empty() && last == 0);
    }
    let share = |count: u64| count as f64 / inside.len().max(1) as f64;
    let [twice, turned, closed] = [twice, turned, closed].map(share);
    if twice > MOST {
        return Err(SurveyError::CountedTwice(100.0 * twice));
    }
    if turned > MOST {
        return Err(SurveyError::TurnedOver(100.0 * turned));
    }
    let [closed, doubtful] =
        [closed, twice + turned].map(|share| if share > LEAST { share } else { 0.0 });
    Ok(Layers {
        is_turned_over,
        closed,
        doubtful,
    })
}

/// Of faces from the top downwards, how many more look up than down: the least, the most, and at the bottom. Those at one
/// height count together.
fn counted(faces: &[Face], is_turned_over: bool, alike: f64) -> [i32; 3] {
    let [mut least, mut most, mut now] = [0; 3];
    for together in faces.chunk_by(|a, b| a.height - b.height <= alike) {
        for face in together {
            now += if face.looks_up == is_turned_over {
                -1
            } else {
                1
            };
        }
        least = least.min(now);
        most = most.max(now);
    }
    [least, most, now]
}

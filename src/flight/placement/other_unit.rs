//! Whether the photos count in another unit than the surface: then none of them sees it as it stands, and
//! all of them do where their positions are counted in the other unit.

use glam::{DVec2, DVec3};

use super::LOOKS;
use crate::flight::{Flight, Photo};
use crate::geometry::{Bounds, Ray};
use crate::scale::Sighting;
use crate::surface::Caster;
use crate::units::LengthUnit::{self, Centimetre, Foot, Inch, Metre, Millimetre};

/// Units that are taken for each other, the commonest first, in either order.
const TAKEN: [[LengthUnit; 2]; 5] = [
    [Metre, Millimetre],
    [Metre, Centimetre],
    [Metre, Foot],
    [Metre, Inch],
    [Foot, Millimetre],
];

/// Of a large flight so many photos tell.
const TELLING: usize = 50;

/// A photo with more looks than this that meet the surface sees it: one look alone may meet it from afar.
const MOST_BY_CHANCE: usize = 1;

/// So large a share of the looks of all photos meets the surface in the right unit. Photos at a rim look beyond it.
const SEEN: f64 = 0.8;

/// A surface that looks at least so wide in a photo, as a share of its longer side, is a small pile that the photo's looks pass by. One in
/// millimetres that are taken for metres, or the other way round, looks smaller, wherever the origin is.
const PILE: f64 = 0.04;

/// How wide a flight is over its surface, as a share: wider or less wide ones are no survey of it.
const LEAST_WIDE: f64 = 0.25;
const MOST_WIDE: f64 = 1.5;

impl Flight {
    /// The units of the poses and of the surface, where the two fit together only so. Of a surface of which only a part is in memory
    /// nothing is said: photos in other places than those that were taken would ask for blocks that no photo sees.
    pub(super) fn other_unit(&self, caster: &mut Caster<'_>) -> Option<[LengthUnit; 2]> {
        let parts = self.parts();
        if parts.surface.is_part() {
            return None;
        }
        let every = parts.photos.len().div_ceil(TELLING).max(1);
        let photos: Vec<&Photo> = parts.photos.iter().step_by(every).collect();
        // In most flights the first sees it, and nothing else is looked at.
        let mut each = photos.iter();
        if each.any(|photo| self.meeting(photo, 1.0, caster) > MOST_BY_CHANCE) {
            return None;
        }
        let wide = |bounds: Bounds| bounds.size().truncate().length();
        let centers: Vec<DVec3> = photos.iter().map(|photo| photo.pose.center).collect();
        let bounds = parts.surface.bounds();
        if parts
            .photos
            .iter()
            .any(|photo| self.shows_pile(photo, bounds))
        {
            return None;
        }
        let flown = wide(Bounds::of(&centers)?) / wide(bounds);
        let mut pairs = TAKEN.iter().flat_map(|[a, b]| [[*a, *b], [*b, *a]]);
        let found = pairs.find(|[poses, surface]| {
            let factor = poses.in_units_of(*surface);
            if !(LEAST_WIDE..=MOST_WIDE).contains(&(flown * factor)) {
                return false;
            }
            let met = photos
                .iter()
                .map(|photo| self.meeting(photo, factor, caster));
            let looks = photos.len() * LOOKS as usize * LOOKS as usize;
            met.sum::<usize>() as f64 >= SEEN * looks as f64
        })?;
        // Of a large flight over a small pile one that was passed over may see it.
        let mut all = parts.photos.iter();
        let is_seen = all.any(|photo| self.meeting(photo, 1.0, caster) > MOST_BY_CHANCE);
        (!is_seen).then_some(found)
    }

    /// Whether a photo looks at the middle of the surface's box, and the box is not too small there to be what it was taken of.
    fn shows_pile(&self, photo: &Photo, bounds: Bounds) -> bool {
        let (camera, image) = (self.camera(photo), self.parts().image);
        let seen = Sighting::in_frame(camera, &photo.pose, image, bounds.center());
        let longer_side = f64::from(camera.width.max(camera.height));
        let wide = bounds.size().truncate().length();
        seen.is_some_and(|seen| seen.scale * wide >= PILE * longer_side)
    }

    /// How many looks of a photo meet the surface, where its position is so many times itself.
    fn meeting(&self, photo: &Photo, factor: f64, caster: &mut Caster<'_>) -> usize {
        let origin = photo.pose.center * factor;
        let directions = self.looks(photo);
        let met = directions.filter(|&direction| caster.cast(&Ray { origin, direction }).is_some());
        met.count()
    }

    /// The directions in which a photo's pixels look that are looked at, evenly over it.
    pub(super) fn looks(&self, photo: &Photo) -> impl Iterator<Item = DVec3> {
        let (camera, image) = (self.camera(photo), self.parts().image);
        let along =
            |size: u32, place: u32| (f64::from(place) + 0.5) / f64::from(LOOKS) * f64::from(size);
        let places = (0..LOOKS).flat_map(|row| (0..LOOKS).map(move |column| (column, row)));
        places.filter_map(move |(column, row)| {
            let pixel = DVec2::new(along(camera.width, column), along(camera.height, row));
            Some(photo.pose.rotation * image.direction(camera, pixel).ok()?)
        })
    }
}

//! Small copies of photos, made while their features are found: what colours a model that grows is shown in.
//!
//! Of a run that goes on, photos whose features were kept are not read again, so what they alone show is grey; the
//! result has the colours of the photos themselves (`adjusted::model_files`).

use std::collections::HashMap;

use cumulus3d_core::{FeatureStore, TrackEntry};
use image::RgbImage;
use image::imageops::thumbnail;

/// The longer side of a copy, pixels: 75 kB a photo at most.
const SIDE: f64 = 160.0;

/// Where no photo is known that shows a point.
const UNKNOWN: [u8; 3] = [160; 3];

/// The copies, by cumulus3d's identifier of the photo.
#[derive(Default)]
pub(super) struct SmallPhotos(HashMap<u32, Small>);

struct Small {
    pixels: RgbImage,
    /// Its pixels over the photo's.
    share: f64,
}

impl SmallPhotos {
    /// Keeps a copy.
    pub(super) fn add(&mut self, image: u32, photo: &RgbImage) {
        let longer = photo.width().max(photo.height());
        let share = (SIDE / f64::from(longer)).min(1.0);
        let side = |pixels: u32| ((f64::from(pixels) * share) as u32).max(1);
        let pixels = thumbnail(photo, side(photo.width()), side(photo.height()));
        self.0.insert(image, Small { pixels, share });
    }

    /// The colours of points that are seen so; empty where no photo is known.
    pub(super) fn colors<'p>(
        &self,
        store: &FeatureStore,
        tracks: impl Iterator<Item = &'p [TrackEntry]>,
    ) -> Vec<[u8; 3]> {
        if self.0.is_empty() {
            return Vec::new();
        }
        let of_one = |entry: &TrackEntry| -> Option<[u8; 3]> {
            let small = self.0.get(&entry.image_id)?;
            let points = store.keypoints(entry.image_id)?;
            let at = points.get(entry.point2d_idx as usize)?;
            let place = |at: f32, most: u32| ((f64::from(at) * small.share) as u32).min(most - 1);
            let x = place(at.x, small.pixels.width());
            let y = place(at.y, small.pixels.height());
            Some(small.pixels.get_pixel(x, y).0)
        };
        tracks
            .map(|track| track.iter().find_map(of_one).unwrap_or(UNKNOWN))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use cumulus3d_core::Keypoint;
    use image::Rgb;

    use super::*;

    /// A photo whose left half is red and whose right half is blue, and another that is not known.
    #[test]
    fn a_point_has_the_colour_of_its_place() {
        let photo = RgbImage::from_fn(800, 600, |x, _| match x < 400 {
            true => Rgb([200, 0, 0]),
            false => Rgb([0, 0, 200]),
        });
        let mut small = SmallPhotos::default();
        let store = FeatureStore::new();
        let key = |x: f32, y: f32| Keypoint {
            x,
            y,
            ..Keypoint::default()
        };
        store.set_keypoints(7, vec![key(100.0, 599.9), key(799.9, 0.0)]);
        let entry = |image_id, point2d_idx| TrackEntry {
            image_id,
            point2d_idx,
        };
        let tracks = [vec![entry(8, 0), entry(7, 0)], vec![entry(7, 1)], vec![]];
        let colors = |small: &SmallPhotos| small.colors(&store, tracks.iter().map(Vec::as_slice));
        assert!(colors(&small).is_empty());
        small.add(7, &photo);
        assert_eq!(small.0[&7].pixels.dimensions(), (160, 120));
        assert_eq!(colors(&small), [[200, 0, 0], [0, 0, 200], UNKNOWN]);
    }
}

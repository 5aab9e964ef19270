//! The undistorted photo (contract, section 2, rule 6): the same K and size without the lens.

use glam::DVec2;
use image::RgbImage;
use rayon::prelude::*;

use super::pyramid::part::Part;
use super::reduce::{reduced_size, reduced_to};
use super::resample::cubic;
use super::warp::{CELL, Cell, bilinear};
use crate::camera::{Camera, Distortion};
use crate::labels::{LabelImage, NOT_ROCK};

/// The undistorted image of `photo`, at its camera's size or reduced so that no side is longer than
/// `max_side` (`u32::MAX` for the full size). Pixels that the photo does not show are black: beyond
/// its edges, and where the lens sees nothing.
///
/// The photo may itself be a reduced one of its camera's shape: it is stretched over the camera's
/// image.
pub fn undistorted(photo: &RgbImage, camera: &Camera, max_side: u32) -> RgbImage {
    let (width, height) = reduced_size(camera.width, camera.height, max_side);
    if photo.is_empty() || width == 0 || height == 0 {
        return RgbImage::new(width, height);
    }
    // What is looked at through fewer pixels is averaged first, or fine rock would turn to noise.
    let reduced;
    let photo = if width < photo.width() && height < photo.height() {
        reduced = reduced_to(photo, width, height);
        &reduced
    } else {
        photo
    };
    if camera.distortion == Distortion::None && photo.dimensions() == (width, height) {
        return photo.clone();
    }
    let whole = Part {
        x: 0,
        y: 0,
        width,
        height,
    };
    filled(photo, &Mapping::new(photo, camera, width, height), whole)
}

/// A part of the undistorted image at the size of `photo`, which may be a reduced one of its camera's
/// shape: a tile of what [`undistorted`] gives, but for the places between the corners of cells, which are
/// the same to 0.02 pixels.
pub fn undistorted_part(photo: &RgbImage, camera: &Camera, part: Part) -> RgbImage {
    let part = part.within(photo.dimensions());
    if camera.distortion == Distortion::None {
        return part.of(photo);
    }
    let (width, height) = photo.dimensions();
    filled(photo, &Mapping::new(photo, camera, width, height), part)
}

/// A part of the image that a mapping leads to.
fn filled(photo: &RgbImage, mapping: &Mapping<'_>, part: Part) -> RgbImage {
    let mut out = RgbImage::new(part.width, part.height);
    if photo.is_empty() || out.is_empty() {
        return out;
    }
    looked_up(&mut out, 3, mapping, part, |pixel, source| {
        if let Some(source) = source {
            pixel.copy_from_slice(&cubic(photo, source.x, source.y));
        }
    });
    out
}

/// The label image of the undistorted photo from that of the photo as it was shot: each pixel has the label of the pixel
/// that it comes from, and is no rock where the photo shows nothing.
pub fn undistorted_labels(labels: &LabelImage, camera: &Camera) -> LabelImage {
    let size = (labels.width as u32, labels.height as u32);
    if camera.distortion == Distortion::None || size != (camera.width, camera.height) {
        return labels.clone();
    }
    let whole = Part {
        x: 0,
        y: 0,
        width: camera.width,
        height: camera.height,
    };
    let mut out = vec![NOT_ROCK; labels.labels.len()];
    let mapping = Mapping::of_size(size, camera, camera.width, camera.height);
    looked_up(&mut out, 1, &mapping, whole, |label, source| {
        let Some(source) = source else {
            return;
        };
        // Places within the image, whose far sides belong to its last pixels.
        let column = (source.x as usize).min(labels.width - 1);
        let row = (source.y as usize).min(labels.height - 1);
        label.fill(labels.labels[row * labels.width + column]);
    });
    LabelImage {
        width: labels.width,
        height: labels.height,
        labels: out,
    }
}

/// Gives each pixel of a part, which is so many entries of `out`, the place in the photo that it comes from, where the
/// photo shows it.
fn looked_up<T: Send>(
    out: &mut [T],
    entries: usize,
    mapping: &Mapping<'_>,
    part: Part,
    each: impl Fn(&mut [T], Option<DVec2>) + Sync,
) {
    let width = part.width;
    out.par_chunks_mut((width * CELL) as usize * entries)
        .enumerate()
        .for_each(|(band, pixels)| {
            let row = band as u32 * CELL;
            for column in (0..width).step_by(CELL as usize) {
                let cell = mapping.cell(part.x + column, part.y + row);
                let columns = CELL.min(width - column) as usize;
                for (y, line) in pixels.chunks_mut(width as usize * entries).enumerate() {
                    let line = &mut line[column as usize * entries..][..columns * entries];
                    for (x, pixel) in line.chunks_exact_mut(entries).enumerate() {
                        // The centre of the pixel.
                        let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                        let source = match &cell {
                            Cell::Smooth(corners) => {
                                Some(bilinear(corners, centre / f64::from(CELL)))
                            }
                            Cell::Exact(origin) => mapping.source(*origin + centre),
                        };
                        each(pixel, source.filter(|source| mapping.shows(*source)));
                    }
                }
            }
        });
}

/// From pixels of the undistorted image to pixels of the photo.
struct Mapping<'a> {
    camera: &'a Camera,
    /// Camera pixels in a pixel of the undistorted image.
    camera_from_target: DVec2,
    /// Photo pixels in a camera pixel.
    photo_from_camera: DVec2,
    /// Of the photo.
    size: DVec2,
}

impl<'a> Mapping<'a> {
    fn new(photo: &RgbImage, camera: &'a Camera, width: u32, height: u32) -> Self {
        Self::of_size(photo.dimensions(), camera, width, height)
    }

    /// The same of a photo of a size.
    fn of_size(photo: (u32, u32), camera: &'a Camera, width: u32, height: u32) -> Self {
        let size = |width: u32, height: u32| DVec2::new(f64::from(width), f64::from(height));
        let of_camera = size(camera.width, camera.height);
        let of_photo = size(photo.0, photo.1);
        Self {
            camera,
            camera_from_target: of_camera / size(width, height),
            photo_from_camera: of_photo / of_camera,
            size: of_photo,
        }
    }

    /// The place in the photo of a place in the undistorted image, exactly.
    fn source(&self, target: DVec2) -> Option<DVec2> {
        let ray = self
            .camera
            .direction_undistorted(target * self.camera_from_target);
        Some(self.camera.pixel_as_shot(ray)? * self.photo_from_camera)
    }

    fn shows(&self, source: DVec2) -> bool {
        source.cmpge(DVec2::ZERO).all() && source.cmple(self.size).all()
    }

    /// The cell whose top left corner is there: smooth where the mapping is bilinear at the middles
    /// of its sides and of itself.
    fn cell(&self, column: u32, row: u32) -> Cell {
        let origin = DVec2::new(f64::from(column), f64::from(row));
        Cell::at(origin, |place| self.source(place))
    }
}

#[cfg(test)]
mod tests {
    use image::Rgb;

    use super::*;
    use crate::camera::{Brown, Fisheye};

    fn camera(distortion: Distortion) -> Camera {
        Camera {
            name: String::new(),
            width: 240,
            height: 160,
            fx: 180.0,
            fy: 176.0,
            cx: 122.5,
            cy: 78.25,
            skew: 0.5,
            distortion,
        }
    }

    /// Red is u, green is v (pixel centres at +0.5), blue marks the photo: a resampled pixel tells
    /// where it came from.
    fn coordinates(width: u32, height: u32) -> RgbImage {
        RgbImage::from_fn(width, height, |x, y| Rgb([x as u8, y as u8, 255]))
    }

    fn lenses() -> [Camera; 2] {
        let brown = Brown::new([-0.25, 0.08, 0.002, -0.001, 0.0, 0.0, 0.0, 0.0]);
        let fisheye = Fisheye::new([-0.02, 0.004, 0.0, 0.0]);
        [
            camera(Distortion::Brown(brown)),
            camera(Distortion::Fisheye(fisheye)),
        ]
    }

    #[test]
    fn without_distortion_nothing_changes() {
        let photo = coordinates(240, 160);
        assert_eq!(
            undistorted(&photo, &camera(Distortion::None), u32::MAX),
            photo
        );
    }

    /// Each pixel holds the coordinates that the camera's own forward model gives for its ray.
    #[test]
    fn pixels_come_from_where_the_lens_puts_them() {
        let photo = coordinates(240, 160);
        for camera in lenses() {
            let out = undistorted(&photo, &camera, u32::MAX);
            assert_eq!(out.dimensions(), (240, 160));
            let (mut seen, mut black) = (0, 0);
            let mut furthest: f64 = 0.0;
            for (x, y, pixel) in out.enumerate_pixels() {
                let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let source = camera
                    .pixel_as_shot(camera.direction_undistorted(centre))
                    .filter(|source| camera.contains(*source));
                // Near the edge the last pixels repeat, which is no ramp.
                let inside = |s: &DVec2| (2.0..238.0).contains(&s.x) && (2.0..158.0).contains(&s.y);
                match source {
                    Some(source) if inside(&source) => {
                        let told = DVec2::new(f64::from(pixel[0]), f64::from(pixel[1])) + 0.5;
                        // Rounded to whole colours, plus the mapping's 0.05 px.
                        assert!(
                            (told - source).abs().max_element() <= 0.55,
                            "{centre}: {told}, {source}"
                        );
                        furthest = furthest.max((source - centre).length());
                        seen += 1;
                    }
                    Some(_) => {}
                    None => {
                        assert_eq!(pixel.0, [0, 0, 0], "{centre}");
                        black += 1;
                    }
                }
            }
            assert!(seen > 20_000 && furthest > 5.0, "{seen}, {furthest}");
            assert!(black == 0, "these lenses pull the image inwards: {black}");
        }
    }

    /// Labels come from where the lens puts their pixels: the label of each pixel tells which it was.
    #[test]
    fn labels_come_from_where_the_lens_puts_them() {
        let labels = LabelImage {
            width: 240,
            height: 160,
            labels: (1..=240 * 160).collect(),
        };
        assert_eq!(
            undistorted_labels(&labels, &camera(Distortion::None)),
            labels
        );
        let outwards = camera(Distortion::Brown(Brown::new([
            0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
        ])));
        for camera in lenses().into_iter().chain([outwards]) {
            let out = undistorted_labels(&labels, &camera);
            let mut nothing = 0;
            for (place, label) in out.labels.iter().enumerate() {
                let centre = DVec2::new((place % 240) as f64 + 0.5, (place / 240) as f64 + 0.5);
                let source = camera.pixel_as_shot(camera.direction_undistorted(centre));
                match source.filter(|source| camera.contains(*source)) {
                    Some(source) if *label != NOT_ROCK => {
                        let told = DVec2::new(
                            f64::from((label - 1) % 240) + 0.5,
                            f64::from((label - 1) / 240) + 0.5,
                        );
                        // Half a pixel, plus the mapping's 0.05 px.
                        assert!(
                            (told - source).abs().max_element() <= 0.55,
                            "{centre}: {told}, {source}"
                        );
                    }
                    Some(source) => assert!(
                        source.x.min(source.y) < 0.1 || source.x > 239.9 || source.y > 159.9
                    ),
                    None => nothing += usize::from(*label == NOT_ROCK),
                }
            }
            assert!(
                out.labels
                    .iter()
                    .filter(|label| **label == NOT_ROCK)
                    .count()
                    <= nothing + 20
            );
        }
    }

    /// A lens that pushes outwards leaves the corners without a source.
    #[test]
    fn what_the_photo_does_not_show_is_black() {
        let lens = camera(Distortion::Brown(Brown::new([
            0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
        ])));
        let out = undistorted(
            &RgbImage::from_pixel(240, 160, Rgb([255; 3])),
            &lens,
            u32::MAX,
        );
        assert_eq!(out.get_pixel(0, 0).0, [0; 3]);
        assert_eq!(out.get_pixel(239, 159).0, [0; 3]);
        assert_eq!(out.get_pixel(120, 80).0, [255; 3]);
    }

    /// Cells that are interpolated are within 0.05 px of the exact mapping everywhere, at the size
    /// of a real photo.
    #[test]
    fn interpolated_cells_are_close_to_the_exact_mapping() {
        for small in lenses() {
            let camera = small.rescaled(2400, 1600).unwrap();
            let mapping = Mapping {
                camera: &camera,
                camera_from_target: DVec2::ONE,
                photo_from_camera: DVec2::ONE,
                size: DVec2::new(2400.0, 1600.0),
            };
            let (mut smooth, mut worst) = (0, 0.0_f64);
            for row in (0..1600).step_by(CELL as usize) {
                for column in (0..2400).step_by(CELL as usize) {
                    let Cell::Smooth(corners) = mapping.cell(column, row) else {
                        continue;
                    };
                    smooth += 1;
                    for (x, y) in [
                        (0.5, 0.5),
                        (3.5, 12.5),
                        (8.5, 7.5),
                        (13.5, 4.5),
                        (15.5, 15.5),
                    ] {
                        let inside = DVec2::new(x, y);
                        let target = DVec2::new(f64::from(column), f64::from(row)) + inside;
                        let exact = mapping.source(target).unwrap();
                        let off = (bilinear(&corners, inside / f64::from(CELL)) - exact).length();
                        worst = worst.max(off);
                    }
                }
            }
            assert!(worst < 0.05, "{worst} px");
            assert!(
                smooth > 14_000,
                "only {smooth} of 15 000 cells are interpolated"
            );
        }
    }

    /// Parts of any place are those of the whole, to the steepness of a ramp of one a pixel.
    #[test]
    fn parts_are_those_of_the_whole() {
        let photo = coordinates(240, 160);
        for camera in lenses().into_iter().chain([camera(Distortion::None)]) {
            let whole = undistorted(&photo, &camera, u32::MAX);
            for (x, y, width, height) in [(0, 0, 240, 160), (33, 47, 50, 70), (199, 101, 90, 90)] {
                let part = Part {
                    x,
                    y,
                    width,
                    height,
                };
                let tile = undistorted_part(&photo, &camera, part);
                assert_eq!(tile.dimensions(), (width.min(240 - x), height.min(160 - y)));
                for (u, v, pixel) in tile.enumerate_pixels() {
                    let there = whole.get_pixel(x + u, y + v);
                    let off = (0..3).map(|i| pixel[i].abs_diff(there[i])).max().unwrap();
                    assert!(off <= 1, "{u}, {v}: {pixel:?} {there:?}");
                }
            }
        }
    }

    /// At half the size the same places are shown, from the full photo and from a reduced one.
    #[test]
    fn a_reduced_size_shows_the_same_places() {
        for camera in lenses() {
            let photo = coordinates(240, 160);
            let full = undistorted(&photo, &camera, u32::MAX);
            let small_photo = crate::picture::reduced(&photo, 120);
            for photo in [&photo, &small_photo] {
                let half = undistorted(photo, &camera, 120);
                assert_eq!(half.dimensions(), (120, 80));
                for (x, y, pixel) in half.enumerate_pixels() {
                    if !(4..116).contains(&x) || !(4..76).contains(&y) {
                        continue;
                    }
                    let around = [(0, 0), (1, 0), (0, 1), (1, 1)]
                        .map(|(dx, dy)| *full.get_pixel(2 * x + dx, 2 * y + dy));
                    for channel in 0..2 {
                        let mean = around.iter().map(|p| f64::from(p[channel])).sum::<f64>() / 4.0;
                        let off = (f64::from(pixel[channel]) - mean).abs();
                        assert!(off <= 1.3, "{x}, {y}: {off}");
                    }
                }
            }
        }
    }
}

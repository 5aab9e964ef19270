//! Whether a photo shows the colours that the cloud has where its pose says: a pose in another
//! convention, with an axis flipped or of another flight, gives footprints as smooth as a right one,
//! but the colours do not match.
//!
//! The brightness of the cloud's vertices and of the pixels that they project to are compared by
//! their correlation (Pearson's r): it does not mind exposure, white balance or contrast. What is
//! hidden behind something else is left out: of what a photo looks flatly at that is half, with which right photos had 0.2 to 0.4.
//! Where it looks flatly, many vertices are in one pixel: their mean is compared.
//! Photos are compared at one size, whoever asks: a finer one has more noise, and the limits are for this one.

use glam::{DVec2, DVec3};
use image::RgbImage;

use super::undistorted;
use crate::camera::{Camera, Pose};
use crate::geometry::Ray;
use crate::surface::Surface;

/// The longer side at which photos are compared, pixels: finer than most clouds, and an error of a percent of the distance is one to
/// three of them.
pub(super) const COMPARED: u32 = 512;

/// How many vertices are looked at: of large clouds every so manieth.
const LOOKED_AT: usize = 200_000;

/// In how many pixels of a photo they are compared, each with a ray; the standard error of r is under 1/sqrt(n).
const COMPARED_IN: usize = 5000;

/// What is met so much nearer hides a vertex, as a share of its distance: noise and the triangles beside it lie closer.
const HIDES: f64 = 0.02;

/// With fewer pairs r says nothing.
const FEWEST: usize = 200;

/// A correlation under which the colours do not match. Of right poses it is 0.5 and more (0.65 to 0.70 on the bundled flight, 0.88 to
/// 0.93 over the lake shore of OpenDroneMap's Brighton, 0.51 to 0.84 of a castle, 0.47 to 0.96 in a simulated survey of 105 photos
/// from all sides; over sparse clouds photos that look flatly across half a muckpile have 0.32 to 0.46); of wrong ones it is
/// what shadows and slopes make of it, -0.2 to 0.2, and 0.06 and 0.31 where two photos of the castle are exchanged.
const POOR: f64 = 0.4;

/// How much better a flipped photo has to match before it is called flipped.
const BETTER: f64 = 0.2;

/// How the colours of one photo match.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// In how many pixels: those of a small copy of the photo that show vertices.
    pub points: usize,
    /// Pearson's r of the brightness, -1 to 1.
    pub correlation: f64,
    /// The best r of a flipped photo, and how it was flipped.
    pub flipped: (f64, Flip),
}

/// A photo turned over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flip {
    /// Left and right exchanged.
    LeftRight,
    /// Top and bottom exchanged.
    TopBottom,
    /// Turned by 180 degrees.
    HalfTurn,
}

impl Flip {
    const ALL: [Self; 3] = [Self::LeftRight, Self::TopBottom, Self::HalfTurn];

    fn of(self, [u, v]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::LeftRight => [1.0 - u, v],
            Self::TopBottom => [u, 1.0 - v],
            Self::HalfTurn => [1.0 - u, 1.0 - v],
        }
    }

    /// What was done to the photo.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::LeftRight => "left and right exchanged",
            Self::TopBottom => "top and bottom exchanged",
            Self::HalfTurn => "a turn by 180 degrees",
        }
    }
}

/// A photo, as shot, as it is compared with whatever else: undistorted and small. `None` where its size is not its camera's.
pub fn for_comparing(photo: &RgbImage, camera: &Camera) -> Option<RgbImage> {
    let is_its = photo.dimensions() == (camera.width, camera.height);
    is_its.then(|| undistorted(photo, camera, COMPARED))
}

impl Agreement {
    /// Compares a surface's colours with a photo, which is that of [`for_comparing`], one of so many `photos` that are.
    ///
    /// # Errors
    /// Why there is nothing to compare.
    pub fn of_photo(
        surface: &Surface,
        camera: &Camera,
        pose: &Pose,
        photo: Option<&RgbImage>,
        photos: usize,
    ) -> Result<Self, NotComparable> {
        if surface.colors().is_empty() {
            return Err(NotComparable::NoColours);
        }
        let photo = photo.ok_or(NotComparable::OtherSize)?;
        Self::of(surface, camera, pose, photo, photos)
    }

    /// Compares a surface's colours with an undistorted photo of any size.
    fn of(
        surface: &Surface,
        camera: &Camera,
        pose: &Pose,
        undistorted: &RgbImage,
        photos: usize,
    ) -> Result<Self, NotComparable> {
        let colors = surface.colors();
        if colors.is_empty() {
            return Err(NotComparable::NoColours);
        }
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        let step = colors.len().div_ceil(LOOKED_AT).max(1);
        let vertices = surface.vertices().zip(colors).step_by(step);
        let mut inside: Vec<Vertex> = vertices
            .filter_map(|(at, color)| {
                let pixel = camera.pixel_undistorted(pose.camera_from_world(at))?;
                let place = (pixel / size).to_array();
                Some(Vertex {
                    pixel: pixel_of(undistorted, place)?,
                    place,
                    distance: at.distance(pose.center),
                    at,
                    brightness: brightness(*color),
                })
            })
            .collect();
        inside.sort_by(|a, b| {
            let by_distance = || a.distance.total_cmp(&b.distance);
            a.pixel.cmp(&b.pixel).then_with(by_distance)
        });
        // Where a photo looks flatly, a pixel is of many vertices.
        let pixels = || inside.chunk_by(|a, b| a.pixel == b.pixel);
        let count = pixels().count();
        let step = count.div_ceil(COMPARED_IN).max(1);
        // Of all photos together: a mesh of the whole surface may pay for them.
        let mut caster = surface.caster_for(photos.saturating_mul(count / step)).ok();
        let (mut seen, mut hidden) = (Vec::new(), Vec::new());
        for vertices in pixels().step_by(step) {
            let Some(nearest) = vertices.first() else {
                continue;
            };
            let ray = Ray {
                origin: pose.center,
                direction: (nearest.at - pose.center).normalize(),
            };
            // A surface that nothing can be cast at says so where scales are asked of it.
            let met = caster.as_mut().and_then(|caster| caster.cast(&ray));
            let is_hidden = met.is_some_and(|met| met.t < (1.0 - HIDES) * nearest.distance);
            let beside = vertices
                .iter()
                .take_while(|vertex| vertex.distance <= (1.0 + HIDES) * nearest.distance);
            let (sum, count) = beside.fold((0.0, 0.0), |(sum, count), vertex| {
                (sum + vertex.brightness, count + 1.0)
            });
            let place = (sum / count, nearest.place);
            match is_hidden {
                true => hidden.push(place),
                false => seen.push(place),
            }
        }
        // A photo that sees hardly anything by its pose stands behind something, or does not stand there: all is held against it.
        if seen.len() < FEWEST {
            seen.append(&mut hidden);
        }
        match seen.len() {
            0 => return Err(NotComparable::NotInPhoto),
            points if points < FEWEST => return Err(NotComparable::TooFew { points }),
            _ => {}
        }
        let correlation_of = |flip: &dyn Fn([f64; 2]) -> [f64; 2]| {
            let pairs = seen.iter().filter_map(|(cloud, place)| {
                Some((*cloud, brightness(pixel_at(undistorted, flip(*place))?)))
            });
            correlation(pairs)
        };
        let as_it_is = correlation_of(&|place| place).ok_or(NotComparable::OneColour)?;
        let flipped = Flip::ALL.map(|flip| {
            let correlation = correlation_of(&|place| flip.of(place));
            (correlation.unwrap_or(-1.0), flip)
        });
        let best = flipped.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        Ok(Self {
            points: seen.len(),
            correlation: as_it_is,
            flipped: best.unwrap_or((-1.0, Flip::HalfTurn)),
        })
    }

    /// What is wrong with the photo's pose, or with the photo, if its colours say so.
    pub fn mismatch(&self) -> Option<Mismatch> {
        let (flipped, flip) = self.flipped;
        if flipped > self.correlation + BETTER && flipped > POOR {
            return Some(Mismatch::Flipped(flip));
        }
        (self.correlation < POOR).then_some(Mismatch::Different)
    }
}

/// How the colours of a photo are not those of the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mismatch {
    /// They would match after this: an axis of the pose is flipped.
    Flipped(Flip),
    /// They match in no way: another photo, another pose or another surface.
    Different,
}

/// Why a photo's colours cannot be compared with the surface's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NotComparable {
    /// The surface has no colours.
    #[error("the surface has no colours")]
    NoColours,
    /// No vertex of the surface projects into the photo.
    #[error("no point of the surface projects into the photo")]
    NotInPhoto,
    /// Vertices project into too few of its pixels, as it is compared.
    #[error(
        "points of the surface project into only {points} places of the photo, too few to compare colours"
    )]
    TooFew {
        /// How many.
        points: usize,
    },
    /// The photo or the surface has one brightness all over.
    #[error("the photo or the surface has only one brightness there")]
    OneColour,
    /// The photo's size is not its camera's.
    #[error("the photo's size is not that of its camera")]
    OtherSize,
}

/// ITU-R BT.601's luma, 0 to 255.
pub fn brightness([red, green, blue]: [u8; 3]) -> f64 {
    0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue)
}

/// A vertex of the surface in a photo.
struct Vertex {
    /// Column and row of the pixel that shows it, in the photo as it is compared.
    pixel: (u32, u32),
    /// Shares of width and height.
    place: [f64; 2],
    at: DVec3,
    /// From the camera's centre.
    distance: f64,
    brightness: f64,
}

/// The pixel at these shares of width and height; `None` outside.
fn pixel_of(image: &RgbImage, place: [f64; 2]) -> Option<(u32, u32)> {
    let (width, height) = image.dimensions();
    let inside = place.iter().all(|share| (0.0..1.0).contains(share));
    // Truncated: the first pixel reaches from 0 to 1.
    let [x, y] = [(place[0], width), (place[1], height)]
        .map(|(share, count)| ((share * f64::from(count)) as u32).min(count.saturating_sub(1)));
    inside.then_some((x, y))
}

fn pixel_at(image: &RgbImage, place: [f64; 2]) -> Option<[u8; 3]> {
    let (x, y) = pixel_of(image, place)?;
    Some(image.get_pixel_checked(x, y)?.0)
}

/// Pearson's r, in one pass after Welford; `None` where one side does not vary.
fn correlation(pairs: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let (mut n, mut mean, mut sums) = (0.0, (0.0, 0.0), (0.0, 0.0, 0.0));
    for (a, b) in pairs {
        n += 1.0;
        let (da, db) = (a - mean.0, b - mean.1);
        mean = (mean.0 + da / n, mean.1 + db / n);
        let after = (a - mean.0, b - mean.1);
        sums = (
            sums.0 + da * after.0,
            sums.1 + db * after.1,
            sums.2 + da * after.1,
        );
    }
    let spread = (sums.0 * sums.1).sqrt();
    (spread > 0.0).then(|| sums.2 / spread)
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::camera::Distortion;
    use crate::surface::Cloud;

    #[test]
    fn the_correlation_is_pearsons() {
        // Anscombe's first quartet: r = 0.816.
        let x = [10.0, 8.0, 13.0, 9.0, 11.0, 14.0, 6.0, 4.0, 12.0, 7.0, 5.0];
        let y = [
            8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68,
        ];
        let r = correlation(x.into_iter().zip(y)).unwrap();
        assert!((r - 0.816_42).abs() < 1e-5, "{r}");
        assert_eq!(correlation([(1.0, 2.0), (1.0, 3.0)].into_iter()), None);
    }

    /// A chequered square of 2 m seen straight from above, each field of its own brightness.
    fn scene() -> (Surface, Camera, Pose, RgbImage) {
        let shade = |x: u32, y: u32| {
            let field = (x / 8 * 7 + y / 8 * 13) % 29;
            u8::try_from(field * 8).unwrap()
        };
        let mut cloud = Cloud::default();
        for y in 0..64 {
            for x in 0..64 {
                let at = DVec3::new(f64::from(x) + 0.5, 63.5 - f64::from(y), 0.0) / 32.0;
                cloud.points.push(at);
                cloud.colors.push([shade(x, y); 3]);
            }
        }
        let image = RgbImage::from_fn(64, 64, |x, y| image::Rgb([shade(x, y) / 2 + 60; 3]));
        let camera = Camera {
            name: String::new(),
            width: 640,
            height: 640,
            fx: 640.0,
            fy: 640.0,
            cx: 320.0,
            cy: 320.0,
            skew: 0.0,
            distortion: Distortion::None,
        };
        let pose = Pose::from_tilt_pan(DVec3::new(1.0, 1.0, 2.0), [90.0, 0.0]);
        (Surface::new(cloud).unwrap(), camera, pose, image)
    }

    #[test]
    fn a_right_pose_matches_and_a_flipped_one_is_recognised() {
        let (surface, camera, pose, image) = scene();
        let right = Agreement::of(&surface, &camera, &pose, &image, 1).unwrap();
        // Not all: rounding may exclude vertices on the photo's edge.
        assert!(right.points > 4000 && right.correlation > 0.99, "{right:?}");
        assert_eq!(right.mismatch(), None);
        let turned = Pose {
            rotation: pose.rotation * DMat3::from_rotation_z(std::f64::consts::PI),
            ..pose
        };
        let wrong = Agreement::of(&surface, &camera, &turned, &image, 1).unwrap();
        assert_eq!(wrong.flipped.1, Flip::HalfTurn);
        assert_eq!(wrong.mismatch(), Some(Mismatch::Flipped(Flip::HalfTurn)));
        let quarter = Pose {
            rotation: pose.rotation * DMat3::from_rotation_z(std::f64::consts::FRAC_PI_2),
            ..pose
        };
        let quarter = Agreement::of(&surface, &camera, &quarter, &image, 1).unwrap();
        assert_eq!(quarter.mismatch(), Some(Mismatch::Different));
    }

    /// A second storey in the negative of the first, of which every other vertex is there: 0.2 m below, a tenth of the distance, the photo
    /// shows the first alone; 0.02 m below, as noise lies, both count.
    #[test]
    fn what_is_hidden_is_left_out() {
        let far = of_two_storeys(0.2);
        assert!(far.points < 3000 && far.correlation > 0.99, "{far:?}");
        let near = of_two_storeys(0.02);
        assert!(near.points > 3000 && near.correlation < 0.5, "{near:?}");
    }

    fn of_two_storeys(apart: f64) -> Agreement {
        let (surface, camera, pose, image) = scene();
        let points: Vec<DVec3> = surface.vertices().collect();
        // A surface has its vertices in an order of its own.
        let corners = [[0.5, 63.5], [63.5, 63.5], [0.5, 0.5], [63.5, 0.5]];
        let corners = corners.map(|at| {
            let at = DVec2::from(at).extend(0.0) / 32.0;
            points.iter().position(|point| *point == at).unwrap()
        });
        let mut cloud = Cloud::default();
        for (storey, step) in [(0.0, 2), (-apart, 1)] {
            // Its corners come first, for its two triangles.
            let first = u32::try_from(cloud.points.len()).unwrap();
            let [a, b, c, d] = [0, 1, 2, 3].map(|corner| first + corner);
            cloud.triangles.extend([[a, c, b], [b, c, d]]);
            for place in corners.into_iter().chain((0..points.len()).step_by(step)) {
                cloud.points.push(points[place] + DVec3::Z * storey);
                let color = surface.colors()[place];
                let negative = color.map(|channel| 255 - channel);
                cloud
                    .colors
                    .push(if storey == 0.0 { color } else { negative });
            }
        }
        let storeys = Surface::new(cloud).unwrap();
        Agreement::of(&storeys, &camera, &pose, &image, 1).unwrap()
    }

    /// Four vertices in each pixel, two of them bright and two dark about the pixel's own shade, are their mean.
    #[test]
    fn vertices_of_one_pixel_are_their_mean() {
        let (surface, camera, pose, image) = scene();
        let mut cloud = Cloud::default();
        for (at, color) in surface.vertices().zip(surface.colors()) {
            for (x, y, off) in [
                (-1.0, -1.0, 30),
                (1.0, -1.0, -30),
                (-1.0, 1.0, -30),
                (1.0, 1.0, 30),
            ] {
                cloud.points.push(at + DVec3::new(x, y, 0.0) / 150.0);
                let shade = i32::from(color[0] / 2 + 60) + off;
                cloud.colors.push([u8::try_from(shade).unwrap(); 3]);
            }
        }
        let found = Agreement::of(&Surface::new(cloud).unwrap(), &camera, &pose, &image, 1);
        let found = found.unwrap();
        assert!(found.points < 4100 && found.correlation > 0.99, "{found:?}");
    }

    #[test]
    fn what_cannot_be_compared_says_why() {
        let (surface, camera, pose, image) = scene();
        let away = Pose {
            center: pose.center + DVec3::X * 100.0,
            ..pose
        };
        assert_eq!(
            Agreement::of(&surface, &camera, &away, &image, 1),
            Err(NotComparable::NotInPhoto)
        );
        // 1.95 m to the side leaves the first of the 64 columns and a half of the second.
        let aside = Pose {
            center: pose.center - DVec3::X * 1.95,
            ..pose
        };
        assert_eq!(
            Agreement::of(&surface, &camera, &aside, &image, 1),
            Err(NotComparable::TooFew { points: 128 })
        );
        let black = RgbImage::new(64, 64);
        assert_eq!(
            Agreement::of(&surface, &camera, &pose, &black, 1),
            Err(NotComparable::OneColour)
        );
        assert_eq!(
            Agreement::of_photo(
                &surface,
                &camera,
                &pose,
                for_comparing(&black, &camera).as_ref(),
                1
            ),
            Err(NotComparable::OtherSize)
        );
        let cloud = Cloud {
            points: surface.vertices().collect(),
            ..Cloud::default()
        };
        let plain = Surface::new(cloud).unwrap();
        assert_eq!(
            Agreement::of(&plain, &camera, &pose, &image, 1),
            Err(NotComparable::NoColours)
        );
    }
}

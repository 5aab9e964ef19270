//! Where one looks from: pixels to rays and points to pixels, in f64.
//!
//! View axes are camera axes (x right, y down, z forward), so that a photo's pose is a view as it
//! is. Pixels of the viewport are continuous like those of photos: (0, 0) at the outer corner of the
//! top-left pixel.

pub(crate) mod orbit;
mod through;

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

use crate::camera::{Camera, Pose};
use crate::geometry::Ray;

/// How view axes become pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Pinhole with square pixels and the axis in the middle.
    Perspective {
        /// Angle between the viewport's top and bottom edge, radians.
        fov_y: f64,
    },
    /// Parallel.
    Orthographic {
        /// World units between the viewport's top and bottom edge.
        height: f64,
    },
    /// The undistorted image of a photo, as large as fits into the viewport, in its middle.
    Photo {
        /// Image size in pixels.
        image: DVec2,
        /// fx and fy, pixels of the image.
        focal: DVec2,
        /// cx and cy, pixels of the image.
        center: DVec2,
        /// Pixels of the image.
        skew: f64,
        /// How far one looks into it.
        zoom: PhotoZoom,
    },
}

/// A part of a photo that is looked at: a narrower field of view than the camera's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhotoZoom {
    /// How many times larger than fitted into the viewport, at least 1.
    pub factor: f64,
    /// Which place of the image is in the viewport's middle, as a share of its width and height.
    pub middle: DVec2,
}

impl Default for PhotoZoom {
    fn default() -> Self {
        Self {
            factor: 1.0,
            middle: DVec2::splat(0.5),
        }
    }
}

impl PhotoZoom {
    /// The largest.
    const MOST: f64 = 400.0;

    /// Larger by a factor, with what is under the cursor (viewport pixels) staying there.
    #[must_use]
    pub fn zoomed(self, cursor: DVec2, factor: f64, image: DVec2, size: DVec2) -> Self {
        let (before, offset) = letterbox(image, self, size);
        let share = (cursor - offset) / (image * before);
        let next = (self.factor * factor).clamp(1.0, Self::MOST);
        if next.is_nan() || next <= 1.0 {
            return Self::default();
        }
        let after = before * next / self.factor;
        let middle = share + (size * 0.5 - cursor) / (image * after);
        Self {
            factor: next,
            middle: middle.clamp(DVec2::ZERO, DVec2::ONE),
        }
    }

    /// Moved by so many viewport pixels.
    #[must_use]
    pub fn panned(self, by: DVec2, image: DVec2, size: DVec2) -> Self {
        if self.factor <= 1.0 {
            return self;
        }
        let (scale, _) = letterbox(image, self, size);
        let middle = self.middle - by / (image * scale);
        Self {
            middle: middle.clamp(DVec2::ZERO, DVec2::ONE),
            ..self
        }
    }
}

/// Where one looks from, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// In the world. In parallel projection what lies behind it is seen too.
    pub eye: DVec3,
    /// View axes in the world, as columns; a proper rotation.
    pub world_from_view: DMat3,
    /// How view axes become pixels.
    pub projection: Projection,
    /// At which distance along the axis the scale bar is true, world units. In parallel projection
    /// it is true everywhere.
    pub focus: f64,
}

/// `u = focal.x x + skew y + center.x z`, `v = focal.y y + center.y z`, over z or, in parallel
/// projection, over 1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pinhole {
    focal: DVec2,
    center: DVec2,
    skew: f64,
    parallel: bool,
}

impl View {
    /// What an undistorted photo shows. `focus` as in [`Self::focus`].
    pub fn of_photo(camera: &Camera, pose: &Pose, focus: f64) -> Self {
        Self {
            eye: pose.center,
            world_from_view: pose.rotation,
            projection: Projection::Photo {
                image: DVec2::new(f64::from(camera.width), f64::from(camera.height)),
                focal: DVec2::new(camera.fx, camera.fy),
                center: DVec2::new(camera.cx, camera.cy),
                skew: camera.skew,
                zoom: PhotoZoom::default(),
            },
            focus,
        }
    }

    /// The same look into a part of the photo; nothing changes in the other projections.
    #[must_use]
    pub fn into_photo(mut self, wanted: PhotoZoom) -> Self {
        if let Projection::Photo { zoom, .. } = &mut self.projection {
            *zoom = wanted;
        }
        self
    }

    /// The ray of a viewport pixel; its direction has unit length.
    pub fn ray(&self, pixel: DVec2, size: DVec2) -> Ray {
        let lens = self.pinhole(size);
        let y = (pixel.y - lens.center.y) / lens.focal.y;
        let x = (pixel.x - lens.center.x - lens.skew * y) / lens.focal.x;
        if lens.parallel {
            return Ray {
                origin: self.eye + self.world_from_view * DVec3::new(x, y, 0.0),
                direction: self.world_from_view.z_axis,
            };
        }
        Ray {
            origin: self.eye,
            direction: (self.world_from_view * DVec3::new(x, y, 1.0)).normalize(),
        }
    }

    /// The viewport pixel of a world point (also outside the edges), or `None` where it is not in
    /// front of the eye.
    pub fn project(&self, point: DVec3, size: DVec2) -> Option<DVec2> {
        let lens = self.pinhole(size);
        let p = self.world_from_view.transpose() * (point - self.eye);
        let depth = if lens.parallel { 1.0 } else { p.z };
        (depth > 0.0).then(|| {
            DVec2::new(lens.focal.x * p.x + lens.skew * p.y, lens.focal.y * p.y) / depth
                + lens.center
        })
    }

    /// Viewport pixels per world unit, across the axis at `distance` along it.
    pub fn pixels_per_unit(&self, size: DVec2, distance: f64) -> f64 {
        let lens = self.pinhole(size);
        if lens.parallel {
            lens.focal.y
        } else {
            lens.focal.y / distance
        }
    }

    /// The same view for a picture of another shape: it shows at least what a viewport of size `seen`
    /// shows.
    #[must_use]
    pub fn reframed(&self, seen: DVec2, picture: DVec2) -> Self {
        let wider = (seen.x / seen.y) / (picture.x / picture.y);
        let wider = wider.max(1.0);
        let projection = match self.projection {
            Projection::Perspective { fov_y } => Projection::Perspective {
                fov_y: 2.0 * ((fov_y * 0.5).tan() * wider).atan(),
            },
            Projection::Orthographic { height } => Projection::Orthographic {
                height: height * wider,
            },
            photo @ Projection::Photo { .. } => photo,
        };
        Self {
            projection,
            ..*self
        }
    }

    /// Where the photo lies in a viewport that looks through its camera: its top left and bottom
    /// right pixel. `None` in the other projections.
    pub fn photo_rectangle(&self, size: DVec2) -> Option<[DVec2; 2]> {
        let Projection::Photo { image, zoom, .. } = self.projection else {
            return None;
        };
        let (scale, offset) = letterbox(image, zoom, size);
        Some([offset, offset + image * scale])
    }

    /// The projection as a pinhole of the viewport.
    pub(crate) fn pinhole(&self, size: DVec2) -> Pinhole {
        let middle = size * 0.5;
        match self.projection {
            Projection::Perspective { fov_y } => Pinhole {
                focal: DVec2::splat(middle.y / (fov_y * 0.5).tan()),
                center: middle,
                skew: 0.0,
                parallel: false,
            },
            Projection::Orthographic { height } => Pinhole {
                focal: DVec2::splat(size.y / height),
                center: middle,
                skew: 0.0,
                parallel: true,
            },
            Projection::Photo {
                image,
                focal,
                center,
                skew,
                zoom,
            } => {
                let (scale, offset) = letterbox(image, zoom, size);
                Pinhole {
                    focal: focal * scale,
                    center: center * scale + offset,
                    skew: skew * scale,
                    parallel: false,
                }
            }
        }
    }

    /// Whether lines of sight are parallel.
    pub(crate) fn is_parallel(&self) -> bool {
        matches!(self.projection, Projection::Orthographic { .. })
    }

    /// View axes to clip space, reverse-z: depth 1 at `near`; 0 at infinity, in parallel projection
    /// at `far`.
    pub(crate) fn clip_from_view(&self, size: DVec2, near: f64, far: f64) -> DMat4 {
        let lens = self.pinhole(size);
        let scale = DVec2::new(2.0, -2.0) / size;
        // Where the axis is in normalised device coordinates.
        let axis = lens.center * scale + DVec2::new(-1.0, 1.0);
        let x = DVec4::new(lens.focal.x * scale.x, 0.0, 0.0, 0.0);
        let y = DVec4::new(lens.skew * scale.x, lens.focal.y * scale.y, 0.0, 0.0);
        if lens.parallel {
            let depth = 1.0 / (far - near);
            DMat4::from_cols(
                x,
                y,
                DVec4::new(0.0, 0.0, -depth, 0.0),
                DVec4::new(axis.x, axis.y, far * depth, 1.0),
            )
        } else {
            DMat4::from_cols(
                x,
                y,
                DVec4::new(axis.x, axis.y, 0.0, 1.0),
                DVec4::new(0.0, 0.0, near, 0.0),
            )
        }
    }
}

/// How an image fits into a viewport: its scale and the place of its corner.
fn letterbox(image: DVec2, zoom: PhotoZoom, size: DVec2) -> (f64, DVec2) {
    let scale = (size / image).min_element() * zoom.factor;
    (scale, size * 0.5 - zoom.middle * image * scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Distortion;

    const SIZE: DVec2 = DVec2::new(1000.0, 700.0);

    fn views() -> [View; 3] {
        let eye = DVec3::new(500_000.0, 5_000_000.0, 300.0);
        let pose = Pose::from_yaw_pitch_roll(eye, [30.0, -60.0, 4.0]);
        let camera = Camera {
            name: String::new(),
            width: 4000,
            height: 2250,
            fx: 3000.0,
            fy: 2990.0,
            cx: 2010.0,
            cy: 1100.0,
            skew: 2.5,
            distortion: Distortion::None,
        };
        let photo = View::of_photo(&camera, &pose, 100.0);
        [
            photo,
            View {
                projection: Projection::Perspective { fov_y: 0.9 },
                ..photo
            },
            View {
                projection: Projection::Orthographic { height: 40.0 },
                ..photo
            },
        ]
    }

    #[test]
    fn pixel_to_ray_to_pixel() {
        for view in views() {
            for pixel in [DVec2::ZERO, SIZE * 0.5, DVec2::new(12.5, 600.25), SIZE] {
                for t in [1.0, 80.0, 5000.0] {
                    let ray = view.ray(pixel, SIZE);
                    assert!((ray.direction.length() - 1.0).abs() < 1e-14);
                    let seen = view.project(ray.at(t), SIZE).unwrap();
                    // Coordinates of 5 000 000 are known to 1e-9, which 1 m away is 1e-6 px.
                    assert!(seen.distance(pixel) < 3e-6, "{pixel} {seen} at {t}");
                }
            }
        }
    }

    /// What touches an edge of the viewport touches that edge of a narrower or a wider picture.
    #[test]
    fn a_picture_of_another_shape_shows_all_that_was_seen() {
        for view in &views()[1..] {
            for (picture, edge) in [
                (DVec2::new(500.0, 900.0), DVec2::new(0.0, 350.0)),
                (DVec2::new(900.0, 300.0), DVec2::new(500.0, 0.0)),
            ] {
                let point = view.ray(edge, SIZE).at(70.0);
                let now = view.reframed(SIZE, picture);
                let seen = now.project(point, picture).unwrap();
                assert!((seen / picture).distance(edge / SIZE) < 1e-6, "{seen}");
            }
        }
    }

    /// The shader's way, in f64: clip space gives the same pixels, 1 at the near plane, 0 at the far
    /// end, and greater depth for what is nearer.
    #[test]
    fn clip_space_agrees_with_pixels() {
        for view in views() {
            let (near, far) = (0.5, 900.0);
            let matrix = view.clip_from_view(SIZE, near, far);
            let clip = |p: DVec3| {
                let clip = matrix * p.extend(1.0);
                clip.truncate() / clip.w
            };
            for p in [DVec3::new(3.0, -2.0, 20.0), DVec3::new(-30.0, 11.0, 400.0)] {
                let ndc = clip(p);
                let pixel = (ndc.truncate() * DVec2::new(0.5, -0.5) + 0.5) * SIZE;
                let world = view.eye + view.world_from_view * p;
                assert!(pixel.distance(view.project(world, SIZE).unwrap()) < 1e-6);
            }
            assert!((clip(DVec3::Z * near).z - 1.0).abs() < 1e-12);
            assert!(clip(DVec3::Z * far).z < 1e-3);
            assert!(clip(DVec3::Z * 10.0).z > clip(DVec3::Z * 10.001).z);
        }
    }

    /// What is under the cursor stays there, ray and all; all the way back the whole photo is seen.
    #[test]
    fn one_looks_into_the_photo_about_the_cursor() {
        let [photo, ..] = views();
        let image = DVec2::new(4000.0, 2250.0);
        let cursor = DVec2::new(800.0, 200.0);
        let ray = photo.ray(cursor, SIZE);
        let mut zoom = PhotoZoom::default();
        for factor in [2.0, 3.0, 0.7] {
            zoom = zoom.zoomed(cursor, factor, image, SIZE);
            let now = photo.into_photo(zoom).ray(cursor, SIZE);
            assert!(now.direction.distance(ray.direction) < 1e-12);
        }
        // A quarter of the size, times 4.2.
        let at = |x: f64| {
            photo
                .into_photo(zoom)
                .ray(DVec2::new(x, 350.0), SIZE)
                .direction
        };
        let axis = photo.world_from_view.z_axis;
        let apart = (at(600.0) / at(600.0).dot(axis)).distance(at(500.0) / at(500.0).dot(axis));
        assert!(
            (apart - 100.0 / (3000.0 * 0.25 * 4.2)).abs() < 1e-12,
            "{apart}"
        );
        assert_eq!(zoom.zoomed(cursor, 0.01, image, SIZE), PhotoZoom::default());
        let moved = zoom.panned(DVec2::new(21.0, 0.0), image, SIZE);
        assert!((zoom.middle.x - moved.middle.x - 21.0 / 4200.0).abs() < 1e-12);
    }

    /// The photo's own corners are the corners of the letterbox.
    #[test]
    fn a_photo_fits_into_the_viewport() {
        let [photo, ..] = views();
        let [top_left, bottom_right] = photo.photo_rectangle(SIZE).unwrap();
        // 4000 x 2250 in 1000 x 700: a quarter of the size, 68.75 px above and below.
        assert_eq!(top_left, DVec2::new(0.0, 68.75));
        assert_eq!(bottom_right, DVec2::new(1000.0, 631.25));
        // The principal point is on the axis.
        let axis = photo.project(photo.eye + photo.world_from_view.z_axis * 50.0, SIZE);
        let there = DVec2::new(2010.0, 1100.0) / 4.0 + top_left;
        assert!(axis.unwrap().distance(there) < 1e-6);
        assert_eq!(
            photo.project(photo.eye - photo.world_from_view.z_axis, SIZE),
            None
        );
    }
}

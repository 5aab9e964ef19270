//! The edge and the corners of the photo whose camera is looked through.

use glam::DVec2;

use super::photo_lines::{GROUND, SELECTED, ink};
use crate::primitives::lines::{Pen, Stroke};
use crate::scene::photo_geometry::PhotoGeometry;
use crate::show::Show;
use crate::view::View;

/// Of a corner on the surface, as on the photo itself.
const ON_SURFACE: [u8; 3] = [64, 200, 110];

/// The strokes, in pixels of the picture: around the undistorted image; a dot at each corner of the image
/// that the scale is for, green on the surface, red where it fell back to the ground or met nothing.
pub(crate) fn strokes(view: &View, photo: &PhotoGeometry, size: DVec2, show: &Show) -> Vec<Stroke> {
    let Some([from, to]) = view.photo_rectangle(size) else {
        return Vec::new();
    };
    let at = |pixel: DVec2| pixel.extend(0.0);
    let place = |share: DVec2| from + share * (to - from);
    let shares = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    let rim = ink(show).map(|channel| 255 - channel);
    let mut strokes = Vec::new();
    for pen in [Pen::new(rim, 4.0).pale(0.6), Pen::new(SELECTED, 1.8)] {
        for side in 0..4 {
            let (a, b) = (place(shares[side]), place(shares[(side + 1) % 4]));
            strokes.push(pen.line(at(a), at(b)));
        }
    }
    for (corner, share) in photo
        .corners
        .iter()
        .zip(photo.image_corners.unwrap_or(shares))
    {
        let on_surface = corner.is_some_and(|met| !met.on_ground);
        let color = if on_surface { ON_SURFACE } else { GROUND };
        for pen in [Pen::new(rim, 12.0), Pen::new(color, 8.0)] {
            strokes.push(pen.dot(at(place(share))));
        }
    }
    strokes
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::camera::{Camera, Distortion, Pose};
    use crate::geometry::{Bounds, LocalFrame};

    /// Eight sides and eight dots; none in the free view, which has no edge.
    #[test]
    fn a_look_through_a_camera_has_an_edge() {
        let camera = Camera {
            name: String::new(),
            width: 400,
            height: 300,
            fx: 300.0,
            fy: 300.0,
            cx: 200.0,
            cy: 150.0,
            skew: 0.0,
            distortion: Distortion::None,
        };
        let pose = Pose::from_yaw_pitch_roll(DVec3::ZERO, [0.0, -90.0, 0.0]);
        let origin = Bounds {
            min: DVec3::ZERO,
            max: DVec3::ZERO,
        };
        let frame = LocalFrame::near(&origin);
        let photo = PhotoGeometry::new(&frame, &camera, &pose, None, None);
        let mut view = View::of_photo(&camera, &pose, 1.0);
        let (size, show) = (DVec2::new(800.0, 500.0), Show::default());
        assert_eq!(strokes(&view, &photo, size, &show).len(), 16);
        view.projection = crate::Projection::Perspective { fov_y: 1.0 };
        assert!(strokes(&view, &photo, size, &show).is_empty());
    }
}

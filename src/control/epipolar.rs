//! Where a point can be in one photo that is marked in another.
//!
//! The mark's ray, from its camera centre to infinity, is seen by the other camera in the directions between
//! those of the two ends: an arc. A projection depends on the direction alone, so each place of the arc is a
//! pixel, through whatever lens.

use glam::{DVec2, DVec3};

use crate::camera::{Camera, NotInvertible, Pose};

/// Directions that are looked at along the whole arc: of a camera that is one degree wide, more than one.
const COARSE: u32 = 512;
/// Pieces that a run of them in the image is drawn with.
const PIECES: u32 = 64;
/// As a share of the image's larger side: how far beside the image the line goes on.
const MARGIN: f64 = 0.05;

/// The ray of a mark as another camera sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EpipolarLine {
    /// In the other camera's axes, unit length: the first camera's centre; `None` where the two are in one place.
    start: Option<DVec3>,
    /// The ray's far end.
    end: DVec3,
}

impl EpipolarLine {
    /// Of the mark at `pixel` of the photo as shot, from `marked` in `other`, each with its camera's pose.
    ///
    /// # Errors
    /// Where the lens shows nothing at that pixel.
    pub fn new(
        (camera, marked): (&Camera, &Pose),
        pixel: DVec2,
        other: &Pose,
    ) -> Result<Self, NotInvertible> {
        let direction = marked.rotation * camera.direction_as_shot(pixel)?;
        Ok(Self {
            start: other.camera_from_world(marked.center).try_normalize(),
            end: (other.rotation.transpose() * direction).normalize_or_zero(),
        })
    }

    /// The direction at a share of the arc, 0 at the marked photo's centre and 1 at infinity, in the other
    /// camera's axes, unit length.
    pub fn direction(&self, share: f64) -> DVec3 {
        let Some(start) = self.start else {
            return self.end;
        };
        // Across the start, in the plane of the arc.
        let Some(across) = (self.end - start * start.dot(self.end)).try_normalize() else {
            return self.end;
        };
        let whole = start.cross(self.end).length().atan2(start.dot(self.end));
        let (sine, cosine) = (share * whole).sin_cos();
        start * cosine + across * sine
    }

    /// The line as it is drawn in an image of this camera, whose pixels of directions `project` gives: runs of
    /// pixels, in the image and a little beside it.
    pub fn runs(
        &self,
        camera: &Camera,
        project: impl Fn(DVec3) -> Option<DVec2>,
    ) -> Vec<Vec<DVec2>> {
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        let margin = size.max_element() * MARGIN;
        let is_near = |pixel: &DVec2| {
            pixel.cmpge(DVec2::splat(-margin)).all() && pixel.cmple(size + margin).all()
        };
        let at = |share: f64| project(self.direction(share)).filter(is_near);
        let share = |step: u32| f64::from(step) / f64::from(COARSE);
        let seen: Vec<bool> = (0..=COARSE).map(|step| at(share(step)).is_some()).collect();
        let mut runs = Vec::new();
        let mut begin = None;
        for step in 0..=COARSE + 1 {
            let is_seen = seen.get(step as usize).copied().unwrap_or(false);
            match (begin, is_seen) {
                (None, true) => begin = Some(step),
                (Some(first), false) => {
                    // The ends lie between two of the coarse directions.
                    let from = share(first.saturating_sub(1));
                    let to = share(step.min(COARSE));
                    let fine = (0..=PIECES)
                        .filter_map(|piece| {
                            at(from + (to - from) * f64::from(piece) / f64::from(PIECES))
                        })
                        .collect::<Vec<_>>();
                    if fine.len() > 1 {
                        runs.push(fine);
                    }
                    begin = None;
                }
                _ => {}
            }
        }
        runs
    }
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::camera::Distortion;
    use crate::control::test_camera::{brown, camera};

    fn pose(x: f64, y: f64, tilt: f64) -> Pose {
        let down = DMat3::from_cols(DVec3::X, -DVec3::Y, -DVec3::Z);
        Pose {
            rotation: down * DMat3::from_rotation_x(tilt) * DMat3::from_rotation_z(0.4 * x),
            center: DVec3::new(x, y, 60.0),
        }
    }

    /// The pixel of a direction in either image of a photo.
    fn project(camera: &Camera, as_shot: bool) -> impl Fn(DVec3) -> Option<DVec2> {
        move |direction| match as_shot {
            true => camera.pixel_as_shot(direction),
            false => camera.pixel_undistorted(direction),
        }
    }

    /// The least distance of the curve from a pixel, by thirds between the nearest of many places.
    fn distance(
        line: &EpipolarLine,
        project: impl Fn(DVec3) -> Option<DVec2>,
        pixel: DVec2,
    ) -> f64 {
        let off = |share: f64| {
            let there = project(line.direction(share));
            there.map_or(f64::INFINITY, |there| there.distance(pixel))
        };
        let count = 20_000;
        let share = |step: i32| f64::from(step) / f64::from(count);
        let nearest = (0..=count)
            .min_by(|a, b| off(share(*a)).total_cmp(&off(share(*b))))
            .unwrap();
        let (mut low, mut high) = (share(nearest - 1), share(nearest + 1));
        for _ in 0..200 {
            let third = (high - low) / 3.0;
            match off(low + third) < off(high - third) {
                true => high -= third,
                false => low += third,
            }
        }
        off((low + high) / 2.0)
    }

    /// Through the true pixel of the other photo, with a lens and without, in either image of it.
    #[test]
    fn it_goes_through_the_true_pixel() {
        for distortion in [Distortion::None, brown()] {
            let camera = camera(distortion);
            for (x, y, z) in [(1.5, 2.25, 3.5), (-9.0, 4.0, 0.0), (6.0, -7.0, 12.0)] {
                let point = DVec3::new(x, y, z);
                let (here, there) = (pose(-8.0, 1.0, 0.1), pose(7.0, -2.0, -0.15));
                let mark = camera.pixel_as_shot(here.camera_from_world(point)).unwrap();
                let line = EpipolarLine::new((&camera, &here), mark, &there).unwrap();
                for as_shot in [true, false] {
                    let project = project(&camera, as_shot);
                    let truth = project(there.camera_from_world(point)).unwrap();
                    let off = distance(&line, &project, truth);
                    assert!(off < 1e-6, "{off} px at {point}");
                    // And what is drawn of it goes by there.
                    let runs = line.runs(&camera, &project);
                    let drawn = runs.iter().flat_map(|run| run.windows(2)).map(|piece| {
                        let along = piece[1] - piece[0];
                        let share = (truth - piece[0]).dot(along) / along.length_squared();
                        (piece[0] + along * share.clamp(0.0, 1.0)).distance(truth)
                    });
                    let off = drawn.fold(f64::INFINITY, f64::min);
                    assert!(off < 0.1, "{off} px from what is drawn");
                }
            }
        }
    }

    /// Two photos from one place see the mark in one direction: there is no line to draw.
    #[test]
    fn one_place_has_no_line() {
        let camera = camera(Distortion::None);
        let (here, there) = (pose(1.0, 1.0, 0.1), pose(1.0, 1.0, -0.1));
        let line = EpipolarLine::new((&camera, &here), DVec2::new(2000.0, 1500.0), &there).unwrap();
        assert_eq!(line.direction(0.2), line.direction(0.9));
        let drawn = line.runs(&camera, project(&camera, true));
        assert!((drawn.iter().flatten()).all(|pixel| pixel.distance(drawn[0][0]) < 1e-9));
    }
}

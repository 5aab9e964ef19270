//! Planes that a photo is seen squarely onto.

use glam::{DMat3, DVec2, DVec3};
use nalgebra::{Matrix3, SymmetricEigen};

use crate::camera::Pose;
use crate::fault::Fault;
use crate::scale::ScaleField;

/// The least angle between the plane and the line of sight to the middle of what a photo shows: below it
/// a pixel covers more than ten times as much along the line of sight as across.
const LEAST_ANGLE_DEGREES: f64 = 5.0;

/// A plane with two axes: on a picture of it they point to the right and down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneFrame {
    /// The point (0, 0), in the world.
    pub origin: DVec3,
    /// Unit vector, in the world.
    pub right: DVec3,
    /// Unit vector, in the world.
    pub down: DVec3,
}

impl PlaneFrame {
    /// The plane that lies best, by least squares of distances, through what a photo shows of the surface,
    /// with the photo's right to the right.
    ///
    /// # Errors
    /// Where it shows too little, or the camera looks along the plane.
    pub fn fitted(field: &ScaleField) -> Result<Self, Fault> {
        let points = field.points();
        let mean = mean(&points)?;
        // About the mean, where squares lose nothing.
        let mut spread = DMat3::ZERO;
        for point in &points {
            let off = *point - mean;
            spread += DMat3::from_cols(off * off.x, off * off.y, off * off.z);
        }
        let spread = Matrix3::from_column_slice(&spread.to_cols_array());
        let eigen = SymmetricEigen::new(spread);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let [least, middle, most] = order.map(|place| eigen.eigenvalues[place]);
        if middle.is_nan() || middle <= most * 1e-12 || middle - least <= most * 1e-12 {
            return Err(too_little());
        }
        let normal = eigen.eigenvectors.column(order[0]);
        let normal = DVec3::new(normal[0], normal[1], normal[2]).normalize();
        let pose = field.pose();
        let to_camera = pose.center - mean;
        let normal = normal * normal.dot(to_camera).signum();
        check_angle(normal, to_camera)?;
        let camera_right = pose.rotation.x_axis;
        let right = (camera_right - normal * normal.dot(camera_right)).normalize_or_zero();
        if right == DVec3::ZERO {
            return Err(along(0.0));
        }
        Ok(Self {
            origin: mean,
            right,
            down: right.cross(normal),
        })
    }

    /// The horizontal plane at the mean height of what a photo shows of the surface, with the world's x to
    /// the right and its y up. Its origin is that of the world, at this height.
    ///
    /// # Errors
    /// Where it shows nothing, or the camera looks along the plane or stands under it.
    pub fn horizontal(field: &ScaleField) -> Result<Self, Fault> {
        let mean = mean(&field.points())?;
        let to_camera = field.pose().center - mean;
        if to_camera.z < 0.0 {
            return Err(Fault::new(
                "the camera looks at the horizontal plane from below",
                "choose another plane (--plane fit)",
            ));
        }
        check_angle(DVec3::Z, to_camera)?;
        Ok(Self::at_height(mean.z))
    }

    /// The horizontal plane at this height.
    pub fn at_height(z: f64) -> Self {
        Self {
            origin: DVec3::new(0.0, 0.0, z),
            right: DVec3::X,
            down: DVec3::NEG_Y,
        }
    }

    /// Unit vector towards whoever looks at its picture.
    pub fn normal(&self) -> DVec3 {
        self.down.cross(self.right)
    }

    /// A point of the plane in the world; right and down in world units.
    pub fn world_from_plane(&self, place: DVec2) -> DVec3 {
        self.origin + self.right * place.x + self.down * place.y
    }

    /// The foot of a world point on the plane.
    pub fn plane_from_world(&self, point: DVec3) -> DVec2 {
        let off = point - self.origin;
        DVec2::new(self.right.dot(off), self.down.dot(off))
    }

    /// Where a ray from the camera meets the plane; `None` where it does not, in front of the camera.
    pub fn meet(&self, pose: &Pose, direction_in_camera: DVec3) -> Option<DVec2> {
        let (normal, direction) = (self.normal(), pose.rotation * direction_in_camera);
        let far = normal.dot(self.origin - pose.center) / normal.dot(direction);
        let met = pose.center + direction * far;
        (far > 0.0 && met.is_finite()).then(|| self.plane_from_world(met))
    }
}

fn mean(points: &[DVec3]) -> Result<DVec3, Fault> {
    let first = points.first().ok_or_else(too_little)?;
    // Near the first one, so that coordinates of a map lose nothing.
    let off: DVec3 = points.iter().map(|point| *point - *first).sum();
    Ok(*first + off / points.len() as f64)
}

fn check_angle(normal: DVec3, to_camera: DVec3) -> Result<(), Fault> {
    let angle = normal.dot(to_camera.normalize()).clamp(-1.0, 1.0).asin();
    match angle.to_degrees() {
        degrees if degrees < LEAST_ANGLE_DEGREES => Err(along(degrees)),
        _ => Ok(()),
    }
}

fn along(degrees: f64) -> Fault {
    Fault::new(
        format!(
            "the camera looks along the plane: {degrees:.1} degrees lie between them, at least {LEAST_ANGLE_DEGREES} are needed"
        ),
        "choose another plane (--plane fit or horizontal)",
    )
}

fn too_little() -> Fault {
    Fault::new(
        "the photo shows too little of the surface for a plane",
        "check its pose, and that the surface is that of this flight",
    )
}

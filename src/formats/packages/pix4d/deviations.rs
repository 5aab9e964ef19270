//! The columns of standard deviations that Pix4D adds to `*_calibrated_external_camera_parameters.txt`
//! in some versions, or writes to `*_calibrated_external_camera_parameters_error.txt`.
//!
//! Pix4D documents neither. Users' scripts read "imageName X Y Z Omega Phi Kappa X_sigma Y_sigma Z_sigma
//! Omega_sigma Phi_sigma Kappa_sigma" from the first, and "imageName, X_gps, Y_gps, Z_gps, X_opt, ..."
//! from the second. So only columns count whose names say "sigma" and of what; positions and angles are
//! in the units of the columns that they belong to, the world's and degrees, and the offset moves none
//! of them. How far an optimised position lies from its receiver's is no standard deviation: nothing is
//! taken from such columns.

use glam::DVec3;

use crate::camera::Pose;
use crate::packages::pose_covariance::{NoCovariance, PassedOver, PoseCovariance, Taken};

/// Standard deviations of a photo as they are written.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Deviations {
    pub(super) photo: String,
    position: Taken<DVec3>,
    omega_phi_kappa: Taken<DVec3>,
}

/// Reads the columns that are named so; nothing where there are none.
pub(super) fn read(text: &str) -> Vec<Deviations> {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let header = lines.next().unwrap_or_default();
    let has_commas = header.contains(',');
    let split = |line: &str| -> Vec<String> {
        let words: Vec<&str> = match has_commas {
            true => line.split(',').map(str::trim).collect(),
            false => line.split_whitespace().collect(),
        };
        words.into_iter().map(str::to_owned).collect()
    };
    let names: Vec<String> = split(header).iter().map(|name| plain(name)).collect();
    let count = names.len();
    // From the end of a line: a photo's name may have spaces.
    let column = |of: &str| {
        let is_it = |name: &String| *name == format!("{of}sigma") || *name == format!("sigma{of}");
        Some(count - names.iter().position(is_it)?)
    };
    let columns = |three: [&str; 3]| -> Option<[usize; 3]> {
        let [a, b, c] = three.map(column);
        Some([a?, b?, c?])
    };
    let (position, angles) = (columns(["x", "y", "z"]), columns(["omega", "phi", "kappa"]));
    if names.first().is_none_or(|name| name != "imagename") || position.or(angles).is_none() {
        return Vec::new();
    }
    let of_line = |line: &str| {
        let words = split(line);
        let spare = words.len().checked_sub(count)?;
        let three = |columns: Option<[usize; 3]>| {
            let columns = columns.ok_or(None);
            let number = |from_end: usize| {
                let word = words.get(words.len().checked_sub(from_end)?)?;
                word.parse::<f64>()
                    .ok()
                    .filter(|n| *n >= 0.0 && n.is_finite())
            };
            let numbers = columns.map(|columns| columns.map(number));
            match numbers {
                Err(nothing) => Ok(nothing),
                Ok([Some(x), Some(y), Some(z)]) => Ok(Some(DVec3::new(x, y, z))),
                Ok(_) => Err(NoCovariance),
            }
        };
        Some(Deviations {
            photo: words.get(..=spare)?.join(" "),
            position: three(position),
            omega_phi_kappa: three(angles),
        })
    };
    lines.filter_map(of_line).collect()
}

/// A column's name without what its versions differ in.
fn plain(name: &str) -> String {
    let letters = name.chars().filter(|c| c.is_alphanumeric());
    letters.collect::<String>().to_ascii_lowercase()
}

impl Deviations {
    /// As those of a pose.
    pub(super) fn of(&self, pose: &Pose, passed_over: &mut PassedOver) -> PoseCovariance {
        // What is zero was held fixed.
        let mut stated = |three: Taken<DVec3>| {
            let taken = passed_over.or_count(three);
            taken.filter(|deviations| *deviations != DVec3::ZERO)
        };
        let position = stated(self.position);
        let angle = stated(self.omega_phi_kappa).map(|angles| about_camera_axes(pose, angles));
        PoseCovariance::of_deviations(position, angle)
    }
}

/// Small errors of Rx(omega) Ry(phi) Rz(kappa) as turns about the camera's axes: omega turns about the
/// world's x, kappa about the camera's z, phi about what is at right angles to both before omega.
/// Errors of the three are taken to have nothing in common. Which way an axis points does not matter.
fn about_camera_axes(pose: &Pose, deviations: DVec3) -> DVec3 {
    let worlds_x = pose.rotation.transpose() * DVec3::X;
    let (sine, cosine) = (-worlds_x.y).atan2(worlds_x.x).sin_cos();
    let middle = DVec3::new(sine, cosine, 0.0);
    let axes = [worlds_x, middle, DVec3::Z].map(|axis| axis * axis);
    let variances = deviations * deviations;
    let sum = axes[0] * variances.x + axes[1] * variances.y + axes[2] * variances.z;
    sum.map(f64::sqrt)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of each angle, turned into turns about the camera's axes.
    #[test]
    fn angles_are_about_the_cameras_axes() {
        let angles = [12.0, -25.0, 100.0];
        let pose = |angles| Pose::from_omega_phi_kappa(DVec3::ZERO, angles);
        let deviations = DVec3::new(0.01, 0.02, 0.03);
        let mut squares = DVec3::ZERO;
        for index in 0..3 {
            let mut moved = angles;
            moved[index] += deviations[index];
            let turn = pose(angles).rotation.transpose() * pose(moved).rotation;
            let turn = glam::DQuat::from_mat3(&turn).to_scaled_axis();
            squares += (turn * turn).map(|s| s.to_degrees().to_degrees());
        }
        let found = about_camera_axes(&pose(angles), deviations);
        assert!(
            (found - squares.map(f64::sqrt)).length() < 1e-5,
            "{found} {squares}"
        );
        // Straight down, the angles are the axes' own, kappa turning those of the first two.
        let down = about_camera_axes(&pose([0.0, 0.0, 90.0]), deviations);
        assert!(
            (down - DVec3::new(0.02, 0.01, 0.03)).length() < 1e-12,
            "{down}"
        );
    }

    #[test]
    fn columns_are_known_by_their_names() {
        let header = "imageName X Y Z Omega Phi Kappa X_sigma Y_sigma Z_sigma Omega_sigma Phi_sigma Kappa_sigma";
        let text = format!("{header}\na b.jpg 1 2 3 0 0 0 0.01 0.02 0.03 0.1 0.2 0.3\n\nshort 1\n");
        let found = read(&text);
        let down = Pose::from_omega_phi_kappa(DVec3::ZERO, [0.0; 3]);
        let mut passed_over = PassedOver::default();
        assert_eq!((found.len(), found[0].photo.as_str()), (1, "a b.jpg"));
        let errors = found[0].of(&down, &mut passed_over).errors();
        assert_eq!(errors.position, Some(DVec3::new(0.01, 0.02, 0.03)));
        let off = errors.angle.unwrap() - DVec3::new(0.1, 0.2, 0.3);
        assert!(off.length() < 1e-15 && passed_over.warning().is_none());
        let commas = "imageName, sigmaX, sigmaY, sigmaZ\na, 1, -2, 3\nb, 0, 0, 0\nc, 1, 2, 3\n";
        let found = read(commas);
        let of = |index: usize, passed_over: &mut PassedOver| {
            found[index].of(&down, passed_over).errors().position
        };
        assert_eq!(of(0, &mut passed_over), None);
        assert!(passed_over.warning().is_some());
        assert_eq!(of(1, &mut passed_over), None);
        assert_eq!(of(2, &mut passed_over), Some(DVec3::new(1.0, 2.0, 3.0)));
        for other in [
            "imageName, X_gps, Y_gps, Z_gps, X_opt, Y_opt, Z_opt\na, 1, 2, 3, 1, 2, 3\n",
            "imageName X Y Z Omega Phi Kappa\na 1 2 3 4 5 6\n",
            "a 1 2 3 4 5 6\n",
            "",
        ] {
            assert_eq!(read(other), []);
        }
    }
}

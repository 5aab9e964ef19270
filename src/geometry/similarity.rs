//! Similarities: rotation, one scale for all axes, translation.

use glam::{DMat3, DVec3};

/// `p -> scale * rotation * p + translation`, with scale > 0 and a proper rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// How many units of the target are one of the source.
    pub scale: f64,
    /// A proper rotation: what directions and camera axes turn by.
    pub rotation: DMat3,
    /// `scale * rotation` as it was given, digit for digit: what points are multiplied by.
    linear: DMat3,
    /// In units of the target.
    pub translation: DVec3,
}

/// Sixteen numbers are no similarity.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NotSimilarity {
    /// A number is NaN or infinite.
    #[error("a number of the transform is not finite")]
    NotFinite,
    /// The last row of the matrix.
    #[error("the last row of the transform is not 0 0 0 1")]
    LastRow,
    /// The columns have different lengths or are not perpendicular; the worst relative deviation.
    #[error(
        "the transform is no similarity: its columns deviate by {0:.3e} from equal lengths and right angles"
    )]
    Sheared(f64),
    /// Determinant <= 0.
    #[error("the transform mirrors or flattens: its determinant is {0:e}")]
    Mirrored(f64),
}

impl Similarity {
    /// From its parts: a scale above 0 and a proper rotation.
    pub fn new(scale: f64, rotation: DMat3, translation: DVec3) -> Self {
        Self {
            scale,
            rotation,
            linear: rotation * scale,
            translation,
        }
    }

    /// The row-major 4x4 matrix, as [`Similarity::from_row_major`] takes it.
    pub fn to_row_major(&self) -> [f64; 16] {
        let [x, y, z] = [self.linear.x_axis, self.linear.y_axis, self.linear.z_axis];
        let t = self.translation;
        [
            x.x, y.x, z.x, t.x, //
            x.y, y.y, z.y, t.y, //
            x.z, y.z, z.z, t.z, //
            0.0, 0.0, 0.0, 1.0,
        ]
    }

    /// From a row-major 4x4 matrix. Its columns may deviate from a similarity by a relative 1e-5:
    /// files carry rounded matrices. The rotation is then made exact by Gram-Schmidt.
    ///
    /// # Errors
    /// Where the matrix is no similarity.
    pub fn from_row_major(m: &[f64; 16]) -> Result<Self, NotSimilarity> {
        if m.iter().any(|x| !x.is_finite()) {
            return Err(NotSimilarity::NotFinite);
        }
        if m[12..] != [0.0, 0.0, 0.0, 1.0] {
            return Err(NotSimilarity::LastRow);
        }
        let column = |j: usize| DVec3::new(m[j], m[4 + j], m[8 + j]);
        let linear = DMat3::from_cols(column(0), column(1), column(2));
        let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
        let determinant = x.cross(y).dot(z);
        if determinant <= 0.0 || !determinant.is_finite() {
            return Err(NotSimilarity::Mirrored(determinant));
        }
        let scale = determinant.cbrt();
        let (x, y, z) = (x / scale, y / scale, z / scale);
        let deviation = [
            x.length() - 1.0,
            y.length() - 1.0,
            z.length() - 1.0,
            x.dot(y),
            y.dot(z),
            z.dot(x),
        ]
        .into_iter()
        .fold(0.0, |worst: f64, d| worst.max(d.abs()));
        if deviation > 1e-5 {
            return Err(NotSimilarity::Sheared(deviation));
        }
        let x = x.normalize();
        let y = (y - x * x.dot(y)).normalize();
        Ok(Self {
            scale,
            rotation: DMat3::from_cols(x, y, x.cross(y)),
            linear,
            translation: column(3),
        })
    }

    /// `first`, then this one.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self::new(
            self.scale * first.scale,
            self.rotation * first.rotation,
            self.apply(first.translation),
        )
    }

    /// Where a point of the source lies in the target.
    pub fn apply(&self, point: DVec3) -> DVec3 {
        self.linear * point + self.translation
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turn_doubled_and_moved() {
        let m = [
            0.0, -2.0, 0.0, 10.0, //
            2.0, 0.0, 0.0, 20.0, //
            0.0, 0.0, 2.0, 30.0, //
            0.0, 0.0, 0.0, 1.0,
        ];
        let similarity = Similarity::from_row_major(&m).unwrap();
        assert_eq!(similarity.scale, 2.0);
        assert_eq!(
            similarity.apply(DVec3::new(1.0, 0.0, 0.5)),
            DVec3::new(10.0, 22.0, 31.0)
        );
    }

    #[test]
    fn numbers_come_back() {
        let rotation = DMat3::from_euler(glam::EulerRot::ZYX, 0.1, 0.2, 0.3);
        let similarity = Similarity::new(0.37, rotation, DVec3::new(5e5, 5e6, 100.1));
        let back = Similarity::from_row_major(&similarity.to_row_major()).unwrap();
        assert_eq!(back.to_row_major(), similarity.to_row_major());
        let point = DVec3::new(1.0, -2.0, 3.0);
        assert_eq!(back.apply(point), similarity.apply(point));
        assert!((back.scale - 0.37).abs() < 1e-15);
    }

    #[test]
    fn what_is_no_similarity_is_refused() {
        let mut m = [0.0; 16];
        (m[0], m[5], m[10], m[15]) = (1.0, 1.0, 1.0, 1.0);
        let with = |i: usize, x: f64| {
            let mut m = m;
            m[i] = x;
            Similarity::from_row_major(&m)
        };
        assert!(with(3, 4.0).is_ok());
        assert_eq!(with(3, f64::NAN), Err(NotSimilarity::NotFinite));
        assert_eq!(with(15, 2.0), Err(NotSimilarity::LastRow));
        assert!(matches!(with(0, 1.1), Err(NotSimilarity::Sheared(_))));
        assert!(matches!(with(1, 0.1), Err(NotSimilarity::Sheared(_))));
        assert!(matches!(with(0, -1.0), Err(NotSimilarity::Mirrored(_))));
        assert!(matches!(with(0, 0.0), Err(NotSimilarity::Mirrored(_))));
    }
}

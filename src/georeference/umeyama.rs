//! The similarity between paired points by least squares: Umeyama, "Least-squares estimation of
//! transformation parameters between two point patterns", IEEE PAMI 13(4), 1991, with weights.

use glam::{DMat3, DVec3};
use nalgebra::Matrix3;

use crate::geometry::Similarity;

/// How much thinner than long a set of points may be before the rotation about its length is lost in
/// rounding.
const THINNEST: f64 = 1e-9;

/// The similarity that takes the first points of `pairs` (source, target, weight) to the second ones
/// with the least sum of weighted squared distances. Never a mirrored one: the rotation is proper
/// whatever the points are.
///
/// `None` where there is no such thing: fewer than three pairs, weights that are not positive,
/// points that are not finite, or points on a line.
pub fn similarity_of(pairs: &[(DVec3, DVec3, f64)]) -> Option<Similarity> {
    let total: f64 = pairs.iter().map(|pair| pair.2).sum();
    if pairs.len() < 3 || !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let mean = |of: fn(&(DVec3, DVec3, f64)) -> DVec3| {
        pairs.iter().map(|pair| of(pair) * pair.2).sum::<DVec3>() / total
    };
    let (source, target) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let (mut cross, mut spread) = (Matrix3::zeros(), 0.0);
    for &(from, to, weight) in pairs {
        if weight.is_nan() || weight <= 0.0 {
            return None;
        }
        let (p, q) = (from - source, to - target);
        let (row, column) = (p.to_array(), q.to_array());
        cross += nalgebra::Vector3::from(column) * nalgebra::RowVector3::from(row) * weight;
        spread += weight * p.length_squared();
    }
    if !(spread > 0.0 && cross.iter().all(|x: &f64| x.is_finite())) {
        return None;
    }
    // nalgebra sorts the singular values, largest first.
    let svd = cross.try_svd(true, true, f64::EPSILON, 1000)?;
    let (u, v_t) = (svd.u?, svd.v_t?);
    let values = svd.singular_values;
    if values[1].is_nan() || values[1] <= THINNEST * values[0] {
        return None;
    }
    let sign = if u.determinant() * v_t.determinant() < 0.0 {
        -1.0
    } else {
        1.0
    };
    let turn = u * Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, 1.0, sign)) * v_t;
    // Both store column by column.
    let rotation = DMat3::from_cols_slice(turn.as_slice());
    let scale = (values[0] + values[1] + sign * values[2]) / spread;
    if !(scale > 0.0 && scale.is_finite()) {
        return None;
    }
    let translation = target - scale * (rotation * source);
    Some(Similarity::new(scale, rotation, translation))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At the coordinates of UTM, from three pairs and from four.
    #[test]
    fn exact_recovery() {
        let rotation = DMat3::from_euler(glam::EulerRot::ZYX, 0.3, -1.2, 2.9);
        let truth = Similarity::new(
            0.037,
            rotation,
            DVec3::new(512_345.678, 5_812_345.25, 312.5),
        );
        let points = [
            DVec3::new(0.0, 0.0, 0.0),
            DVec3::new(10.0, 1.0, 0.5),
            DVec3::new(-3.0, 12.0, 2.0),
            DVec3::new(5.0, -4.0, 7.0),
        ];
        for count in [3, 4] {
            let pairs: Vec<_> = points[..count]
                .iter()
                .map(|&p| (p, truth.apply(p), 1.0))
                .collect();
            let found = similarity_of(&pairs).unwrap();
            assert!(
                (found.scale / truth.scale - 1.0).abs() < 1e-8,
                "{}",
                found.scale
            );
            for &p in &points {
                assert!(found.apply(p).distance(truth.apply(p)) < 2e-9);
            }
            assert!((found.rotation.determinant() - 1.0).abs() < 1e-14);
        }
    }

    /// Points that only a mirror could bring together: the rotation stays a proper one.
    #[test]
    fn never_mirrored() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y * 2.0, DVec3::Z * 3.0];
        let pairs: Vec<_> = points
            .iter()
            .map(|&p| (p, DVec3::new(-p.x, p.y, p.z), 1.0))
            .collect();
        let found = similarity_of(&pairs).unwrap();
        assert!((found.rotation.determinant() - 1.0).abs() < 1e-14);
    }

    /// Two pairs of weight 1 and 3 along each axis: the mean leans towards the heavy ones.
    #[test]
    fn weights_count() {
        let mut pairs = Vec::new();
        for p in [
            DVec3::X,
            DVec3::Y,
            DVec3::Z,
            -DVec3::X,
            -DVec3::Y,
            -DVec3::Z,
        ] {
            pairs.push((p, p + DVec3::X, 1.0));
            pairs.push((p, p + DVec3::X * 5.0, 3.0));
        }
        let found = similarity_of(&pairs).unwrap();
        assert!((found.translation - DVec3::X * 4.0).length() < 1e-12);
        assert!((found.scale - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_gives_none() {
        let pair = |p: DVec3| (p, p, 1.0);
        let line = [0.0, 1.0, 2.0, 5.0].map(|x| pair(DVec3::new(x, 2.0 * x, -x)));
        assert_eq!(similarity_of(&line), None);
        assert_eq!(similarity_of(&[pair(DVec3::X), pair(DVec3::Y)]), None);
        assert_eq!(similarity_of(&[pair(DVec3::X); 5]), None);
        let bad = [pair(DVec3::X), pair(DVec3::Y), pair(DVec3::NAN)];
        assert_eq!(similarity_of(&bad), None);
        let weightless = [DVec3::X, DVec3::Y, DVec3::Z].map(|p| (p, p, 0.0));
        assert_eq!(similarity_of(&weightless), None);
    }
}

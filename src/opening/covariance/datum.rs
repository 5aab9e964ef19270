//! Where cameras stand to the points, whatever place both have in the world: an S-transformation (Baarda 1973) with all
//! points as datum. The points are eliminated from the normal equations; but how each follows the unknowns is known, and
//! so is which similarity fits all their shifts best. That one is taken off of the cameras'.

use glam::DVec3;
use nalgebra::DMatrix;

use super::inverse::small_inverse;
use super::{Block, POSE};
use crate::formats::Reconstruction;

/// Numbers of a similarity: a shift, a turn, a stretch.
const SIMILARITY: usize = 7;

/// What moves cameras and points alike: the similarity that fits the points' shifts best, each as much as it is sure.
pub(super) struct Shared {
    /// Shifts of the unknowns by a similarity, about the points' middle.
    of_similarity: DMatrix<f64>,
    /// Its normal equations, ...
    normal: DMatrix<f64>,
    /// ... their right side by the unknowns, whose points follow them, ...
    by_unknowns: DMatrix<f64>,
    /// ... and what the points' own errors have in it, for a deviation of a pixel of 1.
    own: DMatrix<f64>,
    middle: DVec3,
}

impl Shared {
    pub(super) fn new(model: &Reconstruction, size: usize) -> Self {
        let points = &model.cloud.points;
        let count = points.len().max(1) as f64;
        let middle = points.iter().sum::<DVec3>() / count;
        let mut of_similarity = DMatrix::zeros(size, SIMILARITY);
        for (number, photo) in model.photos.iter().enumerate() {
            let camera_from_world = photo.pose.rotation.transpose();
            for (column, shift) in shifts(photo.pose.center - middle).into_iter().enumerate() {
                let turn = match column {
                    3..6 => camera_from_world * DVec3::AXES[column - 3],
                    _ => DVec3::ZERO,
                };
                let both = turn.to_array().into_iter().chain(shift.to_array());
                for (row, value) in both.enumerate() {
                    of_similarity[(number * POSE + row, column)] = value;
                }
            }
        }
        Self {
            of_similarity,
            normal: DMatrix::zeros(SIMILARITY, SIMILARITY),
            by_unknowns: DMatrix::zeros(SIMILARITY, size),
            own: DMatrix::zeros(SIMILARITY, SIMILARITY),
            middle,
        }
    }

    /// Holds a model of which nobody says where it is: seven directions that the normal equations leave open are known as
    /// well as others are, each unknown counted by its own. So the inverse has most digits.
    pub(super) fn hold(&self, normal: &mut DMatrix<f64>) {
        let own = normal.diagonal().map(f64::sqrt);
        let mut open = self.of_similarity.clone();
        for mut of_column in open.column_iter_mut() {
            of_column.component_mul_assign(&own);
        }
        let mut held = open.qr().q();
        for mut of_column in held.column_iter_mut() {
            of_column.component_mul_assign(&own);
        }
        normal.gemm(1.0, &held, &held.transpose(), 1.0);
    }

    pub(super) fn count(&mut self, block: &Block) {
        let shifts = shifts(block.at - self.middle);
        let columns: Vec<f64> = shifts.iter().flat_map(|shift| shift.to_array()).collect();
        let shifts = DMatrix::from_column_slice(3, SIMILARITY, &columns);
        let weight = block.own.trace().recip();
        let weighed = shifts.transpose() * weight;
        self.normal += &weighed * &shifts;
        self.own += &weighed * &block.own * weighed.transpose();
        let by_unknowns = weighed * &block.by_unknowns;
        for (column, &unknown) in block.unknowns.iter().enumerate() {
            let mut sum = self.by_unknowns.column_mut(unknown);
            sum += by_unknowns.column(column);
        }
    }

    /// Makes of the covariance of the unknowns in the world that of the unknowns to the points.
    pub(super) fn take_off(&self, covariance: &mut DMatrix<f64>, pixel: f64) -> Option<()> {
        let inverse = small_inverse(self.normal.clone())?;
        let similarity = &inverse * &self.by_unknowns;
        let own = &inverse * &self.own * &inverse * (pixel * pixel);
        let with = &*covariance * similarity.transpose();
        let of_both = similarity * &with + own;
        // C - G K' - K G' + G (T K + Q) G'.
        let half = &with - &self.of_similarity * (of_both * 0.5);
        covariance.gemm(-1.0, &half, &self.of_similarity.transpose(), 1.0);
        covariance.gemm(-1.0, &self.of_similarity, &half.transpose(), 1.0);
        Some(())
    }
}

/// How a place so far from the middle moves by each number of a similarity.
fn shifts(from_middle: DVec3) -> [DVec3; SIMILARITY] {
    let turned = DVec3::AXES.map(|axis| axis.cross(from_middle));
    let [x, y, z] = DVec3::AXES;
    [x, y, z, turned[0], turned[1], turned[2], from_middle]
}

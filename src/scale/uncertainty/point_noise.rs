//! How far points of one place lie apart: the noise of a cloud, or that two layers of it do not fit.
//!
//! The difference in height between two points of a surface shrinks with the distance between them; what is left of it at none
//! is not the surface's (geostatistics call it the nugget). But for the sides of stones: a cloud has points all the way down
//! them, at one place over (x, y). So it is not the mean difference that is looked at, but what two thirds of all have at most:
//! that of edges of the triangulation shorter than most, group by group of like lengths, with a line laid through the groups.
//! Its height at 0 is, of normal noise, 1.37 times the standard deviation; of two layers, the upper one of a quarter of the points
//! or more, what lies between them. The photo's plane is taken off: the edges of a grid run two ways, and a slope along one of them would be
//! the same for the shortest and the next.
//!
//! | simulated clouds of 15 000 to 400 000 points | their own, % of the depth | with normal noise of 0.36 % | half, and a fifth, of the points raised by 1.8 % |
//! |---|---|---|---|
//! | muckpile, bench, stockpile | 0.04 to 0.18 | 0.38 to 0.56 | 1.20 to 1.32, 0.92 to 1.14 |
//! | lab (half of it is the sides of stones) | 0.36 to 0.42 | 0.77 to 0.88 | 1.21, 1.13 |
//!
//! The mean would be 0.33 to 1.1 of the first column.
//!
//! What it does to scales nobody can tell from the cloud. Noise evens out in a line, but for rays that meet what stands
//! nearest (8 % of scales for noise of 7 % of the depth); of two layers one is wrong, and which is not known.
//! So it counts in full, where it is more than that of the clouds which the constants of `unseen` rest on
//! ([`USUAL`]): a cloud of that much noise speaks for itself, and more of it hides what `unseen` listens for. Without that, of
//! 18 ends of a muckpile's lines 14 were held as it is, and 6, 1 and 0 with noise of 0.7 %, 1.8 %, and layers 1.8 % of the depth apart.

use glam::{DVec2, DVec3};

use super::LEAST_POINTS;

/// What clouds of `sample` have of themselves, at most, a share of the depth.
const USUAL: f64 = 0.0045;

/// The mean square of what left-out points of pure noise are off, over that of the noise: what predicts them has some, too.
const OF_LEFT_OUT: f64 = 1.5;

/// Two thirds of the differences of normal noise are at most so much of its standard deviation: √2 times the quantile.
const TWO_THIRDS: f64 = 1.368_14;

/// The slope of a photo's plane that is taken off, at most: of 80 degrees.
const STEEPEST: f64 = 5.67;

/// Into how many groups of like lengths the edges are put.
const GROUPS: usize = 10;

/// Of more triangles in a photo only so many are looked at.
pub(super) const MOST_TRIANGLES: usize = 100_000;

/// From here on it is said, and no scale is trusted: the interval is then 2 % and more to either side.
const DOUBTFUL: f64 = 2.0 * USUAL;

/// How far points of one place lie apart in what a photo shows of a cloud.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PointNoise {
    /// The standard deviation of their heights, world units.
    pub height: f64,
    /// What that is of the depth along the photo's rays, as a share.
    pub relative: f64,
}

impl PointNoise {
    /// Of triangles of a cloud and the photo's plane n·X = c, both in the cloud's local frame; `per_height` is what a rise of one
    /// unit takes of the depth, as a share. None where there are too few, or all edges have one length, which tells nothing of
    /// shorter ones.
    pub(super) fn of(triangles: &[[DVec3; 3]], normal: DVec3, per_height: f64) -> Self {
        let slope = -normal.truncate() / normal.z;
        // One that stands on end has none.
        let slope = if slope.length() < STEEPEST {
            slope
        } else {
            DVec2::ZERO
        };
        let edges = triangles
            .iter()
            .flat_map(|&[a, b, c]| [b - a, c - b, a - c]);
        let mut edges: Vec<Edge> = edges.map(|edge| Edge::of(edge, slope)).collect();
        let height = nugget(&mut edges).unwrap_or(0.0) / TWO_THIRDS;
        Self {
            height,
            relative: height * per_height.abs(),
        }
    }

    /// Whether it is so much that scales are not to be trusted.
    pub fn is_doubtful(self) -> bool {
        self.relative > DOUBTFUL
    }

    /// What is more than usual of it, as an error of the depth that all of the photo may share.
    pub(super) fn unusual(self) -> f64 {
        (self.relative.powi(2) - USUAL.powi(2)).max(0.0).sqrt()
    }

    /// The factor that takes it out of the errors of left-out points with this mean square.
    pub(super) fn factor_without(self, mean_square: f64) -> f64 {
        let of_noise = OF_LEFT_OUT * self.unusual().powi(2);
        match mean_square > of_noise {
            true => (1.0 - of_noise / mean_square).sqrt(),
            false => 0.0,
        }
    }
}

/// Two points beside each other.
#[derive(Debug, Clone, Copy)]
struct Edge {
    /// Over (x, y).
    length: f64,
    /// How much the one is higher over the photo's plane, without its sign.
    rise: f64,
}

impl Edge {
    fn of(between: DVec3, slope: DVec2) -> Self {
        Self {
            length: between.truncate().length(),
            rise: (between.z - slope.dot(between.truncate())).abs(),
        }
    }
}

/// What two thirds of edges without any length would rise by at most, from those that are shorter than most.
fn nugget(edges: &mut [Edge]) -> Option<f64> {
    if edges.len() < LEAST_POINTS {
        return None;
    }
    edges.sort_unstable_by(|a, b| a.length.total_cmp(&b.length));
    let (median, short) = (edges[edges.len() / 2], edges[edges.len() / 10]);
    // The points of a grid have two distances: those beside each other are more than half of all.
    let longest = median.length.max(2.0 * short.length);
    let count = edges.partition_point(|edge| edge.length <= longest);
    let groups = edges[..count].chunks_mut(count.div_ceil(GROUPS));
    let groups: Vec<DVec2> = groups.map(of_group).collect();
    let count = groups.len() as f64;
    let mean = groups.iter().sum::<DVec2>() / count;
    let off = || groups.iter().map(|group| *group - mean);
    let spread: f64 = off().map(|off| off.x * off.x).sum();
    let slope = off().map(|off| off.x * off.y).sum::<f64>() / spread;
    let is_told = spread > 1e-9 * mean.x * mean.x;
    // No surface is the smoother the longer its edges are.
    let shortest = groups.first()?.y;
    is_told.then(|| (mean.y - slope * mean.x).clamp(0.0, shortest))
}

/// The mean length of edges, and what two thirds of them rise by at most.
fn of_group(edges: &mut [Edge]) -> DVec2 {
    let lengths: f64 = edges.iter().map(|edge| edge.length).sum();
    let place = edges.len() * 2 / 3;
    let by_rise = |a: &Edge, b: &Edge| a.rise.total_cmp(&b.rise);
    let rise = edges.select_nth_unstable_by(place, by_rise).1.rise;
    DVec2::new(lengths / edges.len() as f64, rise)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Distortion;
    use crate::jobs::Progress;
    use crate::scale::field::{FieldGrid, ScaleField};
    use crate::scale::uncertainty::surface_error::{DepthErrors, plane_of};
    use crate::scale::uncertainty::tests::{camera, nadir};
    use crate::scale::{Draws, Ground, GroundFinder, ImageKind, PhotoScale};
    use crate::scale::{FittedScale, StatedErrors, UncertainPhoto, Uncertainty};
    use crate::split_mix::SplitMix;
    use crate::surface::{Cloud, Surface};

    /// The triangles of points on a square of 40 around the middle, at `height(x, y)`.
    fn cloud(places: impl Iterator<Item = DVec2>, mut height: impl FnMut(DVec2) -> f64) -> Surface {
        let points = places.map(|at| at.extend(height(at))).collect();
        Surface::new(Cloud {
            points,
            ..Cloud::default()
        })
        .unwrap()
    }

    fn random(count: usize) -> impl Iterator<Item = DVec2> {
        let mut random = SplitMix(11);
        (0..count).map(move |_| DVec2::new(random.unit() - 0.5, random.unit() - 0.5) * 40.0)
    }

    fn grid() -> impl Iterator<Item = DVec2> {
        (0..80).flat_map(|x| (0..80).map(move |y| DVec2::new(x.into(), y.into()) / 2.0 - 20.0))
    }

    fn height_of(surface: &Surface) -> f64 {
        height_over(surface, DVec3::Z)
    }

    fn height_over(surface: &Surface, normal: DVec3) -> f64 {
        let patches = surface.patches().seen(|_| false).unwrap();
        let triangles: Vec<_> = patches
            .iter()
            .flat_map(crate::surface::Patch::triangles)
            .collect();
        PointNoise::of(&triangles, normal, 0.1).height
    }

    /// Normal noise is found on a level place, a slope and on steps, and of a surface without noise none: the
    /// steps are squares of 2, every other one raised by 1.
    #[test]
    fn noise_is_told_from_slopes_and_steps() {
        let step = |at: DVec2| {
            f64::from(((at.x / 2.0).floor() + (at.y / 2.0).floor()).rem_euclid(2.0) as u8)
        };
        let slope = |at: DVec2| 0.8 * at.x - 0.3 * at.y;
        let noise = 0.1;
        for count in [2_000, 20_000] {
            let plane = DVec3::new(-0.8, 0.3, 1.0);
            let shapes: [(&dyn Fn(DVec2) -> f64, DVec3); 3] =
                [(&|_| 0.0, DVec3::Z), (&slope, plane), (&step, DVec3::Z)];
            // Where points are as far apart as steps, those hide it.
            let kinds = if count == 2_000 { 2 } else { 3 };
            for ((shape, plane), off) in shapes.into_iter().zip([0.15, 0.15, 0.3]).take(kinds) {
                assert!(height_over(&cloud(random(count), shape), plane) < 0.3 * noise);
                let mut draws = Draws::new(2);
                let noisy = cloud(random(count), |at| shape(at) + noise * draws.normal());
                let found = height_over(&noisy, plane);
                assert!((found / noise - 1.0).abs() < off, "{found} of {count}");
            }
        }
    }

    /// Two points of one place are of two layers half of the time, and more than one time in three where one has three tenths.
    #[test]
    fn two_layers_are_points_apart() {
        for share in [0.5, 0.3] {
            let mut is_upper = SplitMix(8);
            let layers = cloud(random(20_000), |_| match is_upper.unit() < share {
                true => 0.3,
                false => 0.0,
            });
            let found = height_of(&layers);
            assert!((found / (0.3 / 1.368) - 1.0).abs() < 0.1, "{found}");
        }
        // Wild points that are few do not count as much as they are high.
        let mut is_wild = SplitMix(9);
        let wild = cloud(random(10_000), |_| {
            if is_wild.unit() < 0.01 { 50.0 } else { 0.0 }
        });
        assert!(height_of(&wild) < 0.01);
    }

    /// A grid has edges of two lengths: a slope's rise with them, and noise does not.
    #[test]
    fn a_grid_tells_it_too() {
        let slope = cloud(grid(), |at| 0.8 * at.x);
        assert!(height_over(&slope, DVec3::new(-0.8, 0.0, 1.0)) < 1e-9);
        // Who looks at a level place sees 0.8 to either side.
        let roof = cloud(grid(), |at| 0.8 * at.x.abs().min(at.y.abs()));
        assert!(height_of(&roof) < 0.3);
        let mut draws = Draws::new(4);
        let found = height_of(&cloud(grid(), |_| 0.1 * draws.normal()));
        assert!((found / 0.1 - 1.0).abs() < 0.1, "{found}");
        // Of a lattice of equal triangles nothing is known, and of few points neither.
        let side = 0.75_f64.sqrt();
        let triangles: Vec<[DVec3; 3]> = (0..100)
            .map(|at| {
                [
                    DVec3::new(at.into(), 0.0, 0.3),
                    DVec3::new(f64::from(at) + 0.5, side, 0.0),
                    DVec3::new(f64::from(at) + 1.0, 0.0, 0.1),
                ]
            })
            .collect();
        assert_eq!(
            PointNoise::of(&triangles, DVec3::Z, 1.0),
            PointNoise::default()
        );
        assert_eq!(
            PointNoise::of(&triangles[..2], DVec3::Z, 1.0),
            PointNoise::default()
        );
    }

    /// From 10 above two layers, 0.3 apart, of which each point is of one by chance: the scale is 1000 px over 10 or over 9.7,
    /// and nobody knows which. Both lie in the interval, where independent errors of thousands of points would hold neither.
    #[test]
    fn either_of_two_layers_is_in_the_interval() {
        let mut is_upper = SplitMix(8);
        let layers = cloud(random(20_000), |_| {
            if is_upper.unit() < 0.5 { 0.3 } else { 0.0 }
        });
        let (camera, pose, image) = (
            camera(Distortion::None),
            nadir(10.0),
            ImageKind::Undistorted,
        );
        let (grid, progress) = (FieldGrid::of_fit(&camera), Progress::default());
        let field = ScaleField::compute(&camera, &pose, image, grid, &layers, &progress).unwrap();
        let fitted = FittedScale::of(&field).unwrap();
        let mut ground = GroundFinder::new(Ground::Auto, &layers);
        let mut caster = layers.caster().unwrap();
        let scale = PhotoScale::compute(&camera, &pose, image, &mut ground, &mut caster).unwrap();
        let errors = StatedErrors::default();
        let photo = UncertainPhoto {
            field: &field,
            fitted: Some(&fitted),
            scale: &scale,
            errors,
        };
        let uncertainty = Uncertainty::compute(&photo, &layers).unwrap();
        assert!(uncertainty.noise.is_doubtful(), "{uncertainty:?}");
        for end in [uncertainty.fitted_top, uncertainty.fitted_bottom] {
            let end = end.unwrap();
            assert!(end.low < 100.0 && end.high > 1000.0 / 9.7, "{end:?}");
        }
    }

    /// What left-out points of noise are off is the noise's and that of three others around it.
    #[test]
    fn without_noise_nothing_is_left_of_noise() {
        let mut draws = Draws::new(4);
        let noisy = cloud(random(40_000), |_| 0.2 * draws.normal());
        let (camera, pose, image) = (
            camera(Distortion::None),
            nadir(10.0),
            ImageKind::Undistorted,
        );
        let (grid, progress) = (FieldGrid::of_fit(&camera), Progress::default());
        let field = ScaleField::compute(&camera, &pose, image, grid, &noisy, &progress).unwrap();
        let errors = DepthErrors::of(&field, plane_of(&field).unwrap(), &noisy);
        let mean_square = |errors: &DepthErrors| {
            let squares = errors.each.iter().map(|error| error.relative.powi(2));
            squares.sum::<f64>() / errors.each.len() as f64
        };
        let (with, without) = (mean_square(&errors), mean_square(&errors.without_noise()));
        assert!(
            (with / 0.02_f64.powi(2) / OF_LEFT_OUT - 1.0).abs() < 0.15,
            "{with}"
        );
        assert!(without < 0.15 * with, "{without} of {with}");
    }
}

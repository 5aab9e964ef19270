//! The pair of photos that a model begins with: many matches, seen from well apart.

use cumulus3d_core::ids::images_of_pair;
use cumulus3d_core::{FeatureStore, MatchGraph, Rigid3, Vec3};
use cumulus3d_matching::pose::{
    inlier_rays, median_triangulation_angle, refit_and_estimate_relative_pose, triangulate_midpoint,
};

/// Degrees between the rays to a point from which on a pair is a good one.
const GOOD_ANGLE: f64 = 6.0;

/// A pair of photos.
pub(super) struct Seed {
    /// Their identifiers.
    pub(super) images: [u32; 2],
    /// Camera of the second from camera of the first; the distance is 1.
    pub(super) pose: Rigid3,
}

/// The best pairs, the best first.
pub(super) fn seeds(store: &FeatureStore, graph: &MatchGraph) -> Vec<Seed> {
    let mut all: Vec<(f64, Seed)> = graph
        .image_pairs()
        .into_iter()
        .filter_map(|(pair, matches)| {
            let (a, b) = images_of_pair(pair);
            let (pose, angle) = relative_pose(store, graph, a, b)?;
            let share = (angle / GOOD_ANGLE).min(1.0);
            let score = matches as f64 * share * share;
            let images = [a, b];
            Some((score, Seed { images, pose }))
        })
        .collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.images.cmp(&b.1.images)));
    all.into_iter().map(|(_, seed)| seed).collect()
}

/// With the median angle, degrees, between the rays of the two to a point.
fn relative_pose(
    store: &FeatureStore,
    graph: &MatchGraph,
    a: u32,
    b: u32,
) -> Option<(Rigid3, f64)> {
    let mut geometry = graph.two_view_geometry(a, b)?;
    geometry.inlier_matches = graph.matches_between(a, b);
    let [first, second] = [a, b].map(|id| {
        let camera = store.camera(store.image(id)?.camera_id)?;
        Some((camera, store.keypoints(id)?))
    });
    let ((camera_a, points_a), (camera_b, points_b)) = (first?, second?);
    let found =
        refit_and_estimate_relative_pose(&camera_a, &camera_b, &points_a, &points_b, &mut geometry);
    let pose = geometry.cam1_to_cam2.filter(|_| found)?;
    let (rays_a, rays_b) = inlier_rays(&camera_a, &camera_b, &points_a, &points_b, &geometry);
    let rotation = pose.rotation_matrix();
    let points: Vec<Vec3> = (rays_a.iter().zip(&rays_b))
        .filter_map(|(a, b)| triangulate_midpoint(&rotation, &pose.translation, a, b))
        .collect();
    let angle = median_triangulation_angle(&pose, &points).to_degrees();
    Some((pose, angle))
}

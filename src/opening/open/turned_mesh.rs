//! Meshes that Meshroom wrote turned over.
//!
//! Since its version 2023 it turns a mesh by 180 degrees about x as it writes it, for OpenGL's sake (AliceVision's
//! `mesh/Mesh.cpp` and `mesh/Texturing.cpp` change the signs of y and z), while the scene's poses and points stay as they
//! are. Before, it did not, and no file says which. With the ground at y = 0, where Meshroom puts it, rays meet the turned
//! mesh at about the right distance, with its relief inside out: the numbers look good.
//!
//! So both are tried: the scene's points lie near the mesh that is not turned; where there are too few of them, its
//! faces look at the cameras.

use std::collections::HashSet;

use glam::{DVec3, IVec3};

use super::source::Source;
use crate::flight::Doubt;
use crate::geometry::Bounds;
use crate::scale::ImageKind;
use crate::surface::Cloud;

/// Of more triangles, photos or points only so many are looked at.
const MOST_TRIANGLES: usize = 20_000;
const MOST_PHOTOS: usize = 40;
const MOST_POINTS: usize = 2_000;

/// Fewer points say nothing.
const LEAST_POINTS: usize = 50;

/// A point is near the mesh if a vertex lies in its cell or one beside it, of so many cells along the mesh's diagonal.
const CELLS: f64 = 150.0;

/// By how much more points must be near one way than the other.
const NEARER: f64 = 0.2;

/// So large a share of what the photos see of a mesh that is not turned looks at them.
const FACING: f64 = 0.8;

/// Whether the mesh shows the photos its faces or their backs, as one does that lies where they look, and not one that stands
/// on end.
pub(super) fn lies_before_photos(mesh: &Cloud, source: &Source) -> bool {
    let facing = share_facing(mesh, false, source);
    facing.is_some_and(|facing| !(1.0 - FACING..=FACING).contains(&facing))
}

/// Turns the mesh of a scene of Meshroom's back, where it is turned; what is to be said of it, and whether it rests on nothing but
/// the way that its faces look: one that is inside out looks the same.
pub(super) fn turn_back(mesh: &mut Cloud, source: &Source) -> Option<(String, Option<Doubt>)> {
    if !source.may_turn_meshes || mesh.triangles.is_empty() {
        return None;
    }
    let (why, doubt) = match shares_near(mesh, source) {
        Some([as_it_is, turned]) if as_it_is > turned + NEARER => return None,
        Some([as_it_is, turned]) if turned > as_it_is + NEARER => {
            ("the scene's points lie on it then", None)
        }
        _ => {
            let [as_it_is, turned] = [false, true].map(|turned| share_facing(mesh, turned, source));
            let looks_away = as_it_is.is_none_or(|facing| facing < 1.0 - FACING);
            let is_turned = looks_away && turned.is_some_and(|facing| facing > FACING);
            let why = "its faces look at the photos then";
            is_turned.then_some((why, Some(Doubt::TurnedMesh)))?
        }
    };
    for point in &mut mesh.points {
        *point = turned(*point);
    }
    let said = format!(
        "it is turned by 180 degrees about x against the photos, as Meshroom writes meshes since 2023: it was turned back ({why})"
    );
    Some((said, doubt))
}

fn turned(point: DVec3) -> DVec3 {
    DVec3::new(point.x, -point.y, -point.z)
}

/// The share of the scene's points that lie near a vertex of the mesh as it is, and turned; `None` of too few points.
fn shares_near(mesh: &Cloud, source: &Source) -> Option<[f64; 2]> {
    let points = &source.reconstruction_cloud.cloud.points;
    if points.len() < LEAST_POINTS {
        return None;
    }
    let side = Bounds::of(&mesh.points)?.size().length() / CELLS;
    let cell = |point: DVec3| (point / side).floor().as_ivec3();
    let with_vertices: HashSet<IVec3> = mesh.points.iter().map(|vertex| cell(*vertex)).collect();
    let is_near = |point: DVec3| {
        let (at, beside) = (cell(point), -1..=1);
        beside.clone().any(|x| {
            beside.clone().any(|y| {
                let mut across = beside.clone();
                across.any(|z| with_vertices.contains(&at.saturating_add(IVec3::new(x, y, z))))
            })
        })
    };
    let tried = points.iter().step_by(points.len().div_ceil(MOST_POINTS));
    let share = |of: &dyn Fn(DVec3) -> DVec3| {
        let near = tried.clone().filter(|point| is_near(of(**point)));
        near.count() as f64 / tried.len() as f64
    };
    // Turned once more a point is where it was, so points are turned in place of all vertices.
    Some([share(&|point| point), share(&turned)])
}

/// Of what the photos see of the mesh as it is, or turned, as large as they see it and as if nothing hid anything, the share that
/// looks at them; `None` where they see nothing.
fn share_facing(mesh: &Cloud, is_turned: bool, source: &Source) -> Option<f64> {
    let triangles = mesh.triangles.len().div_ceil(MOST_TRIANGLES).max(1);
    let photos = source.photos.len().div_ceil(MOST_PHOTOS).max(1);
    let (mut facing, mut all) = (0.0, 0.0);
    for triangle in mesh.triangles.iter().step_by(triangles) {
        let corners = triangle.map(|corner| {
            let point = mesh.points.get(corner as usize).copied();
            if is_turned { point.map(turned) } else { point }
        });
        let [Some(a), Some(b), Some(c)] = corners else {
            continue;
        };
        let (area, middle) = ((b - a).cross(c - a), (a + b + c) / 3.0);
        for photo in source.photos.iter().step_by(photos) {
            let to_camera = photo.pose.center - middle;
            let seen = photo.pose.rotation.transpose() * -to_camera;
            let Some(camera) = source.cameras.get(photo.camera) else {
                continue;
            };
            let pixel = ImageKind::Undistorted.pixel(camera, seen);
            if seen.z > 0.0 && pixel.is_some_and(|pixel| camera.contains(pixel)) {
                let size = area.dot(to_camera) / to_camera.length().powi(3);
                facing += size.max(0.0);
                all += size.abs();
            }
        }
    }
    (all > 0.0).then_some(facing / all)
}

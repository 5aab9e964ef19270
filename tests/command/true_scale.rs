//! The scale core against lengths that somebody measured: a calibration board in photos, its poses
//! and lens as OpenCV solved them, the pixels per metre as OpenCV's corner detection finds them.

use std::fs;

use crate::common::shared_data;
use fragscale::camera::Pose;
use fragscale::formats::read_camera;
use fragscale::geometry::Ray;
use fragscale::surface::{Cloud, Surface};
use glam::{DMat3, DQuat, DVec2, DVec3};

/// The board has 9 x 6 corners, 25 mm apart.
const COLUMNS: usize = 9;
const ROWS: usize = 6;
const SQUARE: f64 = 0.025;

/// The numbers of a matrix in OpenCV's YAML.
fn matrix(yaml: &str, name: &str) -> Vec<f64> {
    let from = yaml.split(&format!("{name}:")).nth(1).expect("the matrix");
    let data = from.split("data: [").nth(1).expect("its data");
    let data = data.split(']').next().expect("its end");
    data.split(',')
        .map(|n| n.trim().parse().expect("a number"))
        .collect()
}

/// A corner in a world whose z points from the board to the camera: OpenCV's board has z into it.
fn corner(row: usize, column: usize) -> DVec3 {
    DVec3::new(column as f64 * SQUARE, -(row as f64) * SQUARE, 0.0)
}

#[test]
fn the_chessboards_rows_have_the_measured_scale() {
    let (Some(calibration), Some(measured)) = (
        shared_data("opencv-chessboard-left/left_intrinsics.yml"),
        shared_data("opencv-chessboard-left/derived_px_per_m_by_row.csv"),
    ) else {
        return;
    };
    let camera = read_camera(&calibration).expect("a camera");
    let yaml = fs::read_to_string(&calibration).expect("text");
    let poses = matrix(&yaml, "extrinsic_parameters");
    let measured = fs::read_to_string(measured).expect("text");
    let rows = measured.lines().filter(|line| line.starts_with("left"));
    let rows: Vec<Vec<f64>> = rows
        .map(|line| {
            line.split(',')
                .skip(1)
                .map(|n| n.parse().expect("a number"))
                .collect()
        })
        .collect();
    assert_eq!((rows.len(), poses.len()), (13, 13 * 6));
    let corners = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| corner(row, column)));
    let surface = Surface::new(Cloud {
        points: corners.collect(),
        ..Cloud::default()
    });
    let surface = surface.expect("a surface");
    let mut caster = surface.caster().expect("a caster");
    let board_from_world = DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
    let pose_errors = matrix(&yaml, "per_view_reprojection_errors");
    for ((of_photo, pose), pose_error) in rows.iter().zip(poses.chunks(6)).zip(pose_errors) {
        let mut worst: f64 = 0.0;
        let rotation = DQuat::from_scaled_axis(DVec3::from_slice(&pose[..3]));
        let camera_from_world = DMat3::from_quat(rotation) * board_from_world;
        let pose = Pose {
            rotation: camera_from_world.transpose(),
            center: -(camera_from_world.transpose() * DVec3::from_slice(&pose[3..])),
        };
        assert!(pose.center.z > 0.2, "the camera is in front of the board");
        for (row, measured) in of_photo.iter().enumerate() {
            let pixels: Vec<DVec2> = (0..COLUMNS)
                .map(|column| pose.camera_from_world(corner(row, column)))
                .map(|point| camera.pixel_as_shot(point).expect("in front"))
                .collect();
            // Back through the lens, by the rays and the surface that scales come from.
            let points: Vec<DVec3> = pixels
                .iter()
                .map(|pixel| {
                    let direction = camera.direction_as_shot(*pixel).expect("a direction");
                    let ray = Ray {
                        origin: pose.center,
                        direction: (pose.rotation * direction).normalize(),
                    };
                    // The rim belongs to the surface, but these rays come back through a lens.
                    let t = caster
                        .cast(&ray)
                        .map_or(-ray.origin.z / ray.direction.z, |hit| hit.t);
                    ray.at(t)
                })
                .collect();
            let in_pixels: f64 = pixels.windows(2).map(|p| (p[1] - p[0]).length()).sum();
            let in_metres: f64 = points.windows(2).map(|p| (p[1] - p[0]).length()).sum();
            worst = worst.max((in_pixels / in_metres / measured - 1.0).abs());
        }
        // Of one photo the calibration itself says that its pose is 1.18 px off (the others 0.16 to 0.38):
        // over a row of some 280 px that is up to 0.8 %.
        let limit = if pose_error < 0.5 { 0.005 } else { 0.008 };
        println!(
            "the chessboard's rows, pose {pose_error:.2} px: {:.2} %",
            100.0 * worst
        );
        assert!(worst < limit, "{worst}");
    }
}

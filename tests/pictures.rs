//! Pictures: what the renderer draws, off-screen.
//!
//! Snapshots hold the look (`tests/snapshots`, made new with `UPDATE_SNAPSHOTS=1`); where a claim is
//! geometric, pixels are counted against what projecting known points says.

#![cfg(feature = "render")]
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::unwrap_used,
    missing_docs,
    reason = "in a test a panic is the report"
)]

mod common;

use std::path::Path;

use egui_kittest::image_snapshot;
use fragscale::camera::{Camera, Distortion, Pose};
use fragscale::geometry::{Bounds, LocalFrame};
use fragscale::jobs::Progress;
use fragscale::opening::{self, OpenOptions};
use fragscale::render::{
    Background, CloudGeometry, ColorBy, Gpu, MeshGeometry, Normals, Orbit, PhotoGeometry,
    PhotoImage, PhotoLook, Projection, Renderer, Scope, Show, View,
};
use fragscale::scale::{Corner, Ground, GroundFinder, ImageKind, PhotoScale, ViewFacts};
use fragscale::surface::{Cloud, Surface};
use glam::{DMat3, DVec2, DVec3};
use image::{Rgba, RgbaImage};

/// Of most snapshots: small, because they are kept.
const SIZE: [u32; 2] = [240, 160];

fn gpu() -> Gpu {
    // The fault names the package to install.
    Gpu::headless().unwrap_or_else(|fault| panic!("{fault}"))
}

/// The device that the snapshots were drawn with: thin lines differ from driver to driver.
fn gpu_of_snapshots() -> Gpu {
    let gpu = gpu();
    let driver = gpu.device.adapter_info();
    assert!(
        gpu.software && driver.backend == wgpu::Backend::Vulkan,
        "snapshots are compared as the processor draws them, not {} ({}); install the Debian package \
         mesa-vulkan-drivers",
        driver.name,
        driver.backend,
    );
    gpu
}

/// A flight with everything that can be drawn.
struct Scene {
    frame: LocalFrame,
    bounds: Bounds,
    surface: Surface,
    cameras: Vec<(Camera, Pose)>,
    scales: Vec<PhotoScale>,
    views: Vec<ViewFacts>,
}

fn camera() -> Camera {
    Camera {
        name: String::new(),
        width: 640,
        height: 480,
        fx: 600.0,
        fy: 600.0,
        cx: 320.0,
        cy: 240.0,
        skew: 0.0,
        distortion: Distortion::None,
    }
}

impl Scene {
    fn new(cloud: Cloud, cameras: Vec<(Camera, Pose)>, image: ImageKind) -> Self {
        let bounds = Bounds::of(&cloud.points).unwrap();
        let surface = Surface::new(cloud).unwrap();
        let mut caster = surface.caster().unwrap();
        let mut ground = GroundFinder::new(Ground::At(bounds.min.z), &surface);
        let mut scales = Vec::new();
        let mut views = Vec::new();
        for (camera, pose) in &cameras {
            let scale = PhotoScale::compute(camera, pose, image, &mut ground, &mut caster).unwrap();
            views.push(
                ViewFacts::compute(
                    camera,
                    pose,
                    image,
                    &scale,
                    &mut ground,
                    &mut caster,
                    &Progress::default(),
                )
                .unwrap(),
            );
            scales.push(scale);
        }
        drop(caster);
        Self {
            frame: LocalFrame::near(&bounds),
            bounds,
            surface,
            cameras,
            scales,
            views,
        }
    }

    /// A heap of 20 x 14 units with stripes of colour on level ground, and three cameras over it;
    /// the third looks beyond its edge.
    fn heap(origin: DVec3) -> Self {
        let mut cloud = Cloud::default();
        for row in 0..57 {
            for column in 0..81 {
                let (x, y) = (f64::from(column) * 0.25 - 10.0, f64::from(row) * 0.25 - 7.0);
                let heap = 3.0 * (-(x * x + 2.0 * y * y) / 18.0).exp();
                let stones = 0.25 * ((2.3 * x).sin() * (2.9 * y + x).cos()).max(0.0);
                cloud.points.push(origin + DVec3::new(x, y, heap + stones));
                let stripe = (row / 6 + column / 6) % 2 == 0;
                cloud.colors.push(if stripe {
                    [196, 160, 118]
                } else {
                    [122, 126, 132]
                });
            }
        }
        let over = |x: f64, y: f64, angles: [f64; 3]| {
            (
                camera(),
                Pose::from_yaw_pitch_roll(origin + DVec3::new(x, y, 11.0), angles),
            )
        };
        let cameras = vec![
            over(-4.0, 0.0, [0.0, -90.0, 0.0]),
            over(1.5, -5.0, [0.0, -70.0, 0.0]),
            over(7.0, 1.0, [60.0, -75.0, 0.0]),
        ];
        Self::new(cloud, cameras, ImageKind::Undistorted)
    }

    /// A square plate of half-width `half` at z = 0 under one camera.
    fn plate(half: f64, pose: Pose) -> Self {
        let corner = |x: f64, y: f64| DVec3::new(x * half, y * half, 0.0);
        let cloud = Cloud {
            points: vec![
                corner(-1., -1.),
                corner(1., -1.),
                corner(1., 1.),
                corner(-1., 1.),
            ],
            ..Cloud::default()
        };
        Self::new(cloud, vec![(camera(), pose)], ImageKind::Undistorted)
    }

    fn renderer(&self, gpu: &Gpu) -> Renderer {
        let mut renderer = Renderer::new(gpu);
        renderer.start(&self.frame);
        let triangles = self.surface.triangles().unwrap();
        let vertices = || self.surface.vertices();
        let colors = self.surface.colors();
        let normals = Normals::of(&self.frame, vertices(), &triangles);
        let cloud = CloudGeometry::new(&self.frame, vertices(), colors, &normals);
        renderer.set_cloud(Some(&cloud));
        let mesh = MeshGeometry::new(&self.frame, vertices(), colors, &normals, &triangles);
        renderer.set_mesh(Some(&mesh));
        let photos = self.cameras.iter().zip(&self.scales).zip(&self.views);
        let photos = photos.map(|(((camera, pose), scale), view)| {
            PhotoGeometry::new(&self.frame, camera, pose, Some(scale), Some(view))
        });
        renderer.set_photos(photos.collect());
        renderer
    }

    /// From the south-west and above, with all of the surface and the cameras in sight.
    fn orbit(&self) -> Orbit {
        let mut orbit = Orbit::new(&self.bounds);
        orbit.yaw = 0.5;
        let mut points: Vec<DVec3> = self.surface.vertices().collect();
        points.extend(self.cameras.iter().map(|(_, pose)| pose.center));
        orbit.fit_into(&points, DVec2::new(240.0, 160.0));
        orbit
    }
}

/// Nothing but the background.
fn nothing() -> Show {
    Show {
        mesh: false,
        frusta: Scope::None,
        corner_rays: Scope::None,
        outlines: Scope::None,
        fills: Scope::None,
        axes: false,
        scale_bar: false,
        ..Show::default()
    }
}

fn mesh() -> Show {
    Show {
        mesh: true,
        ..nothing()
    }
}

/// A photo with a letter-like mark, so that a turned or mirrored one is seen.
fn marked_photo() -> RgbaImage {
    RgbaImage::from_fn(64, 48, |x, y| {
        let frame = x < 3 || y < 3 || x >= 61 || y >= 45;
        let mark = (10..16).contains(&x) || (y < 14 && x > 10 && x < 40);
        match (frame, mark, y < 24) {
            (true, _, _) => Rgba([250, 250, 250, 255]),
            (_, true, _) => Rgba([20, 20, 20, 255]),
            (_, _, true) => Rgba([214, 84, 60, 255]),
            _ => Rgba([60, 120, 214, 255]),
        }
    })
}

/// One for each primitive and colour mode.
#[test]
fn primitives_look_as_they_did() {
    let gpu = gpu_of_snapshots();
    let scene = Scene::heap(DVec3::ZERO);
    let mut renderer = scene.renderer(&gpu);
    for index in 0..3 {
        renderer.set_photo_image(index, &PhotoImage::new(&marked_photo()));
    }
    renderer.set_projected_photo(Some((1, &marked_photo())));
    let view = scene.orbit().view();
    let selected = Some(1);
    let white = Background::Color([255; 3]);
    let by = |color_by| Show {
        color_by,
        selected,
        ..mesh()
    };
    let pictures = [
        ("mesh", mesh()),
        (
            "mesh_white",
            Show {
                background: white,
                ..mesh()
            },
        ),
        (
            "mesh_without_relief",
            Show {
                eye_dome: false,
                ..mesh()
            },
        ),
        (
            "wireframe",
            Show {
                wireframe: true,
                ..mesh()
            },
        ),
        ("elevation", by(ColorBy::Elevation)),
        ("slope", by(ColorBy::Slope)),
        ("scale", by(ColorBy::Scale)),
        (
            "cloud",
            Show {
                cloud: true,
                ..nothing()
            },
        ),
        (
            "cloud_by_scale",
            Show {
                cloud: true,
                color_by: ColorBy::Scale,
                selected,
                ..nothing()
            },
        ),
        (
            "cloud_sample",
            Show {
                cloud: true,
                max_points: Some(500),
                ..nothing()
            },
        ),
        (
            "frusta",
            Show {
                frusta: Scope::All,
                selected,
                hovered: Some(0),
                ..mesh()
            },
        ),
        (
            "images",
            Show {
                images: Scope::All,
                frusta: Scope::All,
                ..mesh()
            },
        ),
        (
            "corner_rays",
            Show {
                corner_rays: Scope::All,
                ..mesh()
            },
        ),
        (
            "outlines",
            Show {
                outlines: Scope::All,
                selected,
                ..mesh()
            },
        ),
        (
            "fills",
            Show {
                fills: Scope::All,
                selected,
                ..mesh()
            },
        ),
        (
            "flight_line",
            Show {
                flight_line: true,
                ..mesh()
            },
        ),
        (
            "ground",
            Show {
                ground: Some(0.0),
                ..mesh()
            },
        ),
        (
            "projected_photo",
            Show {
                project_photo: true,
                selected,
                ..mesh()
            },
        ),
    ];
    for (name, show) in pictures {
        let picture = renderer.picture(&view, &show, SIZE).unwrap();
        image_snapshot(&picture, name);
    }
    let furniture = Show {
        color_by: ColorBy::Elevation,
        axes: true,
        scale_bar: true,
        background: Background::Transparent,
        ..mesh()
    };
    let mut orbit = scene.orbit();
    orbit.orthographic = true;
    orbit.top();
    let picture = renderer.picture_with_words(&orbit.view(), &furniture, [288, 200]);
    image_snapshot(&picture.unwrap(), "furniture_and_words");
    let (camera, pose) = &scene.cameras[1];
    let through = View::of_photo(camera, pose, 10.0);
    let blended = Show {
        photo_blend: 0.5,
        outlines: Scope::All,
        selected,
        ..mesh()
    };
    let picture = renderer.picture(&through, &blended, SIZE).unwrap();
    image_snapshot(&picture, "through_the_camera");
    assert_eq!(gpu.take_error(), None);
}

/// The paper's figure of the bundled sample, from the command.
#[test]
fn the_corner_ray_figure_of_the_sample() {
    let _ = gpu_of_snapshots();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("figure.png");
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    common::stdout_of(&[
        "render",
        sample.to_str().unwrap(),
        "-o",
        file.to_str().unwrap(),
        "--size",
        "288x162",
    ]);
    let picture = image::open(&file).unwrap().into_rgba8();
    image_snapshot(&picture, "sample_corner_rays");
}

#[test]
fn mistakes_are_one_line_and_leave_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("figure.png");
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    let run = |more: &[&str]| {
        let mut arguments = vec!["render", sample.to_str().unwrap(), "-o"];
        arguments.push(file.to_str().unwrap());
        arguments.extend(more);
        let output = common::fragscale(&arguments);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!file.exists());
        (output.status.code(), said)
    };
    for (arguments, status, part) in [
        (&["--size", "1280"][..], 2, "1280x720"),
        (&["--size", "99999x99999"], 2, "at most 200 million pixels"),
        (&["--view", "below"], 2, "photo:NAME"),
        (&["--show", "mesh,clouds"], 2, "some of mesh, cloud"),
        (&["--show", "mesh:selected"], 2, "some of mesh, cloud"),
        (&["--view", "photo:IMG_9.jpg"], 1, "no photo 'IMG_9.jpg'"),
        (
            &["--select", "IMG_9.jpg"],
            1,
            "the nearest name is 'IMG_0009.jpg'",
        ),
        (&["--color-by", "scale"], 1, "--select PHOTO"),
    ] {
        let (code, said) = run(arguments);
        assert_eq!(code, Some(status), "{said}");
        let lines = said.lines().filter(|line| line.starts_with("error: "));
        assert!(lines.clone().any(|line| line.contains(part)), "{said}");
    }
}

/// Where a picture differs from another by more than the rounding of colours.
fn changed(a: &RgbaImage, b: &RgbaImage) -> Vec<(u32, u32)> {
    let differ = |a: &Rgba<u8>, b: &Rgba<u8>| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 2);
    let pixels = a.enumerate_pixels().zip(b.pixels());
    pixels
        .filter(|((_, _, a), b)| differ(a, b))
        .map(|((x, y, _), _)| (x, y))
        .collect()
}

/// How far a point is inside a clockwise (on the screen) polygon; negative outside.
fn inside(polygon: &[DVec2], at: DVec2) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    polygon
        .iter()
        .zip(next)
        .map(|(a, b)| (*b - *a).normalize().perp_dot(at - *a))
        .fold(f64::INFINITY, f64::min)
}

/// On a plane the footprint is the quadrilateral of the corner points: the fill changes exactly the
/// pixels that projecting them encloses, from any side, also of points.
#[test]
fn a_fill_covers_its_footprint() {
    let gpu = gpu();
    let pose = Pose::from_yaw_pitch_roll(DVec3::new(1.0, -2.0, 9.0), [20.0, -62.0, 5.0]);
    let scene = Scene::plate(30.0, pose);
    let mut renderer = scene.renderer(&gpu);
    let size = DVec2::new(240.0, 160.0);
    let corners = scene.scales[0]
        .corners
        .map(|corner| corner.point().unwrap());
    let mut orbit = Orbit::new(&scene.bounds);
    orbit.center_on(corners.iter().sum::<DVec3>() / 4.0);
    orbit.distance = 28.0;
    for (yaw, pitch, orthographic) in [(0.0, 1.57, true), (2.5, 0.5, false), (0.3, 1.0, true)] {
        (orbit.yaw, orbit.pitch, orbit.orthographic) = (yaw, pitch, orthographic);
        let view = orbit.view();
        let polygon = corners.map(|corner| view.project(corner, size).unwrap());
        let plain = renderer.picture(&view, &mesh(), SIZE).unwrap();
        let fills = Scope::All;
        let filled = renderer
            .picture(&view, &Show { fills, ..mesh() }, SIZE)
            .unwrap();
        let changed = changed(&plain, &filled);
        assert!(changed.len() > 2000, "{}", changed.len());
        for y in 0..SIZE[1] {
            for x in 0..SIZE[0] {
                let depth = inside(&polygon, DVec2::new(f64::from(x), f64::from(y)) + 0.5);
                let is_changed = changed.contains(&(x, y));
                assert!(depth < 1.0 || is_changed, "{x} {y} is inside by {depth}");
                assert!(depth > -1.0 || !is_changed, "{x} {y} is outside by {depth}");
            }
        }
    }
}

/// Off the surface the fill lies on the ground: a camera beside a small plate.
#[test]
fn a_fill_goes_on_over_the_ground() {
    let gpu = gpu();
    let pose = Pose::from_yaw_pitch_roll(DVec3::new(20.0, 0.0, 9.0), [0.0, -90.0, 0.0]);
    let scene = Scene::plate(3.0, pose);
    let mut renderer = scene.renderer(&gpu);
    let view = View::of_photo(
        &scene.cameras[0].0,
        &Pose {
            center: pose.center * 2.0,
            ..pose
        },
        9.0,
    );
    let view = View {
        eye: pose.center.with_z(18.0),
        ..view
    };
    let plain = renderer.picture(&view, &mesh(), SIZE).unwrap();
    let fills = Scope::All;
    let filled = renderer
        .picture(&view, &Show { fills, ..mesh() }, SIZE)
        .unwrap();
    // From twice the height the footprint takes a quarter of the photo's part of the picture, which
    // is 213 x 160 pixels.
    let share = changed(&plain, &filled).len() as f64 / (640.0 / 480.0 * 160.0 * 160.0);
    assert!((share - 0.25).abs() < 0.01, "{share}");
}

/// Two plates one behind the other, 1 : 1.0001 apart: the near one hides the far one at 1 m and at
/// 10 km, whichever is drawn first.
#[test]
fn what_is_near_hides_what_is_far() {
    let gpu = gpu();
    let (red, green) = ([220, 40, 40], [40, 220, 40]);
    for distance in [1.0, 100.0, 10_000.0] {
        for near_first in [true, false] {
            let mut plates = vec![(distance, red), (distance * 1.0001, green)];
            if !near_first {
                plates.reverse();
            }
            let mut points = Vec::new();
            let mut colors = Vec::new();
            for (depth, color) in plates {
                for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                    points.push(DVec3::new(x * distance, depth, z * distance));
                    colors.push(color);
                }
            }
            let triangles = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
            let frame = LocalFrame::near(&Bounds::of(&points).unwrap());
            let none = Normals::default();
            let mesh_geometry =
                MeshGeometry::new(&frame, points.iter().copied(), &colors, &none, &triangles);
            let cloud = CloudGeometry::new(&frame, points.iter().copied(), &colors, &none);
            for projection in [
                Projection::Perspective { fov_y: 0.8 },
                Projection::Orthographic { height: distance },
            ] {
                let view = View {
                    eye: DVec3::ZERO,
                    world_from_view: DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
                    projection,
                    focus: distance,
                };
                let mut renderer = Renderer::new(&gpu);
                renderer.start(&frame);
                renderer.set_mesh(Some(&mesh_geometry));
                let picture = renderer.picture(&view, &mesh(), [32, 32]).unwrap();
                assert!(
                    picture.pixels().all(|p| p[0] > 200 && p[1] < 60),
                    "{distance}"
                );
                // The same as points, of which the corners' are as large as points get.
                renderer.set_mesh(None);
                renderer.set_cloud(Some(&cloud));
                let show = Show {
                    cloud: true,
                    ..nothing()
                };
                let picture = renderer.picture(&view, &show, [32, 32]).unwrap();
                assert!(picture.pixels().all(|p| p[1] < 60), "{distance}");
            }
        }
    }
}

/// Large coordinates change nothing that is seen.
#[test]
fn a_utm_flight_looks_like_the_same_flight_at_the_origin() {
    let gpu = gpu();
    let pictures = [DVec3::ZERO, DVec3::new(500_000.0, 5_000_000.0, 160.0)].map(|origin| {
        let scene = Scene::heap(origin);
        let show = Show {
            images: Scope::All,
            flight_line: true,
            selected: Some(1),
            color_by: ColorBy::Scale,
            ..Show::default()
        };
        let mut renderer = scene.renderer(&gpu);
        let picture = renderer.picture_with_words(&scene.orbit().view(), &show, SIZE);
        picture.unwrap()
    });
    let changed = changed(&pictures[0], &pictures[1]);
    assert!(changed.len() < 8, "{changed:?}");
}

/// A photo whose left half is red and right half is green lands where its camera says, and not on
/// what something else hides from it.
#[test]
fn a_projected_photo_lands_where_its_camera_looks() {
    let gpu = gpu();
    let pose = Pose::from_yaw_pitch_roll(DVec3::new(0.0, 0.0, 9.0), [0.0, -90.0, 0.0]);
    // A plate, and above its eastern half a small roof at half the camera's height.
    let mut points = Vec::new();
    for (half, z, x) in [(30.0, 0.0, 0.0), (0.5, 4.5, 1.2)] {
        for (sx, sy) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            points.push(DVec3::new(x + sx * half, sy * half, z));
        }
    }
    let cloud = Cloud {
        points,
        triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
        ..Cloud::default()
    };
    let scene = Scene::new(cloud, vec![(camera(), pose)], ImageKind::Undistorted);
    let mut renderer = scene.renderer(&gpu);
    let photo = RgbaImage::from_fn(640, 480, |x, _| {
        if x < 320 {
            Rgba([255, 0, 0, 255])
        } else {
            Rgba([0, 255, 0, 255])
        }
    });
    renderer.set_projected_photo(Some((0, &photo)));
    let show = Show {
        project_photo: true,
        selected: Some(0),
        eye_dome: false,
        ..mesh()
    };
    // From the east, low enough to look under the roof.
    let mut orbit = Orbit::new(&scene.bounds);
    (orbit.yaw, orbit.pitch, orbit.distance) = (-1.2, 0.45, 25.0);
    orbit.center_on(DVec3::ZERO);
    let view = orbit.view();
    let picture = renderer.picture(&view, &show, SIZE).unwrap();
    let color = |at: DVec3| {
        let pixel = view.project(at, DVec2::new(240.0, 160.0)).unwrap();
        picture.get_pixel(pixel.x as u32, pixel.y as u32).0
    };
    // fx = 600 at a depth of 9: the footprint reaches 4.8 to both sides and 3.6 up and down.
    assert_eq!(color(DVec3::new(-4.5, 0.0, 0.0)), [255, 0, 0, 255]);
    assert_eq!(color(DVec3::new(-0.4, -3.3, 0.0)), [255, 0, 0, 255]);
    assert_eq!(color(DVec3::new(0.4, 3.3, 0.0)), [0, 255, 0, 255]);
    assert_eq!(color(DVec3::new(4.5, -2.0, 0.0)), [0, 255, 0, 255]);
    assert_eq!(color(DVec3::new(1.2, 0.0, 4.5)), [0, 255, 0, 255]);
    // Behind the roof, which is twice as large on the plate, and beyond the image.
    for hidden in [
        DVec3::new(2.4, 0.0, 0.0),
        DVec3::new(5.2, 0.0, 0.0),
        DVec3::new(0.4, 4.0, 0.0),
    ] {
        let [r, g, b, _] = color(hidden);
        assert!(
            r.abs_diff(g) < 12 && g.abs_diff(b) < 12,
            "{hidden}: {r} {g} {b}"
        );
    }
}

/// Of a level plate under a camera that looks straight down, scale is f / height everywhere.
#[test]
fn the_legend_of_scale_is_focal_length_over_depth() {
    let gpu = gpu();
    let pose = Pose::from_yaw_pitch_roll(DVec3::new(0.0, 0.0, 8.0), [0.0, -90.0, 0.0]);
    let renderer = Scene::plate(30.0, pose).renderer(&gpu);
    let show = Show {
        color_by: ColorBy::Scale,
        selected: Some(0),
        ..mesh()
    };
    let [low, high] = renderer.legend(&show).unwrap().range;
    assert!((low - 75.0).abs() < 1e-3 && (high - 75.0).abs() < 1e-3 && low < high);
    let none = Show {
        selected: None,
        ..show
    };
    assert_eq!(renderer.legend(&none), None);
}

/// Through its camera, a photo's corner points are on the image's corners: for every photo of the
/// sample, of the image that the scales are for.
#[test]
fn corner_points_are_on_the_image_corners() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    let progress = Progress::default();
    let opened = opening::open_flight(&sample, &OpenOptions::default(), &progress).unwrap();
    let flight = &opened.flight;
    let mut count = 0;
    for (photo, outcome) in flight
        .parts()
        .photos
        .iter()
        .zip(flight.scales(&progress).unwrap())
    {
        let fragscale::flight::Outcome::Scale(scale) = outcome else {
            panic!("{} has no scale", photo.name);
        };
        let camera = flight.camera(photo);
        let view = View::of_photo(camera, &photo.pose, 1.0);
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        for corner in &scale.corners {
            let seen = view.project(Corner::point(corner).unwrap(), size).unwrap();
            assert!(seen.distance(corner.pixel) < 1e-6, "{seen}");
            count += 1;
        }
    }
    assert_eq!(count, 36);
}

/// A budget is kept, and what is out of sight is not drawn.
#[test]
fn a_frame_costs_what_is_in_sight() {
    let gpu = gpu();
    // 300 000 points in a row of tiles.
    let frame = LocalFrame::near(&Bounds {
        min: DVec3::ZERO,
        max: DVec3::ZERO,
    });
    let points = (0..300_000).map(|i| DVec3::new(f64::from(i) * 0.01, f64::from(i % 7), 0.0));
    let cloud = CloudGeometry::new(&frame, points, &[], &Normals::default());
    let mut renderer = Renderer::new(&gpu);
    renderer.start(&frame);
    renderer.set_cloud(Some(&cloud));
    let show = Show {
        cloud: true,
        ..nothing()
    };
    let view = |height: f64, x: f64| View {
        eye: DVec3::new(x, 0.0, 10.0),
        world_from_view: DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z),
        projection: Projection::Orthographic { height },
        focus: 10.0,
    };
    let all = renderer.draw(&view(4000.0, 1500.0), &show, [64, 64]);
    assert_eq!((all.points, all.new_texture), (300_000, true));
    let some = renderer.draw(&view(4.0, 100.0), &show, [64, 64]);
    assert!(
        some.points > 0 && some.points < 80_000 && !some.new_texture,
        "{some:?}"
    );
    let few = Show {
        max_points: Some(1000),
        ..show
    };
    let few = renderer.draw(&view(4000.0, 1500.0), &few, [64, 64]);
    assert!(few.points > 980 && few.points <= 1000, "{few:?}");
    // A mesh with too many triangles is stood for by the cloud.
    let heap = Scene::heap(DVec3::ZERO);
    let mut renderer = heap.renderer(&gpu);
    let drawn = |max_points| Show {
        max_points,
        ..mesh()
    };
    let view = heap.orbit().view();
    let whole = renderer.draw(&view, &drawn(Some(5000)), [64, 64]);
    assert_eq!((whole.points, whole.triangles), (0, 2 * 80 * 56));
    let sample = renderer.draw(&view, &drawn(Some(4000)), [64, 64]);
    assert!(sample.points > 3900 && sample.triangles == 0, "{sample:?}");
    assert_eq!(gpu.take_error(), None);
}

/// Hidden photos have nothing drawn, and colours are those asked for.
#[test]
fn looks_are_kept() {
    let gpu = gpu();
    let scene = Scene::heap(DVec3::ZERO);
    let mut renderer = scene.renderer(&gpu);
    let view = scene.orbit().view();
    let show = Show {
        frusta: Scope::All,
        corner_rays: Scope::All,
        outlines: Scope::All,
        fills: Scope::All,
        images: Scope::All,
        background: Background::Color([0; 3]),
        ..nothing()
    };
    let hidden = PhotoLook {
        visible: false,
        ..PhotoLook::default()
    };
    let green = PhotoLook {
        visible: true,
        color: [0, 255, 0],
    };
    renderer.set_looks(&[hidden; 3]);
    let picture = renderer.picture(&view, &show, SIZE).unwrap();
    assert!(picture.pixels().all(|p| p.0 == [0, 0, 0, 255]));
    renderer.set_looks(&[green, hidden, hidden]);
    let picture = renderer.picture(&view, &show, SIZE).unwrap();
    let lit = picture.pixels().filter(|p| p[1] > 200).count();
    assert!(lit > 300, "{lit}");
    assert!(picture.pixels().all(|p| p[0] == 0 && p[2] == 0));
}

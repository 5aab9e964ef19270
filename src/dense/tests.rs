//! Scenes whose depths follow from a formula: rays meet a plane or a step, and the pattern on it is a sum of
//! waves in its own coordinates.

use std::sync::atomic::{AtomicU32, Ordering};

use fragscale_core::split_mix::SplitMix;
use glam::{DMat3, DVec2, DVec3};
use image::{Rgb, RgbImage};

use super::*;
use crate::camera::{Camera, Distortion, Pose};
use crate::found_maps::Outline;
use crate::jobs::Progress;
use crate::patch_match::plane::{Plane, Planes};
use crate::patch_match::{Problem, Sweep};

const SIZE: [u32; 2] = [200, 150];

/// What the cameras look at.
#[derive(Clone, Copy)]
enum Scene {
    /// z = 0.1 x - 0.2 y: inclined to all of them.
    Plane,
    /// z = 0 where x < 0, and z = 1 elsewhere: an edge with a hidden strip.
    Step,
}

impl Scene {
    /// Along the ray, in multiples of its direction.
    fn meet(self, origin: DVec3, direction: DVec3) -> f64 {
        let level = |z: f64| (z - origin.z) / direction.z;
        match self {
            Self::Plane => {
                let normal = DVec3::new(-0.1, 0.2, 1.0);
                -normal.dot(origin) / normal.dot(direction)
            }
            Self::Step => {
                let high = level(1.0);
                if (origin + direction * high).x >= 0.0 {
                    high
                } else {
                    level(0.0)
                }
            }
        }
    }
}

/// A pattern without repetition within the scene, waves of 0.1 to 0.6.
fn pattern(at: DVec3) -> f64 {
    let mut random = SplitMix(5);
    let mut unit = || random.unit();
    let wave = |_: u32| {
        let (turn, length, shift) = (unit() * 6.3, 0.1 + 0.5 * unit(), unit() * 6.3);
        let along = at.x * turn.cos() + at.y * turn.sin() + 0.3 * at.z;
        (along * std::f64::consts::TAU / length + shift).sin()
    };
    128.0 + 20.0 * (0..12).map(wave).sum::<f64>()
}

/// Four cameras in a row, 10 above, a base of 1 apart, turned to the same place, and their photos.
fn views(scene: Scene) -> (Vec<View>, Vec<RgbImage>) {
    let camera = Camera {
        name: String::new(),
        width: SIZE[0],
        height: SIZE[1],
        fx: 400.0,
        fy: 396.0,
        cx: 101.5,
        cy: 74.25,
        skew: 0.5,
        distortion: Distortion::None,
    };
    let view = |x: f64| View {
        camera: camera.clone(),
        pose: Pose {
            rotation: DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z)
                * DMat3::from_rotation_y(-0.08 * x),
            center: DVec3::new(x, 0.1 * x, 10.0 + 0.2 * x),
        },
        depths: [6.0, 16.0],
    };
    let views: Vec<View> = [-1.0, 0.0, 1.0, 2.0].map(view).to_vec();
    let photos = views.iter().map(|view| {
        RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
            let (point, _) = truth(scene, view, x, y);
            let level = pattern(point).clamp(0.0, 255.0).round() as u8;
            Rgb([level; 3])
        })
    });
    let photos = photos.collect();
    (views, photos)
}

/// The place that a pixel shows and its depth.
fn truth(scene: Scene, view: &View, x: u32, y: u32) -> (DVec3, f64) {
    let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let direction = view.pose.rotation * view.camera.direction_undistorted(pixel);
    let depth = scene.meet(view.pose.center, direction);
    (view.pose.center + direction * depth, depth)
}

/// Relative errors of a map's depths, smallest first.
fn errors(scene: Scene, view: &View, map: &DepthMap) -> Vec<f64> {
    let mut errors: Vec<f64> = (0..SIZE[1])
        .flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)))
        .zip(&map.depths)
        .map(|((x, y), depth)| (f64::from(*depth) / truth(scene, view, x, y).1 - 1.0).abs())
        .collect();
    errors.sort_by(f64::total_cmp);
    errors
}

fn found(scene: Scene, backend: &dyn Backend) -> (Vec<View>, Vec<RgbImage>, InMemory) {
    let (views, photos) = views(scene);
    let shelf = InMemory::default();
    maps_of(&views, &photos, backend, &shelf).unwrap();
    (views, photos, shelf)
}

/// The maps of the four views, found or as they lie on the shelf.
fn maps_of<'a>(
    views: &'a [View],
    photos: &dyn Photos,
    backend: &dyn Backend,
    shelf: &'a dyn Shelf,
) -> Result<DepthMaps<'a>, crate::fault::Fault> {
    let neighbours = choose_neighbours(views, 4);
    let options = DenseOptions::of(Quality::Best);
    let progress = Progress::default();
    depth_maps(
        views,
        photos,
        &neighbours,
        &options,
        backend,
        shelf,
        &progress,
    )
}

/// A pixel of disparity is 2.5 % of the depth here: asked for are 0.05 px as the median and 0.25 px nine times of
/// ten.
#[test]
fn a_plane_and_what_is_fused_from_it() {
    let (views, photos, shelf) = found(Scene::Plane, &Cpu);
    let maps = maps_of(&views, &photos, &Cpu, &shelf).unwrap();
    for which in [1, 2] {
        let map = maps.get(which).unwrap().unwrap();
        let errors = errors(Scene::Plane, &views[which], &map);
        assert!(
            errors[errors.len() / 2] < 1.25e-3,
            "{}",
            errors[errors.len() / 2]
        );
        assert!(
            errors[errors.len() * 9 / 10] < 6.25e-3,
            "{}",
            errors[errors.len() * 9 / 10]
        );
    }
    let fused = fuse(&maps, &photos, &Progress::default()).unwrap();
    assert!(fused.points.len() > 20_000, "{}", fused.points.len());
    let mut off: Vec<f64> = fused
        .points
        .iter()
        .map(|p| (p.z - 0.1 * p.x + 0.2 * p.y).abs() / 1.05_f64.sqrt())
        .collect();
    off.sort_by(f64::total_cmp);
    assert!(off[off.len() / 2] < 1.25e-2, "{}", off[off.len() / 2]);
    assert!(fused.noise_pixels < 0.1, "{}", fused.noise_pixels);
}

/// The strip that the step hides from one side is seen from the other.
#[test]
fn a_step_keeps_its_edge() {
    let (views, photos, shelf) = found(Scene::Step, &Cpu);
    let maps = maps_of(&views, &photos, &Cpu, &shelf).unwrap();
    let errors = errors(Scene::Step, &views[1], &maps.get(1).unwrap().unwrap());
    assert!(
        errors[errors.len() / 2] < 1.25e-3,
        "{}",
        errors[errors.len() / 2]
    );
    // The step is 10 % of the depth: what is within 2 % is on the right side of it.
    let right = errors.partition_point(|error| *error < 0.02);
    assert!(
        right * 100 > errors.len() * 93,
        "{right} of {}",
        errors.len()
    );
}

/// The plane's true depths and slopes, with noise of so many pixels of matching.
fn exact_maps(noise: f64) -> (Vec<View>, Vec<RgbImage>, InMemory) {
    let (views, photos) = views(Scene::Plane);
    let mut random = SplitMix(9);
    // Twelve uniform numbers less six: nearly a normal one.
    let mut normal = || (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
    let shelf = InMemory::default();
    for (which, view) in views.iter().enumerate() {
        let depth = |x: u32, y: u32| truth(Scene::Plane, view, x, y).1;
        let slope = [
            (depth(101, 75).recip() - depth(100, 75).recip()) as f32,
            (depth(100, 76).recip() - depth(100, 75).recip()) as f32,
        ];
        let mut planes = Vec::new();
        for y in 0..SIZE[1] {
            for x in 0..SIZE[0] {
                let inverse = depth(x, y).recip() + normal() * noise * PER_PIXEL;
                planes.push(Plane {
                    inverse_depth: inverse as f32,
                    slope,
                    cost: 0.0,
                });
            }
        }
        let planes = Planes {
            width: SIZE[0] as usize,
            height: SIZE[1] as usize,
            planes,
        };
        let name = crate::found_maps::final_name(which);
        shelf.put(&name, planes.to_bytes()).unwrap();
    }
    (views, photos, shelf)
}

/// What a pixel of noise is in the exact maps.
const PER_PIXEL: f64 = 1.0 / 400.0;

/// The maps on such a shelf.
fn of_exact<'a>(views: &'a [View], shelf: &'a InMemory) -> DepthMaps<'a> {
    let outlines = (choose_neighbours(views, 4).into_iter()).zip(views);
    let outlines = outlines.map(|(neighbours, view)| {
        Some(Outline {
            camera: view.camera.clone(),
            halvings: 0,
            per_pixel: PER_PIXEL as f32,
            neighbours,
        })
    });
    DepthMaps::new(views, outlines.collect(), shelf)
}

#[test]
fn exact_maps_are_fused_onto_the_plane() {
    let (views, photos, shelf) = exact_maps(0.0);
    let maps = of_exact(&views, &shelf);
    let fused = fuse(&maps, &photos, &Progress::default()).unwrap();
    for (point, views) in fused.points.iter().zip(&fused.views) {
        assert!(
            (point.z - 0.1 * point.x + 0.2 * point.y).abs() < 2e-5,
            "{point}"
        );
        assert!((3..=4).contains(views));
    }
    // Colours are those of the pattern there, which is drawn at pixels' centres.
    let near = |i: &usize| {
        let level = pattern(fused.points[*i]).clamp(0.0, 255.0);
        (f64::from(fused.colors[*i][0]) - level).abs() < 40.0
    };
    let right = (0..fused.points.len()).filter(near).count();
    assert!(right * 10 > fused.points.len() * 9);
}

/// A hole in one map, as deep as the scene: what stands around it within half a window may be in front of it or not, and nothing
/// supports it there; farther off everything is as before. One pixel alone is a depth that was not found, and spoils no other.
#[test]
fn nothing_supports_what_stands_before_a_hole() {
    let name = crate::found_maps::final_name(0);
    let [width, height] = SIZE.map(|side| side as usize);
    let (column, row) = (100, 75);
    for (half, reach) in [(0, [0, 0]), (1, [2, 3])] {
        let (views, _, shelf) = exact_maps(0.0);
        let mut planes = Planes::from_bytes(&shelf.get(&name).unwrap(), width, height).unwrap();
        for x in column - half..=column + half {
            planes.planes[row * width + x].inverse_depth *= 0.5;
        }
        shelf.put(&name, planes.to_bytes()).unwrap();
        let map = of_exact(&views, &shelf).graded(0).unwrap().unwrap();
        for y in row - 5..=row + 5 {
            for x in column - 5..=column + 5 {
                let is_beside = x.abs_diff(column) <= reach[0] && y.abs_diff(row) <= reach[1];
                let supports = map.supports[y * width + x];
                assert_eq!(supports < 2, is_beside, "{supports} at {x}, {y}");
            }
        }
    }
}

/// Noise of 0.1 px that is independent from pixel to pixel: found again within 3 %, and the points scatter as
/// their standard errors say within 5 %.
#[test]
fn the_standard_error_is_the_scatter() {
    let (views, photos, shelf) = exact_maps(0.1);
    let maps = of_exact(&views, &shelf);
    let fused = fuse(&maps, &photos, &Progress::default()).unwrap();
    assert!(
        (fused.noise_pixels - 0.1).abs() < 0.003,
        "{}",
        fused.noise_pixels
    );
    // Along the mean viewing ray, which is nearly the vertical here: the plane's inclination makes up for
    // the rest.
    let mut sum = 0.0;
    for (point, error) in fused.points.iter().zip(&fused.standard_errors) {
        let normal = DVec3::new(-0.1, 0.2, 1.0);
        let ray = (*point - DVec3::new(0.5, 0.05, 10.1)).normalize();
        let along = normal.dot(*point) / normal.dot(ray);
        sum += (along / f64::from(*error)).powi(2);
    }
    let ratio = (sum / fused.points.len() as f64).sqrt();
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    // All views err alike at most: a view alone, here 0.1 px of 2.5 % of a depth of 10 and a little more.
    let deviation = fused.deviation().unwrap();
    assert!((0.025..0.03).contains(&deviation), "{deviation}");
}

/// Cells of 3 by 3 pixels make about a ninth of the points, as exact as the others, all over the plane, and what
/// four photos show becomes one point.
#[test]
fn cells_make_fewer_points() {
    let (views, photos, shelf) = exact_maps(0.0);
    let maps = of_exact(&views, &shelf);
    let progress = Progress::default();
    let all = crate::fusion::fuse_cells(&maps, &photos, 1, &progress).unwrap();
    let few = crate::fusion::fuse_cells(&maps, &photos, 3, &progress).unwrap();
    let ratio = all.points.len() as f64 / few.points.len() as f64;
    assert!((7.0..13.0).contains(&ratio), "{ratio}");
    for point in &few.points {
        assert!((point.z - 0.1 * point.x + 0.2 * point.y).abs() < 2e-5);
    }
    // A pixel is 0.025 wide on the plane: squares of 0.25 have 11 cells each, inside of what three photos see.
    let mut squares = std::collections::HashMap::new();
    for point in &few.points {
        let square = (
            (point.x * 4.0).floor() as i32,
            (point.y * 4.0).floor() as i32,
        );
        *squares.entry(square).or_insert(0) += 1;
    }
    for x in -4..6 {
        for y in -4..4 {
            let count = squares.get(&(x, y)).copied().unwrap_or(0);
            assert!((6..20).contains(&count), "{x} {y}: {count}");
        }
    }
}

#[test]
fn what_cannot_be_done_is_said() {
    let (views, photos) = views(Scene::Plane);
    let options = DenseOptions::of(Quality::Normal);
    let run = |views: &[View], photos: &Vec<RgbImage>, neighbours: &[Vec<usize>]| {
        let shelf = InMemory::default();
        depth_maps(
            views,
            photos,
            neighbours,
            &options,
            &Cpu,
            &shelf,
            &Progress::default(),
        )
        .err()
    };
    let none = run(&views, &photos, &vec![Vec::new(); 4]).unwrap();
    assert!(none.what.contains("no photo sees"), "{none}");
    let strange = run(&views, &photos, &[vec![7]]).unwrap();
    assert!(strange.what.contains("neighbours"), "{strange}");
    let mut other = photos.clone();
    other[2] = RgbImage::new(5, 5);
    let size = run(&views, &other, &[vec![1]]).unwrap();
    assert!(size.what.contains("5 x 5"), "{size}");
    let mut bad = views.clone();
    bad[0].depths = [3.0, 3.0];
    assert!(
        run(&bad, &photos, &[vec![1]])
            .unwrap()
            .what
            .contains("range")
    );
    // A view alone, and two that look at the same from the same place.
    assert_eq!(choose_neighbours(&views[..1], 4), [Vec::<usize>::new()]);
    let twice = [views[0].clone(), views[0].clone()];
    assert_eq!(choose_neighbours(&twice, 4), [vec![], Vec::<usize>::new()]);
}

/// Photos of one and of 3 x 2 pixels have depths, if no good ones.
#[test]
fn tiny_photos() {
    for (width, height) in [(1, 1), (3, 2), (1, 7)] {
        let (mut views, _) = views(Scene::Plane);
        for view in &mut views {
            (view.camera.width, view.camera.height) = (width, height);
        }
        let photos = vec![RgbImage::new(width, height); 4];
        let neighbours = [vec![1], vec![0, 2], vec![], vec![]];
        let options = DenseOptions::of(Quality::Best);
        let progress = Progress::default();
        let shelf = InMemory::default();
        let maps = depth_maps(
            &views,
            &photos,
            &neighbours,
            &options,
            &Cpu,
            &shelf,
            &progress,
        )
        .unwrap();
        let map = maps.get(1).unwrap().unwrap();
        assert_eq!(map.depths.len(), (width * height) as usize);
        assert!(maps.get(2).unwrap().is_none());
    }
}

/// Cancels itself at a sweep.
struct Cancelling {
    at: u32,
    calls: AtomicU32,
}

impl Backend for Cancelling {
    fn name(&self) -> String {
        String::new()
    }

    fn sweep(
        &self,
        problem: &Problem,
        planes: &mut Planes,
        sweeps: &[Sweep],
        progress: &Progress,
    ) -> Result<(), crate::fault::Fault> {
        if self.calls.fetch_add(1, Ordering::Relaxed) == self.at {
            progress.cancel();
        }
        Cpu.sweep(problem, planes, sweeps, progress)
    }
}

/// At the next look, and what was found until then is not looked for again: the same maps come out, to the bit.
#[test]
fn cancelled_at_once_and_gone_on() {
    let (views, photos, whole) = found(Scene::Plane, &Cpu);
    let neighbours = choose_neighbours(&views, 4);
    let options = DenseOptions::of(Quality::Best);
    let shelf = InMemory::default();
    // A photo has a sweep a size, one here, and then one with the others' depths.
    let mut calls = Vec::new();
    for at in [1, 4, u32::MAX] {
        let backend = Cancelling {
            at,
            calls: AtomicU32::new(0),
        };
        let progress = Progress::default();
        let maps = depth_maps(
            &views,
            &photos,
            &neighbours,
            &options,
            &backend,
            &shelf,
            &progress,
        );
        calls.push(backend.calls.load(Ordering::Relaxed));
        if at == u32::MAX {
            let maps = maps.unwrap();
            for which in 0..4 {
                let name = crate::found_maps::final_name(which);
                assert!(shelf.get(&name) == whole.get(&name), "{which}");
                assert!(shelf.get(&format!("first-{which}")).is_none());
                let graded = maps.graded(which).unwrap().unwrap();
                assert!(graded.supports.contains(&3));
            }
        } else {
            assert_eq!(maps.err().unwrap().what, "cancelled");
        }
    }
    assert_eq!(calls, [2, 5, 3]);
}

#[cfg(feature = "gpu")]
mod on_a_card {
    use super::*;

    #[test]
    fn the_shader_is_valid() {
        let text = include_str!("../../shaders/patch_match.wgsl");
        let module = naga::front::wgsl::parse_str(text).unwrap();
        naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::empty(),
        )
        .validate(&module)
        .unwrap();
    }

    /// Sums run in another order, so that near ties fall otherwise at some pixels, which then hand on other
    /// planes: nine of ten within 0.1 % (0.04 px), and as good as each other in the middle.
    #[test]
    fn the_card_counts_as_the_processor() {
        let gpu = Gpu::on(fragscale_render::Gpu::fastest().unwrap()).unwrap();
        let (views, photos, own) = found(Scene::Plane, &Cpu);
        let (_, _, theirs) = found(Scene::Plane, &gpu);
        let own = maps_of(&views, &photos, &Cpu, &own).unwrap();
        let theirs = maps_of(&views, &photos, &gpu, &theirs).unwrap();
        for which in [1, 2] {
            let (a, b) = (
                own.get(which).unwrap().unwrap(),
                theirs.get(which).unwrap().unwrap(),
            );
            let same = a.depths.iter().zip(&b.depths);
            let same = same.filter(|(a, b)| (*a / *b - 1.0).abs() < 1e-3).count();
            assert!(
                same * 10 > a.depths.len() * 9,
                "{same} of {}",
                a.depths.len()
            );
            let median =
                |map: &DepthMap| errors(Scene::Plane, &views[which], map)[a.depths.len() / 2];
            assert!(
                (median(&a) - median(&b)).abs() < 3e-5,
                "{} {}",
                median(&a),
                median(&b)
            );
        }
    }
}

//! The simulated lab against its own truth.

mod drawn_errors;
mod fitted;
mod survey;

use serde_json::Value;

use super::*;
use crate::camera::Camera;
use crate::flight::Outcome;
use crate::formats::{DistributionColumns, read_cloud, read_size_distributions};
use crate::opening::{OpenOptions, open_flight};
use crate::scale::EdgeScales;

fn options() -> SampleOptions {
    SampleOptions {
        preset: Preset::Lab,
        seed: 7,
        lens: Lens::Brown,
        true_mesh: true,
        noise_px: None,
        points: Some(2000),
        ring: 0,
        survey: None,
        photos: false,
        labels: false,
        at_origin: false,
        errors: DrawnErrors::default(),
    }
}

/// A preset with a small pile, for tests: two photos.
fn small(options: &SampleOptions) -> Recipe {
    let mut recipe = recipe(options).unwrap();
    let k = recipe.sphere / 0.06;
    recipe.pile.half_extent = DVec2::new(0.42, 0.46) * k;
    recipe.pile.smallest = 0.007 * k;
    recipe.reach = DVec2::new(1.2, 1.2) * k;
    recipe.flight.count = [1, 2];
    recipe
}

fn made(options: &SampleOptions, recipe: &Recipe) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fill(folder.path(), recipe, options, &Progress::default()).unwrap();
    folder
}

fn scales(folder: &Path) -> Vec<EdgeScales> {
    let progress = Progress::default();
    let opened = open_flight(folder, &OpenOptions::default(), &progress).unwrap();
    let outcomes = opened.flight.scales(&progress).unwrap();
    outcomes
        .into_iter()
        .map(|outcome| match outcome {
            Outcome::Scale(scale) => scale.scale,
            Outcome::Trouble(trouble) => panic!("{trouble}"),
        })
        .collect()
}

fn truth_of(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("truth.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn true_scales(folder: &Path, image: &str) -> Vec<EdgeScales> {
    let truth = truth_of(folder);
    let photos = truth["photos"].as_array().unwrap();
    photos
        .iter()
        .map(|photo| {
            let edge = |name: &str| photo[image]["scale"][name].as_f64();
            EdgeScales {
                top: edge("top"),
                right: edge("right"),
                bottom: edge("bottom"),
                left: edge("left"),
            }
        })
        .collect()
}

fn assert_same(computed: &[EdgeScales], expected: &[EdgeScales], tolerance: f64) {
    assert_eq!(computed.len(), expected.len());
    for (a, b) in computed.iter().zip(expected) {
        for (a, b) in [
            (a.top, b.top),
            (a.right, b.right),
            (a.bottom, b.bottom),
            (a.left, b.left),
        ] {
            let (a, b) = (a.unwrap(), b.unwrap());
            assert!((a / b - 1.0).abs() < tolerance, "{a} is not {b}");
        }
    }
}

/// On the true surface as a mesh the scales are the truth, undistorted and as shot, for every place
/// and lens.
#[test]
fn the_true_mesh_gives_the_true_scales() {
    for (preset, lens) in [
        (Preset::Lab, Lens::Brown),
        (Preset::Muckpile, Lens::Fisheye),
        (Preset::Stockpile, Lens::None),
        (Preset::Bench, Lens::Brown),
    ] {
        let options = SampleOptions {
            preset,
            lens,
            ..options()
        };
        let folder = made(&options, &small(&options));
        let computed = scales(folder.path());
        assert_same(&computed, &true_scales(folder.path(), "undistorted"), 1e-9);
        fitted::assert_truth_is_that_of_the_written_mesh(folder.path());
        let flight = folder.path().join("flight.toml");
        let text = fs::read_to_string(&flight).unwrap() + "\n[scale]\nimage = \"as-shot\"\n";
        fs::write(&flight, text).unwrap();
        let computed = scales(folder.path());
        assert_same(&computed, &true_scales(folder.path(), "as_shot"), 1e-9);
    }
}

/// The same pile in UTM coordinates and at the origin.
#[test]
fn utm_coordinates_change_no_scale() {
    let far = SampleOptions {
        preset: Preset::Muckpile,
        ..options()
    };
    let near = SampleOptions {
        at_origin: true,
        ..far
    };
    let (far, near) = (made(&far, &small(&far)), made(&near, &small(&near)));
    assert_same(&scales(far.path()), &scales(near.path()), 1e-9);
}

/// Scales from a noisy cloud are near the truth: what is lost is the relief between its points.
#[test]
fn the_cloud_gives_scales_near_the_truth() {
    let options = SampleOptions {
        true_mesh: false,
        points: Some(20_000),
        ..options()
    };
    let folder = made(&options, &small(&options));
    assert_same(
        &scales(folder.path()),
        &true_scales(folder.path(), "undistorted"),
        0.04,
    );
    // Nothing is matched in the dark, and little in the dusk: a fifth of the pixels of a muckpile's photos are under 30
    // of 255 levels, 38 of 100 under 60.
    let cloud = read_cloud(&folder.path().join("pile.ply"), &Progress::default())
        .unwrap()
        .cloud;
    let light = |color: &[u8; 3]| color.iter().map(|part| f64::from(*part)).sum::<f64>() / 3.0;
    let under = |level: f64| {
        cloud
            .colors
            .iter()
            .filter(|color| light(color) < level)
            .count()
    };
    assert_eq!((cloud.colors.len(), under(30.0)), (20_000, 0));
    assert!((1..2000).contains(&under(60.0)), "{}", under(60.0));
}

/// The mass passing of 20 000 drawn fragments follows the asked Swebrec: at each sieve within 4.5
/// standard errors of a ratio of sums (the largest of eight correlated normal deviates passes 4.5
/// once in 20 000 runs; the seed is fixed).
#[test]
fn the_pile_follows_its_distribution() {
    let recipe = recipe(&options()).unwrap();
    let plan = PilePlan {
        thickness: 0.004,
        ..recipe.pile
    };
    let random = Random::new(3);
    let bodies: Vec<_> = (0..40)
        .map(|i| scene::fragment::Body::random(scene::fragment::BROKEN, &mut random.fork(i)))
        .collect();
    let fragments = scene::pile::draw_sizes(&plan, &bodies, &mut random.fork(99)).unwrap();
    assert!(fragments.len() > 10_000, "{}", fragments.len());
    let masses: Vec<(f64, f64)> = fragments
        .iter()
        .map(|f| (f.size, bodies[f.body].volume() * f.size.powi(3)))
        .collect();
    let total: f64 = masses.iter().map(|(_, mass)| mass).sum();
    let fines = plan.sizes.passing(plan.smallest);
    for step in 1..=8 {
        let size = plan.smallest * 1.22_f64.powi(step);
        let expected = (plan.sizes.passing(size) - fines) / (1.0 - fines);
        let passed = |s: f64| if s <= size { 1.0 } else { 0.0 };
        let found: f64 = masses.iter().map(|(s, m)| m * passed(*s)).sum::<f64>() / total;
        let variance: f64 = masses
            .iter()
            .map(|(s, m)| (m * (passed(*s) - expected)).powi(2))
            .sum();
        let error = variance.sqrt() / total;
        assert!(
            (found - expected).abs() < 4.5 * error,
            "{size}: {found} instead of {expected} +- {error}"
        );
    }
}

/// reference.csv is the sieve analysis of the very fragments that truth.json lists, on top of the
/// fines: two files, summed up here once more.
#[test]
fn the_reference_is_the_sieve_analysis_of_the_truth() {
    let options = options();
    let recipe = small(&options);
    let folder = made(&options, &recipe);
    let truth = truth_of(folder.path());
    let fragments: Vec<(f64, f64)> = truth["fragments"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| (f[0].as_f64().unwrap(), f[1].as_f64().unwrap()))
        .collect();
    let total: f64 = fragments.iter().map(|(_, volume)| volume).sum();
    let fines = recipe.pile.sizes.passing(recipe.pile.smallest);
    let reference = fs::read_to_string(folder.path().join("reference.csv")).unwrap();
    let mut sieves_above_the_fines = 0;
    for line in reference.lines().skip(1) {
        let (size, percent) = line.split_once(',').unwrap();
        let (size, percent): (f64, f64) = (size.parse().unwrap(), percent.parse().unwrap());
        let size = size / 1000.0;
        if size > recipe.pile.smallest {
            let passed = fragments.iter().filter(|(s, _)| *s <= size);
            let share = passed.map(|(_, volume)| volume).sum::<f64>() / total;
            let expected = 100.0 * (fines + (1.0 - fines) * share);
            // truth.json has five digits: a fragment at the very opening may change sides.
            assert!(
                (percent - expected).abs() < 0.1,
                "{size}: {percent}, not {expected}"
            );
            sieves_above_the_fines += 1;
        }
    }
    assert!(sieves_above_the_fines >= 3);
}

/// distributions.csv reads back: the sieve's curve is reference.csv, each photo has one by each kind of
/// scale, and where the one scale of a photo is larger than the other everywhere, its fragments are
/// smaller.
#[test]
fn the_distributions_are_the_reference_and_two_of_each_photo() {
    let options = SampleOptions {
        photos: true,
        ..options()
    };
    let mut recipe = small(&options);
    recipe.camera = recipe.camera.rescaled(320, 180).unwrap();
    let folder = made(&options, &recipe);
    let read = |name: &str| {
        let columns = DistributionColumns::default();
        let path = folder.path().join(name);
        let (set, warnings) = read_size_distributions(&path, &columns).unwrap();
        assert!(warnings.is_empty(), "{warnings:?}");
        assert_eq!(set.unit, LengthUnit::Millimetre);
        set.curves
    };
    let (curves, reference) = (read("distributions.csv"), read("reference.csv"));
    let names: Vec<String> = curves.iter().map(|c| c.labels.to_string()).collect();
    assert_eq!(
        names,
        [
            "sieve",
            "point cloud / 1 / IMG_0001.jpg",
            "point cloud / 2 / IMG_0002.jpg",
            "scale object / 1 / IMG_0001.jpg",
            "scale object / 2 / IMG_0002.jpg",
        ]
    );
    assert_eq!(curves[0].distribution, reference[0].distribution);
    assert_eq!(curves[0].weight, None);
    for (by_rows, by_sphere) in [(1, 3), (2, 4)] {
        let scale = |curve: usize| 1.0 / curves[curve].weight.unwrap().sqrt();
        let median = |curve: usize| curves[curve].distribution.size_at(50.0).unwrap();
        let (scales, sizes) = (
            scale(by_rows) / scale(by_sphere),
            median(by_sphere) / median(by_rows),
        );
        // Few fragments, at sieves a factor of 1.4 apart: the medians are no finer than this.
        assert!((sizes / scales - 1.0).abs() < 0.15, "{sizes} {scales}");
        // What is seen is a pile of these fragments: half of the mass passes near the sieve's half.
        let off = median(by_rows) / reference[0].distribution.size_at(50.0).unwrap();
        assert!((0.5..2.5).contains(&off), "{off}");
    }
}

/// Fragments hardly share space: of points drawn inside fragments few lie inside another one.
#[test]
fn fragments_lie_on_each_other_and_not_in_each_other() {
    let recipe = small(&options());
    let pile = Pile::strew(&recipe.pile, &mut Random::new(5), &Progress::default()).unwrap();
    let inside = |fragment: &Fragment, point: DVec3| {
        let own = fragment.rotation.inverse() * (point - fragment.center) / fragment.size;
        let planes = pile.bodies[fragment.body].planes();
        planes
            .iter()
            .all(|plane| plane.normal.dot(own) <= plane.offset)
    };
    let (mut drawn, mut shared) = (0, 0);
    for fragment in &pile.fragments {
        // Halfway to each corner is well inside a convex body.
        for vertex in pile.bodies[fragment.body].vertices().iter().take(4) {
            let point = fragment.center + fragment.rotation * (*vertex * fragment.size * 0.7);
            drawn += 1;
            let near = pile.fragments.iter().filter(|other| {
                (other.center - fragment.center).length() < other.size * 2.0 && *other != fragment
            });
            shared += usize::from(near.into_iter().any(|other| inside(other, point)));
        }
    }
    assert!(
        drawn > 1000 && shared * 50 < drawn,
        "{shared} of {drawn} points are shared"
    );
}

/// A sphere's image gives the scale at its place within 1 %: its area, by the formula for a sphere
/// in perspective (an ellipse), tells its distance.
#[test]
fn the_spheres_images_give_the_scale() {
    let options = options();
    let recipe = small(&options);
    let random = Random::new(options.seed);
    let shots = recipe.flight.fly(&mut random.fork(20));
    let scene = build_scene(&recipe, &shots, &random, &Progress::default()).unwrap();
    let mut caster = scene.caster().unwrap();
    for (index, shot) in shots.iter().enumerate() {
        let (camera, pose): (&Camera, _) = (&recipe.camera, shot.pose());
        let sphere = scene.spheres()[index];
        let center = pose.camera_from_world(sphere.center);
        let middle = camera.pixel_undistorted(center).unwrap();
        // Its own pixels, a quarter of a pixel apart.
        let reach = camera.fx * sphere.radius / center.z * 1.3;
        let steps = (reach * 4.0) as i32;
        let mut quarters = 0;
        for row in -steps..=steps {
            for column in -steps..=steps {
                let pixel = middle + DVec2::new(f64::from(column), f64::from(row)) * 0.25;
                let direction = pose.rotation * camera.direction_undistorted(pixel);
                let ray = Ray {
                    origin: pose.center,
                    direction: direction.normalize(),
                };
                let met = caster.cast(&ray);
                quarters += u32::from(met.is_some_and(|m| m.thing == Thing::Sphere(index)));
            }
        }
        let area = f64::from(quarters) / 16.0;
        // pi fx fy s2 c / (c2 - s2)^1.5 with s = sin of the half angle, c = cosine off the axis.
        let cosine = center.z / center.length();
        let area_at = |distance: f64| {
            let sine2 = (sphere.radius / distance).powi(2);
            std::f64::consts::PI * camera.fx * camera.fy * sine2 * (1.0 - sine2).sqrt() * cosine
                / (cosine * cosine - sine2).powf(1.5)
        };
        let (mut low, mut high) = (center.length() * 0.5, center.length() * 2.0);
        for _ in 0..60 {
            let mid = (low + high) / 2.0;
            if area_at(mid) > area {
                low = mid;
            } else {
                high = mid;
            }
        }
        let off = low / center.length() - 1.0;
        assert!(off.abs() < 0.01, "{}: off by {off}", shot.name);
    }
}

/// The bundled flight's text files are what the command makes today.
#[test]
fn the_bundled_flight_is_what_the_command_makes() {
    let bundled = fragscale_test_data::repository().join("assets/sample");
    let options = SampleOptions {
        seed: 1,
        true_mesh: false,
        ..options()
    };
    let folder = made(&options, &recipe(&options).unwrap());
    for name in [
        "flight.toml",
        "poses.csv",
        "ost.yaml",
        "reference.csv",
        "truth.json",
    ] {
        let (here, there) = (folder.path().join(name), bundled.join(name));
        let mut made = fs::read(here).unwrap();
        if name == "flight.toml" {
            // Here no photos were taken.
            made.extend(b"folder = \"photos\"\n");
        }
        let same = made == fs::read(there).unwrap();
        assert!(
            same,
            "{name} differs; make the bundled flight anew (see docs/sample.md)"
        );
    }
}

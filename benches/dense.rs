//! How good and how fast dense stereo is on a simulated flight whose depths are known.
//!
//! ```text
//! fragscale sample muckpile --preset muckpile --ring 24 --lens none --no-labels
//! fragscale sample mesh --preset muckpile --ring 24 --lens none --no-labels --no-photos --surface mesh
//! fragscale scale-map mesh/flight.toml --all --layers depth -o depth
//! cargo bench -p fragscale-dense --features gpu -- muckpile depth [--gpu] [--views RING_0001,RING_0002]
//! ```
//!
//! Per photo: the relative errors of the depth along the optical axis, over all pixels and over the more
//! confident half; seconds of all cores per megapixel and view.

#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    missing_docs,
    reason = "in a test or a benchmark a panic is the report"
)]

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use fragscale_core::camera::{Camera, Distortion, Pose};
use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use fragscale_dense::{
    Backend, Cpu, DenseOptions, DepthMap, InMemory, Photos, Quality, View, choose_neighbours,
    depth_maps, fuse,
};
use glam::DVec3;
use image::RgbImage;

struct Files(Vec<PathBuf>);

impl Photos for Files {
    fn photo(&self, view: usize) -> Result<RgbImage, Fault> {
        Ok(image::open(&self.0[view]).expect("a photo").into_rgb8())
    }
}

/// The ROS calibration counts pixels from the first one's centre.
fn camera(folder: &Path) -> Camera {
    let text = fs::read_to_string(folder.join("ost.yaml")).expect("ost.yaml");
    let data = text.split("data: [").nth(1).expect("a matrix");
    let numbers: Vec<f64> = data
        .split(']')
        .next()
        .expect("numbers")
        .split(',')
        .map(|number| number.trim().parse().expect("a number"))
        .collect();
    Camera {
        name: String::new(),
        width: 1280,
        height: 720,
        fx: numbers[0],
        fy: numbers[4],
        cx: numbers[2] + 0.5,
        cy: numbers[5] + 0.5,
        skew: numbers[1],
        distortion: Distortion::None,
    }
}

fn poses(folder: &Path) -> Vec<(String, Pose)> {
    let text = fs::read_to_string(folder.join("poses.csv")).expect("poses.csv");
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|row| {
        let fields: Vec<&str> = row.split(',').collect();
        let numbers: Vec<f64> = fields[1..].iter().filter_map(|f| f.parse().ok()).collect();
        let center = DVec3::new(numbers[0], numbers[1], numbers[2]);
        let pose = match numbers[3..] {
            [tilt, pan] => Pose::from_yaw_pitch_roll(center, [pan, -tilt, 0.0]),
            [x, y, z, w] => Pose::from_quaternion(center, [x, y, z, w]).expect("a rotation"),
            _ => panic!("{row}"),
        };
        (fields[0].to_owned(), pose)
    })
    .collect()
}

/// True depths; not finite where the ray meets nothing.
fn truth(folder: &Path, name: &str) -> Vec<f32> {
    let path = folder.join(format!("{name}_scale.tif"));
    let file = fs::File::open(path).expect("a depth map");
    let mut decoder = tiff::decoder::Decoder::new(std::io::BufReader::new(file)).expect("TIFF");
    match decoder.read_image().expect("depths") {
        tiff::decoder::DecodingResult::F32(depths) => depths,
        tiff::decoder::DecodingResult::F64(depths) => {
            depths.into_iter().map(|depth| depth as f32).collect()
        }
        _ => panic!("no depths"),
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    let value = |name: &str| {
        let at = arguments.iter().position(|argument| argument == name)?;
        arguments.get(at + 1).cloned()
    };
    let has = |name: &str| arguments.iter().any(|argument| argument == name);
    let [folder, depth_folder, ..] = arguments.as_slice() else {
        println!("dense: nothing to do without a sample's folder and one of its true depths");
        return;
    };
    let (folder, depth_folder) = (Path::new(folder), Path::new(depth_folder));
    let wanted = value("--views").unwrap_or_else(|| "RING".to_owned());
    let is_wanted = |name: &str| wanted.split(',').any(|part| name.contains(part));
    let poses: Vec<_> = poses(folder)
        .into_iter()
        .filter(|(n, _)| is_wanted(n))
        .collect();
    let names: Vec<&str> = poses
        .iter()
        .map(|(name, _)| name.trim_end_matches(".jpg"))
        .collect();
    let truths: Vec<_> = names.iter().map(|name| truth(depth_folder, name)).collect();
    let camera = camera(folder);
    let views: Vec<_> = poses
        .iter()
        .zip(&truths)
        .map(|((_, pose), truth)| {
            let seen = || {
                truth
                    .iter()
                    .filter(|depth| depth.is_finite() && **depth > 0.0)
            };
            let near = seen().fold(f32::MAX, |a, b| a.min(*b));
            let far = seen().fold(0.0_f32, |a, b| a.max(*b));
            View {
                camera: camera.clone(),
                pose: *pose,
                depths: [0.8 * f64::from(near), 1.25 * f64::from(far)],
            }
        })
        .collect();
    let photos = Files(
        poses
            .iter()
            .map(|(name, _)| folder.join("photos").join(name))
            .collect(),
    );
    let mut options = DenseOptions::of(Quality::Best);
    if let Some(sweeps) = value("--sweeps") {
        options.sweeps = sweeps.parse().expect("a number");
    }
    if let Some(sweeps) = value("--geometric") {
        options.geometric_sweeps = sweeps.parse().expect("a number");
    }
    let neighbours = choose_neighbours(&views, options.neighbours);
    println!("{:?} {:?} {:?}", views[0].depths, &neighbours[..2], options);
    let run = |backend: &dyn Backend| {
        let begin = (Instant::now(), cpu_seconds());
        let (progress, shelf) = (Progress::default(), InMemory::default());
        let maps = depth_maps(
            &views,
            &photos,
            &neighbours,
            &options,
            backend,
            &shelf,
            &progress,
        );
        let maps = maps.expect("depths");
        let took = (begin.0.elapsed().as_secs_f64(), cpu_seconds() - begin.1);
        let graded: Vec<DepthMap> = (0..maps.len())
            .filter_map(|which| maps.graded(which).expect("a map"))
            .collect();
        let megapixels: f64 = graded.iter().map(|map| map.depths.len() as f64 / 1e6).sum();
        println!(
            "{}: {:.2} s a megapixel and view, {:.2} seconds of cores",
            backend.name(),
            took.0 / megapixels,
            took.1 / megapixels
        );
        report(&names, &graded, &truths);
        if has("--fuse") {
            let begin = Instant::now();
            let fused = fuse(&maps, &photos, &progress).expect("points");
            let mut errors = fused.standard_errors.clone();
            errors.sort_by(f32::total_cmp);
            println!(
                "fused: {} points in {:.1} s, matching noise {:.3} px, median standard error {:.4}",
                fused.points.len(),
                begin.elapsed().as_secs_f64(),
                fused.noise_pixels,
                errors.get(errors.len() / 2).copied().unwrap_or(f32::NAN)
            );
        }
        graded
    };
    let on_cpu = (!has("--no-cpu")).then(|| run(&Cpu));
    #[cfg(feature = "gpu")]
    if has("--gpu") {
        let card = fragscale_render::Gpu::fastest().expect("a graphics device");
        let on_gpu = run(&fragscale_dense::Gpu::on(card).expect("a shader that it takes"));
        if let Some(on_cpu) = on_cpu {
            compare(&on_cpu, &on_gpu);
        }
        return;
    }
    drop(on_cpu);
}

fn report(names: &[&str], maps: &[DepthMap], truths: &[Vec<f32>]) {
    let mut sums = [0.0; 6];
    for ((name, map), truth) in names.iter().zip(maps).zip(truths) {
        let mut errors: Vec<(f32, f32)> = map
            .depths
            .iter()
            .zip(truth)
            .zip(&map.confidences)
            .filter(|((_, truth), _)| truth.is_finite() && **truth > 0.0)
            .map(|((depth, truth), confidence)| (*confidence, (depth / truth - 1.0).abs()))
            .collect();
        let figures = |errors: &[(f32, f32)]| {
            let mut errors: Vec<f32> = errors.iter().map(|(_, error)| *error).collect();
            errors.sort_by(f32::total_cmp);
            let within = errors.partition_point(|error| *error <= 0.01);
            let median = f64::from(errors[errors.len() / 2]);
            [100.0 * median, 100.0 * within as f64 / errors.len() as f64]
        };
        let all = figures(&errors);
        errors.sort_by(|a, b| b.0.total_cmp(&a.0));
        let half = figures(&errors[..errors.len() / 2]);
        if names.len() < 6 {
            println!(
                "  {name}: all {:.3} % {:.1} %, half {:.3} % {:.1} %",
                all[0], all[1], half[0], half[1]
            );
        }
        for (sum, figure) in sums.iter_mut().zip(all.into_iter().chain(half)) {
            *sum += figure / names.len() as f64;
        }
    }
    println!(
        "  mean of {} photos: median error {:.3} %, within 1 %: {:.1} %; confident half {:.3} %, {:.1} %",
        names.len(),
        sums[0],
        sums[1],
        sums[2],
        sums[3]
    );
}

/// Where two back ends differ.
#[cfg(feature = "gpu")]
fn compare(a: &[DepthMap], b: &[DepthMap]) {
    let pairs = || {
        a.iter()
            .zip(b)
            .flat_map(|(a, b)| a.depths.iter().zip(&b.depths))
    };
    let share = |most: f32| {
        let same = pairs()
            .filter(|(a, b)| (*a / *b - 1.0).abs() <= most)
            .count();
        100.0 * same as f64 / pairs().count() as f64
    };
    println!(
        "processor and card: {:.2} % within 1e-5, {:.2} % within 0.1 %, {:.2} % within 1 %",
        share(1e-5),
        share(1e-3),
        share(1e-2)
    );
}

/// Of this process, all threads; 0 where the system does not say.
fn cpu_seconds() -> f64 {
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat
        .rsplit(')')
        .next()
        .unwrap_or_default()
        .split_whitespace()
        .collect();
    let ticks = |i: usize| {
        fields
            .get(i)
            .and_then(|f| f.parse::<f64>().ok())
            .unwrap_or(0.0)
    };
    (ticks(11) + ticks(12)) / 100.0
}

//! What the work costs, in criterion's medians: reading, triangulating, building the hierarchy,
//! casting rays, and the whole of `scales` for nine photos.
//!
//! `cargo bench --no-default-features`. Everything is made up here: a rough pile of 0.25 points a
//! square decimetre, in UTM coordinates, written to a temporary folder. For the peers in one run
//! (laspy, SciPy, trimesh with Embree) see `benches/python_pipeline.py`.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    missing_docs,
    reason = "in a test or a benchmark a panic is the report"
)]

use std::f64::consts::TAU;
use std::fs;
use std::hint::black_box;
use std::path::Path;

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fragscale::formats::read_cloud;
use fragscale::geometry::Ray;
use fragscale::jobs::Progress;
use fragscale::opening::{OpenOptions, open_flight};
use fragscale::surface::{Cloud, Levels, Surface};
use glam::DVec3;

mod pile;

use pile::{ORIGIN, pile, write_flight, write_ply};

fn cloud(count: usize) -> Cloud {
    Cloud {
        points: pile(count),
        ..Cloud::default()
    }
}

fn write_laz(path: &Path, points: &[DVec3]) {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(6).expect("a format");
    builder.point_format.is_compressed = true;
    let axis = |offset| las::Transform {
        scale: 0.001,
        offset,
    };
    builder.transforms = las::Vector {
        x: axis(ORIGIN.x),
        y: axis(ORIGIN.y),
        z: axis(ORIGIN.z),
    };
    let header = builder.into_header().expect("a header");
    let mut writer = las::Writer::from_path(path, header).expect("a writer");
    for point in points {
        let point = las::Point {
            x: point.x,
            y: point.y,
            z: point.z,
            gps_time: Some(0.0),
            ..las::Point::default()
        };
        writer.write_point(point).expect("written");
    }
    writer.close().expect("closed");
}

fn reading(c: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a folder");
    let points = pile(1_000_000);
    let mut group = c.benchmark_group("read 1 M points");
    group
        .sample_size(10)
        .throughput(Throughput::Elements(1_000_000));
    for (name, write) in [
        ("pile.ply", write_ply as fn(&Path, &[DVec3])),
        ("pile.laz", write_laz),
    ] {
        let path = folder.path().join(name);
        write(&path, &points);
        group.bench_function(name, |b| b.iter(|| read_cloud(&path, &Progress::default())));
    }
    // The floor of reading: the same bytes, once.
    let path = folder.path().join("pile.laz");
    group.bench_function("pile.laz, bytes only", |b| b.iter(|| fs::read(&path)));
    group.finish();
}

fn surfaces(c: &mut Criterion) {
    let mut group = c.benchmark_group("surface");
    group.sample_size(10);
    for count in [100_000, 1_000_000, 5_000_000] {
        let cloud = cloud(count);
        group.throughput(Throughput::Elements(count as u64));
        group.bench_with_input(
            BenchmarkId::new("sort into the grid", count),
            &cloud,
            |b, cloud| {
                b.iter(|| Surface::new(cloud.clone()));
            },
        );
        // A surface remembers its triangles: each turn has a new one.
        let fresh = || Surface::new(cloud.clone()).expect("a surface");
        group.bench_function(BenchmarkId::new("triangulate all", count), |b| {
            b.iter_batched(
                fresh,
                |surface| surface.triangles(),
                BatchSize::PerIteration,
            );
        });
        let surface = fresh();
        group.bench_with_input(
            BenchmarkId::new("36 rays", count),
            &surface,
            |b, surface| {
                b.iter(|| cast(surface, 36));
            },
        );
        if count <= 1_000_000 {
            group.bench_function(
                BenchmarkId::new("triangulate and build the hierarchy", count),
                |b| {
                    let build = |surface: Surface| {
                        let ready = surface.caster_for(usize::MAX).is_ok();
                        (ready, surface)
                    };
                    b.iter_batched(fresh, build, BatchSize::PerIteration);
                },
            );
            let mesh = surface.to_mesh().expect("a mesh");
            group.bench_with_input(
                BenchmarkId::new("10 000 rays, hierarchy", count),
                &mesh,
                |b, mesh| {
                    b.iter(|| cast(mesh, 10_000));
                },
            );
            group.bench_with_input(
                BenchmarkId::new("10 000 rays, walk", count),
                &surface,
                |b, surface| {
                    b.iter(|| cast(surface, 10_000));
                },
            );
        }
    }
    group.finish();
}

/// Casts rays of a camera 40 m above the middle; returns how many met the surface.
fn cast(surface: &Surface, count: u32) -> usize {
    let mut caster = surface.caster().expect("a caster");
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for vertex in surface.vertices().step_by(997) {
        (min, max) = (min.min(vertex), max.max(vertex));
    }
    let origin = (min + max) / 2.0 + DVec3::Z * 40.0;
    let rays = (0..count).map(|i| {
        let share = f64::from(i) / f64::from(count);
        let (sin, cos) = (share * TAU * 89.0).sin_cos();
        let lean = 0.8 * share.sqrt();
        Ray {
            origin,
            direction: DVec3::new(cos * lean, sin * lean, -1.0).normalize(),
        }
    });
    rays.filter(|ray| black_box(caster.cast(ray)).is_some())
        .count()
}

/// Levels of detail: made once for each cloud, and chosen from for each picture, from afar and from near.
fn levels(c: &mut Criterion) {
    let mut group = c.benchmark_group("levels of detail");
    group.sample_size(10);
    for count in [1_000_000, 10_000_000] {
        let surface = Surface::new(cloud(count)).expect("a surface");
        let make = || Levels::new(&surface, &Progress::default());
        group.bench_function(BenchmarkId::new("make", count), |b| b.iter(make));
        let levels = make().expect("not cancelled").expect("a cloud");
        let bounds = surface.bounds();
        let size = bounds.size().x;
        for (name, height) in [("far", size), ("near", size / 50.0)] {
            let eye = bounds.center().with_z(bounds.max.z + height);
            let choose = || {
                levels.choose(6_000_000, 1.0, |node| {
                    let distance = eye.distance(eye.clamp(node.bounds.min, node.bounds.max));
                    Some(1200.0 * node.spacing / distance.max(0.01))
                })
            };
            let id = BenchmarkId::new(format!("choose from {name}"), count);
            group.bench_function(id, |b| b.iter(choose));
        }
        let largest = levels.nodes().iter().max_by_key(|node| node.count);
        let largest = largest.expect("a node");
        let id = BenchmarkId::new("points of the largest node", count);
        group.bench_function(id, |b| b.iter(|| levels.points_of(largest)));
    }
    group.finish();
}

fn scales(c: &mut Criterion) {
    let mut group = c.benchmark_group("scales of 9 photos");
    group.sample_size(10);
    for count in [1_000_000, 5_000_000] {
        let folder = tempfile::tempdir().expect("a folder");
        let points = pile(count);
        write_laz(&folder.path().join("pile.laz"), &points);
        let flight = write_flight(folder.path(), "pile.laz", count, 9);
        group.bench_function(BenchmarkId::new("LAZ to scales", count), |b| {
            b.iter(|| {
                let progress = Progress::default();
                let opened =
                    open_flight(&flight, &OpenOptions::default(), &progress).expect("open");
                opened.flight.scales(&progress).expect("scales")
            });
        });
        // With FRAGSCALE_BENCH_KEEP the flight stays, for the peer to read the same file.
        if let Some(keep) = std::env::var_os("FRAGSCALE_BENCH_KEEP") {
            let keep = Path::new(&keep).join(count.to_string());
            fs::create_dir_all(&keep).expect("a folder");
            for name in ["pile.laz", "flight.toml", "poses.csv"] {
                fs::copy(folder.path().join(name), keep.join(name)).expect("a copy");
            }
        }
    }
    group.finish();
}

criterion_group!(benches, reading, surfaces, levels, scales);
criterion_main!(benches);

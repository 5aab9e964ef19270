//! What scale fields, best lines and intervals cost beside the four corners, in one run.
//!
//! `cargo bench -p fragscale-sample --bench scale_field`. The pile is made up (`pile/`), the flights as well;
//! each turn opens the flight anew, because a surface remembers what of it was triangulated. At the end
//! stand the ratios that the project asks for: the time of all against that of the corners alone.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    missing_docs,
    reason = "in a test or a benchmark a panic is the report"
)]

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use fragscale_core::camera::Camera;
use fragscale_core::flight::Flight;
use fragscale_core::jobs::Progress;
use fragscale_core::scale::{FieldGrid, FittedScale, ImageKind, ScaleField};
use fragscale_opening::{OpenOptions, open_flight};
use rayon::prelude::*;

mod pile;

use pile::{pile, write_flight, write_ply};

fn opened(flight: &Path) -> Arc<Flight> {
    let opened = open_flight(flight, &OpenOptions::default(), &Progress::default());
    opened.expect("a flight").flight
}

/// The scales of the corners.
fn corners(flight: &Flight) -> usize {
    let scales = flight.scales(&Progress::default());
    scales.expect("scales").len()
}

/// The corners and the best lines.
fn lines(flight: &Flight) -> usize {
    let lines = flight.parts().photos.par_iter().map(|photo| {
        let camera = flight.camera(photo);
        let grid = FieldGrid::of_fit(camera);
        let field = flight.field(photo, ImageKind::Undistorted, grid, &Progress::default());
        FittedScale::of(&field.expect("a field")).is_some()
    });
    corners(flight) + lines.filter(|&has| has).count()
}

/// The corners, the best lines and all intervals.
fn all(flight: &Flight) -> usize {
    let outcomes = flight.scales(&Progress::default()).expect("scales");
    let fields = flight.fields(&outcomes, &Progress::default());
    fields.expect("fields").len()
}

/// The least of a few times: what the work takes when nothing else runs.
fn least(work: impl Fn() -> usize) -> Duration {
    let times = (0..7).map(|_| {
        let start = Instant::now();
        std::hint::black_box(work());
        start.elapsed()
    });
    times.min().unwrap_or_default()
}

type Work = fn(&Flight) -> usize;
const WORKS: [(&str, Work); 3] = [
    ("corners", corners),
    ("corners and lines", lines),
    ("corners, lines, intervals", all),
];

fn flights(c: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a folder");
    write_ply(&folder.path().join("pile.ply"), &pile(1_000_000));
    let flight = write_flight(folder.path(), "pile.ply", 1_000_000, 9);
    let mut group = c.benchmark_group("PLY to scales, 1 M points, 9 photos");
    group.sample_size(10);
    for (name, work) in WORKS {
        group.bench_function(name, |b| b.iter(|| work(&opened(&flight))));
    }
    group.finish();
    let [corners, lines, all] = WORKS.map(|(_, work)| least(|| work(&opened(&flight))));
    let times = |time: Duration| time.as_secs_f64() / corners.as_secs_f64();
    println!(
        "corners {corners:?}; with lines {:.2} times that, with intervals {:.2} times",
        times(lines),
        times(all)
    );
}

fn large(c: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a folder");
    write_ply(&folder.path().join("pile.ply"), &pile(5_000_000));
    let flight = write_flight(folder.path(), "pile.ply", 5_000_000, 500);
    let mut group = c.benchmark_group("5 M points");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(60));
    group.bench_function("500 photos, all", |b| {
        b.iter_batched(
            || opened(&flight),
            |flight| all(&flight),
            BatchSize::PerIteration,
        );
    });
    // 20 megapixels.
    let camera = Camera {
        width: 5472,
        height: 3648,
        fx: 3650.0,
        fy: 3650.0,
        cx: 2736.0,
        cy: 1824.0,
        ..opened(&flight).parts().cameras[0].clone()
    };
    let map = |flight: &Flight| {
        let pose = &flight.parts().photos[250].pose;
        let (grid, image) = (FieldGrid::of_pixels(&camera), ImageKind::Undistorted);
        let surface = &flight.parts().surface;
        ScaleField::compute(&camera, pose, image, grid, surface, &Progress::default())
    };
    group.bench_function(BenchmarkId::new("map", "20 megapixels"), |b| {
        b.iter_batched(
            || opened(&flight),
            |flight| map(&flight),
            BatchSize::PerIteration,
        );
    });
    group.finish();
}

criterion_group!(benches, flights, large);
criterion_main!(benches);

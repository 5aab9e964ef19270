//! What the window does for each flight, beside what it is to be measured by: what is made ready for
//! the viewport and the footprints against triangulating the same points, the table against reading
//! its names.
//!
//! `cargo bench --bench window`.

#![allow(
    clippy::expect_used,
    missing_docs,
    reason = "in a test or a benchmark a panic is the report"
)]

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use fragscale::app::open_flight::OpenFlight;
use fragscale::app::open_flight::loading::Loaded;
use fragscale::app::open_flight::table::{SortBy, TableOrder};
use fragscale::exports::PHOTO_COLUMNS;
use fragscale::flight::Limits;
use fragscale::geometry::{Bounds, LocalFrame};
use fragscale::jobs::Progress;
use fragscale::opening::{OpenOptions, Opened, open_flight};
use fragscale::render::{CloudGeometry, MeshGeometry, Normals};
use fragscale::surface::{Cloud, Surface};

mod pile;

use pile::{ORIGIN, pile, write_ply};

/// `photos` photos in rows, 40 m above a pile of `points` points.
fn write_flight(folder: &Path, points: usize, photos: u32) -> PathBuf {
    write_ply(&folder.join("pile.ply"), &pile(points));
    let side = (points as f64 / 25.0).sqrt();
    let rows = f64::from(photos).sqrt().ceil();
    let mut poses = "photo,x,y,z,tilt,pan\n".to_owned();
    for i in 0..photos {
        let along = |step: f64| side * (0.1 + 0.8 * step / rows);
        let (x, y) = (
            along(f64::from(i) % rows),
            along((f64::from(i) / rows).floor()),
        );
        let (x, y, z) = (x + ORIGIN.x, y + ORIGIN.y, ORIGIN.z + 40.0);
        writeln!(poses, "IMG_{i}.jpg,{x},{y},{z},{},{}", 78 + i % 12, i % 360).expect("written");
    }
    fs::write(folder.join("poses.csv"), poses).expect("written");
    let text = "format = 1\n[world]\nunit = \"m\"\n[surface]\nfile = \"pile.ply\"\n[[camera]]\n\
                width = 4000\nheight = 2250\nfx = 2222.2\nfy = 2222.2\ncx = 2000\ncy = 1125\n\
                [photos]\nposes = \"poses.csv\"\n";
    let flight = folder.join("flight.toml");
    fs::write(&flight, text).expect("written");
    flight
}

fn open(path: &Path) -> Opened {
    open_flight(path, &OpenOptions::default(), &Progress::default()).expect("open")
}

fn viewport(c: &mut Criterion) {
    let points = pile(1_000_000);
    let frame = LocalFrame::near(&Bounds::of(&points).expect("points"));
    let cloud = Cloud {
        points,
        ..Cloud::default()
    };
    let fresh = || Surface::new(cloud.clone()).expect("a surface");
    let mut group = c.benchmark_group("viewport, 1 M points");
    group
        .sample_size(10)
        .throughput(Throughput::Elements(1_000_000));
    group.bench_function("triangulate", |b| {
        b.iter_batched(
            fresh,
            |surface| surface.triangles(),
            BatchSize::PerIteration,
        );
    });
    let surface = fresh();
    let triangles = surface.triangles().expect("triangles");
    let normals = Normals::of(&frame, surface.vertices(), &triangles);
    group.bench_function("normals", |b| {
        b.iter(|| Normals::of(&frame, surface.vertices(), &triangles));
    });
    group.bench_function("mesh", |b| {
        b.iter(|| MeshGeometry::new(&frame, surface.vertices(), &[], &normals, &triangles));
    });
    group.bench_function("cloud", |b| {
        b.iter(|| CloudGeometry::new(&frame, surface.vertices(), &[], &normals));
    });
    group.finish();
}

fn footprints(c: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write_flight(folder.path(), 1_000_000, 500);
    let progress = Progress::default();
    let mut group = c.benchmark_group("500 photos, 1 M points");
    group.sample_size(10);
    let ready = || {
        let flight = open(&path).flight;
        let outcomes = flight.scales(&progress).expect("scales");
        (flight, outcomes)
    };
    group.bench_function("views, with the triangulation", |b| {
        let views = |(flight, outcomes): (Arc<fragscale::flight::Flight>, Vec<_>)| {
            let views = flight.views(&outcomes, &progress).expect("views");
            (flight, views)
        };
        b.iter_batched(ready, views, BatchSize::PerIteration);
    });
    // Once triangulated, each change of a setting costs this.
    let (flight, outcomes) = ready();
    group.bench_function("views again", |b| {
        b.iter(|| flight.views(&outcomes, &progress));
    });
    group.finish();
}

fn column(name: &str) -> SortBy {
    let column = PHOTO_COLUMNS.iter().find(|column| column.name == name);
    SortBy::Column(column.expect("a column"))
}

fn table(c: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write_flight(folder.path(), 100_000, 5000);
    let opened = open(&path);
    let progress = Progress::default();
    let outcomes = opened.flight.scales(&progress).expect("scales");
    let views = opened.flight.views(&outcomes, &progress).expect("views");
    let vertices: Vec<_> = opened.flight.parts().surface.vertices().collect();
    let loaded = Loaded {
        path,
        options: OpenOptions::default(),
        outcomes,
        bulk_bounds: opened.flight.parts().surface.bulk_bounds(),
        opened,
        surface_bounds: Bounds::of(&vertices).expect("vertices"),
        took: [std::time::Duration::ZERO; 2],
        again_for: None,
    };
    let limits = Limits::default();
    let mut flight = OpenFlight::new(1, loaded, &limits);
    flight.take_views(views);
    let mut group = c.benchmark_group("5000 photos");
    group.bench_function("judge", |b| b.iter(|| flight.take_limits(&limits)));
    for (name, by, text) in [
        ("sort by name", column("Photo"), ""),
        ("sort by top scale", column("Top"), ""),
        ("filter by reason", SortBy::Flight, "ground"),
    ] {
        flight.table.order = TableOrder {
            by,
            text: text.to_owned(),
            ..TableOrder::default()
        };
        group.bench_function(name, |b| b.iter(|| flight.arrange()));
    }
    group.finish();
}

criterion_group!(benches, viewport, footprints, table);
criterion_main!(benches);

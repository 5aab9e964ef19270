//! Fitting size distributions and comparing methods: what the window does after each change.
//!
//! The peer is SciPy: `benches/python_fits.py` fits the same curve from one start.

#![allow(
    clippy::expect_used,
    missing_docs,
    reason = "in a test or a benchmark a panic is the report"
)]

use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use fragscale::formats::{DistributionColumns, read_size_distributions};
use fragscale::fragmentation::{
    ComparisonOptions, DistributionSet, FitOptions, Model, Weighting, compare, fit,
};

/// A table of the bundled flight.
fn bundled(name: &str) -> DistributionSet {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    let read = read_size_distributions(&folder.join(name), &DistributionColumns::default());
    read.expect("the bundled table").0
}

fn fits(c: &mut Criterion) {
    let reference = bundled("reference.csv");
    let distribution = &reference.curves[0].distribution;
    let mut group = c.benchmark_group("fit of 14 points");
    for model in Model::ALL {
        group.bench_function(model.key(), |b| {
            b.iter(|| fit(distribution, model, &FitOptions::default()).expect("a fit"));
        });
    }
    group.finish();
}

fn comparison(c: &mut Criterion) {
    let photos = bundled("distributions.csv");
    c.bench_function("two methods of 9 photos against the sieve", |b| {
        b.iter(|| {
            let merged = photos.photos_merged(Weighting::Equal, None);
            let (trials, _) = merged.expect("merged");
            compare(&trials, &ComparisonOptions::new("sieve")).expect("a comparison")
        });
    });
}

criterion_group!(benches, fits, comparison);
criterion_main!(benches);

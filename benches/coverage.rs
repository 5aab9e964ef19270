//! How often the stated 95 % intervals hold the truth, and how far the fitted and the four-corner scales
//! are from it: simulated piles of all presets, with drawn errors and with none.
//!
//! ```text
//! cargo bench -p fragscale-sample --bench coverage -- FLIGHTS [CACHE [PRESET]]
//! ```
//!
//! makes FLIGHTS flights of nine photos of each preset, once without errors and once with drawn ones
//! (position 1 % of the height, angle 0.3°, focal length 0.2 %, world 0.2 %), and prints what docs/scales.md
//! quotes. Each preset has seeds of its own, from 2100, 3100, 4100 and 5100 on: some of those below served to find the
//! constants of `scale/uncertainty/` (`unseen.rs`, `bridges.rs`). The truth is the true mesh with the scale
//! spheres that lie on it (the cloud has them, too), met from the true poses. With CACHE flights are kept there and
//! made once; with PRESET there is no other.
//!
//! ```text
//! cargo bench -p fragscale-sample --bench coverage -- of TRUE FLIGHT [TRUE FLIGHT ...]
//! ```
//!
//! does the same of flights that are there, such as `reconstruct` makes: TRUE is the simulated one that the photos of FLIGHT
//! are of (`sample --surface mesh`).

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    missing_docs,
    reason = "in a benchmark a panic is the report"
)]

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::{Path, PathBuf};

use fragscale_core::jobs::Progress;
use fragscale_core::scale::{EdgeScales, FieldGrid, FittedScale, Interval, ScaleField};
use fragscale_core::surface::{Cloud, Surface};
use fragscale_opening::{OpenOptions, Opened, open_flight};
use fragscale_sample::{DrawnErrors, Lens, PoseNoise, Preset, SampleOptions, make};
use glam::DVec3;

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    if let Some(("of", pairs)) = arguments
        .split_first()
        .map(|(first, rest)| (first.as_str(), rest))
    {
        for pair in pairs.chunks_exact(2) {
            let [truth, flight] = [0, 1].map(|at| Path::new(&pair[at]));
            let mut found = BTreeMap::new();
            compare(
                &opened(flight),
                &true_scales(&opened(truth), truth),
                "as it is",
                &mut found,
            );
            for ((_, scale), found) in found {
                println!("{:20} {scale:8} {}", flight.display(), summary(&found));
            }
        }
        return;
    }
    let flights: u64 = arguments
        .first()
        .map_or(1, |count| count.parse().expect("a count"));
    let folder = tempfile::tempdir().expect("a folder");
    let cache = arguments
        .get(1)
        .map_or(folder.path().to_owned(), PathBuf::from);
    fs::create_dir_all(&cache).expect("a folder");
    println!(
        "preset      errors  scale    photos  off the truth, %: mean    sd  worst   coverage %  half width / sd"
    );
    for (first_seed, (name, preset)) in (2100..).step_by(1000).zip(Preset::ALL) {
        if arguments.get(2).is_some_and(|only| only != name) {
            continue;
        }
        let mut found: BTreeMap<(&str, &str), Vec<Found>> = BTreeMap::new();
        for seed in first_seed..first_seed + flights {
            one_flight(&cache, (name, preset), seed, &mut found);
        }
        for ((errors, scale), found) in found {
            println!("{name:10}  {errors:6}  {scale:8} {}", summary(&found));
        }
    }
}

/// An estimate beside its truth, as shares of the truth.
struct Found {
    off: f64,
    interval: Option<(f64, f64)>,
}

fn summary(found: &[Found]) -> String {
    let count = found.len() as f64;
    let mean = found.iter().map(|f| f.off).sum::<f64>() / count;
    let sd = (found.iter().map(|f| (f.off - mean).powi(2)).sum::<f64>() / count).sqrt();
    let worst = found.iter().map(|f| f.off.abs()).fold(0.0, f64::max);
    let stated: Vec<(f64, f64)> = found.iter().filter_map(|f| f.interval).collect();
    let held = stated
        .iter()
        .filter(|(low, high)| *low <= 0.0 && 0.0 <= *high)
        .count();
    let half = stated
        .iter()
        .map(|(low, high)| (high - low) / 2.0)
        .sum::<f64>()
        / stated.len() as f64;
    format!(
        "{:6}  {:23.2} {:6.2} {:6.2}   {:10.1}  {:15.2}",
        found.len(),
        mean * 100.0,
        sd * 100.0,
        worst * 100.0,
        held as f64 / stated.len() as f64 * 100.0,
        half / sd
    )
}

fn one_flight(
    cache: &Path,
    (name, preset): (&'static str, Preset),
    seed: u64,
    found: &mut BTreeMap<(&'static str, &'static str), Vec<Found>>,
) {
    let lens = [Lens::None, Lens::Brown, Lens::Fisheye][seed as usize % 3];
    let height = preset.recipe(lens).expect("a recipe").flight.height;
    let drawn = DrawnErrors {
        pose: Some(PoseNoise {
            position: 0.01 * height,
            angle: 0.3,
        }),
        lens: Some(0.2),
        world: Some(0.2),
    };
    let kinds = [
        ("none", false, DrawnErrors::default()),
        ("drawn", false, drawn),
    ];
    let open = |kind: &str, true_mesh: bool, errors: DrawnErrors| {
        let folder = cache.join(format!("{name}-{seed}-{kind}"));
        if !folder.join("flight.toml").exists() {
            let options = SampleOptions {
                preset,
                seed,
                lens,
                true_mesh,
                noise_px: None,
                points: None,
                ring: 0,
                survey: None,
                photos: false,
                labels: false,
                at_origin: false,
                errors,
            };
            make(&folder, &options, &Progress::default()).expect("a flight");
        }
        (opened(&folder), folder)
    };
    let (truth, folder) = open("mesh", true, DrawnErrors::default());
    let truth = true_scales(&truth, &folder);
    for (kind, mesh, errors) in kinds {
        compare(&open(kind, mesh, errors).0, &truth, kind, found);
    }
}

fn opened(folder: &Path) -> Opened {
    open_flight(folder, &OpenOptions::default(), &Progress::default()).expect("a flight")
}

/// A photo's name without the folders that it lies in.
fn file_name(photo: &str) -> String {
    photo.rsplit('/').next().unwrap_or(photo).to_owned()
}

/// What a flight says of its photos beside the truth.
fn compare<'a>(
    opened: &Opened,
    truth: &TrueScales,
    kind: &'a str,
    found: &mut BTreeMap<(&'a str, &'static str), Vec<Found>>,
) {
    let flight = &opened.flight;
    let progress = Progress::default();
    let outcomes = flight.scales(&progress).expect("scales");
    let fields = flight.fields(&outcomes, &progress).expect("fields");
    let photos = flight.parts().photos.iter();
    for ((photo, outcome), field) in photos.zip(&outcomes).zip(fields) {
        let (Some(scale), Some(field)) = (outcome.scale(), field) else {
            continue;
        };
        let Some((edges, line)) = truth.get(&file_name(&photo.name)) else {
            continue;
        };
        let uncertainty = field.uncertainty.unwrap_or_default();
        let mut add =
            |what, estimate: Option<f64>, truth: Option<f64>, interval: Option<Interval>| {
                if let (Some(estimate), Some(truth)) = (estimate, truth) {
                    found.entry((kind, what)).or_default().push(Found {
                        off: estimate / truth - 1.0,
                        interval: interval
                            .map(|ends| (ends.low / truth - 1.0, ends.high / truth - 1.0)),
                    });
                }
            };
        let (ours, u) = (&scale.scale, &uncertainty);
        add("corners", ours.top, edges.top, u.top);
        add("corners", ours.bottom, edges.bottom, u.bottom);
        add("sides", ours.left, edges.left, u.left);
        add("sides", ours.right, edges.right, u.right);
        let fitted = |of: fn(&FittedScale) -> f64| field.fitted.as_ref().map(of);
        let true_fit = |of: fn(&FittedScale) -> f64| line.as_ref().map(of);
        add(
            "fitted",
            fitted(|f| f.top),
            true_fit(|f| f.top),
            u.fitted_top,
        );
        add(
            "fitted",
            fitted(|f| f.bottom),
            true_fit(|f| f.bottom),
            u.fitted_bottom,
        );
        // The paper's line, against what the photo's pixels say.
        add("paper", ours.top, true_fit(|f| f.top), None);
        add("paper", ours.bottom, true_fit(|f| f.bottom), None);
    }
}

/// Edges and line of photos, by the names of their files.
type TrueScales = BTreeMap<String, (EdgeScales, Option<FittedScale>)>;

/// Edges and line of each photo on the true surface.
fn true_scales(truth: &Opened, folder: &Path) -> TrueScales {
    let flight = &truth.flight;
    let surface = with_spheres(&flight.parts().surface, folder);
    let progress = Progress::default();
    let outcomes = flight.scales(&progress).expect("scales");
    let photos = flight.parts().photos.iter().zip(outcomes);
    photos
        .map(|(photo, outcome)| {
            let camera = flight.camera(photo);
            let (image, grid) = (flight.parts().image, FieldGrid::of_fit(camera));
            let field = ScaleField::compute(camera, &photo.pose, image, grid, &surface, &progress);
            let edges = outcome.scale().map(|scale| scale.scale).unwrap_or_default();
            let line = FittedScale::of(&field.expect("a field"));
            (file_name(&photo.name), (edges, line))
        })
        .collect()
}

/// The true mesh with the spheres that lie on it.
fn with_spheres(mesh: &Surface, folder: &Path) -> Surface {
    let text = fs::read_to_string(folder.join("truth.json")).expect("truth.json");
    let truth: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let mut points: Vec<DVec3> = mesh.vertices().collect();
    let mut triangles = mesh.triangles().expect("triangles");
    for sphere in truth["spheres"].as_array().expect("spheres") {
        let number = |value: &serde_json::Value| value.as_f64().expect("a number");
        let center = &sphere["center"];
        let center = DVec3::new(number(&center[0]), number(&center[1]), number(&center[2]));
        let radius = number(&sphere["diameter"]) / 2.0;
        let (around, down) = (96_u32, 48_u32);
        let first = u32::try_from(points.len()).expect("few points");
        for row in 0..=down {
            let (ring, z) = (f64::from(row) / f64::from(down) * PI).sin_cos();
            for column in 0..around {
                let (sin, cos) = (f64::from(column) / f64::from(around) * TAU).sin_cos();
                points.push(center + DVec3::new(cos * ring, sin * ring, z) * radius);
            }
        }
        for row in 0..down {
            for column in 0..around {
                let (a, b) = (
                    first + row * around + column,
                    first + row * around + (column + 1) % around,
                );
                triangles.extend([[a, b, a + around], [b, b + around, a + around]]);
            }
        }
    }
    let cloud = Cloud {
        points,
        triangles,
        ..Cloud::default()
    };
    Surface::new(cloud).expect("a surface")
}

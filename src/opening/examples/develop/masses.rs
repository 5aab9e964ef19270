//! Size distributions from simulated photos against their sieves, and what a sieve size is of an outline.

use std::fs;
use std::path::Path;

use fragscale_core::jobs::Progress;
use fragscale_core::picture;
use fragscale_core::units::LengthUnit;
use fragscale_delineation::mass::{self, PhotoFragments, Steps};
use fragscale_delineation::measures::{SieveShape, measured};
use fragscale_delineation::{Engine, delineate};
use fragscale_opening::{OpenOptions, open_flight};

use super::Failed;

pub(super) fn masses(engine: Option<&dyn Engine>, flights: &[&str]) -> Result<(), Failed> {
    let progress = Progress::default();
    let mut forms: Vec<[f64; 4]> = Vec::new();
    for folder in flights {
        let folder = Path::new(folder);
        let opened = open_flight(
            &folder.join("flight.toml"),
            &OpenOptions::default(),
            &progress,
        )?;
        let parts = opened.flight.parts();
        let mut photos = Vec::new();
        let sizes = sizes(&folder.join("truth.json"))?;
        for (index, photo) in parts.photos.iter().enumerate() {
            let camera = opened.flight.camera(photo);
            let (labels, numbers, field) = super::simulated(&opened, folder, index)?;
            let (labels, across) = match engine {
                None => (labels, 1.0),
                Some(engine) => {
                    let image = picture::undistorted(&opened.pixels_of(index)?, camera, u32::MAX);
                    // The ball is no rock.
                    let is_ball = |[r, g, b]: [u8; 3]| r > 90 && r / 2 > g && r / 2 > b;
                    let is_ball: Vec<bool> = image.pixels().map(|pixel| is_ball(pixel.0)).collect();
                    (
                        delineate(engine, &image, &is_ball, &progress)?,
                        engine
                            .habits(camera.width, camera.height)
                            .least_across(picture::edge_spread(&image)),
                    )
                }
            };
            let fragments = measured(&labels, &field, SieveShape::Calibrated);
            if engine.is_none() {
                for fragment in &fragments {
                    let Some(of) = fragment
                        .world
                        .filter(|_| !fragment.is_cut && fragment.pixels > 150)
                    else {
                        continue;
                    };
                    let size = sizes[usize::from(numbers[fragment.number as usize - 1]) - 1];
                    forms.push([
                        (size / of.diameter).ln(),
                        (of.widths[0] / of.diameter).ln(),
                        (of.rectangle[1] / of.diameter).ln(),
                        fragment.pixels as f64,
                    ]);
                }
            }
            photos.push(PhotoFragments::new(
                &labels,
                &field,
                fragments,
                Some(across),
                LengthUnit::Metre,
            ));
        }
        // The same of photos of all sizes.
        let fines = engine.map_or(1.0, |engine| engine.habits(1, 1).fines_of_unfound);
        let steps = Steps {
            fines,
            ..Steps::default()
        };
        let all = mass::by_mass(photos.iter().map(|photo| (photo, steps)))?;
        let reference = reference(&folder.join("reference.csv"))?;
        let at = |size: f64| interpolated(&reference, size);
        print!(
            "{}: {} whole, not outlined {:.1} %, by sieve below {:.4} {:.1} %;",
            folder.display(),
            all.whole,
            100.0 * all.unfound,
            all.limit,
            at(all.limit * 1e3)
        );
        for percent in [20.0, 50.0, 80.0] {
            let truth = inverse(&reference, percent);
            let found = all.curve.size_at(percent).map(|size| size * 1e3);
            print!(
                " P{percent} {:.1} ({:+.1} %)",
                found.unwrap_or(f64::NAN),
                100.0 * (found.unwrap_or(f64::NAN) / truth - 1.0)
            );
        }
        println!();
    }
    if !forms.is_empty() {
        // ln(sieve / D) = a + p ln(B / D), of the least width and of the rectangle's breadth.
        for which in [1, 2] {
            // Large ones count for the mass.
            let n: f64 = forms.iter().map(|form| form[3]).sum();
            let mean = |of: &dyn Fn(&[f64; 4]) -> f64| {
                forms.iter().map(|form| form[3] * of(form)).sum::<f64>() / n
            };
            let (x, y) = (mean(&|form| form[which]), mean(&|form| form[0]));
            let xy = mean(&|form| (form[which] - x) * (form[0] - y));
            let xx = mean(&|form| (form[which] - x).powi(2));
            let p = xy / xx;
            let a = y - p * x;
            let residual = mean(&|form| (form[0] - a - p * form[which]).powi(2));
            println!(
                "{} fragments: factor {:.4}, exponent {p:.4}, residual {:.4}; diameter alone {:.4}",
                forms.len(),
                a.exp(),
                residual.sqrt(),
                y.exp()
            );
        }
    }
    Ok(())
}

/// The sieve size of each fragment, metres, by its number less 1.
fn sizes(path: &Path) -> Result<Vec<f64>, Failed> {
    let truth: serde_json::Value = serde_json::from_str(&fs::read_to_string(path)?)?;
    let fragments = truth["fragments"].as_array().ok_or("no fragments")?;
    Ok(fragments.iter().filter_map(|of| of[0].as_f64()).collect())
}

fn reference(path: &Path) -> Result<Vec<[f64; 2]>, Failed> {
    let text = fs::read_to_string(path)?;
    let rows = text.lines().filter_map(|line| {
        let (size, percent) = line.split_once(',')?;
        Some([size.parse().ok()?, percent.parse().ok()?])
    });
    Ok(rows.collect())
}

fn interpolated(points: &[[f64; 2]], size: f64) -> f64 {
    let pair = points
        .windows(2)
        .find(|pair| pair[0][0] <= size && size <= pair[1][0]);
    pair.map_or(f64::NAN, |pair| {
        let share = (size / pair[0][0]).ln() / (pair[1][0] / pair[0][0]).ln();
        pair[0][1] + share * (pair[1][1] - pair[0][1])
    })
}

fn inverse(points: &[[f64; 2]], percent: f64) -> f64 {
    let pair = points
        .windows(2)
        .find(|pair| pair[0][1] <= percent && percent <= pair[1][1]);
    pair.map_or(f64::NAN, |pair| {
        let share = (percent - pair[0][1]) / (pair[1][1] - pair[0][1]);
        pair[0][0] * (pair[1][0] / pair[0][0]).powf(share)
    })
}

//! What the engines are measured and the score is trained with:
//!
//! `develop features ENGINE FOLDER OUT` writes the features of nodes of labelled photos (`FOLDER/photos`,
//! `FOLDER/labels`) and how far each is a true fragment, for `train_score.py`.
//!
//! `develop score ENGINE DATA [PICTURES]` gives the agreement with outlines that people drew (`DATA/index.csv`,
//! see shared/data/fragments), set by set, and what the best choice of nodes could reach; and the outlines
//! as pictures.

#![allow(
    clippy::print_stdout,
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::panic,
    reason = "a tool for developers, in a terminal: a panic is the report"
)]

use std::collections::BTreeMap;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use fragscale_core::jobs::Progress;
use fragscale_core::scale::{FieldGrid, ImageKind, ScaleField};
use fragscale_delineation::choice::{self, Scorer, features};
use fragscale_delineation::overlap::{self, Agreement};
use fragscale_delineation::{Classical, Engine, Evidence, LabelImage, Learned, Votes, tree};
use fragscale_opening::Opened;
use image::{Rgb, RgbImage};

// For the form of the measures against what passes a sieve: `develop masses ENGINE|truth FLIGHT...` of simulated
// flights without a lens (`fragscale sample DIR --lens none`): what their photos give against their sieves.
mod masses;
// Whether the surface helps to outline.
mod depth;

type Failed = Box<dyn std::error::Error>;

fn main() -> Result<(), Failed> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["features", engine, folder, out] => write_features(&*engine_named(engine)?, folder, out),
        ["score", engine, scorer, data, rest @ ..] => {
            score(&*engine_named(engine)?, scorer, Path::new(data), rest.first().copied())
        }
        ["masses", engine, flights @ ..] => {
            let engine = (*engine != "truth").then(|| engine_named(engine)).transpose()?;
            masses::masses(engine.as_deref(), flights)
        }
        ["depth", engine, scorer, flights @ ..] => {
            let scorer = Scorer::read(&fs::read_to_string(scorer)?).ok_or("not the numbers of a scorer")?;
            depth::depth(&*engine_named(engine)?, &scorer, flights)
        }
        _ => Err("develop depth ENGINE SCORER FLIGHT... | develop masses ENGINE|truth FLIGHT... | develop features ENGINE FOLDER OUT | develop score ENGINE SCORER DATA [PICTURES]".into()),
    }
}

fn engine_named(name: &str) -> Result<Box<dyn Engine>, Failed> {
    match name {
        "classical" => Ok(Box::new(Classical)),
        "learned" => Ok(Box::new(Learned)),
        _ => Err("classical | learned".into()),
    }
}

/// A label image with numbers without gaps, and which each was in the file.
fn labels(path: &Path) -> Result<(LabelImage, Vec<u16>), Failed> {
    let image = image::open(path)?.into_luma16();
    let mut numbers = BTreeMap::new();
    let mut names = Vec::new();
    let (width, height) = (image.width() as usize, image.height() as usize);
    let labels = image.into_raw().into_iter().map(|label| match label {
        0 => 0,
        label => *numbers.entry(label).or_insert_with(|| {
            names.push(label);
            names.len() as u32
        }),
    });
    let labels = labels.collect();
    let labels = LabelImage {
        width,
        height,
        labels,
    };
    Ok((labels, names))
}

/// Of a photo of a simulated flight in this folder: the true outlines with their numbers in the file, and the scales of all pixels.
fn simulated(
    opened: &Opened,
    folder: &Path,
    index: usize,
) -> Result<(LabelImage, Vec<u16>, ScaleField), Failed> {
    let photo = &opened.flight.parts().photos[index];
    let grid = FieldGrid::of_pixels(opened.flight.camera(photo));
    let progress = Progress::default();
    let field = opened
        .flight
        .field(photo, ImageKind::Undistorted, grid, &progress)?;
    let name = photo.name.replace(".jpg", ".png");
    let (labels, numbers) = labels(&folder.join("labels").join(name))?;
    Ok((labels, numbers, field))
}

fn write_features(engine: &dyn Engine, folder: &str, out: &str) -> Result<(), Failed> {
    let folder = Path::new(folder);
    let mut photos: Vec<PathBuf> = fs::read_dir(folder.join("photos"))?
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<_, std::io::Error>>()?;
    photos.sort();
    let mut out = std::io::BufWriter::new(fs::File::create(out)?);
    let progress = Progress::default();
    for (number, path) in photos.iter().enumerate() {
        let name = path.file_name().ok_or("a name")?;
        let (truth, _) = labels(&folder.join("labels").join(name))?;
        let evidence = engine.look(&image::open(path)?.into_rgb8(), &progress)?;
        let tree = tree::tree(&evidence, &[], &progress)?;
        let shared = overlap::of_nodes(&tree, &truth);
        for (place, shared) in shared.iter().enumerate() {
            // Photo, node, parent, pixels, what it shares; then the features; as numbers of 32 bits.
            let node = &tree.nodes[place];
            let head = [
                number as f32,
                node.parent.map_or(-1.0, |parent| parent as f32),
                node.sums.area as f32,
                *shared as f32,
            ];
            for value in head
                .into_iter()
                .chain(features::features(&tree, place).map(|value| value as f32))
            {
                out.write_all(&value.to_le_bytes())?;
            }
        }
    }
    Ok(())
}

fn score(
    engine: &dyn Engine,
    scorer: &str,
    data: &Path,
    pictures: Option<&str>,
) -> Result<(), Failed> {
    let scorer = match scorer {
        "-" => None,
        path => {
            Some(Scorer::read(&fs::read_to_string(path)?).ok_or("not the numbers of a scorer")?)
        }
    };
    let least_score: f64 =
        std::env::var("LEAST").map_or(Ok(engine.least_score()), |text| text.parse())?;
    let mut sets: BTreeMap<String, OfSet> = BTreeMap::new();
    let progress = Progress::default();
    for row in csv::Reader::from_path(data.join("index.csv"))?.records() {
        let row = row?;
        let (set, file) = (&row[1], &row[2]);
        let path = data.join(set).join(file);
        let truth = path.with_extension("labels.png");
        if !truth.exists() && pictures.is_none() {
            continue;
        }
        let photo = image::open(&path)?.into_rgb8();
        let start = Instant::now();
        let evidence = looked_at(engine, &photo, &format!("{set}_{file}"))?;
        let looked = start.elapsed().as_secs_f64();
        let tree = tree::tree(&evidence, &[], &progress)?;
        let grown = start.elapsed().as_secs_f64();
        let best = scorer.as_ref().map(|scorer| {
            let scores = choice::scores(&tree, scorer);
            choice::labelled(&tree, &choice::chosen(&tree, &scores, least_score))
        });
        let all = start.elapsed().as_secs_f64();
        if !truth.exists() {
            println!("{file}: {looked:.2} s look, {grown:.2} s tree, {all:.2} s");
        } else {
            let (truth, _) = labels(&truth)?;
            // Below them the truth is not complete.
            let least = match set {
                "gravel_fh" => 28,
                "tbm_muck" => 177,
                _ => 12,
            };
            let complete = !matches!(set, "belt" | "muckpile_gray");
            let shared = overlap::of_nodes(&tree, &truth);
            let ideal = choice::labelled(&tree, &choice::chosen(&tree, &shared, 0.5));
            let of = sets.entry(set.to_owned()).or_default();
            of.ideal = of.ideal.and(Agreement::of(&ideal, &truth, least, complete));
            if let Some(best) = &best {
                of.best = of.best.and(Agreement::of(best, &truth, least, complete));
                // Where small ones were not outlined, those that are smaller than nearly all that were.
                let mut areas = truth.areas().split_off(1);
                areas.sort_unstable();
                let small = areas.get(areas.len() / 20).copied().unwrap_or_default();
                of.large += Agreement::of(best, &truth, small.max(least), complete).wrong;
                let large =
                    |areas: Vec<usize>| areas.into_iter().filter(move |area| *area >= least);
                let found = best
                    .areas()
                    .into_iter()
                    .zip(overlap::counts(best, &truth, complete));
                let found = found.skip(1).filter(|(_, counts)| *counts);
                of.found
                    .extend(large(found.map(|(area, _)| area).collect()));
                of.outlined.extend(large(truth.areas().split_off(1)));
            }
            of.seconds += all;
            of.leaves += tree.leaves;
        }
        if let Some(folder) = pictures {
            fs::create_dir_all(folder)?;
            let name = format!("{set}_{}", file.replace(".jpg", ".png"));
            let mut picture = photo.clone();
            if let Some(best) = &best {
                outline(&mut picture, best);
            }
            picture.save(Path::new(folder).join(&name))?;
            let mut seen = RgbImage::new(photo.width(), photo.height());
            let parts = evidence
                .border
                .iter()
                .zip(&evidence.rock)
                .zip(&evidence.middle);
            for (pixel, ((border, rock), middle)) in seen.pixels_mut().zip(parts) {
                *pixel = Rgb([*border, *rock, *middle]);
            }
            seen.save(Path::new(folder).join(format!("seen_{name}")))?;
        }
    }
    for (set, of) in sets {
        let without_small = Agreement {
            wrong: of.large,
            ..of.best
        };
        let Agreement {
            right,
            wrong,
            missed,
        } = of.best;
        println!(
            "{set}: F1 {:.3}, {:.3} without small finds ({right} right, {wrong} wrong, {missed} missed), of the tree {:.3}; {} leaves, {:.1} s",
            of.best.f1(),
            without_small.f1(),
            of.ideal.f1(),
            of.leaves,
            of.seconds,
        );
        print!("   diameters by area:");
        for percent in [20, 50, 80] {
            let [found, outlined] = [&of.found, &of.outlined].map(|areas| across(areas, percent));
            print!(" P{percent} {:+.0} %", 100.0 * (found / outlined - 1.0));
        }
        println!();
    }
    Ok(())
}

/// What is counted of the photos of a set.
#[derive(Default)]
struct OfSet {
    ideal: Agreement,
    best: Agreement,
    /// Wrong ones that are not small.
    large: usize,
    /// Pixels of each.
    found: Vec<usize>,
    outlined: Vec<usize>,
    seconds: f64,
    leaves: usize,
}

/// The diameter that fragments with so many percent of the area do not exceed, pixels.
fn across(areas: &[usize], percent: usize) -> f64 {
    let mut areas = areas.to_vec();
    areas.sort_unstable();
    let all: usize = areas.iter().sum();
    let mut below = 0;
    let at = areas.into_iter().find(|area| {
        below += area;
        100 * below >= percent * all
    });
    (at.unwrap_or_default() as f64 * 4.0 / std::f64::consts::PI).sqrt()
}

/// What the engine sees, kept in the folder CACHE where that is set, so that another score takes seconds.
fn looked_at(engine: &dyn Engine, photo: &RgbImage, name: &str) -> Result<Evidence, Failed> {
    let progress = Progress::default();
    let Some(folder) = std::env::var_os("CACHE") else {
        return Ok(engine.look(photo, &progress)?);
    };
    let file = Path::new(&folder).join(format!("{}_{name}.raw", engine.name()));
    let (width, height) = (photo.width() as usize, photo.height() as usize);
    if let Ok(bytes) = fs::read(&file) {
        let mut planes = bytes.chunks_exact(width * height).map(<[u8]>::to_vec);
        let mut next = || planes.next().unwrap_or_default();
        let [border, rock, middle, gray] = [next(), next(), next(), next()];
        let [size, right, down] = [next(), next(), next()];
        let votes = (!size.is_empty()).then_some(Votes { size, right, down });
        return Ok(Evidence {
            width,
            height,
            border,
            rock,
            middle,
            gray,
            votes,
        });
    }
    let evidence = engine.look(photo, &progress)?;
    let planes = [
        &evidence.border,
        &evidence.rock,
        &evidence.middle,
        &evidence.gray,
    ];
    let mut bytes = planes.map(Vec::as_slice).concat();
    if let Some(votes) = &evidence.votes {
        bytes.extend([&votes.size[..], &votes.right, &votes.down].concat());
    }
    fs::create_dir_all(&folder)?;
    fs::write(&file, bytes)?;
    Ok(evidence)
}

fn outline(picture: &mut RgbImage, labels: &LabelImage) {
    let at = |x: usize, y: usize| labels.labels[y * labels.width + x];
    for y in 0..labels.height - 1 {
        for x in 0..labels.width - 1 {
            if at(x, y) != at(x + 1, y) || at(x, y) != at(x, y + 1) {
                picture.put_pixel(x as u32, y as u32, Rgb([255, 230, 0]));
            }
        }
    }
}

//! Whether edges of the surface help to find fragments: `develop depth ENGINE SCORER FLIGHT...` of simulated flights without a lens
//! (`fragscale sample DIR --lens none`). Where the surface bends in a photo is a border, too, so much as `share` says: the
//! stronger of both. The agreement with the true outlines for each share; 0 is the photo alone.

use std::path::Path;

use fragscale_core::jobs::Progress;
use fragscale_core::picture;
use fragscale_core::scale::ScaleField;
use fragscale_delineation::choice::{self, Scorer};
use fragscale_delineation::overlap::Agreement;
use fragscale_delineation::{Engine, tree};
use fragscale_opening::{OpenOptions, open_flight};

use super::Failed;

const SHARES: [f64; 5] = [0.0, 0.15, 0.3, 0.5, 1.0];
/// Pixels between the places that a bend is measured by.
const APART: i64 = 2;

pub(super) fn depth(engine: &dyn Engine, scorer: &Scorer, flights: &[&str]) -> Result<(), Failed> {
    let progress = Progress::default();
    for folder in flights {
        let folder = Path::new(folder);
        let options = OpenOptions::default();
        let opened = open_flight(&folder.join("flight.toml"), &options, &progress)?;
        let mut agreements = [Agreement::default(); SHARES.len()];
        for (index, photo) in opened.flight.parts().photos.iter().enumerate() {
            let camera = opened.flight.camera(photo);
            let (truth, _, field) = super::simulated(&opened, folder, index)?;
            let bends = bends(&field);
            let image = picture::undistorted(&opened.pixels_of(index)?, camera, u32::MAX);
            let evidence = engine.look(&image, &progress)?;
            for (share, agreement) in SHARES.into_iter().zip(&mut agreements) {
                let mut both = evidence.clone();
                for (border, bend) in both.border.iter_mut().zip(&bends) {
                    *border = (*border).max((share * bend) as u8);
                }
                let tree = tree::tree(&both, &[], &progress)?;
                let scores = choice::scores(&tree, scorer);
                let taken = choice::chosen(&tree, &scores, engine.least_score());
                let found = choice::labelled(&tree, &taken);
                *agreement = agreement.and(Agreement::of(&found, &truth, 50, true));
            }
        }
        print!("{}:", folder.display());
        for (share, agreement) in SHARES.into_iter().zip(agreements) {
            print!(" {share}: F1 {:.4};", agreement.f1());
        }
        println!();
    }
    Ok(())
}

/// How much the surface bends at each pixel, across or along: the second difference of the inverse depth, which is 0 on a
/// plane, 255 where 95 of 100 pixels have less.
fn bends(field: &ScaleField) -> Vec<f64> {
    let (columns, rows) = (i64::from(field.grid.columns), i64::from(field.grid.rows));
    let at = |x: i64, y: i64| {
        let [x, y] = [x.clamp(0, columns - 1), y.clamp(0, rows - 1)].map(|place| place as u32);
        field.depth_at(x, y).map_or(f64::NAN, f64::recip)
    };
    let bend = |x: i64, y: i64| {
        let twice = 2.0 * at(x, y);
        let across = at(x - APART, y) + at(x + APART, y) - twice;
        let along = at(x, y - APART) + at(x, y + APART) - twice;
        let bend = across.abs().max(along.abs());
        if bend.is_finite() { bend } else { 0.0 }
    };
    let bends = (0..rows).flat_map(|y| (0..columns).map(move |x| bend(x, y)));
    let mut bends: Vec<f64> = bends.collect();
    let mut sorted = bends.clone();
    sorted.sort_by(f64::total_cmp);
    let most = sorted[sorted.len() * 95 / 100].max(f64::MIN_POSITIVE);
    for bend in &mut bends {
        *bend = (255.0 * *bend / most).min(255.0);
    }
    bends
}

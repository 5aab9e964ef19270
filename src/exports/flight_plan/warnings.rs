//! What is to be said of a plan beside its numbers.

use super::{PlanReport, beyond_in_words, place_in_words, refusals};
use crate::measured::percent;
use crate::numbers::significant_digits;
use fragscale_core::plan::homes_over_keep_out;

/// Of a survey that shows less of the area three times it is said.
const SURVEYED: f64 = 0.97;
/// Of a survey whose photos share by more less over the highest of the area than in its mean it is said.
const LESS_OVERLAP: f64 = 0.05;
/// But where they share as much a reconstruction finds enough: who follows the advice is not given it again.
const ENOUGH_OVERLAP: f64 = 0.65;

/// What is to be said of a plan beside its numbers, one sentence each: what it shows and shares first.
pub fn plan_warnings(report: &PlanReport<'_>) -> Vec<String> {
    let PlanReport { plan, world, .. } = report;
    let mut said = about_cover(report);
    if report.is_nominal {
        let text = "the focal length is the maker's nominal one: scales may be off by 2 %; a calibrated camera is surer";
        said.push(text.to_owned());
    }
    let count =
        |wrong: &dyn Fn(usize) -> bool| (0..plan.photos.len()).filter(|n| wrong(*n)).count();
    let troubled = count(&|number| !plan.troubles(number).is_empty());
    if troubled > 0 {
        said.push(format!(
            "{troubled} of {} photos do not hold what was asked for; each says why",
            plan.photos.len()
        ));
    }
    if let Some(beyond) = beyond_in_words(report) {
        said.push(format!(
            "{beyond}: nobody knows what stands there, and no clearance from it is kept; look there before, or give a surface that reaches so far"
        ));
    }
    let off = plan.wish.errors.off_place();
    if plan.wish.clearance < off {
        said.push(format!(
            "the clearance, {} {world}, is less than the drone may be off its place, {} {world} (95 %): keep farther away, or fly with corrections from a base where it is said to",
            significant_digits(plan.wish.clearance, 3),
            significant_digits(off, 2)
        ));
    }
    let homes = homes_over_keep_out(plan, report.ways);
    if homes > 0 {
        let stops: usize = report.ways.iter().map(|way| way.points.len()).sum();
        said.push(format!(
            "from {homes} of {stops} stops the straight way home leads over an area to keep out of: where the radio is lost the drone hovers by its mission, but called home, or with a low battery, it flies straight; take off where every way home is clear, or bring it back by hand in time"
        ));
    }
    said.extend(refusals(&plan.refused));
    said
}

/// What is to be said of how much the photos show, and share.
fn about_cover(report: &PlanReport<'_>) -> Vec<String> {
    let PlanReport { plan, world, .. } = report;
    let mut said = Vec::new();
    if plan.cover.off_surface > 0.03 {
        let off = percent(plan.cover.off_surface);
        said.push(format!(
            "{off} of the area lies beside the surface or in holes of it: no photo is planned there"
        ));
    }
    if let (Some(at), true) = (plan.cover.gap_at, plan.has_wide_gap()) {
        let gap = significant_digits(plan.cover.widest_gap, 2);
        said.push(format!(
            "photos leave a gap {gap} {world} across at {}: give more overlap, fill gaps, or fly it by hand",
            place_in_words(at)
        ));
    }
    if let Some(share) = plan.cover.surveyed.filter(|share| *share < SURVEYED) {
        let less = percent(1.0 - share);
        said.push(format!(
            "{less} of the area is in fewer than three photos of the survey: it may be missing in a reconstruction; give the survey more overlap"
        ));
    }
    let overlap = plan.wish.survey.overlap;
    if let Some(least) = (plan.cover.least_overlap)
        .filter(|least| *least < ENOUGH_OVERLAP.min(overlap - LESS_OVERLAP))
    {
        // 1 - (1 - overlap) * ratio is what is left: the ratio stays what it is.
        let needed = 1.0 - (1.0 - overlap) * (1.0 - ENOUGH_OVERLAP) / (1.0 - least);
        said.push(format!(
            "photos of the survey share {} with the next over the highest of the area, and {} in its mean: a survey's overlap of {:.0} % leaves {:.0} % there",
            percent(least.max(0.0)),
            percent(overlap),
            (100.0 * needed).ceil(),
            100.0 * ENOUGH_OVERLAP
        ));
    }
    said
}

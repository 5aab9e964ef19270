//! What is known of a whole cloud before a part of it is in memory: the box around its points, their convex hull, a
//! sample; and where each of its pieces lies.

use glam::DVec3;
use rayon::prelude::*;

use super::Moving;
use crate::fault::Fault;
use crate::formats::{CloudPiece, CloudPieces};
use crate::geometry::Bounds;
use crate::jobs::Progress;
use crate::surface::{CloudFacts, HullOfMany, PartPlan};

/// About so many points are decoded at a time: some 60 MB beside what is kept.
pub(super) const AT_ONCE: u64 = 1_000_000;

/// A cloud that was looked at.
#[derive(Debug)]
pub(super) struct Looked {
    pub(super) plan: PartPlan,
    /// Of each piece, in the world.
    pub(super) bounds: Vec<Bounds>,
}

/// What one piece tells.
struct Told {
    bounds: Option<Bounds>,
    /// Those of its points that may be corners of the hull.
    corners: Vec<DVec3>,
    sample: Vec<DVec3>,
}

/// Looks at a cloud: at its octree, or at all of its points.
///
/// # Errors
/// Where a piece is damaged, a point cannot be moved, or the work was cancelled.
pub(super) fn look(
    pieces: &CloudPieces,
    moving: &Moving,
    progress: &Progress,
) -> Result<Looked, Fault> {
    let known: Option<Vec<Bounds>> = pieces.pieces.iter().map(|piece| piece.bounds).collect();
    match (&pieces.facts, known) {
        (Some(facts), Some(bounds)) if moving.is_none() => {
            let hull = rim_of_octree(pieces, &bounds, facts, progress)?;
            let plan = plan(facts.clone(), &hull)?;
            Ok(Looked { plan, bounds })
        }
        _ => through_all(pieces, moving, progress),
    }
}

fn plan(facts: CloudFacts, hull: &HullOfMany) -> Result<PartPlan, Fault> {
    PartPlan::new(facts, hull)
        .map_err(|error| Fault::new(error.to_string(), "check the surface file"))
}

/// The hull of an octree's cloud: coarse nodes first, and of finer ones those that reach beyond what is known.
fn rim_of_octree(
    pieces: &CloudPieces,
    bounds: &[Bounds],
    facts: &CloudFacts,
    progress: &Progress,
) -> Result<HullOfMany, Fault> {
    progress.stage("looking for the rim of the cloud");
    let mut hull = HullOfMany::new(&facts.bounds);
    let mut waiting: Vec<(&CloudPiece, &Bounds)> = pieces.pieces.iter().zip(bounds).collect();
    // The largest boxes first.
    let size = |bounds: &Bounds| bounds.size().truncate().element_product();
    waiting.sort_by(|a, b| size(b.1).total_cmp(&size(a.1)));
    let total = waiting.len() as u64;
    let mut left = &waiting[..];
    while !left.is_empty() {
        progress.advance(total - left.len() as u64, total)?;
        let mut batch = Vec::new();
        let mut points = 0;
        while let Some(((piece, bounds), rest)) = left.split_first() {
            // Finer ones wait until what the coarser ones tell is known.
            let is_finer = batch
                .first()
                .is_some_and(|(_, first)| size(bounds) < 0.5 * size(first));
            if points > AT_ONCE || is_finer {
                break;
            }
            left = rest;
            // No point lies beside the box of all.
            let inside = Bounds {
                min: bounds.min.max(facts.bounds.min),
                max: bounds.max.min(facts.bounds.max),
            };
            if !hull.encloses(&inside) {
                points += piece.count;
                batch.push((*piece, **bounds));
            }
        }
        let corners = batch.par_iter().map(|(piece, _)| {
            let points = pieces.read(piece)?;
            all_inside(&points, &facts.bounds)?;
            Ok(hull.corners_of(&points))
        });
        let corners: Vec<Vec<DVec3>> = corners.collect::<Result<_, Fault>>()?;
        hull.take(&corners.concat());
    }
    Ok(hull)
}

/// Refuses points outside of the box that their file states: everything is laid out by it.
pub(super) fn all_inside(points: &[DVec3], bounds: &Bounds) -> Result<(), Fault> {
    match points.iter().find(|point| !bounds.contains(**point)) {
        None => Ok(()),
        Some(point) => Err(Fault::new(
            format!(
                "its point ({}, {}, {}) lies outside of the box that it states",
                point.x, point.y, point.z
            ),
            "export it again, or as LAZ without an octree",
        )),
    }
}

/// Looks through all points.
fn through_all(
    pieces: &CloudPieces,
    moving: &Moving,
    progress: &Progress,
) -> Result<Looked, Fault> {
    progress.stage("looking through the cloud");
    let mut stated = [pieces.bounds.min, pieces.bounds.max];
    moving.points(&mut stated)?;
    let stride = CloudFacts::sample_stride(pieces.count);
    let mut about = Bounds {
        min: stated[0].min(stated[1]),
        max: stated[0].max(stated[1]),
    };
    loop {
        let mut hull = HullOfMany::new(&about);
        let mut all = Vec::with_capacity(pieces.pieces.len());
        let mut sample = Vec::new();
        let mut first = 0;
        for batch in batches(&pieces.pieces) {
            progress.advance(first, pieces.count)?;
            let firsts = batch.iter().scan(first, |next, piece| {
                let first = *next;
                *next += piece.count;
                Some(first)
            });
            let with_firsts: Vec<(&CloudPiece, u64)> = batch.iter().zip(firsts).collect();
            let told = with_firsts.par_iter().map(|&(piece, first)| {
                let mut points = pieces.read(piece)?;
                moving.points(&mut points)?;
                // To the next whole multiple.
                let skipped = usize::try_from((stride - first % stride) % stride);
                let sampled = points.iter().skip(skipped.unwrap_or(usize::MAX));
                let stride = usize::try_from(stride).unwrap_or(usize::MAX);
                Ok(Told {
                    bounds: Bounds::of(&points),
                    corners: hull.corners_of(&points),
                    sample: sampled.step_by(stride).copied().collect(),
                })
            });
            let told: Vec<Told> = told.collect::<Result<_, Fault>>()?;
            first += batch.iter().map(|piece| piece.count).sum::<u64>();
            for told in told {
                hull.take(&told.corners);
                sample.extend(told.sample);
                // A piece has points.
                all.extend(told.bounds);
            }
        }
        let around = all.iter().copied().reduce(|a, b| Bounds {
            min: a.min.min(b.min),
            max: a.max.max(b.max),
        });
        let Some(bounds) = around else {
            return Err(Fault::new(
                "it has no points",
                "export points with x, y and z",
            ));
        };
        // The hull was found in the frame of what the header states; where it does not hold, once more.
        if !hull.is_of(&bounds) {
            about = bounds;
            continue;
        }
        let facts = CloudFacts {
            count: first,
            bounds,
            sample,
        };
        let plan = plan(facts, &hull)?;
        return Ok(Looked { plan, bounds: all });
    }
}

/// Pieces in batches of about [`AT_ONCE`] points.
pub(super) fn batches(pieces: &[CloudPiece]) -> impl Iterator<Item = &[CloudPiece]> {
    let mut left = pieces;
    std::iter::from_fn(move || {
        let mut points = 0;
        let more = left.iter().take_while(|piece| {
            let has_room = points < AT_ONCE;
            points += piece.count;
            has_room
        });
        let (batch, rest) = left.split_at(more.count());
        left = rest;
        (!batch.is_empty()).then_some(batch)
    })
}

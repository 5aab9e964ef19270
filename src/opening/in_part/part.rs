//! The part of a large cloud that is in memory, from one opening of its flight to the next.

use std::collections::BTreeSet;
use std::path::Path;

use glam::DVec3;
use rayon::prelude::*;

use super::looking::{Looked, all_inside, batches, look};
use super::{Memory, Moving};
use crate::camera::Camera;
use crate::fault::Fault;
use crate::files::FileError;
use crate::flight::Photo;
use crate::formats::{CloudFile, CloudPiece, CloudPieces};
use crate::geometry::Bounds;
use crate::jobs::Progress;
use crate::scale::{ImageKind, Sights};
use crate::surface::{Surface, Wanted};

/// What is kept between openings.
#[derive(Debug)]
pub(crate) struct InPart {
    memory: Memory,
    wanted: Wanted,
    pieces: Option<CloudPieces>,
    looked: Option<Looked>,
    /// The blocks that are held.
    held: BTreeSet<usize>,
    /// Their points, in the world.
    points: Vec<DVec3>,
}

impl InPart {
    /// Nothing is read yet.
    pub(crate) fn new(memory: Memory) -> Self {
        Self {
            memory,
            wanted: Wanted::default(),
            pieces: None,
            looked: None,
            held: BTreeSet::new(),
            points: Vec::new(),
        }
    }

    /// What the last part lacked, to be in the next one.
    pub(crate) fn want(&mut self, wanted: Wanted) {
        self.wanted = wanted;
    }

    /// What a cloud's file states, with three points that stand for all (the first, the box's corners), where it is
    /// read in part; `None` where it is read whole.
    ///
    /// # Errors
    /// With the file, where it is damaged, or needed whole and does not fit into the memory.
    pub(crate) fn stand_in(
        &mut self,
        path: &Path,
        photos: usize,
        thinning: bool,
    ) -> Result<Option<CloudFile>, FileError> {
        let at = |fault| FileError::new(path, fault);
        if self.pieces.is_none() {
            self.pieces = CloudPieces::open(path)?;
        }
        let Some(pieces) = &self.pieces else {
            return Ok(None);
        };
        let memory = self.memory;
        if memory.holds_whole(pieces.count, photos) {
            return Ok(None);
        }
        if let Some(why) = thinning.then_some("thinning it").or(self.wanted.all) {
            return match memory.has_room(pieces.count) {
                true => Ok(None),
                false => Err(at(memory.refuse_whole(pieces.count, why))),
            };
        }
        let first = pieces.pieces.first().map(|piece| pieces.read(piece));
        let first = first.transpose().map_err(at)?.unwrap_or_default();
        let mut file = pieces.file.clone();
        file.cloud.points.extend(first.first());
        file.cloud
            .points
            .extend([pieces.bounds.min, pieces.bounds.max]);
        Ok(Some(file))
    }

    /// That a file of so many points, which is none that could be read in part, takes more memory than was allowed.
    pub(crate) fn exceeded(&self, points: u64) -> Option<String> {
        let needs_whole = self.pieces.is_none();
        needs_whole.then(|| self.memory.exceeded(points)).flatten()
    }

    /// The part of the surface that photos see, with what the last part lacked.
    ///
    /// # Errors
    /// Where it does not fit into the memory, a piece is damaged, the points make no surface, or the work was
    /// cancelled.
    pub(crate) fn surface(
        &mut self,
        moving: &Moving,
        photos: &[Photo],
        cameras: &[Camera],
        image: ImageKind,
        max_edge: Option<f64>,
        progress: &Progress,
    ) -> Result<Surface, Fault> {
        let Some(pieces) = &self.pieces else {
            return Err(Fault::new("it was not opened", "open it again"));
        };
        let looked = match self.looked.take() {
            Some(looked) => looked,
            None => look(pieces, moving, progress)?,
        };
        let mut blocks = std::mem::take(&mut self.wanted.blocks);
        if self.held.is_empty() {
            let mut sights = Sights::default();
            for photo in photos.iter().filter(|photo| photo.trouble.is_none()) {
                if let Some(camera) = cameras.get(photo.camera) {
                    sights.add(camera, &photo.pose, image);
                }
            }
            blocks.extend(looked.plan.blocks_around(|bounds| sights.misses(bounds)));
        }
        blocks.retain(|block| !self.held.contains(block));
        let looked = self.looked.insert(looked);
        let about = self.points.len() as u64 + about(pieces, looked, &blocks);
        self.memory.check_part(about, pieces.count)?;
        progress.stage("reading what the photos see");
        let more = read(pieces, looked, moving, &blocks, progress, &|points| {
            self.memory.check_part(points, pieces.count)
        })?;
        self.points.extend(more);
        self.held.extend(blocks);
        progress.stage("building the surface");
        let surface = looked.plan.surface(&self.points, &self.held, max_edge);
        surface.map_err(|error| Fault::new(error.to_string(), "check the surface file"))
    }
}

/// Which blocks are asked for.
struct Asked<'a> {
    looked: &'a Looked,
    is_asked: Vec<bool>,
    columns: usize,
}

impl<'a> Asked<'a> {
    fn new(looked: &'a Looked, blocks: &BTreeSet<usize>) -> Self {
        let mut is_asked = vec![false; looked.plan.block_count()];
        for &block in blocks {
            if let Some(is_asked) = is_asked.get_mut(block) {
                *is_asked = true;
            }
        }
        Self {
            looked,
            is_asked,
            columns: looked.plan.block_columns(),
        }
    }

    fn holds(&self, point: DVec3) -> bool {
        self.is_asked.get(self.looked.plan.block_of(point)) == Some(&true)
    }

    /// How many blocks a box lies over, and how many of them are asked for.
    fn under(&self, bounds: &Bounds) -> (u64, u64) {
        let plan = &self.looked.plan;
        let (from, to) = (plan.block_of(bounds.min), plan.block_of(bounds.max));
        let (mut all, mut asked) = (0, 0);
        for row in from / self.columns..=to / self.columns {
            for column in from % self.columns..=to % self.columns {
                all += 1;
                asked += u64::from(self.is_asked.get(row * self.columns + column) == Some(&true));
            }
        }
        (all, asked)
    }
}

/// About how many points blocks have: of each piece the share of its box.
fn about(pieces: &CloudPieces, looked: &Looked, blocks: &BTreeSet<usize>) -> u64 {
    let asked = Asked::new(looked, blocks);
    let each = pieces.pieces.iter().zip(&looked.bounds);
    let about = each.map(|(piece, bounds)| {
        let (all, asked) = asked.under(bounds);
        piece.count as f64 * asked as f64 / (all as f64).max(1.0)
    });
    about.sum::<f64>() as u64
}

/// All points of blocks, in the order of the file.
fn read(
    pieces: &CloudPieces,
    looked: &Looked,
    moving: &Moving,
    blocks: &BTreeSet<usize>,
    progress: &Progress,
    check: &dyn Fn(u64) -> Result<(), Fault>,
) -> Result<Vec<DVec3>, Fault> {
    let asked = Asked::new(looked, blocks);
    let each = pieces.pieces.iter().zip(&looked.bounds);
    let needed = each.filter(|(_, bounds)| asked.under(bounds).1 > 0);
    let needed: Vec<CloudPiece> = needed.map(|(piece, _)| piece.clone()).collect();
    let total: u64 = needed.iter().map(|piece| piece.count).sum();
    let (mut done, mut points) = (0, Vec::new());
    for batch in batches(&needed) {
        progress.advance(done, total)?;
        let kept = batch.par_iter().map(|piece| {
            let mut points = pieces.read(piece)?;
            moving.points(&mut points)?;
            all_inside(&points, &looked.plan.facts().bounds)?;
            points.retain(|&point| asked.holds(point));
            Ok(points)
        });
        for kept in kept.collect::<Result<Vec<Vec<DVec3>>, Fault>>()? {
            points.extend(kept);
        }
        check(points.len() as u64)?;
        done += batch.iter().map(|piece| piece.count).sum::<u64>();
    }
    Ok(points)
}

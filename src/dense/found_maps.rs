//! The depth maps that were found, on a shelf: looked at one by one, the latest kept in memory.

use std::sync::Arc;

use rayon::prelude::*;

use crate::agreement::Agreement;
use crate::camera::Camera;
use crate::depth_map::DepthMap;
use crate::edges::before_farther;
use crate::fault::Fault;
use crate::patch_match::EDGE;
use crate::patch_match::plane::{Plane, Planes};
use crate::shelf::{Recent, Shelf};
use crate::view::View;

/// Bytes of maps that are kept in memory: a photo and its neighbours, for those of up to 10 megapixels.
const MOST_BYTES: usize = 1 << 30;
/// Bytes of a pixel of a [`DepthMap`].
const OF_A_PIXEL: usize = 22;

/// What is known of a map without its pixels.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Outline {
    /// Of the map's size.
    pub(crate) camera: Camera,
    /// See [`DepthMap`].
    pub(crate) halvings: u32,
    pub(crate) per_pixel: f32,
    pub(crate) neighbours: Vec<usize>,
}

/// The depth maps of a survey.
pub struct DepthMaps<'a> {
    pub(crate) views: &'a [View],
    /// Of each view that has a map.
    outlines: Vec<Option<Outline>>,
    shelf: &'a dyn Shelf,
    recent: Recent<DepthMap>,
}

/// The name of a view's final planes on the shelf.
pub(crate) fn final_name(which: usize) -> String {
    format!("depths-{which}")
}

impl<'a> DepthMaps<'a> {
    /// Of views whose final planes lie on the shelf.
    pub(crate) fn new(
        views: &'a [View],
        outlines: Vec<Option<Outline>>,
        shelf: &'a dyn Shelf,
    ) -> Self {
        Self {
            views,
            outlines,
            shelf,
            recent: Recent::new(MOST_BYTES),
        }
    }

    /// How many views there are, with a map or without.
    #[must_use]
    pub fn len(&self) -> usize {
        self.outlines.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.outlines.is_empty()
    }

    /// How many pixels the maps have together.
    pub(crate) fn pixels(&self) -> u64 {
        let outlines = self.outlines.iter().flatten();
        outlines
            .map(|outline| u64::from(outline.camera.width) * u64::from(outline.camera.height))
            .sum()
    }

    /// Width and height of a view's map, 0 where it has none.
    pub(crate) fn size(&self, which: usize) -> [usize; 2] {
        let outline = self.outlines.get(which).and_then(Option::as_ref);
        outline.map_or([0; 2], |outline| {
            [
                outline.camera.width as usize,
                outline.camera.height as usize,
            ]
        })
    }

    /// The map of a view; `None` where it had no neighbours. Supports and confidences are by its costs alone:
    /// [`DepthMaps::graded`] has them with the neighbours'.
    ///
    /// # Errors
    /// Where the shelf lost it.
    pub fn get(&self, which: usize) -> Result<Option<Arc<DepthMap>>, Fault> {
        let Some(outline) = self.outlines.get(which).and_then(Option::as_ref) else {
            return Ok(None);
        };
        if let Some(map) = self.recent.get(which) {
            return Ok(Some(map));
        }
        let [width, height] = self.size(which);
        let bytes = self.shelf.get(&final_name(which));
        let planes = bytes.and_then(|bytes| Planes::from_bytes(&bytes, width, height));
        let planes = planes.ok_or_else(|| {
            Fault::new(
                format!("the depths of photo {which} were taken away while they were needed"),
                "start again, and leave the folder alone meanwhile",
            )
        })?;
        let map = Arc::new(DepthMap::of(outline, planes));
        let bytes = OF_A_PIXEL * width * height;
        self.recent.hold(which, bytes, Arc::clone(&map));
        Ok(Some(map))
    }

    /// The map of a view with its supports, and confidences by them.
    ///
    /// # Errors
    /// As [`DepthMaps::get`].
    pub fn graded(&self, which: usize) -> Result<Option<DepthMap>, Fault> {
        let Some(map) = self.get(which)? else {
            return Ok(None);
        };
        let agreements = self.agreements(which)?;
        let count = |at: usize| {
            let same = agreements.iter().filter_map(|other| other.look(&map, at));
            u8::try_from(same.filter(|seen| seen.is_same).count()).unwrap_or(u8::MAX)
        };
        let supports: Vec<u8> = (0..map.depths.len()).into_par_iter().map(count).collect();
        let most = map.neighbours.len().max(1) as f32;
        let grades = map.costs.iter().zip(&supports).map(|(cost, support)| {
            (1.0 - cost).clamp(0.0, 1.0) * (0.2 + 0.8 * f32::from(*support) / most)
        });
        let confidences = grades.collect();
        Ok(Some(DepthMap {
            supports,
            confidences,
            ..(*map).clone()
        }))
    }

    /// From a view's map to those of its neighbours.
    pub(crate) fn agreements(&self, which: usize) -> Result<Vec<Agreement<'a>>, Fault> {
        let Some(own) = self.get(which)? else {
            return Ok(Vec::new());
        };
        let mut all = Vec::with_capacity(own.neighbours.len());
        for &other in &own.neighbours {
            if let Some(theirs) = self.get(other)? {
                let (view, their_view) = (&self.views[which], &self.views[other]);
                all.push(Agreement::of(&own, view, theirs, (other, their_view)));
            }
        }
        Ok(all)
    }
}

impl DepthMap {
    fn of(outline: &Outline, planes: Planes) -> Self {
        let list = |of: fn(&Plane) -> f32| planes.planes.iter().map(of).collect();
        let costs: Vec<f32> = list(|plane| plane.cost);
        let slopes: Vec<[f32; 2]> = planes.planes.iter().map(|plane| plane.slope).collect();
        let size = [outline.camera.width, outline.camera.height].map(|side| side as usize);
        let inverse_depths = list(|plane| plane.inverse_depth);
        Self {
            before_farther: before_farther(
                size,
                &inverse_depths,
                &slopes,
                EDGE as usize,
                outline.per_pixel,
            ),
            camera: outline.camera.clone(),
            halvings: outline.halvings,
            depths: list(|plane| plane.inverse_depth.recip()),
            slopes,
            supports: vec![0; costs.len()],
            confidences: costs
                .iter()
                .map(|cost| (1.0 - cost).clamp(0.0, 1.0))
                .collect(),
            costs,
            per_pixel: outline.per_pixel,
            neighbours: outline.neighbours.clone(),
        }
    }
}

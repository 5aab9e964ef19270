//! The surface as one sight of it: it is drawn once, in portions where it is large, and drawn anew
//! only where something of it has changed. Photos and lines change more often.

use wgpu::TextureView;

use super::frame::Frame;
use super::show::ColorBy;

/// All that the surface's picture depends on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sight {
    frame: Frame,
    /// Counts what was uploaded: surfaces, and photos to lay on them.
    version: (u64, u64),
    pub(super) mesh: bool,
    pub(super) cloud: bool,
    /// How much of the cloud is drawn.
    pub(super) share: f64,
}

impl Sight {
    /// `shapes` says whether mesh and cloud are drawn, `share` how much of the cloud.
    pub(super) fn new(
        frame: &Frame,
        by: ColorBy,
        version: (u64, u64),
        shapes: [bool; 2],
        share: f64,
    ) -> Self {
        let mut frame = Frame {
            // Other passes' concern.
            background: [0.0; 4],
            ink: [0.0; 4],
            relief: 0.0,
            lift: [0.0; 2],
            ..*frame
        };
        if by == ColorBy::Rgb {
            frame.range = [0.0; 2];
        }
        if by != ColorBy::Scale && frame.project == 0 {
            // No matter which photo is selected.
            frame.image_from_local = [[0.0; 4]; 4];
            frame.photo_scale = 0.0;
            frame.photo_near = 0.0;
        }
        let [mesh, cloud] = shapes;
        Self {
            frame,
            version,
            mesh,
            cloud,
            share,
        }
    }

    /// Whether the one is seen from where the other is: it may stand in for it.
    pub(super) fn same_view(&self, other: &Self) -> bool {
        self.frame.clip_from_local == other.frame.clip_from_local
    }
}

/// Colours and depths of the surface alone.
#[derive(Debug)]
pub(super) struct SurfaceTarget {
    pub(super) color: TextureView,
    pub(super) depth: TextureView,
    /// What it shows, or will show.
    pub(super) sight: Option<Sight>,
    /// The tiles to go on with, of mesh and cloud; `None` where all are drawn.
    pub(super) next: [Option<usize>; 2],
    /// Triangles and points drawn.
    pub(super) drawn: [usize; 2],
}

impl SurfaceTarget {
    pub(super) fn new(color: TextureView, depth: TextureView) -> Self {
        Self {
            color,
            depth,
            sight: None,
            next: [None; 2],
            drawn: [0; 2],
        }
    }

    /// Begins another sight.
    pub(super) fn begin(&mut self, sight: Sight) {
        self.next = [sight.mesh, sight.cloud].map(|wanted| wanted.then_some(0));
        self.drawn = [0; 2];
        self.sight = Some(sight);
    }

    /// Whether nothing is missing.
    pub(super) fn is_whole(&self) -> bool {
        self.next == [None; 2]
    }
}

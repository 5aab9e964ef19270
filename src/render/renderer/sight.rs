//! The surface as one sight of it: it is drawn once, in portions where it is large, and drawn anew
//! only where something of it has changed. Photos and lines change more often.

use crate::primitives::frame::FrameUniform;
use crate::show::ColorBy;

/// All that the surface's picture depends on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sight {
    frame: FrameUniform,
    /// Counts what was uploaded: surfaces, photos to lay on them, clouds beside them.
    version: [u64; 3],
    pub(crate) mesh: bool,
    pub(crate) cloud: bool,
    /// How much of the cloud is drawn.
    pub(crate) share: f64,
    /// Which nodes of a streamed cloud are.
    nodes: u64,
}

impl Sight {
    /// `shapes` says whether mesh and cloud are drawn, `share` how much of the cloud and which
    /// nodes of it.
    pub(crate) fn new(
        frame: &FrameUniform,
        by: ColorBy,
        version: [u64; 3],
        shapes: [bool; 2],
        (share, nodes): (f64, u64),
    ) -> Self {
        let mut frame = FrameUniform {
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
            nodes,
        }
    }

    /// Whether the one is seen from where the other is: it may stand in for it.
    pub(crate) fn same_view(&self, other: &Self) -> bool {
        self.frame.clip_from_local == other.frame.clip_from_local
    }
}

//! How much work dense stereo does.

/// How much time the depth maps may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quality {
    /// Photos of at most 3 megapixels.
    Normal,
    /// The photos' full size.
    Best,
}

/// The settings of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DenseOptions {
    /// How many other photos each photo is compared with, at most 8.
    pub neighbours: usize,
    /// The most pixels that a depth map has; photos with more are halved until they fit.
    pub most_pixels: u64,
    /// Sweeps at the full size of the depth map, photos alone; coarser sizes get two more each.
    pub sweeps: u32,
    /// Sweeps with the other photos' depths; 0 leaves them out.
    pub geometric_sweeps: u32,
}

impl DenseOptions {
    /// The settings for a quality.
    #[must_use]
    pub fn of(quality: Quality) -> Self {
        let normal = Self {
            neighbours: 4,
            most_pixels: 3_000_000,
            sweeps: 2,
            geometric_sweeps: 2,
        };
        match quality {
            Quality::Normal => normal,
            Quality::Best => Self {
                most_pixels: u64::MAX,
                ..normal
            },
        }
    }
}

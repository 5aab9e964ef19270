//! How much time the cloud may take.

use crate::dense::DenseOptions;
use crate::dense::Quality as Depths;

/// What an engineer chooses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Quality {
    /// The sparse cloud: the points that the photos' places were found with. The default, for it costs nothing and its fitted
    /// scales are as good as those of a dense one (docs/reconstruct.md).
    #[default]
    Fast,
    /// A dense cloud from photos of at most 3 megapixels, to which larger ones are reduced.
    Normal,
    /// A dense cloud from every pixel.
    Best,
}

impl Quality {
    /// All, by the time that they take.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Normal, Self::Best];

    /// How depths are found; `None` where they are not.
    pub fn dense(self) -> Option<DenseOptions> {
        match self {
            Self::Fast => None,
            Self::Normal => Some(DenseOptions::of(Depths::Normal)),
            Self::Best => Some(DenseOptions::of(Depths::Best)),
        }
    }

    /// Its name on the command line.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Normal => "normal",
            Self::Best => "best",
        }
    }

    /// What comes out and what it costs.
    pub fn explained(self) -> &'static str {
        match self {
            Self::Fast => {
                "The sparse cloud, some thousand points a photo. Scales from it are sure to about 1 %"
            }
            Self::Normal => {
                "A dense cloud, from photos of at most 3 megapixels (larger ones are halved until they fit). \
                 About ten seconds a megapixel of each photo more on two cores, and 35 MB of it on the disk while it runs. \
                 For volumes and for looking at it; corners are a little surer than in the sparse one, fitted scales are not"
            }
            Self::Best => {
                "A dense cloud from all pixels. The same as normal for photos of up to 3 megapixels, four times \
                 its time for those of 12"
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_better_one_looks_at_more() {
        let pixels = Quality::ALL.map(|quality| quality.dense().map(|dense| dense.most_pixels));
        assert_eq!(pixels, [None, Some(3_000_000), Some(u64::MAX)]);
        assert_eq!(Quality::default().as_str(), "fast");
    }
}

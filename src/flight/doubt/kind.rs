//! Reasons for doubt by their kinds: a word for each, without its numbers. Flight files keep these
//! words, so none is ever changed.

use super::Doubt;

/// All words.
const KINDS: [&str; 50] = [
    "no-scale",
    "off-surface",
    "no-point",
    "no-fit",
    "no-line",
    "ratio",
    "sideways",
    "long-triangle",
    "flat-view",
    "not-plane",
    "off-line",
    "wide-interval",
    "noisy-points",
    "wall",
    "unit-unknown",
    "unit-not-systems",
    "strange-size",
    "small-angles",
    "no-rotation",
    "rounded-points",
    "file-missing",
    "no-photo-folder",
    "reduced-photos",
    "file-unreadable",
    "file-size",
    "solved-on-other",
    "off-its-points",
    "same-file",
    "other-place",
    "other-length",
    "other-heights",
    "smaller-photos",
    "far-from-surface",
    "other-unit",
    "under-surface",
    "from-behind",
    "turned-mesh",
    "strange-camera",
    "several-devices",
    "other-device",
    "focal-length",
    "flying-height",
    "laser-range",
    "other-colours",
    "other-distance",
    "partly-there",
    "matches-nowhere",
    "others-elsewhere",
    "others-nowhere",
    "flipped",
];

/// The kind of this name, if there is one.
pub(crate) fn kind_named(name: &str) -> Option<&'static str> {
    KINDS.into_iter().find(|kind| *kind == name)
}

/// The kind whose name is much like this one.
pub(crate) fn nearest_kind(name: &str) -> Option<&'static str> {
    let distance = |kind: &str| strsim::damerau_levenshtein(name, kind);
    let nearest = KINDS.into_iter().min_by_key(|kind| distance(kind))?;
    (distance(nearest) <= 1 + nearest.len() / 2).then_some(nearest)
}

impl Doubt {
    /// What kind of reason it is, as one word: the same for another number.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NoScale(_) => "no-scale",
            Self::OffSurface(_) => "off-surface",
            Self::NoPoint(_) => "no-point",
            Self::NoFit { .. } => "no-fit",
            Self::NoLine => "no-line",
            Self::Ratio { .. } => "ratio",
            Self::Sideways { .. } => "sideways",
            Self::LongTriangle { .. } => "long-triangle",
            Self::FlatView { .. } => "flat-view",
            Self::NotPlane { .. } => "not-plane",
            Self::OffLine { .. } => "off-line",
            Self::WideInterval { .. } => "wide-interval",
            Self::NoisyPoints { .. } => "noisy-points",
            Self::Wall { .. } => "wall",
            Self::UnitUnknown => "unit-unknown",
            Self::UnitNotSystems { .. } => "unit-not-systems",
            Self::StrangeSize { .. } => "strange-size",
            Self::SmallAngles { .. } => "small-angles",
            Self::NoRotation { .. } => "no-rotation",
            Self::RoundedPoints { .. } => "rounded-points",
            Self::FileMissing { .. } => "file-missing",
            Self::NoPhotoFolder { .. } => "no-photo-folder",
            Self::ReducedPhotos { .. } => "reduced-photos",
            Self::FileUnreadable(_) => "file-unreadable",
            Self::FileSize { .. } => "file-size",
            Self::SolvedOnOther { .. } => "solved-on-other",
            Self::OffItsPoints { .. } => "off-its-points",
            Self::SameFile { .. } => "same-file",
            Self::OtherPlace { .. } => "other-place",
            Self::OtherLength { .. } => "other-length",
            Self::OtherHeights { .. } => "other-heights",
            Self::SmallerPhotos { .. } => "smaller-photos",
            Self::FarFromSurface { .. } => "far-from-surface",
            Self::OtherUnit { .. } => "other-unit",
            Self::UnderSurface => "under-surface",
            Self::FromBehind => "from-behind",
            Self::TurnedMesh => "turned-mesh",
            Self::StrangeCamera { .. } => "strange-camera",
            Self::SeveralDevices { .. } => "several-devices",
            Self::OtherDevice { .. } => "other-device",
            Self::FocalLength { .. } => "focal-length",
            Self::FlyingHeight { .. } => "flying-height",
            Self::LaserRange { .. } => "laser-range",
            Self::OtherColours { .. } => "other-colours",
            Self::OtherDistance { .. } => "other-distance",
            Self::PartlyThere { .. } => "partly-there",
            Self::MatchesNowhere { .. } => "matches-nowhere",
            Self::OthersElsewhere { .. } => "others-elsewhere",
            Self::OthersNowhere { .. } => "others-nowhere",
            Self::Flipped { .. } => "flipped",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every arm of `kind` above must be a word of the list, or a saved flight could not be read: the
    /// source itself is the only list of all arms.
    #[test]
    fn every_kind_is_listed_once() {
        let source = include_str!("kind.rs");
        let arms: Vec<&str> = source
            .lines()
            .filter_map(|line| line.trim().strip_prefix("Self::")?.split_once("=> \""))
            .filter_map(|(_, word)| word.strip_suffix("\","))
            .collect();
        let (mut arms, mut kinds) = (arms, KINDS.to_vec());
        arms.sort_unstable();
        kinds.sort_unstable();
        assert_eq!(arms, kinds);
        assert_eq!(nearest_kind("flat_view"), Some("flat-view"));
        assert_eq!(nearest_kind("weather"), None);
    }
}

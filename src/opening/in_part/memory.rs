//! How much memory may be used for a cloud, and what its points take.

use super::memory_size::memory_in_words;
use crate::fault::Fault;

/// Bytes that a point takes where all of a cloud is read (measured at 5 to 100 million points: 52 to 59).
const OF_WHOLE: u64 = 60;

/// Bytes that a point of a part takes: 24 for itself, as much for its site, 48 for two triangles and how well it is
/// predicted; some more while it is sorted.
const OF_PART: u64 = 100;

/// Clouds with fewer points a photo are read whole: some rays are cast at all of their triangles.
const LEAST_POINTS_A_PHOTO: u64 = 60;

/// As many photos count at least.
const LEAST_PHOTOS: u64 = 200;

/// How much memory may be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Memory {
    /// Bytes.
    pub most: u64,
    /// Whether a cloud that would fit is read in part, too. For tests.
    pub always_in_part: bool,
}

impl Memory {
    /// Whether a cloud of so many points is read whole.
    pub(super) fn holds_whole(&self, points: u64, photos: usize) -> bool {
        let photos = (photos as u64).max(LEAST_PHOTOS);
        points < LEAST_POINTS_A_PHOTO * photos || self.has_room(points) && !self.always_in_part
    }

    /// Whether all of so many points have room.
    pub(super) fn has_room(&self, points: u64) -> bool {
        points.saturating_mul(OF_WHOLE) <= self.most
    }

    /// Refuses a part of about so many points, of so many in all, that has no room.
    pub(super) fn check_part(&self, points: u64, of: u64) -> Result<(), Fault> {
        let needed = points.saturating_mul(OF_PART);
        if needed <= self.most || self.always_in_part {
            return Ok(());
        }
        // A point of a part takes more: what is asked for is the lesser of the two.
        if of.saturating_mul(OF_WHOLE) <= needed {
            return Err(self.refuse_whole(of, "what its photos see"));
        }
        Err(Fault::new(
            format!(
                "its photos see about {points} of its points, which need {} of memory, and {} may be used",
                memory_in_words(needed),
                memory_in_words(self.most)
            ),
            "allow more (--memory), leave photos out that look far, or thin the cloud",
        ))
    }

    /// That a surface of so many points, which was read whole, takes more; `None` where it does not.
    pub(super) fn exceeded(&self, points: u64) -> Option<String> {
        let needed = memory_in_words(points.saturating_mul(OF_WHOLE));
        let most = memory_in_words(self.most);
        (!self.has_room(points)).then(|| {
            format!(
                "its {points} points take {needed} of memory, more than {most}: only LAS, LAZ, COPC and EPT are read in part"
            )
        })
    }

    /// Refuses a cloud that something needs all of.
    pub(super) fn refuse_whole(&self, points: u64, why: &str) -> Fault {
        let needed = points.saturating_mul(OF_WHOLE);
        Fault::new(
            format!(
                "{why} needs all of its {points} points, {} of memory, and {} may be used",
                memory_in_words(needed),
                memory_in_words(self.most)
            ),
            "allow more (--memory), or thin the cloud with another program",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_refused_with_what_it_would_need() {
        let memory = Memory {
            most: 8_000_000_000,
            always_in_part: false,
        };
        assert!(memory.holds_whole(133_000_000, 9) && !memory.holds_whole(134_000_000, 9));
        assert_eq!(memory.check_part(80_000_000, 900_000_000), Ok(()));
        let what = memory
            .check_part(230_000_000, 900_000_000)
            .unwrap_err()
            .what;
        assert!(
            what.contains("230000000 of its points, which need 23 GB of memory, and 8000 MB"),
            "{what}"
        );
        let what = memory
            .check_part(230_000_000, 300_000_000)
            .unwrap_err()
            .what;
        assert!(
            what.contains("needs all of its 300000000 points, 18 GB of memory, and 8000 MB"),
            "{what}"
        );
        assert_eq!(memory.exceeded(133_000_000), None);
        let what = memory.exceeded(140_000_000).unwrap();
        assert!(
            what.contains("take 8400 MB of memory, more than 8000 MB"),
            "{what}"
        );
        let small = Memory {
            most: 1,
            always_in_part: true,
        };
        assert!(small.holds_whole(11_999, 9) && !small.holds_whole(12_000, 9));
        assert!(small.holds_whole(59_999, 1000) && !small.holds_whole(60_000, 1000));
    }
}

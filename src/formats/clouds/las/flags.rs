//! Points that a LAS file marks as no ground (LAS 1.4 - R15, tables 8, 9, 16 and 17): withheld ones, which are to be
//! taken as deleted, and those that somebody classified as noise, low (7) or high (18). No point is dropped for it, as in other
//! programs that read all of a file, and whoever reads it is told.

/// What a point is marked as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    Withheld,
    Noise,
}

/// What the point of a record is marked as. Records of point formats from 6 on are extended.
pub(super) fn mark_of(record: &[u8], is_extended: bool) -> Option<Mark> {
    // No format has shorter records.
    let (flags, class) = (*record.get(15)?, *record.get(16)?);
    let (is_withheld, is_noise) = match is_extended {
        true => (flags & 0b0100 != 0, matches!(class, 7 | 18)),
        // One byte has both: five bits of the class, synthetic, key-point, withheld.
        false => (flags & 0b1000_0000 != 0, flags & 0b1_1111 == 7),
    };
    match (is_withheld, is_noise) {
        (true, _) => Some(Mark::Withheld),
        (false, true) => Some(Mark::Noise),
        (false, false) => None,
    }
}

/// How many points of a file are marked so.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct Marked {
    withheld: u64,
    noise: u64,
}

impl Marked {
    pub(super) fn add(&mut self, mark: Mark) {
        match mark {
            Mark::Withheld => self.withheld += 1,
            Mark::Noise => self.noise += 1,
        }
    }

    /// What is to be said of them.
    pub(super) fn warning(self) -> Option<String> {
        let Self { withheld, noise } = self;
        let said = [
            (withheld > 0).then(|| format!("{withheld} points that it marks as withheld")),
            (noise > 0).then(|| format!("{noise} that it classifies as noise (7, 18)")),
        ];
        let said: Vec<String> = said.into_iter().flatten().collect();
        (!said.is_empty()).then(|| format!("{} are taken as rock like all others: if they are none, export the file without them", said.join(" and ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the tables of the specification.
    #[test]
    fn marks_stand_where_the_specification_has_them() {
        let of = |flags: u8, class: u8, is_extended| {
            let mut record = [0; 20];
            (record[15], record[16]) = (flags, class);
            mark_of(&record, is_extended)
        };
        // Class 2 (ground), synthetic and key-point; withheld; class 7; both. The scan angle behind it says nothing.
        assert_eq!(of(0b0110_0010, 7, false), None);
        assert_eq!(of(0b1000_0010, 0, false), Some(Mark::Withheld));
        assert_eq!(of(7, 0, false), Some(Mark::Noise));
        assert_eq!(of(0b1000_0111, 0, false), Some(Mark::Withheld));
        // Synthetic, key-point, overlap, edge of flight line; withheld; low and high noise.
        assert_eq!(of(0b1000_1011, 2, true), None);
        assert_eq!(of(0b0000_0100, 2, true), Some(Mark::Withheld));
        assert_eq!(of(0, 7, true), Some(Mark::Noise));
        assert_eq!(of(0, 18, true), Some(Mark::Noise));
    }
}

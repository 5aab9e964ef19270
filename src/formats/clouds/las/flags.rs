//! Points that a LAS file holds and that are no ground (LAS 1.4 - R15, tables 8, 9, 16 and 17): withheld ones, which are to be
//! taken as deleted, and those that somebody classified as noise, low (7) or high (18).

/// Why a point does not count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::clouds) enum Why {
    Withheld,
    Noise,
}

/// Why the point of a record does not count; `None` of one that does. Records of point formats from 6 on are extended.
pub(in crate::clouds) fn why_not(record: &[u8], is_extended: bool) -> Option<Why> {
    // No format has shorter records.
    let (flags, class) = (*record.get(15)?, *record.get(16)?);
    let (is_withheld, is_noise) = match is_extended {
        true => (flags & 0b0100 != 0, matches!(class, 7 | 18)),
        // One byte has both: five bits of the class, synthetic, key-point, withheld.
        false => (flags & 0b1000_0000 != 0, flags & 0b1_1111 == 7),
    };
    match (is_withheld, is_noise) {
        (true, _) => Some(Why::Withheld),
        (false, true) => Some(Why::Noise),
        (false, false) => None,
    }
}

/// How many points of a file do not count.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct LeftOut {
    withheld: u64,
    noise: u64,
}

impl LeftOut {
    pub(super) fn add(&mut self, why: Why) {
        match why {
            Why::Withheld => self.withheld += 1,
            Why::Noise => self.noise += 1,
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
        (!said.is_empty()).then(|| format!("{} are left out", said.join(" and ")))
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
            why_not(&record, is_extended)
        };
        // Class 2 (ground), synthetic and key-point; withheld; class 7; both. The scan angle behind it says nothing.
        assert_eq!(of(0b0110_0010, 7, false), None);
        assert_eq!(of(0b1000_0010, 0, false), Some(Why::Withheld));
        assert_eq!(of(7, 0, false), Some(Why::Noise));
        assert_eq!(of(0b1000_0111, 0, false), Some(Why::Withheld));
        // Synthetic, key-point, overlap, edge of flight line; withheld; low and high noise.
        assert_eq!(of(0b1000_1011, 2, true), None);
        assert_eq!(of(0b0000_0100, 2, true), Some(Why::Withheld));
        assert_eq!(of(0, 7, true), Some(Why::Noise));
        assert_eq!(of(0, 18, true), Some(Why::Noise));
    }
}

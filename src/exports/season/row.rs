//! What a season's tables say of a flight.

use serde::{Deserialize, Serialize};

use crate::flight::{Date, Review, Verdict};
use crate::units::LengthUnit;

/// The flights of a season.
#[derive(Debug, Clone, PartialEq)]
pub struct SeasonReport<'a> {
    /// Of the season.
    pub name: &'a str,
    /// Of all sizes.
    pub unit: LengthUnit,
    /// In the order of the blasts.
    pub rows: Vec<SeasonRow>,
    /// What else is to be said, a sentence each.
    pub notes: Vec<String>,
}

/// A flight.
#[derive(Debug, Clone, PartialEq)]
pub struct SeasonRow {
    /// Of the blast.
    pub blast: String,
    /// When it was flown, where that is known.
    pub date: Option<Date>,
    /// Its file or folder.
    pub flight: String,
    /// The folder of its results, below that of the season.
    pub results: String,
    /// What came of it; `None` where it could not be opened.
    pub findings: Option<FlightFindings>,
    /// Why it, or a step of it, failed.
    pub error: Option<String>,
}

impl SeasonRow {
    /// "done" or "failed".
    pub fn state(&self) -> &'static str {
        match self.error {
            None => "done",
            Some(_) => "failed",
        }
    }

    /// A size that so many percent pass.
    pub fn size(&self, percent: f64) -> Option<FoundSize> {
        let sizes = self.findings.iter().flat_map(|findings| &findings.sizes);
        let mut sizes = sizes.filter(|size| size.percent == percent);
        sizes.next().copied()
    }
}

/// What came of a flight.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FlightFindings {
    /// How many photos it has.
    pub photos: usize,
    /// How many of them have which verdict.
    pub verdicts: VerdictCounts,
    /// Of all outlined fragments together, in the season's unit; empty where none were outlined.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sizes: Vec<FoundSize>,
    /// How far these are from the reference.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shifts: Vec<SizeShift>,
    /// The day of its first photo, by the camera's clock.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub taken: Option<String>,
    /// What its steps warned of.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

/// A size of all fragments of a flight.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FoundSize {
    /// What passes it.
    pub percent: f64,
    /// Itself; `None` where it is smaller than anything that is claimed.
    pub size: Option<f64>,
    /// The lower end of its 95 % interval.
    pub low: Option<f64>,
    /// The upper end; `None` where it lies among fragments that are too large to be seen whole.
    pub high: Option<f64>,
}

/// How far a size is from the reference's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SizeShift {
    /// What passes it.
    pub percent: f64,
    /// Percent of the reference's; positive is coarser.
    pub off_percent: f64,
}

/// How many photos have which verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct VerdictCounts {
    /// No doubt.
    pub trust: usize,
    /// Doubts that somebody has looked at.
    pub accepted: usize,
    /// Doubts.
    pub check: usize,
    /// Left out by somebody.
    pub left_out: usize,
    /// No scale.
    pub no_scale: usize,
}

impl VerdictCounts {
    /// Of a review.
    pub fn of(review: &Review) -> Self {
        Self {
            trust: review.count_of(Verdict::Trust),
            accepted: review.count_of(Verdict::Accepted),
            check: review.count_of(Verdict::Check),
            left_out: review.count_of(Verdict::LeftOut),
            no_scale: review.count_of(Verdict::NoScale),
        }
    }

    /// With their verdicts, best first.
    pub fn counts(&self) -> [(Verdict, usize); 5] {
        let Self {
            trust,
            accepted,
            check,
            left_out,
            no_scale,
        } = *self;
        [
            (Verdict::Trust, trust),
            (Verdict::Accepted, accepted),
            (Verdict::Check, check),
            (Verdict::LeftOut, left_out),
            (Verdict::NoScale, no_scale),
        ]
    }

    /// "7 trust, 2 check".
    pub fn in_words(&self) -> String {
        let counts = self.counts().into_iter().filter(|(_, count)| *count > 0);
        let words: Vec<String> = counts
            .map(|(verdict, count)| format!("{count} {verdict}"))
            .collect();
        words.join(", ")
    }
}

//! What the engineer has decided of a photo: the `[[review]]` tables of a flight.toml. A decision is
//! hers, a verdict is the program's: one does not replace the other.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::date::Date;
use super::doubt::kind::{kind_named, nearest_kind};
use super::{Doubt, Flight};
use crate::fault::{Fault, first_names, one_line};

/// What is to be done with a photo, whatever the program says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DecisionKind {
    /// She has looked at the reasons for doubt, and takes the photo along.
    Accepted,
    /// The photo does not go along.
    LeftOut,
}

impl DecisionKind {
    /// As a flight.toml writes it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Accepted => "accepted",
            Self::LeftOut => "left-out",
        }
    }
}

/// What the engineer has decided of one photo.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decision {
    /// The photo's name.
    pub photo: String,
    /// What is to be done with it.
    pub kind: DecisionKind,
    /// Why, in her words, one line; empty where she says nothing.
    pub note: String,
    /// When she decided, where it is said.
    pub date: Option<Date>,
    /// The kinds of the reasons for doubt that she has looked at ([`Doubt::kind`]); `None` where a
    /// person wrote the table and named none: then it holds for all.
    pub reasons: Option<Vec<String>>,
}

impl Decision {
    /// A decision about a photo that is doubted for these reasons.
    pub fn new(photo: &str, kind: DecisionKind, doubts: &[Doubt]) -> Self {
        let mut reasons: Vec<String> = doubts.iter().map(|d| d.kind().to_owned()).collect();
        reasons.dedup();
        Self {
            photo: photo.to_owned(),
            kind,
            note: String::new(),
            date: None,
            reasons: (kind == DecisionKind::Accepted).then_some(reasons),
        }
    }

    /// Those of the reasons that were not there when she accepted the photo. Numbers in a reason may
    /// change, its kind may not: a view of 28.4° instead of 28.3° is the same doubt.
    pub fn new_reasons<'a>(&self, doubts: &'a [Doubt]) -> Vec<&'a Doubt> {
        let Some(known) = &self.reasons else {
            return Vec::new();
        };
        let is_new = |doubt: &&Doubt| !known.iter().any(|kind| kind == doubt.kind());
        doubts.iter().filter(is_new).collect()
    }

    /// Whether she looked at all of these reasons.
    pub fn covers(&self, doubts: &[Doubt]) -> bool {
        self.new_reasons(doubts).is_empty()
    }
}

/// "checked, accepted on 2026-11-22: the toe is flat".
impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.kind {
            DecisionKind::Accepted => "checked, accepted",
            DecisionKind::LeftOut => "left out",
        })?;
        if let Some(date) = self.date {
            write!(f, " on {date}")?;
        }
        if !self.note.is_empty() {
            write!(f, ": {}", self.note)?;
        }
        Ok(())
    }
}

/// What was decided of a photo: the first that names it.
pub(super) fn of_photo<'a>(decisions: &'a [Decision], photo: &str) -> Option<&'a Decision> {
    decisions.iter().find(|decision| decision.photo == photo)
}

impl Flight {
    /// A sentence for each decision about a photo that the flight does not have.
    pub fn decisions_without_photo(&self, decisions: &[Decision]) -> Vec<String> {
        let missing = decisions
            .iter()
            .filter_map(|decision| Some((decision, self.photo_named(&decision.photo).err()?)));
        missing
            .map(|(decision, fault)| {
                let what = format!(
                    "a review is of photo '{}', which the flight does not have",
                    decision.photo
                );
                Fault::new(what, fault.remedy).to_string()
            })
            .collect()
    }

    /// The chosen photos (places in the flight) without those that a decision leaves out, and a sentence that names these.
    ///
    /// # Errors
    /// Where all of them are left out.
    pub fn without_left_out(
        &self,
        chosen: Vec<usize>,
        decisions: &[Decision],
    ) -> Result<(Vec<usize>, Option<String>), Fault> {
        let name = |index: usize| self.parts().photos[index].name.as_str();
        let is_out = |index: &usize| {
            of_photo(decisions, name(*index)).is_some_and(|of| of.kind == DecisionKind::LeftOut)
        };
        let (out, kept): (Vec<usize>, Vec<usize>) = chosen.into_iter().partition(is_out);
        if out.is_empty() {
            return Ok((kept, None));
        }
        let names: Vec<&str> = out.iter().map(|index| name(*index)).collect();
        let names = first_names(&names);
        if kept.is_empty() {
            let what = format!("the review leaves all of these photos out: {names}");
            return Err(Fault::new(what, "take one along again, or name it"));
        }
        let said = format!(
            "the review leaves {} out of {}: {names}",
            out.len(),
            out.len() + kept.len()
        );
        Ok((kept, Some(said)))
    }
}

/// As it stands in the file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct DecisionEntry {
    pub(super) photo: String,
    decision: KindEntry,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    note: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    date: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    reasons: Option<Vec<String>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum KindEntry {
    #[serde(rename = "accepted")]
    Accepted,
    #[serde(rename = "left-out")]
    LeftOut,
}

impl From<&DecisionEntry> for Decision {
    fn from(entry: &DecisionEntry) -> Self {
        Self {
            photo: entry.photo.clone(),
            kind: match entry.decision {
                KindEntry::Accepted => DecisionKind::Accepted,
                KindEntry::LeftOut => DecisionKind::LeftOut,
            },
            note: one_line(&entry.note),
            // `parse` has checked it.
            date: entry.date.as_deref().and_then(|date| date.parse().ok()),
            reasons: entry.reasons.clone(),
        }
    }
}

impl From<&Decision> for DecisionEntry {
    fn from(decision: &Decision) -> Self {
        Self {
            photo: decision.photo.clone(),
            decision: match decision.kind {
                DecisionKind::Accepted => KindEntry::Accepted,
                DecisionKind::LeftOut => KindEntry::LeftOut,
            },
            note: decision.note.clone(),
            date: decision.date.map(|date| date.to_string()),
            reasons: decision.reasons.clone(),
        }
    }
}

impl DecisionEntry {
    /// What is wrong with it, as the key, a sentence and what to do; `None` where nothing is. `before`
    /// are the tables above it.
    pub(super) fn trouble(&self, before: &[Self]) -> Option<(&'static str, String, String)> {
        let photo = &self.photo;
        if photo.is_empty() {
            let what = "review.photo is empty".to_owned();
            return Some(("photo", what, "name the photo".to_owned()));
        }
        if before.iter().any(|other| other.photo == *photo) {
            let what = format!("photo '{photo}' has two [[review]] tables");
            return Some(("photo", what, "keep the one that holds".to_owned()));
        }
        if let Some(date) = &self.date
            && let Err(what) = date.parse::<Date>()
        {
            let remedy = "write year-month-day, like \"2026-11-22\"".to_owned();
            return Some(("date", format!("review.date {what}"), remedy));
        }
        let mut reasons = self.reasons.iter().flatten();
        let unknown = reasons.find(|reason| kind_named(reason).is_none())?;
        let what = format!("review.reasons has '{unknown}', which is no reason for doubt");
        let remedy = match nearest_kind(unknown) {
            Some(kind) => format!("did you mean '{kind}'?"),
            None => "correct it, or remove reasons: then it holds for all".to_owned(),
        };
        Some(("reasons", what, remedy))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reason_of_another_kind_is_new_another_number_is_not() {
        let flat = |angle| Doubt::FlatView { angle, limit: 30.0 };
        let off = Doubt::OffLine {
            percent: 9.0,
            limit: 8.0,
        };
        let accepted = Decision::new("a", DecisionKind::Accepted, &[flat(28.0)]);
        assert!(accepted.covers(&[flat(12.0)]) && accepted.covers(&[]));
        assert_eq!(accepted.new_reasons(&[flat(12.0), off.clone()]), [&off]);
        let by_hand = Decision {
            reasons: None,
            ..accepted
        };
        assert!(by_hand.covers(&[flat(12.0), off]));
    }

    #[test]
    fn what_is_left_out_counts_nowhere() {
        let mut parts = crate::flight::tests::flight().parts().clone();
        let mut second = parts.photos[0].clone();
        second.name = "b.jpg".to_owned();
        parts.photos.push(second);
        let flight = Flight::new(parts).unwrap();
        let names: Vec<String> = (flight.parts().photos.iter())
            .map(|photo| photo.name.clone())
            .collect();
        let all: Vec<usize> = (0..names.len()).collect();
        let of = |kind, photos: &[String]| -> Vec<Decision> {
            let photos = photos.iter();
            photos
                .map(|photo| Decision::new(photo, kind, &[]))
                .collect()
        };
        let accepted = of(DecisionKind::Accepted, &names);
        let kept = flight.without_left_out(all.clone(), &accepted).unwrap();
        assert_eq!(kept, (all.clone(), None));
        let first = of(DecisionKind::LeftOut, &names[..1]);
        let (kept, said) = flight.without_left_out(all.clone(), &first).unwrap();
        assert_eq!(kept, all[1..]);
        assert!(said.unwrap().ends_with(&names[0]));
        let none = flight.without_left_out(all, &of(DecisionKind::LeftOut, &names));
        assert!(none.unwrap_err().what.starts_with("the review leaves all"));
    }

    #[test]
    fn a_decision_is_a_sentence() {
        let mut decision = Decision::new("a", DecisionKind::Accepted, &[]);
        assert_eq!(decision.to_string(), "checked, accepted");
        decision.date = "2026-11-22".parse().ok();
        decision.note = "flat toe".to_owned();
        assert_eq!(
            decision.to_string(),
            "checked, accepted on 2026-11-22: flat toe"
        );
        decision.kind = DecisionKind::LeftOut;
        assert_eq!(decision.to_string(), "left out on 2026-11-22: flat toe");
    }
}

//! One photo of a review: what is known of it, and what follows.

use crate::camera::Camera;
use crate::flight::{
    Decision, DecisionKind, Doubt, Outcome, Photo, PhotoFileState, TogetherFound, Verdict,
};
use crate::scale::{
    CornerOutcome, EdgeScales, FieldFacts, FittedScale, PhotoScale, ScaleEstimate, ScalePair,
    Uncertainty, ViewFacts,
};
use crate::units::LengthUnit;

/// Which photos go along into an export, beside what the engineer has decided of single ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// All but those that she leaves out.
    All,
    /// Those without doubt, and those that she has accepted.
    Trusted,
}

/// What is known of one photo.
#[derive(Debug, Clone, Copy)]
pub struct PhotoReview<'a> {
    /// The photo.
    pub photo: &'a Photo,
    /// That it was taken with.
    pub camera: &'a Camera,
    /// Its image file.
    pub file: &'a PhotoFileState,
    /// Whether it and those beside it see the surface where it is.
    pub together: &'a TogetherFound,
    /// Its scale, pixels per world unit.
    pub outcome: &'a Outcome,
    /// How it looks at the surface; `None` where it has no scale, or while nobody has looked.
    pub view: Option<&'a ViewFacts>,
    /// What its scale field says; `None` where it has no scale, or while nobody has computed it.
    pub field: Option<&'a FieldFacts>,
    /// What speaks against its scale, the gravest first.
    pub doubts: &'a [Doubt],
    /// What follows from them and from `decision`.
    pub verdict: Verdict,
    /// What follows from them alone.
    pub own_verdict: Verdict,
    /// What the engineer has decided.
    pub decision: Option<&'a Decision>,
    /// Whether footprints and scale fields were looked at: until then [`Verdict::Trust`] is not the last
    /// word.
    pub is_looked_at: bool,
    /// `Limits::triangle_share`.
    pub(in crate::flight) triangle_share: f64,
    /// Which scales go to Split-Desktop.
    pub pair: ScalePair,
    /// Of the world.
    pub unit: LengthUnit,
    /// Whether somebody says that it is this unit.
    pub unit_known: bool,
}

impl<'a> PhotoReview<'a> {
    /// The photo's name.
    pub fn name(&self) -> &'a str {
        &self.photo.name
    }

    /// Its corners and scales, where it has any.
    pub fn scale(&self) -> Option<&'a PhotoScale> {
        self.outcome.scale()
    }

    /// The same where the numbers mean something: the unit is known.
    pub fn scale_to_type(&self) -> Option<&'a PhotoScale> {
        self.scale().filter(|_| self.unit_known)
    }

    /// Whether it shows the surface, as far as anybody has looked: at a corner, or between them. What stands where no photo of this
    /// surface can shows none of it.
    pub fn sees_surface(&self) -> bool {
        let is_elsewhere = |doubt: &Doubt| {
            matches!(
                doubt,
                Doubt::FarFromSurface { .. } | Doubt::OtherUnit { .. }
            )
        };
        if self.doubts.iter().any(is_elsewhere) {
            return false;
        }
        let mut corners = self.scale().into_iter().flat_map(|scale| &scale.corners);
        corners.any(|corner| matches!(corner.outcome, CornerOutcome::OnSurface { .. }))
            || self.field.is_some_and(|field| field.covered > 0.0)
    }

    /// Pixels per `unit` along its edges; see [`Self::scale_to_type`] for whether they mean it.
    pub fn edges(&self, unit: LengthUnit) -> EdgeScales {
        let scale = self.scale().map(|scale| scale.scale).unwrap_or_default();
        // Pixels per world unit, times world units per unit.
        scale.times(unit.in_units_of(self.unit))
    }

    /// The best line through its scale field, pixels per `unit`.
    pub fn fitted(&self, unit: LengthUnit) -> Option<FittedScale> {
        let fitted = self.field?.fitted?;
        Some(fitted.times(unit.in_units_of(self.unit)))
    }

    /// How sure its scales are, pixels per `unit`.
    pub fn uncertainty(&self, unit: LengthUnit) -> Option<Uncertainty> {
        let uncertainty = self.field?.uncertainty.as_ref()?;
        Some(uncertainty.times(unit.in_units_of(self.unit)))
    }

    /// Top and bottom scale for Split-Desktop, pixels per `unit`: of the best line, or of the corners,
    /// as the flight says; nothing stands in for a line that is not there.
    pub fn pair(&self, unit: LengthUnit) -> [Option<f64>; 2] {
        let estimates = self.estimates(self.pair, unit);
        estimates.map(|estimate| Some(estimate?.value))
    }

    /// Top and bottom scale of either pair with how sure they are, pixels per `unit`.
    pub fn estimates(&self, pair: ScalePair, unit: LengthUnit) -> [Option<ScaleEstimate>; 2] {
        let sure = self.uncertainty(unit).unwrap_or_default();
        let (values, intervals) = match pair {
            ScalePair::Corners => {
                let edges = self.edges(unit);
                ([edges.top, edges.bottom], [sure.top, sure.bottom])
            }
            ScalePair::Fitted => {
                let fitted = self.fitted(unit);
                let values = [fitted.map(|f| f.top), fitted.map(|f| f.bottom)];
                (values, [sure.fitted_top, sure.fitted_bottom])
            }
        };
        std::array::from_fn(|edge| {
            Some(ScaleEstimate {
                value: values[edge]?,
                interval: intervals[edge],
            })
        })
    }

    /// How many of its corners are on the surface; `None` where nothing was computed.
    pub fn corners_on_surface(&self) -> Option<usize> {
        self.scale().map(PhotoScale::corners_on_surface)
    }

    /// What to do with its scale; `None` while nothing speaks against it, but nobody has looked at its
    /// footprint and its scale field yet.
    pub fn settled(&self) -> Option<Verdict> {
        (self.verdict != Verdict::Trust || self.is_looked_at).then_some(self.verdict)
    }

    /// Whether something speaks against it, whatever the engineer has decided: those are the photos that
    /// she reviews.
    pub fn is_doubtful(&self) -> bool {
        self.own_verdict != Verdict::Trust
    }

    /// Whether it is doubtful, and she has not decided about it for the reasons of now.
    pub fn waits_for_decision(&self) -> bool {
        let decided = self.decision.is_some_and(|decision| {
            decision.kind == DecisionKind::LeftOut || decision.covers(self.doubts)
        });
        self.is_doubtful() && !decided
    }

    /// Whether it goes along into an export: the one place that says so, for the window and the command.
    /// What she leaves out never goes; what she has accepted for the reasons of now always does, with a
    /// scale or without; else the verdict says it, once it is the last word.
    pub fn goes_along(&self, along: Along) -> bool {
        match (along, self.decision) {
            (_, Some(decision)) if decision.kind == DecisionKind::LeftOut => false,
            (Along::All, _) => true,
            (Along::Trusted, Some(decision)) if decision.covers(self.doubts) => true,
            (Along::Trusted, _) => self.settled() == Some(Verdict::Trust),
        }
    }

    /// The decision by which it goes along with those that are trusted, or does not; `None` where it
    /// does so by itself. What she has noted stays: then there is always a decision that has it.
    pub fn decision_to(&self, go_along: bool) -> Option<Decision> {
        if self.goes_along(Along::Trusted) == go_along {
            return self.decision.cloned();
        }
        let by_itself = self.own_verdict == Verdict::Trust && self.is_looked_at;
        let kind = match go_along {
            true => DecisionKind::Accepted,
            false => DecisionKind::LeftOut,
        };
        let note = self.decision.map(|decision| decision.note.clone());
        let note = note.unwrap_or_default();
        (by_itself != go_along || !note.is_empty()).then(|| Decision {
            note,
            ..Decision::new(self.name(), kind, self.doubts)
        })
    }

    /// The reasons for doubt that were not there when the engineer accepted the photo: then it was
    /// accepted for others, and counts as not accepted until she looks again.
    pub fn reasons_since_accepted(&self) -> Vec<&'a Doubt> {
        let accepted = self.decision.filter(|d| d.kind == DecisionKind::Accepted);
        accepted.map_or_else(Vec::new, |decision| decision.new_reasons(self.doubts))
    }

    /// What the engineer has decided as a sentence, with what has changed since.
    pub fn decided(&self) -> Option<String> {
        let decision = self.decision?;
        let since = self.reasons_since_accepted();
        Some(match since.is_empty() {
            true => decision.to_string(),
            false => {
                let kinds: Vec<&str> = since.iter().map(|doubt| doubt.kind()).collect();
                let kinds = kinds.join(", ");
                format!("{decision} (for other reasons: {kinds} came since; look again)")
            }
        })
    }

    /// Why its scale is doubted, one sentence each.
    pub fn reasons(&self) -> Vec<String> {
        self.doubts.iter().map(Doubt::to_string).collect()
    }

    /// The same, and behind them what the engineer has decided.
    pub fn reasons_and_decision(&self) -> Vec<String> {
        let mut all = self.reasons();
        all.extend(self.decided());
        all
    }

    /// What every list of scales has to say beside its numbers, one sentence each: what fell back or
    /// failed, that the scale is for another image than the engineer has, that it is not of this pile.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if !self.unit_known {
            notes.push(Doubt::UnitUnknown.to_string());
        }
        match self.outcome {
            Outcome::Trouble(trouble) => notes.push(trouble.clone()),
            Outcome::Scale(scale) => notes.extend(scale.notes(match self.unit_known {
                true => self.unit.symbol(),
                false => "of the model's own units",
            })),
        }
        let said = |doubt: &&Doubt| {
            doubt.is_of_the_pile()
                || doubt.is_of_the_number() && **doubt != Doubt::UnitUnknown
                || matches!(doubt, Doubt::NoFit { .. } | Doubt::NoLine)
        };
        notes.extend(self.doubts.iter().filter(said).map(Doubt::to_string));
        notes
    }
}

//! How the photos of a survey lie, as it is typed.

use clap::Args;

use super::pixel_scale::PixelScale;
use crate::cli::planning::flying::percent;
use crate::plan::{Size, SurveyWish, USUAL_SURVEY_OVERLAP};
use crate::units::LengthUnit;

#[derive(Debug, Args)]
pub(super) struct SurveyArguments {
    /// How much a photo of the survey shares with the next, of patterns that have one, in percent; else 70.
    #[arg(long, value_name = "PERCENT", value_parser = percent, allow_hyphen_values = true)]
    survey_overlap: Option<f64>,
    /// The scale of the survey's photos, as '1 px/cm', where it is not that of the others.
    #[arg(long, value_name = "N px/UNIT", allow_hyphen_values = true)]
    survey_scale: Option<PixelScale>,
    /// Fly rows straight down across the others, too, of a survey.
    #[arg(long)]
    cross_grid: bool,
    /// Leave out the photos of a survey that look aslant into the area from around it.
    #[arg(long)]
    no_ring: bool,
}

impl SurveyArguments {
    /// The first option of a survey that was typed.
    pub(super) fn typed(&self) -> Option<&'static str> {
        let options = [
            (self.survey_overlap.is_some(), "--survey-overlap"),
            (self.survey_scale.is_some(), "--survey-scale"),
            (self.cross_grid, "--cross-grid"),
            (self.no_ring, "--no-ring"),
        ];
        let typed = options.into_iter().find(|(is_typed, _)| *is_typed);
        typed.map(|(_, option)| option)
    }

    /// Whether the survey's overlap was typed.
    pub(super) fn has_overlap(&self) -> bool {
        self.survey_overlap.is_some()
    }

    /// In a world of this unit.
    pub(super) fn wish(&self, unit: LengthUnit) -> SurveyWish {
        SurveyWish {
            overlap: self
                .survey_overlap
                .map_or(USUAL_SURVEY_OVERLAP, |percent| percent / 100.0),
            cross: self.cross_grid,
            ring: !self.no_ring,
            size: self.survey_scale.map(|scale| Size::scale(scale.per(unit))),
        }
    }
}

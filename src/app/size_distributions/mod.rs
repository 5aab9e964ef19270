//! The page of size distributions: what was read, how it is looked at, what was computed from it.
//!
//! ```text
//! command     what the engineer can do on it
//! applying    does that
//! reading     files and pasted tables, as a job
//! source      what came from one file or pasted table
//! computing   analysis and fits, as a job, whenever data or settings change
//! saving      the figure and the report
//! drawing     what the plot draws of it
//! measured    how long the program's own steps took
//! effort      reads times of steps, notes those
//! ```

pub mod applying;
pub mod command;
pub mod computing;
pub mod drawing;
mod effort;
pub mod fitted_curve;
pub mod measured;
pub mod reading;
pub mod saving;
pub mod source;

use std::collections::BTreeSet;
use std::sync::Arc;

pub use command::DistributionCommand;
pub use computing::Computed;
pub use measured::{EffortFile, MeasuredStep};
pub use source::{MadeOf, OfFragments, Source};

use crate::fragmentation::{AnalysisOptions, Labels, Model, SieveSeries, Weighting};
use crate::state::history::History;
use crate::units::LengthUnit;

/// Which page the window shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Page {
    /// The flight over the pile, or the start page.
    #[default]
    Pile,
    /// The flight as a plan, or the start page.
    Map,
    /// A flight that is planned over the surface of this one, or the start page.
    Plan,
    /// The fragments of the selected photo, or the start page.
    Fragments,
    /// The size distributions.
    SizeDistributions,
}

/// Which results are shown beside the plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ResultTab {
    /// The fitted functions.
    #[default]
    Fits,
    /// Every method against the reference.
    Reference,
    /// Whether trials are alike.
    Repeatability,
    /// Time that each step took.
    Effort,
}

/// What the plot shows over the size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PlotOf {
    /// Percent passing.
    #[default]
    Passing,
    /// Percent error against the reference.
    PercentError,
}

/// How the distributions are looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The function that is fitted.
    pub model: Model,
    /// What the photos of a trial count by where they are merged.
    pub merging: Weighting,
    /// The sieves that every curve is brought to; `None` leaves it as measured.
    pub sieves: Option<SieveSeries>,
    /// The method that the others are held against; `None` is the one that is called so.
    pub reference: Option<String>,
    /// The unit that sizes are shown in.
    pub unit: LengthUnit,
    /// Half the width of the envelope around the reference, percent of the size.
    pub envelope_percent: f64,
    /// The level of significance; bands have the confidence of one less it.
    pub level: f64,
}

impl Default for Settings {
    fn default() -> Self {
        let usual = AnalysisOptions::default();
        Self {
            model: usual.model,
            merging: usual.merging,
            sieves: usual.sieves,
            reference: usual.reference,
            unit: LengthUnit::Millimetre,
            envelope_percent: usual.envelope_percent,
            level: usual.level,
        }
    }
}

/// What undo goes back over.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Edit {
    /// What was added, in its order.
    pub sources: Vec<Arc<Source>>,
    /// How it is looked at.
    pub settings: Settings,
}

/// What is typed in the small window for a table.
#[derive(Debug, Clone, PartialEq)]
pub struct PasteForm {
    /// The table.
    pub table: String,
    /// The unit of its sizes, where it does not say.
    pub unit: LengthUnit,
    /// The method, where it does not say.
    pub method: String,
    /// The trial, where it does not say.
    pub trial: String,
    /// Why the table was not taken, in one line.
    pub refused: Option<String>,
}

impl Default for PasteForm {
    fn default() -> Self {
        Self {
            table: String::new(),
            unit: LengthUnit::Millimetre,
            method: String::new(),
            trial: String::new(),
            refused: None,
        }
    }
}

/// The state of the page.
#[derive(Debug)]
pub struct SizeDistributions {
    /// What was added and set, with that before.
    pub history: History<Edit>,
    /// Counts the changes: a result of another one is outdated.
    pub edition: u64,
    /// The last result; that of `edition`, but for the moment until a change is computed.
    pub computed: Option<Arc<Computed>>,
    /// Why there is no newer one, in one line.
    pub problem: Option<String>,
    /// The curves that are not drawn.
    pub hidden: BTreeSet<Labels>,
    /// What the plot shows.
    pub plot: PlotOf,
    /// Which results are shown.
    pub tab: ResultTab,
    /// The small window for a table.
    pub paste: PasteForm,
    /// How many tables were pasted.
    pub pasted: usize,
    /// The times of a file.
    pub effort: Option<EffortFile>,
    /// How long the program's own steps took.
    pub measured: Vec<MeasuredStep>,
    /// What is in a table that was written.
    saved: Vec<Arc<Source>>,
}

impl Default for SizeDistributions {
    fn default() -> Self {
        Self {
            history: History::new(Edit::default()),
            edition: 0,
            computed: None,
            problem: None,
            hidden: BTreeSet::new(),
            plot: PlotOf::default(),
            tab: ResultTab::default(),
            paste: PasteForm::default(),
            pasted: 0,
            effort: None,
            measured: Vec::new(),
            saved: Vec::new(),
        }
    }
}

impl SizeDistributions {
    /// What was added.
    pub fn sources(&self) -> &[Arc<Source>] {
        &self.history.now().sources
    }

    /// How it is looked at.
    pub fn settings(&self) -> &Settings {
        &self.history.now().settings
    }

    /// Whether a table that was pasted is in no file.
    pub fn has_unsaved(&self) -> bool {
        let is_saved = |source| self.saved.iter().any(|saved| Arc::ptr_eq(saved, source));
        let mut sources = self.sources().iter();
        sources.any(|source| source.is_pasted() && !is_saved(source))
    }

    /// Whether the result on the screen belongs to the data and settings of now.
    pub fn is_current(&self) -> bool {
        match &self.computed {
            Some(computed) => computed.edition == self.edition,
            None => self.sources().is_empty(),
        }
    }
}

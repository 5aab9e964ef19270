//! The steps from what is seen to the mass: which of them are taken.

use crate::engine::Habits;
use crate::outlined_by::OutlinedBy;

/// Which steps are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Large fragments are cut more often.
    pub edges: bool,
    /// How many times too large the engine's sizes are; 1 where they are taken as they are.
    pub engine: f64,
    /// The porosity of the pile, between 0 and 1, where small bodies are seen deeper down between large ones; `None` where
    /// its surface is taken for a cut.
    pub pores: Option<f64>,
    /// How much of what nobody outlined is fines, 0 to 1; the rest are fragments that were not found.
    pub fines: f64,
}

impl Default for Steps {
    fn default() -> Self {
        Self {
            edges: true,
            engine: 1.0,
            pores: None,
            fines: 1.0,
        }
    }
}

impl Steps {
    /// The usual ones for what an engine outlined, or other tools and people (`None`). What these leave without an outline is
    /// fines. An engine does not find small fragments as often as large ones, which makes its sizes too large; without the pores
    /// they are too small, and the two make up for each other on simulated piles (docs/fragments.md): so the pores are left out there.
    pub fn of(engine: Option<Habits>) -> Self {
        Self {
            edges: true,
            engine: engine.map_or(1.0, |habits| habits.sizes_off),
            pores: engine.is_none().then_some(LOOSE),
            fines: engine.map_or(1.0, |habits| habits.fines_of_unfound),
        }
    }
}

/// The steps that somebody asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct WantedSteps {
    /// These alone; `None` where the usual ones are wanted.
    pub named: Option<Vec<Step>>,
    /// The porosity of the pile, where the pores are among them.
    pub porosity: f64,
}

impl Default for WantedSteps {
    fn default() -> Self {
        Self {
            named: None,
            porosity: LOOSE,
        }
    }
}

impl WantedSteps {
    /// Those for a photo that was outlined by this.
    pub fn of(&self, outlined: OutlinedBy<'_>) -> Steps {
        let usual = Steps::of(outlined.habits());
        let Some(named) = &self.named else {
            return Steps {
                pores: usual.pores.map(|_| self.porosity),
                ..usual
            };
        };
        let all = Steps {
            pores: Some(self.porosity),
            ..usual
        };
        named
            .iter()
            .fold(Steps::NONE, |steps, step| steps.with(*step, &all))
    }
}

/// The porosity of coarse crushed rock that was dumped and not compacted: 0.40 to 0.50 (void content of loose coarse aggregate,
/// ASTM C29; Kosmatka and Wilson, "Design and Control of Concrete Mixtures", 2011, chapter 6).
pub const LOOSE: f64 = 0.45;

/// The steps that can be left out, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Fragments by the area that is seen of them: where the way begins.
    Seen,
    /// [`Steps::edges`].
    Edges,
    /// [`Steps::engine`].
    Engine,
    /// [`Steps::pores`].
    Pores,
    /// [`Steps::fines`].
    Fines,
}

impl Steps {
    /// None of them.
    pub(super) const NONE: Self = Self {
        edges: false,
        engine: 1.0,
        pores: None,
        fines: 0.0,
    };

    /// Which they are, in their order: "edges, pores and fines".
    pub fn in_words(&self) -> String {
        let all = [
            (Step::Edges, "edges"),
            (Step::Engine, "engine"),
            (Step::Pores, "pores"),
            (Step::Fines, "fines"),
        ];
        let taken = all.into_iter().filter(|(step, _)| self.takes(*step));
        let names: Vec<&str> = taken.map(|(_, name)| name).collect();
        match names.split_last() {
            None => "none".to_owned(),
            Some((only, [])) => (*only).to_owned(),
            Some((last, others)) => format!("{} and {last}", others.join(", ")),
        }
    }

    /// Whether a step is among them.
    pub(super) fn takes(&self, step: Step) -> bool {
        match step {
            Step::Seen => true,
            Step::Edges => self.edges,
            Step::Engine => self.engine != 1.0,
            Step::Pores => self.pores.is_some(),
            Step::Fines => self.fines > 0.0,
        }
    }

    /// The same with a step as `other` takes it.
    pub(super) fn with(self, step: Step, other: &Self) -> Self {
        match step {
            Step::Seen => self,
            Step::Edges => Self {
                edges: other.edges,
                ..self
            },
            Step::Engine => Self {
                engine: other.engine,
                ..self
            },
            Step::Pores => Self {
                pores: other.pores,
                ..self
            },
            Step::Fines => Self {
                fines: other.fines,
                ..self
            },
        }
    }
}

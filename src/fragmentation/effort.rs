//! Time that each step of a method took: the paper's Table I.

use crate::fault::Fault;

/// Times of steps (rows) by trial or method (columns). A time that is not known is missing, not zero.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Effort {
    steps: Vec<String>,
    columns: Vec<String>,
    /// A row a step, a time a column; seconds.
    seconds: Vec<Vec<Option<f64>>>,
}

/// A sum of times, some of which may be missing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeSum {
    /// Of those known, seconds.
    pub total: f64,
    /// How many are known.
    pub known: usize,
    /// How many are not.
    pub missing: usize,
}

impl TimeSum {
    /// Mean of those known, seconds; `None` where none is.
    pub fn average(&self) -> Option<f64> {
        (self.known > 0).then(|| self.total / self.known as f64)
    }
}

impl Effort {
    /// No step yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a time in seconds; a new step or column comes last.
    ///
    /// # Errors
    ///
    /// A step without a name, a time that is no number from 0 up, a second time for the same step and
    /// column.
    pub fn add(&mut self, step: &str, column: &str, seconds: Option<f64>) -> Result<(), Fault> {
        let _ = (step, column, seconds);
        Err(Fault::new("nothing is added yet", "wait"))
    }

    /// The rows' names.
    pub fn steps(&self) -> &[String] {
        &self.steps
    }

    /// The columns' names: trials or methods.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Seconds that a step took in a column; `None` where it is missing.
    pub fn seconds(&self, step: usize, column: usize) -> Option<f64> {
        *self.seconds.get(step)?.get(column)?
    }

    /// Over all columns of a step.
    pub fn of_step(&self, step: usize) -> TimeSum {
        let _ = step;
        TimeSum {
            total: 0.0,
            known: 0,
            missing: 0,
        }
    }

    /// Over all steps of a column.
    pub fn of_column(&self, column: usize) -> TimeSum {
        let _ = column;
        TimeSum {
            total: 0.0,
            known: 0,
            missing: 0,
        }
    }

    /// Over everything.
    pub fn of_all(&self) -> TimeSum {
        TimeSum {
            total: 0.0,
            known: 0,
            missing: 0,
        }
    }
}

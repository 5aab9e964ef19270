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
#[derive(Debug, Clone, Copy, Default, PartialEq)]
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

    /// The total; `None` where no time is known.
    pub fn known_total(&self) -> Option<f64> {
        (self.known > 0).then_some(self.total)
    }

    fn of(times: impl Iterator<Item = Option<f64>>) -> Self {
        let mut sum = Self::default();
        for time in times {
            match time {
                Some(seconds) => {
                    sum.total += seconds;
                    sum.known += 1;
                }
                None => sum.missing += 1,
            }
        }
        sum
    }
}

impl Effort {
    /// No step yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a time in seconds, or that it is missing; a new step or column comes last.
    ///
    /// # Errors
    ///
    /// A step without a name, a time that is no number from 0 up, a second time for the same step and
    /// column.
    pub fn add(&mut self, step: &str, column: &str, seconds: Option<f64>) -> Result<(), Fault> {
        let (step, column) = (step.trim(), column.trim());
        if step.is_empty() {
            return Err(Fault::new("a time without a step", "name the step"));
        }
        if let Some(bad) = seconds.filter(|time| !(time.is_finite() && *time >= 0.0)) {
            let what = format!("'{step}' took {bad} s");
            return Err(Fault::new(what, "give a time from 0 up"));
        }
        let column_at = position_or_new(&mut self.columns, column);
        let step_at = position_or_new(&mut self.steps, step);
        self.seconds.resize(self.steps.len(), Vec::new());
        for times in &mut self.seconds {
            times.resize(self.columns.len(), None);
        }
        let cell = (self.seconds.get_mut(step_at)).and_then(|times| times.get_mut(column_at));
        match cell {
            Some(cell) if cell.is_some() && seconds.is_some() => {
                let what = format!("a second time for '{step}' of '{column}'");
                let remedy = "add the two up, or give the trials names of their own";
                Err(Fault::new(what, remedy))
            }
            Some(cell) => {
                *cell = cell.or(seconds);
                Ok(())
            }
            None => Ok(()),
        }
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
        TimeSum::of(self.seconds.get(step).into_iter().flatten().copied())
    }

    /// Over all steps of a column.
    pub fn of_column(&self, column: usize) -> TimeSum {
        TimeSum::of((0..self.steps.len()).map(|step| self.seconds(step, column)))
    }

    /// Over everything.
    pub fn of_all(&self) -> TimeSum {
        TimeSum::of(self.seconds.iter().flatten().copied())
    }

    /// Over the columns' totals: its average is what one trial takes from the first step to the last.
    /// A column without any time is missing.
    pub fn of_column_totals(&self) -> TimeSum {
        let columns = 0..self.columns.len();
        TimeSum::of(columns.map(|column| self.of_column(column).known_total()))
    }

    /// Over the steps' totals. A step without any time is missing.
    pub fn of_step_totals(&self) -> TimeSum {
        TimeSum::of((0..self.steps.len()).map(|step| self.of_step(step).known_total()))
    }

    /// The step and column of every missing time, to be said.
    pub fn missing(&self) -> Vec<(&str, &str)> {
        let mut missing = Vec::new();
        for (step, times) in self.steps.iter().zip(&self.seconds) {
            for (column, time) in self.columns.iter().zip(times) {
                if time.is_none() {
                    missing.push((step.as_str(), column.as_str()));
                }
            }
        }
        missing
    }
}

/// Where a name stands; a new one is put last.
fn position_or_new(names: &mut Vec<String>, name: &str) -> usize {
    if let Some(at) = names.iter().position(|known| known == name) {
        return at;
    }
    names.push(name.to_owned());
    names.len() - 1
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;

    /// flight 10 and 12 min, cloud 30 and unknown: sums by hand.
    #[test]
    fn totals_and_averages_leave_the_missing_out() {
        let mut effort = Effort::new();
        for (step, trial, minutes) in [
            ("flight", "1", Some(10.0)),
            ("cloud", "1", Some(30.0)),
            ("flight", "2", Some(12.0)),
            ("cloud", "2", None),
        ] {
            let seconds = minutes.map(|minutes| minutes * 60.0);
            effort.add(step, trial, seconds).expect("a time");
        }
        assert_eq!(effort.steps(), ["flight", "cloud"]);
        assert_eq!(effort.columns(), ["1", "2"]);
        assert_eq!(effort.seconds(0, 1), Some(720.0));
        let sum = |total, known, missing| TimeSum {
            total,
            known,
            missing,
        };
        assert_eq!(effort.of_step(0), sum(1320.0, 2, 0));
        assert_eq!(effort.of_step(0).average(), Some(660.0));
        assert_eq!(effort.of_step(1), sum(1800.0, 1, 1));
        assert_eq!(effort.of_step(1).average(), Some(1800.0), "not 900");
        assert_eq!(effort.of_column(0), sum(2400.0, 2, 0));
        assert_eq!(effort.of_column(1), sum(720.0, 1, 1));
        assert_eq!(effort.of_all(), sum(3120.0, 3, 1));
        assert_eq!(effort.of_column_totals().average(), Some(1560.0));
        assert_eq!(effort.of_step_totals().average(), Some(1560.0));
        assert_eq!(effort.missing(), [("cloud", "2")]);
        assert_eq!(effort.of_step(7).average(), None);
    }

    /// A step that is new comes with a row of missing times.
    #[test]
    fn what_was_not_said_is_missing() {
        let mut effort = Effort::new();
        effort.add("flight", "cloud", Some(60.0)).expect("a time");
        effort
            .add("place spheres", "object", Some(30.0))
            .expect("a time");
        assert_eq!(
            effort.missing(),
            [("flight", "object"), ("place spheres", "cloud")]
        );
        effort.add("flight", "object", None).expect("a cell");
        effort.add("flight", "object", Some(1.0)).expect("a time");
        assert_eq!(effort.seconds(0, 1), Some(1.0));
    }

    #[test]
    fn refuses_in_a_sentence() {
        let mut effort = Effort::new();
        effort.add("flight", "1", Some(60.0)).expect("a time");
        for (step, seconds, sentence) in [
            (" ", 1.0, "without a step"),
            ("cloud", -1.0, "'cloud' took -1 s"),
            ("cloud", f64::NAN, "'cloud' took NaN s"),
            ("flight", 1.0, "a second time for 'flight' of '1'"),
        ] {
            let fault = effort.add(step, "1", Some(seconds)).expect_err(sentence);
            assert!(fault.to_string().contains(sentence), "{fault}");
        }
        assert_eq!(effort.steps().len(), 1, "nothing was added");
    }
}

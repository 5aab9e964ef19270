//! What came from one file or one pasted table, and all of them in one unit.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::fault::Fault;
use crate::fragmentation::{DistributionSet, LabelledDistribution};
use crate::units::LengthUnit;

/// Size distributions that were added together.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// The file's name, or "Pasted table 1".
    pub name: String,
    /// The file.
    pub path: Option<PathBuf>,
    /// As read.
    pub set: DistributionSet,
    /// What was noticed while reading.
    pub warnings: Vec<String>,
}

impl Source {
    /// What a file holds. Curves without a method are called after their file.
    pub fn of_file(path: &Path, set: DistributionSet, warnings: Vec<String>) -> Self {
        let name = |part: Option<&std::ffi::OsStr>| {
            part.map_or_else(String::new, |part| part.to_string_lossy().into_owned())
        };
        let stem = name(path.file_stem());
        let mut source = Self {
            name: name(path.file_name()),
            path: Some(path.to_owned()),
            set,
            warnings,
        };
        source.name_methods(&stem);
        source
    }

    /// Gives curves without a method this one.
    pub fn name_methods(&mut self, method: &str) {
        for curve in &mut self.set.curves {
            if curve.labels.method.is_empty() {
                method.clone_into(&mut curve.labels.method);
            }
        }
    }

    /// Makes its curves differ in their labels from those of `others`: where a trial has no name, it
    /// is called after this source, and that is said.
    ///
    /// # Errors
    /// Where curves with the same labels are there already.
    pub fn set_apart(&mut self, others: &[Arc<Self>]) -> Result<(), Fault> {
        let taken = |curve: &LabelledDistribution| {
            let same = |other: &&Arc<Self>| {
                let mut curves = other.set.curves.iter();
                curves.any(|other| other.labels == curve.labels)
            };
            others.iter().find(same).map(|other| other.name.clone())
        };
        let stem = self.path.as_deref().and_then(Path::file_stem);
        let stem = stem.map_or_else(
            || self.name.clone(),
            |stem| stem.to_string_lossy().into_owned(),
        );
        let mut named = 0;
        for curve in &mut self.set.curves {
            if curve.labels.trial.is_empty() && taken(curve).is_some() {
                curve.labels.trial.clone_from(&stem);
                named += 1;
            }
            if let Some(other) = taken(curve) {
                let what = format!("{} is there already, from {other}", curve.labels);
                return Err(Fault::new(what, "give it another method or trial"));
            }
        }
        let mut seen = BTreeSet::new();
        let mut labels = self.set.curves.iter().map(|curve| &curve.labels);
        if let Some(twice) = labels.find(|labels| !seen.insert(*labels)) {
            let what = format!("{twice} would be there twice");
            return Err(Fault::new(
                what,
                "give one of the two another method or trial",
            ));
        }
        if named > 0 {
            self.warnings.push(format!(
                "{named} curves without a trial are the trial '{stem}', to tell them from those that \
                 were there"
            ));
        }
        Ok(())
    }
}

/// The curves of all sources, in one unit.
///
/// # Errors
/// Sizes that become 0 or infinite in that unit.
pub fn joined(sources: &[Arc<Source>], unit: LengthUnit) -> Result<DistributionSet, Fault> {
    let mut curves = Vec::new();
    for source in sources {
        curves.extend(source.set.in_unit(unit)?.curves);
    }
    Ok(DistributionSet { unit, curves })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fragmentation::{Labels, SizeDistribution};

    fn source(name: &str, unit: LengthUnit, labels: &[(&str, &str)]) -> Source {
        let curve = |&(method, trial): &(&str, &str)| LabelledDistribution {
            labels: Labels {
                method: method.to_owned(),
                trial: trial.to_owned(),
                photo: String::new(),
            },
            weight: None,
            distribution: SizeDistribution::new(vec![[1.0, 10.0], [2.0, 90.0]]).unwrap(),
        };
        let curves = labels.iter().map(curve).collect();
        Source::of_file(
            Path::new(name),
            DistributionSet { unit, curves },
            Vec::new(),
        )
    }

    #[test]
    fn sources_in_two_units_are_joined_in_a_third() {
        let of = |name, unit| Arc::new(source(name, unit, &[("sieve", name)]));
        let sources = [of("a", LengthUnit::Inch), of("b", LengthUnit::Metre)];
        let set = joined(&sources, LengthUnit::Millimetre).unwrap();
        let smallest = |place: usize| set.curves[place].distribution.points()[0];
        assert!((smallest(0)[0] - 25.4).abs() < 1e-12, "an inch is 25.4 mm");
        assert!((smallest(1)[0] - 1000.0).abs() < 1e-9);
        assert_eq!(smallest(1)[1], 10.0);
    }

    #[test]
    fn the_same_method_from_two_files_is_two_trials() {
        let unit = LengthUnit::Millimetre;
        let first = Arc::new(source("one.csv", unit, &[("", ""), ("sieve", "")]));
        assert_eq!(first.set.curves[0].labels.method, "one");
        let mut second = source("two.csv", unit, &[("sieve", "")]);
        second.set_apart(std::slice::from_ref(&first)).unwrap();
        assert_eq!(second.set.curves[0].labels.to_string(), "sieve / two");
        assert!(second.warnings[0].contains("the trial 'two'"));
        let mut third = source("one.csv", unit, &[("sieve", "two")]);
        let fault = third.set_apart(&[first, Arc::new(second)]).unwrap_err();
        assert!(
            fault
                .what
                .contains("sieve / two is there already, from two.csv")
        );
    }

    #[test]
    fn no_two_curves_of_one_source_become_the_same() {
        let unit = LengthUnit::Millimetre;
        let first = Arc::new(source("one.csv", unit, &[("sieve", "")]));
        let mut second = source("two.csv", unit, &[("sieve", "two"), ("sieve", "")]);
        assert!(second.set_apart(&[first]).is_err());
    }
}

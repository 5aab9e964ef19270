//! The distributions of several files as one set: their names, their unit.

use std::collections::BTreeSet;

use super::{DistributionSet, LabelledDistribution, SizeDistribution};
use crate::fault::Fault;
use crate::units::LengthUnit;

impl DistributionSet {
    /// Gives curves without a method this one, as the name of their file.
    pub fn name_method(&mut self, method: &str) {
        for curve in &mut self.curves {
            if curve.labels.method.is_empty() {
                method.clone_into(&mut curve.labels.method);
            }
        }
    }

    /// Calls the method of its curves so.
    ///
    /// # Errors
    ///
    /// Curves of several methods.
    pub fn call_method(&mut self, method: &str) -> Result<(), Fault> {
        let own = self.curves.iter().map(|curve| &*curve.labels.method);
        let own: BTreeSet<&str> = own.collect();
        if own.len() > 1 {
            let own: Vec<&str> = own.into_iter().collect();
            let what = format!(
                "it has several methods, which cannot all be called '{method}': {}",
                own.join(", ")
            );
            return Err(Fault::new(what, "leave the name in front of the file away"));
        }
        for curve in &mut self.curves {
            method.clone_into(&mut curve.labels.method);
        }
        Ok(())
    }

    /// Makes its curves differ in their labels from those of `others`, each with the name of its file:
    /// where a trial has no name, it is called `trial`, after this file. Says so in a sentence.
    ///
    /// # Errors
    ///
    /// Curves with the same labels are there already.
    pub fn set_apart(
        &mut self,
        trial: &str,
        others: &[(&str, &Self)],
    ) -> Result<Option<String>, Fault> {
        let taken = |curve: &LabelledDistribution| {
            let same = |(_, other): &&(&str, &Self)| {
                let mut curves = other.curves.iter();
                curves.any(|other| other.labels == curve.labels)
            };
            others.iter().find(same).map(|(name, _)| *name)
        };
        let mut named = 0;
        for curve in &mut self.curves {
            if curve.labels.trial.is_empty() && taken(curve).is_some() {
                trial.clone_into(&mut curve.labels.trial);
                named += 1;
            }
            if let Some(other) = taken(curve) {
                let what = format!("{} is there already, from {other}", curve.labels);
                return Err(Fault::new(
                    what,
                    "give it another method or trial (for 'psd compare': NAME=FILE)",
                ));
            }
        }
        let mut seen = BTreeSet::new();
        let mut labels = self.curves.iter().map(|curve| &curve.labels);
        if let Some(twice) = labels.find(|labels| !seen.insert(*labels)) {
            let what = format!("{twice} would be there twice");
            return Err(Fault::new(
                what,
                "give one of the two another method or trial",
            ));
        }
        Ok((named > 0).then(|| {
            format!(
                "{named} curves without a trial are the trial '{trial}', to tell them from those that \
                 were there"
            )
        }))
    }

    /// The curves of all sets, which [differ in their labels](Self::set_apart), in one unit.
    ///
    /// # Errors
    ///
    /// Sizes that become 0 or infinite in that unit.
    pub fn joined<'a>(
        unit: LengthUnit,
        sets: impl IntoIterator<Item = &'a Self>,
    ) -> Result<Self, Fault> {
        let mut curves = Vec::new();
        for set in sets {
            curves.extend(set.in_unit(unit)?.curves);
        }
        Ok(Self { unit, curves })
    }

    /// The same curves with their sizes in another unit.
    ///
    /// # Errors
    ///
    /// Sizes that become 0 or infinite in that unit.
    pub fn in_unit(&self, unit: LengthUnit) -> Result<Self, Fault> {
        let factor = self.unit.in_units_of(unit);
        let converted = |curve: &LabelledDistribution| {
            let points = curve.distribution.points().iter();
            let points = points.map(|[size, percent]| [size * factor, *percent]);
            Ok(LabelledDistribution {
                distribution: SizeDistribution::new(points.collect())?,
                ..curve.clone()
            })
        };
        let curves = self.curves.iter().map(converted);
        Ok(Self {
            unit,
            curves: curves.collect::<Result<_, Fault>>()?,
        })
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use crate::Labels;

    fn set(unit: LengthUnit, method: &str, points: [[f64; 2]; 2]) -> DistributionSet {
        let curve = LabelledDistribution {
            labels: Labels {
                method: method.to_owned(),
                ..Labels::default()
            },
            weight: None,
            distribution: SizeDistribution::new(points.to_vec()).expect("a distribution"),
        };
        DistributionSet {
            unit,
            curves: vec![curve],
        }
    }

    /// 1 in is 25.4 mm.
    #[test]
    fn sets_in_two_units_are_joined_in_one() {
        let first = set(LengthUnit::Millimetre, "sieve", [[10.0, 5.0], [50.0, 95.0]]);
        let mut other = set(LengthUnit::Inch, "", [[1.0, 20.0], [10.0, 100.0]]);
        other.name_method("cloud");
        other.name_method("never");
        let both = DistributionSet::joined(first.unit, [&first, &other]).expect("joined");
        assert_eq!(both.unit, LengthUnit::Millimetre);
        assert_eq!(both.methods(), ["sieve", "cloud"]);
        let points = both.curves[1].distribution.points();
        assert!((points[0][0] - 25.4).abs() < 1e-12 && (points[1][0] - 254.0).abs() < 1e-11);
    }

    #[test]
    fn the_same_method_from_two_files_is_two_trials() {
        let points = [[10.0, 5.0], [50.0, 95.0]];
        let first = set(LengthUnit::Millimetre, "sieve", points);
        let mut second = first.clone();
        let others = [("one.csv", &first)];
        let said = second.set_apart("two", &others).expect("apart");
        assert!(said.expect("a sentence").contains("the trial 'two'"));
        assert_eq!(second.curves[0].labels.to_string(), "sieve / two");
        let both = [("one.csv", &first), ("two.csv", &second)];
        let mut third = second.clone();
        let fault = third.set_apart("three", &both).expect_err("twice");
        assert_eq!(fault.what, "sieve / two is there already, from two.csv");
        let mut apart = set(LengthUnit::Millimetre, "belt", points);
        assert_eq!(apart.set_apart("four", &both), Ok(None));
    }

    #[test]
    fn no_two_curves_of_one_file_become_the_same() {
        let points = [[10.0, 5.0], [50.0, 95.0]];
        let first = set(LengthUnit::Millimetre, "sieve", points);
        let mut second = first.clone();
        second.curves.extend(first.curves.clone());
        second.curves[0].labels.trial = "two".to_owned();
        assert!(second.set_apart("two", &[("one.csv", &first)]).is_err());
    }
}

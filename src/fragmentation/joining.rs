//! The distributions of several files as one set.

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

    /// Adds the curves of another set, their sizes in the unit of this one.
    ///
    /// # Errors
    ///
    /// A curve with the same labels is there already; sizes that become 0 or infinite in that unit.
    pub fn join(&mut self, other: &Self) -> Result<(), Fault> {
        for curve in other.in_unit(self.unit)?.curves {
            if self.curves.iter().any(|known| known.labels == curve.labels) {
                let what = format!(
                    "{}a curve of this name is there already",
                    curve.labels.in_front()
                );
                return Err(Fault::new(what, "give it another method, trial or photo"));
            }
            self.curves.push(curve);
        }
        Ok(())
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
    fn sizes_are_in_the_unit_of_the_first() {
        let mut both = set(LengthUnit::Millimetre, "sieve", [[10.0, 5.0], [50.0, 95.0]]);
        let mut other = set(LengthUnit::Inch, "", [[1.0, 20.0], [10.0, 100.0]]);
        other.name_method("cloud");
        other.name_method("never");
        both.join(&other).expect("joined");
        assert_eq!(both.unit, LengthUnit::Millimetre);
        assert_eq!(both.curves[1].labels.method, "cloud");
        let points = both.curves[1].distribution.points();
        assert!((points[0][0] - 25.4).abs() < 1e-12 && (points[1][0] - 254.0).abs() < 1e-11);
        let fault = both.join(&other).expect_err("twice").to_string();
        assert!(
            fault.contains("cloud") && fault.contains("already"),
            "{fault}"
        );
    }
}

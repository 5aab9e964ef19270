//! Size distributions as a table with one line a point, as `fragscale psd` and the window read them.

use crate::fragmentation::{DistributionSet, LabelledDistribution};
use crate::measured::csv_of;

/// The curves of several sets, their sizes in the first one's unit. Weights are areas in square metres or masses in kilograms, as they
/// were read, or what their input gave without a unit.
///
/// # Errors
/// Where memory runs out.
pub fn points_of_curves_csv(sets: &[&DistributionSet]) -> Result<String, csv::Error> {
    let Some(unit) = sets.first().map(|set| set.unit) else {
        return Ok(String::new());
    };
    let curves = || sets.iter().flat_map(|set| &set.curves);
    let points = |curve: &LabelledDistribution| curve.distribution.points().to_vec();
    let is_share = |[_, percent]: [f64; 2]| percent <= 1.0;
    // Whoever reads small percents alone may take them for shares of 1.
    let sign = match curves().flat_map(points).all(is_share) {
        true => "%",
        false => "",
    };
    let size = format!("size_{}", unit.symbol());
    let mut heads = vec!["method", "trial", "photo", &size, "percent_passing"];
    let weighed = curves().any(|curve| curve.weight.is_some());
    heads.extend(weighed.then_some("weight"));
    let mut rows = vec![heads.into_iter().map(str::to_owned).collect()];
    for set in sets {
        let factor = set.unit.in_units_of(unit);
        for curve in &set.curves {
            let labels = &curve.labels;
            for [size, percent] in points(curve) {
                let names = [&labels.method, &labels.trial, &labels.photo];
                let numbers = [(size * factor).to_string(), format!("{percent}{sign}")];
                let weight = curve
                    .weight
                    .map_or_else(String::new, |weight| weight.to_string());
                let cells = names.into_iter().cloned().chain(numbers);
                rows.push(cells.chain(weighed.then_some(weight)).collect());
            }
        }
    }
    csv_of(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fragmentation::{Labels, SizeDistribution};
    use crate::units::LengthUnit;

    fn set(
        unit: LengthUnit,
        method: &str,
        points: &[[f64; 2]],
        weight: Option<f64>,
    ) -> DistributionSet {
        let curve = LabelledDistribution {
            labels: Labels {
                method: method.to_owned(),
                ..Labels::default()
            },
            weight,
            distribution: SizeDistribution::new(points.to_vec()).unwrap(),
        };
        DistributionSet {
            unit,
            curves: vec![curve],
        }
    }

    #[test]
    fn each_point_has_a_line() {
        let sieve = set(
            LengthUnit::Inch,
            "sieve, A",
            &[[1.0, 20.0], [2.0, 80.5]],
            Some(3.0),
        );
        let photo = set(
            LengthUnit::Centimetre,
            "photo",
            &[[2.54, 30.0], [12.7, 90.0]],
            None,
        );
        let text = points_of_curves_csv(&[&sieve, &photo]).unwrap();
        assert_eq!(
            text,
            "method,trial,photo,size_in,percent_passing,weight\n\"sieve, A\",,,1,20,3\n\"sieve, A\",,,2,80.5,3\nphoto,,,1,30,\nphoto,,,5,90,\n"
        );
        let fines = set(LengthUnit::Millimetre, "", &[[1.0, 0.2], [2.0, 0.8]], None);
        let text = points_of_curves_csv(&[&fines]).unwrap();
        assert!(text.ends_with("\n,,,1,0.2%\n,,,2,0.8%\n"), "{text}");
        assert_eq!(points_of_curves_csv(&[]).unwrap(), "");
    }
}

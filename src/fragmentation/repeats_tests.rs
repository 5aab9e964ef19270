//! How far fits of photos and of several trials are known.

use crate::comparison::whole_mean_of;
use crate::jobs::Progress;
use crate::units::LengthUnit;
use crate::{
    Analysis, AnalysisOptions, DistributionSet, Fit, FitOptions, LabelledDistribution, Labels,
    Model, SieveSeries, SizeDistribution, Swebrec, fit, fit_trials,
};

fn curve(method: &str, photo: &str, x50: f64, sizes: &[f64]) -> LabelledDistribution {
    let swebrec = Swebrec::new(x50, 4.0 * x50, 2.0).expect("a curve");
    let points = sizes
        .iter()
        .map(|size| [*size, 100.0 * swebrec.passing(*size)]);
    LabelledDistribution {
        labels: Labels {
            method: method.to_owned(),
            trial: String::new(),
            photo: photo.to_owned(),
        },
        weight: None,
        distribution: SizeDistribution::new(points.collect()).expect("points"),
    }
}

/// Nine of ten photos' means lie within the band: photos whose P50 scatters by 20 % about 50, three at a time, each at its own
/// eighteen sizes. By the scatter about the function none of forty was.
#[test]
fn bands_of_photos_hold_the_true_size() {
    let mut random = fragscale_core::split_mix::SplitMix(4);
    let mut holds = 0;
    for _ in 0..40 {
        let mut curves = vec![curve(
            "sieve",
            "",
            50.0,
            &[10.0, 20.0, 40.0, 63.0, 90.0, 125.0, 180.0],
        )];
        for photo in ["a", "b", "c"] {
            // The sum of twelve uniform numbers is nearly normal.
            let normal = (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
            let x50 = 50.0 * (0.2 * normal).exp();
            let first = 8.0 + 2.0 * random.unit();
            let sizes: Vec<f64> = (0..18).map(|step| first * 1.15_f64.powi(step)).collect();
            curves.push(curve("photos", photo, x50, &sizes));
        }
        let set = DistributionSet {
            unit: LengthUnit::Millimetre,
            curves,
        };
        let found = Analysis::of(set, &AnalysisOptions::default(), &Progress::default());
        let comparison = found.expect("analysed").comparison.expect("compared");
        let fit = &comparison.methods[0].curve.fit;
        let [low, high] = fit.percentile(50.0, 0.95).band.expect("a band");
        holds += usize::from((low..=high).contains(&50.0));
        // The sieve has its own, of its scatter.
        assert!(
            comparison
                .reference
                .fit
                .percentile(50.0, 0.95)
                .band
                .is_some()
        );
    }
    assert!(holds >= 36, "{holds} of 40");
}

/// Of one photo there is no band, and that is said.
#[test]
fn one_photo_says_nothing_of_others() {
    let sizes = [10.0, 20.0, 40.0, 63.0, 90.0, 125.0];
    let set = DistributionSet {
        unit: LengthUnit::Millimetre,
        curves: vec![
            curve("sieve", "", 50.0, &sizes),
            curve("photo", "a", 55.0, &sizes),
        ],
    };
    let found = Analysis::of(set, &AnalysisOptions::default(), &Progress::default());
    let comparison = found.expect("analysed").comparison.expect("compared");
    let fit = &comparison.methods[0].curve.fit;
    assert_eq!(fit.percentile(50.0, 0.95).band, None);
    assert_eq!(fit.parameters[0].standard_error, None);
    assert!(
        fit.notes
            .iter()
            .any(|note| note.contains("of one photo or sample")),
        "{:?}",
        fit.notes
    );
}

/// Two sievings at seven sieves of their own, two of them the same: their mean has twelve points, and is known as by seven. The
/// variance is 12/7 times as large, and Student's t of 4 degrees of freedom is 2.776 where that of 9 is 2.262.
#[test]
fn sieves_of_two_trials_count_once() {
    let sizes: [&[f64]; 2] = [
        &[10.0, 20.0, 40.0, 63.0, 90.0, 125.0, 180.0],
        &[10.0, 18.0, 36.0, 58.0, 82.0, 112.0, 180.0],
    ];
    let mut curves = vec![curve("belt", "", 50.0, sizes[0])];
    for (trial, sizes) in sizes.into_iter().enumerate() {
        let mut one = curve("sieve", "", 50.0, sizes);
        one.labels.trial = trial.to_string();
        // Rounded to percents, so that something is left over.
        let points = one.distribution.points().iter();
        let points = points.map(|[size, percent]| [*size, percent.round()]);
        one.distribution = SizeDistribution::new(points.collect()).expect("points");
        curves.push(one);
    }
    let trials: Vec<&SizeDistribution> = curves[1..].iter().map(|of| &of.distribution).collect();
    let mean = whole_mean_of(&trials).expect("a mean");
    assert_eq!(mean.points().len(), 12);
    let model = Model::Swebrec;
    let plain = fit(&mean, model, &FitOptions::default()).expect("a fit");
    let set = DistributionSet {
        unit: LengthUnit::Millimetre,
        curves,
    };
    let found = Analysis::of(set, &AnalysisOptions::default(), &Progress::default());
    let comparison = found.expect("analysed").comparison.expect("compared");
    let width = |fit: &Fit| {
        let [low, high] = fit.percentile(50.0, 0.95).band.expect("a band");
        (high / low).ln()
    };
    let ratio = width(&comparison.reference.fit) / width(&plain);
    let wanted = (12.0_f64 / 7.0).sqrt() * 2.776_445 / 2.262_157;
    assert!((ratio / wanted - 1.0).abs() < 1e-5, "{ratio} {wanted}");
}

/// A single trial brought to other sieves is known by those that it was measured at, as the mean of trials is: seven, and not the
/// nineteen of the series between them.
#[test]
fn a_trial_at_other_sieves_is_known_by_its_own() {
    let sizes = [5.6, 11.2, 20.0, 40.0, 63.0, 90.0, 125.0];
    let rounded = |method: &str, x50: f64| {
        let mut one = curve(method, "", x50, &sizes);
        let points = one.distribution.points().iter();
        let points = points.map(|[size, percent]| [*size, percent.round()]);
        one.distribution = SizeDistribution::new(points.collect()).expect("points");
        one
    };
    let set = DistributionSet {
        unit: LengthUnit::Millimetre,
        curves: vec![rounded("sieve", 50.0), rounded("belt", 60.0)],
    };
    let options = AnalysisOptions {
        sieves: Some(SieveSeries::AstmE11),
        ..AnalysisOptions::default()
    };
    let found = Analysis::of(set, &options, &Progress::default()).expect("analysed");
    let fits = fit_trials(&found, options.model, options.merging, &Progress::default());
    let of_trial = fits.expect("fits")[0].clone().expect("a fit");
    let of_mean = &found.comparison.as_ref().expect("compared").reference.fit;
    assert!(found.trials.curves[0].distribution.points().len() > 15);
    assert!(of_mean.parameters[0].standard_error.is_some());
    assert_eq!(of_trial.parameters, of_mean.parameters);
}

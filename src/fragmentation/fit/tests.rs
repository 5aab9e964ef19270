//! Fits against what is known: closed forms, coverage, refusals. Against scipy: tests/size_distribution_fits.rs.

#![allow(clippy::expect_used, reason = "in a test a panic is the report")]

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::*;
use crate::{GatesGaudinSchuhmann, RosinRammler, Swebrec, Swebrec5};
use fragscale_core::split_mix::SplitMix;

/// The sizes of a usual set of sieves.
const SIEVES: [f64; 12] = [
    2.0, 4.0, 8.0, 16.0, 31.5, 45.0, 63.0, 90.0, 125.0, 180.0, 250.0, 355.0,
];

/// One of each family, with xmax above the sieves where there is one.
fn truths() -> [Curve; 4] {
    [
        Curve::Swebrec(Swebrec::new(120.0, 700.0, 2.4).expect("a curve")),
        Curve::Swebrec5(Swebrec5::new(120.0, 600.0, 3.0, 0.6, 0.7).expect("a curve")),
        Curve::RosinRammler(RosinRammler::new(120.0, 1.1).expect("a curve")),
        Curve::GatesGaudinSchuhmann(GatesGaudinSchuhmann::new(500.0, 0.8).expect("a curve")),
    ]
}

fn measured(curve: &Curve, mut noise: impl FnMut() -> f64) -> Option<SizeDistribution> {
    let points = SIEVES.map(|size| [size, curve.percent_passing(size) + noise()]);
    SizeDistribution::new(points.to_vec()).ok()
}

fn fitted(points: &[[f64; 2]], model: Model, options: &FitOptions) -> Result<Fit, Fault> {
    fit(
        &SizeDistribution::new(points.to_vec()).expect("a distribution"),
        model,
        options,
    )
}

fn value(fit: &Fit, name: &str) -> f64 {
    parameter(fit, name).value
}

fn parameter<'a>(fit: &'a Fit, name: &str) -> &'a FittedParameter {
    let found = fit.parameters.iter().find(|found| found.name == name);
    found.expect("a parameter of the model")
}

fn near(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs())
}

#[test]
fn a_curve_without_noise_gives_its_parameters_back() {
    for truth in truths() {
        let distribution = measured(&truth, || 0.0).expect("it rises");
        let fit = fit(&distribution, truth.model(), &FitOptions::default()).expect("a fit");
        assert!(fit.residual_sum_of_squares < 1e-12, "{fit:?}");
        for (found, asked) in fit.parameters.iter().zip(truth.parameters()) {
            assert!(near(found.value, asked, 1e-6), "{found:?} {asked}");
        }
        assert!(fit.r_squared > 1.0 - 1e-12);
        assert!(near(fit.topsize(0.95).size, truth.size_at(99.95), 1e-6));
    }
}

/// Of Rosin-Rammler the size that a share p passes goes with (-ln(1 - p))^(1 / n).
#[test]
fn uniformity_and_curvature_of_rosin_rammler() {
    let truth = RosinRammler::new(120.0, 1.1).expect("a curve");
    let distribution = measured(&Curve::RosinRammler(truth), || 0.0).expect("it rises");
    let fit = fit(&distribution, Model::RosinRammler, &FitOptions::default()).expect("a fit");
    let passed = |share: f64| (-(1.0 - share).ln()).powf(1.0 / 1.1);
    assert!(near(fit.uniformity(), passed(0.6) / passed(0.1), 1e-6));
    let curvature = passed(0.3).powi(2) / (passed(0.1) * passed(0.6));
    assert!(near(fit.curvature(), curvature, 1e-6));
}

/// The gradients that covariance and search rest on, against differences.
#[test]
fn gradients_are_slopes() {
    for truth in truths() {
        let distribution = measured(&truth, || 0.0).expect("it rises");
        let options = FitOptions::default();
        let points = Points::new(&distribution, truth.model(), &options).expect("points");
        let family = Family::new(truth.model(), &points, None);
        let best = search::optima(&family, &points)[0];
        let mut at = best.at;
        at[1] += 0.1;
        let h = 1e-6;
        for ln_size in [1.0, 3.0, 4.5, 5.5] {
            let share = family.share(&at, ln_size);
            let slope = family.share(&at, ln_size + h).share - family.share(&at, ln_size - h).share;
            assert!((slope / (2.0 * h) - share.slope).abs() < 1e-7);
            for index in 0..truth.parameters().len() {
                let moved = |step: f64| {
                    let mut moved = at;
                    moved[index] += step;
                    moved
                };
                let change = family.share(&moved(h), ln_size).share
                    - family.share(&moved(-h), ln_size).share;
                let gradient = share.gradient[index];
                assert!((change / (2.0 * h) - gradient).abs() < 1e-7, "{index}");
                let gradients = family.parameter_gradients(&at);
                let ends = [h, -h].map(|h| family.curve(&moved(h)).expect("a curve").parameters());
                for (parameter, gradients) in gradients.iter().enumerate().take(ends[0].len()) {
                    let change = (ends[0][parameter] - ends[1][parameter]) / (2.0 * h);
                    let scale = ends[0][parameter].abs();
                    assert!((change - gradients[index]).abs() < 1e-6 * scale.max(1.0));
                }
            }
        }
    }
}

/// Marsaglia's polar method.
struct Noise(SplitMix);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0.unit()
    }

    fn normal(&mut self) -> f64 {
        loop {
            let (x, y) = (2.0 * self.uniform() - 1.0, 2.0 * self.uniform() - 1.0);
            let s = x * x + y * y;
            if s > 0.0 && s < 1.0 {
                return x * (-2.0 * s.ln() / s).sqrt();
            }
        }
    }
}

/// Of N intervals of 95 % about 0.95 N hold the truth, with a standard deviation of
/// sqrt(N 0.95 0.05); four of these to both sides.
#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let mut noise = Noise(SplitMix(6));
    for truth in truths() {
        let extended = truth.model() == Model::Swebrec5;
        let mut held: Vec<(String, usize)> = Vec::new();
        let mut count = |name: String, holds: bool| {
            match held.iter_mut().find(|(known, _)| *known == name) {
                Some((_, number)) => *number += usize::from(holds),
                None => held.push((name, usize::from(holds))),
            };
        };
        let (mut curves, wanted) = (0, if extended { 120 } else { 400 });
        // Five parameters are told apart only where the noise is very small.
        let noise_points = if extended { 0.01 } else { 0.3 };
        while curves < wanted {
            // Noise that makes passing fall is refused.
            let Some(distribution) = measured(&truth, || noise_points * noise.normal()) else {
                continue;
            };
            curves += 1;
            let fit = fit(&distribution, truth.model(), &FitOptions::default()).expect("a fit");
            let reach = StudentsT::new(0.0, 1.0, fit.degrees_of_freedom as f64)
                .expect("degrees of freedom")
                .inverse_cdf(0.975);
            for (found, asked) in fit.parameters.iter().zip(truth.parameters()) {
                let error = found.standard_error.unwrap_or(0.0);
                let holds = (found.value - asked).abs() <= reach * error;
                count(found.name.to_owned(), holds);
            }
            for percent in [20.0, 80.0] {
                let [low, high] = fit.percentile(percent, 0.95).band.expect("a band");
                let size = truth.size_at(percent);
                count(format!("P{percent}"), low <= size && size <= high);
            }
            let [low, high] = fit.band_at(63.0, 0.95).expect("a band");
            let percent = truth.percent_passing(63.0);
            count("at 63".to_owned(), low <= percent && percent <= high);
        }
        let expected = 0.95 * f64::from(wanted);
        let spread = 4.0 * (0.05 * expected).sqrt();
        for (name, held) in held {
            let model = truth.model().key();
            let off = (held as f64 - expected).abs();
            assert!(off <= spread, "{model} {name}: {held} of {wanted}");
        }
    }
}

#[test]
fn weights_say_what_counts() {
    let truth = truths()[2];
    let mut noise = Noise(SplitMix(1));
    let distribution = measured(&truth, || 0.3 * noise.normal()).expect("it rises");
    let points = distribution.points().to_vec();
    let with = |weights: Vec<f64>| {
        let options = FitOptions {
            weights: Some(weights),
            xmax: None,
        };
        fitted(&points, Model::RosinRammler, &options).expect("a fit")
    };
    // All the same is as none, but for the sum, which holds them as they are.
    let plain = fitted(&points, Model::RosinRammler, &FitOptions::default()).expect("a fit");
    let same = with(vec![4.0; 12]);
    assert!(near(value(&same, "x50"), value(&plain, "x50"), 1e-12));
    assert!(near(
        same.residual_sum_of_squares,
        4.0 * plain.residual_sum_of_squares,
        1e-10
    ));
    assert!(near(same.rmse, plain.rmse, 1e-10));
    assert!(near(same.r_squared, plain.r_squared, 1e-12));
    // 0 is as left out.
    let mut weights = vec![1.0; 12];
    weights[11] = 0.0;
    let left_out = with(weights);
    let fewer = fitted(&points[..11], Model::RosinRammler, &FitOptions::default()).expect("a fit");
    assert!(near(value(&left_out, "n"), value(&fewer, "n"), 1e-10));
    assert_eq!(left_out.degrees_of_freedom, 9);
    assert_eq!(left_out.residuals.len(), 12);
    let errors = [&left_out, &fewer].map(|fit| parameter(fit, "n").standard_error.expect("one"));
    assert!(near(errors[0], errors[1], 1e-8));
}

#[test]
fn a_given_largest_size_stays() {
    let truth = truths()[0];
    let distribution = measured(&truth, || 0.0).expect("it rises");
    for model in [Model::Swebrec, Model::Swebrec5, Model::GatesGaudinSchuhmann] {
        let options = FitOptions {
            weights: None,
            xmax: Some(700.0),
        };
        let fit = fit(&distribution, model, &options).expect("a fit");
        assert_eq!(value(&fit, "xmax"), 700.0);
        assert_eq!(parameter(&fit, "xmax").standard_error, None);
        assert_eq!(fit.degrees_of_freedom, 13 - fit.parameters.len());
        if model == Model::Swebrec {
            assert!(near(value(&fit, "b"), 2.4, 1e-8));
        }
    }
}

/// A log-logistic curve is Swebrec with an xmax without end.
#[test]
fn no_largest_size_in_the_data_is_said() {
    let points = SIEVES.map(|x| [x, 100.0 / (1.0 + (x / 60.0).powf(-1.5))]);
    let fit = fitted(&points, Model::Swebrec, &FitOptions::default()).expect("a fit");
    assert!(
        fit.notes[0].contains("do not say a largest size"),
        "{:?}",
        fit.notes
    );
    assert_eq!(parameter(&fit, "xmax").standard_error, None);
    assert!(near(value(&fit, "x50"), 60.0, 1e-2));
    assert!(near(
        fit.percentile(80.0, 0.95).size,
        60.0 * 4f64.powf(1.0 / 1.5),
        2e-2
    ));
    assert!(fit.percentile(50.0, 0.95).band.is_some());
}

/// 97 % passed 355, so that xmax is above it, though a smaller one would fit the others better.
#[test]
fn some_rock_is_larger_than_what_it_did_not_pass() {
    let truth = Curve::Swebrec(Swebrec::new(120.0, 260.0, 1.8).expect("a curve"));
    let mut points: Vec<[f64; 2]> = SIEVES.map(|x| [x, truth.percent_passing(x)]).to_vec();
    points[10][1] = 96.0;
    points[11][1] = 97.0;
    let fit = fitted(&points, Model::Swebrec, &FitOptions::default()).expect("a fit");
    assert!(value(&fit, "xmax") >= 355.0);
    let options = FitOptions {
        weights: None,
        xmax: Some(300.0),
    };
    let fault = fitted(&points, Model::Swebrec, &options).expect_err("too small");
    assert!(fault.what.contains("not everything passed 355"), "{fault}");
}

/// A tenth stayed on 500 mm: the topsize is larger, though the delta method's band of it, by scipy, goes from 431.75 to 3341.57.
/// By scipy's covariance at most 95.85 % pass 500: less than 99.95, and maybe more than 95. The band of P95 is 454.66 to 823.29.
#[test]
fn a_band_does_not_reach_below_a_sieve_that_surely_less_passed() {
    let points = [[63.0, 15.0], [125.0, 30.0], [250.0, 60.0], [500.0, 90.0]];
    let fit = fitted(&points, Model::Swebrec, &FitOptions::default()).expect("a fit");
    let [low, high] = fit.topsize(0.95).band.expect("a band");
    assert_eq!(low, 500.0);
    assert!(near(high, 3341.57, 1e-4), "{high}");
    let [low, high] = fit.percentile(95.0, 0.95).band.expect("a band");
    assert!(near(low, 454.657, 1e-4), "{low}");
    assert!(near(high, 823.286, 1e-4), "{high}");
    // Where everything passed the largest sieve, the one below it counts: 46.71 by the delta method.
    let points = [
        [6.3, 11.2],
        [12.5, 30.0],
        [25.0, 60.0],
        [50.0, 88.4],
        [100.0, 100.0],
    ];
    let fit = fitted(&points, Model::Swebrec, &FitOptions::default()).expect("a fit");
    let [low, high] = fit.topsize(0.95).band.expect("a band");
    assert_eq!(low, 50.0);
    assert!(near(high, 828.138, 1e-4), "{high}");
}

#[test]
fn as_many_points_as_parameters_leave_nothing_over() {
    let truth = truths()[0];
    let points = [16.0, 63.0, 250.0].map(|x| [x, truth.percent_passing(x)]);
    let fit = fitted(&points, Model::Swebrec, &FitOptions::default()).expect("a fit");
    assert!(fit.residual_sum_of_squares < 1e-16);
    assert_eq!(fit.degrees_of_freedom, 0);
    assert!(fit.parameters.iter().all(|p| p.standard_error.is_none()));
    assert_eq!(fit.percentile(50.0, 0.95).band, None);
    assert_eq!(fit.band_at(50.0, 0.95), None);
    assert!(fit.notes[0].contains("as many parameters as points"));
}

/// Above its xmax everything passes any Gates-Gaudin-Schuhmann: two points are left for two parameters. By hand
/// m = ln(90 / 60) / ln(25 / 12.5), and the line reaches 100 % at 25 * 0.9^(-1 / m) mm, below the sieve of 31.5.
#[test]
fn what_everything_passed_does_not_count() {
    let plain = FitOptions::default();
    let points = [
        [12.5, 60.0],
        [25.0, 90.0],
        [31.5, 100.0],
        [50.0, 100.0],
        [63.0, 100.0],
    ];
    let fit = fitted(&points, Model::GatesGaudinSchuhmann, &plain).expect("a fit");
    let m = 1.5_f64.ln() / 2.0_f64.ln();
    assert!(near(value(&fit, "m"), m, 1e-6));
    assert!(near(
        value(&fit, "xmax"),
        25.0 * 0.9_f64.powf(-1.0 / m),
        1e-6
    ));
    assert_eq!(fit.degrees_of_freedom, 0);
    assert!(fit.parameters.iter().all(|p| p.standard_error.is_none()));
    assert_eq!(fit.percentile(50.0, 0.95).band, None);
    assert_eq!(fit.band_at(20.0, 0.95), None);
    assert!(
        fit.notes[0].starts_with("as many parameters as points that say anything"),
        "{:?}",
        fit.notes
    );
    // A largest size that is known is 100 % by itself, too: one point is left for one parameter.
    let points = [[12.5, 60.0], [25.0, 100.0], [50.0, 100.0]];
    let given = FitOptions {
        weights: None,
        xmax: Some(25.0),
    };
    let of_given = fitted(&points, Model::GatesGaudinSchuhmann, &given).expect("a fit");
    assert_eq!(of_given.degrees_of_freedom, 0);
    assert!(near(
        value(&of_given, "m"),
        (1.0 / 0.6_f64).ln() / 2.0_f64.ln(),
        1e-6
    ));
    // Where it is not known, any of 12.5 to 25 mm does.
    let any = fitted(&points, Model::GatesGaudinSchuhmann, &plain).expect("a fit");
    assert_eq!(any.degrees_of_freedom, 0);
    assert_eq!(any.percentile(50.0, 0.95).band, None);
    // One point alone has no spread that could be explained: R squared is of all.
    assert_eq!(any.telling_points, 1);
    assert!(any.r_squared > 1.0 - 1e-6, "{any:?}");
    assert!(
        any.notes[0].starts_with("more parameters than points"),
        "{:?}",
        any.notes
    );
}

/// The standard errors are scipy's (`curve_fit`) of the points below xmax; with those above it scipy's own are half as large of
/// Gates-Gaudin-Schuhmann, as if these had been learnt from.
#[test]
fn what_everything_passed_makes_nothing_surer() {
    let of_ggs = [[6.3, 38.0], [12.5, 60.0], [25.0, 90.0]];
    let of_swebrec = [
        [4.0, 10.0],
        [8.0, 15.0],
        [16.0, 27.0],
        [31.5, 53.0],
        [45.0, 74.0],
        [63.0, 94.0],
    ];
    for (model, below, left, known) in [
        (
            Model::GatesGaudinSchuhmann,
            &of_ggs[..],
            1,
            &[
                ("xmax", 29.510_137, 0.781_905),
                ("m", 0.613_897, 0.023_353_9),
            ][..],
        ),
        (
            Model::Swebrec,
            &of_swebrec[..],
            3,
            &[
                ("xmax", 82.0935, 1.804_34),
                ("x50", 29.922_51, 0.172_492),
                ("b", 2.044_252, 0.050_393_5),
            ][..],
        ),
    ] {
        let mut points = below.to_vec();
        points.extend([100.0, 125.0, 250.0].map(|size| [size, 100.0]));
        for points in [below, &points] {
            let fit = fitted(points, model, &FitOptions::default()).expect("a fit");
            assert_eq!(fit.degrees_of_freedom, left, "{fit:?}");
            // Nor does it make the fit look better.
            let mean = below.iter().map(|point| point[1]).sum::<f64>() / below.len() as f64;
            let about = below.iter().map(|point| (point[1] - mean).powi(2));
            let unexplained = fit.residual_sum_of_squares / about.sum::<f64>();
            assert!(near(1.0 - fit.r_squared, unexplained, 1e-6), "{fit:?}");
            let rmse = (fit.residual_sum_of_squares / below.len() as f64).sqrt();
            assert!(near(fit.rmse, rmse, 1e-6), "{fit:?}");
            assert_eq!(fit.telling_points, below.len());
            assert_eq!(fit.silent_points(), points.len() - below.len());
            for &(name, wanted, error) in known {
                let found = parameter(&fit, name);
                assert!(near(found.value, wanted, 1e-5), "{found:?}");
                let found = found.standard_error.expect("one");
                assert!(near(found, error, 1e-4), "{name} {found}");
            }
        }
    }
}

/// Of eight points four are measured: of sixteen, eight of which say nothing, eight are, and four of these say something.
#[test]
fn of_points_between_those_that_say_nothing_are_fewer_too() {
    let below = [
        [1.0, 13.0],
        [2.0, 20.0],
        [4.0, 30.0],
        [8.0, 46.0],
        [12.5, 60.0],
        [16.0, 69.0],
        [20.0, 79.0],
        [25.0, 91.0],
    ];
    let above = [31.5, 40.0, 50.0, 63.0, 80.0, 100.0, 125.0, 160.0];
    let mut all = below.to_vec();
    all.extend(above.map(|size| [size, 100.0]));
    let band = |points: &[[f64; 2]], own| {
        let model = Model::GatesGaudinSchuhmann;
        let fit = fitted(points, model, &FitOptions::default()).expect("a fit");
        let fit = fit.of_fewer_points(points.len(), own);
        fit.percentile(50.0, 0.95).band.expect("a band")
    };
    let (of_below, of_all) = (band(&below, 4), band(&all, 8));
    for (one, other) in of_below.into_iter().zip(of_all) {
        assert!(near(one, other, 1e-6), "{of_below:?} {of_all:?}");
    }
}

#[test]
fn another_unit_scales_the_sizes() {
    let mut noise = Noise(SplitMix(3));
    for truth in truths() {
        let Some(distribution) = measured(&truth, || 0.05 * noise.normal()) else {
            continue;
        };
        let metres: Vec<[f64; 2]> = distribution
            .points()
            .iter()
            .map(|p| [p[0] / 1000.0, p[1]])
            .collect();
        let options = FitOptions::default();
        let [a, b] = [distribution.points(), &metres]
            .map(|points| fitted(points, truth.model(), &options).expect("a fit"));
        assert!(near(
            a.residual_sum_of_squares,
            b.residual_sum_of_squares,
            1e-9
        ));
        let [a, b] = [a, b].map(|fit| fit.percentile(80.0, 0.9));
        assert!(near(a.size, 1000.0 * b.size, 1e-7));
    }
}

#[test]
fn refuses_in_a_sentence() {
    let plain = FitOptions::default();
    let with = |weights: &[f64], xmax| FitOptions {
        weights: (!weights.is_empty()).then(|| weights.to_vec()),
        xmax,
    };
    let rising = [[1.0, 10.0], [2.0, 30.0], [4.0, 60.0], [8.0, 90.0]];
    for (points, model, options, sentence) in [
        (&rising[..], Model::Swebrec5, &plain, "4 points for the 5"),
        (
            &rising[..],
            Model::Swebrec,
            &with(&[1.0, 1.0], None),
            "2 weights for 4",
        ),
        (
            &rising[..],
            Model::Swebrec,
            &with(&[1.0, 1.0, 1.0, -1.0], None),
            "a weight of -1",
        ),
        (
            &rising[..],
            Model::Swebrec,
            &with(&[1.0, 1.0, 0.0, 0.0], None),
            "2 points for the 3",
        ),
        (
            &rising[..],
            Model::RosinRammler,
            &with(&[], Some(9.0)),
            "no largest size",
        ),
        (
            &rising[..],
            Model::Swebrec,
            &with(&[], Some(7.0)),
            "a largest size of 7",
        ),
        (
            &rising[..],
            Model::Swebrec,
            &with(&[], Some(f64::NAN)),
            "a largest size of NaN",
        ),
        (
            &[[1.0, 0.0], [2.0, 0.0], [3.0, 100.0]],
            Model::Swebrec,
            &plain,
            "between 0 and 100",
        ),
        (
            &[[1.0, 50.0], [2.0, 50.0]],
            Model::RosinRammler,
            &plain,
            "the same at every size",
        ),
    ] {
        let fault = fitted(points, model, options)
            .expect_err(sentence)
            .to_string();
        assert!(fault.contains(sentence), "{fault}");
    }
}

/// Whatever the points, an answer or a sentence; and no worse than the best straight guess, the mean.
#[test]
fn strange_points_are_fitted_or_refused() {
    for points in [
        vec![[1.0, 0.0], [2.0, 50.0], [3.0, 100.0]],
        vec![
            [1.0, 0.0],
            [2.0, 0.0],
            [3.0, 0.1],
            [4.0, 100.0],
            [5.0, 100.0],
            [6.0, 100.0],
        ],
        vec![
            [100.0, 95.0],
            [101.0, 96.0],
            [102.0, 97.0],
            [103.0, 99.0],
            [104.0, 99.5],
        ],
        vec![
            [1.0, 1.0],
            [10.0, 2.0],
            [100.0, 3.0],
            [1000.0, 4.0],
            [1e4, 4.5],
        ],
        vec![
            [1e-9, 20.0],
            [1.0, 21.0],
            [1e9, 80.0],
            [1e12, 81.0],
            [1e15, 82.0],
        ],
        vec![
            [1.0, 40.0],
            [2.0, 100.0],
            [3.0, 100.0],
            [4.0, 100.0],
            [5.0, 100.0],
        ],
    ] {
        for model in Model::ALL {
            let Ok(fit) = fitted(&points, model, &FitOptions::default()) else {
                continue;
            };
            assert!(
                fit.residual_sum_of_squares.is_finite(),
                "{points:?} {fit:?}"
            );
            assert!(
                fit.parameters.iter().all(|p| p.value.is_finite()),
                "{fit:?}"
            );
            assert!(fit.r_squared > 0.0, "{points:?} {fit:?}");
        }
    }
}

//! Analyses of variance against NIST's certified answers, in the library and through the command.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    missing_docs,
    reason = "in a test or a benchmark a panic is the report"
)]

mod common;

use std::collections::BTreeMap;
use std::fs;

use fragscale::fragmentation::Anova;

/// What a file of NIST's Statistical Reference Datasets holds: the groups, and of its header the
/// certified sums of squares between and within, F, R squared and residual standard deviation.
struct Certified {
    groups: Vec<Vec<f64>>,
    degrees: [usize; 2],
    sums: [f64; 2],
    f: f64,
    r_squared: f64,
    residual_sd: f64,
}

fn read(name: &str) -> Option<Certified> {
    let path = common::shared_data(&format!("nist-anova/{name}.dat"))?;
    let text = fs::read_to_string(path).expect("a text");
    let (header, data): (Vec<_>, Vec<_>) = text.lines().enumerate().partition(|(at, _)| *at < 60);
    let numbers = |begin: &str| -> Vec<f64> {
        let line = header.iter().find(|(_, line)| line.contains(begin));
        let words = line.expect("a line of the header").1.split_whitespace();
        words.filter_map(|word| word.parse().ok()).collect()
    };
    let (between, within) = (numbers("Between "), numbers("Within "));
    let mut groups = BTreeMap::<u32, Vec<f64>>::new();
    for (_, line) in data {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let [group, value] = words[..] {
            let group = group.parse().expect("a group");
            let value = value.parse().expect("a value");
            groups.entry(group).or_default().push(value);
        }
    }
    // Whole numbers below 2000.
    let degrees = [between[0] as usize, within[0] as usize];
    Some(Certified {
        groups: groups.into_values().collect(),
        degrees,
        sums: [between[1], within[1]],
        f: between[3],
        r_squared: numbers("Certified R-Squared")[0],
        residual_sd: numbers("Standard Deviation ")[0],
    })
}

/// Nine digits on the sets of low and average difficulty; on SmLs07 no more than its numbers have as
/// doubles: the spacing at 1e12 is 1.2e-4, and exact rational arithmetic on them gives an F of
/// 21.000811887818770 (4e-5 off the certified 21).
#[test]
fn nists_certified_answers() {
    for (name, digits) in [
        ("SiRstv", 1e-12),
        ("SmLs01", 1e-12),
        ("SmLs02", 1e-12),
        ("SmLs04", 2e-10),
        ("SmLs07", 1e-4),
    ] {
        let Some(certified) = read(name) else {
            return;
        };
        let found = Anova::of_groups(&certified.groups, 0.05).expect("a table");
        assert_eq!(
            [found.between, found.within].map(|source| source.degrees_of_freedom),
            certified.degrees
        );
        for (what, found, certified) in [
            ("between", found.between.sum_of_squares, certified.sums[0]),
            ("within", found.within.sum_of_squares, certified.sums[1]),
            ("F", found.f.expect("an F"), certified.f),
            (
                "R squared",
                found.r_squared.expect("a share"),
                certified.r_squared,
            ),
            (
                "deviation",
                found.residual_standard_deviation,
                certified.residual_sd,
            ),
        ] {
            let off = (found / certified - 1.0).abs();
            println!("{name} {what}: {off:.1e}");
            assert!(off < digits, "{name} {what}: {found} for {certified}");
        }
    }
}

/// Sums of squares and F of the doubles themselves, from exact rational arithmetic (Python's
/// fractions): what is lost is lost in reading the numbers, not in the analysis.
#[test]
fn nothing_is_lost_but_the_input() {
    for (name, between, within, f) in [
        (
            "SmLs04",
            1.680_000_000_149_011_6,
            1.800_000_000_093_132_2,
            21.000_000_000_776_1,
        ),
        (
            "SmLs07",
            1.680_156_269_401_469_6,
            1.800_097_837_334_587_5,
            21.000_811_887_818_77,
        ),
    ] {
        let Some(certified) = read(name) else {
            return;
        };
        let found = Anova::of_groups(&certified.groups, 0.05).expect("a table");
        for (found, exact) in [
            (found.between.sum_of_squares, between),
            (found.within.sum_of_squares, within),
            (found.f.expect("an F"), f),
        ] {
            let off = (found / exact - 1.0).abs();
            println!("{name}: {off:.1e} off the exact answer of its doubles");
            assert!(off < 1e-13, "{name}: {found} for {exact}");
        }
    }
}

//! What a laboratory's protocol says, by hand.

use super::*;

/// What passes, with what is said beside where it comes from.
fn passing(text: &str) -> (Points, Vec<String>) {
    let (set, mut said) = read(text);
    assert_eq!(set.curves.len(), 1, "{text}");
    let from = said.iter().position(|said| {
        said.starts_with("what passes is computed from what stays on the sieves, column ")
    });
    said.remove(from.expect("it is said where the percents come from"));
    (set.curves[0].distribution.points().to_vec(), said)
}

/// 50, 300, 250, 200 g of 1000 on the sieves and 200 in the pan: 95, 65, 40, 20 % pass.
#[test]
fn each_way_to_tell_what_stays_gives_what_passes() {
    let wanted = [[10.0, 20.0], [20.0, 40.0], [40.0, 65.0], [80.0, 95.0]];
    for text in [
        // Mass with the pan, with the total, with both.
        "Sieve (mm),Mass retained (g)\n80,50\n40,300\n20,250\n10,200\nPan,200\n",
        "Sieve (mm),Weight retained\n10,200\n20,250\n40,300\n80,50\nTotal,1000\n",
        "Sieve (mm),Weight retained\n10,200\n20,250\n40,300\n80,50\nΣ,1000\n",
        "sieve_mm;retained_kg\n80;0,05\n40;0,3\n20;0,25\n10;0,2\npan;0,2\ntotal;1,0\n",
        "Sieve (mm),Cum. mass retained (g)\n80,50\n40,350\n20,600\n10,800\npan,1000\ntotal,1000\n",
        "Sieve (mm),Cum. mass retained (g)\n80,50\n40,350\n20,600\n10,800\npan,200\ntotal,1000\n",
        "Sieve (mm),Cum. mass retained (g)\n80,50\n40,350\n20,600\n10,800\npan,200\n",
        "Sieve (mm),Mass retained (g)\n80,50\n40,350\n20,600\n10,800\npan,1000\ntotal,1000\n",
        // Washed out before, below the finest, and sieves without an opening.
        "Sieve (mm),Mass retained (g)\n80,50\n40,300\n20,250\n10,200\nWashed fines,150\nPan,50\n",
        "Sieve (mm),Mass retained (g)\n80,50\n40,300\n20,250\n10,200\n<10,200\n",
        "Sieve (mm),Mass retained (g)\n80,50\n40,300\n20,250\n10,200\n0,200\n",
        // Percents of each sieve: with the pan, by name, and as they fall.
        "Sieve (mm),% retained\n80,5\n40,30\n20,25\n10,20\npan,20\n",
        "Sieve (mm),Individual % retained\n80,5\n40,30\n20,25\n10,20\n",
        "Sieve (mm),% retained\n80,5\n40,30\n20,25\n10,20\n",
        "Sieve (mm),retained\n80,5 %\n40,30 %\n20,25 %\n10,20 %\n",
        // Cumulative percents: by name, with the pan, and as they never fall.
        "Sieve (mm),Cumulative % retained\n80,5\n40,35\n20,60\n10,80\n",
        "Sieve (mm),% retained\n80,5\n40,35\n20,60\n10,80\npan,100\n",
        "Sieve (mm),% retained\n80,5\n40,35\n20,60\n10,80\n",
        // All columns of a protocol: the one that needs the least made of it.
        "Sieve (mm),Mass retained (g),% retained,Cum. % retained\n80,50,5,5\n40,300,30,35\n20,250,25,60\n10,200,20,80\npan,200,20,100\n",
    ] {
        let (points, said) = passing(text);
        assert_eq!(points.len(), 4, "{text}");
        for (point, wanted) in points.iter().zip(wanted) {
            assert_eq!(point[0], wanted[0], "{text}");
            assert!((point[1] - wanted[1]).abs() < 1e-9, "{text}: {points:?}");
        }
        let unexpected = said.iter().find(|said| {
            !said.contains("decimal commas")
                && !said.contains("columns that are not used")
                && !said.contains("no line says what was in the pan")
        });
        assert_eq!(unexpected, None, "{text}");
    }
}

/// A line of the pan that was forgotten is seen by whoever reads what was taken for it.
#[test]
fn what_is_taken_for_the_pan_is_said() {
    let pan = |text| {
        let said = passing(text).1;
        said.into_iter().find(|said| said.contains("pan"))
    };
    assert_eq!(
        pan("Sieve (mm),Individual % retained\n80,5\n40,30\n20,25\n10,20\n").unwrap(),
        "no line says what was in the pan: it is taken to be the 20 % that the sieves lack to 100"
    );
    for clear in [
        "Sieve (mm),Individual % retained\n80,5\n40,30\n20,25\n10,39.8\n",
        "Sieve (mm),Individual % retained\n80,5\n40,30\n20,25\n10,20\npan,20\n",
        "Sieve (mm),Cumulative % retained\n80,5\n40,35\n20,60\n10,80\n",
    ] {
        assert_eq!(pan(clear), None, "{clear}");
    }
}

#[test]
fn what_passes_goes_before_what_stays() {
    let text =
        "Sieve (mm),Mass retained (g),% passing\n80,50,95\n40,300,60\npan,650,\nTotal,1000,\n";
    let (set, said) = read(text);
    assert_eq!(
        set.curves[0].distribution.points(),
        [[40.0, 60.0], [80.0, 95.0]]
    );
    assert_eq!(
        said,
        [
            "columns that are not used: Mass retained (g)",
            "the pan under the sieves has no size and is left out (line 4)",
            "a line of sums is left out (line 5)",
        ]
    );
}

/// The total was weighed before: 2 of 1000 g are lost in sieving, which is usual; 20 are not.
#[test]
fn a_total_that_does_not_fit_is_said() {
    let text =
        |total: u32| format!("Sieve (mm),retained (g)\n80,98\n40,400\npan,500\ntotal,{total}\n");
    let (points, said) = passing(&text(1000));
    assert!(said.is_empty(), "{said:?}");
    assert!((points[0][1] - 500.0 / 9.98).abs() < 1e-9);
    assert_eq!(
        passing(&text(1018)).1,
        [
            "sieves and pan add up to 998, the total says 1018: they are off by more than 0.3 % (ASTM C136); shares are of the sum"
        ]
    );
}

/// 12.34 and 45.61 g are on the sieves, 57.95 in all: written with a decimal or none that is 58.0, 57.9 or 58. Of 58.4 g 0.45 passed.
#[test]
fn a_total_that_was_rounded_says_no_more_than_the_sieves() {
    let text =
        |name: &str, total: &str| format!("sieve_mm,{name}\n40,12.34\n20,45.61\ntotal,{total}\n");
    for name in ["each retained g", "Mass retained (g)"] {
        for total in ["57.95", "58.0", "57.9", "58"] {
            let (line, said) = fault(&text(name, total));
            assert_eq!(line, Some(2), "{name} {total}");
            assert_eq!(
                said,
                "the total is the sum of the sieves alone: nothing says how much passed the finest; give what is in the pan in a line 'pan' (0 where nothing is)",
                "{name} {total}"
            );
        }
        let (points, _) = passing(&text(name, "58.4"));
        assert!((points[0][1] - 45.0 / 58.4).abs() < 1e-9, "{points:?}");
    }
}

/// A line that is left out of a protocol is missing in its sum.
#[test]
fn no_line_of_a_protocol_is_to_be_left_out() {
    for (lines, line, wanted) in [
        (
            "40,10\n20,5\npan,n.d.\n",
            4,
            "column retained g: 'n.d.' is not a number; correct it",
        ),
        (
            "40,10\n20,5\npan,5\ntotal,twenty\n",
            5,
            "column retained g: 'twenty' is not a number; correct it",
        ),
        (
            "40,10\n20,\npan,5\n",
            3,
            "column retained g is empty; fill it in",
        ),
        (
            "40,10\n,5\npan,5\n",
            3,
            "column sieve_mm has no size; fill it in",
        ),
    ] {
        let text = format!("sieve_mm,retained g\n{lines}");
        assert_eq!(fault(&text), (Some(line), wanted.to_owned()), "{text}");
    }
}

#[test]
fn several_samples_are_told_apart_by_name() {
    let text = "sample,sieve mm,% retained,mass\nA,40,10,1\nA,20,60,2\nA,pan,30,3\nB,40,0,4\nB,20,55,5\nB,pan,45,6\n";
    let (set, _) = read(text);
    assert_eq!(names(&set), ["||A", "||B"]);
    // A sieve's mass is no weight of the curve.
    assert_eq!(set.curves[0].weight, None);
    assert_eq!(
        set.curves[1].distribution.points(),
        [[20.0, 45.0], [40.0, 100.0]]
    );
}

#[test]
fn what_nobody_can_know_is_refused() {
    for (text, line, wanted) in [
        (
            "sieve_mm,mass retained\n40,300\n20,250\n",
            2,
            "nothing says how much passed the finest sieve; give what is in the pan in a line 'pan' (0 where nothing is), or the sum of all in a line 'total'",
        ),
        (
            "sieve_mm,cum mass retained\n40,300\n20,550\n",
            2,
            "nothing says for sure how much there was in all; give the sum of all in a line 'total': a pan's line may be its own mass as well",
        ),
        (
            "sieve_mm,retained\n40,300\n20,250\npan,50\n",
            2,
            "what is retained is percent or mass, which its column does not say; call the column 'retained %', 'cumulative retained %' or 'retained g'",
        ),
        (
            "sieve_mm,% retained\n40,10\n20,20\n10,30\n",
            2,
            "what is retained is of each sieve (it adds up to 60 %) or cumulative, which nothing says; say 'each' or 'cumulative' in the name of the column",
        ),
        (
            "sieve_mm,each % retained\n40,10\n20,20\npan,30\n",
            2,
            "percents retained and the pan's add up to 60 %, not 100; correct them",
        ),
        (
            "sieve_mm,retained g\n40,10\n20,5\nLoss,30\n",
            4,
            "column sieve_mm: 'Loss' is not a number; give the opening of its sieve, or call it pan, washed or total",
        ),
        (
            "sieve_mm,retained g\n40,10\n20,-20\npan,30\n",
            3,
            "-20 is retained, less than nothing; correct it",
        ),
        (
            "sieve_mm,each retained g\n40,10\n20,20\ntotal,30\n",
            2,
            "the total is the sum of the sieves alone: nothing says how much passed the finest; give what is in the pan in a line 'pan' (0 where nothing is)",
        ),
        (
            "sieve_mm,each retained g\n40,10\n20,20\ntotal,25\n",
            3,
            "30 is retained down to this sieve, of 25 in all; correct it",
        ),
        (
            "sieve_mm,cum mass retained g\n100,0\n63,120\n40,460\n25,870\nPan,1130\n",
            2,
            "nothing says for sure how much there was in all; give the sum of all in a line 'total': a pan's line may be its own mass as well",
        ),
        (
            "sieve_mm,mass retained g\n100,0\n63,120\n40,460\n25,870\nPan,1130\n",
            2,
            "what is retained is of each sieve (it adds up to 2580) or cumulative, which nothing says; say 'each' or 'cumulative' in the name of the column",
        ),
        (
            "sieve_mm,mass retained g\n100,5\n63,120\n40,60\nPan,50\ntotal,2000\n",
            2,
            "sieves and pan add up to 235, the total says 2000; correct them",
        ),
        (
            "sieve_mm,cum % retained\n100,5\n63,60\nwashed loss,50\n",
            2,
            "50 was washed out, beside what is cumulative; give what is retained on each sieve",
        ),
        (
            "Sieve (mm),Passing (kg)\n100,20\n63,18.8\n",
            1,
            "column 'Passing (kg)' is the mass that passes, not percent; give percent passing: that mass over the mass of all, times 100",
        ),
        (
            "Sieve size (mesh),Mass retained (g)\n4,20\n10,0\nPan,25\n",
            2,
            "'4' is the number of a sieve, no size; write 'No. 4' where it is one of ASTM E11, else its opening with a unit",
        ),
        (
            "Sieve No.,% passing\n4,100\n10,50\n",
            2,
            "'4' is the number of a sieve, no size; write 'No. 4' where it is one of ASTM E11, else its opening with a unit",
        ),
        (
            "Sieve (mm),100,63,40,Pan\nface A,100,60,30,\n% retained,40,30,20,10\n",
            3,
            "line '% retained' is no percent passing; give percent passing, or what stays on the sieves with a line for each of them",
        ),
        (
            "Sieve (mm);retained (g)\n100;0\n63;980\n40;1.200\nPan;820\n",
            4,
            "column retained (g): '1.200' may have a decimal sign or a separator of thousands; write decimals with a point, and nothing between thousands",
        ),
        (
            "sieve_mm,each retained g\n40,0\n20,0\npan,0\n",
            2,
            "nothing was sieved: all masses are 0; correct them",
        ),
        (
            "sieve_mm,retained g\n40,0\n20,0\npan,0\npan,1\n",
            5,
            "'pan' is there twice; keep one, or name the curves",
        ),
        (
            "sieve_mm,retained A g,retained A kg\n40,0,1\n20,0,2\n",
            1,
            "columns 'retained A g' and 'retained A kg' may both be what stays on the sieves; name one of them (--passing), or give each the name of its sample",
        ),
        (
            "sieve_mm,retained g,retained B g\n40,0,1\n20,0,2\n",
            1,
            "columns 'retained g' and 'retained B g' may both be what stays on the sieves; name one of them (--passing), or give each the name of its sample",
        ),
        (
            "sieve_mm,retained A g,retained B g\n40,1,1\n20,2,2\n",
            2,
            "'A': nothing says how much passed the finest sieve; give what is in the pan in a line 'pan' (0 where nothing is), or the sum of all in a line 'total'",
        ),
        (
            "grade,retained g\n40,0\n20,0\n",
            1,
            "no column is called size among 'grade', 'retained g'; call the column of sizes size in the first line (or name it by --size)",
        ),
    ] {
        assert_eq!(fault(text), (Some(line), wanted.to_owned()), "{text}");
    }
    // The one that is named is read.
    let columns = DistributionColumns {
        passing: Some("retained B g".to_owned()),
        ..DistributionColumns::default()
    };
    let text = "sieve_mm,retained A g,retained B g\n40,0,1\n20,0,2\npan,5,1\n";
    let (set, _) = size_distributions(text, &columns).unwrap();
    assert_eq!(
        set.curves[0].distribution.points(),
        [[20.0, 25.0], [40.0, 75.0]]
    );
}

/// Lines keep their numbers, and what has no table below is refused for what stands first.
#[test]
fn a_title_stands_above_the_names() {
    let text = "Sieve analysis;;\nSample:;MP-3;\nDate;2026-03-01;\n\nSize (mm);% passing;\n40;100;\n20;55;\n";
    let (set, said) = read(text);
    assert_eq!(
        set.curves[0].distribution.points(),
        [[20.0, 55.0], [40.0, 100.0]]
    );
    assert_eq!(
        said,
        ["3 lines above the names of the columns are passed over"]
    );
    assert!(is_table(text, true));
    let narrow = "Sieve analysis of MP-3\nsize_mm,percent_passing\n40,100\n20,abc\n";
    assert_eq!(fault(narrow).0, Some(4));
    assert_eq!(fault("Report\nno,table\n1,2\n").0, Some(1));
    // Numbers are no names, whatever they look like below.
    assert!(
        fault("this,that,there\na.jpg,12,35\nb.jpg,13,40\n")
            .1
            .starts_with("no column is called")
    );
}

/// Sizes in the first line, behind a column that is called so.
#[test]
fn sieves_may_stand_in_one_line() {
    let text = "Sieve size (mm),80,40,20\n% passing,100,60,30\n";
    assert_eq!(points(text), [[20.0, 30.0], [40.0, 60.0], [80.0, 100.0]]);
    let text = "Sieve (in),3,1-1/2,3/4\nface A,100,60,30\nface B,100,70,35\n";
    let (set, _) = read(text);
    assert_eq!(set.unit, LengthUnit::Inch);
    assert_eq!(names(&set), ["face A||", "face B||"]);
    // Trials with numbers for names are columns of curves.
    let (set, _) = read("size_mm,1,2\n10,20,30\n20,100,100\n");
    assert_eq!(names(&set), ["1||", "2||"]);
}

/// 50 of 100 and 30 of 40 pass 20 mm; B was not shaken through 40 mm.
#[test]
fn samples_may_stand_side_by_side() {
    let text = "Sieve (mm),Sample A retained (g),Sample A retained (%),Sample B retained (g),Sample B retained (%)\n80,0,0,0,0\n40,20,20,,\n20,30,30,10,25\npan,50,50,30,75\n";
    let (set, said) = read(text);
    assert_eq!(names(&set), ["Sample A||", "Sample B||"]);
    assert_eq!(
        set.curves[0].distribution.points(),
        [[20.0, 50.0], [40.0, 80.0], [80.0, 100.0]]
    );
    assert_eq!(
        set.curves[1].distribution.points(),
        [[20.0, 75.0], [80.0, 100.0]]
    );
    assert_eq!(
        said,
        [
            "what passes is computed from what stays on the sieves, columns Sample A retained (%), Sample B retained (%)",
            "columns that are not used: Sample A retained (g), Sample B retained (g)",
        ]
    );
}

/// The same table with its units below the names, in a column, and behind each size: an inch is 25.4 mm.
#[test]
fn units_may_stand_beside_the_names() {
    let in_mm = [[25.4, 35.0], [50.8, 80.0]];
    for text in [
        "Sieve,Passing\n(in),(%)\n1,35\n2,80\n",
        "Sieve;Retained;Passing\n[in];[kg];[%]\n1;3;35\n2;1;80\n",
        "Sieve\tPassing\ninches\t%\n1\t35\n2\t80\n",
        "Sample,Size,Passing\n-,in,%\nA,1,35\nA,2,80\n",
        "size,unit,passing\n1,in,35\n2,in,80\n",
        "size,unit,passing\n25.4,mm,35\n5.08,cm,80\n",
        "unit,method,D35,D80,D90\n(in),sieve,1,2,3\n",
    ] {
        let (set, said) = read(text);
        let points = set.curves[0].distribution.points();
        for (point, wanted) in points.iter().zip(in_mm) {
            let mm = point[0] * set.unit.in_units_of(LengthUnit::Millimetre);
            assert!((mm - wanted[0]).abs() < 1e-9, "{text}: {points:?}");
            assert_eq!(point[1], wanted[1], "{text}");
        }
        let unexpected = said.iter().find(|said| !said.contains("Retained"));
        assert_eq!(unexpected, None, "{text}");
        assert!(is_table(text, true), "{text}");
    }
    // The name that the user gives is the one of the first line.
    let columns = DistributionColumns {
        size: Some("Width".to_owned()),
        ..DistributionColumns::default()
    };
    let (set, _) = size_distributions("Width,Passing\n(cm),(%)\n1,35\n2,80\n", &columns).unwrap();
    assert_eq!(set.unit, LengthUnit::Centimetre);
    // A column of units beside a name that states one is not used, and said.
    let (set, said) = read("size_mm,unit,passing\n1,in,35\n2,in,80\n");
    assert_eq!(set.unit, LengthUnit::Millimetre);
    assert_eq!(said, ["columns that are not used: unit"]);
    // Some sizes with a unit, some without.
    assert!(
        fault("size,unit,passing\n1,in,35\n2,,80\n")
            .1
            .starts_with("this size has no unit")
    );
}

/// What a program writes below the sizes is no point of the curve, nor is a mass of each sieve the weight of the curve.
#[test]
fn results_below_and_masses_beside_are_no_points() {
    let text = "Size [mm],% Passing\n20,35\n40,80\nF10,6.2\nP80: ,40\nTopsize (99.95%),76.1\n";
    let (set, said) = read(text);
    assert_eq!(
        set.curves[0].distribution.points(),
        [[20.0, 35.0], [40.0, 80.0]]
    );
    assert_eq!(
        said,
        [
            "a line of a percentile or the top size is no point and is left out (3 times, first on line 4)"
        ]
    );
    let (set, said) = read("Size (mm),Passing (%),Mass (kg)\n20,35,3\n40,80,4\n");
    assert_eq!(set.curves[0].weight, None);
    assert_eq!(said, ["columns that are not used: Mass (kg)"]);
    let (set, _) = read("Size (mm),Passing (%),Mass (kg)\n20,35,4\n40,80,4\n");
    assert_eq!(set.curves[0].weight, Some(4.0));
}

/// Of columns of areas and masses that one counts by which curves are to be merged.
#[test]
fn curves_weigh_what_they_are_merged_by() {
    let text = "photo,size_mm,passing,area_m2,mass_kg\na,1,20,2,5\na,2,80,2,5\n";
    let weight = |merging, text: &str| {
        let columns = DistributionColumns {
            merging,
            ..DistributionColumns::default()
        };
        size_distributions(text, &columns).map(|(set, _)| set.curves[0].weight)
    };
    assert_eq!(weight(Weighting::Area, text), Ok(Some(2.0)));
    assert_eq!(weight(Weighting::Mass, text), Ok(Some(5.0)));
    assert!(
        weight(Weighting::Equal, text)
            .unwrap_err()
            .what
            .contains("may both be")
    );
    let areas = "photo,size_mm,passing,area_m2\na,1,20,2\na,2,80,2\n";
    let fault = weight(Weighting::Mass, areas).unwrap_err();
    assert_eq!(
        fault.what,
        "column 'area_m2' is no mass, by which curves are to be merged"
    );
    let named = areas.replace("area_m2", "weight 2");
    assert_eq!(weight(Weighting::Mass, &named), Ok(Some(2.0)));
}

#[test]
fn options_of_the_command_are_left_out_elsewhere() {
    for (said, wanted) in [
        ("name one of them (--weight)", "name one of them"),
        (
            "no unit is stated: sizes are taken for mm (state it in the name of their column, or by --size-unit)",
            "no unit is stated: sizes are taken for mm (state it in the name of their column)",
        ),
        (
            "call it size (or name it by --size), please (now)",
            "call it size, please (now)",
        ),
    ] {
        assert_eq!(without_options(said), wanted);
    }
}

#[test]
fn laboratories_write_german_french_and_spanish() {
    let wanted = [[10.0, 20.0], [40.0, 80.0]];
    for text in [
        "Siebweite (mm);Durchgang (%)\n40;80,0\n10;20,0\n",
        "Maschenweite [mm];Rückstand [g]\n40;20,0\n10;60,0\nBoden;20,0\nSumme;100,0\n",
        "Sieb (mm);Durchgang (%)\n40;80,0\n10;20,0\n",
        "Siebgröße (mm);Rückstand (kg)\n40;20,0\n10;60,0\nPfanne;20,0\n",
        "Ouverture (mm);Refus cumulé (%)\n40;20,0\n10;80,0\n",
        "Tamis (mm);Passant (%)\n40;80,0\n10;20,0\n",
        "Malla (mm);Peso retenido (g)\n40;20,0\n10;60,0\nFondo;20,0\n",
        "Abertura (mm);% que pasa\n40;80,0\n10;20,0\n",
        "Tamiz (mm);Retenido acumulado (%)\n40;20,0\n10;80,0\n",
    ] {
        let (set, _) = read(text);
        assert_eq!(set.curves[0].distribution.points(), wanted, "{text}");
    }
}

/// Method, trial and photo tell curves apart in these languages, too.
#[test]
fn method_trial_and_photo_in_other_languages() {
    for names in [
        "Methode;Versuch;Foto",
        "Verfahren;Probe;Bild",
        "Méthode;Essai;Photo",
        "méthode;échantillon;photo",
        "Método;Ensayo;Foto",
        "método;muestra;imagen",
        "Metodo;Campione;Immagine",
        "Метод;Проба;Фото",
    ] {
        let header = format!("{names};Siebweite (mm);Durchgang (%)");
        let (set, _) = read(&format!(
            "{header}\nSieb;1;a;10;20\nSieb;1;a;40;80\nSieb;2;b;10;30\nSieb;2;b;40;90\n"
        ));
        let labels = set.curves.iter().map(|curve| {
            let labels = &curve.labels;
            [&labels.method, &labels.trial, &labels.photo].map(String::as_str)
        });
        let labels: Vec<_> = labels.collect();
        assert_eq!(labels, [["Sieb", "1", "a"], ["Sieb", "2", "b"]], "{names}");
    }
}

/// What stays on sieves under a name that says so in short, and under one that nobody knows: something in the pan tells.
#[test]
fn something_in_the_pan_is_retained() {
    for name in ["% Ret.", "% retida", "Rückstände [%]"] {
        let (set, _) = read(&format!("Sieve (mm);{name}\n16;40\n8;30\n4;10\npan;20\n"));
        let points = set.curves[0].distribution.points();
        assert_eq!(points, [[4.0, 20.0], [8.0, 30.0], [16.0, 60.0]], "{name}");
    }
    for pan in ["Fondo", "prato", "fond"] {
        let (_, fault) = fault(&format!("Sieve (mm),Wt. %\n16,40\n8,30\n4,10\n{pan},20\n"));
        assert!(fault.contains("has 20 in the pan"), "{pan}: {fault}");
    }
    let (_, fault) = fault("Sieve (mm),Wt. %\n16,40\n8,30\n4,10\npan,20\n");
    assert!(fault.contains("has 20 in the pan"), "{fault}");
    // Nothing passes the pan.
    let (set, _) = read("Sieve (mm),sample A\n16,100\n8,30\n4,10\npan,0\n");
    assert_eq!(set.curves[0].distribution.points().len(), 3);
}

/// ASTM C136's sheet: "Pan" and "Total" stand under the names of sieves, with no opening.
#[test]
fn pan_and_total_in_another_column() {
    let head = "Sieve,Size (mm),Weight Retained (g)";
    let rows = "1 1/2,37.5,0\n3/4,19,200\n3/8,9.5,500\nPan,,300\nTotal,,1000\n";
    let (set, _) = read(&format!("{head}\n{rows}"));
    let points = set.curves[0].distribution.points();
    assert_eq!(points, [[9.5, 30.0], [19.0, 80.0], [37.5, 100.0]]);
    let head = "Sieve,Size (mm),% Retained,% Passing";
    let rows = "1 1/2,37.5,0,100\n3/4,19,20,80\n3/8,9.5,50,30\nPan,,30,0\nTotal,,100,\n";
    let (set, _) = read(&format!("{head}\n{rows}"));
    assert_eq!(set.curves[0].distribution.points(), points);
}

/// Percents retained as shares of 1 were 99 % passing.
#[test]
fn shares_retained() {
    let whole = "sieve_mm,cumulative % retained\n64,0\n32,0.2\n16,0.55\n8,1\n";
    let (set, said) = read(whole);
    assert_eq!(set.curves[0].distribution.points()[1], [16.0, 45.0]);
    assert!(
        said.iter().any(|said| said.contains("shares of 1")),
        "{said:?}"
    );
    let each = "sieve_mm,individual % retained\n64,0\n32,0.2\n16,0.35\n8,0.25\npan,0.2\n";
    let (set, _) = read(each);
    let points = set.curves[0].distribution.points();
    for (point, wanted) in points.iter().zip([20.0, 45.0, 80.0, 100.0]) {
        assert!((point[1] - wanted).abs() < 1e-9, "{points:?}");
    }
    for text in [
        "sieve_mm,cumulative % retained\n64,0\n32,0.2\n16,0.55\n8,0.8\n4,0.9\n",
        "sieve_mm,individual % retained\n64,0\n32,0.2\n16,0.35\n8,0.25\n4,0.1\n",
    ] {
        let (_, fault) = fault(text);
        assert!(fault.contains("as shares of 1 do"), "{fault}");
    }
    // With signs they are percents.
    let (set, _) = read("sieve_mm,cumulative % retained\n64,0%\n32,0.2%\n16,0.9%\n");
    assert!((set.curves[0].distribution.points()[0][1] - 99.1).abs() < 1e-9);
}

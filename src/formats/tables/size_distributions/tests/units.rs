//! Which unit sizes are in, wherever and in whatever language it is stated; and what is asked about.

use super::*;

/// The P50, mm, of the Swebrec curve of a finder's files: 120 mm. Its points are written in the unit of each.
fn p50_mm(text: &str) -> f64 {
    let (set, _) = read(text);
    let size = set.curves[0].distribution.size_at(50.0).unwrap();
    size * set.unit.in_units_of(LengthUnit::Millimetre)
}

/// Half passes 120 mm: [size in mm, percent].
const POINTS: [[f64; 2]; 4] = [[63.0, 30.6], [120.0, 50.0], [250.0, 83.0], [500.0, 100.0]];

fn table(header: &str, mm_of_one: f64) -> String {
    let points = POINTS.map(|[size, percent]| format!("{:.9};{percent}\n", size / mm_of_one));
    format!("{header}\n{}", points.concat())
}

#[test]
fn units_in_the_languages_of_laboratories() {
    for (header, mm) in [
        ("Siebweite (Zoll);Durchgang", 25.4),
        ("Siebweite [dm];Durchgang [%]", 100.0),
        ("Korngröße (Mikrometer);Durchgang", 0.001),
        ("Korngröße (Mikron);Durchgang", 0.001),
        ("Siebweite (Meter);Durchgang", 1000.0),
        ("Tamaño (pulgadas);% Pasante", 25.4),
        ("Tamaño (pulg.);% Pasante", 25.4),
        ("Tamaño (metros);% Pasante", 1000.0),
        ("Tamaño (micras);% Pasante", 0.001),
        ("Ouverture (pouces);Passant", 25.4),
        ("Ouverture (mètres);Passant", 1000.0),
        ("Apertura (pollici);Passante", 25.4),
        ("Setaccio (metri);Passante cumulato %", 1000.0),
        ("Peneira (polegadas);Passante", 25.4),
        ("Peneira (mm);% passando", 1.0),
        ("Sito (mm);Przechodzi %", 1.0),
        ("Sikt (mm);Passerande mängd %", 1.0),
        ("Elek (mm);Geçen %", 1.0),
        ("Размер (мм);Проход %", 1.0),
        ("Size (mil);passing", 0.0254),
        ("Size (thou);passing", 0.0254),
        ("Size (nm);passing", 1e-6),
        ("Size (yd);passing", 914.4),
    ] {
        let found = p50_mm(&table(header, mm));
        assert!((found / 120.0 - 1.0).abs() < 1e-6, "{header}: {found}");
    }
    // Of a unit that is none of ours it is said.
    let (_, said) = read(&table("Size (yd);passing", 914.4));
    assert_eq!(said, ["sizes in yards are taken for ft times 3"]);
}

/// A unit in the midst of the name is one, too: without it sizes were 25 times too small.
#[test]
fn a_unit_stands_anywhere_in_the_name() {
    for (header, mm) in [
        ("Sieve size (inches) - square opening;Percent passing", 25.4),
        ("Size (in) nominal;passing", 25.4),
        ("Opening in inches (square);passing", 25.4),
        ("Size cm (square hole);passing", 10.0),
        ("Size in cm, nominal;passing", 10.0),
        ("size (m) [square];passing", 1000.0),
        ("Size (Zoll) x;passing", 25.4),
        ("Particle Diameter (µm) Lower;% finer", 0.001),
        ("Particle diameter um (volume);% finer", 0.001),
    ] {
        let found = p50_mm(&table(header, mm));
        assert!((found / 120.0 - 1.0).abs() < 1e-6, "{header}: {found}");
    }
    let found = p50_mm("photo,P20 (in) mean,P50 (in) mean,P80 (in) mean\na,2,4.7244094488,9\n");
    assert!((found / 120.0 - 1.0).abs() < 1e-6, "{found}");
    for header in ["Sieve size in. or mm", "Size (mm) or cm", "Size φ"] {
        let text = format!("{header},passing\n4,10\n8,20\n");
        assert!(
            size_distributions(&text, &DistributionColumns::default()).is_err(),
            "{header}"
        );
    }
}

/// Names that instruments and laboratories give what passes, and the numbers of sieves.
#[test]
fn names_of_instruments() {
    for header in [
        "Size Classes (μm),Volume Density (%),Volume Cumulative (%)",
        "Channel Diameter um,Diff. Volume %,Cum. < Volume %",
        "Size (μm),% Volume In,% Volume Under",
    ] {
        let (set, _) = read(&format!("{header}\n2,5,5\n5,15,20\n10,50,70\n20,30,100\n"));
        let points = set.curves[0].distribution.points();
        assert_eq!(points.last(), Some(&[0.02, 100.0]), "{header}");
        assert_eq!(points[1][1], 20.0, "{header}");
    }
    for header in ["Sieve No. (ASTM)", "US Standard Sieve No."] {
        let (set, _) = read(&format!("{header},percent passing\nNo. 4,100\nNo. 10,40\n"));
        assert_eq!(set.curves[0].distribution.points()[1], [4.75, 100.0]);
    }
    let (set, _) = read("Tamiz,% que pasa\nN° 4,100\nNº 10,40\nN.º 40,5\n");
    assert_eq!(set.curves[0].distribution.points()[2], [4.75, 100.0]);
}

#[test]
fn what_stays_is_understood_in_them_too() {
    for header in [
        "Peneira (mm);% retido acumulado",
        "Setaccio (mm);% trattenuto cumulato",
        "Sito (mm);pozostałość kumulowana %",
        "Elek (mm);kümülatif kalan %",
        "Сито (мм);накопленный остаток %",
    ] {
        let (set, _) = read(&format!("{header}\n40;0\n20;30\n10;80\n"));
        let points = set.curves[0].distribution.points();
        assert_eq!(
            points,
            [[10.0, 20.0], [20.0, 70.0], [40.0, 100.0]],
            "{header}"
        );
    }
}

/// A millimetre is never guessed where the name says something else.
#[test]
fn what_is_no_known_length_is_refused() {
    for (header, wanted) in [
        (
            "Size (cubits);passing",
            "column 'Size (cubits)': 'cubits' is no known unit of sizes",
        ),
        (
            "Size (px);passing",
            "column 'Size (px)' is in pixels, which are no lengths",
        ),
        (
            "Size (mm2);passing",
            "column 'Size (mm2)' is an area, no size",
        ),
        (
            "Size (mm³);passing",
            "column 'Size (mm³)' is a volume, no size",
        ),
        (
            "Size radius (mm);passing",
            "column 'Size radius (mm)' is a radius, half of a size",
        ),
        (
            "Size radius;passing",
            "column 'Size radius' is a radius, half of a size",
        ),
    ] {
        let (line, text) = fault(&table(header, 1.0));
        assert_eq!(line, Some(1), "{header}");
        assert!(text.starts_with(wanted), "{text}");
    }
    // The user's word goes before what is not known.
    let columns = DistributionColumns {
        unit: Some(LengthUnit::Centimetre),
        ..DistributionColumns::default()
    };
    let (set, _) = size_distributions(&table("Size (Ellen);passing", 10.0), &columns).unwrap();
    assert_eq!(set.unit, LengthUnit::Centimetre);
    // How was sieved is no unit.
    let (set, said) = read(&table("Sieve size (ASTM E11, square opening);passing", 1.0));
    assert_eq!(
        (set.unit, said.len()),
        (LengthUnit::Millimetre, 1),
        "{said:?}"
    );
}

/// As a finder's files had it: 2700 times too large where 0.1 was taken for a percent.
#[test]
fn percentiles_called_by_shares() {
    for header in [
        "d(0.1),d(0.5),d(0.9)",
        "\"D(v,0.1)\",\"D(v,0.5)\",\"D(v,0.9)\"",
    ] {
        let (set, said) = read(&format!("photo,{header}\nA,10.383,120,295.58\n"));
        let points = set.curves[0].distribution.points();
        assert_eq!(
            points,
            [[10.383, 10.0], [120.0, 50.0], [295.58, 90.0]],
            "{header}"
        );
        let wanted = "percentiles are called by shares of 1: of 0.5 it is the size that 50 % pass";
        assert_eq!(said[0], wanted);
    }
    assert!(
        fault("photo,d0.1,d0.2\nA,1,2\n")
            .1
            .contains("which nothing says")
    );
    // Percents below 1 beside others are percents.
    let (set, _) = read("photo,D0.1,D1,D5\nA,1,2,3\n");
    assert_eq!(set.curves[0].distribution.points()[0], [1.0, 0.1]);
}

/// Split-Desktop's and others' names of sizes that a percent passes.
#[test]
fn other_names_of_percentiles() {
    let (set, said) =
        read("Image,F10 (cm),F50 (cm),F80 (cm),Topsize (cm)\nA,1.0383,12,23.384,49\n");
    assert_eq!(set.unit, LengthUnit::Centimetre);
    assert_eq!(
        set.curves[0].distribution.points(),
        [[1.0383, 10.0], [12.0, 50.0], [23.384, 80.0]]
    );
    assert_eq!(said, ["columns that are not used: Topsize (cm)"]);
    let (set, said) = read("photo,10 % passing (cm),50 % passing (cm)\nA,1,12\n");
    assert_eq!((set.unit, said), (LengthUnit::Centimetre, vec![]));
    assert_eq!(
        set.curves[0].distribution.points(),
        [[1.0, 10.0], [12.0, 50.0]]
    );
    let (set, _) = read("Image,10%,20%,50%,80%\nA,1.0383,3.4284,12,23.384\n");
    assert_eq!(set.curves[0].distribution.points()[2], [12.0, 50.0]);
}

#[test]
fn a_unit_above_the_names_counts() {
    for text in [
        "Units: inches\nsize;passing\n4.7244;50\n9;90\n",
        "Sieve analysis, all sizes in inches\nSieve;Passing\n4.7244;50\n9;90\n",
        "# made by me\n# unit: inches\nsize;passing\n4.7244;50\n9;90\n",
        "Sieve analysis blast 14 (sizes in inches)\n\nsize;passing\n4.7244;50\n9;90\n",
    ] {
        let (set, said) = read(text);
        assert_eq!(set.unit, LengthUnit::Inch, "{text}");
        assert!(
            said.iter()
                .any(|of| of.contains("the unit of sizes is that of line")),
            "{said:?}"
        );
    }
    // What the column says itself goes before it, and so does the user.
    let (set, _) = read("Units: inches\nsize_cm;passing\n4;50\n9;90\n");
    assert_eq!(set.unit, LengthUnit::Centimetre);
    let (line, text) = fault("Sieve analysis, cm\nsize;passing\n4;50\n9;90\n");
    assert_eq!(line, Some(1));
    assert!(
        text.contains("'cm' in this line above them may be it or not"),
        "{text}"
    );
}

#[test]
fn inches_with_fractions_and_numbered_sieves() {
    let (set, _) = read("Sieve (in),Passing\n20,100\n15 3/4,98\n10,85\n5 1/2,62\n1½,30\n");
    let mm: Vec<f64> = (set.curves[0].distribution.points().iter())
        .map(|[size, _]| size * set.unit.metres() * 1e3)
        .collect();
    // 1 1/2 in. is a sieve of ASTM E11, 37.5 mm; the others have no place there but as inches.
    for (found, wanted) in mm.iter().zip([37.5, 139.7, 254.0, 400.05, 508.0]) {
        assert!((found - wanted).abs() < 1e-9, "{mm:?}");
    }
    let (set, said) = read("US Mesh,% Passing\n4,54\n10,40\n200,9.9\n");
    let sizes = set.curves[0]
        .distribution
        .points()
        .iter()
        .map(|point| point[0]);
    assert_eq!(sizes.collect::<Vec<_>>(), [0.075, 2.0, 4.75]);
    assert_eq!(
        said,
        ["names of sieves are taken for the openings of ASTM E11"]
    );
    for header in ["Mesh", "Tyler mesh"] {
        let text = format!("{header},% Passing\n4,54\n10,40\n");
        assert!(
            fault(&text).1.contains("is the number of a sieve"),
            "{header}"
        );
    }
}

/// What its name calls percent and ends below 1 may be either: a hundred times too fine or too coarse. What ends at 1 is shares.
#[test]
fn percents_up_to_one_are_asked_about() {
    let text = fault("size_mm,percent_passing\n1,0.1\n2,0.2\n8,0.9\n").1;
    assert!(text.contains("says percent, and ends at"), "{text}");
    for (header, end) in [
        ("passing", ""),
        ("percent_passing", ""),
        ("passing (share of 1)", ""),
        ("percent_passing", "%"),
    ] {
        let (set, _) = read(&format!(
            "size_mm,{header}\n1,0.1{end}\n2,0.2{end}\n8,1.0{end}\n"
        ));
        let wanted = if end.is_empty() { 100.0 } else { 1.0 };
        assert_eq!(
            set.curves[0].distribution.points()[2],
            [8.0, wanted],
            "{header}"
        );
    }
}

#[test]
fn names_that_differ_by_their_spelling_are_said() {
    let (set, said) = read(
        "method,trial,size_mm,passing\nSieve,1,1,10\nSieve,1,2,90\nsieve,01,1,20\nsieve,01,2,80\n",
    );
    assert_eq!(set.curves.len(), 2);
    assert_eq!(
        said,
        [
            "'Sieve' and 'sieve' are two methods, whose names differ by their spelling alone",
            "'Sieve / 1' and 'sieve / 01' are two curves, whose names differ by their spelling alone"
        ]
    );
    // Two trials of one method are two methods by a capital letter.
    let (_, said) = read(
        "method,trial,size_mm,passing\nSieve,1,1,10\nSieve,1,2,90\nsieve,2,1,20\nsieve,2,2,80\n",
    );
    assert_eq!(said.len(), 1, "{said:?}");
}

/// A fraction under feet is of feet (half a foot is 152.4 mm), under millimetres of inches (12.7 is the sieve of 12.5).
#[test]
fn fractions_are_of_the_unit_that_is_stated() {
    for (text, wanted) in [
        ("Size (ft),passing\n2,100\n1/2,50\n1/4,20\n", 152.4),
        ("Size (ft),passing\n2 1/2,100\n1 1/2,50\n3/4,20\n", 457.2),
        ("Size (mm),passing\n25,100\n1/2,50\n1/4,20\n", 12.5),
    ] {
        let found = p50_mm(text);
        assert!((found / wanted - 1.0).abs() < 1e-6, "{text}: {found}");
    }
}

/// A half of a foot is 152.4 mm and 3/8 of an inch are 9.525 mm, which no sieve is; 3/8 mm are 0.375 mm.
#[test]
fn fractions_are_of_a_unit_that_is_stated_elsewhere() {
    for (text, wanted, is_said) in [
        (
            "sizes in mm\nsize,passing\n2,100\n3/8,50\n1/4,20\n",
            0.375,
            true,
        ),
        (
            "Units: feet\nsize,passing\n2,100\n1/2,50\n1/4,20\n",
            152.4,
            true,
        ),
        (
            "photo,P20 (mm),P50 (mm),P80 (mm)\na,1/4,3/8,2\n",
            0.375,
            true,
        ),
        (
            "photo,P20 (in),P50 (in),P80 (in)\na,1/4,3/8,2\n",
            9.525,
            true,
        ),
        ("Sieve (cm),1/4,1/2,2\n% passing,20,50,100\n", 5.0, true),
        ("photo,1/4,1/2,2 ft,3 ft\na,20,50,90,100\n", 152.4, true),
        ("photo,1/4 ft,1/2 ft,2 ft\na,20,50,90\n", 152.4, false),
        (
            "size,unit,passing\n2,ft,100\n1/2,ft,50\n1/4,ft,20\n",
            152.4,
            false,
        ),
        // Beside names of sieves, and under inches, it is the sieve's: ASTM E11 has 12.5 mm and 9.5 mm.
        (
            "sizes in mm\nsieve,passing\n25,100\n1/2,50\nNo. 4,20\n",
            12.5,
            false,
        ),
        (
            "sizes in inches\nsize,passing\n2,100\n3/8,50\n1/4,20\n",
            9.5,
            false,
        ),
        ("photo,3/8,1/2,1 in\na,50,60,90\n", 9.5, false),
    ] {
        let found = p50_mm(text);
        assert!((found / wanted - 1.0).abs() < 1e-9, "{text}: {found}");
        let (_, said) = read(text);
        let sentence = "a fraction is of the unit that is stated of sizes, not of inches";
        let is_there = said.iter().any(|said| said.starts_with(sentence));
        assert_eq!(is_there, is_said, "{text}: {said:?}");
    }
}

/// No sieve is called so: 10.6 inches beside names of sieves are no 26.5 mm.
#[test]
fn inches_with_a_point_are_no_names() {
    let (set, _) = read("size,passing\n10.6 in,100\n3/4 in,60\n3/8 in,40\nNo. 4,24\n");
    let top = set.curves[0].distribution.points().last().unwrap()[0];
    let mm = top * set.unit.in_units_of(LengthUnit::Millimetre);
    assert!((mm - 269.24).abs() < 1e-9, "{mm}");
}

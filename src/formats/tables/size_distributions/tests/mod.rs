//! Every layout, every repair with its sentence.

mod cells;
mod faults;
mod protocols;
mod units;

use proptest::prelude::*;

use super::*;
use crate::fragmentation::{Labels, names_sieve};
use fragscale_test_data::shared_data;

type Points = Vec<[f64; 2]>;

fn read(text: &str) -> (DistributionSet, Vec<String>) {
    size_distributions(text, &DistributionColumns::default()).unwrap()
}

/// The only curve's points of a table that needs no repair.
fn points(text: &str) -> Points {
    let (set, warnings) = read(text);
    assert_eq!(warnings, Vec::<String>::new(), "{text}");
    assert_eq!(set.curves.len(), 1, "{text}");
    set.curves[0].distribution.points().to_vec()
}

/// The names of the curves, as "method|trial|photo".
fn names(set: &DistributionSet) -> Vec<String> {
    let name = |labels: &Labels| format!("{}|{}|{}", labels.method, labels.trial, labels.photo);
    set.curves.iter().map(|curve| name(&curve.labels)).collect()
}

/// The fault of a table, on one line, with its line.
fn fault(text: &str) -> (Option<u64>, String) {
    let fault = size_distributions(text, &DistributionColumns::default()).unwrap_err();
    assert!(!fault.remedy.is_empty(), "{fault}");
    (fault.line, fault.to_string())
}

#[test]
fn a_line_a_point() {
    let wanted = [[10.0, 20.0], [20.0, 50.5], [40.0, 100.0]];
    for text in [
        "size_mm,percent_passing\n10,20\n20,50.5\n40,100\n",
        "\u{feff}# a sieve\r\nCum. % Passing;Size (mm)\r\n\r\n100;40\r\n50.5;20\r\n20;10\r\n",
        "Sieve Opening [mm]\tPercentPassing\n40 mm\t100 %\n20 mm\t50.5%\n10mm\t20\n",
        "P(x),x (mm)\n20,10\n50.5,20\n100,40\n",
        "\"Screen size, mm\",\"Cumulative passing (%)\"\n10,20\n 20 , \"50.5\"\n40,100\n",
        "size_mm percent_passing\n10   20\n20 50.5\n40 100\n",
        "Size (mm)   % finer\n10   20\n20   50.5\n40   100\n",
        "Passing size (mm),passing\n10,20\n20,50.5\n40,100\n",
    ] {
        assert_eq!(points(text), wanted, "{text}");
    }
}

#[test]
fn labels_and_weights_of_points() {
    let text = "Method,Run,IMAGE,size_in,passing,Area (m2)\n\
        sieve,,,1,20,\nsieve,,,2,40,\n\
        point cloud,1,a.jpg,1,21,1.5\npoint cloud,1,b.jpg,1,22,2.5\n\
        point cloud,1,a.jpg,2,41,1.5\npoint cloud,1,b.jpg,2,42,\n";
    let (set, warnings) = read(text);
    assert_eq!(set.unit, LengthUnit::Inch);
    assert_eq!(
        names(&set),
        ["sieve||", "point cloud|1|a.jpg", "point cloud|1|b.jpg"]
    );
    let weights: Vec<_> = set.curves.iter().map(|curve| curve.weight).collect();
    assert_eq!(weights, [None, Some(1.5), Some(2.5)]);
    assert_eq!(
        set.curves[2].distribution.points(),
        [[1.0, 22.0], [2.0, 42.0]]
    );
    assert!(warnings.is_empty(), "{warnings:?}");
}

#[test]
fn named_columns_go_before_their_names() {
    let text = "name;a;b;c;size_mm;area;mass\nx;1;10;5;7;2;3\nx;2;20;6;8;2;3\n";
    let name = |name: &str| Some(name.to_owned());
    let mut columns = DistributionColumns {
        size: name("A"),
        passing: name("b"),
        weight: name("mass"),
        unit: Some(LengthUnit::Foot),
        ..DistributionColumns::default()
    };
    let (set, warnings) = size_distributions(text, &columns).unwrap();
    assert_eq!(set.unit, LengthUnit::Foot);
    assert_eq!(names(&set), ["||x"]);
    assert_eq!(set.curves[0].weight, Some(3.0));
    assert_eq!(
        set.curves[0].distribution.points(),
        [[1.0, 10.0], [2.0, 20.0]]
    );
    assert_eq!(warnings, ["columns that are not used: c, size_mm, area"]);
    columns.weight = None;
    let error = size_distributions(text, &columns).unwrap_err();
    assert_eq!(
        error.what,
        "columns 'area' and 'mass' may both be what curves weigh"
    );
    columns.size = name("nosuch");
    let error = size_distributions(text, &columns).unwrap_err();
    assert_eq!(
        error.to_string(),
        "there is no column 'nosuch'; name one of 'name', 'a', 'b', 'c', 'size_mm', 'area', 'mass'"
    );
}

#[test]
fn a_column_a_curve() {
    let text = "Size (mm);sieve;point cloud / 1 (%);point cloud/2/dir/IMG 1.jpg;rest\n\
        40;100;100;;\n20;50;;52;\n10;20;21;22;\n";
    let (set, warnings) = read(text);
    assert_eq!(
        names(&set),
        ["sieve||", "point cloud|1|", "point cloud|2|dir/IMG 1.jpg"]
    );
    assert_eq!(
        set.curves[1].distribution.points(),
        [[10.0, 21.0], [40.0, 100.0]]
    );
    assert_eq!(
        set.curves[2].distribution.points(),
        [[10.0, 22.0], [20.0, 52.0]]
    );
    assert_eq!(warnings, ["column rest is empty and left out"]);
    // Several columns of percent passing, a corner that is empty, trials that are numbers.
    let (set, _) = read("size_mm,sieve % passing,photo (2) passing\n1,2,3\n2,3,4\n");
    assert_eq!(names(&set), ["sieve||", "photo (2)||"]);
    let (set, _) = read("\ta\tb\n10 cm\t2\t3\n20 cm\t3\t4\n");
    assert_eq!(
        (set.unit, names(&set)),
        (LengthUnit::Centimetre, vec!["a||".into(), "b||".into()])
    );
    let (set, _) = read("size_mm,1,2,3\n1,2,3,4\n2,3,4,5\n");
    assert_eq!(names(&set), ["1||", "2||", "3||"]);
}

/// The bare word for a sieve beside sizes is a method, in whatever language; alone it is the sizes.
#[test]
fn a_sieve_beside_sizes_is_a_method() {
    let curve = [[10.0, 21.0], [20.0, 52.0], [40.0, 100.0]];
    for (size, method) in [
        ("Sieve size (mm)", "sieve"),
        ("Siebgröße (mm)", "Sieb"),
        ("Sieböffnung (mm)", "Sieb"),
        ("Sieb (mm)", "Sieb"),
        ("Siebgröße", "Sieb"),
        ("Korngröße", "Sieb"),
        ("mm", "Sieb"),
        ("d [mm]", "Sieb"),
        ("Siebgröße (mm)", "Siebanalyse"),
        ("Ouverture (mm)", "tamis"),
        ("Ouverture", "Tamis"),
        ("Ouverture (mm)", "tamisage"),
        ("Abertura (mm)", "Tamiz"),
        ("Tamaño (mm)", "cribado"),
        ("Apertura (mm)", "Setaccio"),
        ("Abertura (mm)", "peneira"),
        ("Rozmiar (mm)", "sito"),
        ("Rozmiar (mm)", "przesiewanie"),
        ("Maskvidd (mm)", "sikt"),
        ("Elek açıklığı (mm)", "elek"),
        ("Размер (мм)", "сито"),
    ] {
        let wanted = [
            format!("{method}||"),
            "Kamera|1|".into(),
            "Kamera|2|".into(),
        ];
        let rows = "40\t100\t100\t98\n20\t52\t50\t55\n10\t21\t20\t25\n";
        let (set, _) = read(&format!("{size}\t{method}\tKamera/1\tKamera/2\n{rows}"));
        assert_eq!(names(&set), wanted, "{size}");
        assert_eq!(set.curves[0].distribution.points(), curve, "{size}");
        let rows = "100\t40\t100\t98\n52\t20\t50\t55\n21\t10\t20\t25\n";
        // In whatever order, where the method's name is that of a sieve.
        if names_sieve(method) {
            let (set, _) = read(&format!("{method}\t{size}\tKamera/1\tKamera/2\n{rows}"));
            assert_eq!(names(&set), wanted, "{size}");
            assert_eq!(set.curves[0].distribution.points(), curve, "{size}");
        }
    }
    for size in ["Sieb", "tamis", "Tamiz", "Sito"] {
        let (set, _) = read(&format!("{size};Kamera/1;Kamera/2\n20;50;55\n10;20;25\n"));
        assert_eq!(names(&set), ["Kamera|1|", "Kamera|2|"], "{size}");
    }
    assert!(is_table("Siebgröße (mm)\tSieb\tKamera\n10\t20\t30\n", true));
    // Two that are called sizes are asked about, a sieve beside them or not.
    let (_, said) = fault("Sieb;min size;max size;passing\n1;1;2;30\n2;3;4;50\n");
    assert!(
        said.starts_with("columns 'min size' and 'max size' may both"),
        "{said}"
    );
}

#[test]
fn a_line_a_curve_by_size() {
    let text = "photo,trial,10 mm,2 cm,40 mm,camera\na.jpg,1,20,50,100,x\nb.jpg,1,,40,90 %,x\n";
    let (set, warnings) = read(text);
    assert_eq!(names(&set), ["|1|a.jpg", "|1|b.jpg"]);
    assert_eq!(
        set.curves[0].distribution.points(),
        [[10.0, 20.0], [20.0, 50.0], [40.0, 100.0]]
    );
    assert_eq!(
        set.curves[1].distribution.points(),
        [[20.0, 40.0], [40.0, 90.0]]
    );
    assert_eq!(warnings, ["columns that are not used: camera"]);
    let columns = DistributionColumns {
        unit: Some(LengthUnit::Centimetre),
        ..DistributionColumns::default()
    };
    let (set, warnings) = size_distributions("photo,10,20\na,20,30\n", &columns).unwrap();
    assert_eq!((set.unit, warnings), (LengthUnit::Centimetre, vec![]));
    let (set, warnings) = read("10 mm,20 mm\n20,30\n40,50\n");
    assert_eq!(names(&set), ["||line 2", "||line 3"]);
    assert_eq!(
        warnings,
        ["no column names the curves: they are called by their lines"]
    );
}

#[test]
fn a_line_a_curve_by_percent() {
    let text =
        "label,D10 (mm),D50 (mm),D90 (mm),D50_Psi\na,9,26,38,4.7\nb,5,5,,2.3\nc,,,,\na,1,2,3,1\n";
    let text = text.replace("b,5,5,,2.3", "b,5,5,7,2.3");
    let (set, warnings) = read(&text);
    assert_eq!(names(&set), ["||a", "||b", "||a (line 5)"]);
    assert_eq!(
        set.curves[0].distribution.points(),
        [[9.0, 10.0], [26.0, 50.0], [38.0, 90.0]]
    );
    assert_eq!(
        set.curves[1].distribution.points(),
        [[5.0, 50.0], [7.0, 90.0]]
    );
    assert_eq!(
        warnings,
        [
            "columns that are not used: D50_Psi",
            "a line without a number is left out (line 4)",
            "a curve with the name of an earlier one is told apart by its line (line 5)",
            "of percentiles of the same size the largest percent is kept (line 3)",
        ]
    );
    let (set, _) = read("sample size,label,D10_mm,D50_mm\n12,a,9,26\n");
    assert_eq!(names(&set), ["||a"]);
    for header in ["P10,P50", "x10,x50", "d_10,d_50", "K10 mm,K50 mm"] {
        let (set, _) = read(&format!("photo,{header}\na,9,26\n"));
        assert_eq!(
            set.curves[0].distribution.points(),
            [[9.0, 10.0], [26.0, 50.0]],
            "{header}"
        );
    }
    let one_size =
        "no curve has more than one size; give two or more sizes with their percent passing";
    assert_eq!(
        fault("label,D10,D50\na,2,2\n"),
        (Some(2), one_size.to_owned())
    );
    let (line, text) = fault("label,D10,D50,D90\na,1,2,3\nb,3,5,4\n");
    assert_eq!(line, Some(3));
    assert_eq!(
        text,
        "'b': passing falls from 90 % at size 4 mm to 50 % at size 5 mm; correct the percentiles, \
         which grow with the percent"
    );
}

#[test]
fn units_of_sizes() {
    let unit = |text: &str| {
        let (set, warnings) = read(text);
        (
            set.unit,
            set.curves[0].distribution.points()[0][0],
            warnings,
        )
    };
    for (header, wanted) in [
        ("size_mm", LengthUnit::Millimetre),
        ("Size[cm]", LengthUnit::Centimetre),
        ("size in m", LengthUnit::Metre),
        ("Size (in)", LengthUnit::Inch),
        ("size (\")", LengthUnit::Inch),
        ("SIZE, FT", LengthUnit::Foot),
        ("size_us-ft", LengthUnit::UsSurveyFoot),
    ] {
        let text = format!("{header};passing\n1;10\n2;20\n");
        assert_eq!(unit(&text), (wanted, 1.0, vec![]), "{header}");
    }
    // Both signs for micro.
    for micro in ["um", "\u{b5}m", "\u{3bc}m", "microns"] {
        let (unit, size, said) = unit(&format!("size ({micro}),passing\n500,10\n1000,20\n"));
        assert_eq!((unit, size), (LengthUnit::Millimetre, 0.5), "{micro}");
        assert_eq!(said, ["sizes in micrometres are taken for mm times 0.001"]);
    }
    let (_, _, said) = unit("size,passing\n1,10\n2,20\n");
    assert_eq!(
        said,
        [
            "no unit is stated: sizes are taken for mm (state it in the name of their column, or by --size-unit)"
        ]
    );
    // Units behind the sizes, and a column's unit before the user's.
    let (set, _) = read("size,passing\n500 µm,10\n2 mm,20\n1 cm,30\n");
    let sizes: Vec<f64> = set.curves[0]
        .distribution
        .points()
        .iter()
        .map(|p| p[0])
        .collect();
    assert_eq!(sizes, [0.5, 2.0, 10.0]);
    let columns = DistributionColumns {
        unit: Some(LengthUnit::Inch),
        ..DistributionColumns::default()
    };
    let (set, said) = size_distributions("size_mm,passing\n1,10\n2,20\n", &columns).unwrap();
    assert_eq!(set.unit, LengthUnit::Millimetre);
    assert_eq!(
        said,
        ["the column of sizes states its unit, mm: in is passed over"]
    );
    let (set, said) = size_distributions("size,passing\n1,10\n2,20\n", &columns).unwrap();
    assert_eq!((set.unit, said), (LengthUnit::Inch, vec![]));
    assert_eq!(
        fault("size,passing\n1 mm,10\n2,20\n"),
        (
            Some(3),
            "this size has no unit, where others have one; give each size its unit, or state one in \
             the name of the column"
                .to_owned()
        )
    );
}

/// ASTM E11, table 1: No. 4 is 4.75 mm, 3/8 in. 9.5 mm, 1/2 in. 12.5 mm, 2 in. 50 mm (not 50.8 mm).
#[test]
fn sieves_by_name() {
    let text =
        "Sieve,% passing\n#200,1\nNo. 4,30\n3/8\",40\n\"1/2 in.\",50\n1 1/2 inch,80\n2 in.,90\n";
    let (set, said) = read(text);
    let sizes: Vec<f64> = set.curves[0]
        .distribution
        .points()
        .iter()
        .map(|p| p[0])
        .collect();
    assert_eq!(sizes, [0.075, 4.75, 9.5, 12.5, 37.5, 50.0]);
    assert_eq!(set.unit, LengthUnit::Millimetre);
    assert_eq!(
        said,
        ["names of sieves are taken for the openings of ASTM E11"]
    );
    // As laboratories write them below a column of inches.
    let (set, _) = read("Sieve (in),% passing\n3/8,20\n1-1/2,50\n1 3/4,70\n3,90\n");
    let points = set.curves[0].distribution.points();
    let mm = points
        .iter()
        .map(|[size, _]| size * set.unit.metres() * 1e3);
    for (mm, wanted) in mm.zip([9.5, 37.5, 45.0, 76.2]) {
        assert!((mm - wanted).abs() < 1e-9, "{mm} {wanted}");
    }
    assert!(
        fault("Sieve (in),% passing\n3/7,20\n1,50\n")
            .1
            .contains("'3/7'")
    );
    // As Excel writes it for itself.
    let (set, said) = read("sep=;\nsize_mm;passing\n5;20\n10;90\n");
    assert_eq!(set.curves[0].distribution.points()[1], [10.0, 90.0]);
    assert!(said.is_empty(), "{said:?}");
    // Inches alone are inches.
    let (set, said) = read("Sieve,% passing\n1 in,50\n2 in,90\n");
    assert_eq!(set.unit, LengthUnit::Inch);
    assert_eq!(set.curves[0].distribution.points()[1], [2.0, 90.0]);
    assert!(said.is_empty(), "{said:?}");
    assert!(
        fault("Sieve,% passing\nNo. 4,30\nNo. 9,40\n")
            .1
            .contains("'No. 9' is not a number")
    );
}

#[test]
fn repairs_are_said() {
    for (text, wanted, sentence) in [
        (
            "size_mm;passing\n1,5;10\n2,5;20,25\n",
            vec![[1.5, 10.0], [2.5, 20.25]],
            "decimal commas are read as decimal points (3 numbers, first on line 2)",
        ),
        (
            "size_mm\tpassing\n1\t10\n2\t20,25\n",
            vec![[1.0, 10.0], [2.0, 20.25]],
            "decimal commas are read as decimal points (1 number, first on line 3)",
        ),
        (
            "size_mm,passing\n1,10\n\"2,5\",20\n",
            vec![[1.0, 10.0], [2.5, 20.0]],
            "decimal commas are read as decimal points (1 number, first on line 3)",
        ),
        (
            "size_mm,passing\n1,0.25\n2,0.5\n4,1\n",
            vec![[1.0, 25.0], [2.0, 50.0], [4.0, 100.0]],
            "passing is given in shares of 1 and taken times 100",
        ),
        (
            "size_mm,passing\n1,10\n2,100.04\n",
            vec![[1.0, 10.0], [2.0, 100.0]],
            "passing a little above 100 %, as rounding gives it, is taken for 100 % (line 3)",
        ),
        (
            "size_mm,passing\n1,10\n2,50\n3,49.95\n4,100\n",
            vec![[1.0, 10.0], [2.0, 50.0], [3.0, 50.0], [4.0, 100.0]],
            "passing that falls by up to 0.05 %, as rounding gives it, is taken for the percent before (line 4)",
        ),
        (
            "size_mm,passing\n1,10\n1,10\n2,50\n1,10\n",
            vec![[1.0, 10.0], [2.0, 50.0]],
            "a size that is there twice with the same percent counts once (2 times, first on line 3)",
        ),
        (
            "size_mm,passing\n2,50\n1,10\n0,0\n",
            vec![[1.0, 10.0], [2.0, 50.0]],
            "0 % passing a size of 0 says nothing and is left out (line 4)",
        ),
        (
            "size_mm,passing\n2,50\n1,10\nPan,\n",
            vec![[1.0, 10.0], [2.0, 50.0]],
            "the pan under the sieves has no size and is left out (line 4)",
        ),
    ] {
        let (set, said) = read(text);
        assert_eq!(set.curves[0].distribution.points(), wanted, "{text}");
        assert_eq!(said, [sentence], "{text}");
    }
    // A percent sign, a curve of some percent and one that ends low are no shares.
    assert_eq!(points("size_mm,passing\n1,0.2%\n2,0.9 %\n")[1], [2.0, 0.9]);
    assert_eq!(points("size_mm,passing\n1,0.2\n2,0.4\n")[1], [2.0, 0.4]);
    let (signed, _) = read("size_mm,a,b\n1,0.2%,20%\n2,1%,40%\n");
    assert_eq!(signed.curves[0].distribution.points()[1], [2.0, 1.0]);
}

/// Grain sizes from photos of gravel bars (ericslevenson/Photosieving-Automated-Tools): the first line
/// of the table, and one photo that was measured twice.
#[test]
fn real_percentiles() {
    let Some(folder) = shared_data("rock-photosieving-csv") else {
        return;
    };
    let file = folder.join("Master_Matrix.csv");
    let (set, said) = read_size_distributions(&file, &DistributionColumns::default()).unwrap();
    assert_eq!((set.curves.len(), set.unit), (458, LengthUnit::Millimetre));
    assert_eq!(set.curves[0].labels.photo, "C_DJI_0005");
    let points = set.curves[0].distribution.points();
    assert_eq!(
        (points.len(), points[0], points[8]),
        (9, [37.580_402_15, 5.0], [293.953_977_6, 95.0])
    );
    assert!(
        said.iter()
            .any(|said| said.contains("told apart by its line (line 217)")),
        "{said:?}"
    );
    let file = folder.join("Supplementary_Matrix.csv");
    let mut columns = DistributionColumns::default();
    let error = read_size_distributions(&file, &columns).unwrap_err();
    assert!(
        error.fault.what.contains("'D5_untrunc' and one with 'p5'"),
        "{error}"
    );
    columns.size = Some("D5_untrunc".to_owned());
    let (set, _) = read_size_distributions(&file, &columns).unwrap();
    assert_eq!(
        set.curves[0].distribution.points()[4],
        [41.518_482_39, 50.0]
    );
}

#[test]
fn only_what_is_sure_is_taken_for_such_a_table() {
    for sure in [
        "size_mm,percent_passing\n10,20\n",
        "photo,size,% finer\na,10,20\n",
        "Size (mm);sieve;point cloud\n10;20;30\n",
        "photo,10 mm,20 mm\na,1,2\n",
        "label,D10,D50,D90\na,1,2,3\n",
    ] {
        assert!(is_table(sure, true), "{sure}");
    }
    for other in [
        "x,y,z\n1,2,3\n",
        "photo,x,y,z,qx,qy,qz,qw\na,1,2,3,0,0,0,1\n",
        "size,a,b\n1,2,3\n",
        "x,p\n1,2\n",
        "diameter_cm,x,y,species\n1,2,3,4\n",
        "x,y,z,p10,p50,p90\n1,2,3,4,5,6\n",
        "photo,10,20\na,1,2\n",
        "timestamp,tx,ty,tz,qx,qy,qz,qw\n1,2,3,4,5,6,7,8\n",
        "size_mm,percent_passing\n",
        "",
    ] {
        assert!(!is_table(other, true), "{other}");
    }
    // A last line that is cut off does not count.
    assert!(is_table("size_mm,percent_passing\n10,20\n20,", false));
    assert!(!is_table("size_mm,percent_passing\n20,", false));
}

proptest! {
    #[test]
    fn whatever_the_text_an_error_is_one_line(
        text in "(size_mm|passing|retained|photo|D[159]0|10 mm|No\\. 4|in|pan|[-,;\t\n\"# %0-9.e]|.){0,60}"
    ) {
        for text in [text.clone(), format!("size_mm,passing\n{text}"), format!("photo;10 mm;20 mm\n{text}"),
            format!("label\tD10\tD50\n{text}"), format!("size;a/1;b\n{text}")] {
            match size_distributions(&text, &DistributionColumns::default()) {
                Ok((set, said)) => {
                    prop_assert!(!set.curves.is_empty());
                    prop_assert!(set.curves.iter().all(|curve| curve.distribution.points().len() > 1));
                    prop_assert!(said.iter().all(|said| !said.contains('\n')));
                }
                Err(fault) => {
                    let error = FileError::new(Path::new("a.csv"), fault);
                    prop_assert!(!error.to_string().contains('\n'));
                }
            }
        }
    }

    /// What is written is read: one to three decimals, any order of lines, decimal commas or points.
    #[test]
    fn a_table_reads_back(
        steps in prop::collection::vec((1_u32..5000, 0_u32..300), 2..30), comma in any::<bool>(), down in any::<bool>()
    ) {
        let (mut size, mut percent) = (0, 0);
        let mut points = Vec::new();
        for (wider, more) in steps {
            size += wider;
            percent += more;
            points.push([f64::from(size) / 100.0, f64::from(percent) / 100.0]);
        }
        // Below, not in, the shares of 1.
        prop_assume!(percent > 102);
        prop_assume!(percent <= 10_000);
        let mut lines: Vec<String> =
            points.iter().map(|[size, percent]| format!("{size:.2};{percent:.2}\n")).collect();
        if down {
            lines.reverse();
        }
        let text = format!("size_mm;passing\n{}", lines.concat());
        let text = if comma { text.replace('.', ",") } else { text };
        let (set, _) = read(&text);
        prop_assert_eq!(set.curves[0].distribution.points(), points);
    }
}

/// 25.4 mm and 2 cm and 0.1 in; where only some say their unit, nobody knows the others'.
#[test]
fn each_percentile_has_the_unit_of_its_column() {
    let (set, said) = read("photo,D10 (in),D50 [cm],D80 mm\na,0.1,2,25.4\n");
    assert_eq!(set.unit, LengthUnit::Inch);
    let points = set.curves[0].distribution.points();
    for (point, wanted) in points
        .iter()
        .zip([[0.1, 10.0], [2.0 / 2.54, 50.0], [1.0, 80.0]])
    {
        assert!(
            (point[0] - wanted[0]).abs() < 1e-12 && point[1] == wanted[1],
            "{points:?}"
        );
    }
    assert!(said.is_empty(), "{said:?}");
    let (line, text) = fault("photo,D10,D50,D80 (in)\na,1,2,3\n");
    assert_eq!(line, Some(2));
    assert!(
        text.starts_with("this size has no unit, where others have one"),
        "{text}"
    );
}

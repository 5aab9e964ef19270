//! How spreadsheets write names, lines and numbers.

use super::*;

/// As Excel writes names that are wrapped in their cells.
#[test]
fn a_line_break_in_a_name_is_a_blank() {
    let wanted = [[10.0, 20.0], [20.0, 50.0]];
    for text in [
        "Size (mm),\"Passing\n(%)\"\n10,20\n20,50\n",
        "\"Size\n(mm)\",\"Passing\n(%)\"\n10,20\n20,50\n",
        "\"Sieve\r\nsize\r\n(mm)\";\"Passing\r\n(%)\"\r\n10;20\r\n20;50\r\n",
        "\"Size\n\n(mm)\"\t\"Passing \"\"cum.\"\"\n# of all (%)\"\n10\t20\n20\t50\n",
    ] {
        assert_eq!(points(text), wanted, "{text}");
        assert!(is_table(text, true), "{text}");
    }
    // Lines keep their numbers, and titles may be wrapped, too.
    let text = "\"Size\n(mm)\",\"Passing\n(%)\"\n10,20\n20,many\n";
    assert_eq!(
        fault(text),
        (
            Some(5),
            "column Passing (%): 'many' is not a number; correct it, or leave the line out"
                .to_owned()
        )
    );
    let text = "\"Lab\nof the mine\",\n\"Size\n(mm)\",\"Passing\n(%)\"\n10,20\n20,50\n";
    let (set, said) = read(text);
    assert_eq!(set.curves[0].distribution.points(), wanted);
    assert_eq!(
        said,
        ["2 lines above the names of the columns are passed over"]
    );
}

/// It counts the lines. Other lines that begin with # are comments.
#[test]
fn a_first_column_may_be_called_number_sign() {
    let wanted = [[10.0, 20.0], [20.0, 50.0]];
    for text in [
        "#,size (mm),passing (%)\n1,10,20\n2,20,50\n",
        "# of the mine\n# , size (mm) , passing (%)\n1,10,20\n2,20,50\n",
        "#;\"size\n(mm)\";passing (%)\n1;10;20\n2;20;50\n",
        "Lab of the mine\n#\tsize (mm)\tpassing (%)\n1\t10\t20\n2\t20\t50\n",
    ] {
        let (set, said) = read(text);
        assert_eq!(set.curves[0].distribution.points(), wanted, "{text}");
        let unused = "columns that are not used: #".to_owned();
        assert!(said.contains(&unused), "{text}: {said:?}");
    }
    let (set, _) = read("#,size (mm),sieve,cloud\n1,10,20,25\n2,20,50,55\n");
    assert_eq!(names(&set), ["sieve||", "cloud||"]);
    for text in [
        "#,made by,the lab\nsize_mm,passing,note\n10,20,a\n20,50,b\n",
        "#,old,note\nnr,size_mm,passing\n1,10,20\n2,20,50\n",
        "#,5,10\nnr,size_mm,passing\n1,10,20\n2,20,50\n",
        "size_mm,passing,note\n10,20,a\n#,15,b\n20,50,b\n",
    ] {
        let (set, _) = read(text);
        assert_eq!(set.curves[0].distribution.points(), wanted, "{text}");
    }
    let (_, text) = fault("#,made by the lab\n1,10,20\n2,20,50\n");
    assert!(
        text.starts_with("the first line names no columns"),
        "{text}"
    );
}

/// A sieve of 1.000 mm is one of a metre where percents have commas; others of the same table show that points are decimal.
#[test]
fn thousands_in_the_names_of_columns_are_refused() {
    let of = |text: &str| size_distributions(text, &DistributionColumns::default());
    for (text, named) in [
        ("photo;1.000 mm;2.000 mm\nA;20,5;100\n", "'1.000 mm'"),
        ("photo;500 mm;1.000 mm\nA;20,5;100\n", "'1.000 mm'"),
        ("photo\t1,000 mm\t2,000 mm\nA\t20.5\t100\n", "'1,000 mm'"),
    ] {
        let fault = of(text).unwrap_err();
        assert!(fault.what.contains(named), "{fault}");
        assert!(fault.what.contains("separator of thousands"), "{fault}");
    }
    for (text, largest) in [
        ("photo;0.500 mm;1.000 mm\nA;20,5;100\n", 1.0),
        ("photo;1.000 mm;2.000 mm\nA;20.5;100\n", 2.0),
        ("photo;1,000 mm;2,000 mm\nA;20,5;100\n", 2.0),
    ] {
        let (set, _) = of(text).unwrap();
        let points = set.curves[0].distribution.points();
        assert_eq!(points.last().map(|point| point[0]), Some(largest), "{text}");
    }
}

/// As German Excel writes them, of a table whose other numbers have decimal commas, and of masses that say it themselves.
#[test]
fn thousands_may_have_points_where_commas_are_decimal() {
    let (set, said) = read(
        "Sieböffnung [mm];Durchgang [%]\n1.000;100,0\n500;88,4\n250;60,1\n125;31,5\n31,5;11,2\n",
    );
    let wanted = [
        [31.5, 11.2],
        [125.0, 31.5],
        [250.0, 60.1],
        [500.0, 88.4],
        [1000.0, 100.0],
    ];
    assert_eq!(set.curves[0].distribution.points(), wanted);
    assert!(
        said.iter()
            .any(|said| said.contains("'1.000' as 1000 (1 number, first on line 2)")),
        "{said:?}"
    );
    // 1250 of 5000 g stay on 500 mm: three quarters pass; 1250 g more on 250 mm.
    let (set, _) = read(
        "Sieböffnung [mm];Rückstand [g]\n500;1.250,0\n250;1.250,0\nSchale;2.500,0\nSumme;5.000\n",
    );
    let points = set.curves[0].distribution.points();
    assert_eq!(points, [[250.0, 50.0], [500.0, 75.0]]);
}

/// As Excel writes them in French and Swiss, with a unit behind them or not, as sizes and as names of columns.
#[test]
fn thousands_may_stand_apart_everywhere() {
    let wanted = [[500.0, 20.0], [1200.0, 50.0], [12_500.0, 100.0]];
    for (text, how) in [
        (
            "size_mm;passing\n500;20\n1 200;50\n12 500;100\n",
            "'1 200' as 1200 (2 numbers, first on line 3)",
        ),
        (
            "size;passing\n500 mm;20\n1'200 mm;50\n12'500 mm;100\n",
            "'1'200 mm' as 1200 (2 numbers, first on line 3)",
        ),
        (
            "size;unit;passing\n500;mm;20\n1\u{a0}200;mm;50\n1250;cm;100\n",
            "'1\u{a0}200 mm' as 1200 (1 number, first on line 3)",
        ),
        (
            "photo;500 mm;1\u{202f}200 mm;12\u{2009}500 mm\na;20;50;100\n",
            "'1\u{202f}200 mm' as 1200 (2 numbers, first on line 1)",
        ),
        (
            "Sieve (mm);500;1 200;12 500\n% passing;20;50;100\n",
            "'1 200' as 1200 (2 numbers, first on line 1)",
        ),
        (
            "photo;P20 (mm);P50 (mm);P100 (mm)\na;500;1 200;12 500\n",
            "'1 200' as 1200 (2 numbers, first on line 2)",
        ),
    ] {
        let (set, said) = read(text);
        assert_eq!(set.curves[0].distribution.points(), wanted, "{text}");
        let sentence = format!("thousands that stand apart are read as one number: {how}");
        assert_eq!(said, [sentence], "{text}");
    }
}

use super::*;

fn numbers(text: &str) -> Result<(Vec<Option<f64>>, Vec<String>), Fault> {
    let table = Table::read(text)?;
    let mut repairs = NumberRepairs::default();
    let numbers = table
        .rows()
        .iter()
        .map(|row| table.number(row, 0, &mut repairs))
        .collect::<Result<_, Fault>>()?;
    Ok((numbers, repairs.warnings()))
}

#[test]
fn separators_comments_quotes_and_lines() {
    for text in [
        "\u{feff}# c\r\n\r\na,\"b, \"\"c\"\"\"\r\n# c\r\n1,\"2, x\"\r\n",
        "\n\n\na;\"b, \"\"c\"\"\"\n\n1;\"2, x\"\n",
        "\n\na\tb, \"c\"\n\n1\t2, x",
    ] {
        let table = Table::read(text).unwrap();
        assert_eq!(table.header(), ["a", "b, \"c\""], "{text:?}");
        assert_eq!(
            (table.rows().len(), table.rows()[0].line),
            (1, table.header_line() + 2)
        );
        assert_eq!(table.rows()[0].cell(1).replace(", ", ","), "2,x");
        assert_eq!(table.rows()[0].cell(7), "");
    }
    let table = Table::read("a b  c (d)\n1   2\n").unwrap();
    assert_eq!(
        (table.header(), table.rows()[0].cell(1)),
        (&["a b".into(), "c (d)".into()][..], "2")
    );
    let table = Table::read("a c (d)\n1\t2\n").unwrap();
    assert_eq!(table.header(), ["a", "c (d)"]);
    // Semicolons in a name, commas in every line; inches; a sieve's name is no comment.
    let table = Table::read("a (b; c),d (\")\n1,2\n#4,5\n#no data\n").unwrap();
    assert_eq!(table.header(), ["a (b; c)", "d (\")"]);
    assert_eq!((table.rows()[1].cell(0), table.rows()[1].line), ("#4", 3));
    assert_eq!(table.rows().len(), 2);
}

#[test]
fn columns_are_found_as_people_write_them() {
    let table = Table::read("Step Time (s),who,Who,\n1,2,3\n").unwrap();
    assert_eq!(table.column("step_time_s"), Ok(0));
    assert_eq!(table.column("Who"), Ok(2));
    let fault = table.column("WHO").unwrap_err();
    assert_eq!(fault.what, "2 columns are called 'WHO'");
    let fault = table.column("when").unwrap_err();
    assert_eq!(
        fault.to_string(),
        "there is no column 'when'; name one of 'Step Time (s)', 'who', 'Who', ''"
    );
    assert_eq!(table.name(3), "number 4");
    assert!(table.column("").is_ok());
}

#[test]
fn numbers_are_what_they_can_only_be() {
    let (found, said) = numbers("a;b\n1;\n-2.5e-3;\n;x\n+.5;\n1.000;\n").unwrap();
    assert_eq!(
        found,
        [Some(1.0), Some(-0.0025), None, Some(0.5), Some(1.0)]
    );
    assert!(said.is_empty(), "{said:?}");
    let (found, said) = numbers("a;b\n0,125;\n1,5e1;\n1,000;\n").unwrap();
    assert_eq!(found, [Some(0.125), Some(15.0), Some(1.0)]);
    assert_eq!(
        said,
        ["decimal commas are read as decimal points (3 numbers, first on line 2)"]
    );
    for bad in [
        "1,000",
        "1,000,000",
        "1.00,5",
        "1.000,",
        "1.2.3",
        "1 00",
        "1'0000",
        "x",
        "1x",
        "-",
        "1e",
        "nan",
        "inf",
        "1e999",
        ".",
        ",",
        "--1",
        "1/2",
    ] {
        let fault = numbers(&format!("a;b\n2;\n{bad};\n")).unwrap_err();
        assert_eq!(fault.line, Some(3), "{bad}");
        assert!(
            fault.what.starts_with(&format!("column a: '{bad}' ")),
            "{fault}"
        );
    }
    // A comma and a point that both can only be decimal: neither says what 1,000 is.
    assert!(numbers("a;b\n1,5;2.5\n1,000;3\n").is_err());
    assert!(numbers("a;b\n1,5;2.5\n1.000;3\n").is_err());
    assert!(numbers("a;b\n1,5;2.5\n1.000,5;3\n").is_err());
}

/// As Excel writes them in German and in English, where the table's decimals, or the number itself, say which sign is which.
#[test]
fn thousands_that_points_or_commas_part() {
    let said_of = |how: &str| {
        format!(
            "points or commas between thousands are left out, for the table's decimal sign is the other one: {how}"
        )
    };
    let (found, said) = numbers("a;b\n1.000;88,4\n-12.500;1\n500;2\n").unwrap();
    assert_eq!(found, [1000.0, -12_500.0, 500.0].map(Some));
    assert_eq!(
        said,
        [said_of("'1.000' as 1000 (2 numbers, first on line 2)")]
    );
    // A number with both signs says it of the others.
    let (found, said) = numbers("a;b\n1.250,5;1\n1.000;1\n1.234.567;1\n1,250;1\n").unwrap();
    assert_eq!(found, [1250.5, 1000.0, 1_234_567.0, 1.25].map(Some));
    assert_eq!(
        said,
        [
            "decimal commas are read as decimal points (2 numbers, first on line 2)".to_owned(),
            said_of("'1.250,5' as 1250.5 (3 numbers, first on line 2)")
        ]
    );
    // Another column does not say it: these may be metres with points beside percents with commas, and the other way round.
    for [first, second] in [["2.500;88,4", "1.250;60,1"], ["2,500;88.4", "1,250;60.1"]] {
        let fault = numbers(&format!("size_m;passing\n{first}\n{second}\n")).unwrap_err();
        let wanted = "may have a decimal sign or a separator of thousands";
        assert!(fault.what.ends_with(wanted), "{fault}");
        assert_eq!(fault.line, Some(2));
    }
    // Hundreds in the column itself do.
    let (found, _) = numbers("size_mm;passing\n1,000;88.4\n500;60.1\n").unwrap();
    assert_eq!(found, [1000.0, 500.0].map(Some));
    let (found, said) = numbers("a;b\n1,250.5;1\n1,000;1\n").unwrap();
    assert_eq!(found, [1250.5, 1000.0].map(Some));
    assert_eq!(
        said,
        [said_of("'1,250.5' as 1250.5 (2 numbers, first on line 2)")]
    );
}

#[test]
fn what_stands_too_much_is_refused() {
    let fault = Table::read("a,b\n1,2,\n1,2,3\n").unwrap_err();
    assert_eq!(fault.line, Some(3));
    assert!(
        fault
            .what
            .contains("3 fields for 2 columns ('3' is too many)"),
        "{fault}"
    );
    let wide = format!("{}\n1\n", "a,".repeat(10_001));
    assert!(
        Table::read(&wide)
            .unwrap_err()
            .what
            .contains("over 10000 columns")
    );
}

/// As Excel writes them in French and in Swiss German.
#[test]
fn thousands_that_stand_apart() {
    let text = "a;b\n1\u{a0}450;1\n1\u{202f}234\u{202f}567,5;2\n1'450.25;3\n-12 000;4\n";
    let (found, said) = numbers(text).unwrap();
    let wanted = [1450.0, 1_234_567.5, 1450.25, -12_000.0].map(Some);
    assert_eq!(found, wanted);
    assert_eq!(
        said,
        [
            "decimal commas are read as decimal points (1 number, first on line 3)",
            "thousands that stand apart are read as one number: '1\u{a0}450' as 1450 (4 numbers, first on line 2)",
        ]
    );
    for cell in ["1 45", "0 450", "1 450 5", "1450 000", "1 450'000", "1 4x0"] {
        assert!(numbers(&format!("a;b\n{cell};1\n")).is_err(), "{cell}");
    }
}

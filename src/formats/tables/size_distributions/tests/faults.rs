//! Every fault with its line and its remedy.

use super::*;

#[test]
fn bad_points_have_a_line_and_a_remedy() {
    for (text, line, sentence) in [
        (
            "size_mm,passing\n10,50\n20,40\n",
            3,
            "passing falls from 50 % at size 10 mm (line 2) to 40 % at size 20 mm; correct it; percent \
             passing grows with the size, percent retained falls: give 100 less that",
        ),
        (
            "size_mm,passing,trial\n10,50,1\n20,104,1\n",
            3,
            "'1': 104 % passing at size 20 mm is not in 0 to 100 %; give cumulative percent passing",
        ),
        (
            "size_mm,a,b\n10,0.2,20\n20,1,40\n",
            1,
            "'a' ends at 1 %, as a share of 1 does, beside percents; write it in percent; if it is percent, with % signs",
        ),
        (
            "size_mm,passing\n10,-1\n20,40\n",
            2,
            "-1 % passing at size 10 mm is not in 0 to 100 %; give cumulative percent passing",
        ),
        (
            "size_mm,passing\n10,50\n20,60\n10,51\n",
            4,
            "size 10 mm is there twice, with 50 % on line 2 and 51 % on line 4; keep one, or tell the \
             curves apart in a column method, trial or photo (psd compare: name it by --method, \
             --trial or --photo)",
        ),
        (
            "photo,10 mm,1 cm,20 mm\na,10,11,12\n",
            2,
            "'a': size 10 mm is there twice, with 10 % and 11 %; keep one, or tell the curves apart in a \
             column method, trial or photo (psd compare: name it by --method, --trial or --photo)",
        ),
        (
            "size_mm,passing\n10,50\n",
            2,
            "a single point, 50 % at size 10 mm; give two or more sizes with their percent passing",
        ),
        (
            "size_mm,a,b\n10,50,60\n20,,70\n",
            1,
            "'a': a single point, 50 % at size 10 mm; give two or more sizes with their percent passing",
        ),
        (
            "size_mm,passing\n10,50\n20,sixty\n",
            3,
            "column passing: 'sixty' is not a number; correct it, or leave the line out",
        ),
        (
            "size_mm,passing\n10,50\n20,60 kg\n",
            3,
            "column passing: '60 kg' is not a number; correct it, or leave the line out",
        ),
        (
            "size_mm,passing\n10,50\nlarge,60\n",
            3,
            "column size_mm: 'large' is not a number; correct it, or leave the line out",
        ),
        (
            "size_mm,passing\n10,50\n1e999,60\n",
            3,
            "column size_mm: '1e999' is not finite; correct it",
        ),
        (
            "size_mm,passing\n10,\n20,60\n",
            2,
            "column passing is empty; fill it in, or leave the line out",
        ),
        (
            "size_mm,passing\n,10\n20,60\n",
            2,
            "column size_mm has no size; fill it in, or leave the line out",
        ),
        (
            "size_mm,passing\n0,5\n20,60\n",
            2,
            "size 0 mm, which 5 % pass, is not above 0; give the opening of a sieve, above 0",
        ),
        (
            "size_mm,passing\n-5,5\n20,60\n",
            2,
            "size -5 mm, which 5 % pass, is not above 0; give the opening of a sieve, above 0",
        ),
        (
            "size_mm;passing\n10;50\n1,000;60\n",
            3,
            "column size_mm: '1,000' may have a decimal sign or a separator of thousands; write decimals \
             with a point, and nothing between thousands",
        ),
        (
            "size_mm;passing\n10,5;50.5\n1.234,5;60\n",
            3,
            "column size_mm: '1.234,5' has separators of thousands; write decimals with a point, and \
             nothing between thousands",
        ),
        (
            "size_mm;passing\n10,5;50.5\n1.000;60\n",
            3,
            "column size_mm: '1.000' may have a decimal sign or a separator of thousands; write decimals \
             with a point, and nothing between thousands",
        ),
        (
            "size_mm,passing\n10,50\n12,5,60\n",
            3,
            "it has 3 fields for 2 columns ('60' is too many); write decimal points, and quote what \
             holds the separator",
        ),
        (
            "size_mm,passing,area\n10,50,1\n20,60,2\n",
            3,
            "its weight is 2, where line 2 has 1 for the same curve; give a curve one weight",
        ),
        (
            "size_mm,a,A,a\n10,50,50,50\n20,60,60,60\n",
            1,
            "'a' is there twice; tell them apart by name, or in a column method, trial or photo",
        ),
    ] {
        assert_eq!(fault(text), (Some(line), sentence.to_owned()), "{text}");
    }
}

#[test]
fn bad_tables_say_what_is_missing() {
    let empty = "it is empty; give a line that names the columns, and the numbers below it";
    for text in ["", "\n\n", "# only\n# comments\n", "\u{feff}"] {
        assert_eq!(fault(text), (None, empty.to_owned()), "{text:?}");
    }
    for (text, sentence) in [
        (
            "size_mm,passing\n",
            "it has no line below 'size_mm', 'passing'; give the numbers below the names of the columns",
        ),
        (
            "a,b\n1,2\n",
            "no column is called size or passing among 'a', 'b'; call the columns size and passing \
             in the first line (or name them by --size, --passing)",
        ),
        (
            "grade,% passing\n1,2\n",
            "no column is called size among 'grade', '% passing'; call the column of sizes size in the first line (or name it by --size)",
        ),
        (
            "10,20\n20,40\n",
            "the first line names no columns: '10', '20'; put a line like 'size_mm,percent_passing' first",
        ),
        (
            "size_mm\n10\n20\n",
            "there is no column beside 'size_mm'; give the percent passing in a column",
        ),
        (
            "size_mm,individual % passing\n10,50\n20,40\n",
            "column 'individual % passing' is the percent of each size class, not cumulative; give \
             cumulative percent passing: the sum of all smaller classes",
        ),
        (
            "min size,max size,passing\n1,2,30\n3,4,50\n",
            "columns 'min size' and 'max size' may both be the sizes; name one of them (--size)",
        ),
        (
            "size_mm,passing,D10,D50\n1,2,3,4\n",
            "it can be read in two ways, by 'size_mm' with 'passing' and by percentiles like 'D10'; keep \
             the columns of one of them, or name the sizes and the percent passing (--size, --passing)",
        ),
        (
            "photo,10 mm,20 mm,D10,D50\na,1,2,3,4\n",
            "it can be read in two ways, by columns of sizes like '10 mm' and by percentiles like 'D10'; \
             keep the columns of one of them, or name the sizes and the percent passing (--size, \
             --passing)",
        ),
        (
            "photo,D10,D50,p10,p50\na,1,2,3,4\n",
            "there are several sets of percentiles, one with 'D10' and one with 'p10'; name a column of \
             the one that holds (--size D10)",
        ),
    ] {
        assert_eq!(fault(text), (Some(1), sentence.to_owned()), "{text}");
    }
    assert!(fault("size\0,passing\n1,2\n").1.contains("byte 0"));
    assert!(
        fault(&"size,passing\n1,2\n".repeat(1 << 20))
            .1
            .contains("larger than 16 MB")
    );
    assert!(
        fault(&format!("a,b\n{}", "1\n".repeat(500_001)))
            .1
            .contains("over 500000 lines")
    );
}

#[test]
fn bad_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    for (bytes, wanted) in [
        (
            // Nothing in Windows-1252 either.
            &b"size_mm,passing\n10,50\n20,\x81\n"[..],
            "a.csv:3: it is not UTF-8 text; save it as UTF-8",
        ),
        (
            b"PK\x03\x04\x14",
            "a.csv: it is a spreadsheet's own format or an archive, not text; save the sheet as CSV",
        ),
        (
            b"",
            "a.csv: it is empty; give a line that names the columns, and the numbers below it",
        ),
        (
            b"\xff\xfes\0\0\xd8",
            "a.csv: it is no whole text in UTF-16; save it as CSV in UTF-8",
        ),
    ] {
        std::fs::write(&path, bytes).unwrap();
        let error = read_size_distributions(&path, &DistributionColumns::default()).unwrap_err();
        assert!(error.to_string().ends_with(wanted), "{error}");
    }
    assert!(read_size_distributions(folder.path(), &DistributionColumns::default()).is_err());
}

/// What an engineer has beside cumulative percents, and never is one.
#[test]
fn columns_of_something_else_are_no_curves() {
    for (text, sentence) in [
        (
            "Sieve size (mm),wt %\n25,4\n50,9\n100,18\n200,30\n400,39\n",
            "the percents of 'wt' add up to 100, as those of classes do",
        ),
        (
            "Sieve size (mm),%\n25,4\n50,9\n100,18\n200,30\n400,39\n",
            "the percents add up to 100, as those of classes do",
        ),
        (
            "Sieve size (mm),Mass (kg)\n25,4\n50,9\n100,18\n",
            "column 'Mass (kg)' is a mass, not percent passing",
        ),
        (
            "size (mm),kg\n25,4\n50,9\n100,18\n",
            "column 'kg' is a mass, not percent passing",
        ),
        (
            "Size A (mm),Passing A (%),Size B (in),Passing B (%)\n10,20,1,30\n20,50,2,60\n",
            "columns 'Size A (mm)' and 'Size B (in)' are both sizes",
        ),
        (
            "Size (mm),inch,Sieve,Split\n10,0.4,20,30\n20,0.8,50,60\n",
            "columns 'Size (mm)' and 'inch' are both sizes",
        ),
        (
            "Size (1/10 mm),passing\n100,20\n200,50\n",
            "column 'Size (1/10 mm)' has a number beside its unit",
        ),
        (
            "Size (x100 mm),passing\n1,20\n2,50\n",
            "column 'Size (x100 mm)' has a number beside its unit",
        ),
        (
            "log size (mm),passing\n1,20\n2,50\n",
            "column 'log size (mm)' may be logarithms of sizes",
        ),
        (
            "Size (mm) / in,passing\n10,20\n20,50\n",
            "column 'Size (mm) / in' has two units",
        ),
    ] {
        let (line, said) = fault(text);
        assert_eq!(line, Some(1), "{text}: {said}");
        assert!(said.contains(sentence), "{text}: {said}");
    }
    // A truncated curve that is called what it is, and one that adds up by chance to less.
    for text in [
        "size (mm),percent passing\n10,10\n20,30\n40,60\n",
        "size (mm),sieve\n10,10\n20,31\n40,62\n",
        "size in mm,sieve\n10,10\n20,31\n40,62\n",
    ] {
        assert_eq!(read(text).0.curves.len(), 1, "{text}");
    }
    let text = "size (mm),sieve,Std dev,N,Mass kg\n10,20,1,5,2\n20,50,2,5,3\n40,100,3,5,9\n";
    let (set, said) = read(text);
    assert_eq!(set.curves.len(), 1);
    assert!(
        said.contains(&"columns that are not used: Std dev, N, Mass kg".to_owned()),
        "{said:?}"
    );
}

/// Two tables that are joined by area need not count in the same.
#[test]
fn areas_and_masses_are_of_one_unit() {
    let weight = |name: &str, value: f64| {
        let text = format!("photo,size (mm),passing,{name}\na,10,20,{value}\na,20,60,{value}\n");
        let (set, _) = read(&text);
        set.curves[0].weight.unwrap()
    };
    let square_foot = 0.3048 * 0.3048;
    for (name, value, expected) in [
        ("area (m2)", 3.0, 3.0),
        ("area (ft2)", 10.0, 10.0 * square_foot),
        ("area (sq ft)", 10.0, 10.0 * square_foot),
        ("area_ft2", 10.0, 10.0 * square_foot),
        ("area (cm²)", 1e4, 1.0),
        ("area_mm2", 1e6, 1.0),
        ("mass (t)", 2.0, 2000.0),
        ("mass (kg)", 2.0, 2.0),
        ("mass (lb)", 2.0, 2.0 * 0.453_592_37),
        ("weight g", 500.0, 0.5),
        ("area (in²)", 144.0, square_foot),
        ("area sqft", 1.0, square_foot),
        ("area", 7.0, 7.0),
    ] {
        let found = weight(name, value);
        assert!((found / expected - 1.0).abs() < 1e-12, "{name}: {found}");
    }
}

/// Below the photos of `delineate` stands a line of all of them.
#[test]
fn all_photos_are_no_photo() {
    let text = "photo,D20 (mm),D50 (mm),D80 (mm)\na,10,20,30\nb,11,22,33\nall photos,10,21,32\n";
    let (set, said) = read(text);
    assert_eq!(set.curves.len(), 2);
    assert!(
        said.iter()
            .any(|said| said.contains("a line of sums is left out")),
        "{said:?}"
    );
}

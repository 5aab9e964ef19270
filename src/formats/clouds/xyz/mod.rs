//! Points as text: .xyz, .txt, .csv, .asc. There is no specification; this is what CloudCompare,
//! PDAL, Agisoft, Pix4D and spreadsheets write.
//!
//! - COLMAP's points3D.txt without its comment (POINT3D_ID X Y Z R G B ERROR TRACK) is told by its numbers, and that is said.
//!   Decimal commas between blanks are refused.
//! - One point a line; empty lines and lines that begin with `#` or `//` are passed over, but the
//!   first line, or the first behind such marks, may name the columns.
//! - The separator is found on the first line of numbers: comma, semicolon, tab or spaces. With
//!   semicolons and in quotes the decimal sign may be a comma; between commas alone it may not, and what looks like it is refused.
//! - A height of -9999, -32767 or -32768 stands for none, as in GDAL's grids: such points are left out, which is said.
//! - Without names the columns are x y z, and where six or more stand and the next three are whole
//!   numbers from 0 to 255, red green blue. With names they are found by name: x, y, z (also
//!   easting, northing, elevation, height, altitude, or shorter; a unit may follow in brackets: it is told, and must be
//!   one for all three), red, green, blue (also r, g, b). CloudCompare's Rf, Gf, Bf are colours from 0 to 1. Other named columns may
//!   hold anything, or nothing.
//! - Without names a first of four or more columns that counts the lines is refused: what the others are nothing says, and
//!   surveyors write northing before easting.
//! - A line with a single whole number right behind the names, or first of all, is a count and is
//!   passed over.

mod columns;
mod decimal_commas;

use std::io::BufRead;

use crate::clouds::cloud_file::CloudFile;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::text::fields::shown;
use crate::text::text_lines::TextLines;
use columns::{Columns, unit_of};
use decimal_commas::{
    are_decimal_commas, between_blanks_are_decimal_commas, decimal_commas, decimal_commas_in_quotes,
};

/// Reads points of a text of `size` bytes (for the progress).
///
/// # Errors
/// Where a line has too few columns or something that is not a finite number, or the columns cannot
/// be told.
pub(crate) fn read(
    input: impl BufRead,
    size: u64,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let mut lines = TextLines::new(input);
    let mut file = CloudFile::default();
    let mut named: Option<Columns> = None;
    let mut layout: Option<(Separator, Columns)> = None;
    let mut names = None;
    let (mut looked_at, mut without_height, mut missing) = (0, 0_u64, 0_u64);
    let mut fields = Vec::new();
    // What a first column would have next that counts the lines, from its first number on; `None` once it does not.
    let mut counter: Option<Option<f64>> = Some(None);
    loop {
        if lines.line().is_multiple_of(65_536) {
            progress.advance(lines.bytes(), size)?;
        }
        let line_number = lines.line() + 1;
        let Some(line) = lines.next_line()? else {
            break;
        };
        let line = line.trim();
        let (text, is_comment) = match line.strip_prefix("//").or_else(|| line.strip_prefix('#')) {
            Some(text) => (text.trim(), true),
            None => (line, false),
        };
        if text.is_empty() || (is_comment && (layout.is_some() || named.is_some())) {
            continue;
        }
        let quoted = decimal_commas_in_quotes(text);
        let text = quoted.as_deref().unwrap_or(text);
        let (separator, columns) = match layout {
            Some(known) => known,
            None => {
                let separator = Separator::of(text);
                let wrong = separator.wrong_number(text, &mut fields, named.as_ref());
                if let Some(word) = wrong {
                    if !is_comment && between_blanks_are_decimal_commas(text) {
                        return Err(decimal_commas(line_number, text, "blanks"));
                    }
                    // Names, or a comment in words.
                    let columns = Columns::of_names(&separator.split(text));
                    if columns.is_none() && !is_comment {
                        return Err(match named {
                            Some(_) => not_a_number(line_number, word),
                            None => unknown_columns(line_number, text),
                        });
                    }
                    if let Some(columns) = &columns {
                        let said = separator.split(text);
                        let unit = unit_of(&columns.position.map(|column| said[column]));
                        let unit = unit.map_err(|what| {
                            let remedy = "bring all three to one unit";
                            Fault::at(line_number, what, remedy)
                        })?;
                        file.warnings.extend(unit.map(|unit| {
                            format!("its columns say that they are in {unit}, which is told and not taken over: state the unit (--unit)")
                        }));
                        names = Some(said.len());
                    }
                    named = columns.or(named);
                    continue;
                }
                // A comment of numbers, or a count.
                if is_comment || fields.len() == 1 {
                    continue;
                }
                let of_colmap = Columns::of_colmap(&fields).filter(|_| named.is_none());
                if of_colmap.is_some() {
                    // Its first column may count the lines.
                    counter = None;
                    file.warnings.push(
                        "its columns are taken for those of COLMAP's points3D.txt: a number, x, y, z, red, green, blue, an error, and \
                         where photos show it"
                            .to_owned(),
                    );
                }
                let columns = named
                    .or(of_colmap)
                    .unwrap_or_else(|| Columns::of_numbers(&fields));
                layout = Some((separator, columns));
                (separator, columns)
            }
        };
        if let Some(word) = separator.wrong_number(text, &mut fields, named.as_ref()) {
            return Err(not_a_number(line_number, word));
        }
        let Some((position, color)) = columns.pick(&fields) else {
            let what = format!("it has {} columns, too few", fields.len());
            return Err(Fault::at(
                line_number,
                what,
                "give x, y and z on every line",
            ));
        };
        if separator == Separator::Comma && looked_at < LOOKED_AT {
            looked_at += 1;
            if are_decimal_commas(text, names) {
                return Err(decimal_commas(line_number, text, "commas"));
            }
        }
        counter = counter.filter(|_| named.is_none() && fields.len() > 3);
        counter = match counter {
            Some(Some(next)) => (fields[0] == next).then_some(Some(next + 1.0)),
            Some(None) => (fields[0].fract() == 0.0).then_some(Some(fields[0] + 1.0)),
            None => None,
        };
        if NO_HEIGHT.contains(&position.z) {
            without_height += 1;
            continue;
        }
        if position.is_nan() {
            missing += 1;
            continue;
        }
        if !position.is_finite() {
            return Err(Fault::at(
                line_number,
                "a coordinate is not a finite number",
                "correct or remove the line",
            ));
        }
        file.cloud.points.push(position);
        file.cloud.colors.extend(color);
    }
    if file.cloud.points.is_empty() {
        return Err(Fault::new("it has no points", "give lines with x, y and z"));
    }
    if counter.is_some() && file.cloud.points.len() > 2 {
        return Err(Fault::new(
            "its first column counts the lines: which of the others are x, y and z, nothing says",
            "name the columns in a first line, such as number,x,y,z or number,northing,easting,height",
        ));
    }
    file.say_missing(missing, missing + file.cloud.points.len() as u64);
    if without_height > 0 {
        file.warnings.push(format!(
            "{without_height} points have a height of -9999 or the like, which stands for none, and are left out"
        ));
    }
    Ok(file)
}

/// Heights that stand for none.
const NO_HEIGHT: [f64; 3] = [-9999.0, -32_767.0, -32_768.0];

/// So many lines tell whether commas are decimal signs.
const LOOKED_AT: u32 = 1000;

fn not_a_number(line: u64, word: &str) -> Fault {
    let what = format!("'{}' is not a number", shown(word));
    Fault::at(line, what, "correct or remove the line")
}

fn unknown_columns(line: u64, text: &str) -> Fault {
    Fault::at(
        line,
        format!("the columns '{}' do not name x, y and z", shown(text)),
        "name the columns x, y, z, or remove the line",
    )
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Separator {
    Comma,
    /// The decimal sign may be a comma.
    Semicolon,
    Tab,
    Spaces,
}

impl Separator {
    fn of(line: &str) -> Self {
        if line.contains(';') {
            Self::Semicolon
        } else if line.contains(',') {
            Self::Comma
        } else if line.contains('\t') {
            Self::Tab
        } else {
            Self::Spaces
        }
    }

    fn split(self, line: &str) -> Vec<&str> {
        match self {
            Self::Comma => line.split(',').map(str::trim).collect(),
            Self::Semicolon => line.split(';').map(str::trim).collect(),
            // Tabs are mixed with spaces often enough to be treated alike.
            Self::Tab | Self::Spaces => line.split_ascii_whitespace().collect(),
        }
    }

    /// The numbers of a line, NaN for the words that are none, and the first of those that matters:
    /// where the columns are named, only the columns that are read do.
    fn wrong_number<'a>(
        self,
        line: &'a str,
        numbers: &mut Vec<f64>,
        named: Option<&Columns>,
    ) -> Option<&'a str> {
        numbers.clear();
        let mut wrong = None;
        let mut push = |word: &'a str| {
            let bare = word.trim_matches('"');
            let number = if self == Self::Semicolon && bare.contains(',') {
                bare.replace(',', ".").parse()
            } else {
                bare.parse()
            };
            let matters = named.is_none_or(|columns| columns.reads(numbers.len()));
            if number.is_err() && matters && wrong.is_none() {
                wrong = Some(word);
            }
            numbers.push(number.unwrap_or(f64::NAN));
        };
        match self {
            Self::Comma | Self::Semicolon => {
                let sign = if self == Self::Comma { ',' } else { ';' };
                let line = line.strip_suffix(sign).unwrap_or(line);
                line.split(sign).map(str::trim).for_each(&mut push);
            }
            Self::Tab | Self::Spaces => line.split_ascii_whitespace().for_each(&mut push),
        }
        wrong
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;

    fn read_text(text: &str) -> Result<CloudFile, Fault> {
        read(text.as_bytes(), text.len() as u64, &Progress::default())
    }

    fn points(text: &str) -> Vec<DVec3> {
        read_text(text).unwrap().cloud.points
    }

    #[test]
    fn separators_and_headers_are_found() {
        let expected = [
            DVec3::new(500_000.123_456, 2.5, -3.0),
            DVec3::new(4.0, 5.0, 6e-3),
        ];
        for text in [
            "500000.123456 2.5 -3\n4 5 6e-3\n",
            "500000.123456\t2.5\t-3\r\n4\t5\t6e-3\r\n",
            "X,Y,Z\n500000.123456,2.5,-3\n4,5,6e-3",
            "x, y, z, intensity\n500000.123456, 2.5, -3, 7\n4, 5, 6e-3, 7",
            "X  Y  Z\n500000.123456  2.5  -3\n  4  5  6e-3\n",
            "name;Northing;Elevation;Easting\n1;2,5;-3;500000,123456\n2;5;0,006;4\n",
            "\u{feff}\"x\",\"y\",\"z\"\n500000.123456,2.5,-3\n\n4,5,6e-3\n",
            "# a comment in words\n# x y z\n500000.123456 2.5 -3\n# another\n4 5 6e-3\n",
            "//X Y Z Rf Gf Bf\n2\n500000.123456 2.5 -3 0 0 1\n4 5 6e-3 1 0 0\n",
            "2\n500000.123456 2.5 -3\n4 5 6e-3\n",
            "500000.123456,2.5,-3,\n4,5,6e-3,\n",
        ] {
            assert_eq!(points(text), expected, "{text:?}");
        }
    }

    /// A surveyor's list has the number of the point in front, and northing before easting.
    #[test]
    fn a_first_column_that_counts_is_refused_where_nothing_names_it() {
        for text in [
            "1,499970.5,5999970,100\n2,499971,5999970,100\n3,499972,5999970,101\n",
            "101 5 6 7 0\n102 5 7 7 0\n103 6 7 8 0\n104 7 7 -9999 0\n",
        ] {
            let fault = read_text(text).unwrap_err();
            assert!(fault.what.contains("counts the lines"), "{fault}");
            assert!(read_text(&format!("number,x,y,z,code\n{}", text.replace(' ', ","))).is_ok());
        }
        for text in [
            "1,2,3\n2,2,3\n3,2,3\n",
            "1,2,3,9\n2,2,3,9\n3.5,2,3,9\n",
            "1,2,3,9\n2,2,3,9\n2,3,3,9\n",
        ] {
            assert_eq!(points(text).len(), 3, "{text}");
        }
    }

    #[test]
    fn units_of_columns_are_told_and_must_be_alike() {
        let fault = read_text("X [ft],Y [ft],Z [m]\n1,2,3\n").unwrap_err();
        assert_eq!(fault.what, "x is in ft, y in ft and z in m");
        let file = read_text("X [ft],Y [ft],Z [ft]\n1,2,3\n").unwrap();
        assert!(
            file.warnings[0].contains("they are in ft"),
            "{:?}",
            file.warnings
        );
        for silent in [
            "X [m],Y [m],Z\n1,2,3\n",
            "x,y,z\n1,2,3\n",
            "X (East),Y (North),Z (up)\n1,2,3\n",
        ] {
            assert!(read_text(silent).unwrap().warnings.is_empty(), "{silent}");
        }
    }

    #[test]
    fn other_named_columns_hold_anything() {
        let expected = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)];
        for text in [
            "label,x,y,z,class\nP1,1,2,3,rock\nP2,4,5,6,\n",
            "E,N,H\n1,2,3\n4,5,6\n",
            "n,e,h,z,y,x\n0,0,0,3,2,1\n0,0,0,6,5,4\n",
            "X [m];Y [m];Z (m);time\n1,0;2,0;3,0;2024-05-01 10:00\n4;5;6;\n",
            "\"x\",\"y\",\"z\"\n\"1\",\"2\",\"3\"\n\"4\",\"5\",\"6\"\n",
            "//X Y Z R G B Scalar_field\n2\n1 2 3 4 5 6 nan\n4 5 6 7 8 9 nan\n",
        ] {
            assert_eq!(points(text), expected, "{text:?}");
        }
        let fault = |text: &str| read_text(text).unwrap_err();
        for (text, line, word) in [
            ("label,x,y,z\nP1,one,2,3\n", 2, "'one'"),
            ("label,x,y,z\n1,1,2,3\n1,one,2,3\n", 3, "'one'"),
            ("1 2 3 a\n", 1, "do not name"),
            ("label,x,y,z,yaw\na.jpg,1,2,3,4\n", 2, "'a.jpg'"),
        ] {
            let fault = fault(text);
            assert_eq!(fault.line, Some(line), "{fault}");
            assert!(fault.what.contains(word), "{fault}");
        }
    }

    #[test]
    fn colours() {
        let colors = |text: &str| read_text(text).unwrap().cloud.colors;
        assert_eq!(
            colors("1 2 3 255 0 17\n1 2 3 1 2 3\n"),
            [[255, 0, 17], [1, 2, 3]]
        );
        // Normals are no colours.
        assert!(colors("1 2 3 0.1 0.9 0\n").is_empty());
        assert_eq!(colors("x,y,z,blue,green,red\n1,2,3,4,5,6\n"), [[6, 5, 4]]);
        assert_eq!(colors("//X Y Z Rf Gf Bf\n1 2 3 1 0.5 0\n"), [[255, 128, 0]]);
    }

    /// As COLMAP writes them, but for its comment; tracks are of any length.
    #[test]
    fn points_of_colmap_without_its_comment() {
        let text = "63390 1.67 0.6 12.9 115 121 122 1.33 16 6542 15 7345\n\
                    17 -1.5 0.25 3 0 255 7 0.2 4 1 5 17\n";
        let cloud = read_text(text).unwrap().cloud;
        assert_eq!(
            cloud.points,
            [DVec3::new(1.67, 0.6, 12.9), DVec3::new(-1.5, 0.25, 3.0)]
        );
        assert_eq!(cloud.colors, [[115, 121, 122], [0, 255, 7]]);
        // Numbers may count the lines.
        let counted = text.replace("63390 ", "1 ").replace("17 -1.5", "2 -1.5");
        let counted = counted.clone()
            + &counted
                .replace("2 -1.5", "3 -1.5")
                .replace("1 1.67", "4 1.67");
        assert_eq!(read_text(&counted).unwrap().cloud.points.len(), 4);
        // Colours with normals, a scanner's intensity with time, class and return, are what they were.
        for (line, first) in [
            ("5 1 2 10 20 30 0.5 0.5 0.7 9\n", DVec3::new(5.0, 1.0, 2.0)),
            (
                "500000 5000000 100.00 35 40 50 60 1.500 1 2\n",
                DVec3::new(500_000.0, 5_000_000.0, 100.0),
            ),
        ] {
            let found = read_text(&line.repeat(2)).unwrap();
            assert_eq!(found.cloud.points[0], first);
            assert!(found.warnings.is_empty(), "{:?}", found.warnings);
        }
    }

    #[test]
    fn decimal_commas_between_commas_are_refused() {
        let refused = |text: &str| {
            let fault = read_text(text).unwrap_err();
            assert!(
                fault.what.contains("may be numbers with decimal commas"),
                "{fault}"
            );
            fault.line
        };
        assert_eq!(
            refused("451902,101,5410899,112,90,103\n451902,5,5410899,002,90,3\n"),
            Some(2)
        );
        assert_eq!(refused("x,y,z\n1,5,2,5,3,5\n"), Some(2));
        assert_eq!(refused("500000,123 5000000,5 160,2\n"), Some(1));
        assert_eq!(refused("X\tY\tZ\n500000,123\t5000000,5\t160,2\n"), Some(2));
        // Colours are whole, too.
        assert_eq!(
            points("451902,5410899,90,12,0,255\n"),
            [DVec3::new(451_902.0, 5_410_899.0, 90.0)]
        );
    }

    /// As a spreadsheet of a country of decimal commas writes a comma-separated table.
    #[test]
    fn decimal_commas_in_quotes_are_decimal_signs() {
        let text = "name,x,y,z\n\"a, b\",\"452259,1501\",\"5411829,5\",\"2800,0\"\nc,\"452260\",\"5411830,25\",2801\n";
        let wanted = [
            DVec3::new(452_259.150_1, 5_411_829.5, 2800.0),
            DVec3::new(452_260.0, 5_411_830.25, 2801.0),
        ];
        assert_eq!(points(text), wanted);
    }

    #[test]
    fn heights_that_stand_for_none_are_left_out() {
        let file = read_text("1 2 3\n1 3 -9999\n2 2 -32768\n2 3 4\n").unwrap();
        assert_eq!(file.cloud.points.len(), 2);
        assert!(
            file.warnings[0].starts_with("2 points have a height of -9999"),
            "{:?}",
            file.warnings
        );
    }

    /// NaN marks missing points of organised clouds.
    #[test]
    fn missing_points_are_left_out() {
        let file = read_text("1 2 3\nnan nan nan\n4 5 NaN\n6 7 8\n").unwrap();
        let expected = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(6.0, 7.0, 8.0)];
        assert_eq!(file.cloud.points, expected);
        assert!(file.warnings[0].starts_with("2 of 4 points are not finite"));
        assert!(read_text("nan nan nan\n").is_err());
    }

    #[test]
    fn mistakes_are_placed() {
        let fault = |text: &str| read_text(text).unwrap_err();
        assert_eq!(fault("X,Y,X\n\n0, 0, 0\n").line, Some(1));
        assert_eq!(fault("1 2 3\n4 5\n").line, Some(2));
        assert_eq!(fault("1 2 3\n4 5 six\n").line, Some(2));
        assert_eq!(fault("1 2 3\n4 5 1e999\n").line, Some(2));
        assert!(fault("").what.contains("no points"));
        assert!(fault("x,y,z\n").what.contains("no points"));
        assert!(read(&[0xff, 0xfe, 0][..], 3, &Progress::default()).is_err());
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "([xyz,; \t#0-9.e+-]{0,20}\n){0,20}") {
            let _ = read_text(&text);
        }
    }
}

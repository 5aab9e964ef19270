//! One line of a table as text: what separates its fields, and the fields with their quotes undone.
//! For tables whose lines are read one by one; `table` reads those that are one from end to end.
//!
//! - The separator is, of tab, semicolon and comma, the one that a line holds most of outside of
//!   quotes; white space where it holds none of them, or a colon where there is no white space either
//!   (Orthority's tables).
//! - A field in double or single quotes may hold the separator; a doubled quotation mark in it is one.
//!   Quotes count where they begin a field and end it: elsewhere they are inches and apostrophes.
//! - A comma in a number is a decimal one; that is counted, to be said. `1,234` may as well be
//!   thousands: it is read where other numbers show that commas are decimal here, else refused.

use std::cell::RefCell;

use crate::tables::table::{NumberRepairs, may_be_thousands, split_number};
use crate::text::fields::shown;

/// The separator shows in the first characters of a line.
const LOOKED_AT: usize = 4096;

/// What stands between the fields of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Separator {
    /// This character, once.
    Sign(char),
    /// White space, any amount.
    Blanks,
}

/// Whether a line is of numbers between semicolons, with at most one comma in each: there are more commas than semicolons
/// where all are decimal.
fn is_of_decimal_commas(line: &str) -> bool {
    let is_number = |field: &str| {
        let field = field.trim();
        field.matches(',').count() <= 1 && split_number(field).1.is_empty() && !field.is_empty()
    };
    let line = line.trim_end_matches([';', '\r', '\n']);
    line.contains(';') && line.split(';').all(is_number)
}

impl Separator {
    /// That of a line.
    pub(crate) fn of(line: &str) -> Self {
        // A whole file without a line break need not be looked through to tell.
        let head: String = line.chars().take(LOOKED_AT).collect();
        let bare = without_quoted(&head);
        if is_of_decimal_commas(&bare) {
            return Self::Sign(';');
        }
        let count = |sign: char| bare.matches(sign).count();
        let mut most = (0, Self::Blanks);
        for sign in ['\t', ';', ','] {
            let found = count(sign);
            if found > most.0 {
                most = (found, Self::Sign(sign));
            }
        }
        if most.0 == 0 && count(':') > 1 && Self::Blanks.split(line).len() == 1 {
            return Self::Sign(':');
        }
        most.1
    }

    fn separates(self, c: char) -> bool {
        match self {
            Self::Sign(sign) => c == sign,
            Self::Blanks => c.is_whitespace(),
        }
    }

    /// White space that belongs to no field.
    fn is_padding(self, c: char) -> bool {
        c.is_whitespace() && (self == Self::Blanks || !self.separates(c))
    }

    /// The fields of a line, without blanks at their ends. At least one, which may be empty.
    pub(crate) fn split(self, line: &str) -> Vec<String> {
        let mut fields = Vec::new();
        let mut rest = line.trim_end_matches(['\r', '\n']);
        loop {
            rest = rest.trim_start_matches(|c| self.is_padding(c));
            let (field, behind) = self.first(rest);
            fields.push(field);
            rest = match self {
                Self::Blanks if behind.trim_start().is_empty() => return fields,
                Self::Blanks => behind,
                Self::Sign(sign) => match behind.strip_prefix(sign) {
                    Some(rest) => rest,
                    None => return fields,
                },
            };
        }
    }

    /// The first field, and the line from its separator on.
    pub(crate) fn first(self, line: &str) -> (String, &str) {
        if let Some(found) = self.quoted(line) {
            return found;
        }
        let end = line.find(|c| self.separates(c)).unwrap_or(line.len());
        let (field, behind) = line.split_at(end);
        (field.trim().to_owned(), behind)
    }

    /// As `first`, where it stands in quotes.
    fn quoted(self, line: &str) -> Option<(String, &str)> {
        let quote = line.chars().next().filter(|c| ['"', '\''].contains(c))?;
        let mut field = String::new();
        let mut rest = line.get(quote.len_utf8()..)?;
        loop {
            let (inside, behind) = rest.split_once(quote)?;
            field.push_str(inside);
            match behind.strip_prefix(quote) {
                Some(more) => {
                    field.push(quote);
                    rest = more;
                }
                None => {
                    let next = behind.trim_start_matches(|c| self.is_padding(c));
                    let is_end = next.is_empty()
                        || next.starts_with(|c| self.separates(c))
                        || (self == Self::Blanks && next.len() < behind.len());
                    return is_end.then_some((field, next));
                }
            }
        }
    }
}

/// A line with nothing in its quoted fields, whatever separates them.
fn without_quoted(line: &str) -> String {
    let is_between = |c: char| c.is_whitespace() || ",;:".contains(c);
    let mut bare = String::with_capacity(line.len());
    let mut rest = line;
    let mut begins_field = true;
    while let Some(c) = rest.chars().next() {
        let behind = rest.get(c.len_utf8()..).unwrap_or_default();
        // The quote that ends the field: none in front of it is doubled.
        let undoubled = behind.replace([c, c].iter().collect::<String>().as_str(), "\0\0");
        let end = undoubled.find(c).map(|end| end + c.len_utf8());
        let end = end.filter(|&end| {
            let after = behind.get(end..).and_then(|after| after.chars().next());
            after.is_none_or(is_between)
        });
        if begins_field
            && ['"', '\''].contains(&c)
            && let Some(end) = end
        {
            bare.push(c);
            rest = behind.get(end..).unwrap_or_default();
            begins_field = false;
            continue;
        }
        bare.push(c);
        begins_field = is_between(c);
        rest = behind;
    }
    bare
}

/// The numbers of a table: what shows which sign is the decimal one, and what was mended.
#[derive(Debug, Default)]
pub(crate) struct Numbers {
    decimal_comma: bool,
    decimal_point: bool,
    /// In a cell: closures read numbers.
    repairs: RefCell<NumberRepairs>,
}

impl Numbers {
    /// Those of a table; lines that begin with # are passed over.
    pub(crate) fn of(text: &str) -> Self {
        let mut numbers = Self::default();
        let lines = text.lines().map(str::trim);
        for line in lines.filter(|line| !line.starts_with('#')) {
            for field in Separator::of(line).split(line) {
                let (number, rest) = split_number(&field);
                let signs = [',', '.'].map(|sign| number.matches(sign).count());
                if rest.is_empty() && signs[0] + signs[1] == 1 && !may_be_thousands(number) {
                    numbers.decimal_comma |= signs[0] == 1;
                    numbers.decimal_point |= signs[1] == 1;
                }
            }
        }
        numbers
    }

    /// A field as a finite number; `line` is where it stands.
    ///
    /// # Errors
    /// In words, where it is none.
    pub(crate) fn read(&self, field: &str, line: u64) -> Result<f64, String> {
        let refuse = |what: &str| Err(format!("is '{}', {what}", shown(field)));
        let unclear = "which may have a decimal sign or a separator of thousands";
        let parsed = match (field.matches(',').count(), field.matches('.').count()) {
            (0, 1) if self.decimal_comma && may_be_thousands(field) => return refuse(unclear),
            (1, 0) if may_be_thousands(field) && (self.decimal_point || !self.decimal_comma) => {
                return refuse(unclear);
            }
            (1, 0) => field.replace(',', ".").parse::<f64>(),
            _ => field.parse::<f64>(),
        };
        match parsed {
            Ok(number) if number.is_finite() => {
                if field.contains(',') {
                    self.repairs.borrow_mut().decimal_comma(line);
                }
                Ok(number)
            }
            _ => refuse("not a finite number"),
        }
    }

    /// What was mended, one sentence a kind.
    pub(crate) fn warnings(self) -> Vec<String> {
        self.repairs.into_inner().warnings()
    }
}

/// A text without the quotes around it, if it stands in quotes.
pub(crate) fn unquoted(text: &str) -> String {
    let text = text.trim();
    // No separator: a line feed cannot be in a line.
    match Separator::Sign('\n').quoted(text) {
        Some((inside, "")) => inside,
        _ => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn fields(line: &str) -> Vec<String> {
        Separator::of(line).split(line)
    }

    #[test]
    fn separators_and_quotes() {
        for line in [
            "\"a, b;c.jpg\",1.5,it's,6\"",
            "\"a, b;c.jpg\" ; 1.5 ;it's;6\"\r\n",
            "'a, b;c.jpg'\t1.5\tit's\t6\"",
            "  'a, b;c.jpg'   1.5  it's 6\"  ",
        ] {
            assert_eq!(fields(line), ["a, b;c.jpg", "1.5", "it's", "6\""], "{line}");
        }
        assert_eq!(fields("a:1:2"), ["a", "1", "2"]);
        assert_eq!(fields("C:\\a.jpg 1 2"), ["C:\\a.jpg", "1", "2"]);
        assert_eq!(fields("\"say \"\"cheese\"\"\",1"), ["say \"cheese\"", "1"]);
        assert_eq!(fields(",,\"\","), ["", "", "", ""]);
        assert_eq!(fields("\ta\t"), ["", "a", ""]);
        assert_eq!(fields(""), [""]);
        // A mark that ends nothing is no quotation.
        assert_eq!(fields("\"a\"b,1"), ["\"a\"b", "1"]);
        assert_eq!(fields("'a,1"), ["'a", "1"]);
        // Decimal commas are fewer than what separates, or as many.
        assert_eq!(fields("a;1,5;2,5"), ["a", "1,5", "2,5"]);
        assert_eq!(unquoted(" \"a \"\"b\"\"\" "), "a \"b\"");
        assert_eq!(unquoted("\"a\" and \"b\""), "\"a\" and \"b\"");
    }

    /// Two numbers with decimal commas have more commas than semicolons.
    #[test]
    fn semicolons_go_before_decimal_commas() {
        for (line, expected) in [
            ("452270,5;5411840,5", &["452270,5", "5411840,5"][..]),
            ("1,5;2;3,25;", &["1,5", "2", "3,25", ""]),
            ("a;1,5;2,5", &["a", "1,5", "2,5"]),
            ("1,2,3;4", &["1", "2", "3;4"]),
            ("1,two;3,4", &["1", "two;3", "4"]),
        ] {
            assert_eq!(fields(line), expected, "{line}");
        }
    }

    #[test]
    fn decimal_commas_are_counted_and_thousands_refused() {
        let numbers = Numbers::of("a;-0,5;350123,456\n");
        assert_eq!(numbers.read("-0,5", 3), Ok(-0.5));
        // Other numbers show that it is no separator of thousands.
        assert_eq!(numbers.read("101,234", 4), Ok(101.234));
        assert_eq!(numbers.read("1e-3", 4), Ok(1e-3));
        for bad in ["1.234", "1.234,5", "1,2,3", "nan", "", "a"] {
            assert!(numbers.read(bad, 5).is_err(), "{bad}");
        }
        assert_eq!(
            numbers.warnings(),
            ["decimal commas are read as decimal points (2 numbers, first on line 3)"]
        );
        let unclear = Numbers::of("a;101,234\n").read("101,234", 1).unwrap_err();
        assert!(unclear.contains("thousands"), "{unclear}");
        assert!(Numbers::of("a;1.5;2,345\n").read("2,345", 1).is_err());
        assert_eq!(Numbers::of("a,1.5\n").read("1.234", 1), Ok(1.234));
    }

    proptest! {
        #[test]
        fn what_a_writer_quotes_comes_back(names in prop::collection::vec("[a-c \"',;]{1,8}", 2..6)) {
            let mut writer = csv::WriterBuilder::new()
                .quote_style(csv::QuoteStyle::Always)
                .from_writer(Vec::new());
            writer.write_record(&names).unwrap();
            let line = String::from_utf8(writer.into_inner().unwrap()).unwrap();
            prop_assert_eq!(Separator::Sign(',').split(&line), names);
        }

        #[test]
        fn no_text_panics(line in "([\"', ;:\\t]|\\PC){0,40}") {
            for separator in [Separator::of(&line), Separator::Blanks, Separator::Sign(',')] {
                prop_assert!(!separator.split(&line).is_empty());
            }
            let _ = unquoted(&line);
        }
    }
}

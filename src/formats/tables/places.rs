//! Places in plan: the corners of a polygon, the bends of a line.
//!
//! A place a line, x and y in the world. With a header the columns are found by name (x and y, east and
//! north, easting and northing); without one they are the first two. Lines that begin with # are passed
//! over. As one text, places are separated by semicolons: `1,2;3,4;5,6`.

use std::path::Path;

use glam::DVec2;

use crate::fault::Fault;
use crate::files::{FileError, read_text};
use crate::text::fields::shown;
use crate::text::separated::{Numbers, Separator};

const REMEDY: &str = "give a place a line: x and y";

/// Names of columns, x and y.
const NAMES: [[&str; 4]; 2] = [
    ["x", "e", "east", "easting"],
    ["y", "n", "north", "northing"],
];

/// Reads places from a file, with what was mended.
///
/// # Errors
/// With the file, the line and the remedy.
pub fn read_places(path: &Path) -> Result<(Vec<DVec2>, Vec<String>), FileError> {
    let text = read_text(path)?;
    places(&text).map_err(|fault| FileError::new(path, fault))
}

/// Reads places from the text of a file, with what was mended.
///
/// # Errors
/// With the line and the remedy.
pub fn places(text: &str) -> Result<(Vec<DVec2>, Vec<String>), Fault> {
    if text.trim_start().starts_with(['{', '<']) {
        let what = "it is GeoJSON or XML, whose corners are degrees";
        return Err(Fault::new(
            what,
            "give x and y in the flight's world, a place a line",
        ));
    }
    let numbers = Numbers::of(text);
    let mut counts = Counts::default();
    let mut columns: Option<[usize; 2]> = None;
    let mut places = Vec::new();
    for (line, text) in (1_u64..).zip(text.lines()) {
        let text = text.trim().trim_start_matches('\u{feff}');
        if text.is_empty() || text.starts_with('#') {
            continue;
        }
        let fields = Separator::of(text).split(text);
        let [x, y] = match columns {
            Some(columns) => columns,
            None => match header(&fields) {
                Some(found) => {
                    columns = Some(found);
                    counts.is_broken = true;
                    continue;
                }
                None => *columns.insert([0, 1]),
            },
        };
        let number = |column: usize, name: &str| match fields.get(column) {
            Some(field) => (numbers.read(field, line))
                .map_err(|what| Fault::at(line, format!("{name} {what}"), REMEDY)),
            None => Err(Fault::at(line, format!("there is no {name}"), REMEDY)),
        };
        let place = DVec2::new(number(x, "x")?, number(y, "y")?);
        counts.add(place.x, fields.len());
        places.push(place);
    }
    if counts.are_numbers_of_lines() {
        return Err(Fault::new(
            "its first column counts the lines: which of the others are x and y, nothing says",
            "name the columns in a first line: number,x,y",
        ));
    }
    if places.is_empty() {
        return Err(Fault::new("there is no place in it", REMEDY));
    }
    Ok((places, numbers.warnings()))
}

/// Whether a first column that nobody names counts the lines, from 0 or 1, beside two others.
#[derive(Default)]
struct Counts {
    first: Option<f64>,
    lines: usize,
    /// It does not, or the columns are named.
    is_broken: bool,
}

impl Counts {
    fn add(&mut self, number: f64, fields: usize) {
        let first = *self.first.get_or_insert(number);
        let counts = number == first + self.lines as f64 && [0.0, 1.0].contains(&first);
        self.is_broken |= !counts || fields < 3;
        self.lines += 1;
    }

    fn are_numbers_of_lines(&self) -> bool {
        self.lines >= 3 && !self.is_broken
    }
}

/// Where x and y stand, of a line of names.
fn header(fields: &[String]) -> Option<[usize; 2]> {
    let column = |names: [&str; 4]| {
        let is = |field: &String| {
            // "x_m" and "Easting (m)" are named with their unit.
            let name = field.to_lowercase();
            let name = name.split(|c: char| !c.is_alphanumeric()).next();
            names.contains(&name.unwrap_or_default())
        };
        fields.iter().position(is)
    };
    Some([column(NAMES[0])?, column(NAMES[1])?])
}

/// Places as one text, `x,y;x,y`; as they are typed.
///
/// # Errors
/// With the place that is none.
pub fn typed_places(text: &str) -> Result<Vec<DVec2>, Fault> {
    let places = text.split(';').filter(|place| !place.trim().is_empty());
    let places = places.map(|place| {
        let numbers = place.split_once(',').and_then(|(x, y)| {
            let finite = |text: &str| {
                let number = text.trim().parse::<f64>().ok();
                number.filter(|number| number.is_finite())
            };
            Some(DVec2::new(finite(x)?, finite(y)?))
        });
        numbers.ok_or_else(|| {
            let what = format!("'{}' is no place", shown(place.trim()));
            Fault::new(
                what,
                "write x and y with a comma between them, places with semicolons",
            )
        })
    });
    places.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn with_and_without_names() {
        let expected = vec![DVec2::new(500_000.5, 5e6), DVec2::new(-1.0, 2.25)];
        for text in [
            "# a pile\n500000.5,5000000\n-1,2.25\n",
            "500000.5 5000000 7\n-1 2.25 8",
            "id;Northing (m);Easting (m)\n1;5000000;500000.5\n2;2,25;-1\n",
            "distance_m,x_m,y_m,height_m\n0,500000.5,5000000,1\n1,-1,2.25,1\n",
        ] {
            assert_eq!(places(text).unwrap().0, expected, "{text}");
        }
        let fault = places("x,y\n1,2\n3,wall\n").unwrap_err();
        assert_eq!(fault.line, Some(3));
        assert_eq!(fault.what, "y is 'wall', not a finite number");
        assert_eq!(places("1\n").unwrap_err().what, "there is no y");
        assert!(places("# nothing\n").is_err());
        assert!(
            places("{\"type\": 1}")
                .unwrap_err()
                .what
                .contains("GeoJSON")
        );
    }

    #[test]
    fn numbers_of_lines_are_no_eastings() {
        let fault = places("1,-15,-15\n2,15,-15\n3,15,15\n4,-15,15\n").unwrap_err();
        assert!(
            fault.what.starts_with("its first column counts the lines"),
            "{fault}"
        );
        // Named, or with nothing beside x and y, or too few to count.
        for text in [
            "x,y,z\n1,5,0\n2,6,0\n3,1,0\n",
            "1,5\n2,6\n3,1\n",
            "1,5,0\n2,6,0\n",
        ] {
            assert!(places(text).is_ok(), "{text}");
        }
    }

    #[test]
    fn as_one_text() {
        let typed = typed_places("1,2; -3.5,4e2;").unwrap();
        assert_eq!(typed, [DVec2::new(1.0, 2.0), DVec2::new(-3.5, 400.0)]);
        for text in ["1;2", "1,nan", "1,2,3"] {
            assert!(typed_places(text).is_err(), "{text}");
        }
    }
}

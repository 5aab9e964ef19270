//! A table of named places whose header line names the columns: what surveyors, Pix4D, Metashape and
//! senseFly export, and what people make in a spreadsheet.
//!
//! ```text
//! photo,longitude,latitude,height        fileName  latitude  longitude  altitude_wgs84 ...
//! ```
//!
//! - The separator is the one of tab, semicolon and comma that the header holds most of, else white
//!   space. Fields may be quoted. A comma in a number is a decimal one (see `separated`).
//! - Column names are compared in small letters without blanks, punctuation and what stands in
//!   brackets; of a name with a slash ("X/Easting") one part has to be known ([`Column::of`]). A
//!   leading # belongs to no name. Columns of other names are passed over.
//! - A unit in brackets behind a height beside degrees, or behind an accuracy, is brought to metres, which is said. Beside x and y a unit that is not the metre
//!   is refused: they are in metres, or in what their system counts in, and whether that is it nobody can say here.
//! - Degrees are decimal. Longitude and latitude go before easting and northing where both are there.
//! - The coordinate system is that of a comment "# CoordinateSystem: ..." (Metashape) or "# EPSG:n"
//!   in front of the header, else EPSG:4326 where the columns are longitude and latitude, else not
//!   known. Other lines that begin with # are comments.
//! - senseFly's geoinfo ("#Rev: sensefly/geoinfo/2") is such a table, with two heights: the one above
//!   the ellipsoid is taken, because the receiver measures that one.

use glam::DVec3;

use super::geo_file::leave_out_without_height;
use super::{NamedPosition, PositionList, check_degrees, crs_from_text, is_crs, is_geographic};
use crate::fault::Fault;
use crate::text::separated::{Numbers, Separator, unquoted};
use crate::units::LengthUnit;

/// Reads a table.
pub(super) fn read(text: &str) -> Result<PositionList, Fault> {
    let mut list = PositionList::default();
    let mut layout: Option<Layout> = None;
    let mut without_height = 0_usize;
    let numbers = Numbers::of(text);
    for (line, number) in text.lines().zip(1..) {
        let line = line.trim_end();
        if line.trim().is_empty() {
            continue;
        }
        let comment = line.trim_start().strip_prefix('#');
        let Some(layout) = &layout else {
            if let Some(comment) = comment
                && let Some(crs) = crs_of_comment(comment)
            {
                list.crs = Some(crs);
                continue;
            }
            match Layout::of(comment.unwrap_or(line)) {
                Some(found) => {
                    found.check_units(number)?;
                    list.crs = found.crs(list.crs.take());
                    list.warnings = found.warnings();
                    layout = Some(found);
                }
                None if comment.is_some() => {}
                None => return Err(no_header(number, line)),
            }
            continue;
        };
        if comment.is_some() {
            continue;
        }
        let Some(position) = layout.line(line, number, &numbers)? else {
            without_height += 1;
            continue;
        };
        if is_geographic(list.crs.as_deref()) {
            check_degrees(number, position.position)?;
        }
        list.positions.push(position);
    }
    if layout.is_none() {
        return Err(no_header(1, text.lines().next().unwrap_or_default()));
    }
    leave_out_without_height(&mut list, without_height)?;
    list.warnings.extend(numbers.warnings());
    Ok(list)
}

/// How a table says that it is one of named places.
pub(super) enum SaysSo {
    /// Its header calls the column of names one of photos or control points.
    ByItsHeader,
    /// Names stand in that column: those of classes may be a cloud's.
    ByItsNames,
}

/// Whether a table is one of named places. Numbers in a column "id" may be a cloud's.
pub(super) fn says_so(text: &str) -> Option<SaysSo> {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let header = lines.find_map(|line| {
        let comment = line.trim_start().strip_prefix('#');
        let layout = Layout::of(comment.unwrap_or(line));
        (layout.is_some() || comment.is_none()).then_some(layout)
    });
    let layout = header.flatten()?;
    if layout.says_whose {
        return Some(SaysSo::ByItsHeader);
    }
    // The first few tell.
    let mut names = lines.take(20).filter_map(|line| {
        let fields = layout.separator.split(line);
        fields.into_iter().nth(layout.place(Column::Name)?)
    });
    let is_named = names.any(|name| !name.is_empty() && name.parse::<f64>().is_err());
    is_named.then_some(SaysSo::ByItsNames)
}

fn no_header(line: u64, text: &str) -> Fault {
    let shown: String = text.chars().take(60).collect();
    Fault::at(
        line,
        format!("no header line that names the columns, and no coordinate system: '{shown}'"),
        "put a line like 'photo,longitude,latitude,height' first (or 'EPSG:n' for OpenDroneMap's lists, 'local' where the survey has no coordinate system)",
    )
}

/// The coordinate system that a comment in front of the header states.
fn crs_of_comment(comment: &str) -> Option<String> {
    let comment = comment.trim();
    let (key, value) = comment.split_once(':').unwrap_or(("", comment));
    let key = squeezed(key);
    if matches!(key.as_str(), "coordinatesystem" | "crs" | "srs") {
        return crs_from_text(&unquoted(value));
    }
    is_crs(comment).then(|| crs_from_text(comment)).flatten()
}

/// In small letters, without blanks and punctuation, and without what stands in brackets.
fn squeezed(name: &str) -> String {
    let end = name.find(['(', '[']).unwrap_or(name.len());
    let name = name.get(..end).unwrap_or(name);
    let letters = name.chars().filter(|c| c.is_alphanumeric() || *c == '/');
    letters.flat_map(char::to_lowercase).collect()
}

/// The unit that stands in brackets behind the name of a column; `None` where there is none, or another word.
fn unit_in_brackets(name: &str) -> Option<LengthUnit> {
    let (_, behind) = name.split_once(['(', '['])?;
    let word = behind.split([')', ']']).next()?.trim().to_lowercase();
    match word.as_str() {
        "metre" | "metres" | "meter" | "meters" => Some(LengthUnit::Metre),
        "foot" | "feet" | "'" => Some(LengthUnit::Foot),
        "usft" | "ftus" | "us ft" | "us feet" | "us survey feet" => Some(LengthUnit::UsSurveyFoot),
        symbol => symbol.parse().ok(),
    }
}

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Column {
    Name,
    Longitude,
    Latitude,
    X,
    Y,
    HeightAboveEllipsoid,
    Height,
    Accuracy,
    AccuracyEast,
    AccuracyNorth,
    AccuracyHorizontal,
    AccuracyUp,
}

impl Column {
    fn of(header: &str) -> Option<Self> {
        let name = squeezed(header);
        if let Some(accuracy) = Self::of_accuracy(&name) {
            return Some(accuracy);
        }
        name.split('/').find_map(|part| {
            Some(match part {
                "photo" | "photoname" | "image" | "imagename" | "imageid" | "name" | "label"
                | "filename" | "file" | "sourcefile" | "pointname" | "point" | "pointid"
                | "gcp" | "gcpname" | "gcplabel" | "id" => Self::Name,
                "lon" | "long" | "lng" | "longitude" | "gpslongitude" => Self::Longitude,
                "lat" | "latitude" | "gpslatitude" => Self::Latitude,
                "x" | "easting" | "east" | "e" => Self::X,
                "y" | "northing" | "north" | "n" => Self::Y,
                "altitudewgs84"
                | "ellh"
                | "ellipsoidalheight"
                | "ellipsoidheight"
                | "heightellipsoidal"
                | "heightaboveellipsoid"
                | "altitudeellipsoidal" => Self::HeightAboveEllipsoid,
                "alt" | "altitude" | "height" | "h" | "z" | "elevation" | "elev"
                | "altitudeamsl" | "gpsaltitude" | "orthometricheight" => Self::Height,
                _ => return None,
            })
        })
    }

    /// Columns that state a standard deviation. Metashape's "X_error" is a residual, and none.
    fn of_accuracy(name: &str) -> Option<Self> {
        let of = ["accuracy", "stddev", "std", "sd", "sigma", "acc"]
            .into_iter()
            .find(|word| name.starts_with(word) || name.ends_with(word))?;
        let rest = name.replacen(of, "", 1);
        Some(match rest.trim_matches('/') {
            "" => Self::Accuracy,
            "x" | "e" | "east" | "easting" | "lon" | "longitude" | "x/east" | "x/easting"
            | "x/longitude" => Self::AccuracyEast,
            "y" | "n" | "north" | "northing" | "lat" | "latitude" | "y/north" | "y/northing"
            | "y/latitude" => Self::AccuracyNorth,
            "h" | "xy" | "hor" | "horz" | "horizontal" | "gpsxy" => Self::AccuracyHorizontal,
            "v" | "z" | "u" | "up" | "vert" | "vertical" | "alt" | "altitude" | "height"
            | "hgt" | "z/altitude" | "gpsz" => Self::AccuracyUp,
            _ => return None,
        })
    }
}

/// Which column stands where.
struct Layout {
    separator: Separator,
    columns: Vec<Option<Column>>,
    /// In brackets behind each name.
    units: Vec<Option<LengthUnit>>,
    is_degrees: bool,
    /// Its column of names is one of photos or control points by its own name.
    says_whose: bool,
}

impl Layout {
    /// The layout that a header line states; `None` where it is no header.
    fn of(header: &str) -> Option<Self> {
        let separator = Separator::of(header);
        let mut layout = Self {
            separator,
            columns: Vec::new(),
            units: Vec::new(),
            is_degrees: false,
            says_whose: false,
        };
        let fields = separator.split(header);
        layout.columns = fields.iter().map(|field| Column::of(field)).collect();
        layout.units = fields.iter().map(|field| unit_in_brackets(field)).collect();
        let name = layout
            .place(Column::Name)
            .map(|place| squeezed(&fields[place]));
        let whose = ["photo", "image", "gcp"];
        layout.says_whose =
            name.is_some_and(|name| whose.iter().any(|word| name.starts_with(word)));
        let has = |column| layout.place(column).is_some();
        let in_degrees = has(Column::Longitude) && has(Column::Latitude);
        if !has(Column::Name) || !(in_degrees || has(Column::X) && has(Column::Y)) {
            return None;
        }
        layout.is_degrees = in_degrees;
        Some(layout)
    }

    fn place(&self, column: Column) -> Option<usize> {
        self.columns.iter().position(|&c| c == Some(column))
    }

    /// The unit that the name of a column has behind it.
    fn unit(&self, column: Column) -> Option<LengthUnit> {
        *self.units.get(self.place(column)?)?
    }

    /// The unit of the first column of accuracies that says one.
    fn unit_of_accuracies(&self) -> Option<LengthUnit> {
        let columns = [
            Column::Accuracy,
            Column::AccuracyHorizontal,
            Column::AccuracyEast,
            Column::AccuracyNorth,
            Column::AccuracyUp,
        ];
        columns.into_iter().find_map(|column| self.unit(column))
    }

    /// Refuses x, y and heights beside them in another unit than the metre.
    fn check_units(&self, line: u64) -> Result<(), Fault> {
        let columns = [
            Column::X,
            Column::Y,
            Column::Height,
            Column::HeightAboveEllipsoid,
        ];
        let mut units = columns.into_iter().filter_map(|column| self.unit(column));
        let other = units.find(|unit| *unit != LengthUnit::Metre);
        // Feet behind an accuracy say that x may be in feet, too; millimetres do not: surveyors count so beside metres.
        let of_accuracies = || {
            let unit = self.unit_of_accuracies()?;
            let is_metric = LengthUnit::METRIC.contains(&unit);
            (self.unit(Column::X).is_none() && !is_metric).then_some(unit)
        };
        match other.or_else(of_accuracies).filter(|_| !self.is_degrees) {
            None => Ok(()),
            Some(unit) => Err(Fault::at(
                line,
                format!(
                    "its columns say {unit}, and x, y and heights are read in metres, or in the unit of their coordinate system"
                ),
                "bring them to metres; or, where their system counts so, take the unit out of the names and name the system (--crs)",
            )),
        }
    }

    /// The coordinate system, where comments stated `stated`.
    fn crs(&self, stated: Option<String>) -> Option<String> {
        stated.or_else(|| self.is_degrees.then(|| "EPSG:4326".to_owned()))
    }

    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let heights = [Column::HeightAboveEllipsoid, Column::Height];
        let of_heights = heights.into_iter().find_map(|column| self.unit(column));
        let units = [
            ("heights", of_heights),
            ("accuracies", self.unit_of_accuracies()),
        ];
        for (what, unit) in units {
            if let Some(unit) = unit.filter(|unit| *unit != LengthUnit::Metre) {
                warnings.push(format!(
                    "the list's {what} are in {unit}, and are brought to metres"
                ));
            }
        }
        let above_ellipsoid = self.place(Column::HeightAboveEllipsoid).is_some();
        if above_ellipsoid && self.place(Column::Height).is_some() {
            warnings
                .push("of the list's two heights the one above the ellipsoid is taken".to_owned());
        } else if self.is_degrees && !above_ellipsoid && self.place(Column::Height).is_some() {
            warnings.push(
                "the list does not say whether its heights are above the ellipsoid or above sea level; they differ by up to 100 m".to_owned(),
            );
        }
        warnings
    }

    /// The place on one line; `None` where it has no height.
    fn line(
        &self,
        text: &str,
        line: u64,
        numbers: &Numbers,
    ) -> Result<Option<NamedPosition>, Fault> {
        let fields = self.separator.split(text);
        let field = |column: Column| {
            let field = fields.get(self.place(column)?)?;
            (!field.is_empty()).then_some(field.as_str())
        };
        let number = |column: Column, text: &str| {
            numbers.read(text, line).map_err(|why| {
                let remedy = "write it as a decimal number";
                Fault::at(line, format!("{column:?} {why}"), remedy)
            })
        };
        let needed = |column: Column| {
            let text = field(column).ok_or_else(|| {
                Fault::at(
                    line,
                    format!("the line has no {column:?}"),
                    "fill the columns that the header names",
                )
            })?;
            number(column, text)
        };
        let name = field(Column::Name).ok_or_else(|| {
            Fault::at(line, "the line has no name", "name the photo or the point")
        })?;
        let (x, y) = if self.is_degrees {
            (needed(Column::Longitude)?, needed(Column::Latitude)?)
        } else {
            (needed(Column::X)?, needed(Column::Y)?)
        };
        let height = [Column::HeightAboveEllipsoid, Column::Height]
            .into_iter()
            .find_map(|column| {
                let to_metres = self.unit(column).map_or(1.0, LengthUnit::metres);
                let height = number(column, field(column)?);
                Some(height.map(|height| height * to_metres))
            })
            .transpose()?;
        let accuracy = |columns: &[Column]| -> Result<Option<f64>, Fault> {
            let found = columns.iter().find_map(|&column| {
                let to_metres = self.unit(column).map_or(1.0, LengthUnit::metres);
                let accuracy = number(column, field(column)?);
                Some(accuracy.map(|accuracy| accuracy * to_metres))
            });
            Ok(found.transpose()?.filter(|&accuracy| accuracy > 0.0))
        };
        let horizontal = [Column::AccuracyHorizontal, Column::Accuracy];
        let east = accuracy(&[&[Column::AccuracyEast][..], &horizontal].concat())?;
        let north = accuracy(&[&[Column::AccuracyNorth][..], &horizontal].concat())?;
        let up = accuracy(&[Column::AccuracyUp, Column::Accuracy])?;
        let accuracy = match (east, north, up) {
            (Some(east), Some(north), Some(up)) => Some(DVec3::new(east, north, up)),
            _ => None,
        };
        Ok(height.map(|height| NamedPosition {
            name: name.to_owned(),
            position: DVec3::new(x, y, height),
            accuracy,
            looks: None,
        }))
    }
}

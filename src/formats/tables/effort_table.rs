//! Times of steps as a table.
//!
//! Long, one time a line: a column "step", a column whose name begins with "time" or "duration", and
//! perhaps "method" and "trial". Wide, one step a line: its name first, and a column of times for each
//! trial or method.
//!
//! A time is a number of minutes; of seconds, minutes or hours where the cell ("90 s") or else the
//! column ("time_s", "cloud (h)") says so; or h:mm:ss or mm:ss, in a column of hours h:mm. That mm:ss is no h:mm is said: a log
//! of a site may mean either. An empty cell, or a dash, is a time that is missing.

use std::path::Path;

use crate::fault::Fault;
use crate::files::FileError;
use crate::fragmentation::Effort;
use crate::tables::size_distributions::holds_passing;
use crate::tables::table::{NumberRepairs, Row, Table, key};

/// Seconds.
const HOUR: f64 = 3600.0;

/// Names of rows and columns that a table has for its own sums.
const SUMS: [&str; 9] = [
    "total",
    "totals",
    "subtotal",
    "subtotals",
    "sum",
    "average",
    "averages",
    "mean",
    "avg",
];

/// Names of columns that hold no time.
const NO_TIMES: [&str; 14] = [
    "trial",
    "method",
    "run",
    "n",
    "count",
    "sd",
    "std",
    "std dev",
    "stdev",
    "standard deviation",
    "error",
    "note",
    "notes",
    "comment",
];

/// Names of columns that hold times of the day.
const OF_DAY: [&str; 8] = [
    "start", "begin", "from", "end", "finish", "stop", "to", "until",
];

/// Reads the times of steps from a table, with what was mended or passed over.
///
/// # Errors
/// With the line and the column: a time that is none, a step without a name, two times for one step. A table of size
/// distributions, whose percents are no times.
pub fn effort_table(table: &Table) -> Result<(Effort, Vec<String>), Fault> {
    let mut reading = Reading {
        table,
        effort: Effort::new(),
        repairs: NumberRepairs::default(),
        minutes_and_seconds: None,
        warnings: Vec::new(),
    };
    let named = |begins: &[&str]| {
        let is = |name: &String| begins.iter().any(|begin| key(name).starts_with(begin));
        table.header().iter().position(is)
    };
    if named(&["step"]).is_none() && holds_passing(table) {
        let what = "it holds size distributions, not the times of steps";
        let remedy =
            "give it to 'fragscale psd', or give a table with a column step and one of times";
        return Err(Fault::new(what, remedy));
    }
    // A unit alone: "minutes".
    let of_unit = |name: &String| seconds_of(name).is_some();
    let mut units = table
        .header()
        .iter()
        .enumerate()
        .filter(|(_, name)| of_unit(name));
    let unit = match (units.next(), units.next()) {
        (Some((column, _)), None) => Some(column),
        _ => None,
    };
    match (named(&["step"]), named(&["time", "duration"]).or(unit)) {
        (Some(step), Some(time)) => reading.long(step, time)?,
        _ => reading.wide()?,
    }
    if reading.effort.of_all().known == 0 {
        let what = "there is no time in it";
        return Err(Fault::new(what, "give steps and the times that they took"));
    }
    let mut warnings = reading.repairs.warnings();
    warnings.extend(reading.minutes_and_seconds);
    warnings.extend(reading.warnings);
    Ok((reading.effort, warnings))
}

/// Reads the times of steps from a file; see [`effort_table`].
///
/// # Errors
/// With the file, the line and the remedy.
pub fn read_effort_table(path: &Path) -> Result<(Effort, Vec<String>), FileError> {
    let table = Table::read_file(path)?;
    effort_table(&table).map_err(|fault| FileError::new(path, fault))
}

struct Reading<'a> {
    table: &'a Table,
    effort: Effort,
    repairs: NumberRepairs,
    /// How the first time of two parts was read, and all others.
    minutes_and_seconds: Option<String>,
    warnings: Vec<String>,
}

impl Reading<'_> {
    fn long(&mut self, step: usize, time: usize) -> Result<(), Fault> {
        let (plain_name, seconds_each) = name_and_unit(&self.table.name(time));
        let labels: Vec<usize> = ["method", "trial"]
            .into_iter()
            .filter_map(|label| self.table.column(label).ok())
            .collect();
        for (column, name) in self.table.header().iter().enumerate() {
            if column != step && column != time && !labels.contains(&column) {
                let what = format!("the column '{name}' is not used");
                self.warnings.push(what);
            }
        }
        for row in self.table.rows() {
            let known: Vec<&str> = labels
                .iter()
                .map(|label| row.cell(*label))
                .filter(|label| !label.is_empty())
                .collect();
            let label = match known.join(" / ") {
                none if none.is_empty() => plain_name.clone(),
                some => some,
            };
            self.add(row, step, &label, time, seconds_each)?;
        }
        Ok(())
    }

    fn wide(&mut self) -> Result<(), Fault> {
        let mut columns = Vec::new();
        for column in 1..self.table.header().len() {
            let (name, seconds_each) = name_and_unit(&self.table.name(column));
            if is_sum(&name) {
                let what = format!("the column '{name}' is left out: sums are computed here");
                self.warnings.push(what);
                continue;
            }
            if NO_TIMES.iter().any(|known| key(known) == key(&name)) {
                self.warnings
                    .push(format!("the column '{name}' is not used"));
                continue;
            }
            if OF_DAY.contains(&key(&name).as_str()) {
                let what =
                    format!("column '{name}' may be a time of the day, not how long a step took");
                let remedy = "give the minutes that each step took";
                return Err(Fault::at(self.table.header_line(), what, remedy));
            }
            columns.push((column, name, seconds_each));
        }
        if columns.is_empty() {
            let what = "there is no column of times";
            let remedy = "give a column of steps and one or more of times";
            return Err(Fault::at(self.table.header_line(), what, remedy));
        }
        for row in self.table.rows() {
            for (column, name, seconds_each) in &columns {
                self.add(row, 0, name, *column, *seconds_each)?;
            }
        }
        Ok(())
    }

    /// Adds the time of a cell.
    fn add(
        &mut self,
        row: &Row,
        step: usize,
        label: &str,
        time: usize,
        seconds_each: f64,
    ) -> Result<(), Fault> {
        let step = row.cell(step);
        if is_sum(step) {
            let what = format!("the line '{step}' is left out: sums are computed here");
            if self.warnings.last() != Some(&what) {
                self.warnings.push(what);
            }
            return Ok(());
        }
        let seconds = self.seconds(row, time, seconds_each)?;
        let at_line = |fault: Fault| Fault::at(row.line, fault.what, fault.remedy);
        self.effort.add(step, label, seconds).map_err(at_line)
    }

    /// The time in a cell, in seconds; `None` where it is missing.
    fn seconds(
        &mut self,
        row: &Row,
        column: usize,
        seconds_each: f64,
    ) -> Result<Option<f64>, Fault> {
        let cell = row.cell(column);
        if ["", "-", "–", "—", "n/a", "na"].contains(&cell.to_lowercase().as_str()) {
            return Ok(None);
        }
        let no_time = || {
            let what = format!("column {}: '{cell}' is no time", self.table.name(column));
            let remedy = "write minutes, a number with s, min or h, or h:mm:ss or mm:ss";
            Fault::at(row.line, what, remedy)
        };
        if cell.contains(':') {
            let is_of_hours = seconds_each == HOUR;
            let seconds = clock(cell, is_of_hours).ok_or_else(no_time)?;
            if !is_of_hours && cell.matches(':').count() == 1 {
                self.minutes_and_seconds.get_or_insert_with(|| {
                    format!(
                        "times of two parts are taken for minutes and seconds, the first is '{cell}' on line {}: hours are \
                         written h:mm:ss, or h:mm in a column that says so, as 'time (h)'",
                        row.line
                    )
                });
            }
            return Ok(Some(seconds));
        }
        let found = self.table.number_and_rest(row, column, &mut self.repairs);
        let Some((number, rest)) = found? else {
            return Ok(None);
        };
        let each = match rest {
            "" => seconds_each,
            unit => seconds_of(unit).ok_or_else(no_time)?,
        };
        Ok(Some(number * each))
    }
}

/// Seconds of h:mm:ss or mm:ss, or h:mm where it is of hours; the last may have decimals, and none but the first is 60 or
/// more.
fn clock(text: &str, is_of_hours: bool) -> Option<f64> {
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let (last, leading) = parts.split_last()?;
    let whole = |text: &str| -> Option<f64> {
        let digits =
            !text.is_empty() && text.len() < 10 && text.bytes().all(|b| b.is_ascii_digit());
        digits.then(|| text.parse().ok())?
    };
    let (seconds, decimals) = last.split_once(['.', ',']).unwrap_or((last, "0"));
    let seconds = whole(seconds)? + whole(decimals)? / 10_f64.powi(decimals.len().try_into().ok()?);
    let total = match *leading {
        [hours] if is_of_hours => {
            let minutes = (seconds < 60.0).then_some(seconds)?;
            return Some(whole(hours)? * HOUR + minutes * 60.0);
        }
        [minutes] => whole(minutes)? * 60.0,
        [hours, minutes] => {
            let minutes = whole(minutes).filter(|minutes| *minutes < 60.0)?;
            whole(hours)? * HOUR + minutes * 60.0
        }
        _ => return None,
    };
    (seconds < 60.0).then_some(total + seconds)
}

/// A column's name without its unit, and how many seconds one of the unit has; minutes without one.
fn name_and_unit(name: &str) -> (String, f64) {
    let name = name.trim();
    let bracketed = name
        .strip_suffix([')', ']'])
        .and_then(|rest| rest.rsplit_once(['(', '[']));
    let split = bracketed.or_else(|| name.rsplit_once('_'));
    if let Some((plain, unit)) = split
        && let Some(seconds) = seconds_of(unit)
        && !plain.trim().is_empty()
    {
        return (plain.trim().to_owned(), seconds);
    }
    (name.to_owned(), seconds_of(name).unwrap_or(60.0))
}

fn seconds_of(unit: &str) -> Option<f64> {
    match unit.trim().trim_end_matches('.').to_lowercase().as_str() {
        "s" | "sec" | "secs" | "second" | "seconds" => Some(1.0),
        "min" | "mins" | "minute" | "minutes" => Some(60.0),
        "h" | "hr" | "hrs" | "hour" | "hours" => Some(HOUR),
        _ => None,
    }
}

fn is_sum(name: &str) -> bool {
    SUMS.contains(&key(name).as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<(Effort, Vec<String>), Fault> {
        effort_table(&Table::read(text)?)
    }

    #[test]
    fn long() {
        let (effort, warnings) = read(
            "step,method,trial,time_s,who\nflight,cloud,1,600,A\nflight,cloud,2,12 min,B\n\
             spheres,object,,1:30,A\n",
        )
        .unwrap();
        assert_eq!(effort.steps(), ["flight", "spheres"]);
        assert_eq!(effort.columns(), ["cloud / 1", "cloud / 2", "object"]);
        assert_eq!(effort.seconds(0, 0), Some(600.0));
        assert_eq!(effort.seconds(0, 1), Some(720.0));
        assert_eq!(effort.seconds(1, 2), Some(90.0));
        assert_eq!(effort.of_all().missing, 3);
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        assert_eq!(warnings[1], "the column 'who' is not used");
    }

    /// On a site's log "1:05" may be an hour and five minutes: once it is said how it was read.
    #[test]
    fn times_of_two_parts_are_said_once() {
        let (effort, warnings) = read("step,a,b\nflight,12,1:05\nmesh,2:10,1:00:00\n").unwrap();
        assert_eq!(effort.seconds(0, 1), Some(65.0));
        assert_eq!(
            warnings,
            [
                "times of two parts are taken for minutes and seconds, the first is '1:05' on line 2: hours are \
              written h:mm:ss, or h:mm in a column that says so, as 'time (h)'"
            ]
        );
        let (_, warnings) = read("step,a\nflight,0:01:05\nmesh,3\n").unwrap();
        assert!(warnings.is_empty(), "{warnings:?}");
    }

    /// Percents are no times; flights that are called as percentiles or by their heights are no sizes.
    #[test]
    fn sizes_are_no_times() {
        for text in [
            "method,trial,size_mm,percent_passing\nsieve,,1,5\nsieve,,2,8\n",
            "size_mm,percent_passing\n1,5\n2,8\n",
            "Siebweite (mm);Durchgang (%)\n1;5\n2;8\n",
            "sieve_mm,% retained\n2,40\n1,30\npan,30\n",
            "size_mm,sieve,point cloud/1\n1,5,6\n2,8,9\n",
        ] {
            let fault = read(text).unwrap_err();
            let what = "it holds size distributions, not the times of steps";
            assert_eq!(fault.what, what, "{text}");
        }
        for text in [
            "step,size of sample,passing on\nfly,1,2\n",
            "task,F1,F2,F3\nfly,10,12,11\n",
            "task,20 m,40 m\nfly,10,12\n",
        ] {
            assert!(read(text).is_ok(), "{text}");
        }
    }

    /// In a column of hours two numbers are hours and minutes.
    #[test]
    fn clocks_of_hours() {
        let (effort, warnings) =
            read("step,Time (h)\nsetup,1:30\nflight,0:45:30\nmeshing,2\n").unwrap();
        let seconds = effort.of_all().total;
        assert_eq!(seconds, 5400.0 + 2730.0 + 7200.0);
        assert!(warnings.is_empty(), "{warnings:?}");
        let bad = read("step,Time (h)\nsetup,1:75\n").unwrap_err();
        assert!(bad.what.contains("'1:75' is no time"), "{bad}");
    }

    #[test]
    fn wide() {
        let (effort, warnings) = read(
            "task;point cloud (h);scale object;total\nflight;0,25;1:02:03,5;1\nspheres;-;8.5 s;\n\
             Total;1;2;3\n",
        )
        .unwrap();
        assert_eq!(effort.steps(), ["flight", "spheres"]);
        assert_eq!(effort.columns(), ["point cloud", "scale object"]);
        assert_eq!(effort.seconds(0, 0), Some(900.0));
        assert_eq!(effort.seconds(0, 1), Some(3723.5));
        assert_eq!(effort.seconds(1, 0), None);
        assert_eq!(effort.seconds(1, 1), Some(8.5));
        assert!(
            warnings.iter().any(|w| w.contains("column 'total'")),
            "{warnings:?}"
        );
        assert!(
            warnings.iter().any(|w| w.contains("line 'Total'")),
            "{warnings:?}"
        );
    }

    #[test]
    fn minutes_where_nothing_is_said() {
        let (effort, _) = read("step,time\nflight,2.5\n").unwrap();
        assert_eq!(effort.columns(), ["time"]);
        assert_eq!(effort.seconds(0, 0), Some(150.0));
    }

    #[test]
    fn clocks() {
        assert_eq!(clock("12:34", false), Some(754.0));
        assert_eq!(clock("90:00", false), Some(5400.0));
        assert_eq!(clock("1:00:00.25", false), Some(3600.25));
        for bad in ["1:60", "1:60:00", "1:2:3:4", ":30", "1:", "-1:30", "1:x"] {
            assert_eq!(clock(bad, false), None, "{bad}");
        }
    }

    #[test]
    fn what_is_no_time_is_not_added() {
        let (effort, warnings) =
            read("step,trial,minutes\nSet up,1,10\nFly,1,12\nFly,2,14\n").unwrap();
        assert_eq!(effort.of_all().total, 36.0 * 60.0);
        assert_eq!(effort.columns(), ["1", "2"]);
        assert!(warnings.is_empty(), "{warnings:?}");
        let (effort, warnings) =
            read("task,cloud,sd\nfly,10,3\nSubtotal,10,3\nmesh,20,4\n").unwrap();
        assert_eq!(effort.of_all().total, 30.0 * 60.0);
        let of = |words: &str| warnings.iter().any(|said| said.contains(words));
        assert!(
            of("the column 'sd' is not used") && of("the line 'Subtotal'"),
            "{warnings:?}"
        );
        let fault = read("step,start,end\nfly,8:00,8:20\n").unwrap_err();
        assert!(fault.what.contains("may be a time of the day"), "{fault}");
    }

    #[test]
    fn refuses_with_line_and_column() {
        for (text, line, sentence) in [
            ("step,a\nflight,1\ncloud,quick\n", 3, "column a: 'quick'"),
            (
                "step,a\nflight,3 days\n",
                2,
                "column a: '3 days' is no time",
            ),
            ("step,a\nflight,1:75\n", 2, "column a: '1:75' is no time"),
            ("step,a\nflight,-4\n", 2, "'flight' took -240 s"),
            ("step,a\n,4\n", 2, "without a step"),
            (
                "step,a\nflight,4\nflight,5\n",
                3,
                "a second time for 'flight' of 'a'",
            ),
            ("step,total\nflight,4\n", 1, "no column of times"),
        ] {
            let fault = read(text).unwrap_err();
            assert_eq!(fault.line, Some(line), "{fault}");
            assert!(fault.to_string().contains(sentence), "{fault}");
        }
        let fault = read("step,a\nflight,-\n").unwrap_err();
        assert!(fault.what.contains("no time in it"), "{fault}");
    }
}

//! Values in groups, for an analysis of variance: a table with one value a line, and columns that say
//! which group it is of.

use std::collections::HashMap;
use std::path::Path;

use crate::fault::Fault;
use crate::files::FileError;
use crate::tables::table::{NumberRepairs, Row, Table};
use crate::text::fields::shown;

/// More groups than anyone compares; each is a name in a message or a line of a table.
const MOST_GROUPS: usize = 10_000;

/// The values of a column, by the groups of another.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupedValues {
    /// All values.
    pub all: Groups,
    /// For each value of the `by` column, in the order of the file, the groups of its lines alone.
    pub by: Vec<(String, Groups)>,
    /// What was mended or passed over, one sentence each.
    pub warnings: Vec<String>,
}

/// Groups with their names, in the order of the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Groups {
    /// One name a group.
    pub names: Vec<String>,
    /// The values of each.
    pub values: Vec<Vec<f64>>,
    places: HashMap<String, usize>,
}

impl Groups {
    fn push(&mut self, name: &str, value: f64) -> Result<(), String> {
        let place = match self.places.get(name) {
            Some(place) => *place,
            None if self.names.len() == MOST_GROUPS => {
                return Err(format!("it has over {MOST_GROUPS} groups"));
            }
            None => {
                self.names.push(name.to_owned());
                self.values.push(Vec::new());
                self.places.insert(name.to_owned(), self.names.len() - 1);
                self.names.len() - 1
            }
        };
        if let Some(values) = self.values.get_mut(place) {
            values.push(value);
        }
        Ok(())
    }
}

/// Reads the values of the column `value` in the groups of the column `group`, and again for each
/// value of the column `by`; of the lines that have a text in a column alone, where `only` names both (column, text). A line without
/// a value is passed over and said.
///
/// # Errors
/// With the line and the column: a column that is not there, a value that is no number, a line without
/// its group. Where no line has the text of `only`.
pub fn grouped_values(
    table: &Table,
    group: &str,
    value: &str,
    by: Option<&str>,
    only: Option<(&str, &str)>,
) -> Result<GroupedValues, Fault> {
    let (group, value) = (table.column(group)?, table.column(value)?);
    let by = by.map(|by| table.column(by)).transpose()?;
    let rows = rows_of(table, only)?;
    let mut found = GroupedValues {
        all: Groups::default(),
        by: Vec::new(),
        warnings: Vec::new(),
    };
    let mut parts = HashMap::<&str, usize>::new();
    let mut repairs = NumberRepairs::default();
    let mut without = Vec::new();
    for row in rows {
        let Some(number) = table.number(row, value, &mut repairs)? else {
            without.push(row.line);
            continue;
        };
        for column in [Some(group), by].into_iter().flatten() {
            if row.cell(column).is_empty() {
                let what = format!("a value without its {}", table.name(column));
                let remedy = "fill in the cell, or take the lines of one method or the like (--only COLUMN=TEXT)";
                return Err(Fault::at(row.line, what, remedy));
            }
        }
        let many = |what: String| {
            let remedy = "name a column that holds groups, not measurements";
            Fault::at(row.line, what, remedy)
        };
        found.all.push(row.cell(group), number).map_err(many)?;
        if let Some(by) = by {
            let name = row.cell(by);
            let place = *parts.entry(name).or_insert(found.by.len());
            if place == found.by.len() {
                if place == MOST_GROUPS {
                    return Err(many(format!("over {MOST_GROUPS} tables")));
                }
                found.by.push((name.to_owned(), Groups::default()));
            }
            if let Some((_, groups)) = found.by.get_mut(place) {
                groups.push(row.cell(group), number).map_err(many)?;
            }
        }
    }
    if found.all.names.is_empty() {
        let what = format!("column {} holds no value", shown(&table.name(value)));
        return Err(Fault::new(what, "name the column of the values"));
    }
    found.warnings = repairs.warnings();
    if let Some(first) = without.first() {
        found.warnings.push(format!(
            "{} lines without a value are left out, the first is line {first}",
            without.len()
        ));
    }
    Ok(found)
}

/// The lines that have a text in a column; without both, all.
fn rows_of<'a>(table: &'a Table, only: Option<(&str, &str)>) -> Result<Vec<&'a Row>, Fault> {
    let Some((name, text)) = only else {
        return Ok(table.rows().iter().collect());
    };
    let column = table.column(name)?;
    let is_taken = |row: &&Row| row.cell(column) == text.trim();
    let rows: Vec<&Row> = table.rows().iter().filter(is_taken).collect();
    if rows.is_empty() {
        let what = format!(
            "no line has '{}' in column {}",
            shown(text),
            table.name(column)
        );
        let some = table.rows().iter().map(|row| row.cell(column));
        let some = some.into_iter().find(|cell| !cell.is_empty());
        let remedy = match some {
            Some(some) => format!("name a text of that column, such as '{}'", shown(some)),
            None => "name another column".to_owned(),
        };
        return Err(Fault::new(what, remedy));
    }
    Ok(rows)
}

/// Reads grouped values from a file; see [`grouped_values`].
///
/// # Errors
/// With the file, the line and the remedy.
pub fn read_grouped_values(
    path: &Path,
    group: &str,
    value: &str,
    by: Option<&str>,
    only: Option<(&str, &str)>,
) -> Result<GroupedValues, FileError> {
    let table = Table::read_file(path)?;
    grouped_values(&table, group, value, by, only).map_err(|fault| FileError::new(path, fault))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, by: Option<&str>) -> Result<GroupedValues, Fault> {
        grouped_values(&Table::read(text)?, "Trial", "passing", by, None)
    }

    /// A sieve that was not repeated stands in the same table.
    #[test]
    fn of_one_method_alone() {
        let text = "method,trial,passing\nsieve,,19\ncloud,1,20\nspheres,1,25\ncloud,2,21\n";
        let table = Table::read(text).unwrap();
        let read = |only| grouped_values(&table, "trial", "passing", None, Some(only));
        let found = read(("method", "cloud")).unwrap();
        assert_eq!(found.all.names, ["1", "2"]);
        assert_eq!(found.all.values, [vec![20.0], vec![21.0]]);
        let fault = read(("method", "clouds")).unwrap_err();
        assert_eq!(
            fault.to_string(),
            "no line has 'clouds' in column method; name a text of that column, such as 'sieve'"
        );
        let fault = read(("way", "cloud")).unwrap_err();
        assert!(fault.what.contains("no column 'way'"), "{fault}");
    }

    #[test]
    fn groups_in_the_order_of_the_file() {
        let text = "trial;size;passing\n2;10;20,5\n1;10;21,25\n2;20;50\n1;20;\n2;10;22\n";
        let found = read(text, Some("size")).unwrap();
        assert_eq!(found.all.names, ["2", "1"]);
        assert_eq!(found.all.values, [vec![20.5, 50.0, 22.0], vec![21.25]]);
        assert_eq!(found.by.len(), 2);
        assert_eq!(found.by[0].0, "10");
        assert_eq!(found.by[0].1.values, [vec![20.5, 22.0], vec![21.25]]);
        assert_eq!(found.by[1].1.values, [vec![50.0]]);
        assert!(found.warnings[0].contains("decimal commas"));
        assert!(found.warnings[1].contains("the first is line 5"));
    }

    #[test]
    fn refuses_with_line_and_column() {
        for (text, line, sentence) in [
            (
                "trial,passing\n1,20\n1,many\n",
                Some(3),
                "column passing: 'many'",
            ),
            (
                "trial,passing\n1,20\n,21\n",
                Some(3),
                "a value without its trial",
            ),
            ("round,passing\n1,20\n", Some(1), "no column 'Trial'"),
            ("trial,passing\n1,\n", None, "column passing holds no value"),
        ] {
            let fault = read(text, None).unwrap_err();
            assert_eq!(fault.line, line, "{fault}");
            assert!(fault.to_string().contains(sentence), "{fault}");
        }
    }
}

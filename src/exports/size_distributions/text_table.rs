//! Aligned tables of text, and numbers as people read them.

/// Rows of cells with the first column to the left and the others to the right. A row may be shorter
/// than the others.
pub(super) fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
            line += &match column {
                0 => format!("{cell:<width$}"),
                _ => format!("  {cell:>width$}"),
            };
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}

/// A number with this many significant digits; very small and very large ones with an exponent.
pub(super) fn significant(number: f64, digits: usize) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    // Rounded first: 9.9996 has as many digits before its point as 10.
    let rounded = format!("{number:.*e}", digits.saturating_sub(1));
    let exponent = rounded
        .rsplit_once('e')
        .and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent {
        Some(exponent) if (-4..7).contains(&exponent) => {
            let decimals = i32::try_from(digits).unwrap_or(i32::MAX) - 1 - exponent;
            format!("{number:.*}", usize::try_from(decimals).unwrap_or(0))
        }
        _ => rounded,
    }
}

/// As [`significant`], without zeros at the end of decimals.
pub(super) fn trimmed(number: f64, digits: usize) -> String {
    let text = significant(number, digits);
    if text.contains('e') || !text.contains('.') {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// What is written of a number that there may not be.
pub(super) fn or_dash(number: Option<f64>, write: impl Fn(f64) -> String) -> String {
    number.map_or_else(|| "-".to_owned(), write)
}

/// A number with its sign.
pub(super) fn signed(number: f64, decimals: usize) -> String {
    format!("{number:+.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits() {
        for (number, text) in [
            (0.0, "0"),
            (1255.3, "1255"),
            (12_345.6, "12346"),
            (0.003_363_5, "0.003364"),
            (9.999_96, "10.00"),
            (2.583e-22, "2.583e-22"),
            (1e9, "1.000e9"),
            (-62.764, "-62.76"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(significant(number, 4), text);
        }
        assert_eq!(trimmed(1255.3, 6), "1255.3");
        assert_eq!(trimmed(1200.0, 6), "1200");
        assert_eq!(trimmed(1e12, 6), "1.00000e12");
    }

    #[test]
    fn columns_are_aligned() {
        let rows = [vec!["a", "bb", "c"], vec!["aaa", "b"], vec!["a", "", "ccc"]];
        let rows = rows.map(|row| row.into_iter().map(str::to_owned).collect());
        assert_eq!(aligned(&rows), "a    bb    c\naaa   b\na        ccc\n");
    }
}

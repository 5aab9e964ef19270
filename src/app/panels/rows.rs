//! Rows of a name with its numbers: columns where they fit, else each row goes on in the next line. No
//! number is cut, and nothing makes its panel wider.

use egui::{Label, RichText, TextStyle, Ui, WidgetText};

/// Rows of texts in a panel.
pub(super) struct Rows<'a> {
    /// Tells its grid from others in the panel.
    pub id: &'a str,
    /// What stands over the columns; in a narrow panel before each text of the column.
    pub heads: Option<&'a [&'a str]>,
    /// The texts of each row, the first of them its name.
    pub rows: Vec<Vec<String>>,
}

impl Rows<'_> {
    /// Draws them; `name` draws the first text of a row, which is counted from 0.
    pub(super) fn show(&self, ui: &mut Ui, mut name: impl FnMut(&mut Ui, usize, &str)) {
        if self.fit(ui) {
            self.in_columns(ui, &mut name);
        } else {
            self.in_lines(ui, &mut name);
        }
    }

    fn in_columns(&self, ui: &mut Ui, name: &mut impl FnMut(&mut Ui, usize, &str)) {
        egui::Grid::new(self.id).striped(true).show(ui, |ui| {
            for head in self.heads.into_iter().flatten() {
                ui.weak(*head);
            }
            if self.heads.is_some() {
                ui.end_row();
            }
            for (place, row) in self.rows.iter().enumerate() {
                for (column, text) in row.iter().enumerate() {
                    match column {
                        0 => name(ui, place, text),
                        _ => whole(ui, text),
                    }
                }
                ui.end_row();
            }
        });
    }

    fn in_lines(&self, ui: &mut Ui, name: &mut impl FnMut(&mut Ui, usize, &str)) {
        for (place, row) in self.rows.iter().enumerate() {
            ui.horizontal_wrapped(|ui| {
                for (column, text) in row.iter().enumerate() {
                    let head = self.heads.and_then(|heads| heads.get(column));
                    match (column, head) {
                        (0, _) => name(ui, place, text),
                        (_, Some(head)) => whole(ui, &format!("{head} {text}")),
                        (_, None) => whole(ui, text),
                    }
                }
            });
        }
    }

    /// Whether all columns are as wide as their widest text.
    fn fit(&self, ui: &Ui) -> bool {
        let heads = self.heads.unwrap_or_default();
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let widths = (0..columns).map(|column| {
            let own = self.rows.iter().filter_map(|row| row.get(column));
            let all = own.map(String::as_str).chain(heads.get(column).copied());
            all.map(|text| text_width(ui, text)).fold(0.0, f32::max)
        });
        let between = ui.spacing().item_spacing.x * columns.saturating_sub(1) as f32;
        widths.sum::<f32>() + between <= ui.available_width()
    }
}

/// Rows of a name and what is said of it.
pub(super) fn pairs(id: &str, rows: Vec<(&str, String)>, ui: &mut Ui) {
    let rows = rows.into_iter();
    let rows = rows.map(|(name, said)| vec![name.to_owned(), said]);
    let rows = Rows {
        id,
        heads: None,
        rows: rows.collect(),
    };
    rows.show(ui, |ui, _, name| {
        ui.label(name);
    });
}

/// A text that is not broken, and can be copied.
fn whole(ui: &mut Ui, text: &str) {
    ui.add(Label::new(text).selectable(true).extend());
}

/// How wide a text is on one line, points.
pub(super) fn text_width(ui: &Ui, text: &str) -> f32 {
    let text = WidgetText::from(RichText::new(text));
    let mode = Some(egui::TextWrapMode::Extend);
    let galley = text.into_galley(ui, mode, f32::INFINITY, TextStyle::Body);
    galley.size().x
}

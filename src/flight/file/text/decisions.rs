//! Changing the `[[review]]` tables in the text of a flight.toml.

use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table};

use super::put_in;
use crate::fault::Fault;
use crate::flight::Decision;

/// Replaces the decisions. What was decided before keeps its table as it is written, and of a photo
/// that is decided otherwise what was not changed.
pub(super) fn set_decisions(
    document: &mut DocumentMut,
    old: &[Decision],
    new: &[Decision],
) -> Result<(), Fault> {
    let written = match document.remove("review") {
        None => ArrayOfTables::new(),
        Some(item) => item
            .into_array_of_tables()
            .map_err(|_| Fault::new("review is no list of tables", "write [[review]]"))?,
    };
    let mut tables: Vec<Table> = Vec::new();
    for decision in new {
        let place = old.iter().position(|before| before.photo == decision.photo);
        let before = place.and_then(|place| old.get(place));
        let table = place.and_then(|place| written.get(place)).cloned();
        let mut table = table.unwrap_or_else(Table::new);
        if before.is_none() {
            put_in(&mut table, "photo", decision.photo.as_str());
        }
        if before.is_none_or(|before| before.kind != decision.kind) {
            put_in(&mut table, "decision", decision.kind.as_str());
        }
        if before.map_or("", |before| &before.note) != decision.note {
            match decision.note.is_empty() {
                true => drop(table.remove("note")),
                false => put_in(&mut table, "note", decision.note.as_str()),
            }
        }
        if before.and_then(|before| before.date) != decision.date {
            match decision.date {
                None => drop(table.remove("date")),
                Some(date) => put_in(&mut table, "date", date.to_string()),
            }
        }
        if before.and_then(|before| before.reasons.as_ref()) != decision.reasons.as_ref() {
            match &decision.reasons {
                None => drop(table.remove("reasons")),
                Some(kinds) => {
                    let kinds: Array = kinds.iter().map(String::as_str).collect();
                    put_in(&mut table, "reasons", kinds);
                }
            }
        }
        tables.push(table);
    }
    // Tables are written by the places that they had in the text. Where that is another order than is
    // wanted now, all of them go to its end.
    let before: Vec<Option<isize>> = tables.iter().map(Table::position).collect();
    let last = before
        .iter()
        .rposition(Option::is_some)
        .map_or(0, |last| last + 1);
    let kept = before.get(..last).unwrap_or_default();
    if !kept.iter().all(Option::is_some) || !kept.is_sorted() {
        tables.iter_mut().for_each(|table| table.set_position(None));
    }
    if !tables.is_empty() {
        let tables = tables.into_iter().collect();
        document.insert("review", Item::ArrayOfTables(tables));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::flight::{Decision, DecisionKind, Doubt, FlightFile};

    const REVIEWED: &str = r#"format = 1
[world]
unit = "m"
[surface]
file = "pile.ply"
[photos]
poses = "poses.csv"

# Seen from the crest.
[[review]]
photo = "a.jpg"
decision = "accepted"   # by A. B.
note = "the toe is flat"
date = "2026-11-22"
reasons = ["flat-view"]

[[review]]
photo = "b.jpg"
decision = "left-out"
"#;

    #[test]
    fn decisions_are_read() {
        let settings = FlightFile::parse(REVIEWED).unwrap().settings();
        let flat = Doubt::FlatView {
            angle: 25.0,
            limit: 30.0,
        };
        let mut accepted = Decision::new("a.jpg", DecisionKind::Accepted, &[flat]);
        accepted.note = "the toe is flat".to_owned();
        accepted.date = "2026-11-22".parse().ok();
        let left_out = Decision::new("b.jpg", DecisionKind::LeftOut, &[]);
        assert_eq!(settings.decisions, [accepted, left_out]);
    }

    #[test]
    fn mistakes_are_placed() {
        for (from, to, line, said) in [
            (
                "\"b.jpg\"",
                "\"a.jpg\"",
                18,
                "photo 'a.jpg' has two [[review]] tables; keep the one that holds",
            ),
            (
                "\"b.jpg\"",
                "\"\"",
                18,
                "review.photo is empty; name the photo",
            ),
            (
                "2026-11-22",
                "2026-02-30",
                14,
                "review.date is '2026-02-30', no day of the calendar; write year-month-day, like \"2026-11-22\"",
            ),
            (
                "left-out",
                "left out",
                19,
                "unknown variant `left out`, expected `accepted` or `left-out`; see the flight file's format in docs/flights.md",
            ),
            (
                "note =",
                "notes =",
                13,
                "unknown key 'notes' in [review]; did you mean 'note'?",
            ),
            (
                "\"flat-view\"",
                "\"flat_view\"",
                15,
                "review.reasons has 'flat_view', which is no reason for doubt; did you mean 'flat-view'?",
            ),
            (
                "decision = \"left-out\"\n",
                "",
                17,
                "missing field `decision`; see the flight file's format in docs/flights.md",
            ),
            (
                "[[review]]\nphoto = \"b",
                "[[reviews]]\nphoto = \"b",
                17,
                "unknown key 'reviews'; did you mean 'review'?",
            ),
        ] {
            assert!(REVIEWED.contains(from), "{from}");
            let fault = FlightFile::parse(&REVIEWED.replace(from, to)).unwrap_err();
            assert_eq!(fault.to_string(), said);
            assert_eq!(fault.line, Some(line), "{fault}");
        }
    }

    #[test]
    fn what_is_not_changed_stays_as_it_is_written() {
        let mut settings = FlightFile::parse(REVIEWED).unwrap().settings();
        assert_eq!(
            FlightFile::text_with_settings(REVIEWED, &settings).unwrap(),
            REVIEWED
        );
        let mut first = settings.decisions[0].clone();
        first.kind = DecisionKind::LeftOut;
        first.reasons = None;
        first.note = "blurred".to_owned();
        settings.decide("a.jpg", Some(first));
        settings.decide("b.jpg", None);
        let third = Decision::new("c.jpg", DecisionKind::LeftOut, &[]);
        settings.decide("c.jpg", Some(third));
        let text = FlightFile::text_with_settings(REVIEWED, &settings).unwrap();
        let expected = REVIEWED
            .replace("\"accepted\"   # by", "\"left-out\"   # by")
            .replace("the toe is flat", "blurred")
            .replace("reasons = [\"flat-view\"]\n", "")
            .replace("b.jpg", "c.jpg");
        assert_eq!(text, expected);
        settings.decisions.clear();
        let text = FlightFile::text_with_settings(&text, &settings).unwrap();
        assert!(!text.contains("review"), "{text}");
    }
}

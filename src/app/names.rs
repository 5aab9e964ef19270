//! Names and lines that may be longer than the place for them: cut in the middle, because photos differ at
//! their names' ends, with the whole of it in the hover text. And numbers, which are never cut.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use egui::{FontId, Galley, Label, Response, RichText, TextStyle, Ui, WidgetInfo, WidgetText};

/// What stands for the middle.
const DOTS: char = '…';

/// A hover text is cut after so many characters: it has to fit on the screen.
const LONGEST_HOVER: usize = 2000;

/// Draws a name in what is left of the row.
pub(crate) fn name(ui: &mut Ui, text: &str) -> Response {
    styled(ui, text, TextStyle::Body, |text| text)
}

/// The same with another style, and dressed: strong, weak, coloured.
pub(crate) fn styled(
    ui: &mut Ui,
    text: &str,
    style: TextStyle,
    dress: impl FnOnce(RichText) -> RichText,
) -> Response {
    let font = style.resolve(ui.style());
    let width = ui.available_width();
    let shown = fitted(ui, text, &font, width);
    let is_cut = matches!(shown, Cow::Owned(_));
    let label = Label::new(dress(RichText::new(&*shown).text_style(style)));
    // In a row of the table clicks belong to the row.
    let response = ui.add(label.selectable(false).extend());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, text));
    match is_cut {
        true => response.on_hover_text(text.chars().take(LONGEST_HOVER).collect::<String>()),
        false => response,
    }
}

/// A text for a button or a field, cut to this many points.
pub(crate) fn fitted<'a>(ui: &Ui, text: &'a str, font: &FontId, width: f32) -> Cow<'a, str> {
    // Nothing is wider than its place by more than this, and whole words of a paragraph are none.
    let most = 4000;
    let is_one_line = !text.contains('\n') && text.len() <= most;
    let measure = |text: &str| {
        let font = font.clone();
        let color = egui::Color32::PLACEHOLDER;
        let galley = ui.painter().layout_no_wrap(text.to_owned(), font, color);
        galley.size().x
    };
    if is_one_line && measure(text) <= width {
        return Cow::Borrowed(text);
    }
    let letters: Vec<char> = text
        .chars()
        .map(|letter| if letter == '\n' { ' ' } else { letter })
        .collect();
    // At most a few hundred letters fit anywhere: the middle of a longer text is not measured.
    let (mut fits, mut too_many) = (0, letters.len().min(1000));
    while too_many - fits > 1 {
        let middle = fits.midpoint(too_many);
        match measure(&cut(&letters, middle)) <= width {
            true => fits = middle,
            false => too_many = middle,
        }
    }
    Cow::Owned(cut(&letters, fits))
}

/// The first and last letters, `keep` of them at most, with dots between them. No number is cut through:
/// half of one would be read as another. The number at the cut belongs to the end, which tells photos apart,
/// where there is room for it.
fn cut(letters: &[char], keep: usize) -> String {
    let keep = keep.min(letters.len());
    let (mut head, mut tail) = (keep / 2, keep - keep / 2);
    let of_number = |at: usize| letters.get(at).is_some_and(char::is_ascii_digit);
    let joins = |at: usize| {
        let sign = |at: usize| letters.get(at).is_some_and(|c| ".,-+".contains(*c));
        of_number(at)
            || (sign(at) && (of_number(at + 1) || at.checked_sub(1).is_some_and(of_number)))
    };
    let whole = |at: usize| at == 0 || !(joins(at - 1) && joins(at));
    let begin = |tail: usize| letters.len() - tail;
    let with_number = (tail..=keep).find(|tail| whole(begin(*tail)));
    if let Some(longer) = with_number {
        (head, tail) = (keep - longer, longer);
    }
    if let Some(number) = number_of_file(letters).filter(|number| whole(number.start)) {
        let from_number = letters.len() - number.start;
        if (tail..=keep).contains(&from_number) {
            (head, tail) = (keep - from_number, from_number);
        } else if tail < from_number && number.len() <= keep {
            // Every photo ends in "jpg".
            let number = letters[number].iter();
            return [&DOTS].into_iter().chain(number).chain([&DOTS]).collect();
        }
    }
    while head > 0 && !whole(head) {
        head -= 1;
    }
    while tail > 0 && !whole(begin(tail)) {
        tail -= 1;
    }
    let head = letters[..head].iter();
    let tail = letters[begin(tail)..].iter();
    head.chain([&DOTS]).chain(tail).collect()
}

/// The last number in the name of a file, before its ending: what tells photos apart.
fn number_of_file(letters: &[char]) -> Option<Range<usize>> {
    let dot = letters.iter().rposition(|letter| *letter == '.')?;
    let (name, ending) = (&letters[..dot], &letters[dot + 1..]);
    let is_file = (3..=4).contains(&ending.len()) && ending.iter().all(|c| c.is_ascii_alphabetic());
    let last = name.iter().rposition(char::is_ascii_digit)?;
    let before = name[..last].iter().rposition(|c| !c.is_ascii_digit());
    is_file.then_some(before.map_or(0, |before| before + 1)..last + 1)
}

/// What stands behind numbers, apart from what begins with "px/".
const UNITS: [&str; 17] = [
    "mm", "cm", "m", "in", "ft", "us-ft", "px", "mm²", "cm²", "m²", "in²", "ft²", "m³", "ft³",
    "ha", "min", "h",
];

/// Whether a word is the unit of a number before it, whatever sign of the sentence is behind it.
fn is_unit(word: &str) -> bool {
    let word = word.trim_end_matches([',', '.', ';', ':', ')']);
    word.starts_with("px/") || UNITS.contains(&word)
}

/// The text with each number, its unit, its interval and its per cent sign on one line, wherever the text is broken:
/// "19.9 ±" at the end of a row is no number, nor is "± 0.4" at the begin of the next.
pub(crate) fn unbroken(text: &str) -> String {
    let begins_with_number = |word: &str| {
        let digits = word.trim_start_matches(['(', '-', '−', '+']);
        digits.starts_with(|c: char| c.is_ascii_digit())
    };
    let words: Vec<&str> = text.split(' ').collect();
    let mut whole = String::with_capacity(text.len() + 8);
    for (place, word) in words.iter().enumerate() {
        whole.push_str(word);
        let Some(next) = words.get(place + 1) else {
            break;
        };
        let opens = |word: &str| word.starts_with('(') && begins_with_number(word);
        // "19.9 (19.2 to 20.3)": an interval whose sides are not alike.
        let is_interval = begins_with_number(word) && opens(next)
            || opens(word) && *next == "to"
            || *word == "to" && place > 0 && opens(words[place - 1]);
        let number = word.trim_start_matches(['(', '±', '−']);
        let has_unit = is_unit(next) && number.parse::<f64>().is_ok();
        let is_joined = next.starts_with(['±', '%']) || *word == "±" || is_interval || has_unit;
        whole.push(if is_joined { '\u{a0}' } else { ' ' });
    }
    whole
}

/// Draws a text with numbers in what is left of a cell or row, whole; where it would be cut by its column
/// or by the panel's edge, dots stand for it. `text` is in the hover text then.
pub(crate) fn whole_number(ui: &mut Ui, text: impl Into<RichText>, selectable: bool) -> Response {
    let text: RichText = text.into();
    let mode = Some(egui::TextWrapMode::Extend);
    let text = WidgetText::from(text).into_galley(ui, mode, f32::INFINITY, TextStyle::Body);
    whole(ui, text, selectable)
}

/// The same of a text that is laid out already, perhaps in several rows.
pub(crate) fn whole(ui: &mut Ui, text: Arc<Galley>, selectable: bool) -> Response {
    let sight = ui.clip_rect();
    let left = ui.cursor().left().max(ui.max_rect().left());
    let right = left + text.size().x;
    // Beyond the edge nothing is seen of it.
    let is_whole = right <= sight.right() + 0.1 && left >= sight.left() - 0.1;
    let is_hidden = left >= sight.right() || right <= sight.left();
    if is_whole || is_hidden {
        return ui.add(Label::new(text).selectable(selectable));
    }
    let (place, response) = ui.allocate_exact_size(text.size(), egui::Sense::hover());
    let seen = place.intersect(sight);
    let (at, anchor) = match left < sight.left() {
        true => (seen.right_center(), egui::Align2::RIGHT_CENTER),
        false => (seen.left_center(), egui::Align2::LEFT_CENTER),
    };
    let font = TextStyle::Body.resolve(ui.style());
    let color = ui.visuals().weak_text_color();
    ui.painter().text(at, anchor, DOTS, font, color);
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, text.text()));
    response.on_hover_text(text.text())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut_to(text: &str, keep: usize) -> String {
        cut(&text.chars().collect::<Vec<_>>(), keep)
    }

    #[test]
    fn numbers_and_their_intervals_are_not_parted() {
        for (text, whole) in [
            ("top 19.9 ± 0.4, 2 %", "top 19.9~±~0.4, 2~%"),
            ("19.9 (19.2 to 20.3) px/cm", "19.9~(19.2~to~20.3) px/cm"),
            (
                "from 2 to 3 photos (9 of 12)",
                "from 2 to 3 photos (9 of 12)",
            ),
            ("P80 ± 2 %; less", "P80~±~2~%; less"),
            (
                "an edge of 0.012 m, 3 in all",
                "an edge of 0.012~m, 3~in all",
            ),
            ("TOP  50 cm · 25.6 px/cm", "TOP  50~cm · 25.6~px/cm"),
            ("2 marks of m", "2 marks of m"),
            ("", ""),
        ] {
            assert_eq!(unbroken(text), whole.replace('~', "\u{a0}"));
        }
    }

    #[test]
    fn the_middle_is_cut_and_no_number_through() {
        assert_eq!(cut_to("abcdefghij", 4), "ab…ij");
        assert_eq!(cut_to("abcdefghij", 5), "ab…hij");
        assert_eq!(cut_to("abcdefghij", 0), "…");
        // A half of 2024 or of 18.268 is another number.
        assert_eq!(cut_to("flight 20240506 north", 18), "flig…20240506 north");
        assert_eq!(cut_to("flight 20240506 north", 13), "flight… north");
        assert_eq!(cut_to("ab 18.268 px", 9), "…18.268 px");
        assert_eq!(cut_to("ab 18.268 px", 10), "a…18.268 px");
        assert_eq!(cut_to("ab 18.268 px", 7), "ab … px");
        // Photos of one folder.
        assert_eq!(cut_to("images/100_7103.JPG", 12), "imag…7103.JPG");
        assert_eq!(cut_to("12345678", 4), "…");
        // They all end in their ending: the number before it is what is wanted.
        assert_eq!(cut_to("IMG_0123.jpg", 9), "I…0123.jpg");
        assert_eq!(cut_to("IMG_0123.jpg", 8), "…0123.jpg");
        assert_eq!(cut_to("IMG_0123.jpg", 6), "…0123…");
        assert_eq!(cut_to("IMG_0123.jpg", 3), "I…pg");
        // That is half a number.
        assert_eq!(cut_to("x-7.25.jpg", 5), "x…jpg");
        assert_eq!(cut_to("DJI_20240506_0042_V.JPG", 12), "DJ…0042_V.JPG");
        // Letters of any script are letters.
        assert_eq!(cut_to("矿石爆破照片", 4), "矿石…照片");
        assert_eq!(cut_to("фотография", 4), "фо…ия");
    }

    /// In egui's own font: it fits, it is as long as fits, and short names stay.
    #[test]
    fn what_is_cut_fits() {
        let context = egui::Context::default();
        let long = "DJI_flight_over_the_north_face_".repeat(9) + "0042.JPG";
        let mut output = context.run_ui(egui::RawInput::default(), |ui| {
            let font = TextStyle::Body.resolve(ui.style());
            let width = |text: &str| {
                let color = egui::Color32::WHITE;
                let text = text.to_owned();
                ui.painter()
                    .layout_no_wrap(text, font.clone(), color)
                    .size()
                    .x
            };
            for place in [30.0, 80.0, 200.0, 777.0] {
                let shown = fitted(ui, &long, &font, place);
                assert!(width(&shown) <= place, "{shown}");
                assert!(width(&shown) > place - 45.0, "{shown} in {place}");
                assert!(place < 80.0 || shown.ends_with("JPG"), "{shown}");
            }
            assert_eq!(fitted(ui, "IMG_1.jpg", &font, 200.0), "IMG_1.jpg");
        });
        output.textures_delta.clear();
    }
}

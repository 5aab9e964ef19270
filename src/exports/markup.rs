//! Text for HTML and XML.

/// Text for an element or an attribute.
pub(super) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c if has_no_place(c) => safe.push(' '),
            c => safe.push(c),
        }
    }
    safe
}

/// Text without what XML has no place for, not even escaped; for those who escape themselves.
pub(super) fn printable(text: &str) -> String {
    text.replace(has_no_place, " ")
}

/// XML 1.0, section 2.2; of the control characters it has tab and line ends, which are white space here.
fn has_no_place(c: char) -> bool {
    c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_from_outside_becomes_markup() {
        let nasty = "<script>alert(\"1\" & '2')</script>\u{0}\u{ffff}";
        assert_eq!(
            escaped(nasty),
            "&lt;script&gt;alert(&quot;1&quot; &amp; &#39;2&#39;)&lt;/script&gt;  "
        );
        assert_eq!(printable("a\nb\u{fffe}<"), "a b <");
    }
}

//! XML with one element a line, in the order in which it is written.

use crate::markup::escaped;

/// A document that grows.
pub(super) struct Xml {
    text: String,
    open: Vec<&'static str>,
}

impl Xml {
    /// The declaration and what follows it.
    pub(super) fn new(root: &'static str, attributes: &str) -> Self {
        let mut xml = Self {
            text: String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"),
            open: Vec::new(),
        };
        xml.text += &format!("<{root} {attributes}>\n");
        xml.open.push(root);
        xml
    }

    /// An element with text in it.
    pub(super) fn leaf(&mut self, name: &str, text: impl std::fmt::Display) {
        self.indent();
        let text = escaped(&text.to_string());
        self.text += &format!("<{name}>{text}</{name}>\n");
    }

    /// An element with the elements that `fill` writes.
    pub(super) fn element(&mut self, name: &'static str, fill: impl FnOnce(&mut Self)) {
        self.indent();
        self.text += &format!("<{name}>\n");
        self.open.push(name);
        fill(self);
        self.close();
    }

    /// The whole document.
    pub(super) fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        self.text
    }

    fn close(&mut self) {
        if let Some(name) = self.open.pop() {
            self.indent();
            self.text += &format!("</{name}>\n");
        }
    }

    fn indent(&mut self) {
        self.text += &"  ".repeat(self.open.len());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_nest_and_text_is_escaped() {
        let mut xml = Xml::new("a", "x='1'");
        xml.element("b", |xml| xml.leaf("c", "1 < 2"));
        let expected = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<a x='1'>\n  <b>\n    <c>1 &lt; 2</c>\n  </b>\n</a>\n";
        assert_eq!(xml.finish(), expected);
    }
}

//! What readers of text share: fields and lines with their places, JSON, XML, separators, notes.

pub(crate) mod fields;
pub(crate) mod json;
pub(crate) mod notes;
pub(crate) mod separated;
pub(crate) mod text_lines;
pub(crate) mod xml_document;

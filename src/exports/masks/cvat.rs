//! "CVAT for images 1.1" for all photos (docs.cvat.ai, "XML annotation format"): a mask for each fragment, as its runs row
//! by row through its box. Its number is its group. CVAT reads masks from version 2.3 on.

use super::boxes::{boxes, counts};
use super::{FRAGMENT, NOT_ROCK_NAME};
use crate::delineation::{LabelImage, NOT_ROCK};
use crate::files::SVG_MARK;
use crate::markup::escaped;

/// The outlines of photos, one photo after the other.
#[derive(Debug, Default)]
pub struct CvatFile {
    images: String,
    count: usize,
}

impl CvatFile {
    /// Adds a photo, by its file name.
    pub fn add(&mut self, photo: &str, labels: &LabelImage) {
        let LabelImage { width, height, .. } = labels;
        self.images += &format!(
            "  <image id=\"{}\" name=\"{}\" width=\"{width}\" height=\"{height}\">\n",
            self.count,
            escaped(photo)
        );
        self.count += 1;
        for (label, of) in boxes(labels) {
            let (name, group) = match label {
                NOT_ROCK => (NOT_ROCK_NAME, 0),
                label => (FRAGMENT, label),
            };
            let rows = of.top..of.top + of.height;
            let places =
                rows.flat_map(|y| (of.left..of.left + of.width).map(move |x| y * width + x));
            let counts: Vec<String> = counts(labels, label, places)
                .iter()
                .map(u32::to_string)
                .collect();
            self.images += &format!(
                "    <mask label=\"{name}\" source=\"file\" occluded=\"0\" rle=\"{}\" left=\"{}\" top=\"{}\" width=\"{}\" height=\"{}\" z_order=\"0\" group_id=\"{group}\">\n    </mask>\n",
                counts.join(", "),
                of.left,
                of.top,
                of.width,
                of.height,
            );
        }
        self.images += "  </image>\n";
    }

    /// The text of the file.
    pub fn text(&self) -> String {
        let labels: String = [FRAGMENT, NOT_ROCK_NAME]
            .map(|name| format!("        <label>\n          <name>{name}</name>\n          <type>any</type>\n          <attributes>\n          </attributes>\n        </label>\n"))
            .concat();
        format!(
            "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n{SVG_MARK}<annotations>\n  <version>1.1</version>\n  <meta>\n    <task>\n      <name>fragments</name>\n      <size>{}</size>\n      <mode>annotation</mode>\n      <labels>\n{labels}      </labels>\n    </task>\n  </meta>\n{}</annotations>\n",
            self.count, self.images
        )
    }
}

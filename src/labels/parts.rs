//! The parts of a label image: pixels of one label that touch by their sides.

use super::LabelImage;

impl LabelImage {
    /// The part of each pixel, from 0 in the order of their first pixels, and the label of each part.
    pub fn parts(&self) -> (Vec<u32>, Vec<u32>) {
        const NONE: u32 = u32::MAX;
        let (width, height) = (self.width, self.height);
        let mut part_of = vec![NONE; self.labels.len()];
        let mut labels = Vec::new();
        let mut open = Vec::new();
        for start in 0..part_of.len() {
            if part_of[start] != NONE {
                continue;
            }
            // There are no more of them than pixels.
            let number = labels.len() as u32;
            let label = self.labels[start];
            labels.push(label);
            part_of[start] = number;
            open.push(start);
            while let Some(at) = open.pop() {
                let (x, y) = (at % width, at / width);
                let beside = [
                    (x > 0).then(|| at - 1),
                    (x + 1 < width).then_some(at + 1),
                    (y > 0).then(|| at - width),
                    (y + 1 < height).then_some(at + width),
                ];
                for next in beside.into_iter().flatten() {
                    if part_of[next] == NONE && self.labels[next] == label {
                        part_of[next] = number;
                        open.push(next);
                    }
                }
            }
        }
        (part_of, labels)
    }
}

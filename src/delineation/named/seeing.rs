//! How a photo is put before the model: in which sizes, in which parts.

use fragscale_core::fault::{Fault, one_line};
use fragscale_core::jobs::Progress;
use image::RgbImage;
use rten::{NodeId, Value, ValueOrView};

use super::NamedModel;
use super::outputs::Numbers;
use crate::network::{self, Part, Parts};

impl NamedModel {
    /// How many times smaller a photo is looked at, the least first.
    pub(super) fn sizes(&self, width: u32, height: u32) -> Vec<f64> {
        if self.description.input.whole {
            let fits = |side: u32, part: usize| f64::from(side) / part as f64;
            let by = fits(width, self.parts.part[0]).max(fits(height, self.parts.part[1]));
            return vec![by.max(1.0)];
        }
        let sizes = self.description.input.sizes.clone();
        sizes.unwrap_or_else(|| vec![1.0])
    }

    /// The given outputs of each part of a photo in one size, one part after the other; `take` is told which of how many
    /// it is.
    pub(super) fn see(
        &self,
        photo: &RgbImage,
        outputs: &[NodeId],
        progress: &Progress,
        mut take: impl FnMut(&Part, [usize; 2], &[Value]) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let (width, height) = (photo.width() as usize, photo.height() as usize);
        let parts = self.whole_or_parts(width, height);
        let normals = self.input.normals(photo);
        for (number, part) in parts.iter().enumerate() {
            progress.advance(number as u64, parts.len() as u64)?;
            let tensor = self.input.tensor(photo, part, &normals);
            let tensor = tensor.ok_or_else(|| self.wrong("takes no such picture".to_owned()))?;
            let inputs = vec![(self.input_id, ValueOrView::from(tensor))];
            let values = network::run(&self.model, inputs, outputs).map_err(|error| {
                let of = format!("{} x {} pixels", part.columns, part.rows);
                self.wrong(format!("fails on {of} ({})", one_line(&error)))
            })?;
            take(part, [number, parts.len()], &values)?;
        }
        Ok(())
    }

    /// What the description's outputs say of each part.
    pub(super) fn see_numbers(
        &self,
        photo: &RgbImage,
        progress: &Progress,
        mut take: impl FnMut(&Part, &[Numbers]) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        // Each once: two entries may be channels of one output.
        let mut ids = self.outputs.clone();
        ids.sort_unstable();
        ids.dedup();
        self.see(photo, &ids, progress, |part, _, values| {
            let numbers = self.entries().map(|(entry, id)| {
                let place = ids.binary_search(&id).ok();
                let value = place.and_then(|place| values.get(place));
                value
                    .and_then(Numbers::of)
                    .ok_or_else(|| self.wrong(format!("gives no numbers for {}", entry.is.word())))
            });
            let numbers: Vec<Numbers> = numbers.collect::<Result<_, _>>()?;
            take(part, &numbers)
        })
    }

    /// A photo that is looked at whole is one part, whatever its shape is.
    fn whole_or_parts(&self, width: usize, height: usize) -> Vec<Part> {
        let parts = match self.description.input.whole {
            true => Parts {
                margin: 0,
                ..self.parts
            },
            false => self.parts,
        };
        parts.of(width, height)
    }
}

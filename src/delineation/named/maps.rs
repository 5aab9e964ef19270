//! The evidence of a model that gives maps.

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use image::RgbImage;

use super::NamedModel;
use super::description::Meaning;
use crate::evidence::{Evidence, gray};
use crate::network::{self, Layout};

/// The evidence's kinds, in the order in which they are kept.
const KINDS: [Meaning; 4] = [
    Meaning::Border,
    Meaning::Inside,
    Meaning::Middle,
    Meaning::Fines,
];

impl NamedModel {
    /// The maps of a photo in one size, those of [`KINDS`] that it gives.
    fn maps(&self, photo: &RgbImage, progress: &Progress) -> Result<Vec<Vec<f32>>, Fault> {
        let (width, height) = (photo.width() as usize, photo.height() as usize);
        let kinds: Vec<Meaning> = self.kinds().collect();
        let mut maps = vec![vec![0.0; width * height]; kinds.len()];
        self.see_numbers(photo, progress, |part, numbers| {
            for (entry, of) in self.description.output.iter().zip(numbers) {
                let seen = [part.columns, part.rows];
                let pictures = of
                    .pictures(self.input.layout == Layout::ChannelsLast, seen)
                    .filter(|pictures| entry.channel < pictures.count)
                    .ok_or_else(|| self.wrong_shape(entry.is, of, part))?;
                self.check_chances(entry, entry.channel, of, &pictures)?;
                let chances = of.chances(&pictures, entry.channel, entry.values);
                let from = (pictures.columns, pictures.rows);
                let chances = match from == (part.columns, part.rows) {
                    true => chances,
                    false => network::enlarged_part(&chances, from, (part.columns, part.rows)),
                };
                let map = kinds.iter().position(|kind| *kind == entry.is);
                let Some(map) = map.and_then(|kind| maps.get_mut(kind)) else {
                    continue;
                };
                for y in part.top..part.bottom {
                    let row = &chances[(y - part.above) * part.columns..][..part.columns];
                    let row = &row[part.left - part.first..part.right - part.first];
                    map[y * width + part.left..][..row.len()].copy_from_slice(row);
                }
            }
            Ok(())
        })?;
        Ok(maps)
    }

    fn kinds(&self) -> impl Iterator<Item = Meaning> {
        KINDS.into_iter().filter(|kind| self.gives(*kind))
    }

    pub(super) fn evidence(
        &self,
        photo: &RgbImage,
        progress: &Progress,
    ) -> Result<Evidence, Fault> {
        let (width, height) = photo.dimensions();
        let sizes = self.sizes(width, height);
        let means = network::mean_of_sizes(photo, &sizes, progress, |photo, progress| {
            self.maps(photo, progress)
        })?;
        let kinds: Vec<Meaning> = self.kinds().collect();
        let mean = |kind: Meaning| means.get(kinds.iter().position(|own| *own == kind)?);
        let bytes = |chance: f32| (255.0 * chance).round() as u8;
        let pixels = width as usize * height as usize;
        let of =
            |kind| mean(kind).map(|mean| -> Vec<u8> { mean.iter().map(|of| bytes(*of)).collect() });
        let mut rock = of(Meaning::Inside).unwrap_or_else(|| vec![255; pixels]);
        if let Some(fines) = mean(Meaning::Fines) {
            for (rock, fines) in rock.iter_mut().zip(fines) {
                *rock = (*rock).min(bytes(1.0 - fines));
            }
        }
        let border = of(Meaning::Border);
        let border = border.unwrap_or_else(|| rock.iter().map(|rock| 255 - rock).collect());
        Ok(Evidence {
            width: width as usize,
            height: height as usize,
            border,
            rock,
            middle: of(Meaning::Middle).unwrap_or_else(|| vec![0; pixels]),
            gray: gray(photo),
            votes: None,
        })
    }
}

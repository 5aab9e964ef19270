//! The outlines of a model that gives instances, all at once or where it is asked.

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use image::RgbImage;

use super::NamedModel;
use super::description::Meaning;
use super::instances::{Instance, Instances, Seen};
use super::outputs::{Mask, Numbers, of_detections, of_labels};
use super::prompted::{Prompted, SeenAt};
use crate::engine::{Engine, Outlined};
use crate::network::{self, Layout, Part};

impl NamedModel {
    pub(super) fn instances(
        &self,
        photo: &RgbImage,
        progress: &Progress,
    ) -> Result<Outlined, Fault> {
        let full = [photo.width() as usize, photo.height() as usize];
        let mut all = Instances::default();
        match &self.prompted {
            Some(prompted) => self.ask(prompted, photo, &mut all, progress)?,
            None => self.find(photo, &mut all, progress)?,
        }
        let (labels, sure) = all.painted(full[0], full[1]);
        Ok(Outlined { labels, sure })
    }

    /// What the model gives one by one.
    fn find(
        &self,
        photo: &RgbImage,
        all: &mut Instances,
        progress: &Progress,
    ) -> Result<(), Fault> {
        let full = [photo.width() as usize, photo.height() as usize];
        for by in self.sizes(photo.width(), photo.height()) {
            let sized = network::at_size(photo, by);
            let size = [sized.width() as usize, sized.height() as usize];
            self.see_numbers(&sized, progress, |part, numbers| {
                let seen = Seen { part, size, full };
                let masks = self.masks(part, numbers)?;
                for mask in masks.filter(|mask| mask.score >= self.least_score()) {
                    let mask = mask.enlarged([part.columns, part.rows]);
                    if let Some(instance) = seen.instance(&mask) {
                        self.add(all, instance, full)?;
                    }
                }
                Ok(())
            })?;
        }
        Ok(())
    }

    /// What the model answers where it is asked.
    fn ask(
        &self,
        prompted: &Prompted,
        photo: &RgbImage,
        all: &mut Instances,
        progress: &Progress,
    ) -> Result<(), Fault> {
        let full = [photo.width() as usize, photo.height() as usize];
        let places = prompted.places(photo, progress)?;
        let sizes = self.sizes(photo.width(), photo.height());
        let least = self.least_score();
        let (mut asked, mut best) = (0, f64::NEG_INFINITY);
        for (number, by) in sizes.iter().enumerate() {
            let sized = network::at_size(photo, *by);
            let size = [sized.width() as usize, sized.height() as usize];
            self.see(
                &sized,
                prompted.decoder.takes(),
                progress,
                |part, [nth, parts], values| {
                    let seen = Seen { part, size, full };
                    let at = SeenAt {
                        part,
                        size,
                        sizes: &sizes,
                        number,
                    };
                    let places = places.in_part(at);
                    let sides = [part.columns, part.rows];
                    let count = places.len().max(1);
                    let told = |asked: usize| {
                        let done = nth * count + asked;
                        progress.advance(done as u64, (parts * count) as u64)
                    };
                    let decoder = &prompted.decoder;
                    asked += places.len();
                    decoder.ask(values, &places, sides, told, |mask| {
                        best = best.max(mask.score);
                        if mask.score < least {
                            return Ok(());
                        }
                        match seen.instance(&mask.enlarged(sides)) {
                            // Many places lie in one fragment.
                            Some(instance) if !all.has_surer(&instance) => {
                                self.add(all, instance, full)
                            }
                            _ => Ok(()),
                        }
                    })
                },
            )?;
        }
        all.leave_out_heaps();
        match asked > 0 && all.is_empty() {
            true => Err(self.found_nothing(asked, best)),
            false => Ok(()),
        }
    }

    /// Of a model that was asked at some places, and whose best score was this.
    fn found_nothing(&self, asked: usize, best: f64) -> Fault {
        let least = self.least_score();
        let trained = "whether mean, std and white are those that it was trained with";
        let (what, remedy) = if best >= least {
            (
                " gave no mask that lies whole in a tile and is one fragment".to_owned(),
                format!(
                    "give a larger margin or more sizes in its description, and look {trained}"
                ),
            )
        } else {
            let best = match best.is_finite() {
                true => format!("its best score is {best:.2}, and least_score {least}"),
                false => "none of its scores is a number".to_owned(),
            };
            (
                format!(" is sure of none: {best}"),
                format!("set least_score lower in its description, or look {trained}"),
            )
        };
        let name = &self.name;
        Fault::new(
            format!("the network {name}, asked at {asked} places,{what}"),
            remedy,
        )
    }

    fn add(
        &self,
        all: &mut Instances,
        instance: Instance,
        [width, height]: [usize; 2],
    ) -> Result<(), Fault> {
        match all.add(instance, width * height) {
            true => Ok(()),
            false => Err(self.wrong("covers the photo with too many masks".to_owned())),
        }
    }

    /// The masks of a part.
    fn masks<'a>(
        &'a self,
        part: &Part,
        numbers: &'a [Numbers],
    ) -> Result<Box<dyn Iterator<Item = Mask> + 'a>, Fault> {
        let of = |meaning: Meaning| {
            let all = self.description.output.iter().zip(numbers);
            let mut all = all.filter(|(entry, _)| entry.is == meaning);
            all.next()
        };
        let seen = [part.columns, part.rows];
        if let Some((entry, labels)) = of(Meaning::Labels) {
            let pictures = labels
                .pictures(self.input.layout == Layout::ChannelsLast, seen)
                .filter(|pictures| entry.channel < pictures.count);
            let pictures = pictures.ok_or_else(|| self.wrong_shape(entry.is, labels, part))?;
            let masks = of_labels(labels, &pictures, entry.channel);
            return Ok(Box::new(masks.into_iter()));
        }
        if let (Some((_, detections)), Some((_, prototypes))) =
            (of(Meaning::Detections), of(Meaning::Prototypes))
        {
            let least = self.least_score();
            let masks = of_detections(detections, prototypes, seen, least);
            let masks = masks.ok_or_else(|| {
                let (one, other) = (detections.words(), prototypes.words());
                self.wrong(format!(
                    "gives detections of {one} with prototypes of {other}"
                ))
            })?;
            return Ok(Box::new(masks));
        }
        let Some((entry, masks)) = of(Meaning::Masks) else {
            return Ok(Box::new(std::iter::empty()));
        };
        let pictures = masks.pictures(false, seen);
        let pictures = pictures.ok_or_else(|| self.wrong_shape(entry.is, masks, part))?;
        let scores = of(Meaning::Scores).map(|(_, scores)| scores);
        if let Some(scores) = scores.filter(|scores| scores.values.len() != pictures.count) {
            let what = format!(
                "gives {} masks and scores of {}",
                pictures.count,
                scores.words()
            );
            return Err(self.wrong(what));
        }
        let values = entry.values;
        for number in 0..pictures.count {
            self.check_chances(entry, number, masks, &pictures)?;
        }
        Ok(Box::new((0..pictures.count).map(move |number| {
            let score = scores.and_then(|scores| scores.values.get(number));
            Mask {
                of: [pictures.columns, pictures.rows],
                columns: 0..pictures.columns,
                rows: 0..pictures.rows,
                chances: masks.chances(&pictures, number, values),
                score: score.map_or(1.0, |score| f64::from(*score)),
            }
        })))
    }
}

//! Any network that the user names: an ONNX model with a description of what it takes and gives (`description.rs`).
//!
//! Maps go the way of the engines that the program brings along: the mean over sizes is [`Evidence`], of which the tree
//! is grown. Instances are outlines as they are (`instances.rs`). Which score judges the tree's nodes follows from the
//! maps: with border, inside and middle that of the learned engine, else that of the classical one, which needs a border
//! alone. A model that gives what lies inside and no border has its border where it is not inside.
//!
//! A model in two files, an encoder and a decoder that is asked for one fragment at a time, gives instances, too
//! (`prompted/`).

mod description;
mod instances;
mod model;
mod outputs;
mod prompted;
mod ready;
#[cfg(test)]
mod tests;

use std::sync::LazyLock;

use fragscale_core::fault::{Fault, one_line};
use fragscale_core::jobs::Progress;
use image::RgbImage;
use rten::{Model, NodeId, Value, ValueOrView};

pub use description::Description;
pub use ready::ReadyEngine;

use crate::choice::Scorer;
use crate::classical::Classical;
use crate::engine::{Engine, Habits, Outlined};
use crate::engines::engine_called;
use crate::evidence::{Evidence, gray};
use crate::learned::Learned;
use crate::network::{self, Channels, Input, Layout, Normal, Part, Parts};
use description::{ChannelsWord, LayoutWord, Meaning, OutputEntry};
use instances::{Instance, Instances, Seen};
use model::{input_of, loaded, outputs_of, parts_of};
use outputs::{Mask, Numbers, Pictures};
use prompted::{Prompted, SeenAt};

/// Of what a network calls a fragment: at least even odds.
const LEAST_OF_INSTANCES: f64 = 0.5;

/// The evidence's kinds, in the order in which they are kept.
const KINDS: [Meaning; 4] = [
    Meaning::Border,
    Meaning::Inside,
    Meaning::Middle,
    Meaning::Fines,
];

/// A network of the user's.
pub struct NamedModel {
    name: String,
    model: Model,
    description: Description,
    input: Input,
    input_id: NodeId,
    parts: Parts,
    /// The model's output of each entry of the description.
    outputs: Vec<NodeId>,
    /// Of a model that is asked: its decoder. The model itself is the encoder then.
    prompted: Option<Prompted>,
}

impl std::fmt::Debug for NamedModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("NamedModel")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl NamedModel {
    /// From the bytes of an ONNX file and what is said of it, with those of its decoder where that is said
    /// ([`Description::decoder`]). `name` is what it is called where the description does not say.
    ///
    /// # Errors
    /// What of the model cannot be run, or does not agree with the description. Its file is that of the model.
    pub fn new(
        bytes: Vec<u8>,
        decoder: Option<Vec<u8>>,
        description: Description,
        name: &str,
    ) -> Result<Self, Fault> {
        let model = loaded(bytes, "model")?;
        let name = description
            .name
            .as_deref()
            .unwrap_or(name)
            .trim()
            .to_owned();
        if name.is_empty() || engine_called(&name).is_some() {
            let what = format!("\"{name}\" is no name for it");
            return Err(Fault::new(what, "give another name in the description"));
        }
        let (input_id, sides, bytes) = input_of(&model)?;
        let layout = match description.input.layout {
            LayoutWord::Nchw => Layout::ChannelsFirst,
            LayoutWord::Nhwc => Layout::ChannelsLast,
        };
        let channels = match description.input.channels {
            ChannelsWord::Rgb => Channels::Rgb,
            ChannelsWord::Bgr => Channels::Bgr,
            ChannelsWord::Gray => Channels::Gray,
        };
        let normal = description.normal(channels.count())?;
        let normal = match description.input.normalize {
            Some(_) => Normal::OfPhoto,
            None => Normal::Given(normal),
        };
        let parts = parts_of(&description, &sides, layout, channels)?;
        let (outputs, prompted) = match (&description.prompts, decoder) {
            (None, _) => (outputs_of(&model, &description)?, None),
            (Some(prompts), Some(bytes)) => {
                (Vec::new(), Some(Prompted::new(bytes, &model, prompts)?))
            }
            (Some(prompts), None) => {
                let what = format!("the decoder {} was not read", prompts.model);
                return Err(Fault::new(what, "lay it beside the description"));
            }
        };
        Ok(Self {
            name,
            input: Input {
                layout,
                channels,
                white: description.input.white.unwrap_or(1.0),
                normal,
                bytes,
            },
            model,
            description,
            input_id,
            parts,
            outputs,
            prompted,
        })
    }

    fn entries(&self) -> impl Iterator<Item = (&OutputEntry, NodeId)> {
        let outputs = self.outputs.iter().copied();
        self.description.output.iter().zip(outputs)
    }

    fn gives(&self, meaning: Meaning) -> bool {
        self.description.output.iter().any(|of| of.is == meaning)
    }

    fn gives_maps(&self) -> bool {
        let mut outputs = self.description.output.iter();
        self.prompted.is_none() && outputs.all(|of| of.is.is_map())
    }

    /// How many times smaller a photo is looked at, the least first.
    fn sizes(&self, width: u32, height: u32) -> Vec<f64> {
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
    fn see(
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
    fn see_numbers(
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

    fn wrong(&self, what: String) -> Fault {
        Fault::new(
            format!("the network {} {what}", self.name),
            "look at its description: the tile, multiple, layout, and which output is what",
        )
    }

    /// That an output gives the values that it is said to.
    fn check_chances(
        &self,
        entry: &OutputEntry,
        channel: usize,
        of: &Numbers,
        pictures: &Pictures,
    ) -> Result<(), Fault> {
        match of.no_chances(pictures, channel, entry.values) {
            None => Ok(()),
            Some((what, remedy)) => {
                let (name, word) = (&self.name, entry.is.word());
                let what = format!("{word} of the network {name} is {what}");
                Err(Fault::new(what, remedy))
            }
        }
    }

    fn wrong_shape(&self, meaning: Meaning, of: &Numbers, part: &Part) -> Fault {
        self.wrong(format!(
            "gives {} of {} for {} x {} pixels",
            meaning.word(),
            of.words(),
            part.columns,
            part.rows
        ))
    }

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

    fn evidence(&self, photo: &RgbImage, progress: &Progress) -> Result<Evidence, Fault> {
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

    fn instances(&self, photo: &RgbImage, progress: &Progress) -> Result<Outlined, Fault> {
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
            let masks = outputs::of_labels(labels, &pictures, entry.channel);
            return Ok(Box::new(masks.into_iter()));
        }
        if let (Some((_, detections)), Some((_, prototypes))) =
            (of(Meaning::Detections), of(Meaning::Prototypes))
        {
            let least = self.least_score();
            let masks = outputs::of_detections(detections, prototypes, seen, least);
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

impl Engine for NamedModel {
    fn name(&self) -> &str {
        &self.name
    }

    fn look(&self, photo: &RgbImage, progress: &Progress) -> Result<Evidence, Fault> {
        if self.gives_maps() {
            return self.evidence(photo, progress);
        }
        let outlined = self.instances(photo, progress)?;
        Ok(Evidence::of_outlines(&outlined.labels, photo))
    }

    fn outline(&self, photo: &RgbImage, progress: &Progress) -> Result<Option<Outlined>, Fault> {
        match self.gives_maps() {
            true => Ok(None),
            false => self.instances(photo, progress).map(Some),
        }
    }

    fn least_score(&self) -> f64 {
        let own = match (self.gives_maps(), self.judges_as_learned()) {
            _ if self.prompted.is_some() => prompted::LEAST_SCORE,
            (false, _) => LEAST_OF_INSTANCES,
            (true, true) => Learned.least_score(),
            (true, false) => Classical.least_score(),
        };
        self.description.least_score.unwrap_or(own)
    }

    fn habits(&self, width: u32, height: u32) -> Habits {
        let sizes = self.sizes(width, height);
        Habits {
            // No more than 64, or of a photo of 2^32 pixels along a side.
            sees_every: sizes.first().map_or(1, |by| by.ceil() as u32),
            // Nobody measured it: what it leaves is fines, as of other tools; the rest as the engine that is off most.
            fines_of_unfound: self.description.fines_of_unfound.unwrap_or(1.0),
            sizes_off: 1.0,
            ..Classical.habits(width, height)
        }
    }

    fn scorer(&self) -> Result<&Scorer, Fault> {
        if self.judges_as_learned() {
            Scorer::brought_along(UNVOTED.as_ref())
        } else {
            Classical.scorer()
        }
    }
}

/// Of a network that gives what ours does, but no votes: learned from ours without them.
static UNVOTED: LazyLock<Option<Scorer>> = LazyLock::new(|| {
    Scorer::read(include_str!(
        "../../../assets/delineation/score_unvoted.txt"
    ))
});

impl NamedModel {
    fn judges_as_learned(&self) -> bool {
        let needs = [Meaning::Border, Meaning::Inside, Meaning::Middle];
        needs.into_iter().all(|kind| self.gives(kind))
    }
}

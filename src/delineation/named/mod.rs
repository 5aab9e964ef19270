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
mod maps;
mod model;
mod outlining;
mod outputs;
mod prompted;
mod ready;
mod seeing;
#[cfg(test)]
mod tests;

use std::sync::LazyLock;

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use image::RgbImage;
use rten::{Model, NodeId};

pub use description::Description;
pub use ready::ReadyEngine;

use crate::choice::Scorer;
use crate::classical::Classical;
use crate::engine::{Engine, Habits, Outlined};
use crate::engines::engine_called;
use crate::evidence::Evidence;
use crate::learned::Learned;
use crate::network::{Channels, Input, Layout, Normal, Part, Parts};
use description::{ChannelsWord, LayoutWord, Meaning, OutputEntry};
use model::{input_of, loaded, outputs_of, parts_of};
use outputs::{Numbers, Pictures};
use prompted::Prompted;

/// Of what a network calls a fragment: at least even odds.
const LEAST_OF_INSTANCES: f64 = 0.5;

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

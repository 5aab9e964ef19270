//! What a user says of a network of theirs: a small TOML file beside it.
//!
//! ```toml
//! model = "my_network.onnx"        # beside this file
//! name = "my network"              # as files call it; the model's name without it
//!
//! [input]
//! layout = "nchw"                  # or "nhwc"
//! channels = "rgb"                 # or "bgr", "gray"
//! white = 1.0                      # what white is: 1 or 255
//! mean = [0.485, 0.456, 0.406]     # taken away after that, and
//! std = [0.229, 0.224, 0.225]      # what it is then divided by; one number stands for all channels
//! normalize = "photo"              # in place of both: the photo's own mean and deviation
//! tile = 1024                      # side of what it sees at once; a model of fixed size knows it by itself
//! margin = 48                      # of it thrown away where the photo goes on
//! multiple = 32                    # sides are multiples of it
//! sizes = [1, 2, 4]                # looked at so many times smaller, too, and the mean taken
//! whole = true                     # in place of sizes: the whole photo in one tile
//!
//! [[output]]
//! name = "border"                  # of the model's outputs; not needed where it has one
//! channel = 0
//! is = "border"                    # "inside", "middle", "fines"; "masks", "scores", "labels", "detections", "prototypes"
//! values = "logits"                # or "softmax" over its channels, "bytes" of 0 to 255, else probabilities
//! ```
//!
//! Maps: `border` of fragments, what lies `inside` them, how far in the `middle`, what is `fines`. Instances: `masks`
//! with `scores`; a `labels` image of numbers; `detections` with `prototypes` as YOLO's segmentation gives them.
//!
//! In place of outputs, of a model that is asked for one fragment at a time (SAM), of which `model` is the encoder:
//!
//! ```toml
//! [prompts]
//! model = "decoder.onnx"           # beside this file
//! from = "classical"               # or "learned": asked for where that engine outlines a fragment
//! grid = 16                        # and where it does not, at so many places along a side of a tile; 0 for none
//! masks = "pred_masks"             # its outputs, where they are not called as in the usual exports
//! scores = "iou_scores"
//! ```

use fragscale_core::fault::Fault;
use fragscale_core::toml_text::toml_fault;
use serde::Deserialize;

use crate::classical::Classical;
use crate::engine::Engine;
use crate::engines::engine_called;

/// Sides of what a network sees at once, pixels.
const SIDES: std::ops::RangeInclusive<usize> = 16..=4096;

/// Where nothing is said and the model does not know.
const TILE: usize = 1024;

/// Where a model is asked on what another engine did not outline: places along a side of a tile. SAM's own generator takes
/// 32 over a whole photo.
const GRID: usize = 16;

/// As dense as its masks have pixels.
const MOST_GRID: usize = 256;

/// A description, as it stands in the file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// The model's file, relative to this one.
    pub model: String,
    /// As files call it.
    pub name: Option<String>,
    #[serde(default)]
    pub(super) input: InputEntry,
    #[serde(default)]
    pub(super) output: Vec<OutputEntry>,
    pub(super) prompts: Option<PromptsEntry>,
    /// What a score must exceed for its fragment to count, 0 to 1.
    pub(super) least_score: Option<f64>,
    /// The share of what is not outlined that is fines, 0 to 1.
    pub(super) fines_of_unfound: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InputEntry {
    #[serde(default)]
    pub(super) layout: LayoutWord,
    #[serde(default)]
    pub(super) channels: ChannelsWord,
    pub(super) white: Option<f32>,
    pub(super) mean: Option<Numbers>,
    pub(super) std: Option<Numbers>,
    pub(super) normalize: Option<NormalizeWord>,
    pub(super) tile: Option<usize>,
    #[serde(default)]
    pub(super) margin: usize,
    pub(super) multiple: Option<usize>,
    pub(super) sizes: Option<Vec<f64>>,
    #[serde(default)]
    pub(super) whole: bool,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PromptsEntry {
    pub(super) model: String,
    from: Option<String>,
    grid: Option<usize>,
    pub(super) masks: Option<String>,
    pub(super) scores: Option<String>,
}

impl PromptsEntry {
    /// The engine whose outlines say where to ask.
    ///
    /// # Errors
    /// Where there is none of that name.
    pub(super) fn engine(&self) -> Result<&'static dyn Engine, Fault> {
        let Some(name) = &self.from else {
            return Ok(&Classical);
        };
        engine_called(name).ok_or_else(|| {
            let what = format!("prompts are from \"{name}\", which is no engine");
            Fault::new(what, "give \"classical\" or \"learned\"")
        })
    }

    /// Places along a side of a tile.
    pub(super) fn grid(&self) -> usize {
        self.grid.unwrap_or(GRID)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum LayoutWord {
    #[default]
    Nchw,
    Nhwc,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum ChannelsWord {
    #[default]
    Rgb,
    Bgr,
    Gray,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum NormalizeWord {
    Photo,
}

/// One for all channels, or one for each.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub(super) enum Numbers {
    All(f32),
    Each(Vec<f32>),
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputEntry {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) channel: usize,
    pub(super) is: Meaning,
    #[serde(default)]
    pub(super) values: Values,
}

/// What an output is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Meaning {
    Border,
    Inside,
    Middle,
    Fines,
    Masks,
    Scores,
    Labels,
    Detections,
    Prototypes,
}

impl Meaning {
    pub(super) fn is_map(self) -> bool {
        matches!(
            self,
            Self::Border | Self::Inside | Self::Middle | Self::Fines
        )
    }

    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Border => "border",
            Self::Inside => "inside",
            Self::Middle => "middle",
            Self::Fines => "fines",
            Self::Masks => "masks",
            Self::Scores => "scores",
            Self::Labels => "labels",
            Self::Detections => "detections",
            Self::Prototypes => "prototypes",
        }
    }
}

/// How an output says what it says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Values {
    #[default]
    Probability,
    Logits,
    Softmax,
    Bytes,
}

impl Description {
    /// From a file's text.
    ///
    /// # Errors
    /// What cannot be, with its line where there is one.
    pub fn read(text: &str) -> Result<Self, Fault> {
        let remedy = "see \"Your own network\" in docs/fragments.md for its keys";
        let read: Result<Self, toml::de::Error> = toml::from_str(text);
        let description = read.map_err(|error| toml_fault(text, &error, remedy))?;
        description.check()?;
        Ok(description)
    }

    fn check(&self) -> Result<(), Fault> {
        let refuse = |what: String, remedy: &str| Err(Fault::new(what, remedy));
        let InputEntry {
            white,
            tile,
            margin,
            multiple,
            sizes,
            whole,
            ..
        } = &self.input;
        match &self.prompts {
            None if self.output.is_empty() => {
                return refuse(
                    "it does not say what the model gives".to_owned(),
                    "add [[output]] with is = \"border\", \"masks\" or another one, or [prompts] with the decoder of a model like SAM",
                );
            }
            Some(_) if !self.output.is_empty() => {
                return refuse(
                    "[prompts] stands beside [[output]]".to_owned(),
                    "leave [[output]] out; masks and scores of [prompts] name the decoder's outputs",
                );
            }
            Some(prompts) => {
                prompts.engine()?;
                if prompts.grid() > MOST_GRID {
                    return refuse(
                        format!("a grid of {} places along a tile", prompts.grid()),
                        "give 256 at most; 0 asks only where the engine outlines",
                    );
                }
            }
            None => {}
        }
        for share in [self.least_score, self.fines_of_unfound]
            .into_iter()
            .flatten()
        {
            if !(0.0..=1.0).contains(&share) {
                return refuse(
                    format!("{share} is no share"),
                    "give least_score and fines_of_unfound from 0 to 1",
                );
            }
        }
        if white.is_some_and(|white| !(white > 0.0 && white.is_finite())) {
            return refuse("white is not above 0".to_owned(), "give 1 or 255");
        }
        if let Some(tile) = tile.filter(|tile| !SIDES.contains(tile)) {
            return refuse(format!("a tile of {tile} pixels"), "give 16 to 4096");
        }
        let side = tile.unwrap_or(TILE);
        if 4 * margin > side {
            return refuse(
                format!("of a tile of {side} pixels a margin of {margin} leaves too little"),
                "give a quarter of the tile at most",
            );
        }
        if multiple.is_some_and(|multiple| multiple == 0 || multiple > side) {
            return refuse(
                "sides cannot be such multiples".to_owned(),
                "give what the model halves its picture by, 32 for example",
            );
        }
        if let Some(sizes) = sizes {
            let are_right = !sizes.is_empty()
                && sizes.len() <= 8
                && sizes.iter().all(|by| (1.0..=64.0).contains(by))
                && sizes.is_sorted();
            if !are_right || *whole {
                return refuse(
                    "these sizes cannot be looked at".to_owned(),
                    "give up to 8 from 1 to 64, the least first, or whole = true without sizes",
                );
            }
        }
        Ok(())
    }

    /// The decoder's file, relative to this one, of a model that is asked for one fragment at a time.
    pub fn decoder(&self) -> Option<&str> {
        self.prompts.as_ref().map(|prompts| prompts.model.as_str())
    }

    /// Side of what is seen at once, where the model does not know it.
    pub(super) fn tile(&self) -> usize {
        self.input.tile.unwrap_or(TILE)
    }

    /// The mean and deviation of each channel.
    pub(super) fn normal(&self, channels: usize) -> Result<Vec<[f32; 2]>, Fault> {
        let of = |numbers: &Option<Numbers>, without: f32| match numbers {
            None => Some(vec![without; channels]),
            Some(Numbers::All(number)) => Some(vec![*number; channels]),
            Some(Numbers::Each(numbers)) => (numbers.len() == channels).then(|| numbers.clone()),
        };
        let wrong = || {
            Fault::new(
                format!("mean and std are not of {channels} channels, or not above 0"),
                "give as many as there are channels",
            )
        };
        if self.input.normalize.is_some() && (self.input.mean.is_some() || self.input.std.is_some())
        {
            let what = "normalize = \"photo\" stands beside mean or std";
            return Err(Fault::new(what, "give one of them"));
        }
        let means = of(&self.input.mean, 0.0).ok_or_else(wrong)?;
        let deviations = of(&self.input.std, 1.0).ok_or_else(wrong)?;
        let pairs: Vec<[f32; 2]> = means
            .into_iter()
            .zip(deviations)
            .map(|(mean, deviation)| [mean, deviation])
            .collect();
        let are_right = pairs
            .iter()
            .all(|[mean, deviation]| mean.is_finite() && *deviation > 0.0 && deviation.is_finite());
        if are_right { Ok(pairs) } else { Err(wrong()) }
    }
}

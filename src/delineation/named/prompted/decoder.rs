//! The decoder of a network that is asked for one fragment at a time, in the forms of the usual exports.
//!
//! | export | points | asked at once |
//! |---|---|---|
//! | Meta's `export_onnx_model.py`, MobileSAM, SAM 2 | `point_coords` 1 x N x 2, `point_labels` 1 x N | one place, and a point that is none (label -1) |
//! | Hugging Face's (optimum, transformers.js) | `input_points` 1 x P x N x 2, `input_labels` 1 x P x N | many |
//!
//! Places are columns and rows of pixels of what the encoder saw, the middle of the first pixel at 0. `mask_input` and
//! `has_mask_input` (an outline to begin from) are given as none, `orig_im_size` as the size of what was seen. All others
//! are outputs of the encoder, by their names, or its only one.

use fragscale_core::fault::{Fault, one_line};
use glam::DVec2;
use rten::{DataType, Dimension, Model, NodeId, Value, ValueOrView, ValueType};
use rten_tensor::Layout;

use crate::named::description::PromptsEntry;
use crate::named::model::{loaded, names_of};
use crate::named::outputs::{Mask, Numbers};
use crate::network;

/// Places in one run, of a decoder that takes many: its memory grows with them.
const AT_ONCE: usize = 16;

/// Its outputs in the usual exports; of masks the small ones, of which the large ones are made.
const MASKS: [&str; 3] = ["low_res_masks", "pred_masks", "masks"];
const SCORES: [&str; 3] = ["iou_predictions", "iou_scores", "scores"];

/// What an input is given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Given {
    /// One of the encoder's outputs, by its place among those that are taken.
    Seen(usize),
    Points,
    Labels,
    NoMask,
    HasNoMask,
    Size,
}

/// An input: what it is given, and as which numbers.
#[derive(Debug, Clone, Copy)]
struct Input {
    id: NodeId,
    given: Given,
    is_whole: bool,
}

/// The decoder.
pub(in crate::named) struct Decoder {
    model: Model,
    inputs: Vec<Input>,
    /// Outputs of the encoder.
    takes: Vec<NodeId>,
    masks: NodeId,
    scores: NodeId,
    asks_many: bool,
}

/// What a decoder is given in one run.
struct Question<'a> {
    /// What the encoder saw.
    seen: &'a [Value],
    /// In pixels of what was seen.
    places: &'a [DVec2],
    /// Its columns and rows.
    sides: [usize; 2],
}

impl Decoder {
    /// From an ONNX file's bytes and the encoder that it belongs to.
    ///
    /// # Errors
    /// What of it cannot be run, or what it takes or gives that is not known.
    pub(super) fn new(
        bytes: Vec<u8>,
        encoder: &Model,
        entry: &PromptsEntry,
    ) -> Result<Self, Fault> {
        let model = loaded(bytes, "decoder")?;
        let names = names_of(&model, model.input_ids());
        let mut takes = Vec::new();
        let inputs = model.input_ids().iter().zip(&names).map(|(id, name)| {
            Ok(Input {
                id: *id,
                given: given(name, &names, encoder, &mut takes)?,
                is_whole: is_whole(&model, *id, name)?,
            })
        });
        let inputs: Vec<Input> = inputs.collect::<Result<_, Fault>>()?;
        for (given, word) in [(Given::Points, "points"), (Given::Labels, "their labels")] {
            if !inputs.iter().any(|input| input.given == given) {
                let what = format!("the decoder takes no {word} ({})", names.join(", "));
                let remedy = "give a decoder with point_coords and point_labels, or input_points and input_labels";
                return Err(Fault::new(what, remedy));
            }
        }
        if takes.is_empty() {
            let what = "the decoder takes nothing of what the encoder sees";
            return Err(Fault::new(what, "export both of one model"));
        }
        let masks = output(&model, entry.masks.as_ref(), &MASKS, "masks")?;
        let scores = output(&model, entry.scores.as_ref(), &SCORES, "scores")?;
        if masks == scores {
            let what = "the decoder's masks and scores are the same output";
            return Err(Fault::new(what, "give each its own under [prompts]"));
        }
        Ok(Self {
            asks_many: names.iter().any(|name| name == "input_points"),
            inputs,
            takes,
            masks,
            scores,
            model,
        })
    }

    /// The encoder's outputs that it takes.
    pub(in crate::named) fn takes(&self) -> &[NodeId] {
        &self.takes
    }

    /// Asks at all places of a part of which the encoder's outputs are `seen`, and gives the best mask of each, as
    /// large as the decoder makes it. Before each run `told` hears how many places were asked at.
    ///
    /// # Errors
    /// What the decoder cannot take, or a form of its masks that is not known.
    pub(in crate::named) fn ask(
        &self,
        seen: &[Value],
        places: &[DVec2],
        sides: [usize; 2],
        mut told: impl FnMut(usize) -> Result<(), Fault>,
        mut take: impl FnMut(Mask) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let at_once = if self.asks_many { AT_ONCE } else { 1 };
        for (run, places) in places.chunks(at_once).enumerate() {
            told(run * at_once)?;
            let question = Question {
                seen,
                places,
                sides,
            };
            for mask in self.masks(&question)? {
                take(mask)?;
            }
        }
        Ok(())
    }

    /// The best mask of each place.
    fn masks(&self, question: &Question<'_>) -> Result<Vec<Mask>, Fault> {
        let wrong = |what: String| {
            Fault::new(
                format!("the decoder {what}"),
                "export it with the encoder of the same model, for one picture",
            )
        };
        let inputs = self.inputs.iter().map(|input| {
            let value = self.value(input, question);
            value
                .map(|value| (input.id, value))
                .ok_or_else(|| wrong("cannot be asked".to_owned()))
        });
        let inputs: Vec<_> = inputs.collect::<Result<_, _>>()?;
        let outputs = [self.masks, self.scores];
        let values = network::run(&self.model, inputs, &outputs);
        let values = values.map_err(|error| wrong(format!("fails ({})", one_line(&error))))?;
        let numbers: Option<Vec<Numbers>> = values.iter().map(Numbers::of).collect();
        let Some([masks, scores]) = numbers.as_deref() else {
            return Err(wrong("gives no numbers".to_owned()));
        };
        let asked = question.places.len();
        best(masks, scores, asked).ok_or_else(|| {
            wrong(format!(
                "gives masks of {} with scores of {} for {asked} places",
                masks.words(),
                scores.words()
            ))
        })
    }

    fn value<'a>(&self, input: &Input, question: &Question<'a>) -> Option<ValueOrView<'a>> {
        let Question {
            seen,
            places,
            sides,
        } = *question;
        let count = places.len();
        let (shape, values): (Vec<usize>, Vec<f32>) = match input.given {
            Given::Seen(place) => return seen.get(place).map(ValueOrView::from),
            Given::Points => {
                let points = places.iter().flat_map(|at| [at.x - 0.5, at.y - 0.5]);
                let mut points: Vec<f32> = points.map(|at| at as f32).collect();
                if self.asks_many {
                    (vec![1, count, 1, 2], points)
                } else {
                    points.extend([0.0; 2]);
                    (vec![1, 2, 2], points)
                }
            }
            Given::Labels if self.asks_many => (vec![1, count, 1], vec![1.0; count]),
            // The second point is none.
            Given::Labels => (vec![1, 2], vec![1.0, -1.0]),
            Given::NoMask => {
                let shape = self.mask_shape(input.id, seen)?;
                let count = shape.iter().product();
                (shape, vec![0.0; count])
            }
            Given::HasNoMask => (vec![1], vec![0.0]),
            Given::Size => (vec![2], vec![sides[1] as f32, sides[0] as f32]),
        };
        let shape = shape.as_slice();
        let value = if input.is_whole {
            let whole: Vec<i32> = values.iter().map(|value| value.round() as i32).collect();
            Value::from_shape(shape, whole).ok()
        } else {
            Value::from_shape(shape, values).ok()
        };
        value.map(ValueOrView::from)
    }

    /// Of the mask to begin from: as the model says, else four times what the encoder gives, as SAM has it.
    fn mask_shape(&self, id: NodeId, seen: &[Value]) -> Option<Vec<usize>> {
        let info = self.model.node_info(id);
        let own = info.as_ref().and_then(|info| info.shape());
        let own = own.as_deref().unwrap_or_default();
        let known = |side: usize| match own.get(side) {
            Some(Dimension::Fixed(size)) => Some(*size),
            _ => None,
        };
        let least = (seen.iter())
            .filter_map(|seen| <[usize; 2]>::try_from(seen.shape().get(2..)?).ok())
            .min_by_key(|[rows, _]| *rows);
        let of = |side: usize| known(side).or_else(|| Some(4 * least?[side - 2]));
        Some(vec![1, 1, of(2)?, of(3)?])
    }
}

/// What an input of that name is given; an output of the encoder becomes one of those that are taken.
fn given(
    name: &str,
    names: &[String],
    encoder: &Model,
    takes: &mut Vec<NodeId>,
) -> Result<Given, Fault> {
    Ok(match name {
        "point_coords" | "input_points" => Given::Points,
        "point_labels" | "input_labels" => Given::Labels,
        "mask_input" => Given::NoMask,
        "has_mask_input" => Given::HasNoMask,
        "orig_im_size" => Given::Size,
        _ => {
            let outputs = names_of(encoder, encoder.output_ids());
            let own = outputs.iter().position(|own| own == name);
            // The only output of an encoder need not be called as the decoder calls it.
            let is_only = outputs.len() == 1 && !names.contains(&outputs[0]) && takes.is_empty();
            let only = || (is_only && name.contains("embed")).then_some(0);
            let Some(place) = own.or_else(only) else {
                let what = format!(
                    "the decoder takes \"{name}\", which the encoder does not give ({})",
                    outputs.join(", ")
                );
                let remedy = "export both of one model, the decoder for points without boxes";
                return Err(Fault::new(what, remedy));
            };
            takes.push(encoder.output_ids()[place]);
            Given::Seen(takes.len() - 1)
        }
    })
}

/// Whether an input takes whole numbers, and not floats.
fn is_whole(model: &Model, id: NodeId, name: &str) -> Result<bool, Fault> {
    match model.node_info(id).and_then(|info| info.dtype()) {
        Some(ValueType::Tensor(DataType::Int32)) => Ok(true),
        None | Some(ValueType::Tensor(DataType::Float)) => Ok(false),
        Some(other) => {
            let what = format!("the decoder takes \"{name}\" as {other:?}");
            Err(Fault::new(what, "export it with floats of 32 bits"))
        }
    }
}

/// The output that the description names, or the one with a usual name.
fn output(
    model: &Model,
    said: Option<&String>,
    usual: &[&str],
    word: &str,
) -> Result<NodeId, Fault> {
    let own = names_of(model, model.output_ids());
    let at = |name: &str| own.iter().position(|own| own == name);
    let place = match said {
        Some(said) => at(said),
        None => usual.iter().find_map(|name| at(name)),
    };
    place.map(|place| model.output_ids()[place]).ok_or_else(|| {
        let called = said.map_or_else(|| word.to_owned(), |said| format!("\"{said}\""));
        let what = format!("the decoder gives no {called}; it gives {}", own.join(", "));
        let remedy = "give the names of masks and scores under [prompts] in the description";
        Fault::new(what, remedy)
    })
}

/// The best mask of each place, of numbers above 0 within it: several for each, all of one size, with as many scores.
/// Of four the first is meant for several points at once, and does not count; nor does one whose score is no number.
fn best(masks: &Numbers, scores: &Numbers, asked: usize) -> Option<Vec<Mask>> {
    let [.., rows, columns] = *masks.shape.as_slice() else {
        return None;
    };
    let pixels = rows * columns;
    if pixels == 0 || !masks.values.len().is_multiple_of(pixels * asked) {
        return None;
    }
    let each = masks.values.len() / pixels / asked;
    if each == 0 || scores.values.len() != each * asked {
        return None;
    }
    let for_several = usize::from(each == 4);
    let places = scores.values.chunks_exact(each).enumerate();
    let masks = places.filter_map(|(place, scores)| {
        let of_one = scores.iter().enumerate().skip(for_several);
        let of_one = of_one.filter(|(_, score)| !score.is_nan());
        let (number, score) = of_one.max_by(|a, b| a.1.total_cmp(b.1))?;
        let first = (place * each + number) * pixels;
        let values = masks.values.get(first..first + pixels)?;
        Some(Mask {
            of: [columns, rows],
            columns: 0..columns,
            rows: 0..rows,
            // As far above a half as they are above 0: between pixels it is they that go evenly.
            chances: values.iter().map(|value| value + 0.5).collect(),
            score: f64::from(*score),
        })
    });
    Some(masks.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(shape: &[usize], values: &[f32]) -> Numbers {
        Numbers {
            shape: shape.to_vec(),
            values: values.to_vec(),
        }
    }

    /// No mask is as large as the model says, or four times the smallest picture that the encoder gives (SAM 2 gives larger
    /// ones, too), where the model does not say.
    #[test]
    fn the_size_of_no_mask() {
        let folder =
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures/onnx");
        let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
        let text = "model = 'e'\n[prompts]\nmodel = 'd'\n";
        let description = crate::named::Description::read(text).unwrap();
        let encoder = loaded(read("seen.onnx"), "model").unwrap();
        let entry = description.prompts.as_ref().unwrap();
        let decoder = Decoder::new(read("asked.onnx"), &encoder, entry).unwrap();
        let seen = [[1, 2, 40, 40], [1, 2, 10, 12]].map(|shape| {
            let count = shape.iter().product();
            Value::from_shape(shape, vec![0.0f32; count]).unwrap()
        });
        let of = |given: Given| {
            let input = decoder.inputs.iter().find(|input| input.given == given);
            decoder.mask_shape(input.unwrap().id, &seen)
        };
        assert_eq!(of(Given::NoMask), Some(vec![1, 1, 64, 64]));
        assert_eq!(of(Given::Size), Some(vec![1, 1, 40, 48]));
    }

    /// Of each place the mask with the best score; of four not the first. Other shapes are none.
    #[test]
    fn the_best_of_each_place() {
        let values: Vec<f32> = (0..12).map(|value| value as f32).collect();
        let of = |shape: &[usize], scores: &[f32], asked| {
            let masks = numbers(shape, &values);
            let best = best(&masks, &numbers(&[1, scores.len()], scores), asked)?;
            let best = best.iter().map(|mask| (mask.score, mask.chances[0]));
            Some(best.collect::<Vec<_>>())
        };
        let three = of(&[1, 2, 3, 1, 2], &[0.5, 0.75, 0.25, 0.0, 0.25, 1.0], 2);
        assert_eq!(three.unwrap(), [(0.75, 2.5), (1.0, 10.5)]);
        let four = of(&[1, 4, 1, 3], &[1.0, 0.25, 0.5, 0.0], 1);
        assert_eq!(four.unwrap(), [(0.5, 6.5)]);
        let some = of(&[1, 4, 1, 3], &[1.0, f32::NAN, 0.25, 0.0], 1);
        assert_eq!(some.unwrap(), [(0.25, 6.5)]);
        assert_eq!(of(&[1, 4, 1, 3], &[f32::NAN; 4], 1), Some(vec![]));
        assert_eq!(of(&[1, 4, 1, 3], &[1.0, 0.25, 0.5], 1), None);
        assert_eq!(of(&[1, 4, 1, 3], &[1.0; 4], 5), None);
        assert_eq!(of(&[12], &[1.0], 1), None);
        assert_eq!(of(&[1, 4, 0, 3], &[], 1), None);
    }
}

//! What a model takes and gives, as its file says, against what its description says.

use std::panic::{AssertUnwindSafe, catch_unwind};

use fragscale_core::fault::{Fault, one_line};
use rten::{DataType, Dimension, Model, NodeId, ValueType};

use super::description::{Description, Meaning};
use crate::network::{Channels, Layout, Parts};

/// A model of the bytes of an ONNX file.
pub(super) fn loaded(bytes: Vec<u8>, word: &str) -> Result<Model, Fault> {
    let loaded = catch_unwind(AssertUnwindSafe(|| Model::load(bytes)));
    match loaded {
        Ok(Ok(model)) => Ok(model),
        Ok(Err(error)) => {
            let what = format!(
                "this {word} cannot be run ({})",
                one_line(&error.to_string())
            );
            let remedy = "export it as one ONNX file with other operators, or a lower opset";
            Err(Fault::new(what, remedy))
        }
        Err(_) => {
            let what = format!("this {word} is a broken ONNX file, or one that cannot be run");
            Err(Fault::new(what, "export it again"))
        }
    }
}

/// What inputs or outputs of a model are called.
pub(super) fn names_of(model: &Model, ids: &[NodeId]) -> Vec<String> {
    let name = |id: &NodeId| {
        let info = model.node_info(*id);
        info.and_then(|info| info.name()).unwrap_or("?").to_owned()
    };
    ids.iter().map(name).collect()
}

/// The one input: its name in the graph, its sides where they are known, and whether it takes bytes.
pub(super) fn input_of(model: &Model) -> Result<(NodeId, Vec<Option<usize>>, bool), Fault> {
    let inputs = model.input_ids();
    let &[id] = inputs else {
        let what = format!(
            "the model takes {} inputs ({})",
            inputs.len(),
            names_of(model, inputs).join(", ")
        );
        let remedy = "export one that takes a picture alone";
        return Err(Fault::new(what, remedy));
    };
    let info = model.node_info(id);
    let sides = info.as_ref().and_then(|info| info.shape());
    let sides = sides.map_or_else(
        || vec![None; 4],
        |sides| {
            let known = sides.iter().map(|side| match side {
                Dimension::Fixed(side) => Some(*side),
                Dimension::Symbolic(_) => None,
            });
            known.collect()
        },
    );
    let bytes = match info.and_then(|info| info.dtype()) {
        Some(ValueType::Tensor(DataType::UInt8)) => true,
        None | Some(ValueType::Tensor(DataType::Float)) => false,
        Some(other) => {
            let what = format!("the model takes {other:?}");
            return Err(Fault::new(
                what,
                "export one that takes floats of 32 bits, or bytes",
            ));
        }
    };
    Ok((id, sides, bytes))
}

/// How a photo is cut, from what the description and the model say.
pub(super) fn parts_of(
    description: &Description,
    sides: &[Option<usize>],
    layout: Layout,
    channels: Channels,
) -> Result<Parts, Fault> {
    let (pictures, own_channels, rows, columns) = match (sides, layout) {
        (&[n, c, h, w], Layout::ChannelsFirst) | (&[n, h, w, c], Layout::ChannelsLast) => {
            (n, c, h, w)
        }
        _ => {
            let what = format!("the model takes a tensor of {} sides", sides.len());
            return Err(Fault::new(
                what,
                "export one that takes pictures: four sides",
            ));
        }
    };
    if pictures.is_some_and(|pictures| pictures != 1) {
        let what = "the model takes several pictures at once";
        return Err(Fault::new(what, "export it for one"));
    }
    if let Some(own) = own_channels.filter(|own| *own != channels.count()) {
        let what = format!(
            "the model takes {own} channels, the description says {}",
            channels.count()
        );
        return Err(Fault::new(
            what,
            "set channels, or layout, in the description",
        ));
    }
    let tile = description.tile();
    let knows_its_side = rows.is_some() || columns.is_some();
    // What is asked has learned where things lie in a picture of one size.
    let is_fixed = knows_its_side || description.prompts.is_some();
    let part = [columns.unwrap_or(tile), rows.unwrap_or(tile)];
    let said = description.input.tile;
    if said.is_some_and(|said| part != [said; 2]) {
        let what = format!(
            "the model takes {} x {} pixels, the description says {tile}",
            part[0], part[1]
        );
        return Err(Fault::new(what, "leave tile out of the description"));
    }
    let margin = description.input.margin;
    if part
        .iter()
        .any(|side| *side > 4096 || *side < 16 || 4 * margin > *side)
    {
        let what = format!(
            "the model takes {} x {} pixels, with a margin of {margin}",
            part[0], part[1]
        );
        return Err(Fault::new(
            what,
            "give one of 16 to 4096, and a margin of a quarter at most",
        ));
    }
    let step = description.input.multiple.unwrap_or(1);
    // A part is never larger than the tile.
    let part = part.map(|side| if is_fixed { side } else { side / step * step });
    Ok(Parts {
        part,
        margin,
        step,
        is_fixed,
    })
}

/// Which of the model's outputs each entry is.
pub(super) fn outputs_of(model: &Model, description: &Description) -> Result<Vec<NodeId>, Fault> {
    let ids = model.output_ids();
    let names = names_of(model, ids);
    let all = || names.join(", ");
    let entries = &description.output;
    let found = entries.iter().map(|entry| match &entry.name {
        None if ids.len() == 1 => Ok(ids[0]),
        None => {
            let what = format!("{} is which of its outputs ({})?", entry.is.word(), all());
            Err(Fault::new(what, "give its name in the description"))
        }
        Some(name) => {
            let place = names.iter().position(|own| own == name);
            place.map(|place| ids[place]).ok_or_else(|| {
                let what = format!("the model has no output \"{name}\"; it has {}", all());
                Fault::new(what, "give one of these in the description")
            })
        }
    });
    let found: Vec<NodeId> = found.collect::<Result<_, _>>()?;
    let mut meanings: Vec<Meaning> = entries.iter().map(|entry| entry.is).collect();
    meanings.sort_unstable();
    let is_twice = meanings.windows(2).any(|pair| pair[0] == pair[1]);
    let maps = meanings.iter().filter(|of| of.is_map()).count();
    let is_known = match meanings.as_slice() {
        _ if is_twice => false,
        of if maps == of.len() => of.contains(&Meaning::Border) || of.contains(&Meaning::Inside),
        of => matches!(
            of,
            [Meaning::Masks]
                | [Meaning::Masks, Meaning::Scores]
                | [Meaning::Labels]
                | [Meaning::Detections, Meaning::Prototypes]
        ),
    };
    if !is_known {
        let words: Vec<&str> = meanings.iter().map(|of| of.word()).collect();
        let what = format!("nothing is outlined by {}", words.join(", "));
        let remedy = "describe maps with border or inside; masks, with scores or without; labels; or detections and prototypes";
        return Err(Fault::new(what, remedy));
    }
    Ok(found)
}

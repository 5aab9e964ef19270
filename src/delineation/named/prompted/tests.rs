use std::path::Path;

use fragscale_core::jobs::Progress;
use glam::DVec2;
use image::{Rgb, RgbImage};
use rten::{Value, ValueOrView};

use super::*;
use crate::labels::{FINES, LabelImage, NOT_ROCK};
use crate::named::model::loaded;
use crate::named::{Description, NamedModel};
use crate::network;

fn fixture(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures/onnx");
    std::fs::read(folder.join(name)).unwrap()
}

fn described(more: &str) -> Description {
    Description::read(&format!(
        "model = 'encoder.onnx'\n[prompts]\nmodel = 'decoder.onnx'\n{more}"
    ))
    .unwrap()
}

fn decoder(encoder: &str, decoder: &str, more: &str) -> Result<Decoder, Fault> {
    let encoder = loaded(fixture(encoder), "model").unwrap();
    let description = described(more);
    Decoder::new(
        fixture(decoder),
        &encoder,
        description.prompts.as_ref().unwrap(),
    )
}

/// What the makers' own code answers (`tests/onnx/make_sam.py`), one place at a time and all at once.
#[test]
fn sam_answers_as_its_makers_code() {
    let said: serde_json::Value = serde_json::from_slice(&fixture("sam.json")).unwrap();
    // The picture of which the script's header tells, and its means and deviations.
    let normal = [(123.675, 58.395), (116.28, 57.12), (103.53, 57.375)];
    let picture = normal.iter().enumerate().flat_map(|(channel, normal)| {
        (0..64 * 64).map(move |place| {
            let (x, y) = (place % 64, place / 64);
            let value = [3 * x + y, 2 * y, x + 2 * y][channel] % 256;
            ((f64::from(value) - normal.0) / normal.1) as f32
        })
    });
    let picture: Vec<f32> = picture.collect();
    for (export, word) in [("meta", "meta"), ("hf", "hugging_face")] {
        let encoder = loaded(fixture(&format!("sam_{export}_encoder.onnx")), "model").unwrap();
        let file = format!("sam_{export}_decoder.onnx");
        let description = described("");
        let entry = description.prompts.as_ref().unwrap();
        let decoder = Decoder::new(fixture(&file), &encoder, entry).unwrap();
        let input = encoder.input_ids()[0];
        let value = Value::from_shape([1, 3, 64, 64], picture.clone()).unwrap();
        let inputs = vec![(input, ValueOrView::from(value))];
        let seen = network::run(&encoder, inputs, decoder.takes()).unwrap();
        let answers = said[word].as_array().unwrap();
        let places = answers.iter().map(|answer| {
            let at = |side: usize| answer["place"][side].as_f64().unwrap() + 0.5;
            DVec2::new(at(0), at(1))
        });
        let places: Vec<DVec2> = places.collect();
        let mut found = Vec::new();
        let take = |mask: crate::named::outputs::Mask| {
            found.push((mask.score, mask.chances));
            Ok(())
        };
        let asked = decoder.ask(&seen, &places, [64, 64], |_| Ok(()), take);
        asked.unwrap();
        assert_eq!(found.len(), 3, "{export}");
        for ((score, chances), answer) in found.iter().zip(answers) {
            let wanted = answer["score"].as_f64().unwrap();
            assert!((score - wanted).abs() < 1e-4, "{export} {score} {wanted}");
            let rows = answer["mask"].as_array().unwrap().iter();
            let wanted: String = rows.map(|row| row.as_str().unwrap()).collect();
            assert!(wanted.contains('#') && wanted.contains('.'));
            let differ = chances.iter().zip(wanted.chars());
            let differ = differ.filter(|(chance, is_in)| (**chance > 0.5) != (*is_in == '#'));
            // Of torch's and our floats, where a value is next to 0.
            assert!(differ.count() <= 1, "{export}");
        }
    }
}

/// Stones of one colour each, 16 x 16 pixels, with 8 pixels of black between them.
fn stones(columns: u32, rows: u32) -> RgbImage {
    RgbImage::from_fn(24 * columns, 24 * rows, |x, y| {
        let within = |at: u32| (4..20).contains(&(at % 24));
        let number = x / 24 + columns * (y / 24);
        match within(x) && within(y) {
            true => Rgb([200, 180, (7 * number) as u8]),
            false => Rgb([0; 3]),
        }
    })
}

/// The plain encoder and decoder of `tests/onnx/make.py`, described so.
fn asked(described: &str) -> NamedModel {
    let text = format!("model = 'seen.onnx'\nname = 'asked'\n{described}");
    let description = Description::read(&text).unwrap();
    assert_eq!(description.decoder(), Some("asked.onnx"));
    let [model, decoder] = ["seen.onnx", "asked.onnx"].map(fixture);
    NamedModel::new(model, Some(decoder), description, "x").unwrap()
}

/// Every stone is found once, wherever parts of the photo begin and end, and what is between them is none: it goes on
/// behind each part's edge. Masks of a fourth of the pixels, that are 1 within and -1 without, leave out a pixel at each
/// corner: there a bilinear value is 2 (0.625)^2 - 1.
#[test]
fn every_stone_is_found_once() {
    for from in ["", "from = 'learned'\n"] {
        let model = asked(&format!(
            "[input]\nmargin = 16\n[prompts]\nmodel = 'asked.onnx'\n{from}"
        ));
        let photo = stones(7, 5);
        let progress = Progress::default();
        let outlined = model.outline(&photo, &progress).unwrap().unwrap();
        let labels = &outlined.labels;
        assert_eq!(outlined.sure.len(), 35);
        assert!(outlined.sure.iter().all(|sure| (sure - 0.95).abs() < 1e-6));
        for number in 0..35 {
            let [x, y] = [number % 7, number / 7].map(|at| 24 * at + 12);
            let label = labels.labels[y * labels.width + x];
            assert_ne!(label, FINES, "{number}");
            assert_eq!(labels.areas()[label as usize], 252, "{number}");
        }
        assert_eq!(labels.areas()[0], 7 * 5 * 24 * 24 - 35 * 252);
        assert_eq!(model.least_score(), LEAST_SCORE);
    }
}

/// Where no answer is sure enough it is said how sure the best one is; of the third mask's 0.5 nobody asks.
#[test]
fn sure_of_nothing() {
    let model = asked("least_score = 0.97\n[prompts]\nmodel = 'asked.onnx'\n");
    let fault = model
        .outline(&stones(2, 2), &Progress::default())
        .unwrap_err();
    let said = fault.to_string();
    assert!(
        said.contains("places, is sure of none: its best score is 0.95, and least_score 0.97"),
        "{said}"
    );
}

/// One colour goes on behind the edges of every part.
#[test]
fn nothing_is_whole() {
    let model = asked("[input]\nmargin = 16\n[prompts]\nmodel = 'asked.onnx'\n");
    let gray = RgbImage::from_pixel(128, 128, Rgb([90; 3]));
    let fault = model.outline(&gray, &Progress::default()).unwrap_err();
    let said = fault.to_string();
    assert!(
        said.contains("gave no mask that lies whole in a tile"),
        "{said}"
    );
}

fn rectangle(labels: &mut LabelImage, [x, y]: [usize; 2], [w, h]: [usize; 2], number: u32) {
    for row in y..y + h {
        labels.labels[row * labels.width + x..][..w].fill(number);
    }
}

/// The middle of a stone, in the pixels of the part that keeps it, and in the sizes in which it is neither lost nor cut; on
/// the grid only where nothing is outlined and there is rock.
#[test]
fn where_to_ask() {
    let mut labels = LabelImage {
        width: 256,
        height: 128,
        labels: vec![FINES; 256 * 128],
    };
    // As wide as 7.9, 45 and 102 pixels.
    rectangle(&mut labels, [8, 9], [7, 7], 1);
    rectangle(&mut labels, [40, 20], [41, 39], 2);
    rectangle(&mut labels, [130, 10], [91, 91], 3);
    let sizes = [1.0, 4.0];
    let parts = network::Parts {
        part: [64, 64],
        margin: 16,
        step: 1,
        is_fixed: true,
    };
    let asked = |places: &Places, number: usize| {
        let by = sizes[number] as usize;
        let size = [256 / by, 128 / by];
        let parts = parts.of(size[0], size[1]);
        let each = parts.iter().flat_map(|part| {
            let at = SeenAt {
                part,
                size,
                sizes: &sizes,
                number,
            };
            let corner = DVec2::new(part.first as f64, part.above as f64);
            let places = places.in_part(at).into_iter();
            places.map(move |at| (at + corner) * by as f64)
        });
        each.collect::<Vec<_>>()
    };
    let stones = Places::by(labels.clone(), 0);
    let fine = asked(&stones, 0);
    assert_eq!(
        fine,
        [DVec2::new(11.5, 12.5)],
        "the second is wider than a third of 64"
    );
    let coarse = asked(&stones, 1);
    assert_eq!(coarse.len(), 1, "the second is 11 wide, {coarse:?}");
    assert!((coarse[0] - DVec2::new(175.5, 55.5)).length() < 1e-9);
    labels.labels[..128 * 256].iter_mut().for_each(|label| {
        if *label == FINES {
            *label = NOT_ROCK;
        }
    });
    rectangle(&mut labels, [200, 112], [32, 16], FINES);
    let grid = Places::by(labels, 4);
    let at: Vec<DVec2> = asked(&grid, 0)
        .into_iter()
        .filter(|at| at.y > 110.0)
        .collect();
    // Every 16 pixels of a part of 64, from 8 on.
    assert_eq!(at, [DVec2::new(200.5, 120.5), DVec2::new(216.5, 120.5)]);
}

/// What does not fit is said in a line.
#[test]
fn refused() {
    for (encoder, of, more, wanted) in [
        (
            "seen.onnx",
            "sam_hf_decoder.onnx",
            "",
            "image_positional_embeddings",
        ),
        (
            "seen.onnx",
            "seen.onnx",
            "",
            "takes \"x\", which the encoder does not give",
        ),
        (
            "seen.onnx",
            "asked.onnx",
            "masks = 'maks'\n",
            "gives no \"maks\"; it gives low_res_masks, iou_predictions",
        ),
        (
            "seen.onnx",
            "asked.onnx",
            "scores = 'low_res_masks'\n",
            "masks and scores are the same output",
        ),
        ("seen.onnx", "strange.onnx", "", "Frobnicate"),
        ("sam_hf_encoder.onnx", "squares.onnx", "", "takes \"x\""),
    ] {
        let error = decoder(encoder, of, more).err();
        let error = error.unwrap_or_else(|| panic!("{of} is taken")).to_string();
        assert!(error.contains(wanted) && !error.contains('\n'), "{error}");
    }
    for text in [
        "from = 'sieve'\n",
        "grid = 300\n",
        "[[output]]\nis = 'masks'\n",
        "boxes = true\n",
    ] {
        let text = format!("model = 'm'\n[prompts]\nmodel = 'd'\n{text}");
        assert!(Description::read(&text).is_err(), "{text}");
    }
}

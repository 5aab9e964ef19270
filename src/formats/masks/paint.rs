//! From masks to a label image. Where masks overlap, the smaller piece lies on top, as a small stone lies on a large one;
//! of two of a size the later. A hole stays open to what lies below.

use std::collections::{BTreeSet, HashSet};
use std::ops::Range;

use super::outline::{Mask, Meaning, OutlinedImage, Piece, Runs, is_odd_of_fragments};
use super::regions::take_off_behind;
use super::{Masks, OutlinedPhoto, check_size, drawn_smaller, renumbered};
use crate::fault::Fault;
use crate::labels::{FINES, LabelImage, NOT_ROCK, spans_of_rings};
use crate::text::notes::Notes;

/// What no mask covers, while masks are painted.
const BARE: u32 = NOT_ROCK - 1;

/// How often the masks of a file may cover a photo: nobody draws more, and it would take for ever.
const MOST_COVERS: u64 = 100;

/// How far outside the photo a corner may lie without being worth a word, in pixels.
const AT_THE_EDGE: f64 = 1.0;

/// The label image of an image's masks. `is_own`: fragscale wrote them, so that they overlap on purpose.
///
/// # Errors
/// Where the image is of another size than the photo, no mask lies in the photo, or they cover it too often.
pub(super) fn painted(
    image: &OutlinedImage,
    photo: &OutlinedPhoto<'_>,
    is_own: bool,
) -> Result<Masks, Fault> {
    if let Some((width, height)) = image.size {
        check_size(width, height, photo)?;
    }
    if !is_own {
        drawn_smaller::refuse(image, photo)?;
    }
    let mut notes = image.notes.clone();
    let layers = layers(image, photo, &mut notes)?;
    if layers.is_empty() && !image.masks.is_empty() {
        return Err(Fault::new(
            format!(
                "none of its {} outlines covers a pixel of the photo {}",
                image.masks.len(),
                photo.name
            ),
            "give outlines in pixels of this photo, counted from its top left corner",
        ));
    }
    let numbers = numbers(&image.masks, &layers);
    let pixels = photo.width as usize * photo.height as usize;
    let mut labels = vec![BARE; pixels];
    let mut is_shared = vec![false; pixels];
    for layer in &layers {
        let number = numbers[layer.mask];
        let piece = &image.masks[layer.mask].pieces[layer.piece];
        spans(piece, photo, |row, columns| {
            let begin = row as usize * photo.width as usize;
            let columns = begin + columns.start as usize..begin + columns.end as usize;
            let shared = is_shared[columns.clone()].iter_mut();
            for (label, shared) in labels[columns].iter_mut().zip(shared) {
                *shared |= *label != BARE && *label != number;
                *label = number;
            }
        });
    }
    for label in labels.iter_mut().filter(|label| **label == BARE) {
        *label = FINES;
    }
    let mut labels = LabelImage {
        width: photo.width as usize,
        height: photo.height as usize,
        labels,
    };
    if !is_own {
        let shared = is_shared.iter().filter(|is_shared| **is_shared).count();
        if shared > 0 {
            notes.say(format!(
                "{shared} pixels lie in more than one outline, and belong to the smallest"
            ));
        }
        say_hidden(image, &layers, &numbers, &labels, &mut notes);
        say_odd_classes(image, &mut notes);
        take_off_behind(&mut labels, &mut notes);
    }
    if image.masks.is_empty() {
        notes.say("no fragment is outlined in it");
    }
    Ok(Masks {
        labels: renumbered(labels, &mut notes),
        notes: notes.sentences(),
    })
}

/// A piece that covers pixels.
struct Layer {
    mask: usize,
    piece: usize,
    pixels: u64,
}

/// The pieces that cover pixels, the largest first.
fn layers(
    image: &OutlinedImage,
    photo: &OutlinedPhoto<'_>,
    notes: &mut Notes,
) -> Result<Vec<Layer>, Fault> {
    let most = MOST_COVERS * u64::from(photo.width) * u64::from(photo.height);
    let mut layers = Vec::new();
    let mut sum = 0;
    for (place, mask) in image.masks.iter().enumerate() {
        for (index, piece) in mask.pieces.iter().enumerate() {
            if let Piece::Runs(runs) = piece
                && (runs.width > photo.width || runs.height > photo.height)
            {
                notes.at(
                    "an outline whose runs are larger than the photo is left out",
                    &mask.place,
                );
                continue;
            }
            let mut pixels = 0;
            let is_crossed = spans(piece, photo, |_, columns| {
                pixels += u64::from(columns.end - columns.start)
            });
            sum += pixels;
            if sum > most {
                let what = format!("its outlines cover the photo more than {MOST_COVERS} times");
                return Err(Fault::new(what, "give the outlines of fragments"));
            }
            if is_crossed {
                let what =
                    "an outline crosses itself: what it goes about an odd number of times is taken";
                notes.at(what, &mask.place);
            }
            if pixels == 0 {
                notes.at(why_nothing(piece, photo), &mask.place);
                continue;
            }
            if is_cut(piece, photo) {
                notes.at(
                    "an outline reaches beyond the photo and is cut at its edge",
                    &mask.place,
                );
            }
            layers.push(Layer {
                mask: place,
                piece: index,
                pixels,
            });
        }
    }
    layers.sort_by_key(|layer| std::cmp::Reverse(layer.pixels));
    Ok(layers)
}

/// Why a piece covers no pixel.
fn why_nothing(piece: &Piece, photo: &OutlinedPhoto<'_>) -> &'static str {
    match piece {
        Piece::Rings(rings) if rings.first().is_none_or(|ring| ring.len() < 3) => {
            "an outline of fewer than 3 corners is left out"
        }
        piece if is_cut(piece, photo) => "an outline outside the photo is left out",
        _ => "an outline that covers no pixel's middle is left out",
    }
}

/// Whether a piece reaches beyond the photo.
fn is_cut(piece: &Piece, photo: &OutlinedPhoto<'_>) -> bool {
    let (width, height) = (f64::from(photo.width), f64::from(photo.height));
    let inside = |at: f64, most: f64| (-AT_THE_EDGE..=most + AT_THE_EDGE).contains(&at);
    match piece {
        Piece::Rings(rings) => rings
            .iter()
            .flatten()
            .any(|corner| !inside(corner.x, width) || !inside(corner.y, height)),
        Piece::Runs(runs) => {
            runs.left < 0
                || runs.top < 0
                || runs.left.saturating_add(runs.width.into()) > photo.width.into()
                || runs.top.saturating_add(runs.height.into()) > photo.height.into()
        }
    }
}

/// The label of each mask. Those that have numbers keep them where each has one of its own; else fragments that cover
/// pixels are counted in the order of the file.
fn numbers(masks: &[Mask], layers: &[Layer]) -> Vec<u32> {
    let covers: HashSet<usize> = layers.iter().map(|layer| layer.mask).collect();
    let fragments = || {
        masks
            .iter()
            .filter(|mask| mask.meaning == Meaning::Fragment)
    };
    let mut used = HashSet::new();
    let own = fragments().all(|mask| {
        let number = mask.number.filter(|number| (1..BARE).contains(number));
        number.is_some_and(|number| used.insert(number))
    });
    let mut next = 0;
    let number = |(place, mask): (usize, &Mask)| match (mask.meaning, mask.number) {
        (Meaning::Fines, _) => FINES,
        (Meaning::NotRock, _) => NOT_ROCK,
        (Meaning::Fragment, Some(number)) if own => number,
        (Meaning::Fragment, _) if covers.contains(&place) => {
            next += 1;
            next
        }
        (Meaning::Fragment, _) => BARE,
    };
    masks.iter().enumerate().map(number).collect()
}

/// Says of fragments that smaller ones hide.
fn say_hidden(
    image: &OutlinedImage,
    layers: &[Layer],
    numbers: &[u32],
    labels: &LabelImage,
    notes: &mut Notes,
) {
    let seen: HashSet<u32> = labels.labels.iter().copied().collect();
    let mut said = HashSet::new();
    for layer in layers {
        if !seen.contains(&numbers[layer.mask]) && said.insert(layer.mask) {
            let what = "an outline is hidden below smaller ones and left out";
            notes.at(what, &image.masks[layer.mask].place);
        }
    }
}

/// Says of classes that may be none of rock.
fn say_odd_classes(image: &OutlinedImage, notes: &mut Notes) {
    let fragments = image
        .masks
        .iter()
        .filter(|mask| mask.meaning == Meaning::Fragment);
    let odd = fragments
        .map(|mask| mask.class.trim())
        .filter(|class| is_odd_of_fragments(class));
    let odd: BTreeSet<&str> = odd.collect();
    if !odd.is_empty() {
        let names = crate::fault::first_names(odd.iter().copied());
        notes.say(format!(
            "outlines of the class {names} are taken for fragments: call what is no rock 'not rock', what is fine 'fines'"
        ));
    }
}

/// The pixels of a piece that lie in the photo, as spans of columns in rows; whether its outline crosses itself.
fn spans(piece: &Piece, photo: &OutlinedPhoto<'_>, mut each: impl FnMut(u32, Range<u32>)) -> bool {
    match piece {
        Piece::Rings(rings) => {
            let is_crossed = spans_of_rings(rings, photo.width, photo.height, each);
            rings.len() == 1 && is_crossed
        }
        Piece::Runs(runs) => {
            spans_of_runs(runs, photo, &mut each);
            false
        }
    }
}

fn spans_of_runs(runs: &Runs, photo: &OutlinedPhoto<'_>, each: &mut impl FnMut(u32, Range<u32>)) {
    // The length of a line: a column or a row.
    let line = match runs.by_columns {
        true => u64::from(runs.height),
        false => u64::from(runs.width),
    };
    // The part of a range of lengths that lies in the photo, beginning at an offset.
    let within = |from: u64, to: u64, offset: i64, most: u32| {
        let place = |at: u64| {
            i64::try_from(at)
                .unwrap_or(i64::MAX)
                .saturating_add(offset)
                .clamp(0, most.into()) as u32
        };
        place(from)..place(to)
    };
    let mut at = 0_u64;
    for (index, count) in runs.counts.iter().enumerate() {
        let end = at + u64::from(*count);
        if index % 2 == 1 {
            while at < end {
                let (number, from) = (at / line, at % line);
                let to = (from + (end - at)).min(line);
                let (lines, places) = match runs.by_columns {
                    true => (
                        within(number, number + 1, runs.left, photo.width),
                        within(from, to, runs.top, photo.height),
                    ),
                    false => (
                        within(number, number + 1, runs.top, photo.height),
                        within(from, to, runs.left, photo.width),
                    ),
                };
                for line in lines {
                    match runs.by_columns {
                        true => places.clone().for_each(|row| each(row, line..line + 1)),
                        false if !places.is_empty() => each(line, places.clone()),
                        false => {}
                    }
                }
                at += to - from;
            }
        }
        at = end;
    }
}

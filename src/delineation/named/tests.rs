use image::{Rgb, RgbImage};

use super::*;
use crate::delineating::delineated;
use crate::labels::{FINES, NOT_ROCK};

const DARK: &[u8] = include_bytes!("../../../tests/fixtures/onnx/dark.onnx");
const SQUARES: &[u8] = include_bytes!("../../../tests/fixtures/onnx/squares.onnx");
const NUMBERS: &[u8] = include_bytes!("../../../tests/fixtures/onnx/numbers.onnx");
const YOLO: &[u8] = include_bytes!("../../../tests/fixtures/onnx/yolo.onnx");
const STRANGE: &[u8] = include_bytes!("../../../tests/fixtures/onnx/strange.onnx");
const TWO: &[u8] = include_bytes!("../../../tests/fixtures/onnx/two.onnx");
const OURS: &[u8] = include_bytes!("../../../assets/delineation/fragments.onnx");

const MAPS: &str =
    "model = 'dark.onnx'\n[[output]]\nis = 'border'\n[[output]]\nis = 'inside'\nchannel = 1\n";
const MASKS: &str = "model = 'm.onnx'\n[[output]]\nis = 'masks'\nname = 'masks'\n[[output]]\nis = 'scores'\nname = 'scores'\n";

fn named(bytes: &[u8], text: &str) -> Result<NamedModel, Fault> {
    NamedModel::new(bytes.to_vec(), None, Description::read(text)?, "mine")
}

fn photo(width: u32, height: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        Rgb([
            (x * 7 % 256) as u8,
            (y * 5 % 256) as u8,
            ((x + y) % 256) as u8,
        ])
    })
}

/// Of a map whose formula is known every pixel is right, in parts and in one.
#[test]
fn maps_by_their_formula() {
    let photo = photo(150, 70);
    for input in ["", "[input]\ntile = 64\nmargin = 8\nmultiple = 16\n"] {
        let text = MAPS.replace(
            "[[output]]\nis = 'border'",
            &format!("{input}[[output]]\nis = 'border'"),
        );
        let seen = named(DARK, &text)
            .unwrap()
            .look(&photo, &Progress::default())
            .unwrap();
        for (place, pixel) in photo.pixels().enumerate() {
            let red = f64::from(pixel.0[0]) / 255.0;
            let border = 1.0 / (1.0 + (16.0 * red - 8.0).exp());
            assert!(
                (f64::from(seen.border[place]) - 255.0 * border).abs() <= 0.51,
                "{place}"
            );
            assert!((f64::from(seen.rock[place]) - 255.0 * (1.0 - border)).abs() <= 0.51);
            assert_eq!(seen.middle[place], 0);
        }
    }
    // Blue in the place of red.
    let swapped = format!(
        "{}\n",
        MAPS.replace(
            "[[output]]\nis = 'border'",
            "[input]\nchannels = 'bgr'\n[[output]]\nis = 'border'"
        )
    );
    let seen = named(DARK, &swapped)
        .unwrap()
        .look(&photo, &Progress::default())
        .unwrap();
    let blue = f64::from(photo.get_pixel(149, 60).0[2]) / 255.0;
    let border = 255.0 / (1.0 + (16.0 * blue - 8.0).exp());
    assert!((f64::from(seen.border[60 * 150 + 149]) - border).abs() <= 0.51);
}

/// Our own network, described as if it were a stranger's, sees the same as the engine that it is of.
#[test]
fn ours_as_if_it_were_theirs() {
    let text = "model = 'fragments.onnx'\n[input]\nnormalize = 'photo'\ntile = 1152\nmargin = 64\nmultiple = 32\nsizes = [1, 2, 4]\n\
        [[output]]\nis = 'border'\n[[output]]\nis = 'inside'\nchannel = 1\n[[output]]\nis = 'middle'\nchannel = 2\n";
    let ours = named(OURS, text).unwrap();
    let photo = photo(403, 388);
    let progress = Progress::default();
    let mut without_votes = Learned.look(&photo, &progress).unwrap();
    assert!(without_votes.votes.take().is_some());
    let seen = ours.look(&photo, &progress).unwrap();
    assert!(seen == without_votes);
    assert_eq!(ours.least_score(), Learned.least_score());
    // It gives no votes, and is judged by a score that asks for none.
    assert!(ours.scorer().unwrap() != Learned.scorer().unwrap());
    let outlines = delineated(&ours, &photo, &[], &progress).unwrap().outlines;
    assert!(outlines.labels().areas().len() > 1);
}

/// Masks of a fixed size in a photo of that size: the smaller on top, what is not sure left out, what is no rock is none.
#[test]
fn masks_are_outlines() {
    let model = named(SQUARES, MASKS).unwrap();
    let mut left_out = vec![false; 64 * 64];
    left_out[10 * 64 + 10] = true;
    let found = delineated(&model, &photo(64, 64), &left_out, &Progress::default()).unwrap();
    let labels = found.outlines.labels();
    for (place, label) in labels.labels.iter().enumerate() {
        let (x, y) = (place % 64, place / 64);
        let is_small = (8..24).contains(&x) && (8..24).contains(&y);
        let is_large = (16..56).contains(&x) && (16..56).contains(&y);
        let wanted = match (x, y) {
            (10, 10) => NOT_ROCK,
            _ if is_small => 2,
            _ if is_large => 1,
            _ => FINES,
        };
        assert_eq!(*label, wanted, "{x} {y}");
    }
    let sure = |number| found.outlines.sure(number).unwrap();
    assert!((sure(1) - 0.7).abs() < 1e-6 && (sure(2) - 0.9).abs() < 1e-6);
}

/// A photo of several parts: what a part's edge cuts is not taken from it, and what two parts show is there once. With
/// `whole` the masks are as much larger as the photo is.
#[test]
fn masks_of_parts_and_of_the_whole() {
    let of_parts = named(SQUARES, &format!("{MASKS}[input]\nmargin = 16\n")).unwrap();
    let outlined = of_parts
        .outline(&photo(96, 64), &Progress::default())
        .unwrap()
        .unwrap();
    // Kept columns 0 to 31, 32 to 63 and 64 to 95 are seen in parts that begin at 0, 16 and 48; every part has both masks,
    // and none is at an edge.
    assert_eq!(outlined.sure.len(), 2 * 3 * 2);
    let whole = named(SQUARES, &format!("{MASKS}[input]\nwhole = true\n")).unwrap();
    let outlined = whole
        .outline(&photo(128, 96), &Progress::default())
        .unwrap()
        .unwrap();
    let areas = outlined.labels.areas();
    // The large one reaches beyond the photo's lower edge; the small one lies on 16 by 16 of it.
    assert_eq!(areas[1..], [80 * 64 - 16 * 16, 32 * 32]);
    assert_eq!(whole.habits(128, 96).sees_every, 2);
}

/// Bytes, channels last, numbers of instances.
#[test]
fn an_image_of_numbers() {
    let text =
        "model = 'm'\n[input]\nlayout = 'nhwc'\nchannels = 'gray'\n[[output]]\nis = 'labels'\n";
    let model = named(NUMBERS, text).unwrap();
    let stripes = RgbImage::from_fn(64, 40, |x, _| Rgb([(x / 16 * 70) as u8; 3]));
    let outlined = model
        .outline(&stripes, &Progress::default())
        .unwrap()
        .unwrap();
    // 0, 70, 140 and 210 over 64, rounded down.
    let row: Vec<u32> = (0..4)
        .map(|stripe| outlined.labels.labels[stripe * 16 + 8])
        .collect();
    assert_eq!(row[0], FINES);
    assert!(row[1] != row[2] && row[2] != row[3] && row[1] != FINES);
    assert_eq!(outlined.labels.areas()[1..], [16 * 40; 3]);
}

/// Three detections, of which two are of one fragment; the mask of the third is what its prototypes leave of its box.
#[test]
fn detections_as_yolo_gives_them() {
    let text = "model = 'm'\n[[output]]\nis = 'detections'\nname = 'output0'\n[[output]]\nis = 'prototypes'\nname = 'output1'\n";
    let outlined = named(YOLO, text).unwrap();
    let outlined = outlined
        .outline(&photo(64, 64), &Progress::default())
        .unwrap()
        .unwrap();
    assert_eq!(outlined.sure.len(), 2);
    let area = |x: usize, y: usize| {
        let label = outlined.labels.labels[y * 64 + x];
        assert_ne!(label, FINES, "{x} {y}");
        outlined.labels.areas()[label as usize]
    };
    assert_eq!(area(16, 16), 16 * 16);
    // Between the prototypes' middles at 30 and 34 the sum goes from -9 to 9.
    assert_eq!(area(44, 40), 24 * 32);
}

/// What cannot be is said in a line, by what is wrong.
#[test]
fn refused() {
    let of = |bytes: &[u8], text: &str| named(bytes, text).unwrap_err().to_string();
    for (bytes, text, wanted) in [
        (STRANGE, MAPS, "Frobnicate"),
        (TWO, MAPS, "2 inputs (x, y)"),
        (&b"not an onnx"[..], MAPS, "cannot be run"),
        (&DARK[..DARK.len() / 2], MAPS, ""),
        (&[], MAPS, ""),
        (
            DARK,
            "model = 'd'\n[[output]]\nis = 'border'\nname = 'edges'\n",
            "no output \"edges\"; it has maps",
        ),
        (
            SQUARES,
            "model = 'd'\n[[output]]\nis = 'masks'\n",
            "masks, scores",
        ),
        (
            SQUARES,
            &format!("{MASKS}[input]\ntile = 128\n"),
            "takes 64 x 64 pixels, the description says 128",
        ),
        (
            DARK,
            &format!("{MAPS}[input]\nchannels = 'gray'\n"),
            "takes 3 channels, the description says 1",
        ),
        (
            DARK,
            &format!("{MAPS}[input]\nlayout = 'nhwc'\n"),
            "takes 1024 x 3 pixels",
        ),
        (
            DARK,
            &format!("name = 'learned'\n{MAPS}"),
            "\"learned\" is no name",
        ),
        (
            DARK,
            "model = 'd'\n[[output]]\nis = 'fines'\n",
            "nothing is outlined by fines",
        ),
        (
            DARK,
            "model = 'd'\n[[output]]\nis = 'scores'\n",
            "nothing is outlined by scores",
        ),
        (
            DARK,
            &format!("{MAPS}[input]\nmean = [1, 2]\n"),
            "3 channels",
        ),
        (DARK, &format!("{MAPS}[input]\nstd = 0\n"), "not above 0"),
    ] {
        let error = of(bytes, text);
        assert!(error.contains(wanted) && !error.contains('\n'), "{error}");
    }
    for (text, line, wanted) in [
        ("", 1, "model"),
        ("model = 'm'\nmodle = 3\n", 2, "modle"),
        ("model = 'm'\n\n[[output]]\nis = 'edge'\n", 4, "edge"),
        (
            "model = 'm'\n[input]\ntile = 'x'\n",
            3,
            "the text \"x\" stands where a whole number",
        ),
    ] {
        let fault = Description::read(text).unwrap_err();
        assert_eq!(fault.line, Some(line), "{fault}");
        assert!(fault.to_string().contains(wanted), "{fault}");
    }
    for text in [
        "model = 'm'\n",
        &format!("{MAPS}[input]\ntile = 8\n"),
        &format!("{MAPS}[input]\nmargin = 600\n"),
        &format!("{MAPS}[input]\nmultiple = 0\n"),
        &format!("{MAPS}[input]\nsizes = []\n"),
        &format!("{MAPS}[input]\nsizes = [2, 1]\n"),
        &format!("{MAPS}[input]\nsizes = [1]\nwhole = true\n"),
        &format!("{MAPS}[input]\nwhite = 0\n"),
        &format!("least_score = 2\n{MAPS}"),
    ] {
        assert!(Description::read(text).is_err(), "{text}");
    }
}

/// What only shows when it runs.
#[test]
fn refused_while_it_runs() {
    let run = |bytes: &[u8], text: &str| {
        let model = named(bytes, text).unwrap();
        let photo = photo(64, 64);
        match model.gives_maps() {
            true => model
                .look(&photo, &Progress::default())
                .map(|_| ())
                .unwrap_err(),
            false => model
                .outline(&photo, &Progress::default())
                .map(|_| ())
                .unwrap_err(),
        }
    };
    let channel = MAPS.replace("channel = 1", "channel = 2");
    for (bytes, text, wanted) in [
        (
            DARK,
            channel.as_str(),
            "gives inside of 1 x 2 x 64 x 64 for 64 x 64 pixels",
        ),
        (
            SQUARES,
            "model = 'm'\n[[output]]\nis = 'border'\nname = 'scores'\n",
            "gives border of 3",
        ),
        (
            SQUARES,
            "model = 'm'\n[[output]]\nis = 'masks'\nname = 'masks'\n[[output]]\nis = 'scores'\nname = 'masks'\n",
            "gives 3 masks and scores of 3 x 64 x 64",
        ),
        (
            YOLO,
            "model = 'm'\n[[output]]\nis = 'detections'\nname = 'output1'\n[[output]]\nis = 'prototypes'\nname = 'output1'\n",
            "gives detections of 1 x 2 x 16 x 16",
        ),
    ] {
        let error = run(bytes, text).to_string();
        assert!(error.contains(wanted), "{error}");
    }
}

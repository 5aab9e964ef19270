//! The report's tables: cameras and photos.

use glam::DVec3;

use super::{ReconstructionReport, SolvedCamera, SolvedPhoto};
use crate::camera::Distortion;
use crate::html_page::{Cell, NONE, names, paragraph, table};
use crate::numbers::significant_digits;

pub(super) fn cameras(report: &ReconstructionReport<'_>) -> String {
    let head = names(&[
        "Camera",
        "Photos",
        "Pixels",
        "fx, px",
        "fy, px",
        "\u{b1} %",
        "Stated, px",
        "cx, px",
        "cy, px",
        "Lens",
        "Coefficients",
    ]);
    let rows = report.cameras.iter().enumerate().map(|(number, solved)| {
        let SolvedCamera {
            camera,
            focal_percent,
            stated_focal,
        } = solved;
        let its = report.photos.iter().filter(|photo| photo.camera == number);
        let px = |length: f64| format!("{length:.2}");
        vec![
            Cell::from(camera.name.as_str()),
            its.count().to_string().into(),
            format!("{} \u{d7} {}", camera.width, camera.height).into(),
            px(camera.fx).into(),
            px(camera.fy).into(),
            focal_percent.map_or(NONE.to_owned(), two_digits).into(),
            stated_focal.map_or(NONE.to_owned(), px).into(),
            px(camera.cx).into(),
            px(camera.cy).into(),
            camera.distortion.name().into(),
            coefficients(&camera.distortion).into(),
        ]
    });
    table(&head, rows.collect())
}

/// Up to the last that is not zero.
fn coefficients(lens: &Distortion) -> String {
    let Distortion::Brown(brown) = lens else {
        return NONE.to_owned();
    };
    let all = brown.coefficients();
    let last = all.iter().rposition(|c| *c != 0.0).map_or(0, |at| at + 1);
    let words = all[..last]
        .iter()
        .zip(["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"]);
    let words: Vec<String> = words
        .map(|(c, name)| format!("{name} {}", minus(format!("{c:.5}"))))
        .collect();
    words.join(", ")
}

pub(super) fn photos(report: &ReconstructionReport<'_>) -> String {
    let head = names(&[
        "Photo",
        "Points",
        "Reprojection, px rms",
        "Off its receiver, east",
        "north",
        "up",
        "\u{b1} level",
        "\u{b1} up",
        "\u{b1} angle, \u{b0}",
    ]);
    let rows = report.photos.iter().map(|photo| {
        let SolvedPhoto {
            name,
            points,
            reprojection_px,
            off_receiver,
            deviation,
            ..
        } = photo;
        let off = |axis: usize| match off_receiver {
            Some(receiver) if receiver.used => signed(receiver.off[axis]).into(),
            Some(receiver) => format!("{} (not used)", signed(receiver.off[axis])).into(),
            None => Cell::from(NONE),
        };
        let or_none = |number: Option<f64>| Cell::from(number.map_or(NONE.to_owned(), two_digits));
        let [level, up, angle] = match deviation {
            Some((place, angle)) => [place.x.max(place.y), place.z, *angle].map(Some),
            None => [None; 3],
        };
        vec![
            Cell::from(*name),
            points.to_string().into(),
            or_none(*reprojection_px),
            off(0),
            off(1),
            off(2),
            or_none(level),
            or_none(up),
            or_none(angle),
        ]
    });
    table(&head, rows.collect())
}

/// How well all receivers agree with the model.
pub(super) fn residuals_in_words(report: &ReconstructionReport<'_>) -> String {
    let receivers = report.photos.iter().filter_map(|photo| photo.off_receiver);
    let used: Vec<DVec3> = (receivers.filter(|receiver| receiver.used))
        .map(|receiver| receiver.off)
        .collect();
    if used.is_empty() {
        return paragraph("No photo's own position was used.");
    }
    let squares: DVec3 = used.iter().map(|off| off * off).sum();
    let rms = squares / used.len() as f64;
    let rms = [rms.x.sqrt(), rms.y.sqrt(), rms.z.sqrt()].map(two_digits);
    paragraph(&format!(
        "Cameras lie off the {} positions that were used by {} to the east, {} to the north and {} up (root \
         mean square).",
        used.len(),
        rms[0],
        rms[1],
        rms[2]
    ))
}

fn two_digits(number: f64) -> String {
    significant_digits(number, 2)
}

/// To a thousandth of the unit, with its sign.
fn signed(length: f64) -> String {
    // What rounds to nothing has no sign.
    match length.abs() < 0.000_5 {
        true => "0.000".to_owned(),
        false => minus(format!("{length:+.3}")),
    }
}

fn minus(text: String) -> String {
    text.replace('-', "\u{2212}")
}

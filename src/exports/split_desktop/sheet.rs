//! The sheet to type scales from: one HTML file without scripts, for a screen or A4 paper.

use std::fmt::Write;

use super::objects::PhotoObject;
use super::photo_names::PhotoNames;
use super::{CheckedInput, ExportRequest};
use crate::flight::{Verdict, compare_names};
use crate::markup::escaped;
use crate::numbers::{farther_percent, significant_digits};
use crate::scale::{Ground, ImageKind, ScaleEstimate, ScalePair};
use crate::units::{LengthUnit, in_words};
use crate::{PHOTO_COLUMNS, PhotoColumn, PhotoLine, ScaleReport};

const STYLE: &str = include_str!("sheet.css");

/// The units in which every scale is given, beside the chosen one.
const UNITS: [LengthUnit; 4] = [
    LengthUnit::Metre,
    LengthUnit::Centimetre,
    LengthUnit::Inch,
    LengthUnit::Foot,
];

/// Digits of a scale without an interval: typing fewer than five would add an error, more would only add typing.
const DIGITS: u8 = 5;

/// The sheet of the report's photos; `pictures` and `objects` have an entry for each photo of the
/// flight.
pub(super) fn html(
    request: &ExportRequest<'_>,
    report: &ScaleReport<'_>,
    pictures: &[Result<PhotoNames, String>],
    objects: &[Vec<PhotoObject<'_>>],
    inputs: &[CheckedInput],
    warnings: &[String],
) -> String {
    let title = escaped(report.flight());
    let mut rows = String::new();
    // As Split-Desktop and every file manager list the image files: so the eye goes down both lists.
    let mut lines: Vec<PhotoLine<'_>> = report.lines().collect();
    let listed = |line: &PhotoLine<'_>| match pictures.get(line.index) {
        Some(Ok(names)) => names.photo.clone(),
        _ => line.photo.name().to_owned(),
    };
    lines.sort_by(|a, b| compare_names(&listed(a), &listed(b)));
    for (line, number) in lines.iter().zip(1_usize..) {
        let picture = pictures.get(line.index);
        let picture = picture.map_or(Err("no pictures"), |names| {
            names.as_ref().map_err(String::as_str)
        });
        let objects = objects.get(line.index).map_or(&[][..], Vec::as_slice);
        rows += &row(number, line, picture, objects);
    }
    let headings: String = scale_columns()
        .filter_map(|column| Some(format!("<th>{}</th>", column.sheet?)))
        .collect();
    let (image, where_from) = match report.image() {
        ImageKind::Undistorted => (
            "the undistorted photos",
            "Open the photos in <b>photos/</b>, not the originals: the scales hold for the undistorted ones.",
        ),
        ImageKind::AsShot => (
            "the photos as shot",
            "The photos in <b>photos/</b> are copies of the originals.",
        ),
    };
    let what = match request.review.flight().parts().pair {
        ScalePair::Fitted => {
            "The big scale is the <b>fitted</b> one, of the best line through the scale of all pixels; that of the four corners stands below it."
        }
        ScalePair::Corners => {
            "The big scale is that of the four <b>corners</b>; the fitted one, of the best line through the scale of all pixels, stands below it."
        }
    };
    let intervals = meaning_of_intervals(report);
    let unit = report.unit();
    let total = request.review.count();
    let all_warnings: Vec<&String> = request.from.warnings.iter().chain(warnings).collect();
    let noticed = match all_warnings.len() {
        0 => String::new(),
        1 => " There is <b>1 warning</b>, at the end.".to_owned(),
        n => format!(" There are <b>{n} warnings</b>, at the end."),
    };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}: scales</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n\
         <p>Image scales for Split-Desktop in <b>pixels per {unit}</b>, of {image}. {where_from}</p>\n\
         <p>{what}</p>\n{intervals}\
         <p class=\"small\">{} of {total} photos, in the order of their names.{noticed}</p>\n\
         <table class=\"photos\">\n<thead><tr><th>Photo with its scale</th><th>Name, verdict</th>\
         {headings}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table>\n\
         {}{}{}{}</body>\n</html>\n",
        lines.len(),
        left_out_list(request),
        warning_list(&all_warnings),
        settings(request),
        input_list(inputs),
    )
}

/// The columns that scales are typed from.
fn scale_columns() -> impl Iterator<Item = &'static PhotoColumn> {
    PHOTO_COLUMNS.iter().filter(|column| column.sheet.is_some())
}

fn row(
    number: usize,
    line: &PhotoLine<'_>,
    picture: Result<&PhotoNames, &str>,
    objects: &[PhotoObject<'_>],
) -> String {
    let photo = line.photo;
    let (name, camera) = (escaped(photo.name()), photo.camera);
    let shown = match picture {
        Ok(names) => format!(
            "<a href=\"{}\"><img src=\"{}\" alt=\"{name} with its scale\"></a>",
            link(&names.overlay),
            link(&names.thumbnail)
        ),
        Err(why) => format!("<div class=\"none\">{}</div>", escaped(why)),
    };
    let file = picture.map_or_else(|_| String::new(), |names| {
        format!(
            "<div class=\"small\">{} &middot; <span class=\"pixels\">{} &times; {} px</span></div>",
            escaped(&names.photo),
            camera.width,
            camera.height
        )
    });
    let verdict = photo.verdict.as_str();
    let class = verdict.replace(' ', "-");
    let ground = line.ground().map_or_else(String::new, |z| {
        format!(
            ", ground at {} {}",
            significant_digits(z, 6),
            in_words(photo.unit_known.then_some(photo.unit))
        )
    });
    let reasons = match photo.doubts.is_empty() {
        true => String::new(),
        false => {
            let doubts = photo.doubts.iter();
            let items: String = doubts
                .map(|doubt| format!("<li>{}</li>", escaped(&doubt.to_string())))
                .collect();
            format!("<ul class=\"reasons\">{items}</ul>")
        }
    };
    let decided = photo.decided().map_or_else(String::new, |decided| {
        format!("<div class=\"decided\">{}</div>", escaped(&decided))
    });
    let objects: String = objects
        .iter()
        .map(|object| {
            let sentence = object.sentence(line.unit, photo.unit);
            format!("<div class=\"small\">{sentence}</div>")
        })
        .collect();
    let (used, beside) = (photo.pair, photo.pair.other());
    let scales: String = (line.estimates(used).into_iter())
        .zip(line.estimates(beside))
        .map(|(scale, other)| scale_cell(scale, (beside, other), line.unit, camera.width))
        .collect();
    let sureness = sureness(line);
    format!(
        "<tr><td class=\"picture\">{shown}</td><td><div class=\"name\">{number}. {name}</div>{file}\
         <div class=\"verdict {class}\">{verdict}</div>\
         <div class=\"small\">{} of 4 corners on the surface{ground}</div>{sureness}{reasons}{decided}{objects}</td>{scales}</tr>\n",
        photo.corners_on_surface().unwrap_or(0),
    )
}

/// How well a line from top to bottom describes the photo, and what its intervals leave out.
fn sureness(line: &PhotoLine<'_>) -> String {
    let mut said = Vec::new();
    if let Some(fitted) = line.fitted() {
        let covered = fitted.covered * 100.0;
        said.push(format!(
            "off the line {:.1} % (worst {:.0} %), {covered:.0} % of the photo shows the surface",
            fitted.rms_percent, fitted.worst_percent
        ));
    }
    if let Some(difference) = line.photo.difference() {
        said.push(difference.to_string());
    }
    if let Some(uncertainty) = line.uncertainty() {
        let names = uncertainty.not_counted_in_words(line.photo.pair);
        if !names.is_empty() {
            said.push(format!("errors not counted: {}", names.join(", ")));
        }
    }
    said.iter()
        .map(|sentence| format!("<div class=\"small\">{sentence}</div>"))
        .collect()
}

/// What an interval means, where a photo of the report has one.
fn meaning_of_intervals(report: &ScaleReport<'_>) -> String {
    let percents = report.lines().flat_map(|line| {
        let estimates = line.estimates(line.photo.pair);
        estimates.into_iter().flatten().filter_map(|estimate| {
            let interval = estimate.interval?;
            let farther = farther_percent(estimate.value, interval.low, interval.high);
            Some((farther, estimate.percent()?))
        })
    });
    let Some((_, percent)) = percents.max_by(|(a, _), (b, _)| a.total_cmp(b)) else {
        return String::new();
    };
    let shared = report.shared();
    let shared = shared.map_or_else(String::new, |shared| format!(" {shared}."));
    format!(
        "<p>In 95 of 100 photos the true scale lies within the interval (&plusmn;), given the errors that are counted.{shared} \
         All sizes move with the scale: at the widest interval here P80 is known to &plusmn; {percent} from the scale.</p>\n"
    )
}

/// A scale with the digits that its interval allows, big, and in the other units; it holds for images
/// of this width alone. `beside` is what the other pair says.
fn scale_cell(
    scale: Option<ScaleEstimate>,
    beside: (ScalePair, Option<ScaleEstimate>),
    unit: LengthUnit,
    width: u32,
) -> String {
    let (pair, other) = beside;
    let beside = other.map_or_else(
        || "no scale".to_owned(),
        |other| format!("{} px/{unit}", other.text(DIGITS)),
    );
    let beside = format!("<div class=\"small\">{}: {beside}</div>", pair.as_str());
    let Some(scale) = scale else {
        return format!(
            "<td class=\"scale\"><div class=\"big missing\">no scale</div>{beside}</td>"
        );
    };
    let mut others = String::new();
    for other in UNITS.into_iter().filter(|other| *other != unit) {
        let scale = scale.times(other.in_units_of(unit));
        // Writing to a String cannot fail.
        let _ = write!(
            others,
            "<tr><td>{}</td><td>px/{other}</td></tr>",
            scale.text(DIGITS)
        );
    }
    // The number to type is big, how sure it is stands below.
    let text = scale.text(DIGITS);
    let (number, interval) = text.split_once(' ').unwrap_or((&text, ""));
    let interval = match scale.percent() {
        Some(percent) => format!("{interval} px/{unit}, {percent}"),
        None => format!("px/{unit}"),
    };
    format!(
        "<td class=\"scale\"><div class=\"big\">{number}</div><div>{interval}</div><div class=\"small\">at {width} px width</div>{beside}<table class=\"others\">{others}</table></td>"
    )
}

/// The photos that the engineer leaves out, with her reasons: the sheet would not show that they are
/// missing.
fn left_out_list(request: &ExportRequest<'_>) -> String {
    let photos = request.review.photos().zip(request.selected);
    let items: String = photos
        .filter(|(photo, is_selected)| photo.verdict == Verdict::LeftOut && !**is_selected)
        .filter_map(|(photo, _)| {
            let why = escaped(&photo.decided()?);
            Some(format!("<li>{}: {why}</li>", escaped(photo.name())))
        })
        .collect();
    match items.is_empty() {
        true => String::new(),
        false => format!("<h2>Left out</h2>\n<ul class=\"reasons\">{items}</ul>\n"),
    }
}

fn warning_list(warnings: &[&String]) -> String {
    if warnings.is_empty() {
        return String::new();
    }
    let items: String = warnings
        .iter()
        .map(|warning| format!("<li>{}</li>", escaped(warning)))
        .collect();
    format!("<h2>Warnings</h2>\n<ul class=\"reasons\">{items}</ul>\n")
}

/// What the scales and the verdicts depend on.
fn settings(request: &ExportRequest<'_>) -> String {
    let settings = request.from.settings;
    let limits = request.review.limits();
    let unit = settings.unit;
    let ground = match settings.ground {
        Ground::Auto => "auto: for each photo the median elevation in its view".to_owned(),
        Ground::At(z) => format!("{z} {unit}"),
    };
    let image = match settings.image {
        ImageKind::Undistorted => "undistorted, with the same K and size",
        ImageKind::AsShot => "as shot",
    };
    let length =
        |length: Option<f64>| length.map_or_else(|| "none".to_owned(), |l| format!("{l} {unit}"));
    // In percent, without the noise of the product.
    let share = |share: f64| (share * 1e6).round() / 1e4;
    let percent = |of_edge: f64| format!("{} % of the footprint's mean edge", share(of_edge));
    let rows = [
        (
            "World unit",
            match settings.unit_known {
                true => unit.to_string(),
                false => "not known".to_owned(),
            },
        ),
        (
            "Coordinate system",
            request.from.crs.unwrap_or("not stated").to_owned(),
        ),
        ("Ground", ground),
        ("Image", image.to_owned()),
        (
            "Scale for Split-Desktop",
            request.review.flight().parts().pair.as_str().to_owned(),
        ),
        ("Longest triangle edge", length(settings.surface.max_edge)),
        ("Thinning", length(settings.surface.thinning)),
        (
            "Doubt: top/bottom ratio above",
            limits.top_bottom_ratio.to_string(),
        ),
        (
            "Doubt: left/right ratio above",
            limits.left_right_ratio.to_string(),
        ),
        ("Doubt: triangle edge above", percent(limits.triangle_share)),
        (
            "Doubt: corner's view flatter than",
            format!("{}°", limits.flattest_angle),
        ),
        (
            "Doubt: surface off the plane by",
            percent(limits.plane_share),
        ),
        (
            "Doubt: pixels off the best line by (rms)",
            format!("{} %", share(limits.off_line_share)),
        ),
        (
            "Doubt: 95 % interval wider than",
            format!("{} %", share(limits.interval_share)),
        ),
        (
            "Program",
            concat!("fragscale ", env!("CARGO_PKG_VERSION")).to_owned(),
        ),
    ];
    let rows: String = rows
        .iter()
        .map(|(name, value)| format!("<tr><td>{name}</td><td>{}</td></tr>\n", escaped(value)))
        .collect();
    format!("<h2>Settings</h2>\n<table class=\"facts\">\n{rows}</table>\n")
}

fn input_list(inputs: &[CheckedInput]) -> String {
    let rows: String = inputs
        .iter()
        .map(|input| {
            format!(
                "<li>{}<div class=\"sum\">{}</div></li>\n",
                escaped(&input.path.display().to_string()),
                escaped(&input.checksum)
            )
        })
        .collect();
    format!("<h2>Input files (SHA-256)</h2>\n<ul class=\"inputs\">\n{rows}</ul>\n")
}

/// A relative address: everything but letters, digits and a few signs as %XX (RFC 3986).
fn link(path: &str) -> String {
    let mut link = String::new();
    for byte in path.bytes() {
        if byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte) {
            link.push(char::from(byte));
        } else {
            let _ = write!(link, "%{byte:02X}");
        }
    }
    link
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::Interval;

    #[test]
    fn links_are_escaped() {
        assert_eq!(link("photos/ä #1.jpg"), "photos/%C3%A4%20%231.jpg");
    }

    fn estimate(value: f64, half: Option<f64>) -> Option<ScaleEstimate> {
        let interval = half.map(|half| Interval {
            standard_error: half / 1.96,
            low: value - half,
            high: value + half,
        });
        Some(ScaleEstimate { value, interval })
    }

    /// 25.6 px/cm are 2560 px/m, 65.024 px/in and 780.288 px/ft exactly.
    #[test]
    fn a_scale_in_all_units() {
        let beside = (ScalePair::Corners, estimate(24.5, None));
        let cell = scale_cell(estimate(25.6, None), beside, LengthUnit::Centimetre, 1280);
        for text in [
            ">25.600</div><div>px/cm<",
            ">at 1280 px width<",
            ">corners: 24.500 px/cm<",
            "<td>2560.0</td><td>px/m",
            "<td>65.024</td><td>px/in",
            "<td>780.29</td><td>px/ft",
        ] {
            assert!(cell.contains(text), "{text} is not in {cell}");
        }
        let none = scale_cell(None, (ScalePair::Fitted, None), LengthUnit::Inch, 1280);
        assert!(none.contains("no scale") && none.contains("fitted: no scale"));
    }

    /// By hand: 0.4 are 2 % of 19.9132 px/cm, which are 1991.32 px/m (± 40), 50.5795 px/in (± 1.016) and
    /// 606.954 px/ft (± 12.19).
    #[test]
    fn a_scale_has_the_digits_of_its_interval() {
        let beside = (ScalePair::Corners, estimate(20.31, Some(1.2)));
        let cell = scale_cell(
            estimate(19.9132, Some(0.4)),
            beside,
            LengthUnit::Centimetre,
            1280,
        );
        for text in [
            ">19.9</div><div>± 0.4 px/cm, 2 %<",
            ">corners: 20.3 ± 1.2 px/cm<",
            "<td>1990 ± 40</td><td>px/m",
            "<td>50.6 ± 1.0</td><td>px/in",
            "<td>607 ± 12</td><td>px/ft",
        ] {
            assert!(cell.contains(text), "{text} is not in {cell}");
        }
    }
}

//! Footprints as KML 2.2 (OGC 07-147r2), draped on the globe's own terrain: the flight's heights are
//! of a datum that no file states reliably.

use std::fmt::Write;

use super::photo_footprint::PhotoFootprint;
use crate::ScaleReport;
use crate::flight::Verdict;
use crate::markup::escaped;
use crate::scale::ScalePair;

/// A placemark a photo, coloured by its verdict.
pub(super) fn document<'a>(
    report: &ScaleReport<'_>,
    footprints: impl Iterator<Item = PhotoFootprint<'a>>,
) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n",
    );
    // Writing to a String cannot fail.
    let _ = writeln!(text, "<name>{}</name>", escaped(report.flight()));
    for (index, verdict) in Verdict::ALL.into_iter().enumerate() {
        // aabbggrr
        let color = match verdict {
            Verdict::Trust => "50af4c",
            Verdict::Accepted => "c8b43c",
            Verdict::Check => "20b0ff",
            Verdict::LeftOut => "909090",
            Verdict::NoScale => "3c3cf0",
        };
        let _ = writeln!(
            text,
            "<Style id=\"v{index}\"><LineStyle><color>ff{color}</color><width>2</width></LineStyle><PolyStyle><color>40{color}</color></PolyStyle></Style>"
        );
    }
    for footprint in footprints.filter(|footprint| !footprint.ring.is_empty()) {
        let photo = footprint.line.photo;
        let mut verdicts = Verdict::ALL.iter();
        let style = verdicts.position(|verdict| *verdict == photo.verdict);
        let style = style.unwrap_or(2);
        let unit = report.unit();
        let both = |pair: ScalePair| {
            let [top, bottom] = footprint
                .line
                .estimates(pair)
                .map(|estimate| estimate.map_or_else(|| "none".to_owned(), |scale| scale.text(5)));
            let name = pair.as_str();
            format!("{name}: top {top} px/{unit}, bottom {bottom} px/{unit}")
        };
        let mut description = format!(
            "{}; {}; {}; {} of 4 corners on the surface",
            both(photo.pair),
            both(photo.pair.other()),
            photo.verdict,
            photo.corners_on_surface().unwrap_or(0)
        );
        // Some notes are reasons, too.
        let reasons = photo.reasons_and_decision();
        let notes = photo.notes().into_iter();
        let notes = notes.filter(|note| !reasons.contains(note));
        for said in reasons.iter().cloned().chain(notes) {
            description += &format!("; {said}");
        }
        let positions: Vec<String> = footprint
            .ring
            .iter()
            .map(|position| {
                let numbers: Vec<String> = position.iter().map(f64::to_string).collect();
                numbers.join(",")
            })
            .collect();
        let _ = writeln!(
            text,
            "<Placemark><name>{}</name><description>{}</description><styleUrl>#v{style}</styleUrl><Polygon><tessellate>1</tessellate><altitudeMode>clampToGround</altitudeMode><outerBoundaryIs><LinearRing><coordinates>{}</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>",
            escaped(photo.name()),
            escaped(&description),
            positions.join(" ")
        );
    }
    text += "</Document>\n</kml>\n";
    text
}

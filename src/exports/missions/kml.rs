//! KML 2.2 (OGC 07-147r2) to look at: the stops, the path between them, the place of take-off, fences.
//! Absolute heights count from the geoid EGM96 there (section 9.20); heights above the take-off become
//! absolute where its elevation is known, and are shown above the ground where it is not.

use std::fmt::Write;

use fragscale_core::plan::{Above, Mission, Stop};

use super::{angle, decimal, degrees, metres};
use crate::files::SVG_MARK;
use crate::markup::escaped;

/// The file of a mission.
pub(super) fn bytes(mission: &Mission, notes: &mut Vec<String>) -> Vec<u8> {
    let heights: Option<Vec<f64>> = (mission.stops.iter())
        .map(|stop| mission.height_above(stop.latitude, stop.longitude, stop.height, Above::Geoid))
        .collect();
    let mode = if heights.is_some() {
        "absolute"
    } else {
        "relativeToGround"
    };
    if heights.is_none() {
        notes.push("the elevation of the take-off is not known: KML shows heights above the ground below each stop".to_owned());
    }
    let heights = heights.unwrap_or_else(|| {
        mission
            .stops
            .iter()
            .map(|stop| stop.height.metres)
            .collect()
    });
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{SVG_MARK}<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n<name>{}</name>\n",
        escaped(&mission.name)
    );
    for (id, color) in [
        ("path", "ff20b0ff"),
        ("in", "ff50af4c"),
        ("out", "ff3c3cf0"),
    ] {
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "<Style id=\"{id}\"><LineStyle><color>{color}</color><width>2</width></LineStyle><PolyStyle><fill>0</fill></PolyStyle></Style>"
        );
    }
    if let Some(take_off) = &mission.take_off {
        let _ = writeln!(
            text,
            "<Placemark><name>take-off</name><Point><altitudeMode>clampToGround</altitudeMode><coordinates>{},{}</coordinates></Point></Placemark>",
            degrees(take_off.longitude),
            degrees(take_off.latitude)
        );
    }
    let mut path = Vec::new();
    for ((stop, height), number) in mission.stops.iter().zip(heights).zip(1..) {
        let place = format!(
            "{},{},{}",
            degrees(stop.longitude),
            degrees(stop.latitude),
            metres(height)
        );
        let _ = writeln!(
            text,
            "<Placemark><name>{number}</name><description>{}</description><Point><extrude>1</extrude><altitudeMode>{mode}</altitudeMode><coordinates>{place}</coordinates></Point></Placemark>",
            escaped(&told(stop))
        );
        path.push(place);
    }
    // A line has two places at least.
    if path.len() > 1 {
        let _ = writeln!(
            text,
            "<Placemark><name>path</name><styleUrl>#path</styleUrl><LineString><altitudeMode>{mode}</altitudeMode><coordinates>{}</coordinates></LineString></Placemark>",
            path.join(" ")
        );
    }
    for fence in &mission.fences {
        let (name, style) = match fence.keep_in {
            true => ("keep in", "in"),
            false => ("keep out", "out"),
        };
        let ring = fence.corners.iter().chain(fence.corners.first());
        let ring: Vec<String> = ring
            .map(|&[latitude, longitude]| format!("{},{}", degrees(longitude), degrees(latitude)))
            .collect();
        let _ = writeln!(
            text,
            "<Placemark><name>{name}</name><styleUrl>#{style}</styleUrl><Polygon><tessellate>1</tessellate><altitudeMode>clampToGround</altitudeMode><outerBoundaryIs><LinearRing><coordinates>{}</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>",
            ring.join(" ")
        );
    }
    text += "</Document>\n</kml>\n";
    text.into_bytes()
}

/// What a stop says, in a sentence.
fn told(stop: &Stop) -> String {
    let mut text = format!(
        "{} m above {}",
        metres(stop.height.metres),
        stop.height.above.in_words()
    );
    if let Some(heading) = stop.heading {
        text += &format!("; heading {} degrees", angle(heading));
    }
    if let Some(pitch) = stop.gimbal_pitch {
        text += &format!("; gimbal {} degrees", angle(pitch));
    }
    if stop.settle > 0.0 {
        text += &format!("; waits {} s", decimal(stop.settle, 3));
    }
    if let Some(photo) = &stop.photo {
        text += "; photo";
        if let Some(name) = &photo.name {
            text += &format!(" {name}");
        }
    }
    text
}

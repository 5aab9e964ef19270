//! Areas of plans from maps: GeoJSON and KML.

use std::fs;

use serde_json::Value;

use super::plan::{AREA, plane};
use crate::common::fragscale;

/// The corners of [`AREA`], and of a triangle in its middle, as PROJ 9 has them: EPSG:32632 to EPSG:4326, longitude
/// first.
const ON_EARTH: [[f64; 2]; 4] = [
    [8.320_594_219_2, 48.751_550_045_6],
    [8.321_682_494_8, 48.751_556_456_6],
    [8.321_672_807_2, 48.752_276_086_6],
    [8.320_584_516_1, 48.752_269_675_4],
];
const MISFIRE: [[f64; 2]; 3] = [
    [8.321_066_097_6, 48.751_867_689_8],
    [8.321_202_132_9, 48.751_868_491_2],
    [8.321_200_921_1, 48.751_958_444_9],
];

/// An area from a map is the one that is typed, and what is kept out of is, too.
#[test]
fn areas_are_read_from_maps() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let write = |name: &str, text: String| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let ring = |corners: &[[f64; 2]]| {
        let mut ring = corners.to_vec();
        ring.push(corners[0]);
        ring
    };
    let area = write(
        "area.geojson",
        format!(
            "{{\"type\": \"Polygon\", \"coordinates\": [{:?}]}}",
            ring(&ON_EARTH)
        ),
    );
    let places = MISFIRE.map(|[longitude, latitude]| format!("{longitude},{latitude},0"));
    let polygon = format!(
        "<Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>{} {}</coordinates></LinearRing>\
         </outerBoundaryIs></Polygon></Placemark>",
        places.join(" "),
        places[0]
    );
    let kml = format!(
        "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document>{polygon}</Document></kml>"
    );
    let keep_out = write("misfires.kml", kml.clone());
    let scale = [
        "--drone",
        "mavic-3e",
        "--scale",
        "0.5 px/cm",
        "--format",
        "json",
    ];
    let told = |places: &[&str]| -> Value {
        let output = fragscale(&[&["plan", &flight][..], &scale, places].concat());
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let typed = told(&[
        "--area",
        AREA,
        "--keep-out",
        "450095,5400095;450105,5400095;450105,5400105",
    ]);
    let read = told(&["--area", &area, "--keep-out", &keep_out]);
    for what in ["area", "photos", "refused"] {
        let count = |told: &Value| told[what].as_array().unwrap().len();
        assert_eq!(count(&typed), count(&read), "{what}");
    }
    assert!(!typed["refused"].as_array().unwrap().is_empty());
    let corners = |told: &Value| -> Vec<f64> {
        let all = [&told["area"], &told["keep_out"][0]].map(|area| area.as_array().unwrap());
        let numbers = all
            .into_iter()
            .flatten()
            .flat_map(|corner| corner.as_array().unwrap());
        numbers.map(|number| number.as_f64().unwrap()).collect()
    };
    for (typed, read) in corners(&typed).into_iter().zip(corners(&read)) {
        // Ten decimals of a degree are hundredths of a millimetre.
        assert!((typed - read).abs() < 1e-3, "{typed} {read}");
    }
    // Two polygons are no one area; a cloud alone says nothing of the Earth.
    let two = write("two.kml", kml.replace(&polygon, &polygon.repeat(2)));
    let refused = |arguments: &[&str]| {
        let output = fragscale(&[&["plan"][..], arguments, &scale].concat());
        assert_eq!(output.status.code(), Some(1));
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(error.lines().count(), 1, "{error}");
        error
    };
    let error = refused(&[&flight, "--area", &two]);
    assert!(
        error.contains("it holds 2 polygons, where one is needed"),
        "{error}"
    );
    // A path beside the polygon keeps nothing out, though somebody may think so.
    let path = polygon
        .replace("Polygon", "Path")
        .replace("<Path><outerBoundaryIs><LinearRing>", "<LineString>");
    let path = path.replace("</LinearRing></outerBoundaryIs></Path>", "</LineString>");
    let mixed = write(
        "mixed.kml",
        kml.replace(&polygon, &(polygon.clone() + &path)),
    );
    let error = refused(&[&flight, "--area", AREA, "--keep-out", &mixed]);
    assert!(
        error.contains("beside polygons it holds 0 points and 1 line, which keep nothing out"),
        "{error}"
    );
    // What is read is not written over.
    let error = refused(&[&flight, "--area", &area, "-o", &area, "--force"]);
    assert!(
        error.starts_with("error: ") && error.contains("area.geojson"),
        "{error}"
    );
    assert!(fs::read_to_string(&area).unwrap().starts_with("{\"type\""));
    let cloud = folder.path().join("plane.xyz").display().to_string();
    let error = refused(&[&cloud, "--unit", "m", "--area", &area]);
    assert!(
        error.contains("nobody says in which coordinate system"),
        "{error}"
    );
    told(&["--area", AREA, "--keep-out", &two]);
}

/// A volume in a polygon of a map is that in the same polygon in the world; of two it is asked which.
#[test]
fn volumes_are_measured_in_polygons_of_maps() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let corners = ON_EARTH.map(|[longitude, latitude]| format!("[{longitude},{latitude}]"));
    let rings = format!("[[{},{}]]", corners.join(","), corners[0]);
    let write = |name: &str, text: String| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let one = write(
        "one.geojson",
        format!("{{\"type\": \"Polygon\", \"coordinates\": {rings}}}"),
    );
    let two = write(
        "two.geojson",
        format!("{{\"type\": \"MultiPolygon\", \"coordinates\": [{rings}, {rings}]}}"),
    );
    let volume = |flight: &str, polygon: &str| {
        let base = ["--base", "200", "--format", "json"];
        fragscale(&[&["volume", flight, "--polygon", polygon][..], &base].concat())
    };
    let fill = |polygon: &str| -> f64 {
        let output = volume(&flight, polygon);
        let told: Value = serde_json::from_slice(&output.stdout).unwrap();
        told["fill"].as_f64().unwrap()
    };
    // 80 m x 80 m, and 300 m less half of the way to the middle, over 200 m.
    assert!((fill(AREA) - 6400.0 * 50.0).abs() < 1e-3);
    assert!((fill(&one) / fill(AREA) - 1.0).abs() < 1e-4);
    let error = |output: std::process::Output| {
        assert_eq!(output.status.code(), Some(1));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let said = error(volume(&flight, &two));
    assert!(
        said.contains("it holds 2 polygons, where one is needed"),
        "{said}"
    );
    // A cloud says nothing of the Earth.
    let cloud = folder.path().join("plane.xyz").display().to_string();
    let said = error(volume(&cloud, &one));
    assert!(
        said.contains("nobody says in which coordinate system"),
        "{said}"
    );
    // The map takes both at once.
    let map = folder.path().join("map.svg").display().to_string();
    let output = fragscale(&["map", &flight, "-o", &map, "--polygon", &two]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
}

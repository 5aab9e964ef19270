//! Files as QGIS, geojson.io and Google Earth write them, and what is wrong with others.

use std::io::Write;

use super::*;

/// Bench 7 of a quarry, longitude and latitude.
const CORNERS: [[f64; 2]; 4] = [
    [8.123_456_7, 48.857_012_3],
    [8.124_456_7, 48.857_012_3],
    [8.124_456_7, 48.858_012_3],
    [8.123_456_7, 48.858_012_3],
];

fn degrees(found: &[Vec<Geographic>]) -> Vec<Vec<[f64; 2]>> {
    let of = |polygon: &Vec<Geographic>| {
        polygon
            .iter()
            .map(|place| [place.longitude, place.latitude])
            .collect()
    };
    found.iter().map(of).collect()
}

fn refused(text: &str) -> Fault {
    areas(text.as_bytes()).unwrap_err()
}

/// As QGIS exports a layer; the ring ends where it began.
const QGIS: &str = r#"{
"type": "FeatureCollection",
"name": "bench7",
"crs": { "type": "name", "properties": { "name": "urn:ogc:def:crs:OGC:1.3:CRS84" } },
"features": [
{ "type": "Feature", "properties": { "id": 1, "name": "Bench \u00fc" }, "geometry": { "type": "MultiPolygon", "coordinates": [ [ [ [ 8.1234567, 48.8570123 ], [ 8.1244567, 48.8570123 ], [ 8.1244567, 48.8580123 ], [ 8.1234567, 48.8580123 ], [ 8.1234567, 48.8570123 ] ] ] ] } },
{ "type": "Feature", "properties": { "id": 2 }, "geometry": { "type": "Point", "coordinates": [ 8.1, 48.8 ] } },
{ "type": "Feature", "properties": { "id": 3 }, "geometry": null }
]
}
"#;

/// As Google Earth saves a drawn polygon: heights, tabs, a style.
const EARTH: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2">
<Document>
	<name>Bench 7.kml</name>
	<Style id="s"><PolyStyle><color>7f0000ff</color></PolyStyle></Style>
	<Folder>
	<Placemark>
		<name>Bench 7</name>
		<Polygon>
			<tessellate>1</tessellate>
			<outerBoundaryIs>
				<LinearRing>
					<coordinates>
						8.1234567,48.8570123,312.5 8.1244567,48.8570123,312.5 8.1244567,48.8580123,0
						8.1234567,48.8580123,0 8.1234567,48.8570123,312.5
					</coordinates>
				</LinearRing>
			</outerBoundaryIs>
		</Polygon>
	</Placemark>
	<Placemark><name>Gate</name><Point><coordinates>8.1,48.8,0</coordinates></Point></Placemark>
	</Folder>
</Document>
</kml>
"#;

#[test]
fn polygons_are_read_from_what_maps_write() {
    let expected = vec![CORNERS.to_vec()];
    assert_eq!(degrees(&areas(QGIS.as_bytes()).unwrap().polygons), expected);
    assert_eq!(
        degrees(&areas(EARTH.as_bytes()).unwrap().polygons),
        expected
    );
    for text in [QGIS, EARTH] {
        let found = areas(text.as_bytes()).unwrap();
        assert_eq!(found.others().unwrap(), "1 point and 0 lines");
    }
    // A path that ends where it began, and a ring for itself, are none.
    let path = "<Placemark><LineString><coordinates>8,48 9,48 9,49 8,48</coordinates></LineString></Placemark>\
                <Placemark><LinearRing><coordinates>8,48 9,48 9,49 8,48</coordinates></LinearRing></Placemark></Folder>";
    let with_path = areas(EARTH.replace("</Folder>", path).as_bytes()).unwrap();
    assert_eq!((with_path.points, with_path.lines), (1, 2));
    // A byte order mark, and a ring that does not end where it began.
    let corners = format!("{CORNERS:?}");
    let bare = format!("\u{feff}{{\"coordinates\":[{corners}],\"type\":\"Polygon\"}}");
    assert_eq!(degrees(&areas(bare.as_bytes()).unwrap().polygons), expected);
    // Two polygons, one in a collection of geometries; heights.
    let two = r#"{"type":"GeometryCollection","geometries":[
        {"type":"Polygon","coordinates":[[[7,50,3],[7.1,50,3],[7.1,50.1,3],[7,50,3]]]},
        {"type":"MultiPolygon","coordinates":[[[[-7,-50],[-7.1,-50],[-7.1,-50.1],[-7,-50]]]]}]}"#;
    let found = degrees(&areas(two.as_bytes()).unwrap().polygons);
    assert_eq!(found[0], [[7.0, 50.0], [7.1, 50.0], [7.1, 50.1]]);
    assert_eq!(found[1], [[-7.0, -50.0], [-7.1, -50.0], [-7.1, -50.1]]);
    assert_eq!(found.len(), 2);
}

#[test]
fn a_kmz_is_the_kml_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bench.kmz");
    let mut zip = zip::ZipWriter::new(std::fs::File::create(&path).unwrap());
    zip.start_file("doc.kml", zip::write::SimpleFileOptions::default())
        .unwrap();
    zip.write_all(EARTH.as_bytes()).unwrap();
    zip.finish().unwrap();
    assert_eq!(
        degrees(&read_areas(&path).unwrap().polygons),
        [CORNERS.to_vec()]
    );
    assert!(holds_areas(&path) && !holds_areas(folder.path()));
    let broken = areas(b"PK\x03\x04").unwrap_err();
    assert!(broken.what.contains("zip is damaged"), "{broken}");
}

#[test]
fn lists_of_places_are_no_areas() {
    for text in ["1,2\n3,4\n", "# a\n1 2\n", "x,y\n", "", "-1,2"] {
        assert!(!is_areas(text.as_bytes()), "{text}");
    }
    for text in [QGIS, EARTH, "\u{feff} {}", "[1]"] {
        assert!(is_areas(text.as_bytes()), "{text}");
    }
}

/// Who draws a polygon takes its hole, too; for whom it is ground it is refused.
#[test]
fn holes_are_for_who_draws() {
    let ring = "[[8,48],[9,48],[9,49],[8,48]]";
    let hole = "[[8.5,48.1],[8.8,48.1],[8.8,48.4],[8.5,48.1]]";
    let text = format!("{{\"type\":\"Polygon\",\"coordinates\":[{ring},{hole}]}}");
    let corners = [[8.5, 48.1], [8.8, 48.1], [8.8, 48.4]];
    let found = rings(text.as_bytes()).unwrap();
    assert_eq!(found.polygons.len(), 1);
    assert_eq!(degrees(&found.holes), [corners.to_vec()]);
    assert!(areas(text.as_bytes()).is_err());
    let inner = "<innerBoundaryIs><LinearRing><coordinates>8.5,48.1 8.8,48.1 8.8,48.4</coordinates></LinearRing></innerBoundaryIs>";
    let end = "</outerBoundaryIs>";
    let kml = EARTH.replace(end, &format!("{end}{inner}"));
    let found = rings(kml.as_bytes()).unwrap();
    assert_eq!(degrees(&found.polygons), [CORNERS.to_vec()]);
    assert_eq!(degrees(&found.holes), [corners.to_vec()]);
    // Several rings in one boundary, as some write them.
    let second = "<LinearRing><coordinates>8.1,48.1 8.2,48.1 8.2,48.2</coordinates></LinearRing></innerBoundaryIs>";
    let both = inner.replace("</innerBoundaryIs>", second);
    let kml = EARTH.replace(end, &format!("{end}{both}"));
    let found = rings(kml.as_bytes()).unwrap();
    let others = vec![[8.1, 48.1], [8.2, 48.1], [8.2, 48.2]];
    assert_eq!(degrees(&found.holes), [corners.to_vec(), others]);
    assert!(areas(kml.as_bytes()).is_err());
    // One without coordinates beside one with them is said.
    let broken = inner.replace("</innerBoundaryIs>", "<LinearRing/></innerBoundaryIs>");
    let kml = EARTH.replace(end, &format!("{end}{broken}"));
    let fault = rings(kml.as_bytes()).unwrap_err();
    assert_eq!(
        fault.what,
        "polygon 1 ('Bench 7'), hole 2 has no coordinates"
    );
}

/// One line with the place, what is wrong and what to do.
#[test]
fn what_is_no_area_is_said() {
    let polygon =
        |coordinates: &str| format!("{{\"type\":\"Polygon\",\"coordinates\":{coordinates}}}");
    let ring = "[[8,48],[9,48],[9,49],[8,48]]";
    for (text, what) in [
        (polygon(&format!("[{ring},{ring}]")), "polygon 1 has a hole"),
        (
            polygon("[[[8,48],[9,48],[8,48]]]"),
            "polygon 1 has 2 corners, no area",
        ),
        (polygon("[]"), "polygon 1 has no list of corners"),
        (polygon("7"), "polygon 1 has no list of corners"),
        (
            polygon("[[[8,48],[9],[8,49]]]"),
            "polygon 1, corner 2 is no longitude and latitude",
        ),
        (
            polygon("[[[450060,5400060],[450140,5400060],[450140,5400140]]]"),
            "polygon 1, corner 1: 450060, 5400060 are no degrees",
        ),
        // Latitude first, east of 90 degrees.
        (
            polygon("[[[-23.4,119.8],[-23.4,119.9],[-23.5,119.9]]]"),
            "polygon 1, corner 1: -23.4, 119.8: there is no latitude of 119.8 degrees",
        ),
        (
            "{\"type\":\"LineString\",\"coordinates\":[[8,48],[9,48]]}".to_owned(),
            "there is no polygon in it, but 0 points and 1 line",
        ),
        (
            "{\"type\":\"FeatureCollection\",\"features\":[]}".to_owned(),
            "there is no polygon in it",
        ),
        (
            "{\"type\":\"Polyhedron\"}".to_owned(),
            "\"type\" is \"Polyhedron\", which GeoJSON has not",
        ),
        (
            QGIS.replace("OGC:1.3:CRS84", "EPSG::25832"),
            "its coordinates are in urn:ogc:def:crs:EPSG::25832, not in degrees of WGS 84",
        ),
        ("<gpx/>".to_owned(), "XML that begins with <gpx> is no KML"),
        ("<kml/>".to_owned(), "there is no polygon in it"),
        (String::new(), "it is empty"),
        ("8,48".to_owned(), "it is neither GeoJSON nor KML"),
    ] {
        let fault = refused(&text);
        assert_eq!(fault.what, what);
        assert!(!fault.remedy.is_empty());
    }
    let latitude_first = refused(&polygon("[[[-23.4,119.8],[-23.4,119.9],[-23.5,119.9]]]"));
    assert_eq!(
        latitude_first.remedy,
        "write the longitude first, then the latitude"
    );
}

/// Faults of KML have their line and the name of their polygon.
#[test]
fn faults_of_kml_have_their_line() {
    let hole = EARTH.replace("</outerBoundaryIs>", "</outerBoundaryIs><innerBoundaryIs/>");
    let fault = refused(&hole);
    assert_eq!(
        (fault.line, fault.what.as_str()),
        (Some(9), "polygon 1 ('Bench 7') has a hole")
    );
    let spaces = EARTH.replace("8.1244567,48.8570123,312.5", "8.1244567, 48.8570123");
    let fault = refused(&spaces);
    assert_eq!(fault.line, Some(13));
    assert_eq!(
        fault.what,
        "polygon 1 ('Bench 7'), corner 2: '8.1244567,' is no longitude,latitude"
    );
    let swapped = EARTH.replace("8.1244567,48.8570123", "48.857,118.1");
    let fault = refused(&swapped);
    assert_eq!(
        (fault.line, fault.remedy.as_str()),
        (Some(13), "write the longitude first, then the latitude")
    );
    let none = refused(&EARTH.replace("coordinates", "places"));
    assert_eq!(none.what, "polygon 1 ('Bench 7') has no coordinates");
}

#[test]
fn what_is_large_or_deep_ends_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.geojson");
    std::fs::write(&path, " ".repeat(9 << 20)).unwrap();
    let error = read_areas(&path).unwrap_err().to_string();
    assert!(
        error.contains("it is larger than 8 MB, no areas"),
        "{error}"
    );
    let deep = "{\"type\":\"Feature\",\"geometry\":".repeat(100_000);
    assert!(areas(deep.as_bytes()).is_err());
    let many = format!(
        "{{\"type\":\"Polygon\",\"coordinates\":[[{}[8,48]]]}}",
        "[8,48],[9,48],".repeat(60_000)
    );
    assert!(
        refused(&many)
            .what
            .contains("120001 corners, more than 100000")
    );
}

proptest::proptest! {
    #[test]
    fn no_bytes_panic(bytes in proptest::collection::vec(proptest::num::u8::ANY, 0..200), at in 0..1500_usize) {
        let _ = areas(&bytes);
        for text in [QGIS, EARTH] {
            let mut cut = text.as_bytes().to_vec();
            cut.truncate(at);
            cut.extend(&bytes);
            let _ = areas(&cut);
        }
    }
}

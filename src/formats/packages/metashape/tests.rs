//! Documents by hand with answers by hand, and the real projects of the shared data.

use glam::{DMat3, DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::camera::{Agisoft, AgisoftProjection, Camera, Distortion};
use crate::geodesy::{Geographic, ecef_from_geographic, enu_axes};
use crate::geometry::{Ray, median};
use crate::jobs::Progress;
use crate::read_project as read_any;
use crate::read_text;
use crate::surface::{Cloud, Surface};
use fragscale_test_data::shared_data;

/// A chunk with one sensor of 400 x 300 pixels whose calibration holds `lens`.
fn document(lens: &str, cameras: &str, rest: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<document version=\"1.5.0\">\n\
         <chunk label=\"Chunk 1\" enabled=\"true\">\n{}\n<cameras>{cameras}</cameras>{rest}</chunk>\n</document>\n",
        sensor(lens)
    )
}

fn sensor(lens: &str) -> String {
    format!(
        "<sensors><sensor id=\"0\" label=\"one\" type=\"frame\"><resolution width=\"400\" height=\"300\"/>\
         <calibration type=\"frame\" class=\"initial\"><f>1</f></calibration>\
         <calibration type=\"frame\" class=\"adjusted\"><resolution width=\"400\" height=\"300\"/>{lens}\
         </calibration><covariance><params>f</params><coeffs>1e0</coeffs></covariance></sensor></sensors>"
    )
}

/// A camera of sensor 0 at (x, 0, 0) with the chunk's axes.
fn camera(id: u32, x: f64, attributes: &str) -> String {
    format!(
        "<camera id=\"{id}\" sensor_id=\"0\" label=\"p{id}\" {attributes}>\
         <transform>1 0 0 {x} 0 1 0 0 0 0 1 0 0 0 0 1</transform></camera>"
    )
}

fn lens_of(lens: &str) -> Camera {
    let text = document(lens, &camera(0, 0.0, ""), "");
    read_xml(&text).unwrap().cameras.remove(0)
}

fn names(found: &Reconstruction) -> Vec<&str> {
    found
        .photos
        .iter()
        .map(|photo| photo.name.as_str())
        .collect()
}

fn near(a: DVec3, b: DVec3) -> bool {
    (a - b).length() < 1e-12
}

/// The manual's formula by hand at (x, y) = (0.5, -0.25), r2 = 0.3125: fx = f + b1, skew = b2, cx
/// from the middle, p1 with r2 + 2 x2 in x. With p1 and p2 as OpenCV has them u would be 2.2 px off.
#[test]
fn a_pixel_by_hand() {
    let camera = lens_of(
        "<f>200</f><cx>3</cx><cy>-4</cy><b1>2</b1><b2>0.5</b2><k1>0.1</k1><k2>-0.02</k2><k3>0.003</k3>\
         <p1>0.01</p1><p2>-0.002</p2>",
    );
    assert_eq!((camera.fx, camera.fy, camera.skew), (202.0, 200.0, 0.5));
    assert_eq!((camera.cx, camera.cy), (203.0, 146.0));
    assert_eq!(camera.distortion.name(), "brown");
    let (x, y, r2) = (0.5, -0.25, 0.3125_f64);
    let radial = 1.0 + 0.1 * r2 - 0.02 * r2.powi(2) + 0.003 * r2.powi(3);
    let xd = x * radial + 0.01 * (r2 + 2.0 * x * x) + 2.0 * -0.002 * x * y;
    let yd = y * radial - 0.002 * (r2 + 2.0 * y * y) + 2.0 * 0.01 * x * y;
    let expected = DVec2::new(203.0 + xd * 202.0 + yd * 0.5, 146.0 + yd * 200.0);
    let pixel = camera.pixel_as_shot(DVec3::new(x, y, 1.0)).unwrap();
    assert!(
        (pixel - expected).length() < 1e-12,
        "{pixel} is not {expected}"
    );
}

#[test]
fn each_lens_gets_its_model() {
    let name = |lens: &str| lens_of(&format!("<f>200</f>{lens}")).distortion.name();
    assert_eq!(name(""), "brown");
    assert_eq!(name("<p3>1</p3><p4>2</p4>"), "brown");
    assert_eq!(name("<k4>0.1</k4>"), "agisoft-frame");
    assert_eq!(name("<p1>0.1</p1><p4>0.1</p4>"), "agisoft-frame");
    let full =
        lens_of("<f>200</f><k1>1</k1><k2>2</k2><k3>3</k3><k4>4</k4><p1>5</p1><p2>6</p2><p3>7</p3>");
    let agisoft = Agisoft::new(
        AgisoftProjection::Frame,
        [1.0, 2.0, 3.0, 4.0],
        [5.0, 6.0, 7.0, 0.0],
    );
    assert_eq!(full.distortion, Distortion::Agisoft(agisoft));
    let of_type = |kind: &str, lens: &str| {
        let text = document(&format!("<f>200</f>{lens}"), &camera(0, 0.0, ""), "");
        let text = text.replace(
            "type=\"frame\" class=\"adjusted\"",
            &format!("type=\"{kind}\" class=\"adjusted\""),
        );
        read_xml(&text).map(|found| found.cameras[0].distortion.name())
    };
    assert_eq!(of_type("fisheye", "<k1>0.1</k1>"), Ok("fisheye"));
    assert_eq!(
        of_type("equidistant_fisheye", "<p1>0.1</p1>"),
        Ok("agisoft-equidistant-fisheye")
    );
    assert_eq!(
        of_type("equisolid_fisheye", ""),
        Ok("agisoft-equisolid-fisheye")
    );
    for kind in ["spherical", "cylindrical", "rpc", "?"] {
        let fault = of_type(kind, "").unwrap_err();
        assert!(
            fault.what.contains(&format!("'{kind}'")) && fault.line.is_some(),
            "{fault}"
        );
    }
}

/// PhotoScan up to 1.2: cx, cy from the corner, p1 and p2 in OpenCV's order.
#[test]
fn an_old_calibration() {
    let lens = "<fx>202</fx><fy>200</fy><cx>203</cx><cy>146</cy><skew>0.5</skew><p1>-0.002</p1><p2>0.01</p2>";
    let new = "<f>200</f><b1>2</b1><b2>0.5</b2><cx>3</cx><cy>-4</cy><p1>0.01</p1><p2>-0.002</p2>";
    assert_eq!(lens_of(lens), lens_of(new));
    let found = read_xml(&document(lens, &camera(0, 0.0, ""), "")).unwrap();
    assert!(
        found.warnings[0].contains("before 1.3"),
        "{:?}",
        found.warnings
    );
}

#[test]
fn a_sensor_without_calibration_is_taken_from_its_millimetres() {
    let text = document("", &camera(0, 0.0, ""), "");
    let start = text.find("<calibration").unwrap();
    let end = text.find("<covariance").unwrap();
    let with =
        |properties: &str| read_xml(&format!("{}{properties}{}", &text[..start], &text[end..]));
    let found = with(
        "<property name=\"pixel_width\" value=\"0.01\"/><property name=\"pixel_height\" value=\"0.02\"/>\
         <property name=\"focal_length\" value=\"8\"/>",
    )
    .unwrap();
    let camera = &found.cameras[0];
    assert_eq!(
        (camera.fx, camera.fy, camera.cx, camera.cy),
        (800.0, 400.0, 200.0, 150.0)
    );
    assert!(found.warnings[0].contains("no calibration"));
    assert!(with("").unwrap_err().what.contains("no calibration"));
}

#[test]
fn what_is_left_out_is_counted() {
    let cameras = [
        "<group id=\"0\" label=\"west\" type=\"folder\">".to_owned(),
        camera(0, 0.0, ""),
        "</group>".to_owned(),
        camera(1, 1.0, "enabled=\"false\""),
        camera(2, 2.0, "enabled=\"0\""),
        camera(3, 3.0, "enabled=\"true\""),
        "<camera id=\"4\" sensor_id=\"0\" label=\"p4\"><orientation>1</orientation></camera>"
            .to_owned(),
        camera(5, 5.0, "").replace("sensor_id=\"0\"", "sensor_id=\"7\""),
        camera(6, 6.0, "").replace(
            "</camera>",
            "<rolling_shutter>1 0</rolling_shutter></camera>",
        ),
    ]
    .concat();
    let found = read_xml(&document("<f>200</f>", &cameras, "")).unwrap();
    assert_eq!(names(&found), ["p0", "p3", "p6"]);
    assert_eq!(found.photos[1].pose.center, DVec3::new(3.0, 0.0, 0.0));
    let warnings = found.warnings.join("\n");
    for part in [
        "2 photos are disabled",
        "1 photos were not aligned",
        "1 photos are left out: their sensor is not there",
        "1 photos are compensated for their rolling shutter",
    ] {
        assert!(warnings.contains(part), "{warnings}");
    }
    let none = document("<f>200</f>", &camera(1, 1.0, "enabled=\"0\""), "");
    assert!(
        read_xml(&none)
            .unwrap_err()
            .what
            .contains("no photo that can be used")
    );
}

#[test]
fn only_photos_of_a_panorama_are_refused() {
    let text = document("<f>200</f>", &(camera(0, 0.0, "") + &camera(1, 1.0, "").replace("sensor_id=\"0\"", "sensor_id=\"1\"")), "")
        .replace("</sensors>", "<sensor id=\"1\" label=\"360\" type=\"spherical\"><resolution width=\"8\" height=\"4\"/>\
            <calibration type=\"spherical\" class=\"adjusted\"><resolution width=\"8\" height=\"4\"/></calibration></sensor></sensors>");
    let found = read_xml(&text).unwrap();
    assert_eq!((names(&found), found.cameras.len()), (vec!["p0"], 1));
    assert!(
        found.warnings[0]
            .contains("1 photos are left out: a calibration is of the type 'spherical'")
    );
}

#[test]
fn labels_that_stand_twice_are_told_apart() {
    let cameras = "<group label=\"100\"><camera id=\"0\" sensor_id=\"0\" label=\"D1\">T</camera></group>\
        <group label=\"101\"><camera id=\"1\" sensor_id=\"0\" label=\"D1\">T</camera></group>\
        <camera id=\"2\" sensor_id=\"0\" label=\"D2\">T</camera><camera id=\"3\" sensor_id=\"0\" label=\"D2\">T</camera>"
        .replace('T', "<transform>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</transform>");
    let found = read_xml(&document("<f>200</f>", &cameras, "")).unwrap();
    assert_eq!(
        names(&found),
        ["100/D1", "101/D1", "D2 (camera 2)", "D2 (camera 3)"]
    );
    assert!(found.warnings[0].starts_with("2 photos have no name of their own"));
}

/// The master at (10, 0, 0), turned a quarter about z: its x is the chunk's y. The slave is 1 along
/// the master's x and turned a quarter more.
#[test]
fn a_rig() {
    let rig = "<sensor id=\"1\" label=\"two\" type=\"frame\" master_id=\"0\"><resolution width=\"40\" height=\"30\"/>\
        <calibration type=\"frame\" class=\"adjusted\"><f>50</f></calibration>\
        <rotation locked=\"false\">0 -1 0 1 0 0 0 0 1</rotation><location locked=\"false\">1 0 0</location></sensor></sensors>";
    let master = "<transform>0 -1 0 10 1 0 0 0 0 0 1 0 0 0 0 1</transform>";
    let cameras = format!(
        "<camera id=\"5\" sensor_id=\"0\" label=\"m\">{master}</camera>\
         <camera id=\"6\" sensor_id=\"1\" master_id=\"5\" label=\"s\"><orientation>1</orientation></camera>\
         <camera id=\"7\" sensor_id=\"1\" label=\"first of its rig\">{master}</camera>\
         <camera id=\"8\" sensor_id=\"0\" master_id=\"7\" label=\"of the master sensor\"/>\
         <camera id=\"9\" sensor_id=\"1\" master_id=\"10\" label=\"not aligned\"/><camera id=\"10\" sensor_id=\"0\" label=\"nor this\"/>"
    );
    let text = document("<f>200</f>", &cameras, "").replace("</sensors>", rig);
    let found = read_xml(&text).unwrap();
    assert_eq!(
        names(&found),
        ["m", "s", "first of its rig", "of the master sensor"]
    );
    let half_turn = DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0));
    for index in [1, 2] {
        let slave = found.photos[index].pose;
        assert!(
            near(slave.center, DVec3::new(10.0, 1.0, 0.0)),
            "{}",
            slave.center
        );
        assert!(
            slave.rotation.abs_diff_eq(half_turn, 1e-12),
            "{}",
            slave.rotation
        );
    }
    assert_eq!(found.photos[3].pose, found.photos[0].pose);
    assert!(found.warnings[0].contains("2 photos were not aligned"));
}

const COMPONENTS: &str = "<components active_id=\"1\"><component id=\"0\" label=\"a\">A</component>\
    <component id=\"1\" label=\"b\">B</component><component id=\"2\" label=\"c\"/></components>";

fn in_components(first: &str, second: &str, chunk: &str) -> Reconstruction {
    let cameras = camera(0, 1.0, "component_id=\"0\"")
        + &camera(1, 1.0, "component_id=\"1\"")
        + &camera(2, 1.0, "component_id=\"2\"")
        + &camera(3, 2.0, "component_id=\"0\"");
    let components = COMPONENTS.replace('A', first).replace('B', second);
    read_xml(&document("<f>200</f>", &cameras, &(components + chunk))).unwrap()
}

#[test]
fn components_have_their_own_transforms() {
    let twice = "<transform><rotation>1 0 0 0 1 0 0 0 1</rotation><translation>100 0 0</translation><scale>2</scale></transform>";
    let old = "<transform>0 -3 0 0 3 0 0 50 0 0 3 0 0 0 0 1</transform>";
    // The active component's is the chunk's.
    let found = in_components(twice, "", old);
    assert_eq!(names(&found), ["p0", "p1", "p3"]);
    assert!(near(
        found.photos[0].pose.center,
        DVec3::new(102.0, 0.0, 0.0)
    ));
    assert!(near(
        found.photos[1].pose.center,
        DVec3::new(0.0, 53.0, 0.0)
    ));
    assert!(near(found.photos[1].pose.rotation.x_axis, DVec3::Y));
    assert!(found.warnings[0].contains("1 photos are left out: they belong to components"));
    assert_eq!(found.crs, None);
    // A camera that names none is in the active one.
    let cameras = camera(0, 1.0, "component_id=\"1\"") + &camera(1, 1.0, "");
    let components = COMPONENTS.replace('A', "").replace('B', twice);
    let found = read_xml(&document("<f>200</f>", &cameras, &components)).unwrap();
    assert_eq!(found.photos[1].pose, found.photos[0].pose);
}

#[test]
fn without_a_transform_one_component_is_read() {
    let found = in_components("", "", "");
    assert_eq!(names(&found), ["p1"]);
    assert!(found.warnings[0].contains("3 photos are left out"));
    // Where the active one has no photo, the largest.
    let cameras = camera(0, 1.0, "component_id=\"0\"")
        + &camera(2, 1.0, "component_id=\"2\"")
        + &camera(3, 2.0, "component_id=\"0\"");
    let components = COMPONENTS.replace(['A', 'B'], "");
    let found = read_xml(&document("<f>200</f>", &cameras, &components)).unwrap();
    assert_eq!(names(&found), ["p0", "p3"]);
}

const WGS84: &str = "<reference>GEOGCS[\"WGS 84\",DATUM[\"World Geodetic System 1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],\
    PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.01745329251994328],AUTHORITY[\"EPSG\",\"4326\"]]</reference>";

#[test]
fn a_transform_and_a_coordinate_system_make_ecef() {
    let cameras = camera(0, 1.0, "").replace(
        "</camera>",
        "<reference x=\"139.5\" y=\"35.7\" z=\"126\" enabled=\"true\"/></camera>",
    ) + &camera(1, 2.0, "").replace(
        "</camera>",
        "<reference x=\"139.6\" y=\"35.8\" z=\"126\" enabled=\"0\"/></camera>",
    );
    let place = Geographic {
        longitude: 139.5,
        latitude: 35.7,
        height: 100.0,
    };
    let t = ecef_from_geographic(place);
    let transform = format!(
        "<transform><translation>{:e} {:e} {:e}</translation></transform>",
        t.x, t.y, t.z
    );
    let read = |rest: &str| read_xml(&document("<f>200</f>", &cameras, rest)).unwrap();
    let found = read(&format!("{transform}{WGS84}"));
    assert_eq!(found.crs.as_deref(), Some("ECEF"));
    assert_eq!(found.preferred_crs, None);
    assert!((found.photos[0].pose.center - t - DVec3::X).length() < 1e-8);
    let [measured] = &found.measured_positions[..] else {
        panic!("{:?}", found.measured_positions);
    };
    assert_eq!(
        (measured.photo.as_str(), measured.position.latitude),
        ("p0", 35.7)
    );
    // Scaled, but not georeferenced; and not even scaled.
    let scaled = read(&format!("<transform><scale>3</scale></transform>{WGS84}"));
    assert_eq!(scaled.crs, None);
    assert_eq!(scaled.photos[0].pose.center, DVec3::new(3.0, 0.0, 0.0));
    assert!(scaled.warnings[0].contains("does not lead there"));
    assert_eq!(read(WGS84).crs, None);
    assert_eq!(read(WGS84).measured_positions.len(), 1);
    let local = "<reference>LOCAL_CS[\"Local Coordinates (m)\",UNIT[\"metre\",1]]</reference>";
    let found = read(&format!("{transform}{local}"));
    assert_eq!((found.crs, found.measured_positions.len()), (None, 0));
    assert!((found.photos[0].pose.center - t - DVec3::X).length() < 1e-8);
    // The chunk's own frame is not that system.
    let metre = crate::units::LengthUnit::Metre;
    assert_eq!((found.unit, read(local).unit), (Some(metre), None));
}

#[test]
fn the_active_chunk_is_read_if_it_is_aligned() {
    let inside = |label: &str, x: f64| {
        let text = document("<f>200</f>", &camera(0, x, ""), "");
        let start = text.find("<chunk").unwrap();
        let end = text.find("</document>").unwrap();
        text[start..end].replace("Chunk 1\"", &format!("{label}\" id=\"{label}\""))
    };
    let read = |active: &str| {
        let bare = "<chunk id=\"z\"><cameras/></chunk>";
        let all = format!("{bare}{}{}", inside("a", 1.0), inside("b", 2.0));
        read_xml(&format!(
            "<document><chunks active_id=\"{active}\">{all}</chunks></document>"
        ))
        .unwrap()
    };
    assert_eq!(read("b").photos[0].pose.center.x, 2.0);
    assert_eq!(read("z").photos[0].pose.center.x, 1.0);
    assert!(read("b").warnings[0].contains("3 chunks") && read("b").warnings[0].contains("'b'"));
    let root = inside("a", 1.0);
    assert!(is_project("doc.xml", root.as_bytes()));
    assert_eq!(read_xml(&root).unwrap().photos.len(), 1);
}

#[test]
fn what_is_broken_has_its_line() {
    let good = document(
        "<f>200</f>",
        &camera(0, 1.0, ""),
        "<transform><scale>2</scale></transform>",
    );
    for (from, to, what) in [
        ("1 0 0 1 0 1", "nan 0 0 1 0 1", "'nan', not finite"),
        ("1 0 0 1 0 1", "1 0 0 1 0 2", "no rotation"),
        ("1 0 0 1 0 1", "-1 0 0 1 0 1", "mirrors"),
        ("0 0 0 1</", "0 0 1</", "the line ends"),
        ("0 0 0 1</", "0 0 0 2</", "last row"),
        ("<scale>2<", "<scale>-2<", "mirrors"),
        ("<scale>2<", "<scale>0<", "flattens"),
        ("<scale>2<", "<scale>x<", "'x', not a number"),
        ("<f>200<", "<f>-200<", "focal length"),
        ("<f>200</f>", "", "no focal length"),
        ("<f>200<", "<f>1e999<", "not finite"),
        ("</chunk>", "", "not valid XML"),
    ] {
        assert!(good.contains(from), "{from}");
        let fault = read_xml(&good.replacen(from, to, 1)).unwrap_err();
        assert!(fault.what.contains(what), "{to}: {fault}");
        assert!(fault.line.is_some(), "{fault}");
    }
    let twice = document("<f>200</f>", &camera(0, 1.0, "").repeat(2), "");
    assert!(
        read_xml(&twice)
            .unwrap_err()
            .what
            .contains("the camera '0' is there twice")
    );
    let listed = "<document><chunks><chunk id=\"0\" path=\"0/chunk.zip\"/></chunks></document>";
    assert!(read_xml(listed).unwrap_err().remedy.contains(".psx"));
    let corrected = document(
        "<f>200</f><corrections>1</corrections>",
        &camera(0, 1.0, ""),
        "",
    );
    assert!(read_xml(&corrected).unwrap().warnings[0].contains("left out: corrections"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// One byte changed, or cut off, or a piece put elsewhere.
    #[test]
    fn any_damage_is_read_or_refused(
        from in any::<prop::sample::Index>(),
        length in 0..30_usize,
        to in any::<prop::sample::Index>(),
        with in prop::option::of(any::<u8>()),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let rig = "<camera id=\"9\" sensor_id=\"0\" master_id=\"0\" label=\"s\"/>";
        let all = camera(0, 1.0, "component_id=\"0\"") + rig;
        let rest = COMPONENTS.replace('A', "<transform><scale>2</scale></transform>").replace('B', "") + WGS84;
        let mut bytes = document("<f>200</f><k4>0.1</k4>", &all, &rest).into_bytes();
        let from = from.index(bytes.len());
        if let Some(byte) = with {
            bytes[from] = byte;
        } else {
            let end = (from + length).min(bytes.len());
            let piece: Vec<u8> = bytes.drain(from..end).collect();
            let to = to.index(bytes.len() + 1);
            bytes.splice(to..to, piece);
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        let text = String::from_utf8_lossy(&bytes);
        if let Ok(found) = read_xml(&text) {
            prop_assert!(found.photos.iter().all(|photo| photo.camera < found.cameras.len()));
        }
        let _ = read_calibration(&text);
        let _ = (read_opk(&text), is_project("a.xml", &bytes));
    }
}

/// A marker of a real project: where it was surveyed, and where photos show it.
struct Marker {
    label: String,
    surveyed: DVec3,
    pixels: Vec<(usize, DVec2)>,
}

/// The wheat field with its markers, in ECEF; read here by hand from the extracted documents.
fn wheat() -> Option<(Reconstruction, Vec<Marker>)> {
    let psx = shared_data("metashape-wheat-gcp/wheat_tanashi.psx")?;
    let folder = shared_data("metashape-wheat-gcp/extracted")?;
    let found = read_any(&psx, &Progress::default()).unwrap().reconstruction;
    let chunk = read_text(&folder.join("0/chunk/doc.xml")).unwrap();
    let frame = read_text(&folder.join("0/0/frame/doc.xml")).unwrap();
    let (chunk, frame) = (xml::parse(&chunk).unwrap(), xml::parse(&frame).unwrap());
    let markers = chunk
        .descendants()
        .filter(|node| node.has_tag_name("marker"));
    let markers = markers.map(|marker| {
        let reference = child(marker, "reference").unwrap();
        let number = |name| xml::attribute(reference, name).unwrap();
        let of_this = |node: &Node<'_, '_>| {
            node.has_tag_name("marker") && node.attribute("marker_id") == marker.attribute("id")
        };
        let shown = frame.descendants().find(of_this).unwrap();
        let pixels = children(shown, "location").map(|location| {
            // In this project photo n is camera n.
            let photo = xml::attribute(location, "camera_id").unwrap() as usize;
            let at = |name| xml::attribute(location, name).unwrap();
            (photo, DVec2::new(at("x"), at("y")))
        });
        Marker {
            label: marker.attribute("label").unwrap().to_owned(),
            surveyed: ecef_from_geographic(Geographic {
                longitude: number("x"),
                latitude: number("y"),
                height: number("z"),
            }),
            pixels: pixels.collect(),
        }
    });
    Some((found, markers.collect()))
}

#[test]
fn the_wheat_field() {
    let Some((found, _)) = wheat() else { return };
    assert_eq!((found.photos.len(), found.cameras.len()), (138, 1));
    assert_eq!(found.crs.as_deref(), Some("ECEF"));
    assert_eq!((found.preferred_crs, found.warnings.len()), (None, 0));
    assert_eq!(found.measured_positions.len(), 138);
    assert_eq!(found.photos[0].name, "DJI_0001.JPG");
    // GPS of a drone without RTK: metres in plan, tens of metres in height.
    let first = &found.measured_positions[0];
    let gap = ecef_from_geographic(first.position) - found.photos[0].pose.center;
    let gap = enu_axes(first.position).transpose() * gap;
    assert!(gap.truncate().length() < 3.0, "{gap}");
    let camera = &found.cameras[0];
    assert_eq!((camera.width, camera.height), (4608, 3456));
    assert!((camera.cx - (2304.0 + 48.037_918_055_786_3)).abs() < 1e-12);
}

/// The README's numbers, measured by another program: markers triangulated from their own pixels
/// reproject to 1.88 px, surveyed ones to 5.5 px (medians).
#[test]
fn markers_of_the_wheat_field_reproject() {
    let Some((found, markers)) = wheat() else {
        return;
    };
    let (mut own, mut surveyed) = (Vec::new(), Vec::new());
    for marker in &markers {
        let rays = marker.pixels.iter().map(|&(photo, pixel)| {
            let photo = &found.photos[photo];
            let direction = found.cameras[photo.camera]
                .direction_as_shot(pixel)
                .unwrap();
            (
                photo.pose.center,
                (photo.pose.rotation * direction).normalize(),
            )
        });
        // The point nearest to all rays: sum (I - d dT) x = sum (I - d dT) c.
        let origin = found.photos[0].pose.center;
        let (mut left, mut right) = (DMat3::ZERO, DVec3::ZERO);
        for (center, d) in rays {
            let across = DMat3::IDENTITY - DMat3::from_cols(d * d.x, d * d.y, d * d.z);
            left += across;
            right += across * (center - origin);
        }
        let point = origin + left.inverse() * right;
        for &(photo, pixel) in &marker.pixels {
            let photo = &found.photos[photo];
            let error = |point| {
                let in_camera = photo.pose.camera_from_world(point);
                (found.cameras[photo.camera]
                    .pixel_as_shot(in_camera)
                    .unwrap()
                    - pixel)
                    .length()
            };
            own.push(error(point));
            surveyed.push(error(marker.surveyed));
        }
    }
    assert_eq!(own.len(), 23);
    let (own, surveyed) = (median(&mut own).unwrap(), median(&mut surveyed).unwrap());
    assert!((own - 1.88).abs() < 0.05, "triangulated: {own}");
    assert!((surveyed - 5.5).abs() < 0.1, "surveyed: {surveyed}");
}

/// True scale. Two surveyed points in one photo, some 20 m apart: the pixels between them over the
/// metres between them, as `derived_gcp_px_per_m.txt` has it from the survey and the measured pixels
/// alone. Against it: the metres between the points where the rays of those pixels meet the surface
/// of the surveyed points, through our camera, pose and ray casting.
#[test]
fn scales_of_the_wheat_field_are_true() {
    let Some((found, markers)) = wheat() else {
        return;
    };
    let Some(derived) = shared_data("metashape-wheat-gcp/derived_gcp_px_per_m.txt") else {
        return;
    };
    let mut at = crate::geodesy::geographic_from_ecef(markers[0].surveyed).unwrap();
    at.height = 0.0;
    let (origin, axes) = (ecef_from_geographic(at), enu_axes(at).transpose());
    let level = |point: DVec3| axes * (point - origin);
    // The points lie at the field's edge; a wider hull lets rays through the pixels meet it that
    // pass a hair outside. The field is flat to 0.1 m.
    let mut points: Vec<DVec3> = markers
        .iter()
        .map(|marker| level(marker.surveyed))
        .collect();
    let heights = points.iter().map(|point| point.z).sum::<f64>() / points.len() as f64;
    points.extend(
        [(-99.0, -99.0), (99.0, -99.0), (99.0, 99.0), (-99.0, 99.0)]
            .map(|(x, y)| DVec3::new(x, y, heights)),
    );
    let surface = Surface::new(Cloud {
        points,
        ..Cloud::default()
    })
    .unwrap();
    let mut caster = surface.caster().unwrap();
    let marker = |label: &str| markers.iter().find(|marker| marker.label == label).unwrap();
    let mut compared = 0;
    for line in read_text(&derived).unwrap().lines() {
        // wheat DJI_0045 GCP 7-X d=15.844m px=2303.0 measured 145.35 px/m | ...
        let words: Vec<&str> = line.split_whitespace().collect();
        let index = found
            .photos
            .iter()
            .position(|photo| photo.name == format!("{}.JPG", words[1]))
            .unwrap();
        let photo = &found.photos[index];
        let ends = words[3].split_once('-').unwrap();
        let [a, b] = [marker(ends.0), marker(ends.1)];
        let pixel = |marker: &Marker| {
            marker
                .pixels
                .iter()
                .find(|(photo, _)| *photo == index)
                .unwrap()
                .1
        };
        let mut meet = |marker: &Marker| {
            let direction = found.cameras[photo.camera]
                .direction_as_shot(pixel(marker))
                .unwrap();
            let ray = Ray {
                origin: level(photo.pose.center),
                direction: (axes * photo.pose.rotation * direction).normalize(),
            };
            caster.cast(&ray).unwrap().point
        };
        let scale = (pixel(a) - pixel(b)).length() / (meet(a) - meet(b)).length();
        let measured: f64 = words[7].parse().unwrap();
        let surveyed = (pixel(a) - pixel(b)).length() / (a.surveyed - b.surveyed).length();
        assert!(
            (surveyed / measured - 1.0).abs() < 1e-4,
            "{line}: {surveyed}"
        );
        assert!((scale / measured - 1.0).abs() < 0.01, "{line}: {scale}");
        compared += 1;
    }
    assert_eq!(compared, 5);
}

#[test]
fn the_exported_cameras_of_potree() {
    let Some(path) = shared_data("metashape-xml-potree/cameras.xml") else {
        return;
    };
    let found = read_any(&path, &Progress::default())
        .unwrap()
        .reconstruction;
    assert_eq!((found.photos.len(), found.cameras.len()), (25, 3));
    assert_eq!((found.crs, found.measured_positions.len()), (None, 0));
    let lens = found.cameras[0].distortion.coefficients();
    // OpenCV's p1, p2 are the file's p2, p1.
    assert_eq!(
        lens[2..4],
        [-0.000_257_085_555_850_840_67, 0.005_266_309_532_673_387_4]
    );
    let calibration = path.with_file_name("steele_camcal.xml");
    let camera = crate::read_camera(&calibration).unwrap();
    assert_eq!((camera.width, camera.height), (5280, 3956));
    assert!((camera.cy - (1978.0 - 40.405_046_106_437)).abs() < 1e-12);
    assert_eq!(camera.distortion.name(), "brown");
}

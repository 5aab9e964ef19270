//! Poses from the Earth's centre over a surface on a map: the flight is brought to one system, and its
//! scales are those of a closed form.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use fragscale::geodesy::{Crs, Geographic, ecef_from_geographic, enu_axes};
use fragscale::jobs::Progress;
use fragscale::opening::{OpenOptions, Opened, open_flight};
use fragscale::surface::UpAxis;
use glam::{DMat3, DVec3};

/// In UTM zone 33 north, 2 degrees west of its central meridian.
const PLACE: Geographic = Geographic {
    longitude: 13.0,
    latitude: 48.0,
    height: 400.0,
};

/// A Metashape cameras.xml with one photo straight down from 100 m, its top to true north, f = 1000 px.
/// The chunk's own frame is the Earth's.
fn cameras_xml() -> String {
    let up = Geographic {
        height: PLACE.height + 100.0,
        ..PLACE
    };
    let (center, enu) = (ecef_from_geographic(up), enu_axes(PLACE));
    // Columns: the image's right is east, its down is south, its forward is down.
    let rotation = enu * DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z);
    let (r, c) = (rotation.transpose(), center);
    let row = |axis: usize| {
        // Row `axis` of the 4x4 from the camera to the Earth.
        let row = rotation.row(axis);
        format!("{:.17} {:.17} {:.17} {:.9}", row.x, row.y, row.z, c[axis])
    };
    let matrix = format!("{} {} {} 0 0 0 1", row(0), row(1), row(2));
    assert!(
        (r * rotation - DMat3::IDENTITY)
            .to_cols_array()
            .iter()
            .all(|d| d.abs() < 1e-12)
    );
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<document version="2.0.0"><chunk label="Chunk 1" enabled="true">
<sensors next_id="1"><sensor id="0" label="cam" type="frame"><resolution width="400" height="300"/>
<calibration type="frame" class="adjusted"><resolution width="400" height="300"/><f>1000</f><cx>0</cx><cy>0</cy></calibration></sensor></sensors>
<cameras next_id="1"><camera id="0" sensor_id="0" label="a.jpg"><transform>{matrix}</transform></camera></cameras>
<reference>GEOGCS["WGS 84",DATUM["World Geodetic System 1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.01745329251994328],AUTHORITY["EPSG","4326"]]</reference>
<transform><rotation locked="false">1 0 0 0 1 0 0 0 1</rotation><translation locked="false">0 0 0</translation><scale locked="false">1</scale></transform>
</chunk></document>
"#
    )
}

/// Level ground 50 m around the place on the map of `crs`, as text without any system.
fn ground(crs: &str) -> String {
    let center = Crs::understand(crs)
        .unwrap()
        .from_geographic(PLACE)
        .unwrap();
    let mut text = String::new();
    for (x, y) in [(-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)] {
        let _ = writeln!(text, "{} {} {}", center.x + x, center.y + y, PLACE.height);
    }
    text
}

fn open(folder: &Path, world: &str) -> Opened {
    let text = format!(
        "format = 1\n[world]\n{world}\n[surface]\nfile = \"ground.xyz\"\n[photos]\nreconstruction = \"cameras.xml\"\n"
    );
    fs::write(folder.join("flight.toml"), text).unwrap();
    open_flight(folder, &OpenOptions::default(), &Progress::default()).unwrap()
}

#[test]
fn poses_from_the_earths_centre_meet_a_surface_on_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("cameras.xml"), cameras_xml()).unwrap();
    fs::write(folder.join("ground.xyz"), ground("EPSG:32633")).unwrap();
    for world in ["unit = \"m\"\ncrs = \"EPSG:32633\"", "unit = \"m\""] {
        let opened = open(folder, world);
        assert_eq!(
            opened.crs.as_deref(),
            Some("EPSG:32633"),
            "the photos' zone"
        );
        let outcomes = opened.flight.scales(&Progress::default()).unwrap();
        let scale = outcomes[0].scale().unwrap();
        assert_eq!(scale.corners_on_surface(), 4);
        // Metres of the map are 0.9996 (1 + x^2 / 2 R^2) / (1 + h / R) of those on the ground, but the
        // flying height, which is no length on the map, stays 100 m.
        let top = scale.scale.top.unwrap();
        assert!((top / 10.0 - 1.0).abs() < 1e-5, "{top}");
        // The image's top is true north: on the map it is turned by the convergence, about
        // -2 degrees times sin 48, clockwise.
        let [left, right] = [0, 1].map(|corner| scale.corners[corner].point().unwrap());
        let turn = (right.y - left.y).atan2(right.x - left.x).to_degrees();
        let convergence = (-2.0_f64).to_radians().tan() * 48.0_f64.to_radians().sin();
        assert!(
            (turn - convergence.atan().to_degrees()).abs() < 2e-3,
            "{turn}"
        );
        let said = opened.warnings.join("\n");
        assert!(said.contains("are brought to EPSG:32633"), "{said}");
    }
}

#[test]
fn without_a_surface_on_a_map_lengths_stay_true_around_the_photos() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("cameras.xml"), cameras_xml()).unwrap();
    let error = open_flight(
        &folder.join("cameras.xml"),
        &OpenOptions::default(),
        &Progress::default(),
    );
    let error = error.unwrap_err().to_string();
    assert!(
        error.contains("it has no 3D points to make a surface of"),
        "{error}"
    );
}

#[test]
fn the_map_must_count_in_the_flights_unit() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("cameras.xml"), cameras_xml()).unwrap();
    fs::write(folder.join("ground.xyz"), ground("EPSG:32633")).unwrap();
    let text = "format = 1\n[world]\nunit = \"ft\"\ncrs = \"EPSG:32633\"\n[surface]\nfile = \"ground.xyz\"\n[photos]\nreconstruction = \"cameras.xml\"\n";
    fs::write(folder.join("flight.toml"), text).unwrap();
    let error = open_flight(folder, &OpenOptions::default(), &Progress::default());
    let error = error.unwrap_err().to_string();
    assert!(error.contains("which counts in m, not ft"), "{error}");
}

/// A cloud that the package names is in the frame of its poses, so `photos.transform` is for both.
#[test]
fn a_packages_own_cloud_goes_to_the_world_with_its_poses() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Straight down from 11 on a plane at 1, f = 1000 px: 100 px a unit.
    let frame =
        r#"{"file_path": "a.jpg", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,11],[0,0,0,1]]}"#;
    let json = format!(
        r#"{{"fl_x": 1000, "fl_y": 1000, "cx": 200, "cy": 150, "w": 400, "h": 300, "ply_file_path": "cloud.ply", "frames": [{frame}]}}"#
    );
    fs::write(folder.join("transforms.json"), json).unwrap();
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n-50 -50 1\n50 -50 1\n50 50 1\n-50 50 1\n";
    fs::write(folder.join("cloud.ply"), ply).unwrap();
    // Doubled: at a plane left at 1 it would be 1000 / 21.
    let text = "format = 1\n[world]\nunit = \"m\"\n[photos]\nreconstruction = \"transforms.json\"\ntransform = [2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,0,1]\n";
    fs::write(folder.join("flight.toml"), text).unwrap();
    let opened = open_flight(folder, &OpenOptions::default(), &Progress::default()).unwrap();
    let outcomes = opened.flight.scales(&Progress::default()).unwrap();
    let top = outcomes[0].scale().unwrap().scale.top.unwrap();
    assert!((top - 50.0).abs() < 1e-9, "{top}");
}

/// The map that the engineer chose in Metashape, although the frame is the Earth's.
#[test]
fn a_projects_own_map_comes_before_the_zone() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // ETRS89 / UTM zone 32N: the next zone, so the photos' own would be another one.
    let map = r#"PROJCS["ETRS89 / UTM zone 32N",GEOGCS["ETRS89",DATUM["European_Terrestrial_Reference_System_1989",SPHEROID["GRS 1980",6378137,298.257222101]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1],AUTHORITY["EPSG","25832"]]"#;
    let xml = cameras_xml();
    let (before, rest) = xml.split_once("<reference>").unwrap();
    let (_, after) = rest.split_once("</reference>").unwrap();
    let xml = format!("{before}<reference>{map}</reference>{after}");
    fs::write(folder.join("cameras.xml"), xml).unwrap();
    fs::write(folder.join("ground.xyz"), ground("EPSG:25832")).unwrap();
    let opened = open(folder, "unit = \"m\"");
    assert_eq!(opened.crs.as_deref(), Some("EPSG:25832"));
    let outcomes = opened.flight.scales(&Progress::default()).unwrap();
    assert_eq!(outcomes[0].scale().unwrap().corners_on_surface(), 4);
}

/// A LAZ with these points, whose system is this WKT.
fn write_laz(path: &Path, system: &str, points: &[DVec3]) {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(6).unwrap();
    builder.point_format.is_compressed = true;
    builder.has_wkt_crs = true;
    builder.vlrs.push(las::Vlr {
        user_id: "LASF_Projection".to_owned(),
        record_id: 2112,
        description: String::new(),
        data: system.as_bytes().to_vec(),
    });
    let axis = |offset: f64| las::Transform {
        scale: 1e-4,
        offset: (offset / 1e5).round() * 1e5,
    };
    let [x, y, z] = points[0].to_array().map(axis);
    builder.transforms = las::Vector { x, y, z };
    let file = fs::File::create(path).unwrap();
    let mut writer = las::Writer::new(file, builder.into_header().unwrap()).unwrap();
    for DVec3 { x, y, z } in points.iter().copied() {
        let gps_time = Some(0.0);
        let point = las::Point {
            x,
            y,
            z,
            gps_time,
            ..las::Point::default()
        };
        writer.write_point(point).unwrap();
    }
    writer.close().unwrap();
}

const UTM_33: &str = r#"PROJCS["WGS 84 / UTM zone 33N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",15],PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1],AUTHORITY["EPSG","32633"]]"#;

/// The words of the reasons of the one photo.
fn reasons(opened: &Opened) -> Vec<&'static str> {
    let doubts = opened.looked_up.evidence[0].doubts.iter();
    doubts.map(|doubt| doubt.kind()).collect()
}

/// Metashape's poses are above the ellipsoid; a cloud whose system has heights above a geoid lies elsewhere, by tens of metres.
#[test]
fn heights_of_two_levels_are_a_reason_for_doubt() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("cameras.xml"), cameras_xml()).unwrap();
    let center = Crs::understand("EPSG:32633")
        .unwrap()
        .from_geographic(PLACE);
    let center = center.unwrap();
    let corners = [(-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)];
    let points = corners.map(|(x, y)| center + DVec3::new(x, y, 0.0));
    let compound = format!(
        r#"COMPD_CS["a map and heights",{UTM_33},VERT_CS["EGM96 height",VERT_DATUM["EGM96 geoid",2005,AUTHORITY["EPSG","5171"]],UNIT["metre",1],AXIS["Up",UP],AUTHORITY["EPSG","5773"]]]"#
    );
    let with = |system: &str| {
        write_laz(&folder.join("ground.laz"), system, &points);
        let options = OpenOptions {
            surface: Some(folder.join("ground.laz")),
            ..OpenOptions::default()
        };
        open_flight(&folder.join("cameras.xml"), &options, &Progress::default()).unwrap()
    };
    let opened = with(&compound);
    assert!(reasons(&opened).contains(&"other-heights"), "{opened:?}");
    let said = opened.warnings.join("\n");
    assert_eq!(
        said.matches("heights count from the ellipsoid, the surface's")
            .count(),
        1,
        "{said}"
    );
    let opened = with(UTM_33);
    assert!(!reasons(&opened).contains(&"other-heights"), "{opened:?}");
}

/// A volume between heights above the ellipsoid and above a geoid is refused, between two geoids it is said, in all that is
/// written; between the same, or where one does not say, it is neither.
#[test]
fn volumes_between_heights_of_two_levels() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let heights = |name: &str, code: u32| {
        format!(
            r#"COMPD_CS["a map and heights",{UTM_33},VERT_CS["{name}",VERT_DATUM["a datum",2005],UNIT["metre",1],AXIS["Up",UP],AUTHORITY["EPSG","{code}"]]]"#
        )
    };
    let square = |z: f64| {
        let corners = [(0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (0.0, 40.0)];
        corners.map(|(x, y)| DVec3::new(500_000.0 + x, 5_400_000.0 + y, z))
    };
    let (egm, dhhn) = (
        heights("EGM96 height", 5773),
        heights("DHHN2016 height", 7837),
    );
    for (name, system, z) in [
        ("top.laz", egm.as_str(), 102.0),
        ("same.laz", &egm, 100.0),
        ("other.laz", &dhhn, 100.0),
        ("unsaid.laz", UTM_33, 100.0),
    ] {
        write_laz(&folder.path().join(name), system, &square(z));
    }
    let polygon = "500010,5400010;500020,5400010;500020,5400020;500010,5400020";
    let measured = |top: &str, base: &str| {
        let (top, base) = (path(top), path(base));
        crate::common::fragscale(&[
            "volume",
            &top,
            "--polygon",
            polygon,
            "--base",
            &base,
            "--format",
            "json",
        ])
    };
    for (base, apart) in [
        ("same.laz", false),
        ("unsaid.laz", false),
        ("other.laz", true),
    ] {
        let output = measured("top.laz", base);
        let warned = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{warned}");
        let said = "heights count from DHHN2016, the flight's from the geoid EGM96";
        assert_eq!(warned.contains(said), apart, "{base}: {warned}");
        let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        // 100 square metres, 2 m high.
        assert!(
            (found["fill"].as_f64().unwrap() - 200.0).abs() < 0.3,
            "{found}"
        );
        let told = &found["base"]["other_heights"]["base"];
        assert_eq!(told.as_str(), apart.then_some("DHHN2016"), "{found}");
    }
    let ellipsoid = format!(
        r#"COMPD_CS["a map and heights",{UTM_33},VERT_CS["Ellipsoid (metres)",VERT_DATUM["Ellipsoid",2002],UNIT["metre",1],AXIS["Up",UP]]]"#
    );
    write_laz(
        &folder.path().join("ellipsoid.laz"),
        &ellipsoid,
        &square(100.0),
    );
    let output = measured("top.laz", "ellipsoid.laz");
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(
        error.contains(
            "ellipsoid.laz: its heights count from the ellipsoid, the flight's from the geoid EGM96"
        ),
        "{error}"
    );
}

/// A model in a frame of its own counts in no unit because the file of its cloud names a system: a map's, at whose origin it lies,
/// or a local one. Where both are on the map it does.
#[test]
fn a_clouds_system_gives_no_unit_to_a_model_of_its_own() {
    const LOCAL: &str = r#"LOCAL_CS["Local Coordinates (m)",LOCAL_DATUM["Local Datum",0],UNIT["metre",1,AUTHORITY["EPSG","9001"]]]"#;
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (system, [east, north], is_known) in [
        (UTM_33, [0.0, 0.0], false),
        (LOCAL, [0.0, 0.0], false),
        (UTM_33, [350_000.0, 5_300_000.0], true),
    ] {
        let json = format!(
            r#"{{"fl_x": 1000, "fl_y": 1000, "cx": 200, "cy": 150, "w": 400, "h": 300, "applied_scale": 2, "frames": [{{"file_path": "a.jpg", "transform_matrix": [[1,0,0,{east}],[0,1,0,{north}],[0,0,1,111],[0,0,0,1]]}}]}}"#
        );
        fs::write(folder.join("transforms.json"), json).unwrap();
        let corners = [(-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)];
        let points = corners.map(|(x, y)| DVec3::new(east + x, north + y, 11.0));
        write_laz(&folder.join("cloud.laz"), system, &points);
        let options = OpenOptions {
            surface: Some(folder.join("cloud.laz")),
            ..OpenOptions::default()
        };
        let model = folder.join("transforms.json");
        let opened = open_flight(&model, &options, &Progress::default()).unwrap();
        assert_eq!(opened.flight.parts().unit_known, is_known, "{system}");
        let crs = is_known.then_some("EPSG:32633");
        assert_eq!(
            opened.crs.as_deref().filter(|crs| crs.starts_with("EPSG")),
            crs
        );
        let said = opened.warnings.join("\n");
        let at_origin = said.contains("are at that map's origin");
        assert_eq!(at_origin, !is_known && system == UTM_33, "{said}");
        assert!(said.contains("2 times as large"), "{said}");
    }
}

/// A cloud whose y is up, named beside the flight.
#[test]
fn up_is_said_of_a_surface_beside_the_flight() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("cameras.xml"), cameras_xml()).unwrap();
    fs::write(folder.join("ground.xyz"), ground("EPSG:32633")).unwrap();
    let opened = open(folder, "unit = \"m\"");
    let lying = fs::read_to_string(folder.join("ground.xyz")).unwrap();
    let lying = lying.lines().map(|line| {
        let [x, y, z] = line.split(' ').collect::<Vec<_>>()[..] else {
            panic!("{line}");
        };
        let y: f64 = y.parse().unwrap();
        format!("{x} {z} {}\n", -y)
    });
    fs::write(folder.join("lying.xyz"), lying.collect::<String>()).unwrap();
    let options = OpenOptions {
        surface: Some(folder.join("lying.xyz")),
        surface_up: Some(UpAxis::Y),
        ..OpenOptions::default()
    };
    let turned = open_flight(folder, &options, &Progress::default()).unwrap();
    let points =
        |opened: &Opened| -> Vec<DVec3> { opened.flight.parts().surface.vertices().collect() };
    assert_eq!(points(&turned), points(&opened));
}

/// The ground as ECEF coordinates in a LAZ, its system as PROJ writes EPSG:4978 in WKT 2.
#[test]
fn a_cloud_from_the_earths_centre_meets_poses_from_there() {
    const SYSTEM: &str = r#"GEODCRS["WGS 84",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]]],PRIMEM["Greenwich",0,ANGLEUNIT["degree",0.0174532925199433]],CS[Cartesian,3],AXIS["(X)",geocentricX,ORDER[1],LENGTHUNIT["metre",1]],AXIS["(Y)",geocentricY,ORDER[2],LENGTHUNIT["metre",1]],AXIS["(Z)",geocentricZ,ORDER[3],LENGTHUNIT["metre",1]],ID["EPSG",4978]]"#;
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("cameras.xml"), cameras_xml()).unwrap();
    let corners = [(-1e-3, -1e-3), (1e-3, -1e-3), (1e-3, 1e-3), (-1e-3, 1e-3)];
    let points = corners.map(|(east, north)| {
        ecef_from_geographic(Geographic {
            longitude: PLACE.longitude + east,
            latitude: PLACE.latitude + north,
            ..PLACE
        })
    });
    write_laz(&folder.join("ground.laz"), SYSTEM, &points);
    let text = "format = 1\nworld.unit = \"m\"\nsurface.file = \"ground.laz\"\nphotos.reconstruction = \"cameras.xml\"\n";
    fs::write(folder.join("flight.toml"), text).unwrap();
    let opened = open_flight(folder, &OpenOptions::default(), &Progress::default()).unwrap();
    assert_eq!(opened.crs.as_deref(), Some("EPSG:32633"), "the zone");
    let said = opened.warnings.join("\n");
    assert!(
        !said.contains("degrees") && said.contains("Earth's centre"),
        "{said}"
    );
    let outcomes = opened.flight.scales(&Progress::default()).unwrap();
    let top = outcomes[0].scale().unwrap().scale.top.unwrap();
    assert!((top / 10.0 - 1.0).abs() < 1e-5, "{top}");
}

/// What states an empty system states none; flight.toml is told to leave it out.
#[test]
fn an_empty_system() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let point = |name: &str, x: i32| {
        format!(
            r#"{{"type": "Feature", "properties": {{"filename": "{name}", "xyz": [{x}, 0, 10], "opk": [0, 0, 0]}}, "geometry": null}}"#
        )
    };
    let poses = format!(
        r#"{{"type": "FeatureCollection", "world_crs": " ", "features": [{}]}}"#,
        point("a.jpg", 0)
    );
    fs::write(folder.join("poses.geojson"), poses).unwrap();
    let pile = "-50 -50 0\n50 -50 0\n50 50 0\n-50 50 0\n";
    fs::write(folder.join("pile.xyz"), pile).unwrap();
    let flight = |world: &str| {
        let text = format!(
            "format = 1\nworld.unit = \"m\"\n{world}surface.file = \"pile.xyz\"\nphotos.poses = \"poses.geojson\"\n\
             [[camera]]\nwidth = 400\nheight = 300\nfx = 1000\nfy = 1000\ncx = 200\ncy = 150\n"
        );
        fs::write(folder.join("flight.toml"), text).unwrap();
        open_flight(folder, &OpenOptions::default(), &Progress::default())
    };
    let opened = flight("").unwrap();
    assert_eq!(opened.crs, None);
    let said = opened.warnings.join("\n");
    assert!(!said.contains("coordinate"), "{said}");
    let error = flight("world.crs = \"\"\n").unwrap_err().to_string();
    assert!(
        error.contains("world.crs is empty") && error.contains("remove the key"),
        "{error}"
    );
}

/// Orthority's table of a drone's position and angles, quoted and between blanks, over a surface on a
/// map. It was taken for a list of control points.
#[test]
fn orthoritys_angles_over_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("ground.xyz"), ground("EPSG:32633")).unwrap();
    let up = PLACE.height + 100.0;
    let table = format!(
        "'filename' 'latitude' 'longitude' 'altitude' 'roll' 'pitch' 'yaw'\n\
         'a b.jpg' {} {} {up} 0 0 0\n",
        PLACE.latitude, PLACE.longitude
    );
    fs::write(folder.join("ext.csv"), table).unwrap();
    let text = "format = 1\nworld.unit = \"m\"\nsurface.file = \"ground.xyz\"\nphotos.poses = \"ext.csv\"\n\
        [[camera]]\nwidth = 400\nheight = 300\nfx = 1000\nfy = 1000\ncx = 200\ncy = 150\n";
    fs::write(folder.join("flight.toml"), text).unwrap();
    let opened = open_flight(folder, &OpenOptions::default(), &Progress::default()).unwrap();
    assert_eq!(opened.crs.as_deref(), Some("EPSG:32633"));
    assert_eq!(opened.flight.parts().photos[0].name, "a b.jpg");
    let outcomes = opened.flight.scales(&Progress::default()).unwrap();
    let scale = outcomes[0].scale().unwrap();
    assert!((scale.scale.top.unwrap() / 10.0 - 1.0).abs() < 1e-5);
    // As above: the image's top is true north.
    let [left, right] = [0, 1].map(|corner| scale.corners[corner].point().unwrap());
    let turn = (right.y - left.y).atan2(right.x - left.x).to_degrees();
    let convergence = (-2.0_f64).to_radians().tan() * 48.0_f64.to_radians().sin();
    assert!(
        (turn - convergence.atan().to_degrees()).abs() < 2e-3,
        "{turn}"
    );
}

//! Texts that name coordinate systems, and what is understood of them; against PROJ's answers.

use glam::DVec3;

use crate::geodesy::{Crs, CrsKind};

pub(super) const UTM33: &str = r#"PROJCS["WGS 84 / UTM zone 33N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",15],PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1],AXIS["Easting",EAST],AXIS["Northing",NORTH],AUTHORITY["EPSG","32633"]]"#;

/// ESRI's, GDAL's and ISO's texts without a single code.
#[test]
fn wkt_without_codes_agrees_with_proj() {
    let mut failed = String::new();
    let lines = include_str!("../pyproj_answers.tsv").lines();
    let mut compared = 0;
    for line in lines.filter(|line| !line.starts_with('#')) {
        let fields: Vec<&str> = line.split('\t').collect();
        let [name, x, y, longitude, latitude, wkt] = fields[..] else {
            panic!("{line}");
        };
        let number = |text: &str| text.parse::<f64>().unwrap();
        let point = DVec3::new(number(x), number(y), 0.0);
        match Crs::understand(wkt).map(|crs| crs.to_geographic(point)) {
            Ok(Some(place)) => {
                let east = (place.longitude - number(longitude)).abs();
                let north = (place.latitude - number(latitude)).abs();
                if east.max(north) > 1e-8 {
                    failed += &format!("{name}: {place:?}\n");
                }
            }
            other => failed += &format!("{name}: {other:?}\n"),
        }
        compared += 1;
    }
    assert!(compared > 20 && failed.is_empty(), "\n{failed}");
}

#[test]
fn the_code_of_a_wkt_is_that_of_its_projected_part() {
    let name = |text: &str| Crs::understand(text).unwrap().name().to_owned();
    assert_eq!(name(UTM33), "EPSG:32633");
    let compound = format!(
        "COMPD_CS[\"a\",{UTM33},VERT_CS[\"EGM96 height\",VERT_DATUM[\"EGM96 geoid\",2005],UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"5773\"]],AUTHORITY[\"EPSG\",\"9999\"]]"
    );
    assert_eq!(name(&compound), "EPSG:32633+5773");
    let wkt2 = r#"PROJCRS["WGS 84 / UTM zone 11N",BASEGEOGCRS["WGS 84",ID["EPSG",4326]],CONVERSION["UTM zone 11N",METHOD["Transverse Mercator",ID["EPSG",9807]]],CS[Cartesian,2],LENGTHUNIT["metre",1],ID["EPSG",32611]]"#;
    assert_eq!(name(wkt2), "EPSG:32611");
    // A code only of its parts says nothing about the whole; UTM on WGS 84 is known by its numbers.
    let nameless = UTM33.replace(r#",AUTHORITY["EPSG","32633"]"#, "");
    assert_eq!(name(&nameless), "EPSG:32633");
    let shifted = nameless.replace("500000", "500001");
    assert_eq!(name(&shifted), shifted);
    assert!(
        !Crs::understand(&shifted)
            .unwrap()
            .same_as(&Crs::understand(UTM33).unwrap())
    );
}

#[test]
fn vertical_parts() {
    let with = |vertical: &str| {
        let crs = Crs::understand(&format!("COMPD_CS[\"a\",{UTM33},{vertical}]")).unwrap();
        (crs.heights().to_owned(), crs.vertical_unit_metres())
    };
    assert_eq!(
        with(
            r#"VERT_CS["NAVD88 height (ftUS)",VERT_DATUM["x",2005],UNIT["US survey foot",0.304800609601219],AXIS["Up",UP],AUTHORITY["EPSG","6360"]]"#
        ),
        ("NAVD88".to_owned(), 0.304_800_609_601_219)
    );
    assert_eq!(
        with(
            r#"VERTCRS["pit datum",VDATUM["x"],CS[vertical,1],AXIS["up",up,LENGTHUNIT["foot",0.3048]]]"#
        ),
        ("pit datum".to_owned(), 0.3048)
    );
    assert_eq!(
        with(r#"VERT_CS["Ellipsoid (metre)",VERT_DATUM["Ellipsoid",2002],UNIT["metre",1]]"#),
        ("the ellipsoid".to_owned(), 1.0)
    );
    // A map's system with heights above its ellipsoid keeps them in its name, as it is written into a flight's file.
    let three = UTM33.replace("PROJECTION[", "CS[Cartesian,3],PROJECTION[");
    for text in [
        format!(
            r#"COMPD_CS["a",{UTM33},VERT_CS["Ellipsoid",VERT_DATUM["Ellipsoid",2002],UNIT["metre",1]]]"#
        ),
        three,
    ] {
        let crs = Crs::understand(&text).unwrap();
        assert_eq!(crs.name(), "EPSG:32633+ellipsoid");
        let again = Crs::understand(crs.name()).unwrap();
        assert_eq!(
            (again.name(), again.heights()),
            (crs.name(), "the ellipsoid")
        );
    }
    assert_eq!(Crs::understand("EPSG:4979").unwrap().name(), "EPSG:4979");
    // ESRI appends it.
    let esri = format!(
        "{UTM33},VERTCS[\"EGM96_Geoid\",VDATUM[\"EGM96_Geoid\"],PARAMETER[\"Vertical_Shift\",0.0],PARAMETER[\"Direction\",1.0],UNIT[\"Meter\",1.0]]"
    );
    assert_eq!(Crs::understand(&esri).unwrap().heights(), "EGM96_Geoid");
    let three = r#"GEOGCRS["WGS 84",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]]],CS[ellipsoidal,3],AXIS["latitude",north,ORDER[1],ANGLEUNIT["degree",0.0174532925199433]],AXIS["longitude",east,ORDER[2],ANGLEUNIT["degree",0.0174532925199433]],AXIS["height",up,ORDER[3],LENGTHUNIT["metre",1]]]"#;
    let crs = Crs::understand(three).unwrap();
    assert_eq!(
        (crs.kind(), crs.heights()),
        (CrsKind::Geographic, "the ellipsoid")
    );
    let geocentric = r#"GEOCCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["metre",1],AXIS["Geocentric X",OTHER],AXIS["Geocentric Y",OTHER],AXIS["Geocentric Z",NORTH]]"#;
    let crs = Crs::understand(geocentric).unwrap();
    assert_eq!(
        (crs.kind(), crs.heights()),
        (CrsKind::Geocentric, "the ellipsoid")
    );
    assert!(crs.same_as(&Crs::understand("ECEF").unwrap()));
}

/// The German shift of seven parameters, as TOWGS84 and as PROJ 9.5.1 writes it in WKT 2; the place
/// is PROJ's. WKT 2's coordinate frame rotation turns the other way.
#[test]
fn bound_systems() {
    let source = |towgs84: &str| {
        format!(
            r#"PROJCS["unknown",GEOGCS["unknown",DATUM["Unknown",SPHEROID["Bessel 1841",6377397.155,299.1528128]{towgs84}],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],PARAMETER["scale_factor",1],PARAMETER["false_easting",3500000],PARAMETER["false_northing",0],UNIT["metre",1]]"#
        )
    };
    let shift = ",TOWGS84[598.1,73.7,418.2,0.202,0.045,-2.455,6.7]";
    let bound = |method: &str, sign: f64| {
        format!(
            r#"BOUNDCRS[SOURCECRS[{}],TARGETCRS[GEOGCRS["WGS 84",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563]]]],ABRIDGEDTRANSFORMATION["t",METHOD["{method}",ID["EPSG",9606]],PARAMETER["X-axis translation",598.1,ID["EPSG",8605]],PARAMETER["Y-axis translation",73.7],PARAMETER["Z-axis translation",418.2],PARAMETER["X-axis rotation",{}],PARAMETER["Y-axis rotation",{}],PARAMETER["Z-axis rotation",{}],PARAMETER["Scale difference",1.0000067]]]"#,
            source(""),
            0.202 * sign,
            0.045 * sign,
            -2.455 * sign
        )
    };
    for text in [
        source(shift),
        bound("Position Vector transformation (geog2D domain)", 1.0),
        bound("Coordinate Frame rotation (geog2D domain)", -1.0),
    ] {
        let crs = Crs::understand(&text).unwrap();
        let place = crs
            .to_geographic(DVec3::new(3_500_123.4, 5_500_567.8, 7.0))
            .unwrap();
        assert!(
            (place.longitude - 9.000_672_022_224).abs() < 1e-8,
            "{place:?}"
        );
        assert!(
            (place.latitude - 49.641_815_730_042).abs() < 1e-8,
            "{place:?}"
        );
        assert_eq!(place.height, 7.0);
    }
    // Without it, where the place is is not known.
    let fault = Crs::understand(&source("")).unwrap_err();
    assert_eq!(fault.what, "how unknown relates to WGS 84 is not known");
}

proptest::proptest! {
    /// Whatever a file holds, it ends in an answer or a sentence.
    #[test]
    fn nothing_panics(cut in 0..900_usize, with in "[\\[\\]\"+=,a-z0-9. ]{0,6}") {
        let end = cut.min(UTM33.len());
        let text = format!("{}{with}{}", &UTM33[..end], &UTM33[(end + with.len()).min(UTM33.len())..]);
        if let Ok(crs) = Crs::understand(&text) {
            crs.to_geographic(DVec3::new(5e5, 5e6, 0.0));
        }
        let proj = "+proj=utm +zone=33 +datum=WGS84 +units=m";
        let end = cut.min(proj.len());
        let text = format!("{}{with}{}", &proj[..end], &proj[(end + with.len()).min(proj.len())..]);
        if let Ok(crs) = Crs::understand(&text) {
            crs.to_geographic(DVec3::new(5e5, 5e6, 0.0));
        }
        let _ = Crs::understand(&with);
    }
}

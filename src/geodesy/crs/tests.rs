//! Known places, worked examples, what is refused.

use super::*;
use crate::units::LengthUnit;

fn at(crs: &str, x: f64, y: f64, z: f64) -> Geographic {
    let crs = Crs::understand(crs).unwrap();
    crs.to_geographic(DVec3::new(x, y, z)).unwrap()
}

fn refusal(text: &str) -> String {
    Crs::understand(text).unwrap_err().what
}

/// Degrees, minutes, seconds.
fn dms(degrees: f64, minutes: f64, seconds: f64) -> f64 {
    degrees + minutes / 60.0 + seconds / 3600.0
}

/// Answers of PROJ through pyproj 3.
#[test]
fn known_places() {
    // (system, x, y, longitude, latitude, tolerance in degrees)
    for (crs, x, y, lon, lat, tolerance) in [
        (
            "EPSG:32633",
            500_000.0,
            5_000_000.0,
            15.0,
            45.153_477_183_4,
            1e-9,
        ),
        (
            "EPSG:32633",
            450_123.456,
            5_123_456.789,
            14.352_796_991_7,
            46.262_855_832_7,
            1e-9,
        ),
        (
            "EPSG:32719",
            496_523.2,
            7_321_456.7,
            -69.034_241_463_4,
            -24.219_628_998_0,
            1e-9,
        ),
        (
            "EPSG:2154",
            652_469.0,
            6_862_035.0,
            2.352_199_719_5,
            48.856_597_665_4,
            1e-9,
        ),
        (
            "EPSG:26910",
            491_000.0,
            5_459_000.0,
            -123.123_751_799_3,
            49.283_686_421_4,
            1e-8,
        ),
        (
            "EPSG:2193",
            1_749_000.0,
            5_428_000.0,
            174.779_336_132_3,
            -41.285_699_262_1,
            1e-8,
        ),
        (
            "EPSG:28350",
            400_000.0,
            6_450_000.0,
            115.940_382_706_2,
            -32.081_855_662_8,
            1e-8,
        ),
        (
            "EPSG:7850",
            400_000.0,
            6_450_000.0,
            115.940_382_706_2,
            -32.081_855_662_8,
            1e-8,
        ),
        (
            "EPSG:3857",
            1_000_000.0,
            6_000_000.0,
            8.983_152_841_2,
            47.353_704_702_4,
            1e-8,
        ),
        (
            "EPSG:2285",
            1_277_000.0,
            232_000.0,
            -122.307_191_116_4,
            47.626_477_520_8,
            1e-8,
        ),
        // PROJ uses grids or newer parameters here: some metres.
        (
            "EPSG:28992",
            121_687.0,
            487_484.0,
            4.898_009_893_4,
            52.374_218_164_1,
            5e-5,
        ),
        (
            "EPSG:27700",
            530_000.0,
            180_000.0,
            -0.128_353_940_5,
            51.503_990_827_6,
            5e-5,
        ),
    ] {
        let found = at(crs, x, y, 12.5);
        assert!(
            (found.longitude - lon).abs() < tolerance,
            "{crs}: {found:?}"
        );
        assert!((found.latitude - lat).abs() < tolerance, "{crs}: {found:?}");
    }
}

/// The worked examples of EPSG guidance note 7-2 (2019).
#[test]
fn worked_examples_of_epsg() {
    let place = |longitude, latitude| Geographic {
        longitude,
        latitude,
        height: 0.0,
    };
    for (crs, place, x, y) in [
        // 3.5.3, Transverse Mercator (South Orientated): westing and southing.
        (
            "EPSG:2053",
            place(dms(28.0, 16.0, 57.479), -dms(25.0, 43.0, 55.302)),
            71_984.49,
            2_847_342.74,
        ),
        // 3.3.2, Polar Stereographic (variant A).
        ("EPSG:32661", place(44.0, 73.0), 3_320_416.75, 632_668.43),
    ] {
        let crs = Crs::understand(crs).unwrap();
        let found = crs.from_geographic(place).unwrap();
        // The note gives the places to 0.001 seconds, 3 cm.
        assert!(
            (found.x - x).abs() < 0.02 && (found.y - y).abs() < 0.02,
            "{found}"
        );
    }
    // On their own datums: the shift is taken out by putting the ellipsoid in its place.
    for (text, place, x, y) in [
        // 3.5.1, Mercator (variant A), Makassar / NEIEZ.
        (
            "+proj=merc +lon_0=110 +k_0=0.997 +x_0=3900000 +y_0=900000 +ellps=bessel +nadgrids=@null",
            place(120.0, -3.0),
            5_009_726.58,
            569_150.82,
        ),
        // 3.1.1.2, Lambert Conic Conformal (1SP), JAD69 / Jamaica National Grid.
        (
            "+proj=lcc +lat_1=18 +lat_0=18 +lon_0=-77 +k_0=1 +x_0=250000 +y_0=150000 +ellps=clrk66 +nadgrids=@null",
            place(-dms(76.0, 56.0, 37.26), dms(17.0, 55.0, 55.80)),
            255_966.58,
            142_493.51,
        ),
        // 3.1.1.1, Lambert Conic Conformal (2SP), NAD27 / Texas South Central, in US feet.
        (
            "+proj=lcc +lat_1=28.38333333333333 +lat_2=30.28333333333333 +lat_0=27.83333333333333 +lon_0=-99 +x_0=609601.2192024384 +y_0=0 +ellps=clrk66 +nadgrids=@null +units=us-ft",
            place(-96.0, 28.5),
            2_963_503.91,
            254_759.80,
        ),
    ] {
        let found = Crs::understand(text)
            .unwrap()
            .from_geographic(place)
            .unwrap();
        assert!(
            (found.x - x).abs() < 0.01 && (found.y - y).abs() < 0.01,
            "{found}"
        );
    }
}

/// The prime meridian of Paris, 2 20 14.025 E: the origin of NTF / Lambert zone II lies on it.
#[test]
fn other_prime_meridians() {
    let text = "+proj=lcc +lat_1=46.8 +lat_0=46.8 +lon_0=0 +k_0=0.99987742 +x_0=600000 +y_0=2200000 +a=6378249.2 +b=6356515 +pm=paris +nadgrids=@null";
    let place = at(text, 600_000.0, 2_200_000.0, 0.0);
    assert!(
        (place.longitude - dms(2.0, 20.0, 14.025)).abs() < 1e-7,
        "{place:?}"
    );
    assert!((place.latitude - 46.8).abs() < 1e-9);
    // With its shift of (-168, -60, 320) m: PROJ's answer for those steps.
    let shifted = at("EPSG:27572", 700_000.0, 2_300_000.0, 0.0);
    assert!(
        (shifted.longitude - 3.668_692_443_289).abs() < 1e-9,
        "{shifted:?}"
    );
    assert!(
        (shifted.latitude - 47.691_879_000_030).abs() < 1e-9,
        "{shifted:?}"
    );
}

#[test]
fn there_and_back() {
    for text in [
        "EPSG:32633",
        "EPSG:2154",
        "EPSG:2285",
        "EPSG:27700",
        "EPSG:28992",
        "EPSG:27572",
        "EPSG:2053",
        "EPSG:4326",
        "EPSG:4979",
        "ECEF",
        "EPSG:32617+6360",
        "EPSG:3857",
    ] {
        let crs = Crs::understand(text).unwrap();
        let middle = crs.definition.proj.central_meridian();
        let latitude = match text {
            "EPSG:2053" => -26.0,
            _ => 50.0,
        };
        let place = Geographic {
            longitude: middle + 1.25,
            latitude,
            height: 321.5,
        };
        let point = crs.from_geographic(place).unwrap();
        let back = crs.to_geographic(point).unwrap();
        let apart = ecef_from_geographic(back).distance(ecef_from_geographic(place));
        // Rotations of a datum are undone to the first order only (EPSG method 9606).
        assert!(apart < 5e-4, "{text}: {apart}");
        assert!((back.height - place.height).abs() < 1e-7);
    }
}

#[test]
fn texts_that_mean_the_same() {
    let utm17 = Crs::understand("EPSG:32617").unwrap();
    for text in [
        "epsg : 32617",
        "urn:ogc:def:crs:EPSG::32617",
        "http://www.opengis.net/def/crs/EPSG/0/32617",
        "WGS84 UTM 17N",
        "WGS 84 / UTM zone 17N",
        "WGS_1984_UTM_Zone_17N",
        "+proj=utm +zone=17 +datum=WGS84 +units=m +no_defs +type=crs",
        "+proj=utm +zone=17 +ellps=WGS84 +units=m +no_defs=True",
        "+init=epsg:32617",
        "+proj=tmerc +lat_0=0 +lon_0=-81 +k=0.9996 +x_0=500000 +y_0=0 +datum=WGS84 +units=m",
        crs_definitions::from_code(32_617).unwrap().wkt,
    ] {
        let crs = Crs::understand(text).unwrap();
        assert_eq!(crs.name(), "EPSG:32617", "{text}");
        assert!(crs.same_as(&utm17));
    }
    let south = Crs::understand("WGS84 UTM 7S").unwrap();
    assert_eq!(south.name(), "EPSG:32707");
    assert!(!south.same_as(&utm17));
    for (text, name, kind) in [
        ("ECEF", "EPSG:4978", CrsKind::Geocentric),
        (
            "+proj=geocent +datum=WGS84 +units=m",
            "EPSG:4978",
            CrsKind::Geocentric,
        ),
        ("WGS 84", "EPSG:4326", CrsKind::Geographic),
        ("OGC:CRS84", "EPSG:4326", CrsKind::Geographic),
        ("EPSG:9518", "EPSG:4326+3855", CrsKind::Geographic),
        ("EPSG:25832+5783", "EPSG:25832+5783", CrsKind::Projected),
    ] {
        let crs = Crs::understand(text).unwrap();
        assert_eq!((crs.name(), crs.kind()), (name, kind), "{text}");
        assert!(Crs::understand(crs.name()).unwrap().same_as(&crs));
    }
    // A code that only its WKT explains.
    let wkt = crs_definitions::from_code(32_617).unwrap().wkt;
    let unknown = wkt.replace("32617", "65001").replace("500000", "500100");
    let crs = Crs::understand(&unknown).unwrap();
    assert_eq!(crs.name(), unknown);
    assert!(!crs.same_as(&utm17));
}

#[test]
fn utm_zones() {
    for zone in 1..=60_u32 {
        for (latitude, base) in [(10.0, 32_600), (-10.0, 32_700)] {
            let place = Geographic {
                longitude: f64::from(zone) * 6.0 - 184.0,
                latitude,
                height: 100.0,
            };
            let crs = Crs::utm_at(place);
            assert_eq!(crs.name(), format!("EPSG:{}", base + zone));
            assert!(crs.same_as(&Crs::understand(crs.name()).unwrap()));
            let point = crs.from_geographic(place).unwrap();
            assert!((200_000.0..800_000.0).contains(&point.x));
            assert_eq!(point.z, 100.0);
        }
    }
    let zone = |longitude| {
        Crs::utm_at(Geographic {
            longitude,
            latitude: 1.0,
            height: 0.0,
        })
        .name()
        .to_owned()
    };
    assert_eq!(zone(180.0), "EPSG:32601");
    assert_eq!(zone(-180.0), "EPSG:32601");
    assert_eq!(zone(179.999), "EPSG:32660");
    assert_eq!(zone(f64::NAN), "EPSG:32601");
}

#[test]
fn units_and_heights() {
    let crs = Crs::understand("EPSG:2285").unwrap();
    assert!((crs.unit_metres() / LengthUnit::UsSurveyFoot.metres() - 1.0).abs() < 1e-12);
    assert_eq!(crs.vertical_unit_metres(), crs.unit_metres());
    assert_eq!(crs.heights(), "not said");
    let crs = Crs::understand("EPSG:32633+5773").unwrap();
    assert_eq!(
        (crs.vertical_unit_metres(), crs.heights()),
        (1.0, "the geoid EGM96")
    );
    assert_eq!(crs.heights_apart(), None);
    let feet = Crs::understand("EPSG:32633+6360").unwrap().heights_apart();
    let feet = feet.unwrap();
    assert!(feet.contains("heights in units of 0.30480060"), "{feet}");
    assert!(feet.ends_with("x and y in units of 1 m"), "{feet}");
    assert_eq!(Crs::understand("ECEF").unwrap().heights(), "the ellipsoid");
    assert_eq!(
        Crs::understand("EPSG:4979").unwrap().heights(),
        "the ellipsoid"
    );
    let grid =
        Crs::understand("+proj=utm +zone=33 +datum=WGS84 +geoidgrids=egm96_15.gtx +vunits=us-ft")
            .unwrap();
    assert_eq!(grid.heights(), "the geoid of egm96_15.gtx");
    let place = Geographic {
        longitude: 15.0,
        latitude: 45.0,
        height: 1200.0 / 3937.0,
    };
    assert!((grid.from_geographic(place).unwrap().z - 1.0).abs() < 1e-12);
    assert!(!grid.same_as(&Crs::understand("EPSG:32633").unwrap()));
}

/// The convergence on a sphere is atan(tan(dlon) sin(lat)); the ellipsoid adds a few millionths.
#[test]
fn the_grid_turns_by_the_convergence() {
    let utm = Crs::understand("EPSG:32633").unwrap();
    let place = Geographic {
        longitude: 17.0,
        latitude: 50.0,
        height: 0.0,
    };
    let grid = utm.grid_from_enu(place).unwrap();
    let convergence = (2_f64.to_radians().tan() * 50_f64.to_radians().sin()).atan();
    // East of the central meridian, north leans to the west of grid north... seen from the grid,
    // true north points to the left.
    let north = grid * DVec3::Y;
    assert!(
        ((-north.x).atan2(north.y) - convergence).abs() < 2e-5,
        "{north}"
    );
    assert!((grid.determinant() - 1.0).abs() < 1e-14);
    assert_eq!(grid * DVec3::Z, DVec3::Z);
    let middle = Geographic {
        longitude: 15.0,
        ..place
    };
    let grid = utm.grid_from_enu(middle).unwrap();
    assert!((grid * DVec3::Y - DVec3::Y).length() < 1e-9);
    // South Africa's axes: west and south.
    let lo = Crs::understand("EPSG:2053").unwrap();
    let grid = lo
        .grid_from_enu(Geographic {
            longitude: 29.0,
            latitude: -26.0,
            height: 0.0,
        })
        .unwrap();
    assert!((grid * DVec3::Y - DVec3::NEG_Y).length() < 1e-9);
    assert!((grid * DVec3::X - DVec3::NEG_X).length() < 1e-9);
    let ecef = Crs::understand("ECEF").unwrap();
    assert_eq!(ecef.grid_from_enu(place), Some(enu_axes(place)));
}

/// UTM's factor in the middle of its zone; Web Mercator's a / (M cos(latitude)), with M the radius of
/// the meridian (EPSG guidance note 7-2, 3.5.2).
#[test]
fn the_grid_is_longer_or_shorter_than_the_ground() {
    let place = Geographic {
        longitude: 15.0,
        latitude: 60.0,
        height: 0.0,
    };
    let scale = |name: &str| Crs::understand(name).unwrap().grid_scale(place).unwrap();
    assert!((scale("EPSG:32633") - 0.9996).abs() < 1e-9);
    let e2 = 0.006_694_379_990_14;
    let meridian = 6_378_137.0 * (1.0 - e2) / (1.0_f64 - e2 * 0.75).powf(1.5);
    let expected = 6_378_137.0 / (meridian * 0.5);
    assert!((scale("EPSG:3857") / expected - 1.0).abs() < 1e-9);
    assert_eq!(scale("ECEF"), 1.0);
    // In feet as in metres.
    let place = Geographic {
        longitude: -120.8,
        latitude: 47.9,
        height: 0.0,
    };
    let feet = Crs::understand("EPSG:2285").unwrap().grid_scale(place);
    assert!((feet.unwrap() - 1.0).abs() < 2e-4, "{feet:?}");
}

#[test]
fn what_is_not_understood_says_why() {
    // NAD27 needs a grid.
    assert_eq!(
        refusal("EPSG:26710"),
        "how EPSG:26710 relates to WGS 84 is not known"
    );
    assert!(refusal("EPSG:65000").contains("65000"));
    assert!(refusal("EPSG:650000000").contains("650000000"));
    assert!(refusal("EPSG:x").contains("'x'"));
    assert!(refusal("").contains("empty"));
    assert!(refusal("mine grid 3").contains("'mine grid 3'"));
    assert!(refusal("+proj=nowhere +datum=WGS84").contains("projections"));
    assert!(refusal("+proj=utm +zone=17").contains("relates"));
    assert!(refusal("+proj=utm +zone=99 +datum=WGS84").contains("projections"));
    assert!(refusal("WGS84 UTM 61N").contains("not known"));
    assert!(refusal("LOCAL_CS[\"pit\",UNIT[\"m\",1]]").contains("no place"));
    // NTF (Paris) counts in grads.
    assert!(refusal("EPSG:4807").contains("not in degrees"));
    // Far outside, the projection has no answer rather than a wrong one.
    let utm = Crs::understand("EPSG:32633").unwrap();
    assert_eq!(utm.to_geographic(DVec3::new(1e9, 1e9, 0.0)), None);
    assert_eq!(utm.to_geographic(DVec3::new(f64::NAN, 0.0, 0.0)), None);
    let lonlat = Crs::understand("EPSG:4326").unwrap();
    assert_eq!(lonlat.to_geographic(DVec3::new(0.0, 91.0, 0.0)), None);
}

/// By hand: a mark's easting of 452 272 m read as a northing lies four degrees north of the equator, where zone 33 is no longer made for the
/// easting of 5 411 842.
#[test]
fn swapped_coordinates_are_named_as_such() {
    let utm = Crs::understand("EPSG:32633").unwrap();
    let place = |x: f64, y: f64| utm.to_geographic(DVec3::new(x, y, 300.0)).unwrap();
    let swapped = utm
        .check_lengths(place(5_411_841.7, 452_272.3))
        .unwrap_err();
    assert!(
        swapped
            .remedy
            .starts_with("give the easting first, then the northing"),
        "{swapped}"
    );
    assert_eq!(utm.check_lengths(place(452_272.3, 5_411_841.7)), Ok(None));
    // Another zone's lie nowhere near, either way round.
    let other = utm
        .check_lengths(place(3_500_000.0, 5_411_841.7))
        .unwrap_err();
    assert!(
        other.remedy.starts_with("give the coordinate system"),
        "{other}"
    );
}

use std::io::Cursor;

use exif::{Field, Tag};
use proptest::prelude::*;

use super::*;
use crate::camera::Distortion;
use fragscale_test_data::jpeg::{gps, jpeg, packet, rationals, segment, short, text, tiff};
use fragscale_test_data::shared_data;

pub(super) fn photo(bytes: Vec<u8>) -> PhotoMetadata {
    read(Cursor::new(bytes)).unwrap()
}

pub(super) fn with_xmp(descriptions: &str) -> PhotoMetadata {
    photo(jpeg((4000, 3000), &[], &[&packet(descriptions)]))
}

/// Where the camera looks and where its image's top points, in east, north, up.
fn looks(photo: &PhotoMetadata) -> (DVec3, DVec3) {
    let pose = photo.orientation.unwrap().pose(DVec3::ZERO);
    (pose.rotation.z_axis, -pose.rotation.y_axis)
}

#[track_caller]
pub(super) fn assert_looks(photo: &PhotoMetadata, forward: DVec3, top: DVec3) {
    let (is_forward, is_top) = looks(photo);
    assert!(
        is_forward.abs_diff_eq(forward, 1e-12) && is_top.abs_diff_eq(top, 1e-12),
        "looks to {is_forward}, top to {is_top}"
    );
}

pub(super) const EAST: DVec3 = DVec3::X;
pub(super) const DOWN: DVec3 = DVec3::NEG_Z;
#[test]
fn exif_place_and_camera() {
    let fields = [
        &gps()[..],
        &[
            text(Tag::Make, "Maker\0\0\0"),
            text(Tag::Model, "M 1"),
            text(Tag::BodySerialNumber, "0042"),
            text(Tag::DateTimeOriginal, "2024:05:06 07:08:09"),
        ],
    ]
    .concat();
    let photo = photo(jpeg((4000, 3000), &fields, &[]));
    assert_eq!(photo.size, (4000, 3000));
    assert_eq!(photo.make.as_deref(), Some("Maker"));
    assert_eq!(photo.model.as_deref(), Some("M 1"));
    assert_eq!(photo.serial.as_deref(), Some("0042"));
    assert_eq!(photo.time.as_deref(), Some("2024:05:06 07:08:09"));
    let place = photo.place.unwrap();
    assert!((place.place.latitude - 47.5001).abs() < 1e-12);
    assert!((place.place.longitude + 16.25005).abs() < 1e-12);
    assert_eq!(place.place.height, 200.5);
    assert_eq!(place.height, Some(HeightReference::SeaLevel));
    assert_eq!(photo.warnings, [""; 0]);
    assert_eq!((photo.orientation, photo.focal), (None, vec![]));
}

#[test]
fn dji_as_attributes_and_as_elements() {
    let attributes = with_xmp(
        r#"<rdf:Description rdf:about="DJI Meta Data" tiff:Make="DJI" tiff:Model="FC6310R"
        drone-dji:GpsLatitude="+47.500123456" drone-dji:GpsLongtitude="+16.250987654"
        drone-dji:AbsoluteAltitude="+513.07" drone-dji:RelativeAltitude="+50.10"
        drone-dji:GimbalYawDegree="+90.00" drone-dji:GimbalPitchDegree="-90.00"
        drone-dji:GimbalRollDegree="+0.00" drone-dji:FlightYawDegree="+12.00"
        drone-dji:RtkFlag="50" drone-dji:RtkStdLon="0.01" drone-dji:RtkStdLat="0.02"
        drone-dji:RtkStdHgt="0.03" drone-dji:LRFStatus="Normal" drone-dji:LRFTargetDistance="48.2"/>"#,
    );
    let elements = with_xmp(
        "<rdf:Description tiff:Make=\"DJI\" tiff:Model=\"FC6310R\">
        <drone-dji:GpsLatitude>47.500123456</drone-dji:GpsLatitude>
        <drone-dji:GpsLongitude>16.250987654</drone-dji:GpsLongitude>
        <drone-dji:AbsoluteAltitude>+513.07</drone-dji:AbsoluteAltitude>
        <drone-dji:RelativeAltitude> +50.10 </drone-dji:RelativeAltitude></rdf:Description>
        <rdf:Description><drone-dji:GimbalYawDegree>+90.00</drone-dji:GimbalYawDegree>
        <drone-dji:GimbalPitchDegree>-90</drone-dji:GimbalPitchDegree>
        <drone-dji:GimbalRollDegree>0</drone-dji:GimbalRollDegree>
        <drone-dji:RtkFlag>50</drone-dji:RtkFlag><drone-dji:RtkStdLon>0.01</drone-dji:RtkStdLon>
        <drone-dji:RtkStdLat>0.02</drone-dji:RtkStdLat>
        <drone-dji:RtkStdHgt>0.03</drone-dji:RtkStdHgt>
        <drone-dji:LRFTargetDistance>48.2</drone-dji:LRFTargetDistance></rdf:Description>",
    );
    for photo in [&attributes, &elements] {
        assert_eq!(photo, &attributes);
        let place = photo.place.unwrap();
        let expected = Geographic {
            longitude: 16.250987654,
            latitude: 47.500123456,
            height: 513.07,
        };
        assert_eq!(place.place, expected);
        assert_eq!(place.height, Some(HeightReference::Ellipsoid));
        assert_eq!(place.fix, Some(Fix::RtkFixed));
        assert_eq!(place.deviation, Some(DVec3::new(0.01, 0.02, 0.03)));
        assert_eq!(photo.relative_altitude, Some(50.1));
        assert_eq!(photo.laser_range, Some(48.2));
        assert_looks(photo, DOWN, EAST);
    }
    // Half a turn about the view at nadir still looks down, and the top to the west.
    let rolled = with_xmp(
        r#"<rdf:Description drone-dji:GimbalYawDegree="+90.00" drone-dji:GimbalPitchDegree="-90.00" drone-dji:GimbalRollDegree="+180.00"/>"#,
    );
    assert_looks(&rolled, DOWN, -EAST);
}

#[test]
fn the_finer_place_counts() {
    let exif = gps();
    let coarse = packet(
        r#"<rdf:Description drone-dji:GpsLatitude="47.5" drone-dji:GpsLongitude="-16.25"/>"#,
    );
    let place = |packet: &str| photo(jpeg((40, 30), &exif, &[packet])).place.unwrap().place;
    assert!((place(&coarse).latitude - 47.5001).abs() < 1e-12);
    let fine = packet(
        r#"<rdf:Description drone-dji:GpsLatitude="47.500112345" drone-dji:GpsLongitude="-16.250054321"/>"#,
    );
    assert_eq!(place(&fine).latitude, 47.500112345);
    assert_eq!(place(&fine).longitude, -16.250054321);
    // The height is EXIF's.
    assert_eq!(place(&fine).height, 200.5);
    let elsewhere = packet(
        r#"<rdf:Description drone-dji:GpsLatitude="48.500112345" drone-dji:GpsLongitude="-16.250054321"/>"#,
    );
    let photo = photo(jpeg((40, 30), &exif, &[&elsewhere]));
    assert!((photo.place.unwrap().place.latitude - 47.5001).abs() < 1e-12);
    assert!(
        photo.warnings[0].contains("1.0000 degrees apart"),
        "{:?}",
        photo.warnings
    );
    // A receiver without a fix writes zeros.
    let zero = with_xmp(
        r#"<rdf:Description drone-dji:GpsLatitude="+0.000000" drone-dji:GpsLongitude="0"/>"#,
    );
    assert_eq!(zero.place, None);
}

#[test]
fn heights_of_dji_without_rtk_are_the_barometers() {
    let fields = [&gps()[..], &[text(Tag::Make, "DJI")]].concat();
    let of = |attributes: &str| {
        let packet = packet(&format!("<rdf:Description {attributes}/>"));
        let place = photo(jpeg((40, 30), &fields, &[&packet])).place.unwrap();
        (place.place.height, place.height.unwrap())
    };
    assert_eq!(of(""), (200.5, HeightReference::Barometer));
    let absolute = r#"drone-dji:AbsoluteAltitude="-3.25""#;
    assert_eq!(of(absolute), (-3.25, HeightReference::Barometer));
    let rtk = format!(r#"{absolute} drone-dji:AltitudeType="RtkAlt""#);
    assert_eq!(of(&rtk), (-3.25, HeightReference::Ellipsoid));
}

#[test]
fn skydio_place_and_calibration() {
    // The values of support.skydio.com for the Skydio 2.
    let photo = photo(jpeg(
        (4056, 3040),
        &[],
        &[&packet(
            r#"<rdf:Description drone-skydio:Latitude="37.5" drone-skydio:Longitude="-122.25" drone-skydio:AbsoluteAltitude="12.5" drone-skydio:DewarpData="0.13000, -0.24000, 0.10400"><drone-skydio:CalibratedFocalLength drone-skydio:X="2376.5625" drone-skydio:Y="2376.5625"/><drone-skydio:CalibratedOpticalCenter drone-skydio:X="2027.5000" drone-skydio:Y="1519.5000"/></rdf:Description>"#,
        )],
    ));
    assert_eq!(
        photo.place.unwrap().height,
        Some(HeightReference::Ellipsoid)
    );
    let focal = photo.focal[0];
    assert_eq!(focal.source, FocalSource::SkydioCalibrated);
    assert_eq!((focal.fx, focal.cx, focal.cy), (2376.5625, 2028.0, 1520.0));
    assert!(
        photo.warnings[0].contains("0.13000"),
        "{:?}",
        photo.warnings
    );
}

#[test]
fn a_calibration_of_another_image_size_is_not_used() {
    // A thermal photo of a Skydio X2 (S1008521.JPG of Theta-Limited/OpenAthenaIOS) is 640 x 512.
    let photo = photo(jpeg(
        (640, 512),
        &[],
        &[&packet(
            r#"<rdf:Description><drone-skydio:CalibratedFocalLength drone-skydio:X="4892.025463" drone-skydio:Y="4870.411816"/><drone-skydio:CalibratedOpticalCenter drone-skydio:X="1989.282132" drone-skydio:Y="1443.797021"/></rdf:Description>"#,
        )],
    ));
    assert!(photo.focal.is_empty());
    let said = photo
        .warnings
        .iter()
        .any(|w| w.contains("another image size"));
    assert!(said, "{:?}", photo.warnings);
}

#[test]
fn dewarp_data_of_a_phantom_4_rtk() {
    // As quoted in a question on DewarpData (thinbug.com/q/53511464), photos of 5472 x 3648.
    let packet = |flag: u8| {
        packet(&format!(
            r#"<rdf:Description drone-dji:CalibratedFocalLength="3666.666504" drone-dji:CalibratedOpticalCenterX="2736.000000" drone-dji:CalibratedOpticalCenterY="1824.000000" drone-dji:DewarpData=" 2018-03-13;3659.780000000000,3653.170000000000,-7.710000000000,45.900000000000,-0.269478000000,0.115681000000,-0.000087561900,-0.000306177000,-0.035762800000" drone-dji:DewarpFlag="{flag}"/>"#
        ))
    };
    let raw = photo(jpeg((5472, 3648), &[], &[&packet(0)]));
    let sources: Vec<FocalSource> = raw.focal.iter().map(|focal| focal.source).collect();
    assert_eq!(sources, [FocalSource::Dewarp, FocalSource::DesignedLens]);
    let dewarp = raw.focal[0];
    assert_eq!((dewarp.fx, dewarp.fy), (3659.78, 3653.17));
    assert_eq!((dewarp.cx, dewarp.cy), (2736.0 - 7.71, 1824.0 + 45.9));
    // k1 k2 p1 p2 k3, OpenCV's order as DJI's.
    let coefficients = [
        -0.269478,
        0.115681,
        -8.75619e-5,
        -0.000306177,
        -0.0357628,
        0.0,
        0.0,
        0.0,
    ];
    assert_eq!(dewarp.distortion.coefficients(), coefficients);
    // Rectified in the camera: the distortion is gone.
    let rectified = photo(jpeg((5472, 3648), &[], &[&packet(1)]));
    assert_eq!(rectified.focal.len(), 1);
    assert_eq!(rectified.focal[0].fx, 3666.666504);
    assert_eq!(rectified.focal[0].distortion, Distortion::None);
    // Reduced to a half since: EXIF still knows the camera's size.
    let size = [
        short(Tag::PixelXDimension, 5472),
        short(Tag::PixelYDimension, 3648),
    ];
    let half = photo(jpeg((2736, 1824), &size, &[&packet(0)]));
    assert_eq!(
        (half.focal[0].fx, half.focal[0].cx),
        (1829.89, (2736.0 - 7.71) / 2.0)
    );
    let cut = photo(jpeg((2736, 1000), &size, &[&packet(0)]));
    assert_eq!(cut.focal, []);
    assert!(cut.warnings[0].contains("it was cut"), "{:?}", cut.warnings);
    // Turned by a viewer: the calibration is of the upright photo, its nominal focal length of both.
    let mut with_film = size.to_vec();
    with_film.push(short(Tag::FocalLengthIn35mmFilm, 24));
    let upright = photo(jpeg((2736, 1824), &with_film, &[]));
    let turned = photo(jpeg((1824, 2736), &with_film, &[&packet(0)]));
    let [of_upright, of_turned] = [&upright, &turned].map(|photo| &photo.focal[..]);
    assert_eq!((of_upright.len(), of_turned.len()), (1, 1));
    assert_eq!(of_turned[0].fx, of_upright[0].fx);
    assert_eq!((of_turned[0].cx, of_turned[0].cy), (912.0, 1368.0));
    assert!(turned.warnings[0].contains("it was turned"), "{turned:?}");
    for data in [
        "2018-03-13;1,2",
        ";",
        "a,b",
        "1,2,3,4,5,6,7,8,9,10,11,12,13",
        "0,0,0,0",
        "nan,1,1,1",
    ] {
        let photo = with_xmp(&format!(
            r#"<rdf:Description drone-dji:DewarpData="{data}"/>"#
        ));
        assert_eq!(photo.focal, [], "{data}");
    }
}

#[test]
fn focal_length_by_the_sensor_and_by_film() {
    // 10 mm, 100 pixels per mm both ways: 1000 px; 10 mm on 43.27 mm film at a diagonal of 5000.
    let fields = |unit, resolution| {
        vec![
            rationals(Tag::FocalLength, &[(100, 10)]),
            rationals(Tag::FocalPlaneXResolution, &[resolution]),
            rationals(Tag::FocalPlaneYResolution, &[resolution]),
            short(Tag::FocalPlaneResolutionUnit, unit),
            short(Tag::FocalLengthIn35mmFilm, 10),
        ]
    };
    for (unit, resolution) in [(2, (2540, 1)), (3, (1000, 1)), (4, (100, 1)), (5, (1, 10))] {
        let photo = photo(jpeg((4000, 3000), &fields(unit, resolution), &[]));
        let [plane, film] = photo.focal.as_slice() else {
            panic!("{:?}", photo.focal);
        };
        assert!((plane.fx - 1000.0).abs() < 1e-9, "{unit}: {}", plane.fx);
        assert_eq!((plane.cx, plane.cy), (2000.0, 1500.0));
        // 2 % and half of a tenth of 10 mm.
        assert!((plane.relative_error - 0.025).abs() < 1e-12);
        // 36 x 24 mm: sqrt(1872) = 43.2666 mm.
        assert!((film.fx - 10.0 * 5000.0 / 1872.0_f64.sqrt()).abs() < 1e-9);
        assert!((film.relative_error - 0.08).abs() < 1e-12);
    }
    // Turned since, of pixels that are not square: 100 of them a millimetre along the sensor's rows, 101 across.
    let of_sensor = [
        rationals(Tag::FocalLength, &[(100, 10)]),
        rationals(Tag::FocalPlaneXResolution, &[(100, 1)]),
        rationals(Tag::FocalPlaneYResolution, &[(101, 1)]),
        short(Tag::FocalPlaneResolutionUnit, 4),
        short(Tag::PixelXDimension, 4000),
        short(Tag::PixelYDimension, 3000),
    ];
    let turned = photo(jpeg((3000, 4000), &of_sensor, &[]));
    let [plane] = turned.focal.as_slice() else {
        panic!("{:?}", turned.focal);
    };
    assert!((plane.fx - 1010.0).abs() < 1e-9 && (plane.fy - 1000.0).abs() < 1e-9);
    assert_eq!((plane.cx, plane.cy), (1500.0, 2000.0));
    // Nothing known of the sensor: a denominator of 0.
    let unknown = photo(jpeg((4000, 3000), &fields(2, (0, 0)), &[]));
    assert_eq!(unknown.focal.len(), 1);
    // sensefly.jpg of cdcseacave/TinyEXIF: reduced from 5472 x 3648 with its EXIF's 4167 pixels per cm.
    let fields = [
        rationals(Tag::FocalLength, &[(102, 10)]),
        rationals(Tag::FocalPlaneXResolution, &[(4167, 1)]),
        rationals(Tag::FocalPlaneYResolution, &[(4167, 1)]),
        short(Tag::FocalPlaneResolutionUnit, 3),
        short(Tag::FocalLengthIn35mmFilm, 28),
    ];
    let reduced = photo(jpeg((1368, 912), &fields, &[]));
    let [film] = reduced.focal.as_slice() else {
        panic!("{:?}", reduced.focal);
    };
    assert_eq!(film.source, FocalSource::FilmEquivalent);
    assert!((film.fx - 1064.0).abs() < 0.1, "{}", film.fx);
    assert!(
        reduced.warnings[0].contains("3.99 times"),
        "{:?}",
        reduced.warnings
    );
}

#[test]
fn damage_is_a_warning() {
    let broken = "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF><rdf:Description></x:xmpmeta>";
    let photo_broken = photo(jpeg((40, 30), &gps(), &[broken]));
    assert!(photo_broken.place.is_some());
    assert!(photo_broken.warnings[0].contains("XMP cannot be read"));
    let mut bytes = vec![0xff, 0xd8];
    bytes.extend(segment(0xe1, b"Exif\0\0nothing"));
    bytes.extend(jpeg((40, 30), &[], &[]).split_off(2));
    let photo_odd = photo(bytes);
    assert!(photo_odd.warnings[0].contains("EXIF cannot be read"));
    assert!(read(Cursor::new(b"no image".to_vec())).is_err());
    assert!(read(Cursor::new(Vec::new())).is_err());
}

#[test]
fn extended_xmp_and_png() {
    let guid = "0123456789ABCDEF0123456789ABCDEF";
    let standard = packet(&format!(
        r#"<rdf:Description xmlns:xmpNote="http://ns.adobe.com/xmp/note/" xmpNote:HasExtendedXMP="{guid}"/>"#
    ));
    let more = packet(r#"<rdf:Description drone-dji:RelativeAltitude="+12.5"/>"#);
    let (first, second) = more.as_bytes().split_at(100);
    let part = |place: u32, bytes: &[u8]| {
        let length = u32::try_from(more.len()).unwrap();
        let start = b"http://ns.adobe.com/xmp/extension/\0";
        let numbers = [length.to_be_bytes(), place.to_be_bytes()].concat();
        segment(0xe1, &[start, guid.as_bytes(), &numbers, bytes].concat())
    };
    let whole = jpeg((40, 30), &[], &[&standard]);
    let (soi, rest) = whole.split_at(2);
    // The parts in any order.
    let bytes = [soi, &part(100, second), &part(0, first), rest].concat();
    assert_eq!(photo(bytes).relative_altitude, Some(12.5));
    // Others, which the standard packet does not name: a file with 300 000 of them
    // was once looked at for minutes.
    let others: Vec<u8> = (0..2000)
        .flat_map(|number| {
            let start = "http://ns.adobe.com/xmp/extension/\0";
            segment(
                0xe1,
                format!("{start}{number:032}\0\0\0\0\0\0\0\0").as_bytes(),
            )
        })
        .collect();
    let bytes = [soi, &others, &part(0, first), &part(100, second), rest].concat();
    assert_eq!(photo(bytes).relative_altitude, Some(12.5));
    let lacking = photo([soi, &part(100, second), rest].concat());
    assert_eq!(lacking.relative_altitude, None);
    assert!(lacking.warnings[0].contains("part of the extended XMP is missing"));

    let chunk = |kind: &[u8], data: &[u8]| {
        let length = u32::try_from(data.len()).unwrap().to_be_bytes();
        [&length[..], kind, data, &[0; 4]].concat()
    };
    let header = [
        &40_u32.to_be_bytes()[..],
        &30_u32.to_be_bytes(),
        &[8, 2, 0, 0, 0],
    ]
    .concat();
    let text = [b"XML:com.adobe.xmp\0\0\0\0\0", more.as_bytes()].concat();
    let png = [
        b"\x89PNG\r\n\x1a\n".to_vec(),
        chunk(b"IHDR", &header),
        chunk(b"IDAT", &[1, 2, 3]),
        chunk(b"eXIf", &tiff(&gps())),
        chunk(b"iTXt", &text),
        chunk(b"IEND", &[]),
    ]
    .concat();
    let photo = photo(png);
    assert_eq!(
        (photo.size, photo.relative_altitude),
        ((40, 30), Some(12.5))
    );
    assert_eq!(photo.place.unwrap().place.height, 200.5);
}

#[test]
fn every_truncation_ends_in_words() {
    let packet = packet(r#"<rdf:Description drone-dji:GimbalYawDegree="1"/>"#);
    let whole = jpeg((40, 30), &gps(), &[&packet]);
    for end in 0..whole.len() {
        let _ = read(Cursor::new(whole[..end].to_vec()));
    }
}

proptest! {
    #[test]
    fn no_bytes_panic(place in 0_usize..700, bytes in prop::collection::vec(any::<u8>(), 1..8)) {
        let mut fields: Vec<Field> = gps();
        fields.push(short(Tag::FocalLengthIn35mmFilm, 20));
        let mut whole = jpeg((40, 30), &fields, &[&packet("<rdf:Description drone-dji:DewarpData=\"1;2,3,4,5\"/>")]);
        for (target, byte) in whole.iter_mut().skip(place).zip(bytes) {
            *target = byte;
        }
        let _ = read(Cursor::new(whole));
    }
}

#[test]
fn film_equivalent_of_the_sceaux_camera() {
    let Some(path) = shared_data("sceaux-images/100_7103.JPG") else {
        return;
    };
    let photo = read_file(&path).unwrap();
    assert_eq!((photo.size, photo.place), ((2832, 2128), None));
    let film = photo.focal[0];
    // K.txt, calibrated with a chart: 2905.88 px.
    let off = (film.fx / 2905.88 - 1.0).abs();
    assert!(off < 0.02 && off < film.relative_error, "{}", film.fx);
}

#[test]
fn focal_plane_of_the_kermit_camera() {
    let Some(path) = shared_data("bundler-kermit/kermit000.jpg") else {
        return;
    };
    let photo = read_file(&path).unwrap();
    let plane = photo.focal[0];
    assert_eq!(plane.source, FocalSource::FocalPlane);
    // By hand from the tags: 173/32 mm, 640000/206 pixels per inch.
    let expected = 173.0 / 32.0 * 640_000.0 / 206.0 / 25.4;
    assert!((plane.fx - expected).abs() < 1e-9, "{}", plane.fx);
}

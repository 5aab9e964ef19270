//! Whose angles a photo's XMP holds: every namespace and convention, and those that are not known.

use exif::Tag;
use glam::DVec3;

use super::tests::{DOWN, EAST, assert_looks, photo, with_xmp};
use super::{Angles, PhotoMetadata};
use fragscale_test_data::jpeg::{gps, jpeg, packet, text};

const NORTH: DVec3 = DVec3::Y;

/// A packet with one namespace, under that prefix.
fn in_namespace(prefix: &str, uri: &str, attributes: &str) -> String {
    format!(
        r#"<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description xmlns:{prefix}="{uri}" {attributes}/></rdf:RDF></x:xmpmeta>"#
    )
}

fn of_make(make: &str, packets: &[&str]) -> PhotoMetadata {
    let fields = [gps(), vec![text(Tag::Make, make)]].concat();
    photo(jpeg((4000, 3000), &fields, packets))
}

#[test]
fn autel_parrot_skydio_and_sensefly() {
    // Each looks down with its image's top to the east.
    for descriptions in [
        r#"<rdf:Description rdf:about="DJI Meta Data" drone:GimbalYawDegree="90.0" drone:GimbalPitchDegree="-90.0" drone:GimbalRollDegree="0.0"/>"#,
        r#"<rdf:Description rdf:about="Autel Robotics Meta Data" Camera:Yaw="90" Camera:Pitch="0" Camera:Roll="0"/>"#,
        // Two conventions in one file, which agree.
        "<rdf:Description><Camera:Yaw>90</Camera:Yaw><Camera:Pitch>0.0</Camera:Pitch><Camera:Roll>0</Camera:Roll>\
         <drone-parrot:CameraYawDegree>90</drone-parrot:CameraYawDegree>\
         <drone-parrot:CameraPitchDegree>-90</drone-parrot:CameraPitchDegree>\
         <drone-parrot:CameraRollDegree>0</drone-parrot:CameraRollDegree></rdf:Description>",
        // FLIR's fractions.
        "<rdf:Description><Camera:Yaw>9000/100</Camera:Yaw><Camera:Pitch>0/100</Camera:Pitch></rdf:Description>",
        r#"<rdf:Description sense:Yaw="90" sense:Pitch="0" sense:Roll="0"/>"#,
        r#"<rdf:Description><drone-skydio:CameraOrientationNED drone-skydio:Roll="0" drone-skydio:Pitch="-90" drone-skydio:Yaw="90"/></rdf:Description>"#,
        r#"<rdf:Description><drone-skydio:CameraOrientationNED rdf:parseType="Resource"><drone-skydio:Roll>0</drone-skydio:Roll><drone-skydio:Pitch>-90</drone-skydio:Pitch><drone-skydio:Yaw>90</drone-skydio:Yaw></drone-skydio:CameraOrientationNED></rdf:Description>"#,
        r#"<rdf:Description><drone-skydio:CameraOrientationNED><rdf:Description drone-skydio:Roll="0" drone-skydio:Pitch="-90"><drone-skydio:Yaw>90</drone-skydio:Yaw></rdf:Description></drone-skydio:CameraOrientationNED></rdf:Description>"#,
    ] {
        let photo = with_xmp(descriptions);
        assert!(
            photo.orientation.is_some(),
            "{descriptions} {:?}",
            photo.warnings
        );
        assert_looks(&photo, DOWN, EAST);
    }
}

#[test]
fn pitch_and_roll_of_a_body_that_looks_down() {
    // Pix4D: pitch 90 looks forward, here to the north, and the top is up.
    let forward =
        with_xmp(r#"<rdf:Description Camera:Yaw="0" Camera:Pitch="90" Camera:Roll="0"/>"#);
    assert_looks(&forward, NORTH, -DOWN);
    // A right wing that hangs down (roll > 0) points the belly's camera to the left, here the west.
    let banked = with_xmp(r#"<rdf:Description Camera:Yaw="0" Camera:Pitch="0" Camera:Roll="90"/>"#);
    assert_looks(&banked, -EAST, NORTH);
    // senseFly's roll has the other sign.
    let sensefly = with_xmp(r#"<rdf:Description sense:Yaw="0" sense:Pitch="0" sense:Roll="90"/>"#);
    assert_looks(&sensefly, EAST, NORTH);
}

/// North, east, down of the axes of a body that was turned by yaw, pitch and roll: forward and down,
/// multiplied out by hand from Rz(yaw) Ry(pitch) Rx(roll).
fn axes([yaw, pitch, roll]: [f64; 3]) -> (DVec3, DVec3) {
    let ((sy, cy), (sp, cp), (sr, cr)) = (
        yaw.to_radians().sin_cos(),
        pitch.to_radians().sin_cos(),
        roll.to_radians().sin_cos(),
    );
    let forward = DVec3::new(cp * cy, cp * sy, -sp);
    let down = DVec3::new(cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr);
    let world = |ned: DVec3| DVec3::new(ned.y, ned.x, -ned.z);
    (world(forward), world(down))
}

#[test]
fn every_namespace_in_closed_form() {
    for degrees in [
        [0.0, 0.0, 0.0],
        [18.5, 2.5, -2.5],
        [-112.25, -30.0, 10.0],
        [200.0, 55.5, 0.0],
        [75.0, -89.0, 170.0],
    ] {
        let [yaw, pitch, roll] = degrees;
        let three = |prefix: &str, end: &str| {
            format!(
                r#"{prefix}Yaw{end}="{yaw}" {prefix}Pitch{end}="{pitch}" {prefix}Roll{end}="{roll}""#
            )
        };
        // A camera looks along its body's forward axis, and its image's top is the body's top.
        let (forward, down) = axes(degrees);
        let of_camera = [
            ("http://www.dji.com/drone-dji/1.0/", "p:Gimbal"),
            ("http://www.dji.com/drone-dji/1.0", "p:Gimbal"),
            ("https://www.dji.com/drone-dji/1.0/", "p:Gimbal"),
            ("http://www.dji.com/drone-dji/", "p:Gimbal"),
            ("http://www.parrot.com/drone-parrot/1.0/", "p:Camera"),
            ("http://www.parrot.com/drone-parrot/1.0", "p:Camera"),
        ];
        for (uri, prefix) in of_camera {
            let packet = in_namespace("p", uri, &three(prefix, "Degree"));
            let found = of_make("Any", &[&packet]);
            assert_eq!(found.orientation.unwrap().angles, Angles::Camera, "{uri}");
            assert_looks(&found, forward, -down);
        }
        for uri in [
            "https://www.skydio.com/drone-skydio/1.0/",
            "http://www.skydio.com/drone-skydio/1.0/",
        ] {
            let packet = in_namespace("p", uri, "").replace(
                "/></rdf:RDF>",
                &format!(
                    "><p:CameraOrientationNED {}/></rdf:Description></rdf:RDF>",
                    three("p:", "")
                ),
            );
            assert_looks(&of_make("Any", &[&packet]), forward, -down);
        }
        // Pix4D's looks along the body's down axis, and its image's top is the body's front.
        for uri in [
            "http://pix4d.com/camera/1.0/",
            "http://pix4d.com/camera/1.0",
            "https://pix4d.com/camera/1.0/",
            "https://pix4d.com/camera/1.0",
        ] {
            // Under whatever prefix.
            for prefix in ["Camera", "camera", "ns1", "drone-dji"] {
                let packet = in_namespace(prefix, uri, &three(&format!("{prefix}:"), ""));
                assert_looks(&of_make("Any", &[&packet]), down, forward);
            }
        }
        // senseFly's roll has the other sign, in its own namespace, in Pix4D's and in no one's.
        let (forward, down) = axes([yaw, pitch, -roll]);
        for uri in [
            "http://ns.sensefly.com/Camera/1.0/",
            "http://ns.sensefly.com/Camera/1.0",
            "http://pix4d.com/camera/1.0/",
            "Camera/",
        ] {
            let packet = in_namespace("Camera", uri, &three("Camera:", ""));
            assert_looks(&of_make("senseFly", &[&packet]), down, forward);
        }
    }
}

#[test]
fn angles_in_another_namespace_give_no_orientation() {
    let angles = r#"Camera:Yaw="18.5" Camera:Pitch="2.25" Camera:Roll="-2.5""#;
    for uri in [
        // Parrot's Disco and Bebop 2.
        "Camera/",
        "http://www.parrot.com/camera/1.0/",
        "http://example.org/pix4d.com/camera/1.0/",
        "http://pix4d.com/camera/2.0/",
        "http://PIX4D.com/camera/1.0/",
    ] {
        let found = of_make("PARROT", &[&in_namespace("Camera", uri, angles)]);
        assert_eq!(found.orientation, None, "{uri}");
        assert_eq!(found.unknown_angles, [uri]);
        // Where it was is known all the same.
        assert_eq!(found.place.unwrap().place.height, 200.5);
    }
    let gimbal = r#"drone-dji:GimbalYawDegree="1" drone-dji:GimbalPitchDegree="-90""#;
    let foreign = in_namespace("drone-dji", "http://example.org/drone/", gimbal);
    assert_eq!(
        of_make("DJI", &[&foreign]).unknown_angles,
        ["http://example.org/drone/"]
    );
    // One that is known stands for the camera; the sun sensor's angles are no matter then.
    let sun = in_namespace(
        "DLS",
        "http://micasense.com/DLS/1.0/",
        r#"DLS:Yaw="1" DLS:Pitch="2" DLS:Roll="3""#,
    );
    let known = packet(r#"<rdf:Description Camera:Yaw="90" Camera:Pitch="0" Camera:Roll="0"/>"#);
    let both = of_make("MicaSense", &[&sun, &known]);
    assert_looks(&both, DOWN, EAST);
    assert_eq!(both.unknown_angles, [""; 0]);
    assert_eq!(of_make("MicaSense", &[&sun]).unknown_angles.len(), 1);
    // A roll of film, and a word for an angle.
    let film = in_namespace(
        "f",
        "http://example.org/film/",
        r#"f:Roll="7" f:Pitch="none""#,
    );
    assert_eq!(of_make("Any", &[&film]).unknown_angles, [""; 0]);
}

#[test]
fn the_fields_of_somebody_elses_structure_are_not_read() {
    let found = with_xmp(
        r#"<rdf:Description xmlns:o="http://example.org/"><o:CameraOrientationNED drone-skydio:Yaw="1" drone-skydio:Pitch="2" drone-skydio:Roll="3"/></rdf:Description>"#,
    );
    assert_eq!(found.orientation, None);
    // The aircraft's own angles are not the camera's.
    let aircraft = with_xmp(
        r#"<rdf:Description drone-dji:FlightYawDegree="1" drone-dji:FlightPitchDegree="2" drone-parrot:DroneYawDegree="1" drone-parrot:DronePitchDegree="2"><drone-skydio:VehicleOrientationNED drone-skydio:Yaw="1" drone-skydio:Pitch="2" drone-skydio:Roll="3"/></rdf:Description>"#,
    );
    assert_eq!(
        (aircraft.orientation, aircraft.unknown_angles),
        (None, vec![])
    );
    // In a list of structures, and in a Description inside one.
    for list in [
        r#"<rdf:Seq><rdf:li drone-skydio:Yaw="90" drone-skydio:Pitch="-90"/></rdf:Seq>"#,
        r#"<rdf:Seq><rdf:li rdf:parseType="Resource"><drone-skydio:Yaw>90</drone-skydio:Yaw><drone-skydio:Pitch>-90</drone-skydio:Pitch></rdf:li></rdf:Seq>"#,
        r#"<rdf:Bag><rdf:li><rdf:Description drone-skydio:Yaw="90"><drone-skydio:Pitch>-90</drone-skydio:Pitch></rdf:Description></rdf:li></rdf:Bag>"#,
    ] {
        let packet = format!(
            "<rdf:Description><drone-skydio:CameraOrientationNED>{list}</drone-skydio:CameraOrientationNED></rdf:Description>"
        );
        assert_looks(&with_xmp(&packet), DOWN, EAST);
    }
}

#[test]
fn contradicting_namespaces_are_told() {
    let both = |pitch: &str| {
        with_xmp(&format!(
            r#"<rdf:Description Camera:Yaw="146.8" Camera:Pitch="{pitch}" Camera:Roll="0" drone-parrot:CameraYawDegree="146.8" drone-parrot:CameraPitchDegree="-52" drone-parrot:CameraRollDegree="0"/>"#
        ))
    };
    // Parrot's own example: -52 from the horizon is 38 from straight down.
    assert_eq!(both("38").warnings, [""; 0]);
    let apart = both("-52");
    assert_eq!(apart.orientation.unwrap().degrees, [146.8, -52.0, 0.0]);
    assert_eq!(
        apart.warnings,
        [
            "its camera's angles in http://www.parrot.com/drone-parrot/1.0/ and in http://pix4d.com/camera/1.0/ contradict each other by 90 degrees; the first are taken"
        ]
    );
}

//! What Metashape states of its errors, with answers by hand and from the shared data. Those of the real
//! projects were computed from the files' numbers by another program, from Agisoft's formula.

use glam::DVec3;

use super::*;
use crate::geodesy::enu_axes;
use crate::jobs::Progress;
use crate::read_project as read_any;
use fragscale_test_data::shared_data;

/// A chunk with two sensors and three cameras whose last is fixed.
fn document(covariances: [&str; 2]) -> String {
    let sensor = |id: u32, coeffs: &str| {
        format!(
            "<sensor id=\"{id}\" label=\"s{id}\" type=\"frame\"><resolution width=\"400\" height=\"300\"/>\
             <calibration type=\"frame\" class=\"adjusted\"><resolution width=\"400\" height=\"300\"/>\
             <f>500</f></calibration><covariance><params>cx f</params><coeffs>{coeffs}</coeffs>\
             </covariance></sensor>"
        )
    };
    let [first, second] = covariances;
    format!(
        "<document version=\"1.5.0\"><chunk><sensors>{}{}</sensors><cameras>\
         <camera id=\"0\" sensor_id=\"0\" label=\"a\"><transform>1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1</transform>\
         <rotation_covariance>{first}</rotation_covariance>\
         <location_covariance>{second}</location_covariance></camera>\
         <camera id=\"1\" sensor_id=\"1\" label=\"b\">\
         <transform>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</transform></camera></cameras>\
         <transform><rotation>0 -1 0 1 0 0 0 0 1</rotation><translation>0 0 0</translation>\
         <scale>2</scale></transform></chunk></document>",
        sensor(0, "9 0 0 1"),
        sensor(1, "9 0 0 4")
    )
}

/// The chunk is turned by a quarter about z and twice as long in the world. Of two lenses the one that
/// is less sure counts: 2 px of 500.
#[test]
fn covariances_are_brought_to_the_world() {
    let rotation = "1e-6 0 0 0 4e-6 0 0 0 9e-6";
    let found = read_xml(&document([rotation, "1 0 0 0 4 0 0 0 9"])).unwrap();
    let errors = found.pose_errors[0].errors();
    assert_eq!(errors.position, Some(DVec3::new(4.0, 2.0, 6.0)));
    let angle = DVec3::new(1e-3, 2e-3, 3e-3).map(f64::to_degrees);
    assert!((errors.angle.unwrap() - angle).length() < 1e-15);
    assert_eq!(found.pose_errors[1], Default::default());
    assert!((found.errors.focal.unwrap() - 0.4).abs() < 1e-15);
    assert_eq!(found.warnings, [""; 0]);
}

#[test]
fn what_is_no_covariance_is_said_and_left_out() {
    let good = "1 0 0 0 4 0 0 0 9";
    for wrong in ["1 0 0 0 -4 0 0 0 9", "1 0 0 0 4 0 0 0 nan", "1 2", "x", ""] {
        let found = read_xml(&document([good, wrong])).unwrap();
        let errors = found.pose_errors[0];
        assert!(
            errors.position.is_none() && errors.angle.is_some(),
            "{wrong}"
        );
        let [warning] = &found.warnings[..] else {
            panic!("{:?}", found.warnings)
        };
        assert!(warning.starts_with("1 stated covariances"), "{warning}");
    }
    for wrong in ["9 0 0 -1", "9 0 0 inf", "9 0 1"] {
        let text = document([good, good]).replace("9 0 0 4", wrong);
        let found = read_xml(&text).unwrap();
        // What is known of the other lens stands.
        assert!((found.errors.focal.unwrap() - 0.2).abs() < 1e-15);
        assert_eq!(found.warnings.len(), 1, "{wrong}");
    }
}

#[test]
fn the_wheat_field_states_its_errors() {
    let Some(psx) = shared_data("metashape-wheat-gcp/wheat_tanashi.psx") else {
        return;
    };
    let found = read_any(&psx, &Progress::default()).unwrap().reconstruction;
    assert_eq!(found.pose_errors.len(), 138);
    let focal = found.errors.focal.unwrap();
    assert!((focal - 0.196_289_319_143_100_5).abs() < 1e-9, "{focal}");
    let first = found.pose_errors[0];
    let axes = enu_axes(found.measured_positions[0].position).transpose();
    let here = first.moved(&axes).errors();
    let expected = DVec3::new(0.019_112, 0.015_527, 0.067_108);
    assert!(
        (here.position.unwrap() - expected).length() < 1e-5,
        "{here:?}"
    );
    let expected = DVec3::new(0.032_724_72, 0.023_177_75, 0.006_121_48);
    assert!((here.angle.unwrap() - expected).length() < 1e-7, "{here:?}");
}

/// The first camera was held fixed and states nothing; three lenses.
#[test]
fn cameras_of_a_local_chunk_state_their_errors() {
    let Some(xml) = shared_data("metashape-xml-potree/cameras.xml") else {
        return;
    };
    let found = read_any(&xml, &Progress::default()).unwrap().reconstruction;
    assert_eq!(found.pose_errors[0], Default::default());
    let second = found.pose_errors[1].errors();
    let expected = DVec3::new(1.925_867e-4, 3.087_094e-4, 1.313_873e-4);
    assert!((second.position.unwrap() - expected).length() < 1e-9);
    let expected = DVec3::new(1.822_037e-3, 1.585_587e-3, 6.410_867e-4);
    assert!((second.angle.unwrap() - expected).length() < 1e-8);
    let stated = found.pose_errors.iter().filter(|e| e.position.is_some());
    assert_eq!(stated.count(), 24);
    let focal = found.errors.focal.unwrap();
    assert!((focal - 0.070_717_765_456).abs() < 1e-9, "{focal}");
}

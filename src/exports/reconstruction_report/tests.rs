use super::*;
use crate::camera::{Brown, Distortion};

fn camera() -> Camera {
    let lens = Brown::new([-0.061, 0.0266, 0.0004, 0.0, 0.0, 0.0, 0.0, 0.0]);
    Camera {
        name: "FC <1>".to_owned(),
        width: 1280,
        height: 720,
        fx: 1014.687,
        fy: 1012.669,
        cx: 638.058,
        cy: 361.463,
        skew: 0.0,
        distortion: Distortion::Brown(lens),
    }
}

/// Two photos, and four points of which three lie in one cell: by hand.
#[test]
fn numbers_stand_where_they_belong() {
    let camera = camera();
    let photo = |name, off: Option<(DVec3, bool)>| SolvedPhoto {
        name,
        camera: 0,
        center: DVec2::new(500_010.0, 5_400_010.0),
        points: 1234,
        reprojection_px: Some(0.3456),
        off_receiver: off.map(|(off, used)| OffReceiver { off, used }),
        deviation: Some((DVec3::new(0.006, 0.0092, 0.013), 0.0179)),
    };
    let points = [(0.0, 2), (0.01, 4), (0.02, 6), (20.0, 2)];
    let report = ReconstructionReport {
        name: "blast 7",
        engine: "COLMAP 3.8",
        facts: vec!["2 of 3 photos, 4 points".to_owned()],
        warnings: vec!["heights are above the ellipsoid".to_owned()],
        unit: Some(LengthUnit::Metre),
        cameras: vec![SolvedCamera {
            camera: &camera,
            focal_percent: Some(0.091),
            stated_focal: Some(1000.0),
        }],
        photos: vec![
            photo("a.jpg", Some((DVec3::new(0.03, -0.04, 0.0001), true))),
            photo("b.jpg", Some((DVec3::new(5.0, 0.0, 0.0), false))),
        ],
        left_out: vec![["c & d.jpg", "it is blurred"]],
        points: points
            .map(|(x, photos)| SeenPoint {
                point: DVec3::new(500_000.0 + x, 5_400_000.0 + x, 300.0),
                photos,
            })
            .to_vec(),
    };
    let html = reconstruction_report(&report);
    for part in [
        "<h1>Reconstruction of blast 7</h1>",
        "Found by COLMAP 3.8. Lengths are in m.",
        "FC &lt;1&gt;</td><td>2</td><td>1280 \u{d7} 720</td><td>1014.69</td>",
        "<td>0.091</td><td>1000.00</td>",
        "k1 \u{2212}0.06100, k2 0.02660, p1 0.00040</td>",
        "<td>a.jpg</td><td>1234</td><td>0.35</td><td>+0.030</td><td>\u{2212}0.040</td><td>0.000</td>\
         <td>0.0092</td><td>0.013</td><td>0.018</td>",
        "+5.000 (not used)",
        "off the 1 positions that were used by 0.030 to the east, 0.040 to the north",
        "<td>c &amp; d.jpg</td><td>it is blurred</td>",
        // The mean of 2, 4 and 6, and 2 alone.
        "fill=\"#A1DAB4\"",
        "fill=\"#FDD078\"",
        "5400000",
    ] {
        assert!(html.contains(part), "{part}: {html}");
    }
    // One cell each, and the legend's.
    assert_eq!(html.matches("fill=\"#A1DAB4\"").count(), 2);
    assert_eq!(html.matches("fill=\"#FDD078\"").count(), 2);
}

#[test]
fn without_a_world_lengths_are_the_models() {
    let report = ReconstructionReport {
        name: "a",
        engine: "b",
        facts: Vec::new(),
        warnings: Vec::new(),
        unit: None,
        cameras: Vec::new(),
        photos: Vec::new(),
        left_out: Vec::new(),
        points: Vec::new(),
    };
    let html = reconstruction_report(&report);
    assert!(html.contains("Lengths are in units of the model"));
    assert!(html.contains("No photo&#39;s own position was used"));
    assert!(!html.contains("<figure>"));
}

//! Calibrations of a whole sensor in photos that are a part of it.

use exif::{Field, Tag};

use super::tests::photo;
use super::{FocalSource, PhotoMetadata};
use fragscale_test_data::jpeg::{jpeg, packet, rationals, short};

/// A photo of the size with DJI's designed lens for 5472 x 3648 and its calibrated one.
fn of_a_phantom(size: (u16, u16), exif: &[Field]) -> PhotoMetadata {
    let packet = packet(
        r#"<rdf:Description drone-dji:CalibratedFocalLength="3666.5" drone-dji:CalibratedOpticalCenterX="2736" drone-dji:CalibratedOpticalCenterY="1824" drone-dji:DewarpData="2018-03-13;3659.5,3653.5,-8,46,-0.25,0.125,0,0,0" drone-dji:DewarpFlag="0"/>"#,
    );
    photo(jpeg(size, exif, &[&packet]))
}

#[test]
fn a_calibration_of_the_whole_sensor_serves_a_photo_cut_from_it() {
    let cut = of_a_phantom((5472, 3078), &[]);
    let [dewarp, design] = cut.focal.as_slice() else {
        panic!("{:?}", cut.warnings);
    };
    // The focal lengths stay; the design's centre is 1824 - (3648 - 3078) / 2, DJI's calibrated one
    // counts from the photo's middle.
    assert_eq!((dewarp.fx, dewarp.fy), (3659.5, 3653.5));
    assert_eq!((dewarp.cx, dewarp.cy), (2736.0 - 8.0, 1539.0 + 46.0));
    assert_eq!((design.fx, design.cx, design.cy), (3666.5, 2736.0, 1539.0));
    let expected = "the calibration in its XMP is for 5472 x 3648; the photo, 5472 x 3078, is taken for the middle of that: focal lengths in pixels stay, and the optical centre moves by 285 px";
    assert_eq!(cut.warnings, [expected]);
    // Reduced afterwards, which EXIF's size says: everything by the same factor.
    let size = [
        short(Tag::PixelXDimension, 5472),
        short(Tag::PixelYDimension, 3078),
    ];
    let reduced = of_a_phantom((2736, 1539), &size);
    let design = reduced.focal[1];
    assert_eq!((design.fx, design.cx, design.cy), (1833.25, 1368.0, 769.5));
    // No size in EXIF: the shape says that it is reduced, and DJI's calibration with it.
    let half = of_a_phantom((2736, 1824), &[]);
    let [dewarp, design] = half.focal.as_slice() else {
        panic!("{:?}", half.warnings);
    };
    assert_eq!((dewarp.fx, dewarp.cx, dewarp.cy), (1829.75, 1364.0, 935.0));
    assert_eq!((design.fx, design.cy), (1833.25, 912.0));
    assert!(
        half.warnings[0].contains("has the same shape, so it is scaled"),
        "{:?}",
        half.warnings
    );
    // Another width and another shape: nothing is used, and both are named.
    let other = of_a_phantom((4000, 2250), &[]);
    assert_eq!(other.focal, []);
    assert_eq!(other.warnings.len(), 2, "{:?}", other.warnings);
    for warning in &other.warnings {
        assert!(
            warning.contains("another image size; it is not used"),
            "{warning}"
        );
    }
    // A scaled calibration against the 35 mm equivalent: 10 mm of 43.27 at 3288 px are 760 px.
    let zoomed = of_a_phantom((2736, 1824), &[short(Tag::FocalLengthIn35mmFilm, 10)]);
    assert_eq!(zoomed.focal.len(), 1);
    assert_eq!(zoomed.focal[0].source, FocalSource::FilmEquivalent);
    let said = zoomed
        .warnings
        .iter()
        .any(|w| w.contains("of another camera"));
    assert!(said, "{:?}", zoomed.warnings);
}

#[test]
fn measured_centres_serve_a_photo_cut_from_the_sensor() {
    // As in a photo of a Skydio 2 with 4056 x 2282 pixels.
    let skydio = photo(jpeg(
        (4056, 2282),
        &[],
        &[&packet(
            r#"<rdf:Description><drone-skydio:CalibratedFocalLength drone-skydio:X="2378.5" drone-skydio:Y="2376.5"/><drone-skydio:CalibratedOpticalCenter drone-skydio:X="2029.5" drone-skydio:Y="1520.5"/></rdf:Description>"#,
        )],
    ));
    // 4:3 of 4056 is 3042: 380 rows are cut.
    let focal = skydio.focal[0];
    assert_eq!((focal.fx, focal.fy), (2378.5, 2376.5));
    assert_eq!((focal.cx, focal.cy), (2030.0, 1521.0 - 380.0));
    // Pix4D's tags in mm, 100 pixels a mm: the centre at 1996, 1504 of 4000 x 3000.
    let plane = [
        rationals(Tag::FocalPlaneXResolution, &[(100, 1)]),
        rationals(Tag::FocalPlaneYResolution, &[(100, 1)]),
        short(Tag::FocalPlaneResolutionUnit, 4),
    ];
    let tags = packet(
        r#"<rdf:Description Camera:ModelType="perspective" Camera:PerspectiveFocalLength="29.5" Camera:PrincipalPoint="19.96,15.04"/>"#,
    );
    let pix4d = photo(jpeg((4000, 2250), &plane, &[&tags])).focal[0];
    assert_eq!(pix4d.source, FocalSource::Pix4dTags);
    assert!((pix4d.fx - 2950.0).abs() < 1e-9);
    assert!((pix4d.cx - 1996.0).abs() < 1e-9 && (pix4d.cy - (1504.0 - 375.0)).abs() < 1e-9);
}

//! Rotations against the matrix of an independent importer, intrinsics by hand, malformed files.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::files::FileError;

/// A row that RealityCapture wrote, quoted by two importers.
const CSV: &str = "#cameras 1\n#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\n\
    frame_00001.jpeg,44.5876747664166,138.823621534044,6.821916401534405,170.3483067926429,\
    85.18637269312288,-22.74995074830745,14.2390682243052,-9.482184385774318e-004,\
    -2.446553068050568e-004,3.114799768048152e-003,4.026391718074555e-003,\
    -1.795976992379612e-003,0,0,0\n";

/// A sidecar that RealityCapture wrote, quoted in a public repository, in elements and attributes.
const XMP: &str = "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n\
    <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n\
    <rdf:Description xcr:Version=\"3\" xcr:PosePrior=\"locked\" xcr:Coordinates=\"absolute\"\n\
    xcr:DistortionModel=\"brown3\" xcr:FocalLength35mm=\"24.3765359225552\"\n\
    xcr:Skew=\"0\" xcr:AspectRatio=\"1\" xcr:PrincipalPointU=\"-0.000464752782510192\"\n\
    xcr:PrincipalPointV=\"-0.000823593392050301\" xcr:CalibrationPrior=\"exact\"\n\
    xmlns:xcr=\"http://www.capturingreality.com/ns/xcr/1.1#\">\n\
    <xcr:Rotation>0.412555151152903 0.910841439690343 0.0128887159933671 0.0412058430083455 \
    -0.00452553581407911 -0.999140429583083 -0.910000178988533 0.412731621357468 \
    -0.0393990224812024</xcr:Rotation>\n\
    <xcr:Position>66.8850552499877 45.2551194778559 5.45377092514118</xcr:Position>\n\
    <xcr:DistortionCoeficients>-0.124217384759894 0.107339706650415 -0.0104748224573926 0 0 0\
    </xcr:DistortionCoeficients>\n</rdf:Description>\n</rdf:RDF>\n</x:xmpmeta>\n";

#[test]
fn a_row_becomes_a_photo() {
    let mut found = read_csv(CSV).unwrap();
    assert_eq!(found.photos[0].name, "frame_00001.jpeg");
    assert_eq!(found.photos[0].pose.center.y, 138.823_621_534_044);
    // Pitch 85: nearly to the horizon.
    assert!((found.photos[0].pose.rotation.z_axis.z + 0.077).abs() < 0.01);
    found.set_sizes(|_| Some((3840, 2880)));
    let camera = &found.cameras[0];
    // 14.239 mm on 36 mm of 3840 px.
    assert!((camera.fx - 1_518.833_943_925_888).abs() < 1e-9);
    assert!((camera.cx - (1920.0 - 3.641_158_804_137_338)).abs() < 1e-9);
    assert!((camera.cy - (1440.0 - 0.939_476_378_131_418)).abs() < 1e-9);
    // The same by the newer names, other separators and without what a template may leave out.
    let newer = CSV
        .replace("heading", "yaw")
        .replace(",f,px,py,", ",f_35mm,px_norm,py_norm,");
    assert_eq!(read_csv(&newer).unwrap().photos, found.photos);
    assert_eq!(
        read_csv(&CSV.replace(',', ";")).unwrap().photos,
        found.photos
    );
    let short = "#name,x,y,alt,heading,pitch,roll,f\na.jpg,1,2,3,0,0,0,18\r\n";
    let short = read_csv(short).unwrap();
    assert_eq!((short.cameras[0].fx, short.cameras[0].cx), (0.5, 0.0));
    assert_eq!(short.cameras[0].distortion, Distortion::None);
}

/// The matrix of world to camera that another importer states for these angles.
fn stated(yaw: f64, pitch: f64, roll: f64) -> [[f64; 3]; 3] {
    let (sx, cx) = roll.to_radians().sin_cos();
    let (sy, cy) = pitch.to_radians().sin_cos();
    let (sz, cz) = yaw.to_radians().sin_cos();
    [
        [cx * cz + sx * sy * sz, -cx * sz + cz * sx * sy, -cy * sx],
        [-cy * sz, -cy * cz, -sy],
        [cx * sy * sz - cz * sx, cx * cz * sy + sx * sz, -cx * cy],
    ]
}

#[test]
fn more_values_than_names_are_refused() {
    let wider = format!("{},7\n", CSV.trim_end());
    let fault = read_csv(&wider).unwrap_err();
    assert!(fault.what.contains("decimal commas"), "{fault}");
    // A comma at the end is no value.
    assert!(read_csv(&format!("{},\n", CSV.trim_end())).is_ok());
}

#[test]
fn angles_turn_as_another_importer_states() {
    for [heading, pitch, roll] in [
        [0.0, 0.0, 0.0],
        [90.0, 0.0, 0.0],
        [170.3, 85.2, -22.7],
        [-40.0, -30.0, 120.0],
    ] {
        let pose = csv_file::pose(DVec3::ZERO, [heading, pitch, roll]);
        let stated = stated(heading, pitch, roll);
        for (axis, row) in [
            pose.rotation.x_axis,
            pose.rotation.y_axis,
            pose.rotation.z_axis,
        ]
        .into_iter()
        .zip(stated)
        {
            assert!(
                (axis - DVec3::from_array(row)).length() < 1e-12,
                "{axis} {row:?}"
            );
        }
    }
}

fn folder(files: &[(&str, &str)]) -> Result<Reconstruction, FileError> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    assert!(has_sidecars(folder.path()));
    let project = read_folder(folder.path())?;
    assert_eq!(project.photos.as_deref(), Some(folder.path()));
    Ok(project.reconstruction)
}

#[test]
fn sidecars_name_their_photos() {
    let attributes = XMP
        .replace("<xcr:Position>", "<!-- ")
        .replace("</xcr:Position>", " -->")
        .replace(
            "xcr:Version=\"3\"",
            "xcr:Version=\"4\" xcr:Position=\"1 2 3\"",
        );
    let files = [
        ("a-b.JPG", ""),
        ("a.JPG", ""),
        ("a.xmp", XMP),
        ("b.XMP", &attributes),
        ("c.xmp", "<dji/>"),
    ];
    let mut found = folder(&files).unwrap();
    let names: Vec<_> = found
        .photos
        .iter()
        .map(|photo| photo.name.as_str())
        .collect();
    assert_eq!(names, ["a.JPG", "b"]);
    let pose = found.photos[0].pose;
    // Down in the image is down in the world.
    assert!(pose.rotation.y_axis.z < -0.999);
    assert_eq!(pose.center.x, 66.885_055_249_987_7);
    assert_eq!(found.photos[1].pose.center, DVec3::new(1.0, 2.0, 3.0));
    found.set_sizes(|_| Some((3000, 4000)));
    let camera = &found.cameras[0];
    // The longer side counts, also upright.
    assert!((camera.fx - 24.376_535_922_555_2 / 36.0 * 4000.0).abs() < 1e-9);
    assert!((camera.cx - (1500.0 - 1.859_011_130_040_768)).abs() < 1e-9);
    // x 0.1, y 0.2 in front of the camera, by the polynomial: r2 = 0.05.
    let stretched = 1.0 - 0.124_217_384_759_894 * 0.05 + 0.107_339_706_650_415 * 0.0025
        - 0.010_474_822_457_392_6 * 0.000_125;
    let expected = DVec2::new(0.1, 0.2) * stretched * camera.fx + DVec2::new(camera.cx, camera.cy);
    let pixel = camera.pixel_as_shot(DVec3::new(0.1, 0.2, 1.0)).unwrap();
    assert!((pixel - expected).length() < 1e-9);
}

#[test]
fn tangential_coefficients_change_places() {
    // The program's own OpenCV template writes k1,k2,t2,t1.
    let row = "#name,x,y,alt,heading,pitch,roll,f,k1,t1,t2\na.jpg,0,0,0,0,0,0,36,0.1,0.01,0.02\n";
    let Distortion::Brown(brown) = read_csv(row).unwrap().cameras[0].distortion else {
        panic!("no distortion");
    };
    assert_eq!(
        brown.coefficients(),
        [0.1, 0.0, 0.02, 0.01, 0.0, 0.0, 0.0, 0.0]
    );
}

/// Where a sidecar's lens takes (x, y) on the plane one focal length in front of the camera.
fn distorted(model: &str, coefficients: &str, point: DVec2) -> DVec2 {
    let start = XMP.find("<xcr:Dist").unwrap();
    let end = XMP.find("</rdf:Description>").unwrap();
    let text = format!(
        "{}<xcr:DistortionCoeficients>{coefficients}</xcr:DistortionCoeficients>{}",
        &XMP[..start],
        &XMP[end..]
    );
    let text = text.replace("\"brown3\"", &format!("\"{model}\""));
    let mut found = folder(&[("a.xmp", &text)]).unwrap();
    found.set_sizes(|_| Some((4000, 3000)));
    let camera = &found.cameras[0];
    let pixel = camera.pixel_as_shot(point.extend(1.0)).unwrap();
    (pixel - DVec2::new(camera.cx, camera.cy)) / camera.fx
}

/// Equations 47, 49 and 50 of RealityScan's paper, by hand at (0.3, 0.4): r2 = 0.25.
#[test]
fn every_documented_model_distorts_as_it_is_documented() {
    let point = DVec2::new(0.3, 0.4);
    for (model, coefficients, stretched) in [
        ("none", "0.1 0.2 0.3 0.4 0 0", 1.0),
        ("perspective", "0.1 0.2 0.3 0.4 0 0", 1.0),
        ("division", "0.4 0 0 0 0 0", 1.0 / 1.1),
        // 0.1 * 0.25 + 0.2 * 0.0625 + 0.32 * 0.015625 + 0.64 * 0.00390625
        ("brown4", "0.1 0.2 0.32 0.64 0 0", 1.045),
        ("brown4t2", "0.1 0.2 0.32 0.64 0 0", 1.045),
    ] {
        let found = distorted(model, coefficients, point);
        assert!(
            (found - point * stretched).length() < 1e-12,
            "{model} {found}"
        );
    }
    // x: t1 (r2 + 2 x2) + 2 t2 x y = 0.01 * 0.43 + 0.02 * 0.24;
    // y: t2 (r2 + 2 y2) + 2 t1 x y = 0.02 * 0.57 + 0.01 * 0.24.
    let tangential = DVec2::new(0.0091, 0.0138);
    for (model, coefficients, stretched) in [
        ("brown3t2", "0.1 0.2 0.32 0 0.01 0.02", 1.0425),
        ("brown4t2", "0.1 0.2 0.32 0.64 0.01 0.02", 1.045),
    ] {
        let found = distorted(model, coefficients, point);
        let expected = point * stretched + tangential;
        assert!((found - expected).length() < 1e-12, "{model} {found}");
    }
}

#[test]
fn coordinates_are_absolute_unless_it_is_said_otherwise() {
    let silent = XMP.replace(" xcr:Coordinates=\"absolute\"", "");
    assert_ne!(silent, XMP);
    assert_eq!(folder(&[("a.xmp", &silent)]).unwrap().warnings, [""; 0]);
}

/// The program's template, with its words in brackets. The camera stands at (1, 2, 10) and looks
/// down, its right to the east: R = diag(1, -1, -1), t = -R C = (-1, 2, 10).
#[test]
fn the_opencv_template() {
    let text = "#name,tx,ty,tz,R00,R01,R02,R10,R11,R12,R20,R21,R22,f_pix,px_pix,py_pix,k1,k2,t2,t1,\
        k3,k4 (R = [Rij] provided in row major ordering and t = (tx,ty,tz) are the rotation matrix)\n\
        a.jpg,-1,2,10,1,0,0,0,-1,0,0,0,-1,3000,2010,1490,0.1,0.2,0.02,0.01,0.3,0\n";
    assert!(is_header(text.lines().next().unwrap()));
    let mut found = read_csv(text).unwrap();
    let pose = found.photos[0].pose;
    assert_eq!(pose.center, DVec3::new(1.0, 2.0, 10.0));
    assert_eq!(pose.rotation.x_axis, DVec3::X);
    assert_eq!(pose.rotation.z_axis, DVec3::NEG_Z);
    found.set_sizes(|_| Some((4000, 3000)));
    let camera = &found.cameras[0];
    assert_eq!((camera.fx, camera.cx, camera.cy), (3000.0, 2010.0, 1490.0));
    assert_eq!((camera.name.as_str(), camera.width), ("a.jpg", 4000));
    let Distortion::Brown(brown) = camera.distortion else {
        panic!("{:?}", camera.distortion);
    };
    // k1 k2 p1 p2 k3 in the template's order.
    assert_eq!(brown.coefficients()[..5], [0.1, 0.2, 0.02, 0.01, 0.3]);
    // A turn that is none.
    let error = read_csv(&text.replace(",10,1,0,0,", ",10,2,0,0,")).unwrap_err();
    assert_eq!(error.line, Some(2));
    assert!(error.what.contains("R00 to R22"), "{error}");
    for end in 0..text.len() {
        let _ = read_csv(&text[..end]);
    }
}

#[test]
fn what_cannot_be_said_is_left_out_and_counted() {
    let of = |from: &str, to: &str| {
        let changed = XMP.replace(from, to);
        assert_ne!(changed, XMP);
        folder(&[("a.xmp", XMP), ("b.xmp", &changed)])
    };
    for (from, to, said) in [
        (
            "\"brown3\"",
            "\"cubic\"",
            "1 photos are left out for their lens: 'b' has the distortion model 'cubic'",
        ),
        (
            "\"brown3\"",
            "\"division\"",
            "a division model of more than k1",
        ),
        ("xcr:Skew=\"0\"", "xcr:Skew=\"0.1\"", "a skew of 0.1"),
        (
            "\"absolute\"",
            "\"relative\"",
            "1 photos' coordinates are not said to be absolute",
        ),
        (
            "<xcr:Position>66.8850552499877 45.2551194778559 5.45377092514118</xcr:Position>",
            "",
            "1 photos have no pose",
        ),
    ] {
        let found = of(from, to).unwrap();
        assert!(
            found.warnings.join("; ").contains(said),
            "{:?}",
            found.warnings
        );
    }
    let error = folder(&[("a.xmp", &XMP.replace("\"brown3\"", "\"cubic\""))]).unwrap_err();
    assert!(error.fault.what.contains("cubic"), "{error}");
    for (from, to, what) in [
        ("24.3765", "x", "not a number"),
        ("0.412555151152903", "0.9", "Rotation"),
        (" -0.0393990224812024", "", "the line ends"),
        ("5.45377092514118", "5.4 5", "more than 3"),
        ("</x:xmpmeta>", "", "not valid XML"),
    ] {
        let error = of(from, to).unwrap_err();
        assert!(error.fault.what.contains(what), "{error}");
    }
}

#[test]
fn mistakes_of_the_table_are_placed() {
    let fault = |from: &str, to: &str| read_csv(&CSV.replace(from, to)).unwrap_err();
    assert_eq!(fault("14.2390682243052", "nan").line, Some(3));
    assert!(
        fault("14.2390682243052", "0")
            .what
            .contains("a focal length of 0")
    );
    assert!(fault(",f,", ",focus,").what.contains("no column f"));
    assert!(fault("#name", "name").what.contains("no line names"));
    assert!(fault("frame_00001.jpeg", "").what.contains("without name"));
    let row = CSV.lines().nth(2).unwrap();
    assert!(
        read_csv(&format!("{CSV}{row}"))
            .unwrap_err()
            .what
            .contains("there twice")
    );
    assert!(read_csv("").is_err());
    for end in 0..CSV.len() {
        let _ = read_csv(&CSV[..end]);
        let _ = Lens {
            focal: 1.0,
            principal: [0.0; 2],
            coefficients: [0.0; 6],
        }
        .camera("");
    }
}

proptest! {
    #[test]
    fn no_text_panics(text in "((a|b|,|[0-9.e-]{1,5}|\\PC){0,20}\n){0,5}") {
        let _ = read_csv(&text);
        let _ = read_csv(&format!("#name,x,y,alt,heading,pitch,roll,f\n{text}"));
    }
}

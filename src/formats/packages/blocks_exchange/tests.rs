//! The shared export, a block built from two cameras in numbers known beforehand, and malformed ones.

use glam::DMat3;
use proptest::prelude::*;

use super::*;
use crate::camera::{Distortion, Pose};
use fragscale_test_data::shared_data;

fn shared() -> Option<String> {
    let path = shared_data("contextcapture-snippet/goodalepark_one_photo.xml")?;
    Some(std::fs::read_to_string(path).unwrap())
}

#[test]
fn the_shared_block() {
    let Some(text) = shared() else {
        return;
    };
    let found = read(&text).unwrap();
    assert_eq!(found.package, "contextcapture");
    let origin = found.enu_origin.unwrap();
    assert_eq!((origin.latitude, origin.longitude), (39.97523, -83.00678));
    let [photo] = &found.photos[..] else {
        panic!("{:?}", found.photos);
    };
    assert_eq!(photo.name, "DJI_0001.jpg");
    let camera = &found.cameras[0];
    assert_eq!((camera.width, camera.height), (4856, 3640));
    // 9.9001356603859 mm on a sensor of 13.2 mm and 4856 px.
    assert!(
        (camera.fx - 3_642.049_906_578_33).abs() < 1e-9,
        "{}",
        camera.fx
    );
    assert_eq!(camera.cx, 2_406.862_292_709_1);
    assert_eq!(camera.cy, 1_856.921_664_639_31);
    // The README: the view goes 27.3 degrees below the horizon; x and y of the centre are where the
    // receiver was, 1.1 m and 0.1 m off.
    let forward = photo.pose.rotation.z_axis;
    assert!(
        ((-forward.z).asin().to_degrees() - 27.3).abs() < 0.05,
        "{forward}"
    );
    assert!((photo.pose.center.x - 29.935_029_684_669_4).abs() < 1e-3);
    let measured = &found.measured_positions[0];
    assert_eq!(measured.photo, photo.name);
    assert_eq!(measured.position.latitude, 39.975_270_166_666_7);
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    // East of the origin by the receiver: 111320 m cos(latitude) a degree.
    let east = (measured.position.longitude - origin.longitude)
        * 111_320.0
        * origin.latitude.to_radians().cos();
    assert!((photo.pose.center.x - east).abs() < 2.0, "{east}");
}

/// Two photos that look straight down from 100 m, 10 m apart, the first's right to the east.
fn block(orientation: &str, rotation: &str, lens: &str, extra: &str) -> String {
    let photo = |id: u32, x: u32, path: &str| {
        format!(
            "<Photo><Id>{id}</Id><ImagePath>{path}</ImagePath><Pose><Rotation>{rotation}</Rotation>\
             <Center><x>{x}</x><y>0</y><z>100</z></Center></Pose></Photo>\n"
        )
    };
    format!(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<BlocksExchange version=\"2.1\">\n\
         <SpatialReferenceSystems><SRS><Id>7</Id><Definition>EPSG:32636+5773</Definition></SRS>\
         </SpatialReferenceSystems>\n<Block><SRSId>7</SRSId><Photogroups>\n<Photogroup>\
         <ImageDimensions><Width>1000</Width><Height>500</Height></ImageDimensions>\
         <FocalLengthPixels>800</FocalLengthPixels>{orientation}{lens}\n{}{}\
         <Photo><Id>2</Id><ImagePath>c.jpg</ImagePath></Photo></Photogroup></Photogroups>{extra}\
         </Block></BlocksExchange>",
        photo(0, 0, "D:\\a\\1.jpg"),
        photo(1, 10, "D:\\b\\1.jpg"),
    )
}

const DOWN: &str = "<M_00>1</M_00><M_01>0</M_01><M_02>0</M_02><M_10>0</M_10><M_11>-1</M_11>\
    <M_12>0</M_12><M_20>0</M_20><M_21>0</M_21><M_22>-1</M_22>";

#[test]
fn tie_points_reproject() {
    // 20 m east and 10 m north of the first: 800 px * 20 / 100 right of the middle, 80 px above it;
    // less half a pixel, because Bentley counts from the first pixel's centre.
    let points = "<TiePoints><TiePoint><Position><x>20</x><y>10</y><z>0</z></Position><Color><Red>1\
        </Red><Green>0.5</Green><Blue>0</Blue></Color><Measurement><PhotoId>0</PhotoId><x>659.5</x>\
        <y>169.5</y></Measurement><Measurement><PhotoId>1</PhotoId><x>579.5</x><y>169.5</y>\
        </Measurement><Measurement><PhotoId>2</PhotoId><x>1</x><y>1</y></Measurement></TiePoint>\
        <TiePoint><Measurement><PhotoId>0</PhotoId><x>1</x><y>1</y></Measurement></TiePoint>\
        </TiePoints><ControlPoints><ControlPoint/></ControlPoints>";
    let found = read(&block("", DOWN, "", points)).unwrap();
    assert_eq!(found.crs.as_deref(), Some("EPSG:32636+5773"));
    assert_eq!(found.observations.len(), 2);
    assert!(found.median_reprojection_px().unwrap() < 1e-9);
    assert_eq!(found.cloud.colors, [[255, 128, 0]]);
    // Two photos of one file's name are called by their paths.
    assert_eq!(found.photos[1].name, "D:\\b\\1.jpg");
    let said = found.warnings.join("; ");
    for part in [
        "1 tie points have no position",
        "1 control points are not read",
        "1 photos have no whole pose",
    ] {
        assert!(said.contains(part), "{said}");
    }
}

#[test]
fn every_camera_orientation_is_the_same_photo() {
    let expected = read(&block("", DOWN, "", "")).unwrap().photos[0].pose;
    // Rows: where x, y and z of those axes point, of a photo whose right is east and whose top is
    // north; z is x cross y.
    for (name, x, y) in [
        ("XRightYDown", [1, 0], [0, -1]),
        ("XRightYUp", [1, 0], [0, 1]),
        ("XLeftYDown", [-1, 0], [0, -1]),
        ("XLeftYUp", [-1, 0], [0, 1]),
        ("XDownYRight", [0, -1], [1, 0]),
        ("XDownYLeft", [0, -1], [-1, 0]),
        ("XUpYRight", [0, 1], [1, 0]),
        ("XUpYLeft", [0, 1], [-1, 0]),
    ] {
        let z = x[0] * y[1] - x[1] * y[0];
        let rotation = format!(
            "<M_00>{}</M_00><M_01>{}</M_01><M_02>0</M_02><M_10>{}</M_10><M_11>{}</M_11><M_12>0</M_12>\
             <M_20>0</M_20><M_21>0</M_21><M_22>{z}</M_22>",
            x[0], x[1], y[0], y[1]
        );
        let tag = format!("<CameraOrientation>{name}</CameraOrientation>");
        let found = read(&block(&tag, &rotation, "", "")).unwrap();
        assert_eq!(found.photos[0].pose, expected, "{name}");
    }
}

#[test]
fn angles_are_the_matrix() {
    let pose = |orientation: &str, rotation: &str| {
        read(&block(orientation, rotation, "", "")).unwrap().photos[0].pose
    };
    let photogrammetric = "<CameraOrientation>XRightYUp</CameraOrientation>";
    let angles = "<Omega>3</Omega><Phi>-5</Phi><Kappa>40</Kappa>";
    // The poses.csv's rule, which the shared data checked.
    let expected = Pose::from_omega_phi_kappa(DVec3::new(0.0, 0.0, 100.0), [3.0, -5.0, 40.0]);
    let found = pose(photogrammetric, angles);
    let off = found.rotation.transpose() * expected.rotation - DMat3::IDENTITY;
    assert!(off.x_axis.length() + off.y_axis.length() < 1e-12, "{off}");
    let yaw = "<Yaw>0</Yaw><Pitch>-90</Pitch><Roll>0</Roll>";
    assert!((pose("", yaw).rotation.z_axis - DVec3::NEG_Z).length() < 1e-12);
    let warnings = read(&block("", yaw, "", "")).unwrap().warnings.join("; ");
    assert!(
        warnings.contains("2 photos have yaw, pitch and roll"),
        "{warnings}"
    );
}

/// The commented sample of the format's description (Paris, a camera of 9420 x 14430 pixels) tells
/// the lens and the rotation in several ways "for this dataset".
#[test]
fn the_descriptions_ways_are_the_same_photo() {
    let of = |lens: &str, rotation: &str| {
        let text = block("", rotation, lens, "")
            .replace("<FocalLengthPixels>800</FocalLengthPixels>", "")
            .replace("<Width>1000", "<Width>9420")
            .replace("<Height>500", "<Height>14430");
        let found = read(&text).unwrap();
        (found.cameras[0].clone(), found.photos[0].pose)
    };
    let film = "<FocalLength>100.735601903992</FocalLength>";
    let (sensor, pose) = of(
        &format!(
            "<SensorSize>103.896</SensorSize>{film}<PrincipalPoint><x>4683.755692</x>\
             <y>7223.0141002</y></PrincipalPoint>"
        ),
        "<M_00>-0.9999982912233401</M_00><M_01>-0.001636319085375301</M_01>\
         <M_02>-0.0008602425863163225</M_02><M_10>-0.001631068695467463</M_10>\
         <M_11>0.9999802528616577</M_11><M_12>-0.00606906089589293</M_12>\
         <M_20>0.0008701565192966738</M_20><M_21>-0.006067647409696231</M_21>\
         <M_22>-0.9999812130648239</M_22>",
    );
    let (pixel, turned) = of(
        &format!(
            "<PixelSize>0.0072</PixelSize>{film}<PrincipalPoint><xmm>-0.1853590176</xmm>\
             <ymm>0.06130152144</ymm></PrincipalPoint>"
        ),
        "<Omega>179.6523471469934</Omega><Phi>0.04985630236313049</Phi>\
         <Kappa>179.9065465708369</Kappa>",
    );
    for camera in [&sensor, &pixel] {
        assert!((camera.fx - 13_991.055_82).abs() < 1e-5, "{}", camera.fx);
        assert!((camera.cx - 4_684.255_692).abs() < 1e-6, "{}", camera.cx);
        assert!((camera.cy - 7_223.514_100_2).abs() < 1e-6, "{}", camera.cy);
    }
    let off = pose.rotation.transpose() * turned.rotation - DMat3::IDENTITY;
    assert!(off.to_cols_array().iter().all(|x| x.abs() < 1e-9), "{off}");
    // The photo of Paris looks down.
    assert!(pose.rotation.z_axis.z < -0.9999);
    // Along other axes the millimetres count the other way.
    let up = "<CameraOrientation>XRightYUp</CameraOrientation>";
    let (camera, _) = of(
        &format!(
            "{up}<PixelSize>0.0072</PixelSize>{film}<PrincipalPoint><xmm>-0.1853590176</xmm>\
             <ymm>-0.06130152144</ymm></PrincipalPoint>"
        ),
        DOWN,
    );
    assert!((camera.cy - 7_223.514_100_2).abs() < 1e-6, "{}", camera.cy);
}

#[test]
fn a_heading_is_a_yaw() {
    let yaw = "<Yaw>30</Yaw><Pitch>-80</Pitch><Roll>2</Roll>";
    let heading = yaw.replace("Yaw", "Heading");
    let of = |rotation| read(&block("", rotation, "", "")).unwrap();
    assert_eq!(of(yaw), of(&heading));
}

#[test]
fn tangential_coefficients_change_places() {
    let lens =
        "<Distortion><K1>0.1</K1><K2>0.2</K2><K3>0.3</K3><P1>0.01</P1><P2>0.02</P2></Distortion>";
    let found = read(&block("", DOWN, lens, "")).unwrap();
    let Distortion::Brown(brown) = found.cameras[0].distortion else {
        panic!("{:?}", found.cameras);
    };
    assert_eq!(
        brown.coefficients(),
        [0.1, 0.2, 0.02, 0.01, 0.3, 0.0, 0.0, 0.0]
    );
    assert_eq!((found.cameras[0].cx, found.cameras[0].cy), (500.0, 250.0));
}

#[test]
fn components_systems_and_fisheyes_are_counted() {
    let text = block("", DOWN, "", "").replace("<Id>1</Id>", "<Id>1</Id><Component>0</Component>");
    let text = text.replace("<Id>0</Id>", "<Id>0</Id><Component>1</Component>");
    let found = read(&text).unwrap();
    assert_eq!(found.photos.len(), 1);
    assert!(
        found
            .warnings
            .join("; ")
            .contains("1 photos are not of the main component")
    );
    let fisheye = "<CameraModelType>Fisheye</CameraModelType><FisheyeFocalMatrix><M_00>500</M_00>\
        <M_01>0</M_01><M_10>0</M_10><M_11>500</M_11></FisheyeFocalMatrix>";
    let found = read(&block("", DOWN, fisheye, "")).unwrap();
    assert!((found.cameras[0].fx - 500.0 * std::f64::consts::FRAC_2_PI).abs() < 1e-9);
    let bent =
        format!("{fisheye}<FisheyeDistortion><P0>0</P0><P1>1</P1><P2>0.9</P2></FisheyeDistortion>");
    let refused = read(&block("", DOWN, &bent, "")).unwrap_err();
    assert!(refused.what.contains("p2 = 0.9"), "{refused}");
}

#[test]
fn definitions() {
    for (definition, expected) in [
        ("EPSG:2154", System::Named("EPSG:2154".to_owned())),
        ("EPSG:4978", System::Named("ECEF".to_owned())),
        (
            "EPSG:4326+EPSG:5773",
            System::Named("EPSG:4326+5773".to_owned()),
        ),
        ("WGS84", System::Named("EPSG:4326".to_owned())),
        (
            " PROJCS[\"x\"]\n",
            System::Named("PROJCS[\"x\"]".to_owned()),
        ),
        (
            "+proj=utm +zone=1",
            System::Named("+proj=utm +zone=1".to_owned()),
        ),
        ("Local coordinate system", System::Local),
        ("D:\\a.prj", System::Unknown("D:\\a.prj".to_owned())),
        ("ENU:1", System::Unknown("ENU:1".to_owned())),
    ] {
        assert_eq!(system::read(definition), expected, "{definition}");
    }
}

#[test]
fn mistakes_are_placed() {
    let good = block("", DOWN, "", "");
    for (from, to, what) in [
        ("<Width>1000", "<Width>0", "Width is '0'"),
        ("<M_22>-1", "<M_22>-2", "no rotation"),
        ("<M_22>-1", "<M_22>nan", "not a finite number"),
        ("<M_22>-1</M_22>", "", "a Rotation without M_22"),
        ("<Id>1</Id>", "<Id>0</Id>", "is there twice"),
        ("<SRSId>7", "<SRSId>8", "stands for no SRS"),
        ("800", "-800", "focal length"),
        ("BlocksExchange", "ATExport", "not of 'BlocksExchange'"),
        (
            "<FocalLengthPixels>800</FocalLengthPixels>",
            "",
            "focal length is not said",
        ),
        ("<z>100</z>", "", "a Center without z"),
    ] {
        let broken = good.replace(from, to);
        assert_ne!(broken, good, "{from}");
        let fault = read(&broken).unwrap_err();
        assert!(fault.what.contains(what), "{from}: {fault}");
    }
    let fault = read(&good.replace("<M_22>-1", "<M_22>x")).unwrap_err();
    assert_eq!(fault.line, Some(6), "{fault}");
    assert!(
        read("<BlocksExchange/>")
            .unwrap_err()
            .what
            .contains("no photo")
    );
}

#[test]
fn truncations_are_no_panic() {
    let good = block("", DOWN, "", "<TiePoints><TiePoint/></TiePoints>");
    for end in 0..good.len() {
        assert!(read(&good[..end]).is_err(), "{end}");
    }
}

proptest! {
    #[test]
    fn any_value_is_read_or_refused(value in "(-?[0-9.e]{0,6}|\\PC{0,8})", at in 0_usize..40) {
        let good = block("<CameraOrientation>XRightYUp</CameraOrientation>", DOWN, "", "");
        let value = value.replace(['<', '&'], "");
        // Puts the value in the place of the text behind one of the tags.
        let starts: Vec<_> = good.match_indices('>').map(|(at, _)| at + 1).collect();
        let start = starts[at % starts.len()];
        let end = start + good[start..].find('<').unwrap_or(0);
        let _ = read(&format!("{}{value}{}", &good[..start], &good[end..]));
    }
}

//! A flight.toml as it is read and written, and where its mistakes are.

use proptest::prelude::*;

use super::*;

const WHOLE: &str = r#"format = 1
name = "Lab trial 1"

[world]
unit = "m"
ground = 0.25

[surface]
file = "pile.ply"

[[camera]]
name = "bebop"
file = "ost.yaml"

[[camera]]
name = "other"
width = 1280
height = 720
fx = 1000.0
fy = 1001
cx = 639.5
cy = 359.5
skew = 0.5
pixel_origin = "center"
distortion = "brown"
coefficients = [0.1, -0.2]

[photos]
poses = "poses.csv"
folder = "photos"

[scale]
image = "as-shot"
"#;

#[test]
fn everything_is_read() {
    let file = FlightFile::parse(WHOLE).unwrap();
    assert_eq!(file.name.as_deref(), Some("Lab trial 1"));
    assert_eq!(file.unit(), Some(LengthUnit::Metre));
    assert_eq!(file.ground(), Ground::At(0.25));
    assert_eq!(file.image(), ImageKind::AsShot);
    assert_eq!(file.surface(), Some("pile.ply"));
    assert_eq!(file.photo_source(), PhotoSource::Poses("poses.csv"));
    assert_eq!(file.photo_folder(), Some("photos"));
    assert_eq!(file.cameras[0].source(), Ok(CameraSource::File("ost.yaml")));
    let Ok(CameraSource::Inline(camera)) = file.cameras[1].source() else {
        panic!("an inline camera");
    };
    // From pixel centres to the outer corner.
    assert_eq!((camera.cx, camera.cy, camera.fy), (640.0, 360.0, 1001.0));
    let k = [0.1, -0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(camera.distortion.coefficients(), k);
}

#[test]
fn surface_options_are_read() {
    let options = |text: &str| FlightFile::parse(text).map(|file| file.surface_options());
    let text = WHOLE.replace(
        "\"pile.ply\"",
        "\"pile.ply\"\nmax_edge = 2\nthinning = 0.05",
    );
    let both = SurfaceOptions {
        max_edge: Some(2.0),
        thinning: Some(0.05),
    };
    assert_eq!(options(&text), Ok(both));
    assert_eq!(options(WHOLE), Ok(SurfaceOptions::default()));
    let fault = options(&text.replace("max_edge = 2", "max_edge = -2")).unwrap_err();
    assert_eq!(fault.line, Some(10));
    let fault = options(&text.replace("0.05", "nan")).unwrap_err();
    assert_eq!(fault.line, Some(11));
    assert!(fault.what.contains("surface.thinning is NaN"), "{fault}");
    // The options may stand alone where a reconstruction brings the points.
    let text = "format = 1\nworld.unit = \"m\"\nsurface.max_edge = 3\n[photos]\nreconstruction = \"a.nvm\"";
    let file = FlightFile::parse(text).unwrap();
    assert_eq!(
        (file.surface(), file.settings().surface.max_edge),
        (None, Some(3.0))
    );
}

#[test]
fn the_axis_that_points_up() {
    assert_eq!(FlightFile::parse(WHOLE).unwrap().surface_up(), UpAxis::Z);
    let text = WHOLE.replace("\"pile.ply\"", "\"pile.ply\"\nup = \"y\"");
    let file = FlightFile::parse(&text).unwrap();
    assert_eq!(file.surface_up(), UpAxis::Y);
    assert_eq!(FlightFile::parse(&file.to_toml().unwrap()), Ok(file));
    let fault = FlightFile::parse(&text.replace("\"y\"", "\"up\"")).unwrap_err();
    assert_eq!(fault.line, Some(10));
    assert!(fault.what.contains("surface.up is 'up'"), "{fault}");
    let text =
        "format = 1\nworld.unit = \"m\"\nsurface.up = \"y\"\n[photos]\nreconstruction = \"a.nvm\"";
    let fault = FlightFile::parse(text).unwrap_err();
    assert!(fault.what.contains("belongs to surface.file"), "{fault}");
}

#[test]
fn what_is_written_reads_back() {
    let file = FlightFile::parse(WHOLE).unwrap();
    assert_eq!(FlightFile::parse(&file.to_toml().unwrap()), Ok(file));
    let text = "format = 1\n[world]\nunit = \"us-ft\"\n[photos]\nreconstruction = \"sparse/0\"\n\
            transform = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n";
    let file = FlightFile::parse(text).unwrap();
    assert_eq!(file.ground(), Ground::Auto);
    assert_eq!(FlightFile::parse(&file.to_toml().unwrap()), Ok(file));
}

fn refuse(from: &str, to: &str) -> Fault {
    assert!(WHOLE.contains(from));
    FlightFile::parse(&WHOLE.replace(from, to)).unwrap_err()
}

#[test]
fn unknown_keys_are_named_with_their_neighbour() {
    let fault = refuse("fx = 1000.0", "fX = 1000.0");
    assert_eq!(fault.line, Some(19));
    assert_eq!(
        fault.to_string(),
        "unknown key 'fX' in [camera]; did you mean 'fx'?"
    );
    let fault = refuse("[world]", "[wrold]");
    assert_eq!(
        fault.to_string(),
        "unknown key 'wrold'; did you mean 'world'?"
    );
    let fault = refuse("folder =", "weather_report =");
    assert!(fault.remedy.starts_with("known keys are poses"), "{fault}");
}

#[test]
fn scale_objects_are_read_and_their_mistakes_placed() {
    let object = "\n[[scale_object]]\nphoto = \"a.jpg\"\nkind = \"bar\"\nsize = 2\n\
            outline = [[1, 2], [3, 4.5]]\nmask = false\n";
    let text = WHOLE.to_owned() + object + object;
    let file = FlightFile::parse(&text).unwrap();
    let expected = ScaleObject {
        photo: "a.jpg".to_owned(),
        kind: crate::scale::ScaleObjectKind::Bar,
        size: 2.0,
        outline: vec![(1.0, 2.0).into(), (3.0, 4.5).into()],
        mask: false,
    };
    assert_eq!(file.settings().scale_objects, [expected.clone(), expected]);
    let lines = WHOLE.lines().count() as u64;
    // In the second of them.
    let refused = |from: &str, to: &str| {
        let text = WHOLE.to_owned() + object + &object.replace(from, to);
        FlightFile::parse(&text).unwrap_err()
    };
    for (from, to, line, what) in [
        ("size = 2", "size = 0", 5, "size is 0, no positive length"),
        ("size = 2", "size = nan", 5, "size is NaN"),
        ("[1, 2], ", "", 6, "of the bar has 1 points, not 2"),
        ("\"bar\"", "\"sphere\"", 6, "has 2 points, not at least 3"),
        ("4.5", "inf", 6, "not finite"),
        ("\"a.jpg\"", "\"\"", 3, "photo is empty"),
        ("\"bar\"", "\"ball\"", 4, "unknown variant"),
        (
            "mask",
            "masked",
            7,
            "unknown key 'masked' in [scale_object]",
        ),
    ] {
        let fault = refused(from, to);
        assert!(fault.what.contains(what), "{fault}");
        assert_eq!(fault.line, Some(lines + 7 + line), "{fault}");
    }
}

#[test]
fn mistakes_are_placed() {
    assert_eq!(refuse("format = 1", "format = 2").line, Some(1));
    assert_eq!(refuse("unit = \"m\"", "unit = \"km\"").line, Some(5));
    assert_eq!(refuse("ground = 0.25", "ground = nan").line, Some(6));
    assert_eq!(refuse("\"pile.ply\"", "\"\"").line, Some(9));
    assert_eq!(refuse("\"ost.yaml\"", "\"\"").line, Some(13));
    assert_eq!(refuse("ground = 0.25", "ground = \"low\"").line, Some(6));
    assert_eq!(refuse("fx = 1000.0", "fx = \"wide\"").line, Some(19));
    assert_eq!(refuse("poses = \"poses.csv\"", "").line, Some(30));
    assert_eq!(refuse("[photos]", "[photos").line, Some(28));
    let fault = refuse("folder =", "reconstruction =");
    assert!(fault.what.contains("both"), "{fault}");
    let fault = refuse("folder = \"photos\"", "transform = [1, 2]");
    assert_eq!(fault.line, Some(30));
    assert!(
        refuse("[surface]\nfile = \"pile.ply\"", "")
            .what
            .contains("no surface")
    );
}

proptest! {
    #[test]
    fn no_text_panics(text in "\\PC*") {
        let _ = FlightFile::parse(&text);
    }

    #[test]
    fn no_damage_panics(at in 0..WHOLE.len(), byte in 0..128_u8) {
        let mut bytes = WHOLE.as_bytes().to_vec();
        bytes[at] = byte;
        let _ = FlightFile::parse(&String::from_utf8(bytes).unwrap());
    }
}

#[test]
fn errors_and_the_pair_are_read() {
    let text =
        format!("{WHOLE}\n[uncertainty]\nposition = [0.01, 0.02, 3]\nangle = 1\nfocal = 0.1\n");
    let text = text.replace("[scale]", "[scale]\nuse = \"corners\"");
    let settings = FlightFile::parse(&text).unwrap().settings();
    assert_eq!(settings.pair, ScalePair::Corners);
    let expected = StatedErrors {
        pose: crate::scale::PoseErrors {
            position: Some(glam::DVec3::new(0.01, 0.02, 3.0)),
            angle: Some(glam::DVec3::ONE),
        },
        focal: Some(0.1),
        ..StatedErrors::default()
    };
    assert_eq!(settings.errors, expected);
    let fault = |line: &str| {
        let fault = FlightFile::parse(&format!("{WHOLE}\n[uncertainty]\n{line}\n"));
        fault.unwrap_err().to_string()
    };
    assert!(fault("focal = -0.1").contains("uncertainty.focal is -0.1"));
    // More is no error of anything, and 300 digits in a table.
    assert!(fault("world_scale = 1e300").contains("beyond all measure"));
    assert!(fault("position = 2e12").contains("beyond all measure"));
    assert!(fault("angle = [1, 2]").contains("expected a number or [x, y, z]"));
    assert!(fault("postion = 1").contains("did you mean 'position'?"));
    assert_eq!(FlightFile::parse(WHOLE).unwrap().pair(), ScalePair::Fitted);
}

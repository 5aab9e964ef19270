//! Recognising, reading and using trajectories of all formats.

use glam::{DMat3, DVec3};
use proptest::prelude::*;

use super::*;
use crate::Kind;
use crate::detect;
use crate::open_file;
use fragscale_test_data::shared_data;

const TUM: &str = "# ground truth trajectory\n# timestamp tx ty tz qx qy qz qw\n\
    1305031098.6659 1.3563 0.6305 1.6380 0.6132 0.5962 -0.3311 -0.3986\n\
    1305031098.6758 1.3543 0.6306 1.6360 0.6129 0.5966 -0.3316 -0.3980\n";
const EUROC: &str = "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], v_RS_R_x [m s^-1]\r\n\
    1403715524907143168,1,2,3,0.5,0.5,0.5,0.5,-0.002276\r\n\
    1403715524912143104,1,2,4,0.5,0.5,0.5,0.5,-0.003425\r\n";
/// The first two lines of sequence 00.
const KITTI: &str = "1.000000e+00 9.043680e-12 2.326809e-11 5.551115e-17 9.043683e-12 1.000000e+00 2.392370e-10 3.330669e-16 2.326810e-11 2.392370e-10 9.999999e-01 -4.440892e-16\n\
    9.999978e-01 5.272628e-04 -2.066935e-03 -4.690294e-02 -5.296506e-04 9.999992e-01 -1.154865e-03 -2.839928e-02 2.066324e-03 1.155958e-03 9.999971e-01 8.586941e-01\n";

fn kind(text: &str, name: &str) -> Option<TrajectoryFormat> {
    recognise(text, true, name)
}

fn parsed(text: &str) -> Result<Trajectory, Fault> {
    read(kind(text, "t.txt").unwrap(), text.as_bytes())
}

#[test]
fn the_content_tells_the_format() {
    for (text, format) in [
        (TUM, TrajectoryFormat::Tum),
        (EUROC, TrajectoryFormat::Euroc),
        (KITTI, TrajectoryFormat::Kitti),
    ] {
        assert_eq!(kind(text, "x.txt"), Some(format));
        assert_eq!(
            kind(&text.replace("\r\n", "\n").replace('\n', "\r\n"), "x.csv"),
            Some(format)
        );
        // Cut off in the middle of a line, as by the end of the bytes that are looked at.
        let cut = &text[..text.len() - 30];
        assert_eq!(recognise(cut, false, "x.txt"), Some(format));
    }
    // Without its comments, and with the commas that the benchmark's own script takes.
    let bare: String = TUM
        .lines()
        .filter(|l| !l.starts_with('#'))
        .map(|l| format!("{l}\n"))
        .collect();
    assert_eq!(kind(&bare, "x.txt"), Some(TrajectoryFormat::Tum));
    assert_eq!(
        kind(&bare.replace(' ', ", "), "x.txt"),
        Some(TrajectoryFormat::Tum)
    );
    let nanoseconds =
        "1403715273262142976.000000 1 2 3 0 0 0 1\n1403715273312142848.000000 1 2 3 0 0 0 1\n";
    assert_eq!(kind(nanoseconds, "x.txt"), Some(TrajectoryFormat::Tum));
    // One line only counts where the name says the same.
    assert_eq!(kind("1 0 0 0 0 0 0 1\n", "x.txt"), None);
    assert_eq!(
        kind("1 0 0 0 0 0 0 1\n", "x.tum"),
        Some(TrajectoryFormat::Tum)
    );
}

/// Clouds whose lines have as many numbers.
#[test]
fn clouds_stay_clouds() {
    for cloud in [
        // x y z, colour, two scalars.
        "458074.1 5429380.2 162.9 10 20 30 0.5 0.5\n458074.2 5429380.2 162.9 10 20 30 0.5 0.5\n",
        // x y z intensity normal confidence: normals have length 1, but not with a confidence.
        "1 2 3 7 0 0 1 0.9\n2 2 3 7 0 1 0 0.9\n",
        // What would be a quaternion, but on lines whose first number goes up and down.
        "5 2 3 0 0 0 0 1\n4 2 3 0 0 0 0 1\n",
        "-5 2 3 0 0 0 0 1\n-4 2 3 0 0 0 0 1\n",
        // Twelve numbers.
        "1 2 3 4 5 6 7 8 9 10 11 12\n2 3 4 5 6 7 8 9 10 11 12 13\n",
        // A mirror is no rotation.
        "-1 0 0 5 0 1 0 6 0 0 1 7\n",
        "x,y,z\n1,2,3\n",
        "",
        "\n",
        "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1]\n1403636579758555392,-0.09,0.14\n",
    ] {
        assert_eq!(kind(cloud, "x.txt"), None, "{cloud}");
    }
}

#[test]
fn tum_is_taken_as_it_stands() {
    let file = parsed(TUM).unwrap();
    assert!(!file.format.is_of_body());
    assert_eq!(file.poses[0].name, "1305031098.6659");
    assert_eq!(
        file.poses[1].pose.center,
        DVec3::new(1.3543, 0.6306, 1.6360)
    );
    // Row 3, column 3 of the matrix of a unit quaternion is 1 - 2 (x^2 + y^2).
    let [x, y, z, w] = [0.6132_f64, 0.5962, -0.3311, -0.3986];
    let n = x * x + y * y + z * z + w * w;
    let expected = 1.0 - 2.0 * (x * x + y * y) / n;
    assert!((file.poses[0].pose.rotation.z_axis.z - expected).abs() < 1e-15);
    // Row 1, column 2 is 2 (x y - z w).
    assert!((file.poses[0].pose.rotation.y_axis.x - 2.0 * (x * y - z * w) / n).abs() < 1e-15);
}

#[test]
fn euroc_writes_w_first_and_means_the_body() {
    let file = parsed(EUROC).unwrap();
    assert!(file.format.is_of_body());
    assert_eq!(file.poses[1].name, "1403715524912143104");
    assert_eq!(file.poses[1].pose.center, DVec3::new(1.0, 2.0, 4.0));
    // 1/2 (1, 1, 1, 1) turns x to y to z to x.
    let turn = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X);
    assert!(file.poses[0].pose.rotation.abs_diff_eq(turn, 1e-15));
    let half = EUROC.replace("0.5,0.5,0.5,0.5", "1,0,0,0");
    assert_eq!(
        parsed(&half).unwrap().poses[0].pose.rotation,
        DMat3::IDENTITY
    );
}

#[test]
fn kitti_is_numbered_by_its_lines() {
    let file = parsed(KITTI).unwrap();
    assert_eq!(file.poses[1].name, "000001");
    assert_eq!(
        file.poses[1].pose.center,
        DVec3::new(-4.690294e-2, -2.839928e-2, 8.586941e-1)
    );
    let rotation = file.poses[1].pose.rotation;
    assert!(
        (rotation.z_axis.x - -2.066935e-3).abs() < 1e-6,
        "row 1, column 3"
    );
    assert!((rotation.transpose() * rotation).abs_diff_eq(DMat3::IDENTITY, 1e-15));
}

#[test]
fn mistakes_have_a_line() {
    for (text, from, to, line, expected) in [
        (TUM, "-0.3986", "x", 3, "qw is 'x', not a number"),
        (
            TUM,
            "0.5966 -0.3316",
            "0.5966",
            4,
            "the line ends where qw should be",
        ),
        (TUM, "-0.3980", "-0.3980 7", 4, "'7' stands behind qw"),
        (
            TUM,
            "1305031098.6758",
            "-1",
            4,
            "the timestamp is '-1', not a time",
        ),
        (
            TUM,
            "0.6129 0.5966 -0.3316 -0.3980",
            "0 0 0 0",
            4,
            "the quaternion's length is 0e0, under 1e-6",
        ),
        (TUM, "1.3543", "nan", 4, "the position is 'nan', not finite"),
        (
            EUROC,
            "1403715524912143104,1",
            "1403715524912143104,inf",
            3,
            "column 2: 'inf' is not a finite number",
        ),
        (
            EUROC,
            "1403715524912143104",
            "1403715524.912",
            3,
            "the timestamp '1403715524.912' is no whole number of nanoseconds",
        ),
        (EUROC, "q_RS_w", "q_RS_v", 1, "there is no column q_..._w"),
        (
            KITTI,
            "8.586941e-01",
            "",
            2,
            "the line ends where one of the 12 numbers should be",
        ),
        (
            KITTI,
            "9.999992e-01",
            "9.9e-01",
            2,
            "its 3x3 part is no rotation (off by 2.0e-2, determinant 0.990)",
        ),
    ] {
        let format = kind(text, "").unwrap();
        let bad = text.replacen(from, to, 1);
        let fault = read(format, bad.as_bytes()).unwrap_err();
        assert_eq!((fault.line, fault.what.as_str()), (Some(line), expected));
    }
    assert!(
        read(TrajectoryFormat::Tum, &b"# nothing\n"[..])
            .unwrap_err()
            .what
            .contains("no poses")
    );
    assert!(read(TrajectoryFormat::Euroc, &b""[..]).is_err());
}

#[test]
fn disorder_is_counted() {
    let text = format!("{TUM}1305031098.6758 0 0 0 0 0 0 1\n1305031097 0 0 0 0 0 0 1\n");
    let file = read(TrajectoryFormat::Tum, text.as_bytes()).unwrap();
    assert!(
        file.warnings[0].starts_with("1 stamps are older"),
        "{:?}",
        file.warnings
    );
    assert!(
        file.warnings[1].starts_with("1 stamps stand twice"),
        "{:?}",
        file.warnings
    );
}

fn files(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

#[test]
fn photos_are_found_by_their_stamps() {
    let tum = "10 0 0 0 0 0 0 1\n10.4 4 0 0 0 0 0 1\n12 8 0 0 0 0 0 1\n";
    let file = read(TrajectoryFormat::Tum, tum.as_bytes()).unwrap();
    let names = files(&[
        "10.1.png",
        "10.400050.jpg",
        "11.0.png",
        "9.png",
        "IMG_7.JPG",
        "12.tif",
    ]);
    let posed = file.pose_files(&names).unwrap();
    let found: Vec<(&str, f64)> = posed
        .photos
        .iter()
        .map(|(name, pose)| (name.as_str(), pose.center.x))
        .collect();
    assert_eq!(
        found,
        [("10.1.png", 1.0), ("10.400050.jpg", 4.0), ("12.tif", 8.0)]
    );
    assert_eq!(
        posed.warnings,
        [
            "1 of 6 image files are not named by a time ('IMG_7.JPG') and are left out",
            "2 of 6 image files have no pose and are left out: '11.0.png', for one: the poses around it are 1.6 s apart (over 0.5 s nothing is interpolated)"
        ]
    );
    let fault = file
        .pose_files(&files(&["1403715524909643136.png"]))
        .unwrap_err();
    assert!(
        fault.what.contains("younger than the last pose (12 s)"),
        "{fault}"
    );
    assert!(
        fault.what.ends_with("the poses cover 10 s to 12 s"),
        "{fault}"
    );
    assert!(
        file.pose_files(&files(&["a.png"]))
            .unwrap_err()
            .what
            .contains("is named by a time")
    );
    assert!(
        file.pose_files(&[])
            .unwrap_err()
            .what
            .contains("no image files")
    );
    // Half way between EuRoC's two poses.
    let body = parsed(EUROC).unwrap();
    let posed = body
        .pose_files(&files(&["1403715524909643136.png"]))
        .unwrap();
    assert!((posed.photos[0].1.center - DVec3::new(1.0, 2.0, 3.5)).length() < 1e-12);
}

#[test]
fn photos_of_kitti_are_found_by_their_numbers() {
    let file = parsed(KITTI).unwrap();
    let posed = file
        .pose_files(&files(&["000000.png", "1.jpg", "000002.png"]))
        .unwrap();
    assert_eq!(posed.photos.len(), 2);
    assert_eq!(posed.photos[1].1, file.poses[1].pose);
    assert_eq!(
        posed.warnings,
        [
            "1 of 3 image files are not named by its line, 000000 to 000001 ('000002.png') and are left out"
        ]
    );
    let twice = file
        .pose_files(&files(&["000001.png", "1.jpg"]))
        .unwrap_err();
    assert!(twice.what.contains("both the photo of line 2"), "{twice}");
    assert!(file.pose_files(&files(&["a.png"])).is_err());
}

#[expect(clippy::excessive_precision, reason = "digit by digit as in the file")]
/// The counts of lines are `grep -vc '^#'`'s; the digits are those of the files.
#[test]
fn the_shared_trajectories() {
    for (name, format, count, at, stamp, center) in [
        (
            "freiburg1_xyz-groundtruth.txt",
            TrajectoryFormat::Tum,
            3000,
            0,
            "1305031098.6659",
            [1.3563, 0.6305, 1.6380],
        ),
        (
            "georeferenced.tum",
            TrajectoryFormat::Tum,
            1000,
            2,
            "1706282472.798386574",
            [
                4.580746041256971657e+05,
                5.429380172124968842e+06,
                1.629054958384238034e+02,
            ],
        ),
        (
            "V102.txt",
            TrajectoryFormat::Tum,
            807,
            1,
            "1403715529.212142944",
            [
                7.721999999999999698e-02,
                6.743999999999999995e-02,
                2.224700000000000011e-01,
            ],
        ),
        (
            "V102_groundtruth_first3000.csv",
            TrajectoryFormat::Euroc,
            3000,
            0,
            "1403715524907143168",
            [0.515356, 1.996773, 0.971104],
        ),
    ] {
        let Some(path) = shared_data(&format!("trajectories/{name}")) else {
            return;
        };
        assert_eq!(detect(&path), Ok(Kind::Trajectory(format)), "{name}");
        let input = std::io::BufReader::new(open_file(&path).unwrap());
        let file = read(format, input).unwrap();
        assert_eq!(file.poses.len(), count, "{name}");
        assert_eq!(file.poses[at].name, stamp);
        assert_eq!(
            file.poses[at].pose.center,
            DVec3::from_array(center),
            "{name}: to the last bit"
        );
        // `cut -d' ' -f1 V102.txt | uniq -d` prints 4 stamps.
        let doubles = file.warnings.first().map(String::as_str);
        let expected = "4 stamps stand twice in a row; photos take the first pose of each";
        assert_eq!(doubles, (name == "V102.txt").then_some(expected));
    }
}

proptest! {
    #[test]
    fn no_text_panics(text in "([0-9.eE+-]{0,6}[ ,\n#]|nan|timestamp|p_x|q_w){0,60}") {
        for format in [TrajectoryFormat::Tum, TrajectoryFormat::Euroc, TrajectoryFormat::Kitti] {
            let _ = read(format, text.as_bytes());
            let _ = read(format, format!("#timestamp,p_x,p_y,p_z,q_w,q_x,q_y,q_z\n{text}").as_bytes());
        }
        let _ = recognise(&text, false, "a.tum");
    }
}

//! Missions through the command: what one says, and the same for another ground station.

use std::fs;

/// Home at 50 N 7 E, one photo 12.34 m above it.
const WAYPOINTS: &str = "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t50\t7\t160\t1\n\
    1\t0\t3\t22\t0\t0\t0\tnan\t50\t7\t20\t1\n2\t0\t3\t16\t0\t0\t0\t37.4\t50.0001\t7.0001\t12.34\t1\n\
    3\t0\t2\t115\t37.4\t0\t0\t0\t0\t0\t0\t1\n4\t0\t2\t1000\t-90\t0\tnan\tnan\t12\t0\t0\t1\n\
    5\t0\t2\t93\t3\t-1\t-1\t-1\t0\t0\t0\t1\n6\t0\t2\t2000\t0\t0\t1\t0\t0\t0\t0\t1\n\
    7\t0\t2\t20\t0\t0\t0\t0\t0\t0\t0\t1\n";

#[test]
fn a_mission_is_told_and_written_for_another() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    fs::write(path("bench.waypoints"), WAYPOINTS).unwrap();
    let output = crate::common::fragscale(&[
        "mission",
        &path("bench.waypoints"),
        "--to",
        &path("bench.csv"),
    ]);
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0));
    let stop = "1  50.0001000, 7.0001000  12.34 m above the place of take-off  heading 37.4  gimbal -90.0  waits 3.0 s  photo\n";
    assert!(told.contains(stop), "{told}");
    assert!(told.contains("take-off: 50.0000000, 7.0000000, 160.00 m above the geoid EGM96\n"));
    assert!(told.contains("at the end: returns home\n"));
    assert!(told.contains("written: "), "{told}");
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(notes.contains("set the heading mode to Custom"), "{notes}");
    let litchi = crate::common::stdout_of(&["mission", &path("bench.csv")]);
    assert!(litchi.contains(stop), "{litchi}");
    // DJI asks for a drone, which this file does not have.
    let refused = crate::common::fragscale(&[
        "mission",
        &path("bench.waypoints"),
        "--to",
        &path("bench.kmz"),
    ]);
    assert_eq!(refused.status.code(), Some(1));
    let error = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        error.contains("bench.kmz: DJI's files need the drone"),
        "{error}"
    );
    // A take-off whose numbers were swapped.
    let far = crate::common::error_of(&["mission", &path("bench.waypoints"), "--take-off", "7,50"]);
    assert!(far.contains("the latitude comes first"), "{far}");
    // By haversines on a sphere of 6371 km, of whose latitude a degree is 111.2 km.
    assert!(
        far.contains("the nearest stop lies 6221 km from there"),
        "{far}"
    );
    let at = ["mission", &path("bench.waypoints"), "--take-off"];
    for (place, said) in [
        ("7,50", "swapped, 50,7 lies near them: the latitude"),
        (
            "-50,7",
            "with the other sign of the latitude, 50,7 lies near them: the latitude",
        ),
        (
            "50,-7",
            "with the other sign of the longitude, 50,7 lies near them: the latitude",
        ),
        (
            "-50,-7",
            "with the other signs, 50,7 lies near them: the latitude",
        ),
        (
            "50.5001,7.0001",
            "the nearest stop lies 56 km from there; check both",
        ),
        (
            "50.0631,7.0001",
            "the nearest stop lies 7.0 km from there; check both",
        ),
        (
            "50.0190,7.0001",
            "the nearest stop lies 2.1 km from there; check both",
        ),
    ] {
        let far = crate::common::error_of(&[&at[..], &[place]].concat());
        assert!(far.contains(said), "{place}: {far}");
    }
    crate::common::stdout_of(&[&at[..], &["50.0170,7.0001"]].concat());
    // What is no latitude and longitude at all, though x and y of a map may be.
    let degrees = "write the latitude and the longitude in degrees, with a comma between them";
    for (place, said) in [
        ("34.98;-106.6", degrees),
        ("50", degrees),
        ("50,7;51,8", degrees),
        ("91,0", "a latitude lies between -90 and 90 degrees"),
        (
            "452250,5411820",
            "a latitude lies between -90 and 90 degrees",
        ),
        ("50,187", "a longitude lies between -180 and 180 degrees"),
    ] {
        let refused = crate::common::fragscale(&[&at[..], &[place]].concat());
        let error = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(
            !refused.status.success() && error.contains(said),
            "{place}: {error}"
        );
    }
    // Its elevation is nothing that --take-off says: the file's 0 is no height.
    let to = ["--to", &path("bench.plan")];
    let moved = crate::common::fragscale(&[&at[..], &["50.0001,7"], &to].concat());
    let said = String::from_utf8_lossy(&moved.stderr).into_owned();
    assert!(
        said.contains("how high the place of take-off lies is not known"),
        "{said}"
    );
    let known = ["--elevation", "160", "--datum", "geoid", "--force"];
    let moved = crate::common::fragscale(&[&at[..], &["50.0001,7"], &to, &known].concat());
    let said = String::from_utf8_lossy(&moved.stderr).into_owned();
    assert!(
        moved.status.success() && !said.contains("lies is not known"),
        "{said}"
    );
    let shown = crate::common::stdout_of(&["info", &path("bench.waypoints")]);
    let take_off = "take off: 50.0000000, 7.0000000, 160.00 m above the geoid EGM96\n";
    assert!(shown.contains(take_off), "{shown}");
    // What was read is not written over.
    let own = crate::common::fragscale(&[
        "mission",
        &path("bench.waypoints"),
        "--to",
        &path("bench.waypoints"),
        "--force",
    ]);
    assert_eq!(own.status.code(), Some(1));
    assert_eq!(
        fs::read_to_string(path("bench.waypoints")).unwrap(),
        WAYPOINTS
    );
}

/// DJI's file to DJI's file: what it does at the end and where the radio is lost stays, and is listed; for Litchi, whose files
/// cannot say it, it is named.
#[test]
fn what_a_drone_does_by_itself_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let geojson = r#"{"type":"FeatureCollection","fragscale":"mission 1","name":"a","speed_m_per_s":3,"safe_height_m":20,"return_height_m":30,"finish":"FINISH","lost_signal":"LOST","drone":{"drone":77,"drone_sub":0,"payload":{"payload":66,"payload_sub":0,"position":0}},"features":[{"type":"Feature","geometry":{"type":"Point","coordinates":[7.0,50.0]},"properties":{"what":"stop","number":1,"height_m":12.0,"above":"take-off","heading_deg":10.0,"gimbal_pitch_deg":-60.0,"settle_s":3.0,"photo":true,"photo_name":"P001"}}]}"#;
    for (finish, lost, listed) in [
        ("land", "hover", ["lands", "hovers"]),
        (
            "first stop",
            "land",
            ["flies to the first stop and hovers", "lands"],
        ),
        ("return home", "go on", ["returns home", "goes on"]),
    ] {
        let text = geojson.replace("FINISH", finish).replace("LOST", lost);
        fs::write(path("a.geojson"), text).unwrap();
        for (from, to) in [("a.geojson", "a.kmz"), ("a.kmz", "b.kmz")] {
            let (from, to) = (path(from), path(to));
            let output = crate::common::fragscale(&["mission", &from, "--to", &to, "--force"]);
            assert_eq!(output.status.code(), Some(0), "{output:?}");
        }
        let told = crate::common::stdout_of(&["mission", &path("b.kmz")]);
        let [end, radio] = listed;
        assert!(told.contains(&format!("at the end: {end}\n")), "{told}");
        assert!(
            told.contains(&format!("where the radio is lost: {radio}\n")),
            "{told}"
        );
        let litchi = ["mission", &path("b.kmz"), "--to", &path("b.csv"), "--force"];
        let notes = crate::common::fragscale(&litchi).stderr;
        let notes = String::from_utf8_lossy(&notes).into_owned();
        let named = format!("does where the radio is lost ({radio}): set it at the drone");
        assert!(notes.contains(&named), "{notes}");
    }
}

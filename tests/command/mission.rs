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
    // By haversines on a sphere of 6371 km; half a degree of latitude is 55.6 km of it, 0.4 are 44.5.
    assert!(far.contains("a stop lies 6221 km from there"), "{far}");
    let north = ["mission", &path("bench.waypoints"), "--take-off"];
    let far = crate::common::error_of(&[&north[..], &["50.5001,7.0001"]].concat());
    assert!(far.contains("a stop lies 56 km from there"), "{far}");
    crate::common::stdout_of(&[&north[..], &["50.4001,7.0001"]].concat());
    let shown = crate::common::stdout_of(&["info", &path("bench.waypoints")]);
    let take_off =
        "take off: elevation (above the geoid EGM96, metres 160.0), latitude 50.0, longitude 7.0";
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

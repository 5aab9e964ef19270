//! What is written, read back by our own readers and looked at as text.

mod parted;
mod round_trip;
mod traps;
mod writing;

use fragscale_core::plan::{
    Above, DroneCodes, Fence, Finish, Height, LostSignal, Mission, PayloadCodes, PhotoOf, Stop,
    TakeOff,
};

use super::*;

/// Two photos of a bench from above and one waypoint on the way, at 50 N 7 E.
fn mission() -> Mission {
    let stop = |latitude, height, heading, pitch, photo: Option<&str>| Stop {
        latitude,
        longitude: 7.0001,
        height: Height::above_take_off(height),
        heading: Some(heading),
        gimbal_pitch: Some(pitch),
        settle: 3.0,
        photo: photo.map(|name| PhotoOf {
            name: Some(name.to_owned()),
        }),
    };
    Mission {
        name: "bench".to_owned(),
        drone: Some(mavic_3e()),
        take_off: Some(TakeOff {
            latitude: 50.0,
            longitude: 7.0,
            elevation: Some(Height {
                metres: 160.0,
                above: Above::Geoid,
            }),
        }),
        speed: Some(3.0),
        safe_height: Some(20.0),
        return_height: Some(33.0),
        finish: Finish::ReturnHome,
        lost_signal: Some(LostSignal::ReturnHome),
        stops: vec![
            stop(50.0001, 12.34, 37.4, -62.7, Some("P001")),
            Stop {
                heading: None,
                gimbal_pitch: None,
                settle: 0.0,
                ..stop(50.000_15, 20.0, 0.0, 0.0, None)
            },
            stop(50.0002, -13.9, 220.0, -90.0, Some("P002")),
        ],
        fences: vec![Fence {
            keep_in: false,
            corners: vec![[50.001, 7.001], [50.002, 7.001], [50.002, 7.002]],
        }],
    }
}

fn mavic_3e() -> DroneCodes {
    DroneCodes {
        drone: 77,
        drone_sub: 0,
        payload: Some(PayloadCodes {
            payload: 66,
            payload_sub: 0,
            position: 0,
        }),
    }
}

/// The one file of a mission.
fn file(mission: &Mission, format: MissionFormat) -> Vec<u8> {
    let mut files = mission_files(mission, format).unwrap().files;
    assert_eq!(files.len(), 1);
    files.remove(0).1
}

fn text(mission: &Mission, format: MissionFormat) -> String {
    String::from_utf8(file(mission, format)).unwrap()
}

fn notes(mission: &Mission, format: MissionFormat) -> String {
    mission_files(mission, format).unwrap().notes.join("\n")
}

/// A file of a .kmz.
fn unzipped(kmz: Vec<u8>, name: &str) -> String {
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(kmz)).unwrap();
    let mut text = String::new();
    std::io::Read::read_to_string(&mut archive.by_name(name).unwrap(), &mut text).unwrap();
    text
}

fn refused(mission: &Mission, format: MissionFormat) -> String {
    mission_files(mission, format).unwrap_err().to_string()
}

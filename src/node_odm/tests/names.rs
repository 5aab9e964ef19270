//! Photos whose names a node would change, and the lists that name them.

use super::*;
use crate::opening::{OpenOptions, open_flight};

/// A memory card: folders that a camera made, in which photos are called alike. The node knows its own names, the
/// flight and its photos theirs.
#[test]
fn a_memory_card_is_a_flight() {
    let desk = Desk::faulty(ServerFault::None);
    let photos = desk.photos();
    for (number, name) in [(1, "100MEDIA"), (2, "101MEDIA"), (3, "101MEDIA")] {
        fs::create_dir_all(photos.join(name)).unwrap();
        let new = ["A.JPG", "A.JPG", "B C.JPG"][number - 1];
        let old = photos.join(format!("IMG_{number}.JPG"));
        fs::rename(old, photos.join(name).join(new)).unwrap();
    }
    fs::remove_file(photos.join("geo.txt")).unwrap();
    let places = "EPSG:32615\n100MEDIA/A.JPG 1 2 3\nb c.jpg 1 2 3\n";
    fs::write(photos.join("Geo.TXT"), places).unwrap();
    fs::write(photos.join("image_groups.txt"), "B C.JPG west\n").unwrap();
    let list = "EPSG:32615\n1 2 3 10 20 101MEDIA/A.JPG a\n1 2 3 10 20 100media/A.JPG a\n";
    fs::write(photos.join("gcp_list.txt"), list).unwrap();
    let names = ["100MEDIA_A.JPG", "101MEDIA_A.JPG", "B_C.JPG"];
    let shots = names.map(|name| {
        format!(
            r#"{{"properties": {{"filename": "{name}", "camera": "lens", "translation": [0, 0, 30], "rotation": [3.14, 0, 0]}}}}"#
        )
    });
    let shots = format!(r#"{{"features": [{}]}}"#, shots.join(","));
    desk.server.now_serves(|served| {
        served.results = zipped(&[
            ("cameras.json", CAMERAS.as_bytes()),
            ("odm_report/shots.geojson", shots.as_bytes()),
            (CLOUD, &cloud(50)),
        ]);
    });
    let made = desk.run().unwrap();
    assert_eq!(made.registered, 3);
    let task = &desk.server.tasks()[0];
    let mut sent: Vec<(&str, &[u8])> = (task.files.iter())
        .map(|(name, bytes)| (name.as_str(), bytes.as_slice()))
        .collect();
    sent.sort_unstable();
    let sent_names: Vec<&str> = sent.iter().map(|(name, _)| *name).collect();
    assert_eq!(
        sent_names,
        [&names[..], &["gcp_list.txt", "geo.txt", "image_groups.txt"]].concat()
    );
    assert_eq!(
        String::from_utf8_lossy(sent[4].1),
        "EPSG:32615\n100MEDIA_A.JPG 1 2 3\nB_C.JPG 1 2 3\n"
    );
    assert_eq!(
        String::from_utf8_lossy(sent[3].1),
        "EPSG:32615\n1 2 3 10 20 101MEDIA_A.JPG a\n1 2 3 10 20 100MEDIA_A.JPG a\n"
    );
    assert_eq!(sent[5].1, b"B_C.JPG west\n");
    assert_eq!(sent[0].1, fs::read(photos.join("100MEDIA/A.JPG")).unwrap());
    let said = made.warnings.iter();
    assert!(said.clone().all(|warning| !warning.contains("not sent")));
    // The flight finds each of its photos.
    let opened = open_flight(&made.flight, &OpenOptions::default(), &Progress::default());
    let opened = opened.unwrap();
    let photos_of = opened.flight.parts().photos.iter();
    let mut of_flight: Vec<&str> = photos_of.map(|photo| photo.name.as_str()).collect();
    of_flight.sort_unstable();
    assert_eq!(
        of_flight,
        ["100MEDIA/A.JPG", "101MEDIA/A.JPG", "101MEDIA/B C.JPG"]
    );
    for file in &opened.photo_files {
        assert!(file.path.is_some());
    }
}

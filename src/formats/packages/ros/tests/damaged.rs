//! Recordings that are cut short, whose lengths lie, or that are overwritten in places: read, or refused.

use proptest::prelude::*;

use super::*;

#[test]
fn every_truncation_is_read_or_refused() {
    let whole = bag(&flight(Style::Ros1), "none");
    for end in 0..whole.len() {
        match of_bag(&whole[..end]) {
            Ok(recording) => {
                let _ = recording.reconstruction();
            }
            Err(fault) => assert!(!fault.what.is_empty()),
        }
    }
    // Cut off behind the chunk, all of it is read, and that it is cut is said.
    let cut = of_bag(&whole[..whole.len() - 5])
        .unwrap()
        .reconstruction()
        .unwrap();
    assert_eq!(cut.photos.len(), 2);
    assert!(cut.warnings[0].contains("cut off"), "{:?}", cut.warnings);
    for options in [
        ::mcap::WriteOptions::new(),
        ::mcap::WriteOptions::new().use_chunks(false),
    ] {
        let whole = mcap(&flight(Style::Big), "cdr", options);
        for end in 0..whole.len() {
            if let Ok(recording) = of_mcap(&whole[..end]) {
                let _ = recording.reconstruction();
            }
        }
    }
    assert!(
        of_bag(b"#ROSBAG V1.2\nrest")
            .unwrap_err()
            .what
            .contains("another version ('#ROSBAG V1.2')")
    );
}

#[test]
fn no_length_is_believed() {
    // A record, a chunk and a field that claim 4 GB; a chunk that claims another size.
    let mut record = b"#ROSBAG V2.0\n".to_vec();
    record.extend([0xff; 4]);
    assert!(
        of_bag(&record)
            .unwrap_err()
            .what
            .contains("4294967295 bytes")
    );
    let whole = bag(&flight(Style::Ros1), "lz4");
    let size = whole
        .windows(5)
        .position(|bytes| bytes == b"size=")
        .unwrap()
        + 5;
    for (claim, expected) in [
        (u32::MAX, "over the 536870912"),
        (400 << 20, "is not the 419430400 bytes long"),
    ] {
        let mut lying = whole.clone();
        lying[size..size + 4].copy_from_slice(&claim.to_le_bytes());
        let fault = of_bag(&lying).unwrap_err();
        assert!(fault.what.contains(expected), "{fault}");
    }
    let mut record = super::mcap::MAGIC.to_vec();
    record.push(5);
    record.extend(u64::MAX.to_le_bytes());
    assert!(
        of_mcap(&record)
            .unwrap_err()
            .what
            .contains("18446744073709551615 bytes")
    );
}

#[test]
fn damaged_sqlite_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.db3");
    db3(&file, &flight(Style::Little), "cdr");
    let whole = fs::read(&file).unwrap();
    for end in (16..whole.len()).step_by(997) {
        fs::write(&file, &whole[..end]).unwrap();
        let _ = project(&file);
    }
    for at in (100..whole.len()).step_by(131) {
        let mut bad = whole.clone();
        bad[at] ^= 0xff;
        fs::write(&file, &bad).unwrap();
        let _ = project(&file);
    }
    fs::write(&file, &whole[..200]).unwrap();
    let fault = project(&file).unwrap_err().to_string();
    assert!(fault.contains("SQLite cannot read it"), "{fault}");
    let other = rusqlite::Connection::open(folder.path().join("b.db3")).unwrap();
    other
        .execute_batch("CREATE TABLE messages(id INTEGER)")
        .unwrap();
    let fault = project(&folder.path().join("b.db3"))
        .unwrap_err()
        .to_string();
    assert!(fault.contains("no such table: topics"), "{fault}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn no_damage_panics(at in 0_usize..6000, bytes in proptest::collection::vec(any::<u8>(), 1..9)) {
        let damaged = |mut whole: Vec<u8>| {
            let at = at % whole.len();
            for (to, from) in whole[at..].iter_mut().zip(&bytes) {
                *to = *from;
            }
            whole
        };
        let options = ::mcap::WriteOptions::new;
        let recordings = [
            of_bag(&damaged(bag(&flight(Style::Ros1), "none"))),
            of_bag(&damaged(bag(&flight(Style::Ros1), "lz4"))),
            of_mcap(&damaged(mcap(&flight(Style::Little), "cdr", options().compression(None)))),
            of_mcap(&damaged(mcap(&flight(Style::Big), "cdr", options().use_chunks(false)))),
        ];
        for recording in recordings.into_iter().flatten() {
            let _ = recording.reconstruction();
            let _ = recording.named_poses();
        }
    }
}

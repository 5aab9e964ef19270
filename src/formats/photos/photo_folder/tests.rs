use std::fs;

use super::*;

/// One format, spelt in two ways; the same name of another format is another photo, as a thermal camera's beside it.
#[test]
fn an_ending_spelt_otherwise_is_found() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.JPEG", "b.jpg", "c.tif", "d.png"] {
        fs::write(folder.path().join(name), "a photo").unwrap();
    }
    let files = PhotoFolder::new(Some(folder.path()));
    let found = ["a.jpg", "b.jpeg", "c.TIFF", "d.jpg"].map(|name| files.find(name).is_some());
    assert_eq!(found, [true, true, true, false]);
}

/// A folder as macOS wrote it beside a list of poses from elsewhere, and the other way round; also where a folder's name has
/// accents.
#[test]
fn accents_apart_are_the_same_letters() {
    let folder = tempfile::tempdir().unwrap();
    for name in [
        "Bo\u{308}schung 1.JPG",
        "B\u{f6}schung 2.JPG",
        "Su\u{308}d/3.jpg",
        "N\u{f6}rd/4.jpg",
    ] {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, &name[name.len() - 5..]).unwrap();
    }
    let files = PhotoFolder::new(Some(folder.path()));
    for (asked, found) in [
        ("B\u{f6}schung 1.JPG", "1.JPG"),
        ("b\u{f6}schung 1", "1.JPG"),
        ("D:\\flug\\Bo\u{308}schung 2.JPG", "2.JPG"),
        ("S\u{fc}d/3.jpg", "3.jpg"),
        ("No\u{308}rd/4.jpg", "4.jpg"),
    ] {
        let path = files.find(asked).expect(asked);
        assert_eq!(fs::read_to_string(path).unwrap(), found, "{asked}");
    }
    assert_eq!(files.find("Boschung 1.JPG"), None);
}

/// Folders of an engineer's own: the photos of a folder that is named lie right below it. A package's may hold other flights'.
#[test]
fn a_named_folder_has_the_photos_in_its_folders() {
    let folder = tempfile::tempdir().unwrap();
    for name in [
        "sub1/IMG_0001.JPG",
        "sub1/IMG_0003.jpg",
        "sub2/IMG_0002.jpg",
        "sub2/IMG_0003.jpg",
        "sub2/IMG_0003.jpeg",
        "100MEDIA/DJI_0500.JPG",
        "sub2/deeper/IMG_0004.jpg",
    ] {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "a photo").unwrap();
    }
    let named = PhotoFolder::named(Some(folder.path()), &[]);
    for (photo, file) in [
        ("IMG_0001.jpg", Some("sub1/IMG_0001.JPG")),
        ("img_0002", Some("sub2/IMG_0002.jpg")),
        // In both; the folder before it tells, as other systems write it, too.
        ("IMG_0003.jpg", None),
        ("sub2/IMG_0003.jpg", Some("sub2/IMG_0003.jpg")),
        (r"D:\flug\SUB1\IMG_0003.jpg", Some("sub1/IMG_0003.jpg")),
        // Not there, whatever the other folder has.
        ("sub1/IMG_0002.jpg", None),
        ("101MEDIA/DJI_0500.JPG", None),
        // A folder that nothing is known of does not tell.
        ("photos/IMG_0001.jpg", Some("sub1/IMG_0001.JPG")),
        ("photos/DJI_0500.JPG", Some("100MEDIA/DJI_0500.JPG")),
        ("IMG_0004.jpg", None),
    ] {
        let expected = file.map(|file| folder.path().join(file));
        assert_eq!(named.find(photo), expected, "{photo}");
    }
    assert!(named.check(&["IMG_0001.jpg", "IMG_0003.jpg"]).is_ok());
    let fault = named.check(&["IMG_0003.jpg"]).unwrap_err();
    let words = "several folders within it (sub1, sub2) have files called as the flight's photos (IMG_0003.jpg)";
    assert!(fault.what.starts_with(words), "{fault}");
    assert!(fault.remedy.contains("(sub1/IMG_0003.jpg)"), "{fault}");
    assert_eq!(named.in_several(&["IMG_0001.jpg", "IMG_0004.jpg"]), None);
    let found = PhotoFolder::new(Some(folder.path()));
    assert_eq!(found.find("IMG_0001.jpg"), None);
}

/// A memory card's DCIM, of which a package kept the names of files alone: what two of its folders have is nobody's.
#[test]
fn a_card_is_the_folder_of_the_photos_in_its_folders() {
    let card = tempfile::tempdir().unwrap();
    let write = |name: &str| {
        let path = card.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "a photo").unwrap();
    };
    for name in [
        "100MEDIA/DJI_0998.JPG",
        "101MEDIA/DJI_0999.JPG",
        "north/DJI_0001.JPG",
    ] {
        write(name);
    }
    for folder in ["100MEDIA", "101MEDIA"] {
        write(&format!("{folder}/DJI_0500.JPG"));
    }
    let found = |photo: &str| {
        let path = PhotoFolder::new(Some(card.path())).find(photo)?;
        Some(path.strip_prefix(card.path()).unwrap().to_owned())
    };
    assert_eq!(found("DJI_0998.JPG"), Some("100MEDIA/DJI_0998.JPG".into()));
    assert_eq!(found("dji_0999"), Some("101MEDIA/DJI_0999.JPG".into()));
    assert_eq!(found("DJI_0500.JPG"), None);
    assert_eq!(
        found("101MEDIA/DJI_0500.JPG"),
        Some("101MEDIA/DJI_0500.JPG".into())
    );
    // No camera made it.
    assert_eq!(found("DJI_0001.JPG"), None);
    // Photos of its own are those that are meant.
    write("DJI_0500.JPG");
    assert_eq!(found("DJI_0500.JPG"), Some("DJI_0500.JPG".into()));
    assert_eq!(found("DJI_0998.JPG"), None);
}

/// The files of thumbnails have the names of the photos, and not their size; without a size nothing says which are meant.
#[test]
fn of_namesakes_the_one_of_the_photos_size_is_taken() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, width, height| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        image::RgbImage::new(width, height).save(path).unwrap();
    };
    write("100MEDIA/DJI_0001.PNG", 40, 30);
    write("thumbnails/DJI_0001.PNG", 8, 6);
    // As large as another photo of the flight.
    write("100MEDIA/DJI_0002.PNG", 40, 30);
    write("again/DJI_0002.PNG", 40, 30);
    let names = ["DJI_0001.PNG", "DJI_0002.PNG"];
    let named = |size| PhotoFolder::named(Some(folder.path()), &names.map(|name| (name, size)));
    let of_size = named(Some((40, 30)));
    let taken = folder.path().join("100MEDIA/DJI_0001.PNG");
    assert_eq!(of_size.find(names[0]), Some(taken));
    assert_eq!(of_size.find(names[1]), None);
    let said = of_size.chosen_by_size().unwrap();
    assert!(
        said.starts_with("several folders within it (100MEDIA, thumbnails)"),
        "{said}"
    );
    assert!(said.contains("(DJI_0001.PNG)") && said.ends_with("are taken (100MEDIA)"));
    let several = of_size.in_several(&names).unwrap();
    assert!(several.what.contains("(DJI_0002.PNG)"), "{several}");
    // A package that solved on reduced photos has the size of the thumbnails.
    for size in [None, Some((400, 300)), Some((8, 6))] {
        let of_none = named(size);
        assert_eq!(of_none.find(names[0]), None);
        assert_eq!(of_none.chosen_by_size(), None);
    }
}

/// A logo says nothing of where the photos are; one of the photos does.
#[test]
fn a_stray_picture_does_not_end_the_search() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "a photo").unwrap();
    };
    for name in ["logo.jpg", "sub1/IMG_0001.jpg", "sub2/IMG_0002.jpg"] {
        write(name);
    }
    let names = ["IMG_0001.jpg", "IMG_0002.jpg"];
    let found = || {
        let files = PhotoFolder::named(Some(folder.path()), &names.map(|name| (name, None)));
        (
            names.map(|name| files.find(name).is_some()),
            files.check(&["IMG_7.jpg"]),
        )
    };
    let (both, checked) = found();
    assert_eq!(both, [true, true]);
    let words =
        "it holds 1 images (logo.jpg, ...), but also in the folders within it (sub1, sub2) none of";
    assert!(checked.unwrap_err().what.starts_with(words));
    write("IMG_0002.jpg");
    assert_eq!(found().0, [false, true]);
}

/// As on a card whose photos were moved and linked.
#[cfg(unix)]
#[test]
fn links_that_lead_nowhere_are_called_so() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["IMG_0001.jpg", "IMG_0002.jpg"];
    for name in names {
        std::os::unix::fs::symlink("/nowhere/at/all.jpg", folder.path().join(name)).unwrap();
    }
    let files = PhotoFolder::named(Some(folder.path()), &names.map(|name| (name, None)));
    let fault = files.check(&names).unwrap_err();
    let words = "the files of 2 of the flight's photos (IMG_0001.jpg, IMG_0002.jpg) are links that lead nowhere";
    assert_eq!(fault.what, words);
    let one = files.dead_links(&["IMG_0001.jpg", "IMG_0003.jpg"]).unwrap();
    assert!(one.what.contains("photo IMG_0001.jpg is a link"), "{one}");
    assert_eq!(files.dead_links(&["IMG_0003.jpg"]), None);
}

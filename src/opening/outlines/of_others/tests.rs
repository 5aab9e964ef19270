//! Files of outlines and photos of many names.

use std::fs;

use super::*;

fn camera(width: u32, height: u32) -> Camera {
    Camera {
        name: String::new(),
        width,
        height,
        fx: 4.0,
        fy: 4.0,
        cx: 2.0,
        cy: 2.0,
        skew: 0.0,
        distortion: crate::camera::Distortion::None,
    }
}

/// A label image of 4 by 4 pixels of which one has that number.
fn write_labels(path: &Path, number: u8) {
    let mut image = image::GrayImage::new(4, 4);
    image.put_pixel(1, 1, image::Luma([number]));
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    image.save(path).unwrap();
}

/// What of `path` is of a photo of that size.
fn of_photo(path: &Path, name: &str, photos: &[&str]) -> Result<Masks, Fault> {
    let others = OutlinesOfOthers::open(path, None).unwrap();
    others.of_photo(name, photos, (&camera(4, 4), 1), false)
}

#[test]
fn files_are_known_by_the_name_of_their_photo() {
    let files = [
        "IMG_0005.jpg",
        "IMG_0005.json",
        "IMG_0005_labels.png",
        "IMG_00051_labels.png",
        "img_0005_full_set_pred.tif",
        "IMG_0005_outlines.png",
        "IMG_0005.png",
    ];
    let files: Vec<PathBuf> = files
        .iter()
        .map(|name| Path::new("masks").join(name))
        .collect();
    let found = |photo: &str| -> Vec<String> {
        let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
        candidates(&files, photo, &[photo]).map(name).collect()
    };
    assert_eq!(
        found("photos/IMG_0005.jpg"),
        [
            "IMG_0005_labels.png",
            "IMG_0005.json",
            "IMG_0005.png",
            "img_0005_full_set_pred.tif"
        ]
    );
    // The photo itself is no outline.
    assert_eq!(found("IMG_0005.png").len(), 3);
    assert!(found("IMG_0006.jpg").is_empty());
    // What is of no photo is named: neither photos nor what lies beside label images.
    let folder = OutlinesOfOthers {
        path: "masks".into(),
        of: None,
        place: Place::Folder(files),
    };
    let photos = ["IMG_00051.jpg", "IMG_0006.jpg"];
    assert_eq!(
        photos.map(|photo| folder.is_of(photo, &photos)),
        [true, false]
    );
    let of_none = folder.of_no_photo(&["a/IMG_0005.jpg", "b.jpg"]);
    assert_eq!(of_none, ["IMG_00051_labels.png"]);
}

/// Label images as a Mac wrote them, for photos whose list of poses is from elsewhere.
#[test]
fn accents_apart_are_the_same_letters() {
    let files = ["Bo\u{308}schung_1_labels.png", "Bo\u{308}schung_1.JPG"];
    let files: Vec<PathBuf> = files
        .iter()
        .map(|name| Path::new("Su\u{308}d").join(name))
        .collect();
    let photos = ["S\u{fc}d/B\u{f6}schung_1.JPG", "B\u{f6}schung_1.JPG"];
    let folder = OutlinesOfOthers {
        path: "masks".into(),
        of: None,
        place: Place::Folder(files.clone()),
    };
    // The photo's folder tells which of the two it is of.
    assert_eq!(
        photos.map(|photo| folder.is_of(photo, &photos)),
        [true, false]
    );
    let found: Vec<&Path> = candidates(&files, photos[0], &photos).collect();
    assert_eq!(found, [&files[0]]);
}

/// As Roboflow and CVAT export it: one file of all photos, perhaps beside them.
#[test]
fn a_folder_may_hold_one_file_of_many_photos() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("DJI_0005.jpg", "a photo");
    write(
        "_annotations.coco.json",
        r#"{"images": [{"id": 1, "file_name": "DJI_0005.jpg", "width": 4, "height": 4}], "categories": [], "annotations": []}"#,
    );
    let open = || OutlinesOfOthers::open(folder.path(), None).unwrap();
    let is_of = |photo: &str| open().is_of(photo, &[photo]);
    assert!(is_of("DJI_0005.jpg"));
    assert!(!is_of("DJI_0006.jpg"));
    // Another one, for other photos, in a folder within; and a photo that is a PNG.
    let of = |photo: &str| {
        format!(
            r#"{{"images": [{{"id": 1, "file_name": "{photo}", "width": 4, "height": 4}}], "categories": [], "annotations": []}}"#
        )
    };
    fs::create_dir_all(folder.path().join("annotations")).unwrap();
    write("annotations/instances_default.json", &of("DJI_0007.png"));
    write("DJI_0007.png", "a photo");
    assert!(is_of("DJI_0005.jpg") && is_of("DJI_0007.png"));
    assert_eq!(open().of_no_photo(&["DJI_0005.jpg"]), ["DJI_0007.png"]);
    // Beside files of single photos their names count.
    write("DJI_0006_labels.png", "a label image");
    assert!(!is_of("DJI_0005.jpg"));
    assert!(is_of("DJI_0006.jpg"));
}

/// Cards have folders of their own, with the same names in each: a name alone tells nothing of which photo it is.
#[test]
fn outlines_of_photos_of_one_name_say_their_folder() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str| write_labels(&folder.path().join(name), 1);
    let found = |name: &str, namesake: Option<&str>| {
        let photos: Vec<&str> = [name].into_iter().chain(namesake).collect();
        of_photo(folder.path(), name, &photos)
    };
    write("A_labels.png");
    assert!(found("d1/A.jpg", None).is_ok());
    let fault = found("d1/A.jpg", Some("d2/A.jpg")).unwrap_err();
    assert!(
        fault.what.contains("it may be of d1/A.jpg or of d2/A.jpg"),
        "{fault}"
    );
    write("d1/A.png");
    write("d2_A_labels.png");
    assert!(found("d1/A.jpg", Some("d2/A.jpg")).is_ok());
    assert!(found("d2/A.jpg", Some("d1/A.jpg")).is_ok());
    assert!(found("d3/A.jpg", Some("d1/A.jpg")).is_err());
}

/// Two cards, with a folder of masks for each: every photo takes those of its own folder, and one whose folder has none is of none.
#[test]
fn photos_of_one_name_take_the_outlines_of_their_own_folder() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, number| write_labels(&folder.path().join(name), number);
    write("100MEDIA/DJI_0001_labels.png", 1);
    write("101MEDIA/DJI_0001_labels.png", 2);
    write("100MEDIA/DJI_0002_labels.png", 3);
    let photos = [
        "DCIM/100MEDIA/DJI_0001.JPG",
        "DCIM/101MEDIA/DJI_0001.JPG",
        "DCIM/100MEDIA/DJI_0002.JPG",
        "DCIM/101MEDIA/DJI_0002.JPG",
    ];
    let number = |photo: &str| {
        let found = of_photo(folder.path(), photo, &photos).unwrap();
        assert!(
            !found
                .notes
                .iter()
                .any(|note| note.contains("is taken, not"))
        );
        found.labels.labels[5]
    };
    assert_eq!([0, 1, 2].map(|at| number(photos[at])), [1, 2, 3]);
    let open = || OutlinesOfOthers::open(folder.path(), None).unwrap();
    let is_of = photos.map(|photo| open().is_of(photo, &photos));
    assert_eq!(is_of, [true, true, true, false]);
    let fault = of_photo(folder.path(), photos[3], &photos).unwrap_err();
    assert!(
        fault.what.starts_with("there are no outlines of it"),
        "{fault}"
    );
    // A photo beside the folders has the file beside them.
    write("DJI_0001_labels.png", 4);
    let beside = ["DJI_0001.JPG", photos[0]];
    let found = of_photo(folder.path(), "DJI_0001.JPG", &beside).unwrap();
    assert_eq!(found.labels.labels[5], 4);
    let found = of_photo(folder.path(), photos[0], &beside).unwrap();
    assert_eq!(found.labels.labels[5], 1);
    // What cannot be both, and what is of none, is named with its folder.
    write("100MEDIA/DJI_0001_mask.png", 5);
    write("102MEDIA/DJI_0009_labels.png", 6);
    let notes = of_photo(folder.path(), photos[0], &photos).unwrap().notes;
    let taken = "100MEDIA/DJI_0001_labels.png is taken, not 100MEDIA/DJI_0001_mask.png";
    assert!(notes.iter().any(|note| note == taken), "{notes:?}");
    let of_none = open().of_no_photo(&photos);
    assert_eq!(of_none, ["102MEDIA/DJI_0009_labels.png"]);
}

/// So do files of many photos that name them without their folders, or lie in no folder and name them with it.
#[test]
fn files_of_many_photos_are_of_their_folder() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, photo: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let text = format!(
            r#"{{"images": [{{"id": 1, "file_name": "{photo}", "width": 4, "height": 4}}], "categories": [], "annotations": []}}"#
        );
        fs::write(path, text).unwrap();
    };
    let photos = ["100MEDIA/A.JPG", "101MEDIA/A.JPG", "102MEDIA/A.JPG"];
    let is_of = || {
        let others = OutlinesOfOthers::open(folder.path(), None).unwrap();
        photos.map(|photo| others.is_of(photo, &photos))
    };
    write("all.json", photos[0]);
    assert_eq!(is_of(), [true, false, false]);
    write("101MEDIA/of_card.json", "A.JPG");
    assert_eq!(is_of(), [true, true, false]);
    assert!(of_photo(folder.path(), photos[0], &photos).is_ok());
    assert!(of_photo(folder.path(), photos[1], &photos).is_ok());
    assert!(of_photo(folder.path(), photos[2], &photos).is_err());
    // A file of its own, given by itself.
    let card = OutlinesOfOthers::open(&folder.path().join("101MEDIA/of_card.json"), None).unwrap();
    assert_eq!(
        photos.map(|photo| card.is_of(photo, &photos)),
        [false, true, false]
    );
}

/// `a_IMG` is how fragscale calls `a/IMG.jpg`, where no other photo is called so, and no file lies in `a`.
#[test]
fn a_photos_whole_name_goes_before_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, number| write_labels(&folder.path().join(name), number);
    let number = |photo: &str, photos: &[&str]| {
        let found = of_photo(folder.path(), photo, photos).unwrap();
        found.labels.labels[5]
    };
    write("a_IMG_labels.png", 1);
    let both = ["a/IMG.jpg", "a_IMG.jpg"];
    assert_eq!(number("a/IMG.jpg", &["a/IMG.jpg", "b/IMG.jpg"]), 1);
    assert_eq!(number("a_IMG.jpg", &both), 1);
    let others = OutlinesOfOthers::open(folder.path(), None).unwrap();
    assert_eq!(both.map(|photo| others.is_of(photo, &both)), [false, true]);
    // Given by itself for the other photo: that is said.
    let file = folder.path().join("a_IMG_labels.png");
    let file = OutlinesOfOthers::open(&file, None).unwrap();
    let said = both.map(|photo| file.named_for_another(photo, &both));
    let of_other = |said: &String| said.ends_with("is named as the outlines of a_IMG.jpg");
    assert!(said[0].as_ref().is_some_and(of_other), "{said:?}");
    assert_eq!(said[1], None);
    write("a/IMG_labels.png", 2);
    assert_eq!(both.map(|photo| number(photo, &both)), [2, 1]);
    assert_eq!(number("a/IMG.jpg", &["a/IMG.jpg", "b/IMG.jpg"]), 2);
}

/// As `fragscale delineate --also coco,cvat` writes them: beside label images these are read, and alone they are.
#[test]
fn fragscales_own_files_of_all_photos_are_read_where_they_are_alone() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write(
        "fragments_coco.json",
        r#"{"images": [{"id": 1, "file_name": "A.jpg", "width": 4, "height": 4}],
            "categories": [{"id": 1, "name": "fragment"}], "annotations": [
            {"id": 1, "image_id": 1, "category_id": 1, "segmentation": [[1, 1, 3, 1, 3, 3, 1, 3]], "iscrowd": 0}]}"#,
    );
    write("A_outlines.png", "outlines over the photo");
    write("sizes.csv", "sizes");
    let found = || of_photo(folder.path(), "A.jpg", &["A.jpg"]);
    assert_eq!(found().unwrap().labels.labels[5], 1);
    // Both say the same: one is taken, and that is said.
    write(
        "fragments_cvat.xml",
        r#"<annotations><image id="0" name="A.jpg" width="4" height="4"></image></annotations>"#,
    );
    let masks = found().unwrap();
    assert_eq!(masks.labels.labels[5], 1);
    let taken = "fragments_coco.json is taken, not fragments_cvat.xml";
    assert!(
        masks.notes.iter().any(|note| note == taken),
        "{:?}",
        masks.notes
    );
    write_labels(&folder.path().join("A_labels.png"), 7);
    assert_eq!(found().unwrap().labels.labels[5], 7);
    fs::remove_file(folder.path().join("A_labels.png")).unwrap();
    write("fragments_coco.json", "{");
    assert!(OutlinesOfOthers::open(folder.path(), None).is_err());
}

/// A photo of 6 by 4 that viewers turn: outlined in one that turns it, its outlines are of 4 by 6.
#[test]
fn outlines_of_a_photo_on_its_side_are_turned_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut camera = camera(6, 4);
    let path = folder.path().join("A_labels.png");
    // The stored pixel (1, 0) is shown at the top right, one down.
    let mut image = image::GrayImage::new(4, 6);
    image.put_pixel(3, 1, image::Luma([7]));
    image.save(&path).unwrap();
    let others = OutlinesOfOthers::open(folder.path(), None).unwrap();
    let found = others
        .of_photo("A.jpg", &["A.jpg"], (&camera, 6), false)
        .unwrap();
    assert_eq!(found.labels.labels[1], 7);
    assert!(found.notes.iter().any(|note| note.contains("turned back")));
    assert!(
        others
            .of_photo("A.jpg", &["A.jpg"], (&camera, 3), false)
            .is_err()
    );
    // Of its own size nobody knows, which is said.
    (camera.width, camera.height) = (4, 6);
    let found = others
        .of_photo("A.jpg", &["A.jpg"], (&camera, 3), false)
        .unwrap();
    let asked = "look at them over the photo";
    assert!(
        found.notes.iter().any(|note| note.contains(asked)),
        "{:?}",
        found.notes
    );
    let plain = others
        .of_photo("A.jpg", &["A.jpg"], (&camera, 1), false)
        .unwrap();
    assert!(!plain.notes.iter().any(|note| note.contains("viewers")));
}

/// As a file of many photos that has none of this one: what LabelMe says of its photo counts, letter case, ending and folder do not.
#[test]
fn a_file_that_names_another_photo_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stones.json");
    let read = |stated: &str, name: &str| {
        let text = format!(
            r#"{{"shapes": [{{"label": "rock", "points": [[1, 1], [3, 1], [3, 3], [1, 3]]}}],
            "imagePath": "{stated}", "imageHeight": 4, "imageWidth": 4}}"#
        );
        fs::write(&path, text).unwrap();
        let others = OutlinesOfOthers::open(&path, None).unwrap();
        others.of_photo(name, &["IMG_0001.jpg", name], (&camera(4, 4), 1), true)
    };
    for own in ["IMG_0003.jpg", "../photos/img_0003.PNG", ""] {
        let masks = read(own, "IMG_0003.jpg").unwrap();
        assert_eq!(masks.labels.labels[5], 1, "{own}");
    }
    // As fragscale exports a photo of a folder.
    assert!(read("d1_A.jpg", "d1/A.jpg").is_ok());
    let fault = read("IMG_0001.jpg", "IMG_0003.jpg").unwrap_err();
    let words = "stones.json: it has no outlines of IMG_0003.jpg, but of IMG_0001.jpg";
    assert!(fault.what.ends_with(words), "{fault}");
    assert!(read("d2_A.jpg", "d1/A.jpg").is_err());
}

/// A mask of background alone is no outlines of the only photo that is asked for; among many photos one may have none.
#[test]
fn outlines_without_a_fragment_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("A_mask.png");
    write_labels(&path, 0);
    let found = |from: &Path, is_only| {
        let others = OutlinesOfOthers::open(from, None).unwrap();
        others.of_photo("A.jpg", &["A.jpg"], (&camera(4, 4), 1), is_only)
    };
    let fault = found(folder.path(), true).unwrap_err();
    let words = "A_mask.png: no fragment of A.jpg is outlined in it, only fines or background";
    assert!(fault.what.ends_with(words), "{fault}");
    assert!(found(folder.path(), false).is_ok());
    let many = folder.path().join("coco.json");
    let images = r#"[{"id":1,"file_name":"A.jpg","width":4,"height":4}]"#;
    let text = format!(r#"{{"images":{images},"categories":[],"annotations":[]}}"#);
    fs::write(&many, text).unwrap();
    assert!(found(&many, false).is_ok());
    let fault = found(&many, true).unwrap_err();
    assert!(fault.what.contains("only fines or background"), "{fault}");
}

//! COCO, LabelMe, CVAT and GeoJSON, whose pixels are what pycocotools 2.0.11 says, or counted by hand.

use image::GrayImage;

use super::{PHOTO, of_bytes, png};
use crate::fault::Fault;
use crate::labels::NOT_ROCK;
use crate::masks::{MaskFile, Masks, OutlinedPhoto};

/// `pycocotools.mask.encode` of [0 1 1 0], [0 1 0 0], [0 0 0 1] gives the text; the counts go column by column.
const PACKED: &str = r#"{"size":[3,4],"counts":"321O30"}"#;
const PLAIN: &str = r#"{"size":[3,4],"counts":[3,2,1,1,4,1]}"#;
const REGION: [u32; 12] = [0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1];

fn coco(annotations: &str) -> String {
    format!(
        "{{\"images\":[{{\"id\":7,\"file_name\":\"day 1/IMG_0005.JPG\",\"width\":4,\"height\":3}}],\"categories\":[{{\"id\":1,\"name\":\"rock\"}},{{\"id\":2,\"name\":\"Not-Rock\"}},{{\"id\":3,\"name\":\"sand\"}}],\"annotations\":[{annotations}]}}"
    )
}

fn annotation(category: u32, segmentation: &str) -> String {
    format!(
        "{{\"id\":5,\"image_id\":7,\"category_id\":{category},\"segmentation\":{segmentation},\"iscrowd\":0}}"
    )
}

fn labels(text: &str) -> [u32; 12] {
    of(text).labels.labels.try_into().unwrap()
}

fn of(text: &str) -> Masks {
    of_bytes(text.as_bytes()).unwrap()
}

#[test]
fn runs_of_coco_are_read() {
    for runs in [PACKED, PLAIN] {
        let masks = of(&coco(&annotation(1, runs)));
        assert_eq!(masks.labels.labels, REGION);
        assert!(masks.notes.is_empty(), "{:?}", masks.notes);
        assert_eq!(
            labels(&coco(&annotation(2, runs))),
            REGION.map(|n| n * NOT_ROCK)
        );
    }
    // Of random pixels and a block with a hole, with counts of several digits: `encode` of numpy's default_rng(3).
    const LARGE: &str = r"01100011OO10O2002N10M011OO020N20O000O0011OO30N001OO012;ND1030L001001O14NL030M10O030M110O00O0001020M80H02200N20L11OO0010142LN0O002O05NL032M00N26NLO00N1020O0d04[OMc00^O1c0O[O00Oe00[O50Ke01[OO00643MHOO2525LF00020246LF3713LF031135LH12O`00]O6f0K[O0f0O[O0O0b06]OKf01ZON00c01^OOO0h00XO10Oe02]ONO0b06^OJc01^O2d0NZOO01d0O^O1OOc01\\O11Nj01IO^O0O4OL120OO0140N1MN10O0000031NO00O16OJ1015NL0O020N050K62JO152KMO0123OL";
    const COLUMNS: [usize; 30] = [
        378, 357, 398, 415, 240, 606, 602, 641, 680, 604, 609, 564, 515, 526, 608, 685, 679, 680,
        643, 755, 641, 663, 664, 605, 612, 437, 333, 326, 384, 363,
    ];
    // As no rock: it reaches all edges.
    let text = coco(&annotation(
        2,
        &format!("{{\"size\":[30,40],\"counts\":\"{LARGE}\"}}"),
    ));
    let text = text.replace("\"width\":4,\"height\":3", "\"width\":40,\"height\":30");
    let photo = OutlinedPhoto {
        width: 40,
        height: 30,
        ..PHOTO
    };
    let masks = MaskFile::from_bytes(text.into_bytes())
        .unwrap()
        .of_photo(&photo)
        .unwrap();
    let inside = |row: &[u32]| -> Vec<usize> {
        let inside = row
            .iter()
            .enumerate()
            .filter(|(_, label)| **label == NOT_ROCK);
        inside.map(|(x, _)| x).collect()
    };
    assert_eq!(inside(&masks.labels.labels).len(), 807);
    let row = |row: &[u32]| inside(row).into_iter().sum::<usize>();
    let sums: Vec<usize> = masks.labels.labels.chunks(40).map(row).collect();
    assert_eq!(sums, COLUMNS);
}

/// `frPyObjects` fills the second polygon alike: its sides go through middles of pixels, of which the left and upper count
/// here; of slanting sides pycocotools takes other pixels of the border.
#[test]
fn polygons_of_coco_are_filled_at_middles() {
    let square = annotation(1, "[[1,0,3,0,3,2,1,2]]");
    assert_eq!(labels(&coco(&square)), [0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0]);
    // Two parts of one fragment, then sand on it, then a triangle about one middle.
    let parts = annotation(1, "[[0,0,1,0,1,3,0,3],[3,0,4,0,4,3,3,3]]");
    let sand = annotation(3, "[[0,1,1,1,1,2,0,2]]");
    let triangle = annotation(1, "[[1.2,1.2,1.9,1.2,1.2,1.9]]");
    let masks = of(&coco(&[parts, sand, triangle].join(",")));
    assert_eq!(masks.labels.labels, [1, 0, 0, 1, 0, 2, 0, 1, 1, 0, 0, 1]);
    assert_eq!(
        masks.notes,
        ["1 pixels lie in more than one outline, and belong to the smallest"]
    );
}

/// The smaller lies on top, whichever comes first.
#[test]
fn small_stones_lie_on_large_ones() {
    let large = annotation(1, "[[0,0,3,0,3,3,0,3]]");
    let small = annotation(1, "[[1,1,3,1,3,2,1,2]]");
    assert_eq!(
        labels(&coco(&format!("{large},{small}"))),
        [1, 1, 1, 0, 1, 2, 2, 0, 1, 1, 1, 0]
    );
    assert_eq!(
        labels(&coco(&format!("{small},{large}"))),
        [2, 2, 2, 0, 2, 1, 1, 0, 2, 2, 2, 0]
    );
    // What is about all of the photo is no stone.
    let all = annotation(1, "[[0,0,4,0,4,3,0,3]]");
    let masks = of(&coco(&format!("{small},{all}")));
    assert_eq!(masks.labels.labels, [0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0]);
    assert_eq!(
        masks.notes[1],
        "fragment 2 reaches all four edges of the photo, over 83 % of it: it is taken for what lies between the others, and for none"
    );
    let masks = of(&coco(&format!("{small},{small}")));
    assert_eq!(
        masks.notes[1],
        "an outline is hidden below smaller ones and left out (annotation 5)"
    );
}

/// A class that may be none of rock is named; what is known for none is none.
#[test]
fn odd_classes_of_fragments_are_said() {
    let square = annotation(1, "[[1,0,3,0,3,2,1,2]]");
    let of_class = |class: &str| of(&coco(&square).replace("\"rock\"", &format!("\"{class}\"")));
    for class in ["rock", "Stones", "boulder 12", "Fragment_3", ""] {
        let masks = of_class(class);
        assert!(masks.notes.is_empty(), "{class}: {:?}", masks.notes);
        assert_eq!(masks.labels.fragments(), 1, "{class}");
    }
    let masks = of_class("floor");
    assert_eq!(masks.labels.fragments(), 1);
    assert_eq!(
        masks.notes,
        [
            "outlines of the class floor are taken for fragments: call what is no rock 'not rock', what is fine 'fines'"
        ]
    );
    for class in ["Grass", "people", "excavator", "Scale bar", "bg"] {
        assert_eq!(of_class(class).labels.labels[1], NOT_ROCK, "{class}");
    }
    // Maps write their keys in capitals.
    let feature = r#"{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"Class": "Fines"},
        "geometry": {"type": "Polygon", "coordinates": [[[1, 0], [3, 0], [3, 2], [1, 2], [1, 0]]]}}]}"#;
    assert_eq!(of(feature).labels.fragments(), 0);
}

#[test]
fn what_is_mended_or_left_out_is_said() {
    let square = "[[1,0,3,0,3,2,1,2]]";
    for (segmentation, note) in [
        (
            "[[1,1,2,2]]",
            "an outline of fewer than 3 corners is left out (annotation 5)",
        ),
        (
            "[[1,1,2,2,3]]",
            "an outline whose numbers are no pairs is left out (annotation 5)",
        ),
        (
            "[]",
            "an outline of fewer than 3 corners is left out (annotation 5)",
        ),
        (
            "null",
            "an annotation without an outline is left out (annotation 5)",
        ),
        (
            "[[9,9,12,9,12,12]]",
            "an outline outside the photo is left out (annotation 5)",
        ),
        (
            "[[0.6,0.6,0.9,0.6,0.9,0.9]]",
            "an outline that covers no pixel's middle is left out (annotation 5)",
        ),
        (
            "[[2,1,9,1,9,2,2,2]]",
            "an outline reaches beyond the photo and is cut at its edge (annotation 5)",
        ),
        (
            "[[0,0,4,3,4,0,0,3]]",
            "an outline crosses itself: what it goes about an odd number of times is taken (annotation 5)",
        ),
        (
            r#"{"size":[3,4],"counts":[3,2]}"#,
            "an outline whose runs are damaged is left out (annotation 5)",
        ),
        (
            r#"{"size":[3,4],"counts":"3~"}"#,
            "an outline whose runs are damaged is left out (annotation 5)",
        ),
        (
            r#"{"size":[1,4000000000],"counts":[0,4000000000]}"#,
            "an outline whose runs are larger than the photo is left out (annotation 5)",
        ),
    ] {
        let masks = of(&coco(&format!(
            "{},{}",
            annotation(1, square),
            annotation(1, segmentation)
        )));
        assert!(
            masks.notes.iter().any(|said| said == note),
            "{segmentation}: {:?}",
            masks.notes
        );
    }
    let crowd = annotation(1, PLAIN).replace("\"iscrowd\":0", "\"iscrowd\":1");
    assert_eq!(labels(&coco(&crowd)), REGION);
    let masks = of(&coco(&format!(
        "{crowd},{}",
        annotation(1, "[[0,2,1,2,1,3,0,3]]")
    )));
    assert_eq!(masks.labels.labels[8..], [1, 0, 0, NOT_ROCK]);
    assert_eq!(
        masks.notes,
        ["a region of many things (iscrowd) is left out of the rock (annotation 5)"]
    );
    let found = annotation(1, PLAIN).replace("\"iscrowd\":0", "\"score\":0.31");
    assert_eq!(
        of(&coco(&found)).notes,
        ["its outlines have scores, the least is 0.31: all are taken, leave out which are none"]
    );
}

fn refused(text: &str) -> Fault {
    of_bytes(text.as_bytes()).unwrap_err()
}

#[test]
fn photos_are_chosen_by_their_names() {
    let file = coco(&annotation(1, PLAIN));
    let file = MaskFile::from_bytes(file.into_bytes()).unwrap();
    assert_eq!(file.photos().collect::<Vec<_>>(), ["day 1/IMG_0005.JPG"]);
    assert!(!file.is_of_one() && !file.is_own());
    let other = OutlinedPhoto {
        name: "IMG_0006.jpg",
        ..PHOTO
    };
    assert_eq!(
        file.of_photo(&other).unwrap_err().what,
        "it has no outlines of IMG_0006.jpg, but of day 1/IMG_0005.JPG"
    );
    let twice = r#"{"images":[{"id":1,"file_name":"a\\IMG_0005.jpg"},{"id":2,"file_name":"b/IMG_0005.jpg"}],"annotations":[]}"#;
    assert_eq!(
        refused(twice).what,
        "IMG_0005.jpg may be a\\IMG_0005.jpg or b/IMG_0005.jpg in it"
    );
    let larger = coco("").replace("\"width\":4", "\"width\":8");
    assert_eq!(
        refused(&larger).what,
        "its outlines are of 8 x 3 pixels, the photo IMG_0005.jpg is of 4 x 3"
    );
    let away = coco(&annotation(1, "[[400,400,500,400,500,500]]"));
    assert_eq!(
        refused(&away).what,
        "none of its 1 outlines covers a pixel of the photo IMG_0005.jpg"
    );
}

#[test]
fn a_geometry_alone_is_no_list() {
    let geometry = r#"{"type": "Polygon", "coordinates": [[[1, 0], [3, 0], [3, 2]]]}"#;
    let feature = format!(r#"{{"type": "Feature", "properties": {{}}, "geometry": {geometry}}}"#);
    for text in [geometry, &feature] {
        let fault = refused(text);
        assert!(fault.what.contains("in no list of features"), "{fault}");
    }
}

#[test]
fn what_is_no_file_of_outlines_is_said() {
    let cut = coco(&annotation(1, PLAIN));
    let cut = &cut[..cut.len() - 5];
    for (text, what) in [
        ("{}", "it is JSON without outlines"),
        (
            "[{\"image_id\":1}]",
            "it is a list of JSON, without the images that its outlines are of",
        ),
        ("{\"images\":[]}", "it is COCO without \"annotations\""),
        ("<kml/>", "XML that begins with <kml> is not CVAT's"),
        (
            "<annotations><track/></annotations>",
            "it is CVAT for video",
        ),
        ("PK\u{3}\u{4}", "it is a zip"),
        (cut, "EOF while parsing an object"),
        (
            "{\"features\":[],\"crs\":{\"properties\":{\"name\":\"EPSG:4326\"}}}",
            "its coordinates are in EPSG:4326, on the Earth",
        ),
    ] {
        let fault = refused(text);
        assert_eq!(fault.what, what);
        assert!(!fault.remedy.is_empty());
    }
}

#[test]
fn shapes_of_labelme_are_read() {
    // A PNG of [1 0], [1 1] for the mask.
    let mask = png(GrayImage::from_raw(2, 2, vec![1, 0, 1, 1]).unwrap());
    let text = format!(
        r#"{{"version":"5.4.1","flags":{{}},"shapes":[
        {{"label":"rock","points":[[0.0,0.0],[1.0,0.0],[1.0,1.0],[0.0,1.0]],"group_id":4,"shape_type":"polygon","flags":{{}}}},
        {{"label":"rock","points":[[0.0,2.0],[1.0,3.0]],"group_id":4,"shape_type":"rectangle"}},
        {{"label":"rock","points":[[3.5,0.5],[3.9,0.5]],"group_id":null,"shape_type":"circle"}},
        {{"label":"Background","points":[[2.0,1.0],[3.0,2.0]],"shape_type":"mask","mask":"{}"}},
        {{"label":"rock","points":[[2.0,1.0],[3.0,2.0]],"shape_type":"line"}}],
        "imagePath":"..\\photos\\IMG_0005.jpg","imageData":"AAAA","imageHeight":3,"imageWidth":4}}"#,
        base64(&mask)
    );
    let masks = of(&text);
    assert_eq!(
        masks.labels.labels,
        [1, 0, 0, 2, 0, 0, NOT_ROCK, 0, 1, 0, NOT_ROCK, NOT_ROCK]
    );
    assert_eq!(
        masks.notes,
        ["a line outlines nothing and is left out (shape 5)"]
    );
    let renamed = of(&text.replace("IMG_0005", "IMG_0001"));
    assert_eq!(
        renamed.notes[1],
        "it says that its outlines are of ..\\photos\\IMG_0001.jpg, not of IMG_0005.jpg"
    );
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let letters = |three: &[u8]| {
        let bits = three
            .iter()
            .fold(0_u32, |bits, byte| bits << 8 | u32::from(*byte))
            << (8 * (3 - three.len()));
        let letter = |at: usize| char::from(LETTERS[(bits >> (18 - 6 * at)) as usize & 63]);
        (0..=three.len()).map(letter).collect::<String>()
    };
    bytes.chunks(3).map(letters).collect()
}

/// As CVAT 2 dumps a task; its runs begin with what is outside.
#[test]
fn shapes_of_cvat_are_read() {
    let text = r#"<?xml version="1.0" encoding="utf-8"?>
<annotations>
  <version>1.1</version>
  <meta><job><id>1</id></job></meta>
  <image id="0" name="IMG_0004.jpg" width="8" height="6"/>
  <image id="1" name="photos/IMG_0005.jpg" width="4" height="3">
    <polygon label="rock" source="manual" occluded="0" points="0.00,0.00;1.00,0.00;1.00,1.00;0.00,1.00" z_order="0"/>
    <box label="rock" occluded="0" xtl="3.0" ytl="0.0" xbr="4.0" ybr="1.0" z_order="0" group_id="9"></box>
    <box label="rock" occluded="0" xtl="3.0" ytl="0.0" xbr="4.0" ybr="3.0" z_order="0" group_id="9"></box>
    <mask label="sky" source="manual" occluded="0" rle="1, 1, 1, 2" left="1" top="1" width="2" height="2" z_order="0"/>
    <ellipse label="rock" cx="0.5" cy="2.5" rx="0.2" ry="0.4" z_order="0"/>
    <polyline label="rock" points="0,0;1,1" z_order="0"/>
    <mask label="rock" rle="1, 1" left="1" top="1" width="2" height="2" z_order="0"/>
  </image>
</annotations>"#;
    // 1, 1, 1, 2 is one more than a box of 2 x 2 has.
    let masks = of(&text.replace("1, 1, 1, 2", "1, 1, 1, 1"));
    assert_eq!(
        masks.labels.labels,
        [1, 0, 0, 2, 0, 0, NOT_ROCK, 2, 3, 0, NOT_ROCK, 2]
    );
    assert_eq!(
        masks.notes,
        [
            "a polyline outlines nothing and is left out (line 12)",
            "an outline whose runs are damaged is left out (line 13)"
        ]
    );
    assert_eq!(
        of(text).notes[0],
        "an outline whose runs are damaged is left out (2 times, first at line 10)"
    );
    let bad = refused(&text.replace("1.00,1.00", "1.00;1.00"));
    assert_eq!(
        (bad.line, bad.what.as_str()),
        (Some(7), "'1.00' is no corner of a polygon")
    );
    let far = refused(&text.replace("xtl=\"3.0\"", "xtl=\"inf\""));
    assert_eq!(far.what, "xtl='inf' is no number");
}

/// As CVAT on a Mac exports it, for photos whose list of poses is from elsewhere.
#[test]
fn accents_apart_are_the_same_letters() {
    let text = coco(&annotation(1, PLAIN)).replace("IMG_0005", "Bo\u{308}schung_5");
    let file = MaskFile::from_bytes(text.into_bytes()).unwrap();
    for (name, is_it) in [
        ("a/B\u{f6}schung_5.JPG", true),
        ("B\u{f6}schung_5.png", true),
        ("Boschung_5.JPG", false),
    ] {
        let masks = file.of_photo(&OutlinedPhoto { name, ..PHOTO });
        assert_eq!(masks.is_ok(), is_it, "{name}");
    }
}

fn geojson(geometry: &str) -> String {
    format!(
        "{{\"type\":\"FeatureCollection\",\"features\":[{{\"type\":\"Feature\",\"geometry\":{geometry},\"properties\":{{}}}}]}}"
    )
}

#[test]
fn geojson_in_pixels_is_read() {
    let hole = r#"{"type":"Polygon","coordinates":[[[0,0],[3,0],[3,3],[0,3],[0,0]],[[1,1],[2,1],[2,2],[1,2],[1,1]]]}"#;
    let ring = [1, 1, 1, 0, 1, 0, 1, 0, 1, 1, 1, 0];
    assert_eq!(labels(&geojson(hole)), ring);
    let named = geojson(hole).replace("{}", r#"{"classification":{"name":"Fines"}}"#);
    assert_eq!(labels(&named), [0; 12]);
    let several = r#"{"type":"MultiPolygon","coordinates":[[[[0,0],[1,0,5],[1,1],[0,1]]],[[[3,2],[4,2],[4,3],[3,3]]]]}"#;
    assert_eq!(
        labels(&geojson(several)),
        [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]
    );
    let point = geojson(r#"{"type":"Point","coordinates":[1,1]}"#);
    assert_eq!(
        of(&point).notes[0],
        "a Point outlines nothing and is left out (feature 1)"
    );
}

/// What segmenteverygrain's `save_polygons` writes of the pixels (1, 0), (2, 0), (1, 1), (2, 1):
/// `skimage.measure.find_contours(mask, 0.5)`, whose corners lie between middles of pixels.
#[test]
fn contours_of_segmenteverygrain_are_moved() {
    let contour = r#"{"type":"Polygon","coordinates":[[[2.0,1.5],[1.0,1.5],[0.5,1.0],[0.5,0.0],[1.0,-0.5],[2.0,-0.5],[2.5,0.0],[2.5,1.0],[2.0,1.5]]]}"#;
    let masks = of(&geojson(contour));
    assert_eq!(masks.labels.labels, [0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0]);
    assert_eq!(
        masks.notes,
        [
            "its corners count from the middle of the first pixel (as segmenteverygrain's do): they are moved by half a pixel"
        ]
    );
    // QGIS over a photo that lies nowhere.
    let up = r#"{"type":"Polygon","coordinates":[[[1,0],[3,0],[3,-2],[1,-2],[1,0]]]}"#;
    let masks = of(&geojson(up));
    assert_eq!(masks.labels.labels, [0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0]);
    assert_eq!(
        masks.notes,
        ["rows are counted upwards in it: they are turned"]
    );
}

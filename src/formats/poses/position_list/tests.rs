use proptest::prelude::*;

use glam::DVec2;

use super::*;
use fragscale_test_data::shared_data;

fn positions(text: &str) -> PositionList {
    positions_from_text(text).unwrap()
}

fn points(text: &str) -> ControlPoints {
    control_points_from_text(text).unwrap()
}

fn at(line: u64, list: Result<PositionList, Fault>) -> String {
    let fault = list.unwrap_err();
    assert_eq!(fault.line, Some(line), "{fault}");
    fault.what
}

#[test]
fn a_table_finds_its_columns_by_name() {
    let list = positions(
        "Label,Y/Northing,X/Easting,Z/Altitude,Accuracy Horizontal,Accuracy Vertical\n\
         a.jpg,4.5,3.25,100,0.02,0.05\n\"b, c.jpg\",5,4,101,,\n",
    );
    assert_eq!(list.crs, None);
    assert_eq!(list.positions[0].name, "a.jpg");
    assert_eq!(list.positions[0].position, DVec3::new(3.25, 4.5, 100.0));
    let accuracy = DVec3::new(0.02, 0.02, 0.05);
    assert_eq!(list.positions[0].accuracy, Some(accuracy));
    assert_eq!(list.positions[1].name, "b, c.jpg");
    assert_eq!(list.positions[1].accuracy, None);
    // Whether that matters, whoever takes the list says: `--crs` may name it.
    assert_eq!((&list.crs, list.warnings.len()), (&None, 0));
}

/// Feet behind x are refused, whatever they would come to; a height beside degrees is in metres.
#[test]
fn units_in_the_names_count() {
    for names in [
        "photo,x (ft),y (ft),z (ft)",
        "photo,easting [m],northing [m],height [feet]",
        "photo,x (mm),y (mm),z (mm)",
    ] {
        let what = at(1, positions_from_text(&format!("{names}\na.jpg,1,2,3\n")));
        assert!(what.starts_with("its columns say "), "{what}");
    }
    // An accuracy has its own: a foot is not taken for a metre, nor 15 mm for 15 m.
    let list = positions("photo,x (m),y (m),z [m],accuracy (ft)\na.jpg,1,2,3,1\n");
    assert_eq!(list.positions[0].position, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(list.positions[0].accuracy, Some(DVec3::splat(0.3048)));
    assert_eq!(
        list.warnings,
        ["the list's accuracies are in ft, and are brought to metres"]
    );
    let list = positions("photo,x,y,z,accuracy xy (mm),accuracy z (mm)\na.jpg,1,2,3,15,30\n");
    assert_eq!(
        list.positions[0].accuracy,
        Some(DVec3::new(0.015, 0.015, 0.03))
    );
    let what = at(
        1,
        positions_from_text("photo,x,y,z,accuracy (ft)\na.jpg,1,2,3,1\n"),
    );
    assert!(what.starts_with("its columns say ft"), "{what}");
    let list = positions("photo,latitude,longitude,altitude (feet)\na.jpg,50,7,1000\n");
    assert_eq!(list.positions[0].position, DVec3::new(7.0, 50.0, 304.8));
    assert_eq!(
        list.warnings[0],
        "the list's heights are in ft, and are brought to metres"
    );
}

#[test]
fn decimal_commas_and_byte_order_marks_of_spreadsheets() {
    let text = "Name;Longitude;Latitude;Height\r\n1;16,5;47,25;460,125\r\n";
    let list = positions(text);
    assert_eq!(list.crs.as_deref(), Some("EPSG:4326"));
    assert_eq!(list.positions[0].position, DVec3::new(16.5, 47.25, 460.125));
}

#[test]
fn metashape_states_its_system_in_a_comment() {
    let list = positions(
        "# CoordinateSystem: PROJCS[\"WGS 84 / UTM zone 54N\",GEOGCS[\"WGS 84\"]]\n\
         #Label,X/Easting,Y/Northing,Z/Altitude,Error_(m),X_error,Y_error,Z_error,X_est,Y_est,Z_est\n\
         DJI_1.JPG,380000.5,3950000.25,80.125,0.1,0.1,0.0,0.0,380000.6,3950000.25,80.125\n\
         # Total Error\n",
    );
    assert!(
        list.crs
            .unwrap()
            .starts_with("PROJCS[\"WGS 84 / UTM zone 54N\"")
    );
    assert_eq!(
        list.positions,
        [NamedPosition {
            name: "DJI_1.JPG".to_owned(),
            position: DVec3::new(380000.5, 3950000.25, 80.125),
            accuracy: None,
            looks: None,
        }]
    );
}

#[test]
fn what_is_no_table_is_refused_with_its_line() {
    assert!(at(1, positions_from_text("DJI_1.JPG,47.1,16.2,300\n")).contains("no header"));
    let header = "photo,lon,lat,height\n";
    for (line, what) in [
        ("a.jpg,16,north,4", "Latitude is 'north'"),
        ("a.jpg,16,NaN,4", "not a finite"),
        ("a.jpg,16,1e999,4", "not a finite"),
        (",16,47,4", "no name"),
        ("a.jpg,,47,4", "no Longitude"),
        ("a.jpg,47,516,4", "beyond 180 or 90"),
    ] {
        let list = positions_from_text(&format!("{header}{line}\n"));
        assert!(at(2, list).contains(what), "{line}");
    }
    let twice = format!("{header}a.jpg,1,2,3\nb.jpg,1,2,3\na.jpg,1,2,3\n");
    let fault = positions_from_text(&twice).unwrap_err().to_string();
    assert!(
        fault.contains("'a.jpg' stands twice, as entry 1 and as entry 3"),
        "{fault}"
    );
    assert!(positions_from_text("").is_err());
    assert!(positions_from_text(header).is_err());
}

#[test]
fn opendronemap_geo_file() {
    // The example of OpenDroneMap's documentation, with accuracies on the second line.
    let list = positions(
        "EPSG:4326\nDJI_0028.JPG -91.9942096111111   46.84252125 198.609\n\
         DJI_0032.JPG\t-91.9938293055556\t46.8424584444444\t198.609\t10\t0\t0\t0.03\t0.05\n# end\n",
    );
    assert_eq!(list.crs.as_deref(), Some("EPSG:4326"));
    let first = DVec3::new(-91.9942096111111, 46.84252125, 198.609);
    assert_eq!(list.positions[0].position, first);
    assert_eq!(list.positions[0].accuracy, None);
    let accuracy = Some(DVec3::new(0.03, 0.03, 0.05));
    assert_eq!(list.positions[1].accuracy, accuracy);
    let utm = positions("WGS84 UTM 16N\na.jpg 400000 5000000\nb.jpg 400000 5000000 7\n");
    assert_eq!(utm.crs.as_deref(), Some("EPSG:32616"));
    // A height of 0 that nobody measured would tilt what is fitted to it.
    assert_eq!(utm.positions.len(), 1);
    assert_eq!(utm.positions[0].name, "b.jpg");
    assert_eq!(
        utm.warnings[0],
        "1 of 2 positions have no height and are left out"
    );
    let fault = positions_from_text("WGS84 UTM 16N\na.jpg 400000 5000000\n").unwrap_err();
    assert!(
        fault
            .to_string()
            .contains("none of its 1 positions has a height")
    );
    assert!(at(2, positions_from_text("EPSG:4326\na.jpg 1 b 3\n")).contains("y is 'b'"));
}

#[test]
fn control_points_with_and_without_names() {
    let list = points(
        "WGS84 UTM 17N\n1 2 3 100 200 a.jpg\n1 2 3 10.5 20 b.jpg \n4 5 6 7 8 my photo.jpg x\n",
    );
    assert_eq!(list.list.crs.as_deref(), Some("EPSG:32617"));
    assert_eq!(list.list.points[0].name, "point 1");
    // The first pixel's centre, integer there, is at 0.5 here.
    assert_eq!(
        list.list.points[0].marks,
        [
            ("a.jpg".to_owned(), DVec2::new(100.5, 200.5)),
            ("b.jpg".to_owned(), DVec2::new(11.0, 20.5))
        ]
    );
    assert_eq!(list.list.points[1].name, "x");
    assert_eq!(list.list.points[1].marks[0].0, "my photo.jpg");
    let tabs = points("EPSG:2180\n4\t5\t6\t7\t8\t\tmy photo.jpg\tgcp 1\n");
    assert_eq!(tabs.list.points[0].name, "gcp 1");
    assert_eq!(tabs.list.points[0].marks[0].0, "my photo.jpg");
    let heights = points("EPSG:32632+5773\n4 5 6 7 8 a.jpg\n");
    assert_eq!(heights.list.crs.as_deref(), Some("EPSG:32632+5773"));
    let degrees = control_points_from_text("EPSG:4326+5773\n200 5 6 7 8 a.jpg\n").unwrap_err();
    assert_eq!(degrees.line, Some(2), "{degrees}");
    let moved = points("EPSG:2180\n1 2 3 4 5 a.jpg p\n1 2 5 4 5 b.jpg p\n1 2 9 4 5 b.jpg q\n");
    assert!(moved.warnings[0].contains("'p' stands at places 2 apart"));
    assert!(moved.warnings[1].contains("'p' and 'q' have the same x and y"));
    let unmarked = points("EPSG:2180\np1 1 2 3\n2 1 2 4\n7 8 9\n");
    let names: Vec<&str> = unmarked
        .list
        .points
        .iter()
        .map(|p| p.name.as_str())
        .collect();
    assert_eq!(names, ["p1", "2", "point 3"]);
    let fault = control_points_from_text("EPSG:2180\n1 2 3 4 b.jpg\n").unwrap_err();
    assert_eq!(fault.line, Some(2));
    assert!(control_points_from_text("EPSG:2180\n").is_err());
}

/// As spreadsheets write them: commas to the end of the first line, too, and blanks behind them. A table of points whose columns look
/// like a mark's stays one.
#[test]
fn marks_between_commas() {
    let tabs =
        points("EPSG:2180\n4.5\t5\t6\t7\t8\tmy photo.jpg\tgcp 1\n4.5\t5\t6\t9\t8\tb.jpg\tgcp 1\n");
    let commas =
        points("EPSG:2180,,,,,,\n4.5,5,6,7,8,my photo.jpg,gcp 1\n4.5, 5, 6, 9, 8, b.jpg, gcp 1\n");
    assert_eq!(commas.list, tabs.list);
    let unmarked = points("EPSG:2180\np 1,1,2,3\n2,1,2,4\n");
    let names: Vec<&str> = (unmarked.list.points.iter().map(|p| p.name.as_str())).collect();
    assert_eq!(names, ["p 1", "2"]);
    let table = points("x,y,z,accuracy xy,accuracy z,name\n1,2,3,0.1,0.2,GCP1\n");
    assert_eq!(table.list.points[0].name, "GCP1");
}

/// A list that lost its first line is read whole, without a coordinate system; a cloud with colours is no such list.
#[test]
fn marks_without_a_line_of_the_coordinate_system() {
    let marks = "\n452272.3\t5411841.7\t315.6\t759.4\t280.1\tIMG_1.jpg\tP1\n\
        452313.0\t5411841.1\t315.5\t760.4\t287.7\tIMG_2.jpg\tP2\n";
    let bare = points(marks);
    let whole = points(&format!("local{marks}"));
    assert_eq!(bare.list, whole.list);
    assert_eq!((bare.list.points.len(), bare.list.crs), (2, None));
    // A first line that we do not know may be a system's name.
    let titled = control_points_from_text(&format!("easting northing height px py photo{marks}"));
    let titled = titled.unwrap_err();
    assert_eq!(titled.line, Some(1));
    assert!(
        titled
            .what
            .contains("'easting northing height px py photo', names no coordinate system")
    );
    let refused = control_points_from_text("1.5 2.5 3.5 200 100 50\n2.5 3.5 4.5 200 100 50\n");
    assert!(refused.is_err());
    assert!(
        positions_from_text(marks)
            .unwrap_err()
            .what
            .contains("marks of control points")
    );
}

#[test]
fn truncated_lists_end_in_words() {
    for text in [
        "EPSG:4326\n16.4\t47.6\t463.6\t2501.0\t2452.0\tMAX_0029.JPG\t1\n",
        "2\t296288.2\t[2211]\t 3,N\t 0,E\t 75,V\t47.6,Lat\t16.4,Lon\t512.9,Ellh\t0.01, 0.02, 0.03\t50,Q\n",
        "fileName\tlatitude\tlongitude\taltitude_wgs84\nIMG.JPG\t37.5\t139.0\t255.8\n",
        "a;lön\n",
    ] {
        for end in 0..text.len() {
            if let Some(part) = text.get(..end) {
                let _ = positions_from_text(part);
                let _ = control_points_from_text(part);
            }
        }
    }
}

proptest! {
    #[test]
    fn no_text_panics(
        first in "(EPSG:4326|name[,;\t]lat,lon|1 2.5 \\[7\\]|.{0,20})",
        rest in "([-0-9.,;\t\" a-zé#\n]{0,80})",
    ) {
        let text = format!("{first}\n{rest}");
        let _ = positions_from_text(&text);
        let _ = control_points_from_text(&text);
    }
}

#[test]
fn the_last_digits_number_a_photo() {
    for (name, number) in [
        ("DJI_0002.JPG", Some(2)),
        ("100_0005_0123.JPG", Some(123)),
        ("DJI_20230102030405_0042_V.JPG", Some(42)),
        ("MAX_0029.jpg", Some(29)),
        ("7", Some(7)),
        ("photo.jpg", None),
        ("é.jpg", None),
    ] {
        assert_eq!(mrk::number_of_photo(name), number, "{name}");
    }
}

#[test]
fn dji_mrk_of_helenenschacht() {
    let Some(path) = shared_data("gcp-lists/helenenschacht_Timestamp.mrk") else {
        return;
    };
    let list = read_positions(&path).unwrap();
    // Lines 1 and the last of the file, by eye.
    assert_eq!(list.crs.as_deref(), Some("EPSG:4326"));
    let first = &list.positions[0];
    assert_eq!(first.name, "2");
    assert_eq!(
        first.position,
        DVec3::new(16.4759271684, 47.6436873208, 512.998)
    );
    assert_eq!(
        first.accuracy,
        Some(DVec3::new(0.013698, 0.014391, 0.029694))
    );
    assert_eq!(list.positions.last().unwrap().name, "177");
    assert!(
        list.warnings.iter().all(|w| !w.contains("no fixed")),
        "{:?}",
        list.warnings
    );
}

#[test]
fn control_points_of_the_shared_lists() {
    let Some(folder) = shared_data("gcp-lists") else {
        return;
    };
    // File, system, points, marks: counted with sort and wc.
    for (file, crs, count, marks) in [
        ("helenenschacht_gcp_list.txt", "EPSG:4326", 5, 35),
        ("bellus_gcp_list.txt", "EPSG:32617", 4, 4),
        ("boruszyn_gcp_list.txt", "EPSG:2180", 7, 18),
        ("copr_gcp_list.txt", "EPSG:32611", 10, 27),
        ("copr_gcp_list_noimg.txt", "EPSG:4326", 10, 0),
        ("helenenschacht_latlon.csv", "EPSG:4326", 5, 0),
    ] {
        let list = read_control_points(&folder.join(file)).unwrap();
        assert_eq!(list.list.crs.as_deref(), Some(crs), "{file}");
        let all: usize = list.list.points.iter().map(|point| point.marks.len()).sum();
        assert_eq!(
            (list.list.points.len(), all),
            (count, marks),
            "{file} {:?}",
            list.warnings
        );
    }
    // Latitude and longitude alone.
    let flat = read_control_points(&folder.join("copr_GPS_average.txt")).unwrap_err();
    let said = flat.to_string();
    assert!(
        said.contains("none of its 10 positions has a height"),
        "{said}"
    );
    let list = read_positions(&folder.join("helenenschacht_latlon.csv")).unwrap();
    let expected = DVec3::new(16.47592207, 47.64350399, 463.662);
    assert_eq!(list.positions[0].position, expected);
}

#[test]
fn sensefly_geoinfo() {
    let Some(path) = shared_data("pix4d-p4d-snowpeak/snowpea1_geoinfo.txt") else {
        return;
    };
    let list = read_positions(&path).unwrap();
    assert_eq!(list.positions[0].name, "IMG_2166.JPG");
    let first = DVec3::new(139.0398406, 37.5448893, 255.8478698730);
    assert_eq!(list.positions[0].position, first);
    assert!(
        list.warnings
            .iter()
            .any(|w| w.contains("above the ellipsoid is taken"))
    );
}

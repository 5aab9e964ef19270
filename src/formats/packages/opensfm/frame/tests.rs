//! Lone files, made of six photos whose positions on the Earth were computed outside: east, north, up
//! through ECEF, UTM by Krueger's series to the fourth order.

use glam::{DMat2, DVec2, DVec3};

use crate::packages::opensfm::dataset::read_file;
use crate::packages::reconstruction::Reconstruction;

/// Where the receivers were, east, north and up at the reference.
const MEASURED: [[f64; 3]; 6] = [
    [-60.0, -45.0, 40.0],
    [0.0, -44.0, 41.0],
    [62.0, -46.0, 40.0],
    [58.0, 47.0, 42.0],
    [-2.0, 45.0, 40.0],
    [-61.0, 44.0, 39.0],
];

/// A reference in whole metres of UTM, and the same six photos in that zone less the offset.
struct Site {
    latitude: f64,
    longitude: f64,
    crs: &'static str,
    offset: [f64; 2],
    projected: [[f64; 3]; 6],
}

/// North with 2.4 degrees of convergence; south with 1.3; beside the date line, south, with -1.9; and
/// just over the border of its zone, because the first photo was on the other side.
const SITES: [Site; 4] = [
    Site {
        latitude: 60.20000079741062,
        longitude: 17.80000682720282,
        crs: "EPSG:32633",
        offset: [655_203.0, 6_676_977.0],
        projected: [
            [-58.0315, -47.4984, 40.0004],
            [1.8655, -43.9555, 41.0002],
            [63.8877, -43.3249, 40.0005],
            [55.9487, 49.4116, 42.0004],
            [-3.9059, 44.8697, 40.0002],
            [-62.8039, 41.3693, 39.0004],
        ],
    },
    Site {
        latitude: -29.899996184230883,
        longitude: -71.60000326910344,
        crs: "EPSG:32719",
        offset: [248_941.0, 6_689_455.0],
        projected: [
            [-58.9882, -46.3635, 40.0004],
            [0.9961, -44.0051, 41.0002],
            [63.0485, -44.6017, 40.0005],
            [56.9426, 48.3184, 42.0004],
            [-3.019, 44.9599, 40.0002],
            [-62.0032, 42.6241, 39.0004],
        ],
    },
    Site {
        latitude: -41.20000210310384,
        longitude: 179.9000045167315,
        crs: "EPSG:32760",
        offset: [743_170.0, 5_434_985.0],
        projected: [
            [-61.4871, -42.9878, 40.0004],
            [-1.4679, -43.9897, 41.0002],
            [60.4509, -48.0575, 40.0005],
            [59.5543, 45.0541, 42.0004],
            [-0.4983, 45.0561, 40.0002],
            [-59.5178, 46.0246, 39.0004],
        ],
    },
    Site {
        latitude: 47.09999703473344,
        longitude: 12.001998849793772,
        crs: "EPSG:32632",
        offset: [727_795.0, 5_220_650.0],
        projected: [
            [-58.2418, -47.2811, 40.0004],
            [1.6895, -43.9777, 41.0002],
            [63.7349, -43.5961, 40.0005],
            [56.166, 49.2033, 42.0004],
            [-3.7269, 44.9004, 40.0002],
            [-62.6586, 41.6355, 39.0004],
        ],
    },
];

/// In the middle of a zone: the readings differ by 0.04 %, which no scale shows.
const CENTRAL: Site = Site {
    latitude: 46.79999753362487,
    longitude: -92.99000115416314,
    crs: "EPSG:32615",
    offset: [500_763.0, 5_182_939.0],
    projected: [
        [-59.9699, -44.9893, 40.0004],
        [0.0056, -43.9821, 41.0002],
        [61.9807, -45.9734, 40.0005],
        [57.9704, 46.9883, 42.0004],
        [-2.0049, 44.9815, 40.0002],
        [-60.9808, 43.9744, 39.0004],
    ],
};

/// What the adjustment left between centres and positions: a receiver with corrections.
const CENTIMETRES: [[f64; 2]; 6] = [
    [0.02, -0.01],
    [-0.015, 0.02],
    [0.01, 0.01],
    [-0.02, -0.02],
    [0.0, 0.015],
    [0.012, -0.018],
];

fn plus(centers: &[[f64; 3]; 6], noise: f64) -> Vec<[f64; 3]> {
    let both = centers.iter().zip(CENTIMETRES);
    both.map(|([x, y, z], [dx, dy])| [x + noise * dx, y + noise * dy, *z])
        .collect()
}

/// The lone file in an empty folder, and what is read from it.
fn lone(site: &Site, centers: &[[f64; 3]], measured: bool) -> Reconstruction {
    named("model.json", site, centers, measured)
}

fn named(name: &str, site: &Site, centers: &[[f64; 3]], measured: bool) -> Reconstruction {
    let shots: Vec<String> = centers
        .iter()
        .zip(MEASURED)
        .enumerate()
        .map(|(i, ([x, y, z], [e, n, u]))| {
            // Half a turn about x looks down: t = -R c = (-x, y, z).
            let gps = if measured {
                format!(r#", "gps_position": [{e}, {n}, {u}], "gps_dop": 0.03"#)
            } else {
                String::new()
            };
            format!(
                r#""{i}.jpg": {{"camera": "c", "rotation": [3.141592653589793, 0, 0], "translation": [{}, {y}, {z}]{gps}}}"#,
                -x
            )
        })
        .collect();
    let json = format!(
        r#"[{{"cameras": {{"c": {{"focal": 0.8, "width": 400, "height": 300}}}}, "shots": {{{}}},
        "points": {{"0": {{"coordinates": [1, 2, 3], "color": [1, 2, 3]}}}},
        "reference_lla": {{"latitude": {}, "longitude": {}, "altitude": 0.0}}}}]"#,
        shots.join(", "),
        site.latitude,
        site.longitude
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, json).unwrap();
    read_file(&path).unwrap().reconstruction
}

/// Its only warning.
fn said(found: &Reconstruction) -> &str {
    let [warning] = &found.warnings[..] else {
        panic!("one warning: {:?}", found.warnings);
    };
    warning
}

fn assert_projected(found: &Reconstruction, site: &Site) {
    assert_eq!(found.crs.as_deref(), Some(site.crs));
    assert_eq!(found.enu_origin, None);
    let [east, north] = site.offset;
    assert!((found.cloud.points[0] - DVec3::new(east + 1.0, north + 2.0, 3.0)).length() < 1e-6);
    for (photo, [x, y, z]) in found.photos.iter().zip(site.projected) {
        let off = photo.pose.center - DVec3::new(east + x, north + y, z);
        assert!(off.length() < 0.05, "{off}");
    }
    // The receivers' positions stand, whatever the frame of the poses.
    assert_eq!(found.measured_positions.len(), 6);
    let first = found.measured_positions[0].position;
    assert!((first.height - 40.0004).abs() < 1e-3);
    let north = (first.latitude - site.latitude) * 111_200.0;
    assert!((north + 45.0).abs() < 0.5, "{north}");
}

#[test]
fn positions_to_centimetres_tell_projected_coordinates() {
    for site in &SITES {
        let found = lone(site, &plus(&site.projected, 1.0), true);
        assert_projected(&found, site);
        let [east, north] = site.offset;
        let named = format!("{} less {east} {north}", site.crs);
        assert!(said(&found).contains(&named), "{}", said(&found));
        // The medians: of the noise, and of the difference of the readings.
        assert!(said(&found).contains("to 0.0"), "{}", said(&found));
        let misfit = said(&found).rsplit_once("misfits by ").unwrap().1;
        let misfit: f64 = misfit.split(' ').next().unwrap().parse().unwrap();
        assert!((1.4..3.4).contains(&misfit), "{misfit}");
    }
}

#[test]
fn positions_to_centimetres_tell_east_north_up() {
    for site in &SITES {
        let found = lone(site, &plus(&MEASURED, 1.0), true);
        assert_eq!(found.crs, None);
        let origin = found.enu_origin.unwrap();
        assert_eq!(
            (origin.latitude, origin.longitude),
            (site.latitude, site.longitude)
        );
        assert_eq!(found.cloud.points[0], DVec3::new(1.0, 2.0, 3.0));
        assert!(
            said(&found).contains("taken to be east, north, up"),
            "{}",
            said(&found)
        );
        assert!(said(&found).contains("misfits by"), "{}", said(&found));
    }
}

/// OpenSfM aligns by least squares, so that the turn agrees however much the receivers erred.
#[test]
fn receivers_that_err_by_metres_tell_it_where_the_alignment_is_exact() {
    for site in &SITES {
        let of_grid = of_centers(&site.projected);
        let projected = aligned(&plus(&MEASURED, 150.0));
        let projected: Vec<[f64; 3]> = projected
            .iter()
            .map(|[x, y, z]| {
                let turned = of_grid * DVec2::new(*x, *y);
                [turned.x, turned.y, *z]
            })
            .collect();
        let found = lone(site, &projected, true);
        assert_eq!(found.crs.as_deref(), Some(site.crs), "{}", said(&found));
        let found = lone(site, &aligned(&plus(&MEASURED, 150.0)), true);
        assert!(found.enu_origin.is_some() && found.crs.is_none());
    }
}

/// The linear map of the readings, from the positions that were computed outside.
fn of_centers(projected: &[[f64; 3]; 6]) -> DMat2 {
    let at = |rows: &[[f64; 3]; 6], i: usize| DVec2::new(rows[i][0], rows[i][1]);
    let from = DMat2::from_cols(
        at(&MEASURED, 2) - at(&MEASURED, 0),
        at(&MEASURED, 5) - at(&MEASURED, 0),
    );
    let to = DMat2::from_cols(
        at(projected, 2) - at(projected, 0),
        at(projected, 5) - at(projected, 0),
    );
    to * from.inverse()
}

/// Centres turned and scaled so that the least squares fit to the measured positions is the identity.
fn aligned(centers: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let plane = |rows: &[[f64; 3]]| -> Vec<DVec2> {
        let flat: Vec<DVec2> = rows.iter().map(|[x, y, _]| DVec2::new(*x, *y)).collect();
        let middle = flat.iter().sum::<DVec2>() / flat.len() as f64;
        flat.iter().map(|p| *p - middle).collect()
    };
    let (from, to) = (plane(centers), plane(&MEASURED));
    let both = || from.iter().zip(&to);
    let cos: f64 = both().map(|(a, b)| a.dot(*b)).sum();
    let sin: f64 = both().map(|(a, b)| a.perp_dot(*b)).sum();
    let square: f64 = from.iter().map(|a| a.length_squared()).sum();
    let turn = DVec2::new(cos, sin) / square;
    let middle = MEASURED
        .iter()
        .map(|[x, y, _]| DVec2::new(*x, *y))
        .sum::<DVec2>()
        / 6.0;
    from.iter()
        .zip(centers)
        .map(|(a, [_, _, z])| {
            let p = turn.rotate(*a) + middle;
            [p.x, p.y, *z]
        })
        .collect()
}

#[test]
fn where_neither_fits_it_says_so() {
    // Twenty degrees; mirrored would be no rotation; a place that is not the reference.
    let (sin, cos) = 20_f64.to_radians().sin_cos();
    let turned = plus(&MEASURED, 1.0)
        .into_iter()
        .map(|[x, y, z]| [cos * x - sin * y, sin * x + cos * y, z]);
    let moved = plus(&MEASURED, 1.0)
        .into_iter()
        .map(|[x, y, z]| [x + 300.0, y, z]);
    for centers in [turned.collect::<Vec<_>>(), moved.collect()] {
        for site in &SITES {
            let found = lone(site, &centers, true);
            assert_eq!((found.crs.clone(), found.enu_origin), (None, None));
            assert!(said(&found).contains("fit neither"), "{}", said(&found));
            let elsewhere = Site {
                latitude: site.latitude + 1e-4,
                ..*site
            };
            let found = lone(&elsewhere, &centers, true);
            assert!(said(&found).contains("fit neither"), "{}", said(&found));
        }
    }
}

#[test]
fn without_evidence_a_reference_in_whole_metres_is_doubted() {
    for site in &SITES {
        let found = lone(site, &site.projected, false);
        assert_eq!((found.crs.clone(), found.enu_origin), (None, None));
        assert!(said(&found).contains("not known"), "{}", said(&found));
        assert!(said(&found).contains(site.crs), "{}", said(&found));
        // One position tells no turn.
        let found = lone(site, &site.projected[..1], true);
        assert!(said(&found).contains("do not tell"), "{}", said(&found));
        // Receivers that err by metres, after an adjustment to control points.
        let found = lone(site, &plus(&site.projected, 150.0), true);
        assert_eq!(found.enu_origin, None);
        assert!(
            found.crs.is_none() && said(&found).contains("do not tell"),
            "{}",
            said(&found)
        );
        // OpenSfM's own reference is anywhere.
        let own = Site {
            latitude: site.latitude + 1e-4,
            ..*site
        };
        let found = lone(&own, &site.projected, false);
        assert!(found.enu_origin.is_some());
        assert_eq!(found.warnings, [""; 0]);
        // OpenDroneMap's name for what OpenSfM solved.
        let found = named("reconstruction.topocentric.json", site, &MEASURED, false);
        assert!(found.enu_origin.is_some());
        assert_eq!(found.warnings, [""; 0]);
    }
    let found = lone(&CENTRAL, &CENTRAL.projected, false);
    assert_eq!(found.crs.as_deref(), Some("EPSG:32615"));
    assert!(said(&found).contains("0.04 %"), "{}", said(&found));
}

/// Between February and July 2021 the reference was OpenSfM's own: the offset shows in the positions
/// where the alignment is exact.
#[test]
fn an_offset_that_is_not_the_reference_is_found_or_said_to_be_missing() {
    // The reference is 248941.37 6689455.81 in the zone, the offset 248931 6689459.
    let site = Site {
        latitude: -29.899988957247174,
        longitude: -71.59999925090241,
        crs: "EPSG:32719",
        offset: [248_931.0, 6_689_459.0],
        projected: [
            [-48.6182, -49.5535, 40.0],
            [11.3661, -47.1951, 41.0],
            [73.4185, -47.7917, 40.0],
            [67.3126, 45.1284, 42.0],
            [7.351, 41.7699, 40.0],
            [-51.6332, 39.4341, 39.0],
        ],
    };
    let found = lone(&site, &site.projected, true);
    assert_eq!(found.crs.as_deref(), Some(site.crs), "{}", said(&found));
    assert!(said(&found).contains("EPSG:32719 less 248931 6689459"));
    let [x, y, z] = site.projected[0];
    let off = found.photos[0].pose.center - DVec3::new(248_931.0 + x, 6_689_459.0 + y, z);
    assert!(off.length() < 1e-3, "{off}");
    let moved = site.projected.map(|[x, y, z]| [x + 0.25, y - 0.25, z]);
    let found = lone(&site, &moved, true);
    assert_eq!((found.crs.clone(), found.enu_origin), (None, None));
    assert!(
        said(&found).contains("offset is not known"),
        "{}",
        said(&found)
    );
    assert!(said(&found).contains(site.crs), "{}", said(&found));
}

#[test]
fn a_photo_that_is_far_off_hides_nothing() {
    let site = &SITES[0];
    let mut centers = plus(&site.projected, 1.0);
    centers[3][0] += 400.0;
    let found = lone(site, &centers, true);
    assert_eq!(found.crs.as_deref(), Some(site.crs), "{}", said(&found));
}

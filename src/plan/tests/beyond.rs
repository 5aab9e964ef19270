//! What of a flight lies beyond the surface, which ends 150 east of the middle.

use super::*;

/// Pixels of the terrain are 2/3: in one that the surface ends in all of it counts as over the surface.
const PIXEL: f64 = 2.0 / 3.0;

/// How far a place is beyond the eastern edge, negative before it.
fn off(place: DVec3) -> f64 {
    place.x - 500_150.0
}

/// An area that ends a metre before the edge: the survey's photos of it are taken from beyond, too. Stops and legs against
/// the edge by hand: what lies farther out than a pixel is among them, and nothing that is not out.
#[test]
fn stops_and_legs_beyond_the_edge_are_counted() {
    let surface = surface(|_| 0.0);
    let corners = [(110.0, -20.0), (149.0, -20.0), (149.0, 20.0), (110.0, 20.0)];
    let corners = corners.map(|corner| DVec2::from(corner) + DVec2::new(500_000.0, 5_000_000.0));
    let area = Polygon::new(&corners).unwrap();
    let wish = wish(Pattern::Survey);
    let plan = Plan::new(&surface, &camera(), area, wish, &Progress::default()).unwrap();
    let take_off = DVec2::new(500_080.0, 5_000_000.0);
    let ways = ways((&plan, &surface), take_off, None).unwrap();
    let beyond = Beyond::of(&plan, &ways);
    let stops: Vec<f64> = (ways.iter().flat_map(|way| &way.points))
        .map(|point| off(point.place))
        .collect();
    let out = |offs: &[f64], most: f64| offs.iter().filter(|off| **off > most).count();
    assert!(out(&stops, PIXEL) > 3, "{stops:?}");
    assert_eq!(beyond.of_stops, stops.len());
    assert!((out(&stops, PIXEL)..=out(&stops, 0.0)).contains(&beyond.stops));
    let corners = ways[0].corners();
    let legs: Vec<f64> = (corners[1..corners.len() - 1].windows(2))
        .map(|leg| off(leg[0]).max(off(leg[1])))
        .collect();
    assert_eq!(beyond.of_legs, legs.len());
    assert!((out(&legs, PIXEL)..=out(&legs, 0.0)).contains(&beyond.legs));
    let farthest = stops.iter().copied().fold(0.0, f64::max);
    assert!(
        (beyond.farthest - farthest).abs() < 1.5 * PIXEL,
        "{beyond:?} {farthest}"
    );
    // Without a take-off there are photos alone.
    let photos = Beyond::of(&plan, &[]);
    assert_eq!((photos.of_stops, photos.of_legs), (plan.photos.len(), 0));
    let own: Vec<f64> = (plan.photos.iter())
        .map(|photo| off(photo.pose.center))
        .collect();
    assert!((out(&own, PIXEL)..=out(&own, 0.0)).contains(&photos.stops));
}

/// Over a hole no surface lies either: of a pond of radius 20 in the middle of the field, half of which a leg crosses, the middle
/// is 20 off.
#[test]
fn a_hole_is_beyond_the_surface() {
    let whole = surface(|_| 0.0);
    let middle = DVec2::new(500_000.0, 5_000_000.0);
    let points: Vec<DVec3> = whole.vertices().collect();
    let is_dry = |at: u32| points[at as usize].truncate().distance(middle) >= 20.0;
    let triangles = whole.triangles().unwrap().into_iter();
    let triangles = triangles.filter(|triangle| triangle.iter().all(|at| is_dry(*at)));
    let holed = Surface::new(Cloud {
        triangles: triangles.collect(),
        points: (points.iter().copied())
            .map(|point| match point.truncate().distance(middle) >= 20.0 {
                true => point,
                // Of no triangle, and elsewhere.
                false => DVec3::new(500_100.0, 5_000_100.0, 0.0),
            })
            .collect(),
        ..Cloud::default()
    })
    .unwrap();
    let flat = plan(&whole, 40.0, wish(Pattern::Slope));
    assert!(Beyond::of(&flat, &[]).is_none());
    let holed = plan(&holed, 40.0, wish(Pattern::Slope));
    let over = |x: f64| (middle + DVec2::new(x, 0.0)).extend(20.0);
    let way = Way {
        take_off: over(-40.0).with_z(0.0),
        safe_height: 20.0,
        points: vec![WayPoint {
            place: over(40.0),
            photo: None,
        }],
        length: 0.0,
    };
    let beyond = Beyond::of(&holed, std::slice::from_ref(&way));
    assert_eq!((beyond.stops, beyond.of_stops), (0, 1));
    assert_eq!((beyond.legs, beyond.of_legs), (2, 2));
    assert!((beyond.farthest - 20.0).abs() < 2.0, "{beyond:?}");
    assert!(Beyond::of(&flat, &[way]).is_none());
}

//! What a review says as it grows.

use glam::DVec3;

use super::*;
use crate::camera::{Camera, Distortion, Pose};
use crate::flight::{DecisionKind, Doubt, FlightParts, FlightSettings, InView, OnPhoto, Photo};
use crate::geometry::Bounds;
use crate::scale::{CornerName, Ground, ImageKind};
use crate::surface::{Cloud, Surface};
use crate::units::LengthUnit;

/// A photo of 100 x 100 px, 4 m above a plane with a point every half metre: a footprint of 4 m, so
/// that its scale is 25 px/m, with nothing to doubt.
fn flight() -> Arc<Flight> {
    let at = |i: u32| DVec3::new(f64::from(i % 21), f64::from(i / 21), 0.0) / 2.0;
    let cloud = Cloud {
        points: (0..21 * 21).map(at).collect(),
        ..Cloud::default()
    };
    let flight = Flight::new(FlightParts {
        name: String::new(),
        unit: LengthUnit::Metre,
        unit_known: true,
        ground: Ground::Auto,
        image: ImageKind::Undistorted,
        pair: Default::default(),
        errors: Default::default(),
        package_errors: Default::default(),
        surface: Arc::new(Surface::new(cloud).unwrap()),
        cameras: vec![Camera {
            name: String::new(),
            width: 100,
            height: 100,
            fx: 100.0,
            fy: 100.0,
            cx: 50.0,
            cy: 50.0,
            skew: 0.0,
            distortion: Distortion::None,
        }],
        as_read: Default::default(),
        photos: vec![Photo {
            name: "a.jpg".to_owned(),
            camera: 0,
            pose: Pose::from_tilt_pan(DVec3::new(5.1, 5.1, 4.0), [90.0, 0.0]),
            errors: Default::default(),
            package_errors: Default::default(),
            trouble: None,
        }],
    });
    Arc::new(flight.unwrap())
}

fn looked_up() -> LookedUp {
    let (width, height) = (100, 100);
    LookedUp {
        evidence: vec![Evidence {
            file: PhotoFileState::Found { width, height },
            ..Evidence::default()
        }],
        ..LookedUp::default()
    }
}

fn review() -> Review {
    let (limits, progress) = (Limits::default(), Progress::default());
    Review::of_scales(flight(), looked_up(), &limits, &progress).unwrap()
}

fn settled(review: &Review) -> Option<Verdict> {
    review.photo(0).unwrap().settled()
}

const OTHER: Doubt = Doubt::OtherColours {
    correlation: 0.1,
    points: 500,
};

#[test]
fn nothing_is_trusted_before_it_was_looked_at() {
    let mut review = review();
    assert_eq!(settled(&review), None);
    review.look(&Progress::default()).unwrap();
    assert_eq!(settled(&review), None, "its field is not known");
    review.compute_fields(&Progress::default()).unwrap();
    assert_eq!(settled(&review), Some(Verdict::Trust));
    assert_eq!(review.count_of(Verdict::Trust), 1);
    let photo = review.photo(0).unwrap();
    let top = photo.edges(LengthUnit::Centimetre).top.unwrap();
    assert!((top - 0.25).abs() < 1e-12, "{top}");
    assert_eq!(photo.notes(), [""; 0]);
    assert!(photo.sees_surface());
    // A corner's ray comes in at atan(4 / (2 * sqrt 2)), 54.7 degrees.
    review.take_limits(&Limits {
        flattest_angle: 55.0,
        ..Limits::default()
    });
    assert_eq!(settled(&review), Some(Verdict::Check));
    assert!(review.photo(1).is_none());
}

#[test]
fn colours_outlive_a_change_of_the_settings() {
    let mut review = review();
    review.look(&Progress::default()).unwrap();
    review.compute_fields(&Progress::default()).unwrap();
    review.take_colours([(0, ColoursFound::Against(OTHER))]);
    assert_eq!(settled(&review), Some(Verdict::Check));
    let outcomes = review.outcomes().to_vec();
    review.take_scales(flight(), outcomes, looked_up());
    assert!(!review.is_looked_at());
    let photo = review.photo(0).unwrap();
    assert_eq!(
        (photo.verdict, photo.doubts),
        (Verdict::Check, &[OTHER][..])
    );
    assert_eq!(photo.notes(), [OTHER.to_string()]);
    review.take_colours([(0, ColoursFound::NothingAgainst)]);
    assert_eq!(review.photo(0).unwrap().verdict, Verdict::Trust);
}

/// Another pair and other errors leave corners and best lines as they are, to the bit.
#[test]
fn what_is_stated_changes_no_scale() {
    let mut review = review();
    let progress = Progress::default();
    review.look(&progress).unwrap();
    review.compute_fields(&progress).unwrap();
    let unit = LengthUnit::Metre;
    let fitted = review.photo(0).unwrap().fitted(unit).unwrap();
    let outcomes = review.outcomes().to_vec();
    review.take_stated(ScalePair::Corners, StatedErrors::default());
    assert_eq!(settled(&review), Some(Verdict::Trust));
    let photo = review.photo(0).unwrap();
    let edges = photo.edges(unit);
    assert_eq!(photo.pair(unit), [edges.top, edges.bottom]);
    let errors = StatedErrors {
        surface: Some(0.01),
        ..StatedErrors::default()
    };
    review.take_stated(ScalePair::Fitted, errors);
    assert_eq!(settled(&review), None, "its field is of other errors");
    let photo = review.photo(0).unwrap();
    assert_eq!(photo.fitted(unit), Some(fitted));
    assert_eq!(photo.pair(unit), [Some(fitted.top), Some(fitted.bottom)]);
    assert!(photo.uncertainty(unit).is_none());
    assert_eq!(review.flight().parts().errors, errors);
    review.compute_fields(&progress).unwrap();
    assert_eq!(settled(&review), Some(Verdict::Trust));
    assert_eq!(**review.outcomes(), outcomes);
}

/// A corner's reason is shown with its triangle around it: over points every half metre its longest edge is
/// the diagonal, 0.5 * sqrt 2, more than 0.12 of the footprint's 4 m.
#[test]
fn what_shows_a_reason_is_around_its_corner() {
    let mut review = review();
    review.look(&Progress::default()).unwrap();
    review.take_limits(&Limits {
        triangle_share: 0.1,
        ..Limits::default()
    });
    let photo = review.photo(0).unwrap();
    let [doubt @ Doubt::LongTriangle { corners, .. }] = photo.doubts else {
        panic!("{:?}", photo.doubts);
    };
    assert!(photo.is_doubtful() && photo.waits_for_decision());
    let sight = doubt.sight();
    assert_eq!(sight.on_photo, OnPhoto::Corners(corners.clone()));
    let places = photo.points_in(&InView::Corners(vec![CornerName::TopLeft]));
    let bounds = Bounds::of(&places).unwrap();
    let corner = DVec3::new(3.1, 7.1, 0.0);
    let reach = DVec3::splat(0.5 * 2_f64.sqrt());
    assert!(
        (bounds.min - (corner - reach)).length() < 1e-9,
        "{bounds:?}"
    );
    assert!(
        (bounds.max - (corner + reach)).length() < 1e-9,
        "{bounds:?}"
    );
    let footprint = Bounds::of(&photo.points_in(&InView::Footprint)).unwrap();
    assert!((footprint.size() - DVec3::new(4.0, 4.0, 0.0)).length() < 1e-9);
    let side = Bounds::of(&photo.points_in(&InView::FromSide)).unwrap();
    assert!((side.size().z - 4.0).abs() < 1e-9, "with the camera");
    let left_out = Decision::new("a.jpg", DecisionKind::LeftOut, photo.doubts);
    review.take_decisions(&[left_out]);
    let photo = review.photo(0).unwrap();
    assert!(photo.is_doubtful() && !photo.waits_for_decision());
}

/// Decisions change what goes along and the word for it, no reason for doubt; an acceptance ends
/// where another reason comes.
#[test]
fn what_the_engineer_decides() {
    let mut review = review();
    review.look(&Progress::default()).unwrap();
    review.compute_fields(&Progress::default()).unwrap();
    let along =
        |review: &Review| [Along::All, Along::Trusted].map(|along| review.going_along(along)[0]);
    assert_eq!(along(&review), [true, true]);
    // The corners' rays come in at 54.7 degrees.
    let strict = Limits {
        flattest_angle: 55.0,
        ..Limits::default()
    };
    review.take_limits(&strict);
    assert_eq!(
        (settled(&review), along(&review)),
        (Some(Verdict::Check), [true, false])
    );
    let doubts = review.photo(0).unwrap().doubts.to_vec();
    let accepted = Decision::new("a.jpg", DecisionKind::Accepted, &doubts);
    review.take_decisions(std::slice::from_ref(&accepted));
    assert_eq!(
        (settled(&review), along(&review)),
        (Some(Verdict::Accepted), [true, true])
    );
    assert_eq!(review.photo(0).unwrap().doubts, doubts);
    review.take_colours([(0, ColoursFound::Against(OTHER))]);
    assert_eq!(
        (settled(&review), along(&review)),
        (Some(Verdict::Check), [true, false])
    );
    let photo = review.photo(0).unwrap();
    assert_eq!(photo.reasons_since_accepted(), [&OTHER]);
    assert_eq!(
        photo.decided().unwrap(),
        "checked, accepted (for other reasons: other-colours came since; look again)"
    );
    let left_out = Decision::new("a.jpg", DecisionKind::LeftOut, &doubts);
    review.take_decisions(&[left_out]);
    assert_eq!(
        (settled(&review), along(&review)),
        (Some(Verdict::LeftOut), [false, false])
    );
    // Chosen or not with the space bar: what she noted is kept.
    let noted = Decision {
        note: "taped, fits".to_owned(),
        ..Decision::new(
            "a.jpg",
            DecisionKind::Accepted,
            review.photo(0).unwrap().doubts,
        )
    };
    review.take_decisions(std::slice::from_ref(&noted));
    let off = review.photo(0).unwrap().decision_to(false).unwrap();
    assert_eq!(
        (off.kind, off.note.as_str()),
        (DecisionKind::LeftOut, "taped, fits")
    );
    review.take_decisions(&[off]);
    assert_eq!(review.photo(0).unwrap().decision_to(true), Some(noted));
    // Of a photo that is not there, nothing is taken.
    let other = Decision {
        photo: "b.jpg".to_owned(),
        ..accepted
    };
    review.take_decisions(std::slice::from_ref(&other));
    assert_eq!(settled(&review), Some(Verdict::Check));
    assert_eq!(
        review.flight().decisions_without_photo(&[other]),
        [
            "a review is of photo 'b.jpg', which the flight does not have; the nearest name is 'a.jpg'"
        ]
    );
}

/// Without a unit there is no scale, whoever accepts it.
#[test]
fn nobody_accepts_a_scale_that_is_none() {
    let flight = flight();
    let settings = FlightSettings {
        unit_known: false,
        ..FlightSettings::default()
    };
    let flight = Arc::new(flight.with_settings(&settings).unwrap());
    let (limits, progress) = (Limits::default(), Progress::default());
    let mut review = Review::of_scales(flight, looked_up(), &limits, &progress).unwrap();
    let doubts = review.photo(0).unwrap().doubts.to_vec();
    review.take_decisions(&[Decision::new("a.jpg", DecisionKind::Accepted, &doubts)]);
    assert_eq!(settled(&review), Some(Verdict::NoScale));
    assert!(review.photo(0).unwrap().goes_along(Along::Trusted));
}

/// A file whose header cannot be read is doubted once.
#[test]
fn an_unreadable_file_is_doubted_once() {
    let mut looked_up = looked_up();
    let why = || Doubt::FileUnreadable("cut".to_owned());
    looked_up.evidence[0].file = PhotoFileState::Unreadable("cut".to_owned());
    looked_up.evidence[0].colours = ColoursFound::Against(why());
    let (limits, progress) = (Limits::default(), Progress::default());
    let review = Review::of_scales(flight(), looked_up, &limits, &progress).unwrap();
    assert_eq!(review.photo(0).unwrap().doubts, [why()]);
}

//! A flight's health at a glance: its unit, coordinate system, up axis, colours, distance, metadata, holes, points, photos.
//! Each is good, or says in one sentence what is not and what mends it; every front end shows these words.

use crate::flight::{ColoursFound, Doubt, PhotoFileState, PhotoReview, Review, TogetherFound};
use crate::open::FlightReconstruction;
use crate::surface::UpAxis;

/// What is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HealthItem {
    /// Of the world.
    Unit,
    /// Of the world.
    CoordinateSystem,
    /// Which way the surface is up.
    UpAxis,
    /// Of the surface, and whether those of the photos are the same.
    Colours,
    /// Whether photos see the surface where it is. Only where photos were compared with those beside them.
    Distance,
    /// What the photos' files say of their cameras.
    Exif,
    /// Of the surface, where photos look.
    Holes,
    /// Of the surface: whether they lie on it. Looked for only where something speaks against them.
    Points,
    /// Their files.
    Photos,
}

impl HealthItem {
    /// In one or two words.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Unit => "unit",
            Self::CoordinateSystem => "coordinates",
            Self::UpAxis => "up",
            Self::Colours => "colours",
            Self::Distance => "distance",
            Self::Exif => "EXIF",
            Self::Holes => "holes",
            Self::Points => "points",
            Self::Photos => "photos",
        }
    }
}

/// How it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Health {
    /// Looked at, and good.
    Good,
    /// Nothing is known of it, or it is still being looked at: neither good nor bad.
    Unknown,
    /// Numbers may be wrong for it.
    Bad,
}

/// What mends it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Remedy {
    /// Bringing the reconstruction to the world by what is known of it.
    Georeference,
    /// Saying in which unit cloud and poses are.
    SetUnit,
    /// Naming the folder of the photos.
    AddPhotos,
    /// Naming another cloud or mesh.
    AddSurface,
    /// Taking another axis of the surface's file for up.
    TurnUp(UpAxis),
}

impl Remedy {
    /// What mends a reason for doubt. Poses of their own have nothing to be georeferenced by.
    pub fn against(doubt: &Doubt, can_georeference: bool) -> Option<Self> {
        match doubt {
            Doubt::UnitUnknown if !can_georeference => Some(Self::SetUnit),
            Doubt::UnitNotSystems { .. } => Some(Self::SetUnit),
            Doubt::UnitUnknown => Some(Self::Georeference),
            Doubt::OtherLength { .. } | Doubt::FlyingHeight { .. } | Doubt::LaserRange { .. } => {
                can_georeference.then_some(Self::Georeference)
            }
            Doubt::FileMissing { .. }
            | Doubt::NoPhotoFolder { .. }
            | Doubt::ReducedPhotos { .. }
            | Doubt::FileSize { .. }
            | Doubt::SolvedOnOther { .. }
            | Doubt::SmallerPhotos { .. }
            | Doubt::SameFile { .. }
            | Doubt::FileUnreadable(_) => Some(Self::AddPhotos),
            Doubt::FarFromSurface { .. }
            | Doubt::OffSurface(_)
            | Doubt::NoPoint(_)
            | Doubt::NoisyPoints { .. }
            | Doubt::Wall { .. }
            | Doubt::RoundedPoints { .. } => Some(Self::AddSurface),
            _ => None,
        }
    }
}

/// How one thing is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HealthFinding {
    /// What was looked at.
    pub item: HealthItem,
    /// How it is.
    pub health: Health,
    /// The same in a word or a number: "m", "9 of 9".
    pub short: String,
    /// In one sentence.
    pub says: String,
    /// What mends it, where it is not good and something does.
    pub remedy: Option<Remedy>,
}

/// What is stated of a flight beside its review.
#[derive(Debug, Clone, Copy, Default)]
pub struct StatedOfFlight<'a> {
    /// The coordinate system, "EPSG:n" or WKT.
    pub crs: Option<&'a str>,
    /// The reconstruction that it was made of.
    pub reconstruction: Option<&'a FlightReconstruction>,
    /// The axis that the surface's triangles say is up, where that is not z.
    pub doubtful_up: Option<UpAxis>,
}

/// How a flight is, in the order of [`HealthItem`]; of its points only where something speaks against them, of
/// its distance where photos were compared.
pub fn flight_health(review: &Review, stated: &StatedOfFlight<'_>) -> Vec<HealthFinding> {
    let found = [
        Some(unit(review, stated)),
        Some(coordinates(review, stated)),
        Some(up(review, stated)),
        Some(colours(review)),
        distance(review),
        Some(exif(review, stated)),
        Some(holes(review)),
        points(review),
        Some(photos(review)),
    ];
    found.into_iter().flatten().collect()
}

fn of(item: HealthItem, health: Health, short: impl Into<String>, says: String) -> HealthFinding {
    HealthFinding {
        item,
        health,
        short: short.into(),
        says,
        remedy: None,
    }
}

impl HealthFinding {
    fn with(self, remedy: Remedy) -> Self {
        Self {
            remedy: Some(remedy),
            ..self
        }
    }
}

/// In how many photos, and the first such reason as a sentence.
fn doubted(review: &Review, is_meant: impl Fn(&Doubt) -> bool) -> (usize, String) {
    let reason = |photo: PhotoReview<'_>| photo.doubts.iter().find(|d| is_meant(d)).cloned();
    let mut reasons = review.photos().filter_map(reason).peekable();
    let first = reasons.peek().map(ToString::to_string).unwrap_or_default();
    (reasons.count(), first)
}

/// "3 of 7 photos".
fn share(count: usize, review: &Review) -> String {
    format!("{count} of {} photos", review.count())
}

fn unit(review: &Review, stated: &StatedOfFlight<'_>) -> HealthFinding {
    let parts = review.flight().parts();
    let doubt = parts.unit_doubt();
    if let Some(reason @ Doubt::UnitNotSystems { counted, .. }) = &doubt {
        let says = format!("{}: {reason}.", share(review.count(), review));
        let short = format!("{}, not {counted}", parts.unit);
        return of(HealthItem::Unit, Health::Bad, short, says).with(Remedy::SetUnit);
    }
    match parts.unit_known {
        true => {
            let says = format!("The world counts in {}.", parts.unit);
            of(HealthItem::Unit, Health::Good, parts.unit.symbol(), says)
        }
        false => {
            let says =
                "Nobody states the unit of cloud and poses: no number is a scale.".to_owned();
            let remedy = match stated.reconstruction {
                Some(_) => Remedy::Georeference,
                None => Remedy::SetUnit,
            };
            of(HealthItem::Unit, Health::Bad, "unknown", says).with(remedy)
        }
    }
}

fn coordinates(review: &Review, stated: &StatedOfFlight<'_>) -> HealthFinding {
    let item = HealthItem::CoordinateSystem;
    let is_far = |doubt: &Doubt| matches!(doubt, Doubt::FarFromSurface { .. });
    let (far, reason) = doubted(review, is_far);
    if far > 0 {
        let says = format!("{}: {reason}.", share(far, review));
        return of(item, Health::Bad, "two systems", says).with(Remedy::AddSurface);
    }
    let is_of_heights = |doubt: &Doubt| matches!(doubt, Doubt::OtherHeights { .. });
    let (apart, reason) = doubted(review, is_of_heights);
    if apart > 0 {
        let says = format!("{}: {reason}.", share(apart, review));
        return of(item, Health::Bad, "two heights", says).with(Remedy::AddSurface);
    }
    if let Some(crs) = stated.crs {
        // WKT is a page.
        let is_code = crs.len() <= 16 && !crs.contains('[');
        let (short, says) = match is_code {
            true => (crs.to_owned(), format!("Surface and photos are in {crs}.")),
            false => (
                "stated".to_owned(),
                "Surface and photos are in the system that their files state in full.".to_owned(),
            ),
        };
        return of(item, Health::Good, short, says);
    }
    match stated.reconstruction {
        Some(FlightReconstruction { in_world: None, .. }) => {
            let says = "The reconstruction is in a frame of its own: its directions and its size mean nothing \
                        until it is georeferenced."
                .to_owned();
            of(item, Health::Bad, "own frame", says).with(Remedy::Georeference)
        }
        Some(FlightReconstruction {
            in_world: Some(by), ..
        }) => {
            let says =
                format!("The reconstruction is in the world: {by}. No coordinate system is named.");
            of(item, Health::Good, "local", says)
        }
        None => {
            let says = "No coordinate system is named: scales need none, maps do.".to_owned();
            of(item, Health::Unknown, "local", says)
        }
    }
}

fn up(review: &Review, stated: &StatedOfFlight<'_>) -> HealthFinding {
    let item = HealthItem::UpAxis;
    let (under, reason) = doubted(review, |doubt| matches!(doubt, Doubt::UnderSurface));
    if under > 0 {
        let says = format!("{}: {reason}.", share(under, review));
        return of(item, Health::Bad, "?", says);
    }
    match stated.doubtful_up {
        Some(axis) => {
            let name = axis.name();
            let says = format!(
                "The surface looks as if {name} were up in its file (a steep wall looks the same)."
            );
            of(item, Health::Bad, format!("{name}?"), says).with(Remedy::TurnUp(axis))
        }
        None if matches!(
            stated.reconstruction,
            Some(FlightReconstruction { in_world: None, .. })
        ) =>
        {
            let says = "The reconstruction is in a frame of its own: which way is up was taken from its cameras and \
                        points, or from the gimbals' angles."
                .to_owned();
            of(item, Health::Unknown, "taken", says)
        }
        None if review.count() == 0 => {
            let says = "z is taken to be up: there are no cameras to say otherwise.".to_owned();
            of(item, Health::Unknown, "z", says)
        }
        None => {
            let says = "z is up: every camera is above or beside the surface.".to_owned();
            of(item, Health::Good, "z", says)
        }
    }
}

fn colours(review: &Review) -> HealthFinding {
    let item = HealthItem::Colours;
    let (other, reason) = doubted(review, Doubt::is_of_colours);
    if other > 0 {
        let says = format!("{}: {reason}.", share(other, review));
        return of(item, Health::Bad, share(other, review), says);
    }
    if review.flight().parts().surface.colors().is_empty() {
        let says = "The surface has no colours: none say whether the photos show this pile.";
        return of(item, Health::Unknown, "none", says.to_owned()).with(Remedy::AddSurface);
    }
    let evidence = &review.looked_up().evidence;
    let count = |of: ColoursFound| evidence.iter().filter(|e| e.colours == of).count();
    let compared = count(ColoursFound::NothingAgainst);
    let found = files_found(review);
    if found == 0 || compared + count(ColoursFound::CannotTell) < found {
        let says = format!(
            "The surface has colours; those of {} were compared with it so far.",
            share(compared, review)
        );
        return of(item, Health::Unknown, "not compared", says);
    }
    if compared == 0 {
        let says = "The surface has colours, and too few of them are in the photos' sight to compare them.";
        return of(item, Health::Unknown, "unclear", says.to_owned());
    }
    let says = format!(
        "Nothing in the colours of {} speaks against the surface.",
        share(compared, review)
    );
    of(item, Health::Good, "same", says)
}

fn distance(review: &Review) -> Option<HealthFinding> {
    let item = HealthItem::Distance;
    let (elsewhere, reason) = doubted(review, |d| matches!(d, Doubt::OtherDistance { .. }));
    if elsewhere > 0 {
        let says = format!("{}: {reason}.", share(elsewhere, review));
        return Some(of(item, Health::Bad, share(elsewhere, review), says));
    }
    let evidence = review.looked_up().evidence.iter();
    let of_compared = evidence.filter_map(|evidence| match &evidence.together {
        TogetherFound::NotCompared => None,
        TogetherFound::There { off, .. } => Some(Some(*off)),
        TogetherFound::Unclear | TogetherFound::Against(_) => Some(None),
    });
    let of_compared: Vec<Option<f64>> = of_compared.collect();
    let there: Vec<f64> = of_compared.iter().copied().flatten().collect();
    let worst = there.iter().copied().reduce(f64::max);
    let Some(worst) = worst else {
        let says = "The photos and those beside them do not tell where the surface is.".to_owned();
        return (!of_compared.is_empty()).then(|| of(item, Health::Unknown, "unclear", says));
    };
    let says = format!(
        "{} see the surface where it is, together with those beside them: within {:.1} % of its distance.",
        share(there.len(), review),
        worst * 100.0
    );
    Some(match 2 * there.len() > of_compared.len() {
        true => of(item, Health::Good, "as seen", says),
        false => of(item, Health::Unknown, share(there.len(), review), says),
    })
}

fn exif(review: &Review, stated: &StatedOfFlight<'_>) -> HealthFinding {
    let item = HealthItem::Exif;
    let is_of_metadata = |doubt: &Doubt| {
        matches!(
            doubt,
            Doubt::StrangeCamera { .. }
                | Doubt::SeveralDevices { .. }
                | Doubt::OtherDevice { .. }
                | Doubt::FocalLength { .. }
                | Doubt::FlyingHeight { .. }
                | Doubt::LaserRange { .. }
                | Doubt::OtherPlace { .. }
                | Doubt::OtherLength { .. }
        )
    };
    let can_georeference = stated.reconstruction.is_some();
    let (against, reason) = doubted(review, is_of_metadata);
    if against > 0 {
        let says = format!("{}: {reason}.", share(against, review));
        let mut doubts = review.photos().flat_map(|photo| photo.doubts);
        let first = doubts.find(|doubt| is_of_metadata(doubt));
        return HealthFinding {
            remedy: first.and_then(|doubt| Remedy::against(doubt, can_georeference)),
            ..of(item, Health::Bad, share(against, review), says)
        };
    }
    let metadata = review.looked_up().metadata;
    if metadata.telling == 0 {
        let says = "No photo's file says with what it was taken, or no file is there: nothing speaks for the \
                    calibration, nothing against it."
            .to_owned();
        let finding = of(item, Health::Unknown, "none", says);
        return match files_found(review) {
            0 => finding.with(Remedy::AddPhotos),
            _ => finding,
        };
    }
    let says = format!(
        "What {} of {} files that were looked at say of camera and height fits the flight.",
        metadata.telling, metadata.looked_at
    );
    of(item, Health::Good, "fits", says)
}

fn holes(review: &Review) -> HealthFinding {
    let item = HealthItem::Holes;
    let is_hole = |doubt: &Doubt| {
        matches!(
            doubt,
            Doubt::OffSurface(_)
                | Doubt::NoPoint(_)
                | Doubt::LongTriangle { .. }
                | Doubt::NoFit { .. }
        )
    };
    let (over, reason) = doubted(review, is_hole);
    if over > 0 {
        let says = format!(
            "{} look over a hole or an edge of the surface; the first: {reason}.",
            share(over, review)
        );
        let short = share(over, review);
        return of(item, Health::Bad, short, says).with(Remedy::AddSurface);
    }
    match review.is_looked_at() && review.count() > 0 {
        true => {
            let says = "Every photo's corners are on the surface, none over a hole.".to_owned();
            of(item, Health::Good, "none", says)
        }
        false => {
            let says = "Nobody has looked at the photos' footprints yet.".to_owned();
            of(item, Health::Unknown, "…", says)
        }
    }
}

fn points(review: &Review) -> Option<HealthFinding> {
    let is_of_points = |doubt: &Doubt| {
        matches!(
            doubt,
            Doubt::NoisyPoints { .. } | Doubt::RoundedPoints { .. } | Doubt::Wall { .. }
        )
    };
    let (over, reason) = doubted(review, is_of_points);
    (over > 0).then(|| {
        let says = format!("{}; the first: {reason}.", share(over, review));
        let finding = of(HealthItem::Points, Health::Bad, share(over, review), says);
        finding.with(Remedy::AddSurface)
    })
}

fn files_found(review: &Review) -> usize {
    let is_found = |photo: &PhotoReview<'_>| matches!(photo.file, PhotoFileState::Found { .. });
    review.photos().filter(is_found).count()
}

fn photos(review: &Review) -> HealthFinding {
    let (found, count) = (files_found(review), review.count());
    let is_of_file = |doubt: &Doubt| {
        matches!(
            doubt,
            Doubt::FileSize { .. }
                | Doubt::SolvedOnOther { .. }
                | Doubt::SmallerPhotos { .. }
                | Doubt::SameFile { .. }
        )
    };
    let (wrong, reason) = doubted(review, is_of_file);
    let short = format!("{found} of {count}");
    let (health, says) = match found == count && count > 0 {
        true if wrong > 0 => (Health::Bad, format!("{}: {reason}.", share(wrong, review))),
        true => (Health::Good, format!("All {count} photo files are there.")),
        false => (
            Health::Bad,
            format!("The files of {} are there.", share(found, review)),
        ),
    };
    let finding = of(HealthItem::Photos, health, short, says);
    match health {
        Health::Good => finding,
        _ => finding.with(Remedy::AddPhotos),
    }
}

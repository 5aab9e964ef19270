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
    /// The angles of the poses, and whether photos show points where the poses say. Only where something speaks against them.
    Poses,
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
            Self::Poses => "poses",
            Self::UpAxis => "up",
            Self::Colours => "colours",
            Self::Distance => "distance",
            Self::Exif => "EXIF",
            Self::Holes => "holes",
            Self::Points => "points",
            Self::Photos => "photos",
        }
    }

    /// What a reason for doubt speaks against; `None` where it is of one photo's view, and the flight is well.
    pub fn doubted_by(doubt: &Doubt) -> Option<Self> {
        match doubt {
            Doubt::UnitUnknown
            | Doubt::UnitNotSystems { .. }
            | Doubt::StrangeSize { .. }
            | Doubt::OtherUnit { .. } => Some(Self::Unit),
            Doubt::FarFromSurface { .. } | Doubt::OtherHeights { .. } => {
                Some(Self::CoordinateSystem)
            }
            Doubt::SmallAngles { .. } | Doubt::NoRotation { .. } | Doubt::OffItsPoints { .. } => {
                Some(Self::Poses)
            }
            Doubt::UnderSurface | Doubt::FromBehind | Doubt::TurnedMesh => Some(Self::UpAxis),
            Doubt::OtherColours { .. } | Doubt::Flipped { .. } => Some(Self::Colours),
            Doubt::OtherDistance { .. }
            | Doubt::OthersElsewhere { .. }
            | Doubt::OthersNowhere { .. }
            | Doubt::PartlyThere { .. }
            | Doubt::MatchesNowhere { .. } => Some(Self::Distance),
            Doubt::StrangeCamera { .. }
            | Doubt::SeveralDevices { .. }
            | Doubt::OtherDevice { .. }
            | Doubt::FocalLength { .. }
            | Doubt::FlyingHeight { .. }
            | Doubt::LaserRange { .. }
            | Doubt::OtherPlace { .. }
            | Doubt::OtherLength { .. } => Some(Self::Exif),
            Doubt::OffSurface(_)
            | Doubt::NoPoint(_)
            | Doubt::LongTriangle { .. }
            | Doubt::NoFit { .. } => Some(Self::Holes),
            Doubt::NoisyPoints { .. } | Doubt::RoundedPoints { .. } | Doubt::Wall { .. } => {
                Some(Self::Points)
            }
            Doubt::FileMissing { .. }
            | Doubt::NoPhotoFolder { .. }
            | Doubt::ReducedPhotos { .. }
            | Doubt::FileUnreadable(_)
            | Doubt::FileSize { .. }
            | Doubt::SolvedOnOther { .. }
            | Doubt::SmallerPhotos { .. }
            | Doubt::SameFile { .. } => Some(Self::Photos),
            Doubt::NoScale(_)
            | Doubt::NoLine
            | Doubt::Ratio { .. }
            | Doubt::Sideways { .. }
            | Doubt::FlatView { .. }
            | Doubt::NotPlane { .. }
            | Doubt::OffLine { .. }
            | Doubt::WideInterval { .. } => None,
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
            Doubt::UnitNotSystems { .. } | Doubt::StrangeSize { .. } => Some(Self::SetUnit),
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
            | Doubt::OtherUnit { .. }
            | Doubt::OffSurface(_)
            | Doubt::NoPoint(_)
            | Doubt::NoisyPoints { .. }
            | Doubt::Wall { .. }
            | Doubt::RoundedPoints { .. } => Some(Self::AddSurface),
            Doubt::NoScale(_)
            | Doubt::NoFit { .. }
            | Doubt::NoLine
            | Doubt::Ratio { .. }
            | Doubt::Sideways { .. }
            | Doubt::LongTriangle { .. }
            | Doubt::FlatView { .. }
            | Doubt::NotPlane { .. }
            | Doubt::OffLine { .. }
            | Doubt::WideInterval { .. }
            | Doubt::SmallAngles { .. }
            | Doubt::NoRotation { .. }
            | Doubt::OffItsPoints { .. }
            | Doubt::OtherPlace { .. }
            | Doubt::OtherHeights { .. }
            | Doubt::UnderSurface
            | Doubt::FromBehind
            | Doubt::TurnedMesh
            | Doubt::StrangeCamera { .. }
            | Doubt::SeveralDevices { .. }
            | Doubt::OtherDevice { .. }
            | Doubt::FocalLength { .. }
            | Doubt::OtherColours { .. }
            | Doubt::OtherDistance { .. }
            | Doubt::OthersElsewhere { .. }
            | Doubt::OthersNowhere { .. }
            | Doubt::PartlyThere { .. }
            | Doubt::MatchesNowhere { .. }
            | Doubt::Flipped { .. } => None,
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
    /// The photos that lie beside the flight's and have no pose in it, in words.
    pub without_pose: Option<&'a str>,
}

/// How a flight is, in the order of [`HealthItem`]; of its poses and points only where something speaks against them, of
/// its distance where photos were compared.
pub fn flight_health(review: &Review, stated: &StatedOfFlight<'_>) -> Vec<HealthFinding> {
    let found = [
        Some(unit(review, stated)),
        Some(coordinates(review, stated)),
        poses(review),
        Some(up(review, stated)),
        Some(colours(review)),
        distance(review),
        Some(exif(review, stated)),
        Some(holes(review)),
        points(review),
        Some(photos(review, stated)),
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

/// What speaks against one thing.
struct Doubted {
    /// In how many photos.
    count: usize,
    /// The first such reason.
    first: Doubt,
}

/// Whether reasons for doubt speak against this.
fn doubted(review: &Review, item: HealthItem) -> Option<Doubted> {
    let is_meant = |doubt: &&Doubt| HealthItem::doubted_by(doubt) == Some(item);
    let reason = |photo: PhotoReview<'_>| photo.doubts.iter().find(is_meant).cloned();
    let mut reasons = review.photos().filter_map(reason);
    let first = reasons.next()?;
    Some(Doubted {
        count: 1 + reasons.count(),
        first,
    })
}

impl Doubted {
    /// "3 of 7 photos".
    fn share(&self, review: &Review) -> String {
        share(self.count, review)
    }

    /// With the reason.
    fn says(&self, review: &Review) -> String {
        format!("{}: {}.", self.share(review), self.first)
    }
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
    if let Some(doubted) = doubted(review, item) {
        let short = match doubted.first {
            Doubt::OtherHeights { .. } => "two heights",
            _ => "two systems",
        };
        return of(item, Health::Bad, short, doubted.says(review)).with(Remedy::AddSurface);
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
    if let Some(doubted) = doubted(review, item) {
        return of(item, Health::Bad, "?", doubted.says(review));
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
    if let Some(doubted) = doubted(review, item) {
        return of(
            item,
            Health::Bad,
            doubted.share(review),
            doubted.says(review),
        );
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
    if let Some(doubted) = doubted(review, item) {
        let share = doubted.share(review);
        return Some(of(item, Health::Bad, share, doubted.says(review)));
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
    let seen = share(there.len(), review);
    let rest = match there.len() == review.count() {
        true => "",
        false => " The others do not say so: they do not tell, or are beside none.",
    };
    let says = format!(
        "{seen} see the surface where it is, together with those beside them: within {:.1} % of its distance.{rest}",
        worst * 100.0
    );
    let short = match rest {
        "" => "as seen".to_owned(),
        _ => seen,
    };
    let health = match 2 * there.len() > of_compared.len() {
        true => Health::Good,
        false => Health::Unknown,
    };
    Some(of(item, health, short, says))
}

fn exif(review: &Review, stated: &StatedOfFlight<'_>) -> HealthFinding {
    let item = HealthItem::Exif;
    if let Some(doubted) = doubted(review, item) {
        let can_georeference = stated.reconstruction.is_some();
        return HealthFinding {
            remedy: Remedy::against(&doubted.first, can_georeference),
            ..of(
                item,
                Health::Bad,
                doubted.share(review),
                doubted.says(review),
            )
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
    if let Some(doubted) = doubted(review, item) {
        let says = format!(
            "{} look over a hole or an edge of the surface; the first: {}.",
            doubted.share(review),
            doubted.first
        );
        return of(item, Health::Bad, doubted.share(review), says).with(Remedy::AddSurface);
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

/// Where something speaks against them, with the first reason.
fn only_where_doubted(review: &Review, item: HealthItem) -> Option<HealthFinding> {
    doubted(review, item).map(|doubted| {
        let share = doubted.share(review);
        let says = format!("{share}; the first: {}.", doubted.first);
        of(item, Health::Bad, share, says)
    })
}

fn poses(review: &Review) -> Option<HealthFinding> {
    only_where_doubted(review, HealthItem::Poses)
}

fn points(review: &Review) -> Option<HealthFinding> {
    let finding = only_where_doubted(review, HealthItem::Points);
    finding.map(|finding| finding.with(Remedy::AddSurface))
}

fn files_found(review: &Review) -> usize {
    let is_found = |photo: &PhotoReview<'_>| matches!(photo.file, PhotoFileState::Found { .. });
    review.photos().filter(is_found).count()
}

fn photos(review: &Review, stated: &StatedOfFlight<'_>) -> HealthFinding {
    let (found, count) = (files_found(review), review.count());
    let short = format!("{found} of {count}");
    let (health, says) = match found == count && count > 0 {
        true => match doubted(review, HealthItem::Photos) {
            Some(doubted) => (Health::Bad, doubted.says(review)),
            None => {
                let others = stated.without_pose.map(|others| format!(" {others}."));
                let others = others.unwrap_or_default();
                let says = format!("All {count} photo files are there.{others}");
                (Health::Good, says)
            }
        },
        false => (
            Health::Bad,
            match doubted(review, HealthItem::Photos) {
                Some(doubted) if matches!(doubted.first, Doubt::FileUnreadable(_)) => {
                    doubted.says(review)
                }
                _ => format!("The files of {} are there.", share(found, review)),
            },
        ),
    };
    let finding = of(HealthItem::Photos, health, short, says);
    match health {
        Health::Good => finding,
        _ => finding.with(Remedy::AddPhotos),
    }
}

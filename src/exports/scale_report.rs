//! A list of scales, ready to be written: a review's photos in the unit asked for.

use std::collections::HashMap;

use super::ReportObject;
use crate::fault::{Fault, first_names};
use crate::flight::{Doubt, Evidence, PhotoReview, Review, ScaleObject, Verdict};
use crate::numbers::{farther_percent, is_width};
use crate::scale::{
    EdgeScales, ErrorSource, FittedScale, ImageKind, ScaleEstimate, ScalePair, Uncertainty,
};
use crate::units::LengthUnit;

/// The scales of a review's photos, or of some of them, in a unit.
#[derive(Debug)]
pub struct ScaleReport<'a> {
    review: &'a Review,
    unit: LengthUnit,
    to_type: bool,
    /// By their places in the flight.
    photos: Vec<usize>,
    /// Of each photo of the flight; empty where nobody asked.
    scale_objects: Vec<Vec<ReportObject>>,
}

/// So many photos of one note are said one by one.
const A_FEW: usize = 3;

/// What is noted of a photo, or of many.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Noted {
    /// The photo's name, or how many they are with the first names.
    pub whose: String,
    /// Whether they have what Split-Desktop asks for.
    pub has_scale: bool,
    /// What fell back or failed.
    pub notes: String,
}

/// One photo in a list of scales.
#[derive(Debug, Clone, Copy)]
pub struct PhotoLine<'a> {
    /// The photo with everything that is known of it.
    pub photo: PhotoReview<'a>,
    /// Its place in the flight.
    pub index: usize,
    /// Scales are in pixels per this.
    pub unit: LengthUnit,
    /// Whether scales are left out that are none, because nobody knows the world's unit.
    pub to_type: bool,
    /// Scale objects that were traced on it.
    pub scale_objects: &'a [ReportObject],
}

impl<'a> ScaleReport<'a> {
    /// All photos of a review, without their scale objects.
    pub fn new(review: &'a Review, unit: LengthUnit) -> Self {
        Self {
            review,
            unit,
            to_type: false,
            photos: (0..review.count()).collect(),
            scale_objects: Vec::new(),
        }
    }

    /// The same report with scale objects beside their photos' scales.
    ///
    /// # Errors
    /// Where the surface cannot be met.
    pub fn with_scale_objects(mut self, objects: &[ScaleObject]) -> Result<Self, Fault> {
        self.scale_objects = ReportObject::of_photos(self.review, objects, self.unit)?;
        Ok(self)
    }

    /// The same report to type scales from: without those that are none, because nobody knows the
    /// world's unit.
    #[must_use]
    pub fn to_type_from(mut self) -> Self {
        self.to_type = true;
        self
    }

    /// The report of some of the photos, those that are `true` in `selected`, in the same order.
    #[must_use]
    pub fn of_photos(mut self, selected: &[bool]) -> Self {
        self.photos
            .retain(|&photo| selected.get(photo) == Some(&true));
        self
    }

    /// The flight's name.
    pub fn flight(&self) -> &'a str {
        &self.review.flight().parts().name
    }

    /// Scales are in pixels per this.
    pub fn unit(&self) -> LengthUnit {
        self.unit
    }

    /// The unit of points and elevations.
    pub fn world_unit(&self) -> LengthUnit {
        self.review.flight().parts().unit
    }

    /// Whether anybody says that it is this unit; else no number here is a scale.
    pub fn unit_known(&self) -> bool {
        self.review.flight().parts().unit_known
    }

    /// Which image the scales are for.
    pub fn image(&self) -> ImageKind {
        self.review.flight().parts().image
    }

    /// What fell back or failed, a sentence a photo; one of all photos where more than a few have the same.
    pub fn noted(&self) -> Vec<Noted> {
        self.grouped(notes)
    }

    /// Why photos are not trusted, likewise: all reasons for doubt with the verdict, or what fell back or failed
    /// where nobody has settled one yet.
    pub fn reasons(&self) -> Vec<Noted> {
        self.grouped(|line| line.why_not_trusted())
    }

    /// Which photos that are trusted by themselves were compared with nothing, in a sentence; `None` where all were, or nobody has compared
    /// any.
    pub fn unconfirmed(&self) -> Option<String> {
        let evidence = &self.review.looked_up().evidence;
        // What a person has decided she has looked at.
        let is_trusted = |line: &PhotoLine<'_>| {
            line.photo.verdict == Verdict::Trust && line.photo.decision.is_none()
        };
        let trusted: Vec<PhotoLine<'_>> = self.lines().filter(is_trusted).collect();
        let is_unconfirmed = |line: &&PhotoLine<'_>| {
            let evidence = evidence.get(line.index);
            evidence.is_some_and(Evidence::is_unconfirmed)
        };
        let names = trusted.iter().filter(is_unconfirmed);
        let names: Vec<&str> = names.map(|line| line.photo.name()).collect();
        (!names.is_empty()).then(|| {
            format!(
                "{} of {} trusted photos were compared with nothing ({}): no colours of the surface tell there, and no photo from beside them \
                 shows enough of the same rock. Look whether they show this place",
                names.len(),
                trusted.len(),
                first_names(&names)
            )
        })
    }

    /// What to do where half of the photos or more look beyond the surface; `None` elsewhere.
    pub fn advice(&self) -> Option<String> {
        // Where none shows it, it lies elsewhere, and no larger cloud helps.
        if !self.lines().any(|line| line.photo.sees_surface()) {
            return None;
        }
        let beyond = |doubt: &Doubt| {
            matches!(
                doubt,
                Doubt::NoPoint(_) | Doubt::OffSurface(_) | Doubt::NoFit { .. }
            )
        };
        let lines = self.lines();
        let beyond = lines.filter(|line| line.photo.doubts.iter().any(beyond));
        let (beyond, all) = (beyond.count(), self.photos.len());
        (beyond > 0 && 2 * beyond >= all).then(|| {
            format!(
                "{beyond} of {all} photos look beyond the surface's rim: take a cloud that reaches further than \
                 the photos do (for one, survey photos around the pile as well)"
            )
        })
    }

    /// How much of their 95 % intervals all photos share, in words; `None` where nobody states it.
    pub fn shared(&self) -> Option<String> {
        self.review.flight().errors_of_all().world_in_words()
    }

    /// What no 95 % interval of a photo or more counts, because nobody states it; `None` where all is counted.
    pub fn not_counted(&self) -> Option<String> {
        let counts = |line: &PhotoLine<'_>| {
            let leaves = line.uncertainty().is_some_and(|sure| sure.leaves_surface);
            line.interval_percent().is_some() || leaves
        };
        let lines = self.lines().filter(counts);
        let mut names: Vec<&str> = Vec::new();
        for line in lines {
            let of_photo = line
                .uncertainty()
                .map(|sure| sure.not_counted_in_words(line.photo.pair));
            for name in of_photo.unwrap_or_default() {
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        // In the order of the sources.
        let order = |name: &&str| {
            let sources = ErrorSource::ALL.iter();
            sources
                .map(|source| source.as_str())
                .position(|source| source == *name)
        };
        names.sort_by_key(order);
        (!names.is_empty()).then(|| names.join(", "))
    }

    /// A sentence a photo that has one; one of all photos where more than a few have the same.
    fn grouped(&self, of: impl Fn(&PhotoLine<'_>) -> Option<String>) -> Vec<Noted> {
        let mut found: Vec<(String, bool, Vec<&str>)> = Vec::new();
        let mut places: HashMap<(String, bool), usize> = HashMap::new();
        for line in self.lines() {
            let Some(sentence) = of(&line) else { continue };
            let key = (sentence, line.has_top_and_bottom());
            let place = *places.entry(key.clone()).or_insert(found.len());
            if place == found.len() {
                found.push((key.0, key.1, Vec::new()));
            }
            found[place].2.push(line.photo.name());
        }
        let sentence = |(notes, has_scale, photos): (String, bool, Vec<&str>)| {
            let noted = |whose: String| Noted {
                whose,
                has_scale,
                notes: notes.clone(),
            };
            match photos.len() {
                0..=A_FEW => photos.iter().map(|&name| noted(name.to_owned())).collect(),
                count => vec![noted(format!("{count} photos ({})", first_names(&photos)))],
            }
        };
        found.into_iter().flat_map(sentence).collect()
    }

    /// One a photo, in the order of the flight.
    pub fn lines(&self) -> impl Iterator<Item = PhotoLine<'_>> {
        self.photos.iter().filter_map(|&index| {
            Some(PhotoLine {
                photo: self.review.photo(index)?,
                index,
                unit: self.unit,
                to_type: self.to_type,
                scale_objects: self.scale_objects.get(index).map_or(&[], Vec::as_slice),
            })
        })
    }
}

/// That the model has no unit is said once, of the flight.
fn without_unit(sentences: Vec<String>) -> impl Iterator<Item = String> {
    let of_unit = Doubt::UnitUnknown.to_string();
    sentences.into_iter().filter(move |said| *said != of_unit)
}

/// What fell back or failed, in one sentence; `None` where nothing did.
fn notes(line: &PhotoLine<'_>) -> Option<String> {
    let notes: Vec<String> = without_unit(line.photo.notes()).collect();
    (!notes.is_empty()).then(|| notes.join("; "))
}

impl<'a> PhotoLine<'a> {
    /// A photo by itself, in pixels per world unit, whether that is known or not.
    pub fn of(photo: PhotoReview<'a>, index: usize) -> Self {
        Self {
            photo,
            index,
            unit: photo.unit,
            to_type: false,
            scale_objects: &[],
        }
    }

    /// Why it is not trusted, in one sentence; `None` where nothing is said against it. That the model has no unit is
    /// said of the flight.
    pub fn why_not_trusted(&self) -> Option<String> {
        let photo = &self.photo;
        let Some(verdict) = photo.settled().filter(|_| !photo.doubts.is_empty()) else {
            return notes(self);
        };
        let reasons: Vec<String> = without_unit(photo.reasons()).collect();
        let (verdict, reasons) = (verdict.to_string(), reasons.join("; "));
        if reasons.is_empty() {
            return None;
        }
        // That there is no scale is verdict and reason.
        Some(match reasons.starts_with(&verdict) {
            true => reasons,
            false => format!("{verdict}: {reasons}"),
        })
    }

    /// Pixels per unit along the edges.
    pub fn scale(&self) -> EdgeScales {
        match self.to_type && !self.photo.unit_known {
            true => EdgeScales::default(),
            false => self.photo.edges(self.unit),
        }
    }

    /// The best line through its scale field, pixels per unit.
    pub fn fitted(&self) -> Option<FittedScale> {
        match self.to_type && !self.photo.unit_known {
            true => None,
            false => self.photo.fitted(self.unit),
        }
    }

    /// How sure its scales are, pixels per unit.
    pub fn uncertainty(&self) -> Option<Uncertainty> {
        match self.to_type && !self.photo.unit_known {
            true => None,
            false => self.photo.uncertainty(self.unit),
        }
    }

    /// Top and bottom scale for Split-Desktop, pixels per unit.
    pub fn pair(&self) -> [Option<f64>; 2] {
        let estimates = self.estimates(self.photo.pair);
        estimates.map(|estimate| Some(estimate?.value))
    }

    /// Top and bottom scale of either pair with how sure they are, pixels per unit.
    pub fn estimates(&self, pair: ScalePair) -> [Option<ScaleEstimate>; 2] {
        match self.to_type && !self.photo.unit_known {
            true => [None; 2],
            false => self.photo.estimates(pair, self.unit),
        }
    }

    /// How far the farther end of the 95 % interval of what goes to Split-Desktop is, of the less certain edge, in
    /// percent; `None` where an edge has none, or one that is rounding.
    pub fn interval_percent(&self) -> Option<f64> {
        let [top, bottom] = self.estimates(self.photo.pair);
        let farther = |estimate: Option<ScaleEstimate>| {
            let ScaleEstimate { value, interval } = estimate?;
            let interval = interval?;
            Some(farther_percent(value, interval.low, interval.high))
        };
        Some(farther(top)?.max(farther(bottom)?)).filter(|percent| is_width(*percent))
    }

    /// Elevation of the ground, where a ray needed it; world units.
    pub fn ground(&self) -> Option<f64> {
        self.photo.scale()?.ground
    }

    /// Whether Split-Desktop gets the two scales that it asks for.
    pub fn has_top_and_bottom(&self) -> bool {
        self.pair().iter().all(Option::is_some)
    }
}

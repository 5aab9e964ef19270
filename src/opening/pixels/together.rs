//! Whether photos and those beside them see the surface where it is.

use std::collections::{BTreeMap, BTreeSet};

use image::RgbImage;

use super::pairs::pairs;
use crate::fault::Fault;
use crate::flight::{ColoursFound, Doubt, Flight, Outcome, TogetherFound};
use crate::geometry::median;
use crate::jobs::Progress;
use crate::photo_files::PhotoFile;
use crate::picture::{PairSight, Patches, SeenAt, Sighted, SmallPhoto, seen_at};
use crate::scale::{ImageKind, ScaleField};

/// What a photo and those beside it see.
#[derive(Debug, Clone, PartialEq)]
pub enum Together {
    /// It was compared with those beside it.
    Pair {
        /// The name of the photo beside it that tells most.
        other: String,
        /// Where the two see the surface.
        sight: PairSight,
    },
    /// It does not tell; others of the flight do, and none of them sees the surface where it is.
    OthersElsewhere {
        /// So many see it elsewhere.
        photos: usize,
        /// At so many times its distance, their median.
        factor: f64,
    },
    /// It does not tell, or is beside none, and none that was compared tells where the surface is.
    OthersNowhere {
        /// So many were.
        photos: usize,
    },
}

/// So many photos that are compared and do not tell, none of them, are of another surface: of right flights nearly all tell (of the
/// 26 photos of five simulated nine-photo flights all, with a ring 66 of 68; a heap turned upside down has none of six).
const NONE_OF_SO_MANY: usize = 4;

impl Together {
    /// What they say against the photo.
    pub fn doubt(&self) -> Option<Doubt> {
        match self {
            Self::Pair {
                other,
                sight:
                    PairSight::Elsewhere(SeenAt {
                        factor,
                        there,
                        here,
                        ..
                    }),
            } => Some(Doubt::OtherDistance {
                other: other.clone(),
                factor: *factor,
                there: *there,
                here: *here,
            }),
            Self::Pair {
                other,
                sight: PairSight::Nowhere,
            } => Some(Doubt::MatchesNowhere {
                other: other.clone(),
            }),
            Self::Pair {
                other,
                sight: PairSight::Partly(share),
            } => Some(Doubt::PartlyThere {
                other: other.clone(),
                share: *share,
            }),
            Self::Pair { .. } => None,
            &Self::OthersElsewhere { photos, factor } => {
                Some(Doubt::OthersElsewhere { photos, factor })
            }
            &Self::OthersNowhere { photos } => Some(Doubt::OthersNowhere { photos }),
        }
    }

    /// The same in a few words, for lists of all photos.
    pub fn in_words(&self) -> String {
        let (other, sight) = match self {
            Self::Pair { other, sight } => (other, sight),
            Self::OthersElsewhere { photos, .. } => {
                return format!(
                    "it does not tell where the surface is, and the {photos} that do see it elsewhere"
                );
            }
            Self::OthersNowhere { photos } => {
                return format!(
                    "it does not tell where the surface is, nor does any of the {photos} that were compared"
                );
            }
        };
        match sight {
            PairSight::There(off) => {
                format!(
                    "with {other} it sees the surface where it is, to {:.1} %",
                    off * 100.0
                )
            }
            PairSight::Elsewhere(seen) => format!(
                "with {other} it sees the surface at {:.1} % of its distance",
                seen.factor * 100.0
            ),
            PairSight::Partly(share) => format!(
                "with {other} it sees the surface where it is in {:.0} % of what both show",
                share * 100.0
            ),
            PairSight::Nowhere => format!("it is like {other} at no distance of the surface"),
            PairSight::Unclear => format!("with {other} it does not tell where the surface is"),
        }
    }
}

impl From<&Together> for TogetherFound {
    fn from(together: &Together) -> Self {
        match (together.doubt(), together) {
            (Some(doubt), _) => Self::Against(doubt),
            (
                None,
                Together::Pair {
                    other,
                    sight: PairSight::There(off),
                },
            ) => Self::There {
                other: other.clone(),
                off: *off,
            },
            (None, _) => Self::Unclear,
        }
    }
}

/// Compares photos with those beside them, as they are read: each is kept, small and with its distances, until all beside it were there.
/// (Its patches would be ten times as much.)
#[derive(Debug, Default)]
pub struct PhotosTogether {
    /// Which are compared.
    pairs: Vec<[usize; 2]>,
    /// Those that were read, and wait for others, with where they see the surface.
    kept: BTreeMap<usize, (SmallPhoto, ScaleField)>,
    /// What was seen, parallel to the pairs; `None` while a photo is not read.
    sights: Vec<Option<PairSight>>,
    /// Those whose colours are the surface's.
    fitting: BTreeSet<usize>,
    /// Those without a file: nothing can be said of what they show.
    absent: BTreeSet<usize>,
}

impl PhotosTogether {
    /// Chooses which photos of a flight are compared, of those whose files are there: none over a surface of which only a
    /// part was read. `outcomes` are its scales ([`Flight::scales`]).
    ///
    /// # Errors
    /// Where the work was cancelled.
    pub fn new(
        flight: &Flight,
        outcomes: &[Outcome],
        files: &[PhotoFile],
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let pairs = match flight.parts().surface.is_part() {
            true => Vec::new(),
            false => pairs(flight, outcomes, files, progress)?,
        };
        let absent = files.iter().enumerate();
        let absent = absent.filter(|(_, file)| file.path.is_none());
        let absent = absent.map(|(photo, _)| photo);
        Ok(Self {
            sights: vec![None; pairs.len()],
            pairs,
            kept: BTreeMap::new(),
            fitting: BTreeSet::new(),
            absent: absent.collect(),
        })
    }

    /// Whether a photo is compared with another.
    pub fn wants(&self, photo: usize) -> bool {
        self.pairs.iter().any(|pair| pair.contains(&photo))
    }

    /// Takes a photo, which is that of [`for_comparing`](crate::picture::for_comparing), and compares it with those beside it that were
    /// read before.
    pub fn take(&mut self, flight: &Flight, photo: usize, small: &RgbImage, progress: &Progress) {
        if !self.wants(photo) {
            return;
        }
        let posed = &flight.parts().photos[photo];
        let small = SmallPhoto::of(small, flight.camera(posed));
        let (grid, image) = (Patches::grid(&small), ImageKind::Undistorted);
        // What shows no surface is compared with nothing.
        let Ok(field) = flight.field(posed, image, grid, progress) else {
            self.give_up(photo);
            return;
        };
        let own = Patches::of(&small, &field);
        for (pair, sight) in self.pairs.iter().zip(&mut self.sights) {
            let other = match *pair {
                [first, second] if first == photo => second,
                [first, second] if second == photo => first,
                _ => continue,
            };
            if let Some((its_small, its_field)) = self.kept.get(&other) {
                let its = Patches::of(its_small, its_field);
                let in_other = seen_at(&own, &sighted(flight, other, its_small));
                let in_own = seen_at(&its, &sighted(flight, photo, &small));
                *sight = Some(PairSight::of(in_other, in_own));
            }
        }
        self.kept.insert(photo, (small, field));
        self.forget_done();
    }

    /// What a photo's colours say: where they are those of the surface, and it is like another one at no distance, that one is to
    /// blame.
    pub fn take_colours(&mut self, photo: usize, colours: &ColoursFound) {
        if *colours == ColoursFound::NothingAgainst {
            self.fitting.insert(photo);
        }
    }

    /// Nothing comes of a photo: nobody waits for it any more.
    pub fn give_up(&mut self, photo: usize) {
        if !self.wants(photo) {
            return;
        }
        let pairs = self.pairs.iter().copied().zip(self.sights.iter().copied());
        (self.pairs, self.sights) = pairs.filter(|(pair, _)| !pair.contains(&photo)).unzip();
        self.forget_done();
    }

    /// Forgets those that wait for nobody.
    fn forget_done(&mut self) {
        let waits = |of: usize| {
            let mut open = self.pairs.iter().zip(&self.sights);
            open.any(|(pair, sight)| sight.is_none() && pair.contains(&of))
        };
        let done: Vec<usize> = self.kept.keys().copied().filter(|of| !waits(*of)).collect();
        for of in done {
            self.kept.remove(&of);
        }
    }

    /// What the photos that were compared see, each with its place in the flight; of the others what follows from these.
    pub fn found(&self, flight: &Flight) -> Vec<(usize, Together)> {
        let photos = &flight.parts().photos;
        let of_photo = |photo: usize| {
            let its = self
                .pairs
                .iter()
                .zip(&self.sights)
                .filter_map(|(pair, sight)| {
                    let other = pair.iter().find(|of| **of != photo)?;
                    pair.contains(&photo).then_some((*other, (*sight)?))
                });
            said_by(&its.collect::<Vec<_>>())
        };
        let mut said: Vec<_> = (0..photos.len()).map(of_photo).collect();
        for photo in &self.fitting {
            if let Some(Some((_, sight @ PairSight::Nowhere))) = said.get_mut(*photo) {
                *sight = PairSight::Unclear;
            }
        }
        let fits = !self.fitting.is_empty();
        doubt_strangers(said.iter_mut().flatten().map(|(_, sight)| sight), fits);
        let sights = || said.iter().flatten().map(|(_, sight)| sight);
        let elsewhere = all_elsewhere(sights())
            .map(|(photos, factor)| Together::OthersElsewhere { photos, factor });
        let nowhere = none_tells(sights()).filter(|_| !fits);
        let nowhere = nowhere.map(|photos| Together::OthersNowhere { photos });
        // Of those that do not tell. Where the surface is elsewhere it is so for a photo without a file, too.
        let of_others = |photo: usize| match &elsewhere {
            None if self.absent.contains(&photo) => None,
            None => nowhere.clone(),
            elsewhere => elsewhere.clone(),
        };
        let all = said.into_iter().enumerate();
        let together = all.filter_map(|(photo, said)| {
            let pair = said.map(|(other, sight)| Together::Pair {
                other: photos[other].name.clone(),
                sight,
            });
            let tells = said.is_some_and(|(_, sight)| sight != PairSight::Unclear);
            let of_others = of_others(photo).filter(|_| !tells);
            Some((photo, of_others.or(pair)?))
        });
        together.collect()
    }
}

/// How many photos see the surface elsewhere, and at how many times its distance (their median), where none sees it in its
/// place: then nothing speaks for it under the others. (Of 379 photos of right flights none saw it elsewhere.)
fn all_elsewhere<'a>(sights: impl Iterator<Item = &'a PairSight>) -> Option<(usize, f64)> {
    let mut factors = Vec::new();
    for sight in sights {
        match sight {
            PairSight::There(_) | PairSight::Partly(_) => return None,
            PairSight::Elsewhere(seen) => factors.push(seen.factor),
            PairSight::Nowhere | PairSight::Unclear => {}
        }
    }
    Some((factors.len(), median(&mut factors)?))
}

/// How many photos were compared, where none tells where the surface is, and most are alike with those beside them at no distance or
/// they are many: then nothing speaks for the others, either.
fn none_tells<'a>(sights: impl Iterator<Item = &'a PairSight>) -> Option<usize> {
    let (mut strangers, mut unclear) = (0, 0);
    for sight in sights {
        match sight {
            PairSight::Nowhere => strangers += 1,
            PairSight::Unclear => unclear += 1,
            PairSight::There(_) | PairSight::Partly(_) | PairSight::Elsewhere(_) => return None,
        }
    }
    let photos = strangers + unclear;
    (strangers > unclear || photos >= NONE_OF_SO_MANY).then_some(photos)
}

/// Two photos that are alike at no distance may be of other light, or of leaves and water. They speak against themselves where others of
/// their flight tell, by their stones or by their colours (`fits`), or where there are more such photos.
fn doubt_strangers<'a>(sights: impl Iterator<Item = &'a mut PairSight>, fits: bool) {
    let all: Vec<&mut PairSight> = sights.collect();
    let count = |is: fn(&PairSight) -> bool| all.iter().filter(|sight| is(sight)).count();
    let strangers = count(|sight| matches!(sight, PairSight::Nowhere));
    let telling = count(|sight| !matches!(sight, PairSight::Nowhere | PairSight::Unclear));
    if telling == 0 && !fits && strangers < 3 {
        let strangers = all.into_iter();
        let strangers = strangers.filter(|sight| matches!(sight, PairSight::Nowhere));
        strangers.for_each(|sight| *sight = PairSight::Unclear);
    }
}

/// What the pairs of a photo say of it, each with the other photo. One of two pairs may be wrong by the other photo's error: the surface is
/// elsewhere if more of them see it elsewhere, or not in all, than where it is.
fn said_by(pairs: &[(usize, PairSight)]) -> Option<(usize, PairSight)> {
    let tells = |sight: &PairSight| match sight {
        PairSight::There(off) => -off,
        PairSight::Partly(share) => -share,
        PairSight::Elsewhere(seen) => seen.there,
        PairSight::Nowhere | PairSight::Unclear => 0.0,
    };
    let best = |wanted: fn(&PairSight) -> bool| {
        let wanted = pairs.iter().filter(|(_, sight)| wanted(sight));
        let best = wanted
            .clone()
            .max_by(|a, b| tells(&a.1).total_cmp(&tells(&b.1)));
        (best, wanted.count())
    };
    let (there, of_there) = best(|sight| matches!(sight, PairSight::There(_)));
    let (elsewhere, of_elsewhere) = best(|sight| matches!(sight, PairSight::Elsewhere(_)));
    let (partly, of_partly) = best(|sight| matches!(sight, PairSight::Partly(_)));
    let said = match of_elsewhere + of_partly > of_there {
        true => elsewhere.or(partly),
        false => there,
    };
    let (stranger, _) = best(|sight| matches!(sight, PairSight::Nowhere));
    said.or(stranger).or(pairs.first()).copied()
}

fn sighted<'a>(flight: &'a Flight, photo: usize, small: &'a SmallPhoto) -> Sighted<'a> {
    let posed = &flight.parts().photos[photo];
    Sighted {
        photo: small,
        camera: flight.camera(posed),
        pose: &posed.pose,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elsewhere(there: f64) -> PairSight {
        PairSight::Elsewhere(SeenAt {
            factor: 1.1,
            there,
            here: 0.0,
            is_elsewhere: true,
            share: 1.0,
            part_elsewhere: None,
        })
    }

    /// One of two pairs may be wrong by the other photo's pose.
    #[test]
    fn more_pairs_than_not_speak_against_a_photo() {
        let there = PairSight::There(0.001);
        for (pairs, wanted) in [
            (vec![(1, elsewhere(0.3)), (2, there)], (2, there)),
            (
                vec![(1, elsewhere(0.3)), (2, PairSight::Unclear)],
                (1, elsewhere(0.3)),
            ),
            (
                vec![(1, elsewhere(0.2)), (2, there), (3, elsewhere(0.4))],
                (3, elsewhere(0.4)),
            ),
            (vec![(1, PairSight::There(0.004)), (2, there)], (2, there)),
            (vec![(4, PairSight::Unclear)], (4, PairSight::Unclear)),
            (
                vec![(1, PairSight::Partly(0.5)), (2, PairSight::Partly(0.4))],
                (2, PairSight::Partly(0.4)),
            ),
            (vec![(1, PairSight::Partly(0.5)), (2, there)], (2, there)),
            (
                vec![(4, PairSight::Unclear), (5, PairSight::Nowhere)],
                (5, PairSight::Nowhere),
            ),
            (vec![(5, PairSight::Nowhere), (6, there)], (6, there)),
        ] {
            assert_eq!(said_by(&pairs), Some(wanted), "{pairs:?}");
        }
        assert_eq!(said_by(&[]), None);
    }

    /// One pair alone may be of two lights; beside others that tell, or several of them, it is of other photos.
    #[test]
    fn photos_that_are_like_none_beside_them_are_doubted() {
        let there = PairSight::There(0.001);
        let (stranger, unclear) = (PairSight::Nowhere, PairSight::Unclear);
        for (sights, wanted) in [
            (vec![stranger, stranger], vec![unclear, unclear]),
            (vec![stranger, there], vec![stranger, there]),
            (
                vec![stranger, unclear, stranger, stranger],
                vec![stranger, unclear, stranger, stranger],
            ),
        ] {
            let mut found = sights.clone();
            doubt_strangers(found.iter_mut(), false);
            assert_eq!(found, wanted, "{sights:?}");
            let mut found = sights.clone();
            doubt_strangers(found.iter_mut(), true);
            assert_eq!(found, sights);
        }
    }

    /// Nothing speaks for a photo that was compared with none where all that were are of other rock, or many do not tell.
    #[test]
    fn where_none_that_could_tells_all_are_doubted() {
        let (stranger, unclear) = (PairSight::Nowhere, PairSight::Unclear);
        let there = PairSight::There(0.001);
        let of = |sights: &[PairSight]| none_tells(sights.iter());
        assert_eq!(of(&[stranger, unclear, stranger]), Some(3));
        assert_eq!(of(&[stranger, there, stranger, stranger]), None);
        assert_eq!(of(&[unclear, unclear, unclear]), None);
        assert_eq!(of(&[stranger, unclear, unclear]), None);
        assert_eq!(of(&[unclear, unclear, unclear, unclear]), Some(4));
        assert_eq!(of(&[unclear, unclear, unclear, there]), None);
    }

    /// A photo that does not tell is no surer than those of its flight that do.
    #[test]
    fn where_none_sees_the_surface_in_its_place_all_are_doubted() {
        let there = PairSight::There(0.001);
        let unclear = PairSight::Unclear;
        let far = elsewhere(0.3);
        assert_eq!(all_elsewhere([far, unclear, far].iter()), Some((2, 1.1)));
        assert_eq!(all_elsewhere([far, there, far].iter()), None);
        assert_eq!(all_elsewhere([unclear].iter()), None);
    }
}

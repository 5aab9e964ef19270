//! What came from one file or one pasted table.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::fault::Fault;
use crate::flight::{Decision, ScaleObject};
use crate::fragmentation::DistributionSet;
use crate::units::LengthUnit;

/// Size distributions that were added together.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// The file's name, or "Pasted table 1".
    pub name: String,
    /// The file.
    pub path: Option<PathBuf>,
    /// As read.
    pub set: DistributionSet,
    /// What was noticed while reading.
    pub warnings: Vec<String>,
    /// What it was made of, where it is of photos' fragments.
    pub fragments: Option<OfFragments>,
}

/// What a curve of fragments was made of: when it is another one, so is the curve.
#[derive(Debug, Clone, PartialEq)]
pub struct OfFragments {
    /// The flight's file.
    pub flight: PathBuf,
    /// By its place in the flight; `None`: of all photos that are outlined.
    pub photo: Option<usize>,
    /// Their outlines.
    pub made_of: MadeOf,
}

/// What sizes of fragments follow from: with another one they are others.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeOf {
    /// Of those photos whose outlines are not as their files have them, which revision.
    pub revisions: Vec<(usize, u64)>,
    /// What is taken off the outlines.
    pub objects: Vec<ScaleObject>,
    /// Which photos are left out.
    pub decisions: Vec<Decision>,
    /// Of the world's lengths.
    pub unit: LengthUnit,
}

impl MadeOf {
    /// What those of one photo alone follow from.
    #[must_use]
    pub fn of_photo(mut self, photo: usize, name: &str) -> Self {
        self.revisions.retain(|(of, _)| *of == photo);
        self.objects.retain(|object| object.photo == name);
        self.decisions.clear();
        self
    }
}

impl Source {
    /// What a file holds. Curves without a method are called after their file.
    pub fn of_file(path: &Path, set: DistributionSet, warnings: Vec<String>) -> Self {
        let name = |part: Option<&std::ffi::OsStr>| {
            part.map_or_else(String::new, |part| part.to_string_lossy().into_owned())
        };
        let stem = name(path.file_stem());
        let mut set = set;
        set.name_method(&stem);
        Self {
            name: name(path.file_name()),
            path: Some(path.to_owned()),
            set,
            warnings,
            fragments: None,
        }
    }

    /// Whether it is in no file but a table that is written of it.
    pub fn is_pasted(&self) -> bool {
        self.path.is_none() && self.fragments.is_none()
    }

    /// Whether another one is of the same photo of the same flight, outlined by the same engine, or of one of its photos where this is
    /// of all: it takes that one's place.
    pub fn replaces(&self, other: &Self) -> bool {
        let of = |source: &Self| {
            let of = source.fragments.as_ref()?;
            let method = source.set.curves.first()?.labels.method.clone();
            Some((of.photo, (of.flight.clone(), method)))
        };
        let (Some((photo, own)), Some((other, others))) = (of(self), of(other)) else {
            return false;
        };
        own == others && (photo.is_none() || photo == other)
    }

    /// Makes its curves differ in their labels from those of `others`: where a trial has no name, it
    /// is called after this source, and that is said.
    ///
    /// # Errors
    /// Where curves with the same labels are there already.
    pub fn set_apart(&mut self, others: &[Arc<Self>]) -> Result<(), Fault> {
        let others: Vec<_> = others.iter().map(|o| (o.name.as_str(), &o.set)).collect();
        let of_flight = self.fragments.as_ref().map(|of| of.flight.as_path());
        let stem = match of_flight {
            Some(flight) => flight.parent().and_then(Path::file_name),
            None => self.path.as_deref().and_then(Path::file_stem),
        };
        let stem = stem.map_or_else(
            || self.name.clone(),
            |stem| stem.to_string_lossy().into_owned(),
        );
        let said = self.set.set_apart(&stem, &others)?;
        self.warnings.extend(said);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(flight: &str, photo: Option<usize>, method: &str) -> Source {
        let table = format!("method,size_mm,passing\n{method},1,20\n{method},2,80\n");
        let columns = crate::formats::DistributionColumns::default();
        let (set, _) = crate::formats::size_distributions(&table, &columns).unwrap();
        Source {
            name: "Fragments of DJI_0001.JPG".to_owned(),
            path: None,
            set,
            warnings: Vec::new(),
            fragments: Some(OfFragments {
                flight: PathBuf::from(flight),
                photo,
                made_of: MadeOf {
                    revisions: Vec::new(),
                    objects: Vec::new(),
                    decisions: Vec::new(),
                    unit: LengthUnit::Metre,
                },
            }),
        }
    }

    /// Drones call the first photo of each card alike.
    #[test]
    fn photos_of_two_flights_stand_beside_each_other() {
        let first = of("north/flight.toml", Some(0), "learned");
        assert!(of("north/flight.toml", Some(0), "learned").replaces(&first));
        assert!(!of("north/flight.toml", Some(0), "classical").replaces(&first));
        assert!(!of("north/flight.toml", Some(1), "learned").replaces(&first));
        // All photos of a flight have its single ones among them.
        let all = of("north/flight.toml", None, "learned");
        assert!(all.replaces(&first) && !first.replaces(&all) && all.replaces(&all));
        assert!(!of("south/flight.toml", None, "learned").replaces(&first));
        let mut other = of("south/flight.toml", Some(0), "learned");
        assert!(!other.replaces(&first));
        other.set_apart(&[Arc::new(first)]).unwrap();
        assert_eq!(other.set.curves[0].labels.trial, "south");
    }
}

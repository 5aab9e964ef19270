//! What somebody knows about a reconstruction's place in the world.

use std::path::PathBuf;
use std::str::FromStr;

use glam::DVec3;

use crate::control::ControlList;
use crate::formats::Reconstruction;
use crate::formats::photos::photo_folder::{PhotoFolder, WantedPhoto};

/// What is known about a reconstruction's place in the world.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GeoreferenceRequest {
    /// The folder of the photos: their own positions, where nothing else is given, and their sizes.
    pub photos: Option<PathBuf>,
    /// Whether nobody named that folder, but the package leads to it: then the folders within it may be of other flights.
    pub photos_are_packages: bool,
    /// A list of the photos' positions.
    pub positions: Option<PathBuf>,
    /// Ground control points; with positions as well, those are only compared.
    pub control_points: Option<PathBuf>,
    /// The same as they were marked in the window, instead of a list.
    pub marked: Option<ControlList>,
    /// Known distances: the scale. The place is then that of [`positions`](Self::positions) or of the photos' own, where there
    /// are any, it is not to be level, and no points were marked in the window.
    pub distances: Vec<KnownDistance>,
    /// The coordinate system of the world, and of lists that state none.
    pub crs: Option<String>,
    /// With distances: whether to turn the plane of the reconstruction's points level.
    pub level: bool,
}

impl GeoreferenceRequest {
    /// The folder of a model's photos: one that somebody named is looked through with the folders in it.
    pub(super) fn photo_folder(&self, model: &Reconstruction) -> PhotoFolder<'_> {
        let path = self.photos.as_deref();
        if self.photos_are_packages {
            return PhotoFolder::new(path);
        }
        let are_known = model.sizes.are_known();
        let photos = model.photos.iter().map(|photo| {
            let camera = model.cameras.get(photo.camera).filter(|_| are_known);
            let named = model.named_sizes.get(&photo.name).copied();
            let size = named.or(camera.map(|camera| (camera.width, camera.height)));
            (photo.name.as_str(), size)
        });
        let photos: Vec<WantedPhoto<'_>> = photos.collect();
        PhotoFolder::named(path, &photos)
    }
}

/// What there is to say of photos that are known by their size among others of their names.
pub(super) fn chosen_by_size(photos: &PhotoFolder<'_>) -> Option<String> {
    let said = photos.chosen_by_size()?;
    Some(format!("{}: {said}", photos.folder?.display()))
}

/// A known distance between two points.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownDistance {
    /// The two points.
    pub ends: KnownEnds,
    /// In metres.
    pub metres: f64,
}

/// Two points that have a known distance.
#[derive(Debug, Clone, PartialEq)]
pub enum KnownEnds {
    /// In the reconstruction's frame.
    Points(DVec3, DVec3),
    /// Names of control points with marks.
    Names(String, String),
}

impl FromStr for KnownDistance {
    type Err = String;

    /// Reads "x1,y1,z1 x2,y2,z2 12.5" or "name1 name2 12.5", the distance in metres.
    fn from_str(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let [a, b, metres] = words[..] else {
            return Err("give two points and their distance, \"x1,y1,z1 x2,y2,z2 12.5\" or \"name1 name2 12.5\"".to_owned());
        };
        let metres = match metres.parse() {
            Ok(metres) if metres > 0.0 && f64::is_finite(metres) => metres,
            _ => return Err(format!("'{metres}' is no distance above 0 in metres")),
        };
        let point = |text: &str| {
            let numbers: Result<Vec<f64>, _> = text.split(',').map(str::parse).collect();
            let numbers: [f64; 3] = numbers.ok()?.try_into().ok()?;
            Some(DVec3::from_array(numbers)).filter(|point| point.is_finite())
        };
        let ends = match (point(a), point(b)) {
            (Some(a), Some(b)) => KnownEnds::Points(a, b),
            (None, None) => KnownEnds::Names(a.to_owned(), b.to_owned()),
            _ => return Err("give two points as x,y,z or two names".to_owned()),
        };
        Ok(Self { ends, metres })
    }
}

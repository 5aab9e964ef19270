//! Which photos and cameras of the folder those of a model are: engines number them as they like.

use std::collections::{HashMap, HashSet};

use cumulus3d_core::Reconstruction;

use crate::photo_set::{LeftOut, PhotoSet, SurveyCamera, SurveyPhoto};

/// The photos and cameras of a model's identifiers.
pub(crate) struct Whose<'a> {
    photos: HashMap<u32, &'a SurveyPhoto>,
    cameras: HashMap<u32, &'a SurveyCamera>,
    all: &'a PhotoSet,
}

impl<'a> Whose<'a> {
    /// By the names of a model's photos, whether they have a pose or not.
    pub(crate) fn of(model: &Reconstruction, all: &'a PhotoSet) -> Self {
        let named = all.photos.iter().map(|photo| (photo.name.as_str(), photo));
        let named: HashMap<&str, &SurveyPhoto> = named.collect();
        let (mut photos, mut cameras) = (HashMap::new(), HashMap::new());
        for image in model.images() {
            let Some(&photo) = named.get(image.name.as_str()) else {
                continue;
            };
            photos.insert(image.image_id, photo);
            cameras.insert(image.camera_id, &all.cameras[photo.camera]);
        }
        Self {
            photos,
            cameras,
            all,
        }
    }

    /// The same of a model of the same photos that has other cameras.
    pub(crate) fn again(&self, model: &Reconstruction) -> Self {
        Self::of(model, self.all)
    }

    /// The photo that an engine calls so.
    pub(crate) fn photo(&self, image: u32) -> Option<&'a SurveyPhoto> {
        self.photos.get(&image).copied()
    }

    /// The cameras, with what the engine calls them.
    pub(crate) fn cameras(&self) -> impl Iterator<Item = (u32, &'a SurveyCamera)> {
        self.cameras.iter().map(|(&id, &camera)| (id, camera))
    }

    /// Photos of the folder that have no pose in the model, and of which `known` does not say why.
    pub(crate) fn missing(
        &self,
        model: &Reconstruction,
        known: &[LeftOut],
    ) -> Vec<&'a SurveyPhoto> {
        let placed = model.registered_images().into_iter();
        let placed = placed.filter_map(|image| Some(self.photo(image)?.name.as_str()));
        let explained = known.iter().map(|out| out.photo.as_str());
        let settled: HashSet<&str> = placed.chain(explained).collect();
        let photos = self.all.photos.iter();
        photos
            .filter(|photo| !settled.contains(photo.name.as_str()))
            .collect()
    }
}

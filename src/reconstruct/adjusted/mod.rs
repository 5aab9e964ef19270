//! What an engine found, brought to where the photos were taken and adjusted with those places: one policy
//! for all engines, so that their poses, lenses and standard errors are of the same kind.
//!
//! ```text
//! whose         which photos and cameras of the folder those of a model are
//! bundle        poses, points and lenses adjusted together
//! given_lens    calibrations that are kept
//! placing       the model brought to the photos' places, and adjusted with them
//! own_lens      photos that may have been zoomed
//! level         which way is up without places
//! stray         points that stand alone
//! model_files   what comes out
//! in_order      photos numbered as in the folder
//! conversions   cumulus3d's points and poses as ours, and back
//! guarded       what cumulus3d does when something goes wrong
//! ```

mod bundle;
mod conversions;
mod given_lens;
mod guarded;
mod in_order;
mod level;
mod model_files;
mod own_lens;
mod placing;
mod stray;
mod whose;

use std::path::Path;

pub(crate) use self::bundle::{Adjustment, Weighed, adjust};
pub(crate) use self::conversions::{point, pose};
pub(crate) use self::guarded::{failed, guarded, not_waited_for};
pub(crate) use self::in_order::in_order;
pub(crate) use self::model_files::read;
pub(crate) use self::whose::Whose;

use self::given_lens::GivenLenses;
use crate::engine::{Found, Sparse};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::photo_set::{LeftOut, PhotoSet};

/// Photos at least that a model is worth having of.
pub(crate) const FEWEST_PHOTOS: usize = 3;

/// What to say where no model has so many.
pub(crate) fn too_little_in_common() -> Fault {
    Fault::new(
        "no three photos show the same from different places",
        "take photos that overlap by two thirds, from places apart",
    )
}

/// The model that goes into the flight. `work` is the folder of unfinished work.
///
/// # Errors
/// Where it holds too few photos, the adjustment has no solution, the model cannot be written, or the work
/// was cancelled.
pub(crate) fn adjusted(
    found: Found,
    photos: &PhotoSet,
    work: &Path,
    progress: &Progress,
) -> Result<Sparse, Fault> {
    guarded(|| {
        let Found {
            mut model,
            mut left_out,
        } = found;
        if model.registered_image_count() < FEWEST_PHOTOS {
            return Err(too_little_in_common());
        }
        let whose = Whose::of(&model, photos);
        stray::remove(&mut model);
        let given = GivenLenses::of(&model, &whose);
        if let Some(given) = &given {
            given.as_pinholes(&mut model, photos)?;
        }
        placing::place(&mut model, &whose, progress)?;
        // Adjusted, rays of two photos that hardly cross may meet a hundred metres off.
        stray::remove(&mut model);
        if let Some(given) = &given {
            given.as_shot(&mut model, photos)?;
        }
        progress.stage("colouring points");
        model_files::colour(&mut model, &whose, progress)?;
        let missing = whose.missing(&model, &left_out).into_iter();
        left_out.extend(missing.map(|photo| LeftOut {
            photo: photo.name.clone(),
            why: "it shows too little of what the others show".to_owned(),
        }));
        let mut files = model_files::files(&model, work)?;
        if let (Some(given), [(_, cameras), ..]) = (&given, &mut files) {
            *cameras = given.write(cameras);
        }
        Ok(Sparse { files, left_out })
    })
}

//! Where a reconstruction stands on the Earth, and how well its receivers placed it.

use std::collections::HashMap;

use glam::{DMat3, DVec3};

use super::OpenSfm;
use super::frame::{Frame, Hint, frame_of};
use super::reference::{RawReference, enu_origin, measured_positions, scale_error_of};
use crate::fault::Fault;
use crate::geometry::Similarity;
use crate::text::json::parse;

impl OpenSfm {
    /// Takes the origin of a `reference_lla.json` that lies beside, where the file states none itself.
    ///
    /// # Errors
    /// Where it is no JSON of that shape.
    pub(super) fn add_reference(&mut self, json: &[u8]) -> Result<(), Fault> {
        let reference: RawReference = parse(json)?;
        if let Some(origin) = enu_origin(reference)
            && self.reconstruction.enu_origin.is_none()
        {
            self.reconstruction.enu_origin = Some(origin);
            let warnings = &mut self.reconstruction.warnings;
            let positions = measured_positions(&self.measured, Some(origin), warnings);
            self.reconstruction.measured_positions = positions;
        }
        Ok(())
    }

    /// Puts the reconstruction where it stands on the Earth, if it has a reference: that depends on
    /// which frame it is in, which nothing states. Warns where that is not what OpenSfM writes.
    pub(super) fn place(&mut self, hint: Hint) {
        let Some((frame, said)) = self.frame(hint) else {
            return;
        };
        let reconstruction = &mut self.reconstruction;
        reconstruction.warnings.extend(said);
        match frame {
            Frame::Topocentric => {}
            Frame::Unknown => reconstruction.enu_origin = None,
            Frame::Projected { crs, offset } => {
                let offset = Similarity::new(1.0, DMat3::IDENTITY, offset.extend(0.0));
                reconstruction.transform(&offset);
                reconstruction.enu_origin = None;
                reconstruction.crs = Some(crs);
            }
        }
    }

    /// The standard error of all lengths in percent by its receivers' positions, where they placed it.
    pub(crate) fn scale_error_by_receivers(&self) -> Option<f64> {
        let photos = self.reconstruction.photos.iter();
        let centers: HashMap<&str, DVec3> = photos
            .map(|photo| (photo.name.as_str(), photo.pose.center))
            .collect();
        let pairs = self.measured.iter().filter_map(|one| {
            let solved = centers.get(one.photo.as_str())?;
            Some((*solved, one.position))
        });
        scale_error_of(&pairs.collect::<Vec<_>>())
    }

    /// The sentence that says so where the photos' positions tell that OpenDroneMap has put projected
    /// coordinates less an offset into it.
    pub(crate) fn said_to_be_projected(&self) -> Option<String> {
        match self.frame(Hint::None)? {
            (Frame::Projected { .. }, said) => said,
            _ => None,
        }
    }

    /// The frame that it is in, with what there is to say; `None` where it has no reference.
    fn frame(&self, hint: Hint) -> Option<(Frame, Option<String>)> {
        let origin = self.reconstruction.enu_origin?;
        let photos = self.reconstruction.photos.iter();
        let centers: HashMap<&str, DVec3> = photos
            .map(|photo| (photo.name.as_str(), photo.pose.center))
            .collect();
        let pairs: Vec<(DVec3, DVec3)> = self
            .measured
            .iter()
            .filter_map(|one| Some((one.position, *centers.get(one.photo.as_str())?)))
            .collect();
        Some(frame_of(&pairs, origin, hint))
    }
}

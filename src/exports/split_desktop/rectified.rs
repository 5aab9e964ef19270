//! The rectified photos of an export: for programs that know one scale for the whole image.

use image::RgbImage;
use serde_json::json;

use super::ExportRequest;
use super::plan::PhotoNames;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::scale::{Onto, PixelSize};
use crate::{RectifiedFormat, RectifiedPhoto};

/// A format that every such program reads.
pub(super) const FORMAT: RectifiedFormat = RectifiedFormat::Png;

/// What a rectified photo depends on besides the photo and its scales, which stand for the surface.
/// `None` where none is asked for.
pub(super) fn depends_on(request: &ExportRequest<'_>, index: usize) -> Option<String> {
    let parts = request.review.flight().parts();
    let onto = match request.rectified? {
        Onto::FittedPlane => "fit",
        Onto::HorizontalPlane => "horizontal",
        Onto::Surface => "ortho",
    };
    let pose = &parts.photos.get(index)?.pose;
    let what = json!([
        onto,
        pose.center.to_array(),
        pose.rotation.to_cols_array(),
        parts.name,
        parts.unit.symbol(),
        request.from.crs,
    ]);
    Some(what.to_string())
}

/// The picture and its world file, with their names below the exported folder; none where they are
/// not asked for. `photo` is as shot.
///
/// # Errors
/// Where the photo cannot be rectified.
pub(super) fn files(
    request: &ExportRequest<'_>,
    index: usize,
    names: &PhotoNames,
    photo: &RgbImage,
    progress: &Progress,
) -> Result<Vec<(String, Vec<u8>)>, Fault> {
    let flight = request.review.flight();
    let parts = flight.parts();
    let (Some(onto), Some([picture, world]), Some(of)) =
        (request.rectified, &names.rectified, parts.photos.get(index))
    else {
        return Ok(Vec::new());
    };
    let size = PixelSize {
        asked: None,
        round_in: request.unit.in_units_of(parts.unit),
    };
    let rectification = flight.rectification(of, onto, size, progress)?;
    let rectified = RectifiedPhoto {
        rectification: &rectification,
        onto,
        flight: &parts.name,
        photo: &of.name,
        unit: request.unit,
        world_unit: parts.unit,
        crs: request.from.crs,
    };
    let bytes = rectified.bytes(photo, FORMAT)?;
    Ok(vec![
        (picture.clone(), bytes),
        (world.clone(), rectified.world_file().into_bytes()),
    ])
}

//! The rectified photos of an export: for programs that know one scale for the whole image.

use std::borrow::Cow;

use glam::DVec2;
use image::RgbImage;
use serde_json::json;

use super::ExportRequest;
use super::objects::PhotoObject;
use super::photo_names::PhotoNames;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::picture;
use crate::scale::PixelSize;
use crate::{RectifiedFormat, RectifiedPhoto};

/// A format that every such program reads.
pub(super) const FORMAT: RectifiedFormat = RectifiedFormat::Png;

/// What a rectified photo depends on besides the photo and its scales, which stand for the surface.
/// `None` where none is asked for.
pub(super) fn depends_on(request: &ExportRequest<'_>, index: usize) -> Option<String> {
    let parts = request.review.flight().parts();
    let pose = &parts.photos.get(index)?.pose;
    let what = json!([
        request.rectified?.name(),
        pose.center.to_array(),
        pose.rotation.to_cols_array(),
        parts.name,
        parts.unit.symbol(),
        request.from.crs,
    ]);
    Some(what.to_string())
}

/// A rectified photo's files, with their names below the exported folder.
#[derive(Default)]
pub(super) struct Made {
    pub files: Vec<(String, Vec<u8>)>,
    /// What is to be said of them.
    pub doubt: Option<&'static str>,
}

/// The picture and its world file; none where they are not asked for. `photo` is as shot; of it the
/// regions of `objects` are painted over.
///
/// # Errors
/// Where the photo cannot be rectified.
pub(super) fn files(
    request: &ExportRequest<'_>,
    index: usize,
    names: &PhotoNames,
    photo: &RgbImage,
    objects: &[PhotoObject<'_>],
    progress: &Progress,
) -> Result<Made, Fault> {
    let flight = request.review.flight();
    let parts = flight.parts();
    let (Some(onto), Some([picture, world]), Some(of)) =
        (request.rectified, &names.rectified, parts.photos.get(index))
    else {
        return Ok(Made::default());
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
    let masked = objects.iter().filter(|object| object.is_masked());
    let regions: Vec<Vec<DVec2>> = masked
        .map(|object| object.region_as_shot().clone())
        .collect();
    let mut photo = Cow::Borrowed(photo);
    if !regions.is_empty() {
        picture::paint_regions(photo.to_mut(), &regions);
    }
    let bytes = rectified.bytes(&photo, FORMAT)?;
    Ok(Made {
        files: vec![
            (picture.clone(), bytes),
            (world.clone(), rectified.world_file().into_bytes()),
        ],
        doubt: rectification.doubt(),
    })
}

//! VisualSFM's N-View Match, NVM_V3, from VisualSFM's documentation ("The output format: N-View
//! Match", ccwu.me/vsfm/doc.html#nvm) and the reader in its Multicore Bundle Adjustment.
//!
//! ```text
//! NVM_V3 [FixedK fx cx fy cy [r]]
//! <model> <model> ... 0          a count of 0 photos ends the models
//! <PLY section>                  not read
//!
//! <model> = count of photos, then one line each:
//!             name f qw qx qy qz cx cy cz r 0
//!           count of points, then one line each:
//!             x y z red green blue n, then n times: photo feature u v
//! ```
//!
//! - Empty lines may stand anywhere. White space in a name is written as `"` since V0.5.7; a name
//!   with real spaces reads too, because ten numbers end the line.
//! - q is the rotation of `camera_from_world` (x right, y down, z forward), c the camera CENTRE.
//! - r acts on the MEASURED point, in focal lengths: `ideal = measured (1 + r |measured|2)`.
//! - f is in pixels, one for each photo, so each photo is a camera of its own here. The file has no
//!   image sizes: cx, cy are offsets from the middle of the image, 0, until the sizes are set.
//! - u v count from the principal point in the documentation, and from the top-left corner in files
//!   of recent versions (in `shared/data/sceaux-nvm` the points reproject to 0.76 px so). Which one
//!   it is shows in the signs: measurements around the middle have negative coordinates, measurements
//!   from the corner never do.
//! - FixedK is the calibration that the user gave for all photos ("Set Fixed Calibration"), in
//!   pixels from the top-left corner, so it needs no image size. Some writers give its cx, cy from
//!   the middle: taken so where both are less than a tenth of a focal length, because no photo is
//!   so narrow (11 degrees) that its middle lies there. r is the file's, where it is not 0.
//! - Only the first model that has a photo with a pose is read; the models do not share a frame. A
//!   model without points lists the photos that were not aligned; their numbers are 0, or the
//!   identity at the origin.
//! - NVM_V3_R9T, which Multicore Bundle Adjustment writes (a matrix and a translation), is refused.

use std::collections::HashSet;

use glam::{DVec2, DVec3};

use crate::camera::{Camera, Distortion, Pose, VisualSfm};
use crate::fault::Fault;

use crate::ImageUnit;
use crate::Observation;
use crate::Origin;
use crate::PosedPhoto;
use crate::Reconstruction;
use crate::Sizes;
use crate::text::fields::{Fields, shown};

const SAVE: &str = "save the workspace from VisualSFM again (SfM > Save NV Match)";

/// Reads the first model of an NVM_V3 file, in the model's own frame and unit.
///
/// The sizes are unknown: [`Reconstruction::set_sizes`] has to be told the photos' sizes. Cameras
/// and photos share their order and their names.
///
/// # Errors
/// Text that is not what the format says, or that holds no photo with a pose.
pub(crate) fn read(text: &str) -> Result<Reconstruction, Fault> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = Lines {
        inner: Box::new((1..).zip(text.lines())),
        last: 1,
    };
    let fixed = read_header(&mut lines)?;
    let mut found = Reconstruction {
        package: "visualsfm",
        ..Reconstruction::default()
    };
    let mut not_aligned = 0;
    while let Some(count) = lines.photo_count()? {
        let photos = read_photos(&mut lines, count)?;
        let (points_line, points) = lines.expect("the count of points")?;
        let points: u64 = only(points_line, points, "the count of points")?;
        let posed = posed(photos, points == 0);
        not_aligned += posed.iter().filter(|photo| photo.is_none()).count();
        if posed.iter().all(Option::is_none) {
            for _ in 0..points {
                lines.expect("a point")?;
            }
            continue;
        }
        let photo_of_index = add_photos(&mut found, posed, fixed);
        read_points(&mut lines, points, &photo_of_index, &mut found)?;
        break;
    }
    if found.photos.is_empty() {
        let remedy = "reconstruct the scene in VisualSFM and save it again (SfM > Save NV Match)";
        return Err(Fault::new("it holds no photo with a pose", remedy));
    }
    measure_from_one_origin(&mut found, fixed);
    let rest = skip_models(&mut lines, &mut found.warnings);
    not_aligned += usize::try_from(rest).unwrap_or(usize::MAX);
    if not_aligned > 0 {
        let warning = format!("{not_aligned} photos were not aligned and are left out");
        found.warnings.push(warning);
    }
    Ok(found)
}

/// The lines that are not empty, with their numbers from 1.
struct Lines<'a> {
    inner: Box<dyn Iterator<Item = (u64, &'a str)> + 'a>,
    last: u64,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<(u64, &'a str)> {
        let found = self.inner.find(|(_, line)| !line.trim().is_empty())?;
        self.last = found.0;
        Some(found)
    }

    fn expect(&mut self, what: &str) -> Result<(u64, &'a str), Fault> {
        let last = self.last;
        self.next()
            .ok_or_else(|| Fault::at(last, format!("the file ends before {what}"), SAVE))
    }

    /// How many photos the next model has; `None` after the last model.
    fn photo_count(&mut self) -> Result<Option<u64>, Fault> {
        let Some((line, text)) = self.next() else {
            return Ok(None);
        };
        let count = only(line, text, "the count of photos")?;
        Ok(Some(count).filter(|&count| count > 0))
    }
}

/// The whole number that a line consists of.
fn only(line: u64, text: &str, name: &str) -> Result<u64, Fault> {
    let mut fields = Fields::new(line, text, SAVE);
    let number = fields.whole(name)?;
    end(&fields)?;
    Ok(number)
}

fn end(fields: &Fields<'_>) -> Result<(), Fault> {
    match fields.rest() {
        "" => Ok(()),
        rest => Err(fields.fault(format!("'{}' where the line should end", shown(rest)))),
    }
}

/// The calibration that the user gave for all photos.
#[derive(Debug, Clone, Copy, PartialEq)]
struct FixedK {
    focal: DVec2,
    center: DVec2,
    /// Whether `center` counts from the top-left corner, else from the middle of the image.
    from_corner: bool,
    radial: f64,
}

fn read_header(lines: &mut Lines<'_>) -> Result<Option<FixedK>, Fault> {
    let (line, text) = lines.expect("the first line, NVM_V3")?;
    let mut fields = Fields::new(line, text, SAVE);
    let format = fields.word("NVM_V3")?;
    if format != "NVM_V3" {
        return Err(fields.fault(format!(
            "it starts with '{}'; only NVM_V3 is known",
            shown(format)
        )));
    }
    if fields.rest().is_empty() {
        return Ok(None);
    }
    let keyword = fields.word("FixedK")?;
    if keyword != "FixedK" {
        return Err(fields.fault(format!("'{}' where only FixedK can stand", shown(keyword))));
    }
    // Their order is fx cx fy cy.
    let x = fields.pair("FixedK's fx cx")?;
    let y = fields.pair("FixedK's fy cy")?;
    let radial = match fields.rest() {
        "" => 0.0,
        _ => fields.number("FixedK's r")?,
    };
    end(&fields)?;
    let (focal, center) = (DVec2::new(x.x, y.x), DVec2::new(x.y, y.y));
    if focal.min_element() <= 0.0 {
        return Err(fields.fault("FixedK's focal lengths must be positive"));
    }
    Ok(Some(FixedK {
        focal,
        center,
        from_corner: (center.abs() * 10.0).cmpge(focal).any(),
        radial,
    }))
}

/// One line of a model's photos.
struct Photo {
    name: String,
    focal: f64,
    /// `None` where the quaternion is 0.
    pose: Option<Pose>,
    radial: f64,
}

fn read_photos(lines: &mut Lines<'_>, count: u64) -> Result<Vec<Photo>, Fault> {
    let mut photos = Vec::new();
    let mut names = HashSet::new();
    for _ in 0..count {
        let (line, text) = lines.expect("the last of its photos")?;
        let photo = read_photo(line, text)?;
        if !names.insert(photo.name.clone()) {
            let what = format!("the photo '{}' is there twice", photo.name);
            return Err(Fault::at(line, what, SAVE));
        }
        photos.push(photo);
    }
    Ok(photos)
}

fn read_photo(line: u64, text: &str) -> Result<Photo, Fault> {
    const NUMBERS: usize = 10;
    let mut name = text.trim();
    for _ in 0..NUMBERS {
        // Without a name the first number is taken for it.
        name = name
            .rsplit_once(char::is_whitespace)
            .map(|(before, _)| before.trim_end())
            .ok_or_else(|| {
                let what = "a photo's line is its name and 10 numbers, this one is shorter";
                Fault::at(line, what, SAVE)
            })?;
    }
    let numbers = text.trim().get(name.len()..).unwrap_or_default();
    let mut fields = Fields::new(line, numbers, SAVE);
    let focal = fields.number("the focal length")?;
    let mut quaternion = [0.0; 4];
    for (part, name) in quaternion.iter_mut().zip(["qw", "qx", "qy", "qz"]) {
        *part = fields.number(name)?;
    }
    let center = fields.triple("the camera centre")?;
    let radial = fields.number("the radial term")?;
    fields.number("the last field, 0")?;
    let [w, x, y, z] = quaternion;
    let squared: f64 = quaternion.iter().map(|q| q * q).sum();
    if !squared.is_finite() {
        return Err(fields.fault("the quaternion is too large"));
    }
    let pose = if quaternion == [0.0; 4] {
        None
    } else {
        // The conjugate turns camera axes to the world.
        let pose = Pose::from_quaternion(center, [-x, -y, -z, w]);
        Some(pose.map_err(|e| fields.fault(e.to_string()))?)
    };
    let name = name.replace('"', " ").trim().to_owned();
    if name.is_empty() {
        return Err(fields.fault("the photo has no name"));
    }
    Ok(Photo {
        name,
        focal,
        pose,
        radial,
    })
}

/// The photos that have a pose, `None` in the place of each that was not aligned.
fn posed(photos: Vec<Photo>, without_points: bool) -> Vec<Option<(Photo, Pose)>> {
    let nowhere = Pose::from_quaternion(DVec3::ZERO, [0.0, 0.0, 0.0, 1.0]).ok();
    // One camera at the origin is how many a reconstruction starts, several are none.
    let at_nowhere = photos.iter().filter(|photo| photo.pose == nowhere).count();
    photos
        .into_iter()
        .map(|photo| {
            let pose = photo.pose?;
            let listed = without_points && at_nowhere > 1 && Some(pose) == nowhere;
            (photo.focal > 0.0 && !listed).then_some((photo, pose))
        })
        .collect()
}

/// Adds the photos with a camera for each; returns where each photo of the file went.
fn add_photos(
    found: &mut Reconstruction,
    photos: Vec<Option<(Photo, Pose)>>,
    fixed: Option<FixedK>,
) -> Vec<Option<u32>> {
    let mut photo_of_index = Vec::new();
    let mut next = 0;
    let mut other_focal = 0;
    for photo in photos {
        let Some((photo, pose)) = photo else {
            photo_of_index.push(None);
            continue;
        };
        let mut focal = DVec2::splat(photo.focal);
        let mut center = DVec2::ZERO;
        let mut radial = photo.radial;
        if let Some(fixed) = fixed {
            // The line repeats fx in fewer digits. Where it differs, the bundle adjustment moved on
            // from the given calibration.
            focal = fixed.focal;
            if (photo.focal / fixed.focal.x - 1.0).abs() > 1e-3 {
                focal *= photo.focal / fixed.focal.x;
                other_focal += 1;
            }
            center = fixed.center;
            if fixed.radial != 0.0 {
                radial = fixed.radial;
            }
        }
        found.photos.push(PosedPhoto {
            name: photo.name.clone(),
            camera: found.cameras.len(),
            pose,
        });
        found.cameras.push(Camera {
            name: photo.name,
            width: 0,
            height: 0,
            fx: focal.x,
            fy: focal.y,
            cx: center.x,
            cy: center.y,
            skew: 0.0,
            distortion: Distortion::VisualSfm(VisualSfm { k: radial }),
        });
        photo_of_index.push(Some(next));
        next += 1;
    }
    if other_focal > 0 {
        found.warnings.push(format!(
            "{other_focal} photos have another focal length than the fixed calibration of the \
             first line; theirs is used"
        ));
    }
    photo_of_index
}

fn read_points(
    lines: &mut Lines<'_>,
    count: u64,
    photo_of_index: &[Option<u32>],
    found: &mut Reconstruction,
) -> Result<(), Fault> {
    for _ in 0..count {
        let (line, text) = lines.expect("the last of its points")?;
        let mut fields = Fields::new(line, text, SAVE);
        let point = u32::try_from(found.cloud.points.len())
            .map_err(|_| fields.fault("more points than fragscale can count"))?;
        found.cloud.points.push(fields.triple("the position")?);
        found.cloud.colors.push(fields.color()?);
        let measurements: u64 = fields.whole("the count of measurements")?;
        for _ in 0..measurements {
            let index: usize = fields.whole("a measurement's photo")?;
            let Some(&photo) = photo_of_index.get(index) else {
                let photos = photo_of_index.len();
                return Err(fields.fault(format!(
                    "a measurement in photo {index}, where there are {photos}, counted from 0"
                )));
            };
            fields.word("a measurement's feature")?;
            let pixel = fields.pair("a measured x y")?;
            if let Some(photo) = photo {
                found.observations.push(Observation {
                    photo,
                    point,
                    pixel,
                });
            }
        }
        end(&fields)?;
    }
    Ok(())
}

/// Finds out where the measurements count from, and lets those around the principal point count
/// from where the principal point does.
fn measure_from_one_origin(found: &mut Reconstruction, fixed: Option<FixedK>) {
    let from_corner = fixed.is_some_and(|fixed| fixed.from_corner);
    let principal_points_from = match from_corner {
        true => Origin::Corner,
        false => Origin::Middle,
    };
    found.sizes = Sizes::Unknown {
        unit: ImageUnit::Pixel,
        principal_points_from,
    };
    let around_center = found
        .observations
        .iter()
        .any(|observation| observation.pixel.min_element() < 0.0);
    if around_center {
        found.observed_from = principal_points_from;
        let center = fixed.map_or(DVec2::ZERO, |fixed| fixed.center);
        for observation in &mut found.observations {
            observation.pixel += center;
        }
    }
}

/// Passes over the models after the one that is read, which are in frames of their own; returns how
/// many photos were not aligned.
fn skip_models(lines: &mut Lines<'_>, warnings: &mut Vec<String>) -> u64 {
    let mut not_aligned: u64 = 0;
    let mut models: Vec<String> = Vec::new();
    let mut skip = || -> Result<(), Fault> {
        while let Some(photos) = lines.photo_count()? {
            for _ in 0..photos {
                lines.expect("the last of its photos")?;
            }
            let (line, text) = lines.expect("the count of points")?;
            let points = only(line, text, "the count of points")?;
            for _ in 0..points {
                lines.expect("the last of its points")?;
            }
            if points == 0 {
                not_aligned = not_aligned.saturating_add(photos);
            } else {
                models.push(format!("{photos} photos with {points} points"));
            }
        }
        Ok(())
    };
    let skipped = skip();
    if !models.is_empty() {
        warnings.push(format!(
            "only the first model is read; left out, each in its own frame: {}",
            models.join(", ")
        ));
    }
    if let Err(fault) = skipped {
        let line = fault.line.unwrap_or_default();
        warnings.push(format!(
            "after the first model, line {line}: {}; the rest is left out",
            fault.what
        ));
    }
    not_aligned
}

#[cfg(test)]
mod tests;

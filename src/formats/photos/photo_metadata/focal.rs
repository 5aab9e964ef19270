//! What a photo's metadata say about its intrinsics, the most trustworthy first, each with the error
//! of the focal length to be expected. A scale (pixels per metre) is off by the same part.
//!
//! 1. DJI's DewarpData (DewarpDataK6), where DewarpFlag is not 1 (then the photo is rectified
//!    already): `YYYY-MM-DD;fx,fy,cx,cy,k1,k2,p1,p2,k3[,k4,k5,k6]`, the date optional, pixels, cx and
//!    cy from the middle of the photo, OpenCV's distortion (DJI, Matrice 4 Series User Manual, pages
//!    90 and 91). Calibrated for this very camera: 0.3 %, because focus and temperature move it.
//! 2. Pix4D's tags (support.pix4d.com, "Specifications of XMP Camera Tags"): PerspectiveFocalLength
//!    and PrincipalPoint in mm from the corner of the sensor, PerspectiveDistortion "R1,R2,R3,T1,T2"
//!    (OpenCV's k1 k2 k3 p1 p2), with EXIF's pixels per mm: 0.5 %.
//! 3. CalibratedFocalLength in pixels. Skydio's, with X and Y, is this camera's (0.5 %), and its
//!    optical centre counts from the centre of the first pixel (2027.5 of 4056). DJI's is the lens's
//!    design (page 91), and its DewarpData deviate by 0.2 to 0.5 % from it: 1 %.
//! 4. EXIF's FocalLength in mm and its focal plane's pixels per mm: the nominal length, 2 % and half
//!    its last digit.
//! 5. EXIF's FocalLengthIn35mmFilm: CIPA DC-008 compares the DIAGONALS (43.27 mm), 3 % and half a
//!    millimetre. Measured: Kodak Z612 (shared/data/sceaux-images, calibrated f 2905.88 px) 1.4 % by
//!    the diagonal, 5 % by the width. Photos wider than 3:2 are mostly cut from a 4:3 sensor, whose
//!    diagonal counts then: 10 %.
//!
//! A calibration of 1 to 3 may be of the whole sensor where the photo is a part of it, or of another
//! image size: [`calibrated_frame`](super::calibrated_frame) fits it by its centre, and says so. One
//! that fits nowhere (Skydio's X2 writes its colour camera's into its thermal photos) is not used, nor
//! a sensor's resolution or a scaled calibration that contradicts the 35 mm equivalent. DewarpData
//! count their centre from the photo's and so do not say their size: CalibratedOpticalCenter beside
//! them does.
//!
//! Of a photo that was turned since (its file has the sides of the camera's, swapped) 4 and 5 alone are used: which way it
//! was turned, and with it the centre, nobody says.
//!
//! Pixels of 1 to 3 belong to the size that the camera wrote (EXIF's PixelXDimension); where the file
//! has been reduced since, they are scaled.

use super::calibrated_frame::{Centre, Fit, fit};
use super::exif_fields::ExifFields;
use super::xmp::{Vocabulary, Xmp};
use crate::camera::{Brown, Distortion};

/// The diagonal of 35 mm film, 36 x 24 mm.
const FILM_DIAGONAL_MM: f64 = 43.266_615_305_567_87;

/// Where intrinsics come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FocalSource {
    /// DJI's DewarpData.
    Dewarp,
    /// Pix4D's tags.
    Pix4dTags,
    /// Skydio's calibration.
    SkydioCalibrated,
    /// DJI's CalibratedFocalLength.
    DesignedLens,
    /// EXIF's focal length and focal plane resolution.
    FocalPlane,
    /// EXIF's 35 mm equivalent.
    FilmEquivalent,
}

impl FocalSource {
    /// Whether it is the lens's, with its centre in the middle and no distortion.
    fn is_nominal(self) -> bool {
        matches!(self, Self::FocalPlane | Self::FilmEquivalent)
    }

    /// For messages.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Dewarp => "DJI's DewarpData (this camera's calibration)",
            Self::Pix4dTags => "XMP's PerspectiveFocalLength",
            Self::SkydioCalibrated => "Skydio's CalibratedFocalLength",
            Self::DesignedLens => "CalibratedFocalLength (the lens's design)",
            Self::FocalPlane => "EXIF's focal length and sensor resolution",
            Self::FilmEquivalent => "EXIF's 35 mm equivalent",
        }
    }
}

/// Intrinsics that the metadata state, for the photo file as it is; pixels from its outer corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FocalCandidate {
    /// What states them.
    pub source: FocalSource,
    /// Horizontal focal length, pixels.
    pub fx: f64,
    /// Vertical focal length, pixels.
    pub fy: f64,
    /// Principal point, pixels from the left edge.
    pub cx: f64,
    /// Principal point, pixels from the top edge.
    pub cy: f64,
    /// Zero where none is stated.
    pub distortion: Distortion,
    /// How far the focal length is expected to be off, as a part of it.
    pub relative_error: f64,
}

/// The share from which two focal lengths are worth a sentence, however well the stated one is known.
const WORTH_SAYING: f64 = 0.05;

/// Whether a calibration's focal length that is `ratio` times the stated one is beyond what that may be off, `relative_error`.
pub fn is_another_focal(ratio: f64, relative_error: f64) -> bool {
    (ratio - 1.0).abs() > relative_error.max(WORTH_SAYING)
}

/// All that the metadata state, the most trustworthy first.
pub(super) fn candidates(
    exif: &ExifFields,
    xmp: &Xmp,
    size: (u32, u32),
    warnings: &mut Vec<String>,
) -> Vec<FocalCandidate> {
    let Some(frame) = Frame::new(exif, size, warnings) else {
        return Vec::new();
    };
    if let Some(zoom) = exif.digital_zoom.filter(|&zoom| zoom > 1.0) {
        warnings.push(format!(
            "it was taken with a digital zoom of {zoom}, which focal lengths in metadata may or may not hold"
        ));
    }
    let film = film_equivalent(exif, &frame);
    let all = [
        dewarp(xmp, &frame, warnings),
        pix4d_tags(xmp, exif, &frame),
        skydio(xmp, &frame, warnings),
        designed(xmp, &frame),
        focal_plane(exif, &frame).map(Stated::of_photo),
        film.map(Stated::of_photo),
    ];
    let mut candidates = Vec::new();
    for stated in all.into_iter().flatten() {
        let candidate = stated.candidate;
        if frame.is_turned && !candidate.source.is_nominal() {
            continue;
        }
        let fitted = frame.fitted(&stated).and_then(|(fitted, fit)| {
            match frame.objection(&fitted, &fit, film.as_ref()) {
                None => Ok((fitted, fit)),
                Some(why) => Err(why),
            }
        });
        match fitted {
            Ok((fitted, fit)) => {
                let said = fit.sentence(frame.written);
                warnings.extend(said.filter(|said| !warnings.contains(said)));
                candidates.push(frame.in_file(fitted));
            }
            Err(why) => warnings.push(format!(
                "{} {why}; it is not used",
                candidate.source.in_words()
            )),
        }
    }
    candidates
}

/// Intrinsics as the metadata state them, in pixels of the image that they are for.
struct Stated {
    candidate: FocalCandidate,
    /// What says which image that is; `None` where it is the photo.
    centre: Option<((f64, f64), Centre)>,
    /// Whether the candidate's own centre counts from the photo's middle, and not from the corner of
    /// that image.
    from_middle: bool,
}

impl Stated {
    fn of_photo(candidate: FocalCandidate) -> Self {
        Self {
            candidate,
            centre: None,
            from_middle: false,
        }
    }

    /// With a centre in pixels from the corner of its image.
    fn with_centre(mut candidate: FocalCandidate, at: (f64, f64), centre: Centre) -> Self {
        (candidate.cx, candidate.cy) = at;
        Self {
            candidate,
            centre: Some((at, centre)),
            from_middle: false,
        }
    }
}

/// The image as the camera wrote it, and as the file is.
struct Frame {
    written: (f64, f64),
    scale: f64,
    is_turned: bool,
}

impl Frame {
    fn new(exif: &ExifFields, size: (u32, u32), warnings: &mut Vec<String>) -> Option<Self> {
        let (width, height) = (f64::from(size.0), f64::from(size.1));
        let Some((w, h)) = exif.size.filter(|&written| written != size) else {
            return Some(Self {
                written: (width, height),
                scale: 1.0,
                is_turned: false,
            });
        };
        let (w, h) = (f64::from(w), f64::from(h));
        let fit = |width: f64, height: f64| {
            let scale = width / w;
            ((h * scale - height).abs() <= 1.0_f64.max(scale)).then_some(scale)
        };
        let sides = format!("the file is {width} x {height}");
        let (scale, is_turned, said) = match (fit(width, height), fit(height, width)) {
            (Some(scale), _) => (
                scale,
                false,
                format!("{sides}, the camera wrote {w} x {h}: its focal length is scaled"),
            ),
            (None, Some(scale)) => (
                scale,
                true,
                format!(
                    "{sides}, the camera wrote {w} x {h}: it was turned, so it counts as a camera of its own"
                ),
            ),
            (None, None) => {
                warnings.push(format!(
                    "{sides}, its EXIF says {w} x {h}: it was cut, so no focal length is taken from its metadata"
                ));
                return None;
            }
        };
        warnings.push(said);
        Some(Self {
            written: (w, h),
            scale,
            is_turned,
        })
    }

    fn middle(&self) -> (f64, f64) {
        (self.written.0 / 2.0, self.written.1 / 2.0)
    }

    /// The intrinsics for the photo, and how they became so.
    fn fitted(&self, stated: &Stated) -> Result<(FocalCandidate, Fit), String> {
        let mut found = stated.candidate;
        let Some((at, centre)) = stated.centre else {
            return Ok((found, Fit::SAME));
        };
        let fit = fit(at, centre, self.written).ok_or_else(|| {
            let ((x, y), (width, height)) = (at, self.written);
            format!(
                "has its centre at {x:.0}, {y:.0}, far from the middle of {width} x {height}, and that of no image that this is the middle of: it is of another image size"
            )
        })?;
        found.fx *= fit.scale;
        found.fy *= fit.scale;
        let (middle_x, middle_y) = self.middle();
        (found.cx, found.cy) = if stated.from_middle {
            let from_middle = |c: f64, middle: f64| middle + (c - middle) * fit.scale;
            (
                from_middle(found.cx, middle_x),
                from_middle(found.cy, middle_y),
            )
        } else {
            let (left, top) = fit.cut;
            (found.cx * fit.scale - left, found.cy * fit.scale - top)
        };
        // Twice a measured centre is the size only as far as the centre is the middle.
        if fit.is_scaled() && centre == Centre::Measured {
            found.relative_error = found.relative_error.max(0.03);
        }
        Ok((found, fit))
    }

    /// Why what the metadata state cannot be of this image. `film` is the 35 mm equivalent, which
    /// counts no pixels and so outlives a program that reduced the photo.
    fn objection(
        &self,
        found: &FocalCandidate,
        fit: &Fit,
        film: Option<&FocalCandidate>,
    ) -> Option<String> {
        let (width, height) = self.written;
        // From a fisheye's to a long telephoto's.
        if !(0.2..=100.0).contains(&(found.fx / width)) || found.fy <= 0.0 {
            return Some(format!(
                "gives a focal length of {:.1} px for a width of {width} px",
                found.fx
            ));
        }
        let (middle_x, middle_y) = self.middle();
        if (found.cx / middle_x - 1.0).abs() > 0.1 || (found.cy / middle_y - 1.0).abs() > 0.1 {
            return Some(format!(
                "has its centre at {:.0}, {:.0}, far from the middle of {width} x {height}: it is of another image size",
                found.cx, found.cy
            ));
        }
        let of_sensor = [FocalSource::FocalPlane, FocalSource::Pix4dTags].contains(&found.source);
        let ratio = film.map(|film| found.fx / film.fx);
        let ratio = ratio.filter(|ratio| !(1.0 / 1.5..=1.5).contains(ratio))?;
        let why = match (fit.is_scaled(), of_sensor) {
            (true, _) => "it is of another camera",
            (false, true) => "the photo was reduced, and its sensor's resolution left",
            (false, false) => return None,
        };
        Some(format!(
            "gives {ratio:.2} times the focal length of EXIF's 35 mm equivalent: {why}"
        ))
    }

    fn in_file(&self, candidate: FocalCandidate) -> FocalCandidate {
        let FocalCandidate { fx, fy, cx, cy, .. } = candidate;
        let [fx, fy, cx, cy] = match self.is_turned {
            true => [fy, fx, cy, cx],
            false => [fx, fy, cx, cy],
        };
        FocalCandidate {
            fx: fx * self.scale,
            fy: fy * self.scale,
            cx: cx * self.scale,
            cy: cy * self.scale,
            ..candidate
        }
    }

    /// A pinhole whose principal point is the middle.
    fn plain(&self, source: FocalSource, f: (f64, f64), relative_error: f64) -> FocalCandidate {
        let (cx, cy) = self.middle();
        FocalCandidate {
            source,
            fx: f.0,
            fy: f.1,
            cx,
            cy,
            distortion: Distortion::None,
            relative_error,
        }
    }
}

/// Finite numbers between commas; `None` where one is none.
fn numbers(text: &str) -> Option<Vec<f64>> {
    let parse = |word: &str| word.trim().parse::<f64>().ok().filter(|n| n.is_finite());
    text.split(',').map(parse).collect()
}

fn dewarp(xmp: &Xmp, frame: &Frame, warnings: &mut Vec<String>) -> Option<Stated> {
    if xmp.number(Vocabulary::Dji, "DewarpFlag") == Some(1.0) {
        return None;
    }
    for name in ["DewarpDataK6", "DewarpData"] {
        let Some(text) = xmp.text(Vocabulary::Dji, name) else {
            continue;
        };
        let values = text.rsplit(';').next().unwrap_or(text);
        let (fx, fy, cx, cy, rest) = match numbers(values).as_deref() {
            Some(&[fx, fy, cx, cy, ref rest @ ..]) => (fx, fy, cx, cy, rest.to_vec()),
            _ => (0.0, 0.0, 0.0, 0.0, Vec::new()),
        };
        // Uncalibrated cameras write zeros.
        if fx <= 0.0 || fy <= 0.0 {
            continue;
        }
        let mut coefficients = [0.0; 8];
        if rest.len() > coefficients.len() {
            warnings.push(format!(
                "its {name} has {} numbers, more than is known; it is not used",
                rest.len() + 4
            ));
            continue;
        }
        for (coefficient, value) in coefficients.iter_mut().zip(rest) {
            *coefficient = value;
        }
        let (middle_x, middle_y) = frame.middle();
        let candidate = FocalCandidate {
            cx: middle_x + cx,
            cy: middle_y + cy,
            distortion: Distortion::Brown(Brown::new(coefficients)),
            ..frame.plain(FocalSource::Dewarp, (fx, fy), 0.003)
        };
        return Some(Stated {
            candidate,
            centre: designed_centre(xmp).map(|at| (at, Centre::Designed)),
            from_middle: true,
        });
    }
    None
}

fn pix4d_tags(xmp: &Xmp, exif: &ExifFields, frame: &Frame) -> Option<Stated> {
    let text = |name| xmp.text(Vocabulary::Pix4dCamera, name);
    if text("ModelType").is_some_and(|model| !model.eq_ignore_ascii_case("perspective")) {
        return None;
    }
    let length = xmp.number(Vocabulary::Pix4dCamera, "PerspectiveFocalLength")?;
    let (x, y) = exif.plane?;
    let mut candidate = frame.plain(FocalSource::Pix4dTags, (length * x, length * y), 0.005);
    if let Some(&[r1, r2, r3, t1, t2]) = text("PerspectiveDistortion").and_then(numbers).as_deref()
    {
        let brown = Brown::new([r1, r2, t1, t2, r3, 0.0, 0.0, 0.0]);
        candidate.distortion = Distortion::Brown(brown);
    }
    Some(match text("PrincipalPoint").and_then(numbers).as_deref() {
        Some([cx, cy]) => Stated::with_centre(candidate, (cx * x, cy * y), Centre::Measured),
        _ => Stated::of_photo(candidate),
    })
}

fn skydio(xmp: &Xmp, frame: &Frame, warnings: &mut Vec<String>) -> Option<Stated> {
    let number = |name: &str| xmp.number(Vocabulary::Skydio, name);
    let fx = number("CalibratedFocalLength/X").or_else(|| number("CalibratedFocalLengthX"))?;
    let fy = number("CalibratedFocalLength/Y").or_else(|| number("CalibratedFocalLengthY"))?;
    let candidate = frame.plain(FocalSource::SkydioCalibrated, (fx, fy), 0.005);
    let center = |axis| {
        number(&format!("CalibratedOpticalCenter/{axis}"))
            .or_else(|| number(&format!("CalibratedOpticalCenter{axis}")))
    };
    let bent = xmp.text(Vocabulary::Skydio, "DewarpData");
    if let Some(bent) = bent.filter(|text| text.contains(|c: char| ('1'..='9').contains(&c))) {
        warnings.push(format!(
            "Skydio's distortion ({bent}) is left out, because its formula is not published"
        ));
    }
    Some(match center("X").zip(center("Y")) {
        Some((x, y)) => Stated::with_centre(candidate, (x + 0.5, y + 0.5), Centre::Measured),
        None => Stated::of_photo(candidate),
    })
}

/// Where DJI's lens is designed to have its centre, in pixels of the image that it is designed for.
fn designed_centre(xmp: &Xmp) -> Option<(f64, f64)> {
    let number = |name| xmp.number(Vocabulary::Dji, name).filter(|&n| n > 0.0);
    number("CalibratedOpticalCenterX").zip(number("CalibratedOpticalCenterY"))
}

fn designed(xmp: &Xmp, frame: &Frame) -> Option<Stated> {
    let f = xmp.number(Vocabulary::Dji, "CalibratedFocalLength");
    let f = f.filter(|&f| f > 0.0)?;
    let candidate = frame.plain(FocalSource::DesignedLens, (f, f), 0.01);
    Some(match designed_centre(xmp) {
        Some(at) => Stated::with_centre(candidate, at, Centre::Designed),
        None => Stated::of_photo(candidate),
    })
}

fn focal_plane(exif: &ExifFields, frame: &Frame) -> Option<FocalCandidate> {
    let length = exif.focal_length?;
    let (x, y) = exif.plane?;
    // A sensor between 1 and 70 mm: some programs write nonsense here.
    if !(1.0..=70.0).contains(&(frame.written.0 / x)) {
        return None;
    }
    let f = length.millimetres;
    let error = 0.02 + 0.5 * length.step / f;
    Some(frame.plain(FocalSource::FocalPlane, (f * x, f * y), error))
}

fn film_equivalent(exif: &ExifFields, frame: &Frame) -> Option<FocalCandidate> {
    let film = exif.film_equivalent?;
    let (width, height) = frame.written;
    let (long, short) = (width.max(height), width.min(height));
    let (diagonal, error) = if long / short > 1.55 {
        (long * 1.25, 0.1)
    } else {
        (long.hypot(short), 0.03 + 0.5 / film)
    };
    let f = film / FILM_DIAGONAL_MM * diagonal;
    Some(frame.plain(FocalSource::FilmEquivalent, (f, f), error))
}

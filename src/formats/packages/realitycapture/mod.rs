//! RealityCapture's (RealityScan's) cameras, as a CSV or as XMP sidecars of the photos.
//!
//! Written from Capturing Reality's "RealityCapture XMP Camera Math", RealityScan's paper on its
//! camera geometry (sections 3 to 5, appendices A and B), the export templates that come with the
//! program (`calibration.xml`, quoted there and in public code), and importers that agree with each
//! other (nerfstudio's, brush's, pascalwhoop's rotation matrix).
//!
//! ```text
//! CSV "Internal/External camera parameters", sometimes a line "#cameras N" first:
//!     #name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2
//!     #name,x,y,alt,yaw,pitch,roll,f_35mm,px_norm,py_norm,k1,k2,k3,k4,t1,t2
//! CSV "OpenCV-compliant", where f, px, py are pixels from the image's corner, and words in brackets
//! follow the names:
//!     #name,tx,ty,tz,R00,R01,R02,R10,R11,R12,R20,R21,R22,f_pix,px_pix,py_pix,k1,k2,t2,t1,k3,k4
//! XMP (namespace http://www.capturingreality.com/ns/xcr/1.1#), each an attribute or an element:
//!     Position, Rotation, Coordinates, FocalLength35mm, PrincipalPointU/V, Skew, AspectRatio,
//!     DistortionModel, DistortionCoeficients (so spelt): k1 k2 k3 k4 t1 t2
//! ```
//!
//! - Position and x, y, alt are the camera CENTRE. Rotation is row-major, from the world (z up) to
//!   camera axes x right, y down, z forward.
//! - Degrees: Rz(-heading) Rx(pitch) Ry(roll) takes (x right, y up, z back) to the world: all zero
//!   looks straight down with the image's top to +y, pitch 90 looks to the horizon.
//! - Neither form has image sizes: f counts in film of 36 mm by the photo's longer side, px and py
//!   (PrincipalPointU and V) in longer sides from the image's middle, right and down. The sizes come
//!   from the photos (`ImageUnit::LongerSide`).
//! - brown3, brown4, brown3t2, brown4t2, and every CSV: `1 + k1 r2 + k2 r4 + k3 r6 + k4 r8` in focal
//!   lengths, and t1, t2 are OpenCV's p2, p1 (the "OpenCV-compliant" template writes k1,k2,t2,t1).
//!   With a k4 that is Agisoft's model, whose p1, p2 are t1, t2. division: `1 / (1 + k1 r2)`, OpenCV's
//!   rational k4 alone. perspective and none have no distortion whatever the coefficients say. Other
//!   models leave the photo out, with a warning.
//! - Skew and AspectRatio other than 0 and 1 leave the photo out: no source says how they act.
//! - Neither says its coordinate system; XMP positions count from an origin of the project's own.
//!   Coordinates that are there and not "absolute" are said in a warning.
//! - Which file belongs to a sidecar: the image beside it with the same name but for the extension.

mod csv_file;
mod sidecar;
#[cfg(test)]
mod tests;

use crate::camera::{Agisoft, AgisoftProjection, Brown, Camera, Distortion, Pose};
use crate::packages::reconstruction::{PosedPhoto, Reconstruction};

pub(crate) use csv_file::{is_header, pose, read_csv};
pub(crate) use sidecar::{has_sidecars, read_folder};

/// The width of the film that focal lengths are told on, in mm.
const FILM: f64 = 36.0;

/// What the forms say of a photo's lens.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Lens {
    /// In longer sides of the image, or in pixels.
    focal: f64,
    /// In the same unit.
    principal: [f64; 2],
    /// k1 k2 k3 k4 t1 t2.
    coefficients: [f64; 6],
}

impl Lens {
    /// As a camera without size, or, in words, why it cannot be one.
    fn camera(&self, name: &str) -> Result<Camera, String> {
        if self.focal <= 0.0 {
            return Err(format!("a focal length of {}", self.focal));
        }
        let [k1, k2, k3, k4, t1, t2] = self.coefficients;
        let distortion = if self.coefficients == [0.0; 6] {
            Distortion::None
        } else if k4 == 0.0 {
            Distortion::Brown(Brown::new([k1, k2, t2, t1, k3, 0.0, 0.0, 0.0]))
        } else {
            let radial = [k1, k2, k3, k4];
            let frame = AgisoftProjection::Frame;
            Distortion::Agisoft(Agisoft::new(frame, radial, [t1, t2, 0.0, 0.0]))
        };
        let [cx, cy] = self.principal;
        Ok(Camera {
            name: name.to_owned(),
            width: 0,
            height: 0,
            fx: self.focal,
            fy: self.focal,
            cx,
            cy,
            skew: 0.0,
            distortion,
        })
    }
}

/// Adds a photo with a camera of its own.
fn add(found: &mut Reconstruction, name: String, camera: Camera, pose: Pose) {
    found.photos.push(PosedPhoto {
        name,
        camera: found.cameras.len(),
        pose,
    });
    found.cameras.push(camera);
}

/// Says which photos were left out for their lens.
fn say_refused(found: &mut Reconstruction, refused: &[(String, String)]) {
    if let Some((name, why)) = refused.first() {
        found.warnings.push(format!(
            "{} photos are left out for their lens: '{name}' has {why}",
            refused.len()
        ));
    }
}

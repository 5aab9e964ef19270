//! RealityCapture's (RealityScan's) cameras, as a CSV or as XMP sidecars of the photos.
//!
//! Written from Capturing Reality's "RealityCapture XMP Camera Math", the export templates that come
//! with the program (`calibration.xml`, quoted in public code), and importers that agree with each
//! other (nerfstudio's, brush's, pascalwhoop's rotation matrix).
//!
//! ```text
//! CSV "Internal/External camera parameters", sometimes a line "#cameras N" first:
//!     #name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2
//!     #name,x,y,alt,yaw,pitch,roll,f_35mm,px_norm,py_norm,k1,k2,k3,k4,t1,t2
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
//!   from the photos (`Reconstruction::intrinsics_in_longer_sides`).
//! - perspective, brown3, brown3t2: `1 + k1 r2 + k2 r4 + k3 r6` in focal lengths, and t1, t2 are
//!   OpenCV's p2, p1 (the program's own "OpenCV-compliant" template writes k1,k2,t2,t1). A k4 that is
//!   not 0 (brown4), division and rational models cannot be said in OpenCV's terms: those photos are
//!   left out, with a warning.
//! - Skew and AspectRatio other than 0 and 1 leave the photo out: no source says how they act.
//! - Neither says its coordinate system; XMP positions count from an origin of the project's own.
//!   Coordinates that are not "absolute" are said in a warning.
//! - Which file belongs to a sidecar: the image beside it with the same name but for the extension.

mod csv_file;
mod sidecar;
#[cfg(test)]
mod tests;

use crate::camera::{Brown, Camera, Distortion, Pose};
use crate::formats::reconstruction::{PosedPhoto, Reconstruction};

pub(super) use csv_file::{is_header, read_csv};
pub(super) use sidecar::{has_sidecars, read_folder};

/// What both forms say of a photo's lens.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Lens {
    /// On film of 36 mm.
    focal: f64,
    /// In longer sides, from the middle.
    principal: [f64; 2],
    /// k1 k2 k3 k4 t1 t2.
    coefficients: [f64; 6],
}

impl Lens {
    /// As a camera without size, or, in words, why it cannot be one.
    fn camera(&self, name: &str) -> Result<Camera, String> {
        let [k1, k2, k3, k4, t1, t2] = self.coefficients;
        if k4 != 0.0 {
            return Err(format!(
                "a fourth radial coefficient ({k4}), which cannot be read: use Brown3"
            ));
        }
        if self.focal <= 0.0 {
            return Err(format!("a focal length of {} mm", self.focal));
        }
        let distortion = if self.coefficients == [0.0; 6] {
            Distortion::None
        } else {
            Distortion::Brown(Brown::new([k1, k2, t2, t1, k3, 0.0, 0.0, 0.0]))
        };
        let [cx, cy] = self.principal;
        Ok(Camera {
            name: name.to_owned(),
            width: 0,
            height: 0,
            fx: self.focal / 36.0,
            fy: self.focal / 36.0,
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

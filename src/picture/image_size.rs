//! How large a photo may claim to be.

use image::RgbImage;

use crate::camera::Camera;
use crate::fault::Fault;

/// The most pixels that a photo may have: twice the largest aerial sensors of today.
const MOST_PIXELS: u64 = 400_000_000;

/// Pixels that a byte of a photo may stand for. The flattest JPEG and PNG reach some hundreds, so a
/// header that claims more lies.
const MOST_PIXELS_A_BYTE: u64 = 1000;

/// Below this many pixels a lying header does no harm.
const HARMLESS_PIXELS: u64 = 16_000_000;

/// Refuses a photo of another size than its camera's.
///
/// # Errors
/// Where it is.
pub fn check_size_of(photo: &RgbImage, camera: &Camera) -> Result<(), Fault> {
    let (width, height) = photo.dimensions();
    if (width, height) == (camera.width, camera.height) {
        return Ok(());
    }
    Err(Fault::new(
        format!(
            "the photo is {width} x {height}, its camera {} x {}",
            camera.width, camera.height
        ),
        "give the photo that the camera was calibrated for",
    ))
}

/// Refuses sizes that no photo in a file of so many bytes has, before memory is taken for them.
pub(super) fn check_size(width: u32, height: u32, bytes: u64) -> Result<(), Fault> {
    let pixels = u64::from(width) * u64::from(height);
    let refuse = |why: &str, remedy: &str| {
        Err(Fault::new(
            format!("the image claims to be {width} x {height}, {why}"),
            remedy,
        ))
    };
    if pixels == 0 {
        return refuse("which has no pixels", "give a photo");
    }
    if pixels > MOST_PIXELS {
        return refuse(
            "more than the 400 megapixels that are supported",
            "reduce it",
        );
    }
    if pixels > HARMLESS_PIXELS && pixels > bytes.saturating_mul(MOST_PIXELS_A_BYTE) {
        return refuse(
            &format!("far too much for its {bytes} bytes"),
            "copy the photo again",
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_that_no_photo_has_are_refused() {
        assert!(check_size(65_535, 65_535, 1 << 40).is_err());
        assert!(check_size(0, 5, 100).is_err());
        // A phone's 48 megapixels of plain sky at 200 kB.
        assert!(check_size(8000, 6000, 200_000).is_ok());
    }
}

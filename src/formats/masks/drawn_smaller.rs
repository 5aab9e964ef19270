//! Whether outlines without a size of their photo were drawn on a smaller copy of it: then they all lie in a corner of it that is a half,
//! a third or a quarter as wide and as high, and fill that. Sizes would be a half of what they are. Or on the photo as viewers turn it by its EXIF
//! mark: then they reach beyond one side of it, and not beyond both where it is turned.

use super::OutlinedPhoto;
use super::outline::{OutlinedImage, Piece};
use crate::fault::Fault;

/// How many times smaller copies are that people and programs make.
const TIMES: [f64; 6] = [2.0, 3.0, 4.0, 5.0, 6.0, 8.0];

/// From which share of the smaller photo's width and height on outlines fill it, and by which they may go beyond.
const FILLED: [f64; 2] = [0.97, 1.002];

/// Fewer outlines may lie anywhere.
const FEWEST: usize = 10;

/// Refuses them.
///
/// # Errors
/// With the size that they seem to be of, and how to state the right one.
pub(super) fn refuse(image: &OutlinedImage, photo: &OutlinedPhoto<'_>) -> Result<(), Fault> {
    if image.size.is_some() || image.masks.len() < FEWEST {
        return Ok(());
    }
    let (mut right, mut bottom) = (0.0_f64, 0.0_f64);
    for piece in image.masks.iter().flat_map(|mask| &mask.pieces) {
        match piece {
            Piece::Rings(rings) => {
                for corner in rings.iter().flatten() {
                    right = right.max(corner.x);
                    bottom = bottom.max(corner.y);
                }
            }
            // They say the size of their image, or of their box.
            Piece::Runs(_) => return Ok(()),
        }
    }
    let (width, height) = (f64::from(photo.width), f64::from(photo.height));
    let [beyond_width, beyond_height] = [width, height].map(|side| FILLED[1] * side);
    let is_beyond = right > beyond_width || bottom > beyond_height;
    if is_beyond && right <= beyond_height && bottom <= beyond_width {
        return Err(Fault::new(
            format!(
                "its outlines reach beyond the photo {}, {} x {}, and not beyond it turned by 90 degrees: they seem to be drawn on it as viewers \
                 turn it",
                photo.name, photo.width, photo.height
            ),
            format!(
                "say so in the file (\"width\": {}, \"height\": {}), or draw them on the photo as its pixels are stored",
                photo.height, photo.width
            ),
        ));
    }
    let fills = |times: &f64| {
        let shares = [right * times / width, bottom * times / height];
        shares
            .iter()
            .all(|share| (FILLED[0]..=FILLED[1]).contains(share))
    };
    let Some(times) = TIMES.into_iter().find(fills) else {
        return Ok(());
    };
    let [w, h] = [width / times, height / times].map(f64::round);
    Err(Fault::new(
        format!(
            "all its outlines lie within {w} x {h} pixels at the top left, and fill them, where the photo {} is of {} x {}: they seem to \
             be drawn on a copy of 1/{times} of its size, and the file does not say of which",
            photo.name, photo.width, photo.height
        ),
        format!(
            "draw them on the photo at its full size, or multiply their corners by {times}; if they are of the whole photo, say so in the file \
             (\"width\": {}, \"height\": {})",
            photo.width, photo.height
        ),
    ))
}

#[cfg(test)]
mod tests {
    use crate::masks::{MaskFile, OutlinedPhoto};

    /// Squares of 20 pixels all over so much of a photo of 400 x 300, as GeoJSON; with members of the file before them.
    fn squares(width: u32, height: u32, members: &str) -> Vec<u8> {
        let mut features = Vec::new();
        for top in (0..height - 19).step_by(26) {
            for left in (0..width - 19).step_by(30) {
                let (right, bottom) = (left + 20, top + 20);
                features.push(format!(
                    r#"{{"type": "Feature", "properties": {{}}, "geometry": {{"type": "Polygon", "coordinates":
                    [[[{left}, {top}], [{right}, {top}], [{right}, {bottom}], [{left}, {bottom}], [{left}, {top}]]]}}}}"#
                ));
            }
        }
        format!(
            r#"{{"type": "FeatureCollection", {members} "features": [{}]}}"#,
            features.join(",")
        )
        .into_bytes()
    }

    #[test]
    fn outlines_of_a_smaller_copy_are_refused() {
        let photo = OutlinedPhoto {
            name: "A.jpg",
            width: 400,
            height: 300,
        };
        let read = |bytes: Vec<u8>| MaskFile::from_bytes(bytes).unwrap().of_photo(&photo);
        let fault = read(squares(200, 150, "")).unwrap_err();
        assert!(fault.what.contains("a copy of 1/2 of its size"), "{fault}");
        assert!(fault.what.contains("within 200 x 150 pixels"), "{fault}");
        // On the photo as viewers turn it; a file that says so is turned back elsewhere.
        let fault = read(squares(300, 400, "")).unwrap_err();
        assert!(fault.what.contains("as viewers turn it"), "{fault}");
        assert!(
            fault.remedy.contains(r#""width": 300, "height": 400"#),
            "{fault}"
        );
        // What reaches beyond both is only cut off there.
        assert!(read(squares(440, 330, "")).is_ok());
        // A corner that is no half both ways, the whole photo, and a file that says that it is of the whole one.
        for bytes in [
            squares(200, 300, ""),
            squares(230, 180, ""),
            squares(400, 300, ""),
            squares(200, 150, r#""width": 400, "height": 300,"#),
        ] {
            assert!(read(bytes).is_ok());
        }
        let other = read(squares(200, 150, r#""width": 200, "height": 150,"#)).unwrap_err();
        assert!(other.what.contains("are of 200 x 150 pixels"), "{other}");
    }
}

//! How much is seen of each photo's lines where there are many: of hundreds of outlines all is covered, and
//! nothing is seen of the pile.

use crate::scene::photo_geometry::PhotoGeometry;
use crate::show::Show;

/// So many photos are drawn as they are.
const FEW: f64 = 30.0;

/// The least that is seen of a line.
const LEAST: f64 = 0.1;

/// Image planes that are seen less than this are not drawn: they cover what is under them.
pub(crate) const LEAST_PLANE: f64 = 0.35;

/// How much is seen of each photo, 0 to 1. All of the selected one and of that under the mouse, and where
/// there are few; else the less the more there are, and the less the farther they are from the selected one.
pub(crate) fn presence(photos: &[PhotoGeometry], show: &Show) -> Vec<f64> {
    // `as` is exact for so few.
    let base = (FEW / photos.len().max(1) as f64).powf(0.75);
    if base >= 1.0 {
        return vec![1.0; photos.len()];
    }
    let base = base.max(LEAST);
    let chosen = show.selected.and_then(|photo| photos.get(photo));
    // As wide as its image reaches on the surface: its neighbours overlap it.
    let reach = chosen.map(|photo| {
        let width = f64::from(photo.camera.width) / photo.camera.fx;
        width * photo.depth_of_share(0.5).unwrap_or(0.0)
    });
    let of = |(index, photo): (usize, &PhotoGeometry)| {
        if show.selected == Some(index) || show.hovered == Some(index) {
            return 1.0;
        }
        let near = chosen.zip(reach).map(|(chosen, reach)| {
            let away = photo.center.distance(chosen.center);
            (-(2.0 * away / reach.max(f64::MIN_POSITIVE)).powi(2)).exp()
        });
        base.max(0.7 * near.unwrap_or(0.0))
    };
    photos.iter().enumerate().map(of).collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::camera::{Camera, Distortion, Pose};
    use crate::geometry::{Bounds, LocalFrame};

    fn line_of(count: u32) -> Vec<PhotoGeometry> {
        let camera = Camera {
            name: String::new(),
            width: 100,
            height: 100,
            fx: 100.0,
            fy: 100.0,
            cx: 50.0,
            cy: 50.0,
            skew: 0.0,
            distortion: Distortion::None,
        };
        let frame = LocalFrame::near(&Bounds {
            min: DVec3::ZERO,
            max: DVec3::ONE,
        });
        let at = |i| DVec3::new(f64::from(i), 0.0, 10.0);
        let pose = |i| Pose::from_tilt_pan(at(i), [90.0, 0.0]);
        let photo = |i| PhotoGeometry {
            depths: vec![10.0],
            ..PhotoGeometry::new(&frame, &camera, &pose(i), None, None)
        };
        (0..count).map(photo).collect()
    }

    #[test]
    fn few_are_whole_many_fade_with_their_distance() {
        let selected = |photo| Show {
            selected: Some(photo),
            hovered: Some(499),
            ..Show::default()
        };
        assert_eq!(presence(&line_of(9), &selected(3)), [1.0; 9]);
        let many = presence(&line_of(500), &selected(250));
        assert_eq!((many[250], many[499]), (1.0, 1.0));
        // 500 are 16.7 times 30, to the power of -3/4.
        assert!((many[0] - 0.1212).abs() < 1e-4, "{}", many[0]);
        // Half of its 10 m away: exp(-1) of 0.7.
        assert!((many[255] - 0.7 * (-1_f64).exp()).abs() < 1e-9);
        let after = &many[251..498];
        assert!(after.windows(2).all(|pair| pair[0] >= pair[1]));
        let unselected = presence(&line_of(500), &Show::default());
        assert!(unselected.iter().all(|seen| (seen - 0.1212).abs() < 1e-4));
    }
}

//! A model that the fit turned over. Places of nearly level flights fit in a mirror, too, and what is no rotation is answered
//! by one that looks at the mirror from behind: longitudes without their minus, latitude and longitude swapped, heights that
//! count downwards.

use glam::DVec3;

use crate::geometry::median;

/// How far above the horizon all photos look, a sine (45 degrees), where no gimbal says how they were turned: no pile is
/// photographed so.
const UP: f64 = 0.7;

/// Whether most photos look the other way than their gimbals say, or where none says, all look at the sky: of each the way that
/// it looks in the world by the fit, and by its gimbal, both of length 1 with z up.
pub fn is_turned_over(looks: impl IntoIterator<Item = (DVec3, Option<DVec3>)>) -> bool {
    let mut agree = Vec::new();
    let mut lowest: Option<f64> = None;
    for (found, gimbal) in looks {
        agree.extend(gimbal.map(|gimbal| gimbal.dot(found)));
        lowest = Some(lowest.map_or(found.z, |lowest| lowest.min(found.z)));
    }
    match median(&mut agree) {
        Some(agree) => agree < 0.0,
        None => lowest.is_some_and(|lowest| lowest > UP),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gimbals_decide_where_they_are() {
        let down = DVec3::new(0.1, 0.0, -0.995);
        let wall = DVec3::new(0.5, 0.0, 0.75);
        let looks = |found: DVec3, gimbals: [Option<DVec3>; 3]| {
            is_turned_over(gimbals.map(|gimbal| (found, gimbal)))
        };
        assert!(!looks(down, [Some(down); 3]));
        assert!(looks(-down, [Some(down); 3]));
        // One of them is broken, one says nothing.
        assert!(!looks(down, [Some(down), Some(down), Some(-down)]));
        assert!(looks(-down, [Some(down), None, None]));
        // A wall photographed from below, as the gimbals say.
        assert!(!looks(wall, [Some(wall); 3]));
        assert!(!looks(down, [None; 3]) && looks(-down, [None; 3]));
        assert!(!looks(wall.with_z(0.5), [None; 3]));
        assert!(!is_turned_over([]));
    }
}

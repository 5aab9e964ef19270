//! Viridis: a colour map whose steps look equal, also to the colour-blind and in grey (Smith & van
//! der Walt 2015).

/// The colour for `share`, 0 to 1 (beyond them the ends' colours): red, green, blue.
pub fn viridis(share: f64) -> [u8; 3] {
    let place = share.clamp(0.0, 1.0) * (VIRIDIS_STOPS.len() - 1) as f64;
    let below = (place as usize).min(VIRIDIS_STOPS.len() - 2);
    let part = place - below as f64;
    std::array::from_fn(|channel| {
        let (a, b) = (
            VIRIDIS_STOPS[below][channel],
            VIRIDIS_STOPS[below + 1][channel],
        );
        // `as` saturates, and turns NaN into 0.
        (f64::from(a) + (f64::from(b) - f64::from(a)) * part).round() as u8
    })
}

/// matplotlib's viridis at every sixteenth of its length; straight lines between them are off by at
/// most 6 of 255.
pub const VIRIDIS_STOPS: [[u8; 3]; 17] = [
    [68, 1, 84],
    [72, 24, 106],
    [71, 45, 123],
    [66, 64, 134],
    [59, 82, 139],
    [51, 99, 141],
    [44, 114, 142],
    [38, 129, 142],
    [33, 144, 140],
    [31, 159, 136],
    [40, 174, 128],
    [62, 188, 116],
    [93, 201, 99],
    [130, 211, 76],
    [171, 220, 50],
    [213, 226, 26],
    [253, 231, 37],
];

#[cfg(test)]
mod tests {
    use super::*;

    /// matplotlib 3: `viridis(64 / 255)` and `viridis(200 / 255)`, of 255.
    #[test]
    fn as_matplotlib_has_it() {
        for (share, known) in [
            (64.0 / 255.0, [58.6, 82.2, 139.2]),
            (200.0 / 255.0, [112.2, 206.8, 86.9]),
        ] {
            for (ours, theirs) in viridis(share).into_iter().zip(known) {
                assert!((f64::from(ours) - theirs).abs() < 6.5, "{ours} {theirs}");
            }
        }
        assert_eq!(viridis(-1.0), VIRIDIS_STOPS[0]);
        assert_eq!(viridis(2.0), VIRIDIS_STOPS[16]);
        assert_eq!(viridis(f64::NAN), [0, 0, 0]);
    }
}

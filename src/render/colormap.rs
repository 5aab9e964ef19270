//! Viridis: a colour map whose steps look equal, also to the colour-blind and in grey (Smith & van
//! der Walt 2015).

/// The colour for `share`, 0 to 1 (beyond them the ends' colours): red, green, blue.
pub fn viridis(share: f64) -> [u8; 3] {
    let place = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let below = (place as usize).min(STOPS.len() - 2);
    let part = place - below as f64;
    std::array::from_fn(|channel| {
        let (a, b) = (STOPS[below][channel], STOPS[below + 1][channel]);
        // `as` saturates, and turns NaN into 0.
        (f64::from(a) + (f64::from(b) - f64::from(a)) * part).round() as u8
    })
}

/// matplotlib's viridis at every sixteenth; straight lines between them are off by at most 2.
pub(super) const STOPS: [[u8; 3]; 17] = [
    [68, 1, 84],
    [72, 24, 106],
    [71, 45, 123],
    [66, 64, 134],
    [59, 82, 139],
    [51, 99, 141],
    [44, 114, 142],
    [38, 130, 142],
    [33, 145, 140],
    [31, 160, 136],
    [40, 174, 128],
    [63, 188, 115],
    [94, 201, 98],
    [132, 212, 75],
    [173, 220, 48],
    [216, 226, 25],
    [253, 231, 37],
];

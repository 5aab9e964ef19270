//! How far COLMAP is, from what it prints.

/// Of "Processed file [3/26]": how many of how many.
pub(super) fn of_total(line: &str) -> Option<(u64, u64)> {
    let inside = line.rsplit_once('[')?.1.split_once(']')?.0;
    let (at, total) = inside.split_once('/')?;
    Some((at.trim().parse().ok()?, total.trim().parse().ok()?))
}

/// Of "Registering image #12 (7)" (3.x) and "Registering image #12 (num_reg_frames=7)" (4): how many
/// photos the model holds.
pub(super) fn registered(line: &str) -> Option<u64> {
    let inside = line.split_once("Registering image")?.1;
    let inside = inside.rsplit_once('(')?.1.split_once(')')?.0;
    let number = inside.rsplit('=').next()?;
    number.trim().parse().ok()
}

/// Whether the mapper says that no pair of photos is one to begin with: it ends with an error then.
pub(super) fn finds_nothing(line: &str) -> bool {
    line.contains("failed to create sparse model")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of COLMAP 3.8 and 3.12.
    #[test]
    fn lines_are_understood() {
        assert_eq!(of_total("Processed file [3/26]"), Some((3, 26)));
        let glog = "I20250101 10:00:00.1  99 feature_matching.cc:46] Matching block [1/2, 2/2]";
        assert_eq!(of_total(glog), None);
        assert_eq!(of_total("Matching block [2/11] in 1.2s"), Some((2, 11)));
        assert_eq!(of_total("  Image size:      1280 x 720"), None);
        assert_eq!(registered("Registering image #12 (7)"), Some(7));
        let glog = "I2025 incremental_pipeline.cc:1] Registering image #12 (num_reg_frames=7)";
        assert_eq!(registered(glog), Some(7));
        assert_eq!(registered("  => Image sees 391 / 1400 points"), None);
    }
}

//! The keys that a flight.toml may have.

use super::plan_entry::PLAN_KEYS;

/// Every table with the keys that it may have.
pub(super) const KNOWN_KEYS: [(&str, &[&str]); 10] = [
    (
        "",
        &[
            "format",
            "name",
            "world",
            "surface",
            "camera",
            "photos",
            "scale",
            "scale_object",
            "uncertainty",
            "review",
            "plan",
        ],
    ),
    ("world", &["unit", "ground", "crs", "placed"]),
    ("surface", &["file", "up", "max_edge", "thinning"]),
    (
        "camera",
        &[
            "name",
            "file",
            "width",
            "height",
            "fx",
            "fy",
            "cx",
            "cy",
            "skew",
            "pixel_origin",
            "distortion",
            "coefficients",
        ],
    ),
    (
        "photos",
        &["poses", "folder", "reconstruction", "topic", "transform"],
    ),
    ("scale", &["image", "use"]),
    (
        "uncertainty",
        &["position", "angle", "focal", "surface", "world_scale"],
    ),
    (
        "scale_object",
        &["photo", "kind", "size", "outline", "mask"],
    ),
    ("review", &["photo", "decision", "note", "date", "reasons"]),
    ("plan", PLAN_KEYS),
];

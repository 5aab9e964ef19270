//! An option of a COLMAP command and its value.

use std::ffi::OsString;
use std::path::Path;

/// An option of a command and its value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Setting {
    /// Without the two dashes.
    pub(super) option: String,
    pub(super) value: OsString,
}

impl Setting {
    pub(super) fn text(option: impl Into<String>, value: impl Into<OsString>) -> Self {
        Self {
            option: option.into(),
            value: value.into(),
        }
    }

    pub(super) fn path(option: &str, value: &Path) -> Self {
        Self::text(option, value)
    }
}

//! Which of a command's options a version of COLMAP has.

use std::ffi::OsString;
use std::path::Path;

use super::program::Program;
use crate::fault::Fault;

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

/// What a command's help says.
pub(super) struct Options {
    help: String,
}

impl Options {
    /// Asks the program.
    ///
    /// # Errors
    /// Where it does not start.
    pub(super) fn of(program: &Program, command: &str) -> Result<Self, Fault> {
        Ok(Self {
            help: program.help(command)?,
        })
    }

    /// The option that says whether a graphics card does the work: `SiftExtraction.use_gpu` up to 3.12,
    /// `FeatureExtraction.use_gpu` from then on. Without CUDA COLMAP would want a screen for it.
    pub(super) fn use_gpu(&self, work: &str, has_cuda: bool) -> Option<Setting> {
        let names = ["Feature", "Sift"].map(|kind| format!("{kind}{work}.use_gpu"));
        let option = names.into_iter().find(|name| self.has(name))?;
        Some(Setting::text(option, if has_cuda { "1" } else { "0" }))
    }

    fn has(&self, option: &str) -> bool {
        let wanted = format!("--{option}");
        self.help.split_whitespace().any(|word| word == wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_option_is_looked_up_by_its_old_and_new_name() {
        let of = |help: &str| Options {
            help: help.to_owned(),
        };
        let old = of("  --SiftExtraction.use_gpu arg (=1)\n");
        let new = of("  --FeatureExtraction.use_gpu arg (=1)\n  --SiftExtraction.peak arg");
        let old = old.use_gpu("Extraction", false).unwrap();
        assert_eq!(old, Setting::text("SiftExtraction.use_gpu", "0"));
        let new = new.use_gpu("Extraction", true).unwrap();
        assert_eq!(new, Setting::text("FeatureExtraction.use_gpu", "1"));
        assert_eq!(of("--database_path arg").use_gpu("Extraction", true), None);
    }
}

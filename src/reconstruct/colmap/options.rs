//! Which of a command's options a version of COLMAP has.

use super::program::Program;
use super::setting::Setting;
use crate::fault::Fault;

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

//! What is done with every flight: steps with options, which are words of the single commands.

use std::collections::BTreeMap;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::units::LengthUnit;

/// Something that is done with a flight, called as the command that does it alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Step {
    /// `scales`: scales.csv and scales.json.
    Scales,
    /// `check`: check.txt.
    Check,
    /// `export`: the folder for Split-Desktop.
    Export,
    /// `scale-map`: a folder with the maps of all photos.
    ScaleMap,
    /// `delineate`: a folder with outlines and sizes.
    Delineate,
    /// `psd compare`: the outlined fragments held against a reference.
    Psd,
}

/// What can be said of a step.
#[derive(Debug, Clone, Copy)]
pub struct StepOption {
    /// The key in SEASON.toml; the command has it as `--key`.
    pub key: &'static str,
    /// The words that it may be; any text where there are none.
    pub values: &'static [&'static str],
    /// Whether several values may stand together.
    pub is_list: bool,
    /// What it is where it is none of the words.
    pub kind: OptionKind,
}

/// What a value of an option is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OptionKind {
    /// A word, and nothing else.
    Word,
    /// A file; in SEASON.toml it lies beside that.
    File,
    /// A file or folder below that of each flight.
    OfFlight,
    /// A share, 0 to [`MOST_SHARE`].
    Share,
}

/// No pile has more pores.
pub const MOST_SHARE: f64 = 0.9;

const fn one_of(key: &'static str, values: &'static [&'static str]) -> StepOption {
    StepOption {
        key,
        values,
        is_list: false,
        kind: OptionKind::Word,
    }
}

const fn other(key: &'static str, kind: OptionKind) -> StepOption {
    StepOption {
        kind,
        ..one_of(key, &[])
    }
}

const fn some_of(key: &'static str, values: &'static [&'static str]) -> StepOption {
    StepOption {
        key,
        values,
        is_list: true,
        kind: OptionKind::Word,
    }
}

impl Step {
    /// In the order in which they are done.
    pub const ALL: [Self; 6] = [
        Self::Scales,
        Self::Check,
        Self::Export,
        Self::ScaleMap,
        Self::Delineate,
        Self::Psd,
    ];

    /// The word for it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Scales => "scales",
            Self::Check => "check",
            Self::Export => "export",
            Self::ScaleMap => "scale-map",
            Self::Delineate => "delineate",
            Self::Psd => "psd",
        }
    }

    /// For people: what comes of it.
    pub fn explained(self) -> &'static str {
        match self {
            Self::Scales => "every photo's scale: scales.csv, scales.json",
            Self::Check => "what may be wrong with the flight: check.txt",
            Self::Export => "the folder for Split-Desktop: split-desktop/",
            Self::ScaleMap => "the scale of every pixel: scale-maps/",
            Self::Delineate => "outlined fragments and their sizes: fragments/",
            Self::Psd => {
                "the outlined fragments held against a reference: psd.csv, psd.html (needs delineate)"
            }
        }
    }

    /// What can be said of it.
    pub fn options(self) -> &'static [StepOption] {
        const EXPORT: [StepOption; 2] = [
            one_of("photos", &["all", "trusted"]),
            one_of("rectified", &["fit", "horizontal", "ortho"]),
        ];
        const SCALE_MAP: [StepOption; 1] = [some_of("layers", &["scale", "depth", "x", "y", "z"])];
        const DELINEATE: [StepOption; 7] = [
            one_of("engine", &["learned", "classical"]),
            one_of("shape", &["calibrated", "breadth", "circle"]),
            some_of("also", &["coco", "labelme", "cvat", "geojson", "tiff"]),
            other("masks", OptionKind::OfFlight),
            some_of("steps", &["edges", "engine", "pores", "fines", "none"]),
            other("porosity", OptionKind::Share),
            StepOption {
                values: &["swebrec"],
                ..other("tail", OptionKind::File)
            },
        ];
        const PSD: [StepOption; 3] = [
            other("reference", OptionKind::File),
            one_of("model", &["swebrec", "swebrec5", "rosin-rammler", "ggs"]),
            one_of("merge", &["equal", "area", "mass"]),
        ];
        match self {
            Self::Scales | Self::Check => &[],
            Self::Export => &EXPORT,
            Self::ScaleMap => &SCALE_MAP,
            Self::Delineate => &DELINEATE,
            Self::Psd => &PSD,
        }
    }
}

/// Something said of a step that does not fit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Misfit {
    /// Of which step.
    pub step: Step,
    /// The key that is to be corrected.
    pub key: &'static str,
    /// What is wrong, beginning with a key.
    pub what: String,
}

/// Whether the steps to the mass fit each other and what they are given: those of the option `steps`, `None` where it is not there.
///
/// # Errors
/// What does not.
pub fn steps_fit<'a>(
    steps: Option<impl Iterator<Item = &'a str>>,
    has_porosity: bool,
    has_tail: bool,
) -> Result<(), Misfit> {
    let Some(steps) = steps else {
        return Ok(());
    };
    let steps: Vec<&str> = steps.collect();
    let misfit = |key, what: &str| {
        Err(Misfit {
            step: Step::Delineate,
            key,
            what: what.to_owned(),
        })
    };
    if steps.contains(&"none") && steps.len() > 1 {
        return misfit("steps", "steps: none goes with no other step; leave it out");
    }
    if has_porosity && !steps.contains(&"pores") {
        return misfit(
            "porosity",
            "porosity is for the step pores, which the steps leave out",
        );
    }
    if has_tail && !steps.contains(&"fines") {
        return misfit("tail", "tail is of the fines, which the steps leave out");
    }
    Ok(())
}

impl FromStr for Step {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|step| step.as_str() == text);
        found.ok_or_else(|| {
            let all = Self::ALL.map(Self::as_str).join(", ");
            format!("'{text}' is no step; the steps are {all}")
        })
    }
}

/// A step with what was said of it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AskedStep {
    /// What is done.
    pub step: Step,
    /// By key: see [`Step::options`].
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub options: BTreeMap<String, Vec<String>>,
}

/// What is done with every flight.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Asked {
    /// Of all lengths that are written; one of [`Asked::UNITS`].
    pub unit: String,
    /// In the order of [`Step::ALL`], each once.
    pub steps: Vec<AskedStep>,
    /// What was said of steps that are not asked for now: it waits until they are, and decides nothing.
    #[serde(skip)]
    waiting: Vec<AskedStep>,
}

impl Default for Asked {
    /// Scales and check, in cm.
    fn default() -> Self {
        Self::of(&[Step::Scales, Step::Check])
    }
}

impl Asked {
    /// Whether it is said what the sizes of all flights are held against, also where psd is not asked for now.
    pub fn names_reference(&self) -> bool {
        let mut steps = self.steps.iter().chain(&self.waiting);
        steps.any(|asked| asked.step == Step::Psd && asked.options.contains_key("reference"))
    }

    /// The units that commands write.
    pub const UNITS: [&'static str; 5] = ["mm", "cm", "m", "in", "ft"];

    /// These steps without options, in cm.
    pub fn of(steps: &[Step]) -> Self {
        let mut asked = Self {
            unit: "cm".to_owned(),
            steps: Vec::new(),
            waiting: Vec::new(),
        };
        asked.set_steps(steps);
        asked
    }

    /// Whether it is among them.
    pub fn has(&self, step: Step) -> bool {
        self.steps.iter().any(|asked| asked.step == step)
    }

    /// These steps, with what was said of them, perhaps before they were asked for; what was said of others waits.
    pub fn set_steps(&mut self, steps: &[Step]) {
        let mut said = std::mem::take(&mut self.steps);
        said.append(&mut self.waiting);
        let all = Step::ALL.into_iter().filter(|step| steps.contains(step));
        self.steps = all
            .map(|step| {
                let before = said.iter().find(|asked| asked.step == step).cloned();
                before.unwrap_or(AskedStep {
                    step,
                    options: BTreeMap::new(),
                })
            })
            .collect();
        said.retain(|asked| !asked.options.is_empty() && !steps.contains(&asked.step));
        self.waiting = said;
    }

    /// The unit of all lengths that are written.
    ///
    /// # Errors
    /// Where it is none of [`Asked::UNITS`].
    pub fn length_unit(&self) -> Result<LengthUnit, String> {
        let known = Self::UNITS.contains(&self.unit.as_str());
        let unit = known.then(|| self.unit.parse().ok()).flatten();
        unit.ok_or_else(|| {
            let all = Self::UNITS.join(", ");
            format!("unit is '{}', none of {all}", self.unit)
        })
    }

    /// Says something of a step.
    ///
    /// # Errors
    /// Where the step is not asked for, has no such option, or the option no such value.
    pub fn set(&mut self, step: Step, key: &str, values: Vec<String>) -> Result<(), String> {
        let name = step.as_str();
        let Some(option) = step.options().iter().find(|option| option.key == key) else {
            let known: Vec<&str> = step.options().iter().map(|option| option.key).collect();
            return Err(match known.is_empty() {
                true => format!("{name} has no options"),
                false => format!("{name} has no option '{key}', only {}", known.join(", ")),
            });
        };
        if values.is_empty() || values.len() > 1 && !option.is_list {
            return Err(format!("{name}.{key} takes one value"));
        }
        let wrong = values.iter().find(|value| {
            value.is_empty()
                || option.kind == OptionKind::Word && !option.values.contains(&value.as_str())
        });
        if let Some(wrong) = wrong {
            let all = match option.kind {
                OptionKind::Word => format!("one of {}", option.values.join(", ")),
                OptionKind::File | OptionKind::OfFlight | OptionKind::Share => "a name".to_owned(),
            };
            return Err(format!("{name}.{key} is '{wrong}', not {all}"));
        }
        let Some(asked) = self.steps.iter_mut().find(|asked| asked.step == step) else {
            return Err(format!("{name} is not among the steps"));
        };
        asked.options.insert(key.to_owned(), values);
        Ok(())
    }

    /// What the steps need of each other.
    ///
    /// # Errors
    /// Where one has not what it needs.
    pub fn check(&self) -> Result<(), String> {
        if self.steps.is_empty() {
            return Err("there is no step, so nothing would be done".to_owned());
        }
        if self.has(Step::Psd) && !self.has(Step::Delineate) {
            return Err(
                "psd holds outlined fragments against a reference, so it needs delineate"
                    .to_owned(),
            );
        }
        self.check_options().map_err(|misfit| {
            let Misfit { step, what, .. } = misfit;
            format!("{}.{what}", step.as_str())
        })?;
        self.length_unit().map(|_| ())
    }

    /// Whether what is said of each step fits.
    ///
    /// # Errors
    /// The first that does not.
    pub fn check_options(&self) -> Result<(), Misfit> {
        for said in &self.steps {
            let has = |key: &str| said.options.contains_key(key);
            if has("masks") && has("engine") {
                return Err(Misfit {
                    step: said.step,
                    key: "engine",
                    what: "masks is in place of an engine: leave engine out".to_owned(),
                });
            }
            if said.step == Step::Delineate {
                let steps = said.options.get("steps");
                steps_fit(
                    steps.map(|steps| steps.iter().map(String::as_str)),
                    has("porosity"),
                    has("tail"),
                )?;
            }
            for option in said.step.options() {
                if option.kind != OptionKind::Share {
                    continue;
                }
                let is_share = |text: &str| {
                    let share: Result<f64, _> = text.parse();
                    share.is_ok_and(|share| (0.0..=MOST_SHARE).contains(&share))
                };
                let mut values = said.options.get(option.key).into_iter().flatten();
                if let Some(wrong) = values.find(|text| !is_share(text)) {
                    return Err(Misfit {
                        step: said.step,
                        key: option.key,
                        what: format!(
                            "{} is '{wrong}', no share from 0 to {MOST_SHARE}",
                            option.key
                        ),
                    });
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_in_their_order_and_keep_what_was_said() {
        let mut asked = Asked::of(&[Step::Delineate, Step::Scales]);
        let steps: Vec<Step> = asked.steps.iter().map(|asked| asked.step).collect();
        assert_eq!(steps, [Step::Scales, Step::Delineate]);
        let value = |text: &str| vec![text.to_owned()];
        asked
            .set(Step::Delineate, "engine", value("classical"))
            .unwrap();
        asked.set_steps(&[Step::Delineate, Step::Export]);
        assert_eq!(asked.steps[1].options["engine"], value("classical"));
        // A step that is left out for a while says the same when it is back.
        asked.set_steps(&[Step::Export]);
        assert!(!asked.has(Step::Delineate));
        asked.set_steps(&[Step::Delineate, Step::Export]);
        assert_eq!(asked.steps[1].options["engine"], value("classical"));
        for (step, key, text, why) in [
            (Step::Delineate, "engin", "classical", "no option 'engin'"),
            (
                Step::Delineate,
                "engine",
                "both",
                "one of learned, classical",
            ),
            (Step::Scales, "unit", "m", "has no options"),
            (Step::ScaleMap, "layers", "scale", "is not among the steps"),
            (Step::Export, "photos", "", "not one of all, trusted"),
        ] {
            let error = asked.set(step, key, value(text)).unwrap_err();
            assert!(error.contains(why), "{error}");
        }
        let two = vec!["fit".to_owned(), "ortho".to_owned()];
        assert!(asked.set(Step::Export, "rectified", two).is_err());
        assert!("scale".parse::<Step>().unwrap_err().contains("scale-map"));
    }

    #[test]
    fn what_cannot_be_done_is_refused() {
        assert!(Asked::default().check().is_ok());
        assert!(Asked::of(&[]).check().is_err());
        assert!(Asked::of(&[Step::Psd]).check().is_err());
        assert!(Asked::of(&[Step::Psd, Step::Delineate]).check().is_ok());
        let asked = Asked {
            unit: "km".to_owned(),
            ..Asked::default()
        };
        assert!(asked.check().unwrap_err().contains("'km'"));
        let mut asked = Asked::of(&[Step::Delineate]);
        let value = |text: &str| vec![text.to_owned()];
        asked.set(Step::Delineate, "masks", value("masks")).unwrap();
        asked
            .set(Step::Delineate, "porosity", value("0.4"))
            .unwrap();
        assert!(asked.check().is_ok());
        asked.set(Step::Delineate, "porosity", value("40")).unwrap();
        assert!(
            asked
                .check()
                .unwrap_err()
                .contains("no share from 0 to 0.9")
        );
        asked
            .set(Step::Delineate, "porosity", value("0.4"))
            .unwrap();
        asked
            .set(Step::Delineate, "engine", value("learned"))
            .unwrap();
        assert!(asked.check().unwrap_err().contains("in place of an engine"));
    }
}

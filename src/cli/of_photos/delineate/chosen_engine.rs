//! `--engine`: one that the program brings along, or a model of the user's.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::delineation::{Learned, ReadyEngine, engine_called};
use crate::opening::read_named_engine;

/// An engine, as it was named.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum ChosenEngine {
    /// One of the program's.
    BroughtAlong(String),
    /// What describes the user's.
    Described(PathBuf),
    /// None: what was saved in the window.
    Saved,
}

impl ChosenEngine {
    /// From the command line.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        if text == "saved" {
            return Ok(Self::Saved);
        }
        if engine_called(text).is_some() {
            return Ok(Self::BroughtAlong(text.to_owned()));
        }
        let ending = Path::new(text).extension().unwrap_or_default();
        match ending.to_ascii_lowercase().to_string_lossy().as_ref() {
            "toml" => Ok(Self::Described(text.into())),
            "onnx" => Err("a model needs a description: name the TOML file that has one (docs/fragments.md, \"Your own network\")".to_owned()),
            _ => Err("learned, classical, saved, or a TOML file that describes an ONNX model".to_owned()),
        }
    }

    /// The file that is read for it.
    pub(super) fn file(&self) -> Option<&PathBuf> {
        match self {
            Self::BroughtAlong(_) | Self::Saved => None,
            Self::Described(path) => Some(path),
        }
    }

    /// Makes it ready.
    ///
    /// # Errors
    /// Where the user's cannot be taken.
    pub(super) fn open(&self) -> Result<ReadyEngine, String> {
        match self {
            // Of a photo without saved outlines it is not asked.
            Self::Saved => Ok(ReadyEngine::BroughtAlong(&Learned)),
            Self::BroughtAlong(name) => {
                let engine =
                    engine_called(name).ok_or_else(|| format!("there is no engine {name}"))?;
                Ok(ReadyEngine::BroughtAlong(engine))
            }
            Self::Described(path) => {
                let model = read_named_engine(path).map_err(|error| error.to_string())?;
                Ok(ReadyEngine::Named(Arc::new(model)))
            }
        }
    }
}

//! `fragscale info`: what a file or folder holds.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde_json::Value;

use super::Answer;
use crate::jobs::Progress;
use crate::opening;

#[derive(Debug, Args)]
pub(super) struct InfoArguments {
    /// Any file or folder that fragscale reads.
    file: PathBuf,
    /// How to write it.
    #[arg(long, value_enum, default_value = "text")]
    format: InfoFormat,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum InfoFormat {
    Text,
    Json,
}

pub(super) fn info(arguments: &InfoArguments, progress: &Progress) -> Result<Answer, String> {
    let value = opening::info(&arguments.file, progress).map_err(|error| error.to_string())?;
    let text = match arguments.format {
        InfoFormat::Json => format!("{value}\n"),
        InfoFormat::Text => info_text(&value),
    };
    Ok(Answer::new(text, Vec::new()))
}

/// The top level of an `info` value, a line each; of lists how long they are.
fn info_text(value: &Value) -> String {
    let mut text = String::new();
    for (key, value) in value.as_object().into_iter().flatten() {
        let shown = match value {
            Value::Null => "not stated".to_owned(),
            Value::String(text) => text.clone(),
            Value::Array(list) if key == "warnings" => {
                for warning in list {
                    text += &format!("warning: {}\n", warning.as_str().unwrap_or_default());
                }
                continue;
            }
            Value::Array(list) if key == "topics" => {
                for topic in list {
                    let of = |key: &str| topic[key].as_str().unwrap_or_default();
                    let poses = match topic["gives_poses"].as_bool() {
                        Some(true) => ", gives poses",
                        _ => "",
                    };
                    let (name, kind, count) = (of("name"), of("type"), &topic["messages"]);
                    text += &format!("topic: {name} ({kind}), {count} messages{poses}\n");
                }
                continue;
            }
            Value::Array(list) => list.len().to_string(),
            other => in_words(other),
        };
        text += &format!("{}: {shown}\n", key.replace('_', " "));
    }
    text
}

/// A value with what is in it, in a line.
fn in_words(value: &Value) -> String {
    match value {
        Value::Null => "not stated".to_owned(),
        Value::String(text) => text.clone(),
        Value::Object(parts) => {
            let parts = parts.iter().map(|(name, part)| match part {
                Value::Object(_) => format!("{name} ({})", in_words(part)),
                part => format!("{name} {}", in_words(part)),
            });
            parts.collect::<Vec<_>>().join(", ")
        }
        other => other.to_string(),
    }
}

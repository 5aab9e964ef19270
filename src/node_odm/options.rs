//! What the user asks OpenDroneMap for, held against what the node says that it knows.
//!
//! A node drops what it does not know without a word, so its `/options` is asked first and an unknown name is
//! refused. Nothing with a number and no `boundary` is sent unless the user asks: versions of NodeODM stumble
//! over the first and take the quotes out of the second.

use serde::Deserialize;
use serde_json::{Value, json};

use crate::fault::Fault;
use crate::outputs::needs;

/// An option as the user typed it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Asked {
    /// OpenDroneMap's name, without dashes in front.
    pub name: String,
    /// Its value, as text.
    pub value: String,
}

impl Asked {
    /// `NAME=VALUE`; `NAME` alone is `NAME=true`.
    ///
    /// # Errors
    /// Where there is no name.
    pub fn parse(typed: &str) -> Result<Self, Fault> {
        let (name, value) = typed.split_once('=').unwrap_or((typed, "true"));
        let name = name.trim().trim_start_matches('-');
        if name.is_empty() || name.contains(char::is_whitespace) {
            let what = format!("\"{typed}\" is no option of OpenDroneMap");
            return Err(Fault::new(
                what,
                "write it as name=value, like pc-quality=medium",
            ));
        }
        Ok(Self {
            name: name.to_owned(),
            value: value.trim().to_owned(),
        })
    }

    /// Several, as they are typed into one field, apart by blanks; a value with blanks stands in quotation marks
    /// ("name=a b").
    ///
    /// # Errors
    /// As [`Asked::parse`], and where a quotation does not end.
    pub fn parse_all(typed: &str) -> Result<Vec<Self>, Fault> {
        let (mut words, mut word, mut quoted) = (Vec::new(), String::new(), false);
        for c in typed.chars() {
            match c {
                '"' => quoted = !quoted,
                c if c.is_whitespace() && !quoted => words.push(std::mem::take(&mut word)),
                c => word.push(c),
            }
        }
        if quoted {
            let what = format!("the quotation in {typed} does not end");
            return Err(Fault::new(what, "put a second quotation mark behind it"));
        }
        words.push(word);
        let words = words.iter().filter(|word| !word.is_empty());
        words.map(|word| Self::parse(word)).collect()
    }
}

/// An option that a node knows.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Known {
    name: String,
    #[serde(default, rename = "type")]
    kind: String,
    /// A list of words, or a sentence.
    #[serde(default)]
    domain: Value,
}

/// Saves hours of work that no scale needs, where the node knows it and the user neither says otherwise nor asks for
/// what is made of it.
const USUAL: [(&str, &str); 2] = [("skip-3dmodel", "true"), ("skip-orthophoto", "true")];

/// How the options of a task that was begun differ from those of now, as a clause: "with dsm=true and without
/// pc-quality=low". `None` where they do not.
pub(crate) fn difference(before: &str, now: &str) -> Option<String> {
    let listed = |text: &str| -> Vec<String> {
        let options: Vec<Value> = serde_json::from_str(text).unwrap_or_default();
        let shown = |option: &Value| {
            let value = match option.get("value")? {
                Value::String(text) => text.clone(),
                other => other.to_string(),
            };
            Some(format!("{}={value}", option.get("name")?.as_str()?))
        };
        options.iter().filter_map(shown).collect()
    };
    let (before, now) = (listed(before), listed(now));
    let only_in = |these: &[String], those: &[String]| {
        let only: Vec<&str> = (these.iter())
            .filter(|option| !those.contains(option))
            .map(String::as_str)
            .collect();
        only.join(", ")
    };
    match (only_in(&before, &now), only_in(&now, &before)) {
        (with, without) if with.is_empty() && without.is_empty() => None,
        (with, without) if without.is_empty() => Some(format!("with {with}")),
        (with, without) if with.is_empty() => Some(format!("without {without}")),
        (with, without) => Some(format!("with {with} and without {without}")),
    }
}

/// What is sent to `/task/new/init` as `options`.
///
/// # Errors
/// Where an option is not known to the node or its value is none.
pub(crate) fn to_send(asked: &[Asked], known: &[Known]) -> Result<String, Fault> {
    let mut sent = Vec::new();
    for (number, option) in asked.iter().enumerate() {
        let name = &option.name;
        if asked.iter().take(number).any(|before| before.name == *name) {
            let what = format!("the option {name} is given twice");
            return Err(Fault::new(what, "give it once"));
        }
        let known = known
            .iter()
            .find(|known| known.name == *name)
            .ok_or_else(|| unknown(name, known))?;
        sent.push(json!({ "name": name, "value": value(option, known)? }));
    }
    for (name, value) in USUAL {
        let is_asked = asked.iter().any(|option| {
            let value = match option.value.as_str() {
                "false" | "0" => Value::Bool(false),
                _ => Value::Bool(true),
            };
            option.name == name || needs(&option.name, &value, name)
        });
        let is_known = known
            .iter()
            .any(|known| known.name == name && known.kind == "bool");
        if is_known && !is_asked {
            sent.push(json!({ "name": name, "value": value == "true" }));
        }
    }
    Ok(Value::Array(sent).to_string())
}

fn unknown(name: &str, known: &[Known]) -> Fault {
    let likeness = |known: &&Known| strsim::jaro_winkler(name, &known.name);
    let nearest = known
        .iter()
        .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
        .filter(|nearest| likeness(nearest) > 0.7);
    let remedy = match nearest {
        Some(nearest) => format!("perhaps {} is meant", nearest.name),
        None => "leave it out".to_owned(),
    };
    Fault::new(
        format!("the node's OpenDroneMap knows no option {name}"),
        remedy,
    )
}

fn value(option: &Asked, known: &Known) -> Result<Value, Fault> {
    let Asked { name, value } = option;
    let wrong = |needed: String| {
        let what = format!("the option {name} cannot be \"{value}\"");
        Err(Fault::new(what, format!("it needs {needed}")))
    };
    if let Value::Array(words) = &known.domain {
        let words: Vec<&str> = words.iter().filter_map(Value::as_str).collect();
        return match words.contains(&value.as_str()) {
            true => Ok(json!(value)),
            false => wrong(format!("one of {}", words.join(", "))),
        };
    }
    match known.kind.as_str() {
        "bool" => match value.as_str() {
            "true" | "1" => Ok(json!(true)),
            "false" | "0" => Ok(json!(false)),
            _ => wrong("true or false".to_owned()),
        },
        "int" if value.parse::<i64>().is_err() => wrong("a whole number".to_owned()),
        "float" if !value.parse::<f64>().is_ok_and(f64::is_finite) => wrong("a number".to_owned()),
        // Numbers go as texts, too: that is what NodeODM's own description of its calls says.
        _ => Ok(json!(value)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of NodeODM 2.2.4, shortened.
    fn known() -> Vec<Known> {
        serde_json::from_str(
            r#"[{"name":"pc-quality","type":"enum","value":"medium","domain":["ultra","high","medium","low","lowest"],"help":""},
                {"name":"dem-resolution","type":"float","value":"5","domain":"float","help":""},
                {"name":"min-num-features","type":"int","value":"10000","domain":"integer","help":""},
                {"name":"dsm","type":"bool","value":"false","domain":"","help":""},
                {"name":"skip-3dmodel","type":"bool","value":"false","domain":"","help":""},
                {"name":"skip-orthophoto","type":"bool","value":"false","domain":"","help":""},
                {"name":"boundary","type":"string","value":"","domain":"json","help":""}]"#,
        )
        .unwrap()
    }

    fn sent(asked: &[&str]) -> Result<Value, Fault> {
        let asked: Vec<Asked> = asked
            .iter()
            .map(|text| Asked::parse(text).unwrap())
            .collect();
        to_send(&asked, &known()).map(|text| serde_json::from_str(&text).unwrap())
    }

    #[test]
    fn nothing_with_a_number_goes_unasked() {
        let usual = sent(&[]).unwrap();
        assert_eq!(
            usual,
            json!([{"name": "skip-3dmodel", "value": true}, {"name": "skip-orthophoto", "value": true}])
        );
        assert_eq!(to_send(&[], &[]).unwrap(), "[]");
    }

    #[test]
    fn what_is_asked_goes_in_its_type() {
        let all = sent(&[
            "pc-quality=high",
            "--dsm",
            "skip-orthophoto=false",
            "dem-resolution=2.5",
            r#"boundary={"type":"Feature"}"#,
        ]);
        assert_eq!(
            all.unwrap(),
            json!([
                {"name": "pc-quality", "value": "high"},
                {"name": "dsm", "value": true},
                {"name": "skip-orthophoto", "value": false},
                {"name": "dem-resolution", "value": "2.5"},
                {"name": "boundary", "value": "{\"type\":\"Feature\"}"},
                {"name": "skip-3dmodel", "value": true},
            ])
        );
    }

    /// An orthophoto's picture is made of an orthophoto.
    #[test]
    fn what_is_asked_is_not_left_out() {
        let known: Vec<Known> = serde_json::from_str(
            r#"[{"name":"orthophoto-png","type":"bool"},{"name":"gltf","type":"bool"},{"name":"skip-3dmodel","type":"bool"},
                {"name":"skip-orthophoto","type":"bool"}]"#,
        )
        .unwrap();
        let sent = |asked: &str| to_send(&[Asked::parse(asked).unwrap()], &known).unwrap();
        assert_eq!(
            sent("orthophoto-png"),
            r#"[{"name":"orthophoto-png","value":true},{"name":"skip-3dmodel","value":true}]"#
        );
        assert!(!sent("gltf").contains("skip-3dmodel"));
        assert!(sent("orthophoto-png=false").contains("skip-orthophoto"));
    }

    #[test]
    fn differences_are_named() {
        let (high, low) = (
            r#"[{"name":"pc-quality","value":"high"},{"name":"dsm","value":true}]"#,
            r#"[{"name":"dsm","value":true},{"name":"pc-quality","value":"low"}]"#,
        );
        let said = difference(high, low);
        assert_eq!(
            said.as_deref(),
            Some("with pc-quality=high and without pc-quality=low")
        );
        assert_eq!(
            difference("[]", r#"[{"name":"dsm","value":true}]"#).as_deref(),
            Some("without dsm=true")
        );
        assert_eq!(difference(high, high), None);
    }

    #[test]
    fn what_a_node_would_drop_or_refuse_is_said_before() {
        for (asked, said) in [
            (
                "pc-qualty=high",
                "knows no option pc-qualty; perhaps pc-quality is meant",
            ),
            ("xyz=1", "knows no option xyz; leave it out"),
            (
                "pc-quality=best",
                "cannot be \"best\"; it needs one of ultra, high, medium, low, lowest",
            ),
            ("dsm=yes", "cannot be \"yes\"; it needs true or false"),
            ("min-num-features=1.5", "it needs a whole number"),
            ("dem-resolution=abc", "it needs a number"),
            ("dem-resolution=inf", "it needs a number"),
        ] {
            let fault = sent(&[asked]).unwrap_err().to_string();
            assert!(fault.contains(said), "{fault}");
        }
        assert!(
            sent(&["dsm", "dsm=false"])
                .unwrap_err()
                .what
                .contains("twice")
        );
        assert!(Asked::parse("=1").is_err());
        assert!(Asked::parse("pc quality=1").is_err());
    }

    #[test]
    fn a_field_holds_several() {
        let all = Asked::parse_all(" pc-quality=high  dsm \"name=a b\" ").unwrap();
        let all: Vec<(&str, &str)> = all.iter().map(|a| (&*a.name, &*a.value)).collect();
        assert_eq!(
            all,
            [("pc-quality", "high"), ("dsm", "true"), ("name", "a b")]
        );
        assert_eq!(Asked::parse_all(" ").unwrap(), []);
        assert!(Asked::parse_all("name=\"a b").is_err());
    }
}

//! What a node answers, as far as it is looked at. Everything may be missing: versions differ, and ClusterODM
//! answers for tasks that it has not handed on yet.

use serde::Deserialize;

/// `/info`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(crate) struct NodeInfo {
    pub(crate) version: Option<String>,
    /// "odm"; "?" of a cluster without nodes.
    pub(crate) engine: Option<String>,
    /// The most photos that it takes.
    #[serde(rename = "maxImages")]
    pub(crate) most_photos: Option<f64>,
}

/// `/task/new/init` and `/task/new/commit`.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Named {
    pub(crate) uuid: String,
}

/// `/task/UUID/info`.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct TaskInfo {
    pub(crate) status: Status,
    /// Milliseconds since it began; negative before.
    #[serde(rename = "processingTime", default)]
    pub(crate) time: Option<f64>,
    #[serde(rename = "imagesCount", default)]
    pub(crate) photos: Option<f64>,
    /// Percent; 100 also after a failure. `None` from a cluster that has not handed the task on yet.
    #[serde(default)]
    pub(crate) progress: Option<f64>,
}

/// How a task is.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Status {
    pub(crate) code: i64,
    #[serde(rename = "errorMessage", default)]
    pub(crate) error: Option<String>,
}

/// The same in words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum State {
    Queued,
    Running,
    Failed,
    Completed,
    Cancelled,
}

impl TaskInfo {
    /// `None` for a code that is not known.
    pub(crate) fn state(&self) -> Option<State> {
        Some(match self.status.code {
            10 => State::Queued,
            20 => State::Running,
            30 => State::Failed,
            40 => State::Completed,
            50 => State::Cancelled,
            _ => return None,
        })
    }

    /// How many files have arrived and of which: a cluster that has not handed the task on yet counts all of them,
    /// a node the photos. `None` as long as a node has not looked: what it says until then is an estimate.
    pub(crate) fn arrived(&self) -> Option<Arrived> {
        let count = self.photos?;
        match (self.progress, self.state()) {
            (None, _) => Some(Arrived::Files(count)),
            (Some(_), Some(State::Running)) if self.time.is_none_or(|time| time < 0.0) => None,
            _ => Some(Arrived::Photos(count)),
        }
    }
}

/// How many have arrived.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Arrived {
    /// Photos and lists.
    Files(f64),
    /// Photos alone.
    Photos(f64),
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info(text: &str) -> TaskInfo {
        serde_json::from_str(text).unwrap()
    }

    /// Answers of NodeODM 2.2.4 and ClusterODM 1.5.8, word for word but for the options.
    #[test]
    fn counts_are_those_of_nodes_and_of_clusters() {
        let begun = r#"{"uuid":"f","name":"pile","dateCreated":1795315232974,"processingTime":-1,"status":{"code":20},"options":[],"imagesCount":4,"progress":0}"#;
        assert_eq!(info(begun).arrived(), None);
        let runs = begun.replace("-1", "1001");
        assert_eq!(info(&runs).arrived(), Some(Arrived::Photos(4.0)));
        let queued = begun.replace("20}", "10}");
        assert_eq!(info(&queued).arrived(), Some(Arrived::Photos(4.0)));
        assert_eq!(info(&queued).state(), Some(State::Queued));
        let cluster = r#"{"uuid":"a","name":"pile","dateCreated":1795315611911,"status":{"code":20},"options":[],"imagesCount":5,"processingTime":58}"#;
        assert_eq!(info(cluster).arrived(), Some(Arrived::Files(5.0)));
        let failed =
            r#"{"status":{"code":30,"errorMessage":"Cannot process dataset"},"progress":100}"#;
        assert_eq!(info(failed).arrived(), None);
        assert_eq!(info(failed).state(), Some(State::Failed));
        assert_eq!(
            info(failed).status.error.as_deref(),
            Some("Cannot process dataset")
        );
        assert_eq!(info(r#"{"status":{"code":60}}"#).state(), None);
    }
}

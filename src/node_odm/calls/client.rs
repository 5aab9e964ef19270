//! Calls to a node, and what its answers mean.
//!
//! NodeODM and ClusterODM answer nearly everything with status 200 and, where something is wrong, an object with
//! `error`; a wrong token is such an object from NodeODM and a bare 401 from ClusterODM. Nothing is followed
//! anywhere: a redirect is an error, whatever is behind it. No answer is read beyond what it can sensibly hold.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::Path;
use std::time::Duration;

use serde::de::DeserializeOwned;
use serde_json::Value;
use ureq::http::Response;
use ureq::{Agent, Body, Error, SendBody};

use crate::address::{Address, Token, percent_encoded};
use crate::fault::Fault;
use crate::files::{FileError, cannot_be};
use crate::jobs::Progress;
use crate::limits::Limits;
use crate::line::Lines;
use crate::multipart::{Counting, Multipart};
use crate::tls;
use crate::trouble::Trouble;

/// The longest answer that is read where it is no result: lists of options have 40 KB.
const ANSWER: u64 = 4 << 20;
/// The longest piece of a task's own messages: those of some days.
const MESSAGES: u64 = 64 << 20;

/// Whoever calls.
pub(crate) struct Client<'a> {
    pub(crate) address: &'a Address,
    pub(crate) token: Option<&'a Token>,
    agent: Agent,
    /// For the call that moves all photos to their place.
    patient: Agent,
    wanted_by: Option<Progress>,
}

fn agent(lines: Lines) -> Agent {
    let config = Agent::config_builder()
        .http_status_as_error(false)
        .max_redirects(0)
        .max_redirects_will_error(false)
        // Only the address that was typed.
        .proxy(None)
        .timeout_resolve(Some(Duration::from_secs(10)))
        .max_idle_connections(0)
        .user_agent(concat!("fragscale/", env!("CARGO_PKG_VERSION")));
    tls::agent(config, lines)
}

impl<'a> Client<'a> {
    /// `wanted_by` may call calls off.
    pub(crate) fn new(
        address: &'a Address,
        token: Option<&'a Token>,
        limits: &Limits,
        wanted_by: Option<&Progress>,
    ) -> Self {
        let lines = |idle| Lines {
            wanted_by: wanted_by.cloned(),
            idle,
        };
        Self {
            address,
            token,
            agent: agent(lines(limits.idle)),
            patient: agent(lines(limits.commit)),
            wanted_by: wanted_by.cloned(),
        }
    }

    fn url(&self, path: &str, query: &str) -> String {
        self.address.url(path, query, self.token)
    }

    /// Asks for something.
    pub(crate) fn get<T: DeserializeOwned>(&self, path: &str, query: &str) -> Result<T, Trouble> {
        let most = if path.ends_with("/output") {
            MESSAGES
        } else {
            ANSWER
        };
        let answered = self.agent.get(self.url(path, query)).call();
        self.typed(answered, most)
    }

    /// Sends a form, and tells `moved` how many bytes of it went, piece by piece.
    pub(crate) fn post<T: DeserializeOwned>(
        &self,
        path: &str,
        form: Multipart,
        moved: impl FnMut(u64),
    ) -> Result<T, Trouble> {
        let (kind, length, body) = form.end();
        let mut body = Counting {
            inner: body,
            count: moved,
        };
        let call = self.agent.post(self.url(path, ""));
        let call = call.content_type(kind).header("Content-Length", length);
        self.typed(call.send(SendBody::from_reader(&mut body)), ANSWER)
    }

    /// Ends the sending of a task's files.
    pub(crate) fn commit<T: DeserializeOwned>(&self, path: &str) -> Result<T, Trouble> {
        self.typed(self.patient.post(self.url(path, "")).send_empty(), ANSWER)
    }

    /// Names a task in a form as pages send it: ClusterODM looks at no other.
    pub(crate) fn name_task(&self, path: &str, uuid: &str) -> Result<(), Trouble> {
        let call = self.agent.post(self.url(path, ""));
        let call = call.content_type("application/x-www-form-urlencoded");
        let answered = call.send(format!("uuid={}", percent_encoded(uuid)).as_str());
        self.typed::<Value>(answered, ANSWER).map(|_| ())
    }

    /// Writes what lies at `path` into a file, `most` bytes at most; `moved` is told how many have come, and of how
    /// many. Returns how many there are.
    pub(crate) fn download(
        &self,
        path: &str,
        (to, name): (&mut File, &Path),
        most: u64,
        mut moved: impl FnMut(u64, Option<u64>),
    ) -> Result<u64, Trouble> {
        let answer = self.agent.get(self.url(path, "")).call();
        let answer = self.fit(answer.map_err(|error| self.trouble(&error))?)?;
        let header = |name: &str| answer.headers().get(name)?.to_str().ok().map(str::to_owned);
        if header("content-type").is_some_and(|kind| kind.starts_with("application/json")) {
            return Err(match self.json(answer, ANSWER) {
                Err(trouble) => trouble,
                Ok(_) => Trouble::Final(no_node("a message in place of the results")),
            });
        }
        let said = header("content-length").and_then(|length| length.parse::<u64>().ok());
        let too_much = || {
            let what = format!("the results are larger than {} GB", most >> 30);
            Trouble::Worthless(Fault::new(
                what,
                "take fewer photos, or options that make a smaller cloud",
            ))
        };
        if said.is_some_and(|said| said > most) {
            return Err(too_much());
        }
        let mut body = answer
            .into_body()
            .into_with_config()
            .limit(most + 1)
            .reader();
        let mut buffer = vec![0; 1 << 16];
        let mut came = 0;
        loop {
            let now = match body.read(&mut buffer) {
                Ok(0) => break,
                Ok(now) => now,
                Err(_) if came >= most => return Err(too_much()),
                Err(error) => return Err(self.broken_off(came, said, &error)),
            };
            came += now as u64;
            if came > most {
                return Err(too_much());
            }
            let piece = buffer.get(..now).unwrap_or_default();
            to.write_all(piece)
                .map_err(|error| Trouble::Here(unwritten(name, &error)))?;
            moved(came, said);
        }
        if said.is_some_and(|said| came != said) {
            return Err(self.broken_off(came, said, &io::ErrorKind::UnexpectedEof.into()));
        }
        to.sync_all()
            .map_err(|error| Trouble::Here(unwritten(name, &error)))?;
        Ok(came)
    }

    fn broken_off(&self, came: u64, said: Option<u64>, error: &io::Error) -> Trouble {
        if self.is_cancelled() {
            return Trouble::Cancelled;
        }
        let of = said.map_or_else(String::new, |said| format!(" of {said}"));
        let why = self.hidden(&error.to_string());
        let what = format!("the results broke off after {came}{of} bytes ({why})");
        Trouble::Passing(Fault::new(
            what,
            "start it once more: it goes on with the download",
        ))
    }

    fn is_cancelled(&self) -> bool {
        self.wanted_by.as_ref().is_some_and(Progress::is_cancelled)
    }

    /// A text without the token.
    pub(crate) fn hidden(&self, text: &str) -> String {
        self.token
            .map_or_else(|| text.to_owned(), |token| token.hidden_in(text))
    }

    fn typed<T: DeserializeOwned>(
        &self,
        answered: Result<Response<Body>, Error>,
        most: u64,
    ) -> Result<T, Trouble> {
        let answer = self.fit(answered.map_err(|error| self.trouble(&error))?)?;
        let value = self.json(answer, most)?;
        serde_json::from_value(value).map_err(|error| {
            let what = format!("an answer without what it has to hold ({error})");
            Trouble::Final(no_node(&self.hidden(&what)))
        })
    }

    /// The answer, where its status says that there is one.
    fn fit(&self, answer: Response<Body>) -> Result<Response<Body>, Trouble> {
        let status = answer.status();
        match status.as_u16() {
            200..=299 => Ok(answer),
            300..=399 => {
                let to = answer.headers().get("location");
                let to = to.and_then(|to| to.to_str().ok()).unwrap_or_default();
                // Without what may be secret in it.
                let to = to.split(['?', '#']).next().unwrap_or_default();
                let what = format!(
                    "it sends on to another address (\"{}\"), which nobody typed",
                    self.hidden(to)
                );
                let remedy = "if that is the node, name it; results that a cluster keeps elsewhere cannot be taken";
                Err(Trouble::Final(Fault::new(what, remedy)))
            }
            401 | 403 => Err(Trouble::Final(self.wrong_token())),
            413 => {
                let what = "something before the node takes no file of this size (HTTP 413)";
                Err(Trouble::Final(Fault::new(
                    what,
                    "let it take larger ones (of nginx: client_max_body_size)",
                )))
            }
            408 | 429 | 500..=599 => {
                let what = format!("it cannot answer now (HTTP {status})");
                Err(Trouble::Passing(Fault::new(
                    what,
                    "look after the node, then start it once more",
                )))
            }
            _ => Err(Trouble::Final(no_node(&format!("HTTP {status}")))),
        }
    }

    fn wrong_token(&self) -> Fault {
        match self.token {
            None => Fault::new(
                "the node asks for a token",
                "set the environment variable FRAGSCALE_NODE_TOKEN to it, or give --token (in the window the field Token)",
            ),
            Some(_) => Fault::new(
                "the node refuses the token",
                "ask whoever runs the node for the right one",
            ),
        }
    }

    fn json(&self, answer: Response<Body>, most: u64) -> Result<Value, Trouble> {
        let kind = answer
            .headers()
            .get("content-type")
            .and_then(|kind| kind.to_str().ok());
        let kind = kind
            .unwrap_or("no type")
            .split(';')
            .next()
            .unwrap_or_default()
            .to_owned();
        let mut bytes = Vec::new();
        let body = answer
            .into_body()
            .into_with_config()
            .limit(most + 1)
            .reader();
        let read = body.take(most + 1).read_to_end(&mut bytes);
        if bytes.len() as u64 > most {
            return Err(Trouble::Final(no_node(&format!(
                "an answer of more than {} MB",
                most >> 20
            ))));
        }
        read.map_err(|error| self.passing(&format!("its answer broke off: {error}")))?;
        let Ok(value) = serde_json::from_slice::<Value>(&bytes) else {
            let what = if bytes.is_empty() {
                "nothing".to_owned()
            } else {
                self.hidden(&kind)
            };
            return Err(Trouble::Final(no_node(&what)));
        };
        let error = value.get("error").filter(|error| !error.is_null());
        let Some(error) = error else {
            return Ok(value);
        };
        let words = error
            .as_str()
            .map_or_else(|| error.to_string(), str::to_owned);
        let words = crate::fault::one_line(&self.hidden(&words));
        let says = |text: &str| words.contains(text);
        Err(if says("authentication token") {
            Trouble::Final(self.wrong_token())
        } else if says("not found")
            || says("no task table entry")
            || says("no nodes in routing table")
        {
            Trouble::Unknown
        } else if says("Proxy redirect error") {
            self.passing(&words)
        } else {
            Trouble::Refused(words)
        })
    }

    fn passing(&self, why: &str) -> Trouble {
        if self.is_cancelled() {
            return Trouble::Cancelled;
        }
        let what = format!("it does not answer ({})", self.hidden(why));
        Trouble::Passing(Fault::new(
            what,
            "check the address, and whether the node runs",
        ))
    }

    fn trouble(&self, error: &Error) -> Trouble {
        if let Some(fault) = tls::fault(error) {
            return Trouble::Final(fault);
        }
        match error {
            Error::Io(error) => self.passing(&in_words(error)),
            Error::HostNotFound => self.passing("its name is not known"),
            // What is no HTTP.
            Error::Protocol(_) | Error::Http(_) | Error::LargeResponseHeader(..) => {
                Trouble::Final(no_node("something that is no HTTP"))
            }
            other => self.passing(&other.to_string()),
        }
    }
}

/// As an engineer says it.
fn in_words(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::ConnectionRefused => "connection refused".to_owned(),
        io::ErrorKind::ConnectionReset
        | io::ErrorKind::BrokenPipe
        | io::ErrorKind::ConnectionAborted => "the connection was broken off".to_owned(),
        io::ErrorKind::UnexpectedEof => "the connection was closed without an answer".to_owned(),
        _ => error.to_string(),
    }
}

fn no_node(answered: &str) -> Fault {
    let what = format!("it is no NodeODM and no ClusterODM: it answers with {answered}");
    Fault::new(what, "check address and port")
}

/// A file here that cannot be written.
pub(crate) fn unwritten(path: &Path, error: &io::Error) -> FileError {
    let fault = match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => Fault::new(
            "this computer's disk is full",
            "free some space, then start it once more: it goes on with the download",
        ),
        _ => cannot_be("written", error),
    };
    FileError::new(path, fault)
}

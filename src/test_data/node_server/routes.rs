//! What the server answers to which call, word for word as it was measured.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::atomic::Ordering;
use std::time::Duration;

use super::http::{Call, form, head, json, send};
use super::{MOST_CALLS, Served, ServedTask, ServerFault, Shared, locked};

/// Uploads of lists are not longer, bytes; those of photos are.
const LISTS: usize = 400;

impl Shared {
    pub(super) fn answer(&self, stream: &TcpStream) -> std::io::Result<()> {
        stream.set_read_timeout(Some(Duration::from_secs(20)))?;
        let served = locked(&self.served).clone();
        let mut call = head(stream)?;
        {
            let mut calls = locked(&self.calls);
            let query = call.query.iter().filter(|(key, _)| *key != "token");
            let query: Vec<String> = query.map(|(key, value)| format!("{key}={value}")).collect();
            let sign = if query.is_empty() { "" } else { "?" };
            let kind = call.kind.split(';').next().unwrap_or_default();
            calls.push(
                format!(
                    "{} {}{sign}{} {kind}",
                    call.method,
                    call.path,
                    query.join("&")
                )
                .trim_end()
                .to_owned(),
            );
            if calls.len() > MOST_CALLS {
                return Ok(());
            }
        }
        match &served.fault {
            ServerFault::NeverAnswers => return self.hold(),
            ServerFault::Redirects(to) => {
                return send(stream, "301 Moved Permanently", &[("Location", to)], b"");
            }
            ServerFault::Page => {
                return send(
                    stream,
                    "200 OK",
                    &[("Content-Type", "text/html; charset=utf-8")],
                    b"<!DOCTYPE html>\n<html>It works!</html>",
                );
            }
            ServerFault::Slow => std::thread::sleep(Duration::from_millis(150)),
            _ => {}
        }
        let is_upload = call.path.starts_with("/task/new/upload/");
        let length = call.body.len();
        if is_upload {
            let now = 1 + self.under_way.fetch_add(1, Ordering::Relaxed);
            self.most_under_way.fetch_max(now, Ordering::Relaxed);
        }
        let (wanted, broken) = match served.fault {
            // Photos alone: half of what stands around a short list holds nothing of it.
            ServerFault::UploadsBrokenOff(times)
                if is_upload && length > LISTS && self.fails(times) =>
            {
                (length / 2, true)
            }
            ServerFault::UploadsRefused(times) if is_upload && self.fails(times) => (0, true),
            _ => (length, false),
        };
        call.body.truncate(wanted);
        let mut reader = stream;
        let read = reader.read_exact(&mut call.body);
        if is_upload {
            // As long as an upload takes others may come.
            std::thread::sleep(Duration::from_millis(5));
            self.under_way.fetch_sub(1, Ordering::Relaxed);
        }
        read?;
        if let Some(token) = served.token
            && call.query.get("token").map(String::as_str) != Some(token)
            && call.path != "/auth/info"
        {
            return match served.cluster {
                true => send(stream, "401 unauthorized", &[], b""),
                false => json(
                    stream,
                    r#"{"error":"Invalid authentication token: token does not match."}"#,
                ),
            };
        }
        if broken {
            if wanted > 0 {
                self.keep(&call);
                return Ok(());
            }
            return send(
                stream,
                "500 Internal Server Error",
                &[("Content-Type", "text/plain")],
                b"Internal Server Error",
            );
        }
        self.route(stream, &call, &served)
    }

    fn route(&self, stream: &TcpStream, call: &Call, served: &Served) -> std::io::Result<()> {
        let parts: Vec<&str> = call.path.trim_start_matches('/').split('/').collect();
        match (call.method.as_str(), parts.as_slice()) {
            ("GET", ["info"]) if served.fault == ServerFault::EndlessAnswer => {
                self.endless(stream, "application/json", b"[[[[[[[[")
            }
            ("GET", ["info"]) if served.cluster => json(
                stream,
                r#"{"version":"1.5.3","taskQueueCount":0,"totalMemory":99999999999,"availableMemory":99999999999,"cpuCores":99999999999,"maxImages":null,"maxParallelTasks":99999999999,"engineVersion":"?","engine":"odm"}"#,
            ),
            ("GET", ["info"]) => json(
                stream,
                r#"{"version":"2.2.4","taskQueueCount":0,"totalMemory":25276514304,"availableMemory":24078979072,"cpuCores":2,"maxImages":null,"maxParallelTasks":1,"engineVersion":"?","engine":"odm"}"#,
            ),
            ("GET", ["options"]) => json(stream, OPTIONS),
            ("POST", ["task", "new", "init"]) => self.init(stream, call),
            ("POST", ["task", "new", "upload", uuid]) => self.upload(stream, call, uuid, served),
            ("POST", ["task", "new", "commit", uuid]) => self.commit(stream, uuid, served),
            ("POST", ["task", what @ ("cancel" | "remove")]) => {
                self.end(stream, call, what, served)
            }
            ("GET", ["task", uuid, "info"]) => self.info(stream, uuid, served),
            ("GET", ["task", uuid, "output"]) => self.output(stream, call, uuid, served),
            ("GET", ["task", uuid, "download", "all.zip"]) => self.download(stream, uuid, served),
            _ if served.cluster => json(
                stream,
                &format!("{{\"error\":\"Cannot handle {}\"}}", call.path),
            ),
            _ => send(
                stream,
                "404 Not Found",
                &[("Content-Type", "text/html; charset=utf-8")],
                b"<!DOCTYPE html>\n<pre>Cannot GET</pre>",
            ),
        }
    }

    /// Whether this one is among the first that fail.
    fn fails(&self, times: usize) -> bool {
        self.failed.fetch_add(1, Ordering::Relaxed) < times
    }

    fn hold(&self) -> std::io::Result<()> {
        while !self.stops.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(20));
        }
        Ok(())
    }

    fn endless(&self, mut stream: &TcpStream, kind: &str, bytes: &[u8]) -> std::io::Result<()> {
        write!(
            stream,
            "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nConnection: close\r\n\r\n"
        )?;
        let piece = bytes.repeat(1 << 13);
        while !self.stops.load(Ordering::Relaxed) {
            stream.write_all(&piece)?;
        }
        Ok(())
    }

    fn init(&self, stream: &TcpStream, call: &Call) -> std::io::Result<()> {
        let mut tasks = locked(&self.tasks);
        let uuid = format!("fda57596-9d93-48f0-8e5b-{:012}", tasks.len() + 1);
        let task = ServedTask {
            fields: form(call)
                .into_iter()
                .map(|part| (part.name, String::from_utf8_lossy(&part.bytes).into_owned()))
                .collect(),
            ..ServedTask::default()
        };
        tasks.push((uuid.clone(), task));
        drop(tasks);
        json(stream, &format!("{{\"uuid\":\"{uuid}\"}}"))
    }

    /// Keeps what came of an upload; whether there was a file.
    fn keep(&self, call: &Call) -> bool {
        let uuid = call.path.rsplit('/').next().unwrap_or_default();
        let mut tasks = locked(&self.tasks);
        let Some((_, task)) = tasks
            .iter_mut()
            .find(|(name, task)| name == uuid && !task.committed)
        else {
            return false;
        };
        let mut is_there = false;
        for part in form(call).into_iter().filter(|part| part.name == "images") {
            let mut name = part.file;
            while task.files.iter().any(|(other, _)| *other == name) {
                let (stem, ending) = name.rsplit_once('.').unwrap_or((&name, ""));
                name = format!("{stem}_.{ending}");
            }
            task.files.push((name, part.bytes));
            is_there = true;
        }
        is_there
    }

    fn upload(
        &self,
        stream: &TcpStream,
        call: &Call,
        uuid: &str,
        served: &Served,
    ) -> std::io::Result<()> {
        if served.fault == ServerFault::DiskFull {
            return json(
                stream,
                r#"{"error":"ENOSPC: no space left on device, write"}"#,
            );
        }
        if !locked(&self.tasks)
            .iter()
            .any(|(name, task)| name == uuid && !task.committed)
        {
            return json(stream, r#"{"error":"Invalid uuid (not found)"}"#);
        }
        match self.keep(call) {
            true => json(stream, r#"{"success":true}"#),
            false if served.cluster => Ok(()),
            false => json(
                stream,
                r#"{"error":"Need at least 1 file.","noRetry":true}"#,
            ),
        }
    }

    fn commit(&self, stream: &TcpStream, uuid: &str, served: &Served) -> std::io::Result<()> {
        let mut tasks = locked(&self.tasks);
        let task = tasks
            .iter_mut()
            .find(|(name, task)| name == uuid && !task.committed);
        let Some((_, task)) = task else {
            return json(stream, r#"{"error":"Invalid uuid (not found)"}"#);
        };
        if task.files.is_empty() {
            return json(stream, r#"{"error":"Need at least 1 file."}"#);
        }
        task.committed = true;
        drop(tasks);
        if served.fault == ServerFault::CommitAnswerLost {
            return Ok(());
        }
        json(stream, &format!("{{\"uuid\":\"{uuid}\"}}"))
    }

    fn unknown(stream: &TcpStream, uuid: &str, what: &str, served: &Served) -> std::io::Result<()> {
        match served.cluster {
            true => json(
                stream,
                &format!(
                    "{{\"error\":\"Invalid route for taskId {uuid}:{what}, no task table entry.\"}}"
                ),
            ),
            false => json(stream, &format!("{{\"error\":\"{uuid} not found\"}}")),
        }
    }

    fn end(
        &self,
        stream: &TcpStream,
        call: &Call,
        what: &str,
        served: &Served,
    ) -> std::io::Result<()> {
        let text = String::from_utf8_lossy(&call.body).into_owned();
        if served.cluster && call.kind != "application/x-www-form-urlencoded" {
            return json(stream, r#"{"error":"exception"}"#);
        }
        let Some(uuid) = text.strip_prefix("uuid=") else {
            return json(stream, r#"{"error":"uuid param missing."}"#);
        };
        let mut tasks = locked(&self.tasks);
        let known = |(name, task): &&mut (String, ServedTask)| {
            name == uuid && task.committed && !task.removed
        };
        let Some((_, task)) = tasks.iter_mut().find(known) else {
            let answer = match served.cluster {
                true => format!(
                    "{{\"error\":\"Invalid route for taskId {uuid}, no nodes in routing table.\"}}"
                ),
                false => format!("{{\"success\":false,\"error\":\"{uuid} not found\"}}"),
            };
            return json(stream, &answer);
        };
        match what {
            "cancel" => task.cancelled = true,
            _ => task.removed = true,
        }
        json(stream, r#"{"success":true}"#)
    }

    fn info(&self, stream: &TcpStream, uuid: &str, served: &Served) -> std::io::Result<()> {
        let mut tasks = locked(&self.tasks);
        let known = |(name, task): &&mut (String, ServedTask)| {
            name == uuid && task.committed && !task.removed
        };
        let Some((_, task)) = tasks.iter_mut().find(known) else {
            return Self::unknown(stream, uuid, "info", served);
        };
        let poll = task.polls;
        task.polls += 1;
        match served.fault {
            ServerFault::Forgets if poll > 0 => return Self::unknown(stream, uuid, "info", served),
            ServerFault::Dies if poll > 0 => {
                self.is_dead.store(true, Ordering::Relaxed);
                return Ok(());
            }
            _ => {}
        }
        let files = task.files.len();
        let photos = task
            .files
            .iter()
            .filter(|(name, _)| !name.ends_with(".txt"))
            .count();
        let is_over = task.polls >= served.polls && served.fault != ServerFault::NeverEnds;
        let status = match &served.fault {
            _ if task.cancelled => r#"{"code":50}"#.to_owned(),
            ServerFault::CancelledThere if is_over => r#"{"code":50}"#.to_owned(),
            ServerFault::Fails("") if is_over => r#"{"code":30}"#.to_owned(),
            ServerFault::Fails(words) if is_over => {
                format!("{{\"code\":30,\"errorMessage\":\"{words}\"}}")
            }
            _ if is_over => r#"{"code":40}"#.to_owned(),
            _ => r#"{"code":20}"#.to_owned(),
        };
        let options = r#"[{"name":"pc-quality","value":"medium"}]"#;
        let begin =
            format!("{{\"uuid\":\"{uuid}\",\"name\":\"pile\",\"dateCreated\":1795315232974");
        let answer = match (poll, served.cluster) {
            // The cluster has not handed it on.
            (0, true) => format!(
                "{begin},\"status\":{{\"code\":20}},\"options\":{options},\"imagesCount\":{files},\"processingTime\":58}}"
            ),
            // The node has not looked yet: what it says is an estimate.
            (0, false) => format!(
                "{begin},\"processingTime\":-1,\"status\":{{\"code\":20}},\"options\":{options},\"imagesCount\":{files},\"progress\":0}}"
            ),
            _ => {
                let progress = if is_over { 100 } else { 10 * poll.min(9) };
                let time = 1001 * poll;
                format!(
                    "{begin},\"processingTime\":{time},\"status\":{status},\"options\":{options},\"imagesCount\":{photos},\"progress\":{progress}}}"
                )
            }
        };
        drop(tasks);
        json(stream, &answer)
    }

    fn output(
        &self,
        stream: &TcpStream,
        call: &Call,
        uuid: &str,
        served: &Served,
    ) -> std::io::Result<()> {
        let polls = {
            let tasks = locked(&self.tasks);
            let found = tasks.iter().find(|(name, _)| name == uuid);
            found.map_or(0, |(_, task)| task.polls)
        };
        let launching = vec!["Launching... please wait! This can take a few minutes.".to_owned()];
        let lines = if served.cluster && polls <= 1 {
            &launching
        } else {
            &served.messages
        };
        let from: usize = call
            .query
            .get("line")
            .and_then(|line| line.parse().ok())
            .unwrap_or(0);
        let quoted = lines.iter().skip(from).map(|line| format!("{line:?}"));
        let text = format!("[{}]", quoted.collect::<Vec<_>>().join(","));
        json(stream, &text)
    }

    fn download(&self, mut stream: &TcpStream, uuid: &str, served: &Served) -> std::io::Result<()> {
        if !locked(&self.tasks)
            .iter()
            .any(|(name, task)| name == uuid && !task.removed)
        {
            return Self::unknown(stream, uuid, "download/all.zip", served);
        }
        let bytes = &served.results;
        let said = match &served.fault {
            ServerFault::TooShort(times) if self.fails(*times) => bytes.len() + 1000,
            ServerFault::TooLong => bytes.len() / 2,
            ServerFault::EndlessResults => {
                return self.endless(stream, "application/zip", b"PK\x03\x04");
            }
            ServerFault::NotReady(times) if self.fails(*times) => {
                return json(stream, r#"{"error":"Asset not ready"}"#);
            }
            ServerFault::RedirectsResults(to) => {
                return send(stream, "301 Moved Permanently", &[("Location", to)], b"");
            }
            ServerFault::PageForResults => {
                return send(
                    stream,
                    "200 OK",
                    &[("Content-Type", "text/html")],
                    b"<html>Sign in</html>",
                );
            }
            _ => bytes.len(),
        };
        write!(
            stream,
            "HTTP/1.1 200 OK\r\nX-Powered-By: Express\r\nAccess-Control-Allow-Origin: *\r\n\
             Content-Disposition: attachment; filename=all.zip\r\nContent-Type: application/zip\r\n\
             Content-Length: {said}\r\nConnection: close\r\n\r\n"
        )?;
        if served.fault == ServerFault::Slow {
            for piece in bytes.chunks(bytes.len() / 20 + 1) {
                stream.write_all(piece)?;
                std::thread::sleep(Duration::from_millis(20));
            }
            return Ok(());
        }
        stream.write_all(bytes)
    }
}

/// Of NodeODM 2.2.4, a few.
const OPTIONS: &str = r#"[{"name":"end-with","type":"enum","value":"odm_postprocess","domain":["dataset","split","merge","opensfm","openmvs","odm_filterpoints","odm_meshing","mvs_texturing","odm_georeferencing","odm_dem","odm_orthophoto","odm_report","odm_postprocess"],"help":"End processing at this stage."},{"name":"pc-quality","type":"enum","value":"medium","domain":["ultra","high","medium","low","lowest"],"help":""},{"name":"feature-quality","type":"enum","value":"high","domain":["ultra","high","medium","low","lowest"],"help":""},{"name":"dsm","type":"bool","value":"false","domain":"","help":""},{"name":"skip-3dmodel","type":"bool","value":"false","domain":"","help":""},{"name":"skip-orthophoto","type":"bool","value":"false","domain":"","help":""},{"name":"dem-resolution","type":"float","value":"5","domain":"float","help":""},{"name":"boundary","type":"string","value":"","domain":"json","help":""}]"#;

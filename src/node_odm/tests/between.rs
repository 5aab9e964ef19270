//! Stands between a run and its node, and spoils single calls as networks and proxies do.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;

/// What becomes of a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Becomes {
    /// It is handed on, and so is its answer.
    Answered,
    /// The node does not hear of it, and the line is closed.
    Unheard,
    /// The node hears of it; its answer is lost.
    Unanswered,
    /// The node does not hear of it, which is said.
    BadGateway,
    /// It is answered as a node does that knows no such task.
    NotFound,
}

pub(super) struct Between {
    port: u16,
    stops: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Between {
    /// Hands on to a node; `becomes` is asked of every call ("METHOD /path?query").
    pub(super) fn start(
        node: &str,
        becomes: impl Fn(&str) -> Becomes + Send + Sync + 'static,
    ) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        let node = node.strip_prefix("http://").unwrap().to_owned();
        let stops = Arc::new(AtomicBool::new(false));
        let (stopped, becomes) = (stops.clone(), Arc::new(becomes));
        let thread = std::thread::spawn(move || {
            for stream in listener.incoming().map_while(Result::ok) {
                if stopped.load(Ordering::Relaxed) {
                    return;
                }
                let (node, becomes) = (node.clone(), becomes.clone());
                std::thread::spawn(move || {
                    // A line that breaks off is what is tested.
                    let _ = hand_on(&stream, &node, &*becomes);
                    let _ = stream.shutdown(Shutdown::Both);
                });
            }
        });
        Self {
            port,
            stops,
            thread: Some(thread),
        }
    }

    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}", self.port)
    }
}

impl Drop for Between {
    fn drop(&mut self) {
        self.stops.store(true, Ordering::Relaxed);
        // Wakes the listener.
        drop(TcpStream::connect(("127.0.0.1", self.port)));
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn hand_on(
    mut stream: &TcpStream,
    node: &str,
    becomes: &impl Fn(&str) -> Becomes,
) -> std::io::Result<()> {
    let mut call = Vec::new();
    let mut byte = [0];
    while !call.ends_with(b"\r\n\r\n") {
        stream.read_exact(&mut byte)?;
        call.extend(byte);
    }
    let head = String::from_utf8_lossy(&call).to_ascii_lowercase();
    let length = head
        .lines()
        .find_map(|line| line.strip_prefix("content-length: "));
    let mut body = vec![0; length.map_or(0, |length| length.parse().unwrap())];
    stream.read_exact(&mut body)?;
    let text = String::from_utf8_lossy(&call).into_owned();
    let first = text.split(" HTTP/1.1\r\n").next().unwrap_or_default();
    let becomes = becomes(first);
    match becomes {
        Becomes::Unheard => return Ok(()),
        Becomes::BadGateway => {
            let page = "<html>502 Bad Gateway</html>";
            let length = page.len();
            return write!(
                stream,
                "HTTP/1.1 502 Bad Gateway\r\nContent-Type: text/html\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n{page}"
            );
        }
        Becomes::NotFound => {
            let answer = r#"{"error":"Invalid uuid (not found)"}"#;
            let length = answer.len();
            return write!(
                stream,
                "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n{answer}"
            );
        }
        Becomes::Answered | Becomes::Unanswered => {}
    }
    let mut to = TcpStream::connect(node)?;
    to.write_all(&call)?;
    to.write_all(&body)?;
    let mut answer = Vec::new();
    to.read_to_end(&mut answer)?;
    match becomes {
        Becomes::Unanswered => Ok(()),
        _ => stream.write_all(&answer),
    }
}

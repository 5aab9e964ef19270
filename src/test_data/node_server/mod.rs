//! A NodeODM and a ClusterODM for tests: answers on this computer as the two were measured to answer (NodeODM 2.2.4,
//! ClusterODM 1.5.8), and can be made to fail in every way that was seen. It computes nothing: its results are given.

mod http;
mod routes;

use std::collections::HashMap;
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// How a server fails.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ServerFault {
    /// It does not.
    None,
    /// So many uploads are broken off halfway. What came stays, and the next try is renamed.
    UploadsBrokenOff(usize),
    /// So many uploads are answered by HTTP 500, before anything of them is kept.
    UploadsRefused(usize),
    /// The node has no space for uploads.
    DiskFull,
    /// The answer to the commit is lost.
    CommitAnswerLost,
    /// The task fails in these words.
    Fails(&'static str),
    /// Somebody cancels the task on the node.
    CancelledThere,
    /// It was killed and started anew while it worked: the task is gone.
    Forgets,
    /// It was killed while it worked, and stays so.
    Dies,
    /// Every answer takes a while.
    Slow,
    /// No answer ever comes.
    NeverAnswers,
    /// The task never ends.
    NeverEnds,
    /// So many downloads are announced longer than they are.
    TooShort(usize),
    /// Downloads are announced shorter than they are.
    TooLong,
    /// The results never end, and no length is announced.
    EndlessResults,
    /// So many times the results are not ready although the task has ended.
    NotReady(usize),
    /// Every call is sent on to this address.
    Redirects(String),
    /// The results are sent on to this address.
    RedirectsResults(String),
    /// Something else answers here: a page.
    Page,
    /// The answer to `/info` never ends.
    EndlessAnswer,
    /// The results' `all.zip` is a page.
    PageForResults,
}

/// What a server is to be.
#[derive(Debug, Clone)]
pub struct Served {
    /// Whether it is a ClusterODM in front of a node.
    pub cluster: bool,
    /// The token that it asks for.
    pub token: Option<&'static str>,
    /// The results of every task, a zip archive.
    pub results: Vec<u8>,
    /// How often a task is asked for until it has ended.
    pub polls: usize,
    /// How it fails.
    pub fault: ServerFault,
    /// The node's messages.
    pub messages: Vec<String>,
}

impl Default for Served {
    fn default() -> Self {
        Self {
            cluster: false,
            token: None,
            results: Vec::new(),
            polls: 3,
            fault: ServerFault::None,
            messages: vec!["matching".to_owned(), "Compressing all.zip\n".to_owned()],
        }
    }
}

/// A task as a server has it.
#[derive(Debug, Clone, Default)]
pub struct ServedTask {
    /// The fields that began it.
    pub fields: HashMap<String, String>,
    /// The files that have arrived, by the names that the node gave them.
    pub files: Vec<(String, Vec<u8>)>,
    /// Whether it was committed.
    pub committed: bool,
    /// Whether it was cancelled.
    pub cancelled: bool,
    /// Whether it was removed.
    pub removed: bool,
    polls: usize,
}

/// A server on this computer, until it is dropped.
#[derive(Debug)]
pub struct NodeServer {
    port: u16,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug)]
struct Shared {
    served: Mutex<Served>,
    tasks: Mutex<Vec<(String, ServedTask)>>,
    calls: Mutex<Vec<String>>,
    /// Uploads, downloads that have failed so far.
    failed: AtomicUsize,
    under_way: AtomicUsize,
    most_under_way: AtomicUsize,
    stops: AtomicBool,
    /// Whether nobody is let in any more.
    is_dead: AtomicBool,
}

/// A test that calls more often than this asks without end.
const MOST_CALLS: usize = 3000;

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[expect(clippy::expect_used, reason = "in a test a panic is the report")]
impl NodeServer {
    /// Starts one.
    ///
    /// # Panics
    /// Where the system gives no port.
    pub fn start(served: Served) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let port = listener.local_addr().expect("a port").port();
        let shared = Arc::new(Shared {
            served: Mutex::new(served),
            tasks: Mutex::default(),
            calls: Mutex::default(),
            failed: AtomicUsize::new(0),
            under_way: AtomicUsize::new(0),
            most_under_way: AtomicUsize::new(0),
            stops: AtomicBool::new(false),
            is_dead: AtomicBool::new(false),
        });
        let theirs = shared.clone();
        let thread = std::thread::spawn(move || {
            let mut listener = Some(listener);
            while let Some(open) = &listener {
                let Ok((stream, _)) = open.accept() else {
                    break;
                };
                if theirs.stops.load(Ordering::Relaxed) {
                    break;
                }
                if theirs.is_dead.load(Ordering::Relaxed) {
                    listener = None;
                    continue;
                }
                let shared = theirs.clone();
                std::thread::spawn(move || {
                    // A line that breaks off is what is tested.
                    let _ = shared.answer(&stream);
                    let _ = stream.shutdown(Shutdown::Both);
                    if shared.is_dead.load(Ordering::Relaxed) {
                        // Wakes the listener.
                        let _ = stream.local_addr().map(TcpStream::connect);
                    }
                });
            }
        });
        Self {
            port,
            shared,
            thread: Some(thread),
        }
    }

    /// Where it answers.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}", self.port)
    }

    /// What it is from now on.
    pub fn now_serves(&self, change: impl FnOnce(&mut Served)) {
        change(&mut locked(&self.shared.served));
    }

    /// Every call so far, "METHOD /path?query", without tokens, and with the type of its body.
    pub fn calls(&self) -> Vec<String> {
        locked(&self.shared.calls).clone()
    }

    /// The tasks so far.
    pub fn tasks(&self) -> Vec<ServedTask> {
        locked(&self.shared.tasks)
            .iter()
            .map(|(_, task)| task.clone())
            .collect()
    }

    /// How many uploads were under way at once.
    pub fn most_at_once(&self) -> usize {
        self.shared.most_under_way.load(Ordering::Relaxed)
    }

    /// Waits until something holds, for a minute.
    ///
    /// # Panics
    /// Where it does not.
    pub fn wait_until(&self, holds: impl Fn(&Self) -> bool) {
        for _ in 0..6000 {
            if holds(self) {
                return;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        let calls = self.calls();
        assert!(holds(self), "{calls:?}");
    }
}

impl Drop for NodeServer {
    fn drop(&mut self) {
        self.shared.stops.store(true, Ordering::Relaxed);
        // Wakes the listener.
        drop(TcpStream::connect(("127.0.0.1", self.port)));
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

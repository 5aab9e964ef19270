//! Handing a task over, on lines that fail: nothing that was sent is lost.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::between::{Becomes, Between};
use super::*;

/// Runs through a line on which calls that hold a text become something, so many times.
fn through(
    desk: &Desk,
    text: &'static str,
    times: usize,
    spoilt: Becomes,
) -> Result<Reconstructed, String> {
    let left = Arc::new(AtomicUsize::new(times));
    let line = Between::start(&desk.server.address(), move |call| {
        let takes = |left: usize| left.checked_sub(1);
        let is_meant = call.contains(text);
        match is_meant
            && left
                .fetch_update(Ordering::Relaxed, Ordering::Relaxed, takes)
                .is_ok()
        {
            true => spoilt,
            false => Becomes::Answered,
        }
    });
    desk.run_request(&NodeRequest {
        node: Address::parse(&line.address()).unwrap(),
        ..desk.request()
    })
}

/// The call that ends the sending fails, with and without the node hearing of it.
#[test]
fn a_commit_that_fails_is_made_again() {
    for cluster in [false, true] {
        for spoilt in [Becomes::Unheard, Becomes::BadGateway, Becomes::Unanswered] {
            let desk = Desk::new(Served {
                cluster,
                ..Served::default()
            });
            let made = through(&desk, "/task/new/commit/", 3, spoilt);
            assert!(made.is_ok(), "{spoilt:?}: {made:?}");
            let [task] = &desk.server.tasks()[..] else {
                panic!("one task")
            };
            assert!(task.committed && task.removed && !task.cancelled);
            assert_eq!(desk.called("POST /task/new/upload/"), 4);
        }
    }
}

/// Given up, the task is remembered with what arrived, and the same run commits it.
#[test]
fn a_commit_that_was_given_up_is_gone_on_with() {
    let desk = Desk::faulty(ServerFault::None);
    let line = Between::start(&desk.server.address(), |call| {
        match call.contains("/task/new/commit/") {
            true => Becomes::BadGateway,
            false => Becomes::Answered,
        }
    });
    let error = desk
        .run_request(&NodeRequest {
            node: Address::parse(&line.address()).unwrap(),
            ..desk.request()
        })
        .unwrap_err();
    assert!(
        error.contains("HTTP 502") && error.contains("it goes on with what the node has"),
        "{error}"
    );
    assert!(!desk.server.tasks()[0].cancelled);
    goes_on_through(&desk, &line);
}

/// The same once more from the same address, with the node behind it as it is now.
fn goes_on_through(desk: &Desk, line: &Between) {
    // (The folder is of the line's address: the node is that, as far as anybody knows.)
    let task = desk.to().join("unfinished/task.json");
    let text = fs::read_to_string(&task).unwrap();
    let direct = desk.server.address();
    fs::write(&task, text.replace(&line.address(), &direct)).unwrap();
    let photos = desk.to().join("unfinished/photos.txt");
    let text = fs::read_to_string(&photos).unwrap();
    fs::write(&photos, text.replace(&line.address(), &direct)).unwrap();
    desk.run().unwrap();
    let [task] = &desk.server.tasks()[..] else {
        panic!("one task")
    };
    assert!(task.committed && task.removed);
    assert_eq!(task.files.len(), 4);
}

/// Broken off while it sends, a second run sends what has not arrived.
#[test]
fn what_has_arrived_is_not_sent_again() {
    let desk = Desk::faulty(ServerFault::None);
    let sent = AtomicUsize::new(0);
    let line = Between::start(&desk.server.address(), move |call| {
        let is_upload = call.contains("/task/new/upload/");
        match is_upload && sent.fetch_add(1, Ordering::Relaxed) >= 2 {
            true => Becomes::Unheard,
            false => Becomes::Answered,
        }
    });
    let request = NodeRequest {
        node: Address::parse(&line.address()).unwrap(),
        ..desk.request()
    };
    let error = desk.run_request(&request).unwrap_err();
    assert!(error.contains("could not be sent for"), "{error}");
    assert!(!desk.server.tasks()[0].cancelled);
    let arrived = fs::read_to_string(desk.to().join("unfinished/arrived.txt")).unwrap();
    assert_eq!(arrived.lines().count(), 2, "{arrived}");
    goes_on_through(&desk, &line);
    assert_eq!(desk.called("POST /task/new/upload/"), 4);
    assert!(!desk.to().join("unfinished").exists());
}

/// Killed while the node moves the photos to their place, where nobody finds them for a while: it is waited for.
#[test]
fn a_task_on_its_way_is_waited_for() {
    let desk = Desk::faulty(ServerFault::None);
    let is_second = Arc::new(AtomicBool::new(false));
    let (second, hidden) = (is_second.clone(), AtomicUsize::new(0));
    let line = Between::start(&desk.server.address(), move |call| {
        let is_commit = call.contains("/task/new/commit/");
        if !second.load(Ordering::Relaxed) {
            return match is_commit {
                true => Becomes::BadGateway,
                false => Becomes::Answered,
            };
        }
        let is_hidden = is_commit || (call.contains("/task/") && call.contains("/info"));
        match is_hidden && hidden.fetch_add(1, Ordering::Relaxed) < 5 {
            true => Becomes::NotFound,
            false => Becomes::Answered,
        }
    });
    let request = NodeRequest {
        node: Address::parse(&line.address()).unwrap(),
        ..desk.request()
    };
    desk.run_request(&request).unwrap_err();
    is_second.store(true, Ordering::Relaxed);
    desk.run_request(&request).unwrap();
    assert_eq!(desk.server.tasks().len(), 1);
    assert_eq!(desk.called("POST /task/new/upload/"), 4);
}

/// Nobody looks at a bar that stands still without a word.
#[test]
fn what_is_waited_for_is_said() {
    let desk = Desk::faulty(ServerFault::UploadsRefused(usize::MAX));
    let request = NodeRequest {
        limits: Limits {
            give_up: Duration::from_secs(60),
            ..quick()
        },
        ..desk.request()
    };
    let progress = Progress::default();
    std::thread::scope(|scope| {
        let run = scope.spawn(|| reconstruct_on_node(&request, &|_| {}, &progress));
        desk.server.wait_until(|_| {
            let (stage, _) = progress.snapshot();
            stage
                .ends_with("; it cannot answer now (HTTP 500 Internal Server Error), sending again")
        });
        progress.cancel();
        let error = run.join().unwrap().unwrap_err();
        assert!(
            error.fault.what.contains("throws away by itself"),
            "{error}"
        );
    });
    assert!(!desk.to().exists());
}

/// What the node has thrown away meanwhile is sent again.
#[test]
fn what_the_node_has_forgotten_is_begun_anew() {
    let desk = Desk::faulty(ServerFault::UploadsRefused(usize::MAX));
    desk.error();
    let task = desk.to().join("unfinished/task.json");
    let text = fs::read_to_string(&task).unwrap();
    fs::write(&task, text.replace("000000000001", "00000000000f")).unwrap();
    desk.server
        .now_serves(|served| served.fault = ServerFault::None);
    desk.run().unwrap();
    let tasks = desk.server.tasks();
    assert_eq!(tasks.len(), 2);
    assert!(!tasks[0].committed && tasks[1].removed);
}

/// A task that has ended well is nobody's to throw away.
#[test]
fn a_task_that_has_ended_outlives_a_cancel() {
    let desk = Desk::faulty(ServerFault::Slow);
    let request = desk.request();
    let progress = Progress::default();
    std::thread::scope(|scope| {
        let run = scope.spawn(|| reconstruct_on_node(&request, &|_| {}, &progress));
        desk.server.wait_until(|server| {
            let calls = server.calls();
            calls.iter().any(|call| call.ends_with("/all.zip"))
        });
        progress.cancel();
        let error = run.join().unwrap().unwrap_err().fault.to_string();
        assert!(
            error.contains(
                "the task has ended on the node, which keeps its results; start it once more"
            ),
            "{error}"
        );
    });
    let task = &desk.server.tasks()[0];
    assert!(!task.cancelled && !task.removed);
    desk.server
        .now_serves(|served| served.fault = ServerFault::None);
    desk.run().unwrap();
    assert_eq!(desk.server.tasks().len(), 1);
}

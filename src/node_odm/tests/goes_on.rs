//! What is left where a run ends before its time, and what the next one makes of it.

use super::*;

/// A run of ours that ended (a crash, a node out of reach) has its task on the node: the next one takes its results.
#[test]
fn a_second_run_goes_on_with_the_task() {
    for cluster in [false, true] {
        let desk = Desk::new(Served {
            cluster,
            fault: ServerFault::NeverEnds,
            ..Served::default()
        });
        let progress = Progress::default();
        std::thread::scope(|scope| {
            let run =
                scope.spawn(|| reconstruct_on_node(&desk.impatient_request(), &|_| {}, &progress));
            desk.wait_until_asked(3);
            desk.server
                .now_serves(|served| served.fault = ServerFault::NeverAnswers);
            let error = run.join().unwrap().unwrap_err();
            assert!(
                error.to_string().contains("goes on with the task"),
                "{error}"
            );
        });
        // Whoever opens it meanwhile is told.
        assert!(desk.to().join("unfinished/photos.txt").is_file());
        desk.server
            .now_serves(|served| served.fault = ServerFault::None);
        desk.run().unwrap();
        let [task] = &desk.server.tasks()[..] else {
            panic!("one task")
        };
        assert!(task.removed);
        assert_eq!(desk.called("POST /task/new/init"), 1);
        assert!(!desk.to().join("unfinished").exists());
    }
}

/// Other options are no slip of the pen: hours of the node's work are not thrown away for them.
#[test]
fn other_options_are_refused() {
    let desk = Desk::faulty(ServerFault::TooShort(usize::MAX));
    let asked = |options: &[&str]| NodeRequest {
        options: options.iter().map(|of| Asked::parse(of).unwrap()).collect(),
        ..desk.request()
    };
    desk.run_request(&asked(&["pc-quality=high"])).unwrap_err();
    desk.server
        .now_serves(|served| served.fault = ServerFault::None);
    let error = desk.run().unwrap_err();
    assert!(
        error.contains("the task that the node works on was asked with pc-quality=high; give the same options, or remove"),
        "{error}"
    );
    let error = desk.run_request(&asked(&["dsm"])).unwrap_err();
    assert!(
        error.contains("was asked with pc-quality=high and without dsm=true;"),
        "{error}"
    );
    let [task] = &desk.server.tasks()[..] else {
        panic!("one task")
    };
    assert!(!task.cancelled && !task.removed);
    desk.run_request(&asked(&["pc-quality=high"])).unwrap();
    assert_eq!(desk.server.tasks().len(), 1);
}

/// Other photos are another task; that of before is removed from its node.
#[test]
fn another_request_is_another_task() {
    let desk = Desk::faulty(ServerFault::TooShort(usize::MAX));
    desk.error();
    desk.server
        .now_serves(|served| served.fault = ServerFault::None);
    fs::write(
        desk.photos().join("geo.txt"),
        "EPSG:32615\nIMG_2.JPG 1 2 3\n",
    )
    .unwrap();
    let made = desk.run().unwrap();
    let tasks = desk.server.tasks();
    assert_eq!(tasks.len(), 2);
    assert!(tasks[0].cancelled && tasks[0].removed && tasks[1].removed);
    assert!(
        !made.warnings.iter().any(|warning| warning.contains("page")),
        "{:?}",
        made.warnings
    );

    // That of a node that was not typed this time is left alone, and said.
    let desk = Desk::faulty(ServerFault::TooShort(usize::MAX));
    desk.error();
    let other = NodeServer::start(Served {
        results: results(),
        ..Served::default()
    });
    let before = desk.server.calls().len();
    let request = NodeRequest {
        node: Address::parse(&other.address()).unwrap(),
        ..desk.request()
    };
    let made = desk.run_request(&request).unwrap();
    assert!(
        made.warnings
            .iter()
            .any(|warning| warning.contains("remove the task fda57596")),
        "{:?}",
        made.warnings
    );
    assert_eq!(desk.server.calls().len(), before);
}

/// Cancelled, whatever it is doing, it is over soon, the node is told, and nothing is left here.
#[test]
fn cancelling_calls_the_task_off() {
    for cluster in [false, true] {
        let desk = Desk::new(Served {
            cluster,
            fault: ServerFault::NeverEnds,
            ..Served::default()
        });
        let progress = Progress::default();
        std::thread::scope(|scope| {
            let run = scope.spawn(|| reconstruct_on_node(&desk.request(), &|_| {}, &progress));
            desk.wait_until_asked(2);
            progress.cancel();
            let error = run.join().unwrap().unwrap_err();
            assert!(
                error
                    .fault
                    .what
                    .contains("the task on the node was cancelled and removed"),
                "{error}"
            );
        });
        let [task] = &desk.server.tasks()[..] else {
            panic!("one task")
        };
        assert!(task.cancelled && task.removed);
        assert!(!desk.to().exists());
        let calls = desk.server.calls();
        for what in ["cancel", "remove"] {
            let call = format!("POST /task/{what} application/x-www-form-urlencoded");
            assert!(calls.contains(&call), "{calls:?}");
        }
    }
}

/// Where the node does not hear it, the task is remembered.
#[test]
fn a_task_that_cannot_be_called_off_is_remembered() {
    let desk = Desk::faulty(ServerFault::NeverEnds);
    let progress = Progress::default();
    std::thread::scope(|scope| {
        let run =
            scope.spawn(|| reconstruct_on_node(&desk.impatient_request(), &|_| {}, &progress));
        desk.wait_until_asked(2);
        desk.server
            .now_serves(|served| served.fault = ServerFault::NeverAnswers);
        progress.cancel();
        let error = run.join().unwrap().unwrap_err();
        assert!(
            error
                .fault
                .what
                .contains("could not be removed from the node"),
            "{error}"
        );
    });
    assert!(desk.to().join("unfinished/task.json").is_file());
    desk.server
        .now_serves(|served| served.fault = ServerFault::None);
    desk.run().unwrap();
    assert_eq!(desk.server.tasks().len(), 1);
}

/// What a run leaves that ends between the last steps is taken away by the next; what is somebody else's is not.
#[test]
fn the_last_steps_can_be_done_again() {
    let desk = Desk::faulty(ServerFault::TooShort(usize::MAX));
    desk.error();
    desk.server
        .now_serves(|served| served.fault = ServerFault::None);
    let odm = desk.to().join("odm");
    fs::create_dir(&odm).unwrap();
    fs::write(odm.join("mine.txt"), "mine").unwrap();
    let error = desk.run().unwrap_err();
    assert!(
        error.contains("it is there already; name a new folder"),
        "{error}"
    );
    assert_eq!(fs::read_to_string(odm.join("mine.txt")).unwrap(), "mine");
    fs::write(desk.to().join("unfinished/placed"), "").unwrap();
    desk.run().unwrap();
    assert!(!odm.join("mine.txt").exists());
    assert_eq!(desk.server.tasks().len(), 1);
}

#[test]
fn two_runs_in_one_folder_do_not_mix() {
    let desk = Desk::faulty(ServerFault::NeverEnds);
    let progress = Progress::default();
    std::thread::scope(|scope| {
        let run = scope.spawn(|| reconstruct_on_node(&desk.request(), &|_| {}, &progress));
        desk.server.wait_until(|server| {
            server
                .calls()
                .iter()
                .any(|call| call.ends_with("/info") && call.contains("/task/"))
        });
        let error = desk.run().unwrap_err();
        assert!(
            error.contains("another run works in this folder"),
            "{error}"
        );
        assert_eq!(desk.server.tasks().len(), 1);
        progress.cancel();
        run.join().unwrap().unwrap_err();
    });
}

/// A node repeats what it was sent: neither log nor results nor what is remembered hold the token.
#[test]
fn the_token_is_in_no_file() {
    const TOKEN: &str = "s3cret+token";
    let messages = vec![format!(
        "sm-cluster http://x/?token={TOKEN} and token=s3cret%2Btoken"
    )];
    for fault in [
        ServerFault::None,
        ServerFault::Fails("token s3cret+token"),
        ServerFault::TooShort(usize::MAX),
    ] {
        let desk = Desk::new(Served {
            token: Some(TOKEN),
            messages: messages.clone(),
            fault: fault.clone(),
            ..Served::default()
        });
        let request = NodeRequest {
            token: Token::typed(TOKEN),
            ..desk.request()
        };
        let done = desk.run_request(&request);
        assert_eq!(done.is_ok(), fault == ServerFault::None);
        let said = done.map_or_else(|error| error, |made| format!("{:?}", made.warnings));
        let mut files = all_files(&desk.to());
        assert!(files.len() > 2);
        files.push((PathBuf::from("what is said"), said.into_bytes()));
        for (path, bytes) in files {
            let text = String::from_utf8_lossy(&bytes);
            assert!(!text.contains("s3cret"), "{}: {text}", path.display());
        }
    }
}

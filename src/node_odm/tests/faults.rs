//! Every way to fail that was seen: one clear line, nothing half, nothing lost.

use super::*;

/// What is over before anything was begun leaves no folder.
#[test]
fn what_is_no_node_is_said_and_leaves_nothing() {
    let other = NodeServer::start(Served::default());
    for (fault, said) in [
        (
            ServerFault::Page,
            "no NodeODM and no ClusterODM: it answers with text/html",
        ),
        (ServerFault::EndlessAnswer, "an answer of more than 4 MB"),
        (
            ServerFault::Redirects(other.address()),
            "it sends on to another address",
        ),
    ] {
        let desk = Desk::faulty(fault.clone());
        let error = desk.error();
        assert!(error.starts_with(&desk.server.address()), "{error}");
        assert!(error.contains(said), "{fault:?}: {error}");
        assert!(!desk.to().exists(), "{fault:?}");
    }
    // Nobody went there.
    assert!(other.calls().is_empty());
    // Nobody is there any more.
    let desk = Desk::faulty(ServerFault::None);
    let request = desk.request();
    let Desk {
        folder: _folder,
        server,
    } = desk;
    drop(server);
    let error = reconstruct_on_node(&request, &|_| {}, &Progress::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("it does not answer (connection refused)"),
        "{error}"
    );
    assert!(!request.to.exists());
}

#[test]
fn a_node_that_never_answers_is_given_up() {
    let desk = Desk::faulty(ServerFault::NeverAnswers);
    let request = NodeRequest {
        limits: Limits {
            idle: Duration::from_millis(300),
            ..quick()
        },
        ..desk.request()
    };
    let error = desk.run_request(&request).unwrap_err();
    assert!(
        error.contains("it does not answer (the node has said nothing for"),
        "{error}"
    );
    assert!(!desk.to().exists());
}

/// NodeODM answers 200 with a message, ClusterODM a bare 401.
#[test]
fn wrong_tokens_are_said() {
    for cluster in [false, true] {
        let desk = Desk::new(Served {
            cluster,
            token: Some("right"),
            ..Served::default()
        });
        assert!(
            desk.error()
                .contains("asks for a token; set the environment variable FRAGSCALE_NODE_TOKEN")
        );
        let request = NodeRequest {
            token: Token::typed("wr0ng"),
            ..desk.request()
        };
        let error = desk.run_request(&request).unwrap_err();
        assert!(
            error.contains("refuses the token") && !error.contains("wr0ng"),
            "{error}"
        );
        assert!(!desk.to().exists());
    }
}

#[test]
fn unknown_options_are_not_dropped_silently() {
    let desk = Desk::faulty(ServerFault::None);
    let request = NodeRequest {
        options: vec![Asked::parse("pc-qualty=high").unwrap()],
        ..desk.request()
    };
    let error = desk.run_request(&request).unwrap_err();
    assert!(
        error.contains("knows no option pc-qualty; perhaps pc-quality is meant"),
        "{error}"
    );
    assert!(desk.server.tasks().is_empty() && !desk.to().exists());
}

/// Half a photo stays on the node, and its second try has another name: the task is begun anew.
#[test]
fn a_broken_upload_is_found_by_counting() {
    let desk = Desk::faulty(ServerFault::UploadsBrokenOff(1));
    let made = desk.run().unwrap();
    let said = "4 files have arrived where 3 were sent: the task was begun anew";
    assert!(
        made.warnings.iter().any(|warning| warning == said),
        "{:?}",
        made.warnings
    );
    let tasks = desk.server.tasks();
    assert_eq!(tasks.len(), 2);
    assert!(tasks.iter().all(|task| task.removed));
    assert_eq!((tasks[0].files.len(), tasks[1].files.len()), (5, 4));
    for (name, bytes) in &tasks[1].files {
        assert_eq!(
            *bytes,
            fs::read(desk.photos().join(name)).unwrap(),
            "{name}"
        );
    }
}

#[test]
fn uploads_are_tried_again_and_not_for_ever() {
    // Refused before anything was kept: the same task goes on.
    let desk = Desk::faulty(ServerFault::UploadsRefused(3));
    desk.run().unwrap();
    assert_eq!(desk.server.tasks().len(), 1);
    // More often than anybody counts, as long as something arrives.
    let desk = Desk::faulty(ServerFault::UploadsRefused(20));
    desk.run().unwrap();
    assert_eq!(desk.server.tasks().len(), 1);
    for fault in [
        ServerFault::UploadsRefused(usize::MAX),
        // Each try leaves half a photo.
        ServerFault::UploadsBrokenOff(usize::MAX),
    ] {
        let desk = Desk::faulty(fault);
        let error = desk.error();
        assert!(error.contains("could not be sent for"), "{error}");
        assert!(
            error.contains("it goes on with what the node has"),
            "{error}"
        );
        assert!(desk.to().join("unfinished/task.json").is_file());
    }
}

#[test]
fn a_full_disk_there_is_said_at_once() {
    let desk = Desk::faulty(ServerFault::DiskFull);
    let error = desk.error();
    assert!(
        error.contains("the node's disk is full") && error.contains("free space there"),
        "{error}"
    );
    assert!(desk.called("POST /task/new/upload") <= 4);
    assert!(!desk.to().exists());
}

#[test]
fn a_lost_answer_to_the_commit_loses_nothing() {
    let desk = Desk::faulty(ServerFault::CommitAnswerLost);
    desk.run().unwrap();
    assert_eq!(desk.server.tasks().len(), 1);
}

/// The status decides, not the progress, which is 100 by then.
#[test]
fn failures_of_the_task_are_said_and_its_messages_kept() {
    for (fault, said) in [
        (
            ServerFault::Fails("Cannot process dataset"),
            "could not reconstruct the photos (\"Cannot process dataset\", exit status 1)",
        ),
        (
            ServerFault::Fails("Not enough memory"),
            "not enough memory (exit status 137)",
        ),
        (
            ServerFault::Fails(""),
            "failed on the node; its last message: \"Compressing all.zip\"",
        ),
        (
            ServerFault::CancelledThere,
            "the task was cancelled on the node",
        ),
    ] {
        let desk = Desk::faulty(fault);
        let error = desk.error();
        assert!(error.contains(said), "{error}");
        assert!(desk.server.tasks()[0].removed);
        let log = fs::read_to_string(desk.to().join("unfinished/log.txt")).unwrap();
        assert_eq!(log, "matching\nCompressing all.zip\n");
        assert!(!desk.to().join("unfinished/task.json").exists());
        // The same once more begins anew.
        desk.server
            .now_serves(|served| served.fault = ServerFault::None);
        desk.run().unwrap();
        assert_eq!(desk.server.tasks().len(), 2);
    }
}

#[test]
fn a_node_that_has_forgotten_is_said() {
    for cluster in [false, true] {
        let desk = Desk::new(Served {
            cluster,
            fault: ServerFault::Forgets,
            ..Served::default()
        });
        let error = desk.error();
        assert!(error.contains("does not know the task any more"), "{error}");
        desk.server
            .now_serves(|served| served.fault = ServerFault::None);
        desk.run().unwrap();
        assert_eq!(desk.server.tasks().len(), 2);
    }
}

#[test]
fn a_node_that_dies_is_waited_for_and_its_task_remembered() {
    let desk = Desk::faulty(ServerFault::Dies);
    let error = desk.error();
    assert!(error.contains("it does not answer"), "{error}");
    assert!(error.contains("goes on with the task"), "{error}");
    let task = fs::read_to_string(desk.to().join("unfinished/task.json")).unwrap();
    assert!(
        task.contains("fda57596-9d93-48f0-8e5b-000000000001"),
        "{task}"
    );
}

#[test]
fn a_slow_node_is_waited_for() {
    let desk = Desk::faulty(ServerFault::Slow);
    desk.run().unwrap();
}

/// Ranges are not asked for: nodes take no notice of them. So it begins at the first byte again.
#[test]
fn results_that_break_off_are_fetched_again() {
    for fault in [ServerFault::TooShort(2), ServerFault::NotReady(2)] {
        let desk = Desk::faulty(fault);
        desk.run().unwrap();
        assert_eq!(
            desk.called("GET /task/fda57596-9d93-48f0-8e5b-000000000001/download/all.zip"),
            3
        );
    }
}

/// What never comes whole stays on the node, and a second run fetches it.
#[test]
fn results_that_are_none_are_refused_and_stay_there() {
    let good = results();
    let mut evil = zipped(&[
        ("cameras.json", CAMERAS.as_bytes()),
        ("../../evil.txt", b"evil"),
    ]);
    let zeros = vec![b'0'; 65 << 20];
    let bomb = zipped(&[
        ("cameras.json", CAMERAS.as_bytes()),
        ("opensfm/reconstruction.json", &zeros),
    ]);
    let nothing = zipped(&[("images.json", b"[]")]);
    let other = NodeServer::start(Served::default());
    for (fault, results, said) in [
        (
            ServerFault::TooShort(usize::MAX),
            good.clone(),
            "the results broke off after",
        ),
        (
            ServerFault::TooLong,
            good.clone(),
            "cut off or no zip archive",
        ),
        (
            ServerFault::None,
            good[..good.len() / 2].to_vec(),
            "cut off or no zip archive",
        ),
        (
            ServerFault::None,
            b"<html>".to_vec(),
            "cut off or no zip archive",
        ),
        (
            ServerFault::PageForResults,
            good.clone(),
            "cut off or no zip archive",
        ),
        (
            ServerFault::None,
            std::mem::take(&mut evil),
            "outside of their folder (\"../../evil.txt\")",
        ),
        (ServerFault::None, bomb, "would unpack to more than 64 MB"),
        (
            ServerFault::None,
            nothing,
            "the node's results cannot be read",
        ),
        (
            ServerFault::EndlessResults,
            good.clone(),
            "the results are larger than",
        ),
        (
            ServerFault::NotReady(usize::MAX),
            good.clone(),
            "the node refuses: \"Asset not ready\"",
        ),
        (
            ServerFault::RedirectsResults(other.address()),
            good.clone(),
            "it sends on to another address",
        ),
    ] {
        let desk = Desk::new(Served {
            fault: fault.clone(),
            results,
            ..Served::default()
        });
        let error = desk.error();
        assert!(error.contains(said), "{fault:?}: {error}");
        assert!(!desk.server.tasks()[0].removed, "{fault:?}");
        // Nothing of them stays, and what no second run would mend says how to be rid of it.
        for name in ["all.zip", "odm"] {
            assert!(
                !desk.to().join("unfinished").join(name).exists(),
                "{fault:?}"
            );
        }
        let is_final = error.contains("do not trust") || error.contains("are larger than");
        let is_told = error.contains("to begin anew, remove");
        assert!(is_told || !is_final, "{error}");
        let outside: Vec<PathBuf> = all_files(desk.folder.path())
            .into_iter()
            .map(|(path, _)| path)
            .collect();
        assert!(
            !outside.iter().any(|path| path.ends_with("evil.txt")),
            "{outside:?}"
        );
        desk.server.now_serves(|served| {
            served.fault = ServerFault::None;
            served.results.clone_from(&good);
        });
        desk.run().unwrap();
        assert_eq!(desk.server.tasks().len(), 1, "{fault:?}");
    }
    assert!(other.calls().is_empty());
}

use std::fs;

use super::*;
use crate::asked::OptionKind;

const SEASON: &str = r#"format = 1
name = "North"
to = "./out"
unit = "mm"
steps = ["delineate", "scales", "psd"]

[delineate]
engine = "classical"
also = ["coco", "tiff"]

[export]
photos = "trusted"

[psd]
reference = "sieves.csv"

[[flight]]
path = "flights/*"

[[flight]]
path = "late"
name = "B/31"
date = 2026-06-02
reference = "late.csv"
"#;

fn parsed(text: &str) -> Result<Season, Fault> {
    file::parse(text, Path::new("a/season.toml"))
}

#[test]
fn a_season_says_what_is_done() {
    let season = parsed(SEASON).unwrap();
    assert_eq!(
        (season.name.as_str(), season.asked.unit.as_str()),
        ("North", "mm")
    );
    assert_eq!(season.to.as_deref(), Some(Path::new("a/out")));
    let steps: Vec<Step> = season.asked.steps.iter().map(|asked| asked.step).collect();
    assert_eq!(steps, [Step::Scales, Step::Delineate, Step::Psd]);
    let options = &season.asked.steps[1].options;
    assert_eq!(options["engine"], ["classical"]);
    assert_eq!(options["also"], ["coco", "tiff"]);
    assert_eq!(season.asked.steps[2].options["reference"], ["a/sieves.csv"]);
    assert_eq!(
        season.sources[1].reference.as_deref(),
        Some(Path::new("a/late.csv"))
    );
    assert_eq!(season.sources[1].date, "2026-06-02".parse().ok());
    let quoted = SEASON.replace("2026-06-02", "\"2026-06-02\"");
    assert_eq!(parsed(&quoted).unwrap(), season);
    let least = parsed("format = 1\n[[flight]]\npath = \"b\"\n").unwrap();
    assert_eq!(least.name, "season");
    assert!(least.asked.has(Step::Scales) && least.asked.has(Step::Check));
}

/// The keys that a file may have are the options that the steps have.
#[test]
fn keys_are_those_of_the_steps() {
    for step in Step::ALL {
        for option in step.options() {
            let value = match option.kind {
                OptionKind::Share => "0.4",
                _ => option.values.first().unwrap_or(&"x"),
            };
            let text = format!(
                "format = 1\nsteps = [\"{}\", \"delineate\"]\n[{}]\n{} = \"{value}\"\n[[flight]]\npath = \"b\"\n",
                step.as_str(),
                step.as_str(),
                option.key
            );
            let season = parsed(&text).unwrap();
            let asked = season
                .asked
                .steps
                .iter()
                .find(|asked| asked.step == step)
                .unwrap();
            assert!(asked.options.contains_key(option.key), "{text}");
        }
    }
}

/// Outlines lie below each flight, a share is a number, and a table of the fines beside the file.
#[test]
fn the_way_to_the_mass_is_that_of_the_command() {
    let text = "format = 1\nsteps = [\"delineate\"]\n[delineate]\nmasks = \"masks\"\nsteps = [\"edges\", \"pores\", \"fines\"]\nporosity = 0.3\n\
                tail = \"fines.csv\"\n[[flight]]\npath = \"b\"\n";
    let options = &parsed(text).unwrap().asked.steps[0].options;
    assert_eq!(options["masks"], ["masks"]);
    assert_eq!(options["steps"], ["edges", "pores", "fines"]);
    // What the command would refuse of every flight is refused at once.
    let fault = parsed(&text.replace(", \"pores\"", "")).unwrap_err();
    let wanted = "delineate.porosity is for the step pores, which the steps leave out";
    assert_eq!(
        (fault.what.as_str(), fault.line),
        (wanted, Some(6)),
        "{fault}"
    );
    assert_eq!(options["porosity"], ["0.3"]);
    assert_eq!(options["tail"], ["a/fines.csv"]);
    let law = parsed(&text.replace("fines.csv", "swebrec")).unwrap();
    assert_eq!(law.asked.steps[0].options["tail"], ["swebrec"]);
    // Also where the step is not asked for now, with its line.
    let text = text.replace("0.3", "30");
    for text in [text.replace("[\"delineate\"]", "[\"scales\"]"), text] {
        let fault = parsed(&text).unwrap_err();
        assert!(fault.what.contains("no share from 0 to 0.9"), "{fault}");
        assert_eq!(fault.line, Some(6), "{fault}");
    }
}

/// A wrong value waits for nobody: also where its step is not asked for now.
#[test]
fn what_waits_is_looked_at() {
    let of = |engine: &str| {
        parsed(&format!(
            "format = 1\nsteps = [\"scales\"]\n[delineate]\nengine = \"{engine}\"\n[[flight]]\npath = \"b\"\n"
        ))
    };
    assert!(!of("classical").unwrap().asked.has(Step::Delineate));
    let error = of("both").unwrap_err().to_string();
    assert!(error.contains("'both'"), "{error}");
}

#[test]
fn what_is_wrong_is_said_with_its_line() {
    for (old, new, line, what) in [
        ("format = 1", "format = 2", 1, "format 2 is not known"),
        (
            "format = 1\n",
            "",
            1,
            "missing field `format`; write format = 1",
        ),
        (
            "name = \"North\"",
            "nmae = \"North\"",
            2,
            "unknown key 'nmae'",
        ),
        ("unit = \"mm\"", "unit = \"km\"", 4, "'km'"),
        ("\"psd\"]", "\"psds\"]", 5, "'psds' is no step"),
        ("engine = \"classical\"", "engine = \"both\"", 8, "'both'"),
        (
            "engine = \"classical\"",
            "engin = \"classical\"",
            8,
            "unknown key 'engin'",
        ),
        (
            "also = [\"coco\", \"tiff\"]",
            "also = 3",
            9,
            "neither a text",
        ),
        (
            "path = \"late\"",
            "path = \" \"",
            21,
            "flight.path is empty",
        ),
        (
            "date = 2026-06-02",
            "date = \"2026-02-30\"",
            23,
            "no day of the calendar",
        ),
        (
            "path = \"late\"",
            "file = \"late\"",
            21,
            "unknown key 'file'",
        ),
        ("[export]", "[exports]", 11, "unknown key 'exports'"),
        ("\"delineate\", ", "", 5, "needs delineate"),
    ] {
        assert!(SEASON.contains(old), "{old}");
        let fault = parsed(&SEASON.replacen(old, new, 1)).unwrap_err();
        assert!(fault.to_string().contains(what), "{fault}");
        // serde says of some that a table lacks something, and names the table.
        assert_eq!(fault.line, Some(line), "{fault}");
    }
    assert!(
        parsed("format = 1\n")
            .unwrap_err()
            .what
            .contains("no flight")
    );
    assert!(parsed("format = ").unwrap_err().line.is_some());
    let nearest = parsed("format = 1\nstep = []\n").unwrap_err();
    assert!(nearest.remedy.contains("'steps'"), "{nearest}");
}

fn flight_in(folder: &Path) {
    fs::create_dir_all(folder).unwrap();
    fs::write(folder.join("flight.toml"), "format = 1\n").unwrap();
}

fn names(found: &Found) -> Vec<&str> {
    found
        .flights
        .iter()
        .map(|flight| flight.results.as_str())
        .collect()
}

#[test]
fn flights_are_found_below_folders() {
    let root = tempfile::tempdir().unwrap();
    let root = root.path();
    for name in ["b", "a/2", "a/1", "c/flight"] {
        flight_in(&root.join(name));
    }
    // No flights: nothing, results of this season and of another, an export, what is hidden.
    fs::create_dir_all(root.join("empty/inside")).unwrap();
    fs::write(root.join("notes.txt"), "x").unwrap();
    flight_in(&root.join("out/a-1"));
    flight_in(&root.join("older/x"));
    fs::write(root.join("older/season.lock"), "").unwrap();
    flight_in(&root.join("d/split-desktop/x"));
    fs::write(root.join("d/split-desktop/export.json"), "{}").unwrap();
    flight_in(&root.join(".hidden"));
    // Inside a flight nothing is looked for.
    flight_in(&root.join("b/older"));
    let to = root.join("out");
    let season = Season::of_folders(&[root.to_owned()], Asked::default()).unwrap();
    let found = season.flights(&to).unwrap();
    assert_eq!(names(&found), ["a-1", "a-2", "b", "c-flight"]);
    assert_eq!(found.notes.len(), 1, "{:?}", found.notes);
    let note = &found.notes[0];
    assert!(note.contains("empty") && !note.contains("inside"), "{note}");
    // One more beside them changes no other name.
    flight_in(&root.join("a/0"));
    let found = season.flights(&to).unwrap();
    assert_eq!(names(&found), ["a-0", "a-1", "a-2", "b", "c-flight"]);

    // What is named is one, and fails by itself where it is none.
    let named = ["b", "empty"].map(|name| root.join(name));
    let season = Season::of_folders(&named, Asked::default()).unwrap();
    assert_eq!(names(&season.flights(&to).unwrap()), ["b", "empty"]);
    // What is not there was mistyped.
    let missing = [root.join("b"), root.join("missing")];
    let error = Season::of_folders(&missing, Asked::default()).unwrap_err();
    assert!(
        error.to_string().contains("missing: there is no such"),
        "{error}"
    );

    // Two of one name.
    flight_in(&root.join("e/b"));
    let twins = ["b", "e/b"].map(|name| root.join(name));
    let season = Season::of_folders(&twins, Asked::default()).unwrap();
    let error = season.flights(&to).unwrap_err().to_string();
    assert!(
        error.contains("SEASON.toml") && error.contains("'b'"),
        "{error}"
    );
}

#[test]
fn seasons_name_flights_by_patterns() {
    let root = tempfile::tempdir().unwrap();
    for name in ["flights/x1", "flights/x2", "late"] {
        flight_in(&root.path().join(name));
    }
    let path = root.path().join("SEASON.toml");
    fs::write(&path, SEASON).unwrap();
    assert!(Season::is_season(&path));
    assert!(!Season::is_season(&root.path().join("late/flight.toml")));
    let season = Season::read(&path).unwrap();
    let found = season.flights(&root.path().join("out")).unwrap();
    assert_eq!(names(&found), ["x1", "x2", "B_31"]);
    assert_eq!(found.flights[2].blast, "B/31");
    let note = "the results of 'B/31' go into the folder 'B_31'";
    assert_eq!(found.notes, [note]);
    // A name for several.
    let many = SEASON.replace("path = \"late\"", "path = \"flights\"");
    fs::write(&path, many).unwrap();
    let error = Season::read(&path)
        .unwrap()
        .flights(Path::new("out"))
        .unwrap_err();
    assert!(error.to_string().contains("2 flights"), "{error}");
}

/// What fits a pattern beside the flights is passed over and named; flights are called by the way from the part without stars.
#[test]
fn patterns_pass_over_what_is_no_flight() {
    let root = tempfile::tempdir().unwrap();
    for name in ["north/rep", "south/rep", "east"] {
        flight_in(&root.path().join(name));
    }
    fs::create_dir(root.path().join("empty")).unwrap();
    fs::write(root.path().join("notes.txt"), "hi").unwrap();
    let path = root.path().join("SEASON.toml");
    let found = |pattern: &str| {
        let text = format!("format = 1\n[[flight]]\npath = \"{pattern}\"\n");
        fs::write(&path, text).unwrap();
        let season = Season::read(&path).unwrap();
        season.flights(&root.path().join("out")).unwrap()
    };
    let all = found("*");
    assert_eq!(names(&all), ["east", "north-rep", "south-rep"]);
    let at = |name: &str| root.path().join(name).display().to_string();
    assert_eq!(
        all.notes,
        [
            format!(
                "2 files are no flights: {}, {}",
                at("SEASON.toml"),
                at("notes.txt")
            ),
            format!("1 folder holds no flight: {}", at("empty")),
        ]
    );
    assert_eq!(names(&found("*/rep")), ["north-rep", "south-rep"]);
    assert_eq!(names(&found("*/flight.toml")), ["east"]);
    assert_eq!(names(&found("*/*/flight.toml")), ["north-rep", "south-rep"]);
}

/// Found by a pattern and named by itself, a blast counts once, with what is said of it; the season's file may lack one.
#[test]
fn a_flight_that_is_named_in_two_ways_is_one() {
    let root = tempfile::tempdir().unwrap();
    for name in ["flights/x1", "flights/x2"] {
        flight_in(&root.path().join(name));
    }
    let path = root.path().join("SEASON.toml");
    let named = |itself: &str| {
        let text = format!(
            "format = 1\n[[flight]]\npath = \"flights/*\"\n[[flight]]\npath = \"{itself}\"\nname = \"B2\"\n"
        );
        fs::write(&path, text).unwrap();
        let season = Season::read(&path).unwrap();
        season.flights(&root.path().join("out")).unwrap()
    };
    for itself in [
        "flights/x2",
        "flights/x2/flight.toml",
        "flights/../flights/x2",
    ] {
        assert_eq!(names(&named(itself)), ["x1", "B2"], "{itself}");
    }
    assert_eq!(names(&named("flights/x3")), ["x1", "x2", "B2"]);
}

/// Where results go is said of flights that are done, and not of names that were only found on the way to them.
#[test]
fn a_name_that_is_replaced_has_no_folder() {
    let root = tempfile::tempdir().unwrap();
    flight_in(&root.path().join("flights/x2."));
    let path = root.path().join("SEASON.toml");
    let found = |more: &str| {
        let text = format!("format = 1\n[[flight]]\npath = \"flights/*\"\n{more}");
        fs::write(&path, text).unwrap();
        let season = Season::read(&path).unwrap();
        season.flights(&root.path().join("out")).unwrap()
    };
    let by_itself = "[[flight]]\npath = \"flights/x2.\"\nname = \"B2\"\n";
    assert_eq!(
        found("").notes,
        ["the results of 'x2.' go into the folder 'x2'"]
    );
    let named = found(by_itself);
    assert_eq!(names(&named), ["B2"]);
    assert!(named.notes.is_empty(), "{:?}", named.notes);
}

#[test]
fn folders_have_safe_names() {
    for (name, folder) in [
        ("2026-05-31", "2026-05-31"),
        ("a/b:c", "a_b_c"),
        ("..", "_"),
        ("", "_"),
        (".x", "_.x"),
        ("season.csv", "_season.csv"),
        ("x. ", "x"),
        ("Grube Süd", "Grube Süd"),
    ] {
        assert_eq!(results_folder(name), folder);
    }
}

/// What the header of `file.rs` shows is a file.
#[test]
fn the_header_is_an_example() {
    let source = include_str!("file.rs");
    let lines = source.lines().map_while(|line| line.strip_prefix("//!"));
    let block = lines.skip_while(|line| !line.contains("```toml")).skip(1);
    let block = block.take_while(|line| !line.contains("```"));
    let text: Vec<&str> = block.map(str::trim_start).collect();
    let season = parsed(&text.join("\n")).unwrap();
    assert_eq!(season.name, "North pit 2026");
    assert_eq!(season.reference_waits, None);
}

/// Without a reference nothing comes of psd, which is said before the hours that the rest may take.
#[test]
fn flights_without_a_reference_are_said() {
    let flight = |blast: &str, reference: Option<&str>| SeasonFlight {
        blast: blast.to_owned(),
        date: None,
        path: PathBuf::from(blast),
        surface: None,
        photos: None,
        reference: reference.map(PathBuf::from),
        results: blast.to_owned(),
    };
    let (sieved, alone) = (flight("a", Some("a.csv")), flight("b", None));
    let season = |text: &str| parsed(&format!("format = 1\n{text}")).unwrap();
    let psd = "steps = [\"delineate\", \"psd\"]\n[[flight]]\npath = \"x\"\n";
    let said = |text: &str, flights: &[SeasonFlight]| season(text).without_reference(flights);
    let of_all = said(psd, std::slice::from_ref(&alone)).unwrap();
    assert!(
        of_all.starts_with("psd is passed over for all flights: no reference"),
        "{of_all}"
    );
    let of_one = said(psd, &[sieved.clone(), alone.clone()]).unwrap();
    assert!(of_one.contains("for 1 of 2 flights (b): "), "{of_one}");
    assert_eq!(said(psd, &[sieved]), None);
    assert_eq!(said(psd, &[]), None);
    let of_season = format!("{psd}[psd]\nreference = \"s.csv\"\n");
    assert_eq!(said(&of_season, std::slice::from_ref(&alone)), None);
    let without = "steps = [\"delineate\"]\n[[flight]]\npath = \"x\"\n";
    assert_eq!(said(without, &[alone]), None);
}

/// A reference that no step holds sizes against is said, with the steps that would; and it is there once they are asked for.
#[test]
fn a_reference_that_waits_is_said_and_kept() {
    let said = |season: &Season| {
        let found = season.flights(Path::new("out")).unwrap();
        let mut notes = found.notes.into_iter();
        notes.find(|note| note.contains("names a reference"))
    };
    let of_all = "[psd]\nreference = \"s.csv\"\n";
    let of_flight = "reference = \"own.csv\"\n";
    let season = |steps: &str, all: &str, flight: &str| {
        let text = format!("format = 1\n{steps}{all}[[flight]]\npath = \"x\"\n{flight}");
        parsed(&text).unwrap()
    };
    let mut waits = season("steps = [\"export\"]\n", of_all, of_flight);
    assert_eq!(
        said(&waits).unwrap(),
        "a/season.toml: [psd] names a reference, but psd is not among the steps, so no sizes are held against it: write steps = \
         [\"export\", \"delineate\", \"psd\"], or give --steps export,delineate,psd"
    );
    waits.asked.set_steps(&[Step::Delineate, Step::Psd]);
    assert_eq!(said(&waits), None);
    assert_eq!(waits.asked.steps[1].options["reference"], ["a/s.csv"]);
    let of_one = said(&season("", "", of_flight)).unwrap();
    assert!(
        of_one.contains(": [[flight]] names a reference")
            && of_one.ends_with("--steps scales,check,delineate,psd"),
        "{of_one}"
    );
    assert_eq!(said(&season("", "", "")), None);
    // Whoever leaves psd out of a season that has it knows what she does.
    let mut left_out = season("steps = [\"delineate\", \"psd\"]\n", of_all, "");
    left_out.asked.set_steps(&[Step::Scales]);
    assert_eq!(said(&left_out), None);
}

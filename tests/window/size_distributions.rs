//! The page of size distributions: tables dropped, pasted and taken away, fits, the reference,
//! repeatability, time effort.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::NodeT;
use fragscale::app::Command;
use fragscale::app::size_distributions::{Computed, DistributionCommand, Page, Settings};
use fragscale::app::tasks::Task;
use fragscale::exports::comparison_json;
use fragscale::fragmentation::{FitOptions, Model, SieveSeries, Weighting, fit};
use fragscale::units::LengthUnit;
use tempfile::TempDir;

use crate::desk::{Desk, Written, flight};
use crate::dropping::drop_on;
use crate::random::Dice;

/// A sieve and a method of three trials with two photos each.
const TRIALS: &str = "\
method,trial,photo,size_mm,percent_passing
sieve,,,8,6
sieve,,,16,14.5
sieve,,,31.5,33
sieve,,,63,65
sieve,,,125,96
point cloud,1,a,8,6
point cloud,1,a,16,14
point cloud,1,a,31.5,31
point cloud,1,a,63,62
point cloud,1,a,125,95
point cloud,1,b,8,8
point cloud,1,b,16,15
point cloud,1,b,31.5,33
point cloud,1,b,63,66
point cloud,1,b,125,97
point cloud,2,c,8,9
point cloud,2,c,16,19
point cloud,2,c,31.5,37
point cloud,2,c,63,70
point cloud,2,c,125,98
point cloud,2,d,8,7
point cloud,2,d,16,18
point cloud,2,d,31.5,36
point cloud,2,d,63,69
point cloud,2,d,125,99
point cloud,3,e,8,5
point cloud,3,e,16,12
point cloud,3,e,31.5,28
point cloud,3,e,63,58
point cloud,3,e,125,93
point cloud,3,f,8,6
point cloud,3,f,16,13
point cloud,3,f,31.5,30
point cloud,3,f,63,59
point cloud,3,f,125,94
";

/// The page with these tables dropped on it.
fn desk(tables: &[(&str, &str)]) -> (TempDir, Desk) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = Desk::new(None);
    desk.click(Role::Button, "Size distributions");
    let paths = tables.iter().map(|(name, text)| {
        let path = folder.path().join(name);
        fs::write(&path, text).expect("written");
        path
    });
    let paths: Vec<PathBuf> = paths.collect();
    let paths: Vec<&Path> = paths.iter().map(PathBuf::as_path).collect();
    drop_on(&mut desk, &paths);
    (folder, desk)
}

fn computed(desk: &Desk) -> &Computed {
    let page = &desk.harness.state().state().distributions;
    assert!(page.is_current(), "{:?}", page.problem);
    page.computed.as_ref().expect("something computed")
}

fn settings(desk: &Desk) -> Settings {
    desk.harness
        .state()
        .state()
        .distributions
        .settings()
        .clone()
}

/// The rows of a table of results: their texts.
fn table(desk: &Desk, name: &str) -> Vec<Vec<String>> {
    let rows = desk.rows_of(&format!("{name}:")).into_iter();
    rows.map(|(_, cells)| cells).collect()
}

fn choose(desk: &mut Desk, list: &str, entry: &str) {
    desk.click(Role::ComboBox, list);
    desk.click(Role::Button, entry);
}

#[test]
fn the_page_opens_without_a_flight_and_with_one() {
    let mut desk = Desk::new(None);
    desk.click(Role::Button, "Size distributions");
    assert!(desk.says("What Split-Desktop or a sieve gave"));
    desk.click(Role::Tab, "Pile");
    assert!(desk.shows(Role::Button, "Open the sample flight"));
    desk.press(Modifiers::COMMAND, Key::Num5);
    assert!(desk.says("What Split-Desktop or a sieve gave"));

    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.click(Role::Tab, "Size distributions");
    // The sample flight's known fragments, by one click.
    desk.click(Role::Button, "Add the flight's known fragments");
    let computed = computed(&desk);
    assert_eq!(computed.analysis.methods, ["reference"]);
    assert_eq!(
        computed.analysis.photos.curves[0]
            .distribution
            .points()
            .len(),
        14
    );
    assert!(desk.says("reference.csv"));
    // What the program itself took is measured.
    desk.click(Role::Tab, "Time effort");
    let steps = table(&desk, "Measured by this program, s");
    let names: Vec<&str> = steps.iter().map(|row| row[0].as_str()).collect();
    assert_eq!(
        names,
        ["Opening the flight", "Computing scales", "Total", "Average"]
    );
    desk.click(Role::Tab, "Pile");
    assert_eq!(desk.rows().len(), 9, "the flight is still there");
}

#[test]
fn a_dropped_table_is_drawn_and_one_of_a_flight_goes_to_the_pile() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("trials.csv");
    fs::write(&path, TRIALS).expect("written");
    let mut desk = Desk::new(None);
    drop_on(&mut desk, &[&path]);
    assert_eq!(desk.harness.state().state().page, Page::SizeDistributions);
    assert_eq!(computed(&desk).analysis.photos.curves.len(), 7);
    assert_eq!(computed(&desk).analysis.methods, ["sieve", "point cloud"]);
    // The plot's legend.
    assert!(desk.shows(Role::CheckBox, "sieve") && desk.shows(Role::CheckBox, "point cloud"));
    assert!(desk.shows(Role::Image, "Plot of percent passing"));
    assert!(desk.logged("trials.csv: 7 curves"));

    // With a flight that is dropped with it, both are there.
    let mut desk = Desk::new(None);
    drop_on(&mut desk, &[&path, &flight("tests/windrow")]);
    assert_eq!(desk.open().flight().parts().name, "Windrow");
    assert_eq!(computed(&desk).analysis.photos.curves.len(), 7);

    // A list of poses is something of a flight, as ever.
    let poses = folder.path().join("poses.csv");
    fs::write(&poses, "photo,x,y,z,tilt,pan\na.jpg,0,0,10,90,0\n").expect("written");
    let mut desk = Desk::new(None);
    drop_on(&mut desk, &[&poses]);
    assert_eq!(desk.harness.state().state().page, Page::Pile);
    assert!(
        desk.logged("it holds"),
        "{:?}",
        desk.harness.state().state().log
    );
}

#[test]
fn the_fits_are_those_of_the_core() {
    let (_folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    for (name, model) in [
        ("Swebrec", Model::Swebrec),
        ("Rosin-Rammler", Model::RosinRammler),
        ("Gates-Gaudin-Schuhmann", Model::GatesGaudinSchuhmann),
    ] {
        if model != Model::Swebrec {
            choose(&mut desk, "Function", name);
        }
        let now = computed(&desk);
        assert_eq!(now.edit.settings.model, model);
        // The sieve, and each trial with its photos merged.
        assert_eq!(now.fits.len(), 4);
        let rows = table(&desk, "Parameters");
        assert_eq!(rows.len(), 4, "{rows:?}");
        for (trial, row) in now.analysis.trials.curves.iter().zip(rows) {
            let fitted = fit(&trial.distribution, model, &FitOptions::default()).expect("a fit");
            assert_eq!(row[0], trial.labels.to_string());
            for (place, parameter) in fitted.parameters.iter().enumerate() {
                let shown: f64 = row[1 + 2 * place].parse().expect("a number");
                assert!((shown / parameter.value - 1.0).abs() < 1e-4, "{row:?}");
            }
            let rmse: f64 = row[1 + 2 * fitted.parameters.len()]
                .parse()
                .expect("a number");
            assert!((rmse - fitted.rmse).abs() < 0.006, "{row:?}");
        }
    }
    // The mean of trial 1's two photos.
    let first = &computed(&desk).analysis.trials.curves[1];
    assert_eq!(first.distribution.points()[0], [8.0, 7.0]);
}

/// Those of the page Fragments are of the curve as measured.
#[test]
fn percentiles_say_that_they_are_of_the_function() {
    let (_folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    assert!(desk.says("Percentiles of the fitted functions, mm"));
    assert_eq!(
        table(&desk, "Percentiles of the fitted functions, mm").len(),
        4
    );
    let marks = computed(&desk)
        .drawing
        .methods
        .iter()
        .flat_map(|of| &of.marks);
    assert!(marks.clone().count() > 0 && marks.clone().all(|(name, _)| name.ends_with(", fitted")));
    desk.click(Role::Tab, "Against the reference");
    assert!(desk.says("Shifts of the fitted percentiles, mm"));
}

/// With a weight behind it, as curves of fragments have one, a usual name is not cut at the left; in the head of a table a long one
/// goes on in the next row.
#[test]
fn names_of_curves_have_the_room_that_is_there() {
    let long = "sieve reference curve of the laboratory";
    let usual = "fragscale (learned)";
    let lines = TRIALS.lines().map(|line| match line.starts_with("method") {
        true => format!("{line},weight\n"),
        false => format!("{line},0.2029\n"),
    });
    let text = lines.collect::<String>();
    let text = text.replace("sieve,", &format!("{long},"));
    let text = text.replace("point cloud,", &format!("{usual},"));
    let (_folder, mut desk) = desk(&[("trials.csv", &text)]);
    // The plot's legend begins behind the panel.
    let is_at_left = |place: egui::Rect| place.right() < 320.0;
    let written = desk.written();
    assert!(
        written
            .iter()
            .any(|w| w.text.starts_with("weight") && is_at_left(w.place))
    );
    assert!(
        written
            .iter()
            .any(|w| w.text == usual && is_at_left(w.place))
    );
    desk.click(Role::Tab, "Against the reference");
    let in_rows = |w: &Written| w.text == long && w.rows.len() > 1;
    assert!(desk.written().iter().any(in_rows));
}

#[test]
fn sizes_in_another_unit_are_the_same_sizes() {
    let (_folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    let p50 = |desk: &Desk| {
        let now = computed(desk);
        now.fits[0].percentiles[2].size
    };
    let before = p50(&desk);
    desk.click(Role::RadioButton, "Sizes in in");
    assert_eq!(computed(&desk).analysis.photos.unit, LengthUnit::Inch);
    assert!((p50(&desk) * 25.4 / before - 1.0).abs() < 1e-6);
    assert!(desk.says("xmax in"));
    desk.press(Modifiers::COMMAND, Key::Z);
    desk.click(Role::RadioButton, "Sizes in ft");
    assert_eq!(computed(&desk).analysis.photos.unit, LengthUnit::Foot);
    assert!((p50(&desk) * 304.8 / before - 1.0).abs() < 1e-6);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!((p50(&desk) / before - 1.0).abs() < 1e-12);
}

/// At 200 % on a small screen every unit is seen, and lists end where their column does.
#[test]
fn a_narrow_column_holds_its_fields() {
    let (_folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    let wide = desk.node(Role::ComboBox, "Function").rect().width();
    desk.harness.set_size(egui::vec2(640.0, 360.0));
    desk.settle();
    // A third of the window.
    let column = 640.0 * 0.33 + 1.0;
    for unit in ["mm", "cm", "m", "in", "ft"] {
        let name = format!("Sizes in {unit}");
        let right = desk.node(Role::RadioButton, &name).rect().right();
        assert!(right < column, "{unit}: {right}");
    }
    for list in ["Function", "Reference", "Merge photos by", "Sieves"] {
        let place = desk.node(Role::ComboBox, list).rect();
        assert!(place.right() < column, "{list}: {place:?}");
        assert!(
            place.width() > 60.0 && place.width() < wide,
            "{list}: {place:?}"
        );
    }
}

#[test]
fn the_reference_can_be_chosen() {
    let (_folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    assert_eq!(computed(&desk).analysis.reference.as_deref(), Some("sieve"));
    desk.click(Role::Tab, "Against the reference");
    let rows = table(&desk, "Percent error of the passing");
    assert_eq!(rows.len(), 5);
    // The mean of the six photos at 8 mm is 41 / 6, of the sieve 6: 100 (41 / 36 - 1) = 13.9 %.
    assert_eq!(rows[0], ["8.000", "6.00", "6.83", "+13.9", "yes"]);
    // The trials pass 7, 8 and 5.5 % there: a mean of 6.833 and a standard deviation of 1.258.
    let drawn = &computed(&desk).drawing.methods[1];
    assert_eq!(drawn.spread.sizes[0], 8.0_f64.log10());
    assert!((drawn.spread.low[0] - (41.0 / 6.0 - (19.0_f64 / 12.0).sqrt())).abs() < 1e-9);
    assert!((drawn.errors[0].y - 100.0 * (41.0 / 36.0 - 1.0)).abs() < 1e-9);
    choose(&mut desk, "Reference", "point cloud");
    assert_eq!(settings(&desk).reference.as_deref(), Some("point cloud"));
    assert_eq!(
        computed(&desk).analysis.reference.as_deref(),
        Some("point cloud")
    );
    // 100 (36 / 41 - 1) = -12.2 %.
    let rows = table(&desk, "Percent error of the passing");
    assert_eq!(rows[0], ["8.000", "6.83", "6.00", "-12.2", "yes"]);
    desk.fill("Envelope percent", "10");
    let rows = table(&desk, "Percent error of the passing");
    assert_eq!(rows[0][4], "no");
    desk.click(Role::Tab, "Percent error");
    assert!(desk.shows(Role::Image, "Plot of percent errors"));
}

/// scipy.stats.f_oneway of the three trials with all their values, and of those at one size.
#[test]
fn repeatability_has_the_numbers_of_scipy() {
    let (_folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    desk.click(Role::Tab, "Repeatability");
    let rows = table(&desk, "point cloud, all sizes pooled");
    assert_eq!(rows[0], ["Trial", "2", "205.400", "102.700", "0.08474"]);
    assert_eq!(rows[1], ["Residual", "27", "32721.3", "1211.90", ""]);
    assert_eq!(rows[2], ["Total", "29", "32926.7", "", ""]);
    assert!(desk.says("F(2, 27; 0.05) = 3.35, p = 0.919"));
    // The headline is of the single sizes, of which four of five have a p under 0.05; the pooled table
    // drowns that in the spread of the sizes.
    assert!(
        desk.says(
            "point cloud: the trials differ at 4 of 5 sizes (5 % level): 16, 31.5, 63, 125 mm"
        )
    );
    assert!(!desk.says("trials do not differ"));
    let rows = table(&desk, "point cloud, size by size");
    assert_eq!(rows.len(), 5);
    assert_eq!(rows[0][0..2], ["8.000", "2, 3"]);
    assert_eq!(rows[0][4..8], ["2.111", "9.55", "0.268", "no"]);
    assert_eq!(rows[1][4..8], ["37.33", "9.55", "0.00759", "yes"]);
    // The whole table goes to a spreadsheet.
    desk.node(Role::Button, "Copy table: point cloud, all sizes pooled")
        .click();
    desk.harness.step();
    let copied = desk.copied().or_else(|| desk.frame([])).expect("a text");
    assert!(
        copied.starts_with("Source\tdf\tSS\tMS\tF\nTrial\t2\t205.400\t"),
        "{copied}"
    );
}

#[test]
fn a_table_is_pasted() {
    let mut desk = Desk::new(None);
    desk.press(Modifiers::COMMAND, Key::Num5);
    desk.click(Role::Button, "Paste table…");
    choose(&mut desk, "Unit of the table", "in");
    paste(&mut desk, "size\tpassing\n1\t10\n2\t35\n4\t80\n8\t100\n");
    desk.fill("Method of the table", "sieve");
    desk.fill("Trial of the table", "7");
    desk.click(Role::Button, "Add table");
    let now = computed(&desk);
    assert_eq!(now.analysis.photos.unit, LengthUnit::Inch);
    assert_eq!(
        now.analysis.photos.curves[0].labels.to_string(),
        "sieve / 7"
    );
    assert_eq!(
        now.analysis.photos.curves[0].distribution.points()[3],
        [8.0, 100.0]
    );
    assert!(
        !desk.shows(Role::Button, "Add table"),
        "the small window is closed"
    );
    assert!(desk.says("Pasted table 1"));
}

/// Without a field that has the keys: onto the page itself.
#[test]
fn a_table_is_pasted_onto_the_page() {
    let mut desk = Desk::new(None);
    let table = "size_mm\tpassing\n1\t10\n2\t35\n4\t80\n8\t100\n";
    // Another page has no use for it.
    desk.harness.event(Event::Paste(table.to_owned()));
    desk.settle();
    assert!(!desk.shows(Role::Button, "Add table"));
    desk.press(Modifiers::COMMAND, Key::Num5);
    desk.harness.event(Event::Paste(table.to_owned()));
    desk.settle();
    assert_eq!(
        desk.harness.state().state().distributions.paste.table,
        table
    );
    desk.click(Role::Button, "Add table");
    assert_eq!(
        computed(&desk).analysis.photos.curves[0]
            .distribution
            .points()[1],
        [2.0, 35.0]
    );
}

/// She asked for the small window: what she pastes then goes into its field.
#[test]
fn the_field_for_a_table_has_the_keys() {
    let mut desk = Desk::new(None);
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::D);
    desk.harness
        .event(Event::Paste("size\tpassing\n".to_owned()));
    desk.settle();
    let page = &desk.harness.state().state().distributions;
    assert_eq!(page.paste.table, "size\tpassing\n");
}

/// How a table comes in is said in the empty field: a hover text lay over the fields below it.
#[test]
fn nothing_lies_over_the_fields_of_a_pasted_table() {
    let hint = "Ctrl+V pastes what was copied elsewhere";
    let mut desk = Desk::new(None);
    desk.press(Modifiers::COMMAND, Key::Num5);
    desk.click(Role::Button, "Paste table…");
    let says = |desk: &Desk| desk.written().iter().any(|w| w.text.contains(hint));
    assert!(says(&desk));
    paste(&mut desk, "size\tpassing\n1\t10\n2\t35\n4\t80\n");
    let field = desk.node(Role::TextInput, "Table");
    let words = field.accesskit_node().description();
    assert_eq!(words.as_deref(), Some(hint));
    let place = field.rect();
    desk.harness.hover_at(place.center());
    for _ in 0..90 {
        desk.harness.step();
    }
    assert!(!says(&desk));
}

#[test]
fn a_bad_table_is_refused_in_one_line() {
    let mut desk = Desk::new(None);
    desk.press(Modifiers::COMMAND, Key::Num5);
    desk.click(Role::Button, "Paste table…");
    paste(&mut desk, "size\tpassing\n1\t10\n2\t35\n4\t180\n");
    desk.click(Role::Button, "Add table");
    let page = &desk.harness.state().state().distributions;
    let refused = page.paste.refused.clone().expect("a line");
    assert!(
        refused.contains("180") && !refused.contains('\n'),
        "{refused}"
    );
    assert!(desk.says(&refused) && desk.logged(&refused));
    assert!(page.sources().is_empty());
    // Mended, it is taken.
    paste(&mut desk, "size\tpassing\n1\t10\n2\t35\n4\t80\n");
    desk.click(Role::Button, "Add table");
    assert_eq!(computed(&desk).analysis.photos.curves.len(), 1);
    assert!(desk.harness.state().state().notice.is_none());
}

/// What was pasted goes with the window: that is asked, and a table keeps it.
#[test]
fn pasted_tables_are_asked_about_and_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = Desk::new(None);
    desk.press(Modifiers::COMMAND, Key::Num5);
    desk.click(Role::Button, "Paste…");
    paste(&mut desk, "size_cm\tpassing\n1\t10\n2\t35\n4\t80\n8\t100\n");
    desk.click(Role::Button, "Add table");
    let quits = |desk: &Desk| desk.harness.state().state().may_quit;
    desk.press(Modifiers::COMMAND, Key::Q);
    assert!(desk.says("Pasted tables are in no file") && !quits(&desk));
    desk.click(Role::Button, "Stay here");
    desk.press(Modifiers::COMMAND, Key::Q);
    desk.click(Role::Button, "Save them as a table…");
    let path = folder.path().join("kept.csv");
    desk.type_path(&path);
    desk.click(Role::Button, "Write table");
    let text = std::fs::read_to_string(&path).expect("a table");
    assert!(
        text.starts_with("method,trial,photo,size_cm,percent_passing\n"),
        "{text}"
    );
    assert!(
        text.ends_with(",,1,10\npasted 1,,,2,35\npasted 1,,,4,80\npasted 1,,,8,100\n"),
        "{text}"
    );
    desk.press(Modifiers::COMMAND, Key::Q);
    assert!(quits(&desk));
    // Pasted once more, and thrown away.
    let mut desk = Desk::new(None);
    desk.press(Modifiers::COMMAND, Key::Num5);
    desk.click(Role::Button, "Paste…");
    paste(&mut desk, "size\tpassing\n1\t10\n2\t35\n");
    desk.click(Role::Button, "Add table");
    desk.press(Modifiers::COMMAND, Key::Q);
    desk.click(Role::Button, "Discard them");
    assert!(quits(&desk));
}

/// Pastes into the small window, over what is there.
fn paste(desk: &mut Desk, text: &str) {
    desk.node(Role::TextInput, "Table").click();
    desk.harness.run();
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    desk.harness.event(Event::Paste(text.to_owned()));
    desk.settle();
}

#[test]
fn what_is_taken_away_comes_back() {
    let more = "size_mm,percent_passing\n10,5\n20,30\n40,80\n80,99\n";
    let (_folder, mut desk) = desk(&[("trials.csv", TRIALS), ("belt.csv", more)]);
    let curves = |desk: &Desk| computed(desk).analysis.photos.curves.len();
    assert_eq!(curves(&desk), 8);
    // Without a method it is called after its file.
    assert_eq!(computed(&desk).analysis.methods[2], "belt");
    desk.click(Role::Button, "Remove trials.csv");
    assert_eq!(curves(&desk), 1);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(curves(&desk), 8);
    desk.click(Role::Button, "Remove all");
    assert!(
        desk.harness
            .state()
            .state()
            .distributions
            .computed
            .is_none()
    );
    assert!(desk.says("What Split-Desktop or a sieve gave"));
    desk.click(Role::Button, "Undo");
    assert_eq!(curves(&desk), 8);
    desk.click(Role::Button, "Redo");
    assert!(
        desk.harness
            .state()
            .state()
            .distributions
            .sources()
            .is_empty()
    );
    desk.click(Role::Button, "Undo");
    // A curve that is not shown stays in the tables.
    desk.click(Role::CheckBox, "Show belt");
    assert_eq!(desk.harness.state().state().distributions.hidden.len(), 1);
    assert_eq!(table(&desk, "Parameters").len(), 5);
    desk.click(Role::CheckBox, "Show point cloud / 2");
    assert_eq!(desk.harness.state().state().distributions.hidden.len(), 3);
}

#[test]
fn the_same_curves_twice_are_refused_in_one_line() {
    let (folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    drop_on(&mut desk, &[&folder.path().join("trials.csv")]);
    assert_eq!(computed(&desk).analysis.photos.curves.len(), 7);
    assert!(desk.logged("is there already, from trials.csv"));
}

#[test]
fn a_broken_file_is_told_with_its_name() {
    let (_folder, desk) = desk(&[("broken.csv", "size_mm,percent_passing\n10,5\n20,many\n")]);
    assert!(
        desk.harness
            .state()
            .state()
            .distributions
            .sources()
            .is_empty()
    );
    assert!(desk.says("broken.csv") && desk.logged("broken.csv:3"));
}

#[test]
fn times_of_steps_are_read_from_a_file() {
    let (folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    let path = folder.path().join("effort.csv");
    fs::write(&path, "step,trial 1,trial 2\nFly,4,6\nDelineate,20,30\n").expect("written");
    desk.click(Role::Tab, "Time effort");
    desk.click(Role::Button, "Add times…");
    desk.type_path(&path);
    desk.click(Role::Button, "Add times");
    let rows = table(&desk, "Time effort: effort.csv, min");
    assert_eq!(rows[0], ["Fly", "4.00", "6.00", "10.0", "5.00"]);
    assert_eq!(rows[1], ["Delineate", "20.0", "30.0", "50.0", "25.0"]);
    assert_eq!(rows[2], ["Total", "24.0", "36.0", "60.0", "30.0"]);
    assert_eq!(rows[3], ["Average", "12.0", "18.0", "30.0", "15.0"]);
}

#[test]
fn an_idle_page_draws_no_frames() {
    let (_folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    desk.settle();
    desk.harness.step();
    let output = &desk.harness.output().viewport_output[&egui::ViewportId::ROOT];
    assert_eq!(output.repaint_delay, std::time::Duration::MAX);
}

#[test]
fn a_change_while_it_is_computed_counts() {
    let (_folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    let mut wanted = settings(&desk);
    for model in Model::ALL {
        wanted.model = model;
        let command = DistributionCommand::Set(wanted.clone());
        desk.harness
            .state_mut()
            .apply(Command::Distributions(command));
    }
    desk.settle();
    assert_eq!(
        computed(&desk).edit.settings.model,
        Model::GatesGaudinSchuhmann
    );
}

/// Whatever is added, set, taken away, undone and cancelled, in an order that nobody would choose.
#[test]
fn the_results_are_always_those_of_the_data_and_settings_of_now() {
    let (folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    let mut paths = vec![
        folder.path().join("trials.csv"),
        folder.path().join("none.csv"),
    ];
    for name in ["belt", "bucket"] {
        let path = folder.path().join(format!("{name}.csv"));
        let text = "size_mm,percent_passing\n5,2\n10,5\n20,30\n40,80\n80,99\n";
        fs::write(&path, text).expect("written");
        paths.push(path);
    }
    let mut dice = Dice::new(19_380_704);
    for step in 0..400 {
        let mut settings = settings(&desk);
        let command = match dice.below(12) {
            0..=3 => {
                let paths: Vec<&PathBuf> = paths.iter().collect();
                let path = dice.one_of(&paths).clone();
                Command::Distributions(DistributionCommand::Add(vec![path]))
            }
            4 => Command::Distributions(DistributionCommand::Remove(dice.below(4))),
            5 if dice.below(4) == 0 => Command::Distributions(DistributionCommand::RemoveAll),
            6 => {
                settings.unit = dice.one_of(&LengthUnit::ALL);
                Command::Distributions(DistributionCommand::Set(settings))
            }
            7 => {
                settings.model = dice.one_of(&Model::ALL);
                settings.merging = dice.one_of(&Weighting::ALL);
                Command::Distributions(DistributionCommand::Set(settings))
            }
            8 => {
                let methods = ["belt", "point cloud", "gone"];
                settings.reference = Some(dice.one_of(&methods).to_owned());
                Command::Distributions(DistributionCommand::Set(settings))
            }
            9 => Command::Redo,
            10 => Command::Cancel(dice.one_of(&[Task::FITS, Task::READ_DISTRIBUTIONS])),
            _ => Command::Undo,
        };
        println!("{step}: {command:?}");
        desk.harness.state_mut().apply(command);
        desk.harness.state_mut().poll();
        if step % 20 == 0 {
            desk.harness.run_ok();
        }
        if step % 40 == 39 {
            // What was cancelled is computed with the next change.
            let mut settings = self::settings(&desk);
            settings.level = 1.0 / f64::from(step);
            let command = DistributionCommand::Set(settings);
            desk.harness
                .state_mut()
                .apply(Command::Distributions(command));
            desk.settle();
            check(&desk);
        }
    }
    let app = desk.harness.state_mut();
    while app.state().distributions.history.can_undo() {
        app.apply(Command::Undo);
    }
    desk.settle();
    assert!(
        desk.harness
            .state()
            .state()
            .distributions
            .computed
            .is_none()
    );
}

fn check(desk: &Desk) {
    let page = &desk.harness.state().state().distributions;
    let count: usize = page.sources().iter().map(|s| s.set.curves.len()).sum();
    // Weighted by areas that nobody gave, photos cannot be merged, and that is told.
    if let Some(problem) = &page.problem {
        assert!(problem.contains("it has no "), "{problem}");
        return;
    }
    assert!(page.is_current());
    let Some(computed) = &page.computed else {
        assert_eq!(count, 0);
        return;
    };
    assert_eq!(computed.edit, *page.history.now());
    assert_eq!(computed.analysis.photos.curves.len(), count);
    let labels: BTreeSet<_> = computed
        .analysis
        .photos
        .curves
        .iter()
        .map(|c| c.labels.clone())
        .collect();
    assert_eq!(labels.len(), count, "two curves with the same labels");
    assert_eq!(computed.fits.len(), computed.analysis.trials.curves.len());
}

#[test]
fn the_figure_and_the_report_are_written() {
    let (folder, mut desk) = desk(&[("trials.csv", TRIALS)]);
    for (save, name, write, begins) in [
        ("Save figure…", "a.svg", "Write figure", &b"<"[..]),
        ("Save figure…", "a.png", "Write figure", b"\x89PNG"),
        ("Save report…", "a.html", "Write report", b"<!DOCTYPE html>"),
    ] {
        let path = folder.path().join(name);
        desk.click(Role::Button, save);
        desk.type_path(&path);
        desk.click(Role::Button, write);
        let bytes = fs::read(&path).expect("written");
        assert!(bytes.starts_with(begins), "{name}");
        assert!(desk.logged(&format!("{}: written", path.display())));
        // A second time it asks first.
        fs::write(&path, "mine").expect("written");
        desk.click(Role::Button, save);
        desk.type_path(&path);
        desk.click(Role::Button, write);
        assert!(desk.says("There is a file already"));
        desk.click(Role::Button, "Keep the file");
        assert_eq!(fs::read(&path).expect("there"), b"mine");
    }
    desk.click(Role::Button, "Save figure…");
    desk.type_path(&folder.path().join("a.bmp"));
    desk.click(Role::Button, "Write figure");
    assert!(desk.logged("let its name end in .svg or .png"));
}

/// The same tables looked at in the same way: the window's figure, report and numbers are the command's
/// to the last byte.
#[test]
fn the_command_gives_the_same_answers() {
    let belt = "size_in,percent_passing\n0.2,4\n0.5,10\n1,30\n2,60\n4,90\n";
    let again = "method,size_mm,percent_passing\nSieve,8,5\nsieve,8,7\nSieve,16,15\nsieve,16,14\n\
                 Sieve,63,66\nsieve,63,65\nSieve,125,97\nsieve,125,96\n";
    let tables = [
        ("trials.csv", TRIALS),
        ("belt.csv", belt),
        ("again.csv", again),
    ];
    let usual = Settings::default();
    for (count, settings, arguments) in [
        (1, usual.clone(), &[][..]),
        (3, usual.clone(), &[]),
        (
            2,
            Settings {
                model: Model::RosinRammler,
                sieves: Some(SieveSeries::Iso565),
                reference: Some("point cloud".to_owned()),
                envelope_percent: 20.0,
                ..usual.clone()
            },
            &[
                "--model=rosin-rammler",
                "--resample=iso-565",
                "--reference=point cloud",
                "--envelope=20",
            ],
        ),
    ] {
        let tables = &tables[..count];
        let (folder, mut desk) = desk(&[]);
        for (name, text) in tables {
            let path = folder.path().join(name);
            fs::write(&path, text).expect("written");
            drop_on(&mut desk, &[&path]);
        }
        let command = DistributionCommand::Set(settings);
        desk.harness
            .state_mut()
            .apply(Command::Distributions(command));
        desk.settle();
        for save in [
            DistributionCommand::SaveFigure(folder.path().join("window.svg").into()),
            DistributionCommand::SaveReport(folder.path().join("window.html").into()),
        ] {
            desk.harness.state_mut().apply(Command::Distributions(save));
            desk.settle();
        }
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_fragscale"))
            .current_dir(folder.path())
            .args(["psd", "compare", "--format=json"])
            .args(["--figure=command.svg", "--report=command.html"])
            .args(arguments)
            .args(tables.iter().map(|(name, _)| name))
            .output()
            .expect("the command");
        assert!(output.status.success(), "{output:?}");
        let comparison = computed(&desk).analysis.comparison.as_ref();
        let json = comparison_json(comparison.expect("compared")).expect("JSON");
        assert_eq!(String::from_utf8_lossy(&output.stdout), json);
        for ending in ["svg", "html"] {
            let read = |who: &str| {
                fs::read_to_string(folder.path().join(format!("{who}.{ending}"))).expect("written")
            };
            assert_eq!(read("window"), read("command"), "{arguments:?}");
        }
    }
}
